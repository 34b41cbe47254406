#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: test_packages.sh FOLDER ROOT
# Installs the packages of FOLDER (CMake/make-packages.sh) in a fresh Debian 12 in the folder ROOT, which is made by debootstrap where it does not
# exist; runs first tasks with the program, Python and ParaView, python3-paraview installed beside; purges them and looks for what is left.
# As root. Ends with 0 when all holds; `umount -l ROOT/proc` before ROOT is removed.
set -eu
folder=$(realpath "$1")
root=$(realpath -m "$2")
if [ ! -e "$root/etc/debian_version" ]; then
  command -v debootstrap > /dev/null || { echo "test_packages.sh: install the package debootstrap" >&2; exit 1; }
  mirror=$(apt-cache policy base-files | grep -oE 'https?://[^ ]+' | grep -v -e security -e snapshot | head -1)
  debootstrap --variant=minbase bookworm "$root" "$mirror" > "$root.log" 2>&1
  cp -r /etc/apt/sources.list* /etc/apt/apt.conf.d "$root/etc/apt/" 2> /dev/null || true
  cp /etc/resolv.conf "$root/etc/"
fi
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
mkdir -p "$root/root/packages"
rm -f "$root"/root/packages/*
cp "$folder"/*.deb "$root/root/packages/"
inside()
{
  chroot "$root" /usr/bin/env -i HOME=/root DEBIAN_FRONTEND=noninteractive PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" bash -euc "cd /root; $1"
}
# name, words behind it; the script is read from the standard input
script()
{
  cat > "$root/root/$1"
  inside "${*:2} $1"
}
install()
{
  inside "apt-get install -y -qq --no-install-recommends $* > install.log 2>&1 || { tail -20 install.log; exit 1; }"
}

echo "== program and Python, on a machine without VTK's Python"
inside "apt-get update -qq"
install "./packages/{knotwork,libknotwork,libknotwork-gpl,python3-knotwork}_*.deb"
begin=$(date +%s)
inside 'knotwork source --shape cube --output cube.vtu --quiet
knotwork boundary cube.vtu --output scan.stl --quiet
knotwork trim scan.stl -o scan.step --quiet --report trim.json
grep -q "\"planes\": 6" trim.json
test -s scan.step
test -s /usr/share/man/man1/knotwork-trim.1.gz
bash -n /usr/share/bash-completion/completions/knotwork'
install "./packages/knotwork-doc_*.deb"
inside 'cd /usr/share/doc/knotwork/html
test -s index.html -a -s modules/SplineCore.html -a -s cxx/SplineGrid.html
test -s _images/terrain.png' # a link that leads somewhere
script first.py python3 << 'END'
import knotwork as kw

part = kw.trim("scan.stl")
assert part.numbers["planes"] == 6, part.numbers
surface = kw.fit([(x / 30, y / 30, x * y / 900) for x in range(31) for y in range(31)], tolerance=0.01)
assert surface.numbers["points_outside"] == 0
END
echo "first results $(($(date +%s) - begin)) s behind the installation"
script loaded.py python3 << 'END' # what is loaded on demand or works in a process
import knotwork as kw
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import vtkImageData

surface = kw.fit([(x / 30, y / 30, x * y / 900) for x in range(31) for y in range(31)], tolerance=0.01)
surface.contour([0.3, 0.6]).save("lines.gpkg")
image, values = vtkImageData(), vtkDoubleArray()
values.SetName("Value")
image.SetDimensions(9, 9, 9)
for i in range(image.GetNumberOfPoints()):
    values.InsertNextValue(sum((x - 4) ** 2 for x in image.GetPoint(i)) - 9)
image.GetPointData().SetScalars(values)
assert kw.tetrahedralize(image).numbers["tetrahedra"] > 100
assert kw.tetrahedralize("scan.stl").numbers["tetrahedra"] > 1
END

echo "== ParaView with its Python beside"
install "paraview python3-paraview xvfb xauth libgl1-mesa-dri ./packages/paraview-knotwork_*.deb"
script pipeline.py xvfb-run -a pvbatch << 'END'
from paraview.simple import *

refined = SplineRefine(Input=KnotworkSplineSource(Shape="Disc"))
refined.UpdatePipeline()
assert refined.GetDataInformation().GetNumberOfCells() == 20, refined.GetDataInformation().GetNumberOfCells()
print("the plugin was loaded by itself")
END
script beside.py python3 << 'END'
import knotwork as kw

print("python3-knotwork beside python3-paraview:", kw.source("disc"))
END
script other.py python3 << 'END'
import vtkmodules.vtkCommonCore

try:
    import knotwork
except ImportError as fault:
    print("refused behind the modules of another VTK:", fault)
else:
    raise SystemExit("two VTKs in one process")
END

echo "== what is left behind purge"
inside "apt-get purge -y -qq knotwork libknotwork libknotwork-gpl python3-knotwork paraview-knotwork knotwork-doc > purge.log 2>&1"
left=$(inside 'find / -xdev -iname "*knotwork*" -not -path "/proc/*" -not -path "/root/*" -not -path "/var/log/*"; ls /usr/bin/p*.conf 2> /dev/null || true')
if [ -n "$left" ]; then
  echo "left behind: $left"
  exit 1
fi
inside 'python3 -c "import paraview"'
echo "nothing; python3-paraview is kept"
