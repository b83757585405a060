# SPDX-License-Identifier: BSD-3-Clause

# A pixel must not depend on what the compiler contracts where: the oracle of the tests and the
# kernels evaluate the same expressions.
include(CheckCXXCompilerFlag)
foreach (flag IN ITEMS -ffp-contract=off -fno-semantic-interposition)
  string(MAKE_C_IDENTIFIER "DSM_COMPILER_HAS${flag}" variable)
  check_cxx_compiler_flag("${flag}" "${variable}")
  if (${variable})
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:${flag}>")
  endif ()
endforeach ()

# Warnings for our own sources; the generated ones of the wrappers are not ours.
set(DSM_WARNINGS)
if (CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  set(DSM_WARNINGS -Wall -Wextra)
  if (DSM_WARNINGS_AS_ERRORS)
    list(APPEND DSM_WARNINGS -Werror)
  endif ()
endif ()
