# SPDX-License-Identifier: BSD-3-Clause
"""Every format on a disk that is too small, which a limit of the size of files stands for: an error with the system's reason."""
import os
import random
import resource
import signal
import subprocess
import tempfile

import knotwork_testing
import job_inputs
from refusals import good, path

LIMITED = ".vtu .vtp .vtpc .vti .csv .json .xml .g2 .bext .xyz .txt .step .iges .stl .obj .ply".split()


def limited(size):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # whose default would end the program

    return limit


def run(folder, arguments, limit=None):
    return subprocess.run([knotwork_testing.PROGRAM, *map(str, arguments), "--quiet"], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=120, preexec_fn=limit)


def sizes(folder):
    return {os.path.relpath(os.path.join(place, name), folder): os.path.getsize(os.path.join(place, name))
            for place, _, names in os.walk(folder) for name in names}


def cases():
    """A run a format, and the file that grows too large."""
    height, cloud, square = path("height.vtu"), path("cloud.csv"), path("square.vtu")
    for name in ("o.vtu", "o.xml", "o.g2", "o.bext", "o.step", "o.iges", "o.vtpc"):
        yield ["convert", square if name == "o.xml" else height, "--output", name], name
    for encoding in ("ascii", "appended"):
        yield ["convert", height, "--encoding", encoding, "--output", "o.vtu"], "o.vtu"
    for name in ("o.vtp", "o.stl", "o.obj", "o.ply"):
        yield ["tessellate", height, "--output", name], name
    for name in ("o.xyz", "o.txt", "o.csv", "o.g2"):
        yield ["convert", cloud, "--output", name], name
    yield ["fit", cloud, "--tolerance", 1e-3, "--output", "f.vtu", "--features", "o.vti", "--feature-grid-size", 40], "o.vti"
    yield ["validate", height, "--table", "o.csv"], "o.csv"
    yield ["info", height, "--report", "o.json"], "o.json"


def test_no_format_is_cut_off_in_silence():
    job_inputs.make_files()
    draw = random.Random(5)
    seen = set()
    for arguments, name in cases():
        with tempfile.TemporaryDirectory() as folder:
            done = run(folder, arguments)
            assert done.returncode == 0, (arguments, done.stderr)
            whole = max(size for file, size in sizes(folder).items() if os.path.splitext(file)[0][:1] == "o")
        seen.add(os.path.splitext(name)[1])
        if name.endswith(".json"):
            whole -= 200  # measured seconds have more or fewer digits
        # nothing at all, all but the last byte, and places between
        for size in {0, 1, whole - 1, whole // 2, draw.randrange(whole), draw.randrange(whole)}:
            with tempfile.TemporaryDirectory() as folder:
                with open(os.path.join(folder, name), "w") as stream:
                    stream.write("")
                before = sizes(folder)
                done = run(folder, arguments, limited(size))
                where = (arguments, size, whole, done.returncode, done.stderr)
                assert done.returncode == 1, where
                assert len(done.stderr.splitlines()) == 1 and "File too large" in done.stderr, where
                assert name in done.stderr or "f.vtu" in arguments, where
                assert sizes(folder) == before, (where, sizes(folder))
    assert seen == set(LIMITED), set(LIMITED) - seen


knotwork_testing.main(globals())
