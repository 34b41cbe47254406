# SPDX-License-Identifier: BSD-3-Clause
"""All meshes (.off) of the Debian package libcgal-demo through `flatten`, `features` and `trim`: a result, or one clean line that names the file,
within 120 seconds of processor time and two gigabytes. The environment variable KNOTWORK_PACKAGE_MESHES may name a folder that has
them unpacked, or others. usage: test_package_meshes.py [PART [PARTS]]: every PARTS-th mesh from number PART on."""
import hashlib
import json
import os
import pathlib
import sys
import tarfile
import tempfile

import knotwork_testing
from measured_runs import faults_of_message, run

PART, PARTS = (int(word) for word in (sys.argv[1:] + ["0", "1"][len(sys.argv) - 1:])[:2])
ARCHIVES = [pathlib.Path("/usr/share/doc/libcgal-dev") / name for name in ("data.tar.gz", "demo.tar.gz", "examples.tar.gz")]
LONGEST = 120.0  # seconds of the processors
LARGEST = 2 << 30  # bytes
FINE = (0, 1, 5)


def unpacked():
    """Of the package's archives the meshes, in a folder of their own."""
    if not ARCHIVES[0].exists():
        knotwork_testing.skip("neither KNOTWORK_PACKAGE_MESHES nor the package libcgal-demo is there")
    folder = pathlib.Path(tempfile.mkdtemp(dir=os.path.dirname(knotwork_testing.output("package_meshes"))))
    for number, archive in enumerate(ARCHIVES):
        if archive.exists():
            with tarfile.open(archive) as files:
                for member in files:
                    if member.isfile() and member.name.endswith(".off"):
                        target = folder / str(number) / member.name.lstrip("./")
                        target.parent.mkdir(parents=True, exist_ok=True)
                        target.write_bytes(files.extractfile(member).read())
    return folder


def meshes():
    """Each once, in the order of names."""
    folder = os.environ.get("KNOTWORK_PACKAGE_MESHES")
    files = {}
    for file in sorted(pathlib.Path(folder or unpacked()).rglob("*.off")):
        files.setdefault(hashlib.sha256(file.read_bytes()).hexdigest(), file)
    return list(files.values())[PART::PARTS]


def test_every_mesh_ends_in_a_result_or_one_clean_line():
    wrong = []
    for mesh in meshes():
        for job, output, options in (("flatten", "flat.vtp", []), ("flatten", "charts.vtp", ["--maximum-stretch", 3]),
                                     ("features", "regions.vtp", []), ("trim", "face.step", [])):
            with tempfile.TemporaryDirectory(dir=os.path.dirname(knotwork_testing.output("package_meshes"))) as folder:
                status, seconds, cpu, memory, errors = run([job, mesh, "--output", output, *options, "--report", "report.json", "--threads", 1, "--quiet"], folder,
                                                             1200)
                faults = list(faults_of_message(mesh.stem, status, errors))
                if status not in FINE:
                    faults.append(f"ended with {status}")
                if (status != 1) != os.path.exists(os.path.join(folder, output)):
                    faults.append("has an output in spite of an error, or none")
                if options and status != 1 and not json.loads(pathlib.Path(folder, "report.json").read_text())["injective"]:
                    faults.append("has a chart that lies over itself")
                if cpu > LONGEST:
                    faults.append(f"took {cpu:.0f} s")
                if memory > LARGEST:
                    faults.append(f"took {memory >> 20} MB")
            line = errors[:400].decode(errors="backslashreplace").strip().replace("\n", " | ")
            print(f"{job:8} {mesh.name:34} {status} {cpu:6.1f} s {memory >> 20:5} MB {line}", flush=True)
            wrong += [f"{job} {mesh}: {fault}: {line}" for fault in faults]
    assert not wrong, f"{len(wrong)} complaints:\n" + "\n".join(wrong)


knotwork_testing.main(globals())
