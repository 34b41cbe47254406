# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of the SplineGrid page, one of every filter.

usage: spline_grid.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkSphere
from vtkmodules.vtkFiltersCore import vtkGlyph3D, vtkPolyDataNormals, vtkTubeFilter
from vtkmodules.vtkFiltersExtraction import vtkExtractEdges
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import _scene as scene

LEFT, RIGHT = (0.0, 0.0, 0.5, 1.0), (0.5, 0.0, 1.0, 1.0)


def source(name, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(name)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def refined(splines, center, radius, times, **properties):
    """Refined locally around a ball."""
    ball = vtkSphere()
    ball.SetCenter(*center)
    ball.SetRadius(radius)
    made = knotwork.vtkSplineRefine()
    made.SetInputConnection(splines.GetOutputPort())
    made.SetMode(made.IMPLICIT_FUNCTION)
    made.SetImplicitFunction(ball)
    made.SetNumberOfRefinements(times)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return scene.updated(made)


def tessellated(splines, tolerance, splitting=False):
    made = knotwork.vtkSplineTessellate()
    made.SetSplitting(splitting)
    made.SetInputConnection(splines.GetOutputPort())
    made.SetChordalTolerance(tolerance)
    return scene.updated(made).GetOutputDataObject(0)


def look(panel, direction):
    """Turns the camera to look from a direction, z upward, at everything."""
    camera = panel.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
    camera.SetViewUp(0, 0, 1)
    panel.ResetCamera()


def tubes(lines, radius, by=None, colour=scene.INK):
    """Lines as tubes in one colour, or in colours by a cell array."""
    made = vtkTubeFilter()
    made.SetInputDataObject(lines)
    made.SetRadius(radius)
    made.SetNumberOfSides(12)
    made.Update()
    return scene.patches(made.GetOutput(), by, True) if by else scene.actor(made.GetOutput(), colour, lighting=True)


def balls(points, radius, colour):
    """A ball at every point; the radius times the point's scalar where there is one."""
    ball = vtkSphereSource()
    ball.SetRadius(radius)
    ball.SetThetaResolution(20)
    ball.SetPhiResolution(20)
    made = vtkGlyph3D()
    made.SetInputDataObject(points)
    made.SetSourceConnection(ball.GetOutputPort())
    made.SetScaleModeToScaleByScalar() if points.GetPointData().GetScalars() else made.SetScaleModeToDataScalingOff()
    made.Update()
    return scene.actor(made.GetOutput(), colour, lighting=True)


def plate():
    return refined(source("QuarterPlateWithHole", InnerRadius=0.4, Size=(2, 2, 1), Degree=2, Elements=(4, 4, 1)),
                   (0, 0.4, 0), 0.1, 3)


def shapes(file):
    """Every shape of the source, its patches in colours."""
    count, columns, rows, panels = 18, 6, 3, []
    for shape in range(count):
        made = knotwork.vtkSplineSource()
        made.SetShape(shape)
        name = made.GetShapeName()
        if name in ("CylinderSurface", "TorusSurface", "SolidTube", "SolidTorus", "PolarSphereSurface"):
            made.SetAngle(270)
        if "Plate" in name:
            made.SetInnerRadius(0.25)
        made.SetSectors(3)
        mesh = tessellated(made, 1e-3, True)
        solid = mesh.GetNumberOfPolys() > 0
        item = scene.patches(mesh, lighting=True) if solid else scene.actor(mesh, scene.INK, 3)
        across, down = shape % columns, shape // columns
        panel = scene.renderer([item], (across / columns, 1 - (down + 1) / rows, (across + 1) / columns, 1 - down / rows))
        camera, bounds = panel.GetActiveCamera(), mesh.GetBounds()
        if bounds[5] - bounds[4] > 1e-9:
            look(panel, (1.5, -2.2, 1.6))
        camera.Zoom(0.85 if name == "Line" else 0.95 if name in ("BallSector", "Cube") else 1.1)
        camera.SetWindowCenter(0, -0.12)  # room for the name
        text = scene.label(name, 0.5, 0.01, 14)
        text.GetTextProperty().SetJustificationToCentered()
        panel.AddActor(text)
        panels.append(panel)
    scene.save(panels, file, (1080, 570))


def refinement(file):
    """One disc of five patches: as it is made, refined everywhere, and locally around a point of its rim."""
    disc = source("Disc", Degree=2, Elements=(2, 2, 1))
    everywhere = knotwork.vtkSplineRefine()
    everywhere.SetInputConnection(disc.GetOutputPort())
    locally = refined(disc, (0.75, 0.66, 0), 0.15, 4)
    panels = []
    for k, splines in enumerate((disc, scene.updated(everywhere), locally)):
        faces = scene.patches(tessellated(splines, 1e-4), "Level")
        lines = scene.actor(scene.element_edges(splines.GetOutputDataObject(0)), scene.INK, 1.0)
        lines.SetPosition(0, 0, 0.001)
        panels.append(scene.renderer([faces, lines], (k / 3, 0, (k + 1) / 3, 1), 1.35))
    scene.save(panels, file, (1080, 370))


def extracted(surface, **properties):
    made = knotwork.vtkSplineExtract()
    made.SetInputConnection(surface.GetOutputPort())
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def extraction(file):
    """A surface in parts over boxes of parameters, one of them with its iso-curves."""
    torus = source("TorusSurface", Angle=270, Elements=(4, 4, 1))
    box = (0.2, 0.85, 0.05, 0.45)
    part = extracted(torus, RestrictToBox=True, Box=box)
    items = [scene.actor(tessellated(part, 2e-4), (0.95, 0.75, 0.30), lighting=True)]
    for rest in ((0, box[0], 0, 1), (box[1], 1, 0, 1), (*box[:2], 0, box[2]), (*box[:2], box[3], 1)):
        items.append(scene.actor(tessellated(extracted(torus, RestrictToBox=True, Box=rest), 2e-4), (0.80, 0.84, 0.90),
                                 lighting=True))
    for k, (direction, colour) in enumerate(((part.FIRST, (0.75, 0.1, 0.1)), (part.SECOND, (0.0, 0.3, 0.6)))):
        for value in np.linspace(box[2 * k], box[2 * k + 1], (7, 4)[k]):
            curve = extracted(part, IsoCurve=direction, IsoValue=value)
            items.append(tubes(tessellated(curve, 2e-4), 0.014, colour=colour))
    panel = scene.renderer(items, flat=False)
    look(panel, (1.2, -2.2, 1.9))
    panel.GetActiveCamera().Zoom(1.75)
    scene.save([panel], file, (640, 400))


def control_nets(file):
    """A rational disc of five patches with its net, and the nets of all levels of a refined plate."""
    disc = source("Disc")
    net = knotwork.vtkSplineControlNet()
    net.SetInputConnection(disc.GetOutputPort())
    points = scene.updated(net).GetOutputDataObject(0)
    points.GetPointData().SetActiveScalars("Weight")
    faces = scene.patches(tessellated(disc, 1e-4))
    faces.GetProperty().SetOpacity(0.55)
    faces.SetPosition(0, 0, -0.2)
    left = scene.renderer([faces, tubes(points, 0.008), balls(points, 0.04, (0.75, 0.1, 0.1))], LEFT, 1.35)

    plate_ = plate()
    levels = knotwork.vtkSplineControlNet()
    levels.SetInputConnection(plate_.GetOutputPort())
    levels.VerticesOff()
    right = scene.renderer([tubes(scene.updated(levels).GetOutputDataObject(0), 0.004, "Level")], RIGHT, 1.35)
    scene.save([left, right], file, (1000, 500))


def parametric_mesh(file):
    """Elements of a hierarchical plate in the parameter domain and in the plane, by level."""
    plate_ = plate()
    mesh = knotwork.vtkSplineParametricMesh()
    mesh.SetInputConnection(plate_.GetOutputPort())
    outside = vtkDataSetSurfaceFilter()
    outside.SetInputConnection(mesh.GetOutputPort())
    outside.Update()
    domain = scene.patches(outside.GetOutput(), "Level")
    edges = vtkExtractEdges()
    edges.SetInputConnection(mesh.GetOutputPort())
    edges.Update()
    grid = scene.actor(edges.GetOutput(), scene.INK, 1.0)
    grid.SetPosition(0, 0, 0.001)
    faces = scene.patches(tessellated(plate_, 1e-4), "Level")
    lines = scene.actor(scene.element_edges(plate_.GetOutputDataObject(0)), scene.INK, 1.0)
    lines.SetPosition(0, 0, 0.001)
    scene.save([scene.renderer([domain, grid], (0.0, 0.0, 0.62, 1.0), 1.35),
                scene.renderer([faces, lines], (0.62, 0.0, 1.0, 1.0), 1.3)], file, (1100, 440))


def tessellation(file):
    """A torus refined around one point: coarse cells, finer levels, and the triangles that join them."""
    torus = refined(source("TorusSurface", Angle=360, Elements=(3, 2, 1)), (0.7, 0.7, 0.5), 0.1, 5, Extension=0)
    surface = tessellated(torus, 1.2e-2)
    panels = []
    for viewport, middle, zoom in ((LEFT, (0, 0, 0), 1.6), (RIGHT, (0.7, 0.7, 0.42), 4.5)):
        actor = scene.patches(surface, "Level", True)
        actor.GetProperty().SetInterpolationToFlat()
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(*scene.INK)
        panel = scene.renderer([actor], viewport, flat=False)
        camera = panel.GetActiveCamera()
        camera.SetPosition(3, 3, 5)
        camera.SetViewUp(0, 0, 1)
        panel.ResetCamera()
        camera.SetFocalPoint(*middle)
        camera.Zoom(zoom)
        panel.ResetCameraClippingRange()
        panels.append(panel)
    scene.save(panels, file, (840, 380))


def evaluation(file):
    """Gaussian curvature of a torus from exact second derivatives at the vertices of its tessellation."""
    outer, inner = 1.0, 0.45
    torus = source("TorusSurface", Angle=300, OuterRadius=outer, InnerRadius=inner, Elements=(2, 2, 1))
    surface = tessellated(torus, 3e-4)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputConnection(torus.GetOutputPort())
    evaluate.SetPointsData(surface)
    evaluate.SetMode(evaluate.PROBE)
    evaluate.SetDerivatives(2)
    arrays = scene.updated(evaluate).GetOutputDataObject(0).GetPointData()
    u, v, uu, uv, vv = (vtk_to_numpy(arrays.GetArray("Derivative_" + name)) for name in ("u", "v", "uu", "uv", "vv"))

    def dot(a, b):
        return np.sum(a * b, axis=1)

    normal = np.cross(u, v)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    first = dot(u, u) * dot(v, v) - dot(u, v) ** 2
    curvature = (dot(uu, normal) * dot(vv, normal) - dot(uv, normal) ** 2) / first
    points = vtk_to_numpy(surface.GetPoints().GetData())
    from_axis = np.hypot(points[:, 0], points[:, 1])
    exact = (from_axis - outer) / (inner ** 2 * from_axis)
    print(f"Gaussian curvature of the torus at {len(points)} points: largest error {abs(curvature - exact).max():.1e}")

    drawn = vtkPolyData()
    drawn.ShallowCopy(surface)
    scalars = numpy_to_vtk(curvature, deep=1)
    scalars.SetName("Curvature")
    drawn.GetPointData().SetScalars(scalars)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(257)
    for i in range(257):
        share = abs(i - 128) / 128
        end = np.array((0.13, 0.40, 0.67) if i < 128 else (0.70, 0.09, 0.17))
        table.SetTableValue(i, *(share * end + (1 - share) * np.array((0.97, 0.97, 0.97))), 1)
    largest = abs(exact).max()
    table.SetTableRange(-largest, largest)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(drawn)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    scene.soften(actor)
    actor.GetProperty().SetSpecular(0.15)
    actor.GetProperty().SetSpecularPower(30)
    panel = scene.renderer([actor], flat=False)
    look(panel, (2, -3, 3))
    panel.GetActiveCamera().Zoom(1.35)
    panel.AddActor(scene.label(f"Gaussian curvature from {exact.min():.2f} (blue) to {exact.max():.2f} (red)", 0.02, 0.03,
                               18))
    scene.save([panel], file, (640, 440))


def box_lattice(n, samples):
    """Lines of n cells a side on the faces of the unit cube."""
    along, lines = np.linspace(0, 1, samples), []
    for axis in range(3):
        for other in range(3):
            for end in (0.0, 1.0):
                for at in np.linspace(0, 1, n + 1):
                    if axis != other:
                        line = np.full((samples, 3), at)
                        line[:, axis] = along
                        line[:, other] = end
                        lines.append(line)
    return scene.polylines(lines)


def warp(file):
    """A real mesh in a box, and sent with it through the map of a twisted bar."""
    points, triangles = scene.read_off("elephant.off")
    points = points[:, (0, 2, 1)] * [1, -1, 1]  # upright
    size = np.ptp(points, axis=0)
    parameters = 0.5 + 0.92 * (points - (points.max(axis=0) + points.min(axis=0)) / 2) / size
    panels = []
    for viewport, twist in ((LEFT, 0), (RIGHT, 120)):
        bar = source("TwistedBar", Twist=twist, Size=tuple(size / size.max()))
        actors = []
        for data, draw in ((scene.triangle_mesh(parameters, triangles), body), (box_lattice(3, 40), frame)):
            made = knotwork.vtkSplineWarp()
            made.SetInputDataObject(data)
            made.SetMapConnection(bar.GetOutputPort())
            actors.append(draw(scene.updated(made).GetOutputDataObject(0)))
        panel = scene.renderer(actors, viewport, flat=False)
        look(panel, (2.4, -3, 1.5))
        panels.append(panel)
    scene.save(panels, file, (900, 520))


def body(mesh):
    smooth = vtkPolyDataNormals()
    smooth.SetInputData(mesh)
    smooth.SplittingOff()
    smooth.Update()
    return scene.actor(smooth.GetOutput(), (0.60, 0.67, 0.78), lighting=True)


def frame(lines):
    return scene.actor(lines, (0.0, 0.45, 0.70), 1.2, 0.45)


def main():
    folder = scene.output_folder()
    for name, draw in (("shapes", shapes), ("refinement", refinement), ("extraction", extraction),
                       ("tessellation", tessellation),
                       ("evaluation", evaluation), ("warp", warp), ("control_net", control_nets),
                       ("parametric_mesh", parametric_mesh)):
        draw(os.path.join(folder, name + ".png"))


if __name__ == "__main__":
    main()
