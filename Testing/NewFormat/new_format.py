# SPDX-License-Identifier: BSD-3-Clause
"""A format with a reader and a writer of its own is added to a copy of the tree: its files, and the edits of other files, which are
counted. The table of formats of the copy takes the place of the library's, and a file of the format is read and written by its ending.

usage: new_format.py COMPILER INCLUDE_FOLDERS LIBRARY...    (folders separated by ;)"""
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
MOST_EDITS = 5
FORMAT = {"Kernel": ("LatticeText.h", "LatticeText.cxx"),
          ".": ("vtkLatticeReader.h", "vtkLatticeReader.cxx", "vtkLatticeWriter.h", "vtkLatticeWriter.cxx")}
FILE_NAME = '<StringVectorProperty name="FileName" command="SetFileName" number_of_elements="1" default_values=""/>'

# file of Modules/SplineIO: (text, the text that takes its place), once or more
EDITS = {
    "Kernel/CMakeLists.txt": [("    NearestName.cxx\n", "    LatticeText.cxx\n    NearestName.cxx\n"),
                              ("    NearestName.h\n", "    LatticeText.h\n    NearestName.h\n")],
    "CMakeLists.txt": [("    vtkGoToolsG2Writer\n", "    vtkGoToolsG2Writer\n    vtkLatticeReader\n    vtkLatticeWriter\n")],
    "FileFormats.cxx": [
        ('#include "vtkPointCloudReader.h"\n', '#include "vtkLatticeReader.h"\n#include "vtkLatticeWriter.h"\n#include "vtkPointCloudReader.h"\n'),
        ('    { "STL",', '    { "lattice", { ".lat" }, SplineGridContent, SplineGridContent, false, ReadWith<vtkLatticeReader>,\n'
         '      WriteWith<vtkLatticeWriter> },\n    { "STL",')],
    "ParaView/SplineIO.xml": [
        ('    <SourceProxy name="CADReader"', f'''    <SourceProxy name="LatticeReader" class="vtkLatticeReader" label="Lattice Reader">
      {FILE_NAME}
      <Hints><ReaderFactory extensions="lat" file_description="Lattices"/></Hints>
    </SourceProxy>
    <SourceProxy name="CADReader"'''),
        ('    <WriterProxy name="GoToolsG2Writer"', f'''    <WriterProxy name="LatticeWriter" class="vtkLatticeWriter" label="Lattice Writer">
      <Input name="Input">The spline grid to write.</Input>
      {FILE_NAME}
      <Hints><WriterFactory extensions="lat" file_description="Lattices"/></Hints>
    </WriterProxy>
    <WriterProxy name="GoToolsG2Writer"''')],
    "README.md": [("### Boundaries of domains as JSON\n", "Lattices (`.lat`) are surfaces of degree 1.\n\n### Boundaries of domains as JSON\n")],
}


def edit(path, edits):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for old, new in edits:
        assert text.count(old) == 1, f"{path}: {old!r} is there {text.count(old)} times"
        text = text.replace(old, new)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def check_proxies(module):
    """What ParaView is given knows the new reader and writer."""
    headers = [os.path.join(module, name) for name in sorted(os.listdir(module)) if name.startswith("vtk") and name.endswith(".h")]
    made = os.path.join(module, "SplineIO.xml")
    subprocess.run([sys.executable, os.path.join(ROOT, "CMake", "properties.py"), "proxies", made,
                    os.path.join(module, "ParaView", "SplineIO.xml"), *headers], check=True)
    endings = [each.get("extensions") for each in ElementTree.parse(made).getroot().iter() if each.tag.endswith("Factory")]
    assert endings.count("lat") == 2


def main():
    compiler, folders, libraries = sys.argv[1], sys.argv[2].split(";"), sys.argv[3:]
    with tempfile.TemporaryDirectory() as folder:
        module = os.path.join(folder, "SplineIO")
        shutil.copytree(os.path.join(ROOT, "Modules", "SplineIO"), module, ignore=shutil.ignore_patterns("Testing"))
        for place, names in FORMAT.items():
            for name in names:
                shutil.copy(os.path.join(HERE, name), os.path.join(module, place))
        for path, edits in EDITS.items():
            edit(os.path.join(module, path), edits)
        check_proxies(module)
        sources = [os.path.join(module, name) for name in ("FileFormats.cxx", "Kernel/LatticeText.cxx", "vtkLatticeReader.cxx", "vtkLatticeWriter.cxx")]
        program = os.path.join(folder, "UseLattice")
        # the program's table is exported, so the library's own functions take it instead of theirs
        command = [compiler, "-std=c++17", "-O0", "-Wall", "-Werror", "-rdynamic", f"-I{module}", f"-I{module}/Kernel"]
        command += [word for where in folders if where != "/usr/include" for word in ("-isystem", where)]
        command += [*sources, os.path.join(HERE, "UseLattice.cxx"), *libraries, "-ltbb", "-lpthread", "-o", program]
        command += [f"-Wl,-rpath,{os.path.dirname(library)}" for library in libraries if ".so" in library]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        done = subprocess.run([program, folder], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    print(f"a format with a reader and writer of its own edits {len(EDITS)} files: " + ", ".join(sorted(EDITS)))
    assert len(EDITS) <= MOST_EDITS


if __name__ == "__main__":
    main()
