# SPDX-License-Identifier: BSD-3-Clause
"""A rolled plate with a hole through vtkMeshParameterization and `knotwork flatten`: the flat plate comes back; bad meshes
are refused with the reason."""
import json

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_PIXEL, VTK_POLYGON, VTK_QUAD, VTK_TETRA, VTK_TRIANGLE, VTK_TRIANGLE_STRIP, vtkCellArray,
                                           vtkPolyData, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter


def plate(n=40):
    """Points of a rectangle with a square hole, and its triangles."""
    x, y = np.meshgrid(np.linspace(0, 2, 2 * n + 1), np.linspace(0, 1, n + 1))
    grid = np.c_[x.ravel(), y.ravel()]
    triangles = []
    for j in range(n):
        for i in range(2 * n):
            if abs(i + 0.5 - 0.5 * n) < 0.2 * n and abs(j + 0.5 - 0.5 * n) < 0.2 * n:
                continue
            a = j * (2 * n + 1) + i
            b = a + 2 * n + 1
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    used, cells = np.unique(triangles, return_inverse=True)
    return grid[used], cells.reshape(-1, 3)


def polydata(points, triangles):
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells = vtkCellArray()
    for triangle in triangles:
        cells.InsertNextCell(len(triangle), [int(i) for i in triangle])
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    return mesh


FLAT, TRIANGLES = plate()
ROLLED = np.c_[0.5 * np.cos(2 * FLAT[:, 0]), 0.5 * np.sin(2 * FLAT[:, 0]), FLAT[:, 1]]


def rolled():
    mesh = polydata(ROLLED, TRIANGLES)
    height = numpy_to_vtk(FLAT[:, 1].copy(), deep=1)
    height.SetName("Height")
    mesh.GetPointData().AddArray(height)
    number = numpy_to_vtk(np.arange(len(TRIANGLES)), deep=1)
    number.SetName("Number")
    mesh.GetCellData().AddArray(number)
    return mesh


def rigid_error(uv, truth):
    """Root mean square distance after the best rotation or reflection, over the diagonal."""
    a, b = uv - uv.mean(0), truth - truth.mean(0)
    u, _, v = np.linalg.svd(a.T @ b)
    return np.sqrt(((a @ u @ v - b) ** 2).sum(1).mean()) / np.linalg.norm(np.ptp(truth, axis=0))


def flatten(mesh, **options):
    parameterization = knotwork.vtkMeshParameterization()
    parameterization.SetInputDataObject(mesh)
    for name, value in options.items():
        getattr(parameterization, "Set" + name)(value)
    parameterization.Update()
    return parameterization


def error_of(mesh, **options):
    """The filter's error code, 0: none. On an error there is one message and the outputs are empty."""
    parameterization = knotwork.vtkMeshParameterization()
    messages = []
    parameterization.AddObserver("ErrorEvent", lambda *_: messages.append(1))
    parameterization.SetInputDataObject(mesh)
    for name, value in options.items():
        getattr(parameterization, "Set" + name)(value)
    parameterization.Update()
    code = parameterization.GetErrorCode()
    assert len(messages) == (code != 0)
    assert code == 0 or parameterization.GetOutputDataObject(0).GetNumberOfPoints() == 0
    return code


def test_cylinder_unrolls():
    for method in (knotwork.vtkMeshParameterization.HLLE, knotwork.vtkMeshParameterization.LSCM,
                   knotwork.vtkMeshParameterization.ARAP):
        result = flatten(rolled(), Method=method)
        mesh, loops, table = (result.GetOutputDataObject(port) for port in range(3))
        uv = vtk_to_numpy(mesh.GetPointData().GetTCoords())
        # chords: edges of 0.025 on a radius of 0.5 are short by (0.05)^2 / 24 = 1e-4
        assert rigid_error(uv, FLAT) < 2e-4
        assert vtk_to_numpy(mesh.GetCellData().GetArray("Flipped")).sum() == 0
        values = vtk_to_numpy(mesh.GetCellData().GetArray("SingularValues"))
        assert abs(values - 1).max() < 2e-2
        assert (vtk_to_numpy(mesh.GetPointData().GetArray("Height")) == FLAT[:, 1]).all()
        assert (vtk_to_numpy(mesh.GetCellData().GetArray("Number")) == np.arange(len(TRIANGLES))).all()
        assert (vtk_to_numpy(mesh.GetPoints().GetData()) == ROLLED).all()
        assert table.GetNumberOfRows() == 1 and table.GetValueByName(0, "Loops").ToInt() == 2
        assert table.GetValueByName(0, "Fallback").ToInt() == 0
        lengths = vtk_to_numpy(loops.GetCellData().GetArray("Length"))
        assert loops.GetNumberOfCells() == 2
        assert abs(lengths - (6, 1.6)).max() < 2e-3
        for loop in range(2):  # outer one counterclockwise, hole clockwise
            ids = loops.GetCell(loop).GetPointIds()
            at = vtk_to_numpy(loops.GetPointData().GetArray("UV"))[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
            assert (at[0] == at[-1]).all()
            area = 0.5 * (at[:-1, 0] * at[1:, 1] - at[1:, 0] * at[:-1, 1]).sum()
            assert abs(area - (2, -0.16)[loop]) < 2e-3, area


def test_every_property_of_the_methods_changes_what_it_is_about():
    kind = knotwork.vtkMeshParameterization
    # a sheet that cannot be laid into the plane without stretch
    flat, triangles = plate(20)
    mesh = polydata(np.c_[flat, 0.3 * np.cos(3 * flat[:, 0]) * np.sin(2 * flat[:, 1])], triangles)

    def said(**options):
        result = flatten(mesh, **options)
        assert result.GetErrorCode() == 0
        table = result.GetOutputDataObject(2)
        numbers = [table.GetValueByName(0, name).ToString() for name in ("MeanStretch", "DistanceError")]
        return vtk_to_numpy(result.GetOutputDataObject(0).GetPointData().GetArray("UV")).tobytes(), numbers

    for method, name, values in (
            (kind.HLLE, "Neighbours", (10, 16)), (kind.HLLE, "MinimumParticipation", (0.02, 0.9)),
            (kind.LAPLACIAN, "LaplacianWeights", (kind.COTANGENT, kind.GRAPH)),
            (kind.ISOMAP, "Landmarks", (50, 20)), (kind.ISOMAP, "Geodesics", (kind.UNFOLDING, kind.EDGE_GRAPH)),
            (kind.ARAP, "MaximumIterations", (100, 1))):
        one, other = (said(Method=method, **{name: value}) for value in values)
        assert one == said(Method=method), name  # the default
        assert one[0] != other[0], name


def test_flat_output_lies_in_the_plane():
    result = flatten(rolled(), FlatOutput=True)
    for port in range(2):
        data = result.GetOutputDataObject(port)
        points = vtk_to_numpy(data.GetPoints().GetData())
        assert (points[:, :2] == vtk_to_numpy(data.GetPointData().GetArray("UV"))).all() and (points[:, 2] == 0).all()


def test_faces_of_more_corners_are_divided_exact_oracle():
    # six squares: a quad, a hexagon that is not convex, a strip, a pixel, two triangles
    points = np.array([(x, y, 0.1 * x * y) for y in range(3) for x in range(4)], float)
    points[5:7, 0] += 0.2, -0.1  # into the hexagon
    grid = vtkUnstructuredGrid()
    grid.SetPoints(polydata(points, []).GetPoints())
    cells = ((VTK_QUAD, (0, 1, 5, 4)), (VTK_POLYGON, (1, 2, 6, 10, 9, 5)), (VTK_TRIANGLE_STRIP, (2, 3, 6, 7)),
             (VTK_PIXEL, (4, 5, 8, 9)), (VTK_TRIANGLE, (6, 7, 11)), (VTK_TRIANGLE, (6, 11, 10)))
    for kind, corners in cells:
        grid.InsertNextCell(kind, len(corners), corners)
    number = numpy_to_vtk(np.arange(len(cells)), deep=1)
    number.SetName("Number")
    grid.GetCellData().AddArray(number)
    result = flatten(grid, Method=knotwork.vtkMeshParameterization.LSCM)
    mesh = result.GetOutput()
    assert mesh.GetNumberOfCells() == 12 and mesh.GetNumberOfPoints() == 12
    assert sorted(vtk_to_numpy(mesh.GetCellData().GetArray("Number"))) == [0, 0, 1, 1, 1, 1, 2, 2, 3, 3, 4, 5]
    assert vtk_to_numpy(mesh.GetCellData().GetArray("Flipped")).sum() == 0
    # in the cells' orientation, as a plane they fill the rectangle once
    xy = vtk_to_numpy(mesh.GetPoints().GetData())[:, :2]
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    sides = xy[corners[:, 1:]] - xy[corners[:, :1]]
    areas = 0.5 * np.linalg.det(sides)
    assert areas.min() > 0 and abs(areas.sum() - 6) < 1e-12, areas
    assert result.GetOutputDataObject(2).GetValueByName(0, "DividedFaces").ToInt() == 4
    tetrahedron = vtkUnstructuredGrid()
    tetrahedron.SetPoints(grid.GetPoints())
    tetrahedron.InsertNextCell(VTK_TETRA, 4, (0, 1, 4, 6))
    assert error_of(tetrahedron) > 0


def test_polygons_that_are_not_quite_flat_are_divided_exact_oracle():
    # an L whose corners are up to a ten thousandth off its plane, as coordinates of six digits leave them
    corners = [(0, 0, 1e-4), (2, 0, 0), (2, 1, 1e-4), (2.03, 1, 0), (2.03, 2, 0), (0, 2, 1e-4)]
    mesh = flatten(polydata(corners, [range(6)])).GetOutput()
    assert mesh.GetNumberOfCells() == 4 and vtk_to_numpy(mesh.GetCellData().GetArray("Flipped")).sum() == 0
    xy = vtk_to_numpy(mesh.GetPoints().GetData())[:, :2]
    triangles = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    areas = 0.5 * np.linalg.det(xy[triangles[:, 1:]] - xy[triangles[:, :1]])
    assert areas.min() > 0 and abs(areas.sum() - 4.03) < 1e-12, areas


def test_bad_meshes_are_refused():
    assert error_of(polydata(ROLLED, TRIANGLES)) == 0
    assert error_of(polydata(ROLLED, [*TRIANGLES, (0, 1, 0, 1)])) > 0  # nothing to divide
    assert error_of(polydata([(0, 0, 0), (2, 2, 0), (2, 0, 0), (0, 1, 0)], [range(4)])) > 0  # crosses itself
    assert error_of(polydata(ROLLED, [(0, 0, 1)])) > 0
    assert error_of(polydata(ROLLED, [*TRIANGLES, (0, 1)])) > 0  # VTK crashes on a face of two corners
    more = np.vstack([ROLLED, [[9, 9, 9]]])
    assert error_of(polydata(more, TRIANGLES)) > 0
    assert error_of(polydata(more, TRIANGLES), LargestComponent=True) == 0
    more[3] = np.nan
    assert error_of(polydata(more, TRIANGLES), LargestComponent=True) > 0
    tetrahedron = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    assert error_of(polydata(np.vstack([np.zeros(3), np.eye(3)]), tetrahedron)) > 0
    assert error_of(vtkPolyData()) > 0


def test_job_reports_what_the_filter_says():
    name = knotwork_testing.output("rolled_plate.vtp")
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(name)
    writer.SetDataModeToBinary()
    writer.SetInputData(rolled())
    writer.Write()
    out, loops, report = (knotwork_testing.output(end) for end in ("flat.vtp", "flat_loops.vtp", "flat.json"))
    done = knotwork_testing.run_program("flatten", name, "--method", "hlle", "--output", out, "--loops", loops,
                                        "--report", report, "--quiet")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    with open(report) as stream:
        said = json.load(stream)
    assert said["flipped_triangles"] == 0 and said["loops"] == 2
    assert said["method"] == "hlle" and said["fallback"] is False
    assert 1 <= said["mean_stretch"] <= said["max_stretch"] < 1.02
    assert said["seconds"] > 0
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(out)
    reader.Update()
    assert rigid_error(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("UV")), FLAT) < 2e-4
    done = knotwork_testing.run_program("flatten", name, "--method", "laplacian", "--output", out,
                                        "--report", report, "--quiet")
    assert done.returncode == 0, done.stderr
    with open(report) as stream:
        assert json.load(stream)["mean_stretch"] > 1.5


def sphere():
    """A closed surface with its points as point data and the numbers of its cells."""
    source = vtkSphereSource()
    source.SetThetaResolution(31)
    source.SetPhiResolution(21)
    source.SetOutputPointsPrecision(vtkAlgorithm.DOUBLE_PRECISION)
    source.Update()
    mesh = vtkPolyData()
    mesh.SetPoints(source.GetOutput().GetPoints())
    mesh.SetPolys(source.GetOutput().GetPolys())
    place = numpy_to_vtk(vtk_to_numpy(mesh.GetPoints().GetData()).copy(), deep=1)
    place.SetName("Place")
    mesh.GetPointData().AddArray(place)
    number = numpy_to_vtk(np.arange(mesh.GetNumberOfCells()), deep=1)
    number.SetName("Number")
    mesh.GetCellData().AddArray(number)
    return mesh


def areas(points, corners):
    a, b, c = (points[corners[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def test_closed_surface_gets_charts():
    mesh = sphere()
    assert error_of(mesh) > 0  # closed
    assert error_of(mesh, MaximumStretch=0.5) > 0
    assert error_of(mesh, MaximumStretch=2, MaximumCharts=1) > 0
    result = flatten(mesh, MaximumStretch=1.2)
    out, loops, table = (result.GetOutputDataObject(port) for port in range(3))
    points, uv, cut, place = (vtk_to_numpy(data) for data in (
        out.GetPoints().GetData(), *(out.GetPointData().GetArray(name) for name in ("UV", "CutPointId", "Place"))))
    chart, number, values = (vtk_to_numpy(out.GetCellData().GetArray(name))
                             for name in ("ChartId", "Number", "SingularValues"))
    corners = vtk_to_numpy(out.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    count = table.GetValueByName(0, "Charts").ToInt()
    assert count > 2 and sorted(set(chart)) == list(range(count))
    assert (1 / values[:, 1]).max() <= 1.2 and values[:, 0].max() <= 1.2
    assert abs(table.GetValueByName(0, "MaxStretch").ToDouble() - max(values[:, 0].max(), (1 / values[:, 1]).max())) < 1e-9
    # point data is linear, as the points are; rounding
    assert abs(place - points).max() < 1e-14
    before = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    whole = areas(vtk_to_numpy(mesh.GetPoints().GetData()), before)
    assert abs(np.bincount(number, areas(points, corners)) - whole).max() < 1e-14
    # the same id is the same place, and copies belong to different charts
    _, first, copies = np.unique(cut, return_index=True, return_inverse=True)
    assert (points == points[first][copies]).all()
    assert len(first) < len(points) and len(np.unique(points, axis=0)) == len(first)
    edges = np.sort(cut[corners[:, [0, 1, 1, 2, 2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()  # closed by its ids
    # images side by side
    boxes = [(uv[corners[chart == c].ravel()].min(0), uv[corners[chart == c].ravel()].max(0)) for c in range(count)]
    for c in range(count):
        for d in range(c):
            assert (np.maximum(boxes[c][0], boxes[d][0]) > np.minimum(boxes[c][1], boxes[d][1])).any()
    of_loop = vtk_to_numpy(loops.GetCellData().GetArray("Chart"))
    assert sorted(set(of_loop)) == list(range(count))
    ids = vtk_to_numpy(loops.GetPointData().GetArray("PointIds"))
    at = vtk_to_numpy(loops.GetPoints().GetData())
    given = vtk_to_numpy(mesh.GetPoints().GetData())
    assert (ids == -1).any() and (at[ids >= 0] == given[ids[ids >= 0]]).all()
    assert set(vtk_to_numpy(loops.GetPointData().GetArray("CutPointId"))) <= set(cut)


def test_one_good_chart_is_the_mesh():
    result = flatten(rolled(), MaximumStretch=1.5).GetOutputDataObject(0)
    plain = flatten(rolled()).GetOutputDataObject(0)
    for name in ("UV", "CutPointId"):
        one, other = (vtk_to_numpy(data.GetPointData().GetArray(name)) for data in (result, plain))
        assert abs(one - other).max() < 1e-12
    assert (vtk_to_numpy(plain.GetPointData().GetArray("CutPointId")) == np.arange(len(FLAT))).all()
    assert vtk_to_numpy(result.GetCellData().GetArray("ChartId")).max() == 0


def test_one_chart_that_lies_over_itself_is_said():
    turn, radius = np.meshgrid(np.linspace(0, 4 * np.pi, 121), [0.7, 1.0, 1.3], indexing="ij")
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn), 0.02 * turn], -1).reshape(-1, 3)  # two turns of a ramp
    corners = [(a, a + 1, a + 4) for i in range(120) for a in (3 * i, 3 * i + 1)]
    ramp = polydata(points, corners + [(a, d, d - 1) for a, _, d in corners])
    whole = flatten(ramp).GetOutputDataObject(2)
    assert whole.GetValueByName(0, "FlippedTriangles").ToInt() == 0 and whole.GetValueByName(0, "Injective").ToInt() == 0
    charts = flatten(ramp, MaximumStretch=2).GetOutputDataObject(2)
    assert charts.GetValueByName(0, "Injective").ToInt() == 1 and charts.GetValueByName(0, "Charts").ToInt() > 1


def test_job_makes_charts():
    name = knotwork_testing.output("sphere.vtp")
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(name)
    writer.SetInputData(sphere())
    writer.Write()
    out, report = (knotwork_testing.output(end) for end in ("charts.vtp", "charts.json"))
    done = knotwork_testing.run_program("flatten", name, "--maximum-stretch", 2, "--output", out, "--report", report,
                                        "--quiet")
    assert done.returncode == 0, done.stderr
    with open(report) as stream:
        said = json.load(stream)
    assert said["charts"] == 2 and said["loops"] == 2 and said["flipped_triangles"] == 0 and said["injective"] is True
    assert said["max_stretch"] <= 2 and said["maximum_stretch"] == 2 and said["crease_angle"] == 40
    done = knotwork_testing.run_program("flatten", name, "--output", out)
    assert done.returncode == 1 and "closed" in done.stderr, done.stderr
    done = knotwork_testing.run_program("flatten", name, "--maximum-stretch", -1, "--output", out)
    assert done.returncode == 2, done.stderr


def test_job_refuses_bad_meshes():
    name = knotwork_testing.output("two_triangles.off")
    out = knotwork_testing.output("never.vtp")
    with open(name, "w") as stream:
        stream.write("OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n5 0 0\n6 0 0\n5 1 0\n3 0 1 2\n3 3 4 5\n")
    done = knotwork_testing.run_program("flatten", name, "--output", out)
    assert done.returncode == 1 and "2 components" in done.stderr, done.stderr
    done = knotwork_testing.run_program("flatten", name, "--output", out, "--neighbours", 2)
    assert done.returncode == 2, done.stderr


knotwork_testing.main(globals())
