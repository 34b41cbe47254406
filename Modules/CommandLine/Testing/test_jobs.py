# SPDX-License-Identifier: BSD-3-Clause
"""Every job of the program on good input; numbers of the report against independent ones."""
import json
import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

import knotwork_testing
import skeletons


def path(name):
    return knotwork_testing.output("cli/" + name)


def run(*arguments):
    """Runs a job with a report; returns the report."""
    report = path("report.json")
    done = knotwork_testing.run_program(*arguments, "--report", report, "--quiet")
    assert done.returncode == 0, done.stderr
    assert done.stderr == "", done.stderr
    with open(report) as stream:
        return json.load(stream)


def read(reader, name):
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def annulus():
    run("source", "--shape", "annulus-sector", "--elements", 4, 4, 1, "--output", path("annulus.vtu"))
    return path("annulus.vtu")


def test_map_reports_the_numbers_of_its_outputs():
    template = skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, 2001)), path("template.vtp"))
    target = skeletons.write(skeletons.polydata(skeletons.curves(0.1, 5, 200)), path("target.vtp"))
    report = run("map", template, target, "--output", path("map.vtu"), "--mapped", path("mapped.vtp"),
                 "--table", path("table.csv"), "--iterations", 5, "--method", "pdm", "--threads", 1)
    assert report["functions"] == (11 + 4) ** 2  # inner knots + degree + 1 a direction
    assert report["iterations"] == 5 and report["method"] == "pdm" and report["tikhonov_weight"] == 0.02
    errors = report["squared_l2_errors"]
    assert errors[-1] == report["squared_l2_error"] < 1e-3 * 0.25 < errors[0] * 1e3
    assert report["negative_jacobian_percents"][-1] == report["negative_jacobian_percent"]
    assert 0 < report["seconds"] and 0 < report["cpu_seconds"] and 0 < report["seconds_io"]
    # the two-sided maximum is at least that of the mapped skeleton's own points
    mapped = read(vtkXMLPolyDataReader(), path("mapped.vtp"))
    distance = vtk_to_numpy(mapped.GetPointData().GetArray("Distance"))
    assert distance.max() <= report["max_error"] * (1 + 1e-9)
    with open(path("table.csv")) as stream:
        assert len(stream.readlines()) == 1 + len(errors)


def test_fixed_pdm_and_tdm_reach_the_published_pattern():
    template = skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, 2001)), path("template.vtp"))
    target = skeletons.write(skeletons.polydata(skeletons.curves(0.2, 5, 200)), path("target.vtp"))
    errors = [run("map", template, target, "--output", path("map.vtu"), "--method", method, "--guard", "off")["squared_l2_error"]
              for method in ("fixed", "pdm", "tdm")]
    assert errors[0] > errors[1] > errors[2], errors


def lobed_case(samples=1001, **shape):
    target = {"amplitude": 0.2, "lobes": 5, "samples": 200, **shape}
    return (skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, samples)), path("template.vtp")),
            skeletons.write(skeletons.polydata(skeletons.curves(**target)), path("target.vtp")))


def test_skewed_targets_are_regular_with_the_guard():
    case = lobed_case(2001, amplitude=0.3, lobes=6, skew=0.8)
    folded = run("map", *case, "--output", path("folded.vtu"), "--guard", "off")
    regular = run("map", *case, "--output", path("regular.vtu"))
    assert regular["guard"] == "on" and folded["guard"] == "off"
    assert folded["negative_jacobian_percent"] > 1 and folded["min_jacobian_bound"] < 0, folded
    assert folded["injective"] == "not_injective"
    assert regular["negative_jacobian_percent"] == 0 and regular["min_jacobian_bound"] > 0, regular
    assert regular["injective"] == "injective" and sum(regular["held_elements"]) > 0
    assert regular["squared_l2_error"] <= folded["squared_l2_error"]
    # The written map, read again.
    verdict = run("validate", path("regular.vtu"))
    assert verdict["verdict"] == "valid" and verdict["injective"] == "injective"
    done = knotwork_testing.run_program("validate", path("folded.vtu"))
    assert done.returncode != 0, done.stdout


def test_local_refinement_takes_fewer_functions():
    case = lobed_case()
    report = {kind: run("map", *case, "--output", path(kind + ".vtu"), "--refine", kind, "--iterations", 3)
              for kind in ("none", "local", "global")}
    assert report["none"]["functions_per_iteration"] == [225, 225, 225]
    assert report["global"]["functions_per_iteration"] == [225, 729, 2601]
    local = report["local"]["functions_per_iteration"]
    assert local[0] == 225 < local[1] <= local[2] < 729 and local[-1] == report["local"]["functions"]
    assert report["local"]["squared_l2_error"] < 0.1 * report["none"]["squared_l2_error"]
    for kind in report:
        assert run("info", path(kind + ".vtu"))["functions"] == report[kind]["functions"]
        assert run("validate", path(kind + ".vtu"))["verdict"] == "valid"

    def functions(*options):
        return run("map", *case, "--output", path("map.vtu"), "--refine", "local", "--iterations", 4,
                   *options)["functions_per_iteration"]

    base = functions()
    assert functions("--extension", 3)[-1] > base[-1] > functions("--extension", 0)[-1]
    assert functions("--refine-threshold", 1e-3)[-1] < base[-1] < functions("--refine-threshold", 1e-7)[-1]
    assert functions("--refine-threshold", 0, "--refine-share", 0.01)[-1] < functions("--refine-threshold", 0)[-1]
    assert functions("--maximum-functions", 230) == [225] * 4 == functions("--maximum-level", 0)
    every = functions("--refine-every", 2)
    assert every[0] == every[1] < every[2] == every[3]
    assert functions("--refine-every", 0, "--stagnation-ratio", 0.999)[-1] > 225


def test_every_weight_and_end_of_map_has_its_effect():
    case = lobed_case(skew=0.35)

    def error(*options, iterations=4):
        return run("map", *case, "--output", path("map.vtu"), "--iterations", iterations, *options)

    base = error()
    assert base["method"] == "tdm" and base["refine"] == "none" and base["initial_map"] == "identity"
    for name in ("uniformity", "length", "orthogonality", "skewness", "eccentricity", "area", "self_intersection"):
        assert base[name + "_weight"] == 0
        report = error(f"--{name.replace('_', '-')}-weight", 1e-3)
        assert report[name + "_weight"] == 1e-3
        assert report["squared_l2_error"] != base["squared_l2_error"], name
    errors = [error("--method", "weighted", "--pdm-weight", pdm, "--tdm-weight", tdm)["squared_l2_error"]
              for pdm, tdm in ((1, 0), (0, 1), (1, 1))]
    assert len({f"{value:.6e}" for value in errors}) == 3, errors
    assert abs(errors[1] / base["squared_l2_error"] - 1) < 1e-6  # coordinates solved together: rounding
    early = error("--accuracy", 1.01 * base["max_error"], iterations=1000)
    assert early["iterations"] <= 4 and early["max_error"] <= 1.01 * base["max_error"]
    folding = ("--method", "fixed", "--guard", "off")
    assert error(*folding, "--maximum-irregular-share", 0, iterations=20)["iterations"] < 20
    assert error(*folding, iterations=20)["negative_jacobian_percent"] > 0
    assert "injective" not in error("--injectivity", "off")


def test_map_begins_where_it_is_told():
    case = lobed_case()

    def report(*options):
        return run("map", *case, "--output", path("map.vtu"), "--iterations", 2, *options)

    base = report()
    run("map", *case, "--output", path("first.vtu"), "--iterations", 10, "--degree", 2)
    onward = report("--initial", path("first.vtu"))
    assert onward["functions"] == 14**2 and onward["initial"] == path("first.vtu")
    assert onward["squared_l2_error"] < base["squared_l2_error"]
    assert report("--initial-map", "moved")["squared_l2_error"] != base["squared_l2_error"]
    smooth, rough = (report("--initial-map", "quadratic", "--initial-uniformity-weight", weight) for weight in (10, 1e-4))
    assert smooth["squared_l2_errors"][0] > rough["squared_l2_errors"][0]
    assert report("--refine", "held")["functions"] == base["functions"]  # the guard holds nothing back
    assert report("--inner-knots-per-direction", 3, -1, -1)["functions"] == 7 * 15
    wide = report("--domain", -1, 2, -0.5, 1.5)
    assert wide["domain"] == [-1, 2, -0.5, 1.5] and wide["squared_l2_error"] != base["squared_l2_error"]
    bounds = vtk_to_numpy(read(vtkXMLUnstructuredGridReader(), path("map.vtu")).GetCellData().GetArray("ParametricBounds"))
    assert bounds[:, 0].min() == -1 and bounds[:, 1].max() == 2 and bounds[:, 3].max() == 1.5


def test_surfaces_are_mapped_in_space():
    egg = skeletons.ball()
    x = skeletons.points(egg)
    x[:, 1] = 0.5 + (1.2 + 0.4 * (x[:, 0] - 0.5)) * (x[:, 1] - 0.5)
    case = skeletons.write(skeletons.ball(), path("ball.vtp")), skeletons.write(egg, path("egg.vtp"))
    report = run("map", *case, "--output", path("egg.vtu"), "--mapped", path("mapped.vtp"), "--inner-knots", 2,
                 "--iterations", 4, "--domain", 0, 1, 0, 1, 0, 1, "--refine", "local", "--refine-every", 2,
                 "--extension", 1)
    assert report["functions_per_iteration"][:2] == [216, 216] and report["functions"] > 216
    assert report["squared_l2_error"] < 1e-4 and report["min_jacobian_bound"] > 0 and report["injective"] == "injective"
    verdict = run("validate", path("egg.vtu"))
    assert verdict["verdict"] == "valid" and verdict["injective"] == "injective"
    distance = vtk_to_numpy(read(vtkXMLPolyDataReader(), path("mapped.vtp")).GetPointData().GetArray("Distance"))
    assert distance.max() <= report["max_error"] * (1 + 1e-9)


def test_refine_keeps_the_map():
    source = annulus()
    report = run("refine", source, "--output", path("fine.vtu"), "--sphere", 1, 0, 0, 0.2)
    assert report["elements"] > 16
    at = skeletons.write(skeletons.polydata([np.random.default_rng(7).random((50, 2))]), path("at.vtp"))
    run("evaluate", source, at, "--output", path("a.vtp"), "--derivatives", 1, "--patch-id-array", "none")
    run("evaluate", path("fine.vtu"), at, "--output", path("b.vtp"), "--patch-id-array", "none")
    a = points_of(read(vtkXMLPolyDataReader(), path("a.vtp")))
    b = points_of(read(vtkXMLPolyDataReader(), path("b.vtp")))
    assert np.abs(a - b).max() < 1e-14  # a few roundings of numbers of size 1
    radius = np.linalg.norm(a, axis=1)
    assert radius.min() >= 0.5 - 1e-14 and radius.max() <= 1 + 1e-14


def test_probe_inverts_evaluation():
    source = annulus()
    parameters = np.random.default_rng(3).random((40, 2))
    at = skeletons.write(skeletons.polydata([parameters]), path("at.vtp"))
    run("evaluate", source, at, "--output", path("on.vtp"), "--patch-id-array", "none")
    report = run("evaluate", source, path("on.vtp"), "--output", path("probe.vtp"), "--mode", "probe")
    assert report["number_of_points"] == 40 and report["max_distance"] < 1e-12


def test_tessellation_lies_on_the_circle():
    source = annulus()
    report = run("tessellate", source, "--output", path("annulus.vtp"), "--chordal-tolerance", 1e-4)
    surface = read(vtkXMLPolyDataReader(), path("annulus.vtp"))
    assert report["number_of_points"] == surface.GetNumberOfPoints() > 25
    radius = np.linalg.norm(points_of(surface), axis=1)
    assert radius.min() >= 0.5 - 1e-14 and radius.max() <= 1 + 1e-14


def test_warp_sends_points_and_splines_alike():
    source = annulus()
    run("source", "--shape", "square", "--center", 0.5, 0.5, 0, "--size", 0.5, 0.5, 1, "--degree", 3,
        "--output", path("square.vtu"))
    report = run("warp", path("square.vtu"), source, "--output", path("image.vtu"), "--tolerance", 1e-6)
    assert report["max_distance"] <= 1e-6
    info = run("info", path("image.vtu"))
    assert info["patches"] == 1 and info["parametric_dimension"] == 2 and not info["rational"]
    corners = skeletons.write(skeletons.polydata([np.array([(0.25, 0.25), (0.75, 0.25), (0.75, 0.75)])]),
                              path("corners.vtp"))
    run("warp", corners, source, "--output", path("sent.vtp"))
    sent = points_of(read(vtkXMLPolyDataReader(), path("sent.vtp")))
    # radial parameter first: radii 0.5 + u / 2
    assert np.allclose(np.linalg.norm(sent, axis=1), [0.625, 0.875, 0.875], rtol=0, atol=1e-14)


def test_convert_writes_every_encoding_without_loss():
    source = annulus()
    expected = points_of(read(vtkXMLUnstructuredGridReader(), source))
    for encoding in ("ascii", "binary", "appended"):
        run("convert", source, "--output", path("again.vtu"), "--encoding", encoding)
        again = points_of(read(vtkXMLUnstructuredGridReader(), path("again.vtu")))
        assert np.array_equal(again, expected), encoding
    run("convert", source, "--output", path("again.vtpc"))
    assert run("info", path("again.vtpc"))["functions"] == run("info", source)["functions"]


def test_convert_writes_meshes():
    """Triangles of a square of area 1, by every format of triangles."""
    run("source", "--shape", "square", "--output", path("square.vtu"))
    run("tessellate", path("square.vtu"), "--output", path("square.obj"))
    np.savetxt(path("some.xyz"), np.eye(3))
    for ending in ("stl", "ply", "obj", "vtp"):
        run("convert", path("square.obj"), "--output", path("again." + ending))
        run("convert", path("again." + ending), "--output", path("mesh.vtp"))
        triangles, measured = vtkTriangleFilter(), vtkMassProperties()
        triangles.SetInputData(read(vtkXMLPolyDataReader(), path("mesh.vtp")))
        measured.SetInputConnection(triangles.GetOutputPort())
        assert abs(measured.GetSurfaceArea() - 1.0) < 1e-6, ending
    for file in (path("square.vtu"), path("some.xyz")):
        done = knotwork_testing.run_program("convert", file, "--output", path("none.stl"))
        assert done.returncode == 1 and not os.path.exists(path("none.stl")), done.stderr


def test_threads_do_not_change_a_bit():
    template = skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, 501)), path("template.vtp"))
    target = skeletons.write(skeletons.polydata(skeletons.curves(0.1, 3, 100)), path("target.vtp"))
    maps = []
    for threads in (1, 2):
        run("map", template, target, "--output", path("map.vtu"), "--iterations", 3, "--threads", threads)
        maps.append(points_of(read(vtkXMLUnstructuredGridReader(), path("map.vtu"))).copy())
    assert np.array_equal(*maps)


def test_options_are_those_of_the_filters():
    done = knotwork_testing.run_program("map", "--help")
    assert done.returncode == 0
    for option in ("method", "iterations", "degree", "inner-knots", "template-samples", "newton-steps",
                   "tikhonov-weight", "threads", "report", "mapped", "table", "pdm-weight", "tdm-weight",
                   "uniformity-weight", "length-weight", "orthogonality-weight", "skewness-weight", "eccentricity-weight",
                   "area-weight", "self-intersection-weight", "guard", "accuracy", "maximum-irregular-share", "refine",
                   "refine-every", "stagnation-ratio", "refine-threshold", "refine-share", "extension", "maximum-level",
                   "maximum-functions", "initial-map", "initial", "domain", "inner-knots-per-direction", "injectivity"):
        assert "--" + option in done.stdout, option


knotwork_testing.main(globals())
