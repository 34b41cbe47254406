# SPDX-License-Identifier: BSD-3-Clause
"""Two surveys of a ground on which a heap has grown and a pit was dug: their surfaces and the difference of these (changes.png), the points of
the second one by their distance from the first surface (distances.png).

usage: surveys.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import _scene as scene
import tiles

DOMAIN = (0, 2, 0, 1.4)
NOISE = 0.002
CLASSES = ((0.02, 0.19, 0.58), (0.26, 0.57, 0.78), (0.25, 0.26, 0.28), (0.94, 0.50, 0.35), (0.70, 0.05, 0.12))  # deep below to far above


def survey(seed, changed):
    """Points with noise; the heap and the pit are there when changed."""
    random = np.random.default_rng(seed)
    x, y = random.uniform(size=(2, 20000)) * np.array(((DOMAIN[1],), (DOMAIN[3],)))
    z = 0.5 * tiles.height(x, y) + NOISE * random.normal(size=len(x))
    if changed:
        z += 0.14 * np.exp(-30 * ((x - 0.55) ** 2 + (y - 0.8) ** 2))
        z -= 0.12 * np.exp(-40 * ((x - 1.45) ** 2 + (y - 0.5) ** 2))
    return np.c_[x, y, z]


def surface(points):
    return tiles.fitted(points, DOMAIN, 5 * NOISE)


def fading():
    """From the colour of the lowest class over white to that of the highest."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(129)
    for i in range(129):
        share = abs(i - 64) / 64
        table.SetTableValue(i, *(1 - share * (1 - np.array(CLASSES[0 if i < 64 else -1]))))
    return table


def by_class(points):
    """Points in the colours of their classes."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(CLASSES))
    for i, colour in enumerate(CLASSES):
        table.SetTableValue(i, *colour)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(points)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("DistanceClass")
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(-2.5, 2.5)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetPointSize(3)
    actor.GetProperty().LightingOff()
    return actor


def main():
    folder = scene.output_folder()
    before, after = survey(1, False), survey(2, True)
    old, new = surface(before), surface(after)
    combine = knotwork.vtkSplineCombine()
    combine.SetInputDataObject(0, new)
    combine.SetSecondData(old)
    change = tiles.coloured(tiles.tessellated(scene.updated(combine).GetOutputDataObject(0), 5e-4), 0.12)
    change.SetScale(1, 1, 1)
    change.GetMapper().SetLookupTable(fading())
    change.GetProperty().SetAmbient(0.5)
    change.GetProperty().SetDiffuse(0.5)
    bounds = combine.GetOutputDataObject(1)
    print(*(f"{name} {bounds.GetValueByName(0, name).ToDouble():.4f}" for name in ("MinBound", "MaxBound")))
    scene.save([tiles.panel([tiles.shining(tiles.tessellated(old, 5e-4))], (0, 0, 0.34, 1), "first survey", 1.02),
                tiles.panel([tiles.shining(tiles.tessellated(new, 5e-4))], (0.34, 0, 0.67, 1), "second survey", 1.02),
                tiles.panel([change], (0.67, 0, 1, 1), "the difference", 1.02)], os.path.join(folder, "changes.png"), (1260, 400))

    distance = knotwork.vtkSplinePointDistance()
    distance.SetInputData(tiles.cloud(after[::3]))
    distance.SetSurfaceData(old)
    for tolerance in (5 * NOISE, 0.05):
        distance.AddTolerance(tolerance)
    points = scene.updated(distance).GetOutputDataObject(0)
    numbers = distance.GetOutputDataObject(2)
    print(*(f"{name} {numbers.GetValueByName(0, name).ToString()}" for name in ("Kind", "Min", "Max", "Rms")))
    ground = tiles.shining(tiles.tessellated(old, 5e-4))
    ground.GetProperty().SetOpacity(0.35)
    scene.save([tiles.panel([ground, by_class(points)], (0, 0, 1, 1), "by distance from the first survey", 1.3)],
               os.path.join(folder, "distances.png"), (700, 460))


if __name__ == "__main__":
    main()
