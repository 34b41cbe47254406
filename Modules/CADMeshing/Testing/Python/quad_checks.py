# SPDX-License-Identifier: BSD-3-Clause
"""Runs of `knotwork quads`, and what must hold of their meshes, counted from the files."""
import collections
import json
import os

import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

def meshed(folder, part, *options):
    done = knotwork_testing.run_program("quads", part, *options, "--output", "quads.vtp", "--report", "quads.json", "--force", folder=folder)
    assert done.returncode == 0, (part, done.stderr)
    with open(os.path.join(folder, "quads.json"), encoding="utf-8") as file:
        report = json.load(file)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(folder, "quads.vtp"))
    reader.Update()
    return report, reader.GetOutput()


def check_solids(report, mesh, euler):
    """Counted here, from the file."""
    quads = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    assert mesh.GetNumberOfPolys() == len(quads) == report["quads"]
    assert len(np.unique(quads)) == mesh.GetNumberOfPoints(), "every point is used"
    sides = np.stack([quads, np.roll(quads, -1, 1)], 2).reshape(-1, 2)
    solids = np.repeat(vtk_to_numpy(mesh.GetCellData().GetArray("SolidId")), 4)
    directed = collections.Counter(map(tuple, np.column_stack([solids, sides])))
    assert max(directed.values()) == 1 and all((s, b, a) in directed for s, a, b in directed), "closed and oriented"
    edges = len(np.unique(np.sort(sides, 1), axis=0))
    assert mesh.GetNumberOfPoints() - edges + len(quads) == report["euler_number"] == euler, report["euler_number"]
    assert report["closed"] and report["least_scaled_jacobian"] > 0.05, report["least_scaled_jacobian"]
    assert vtk_to_numpy(mesh.GetCellData().GetArray("ScaledJacobian")).min() == report["least_scaled_jacobian"]
    assert sum(face["quads"] for face in report["face_table"]) == report["quads"]
