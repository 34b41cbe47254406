# SPDX-License-Identifier: BSD-3-Clause
"""Four meshes fitted to exact parts: a plate with round holes (cad_fit_plate.png), bent sheet metal (cad_fit_bracket.png), a brick
with a divot, cut open, before and after elements are mended (cad_fit_divot.png), and a quarter of a disc with a point of three
quadrilaterals (cad_fit_quarter.png).

usage: cad_fit_examples.py [--output DIR]
"""
import os
import tempfile
from math import comb

import _fit_examples as examples
import _scene as scene
import cad_fit
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkThreshold, vtkTubeFilter
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

PAPER = (0.95, 0.93, 0.88)
RED = (0.85, 0.2, 0.15)


def fitted(part, mesh, **properties):
    """The mesh as data, and the filter that has fitted a spline on it to the part."""
    with tempfile.TemporaryDirectory() as folder:
        names = examples.write(folder, "example", part, mesh)
        mesh, target = (knotwork.read(name) for name in names)
    return mesh, cad_fit.fit(mesh, target, **properties)


def text_of(made, column):
    return made.GetOutputDataObject(1).GetValueByName(0, column).ToString()


def element_lines(grid, samples=12):
    """Polylines along the edges of polynomial Bezier cells, each once."""
    points, lines = vtk_to_numpy(grid.GetPoints().GetData()), {}
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        for e in range(cell.GetNumberOfEdges()):
            ids = cell.GetEdge(e).GetPointIds()
            ids = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
            control = points[[ids[0], *ids[2:], ids[1]]]
            p, t = len(ids) - 1, np.linspace(0, 1, samples)[:, None]
            line = sum(comb(p, k) * t**k * (1 - t)**(p - k) * control[k] for k in range(p + 1))
            lines[tuple(np.round(line[samples // 2] + line[samples - 1 - samples // 2], 6))] = line
    return scene.polylines(list(lines.values()))


def surface_of(grid, keep):
    """What can be seen of some of the Bezier cells, and these."""
    marked = grid.NewInstance()
    marked.ShallowCopy(grid)
    mask = scene.numpy_to_vtk(np.asarray(keep, float), deep=1)
    mask.SetName("Keep")
    marked.GetCellData().AddArray(mask)
    shown = vtkThreshold()
    shown.SetInputDataObject(marked)
    shown.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Keep")
    shown.SetThresholdFunction(shown.THRESHOLD_UPPER)
    shown.SetUpperThreshold(0.5)
    grid = scene.updated(shown).GetOutput()
    faces = vtkDataSetSurfaceFilter()
    faces.SetInputDataObject(grid)
    faces.SetNonlinearSubdivisionLevel(4)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(faces.GetOutputPort())
    normals.SetFeatureAngle(25)
    scene.updated(normals)
    return normals.GetOutput(), grid


def lines_of(data, width):
    """Lines that faces do not hide."""
    made = scene.actor(data, scene.INK, line_width=width)
    made.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    made.GetMapper().SetRelativeCoincidentTopologyLineOffsetParameters(0, -8)
    return made


def tubes(data, radius, colour):
    made = vtkTubeFilter()
    made.SetInputDataObject(data)
    made.SetRadius(radius)
    made.SetNumberOfSides(10)
    return scene.actor(scene.updated(made).GetOutputDataObject(0), colour, lighting=True)


def flat(items, k, count, text, zoom=1.3):
    """A panel seen from above."""
    shown = scene.renderer(items, (k / count, 0, (k + 1) / count, 1), zoom)
    shown.AddActor(scene.label(text, 0.04, 0.03, 14))
    return shown


def seen(items, k, count, text, position, focus, zoom=1.15):
    shown = scene.renderer(items, (k / count, 0, (k + 1) / count, 1), 1.0, False)
    camera = shown.GetActiveCamera()
    camera.SetFocalPoint(*focus)
    camera.SetPosition(*position)
    camera.SetViewUp(0, 0, 1)
    shown.ResetCamera()
    camera.Zoom(zoom)
    shown.AddActor(scene.label(text, 0.04, 0.03, 14))
    return shown


def rim_of(made):
    """Points on the curves of the boundary, close together."""
    drawn = knotwork.vtkSplineTessellate()
    drawn.SetInputDataObject(cad_fit.boundary(made.GetOutputDataObject(0)))
    drawn.SetChordalTolerance(1e-6)
    return vtk_to_numpy(scene.updated(drawn).GetOutputDataObject(0).GetPoints().GetData())


def hole_error(made):
    """Largest distance of the rims from their circles, as share of the radius."""
    points, worst = rim_of(made)[:, :2], 0.0
    for place, radius in examples.PLATE.items():
        away = np.linalg.norm(points - 2.0 * np.array(place), axis=1)
        if radius:
            worst = max(worst, np.abs(away[away < 0.9] / radius - 1).max())
    return worst


def plate(folder):
    panels = []
    for k, n in enumerate((2, 4)):
        mesh, made = fitted(examples.plate_part(), examples.plate_mesh(n))
        if k == 0:
            panels.append(flat([cad_fit.edged(mesh, PAPER)], 0, 3, f"{mesh.GetNumberOfCells()} quadrilaterals, {4 * n} edges a hole"))
        spline = made.GetOutputDataObject(0)
        items = [scene.actor(cad_fit.drawn(spline), scene.COLOURS[0]), lines_of(element_lines(spline), 1.5)]
        panels.append(flat(items, k + 1, 3, f"spline, {4 * n} edges a hole: circles right to {hole_error(made):.0e} of the radius"))
    scene.save(panels, os.path.join(folder, "cad_fit_plate.png"), (1500, 350))


def bracket(folder):
    mesh, made = fitted(examples.bracket_part(), examples.bracket_mesh(2))
    spline, corners = made.GetOutputDataObject(0), examples.bracket_corners()
    view, focus = (-3.2, -5.5, 4.6), (2, 2, 0.2)
    bends = scene.polylines(list(corners[1:-1]))
    scene.save([
        seen([cad_fit.edged(mesh, PAPER)], 0, 2, f"{mesh.GetNumberOfCells()} quadrilaterals, {float(text_of(made, 'MeshMaxDistance')):.3f} off", view, focus, 1.15),
        seen([scene.actor(cad_fit.drawn(spline), scene.COLOURS[0], lighting=True), lines_of(element_lines(spline), 1), tubes(bends, 0.015, RED)], 1, 2,
             f"spline, {float(text_of(made, 'MaxDistance')):.0e} off: its creases are the bends (red)", view, focus, 1.15)],
        os.path.join(folder, "cad_fit_bracket.png"), (1200, 450))


def divot(folder):
    """Without the half in front; red: elements whose map is folded."""
    points, cells = examples.divot_mesh(2)
    behind = points[cells].mean(1)[:, 1] > 0
    view, focus = (-1.1, -5.5, 3.4), (0, 1, -0.5)
    mesh = cad_fit.grid_of(points, cells[behind])
    panels = [seen([cad_fit.edged(mesh, PAPER)], 0, 3, f"{len(cells)} hexahedra, cut open", view, focus, 1.4)]
    for k, (smoothing, title) in enumerate((("off", "fitted"), ("certificate", "fitted and mended"))):
        _, made = fitted(examples.divot_part(), (points, cells), Degree=2, Smoothing=smoothing)
        grid = made.GetOutputDataObject(0)
        good = vtk_to_numpy(grid.GetCellData().GetArray("Verdict")) == 1
        items = []
        for keep, colour in ((behind & good, scene.COLOURS[0]), (behind & ~good, RED)):
            if keep.any():
                faces, kept = surface_of(grid, keep)
                items += [scene.actor(faces, colour, lighting=True), lines_of(element_lines(kept), 2)]
        count = len(good) - good.sum()
        panels.append(seen(items, k + 1, 3, f"{title}: {count} of {len(cells)} elements inverted" if count else
                           f"{title}: every element valid, {float(text_of(made, 'RmsDistance')):.4f} off", view, focus, 1.4))
    scene.save(panels, os.path.join(folder, "cad_fit_divot.png"), (1500, 340))


def quarter(folder):
    panels = []
    mesh = None
    for policy in ("full", "minimal"):
        mesh, made = fitted(examples.quarter_part(), examples.quarter_mesh(4), Policy=policy)
        spline = made.GetOutputDataObject(0)
        lines = lines_of(element_lines(spline), 1.5)
        functions = text_of(made, "Functions")
        error = np.abs(np.linalg.norm(points, axis=1) - 1).max() if len(points := arc_of(made)) else np.nan
        surface = scene.actor(cad_fit.drawn(spline), scene.COLOURS[0])
        if policy == "full":
            cuts = knotwork.vtkMeshPatches()
            cuts.SetInputDataObject(mesh)
            tracks = tubes(scene.updated(cuts).GetOutputDataObject(1), 0.008, RED)
            panels.append(flat([cad_fit.edged(mesh, PAPER), tracks], 0, 3, "tracks of the point of three quadrilaterals", 1.12))
            with tempfile.TemporaryDirectory() as place:
                knotwork.write(spline, os.path.join(place, "patches.xml"))
                patches = knotwork.read(os.path.join(place, "patches.xml"))
            shown = scene.patches(cad_fit.drawn(patches))
            structured = flat([shown, lines], 2, 3, f"creased along the tracks: {patch_count(patches)} structured patches,\n{functions} functions, {error:.0e} off the circle", 1.12)
        else:
            panels.append(flat([surface, lines], 1, 3, f"smooth but next to the point: {functions} functions,\n{error:.0e} off the circle", 1.12))
    scene.save(panels + [structured], os.path.join(folder, "cad_fit_quarter.png"), (1200, 470))


def patch_count(patches):
    return len(np.unique(vtk_to_numpy(patches.GetCellData().GetArray("PatchId"))))


def arc_of(made):
    """Points on the rim that are not on the axes."""
    points = rim_of(made)[:, :2]
    return points[points.min(1) > 1e-6]


def main():
    folder = scene.output_folder()
    plate(folder)
    bracket(folder)
    divot(folder)
    quarter(folder)


if __name__ == "__main__":
    main()
