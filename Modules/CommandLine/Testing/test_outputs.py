# SPDX-License-Identifier: BSD-3-Clause
"""What is in the way of outputs: nothing is lost, and what is written is there whole or not at all."""
import json
import os
import random
import shutil
import tempfile

import knotwork_testing
from refusals import good, path

ROOT = os.path.dirname(path("outputs"))


def folder():
    return tempfile.TemporaryDirectory(dir=ROOT)


def write(name, text="precious\n"):
    os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
    with open(name, "w") as stream:
        stream.write(text)
    return name


def read(name):
    with open(name, "rb") as stream:
        return stream.read()


def contents(top):
    """Everything below a folder: links as what they say, files as their bytes, folders as None."""
    found = {}
    for place, folders, files in os.walk(top):
        for name in folders + files:
            item = os.path.join(place, name)
            key = os.path.relpath(item, top)
            found[key] = os.readlink(item) if os.path.islink(item) else None if os.path.isdir(item) else read(item)
    return found


def run(place, *arguments):
    return knotwork_testing.run_program(*arguments, folder=place)


def refused(place, *arguments):
    """The run fails in one line and leaves the folder as it is; the line."""
    before = contents(place)
    done = run(place, *arguments)
    assert done.returncode == 1 and len(done.stderr.splitlines()) == 1, (arguments, done.returncode, done.stderr)
    assert contents(place) == before, (arguments, sorted(contents(place)), sorted(before))
    return done.stderr


def done_well(place, *arguments):
    done = run(place, *arguments)
    assert done.returncode == 0, (arguments, done.stderr)
    assert not [name for name in os.listdir(place) if ".knotwork" in name or ".part" in name], os.listdir(place)


def square(name=None):
    name = name or path("square_in.vtu")
    if not os.path.exists(name):
        good("source", "--elements", 3, 3, 1, "--output", name)
    return name


def test_folders_and_files_of_a_user_stay():
    grid = square()
    for kind in ("folder", "file", "link", "dangling", "deep"):
        with folder() as place:
            results = os.path.join(place, "results")
            if kind == "folder":
                write(os.path.join(results, "thesis.txt"))
                write(os.path.join(results, "results_0_0.vtu"))  # of that name, but no .vtpc lists it
            elif kind == "file":
                write(results)
            elif kind == "link":
                write(os.path.join(place, "elsewhere", "thesis.txt"))
                os.symlink("elsewhere", results)
            elif kind == "dangling":
                os.symlink("nowhere", results)
            else:
                write(os.path.join(results, "deep", "thesis.txt"))
            assert "results" in refused(place, "convert", grid, "--output", "results.vtpc")
            # forcing is for inputs: what is not ours stays all the same
            refused(place, "convert", grid, "--output", "results.vtpc", "--force")


def test_pieces_are_replaced_and_nothing_else():
    grid = square()
    with folder() as place:
        two = os.path.join(place, "two.vtu")
        good("source", "--shape", "annulus-sector", "--sectors", 2, "--output", two)
        done_well(place, "convert", two, "--output", "results.vtpc")
        pieces = set(os.listdir(os.path.join(place, "results")))
        write(os.path.join(place, "results", "notes.txt"))
        # an older collection that lists more pieces than the new one has
        text = read(os.path.join(place, "results.vtpc")).decode()
        extra = os.path.join(place, "results", "results_7_0.vtu")
        shutil.copy(os.path.join(place, "results", sorted(pieces)[0]), extra)
        write(os.path.join(place, "thesis.vtu"))
        text = text.replace("</vtkPartitionedDataSetCollection>", '<Partitions index="7"><DataSet index="0" '
                            'file="results/results_7_0.vtu"/><DataSet index="1" file="thesis.vtu"/><DataSet index="2" '
                            'file="results/../thesis.vtu"/><DataSet index="3" file="results/notes.txt"/></Partitions>'
                            "</vtkPartitionedDataSetCollection>")
        write(os.path.join(place, "results.vtpc"), text)
        done_well(place, "convert", grid, "--output", "results.vtpc")
        assert set(os.listdir(os.path.join(place, "results"))) == {"notes.txt", "results_0_0.vtu"}
        assert read(os.path.join(place, "results", "notes.txt")) == b"precious\n"
        assert read(os.path.join(place, "thesis.vtu")) == b"precious\n"
        done_well(place, "info", "results.vtpc")
        # a new piece would take the place of a file that is none of the old ones
        os.rename(os.path.join(place, "results", "results_0_0.vtu"), os.path.join(place, "results", "other.vtu"))
        write(os.path.join(place, "results.vtpc"),
              read(os.path.join(place, "results.vtpc")).decode().replace("results_0_0", "other"))
        write(os.path.join(place, "results", "results_0_0.vtu"))
        refused(place, "convert", grid, "--output", "results.vtpc")


def test_an_input_is_not_replaced_unless_forced():
    with folder() as place:
        grid = square(os.path.join(place, "grid.vtu"))
        os.makedirs(os.path.join(place, "sub"))
        os.symlink("grid.vtu", os.path.join(place, "link.vtu"))
        os.symlink("../link.vtu", os.path.join(place, "sub", "chain.vtu"))
        os.link(grid, os.path.join(place, "hard.vtu"))
        for name in ("grid.vtu", "./grid.vtu", "sub/../grid.vtu", grid, "link.vtu", "sub/chain.vtu", "hard.vtu"):
            assert "input" in refused(place, "refine", "grid.vtu", "--output", name), name
        assert "input" in refused(place, "refine", "link.vtu", "--output", "grid.vtu")
        assert "input" in refused(place, "refine", "grid.vtu", "--report", "grid.vtu", "--output", "other.vtu")
        before = read(grid)
        done_well(place, "refine", "grid.vtu", "--output", "link.vtu", "--force")
        assert os.path.islink(os.path.join(place, "link.vtu")) and read(grid) != before
        assert read(os.path.join(place, "hard.vtu")) == before  # another name of the old file
        done_well(place, "convert", "grid.vtu", "--output", "grid.step")
        assert "input" in refused(place, "tessellate", "grid.step", "--output", "x.vtp", "--report", "grid.step")
        done_well(place, "convert", "grid.vtu", "--output", "all.vtpc")
        for name in ("all.vtpc", "all/all_0_0.vtu"):
            refused(place, "convert", name, "--output", "all.vtpc")
        refused(place, "convert", "all.vtpc", "--output", "all/all_0_0.vtu")
        done_well(place, "convert", "all.vtpc", "--output", "all.vtpc", "--force")
        done_well(place, "info", "all.vtpc")


def test_every_output_has_a_name_of_its_own():
    grid = square()
    with folder() as place:
        os.makedirs(os.path.join(place, "sub"))
        write(os.path.join(place, "a.csv"))
        os.link(os.path.join(place, "a.csv"), os.path.join(place, "hard.csv"))
        os.symlink("new.csv", os.path.join(place, "link.csv"))
        for table, report in (("t.csv", "t.csv"), ("t.csv", "sub/../t.csv"), ("a.csv", "hard.csv"), ("link.csv", "new.csv"),
                              ("t.csv", os.path.join(place, "t.csv"))):
            assert "name of its own" in refused(place, "validate", grid, "--table", table, "--report", report), (table, report)
        os.makedirs(os.path.join(place, "all"))
        for report in ("all.vtpc", "all/report.json"):
            assert "name of its own" in refused(place, "convert", grid, "--output", "all.vtpc", "--report", report), report
        os.rmdir(os.path.join(place, "all"))
        assert "name of its own" in refused(place, "convert", grid, "--output", "all.vtpc", "--report", "all")


def test_links_are_followed():
    grid = square()
    with folder() as place:
        os.makedirs(os.path.join(place, "far"))
        write(os.path.join(place, "far", "kept.vtu"))
        os.chmod(os.path.join(place, "far", "kept.vtu"), 0o600)
        os.symlink("far/kept.vtu", os.path.join(place, "old.vtu"))
        os.symlink("far/new.vtu", os.path.join(place, "new.vtu"))
        for link, target in (("old.vtu", "kept.vtu"), ("new.vtu", "new.vtu")):
            done_well(place, "convert", grid, "--output", link)
            assert os.path.islink(os.path.join(place, link)), link
            assert read(os.path.join(place, "far", target)).startswith(b"<?xml"), link
        assert os.stat(os.path.join(place, "far", "kept.vtu")).st_mode & 0o777 == 0o600
        assert sorted(os.listdir(os.path.join(place, "far"))) == ["kept.vtu", "new.vtu"]
        os.symlink("no/such/folder/x.vtu", os.path.join(place, "broken.vtu"))
        refused(place, "convert", grid, "--output", "broken.vtu")
        os.symlink("round.vtu", os.path.join(place, "round.vtu"))
        refused(place, "convert", grid, "--output", "round.vtu")


def test_folders_are_no_files():
    grid = square()
    with folder() as place:
        write(os.path.join(place, "out.vtu", "thesis.txt"))
        write(os.path.join(place, "report.json", "thesis.txt"))
        assert "folder" in refused(place, "convert", grid, "--output", "out.vtu")
        assert "folder" in refused(place, "convert", grid, "--output", "new.vtu", "--report", "report.json")
        refused(place, "convert", grid, "--output", "new.vtu", "--report", "out.vtu/thesis.txt/report.json")


def test_a_report_that_cannot_be_written_leaves_no_output():
    grid = square()
    with folder() as place:
        write(os.path.join(place, "kept.vtu"))
        for output in ("kept.vtu", "new.vtu"):
            for report, reason in (("/dev/full", "No space left on device"), ("no/such/report.json", "no folder")):
                assert reason in refused(place, "convert", grid, "--output", output, "--report", report), report
        done_well(place, "convert", grid, "--output", "new.vtu", "--report", "/dev/null")
        assert not os.path.isfile("/dev/null") and not os.path.isfile("/dev/full")
        done = run(place, "convert", grid, "--output", "new.vtu", "--report", "/dev/stdout")
        assert done.returncode == 0 and json.loads(done.stdout)["job"] == "convert", done.stderr


def test_the_ending_is_refused_before_the_work():
    """An output that no job of the kind writes: refused before even the input is read."""
    for arguments in (["fit", "none.xyz", "--output", "x.vtp"], ["tessellate", "none.vtu", "--output", "x.step"],
                      ["trim", "none.off", "--output", "x.step", "--table", "x.vtu"],
                      ["flatten", "none.off", "--output", "x.vtu"], ["contour", "none.vtu", "--output", "x.step"],
                      ["map", "a.vtp", "b.vtp", "--output", "x.vtu", "--mapped", "x.step"],
                      ["validate", "none.vtu", "--witnesses", "x.vtp"], ["source", "--output", "x.vtp"]):
        with folder() as place:
            assert "change the ending" in refused(place, *arguments), arguments


def test_what_the_format_does_not_take_is_refused_before_the_work():
    with folder() as place:
        for name, shape in (("arc", "arc"), ("square", "square"), ("cube", "cube")):
            good("source", "--shape", shape, "--output", os.path.join(place, name + ".vtu"))
        done_well(place, "convert", "cube.vtu", "--output", "cube.vtpc")
        # these would take minutes
        hard = ["--number-of-refinements", 7, "--maximum-functions", 2000000000]
        for arguments in (["refine", "arc.vtu", "--output", "x.step"], ["refine", "cube.vtu", "--output", "x.vtpc", *hard],
                          ["refine", "cube.vtpc", "--output", "x.vtu", *hard],
                          ["extract", "square.vtu", "--iso-curve", "first", "--output", "x.step"],
                          ["tessellate", "cube.vtu", "--cells", "volume", "--output", "x.stl"],
                          ["tessellate", "arc.vtu", "--output", "x.obj"], ["tessellate", "square.vtu", "--output", "x.vtu"]):
            done = run(place, *arguments)
            assert done.returncode == 1 and "'x." in done.stderr and ("write" in done.stderr or "written" in done.stderr), (arguments, done.stderr)


def test_random_names_lose_nothing():
    """Property: whatever stands in the way, a run that fails changes nothing, one that succeeds only what it writes."""
    draw = random.Random(3)
    grid = square()
    names = ["a.vtu", "b.vtpc", "b", "c.csv", "d.json", "b/b_0_0.vtu", "b/x", "e"]
    for _ in range(60):
        with folder() as place:
            for name in names:
                full = os.path.join(place, name)
                kind = draw.choice(["none", "file", "folder", "link", "none"])
                if os.path.lexists(full) or not os.path.isdir(os.path.dirname(full)):
                    continue
                if kind == "file":
                    write(full, draw.choice(["precious\n", ""]))
                elif kind == "folder":
                    os.makedirs(full)
                elif kind == "link":
                    os.symlink(draw.choice(names), full)
            before = contents(place)
            output = draw.choice(["a.vtu", "b.vtpc"])
            report = draw.choice(["d.json", "b", "c.csv", "e"])
            done = run(place, "convert", grid, "--output", output, "--report", report)
            after = contents(place)
            assert done.returncode in (0, 1), done.stderr
            if done.returncode == 1:
                assert after == before, (output, report, done.stderr)
                continue
            written = {os.path.relpath(os.path.realpath(os.path.join(place, name)), os.path.realpath(place))
                       for name in (output, report, "b/b_0_0.vtu", "b")}
            assert {name for name in before if after.get(name, "gone") != before[name]} <= written, (output, report)


knotwork_testing.main(globals())
