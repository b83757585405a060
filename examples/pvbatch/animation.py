# SPDX-License-Identifier: BSD-3-Clause
"""Plays a time series, and saves a picture of every step.

    mpirun -np 4 pvbatch animation.py --plugin DSMRayTracer.so --files step*.vti --array f \\
        --isovalues=0.5 --output frame.png

Pictures are numbered: frame.0000.png, frame.0001.png, ...
"""
import argparse
import os

from paraview import simple


def parse_numbers(text):
    """`1,2,3`. Not several words: pvbatch would take one like `-30` for an option."""
    return [float(word) for word in text.split(",")]


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--files", nargs="+", required=True, help="image data, one file per time step")
    parser.add_argument("--array", required=True)
    parser.add_argument("--isovalues", type=parse_numbers, required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--size", type=int, nargs=2, default=[512, 512])
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))
    series = simple.OpenDataFile(sorted(arguments.files))
    view = simple.CreateRenderView(ViewSize=arguments.size)
    view.OrientationAxesVisibility = 0
    display = simple.Show(series, view)
    display.Representation = "DSM Ray Traced"
    display.ColorArrayName = [None, ""]
    display.DSMIsoArray = arguments.array
    display.DSMIsoValues = arguments.isovalues
    simple.ResetCamera(view)
    animation = simple.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    simple.SaveAnimation(
        arguments.output, view, ImageResolution=arguments.size, SuffixFormat=".%04d"
    )


main()
