# SPDX-License-Identifier: BSD-3-Clause
# The CMake package for applications, and what cpack makes.
include(CMakePackageConfigHelpers)

# What the public classes' own package must find again, since a link needs it.
set(DSM_VTK_COMPONENTS)
foreach (module IN LISTS dsm_required_modules)
  if (module MATCHES "^VTK::(.*)$")
    list(APPEND DSM_VTK_COMPONENTS "${CMAKE_MATCH_1}")
  endif ()
endforeach ()
foreach (module IN ITEMS ParallelMPI mpi)
  if (TARGET "VTK::${module}")
    list(APPEND DSM_VTK_COMPONENTS "${module}")
  endif ()
endforeach ()
list(REMOVE_DUPLICATES DSM_VTK_COMPONENTS)
list(JOIN DSM_VTK_COMPONENTS " " DSM_VTK_COMPONENTS)

set(DSM_INSTALL_PLUGIN "none")
if (DSM_BUILD_PARAVIEW_PLUGIN)
  set(DSM_INSTALL_PLUGIN
    "${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}/DSMRayTracer/DSMRayTracer.so")
endif ()
configure_package_config_file(cmake/DSMRayTracerConfig.cmake.in
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/DSMRayTracerConfig.cmake"
  INSTALL_DESTINATION "${DSM_INSTALL_CMAKEDIR}"
  PATH_VARS DSM_INSTALL_PYTHONDIR DSM_INSTALL_PLUGIN)
write_basic_package_version_file(
  "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/DSMRayTracerConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
    "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/DSMRayTracerConfig.cmake"
    "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/DSMRayTracerConfigVersion.cmake"
    cmake/DSMDistributionTargets.cmake
  DESTINATION "${DSM_INSTALL_CMAKEDIR}"
  COMPONENT development)
install(FILES LICENSE README.md CHANGELOG.md
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/dsmraytracer"
  COMPONENT runtime)
install(DIRECTORY docs examples
  DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/doc/dsmraytracer"
  COMPONENT runtime
  PATTERN "__pycache__" EXCLUDE)

set(CPACK_PACKAGE_NAME dsmraytracer)
set(CPACK_PACKAGE_VENDOR "The DSM Ray Tracer developers")
set(CPACK_PACKAGE_CONTACT "The DSM Ray Tracer developers <dsmraytracer@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
  "The ranks of a ParaView server pool their memory and share data as bricks. The plugin adds the representations
DSM Ray Traced, DSM Volume and DSM Slices, and a reader of volumes in HDF5, Zarr, NRRD and MetaImage files that are
larger than memory. VTK mappers, a CMake package and Python classes are included.")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
if (EXISTS "/etc/debian_version")
  # Debian's ParaView looks for plugins below /usr; its packages depend on what the libraries need.
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${CPACK_PACKAGE_CONTACT}")
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  # Our own libraries are in the package.
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
  if (DSM_BUILD_PARAVIEW_PLUGIN)
    set(CPACK_DEBIAN_PACKAGE_DEPENDS paraview)
    set(CPACK_DEBIAN_PACKAGE_RECOMMENDS python3-paraview)
    set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview-dev, libglm-dev, libopenmpi-dev")
  else ()
    set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libvtk9-dev, libglm-dev, libopenmpi-dev")
  endif ()
else ()
  set(CPACK_GENERATOR TGZ)
endif ()
include(CPack)
