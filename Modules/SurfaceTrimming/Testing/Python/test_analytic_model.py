# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of turned solids -> vtkAnalyticModel -> a CAD file -> vtkCADReader: the types of all faces, the area in closed form."""
import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkPlaneSource

SIDES = 64
PLANE, CYLINDER, SPHERE, CONE, TORUS = range(5)


def arc(centre, radius, begin, end):
    """Points (radius, z) of an arc, in degrees, without its first one."""
    angles = np.radians(np.linspace(begin, end, SIDES // 4 + 1))[1:]
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in angles]


def turned(profile):
    """The triangles of a profile, points (radius, z), turned about the z axis."""
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    points = vtkPoints()
    points.SetDataTypeToDouble()
    rings = []
    for radius, height in profile:
        count = SIDES if radius > 1e-12 else 1
        ring = [points.InsertNextPoint(radius * np.cos(a), radius * np.sin(a), height) for a in angles[:count]]
        rings.append(ring * (SIDES // count))
    cells = vtkCellArray()
    for low, high in zip(rings[:-1], rings[1:]):
        for i in range(SIDES):
            j = (i + 1) % SIDES
            for triangle in ((low[i], low[j], high[j]), (low[i], high[j], high[i])):
                if len(set(triangle)) == 3:
                    cells.InsertNextCell(3, triangle)
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    return mesh


# profile, types of the faces, area
SOLIDS = {
    "drum": ([(0, 0), (1, 0), (1, 2), (0, 2)], [PLANE, PLANE, CYLINDER], 6 * np.pi),
    "frustum": ([(0, 0), (2, 0), (1, 2), (0, 2)], [PLANE, PLANE, CONE], np.pi * (5 + 3 * np.sqrt(5))),
    "dome": ([(0, 0), (1, 0), *arc((0, 0), 1, 0, 90)], [PLANE, SPHERE], 3 * np.pi),
    # a drum with a round upper edge: the torus of a quarter circle has the area 2 pi (1.5 pi / 2 * 0.5 + 0.5 * 0.5)
    "cheese": ([(0, 0), (2, 0), (2, 1), *arc((1.5, 1), 0.5, 0, 90), (0, 1.5)], [PLANE, PLANE, CYLINDER, TORUS],
               np.pi * (4 + 4 + 1.5 ** 2) + 2 * np.pi * (1.5 * np.pi / 2 * 0.5 + 0.25)),
}


def modelled(mesh):
    model = knotwork.vtkAnalyticModel()
    model.SetInputDataObject(mesh)
    model.SetMaximumSag(30)
    model.Update()
    assert model.GetErrorCode() == 0
    return model


def number(model, name):
    return model.GetOutputDataObject(3).GetValueByName(0, name).ToDouble()


def types_of(grid):
    """Of the faces, sorted."""
    types = vtk_to_numpy(grid.GetCellData().GetArray("SurfaceType"))
    faces = vtk_to_numpy(grid.GetCellData().GetArray("FaceId"))
    return sorted(int(types[faces == face][0]) for face in set(faces))


def area_of(triangles):
    points = vtk_to_numpy(triangles.GetPoints().GetData()).astype(float)
    corners = points[vtk_to_numpy(triangles.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2


def written(model, name):
    file = knotwork_testing.output("surface_trimming/" + name)
    writer = knotwork.vtkCADWriter()
    writer.SetInputConnection(0, model.GetOutputPort(1))
    writer.SetInputConnection(1, model.GetOutputPort(2))
    writer.SetFileName(file)
    assert writer.Write() == 1
    return file


def test_solids_come_back_from_files_with_their_types():
    for name, (profile, types, area) in SOLIDS.items():
        model = modelled(turned(profile))
        assert types_of(model.GetOutputDataObject(1)) == sorted(types), name
        assert number(model, "WithinTolerance") == 1 and number(model, "LoopsProved") == 1
        assert number(model, "Loops") == 0 and number(model, "Circles") == number(model, "Edges")
        for ending in (".step", ".igs"):
            reader = knotwork.vtkCADReader()
            reader.SetFileName(written(model, name + ending))
            reader.SetChordalTolerance(3e-4)
            reader.Update()
            assert reader.GetErrorCode() == 0
            assert types_of(reader.GetOutputDataObject(0)) == sorted(types), (name, ending)
            # chords within t = 3e-4 of the size, about 6, of surfaces of a mean radius r near 1: less than 2 t / r of the area
            found = area_of(reader.GetOutputDataObject(2))
            assert abs(found / area - 1) < 3.6e-3, (name, ending, found, area)


def test_files_hold_the_surfaces_and_no_splines():
    for name, words in (("drum", ("PLANE", "CYLINDRICAL_SURFACE", "CIRCLE")), ("cheese", ("TOROIDAL_SURFACE", "CIRCLE"))):
        with open(written(modelled(turned(SOLIDS[name][0])), name + ".step")) as stream:
            text = stream.read()
        assert all(word in text for word in words), name
        assert "B_SPLINE_SURFACE" not in text, name
        assert "MANIFOLD_SOLID_BREP" in text, name


def test_every_fineness_has_triangles():
    """At 1e-3 and 1.5e-3 polygons of the cheese's rims cross, so that its triangles are finer."""
    profile, _, area = SOLIDS["cheese"]
    for tolerance in (1e-3, 1.2e-3, 1.5e-3, 4e-3):
        model = knotwork.vtkAnalyticModel()
        model.SetInputDataObject(turned(profile))
        model.SetMaximumSag(30)
        model.SetChordalTolerance(tolerance)
        model.Update()
        assert model.GetErrorCode() == 0, tolerance
        assert abs(number(model, "Area") / area - 1) < 5 * tolerance, tolerance


def test_free_form_is_refused():
    plane = vtkPlaneSource()
    plane.SetResolution(20, 20)
    plane.SetOutputPointsPrecision(1)
    plane.Update()
    wave = plane.GetOutput()
    points = vtk_to_numpy(wave.GetPoints().GetData())
    points[:, 2] = 0.2 * np.sin(5 * points[:, 0]) * np.cos(4 * points[:, 1])
    model = knotwork.vtkAnalyticModel()
    model.SetInputDataObject(wave)
    for free, words in ((True, "% of the area"), (False, "is of free form")):
        model.SetFreeForm(free)
        with knotwork_testing.Errors(model) as errors:
            model.Update()
        assert model.GetErrorCode() != 0 and words in errors[0], errors
    assert model.GetOutputDataObject(1).GetNumberOfCells() == 0


knotwork_testing.main(globals())
