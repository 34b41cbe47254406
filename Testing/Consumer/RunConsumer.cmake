# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DBUILD=<build tree> -DWORK=<scratch folder> -DGENERATOR=<generator> [-DFLAGS=<compiler flags>]
#              [-DPYTHON=<interpreter> -DPYTHON_DIR=<folder below the prefix>] -P RunConsumer.cmake
# Installs the build tree, then configures, builds and runs this folder's project against nothing but the install
# tree, and imports the installed Python package.
cmake_minimum_required(VERSION 3.22)
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

file(REMOVE_RECURSE "${WORK}")
set(prefix "${WORK}/prefix")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}"
  RESULT_VARIABLE status OUTPUT_QUIET)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "cmake --install failed (${status})")
endif()
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/build"
  "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
run("${CMAKE_COMMAND}" --build "${WORK}/build")
run("${WORK}/build/kernels")
if(EXISTS "${WORK}/build/filters")
  run("${WORK}/build/filters" "${WORK}/consumer.vtp")
  if(NOT EXISTS "${WORK}/consumer.vtp")
    message(FATAL_ERROR "the chain of filters wrote nothing")
  endif()
endif()
if(PYTHON)
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${prefix}/${PYTHON_DIR}" "${PYTHON}" -c
    "import knotwork; assert knotwork.__file__.startswith('${prefix}'); print(knotwork.vtkSplineSource().GetClassName())")
endif()
