# SPDX-License-Identifier: BSD-3-Clause
"""The table of damages on the page of surface remeshing: closed meshes of Debian's libcgal-demo, each damaged ten times in each of five ways, at
places by chance, repaired by `knotwork repair --largest-hole 1` and filled by `knotwork tetrahedralize`.

usage: damages_table.py PROGRAM [--only KIND ...] [--write PAGE]

--write puts the table between the comments `the table of damages: begin` and `end` of a page. Distances are shares of the diagonal, the
Euler number is compared with that of the mesh before it was damaged.
"""
import argparse
import json
import os
import random
import subprocess
import sys
import tarfile
import tempfile

import page_tables
from repair_table import ARCHIVE, FOLDER, LIMIT, shortened

NAMES = "eight blobby cactus hand helmet joint knot1 pinion_small rotor spool".split()
PLACES = 5  # that are damaged
HEAD = ["damage", "meshes", "solid again", "filled with tetrahedra", "Euler number as before", "farthest from the input", "farthest to the input",
        "what failed"]


def read_off(text):
    lines = [line.split() for line in text.splitlines() if line.split() and not line.startswith("#")][1:]
    points, faces, _ = map(int, lines[0])
    return ([[float(word) for word in line[:3]] for line in lines[1:1 + points]],
            [[int(word) for word in line[1:1 + int(line[0])]] for line in lines[1 + points:1 + points + faces]])


def between(a, b, share):
    return [(1 - share) * x + share * y for x, y in zip(a, b)]


def holes(points, faces, dice):
    for _ in range(PLACES):
        point = dice.randrange(len(points))
        faces[:] = [face for face in faces if point not in face]


def flipped(points, faces, dice):
    for face in dice.sample(faces, max(PLACES, len(faces) // 20)):
        face.reverse()


def duplicated(points, faces, dice):
    for i, face in enumerate(dice.sample(faces, max(PLACES, len(faces) // 20))):
        faces.append(face[::-1] if i % 2 else list(face))


def intersecting(points, faces, dice):
    """Corners are moved through the triangle's opposite edge."""
    for face in dice.sample(faces, PLACES):
        middle = between(points[face[1]], points[face[2]], 0.5)
        points[face[0]] = between(points[face[0]], middle, 1.5)


def slivers(points, faces, dice):
    """An edge of a triangle is divided almost at its end, and the gap is left, or filled with a triangle without an area."""
    for i, face in enumerate(dice.sample(faces, PLACES)):
        points.append(between(points[face[0]], points[face[1]], 1e-6 if i % 2 else 0.5))
        new = len(points) - 1
        faces.append([new, face[1], face[2]])
        if i < 3:
            faces.append([face[0], face[1], new])
        face[1] = new


KINDS = {"holes": holes, "flipped triangles": flipped, "triangles twice": duplicated, "folds and intersections": intersecting, "slivers": slivers}


def run(program, *arguments):
    """What went wrong, or an empty text."""
    try:
        done = subprocess.run([program, *arguments, "--threads", "1", "--force"], stderr=subprocess.PIPE, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return f"not done after {LIMIT} s"
    return shortened(done.stderr, arguments[1]) or f"status {done.returncode}" if done.returncode else ""


def row(program, kind, meshes, folder):
    damaged, output, report = (os.path.join(folder, name) for name in ("damaged.off", "out.vtp", "out.json"))
    tetrahedra = os.path.join(folder, "out.vtu")
    solid = filled = same = 0
    farthest = [0.0, 0.0]
    failures = []
    for number, (name, (points, faces, euler)) in enumerate(meshes.items()):
        for again in range(10 // len(meshes) or 1):
            dice = random.Random(1000 * list(KINDS).index(kind) + 10 * number + again)
            points, faces = [list(x) for x in points], [list(face) for face in faces]
            KINDS[kind](points, faces, dice)
            with open(damaged, "w", encoding="ascii") as stream:
                stream.write(f"OFF\n{len(points)} {len(faces)} 0\n")
                stream.writelines(" ".join(map(repr, x)) + "\n" for x in points)
                stream.writelines(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
            failure = run(program, "repair", damaged, "--largest-hole", "1", "--output", output, "--report", report)
            if not failure:
                solid += 1
                with open(report, encoding="utf-8") as stream:
                    said = json.load(stream)
                same += said["euler_after"] == euler
                for i, key in enumerate(("distance_from_input", "distance_to_input")):
                    farthest[i] = max(farthest[i], said[key] / said["diagonal"])
                failure = run(program, "tetrahedralize", output, "--output", tetrahedra)
                filled += not failure
            if failure:
                failures.append(f"{name}: {failure}")
            print(f"{kind} | {name} | {failure or 'done'}", file=sys.stderr, flush=True)
    return [kind, str(len(meshes)), str(solid), str(filled), str(same), *(f"{value:.1e}" for value in farthest), "; ".join(failures)]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*", default=list(KINDS))
    parser.add_argument("--write")
    arguments = parser.parse_args()
    if not os.path.exists(ARCHIVE):
        sys.exit(f"{ARCHIVE} is missing; install the package libcgal-demo")
    meshes = {}
    with tarfile.open(ARCHIVE) as archive:
        for name in NAMES:
            points, faces = read_off(archive.extractfile(f"{FOLDER}{name}.off").read().decode())
            edges = {tuple(sorted((face[k - 1], face[k]))) for face in faces for k in range(len(face))}
            meshes[name] = points, faces, len({corner for face in faces for corner in face}) - len(edges) + len(faces)
    with tempfile.TemporaryDirectory() as folder:
        rows = [row(arguments.program, kind, meshes, folder) for kind in arguments.only]
    table = page_tables.table_text(HEAD, rows)
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of damages", table)


if __name__ == "__main__":
    main()
