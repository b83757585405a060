# SPDX-License-Identifier: BSD-3-Clause
"""Colour: solid, by the isosurface array, by another array, by components; the colour map live."""

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0  # it would mix colours along the edges
source = image_source("""
image.SetExtent(piece)
i, j, k = points(piece)
add(image, np.stack([i, j, k], axis=1), 'position')
add(image, i, 'i')
add(image, distance(piece))
""")
display = show(source, view, [0.8], "f")
place_camera(view, (0.0, 0.0, 1.0))
solid = render(view, "Solid")
middle = solid.shape[0] // 2


def color_by(array, component=None):
    simple.ColorBy(display, ("POINTS", array) + ((component,) if component else ()))
    display.RescaleTransferFunctionToDataRange(False, True)
    # On: the colour is the map's, without shading that would blur the comparison.
    return simple.GetColorTransferFunction(array)


def get_ends(pixels):
    """Mean colours of the left and of the right half of the surface."""
    covered = get_covered(pixels)
    left, right = covered.copy(), covered.copy()
    half = pixels.shape[1] // 2
    left[:, half:] = False
    right[:, :half] = False
    return pixels[left].mean(axis=0), pixels[right].mean(axis=0)


display.DiffuseColor = display.AmbientColor = [0.0, 1.0, 0.0]
green = render(view, "Green")
check((green[get_covered(green)][:, 0] < 3).all(), "solid green has no red")
display.Diffuse = 0.0
display.Ambient = 1.0
flat = render(view, "Ambient")
check((flat[get_covered(flat)] == [0, 255, 0]).all(), "ambient light alone shows the plain colour")

table = color_by("i")
table.ApplyPreset("Grayscale", True)
table.RescaleTransferFunction(0.0, 24.0)
gray = render(view, "ByI")
left, right = get_ends(gray)
check(left[0] + 40 < right[0], f"it grows brighter to the right: {left} {right}")
table.InvertTransferFunction()
left, right = get_ends(render(view, "Inverted"))
check(left[0] > right[0] + 40, "the inverted map is followed at once")
table.InvertTransferFunction()
table.RescaleTransferFunction(100.0, 200.0)
low = render(view)
check((low[get_covered(low)] == low[low.shape[0] // 2, middle]).all() or
      low[get_covered(low)].max() < 30, "below the range, all has the first colour")
table.UseBelowRangeColor = 1
table.BelowRangeColor = [1.0, 0.0, 0.0]
below = render(view, "BelowRange")
check((below[get_covered(below)] == [255, 0, 0]).all(), "the colour below the range")
table.UseBelowRangeColor = 0

table.RescaleTransferFunction(0.0, 24.0)
surface = flying_edges(source, [0.8])
simple.Hide(source, view)
# The same colours as ParaView gives to triangles with interpolated values of the array.
probe = simple.ResampleWithDataset(SourceDataArrays=source, DestinationMesh=surface)
triangles = simple.Show(probe, view)
simple.ColorBy(triangles, ("POINTS", "i"))
triangles.Diffuse, triangles.Ambient = 0.0, 1.0
table.RescaleTransferFunction(0.0, 24.0)
reference = render(view)
both = get_covered(reference) & get_covered(gray)
check(both.sum() > 0.1 * both.size, "the triangles are drawn")
difference = abs(reference - gray)[both].mean()
check(difference < 2.0, f"colours as on triangles: mean difference {difference:.2f}")
simple.Delete(probe)
simple.Delete(surface)
simple.Show(source, view)

table = color_by("position", "Magnitude")
table.ApplyPreset("Grayscale", True)
render(view, "Magnitude")
for component, name in enumerate("XYZ"):
    table = color_by("position", name)
    table.RescaleTransferFunction(0.0, 24.0)
    pixels = render(view, "Component" + name)
    left, right = get_ends(pixels)
    if component == 0:
        check(left[0] + 40 < right[0], "component X grows to the right")
    else:
        check(abs(left[0] - right[0]) < 10, f"component {name} does not")

color_by("f").ApplyPreset("Cool to Warm", True)
own = render(view, "ByIsosurfaceArray")
colors = own[get_covered(own)]
check((abs(colors - colors[0]).max(axis=0) <= 3).all(), "its own array has one value on the surface")

display.ColorArrayName = [None, ""]
check_equal(render(view), flat, "solid again")
