#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The table of random parts on the page of CAD meshing: parts of OpenCASCADE, their numbers drawn by seeds, go through `knotwork quads`, `hexes` and `cadfit` to STEP, which
OpenCASCADE reads again.

usage: random_parts.py PROGRAM [--first SEED] [--count N] [--kinds NAME,...] [--keep FOLDER] [--write PAGE]

Needs Debian's python3-gmsh. Of each part:

    quads PART --output quads.vtp           cadfit quads.vtp --target PART --degree 2 --output quads.step
    hexes PART --output hexes.vtu           cadfit hexes.vtu --target PART --degree 2 --output hexes.step

A part comes back when the STEP file has as many solids as it had, their volume differs by a thousandth at most and every element is proved valid. `hexes` may refuse a part
that cannot be swept; it has to say why. What does not come back is listed on the standard error, with its seed. --keep: parts and results stay there. --write puts the table between the
comments `random parts: begin` and `... end` of a page.
"""
import argparse
import collections
import json
import math
import os
import random
import subprocess
import sys
import tempfile
import time

import gmsh

import page_tables

HEAD = ["kind", "parts", "quadrilaterals", "surfaces proved, the part's volume", "largest distance / diagonal", "hexahedra", "refused", "splines proved, the part's volume",
        "largest distance / diagonal", "s"]
CLOSE = 1e-3  # of the volume
PATIENCE = 300


def plate(occ, draw):
    """Plate with holes, some of them with counterbores."""
    x, y, z = draw.uniform(40, 100), draw.uniform(30, 80), draw.uniform(3, 15)
    body = [(3, occ.addBox(0, 0, 0, x, y, z))]
    cutters = []
    columns, rows = draw.randint(1, 3), draw.randint(1, 2)
    for i in range(columns):
        for j in range(rows):
            pitch = min(x / columns, y / rows)
            radius = draw.uniform(0.1, 0.25) * pitch
            place = ((i + 0.5) * x / columns, (j + 0.5) * y / rows)
            cutters.append((3, occ.addCylinder(*place, -1, 0, 0, z + 2, radius)))
            if draw.random() < 0.4:
                cutters.append((3, occ.addCylinder(*place, 0.6 * z, 0, 0, z, 1.5 * radius)))
    occ.cut(body, cutters)


def steps(occ, draw):
    """Block with steps, slots and pockets."""
    x, y, z = (draw.uniform(20, 60) for _ in range(3))
    cutters = []
    for _ in range(draw.randint(1, 3)):
        way = draw.choice(("slot", "step", "pocket"))
        wide, deep = draw.uniform(0.15, 0.35) * x, draw.uniform(0.2, 0.5) * z
        if way == "slot":
            cutters.append((3, occ.addBox(draw.uniform(0.1, 0.5) * x, -1, z - deep, wide, y + 2, deep + 1)))
        elif way == "step":
            cutters.append((3, occ.addBox(-1, -1, z - deep, wide + 1, y + 2, deep + 1)))
        else:
            cutters.append((3, occ.addBox(draw.uniform(0.1, 0.5) * x, 0.3 * y, z - deep, wide, 0.4 * y, deep + 1)))
    occ.cut([(3, occ.addBox(0, 0, 0, x, y, z))], cutters)


def bracket(occ, draw):
    """Angle with a rounded inner edge and holes in both legs."""
    wide, tall, long, thick = (draw.uniform(*span) for span in ((20, 50), (20, 50), (15, 50), (3, 8)))
    radius = draw.uniform(0.5, 1.5) * thick
    points = [(0, 0), (wide, 0), (wide, thick), (thick + radius, thick), (thick, thick + radius), (thick, tall), (0, tall)]
    corners = [occ.addPoint(u, 0, v) for u, v in points]
    middle = occ.addPoint(thick + radius, 0, thick + radius)
    lines = [occ.addCircleArc(corners[i], middle, corners[i + 1]) if i == 3 else occ.addLine(corners[i], corners[(i + 1) % 7]) for i in range(7)]
    body = [d for d in occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))], 0, long, 0) if d[0] == 3]
    hole = 0.2 * min(long, wide - thick - radius, tall - thick - radius)
    cutters = [(3, occ.addCylinder(0.5 * (thick + radius + wide), 0.5 * long, -1, 0, 0, thick + 2, hole))]
    if draw.random() < 0.6:
        cutters.append((3, occ.addCylinder(-1, 0.5 * long, 0.5 * (thick + radius + tall), thick + 2, 0, 0, hole)))
    occ.cut(body, cutters)


def turned(occ, draw):
    """Shaft of several diameters, with chamfers, grooves and a bore."""
    places, at = [], 0.0
    for _ in range(draw.randint(2, 4)):
        at += draw.uniform(8, 25)
        places.append((at, draw.uniform(6, 20)))
    bore = draw.choice((0.0, draw.uniform(1.5, 4)))
    outline = [(bore, 0.0)]
    before = 0.0
    for end, radius in places:
        outline += [(radius, before), (radius, end)]
        before = end
    outline.append((bore, before))
    if draw.random() < 0.5:  # the last edge is chamfered
        u, v = outline[-2]
        outline[-2:-1] = [(u, v - 0.2 * u), (0.8 * u, v)]
    corners = [occ.addPoint(u, 0, v) for u, v in outline]
    face = occ.addPlaneSurface([occ.addCurveLoop([occ.addLine(corners[i], corners[(i + 1) % len(corners)]) for i in range(len(corners))])])
    occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2 * math.pi)


def polygon(occ, draw):
    """Prism over a polygon with one side an arc, with a hole."""
    n = draw.randint(4, 8)
    radii = [draw.uniform(15, 30) for _ in range(n)]
    points = [(r * math.cos(2 * math.pi * i / n), r * math.sin(2 * math.pi * i / n)) for i, r in enumerate(radii)]
    corners = [occ.addPoint(u, v, 0) for u, v in points]
    lines = [occ.addLine(corners[i], corners[(i + 1) % n]) for i in range(1, n)]
    (a, b), (c, d) = points[0], points[1]
    chord = math.hypot(c - a, d - b)
    rise = draw.uniform(0.1, 0.45) * chord
    inward = (0.25 * chord ** 2 - rise ** 2) / (2 * rise)  # of the circle's middle from the chord
    middle = occ.addPoint(0.5 * (a + c) - inward * (d - b) / chord, 0.5 * (b + d) + inward * (c - a) / chord, 0)
    lines.insert(0, occ.addCircleArc(corners[0], middle, corners[1]))
    face = (2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))
    body = [d for d in occ.extrude([face], 0, 0, draw.uniform(5, 30)) if d[0] == 3]
    occ.cut(body, [(3, occ.addCylinder(0, 0, -1, 0, 0, 40, draw.uniform(2, 7)))])


def loft(occ, draw):
    """Through a square, or a circle, and a smaller one that is turned."""
    height, size = draw.uniform(15, 40), draw.uniform(8, 20)
    share, turn = draw.uniform(0.5, 0.9), draw.uniform(0.0, 0.5)
    isRound = draw.random() < 0.5

    def loop(z, a, angle):
        if isRound:
            return occ.addCurveLoop([occ.addEllipse(0.2 * z * share, 0, z, a, 0.8 * a)])
        corners = [occ.addPoint(a * math.sqrt(2) * math.cos(angle + 0.25 * math.pi + 0.5 * math.pi * k), a * math.sqrt(2) * math.sin(angle + 0.25 * math.pi + 0.5 * math.pi * k), z)
                   for k in range(4)]
        return occ.addCurveLoop([occ.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)])

    occ.addThruSections([loop(0, size, 0), loop(height, share * size, turn)], makeSolid=True)


def tee(occ, draw):
    """Two pipes that cross, or one that ends in the other."""
    big, long = draw.uniform(8, 15), draw.uniform(40, 70)
    small, tall = draw.uniform(0.4, 0.8) * big, draw.uniform(25, 40)
    wall = draw.uniform(0.15, 0.3)
    outer = occ.fuse([(3, occ.addCylinder(-0.5 * long, 0, 0, long, 0, 0, big))], [(3, occ.addCylinder(0, 0, 0, 0, 0, tall, small))])[0]
    if draw.random() < 0.7:
        occ.cut(outer, [(3, occ.addCylinder(-0.5 * long - 1, 0, 0, long + 2, 0, 0, (1 - wall) * big)), (3, occ.addCylinder(0, 0, 0, 0, 0, tall + 1, (1 - wall) * small))])


def dome(occ, draw):
    """Sphere, or a part of one, on a block or a cylinder."""
    radius, height = draw.uniform(8, 15), draw.uniform(5, 20)
    if draw.random() < 0.5:
        base = occ.addBox(-1.5 * radius, -1.5 * radius, -height, 3 * radius, 3 * radius, height)
    else:
        base = occ.addCylinder(0, 0, -height, 0, 0, height, draw.choice((1.0, 1.4)) * radius)
    occ.fuse([(3, base)], [(3, occ.addSphere(0, 0, draw.uniform(-0.3, 0.0) * radius, radius))])


def rounded(occ, draw):
    """Block with rounded edges, of one direction or all, and perhaps a bore."""
    x, y, z = (draw.uniform(20, 50) for _ in range(3))
    body = [(3, occ.addBox(0, 0, 0, x, y, z))]
    occ.synchronize()
    edges = [tag for _, tag in gmsh.model.getEntities(1)]
    if draw.random() < 0.6:
        edges = [tag for tag in edges if gmsh.model.getBoundingBox(1, tag)[5] - gmsh.model.getBoundingBox(1, tag)[2] > 0.5 * z]
    body = occ.fillet([body[0][1]], edges, [draw.uniform(0.1, 0.25) * min(x, y, z)])
    if draw.random() < 0.5:
        occ.cut(body, [(3, occ.addCylinder(0.5 * x, 0.5 * y, -1, 0, 0, z + 2, 0.2 * min(x, y)))])


def assembly(occ, draw):
    """Solids that touch in parts of faces and share none: a cylinder or a block on a plate, perhaps one below."""
    x, y, z = draw.uniform(30, 60), draw.uniform(30, 60), draw.uniform(5, 15)
    occ.addBox(0, 0, 0, x, y, z)
    if draw.random() < 0.5:
        occ.addCylinder(0.5 * x, 0.5 * y, z, 0, 0, draw.uniform(10, 30), draw.uniform(0.15, 0.4) * min(x, y))
    else:
        occ.addBox(0.25 * x, 0.3 * y, z, 0.4 * x, 0.35 * y, draw.uniform(10, 30))
    if draw.random() < 0.4:
        occ.addCylinder(0.3 * x, 0.5 * y, -20, 0, 0, 20, draw.uniform(0.1, 0.25) * min(x, y))


def bent(occ, draw):
    """Rod of a round or square section along a quarter of a circle, with straight ends."""
    size, radius, straight = draw.uniform(3, 8), draw.uniform(15, 30), draw.uniform(10, 25)
    face = occ.addDisk(0, 0, 0, size, size) if draw.random() < 0.5 else occ.addRectangle(-size, -size, 0, 2 * size, 2 * size)
    points = [occ.addPoint(*p) for p in ((0, 0, 0), (0, 0, straight), (radius, 0, straight + radius), (radius + straight, 0, straight + radius))]
    middle = occ.addPoint(radius, 0, straight)
    wire = occ.addWire([occ.addLine(points[0], points[1]), occ.addCircleArc(points[1], middle, points[2]), occ.addLine(points[2], points[3])])
    occ.addPipe([(2, face)], wire)
    occ.remove([(2, face)])


def ribs(occ, draw):
    """Plate with ribs across it and bosses on it."""
    x, y, z = draw.uniform(40, 80), draw.uniform(30, 60), draw.uniform(3, 6)
    pieces = [(3, occ.addBox(draw.uniform(0.2, 0.7) * x, 0, z, draw.uniform(2, 4), y, draw.uniform(5, 15)))]
    if draw.random() < 0.6:
        pieces.append((3, occ.addBox(0, draw.uniform(0.3, 0.6) * y, z, x, draw.uniform(2, 4), draw.uniform(5, 15))))
    if draw.random() < 0.5:
        pieces.append((3, occ.addCylinder(0.12 * x, 0.15 * y, z, 0, 0, draw.uniform(4, 10), 0.1 * min(x, y))))
    occ.fuse([(3, occ.addBox(0, 0, 0, x, y, z))], pieces)


def flange(occ, draw):
    """Disc with a hub, a bore and a circle of holes."""
    radius, thick = draw.uniform(25, 45), draw.uniform(5, 10)
    hub, tall = draw.uniform(0.35, 0.5) * radius, draw.uniform(10, 30)
    body = occ.fuse([(3, occ.addCylinder(0, 0, 0, 0, 0, thick, radius))], [(3, occ.addCylinder(0, 0, 0, 0, 0, tall, hub))])[0]
    cutters = [(3, occ.addCylinder(0, 0, -1, 0, 0, tall + 2, draw.uniform(0.4, 0.7) * hub))]
    n = draw.randint(3, 8)
    circle = 0.5 * (hub + radius)
    size = draw.uniform(0.2, 0.35) * min(radius - hub, 2 * math.pi * circle / n)
    for i in range(n):
        cutters.append((3, occ.addCylinder(circle * math.cos(2 * math.pi * i / n), circle * math.sin(2 * math.pi * i / n), -1, 0, 0, thick + 2, size)))
    occ.cut(body, cutters)


def case(occ, draw):
    """Box that is hollow and open above, with an opening in a wall."""
    x, y, z = draw.uniform(30, 70), draw.uniform(30, 60), draw.uniform(15, 40)
    wall = draw.uniform(1.5, 4)
    cutters = [(3, occ.addBox(wall, wall, wall, x - 2 * wall, y - 2 * wall, z))]
    if draw.random() < 0.5:
        cutters.append((3, occ.addCylinder(-1, 0.5 * y, 0.55 * z, wall + 2, 0, 0, 0.2 * min(y, z))))
    else:
        cutters.append((3, occ.addBox(0.3 * x, -1, 0.4 * z, 0.3 * x, wall + 2, 0.3 * z)))
    occ.cut([(3, occ.addBox(0, 0, 0, x, y, z))], cutters)


def gear(occ, draw):
    """Wheel with straight teeth and a bore, perhaps with a keyway."""
    n, root, tip = draw.randint(8, 16), draw.uniform(15, 25), draw.uniform(1.15, 1.3)
    thick, bore = draw.uniform(5, 15), draw.uniform(0.2, 0.4) * root
    points = []
    for i in range(n):
        for share, radius in ((0.0, root), (0.3, root), (0.45, tip * root), (0.85, tip * root)):
            angle = 2 * math.pi * (i + share) / n
            points.append(occ.addPoint(radius * math.cos(angle), radius * math.sin(angle), 0))
    lines = [occ.addLine(points[i], points[(i + 1) % len(points)]) for i in range(len(points))]
    body = [d for d in occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))], 0, 0, thick) if d[0] == 3]
    cutters = [(3, occ.addCylinder(0, 0, -1, 0, 0, thick + 2, bore))]
    if draw.random() < 0.5:
        cutters.append((3, occ.addBox(-0.25 * bore, 0, -1, 0.5 * bore, 1.35 * bore, thick + 2)))
    occ.cut(body, cutters)


def countersunk(occ, draw):
    """Plate with countersunk holes and chamfered corners."""
    x, y, z = draw.uniform(40, 80), draw.uniform(30, 60), draw.uniform(5, 12)
    body = [(3, occ.addBox(0, 0, 0, x, y, z))]
    occ.synchronize()
    edges = [tag for _, tag in gmsh.model.getEntities(1) if gmsh.model.getBoundingBox(1, tag)[5] - gmsh.model.getBoundingBox(1, tag)[2] > 0.5 * z]
    faces = [gmsh.model.getAdjacencies(1, tag)[0][0] for tag in edges]
    size = draw.uniform(0.05, 0.15) * y
    body = occ.chamfer([body[0][1]], edges, faces, [size])
    cutters = []
    for u in (0.3, 0.7):
        radius = draw.uniform(0.05, 0.1) * y
        cutters.append((3, occ.addCylinder(u * x, 0.5 * y, -1, 0, 0, z + 2, radius)))
        cutters.append((3, occ.addCone(u * x, 0.5 * y, z - radius, 0, 0, 1.2 * radius, radius, 2.2 * radius)))
    occ.cut(body, cutters)


def cone(occ, draw):
    """Cone, with its tip or without, on a cylinder, perhaps bored."""
    radius, tall = draw.uniform(8, 20), draw.uniform(10, 30)
    top = draw.choice((0.0, draw.uniform(0.3, 0.7) * radius))
    body = occ.fuse([(3, occ.addCone(0, 0, 0, 0, 0, tall, radius, top))], [(3, occ.addCylinder(0, 0, -10, 0, 0, 10, radius))])[0]
    if top > 0.0 and draw.random() < 0.5:
        occ.cut(body, [(3, occ.addCylinder(0, 0, -11, 0, 0, tall + 12, 0.6 * top))])


def wing(occ, draw):
    """Prism over a closed spline, thick in front and thin behind, perhaps tapered."""
    chord, long, thick = draw.uniform(30, 60), draw.uniform(20, 60), draw.uniform(0.12, 0.3)

    def loop(z, size):
        points = [occ.addPoint(size * u, size * thick * w, z) for u, w in ((1, 0), (0.7, 0.28), (0.4, 0.46), (0.15, 0.42), (0, 0), (0.15, -0.3), (0.4, -0.3), (0.7, -0.15))]
        return occ.addCurveLoop([occ.addSpline(points[:5]), occ.addSpline(points[4:] + points[:1])])

    occ.addThruSections([loop(0, chord), loop(long, draw.choice((1.0, 0.6)) * chord)], makeSolid=True)


def nut(occ, draw):
    """Hexagonal prism with a bore, perhaps with a collar."""
    size, tall = draw.uniform(8, 20), draw.uniform(6, 15)
    corners = [occ.addPoint(size * math.cos(math.pi * i / 3), size * math.sin(math.pi * i / 3), 0) for i in range(6)]
    face = (2, occ.addPlaneSurface([occ.addCurveLoop([occ.addLine(corners[i], corners[(i + 1) % 6]) for i in range(6)])]))
    body = [d for d in occ.extrude([face], 0, 0, tall) if d[0] == 3]
    if draw.random() < 0.5:
        body = occ.fuse(body, [(3, occ.addCylinder(0, 0, 0, 0, 0, 1.3 * tall, 0.75 * size))])[0]
    occ.cut(body, [(3, occ.addCylinder(0, 0, -1, 0, 0, 2 * tall, draw.uniform(0.35, 0.55) * size))])


def wedge(occ, draw):
    """Prism over a triangle with an acute angle, with a hole or a step."""
    wide, tall, long = draw.uniform(30, 60), draw.uniform(10, 30), draw.uniform(10, 40)
    corners = [occ.addPoint(*p) for p in ((0, 0, 0), (wide, 0, 0), (draw.choice((0.0, 0.3)) * wide, 0, tall))]
    face = (2, occ.addPlaneSurface([occ.addCurveLoop([occ.addLine(corners[i], corners[(i + 1) % 3]) for i in range(3)])]))
    body = [d for d in occ.extrude([face], 0, long, 0) if d[0] == 3]
    if draw.random() < 0.5:
        occ.cut(body, [(3, occ.addCylinder(0.3 * wide, -1, 0.3 * tall, 0, long + 2, 0, 0.15 * tall))])
    else:
        occ.cut(body, [(3, occ.addBox(-1, 0.4 * long, -1, 0.4 * wide, long, 0.4 * tall))])


KINDS = (plate, steps, bracket, turned, polygon, loft, tee, dome, rounded, assembly, bent, ribs, flange, case, gear, countersunk, cone, wing, nut, wedge)


def measure(file):
    """Solids of a STEP file, the diagonal of their box, and whether each of their edges has two faces."""
    gmsh.clear()
    gmsh.model.occ.importShapes(file, highestDimOnly=False)
    gmsh.model.occ.synchronize()
    box = gmsh.model.getBoundingBox(-1, -1)
    uses = collections.Counter()
    for face in gmsh.model.occ.getEntities(2):
        uses.update(abs(edge) for _, edge in gmsh.model.getBoundary([face], oriented=False, combined=False))
    return len(gmsh.model.occ.getEntities(3)), math.dist(box[:3], box[3:]), set(uses.values()) <= {1, 2}


def make(kind, seed, file):
    gmsh.clear()
    kind(gmsh.model.occ, random.Random(seed))
    occ = gmsh.model.occ
    occ.synchronize()
    occ.remove([entity for dim in (2, 1, 0) for entity in occ.getEntities(dim)])  # what belongs to no solid
    occ.synchronize()
    sys.stdout.flush()
    kept, silent = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)  # OpenCASCADE says there that it writes
    try:
        gmsh.write(file)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(silent)


class Part:
    """One part and what became of it; words are empty where all is well."""

    def __init__(self, program, folder, kind, seed):
        self.program, self.name, self.stem = program, f"{kind.__name__} {seed}", os.path.join(folder, f"{kind.__name__}_{seed}")
        self.file = self.stem + ".step"
        make(kind, seed, self.file)
        self.solids, self.diagonal, _ = measure(self.file)
        self.volume = self.volume_of(self.file)
        begin = time.monotonic()
        self.quads = self.way("quads", ".vtp")
        self.hexes = self.way("hexes", ".vtu")
        self.seconds = time.monotonic() - begin

    def run(self, *words):
        """The report of a job, or None, and what it says on the standard error."""
        report = self.stem + ".json"
        if os.path.exists(report):
            os.remove(report)
        try:
            done = subprocess.run([self.program, *words, "--force", "--report", report], capture_output=True, text=True, timeout=PATIENCE, check=False)
        except subprocess.TimeoutExpired:
            return None, f"{words[0]} takes more than {PATIENCE} s"
        said = done.stderr.strip().split("\n")[-1]
        if done.returncode not in (0, 5) or not os.path.exists(report):
            return None, said if done.returncode == 1 else f"{words[0]} ends with {done.returncode}: {said}"
        with open(report, encoding="utf-8") as stream:
            return json.load(stream), said

    def volume_of(self, file):
        """By OpenCASCADE, with a tolerance: by default (gmsh's, FreeCAD's) it is off by up to a hundredth on splines of several spans."""
        report, _ = self.run("cadmodify", file, "--suggest", "--maximum-cuts", "0")
        return report["part"]["volume"] if report else math.nan

    def way(self, job, ending):
        """Whether there is a mesh, whether the spline on it comes back as it should, its distance, and what is to be said."""
        mesh, spline = f"{self.stem}_{job}{ending}", f"{self.stem}_{job}.step"
        report, said = self.run(job, self.file, "--output", mesh)
        if not report:
            return False, False, 0.0, said
        report, said = self.run("cadfit", mesh, "--target", self.file, "--degree", "2", "--output", spline)
        if not report:
            return True, False, 0.0, said
        distance = max(report["max_distance"], report["max_distance_back"]) / self.diagonal
        try:
            solids, _, isClosed = measure(spline)
        except Exception as error:  # gmsh has no type of its own
            return True, False, distance, f"{job}: the STEP file is not read: {error}"
        faults = []
        if report["verdict"] != "valid":
            faults.append(f"{report['verdict']}, {report.get('uncertified_elements', '?')} elements not proved")
        if solids != self.solids:
            faults.append(f"{solids} solids of {self.solids}")
        if not isClosed:
            faults.append("edges with more than two faces")
        volume = self.volume_of(spline)
        if not abs(volume - self.volume) <= CLOSE * self.volume:
            faults.append(f"volume {volume:.6g} of {self.volume:.6g}")
        return True, not faults, distance, f"{job}: {', '.join(faults)}" if faults else ""


def table_row(name, parts):
    def cells(job):
        made = [getattr(part, job) for part in parts if getattr(part, job)[0]]
        return len(made), sum(result[1] for result in made), f"{max((result[2] for result in made), default=0.0):.1e}"

    quads, hexes = cells("quads"), cells("hexes")
    return [name, str(len(parts)), str(quads[0]), str(quads[1]), quads[2], str(hexes[0]), str(len(parts) - hexes[0]), str(hexes[1]), hexes[2],
            f"{sum(part.seconds for part in parts):.0f}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--count", type=int, default=4, help="seeds of each kind")
    parser.add_argument("--kinds", default=",".join(kind.__name__ for kind in KINDS))
    parser.add_argument("--keep")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    rows, everything = [], []
    with tempfile.TemporaryDirectory() as folder:
        folder = arguments.keep or folder
        os.makedirs(folder, exist_ok=True)
        for kind in KINDS:
            if kind.__name__ not in arguments.kinds.split(","):
                continue
            parts = []
            for seed in range(arguments.first, arguments.first + arguments.count):
                part = Part(arguments.program, folder, kind, seed)
                for made, good, _, said in (part.quads, part.hexes):
                    if not good:
                        print(f"{part.name}: {said}", file=sys.stderr, flush=True)
                parts.append(part)
            rows.append(table_row(kind.__name__, parts))
            everything += parts
    rows.append(table_row("all", everything))
    text = page_tables.table_text(HEAD, rows)
    print(text)
    if arguments.write:
        page_tables.write_table(arguments.write, "random parts", text)


if __name__ == "__main__":
    main()
