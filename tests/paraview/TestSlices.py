# SPDX-License-Identifier: BSD-3-Clause
"""Image data as DSM Slices, beside ParaView's Slice of the same data and its Slice filter; and the faces that clipping
cuts out of isosurfaces and volumes, beside those of its Clip filter."""

from dsm_testing import *

load_plugin()
view = create_view()
EXTENT = (2, 26, 0, 20, -3, 15)
source = image_source(
    """
image.SetExtent(piece)
image.SetSpacing(1.0, 1.2, 1.5)
image.SetOrigin(3.0, -2.0, 1.0)
i, j, k = points(piece)
add(image, i + 2.0 * j - k, 'ramp')
vectors = numpy_to_vtk(np.stack([i, j, k], axis=1), deep=True)
vectors.SetName('vectors')
image.GetPointData().AddArray(vectors)
add(image, 1.0 / (1.0 + distance(piece)), 'ball')
add(image, np.cos(3.0 * distance(piece)) + 0.01 * i, 'waves')
n = [max(piece[2 * axis + 1] - piece[2 * axis], 0) for axis in range(3)]
cells = numpy_to_vtk(np.arange(n[0] * n[1] * n[2]) % 17.0, deep=True)
cells.SetName('cells')
image.GetCellData().AddArray(cells)
""",
    EXTENT,
)
display = simple.Show(source, view)
display.ColorArrayName = [None, ""]
place_camera(view)


def show_as(kind):
    display.Representation = kind
    return render(view)


def compare(ours, theirs, what, mean=0.2, share=0.01, step=2):
    """Pictures that are the same but for a small share of pixels, at borders."""
    difference = abs(ours - theirs).max(axis=2)
    check(get_covered(theirs).mean() > 0.05, f"{what}: the reference shows something")
    check(
        difference.mean() < mean and (difference > step).mean() < share,
        f"{what}: mean difference {difference.mean():.3f}, {100 * (difference > step).mean():.2f} % differ by more "
        f"than {step}",
    )


def set_slices(x=None, y=None, z=None):
    for letter, index in zip("XYZ", (x, y, z)):
        setattr(display, f"DSMSlice{letter}", int(index is not None))
        setattr(display, f"DSMSlice{letter}Index", index or 0)


def show_filter(shown, **coloring):
    """A filter's output in the colors of the display, unlit."""
    theirs = simple.Show(shown, view)
    theirs.Representation = "Surface"
    theirs.Ambient, theirs.Diffuse = 1.0, 0.0
    theirs.ColorArrayName = list(display.ColorArrayName)
    theirs.LookupTable = display.LookupTable
    return theirs


def compare_with_filter(name, origin, normal, **bounds):
    """With the polygons of ParaView's Slice filter."""
    render(view, name)
    ours = show_as("DSM Slices")
    plane = simple.Slice(Input=source, SliceType="Plane", Triangulatetheslice=0)
    plane.SliceType.Origin, plane.SliceType.Normal = origin, normal
    simple.Hide(source, view)
    show_filter(plane)
    theirs = render(view)
    simple.SaveScreenshot(os.path.join(OUTPUT, f"{name}.Slice.png"), view)
    simple.Delete(plane)
    simple.Show(source, view)
    compare(ours, theirs, name, **bounds)


def color_by(*array):
    simple.ColorBy(display, array)
    display.RescaleTransferFunctionToDataRange(False)


first = show_as("DSM Slices")
check(list(display.ColorArrayName)[0] == "POINTS", "the first look has an array")
check([display.DSMSliceXIndex, display.DSMSliceYIndex, display.DSMSliceZIndex] == [12, 10, 9],
      "slices begin in the middle")
check(get_covered(first).mean() > 0.1, "the first look shows something")
check(sum(row["Tiles"] for row in get_rows(display)) > 0, "statistics are those of the slices")
color_by("POINTS", "waves")
render(view, "FirstLook")

# Of a linear function, polygons have the same values.
color_by("POINTS", "ramp")
set_slices(z=5)
compare_with_filter("Ramp", [3.0, 0.0, 1.0 + 1.5 * (-3 + 5)], [0.0, 0.0, 1.0])

# What is selected lies on the slice.
before = render(view)
simple.SelectSurfacePoints(Rectangle=[130, 100, 170, 140], View=view)
extract = simple.ExtractSelection(Input=source)
extract.UpdatePipeline()
selected = extract.GetDataInformation().GetNumberOfPoints()
bounds = extract.GetDataInformation().GetBounds()
check(selected > 5, f"{selected} points of a slice are selected")
check(abs(bounds[4] - 4.0) < 1e-6 and abs(bounds[5] - 4.0) < 1e-6, f"they lie on it, in {bounds}")
simple.Delete(extract)
simple.ClearSelection(source)
check_equal(render(view), before, "after a selection")
set_slices(x=24)
compare_with_filter("RampAtBorder", [3.0 + 26.0, 0.0, 0.0], [1.0, 0.0, 0.0])
set_slices()
display.DSMSlicePlane = 1
display.DSMSliceOrigin, display.DSMSliceNormal = [17.0, 10.0, 10.0], [0.4, 0.3, 0.8]
compare_with_filter("RampOblique", [17.0, 10.0, 10.0], [0.4, 0.3, 0.8])
color_by("POINTS", "waves")
compare_with_filter("WavesOblique", [17.0, 10.0, 10.0], [0.4, 0.3, 0.8], step=8)
color_by("CELLS", "cells")
compare_with_filter("CellsOblique", [17.0, 10.0, 10.0], [0.4, 0.3, 0.8], mean=1.0, share=0.04)
display.DSMSlicePlane = 0

# ParaView's own representation has a pixel of a texture for each sample, so it is up to half a cell away. From 6.0
# on, it does not interpolate between them, either.
interpolates = simple.GetParaViewVersion() < (6, 0)
color_by("POINTS", "waves")
for axis, index in ((0, 12), (1, 3), (2, 18)):
    set_slices(*[index if other == axis else None for other in range(3)])
    display.DSMSliceInterpolate = int(interpolates)
    ours = render(view, f"Slice{'XYZ'[axis]}")
    display.SliceMode = ["YZ Plane", "XZ Plane", "XY Plane"][axis]
    display.Slice = index
    theirs = show_as("Slice")
    simple.SaveScreenshot(os.path.join(OUTPUT, f"Slice{'XYZ'[axis]}.Slice.png"), view)
    compare(ours, theirs, f"Slice{'XYZ'[axis]}", mean=3.0 if interpolates else 4.0, share=0.02, step=48)
    display.Representation = "DSM Slices"
display.DSMSliceInterpolate = int(not interpolates)
other = render(view, "Interpolation")
check(abs(other - ours).mean() > 0.2, "interpolation is seen")
display.DSMSliceInterpolate = 1

color_by("POINTS", "vectors", "Y")
render(view, "Component")
color_by("POINTS", "vectors", "Magnitude")
render(view, "Magnitude")
color_by("POINTS", "waves")

set_slices(x=4, y=10)
display.DSMSliceXIndices = [12, 20]
several = render(view, "Several")
display.DSMSliceXIndices = []
check(get_covered(several).sum() > 1.2 * get_covered(render(view)).sum(), "further slices are seen")
opacity = simple.GetOpacityTransferFunction("waves")
opaque = render(view)
display.DSMSliceOpacityFromMap = 1
check(abs(render(view, "OpacityFromMap") - opaque).mean() > 1.0, "slices have the opacities of the map")
display.DSMSliceOpacityFromMap = 0
display.DSMSliceLighting = 1
check(abs(render(view, "Lit") - opaque).mean() > 1.0, "slices are lit")
display.DSMSliceLighting = 0
display.DSMClip = 1
display.DSMClipOrigin, display.DSMClipNormal = [17.0, 10.0, 10.0], [0.3, 0.0, 1.0]
check(get_covered(render(view, "Clipped")).sum() < 0.8 * get_covered(opaque).sum(), "slices are clipped")
display.DSMClip = 0
with Messages() as messages:
    set_slices(x=99)
    nothing = render(view)
    check(get_ranks() > 1 or "Slice 99 along x is outside the volume" in messages.text, "a slice outside is reported")
check(not get_covered(nothing).any(), "and not shown")
set_slices()
check(not get_covered(render(view)).any(), "without slices, nothing is shown")
color = list(display.ColorArrayName)
display.ColorArrayName = [None, ""]
set_slices(z=9)
display.DiffuseColor = [0.2, 0.8, 0.4]
plain = render(view, "Plain")
check(len(numpy.unique(plain[get_covered(plain)], axis=0)) < 80, "without an array, slices have one color")
display.ColorArrayName = color

# The faces that a plane cuts out of an isosurface and of a volume.
color_by("POINTS", "ramp")
display.DSMIsoArray = ["POINTS", "ball"]
display.DSMIsoValues = [0.62]
display.Representation = REPRESENTATION
display.Ambient, display.Diffuse = 1.0, 0.0
display.DSMClip = 1
display.DSMClipOrigin, display.DSMClipNormal = [17.0, 10.0, 10.0], [-0.4, -0.3, -0.8]
simple.GetActiveCamera().Zoom(1.5)
hollow = render(view)
display.DSMCap = 1
ours = render(view, "Cap")
check(abs(ours - hollow).mean() > 1.0, "the cap is seen")
half = simple.Clip(Input=source, ClipType="Plane", Invert=0)
half.ClipType.Origin, half.ClipType.Normal = [17.0, 10.0, 10.0], [-0.4, -0.3, -0.8]
solid = simple.Clip(Input=half, ClipType="Scalar", Scalars=["POINTS", "ball"], Value=0.62, Invert=0)
simple.Hide(source, view)
show_filter(solid)
theirs = render(view)
simple.SaveScreenshot(os.path.join(OUTPUT, "Cap.Clip.png"), view)
simple.Hide(solid, view)
simple.Show(source, view)
compare(ours, theirs, "Cap", mean=0.5, step=16, share=0.02)
display.DSMCapSide = "Values Below"
below = render(view, "CapBelow")
display.DSMCapSide = "Whole Face"
whole = render(view, "CapWhole")
check(get_covered(below).sum() > 2 * get_covered(ours).sum(), "values below are around those above")
check(abs(whole - below).mean() > 0.1, "the whole face covers what it is cut from")
display.DSMCropping = 1
display.DSMCroppingBox = [9.0, 26.0, 2.0, 15.0, 0.0, 30.0]
render(view, "CapOfBox")
display.DSMCropping = 0

color_by("POINTS", "waves")
display.Representation = "DSM Volume"
# ParaView's default counts the cells of all ranks, which all have the whole here
display.ScalarOpacityUnitDistance = 1.7
display.DSMCapOpacityFromMap = 0
opacity.Points = [-2.0, 0.0, 0.5, 0.0, 2.0, 0.0, 0.5, 0.0]
ours = render(view, "CapOfVolume")
display.UseSeparateOpacityArray, display.OpacityArrayName = 1, ["POINTS", "ball"]
display.DSMCapOpacityFromMap = 1
other = render(view, "CapOfOpacityArray")
check_equal(other, ours, "with an opacity array, the face has the colors of the coloring array, and is opaque")
display.UseSeparateOpacityArray, display.DSMCapOpacityFromMap = 0, 0
display.DSMClip = 0
display.Representation = "DSM Slices"
set_slices()
display.DSMSlicePlane = 1
display.DSMSliceOrigin, display.DSMSliceNormal = [17.0, 10.0, 10.0], [-0.4, -0.3, -0.8]
compare(ours, render(view), "the face of a volume without opacity is a slice", mean=0.05)
display.DSMClip = 1
display.Representation = "DSM Volume"
opacity.Points = [-1.0, 0.1, 0.5, 0.0, 1.0, 0.6, 0.5, 0.0]
hollow = ours
display.DSMCapOpacityFromMap = 1
check(abs(render(view, "CapOfMedium") - hollow).mean() > 1.0, "the face has the opacities of the map")
