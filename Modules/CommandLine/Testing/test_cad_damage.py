# SPDX-License-Identifier: BSD-3-Clause
"""CAD files with random damage end in a result or in one line that names the file; the program never crashes or hangs."""
import random

import knotwork_testing


def path(name):
    return knotwork_testing.output("cli_cad_damage/" + name)


def run(*arguments):
    return knotwork_testing.run_program(*arguments)


def test_random_damage_ends_in_a_result_or_an_error():
    grid = path("torus.vtu")
    done = run("source", "--shape", "torus-surface", "--output", grid)
    assert done.returncode == 0, done.stderr
    for ending, count in ((".step", 60), (".igs", 60)):
        whole = path("whole" + ending)
        done = run("convert", grid, "--output", whole)
        assert done.returncode == 0, done.stderr
        with open(whole, "rb") as stream:
            text = stream.read()
        generator = random.Random(20)
        last = len(text) - 200
        refused = 0
        for _ in range(count):
            hurt = bytearray(text)
            for _ in range(generator.randint(1, 5)):
                place, source = generator.randint(500, last), generator.randint(500, last)
                hurt[place:place + 20] = text[source:source + 20]
            bad = path("hurt" + ending)
            with open(bad, "wb") as stream:
                stream.write(hurt)
            done = run("info", bad)
            assert done.returncode in (0, 1), (done.returncode, done.stderr)
            refused += done.returncode
            if done.returncode == 1:
                assert len(done.stderr.splitlines()) == 1 and "hurt" + ending in done.stderr, done.stderr
        assert refused > count // 5, (ending, refused)


knotwork_testing.main(globals())
