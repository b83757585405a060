# SPDX-License-Identifier: BSD-3-Clause
"""Exported scenes hold what is traced, as triangles, whether the data are here or on a server. Called as
TestExport.py PLUGIN OUTPUT [PORT]."""

import importlib.util
import json
import math
import re
import zipfile

from dsm_testing import *
from vtkmodules.vtkFiltersCore import (
    vtkCellDataToPointData, vtkContourGrid, vtkFlyingEdges3D, vtkPointDataToCellData, vtkThreshold)
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

if len(sys.argv) > 3:
    connect(sys.argv[3])
load_plugin()
view = create_view()
wavelet = simple.Wavelet()
display = show(wavelet, view, [150.0], "RTData")
place_camera(view)
render(view)


def read_gltf(name):
    """Sums of points and triangles of a file, and the bounds of the points."""
    with open(name) as file:
        scene = json.load(file)
    points, triangles, low, high = 0, 0, [], []
    for mesh in scene["meshes"] or []:
        for primitive in mesh["primitives"]:
            place = scene["accessors"][primitive["attributes"]["POSITION"]]
            points += place["count"]
            low.append(place["min"])
            high.append(place["max"])
            triangles += scene["accessors"][primitive["indices"]]["count"] // 3
    return points, triangles, numpy.min(low, axis=0) if low else None, numpy.max(high, axis=0) if high else None


def read_points(name):
    """Places and normals of the points of an X3D file."""
    with open(name) as file:
        text = file.read()
    return [numpy.array(" ".join(re.findall(f'{kind}="([^"]*)"', text)).replace(",", " ").split(), "f8").reshape(-1, 3)
            for kind in ("point", "vector")]


def read_colors(name):
    """The colors of the points of a glTF file, one row each."""
    with open(name) as file:
        scene = json.load(file)
    colors = []
    for mesh in scene["meshes"]:
        for primitive in mesh["primitives"]:
            accessor = scene["accessors"][primitive["attributes"]["COLOR_0"]]
            part = scene["bufferViews"][accessor["bufferView"]]
            uri = scene["buffers"][part["buffer"]]["uri"]
            with open(os.path.join(os.path.dirname(name), uri), "rb") as file:
                data = file.read()[part.get("byteOffset", 0):][:part["byteLength"]]
            columns = {"VEC3": 3, "VEC4": 4}[accessor["type"]]
            values = numpy.frombuffer(data, {5121: "u1", 5126: "f4"}[accessor["componentType"]])
            colors.append(values.reshape(-1, columns) / (255.0 if values.dtype == "u1" else 1.0))
    return numpy.concatenate(colors)


def export(name):
    path = os.path.join(OUTPUT, f"{'server' if len(sys.argv) > 3 else 'alone'}.{get_ranks()}.{name}")
    if os.path.exists(path):
        os.remove(path)
    with Messages() as messages:
        simple.ExportView(path, view=view)
    check("err" not in messages.text.lower(), f"{name} is exported without an error: {messages.text.strip()}")
    return path


# On several ranks, Contour's number counts ghost cells.
contour = simple.Contour(Input=wavelet, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0])
contour.UpdatePipeline()
volume = vtkRTAnalyticSource()
edges = vtkFlyingEdges3D()
edges.SetInputConnection(volume.GetOutputPort())
edges.SetValue(0, 150.0)
edges.Update()
expected = edges.GetOutput().GetNumberOfCells()
points, triangles, low, high = read_gltf(export("isosurface.gltf"))
check(triangles == expected, f"{triangles} triangles in glTF, of {expected}")
bounds = contour.GetDataInformation().GetBounds()
check(abs(low - bounds[0::2]).max() < 0.01 and abs(high - bounds[1::2]).max() < 0.01, "where Contour has them")

simple.ColorBy(display, ("POINTS", "RTData"))
with open(export("isosurface.x3d")) as file:
    text = file.read()
indices = re.search(r'coordIndex="([^"]*)"', text)
check(indices is not None and indices.group(1).count("-1") == triangles, "as many in X3D")
with open(export("isosurface.vrml")) as file:
    check("IndexedFaceSet" in file.read(), "there are faces in VRML")

# Volumes and slices are no triangles.
for kind in ("DSM Volume", "DSM Slices"):
    display.Representation = kind
    render(view)
    with Messages() as messages:
        simple.ExportView(os.path.join(OUTPUT, "none.gltf"), view=view)
    check("screenshot" in messages.text and messages.text.count(kind) == 1, f"{kind}: an error names a way out")
display.Representation = REPRESENTATION
render(view)

# What is clipped, placed, hidden or without a surface.
display.DSMClip = 1
display.DSMClipOrigin, display.DSMClipNormal = [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]
clipped = read_gltf(export("clipped.gltf"))
check(0.3 * triangles < clipped[1] < 0.7 * triangles and clipped[2][0] > -1e-5, "what a clip leaves")
display.DSMClip = 0
simple.Hide(wavelet, view)
check(read_gltf(export("hidden.gltf"))[1] == 0, "nothing of what is hidden")
simple.Show(wavelet, view)
display.DSMIsoValues = [1e6]
check(read_gltf(export("empty.gltf"))[1] == 0, "nothing where there is no surface")
simple.Hide(wavelet, view)

# A volume that is looked through in several parts has no seams.
large = simple.Wavelet(WholeExtent=[-70, 75, -10, 10, -66, 70])
show(large, view, [150.0], "RTData")
render(view)
volume.SetWholeExtent(-70, 75, -10, 10, -66, 70)
edges.Update()
whole = edges.GetOutput()
count, triangles, low, high = read_gltf(export("parts.gltf"))
check(triangles == whole.GetNumberOfCells(), f"{triangles} triangles of {whole.GetNumberOfCells()}")
check(whole.GetNumberOfPoints() <= count <= 1.1 * whole.GetNumberOfPoints(), f"{count} points")
points, normals = read_points(export("parts.x3d"))
place = {tuple(point): normal for point, normal in zip(points.round(2) + 0.0, normals)}
expected = whole.GetPointData().GetNormals()
wrong = 0
for number in range(whole.GetNumberOfPoints()):
    normal = place.get(tuple(numpy.array(whole.GetPoint(number)).round(2) + 0.0))
    wrong += normal is None or abs(normal - expected.GetTuple(number)).max() > 0.01
check(wrong <= 0.01 * whole.GetNumberOfPoints(),
      f"{wrong} of {whole.GetNumberOfPoints()} points or normals are not those of all at once")
simple.Hide(large, view)

# Means of cells: without gaps between the cells of a server's ranks.
cells = simple.PointDatatoCellData(simple.Wavelet())
show_traced(cells, view, DSMIsoArray=["CELLS", "RTData"], DSMIsoValues=[150.0])
render(view)
to_cells, to_points = vtkPointDataToCellData(), vtkCellDataToPointData()
volume.SetWholeExtent(-10, 10, -10, 10, -10, 10)
to_cells.SetInputConnection(volume.GetOutputPort())
to_points.SetInputConnection(to_cells.GetOutputPort())
edges.SetInputConnection(to_points.GetOutputPort())
edges.Update()
expected = edges.GetOutput().GetNumberOfCells()
triangles = read_gltf(export("cells.gltf"))[1]
check(triangles == expected, f"{triangles} triangles of {expected}")
simple.Hide(cells, view)

# Where values are ignored, surfaces end, and have no shell around these.
display.DSMIsoValues, display.DSMIgnoreValues, display.DSMValidRange = [150.0], 1, [130.0, 200.0]
simple.Show(wavelet, view)
render(view)
valid, surface = vtkThreshold(), vtkContourGrid()
valid.SetInputConnection(volume.GetOutputPort())
valid.SetLowerThreshold(130.0)
valid.SetUpperThreshold(200.0)
surface.SetInputConnection(valid.GetOutputPort())
surface.SetValue(0, 150.0)
surface.Update()
found, expected = read_gltf(export("missing.gltf"))[1], surface.GetOutput().GetNumberOfCells()
check(found == expected and 0 < found < triangles, f"{found} triangles of {expected} between valid values")
simple.Hide(wavelet, view)

# Blocks that have a look of their own.
halves = [simple.Wavelet(WholeExtent=[low, low + 10, -10, 10, -10, 10]) for low in (-10, 0)]
blocks = simple.GroupDatasets(Input=halves, BlockNames=["one", "two"])
shown = show(blocks, view, [150.0], "RTData")
render(view)


def read_materials(name):
    """Colours and triangles of the parts of a file."""
    with open(name) as file:
        scene = json.load(file)
    parts = [part for mesh in scene["meshes"] or [] for part in mesh["primitives"]]
    return {tuple(round(number, 2) for number in
                  scene["materials"][part["material"]]["pbrMetallicRoughness"]["baseColorFactor"]):
            scene["accessors"][part["indices"]]["count"] // 3 for part in parts}


alike = read_materials(export("blocks.gltf"))
check(list(alike) == [(1.0, 1.0, 1.0, 1.0)], f"blocks without a look of their own are together: {alike}")
shown.BlockColors = ["/Root/one", "0.25", "0.5", "1.0"]
shown.BlockOpacities = ["/Root/two", "0.5"]
render(view)
own = read_materials(export("block_looks.gltf"))
check(sorted(own) == [(0.25, 0.5, 1.0, 1.0), (1.0, 1.0, 1.0, 0.5)], f"each has its own: {own}")
check(sum(own.values()) == sum(alike.values()), "and nothing is lost")
simple.Hide(blocks, view)

# The outer surface of image data.
simple.Hide(wavelet, view)
box = simple.Wavelet()
outside = show_traced(box, view, DSMShow="Surface")
render(view)
found = read_gltf(export("surface.gltf"))[1]
check(found == 6 * 2 * 20 * 20, f"the outer surface has {found} triangles")
simple.Delete(box)

# AMR and hyper tree grids.
pulse = simple.AMRGaussianPulseSource(XPulseWidth=1.0, YPulseWidth=1.0, ZPulseWidth=1.0)
shown = show_traced(pulse, view, DSMIsoArray=["CELLS", "Gaussian-Pulse"], DSMIsoValues=[0.2])
simple.ColorBy(shown, ("CELLS", "Gaussian-Pulse"))
render(view)
points, normals = read_points(export("amr.x3d"))
radii = numpy.linalg.norm(points, axis=1)
radius = pulse.XPulseWidth * math.sqrt(math.log(pulse.PulseAmplitude / 0.2))
# Between the centers of cells: a Gaussian is not linear in the half cell beyond them.
inside = radii[((points >= [-1.75, -1.75, 0.25]) & (points <= [0.25, 0.25, 2.25])).all(axis=1)]
check(len(inside) > 20 and abs(inside - radius).max() < 0.1,
      f"{len(inside)} points with radii from {inside.min()} to {inside.max()}, of {radius}")
outward = (normals * points).sum(axis=1) / radii
check(outward.min() > 0.8, f"normals point where values fall: {outward.min()}")
colors = read_colors(export("amr.gltf"))
check(len(colors) == len(points) and colors.std(axis=0).max() < 0.05, f"colored by the isovalue: {colors.std(axis=0)}")
simple.Delete(pulse)
trees = simple.HyperTreeGridRandom()
show_traced(trees, view, DSMShow="Isosurfaces", DSMIsoArray=["CELLS", "Depth"])
render(view)
found = read_gltf(export("trees.gltf"))[1]
check(found > 1000, f"{found} triangles of hyper trees")
simple.Delete(trees)

# A mesh.
ball = simple.Sphere(ThetaResolution=32, PhiResolution=24)
mesh = show_traced(ball, view)
found = read_gltf(export("mesh.gltf"))[1]
check(found == 2 * 32 * 22, f"a mesh has {found} triangles")

# For vtk.js, which nothing of a traced volume reaches, what is drawn is packed, with the names of its datasets.
simple.Delete(mesh)
show_surface(ball, view)
simple.Hide(wavelet, view)
render(view)
simple.RenameSource("ball", ball)
# ParaView packs it by a module of a package that Debian 14 does not have.
if importlib.util.find_spec("paraview.web"):
    with zipfile.ZipFile(export("scene.vtkjs")) as scene:
        names = [item["name"] for item in json.loads(scene.read("index.json"))["scene"]]
    check("ball" in names, f"a scene for vtk.js has {names}")
