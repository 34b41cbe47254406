#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: Testing/variants.sh [--all] [-j JOBS]
# Runs the kernels' tests as they would run on other machines: built for this processor's own instruction set, with the
# inner loops, mathematical functions and BLAS of an old processor, and with memory that begins where it pleases. What hangs on
# the last bit of a number fails here. Expects the release tree built; builds the others: of the modules that solve
# equations only. --all adds the other modules, the slow tests, more instruction sets and more repetitions, and on the old processor
# the tests that took longer than 8 s in the release tree.
set -eu
source "$(dirname "$0")/../CMake/common.sh"
jobs=$(default_jobs)
all=
while [ $# -gt 0 ]; do
  case "$1" in
    --all) all=1 ;;
    -j) jobs=$2; shift ;;
    -j*) jobs=${1#-j} ;;
    *) sed -n '3p' "$0" | cut -c 3- >&2; exit 2 ;;
  esac
  shift
done
failed=()

# tests NAME TREE [VARIABLE=VALUE...] [--gtest_option...]: every program of kernel tests in a tree, JOBS at a time.
tests()
{
  local name=$1 tree=$2 begin=$SECONDS status=0
  shift 2
  echo "variant: $name"
  find "$tree/bin" -name '*KernelTests' ${all:+-o -name '*KernelSlowTests'} | sort |
    xargs -P "$jobs" -I {} bash -c 'program=$1; shift
      settings=(); while [[ ${1:-} == [A-Z]*=* ]]; do settings+=("$1"); shift; done
      log=$(mktemp)
      env "${settings[@]}" "$program" --gtest_brief=1 "$@" > "$log" 2>&1 || { cat "$log"; rm "$log"; exit 1; }
      rm "$log"' tests {} "$@" || status=1
  echo "variant: $name: $([ $status = 0 ] && echo passed || echo FAILED), $((SECONDS - begin)) s"
  [ $status = 0 ] || failed+=("$name")
}

# threads NAME TREE REPETITIONS: the tests of equal bits for any number of threads.
threads()
{
  tests "$1, threads and places of memory" "$2" "LD_PRELOAD=$2/lib/libShiftedAllocations.so" \
    '--gtest_filter=*Thread*:*SameBits*' "--gtest_repeat=$3"
}

# build PRESET
build()
{
  local targets=(SplineCoreKernelTests TemplateMappingKernelTests SurfaceFittingKernelTests ShiftedAllocations)
  KNOTWORK_WERROR= configure "$1" # what a compiler says of other flags is no error
  cmake --build "$root/build/$1" -j "$jobs" --target $([ -n "$all" ] && echo all || echo "${targets[@]}")
}

# A filter of GoogleTest that leaves out the long tests of the release tree, none with --all.
without_long_tests()
{
  printf -- '--gtest_filter=*-'
  [ -n "$all" ] || awk '/^---/ { exit } NF == 3 && $3 > 8 { sub(/^[^.]*\./, "", $1); printf "%s:", $1 }' \
    "$release/Testing/Temporary/CTestCostData.txt"
}

build native
tests 'own instruction set' "$root/build/native"
threads 'own instruction set' "$root/build/native" ${all:+2}5
tests 'old processor' "$release" GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA OPENBLAS_CORETYPE=Prescott "$(without_long_tests)"
threads 'default build' "$release" ${all:+2}5
if [ -n "$all" ] && grep -q -w avx2 /proc/cpuinfo; then
  tests 'BLAS of Haswell' "$release" OPENBLAS_CORETYPE=Haswell
  build v3
  tests 'x86-64-v3' "$root/build/v3"
  threads 'x86-64-v3' "$root/build/v3" 25
fi
if [ -n "$all" ] && grep -q -w avx512dq /proc/cpuinfo; then
  tests 'BLAS of SkylakeX' "$release" OPENBLAS_CORETYPE=SkylakeX
fi
if [ ${#failed[@]} != 0 ]; then
  printf 'variant failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
