# SPDX-License-Identifier: BSD-3-Clause
"""A cluster on one machine: every rank in a network namespace of its own, on a bridge, with 1 Gbit/s
and, where the kernel has netem, 0.1 ms on the way. MPI runs over TCP, and starts the remote ranks
through an agent that enters the namespace, as ssh would enter a host.

    run_cluster.py [--ranks N] COMMAND [ARGUMENT...]

runs the command on every rank, and leaves with its status; with 77 where namespaces cannot be made."""

import argparse
import os
import shutil
import stat
import subprocess
import sys
import tempfile

SKIPPED = 77
NETWORK = "10.77.31"
AGENT = """#!/bin/sh
# mpirun calls: agent HOST COMMAND...; the host's last number names the namespace.
host=$1
shift
exec ip netns exec {prefix}${{host##*.}} unshare --uts sh -c "hostname {prefix}${{host##*.}}; $*"
"""


class Unavailable(Exception):
    """What this machine lacks."""


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Unavailable(f"`{' '.join(command)}` failed: {done.stderr.strip() or done.stdout.strip()}")


class Cluster:
    """Namespaces PREFIX1 .. PREFIXn with addresses 10.77.31.1 .. n, on a bridge in PREFIX0."""

    def __init__(self, ranks):
        self.ranks = ranks
        self.prefix = f"dsm{os.getpid()}-"
        self.made = []

    def __enter__(self):
        try:
            self.build()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for name in self.made:
            subprocess.run(["ip", "netns", "del", name], check=False)

    def add_namespace(self, number):
        name = f"{self.prefix}{number}"
        run("ip", "netns", "add", name)
        self.made.append(name)
        run("ip", "-n", name, "link", "set", "lo", "up")
        return name

    def build(self):
        for tool in ("ip", "tc", "unshare", "hostname"):
            if not shutil.which(tool):
                raise Unavailable(f"the program {tool} is not installed")
        if os.geteuid() != 0:
            raise Unavailable("network namespaces need the rights of root")
        switch = self.add_namespace(0)
        run("ip", "-n", switch, "link", "add", "bridge", "type", "bridge")
        run("ip", "-n", switch, "link", "set", "bridge", "up")
        delayed = True
        for number in range(1, self.ranks + 1):
            node = self.add_namespace(number)
            run("ip", "-n", switch, "link", "add", f"port{number}", "type", "veth",
                "peer", "name", "eth0", "netns", node)
            run("ip", "-n", switch, "link", "set", f"port{number}", "master", "bridge", "up")
            run("ip", "-n", node, "address", "add", f"{NETWORK}.{number}/24", "dev", "eth0")
            run("ip", "-n", node, "link", "set", "eth0", "up")
            delayed = self.limit(node, "eth0") and delayed
            self.limit(switch, f"port{number}", delay=False)
        print(f"{self.ranks} hosts, 1 Gbit/s" + (", 0.1 ms" if delayed else
              "; no added delay, for this kernel has no netem"), flush=True)

    @staticmethod
    def limit(name, device, delay=True):
        """Whether the delay could be had."""
        limit = ["tc", "-n", name, "qdisc", "add", "dev", device]
        if delay:
            try:
                run(*limit, "root", "netem", "delay", "0.1ms", "rate", "1gbit")
                return True
            except Unavailable:
                pass
        run(*limit, "root", "tbf", "rate", "1gbit", "burst", "128kb", "latency", "20ms")
        return False

    def run_on_all(self, command):
        with tempfile.TemporaryDirectory() as folder:
            agent = os.path.join(folder, "agent")
            with open(agent, "w", encoding="ascii") as file:
                file.write(AGENT.format(prefix=self.prefix))
            os.chmod(agent, stat.S_IRWXU)
            hosts = ",".join(f"{NETWORK}.{number}:1" for number in range(1, self.ranks + 1))
            network = f"{NETWORK}.0/24"
            first = f"{self.prefix}1"
            mpirun = ["mpirun", "--allow-run-as-root", "--host", hosts, "-np", str(self.ranks),
                      "--bind-to", "none", "--mca", "plm_rsh_agent", agent,
                      "--mca", "pml", "ob1", "--mca", "btl", "tcp,self",
                      "--mca", "btl_tcp_if_include", network,
                      "--mca", "oob_tcp_if_include", network, "--mca", "mpi_yield_when_idle", "1"]
            enter = ["ip", "netns", "exec", first, "unshare", "--uts", "sh", "-c",
                     f'hostname {first}; exec "$@"', "sh"]
            return subprocess.run(enter + mpirun + command, check=False).returncode


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    arguments = parser.parse_args()
    try:
        with Cluster(arguments.ranks) as cluster:
            return cluster.run_on_all(arguments.command)
    except Unavailable as reason:
        print(f"Skipped: {reason}.", flush=True)
        return SKIPPED


if __name__ == "__main__":
    sys.exit(main())
