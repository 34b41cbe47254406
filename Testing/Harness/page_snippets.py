# SPDX-License-Identifier: BSD-3-Clause
"""Pages run as they are written: their fenced blocks of bash, Python and C++, one after the other, in one folder.

Commands of the program within the text between backquotes are run, too; only there may validate end with a verdict other than valid.
A block whose first line is a comment with the name of a file ("# CMakeLists.txt", "// main.cxx") becomes that file. Other bash blocks are run by
bash, which ends at the first command that fails; other Python blocks are run in one namespace a page. C++ must have a name, so that a
later block builds it. Blocks of other languages (text, console, json) are not run, nor those
with the job quadremesh where there is no blender.

usage: page_snippets.py PAGE FOLDER FILES   on copies of what the folder FILES holds; status 77: there is no such folder
"""
import os
import re
import shutil
import subprocess
import sys

BLOCK = re.compile(r"^```(bash|python|cpp|cmake)\n(.*?)^```$|(?<!`)`(knotwork \w+ [^`]+)`(?!`)", re.M | re.S)
NAMED = re.compile(r"(?:#|//) ([\w-]+\.\w+)\n")


def snippets(file):
    """[(place, language, text)] of a page; place: file and line."""
    with open(file, encoding="utf-8") as stream:
        text = stream.read()
    return [(f"{os.path.basename(file)}:{text.count(chr(10), 0, found.start()) + 1}", found[1] or "command", found[2] or found[3])
            for found in BLOCK.finditer(text)]


def fenced(file, language):
    """Texts of a page's blocks of one language."""
    with open(file, encoding="utf-8") as stream:
        return re.findall(rf"^```{language}\n(.*?)^```$", stream.read(), re.M | re.S)


def run_bash(place, text, folder, allowed=(0,)):
    environment = dict(os.environ, PATH=os.pathsep.join([os.environ["KNOTWORK_BIN_DIR"], "/usr/bin", os.environ["PATH"]]))
    done = subprocess.run(["bash", "-eu", "-o", "pipefail", "-c", text], cwd=folder, env=environment, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    if done.returncode not in allowed:
        raise AssertionError(f"{place}: bash ended with status {done.returncode}: {done.stdout[-3000:]}")


def run_python(place, text, names):
    """VTK's errors, which raise nothing, are failures too."""
    import knotwork  # noqa: F401
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

    window, before = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    vtkOutputWindow.SetInstance(window)
    try:
        exec(compile(text, place, "exec"), names)
    finally:
        vtkOutputWindow.SetInstance(before)
    if "ERR" in window.GetOutput():
        raise AssertionError(f"{place}: {window.GetOutput()}")


def run_page(file, folder, names=None, compile_cxx=None, commands=True):
    """Runs a page's blocks in a folder; the namespace of its Python and the number of blocks. Raises what a block raises.

    names: what the page's Python takes as given. compile_cxx: called with all C++ blocks without a name, of a page that shows parts of programs.
    commands: False leaves out those within the text, of a page that shows their forms."""
    names, found, before, parts = names or {}, snippets(file), os.getcwd(), []
    os.chdir(folder)
    try:
        for place, language, text in found:
            named = NAMED.match(text)
            if "knotwork quadremesh" in text and not shutil.which("blender"):
                print(f"{place}: skipped: blender is not installed")
            elif named:
                with open(named[1], "w", encoding="utf-8") as stream:
                    stream.write(text)
            elif language == "bash":
                run_bash(place, text, folder)
            elif language == "command":
                if commands:
                    run_bash(place, text, folder, (0, 3, 4) if text.startswith("knotwork validate ") else (0,))
            elif language == "python":
                run_python(place, text, names)
            elif language == "cpp" and compile_cxx:
                parts.append(text)
            else:
                raise AssertionError(f"{place}: a block of {language} begins with its file's name in a comment")
        if parts:
            compile_cxx(parts)
    finally:
        os.chdir(before)
    return names, len(found)


def main(page, folder, files):
    if not os.path.isdir(files):
        print("skipped: the packages that the files come from are not installed")
        return 77
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(files, folder)
    _, count = run_page(os.path.abspath(page), os.path.abspath(folder))
    print(f"{count} blocks ran")
    return 0 if count else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
