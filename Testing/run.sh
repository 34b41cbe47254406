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
domains="$root/../shared/data/domains"
if [ -z "${KNOTWORK_DOMAIN_CASES:-}" ] && [ -d "$domains" ]; then
  export KNOTWORK_DOMAIN_CASES="$domains"
fi

meshes="$root/../shared/data/meshes"
if [ -z "${KNOTWORK_MESH_CASES:-}" ] && [ -d "$meshes" ]; then
  export KNOTWORK_MESH_CASES="$meshes"
fi

surfaces="$root/../shared/data/lr"
if [ -z "${KNOTWORK_LR_CASES:-}" ] && [ -d "$surfaces" ]; then
  export KNOTWORK_LR_CASES="$surfaces"
fi

# One display for all tests that draw; they start their own where there is none.
cd "$release"
status=0
"$root/CMake/with-display.sh" ctest --no-tests=error --output-on-failure -j "$jobs" "${select[@]}" || status=$?
"$root/Testing/variants.sh" $all -j "$jobs" || status=$?
minutes() { printf '%d:%02d' $(($1 / 60)) $(($1 % 60)); }
echo "build $(minutes "$built") min, tests $(minutes $((SECONDS - built))) min with $jobs jobs"
exit $status
