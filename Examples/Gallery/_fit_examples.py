# SPDX-License-Identifier: BSD-3-Clause
"""Parts with exact geometry and meshes for them: what `cad_fit_examples.py` draws and the tests of CADFitting measure.

A part is a list of rational Bezier patches, arrays of (p + 1) x (q + 1) x 4 homogeneous control points (w x, w y, w z, w), written
as .g2; a mesh is a pair of points and cells, quadrilaterals going round and hexahedra as VTK orders them.
"""
import numpy as np

# Plate of squares with sides of 2: their places in steps of 2, with the radius of the hole in the middle or None.
PLATE = {(0, 0): 0.6, (1, 0): None, (2, 0): 0.45, (0, 1): 0.45, (1, 1): 0.75, (2, 1): None}
# Profile of the bracket across its bends, in x and z, and its length along y on both ends: at x, from 0.15 x to 4 - 0.1 x.
BRACKET = np.array([(0, 0), (1, 0), (1.3, 1.2), (2.7, 1.2), (3, 0), (4, 0)], float)
# Brick [-2, 2]^2 x [-1, 0] with a divot that is part of a sphere: its rim is a circle around the middle of the top.
DIVOT_RIM, DIVOT_DEPTH = 1.1, 0.4
DIVOT_RADIUS = (DIVOT_RIM**2 + DIVOT_DEPTH**2) / (2 * DIVOT_DEPTH)
DIVOT_VOLUME = 16 - np.pi * DIVOT_DEPTH**2 * (DIVOT_RADIUS - DIVOT_DEPTH / 3)


def homogeneous(points, weights=None):
    points = np.asarray(points, float)
    points = np.concatenate([points, np.zeros(points.shape[:-1] + (3 - points.shape[-1],))], -1)
    weights = np.ones(points.shape[:-1]) if weights is None else np.asarray(weights, float)
    return np.concatenate([points * weights[..., None], weights[..., None]], -1)


def arc(middle, radius, first, last):
    """Three control points of an arc around an axis along z, angles in radians."""
    between = (last - first) / 2
    angles = np.array([first, first + between, last])
    weights = np.array([1, np.cos(between), 1])
    return homogeneous(np.asarray(middle)[None] + radius * np.stack([np.cos(angles), np.sin(angles)], -1) / weights[:, None], weights)


def segment(a, b):
    """The same of a line."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return homogeneous([a, (a + b) / 2, b])


def ruled(a, b):
    return np.stack([a, b], 1)


def quad(a, b, c, d):
    """The bilinear patch with four corners, in order round."""
    return homogeneous([[a, d], [b, c]])


def ringed(middle, radius, half):
    """A square with a hole: four patches from arcs to sides."""
    corner = [np.asarray(middle) + half * np.array(c) for c in ((1, -1), (1, 1), (-1, 1), (-1, -1))]
    return [ruled(arc(middle, radius, (2 * k - 1) * np.pi / 4, (2 * k + 1) * np.pi / 4), segment(corner[k], corner[(k + 1) % 4]))
            for k in range(4)]


def plate_part():
    patches = []
    for place, radius in PLATE.items():
        middle = 2.0 * np.array(place)
        if radius:
            patches += ringed(middle, radius, 1.0)
        else:
            patches.append(quad(*(middle + c for c in ((-1, -1), (1, -1), (1, 1), (-1, 1)))))
    return patches


def bracket_ends(x):
    return 0.15 * x, 4 - 0.1 * x


def bracket_corners():
    """6 x 2 x 3 points: the profile on both ends."""
    return np.array([[(x, y, z) for y in bracket_ends(x)] for x, z in BRACKET])


def bracket_part():
    corners = bracket_corners()
    return [quad(corners[k, 0], corners[k + 1, 0], corners[k + 1, 1], corners[k, 1]) for k in range(len(corners) - 1)]


def divot_part():
    """Five plane sides, the top with its hole, and the cap in four patches with a pole; outward."""
    x = [np.array((sx, sy)) for sx, sy in ((-2, -2), (2, -2), (2, 2), (-2, 2))]
    patches = [quad(*(np.append(c, -1) for c in x[::-1]))]
    for k in range(4):
        a, b = x[k], x[(k + 1) % 4]
        patches.append(quad(np.append(a, -1), np.append(b, -1), np.append(b, 0), np.append(a, 0)))
    patches += [side[:, ::-1].transpose(1, 0, 2) for side in ringed((0, 0), DIVOT_RIM, 2.0)]
    # from the pole to the rim in the plane of a radius and z, then around z
    top = DIVOT_RADIUS - DIVOT_DEPTH
    angle = np.arcsin(DIVOT_RIM / DIVOT_RADIUS)
    section = arc((top, 0), DIVOT_RADIUS, np.pi, np.pi - angle)  # z and radius
    for k in range(4):
        around = arc((0, 0), 1, (2 * k - 1) * np.pi / 4, (2 * k + 1) * np.pi / 4)
        patch = np.empty((3, 3, 4))
        for i, (z, radius, _, w) in enumerate(section):
            for j, (c, s, _, v) in enumerate(around):
                patch[i, j] = (radius * c, radius * s, z * v, w * v)
        patches.append(patch)
    return patches


def quarter_part():
    """The quarter of the unit disc: three patches around (0.45, 0.45)."""
    o, a, b, m, half = (0, 0), (0.5, 0), (0, 0.5), (0.45, 0.45), np.pi / 4
    return [quad(o, a, m, b), ruled(segment(a, m), arc((0, 0), 1, 0, half)), ruled(segment(m, b), arc((0, 0), 1, half, 2 * half))]


def g2_text(patches):
    lines = []
    for patch in patches:
        lines.append("200 1 0 0\n3 1")
        for n in patch.shape[:2]:
            lines += [f"{n} {n}", " ".join(["0"] * n + ["1"] * n)]
        lines += [" ".join("%.17g" % value for value in patch[i, j]) for j in range(patch.shape[1]) for i in range(patch.shape[0])]
        lines.append("")
    return "\n".join(lines)


class Cells:
    """Points and cells of blocks, whose points are one where their places are but for rounding."""

    def __init__(self):
        self.numbers, self.points, self.cells = {}, [], []

    def number(self, x):
        x = np.append(x, np.zeros(3 - len(x)))
        key = tuple(np.round(x * 1e8).astype(int))
        if key not in self.numbers:
            self.numbers[key] = len(self.points)
            self.points.append(x)
        return self.numbers[key]

    def add(self, counts, place):
        """A block of counts cells, its points at place(u, v[, w]) with parameters in [0, 1]."""
        round_trip = [(0, 0), (1, 0), (1, 1), (0, 1)]
        corners = round_trip if len(counts) == 2 else [c + (k,) for k in (0, 1) for c in round_trip]
        for cell in np.ndindex(*counts):
            self.cells.append([self.number(place(*((np.array(cell) + c) / counts))) for c in corners])

    def done(self):
        return np.array(self.points), np.array(self.cells)


def between(a, b, t):
    return (1 - t) * np.asarray(a, float) + t * np.asarray(b, float)


def around(middle, radius, half, side, t, s):
    """Place in a square with a hole: t of the way from the circle to the side, s of the way along; equal steps of the angle."""
    angle = (2 * side - 1 + 2 * s) * np.pi / 4
    direction = np.array((np.cos(angle), np.sin(angle)))
    turn = (side * np.pi) / 2
    out, along = np.array((np.cos(turn), np.sin(turn))), np.array((-np.sin(turn), np.cos(turn)))
    return np.asarray(middle) + between(radius * direction, half * (out + (2 * s - 1) * along), t)


def plate_mesh(n):
    """n edges along the sides of the squares, 4 n around the holes."""
    cells = Cells()
    for place, radius in PLATE.items():
        middle = 2.0 * np.array(place)
        if not radius:
            cells.add((n, n), lambda u, v, m=middle: m + (2 * u - 1, 2 * v - 1))
            continue
        for side in range(4):
            cells.add((max(2, n // 2), n), lambda u, v, m=middle, r=radius, k=side: around(m, r, 1.0, k, u, v))
    return cells.done()


def bracket_mesh(n, seed=3):
    """n cells for a length of 1, every point off by 0.02 at most."""
    cells, corners = Cells(), bracket_corners()
    for k in range(len(corners) - 1):
        length = np.linalg.norm(corners[k + 1, 0] - corners[k, 0])
        cells.add((max(2, round(n * length)), 4 * n),
                  lambda u, v, k=k: between(between(corners[k, 0], corners[k + 1, 0], u), between(corners[k, 1], corners[k + 1, 1], u), v))
    points, quads = cells.done()
    return points + 0.02 * np.random.default_rng(seed).uniform(-1, 1, points.shape), quads


def divot_mesh(n, inner=0.55, layer=None):
    """Two layers of n x n cells in every block of the brick's top: a square whose corners are `inner` from the middle of the divot, four
    blocks from there to the rim and four outside. The lower layer is plane; the points of the upper one are pressed down to the divot,
    where little is left of it. With a thickness, the upper layer has it everywhere."""
    cells, side = Cells(), inner / np.sqrt(2)

    def column(place):
        def at(u, v, w):
            x = place(u, v)
            radius = np.linalg.norm(x)
            depth = np.sqrt(DIVOT_RADIUS**2 - radius**2) - (DIVOT_RADIUS - DIVOT_DEPTH) if radius < DIVOT_RIM else 0.0
            middle = -0.5 if layer is None else -depth - layer
            return np.append(x, np.interp(w, (0, 0.5, 1), (-1, middle, -depth)))
        return at

    cells.add((n, n, 2), column(lambda u, v: side * np.array((2 * u - 1, 2 * v - 1))))
    for k in range(4):
        def within(u, v, k=k):
            return between(around((0, 0), 0, side, k, 1, v), around((0, 0), DIVOT_RIM, 2.0, k, 0, v), u)
        cells.add((n, n, 2), column(within))
        cells.add((n, n, 2), column(lambda u, v, k=k: around((0, 0), DIVOT_RIM, 2.0, k, u, v)))
    return cells.done()


def quarter_mesh(n):
    cells, middle, half = Cells(), (0.45, 0.45), np.pi / 4

    def block(a, b, c, d):
        """Between the lines from a to b and from d to c."""
        return lambda u, v: between(between(a, b, u), between(d, c, u), v)

    cells.add((n, n), block((0, 0), (0.5, 0), middle, (0, 0.5)))
    for k, (a, b) in enumerate((((0.5, 0), middle), (middle, (0, 0.5)))):
        cells.add((n, n), lambda u, v, a=a, b=b, k=k: between(between(a, b, v), (np.cos((k + v) * half), np.sin((k + v) * half)), u))
    return cells.done()


def mesh_text(points, cells):
    """OFF of quadrilaterals, VTK's legacy format of hexahedra."""
    places = ["%.17g %.17g %.17g" % tuple(x) for x in points]
    rows = [" ".join(map(str, [len(cell), *cell])) for cell in cells]
    if cells.shape[1] == 4:
        return "\n".join([f"OFF\n{len(points)} {len(cells)} 0", *places, *rows]) + "\n"
    return "\n".join(["# vtk DataFile Version 3.0\nhexahedra\nASCII\nDATASET UNSTRUCTURED_GRID", f"POINTS {len(points)} double", *places,
                      f"CELLS {len(cells)} {9 * len(cells)}", *rows, f"CELL_TYPES {len(cells)}", *["12"] * len(cells)]) + "\n"


def write(folder, name, part, mesh):
    """name.g2 and the mesh next to it; the paths of the mesh and of the part."""
    import os
    paths = [os.path.join(folder, name + (".off" if mesh[1].shape[1] == 4 else ".vtk")), os.path.join(folder, name + ".g2")]
    for path, text in zip(paths, (mesh_text(*mesh), g2_text(part))):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    return paths
