# SPDX-License-Identifier: BSD-3-Clause
"""A server that is there again after its client has left, and what its ranks hold."""

import os
import signal
import subprocess
import tempfile
import threading
import time

from started import find_free_port


def holds_blocks(process):
    """Whether a process maps any of the ray tracer's blocks."""
    with open(f"/proc/{process}/maps", encoding="utf-8") as text:
        return "memfd:dsm blocks" in text.read()


def get_heap(process, folder):
    """What a process has in use of its heap, in KiB, by the notes of HeapNotes.cxx; None while it is only being loaded,
    as a server is that takes the place of another."""
    path = os.path.join(folder, str(process))
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as note:
        return int(note.read())


def is_listening(port):
    """Without connecting, which a server would take for its client."""
    with open("/proc/net/tcp", encoding="utf-8") as text:
        rows = [line.split() for line in text][1:]
    listening = "0A"
    return any(row[1].endswith(f":{port:04X}") and row[3] == listening for row in rows)


def wait_until_listening(port):
    deadline = time.monotonic() + 60
    while not is_listening(port):
        if time.monotonic() > deadline:
            raise AssertionError("the server did not come up")
        time.sleep(0.1)


class ServerOfRanks:
    """Runs a command again and again, on one port, while it is entered. What it starts notes its heaps in a folder."""

    def __init__(self, command, heap_notes):
        self.port = find_free_port()
        self.heaps = tempfile.TemporaryDirectory()
        loaded = filter(None, (heap_notes, os.environ.get("LD_PRELOAD")))
        self.environment = dict(os.environ, LD_PRELOAD=":".join(loaded), DSM_HEAP_NOTES=self.heaps.name)
        self.command = command + [f"--server-port={self.port}"]
        self.log = tempfile.TemporaryFile("w+")
        self.ends = False
        self.process = None
        self.thread = threading.Thread(target=self.keep)

    def __enter__(self):
        self.thread.start()
        wait_until_listening(self.port)
        return self

    def __exit__(self, *_):
        self.ends = True
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGTERM)
        self.thread.join()
        self.heaps.cleanup()

    def keep(self):
        while not self.ends:
            self.process = subprocess.Popen(
                self.command, stdout=self.log, stderr=subprocess.STDOUT, start_new_session=True, env=self.environment
            )
            self.process.wait()

    def read(self):
        self.log.seek(0)
        return self.log.read()
