#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A simulation that has its pictures ray traced while it runs, with ParaView Catalyst:

    mpirun -np 2 python3 simulation.py --pipeline pipeline.py --steps 200

Two substances react and diffuse (the Gray-Scott model) on a grid that the ranks share in slabs along
z. Every rank gives Catalyst its slab and the first layer of the next one, as vtkImageData without a
copy. Rank 0 can print the memory that each rank takes.
"""
import argparse

import numpy as np
from mpi4py import MPI
from paraview.catalyst import bridge
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData

FEED, KILL, DIFFUSION_U, DIFFUSION_V = 0.035, 0.062, 0.16, 0.08
TIME_STEP = 1.0


class GrayScott:
    """A rank's slab of the two concentrations, indexed [z, y, x], with a layer of each neighbor."""

    def __init__(self, comm, size):
        self.comm, self.size = comm, size
        self.first = size * comm.rank // comm.size
        self.end = size * (comm.rank + 1) // comm.size
        shape = (self.end - self.first + 2, size, size)
        self.u = np.ones(shape, dtype=np.float32)
        self.v = np.zeros(shape, dtype=np.float32)
        z, y, x = np.ogrid[self.first - 1 : self.end + 1, 0:size, 0:size]
        for center in ((0.5, 0.5, 0.5), (0.3, 0.6, 0.4), (0.65, 0.35, 0.55)):
            distance2 = sum((p - size * c) ** 2 for p, c in zip((z, y, x), center))
            seed = distance2 < (0.11 * size) ** 2
            self.u[seed], self.v[seed] = 0.5, 0.25
        self.exchange()

    def exchange(self):
        """Exchanges layers with the neighbors. The domain is periodic."""
        below, above = (self.comm.rank - 1) % self.comm.size, (self.comm.rank + 1) % self.comm.size
        for field in (self.u, self.v):
            self.comm.Sendrecv(field[-2], above, recvbuf=field[0], source=below)
            self.comm.Sendrecv(field[1], below, recvbuf=field[-1], source=above)

    def advance(self):
        u, v = self.u[1:-1], self.v[1:-1]
        reaction = u * v * v
        du = DIFFUSION_U * self.laplacian(self.u) - reaction + FEED * (1 - u)
        dv = DIFFUSION_V * self.laplacian(self.v) + reaction - (FEED + KILL) * v
        u += TIME_STEP * du
        v += TIME_STEP * dv
        self.exchange()

    @staticmethod
    def laplacian(field):
        inner = field[1:-1]
        total = field[2:] + field[:-2] - 6 * inner
        for axis in (1, 2):
            total += np.roll(inner, 1, axis) + np.roll(inner, -1, axis)
        return total


class Slab:
    """A rank's part of the simulation's grid as vtkImageData that shares the simulation's arrays."""

    def __init__(self, model):
        last = min(model.end, model.size - 1)  # neighbors share a layer, so no cells are missing
        self.image = vtkImageData()
        self.image.SetExtent(0, model.size - 1, 0, model.size - 1, model.first, last)
        self.image.SetSpacing([1.0 / (model.size - 1)] * 3)
        layers = last - model.first + 1
        self.arrays = []
        for name, field in (("u", model.u), ("v", model.v)):
            array = numpy_to_vtk(field[1 : 1 + layers].ravel(), deep=False)
            array.SetName(name)
            self.image.GetPointData().AddArray(array)
            self.arrays.append(array)

    def note_change(self):
        """VTK cannot see that the values in the simulation's memory are others now."""
        for array in self.arrays:
            array.Modified()
        self.image.Modified()


def get_resident_kibibytes():
    with open("/proc/self/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pipeline", required=True, help="the Catalyst script")
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--size", type=int, default=64, help="grid points along an axis")
    parser.add_argument("--substeps", type=int, default=10, help="substeps of the model per step")
    parser.add_argument("--still-from", type=int, help="step after which the fields no longer change")
    parser.add_argument("--memory-every", type=int, default=0, help="print memory use every N steps")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    comm = MPI.COMM_WORLD
    model = GrayScott(comm, arguments.size)
    slab = Slab(model)
    whole = [0, arguments.size - 1] * 3
    bridge.initialize()
    bridge.add_pipeline(arguments.pipeline, 2)
    for step in range(arguments.steps):
        if arguments.still_from is None or step < arguments.still_from:
            for _ in range(arguments.substeps):
                model.advance()
            slab.note_change()
        bridge.coprocess(step * TIME_STEP, step, slab.image, "input", whole)
        if arguments.memory_every and step % arguments.memory_every == 0:
            memory = comm.gather(get_resident_kibibytes())
            if comm.rank == 0:
                print("memory", step, *memory, flush=True)
    bridge.finalize()


main()
