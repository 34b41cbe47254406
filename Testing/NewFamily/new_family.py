# SPDX-License-Identifier: BSD-3-Clause
"""A family of spaces is added to a copy of the kernel: its folder, and the edits of files outside of it, which are all that the
compiler asks for (every switch over SpaceKind is exhaustive). The edited files are compiled and take the place of the library's own.

usage: new_family.py LIBRARY COMPILER [OPTION...]    (options of the compiler; LIBRARY is libSplineCoreKernel.a)"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
KERNEL = os.path.join(HERE, "..", "..", "Modules", "SplineCore", "Kernel")
MOST_EDITS = 5

# file: (text, the text that takes its place)
EDITS = {
    "Space/SplineSpace.h": [
        ("  Explicit        ///<", "  Constant,\n  Explicit        ///<"),
        ("SpaceKind::Explicit };", "SpaceKind::Explicit, SpaceKind::Constant };"),
        ("    case SpaceKind::LocallyRefined:\n", "    case SpaceKind::LocallyRefined:\n    case SpaceKind::Constant:\n")],
    "Space/SpaceFamilies.cxx": [
        ('#include "BezierSpace.h"\n', '#include "BezierSpace.h"\n#include "ConstantSpace.h"\n'),
        ("    case SpaceKind::Bezier:\n", "    case SpaceKind::Constant:\n      return ConstantFamily<Dim>();\n    case SpaceKind::Bezier:\n")],
    "Space/LR/LocallyRefinedForm.cxx": [("    case SpaceKind::Bezier:\n", "    case SpaceKind::Constant:\n    case SpaceKind::Bezier:\n")],
    "CMakeLists.txt": [("    Space/Bezier/BezierFamily.cxx\n", "    Space/Bezier/BezierFamily.cxx\n    Space/Constant/ConstantFamily.cxx\n")],
}


def edit(path, edits):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for old, new in edits:
        assert text.count(old) == 1, f"{path}: {old!r} is there {text.count(old)} times"
        text = text.replace(old, new)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def check_switches():
    """No switch over families has a default, which would take the next family without a word."""
    for where, _, names in os.walk(os.path.join(HERE, "..", "..", "Modules")):
        for name in names:
            if name.endswith((".cxx", ".h")):
                with open(os.path.join(where, name), encoding="utf-8") as file:
                    blocks = [found.group(0) for found in re.finditer(r"^( *)switch \(.*?^\1}", file.read(), re.M | re.S)]
                assert not any("case SpaceKind::" in block and "default:" in block for block in blocks), f"{name}: a default for families"


def main():
    check_switches()
    library, compiler = sys.argv[1], sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        kernel = os.path.join(folder, "Kernel")
        shutil.copytree(KERNEL, kernel)
        public = os.path.join(folder, "include", "knotwork", "SplineCore")
        os.makedirs(public)
        room = os.path.join(kernel, "Space", "Constant")
        os.mkdir(room)
        for name in ("ConstantSpace.h", "ConstantFamily.cxx"):
            shutil.copy(os.path.join(HERE, name), room)

        def compile_file(path):
            made = os.path.join(folder, os.path.basename(path) + ".o")
            folders = [os.path.join(folder, "include")] + [where for where, _, _ in os.walk(kernel)]
            # the compiler names every switch that does not know the family
            flags = ["-std=c++17", "-O0", "-Wall", "-Werror", "-c", path, "-o", made] + ["-I" + where for where in folders]
            return made, subprocess.run([*compiler, *flags], capture_output=True, text=True, check=False)

        for where, _, names in os.walk(kernel):
            for name in names:
                if name.endswith(".h"):
                    os.symlink(os.path.join(where, name), os.path.join(public, name))
        switches = [os.path.join(where, name) for where, _, names in os.walk(kernel) for name in names if name.endswith(".cxx")]
        switches = [path for path in switches if "case SpaceKind::" in open(path, encoding="utf-8").read()]
        # with the enumerator alone the compiler refuses the very files that are edited below
        edit(os.path.join(kernel, "Space/SplineSpace.h"), EDITS["Space/SplineSpace.h"])
        for path in switches:
            _, done = compile_file(path)
            assert "Constant" in done.stderr and done.returncode != 0, f"{path} does not miss the family\n{done.stderr}"
            assert os.path.relpath(path, kernel) in EDITS, f"{path} names families and is not edited"
        for path, edits in EDITS.items():
            if path != "Space/SplineSpace.h":
                edit(os.path.join(kernel, path), edits)
        objects = []
        for path in [*switches, os.path.join(room, "ConstantFamily.cxx"), os.path.join(HERE, "UseConstantSpace.cxx")]:
            made, done = compile_file(path)
            assert done.returncode == 0, done.stderr
            objects.append(made)
        program = os.path.join(folder, "UseConstantSpace")
        subprocess.run([*compiler, *objects, library, "-ltbb", "-lpthread", "-o", program], check=True)
        subprocess.run([program], check=True)
    print(f"a family edits {len(EDITS)} files outside its folder: " + ", ".join(sorted(EDITS)))
    assert len(EDITS) <= MOST_EDITS


if __name__ == "__main__":
    main()
