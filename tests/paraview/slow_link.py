#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A slow connection to a local port: connections to the port that it prints first go on to PORT, in each
direction with MBIT megabits a second and MS milliseconds on the way. For each line read from standard
input it prints how many bytes have come from PORT; ends with the input.
    slow_link.py PORT MBIT MS"""

import queue
import socket
import sys
import threading
import time

PORT, MEGABITS, MILLISECONDS = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
CHUNK = 16 * 1024

carried = 0


def deliver(sink, chunks):
    while True:
        due, chunk = chunks.get()
        time.sleep(max(0.0, due - time.monotonic()))
        if not chunk:
            break
        sink.sendall(chunk)
    sink.shutdown(socket.SHUT_WR)


def carry(source, sink, counts):
    global carried
    # What the link and the other side have not taken yet waits here; so does who sends.
    chunks = queue.Queue(maxsize=64)
    threading.Thread(target=deliver, args=(sink, chunks), daemon=True).start()
    free = time.monotonic()
    while True:
        chunk = source.recv(CHUNK)
        if counts:
            carried += len(chunk)
        free = max(free, time.monotonic()) + 8 * len(chunk) / (1e6 * MEGABITS)
        chunks.put((free + MILLISECONDS / 1000, chunk))
        if not chunk:
            return


def accept(listener):
    while True:
        client = listener.accept()[0]
        server = socket.create_connection(("127.0.0.1", PORT))
        for end in (client, server):
            end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        threading.Thread(target=carry, args=(client, server, False), daemon=True).start()
        threading.Thread(target=carry, args=(server, client, True), daemon=True).start()


listener = socket.create_server(("127.0.0.1", 0))
threading.Thread(target=accept, args=(listener,), daemon=True).start()
print(listener.getsockname()[1], flush=True)
for _ in sys.stdin:
    print(carried, flush=True)
