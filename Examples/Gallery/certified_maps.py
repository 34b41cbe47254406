# SPDX-License-Identifier: BSD-3-Clause
"""Maps with their certificates: valid, folded and overlapping ones, and a boundary that is filled.

usage: certified_maps.py [--output DIR]
"""
import json
import math
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

import _scene as scene

VERDICTS = {1: (0.00, 0.62, 0.45), 0: (0.90, 0.62, 0.00), -1: (0.80, 0.15, 0.12)}


def tessellated(grid, tolerance=1e-4):
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(grid)
    made.SetChordalTolerance(tolerance)
    return scene.updated(made).GetOutputDataObject(0)


def validated(grid, opacity=1.0):
    """Actors of a planar grid's cells in the colours of their verdicts, with edges and witnesses."""
    validator = knotwork.vtkJacobianValidator()
    validator.SetInputDataObject(grid)
    scene.updated(validator)
    surface = tessellated(validator.GetOutputDataObject(0))
    verdicts = vtk_to_numpy(surface.GetCellData().GetArray("JacobianVerdict"))
    colours = (255 * np.array([VERDICTS[int(v)] for v in verdicts])).round().astype(np.uint8)
    surface.GetCellData().SetScalars(numpy_to_vtk(colours, deep=1))
    faces = scene.actor(surface, scene.INK, opacity=opacity)
    faces.GetMapper().ScalarVisibilityOn()
    faces.GetMapper().SetScalarModeToUseCellData()
    edges = scene.actor(scene.element_edges(grid), scene.INK, 1.2)
    edges.SetPosition(0, 0, 0.001)
    bounds = surface.GetBounds()
    ball = vtkSphereSource()
    ball.SetRadius(0.012 * (bounds[1] - bounds[0]))
    glyphs = vtkGlyph3D()
    glyphs.SetInputDataObject(points_of_witnesses(validator))
    glyphs.SetSourceConnection(ball.GetOutputPort())
    glyphs.SetScaleModeToDataScalingOff()
    glyphs.Update()
    witnesses = scene.actor(glyphs.GetOutput(), (0, 0, 0))
    witnesses.SetPosition(0, 0, 0.002)
    table = validator.GetOutputDataObject(2)
    last = table.GetNumberOfRows() - 1
    return [faces, edges, witnesses], table.GetValueByName(last, "Verdict").ToString(), \
        table.GetValueByName(last, "Injective").ToString()


def points_of_witnesses(validator):
    """Output 1 without the boxes."""
    threshold = vtkThreshold()
    threshold.SetInputDataObject(validator.GetOutputDataObject(1))
    threshold.SetInputArrayToProcess(0, 0, 0, 1, "JacobianUpper")
    threshold.SetThresholdFunction(threshold.THRESHOLD_LOWER)
    threshold.SetLowerThreshold(np.inf)
    vertices = vtkDataSetSurfaceFilter()
    vertices.SetInputConnection(threshold.GetOutputPort())
    vertices.Update()
    result = vertices.GetOutput()
    result.SetPolys(None)
    return result


def curve(points):
    """A cubic B-spline curve, uniform inner knots, with these control points."""
    inner = np.linspace(0, 1, len(points) - 2)[1:-1]
    return {"degree": 3, "knots": [0.0] * 4 + list(inner) + [1.0] * 4, "control_points": np.asarray(points).tolist()}


def line(start, end):
    return {"degree": 1, "knots": [0, 0, 1, 1], "control_points": [start, end]}


def wave(start, end, height, waves, count=15):
    """A curve from start to end whose control polygon swings by height."""
    start, end = np.array(start, float), np.array(end, float)
    along = end - start
    normal = np.array([-along[1], along[0]])
    at = np.linspace(0, 1, count)
    swing = height * np.sin(2 * math.pi * waves * at) * (4 * at * (1 - at)) ** 1.5
    return curve(start + at[:, None] * along + swing[:, None] * normal)


def band(sweep, count=30):
    """Boundary of a band from 0 to `sweep` degrees between the radii 1/2 and 1."""
    angles = np.radians(np.linspace(0, sweep, count))
    circle = np.c_[np.cos(angles), np.sin(angles)]
    inner, outer = 0.5 * circle, circle
    return [curve(inner), curve(outer), line(inner[0].tolist(), outer[0].tolist()),
            line(inner[-1].tolist(), outer[-1].tolist())]


def waves():
    """A boundary with waves on every side."""
    return [wave((0, 0), (1, 0), 0.32, 1.5), wave((0, 1), (1, 1), 0.32, 1.5), wave((0, 0), (0, 1), -0.32, 1.5),
            wave((1, 0), (1, 1), -0.32, 1.5)]


def filled(folder, name, sides, optimizer=0):
    """The domain parameterization of a boundary; output 1 is its Coons map."""
    file = os.path.join(folder, name + ".json")
    with open(file, "w") as stream:
        json.dump({"curves": sides}, stream)
    reader = knotwork.vtkDomainBoundaryReader()
    reader.SetFileName(file)
    domain = knotwork.vtkDomainParameterization()
    domain.SetInputConnection(reader.GetOutputPort())
    domain.SetInitialMap(domain.COONS)
    domain.SetOptimizer(optimizer)
    return scene.updated(domain)


def draw(grids, file, size, titles=None, opacity=1.0):
    """The grids side by side with what the validator says of them."""
    panels = []
    for k, grid in enumerate(grids):
        actors, verdict, injective = validated(grid, opacity)
        panel = scene.renderer(actors, (k / len(grids), 0, (k + 1) / len(grids), 1), 1.15)
        panel.GetActiveCamera().SetWindowCenter(0, -0.08)  # room for the text
        said = f"{verdict}, {injective.replace('_', ' ')}"
        text = scene.label(f"{titles[k]}: {said}" if titles else said, 0.5, 0.02, 18)
        text.GetTextProperty().SetJustificationToCentered()
        panel.AddActor(text)
        panels.append(panel)
    scene.save(panels, file, size)


def main():
    folder = scene.output_folder()
    swinging = filled(folder, "waves", waves())
    if swinging.GetVerdict() != 1:
        raise RuntimeError("the map of the waves is not proved valid")
    once, twice = (filled(folder, name, band(sweep)) for name, sweep in (("band", 280), ("overlap", 420)))
    coons, best = swinging.GetOutputDataObject(1), swinging.GetOutputDataObject(0)
    draw([once.GetOutputDataObject(0), coons, twice.GetOutputDataObject(0)], os.path.join(folder, "certificates.png"),
         (1080, 400), opacity=0.8)
    draw([coons, best], os.path.join(folder, "domains.png"), (1000, 540), ("Coons", "optimized"))


if __name__ == "__main__":
    main()
