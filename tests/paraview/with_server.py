#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Starts a server on a free port and runs a client against it:
    with_server.py --server COMMAND... --client COMMAND...
@PORT@ in the client's command stands for the port, which the client also has in the environment
variable DSM_TEST_PORT. Returns what the client returns; fails when the
server does not come up, or does not end by itself after the client has left. Nothing that either has
started is left when this ends."""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
from started import ended_with_this, find_free_port


def wait_until_listening(server, log, seconds):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and server.poll() is None:
        log.seek(0)
        if "Accepting connection" in log.read():
            return True
        time.sleep(0.1)
    return False


def main():
    split = sys.argv.index("--client")
    port = find_free_port()
    server_command = sys.argv[2:split] + [f"--server-port={port}"]
    client_command = [word.replace("@PORT@", str(port)) for word in sys.argv[split + 1 :]]
    with tempfile.TemporaryFile("w+") as log:
        server = subprocess.Popen(
            server_command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
        )
        result = 1
        try:
            if wait_until_listening(server, log, 60):
                result = subprocess.call(client_command, env={**os.environ, "DSM_TEST_PORT": str(port)})
                result = result or server.wait(timeout=30)
            else:
                print("the server did not come up")
        except subprocess.TimeoutExpired:
            print("the server did not end after its client had left")
            result = 1
        finally:
            if server.poll() is None:
                os.killpg(server.pid, signal.SIGTERM)
                # `timeout` gives a test that it ends ten seconds.
                with contextlib.suppress(subprocess.TimeoutExpired):
                    server.wait(timeout=4)
            log.seek(0)
            print("--- server ---", log.read(), sep="\n")
    return result


with ended_with_this():
    sys.exit(main())
