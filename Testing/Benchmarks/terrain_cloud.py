#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes a cloud of points of a terrain as LAS (1.2, point format 2): eight octaves of waves with a cliff, noise, and outliers.

usage: terrain_cloud.py POINTS FILE.las [--seed N] [--noise normal|uniform]

The terrain is square, with a point a square metre on average, in strips of one flight after the other: 60 m of heights, a cliff of 20 m,
noise of a standard deviation of SIGMA, normal, or uniform and so never beyond 1.74 SIGMA. One point in a thousand is an outlier, 5 to 50 m off the ground, of classification 7.
Coordinates have millimetres; all is seeded, and the memory does not depend on the number of points.
"""
import argparse
import math
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Harness"))
import las_files  # noqa: E402

SIGMA = 0.05
OUTLIERS = 0.001
ORIGIN = (500000.0, 5400000.0, 0.0)
RECORD = np.dtype([("xyz", "<i4", (3,)), ("intensity", "<u2"), ("returns", "u1"), ("class", "u1"), ("angle", "i1"), ("user", "u1"),
                   ("source", "<u2"), ("rgb", "<u2", (3,))])


def heights(x, y, side):
    """Of the ground. The waves are the same whatever the side: a larger terrain has more of them."""
    z = np.zeros_like(x)
    length, size = 2048.0, 16.0
    for octave in range(8):
        turn = 0.7 + 1.3 * octave
        u, v = x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)
        z += size * np.sin(2 * math.pi * u / length + octave) * np.cos(2 * math.pi * v / length)
        length, size = length / 2, size / 2
    cliff = y - 0.45 * side - 0.05 * side * np.sin(2 * math.pi * x / side)
    return z + 20.0 / (1.0 + np.exp(-np.clip(cliff / 0.5, -50, 50)))


def write(count, file, seed=1, noise="normal", strip=1000000):
    """The number of outliers."""
    side = float(math.ceil(math.sqrt(count)))
    random, outliers = np.random.default_rng(seed), 0
    with open(file, "wb") as stream:
        stream.write(las_files.header(2, 2, count, (*ORIGIN[:2], -100), (ORIGIN[0] + side, ORIGIN[1] + side, 200), offset=ORIGIN))
        for first in range(0, count, strip):
            n = min(strip, count - first)
            x = random.uniform(0, side, n)
            y = random.uniform(side * first / count, side * (first + n) / count, n)
            z = heights(x, y, side)
            z += random.normal(0, SIGMA, n) if noise == "normal" else random.uniform(-SIGMA, SIGMA, n) * math.sqrt(3)
            off = random.random(n) < OUTLIERS
            z[off] += random.choice([-1, 1], off.sum()) * random.uniform(5, 50, off.sum())
            outliers += int(off.sum())
            records = np.zeros(n, RECORD)
            records["xyz"] = np.round(np.c_[x, y, z] / 0.001)
            records["intensity"] = random.integers(0, 2**16, n)
            records["returns"] = 0b001001
            records["class"] = np.where(off, 7, 2)
            records["rgb"] = (np.clip(z[:, None] + 100, 0, 255) * 256).astype("<u2")
            stream.write(records.tobytes())
    return outliers


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("points", type=int)
    parser.add_argument("file")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--noise", choices=("normal", "uniform"), default="normal")
    options = parser.parse_args()
    print(write(options.points, options.file, options.seed, options.noise), "outliers")
