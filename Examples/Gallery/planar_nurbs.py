# SPDX-License-Identifier: BSD-3-Clause
"""Planar NURBS by control points and weights: with and without the uniformity term, with fixed and optimized weights.

A quarter annulus with a bump on its inner arc, exact arcs all along; the first map is Coons, ReLU removes its folds, and inner
weights begin at 1: the published method. Four maps coloured by det J over the area.

usage: planar_nurbs.py [--output DIR]
"""
import math
import os

import knotwork
import numpy as np

import _cases as cases
import _scene as scene
from domain_quality import legend, panel
from certified_maps import filled

WIDTH, HEIGHT, OUTER, DEGREE = 0.46, 1.2, 2.92, 3


def at(radius, angle):
    return [radius * math.cos(angle), radius * math.sin(angle)]


def arc(radius, begin, end):
    """Points and weights of an exact arc about the origin without its first point."""
    middle, weight = (begin + end) / 2, math.cos((end - begin) / 2)
    return [(at(radius / weight, middle), weight), (at(radius, end), 1)]


def quadratic(start, *pieces):
    """Quadratic pieces that begin where the one before ends, as one curve."""
    rows = [(list(start), 1)] + [row for piece in pieces for row in piece]
    knots = [0.0] * 3 + [i / len(pieces) for i in range(1, len(pieces)) for _ in range(2)] + [1.0] * 3
    return {"degree": 2, "knots": knots, "control_points": [x for x, _ in rows], "weights": [w for _, w in rows]}


def ray(start, end, degree):
    share = np.linspace(0, 1, degree + 1)[:, None]
    return {"degree": degree, "knots": [0.0] * (degree + 1) + [1.0] * (degree + 1),
            "control_points": (start + share * np.subtract(end, start)).tolist()}


def sector():
    """Inner arc with its bump, outer arc, and the two rays between them."""
    quarter = math.pi / 2
    left, middle, right = (quarter * t for t in (0.48 - WIDTH, 0.48, 0.48 + WIDTH))
    top, half = 1 + HEIGHT, math.sqrt(0.5)
    return [quadratic((1, 0), arc(1, 0, left), [(at(top, left), half), (at(top, middle), 1)],
                      [(at(top, right), half), (at(1, right), 1)], arc(1, right, quarter)),
            quadratic((OUTER, 0), arc(OUTER, 0, quarter)),
            ray((1, 0), (OUTER, 0), DEGREE), ray((0, 1), (0, OUTER), 1)]


def parameter_lines(grid, count=13, samples=200):
    """Images of equally spaced lines of the unit square."""
    along = np.linspace(0, 1, samples)
    lines = []
    for fixed in np.linspace(0, 1, count):
        for column in (0, 1):
            line = np.zeros((samples, 3))
            line[:, column], line[:, 1 - column] = along, fixed
            lines.append(line)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, grid)
    evaluate.SetInputDataObject(1, scene.polylines(lines))
    shown = scene.actor(scene.updated(evaluate).GetOutputDataObject(0), scene.INK, 0.6)
    shown.SetPosition(0, 0, 0.0012)
    return shown


def main():
    folder = scene.output_folder()
    kinds = knotwork.vtkDomainParameterization
    panels, scaled = [], {}
    for row, uniformity in enumerate((0.0, 1.0)):
        for column, (word, weights) in enumerate((("fixed", kinds.WEIGHTS_FIXED), ("optimized", kinds.WEIGHTS_OPTIMIZED))):
            domain = filled(folder, "sector", sector())
            domain.SetInitialWeights(kinds.ONES)
            domain.SetFoldover(kinds.RELU)
            domain.SetWeights(weights)
            domain.SetUniformityWeight(uniformity)
            domain.SetMaximumRefinements(0)
            grid = scene.updated(domain).GetOutputDataObject(0)
            cases.require(cases.certificate(grid) == ("valid", "injective"), "a map is not proved valid and injective")
            data = grid.GetFieldData()
            scaled[uniformity, word] = data.GetArray("MeanScaledJacobian").GetTuple1(0)
            print(f"lambda {uniformity:g}, weights {word}: mean scaled Jacobian {scaled[uniformity, word]:.4f}, "
                  f"mean condition number {data.GetArray('MeanConditionNumber').GetTuple1(0):.4f}")
            area = data.GetArray("Area").GetTuple1(0)
            panels.append(panel(grid, area, f"lambda {uniformity:g}, weights {word}",
                                (0.44 * column, 0.5 * (1 - row), 0.44 * (column + 1), 0.5 * (2 - row))))
            panels[-1].AddActor(parameter_lines(grid))
    scene.save(panels + [legend((0.88, 0, 1, 1))], os.path.join(folder, "planar_nurbs.png"), (1200, 1000))


if __name__ == "__main__":
    main()
