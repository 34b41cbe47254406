#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A model of jobs in many processes: its constants, how far it is from runs that it has not seen, and what it says of 64 and 4,096 processes.

usage: processes_model.py PROGRAM [--seconds S] [--repeats N] [--folder FOLDER] [--write PAGE]

One thread a process, each on a core of its own, memory for all of them:
    seconds = fixed + n (own / P + everywhere) + messages latency log2(P) + told / bandwidth
    bytes   = fixed + n (own / P + everywhere), fixed being another of one process and of several
of n cells or points in P processes. Memory is a process's own, without pages of libraries; what is fixed of it is that of a
thousand cells or points. Each of the latter tells all others its part of what is summed up, so that what one of them hears does not become
less with P; messages and what is told are counted by the program and grow with n. The constants follow from runs of n in one process, 2 n in one and n in two
(what is everywhere counts from a tenth on; --seconds: of one thread for n, 5 without), latency and bandwidth from messages between two processes. Runs of 2 n in two processes and of 4 n in one and two are what the model
is held against; of N runs the fastest, 3 without --repeats. A fit of tiles takes, row by row, ceil(tiles of a row / P) times a tile's seconds, and for each tile what all processes do, both by the functions of a tile. --write puts the tables between the
comments `the model of processes: begin` and `end` of a page.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

import page_tables
import processes_table
import terrain_cloud
import tiles_table

PING = """
from mpi4py import MPI
import numpy, time
world, other = MPI.COMM_WORLD, 1 - MPI.COMM_WORLD.rank
for size, count in ((8, 4000), (1 << 24, 20)):
    data = numpy.zeros(size, dtype=numpy.uint8)
    world.Barrier()
    start = time.perf_counter()
    for _ in range(count):
        for sender in (0, 1):
            (world.Send if world.rank == sender else world.Recv)(data, other)
    if world.rank == 0:
        print((time.perf_counter() - start) / (2 * count))
"""
PROCESSES = (64, 4096)
SIZES = (1e9, 1e10, 1e11)
TILE_POINTS = 250000


def network():
    """Seconds of a message, and bytes a second."""
    done = subprocess.run([*processes_table.MPIRUN, "2", "/usr/bin/python3", "-c", PING], check=True, stdout=subprocess.PIPE, text=True)
    latency, long = map(float, done.stdout.split())
    return latency, (1 << 24) / (long - latency)


# Of what a cell or point takes: less that is everywhere is not told from noise by two processes.
LEAST_EVERYWHERE = 0.1


def split(a_unit, own):
    """What a cell or point takes divided by the processes, and everywhere; none is negative."""
    own = a_unit if own > (1.0 - LEAST_EVERYWHERE) * a_unit else max(own, 0.0)
    return own, a_unit - own


class JobModel:
    """Constants of a job from three runs: of n, of about 2 n, and of n in two processes; and from the memory that few cells or points take in one and in two."""

    def __init__(self, n, alone, more, twice, both, least, net):
        self.net, self.n, self.more = net, n, more
        self.messages = both["rank_messages"][0] / n
        self.told = sum(both["rank_sent_bytes"]) / n
        self.fixed, self.own, self.everywhere = self.solve(alone["seconds"], twice["seconds"], both["seconds"] - self.talk(2, n))
        self.least = least
        a_unit = max(twice["peak_own_bytes"] - least[0], 0.0) / more
        self.own_bytes, self.bytes_everywhere = split(a_unit, 2.0 * (a_unit - max(max(both["rank_peak_own_bytes"]) - least[1], 0.0) / n))

    def solve(self, alone, twice, both):
        """fixed, own and everywhere of the seconds; none is negative."""
        a_unit = max(twice - alone, 0.0) / (self.more - self.n)
        return (max(alone - self.n * a_unit, 0.0), *split(a_unit, 2.0 * (alone - both) / self.n))

    def talk(self, processes, n):
        latency, bandwidth = self.net
        return n * self.messages * latency * math.log2(processes) + n * self.told / bandwidth if processes > 1 else 0.0

    def seconds(self, processes, n):
        return self.fixed + n * (self.own / processes + self.everywhere) + self.talk(processes, n)

    def bytes(self, processes, n):
        return self.least[processes > 1] + n * (self.own_bytes / processes + self.bytes_everywhere)


class TileModel:
    """Seconds of a tile, and of what all processes do for it, a function, from the same tiles in one process and in two: tiles need more functions where the terrain is rougher."""

    def __init__(self, side, alone, both):
        a_tile = alone["functions"] / side ** 2
        rounds = math.ceil(side / 2)
        self.tile = max((alone["seconds"] - both["seconds"]) / (side * (side - rounds)), 0.0) / a_tile
        self.common = max(alone["seconds"] / side ** 2 / a_tile - self.tile, 0.0)
        self.held = max(both["rank_peak_own_bytes"])

    def seconds(self, processes, tiles, functions):
        """@param functions  of a tile."""
        side = math.ceil(math.sqrt(tiles))
        return side * (math.ceil(side / processes) * self.tile + side * self.common) * functions


def text(value):
    return f"{value:.2g}".replace("e+0", "e").replace("e+", "e")


def duration(seconds):
    for unit, size in (("d", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{seconds / size:.{0 if seconds >= 10 * size else 1}f} {unit}"
    return f"{seconds:.{0 if seconds >= 10 else 1}f} s"


def off(predicted, measured):
    return f"{measured:.1f} ({100.0 * (predicted / measured - 1.0):+.0f} %)"


def off_memory(predicted, measured):
    return f"{measured / 1e6:.0f} ({100.0 * (predicted / measured - 1.0):+.0f} %)"


def job_rows(program, folder, job, seconds, repeats, make, words_of, net):
    """A row of constants, one of checks, and one of predictions for each number of processes. Of repeated runs the fastest counts: other work only adds."""
    def run(processes):
        return min((processes_table.run(program, folder, processes, 1, words_of("work", processes > 1)) for _ in range(repeats)), key=lambda report: report["seconds"])

    make(1000)
    least = run(1)["peak_own_bytes"], max(run(2)["rank_peak_own_bytes"])
    n = make(20000)
    n = int(n * seconds / max(run(1)["seconds"], 1e-3))
    runs, sizes = {}, {}
    for factor in (1, 2, 4):
        sizes[factor] = make(factor * n)
        for processes in (1, 2):
            runs[factor, processes] = run(processes)
    n = sizes[1]
    model = JobModel(n, runs[1, 1], sizes[2], runs[2, 1], runs[1, 2], least, net)
    constants = [job, text(n), text(model.fixed), *(text(1e9 * one) for one in (model.own, model.everywhere)), *(text(one / 1e6) for one in least), text(model.own_bytes),
                 text(model.bytes_everywhere),
                 text(1e6 * model.messages), text(model.told)]
    checks = [job]
    for factor, processes in ((2, 2), (4, 1), (4, 2)):
        found = runs[factor, processes]
        checks.append(off(model.seconds(processes, sizes[factor]), found["seconds"]))
        checks.append(off_memory(model.bytes(processes, sizes[factor]), max(found.get("rank_peak_own_bytes", [found["peak_own_bytes"]]))))
    predictions = [[job, str(processes)] + [f"{duration(model.seconds(processes, size))}, {text(model.bytes(processes, size) / 1e9)} GB" for size in SIZES]
                   for processes in PROCESSES]
    return constants, checks, predictions


def tile_rows(program, folder):
    """The same of tiles: of 16 in one process and two for the constants, of 36 for the check."""
    runs = {}
    for side in (4, 6):
        points = side * side * TILE_POINTS
        terrain_cloud.write(points, os.path.join(folder, "cloud.las"), noise="uniform")
        found = tiles_table.run(program, folder, "tiles", "cloud.las", "--points-per-tile", TILE_POINTS, "--output", "cloud.tiles")
        for processes in (1, 2):
            runs[side, processes] = tiles_table.run(program, folder, "fit", "cloud.tiles", "--tolerance", 3 * terrain_cloud.SIGMA, "--find-outliers", "--threads", 1,
                                                    "--output", "ground.vtpc", processes=processes)
            runs[side, processes]["side"] = math.sqrt(found["tiles"])
    side = math.ceil(runs[4, 1]["side"])
    model = TileModel(side, runs[4, 1], runs[4, 2])
    checks = ["`fit` of tiles", "", ""]
    for processes in (1, 2):
        found = runs[6, processes]
        functions = found["functions"] / found["tiles"]
        checks += [off(model.seconds(processes, found["tiles"], functions), max(found.get("rank_seconds", [found["seconds"]]))), f"{max(found.get('rank_peak_own_bytes', [found['peak_own_bytes']])) / 1e6:.0f}"]
    said = (f"A tile of {TILE_POINTS:.1e} points, with {functions:.0f} functions, takes {model.tile * functions:.2f} s, what all processes do for it "
            f"{model.common * functions:.3f} s.")
    predictions = [["`fit` of tiles", str(processes)] + [f"{duration(model.seconds(processes, size / TILE_POINTS, functions))}, {text(model.held / 1e9)} GB and two rows of surfaces"
                                                         for size in SIZES] for processes in PROCESSES]
    return said, checks, predictions


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--folder")
    parser.add_argument("--write")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    net = network()
    constants, checks, predictions = [], [], []
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        processes_table.surface(program, folder)
        for job, make, words_of in processes_table.jobs(program, folder):
            one, check, many = job_rows(program, folder, job, arguments.seconds, arguments.repeats, make, words_of, net)
            constants.append(one)
            checks.append(check)
            predictions += many
            print(json.dumps([one, check, many]), file=sys.stderr, flush=True)
        said, check, many = tile_rows(program, folder)
        checks.append(check)
        predictions += many
    result = (f"A message takes {1e6 * net[0]:.1f} us, a byte {1e9 / net[1]:.2f} ns. {said}\n\n" +
              page_tables.table_text(["job", "n", "fixed, s", "own, ns", "everywhere, ns", "fixed, MB, one", "several", "own, bytes", "everywhere, bytes", "messages of 1e6", "told, bytes"],
                                     constants) + "\nRuns that the model was held against, seconds and MB, and how far it is off:\n\n" +
              page_tables.table_text(["job", "2 n by two, s", "MB", "4 n by one, s", "MB", "4 n by two, s", "MB"], checks) +
              "\nWhat it says of many processes, each with the memory it needs:\n\n" +
              page_tables.table_text(["job", "processes", *(f"{text(size)} cells or points" for size in SIZES)], predictions))
    print(result, end="")
    if arguments.write:
        page_tables.write_table(arguments.write, "the model of processes", result)


if __name__ == "__main__":
    main()
