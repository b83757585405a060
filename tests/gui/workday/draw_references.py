# SPDX-License-Identifier: BSD-3-Clause
"""Run by pvbatch as `draw_references.py PLUGIN FOLDER`: draws what the states of a workday's steps show with
representations of ParaView's own: a Contour of the same isovalues, or the Surface of a mesh."""

import json
import os
import sys

from paraview import simple

PLUGIN, FOLDER = sys.argv[1:]
TRACED = "DSM Ray Traced"
# ParaView 5.13 calls Translation what was Position.
LOOK = ("ColorArrayName", "LookupTable", "AmbientColor", "DiffuseColor", "Specular", "SpecularColor", "SpecularPower",
        "Opacity", "Orientation", "Scale", "Position", "Translation", "Origin", "Interpolation",
        "InterpolateScalarsBeforeMapping")


def clip_like(display, source):
    """Clips what is shown as the display clips; before its transform, which the steps do not combine with this."""
    if display.DSMClip:
        source = simple.Clip(Input=source, ClipType="Plane", Invert=0)
        source.ClipType.Origin = display.DSMClipOrigin
        source.ClipType.Normal = display.DSMClipNormal
    if display.DSMCropping:
        box = display.DSMCroppingBox
        source = simple.Clip(Input=source, ClipType="Box", Invert=1)
        source.ClipType.Position = [box[0], box[2], box[4]]
        source.ClipType.Length = [box[1] - box[0], box[3] - box[2], box[5] - box[4]]
    return source


def show_contour(display, view):
    values = list(display.DSMIsoValues) or [display.DSMIsoValue]
    array = display.SMProxy.GetProperty("DSMIsoArray").GetElement(4)
    contour = simple.Contour(Input=display.Input, ContourBy=["POINTS", array], Isosurfaces=values)
    other = simple.Show(clip_like(display, contour), view)
    other.Representation = "Surface"
    for name in filter(display.SMProxy.GetProperty, LOOK):
        other.SMProxy.GetProperty(name).Copy(display.SMProxy.GetProperty(name))
    other.SMProxy.UpdateVTKObjects()
    display.Visibility = 0


def show_surface(display, view):
    edges = display.DSMShowEdges
    display.Representation = "Surface With Edges" if edges else "Surface"


def replace(view):
    for display in list(view.Representations):
        if not display.GetProperty("Representation") or display.Representation != TRACED or not display.Visibility:
            continue
        if display.SMProxy.GetXMLName() == "UniformGridRepresentation":
            show_contour(display, view)
        else:
            show_surface(display, view)


def main():
    simple.LoadPlugin(PLUGIN, remote=False, ns=globals())
    with open(os.path.join(FOLDER, "notes.jsonl"), encoding="utf-8") as text:
        notes = [json.loads(line) for line in text]
    for entry in notes:
        state = os.path.join(FOLDER, f"{entry['number']:02}.pvsm")
        if not os.path.exists(state):
            continue
        simple.ResetSession()
        simple.LoadState(state)
        for index, view in enumerate(simple.GetRenderViews()):
            view.ViewSize = entry["sizes"][index]
            replace(view)
            simple.Render(view)
            name = os.path.join(FOLDER, f"{entry['number']:02}.{index}.reference.png")
            simple.SaveScreenshot(name, view, ImageResolution=entry["sizes"][index])


main()
