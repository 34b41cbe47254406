# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DROOT=<source tree> -DCLANG_FORMAT=<program> -P CheckFormat.cmake
# Fails when a C++ file of the repository is not as clang-format would write it; `clang-format -i FILE` mends it.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND git -C "${ROOT}" ls-files "*.h" "*.cxx"
  RESULT_VARIABLE status OUTPUT_VARIABLE files ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(status EQUAL 0 AND files)
  string(REPLACE "\n" ";" files "${files}")
else() # sources without a repository
  file(GLOB_RECURSE files RELATIVE "${ROOT}"
    "${ROOT}/Modules/*.h" "${ROOT}/Modules/*.cxx" "${ROOT}/Testing/*.h" "${ROOT}/Testing/*.cxx"
    "${ROOT}/Examples/*.h" "${ROOT}/Examples/*.cxx")
endif()
set(present "")
foreach(file IN LISTS files)
  if(EXISTS "${ROOT}/${file}") # a file may be removed but not yet committed
    list(APPEND present "${file}")
  endif()
endforeach()
if(NOT present)
  message(FATAL_ERROR "no C++ file below ${ROOT}: the check would be empty")
endif()
execute_process(COMMAND "${CLANG_FORMAT}" --dry-run --Werror --style=file ${present}
  WORKING_DIRECTORY "${ROOT}" RESULT_VARIABLE status ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "not formatted:\n${output}")
endif()
list(LENGTH present count)
message(STATUS "format: ${count} files are clean")
