#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Has ParaView's test player go through session.xml in the real application, and compares the ray traced
pictures with Contour's. Called as
    play_session.py PLUGIN OUTPUT [RANKS --server-url=URL] PARAVIEW
RANKS is how many the server has."""

import json
import math
import os
import shutil
import subprocess
import sys

import file_dialog
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

PLUGIN, OUTPUT, *OPTIONS, PARAVIEW = sys.argv[1:]
RANKS = OPTIONS.pop(0) if OPTIONS else 1
HERE = os.path.dirname(os.path.abspath(__file__))


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def write_session(path, address):
    with open(os.path.join(HERE, "session.xml"), encoding="utf-8") as text:
        content = text.read()
    for name, value in (("@PLUGIN@", PLUGIN), ("@OUTPUT@", OUTPUT), ("@RANKS@", str(RANKS)), ("@ADDRESS@", address),
                        ("@FILE_DIALOG@", file_dialog.get_name(PARAVIEW))):
        content = content.replace(name, value)
    has_panel = os.path.exists(os.path.join(os.path.dirname(PLUGIN), "DSMRayTracerPanel.so"))
    wanted = {"@REMOTE@": bool(OPTIONS), "@PANEL@": has_panel}
    lines = content.splitlines()
    head, events = lines[:6], lines[6:]
    with open(path, "w", encoding="utf-8") as text:
        for line in [head[0], head[1]] + events:
            marks = [mark for mark in wanted if mark in line]
            if all(wanted[mark] for mark in marks):
                for mark in marks:
                    line = line.replace(mark, "")
                text.write(line + "\n")


def write_files():
    """Bare values, and OME-Zarr with two levels."""
    with open(os.path.join(OUTPUT, "bare.raw"), "wb") as raw:
        raw.write(bytes(range(8 * 6 * 4)))
    for level, shape in enumerate(([4, 6, 8], [2, 3, 4])):
        folder = os.path.join(OUTPUT, "levels.zarr", str(level))
        os.makedirs(folder)
        with open(os.path.join(folder, ".zarray"), "w", encoding="utf-8") as text:
            json.dump({"zarr_format": 2, "shape": shape, "chunks": shape, "dtype": "|u1", "compressor": None,
                       "fill_value": 0, "order": "C", "filters": None}, text)
        with open(os.path.join(folder, "0.0.0"), "wb") as chunk:
            chunk.write(bytes(range(math.prod(shape))))
    axes = [{"name": name, "type": "space"} for name in "zyx"]
    scales = [{"path": str(level), "coordinateTransformations": [{"type": "scale", "scale": [2**level] * 3}]}
              for level in range(2)]
    for name, content in ((".zgroup", {"zarr_format": 2}),
                          (".zattrs", {"multiscales": [{"version": "0.4", "axes": axes, "datasets": scales}]})):
        with open(os.path.join(OUTPUT, "levels.zarr", name), "w", encoding="utf-8") as text:
            json.dump(content, text)


def read_picture(name):
    reader = vtkPNGReader()
    reader.SetFileName(os.path.join(OUTPUT, name))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return values.reshape(height, width, -1)[:, :, :3].astype(int)


def main():
    shutil.rmtree(OUTPUT, ignore_errors=True)
    os.makedirs(OUTPUT)
    write_files()
    session = os.path.join(OUTPUT, "session.xml")
    server = subprocess.Popen([sys.executable, os.path.join(HERE, "..", "files", "http_server.py"), OUTPUT],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    write_session(session, f"http://127.0.0.1:{int(server.stdout.readline())}/ok/levels.zarr")
    command = [PARAVIEW, "--dr", *OPTIONS, f"--test-directory={OUTPUT}", f"--test-script={session}", "--exit"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=150)
    server.stdin.close()
    print(result.stdout, result.stderr)
    check(result.returncode == 0, "every step of the session can be done")
    said = result.stdout + result.stderr
    check(not any(word in said for word in ("ERR|", "WARN|", "ERROR")), "without errors and warnings")
    contour = read_picture("contour.png")
    expected = (abs(contour - contour[0, 0]) > 8).any(axis=2)
    check(0.05 < expected.mean() < 0.9, f"Contour covers {100 * expected.mean():.0f} % of the view")
    for name in ("traced.png", "mesh.png"):
        picture = read_picture(name)
        check(picture.shape == contour.shape, f"{name}: as large as Contour's")
        covered = (abs(picture - picture[0, 0]) > 8).any(axis=2)
        share = (covered != expected).mean()
        check(share < 0.01, f"{name}: covers the same pixels but {100 * share:.2f} %")
        difference = abs(picture - contour).mean(axis=2)[covered & expected].mean()
        check(difference < 12, f"{name}: its colours differ by {difference:.1f} of 255 on average")

    check((read_picture("isosurfaces.png") == read_picture("traced.png")).all(), "isosurfaces are back as they were")
    outside, surface = read_picture("outside.png"), read_picture("surface.png")
    check((outside != read_picture("traced.png")).any(axis=2).mean() > 0.05, "the outer surface is another picture")
    difference = abs(outside - surface).mean()
    check(difference < 1, f"and differs from Surface by {difference:.2f} of 255 on average")


main()
