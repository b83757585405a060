# SPDX-License-Identifier: BSD-3-Clause
"""Times a new isovalue to picture: the DSM ray tracer beside ParaView's Contour, in one run.

    pvbatch new_isovalue.py --plugin DSMRayTracer.so [--size 512] [--kind sphere|mixing_layer]
                            [--repeat 5] [--threads 0] [--json FILE]

Prints seconds for both (the median over the isovalues) and their ratio.
"""
import argparse
import json
import os

from measuring import take_picture, time_isovalues
from paraview import simple

KINDS = {"sphere": (0, "f", 0.5, 0.05), "mixing_layer": (1, "entropy", 100.0, 10.0)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--kind", choices=sorted(KINDS), default="sphere")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--json", default="")
    arguments = parser.parse_args()
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))
    kind, array, isovalue, step = KINDS[arguments.kind]
    isovalues = [isovalue + step * (index % 5 - 2) / 5 for index in range(arguments.repeat + 1)]

    source = simple.DSMSampleVolume(Kind=kind, Dimensions=[arguments.size] * 3)
    source.UpdatePipeline()
    view = simple.CreateRenderView()
    view.ViewSize = [512, 512]
    view.OrientationAxesVisibility = 0
    ours = simple.Show(source, view)
    ours.Representation = "DSM Ray Traced"
    ours.ColorArrayName = [None, ""]
    ours.DSMIsoArray = array
    ours.DSMThreads = arguments.threads
    simple.ResetCamera(view)

    def set_ours(value):
        ours.DSMIsoValues = [value]

    set_ours(isovalues[0])
    take_picture(view)  # makes bricks
    traced = time_isovalues(view, set_ours, isovalues[1:])

    ours.Visibility = 0
    contour = simple.Contour(Input=source, ContourBy=["POINTS", array], Isosurfaces=[isovalue])
    contour.ComputeScalars = 0
    theirs = simple.Show(contour, view)
    theirs.ColorArrayName = [None, ""]

    def set_theirs(value):
        contour.Isosurfaces = [value]

    set_theirs(isovalues[0])
    take_picture(view)
    contoured = time_isovalues(view, set_theirs, isovalues[1:])
    result = {
        "volume": f"{arguments.kind}:{arguments.size}:float",
        "picture": "512x512",
        "dsm_seconds": traced,
        "contour_seconds": contoured,
        "contour_triangles": contour.GetDataInformation().GetNumberOfCells(),
        "ratio": traced / contoured,
    }
    print(json.dumps(result, indent=2))
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=2)


main()
