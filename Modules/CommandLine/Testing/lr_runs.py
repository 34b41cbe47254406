# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the program on LR surfaces, and values of what they wrote."""
import json
import pathlib
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import knotwork_testing
import skeletons


def path(name):
    """A file of the running script alone: scripts run side by side."""
    return knotwork_testing.output(f"cli_lr/{pathlib.Path(sys.argv[0]).stem}/{name}")


def text(name):
    with open(name) as stream:
        return stream.read()


def run(*arguments):
    report = path("report.json")
    done = knotwork_testing.run_program(*arguments, "--report", report, "--quiet")
    assert done.returncode == 0, (arguments, done.stderr)
    return json.loads(text(report))


def values(surface, parameters):
    """Points of a surface at parameters."""
    at = skeletons.write(skeletons.polydata([parameters]), path("at.vtp"))
    run("evaluate", surface, at, "--output", path("on.vtp"), "--patch-id-array", "none")
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path("on.vtp"))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()).copy()


def there_and_back(given):
    """The file as g2, twice, and by way of a grid: the same text, left as first.g2, grid.vtu and third.g2."""
    run("convert", given, "--output", path("first.g2"))
    run("convert", path("first.g2"), "--output", path("second.g2"))
    run("convert", path("first.g2"), "--output", path("grid.vtu"))
    run("convert", path("grid.vtu"), "--output", path("third.g2"))
    assert text(path("first.g2")) == text(path("second.g2")) == text(path("third.g2")), given


def uniform(n=300):
    return np.random.default_rng(7).random((n, 2))


def local_square(space="lr"):
    """A biquadratic square, bent by nothing, with one corner refined."""
    run("source", "--shape", "square", "--degree", 2, "--elements", 6, 6, 1, "--size", 2, 1, 1, "--output", path("square.vtu"))
    report = run("refine", path("square.vtu"), "--sphere", -0.4, 0, 0, 0.1, "--local-space", space, "--output", path("local.g2"
                 if space == "lr" else "local.vtu"))
    assert report["local_space"] == space
    return path("local.g2" if space == "lr" else "local.vtu")
