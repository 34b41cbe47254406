# SPDX-License-Identifier: BSD-3-Clause
"""`knotwork cadmodify`: solids of known volumes imprinted, cut and split; files that are no such."""
import json
import math
import os
import re

import knotwork_testing
import step_solids
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkFiltersSources import vtkLineSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridReader
from refusals import path, refuse_all, write_text

EXACT = 1e-9  # share


def modify(part, *arguments, output="out.step"):
    """Runs the job and returns its report."""
    report = path("modify.json")
    done = knotwork_testing.run_program("cadmodify", part, *arguments, "--output", path(output), "--report", report)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    with open(report) as stream:
        return json.load(stream)


def near(value, wanted, share=EXACT):
    assert abs(value - wanted) <= share * abs(wanted), (value, wanted)


def box(name="box.step", **looks):
    """3 x 2 x 1."""
    solids = step_solids.Solids()
    solids.box((0, 0, 0), (3, 2, 1), **looks)
    return solids.write(path(name))


def stacked(name="stacked.step"):
    """A cylinder of radius 3 on a cube of side 10 whose top is named and red."""
    solids = step_solids.Solids()
    solids.box((0, 0, 0), (10, 10, 10), "Cube", ("",) * 5 + ("Top",), (None,) * 5 + ((1.0, 0.0, 0.0),))
    solids.cylinder((5, 5, 10), 3, 4, "Pin")
    return solids.write(path(name), "Stack")


def test_a_cylinder_on_a_cube_conforms_when_imprinted():
    part = stacked()
    volume = 1000 + 36 * math.pi
    report = modify(part, "--imprint", output="shared.brep")
    step, = report["operations"]
    assert step["operation"] == "imprint" and report["solids_before"] == report["solids"] == 2
    # not before: nothing is shared; after: the disc, with its circle and the vertex on it
    before, after = ({key: step[when][key] for key in ("faces", "edges", "vertices", "face_ids")} for when in ("before", "after"))
    assert before == {"faces": 9, "edges": 15, "vertices": 10, "face_ids": 9}, before
    assert after == {"faces": 9, "edges": 15, "vertices": 10, "face_ids": 10}, after
    assert report["shared_faces"] == 1 and report["file_faces"] == 9 and report["file_solids"] == 2 and report["brep_valid"]
    assert sorted(map(len, step["new_faces"])) == [1] * 8 + [2], step["new_faces"]
    near(report["volume"], volume)
    near(report["file_volume"], volume)
    assert step["overlap"] == 0 and step["volume_change"] <= EXACT
    # the same as STEP, which has the disc once for each solid
    report = modify(part, "--imprint")
    assert report["shared_faces"] == 1 and report["file_faces"] == 10
    near(report["file_volume"], volume)


def test_names_and_colours_are_kept():
    modify(stacked(), "--imprint", "--cut-plane", 5, 5, 0, 1, 0, 0)
    with open(path("out.step")) as stream:
        text = stream.read().replace("\n", "")
    # the ring and the disc, each halved
    assert len(re.findall(r"ADVANCED_FACE\('Top'", text)) == 4, re.findall(r"ADVANCED_FACE\('[^']+'", text)
    faces = {number for number, name in re.findall(r"(#\d+) = ADVANCED_FACE\('([^']*)'", text) if name == "Top"}
    styled = set(re.findall(r"STYLED_ITEM\('[^']*',\([^)]*\),(#\d+)\)", text))
    assert faces <= styled and re.search(r"COLOUR_RGB\('',1\.?,0\.?,0\.?\)|DRAUGHTING_PRE_DEFINED_COLOUR\('red'\)", text), styled
    for name in ("'Stack'", "'Cube'", "'Pin'", "SI_UNIT(.MILLI.,.METRE.)"):
        assert name in text, name


def test_planes_and_cylinders_cut_to_exact_volumes():
    part = box()
    # in the order of the command line, options repeated
    report = modify(part, "--cut-plane", 1, 0, 0, 1, 0, 0, "--cut-cylinder", 2, 1, -5, 0, 0, 7, 0.5, "--cut-plane", 0, 0.5, 0, 0, -2, 0)
    assert [step["operation"] for step in report["operations"]] == ["cut-plane", "cut-cylinder", "cut-plane"]
    assert [step["after"]["solids"] for step in report["operations"]] == [2, 3, 5]
    for step in report["operations"]:
        near(step["after"]["volume"], 6)
    near(report["file_volume"], 6)
    assert report["file_solids"] == 5 and report["brep_valid"]
    report = modify(part, "--cut-cylinder", 2, 1, 0, 0, 0, 1, 0.5, "--cut-plane", 0, 0, 0.25, 0, 0, 1, output="pieces.brep")
    # the ring and the rod, twice: 10 sides each of the box and 2 of the hole, shared ones once
    assert report["solids"] == 4 and report["shared_faces"] == 2 + 2
    near(report["volume"], 6)
    # lengths in other units
    report = modify(part, "--unit", "centimetre", "--cut-plane", 0.1, 0, 0, 1, 0, 0)
    near(report["volume"], 6e-3)
    assert report["unit"] == "centimetre" and report["solids"] == 2


def test_a_face_extended_cuts():
    # the pin's side, behind the seven faces of the imprinted cube, goes on through the cube
    report = modify(stacked(), "--imprint", "--cut-face", 7)
    assert report["operations"][1]["after"]["solids"] == 3
    near(report["file_volume"], 1000 + 36 * math.pi)


def test_faces_are_split():
    part = box()
    for arguments in (["--split-plane", "1,3", 0, 1.5, 0, 0, 1, 0], ["--split-iso", "1,3", "u", 0.5], ["--split-iso", "1,3", "v", 0.25]):
        report = modify(part, *arguments)
        assert report["solids"] == 1 and report["faces"] == 8 and report["file_faces"] == 8, report
        assert list(map(len, report["operations"][0]["new_faces"])) == [1, 2, 1, 2, 1, 1]
        near(report["file_volume"], 6)


def loose_box(name, lift):
    """A cube of side 2 whose six faces have no edge in common; the top lies higher."""
    solids = step_solids.Solids()
    faces = []
    for axis in range(3):
        for side in (0, 1):
            normal, along = [0.0] * 3, [0.0] * 3
            normal[axis], along[(axis + 1) % 3] = 2 * side - 1, 1.0
            corners = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)) if side else ((0, 0), (0, 1), (1, 1), (1, 0)):
                corner = [0.0] * 3
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = 2.0 * side, 2.0 * a, 2.0 * b
                corner[2] += lift if axis == 2 and side else 0.0
                corners.append(corner)
            vertices = [solids.vertex(corner) for corner in corners]
            edges = [(solids.line(corners[i], corners[(i + 1) % 4], (vertices[i], vertices[(i + 1) % 4])), "T") for i in range(4)]
            faces.append(solids.face("Side%d" % len(faces), solids.place("PLANE('',%s)", corners[0], normal, along), [edges]))
    solids.close("", faces)
    return solids.write(path(name))


def test_defects_are_mended_and_counted():
    # nothing to do, also where the file has no curves in the parameters of its faces
    report = modify(stacked(), "--heal", 0.01)
    healing = report["operations"][0]["healing"]
    assert not any(healing.values()), healing
    assert report["operations"][0]["new_faces"] == [[id] for id in range(9)]
    # a face turned
    with open(box()) as stream:
        text = stream.read()
    bound, = re.search(r"ADVANCED_FACE\('',\((#\d+)\)", text).groups()
    text = re.sub(r"(ADVANCED_FACE\('',\(%s\),#\d+,)\.T\." % bound, r"\1.F.", text)
    text = re.sub(r"(%s=FACE_BOUND\('',#\d+,)\.T\." % bound, r"\1.F.", text)
    report = modify(write_text("turned.step", text), "--heal", 1e-3)
    healing = report["operations"][0]["healing"]
    assert healing["turned_faces"] == 1 and healing["sewn_edges"] == healing["removed_edges"] == 0 and not healing["unmended"], healing
    near(report["file_volume"], 6)
    # faces that are not sewn, in one unit and another; their names stay
    for unit in ("millimetre", "centimetre"):
        report = modify(loose_box("loose.step", 0.01), "--unit", unit, "--heal", 0.1 if unit == "millimetre" else 0.01)
        healing = report["operations"][0]["healing"]
        assert healing["sewn_edges"] == 24 and healing["new_solids"] == 1 and healing["turned_faces"] == 0 and not healing["unmended"], healing
        assert report["solids"] == report["file_solids"] == 1 and report["edges"] == 12 and report["brep_valid"]
        near(report["volume"] * (1 if unit == "millimetre" else 1000), 8.02, 0.003)
    with open(path("out.step")) as stream:
        assert sorted(re.findall(r"ADVANCED_FACE\('(Side\d)'", stream.read())) == ["Side%d" % i for i in range(6)]
    # a gap above the tolerance is named, on stderr and in the report
    done = knotwork_testing.run_program("cadmodify", loose_box("apart.step", 0.25), "--heal", 0.01, "--output", path("apart_out.step"), "--report", path("apart.json"))
    assert done.returncode == 0 and "4 edges of one face only" in done.stderr and "0.25 from the next" in done.stderr, done
    with open(path("apart.json")) as stream:
        report = json.load(stream)
    assert report["solids"] == 0 and len(report["operations"][0]["healing"]["unmended"]) == 2
    # the line of an edge that passes its ends at a distance of 0.005
    with open(box()) as stream:
        text = stream.read()
    point = re.search(r"LINE\('',(#\d+)", text).group(1)
    begin, count = re.subn(r"\n%s=CARTESIAN_POINT\('',\([^)]*\)\)" % point, "\n%s=CARTESIAN_POINT('',(0.,0.003,-0.004))" % point, text)
    report = modify(write_text("beside.step", begin), "--heal", 0.01)
    assert count == 1 and report["operations"][0]["healing"]["closed_gaps"] == 4, report
    near(report["file_volume"], 6, 1e-3)
    # a tiny edge that makes a sliver
    solids = step_solids.Solids()
    solids.prism([(0, 0), (10, 0), (10, 10), (9.999, 10), (0, 10)], 10)
    report = modify(solids.write(path("sliver.step")), "--heal", 0.01, "--cut-plane", 5, 0, 0, 1, 0, 0)
    healing = report["operations"][0]["healing"]
    assert healing["removed_faces"] == 1 and healing["removed_edges"] == 2 and not healing["unmended"], healing
    assert report["operations"][0]["after"]["faces"] == 6 and report["operations"][0]["after"]["edges"] == 12
    assert report["solids"] == 2 and [len(ids) for ids in report["operations"][0]["new_faces"]].count(0) == 1


def composites(reader_class, name):
    reader = reader_class()
    reader.SetFileName(path(name))
    reader.Update()
    return reader.GetOutput().GetCellData().GetArray("CompositeId")


def test_composites_travel():
    # two sides and the top of a box, which keep their names; a part of a side is one again
    part = box(names=("", "East", "", "", "", "Top"))
    report = modify(part, "--composite", "1,2,5", "--split-iso", "0", "u", 0.5, "--composite", "0,1")
    first, _, third = report["operations"]
    assert first["composite"] == {"name": "1", "faces": [1, 2, 5]} and first["after"] == first["before"], first
    assert third["operation"] == "composite" and third["composite"]["name"] == "" and third["after"]["faces"] == 6, third
    with open(path("out.step")) as stream:
        names = re.findall(r"ADVANCED_FACE\('([^']*)'", stream.read())
    assert sorted(name for name in names if name) == ["composite:1", "composite:1/East", "composite:1/Top"], names
    # in the grid and in the mesh; a second group in the next run
    report = modify(path("out.step"), "--composite", "%d,%d" % tuple(id for id in range(6) if not names[id])[:2], output="two.step")
    assert report["operations"][0]["composite"]["name"] == "2", report["operations"]
    done = knotwork_testing.run_program("convert", path("two.step"), "--output", path("two.vtu"))
    assert done.returncode == 0, done.stderr
    ids = composites(vtkXMLUnstructuredGridReader, "two.vtu")
    assert sorted(ids.GetValue(i) for i in range(ids.GetNumberOfTuples())) in ([-1, 0, 0, 1, 1, 1], [-1, 0, 0, 0, 1, 1])
    done = knotwork_testing.run_program("quads", path("two.step"), "--output", path("two.vtp"), "--report", path("quads.json"))
    assert done.returncode == 0, done.stderr
    with open(path("quads.json")) as stream:
        table = json.load(stream)["face_table"]
    assert sorted((face["composite"], face["joined_faces"]) for face in table) == [("", 0), ("1", 3), ("2", 2)], table
    assert composites(vtkXMLPolyDataReader, "two.vtp").GetRange() == (-1.0, 1.0)


def test_faces_are_split_by_curves():
    # a polyline over the top, and a line of a spline file: projected straight down
    source = vtkLineSource()
    points = vtkPoints()
    for point in ((1, -1, 5), (1, 1.25, 5), (-1, 1.25, 5)):
        points.InsertNextPoint(point)
    source.SetPoints(points)
    writer = vtkXMLPolyDataWriter()
    writer.SetInputConnection(source.GetOutputPort())
    lines = path("lines.vtp")
    writer.SetFileName(lines)
    writer.Write()
    spline = write_text("curve.g2", "100 1 0 0\n3 0\n2 2\n0 0 1 1\n1 -1 7\n1 3 9\n")
    for file, areas, more in ((lines, (1.25, 4.75), 4), (spline, (2, 4), 3)):
        report = modify(box(), "--split-curve", "5", file)
        step, = report["operations"]
        assert step["operation"] == "split-curve" and step["after"]["faces"] == 7 and step["after"]["edges"] == 12 + more, step
        assert list(map(len, step["new_faces"])) == [1] * 5 + [2]
        near(report["file_volume"], 6)
    # two faces by one curve
    report = modify(box(), "--split-curve", "4,5", spline)
    assert report["faces"] == 8 and report["solids"] == 1


def test_crashes_of_the_worker_are_one_error():
    part, folder = box(), path("workers")
    os.makedirs(folder, exist_ok=True)
    program = os.path.join(folder, "knotwork-modify-cad")
    for script, word in ((None, "is missing"), ("kill -SEGV $$", "OpenCASCADE crashes on it"), ("exit 0", "OpenCASCADE crashes on it")):
        if script:
            with open(program, "w") as stream:
                stream.write("#!/bin/sh\n%s\n" % script)
            os.chmod(program, 0o755)
        elif os.path.exists(program):
            os.remove(program)
        os.environ["KNOTWORK_WORKERS"] = folder
        try:
            done = knotwork_testing.run_program("cadmodify", part, "--heal", 0.1, "--output", path("crash.step"))
        finally:
            del os.environ["KNOTWORK_WORKERS"]
        assert done.returncode == 1 and len(done.stderr.splitlines()) == 1 and word in done.stderr and "box.step" in done.stderr, done
        assert not os.path.exists(path("crash.step"))


def suggest(part, *arguments):
    report = path("suggest.json")
    done = knotwork_testing.run_program("cadmodify", part, "--suggest", *arguments, "--report", report)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    with open(report) as stream:
        report = json.load(stream)
    assert len(done.stdout.splitlines()) == len(report["suggestions"]), done.stdout
    return report


def test_suggestions_of_parts_that_are_known():
    # a box is swept in three ways, and nothing is to be done
    report = suggest(box())
    assert report["swept_solids"] == report["mapped_solids"] == 1 and report["concave_edges"] == 0 and report["suggestions"] == [], report
    near(report["size"], 0.01 * math.sqrt(14), 1e-6)
    # at another size its edges are tiny and its sides slivers: widths and lengths are exact
    report = suggest(box(), "--size", 1.5, "--table", path("suggest.csv"))
    slivers, tiny = ([one for one in report["suggestions"] if one["kind"] == kind] for kind in ("sliver", "tiny-edge"))
    assert len(slivers) == 4 and len(tiny) == 4 and len(report["suggestions"]) == 8, report
    for one in slivers:
        near(one["width"], 1)
    for one in tiny:
        near(one["length"], 1)
        assert len(one["faces"]) == 2
    with open(path("suggest.csv")) as stream:
        lines = stream.read().splitlines()
    assert len(lines) == 9 and lines[0].startswith('"Kind","Faces","Size"'), lines[:2]
    # a step of two boxes in one solid: either face at the concave edge leaves two bricks
    solids = step_solids.Solids()
    solids.prism([(0, 0), (4, 0), (4, 1), (2, 1), (2, 4), (0, 4)], 1)
    part = solids.write(path("step_shape.step"))
    report = suggest(part)
    cuts = [one for one in report["suggestions"] if one["kind"] == "cut-face"]
    assert report["concave_edges"] == 1 and report["swept_solids"] == 1 and report["mapped_solids"] == 0
    assert len(cuts) == len(report["suggestions"]) == 2, report["suggestions"]
    for one in cuts:
        assert (one["solids"], one["swept_solids"], one["mapped_solids"], one["concave_edges"]) == (2, 2, 1, 0), one  # a side of one of them is two faces
        near(modify(part, "--cut-face", one["faces"][0])["file_volume"], 10)
    assert suggest(part, "--maximum-cuts", 1)["untried_cuts"] == 1
    # a side in two pieces of one plane
    solids = step_solids.Solids()
    solids.prism([(0, 0), (2, 0), (4, 0), (4, 3), (0, 3)], 1)
    chain, = suggest(solids.write(path("pieces_of_a_side.step")))["suggestions"]
    assert chain["kind"] == "tangent-faces" and chain["faces"] == [0, 1] and chain["angle"] < 1e-6, chain
    # lengths in other units
    near(suggest(box(), "--unit", "centimetre")["size"], 0.001 * math.sqrt(14), 1e-6)


def test_flags_may_be_off_and_repeated():
    report = modify(stacked(), "--imprint", "--cut-plane", 0, 0, 5, 0, 0, 1, "--imprint")
    assert [step["operation"] for step in report["operations"]] == ["imprint", "cut-plane", "imprint"]
    report = modify(stacked(), "--imprint", 0, "--cut-plane", 0, 0, 5, 0, 0, 1)
    assert [step["operation"] for step in report["operations"]] == ["cut-plane"]


def test_failures_are_one_line():
    part, two = box(), stacked()
    output = ["--output", "out.step"]
    plane = ["--cut-plane", 1, 0, 0, 1, 0, 0]
    sheet = path("sheet.step")
    done = knotwork_testing.run_program("source", "--output", sheet)
    assert done.returncode == 0, done.stderr
    curve = write_text("far.g2", "100 1 0 0\n3 0\n2 2\n0 0 1 1\n11 -1 7\n11 3 9\n")
    refuse_all((["cadmodify", file, *arguments, *output], words) for file, arguments, words in (
        (part, [], ["box.step", "no operation"]),
        (part, ["--suggest"], ["box.step", "leave it out"]),
        (part, [*plane, "--table", "table.csv"], ["--table", "--suggest"]),
        (part, ["--imprint"], ["box.step", "operation 1", "one solid"]),
        (part, ["--cut-plane", 9, 0, 0, 1, 0, 0], ["operation 1", "misses"]),
        (part, ["--cut-plane", 3, 0, 0, 1, 0, 0], ["operation 1", "divides no solid"]),
        (part, [*plane, "--cut-plane", "nan", 0, 0, 1, 0, 0], ["operation 2", "finite"]),
        (part, ["--cut-plane", 1, 0, 0, 0, 0, 0], ["length 0"]),
        (part, ["--cut-cylinder", 1, 1, 0, 0, 0, 1, 0], ["radius"]),
        (part, ["--cut-cylinder", 1, 1, 0, 0, 0, 1, -2], ["radius"]),
        (part, ["--composite", "1"], ["operation 1", "two or more"]),
        (part, ["--composite", "1,9"], ["no face 9"]),
        (part, ["--composite", "1,3"], ["face 1 to face 3", "add the faces between"]),
        (part, ["--composite", "1,x"], ["'1,x'", "list of faces"]),
        (two, ["--composite", "1,8"], ["two bodies"]),
        (part, ["--composite", "1,2", "--composite", "2,3"], ["operation 2", "face 2", "composite 1"]),
        (part, ["--split-curve", "1", path("missing.vtp")], ["missing.vtp"]),
        (part, ["--split-curve", "1", sheet], ["sheet.step", "no line"]),
        (part, ["--split-curve", "9", curve], ["no face 9"]),
        (part, ["--split-curve", "5", curve], ["does not cross face 5"]),
        (part, ["--heal", 0], ["operation 1", "above 0"]),
        (part, ["--heal", "nan"], ["operation 1", "above 0"]),
        (part, ["--cut-face", 6], ["no face 6", "0 to 5"]),
        (part, ["--cut-face", -1], ["no face -1"]),
        (part, ["--split-iso", "9", "u", 0.5], ["no face 9"]),
        (part, ["--split-iso", "0,x", "u", 0.5], ["box.step", "'0,x'", "list of faces"]),
        (part, ["--split-iso", "0,", "u", 0.5], ["list of faces"]),
        (part, ["--split-iso", "0", "w", 0.5], ["'w'", "u or v"]),
        (part, ["--split-iso", "0", "u", 1.5], ["share"]),
        (part, ["--split-plane", "0", 9, 0, 0, 1, 0, 0], ["misses"]),
        (part, ["--split-plane", "1", 1, 0, 0, 1, 0, 0], ["does not cross face 1"]),
        (two, ["--cut-plane", 0.1, 0.2, 3, 0.3, 0.2, 1, "--volume-tolerance", 0], ["volume"]),
        (sheet, plane, ["sheet.step", "no solid"]),
        (path("missing.step"), plane, ["missing.step"]),
        (write_text("empty.step", ""), plane, ["empty.step"]),
        (write_text("damaged.step", "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1="), plane, ["damaged.step"]),
        (path("part.iges"), plane, ["part.iges", ".step"])))
    refuse_all([(["cadmodify", part, "--composite", "1,2", "--output", "group.brep"], ["group.brep", "composite 1", ".step"])])
    refuse_all((["cadmodify", part, *plane, "--output", name], [name, ".brep"]) for name in ("out.iges", "out.vtu"))
    refuse_all((["cadmodify", file, *arguments], words) for file, arguments, words in (
        (part, plane, ["box.step", "--output"]), (sheet, ["--suggest"], ["sheet.step", "no solid"]),
        (path("missing.step"), ["--suggest"], ["missing.step"]), (path("part.iges"), ["--suggest"], ["part.iges", ".step"]),
        (part, ["--suggest", "--size", "nan"], ["box.step", "Size"])))
    for usage in (["--tangent-angle", 50, *plane], ["--size", -1, *plane], ["--maximum-cuts", -1, *plane], ["--cut-plane", 1, 0, 0], ["--cut-plane", "a", 0, 0, 1, 0, 0], ["--cut-face", "x"], ["--unit", "mile", *plane],
                  ["--volume-tolerance", 2, *plane], ["--cut-face", 1, 2]):
        done = knotwork_testing.run_program("cadmodify", part, *usage, *["--output", path("never.step")])
        assert done.returncode == 2 and len(done.stderr.splitlines()) == 1, (usage, done)
    done = knotwork_testing.run_program("cadmodify", part, *plane, "--output", part)
    assert done.returncode == 1 and "--force" in done.stderr, done.stderr


knotwork_testing.main(globals())
