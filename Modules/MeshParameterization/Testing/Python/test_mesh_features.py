# SPDX-License-Identifier: BSD-3-Clause
"""A box with a step and a hole, noisy: its edges, corners and faces; and meshes of machined parts, where they are there."""
import os
import pathlib
import sys

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "Examples/Gallery"))
import _scene as scene  # noqa: E402

# edges, corners and regions as a plain segmentation by angle counts them on the clean meshes
PARTS = {"joint": (22, 12, 10), "cross": (36, 24, 14), "fandisk": (54, 37, 19)}


def prism(outline, n, height):
    """The side of an upright prism on a closed outline in the plane, every edge divided n times, open above and below."""
    corners = np.array(outline, float)
    ring = np.concatenate([a + (b - a) * np.arange(n)[:, None] / n for a, b in zip(corners, np.roll(corners, -1, axis=0))])
    layers = np.linspace(0, height, n + 1)
    points = np.concatenate([np.c_[ring, np.full(len(ring), z)] for z in layers])
    m = len(ring)
    triangles = []
    for k in range(n):
        for i in range(m):
            j = (i + 1) % m
            triangles += [(k * m + i, k * m + j, (k + 1) * m + j), (k * m + i, (k + 1) * m + j, (k + 1) * m + i)]
    return points, np.array(triangles)


def features(mesh, **properties):
    filter = knotwork.vtkMeshFeatures()
    filter.SetInputDataObject(mesh)
    for name, value in properties.items():
        getattr(filter, "Set" + name)(value)
    filter.Update()
    assert filter.GetErrorCode() == 0
    table = filter.GetOutputDataObject(3)
    return filter, {table.GetColumnName(c): table.GetValue(0, c).ToDouble() for c in range(table.GetNumberOfColumns())}


def test_l_shaped_prism_with_noise():
    points, triangles = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 20, 1)
    for seed in range(3):
        noisy = points + np.random.default_rng(seed).normal(0, 0.005, points.shape)
        filter, numbers = features(scene.triangle_mesh(noisy, triangles))
        assert numbers["Regions"] == 6, (seed, numbers)
        lines = filter.GetOutputDataObject(1)
        arrays = {name: vtk_to_numpy(lines.GetCellData().GetArray(name)) for name in ("Rim", "MeanAngle", "Length", "ChainId")}
        creases = arrays["Rim"] == 0
        assert creases.sum() == 6, seed
        assert np.abs(arrays["MeanAngle"][creases] - 90).max() < 5
        assert np.abs(arrays["Length"][creases] - 1).max() < 0.1
        regions = vtk_to_numpy(filter.GetOutputDataObject(0).GetCellData().GetArray("RegionId"))
        sides = (np.arange(len(triangles)) // 2 % 120) // 20
        assert all(len(set(regions[sides == side])) == 1 for side in range(6)), seed


def test_parts_clean_and_noisy():
    if not os.path.exists(scene.ARCHIVE):
        print(f"{scene.ARCHIVE} (libcgal-demo) is missing: left out")
        return
    for name, (lines, corners, regions) in PARTS.items():
        points, triangles = scene.read_off(f"{name}.off")
        found = features(scene.triangle_mesh(points, triangles))[1]
        assert (found["Chains"], found["Corners"], found["Regions"]) == (lines, corners, regions), (name, found)
        diagonal = np.linalg.norm(np.ptp(points, axis=0))
        noisy = points + np.random.default_rng(1).normal(0, 8e-5 * diagonal, points.shape)
        found = features(scene.triangle_mesh(noisy, triangles))[1]
        print(name, found)
        assert found["Regions"] == regions, (name, found)
        assert 0.5 < found["NoiseLevel"] / (8e-5 * diagonal) < 2


knotwork_testing.main(globals())
