# SPDX-License-Identifier: BSD-3-Clause
"""What the pvbatch tests share. They are run by run.py, as `TestX.py PLUGIN OUTPUT`: PLUGIN is
DSMRayTracer.so, OUTPUT a folder for pictures, one for each number of ranks."""

import json
import os
import sys

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

PLUGIN, OUTPUT = sys.argv[1], sys.argv[2]
REPRESENTATION = "DSM Ray Traced"
is_on_ranks = False  # the plugin, which outlives a session, and which ParaView 6.1 will not load there anew


def connect(port):
    """Connects to a server, unless a script before this one, in the same start of ParaView, has done so."""
    if not servermanager.ActiveConnection.IsRemote():
        simple.Connect("127.0.0.1", int(port))


def load_plugin():
    global is_on_ranks
    if servermanager.ActiveConnection.IsRemote() and not is_on_ranks:
        simple.LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        is_on_ranks = True
    simple.LoadPlugin(PLUGIN, remote=False, ns=vars(simple))
    os.makedirs(OUTPUT, exist_ok=True)


def get_ranks():
    return vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()


def can_load_states():
    """Whether LoadState of a .pvsm comes back: with ParaView 6.1 and several ranks it waits for ever, also of a state
    that shows a Sphere and knows nothing of the plugin."""
    return get_ranks() == 1 or simple.GetParaViewVersion() < (6, 0)


def create_view(width=300, height=240):
    view = simple.CreateRenderView(ViewSize=[width, height])
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.BackgroundColorMode = "Single Color"
    view.Background = [0.0, 0.0, 0.2]
    return view


def show_traced(source, view, **properties):
    """A dataset of any kind, as its surface, in its own colour."""
    display = simple.Show(source, view)
    display.Representation = REPRESENTATION
    display.ColorArrayName = [None, ""]
    for name, value in properties.items():
        setattr(display, name, value)
    return display


def show(source, view, isovalues, array=None, **properties):
    chosen = {"DSMIsoArray": ["POINTS", array]} if array else {}
    return show_traced(source, view, DSMShow="Isosurfaces", **chosen, DSMIsoValues=isovalues, **properties)


def show_surface(source, view):
    display = simple.Show(source, view)
    display.Representation = "Surface"
    display.ColorArrayName = [None, ""]
    return display


def transform(display, translation=(0, 0, 0), orientation=(0, 0, 0), scale=(1, 1, 1)):
    """Sets a representation's transform; ParaView 5.13 calls Translation what was Position."""
    name = "Translation" if display.SMProxy.GetProperty("Translation") else "Position"
    setattr(display, name, list(translation))
    display.Orientation = list(orientation)
    display.Scale = list(scale)


def place_camera(view, position=(0.6, 0.5, 1.0)):
    """Looks at everything from a direction."""
    view.CameraViewUp = [0, 1, 0]
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = list(position)
    simple.ResetCamera(view)


def render(view, name=None):
    """The picture as rows of pixels from the bottom, red first. With a name, it is also saved, and
    must be what one rank made."""
    simple.Render(view)
    image = view.SMProxy.CaptureWindow(1)
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)
    pixels = pixels[:, :, :3].astype(int)
    if name:
        simple.SaveScreenshot(os.path.join(OUTPUT, f"{name}.{get_ranks()}.png"), view)
        reference = os.path.join(OUTPUT, name + ".npy")
        if get_ranks() == 1:
            numpy.save(reference, pixels)
        else:
            check_equal(pixels, numpy.load(reference), name + " is what one rank draws")
    return pixels


def grab(view, name=None):
    """What the window shows, without rendering, as rows of pixels like render's. With a name, it is also saved."""
    image = vtkWindowToImageFilter()
    image.SetInput(view.GetRenderWindow())
    image.ShouldRerenderOff()
    image.ReadFrontBufferOff()
    image.Update()
    if name:
        writer = vtkPNGWriter()
        writer.SetFileName(os.path.join(OUTPUT, f"{name}.{get_ranks()}.png"))
        writer.SetInputData(image.GetOutput())
        writer.Write()
    width, height, _ = image.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(image.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, -1)[:, :, :3].astype(int)


def select(view, source, kind, region):
    """Coordinates of the cells or points that are selected, as ParaView extracts them: their numbers and bounds."""
    simple.ClearSelection(source)
    {"cells": simple.SelectSurfaceCells, "points": simple.SelectSurfacePoints}[kind](
        Rectangle=region, View=view)
    extract = simple.ExtractSelection(Input=source)
    extract.UpdatePipeline()
    merged = simple.MergeBlocks(extract)
    merged.UpdatePipeline()
    information = merged.GetDataInformation()
    result = (information.GetNumberOfCells(), information.GetNumberOfPoints(),
              numpy.round(information.GetBounds(), 5).tolist())
    simple.Delete(merged)
    simple.Delete(extract)
    return result


def get_rows(display):
    """The statistics of each rank (vtkDSMStatistics::GetJson)."""
    display.SMProxy.UpdatePropertyInformation()
    return json.loads(str(display.GetProperty("DSMStatistics")).strip("'"))


def get_covered(pixels):
    """Which pixels are not background, the lower left one being background."""
    return (abs(pixels - pixels[0, 0]) > 2).any(axis=2)


def check(condition, what):
    if not condition:
        raise AssertionError(what)
    print("ok:", what, flush=True)


def check_equal(a, b, what, tolerance=1):
    """Compositing may round the last bit."""
    check(a.shape == b.shape and abs(a - b).max() <= tolerance, what)


def check_same_surface(traced, reference, what, share=0.005):
    covered, expected = get_covered(traced), get_covered(reference)
    check(expected.mean() > 0.02, what + ": the reference shows something")
    wrong = (covered != expected).mean()
    check(wrong <= share, f"{what}: covers the same pixels but {100 * wrong:.2f} %")
    both = covered & expected
    difference = abs(traced - reference).mean(axis=2)[both].mean()
    check(difference < 8, f"{what}: mean difference of the shading is {difference:.1f} of 255")


class Messages:
    """Collects what rank 0 reports instead of printing it."""

    def __enter__(self):
        self.previous = vtkOutputWindow.GetInstance()
        self.window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self.window)
        return self

    def __exit__(self, *_):
        vtkOutputWindow.SetInstance(self.previous)

    @property
    def text(self):
        return self.window.GetOutput()


IMAGE_SOURCE_INFORMATION = """
from paraview import util
util.SetOutputWholeExtent(self, [%s])
"""

TIME_STEPS = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
information = self.GetExecutive().GetOutputInformation().GetInformationObject(0)
information.Set(pipeline.TIME_STEPS(), [0.0, 1.0, 2.0], 3)
information.Set(pipeline.TIME_RANGE(), [0.0, 2.0], 2)
"""

IMAGE_SOURCE_IN_PARTS = """
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
self.GetOutputInformation(0).Set(vtkAlgorithm.CAN_PRODUCE_SUB_EXTENT(), 1)
"""

IMAGE_SOURCE = """
from builtins import max, min
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()
whole = [{extent}]
request = self.GetExecutive().GetOutputInformation().GetInformationObject(0)
piece = [0] * 6
request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_EXTENT(), piece)
image = self.GetOutputDataObject(0)
def points(extent):
    k, j, i = np.meshgrid(np.arange(extent[4], extent[5] + 1.0),
        np.arange(extent[2], extent[3] + 1.0), np.arange(extent[0], extent[1] + 1.0),
        indexing='ij')
    return i.ravel(), j.ravel(), k.ravel()
def distance(extent):
    '''From the middle of the whole extent, 1 at its nearest face.'''
    total = 0
    for axis, p in enumerate(points(extent)):
        low, high = whole[2 * axis], whole[2 * axis + 1]
        total = total + ((p - 0.5 * (low + high)) / (0.5 * (high - low))) ** 2
    return np.sqrt(total)
def add(image, values, name='f'):
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    image.GetPointData().AddArray(array)
    image.GetPointData().SetActiveScalars(name)
    return array
{script}
"""


def image_source(script, extent=(0, 24, 0, 24, 0, 24), in_parts=False, kind="vtkImageData"):
    """An image data source: `script` fills `image` with its `piece` of the whole extent. In parts: each rank is asked
    for one of its own; else all are asked for the whole."""
    text = ", ".join(str(value) for value in extent)
    source = simple.ProgrammableSource(OutputDataSetType=kind)
    source.ScriptRequestInformation = IMAGE_SOURCE_INFORMATION % text + (IMAGE_SOURCE_IN_PARTS if in_parts else "")
    source.Script = IMAGE_SOURCE.format(extent=text, script=script)
    return source


FLYING_EDGES = """
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkFlyingEdges3D
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkImageData
data = self.GetInputDataObject(0, 0)
append = vtkAppendPolyData()
images = [data] if data.IsA('vtkImageData') else []
if data.IsA('vtkCompositeDataSet'):
    leaf = data.NewIterator()
    while not leaf.IsDoneWithTraversal():
        images.append(leaf.GetCurrentDataObject())
        leaf.GoToNextItem()
for image in images:
    if image.GetNumberOfCells() == 0 or image.GetPointData().GetScalars() is None:
        continue
    # In double: with unsigned integers of 32 bits and more, its differences wrap around.
    plain = image.NewInstance()
    plain.ShallowCopy(image)
    scalars = vtkDoubleArray()
    scalars.DeepCopy(image.GetPointData().GetScalars())
    scalars.SetName('in double')
    plain.GetPointData().SetScalars(scalars)
    edges = vtkFlyingEdges3D()
    edges.SetInputData(plain)
    edges.ComputeNormalsOn()
    edges.ComputeScalarsOff()
    for index, value in enumerate({isovalues}):
        edges.SetValue(index, value)
    edges.Update()
    append.AddInputData(edges.GetOutput())
if append.GetNumberOfInputConnections(0) > 0:
    append.Update()
    self.GetOutputDataObject(0).ShallowCopy(append.GetOutput())
"""


def flying_edges(source, isovalues):
    """The same isosurfaces as triangles; unlike Contour, this honours the direction matrix."""
    surface = simple.ProgrammableFilter(source, OutputDataSetType="vtkPolyData")
    surface.Script = FLYING_EDGES.format(isovalues=list(isovalues))
    return surface


def compare_with_triangles(
    view, name, source, isovalues=(0.7,), array=None, reference=None, share=0.005, **properties
):
    """Draws a source and compares: one rank with vtkFlyingEdges3D's triangles (of `reference`, if the
    source itself would mislead it), several ranks with what one rank drew. Deletes the sources."""
    show(source, view, list(isovalues), array, **properties)
    place_camera(view)
    picture = render(view, name)
    if get_ranks() == 1:
        simple.Hide(source, view)
        surface = flying_edges(reference or source, isovalues)
        show_surface(surface, view)
        check_same_surface(picture, render(view), name, share)
        simple.Delete(surface)
    simple.Delete(source)
    if reference:
        simple.Delete(reference)
