# SPDX-License-Identifier: BSD-3-Clause
"""A volume mapped by a surface inside it: a hyperboloid in the unit cube is carried onto a twisted lobed tube.

1. the target: a tube with three lobes that turn by a third of a turn from the lower face to the upper one, base radius
   0.25 and a waist of 0.8 of it, with exact normals; the template: the hyperboloid of the same radii. Both have
   the six faces of the cube as patches that stay where they are;
2. vtkTemplateMapping: tricubic, 15 inner knots a direction, two series of ten iterations of tangent distances and
   one local refinement between them where the tube is; errors by iteration;
3. the certificate of the whole volume, and a picture.

usage: tube.py [--output DIR]
"""
import os
import time

import knotwork
import numpy as np
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

import _cases as cases
import _scene as scene

RADIUS, WAIST = 0.25, 0.8
LOBES, AMPLITUDE, TWIST = 3, 0.18, 2 * np.pi / 3
INNER_KNOTS = 15
THRESHOLD, EXTENSION = 1e-6, 1
TUBE_ID = 6


def radius(v):
    """Radius of the hyperboloid and its derivative at height v: 0.25 at both ends, 0.8 of it in the middle."""
    square = RADIUS**2 * (WAIST**2 + (1 - WAIST**2) * (2 * v - 1)**2)
    slope = RADIUS**2 * (1 - WAIST**2) * 4 * (2 * v - 1)
    return np.sqrt(square), slope / (2 * np.sqrt(square))


def tube(around, along, amplitude):
    """The tube of radius R(v) (1 + amplitude cos(lobes (a - twist v))) at the angle a = 2 pi u and the height v.

    Amplitude 0 is the hyperboloid. The seam u = 0, 1 has its points twice.
    """
    parameters, triangles = cases.sheet(around, along)
    u, v = parameters.T
    angle = 2 * np.pi * u
    lobes = LOBES * angle - TWIST * LOBES * v
    size, slope = radius(v)
    factor = 1 + amplitude * np.cos(lobes)
    out = np.c_[np.cos(angle), np.sin(angle), np.zeros(len(u))]
    aside = np.c_[-np.sin(angle), np.cos(angle), np.zeros(len(u))]
    r = size * factor
    by_angle = -size * amplitude * LOBES * np.sin(lobes)
    by_height = slope * factor + size * amplitude * LOBES * TWIST * np.sin(lobes)
    tangent = by_angle[:, None] * out + r[:, None] * aside
    up = by_height[:, None] * out + (0, 0, 1)
    normals = np.cross(tangent, up)
    return cases.Patch(TUBE_ID, (0.5, 0.5, 0) + r[:, None] * out + np.outer(v, (0, 0, 1)), parameters,
                       normals / np.linalg.norm(normals, axis=1)[:, None], triangles)


def cube_faces(cells):
    """The six faces of the unit cube as patches 0 to 5: x = 0, x = 1, y = 0, ...; outward normals and triangles."""
    parameters, triangles = cases.sheet(cells, cells)
    faces = []
    for face in range(6):
        axis, side = divmod(face, 2)
        points = np.empty((len(parameters), 3))
        points[:, axis] = side
        points[:, (axis + 1) % 3], points[:, (axis + 2) % 3] = parameters.T
        normal = np.zeros(3)
        normal[axis] = 2 * side - 1
        faces.append(cases.Patch(face, points, parameters, np.tile(normal, (len(points), 1)),
                                 triangles if side else triangles[:, ::-1]))
    return faces


def skeletons():
    """Template and target; 10,449 samples on the tube, 441 on each face of the cube."""
    return cube_faces(40) + [tube(256, 160, 0.0)], cube_faces(20) + [tube(128, 80, AMPLITUDE)]


def slices(grid, heights, count, samples):
    """Curves of the map: planes of the domain at these heights with `count` lines a direction."""
    lines, at, along = [], np.linspace(0, 1, count), np.linspace(0, 1, samples)
    for height in heights:
        for fixed in at:
            for column in (0, 1):
                line = np.full((samples, 3), float(height))
                line[:, column], line[:, 1 - column] = along, fixed
                lines.append(line)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, grid)
    evaluate.SetInputDataObject(1, scene.polylines(lines))
    return scene.updated(evaluate).GetOutputDataObject(0)


def view(surface, lines, viewport):
    result = scene.renderer([scene.actor(surface, scene.COLOURS[1], lighting=True, opacity=0.85),
                             scene.actor(lines, scene.INK, 1.2)], viewport, flat=False)
    camera = result.GetActiveCamera()
    camera.SetPosition(2.4, -2.0, 1.7)
    camera.SetFocalPoint(0.5, 0.5, 0.5)
    camera.SetViewUp(0, 0, 1)
    result.ResetCamera()
    camera.Zoom(0.95)
    return result


def main():
    folder = scene.output_folder()
    patches, shapes = skeletons()
    template, target = cases.skeleton(patches), cases.skeleton(shapes)
    cases.write(template, os.path.join(folder, "tube_template.vtp"))
    cases.write(target, os.path.join(folder, "tube_target.vtp"))
    started = time.perf_counter()
    mapping = cases.mapped(template, target, InnerKnots=INNER_KNOTS, Iterations=20, RefineEvery=10,
                           Refinement=knotwork.vtkTemplateMapping.LOCAL, RefineThreshold=THRESHOLD,
                           Extension=EXTENSION)
    seconds = time.perf_counter() - started
    grid = mapping.GetOutputDataObject(0)
    functions, largest = cases.column(mapping, "Functions"), cases.column(mapping, "MaxError")
    squared = cases.column(mapping, "SquaredL2Error")
    verdict = cases.certificate(grid)
    print(f"{functions[0]:.0f} to {functions[-1]:.0f} functions, squared error {squared[9]:.3e} to {squared[-1]:.3e}, "
          f"largest distance {largest[-1]:.2e}, certificate {' '.join(verdict)}, {seconds:.1f} s")
    steps = np.arange(1, len(squared) + 1)
    cases.chart([("squared error", steps, squared), ("largest distance", steps, largest)],
                os.path.join(folder, "tube_convergence.png"), (700, 450), "iteration", "error")
    cases.require(functions[0] == 6859 and functions[-1] <= 13600, "another number of functions than promised")
    cases.require(verdict == ("valid", "injective"), "the map is not proved valid and injective")

    mapped = mapping.GetOutputDataObject(1)
    ids = vtkThreshold()
    ids.SetInputData(mapped)
    ids.SetInputArrayToProcess(0, 0, 0, 1, "PatchId")
    ids.SetThresholdFunction(vtkThreshold.THRESHOLD_UPPER)
    ids.SetUpperThreshold(TUBE_ID)
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputConnection(ids.GetOutputPort())
    surface.Update()
    heights = (0, 0.5, 1)
    square = [np.c_[line, np.full(2, z)] for z in heights for s in np.linspace(0, 1, 17)
              for line in (np.array([(s, 0), (s, 1)]), np.array([(0, s), (1, s)]))]
    scene.save([view(cases.skeleton(patches[TUBE_ID:]), scene.polylines(square), (0, 0, 0.5, 1)),
                view(surface.GetOutput(), slices(grid, heights, 17, 200), (0.5, 0, 1, 1))],
               os.path.join(folder, "tube.png"), (1200, 700))


if __name__ == "__main__":
    main()
