# SPDX-License-Identifier: BSD-3-Clause
"""Bad input: exit status 1, one line that names the file, no output file, an existing one untouched; wrong usage: 2."""
import os
import re

import numpy as np

import damages
import knotwork_testing
import skeletons


def path(name):
    return knotwork_testing.output("cli_bad/" + name)


def write_text(name, text):
    with open(path(name), "w") as stream:
        stream.write(text)
    return path(name)


def source(name="square.vtu"):
    done = knotwork_testing.run_program("source", "--output", path(name))
    assert done.returncode == 0, done.stderr
    return path(name)


def skeleton(name, curves, ids=None):
    return skeletons.write(skeletons.polydata(curves, ids), path(name))


def assert_refused(arguments, output, *words):
    """The job fails as it should, with the words in its one line, whether or not the output was there before."""
    for before in (None, "kept as it is"):
        if os.path.exists(output):
            os.remove(output)
        if before is not None:
            with open(output, "w") as stream:
                stream.write(before)
        done = knotwork_testing.run_program(*arguments, "--output", output)
        assert done.returncode == 1, (done.returncode, done.stderr)
        lines = done.stderr.splitlines()
        assert len(lines) == 1, done.stderr
        for word in words:
            assert word in lines[0], (word, lines[0])
        if before is None:
            assert not os.path.exists(output)
        else:
            with open(output) as stream:
                assert stream.read() == before
    assert not [name for name in os.listdir(os.path.dirname(output)) if name.startswith(".knotwork")]


def truncated(name, of):
    with open(of, "rb") as stream:
        content = stream.read()
    with open(path(name), "wb") as stream:
        stream.write(content[:len(content) // 2])
    return path(name)


def bad_grids():
    yield path("missing.vtu"), "missing.vtu"
    yield write_text("empty.vtu", ""), "empty.vtu"
    yield truncated("truncated.vtu", source()), "truncated.vtu"
    yield write_text("text.vtu", "not a grid\n"), "text.vtu"
    yield write_text("grid.abc", "0 0 0\n"), ".abc"


def test_grid_jobs_refuse_bad_files():
    points = skeleton("points.vtp", [np.array([(0.2, 0.3), (0.4, 0.5)])])
    for file, word in bad_grids():
        assert_refused(["refine", file], path("out.vtu"), word)
        assert_refused(["tessellate", file], path("out.vtp"), word)
        assert_refused(["convert", file], path("out.vtu"), word)
        assert_refused(["evaluate", file, points], path("out.vtp"), word)
        assert_refused(["warp", points, file], path("out.vtp"), word)
        done = knotwork_testing.run_program("info", file)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and word in done.stderr, done.stderr


def test_grid_jobs_refuse_skeletons():
    lines = skeleton("lines.vtp", skeletons.curves(0.1, 3, 20))
    for job in ("refine", "tessellate"):
        assert_refused([job, lines], path("out.vtu" if job == "refine" else "out.vtp"), "lines.vtp")


def test_map_refuses_bad_skeletons():
    good = skeletons.curves(0.0, 1, 101)
    template = skeleton("template.vtp", good)
    target = skeleton("target.vtp", skeletons.curves(0.1, 5, 50))
    for file, word in bad_grids():
        assert_refused(["map", template, file], path("map.vtu"), word)
        assert_refused(["map", file, target], path("map.vtu"), word)
    holed = skeletons.curves(0.1, 5, 50)
    holed[4][7, 1] = np.nan
    assert_refused(["map", template, skeleton("nan.vtp", holed)], path("map.vtu"), "nan.vtp")
    other = skeleton("ids.vtp", skeletons.curves(0.1, 5, 50), [10, 11, 12, 13, 14])
    assert_refused(["map", template, other], path("map.vtu"), "ids.vtp")
    grid = source()
    assert_refused(["map", template, grid], path("map.vtu"), "square.vtu")
    ball = skeletons.write(skeletons.ball(), path("ball.vtp"))
    assert_refused(["map", template, ball], path("map.vtu"), "ball.vtp", "curves")
    for name, spoil, word in (("nan_ball", lambda points: points.__setitem__((7, 1), np.nan), "NaN"),
                              ("flat_ball", lambda points: points.__imul__((1, 1, 0)), ""),
                              ("point_ball", lambda points: points.__imul__(0), "")):
        broken = skeletons.ball()
        spoil(skeletons.points(broken))
        broken = skeletons.write(broken, path(name + ".vtp"))
        if name != "flat_ball":
            assert_refused(["map", ball, broken], path("map.vtu"), name, word)
        assert_refused(["map", broken, ball], path("map.vtu"), name, word)
    unnumbered = skeletons.ball()
    unnumbered.GetCellData().RemoveArray("PatchId")
    assert_refused(["map", ball, skeletons.write(unnumbered, path("unnumbered.vtp"))], path("map.vtu"), "unnumbered", "PatchId")


def spline():
    """An annulus sector of biquadratic rational elements with a refined corner and a field."""
    for job in (["source", "--shape", "annulus-sector", "--degree", 2, "--elements", 2, 2, 1],
                ["refine", path("coarse.vtu"), "--array", "ElementId", "--upper-threshold", 0]):
        done = knotwork_testing.run_program(*job, "--output", path("coarse.vtu"))
        assert done.returncode == 0, done.stderr
    grid = damages.read(path("coarse.vtu"))
    damages.add_field(grid, "Temperature")
    damages.write(grid, path("field.vtu"))
    done = knotwork_testing.run_program("convert", path("field.vtu"), "--output", path("spline.vtu"))
    assert done.returncode == 0, done.stderr
    return path("spline.vtu")


def jobs_on(file):
    """Every job that reads splines, on that file."""
    points = skeleton("points.vtp", [np.array([(0.2, 0.3), (0.4, 0.5)])])
    grid, polydata = ["--output", path("out.vtu")], ["--output", path("out.vtp")]
    yield ["info", file]
    yield ["convert", file, *grid]
    yield ["refine", file, *grid]
    yield ["tessellate", file, *polydata]
    yield ["contour", file, *polydata]
    yield ["evaluate", file, points, *polydata]
    yield ["evaluate", file, points, "--mode", "probe", *polydata]
    yield ["warp", points, file, *polydata]


def outcome(arguments, before):
    """Exit status and stderr of a job; what failed has said so in one line and left the output as it was."""
    output = arguments[-1] if "--output" in arguments else path("none")
    if os.path.exists(output):
        os.remove(output)
    if before:
        with open(output, "w") as stream:
            stream.write("kept as it is")
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode in (0, 1), (arguments, done.returncode, done.stderr)
    if done.returncode == 1:
        assert len(done.stderr.splitlines()) == 1, (arguments, done.stderr)
        assert os.path.exists(output) == before, arguments
        assert not before or open(output).read() == "kept as it is"
    assert not [name for name in os.listdir(os.path.dirname(output)) if name.startswith(".knotwork")]
    return done.returncode, done.stderr


def test_every_spline_job_refuses_every_damage():
    good = spline()
    for name, spoil, words in damages.REFUSED:
        grid = damages.read(good)
        spoil(grid)
        file = damages.write(grid, path(name + ".vtu"))
        for i, arguments in enumerate(jobs_on(file)):
            status, text = outcome(arguments, before=i % 2 == 1)
            assert status == 1, (name, arguments[0], text)
            for word in [name + ".vtu", *words]:
                assert word in text, (name, arguments[0], word, text)


def test_what_is_kept_beside_the_points_may_be_lost():
    good = spline()
    for name, spoil in damages.SURVIVED:
        grid = damages.read(good)
        spoil(grid)
        file = damages.write(grid, path(name + ".vtu"))
        for arguments in jobs_on(file):
            status, text = outcome(arguments, before=False)
            # a grid that lost its basis has no parameters any more
            lost = name in ("no_patches", "no_version") and arguments[0] in ("evaluate", "warp")
            assert status == 0 or lost and "parameter domain" in text, (name, arguments[0], text)


def test_points_and_skeletons_with_bad_numbers_are_refused():
    grid = spline()
    curves = {"template": skeletons.curves(0.0, 1, 101), "target": skeletons.curves(0.1, 5, 50)}
    files = {name: skeleton(name + ".vtp", lines) for name, lines in curves.items()}
    for word, value in (("nan", np.nan), ("inf", np.inf), ("huge", damages.HUGE)):
        name = word + "_points.vtp"
        points = skeleton(name, [np.array([(0.2, 0.3), (value, 0.5)])])
        assert_refused(["evaluate", grid, points], path("out.vtp"), name, "point 1")
        assert_refused(["evaluate", grid, points, "--mode", "probe"], path("out.vtp"), name, "query 1")
        assert_refused(["warp", points, grid], path("out.vtp"), name, "point 1")
        for role in curves:
            lines = [line.copy() for line in curves[role]]
            lines[4][7, 1] = value
            broken = {**files, role: skeleton(word + "_lines.vtp", lines)}
            assert_refused(["map", broken["template"], broken["target"]], path("map.vtu"), word + "_lines.vtp",
                           role + " patch 4")


def test_skeletons_that_do_not_fit_are_refused():
    curves = skeletons.curves(0.0, 1, 101)
    good = skeleton("good.vtp", curves)
    for name, lines, ids, word in (
            ("point", curves[:4] + [np.repeat(curves[4][:1], 5, axis=0)], None, "single point"),
            ("tiny", [line * 1e-200 for line in curves], None, "single point"),
            ("other", curves, [0, 1, 2, 3, 9], "9"),
            ("open", curves, [0, 1, 2, 3, 3], "patch 3 is open")):
        file = skeleton(name + ".vtp", lines, ids)
        assert_refused(["map", good, file], path("map.vtu"), name + ".vtp", word)
        assert_refused(["map", file, good], path("map.vtu"), name + ".vtp", word)


def test_damaged_xml_is_refused():
    done = knotwork_testing.run_program("convert", spline(), "--encoding", "ascii", "--output", path("ascii.vtu"))
    assert done.returncode == 0, done.stderr
    with open(path("ascii.vtu")) as stream:
        text = stream.read()

    def first_of(array, value):
        begin = re.search(f'Name="{array}".*?>\\s*', text, re.S).end()
        return text[:begin] + value + " " + text[begin:].split(None, 1)[1]

    cases = {f"{count}_{value}": re.sub(f'{count}="\\d+"', f'{count}="{value}"', text)
             for count in ("NumberOfPoints", "NumberOfCells", "NumberOfTuples", "NumberOfComponents")
             for value in (2**60, 2**31 - 1, -1, "1152921504606846976000")}
    cases.update({
        "type": text.replace('type="Float64"', 'type="Strange"'),
        "root": text.replace("UnstructuredGrid", "PolyData"),
        "no_piece": re.sub("<Piece.*</Piece>", "", text, flags=re.S),
        "no_points": re.sub("<Points>.*</Points>", "", text, flags=re.S),
        "no_cells": re.sub("<Cells>.*</Cells>", "", text, flags=re.S),
        "point_id": first_of("connectivity", "99999999"), "point_id_negative": first_of("connectivity", "-4"),
        "offset": first_of("offsets", "99999999"), "offset_negative": first_of("offsets", "-9"),
        "cell_type": first_of("types", "200"), "polyhedron": first_of("types", "42")})
    for name, content in cases.items():
        assert content != text, name
        assert_refused(["refine", write_text(name + ".vtu", content)], path("out.vtu"), name + ".vtu")


def test_bytes_anywhere_may_be_wrong_PropertyOracle():
    with open(spline(), "rb") as stream:
        good = stream.read()
    for cut in range(0, len(good) * 11 // 12, len(good) // 12):
        with open(path("cut.vtu"), "wb") as stream:
            stream.write(good[:cut])
        assert_refused(["refine", path("cut.vtu")], path("out.vtu"), "cut.vtu")
    for seed in range(40):
        random = np.random.default_rng(seed)
        content = bytearray(good)
        for at in random.integers(0, len(content) if seed % 2 else 4000, 4):
            content[at] = random.integers(256)
        with open(path(f"flipped{seed}.vtu"), "wb") as stream:
            stream.write(content)
        outcome(["refine", path(f"flipped{seed}.vtu"), "--quiet", "--output", path("out.vtu")], before=seed % 3 == 0)


def test_meshes_and_old_files_cut_short_are_refused_PropertyOracle():
    for ending, content in (
            (".vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0 1 0 0 2 1 0\n"
                     "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n79\n"),
            (".ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            (".stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                     "endfacet\nendsolid\n"),
            (".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")):
        for cut in {*range(0, len(content), 1 + len(content) // 8), len(content)}:
            name = f"cut{cut}{ending}"
            status, text = outcome(["refine", write_text(name, content[:cut]), "--output", path("out.vtu")], False)
            assert status == 1 and name in text, (name, status, text)


def test_numbers_that_no_option_takes_are_refused():
    for arguments, word in ((["--size", "nan", 1, 1], "nan"), (["--size", 0, 1, 1], "size 0 is 0"),
                            (["--size", 1e308, 1, 1], "1e+60"), (["--elements", 0, 1, 1], "elements"),
                            (["--elements", 10**9, 10**9, 1], "control points"), (["--center", "inf", 0, 0], "centre"),
                            (["--shape", "arc", "--angle", 1e308], "1e+308"),
                            (["--shape", "twisted-bar", "--twist", "nan"], "twist"),
                            (["--shape", "disc", "--outer-radius", 1e308], "1e+60")):
        assert_refused(["source", *arguments], path("out.vtu"), word)
    grid = spline()
    assert_refused(["refine", grid, "--sphere", "nan", 0, 0, 1], path("out.vtu"), "implicit function")
    assert_refused(["tessellate", grid, "--chordal-tolerance", "nan"], path("out.vtp"), "tolerance")
    assert_refused(["warp", grid, source(), "--clamp", 1, "--tolerance", "nan"], path("out.vtu"), "tolerance")
    lines = skeleton("lines.vtp", skeletons.curves(0.1, 3, 20))
    assert_refused(["map", lines, lines, "--tikhonov-weight", "nan"], path("map.vtu"), "Tikhonov")


def test_map_refuses_bad_options():
    lines = skeleton("lines.vtp", skeletons.curves(0.1, 3, 20))
    for name in ("pdm", "tdm", "uniformity", "length", "orthogonality", "skewness", "eccentricity", "area",
                 "self-intersection"):
        assert_refused(["map", lines, lines, f"--{name}-weight", "nan"], path("map.vtu"), "weight", "nan")
    for name in ("accuracy", "max-irregular-share", "stagnation-ratio", "refine-threshold", "refine-share"):
        assert_refused(["map", lines, lines, "--refine", "local", f"--{name}", "nan"], path("map.vtu"), "nan")
    assert_refused(["map", lines, lines, "--method", "weighted", "--pdm-weight", 0, "--tdm-weight", 0], path("map.vtu"),
                   "both 0")
    for numbers, word in (((0, 1, 0, 0.9), "outside the domain"), ((1, 0, 0, 1), "empty"), ((0, "nan", 0, 1), "empty"),
                          ((0, "inf", 0, 1), "empty"), ((0, 1, 0, 1, 0), "4 or 6")):
        assert_refused(["map", lines, lines, "--domain", *numbers], path("map.vtu"), word)
    assert_refused(["map", lines, lines, "--inner-knots-per-direction", -2, 3, 3], path("map.vtu"), "inner knots")
    for usage in (["--guard", "maybe"], ["--refine", "sometimes"], ["--extension", -1], ["--refine-share", 2],
                  ["--method", "best"], ["--initial-map", "random"], ["--max-level", 25], ["--area-weight", -1],
                  ["--domain", 0, 1], ["--refine-every", -1], ["--max-functions", 0], ["--accuracy", "much"]):
        done = knotwork_testing.run_program("map", lines, lines, "--output", path("map.vtu"), *usage)
        assert done.returncode == 2, (usage, done.returncode, done.stderr)


def test_map_refuses_bad_initial_maps():
    lines = skeleton("lines.vtp", skeletons.curves(0.1, 3, 50))
    for file, word in bad_grids():
        assert_refused(["map", lines, lines, "--initial", file], path("map.vtu"), word)
    good = path("first.vtu")
    done = knotwork_testing.run_program("map", lines, lines, "--output", good, "--iterations", 1)
    assert done.returncode == 0, done.stderr

    def moved(name, row, *xyz):
        grid = damages.read(good)
        damages.point(grid, row, *xyz)
        return damages.write(grid, path(name))

    for file, words in ((moved("nan_map.vtu", 4, np.nan, 0, 0), ["nan_map.vtu", "NaN"]),
                        (spline(), ["polynomial"]), (lines, ["lines.vtp"])):
        assert_refused(["map", lines, lines, "--initial", file], path("map.vtu"), *words)
    for name, spoil, words in damages.REFUSED:
        grid = damages.read(spline())
        spoil(grid)
        file = damages.write(grid, path(name + ".vtu"))
        status, text = outcome(["map", lines, lines, "--initial", file, "--output", path("map.vtu")], before=False)
        assert status == 1, (name, text)
        for word in [name + ".vtu", *words]:
            assert word in text, (name, word, text)


def test_points_outside_are_named():
    grid = source()
    points = skeleton("outside.vtp", [np.array([(0.2, 0.3), (4.0, 0.5)])])
    assert_refused(["evaluate", grid, points, "--patch-id-array", "none"], path("out.vtp"), "point 1")
    assert_refused(["warp", points, grid], path("out.vtp"), "outside.vtp")
    assert_refused(["evaluate", grid, points, "--parameter-array", "nothing"], path("out.vtp"), "nothing")


def test_wrong_endings_and_folders_are_refused():
    grid = source()
    assert_refused(["refine", grid], path("out.csv"), "out.csv")
    done = knotwork_testing.run_program("refine", grid, "--output", path("no/such/folder") + "/out.vtu/x.vtu")
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr


def test_wrong_usage_is_status_2():
    for arguments in ([], ["nothing"], ["map"], ["refine", source()], ["source", "--output", path("x.vtu"), "--degree", 99],
                      ["source", "--output", path("x.vtu"), "--shape", "heart"],
                      ["map", "a", "b", "--output", "c.vtu", "--iterations", "many"]):
        done = knotwork_testing.run_program(*arguments)
        assert done.returncode == 2, (arguments, done.returncode, done.stderr)


knotwork_testing.main(globals())
