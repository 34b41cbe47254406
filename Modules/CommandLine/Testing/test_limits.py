# SPDX-License-Identifier: BSD-3-Clause
"""Jobs that would take the machine's memory are refused before they take any; a limit that is raised is one that holds."""
import json
import os
import subprocess
import tempfile

import knotwork_testing
import skeletons
from refusals import good, path

MOST_BYTES = 400 << 20  # libraries and small inputs take some 150 MB


def peak_of(arguments):
    """Exit status, stderr and largest memory of a run."""
    with tempfile.TemporaryDirectory() as folder:
        job = subprocess.Popen([knotwork_testing.PROGRAM, *map(str, arguments), "--quiet"], cwd=folder, stderr=subprocess.PIPE, text=True)
        errors = job.stderr.read()
        _, status, usage = os.wait4(job.pid, 0)
        job.returncode = os.waitstatus_to_exitcode(status)
        assert job.returncode == 0 or os.listdir(folder) == [], os.listdir(folder)
        return job.returncode, errors, 1024 * usage.ru_maxrss


def inputs():
    for name, shape, elements in (("cube", "cube", (1, 1, 1)), ("square", "square", (1, 1, 1)), ("wide", "square", (997, 3, 1)),
                                  ("tall", "square", (3, 1009, 1))):
        good("source", "--shape", shape, "--degree", 2, "--elements", *elements, "--output", path(name + ".vtu"))
    good("source", "--shape", "annulus-sector", "--output", path("annulus.vtu"))
    # LR: lines along the diagonal, so that the tensor product has about the square of them
    grid = path("square.vtu")
    for level in range(3, 9):
        finer = path("diagonal%d.vtu" % level)
        good("refine", grid, "--local-space", "lr", "--plane", 0, 0, 0, 1, -1, 0, "--implicit-region", "crossed", "--output", finer)
        grid = finer
    for name, curves in (("template", skeletons.curves(0.0, 1, 101)), ("target", skeletons.curves(0.1, 5, 50))):
        skeletons.write(skeletons.polydata(curves), path(name + ".vtp"))
    with open(path("curves.json"), "w") as stream:
        json.dump({"curves": [straight([0, 0], [1, 0], 1009), straight([0, 1], [1, 1], 3), straight([0, 0], [0, 1], 3),
                              straight([1, 0], [1, 1], 1013)]}, stream)
    with open(path("long.json"), "w") as stream:
        json.dump({"curves": [straight([0, 0], [1, 0], 20000), straight([0, 1], [1, 1], 3), straight([0, 0], [0, 1], 3),
                              straight([1, 0], [1, 1], 3)]}, stream)
    with open(path("sides.json"), "w") as stream:
        json.dump({"curves": [straight([0, 0], [1, 0], 2), straight([0, 1], [1, 1], 2), straight([0, 0], [0, 1], 2),
                              straight([1, 0], [1, 1], 2)]}, stream)
    good("tessellate", path("square.vtu"), "--cells", "surface", "--chordal-tolerance", 1, "--output", path("quad.vtp"))
    return grid


def straight(begin, end, count):
    """A polyline of so many control points."""
    share = [k / (count - 1) for k in range(count)]
    return {"degree": 1, "knots": [0, *share, 1], "control_points": [[a + t * (b - a) for a, b in zip(begin, end)] for t in share]}


def cases(diagonal):
    """A run, the property that its refusal names, and numbers that it would have."""
    out = ["--output", "out.vtu"]
    yield ["refine", path("cube.vtu"), "--number-of-refinements", 10, *out], "MaximumFunctions"
    yield ["refine", path("cube.vtu"), "--degree-elevation", 7, "--number-of-refinements", 7, *out], "MaximumFunctions"
    yield ["refine", path("square.vtu"), "--number-of-refinements", 10, "--sphere", 0, 0, 0, 9, *out], "MaximumFunctions"
    yield ["refine", path("square.vtu"), "--number-of-refinements", 10, "--local-space", "lr", "--sphere", 0, 0, 0, 9,
           "--maximum-functions", 3000, *out], "MaximumFunctions"
    yield ["extract", diagonal, "--expand-to-tensor", 1, "--maximum-functions", 1000, *out], "MaximumFunctions"
    yield ["combine", path("wide.vtu"), path("tall.vtu"), *out], "MaximumFunctions"
    yield ["source", "--shape", "ball", "--elements", 1000, 1000, 1000, *out], "MaximumFunctions"
    yield ["source", "--shape", "annulus-sector", "--sectors", 4000, "--elements", 20, 20, 1, *out], "MaximumFunctions"
    yield ["tessellate", path("annulus.vtu"), "--chordal-tolerance", 1e-12, "--maximum-subdivision", 10, "--maximum-cells", 100000,
           "--output", "out.vtp"], "MaximumCells"
    yield ["tessellate", path("cube.vtu"), "--cells", "volume", "--chordal-tolerance", 1e-12, "--maximum-cells", 1, *out], None
    yield ["map", path("template.vtp"), path("target.vtp"), "--inner-knots", 4000, *out], "MaxFunctions"
    yield ["warp", path("annulus.vtu"), path("annulus.vtu"), "--clamp", 1, "--tolerance", 1e-14, "--maximum-level", 20, "--maximum-functions",
           2000, *out], "MaximumFunctions"
    yield ["parameterize", path("curves.json"), *out], "MaximumFunctions"
    yield ["parameterize", path("long.json"), *out], "functions in one direction"
    yield ["parameterize", path("sides.json"), "--layout", path("quad.vtp"), "--minimum-elements", 1000, *out], "MaximumFunctions"


def test_what_would_explode_is_refused_before_it_does():
    for arguments, name in cases(inputs()):
        status, errors, peak = peak_of(arguments)
        if name is None:  # a cube is one hexahedron
            assert status == 0, errors
            continue
        assert status == 1 and errors.count("\n") == 1 and name in errors and "limit" in errors, (arguments, status, errors)
        assert peak < MOST_BYTES, (arguments, peak)


def test_a_limit_can_be_raised():
    for arguments, functions in ((["refine", path("square.vtu"), "--number-of-refinements", 6], 66 * 66),
                                 (["source", "--elements", 30, 40, 1], 31 * 41)):
        for limit, status in ((functions, 0), (functions - 1, 1)):
            done = peak_of([*arguments, "--maximum-functions", limit, "--output", "out.vtu"])
            assert done[0] == status, (arguments, limit, done)


knotwork_testing.main(globals())
