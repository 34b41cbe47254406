# SPDX-License-Identifier: BSD-3-Clause
"""Splines on meshes of quadrilaterals: from files to files, refinement, values that are refused; patches of meshes."""
import json

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter


def cube_text(n, ending):
    """The surface of a cube of n x n quadrilaterals a side, on the unit sphere."""
    numbers, faces = {}, []
    for axis in range(3):
        for end in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    corners = corners if end else corners[::-1]
                    keys = [tuple(np.roll((end, a, b), axis)) for a, b in corners]
                    faces.append([numbers.setdefault(key, len(numbers)) for key in keys])
    points = np.tan((2.0 * np.array(list(numbers)) / n - 1) * np.pi / 4)
    points /= np.linalg.norm(points, axis=1)[:, None]
    if ending == ".off":
        lines = [f"OFF\n{len(points)} {len(faces)} 0", *("%.17g %.17g %.17g" % tuple(p) for p in points),
                 *("4 %d %d %d %d" % tuple(f) for f in faces)]
    else:
        lines = [*("v %.17g %.17g %.17g" % tuple(p) for p in points), *("f %d %d %d %d" % tuple(i + 1 for i in f) for f in faces)]
    return "\n".join(lines) + "\n"


def spline_of(mesh, **properties):
    made = knotwork.vtkUnstructuredSpline()
    made.SetInputDataObject(mesh)
    for name, value in properties.items():
        getattr(made, "Set" + name)(value)
    made.Update()
    return made


def number(made, column):
    return made.GetOutputDataObject(1).GetValueByName(0, column).ToDouble()


def measured(splines, tolerance):
    """Area and volume of the tessellation."""
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputDataObject(splines)
    tessellate.SetChordalTolerance(tolerance)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(tessellate.GetOutputPort())
    mass = vtkMassProperties()
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    return mass.GetSurfaceArea(), mass.GetVolume()


def test_defaults_and_refused_values():
    made = knotwork.vtkUnstructuredSpline()
    assert (made.GetDegree(), made.GetPolicy(), made.GetConstruction(), made.GetLengths()) == (3, 0, 0, 0)
    assert (made.GetFeatureAngle(), made.GetFeatureArray(), made.GetSplitPolygons(), made.GetTangentPlanes()) == (180, None, False, False)
    assert (made.GetUntangle(), made.GetUntangleRings()) == (made.CELLS, 2)
    for name, value in (("Degree", 10), ("Untangle", 3), ("UntangleRings", -1), ("Policy", "none"), ("FeatureAngle", -1)):
        try:
            getattr(made, "Set" + name)(value)
        except ValueError:
            continue
        raise AssertionError(name)
    made.SetPolicy("motorcycle")
    assert made.GetPolicy() == made.MOTORCYCLE


def test_a_sphere_from_every_mesh_file_to_every_spline_file():
    n, volumes = 8, []
    for ending in (".off", ".obj"):
        with open(knotwork_testing.output("sphere" + ending), "w") as file:
            file.write(cube_text(n, ending))
        made = spline_of(knotwork.read(knotwork_testing.output("sphere" + ending)))
        assert number(made, "Functions") == 6 * (n + 2) ** 2 + 2  # of Full: 6 (n + p - 1)^2 + 2
        assert number(made, "MaxNormalAngle") <= 0.06
        tessellate = knotwork.vtkSplineTessellate()
        tessellate.SetInputDataObject(made.GetOutputDataObject(0))
        tessellate.SetChordalTolerance(1e-4)
        tessellate.Update()
        radii = np.linalg.norm(dataset_adapter.WrapDataObject(tessellate.GetOutputDataObject(0)).Points, axis=1)
        assert abs(radii - 1).max() <= 5e-5
        for file in ("sphere.step", "sphere.xml", "sphere.g2"):
            name = knotwork_testing.output(file)
            knotwork.write(made.GetOutputDataObject(0), name)
            back = knotwork.read(name)
            ids = vtk_to_numpy(back.GetCellData().GetArray("PatchId"))
            assert len(np.unique(ids)) == 6 and back.GetNumberOfCells() == 6 * n * n, file
            volumes.append(measured(back, 1e-4)[1])
    # chords of a ten thousandth of the size, 3.5, lose up to that times the area
    assert np.ptp(volumes) <= 1e-6 and abs(volumes[0] - 4 / 3 * np.pi) <= 3.5e-4 * 4 * np.pi, volumes


def test_refinement_keeps_the_map():
    with open(knotwork_testing.output("small.off"), "w") as file:
        file.write(cube_text(2, ".off"))
    made = spline_of(knotwork.read(knotwork_testing.output("small.off")), Degree=2)
    refine = knotwork.vtkSplineRefine()
    refine.SetInputConnection(made.GetOutputPort())
    refine.Update()
    fine = refine.GetOutputDataObject(0)
    assert fine.GetNumberOfCells() == 4 * 24

    coarse, halved = measured(made.GetOutputDataObject(0), 1e-5), measured(fine, 1e-5)
    assert np.allclose(coarse, halved, rtol=1e-4), (coarse, halved)


def test_patches_of_a_mesh_and_their_files():
    with open(knotwork_testing.output("cube.off"), "w") as file:
        file.write(cube_text(3, ".off"))
    run = knotwork_testing.run_program(
        "patches", knotwork_testing.output("cube.off"), "--output", knotwork_testing.output("patches.vtu"), "--cuts",
        knotwork_testing.output("cuts.vtp"), "--report", knotwork_testing.output("patches.json"), "--force")
    assert run.returncode == 0, run.stderr
    with open(knotwork_testing.output("patches.json")) as file:
        report = json.load(file)
    assert [report[key] for key in ("patches", "cells", "cut_facets", "t_joints")] == [6, 54, 36, 0]
    cells = knotwork.read(knotwork_testing.output("patches.vtu")).GetCellData()
    places = np.c_[vtk_to_numpy(cells.GetArray("PatchId")), vtk_to_numpy(cells.GetArray("PatchIndex"))]
    assert len(np.unique(places, axis=0)) == 54 and places.max(0).tolist() == [5, 2, 2, 0]
    patches = knotwork.vtkMeshPatches()
    patches.SetLayout("motorcycle-graph")
    assert patches.GetLayout() == patches.MOTORCYCLE_GRAPH


knotwork_testing.main(globals())
