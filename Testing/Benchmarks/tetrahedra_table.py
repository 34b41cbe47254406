# SPDX-License-Identifier: BSD-3-Clause
"""The table of solid meshes on the page of TetMeshing: `knotwork tetrahedralize MESH --output OUT.vtu --report OUT.json` on the meshes of
Debian's libcgal-demo, a second time with --repair where the surface bounds no solid.

usage: tetrahedra_table.py PROGRAM [--only NAME ...] [--limit SECONDS] [--write PAGE]

--limit is TetGen's. --write puts the table between the comments `the table of tetrahedra: begin` and `end` of a page. Distances are those
between the boundary and the given surface, the larger of both ways, as shares of the diagonal.
"""
import argparse
import json
import os
import subprocess
import sys
import tarfile
import tempfile
import time

import page_tables
import repair_table

HEAD = ["mesh", "options", "outcome", "tetrahedra", "smallest angle", "volume, of the surface's", "distance", "s"]


def run(program, mesh, stem, options, limit):
    """Status, what was said, the report and the seconds of one run."""
    start = time.monotonic()
    words = [program, "tetrahedralize", mesh, *options, "--time-limit", str(limit), "--output", stem + ".vtu", "--report", stem + ".json",
             "--force", "--quiet"]
    try:
        done = subprocess.run(words, stderr=subprocess.PIPE, text=True, timeout=3 * limit)
        status, error = done.returncode, repair_table.shortened(done.stderr, mesh).replace("knotwork tetrahedralize: ", "")
    except subprocess.TimeoutExpired:
        status, error = None, f"**not done after {3 * limit} s**"
    report = {}
    if status in (0, repair_table.PART_LEFT_OUT):
        with open(stem + ".json", encoding="utf-8") as stream:
            report = json.load(stream)
    return status, error, report, time.monotonic() - start


def row(name, options, error, report, seconds):
    if not report:
        return [name, " ".join(options), error, "", "", "", "", f"{seconds:.2g}"]
    distance = max(report["distance_to_surface"], report["distance_from_surface"]) / report["diagonal"]
    return [name, " ".join(options), report["verdict"], str(report["tetrahedra"]), f"{report['smallest_dihedral_angle']:.2g}",
            f"{report['volume'] / report['surface_volume']:.10g}", f"{distance:.1e}" if distance else "0", f"{seconds:.2g}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--limit", type=int, default=60)
    parser.add_argument("--write")
    arguments = parser.parse_args()
    if not os.path.exists(repair_table.ARCHIVE):
        sys.exit(f"{repair_table.ARCHIVE} is missing; install the package libcgal-demo")
    rows, counts = [], {"as they are": 0, "after repair": 0, "not": 0}
    with tempfile.TemporaryDirectory() as folder, tarfile.open(repair_table.ARCHIVE) as archive:
        prefix = repair_table.FOLDER
        for name in sorted(member.name[len(prefix):] for member in archive if member.isfile() and member.name.startswith(prefix)):
            if arguments.only and os.path.splitext(name)[0] not in arguments.only:
                continue
            mesh = os.path.join(folder, name)
            with open(mesh, "wb") as stream:
                stream.write(archive.extractfile(prefix + name).read())
            options = []
            _, error, report, seconds = run(arguments.program, mesh, mesh + ".out", options, arguments.limit)
            if not report and "repair" in error:
                options = ["--repair"]
                _, error, report, seconds = run(arguments.program, mesh, mesh + ".out", options, arguments.limit)
            rows.append(row(name, options, error, report, seconds))
            counts["not" if not report else "after repair" if options else "as they are"] += 1
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    table = page_tables.table_text(HEAD, rows)
    table += "\n" + f"{counts['as they are']} are meshed as they are, {counts['after repair']} after repair, {counts['not']} are not.\n"
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of tetrahedra", table)


if __name__ == "__main__":
    main()
