# SPDX-License-Identifier: BSD-3-Clause
"""Every input of every job of the program: what it takes, and a run in which everything else is in order."""
import os

import numpy as np

import damages
import skeletons
import step_solids
from refusals import good, path, write_text

FILE = "the file in question"  # its place in a run

# endings of what an input takes, the one to begin with first
ENDINGS = {"surface": (".vtu", ".xml", ".g2", ".step", ".iges"), "points": (".vtp", ".xyz", ".csv", ".ply", ".g2"),
           "cells": (".vtp",), "mesh": (".off", ".obj", ".ply", ".stl", ".vtp"), "curves": (".vtp",),
           "boundary": (".json",), "map": (".vtu",), "trim": (".vtu",), "grid": (".vtu",), "layout": (".vtu",),
           "quads": (".off", ".obj", ".ply", ".vtu"), "values": (".vtp", ".csv"), "edges": (".vtp",), "part": (".step",), "box": (".off", ".obj", ".ply"), "volume": (".vtu",), "problem": (".json",), "cloud": (".xyz", ".ply")}

BOUNDARY = ('{"curves": [%s]}' % ", ".join(
    '{"degree": 1, "knots": [0, 0, 1, 1], "control_points": [%s]}' % ends
    for ends in ("[0, 0], [1, 0]", "[0, 1], [1, 1]", "[0, 0], [0, 1]", "[1, 0], [1, 1]")))


# of the square: held on the left, drawn on the right
PROBLEM = ('{"material": {"youngs_modulus": 200, "poissons_ratio": 0.25}, "conditions": ['
           '{"on": {"side": 0}, "displacement": [0, 0]}, {"on": {"side": 1}, "traction": [1, "x - y"]}]}')


def triangles(ending):
    """A square as four triangles, which fill it from its middle."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 0.1)]
    corners = [(i, (i + 1) % 4, 4) for i in range(4)]
    if ending == ".off":
        lines = ["OFF", "5 4 0", *(" ".join(map(str, p)) for p in points), *("3 %d %d %d" % c for c in corners)]
    elif ending == ".obj":
        lines = [*("v %g %g %g" % p for p in points), *("f %d %d %d" % tuple(i + 1 for i in c) for c in corners)]
    elif ending == ".ply":
        lines = ["ply", "format ascii 1.0", "element vertex 5", "property float x", "property float y", "property float z",
                 "element face 4", "property list uchar int vertex_indices", "end_header",
                 *(" ".join(map(str, p)) for p in points), *("3 %d %d %d" % c for c in corners)]
    else:
        facets = ["facet normal 0 0 1\nouter loop\n" + "\n".join("vertex %g %g %g" % points[i] for i in c) +
                  "\nendloop\nendfacet" for c in corners]
        lines = ["solid x", *facets, "endsolid"]
    return "\n".join(lines) + "\n"


def cube(ending):
    """The surface of a cube as six quadrilaterals."""
    points = [(i % 2, i // 2 % 2, i // 4) for i in range(8)]
    corners = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    if ending == ".off":
        lines = ["OFF", "8 6 0", *("%d %d %d" % p for p in points), *("4 %d %d %d %d" % c for c in corners)]
    elif ending == ".obj":
        lines = [*("v %d %d %d" % p for p in points), *("f %d %d %d %d" % tuple(i + 1 for i in c) for c in corners)]
    else:
        lines = ["ply", "format ascii 1.0", "element vertex 8", "property float x", "property float y", "property float z",
                 "element face 6", "property list uchar int vertex_indices", "end_header",
                 *("%d %d %d" % p for p in points), *("4 %d %d %d %d" % c for c in corners)]
    return "\n".join(lines) + "\n"


SOUND = {"surface": "square", "points": "cloud", "cells": "cloud", "mesh": "mesh", "curves": "target", "boundary": "boundary",
         "map": "map", "trim": "trim", "grid": "square", "layout": "quads", "quads": "quads", "values": "samples", "edges": "edges", "part": "solid",
         "box": "quads", "volume": "cube", "problem": "problem", "cloud": "cloud"}


# What `quadremesh` finds as blender: every triangle becomes three quadrilaterals.
BLENDER = """#!/bin/sh
while [ "$1" != -- ]; do shift; done
awk 'NR == 2 { n = $1; m = $2 }
NR > 2 && NR <= 2 + n { for (k = 1; k <= 3; ++k) x[NR - 3, k] = $k }
NR > 2 + n { t = NR - 3 - n; for (k = 0; k < 3; ++k) c[t, k] = $(k + 2) }
function middle(a, b, key) {
  key = a < b ? a " " b : b " " a
  if (!(key in edge)) { edge[key] = n; for (k = 1; k <= 3; ++k) x[n, k] = (x[a, k] + x[b, k]) / 2; ++n }
  return edge[key]
}
END {
  for (t = 0; t < m; ++t) {
    for (i = 0; i < 3; ++i) e[i] = middle(c[t, i], c[t, (i + 1) % 3])
    for (k = 1; k <= 3; ++k) x[n, k] = (x[c[t, 0], k] + x[c[t, 1], k] + x[c[t, 2], k]) / 3
    for (i = 0; i < 3; ++i) faces = faces "4 " c[t, i] " " e[i] " " n " " e[(i + 2) % 3] "\\n"
    ++n
  }
  printf "OFF\\n%d %d 0\\n", n, 3 * m
  for (i = 0; i < n; ++i) printf "%.9g %.9g %.9g\\n", x[i, 1], x[i, 2], x[i, 3]
  printf "%s", faces
}' "$2" > "$3"
"""


def add_blender():
    """The stand-in becomes the first on PATH."""
    os.makedirs(path("programs"), exist_ok=True)
    with open(path("programs/blender"), "w", encoding="utf-8") as stream:
        stream.write(BLENDER)
    os.chmod(path("programs/blender"), 0o755)
    os.environ["PATH"] = path("programs") + os.pathsep + os.environ["PATH"]


def sound(kind, ending):
    """A file that is in order."""
    return path(SOUND[kind] + ending)


def make_files():
    """Writes all of them, small ones."""
    add_blender()
    x, y = np.meshgrid(np.linspace(0, 1, 15), np.linspace(0, 1, 15))
    heights = np.c_[x.ravel(), y.ravel(), (0.2 * np.sin(5 * x) * y).ravel()]
    rows = [" ".join("%.17g" % value for value in point) for point in heights]
    write_text("cloud.csv", "x,y,z,Heat\n" + "".join(row.replace(" ", ",") + ",1\n" for row in rows))
    write_text("cloud.xyz", "\n".join(rows) + "\n")
    write_text("samples.csv", "x,y,z,Temperature\n" + "".join("%.17g,%.17g,%.17g,%.17g\n" % (*point, point[0] - 2 * point[1]) for point in heights))
    write_text("cloud.ply", "ply\nformat ascii 1.0\nelement vertex 225\nproperty double x\nproperty double y\n"
               "property double z\nend_header\n" + "\n".join(rows) + "\n")
    for ending in (".g2", ".vtp"):
        good("convert", path("cloud.csv"), "--output", path("cloud" + ending))
    good("convert", path("samples.csv"), "--output", path("samples.vtp"))
    good("fit", path("cloud.csv"), "--tolerance", 1e-3, "--field", "Heat", "--output", path("height.vtu"))
    for name, x in (("square", 0.5), ("east", 1.5)):
        good("source", "--degree", 2, "--elements", 2, 2, 1, "--center", x, 0.5, 0, "--output", path(name + ".vtu"))
    good("source", "--shape", "cube", "--output", path("cube.vtu"))
    for ending in (".xml", ".g2", ".step", ".iges"):
        good("convert", path("square.vtu"), "--output", path("square" + ending))
    solids = step_solids.Solids()
    solids.box((0, 0, 0), (1, 1, 1))
    solids.write(path("solid.step"))
    for ending in (".off", ".obj", ".ply", ".stl"):
        write_text("mesh" + ending, triangles(ending))
    for ending in (".off", ".obj", ".ply"):
        write_text("quads" + ending, cube(ending))
    good("flatten", path("mesh.off"), "--output", path("mesh.vtp"))
    good("features", path("mesh.off"), "--lines", path("edges.vtp"), "--output", path("regions.vtp"))
    skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, 101)), path("template.vtp"))
    skeletons.write(skeletons.polydata(skeletons.curves(0.1, 5, 50)), path("target.vtp"))
    write_text("boundary.json", BOUNDARY)
    write_text("problem.json", PROBLEM)
    good("crop", path("height.vtu"), path("cloud.vtp"), "--curves", path("trim.vtu"), "--output", path("face.vtu"))
    damages.write(damages.quadrilateral(), path("quads.vtu"))
    good("map", path("template.vtp"), path("target.vtp"), "--iterations", 1, "--output", path("map.vtu"))


def runs():
    """Pairs of a run and the kind of the file in question."""
    surface, points, mesh = path("square.vtu"), path("cloud.vtp"), path("mesh.off")
    height = path("height.vtu")
    template, target, grid, polydata = path("template.vtp"), path("target.vtp"), "out.vtu", "out.vtp"
    by_geometry = ["--matching", "geometry", "--edges", "table.csv"]
    report = ["--report", "report.json", "--quiet"]
    for arguments, kind in (
            (["combine", FILE, height, "--output", grid], "surface"),
            (["combine", height, FILE, "--output", grid], "surface"),
            (["contour", FILE, "--table", "table.csv", "--output", polydata], "surface"),
            (["convert", FILE, "--output", grid], "surface"),
            (["convert", path("face.vtu"), "--curves", FILE, "--output", "out.step"], "trim"),
            (["crop", FILE, points, "--triangles", polydata, "--output", "out.step"], "surface"),
            (["crop", height, FILE, "--triangles", polydata, "--output", "out.step"], "points"),
            (["distance", points, FILE, "--class-table", "table.csv", "--output", polydata], "surface"),
            (["distance", FILE, height, "--class-table", "table.csv", "--output", polydata], "points"),
            (["evaluate", FILE, points, "--output", polydata], "surface"),
            (["evaluate", FILE, points, "--mode", "probe", "--output", polydata], "surface"),
            (["evaluate", surface, FILE, "--output", polydata], "cells"),
            (["extrema", FILE, "--component", 0, "--boxes", "boxes.vtp", "--output", polydata], "surface"),
            (["extract", FILE, "--output", grid], "surface"),
            (["extract", FILE, "--iso-curve", "first", "--output", grid], "surface"),
            (["fit", FILE, "--table", "table.csv", "--points", polydata, "--output", grid], "points"),
            (["flatten", FILE, "--loops", "loops.vtp", "--output", polydata], "mesh"),
            (["info", FILE], "surface"),
            (["view", FILE, "--size", 64, 64, "--output", "out.png"], "surface"),
            (["view", FILE, "--size", 64, 64, "--output", "out.png"], "points"),
            (["info", FILE], "points"),
            (["map", template, FILE, "--mapped", polydata, "--output", grid], "curves"),
            (["map", FILE, target, "--mapped", polydata, "--output", grid], "curves"),
            (["map", template, target, "--initial", FILE, "--output", grid], "map"),
            (["parameterize", FILE, "--first-map", "first.vtu", "--output", grid], "boundary"),
            (["parameterize", path("boundary.json"), "--layout", FILE, "--output", grid], "layout"),
            (["patches", FILE, "--cuts", "cuts.vtp", "--table", "table.csv", "--output", grid], "quads"),
            (["raster", FILE, "--cell-size", 0.05, "--output", "out.tif"], "surface"),
            (["refine", FILE, "--output", grid], "surface"),
            (["stitch", FILE, path("east.vtu"), *by_geometry, "--output", grid], "surface"),
            (["stitch", path("east.vtu"), FILE, *by_geometry, "--output", grid], "surface"),
            (["tessellate", FILE, "--output", polydata], "surface"),
            (["tiles", FILE, "--tile-size", 0.5, "--output", "out.tiles"], "cloud"),
            (["trim", FILE, "--triangles", polydata, "--output", "out.step"], "mesh"),
            (["unstructured", FILE, "--table", "table.csv", "--output", grid], "quads"),
            (["validate", FILE, "--table", "table.csv", "--output", grid], "grid"),
            (["warp", FILE, surface, "--output", polydata], "points"),
            (["warp", surface, FILE, "--output", grid], "surface"),
            (["approximate", FILE, "--values", "Temperature", "--table", "table.csv", "--points", polydata, "--output", grid], "values"),
            (["cadmodify", FILE, "--cut-plane", 0.5, 0, 0, 1, 0, 0, "--suggest", "--table", "table.csv", "--output", "out.step"], "part"),
            (["hexes", FILE, "--solid-table", "table.csv", "--output", grid], "part"),
            (["quads", FILE, "--face-table", "table.csv", "--output", polydata], "part"),
            (["sweep", FILE, "--direction", 0, 0, 2, "--output", grid], "quads"),
            (["cadfit", FILE, "--entities", "table.csv", "--output", grid], "quads"),
            (["cadfit", FILE, "--target", path("quads.off"), "--elements-only", "--table", "table.csv", "--output", grid], "quads"),
            (["intersections", FILE, "--table", "table.csv", "--output", polydata], "surface"),
            (["recognize", FILE, "--edges", "edges.vtp", "--regions", "table.csv", "--output", polydata], "mesh"),
            (["repair", FILE, "--allow-open", "--actions", "actions.vtp", "--output", polydata], "mesh"),
            (["remesh", FILE, "--lines", "lines.vtp", "--output", polydata], "mesh"),
            (["quadremesh", FILE, "--tries", "table.csv", "--output", polydata], "box"),
            (["tetrahedralize", FILE, "--repair", "--boundary", "edges.vtp", "--output", grid], "mesh"),
            (["boundary", FILE, "--output", polydata], "surface"),
            (["compare", FILE, path("cube.vtu"), "--histogram", "histogram.csv", "--output", "table.csv"], "volume"),
            (["compare", path("cube.vtu"), FILE, "--mesh-boundary", polydata, "--output", "table.csv"], "volume"),
            (["solve", "elasticity", FILE, path("problem.json"), "--gauss-points", polydata, "--output", grid], "surface"),
            (["solve", "elasticity", surface, FILE, "--conditions", "table.csv", "--output", grid], "problem"),
            (["align", FILE, "--to", mesh, "--table", "table.csv", "--output", polydata], "points"),
            (["distance", FILE, mesh, "--both-ways", "--percentiles", "table.csv", "--model", "model.vtp", "--output", polydata], "points"),
            (["features", FILE, "--lines", "lines.vtp", "--corners", "corners.vtp", "--output", polydata], "mesh"),
            (["features", mesh, "--edges", FILE, "--output", polydata], "edges")):
        yield arguments + report, kind


def on(arguments, file):
    """The run with that file."""
    return [file if argument is FILE else argument for argument in arguments]
