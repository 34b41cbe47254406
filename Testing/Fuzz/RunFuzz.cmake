# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DROOT=<source tree> -DWORK=<scratch folder> -DCLANG=<compiler> -DGENERATOR=<generator> -DSECONDS=<n>
#              -DFUZZERS=<name>@<name>... -P RunFuzz.cmake
# Builds the fuzz programs in a tree of their own and runs each for some seconds, starting from the files of
# Testing/Data/SplineIO. Input on which one fails stays in the scratch folder, as crash-... or timeout-... or oom-...
cmake_minimum_required(VERSION 3.22)
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

set(flags "-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${ROOT}" -B "${WORK}" "-DCMAKE_CXX_COMPILER=${CLANG}"
  -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g" "-DCMAKE_CXX_FLAGS=${flags}"
  -DKNOTWORK_FUZZ=ON -DKNOTWORK_FILTERS=OFF -DKNOTWORK_PYTHON=OFF)
string(REPLACE "@" ";" fuzzers "${FUZZERS}")
run("${CMAKE_COMMAND}" --build "${WORK}" --target ${fuzzers})
foreach(fuzzer IN LISTS fuzzers)
  file(MAKE_DIRECTORY "${WORK}/${fuzzer}")
  # What has been found before is kept; the data of the source tree is only read.
  run("${WORK}/bin/${fuzzer}" -max_total_time=${SECONDS} -max_len=16384 -timeout=10 -rss_limit_mb=3072
    "-artifact_prefix=${WORK}/" "-dict=${ROOT}/Testing/Fuzz/${fuzzer}.dict" -print_final_stats=1 -verbosity=0
    "${WORK}/${fuzzer}" "${ROOT}/Testing/Data/SplineIO")
endforeach()
