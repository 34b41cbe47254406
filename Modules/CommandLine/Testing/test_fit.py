# SPDX-License-Identifier: BSD-3-Clause
"""`knotwork fit`: distances are measured again on the written files, by an evaluator of LR surfaces that is written here."""
import csv
import json
import os
import struct

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader, vtkXMLPolyDataWriter

import knotwork_testing


def path(name):
    return knotwork_testing.output("fit/" + name)


def bump(x, y):
    return np.exp(-20 * ((x - 0.6) ** 2 + (y - 0.4) ** 2)) + 0.3 * x * y


def cloud(seed=1, n=3000):
    x, y = np.random.default_rng(seed).random((2, n))
    return np.c_[x, y, bump(x, y)]


def write_xyz(name, points, separator=" ", head=""):
    with open(path(name), "w") as stream:
        stream.write(head)
        stream.writelines(separator.join(f"{value:.17g}" for value in row) + "\n" for row in points)
    return path(name)


def write_vtp(name, points, **arrays):
    data = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetDataTypeToDouble()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    data.SetPoints(coordinates)
    for key, values in arrays.items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
        array.SetName(key)
        data.GetPointData().AddArray(array)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(path(name))
    assert writer.Write() == 1
    return path(name)


def write_ply(name, points):
    with open(path(name), "wb") as stream:
        stream.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
                     "property double x\nproperty double y\nproperty double z\nend_header\n".encode())
        stream.writelines(struct.pack("<3d", *row) for row in points)
    return path(name)


def fit(file, output, *arguments, warns=False):
    """Runs the job and returns its report; what it says on stderr is one warning, if one is due."""
    done = knotwork_testing.run_program("fit", file, "--output", path(output), *arguments, "--report", path("report.json"))
    assert done.returncode == 0, done.stderr
    said = [line for line in done.stderr.splitlines() if line]
    assert len(said) == (1 if warns else 0), done.stderr
    with open(path("report.json")) as stream:
        return json.load(stream)


def read_lr(file):
    """Functions of class 293 as the format's description says: coefficient and the two local knot vectors."""
    words = iter(open(file).read().split())

    def number(kind=float):
        return kind(next(words))

    assert [number(int) for _ in range(4)] == [293, 1, 0, 0]
    assert number(int) == 0
    number()
    knots = [[number() for _ in range(number(int))] for _ in range(2)]
    for _ in range(2):
        for _ in range(number(int)):
            for _ in range(number(int)):
                number(int), number(int)
    functions = []
    for _ in range(number(int)):
        dimension = number(int)
        number(int)
        coefficient = [number() for _ in range(dimension)]
        number(), number()
        functions.append((coefficient, *([knots[d][number(int)] for _ in range(number(int))] for d in range(2))))
    assert next(words, None) is None
    return functions


def b_spline(knots, x, end):
    """Cox and de Boor, for many x."""
    degree = len(knots) - 2
    inside = [((knots[i] <= x) & (x < knots[i + 1])) | ((x == end) & (knots[i] < knots[i + 1]) & (knots[i + 1] == end))
              for i in range(degree + 1)]
    values = [np.where(here, 1.0, 0.0) for here in inside]
    for q in range(1, degree + 1):
        for i in range(degree + 1 - q):
            value = np.zeros_like(x)
            if knots[i + q] > knots[i]:
                value += (x - knots[i]) / (knots[i + q] - knots[i]) * values[i]
            if knots[i + q + 1] > knots[i + 1]:
                value += (knots[i + q + 1] - x) / (knots[i + q + 1] - knots[i + 1]) * values[i + 1]
            values[i] = value
    return values[0]


def evaluate_lr(file, u, v):
    functions = read_lr(file)
    end_u = max(f[1][-1] for f in functions)
    end_v = max(f[2][-1] for f in functions)
    result = np.zeros((len(u), len(functions[0][0])))
    for coefficient, ku, kv in functions:
        rows = np.flatnonzero((ku[0] <= u) & (u <= ku[-1]) & (kv[0] <= v) & (v <= kv[-1]))
        result[rows] += np.outer(b_spline(ku, u[rows], end_u) * b_spline(kv, v[rows], end_v), coefficient)
    return result


def read_points(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path(name))
    reader.Update()
    data = reader.GetOutput()
    arrays = {data.GetPointData().GetArrayName(i): vtk_to_numpy(data.GetPointData().GetArray(i))
              for i in range(data.GetPointData().GetNumberOfArrays())}
    return vtk_to_numpy(data.GetPoints().GetData()), arrays


def evaluate_grid(name, u, v, *arguments):
    """Values of the surface (and fields) by `knotwork evaluate`, at points of the parameter domain."""
    uv = write_vtp("uv.vtp", np.c_[u, v, 0 * u])
    done = knotwork_testing.run_program("evaluate", path(name), uv, "--output", path("values.vtp"), *arguments)
    assert done.returncode == 0, done.stderr
    return read_points("values.vtp")


def test_written_surface_has_the_reported_errors_CrossOracle():
    points = cloud()
    file = write_xyz("bump.xyz", points)
    for tolerance in (1e-2, 1e-3):
        report = fit(file, "bump.g2", "--tolerance", tolerance, "--points", path("out.vtp"), "--table", path("out.csv"))
        x = evaluate_lr(path("bump.g2"), points[:, 0], points[:, 1])
        assert np.abs(x[:, :2] - points[:, :2]).max() < 1e-14  # u and v themselves, to rounding
        distance = points[:, 2] - x[:, 2]
        errors = np.abs(distance)
        assert errors.max() <= tolerance
        rounding = 1e-13
        assert abs(errors.max() - report["max_error"]) < rounding
        assert abs(errors.mean() - report["mean_error"]) < rounding
        assert report["within_tolerance"] is True and report["points_outside"] == 0
        assert report["functions"] == len(read_lr(path("bump.g2"))) and report["points"] == len(points)
        _, arrays = read_points("out.vtp")
        assert np.abs(arrays["Distance"] - distance).max() < rounding
        assert (arrays["Tolerance"] == tolerance).all() and not arrays["Outlier"].any()
        rows = list(csv.DictReader(open(path("out.csv"))))
        assert len(rows) == report["iterations"] + 1  # iterations from 0
        assert int(rows[-1]["Functions"]) == report["functions"]
        assert int(rows[0]["PointsOutside"]) > 0
        for key in ("seconds", "cpu_seconds", "peak_bytes", "iterations"):
            assert report[key] > 0, key


def test_spaces_and_formats_hold_the_same_surface_CrossOracle():
    points = cloud(2)
    file = write_xyz("bump.txt", points)
    for space in ("lr", "thb"):
        report = fit(file, "bump.vtu", "--tolerance", 1e-3, "--space", space)
        values, _ = evaluate_grid("bump.vtu", points[:, 0], points[:, 1])
        errors = np.abs(values[:, 2] - points[:, 2])
        assert errors.max() <= 1e-3 and abs(errors.max() - report["max_error"]) < 1e-13, space
        assert np.abs(values[:, :2] - points[:, :2]).max() < 1e-14
    assert fit(file, "bump.xml", "--tolerance", 1e-3, "--space", "thb")["within_tolerance"]
    # 17 digits in every format: the same bits
    fit(file, "first.g2", "--tolerance", 1e-3)
    with open(path("first.g2")) as stream:
        first = stream.read()
    g2 = f"400 1 0 0\n{len(points)}\n"
    for other in (write_xyz("b.xyz", points), write_xyz("b.csv", points, ","), write_xyz("c.csv", points, ";", "X;Y;Z\n"),
                  write_xyz("b.g2", points, head=g2), write_ply("b.ply", points), write_vtp("b.vtp", points)):
        fit(other, "other.g2", "--tolerance", 1e-3)
        with open(path("other.g2")) as stream:
            assert stream.read() == first, other
    for threads in (1, 2, 4):
        fit(file, "other.g2", "--tolerance", 1e-3, "--threads", threads)
        with open(path("other.g2")) as stream:
            assert stream.read() == first, threads


def test_a_start_is_updated_where_the_points_are():
    """The LR surfaces before and after as the g2 files say, evaluated here."""
    whole = write_xyz("whole.xyz", cloud(31))
    fit(whole, "start.g2", "--tolerance", 2e-3, "--domain", 0, 1, 0, 1)
    random = np.random.default_rng(32)
    corner = 0.2 * random.random((500, 2))
    z = bump(*corner.T) + 0.05 * np.exp(-500 * ((corner - 0.08) ** 2).sum(1))
    new = write_xyz("new.xyz", np.c_[corner, z])
    report = fit(new, "update.g2", "--start", path("start.g2"), "--tolerance", 2e-3, "--hold-edges", "values",
                 "--held-sides", 1, 0, 0, 0)
    assert report["within_tolerance"] and report["start"] == path("start.g2") and report["hold_edges"] == "values", report
    before, after = (read_lr(path(name)) for name in ("start.g2", "update.g2"))

    def height(functions, x, y):
        return sum(c[-1] * b_spline(u, x, 1.0) * b_spline(v, y, 1.0) for c, u, v in functions)

    assert np.abs(height(after, *corner.T) - z).max() <= 2e-3
    assert np.abs(height(before, *corner.T) - z).max() > 0.02
    x, y = random.random((2, 500))
    far = (x > 0.7) | (y > 0.7)
    # files hold all digits; both sums have other terms
    assert np.abs(height(after, x, y) - height(before, x, y))[far].max() < 1e-13
    assert np.abs(height(after, 0 * y, y) - height(before, 0 * y, y)).max() < 1e-13
    assert np.abs(height(after, x, 0 * x) - height(before, x, 0 * x)).max() > 1e-5
    done = knotwork_testing.run_program("fit", new, "--start", whole, "--output", path("a.vtu"))
    assert done.returncode == 1 and "whole.xyz" in done.stderr, done.stderr
    done = knotwork_testing.run_program("fit", new, "--hold-edges", "values", "--output", path("a.vtu"))
    assert done.returncode == 1 and "start surface" in done.stderr, done.stderr


def test_factors_and_significant_points_are_reported():
    """Measured anew on the points that the job writes."""
    points = cloud(33)
    points[:, 2] += 0.004 * np.random.default_rng(34).random(len(points))
    mark = points[:, 0] < 0.3
    file = write_vtp("marked.vtp", points, Mark=mark.astype(float))
    report = fit(file, "marked.vtu", "--tolerance", 2e-3, "--tolerance-factor-above", 1.5, "--tolerance-factor-below", 0.9,
                 "--significant-array", "Mark", "--points", path("far.vtp"))
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path("far.vtp"))
    reader.Update()
    data = reader.GetOutput().GetPointData()
    distance, tolerance = (vtk_to_numpy(data.GetArray(name)) for name in ("Distance", "Tolerance"))
    assert np.allclose(tolerance, 2e-3 * np.where(distance > 0, 1.5, 0.9), rtol=1e-14)
    assert report["within_tolerance"] and distance.max() > 2e-3 and distance.max() <= 3e-3 and distance.min() >= -1.8e-3
    assert report["significant_points"] == mark.sum() and report["significant_outside"] == 0
    sizes = np.abs(distance[mark])
    assert np.allclose([report["max_significant_error"], report["mean_significant_error"]], [sizes.max(), sizes.mean()], rtol=1e-12)


def test_both_spaces_are_written_in_every_format():
    """The same map as a tensor product where a format has no other kind: its distances from the points are those of the fit."""
    file = write_xyz("cliff.xyz", cloud(4, 1500))
    for space in ("lr", "thb"):
        distances = {}
        for ending in (".vtu", ".g2", ".xml", ".step", ".iges"):
            name = space + "_all" + ending
            done = knotwork_testing.run_program("fit", file, "--space", space, "--tolerance", 2e-3, "--output", path(name))
            assert done.returncode == 0, (name, done.stderr)
            own = ending in (".vtu", ".g2" if space == "lr" else ".xml")
            assert ("tensor product of" in done.stderr) != own, (name, done.stderr)
            done = knotwork_testing.run_program("distance", file, path(name), "--kind", "closest", "--output", path("far.vtp"),
                                                "--report", path("far.json"), "--quiet")
            assert done.returncode == 0, (name, done.stderr)
            with open(path("far.json")) as stream:
                report = json.load(stream)
            distances[ending] = (report["max_distance"], report["rms_distance"])
        for ending, found in distances.items():
            # closest points by iterations that end at 1e-10 of the size
            assert np.allclose(found, distances[".vtu"], rtol=0, atol=1e-8), (space, ending, distances)


def test_a_surface_too_large_for_its_format_is_not_lost():
    """A cliff along the diagonal: the tensor product of its lines would have more than a million functions."""
    random = np.random.default_rng(3)
    along, across = random.random(20000), random.uniform(-0.004, 0.004, 20000)
    x, y = along + across, along - across
    file = write_xyz("diagonal.xyz", np.column_stack([x, y, np.tanh((x - y) * 400)]))
    for ending in (".step", ".g2", ".iges"):
        arguments = ["fit", file, "--space", "thb" if ending == ".g2" else "lr", "--tolerance", 1e-3, "--initial-elements-u", 16,
                     "--initial-elements-v", 16, "--report", path("diagonal.json"), "--quiet", "--output", path("diagonal" + ending)]
        for name in ("diagonal.vtu", "diagonal" + ending):
            if os.path.exists(path(name)):
                os.remove(path(name))
        done = knotwork_testing.run_program(*arguments)
        assert done.returncode == 5, (ending, done.returncode, done.stderr)
        assert not os.path.exists(path("diagonal" + ending))
        with open(path("diagonal.json")) as stream:
            report = json.load(stream)
        assert "as a tensor product" in report["left_out"][0] and path("diagonal.vtu") in report["left_out"][0], report["left_out"]
        done = knotwork_testing.run_program("info", path("diagonal.vtu"))
        assert done.returncode == 0 and "%d functions" % report["functions"] in done.stdout, (done.stdout, done.stderr)
        # distances have signs, errors have none
        done = knotwork_testing.run_program("distance", file, path("diagonal.vtu"), "--kind", "vertical", "--output",
                                            path("far.vtp"), "--report", path("far.json"), "--quiet")
        assert done.returncode == 0, done.stderr
        with open(path("far.json")) as stream:
            far = json.load(stream)
        assert abs(max(-far["min_distance"], far["max_distance"]) - report["max_error"]) < 1e-12, (far, report["max_error"])
        # a file of that name is somebody's
        done = knotwork_testing.run_program(*arguments)
        assert done.returncode == 1 and "as a tensor product" in done.stderr, (done.returncode, done.stderr)


def test_endings_are_those_of_the_file_in_small_letters():
    file = write_xyz("bump.txt", cloud(2, 200))
    os.makedirs(path("run.g2"), exist_ok=True)
    for output in ("run.g2/thb.vtu", "thb.g2.XML"):
        assert fit(file, output, "--tolerance", 0.1, "--space", "thb")["within_tolerance"], output
    done = knotwork_testing.run_program("fit", file, "--output", path("thb.G2"), "--tolerance", 0.1, "--space", "thb")
    assert done.returncode == 0, done.stderr
    for output in ("run.g2/again.VTU", "run.g2/again.Vtpc"):
        done = knotwork_testing.run_program("convert", path("run.g2/thb.vtu"), "--output", path(output))
        assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("contour", path("run.g2/again.VTU"), "--output", path("LINES.VTP"))
    assert done.returncode == 0, done.stderr


def test_large_coordinates_CrossOracle():
    points = cloud(3, 5000) * (3000, 2000, 400) + (5e5, 5.2e6, 100)
    for space, output in (("lr", "utm.g2"), ("thb", "utm.vtu")):
        report = fit(write_xyz("utm.xyz", points), output, "--tolerance", 0.1, "--space", space)
        assert report["within_tolerance"] is True
        if space == "lr":
            values = evaluate_lr(path(output), points[:, 0], points[:, 1])
        else:
            values, _ = evaluate_grid(output, points[:, 0], points[:, 1])
        assert np.abs(values[:, 2] - points[:, 2]).max() <= 0.1
        # half a unit in the last place of 5.2e6 a rounding, some sixteen of them
        assert np.abs(values[:, :2] - points[:, :2]).max() < 16 * 0.5 * 2.0 ** -30
    # the fit itself is that of the cloud moved to the origin, up to rounding
    near = fit(write_xyz("near.xyz", points - (5e5, 5.2e6, 0)), "near.g2", "--tolerance", 0.1)
    assert abs(near["functions"] - fit(write_xyz("utm.xyz", points), "utm.g2", "--tolerance", 0.1)["functions"]) <= 2


def test_surfaces_in_space_with_fields_CrossOracle():
    u, v = np.random.default_rng(4).random((2, 4000))
    shape = np.c_[np.cos(2 * u), np.sin(2 * u), v + 0.1 * np.sin(5 * u)]
    velocity = np.c_[np.sin(u + v), u * v]
    file = write_vtp("roll.vtp", shape, Uv=np.c_[u, v], Velocity=velocity, Heat=np.cos(3 * u))
    report = fit(file, "roll.vtu", "--parameterization", "given", "--parameter-array", "Uv", "--field", "Velocity",
                 "--field", "Heat", "--tolerance", 1e-3, "--points", path("out.vtp"))
    assert report["within_tolerance"] is True
    values, arrays = evaluate_grid("roll.vtu", u, v)
    errors = np.linalg.norm(values - shape, axis=1)
    assert errors.max() <= 1e-3 and abs(errors.max() - report["max_error"]) < 1e-12
    assert np.abs(arrays["Velocity"] - velocity).max() < 5e-3 and np.abs(arrays["Heat"] - np.cos(3 * u)).max() < 5e-3
    assert np.allclose(read_points("out.vtp")[1]["Distance"], errors, atol=1e-12)
    # wrong parameters, corrected: distances are those at the parameters that are written
    off = np.clip(np.c_[u, v] + 0.02 * np.random.default_rng(6).uniform(-1, 1, (4000, 2)), 0, 1)
    wrong = write_vtp("wrong.vtp", shape, Uv=off)
    report = fit(wrong, "wrong.vtu", "--parameterization", "given", "--parameter-array", "Uv", "--tolerance", 2e-3,
                 "--correct-parameters", "--points", path("out.vtp"))
    assert report["within_tolerance"] is True and report["functions"] < 1000, report
    _, arrays = read_points("out.vtp")
    values, _ = evaluate_grid("wrong.vtu", *arrays["UV"].T)
    assert np.linalg.norm(values - shape, axis=1).max() <= 2e-3
    # without parameters: a projection on the plane of least squares, or a message that it folds
    tilted = np.c_[u, v, 0.2 * np.sin(3 * u) * v] @ np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    report = fit(write_xyz("tilted.xyz", tilted), "tilted.vtu", "--parameterization", "computed", "--tolerance", 1e-3,
                 "--points", path("out.vtp"))
    assert report["within_tolerance"] is True
    _, arrays = read_points("out.vtp")
    values, _ = evaluate_grid("tilted.vtu", *arrays["UV"].T)
    assert np.linalg.norm(values - tilted, axis=1).max() <= 1e-3


def test_tolerances_of_points_boxes_and_sides_CrossOracle():
    points = cloud(6)
    inside = (points[:, 0] < 0.5) & (points[:, 1] < 0.5)
    file = write_vtp("t.vtp", points, Limit=np.where(inside, 1e-4, 1e-2), Peak=(points[:, 2] > 0.95).astype(float))

    def distances(*arguments):
        report = fit(file, "t.g2", *arguments, "--points", path("out.vtp"))
        assert report["within_tolerance"] is True, arguments
        d = points[:, 2] - evaluate_lr(path("t.g2"), points[:, 0], points[:, 1])[:, 2]
        assert np.abs(np.abs(d).max() - report["max_error"]) < 1e-13
        return d, read_points("out.vtp")[1]["Tolerance"]

    for arguments in (("--tolerance-array", "Limit"),
                      ("--tolerance", 1e-2, "--tolerance-box", 0, 0.5, 0, 0.5, 1e-4)):
        d, tolerances = distances(*arguments)
        assert (np.abs(d) <= tolerances).all()
        assert np.array_equal(tolerances[inside], np.full(inside.sum(), 1e-4)) and tolerances.max() == 1e-2
    d, tolerances = distances("--tolerance", 1e-3, "--distance-mode", "point", "--distance-slope", 0.05,
                              "--distance-centre", 0.5, 0.5)
    expected = 1e-3 + 0.05 * np.hypot(*(points[:, :2] - 0.5).T)
    assert np.abs(tolerances - expected).max() < 1e-15 and (np.abs(d) <= tolerances).all()
    rounding = 1e-14
    d, _ = distances("--tolerance", 1e-2, "--side", "above")  # no point above the surface
    assert d.max() <= rounding and d.min() >= -1e-2
    d, _ = distances("--tolerance", 1e-2, "--side", "below")
    assert d.min() >= -rounding and d.max() <= 1e-2
    report = fit(file, "t.g2", "--tolerance", 1e-2, "--significant-array", "Peak", "--significant-weight", 100)
    assert report["significant_array"] == "Peak"


def test_outliers_are_a_mask():
    points = cloud(7, 10000)
    random = np.random.default_rng(8)
    points[:, 2] += 0.002 * random.normal(size=len(points))
    wild = random.random(len(points)) < 0.01
    points[wild, 2] += 0.5
    report = fit(write_xyz("o.xyz", points), "o.g2", "--tolerance", 0.012, "--find-outliers", 1, "--points", path("out.vtp"))
    mask = read_points("out.vtp")[1]["Outlier"] == 1
    assert report["outliers"] == mask.sum()
    assert (mask & wild).sum() >= 0.95 * wild.sum() and (mask & ~wild).sum() <= 0.02 * wild.sum() + 1


def test_truth_values_stand_alone_or_with_a_value():
    file = write_xyz("t.xyz", cloud(14, 500))
    for value, expected in (([], False), (["--find-outliers"], True), (["--find-outliers", 1], True), (["--find-outliers", 0], False),
                            (["--find-outliers=0"], False), (["--find-outliers=True"], True), (["--find-outliers", "OFF"], False),
                            (["--find-outliers", "on"], True), (["--find-outliers", "--all-fields", 0], True)):
        assert fit(file, "t.g2", *value)["find_outliers"] is expected, value
    # what follows is the file, not a value
    done = knotwork_testing.run_program("fit", "--find-outliers", file, "--output", path("t.g2"), "--report", path("r.json"))
    assert done.returncode == 0, done.stderr
    with open(path("r.json")) as stream:
        assert json.load(stream)["find_outliers"] is True
    # all jobs with files as input: with a missing one they end with 1, with a wrong option with 2
    checked = 0
    for job, files in (("combine", 2), ("contour", 1), ("extract", 1), ("extrema", 1), ("fit", 1), ("flatten", 1), ("refine", 1),
                       ("tessellate", 1), ("validate", 1), ("warp", 2)):
        lines = knotwork_testing.run_program(job, "--help").stdout.splitlines()
        options = [line.split()[0] for line in lines if "[0|1]=" in line]
        assert options, job
        inputs = [path(f"missing{i}.vtu") for i in range(files)]
        every = [word for option in options for word in ([option], [option, "false"], [option + "=1"])]
        words = [word for group in every for word in group]
        more = ["--levels", 1] if job == "contour" else []
        output = path("t.vtp" if job in ("extrema", "flatten") else "t.vtu")
        done = knotwork_testing.run_program(job, *words, *inputs, "--output", output, *more)
        assert done.returncode == 1 and "missing" in done.stderr, (job, done.stderr)
        done = knotwork_testing.run_program(job, *inputs, "--output", output, *more, options[0] + "=maybe")
        assert done.returncode == 2, (job, done.stderr)
        checked += len(options)
    assert checked >= 20


def test_limits_end_the_fit_with_a_warning():
    points = cloud(9)
    file = write_xyz("l.xyz", points)
    report = fit(file, "l.g2", "--tolerance", 1e-5, "--maximum-iterations", 1, warns=True)
    assert report["within_tolerance"] is False and report["points_outside"] > 0 and report["iterations"] == 1
    d = points[:, 2] - evaluate_lr(path("l.g2"), points[:, 0], points[:, 1])[:, 2]
    assert (np.abs(d) > 1e-5).sum() == report["points_outside"]
    report = fit(file, "l.g2", "--tolerance", 1e-5, "--maximum-functions", 200, warns=True)
    assert report["functions"] <= 200 and report["within_tolerance"] is False
    for arguments, reason in ((("--maximum-iterations", 1), "limit of iterations"), (("--maximum-functions", 200), "limit of functions"),
                              (("--maximum-seconds", 1e-9), "limit of time")):
        done = knotwork_testing.run_program("fit", file, "--output", path("l.g2"), "--tolerance", 1e-5, *arguments)
        assert done.returncode == 0 and reason in done.stderr, done.stderr
    again = np.r_[points, points[:5] + (0, 0, 0.1)]  # in the same place, at another height
    done = knotwork_testing.run_program("fit", write_xyz("l.xyz", again), "--output", path("l.g2"), "--tolerance", 1e-3)
    assert done.returncode == 0 and "contradict" in done.stderr, done.stderr
    noise = np.c_[points[:, :2], np.random.default_rng(10).random(len(points))]
    for arguments, reason in ((("--criterion", "bic"), "information criterion has ended"), (("--minimum-element-size", 0.1), "not split any smaller")):
        done = knotwork_testing.run_program("fit", write_xyz("l.xyz", noise), "--output", path("l.g2"), "--tolerance", 1e-2, *arguments)
        assert done.returncode == 0 and reason in done.stderr, done.stderr


def test_few_points_have_a_surface_too():
    for name, points in (("one", [[0.5, 0.5, 1]]), ("line", [[i / 7, 0.5, (i / 7) ** 2] for i in range(8)]),
                         ("same", [[0.5, 0.5, 1]] * 20)):
        points = np.array(points, float)
        report = fit(write_xyz(name + ".xyz", points), name + ".g2", "--tolerance", 1e-3)
        d = points[:, 2] - evaluate_lr(path(name + ".g2"), points[:, 0], points[:, 1])[:, 2]
        assert np.abs(d).max() <= 1e-3 and report["within_tolerance"] is True, name


def test_features_of_the_elements():
    """The file of the elements of every iteration against the table: numbers, largest errors, areas that fill the domain."""
    file = write_xyz("e.xyz", cloud(35))
    fit(file, "e.vtu", "--tolerance", 2e-3, "--element-features", "--feature-iterations", "--elements", path("e.vtp"),
        "--table", path("e.csv"), "--domain", 0, 1, 0, 1, "--feature-grid-size", 3, "--features", path("e.vti"))
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path("e.vtp"))
    reader.Update()
    data = reader.GetOutput().GetCellData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    with open(path("e.csv"), newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) > 2
    for row in rows:
        own = arrays["Iteration"] == int(row["Iteration"])
        assert own.sum() == int(row["Elements"]) and arrays["NumPoints"][own].sum() == 3000
        assert arrays["NumOutside"][own].sum() == int(row["PointsOutside"])
        assert np.isclose(arrays["MaxError"][own].max(), float(row["MaxError"]), rtol=1e-5, atol=0)  # a table has six digits
        assert abs(arrays["ElementSize"][own].sum() - 1) < 1e-12
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path("e.vti"))
    reader.Update()
    assert reader.GetOutput().GetNumberOfCells() == 9 * len(rows)


def test_feature_grid():
    points = cloud(10)
    fit(write_xyz("f.xyz", points), "f.g2", "--tolerance", 1e-3, "--feature-grid-size", 10, "--features", path("f.vti"))
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path("f.vti"))
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetDimensions() == (11, 11, 1)
    counts = vtk_to_numpy(grid.GetCellData().GetArray("NumPoints"))
    low, high = points[:, :2].min(0), points[:, :2].max(0)
    expected = np.histogram2d(points[:, 1], points[:, 0], 10, ((low[1], high[1]), (low[0], high[0])))[0]
    assert np.array_equal(counts.reshape(10, 10), expected)
    middle = low + (high - low) * (np.array([[3, 7]]) + 0.5) / 10
    height = vtk_to_numpy(grid.GetCellData().GetArray("Height")).reshape(10, 10)[7, 3]
    assert abs(height - evaluate_lr(path("f.g2"), *middle.T)[0, 2]) < 1e-13


def test_clouds_are_converted_without_loss_PropertyOracle():
    points = np.c_[cloud(11, 200), np.arange(200) / 7]
    first = write_xyz("c.xyz", points, head="# x y z heat\n")
    for chain in (("a.csv", "b.txt", "c.vtp", "d.xyz"), ("a.vtp", "d.xyz")):
        file = first
        for name in chain:
            done = knotwork_testing.run_program("convert", file, "--output", path(name))
            assert done.returncode == 0 and done.stderr == "", done.stderr
            file = path(name)
        again = np.loadtxt(file)
        assert np.array_equal(again, points), chain
    done = knotwork_testing.run_program("convert", first, "--output", path("e.g2"))
    assert done.returncode == 0 and "left out" in done.stderr, done.stderr
    assert np.array_equal(np.loadtxt(path("e.g2"), skiprows=2), points[:, :3])
    done = knotwork_testing.run_program("info", path("c.xyz"), "--report", path("info.json"))
    assert done.returncode == 0 and "200 points" in done.stdout, done.stdout
    with open(path("info.json")) as stream:
        report = json.load(stream)
    assert report["points"] == 200 and report["arrays"] == ["heat"] and report["upper"][2] == points[:, 2].max()


def refused(arguments, *words, status=1):
    output = path("refused.g2")
    if os.path.exists(output):
        os.remove(output)
    done = knotwork_testing.run_program("fit", *arguments, "--output", output)
    assert done.returncode == status, (arguments, done.returncode, done.stderr)
    if status == 1:
        assert len(done.stderr.splitlines()) == 1, done.stderr
        for word in words:
            assert word in done.stderr, (word, done.stderr)
    assert not os.path.exists(output)


def write_text(name, text):
    with open(path(name), "w") as stream:
        stream.write(text)
    return path(name)


def test_every_bad_cloud_is_refused_with_its_place():
    good = cloud(12, 100)
    lines = [" ".join(map(str, row)) for row in good]

    def spoiled(line):
        return "\n".join(lines[:49] + [line] + lines[50:]) + "\n"

    for name, text, words in (
            ("empty", "", ["no points"]), ("comments", "# nothing\n\n", ["no points"]),
            ("nan", spoiled("0.5 nan 1"), ["line 50, column 2", "'nan'"]),
            ("inf", spoiled("0.5 0.5 -inf"), ["line 50, column 3", "'-inf'"]),
            ("word", spoiled("0.5 0.5 high"), ["line 50, column 3", "'high'", "correct or remove"]),
            ("short", spoiled("0.5 0.5"), ["line 50", "2 columns"]), ("long", spoiled("1 2 3 4"), ["line 50", "4 columns"]),
            ("range", spoiled("0.5 0.5 1e999"), ["line 50", "1e999"]),
            ("huge", spoiled("0.5 0.5 1e308"), ["point 49"]), ("far", spoiled("1e308 0.5 1"), ["point 49"]),
            ("cut", "\n".join(lines)[:-25].rsplit(" ", 1)[0], ["truncated"]),
            ("two", "1 2\n3 4\n", ["2 columns"]),
            ("binary", "\x7fELF\x00\x01\x02\n" * 5, ["line 1"])):
        refused([write_text(name + ".xyz", text)], name + ".xyz", *words)
    for name, text, words in (
            ("count", "400 1 0 0\n5\n1 2 3\n", ["truncated"]), ("many", "400 1 0 0\n2000000000\n1 2 3\n", ["truncated"]),
            ("none", "400 1 0 0\n0\n", ["no point cloud"])):
        refused([write_text(name + ".g2", text)], name + ".g2", *words)
    ply = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n")
    for cut in range(0, len(ply), 7):
        refused([write_text("cut.ply", ply[:cut])], "cut.ply")
    refused([path("missing.xyz")], "missing.xyz", "not a file")


def test_arrays_and_options_that_do_not_fit_are_refused():
    points = cloud(13, 200)
    limits = np.full(200, 0.01)
    file = write_vtp("a.vtp", points, Limit=limits, Bad=np.where(np.arange(200) == 17, np.nan, 0.01),
                     Zero=np.where(np.arange(200) == 17, 0.0, 0.01), Three=points)
    refused([file, "--tolerance-array", "Nothing"], "a.vtp", "'Nothing'")
    refused([file, "--tolerance-array", "Bad"], "a.vtp", "17")
    refused([file, "--tolerance-array", "Zero"], "a.vtp", "17")
    refused([file, "--field", "Nothing"], "a.vtp", "'Nothing'")
    refused([file, "--field", "Bad"], "a.vtp", "17")
    refused([file, "--parameterization", "given"], "a.vtp", "parameters")
    refused([file, "--parameterization", "given", "--parameter-array", "Limit"], "a.vtp", "'Limit'", "rows of 2")
    refused([file, "--significant-array", "Nothing"], "a.vtp", "'Nothing'")
    refused([file, "--domain", 0.2, 0.4, 0.2, 0.4], "a.vtp", "point")
    refused([file, "--tolerance-box", 0, 1, 0, 1, -1], "a.vtp", "tolerance")
    sphere = np.random.default_rng(14).normal(size=(2000, 3))
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    angles = np.c_[np.arctan2(sphere[:, 1], sphere[:, 0]), np.arcsin(sphere[:, 2])]
    closed = write_vtp("sphere.vtp", sphere, XY=sphere[:, :2].copy(), Angles=angles)
    for choice in (["height-field"], ["computed"], ["given", "--parameter-array", "XY"]):
        refused([closed, "--parameterization", *choice], "sphere.vtp", "layers", "`trim`")
    refused([write_xyz("sphere.xyz", sphere)], "sphere.xyz", "layers")
    output = path("angles.vtu")
    done = knotwork_testing.run_program("fit", closed, "--parameterization", "given", "--parameter-array", "Angles", "--tolerance", 0.1,
                                        "--output", output, "--quiet")
    assert done.returncode == 0, done.stderr
    for usage in (["--tolerance", -1], ["--degree", 0], ["--degree", 10], ["--space", "nurbs"], ["--side", "left"],
                  ["--outlier-scale", 0], ["--domain", 0, 1], ["--tolerance-box", 1, 2, 3], ["--smoothing", -1]):
        refused([file, *usage], status=2)


knotwork_testing.main(globals())
