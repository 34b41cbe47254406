#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The table of tiles on the page of surface fitting: a cloud of terrain_cloud.py, `knotwork tiles` and `knotwork fit` over the tiles.

usage: tiles_table.py PROGRAM [--points N ...] [--noise KIND ...] [--processes N] [--folder FOLDER] [--write PAGE]

--points: numbers of points, 1e6 and 1e7 without. --noise: uniform, normal, or both. --folder: for the clouds (26 bytes a point, twice) and tiles, which are removed.
--write puts the table between the comments `the table of tiles: begin` and `end` of a page. Tolerances are three standard deviations of the
noise. --processes: of mpirun that the fit is divided among, 1 without. Memory is the largest resident set of a process of the fit.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import page_tables
import terrain_cloud

HEAD = ["points", "noise", "outliers planted", "tiles", "s, split", "MB, split", "s, fit", "processor s, fit", "MB, fit", "functions",
        "outliers found", "points outside", "largest jump", "of slopes"]


def run(program, folder, *words, processes=1):
    """The report of a job."""
    report = os.path.join(folder, "report.json")
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--quiet", "-np", str(processes)] if processes > 1 else []
    subprocess.run([*mpirun, program, *map(str, words), "--report", report, "--quiet", "--force"], cwd=folder, check=True)
    with open(report, encoding="utf-8") as stream:
        return json.load(stream)


def row(program, folder, points, noise, processes):
    planted = terrain_cloud.write(points, os.path.join(folder, "cloud.las"), noise=noise)
    split = run(program, folder, "tiles", "cloud.las", "--points-per-tile", 250000, "--output", "cloud.tiles")
    fit = run(program, folder, "fit", "cloud.tiles", "--tolerance", 3 * terrain_cloud.SIGMA, "--find-outliers", "--output", "ground.vtpc",
              processes=processes)
    assert split["points"] == fit["points"] == points
    return [f"{points:.0e}".replace("e+0", "e"), noise, str(planted), str(fit["tiles"]), f"{split['seconds']:.1f}",
            f"{split['peak_bytes'] / 1e6:.0f}", f"{fit['seconds']:.0f}", f"{fit['cpu_seconds']:.0f}", f"{fit['peak_bytes'] / 1e6:.0f}",
            str(fit["functions"]), str(fit["outliers"]), str(fit["points_outside"]), f"{fit['max_jump']:.1e}", f"{fit['max_slope_jump']:.1e}"]


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--points", nargs="*", type=lambda text: int(float(text)), default=[10**6, 10**7])
    parser.add_argument("--noise", nargs="*", choices=("uniform", "normal"), default=["uniform", "normal"])
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--folder")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    rows = []
    for points in arguments.points:
        for noise in arguments.noise:
            with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
                rows.append(row(os.path.abspath(arguments.program), folder, points, noise, arguments.processes))
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    table = page_tables.table_text(HEAD, rows)
    print(table, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the table of tiles", table)


if __name__ == "__main__":
    main()
