# SPDX-License-Identifier: BSD-3-Clause
"""Clipping planes and cropping boxes: what is left is what clipping the triangles leaves."""

import math

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0
source = image_source("image.SetExtent(piece)\nadd(image, distance(piece))\n")
traced = show(source, view, [0.5, 0.8], "f")
surface = flying_edges(source, [0.5, 0.8])
place_camera(view)


def compare(what, clips, **place):
    """One rank's picture with the triangles, clipped by filters, in a place."""
    transform(traced, **place)
    picture = render(view, what.replace(" ", "_"))
    if get_ranks() > 1:
        return picture
    simple.Hide(source, view)
    clipped = surface
    for parameters in clips:
        clipped = simple.Clip(clipped, ClipType="Plane", Crinkleclip=0, Invert=0)
        clipped.ClipType.Origin, clipped.ClipType.Normal = parameters
    display = show_surface(clipped, view)
    transform(display, **place)
    reference = render(view)
    simple.SaveScreenshot(os.path.join(OUTPUT, f"{what}.triangles.{get_ranks()}.png"), view)
    simple.Hide(clipped, view)
    simple.Show(source, view)
    check_same_surface(picture, reference, what)
    return picture


whole = render(view)
check(list(traced.DSMClipOrigin) == [12.0, 12.0, 12.0], "the plane starts in the middle")
check(list(traced.DSMCroppingBox) == [0.0, 24.0] * 3, "and the box as large as the data")
traced.DSMCropping = 1
check_equal(render(view), whole, "which hides nothing", 0)
traced.DSMCropping = 0

normal = [0.2, 0.1, -1.0]
traced.DSMClip = 1
traced.DSMClipOrigin = [12.0, 12.0, 13.0]
traced.DSMClipNormal = normal
plane = ([12.0, 12.0, 13.0], normal)
clipped = compare("clipped volume", [plane])
check((abs(clipped - whole) > 10).any(axis=2).mean() > 0.05, "and it looks different")
traced.DSMCropping = 1
traced.DSMCroppingBox = [3.0, 24.0, 0.0, 14.5, 0.0, 24.0]
compare("clipped and cropped", [plane, ([3.0, 0, 0], [1, 0, 0]), ([0, 14.5, 0], [0, -1, 0])])

# The box moves with the dataset, the plane does not.
traced.DSMClip = 0
compare("cropped and moved", [([3.0, 0, 0], [1, 0, 0]), ([0, 14.5, 0], [0, -1, 0])],
        translation=(2.0, -3.0, 1.0), orientation=(0.0, 20.0, 0.0))
transform(traced)

# What ParaView's box in the view does with it: it grows, turns and moves from the origin.
traced.DSMCroppingScale = [0.5, 1.0, 1.0]
traced.DSMCroppingRotation = [0.0, 0.0, 30.0]
traced.DSMCroppingPosition = [6.0, -3.0, 0.0]
cosine, sine = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))


def turn(x, y):
    return [6.0 + cosine * x - sine * y, -3.0 + sine * x + cosine * y, 0.0]


compare("cropped to a box that was moved", [
    (turn(1.5, 0.0), [cosine, sine, 0.0]), (turn(12.0, 0.0), [-cosine, -sine, 0.0]),
    (turn(0.0, 0.0), [-sine, cosine, 0.0]), (turn(0.0, 14.5), [sine, -cosine, 0.0])])
traced.DSMCroppingUsesBox = 0
traced.DSMCroppingPosition, traced.DSMCroppingRotation = [3.0, 0.0, 0.0], [0.0, 0.0, 0.0]
traced.DSMCroppingScale = [21.0, 14.5, 24.0]
compare("cropped to a scaled unit box", [([3.0, 0, 0], [1, 0, 0]), ([0, 14.5, 0], [0, -1, 0])])
traced.DSMCropping = 0
check_equal(render(view), whole, "and whole again", 0)
simple.Hide(source, view)

# A mesh.
ball = simple.Sphere(Radius=10.0, Center=[12.0, 12.0, 12.0], ThetaResolution=60, PhiResolution=60)
traced = source = None
mesh = simple.Show(ball, view)
mesh.Representation = REPRESENTATION
mesh.ColorArrayName = [None, ""]
mesh.DSMClip = 1
mesh.DSMClipOrigin = [12.0, 12.0, 15.0]
mesh.DSMClipNormal = normal
mesh.DSMCropping = 1
mesh.DSMCroppingBox = [0.0, 24.0, 5.0, 24.0, 0.0, 24.0]
source, traced, surface = ball, mesh, ball
compare("clipped mesh", [([12.0, 12.0, 15.0], normal), ([0, 5, 0], [0, 1, 0])])
simple.Hide(ball, view)

# A domain that moves: a box, a plane and slices that the user has not placed are in each step what they are in the
# first one; what the user has placed stays, and says so when nothing is left.
moving = image_source("""
time = request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()) or 0.0
image.SetExtent(piece)
image.SetOrigin(30.0 * time, 0.0, 0.0)
add(image, distance(piece))
""")
moving.ScriptRequestInformation += TIME_STEPS
moving.UpdatePipelineInformation()
display = show(moving, view, [0.7], "f", DSMCropping=1, DSMClip=1)
place_camera(view)
position, focus = list(view.CameraPosition), list(view.CameraFocalPoint)


def look(step):
    view.ViewTime = step
    for name, place in (("CameraPosition", position), ("CameraFocalPoint", focus)):
        setattr(view, name, [place[0] + 30.0 * step, *place[1:]])
    return render(view)


for way in (REPRESENTATION, "DSM Volume", "DSM Slices"):
    display.SetRepresentationType(way)
    render(view)
    with Messages() as messages:
        pictures = [look(step) for step in (0.0, 2.0, 1.0)]
    check(get_covered(pictures[0]).mean() > 0.01, f"{way}: half of it is there")
    check(abs(pictures[0] - pictures[1]).max() <= 2 and abs(pictures[0] - pictures[2]).max() <= 2, "in each step")
    check("hides" not in messages.text, f"and nothing is amiss: {messages.text}")
check(list(display.DSMCroppingBox) == [30.0, 54.0, 0.0, 24.0, 0.0, 24.0], f"the box is there: {display.DSMCroppingBox}")
check(list(display.DSMClipOrigin) == [42.0, 12.0, 12.0], f"and the plane: {display.DSMClipOrigin}")
display.SetRepresentationType(REPRESENTATION)
display.DSMClipOrigin = [40.0, 12.0, 12.0]
with Messages() as messages:
    check(get_covered(look(1.0)).any() and not get_covered(look(0.0)).any(), "a plane that was placed stays")
    look(0.0)
check(list(display.DSMClipOrigin) == [40.0, 12.0, 12.0], "where it was placed")
check(messages.text.count("clipping plane hides the whole dataset") == 1, f"which is said once: {messages.text}")
display.DSMClip = 0
display.DSMCroppingPosition = [50.0, 0.0, 0.0]
with Messages() as messages:
    look(2.0)
    check(not get_covered(look(0.0)).any(), "a box that was moved stays, too")
check("cropping box hides the whole dataset, which is at x 0 to 24" in messages.text, f"which is said: {messages.text}")
