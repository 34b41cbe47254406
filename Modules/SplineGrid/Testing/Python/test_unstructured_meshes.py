# SPDX-License-Identifier: BSD-3-Clause
"""Splines on the meshes of a folder that the environment variable KNOTWORK_UNSTRUCTURED_MESHES names (.off, .vtk, .obj, .mesh), to STEP for one."""
import glob
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid


def test_meshes_of_the_folder():
    folder = os.environ.get("KNOTWORK_UNSTRUCTURED_MESHES")
    files = sorted(sum((glob.glob(os.path.join(folder or "", "*" + ending)) for ending in (".off", ".vtk", ".obj", ".mesh")), []))
    files = [file for file in files if "_target" not in file]  # triangles
    if not folder or not files:
        knotwork_testing.skip("KNOTWORK_UNSTRUCTURED_MESHES names no folder of meshes")
    for file in files:
        try:
            mesh = knotwork.read(file)
        except ValueError as refusal:  # faces refer to what is not in the file
            assert "a corner " in str(refusal), (file, refusal)
            continue
        split = file.endswith(".obj")  # with triangles among quadrilaterals
        cells = mesh.GetNumberOfCells()
        for degree in (2, 3):
            made = knotwork.vtkUnstructuredSpline()
            made.SetInputDataObject(mesh)
            made.SetDegree(degree)
            made.SetSplitPolygons(split)
            made.Update()
            output = made.GetOutputDataObject(0)
            assert made.GetErrorCode() == 0 and isinstance(output, vtkUnstructuredGrid), file
            assert (output.GetNumberOfCells() > cells) == split, file
            if file.endswith(".mesh"):  # what closes in the file closes here
                table = made.GetOutputDataObject(1)
                closed = {"klein-bottle": 128, "mobius-strip": 8 * (2 + degree), "toroid-hex": 6 * (1 + degree) ** 2}
                name = os.path.basename(file)[len("mfem_"):-len(".mesh")]
                functions = table.GetValueByName(0, "Functions").ToInt()
                assert functions == closed.get(name, functions), (file, functions)
                assert table.GetValueByName(0, "Orientable").ToInt() == (name in ("star", "toroid-hex")), file
            folded = {"bl_rod_764.off": 7, "cmu_joint_folded.vtk": 37, "cmu_mount1_folded.vtk": 17}
            numbers = {name: made.GetOutputDataObject(1).GetValueByName(0, name).ToInt() for name in ("FoldedCells", "StillFolded")}
            assert numbers["FoldedCells"] == folded.get(os.path.basename(file), numbers["FoldedCells"]), (file, numbers)
            assert numbers["StillFolded"] == 0, (file, numbers)
            if file.endswith("bl_rod_764.off") and degree == 2:
                assert made.GetOutputDataObject(1).GetValueByName(0, "Functions").ToInt() <= 1400
                knotwork.write(output, knotwork_testing.output("rod.step"))
                back = knotwork.read(knotwork_testing.output("rod.step"))
                assert len(np.unique(vtk_to_numpy(back.GetCellData().GetArray("PatchId")))) <= 100


knotwork_testing.main(globals())
