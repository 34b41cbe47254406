# SPDX-License-Identifier: BSD-3-Clause
"""Quadrilaterals swept to hexahedra: a face of Debian's gmsh-doc part component8 around a bend, and a square as a twisted ring.

usage: sweep.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkColorTransferFunction, vtkDataSetMapper

import _scene as scene
from cad_quads import unpack

ORANGE, WHITE, BLUE = (0.93, 0.55, 0.20), (0.96, 0.94, 0.90), (0.35, 0.62, 0.85)


def data(points, cells, lines=False):
    made, places, ids = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetDataTypeToDouble()
    for point in points:
        places.InsertNextPoint(point)
    for cell in cells:
        ids.InsertNextCell(len(cell), [int(i) for i in cell])
    made.SetPoints(places)
    (made.SetLines if lines else made.SetPolys)(ids)
    return made


def section_of(part):
    """Its largest plane face with a hole: points, cells, and the normal."""
    quads = knotwork.vtkCADQuads()
    quads.SetFileName(part)
    scene.updated(quads)
    mesh = quads.GetOutputDataObject(0)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    cells = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 4)
    faces = vtk_to_numpy(mesh.GetCellData().GetArray("CADFaceId"))
    normals = np.cross(points[cells[:, 2]] - points[cells[:, 0]], points[cells[:, 3]] - points[cells[:, 1]]) / 2
    areas = {}
    for face in np.unique(faces):
        of_face = normals[faces == face]
        area = np.linalg.norm(of_face, axis=1).sum()
        own = cells[faces == face]
        sides = np.unique(np.sort(np.stack([own, np.roll(own, -1, 1)], 2).reshape(-1, 2), 1), axis=0)
        has_hole = len(np.unique(own)) - len(sides) + len(own) == 0
        if has_hole and np.linalg.norm(of_face.sum(0)) > 0.9999 * area:
            areas[face] = area
    best = max(areas, key=areas.get)
    normal = normals[faces == best].sum(0)
    used, renumbered = np.unique(cells[faces == best], return_inverse=True)
    return points[used], renumbered.reshape(-1, 4), normal / np.linalg.norm(normal)


def panel(k, section, path, layers, twist):
    sweep = knotwork.vtkSweepToHexahedra()
    sweep.SetInputDataObject(section)
    sweep.SetPathData(path)
    sweep.SetLayers(layers)
    sweep.SetTwist(twist)
    scene.updated(sweep)
    mesh, numbers = (sweep.GetOutputDataObject(port) for port in range(2))
    mesh.GetCellData().SetActiveScalars("ScaledJacobian")
    colours = vtkColorTransferFunction()
    for value, colour in ((0.0, ORANGE), (0.5, WHITE), (1.0, BLUE)):
        colours.AddRGBPoint(value, *colour)
    mapper = vtkDataSetMapper()
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUseCellData()
    mapper.SetLookupTable(colours)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(*scene.INK)
    view = scene.renderer([actor], (k / 2, 0, (k + 1) / 2, 1), flat=False)
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (0.6, -1.5, 1.1)))
    camera.SetViewUp(0, 0, 1)
    view.ResetCamera()
    count, valid, least = (numbers.GetValueByName(0, name).ToDouble() for name in ("Hexahedra", "ValidCells", "LeastScaledJacobian"))
    text = f"{count:.0f} hexahedra, {valid:.0f} valid, least scaled Jacobian {least:.2f}"
    print(text)
    view.AddViewProp(scene.label(text, 0.04, 0.03, 16))
    return view


def main():
    folder = scene.output_folder()
    points, cells, normal = section_of(unpack("component8.step", folder))
    centre = points.mean(0)
    across = np.cross(normal, (0.0, 0.0, 1.0) if abs(normal[2]) < 0.9 else (0.0, 1.0, 0.0))
    across /= np.linalg.norm(across)
    radius = 1.2 * np.linalg.norm(points - centre, axis=1).max()
    turn = np.linspace(0, np.pi / 2, 81)
    bend = [centre + radius * (np.sin(t) * normal + (1 - np.cos(t)) * across) for t in turn]
    grid = [(3 + x, 0, z) for z in np.linspace(-0.8, 0.8, 5) for x in np.linspace(-0.8, 0.8, 5)]
    squares = [(a, a + 1, a + 6, a + 5) for j in range(4) for a in range(5 * j, 5 * j + 4)]
    ring = [(3 * np.cos(t), 3 * np.sin(t), 0) for t in np.linspace(0, 2 * np.pi, 240, endpoint=False)]
    views = [panel(0, data(points, cells), data(bend, [range(81)], lines=True), 24, 0.0),
             panel(1, data(grid, squares), data(ring, [[*range(240), 0]], lines=True), 60, 360.0)]
    scene.save(views, os.path.join(folder, "sweep.png"), (1500, 700))


if __name__ == "__main__":
    main()
