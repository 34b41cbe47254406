# SPDX-License-Identifier: BSD-3-Clause
"""Bad input: exit status 1, one line that names the file, no output file, an existing one untouched; wrong usage: 2."""
import os

import numpy as np

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
    yield write_text("grid.xyz", "0 0 0\n"), ".xyz"


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
