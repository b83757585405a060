# SPDX-License-Identifier: BSD-3-Clause
# The reference of the modules, made from their headers: cmake --build BUILD --target api_documentation
# writes doc/html/index.html in the build folder.
find_package(Doxygen QUIET)
if (NOT DOXYGEN_FOUND)
  return()
endif ()
set(DOXYGEN_PROJECT_NAME "DSM ray tracer")
set(DOXYGEN_PROJECT_BRIEF "Ray tracing out of distributed shared memory, for VTK and ParaView")
set(DOXYGEN_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/doc")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${PROJECT_SOURCE_DIR}/docs/architecture.md")
set(DOXYGEN_IMAGE_PATH "${PROJECT_SOURCE_DIR}/docs")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}/vtk_modules")
set(DOXYGEN_FILE_PATTERNS *.h *.md)
set(DOXYGEN_EXCLUDE_PATTERNS *-inl.h)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_DISTRIBUTE_GROUP_DOC YES)
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_PREDEFINED VTKRENDERINGDSM_EXPORT= VTK_WRAPEXCLUDE= VTK_NEWINSTANCE=)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(api_documentation
  "${PROJECT_SOURCE_DIR}/docs/architecture.md"
  "${PROJECT_SOURCE_DIR}/vtk_modules/DSMCore"
  "${PROJECT_SOURCE_DIR}/vtk_modules/DSMBricks"
  "${PROJECT_SOURCE_DIR}/vtk_modules/DSMRayTracing"
  "${PROJECT_SOURCE_DIR}/vtk_modules/DSMVolumeFiles"
  "${PROJECT_SOURCE_DIR}/vtk_modules/RenderingDSM"
  "${PROJECT_BINARY_DIR}/vtk_modules/RenderingDSM/vtkDSMLightOptions.h"
  "${PROJECT_BINARY_DIR}/vtk_modules/RenderingDSM/vtkDSMMemoryOptions.h"
  COMMENT "The reference, from the headers")
