# SPDX-License-Identifier: BSD-3-Clause
"""An isosurface as a picture, where there is neither a screen nor a graphics card, nor EGL or OSMesa.

usage: without_display.py PICTURE    writes it to a PNG file
With several ranks (mpirun -np N without_display.py PICTURE) each makes its piece of the volume.
"""
import sys

from dsmraytracer import vtkDSMScene, vtkDSMVolumeMapper
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkParallelCore import vtkMultiProcessController
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkVolume
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  the renderer's class; it draws nothing here


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


def draw(controller):
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

    # It has the objects, the camera, the lights and the background, and never gets a window.
    renderer = vtkRenderer()
    renderer.AddVolume(volume)
    renderer.SetBackground(0.3, 0.35, 0.4)
    renderer.GetActiveCamera().SetPosition(90.0, 70.0, 140.0)
    renderer.ResetCamera()
    scene = vtkDSMScene.NewForRenderer(renderer)
    picture = vtkImageData()
    if not scene.TraceImage(600, 450, picture):  # on all ranks
        sys.exit(1)
    if controller is None or controller.GetLocalProcessId() == 0:
        writer = vtkPNGWriter()
        writer.SetInputData(picture)
        writer.SetFileName(sys.argv[1])
        writer.Write()


def main():
    draw(start_ranks())  # what it made is gone when MPI ends


main()
