# SPDX-License-Identifier: BSD-3-Clause
"""Solids from files to files: cut, meshed with hexahedra that conform, fitted to one spline volume."""
import glob
import json
import os

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

FOLDER = os.path.dirname(knotwork_testing.output("cad_hexahedra/files"))
PISTON = knotwork_testing.data(os.path.join("Parts", "piston.step"))
VOLUME = 131458.91  # its own, of OpenCASCADE
FACETS = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def run(job, *arguments, report=None):
    words = [*map(str, arguments), "--force", *(["--report", report] if report else [])]
    done = knotwork_testing.run_program(job, *words, folder=FOLDER, timeout=600)
    assert done.returncode == 0, (job, arguments, done.stderr)
    if report:
        with open(os.path.join(FOLDER, report), encoding="utf-8") as file:
            return json.load(file)
    return None


def meshed(part, *options):
    report = run("hexes", part, *options, "--output", "hexes.vtu", report="hexes.json")
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(os.path.join(FOLDER, "hexes.vtu"))
    reader.Update()
    return report, reader.GetOutput()


def check_conforming(report, mesh):
    """Counted here, from the file: every side lies between two hexahedra or on the boundary, which is closed."""
    cells = vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 8)
    assert len(cells) == report["hexahedra"] == report["valid_cells"] and report["verdict"] == "valid", report
    assert len(np.unique(cells)) == mesh.GetNumberOfPoints() == report["points"]
    sides = np.sort(np.vstack([cells[:, facet] for facet in FACETS]), 1)
    facets, counts = np.unique(sides, axis=0, return_counts=True)
    assert counts.max() <= 2
    dimension = vtk_to_numpy(mesh.GetPointData().GetArray("CADEntityDimension"))
    assert (dimension[facets[counts == 1]] < 3).all(), "the boundary lies on the part"
    assert sum(solid["hexahedra"] for solid in report["solid_table"]) == len(cells)


def test_a_piston_becomes_one_valid_spline_volume():
    cut = run("cadmodify", PISTON, "--cut-plane", 0, 0, 46, 0, 0, 1, "--cut-plane", 0, 0, 0, 1, 0, 0, "--output", "piston.brep", report="cut.json")
    assert cut["solids"] == 4
    report, mesh = meshed("piston.brep", "--edge-length", 10)
    check_conforming(report, mesh)
    fitted = run("cadfit", "hexes.vtu", "--target", PISTON, "--degree", 2, "--output", "piston.vtu", report="fit.json")
    assert fitted["verdict"] == "valid" and fitted["uncertified_elements"] == 0
    assert abs(fitted["volume"] - VOLUME) < 5e-4 * VOLUME, fitted["volume"]
    assert fitted["max_distance"] < 5e-3 * report["diagonal"], fitted["max_distance"]


def test_the_piston_in_one_piece_names_its_faces():
    done = knotwork_testing.run_program("hexes", PISTON, "--maximum-cuts", "0", "--output", "no.vtu", folder=FOLDER)
    assert done.returncode == 1 and "solid 0 is neither mapped nor swept" in done.stderr and "cadmodify" in done.stderr, done.stderr
    assert not os.path.exists(os.path.join(FOLDER, "no.vtu"))


def test_parts_are_cut_as_far_as_it_takes():
    """From the file to a valid spline: number of cuts and of solids, least scaled Jacobian, volume as of make_parts.py."""
    cases = {"piston": (2, 4, 0.4, VOLUME), "tee": (2, 4, 0.4, 14253.818), "cover": (0, 1, 0.3, 32040.782), "rod": (0, 1, 0.5, 3792.2203),
             "bracket": (0, 1, 0.5, 7790.1239)}
    for name, (cuts, solids, least, volume) in cases.items():
        part = knotwork_testing.data(os.path.join("Parts", name + ".step"))
        report, mesh = meshed(part)
        check_conforming(report, mesh)
        assert (len(report["cuts"]), report["solids"]) == (cuts, solids), report
        assert report["least_scaled_jacobian"] > least, (name, report["least_scaled_jacobian"])
        fitted = run("cadfit", "hexes.vtu", "--target", part, "--degree", 2, "--output", "fitted.vtu", report="fit.json")
        assert fitted["verdict"] == "valid" and fitted["uncertified_elements"] == 0 and fitted["unmatched_features"] == 0, (name, fitted)
        assert abs(fitted["volume"] - volume) < 1e-3 * volume, (name, fitted["volume"])
        # its patches meet in T-joints; as a solid of OpenCASCADE
        run("convert", "fitted.vtu", "--output", "fitted.step")
        solid = run("cadmodify", "fitted.step", "--suggest", report="solid.json")["part"]
        assert solid["solids"] == 1 and abs(solid["volume"] - volume) < 1e-3 * volume, (name, solid)


def test_solids_and_faces_are_groups_of_gmsh():
    part = knotwork_testing.data(os.path.join("Parts", "tee.step"))
    for job, name, cells, dimension in (("hexes", "SolidId", 8, 3), ("quads", "CADFaceId", 4, 2)):
        run(job, part, "--output", job + ".msh", report=job + ".json")
        grid = knotwork.read(os.path.join(FOLDER, job + ".msh"))
        groups = vtk_to_numpy(grid.GetCellData().GetArray("PhysicalGroup"))
        field = grid.GetFieldData()
        names = field.GetAbstractArray("PhysicalGroupNames")
        ids = vtk_to_numpy(field.GetArray("PhysicalGroupIds")).tolist()
        assert ids == [[dimension, int(group)] for group in np.unique(groups)], (ids, np.unique(groups))
        assert [names.GetValue(i) for i in range(names.GetNumberOfValues())] == [f"{name} {group - 1}" for _, group in ids]
        assert len(ids) > 3 and grid.GetCell(0).GetNumberOfPoints() == cells, ids


def test_faces_of_the_part_are_groups_beside_solids():
    """A tee, and a cover with layers under its rounded faces: quadrilaterals are the outer sides and those between solids, outward, on planes and cylinders of the part."""
    for name, solids in (("tee", 4), ("cover", 1)):
        part = knotwork_testing.data(os.path.join("Parts", name + ".step"))
        said = run("hexes", part, "--boundary-cells", 1, "--output", "with.vtu", report="with.json")
        grid = knotwork.read(os.path.join(FOLDER, "with.vtu"))
        faces = vtk_to_numpy(grid.GetCellData().GetArray("CADFaceId"))
        points = vtk_to_numpy(grid.GetPoints().GetData())
        corners = [[grid.GetCell(i).GetPointId(k) for k in range(grid.GetCell(i).GetNumberOfPoints())] for i in range(grid.GetNumberOfCells())]
        hexes, quads = corners[:said["hexahedra"]], corners[said["hexahedra"]:]
        assert (faces[:len(hexes)] == -1).all() and (faces[len(hexes):] >= 0).all()
        sides = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (2, 3, 7, 6), (0, 4, 7, 3), (1, 2, 6, 5))
        bodies = vtk_to_numpy(grid.GetCellData().GetArray("SolidId"))
        found = {}
        for cell, at in enumerate(hexes):
            for side in sides:
                found.setdefault(tuple(sorted(at[i] for i in side)), []).append((bodies[cell], [at[i] for i in side]))
        wanted = {key: uses for key, uses in found.items() if len({body for body, _ in uses}) > 1 or len(uses) == 1}
        assert sorted(tuple(sorted(quad)) for quad in quads) == sorted(wanted), (len(quads), len(wanted))
        for quad in quads:  # the same way round as its hexahedron's
            turned = [quad[i:] + quad[:i] for i in range(4)]
            assert any(use in turned for _, use in wanted[tuple(sorted(quad))]), quad
        # those of a face that two points of one are inside of are on it: by the array of points
        dimension, entity = (vtk_to_numpy(grid.GetPointData().GetArray(name)) for name in ("CADEntityDimension", "CADEntityId"))
        for quad, face in zip(quads, faces[len(hexes):]):
            assert all(entity[i] == face for i in quad if dimension[i] == 2), (quad, face)
        # volume by the divergence theorem, of the outer ones
        outer = np.array([quad for quad in quads if len(wanted[tuple(sorted(quad))]) == 1])
        a, b, c, d = (points[outer[:, i]] for i in range(4))
        volume = (np.einsum("ij,ij->i", a + b + c + d, np.cross(c - a, d - b)) / 24.0).sum()
        assert abs(volume - said["volume"]) < 1e-2 * said["volume"], (volume, said["volume"])
        run("hexes", part, "--boundary-cells", 1, "--output", "with.msh", report="with.json")
        field = knotwork.read(os.path.join(FOLDER, "with.msh")).GetFieldData()
        ids = vtk_to_numpy(field.GetArray("PhysicalGroupIds")).tolist()
        assert sorted(ids) == [[2, int(face) + 1] for face in np.unique(faces[len(hexes):])] + [[3, i + 1] for i in range(solids)], ids


def test_the_cuts_that_are_said_give_the_same_solids():
    said, _ = meshed(knotwork_testing.data(os.path.join("Parts", "tee.step")), "--edge-length", 5)
    words = [word for cut in said["cuts"] for word in ("--" + cut).split()]
    run("cadmodify", knotwork_testing.data(os.path.join("Parts", "tee.step")), *words, "--output", "tee.brep")
    again, mesh = meshed("tee.brep", "--edge-length", 5, "--maximum-cuts", 0)
    check_conforming(again, mesh)
    for report in (said, again):
        for solid in report["solid_table"]:
            solid.pop("least_scaled_jacobian")  # differs in the last digits
    assert again["solid_table"] == said["solid_table"] and not again["cuts"], again
    assert abs(again["volume"] - said["volume"]) < 1e-9 * said["volume"], (again["volume"], said["volume"])


def test_solids_of_the_folder():
    """Those of KNOTWORK_UNSTRUCTURED_MESHES: all of them, with the fewest cuts that are known to do."""
    cuts = {"hexme_n12o_limit_cycle_genus0.stp": 0, "hexme_s11o_cube_cyl.stp": 1, "hexme_i01o_m1.step": 1, "hexme_s16o_torus.stp": 1,
            "hexme_s10o_cyl_cutsphere.stp": 3, "hexme_s12o_cube_rounded_1.stp": 0}
    folder = os.environ.get("KNOTWORK_UNSTRUCTURED_MESHES", "")
    if not (folder and glob.glob(os.path.join(folder, "hexme_*.st*p"))):
        knotwork_testing.skip("KNOTWORK_UNSTRUCTURED_MESHES names no folder with hexme_*.step")
    for name, number in cuts.items():
        report, mesh = meshed(os.path.join(folder, name))
        check_conforming(report, mesh)
        assert len(report["cuts"]) == number, (name, report["cuts"])
        assert report["least_scaled_jacobian"] > 0.3, (name, report["least_scaled_jacobian"])
        fitted = run("cadfit", "hexes.vtu", "--target", os.path.join(folder, name), "--degree", 2, "--output", "fitted.vtu", report="fit.json")
        assert fitted["verdict"] == "valid" and fitted["uncertified_elements"] == 0, (name, fitted)


knotwork_testing.main(globals())
