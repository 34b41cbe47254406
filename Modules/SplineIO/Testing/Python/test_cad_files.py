# SPDX-License-Identifier: BSD-3-Clause
"""STEP and IGES from Python and from the command line: conversion, triangles, damaged files."""
import os

import knotwork
import knotwork_testing


def path(name):
    return knotwork_testing.output("spline_io/" + name)


def run(*arguments):
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode == 0, (arguments, done.stderr)
    return done


def test_classes():
    source = knotwork.vtkSplineSource()
    writer = knotwork.vtkCADWriter()
    writer.SetInputConnection(source.GetOutputPort())
    writer.SetFileName(path("from_python.step"))
    assert writer.Write() == 1
    reader = knotwork.vtkCADReader()
    reader.SetFileName(path("from_python.step"))
    assert reader.CanReadFile(path("from_python.step")) == 1
    reader.Update()
    assert reader.GetOutputDataObject(0).GetNumberOfCells() > 0
    assert reader.GetOutputDataObject(2).GetNumberOfCells() > 0


def test_jobs_take_and_give_cad_files():
    run("source", "--shape", "disc", "--output", path("disc.vtu"))
    for ending in ("step", "igs"):
        run("convert", path("disc.vtu"), "--output", path("disc." + ending))
        run("info", path("disc." + ending))
        run("tessellate", path("disc." + ending), "--output", path("disc_%s.vtp" % ending))
        # surfaces and curves by themselves, and together again
        run("convert", path("disc." + ending), "--output", path("surfaces.vtu"), "--curves", path("curves.vtu"))
        run("convert", path("surfaces.vtu"), "--curves", path("curves.vtu"), "--output", path("again.step"))
        run("convert", path("disc." + ending), "--output", path("direct.step"))
    run("source", "--shape", "solid-tube", "--output", path("tube.vtu"))
    run("convert", path("tube.vtu"), "--output", path("tube.step"))
    with open(path("tube.step")) as stream:
        assert "MANIFOLD_SOLID_BREP" in stream.read()


def test_damaged_files_are_errors_that_name_the_file():
    run("source", "--shape", "disc", "--output", path("disc.vtu"))
    for ending in ("step", "igs"):
        good = path("good." + ending)
        run("convert", path("disc.vtu"), "--output", good)
        with open(good, "rb") as stream:
            data = stream.read()
        for kind, content in (("empty", b""), ("half", data[: len(data) // 2]), ("noise", b"hello world\n" * 100),
                              ("zeros", bytes(5000)), ("hole", data[:2000] + data[-2000:])):
            bad = path("bad_%s.%s" % (kind, ending))
            with open(bad, "wb") as stream:
                stream.write(content)
            done = knotwork_testing.run_program("convert", bad, "--output", path("out.vtu"))
            assert done.returncode > 0, (kind, ending, done.returncode, done.stderr)
            assert os.path.basename(bad) in done.stderr, (kind, ending, done.stderr)


def test_python_survives_a_file_that_crashes_opencascade():
    reader = knotwork.vtkCADReader()
    assert reader.GetSeparateProcess()
    reader.SetFileName(knotwork_testing.data("Hostile/crashes_opencascade.iges"))
    with knotwork_testing.Errors(reader) as errors:
        reader.Update()
    assert reader.GetErrorCode() != 0 and "its reader crashed" in errors[0], errors
    reader.SetFileName(knotwork_testing.data("Hostile/sound.step"))
    reader.Update()
    assert reader.GetErrorCode() == 0 and reader.GetOutputDataObject(2).GetNumberOfCells() > 0


knotwork_testing.main(globals())
