# SPDX-License-Identifier: BSD-3-Clause
"""STEP solids of splines on closed meshes are meshed with tetrahedra by gmsh, where it is installed: no error, and the volume is ours.
Meshes of the folder that KNOTWORK_UNSTRUCTURED_MESHES names, too; the rod among them has folded cells, which are untangled."""
import os
import re
import shutil
import subprocess

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter

GMSH = shutil.which("gmsh")


def write_off(name, points, faces):
    with open(knotwork_testing.output(name), "w") as file:
        file.write("OFF\n%d %d 0\n" % (len(points), len(faces)))
        file.writelines("%.17g %.17g %.17g\n" % tuple(point) for point in points)
        file.writelines("4 %d %d %d %d\n" % tuple(face) for face in faces)
    return knotwork_testing.output(name)


def blocks(cells, smoothing):
    """The surface of blocks of whole numbers, every point moved to the mean of its neighbours a few times."""
    cells = set(cells)
    numbers, faces = {}, []
    for cell in sorted(cells):
        for axis in range(3):
            for step in (-1, 1):
                beside = list(cell)
                beside[axis] += step
                if tuple(beside) in cells:
                    continue
                face = []
                for i, j in [(0, 0), (1, 0), (1, 1), (0, 1)][::step]:
                    key = list(cell)
                    key[axis] += step > 0
                    key[(axis + 1) % 3] += i
                    key[(axis + 2) % 3] += j
                    face.append(numbers.setdefault(tuple(key), len(numbers)))
                faces.append(face)
    points = np.array(list(numbers), float)
    sides = np.array([(face[k], face[k - 1]) for face in faces for k in range(4)])
    for _ in range(smoothing):
        sums = np.zeros_like(points)
        np.add.at(sums, sides[:, 0], points[sides[:, 1]])
        points = sums / np.bincount(sides[:, 0])[:, None]
    return points, faces


def volume_of_tetrahedra(name):
    """Of a mesh file of gmsh, version 2."""
    with open(name) as file:
        text = file.read()
    rows = text.split("$Nodes\n")[1].split("$EndNodes")[0].split("\n")[1:-1]
    points = {int(row.split()[0]): np.array(row.split()[1:4], float) for row in rows}
    volume = 0.0
    for row in text.split("$Elements\n")[1].split("$EndElements")[0].split("\n")[1:-1]:
        numbers = [int(item) for item in row.split()]
        if numbers[1] == 4:
            a, b, c, d = (points[i] for i in numbers[-4:])
            volume += abs(np.dot(b - a, np.cross(c - a, d - a))) / 6
    return volume


def check(mesh, degree, size, name):
    made = knotwork.vtkUnstructuredSpline()
    made.SetInputDataObject(knotwork.read(mesh))
    made.SetDegree(degree)
    made.Update()
    numbers = made.GetOutputDataObject(1)
    assert numbers.GetValueByName(0, "StillFolded").ToInt() == 0
    step, tetrahedra = (knotwork_testing.output(name + ending) for ending in (".step", ".msh"))
    knotwork.write(made.GetOutputDataObject(0), step)
    done = subprocess.run([GMSH, "-3", "-clmax", str(size), "-format", "msh2", "-o", tetrahedra, step],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=300)
    faults = [line for line in done.stdout.split("\n") if re.match(r"Error *: +\S", line)]
    assert done.returncode == 0 and not faults, (name, degree, faults)
    assert "elements remain invalid" not in done.stdout, (name, degree, done.stdout)
    # chords of the size: the volume of the solid but for their part
    triangles = knotwork.vtkSplineTessellate()
    triangles.SetInputDataObject(made.GetOutputDataObject(0))
    triangles.SetChordalTolerance(size / 100)
    triangles.Update()
    split = vtkTriangleFilter()
    split.SetInputDataObject(triangles.GetOutputDataObject(0))
    mass = vtkMassProperties()
    mass.SetInputConnection(split.GetOutputPort())
    mass.Update()
    assert abs(volume_of_tetrahedra(tetrahedra) / mass.GetVolume() - 1) < 0.03, (name, degree)


def test_solids_are_meshed():
    if not GMSH:
        knotwork_testing.skip("gmsh is not installed")
    box = [(i, j, k) for i in range(3) for j in range(3) for k in range(3)]
    ring = [(i, j, 0) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    for name, cells in (("box", box), ("ring", ring)):
        fine = [tuple(2 * c + d for c, d in zip(cell, at)) for cell in cells for at in np.ndindex(2, 2, 2)]
        mesh = write_off(name + ".off", *blocks(fine, 4))
        for degree in (2, 3):
            check(mesh, degree, 0.5, name)
    folder = os.environ.get("KNOTWORK_UNSTRUCTURED_MESHES", "")
    for name, size in (("gs_bitorus.off", 0.3), ("bl_rod_764.off", 1.0)):
        if os.path.exists(os.path.join(folder, name)):
            for degree in (2, 3):
                check(os.path.join(folder, name), degree, size, name)


knotwork_testing.main(globals())
