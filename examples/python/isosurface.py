# SPDX-License-Identifier: BSD-3-Clause
"""An isosurface of a volume over a floor that it casts its shadow on.

usage: isosurface.py            shows it in a window
       isosurface.py PICTURE    draws it off screen, and writes it to a PNG file
With several ranks (mpirun -np N isosurface.py PICTURE) each makes its piece of the volume.
"""
import sys

from dsmraytracer import vtkDSMPolyDataMapper, vtkDSMScene, vtkDSMVolumeMapper
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
import vtkmodules.vtkInteractionStyle  # noqa: F401
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLight, vtkRenderer, vtkRenderWindow,
                                         vtkRenderWindowInteractor, vtkVolume, vtkWindowToImageFilter)


def start_ranks():
    """The controller of the MPI ranks, which also is the global one; None where there is no MPI."""
    controller = vtkMultiProcessController.GetGlobalController()
    if controller is None:  # it is there in pvpython and pvbatch
        try:
            from mpi4py import MPI  # noqa: F401  starts MPI, and ends it when Python ends
            from vtkmodules.vtkParallelMPI import vtkMPIController
        except ImportError:
            return None
        controller = vtkMPIController()
        controller.Initialize()
        vtkMultiProcessController.SetGlobalController(controller)
    return controller


def make_renderer():
    source = vtkRTAnalyticSource()  # or any reader of image data
    source.SetWholeExtent(-40, 40, -40, 40, -40, 40)
    isosurface = vtkDSMVolumeMapper()
    isosurface.SetInputConnection(source.GetOutputPort())
    isosurface.SetIsoArray("RTData")
    isosurface.SetIsoValue(0, 160.0)
    isosurface.GetSurfaceProperty().SetColor(0.9, 0.7, 0.3)
    isosurface.GetLightOptions().ShadowsOn()
    volume = vtkVolume()
    volume.SetMapper(isosurface)

    floor = vtkPlaneSource()
    floor.SetOrigin(-60.0, -30.0, 60.0)
    floor.SetPoint1(60.0, -30.0, 60.0)
    floor.SetPoint2(-60.0, -30.0, -60.0)
    surface = vtkDSMPolyDataMapper()  # in the place of vtkPolyDataMapper
    surface.SetInputConnection(floor.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(surface)

    sun = vtkLight()
    sun.SetLightTypeToSceneLight()
    sun.SetPosition(60.0, 150.0, 90.0)

    renderer = vtkRenderer()
    renderer.AddLight(sun)
    renderer.AddVolume(volume)
    renderer.AddActor(actor)
    renderer.SetBackground(0.3, 0.35, 0.4)
    renderer.GetActiveCamera().SetPosition(90.0, 70.0, 140.0)
    renderer.ResetCamera()
    return renderer


def write(window, file_name):
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ShouldRerenderOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(file_name)
    writer.Write()


def draw(controller):
    renderer = make_renderer()
    # Several ranks need it before the first frame; in one process, the mappers would make it.
    scene = vtkDSMScene.NewForRenderer(renderer)
    scene.DeliverEverywhere()  # every rank's window gets the whole picture
    window = vtkRenderWindow()
    window.SetSize(600, 450)
    window.AddRenderer(renderer)
    if len(sys.argv) > 1:
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.Render()
        if controller is None or controller.GetLocalProcessId() == 0:
            write(window, sys.argv[1])
    else:
        interactor = vtkRenderWindowInteractor()
        interactor.SetRenderWindow(window)
        interactor.Start()


def main():
    draw(start_ranks())  # what it made is gone when MPI ends


main()
