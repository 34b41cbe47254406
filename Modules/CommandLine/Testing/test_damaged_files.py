# SPDX-License-Identifier: BSD-3-Clause
"""Files of every kind with random damage through many jobs: a result or one clean line that names the file; no crash, no hang, no
process over two gigabytes. usage: test_damaged_files.py [NUMBER [SEED [KEEP]]]; files that failed a check are left in the folder KEEP."""
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

import damage_modes
import damages
import job_inputs
import knotwork_testing
from measured_runs import faults_of_message, run
from refusals import good, path, write_bytes

NUMBER = int(sys.argv[1]) if len(sys.argv) > 1 else 150
SEED = int(sys.argv[2]) if len(sys.argv) > 2 else 1
KEEP = sys.argv[3] if len(sys.argv) > 3 else None

LONGEST = 60.0  # seconds
LARGEST = 2 << 30  # bytes
FINE = (0, 1, 3, 4, 5)


def sound_files():
    """Pairs of a file and the jobs that take it; every kind, and every encoding of it."""
    job_inputs.make_files()
    height, surface, points = path("height.vtu"), path("square.vtu"), path("cloud.vtp")
    good("source", "--shape", "torus-surface", "--output", path("torus.vtu"))
    good("source", "--shape", "annulus-sector", "--degree", 2, "--elements", 2, 2, 1, "--output", path("annulus.vtu"))
    good("refine", path("annulus.vtu"), "--array", "ElementId", "--upper-threshold", 0, "--output", path("thb.vtu"))
    good("convert", path("thb.vtu"), "--output", path("thb.xml"))
    good("convert", height, "--output", path("lr.g2"))
    good("convert", path("square.vtu"), "--output", path("grids.vtpc"))
    for name in ("thb.bext", "operators.json"):
        good("convert", path("thb.vtu"), "--output", path(name))
    good("convert", path("thb.bext"), "--output", path("explicit.vtu"))
    for ending in (".step", ".igs"):
        good("convert", path("torus.vtu"), "--output", path("torus" + ending))
    shutil.copy(knotwork_testing.data("Hostile/sound.brep"), path("drilled.brep"))
    for name, of in (("ascii", "thb.vtu"), ("appended", "height.vtu"), ("appended", "cloud.vtp"), ("ascii", "cloud.vtp")):
        good("convert", path(of), "--encoding", name, "--output", path(name + "_" + of))
    for name in ("curved.mesh", "linear.mesh", "nurbs.mesh"):
        shutil.copy(knotwork_testing.data("SplineIO/" + name), path(name))
    legacy_files(height)
    binary_meshes()
    grid, polydata, table = "out.vtu", "out.vtp", "table.csv"
    spline = [["info", "IN"], ["convert", "IN", "--output", grid], ["convert", "IN", "--output", "out.xml"], ["convert", "IN", "--output", "out.g2"],
              ["convert", "IN", "--output", "out.step"], ["tessellate", "IN", "--output", polydata], ["refine", "IN", "--output", grid],
              ["evaluate", "IN", points, "--output", polydata], ["extract", "IN", "--output", grid],
              ["validate", "IN", "--table", table, "--output", grid], ["distance", points, "IN", "--output", polydata],
              ["warp", points, "IN", "--output", polydata]]
    cloud = [["info", "IN"], ["convert", "IN", "--output", polydata], ["convert", "IN", "--output", "out.csv"],
             ["fit", "IN", "--tolerance", 1e-3, "--output", grid], ["warp", "IN", surface, "--output", polydata],
             ["distance", "IN", height, "--output", polydata], ["crop", height, "IN", "--output", grid]]
    mesh = [["info", "IN"], ["convert", "IN", "--output", polydata], ["flatten", "IN", "--output", polydata],
            ["flatten", "IN", "--loops", "loops.vtp", "--output", polydata],
            ["trim", "IN", "--triangles", polydata, "--output", "out.step"], ["fit", "IN", "--output", grid],
            ["features", "IN", "--lines", "lines.vtp", "--output", polydata]]
    meshes = [["unstructured", "IN", "--output", grid], ["patches", "IN", "--output", grid], ["validate", "IN", "--table", table],
              ["info", "IN"], ["convert", "IN", "--output", grid], ["tessellate", "IN", "--output", polydata]]
    curves = [["map", "IN", path("target.vtp"), "--iterations", 1, "--output", grid], ["info", "IN"]]
    boundary = [["parameterize", "IN", "--output", grid], ["info", "IN"]]
    kinds = [(spline, "square.vtu"), (spline, "ascii_thb.vtu"), (spline, "appended_height.vtu"), (spline, "grids.vtpc"), (spline, "height.vtk"),
             (spline, "ascii.vtk"), (spline, "thb.xml"), (spline, "square.xml"), (spline, "square.g2"), (spline, "lr.g2"), (spline, "thb.bext"), (spline, "operators.json"), (spline, "explicit.vtu"),
             (spline, "torus.step"), (spline, "drilled.brep"),
             (spline, "torus.igs"), (spline, "square.step"), (spline, "square.iges"), (cloud, "appended_cloud.vtp"), (cloud, "ascii_cloud.vtp"),
             (cloud, "cloud.xyz"), (cloud, "cloud.txt"), (cloud, "cloud.csv"), (cloud, "cloud.ply"), (cloud, "cloud.g2"), (mesh, "mesh.off"),
             (mesh, "mesh.obj"), (mesh, "mesh.ply"), (mesh, "bytes.ply"), (mesh, "mesh.stl"), (mesh, "bytes.stl"), (mesh, "mesh.vtp"),
             (meshes, "curved.mesh"), (meshes, "linear.mesh"), (spline, "nurbs.mesh"), (curves, "template.vtp"), (boundary, "boundary.json")]
    # collections stay collections
    endings = {"convert": {}, "tessellate": {"out.vtp": "out.vtpc"}}
    parts = [[endings.get(job[0], {"out.vtu": "out.vtpc"}).get(word, word) for word in job] for job in spline]
    return [(path(name), parts if name.endswith(".vtpc") else jobs) for jobs, name in kinds]


def legacy_files(of):
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
    for name, binary in (("height.vtk", True), ("ascii.vtk", False)):
        writer = vtkUnstructuredGridWriter()
        writer.SetInputData(damages.read(of))
        writer.SetFileName(path(name))
        writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
        assert writer.Write() == 1


def binary_meshes():
    import numpy as np
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 0.1)], "<f4")
    corners = [(i, (i + 1) % 4, 4) for i in range(4)]
    facets = b"".join(np.array([(0, 0, 1), *points[list(c)]], "<f4").tobytes() + b"\0\0" for c in corners)
    write_bytes("bytes.stl", b"binary".ljust(80) + np.array([4], "<u4").tobytes() + facets)
    faces = b"".join(b"\3" + np.array(c, "<i4").tobytes() for c in corners)
    write_bytes("bytes.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                b"element face 4\nproperty list uchar int vertex_indices\nend_header\n" + points.tobytes() + faces)
    shutil.copy(path("cloud.xyz"), path("cloud.txt"))


def complaints(name, status, seconds, memory, errors, left):
    """What is not as it should be."""
    if status not in FINE:
        yield f"ended with {status}"
    if seconds > LONGEST:
        yield f"took {seconds:.0f} s"
    if memory > LARGEST:
        yield f"took {memory >> 20} MB"
    yield from faults_of_message(name, status, errors)
    if status == 1 and left:
        yield f"left {left}"


def attempt(number, sound):
    """One damaged file through one job: its kind, mode, outcome and complaints."""
    chance = random.Random(f"{SEED} {number}")
    of, jobs = sound[number % len(sound)]
    with open(of, "rb") as stream:
        content = stream.read()
    # of a collection the pieces are damaged too
    piece = os.path.splitext(of)[0]
    pieces = [os.path.join(piece, name) for name in sorted(os.listdir(piece))] if of.endswith(".vtpc") else []
    with tempfile.TemporaryDirectory(dir=os.path.dirname(path("runs"))) as folder:
        name = os.path.basename(of)
        file = os.path.join(folder, "input", name)
        os.makedirs(os.path.dirname(file))
        hurt = file
        if pieces:
            shutil.copy(of, file)
            shutil.copytree(piece, os.path.splitext(file)[0])
            if chance.random() < 0.5:
                hurt = os.path.join(os.path.splitext(file)[0], os.path.basename(chance.choice(pieces)))
                with open(hurt, "rb") as stream:
                    content = stream.read()
        mode, damaged = damage_modes.damage(content, chance)
        with open(hurt, "wb") as stream:
            stream.write(damaged)
        job = chance.choice(jobs)
        work = os.path.join(folder, "work")
        os.makedirs(work)
        status, seconds, _, memory, errors = run([file if word == "IN" else word for word in job] + ["--quiet"], work, 2 * LONGEST)
        left = [entry for entry in os.listdir(work) if entry != "stderr"]
        wrong = list(complaints(os.path.splitext(name)[0], status, seconds, memory, errors, left if status == 1 else []))
        if wrong and KEEP:
            kept = os.path.join(KEEP, f"{SEED}_{number}")
            shutil.copytree(os.path.dirname(file), kept, dirs_exist_ok=True)
        line = errors[:600].decode(errors="backslashreplace").strip()
        return name, mode, job, status, seconds, memory, [f"{number} {name} {mode} {' '.join(map(str, job))}: {text}: {line}" for text in wrong]


def test_damage_ends_in_a_result_or_one_clean_line():
    sound = sound_files()
    for file, jobs in sound:  # not what the jobs refuse anyway
        outcomes = [run([file if word == "IN" else word for word in job] + ["--quiet"], tempfile.mkdtemp(dir=os.path.dirname(path("runs"))), 2 * LONGEST)[0]
                    for job in jobs[:1]]
        assert outcomes == [0], (file, outcomes)
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        found = list(pool.map(lambda number: attempt(number, sound), range(NUMBER)))
    statuses = Counter(status for _, _, _, status, _, _, _ in found)
    print(f"seed {SEED}: {NUMBER} damaged files, exit statuses {dict(sorted(statuses.items()))}, longest "
          f"{max(seconds for _, _, _, _, seconds, _, _ in found):.1f} s, largest {max(memory for _, _, _, _, _, memory, _ in found) >> 20} MB")
    wrong = [text for *_, texts in found for text in texts]
    assert not wrong, f"{len(wrong)} complaints:\n" + "\n".join(wrong)
    # the damage is such that most files are refused, and each kind of file now and then
    assert statuses[1] > NUMBER // 3, statuses


def test_names_may_be_any_bytes():
    """A missing file, a damaged one and a sound one, each with a name that a terminal would obey."""
    with open(path("square.vtu"), "rb") as stream:
        sound = stream.read()
    folder = tempfile.mkdtemp(dir=os.path.dirname(path("runs")))
    for name in (b"two\nlines", b"\x1b[31mred\x07", b"caf\xe9", b"\xff\xfe", "\u202egpj".encode(), b"a" * 200 + b"/" + b"b" * 200, b"two  blanks",
                 b"'quote'", b"-dash"):
        file = os.path.join(os.fsencode(folder), name + b".vtu")
        os.makedirs(os.path.dirname(file), exist_ok=True)
        for content in (None, b"<VTKFile", sound):
            if content is not None:
                with open(file, "wb") as stream:
                    stream.write(content)
            done = subprocess.run([knotwork_testing.PROGRAM, "info", file, "--report", "report.json"], cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE)
            said = done.stderr + done.stdout
            assert done.returncode == (0 if content == sound else 1), (name, done)
            assert not re.search(r"[^\n\x20-\x7e\u00a0-\u200a\u2010-\u2027\u202f-\U0010ffff]", said.decode()), (name, said)
            assert done.stderr.count(b"\n") == done.returncode, (name, done.stderr)
            if done.returncode == 0:
                with open(os.path.join(folder, "report.json"), "rb") as stream:
                    assert json.loads(stream.read().decode())["input"], name
                os.remove(os.path.join(folder, "report.json"))
        usage = subprocess.run([knotwork_testing.PROGRAM, "info", file, b"--" + name], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert usage.returncode == 2 and not re.search(r"[\x00-\x09\x0b-\x1f\x7f]", usage.stderr.decode()), usage


knotwork_testing.main(globals())
