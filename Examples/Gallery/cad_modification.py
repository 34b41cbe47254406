# SPDX-License-Identifier: BSD-3-Clause
"""An assembly before and behind `cadmodify --imprint`, with what its solids share in red, and cut along the faces that `--suggest` names.

The bracket assembly of Debian's gmsh-doc: plate, two brackets, bolts, nuts and a rod.

usage: cad_modification.py [--output DIR]
"""
import gzip
import json
import os
import subprocess

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkPolyDataConnectivityFilter

import _scene as scene

PART = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean/as1-tu-203.stp.gz"
PROGRAM = os.path.join(os.environ["KNOTWORK_BIN_DIR"], "knotwork") if "KNOTWORK_BIN_DIR" in os.environ else "knotwork"
RED = (0.84, 0.20, 0.10)
PALE = (0.80, 0.84, 0.88)
MIDDLE = (90, 75, 0)  # what is moved apart leaves it by these shares
APART = (0.5, 0.0, 1.6)


def modify(part, *arguments):
    """Runs the job; its report."""
    report = os.path.splitext(part)[0] + ".json"
    subprocess.run([PROGRAM, "cadmodify", part, *arguments, "--report", report, "--quiet"], check=True)
    with open(report, encoding="utf-8") as stream:
        return json.load(stream)


def triangles(file):
    """Of the faces, with FaceId."""
    reader = knotwork.vtkCADReader()
    reader.SetFileName(file)
    return scene.updated(reader).GetOutputDataObject(2)


def centres_and_areas(mesh):
    """Of every face."""
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    corners = points[vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    faces = vtk_to_numpy(mesh.GetCellData().GetArray("FaceId")).astype(int)
    total = np.bincount(faces, area)
    middle = np.stack([np.bincount(faces, area * corners.mean(1)[:, d]) for d in range(3)], 1)
    return middle / total[:, None], total, faces


def shared(mesh):
    """Cells of faces that are there twice: equal areas and centres, up to their triangles."""
    centres, areas, faces = centres_and_areas(mesh)
    twice = [np.sum((np.linalg.norm(centres - c, axis=1) < 0.5) & (np.abs(areas - a) < 0.03 * a)) > 1 for c, a in zip(centres, areas)]
    return np.array(twice)[faces]


def twins(mesh):
    return len(np.unique(vtk_to_numpy(mesh.GetCellData().GetArray("FaceId"))[shared(mesh)]))


def apart(mesh):
    """The solids moved away from each other, with SolidId: their triangles share points."""
    clean = vtkCleanPolyData()
    clean.SetInputData(mesh)
    clean.PointMergingOff()
    parts = vtkPolyDataConnectivityFilter()
    parts.SetInputConnection(clean.GetOutputPort())
    parts.SetExtractionModeToAllRegions()
    parts.ColorRegionsOn()
    found = scene.updated(parts).GetOutput()
    ids = vtk_to_numpy(found.GetPointData().GetArray("RegionId"))
    points = vtk_to_numpy(found.GetPoints().GetData())
    for i in np.unique(ids):
        own = ids == i
        lower, upper = points[own].min(0), points[own].max(0)
        points[own] += np.array(APART) * (0.5 * (lower + upper) - MIDDLE)
    first = vtk_to_numpy(found.GetPolys().GetConnectivityArray()).reshape(-1, 3)[:, 0]
    tagged(found, "SolidId", ids[first])
    found.GetPointData().Initialize()
    return found


def tagged(mesh, name, numbers):
    array = numpy_to_vtk(np.asarray(numbers, np.int32), deep=1)
    array.SetName(name)
    mesh.GetCellData().AddArray(array)
    return mesh


def panel(k, of, mesh, name, colours, text):
    view = scene.renderer([scene.coloured_cells(mesh, name, colours)], (k / of, 0, (k + 1) / of, 1))
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (1.0, -1.5, 1.0)))
    camera.SetViewUp(0, 0, 1)
    view.ResetCamera()
    camera.Zoom(1.0)
    view.AddViewProp(scene.label(text, 0.04, 0.03, 15))
    return view


def main():
    if not os.path.exists(PART):
        scene.leave_out(f"{PART} is missing; install the package gmsh-doc")
    folder = scene.output_folder()
    part, whole, pieces = (os.path.join(folder, "cad_modification" + end) for end in (".step", "_imprinted.step", "_cut.step"))
    with gzip.open(PART) as source, open(part, "wb") as target:
        target.write(source.read())
    imprinted = modify(part, "--imprint", "--output", whole)
    print({key: imprinted[key] for key in ("solids", "faces_before", "faces", "shared_faces", "volume_before", "volume")})
    cuts = [one for one in modify(part, "--suggest")["suggestions"] if one["kind"] == "cut-face"]
    print(cuts[0])
    cut = modify(part, "--cut-face", str(cuts[0]["faces"][0]), "--output", pieces)
    print({key: cut[key] for key in ("solids_before", "solids", "faces", "volume_before", "volume")})

    before, after, divided = triangles(part), triangles(whole), triangles(pieces)
    print("faces with a twin: before", twins(before), "after", twins(after))
    pair = ("Shared", (PALE, RED))
    views = [panel(0, 3, apart(tagged(before, "Shared", shared(before))), *pair, f"{imprinted['solids']} solids, {imprinted['faces_before']} faces"),
             panel(1, 3, apart(tagged(after, "Shared", shared(after))), *pair,
                   f"imprinted: {imprinted['faces']} faces, {imprinted['shared_faces']} of them shared"),
             panel(2, 3, apart(divided), "SolidId", scene.COLOURS, f"cut by face {cuts[0]['faces'][0]}: {cut['solids']} solids, {cuts[0]['swept_solids']} swept")]
    scene.save(views, os.path.join(folder, "cad_modification.png"), (1500, 620))


if __name__ == "__main__":
    main()
