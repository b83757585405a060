#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Times volumes beside VTK's own volume mappers, in turn in one process, by the Python of the VTK that the project was
built with:

    PYTHONPATH=build/lib/python3/dist-packages xvfb-run -a python3 tests/benchmarks/beside_volume.py
        [--kinds sphere,rm] [--samples 256,512] [--data FILE.vti] [--frames 3] [--bench build/bin/dsm_bench]

The peers are vtkGPUVolumeRayCastMapper by the processor (Mesa's llvmpipe) and vtkFixedPointVolumeRayCastMapper, both
with two samples a cell. A ratio is a peer's time over ours, each the fastest of the frames: above 1, we are faster.
Each frame has a camera of its own. Differences are between pictures, in 255ths, over the pixels that show anything:
ours, and the first peer's, beside the first peer with eight times as many samples.
"""
import argparse
import json
import os
import subprocess
import tempfile
import time

import numpy
from dsmraytracer import vtkDSMVolumeMapper
from measuring import BENCH
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume,
                                         vtkVolumeProperty, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkOpenGLGPUVolumeRayCastMapper

SAMPLES_PER_CELL = 2
FINER = 8
# As MediumFunction.h: places in the range of values, and the opacities of a cell there.
FUNCTIONS = {
    "shell": ((0.0, 0.0), (0.48, 0.0), (0.5, 0.8), (0.52, 0.0), (1.0, 0.0)),
    "fog": ((0.0, 0.01), (1.0, 0.01)),
    "ramp": ((0.0, 0.0), (1.0, 0.05)),
}
# Around measured data there is nothing to be seen.
DATA_FUNCTIONS = {**FUNCTIONS, "fog": ((0.0, 0.0), (0.02, 0.01), (1.0, 0.01))}


def make_image(bench, volume):
    """A sample volume of floats."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "samples.raw")
        text = subprocess.run([bench, "write", "--volume", volume, "--file", path], check=True,
                              stdout=subprocess.PIPE).stdout
        values = numpy.fromfile(path, dtype=numpy.float32)
    place = json.loads(text)
    image = vtkImageData()
    image.SetDimensions(place["points"])
    image.SetSpacing(place["spacing"])
    image.SetOrigin(place["origin"])
    array = numpy_to_vtk(values)
    array.SetName("values")
    image.GetPointData().SetScalars(array)
    image.values = values  # the array is of this memory
    return image


def read_image(path):
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    if image.GetPointData().GetScalars() is None:
        raise SystemExit(f"'{path}' has no scalars on points that this VTK can read")
    return image


def make_property(function, values, cell, shade):
    first, last = values
    colors = vtkColorTransferFunction()
    colors.AddRGBPoint(first, 0.0, 0.3, 1.0)
    colors.AddRGBPoint(last, 1.0, 0.3, 0.0)
    opacities = vtkPiecewiseFunction()
    for part, opacity in function:
        opacities.AddPoint(first + part * (last - first), opacity)
    look = vtkVolumeProperty()
    look.SetColor(colors)
    look.SetScalarOpacity(opacities)
    look.SetScalarOpacityUnitDistance(cell)
    look.SetInterpolationTypeToLinear()
    look.SetShade(shade)
    look.SetAmbient(0.1)
    look.SetDiffuse(0.7)
    look.SetSpecular(0.2)
    look.SetSpecularPower(10.0)
    return look


class View:
    """A window with one volume, by one mapper."""

    def __init__(self, mapper, image, size):
        mapper.SetInputData(image)
        self.volume = vtkVolume()
        self.volume.SetMapper(mapper)
        self.renderer = vtkRenderer()
        self.renderer.AddVolume(self.volume)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(size, size)
        self.window.AddRenderer(self.renderer)

    def render(self, azimuth):
        """Seconds."""
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(0.0, 0.0, 0.0)
        camera.SetPosition(0.0, 0.0, 1.0)
        camera.SetViewUp(0.0, 1.0, 0.0)
        camera.Azimuth(azimuth)
        camera.Elevation(20.0)
        self.renderer.ResetCamera(self.volume.GetBounds())
        start = time.perf_counter()
        self.window.Render()
        self.window.WaitForCompletion()
        return time.perf_counter() - start

    def grab(self):
        shot = vtkWindowToImageFilter()
        shot.SetInput(self.window)
        shot.SetInputBufferTypeToRGB()
        shot.ReadFrontBufferOff()
        shot.ShouldRerenderOff()
        shot.Update()
        return vtk_to_numpy(shot.GetOutput().GetPointData().GetScalars()).astype(float)


def make_sampling(mapper, distance):
    """A peer that takes its samples at this distance, in all of the pixels."""
    mapper.SetAutoAdjustSampleDistances(0)
    mapper.SetSampleDistance(distance)
    mapper.SetImageSampleDistance(1.0)
    return mapper


def find_difference(picture, right):
    shown = picture.any(axis=1) | right.any(axis=1)
    apart = numpy.abs(picture - right)[shown]
    return apart.mean(), apart.max()


def measure(volume, image, functions, options):
    cell = min(image.GetSpacing())
    values = image.GetPointData().GetScalars().GetRange()
    distance = cell / SAMPLES_PER_CELL
    mappers = {
        "ours": vtkDSMVolumeMapper(),
        "llvmpipe": make_sampling(vtkOpenGLGPUVolumeRayCastMapper(), distance),
        "fixed point": make_sampling(vtkFixedPointVolumeRayCastMapper(), distance),
    }
    views = {name: View(mapper, image, options.size) for name, mapper in mappers.items()}
    for function, nodes in functions.items():
        for shade in (False, True):
            seconds = {}
            for mapper, view in views.items():
                # Each has its own: vtkFixedPointVolumeRayCastMapper adds a gradient opacity to that of its volume.
                view.volume.SetProperty(make_property(nodes, values, cell, shade))
                view.render(0.0)  # makes bricks and textures
                seconds[mapper] = []
            for frame in range(options.frames):
                for mapper, view in views.items():
                    seconds[mapper].append(view.render(7.0 * (frame + 1)))
            best = {mapper: min(each) for mapper, each in seconds.items()}
            ours, peer = views["ours"].grab(), views["llvmpipe"].grab()
            mappers["llvmpipe"].SetSampleDistance(distance / FINER)
            views["llvmpipe"].render(7.0 * options.frames)
            right = views["llvmpipe"].grab()
            mappers["llvmpipe"].SetSampleDistance(distance)
            print("| {} | {} | {} | {:.3f} | {:.2f} | {:.2f} | {:.2f}, {:.0f} | {:.2f}, {:.0f} |".format(
                volume, function, "on" if shade else "off", best["ours"], best["llvmpipe"] / best["ours"],
                best["fixed point"] / best["ours"], *find_difference(ours, right), *find_difference(peer, right)),
                flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--kinds", default="sphere,rm")
    parser.add_argument("--samples", default="256,512", help="along each axis of the sample volumes")
    parser.add_argument("--data", default="", help="a volume that is measured too, after the others")
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--size", type=int, default=512, help="pixels along each edge of the pictures")
    options = parser.parse_args()
    print(f"Load of the machine at the start: {os.getloadavg()[0]:.1f}.\n\n"
          "| volume | opacity | shade | our seconds | llvmpipe over ours | fixed point over ours "
          "| our difference: mean, largest | llvmpipe's |\n|---|---|---|---|---|---|---|---|", flush=True)
    for samples in filter(None, options.samples.split(",")):
        for kind in filter(None, options.kinds.split(",")):
            volume = f"{kind}:{samples}:float"
            measure(volume, make_image(options.bench, volume), FUNCTIONS, options)
    if options.data:
        measure(os.path.basename(options.data), read_image(options.data), DATA_FUNCTIONS, options)


if __name__ == "__main__":
    main()
