#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: make_packages.py SOURCE RELEASE_TREE PARAVIEW_TREE FOLDER

Debian packages of built trees, FOLDER/*.deb; what stands in which says the file `control`. Needs dpkg-dev and the build's own packages."""
import filecmp
import glob
import gzip
import os
import re
import shutil
import subprocess
import sys

import completions
import man_pages

HERE = os.path.dirname(os.path.abspath(__file__))
MAINTAINER = os.environ.get("KNOTWORK_MAINTAINER", "The Knotwork authors <authors@knotwork.invalid>")
# modules of python3-vtk9 that need Qt, Tk or MPI, or serve VTK's own tests
LEFT_OF_VTK = ("*Qt*", "*Tk*", "*MPI*", "gtk", "qt", "test", "tk", "wx", "web", "__pycache__")
OWN = ("libknotwork", "libknotwork-gpl")  # packages with libraries
SCRIPTS = "/usr/share/javascript/sphinxdoc/1.0"  # of the package libjs-sphinxdoc
NOTICES = {"libknotwork-gpl": """
Comment: these libraries are linked with CHOLMOD's supernodal part (GPL-2+) or made with CGAL's packages under
 the GPL-3+, so they are distributed under the GPL version 3, which is in
 /usr/share/common-licenses/GPL-3. knotwork-tetgen is linked with TetGen
 (AGPL-3+) and runs in a process of its own.
""", "python3-knotwork": """
Files: /usr/lib/knotwork/python/vtkmodules
Copyright: Ken Martin, Will Schroeder, Bill Lorensen
License: BSD-3-Clause
 From Debian's package python3-vtk9; its notices are in /usr/share/doc/libvtk9.1/copyright.
"""}


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def write(file, text, mode=0o644):
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(text)
    os.chmod(file, mode)


def compress(file):
    with open(file, "rb") as plain, open(file + ".gz", "wb") as packed, gzip.GzipFile("", "wb", 9, packed, 0) as stream:
        stream.write(plain.read())
    os.remove(file)


def stanzas(text):
    """Fields of every package in the order of the file."""
    for stanza in re.split(r"\n\n+", re.sub(r"^#.*\n", "", text, flags=re.M).strip()):
        fields = {}
        for line in stanza.split("\n"):
            if line.startswith(" "):
                fields[name] += "\n" + line
            else:
                name, _, value = line.partition(":")
                fields[name] = value.strip()
        yield fields


def make_stage(source, release, paraview, folder):
    """The install tree, with plugin/, docs/, vtk/ and made/ beside it."""
    stage = os.path.join(folder, "stage")
    shutil.rmtree(stage, ignore_errors=True)
    run("cmake", "--install", release, "--prefix", stage, "--strip")
    version = re.search(r"^CMAKE_PROJECT_VERSION:\w+=(.*)$", open(os.path.join(release, "CMakeCache.txt"), encoding="utf-8").read(), re.M)[1]
    for package in glob.glob(os.path.join(stage, "lib", "python3*", "site-packages", "knotwork")):
        shutil.rmtree(os.path.join(package, "__pycache__"), ignore_errors=True)
    triplet = run("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()
    plugin = os.path.join(stage, "plugin", "Knotwork")
    shutil.copytree(os.path.join(paraview, "lib", "knotwork-paraview", "Knotwork"), plugin, ignore=shutil.ignore_patterns("cmake", "vtk"))
    there = f"/usr/lib/{triplet}/paraview-5.11/plugins/Knotwork"
    write(os.path.join(plugin, "knotwork.plugins.xml"), '<?xml version="1.0"?>\n<Plugins>\n'
          f'  <Plugin name="Knotwork" filename="{there}/Knotwork.so" auto_load="1"/>\n</Plugins>\n')
    for program in ("paraview", "pvserver", "pvdataserver", "pvrenderserver", "pvbatch", "pvpython"):
        write(os.path.join(stage, "made", "conf", program + ".conf"), there + "/knotwork.plugins.xml\n")
    make_texts(stage, version)
    make_docs(source, os.path.join(stage, "docs"))
    make_site(source, stage, version, folder)
    modules = "/usr/lib/python3/dist-packages/vtkmodules"
    if "python3-vtk9" not in run("dpkg", "-S", modules):
        raise SystemExit("make_packages.py: the package python3-vtk9 is not installed; CMake/install-dependencies.sh installs it")
    shutil.copytree(modules, os.path.join(stage, "vtk", "vtkmodules"), ignore=shutil.ignore_patterns(*LEFT_OF_VTK))
    return stage, version + "-1", triplet


def make_texts(stage, version):
    program = os.path.join(stage, "bin", "knotwork")
    made = os.path.join(stage, "made")
    man_pages.main(program, version, os.path.join(made, "man1"))
    for file in glob.glob(os.path.join(made, "man1", "*.1")):
        compress(file)
    for shell in ("bash", "zsh"):
        os.makedirs(os.path.join(made, shell))
    completions.main(program, os.path.join(made, "bash", "knotwork"), os.path.join(made, "zsh", "_knotwork"))


def make_docs(source, docs):
    """What git has of pages, pictures and examples, where their links find each other, and the parts that examples read."""
    listed = run("git", "-C", source, "ls-files", "*.md", "CITATION.cff", "Modules/modules.svg", "Examples", "Testing/Data/Parts/*.step").split("\n")
    for name in filter(None, listed):
        if name.endswith(".md") and name.startswith(("Testing/", "CONTRIBUTING")):
            continue
        os.makedirs(os.path.dirname(os.path.join(docs, name)) or docs, exist_ok=True)
        shutil.copyfile(os.path.join(source, name), os.path.join(docs, name))


def make_site(source, stage, version, folder):
    """The guide as HTML in docs/html; its pictures are links to those of the examples, its scripts to those of Debian."""
    build = os.path.join(folder, "guide")
    python = glob.glob(os.path.join(stage, "lib", "python3*", "site-packages"))[0]
    done = subprocess.run([sys.executable, os.path.join(source, "Examples", "Guide", "build_site.py"), source, build, version],
                          env=dict(os.environ, PYTHONPATH=python, PYTHONDONTWRITEBYTECODE="1"))
    if done.returncode != 0:
        raise SystemExit("make_packages.py: the guide's site is not made; CMake/install-dependencies.sh installs what it needs")
    made = os.path.join(stage, "docs", "html")
    shutil.copytree(os.path.join(build, "html"), made, ignore=shutil.ignore_patterns(".buildinfo", "objects.inv", ".doctrees"))
    for picture in glob.glob(os.path.join(made, "_images", "*.png")):
        name = os.path.join("Examples", "Gallery", "Pictures", os.path.basename(picture))
        if os.path.exists(os.path.join(stage, "docs", name)):
            os.remove(picture)
            os.symlink(os.path.join("..", "..", name), picture)
    for script in glob.glob(os.path.join(made, "_static", "*.js")):
        theirs = os.path.join(SCRIPTS, os.path.basename(script))
        if os.path.exists(theirs) and filecmp.cmp(script, theirs, shallow=False):
            os.remove(script)
            os.symlink(os.path.relpath(theirs, "/usr/share/doc/knotwork/html/_static"), script)
    shutil.rmtree(build)


def take(stage, root, lines, triplet, taken):
    """Copies the files of a stanza's lines. taken: files that went elsewhere, which a pattern leaves out."""
    for line in filter(None, lines.split("\n")):
        pattern, target = line.format(triplet=triplet).strip().split(" -> ")
        found = [each for each in sorted(glob.glob(os.path.join(stage, pattern))) if each not in taken]
        if not found:
            raise SystemExit(f"make_packages.py: there is no {pattern}")
        taken.update(found)
        for item in found:
            to = os.path.join(root, target, os.path.basename(item))
            os.makedirs(os.path.dirname(to), exist_ok=True)
            if os.path.isdir(item) and not os.path.islink(item):
                shutil.copytree(item, to, symlinks=True, dirs_exist_ok=True)
            else:
                shutil.copy2(item, to, follow_symlinks=False)


def binaries(root):
    for folder, _, files in os.walk(root):
        for name in files:
            file = os.path.join(folder, name)
            if not os.path.islink(file):
                with open(file, "rb") as stream:
                    if stream.read(4) == b"\x7fELF":
                        yield file


def finish_binaries(root):
    """No symbols, and no paths to look for libraries but those of the plugin, which has its libraries beside it."""
    script = ""
    for file in binaries(root):
        run("strip", "--strip-unneeded", "--remove-section=.comment", "--remove-section=.note", file)
        os.chmod(file, 0o755 if os.access(file, os.X_OK) and ".so" not in os.path.basename(file) else 0o644)
        beside = "/plugins/" in file
        script += f'file(RPATH_SET FILE "{file}" NEW_RPATH "\\$ORIGIN")\n' if beside else f'file(RPATH_REMOVE FILE "{file}")\n'
    if script:
        name = root + ".cmake"
        write(name, script)
        run("cmake", "-P", name)
        os.remove(name)


def needed(root, folder, private):
    """The packages whose libraries the files are linked with, as dpkg-shlibdeps finds them."""
    files = list(binaries(root))
    if not files:
        return ""
    work = os.path.join(folder, "work")
    write(os.path.join(work, "debian", "control"), f"Source: knotwork\nMaintainer: {MAINTAINER}\n\nPackage: knotwork\nArchitecture: any\n")
    found = run("dpkg-shlibdeps", "-O", "--ignore-missing-info", *(f"-l{each}" for each in private), *(f"-e{each}" for each in files),
                cwd=work, stderr=subprocess.DEVNULL)
    shutil.rmtree(work)
    listed = re.sub(r"^shlibs:Depends=", "", found.strip()).split(", ")
    return ", ".join(each for each in listed if each.split()[0] not in OWN)  # `control` says these


def maintainer_scripts(root, package, version):
    control = os.path.join(root, "DEBIAN")
    libraries = sorted(glob.glob(os.path.join(root, "usr", "lib", "*.so.*")))
    if libraries:
        write(os.path.join(control, "triggers"), "activate-noawait ldconfig\n")
        names = [os.path.basename(each).split(".so.") for each in libraries]
        write(os.path.join(control, "shlibs"), "".join(f"{name} {number} {package} (= {version})\n" for name, number in names))
    if package == "python3-knotwork":
        places = f"{package} /usr/lib/knotwork/python"
        write(os.path.join(control, "postinst"), f'#!/bin/sh\nset -e\nif [ "$1" = configure ]; then\n  py3compile -p {package}\n  py3compile -p {places}\nfi\n', 0o755)
        write(os.path.join(control, "prerm"), f"#!/bin/sh\nset -e\npy3clean -p {package}\nfind /usr/lib/knotwork/python -name __pycache__ -exec rm -rf {{}} +\n", 0o755)


def make_package(fields, stage, version, triplet, folder, private, taken):
    package = fields["Package"]
    root = os.path.join(folder, package)
    shutil.rmtree(root, ignore_errors=True)
    take(stage, root, fields["Files"], triplet, taken)
    finish_binaries(root)
    documents = os.path.join(root, "usr", "share", "doc", package)
    write(os.path.join(documents, "copyright"), "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n\nFiles: *\n"
          "Copyright: 2026, the Knotwork authors\nLicense: BSD-3-Clause\n" +
          "".join(f" {line}\n" if line else " .\n" for line in open(os.path.join(HERE, "..", "..", "LICENSE"), encoding="utf-8").read().rstrip().split("\n")) +
          NOTICES.get(package, ""))
    write(os.path.join(documents, "changelog.Debian"), f"knotwork ({version}) bookworm; urgency=medium\n\n  * The changes are in CHANGELOG.md of knotwork-doc.\n\n"
          f" -- {MAINTAINER}  {run('date', '-R', '-u', '-d', '@' + run('git', '-C', HERE, 'log', '-1', '--format=%ct').strip()).strip()}\n")
    compress(os.path.join(documents, "changelog.Debian"))
    overrides = f"# made for a site, not for an upload to Debian\n{package}: initial-upload-closes-no-bugs *\n"
    if os.path.exists(os.path.join(HERE, "lintian-overrides", package)):
        overrides += open(os.path.join(HERE, "lintian-overrides", package), encoding="utf-8").read()
    write(os.path.join(root, "usr", "share", "lintian", "overrides", package), overrides)
    maintainer_scripts(root, package, version)
    depends = [each for each in (fields.get("Depends", "").format(version=version).replace("\n", ""), needed(root, folder, private)) if each]
    size = run("du", "-sk", "--apparent-size", root).split()[0]
    architecture = fields.get("Architecture") or run("dpkg", "--print-architecture").strip()
    control = {"Package": package, "Source": "knotwork" if package != "knotwork" else None, "Version": version, "Section": fields["Section"],
               "Priority": "optional", "Architecture": architecture, "Installed-Size": size, "Maintainer": MAINTAINER,
               "Depends": ", ".join(depends), "Recommends": fields.get("Recommends"), "Suggests": fields.get("Suggests"),
               "Description": fields["Description"]}
    write(os.path.join(root, "DEBIAN", "control"), "".join(f"{name}: {value}\n" for name, value in control.items() if value))
    sums = run("find", ".", "-type", "f", "-not", "-path", "./DEBIAN/*", "-printf", "%P\\0", cwd=root).rstrip("\0").split("\0")
    write(os.path.join(root, "DEBIAN", "md5sums"), run("md5sum", *sorted(sums), cwd=root))
    run("chmod", "-R", "u=rwX,go=rX", root)
    file = os.path.join(folder, f"{package}_{version}_{architecture}.deb")
    run("dpkg-deb", "--root-owner-group", "-Zxz", "--build", root, file)
    shutil.rmtree(root)
    return file


def main(source, release, paraview, folder):
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
    stage, version, triplet = make_stage(source, release, paraview, folder)
    with open(os.path.join(HERE, "control"), encoding="utf-8") as stream:
        packages = list(stanzas(stream.read()))
    taken = set()
    private = [os.path.join(stage, "lib"), os.path.join(stage, "plugin", "Knotwork"), f"/usr/lib/{triplet}/paraview-5.11"]
    for fields in packages:
        print(make_package(fields, stage, version, triplet, folder, private, taken))
    shutil.rmtree(stage)


if __name__ == "__main__":
    main(*sys.argv[1:])
