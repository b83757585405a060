# SPDX-License-Identifier: BSD-3-Clause
"""Ray traces isosurfaces and meshes in VTK, out of the memory of all MPI ranks.

vtkDSMVolumeMapper takes the place of a vtkVolume's mapper, vtkDSMPolyDataMapper that of a vtkActor's.
"""
# The classes draw with OpenGL; this makes VTK's own classes do so, too.
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401

from .vtkRenderingDSM import *  # noqa: F401,F403
