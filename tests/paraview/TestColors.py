# SPDX-License-Identifier: BSD-3-Clause
"""Colour: solid, by the isosurface array, by another array, by components; the colour map live. One rank's pictures are
compared with those of Contour and Surface, and those of several with one rank's."""

from dsm_testing import *

load_plugin()
view = create_view()
view.UseFXAA = 0  # it would mix colors along the edges
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
    # On: the color is the map's, without shading that would blur the comparison.
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
# The same colors as ParaView gives to triangles with interpolated values of the array.
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

# Arrays of the cells: the color of the cell, exactly, as Contour passes it on; in one image, with ghost layers, and
# in blocks.
simple.Delete(source)
CELLS = """
image.SetExtent(piece)
add(image, distance(piece))
size = [int(piece[2 * axis + 1] - piece[2 * axis]) for axis in range(3)]
k, j, i = np.meshgrid(*(np.arange(size[axis]) + piece[2 * axis] for axis in (2, 1, 0)), indexing='ij')
of_cells = ((7 * i + 3 * j + 5 * k) % 11).ravel().astype(float)
for name, values in (('n', of_cells), ('f', 10 - of_cells),
                     ('colours', np.stack([20 * of_cells, 255 - 20 * of_cells, 0 * of_cells], axis=1).astype(np.uint8)),
                     ('glass', np.stack([20 * of_cells] * 3 + [128 + 0 * of_cells], axis=1).astype(np.uint8))):
    array = numpy_to_vtk(values, deep=True); array.SetName(name)
    image.GetCellData().AddArray(array)
i, j, k = points(piece)
colours = numpy_to_vtk(np.stack([10 * i, 10 * j, 10 * k], axis=1).astype(np.uint8), deep=True)
colours.SetName('smooth'); image.GetPointData().AddArray(colours)
labels = numpy_to_vtk(i // 4, deep=True); labels.SetName('labels'); image.GetPointData().AddArray(labels)
shades = numpy_to_vtk((i + k) / 48, deep=True); shades.SetName('shades')
image.GetPointData().AddArray(shades)
"""
cells = image_source(CELLS)
blocks = simple.GroupDatasets(Input=[image_source(CELLS, (0, 12, 0, 24, 0, 24)),
                                     image_source(CELLS, (12, 24, 0, 24, 0, 24))])
ghosts = (getattr(simple, "GhostCells", None) or simple.GhostCellsGenerator)(Input=cells)


def color_plainly(display, array, place, mapped):
    """Its colours as they are, without shading."""
    simple.ColorBy(display, (place, array))
    display.MapScalars = 1 if mapped else 0
    display.Ambient, display.Diffuse = 1.0, 0.0
    if mapped:
        table = simple.GetColorTransferFunction(array)
        table.ApplyPreset("Jet", True)
        table.RescaleTransferFunction(0.0, 10.0)


def check_colors(dataset, name, array, place, mapped=True, share=0.02, counts=get_covered, prepare=lambda array: None):
    """`counts`: which pixels of Contour's picture do; `prepare`: the colours of the array."""
    display = show(dataset, view, [0.7], "f")
    color_plainly(display, array, place, mapped)
    prepare(array)
    place_camera(view, (0.3, 0.2, 1.0))
    view.CameraViewAngle = 15
    traced = render(view, name)
    simple.Hide(dataset, view)
    if get_ranks() > 1:
        display.MapScalars = 1
        return traced
    contour = simple.Contour(Input=dataset, ContourBy=["POINTS", "f"], Isosurfaces=[0.7])
    triangles = simple.Show(contour, view)
    triangles.Representation = "Surface"
    color_plainly(triangles, array, place, mapped)
    prepare(array)
    reference = render(view)
    both = get_covered(traced) & get_covered(reference) & counts(reference)
    check(both.sum() > 0.05 * both.size, f"{name}: Contour draws it")
    others = (abs(traced - reference).max(axis=2)[both] > 3).mean()
    check(others < share, f"{name}: the colours are Contour's but for {100 * others:.2f} % along the cells' edges")
    simple.Delete(contour)
    display.MapScalars = 1
    return traced


by_cell = check_colors(cells, "ByCell", "n", "CELLS")
shown = numpy.unique(by_cell[get_covered(by_cell)], axis=0)
check(len(shown) == 11, f"nothing is interpolated: {len(shown)} colours for 11 values")
check_colors(cells, "ByCellOfTheSameName", "f", "CELLS")
check_colors(ghosts, "ByCellWithGhosts", "n", "CELLS")
check_colors(blocks, "ByCellInBlocks", "n", "CELLS")

# Map Scalars off: the array's values are colors.
check_colors(cells, "ColoursOfCells", "colours", "CELLS", False)
check_colors(cells, "ColoursOfPoints", "smooth", "POINTS", False)
check_colors(cells, "ShadesOfPoints", "shades", "POINTS", False)
check_colors(blocks, "ColoursInBlocks", "colours", "CELLS", False)
display = simple.Show(cells, view)
color_plainly(display, "glass", "CELLS", False)
glass = render(view, "Glass")
front = glass[get_covered(glass)]
check((abs(front - [0, 0, 51]).max(axis=1) > 2).any() and (front[:, 2] >= front[:, 0]).all(),
      "an opacity among the colours lets the background through")
display.MapScalars = 1

# Values that are no numbers have their color and opacity.
holes = image_source(CELLS + """
of_cells[::3] = np.nan
array = numpy_to_vtk(of_cells, deep=True); array.SetName('holes')
image.GetCellData().AddArray(array)
""")
simple.Hide(cells, view)
table = simple.GetColorTransferFunction("holes")
table.NanColor = [0.0, 1.0, 0.0]
for opacity in (1.0, 0.0):
    table.NanOpacity = opacity
    check_colors(holes, f"NotANumber{opacity:.0f}", "holes", "CELLS")

# Infinite values of points have the first and the last color.
endless = image_source(CELLS + """
f = image.GetPointData().GetArray("f")
n = f.GetNumberOfTuples()
side = np.arange(n) % 25
array = numpy_to_vtk(np.where(side > 15, np.inf, np.where(side < 9, -np.inf, 0.5)), deep=True)
array.SetName('endless')
image.GetPointData().AddArray(array)
""")
display = show(endless, view, [0.7], "f")
color_plainly(display, "endless", "POINTS", True)
simple.GetColorTransferFunction("endless").NanColor = [1.0, 1.0, 0.0]
pixels = render(view, "Endless")
simple.Hide(endless, view)
red = (pixels[:, :, 0] > 120) & (pixels[:, :, 2] < 60)
blue = (pixels[:, :, 2] > 120) & (pixels[:, :, 0] < 90)
yellow = (pixels[:, :, 0] > 200) & (pixels[:, :, 1] > 200) & (pixels[:, :, 2] < 60)
check(red.sum() > 1000 and blue.sum() > 1000, f"above all numbers and below: {red.sum()} and {blue.sum()} pixels")
check(yellow.sum() < 100, f"only between both there is no number: {yellow.sum()} pixels")

# Flat: the cells can be told from one another, as Contour's triangles, in its mean as bright.
simple.ColorBy(display, None)
simple.Hide(holes, view)
contour = simple.Contour(Input=cells, ContourBy=["POINTS", "f"], Isosurfaces=[0.7])
edges = []
for interpolation in ("Gouraud", "Flat"):
    pictures = []
    for dataset, properties in ((cells, {"DSMIsoArray": ["POINTS", "f"], "DSMIsoValues": [0.7]}), (contour, {})):
        if get_ranks() > 1 and dataset == contour:
            break
        shown = simple.Show(dataset, view)
        shown.Representation = REPRESENTATION if properties else "Surface"
        shown.ColorArrayName = [None, ""]
        shown.Ambient, shown.Diffuse, shown.Interpolation = 0.0, 1.0, interpolation
        for name, value in properties.items():
            setattr(shown, name, value)
        pictures.append(render(view, ("Traced" if properties else "Contour") + interpolation))
        simple.Hide(dataset, view)
    if get_ranks() == 1:
        check_same_surface(pictures[0], pictures[1], interpolation, 0.01)
    edges.append(abs(numpy.diff(pictures[0][:, :, 0], n=2, axis=1))[get_covered(pictures[0])[:, 2:]].mean())
check(edges[1] > 1.5 * edges[0], f"edges between cells: {edges[0]:.2f} Gouraud, {edges[1]:.2f} Flat")

# The same controls of meshes do what they do on a Surface.
mesh = simple.Contour(Input=holes, ContourBy=["POINTS", "f"], Isosurfaces=[0.7])
for name, array, place, mapped, opacity, interpolation in (
        ("MeshOfNumbers", "holes", "CELLS", True, 1.0, "Gouraud"),
        ("MeshWithHoles", "holes", "CELLS", True, 0.0, "Gouraud"),
        ("MeshOfColours", "colours", "CELLS", False, 0.0, "Gouraud"),
        ("FlatMesh", "smooth", "POINTS", False, 0.0, "Flat")):
    pictures = []
    for representation in (REPRESENTATION, "Surface") if get_ranks() == 1 else (REPRESENTATION,):
        shown = simple.Show(mesh, view)
        shown.Representation = representation
        color_plainly(shown, array, place, mapped)
        table.NanOpacity = opacity
        shown.Interpolation = interpolation
        if interpolation == "Flat":
            shown.Ambient, shown.Diffuse = 0.0, 1.0
        pictures.append(render(view, name if representation == REPRESENTATION else None))
    if get_ranks() == 1:
        check(get_covered(pictures[1]).mean() > 0.05, f"{name}: Surface draws it")
        different = (abs(pictures[0] - pictures[1]).max(axis=2) > 8).mean()
        check(different < 0.005, f"{name}: {100 * different:.2f} % of the pixels differ from Surface")

# Categories: each value has a color of its own. Between two samples it is that of the nearer one, where Contour makes
# values that are of no category.
PALETTE = numpy.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [0, 255, 255], [255, 0, 255], [255, 128, 0],
                       [0, 128, 255]])
NO_CATEGORY = [255, 255, 255]


def divide(array):
    table = simple.GetColorTransferFunction(array)
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for value in range(len(PALETTE)) for text in (str(value), f"<{value}>")]
    table.ActiveAnnotatedValues = [str(value) for value in range(len(PALETTE))]
    table.IndexedColors = list(PALETTE.ravel() / 255)
    table.NanColor = numpy.array(NO_CATEGORY) / 255


def find_colors(pixels):
    return set(map(tuple, pixels[get_covered(pixels)]))


simple.HideAll(view)
known = set(map(tuple, PALETTE))
found = find_colors(check_colors(cells, "CategoriesOfCells", "n", "CELLS", prepare=divide))
check(found == known | {tuple(NO_CATEGORY)}, f"four of eleven values are of no category: {found}")
found = find_colors(check_colors(cells, "CategoriesOfPoints", "labels", "POINTS", prepare=divide,
                                 counts=lambda pixels: (pixels[..., None, :] == PALETTE).all(axis=-1).any(axis=-1)))
check(found <= known and len(found) > 2, f"labels of points have their colours, and no other: {found}")

# Backfaces: the side where values are above the isovalue, of a surface that the volume's border cuts open.
simple.HideAll(view)
view.CameraViewAngle = 40
contour = simple.Contour(Input=cells, ContourBy=["POINTS", "f"], Isosurfaces=[1.15])
for name, back, opacity in (("CullBackface", "Cull Backface", 1.0), ("CullFrontface", "Cull Frontface", 1.0),
                            ("Backface", "Surface", 1.0), ("GlassBackface", "Surface", 0.4)):
    pictures = []
    for dataset in (cells, contour) if get_ranks() == 1 else (cells,):
        shown = show(cells, view, [1.15], "f") if dataset == cells else simple.Show(contour, view)
        shown.ColorArrayName = [None, ""]
        shown.Ambient, shown.Diffuse, shown.Interpolation = 0.2, 0.8, "Gouraud"
        shown.BackfaceRepresentation, shown.BackfaceOpacity = back, opacity
        shown.BackfaceAmbientColor = shown.BackfaceDiffuseColor = [1.0, 0.3, 0.0]
        pictures.append(render(view, ("Traced" if dataset == cells else "Contour") + name))
        simple.Hide(dataset, view)
    if get_ranks() == 1:
        check_same_surface(pictures[0], pictures[1], name, 0.01)
        different = (abs(pictures[0] - pictures[1]).max(axis=2) > 24).mean()
        check(different < 0.01, f"{name}: {100 * different:.2f} % of the pixels differ from Contour")
