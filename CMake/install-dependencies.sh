#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: install-dependencies.sh
# Installs the Debian 12 packages that Knotwork needs and that are missing, as root or through sudo. With nothing missing
# it neither asks for rights nor touches the network. Where apt would remove packages to make room (python3-vtk9 and
# python3-paraview exclude each other), it says which and stops; KNOTWORK_ALLOW_REMOVALS=1 lets it go on.
# KNOTWORK_NO_INSTALL=1 leaves the system alone.
set -eu
packages=(
  # build
  build-essential cmake ninja-build ccache git pkg-config
  # kernels
  libeigen3-dev libtbb-dev libpugixml-dev libboost-dev libsuitesparse-dev libopenblas0-serial
  libocct-data-exchange-dev libocct-modeling-algorithms-dev libocct-ocaf-dev
  libcgal-dev libtet1.5-dev
  # filters, command line, Python
  libvtk9-dev libegl-dev python3-vtk9 python3-dev libcli11-dev nlohmann-json3-dev
  # ParaView plugin
  paraview paraview-dev qtbase5-dev qttools5-dev qttools5-dev-tools libqt5opengl5-dev libqt5svg5-dev python3-mpi4py python3-markdown
  # tests, benchmarks, pictures
  libgtest-dev libbenchmark-dev clang clang-format clang-tidy libclang-rt-14-dev xvfb libgl1-mesa-dri python3-numpy python3-pyqt5 openmpi-bin
  # the guide as a site
  python3-sphinx python3-myst-parser python3-breathe furo doxygen
  # real data for examples and tests
  libcgal-demo gmsh-doc
)
if [ "${KNOTWORK_NO_INSTALL:-0}" = 1 ]; then
  exit 0
fi
if ! command -v dpkg-query > /dev/null; then
  echo "install-dependencies.sh: this is not a Debian system; install by hand: ${packages[*]}" >&2
  exit 1
fi
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2> /dev/null | sed -n 's/^installed //p')
missing=()
for package in "${packages[@]}"; do
  grep -qx -- "$package" <<< "$installed" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi
echo "Installing: ${missing[*]}"
sudo=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "install-dependencies.sh: needs root or sudo to install: ${missing[*]}" >&2
    exit 1
  fi
  sudo=(sudo)
fi
install=(install --no-install-recommends "${missing[@]}")
"${sudo[@]}" apt-get -q update
if ! plan=$(LC_ALL=C apt-get -q -s "${install[@]}"); then
  echo "install-dependencies.sh: apt cannot install: ${missing[*]}" >&2
  exit 1
fi
removed=$(sed -n 's/^Remv \([^ ]*\).*/\1/p' <<< "$plan" | tr '\n' ' ')
guard=(--no-remove)
if [ -n "$removed" ]; then
  if [ "${KNOTWORK_ALLOW_REMOVALS:-0}" != 1 ]; then
    echo "install-dependencies.sh: nothing was installed, for apt would remove: ${removed% }" >&2
    echo "To let it, set KNOTWORK_ALLOW_REMOVALS=1; else install by hand what can stay beside them" \
      "and set KNOTWORK_NO_INSTALL=1. Wanted: ${missing[*]}" >&2
    exit 1
  fi
  echo "Removing: ${removed% }"
  guard=()
fi
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y "${guard[@]}" -o Dpkg::Use-Pty=0 "${install[@]}"
