# SPDX-License-Identifier: BSD-3-Clause
"""The main job: a cross-section of a real gear becomes a multi-patch spline parameterization.

1. cut `pinion.off` (from Debian's libcgal-demo) across its axis: a toothed outline around a bore;
2. a template: the ring between two circles with concentric circles in it, and a segmentation of the ring into ten
   patches, one for each tooth;
3. vtkTemplateMapping finds the spline map that carries the circles onto curves that lead from the bore to the outline;
4. vtkSplineWarp sends the ten patches through that map: the parameterization of the gear, gear.vtu;
5. vtkJacobianValidator proves it valid and injective.

usage: gear.py [--output DIR]
"""
import math
import os

import numpy as np
import knotwork
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkCutter, vtkStripper

import _cases as cases
import _scene as scene

TEETH = 10
TEMPLATE_SAMPLES = 2001
TARGET_SAMPLES = 3000
INNER_KNOTS = 80
CIRCLES = 70
# Share of the length of the outline in its parameter, against the angle: length alone bends the lines from bore to
# outline too much, angle alone shears the flanks of the teeth.
LENGTH_SHARE = 0.3


def cross_section(points, triangles):
    """Closed outlines of the section across the axis of a prismatic part, n x 2 each, longest first."""
    corner = points[triangles]
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = np.linalg.norm(normals, axis=1)
    normals /= area[:, None]
    # the side walls' normals are perpendicular to the axis
    _, frame = np.linalg.eigh((area[:, None] * normals).T @ normals)
    axis, first = frame[:, 0], frame[:, 1]
    second = np.cross(axis, first)

    mesh = scene.triangle_mesh(points, triangles)
    plane = vtkPlane()
    plane.SetNormal(*axis)
    plane.SetOrigin(*(0.1 * np.ptp(points @ axis) * axis))
    cutter = vtkCutter()
    cutter.SetCutFunction(plane)
    cutter.SetInputData(mesh)
    strips = vtkStripper()
    strips.SetInputConnection(cutter.GetOutputPort())
    strips.JoinContiguousSegmentsOn()
    strips.SetMaximumLength(100000)
    strips.Update()
    section = strips.GetOutput()
    coordinates = vtk_to_numpy(section.GetPoints().GetData())
    loops = []
    for i in range(section.GetNumberOfCells()):
        ids = section.GetCell(i).GetPointIds()
        loop = coordinates[[ids.GetId(k) for k in range(ids.GetNumberOfIds())]]
        loops.append(np.c_[loop @ first, loop @ second])
    return sorted(loops, key=len, reverse=True)


def resample(loop, count):
    """Angles (increasing by 2 pi), radii and shares of length of a star-shaped closed outline, seam at angle 0 twice."""
    loop = loop[:-1]
    if np.sum(loop[:, 0] * np.roll(loop[:, 1], -1) - loop[:, 1] * np.roll(loop[:, 0], -1)) < 0:
        loop = loop[::-1]
    angle = np.mod(np.arctan2(loop[:, 1], loop[:, 0]), 2 * math.pi)
    loop = loop[np.argsort(angle)]
    # the point of the outline at angle 0, on the side from the last corner to the first
    last, first = loop[-1], loop[0]
    seam = last + (first - last) * last[1] / (last[1] - first[1])
    corners = np.vstack([seam, loop, seam])
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))]
    share = np.linspace(0, 1, count)
    x, y = (np.interp(share * length[-1], length, corners[:, k]) for k in (0, 1))
    angle = np.mod(np.arctan2(y, x), 2 * math.pi)
    angle[0], angle[-1] = 0, 2 * math.pi
    return angle, np.hypot(x, y), share


def skeleton(curves):
    """Polydata with a polyline a curve, PatchId and Parameter; curves are pairs of points and parameters."""
    return cases.skeleton([cases.Patch(number, *curve) for number, curve in enumerate(curves)])


def circle(radius):
    made = cases.circle((0, 0), radius, TEMPLATE_SAMPLES, 0)
    return made.points, made.parameters


def main():
    folder = scene.output_folder()
    outer, bore = cross_section(*scene.read_off("pinion.off"))
    bore_radius = np.linalg.norm(bore, axis=1).mean()
    # the circle that encloses the area of the toothed outline
    area = 0.5 * abs(np.sum(np.cross(outer[:-1], outer[1:])))
    outer_radius = math.sqrt(area / math.pi)

    angle, radius, share = resample(outer, TARGET_SAMPLES)
    parameter = LENGTH_SHARE * share + (1 - LENGTH_SHARE) * angle / (2 * math.pi)

    def between(s):
        """The curve at share s of the way from the bore to the outline, angle and radius blended."""
        at = (1 - s) * 2 * math.pi * parameter + s * angle
        r = bore_radius + s * (radius - bore_radius)
        return np.c_[r * np.cos(at), r * np.sin(at)], parameter

    shares = np.linspace(0, 1, CIRCLES + 1)
    template = skeleton([circle(bore_radius + s * (outer_radius - bore_radius)) for s in shares])
    target = skeleton([between(s) for s in shares])
    cases.write(template, os.path.join(folder, "gear_template.vtp"))
    cases.write(target, os.path.join(folder, "gear_target.vtp"))

    mapping = knotwork.vtkTemplateMapping()
    mapping.SetInputDataObject(0, template)
    mapping.SetInputDataObject(1, target)
    mapping.SetMethod(mapping.FIXED)
    mapping.SetDegree(3)
    mapping.SetInnerKnots(INNER_KNOTS)
    mapping.SetIterations(1)
    mapping.SetTikhonovWeight(1e-3)
    scene.updated(mapping)
    table = mapping.GetOutputDataObject(2)
    last = table.GetNumberOfRows() - 1
    print(f"functions {table.GetValueByName(last, 'Functions').ToInt()}, "
          f"largest distance {table.GetValueByName(last, 'MaxError').ToDouble():.2e} "
          f"(outer radius {radius.max():.3f})")

    ring = knotwork.vtkSplineSource()
    ring.SetShapeName("AnnulusSector")
    ring.SetInnerRadius(bore_radius)
    ring.SetOuterRadius(outer_radius)
    ring.SetAngle(360)
    ring.SetSectors(TEETH)
    ring.SetDegree(3)
    ring.SetElements(8, 16, 1)
    gear = knotwork.vtkSplineWarp()
    gear.SetInputConnection(ring.GetOutputPort())
    gear.SetMapConnection(mapping.GetOutputPort())
    gear.SetTolerance(3e-4)
    scene.updated(gear)
    grid = gear.GetOutputDataObject(0)
    print(f"patches {TEETH}, elements {grid.GetNumberOfCells()}, "
          f"distance to the composition {grid.GetCellData().GetArray('Distance').GetRange()[1]:.1e}")
    cases.write(grid, os.path.join(folder, "gear.vtu"))
    certify(gear)

    half = 1.06 * np.abs(outer).max()
    circles = skeleton([circle(bore_radius), circle(outer_radius)])
    scene.save([view(ring, circles, (0.0, 0, 0.5, 1), half),
                view(gear, skeleton([between(0), between(1)]), (0.5, 0, 1.0, 1), half)],
               os.path.join(folder, "gear.png"), (1200, 600))


def certify(splines):
    """Proves the patches valid and the gear as a whole free of overlaps, or stops."""
    validator = knotwork.vtkJacobianValidator()
    validator.SetInputConnection(splines.GetOutputPort())
    scene.updated(validator)
    table = validator.GetOutputDataObject(2)
    last = table.GetNumberOfRows() - 1
    verdict, injective = (table.GetValueByName(last, name).ToString() for name in ("Verdict", "Injective"))
    print(f"certificate: {verdict}, {injective}, area {table.GetValueByName(last, 'Measure').ToDouble():.12f}")
    if (verdict, injective) != ("valid", "injective"):
        raise RuntimeError("the gear is not proved valid")


def view(splines, outline, viewport, half):
    """Patches in colours, their elements' lines, and the outline that they shall follow."""
    surface = knotwork.vtkSplineTessellate()
    surface.SetInputConnection(splines.GetOutputPort())
    surface.SetChordalTolerance(1e-4)
    scene.updated(surface)
    faces = scene.patches(surface.GetOutputDataObject(0))
    lines = scene.actor(scene.element_edges(splines.GetOutputDataObject(0)), scene.INK, 1.0)
    border = scene.actor(outline, (0.75, 0.1, 0.1), 2.5)
    lines.SetPosition(0, 0, 0.001)
    border.SetPosition(0, 0, 0.002)
    result = scene.renderer([faces, lines, border], viewport)
    result.GetActiveCamera().SetParallelScale(half)
    return result


if __name__ == "__main__":
    main()
