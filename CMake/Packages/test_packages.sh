#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: test_packages.sh FOLDER ROOT
# Asks lintian about the packages of FOLDER (CMake/make-packages.sh); installs them in a fresh Debian 12 in the folder ROOT, which is made by
# debootstrap where it does not exist; runs the tests of debian/tests there by autopkgtest, which does first tasks with the program, Python and
# ParaView; purges them and looks for what is left. As root. Ends with 0 when all holds; `umount -l ROOT/proc` before ROOT is removed.
set -eu
here=$(dirname "$(realpath "$0")")
folder=$(realpath "$1")
root=$(realpath -m "$2")
for program in autopkgtest debootstrap lintian; do
  command -v $program > /dev/null || { echo "test_packages.sh: install the package $program" >&2; exit 1; }
done
if [ ! -e "$root/etc/debian_version" ]; then
  mirror=$(apt-cache policy base-files | grep -oE 'https?://[^ ]+' | grep -v -e security -e snapshot | head -1)
  debootstrap --variant=minbase bookworm "$root" "$mirror" > "$root.log" 2>&1
  rm -f "$root/etc/apt/sources.list"
  cp -r /etc/apt/sources.list* /etc/apt/apt.conf.d "$root/etc/apt/" 2> /dev/null || true
  cp /etc/resolv.conf "$root/etc/"
fi
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
inside()
{
  chroot "$root" /usr/bin/env -i HOME=/root DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" bash -euc "cd /root; $1"
}

echo "== lintian"
lintian --no-cfg --allow-root --fail-on error,warning "$folder"/*.deb

echo "== debian/tests"
inside "apt-get update -qq"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cp -r "$here/debian" "$tree/"
dpkg-deb --fsys-tarfile "$folder"/knotwork_*.deb | tar -xO ./usr/share/doc/knotwork/changelog.Debian.gz | gunzip > "$tree/debian/changelog"
autopkgtest "$folder"/*.deb "$tree/" -- chroot "$root"

echo "== what is left behind purge"
inside 'dpkg-query -W -f "\${Package}\n" "*knotwork*" | xargs apt-get purge -y -qq > purge.log 2>&1'
left=$(inside 'find / -xdev -iname "*knotwork*" -not -path "/proc/*" -not -path "/root/*" -not -path "/tmp/*" -not -path "/var/log/*"; ls /usr/bin/p*.conf 2> /dev/null || true')
if [ -n "$left" ]; then
  echo "left behind: $left"
  exit 1
fi
inside 'python3 -c "import paraview"'
echo "nothing; python3-paraview is kept"
