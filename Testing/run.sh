#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: Testing/run.sh [--all] [-j JOBS]
# Installs what is missing, builds everything, runs every test, and those of the kernels as other machines would.
# --all adds the slow ones. KNOTWORK_WERROR=ON in the environment makes warnings errors.
set -eu
source "$(dirname "$0")/../CMake/common.sh"
jobs=$(default_jobs)
select=(-LE '^slow$')
all=
while [ $# -gt 0 ]; do
  case "$1" in
    --all) select=(); all=--all ;;
    -j) jobs=$2; shift ;;
    -j*) jobs=${1#-j} ;;
    *) sed -n '3,5s/^# //p' "$0" >&2; exit 2 ;;
  esac
  shift
done

"$root/CMake/install-dependencies.sh"

configure_release
cmake --build "$release" -j "$jobs"
build_plugin "$jobs"
built=$SECONDS

# Cases of other origin, where they lie beside the project: ctest lists as skipped what needs them and does not find them.
for cases in DOMAIN_CASES:domains MESH_CASES:meshes LR_CASES:lr UNSTRUCTURED_MESHES:unstructured; do
  name=KNOTWORK_${cases%%:*}
  folder="$root/../shared/data/${cases#*:}"
  if [ -z "${!name:-}" ] && [ -d "$folder" ]; then
    export "$name=$folder"
  fi
done

# One display for all tests that draw; they start their own where there is none.
cd "$release"
status=0
"$root/CMake/with-display.sh" ctest --no-tests=error --output-on-failure -j "$jobs" "${select[@]}" || status=$?
"$root/Testing/variants.sh" $all -j "$jobs" || status=$?
minutes() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }
echo "build $(minutes "$built") min, tests $(minutes $((SECONDS - built))) min with $jobs jobs"
exit $status
