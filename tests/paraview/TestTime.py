# SPDX-License-Identifier: BSD-3-Clause
"""Data that change: time steps, edited sources, reloaded files."""

from dsm_testing import *
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

load_plugin()
view = create_view()

TIME_INFORMATION = IMAGE_SOURCE_INFORMATION % "0, 24, 0, 24, 0, 24" + TIME_STEPS
steps = image_source("""
time = request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP())
image.SetExtent(piece)
add(image, distance(piece) + 0.2 * (time or 0.0))
""")
steps.ScriptRequestInformation = TIME_INFORMATION
steps.UpdatePipelineInformation()
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()


def play(cached):
    view.Update()
    pictures = []
    for time in (0.0, 1.0, 2.0, 1.0, 0.0):
        scene.AnimationTime = time
        view.ViewTime = time
        pictures.append(render(view, f"Step{time:.0f}"))
    sizes = [get_covered(picture).sum() for picture in pictures]
    check(sizes[0] > sizes[1] > sizes[2] > 0, f"the sphere shrinks: {sizes}{cached}")
    check_equal(pictures[0], pictures[4], "the first step again")
    check_equal(pictures[1], pictures[3], "the second step again")


show(steps, view, [0.7])
place_camera(view)
play("")
settings = simple.GetSettingsProxy("GeneralSettings")
settings.CacheGeometryForAnimation = 1
view.UseCache = 1
play(", with the geometry cache on")
view.UseCache = 0
settings.CacheGeometryForAnimation = 0
simple.Delete(steps)

# What a time step does not change keeps its bricks, be the arrays new objects or old ones.


def count_publications(display):
    return get_rows(display)[0]["Publications"]


def check_publications(display, expected, what):
    """Plays some steps; `expected` of them cut one array or surface into bricks. Returns the pictures."""
    view.Update()
    before = count_publications(display)
    pictures = []
    for time in (0.0, 1.0, 2.0, 1.0):
        scene.AnimationTime = time
        view.ViewTime = time
        pictures.append(render(view))
    made = count_publications(display) - before
    check(made == expected, f"{what}: {made} times something was cut into bricks")
    return pictures


TIME = "time = request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()) or 0.0"
half = image_source(TIME + """
image.SetExtent(piece)
add(image, points(piece)[2] * (1.0 + time), 'changing')
add(image, distance(piece), 'constant')
""")
half.ScriptRequestInformation = TIME_INFORMATION
half.UpdatePipelineInformation()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = view.ViewTime = 2.0
display = show(half, view, [0.7], "constant")
place_camera(view)
render(view)
same = check_publications(display, 0, "an array that stays the same")
check_equal(same[0], same[1], "and the picture does", tolerance=0)
simple.ColorBy(display, ("POINTS", "changing"))
simple.GetColorTransferFunction("changing").RescaleTransferFunction(0.0, 72.0)
simple.GetColorTransferFunction("changing").AutomaticRescaleRangeMode = "Never"
scene.AnimationTime = view.ViewTime = 2.0
render(view)
changing = check_publications(display, 4, "a surface that stays, with colours that do not")
check((changing[0] != changing[1]).any(), "the colours change")
check_equal(changing[1], changing[3], "and come back", tolerance=0)
simple.Delete(half)

# Values that are written to the same array by somebody who does not say so, as simulations do.
in_place = image_source(TIME + """
import sys
keep = vars(sys).setdefault('dsm_in_place', {})
if 'array' not in keep:
    keep['array'] = np.zeros(distance(piece).shape)
    keep['vtk'] = numpy_to_vtk(keep['array'], deep=False)
    keep['vtk'].SetName('f')
keep['array'][:] = distance(piece) + 0.2 * min(time, 1.0)
image.SetExtent(piece)
image.GetPointData().AddArray(keep['vtk'])
""")
in_place.ScriptRequestInformation = TIME_INFORMATION
in_place.UpdatePipelineInformation()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = view.ViewTime = 2.0
display = show(in_place, view, [0.7], "f")
place_camera(view)
render(view)
pictures = check_publications(display, 2, "values that change in place from step 0 to step 1")
check(get_covered(pictures[0]).sum() > get_covered(pictures[1]).sum(), "the sphere shrinks")
check_equal(pictures[1], pictures[2], "and then does not", tolerance=0)
simple.Delete(in_place)

# Surfaces, likewise.
strip = simple.ProgrammableSource(OutputDataSetType="vtkPolyData")
strip.ScriptRequestInformation = TIME_STEPS
strip.Script = """
import sys
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
request = self.GetExecutive().GetOutputInformation().GetInformationObject(0)
time = request.Get(vtkStreamingDemandDrivenPipeline.UPDATE_TIME_STEP()) or 0.0
keep = vars(sys).setdefault('dsm_strip', {})
if 'array' not in keep:
    keep['array'] = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    keep['points'] = vtkPoints()
    keep['points'].SetData(numpy_to_vtk(keep['array'], deep=False))
keep['array'][2] = [1.0, 1.0 if time < 1.0 else 0.2, 0.0]
cells = vtkCellArray()
cells.InsertNextCell(4, [0, 1, 2, 3])
output = self.GetOutputDataObject(0)
output.SetPoints(keep['points'])
output.SetPolys(cells)
"""
strip.UpdatePipelineInformation()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = view.ViewTime = 2.0
display = simple.Show(strip, view)
display.Representation = REPRESENTATION
display.ColorArrayName = [None, ""]
place_camera(view, (0.1, 0.2, 1.0))
render(view)
pictures = check_publications(display, 2, "a quadrangle that changes from step 0 to step 1")
check(get_covered(pictures[0]).sum() > get_covered(pictures[1]).sum(), "a corner moves")
check_equal(pictures[1], pictures[2], "and then does not", tolerance=0)
simple.Delete(strip)

# An edited source, also to another size.
wavelet = simple.Wavelet()
show(wavelet, view, [157.0])
place_camera(view)
before = render(view, "Wavelet")
wavelet.Maximum = 200.0
after = render(view, "LargerMaximum")
check((before != after).any(), "an edited source changes the picture")
wavelet.Maximum = 255.0
check_equal(render(view), before, "and back")
wavelet.WholeExtent = [-10, 5, -10, 10, -3, 10]
check((render(view, "SmallerExtent") != before).any(), "another extent")
wavelet.WholeExtent = [-10, 10, -10, 10, -10, 10]
check_equal(render(view), before, "and back again")
simple.Delete(wavelet)

# A file that is written anew.
path = os.path.join(OUTPUT, f"reload.{get_ranks()}.vti")


def write(maximum):
    generator = vtkRTAnalyticSource()
    generator.SetMaximum(maximum)
    generator.Update()
    writer = vtkXMLImageDataWriter()
    writer.SetDataModeToBinary()
    writer.SetInputData(generator.GetOutput())
    writer.SetFileName(path)
    writer.Write()


write(255.0)
reader = simple.XMLImageDataReader(FileName=[path])
show(reader, view, [157.0], "RTData")
place_camera(view)
check_equal(render(view), before, "a file shows what the source shows")
write(200.0)
simple.ReloadFiles(reader)
check_equal(render(view), after, "reloading shows what the file holds now")
simple.Delete(reader)
