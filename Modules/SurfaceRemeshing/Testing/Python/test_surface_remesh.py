# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of libcgal-demo remeshed, from files to files and in Python: how they hang together stays, distances hold, what is wrong is named."""
import json
import os
import tarfile

import knotwork
import knotwork_testing
from vtkmodules.vtkFiltersSources import vtkSphereSource

FOLDER = os.path.dirname(knotwork_testing.output("remesh/files"))
ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"


def unpack(*names):
    if not os.path.exists(ARCHIVE):
        knotwork_testing.skip(f"{ARCHIVE} is missing; install the package libcgal-demo")
    with tarfile.open(ARCHIVE) as archive:
        for name in names:
            with open(os.path.join(FOLDER, name + ".off"), "wb") as file:
                file.write(archive.extractfile(f"data/meshes/{name}.off").read())


def run(*words, status=0):
    done = knotwork_testing.run_program(*words, folder=FOLDER)
    assert done.returncode == status, (words, done.stderr)
    return done


def remeshed(name, *options):
    run("remesh", name, *options, "--output", "fine.vtp", "--lines", "lines.vtp", "--report", "remesh.json", "--force")
    with open(os.path.join(FOLDER, "remesh.json"), encoding="utf-8") as file:
        return json.load(file)


def test_meshes_keep_how_they_hang_together():
    unpack("elephant", "eight", "rotor", "mpi_triang")
    for name, euler in (("elephant", -4), ("eight", -2), ("rotor", 0), ("mpi_triang", 0)):
        for options in ((), ("--sizing", "curvature")):
            report = remeshed(name + ".off", *options)
            assert report["euler_before"] == report["euler_after"] == euler, report
            assert report["parts_before"] == report["parts_after"] and report["intersections"] == 0, report
            assert 0 < max(report["distance_from_input"], report["distance_to_input"]) <= 0.01 * report["diagonal"], report
            again = run("repair", "fine.vtp", "--output", "same.vtp", "--report", "repair.json", "--force")
            with open(os.path.join(FOLDER, "repair.json"), encoding="utf-8") as file:
                assert not json.load(file)["changed"], (name, again.stderr)


def test_what_is_no_manifold_is_to_be_repaired():
    unpack("cow")
    done = run("remesh", "cow.off", "--output", "no.vtp", status=1)
    assert "repair" in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
    done = run("remesh", "cow.off", "--sizing", "array", "--size-array", "Lengths", "--output", "no.vtp", status=1)
    assert "there is no point array 'Lengths'" in done.stderr, done.stderr
    assert run("remesh", "cow.off", "--size", "-1", "--output", "no.vtp", status=2).stderr


def test_in_python():
    ball = vtkSphereSource()
    ball.SetThetaResolution(60)
    ball.SetPhiResolution(30)
    remesh = knotwork.vtkSurfaceRemesh()
    remesh.SetInputConnection(ball.GetOutputPort())
    remesh.SetSize(0.08)
    remesh.Update()
    numbers = remesh.GetOutputDataObject(2)
    value = lambda name: numbers.GetValueByName(0, name).ToDouble()  # noqa: E731
    assert value("FittingEdges") > 0.9 and value("LeastAngleAfter") > 25, numbers
    assert abs(value("VolumeAfter") / value("VolumeBefore") - 1) < 0.02
    assert abs(value("MeanEdgeAfter") / 0.08 - 1) < 0.15


knotwork_testing.main(globals())
