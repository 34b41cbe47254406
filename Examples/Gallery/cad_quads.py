# SPDX-License-Identifier: BSD-3-Clause
"""Quadrilaterals on two parts of Debian's gmsh-doc, component8 and a bracket assembly: faces with four corners as grids, others unstructured.

usage: cad_quads.py [--output DIR]
"""
import gzip
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import _scene as scene

DEMOS = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean"
PARTS = ("component8.step", "as1-tu-203.stp")
COLOURS = ((0.93, 0.71, 0.36), (0.55, 0.75, 0.90))  # unstructured, mapped


def unpack(name, folder):
    source = os.path.join(DEMOS, name + ".gz")
    if not os.path.exists(source):
        scene.leave_out(f"{source} is missing; install the package gmsh-doc")
    target = os.path.join(folder, "cad_quads_" + name)
    with gzip.open(source) as packed, open(target, "wb") as file:
        file.write(packed.read())
    return target


def panel(k, part):
    quads = knotwork.vtkCADQuads()
    quads.SetFileName(part)
    scene.updated(quads)
    mesh, numbers, faces = (quads.GetOutputDataObject(port) for port in range(3))
    mapped = dict(zip(vtk_to_numpy(faces.GetColumnByName("FaceId")), vtk_to_numpy(faces.GetColumnByName("Mapped"))))
    kinds = numpy_to_vtk(np.array([mapped[f] for f in vtk_to_numpy(mesh.GetCellData().GetArray("CADFaceId"))], np.int32), deep=1)
    kinds.SetName("Mapped")
    mesh.GetCellData().AddArray(kinds)
    shown = scene.coloured_cells(mesh, "Mapped", COLOURS)
    shown.GetProperty().EdgeVisibilityOn()
    shown.GetProperty().SetEdgeColor(*scene.INK)
    shown.GetProperty().SetLineWidth(1.0)
    view = scene.renderer([shown], (k / 2, 0, (k + 1) / 2, 1), flat=False)
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (1.0, -1.5, 1.0)))
    camera.SetViewUp(0, 0, 1)
    view.ResetCamera()
    count, least = (numbers.GetValueByName(0, name).ToDouble() for name in ("Quads", "LeastScaledJacobian"))
    text = f"{count:.0f} quadrilaterals, least scaled Jacobian {least:.2f}"
    print(os.path.basename(part), text)
    view.AddViewProp(scene.label(text, 0.04, 0.03, 16))
    return view


def main():
    folder = scene.output_folder()
    views = [panel(k, unpack(name, folder)) for k, name in enumerate(PARTS)]
    scene.save(views, os.path.join(folder, "cad_quads.png"), (1500, 700))


if __name__ == "__main__":
    main()
