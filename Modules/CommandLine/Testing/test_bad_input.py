# SPDX-License-Identifier: BSD-3-Clause
"""Every input of every job: bad files are refused in one line that names them, and no output is begun; wrong usage is status 2."""
import os
import re

import numpy as np

import damages
import job_inputs
import knotwork_testing
import skeletons
from job_inputs import ENDINGS, on, runs, sound
from refusals import good, outcome, path, refuse, refuse_all, together, write_bytes, write_text

EVERY = 5  # so many damages apart does a job meet them: neighbours in the tables are alike


def name_of(file):
    return os.path.basename(file)


def test_the_table_of_inputs_names_every_job():
    jobs = re.findall(r"^  (\w+) +\w", knotwork_testing.run_program("--help").stdout.split("Subcommands:")[1], re.M)
    assert len(jobs) > 10 and set(jobs) == {arguments[0] for arguments, _ in runs()} | {"source"}, jobs


def test_sound_files_are_taken():
    job_inputs.make_files()

    def take(arguments, file):
        status, text = outcome(on(arguments, file))
        assert status == 0, (arguments, file, text)

    together((lambda arguments=arguments, file=sound(kind, ending): take(arguments, file))
             for i, (arguments, kind) in enumerate(runs())
             for ending in {ENDINGS[kind][0], ENDINGS[kind][i % len(ENDINGS[kind])]})


def bad_files(ending, of):
    """Files that are none, with a word of the message."""
    with open(of, "rb") as stream:
        content = stream.read()
    yield path("missing" + ending)
    yield write_text("empty" + ending, "")
    half = content[:len(content) // 2]
    # rows of numbers alone: one that is cut inside its last number is one all the same
    yield write_bytes("truncated" + ending, half.rsplit(b" ", 1)[0] if ending == ".xyz" else half)
    yield write_text("text" + ending, "neither a number nor a cell\n")
    yield write_text("unknown.abc", "0 0 0\n")


def test_every_input_refuses_bad_files():
    def cases():
        for i, (arguments, kind) in enumerate(runs()):
            for k, ending in enumerate(ENDINGS[kind]):
                files = list(bad_files(ending, sound(kind, ending)))
                for file in files if k == 0 else files[(i + k) % 4:][:1]:
                    yield on(arguments, file), [name_of(file)]

    refuse_all(cases())


def test_every_input_refuses_what_it_does_not_take():
    wrong = {"surface": ["mesh.off", "target.vtp"], "points": [], "cells": [], "mesh": ["cloud.xyz", "square.vtu"],
             "curves": ["cloud.xyz", "square.vtu"], "boundary": ["square.vtu", "mesh.off"], "map": ["target.vtp", "cloud.xyz"],
             "trim": ["square.vtu", "mesh.off"], "grid": ["cloud.xyz", "target.vtp"], "layout": ["target.vtp", "cloud.xyz"],
             "quads": ["mesh.off", "cloud.xyz", "target.vtp", "square.vtu"], "values": ["mesh.off", "target.vtp", "square.vtu"],
             "edges": ["mesh.off", "cloud.xyz", "square.vtu", "target.vtp"],
             "volume": ["mesh.off", "cloud.xyz", "target.vtp", "square.vtu"],
             "problem": ["mesh.off", "square.vtu"], "cloud": ["mesh.off", "square.vtu"],
             "box": ["mesh.off", "cloud.xyz", "target.vtp", "square.vtu"],
             "part": ["square.step", "square.iges", "mesh.off", "cloud.xyz", "square.vtu"]}
    anything = ("convert", "info", "view")  # of any kind
    faces = ("quads",)              # CAD parts without solids too
    elements = ("mesh.off", "square.vtu")  # what --elements-only takes besides

    def cases():
        for arguments, kind in runs():
            for name in wrong[kind] if arguments[0] not in anything or "--curves" in arguments else []:
                taken = name in elements if "--elements-only" in arguments else arguments[0] in faces and name.endswith((".step", ".iges"))
                if not taken:
                    yield on(arguments, path(name)), [name]
            if kind == "surface" and arguments[0] in ("combine", "contour", "crop", "distance", "extrema", "extract", "raster", "stitch"):
                yield on(arguments, path("cube.vtu")), ["cube.vtu"]

    refuse_all(cases())


def spline():
    """An annulus sector of biquadratic rational elements with a refined corner and a field."""
    good("source", "--shape", "annulus-sector", "--degree", 2, "--elements", 2, 2, 1, "--output", path("coarse.vtu"))
    good("refine", path("coarse.vtu"), "--array", "ElementId", "--upper-threshold", 0, "--output", path("local.vtu"))
    grid = damages.read(path("local.vtu"))
    damages.add_field(grid, "Temperature")
    damages.write(grid, path("field.vtu"))
    good("convert", path("field.vtu"), "--output", path("spline.vtu"))
    return path("spline.vtu")


def damaged(of, table):
    """The file with each damage of the table: name of the damage, file and words."""
    for name, spoil, *words in table:
        grid = damages.read(of)
        spoil(grid)
        yield name, damages.write(grid, path(name + ".vtu")), words[0] if words else []


def spline_runs():
    """The jobs on splines; validate is not about splines but about their cells."""
    for arguments, kind in runs():
        if kind in ("surface", "map"):
            yield arguments


def test_every_spline_job_refuses_every_damage():
    def cases(of, table):
        for d, (_, file, words) in enumerate(damaged(of, table)):
            for i, arguments in enumerate(spline_runs()):
                if (d + i) % EVERY == 0:
                    yield on(arguments, file), [name_of(file), *words]

    refuse_all(cases(spline(), damages.REFUSED))
    refuse_all(cases(path("height.vtu"), damages.REFUSED_LR))
    together(lambda file=file: outcome(["validate", file, "--table", "table.csv", "--output", "out.vtu"])
             for _, file, _ in damaged(spline(), damages.REFUSED))


def test_what_is_kept_beside_the_points_may_be_lost():
    # rational hierarchical splines; sides that were known, and areas above the smallest numbers
    not_of_its_kind = ("combine", "crop", "extract", "map", "raster", "stitch", "solve")

    def take(name, arguments, file):
        status, text = outcome(on(arguments, file))
        # a grid that lost its basis has no parameters any more
        lost = name in ("no_patches", "no_version") and "domain" in text
        assert status == 0 or lost, (name, arguments, text)

    def calls():
        for d, (name, file, _) in enumerate(damaged(spline(), damages.SURVIVED)):
            for i, arguments in enumerate(spline_runs()):
                if (d + i) % EVERY == 0 and arguments[0] not in not_of_its_kind:
                    yield lambda name=name, arguments=arguments, file=file: take(name, arguments, file)

    together(calls())


def test_damaged_xml_is_refused():
    good("convert", spline(), "--encoding", "ascii", "--output", path("ascii.vtu"))
    with open(path("ascii.vtu")) as stream:
        text = stream.read()

    def first_of(array, value):
        begin = re.search(f'Name="{array}".*?>\\s*', text, re.S).end()
        return text[:begin] + value + " " + text[begin:].split(None, 1)[1]

    contents = {f"{count}_{value}": re.sub(f'{count}="\\d+"', f'{count}="{value}"', text)
                for count in ("NumberOfPoints", "NumberOfCells", "NumberOfTuples", "NumberOfComponents")
                for value in (2**60, 2**31 - 1, -1, "1152921504606846976000")}
    contents.update({
        "type": text.replace('type="Float64"', 'type="Strange"'),
        "root": text.replace("UnstructuredGrid", "PolyData"),
        "no_piece": re.sub("<Piece.*</Piece>", "", text, flags=re.S),
        "no_points": re.sub("<Points>.*</Points>", "", text, flags=re.S),
        "no_cells": re.sub("<Cells>.*</Cells>", "", text, flags=re.S),
        "point_id": first_of("connectivity", "99999999"), "point_id_negative": first_of("connectivity", "-4"),
        "offset": first_of("offsets", "99999999"), "offset_negative": first_of("offsets", "-9"),
        "cell_type": first_of("types", "200"), "polyhedron": first_of("types", "42")})
    assert text not in contents.values()
    refuse_all((["refine", write_text(name + ".vtu", content), "--output", "out.vtu"], [name + ".vtu"])
               for name, content in contents.items())


def test_bytes_anywhere_may_be_wrong_PropertyOracle():
    with open(spline(), "rb") as stream:
        sound_bytes = stream.read()
    cuts = range(0, len(sound_bytes) * 11 // 12, len(sound_bytes) // 12)
    refuse_all((["refine", write_bytes(f"cut{cut}.vtu", sound_bytes[:cut]), "--output", "out.vtu"], [f"cut{cut}.vtu"])
               for cut in cuts)

    def calls():
        for seed in range(40):
            random = np.random.default_rng(seed)
            content = bytearray(sound_bytes)
            for at in random.integers(0, len(content) if seed % 2 else 4000, 4):
                content[at] = random.integers(256)
            arguments = ["refine", write_bytes(f"flipped{seed}.vtu", content), "--quiet", "--output", "out.vtu"]
            yield lambda arguments=arguments, before=seed % 3 == 0: outcome(arguments, before)

    together(calls())


def test_meshes_and_old_files_cut_short_are_refused_PropertyOracle():
    old = ("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0 1 0 0 2 1 0\n"
           "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n79\n")
    contents = {ending: job_inputs.triangles(ending) for ending in (".ply", ".stl", ".obj", ".off")}

    def cases():
        for ending, content in {".vtk": old, **contents}.items():
            for cut in {*range(0, len(content), 1 + len(content) // 8), len(content)}:
                name = f"cut{cut}{ending}"
                yield ["refine", write_text(name, content[:cut]), "--output", "out.vtu"], [name]

    refuse_all(cases())


def test_wrong_endings_and_folders_are_refused():
    grid = sound("surface", ".vtu")
    refuse(["refine", grid, "--output", "out.csv"], "out.csv")
    refuse(["refine", grid, "--output", path("no/such/folder") + "/out.vtu/x.vtu"], "no folder")
    refuse(["refine", grid, "--report", path("no/such/folder") + "/out.vtu/x.json", "--output", "out.vtu"], "no folder")


def test_wrong_usage_is_status_2():
    for arguments in ([], ["nothing"], ["map"], ["refine", "a.vtu"], ["source", "--output", "x.vtu", "--degree", 99],
                      ["source", "--output", "x.vtu", "--shape", "heart"], ["combine", "a.vtu", "--output", "x.vtu"],
                      ["distance", "a.xyz", "b.vtu", "--kind", "far", "--output", "x.vtp"], ["stitch", "--output", "x.vtu"],
                      ["extract", "a.vtu", "--box", 1, 2, "--output", "x.vtu"], ["fit", "a.xyz"],
                      ["crop", "a.vtu", "b.xyz", "--cell-size", -1, "--output", "x.step"],
                      ["contour", "a.vtu", "--number-of-levels", 0, "--output", "x.vtp"],
                      ["map", "a", "b", "--output", "c.vtu", "--iterations", "many"]):
        done = knotwork_testing.run_program(*arguments)
        assert done.returncode == 2, (arguments, done.returncode, done.stderr)


knotwork_testing.main(globals())
