# SPDX-License-Identifier: BSD-3-Clause
"""The jobs validate and parameterize: verdicts, exit statuses, numbers of the reports."""
import json
import math
import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

import knotwork_testing


def path(name):
    return knotwork_testing.output("cli_validate/" + name)


def run(status, *arguments):
    """Runs a job that must end with the status; returns its report and what it printed."""
    report = path("report.json")
    done = knotwork_testing.run_program(*arguments, "--report", report, "--quiet")
    assert done.returncode == status, (done.returncode, done.stderr)
    with open(report) as stream:
        return json.load(stream), done


def read(name):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def annulus(name="annulus.vtu", move=None):
    knotwork_testing.run_program("source", "--shape", "annulus-sector", "--elements", 4, 4, 1, "--output", path(name))
    if move:
        grid = read(path(name))
        points = vtk_to_numpy(grid.GetPoints().GetData())
        points[grid.GetCell(5).GetPointId(0)] += move
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(path(name))
        writer.SetInputData(grid)
        writer.Write()
    return path(name)


def quadrilaterals(name, corners, patches=None):
    """A file of linear quadrilaterals, each with points of its own."""
    grid, points, ids = vtkUnstructuredGrid(), vtkPoints(), vtkIntArray()
    points.SetDataTypeToDouble()
    for cell in corners:
        grid.InsertNextCell(VTK_QUAD, 4, [points.InsertNextPoint(x, y, 0) for x, y in cell])
    grid.SetPoints(points)
    if patches:
        ids.SetName("PatchId")
        for patch in patches:
            ids.InsertNextValue(patch)
        grid.GetCellData().AddArray(ids)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path(name))
    writer.SetInputData(grid)
    assert writer.Write() == 1
    return path(name)


def band(degrees, steps=40):
    """Corners of cells between the radii 1 and 2 from 0 to so many degrees."""
    def at(i, radius):
        angle = math.radians(degrees * i / steps)
        return radius * math.cos(angle), radius * math.sin(angle)
    return [(at(i, 1), at(i, 2), at(i + 1, 2), at(i + 1, 1)) for i in range(steps)]


def said(name, status, *arguments):
    """What validate prints about a file."""
    done = knotwork_testing.run_program("validate", path(name), *arguments)
    assert done.returncode == status, (done.returncode, done.stderr)
    return done.stdout.strip()


def test_valid_grid():
    report, _ = run(0, "validate", annulus(), "--output", path("annotated.vtu"), "--table", path("table.csv"))
    assert report["verdict"] == "valid" and report["cells"] == 16
    assert report["invalid_cells"] == report["undecided_cells"] == 0 and report["witness"] is None
    assert abs(report["measure"] - math.pi / 4 * 0.75) < 1e-12
    assert 0 < report["measure_error"] < 1e-12
    assert 0 < report["min_jacobian_lower"] <= report["min_jacobian_upper"]
    assert abs(report["min_scaled_jacobian"] - 1) < 0.2 and report["seconds"] >= 0
    verdicts = vtk_to_numpy(read(path("annotated.vtu")).GetCellData().GetArray("JacobianVerdict"))
    assert (verdicts == 1).all()


def test_folded_grid_has_a_witness():
    report, done = run(3, "validate", annulus("folded.vtu", [0.3, 0.3, 0]), "--output", path("annotated.vtu"),
                       "--witnesses", path("witnesses.vtu"))
    assert report["verdict"] == "invalid" and report["invalid_cells"] > 0
    assert done.stderr == "" and len(report["witness"]) == 3 and len(report["witness_parameters"]) == 3
    cell_data = read(path("annotated.vtu")).GetCellData()
    assert vtk_to_numpy(cell_data.GetArray("JacobianVerdict"))[report["witness_cell"]] == -1
    assert read(path("witnesses.vtu")).GetNumberOfCells() == 2 * report["invalid_cells"]


def test_overlap_of_valid_cells_is_invalid():
    report, _ = run(3, "validate", quadrilaterals("overlap.vtu", band(420)))
    assert report["verdict"] == "valid" and report["invalid_cells"] == 0 and report["injective"] == "not_injective"
    x, y, _ = report["witness"]
    assert 0.9 < math.hypot(x, y) < 2.1 and 0 <= math.atan2(y, x) < math.radians(60)  # where it lies twice
    assert said("overlap.vtu", 3) == "valid, not injective: two different points have the same image"
    assert said("overlap.vtu", 0, "--injectivity", "false") == "valid"
    quadrilaterals("once.vtu", band(300))
    assert said("once.vtu", 0) == "valid, injective"


def test_undecided_injectivity_of_valid_cells_is_said():
    square = ((0, 0), (1, 0), (1, 1), (0, 1))
    beside = [(x + 1 + 1e-9, y) for x, y in square]
    report, _ = run(0, "validate", quadrilaterals("beside.vtu", [square, beside], patches=[0, 1]))
    assert report["verdict"] == "valid" and report["injective"] == "undecided" and report["interface_gaps"] == 1
    assert said("beside.vtu", 0) == "valid, injectivity undecided: sides of two patches nearly agree, but are not equal"


def test_reversed_grid():
    grid = read(annulus())
    points = vtk_to_numpy(grid.GetPoints().GetData())
    points[:, 0] *= -1
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path("mirrored.vtu"))
    writer.SetInputData(grid)
    writer.Write()
    report, _ = run(3, "validate", path("mirrored.vtu"))
    assert report["verdict"] == "reversed" and report["reversed_cells"] == 16
    assert report["measure"] < 0


def test_limit_leaves_a_valley_undecided():
    # x = u, y = u^2 v - u v^2 + v^3 / 3 + 1e-6 v, so that det J = (u - v)^2 + 1e-6
    power = [[math.comb(k, i) / math.comb(3, i) for k in range(4)] for i in range(4)]  # u^i in Bernstein form
    knots = "4 4\n0 0 0 0 1 1 1 1\n"
    rows = ["%r %r" % (k / 3, power[2][k] * power[1][l] - power[1][k] * power[2][l] + power[3][l] / 3
                       + 1e-6 * power[1][l]) for l in range(4) for k in range(4)]
    with open(path("valley.g2"), "w") as stream:
        stream.write("200 1 0 0\n2 0\n" + 2 * knots + "\n".join(rows) + "\n")
    report, _ = run(4, "validate", path("valley.g2"), "--maximum-boxes", 1)
    assert report["verdict"] == "undecided" and report["undecided_cells"] == 1
    assert report["min_jacobian_lower"] <= 1e-6 <= report["min_jacobian_upper"]
    report, _ = run(0, "validate", path("valley.g2"))
    assert report["verdict"] == "valid" and report["min_jacobian_lower"] > 0


def straight_corners(name, angle, move=0.0):
    """A square of four straight corners, where det J = 0, extruded and turned; one point moves down."""
    net = [(0, -1), (1, -1 - move), (1, 0), (-1, -1), (0, 0), (1, 1), (-1, 0), (-1, 1), (0, 1)]
    c, s = math.cos(angle), math.sin(angle)
    rows = ["%r %r %r" % (c * x - s * y, s * x + c * y, 0.5 * k) for k in range(2) for x, y in net]
    with open(path(name), "w") as stream:
        stream.write("700 1 0 0\n3 0\n" + 2 * "3 3\n0 0 0 1 1 1\n" + "2 2\n0 0 1 1\n" + "\n".join(rows) + "\n")
    return path(name)


def test_degenerate_within_rounding_is_undecided_and_says_so():
    report, _ = run(0, "validate", straight_corners("straight.g2", 0))
    assert report["verdict"] == "valid" and report["degenerate_cells"] == 1 and report["rounding"] == 0
    assert report["undecided_cell"] is None and report["undecided_reason"] == ""
    # turned, its coordinates are rounded: now and then det J is negative by that along an edge
    undecided = 0
    for k in range(1, 21):
        done = knotwork_testing.run_program("validate", straight_corners("turned.g2", 0.1 * k), "--report",
                                            path("report.json"), "--output", path("turned.vtu"), "--quiet")
        with open(path("report.json")) as stream:
            report = json.load(stream)
        assert (done.returncode, report["verdict"]) in ((0, "valid"), (4, "undecided")), k
        if done.returncode == 4:
            undecided += 1
            assert report["undecided_reason"] == "degenerate within the rounding of its coordinates"
            assert report["undecided_cell"] == 0 and 0 < report["rounding"] < 1e-15
            assert -1e-15 < report["min_jacobian_upper"] < 0
            assert read(path("turned.vtu")).GetCellData().GetArray("JacobianLimit").GetTuple1(0) == 4
            assert said("turned.g2", 4).startswith(
                "undecided: degenerate within the rounding of its coordinates (cell 0, det J down to -")
    assert undecided > 2
    # folded by more than that, as little as it is
    for move in (1e-9, 1e-3):
        report, _ = run(3, "validate", straight_corners("folded.g2", 0, move))
        assert report["verdict"] == "invalid" and report["rounding"] == 0


def test_unreadable_input_leaves_nothing():
    with open(path("broken.vtu"), "w") as stream:
        stream.write("<VTKFile")
    output = path("none.vtu")
    done = knotwork_testing.run_program("validate", path("broken.vtu"), "--output", output)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1
    assert not os.path.exists(output)


def boundary(name, sides):
    with open(path(name), "w") as stream:
        json.dump({"curves": sides}, stream)
    return path(name)


def line(a, b):
    return {"degree": 1, "knots": [0, 0, 1, 1], "control_points": [a, b]}


def test_parameterize_reports_a_certified_map():
    bite = {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "control_points": [[0, 0], [0.5, 0.7], [1, 0]]}
    name = boundary("bite.json", [bite, line([0, 1], [1, 1]), line([0, 0], [0, 1]), line([1, 0], [1, 1])])
    report, _ = run(0, "parameterize", name, "--output", path("bite.vtu"), "--first-map", path("first.vtu"),
                    "--table", path("convergence.csv"))
    assert report["verdict"] == "valid" and report["min_jacobian_lower"] > 0
    assert abs(report["area"] - (1 - 0.7 / 3)) < 1e-12
    assert 0 < report["min_det_over_area"] < 1 < report["max_det_over_area"]
    # the proved bound is below the samples, and not far below
    sampled = report["min_det_over_area"] * report["area"]
    assert 0.8 * sampled < report["min_jacobian_lower"] <= sampled * (1 + 1e-12)
    for key in ("min_scaled_jacobian", "mean_scaled_jacobian", "mean_condition_number", "iterations", "functions",
                "seconds"):
        assert np.isfinite(report[key]), key
    finer, _ = run(0, "parameterize", name, "--output", path("bite.vtu"), "--certificate-gap", 1e-9, "--foldover", "penalty",
                   "--energy-tolerance", 1e-9, "--metric-samples", 11)
    assert finer["foldover"] == "penalty" and finer["metric_samples"] == 11 and finer["energy_tolerance"] == 1e-9
    assert 0 <= finer["min_jacobian_upper"] - finer["min_jacobian_lower"] <= 1e-9 * finer["min_jacobian_upper"]
    again, _ = run(0, "validate", path("bite.vtu"))
    assert abs(again["measure"] - report["area"]) < 1e-12


def test_parameterize_begins_where_it_is_told():
    half = math.sqrt(0.5)
    arcs = [{"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, half, 1], "control_points": [[r, 0], [r, r], [0, r]]}
            for r in (1, 2)]
    raised = {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "control_points": [[1, 0], [1.5, 0.3], [2, 0]]}
    name = boundary("sector.json", [*arcs, raised, line([0, 1], [0, 2])])
    job = ["parameterize", name, "--output", path("sector.vtu"), "--table", path("sector.csv")]
    rows = {}
    for options in ([], ["--initial-weights", "ones"], ["--initial-map", "variational-harmonic"],
                    ["--weights", "optimized", "--initial-weights", "ones", "--foldover", "relu"]):
        report, _ = run(0, *job, *options)
        assert report["verdict"] == "valid" and report["injective"] == "injective", options
        with open(path("sector.csv")) as stream:
            rows[" ".join(options)] = stream.read().splitlines()
    firsts = {lines[1] for lines in rows.values()}
    assert len(firsts) == 3, rows  # the first and the last but one differ from each other and from weights of 1
    stages = [row.split(",")[0].strip('"') for row in rows["--weights optimized --initial-weights ones --foldover relu"][1:]]
    assert "weights" in stages and stages.index("quality") < stages.index("weights")
    name = boundary("linear.json", [line([0, 0], [0, 1]), line([1, 0], [1, 1]), line([0, 0], [1, 0]), line([0, 1], [1, 1])])
    _, done = run(1, "parameterize", name, "--output", path("none.vtu"), "--initial-map", "variational-harmonic")
    assert "degree 2 or more" in done.stderr


def test_parameterize_writes_the_same_bytes_every_time():
    bite = {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "control_points": [[0, 0], [0.5, 0.7], [1, 0]]}
    name = boundary("bite_again.json", [bite, line([0, 1], [1, 1]), line([0, 0], [0, 1]), line([1, 0], [1, 1])])
    written = []
    for i, threads in enumerate((1, 2, 2)):
        files = [path(f"again_{i}.vtu"), path(f"again_first_{i}.vtu"), path(f"again_{i}.csv")]
        run(0, "parameterize", name, "--output", files[0], "--first-map", files[1], "--table", files[2],
            "--threads", threads)
        written.append([open(file, "rb").read() for file in files])
    assert written[0] == written[1] == written[2]
    assert b"Seconds" not in written[0][0]  # measured times belong into reports


def ring_of_degrees(name, degrees):
    """Arcs about the radii 1 and 2, cubic, and the segments between their ends."""
    knots = [0.0] * 4 + [i / 12 for i in range(1, 12)] + [1.0] * 4
    at = [math.radians(degrees) * sum(knots[i + 1:i + 4]) / 3 for i in range(15)]
    arcs = [[[r * math.cos(a), r * math.sin(a)] for a in at] for r in (1, 2)]
    return boundary(name, [*({"degree": 3, "knots": knots, "control_points": arc} for arc in arcs),
                           line(arcs[0][0], arcs[1][0]), line(arcs[0][-1], arcs[1][-1])])


def test_parameterize_says_whether_the_map_is_one_to_one():
    report, _ = run(0, "parameterize", ring_of_degrees("ring_270.json", 270), "--output", path("ring_270.vtu"))
    assert report["verdict"] == "valid" and report["injective"] == "injective" and report["stopped"] == "finished"
    name = ring_of_degrees("ring_504.json", 504)
    done = knotwork_testing.run_program("parameterize", name, "--output", path("ring_504.vtu"), "--report",
                                        path("ring_504_report.json"))
    assert done.returncode == 0 and "regular, but not one-to-one" in done.stderr and " at (" in done.stderr, done.stderr
    with open(path("ring_504_report.json")) as stream:
        report = json.load(stream)
    assert report["verdict"] == "valid" and report["injective"] == "not_injective"


def test_parameterize_stops_at_its_limits():
    dent = {"degree": 3, "knots": [0, 0, 0, 0, 0.25, 0.5, 0.75, 1, 1, 1, 1],
            "control_points": [[0, 0], [0.7, 0.1], [0.1, 0.7], [0.5, 1.1], [0.9, 0.7], [0.3, 0.1], [1, 0]]}
    west = {"degree": 3, "knots": [0, 0, 0, 0, 1, 1, 1, 1], "control_points": [[0, 0], [0, 0.4], [0, 0.8], [0, 1.2]]}
    name = boundary("dent.json", [dent, line([0, 1.2], [1, 1.2]), west, line([1, 0], [1, 1.2])])
    for option, value, stopped in (("--effort", 1e-5, "effort"), ("--time-limit", 1e-6, "time_limit")):
        done = knotwork_testing.run_program("parameterize", name, "--output", path("limited.vtu"), option, str(value),
                                            "--report", path("limited.json"))
        assert done.returncode == 0, done.stderr
        with open(path("limited.json")) as stream:
            report = json.load(stream)
        assert report["stopped"] == stopped and report["work"] < 1e-3, report
    winslow, _ = run(0, "parameterize", name, "--output", path("dent.vtu"))
    least, _ = run(0, "parameterize", name, "--output", path("dent.vtu"), "--objective", "least-jacobian")
    assert winslow["stopped"] == least["stopped"] == "finished" and least["objective"] == "least-jacobian"
    assert least["verdict"] == "valid" and least["min_det_over_area"] > winslow["min_det_over_area"]


def quarter(radius, k):
    """A quarter of a circle about the origin, from 90 k degrees on."""
    at = [math.radians(90 * k + 45 * i) for i in range(3)]
    points = [[radius * r * math.cos(a), radius * r * math.sin(a)] for a, r in zip(at, (1, math.sqrt(2), 1))]
    return {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, math.sqrt(0.5), 1], "control_points": points}


def ring_layout(name):
    """Four quadrilaterals between circles of the radii 1 and 2."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    for radius in 1, 2:
        for k in range(4):
            points.InsertNextPoint(radius * math.cos(math.pi / 2 * k), radius * math.sin(math.pi / 2 * k), 0)
    grid = vtkUnstructuredGrid()
    grid.SetPoints(points)
    for k in range(4):
        grid.InsertNextCell(VTK_QUAD, 4, [k, 4 + k, 4 + (k + 1) % 4, (k + 1) % 4])
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path(name))
    writer.SetInputData(grid)
    writer.Write()
    return path(name)


def test_parameterize_layout_of_four_patches():
    name = boundary("ring.json", [quarter(radius, k) for radius in (1, 2) for k in range(4)])
    layout = ring_layout("ring_layout.vtu")
    report, _ = run(0, "parameterize", name, "--layout", layout, "--output", path("ring.vtu"))
    assert report["verdict"] == "valid" and report["injective"] == "injective" and report["patches"] == 4
    assert report["layout"] == layout and report["move_interfaces"] is True
    assert abs(report["area"] - 3 * math.pi) < 1e-12
    # det J is compared with the mean area of a patch
    sampled = report["min_det_over_area"] * report["area"] / 4
    assert 0.8 * sampled < report["min_jacobian_lower"] <= sampled * (1 + 1e-12)
    again, _ = run(0, "validate", path("ring.vtu"))
    assert again["verdict"] == "valid" and again["injective"] == "injective" and again["cells"] == 64
    assert abs(again["measure"] - 3 * math.pi) < 1e-12
    coarse, _ = run(0, "parameterize", name, "--layout", layout, "--output", path("ring.vtu"), "--minimum-elements", 2,
                    "--minimum-degree", 3, "--move-interfaces", "false")
    assert coarse["functions"] == 4 * 5 * 5 - 4 * 5 and coarse["move_interfaces"] is False
    name = boundary("open_ring.json", [quarter(radius, k) for radius in (1, 2) for k in range(4)][1:])
    done = knotwork_testing.run_program("parameterize", name, "--layout", layout, "--output", path("never.vtu"))
    assert done.returncode == 1 and "has no curve" in done.stderr and len(done.stderr.splitlines()) == 1
    assert not os.path.exists(path("never.vtu"))


def test_boundary_with_a_gap_is_refused():
    name = boundary("gap.json", [line([0, 0], [1, 0]), line([0, 1], [1, 1]), line([0, 0], [0, 1]),
                                 line([1.25, 0], [1, 1])])
    done = knotwork_testing.run_program("parameterize", name, "--output", path("gap.vtu"))
    assert done.returncode == 1 and "0.25" in done.stderr and len(done.stderr.splitlines()) == 1
    assert not os.path.exists(path("gap.vtu"))


def test_boundary_files_that_are_damaged_are_refused():
    for text, word in (("", "JSON"), ("{", "JSON"), ("[]", "JSON"), ("{}", "curves"), ('{"curves": 3}', "curves"),
                       ('{"curves": [3]}', "side 0"), ('{"curves": [{"degree": 2}]}', "knots"),
                       ('{"curves": [{"degree": 1e9, "knots": [0, 1], "control_points": [[0]]}]}', "side 0"),
                       ('{"curves": [{"degree": 1, "knots": [0, 0, 1, 1], "control_points": [[0, 0], [1]]}]}', "point 1"),
                       ('{"curves": [{"degree": 1, "knots": [0, 0, 1, 1], "control_points": [[0, 0], "x"]}]}', "side 0"),
                       ("[" * 100000, "JSON")):
        with open(path("damaged.json"), "w") as stream:
            stream.write(text)
        done = knotwork_testing.run_program("parameterize", path("damaged.json"), "--output", path("never.vtu"))
        assert done.returncode == 1, (text[:60], done.returncode, done.stderr)
        assert len(done.stderr.splitlines()) == 1 and word in done.stderr, (text[:60], done.stderr)
        assert not os.path.exists(path("never.vtu"))


knotwork_testing.main(globals())
