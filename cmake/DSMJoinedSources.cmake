# SPDX-License-Identifier: BSD-3-Clause
# Most of the time of a build goes into headers, so sources are compiled ten at a time. A name is unique in its target,
# then, also in an unnamed namespace. With -DDSM_JOINED_SOURCES=OFF each source is compiled by itself, which is quicker
# after a change of one.
option(DSM_JOINED_SOURCES "Compile ten sources of a target at a time" ON)
set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)
if (DSM_JOINED_SOURCES AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Joined sources are included, and what is included should have no unnamed namespace.
  list(APPEND DSM_WARNINGS -Wno-subobject-linkage)
endif ()

# Joins the sources of a target of the same folder, but for those that match a regular expression.
function (dsm_join_sources target)
  set_target_properties("${target}" PROPERTIES UNITY_BUILD "${DSM_JOINED_SOURCES}")
  if (ARGN)
    get_target_property(apart "${target}" SOURCES)
    list(FILTER apart INCLUDE REGEX "${ARGN}")
    set_source_files_properties(${apart} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif ()
endfunction ()
