# SPDX-License-Identifier: BSD-3-Clause
"""Structured and unstructured grids: isosurfaces beside Contour's, volumes and slices; the same on any number of ranks,
as ParaView divides its sources. Also those of files: of several blocks, with ids, with polyhedra."""

import grid_files
from dsm_testing import *

load_plugin()
view = create_view(220, 180)
view.UseFXAA = 0

# Bends a piece of an image, so that no two cells have the same shape.
CURVILINEAR = """
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
image, grid = self.GetInputDataObject(0, 0), self.GetOutputDataObject(0)
grid.SetExtent(image.GetExtent())
x, y, z = np.array([image.GetPoint(point) for point in range(image.GetNumberOfPoints())]).reshape(-1, 3).T
points = vtkPoints()
points.SetData(numpy_to_vtk(np.stack([x + np.sin(0.4 * y), y + np.sin(0.3 * z + 1.0), z + np.sin(0.5 * x)], axis=1),
    deep=True))
grid.SetPoints(points)
grid.GetPointData().ShallowCopy(image.GetPointData())
grid.GetCellData().ShallowCopy(image.GetCellData())
"""
# Smooth: Contour takes normals of unstructured grids from its triangles.
wavelet = simple.Wavelet(WholeExtent=[-9, 9] * 3, XMag=2, YMag=4, ZMag=2)
curvilinear = simple.ProgrammableFilter(Input=wavelet, OutputDataSetType="vtkStructuredGrid", Script=CURVILINEAR)
hexahedra = simple.AppendDatasets(Input=curvilinear)
tetrahedra = simple.Tetrahedralize(Input=curvilinear)
of_cells = simple.PointDatatoCellData(Input=hexahedra)
kinds = {"Curvilinear": (curvilinear, "vtkStructuredGrid"), "Hexahedra": (hexahedra, "vtkUnstructuredGrid"),
         "Tetrahedra": (tetrahedra, "vtkUnstructuredGrid"), "OfCells": (of_cells, "vtkUnstructuredGrid")}


def show_without_messages(display, name, **properties):
    with Messages() as messages:
        for property, value in properties.items():
            setattr(display, property, value)
        render(view)
    pixels = render(view, None if name.startswith("Tetrahedra") else name)  # ranks have other tetrahedra
    check(not messages.text.strip(), f"{name}: no message: {messages.text.strip()}")
    return pixels


def show_contour(source, name):
    points = source
    if name == "OfCells":
        # ParaView's means at points know no cells of other ranks, unless there are ghost cells.
        add_ghosts = getattr(simple, "GhostCellsGenerator", None) or simple.GhostCells  # since ParaView 6.1
        points = add_ghosts(Input=source) if get_ranks() > 1 else source
        points = simple.CellDatatoPointData(Input=points)
    contour = simple.Contour(Input=points, ContourBy=["POINTS", "RTData"], Isosurfaces=[150.0], ComputeScalars=0)
    show_surface(contour, view)
    pixels = render(view)
    simple.Delete(contour)
    return pixels


pictures = {}
for name, (source, type) in kinds.items():
    source.UpdatePipeline()
    check(source.GetDataInformation().GetDataSetTypeAsString() == type, f"{name} is a {type}")
    display = show_traced(source, view)
    check(display.DSMShow == "Surface", f"{name}: the surface is shown at first")
    place_camera(view)
    surface = render(view)
    array = ["CELLS" if name == "OfCells" else "POINTS", "RTData"]
    # The array and the isovalue come from the data.
    show_without_messages(display, f"{name}First", DSMShow="Isosurfaces")
    check(list(display.DSMIsoArray) == array, f"{name}: {list(display.DSMIsoArray)} is chosen")
    check(60.0 < display.DSMIsoValue < 260.0, f"{name}: isovalue {display.DSMIsoValue} is chosen")
    pictures[name] = show_without_messages(display, name, DSMIsoValues=[150.0])
    check((pictures[name] != surface).any(), f"{name}: isosurfaces are not the surface")
    simple.Hide(source, view)
    check_same_surface(pictures[name], show_contour(source, name), name)
    display = simple.Show(source, view)
    simple.ColorBy(display, tuple(array))
    # A fixed range: ranks may know others.
    simple.GetColorTransferFunction("RTData").RescaleTransferFunction(60.0, 260.0)
    simple.GetOpacityTransferFunction("RTData").RescaleTransferFunction(60.0, 260.0)
    # The cells in which the surface, or the slice, is seen.
    everything = [0, 0, 219, 179]
    display.DSMIsoValues = [150.0]
    simple.Render(view)
    cells, _, _ = select(view, source, "cells", everything)
    check(50 < cells < source.GetDataInformation().GetNumberOfCells() / 4, f"{name}: {cells} cells are selected")
    simple.ClearSelection(source)
    colored = show_without_messages(display, f"{name}Colored", DSMIsoValues=[100.0, 200.0])
    check((colored != pictures[name]).any(), f"{name}: colors")
    if name not in ("Curvilinear", "OfCells"):
        simple.Hide(source, view)
        continue
    # The default depends on the number of points, and so on ranks that share some.
    volume = show_without_messages(display, f"{name}Volume", Representation="DSM Volume",
                                   ScalarOpacityUnitDistance=2.0)
    check(get_covered(volume).mean() > 0.05, f"{name}: a volume is shown")
    slice_of_z = show_without_messages(display, f"{name}Slice", Representation="DSM Slices")
    check(get_covered(slice_of_z).mean() > 0.05, f"{name}: a slice is shown")
    other = show_without_messages(display, f"{name}OtherSlice", DSMSliceNormal=[1, 0, 0], DSMSliceOrigin=[2, 0, 0])
    check((other != slice_of_z).any(), f"{name}: another slice")
    cells, _, bounds = select(view, source, "cells", everything)
    check(cells > 50 and bounds[0] < 2.0 < bounds[1] and bounds[1] - bounds[0] < 6.0,
          f"{name}: {cells} cells in {bounds} are selected in the slice")
    simple.ClearSelection(source)
    display.DSMSlicePlane = 0
    check(not get_covered(render(view)).any(), f"{name}: no slice")
    simple.Hide(source, view)
check_equal(pictures["Curvilinear"], pictures["Hexahedra"], "a structured grid is as its hexahedra", 0)

# Blocks of several kinds: an image, hexahedra and a surface.
sphere = simple.Sphere(Center=[20, 20, 0], Radius=6)
moved = simple.Transform(Input=hexahedra, Transform="Transform")
moved.Transform.Translate = [24, 0, 0]
moved.TransformAllInputVectors = 0
group = simple.GroupDatasets(Input=[wavelet, moved, sphere])
display = show_traced(group, view)
with Messages() as messages:
    display.DSMShow, display.DSMIsoArray, display.DSMIsoValues = "Isosurfaces", ["POINTS", "RTData"], [150.0]
    render(view)
    place_camera(view)
    render(view)
together = render(view, "Blocks")
reports = [word for word in ("Warning:", "ERROR:") if word in messages.text]
check(not reports, f"Blocks: no message: {messages.text if reports else ''}")
simple.Hide(group, view)
for source in (wavelet, moved):
    show(source, view, [150.0], "RTData")
show_traced(sphere, view)
check_equal(render(view), together, "Blocks: as apart")
simple.Hide(wavelet, view)
simple.Hide(moved, view)
simple.Hide(sphere, view)

# Files of simulations, as ParaView's readers give them. One rank writes them.
exodus = os.path.join(OUTPUT, "cells.e")
if get_ranks() == 1:
    simple.SaveData(exodus, hexahedra)
foam = grid_files.write_open_foam(os.path.join(OUTPUT, "foam"))
ensight = grid_files.write_ensight(os.path.join(OUTPUT, "ensight"))
files = {
    # Its ids of points come before its values.
    "Exodus": (simple.ExodusIIReader(FileName=[exodus]), "POINTS", "RTData", 150.0),
    "EnSight": (simple.EnSightReader(CaseFileName=ensight), "POINTS", "f", 3.3),
    "OpenFOAM": (simple.OpenFOAMReader(FileName=foam), "POINTS", "T", 3.3),
    "Decomposed": (simple.OpenFOAMReader(FileName=foam, CaseType="Decomposed Case"), "CELLS", "T", 3.3),
}
for name in ("OpenFOAM", "Decomposed"):
    files[name][0].Createcelltopointfiltereddata = 1  # off from ParaView 6 on
decomposed = files["Decomposed"][0]
if "Decomposepolyhedra" in decomposed.ListProperties():  # before ParaView 6
    decomposed.Decomposepolyhedra = 0
view.ViewTime = 1.0
for name, (source, association, array, isovalue) in files.items():
    source.UpdatePipeline(1.0)
    display = show_traced(source, view)
    for representation in (REPRESENTATION, "DSM Volume", "DSM Slices"):
        check(representation in display.GetProperty("Representation").Available, f"{name}: {representation} is offered")
    place_camera(view)  # after a picture of other bounds
    display.DSMShow = "Isosurfaces"
    check(display.DSMIsoArray[1] == array, f"{name}: {list(display.DSMIsoArray)} is chosen")
    low, high = source.GetDataInformation().GetArrayInformation(array, 0).GetComponentRange(0)
    check(low < display.DSMIsoValue < high, f"{name}: isovalue {display.DSMIsoValue} is chosen")
    picture = show_without_messages(display, name, DSMIsoArray=[association, array], DSMIsoValues=[isovalue])
    simple.Hide(source, view)
    if get_ranks() == 1:
        points = simple.MergeBlocks(Input=source)
        if association == "CELLS":
            points = simple.CellDatatoPointData(Input=points)
        contour = simple.Contour(Input=points, ContourBy=["POINTS", array], Isosurfaces=[isovalue], ComputeScalars=0)
        show_surface(contour, view)
        check_same_surface(picture, render(view), name)
        simple.Delete(contour)

# A closed isosurface through cells of unlike kinds, of pieces on all ranks, has no gap: no background is seen from
# within, and a lamp within lights nothing of a room around it.
source = files["EnSight"][0]
display = show(source, view, [3.3], "f")
simple.ResetCamera(view)
center = [4.3, 3.8, 4.1]
view.CameraPosition, view.CameraViewAngle = center, 100.0
directions = [[1.0, 0.2, 0.1], [-0.6, 1.0, 0.3], [0.1, -0.4, -1.0], [-1.0, -1.0, 0.5]]
for direction in directions:
    view.CameraFocalPoint = [place + step for place, step in zip(center, direction)]
    check((render(view) != [0, 0, 51]).any(axis=2).all(), f"no background is seen towards {direction}")
room = simple.Sphere(Center=center, Radius=20, ThetaResolution=32, PhiResolution=32)
show_traced(room, view)
lamp = simple.CreateLight()
lamp.Coords, lamp.Type, lamp.ConeAngle = "Scene", "Positional", 180.0
lamp.Position, lamp.FocalPoint = center, [5.0, 4.0, 4.0]
view.AdditionalLights, view.UseLight = [lamp], 0
for direction in directions:
    view.CameraPosition = [place + 12.0 * step for place, step in zip(center, direction)]
    view.CameraFocalPoint = center
    display.DSMShadows = 0
    check(get_covered(render(view)).any(), "the lamp lights the room")
    display.DSMShadows = 1
    check(render(view).max() == 0, f"the lamp is hidden from {direction}")
