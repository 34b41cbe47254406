# SPDX-License-Identifier: BSD-3-Clause
"""Two meshes of Debian's libcgal-demo become STEP faces by `knotwork trim`, and are shown in ParaView (paraview_faces.png).

ParaView's Python lies in the prefix that CMake/make-paraview-prefix.sh makes; KNOTWORK_PARAVIEW_PREFIX names it.
"""
import json
import os
import subprocess
import sys

import _scene as scene
from trimmed_faces import bust

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAM = os.path.join(os.environ["KNOTWORK_BIN_DIR"], "knotwork") if "KNOTWORK_BIN_DIR" in os.environ else "knotwork"
PREFIX = os.environ.get("KNOTWORK_PARAVIEW_PREFIX", os.path.join(HERE, "../../build/paraview-prefix"))


def write_off(name, points, triangles):
    with open(name, "w") as stream:
        stream.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        stream.writelines("{:.17g} {:.17g} {:.17g}\n".format(*p) for p in points)
        stream.writelines("3 {} {} {}\n".format(*t) for t in triangles)


def trimmed(file, mesh):
    """Makes the STEP file, the triangles and the trimming curves of a mesh; says what they are."""
    write_off(file + ".off", *mesh)
    subprocess.run([PROGRAM, "trim", file + ".off", "--output", file + ".step", "--triangles", file + ".vtp", "--curves",
                    file + "_curves.vtu", "--report", file + ".json"], check=True)
    with open(file + ".json") as stream:
        said = json.load(stream)
    if not said["brep_valid"]:
        sys.exit(f"{file}.step is not valid")
    print(f"{file}.step: {said['faces']} faces, {said['loops']} loops, deviation {said['max_deviation']:.2g}")
    return file


def main():
    folder = scene.output_folder()
    files = [trimmed(os.path.join(folder, "box"), scene.read_off("patch-30.off")), trimmed(os.path.join(folder, "bust"), bust())]
    modules = os.path.join(PREFIX, "usr/lib/python3/dist-packages")
    if not os.path.isdir(modules):
        sys.exit(f"no ParaView in {PREFIX}; run CMake/make-paraview-prefix.sh {PREFIX}")
    picture = os.path.join(folder, "paraview_faces.png")
    subprocess.run(["pvbatch", os.path.join(HERE, "_open_in_paraview.py"), picture, *files], check=True,
                   env={**os.environ, "PYTHONPATH": modules})
    print("picture", picture)


if __name__ == "__main__":
    main()
