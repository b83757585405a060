# SPDX-License-Identifier: BSD-3-Clause

find_package(Threads REQUIRED)
find_package(glm REQUIRED)

# Distributions build ParaView against their own Python; another one in the PATH does not fit.
if (NOT DEFINED Python3_EXECUTABLE AND EXISTS "/usr/bin/python3")
  set(Python3_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "The Python that ParaView was built with")
endif ()
find_package(Python3 COMPONENTS Interpreter Development)

# Debian's package names targets of development packages that it does not depend on; nothing here
# uses them.
foreach (target IN ITEMS
    double-conversion::double-conversion EXPAT::EXPAT Freetype::Freetype GLEW::GLEW JPEG::JPEG
    LZ4::LZ4 LZMA::LZMA PNG::PNG TIFF::TIFF utf8cpp::utf8cpp)
  if (NOT TARGET "${target}")
    add_library("${target}" INTERFACE IMPORTED)
  endif ()
endforeach ()

if (DSM_BUILD_PARAVIEW_PLUGIN)
  # Without COMPONENTS, Qt's development files are demanded.
  find_package(ParaView REQUIRED COMPONENTS RemotingViews)
else ()
  find_package(VTK REQUIRED COMPONENTS RenderingOpenGL2 IOXML
    OPTIONAL_COMPONENTS RenderingParallel ParallelMPI)
endif ()

set(DSM_HAS_MPI OFF)
if (DSM_USE_MPI)
  find_package(MPI COMPONENTS C)
  if (MPI_C_FOUND)
    set(DSM_HAS_MPI ON)
  endif ()
endif ()
