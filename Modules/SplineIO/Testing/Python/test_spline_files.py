# SPDX-License-Identifier: BSD-3-Clause
"""G+Smo XML and g2 from Python and from the command line: conversion there and back, every job's input, bad files."""
import json
import os

import knotwork
import knotwork_testing


def path(name):
    return knotwork_testing.output("spline_io/" + name)


def by_hand(name):
    return knotwork_testing.data("SplineIO/by_hand." + name)


def text(name):
    with open(name) as stream:
        return stream.read()


def run(*arguments):
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode == 0, (arguments, done.stderr)
    return done


def test_classes():
    reader = knotwork.vtkGoToolsG2Reader()
    reader.SetFileName(by_hand("g2"))
    assert reader.CanReadFile(by_hand("g2")) == 1
    writer = knotwork.vtkGismoXMLWriter()
    writer.SetInputConnection(reader.GetOutputPort())
    writer.SetFileName(path("from_python.xml"))
    assert writer.Write() == 1
    assert 'type="Nurbs"' in text(path("from_python.xml"))


def test_convert_there_and_back():
    for name, endings in (("annulus-sector", ("xml", "g2")), ("solid-torus", ("xml", "g2")), ("disc", ("xml", "g2"))):
        run("source", "--shape", name, "--elements", 3, 2, 2, "--output", path("shape.vtu"))
        for ending in endings:
            run("convert", path("shape.vtu"), "--output", path("shape." + ending))
            run("convert", path("shape." + ending), "--output", path("back.vtu"))
            run("convert", path("back.vtu"), "--output", path("back." + ending))
            assert text(path("shape." + ending)) == text(path("back." + ending)), (name, ending)


def test_topology_survives_a_grid():
    run("convert", by_hand("xml"), "--output", path("two.vtu"))
    run("convert", path("two.vtu"), "--output", path("two.xml"))
    run("convert", by_hand("xml"), "--output", path("direct.xml"))
    assert text(path("two.xml")) == text(path("direct.xml"))
    assert "<interfaces>\n4 2 7 1 0 1 1 1\n</interfaces>" in text(path("two.xml"))


def test_jobs_take_and_give_spline_files():
    run("info", by_hand("xml"), "--report", path("info.json"))
    with open(path("info.json")) as stream:
        report = json.load(stream)
    assert report["patches"] == 4 and report["patch_ids"] == [4, 7, 0, 9], report
    assert report["kinds"].count("THB") == 1 and report["rational"] is True, report
    run("info", by_hand("g2"))
    run("source", "--shape", "square", "--degree", 2, "--elements", 4, 4, 1, "--output", path("square.g2"))
    run("refine", path("square.g2"), "--sphere", 0, 0, 0, 0.3, "--output", path("fine.xml"))
    assert 'type="THBSpline2"' in text(path("fine.xml"))
    run("tessellate", path("fine.xml"), "--output", path("fine.vtp"))


def test_bad_files_are_one_line_and_leave_no_output():
    truncated = path("truncated.xml")
    with open(truncated, "w") as stream:
        stream.write(text(by_hand("xml"))[:400])
    other = path("other.xml")
    with open(other, "w") as stream:
        stream.write("<?xml version='1.0'?>\n<VTKFile/>\n")
    huge = path("huge.g2")
    with open(huge, "w") as stream:
        stream.write("100 1 0 0\n3 0\n1000000000000000000 4\n0 0 0 0 1 1 1 1\n")
    for file, word in ((truncated, "line"), (other, "<VTKFile>"), (huge, "line 3")):
        for job in ("convert", "refine"):
            output = path("none.vtu")
            done = knotwork_testing.run_program(job, file, "--output", output)
            assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done.stderr
            assert os.path.basename(file) in done.stderr and word in done.stderr, done.stderr
            assert not os.path.exists(output)


def test_kinds_that_g2_has_not_become_tensor_products():
    output, report = path("fine.g2"), path("fine.json")
    run("source", "--shape", "square", "--degree", 2, "--elements", 4, 4, 1, "--output", path("square.vtu"))
    done = knotwork_testing.run_program("refine", path("square.vtu"), "--sphere", 0, 0, 0, 0.3, "--output", output)
    assert done.returncode == 0 and "tensor product" in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
    run("info", output, "--report", report)
    with open(report) as stream:
        assert json.load(stream)["kinds"] == ["tensor-product"]


knotwork_testing.main(globals())
