#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: make-packages.sh [FOLDER]
# Builds Knotwork and its ParaView plugin, and makes Debian packages of them in FOLDER (build/packages). They serve every processor of the
# architecture. KNOTWORK_MAINTAINER="Name <address>" stands in them as the maintainer.
set -eu
source "$(dirname "$0")/common.sh"
folder=$(realpath -m "${1:-$root/build/packages}")
cd "$root"
configure_release
cmake --build "$release" -j "$(nproc)"
build_plugin "$(nproc)"
/usr/bin/python3 "$root/CMake/Packages/make_packages.py" "$root" "$release" "$paraview" "$folder"
