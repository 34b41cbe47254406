# SPDX-License-Identifier: BSD-3-Clause
"""Commands and Python of the pages on fitted surfaces run as they are written, on small files of the names that they read."""
import os
import re
import shlex
import shutil
import subprocess
import sys

import knotwork_testing
import las_files
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

MODULES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")


def page(module):
    with open(os.path.join(MODULES, module, "README.md"), encoding="utf-8") as stream:
        return stream.read()


TEXT = page("SurfaceFitting") + page("SurfaceFeatures") + re.search(
    "^## Surfaces as far as their points\n.*?^## ", page("SurfaceTrimming"), re.M | re.S).group(0)
FOLDER = os.path.dirname(knotwork_testing.output("fitting_page/files"))


def run(*words):
    done = subprocess.run([knotwork_testing.PROGRAM, *map(str, words)], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, (words, done.stderr)


def rows(lift=0.0, begin=0.0):
    """A hill over a square of side 1 that begins there, as text."""
    x, y = np.meshgrid(np.linspace(0, 1, 31), np.linspace(0, 1, 31))
    x, y = x.ravel(), y.ravel()
    return np.c_[x + begin, y, lift + np.exp(-8 * ((x - 0.4) ** 2 + (y - 0.5) ** 2))]


def write_text(name, table, separator=" ", head=""):
    with open(os.path.join(FOLDER, name), "w") as file:
        file.write(head + "".join(separator.join(f"{value:.17g}" for value in row) + "\n" for row in table))


def write_part():
    """A piece of a cylinder with its parameters and a temperature."""
    uv = rows()[:, :2]
    part = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[np.cos(uv[:, 0]), np.sin(uv[:, 0]), uv[:, 1]], deep=1))
    part.SetPoints(points)
    for name, values in (("UV", uv), ("Temperature", 20 + uv[:, 0])):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
        array.SetName(name)
        part.GetPointData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(part)
    writer.SetFileName(os.path.join(FOLDER, "part.vtp"))
    assert writer.Write() == 1


def fitted(name, table):
    write_text("points.xyz", table)
    run("fit", "points.xyz", "--tolerance", 0.001, "--output", name)


def prepare():
    write_text("scan.xyz", rows())
    write_text("resurvey.xyz", rows(0.2)[rows()[:, 0] < 0.3])
    write_text("scan.csv", rows(), ",", "x,y,z\n")
    write_text("scan.ply", rows(), " ", "ply\nformat ascii 1.0\nelement vertex 961\nproperty double x\nproperty double y\n"
               "property double z\nend_header\n")
    write_text("samples.csv", np.c_[rows(), rows()[:, 0]], ",", "x,y,z,Temperature\n")
    write_part()
    las_files.write(os.path.join(FOLDER, "survey.las"), 2, 2, 3000)
    shutil.rmtree(os.path.join(FOLDER, "survey.kept"), ignore_errors=True)
    for name, table in (("surface.vtu", rows()), ("terrain.vtu", rows() * (1, 1, 40) + (0, 0, 90)), ("west.vtu", rows()),
                        ("east.vtu", rows(0.01, 1.0)), ("old.vtu", rows()), ("new.vtu", rows(0.1))):
        fitted(name, table)


def test_commands():
    prepare()
    commands = re.findall(r"^(knotwork .*)$", TEXT, re.M)
    assert {shlex.split(command)[1] for command in commands} == {
        "fit", "approximate", "contour", "extrema", "stitch", "distance", "combine", "crop", "tiles"}
    for command in commands:
        words = shlex.split(command, comments=True)[1:]
        outputs = [words[i + 1] for i, word in enumerate(words) if word in ("--output", "--report", "--table", "--points")]
        for name in outputs:
            if os.path.exists(os.path.join(FOLDER, name)):
                os.remove(os.path.join(FOLDER, name))
            shutil.rmtree(os.path.join(FOLDER, os.path.splitext(name)[0]), ignore_errors=True)  # pieces
        run(*words)
        for name in outputs:
            assert os.path.getsize(os.path.join(FOLDER, name)) > 0, (command, name)


def test_python():
    blocks = re.findall(r"^```python\n(.*?)^```", TEXT, re.M | re.S)
    assert blocks
    for block in blocks:
        done = subprocess.run([sys.executable, "-c", block], cwd=FOLDER, stderr=subprocess.PIPE, text=True)
        assert done.returncode == 0 and "ERR" not in done.stderr, done.stderr


knotwork_testing.main(globals())
