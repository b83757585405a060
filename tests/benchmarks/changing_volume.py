#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A volume of which a part of the bricks changes with every time step: how many bytes move, and how long the next
step takes beside a still picture, for volumes of a pipeline and, with --files, for compressed brick files of which
each is a step.

    tests/benchmarks/changing_volume.py build --ranks 2 [--steps 100] [--edge 161] [--files /var/tmp]

`build` is the project's build folder. The files are written to the folder, and deleted."""

import argparse
import builtins
import json
import os
import shutil
import statistics
import subprocess
import sys
import time

from measuring import get_rows

SHARES = (0.01, 0.1, 1.0)
BRICK = 16  # cells along an axis of a brick of floats
SOURCE = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
request = self.GetExecutive().GetOutputInformation().GetInformationObject(0)
piece = [0] * 6
request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT(), piece)
image = self.GetOutputDataObject(0)
image.SetExtent(piece)
k, j, i = np.meshgrid(*[np.arange(piece[a], piece[a + 1] + 1) for a in (4, 2, 0)], indexing="ij")
values = np.sqrt((i / {middle} - 1) ** 2 + (j / {middle} - 1) ** 2 + (k / {middle} - 1) ** 2)
# Bricks that change, spread over all; their faces, which they share with others, stay.
bricks = {edge} // {brick}
number = i // {brick} + bricks * (j // {brick} + bricks * (k // {brick}))
inner = (i % {brick} > 0) * (j % {brick} > 0) * (k % {brick} > 0)
chosen = number * 7919 % 1000 < {share} * 1000
values = (values + chosen * inner * 0.001 * (1 + {step} % 7)).astype(np.float32)
array = numpy_to_vtk(values.ravel(), deep=True)
array.SetName("f")
image.GetPointData().SetScalars(array)
"""
INFORMATION = """
from paraview import util
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
util.SetOutputWholeExtent(self, [0, {edge}, 0, {edge}, 0, {edge}])
self.GetOutputInformation(0).Set(vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""


def get_moved(display):
    rows = get_rows(display)
    # A programmable source brings a sum of its own.
    return [builtins.sum(row[name] for row in rows) for name in ("BytesPublished", "BytesReceived")]


def create_view(simple):
    view = simple.CreateRenderView(ViewSize=[800, 600])
    view.UseFXAA = 0
    return view


def show(simple, source, view, organization):
    display = simple.Show(source, view)
    display.Representation = "DSM Ray Traced"
    display.ColorArrayName = [None, ""]
    display.DSMIsoArray = ["POINTS", "f"]
    display.DSMIsoValues = [0.9]
    display.DSMMemoryOrganization = organization
    display.DSMHostSharing = 0
    simple.ResetCamera(view)
    simple.Render(view)
    return display


def time_picture(simple, view):
    start = time.time()
    simple.Render(view)
    return time.time() - start


def time_still(simple, view):
    times = []
    for number in range(10):
        view.CameraViewAngle = 30 + 1e-6 * (number % 2)
        times.append(time_picture(simple, view))
    view.CameraViewAngle = 30
    return statistics.median(times)


def play_pipeline(simple, edge, steps):
    view = create_view(simple)
    for organization in ("Object based", "Page based", "Replicated"):
        for share in SHARES:
            def get_script(step):
                return SOURCE.format(middle=0.5 * edge, edge=edge, brick=BRICK, share=share, step=step)

            source = simple.ProgrammableSource(OutputDataSetType="vtkImageData")
            source.ScriptRequestInformation = INFORMATION.format(edge=edge)
            source.Script = get_script(0)
            display = show(simple, source, view, organization)
            start, _ = get_moved(display)
            times, received = [], 0
            for step in range(1, steps):
                source.Script = get_script(step)
                simple.UpdatePipeline(proxy=source)
                times.append(time_picture(simple, view))
                received += get_moved(display)[1]
            moved = (get_moved(display)[0] - start) / (steps - 1)
            still = time_still(simple, view)
            print(json.dumps({"what": "pipeline", "organization": organization, "changed": share,
                              "moved MiB a step": round(moved / 2**20, 2),
                              "fetched MiB a step": round(received / (steps - 1) / 2**20, 2),
                              "step s": round(statistics.median(times), 4), "still s": round(still, 4),
                              "ratio": round(statistics.median(times) / still, 2)}), flush=True)
            simple.Delete(source)
            simple.Render(view)


def count_fetched(display):
    """Bricks that ranks asked for in the last frame, of files or of one another."""
    return builtins.sum(row["Misses"] - row["Joins"] + row["Prefetches"] for row in get_rows(display))


def play_files(simple, share, paths):
    view = create_view(simple)
    source = simple.DSMVolumeReader(FileName=paths)
    display = show(simple, source, view, "Object based")
    times, fetched = [], []
    for step in range(1, len(paths)):
        view.ViewTime = step
        times.append(time_picture(simple, view))
        fetched.append(count_fetched(display))
        time.sleep(2 * times[-1])  # the disk keeps up
    still = time_still(simple, view)
    print(json.dumps({"what": "files", "changed": share, "bricks fetched a step": statistics.median(fetched[2:]),
                      "step s": round(statistics.median(times[2:]), 4), "still s": round(still, 4),
                      "ratio": round(statistics.median(times[2:]) / still, 2)}), flush=True)


def write_files(build, folder, edge, steps, share):
    import h5py
    import numpy

    os.makedirs(folder)
    along = (numpy.arange(edge + 1) / (0.5 * edge) - 1) ** 2
    values = numpy.sqrt(along[:, None, None] + along[None, :, None] + along[None, None, :]).astype("f4")
    # As for a pipeline.
    at = numpy.arange(edge + 1)
    k, j, i = at[:, None, None], at[None, :, None], at[None, None, :]
    bricks = edge // BRICK
    number = i // BRICK + bricks * (j // BRICK + bricks * (k // BRICK))
    inner = (i % BRICK > 0) & (j % BRICK > 0) & (k % BRICK > 0)
    chosen = (number * 7919 % 1000 < share * 1000) & inner
    paths = []
    for step in range(steps):
        plain = os.path.join(folder, "plain.h5")
        with h5py.File(plain, "w") as file:
            file["f"] = (values + chosen * numpy.float32(0.0005 * step)).astype("f4")
        paths.append(os.path.join(folder, f"step_{step:03}.h5"))
        subprocess.run([os.path.join(build, "bin", "dsm_convert"), plain, paths[-1], "--compression", "zstd",
                        "--quiet"],
                       check=True)
        os.remove(plain)
    return paths


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("--edge", type=int, default=160, help="cells along each axis")
    parser.add_argument("--files", help="a folder for brick files; else volumes of a pipeline")
    parser.add_argument("--inside", nargs="*", help=argparse.SUPPRESS)
    options = parser.parse_args()
    plugin = os.path.join(os.path.abspath(options.build), "lib", "DSMRayTracer", "DSMRayTracer.so")
    if options.inside is not None:
        from paraview import simple

        simple.LoadPlugin(plugin, ns=vars(simple))
        if options.inside:
            play_files(simple, float(options.inside[0]), options.inside[1:])
        else:
            play_pipeline(simple, options.edge, options.steps)
        return
    folder = options.files and os.path.join(options.files, "changing_volume")

    def run(*files):
        subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", str(options.ranks), "pvbatch",
                        os.path.abspath(__file__), options.build, "--steps", str(options.steps), "--edge",
                        str(options.edge), "--inside", *files], check=True)

    if not folder:
        run()
        return
    for share in SHARES:
        try:
            run(str(share), *write_files(options.build, folder, options.edge, min(options.steps, 20), share))
        finally:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
