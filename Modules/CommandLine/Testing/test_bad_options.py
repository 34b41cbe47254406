# SPDX-License-Identifier: BSD-3-Clause
"""Skeletons, points and numbers that read well but cannot be worked with: refused in one line that names them."""
import os
import subprocess

import numpy as np

import damages
import knotwork_testing
import skeletons
from refusals import good, path, refuse, refuse_all

MAPPED = ["--output", "map.vtu"]


def skeleton(name, curves, ids=None):
    return skeletons.write(skeletons.polydata(curves, ids), path(name))


def lines():
    return skeleton("lines.vtp", skeletons.curves(0.1, 3, 20))


def square(name="plain.vtu"):
    good("source", "--output", path(name))
    return path(name)


def fitted(name="fitted.vtu"):
    """A height field over [0, 1]^2 and its points."""
    rows = [f"{x / 12} {y / 12} {0.1 * np.sin(x / 3) * y / 12}" for x in range(13) for y in range(13)]
    with open(path("fitted.xyz"), "w") as stream:
        stream.write("\n".join(rows) + "\n")
    good("fit", path("fitted.xyz"), "--tolerance", 1e-3, "--output", path(name))
    return path(name), path("fitted.xyz")


def test_map_refuses_bad_skeletons():
    template, target = skeleton("template0.vtp", skeletons.curves(0.0, 1, 101)), skeletons.curves(0.1, 5, 50)
    holed = skeletons.curves(0.1, 5, 50)
    holed[4][7, 1] = np.nan
    ball = skeletons.write(skeletons.ball(), path("ball.vtp"))
    cases = [(["map", template, skeleton("nan.vtp", holed)], ["nan.vtp"]),
             (["map", template, skeleton("ids.vtp", target, [10, 11, 12, 13, 14])], ["ids.vtp"]),
             (["map", template, square()], ["plain.vtu"]), (["map", template, ball], ["ball.vtp", "curves"])]
    for name, spoil, word in (("nan_ball", lambda points: points.__setitem__((7, 1), np.nan), "NaN"),
                              ("flat_ball", lambda points: points.__imul__((1, 1, 0)), ""),
                              ("point_ball", lambda points: points.__imul__(0), "")):
        broken = skeletons.ball()
        spoil(skeletons.points(broken))
        broken = skeletons.write(broken, path(name + ".vtp"))
        if name != "flat_ball":
            cases.append((["map", ball, broken], [name, word]))
        cases.append((["map", broken, ball], [name, word]))
    unnumbered = skeletons.ball()
    unnumbered.GetCellData().RemoveArray("PatchId")
    unnumbered = skeletons.write(unnumbered, path("unnumbered.vtp"))
    cases.append((["map", ball, unnumbered], ["unnumbered", "PatchId"]))
    refuse_all((arguments + MAPPED, words) for arguments, words in cases)


def test_points_and_skeletons_with_bad_numbers_are_refused():
    grid, (surface, _) = square(), fitted()
    curves = {"template": skeletons.curves(0.0, 1, 101), "target": skeletons.curves(0.1, 5, 50)}
    files = {name: skeleton(name + "0.vtp", lines) for name, lines in curves.items()}
    output = ["--output", "out.vtp"]

    def cases():
        for word, value in (("nan", np.nan), ("inf", np.inf), ("huge", damages.HUGE)):
            name = word + "_points.vtp"
            points = skeleton(name, [np.array([(0.2, 0.3), (value, 0.5), (0.7, 0.1), (0.4, 0.9)])])
            yield ["evaluate", grid, points, *output], [name, "point 1"]
            yield ["evaluate", grid, points, "--mode", "probe", *output], [name, "query 1" if word == "huge" else "point 1"]
            yield ["warp", points, grid, *output], [name, "point 1"]
            yield ["distance", points, surface, *output], [name, "point 1"]
            yield ["distance", points, surface, "--kind", "closest", *output], [name, "point 1"]
            yield ["crop", surface, points, "--output", "out.step"], [name, "point 1"]
            yield ["fit", points, "--output", "out.vtu"], [name, "point 1"]
            for role in curves:
                lines = [line.copy() for line in curves[role]]
                lines[4][7, 1] = value
                broken = {**files, role: skeleton(f"{word}_{role}.vtp", lines)}
                place = role + " patch 4" if word == "huge" else "coordinate y that is not finite"
                yield ["map", broken["template"], broken["target"], *MAPPED], [f"{word}_{role}.vtp", place]

    refuse_all(cases())


def test_skeletons_that_do_not_fit_are_refused():
    curves = skeletons.curves(0.0, 1, 101)
    sound = skeleton("good.vtp", curves)

    def cases():
        for name, lines, ids, word in (
                ("point", curves[:4] + [np.repeat(curves[4][:1], 5, axis=0)], None, "single point"),
                ("tiny", [line * 1e-200 for line in curves], None, "single point"),
                ("other", curves, [0, 1, 2, 3, 9], "9"),
                ("open", curves, [0, 1, 2, 3, 3], "patch 3 is open")):
            file = skeleton(name + ".vtp", lines, ids)
            yield ["map", sound, file, *MAPPED], [name + ".vtp", word]
            yield ["map", file, sound, *MAPPED], [name + ".vtp", word]

    refuse_all(cases())


def test_numbers_that_no_option_takes_are_refused():
    grid = ["--output", "out.vtu"]
    cases = [(["source", *arguments, *grid], [word]) for arguments, word in (
        (["--size", "nan", 1, 1], "nan"), (["--size", 0, 1, 1], "size 0 is 0"), (["--size", 1e308, 1, 1], "1e+60"),
        (["--elements", 0, 1, 1], "elements"), (["--elements", 10**9, 10**9, 1], "MaximumFunctions"),
        (["--center", "inf", 0, 0], "centre"), (["--shape", "arc", "--angle", 1e308], "1e+308"),
        (["--shape", "twisted-bar", "--twist", "nan"], "twist"), (["--shape", "disc", "--outer-radius", 1e308], "1e+60"))]
    plain, (surface, points) = square(), fitted()
    refuse_all(cases + [
        (["refine", plain, "--sphere", "nan", 0, 0, 1, *grid], ["implicit function"]),
        (["tessellate", plain, "--chordal-tolerance", "nan", "--output", "out.vtp"], ["tolerance"]),
        (["warp", plain, square("other.vtu"), "--clamp", 1, "--tolerance", "nan", *grid], ["tolerance"]),
        (["map", lines(), lines(), "--tikhonov-weight", "nan", *MAPPED], ["Tikhonov"]),
        (["combine", surface, surface, "--mode", "weighted", "--first-weight", "nan", *grid], ["weight"]),
        (["combine", surface, surface, "--mode", "weighted", "--second-weight", "inf", *grid], ["weight"]),
        (["distance", points, surface, "--tolerances", 0.2, 0.1, "--output", "out.vtp"], ["ascend"]),
        (["distance", points, surface, "--tolerances", "nan", "--output", "out.vtp"], ["positive"]),
        (["crop", surface, points, "--cell-size", "nan", "--output", "out.step"], ["ell"]),
        (["crop", surface, points, "--cell-size", 1e-9, "--output", "out.step"], ["cells"]),
        (["crop", surface, points, "--tolerance", "nan", "--output", "out.step"], ["olerance"]),
        (["crop", surface, points, "--maximum-gap", "nan", "--output", "out.step"], ["gap"]),
        (["contour", surface, "--levels", "nan", "--output", "out.vtp"], ["level"]),
        (["contour", surface, "--tolerance", "nan", "--output", "out.vtp"], ["olerance"]),
        (["contour", surface, "--field", "Nothing", "--output", "out.vtp"], ["Nothing"]),
        (["contour", surface, "--component", 7, "--output", "out.vtp"], ["7"]),
        (["extrema", surface, "--field-name", "Nothing", "--output", "out.vtp"], ["Nothing"]),
        (["extrema", surface, "--component", 7, "--output", "out.vtp"], ["7"]),
        (["stitch", surface, surface, *grid], ["overlap"]),
        (["stitch", surface, surface, "--matching", "geometry", "--tolerance", "nan", *grid], ["olerance"]),
        (["stitch", surface, surface, "--pair", 0, 1, 7, 0, 0, *grid], ["7"]),
        (["extract", surface, "--box", 0, 2, 0, 1, *grid], ["outside"]),
        (["extract", surface, "--box", 0, "nan", 0, 1, *grid], ["nan"]),
        (["extract", surface, "--box", 0.5, 0.5, 0, 1, *grid], ["no length"]),
        (["extract", surface, "--iso-curve", "first", "--iso-value", 7, *grid], ["7"]),
        (["extract", surface, "--iso-curve", "first", "--iso-value", "nan", *grid], ["nan"]),
        (["fit", points, "--tolerance", "nan", *grid], ["olerance"]),
        (["fit", points, "--smoothing", "nan", *grid], ["moothing"]),
        (["fit", points, "--domain", 0, 0.5, 0, 1, *grid], ["point"]),
        (["validate", surface, "--relative-gap", "nan", *grid], ["gap"]),
    ])


def test_map_refuses_bad_options():
    file = lines()
    cases = [([f"--{name}-weight", "nan"], ["weight", "nan"]) for name in (
        "pdm", "tdm", "uniformity", "length", "orthogonality", "skewness", "eccentricity", "area", "self-intersection")]
    cases += [(["--refine", "local", f"--{name}", "nan"], ["nan"]) for name in (
        "accuracy", "maximum-irregular-share", "stagnation-ratio", "refine-threshold", "refine-share")]
    cases += [(["--method", "weighted", "--pdm-weight", 0, "--tdm-weight", 0], ["both 0"]),
              (["--inner-knots-per-direction", -2, 3, 3], ["inner knots"])]
    cases += [(["--domain", *numbers], [word]) for numbers, word in (
        ((0, 1, 0, 0.9), "outside the domain"), ((1, 0, 0, 1), "empty"), ((0, "nan", 0, 1), "empty"),
        ((0, "inf", 0, 1), "empty"), ((0, 1, 0, 1, 0), "4 or 6"))]
    refuse_all((["map", file, file, *options, *MAPPED], words) for options, words in cases)
    for usage in (["--guard", "maybe"], ["--refine", "sometimes"], ["--extension", -1], ["--refine-share", 2],
                  ["--method", "best"], ["--initial-map", "random"], ["--maximum-level", 25], ["--area-weight", -1],
                  ["--domain", 0, 1], ["--refine-every", -1], ["--maximum-functions", 0], ["--accuracy", "much"]):
        done = knotwork_testing.run_program("map", file, file, "--output", path("map.vtu"), *usage)
        assert done.returncode == 2, (usage, done.returncode, done.stderr)


def test_map_refuses_initial_maps_that_do_not_fit():
    file = skeleton("lines50.vtp", skeletons.curves(0.1, 3, 50))
    good("map", file, file, "--output", path("first.vtu"), "--iterations", 1)
    grid = damages.read(path("first.vtu"))
    damages.point(grid, 4, np.nan, 0, 0)
    good("source", "--shape", "annulus-sector", "--output", path("rational.vtu"))
    for initial, words in ((damages.write(grid, path("nan_map.vtu")), ["nan_map.vtu", "NaN"]),
                           (path("rational.vtu"), ["polynomial"]), (file, ["lines50.vtp"])):
        refuse(["map", file, file, "--initial", initial, *MAPPED], *words)


def test_points_outside_are_named():
    grid, (surface, _) = square(), fitted()
    points = skeleton("outside.vtp", [np.array([(0.2, 0.3), (4.0, 0.5), (0.1, 0.1), (0.3, 0.9)])])
    for arguments, words in ((["evaluate", grid, points, "--patch-id-array", "none"], ["point 1"]),
                             (["warp", points, grid], ["outside.vtp"]),
                             (["evaluate", grid, points, "--parameter-array", "nothing"], ["nothing"])):
        refuse([*arguments, "--output", "out.vtp"], *words)
    refuse(["crop", surface, points, "--output", "out.step"], "outside.vtp", "point 1")


def test_a_start_by_mpirun_is_refused_once():
    output = path("twice.vtu")
    for launcher in ("OMPI_COMM_WORLD", "PMI", "MV2_COMM_WORLD"):
        for size, rank, lines in ((2, 0, 1), (2, 1, 0), (1, 0, 0)):
            names = {launcher + "_SIZE": str(size), launcher + "_RANK": str(rank)}
            done = subprocess.run([knotwork_testing.PROGRAM, "source", "--output", output], stderr=subprocess.PIPE, text=True,
                                  env={**os.environ, **names})
            assert done.returncode == (2 if size > 1 else 0), (names, done.stderr)
            assert len(done.stderr.splitlines()) == lines, done.stderr
            assert lines == 0 or (launcher + "_SIZE is 2" in done.stderr and "without mpirun" in done.stderr), done.stderr
            assert os.path.exists(output) == (size == 1)
        os.remove(output)


knotwork_testing.main(globals())
