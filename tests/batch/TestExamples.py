#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the pvbatch examples on one rank and on two, and compares their pictures. Called as
    TestExamples.py EXAMPLES PLUGIN OUTPUT PVBATCH MPIRUN..."""

import csv
import os
import shutil
import subprocess
import sys

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

EXAMPLES, PLUGIN, OUTPUT, PVBATCH = sys.argv[1:5]
MPIRUN = sys.argv[5:]


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def run(ranks, script, *options):
    command = [*MPIRUN, "-np", str(ranks), PVBATCH, os.path.join(EXAMPLES, script)]
    command += ["--plugin", PLUGIN, *options]
    result = subprocess.run(command, capture_output=True, text=True, timeout=100)
    print(result.stdout, result.stderr)
    check(result.returncode == 0, f"{script} on {ranks} ranks comes to an end")
    check("ERR|" not in result.stderr and "Error" not in result.stderr, "without errors")


def read_picture(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def compare(name, one, two):
    """Returns the picture, which must show something."""
    first = read_picture(one)
    difference = abs(first - read_picture(two)).max()
    check(difference <= 1, f"{name}: two ranks draw what one draws ({difference})")
    covered = (abs(first - first[0]) > 20).any(axis=1).mean()
    check(0.02 < covered < 0.9, f"{name}: a surface on {100 * covered:.0f} % of the picture")
    return first


shutil.rmtree(OUTPUT, ignore_errors=True)
os.makedirs(OUTPUT)
folders = [os.path.join(OUTPUT, f"{ranks}.cdb") for ranks in (1, 2)]
for ranks, folder in zip((1, 2), folders):
    run(ranks, "cinema.py", "--output", folder, "--phi=0,100", "--theta=-20,30",
        "--isovalues=0.3,0.5", "--size", "160", "120")
tables = []
for folder in folders:
    with open(os.path.join(folder, "data.csv"), newline="") as text:
        tables.append(list(csv.DictReader(text)))
check(tables[0] == tables[1], "the tables are the same")
check(len(tables[0]) == 8, "with a row for each picture")
check(list(tables[0][0]) == ["phi", "theta", "isovalue", "FILE"], "and parameters before FILE")
pictures = [
    compare(row["FILE"], *(os.path.join(folder, row["FILE"]) for folder in folders))
    for row in tables[0]
]
different = len({picture.tobytes() for picture in pictures})
check(different == len(pictures), "all pictures differ")

files = []
for step, maximum in enumerate((255.0, 235.0, 215.0)):
    source = vtkRTAnalyticSource()
    source.SetMaximum(maximum)
    writer = vtkXMLImageDataWriter()
    writer.SetInputConnection(source.GetOutputPort())
    files.append(os.path.join(OUTPUT, f"step{step}.vti"))
    writer.SetFileName(files[-1])
    writer.Write()
for ranks in (1, 2):
    run(ranks, "animation.py", "--files", *files, "--array", "RTData", "--isovalues=157",
        "--output", os.path.join(OUTPUT, f"frame{ranks}.png"), "--size", "160", "120")
frames = [
    compare(f"step {step}", *(os.path.join(OUTPUT, f"frame{ranks}.{step:04d}.png") for ranks in (1, 2)))
    for step in range(3)
]
check((frames[0] != frames[1]).any() and (frames[1] != frames[2]).any(), "the surface changes")
check(not os.path.exists(os.path.join(OUTPUT, "frame1.0003.png")), "and there are three steps")
