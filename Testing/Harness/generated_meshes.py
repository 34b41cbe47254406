# SPDX-License-Identifier: BSD-3-Clause
"""Triangle meshes from formulas, as OFF files; beside those of developable surfaces their true flattening, a point a line
(.uv). Seeded: the same files every time."""
import os

import numpy as np


def grid_mesh(low, high, edge, inside, seed):
    """Points of a jittered grid in the plane, and its triangles whose centres lie inside."""
    count = np.ceil((np.array(high) - low) / edge).astype(int)
    x, y = np.meshgrid(*(np.linspace(low[k], high[k], count[k] + 1) for k in (0, 1)))
    points = np.c_[x.ravel(), y.ravel()]
    points += np.random.default_rng(seed).uniform(-0.25, 0.25, points.shape) * edge
    i, j = (index.ravel() for index in np.meshgrid(np.arange(count[0]), np.arange(count[1])))
    a = j * (count[0] + 1) + i
    b = a + count[0] + 1
    triangles = np.r_[np.c_[a, a + 1, b + 1], np.c_[a, b + 1, b]]
    triangles = triangles[inside(*points[triangles].mean(axis=1).T)]
    used, corners = np.unique(triangles, return_inverse=True)
    return points[used], corners.reshape(-1, 3)


def write(path, points, triangles, flat=None):
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        np.savetxt(file, points, fmt="%.17g")
        np.savetxt(file, np.c_[np.full(len(triangles), 3), triangles], fmt="%d")
    if flat is not None:
        np.savetxt(os.path.splitext(path)[0] + ".uv", flat, fmt="%.17g")


def s_on_cone(path, edge=0.055):
    """A stroke in the shape of an S, of two arcs of three quarters, isometrically on a cone."""
    def inside(x, y):
        lower = (np.abs(np.hypot(x, y - 4) - 1) < 0.35) & ~((x < 0) & (y > 4))
        upper = (np.abs(np.hypot(x, y - 6) - 1) < 0.35) & ~((x > 0) & (y < 6))
        return lower | upper
    flat, triangles = grid_mesh((-1.4, 2.6), (1.4, 7.4), edge, inside, 1)
    radius, angle = np.hypot(*flat.T), np.arctan2(flat[:, 0], flat[:, 1])
    slope = 0.4  # sine of half of the cone's opening
    turn = angle / slope
    write(path, np.c_[slope * radius * np.cos(turn), slope * radius * np.sin(turn), np.sqrt(1 - slope**2) * radius],
          triangles, flat)


def roll_with_hole(path, edge=0.24, turns=2.0):
    """A rectangle with a rectangular hole, rolled up on a spiral of Archimedes."""
    angle = np.linspace(np.pi, (1 + 2 * turns) * np.pi, 200001)
    length = 0.5 * (angle * np.sqrt(1 + angle**2) + np.arcsinh(angle))  # of r = angle
    width = 0.4 * (length[-1] - length[0])

    def inside(x, y):
        return ~((np.abs(x - 1.2 * width) < 0.5 * width) & (np.abs(y - 0.15 * width) < 0.06 * width))
    flat, triangles = grid_mesh((0, 0), (length[-1] - length[0], 0.3 * width), edge * 2, inside, 2)
    at = np.interp(flat[:, 0] + length[0], length, angle)
    write(path, np.c_[at * np.cos(at), at * np.sin(at), flat[:, 1]], triangles, flat)


def mask(path, edge=0.035):
    """A face like a height field, without two eyes and a mouth."""
    def inside(x, y):
        eyes = np.minimum(np.hypot((x - 0.4) / 0.2, (y - 0.35) / 0.12), np.hypot((x + 0.4) / 0.2, (y - 0.35) / 0.12))
        mouth = np.hypot(x / 0.35, (y + 0.5) / 0.1)
        return (np.hypot(x / 0.95, y / 1.15) < 1) & (eyes > 1) & (mouth > 1)
    flat, triangles = grid_mesh((-1, -1.2), (1, 1.2), edge, inside, 3)
    x, y = flat.T
    height = 0.5 * np.sqrt(np.maximum(1.6 - x**2 - 0.6 * y**2, 0)) + 0.18 * np.exp(-(x / 0.13)**2 - (y / 0.28)**2)
    write(path, np.c_[flat, height], triangles)
