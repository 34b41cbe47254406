#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""A hand-drawn outline with four corners, the curves that are fitted to it, and the map that fills them (hand_drawn.png)."""
import os

import knotwork
import numpy as np

import _scene as scene


def outline():
    """A shaken line around a fin: an arc, a wave, two sides that are nearly straight; closed but for a gap."""
    random = np.random.default_rng(5)
    t = np.linspace(0, 1, 160)[:-1]
    below = np.c_[3 * t, 0.25 * np.sin(7 * t)]
    right = np.c_[3 - 0.5 * t, 0.25 * np.sin(7) + t * (1.9 - 0.25 * np.sin(7))]
    angle = np.pi * (0.25 + 0.5 * t)
    above = np.c_[1.1 + 1.4 * np.cos(angle) / np.cos(np.pi / 4), 0.5 + 1.4 * np.sin(angle) / np.cos(np.pi / 4)]
    left = np.c_[-0.3 + 0.3 * t, 1.9 - 1.9 * t]
    line = np.vstack([below, right, above, left])
    return np.c_[line + random.normal(0, 0.006, line.shape), np.zeros(len(line))]


def main():
    folder = scene.output_folder()
    drawn = scene.polylines([outline()])
    domain = knotwork.vtkDomainParameterization()
    domain.SetInputDataObject(drawn)
    domain.SetOutlineTolerance(0.01)
    scene.updated(domain)
    field = domain.GetOutputDataObject(0).GetFieldData()
    print({name: field.GetArray(name).GetTuple1(0) for name in ("OutlineCorners", "OutlineLines", "OutlineArcs", "OutlineCurves",
                                                                "OutlineDistance")}, field.GetAbstractArray("Verdict").GetValue(0))
    refine = knotwork.vtkSplineRefine()  # more lines of parameters to look at, the map is the same
    refine.SetInputConnection(domain.GetOutputPort())
    refine.SetNumberOfRefinements(2)
    grid = scene.updated(refine).GetOutputDataObject(0)
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputDataObject(grid)
    tessellate.SetChordalTolerance(2e-4)
    surface = scene.updated(tessellate).GetOutputDataObject(0)
    left = [scene.actor(drawn, scene.INK, 1.5)]
    right = [scene.actor(surface, scene.COLOURS[0]), scene.actor(scene.element_edges(grid), scene.INK, 1),
             scene.actor(scene.patch_edges(grid), scene.INK, 3)]
    scene.save([scene.renderer(left, (0, 0, 0.5, 1), 1.25), scene.renderer(right, (0.5, 0, 1, 1), 1.25)],
               os.path.join(folder, "hand_drawn.png"), (1100, 420))


if __name__ == "__main__":
    main()
