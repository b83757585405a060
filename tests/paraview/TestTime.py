# SPDX-License-Identifier: BSD-3-Clause
"""Data that change: time steps, edited sources, reloaded files."""

from dsm_testing import *
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

load_plugin()
view = create_view()

TIME_INFORMATION = IMAGE_SOURCE_INFORMATION % "0, 24, 0, 24, 0, 24" + """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as pipeline
information = self.GetExecutive().GetOutputInformation().GetInformationObject(0)
information.Set(pipeline.TIME_STEPS(), [0.0, 1.0, 2.0], 3)
information.Set(pipeline.TIME_RANGE(), [0.0, 2.0], 2)
"""
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
