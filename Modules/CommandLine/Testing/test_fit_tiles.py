# SPDX-License-Identifier: BSD-3-Clause
"""The job `fit` over the tiles of a cloud: one C1 surface within the tolerance, what is reported is what other jobs find, and a run
that was killed goes on with the same bits."""
import os
import random
import shutil
import signal
import subprocess
import time

import numpy as np

import knotwork_testing

FILES = knotwork_testing.Files("fit_tiles")
FIT = ["fit", "terrain.tiles", "--tolerance", 0.02, "--find-outliers"]


def make_tiles():
    """A slope with waves and a step on [0, 3] x [0, 2], without its corner, with noise and outliers; seeded. The number of these."""
    draw = np.random.default_rng(2)
    x, y = draw.uniform(0, 3, 24000), draw.uniform(0, 2, 24000)
    z = 0.2 * x + 0.3 * np.sin(4 * x) * np.cos(5 * y) + 0.3 / (1 + np.exp(-40 * (y - 0.3 * x - 0.6)))
    z += draw.uniform(-0.005, 0.005, 24000)
    z[::400] += 0.5
    kept = (x < 2) | (y < 1)
    if os.path.exists(FILES.path("terrain.tiles")):
        return kept[::400].sum()
    np.savetxt(FILES.path("terrain.xyz"), np.c_[x, y, z][kept], "%.17g")
    report = FILES.report("tiles", "terrain.xyz", "--tile-size", 1, "--output", "terrain.tiles")
    assert report["tiles"] == 5 and report["points"] == kept.sum(), report
    return kept[::400].sum()


def content(folder):
    return {name: open(FILES.path(folder + "/" + name), "rb").read() for name in sorted(os.listdir(FILES.path(folder)))}


def test_one_smooth_surface_within_the_tolerance():
    planted = make_tiles()
    report = FILES.report(*FIT, "--output", "surface.vtpc", "--table", "tiles.csv")
    assert report["within_tolerance"] and report["points_outside"] == 0 and report["tiles"] == 5 and report["edges"] == 5, report
    assert report["max_jump_before"] > 1e-4 and report["max_jump"] < 1e-13 and report["max_slope_jump"] < 1e-11, report  # rounding
    # an independent count: every point of the cloud against the surface that was written
    FILES.run("distance", "terrain.xyz", "surface.vtpc", "--tolerances", report["tolerance"], "--class-table", "classes.csv", "--output",
              "distances.vtp")
    classes = np.genfromtxt(FILES.path("classes.csv"), delimiter=",", names=True)
    off = classes["Points"][classes["Class"] != 0].sum()
    assert classes["Points"].sum() == report["points"] and off == report["outliers"] == planted, (classes, report["outliers"])
    # and of the jumps: those before stitching again are those that are there, updates included
    again = FILES.report("stitch", "surface.vtpc", "--output", "again.vtu")
    assert again["max_jump_before"] < 1e-13 and again["max_slope_jump_before"] < 1e-11 and again["edges"] == 5, again
    table = np.genfromtxt(FILES.path("tiles.csv"), delimiter=",", names=True)
    for column, key in (("Points", "points"), ("Functions", "functions"), ("Outliers", "outliers"), ("PointsOutside", "points_outside")):
        assert table[column].sum() == report[key], (column, report)
    assert np.isclose(table["MaxError"].max(), report["max_error"], rtol=1e-5) and report["max_error"] <= 0.02  # six digits
    # one grid has the same patches
    FILES.run(*FIT, "--output", "surface.vtu")
    assert FILES.run("info", "surface.vtu").stdout == FILES.run("info", "surface.vtpc").stdout


def test_a_killed_run_goes_on_with_the_same_bits():
    make_tiles()
    begin = time.monotonic()
    FILES.run(*FIT, "--output", "whole.vtpc")
    seconds = time.monotonic() - begin
    resumed = 0
    for seed in range(4):
        random.seed(seed)
        folder, output = f"kept-{seed}", f"killed-{seed}"
        shutil.rmtree(FILES.path(folder), ignore_errors=True)  # of the test's last run
        words = [*map(str, FIT), "--resume", folder, "--output", output + ".vtpc"]
        for _ in range(3):
            run = subprocess.Popen([knotwork_testing.PROGRAM, *words], cwd=FILES.folder, stderr=subprocess.DEVNULL)
            time.sleep(random.uniform(0.2, 1.0) * seconds)
            run.send_signal(signal.SIGKILL)
            run.wait()
        report = FILES.report(*words)
        resumed += report["tiles_resumed"]
        names = [name.replace(output, "whole") for name in content(output)]
        assert names == list(content("whole")) and list(content(output).values()) == list(content("whole").values()), seed
        # its own results are taken, another run's are not
        again = FILES.report(*words)
        assert again["tiles_resumed"] == 10 and again["outliers"] == report["outliers"], again
    assert resumed > 0
    text = FILES.run(*FIT[:3], 0.03, "--resume", "kept-0", "--output", "other.vtpc", status=1).stderr
    assert "kept-0" in text and "other tiles, options" in text and len(text.splitlines()) == 1, text
    # nor those of a cloud with one point moved by a little
    points = np.loadtxt(FILES.path("terrain.xyz"))
    points[1234, 2] += 1e-9
    os.makedirs(FILES.path("moved"), exist_ok=True)
    np.savetxt(FILES.path("moved/terrain.xyz"), points, "%.17g")
    FILES.run("tiles", "moved/terrain.xyz", "--tile-size", 1, "--output", "moved/terrain.tiles", "--force")
    text = FILES.run("fit", "moved/terrain.tiles", *FIT[2:], "--resume", "kept-0", "--output", "other.vtpc", status=1).stderr
    assert "other tiles, options" in text, text


def test_what_is_wrong_is_one_line():
    make_tiles()
    os.makedirs(FILES.path("mine"), exist_ok=True)
    with open(FILES.path("mine/notes.txt"), "w", encoding="utf-8") as stream:
        stream.write("mine")
    tile = FILES.path("terrain/tile-1-0.ply")
    data = open(tile, "rb").read()
    for words, said in ((["--space", "thb"], "--space is not of tiles"), (["--domain", 0, 1, 0, 1], "--domain is not of tiles"),
                        (["--points", "p.vtp"], "--points is not of tiles"), (["--resume", "mine"], "'mine' (--resume) holds other files")):
        text = FILES.run(*FIT, *words, "--output", "bad.vtpc", status=1).stderr
        assert said in text and len(text.splitlines()) == 1, text
    assert "written as .vtu or .vtpc" in FILES.run(*FIT, "--output", "bad.g2", status=1).stderr
    assert "of tiles" in FILES.run("fit", "terrain.xyz", "--output", "bad.vtpc", status=1).stderr
    assert "--resume is of tiles" in FILES.run("fit", "terrain.xyz", "--resume", "new", "--output", "bad.vtu", status=1).stderr
    try:
        for spoiled, said in ((data[:-8], "truncated"), (b"", "tile-1-0.ply"), (data.replace(b"      4", b"      3", 1), "tile-1-0.ply")):
            open(tile, "wb").write(spoiled)
            text = FILES.run(*FIT, "--output", "bad.vtpc", status=1).stderr
            assert said in text and "tile-1-0.ply" in text and len(text.splitlines()) == 1, text
    finally:
        open(tile, "wb").write(data)
    assert not [name for name in os.listdir(FILES.folder) if name.startswith(("bad", "new"))]
    assert os.listdir(FILES.path("mine")) == ["notes.txt"]


knotwork_testing.main(globals())
