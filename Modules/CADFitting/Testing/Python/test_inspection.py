# SPDX-License-Identifier: BSD-3-Clause
"""What inspection does with a scan, from files to files: onto its model, to a coordinate system of its faces, deviations both ways; pictures of them."""
import json
import os

import knotwork
import knotwork_testing
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: before the first renderer is made
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

FILES = knotwork_testing.Files("inspection")


def box(*lengths, centre=(0, 0, 0)):
    source = vtkCubeSource()
    source.SetXLength(lengths[0])
    source.SetYLength(lengths[1])
    source.SetZLength(lengths[2])
    source.SetCenter(*centre)
    source.SetOutputPointsPrecision(1)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def report(name="report.json"):
    with open(FILES.path(name), encoding="utf-8") as file:
        return json.load(file)


def write(data, name):
    knotwork.write(data, FILES.path(name))


def read(name):
    return knotwork.read(FILES.path(name))


def test_datums_by_the_numbers_of_recognize():
    transform = vtkTransform()
    transform.Translate(4, -7, 2)
    transform.RotateWXYZ(100, 1, 1, 3)
    moved = vtkTransformFilter()
    moved.SetTransform(transform)
    moved.SetInputData(box(4, 3, 1))
    moved.SetOutputPointsPrecision(1)
    moved.Update()
    write(moved.GetOutput(), "moved.vtp")
    FILES.run("recognize", "moved.vtp", "--output", "regions.vtp", "--regions", "regions.csv")
    # the output of recognize brings its numbers with it: the largest faces are the first
    FILES.run("align", "regions.vtp", "--datum-plane", 1, "--datum-axis", 3, "--datum-point", 5, "--inward", "--output", "datums.vtp",
        "--report", "report.json")
    found = report()
    assert found["regions"] == 6 and found["free_motions"] == 0
    bounds = read("datums.vtp").GetBounds()
    assert np.allclose(np.sort(np.ptp(np.reshape(bounds, (3, 2)), axis=1)), (1, 3, 4)), bounds
    assert abs(bounds[4]) < 1e-9 and abs(bounds[5] - 1) < 1e-9 and abs(bounds[0]) < 1e-9, bounds
    matrix = np.reshape(found["motion"], (4, 4))
    before, after = (vtk_to_numpy(read(name).GetPoints().GetData()) for name in ("regions.vtp", "datums.vtp"))
    assert np.allclose(before @ matrix[:3, :3].T + matrix[:3, 3], after, atol=1e-12)
    # options and keys are those of what runs
    assert found["recognition_tolerance"] == 0 and found["maximum_sag"] == 5
    assert not {"samples", "tolerance", "coarse", "outliers", "trimmed_share"} & set(found), found
    datums = ("--datum-plane", 1, "--output", "x.vtp")
    for words in (("--samples", 500), ("--tolerance", 1e-3), ("--coarse", 0), ("--outliers", "tukey"), ("--trimmed-share", 0.1)):
        assert words[0] + " is of" in FILES.run("align", "moved.vtp", *datums, *words, status=1).stderr
    for words in (("--inward", ), ("--maximum-sag", 3), ("--recognition-tolerance", 0.1)):
        assert words[0] + " is of" in FILES.run("align", "moved.vtp", "--to", "moved.vtp", "--output", "x.vtp", *words, status=1).stderr
    FILES.run("align", "moved.vtp", *datums, "--recognition-tolerance", 0.001, "--report", "report.json")
    assert report()["recognition_tolerance"] == 0.001
    FILES.run("align", "moved.vtp", "--to", "moved.vtp", "--output", "x.vtp", "--report", "report.json")
    found = report()
    assert found["samples"] == 10000 and not {"datum_plane", "inward", "recognition_tolerance"} & set(found), found
    for point in ("0,1", "4,4,4"):  # opposite sides, one side again
        assert "fixes nothing" in FILES.run("align", "moved.vtp", *datums, "--datum-point", point, status=1).stderr
    assert "region 17" in FILES.run("align", "moved.vtp", "--datum-plane", 17, "--output", "x.vtp", status=1).stderr
    assert "either" in FILES.run("align", "moved.vtp", "--datum-plane", 1, "--to", "moved.vtp", "--output", "x.vtp", status=1).stderr
    assert "--datum-plane" in FILES.run("align", "moved.vtp", "--output", "x.vtp", status=1).stderr


def test_both_ways_on_a_step_file():
    write(box(3, 2, 1), "block.vtp")
    FILES.run("trim", "block.vtp", "--output", "block.step")
    write(box(3, 2, 1.2, centre=(0, 0, 0.1)), "thick.vtp")
    FILES.run("distance", "thick.vtp", "block.step", "--both-ways", "--output", "scan.vtp", "--model", "model.vtp", "--percentiles", "percentiles.csv",
        "--report", "report.json")
    found = report()
    assert found["both_ways"] is True and found["signed"] is True and found["points_without"] == 0
    assert abs(found["scan_max"] - 0.2) < 1e-9 and abs(found["scan_min"]) < 1e-9
    # a quarter and a bit of the model is below the new top: 6 of 22
    assert abs(found["model_max"] - 0.2) < 1e-9 and abs(found["model_min"]) < 1e-9
    assert found["percentile_levels"] == [50, 90, 95, 99, 99.9, 100]
    assert abs(found["model_percentiles"][0]) < 1e-9 and abs(found["model_percentiles"][1] - 0.2) < 1e-9
    table = np.genfromtxt(FILES.path("percentiles.csv"), delimiter=",", names=True)
    assert np.allclose(table["ModelToScan"], found["model_percentiles"]) and np.allclose(table["ScanToModel"], found["scan_percentiles"])
    model = read("model.vtp")
    distance = vtk_to_numpy(model.GetPointData().GetArray("Distance"))
    top = vtk_to_numpy(model.GetPoints().GetData())[:, 2] > 0.5 - 1e-9
    assert len(distance) == found["model_points"] >= 20000 and np.allclose(distance[top][np.abs(distance[top]) > 1e-6].max(), 0.2)
    assert found["samples"] == 20000 and not {"kind", "tolerances"} & set(found), found
    for words, said in ((("--model", "m.vtp"), "--both-ways"), (("--both-ways", "--tolerances", 0.1), "--tolerances"),
                        (("--both-ways", "--kind", "closest"), "--kind is of"), (("--samples", 500), "--samples is of"),
                        (("--maximum-distance", 0.5), "--maximum-distance is of")):
        assert said in FILES.run("distance", "thick.vtp", "block.step", "--output", "x.vtp", *words, status=1).stderr
    assert "10000000" in FILES.run("distance", "thick.vtp", "block.step", "--both-ways", "--samples", 100000000, "--output", "x.vtp", status=2).stderr
    FILES.run("distance", "thick.vtp", "block.step", "--kind", "closest", "--output", "x.vtp", "--report", "report.json")
    found = report()
    assert found["kind"] == "closest" and not {"samples", "maximum_distance"} & set(found), found


def test_what_cannot_be_compared():
    write(box(3, 2, 1), "block.vtp")
    knotwork.write(box(3, 2, 1), FILES.path("block.obj"))
    np.savetxt(FILES.path("far.xyz"), [[10, 0, 0]])
    np.savetxt(FILES.path("near.xyz"), [[1.6, 0, 0]])
    for model in ("block.obj", "block.vtp"):
        done = FILES.run("distance", "near.xyz", model, "--output", "x.vtp", status=1)
        assert f"'{model}' holds triangles: give --both-ways" in done.stderr and "vtk" not in done.stderr, done.stderr
    assert "holds no surface" in FILES.run("distance", "near.xyz", "far.xyz", "--output", "x.vtp", status=1).stderr
    # nothing of the model is near the scan
    words = ("block.obj", "--both-ways", "--maximum-distance", 0.5, "--output", "x.vtp", "--report", "report.json")
    assert "within 0.5 of the scan" in FILES.run("distance", "far.xyz", *words, status=1).stderr
    FILES.run("distance", "near.xyz", *words)
    found = report()
    assert 0 < found["model_points"] and 0 < found["points_without"] and abs(found["scan_max"] - 0.1) < 1e-12, found


def test_a_stray_point_leaves_other_signs_alone():
    """Beside the acute edge of a wedge, at x = 0: outside, whatever else was scanned."""
    corners = np.array([(0, 0, 0), (2, -0.2, 0), (2, 0.2, 0), (0, 0, 1), (2, -0.2, 1), (2, 0.2, 1)], float)
    triangles = [(0, 2, 1), (3, 4, 5), (0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5)]
    with open(FILES.path("wedge.off"), "w", encoding="utf-8") as file:
        file.write("OFF\n6 8 0\n" + "".join("%g %g %g\n" % tuple(p) for p in corners) + "".join("3 %d %d %d\n" % t for t in triangles))
    for others in ([], [[1e6, 0, 0]], [[0, 0, 1e50]]):
        np.savetxt(FILES.path("scan.xyz"), [[-0.5, 0.2, 0.5], *others], fmt="%.17g")
        FILES.run("distance", "scan.xyz", "wedge.off", "--both-ways", "--output", "x.vtp", "--report", "report.json")
        assert abs(report()["scan_min"] - np.hypot(0.5, 0.2)) < 1e-12, (others, report())


def actor(polydata, limit):
    """Colours of Distance, blue inside and red outside."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(9)
    for i in range(9):
        share = i / 4 - 1
        table.SetTableValue(i, 0.8 + min(share, 0) * 0.7, 0.8 - abs(share) * 0.7, 0.8 - max(share, 0) * 0.7, 1)
    table.SetRange(-limit, limit)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("Distance")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().LightingOff()
    return result


def test_picture():
    """A block with a dent (blue) and a boss (red) on top, aligned from another pose, on its model."""
    source = box(3, 2, 1)
    divided = knotwork.vtkDeviationMap()  # of itself: evenly divided triangles
    divided.SetInputDataObject(source)
    divided.SetModelData(source)
    divided.SetSamples(8000)
    divided.Update()
    scan = divided.GetOutputDataObject(1)
    points = vtk_to_numpy(scan.GetPoints().GetData())
    for x, height in ((-0.8, -0.12), (0.8, 0.12)):
        near = np.exp(-8 * ((points[:, 0] - x)**2 + points[:, 1]**2))
        points[:, 2] += np.where(points[:, 2] > 0.49, height * near, 0)
    points[:] = points @ np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]]).T + (9, 4, -2)
    scan.GetPoints().Modified()
    alignment = knotwork.vtkRigidAlignment()
    alignment.SetInputDataObject(scan)
    alignment.SetTargetData(source)
    deviation = knotwork.vtkDeviationMap()
    deviation.SetInputConnection(0, alignment.GetOutputPort(0))
    deviation.SetModelData(source)
    deviation.Update()
    numbers = deviation.GetOutputDataObject(3)
    assert abs(numbers.GetValueByName(0, "ScanMin").ToDouble() + 0.12) < 0.005, numbers.GetValueByName(0, "ScanMin").ToDouble()
    assert abs(numbers.GetValueByName(0, "ScanMax").ToDouble() - 0.12) < 0.005
    renderer = vtkRenderer()
    renderer.AddActor(actor(deviation.GetOutputDataObject(1), 0.12))
    renderer.GetActiveCamera().SetPosition(1.0, -3.0, 4.0)
    renderer.GetActiveCamera().SetViewUp(0, 0, 1)
    renderer.ResetCamera()
    # half turns lay the block on itself: the dent comes to one of four places, seen from above or not
    top = vtk_to_numpy(deviation.GetOutputDataObject(1).GetPointData().GetArray("Distance"))
    where = vtk_to_numpy(deviation.GetOutputDataObject(1).GetPoints().GetData())[np.argmin(top)]
    renderer.GetActiveCamera().Azimuth(0 if where[0] < 0 else 180)
    if where[2] < 0:
        renderer.GetActiveCamera().SetPosition(*(np.array(renderer.GetActiveCamera().GetPosition()) * (1, 1, -1)))
    knotwork_testing.render_and_compare(renderer, "DeviationMap", 200)


knotwork_testing.main(globals())
