# SPDX-License-Identifier: BSD-3-Clause
"""Makes the MFEM meshes of this folder: a star of five rhombi, a Klein bottle with nodes of degree 2, a disc of five NURBS patches.
usage: make_meshes.py FOLDER"""
import itertools
import os
import sys
from math import cos, pi, sin, sqrt

FOLDER = sys.argv[1]


def write(name, kind, elements, *sections):
    cells = [f"{attribute} 3 {' '.join(map(str, corners))}" for attribute, corners in elements]
    with open(os.path.join(FOLDER, name), "w") as stream:
        stream.write("\n".join([f"MFEM {kind} v1.0", "", "# made by make_meshes.py", "", "dimension", "2", "", "elements",
                                str(len(cells)), *cells, "", "boundary", "0", "", *sections]) + "\n")


def nodes(name, points):
    return ["FiniteElementSpace", f"FiniteElementCollection: {name}", f"VDim: {len(points[0])}", "Ordering: 1", "", *rows(points)]


def rows(points):
    return [" ".join("%.10g" % x for x in point) for point in points]


def star():
    ring = [(r * cos(k * pi / 5), r * sin(k * pi / 5)) for k, r in zip(range(10), itertools.cycle((1.0, 1.5)))]
    elements = [(1 + k % 2, (0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % 10)) for k in range(5)]
    write("linear.mesh", "mesh", elements, "vertices", "11", "2", "0 0", *rows(ring))


def klein_bottle(around=8, across=6):
    """A figure eight that turns half a time while it goes around: (u + 2 pi, v) is (u, -v)."""
    def place(u, v):
        out = 3 + cos(u / 2) * sin(v) - sin(u / 2) * sin(2 * v)
        return out * cos(u), out * sin(u), sin(u / 2) * sin(v) + cos(u / 2) * sin(2 * v)

    def vertex(i, j):
        return j % across + across * i if i < around else -j % across

    elements, points = [], []
    for i, j in itertools.product(range(around), range(across)):
        elements.append((1, (vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1))))
        points += [place(2 * pi * (i + a / 2) / around, 2 * pi * (j + b / 2) / across) for b in range(3) for a in range(3)]
    write("curved.mesh", "mesh", elements, "vertices", str(around * across), "", "nodes", *nodes("L2_T1_2D_P2", points))


def disc():
    """A square within, and around it four patches out to the circle of radius 1."""
    inner = [(-0.4, -0.4, 1), (0.4, -0.4, 1), (0.4, 0.4, 1), (-0.4, 0.4, 1)]
    outer = [(x / abs(x) / sqrt(2), y / abs(y) / sqrt(2), 1) for x, y, _ in inner]

    def between(a, b, t):
        """Of rational points (x, y, w)."""
        w = (1 - t) * a[2] + t * b[2]
        return tuple(((1 - t) * a[2] * p + t * b[2] * q) / w for p, q in zip(a[:2], b[:2])) + (w,)

    def arc(k):
        """Control point in the middle of a quarter."""
        a, b = outer[k], outer[(k + 1) % 4]
        return a[0] + b[0], a[1] + b[1], sqrt(0.5)

    middle = [between(inner[k], inner[(k + 1) % 4], 0.5) for k in range(4)]
    quarters = [(0, 1), (1, 2), (3, 2), (0, 3)]  # from, to: those that face each other run alike
    edges = [(k % 2, a, b) for k, (a, b) in enumerate(quarters)] + [(k % 2, a + 4, b + 4) for k, (a, b) in enumerate(quarters)]
    edges += [(2, k, k + 4) for k in range(4)]
    points = inner + outer + middle + [arc(k) for k in range(4)]
    for k in range(4):
        points += [between(inner[k], outer[k], t) for t in (0.25, 0.75)]
    elements = [(1, (0, 1, 2, 3))]
    points.append((0, 0, 1))
    for k in range(4):
        a, b = k, (k + 1) % 4
        elements.append((2, (a, a + 4, b + 4, b)))
        points += [between(middle[k], arc(k), t) for t in (0.25, 0.75)]
    knots = ["knotvectors", "3", "2 3 0 0 0 1 1 1", "2 3 0 0 0 1 1 1", "2 4 0 0 0 0.5 1 1 1"]
    # %.17g, or the boundary is no circle
    write("nurbs.mesh", "NURBS mesh", elements, "edges", "12", *(" ".join(map(str, edge)) for edge in edges), "", "vertices", "8", "",
          *knots, "", "weights", *("%.17g" % p[2] for p in points), "", *nodes("NURBS2", [p[:2] for p in points])[:5],
          *(" ".join("%.17g" % x for x in p[:2]) for p in points))


star()
klein_bottle()
disc()
