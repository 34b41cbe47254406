# SPDX-License-Identifier: BSD-3-Clause
"""Filters of the plugin in two processes of pvbatch: with data in both, those that need the whole say so once, those that
work on cells or points do their piece and sum up what they found; with data in one of them all are right; nobody waits for ever."""
import collections
import os
import re
import shutil
import signal
import subprocess
import sys
import traceback

import knotwork_testing

WORDS = "the whole input is needed, and it is spread over 2 of 2 processes"


def grid_of_quads(x):
    """A quadrilateral of which those of the two processes overlap."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkUnstructuredGrid
    points, grid = vtkPoints(), vtkUnstructuredGrid()
    for corner in ((0, 0), (1, 0), (1, 1), (0, 1)):
        points.InsertNextPoint(x + corner[0], corner[1], 0)
    grid.SetPoints(points)
    grid.InsertNextCell(VTK_QUAD, 4, [0, 1, 2, 3])
    return grid


def in_one_process():
    """What a process does; a line for every filter with the cells of its first output."""
    knotwork_testing.load_plugin()
    import paraview.simple as simple
    from mpi4py import MPI
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkFiltersSources import vtkPlaneSource
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
    rank = MPI.COMM_WORLD.rank

    def producer(data):
        made = simple.PVTrivialProducer()
        made.GetClientSideObject().SetOutput(data)
        return made

    def say(kind, name, proxy):
        proxy.UpdatePipeline()
        algorithm = proxy.GetClientSideObject()
        output = algorithm.GetOutputDataObject(0)
        # on a line of its own, whatever the other process writes
        print(f"\n{kind} {name} {rank} {output.GetNumberOfElements(output.CELL)} {algorithm.GetErrorCode()}\n", end="", flush=True)

    square = simple.KnotworkSplineSource(Center=[0, 0, 0], Elements=[3, 3, 1])
    square.UpdatePipeline()
    plane = vtkPlaneSource()
    plane.SetResolution(12, 12)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(plane.GetOutputPort())
    triangles.Update()
    grid, mesh = vtkUnstructuredGrid(), vtkPolyData()
    grid.DeepCopy(square.GetClientSideObject().GetOutputDataObject(0))
    assert (grid.GetNumberOfCells() > 0) == (rank == 0)  # sources make their data in the first process alone
    file = knotwork_testing.output("two_processes_square.vtu")
    if rank == 0:
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(file)
        writer.SetDataModeToBinary()
        writer.Write()
    MPI.COMM_WORLD.Barrier()
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    grid.DeepCopy(reader.GetOutput())
    mesh.DeepCopy(triangles.GetOutput())
    everywhere = {"splines": producer(grid), "mesh": producer(mesh), "quads": producer(grid_of_quads(0.5 * rank))}
    first = {"splines": square, "mesh": producer(mesh if rank == 0 else vtkPolyData()),
             "quads": producer(grid_of_quads(0) if rank == 0 else vtkUnstructuredGrid())}
    nowhere = {"splines": producer(vtkUnstructuredGrid()), "mesh": producer(vtkPolyData()),
               "quads": producer(vtkUnstructuredGrid())}

    def whole(data):
        flat = simple.MeshParameterization(Input=data["mesh"])
        return {
            "SplineSurfaceFit": simple.SplineSurfaceFit(Input=data["mesh"], FindOutliers=1),
            "MeshParameterization": flat,
            "SplineCombine": simple.SplineCombine(Input=data["splines"], Second=data["splines"]),
            "SplineStitch": simple.SplineStitch(Input=data["splines"]),
            "SplineTrimToPoints": simple.SplineTrimToPoints(Input=data["splines"], Points=data["mesh"]),
            "TrimmedSurface": simple.TrimmedSurface(Input=data["mesh"]),
            "TemplateMapping": simple.TemplateMapping(Template=data["mesh"], Target=data["mesh"]),
            "DomainParameterization": simple.DomainParameterization(Input=data["splines"]),
        }

    def patches(data):
        return {
            "SplineContour": simple.SplineContour(Input=data["splines"], NumberOfLevels=1, Component=0),
            "SplineExtrema": simple.SplineExtrema(Input=data["splines"]),
        }

    def summed(data):
        return {
            "JacobianValidator": simple.JacobianValidator(Input=data["quads"]),
            "SplinePointDistance": simple.SplinePointDistance(Input=data["mesh"], Surface=data["splines"], Kind="Closest"),
            "Probe": simple.SplineEvaluate(Input=data["splines"], Points=data["mesh"], Mode="Probe"),
        }

    def numbers(name, proxy):
        """What the tables say, which the first process alone has."""
        algorithm = proxy.GetClientSideObject()
        table = algorithm.GetOutputDataObject(2)
        words = [str(table.GetNumberOfRows())]
        if table.GetNumberOfRows() > 0:
            columns = {"JacobianValidator": ("Cells", "ValidCells", "Injective"), "SplineContour": ("Components", "Closed"),
                       "SplineSurfaceFit": ("Functions", "PointsOutside")}.get(name, ("Points", "Max"))
            words += [table.GetValueByName(table.GetNumberOfRows() - 1, column).ToString() for column in columns]
        print(f"\nnumbers {name} {rank} {' '.join(words)}\n", end="", flush=True)

    for name, proxy in whole(everywhere).items():
        say("both", name, proxy)
    again = simple.SplineSurfaceFit(Input=simple.SplineSurfaceFit(Input=everywhere["mesh"], FindOutliers=1))
    say("chain", "SplineSurfaceFit", again)
    # the splines in the first process alone, the points in both: they are sent to the other one
    sent = {**everywhere, "splines": square}
    for name, proxy in summed(sent).items():
        say("summed", name, proxy)
        if name != "Probe":
            numbers(name, proxy)
    for name in ("SplineSurfaceFit", "MeshParameterization", "SplineCombine"):
        say("first", name, whole(first)[name])
    for name, proxy in summed(first).items():
        say("first", name, proxy)
    # points of both, fitted together by both; of one of them too
    for kind, data in (("fitted", everywhere), ("given", {"mesh": producer(mesh if rank == 1 else vtkPolyData())})):
        fit = simple.SplineSurfaceFit(Input=data["mesh"])
        say(kind, "SplineSurfaceFit", fit)
        if kind == "fitted":
            numbers("SplineSurfaceFit", fit)
    for name, proxy in {**whole(nowhere), **patches(nowhere), **summed(nowhere)}.items():
        say("nowhere", name, proxy)
    for name, proxy in {
            "SplineTessellate": simple.SplineTessellate(Input=everywhere["splines"]),
            "SplineControlNet": simple.SplineControlNet(Input=everywhere["splines"]),
            "SplineParametricMesh": simple.SplineParametricMesh(Input=everywhere["splines"]),
            "SplineRefine": simple.SplineRefine(Input=everywhere["splines"]),
            "SplineExtract": simple.SplineExtract(Input=everywhere["splines"], SwapParameters=1),
            "SplineWarp": simple.SplineWarp(Input=everywhere["quads"], Map=everywhere["splines"], Clamp=1),
            "SplineEvaluate": simple.SplineEvaluate(Input=everywhere["splines"], Points=producer(grid_of_quads(0))),
            "SplineContour": patches(everywhere)["SplineContour"],
    }.items():
        say("piece", name, proxy)
        if name == "SplineContour":
            numbers(name, proxy)
    sys.stdout.flush()
    sys.stderr.flush()
    MPI.Finalize()
    os._exit(0)


def run_twice(*command):
    """Both processes' status and what they say."""
    if not shutil.which("mpirun"):
        knotwork_testing.skip("there is no mpirun")
    done = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2", *command],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240)
    print(done.stdout)
    return done


def test_the_program_refuses():
    done = run_twice(knotwork_testing.PROGRAM, "source", "--output", knotwork_testing.output("two_processes.vtu"))
    assert done.returncode == 2 and done.stdout.count("knotwork source: started as one of several processes") == 1


def test_filters():
    done = run_twice("pvbatch", "--sym", os.path.abspath(__file__))
    assert done.returncode == 0
    found = collections.defaultdict(lambda: collections.defaultdict(dict))
    for kind, name, rank, cells, code in re.findall(r"^(\w+) (\w+) ([01]) (\d+) (\d+)$", done.stdout, re.M):
        found[kind][name][int(rank)] = (int(cells), int(code))
    assert all(sorted(ranks) == [0, 1] for names in found.values() for ranks in names.values()), found

    # one message for each of them and for the first validator of the chain, and no other
    assert len(found["both"]) == 8
    for name, ranks in found["both"].items():
        assert all(cells == 0 and code > 0 for cells, code in ranks.values()), (name, ranks)
    messages = done.stdout.count(WORDS)
    assert messages == done.stdout.count("ERR|") == len(found["both"]) + 1, messages
    # behind a failed one there is nothing to do, and nothing is waited for
    assert found["chain"]["SplineSurfaceFit"] == {0: (0, 0), 1: (0, 0)}

    # each has its piece; the numbers are those of both. Two squares half a side apart are valid and overlap
    assert len(found["summed"]) == 3
    for name, ranks in found["summed"].items():
        assert all(cells > 0 and code == 0 for cells, code in ranks.values()), (name, ranks)
    said = {(name, int(rank)): words.split() for name, rank, words in re.findall(r"^numbers (\w+) ([01]) (.*)$", done.stdout, re.M)}
    assert said["JacobianValidator", 0][1:] == ["2", "2", "not_injective"], said
    assert said["SplinePointDistance", 0][1] == str(2 * 13 * 13), said
    assert said["SplineContour", 0][1:] == ["2", "0"] and said["SplineContour", 1] == ["0"], said
    assert said["JacobianValidator", 1] == said["SplinePointDistance", 1] == ["0"], said

    # the surface and the table are in the first one, wherever the points are
    for kind in ("fitted", "given"):
        ranks = found[kind]["SplineSurfaceFit"]
        assert ranks[0][0] > 0 and ranks[1][0] == 0 and ranks[0][1] == ranks[1][1] == 0, (kind, ranks)
    assert int(said["SplineSurfaceFit", 0][1]) > 0 and said["SplineSurfaceFit", 0][2] == "0", said
    assert said["SplineSurfaceFit", 1] == ["0"], said

    for name, ranks in found["first"].items():
        assert ranks[0][0] > 0 and ranks[1][0] == 0 and ranks[0][1] == ranks[1][1] == 0, (name, ranks)
    for name, ranks in found["nowhere"].items():
        assert ranks == {0: (0, 0), 1: (0, 0)}, (name, ranks)
    for name, ranks in found["piece"].items():
        assert all(cells > 0 and code == 0 for cells, code in ranks.values()), (name, ranks)


if "OMPI_COMM_WORLD_SIZE" in os.environ:
    try:
        in_one_process()
    except BaseException:  # the other process may wait for this one
        traceback.print_exc()
        os.kill(os.getppid(), signal.SIGTERM)
else:
    knotwork_testing.main(globals())
