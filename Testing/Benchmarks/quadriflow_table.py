# SPDX-License-Identifier: BSD-3-Clause
"""The table of solids on the page of surface remeshing: `knotwork quadremesh` and `knotwork cadfit` on the closed meshes of Debian's
libcgal-demo with at least 100 faces, with Debian's blender installed.

usage: quadriflow_table.py PROGRAM [--only NAME ...] [--keep FOLDER] [--write PAGE] [--limit SECONDS] [--rest SECONDS]

A mesh is closed where every edge has two faces that run it oppositely. All meshes get the same commands, until one spline is valid:

    quadremesh MESH --faces 2000 --time-limit 60
    cadfit --target MESH --degree 2        where all quadrilaterals are QuadriFlow's
    cadfit --target MESH --degree 2 --sharp-angle 179 --weak-angle 179 --untangle-rings 5 --policy full        all edges taken for smooth
    quadremesh MESH --faces 4000 --way triangles
    cadfit as the second one
    cadfit --degree 2 --policy full        to the quadrilaterals themselves

What quadremesh does not take as it is, is repaired first, without parts below 0.02 of the diagonal. A solid is valid when cadfit proves every element, and when OpenCASCADE reads
solids in the STEP file, at most as many as the scan has parts, of the volume that cadfit says. Distances of the last fit are sums: of the spline from the
quadrilaterals, and of these from the scan, which is a bound. Seconds are those of the processor, of all programs.

--keep: results of meshes are kept there and not made again. --limit: seconds of a mesh from which on only the last way is tried; --rest: seconds
from which on meshes are not begun. --write puts the table between the comments `the table of solids: begin` and `end` of a page.
"""
import argparse
import collections
import json
import os
import resource
import signal
import subprocess
import sys
import tarfile
import tempfile
import time

import page_tables
from repair_table import ARCHIVE, FOLDER, shortened

HEAD = ["mesh", "faces", "Euler number", "made by", "quadrilaterals", "tries", "scaled Jacobian", "fit", "outcome", "spline from the scan",
        "scan from the spline", "volume", "s"]
SMOOTH = ["--sharp-angle", "179", "--weak-angle", "179", "--untangle-rings", "5", "--policy", "full"]
ITSELF = "to the quadrilaterals"
# how quadrilaterals are made, and how these are fitted: what the table calls it, and options
WAYS = ((["--faces", "2000", "--time-limit", "60"], (("", []), ("smooth", SMOOTH))),
        (["--faces", "4000", "--way", "triangles"], (("smooth", SMOOTH), (ITSELF, ["--policy", "full"]))))
FEWEST = 100
PATIENCE = 200  # seconds of the processor of a job; tries of quadrilaterals have limits of their own
PART_LEFT_OUT = 5


def faces_of(file):
    """Corners of the faces of an OFF file, also of one with colours; None where it is none."""
    with open(file, encoding="ascii", errors="replace") as stream:
        words = [word for line in stream for word in line.split("#")[0].split()]
    if not words or words[0] not in ("OFF", "COFF"):
        return None
    width = 3 if words[0] == "OFF" else 7
    num_points, num_faces = int(words[1]), int(words[2])
    try:
        float(words[4 + num_points * width - 1])
        for width in (width, 6):  # colours have three or four numbers
            at, faces = 4 + num_points * width, []
            for _ in range(num_faces):
                count = int(words[at])
                faces.append([int(word) for word in words[at + 1:at + 1 + count]])
                at += count + 1
            if at == len(words):
                return faces
    except (ValueError, IndexError):
        pass
    return None


def is_closed(faces):
    sides = collections.Counter((a, b) for face in faces for a, b in zip(face, face[1:] + face[:1]))
    return all(count == 1 and sides[b, a] == 1 for (a, b), count in list(sides.items()))


class Mesh:
    """All that is tried with one mesh."""

    def __init__(self, program, file, faces, limit):
        self.program, self.file, self.stem, self.limit = program, file, os.path.splitext(file)[0], limit
        self.said = {"name": os.path.basename(self.stem), "faces": faces, "outcome": ""}

    def run(self, job, given, made, *options):
        """The report of a job, None when it failed."""
        report = self.stem + "." + job + ".json"
        done = subprocess.run([self.program, job, given, *made, "--report", report, "--quiet", "--force", *options], stderr=subprocess.PIPE,
                              text=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 5)), check=False)
        if done.returncode in (-signal.SIGXCPU, 128 + signal.SIGXCPU, -signal.SIGKILL):
            self.said["outcome"] = f"{job} was not done after {PATIENCE} s"
            return None
        if done.returncode not in (0, PART_LEFT_OUT):
            error = done.stderr.strip() if done.returncode == 1 else f"**ended with status {done.returncode}** {done.stderr.strip()}"
            self.said["outcome"] = shortened(error, given).replace(f"knotwork {job}: ", "").replace(f"'{given}': ", "")
            return None
        with open(report, encoding="utf-8") as stream:
            return json.load(stream)

    def fits(self, scan, quads, fits):
        """Fits of the quadrilaterals until one is valid."""
        for called, options in fits:
            if time.monotonic() - self.begun > self.limit and fits != WAYS[-1][1]:
                return False
            if not options and quads["divided_parts"] > 0:
                continue  # sharp edges do not run along edges of such quadrilaterals
            step = self.stem + ".step"
            target = [] if called == ITSELF else ["--target", scan]
            fit = self.run("cadfit", self.stem + ".vtp", ["--output", step], *target, "--degree", "2", *options)
            if not fit:
                continue
            there, back = (0, 0) if target else (quads["distance_from_input"], quads["distance_to_input"])
            self.said.update(fit=called, quads=quads["quads"], tries=quads["tries"], jacobian=quads["least_scaled_jacobian"], euler=quads["euler_number"],
                             there=(there + fit["max_distance"]) / quads["diagonal"], back=(back + fit["max_distance_back"]) / quads["diagonal"],
                             volume=fit["volume"] / quads["input_volume"], parts=quads["parts"], divided=quads["divided_parts"])
            if fit["verdict"] != "valid":
                self.said["outcome"] = f"{fit['uncertified_elements']} of {fit['elements']} elements without a certificate"
                continue
            part = self.run("cadmodify", step, ["--suggest"])
            if not part:
                continue
            found = part["part"]
            # parts that are turned inward are cavities of solids, which the volume tells
            if 0 < found["solids"] <= quads["parts"] and abs(found["volume"] - fit["volume"]) <= 1e-5 * abs(fit["volume"]):
                self.said["outcome"] = "valid"
                return True
            self.said["outcome"] = f"OpenCASCADE finds {found['solids']} solids of volume {found['volume']:.6g} in the file instead of {fit['volume']:.6g}"
        return False

    def try_all(self):
        self.begun = time.monotonic()
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        scan = self.file
        for made, fits in WAYS:
            quads = self.run("quadremesh", scan, ["--output", self.stem + ".vtp"], *made)
            if not quads and "repair the mesh first" in self.said["outcome"]:
                scan = self.stem + ".repaired.vtp"
                if not self.run("repair", self.file, ["--output", scan], "--smallest-part", "0.02"):
                    break
                self.said["repaired"] = True
                quads = self.run("quadremesh", scan, ["--output", self.stem + ".vtp"], *made)
            if quads and self.fits(scan, quads, fits):
                break
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.said["seconds"] = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return self.said


def maker(said):
    """What made the quadrilaterals."""
    if said["divided"] == 0:
        return "QuadriFlow"
    return "triangles" if said["divided"] == said["parts"] else f"QuadriFlow, {said['divided']} of {said['parts']} parts triangles"


def row(said):
    name = said["name"] + (" (repaired)" if said.get("repaired") else "")
    seconds = f"{said['seconds']:.0f}"
    if "quads" not in said:
        return [name, str(said["faces"]), "", "", "", "", "", "", said["outcome"], "", "", "", seconds]
    return [name, str(said["faces"]), str(said["euler"]), maker(said), str(said["quads"]), str(said["tries"]), f"{said['jacobian']:.2f}",
            said["fit"], said["outcome"], f"{said['there']:.1e}", f"{said['back']:.1e}", f"{abs(said['volume']):.4f}", seconds]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--keep")
    parser.add_argument("--write")
    parser.add_argument("--limit", type=float, default=400)
    parser.add_argument("--rest", type=float, default=float("inf"))
    arguments = parser.parse_args()
    if not os.path.exists(ARCHIVE):
        sys.exit(f"{ARCHIVE} is missing; install the package libcgal-demo")
    begun, rows, valid, left_out = time.monotonic(), [], 0, 0
    with tempfile.TemporaryDirectory() as folder, tarfile.open(ARCHIVE) as archive:
        folder = arguments.keep or folder
        for name in sorted(member.name[len(FOLDER):] for member in archive if member.isfile() and member.name.startswith(FOLDER)):
            stem, ending = os.path.splitext(name)
            if ending != ".off" or (arguments.only and stem not in arguments.only):
                continue
            mesh, kept = os.path.join(folder, name), os.path.join(folder, stem + ".kept.json")
            with open(mesh, "wb") as stream:
                stream.write(archive.extractfile(FOLDER + name).read())
            faces = faces_of(mesh)
            if not faces or len(faces) < FEWEST or not is_closed(faces):
                continue
            if os.path.exists(kept):
                with open(kept, encoding="utf-8") as stream:
                    said = json.load(stream)
            elif time.monotonic() - begun > arguments.rest:
                left_out += 1
                continue
            else:
                said = Mesh(arguments.program, mesh, len(faces), arguments.limit).try_all()
                with open(kept, "w", encoding="utf-8") as stream:
                    json.dump(said, stream)
            valid += said["outcome"] == "valid"
            rows.append(row(said))
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    text = page_tables.table_text(HEAD, rows) + f"\n{valid} of {len(rows)} meshes become valid solids.\n"
    if left_out:
        text += f"\n{left_out} meshes were not tried.\n"
    print(text, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of solids", text)


if __name__ == "__main__":
    main()
