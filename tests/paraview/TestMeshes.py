# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of datasets of every kind: what ParaView's own Surface shows, and the same picture on any
number of ranks."""

from dsm_testing import *
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

load_plugin()
view = create_view()
view.UseFXAA = 0  # it would blur each picture in its own way


def color_by(display, association, array, *component):
    simple.ColorBy(display, (association, array) + component)
    display.RescaleTransferFunctionToDataRange(False, True)
    return simple.GetColorTransferFunction(array)


def compare(name, source, prepare=None, share=0.005, shading=3.0, position=(0.6, 0.5, 1.0),
            reference="Surface"):
    """Draws a source; `prepare(display)` sets it up. Deletes it. One rank is compared with its Surface, and several
    with one, or, where they have other data than one (no name), with their own Surface."""
    display = show_traced(source, view)
    if prepare:
        prepare(display)
    place_camera(view, position)
    traced = render(view, name)
    if get_ranks() == 1 or not name:
        display.Representation = reference
        surface = render(view)
        check_same_surface(traced, surface, str(name), share)
        both = get_covered(traced) & get_covered(surface)
        difference = abs(traced - surface).mean(axis=2)[both].mean()
        check(difference < shading, f"{name}: shading differs by {difference:.2f} of 255")
        display.Representation = REPRESENTATION
        check_equal(render(view), traced, f"{name}: back from Surface, the picture is the same")
    simple.Delete(source)


def wavelet(**properties):
    return simple.Wavelet(WholeExtent=[-8, 8] * 3, **properties)


def contour(source):
    return simple.Contour(Input=source, ContourBy=["POINTS", "RTData"], Isosurfaces=[157.0])


SMOOTH = simple.Sphere(ThetaResolution=64, PhiResolution=48)
compare("SmoothSphere", SMOOTH)
compare("FlatBox", simple.Box())
compare("Lit", simple.Sphere(ThetaResolution=64, PhiResolution=48),
        lambda d: (setattr(d, "Specular", 0.6), setattr(d, "SpecularPower", 30.0),
                   setattr(d, "Ambient", 0.1), setattr(d, "Interpolation", "Flat")))
compare("Placed", simple.Box(),
        lambda d: transform(d, [0.3, 0.2, -0.1], [20.0, 30.0, 40.0], [1.0, 0.4, 2.0]))
compare("FarFromTheOrigin", simple.Sphere(Center=[5e5, -3e5, 1e5], ThetaResolution=64,
                                          PhiResolution=48), shading=6.0)

# Distributed data of the kinds that the geometry filter makes surfaces of.
grid = wavelet()
compare("ContourByNormals", contour(grid), share=0.01)
compare("Unstructured", simple.Clip(Input=grid, ClipType="Sphere"),
        lambda d: color_by(d, "POINTS", "RTData"), share=0.01, shading=5.0)
cells = simple.PointDatatoCellData(Input=simple.Clip(Input=grid, ClipType="Sphere"))
compare("CellColours", cells, lambda d: color_by(d, "CELLS", "RTData"), share=0.01, shading=5.0)
bent = simple.Transform(Input=grid)
bent.Transform.Rotate = [20.0, 30.0, 0.0]
bent.UpdatePipeline()
check(bent.GetDataInformation().GetDataSetTypeAsString() == "vtkStructuredGrid", "curvilinear")
compare("Structured", bent, lambda d: color_by(d, "POINTS", "RTData"), share=0.01, shading=5.0)

# AMR and trees show the surface of their cells.
compare("Amr", simple.AMRGaussianPulseSource(),
        lambda d: (setattr(d, "DSMShow", "Surface"), color_by(d, "CELLS", "Gaussian-Pulse")), share=0.01, shading=5.0)
# Since ParaView 5.13 at the latest, the random trees are others on another number of ranks.
fixed = get_ranks() == 1 or simple.GetParaViewVersion() < (5, 13)
compare("HyperTreeGrid" if fixed else None, simple.HyperTreeGridRandom(),
        lambda d: (setattr(d, "DSMShow", "Surface"), color_by(d, "CELLS", "Depth")), share=0.01, shading=5.0)

# Of image data, isosurfaces are what is shown unless Show says otherwise.
def show_outer_surface(display):
    check(display.DSMShow == "Isosurfaces", "isosurfaces are the default of image data")
    display.DSMShow = "Surface"
    color_by(display, "POINTS", "RTData")


def show_edges_of_image(display):
    show_outer_surface(display)
    display.DSMShowEdges = 1
    transform(display, [0.3, 0.2, -0.1], [20.0, 30.0, 40.0], [1.0, 0.4, 2.0])


compare("ImageSurface", wavelet(), show_outer_surface)
compare("ImageEdges", wavelet(), show_edges_of_image, shading=8.0, reference="Surface With Edges")
blocks = simple.GroupDatasets(
    Input=[wavelet(), simple.Wavelet(WholeExtent=[12, 20, -8, 8, -8, 8])], BlockNames=["one", "other"])


def show_one_block(display):
    show_outer_surface(display)
    display.BlockSelectors = ["/Root/other"]
    display.BlockColors = ["/Root/other", "1.0", "0.5", "0.0"]


compare("ImageBlocks", blocks, show_one_block)

# What is not shown has no bricks.
image = wavelet()
display = show_traced(image, view, DSMIsoValues=[150.0])
place_camera(view)
isosurfaces = render(view)
published = get_rows(display)[0]["BytesPublished"]
display.DSMShow = "Surface"
check((render(view) != isosurfaces).any(), "the surface is shown in place of the isosurfaces")
surface = get_rows(display)[0]
check(surface["Publications"] == 1 and surface["BytesPublished"] != published, "and only it has bricks")
display.DSMShow = "Isosurfaces"
check_equal(render(view), isosurfaces, "and they in place of the surface", tolerance=0)
check(get_rows(display)[0]["Publications"] == 1, "as have they")
simple.Delete(image)

# Textures, also where each rank has a part of the surface.
CHECKS = os.path.join(OUTPUT, f"checks.{get_ranks()}.png")
if vtkMultiProcessController.GetGlobalController().GetLocalProcessId() == 0:
    row = [255, 60, 20, 40, 90, 255]
    rows = numpy.array(2 * (2 * row + 2 * (row[3:] + row[:3])), numpy.uint8).reshape(-1, 3)
    checks = numpy_to_vtk(rows, deep=True)
    image = vtkImageData()
    image.SetDimensions(4, 4, 1)
    image.GetPointData().SetScalars(checks)
    writer = vtkPNGWriter()
    writer.SetFileName(CHECKS)
    writer.SetInputData(image)
    writer.Write()
texture = simple.CreateTexture(CHECKS)
plane = simple.TextureMaptoPlane(Input=simple.Clip(Input=grid, ClipType="Sphere"))
plane.Automatic = 0  # it would be another one on each rank
plane.Origin, plane.Point1, plane.Point2 = [-8, -8, 0], [8, -8, 0], [-8, 8, 0]
# ParaView 5.13 finds no values in the picture that it has read, without any of ours, too.
version = simple.GetParaViewVersion()
if version < (5, 13) or version >= (6, 0):
    compare("Textured", plane, lambda d: setattr(d, "Texture", texture), shading=5.0)

# Color: mapped per pixel, or at the corners; vectors; colors of the data themselves.
normals = simple.Elevation(Input=simple.Sphere(ThetaResolution=12, PhiResolution=9),
                           LowPoint=[0, -0.5, 0], HighPoint=[0, 0.5, 0])
compare("MappedPerPixel", normals, lambda d: color_by(d, "POINTS", "Elevation"), shading=6.0)
corners = simple.Elevation(Input=simple.Sphere(ThetaResolution=12, PhiResolution=9),
                           LowPoint=[0, -0.5, 0], HighPoint=[0, 0.5, 0])
compare("MappedAtCorners", corners,
        lambda d: (color_by(d, "POINTS", "Elevation"),
                   setattr(d, "InterpolateScalarsBeforeMapping", 0)), shading=6.0)
compare("VectorComponent", simple.Sphere(ThetaResolution=64, PhiResolution=48),
        lambda d: color_by(d, "POINTS", "Normals", "X"), shading=4.0)
colors = simple.ProgrammableFilter(Input=simple.Sphere(ThetaResolution=48, PhiResolution=32))
colors.Script = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
output = self.GetOutputDataObject(0)
if output.GetNumberOfPoints():
    points = vtk_to_numpy(output.GetPoints().GetData())
    array = numpy_to_vtk((255 * (points + 0.5).clip(0, 1)).astype(np.uint8), deep=True)
    array.SetName('paint')
    output.GetPointData().AddArray(array)
"""
compare("DirectColours", colors,
        lambda d: (setattr(d, "ColorArrayName", ["POINTS", "paint"]), setattr(d, "MapScalars", 0)),
        shading=5.0)

# Edges, of the polygons and not of the triangles that they are cut into.
def with_edges(name, source, width=1.0, **properties):
    def prepare(display):
        display.DSMShowEdges = 1
        display.EdgeColor = [0.9, 0.1, 0.1]
        display.LineWidth = width
    compare(name, source, prepare, reference="Surface With Edges", **properties)


with_edges("EdgesOfQuads", simple.Plane(XResolution=9, YResolution=7), shading=1.0)
with_edges("EdgesOfPolygons", simple.Cylinder(Resolution=14), 3.0, share=0.01, shading=1.0)
with_edges("EdgesOfTriangles", simple.Sphere(ThetaResolution=24, PhiResolution=16), shading=1.0)
with_edges("EdgesOfCells", simple.Clip(Input=grid, ClipType="Sphere"), shading=1.0)

# Both sides of a surface.
def open_sphere():
    return simple.Sphere(ThetaResolution=64, PhiResolution=48, EndTheta=230.0)


for style in ("Cull Backface", "Cull Frontface", "Surface"):
    compare("Backface" + style.replace(" ", ""), open_sphere(),
            lambda d, s=style: (setattr(d, "BackfaceRepresentation", s),
                                setattr(d, "BackfaceDiffuseColor", [0.9, 0.3, 0.1])))

# Blocks.
def make_blocks():
    one = simple.Sphere(ThetaResolution=48, PhiResolution=32)
    two = simple.Sphere(ThetaResolution=48, PhiResolution=32, Center=[1.1, 0, 0])
    three = simple.Box(Center=[0, 1.1, 0])
    return simple.GroupDatasets(Input=[one, two, three], BlockNames=["one", "two", "three"])


compare("Blocks", make_blocks())
compare("BlockVisibility", make_blocks(),
        lambda d: setattr(d, "BlockSelectors", ["/Root/one", "/Root/three"]))
compare("BlockColour", make_blocks(),
        lambda d: setattr(d, "BlockColors", ["/Root/two", "1", "0.3", "0.2"]))

# Lines and vertices have an extent.
LINES_AND_POINTS = """
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from math import cos, sin
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
points, lines, vertices = vtkPoints(), vtkCellArray(), vtkCellArray()
for number in range(12):
    if number % ranks == rank:
        first = points.InsertNextPoint(cos(number), sin(number), 0.0)
        points.InsertNextPoint(cos(number + 1), sin(number + 1), 0.2)
        points.InsertNextPoint(1.4 * cos(number), 1.4 * sin(number), -0.2)
        lines.InsertNextCell(2, [first, first + 1])
        vertices.InsertNextCell(1, [first + 2])
output = self.GetOutputDataObject(0)
output.SetPoints(points)
output.SetLines(lines)
output.SetVerts(vertices)
"""
source = simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=LINES_AND_POINTS)
line = simple.PlotOverLine(Input=simple.Wavelet())
check(simple.Show(line, view).DSMRadiusArray[1] == "None", "no array that lines have scales their tubes by itself")
simple.Delete(line)
display = show_traced(source, view, DSMLineRadius=0.1, DSMPointRadius=-1.0)
place_camera(view, (0.0, 0.0, 1.0))
tubes = get_covered(render(view, "Tubes")).mean()
display.DSMLineRadius = 0.0
thin = get_covered(render(view, "ThinTubes")).mean()
check(0.002 < thin < 0.3 * tubes < 0.1, f"tubes: {tubes:.4f}, without a radius {thin:.4f}")
display.DSMPointRadius = 0.15
both = get_covered(render(view, "TubesAndSpheres")).mean()
display.DSMLineRadius = -1.0
spheres = get_covered(render(view, "Spheres")).mean()
check(0.02 < spheres and abs(both - spheres - thin) < 0.002,
      f"spheres: {spheres:.4f}, with tubes {both:.4f}")
simple.Delete(source)

# In one scene with an isosurface and with what OpenGL draws.
image = simple.Wavelet(WholeExtent=[-8, 8] * 3)
isosurface = show(image, view, [157.0], "RTData", DiffuseColor=[0.3, 0.6, 1.0])
ball = show_traced(simple.Sphere(Radius=5.0, Center=[3, 2, 4], ThetaResolution=64,
                                 PhiResolution=48), view, DiffuseColor=[1.0, 0.5, 0.2])
box = simple.Show(simple.Box(XLength=9.0, YLength=3.0, ZLength=9.0), view)
place_camera(view)
together = render(view, "Together")
isosurface.Visibility = 0
ball.Representation = "Surface"
isosurface.Visibility = 1
with_surface = render(view)
check_same_surface(together, with_surface, "the ball is as deep as the Surface one", 0.01)
ball.Representation = REPRESENTATION
ball.Opacity = 0.4
translucent = render(view, "Translucent")
check(abs(translucent - together)[get_covered(together)].mean() > 2, "the ball is translucent")
simple.Delete(image)
simple.Delete(ball.Input)
simple.Delete(box.Input)

# What changes is followed.
source = simple.Sphere(ThetaResolution=64, PhiResolution=48)
display = show_traced(source, view)
place_camera(view)
before = get_covered(render(view)).sum()
source.Radius = 0.25
check(get_covered(render(view)).sum() < 0.4 * before, "a smaller sphere")
source.Radius = 0.5
check(get_covered(render(view)).sum() == before, "and as large as it was")
display.Visibility = 0
check(not get_covered(render(view)).any(), "hidden")
display.Visibility = 1
check(get_covered(render(view)).sum() == before, "shown again")
simple.Delete(source)

# What is wrong is said, once, and nothing is lost.
NOTHING = "pass"
ONLY_ONE_RANK = """
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController
controller = vtkMultiProcessController.GetGlobalController()
if controller.GetLocalProcessId() == controller.GetNumberOfProcesses() - 1:
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(64)
    sphere.SetPhiResolution(48)
    sphere.Update()
    self.GetOutputDataObject(0).ShallowCopy(sphere.GetOutput())
"""
empty = simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=NOTHING)
with Messages() as messages:
    show_traced(empty, view)
    pixels = render(view)
    text = messages.text
check(not get_covered(pixels).any(), "an empty mesh is an empty picture")
check(text.strip() == "", "without a word")
simple.Delete(empty)

one = simple.ProgrammableSource(OutputDataSetType="vtkPolyData", Script=ONLY_ONE_RANK)
with Messages() as messages:
    display = show_traced(one, view)
    place_camera(view)
    simple.Render(view)
    text = messages.text
check(text.strip() == "", "one rank has all triangles, the others none: " + text)
pixels = render(view, "OneRankHasEverything")
check(get_covered(pixels).any(), "and they are drawn")
with Messages() as messages:
    display.ColorArrayName = ["POINTS", "pressure"]
    wrong = render(view)
    text = messages.text
    render(view)
    again = messages.text
check("'pressure' does not exist" in text and "'Normals'" in text, "an unknown array: " + text)
check(text == again, "which is said once")
check((get_covered(wrong) == get_covered(pixels)).all(), "and the surface is shown without it")
display.ColorArrayName = [None, ""]
check_equal(render(view), pixels, "until it is right again")
simple.Delete(one)

# ParaView's views of slices show meshes traced beside these.
sphere = simple.Sphere(ThetaResolution=64, PhiResolution=48)
for kind in ("MultiSlice", "OrthographicSliceView"):
    slices = simple.CreateView(kind)
    slices.ViewSize = [400, 300]
    slices.OrientationAxesVisibility = 0
    show_traced(sphere, slices, DSMLook="Plain")
    simple.ResetCamera(slices)
    traced = render(slices)
    show_surface(sphere, slices)
    check_same_surface(traced, render(slices), f"a mesh in a {kind}")
    simple.Delete(slices)
