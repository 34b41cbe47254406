# SPDX-License-Identifier: BSD-3-Clause
"""Files of Bezier extraction operators (BEXT) from Python and from the command line: what they hold by a reader of our own, there and back,
every job's input, changed coefficients."""
import json
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy


def path(name):
    return knotwork_testing.output("bext/" + name)


def by_hand(name):
    return knotwork_testing.data("SplineIO/" + name)


def text(name):
    with open(name) as stream:
        return stream.read()


def run(*arguments):
    done = knotwork_testing.run_program(*arguments)
    assert done.returncode == 0, (arguments, done.stderr)
    return done


def report(*arguments):
    run(*arguments, "--report", path("report.json"))
    with open(path("report.json")) as stream:
        return json.load(stream)


def read_text(name):
    """Degrees, control points, and the numbers and vectors of every element of a text, word by word."""
    lines = [line for line in text(name).splitlines() if line.strip() and not line.startswith("$")]
    assert lines[0].startswith("B E X T 2.0")
    words = iter(" ".join(lines[1:]).split())
    integers = lambda n: [int(next(words)) for _ in range(n)]
    _, num_nodes, num_elements, num_vectors, rational = integers(5)
    nodes = np.array([[float(next(words)) for _ in range(4)] for _ in range(num_nodes)])
    first = 1 + 1 + num_nodes
    num_blocks = integers(1)[0]
    elements = []
    blocks = []
    for line in lines[first + 1:first + 1 + num_blocks]:
        integers(len(line.split()))
        blocks.append([int(word) for word in line.split()])
    for _, count, functions, _, *degrees in blocks:
        elements += [(degrees, np.array(integers(functions)) - 1, np.array(integers(functions)) - 1) for _ in range(count)]
    dense, sparse = integers(2)
    sizes = [integers(2) for _ in range(dense)]
    vectors = [[float(next(words)) for _ in range(size)] for count, size in sizes for _ in range(count)]
    assert sparse == 0 and len(vectors) == num_vectors and len(elements) == num_elements and next(words, None) is None
    return nodes, elements, vectors, rational


def corners(degrees):
    """Places of the corners in VTK's order."""
    order = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)][:2 ** len(degrees)]
    strides = np.cumprod([1] + [p + 1 for p in degrees[:-1]])
    return [sum(end * p * stride for end, p, stride in zip(ends, degrees, strides)) for ends in order]


def make_inputs():
    """Splines of every kind: names of .vtu files."""
    run("source", "--shape", "arc", "--output", path("curve.vtu"))
    run("source", "--shape", "annulus-sector", "--degree", 3, "--elements", 3, 2, 1, "--output", path("tensor.vtu"))
    run("source", "--shape", "solid-torus", "--output", path("volume.vtu"))
    run("refine", path("tensor.vtu"), "--sphere", 1, 0, 0, 0.4, "--output", path("thb.vtu"))
    run("refine", path("tensor.vtu"), "--sphere", 1, 0, 0, 0.4, "--local-space", "lr", "--output", path("lr.vtu"))
    run("source", "--shape", "disc", "--output", path("patches.vtu"))
    with open(path("star.off"), "w") as stream:
        points = [(0, 0)] + [(round(np.cos(np.pi * k / 5) * (2 - k % 2), 6), round(np.sin(np.pi * k / 5) * (2 - k % 2), 6)) for k in range(10)]
        stream.write("OFF\n%d 5 0\n" % len(points) + "".join("%g %g 0\n" % point for point in points))
        stream.write("".join("4 0 %d %d %d\n" % ((2 * k + 9) % 10 + 1, 2 * k + 1, (2 * k + 1) % 10 + 1) for k in range(5)))
    run("unstructured", path("star.off"), "--degree", 2, "--output", path("unstructured.vtu"))
    return [path(name + ".vtu") for name in ("curve", "tensor", "volume", "thb", "lr", "patches", "unstructured")]


def test_what_is_written_by_another_reader():
    for name in make_inputs():
        bext = name[:-3] + "bext"
        run("convert", name, "--output", bext)
        nodes, elements, vectors, rational = read_text(bext)
        grid = knotwork.read(bext)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        original = knotwork.read(name)
        assert grid.GetNumberOfCells() == original.GetNumberOfCells() == len(elements)
        assert bool(rational) == (original.GetPointData().GetRationalWeights() is not None)
        weights = nodes[:, 3:] if rational else np.ones((len(nodes), 1))
        for e, (degrees, numbers, columns) in enumerate(elements):
            operator = np.array([vectors[column] for column in columns])
            homogeneous = operator.T @ np.hstack([nodes[numbers, :3] * weights[numbers], weights[numbers]])
            expected = (homogeneous[:, :3] / homogeneous[:, 3:])[corners(degrees)]
            for data in (grid, original):
                ids = data.GetCell(e).GetPointIds()
                found = np.array([data.GetPoint(ids.GetId(i)) for i in range(len(expected))])
                assert np.abs(found - expected).max() < 1e-13 * max(1, np.abs(points).max()), (name, e)


def test_there_and_back():
    for name in make_inputs():
        bext, json_file, back = name[:-3] + "bext", name[:-3] + "json", path("back.")
        run("convert", name, "--output", bext)
        run("convert", bext, "--output", back + "vtu")
        run("convert", back + "vtu", "--output", back + "bext")
        assert text(back + "bext") == text(bext), name
        run("convert", bext, "--output", json_file)
        run("convert", json_file, "--output", back + "bext")
        assert text(back + "bext") == text(bext), name
        assert set(report("info", bext)["kinds"]) == {"explicit"}, name


def test_jobs_say_the_same_of_both():
    for name in make_inputs():
        bext = name[:-3] + "bext"
        run("convert", name, "--output", bext)
        if "curve" not in name:
            ours, theirs = (knotwork_testing.run_program("validate", one, "--report", path("report.json")) for one in (name, bext))
            assert ours.returncode == theirs.returncode == 0, (name, ours, theirs)
            measures = [report("validate", one)["measure"] for one in (name, bext)]
            assert abs(measures[0] - measures[1]) < 1e-12 * abs(measures[0]), (name, measures)
        for one in (name, bext):
            run("tessellate", one, "--chordal-tolerance", 1e-3, "--output", path("drawn.vtp"))
        refined = knotwork_testing.run_program("refine", bext, "--output", path("never.vtu"))
        assert refined.returncode == 1 and len(refined.stderr.splitlines()) == 1 and "no mesh to refine" in refined.stderr, refined
        assert os.path.basename(bext) in refined.stderr, refined
        for ending in ("xml", "g2", "step"):
            done = knotwork_testing.run_program("convert", bext, "--output", path("never." + ending))
            assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and "cannot be written" in done.stderr, done
            assert not os.path.exists(path("never." + ending))


def test_moved_points_are_written():
    """Control points of an affine image are the images of the control points."""
    for name in make_inputs():
        bext = name[:-3] + "bext"
        run("convert", name, "--output", bext)
        grid = knotwork.read(bext)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        points[:] = points @ np.array([[2, 0, 0], [1, 1, 0], [0, -1, 3.0]]) + [5, 0, -1]
        grid.GetPoints().Modified()
        knotwork.write(grid, path("moved.bext"))
        before, after = read_text(bext), read_text(path("moved.bext"))
        expected = before[0][:, :3] @ np.array([[2, 0, 0], [1, 1, 0], [0, -1, 3.0]]) + [5, 0, -1]
        assert np.abs(after[0][:, :3] - expected).max() < 1e-11, name  # 64 eps of the size 10, times the condition of the bases
        assert before[2] == after[2] and text(bext).count("\n") == text(path("moved.bext")).count("\n"), name


def test_changed_coefficients_name_their_element():
    for name, begin, word, other, element in (("by_hand.bext", "12       6\n", "5.0000000000000000E-01", "5.0010000000000000E-01", "element 1"),
                                              ("by_hand_bext.json", "components", "0.5", "0.5001", "element 0")):
        head, tail = text(by_hand(name)).split(begin, 1)
        bad = path("bad" + os.path.splitext(name)[1])
        with open(bad, "w") as stream:
            stream.write(head + begin + tail.replace(word, other, 1))
        done = knotwork_testing.run_program("info", bad)
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, done
        assert os.path.basename(bad) in done.stderr and element in done.stderr and "do not sum to one" in done.stderr, done.stderr
        try:
            knotwork.read(bad)
        except ValueError as error:
            assert element in str(error), error
        else:
            raise AssertionError("the file is read")


def test_dimensions_have_files_of_their_own():
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    run("source", "--shape", "line", "--output", path("curve.vtu"))
    run("source", "--shape", "square", "--output", path("square.vtu"))
    both = vtkAppendFilter()
    for name in ("curve.vtu", "square.vtu"):
        both.AddInputData(knotwork.read(path(name)))
    both.Update()
    try:
        knotwork.write(both.GetOutput(), path("both.bext"))
    except ValueError as error:
        assert "files of their own" in str(error), error
    else:
        raise AssertionError("curves and surfaces are in one file")


knotwork_testing.main(globals())
