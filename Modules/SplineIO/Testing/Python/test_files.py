# SPDX-License-Identifier: BSD-3-Clause
"""knotwork.read and knotwork.write: every format of the table by the ending alone, what goes wrong is raised, and nothing is lost."""
import os
import warnings

import knotwork
import knotwork_testing
from vtkmodules.vtkCommonDataModel import vtkPartitionedDataSetCollection, vtkPolyData, vtkTable


def path(name):
    return knotwork_testing.output("files/" + name)


def source():
    """A rational surface of one patch."""
    made = knotwork.vtkSplineSource()
    made.SetShape(knotwork.vtkSplineSource.ANNULUS_SECTOR)
    made.Update()
    return made


def raised(error, call, *words):
    try:
        call()
    except error as failure:
        assert all(word in str(failure) for word in words), str(failure)
        return
    raise AssertionError(f"no {error.__name__}")


def points_of(grid):
    return sorted(grid.GetPoint(i) for i in range(grid.GetNumberOfPoints()))


def test_splines_come_back_from_every_format():
    """The boxes of the control points are those of the source: exact but for the last digits of text."""
    grid = source().GetOutputDataObject(0)
    for ending in (".vtu", ".xml", ".g2", ".step", ".stp", ".iges", ".igs"):
        knotwork.write(grid, path("splines" + ending))
        back = knotwork.read(path("splines" + ending))
        assert back.GetNumberOfCells() > 0, ending
        if ending in (".vtu", ".xml", ".g2"):
            assert points_of(back) == points_of(grid), ending


def test_a_filter_is_updated_and_a_path_is_a_name():
    import pathlib

    knotwork.write(knotwork.vtkSplineSource(), pathlib.Path(path("of_a_filter.vtu")))
    assert knotwork.read(pathlib.Path(path("of_a_filter.vtu"))).GetNumberOfCells() > 0


def test_meshes_and_points():
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputData(source().GetOutputDataObject(0))
    tessellate.Update()
    mesh = tessellate.GetOutput()
    assert isinstance(mesh, vtkPolyData)
    for ending in (".vtp", ".obj", ".ply", ".stl"):
        knotwork.write(mesh, path("mesh" + ending))
        assert knotwork.read(path("mesh" + ending)).GetNumberOfPolys() > 0, ending
    for ending in (".xyz", ".txt", ".csv"):
        knotwork.write(mesh, path("points" + ending))
        assert knotwork.read(path("points" + ending)).GetNumberOfPoints() == mesh.GetNumberOfPoints(), ending


def test_curves_of_faces():
    """What trims the faces of a STEP file is read with them, and makes the same faces when it is written again."""
    knotwork.write(source(), path("faces.step"))
    faces, curves = knotwork.read(path("faces.step"), with_curves=True)
    knotwork.write(faces, path("again.step"), curves=curves)
    again, same = knotwork.read(path("again.step"), with_curves=True)
    assert again.GetNumberOfCells() == faces.GetNumberOfCells()
    assert same.GetNumberOfCells() == curves.GetNumberOfCells()


def test_a_collection_replaces_its_own_pieces_and_nothing_else():
    grid = source().GetOutputDataObject(0)
    collection = vtkPartitionedDataSetCollection()
    collection.SetNumberOfPartitionedDataSets(2)
    collection.SetPartition(0, 0, grid)
    collection.SetPartition(1, 0, grid)
    for _ in range(2):
        knotwork.write(collection, path("parts.vtpc"))
    assert knotwork.read(path("parts.vtpc")).GetNumberOfPartitionedDataSets() == 2
    foreign = path("other/keep.txt")
    with open(foreign, "w", encoding="ascii") as stream:
        stream.write("mine")
    raised(OSError, lambda: knotwork.write(collection, path("other.vtpc")), "other", "holds other files")
    assert open(foreign, encoding="ascii").read() == "mine"


def test_what_goes_wrong_is_raised_and_nothing_is_lost():
    grid = source().GetOutputDataObject(0)
    raised(OSError, lambda: knotwork.read(path("missing.vtu")), "missing.vtu", "is not a file")
    with open(path("odd.stpe"), "w", encoding="ascii") as stream:
        stream.write("text")
    raised(ValueError, lambda: knotwork.read(path("odd.stpe")), "did you mean '.step'")
    raised(ValueError, lambda: knotwork.write(grid, path("odd.stl")), "change the ending")
    raised(ValueError, lambda: knotwork.write(None, path("none.vtu")), "no data")
    raised(ValueError, lambda: knotwork.write(grid, path("code.vtu"), encoding="base64"), "choose ascii")
    raised(OSError, lambda: knotwork.write(grid, "/nowhere/at/all.vtu"), "/nowhere/at/all.vtu")
    knotwork.write(grid, path("kept.xml"))
    with open(path("kept.xml"), "rb") as stream:
        before = stream.read()
    raised(ValueError, lambda: knotwork.write(vtkTable(), path("kept.xml")), "kept.xml")
    with open(path("kept.xml"), "rb") as stream:
        assert stream.read() == before
    with open(path("cut.g2"), "w", encoding="ascii") as stream:
        stream.write("200 1 0 0\n3 0\n2")
    raised(ValueError, lambda: knotwork.read(path("cut.g2")), "cut.g2")
    assert not [name for name in os.listdir(os.path.dirname(path("x"))) if name.startswith(".knotwork")]


def test_what_is_left_out_is_warned_of():
    with open(path("extra.xml"), "w", encoding="ascii") as stream:
        with open(path("kept.xml"), encoding="ascii") as kept:
            stream.write(kept.read().replace("</xml>", '<Geometry type="Unheard" id="77"> 1 </Geometry></xml>'))
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        knotwork.read(path("extra.xml"))
    assert any("left out" in str(warning.message) and warning.filename == __file__ for warning in heard), [str(w.message) for w in heard]


knotwork_testing.main(globals())
