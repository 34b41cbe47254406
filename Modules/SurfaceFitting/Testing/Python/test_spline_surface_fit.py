# SPDX-License-Identifier: BSD-3-Clause
"""A wave and a cliff fitted from Python: errors measured here with NumPy, and heights as a picture."""
import knotwork
import knotwork_testing
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: before the first renderer is made
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer


def cloud(height, n=20000, seed=1, **arrays):
    """Points of z = height(x, y) over the unit square."""
    x, y = np.random.default_rng(seed).random((2, n))
    data = polydata(np.c_[x, y, height(x, y)])
    for name, function in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(function(x, y)), deep=1)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def polydata(points):
    data = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetDataTypeToDouble()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=1))
    data.SetPoints(coordinates)
    return data


def fitted(data, **properties):
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputDataObject(data)
    for name, value in properties.items():
        getattr(fit, "Set" + name)(value)
    fit.Update()
    assert fit.GetErrorCode() == 0
    return fit


def evaluated(fit, uv):
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputConnection(0, fit.GetOutputPort(0))
    evaluate.SetInputDataObject(1, polydata(np.c_[uv, np.zeros(len(uv))]))
    evaluate.Update()
    return evaluate.GetOutputDataObject(0)


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def final(fit, name):
    table = fit.GetOutputDataObject(2)
    return table.GetValueByName(table.GetNumberOfRows() - 1, name).ToDouble()


def cliff(x, y):
    return 0.2 * np.sin(3 * x) * y + 0.3 * np.tanh((y - 0.5 - 0.2 * np.sin(4 * x)) / 0.01)


def test_both_spaces_keep_the_tolerance_CrossOracle():
    data = cloud(cliff, Double=lambda x, y: 2 * cliff(x, y))
    for space in (knotwork.vtkSplineSurfaceFit.LR, knotwork.vtkSplineSurfaceFit.THB):
        fit = fitted(data, Space=space, Tolerance=0.01, AllFields=True)
        surface = evaluated(fit, points_of(data)[:, :2])
        distance = points_of(data)[:, 2] - points_of(surface)[:, 2]
        assert np.abs(distance).max() <= 0.01
        rounding = 1e-13
        assert abs(np.abs(distance).max() - final(fit, "MaxError")) < rounding
        assert np.allclose(vtk_to_numpy(fit.GetOutputDataObject(1).GetPointData().GetArray("Distance")), distance,
                           atol=rounding)
        # what is fitted along is near twice the surface; only the surface is brought within the tolerance
        double = vtk_to_numpy(surface.GetPointData().GetArray("Double"))
        assert np.abs(double - 2 * points_of(surface)[:, 2]).max() < 0.01
        cells = fit.GetOutputDataObject(0).GetNumberOfCells()
        assert cells == final(fit, "Elements") > 500


def test_between_the_points_the_surface_is_near_the_truth_PropertyOracle():
    def wave(x, y):
        return np.sin(5 * x) * np.cos(4 * y)

    fit = fitted(cloud(wave), Tolerance=1e-3, Degree=3)
    uv = np.random.default_rng(2).uniform(0.01, 0.99, (5000, 2))
    z = points_of(evaluated(fit, uv))[:, 2]
    assert np.abs(z - wave(*uv.T)).max() < 2e-3


def test_arrays_by_name():
    data = cloud(cliff, Limit=lambda x, y: np.where(x < 0.5, 0.05, 0.005))
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputDataObject(data)
    fit.SetInputArrayToProcess(1, 0, 0, 0, "Limit")
    fit.Update()
    limit = vtk_to_numpy(data.GetPointData().GetArray("Limit"))
    distance = vtk_to_numpy(fit.GetOutputDataObject(1).GetPointData().GetArray("Distance"))
    assert (np.abs(distance) <= limit).all() and np.abs(distance).max() > 0.005
    fit.SetInputArrayToProcess(1, 0, 0, 0, "Nothing")
    with knotwork_testing.Errors(fit) as errors:
        fit.Update()
    assert "'Nothing'" in errors[0], errors
    assert fit.GetErrorCode() == 40006


def heights(**properties):
    """The surface from above, in bands of height."""
    fit = fitted(cloud(cliff), Tolerance=0.005, **properties)
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputConnection(fit.GetOutputPort(0))
    tessellate.SetChordalTolerance(0.002)
    tessellate.Update()
    surface = tessellate.GetOutputDataObject(0)
    z = numpy_to_vtk(points_of(surface)[:, 2].copy(), deep=1)
    z.SetName("Height")
    surface.GetPointData().SetScalars(z)
    colours = [(0, 0.2, 0.8), (0.4, 0.8, 1), (0, 0.6, 0.2), (0.9, 0.9, 0), (1, 0.5, 0), (0.7, 0, 0)]
    table = vtkLookupTable()
    table.SetNumberOfTableValues(len(colours))
    for i, colour in enumerate(colours):
        table.SetTableValue(i, *colour, 1)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(-0.36, 0.54)
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetLighting(False)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.5, 0.5, 5)
    camera.SetFocalPoint(0.5, 0.5, 0)
    camera.SetParallelScale(0.53)
    return renderer


def test_elements_have_features_CrossOracle():
    data = cloud(cliff, n=3000)
    fit = fitted(data, Tolerance=0.02, ElementFeatures=True)
    elements = fit.GetOutputDataObject(4)
    distance = vtk_to_numpy(fit.GetOutputDataObject(1).GetPointData().GetArray("Distance"))
    x, y = points_of(data)[:, 0], points_of(data)[:, 1]
    for name, of in (("MaxAbove", lambda d: d[d > 0].max(initial=0)), ("NumPoints", len),
                     ("Roughness", lambda d: d.std() if len(d) else 0)):
        values = vtk_to_numpy(elements.GetCellData().GetArray(name))
        for c in range(0, elements.GetNumberOfCells(), 17):
            x0, x1, y0, y1 = elements.GetCell(c).GetBounds()[:4]
            inside = (x >= x0) & (x < x1) & (y >= y0) & (y < y1)
            if x1 < x.max() and y1 < y.max():
                assert abs(values[c] - of(distance[inside])) < 1e-13, (name, c)


def test_a_start_is_updated_CrossOracle():
    first = fitted(cloud(cliff), Tolerance=0.01, Space="THB", Domain=(0, 1, 0, 1))
    uv = 0.25 * np.random.default_rng(5).random((1000, 2))
    z = cliff(*uv.T) + 0.1 * np.exp(-400 * ((uv - 0.1) ** 2).sum(1))
    update = knotwork.vtkSplineSurfaceFit()
    update.SetInputDataObject(polydata(np.c_[uv, z]))
    update.SetStartConnection(first.GetOutputPort(0))
    update.SetTolerance(0.01)
    update.Update()
    assert update.GetErrorCode() == 0
    assert np.abs(points_of(evaluated(update, uv))[:, 2] - z).max() <= 0.01
    assert np.abs(points_of(evaluated(first, uv))[:, 2] - z).max() > 0.05
    far = 0.65 + 0.35 * np.random.default_rng(6).random((500, 2))
    assert np.abs(points_of(evaluated(update, far)) - points_of(evaluated(first, far))).max() < 1e-14


def test_bands_of_height_follow_the_cliff():
    knotwork_testing.render_and_compare(heights(), "SplineSurfaceFit")


def test_a_coarse_fit_is_another_picture():
    try:
        knotwork_testing.render_and_compare(heights(MaximumIterations=0), "SplineSurfaceFit")
    except AssertionError:
        return
    raise AssertionError("the picture of a coarse fit passes")


knotwork_testing.main(globals())
