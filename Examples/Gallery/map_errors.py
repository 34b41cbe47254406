# SPDX-License-Identifier: BSD-3-Clause
"""Errors of template maps by iteration: fixed parameters, point and tangent distances, with and without the guard.

1. the plane: a circle in a square is carried onto a skewed flower of five lobes (that of flower.py), 20 iterations from the
   identity: squared error, largest error, and the share of the domain where det J < 0 (sampled at 10^6 points);
2. the initial maps: the same flower far off, after 20 iterations of tangent distances from the identity, from control points
   that are moved by mean displacements, and from the solution of one quadratic problem.

usage: map_errors.py [--output DIR]
"""
import os

import knotwork
import numpy as np

import _cases as cases
import _scene as scene
import flower

ITERATIONS = 20
METHODS = (("fixed", "FIXED", 4), ("PDM", "PDM", 5), ("TDM", "TDM", 2))
STARTS = (("identity", "IDENTITY", 4), ("moved (lumped)", "MOVED", 5), ("quadratic", "QUADRATIC", 2))
AWAY = (1.5, -1.0)


def steps(columns):
    return np.arange(1, len(columns) + 1)


def methods(template, target):
    """Tables of all methods, without the guard and with it."""
    found = {}
    for name, method, _ in METHODS:
        for guard in (False, True):
            mapping = cases.mapped(template, target, Method=getattr(knotwork.vtkTemplateMapping, method), Guard=guard,
                                   Iterations=ITERATIONS)
            found[name, guard] = [cases.column(mapping, column)
                                  for column in ("SquaredL2Error", "MaxError", "NegativeJacobianPercent")]
            squared, largest, negative = (column[-1] for column in found[name, guard])
            print(f"{name}, guard {'on' if guard else 'off'}: squared error {squared:.3e}, largest {largest:.2e}, "
                  f"det J < 0 at {negative:.3f} %")
            cases.require(not guard or max(found[name, guard][2]) == 0.0, "the guard let a map fold")
    return found


def draw_methods(found, file):
    panels = []
    for number, title in enumerate(("squared error", "largest error", "share of det J < 0, percent")):
        series = [(name + (", guard" if guard else ""), steps(found[name, guard][number]), found[name, guard][number],
                   (colour, not guard)) for name, _, colour in METHODS for guard in (False, True)]
        panels.append(cases.plot(series, (560, 460), (number / 3, 0, (number + 1) / 3, 1), ("iteration", title),
                                 log_y=number < 2, legend=number == 1))
    scene.save(panels, file, (1680, 460))


def main():
    folder = scene.output_folder()
    patches, shapes = flower.skeletons()
    template = cases.skeleton(patches)
    draw_methods(methods(template, cases.skeleton(shapes)), os.path.join(folder, "map_errors.png"))

    for shape in shapes:
        shape.points = shape.points + AWAY
    target, series, last = cases.skeleton(shapes), [], {}
    for name, start, colour in STARTS:
        mapping = cases.mapped(template, target, InitialMap=getattr(knotwork.vtkTemplateMapping, start), Iterations=ITERATIONS)
        errors = cases.column(mapping, "SquaredL2Error")
        last[start] = errors[-1]
        print(f"from {name}: squared error {errors[0]:.3e} to {errors[-1]:.3e}")
        series.append((name, steps(errors), errors, (colour, False)))
    cases.require(last["QUADRATIC"] <= last["IDENTITY"], "the quadratic start does not help")
    size = (700, 450)
    scene.save([cases.plot(series, size, (0, 0, 1, 1), ("iteration", "squared error"), legend="middle")],
               os.path.join(folder, "map_starts.png"), size)


if __name__ == "__main__":
    main()
