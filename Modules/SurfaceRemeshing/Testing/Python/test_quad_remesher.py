# SPDX-License-Identifier: BSD-3-Clause
"""Quadrilaterals by a program that is not trusted: stand-ins named blender that fail in every way, each of which is one error with its reason;
and blender itself where it is installed."""
import json
import math
import os
import shutil
import sys
import tarfile
import time

import knotwork
import knotwork_testing

FOLDER = os.path.dirname(knotwork_testing.output("quad_remesher/files"))
PROGRAMS = os.path.dirname(knotwork_testing.output("quad_remesher/programs/blender"))
ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
PATH = os.environ["PATH"]
N, M = 24, 12  # of the torus

# Triangles of the torus become the quadrilaterals that they are halves of.
JOIN = """
import sys
given, made, faces, sharp = sys.argv[sys.argv.index("--") + 1:]
lines = open(given).read().splitlines()
n, m = map(int, lines[1].split()[:2])
points, triangles = lines[2:2 + n], [list(map(int, line.split()[1:])) for line in lines[2 + n:2 + n + m]]
quads = [[a[0], a[1], a[2], b[2]] for a, b in zip(triangles[::2], triangles[1::2])]


def write(points, faces):
    with open(made, "w") as stream:
        stream.write("OFF\\n%d %d 0\\n" % (len(points), len(faces)))
        stream.writelines(point + "\\n" for point in points)
        stream.writelines(" ".join(map(str, [len(face), *face])) + "\\n" for face in faces)
"""


def torus(name="torus.off"):
    """Halves of N x M quadrilaterals; their radii are 2 and 1."""
    lines = ["OFF", f"{N * M} {2 * N * M} 0"]
    for i in range(N):
        for j in range(M):
            u, v = 2 * math.pi * i / N, 2 * math.pi * j / M
            lines.append(f"{(2 + math.cos(v)) * math.cos(u)} {(2 + math.cos(v)) * math.sin(u)} {math.sin(v)}")
    for i in range(N):
        for j in range(M):
            a, b, c, d = i * M + j, (i + 1) % N * M + j, (i + 1) % N * M + (j + 1) % M, i * M + (j + 1) % M
            lines += [f"3 {a} {b} {c}", f"3 {a} {c} {d}"]
    file = os.path.join(FOLDER, name)
    with open(file, "w", encoding="utf-8") as stream:
        stream.write("\n".join(lines) + "\n")
    return file


def stand_in(text, interpreter=sys.executable):
    """A program named blender, the first on PATH."""
    file = os.path.join(PROGRAMS, "blender")
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(f"#!{interpreter}\n{text}\n")
    os.chmod(file, 0o755)
    os.environ["PATH"] = PROGRAMS + os.pathsep + PATH


def remesh(*options):
    """A run of the job."""
    for name in ("quads.vtp", "tries.csv", "quads.json"):
        if os.path.exists(os.path.join(FOLDER, name)):
            os.remove(os.path.join(FOLDER, name))
    return knotwork_testing.run_program("quadremesh", torus(), "--output", "quads.vtp", "--tries", "tries.csv", "--report", "quads.json", *options,
                                        folder=FOLDER)


def refused(*options):
    """The one line of a run that fails, which leaves nothing."""
    done = remesh("--way", "program", *options)
    lines = done.stderr.splitlines()
    assert done.returncode == 1 and len(lines) == 1, done
    assert not os.path.exists(os.path.join(FOLDER, "quads.vtp")) and not os.path.exists(os.path.join(FOLDER, "quads.json"))
    return lines[0]


def test_a_good_answer_is_taken():
    stand_in(JOIN + "write(points, quads)")
    done = remesh("--faces", 300)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "quads.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    assert (report["quads"], report["points"], report["parts"], report["euler_number"], report["tries"]) == (N * M, N * M, 1, 0, 1), report
    assert report["extraordinary_points"] == 0 and 0.8 < report["least_scaled_jacobian"] <= 1, report
    assert max(report["distance_from_input"], report["distance_to_input"]) < 0.02 * report["diagonal"], report
    with open(os.path.join(FOLDER, "tries.csv"), encoding="utf-8") as stream:
        rows = stream.read().splitlines()
    assert len(rows) == 2 and rows[1].split(",")[1] == "300", rows


def test_what_is_asked_for():
    stand_in(JOIN + f"open({os.path.join(FOLDER, 'asked')!r}, 'a').write(f'{{faces}} {{sharp}};')")
    open(os.path.join(FOLDER, "asked"), "w", encoding="utf-8").close()
    line = refused("--faces", 1000)
    with open(os.path.join(FOLDER, "asked"), encoding="utf-8") as stream:
        assert stream.read() == "1000 1;1000 0;1400 1;1400 0;700 1;700 0;"
    assert line.count("blender wrote no faces that can be read") == 6, line
    open(os.path.join(FOLDER, "asked"), "w", encoding="utf-8").close()
    refused("--faces", 1000, "--keep-sharp", 0)
    with open(os.path.join(FOLDER, "asked"), encoding="utf-8") as stream:
        assert stream.read() == "1000 0;1400 0;700 0;"


def test_answers_that_do_not_hold_are_refused_with_their_reasons():
    for text, reason in (
            ("write(points, triangles)", "the triangles came back as they are"),
            ("write(points, quads[:-1])", "4 edges are open"),
            ("write(points, triangles[:2] + quads[1:])", "2 faces are no quadrilateral"),
            ("write(points, [face[::-1] for face in quads])", "it is inside out"),
            ("write([' '.join(str(1.3 * float(x)) for x in point.split()) for point in points], quads)", "of the diagonal from"),
            ("write(['-1 -1 -1', '1 -1 -1', '1 1 -1', '-1 1 -1', '-1 -1 1', '1 -1 1', '1 1 1', '-1 1 1'], "
             "[[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])", "its Euler number is 2 instead of 0"),
            ("write(points, quads[:-1] + [[0, 1, 2, 100000]])", "a corner that is no point"),
            ("write(points[:-1] + ['nan nan nan'], quads)", "blender wrote no faces that can be read"),
            ("open(made, 'wb').write(bytes(range(256)) * 100)", "blender wrote no faces that can be read"),
            ("open(made, 'w').write('OFF\\n2000000000 2000000000 0\\n')", "blender wrote no faces that can be read"),
            ("sys.exit(3)", "blender ended with status 3"),
            ("print('completed')", "blender wrote no faces that can be read")):
        stand_in(JOIN + text)
        line = refused("--keep-sharp", 0, "--smoothing", 0)
        assert line.count(reason) == 3 and "none of 3 tries" in line and "torus.off" in line, (text, line)


def test_a_crash_and_a_hang_are_errors():
    stand_in("kill -SEGV $$", "/bin/sh")
    assert refused().count("blender crashed") == 6
    stand_in("sleep 1000", "/bin/sh")
    start = time.monotonic()
    line = refused("--keep-sharp", 0, "--time-limit", 1)
    assert line.count("did not end within 1 s") == 2 and "none of 2 tries" in line and time.monotonic() - start < 60, line
    stand_in("x = [bytearray(1 << 24) for i in range(1000)]")
    assert "blender" in refused("--memory-limit", 64)


def test_triangles_are_divided_where_no_answer_holds():
    """Three quadrilaterals a triangle, and the same without blender when it is not asked."""
    stand_in("kill -SEGV $$", "/bin/sh")
    done = remesh()
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "quads.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    assert (report["quads"], report["parts"], report["divided_parts"], report["euler_number"], report["tries"]) == (6 * N * M, 1, 1, 0, 7), report
    with open(os.path.join(FOLDER, "tries.csv"), encoding="utf-8") as stream:
        rows = [row.split(",") for row in stream.read().splitlines()]
    of_triangles = rows[0].index('"OfTriangles"') if '"OfTriangles"' in rows[0] else rows[0].index("OfTriangles")
    assert [row[of_triangles] for row in rows[1:]] == ["0"] * 6 + ["1"], rows
    os.environ["PATH"] = FOLDER
    done = remesh("--way", "triangles", "--faces", 600)
    os.environ["PATH"] = PATH
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "quads.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    assert 500 < report["quads"] <= 600 and report["euler_number"] == 0, report
    assert max(report["distance_from_input"], report["distance_to_input"]) <= 0.05 * report["diagonal"], report


def test_without_blender_there_is_one_sentence():
    os.environ["PATH"] = FOLDER
    line = refused()
    assert "the program blender, which makes the quadrilaterals, is not on PATH; install it" in line and "tries" not in line, line
    filter = knotwork.vtkQuadRemesher()
    filter.SetInputDataObject(knotwork.read(torus()))
    with knotwork_testing.Errors(filter) as errors:
        filter.Update()
    assert "is not on PATH" in errors[0], errors
    assert filter.GetOutputDataObject(0).GetNumberOfCells() == 0
    os.environ["PATH"] = PATH


def test_an_open_mesh_is_refused_before_anything_runs():
    stand_in("exit 0", "/bin/sh")
    with open(torus(), encoding="utf-8") as stream:
        lines = stream.read().splitlines()
    lines[1] = f"{N * M} {2 * N * M - 1} 0"
    with open(os.path.join(FOLDER, "open.off"), "w", encoding="utf-8") as stream:
        stream.write("\n".join(lines[:-1]) + "\n")
    done = knotwork_testing.run_program("quadremesh", "open.off", "--output", "quads.vtp", folder=FOLDER)
    assert done.returncode == 1 and "1 hole" in done.stderr and "repair the mesh first" in done.stderr, done.stderr


def test_blender_makes_quadrilaterals():
    """The joint has Euler number -2."""
    os.environ["PATH"] = PATH
    if shutil.which("blender") is None or not os.path.exists(ARCHIVE):
        print("not run: blender or libcgal-demo is not installed")
        return
    with tarfile.open(ARCHIVE) as archive, open(os.path.join(FOLDER, "joint.off"), "wb") as stream:
        stream.write(archive.extractfile("data/meshes/joint.off").read())
    done = knotwork_testing.run_program("quadremesh", "joint.off", "--output", "joint.vtp", "--faces", 1500, "--report", "joint.json", "--force",
                                        folder=FOLDER, timeout=500)
    assert done.returncode == 0, done.stderr
    with open(os.path.join(FOLDER, "joint.json"), encoding="utf-8") as stream:
        report = json.load(stream)
    assert report["euler_number"] == -2 and 700 < report["quads"] < 3000, report
    assert max(report["distance_from_input"], report["distance_to_input"]) <= 0.05 * report["diagonal"], report
    assert abs(report["volume"] / report["input_volume"] - 1) < 0.05, report


knotwork_testing.main(globals())
