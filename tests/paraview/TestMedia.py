# SPDX-License-Identifier: BSD-3-Clause
"""DSM Volume: what ParaView's Volume shows, the same picture on any number of ranks, and what else the view shows in
it."""

import numpy as np
from dsm_testing import *

load_plugin()
view = create_view()
source = image_source(
    """
image.SetExtent(piece)
add(image, np.cos(3.0 * distance(piece)), 'waves')
add(image, distance(piece), 'ways')
i, j, k = points(piece)
near = 1.0 / (1.0 + distance(piece))
for name, parts in {
    'x2': [np.sin(i / 4.0) * np.sin(j / 5.0), near],
    'x3': [i, j, k],
    'x4bytes': [(10.0 * i).astype(np.uint8), (10.0 * j).astype(np.uint8), (10.0 * k).astype(np.uint8),
                (255.0 - 12.0 * distance(piece)).clip(0.0, 255.0).astype(np.uint8)],
    'x4': [i / 24.0, j / 24.0, k / 24.0, near],
}.items():
    several = numpy_to_vtk(np.stack(parts, axis=1), deep=True)
    several.SetName(name)
    image.GetPointData().AddArray(several)
"""
)
display = simple.Show(source, view)
display.ColorArrayName = [None, ""]
place_camera(view)


def show_as(kind):
    display.Representation = kind
    return render(view)


def compare(name, mean=1.0, largest=60):
    """With Volume, which ParaView draws alike on one rank only."""
    ours = show_as("DSM Volume")
    if get_ranks() == 1:
        theirs = show_as("Volume")
        simple.SaveScreenshot(os.path.join(OUTPUT, f"{name}.Volume.png"), view)
        difference = abs(ours - theirs)
        check(difference.mean() < mean, f"{name}: the mean difference from Volume is {difference.mean():.2f}")
        check(difference.max() < largest, f"{name}: the largest difference from Volume is {difference.max()}")
    display.Representation = "DSM Volume"
    render(view, name)


chosen = show_as("DSM Volume")
check(list(display.ColorArrayName) == ["POINTS", "waves"], "the first look has an array")
check(get_covered(chosen).mean() > 0.1, "the first look shows something")
# ParaView's default counts the cells of all ranks, which all have the whole here.
display.ScalarOpacityUnitDistance = 1.7
compare("FirstLook")

# As Volume, which shows nothing without an array, or without a box of a two-dimensional function; here with a message.
expected = show_as("DSM Volume")
for name, value, before, text in (("ColorArrayName", [None, ""], ["POINTS", "waves"], "No array colors"),
                                  ("UseTransfer2D", 1, 0, "has no box")):
    for times in (1, 0):
        with Messages() as messages:
            setattr(display, name, value)
            nothing = render(view)
        check(get_ranks() > 1 or messages.text.count(text) == times, f"{name} is reported {times} times")
    setattr(display, name, before)
    check(not get_covered(nothing).any(), f"{name}: nothing is seen")
check_equal(render(view), expected, "an array colors it again", tolerance=0)

opacity = simple.GetOpacityTransferFunction("waves")
opacity.Points = [-1.0, 0.0, 0.5, 0.0, 0.2, 0.0, 0.5, 0.0, 0.3, 0.9, 0.5, 0.0, 0.4, 0.0, 0.5, 0.0, 1.0, 0.1, 0.5, 0.0]
compare("Shells", mean=1.5, largest=120)
display.ScalarOpacityUnitDistance *= 4.0
compare("UnitDistance")
view.CameraParallelProjection = 1
view.CameraPosition, view.CameraFocalPoint = [12.0, 12.0, 80.0], [12.0, 12.0, 12.0]
compare("AlongAnAxis")
view.CameraParallelProjection = 0
place_camera(view)

# Volume and DSM Volume share the property.
for mode in ("Maximum Intensity", "Minimum Intensity", "Average Intensity", "Additive"):
    display.BlendMode = mode
    compare(mode.replace(" ", ""), mean=1.5, largest=255)
display.BlendMode, display.IsosurfaceValues = "Isosurface", [0.3]
compare("Isosurface", mean=3.0, largest=255)
display.BlendMode = "Composite"

display.DSMDebugView = "Brick"
bricks = render(view, "Bricks")
display.DSMDebugView = "Off"
check(abs(bricks - render(view)).mean() > 1.0, "a debug view shows volumes")
check(sum(row["Accesses"] for row in get_rows(display)) > 0, "bricks of volumes are counted")

# Cells are selected where half of the light is covered, by the ranks that have them; also for the center of rotation.
before = render(view)
simple.SelectSurfaceCells(Rectangle=[130, 100, 170, 140], View=view)
extract = simple.ExtractSelection(Input=source)
extract.UpdatePipeline()
selected = extract.GetDataInformation().GetNumberOfCells()
bounds = extract.GetDataInformation().GetBounds()
saved = os.path.join(OUTPUT, "selected.npy")
if get_ranks() == 1:
    np.save(saved, selected)
check(selected == np.load(saved), f"{selected} cells are selected, as on one rank")
check(selected > 20 and max(bounds[1], bounds[3], bounds[5]) < 20.0, f"they are those of the shells, in {bounds}")
simple.Delete(extract)
simple.ClearSelection(source)
check_equal(render(view), before, "after a selection")

# What ParaView draws itself is where it is in the volume.
sphere = simple.Sphere(Center=[12.0, 12.0, 12.0], Radius=9.0, ThetaResolution=48, PhiResolution=48)
show_surface(sphere, view)
compare("OrdinarySphere", mean=1.5, largest=150)
simple.Show(sphere, view).Representation = REPRESENTATION
inside = render(view, "TracedSphere")
simple.Hide(sphere, view)
check(abs(inside - render(view)).mean() > 1.0, "the sphere is seen")

display.DSMClip = 1
display.DSMClipOrigin, display.DSMClipNormal = [12.0, 12.0, 12.0], [1.0, 0.0, 0.2]
clipped = render(view, "Clipped")
display.DSMClip = 0
check(get_covered(clipped).mean() < get_covered(render(view)).mean(), "a clipped volume covers less")

# Another array says how dense it is.
display.UseSeparateOpacityArray, display.OpacityArrayName = 1, ["POINTS", "waves"]
opacity.Points = [-1.0, 0.0, 0.5, 0.0, 0.2, 0.0, 0.5, 0.0, 1.0, 0.4, 0.5, 0.0]
twice = render(view, "OpacityOfWaves")
display.OpacityArrayName = ["POINTS", "ways"]
far = render(view, "OpacityOfWays")
display.UseSeparateOpacityArray = 0
once = render(view)
check(abs(once - twice).mean() < 0.1, f"the same array twice is once: {abs(once - twice).mean():.3f}")
check(abs(once - far)[get_covered(once)].mean() > 5.0, "another array for opacity is another picture")

# A function of the value and of the gradient, or of another array. Volume applies an opacity at each sample, which are
# eight in a cell of so few.
# It takes differences over 25 / 24 of a cell for those over a cell.
unit_distance = display.ScalarOpacityUnitDistance
simple.ColorBy(display, ("POINTS", "ways"))
display.ScalarOpacityUnitDistance, display.UseTransfer2D = 0.125, 1
boxes = simple.GetTransferFunction2D("ways")
boxes.OutputDimensions, boxes.Range = [32, 32], [0.0, 21.0, 0.0, 1.0]
boxes.Boxes = [4.0, 0.0, 6.0, 0.4, 1.0, 0.3, 0.1, 0.2, 9.0, 0.1, 9.0, 0.9, 0.1, 0.4, 1.0, 0.1]
compare("GradientBoxes", mean=2.0, largest=120)
of_gradients = render(view)
check(get_covered(of_gradients).any(), "the boxes show something")
display.UseGradientForTransfer2D, display.ColorArray2Name = 0, ["POINTS", "x2"]
compare("ArrayBoxes", mean=2.0, largest=120)
check(abs(of_gradients - render(view)).mean() > 2.0, "another array is another picture")
display.UseTransfer2D, display.UseGradientForTransfer2D, display.ScalarOpacityUnitDistance = 0, 1, unit_distance
simple.ColorBy(display, ("POINTS", "waves"))
check_equal(render(view), once, "one-dimensional functions show what they showed", tolerance=0)

# As the color map's editor sets it: a logarithmic map of values from 0 on, and colors beyond the range.
simple.ColorBy(display, ("POINTS", "ways"))
display.RescaleTransferFunctionToDataRange(True, False)
colors, of_ways = simple.GetColorTransferFunction("ways"), simple.GetOpacityTransferFunction("ways")
colors.MapControlPointsToLogSpace()
colors.UseLogScale = 1
from_zero = render(view, "LogScale")
of_ways.Points = [colors.RGBPoints[0], *of_ways.Points[1:]]
check(abs(from_zero - render(view)).mean() < 0.5, "a logarithmic map shows values from 0 on")
colors.UseLogScale, colors.RGBPoints = 0, [6.0, 0.1, 0.2, 1.0, 10.0, 0.1, 0.2, 1.0]
of_ways.Points = [6.0, 0.1, 0.5, 0.0, 10.0, 0.1, 0.5, 0.0]
inside = render(view)
colors.UseBelowRangeColor, colors.BelowRangeColor = 1, [1.0, 0.0, 0.0]
colors.UseAboveRangeColor, colors.AboveRangeColor = 1, [0.0, 1.0, 0.0]
compare("RangeColors")
check(abs(inside - render(view)).mean() > 5.0, "what is below and above the range has its own colors")
simple.ColorBy(display, ("POINTS", "waves"))

# Components are colors and opacities: of two, the color function maps the first and the opacity function the second; of
# four, the first three are the color. Volume has the unit distance 1 then, and takes bytes for 0 to 255.
unit_distance = display.ScalarOpacityUnitDistance
display.ScalarOpacityUnitDistance = 1.0
for name, last in (("x2", 1.0), ("x4", 1.0), ("x4bytes", 255.0)):
    simple.ColorBy(display, ("POINTS", name))
    several = simple.GetOpacityTransferFunction(name)
    several.Points = [0.0, 0.0, 0.5, 0.0, 0.1 * last, 0.0, 0.5, 0.0, last, 0.6, 0.5, 0.0]
    magnitude = render(view)
    display.MapScalars = 0
    compare(f"Dependent.{name}", mean=1.0, largest=80)
    direct = render(view)
    check(abs(direct - magnitude).mean() > 0.3, f"{name}: components are another picture than the magnitude")
    display.MapScalars, display.MultiComponentsMapping = 1, 1
    check_equal(render(view), direct, f"{name}: Multi Components Mapping shows the same")
    display.DSMCap = display.DSMClip = 1
    capped = render(view, f"Dependent.{name}.Cap")
    check(abs(capped - direct).mean() > 1.0, f"{name}: the cap is seen")
    display.DSMCap = display.DSMClip = 0
    display.MultiComponentsMapping = 0
hints = display.SMProxy.GetProperty("MultiComponentsMapping").GetHints()
kinds = [hints.GetNestedElement(number).GetAttribute("type") for number in range(hints.GetNumberOfNestedElements())]
check("CompositeDecorator" in kinds, "the panel has it for DSM Volume, too")
path = os.path.join(OUTPUT, "components.h5")
if get_ranks() == 1:
    simple.SaveData(path, proxy=source)
stored = simple.DSMVolumeReader(FileName=path)
of_file = simple.Show(stored, view)
of_file.Representation = "DSM Volume"
opacities = list(several.Points)
simple.ColorBy(of_file, ("POINTS", "x4bytes"))  # it scales them
several.Points = opacities
of_file.MapScalars, of_file.ScalarOpacityUnitDistance = 0, 1.0
simple.Hide(source, view)
check_equal(render(view), direct, "components in a file are what they are in memory")
simple.Delete(stored)
simple.Show(source, view)
simple.ColorBy(display, ("POINTS", "x3"))
display.MapScalars = 0
with Messages() as messages:
    nothing = render(view)
    check(get_ranks() > 1 or "array 'x3' has 3, so nothing is drawn" in messages.text, "three components are refused")
check(not get_covered(nothing).any(), "and not shown")
display.MapScalars = 1
simple.ColorBy(display, ("POINTS", "waves"))
display.ScalarOpacityUnitDistance = unit_distance

# Light.
opacity.Points = [-1.0, 0.0, 0.5, 0.0, 0.2, 0.0, 0.5, 0.0, 1.0, 0.4, 0.5, 0.0]
display.Shade, display.Specular, display.SpecularPower = 1, 0.3, 20.0
compare("Shaded", mean=1.0, largest=60)
# Volume has it for a headlight alone.
display.Ambient = 0.2
display.DSMShadows = 1
view.AdditionalLights = [simple.CreateLight()]
view.AdditionalLights[0].Coords, view.AdditionalLights[0].Position = "Scene", [80.0, 60.0, 12.0]
display.ScalarOpacityUnitDistance = 0.2 * unit_distance
scattered = render(view, "DenseShadows")
display.DSMScattering = 0.0
dark, covered = render(view), get_covered(scattered)
means = dark[covered].mean(), scattered[covered].mean()
check(means[1] > 1.3 * means[0], f"by default, a dense volume scatters light: {means}")
display.ScalarOpacityUnitDistance = unit_distance
shadows = render(view, "Shadows")
display.DSMShadows = 0
lit = render(view)
covered = get_covered(lit)
check(lit[covered].mean() > shadows[covered].mean() + 2.0, "a volume casts shadows on itself")
display.DSMAmbientOcclusionSamples = 8
check(lit[covered].mean() > render(view, "Occlusion")[covered].mean() + 2.0, "and hides what is around it")
display.DSMAmbientOcclusionSamples = 0
display.DSMScattering, display.DSMShadows = 1.0, 1
scattered = render(view, "Scattering")
display.VolumeAnisotropy = 0.6
check(abs(scattered - render(view))[covered].mean() > 2.0, "light is scattered forward")
display.DSMScattering, display.DSMShadows, display.Shade = 0.0, 0, 0
view.AdditionalLights = []

opacity.Points = [-1.0, 0.0, 0.5, 0.0, 1.0, 0.0, 0.5, 0.0]
check(not get_covered(render(view)).any(), "of a transparent volume, nothing is seen")
display.Representation = REPRESENTATION
check(get_covered(render(view)).mean() > 0.05, "its isosurface is")
check(sum(row["Accesses"] for row in get_rows(display)) > 0, "and bricks of that are counted, too")

# Translucent geometry of ParaView's is where it is in a volume: fog, whose color and those of planes in it are known.
simple.Hide(source, view)
FOG, COLORS, DENSITY = np.array([0.9, 0.5, 0.1]), np.array([[0.1, 0.9, 0.4], [0.2, 0.2, 1.0]]), 0.05
# Of each plane: z at x = 0, how that grows along x, how far it reaches along x and y, opacity.
PLANES = [(0.0, 0.0, 9.05, 13.05, 0.5), (1.1, 0.6, 10.1, 7.05, 0.4)]
fog = image_source(
    "image.SetOrigin(-12, -12, -12)\nimage.SetExtent(piece)\nadd(image, points(piece)[0], 'fog')\n", in_parts=True
)
display = simple.Show(fog, view)
display.Representation = "DSM Volume"
simple.ColorBy(display, ("POINTS", "fog"))
display.ScalarOpacityUnitDistance = 1.0
simple.GetColorTransferFunction("fog").RGBPoints = [0.0, *FOG, 24.0, *FOG]
simple.GetOpacityTransferFunction("fog").Points = [0.0, DENSITY, 0.5, 0.0, 24.0, DENSITY, 0.5, 0.0]
view.UseFXAA = 0
render(view)
place_camera(view)

# What is selected of each rank's part is drawn in the volume, too.
bare = render(view)
simple.SelectCellsThrough(Rectangle=[130, 100, 170, 140], View=view)
marked = render(view)[:, :, 2] > 80
simple.SaveScreenshot(os.path.join(OUTPUT, f"FogSelected.{get_ranks()}.png"), view)
saved = os.path.join(OUTPUT, "marked.npy")
if get_ranks() == 1:
    np.save(saved, marked)
expected = np.load(saved)
check(expected.sum() > 100, "a selection is marked")
share = (marked & expected).sum() / expected.sum()
check(share > 0.99, f"{share:.3f} of it as on one rank")
simple.ClearSelection(fog)
check_equal(render(view), bare, "without the selection")

view.CameraParallelProjection, view.CameraParallelScale = 1, 16.0
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [0, 0, 70], [0, 0, 0], [0, 1, 0]


def get_fog(planes, shape):
    size = np.array(shape[:2])[:, None, None]
    y, x = 16.0 * (2 * np.mgrid[: shape[0], : shape[1]] + 1 - size) / shape[0]
    planes = planes or [(0.0, 0.0, 0.0, 0.0, 0.0)]
    depths = np.array([np.clip(z + growth * x, -12, 12) for z, growth, _, _, _ in planes])
    covers = np.array([opacity * ((abs(x) < right) & (abs(y) < top)) for _, _, right, top, opacity in planes])
    order = np.argsort(-depths, axis=0)
    depths, covers = (np.take_along_axis(values, order, 0) for values in (depths, covers))
    before, color, left = 12.0, 0.0, 1.0
    # Behind all, a plane that is not seen.
    for depth, cover, through in [*zip(depths, covers, COLORS[order]), (np.full(x.shape, -12.0), 0.0 * x, 0.0)]:
        misty = (1 - (1 - DENSITY) ** (before - depth)) * ((abs(x) < 12) & (abs(y) < 12))
        for part, its_color in ((misty, FOG), (cover, through)):
            color = color + (left * part)[:, :, None] * its_color
            left = left * (1 - part)
        before = depth
    return 255 * (color + left[:, :, None] * np.array(view.Background))


def check_fog(pixels, planes, what, mean=1.0, part=np.s_[:, :]):
    difference = abs(pixels - get_fog(planes, pixels.shape))[part].mean()
    check(difference < mean, f"{what}: {difference:.2f} of 255 from what it has to be")


check_fog(render(view), PLANES[:0], "fog")
for count, (z, growth, right, top, opacity) in enumerate(PLANES):
    left_end, right_end = z - growth * right, z + growth * right
    corners = [-right, -top, left_end], [right, -top, right_end], [-right, top, left_end]
    plane = show_surface(simple.Plane(Origin=corners[0], Point1=corners[1], Point2=corners[2]), view)
    plane.AmbientColor = COLORS[count]
    plane.Ambient, plane.Diffuse, plane.Specular, plane.Opacity = 1.0, 0.0, 0.0, opacity
    check_fog(render(view, f"Planes{count + 1}"), PLANES[: count + 1], f"{count + 1} translucent planes in fog")
view.LODThreshold, view.LODResolution = 0.0, 0.5
view.SMProxy.InteractiveRender()
# The fewer pixels are traced, the longer they take; so not at the planes' borders.
check_fog(grab(view, "PlanesMoving"), PLANES, "while the camera moves", 2.0, np.s_[80:160, 96:204])

# Values of cells are those of points that have their means.
view = create_view()
cells = image_source(
    """
image.SetExtent(piece)
values = np.cos(3.0 * distance([piece[0], piece[1] - 1, piece[2], piece[3] - 1, piece[4], piece[5] - 1]))
for name, array in {'waves': values, 'other': values ** 2}.items():
    array = numpy_to_vtk(array, deep=True)
    array.SetName(name)
    image.GetCellData().AddArray(array)
""",
    in_parts=True,
)
display = simple.Show(cells, view)
display.ColorArrayName = [None, ""]
place_camera(view)
display.ScalarOpacityUnitDistance = 1.7
check(get_covered(show_as("DSM Volume")).mean() > 0.1, "a volume of cells is shown")
check(list(display.ColorArrayName) == ["CELLS", "other"], f"by an array: {display.ColorArrayName}")
means = simple.CellDatatoPointData(cells)


def show_means(name, opacity=None):
    """Several ranks show what one rank does, and that shows what points do."""
    pictures = []
    for source, association in ((cells, "CELLS"), (means, "POINTS"))[: 1 if get_ranks() > 1 else 2]:
        display = simple.Show(source, view)
        display.ColorArrayName = [association, "waves"]
        display.LookupTable = simple.GetColorTransferFunction("waves")
        display.ScalarOpacityFunction = simple.GetOpacityTransferFunction("waves")
        display.ScalarOpacityUnitDistance = 1.7
        display.OpacityArrayName = [association, "other"]
        display.UseSeparateOpacityArray = 1 if opacity else 0
        pictures.append(show_as_volume(display, name if source is cells else None))
        simple.Hide(source, view)
    check_equal(pictures[0], pictures[-1], name + " is what the means at points show", tolerance=0)


def show_as_volume(display, name):
    display.Representation = "DSM Volume"
    return render(view, name)


show_means("Cells")
show_means("CellsWithOpacityArray", "other")

# Labels, as of a segmentation, have no values between them: no sample has the green one.
view = create_view()
labels = image_source(
    """
image.SetExtent(piece)
way = distance(piece)
add(image, np.where(way < 0.4, 9, np.where(way < 0.7, 1, 0)).astype(np.uint8), 'labels')
""",
    in_parts=True,
)
display = simple.Show(labels, view)
place_camera(view)
simple.ColorBy(display, ("POINTS", "labels"))
colors, opacity = simple.GetColorTransferFunction("labels"), simple.GetOpacityTransferFunction("labels")
colors.RGBPoints = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0, 9.0, 0.0, 0.0, 1.0]
opacity.Points = [0.0, 0.0, 0.5, 0.0, 0.9, 0.0, 0.5, 0.0, 1.0, 0.2, 0.5, 0.0, 9.0, 0.2, 0.5, 0.0]
display.ScalarOpacityUnitDistance = 1.7
display.InterpolationType = "Nearest"
compare("Labels", mean=2.0, largest=255)
nearest = show_as("DSM Volume")
check(nearest[..., 0].max() > 100 and nearest[..., 1].max() == 0, "two labels are seen, and nothing between")
display.InterpolationType = "Linear"
colors.InterpretValuesAsCategories = 1
colors.Annotations = ["0", "air", "1", "skin", "5", "liver", "9", "bone"]
colors.IndexedColors = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
check_equal(show_as("DSM Volume"), nearest, "categories are labels", tolerance=1)
colors.EnableOpacityMapping, colors.IndexedOpacities = 1, [1.0, 0.0, 1.0, 1.0]
hidden = show_as("DSM Volume")
render(view, "LabelHidden")
check(hidden[..., 0].max() == 0 and hidden[..., 2].max() > 100, "a label is hidden by its opacity")
