# SPDX-License-Identifier: BSD-3-Clause
"""An image database (Cinema, specification D): pictures of isosurfaces from many sides, and data.csv.

    mpirun -np 4 pvbatch cinema.py --plugin DSMRayTracer.so --output field.cdb \\
        --file field.vti --array f --isovalues=0.3,0.5 --phi=0,45,90,135 --theta=-30,0,30

A new isovalue extracts nothing, so each picture costs one frame. Cinema's viewers open the folder.
"""
import argparse
import csv
import os

from paraview import servermanager, simple


def parse_numbers(text):
    """`1,2,3`. Not several words: pvbatch would take one like `-30` for an option."""
    return [float(word) for word in text.split(",")]


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--plugin", required=True, type=os.path.abspath)
    parser.add_argument("--output", required=True, help="folder of the database, named *.cdb")
    parser.add_argument("--file", help="image data; without it, a noisy sphere is generated")
    parser.add_argument("--array", default="f")
    parser.add_argument("--isovalues", type=parse_numbers, default=[0.3, 0.5])
    parser.add_argument("--phi", type=parse_numbers, default=[0, 90, 180, 270],
                        help="degrees around the vertical axis")
    parser.add_argument("--theta", type=parse_numbers, default=[-30, 0, 30],
                        help="degrees above the horizon")
    parser.add_argument("--size", type=int, nargs=2, default=[512, 512])
    return parser.parse_args()


def open_input(arguments):
    if arguments.file:
        return simple.OpenDataFile(arguments.file)
    return simple.DSMSampleVolume(Dimensions=[64, 64, 64])


def main():
    arguments = parse_arguments()
    simple.LoadPlugin(arguments.plugin, remote=False, ns=vars(simple))
    os.makedirs(arguments.output, exist_ok=True)
    view = simple.CreateRenderView(ViewSize=arguments.size)
    view.OrientationAxesVisibility = 0
    display = simple.Show(open_input(arguments), view)
    display.Representation = "DSM Ray Traced"
    display.ColorArrayName = [None, ""]
    display.DSMIsoArray = arguments.array
    view.CameraViewUp = [0, 1, 0]
    view.CameraPosition = [0, 0, 1]
    view.CameraFocalPoint = [0, 0, 0]
    simple.ResetCamera(view)
    camera = view.GetActiveCamera()
    rows = []
    for phi in arguments.phi:
        for theta in arguments.theta:
            camera.Azimuth(phi)
            camera.Elevation(theta)
            for isovalue in arguments.isovalues:
                display.DSMIsoValues = [isovalue]
                name = f"phi{phi:g}_theta{theta:g}_isovalue{isovalue:g}.png"
                simple.SaveScreenshot(os.path.join(arguments.output, name), view)
                rows.append([phi, theta, isovalue, name])
            camera.Elevation(-theta)
            camera.Azimuth(-phi)
    if servermanager.vtkProcessModule.GetProcessModule().GetPartitionId() == 0:
        with open(os.path.join(arguments.output, "data.csv"), "w", newline="") as table:
            csv.writer(table).writerows([["phi", "theta", "isovalue", "FILE"], *rows])


main()
