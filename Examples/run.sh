#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: Examples/run.sh [-j JOBS]
# Installs what is missing, builds (the ParaView plugin too), runs the examples on real data and says where their
# pictures are.
set -eu
source "$(dirname "$0")/../CMake/common.sh"
jobs=$(default_jobs)
while [ $# -gt 0 ]; do
  case "$1" in
    -j) jobs=$2; shift ;;
    -j*) jobs=${1#-j} ;;
    *) sed -n '3,5s/^# //p' "$0" >&2; exit 2 ;;
  esac
  shift
done

"$root/CMake/install-dependencies.sh"

configure_release
cmake --build "$release" -j "$jobs" --target products
build_plugin "$jobs"
export KNOTWORK_PARAVIEW_PREFIX="$prefix"

output="$root/build/examples"
mkdir -p "$output"
export PATH="$release/bin:$PATH"
export PYTHONPATH="$(echo "$release"/lib/python3.*/site-packages)"
export PYTHONDONTWRITEBYTECODE=1
for example in "$root"/Examples/Gallery/[!_]*.py; do
  echo "== $(basename "$example")"
  status=0
  "$root/CMake/with-display.sh" /usr/bin/python3 "$example" --output "$output" || status=$?
  case $status in
    0) ;;
    77) echo "left out: its data is not installed" ;; # as it has said
    *) exit "$status" ;;
  esac
done
echo "Pictures:"
ls "$output"/*.png
