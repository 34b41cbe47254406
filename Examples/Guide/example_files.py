#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: example_files.py FOLDER

Files of the names that the guide's pages read, to try them with: a scan and a mesh of quadrilaterals of Debian's libcgal-demo, the points of a
terrain of its gmsh-doc, a CAD part, and an outline and a mesh that are computed here."""
import gzip
import io
import math
import os
import shutil
import sys
import tarfile

import knotwork as kw
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
MESHES = "/usr/share/doc/libcgal-dev/data.tar.gz"
TERRAIN = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/api/terrain_stl_data.stl.gz"
PART = os.path.join(HERE, "..", "..", "Testing", "Data", "Parts", "piston.step")


def read_off(archive, name):
    """Points and polygons of a mesh of the archive."""
    words = io.TextIOWrapper(archive.extractfile(f"data/meshes/{name}.off")).read().split()
    points, cells = int(words[1]), int(words[2])
    xyz = np.array(words[4:4 + 3 * points], float).reshape(-1, 3)
    rest, polygons = list(map(int, words[4 + 3 * points:])), []
    for _ in range(cells):
        polygons.append(rest[1:1 + rest[0]])
        rest = rest[1 + rest[0]:]
    return xyz, polygons


def make_scan(archive):
    """scan.stl: a machined part, closed triangles; damaged.off: a cow that intersects itself; quads.off: a torus of quadrilaterals."""
    kw.mesh(*read_off(archive, "joint")).save("scan.stl")
    for name, file in (("cow", "damaged.off"), ("torus_quad", "quads.off")):
        with open(file, "wb") as stream:
            stream.write(archive.extractfile(f"data/meshes/{name}.off").read())


def make_points():
    """points.xyz: a terrain of 2649 m x 2491 m, heights 4 to 125 m; resurvey.xyz: a part of it, half a metre higher."""
    with gzip.open(TERRAIN) as packed, open("terrain.stl", "wb") as plain:
        shutil.copyfileobj(packed, plain)
    xyz = kw.read("terrain.stl").points.astype(float)
    os.remove("terrain.stl")
    np.savetxt("points.xyz", xyz, fmt="%.9g")
    np.savetxt("resurvey.xyz", xyz[xyz[:, 0] < 800] + [0, 0, 0.5], fmt="%.9g")


def make_outline():
    """outline.svg: a blade's section, as a drawing program writes it."""
    share = np.linspace(0, 1, 60)
    upper = np.c_[100 * share, 30 + 22 * np.sin(math.pi * share)]
    lower = np.c_[100 * share, 10 + 18 * np.sin(math.pi * share)]
    points = np.r_[upper, lower[::-1]]
    words = " ".join(f"{x:.3f},{y:.3f}" for x, y in points)
    with open("outline.svg", "w", encoding="ascii") as stream:
        stream.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60"><path fill="none" stroke="black" d="M {words} Z"/></svg>\n')


def make_mesh():
    """mesh.msh: quadrilaterals of a plate with a hole, one of whose points was moved across its neighbours; sound.msh: the same before."""
    plate = kw.source("plate-with-hole", inner_radius=0.2, elements=(4, 6, 1)).tessellate(chordal_tolerance=0.01)
    plate.save("sound.msh")
    points, cells = np.array(plate.points), []
    for i in range(plate.GetNumberOfCells()):
        cell = plate.GetCell(i)  # the same object every time
        cells.append([cell.GetPointId(k) for k in range(4)])
    victim = cells[len(cells) // 2]
    points[victim[0]] += 1.5 * (points[victim[2]] - points[victim[0]])
    kw.mesh(points, cells).save("mesh.msh")


def main(folder):
    for file, package in ((MESHES, "libcgal-demo"), (TERRAIN, "gmsh-doc")):
        if not os.path.exists(file):
            print(f"skipped: {file} is missing; install the package {package}")
            return 77
    os.makedirs(folder, exist_ok=True)
    shutil.copyfile(PART, os.path.join(folder, "part.step"))
    os.chdir(folder)
    with tarfile.open(MESHES) as archive:
        make_scan(archive)
    make_points()
    make_outline()
    make_mesh()
    print(*sorted(os.listdir(".")), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
