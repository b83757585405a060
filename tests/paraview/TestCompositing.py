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


def compare(name, share=0.01, shading=8, with_one_rank=False):
    """The picture with our surface in place of triangles; both on this number of ranks, or the triangles
    on one rank."""
    simple.Hide(surface, view)
    simple.Show(source, view)
    with_ours = render(view)
    simple.Hide(source, view)
    show_surface(surface, view).Opacity = traced.Opacity
    with_triangles = render(view)
    kept = os.path.join(OUTPUT, f"{name}.triangles.npy")
    if with_one_rank and get_ranks() == 1:
        numpy.save(kept, with_triangles)
    elif with_one_rank:
        with_triangles = numpy.load(kept)
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

# ParaView's own ambient occlusion works on depths, places and normals in the picture.
view.UseFXAA = 0
view.UseAmbientOcclusion = 1
compare("AmbientOcclusionOfTheScreen", 0.001, 1.0)
view.UseAmbientOcclusion = 0

# Translucent itself: whatever lies behind its surfaces, and between them, shows through, in order.
view.UseFXAA = 0
traced.Opacity = 0.4
traced.DSMIsoValues = [0.5, 0.8]
simple.Delete(surface)
surface = flying_edges(source, [0.5, 0.8])
compare("TranslucentOverSlice", 0.001, 0.3)
plane.Pickable = 0
compare("TranslucentOverSliceThatCannotBePicked", 0.001, 0.3)
plane.Pickable = 1
plane.Opacity = 0.5
compare("TranslucentOverTranslucentSlice", 0.001, 0.3)
view.CameraParallelProjection = 1
compare("TranslucentInParallelProjection", 0.001, 0.3)
view.CameraParallelProjection = 0
plane.Opacity = 1.0
simple.Hide(slices, view)
# On several ranks ParaView 6.1, without any of ours, loses parts of an outline beside a translucent Surface.
compare("TranslucentWithOutline", 0.002, 0.3, with_one_rank=True)

simple.Hide(outline, view)
traced.Opacity = 1.0
opaque = render(view)
traced.Opacity = 0.4
pixels = render(view, "Translucent")
covered = get_covered(opaque)
check((pixels[covered] < opaque[covered]).any(axis=1).mean() > 0.99, "the background shows through")


def of_one_rank(name, pixels):
    """ParaView's own picture: on several ranks, 6.1 loses parts of what is behind translucent surfaces."""
    saved = os.path.join(OUTPUT, name + ".npy")
    if get_ranks() == 1:
        numpy.save(saved, pixels)
    return numpy.load(saved)


# A mesh of ours that is translucent, with an opaque surface in it.
simple.Hide(source, view)
ball = simple.Sphere(Radius=9.0, Center=[12.0, 12.0, 12.0], ThetaResolution=60, PhiResolution=60)
cone = simple.Cone(Center=[12.0, 12.0, 12.0], Height=14.0, Radius=4.0)
inner = show_surface(cone, view)
inner.DiffuseColor = inner.AmbientColor = [0.2, 1.0, 0.3]
pictures = []
for name in (REPRESENTATION, "Surface"):
    mesh = simple.Show(ball, view)
    mesh.ColorArrayName = [None, ""]
    mesh.Representation = name
    mesh.Opacity = 0.5
    pictures.append(render(view))
    simple.SaveScreenshot(os.path.join(OUTPUT, f"Mesh{len(pictures)}.{get_ranks()}.png"), view)
difference = abs(pictures[0] - of_one_rank("TranslucentSurface", pictures[1]))
check(get_covered(pictures[1]).mean() > 0.1, "the mesh shows")
check((difference > 30).any(axis=2).mean() < 0.002, "a translucent mesh over a surface")
check(difference.mean() < 0.3, f"which differs by {difference.mean():.2f} from Surface")

# The same by a color map that has an opacity: of a mesh, and of an isosurface.
waves = simple.Elevation(ball, LowPoint=[12.0, 3.0, 12.0], HighPoint=[12.0, 21.0, 12.0])
simple.Hide(ball, view)
pictures = []
for name in (REPRESENTATION, "Surface"):
    mesh = simple.Show(waves, view)
    mesh.Representation = name
    simple.ColorBy(mesh, ("POINTS", "Elevation"))
    simple.GetColorTransferFunction("Elevation").EnableOpacityMapping = 1
    simple.GetOpacityTransferFunction("Elevation").Points = [0, 0.1, 0.5, 0, 1, 0.7, 0.5, 0]
    pictures.append(render(view))
difference = abs(pictures[0] - of_one_rank("MappedSurface", pictures[1]))
check((difference > 30).any(axis=2).mean() < 0.002, "a mesh with mapped opacity over a surface")
check(difference.mean() < 0.3, f"which differs by {difference.mean():.2f} from Surface")
simple.Hide(waves, view)
simple.Show(source, view)
traced.Opacity = 1.0
simple.ColorBy(traced, ("POINTS", "f"))
simple.GetColorTransferFunction("f").EnableOpacityMapping = 1
simple.GetOpacityTransferFunction("f").Points = [0, 0.4, 0.5, 0, 1, 0.4, 0.5, 0]
through = render(view)
reference = os.path.join(OUTPUT, "mapped.npy")
if get_ranks() == 1:
    numpy.save(reference, through)
# Where surfaces are equally near, ranks may choose another one.
different = (abs(through - numpy.load(reference)) > 8).any(axis=2).mean()
check(different < 0.001, f"an isosurface with mapped opacity: {100 * different:.2f} % of the pixels differ")
simple.Hide(cone, view)
check((abs(render(view) - through) > 30).any(axis=2).mean() > 0.01, "the cone shows through it")
simple.Hide(source, view)
simple.Show(ball, view)

# What ParaView draws around and on the data: axes, legend, text, markers, a selection.
simple.Hide(cone, view)
view.OrientationAxesVisibility = 1
view.CenterAxesVisibility = 1
view.AxesGrid.Visibility = 1
text = simple.Text(Text="a text")
simple.Show(text, view)
for opacity in (1.0, 0.5):
    pictures = []
    for name in (REPRESENTATION, "Surface"):
        mesh = simple.Show(ball, view)
        mesh.Representation = name
        mesh.Opacity = opacity
        simple.ColorBy(mesh, ("POINTS", "Normals", "X"))
        mesh.SetScalarBarVisibility(view, True)
        simple.Render(view)
        simple.SelectSurfaceCells(Rectangle=[120, 100, 170, 150], View=view)
        pictures.append(render(view))
        simple.SaveScreenshot(
            os.path.join(OUTPUT, f"Annotations{opacity}.{len(pictures)}.{get_ranks()}.png"), view)
        simple.ClearSelection(ball)
    # On several ranks ParaView draws the axes over a translucent Surface more than once.
    difference = abs(pictures[0] - of_one_rank(f"annotations{opacity}", pictures[1]))
    different = (difference > 60).any(axis=2).mean()
    check(different < 0.01, f"axes, legend, text and selection at opacity {opacity}: "
          f"{100 * different:.2f} % of the pixels differ, by {difference.mean():.2f} in the mean")

# What covers a pixel in part is blended with what is behind it, which may be another rank's.
view = create_view()
traced = show(source, view, [0.8], "f")
place_camera(view)
wall = simple.Plane(Origin=[-900, -900, -30], Point1=[900, -900, -30], Point2=[-900, 900, -30])
traced.DSMSamplesPerPixel = 16
view.UseFXAA = 0
pictures = []
for name in ("Surface", REPRESENTATION):
    wall_shown = simple.Show(wall, view)
    wall_shown.Representation = name
    wall_shown.Ambient, wall_shown.Diffuse = 1.0, 0.0
    wall_shown.AmbientColor = wall_shown.DiffuseColor = [1.0, 1.0, 0.2]
    pictures.append(render(view, f"Wall{name.replace(' ', '')}"))
different = abs(pictures[0] - pictures[1]).max(axis=2)
check((different > 0).mean() < 0.01, f"{100 * (different > 0).mean():.2f} % of the pixels differ from a traced wall's")
check(different.max() <= 3, f"by at most {different.max()}")
