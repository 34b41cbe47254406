# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of libcgal-demo remeshed, from files to files and in Python: how they hang together stays, distances hold, what is wrong is named."""

import knotwork
import knotwork_testing
from vtkmodules.vtkFiltersSources import vtkSphereSource

FILES = knotwork_testing.Files("remesh")


def remeshed(name, *options):
    return FILES.report("remesh", name, *options, "--output", "fine.vtp", "--lines", "lines.vtp")


def test_meshes_keep_how_they_hang_together():
    FILES.unpack_meshes("elephant", "eight", "rotor", "mpi_triang")
    for name, euler in (("elephant", -4), ("eight", -2), ("rotor", 0), ("mpi_triang", 0)):
        for options in ((), ("--sizing", "curvature")):
            report = remeshed(name + ".off", *options)
            assert report["euler_before"] == report["euler_after"] == euler, report
            assert report["parts_before"] == report["parts_after"] and report["intersections"] == 0, report
            assert 0 < max(report["distance_from_input"], report["distance_to_input"]) <= 0.01 * report["diagonal"], report
            assert not FILES.report("repair", "fine.vtp", "--output", "same.vtp")["changed"], name


def test_what_is_no_manifold_is_to_be_repaired():
    FILES.unpack_meshes("cow")
    done = FILES.run("remesh", "cow.off", "--output", "no.vtp", status=1)
    assert "repair" in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
    done = FILES.run("remesh", "cow.off", "--sizing", "array", "--size-array", "Lengths", "--output", "no.vtp", status=1)
    assert "there is no point array 'Lengths'" in done.stderr, done.stderr
    assert FILES.run("remesh", "cow.off", "--size", "-1", "--output", "no.vtp", status=2).stderr


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
