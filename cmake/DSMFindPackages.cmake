# SPDX-License-Identifier: BSD-3-Clause

find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(hwy REQUIRED CONFIG)

# Of file formats; each may be absent. `lack`: what is told then.
find_package(PkgConfig)
function (dsm_find_format_library name lack)
  foreach (module IN LISTS ARGN)
    pkg_check_modules(DSM_${name} QUIET IMPORTED_TARGET "${module}")
    if (TARGET PkgConfig::DSM_${name})
      add_library(DSM::${name} INTERFACE IMPORTED GLOBAL)
      target_link_libraries(DSM::${name} INTERFACE PkgConfig::DSM_${name})
      return ()
    endif ()
  endforeach ()
  message(STATUS "${name} was not found: ${lack}")
endfunction ()
if (PkgConfig_FOUND)
  set(unread "files that need it cannot be read")
  dsm_find_format_library(HDF5 "${unread}" hdf5-serial hdf5)
  dsm_find_format_library(ZLIB "${unread}" zlib)
  dsm_find_format_library(BLOSC "${unread}" blosc)
  dsm_find_format_library(ZSTD "${unread}" libzstd)
  dsm_find_format_library(LZ4 "${unread}" liblz4)
  dsm_find_format_library(LZMA "${unread}" liblzma)
  dsm_find_format_library(CURL "volumes on servers cannot be read" libcurl>=7.75)
  if (TARGET DSM::ZLIB)
    dsm_find_format_library(LIBDEFLATE "the slower zlib is used instead" libdeflate)
  endif ()
endif ()
find_package(BZip2 QUIET) # it has no file for pkg-config in Debian 12
if (BZIP2_FOUND)
  add_library(DSM::BZIP2 INTERFACE IMPORTED GLOBAL)
  target_link_libraries(DSM::BZIP2 INTERFACE BZip2::BZip2)
else ()
  message(STATUS "BZIP2 was not found: files that need it cannot be read")
endif ()
find_package(nlohmann_json REQUIRED)
find_path(DSM_XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
add_library(DSM::XXHASH INTERFACE IMPORTED GLOBAL)
set_target_properties(DSM::XXHASH PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${DSM_XXHASH_INCLUDE_DIR}")
if (TARGET DSM::HDF5 OR DSM_BUILD_BENCHMARKS OR DSM_BUILD_TESTING)
  find_package(CLI11 REQUIRED) # of dsm_convert and dsm_bench
endif ()

# Distributions build ParaView against their own Python; another one in the PATH does not fit.
if (NOT DEFINED Python3_EXECUTABLE AND EXISTS "/usr/bin/python3")
  set(Python3_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "The Python that ParaView was built with")
endif ()
find_package(Python3 COMPONENTS Interpreter Development)

include(DSMDistributionTargets)

if (DSM_BUILD_PARAVIEW_PLUGIN)
  # Without COMPONENTS, Qt's development files are demanded.
  find_package(ParaView REQUIRED COMPONENTS RemotingViews)
else ()
  find_package(VTK 9.1 REQUIRED
    COMPONENTS ImagingCore IOXML RenderingOpenGL2 RenderingVolume RenderingVolumeOpenGL2
    OPTIONAL_COMPONENTS RenderingParallel ParallelMPI TestingCore)
endif ()
dsm_add_targets_of_distribution()

# The panel in ParaView's application needs Qt, of the version that ParaView was built with.
set(DSM_HAS_QT OFF)
if (DSM_BUILD_PARAVIEW_PLUGIN AND PARAVIEW_USE_QT)
  if (NOT DEFINED PARAVIEW_QT_MAJOR_VERSION)
    set(PARAVIEW_QT_MAJOR_VERSION 5) # the only one up to 5.11
  endif ()
  find_package("Qt${PARAVIEW_QT_MAJOR_VERSION}" QUIET COMPONENTS Widgets)
  if (TARGET "Qt${PARAVIEW_QT_MAJOR_VERSION}::Widgets")
    # ParaView's headers include it, and a VTK that is packaged for itself may have it in a package of its own.
    include(CheckIncludeFileCXX)
    set(CMAKE_REQUIRED_LIBRARIES VTK::CommonCore "Qt${PARAVIEW_QT_MAJOR_VERSION}::Widgets")
    check_include_file_cxx("vtkEventQtSlotConnect.h" DSM_HAS_QT_HEADERS_OF_VTK "-fPIC")
    unset(CMAKE_REQUIRED_LIBRARIES)
  endif ()
  if (DSM_HAS_QT_HEADERS_OF_VTK)
    set(DSM_HAS_QT ON)
    dsm_add_targets_of_qt("Qt${PARAVIEW_QT_MAJOR_VERSION}")
  else ()
    unset(DSM_HAS_QT_HEADERS_OF_VTK CACHE) # so that it is looked for again once it is installed
    message(STATUS "The panel Ray Tracing Memory is not built: it requires the development files of "
      "Qt ${PARAVIEW_QT_MAJOR_VERSION} and of VTK's Qt support")
  endif ()
endif ()

# By the target: VTK 9.6 looks for parts of Python's development files, after which the whole is said to
# be missing.
set(DSM_HAS_PYTHON OFF)
if (DSM_WRAP_PYTHON AND VTK_WRAP_PYTHON AND TARGET Python3::Module)
  find_package(VTK COMPONENTS CommonCore OPTIONAL_COMPONENTS Python WrappingPythonCore WrapPython)
  if (TARGET VTK::Python AND TARGET VTK::WrappingPythonCore AND TARGET VTK::WrapPython)
    set(DSM_HAS_PYTHON ON)
  endif ()
endif ()
if (DSM_WRAP_PYTHON AND NOT DSM_HAS_PYTHON)
  message(STATUS "The Python modules are not built: they require VTK's Python "
    "wrapping and the development files of Python")
endif ()

set(DSM_HAS_MPI OFF)
if (DSM_USE_MPI)
  find_package(MPI COMPONENTS C)
  if (MPI_C_FOUND)
    set(DSM_HAS_MPI ON)
  endif ()
endif ()
