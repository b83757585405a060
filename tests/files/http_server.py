#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Serves a folder over HTTP, with byte ranges and ETags, and misbehaves as the first part of a path says:
/BEHAVIOR/NAME.zarr/KEY. Called as http_server.py FOLDER [SECONDS]: prints its port, and ends after so many seconds, or
when its input ends. Files of metadata are served as they should be, but by behaviors that begin with "all_".

/log: the requests since the last look at it, as JSON, each [method, path, range, credentials, status]."""

import email.utils
import hashlib
import hmac
import http.server
import json
import os
import re
import socket
import sys
import threading
import time
import urllib.parse

METADATA = ("zarr.json", ".zarray", ".zgroup", ".zattrs", ".zmetadata")
FOLDER = sys.argv[1]
guard = threading.Lock()
log, seen = [], {}


def consolidate(folder, name):
    """The text of a group's consolidated metadata; none for other files."""
    if name == ".zmetadata" and os.path.isfile(os.path.join(folder, ".zgroup")):
        wanted = METADATA[1:4]
    elif name == "zarr.json" and os.path.isfile(os.path.join(folder, name)):
        wanted = METADATA[:1]
    else:
        return None
    found = {}
    for inner, _, files in os.walk(folder):
        for file in set(files) & set(wanted):
            path = os.path.relpath(os.path.join(inner, file), folder)
            with open(os.path.join(inner, file), encoding="utf-8") as text:
                found[path] = json.load(text)
    if name == ".zmetadata":
        return json.dumps({"metadata": found, "zarr_consolidated_format": 1}).encode()
    root = found.pop("zarr.json")
    if root["node_type"] != "group":
        return None
    copies = {os.path.dirname(path): one for path, one in found.items()}
    root["consolidated_metadata"] = {"kind": "inline", "must_understand": False, "metadata": copies}
    return json.dumps(root).encode()


def is_signed(request):
    """Whether a request has the signature that Amazon describes, version 4, by the key "KEY" and the secret below."""
    found = re.fullmatch(r"AWS4-HMAC-SHA256 Credential=KEY/(\d+)/(\S+)/s3/aws4_request, ?"
                         r"SignedHeaders=(\S+), ?Signature=(\w+)", request.headers.get("Authorization", ""))
    if not found or request.headers.get("x-amz-security-token") != "TOKEN":
        return False
    day, region, names, signature = found.groups()
    names = names.split(";")
    lines = [f"{name}:{request.headers[name].strip()}" for name in names]
    canonical = "\n".join([request.command, request.path, "", *lines, "", ";".join(names),
                           request.headers["x-amz-content-sha256"]])
    scope = f"{day}/{region}/s3/aws4_request"
    text = "\n".join(["AWS4-HMAC-SHA256", request.headers["x-amz-date"], scope,
                      hashlib.sha256(canonical.encode()).hexdigest()])
    key = b"AWS4se/cr+et"
    for part in (day, region, "s3", "aws4_request", text):
        key = hmac.new(key, part.encode(), hashlib.sha256).digest()
    return key.hex() == signature and {"host", "x-amz-security-token"} <= set(names)


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True  # head and body are sent one after the other

    def log_message(self, *_):
        pass

    def drop(self):
        self.close_connection = True
        self.connection.shutdown(socket.SHUT_RDWR)

    def answer(self, status, body=b"", length=None, **headers):
        """Sends a head and a body, of which the head may declare another length."""
        with guard:
            log.append([self.command, self.path, self.headers.get("Range", ""),
                        self.headers.get("Authorization", ""), status])
        self.send_response(status)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        for name, value in headers.items():
            if value is not None:
                self.send_header(name.replace("_", "-"), value)
        self.end_headers()
        if status != 304:
            self.wfile.write(body)

    def do_GET(self):
        parts = urllib.parse.unquote(self.path).lstrip("/").split("/", 1)
        if parts[0] == "log":
            with guard:
                text = json.dumps(log).encode()
                log.clear()
            self.send_response(200)
            self.send_header("Content-Length", str(len(text)))
            self.end_headers()
            self.wfile.write(text)
            return
        behavior, key = parts if len(parts) == 2 else ("ok", "")
        if behavior.startswith("all_"):
            behavior = behavior[4:]
        elif os.path.basename(key) in METADATA and behavior != "consolidated":
            behavior = "ok"
        with guard:
            count = seen[self.path] = seen.get(self.path, 0) + 1
        self.serve(behavior, key, count)

    def serve(self, behavior, key, count):
        if behavior == "drop" or (behavior == "drop_twice" and count <= 2):
            self.drop()
            return
        if behavior == "silent":
            time.sleep(30)
            self.drop()
            return
        if behavior == "garbage":
            self.wfile.write(b"\x00\xffnonsense\r\n\r\n")
            self.drop()
            return
        if behavior.isdigit() and len(behavior) == 3:
            self.answer(int(behavior), b"no")
            return
        if behavior == "503_twice" and count <= 2:
            self.answer(503, b"busy", Retry_After="0")
            return
        other = f"http://localhost:{self.server.server_port}"
        if behavior in ("redirect", "redirect_loop", "redirect_file"):
            to = {"redirect": f"{other}/ok/{key}", "redirect_loop": f"/redirect_loop/{key}",
                  "redirect_file": f"file:///{FOLDER}/{key}"}[behavior]
            self.answer(302, b"there", Location=urllib.parse.quote(to, safe=":/"))
            return
        if behavior == "signed" and not is_signed(self):
            self.answer(403, b"no")
            return
        path = os.path.join(FOLDER, key)
        if behavior == "consolidated":
            text = consolidate(os.path.dirname(path), os.path.basename(path))
            if text:
                self.answer(200, text, ETag='"' + hashlib.md5(text).hexdigest() + '"')
                return
        if ".." in key or not os.path.isfile(path):
            self.answer(404, b"nothing")
            return
        with open(path, "rb") as file:
            body = file.read()
        self.send(behavior, body, os.stat(path).st_mtime, count)

    def send(self, behavior, body, modified, count):
        tag = '"' + hashlib.md5(body).hexdigest() + '"'
        if behavior == "new_tag":
            tag = f'"{count}"'
        headers = {"ETag": tag, "Last_Modified": email.utils.formatdate(modified, usegmt=True)}
        if behavior == "no_tag":
            headers = {"Last_Modified": headers["Last_Modified"]}
        if behavior == "nothing_said":
            headers = {}
        since = self.headers.get("If-Modified-Since") == headers.get("Last_Modified", "")
        if headers and (self.headers.get("If-None-Match") == tag or since):
            self.answer(304, b"", 0, **headers)
            return
        status = 200
        wanted = re.fullmatch(r"bytes=(\d*)-(\d*)", self.headers.get("Range", ""))
        if wanted and behavior != "no_ranges":
            total, first, last = len(body), wanted.group(1), wanted.group(2)
            begin = int(first) if first else max(0, total - int(last))
            end = min(total, int(last) + 1) if first and last else total
            body, status = body[begin:end], 206
            shift = -1 if behavior == "wrong_range" else 0
            headers["Content_Range"] = f"bytes {begin + shift}-{end - 1 + shift}/{total}"
            if behavior == "no_content_range":
                del headers["Content_Range"]
            if behavior == "other_total":
                headers["Content_Range"] = f"bytes {begin}-{end - 1}/{total + count - 1}"
        if behavior == "slow":
            time.sleep(0.02)
        if behavior == "encoded":
            headers["Content_Encoding"] = "gzip"
        if behavior in ("cut", "cut_once") and (behavior == "cut" or count == 1):
            self.answer(status, body[: len(body) // 2], len(body), **headers)
            self.drop()
        elif behavior == "trickle":
            self.answer(status, b"", len(body), **headers)
            try:
                for byte in body:
                    self.wfile.write(bytes([byte]))
                    time.sleep(0.2)
            except OSError:
                pass
            self.drop()
        elif behavior == "less_declared":
            self.answer(status, body[:-3], **headers)
        elif behavior == "more_declared":
            self.answer(status, body, len(body) + 3, **headers)
            self.drop()
        elif behavior == "longer":
            self.answer(status, body * 3, **headers)
        elif behavior == "other_bytes":
            self.answer(status, bytes(byte ^ 0x5A for byte in body), **headers)
        elif behavior == "endless":
            self.send_response(status)
            self.end_headers()
            self.close_connection = True
            try:
                while True:
                    self.wfile.write(b"x" * 65536)
            except OSError:
                pass
        else:
            self.answer(status, body, **headers)


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 64

    def handle_error(self, *_):
        pass


server = Server(("127.0.0.1", 0), Handler)
print(server.server_port, flush=True)
threading.Thread(target=server.serve_forever, daemon=True).start()
if len(sys.argv) > 2:
    time.sleep(float(sys.argv[2]))
else:
    sys.stdin.read()
