# SPDX-License-Identifier: BSD-3-Clause
"""Local against global refinement: a circle in a square is carried onto a skewed flower of five lobes.

Tangent distance minimization from the bicubic map with 11 inner knots, refined after every iteration: everywhere, or
only where the distance exceeds a threshold. The locally refined maps need less than a tenth of the functions for a
smaller error.

usage: flower.py [--output DIR]
"""
import os

import knotwork
import numpy as np

import _cases as cases
import _scene as scene

LOBES, AMPLITUDE, SKEW = 5, 0.2, 0.35
FLOWER_ID = 4
THRESHOLD = 5e-6


def flower(count):
    """r(a) = 0.25 (1 + 0.2 cos 5a) about (1/2, 1/2), uneven: a / 2 pi = t + 0.35 sin(2 pi t) / 2 pi."""
    share = np.linspace(0, 1, count)
    angle = 2 * np.pi * share + SKEW * np.sin(2 * np.pi * share)
    radius = 0.25 * (1 + AMPLITUDE * np.cos(LOBES * angle))
    slope = -0.25 * AMPLITUDE * LOBES * np.sin(LOBES * angle)
    out, aside = np.c_[np.cos(angle), np.sin(angle)], np.c_[-np.sin(angle), np.cos(angle)]
    normals = radius[:, None] * out - slope[:, None] * aside
    return cases.Patch(FLOWER_ID, 0.5 + radius[:, None] * out, share, normals / np.hypot(*normals.T)[:, None])


def skeletons():
    """Template and target: the sides of the unit square, and a circle and the flower in it."""
    return (cases.box_sides((0, 0), (1, 1), 10001) + [cases.circle((0.5, 0.5), 0.25, 10001, FLOWER_ID)],
            cases.box_sides((0, 0), (1, 1), 200) + [flower(200)])


def run(template, target, **properties):
    mapping = cases.mapped(template, target, RefineEvery=1, **properties)
    functions, error = cases.column(mapping, "Functions"), cases.column(mapping, "SquaredL2Error")
    print(f"{functions[-1]:.0f} functions, squared error {error[-1]:.3e}, certificate "
          + " ".join(cases.certificate(mapping.GetOutputDataObject(0))))
    return mapping, functions, error


def view(mapping, target):
    """The elements of the map and the flower."""
    lines = scene.actor(scene.element_edges(mapping.GetOutputDataObject(0)), (0.45, 0.5, 0.6), 1.0)
    curve = scene.actor(target, scene.COLOURS[5], 2.5)
    curve.SetPosition(0, 0, 0.001)
    return scene.renderer([lines, curve], zoom=1.25)


def main():
    folder = scene.output_folder()
    template, target = (cases.skeleton(s) for s in skeletons())
    cases.write(template, os.path.join(folder, "flower_template.vtp"))
    cases.write(target, os.path.join(folder, "flower_target.vtp"))
    filter = knotwork.vtkTemplateMapping
    everywhere = run(template, target, Refinement=filter.GLOBAL, Iterations=4)
    local = {extension: run(template, target, Refinement=filter.LOCAL, RefineThreshold=THRESHOLD,
                            Extension=extension, Iterations=8) for extension in (1, 2)}
    cases.require(everywhere[1][-1] == 9801, "global refinement ends with another number of functions")
    for mapping, functions, error in local.values():
        cases.require(functions[-1] <= 980 and error[-1] <= 7.3e-11, "local refinement does not hold its numbers")
        cases.require(cases.certificate(mapping.GetOutputDataObject(0)) == ("valid", "injective"),
                      "the map is not proved valid and injective")
    cases.chart([("everywhere", everywhere[1], everywhere[2])] +
                [(f"local, extension {extension}", made[1], made[2]) for extension, made in local.items()],
                os.path.join(folder, "flower_convergence.png"), (760, 520), "functions", "squared error", log_x=True)
    scene.save([view(local[1][0], target)], os.path.join(folder, "flower.png"), (640, 640))


if __name__ == "__main__":
    main()
