# SPDX-License-Identifier: BSD-3-Clause
# Makes up for what Debian's packages of ParaView and VTK leave out. To be included before either is
# looked for.

# They name targets of development packages that they do not depend on; nothing here uses them. To be
# called after they were looked for, which may find some.
function (dsm_add_targets_of_distribution)
  foreach (target IN ITEMS
      double-conversion::double-conversion EXPAT::EXPAT Freetype::Freetype GLEW::GLEW hdf5::hdf5
      hdf5::hdf5_hl JPEG::JPEG LZ4::LZ4 LZMA::LZMA NetCDF::NetCDF PNG::PNG TIFF::TIFF utf8cpp::utf8cpp)
    if (NOT TARGET "${target}")
      add_library("${target}" INTERFACE IMPORTED)
    endif ()
  endforeach ()
endfunction ()

# ParaView's Qt libraries name more of Qt, and of others, than the panel uses.
function (dsm_add_targets_of_qt qt)
  foreach (target IN ITEMS
      Boost::boost LibPROJ::LibPROJ LibXml2::LibXml2 "${qt}::Concurrent" "${qt}::Help" "${qt}::Network" "${qt}::OpenGL"
      "${qt}::OpenGLWidgets" "${qt}::Sql" "${qt}::Svg" "${qt}::Xml")
    if (NOT TARGET "${target}")
      add_library("${target}" INTERFACE IMPORTED)
    endif ()
  endforeach ()
endfunction ()

# From Debian 13 on, its ParaView's CMake files name Python modules as they were before they were
# packaged (vtkCommonCore.so, which is vtkCommonCore.cpython-313-x86_64-linux-gnu.so), and refuse to be
# read since these files are missing. Where their targets exist already, they are not looked for.
function (dsm_add_python_targets_of_distribution)
  file(GLOB python_targets
    "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/paraview-*/*Python*-targets.cmake"
    "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/paraview-*/vtk/*Python*-targets.cmake")
  foreach (file IN LISTS python_targets)
    string(REPLACE ".cmake" "-*.cmake" configurations "${file}")
    file(GLOB configurations "${configurations}")
    set(missing FALSE)
    foreach (configuration IN LISTS configurations)
      file(STRINGS "${configuration}" locations REGEX "IMPORTED_LOCATION_[A-Z]+ .*/dist-packages/.*\\.so")
      if (locations MATCHES "_IMPORT_PREFIX}(/[^;\"]+\\.so)")
        if (NOT EXISTS "/usr${CMAKE_MATCH_1}")
          set(missing TRUE)
        endif ()
      endif ()
    endforeach ()
    if (missing)
      file(STRINGS "${file}" names REGEX "_cmake_expected_target IN ITEMS")
      string(REGEX MATCHALL "[A-Za-z0-9_.]+::[A-Za-z0-9_.]+" names "${names}")
      foreach (name IN LISTS names)
        if (NOT TARGET "${name}")
          add_library("${name}" MODULE IMPORTED)
        endif ()
      endforeach ()
    endif ()
  endforeach ()
endfunction ()
dsm_add_python_targets_of_distribution()
