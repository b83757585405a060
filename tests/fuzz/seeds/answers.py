# SPDX-License-Identifier: BSD-3-Clause
"""Answers of servers, as FuzzAnswers.cxx takes them: a byte for what is asked, and all that comes back."""

import os

TAG = 'ETag: "tag"\r\n'
ANSWERS = {
    "whole": (0, f"HTTP/1.1 200 OK\r\nContent-Length: 5\r\n{TAG}\r\nhello"),
    "chunked": (0, "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"),
    "until_end": (0, f"HTTP/1.0 200 OK\r\n{TAG}\r\nhello"),
    "part": (1, f"HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 10-29/100\r\nContent-Length: 20\r\n{TAG}\r\n"
             + 20 * "x"),
    "end": (2, f"HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 84-99/100\r\nContent-Length: 16\r\n{TAG}\r\n"
            + 16 * "x"),
    "short_end": (2, "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 0-3/4\r\nContent-Length: 4\r\n\r\nabcd"),
    "all_of_it": (1, f"HTTP/1.1 200 OK\r\nContent-Length: 100\r\n{TAG}\r\n" + 100 * "x"),
    "unchanged": (3, f"HTTP/1.1 304 Not Modified\r\n{TAG}\r\n"),
    "missing": (0, "HTTP/1.1 404 Not Found\r\nContent-Length: 2\r\n\r\nno"),
    "busy": (0, "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 1\r\nContent-Length: 0\r\n\r\n"),
    "redirect": (0, "HTTP/1.1 302 Found\r\nLocation: http://other/x\r\nContent-Length: 0\r\n\r\n"),
    "cut": (0, "HTTP/1.1 200 OK\r\nContent-Length: 500\r\n\r\nhello"),
}


def make(folder):
    place = os.path.join(folder, "Answers")
    os.makedirs(place)
    for name, (kind, text) in ANSWERS.items():
        with open(os.path.join(place, name), "wb") as file:
            file.write(bytes([kind]) + text.encode())
