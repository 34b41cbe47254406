# SPDX-License-Identifier: BSD-3-Clause
"""Signals end every job at once: exit status 128 + n, one line, nothing left behind, outputs as they were."""
import os
import random
import signal
import subprocess
import tempfile
import time

import numpy as np

import knotwork_testing
import skeletons
from refusals import good, path, write_text

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
KEPT = "kept as it is"
LATEST = 2.0  # seconds from the signal to the end, on a loaded machine; without handling, jobs run on for longer or for ever


def make_inputs():
    grid = np.linspace(0, 1, 60)
    x, y = (a.ravel() for a in np.meshgrid(grid, grid))
    z = 0.2 * np.sin(9 * x) * np.cos(7 * y)
    write_text("many.xyz", "".join("%.17g %.17g %.17g\n" % point for point in zip(x, y, z)))
    n = len(grid)
    corners = [(i * n + j, i * n + j + 1, (i + 1) * n + j + 1, (i + 1) * n + j) for i in range(n - 1) for j in range(n - 1)]
    triangles = [t for a, b, c, d in corners for t in ((a, b, c), (a, c, d))]
    write_text("mesh.off", "OFF\n%d %d 0\n" % (len(x), len(triangles)) +
               "".join("%.17g %.17g %.17g\n" % point for point in zip(x, y, z)) +
               "".join("3 %d %d %d\n" % corner for corner in triangles))
    good("source", "--degree", 2, "--elements", 24, 24, 1, "--center", 0.5, 0.5, 0, "--output", path("square.vtu"))
    good("source", "--degree", 2, "--elements", 24, 24, 1, "--center", 1.5, 0.5, 0, "--output", path("east.vtu"))
    good("source", "--shape", "cube", "--degree", 2, "--elements", 12, 12, 12, "--output", path("cube.vtu"))
    good("convert", path("many.xyz"), "--output", path("many.vtp"))
    good("fit", path("many.xyz"), "--tolerance", 1e-3, "--output", path("height.vtu"))
    good("convert", path("square.vtu"), "--output", path("square.step"))
    skeletons.write(skeletons.polydata(skeletons.curves(0.0, 1, 2001)), path("template.vtp"))
    skeletons.write(skeletons.polydata(skeletons.curves(0.3, 5, 2000)), path("target.vtp"))
    bumps = ", ".join('{"degree": 2, "knots": [0,0,0,1,1,1], "control_points": [%s]}' % ends for ends in (
        "[0, 0], [0.5, 0.9], [1, 0]", "[0, 1], [0.5, 1.9], [1, 1]", "[0, 0], [0.9, 0.5], [0, 1]", "[1, 0], [1.9, 0.5], [1, 1]"))
    write_text("boundary.json", '{"curves": [%s]}' % bumps)


def runs():
    """Every job, with work for some tenths of a second at least where that is possible."""
    table, grid = ["--table", "table.csv"], ["--output", "out.vtu"]
    height, square, cube = path("height.vtu"), path("square.vtu"), path("cube.vtu")
    yield ["combine", height, height, *grid]
    yield ["contour", height, "--number", 12, "--tolerance", 1e-5, *table, "--output", "out.vtp"]
    yield ["convert", cube, "--output", "out.vtpc"]
    yield ["convert", square, "--output", "out.step"]
    yield ["crop", height, path("many.xyz"), "--triangles", "faces.vtp", "--output", "out.step"]
    yield ["distance", path("many.xyz"), height, "--kind", "closest", "--output", "out.vtp"]
    yield ["evaluate", height, path("many.vtp"), "--mode", "probe", "--output", "out.vtp"]
    yield ["extrema", height, *table, "--output", "out.vtp"]
    yield ["extract", height, "--expand-to-tensor", 1, *grid]
    yield ["fit", path("many.xyz"), "--tolerance", 1e-5, *table, "--points", "points.vtp", *grid]
    yield ["flatten", path("mesh.off"), *table, "--output", "out.vtp"]
    yield ["info", cube]
    yield ["map", path("template.vtp"), path("target.vtp"), "--iterations", 50, *table, *grid]
    yield ["parameterize", path("boundary.json"), *table, *grid]
    yield ["raster", height, "--cell-size", 5e-4, "--output", "out.tif"]
    yield ["refine", cube, "--number-of-refinements", 2, *grid]
    yield ["source", "--shape", "cube", "--degree", 3, "--elements", 40, 40, 40, *grid]
    yield ["stitch", square, path("east.vtu"), "--matching", "geometry", "--edges", "table.csv", *grid]
    yield ["tessellate", cube, "--cells", "volume", "--maximum-subdivision", 3, "--chordal-tolerance", 1e-9, *grid]
    yield ["tessellate", path("square.step"), "--output", "out.vtp"]
    yield ["trim", path("mesh.off"), "--tolerance", 1e-3, "--triangles", "faces.vtp", *table, "--output", "out.step"]
    yield ["validate", cube, *table, *grid]
    yield ["warp", height, height, "--clamp", 1, "--tolerance", 1e-7, *grid]


def contents(folder):
    return {os.path.relpath(os.path.join(place, name), folder): open(os.path.join(place, name), "rb").read()
            for place, _, names in os.walk(folder) for name in names}


def defaults():
    """A shell gives its background jobs an ignored SIGINT; here it is as in the foreground."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_DFL)


def wait_until_loaded(job):
    """Before its own first instruction, while libraries are loaded, a program ends as the system has it."""
    mask = sum(1 << (number - 1) for number in SIGNALS)
    while job.poll() is None:
        with open(f"/proc/{job.pid}/status") as status:
            blocked = next((int(line.split()[1], 16) for line in status if line.startswith("SigBlk")), 0)
        if blocked & mask == mask:
            return
        time.sleep(0.002)


def kill_after(folder, arguments, number, share, length):
    """Runs a job and sends it a signal; whether it came before the end."""
    outputs = [a for a in map(str, arguments) if a.startswith(("out.", "table.", "faces.", "points."))]
    for name in outputs[::2]:
        if not name.endswith(".vtpc"):
            with open(os.path.join(folder, name), "w") as stream:
                stream.write(KEPT)
    before = contents(folder)
    job = subprocess.Popen([knotwork_testing.PROGRAM, *map(str, arguments), "--report", "report.json", "--quiet"], cwd=folder,
                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=defaults)
    begin = time.monotonic()
    wait_until_loaded(job)
    time.sleep(share * max(0.0, length - (time.monotonic() - begin)))
    job.send_signal(number)
    begin = time.monotonic()
    _, errors = job.communicate(timeout=60)
    took = time.monotonic() - begin
    where = (arguments, number, share, length, job.returncode, errors)
    after = contents(folder)
    assert not [name for name in after if ".knotwork" in name or ".part" in name], (where, sorted(after))
    if job.returncode == 0:
        assert errors == "" and (arguments[0] == "info" or after != before), where
        return False
    assert job.returncode == 128 + number, where
    assert errors.count("\n") == 1 and arguments[0] in errors and number.name in errors, where
    assert after == before, (where, sorted(after), sorted(before))
    assert took < LATEST, (where, took)
    return True


def test_every_job_ends_at_once():
    make_inputs()
    draw = random.Random(11)
    ended = 0
    for arguments in runs():
        with tempfile.TemporaryDirectory() as whole:  # how long it takes to its end
            begin = time.monotonic()
            done = knotwork_testing.run_program(*arguments, "--report", "report.json", "--quiet", folder=whole)
            length = time.monotonic() - begin
            assert done.returncode == 0, (arguments, done.stderr)
        for number in SIGNALS:
            with tempfile.TemporaryDirectory() as folder:
                ended += kill_after(folder, arguments, number, draw.uniform(0.0, 0.9), length)
    assert ended >= 40, ended  # of 66: some are over sooner than before


def test_an_ignored_signal_stays_ignored():
    """As nohup has it."""
    with tempfile.TemporaryDirectory() as folder:
        job = subprocess.Popen([knotwork_testing.PROGRAM, "refine", path("cube.vtu"), "--number-of-refinements", "1", "--output",
                                "out.vtu", "--quiet"], cwd=folder, stderr=subprocess.PIPE,
                               preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        time.sleep(0.1)
        job.send_signal(signal.SIGHUP)
        assert job.wait(timeout=60) == 0 and os.listdir(folder) == ["out.vtu"]


def test_standard_output_that_cannot_be_written_is_an_error():
    with open("/dev/full", "w") as full:
        done = subprocess.run([knotwork_testing.PROGRAM, "info", path("cube.vtu")], stdout=full, stderr=subprocess.PIPE, text=True,
                              timeout=60)
    assert done.returncode == 1 and "No space left on device" in done.stderr, done.stderr
    with tempfile.TemporaryDirectory() as folder:
        closed, pipe = os.pipe()
        os.close(closed)
        done = subprocess.run([knotwork_testing.PROGRAM, "validate", path("cube.vtu"), "--output", "out.vtu"], cwd=folder, stdout=pipe,
                              stderr=subprocess.PIPE, text=True, timeout=60)
        os.close(pipe)
        assert done.returncode == 1 and "Broken pipe" in done.stderr and os.listdir(folder) == [], (done.stderr, os.listdir(folder))


knotwork_testing.main(globals())
