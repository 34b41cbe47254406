# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DOUTPUT_DIR=<build>/Testing/Temporary [-DNAME=<picture>] -P AcceptBaselines.cmake
# Copies each picture that its test rejected (X.rejected, which names the baseline) over that baseline.
if(NOT NAME)
  set(NAME "*")
endif()
file(GLOB marks "${OUTPUT_DIR}/${NAME}.rejected")
foreach(mark IN LISTS marks)
  file(STRINGS "${mark}" baseline LIMIT_COUNT 1)
  string(REGEX REPLACE "\\.rejected$" ".png" picture "${mark}")
  get_filename_component(folder "${baseline}" DIRECTORY)
  file(MAKE_DIRECTORY "${folder}")
  configure_file("${picture}" "${baseline}" COPYONLY)
  file(REMOVE "${mark}")
  message(STATUS "accepted ${baseline}")
endforeach()
if(NOT marks)
  message(STATUS "no rejected picture in ${OUTPUT_DIR}")
endif()
