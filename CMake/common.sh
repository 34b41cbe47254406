# SPDX-License-Identifier: BSD-3-Clause
# Read by Examples/run.sh and Testing/run.sh: where things are, how many jobs, how the build trees are made.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
release="$root/build/release"
paraview="$root/build/paraview"
prefix="$root/build/paraview-prefix"
export PATH="/usr/bin:/bin:$PATH" # the system's Python and compilers: VTK's modules belong to them
export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1

# As many jobs as there are cores, but one for each 2 GB of free memory at most (or of what the control group allows).
default_jobs()
{
  local memory limit used jobs
  memory=$(awk '/^MemAvailable/ { print int($2 / 1024) }' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2> /dev/null || echo max)
  if [ "$limit" != max ]; then
    used=$(cat /sys/fs/cgroup/memory.current 2> /dev/null || echo 0)
    limit=$(((limit - used) / 1048576))
    [ "$limit" -ge "$memory" ] || memory=$limit
  fi
  jobs=$((memory / 2048))
  [ "$jobs" -le "$(nproc)" ] || jobs=$(nproc)
  [ "$jobs" -ge 1 ] || jobs=1
  echo "$jobs"
}

# configure PRESET [-D...]: only when the tree is new, or the presets or options have changed; Ninja sees the rest.
# KNOTWORK_WERROR in the environment becomes the option of that name.
configure()
{
  local tree="$root/build/$1" options
  set -- "$@" ${KNOTWORK_WERROR:+"-DKNOTWORK_WERROR=$KNOTWORK_WERROR"}
  options="$* $(cksum < "$root/CMakePresets.json")"
  if [ -e "$tree/build.ninja" ] && [ "$(cat "$tree/configured" 2> /dev/null)" = "$options" ]; then
    return 0
  fi
  (cd "$root" && cmake --preset "$@")
  echo "$options" > "$tree/configured"
}

configure_release()
{
  configure release "-DKNOTWORK_PARAVIEW_TREE=$paraview" "-DKNOTWORK_PARAVIEW_PREFIX=$prefix"
}

# build_plugin JOBS: the ParaView plugin, with the kernels of the release tree, which is built before.
build_plugin()
{
  "$root/CMake/make-paraview-prefix.sh" "$prefix"
  configure paraview "-DKNOTWORK_PARAVIEW_PREFIX=$prefix" "-DKNOTWORK_KERNELS_FROM=$release"
  cmake --build "$paraview" -j "$1"
}
