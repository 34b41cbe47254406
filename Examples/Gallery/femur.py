# SPDX-License-Identifier: BSD-3-Clause
"""A block-structured bar becomes a bone: a closed triangle mesh gets an all-hexahedral multi-patch spline volume.

1. the target: `femur.off` (from Debian's libcgal-demo) in the frame of its principal axes, as two patches: the plane
   where the shaft was cut, and the rest;
2. the template: a bent round bar with one spherical end, made of blocks: a core column, four around it, one on the
   end;
3. vtkTemplateMapping carries the surface of the bar onto the bone: tricubic, locally refined;
4. vtkSplineWarp carries the blocks into the bone, and vtkJacobianValidator proves them valid.

usage: femur.py [--output DIR]
"""
import os

import knotwork
import numpy as np

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersModeling import vtkAdaptiveSubdivisionFilter

import _cases as cases
import _scene as scene

# Axis of the bar: control points (x, y, z) in the frame of the bone's principal axes, and the radius along it. The
# first point lies in the cut, the last one is the centre of the head.
AXIS = np.array([(0.746, -0.078, 0.0), (0.62, -0.05, -0.012), (0.46, -0.02, -0.012), (0.30, 0.022, -0.006),
                 (0.15, 0.055, 0.0), (0.02, 0.085, 0.004), (-0.06, 0.05, 0.004), (-0.117, -0.02, 0.002),
                 (-0.173, -0.0885, 0.0015)])
RADII = np.array([0.064, 0.063, 0.060, 0.058, 0.070, 0.115, 0.095, 0.095, 0.108])
SHAFT_BLOCKS = 5
CORE = 0.38    # half side of the core column in units of the radius
BEYOND = 0.42  # how far the core goes beyond the centre of the spherical end, in units of the radius
PIT = 0.04
EDGE = 0.012  # of the samples of the bone, whose length is about 1
DOMAIN = (-0.36, 0.82, -0.28, 0.28, -0.20, 0.20)  # of the map: a margin around bar and bone
TOLERANCE = 6e-4  # of the volume's patches against the composition
SIDE_ID, CUT_ID = 0, 1


def swept(points):
    """Points of the straight bar on the bent one: x, y in a section of radius 1, z in [0, 1] along, more in the end."""
    along = np.clip(points[:, 2], 0, 1)
    where = cases.basis(len(AXIS), along)
    centre, size = where @ AXIS, where @ RADII
    tangent = cases.basis(len(AXIS), along, 1) @ AXIS
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    second = np.cross(tangent, np.cross((0.0, 0.0, 1.0), tangent))
    second /= np.linalg.norm(second, axis=1)[:, None]
    first = np.cross(second, tangent)
    beyond = np.maximum(points[:, 2] - 1, 0)  # in units of the radius
    return centre + size[:, None] * (points[:, :1] * first + points[:, 1:2] * second + beyond[:, None] * tangent)


def side(quarter, t, height):
    """Core face and outer surface of a side block: t in [-1, 1] around, height in [0, 1] along, to 2 around the end."""
    angle = np.pi / 4 * t
    end = np.clip(height - 1, 0, 1)
    rise = end * np.arctan(np.cos(angle))
    outer = np.c_[np.cos(rise) * np.cos(angle), np.cos(rise) * np.sin(angle), np.minimum(height, 1) + np.sin(rise)]
    core = np.c_[np.full(len(t), CORE), CORE * t, np.minimum(height, 1) + BEYOND * end]
    spin = [(1, 0), (0, 1), (-1, 0), (0, -1)][quarter]
    turn = np.array([(spin[0], -spin[1], 0), (spin[1], spin[0], 0), (0, 0, 1)], float)
    return core @ turn.T, outer @ turn.T


def cap(s, t):
    """Top of the core column and the outer surface of the block on the end, s and t in [-1, 1]."""
    ray = np.c_[np.tan(np.pi / 4 * s), np.tan(np.pi / 4 * t), np.ones(len(s))]
    outer = ray / np.linalg.norm(ray, axis=1)[:, None] + (0, 0, 1)
    return np.c_[CORE * s, CORE * t, np.full(len(s), 1 + BEYOND)], outer


def blocks():
    """Functions of three parameters in [0, 1] onto the blocks of the bent bar, right-handed, and their names."""
    def between(pair, share):
        return swept(pair[0] + share[:, None] * (pair[1] - pair[0]))

    heights = np.r_[np.linspace(0, 1, SHAFT_BLOCKS + 1), 2]
    made = []
    for low, high in zip(heights[:-1], heights[1:]):
        made.append(lambda u, v, w, a=low, b=high: swept(
            np.c_[CORE * (2 * u - 1), CORE * (2 * v - 1),
                  np.minimum(a + w * (b - a), 1) + BEYOND * np.clip(a + w * (b - a) - 1, 0, 1)]))
        for quarter in range(4):
            made.append(lambda u, v, w, a=low, b=high, q=quarter: between(side(q, 2 * v - 1, a + w * (b - a)), u))
    made.append(lambda u, v, w: between(cap(2 * u - 1, 2 * v - 1), w))
    return made


def bar_surface(around, along):
    """Triangles of the bar's outer surface: the side with the spherical end, and the plane end."""
    def square(*counts):
        parameters, triangles = cases.sheet(*counts)
        return (2 * parameters - 1).T, triangles

    def joined(parts, identifier):
        points = np.vstack([p for p, _ in parts])
        firsts = np.cumsum([0] + [len(p) for p, _ in parts])
        triangles = np.vstack([first + t for first, (_, t) in zip(firsts, parts)])
        _, kept, merged = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
        return cases.Patch(identifier, points[kept], triangles=merged.reshape(-1)[triangles])

    outside, plane = [], []
    for quarter in range(4):
        for count, low, high in ((along, 0, 1), (around // 2, 1, 2)):
            (t, h), triangles = square(around, count)
            outside.append((swept(side(quarter, t, low + (h + 1) / 2 * (high - low))[1]), triangles))
        (t, share), triangles = square(around, around)
        core, outer = side(quarter, t, np.zeros(len(t)))
        plane.append((swept(core + (share[:, None] + 1) / 2 * (outer - core)), triangles))
    (s, t), triangles = square(around, around)
    outside.append((swept(cap(s, t)[1]), triangles))
    plane.append((swept(np.c_[CORE * s, CORE * t, np.zeros(len(s))]), triangles[:, ::-1]))
    return joined(outside, SIDE_ID), joined(plane, CUT_ID)


def bone():
    """The bone in the frame of its principal axes: patches without and with the cut plane, edges at most EDGE long.

    Pits and cracks are left out (see in_pits): the bone as a whole is a ball, the mesh has two small tunnels.
    """
    points, triangles = scene.read_off("femur.off")
    centred = points - points.mean(0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    along = centred @ axes.T
    # the cut at positive x, the head at negative y
    axes *= ((1, -1, 1) * np.sign(along.max(0) + along.min(0)))[:, None]
    axes[2] = np.cross(axes[0], axes[1])
    points = centred @ axes.T
    triangles = triangles[~in_pits(points, triangles)]
    centres, normals = centres_and_normals(points, triangles)
    cut = (normals[:, 0] > 0.6) & (centres[:, 0] > 0.715)
    return [refined(points, triangles[~cut], SIDE_ID), refined(points, triangles[cut], CUT_ID)]


def centres_and_normals(points, triangles):
    corner = points[triangles]
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return corner.mean(1), normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]


def in_pits(points, triangles):
    """Whether a triangle sees other parts of the mesh, nearer than PIT, in a third of all directions.

    It then lies in a pit, a crack or a tunnel.
    """
    locate = vtkStaticCellLocator()
    locate.SetDataSet(scene.triangle_mesh(points, triangles))
    locate.BuildLocator()
    t, place, local, part_of, cell = reference(0.0), [0.0] * 3, [0.0] * 3, reference(0), reference(0)
    fan = [(0.0, 0.0)] + [(tilt, turn) for tilt in np.radians((30, 60)) for turn in np.radians(np.arange(0, 360, 60))]
    found = np.zeros(len(triangles), bool)
    for i, (centre, normal) in enumerate(zip(*centres_and_normals(points, triangles))):
        first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
        first /= max(np.linalg.norm(first), 1e-300)
        second = np.cross(normal, first)
        hits = 0
        for tilt, turn in fan:
            way = np.cos(tilt) * normal + np.sin(tilt) * (np.cos(turn) * first + np.sin(turn) * second)
            hits += locate.IntersectWithLine(centre + 1e-5 * normal, centre + PIT * way, 1e-9, t, place, local, part_of,
                                             cell)
        found[i] = 3 * hits > len(fan)
    return found


def refined(points, triangles, identifier):
    """A patch of these triangles, cut until no edge is longer than EDGE; points that no triangle uses are left out."""
    divide = vtkAdaptiveSubdivisionFilter()
    divide.SetInputData(scene.triangle_mesh(points, triangles))
    divide.SetMaximumEdgeLength(EDGE)
    divide.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    mesh = scene.updated(divide).GetOutput()
    used, numbers = np.unique(vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()), return_inverse=True)
    return cases.Patch(identifier, vtk_to_numpy(mesh.GetPoints().GetData())[used], triangles=numbers.reshape(-1, 3))


def skeletons():
    """Template and target."""
    return bar_surface(24, 120), bone()


def view(shown, direction, up, viewport):
    result = scene.renderer(shown, viewport)
    camera = result.GetActiveCamera()
    camera.SetFocalPoint(0.228, 0, 0)
    camera.SetPosition(*(np.array((0.228, 0, 0)) + direction))
    camera.SetViewUp(*up)
    result.ResetCamera()
    camera.SetParallelScale(0.27)
    return result


def coloured(splines):
    surface = knotwork.vtkSplineTessellate()
    surface.SetInputDataObject(splines)
    surface.SetChordalTolerance(5e-4)
    return scene.patches(scene.updated(surface).GetOutputDataObject(0), lighting=True)


def main():
    folder = scene.output_folder()
    bar, shape = skeletons()
    template, target = cases.skeleton(bar), cases.skeleton(shape)
    cases.write(template, os.path.join(folder, "femur_template.vtp"))
    cases.write(target, os.path.join(folder, "femur_target.vtp"))
    mapping = cases.mapped(template, target, UseDomain=True, Domain=DOMAIN, InnerKnots=10, Iterations=6, RefineEvery=3,
                           Refinement=knotwork.vtkTemplateMapping.LOCAL, RefineThreshold=5e-3, Extension=1,
                           UniformityWeight=4e-3)
    grid = mapping.GetOutputDataObject(0)
    functions, largest = cases.column(mapping, "Functions"), cases.column(mapping, "MaxError")
    squared = cases.column(mapping, "SquaredL2Error")
    samples = target.GetNumberOfPoints()
    verdict = cases.certificate(grid)
    print(f"{functions[-1]:.0f} functions, root mean square distance {np.sqrt(squared[-1] / samples):.2e}, largest "
          f"{largest[-1]:.2e}, certificate {' '.join(verdict)}")
    cases.require(verdict == ("valid", "injective"), "the map is not proved valid and injective")
    cases.require(np.sqrt(squared[-1] / samples) < 2.5e-3 and largest[-1] < 0.02, "the bone is missed")

    straight = cases.interpolated(os.path.join(folder, "femur_bar.g2"), blocks(), (8, 8, 8))
    warp = knotwork.vtkSplineWarp()
    warp.SetInputDataObject(0, straight)
    warp.SetInputDataObject(1, grid)
    warp.SetTolerance(TOLERANCE)
    volume = scene.updated(warp).GetOutputDataObject(0)
    verdict = cases.certificate(volume)
    print(f"{len(blocks())} patches, {volume.GetNumberOfCells()} elements, distance to the composition "
          f"{volume.GetCellData().GetArray('Distance').GetRange()[1]:.1e}, certificate {' '.join(verdict)}")
    cases.require(verdict == ("valid", "injective"), "the volume is not proved valid and injective")
    cases.write(volume, os.path.join(folder, "femur.vtu"))

    mesh = scene.actor(target, (0.85, 0.80, 0.70), lighting=True)
    views = (((0, 0, 1), (0, 1, 0)), ((0, 1, 0), (0, 0, 1)))
    rows = (coloured(straight), mesh, coloured(volume))
    scene.save([view([item], *views[x], (x / 2, 1 - (y + 1) / 3, (x + 1) / 2, 1 - y / 3))
                for y, item in enumerate(rows) for x in (0, 1)], os.path.join(folder, "femur.png"), (1300, 900))


if __name__ == "__main__":
    main()
