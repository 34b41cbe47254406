#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: make-paraview-prefix.sh DIR
# Lays a prefix with all of ParaView below DIR: links to the installed packages paraview and paraview-dev, copies of their
# CMake files, and the files of python3-paraview, which find_package(ParaView) and pvbatch need but which cannot be
# installed beside python3-vtk9. A prefix made from the same versions is left as it is.
set -eu
dir=$(realpath -m "$1")
version=$(dpkg-query -W -f '${Package} ${Version}\n' paraview paraview-dev)
stamp="$dir/versions"
if [ -e "$stamp" ] && [ "$(cat "$stamp")" = "$version" ]; then
  exit 0
fi
echo "ParaView prefix in $dir"
rm -rf "$dir"
mkdir -p "$dir/download"
cd "$dir"
wanted="python3-paraview=$(dpkg-query -W -f '${Version}' paraview)"
# Sandbox::User: apt's own user may not write into this folder.
download=(apt-get -q -o APT::Sandbox::User=root download "$wanted")
if ! (cd download && "${download[@]}"); then # package lists may be missing or old
  if [ "$(id -u)" = 0 ]; then apt-get -q update; else sudo apt-get -q update; fi
  (cd download && "${download[@]}")
fi
dpkg -x download/python3-paraview_*.deb .
rm -rf download
# CMake files find their prefix from where they lie: copies; everything else is a link.
dpkg -L paraview paraview-dev | grep '^/usr/' | grep -v '^/usr/share/doc' | sort -u | while read -r file; do
  if [ -L "$file" ] || [ ! -d "$file" ]; then
    echo "$file"
  fi
done > files
grep '/cmake/' files | xargs -d '\n' cp --parents -t .
grep -v '/cmake/' files | xargs -d '\n' cp -s --parents -t . 2> /dev/null || true # some come with python3-paraview too
rm files
test -e usr/lib/*/cmake/paraview-*/paraview-config.cmake || test -e usr/lib/*/cmake/paraview-*/ParaViewConfig.cmake
echo "$version" > "$stamp"
