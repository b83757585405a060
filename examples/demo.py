# SPDX-License-Identifier: BSD-3-Clause
"""The main job, for pvbatch on any number of ranks: an isosurface, ray traced, to a picture.

See demo.sh, which starts it. Without --file a noisy sphere is generated, each rank its own piece.
"""
import argparse
import json
import os
import sys
import time

from paraview import servermanager, simple

START = time.perf_counter()


def say(text):
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        print(f"[{time.perf_counter() - START:6.1f} s] {text}", flush=True)


class DemoError(Exception):
    """An error in the user's request."""


def open_input(arguments):
    """The source, the point array and the isovalue."""
    if not arguments.file:
        say(f"generating a noisy sphere of {arguments.size}^3 samples; each rank generates its own piece")
        source = simple.DSMSampleVolume(Dimensions=[arguments.size] * 3)
        source.UpdatePipeline()
        return source, "f", 0.5
    say(f"reading {arguments.file}")
    source = simple.OpenDataFile(arguments.file)
    if source is None:
        raise DemoError(f"ParaView has no reader for {arguments.file}")
    source.UpdatePipeline()
    data = source.GetDataInformation()
    if not data.DataInformation.IsDataStructured() and not data.IsCompositeDataSet():
        raise DemoError(f"{arguments.file} is a {data.GetDataSetTypeAsString()}, not image data. Resample it "
             "to an image (filter Resample To Image) and save the image.")
    names = [array.Name for array in source.PointData]
    if not names:
        raise DemoError(f"{arguments.file} has no point arrays. If it has cell arrays, apply Cell "
             "Data to Point Data and save the result.")
    array = arguments.array or names[0]
    if array not in names:
        raise DemoError(f"{arguments.file} has no point array {array}; it has: {', '.join(names)}")
    return source, array, arguments.isovalue


def print_statistics(representation):
    """Prints each rank's memory use, and its counters for the last frame."""
    representation.SMProxy.UpdatePropertyInformation()
    seconds = representation.SMProxy.GetProperty("DSMFrameTime").GetElement(0)
    ranks = json.loads(representation.SMProxy.GetProperty("DSMStatistics").GetElement(0))
    pixels = 1024 * 768
    say(f"frame time {1000 * seconds:.1f} ms ({pixels / seconds / 1e6:.2f} million rays/s)")
    columns = [("rank", "Rank", 1), ("threads", "Threads", 1), ("MiB resident", "BytesResident", 2**20),
               ("MiB cached", "BytesCached", 2**20), ("accesses", "Accesses", 1), ("hits", "Hits", 1),
               ("misses", "Misses", 1), ("MiB received", "BytesReceived", 2**20), ("tiles", "Tiles", 1)]
    print(" ".join(f"{title:>12}" for title, _, _ in columns))
    for rank in ranks:
        cells = [f"{rank[key] / unit:.1f}" if unit > 1 else str(rank[key]) for _, key, unit in columns]
        print(" ".join(f"{cell:>12}" for cell in cells))


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--output", default="demo.png")
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--file", default="")
    parser.add_argument("--isovalue", type=float)
    parser.add_argument("--array", default="")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))

    source, array, isovalue = open_input(arguments)
    view = simple.CreateRenderView()
    view.ViewSize = [1024, 768]
    representation = simple.Show(source, view)
    representation.Representation = "DSM Ray Traced"
    representation.ColorArrayName = [None, ""]
    representation.DSMIsoArray = array
    representation.DSMIsoValues = [isovalue]
    # As if each rank had a host of its own; else the data, which fit here, would be replicated.
    representation.DSMMemoryOrganization = "Object based"
    representation.DSMHostSharing = 0
    simple.ResetCamera(view)
    camera = simple.GetActiveCamera()
    camera.Azimuth(30)
    camera.Elevation(20)
    camera.Dolly(1.4)
    view.CameraViewUp = camera.GetViewUp()
    say("cutting the volume into bricks and tracing the first frame")
    simple.Render(view)
    say("tracing a second frame with warm caches")
    simple.Render(view)
    simple.SaveScreenshot(arguments.output, view)
    say(f"the picture is {arguments.output}")
    print_statistics(representation)


try:
    main()
except DemoError as error:
    # Not an exit code: mpirun would kill the other ranks, noisily. demo.sh sees that there is no
    # picture.
    print(f"error: {error}", file=sys.stderr, flush=True)
