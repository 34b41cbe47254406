# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package: results as the filters' own, splines from numbers and back, errors with code, place and remedy."""
import os
import pickle
import tempfile
import warnings

import knotwork as kw
import knotwork_testing
import numpy as np
from vtkmodules.vtkCommonDataModel import vtkDataSet, vtkSphere

RNG = np.random.default_rng(7)


def cloud(n=3000):
    xy = RNG.random((n, 2))
    return np.column_stack([xy, 10 * np.sin(4 * xy[:, 0]) * np.cos(3 * xy[:, 1])])


def basis(knots, degree, i, u):
    """Cox and de Boor's recursion, value of function i; the independent computation of this test."""
    if degree == 0:
        last = knots[i + 1] == knots[-1] and u == knots[-1] and knots[i] < knots[i + 1]
        return 1.0 if knots[i] <= u < knots[i + 1] or last else 0.0
    left = knots[i + degree] - knots[i]
    right = knots[i + degree + 1] - knots[i + 1]
    return ((u - knots[i]) / left * basis(knots, degree - 1, i, u) if left else 0.0) + \
        ((knots[i + degree + 1] - u) / right * basis(knots, degree - 1, i + 1, u) if right else 0.0)


def rational_point(knots, degrees, net, weights, parameters):
    values = [np.array([basis(k, p, i, u) for i in range(len(k) - p - 1)]) for k, p, u in zip(knots, degrees, parameters)]
    products = values[0] if len(knots) == 1 else np.einsum("i,j->ji", *values) if len(knots) == 2 else np.einsum("i,j,k->kji", *values)
    blend = products * weights
    return np.tensordot(blend, net, blend.ndim) / blend.sum()


def test_splines_of_numbers_are_the_recursion_s():
    cases = [([[0, 0, 0, .3, .7, 1, 1, 1]], (5,)), ([[0, 0, 0, .4, 1, 1, 1], [0, 0, .5, 1, 1]], (3, 4)),
             ([[0, 0, 1, 1], [0, 0, 0, 2, 2, 2], [0, 0, .5, 1, 1]], (3, 3, 2))]
    for knots, counts in cases:
        for rational in (False, True):
            net = RNG.random(counts + (3,))
            weights = RNG.uniform(0.5, 2, counts) if rational else np.ones(counts)
            made = kw.spline(knots, net, weights if rational else None)
            degrees = [len(k) - n - 1 for k, n in zip(knots, counts[::-1])]
            assert made.degrees == tuple(degrees)
            for _ in range(5):
                at = [RNG.uniform(k[0], k[-1]) for k in knots]
                expected = rational_point([np.array(k, float) for k in knots], degrees, net, weights, at)
                assert np.allclose(made(*at), expected, rtol=0, atol=1e-14), (knots, at)


def test_numbers_of_splines_come_back_bit_for_bit():
    knots = [np.array([0, 0, 0, .4, 1, 1, 1]), np.array([0, 0, .5, 1, 1])]
    net, weights = RNG.random((3, 4, 3)), RNG.uniform(0.5, 2, (3, 4))
    for made in (kw.spline(knots, net, weights), kw.spline(knots, net.reshape(-1, 3), weights.ravel())):
        assert all(np.array_equal(*both) for both in zip(made.knots, knots))
        assert np.array_equal(made.control_points, net.reshape(-1, 3)) and np.array_equal(made.weights, weights.ravel())
        assert not made.control_points.flags.writeable
        assert made.spline_patches[0].family == "tensor-product" and made.spline_patches[0].id == 0
    assert kw.spline(knots, net).weights is None
    disc = kw.source("disc")
    assert len(disc.spline_patches) == 5
    assert "5 patches" in refused(ValueError, lambda: disc.knots)
    assert kw.spline([0, 0, 1, 1], [[0, 0], [2, 1]]).control_points.tolist() == [[0, 0, 0], [2, 1, 0]]


def test_derivatives_are_differences():
    made = kw.spline([[0, 0, 0, .4, 1, 1, 1], [0, 0, 0, .5, 1, 1, 1]], RNG.random((4, 4, 3)), RNG.uniform(0.5, 2, (4, 4)))
    u, v, h = RNG.uniform(0.1, 0.3, 6), RNG.uniform(0.6, 0.9, 6), 1e-5
    first = (made(u + h, v) - made(u - h, v)) / (2 * h)  # errs by h^2 f''' / 6 and rounding / h
    assert np.allclose(made.derivative(u, v), first, rtol=1e-6, atol=1e-6)
    mixed = (made.derivative(u, v + h) - made.derivative(u, v - h)) / (2 * h)
    assert np.allclose(made.derivative(u, v, order=(1, 1)), mixed, rtol=1e-5, atol=1e-5)
    assert made(u.reshape(2, 3), v.reshape(2, 3)).shape == (2, 3, 3) and made(u, 0.5).shape == (6, 3) and made(0.5, 0.5).shape == (3,)
    assert "sum of 1 or 2" in refused(ValueError, lambda: made.derivative(0.5, 0.5, order=(2, 1)))


def test_a_function_gives_what_its_filter_gives():
    points = cloud()
    result = kw.fit(points, tolerance=0.3)
    fit = kw.vtkSplineSurfaceFit()
    fit.SetInputDataObject(kw.points(points))
    fit.SetTolerance(0.3)
    fit.Update()
    same = kw.wrap(fit.GetOutputDataObject(0))
    assert np.array_equal(result.control_points, same.control_points)
    assert list(result.outputs) == ["points", "iterations", "features", "elements"]
    assert result.numbers["points_outside"] == 0 and result.numbers["max_error"] <= 0.3
    assert isinstance(result, vtkDataSet)
    contour = result.contour([3, 5])
    assert sorted(set(contour.cell_arrays["Level"])) == [3, 5]
    assert np.allclose(contour.points[:, 2], np.repeat([3, 5], [np.sum(contour.points[:, 2] < 4), np.sum(contour.points[:, 2] > 4)])[
        np.argsort(np.argsort(contour.points[:, 2], kind="stable"), kind="stable")], atol=1e-2)
    by_name = kw.contour(input=result, levels=[3, 5])
    assert np.array_equal(by_name.points, contour.points)


def test_every_property_is_a_parameter_and_reaches_its_filter():
    """Of each function: a value that is not the default is what the filter has then."""
    from knotwork import _properties, operations, signatures

    counted = 0
    for verb, (filter_name, _) in signatures.VERBS.items():
        if not signatures.available(filter_name):
            continue
        for keyword, (name, default, _) in signatures.properties(filter_name).items():
            owner = filter_name if name in _properties.PROPERTIES[filter_name] else "vtkSplineAlgorithm"
            kind, count, low, high, names = _properties.PROPERTIES[owner][name]
            made = getattr(kw, filter_name)()
            stored = getattr(made, "Get" + name)()
            if names:
                assert names[stored][0] == default, (verb, keyword)
                value, expected = names[-1][0], len(names) - 1
            elif kind == "bool":
                assert bool(stored) == default, (verb, keyword)
                value = expected = not default
            elif kind == "string":
                assert (stored or "") == default, (verb, keyword)
                value = expected = "Name"
            else:
                assert stored == default, (verb, keyword, stored, default)
                other = [x for x in (high, low) if x is not None and x != default]
                single = other[0] if other else (default[0] if count > 1 else default) + 1
                value = expected = single if count == 1 else (single,) * count
            operations._adjust(made, filter_name, {keyword: value})
            assert getattr(made, "Get" + name)() == expected, (verb, keyword)
            counted += 1
    assert counted > 300, counted


def test_every_filter_has_a_function():
    from knotwork import _properties, signatures

    filters = {name for name in _properties.FILTERS if not name.endswith("Reader")}
    used = {name for name, _ in signatures.VERBS.values()} | {"vtkAnalyticModel", "vtkTrimmedSurface"}  # these two by trim
    assert filters <= used, filters - used


def test_signatures_and_help_say_the_parameters():
    import inspect

    from knotwork import signatures

    for verb, (filter_name, _) in signatures.VERBS.items():
        if not signatures.available(filter_name):
            continue
        function = getattr(kw, verb)
        listed = inspect.signature(function).parameters
        assert "progress" in listed
        for keyword, (_, default, sentence) in signatures.properties(filter_name).items():
            if keyword != "file_name":
                assert listed[keyword].default == default
                assert f"{keyword} = {default!r}: {sentence}" in function.__doc__, (verb, keyword)
        assert len(function.__doc__.split("\n")[0].split()) > 4, function.__doc__
    assert "contour" in dir(kw.Grid) and kw.Grid.contour.__doc__ == kw.contour.__doc__ and not hasattr(kw.Grid, "source")


def test_stubs_name_every_function():
    folder = os.path.dirname(kw.__file__)
    with open(os.path.join(folder, "__init__.pyi"), encoding="utf-8") as stream:
        text = stream.read()
    compile(text, "__init__.pyi", "exec")
    from knotwork import signatures

    for verb, (filter_name, _) in signatures.VERBS.items():
        assert (f"def {verb}(" in text) == signatures.available(filter_name), verb
    assert os.path.exists(os.path.join(folder, "py.typed"))


def refused(error, call, *words):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = call()
    except error as fault:
        text = str(fault)
        assert len(text.split()) > 3, text
        for word in words:
            assert word in text, (word, text)
        return text
    raise AssertionError(f"no {error.__name__}, but {result!r}")


def test_wrong_calls_raise_with_a_sentence():
    s = kw.source("square", elements=(2, 2, 1))
    points = cloud(200)
    folder = tempfile.mkdtemp()
    empty = os.path.join(folder, "empty.vtu")
    open(empty, "w").close()
    nan = points.copy()
    nan[17, 2] = np.nan
    calls = [
        # names
        (TypeError, lambda: kw.fit(points, tolerence=1), "'tolerence'", "did you mean 'tolerance'"),
        (TypeError, lambda: kw.fit(points, zzzz=1), "no parameter", "tolerance"),
        (TypeError, lambda: kw.trim("a.stl", tolerence=1), "did you mean 'tolerance'"),
        (TypeError, lambda: s.refine(number=1), "no parameter"),
        (TypeError, lambda: kw.fit(), "'input'"),
        (TypeError, lambda: kw.fit(points, None, 0.3), "too many"),
        (TypeError, lambda: kw.quads(), "'file'"),
        (AttributeError, lambda: s.contuor([1]), "contuor"),
        # ranges
        (ValueError, lambda: kw.fit(points, tolerance=-5), "SetTolerance", "at least 0"),
        (ValueError, lambda: kw.fit(points, degree=10), "1 to 9"),
        (ValueError, lambda: kw.fit(points, degree=0), "1 to 9"),
        (ValueError, lambda: kw.fit(points, threads=5000), "0 to 1024"),
        (ValueError, lambda: s.refine(number_of_refinements=11), "0 to 10"),
        (ValueError, lambda: s.validate(relative_gap=0), "not in"),
        (ValueError, lambda: s.validate(relative_gap=2), "not in"),
        (ValueError, lambda: s.contour(number_of_levels=0), "1 to 10000"),
        (ValueError, lambda: kw.fit(points, method=3), "none of", "least-squares"),
        (ValueError, lambda: kw.fit(points, method="mbb"), "none of", "mba"),
        (ValueError, lambda: kw.source("disk"), "'disk'", "disc"),
        (ValueError, lambda: kw.source("Disk"), "none of"),
        # types
        (TypeError, lambda: kw.fit(points, tolerance="0.3"), "no number"),
        (TypeError, lambda: kw.fit(points, degree=2.5), "no whole number"),
        (TypeError, lambda: kw.fit(points, degree=None.__class__), "no whole number"),
        (TypeError, lambda: kw.fit(points, find_outliers="off"), "True nor False"),
        (TypeError, lambda: kw.fit(points, domain=(0, 1)), "takes 4 values"),
        (TypeError, lambda: kw.fit(points, parameter_array=3), "a string"),
        (TypeError, lambda: s.contour(8), "levels"),
        (TypeError, lambda: s.contour(["high"]), "real number"),
        (TypeError, lambda: kw.source(elements=3), "elements"),
        (TypeError, lambda: s.refine(implicit_function=3), "vtkImplicitFunction"),
        # data
        (TypeError, lambda: kw.fit(3), "neither data"),
        (TypeError, lambda: kw.fit(None), "neither data"),
        (TypeError, lambda: kw.fit(np.zeros((5, 4))), "2 or 3 coordinates"),
        (TypeError, lambda: kw.fit({"a": 1}), "neither data"),
        (kw.Error, lambda: kw.fit(np.zeros((0, 3))), "no points"),
        (kw.Error, lambda: kw.fit(nan), "17"),
        (TypeError, lambda: kw.fit(kw.Table()), "fit(): input", "vtkTable", "vtkPointSet is wanted"),
        (TypeError, lambda: kw.refine(kw.points(points)), "vtkUnstructuredGrid"),
        (TypeError, lambda: kw.points(points).validate(), "type"),
        (kw.Error, lambda: kw.source("ball").contour(), "select the surfaces"),
        (kw.Error, lambda: kw.warp([[5.0, 5, 5]], kw.source("line")), "point 0"),
        (ValueError, lambda: kw.points([1, 2, 3]), "rows of 2 or 3"),
        (ValueError, lambda: kw.points(points, z=[1, 2]), "2 values for 200 points"),
        (ValueError, lambda: kw.mesh(points, [[0, 1]]), "at least 3"),
        (ValueError, lambda: kw.mesh(points, [[0, 1, 200]]), "0 to 199"),
        (ValueError, lambda: kw.mesh(points, [[0.0, 1.0, 2.0]]), "float"),
        (ValueError, lambda: kw.polyline([[0, 0]]), "at least two"),
        (ValueError, lambda: kw.polyline([[0, 0], [0, 0], [1, 0]]), "no two"),
        # splines
        (kw.Error, lambda: kw.spline([0, 0, 1, 1], [[0, 0], [1, 1], [2, 2]]), "degree"),
        (kw.Error, lambda: kw.spline([0, 1, 0, 1], [[0, 0], [1, 1]]), "first direction"),
        (kw.Error, lambda: kw.spline([0, 0, 1, 1], [[0, 0], [1, np.nan]]), "control point 1"),
        (kw.Error, lambda: kw.spline([0, 0, 1, 1], [[0, 0], [1, 1]], [1, -1]), "weight"),
        (kw.Error, lambda: kw.spline([0, 0, 1, 1], [[0, 0], [1, 1]], [1]), "weight"),
        (ValueError, lambda: kw.spline([[0, 0, 1, 1]] * 2, np.zeros((2, 2, 2, 3))), "an axis a direction"),
        (kw.Error, lambda: s(2.0, 0.5), "outside the domain"),
        (TypeError, lambda: s(0.5), "1 parameters", "has 2"),
        (TypeError, lambda: s(), "has 2"),
        (ValueError, lambda: s.field("height", 0.5, 0.5), "no field 'height'"),
        (ValueError, lambda: s.invalid_cells, "validate()"),
        (TypeError, lambda: kw.cadfit(s, target=kw.Table()), "target", "vtkTable"),
        (ValueError, lambda: s.plot(file=os.path.join(folder, "a.png"), scalars="height"), "'height'"),
        # files
        (kw.FileError, lambda: kw.read(os.path.join(folder, "none.stl")), "none.stl", "check the name"),
        (OSError, lambda: kw.fit(os.path.join(folder, "none.xyz")), "none.xyz"),
        (kw.Error, lambda: kw.read(empty), "empty.vtu"),
        (kw.Error, lambda: s.save(os.path.join(folder, "a.abc")), ".abc"),
        (OSError, lambda: s.save(os.path.join(folder, "no", "a.vtu")), "no"),
        (kw.Error, lambda: kw.points(points).save(os.path.join(folder, "a.step")), "a.step"),
        (kw.Error, lambda: s.save(os.path.join(folder, "a.vtu"), encoding="utf-8"), "utf-8"),
    ]
    for number, (error, call, *words) in enumerate(calls):
        try:
            refused(error, call, *words)
        except BaseException as fault:
            raise AssertionError(f"call {number}: {type(fault).__name__}: {fault}") from fault
    assert len(calls) >= 60
    assert os.listdir(folder) == ["empty.vtu"]


def test_errors_have_code_place_and_remedy():
    try:
        kw.read("there-is-no-such-file.stl")
    except kw.Error as fault:
        assert (fault.code, fault.remedy) == ("FileError", "check the name")
        assert "there-is-no-such-file.stl" in fault.place and fault.message == str(fault)
        again = pickle.loads(pickle.dumps(fault))
        assert type(again) is kw.FileError and (again.code, str(again)) == (fault.code, str(fault))


def test_five_tasks_in_four_lines():
    """Scan to STEP, points to contours, boundary from numpy, validity of a mesh, warp of an STL."""
    with tempfile.TemporaryDirectory() as folder:
        scan, step = os.path.join(folder, "scan.stl"), os.path.join(folder, "scan.step")
        kw.boundary(kw.source("cube", center=(0.5, 0.5, 0.5))).save(scan)
        kw.trim(scan).save(step)
        assert kw.read(step).curves is not None

        kw.fit(cloud(), tolerance=0.3).contour([8]).save(os.path.join(folder, "c.vtp"))
        assert kw.read(os.path.join(folder, "c.vtp")).GetNumberOfCells() >= 1

        sides = [np.array(side, float) for side in ([(0, 0), (2, 0)], [(2, 0), (2.3, 0.5), (2, 1)], [(2, 1), (0, 1)], [(0, 1), (0, 0)])]
        plate = kw.parameterize(sides)
        assert kw.validate(plate).numbers["verdict"] == "valid"

        folded = kw.mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [0.5, 1]], [[0, 1, 2, 3], [1, 4, 5, 2]])
        grid = kw.Grid()
        grid.SetPoints(folded.GetPoints())
        grid.SetCells(9, folded.GetPolys())  # VTK_QUAD
        assert kw.validate(grid).invalid_cells.tolist() == [1]
        assert kw.validate(grid).undecided_cells.tolist() == []

        bent = kw.spline([[0, 0, 1, 1]] * 3, np.array([[[[x, y, z + 0.5 * x] for x in (0, 1)] for y in (0, 1)] for z in (0, 1)], float))
        kw.warp(scan, bent).save(os.path.join(folder, "bent.stl"))
        before, after = kw.read(scan), kw.read(os.path.join(folder, "bent.stl"))
        assert np.allclose(after.points[:, 2], before.points[:, 2] + 0.5 * before.points[:, 0], atol=1e-6)  # STL has floats


def test_data_can_be_pickled():
    s = kw.fit(cloud(), tolerance=0.3)
    again = pickle.loads(pickle.dumps(s))
    assert type(again) is kw.Grid and np.array_equal(again.control_points, s.control_points)
    assert np.array_equal(again.points, s.points) and again.numbers == s.numbers
    assert list(again.outputs) == list(s.outputs)
    for each in (kw.source("disc"), s.contour([3]), s.outputs["iterations"], kw.parameterize(
            [np.array(side, float) for side in ([(0, 0), (1, 0)], [(1, 0), (1, 1)], [(1, 1), (0, 1)], [(0, 1), (0, 0)])])):
        copy = pickle.loads(pickle.dumps(each))
        assert type(copy) is type(each) and copy.GetNumberOfElements(0) == each.GetNumberOfElements(0)
    assert np.array_equal(pickle.loads(pickle.dumps(kw.source("disc"))).spline_patches[3].weights, kw.source("disc").spline_patches[3].weights)


def test_inputs_of_other_kinds():
    source = kw.vtkSplineSource()
    source.SetShape("annulus-sector")
    assert kw.refine(source, number_of_refinements=1).GetNumberOfCells() == 4 * kw.wrap(source.GetOutputDataObject(0)).GetNumberOfCells()
    sphere = vtkSphere()
    sphere.SetRadius(0.2)
    square = kw.source("square", elements=(8, 8, 1))
    refined = square.refine(mode="implicit-function", implicit_function=sphere, implicit_region="crossed-or-inside")
    assert refined.GetNumberOfCells() > square.GetNumberOfCells()
    tiles = [kw.source("square", center=(x, 0, 0), degree=2) for x in (0, 1)]
    assert kw.stitch(tiles, matching="geometry").GetNumberOfElements(1) >= 2
    curved = [kw.source("line"), "nothing"]
    refused(OSError, lambda: kw.refine(curved), "nothing")


knotwork_testing.main(globals())
