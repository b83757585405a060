# SPDX-License-Identifier: BSD-3-Clause
"""Ray traced surfaces among ordinary ones: cut by depth, under and over translucent ones."""

from dsm_testing import *

load_plugin()
view = create_view()
source = image_source("image.SetExtent(piece)\nadd(image, distance(piece))\n")
traced = show(source, view, [0.8], "f")
surface = flying_edges(source, [0.8])
outline = simple.Outline(source)
slices = simple.Slice(source)
slices.SliceType.Origin = [12.0, 12.0, 12.0]
slices.SliceType.Normal = [1.0, 0.0, 0.3]


def compare(name, share=0.01, shading=8):
    """The picture with our surface in place of triangles; both on this number of ranks."""
    simple.Hide(surface, view)
    simple.Show(source, view)
    with_ours = render(view)
    simple.Hide(source, view)
    show_surface(surface, view)
    with_triangles = render(view)
    different = (abs(with_ours - with_triangles) > 60).any(axis=2).mean()
    check(different <= share, f"{name}: {100 * different:.2f} % of the pixels differ")
    mean = abs(with_ours - with_triangles).mean()
    check(mean < shading, f"{name}: mean difference {mean:.2f}")
    simple.Hide(surface, view)
    simple.Show(source, view)
    simple.SaveScreenshot(os.path.join(OUTPUT, f"{name}.{get_ranks()}.png"), view)


show_surface(outline, view)
plane = show_surface(slices, view)
plane.DiffuseColor = plane.AmbientColor = [1.0, 0.2, 0.2]
place_camera(view)
compare("SliceThroughSurface")

view.CameraParallelProjection = 1
compare("SliceInParallelProjection")
view.CameraParallelProjection = 0

plane.Opacity = 0.5
compare("TranslucentSlice")
view.UseFXAA = 0
compare("TranslucentSliceWithoutFXAA")
view.UseFXAA = 1
plane.Opacity = 1.0

view.BackgroundColorMode = "Gradient"
view.Background2 = [0.6, 0.6, 0.9]
compare("GradientBackground")
view.BackgroundColorMode = "Single Color"

# Translucent itself: what is behind shows through, on one rank and on several.
simple.Hide(slices, view)
simple.Hide(outline, view)
opaque = render(view)
traced.Opacity = 0.4
pixels = render(view, "Translucent")
covered = get_covered(opaque)
check((pixels[covered] < opaque[covered]).any(axis=1).mean() > 0.99, "the background shows through")
if get_ranks() == 1:
    # Several ranks see through to what they have themselves, only.
    simple.Show(slices, view)
    red = render(view, "TranslucentOverSlice") - pixels
    check((red[covered][:, 0] > 20).mean() > 0.2, "and so does the slice behind it")
traced.Opacity = 1.0
