# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DBUILD=<build tree> -DSOURCE=<source tree> -DWORK=<scratch folder> -DGENERATOR=<generator>
#              [-DFLAGS=<compiler flags>] [-DLAUNCHER=<compiler cache>] [-DKERNELS_ONLY=ON]
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
if(NOT EXISTS "${prefix}/share/doc/Knotwork/LICENSE")
  message(FATAL_ERROR "the licence is not installed")
endif()
file(GLOB_RECURSE scripts "${prefix}/lib/cmake/*.cmake")
foreach(script IN LISTS scripts)
  file(READ "${script}" text)
  foreach(tree IN ITEMS "${BUILD}" "${SOURCE}")
    string(REPLACE "${prefix}" "" text "${text}")
    string(FIND "${text}" "${tree}" place)
    if(NOT place EQUAL -1)
      message(FATAL_ERROR "${script} refers to ${tree}")
    endif()
  endforeach()
endforeach()

run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/build"
  "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE=Release
  "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" "-DKERNELS_ONLY=${KERNELS_ONLY}"
  -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF)
cmake_host_system_information(RESULT jobs QUERY NUMBER_OF_LOGICAL_CORES)
run("${CMAKE_COMMAND}" --build "${WORK}/build" --parallel ${jobs})
file(GLOB programs "${CMAKE_CURRENT_LIST_DIR}/Programs/*.cxx")
foreach(program IN LISTS programs)
  get_filename_component(component "${program}" NAME_WE)
  if(component MATCHES "Kernel$" OR NOT KERNELS_ONLY)
    message(STATUS "${component}")
    if(component MATCHES "^(CADModelKernel|CADMeshingKernel|SplineIO)$")
      run("${WORK}/build/${component}/${component}" "${WORK}")
    else()
      run("${WORK}/build/${component}/${component}")
    endif()
  endif()
endforeach()
if(PYTHON)
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${prefix}/${PYTHON_DIR}" "${PYTHON}" -c
    "import knotwork; assert knotwork.__file__.startswith('${prefix}'); print(knotwork.vtkSplineSource().GetClassName())")
endif()
