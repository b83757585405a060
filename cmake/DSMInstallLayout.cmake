# SPDX-License-Identifier: BSD-3-Clause
# Where things go, below the prefix: the libraries where those of the ParaView or VTK that was found
# are below theirs. On Debian that is a folder of the processor's, where its ParaView looks for plugins.
if (DSM_BUILD_PARAVIEW_PLUGIN)
  set(found "${ParaView_DIR}")
  set(found_prefix "${ParaView_PREFIX_PATH}")
  set(found_python "${PARAVIEW_PYTHONPATH}")
else ()
  set(found "${VTK_DIR}")
  set(found_prefix "${VTK_PREFIX_PATH}")
  set(found_python "${VTK_PYTHONPATH}")
endif ()
if (NOT DEFINED CMAKE_INSTALL_LIBDIR)
  get_filename_component(found "${found}/../.." REALPATH)
  get_filename_component(found_prefix "${found_prefix}" REALPATH)
  file(RELATIVE_PATH directory "${found_prefix}" "${found}")
  if (directory MATCHES "^lib")
    set(CMAKE_INSTALL_LIBDIR "${directory}" CACHE PATH "Libraries, below the prefix")
  endif ()
endif ()
include(GNUInstallDirs)

set(DSM_INSTALL_INCLUDEDIR "${CMAKE_INSTALL_INCLUDEDIR}/dsmraytracer")
set(DSM_INSTALL_CMAKEDIR "${CMAKE_INSTALL_LIBDIR}/cmake/DSMRayTracer")
set(DSM_INSTALL_PYTHONDIR "${found_python}" CACHE PATH "Python modules, below the prefix")

# In the build folder, short paths; the same on every distribution.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib")

# An application finds our libraries, these find each other, and the VTK that they were built with.
list(APPEND CMAKE_INSTALL_RPATH "$ORIGIN")
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
