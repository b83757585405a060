#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the example simulation: two ranks draw what one draws, fields that stay the same keep their
bricks, and no step takes memory for good. Called as
    TestCatalyst.py EXAMPLE PLUGIN OUTPUT MPIRUN..."""

import os
import re
import statistics
import subprocess
import sys

try:
    import mpi4py  # noqa: F401
    from paraview.catalyst import bridge  # noqa: F401
except ImportError as error:
    print(f"skipped: the example needs mpi4py and ParaView's Catalyst ({error})")
    sys.exit(77)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

EXAMPLE, PLUGIN, OUTPUT = sys.argv[1:4]
MPIRUN = sys.argv[4:]
WARM_UP, STEPS = 15, 40
KIBIBYTES_FOR_ALL_STEPS = 4096  # less than the bricks of five steps


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def simulate(ranks, name, every, *options):
    """What the simulation printed, and the folder of its pictures."""
    folder = os.path.join(OUTPUT, name)
    os.makedirs(folder, exist_ok=True)
    for old in os.listdir(folder):
        os.remove(os.path.join(folder, old))
    environment = dict(os.environ, DSM_PLUGIN=PLUGIN, DSM_OUTPUT=folder, DSM_EVERY=str(every))
    command = [*MPIRUN, "-np", str(ranks), sys.executable, os.path.join(EXAMPLE, "simulation.py")]
    command += ["--pipeline", os.path.join(EXAMPLE, "pipeline.py"), "--size", "48", *options]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=150)
    print(result.stdout, result.stderr)
    check(result.returncode == 0, f"{name}: {ranks} ranks come to an end")
    check("ERR|" not in result.stderr and "Error" not in result.stderr, "without errors")
    return result.stdout, folder


def read_picture(folder, step):
    reader = vtkPNGReader()
    reader.SetFileName(os.path.join(folder, f"step{step:06d}.png"))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)


def get_publications(text):
    return int(re.search(r"cut into bricks (\d+) times", text).group(1))


# Ten steps that change and ten that do not, with a picture every fifth step: of both arrays, three
# states must be cut into bricks.
options = ("--steps", "21", "--still-from", "11")
text, one = simulate(1, "one", 5, *options)
check(sorted(os.listdir(one)) == [f"step{step:06d}.png" for step in range(0, 21, 5)], "five pictures")
text, two = simulate(2, "two", 5, *options)
check(get_publications(text) == 6, "what does not change is not cut into bricks again")
pictures = {step: read_picture(two, step) for step in range(0, 21, 5)}
covered = (abs(pictures[20] - pictures[20][0]) > 30).any(axis=1).mean()
check(0.05 < covered < 0.6, f"a surface is seen in {100 * covered:.0f} % of the pixels")
for step, picture in pictures.items():
    difference = abs(picture - read_picture(one, step)).max()
    check(difference <= 1, f"step {step}: two ranks draw what one draws ({difference})")
check((pictures[5] != pictures[10]).any(), "the surface grows")
check((pictures[10] == pictures[15]).all(), "up to the last change")
check((pictures[10] == pictures[20]).all(), "and not any further")

# A picture on every step.
text, _ = simulate(2, "memory", 1, "--steps", str(STEPS), "--memory-every", "1", "--substeps", "1")
check(get_publications(text) == 2 * STEPS, "what changes is cut into bricks on every step")
memory = [
    [int(word) for word in line.split()[2:]]
    for line in text.splitlines()
    if line.startswith("memory")
]
# Medians of several steps are compared, because the memory that the allocator keeps varies from step to step.
NEAR = 6
for rank in range(2):
    before = statistics.median(step[rank] for step in memory[WARM_UP - NEAR : WARM_UP])
    after = statistics.median(step[rank] for step in memory[-NEAR:])
    check(
        after - before < KIBIBYTES_FOR_ALL_STEPS,
        f"rank {rank} holds {before} KiB after {WARM_UP} steps and {after} after {STEPS}",
    )
