# SPDX-License-Identifier: BSD-3-Clause
"""From files to files: boundaries of splines, meshes of libcgal-demo that TetGen alone refuses, what is said of bad ones."""
import os

import knotwork_testing

FILES = knotwork_testing.Files("tetrahedralize")


def test_a_spline_and_its_boundary():
    FILES.run("source", "--shape", "solid-cylinder", "--output", "rod.vtu", "--force")
    boundary = FILES.report("boundary", "rod.vtu", "--chordal-tolerance", "0.005", "--output", "rod.vtp")
    assert boundary["closed"] and boundary["volume"] < 3.1416, boundary
    straight = FILES.report("tetrahedralize", "rod.vtp", "--output", "straight.vtu")
    assert abs(straight["volume"] - boundary["volume"]) < 1e-9 and straight["verdict"] == "valid", straight
    curved = FILES.report("tetrahedralize", "rod.vtp", "--target", "rod.vtu", "--order", "2", "--output", "curved.vtu")
    assert curved["curved_to_target"] < 0.1 * curved["straight_to_target"], curved
    assert abs(curved["volume"] - 3.14159265) < 1e-3 and curved["verdict"] == "valid", curved
    FILES.run("validate", "curved.vtu")


def test_no_cell_lies_flat_on_a_smooth_boundary():
    """TetGen leaves cells with two faces on the tube, which would have to be moved back from it."""
    FILES.run("source", "--shape", "solid-torus", "--inner-radius", "0.3", "--angle", "270", "--output", "torus.vtu", "--force")
    FILES.run("boundary", "torus.vtu", "--chordal-tolerance", "0.01", "--output", "torus.vtp", "--force")
    FILES.run("remesh", "torus.vtp", "--size", "0.2", "--output", "even.vtp", "--force")
    for order in (2, 3):
        found = FILES.report("tetrahedralize", "even.vtp", "--target", "torus.vtu", "--order", order, "--edge-length", "0.2", "--output", "torus_tets.vtu")
        assert found["verdict"] == "valid" and found["relaxed_elements"] == 0, found
        assert found["curved_to_target"] < 0.05 * found["straight_to_target"], found


def boxes(name, *sizes):
    """Cubes about the origin as one file."""
    corners = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    sides = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    points = [tuple(size * x for x in corner) for size in sizes for corner in corners]
    triangles = [(8 * i + side[0], 8 * i + side[k], 8 * i + side[k + 1]) for i in range(len(sizes)) for side in sides for k in (1, 2)]
    with open(FILES.path(name), "w", encoding="utf-8") as stream:
        stream.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        stream.writelines("%g %g %g\n" % point for point in points)
        stream.writelines("3 %d %d %d\n" % triangle for triangle in triangles)


def test_points_tell_sizes_of_regions():
    boxes("both.off", 2, 1)
    with open(FILES.path("sizes.csv"), "w", encoding="utf-8") as stream:
        stream.write("x,y,z,Length\n0,0,0,0.2\n1.5,0,0,1\n")
    words = ("tetrahedralize", "both.off", "--inner", "regions", "--keep-boundary", "off")
    plain = FILES.report(*words, "--output", "plain.vtu")
    sized = FILES.report(*words, "--sizes", "sizes.csv", "--output", "sized.vtu")
    assert sized["regions"] == 2 and sized["verdict"] == "valid" and abs(sized["volume"] - 64) < 1e-9, sized
    # a cube of side 2 in tetrahedra of edges of 0.2 at most
    assert sized["tetrahedra"] > max(2 * plain["tetrahedra"], 8 * 6 * 2 ** 0.5 / 0.2 ** 3), (plain, sized)
    done = FILES.run(*words, "--sizes", "sizes.csv", "--size-array", "Width", "--output", "no.vtu", status=1)
    assert "no array 'Width'" in done.stderr and not os.path.exists(FILES.path("no.vtu")), done.stderr


def test_faces_are_groups_of_solvers():
    """The faces of a box, as `features` tells them, are groups of triangles beside the tetrahedra, of any order; boundary attributes of MFEM."""
    boxes("box.off", 2)
    FILES.run("features", "box.off", "--output", "regions.vtp", "--force")
    for order in (1, 2, 3):
        said = FILES.report("tetrahedralize", "regions.vtp", "--edge-length", "1.5", "--keep-boundary", "0", "--order", order, "--boundary-cells", "1", "--output", "box.msh")
        FILES.report("validate", "box.msh")
        with open(FILES.path("box.msh"), encoding="latin-1") as stream:
            names = stream.read().split("$PhysicalNames\n")[1].split("$End")[0].split("\n")
        assert [line for line in names if line.startswith("2 ")] == [f'2 {i + 1} "BoundaryId {i}"' for i in range(6)], names
        assert [line for line in names if line.startswith("3 ")] == ['3 1 "Region 0"'], names
        FILES.run("convert", "box.msh", "--output", "box.mesh", "--force")
        with open(FILES.path("box.mesh"), encoding="utf-8") as stream:
            lines = stream.read().split("boundary\n")[1].split("\n")
        assert int(lines[0]) == said["boundary_triangles"]
        assert {line.split()[0] for line in lines[1:1 + int(lines[0])]} == set("123456"), lines[:3]


def test_sides_of_a_spline_are_groups():
    """Those of one volume by number, of several with that of the patch; from the spline and from its `boundary` alike."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    for shape, number in (("cube", 6), ("ball", 0)):
        FILES.run("source", "--shape", shape, "--output", "volume.vtu", "--force")
        FILES.run("boundary", "volume.vtu", "--chordal-tolerance", "0.02", "--output", "volume.vtp", "--force")
        found = []
        for surface in ("volume.vtu", "volume.vtp"):
            FILES.report("tetrahedralize", surface, "--chordal-tolerance", "0.02", "--boundary-cells", "1", "--output", "sides.vtu")
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(FILES.path("sides.vtu"))
            reader.Update()
            ids = vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("BoundaryId"))
            found.append(sorted(set(ids[ids >= 0].tolist())))
        assert found[0] == found[1] and (found[0] == list(range(6)) if number else len(found[0]) >= 6), (shape, found)


def test_images():
    """Two balls that merge, as an implicit function on a grid, and a damaged file."""
    from vtkmodules.vtkCommonCore import vtkDoubleArray
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
    image, values = vtkImageData(), vtkDoubleArray()
    image.SetDimensions(41, 31, 31)
    image.SetOrigin(-2, -1.5, -1.5)
    image.SetSpacing(0.1, 0.1, 0.1)
    values.SetName("Function")
    for p in range(image.GetNumberOfPoints()):
        x, y, z = image.GetPoint(p)
        values.InsertNextValue(min(((x - side) ** 2 + y * y + z * z) ** 0.5 for side in (-0.5, 0.5)) - 1)
    image.GetPointData().AddArray(values)
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetFileName(FILES.path("balls.vti"))
    writer.Write()
    found = FILES.report("tetrahedralize", "balls.vti", "--level", 0, "--edge-length", 0.3, "--chordal-tolerance", 0.002, "--output", "balls.vtu")
    # two balls less the lens that both have, of height 0.5 on each side
    expected = 2 * 4 / 3 * 3.14159265 - 2 * 3.14159265 * 0.25 * (3 - 0.5) / 3
    assert found["verdict"] == "valid" and abs(found["volume"] / expected - 1) < 0.03, (found, expected)
    FILES.run("validate", "balls.vtu")
    FILES.refused("tetrahedralize", "balls.vti", "--level", -2, "--output", "no.vtu", said=("nothing is solid", ))
    with open(FILES.path("balls.vti"), "rb") as stream:
        text = stream.read()
    with open(FILES.path("short.vti"), "wb") as stream:
        stream.write(text[:len(text) // 2])
    FILES.refused("tetrahedralize", "short.vti", "--output", "no.vtu", said=("short.vti", "damaged"))
    FILES.refused("trim", "balls.vti", "--output", "no.step")


def test_flat_cells_do_not_hang():
    """A point of the surface lies on the edge of another triangle but for rounding: so flat a cell is one of a mesh that conforms."""
    FILES.unpack_meshes("mpi_triang")
    found = FILES.report("tetrahedralize", "mpi_triang.off", "--output", "mpi.vtu")
    assert found["verdict"] == "valid" and not found["repaired"], found


def test_intersections_are_named_and_repaired():
    FILES.unpack_meshes("bull")
    done = FILES.run("tetrahedralize", "bull.off", "--output", "no.vtu", status=1)
    assert "turned" in done.stderr or "intersect" in done.stderr, done.stderr
    assert "repair" in done.stderr and not os.path.exists(FILES.path("no.vtu")), done.stderr
    found = FILES.report("tetrahedralize", "bull.off", "--repair", "--output", "bull.vtu")
    assert found["repaired"] and found["verdict"] == "valid", found
    assert max(found["distance_to_surface"], found["distance_from_surface"]) <= 1e-3 * found["diagonal"], found


knotwork_testing.main(globals())
