#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the plugin costs those who do not use it: frames of a Surface and a Contour of a wavelet, and the memory of the
ranks, without a plugin, with one of ParaView's own, and with ours; in processes of their own, in turn. Called as
    xvfb-run -a -s "-noreset -screen 0 1280x1024x24" unused.py PLUGIN [--ranks N] [--runs N] [--frames N] [--server]
With --server, a pvserver of so many ranks draws for a client; else pvbatch draws. Memory is what a rank holds besides
files that are mapped, with its part of what ranks share."""

import argparse
import glob
import json
import os
import statistics
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import started

VARIANTS = ("none", "another", "ours")


def list_ranks(program):
    """The processes of that name that were started from where this one was."""
    for entry in glob.glob("/proc/[0-9]*/stat"):
        try:
            with open(entry, encoding="utf-8", errors="replace") as text:
                stat = text.read()
        except OSError:
            continue  # a process that has just ended
        name = stat[stat.index("(") + 1 : stat.rindex(")")]
        session = stat[stat.rindex(")") + 1 :].split()[3]
        if name.startswith(program) and session == str(os.getsid(0)):
            yield int(entry.split("/")[2])


def get_memory(program):
    """KiB of each rank."""
    return [started.get_memory(rank) for rank in list_ranks(program)]


def get_processor_time(program):
    """Seconds of all ranks; a busy machine has less influence on them than on the time of a clock."""
    ticks = 0
    for rank in list_ranks(program):
        with open(f"/proc/{rank}/stat", encoding="utf-8", errors="replace") as text:
            fields = text.read().rsplit(")", 1)[1].split()
        ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def draw(plugin, frames, port, program):
    """In ParaView's Python, on its rank 0 or its client. Prints what was measured."""
    from paraview import simple

    if port:
        simple.Connect("127.0.0.1", port)
    if plugin != "none":
        if port:
            simple.LoadPlugin(plugin, remote=True, ns=vars(simple))
        simple.LoadPlugin(plugin, remote=False, ns=vars(simple))
    view = simple.CreateRenderView(ViewSize=[400, 300])
    wavelet = simple.Wavelet(WholeExtent=[-20, 20, -20, 20, -20, 20])
    contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[130.0, 200.0])
    for source in (contour, wavelet):
        simple.Show(source, view).Representation = "Surface"
    simple.ResetCamera(view)
    taken = {"still": [], "moving": []}
    for number in range(frames + 3):
        if number == 3:
            begun = get_processor_time(program)
        view.GetActiveCamera().Azimuth(3.0)
        for kind, render in (("still", view.SMProxy.StillRender), ("moving", view.SMProxy.InteractiveRender)):
            start = time.perf_counter()
            render()
            if number >= 3:  # what is made for the first frames only is not counted
                taken[kind].append(time.perf_counter() - start)
    processor = 1000 * (get_processor_time(program) - begun) / (2 * frames)
    measured = {kind: 1000 * statistics.median(times) for kind, times in taken.items()}
    print("measured: " + json.dumps({**measured, "processor": processor, "memory": get_memory(program)}), flush=True)


def find_another():
    """One of ParaView's own plugins."""
    for found in glob.glob("/usr/lib/*/paraview-*/plugins/StreamLinesRepresentation/StreamLinesRepresentation.so"):
        return found
    sys.exit("none of ParaView's own plugins was found")


def run(arguments, plugin):
    mpi = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(arguments.ranks)]
    if os.geteuid() == 0:
        mpi.insert(1, "--allow-run-as-root")
    own = [os.path.abspath(__file__), plugin, "--frames", str(arguments.frames)]
    if not arguments.server:
        command = [*mpi, "pvbatch", *own, "--draw", "pvbatch"]
        server = None
    else:
        port = started.find_free_port()
        server = subprocess.Popen([*mpi, "pvserver", f"--server-port={port}"], stdout=subprocess.PIPE, text=True)
        while "Accepting" not in server.stdout.readline():
            pass
        command = ["pvpython", "--force-offscreen-rendering", *own, "--draw", "pvserver", "--port", str(port)]
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, timeout=300)
    if server:
        server.wait(60)
    (line,) = [line for line in result.stdout.splitlines() if line.startswith("measured: ")]
    return json.loads(line[len("measured: ") :])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("plugin")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--server", action="store_true")
    parser.add_argument("--draw", help="the program whose processes are the ranks (of this script itself)")
    parser.add_argument("--port", type=int, default=0)
    arguments = parser.parse_args()
    if arguments.draw:
        draw(arguments.plugin, arguments.frames, arguments.port, arguments.draw)
        return
    plugins = {"none": "none", "another": find_another(), "ours": os.path.abspath(arguments.plugin)}
    measured = {variant: [] for variant in VARIANTS}
    for number in range(arguments.runs):
        for variant in VARIANTS if number % 2 == 0 else reversed(VARIANTS):
            measured[variant].append(run(arguments, plugins[variant]))
            print(number, variant, measured[variant][-1], flush=True)
    for variant in VARIANTS:
        rows = measured[variant]
        middle = {kind: statistics.median(row[kind] for row in rows) for kind in ("still", "moving", "processor")}
        memory = statistics.median(max(row["memory"]) for row in rows) / 1024
        print(f"{variant}: still {middle['still']:.2f} ms, moving {middle['moving']:.2f} ms, "
              f"processor time of a frame {middle['processor']:.2f} ms, "
              f"largest rank {memory:.1f} MiB")


main()
