#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: build_site.py ROOT FOLDER VERSION

The site of Knotwork in FOLDER/html, for any static host: the guide's pages, the pages of the modules, the parts of the README that pages
ask for, and the reference of C++ (Doxygen, Breathe) and Python (the package's docstrings; `import knotwork` must work). Warnings are
errors, and every local link and picture of the result must exist. Status 77: Sphinx, MyST, Breathe, Furo or Doxygen is not installed.

A page takes a section of another one by <!-- section of FILE: HEADING -->, without its heading. Links between pages are those of the
repository, so that they lead there, too; links to what is no page become the name of the file.
"""
import glob
import html.parser
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import urllib.parse

HERE = os.path.dirname(os.path.abspath(__file__))
PICTURES = (".png", ".svg")
SECTION = re.compile(r"^<!-- section of (\S+): (.+) -->$", re.M)
LINK = re.compile(r"""(?P<text>\[(?P<words>[^\]]*)\])\((?P<target>[^)\s]+)\)|(?P<image><img src=")(?P<source>[^"]+)""")
CODE = re.compile(r"(^```.*?^```\n?)", re.M | re.S)


def read(file):
    with open(file, encoding="utf-8") as stream:
        return stream.read()


def write(file, text):
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(text)


def site_names(root):
    """{page of the repository: page of the site}"""
    names = {"README.md": "index.md", "CHANGELOG.md": "changes.md", "CONTRIBUTING.md": "contributing.md", "SECURITY.md": "security.md",
             "Modules/README.md": "architecture.md"}
    for file in glob.glob(os.path.join(root, "Modules", "*", "README.md")):
        module = os.path.basename(os.path.dirname(file))
        names[f"Modules/{module}/README.md"] = f"modules/{module}.md"
    for file in glob.glob(os.path.join(HERE, "*.md")):
        names[f"Examples/Guide/{os.path.basename(file)}"] = os.path.basename(file)
    return names


def section(text, heading):
    """What stands under a heading of the second level."""
    found = re.search(rf"^## {re.escape(heading)}\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    if not found:
        raise SystemExit(f"build_site.py: there is no section {heading}")
    return found[1]


class Stage:
    """The pages as Sphinx reads them, in a folder."""

    def __init__(self, root, folder):
        self.root, self.folder, self.names = root, folder, site_names(root)

    def target(self, page, site_page, target):
        """A link's target as the site has it; None when it is no page and no picture."""
        path, _, anchor = target.partition("#")
        if not path or re.match(r"\w+:", path):
            return target
        there = os.path.normpath(os.path.join(os.path.dirname(page), path))
        if not os.path.exists(os.path.join(self.root, there)):
            raise SystemExit(f"build_site.py: {page} links to {target}, which is not there")
        if there in self.names:
            made = self.names[there]
        elif there.endswith(PICTURES):
            made = "pictures/" + os.path.basename(there)
            os.makedirs(os.path.join(self.folder, "pictures"), exist_ok=True)
            shutil.copyfile(os.path.join(self.root, there), os.path.join(self.folder, made))
        else:
            return None
        return os.path.relpath(made, os.path.dirname(site_page) or ".") + ("#" + anchor if anchor else "")

    def with_links(self, page, site_page, text):
        def linked(found):
            if found["image"]:
                return found["image"] + self.target(page, site_page, found["source"])
            made = self.target(page, site_page, found["target"])
            if made is None:
                return f"{found['words']} (`{os.path.normpath(os.path.join(os.path.dirname(page), found['target']))}`)"
            return f"{found['text']}({made})"

        return "".join(part if CODE.fullmatch(part) else LINK.sub(linked, part) for part in CODE.split(text))

    def add(self, page, site_page):
        """Sections of other pages are taken with their own links."""
        parts = SECTION.split(read(os.path.join(self.root, page)))
        made = self.with_links(page, site_page, parts[0])
        for file, heading, rest in zip(*[iter(parts[1:])] * 3):
            other = os.path.normpath(os.path.join(os.path.dirname(page), file))
            made += self.with_links(other, site_page, section(read(os.path.join(self.root, other)), heading))
            made += self.with_links(page, site_page, rest)
        write(os.path.join(self.folder, site_page), made)

    def make(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        for page, site_page in self.names.items():
            if page != "README.md":
                self.add(page, site_page)


def filter_headers(root):
    """{module: its classes' headers}"""
    found = {}
    for file in sorted(glob.glob(os.path.join(root, "Modules", "*", "vtk*.h"))):
        found.setdefault(os.path.basename(os.path.dirname(file)), []).append(file)
    return found


def kernel_headers(root):
    """{module: the headers of its kernel that programs may include}"""
    found = {}
    for file in sorted(glob.glob(os.path.join(root, "Modules", "*", "Kernel", "CMakeLists.txt"))):
        listed = re.search(r"\bHEADERS\b(.*?)\bSOURCES\b", read(file), re.S)[1].split()
        folder = os.path.dirname(file)
        found[os.path.basename(os.path.dirname(folder))] = [os.path.join(folder, name) for name in sorted(listed) if name.endswith(".h")]
    return found


def run_doxygen(files, folder):
    """Doxygen's XML of the headers in FOLDER/xml."""
    exports = sorted({name for file in files for name in re.findall(r"\bVTKKNOTWORK\w+_EXPORT\b", read(file))})
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    settings = read(os.path.join(HERE, "Doxyfile")) + f'OUTPUT_DIRECTORY = "{folder}"\n'
    settings += f'INPUT_FILTER = "{sys.executable} {os.path.join(HERE, "doxygen_filter.py")}"\n'
    settings += "".join(f'INPUT += "{file}"\n' for file in files) + "".join(f'PREDEFINED += "{name}="\n' for name in exports)
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True)


def add_cxx_reference(filters, kernels, folder):
    """Two pages a module, as Breathe shows them: its filters, and the headers of its kernel."""
    for module, files in filters.items():
        text = f"# {module}: filters\n\nTarget `Knotwork::{module}`, headers `<knotwork/{module}/CLASS.h>`. Use, limits and errors: " \
               f"[{module}](../modules/{module}.md).\n"
        for name in (os.path.basename(file)[:-2] for file in files):
            text += f"\n## {name}\n\n```{{doxygenclass}} {name}\n:members:\n```\n"
        write(os.path.join(folder, "cxx", module + ".md"), text)
    for module, files in kernels.items():
        text = f"# {module}: kernel\n\nTarget `Knotwork::{module}Kernel`, which needs no VTK.\n"
        for file in files:
            name = os.path.basename(file)
            text += f"\n## {name}\n\n`#include <knotwork/{module}/{name}>`\n\n```{{doxygengroup}} {name.replace('.', '_')}\n:content-only:\n:members:\n```\n"
        write(os.path.join(folder, "cxx", module + "Kernel.md"), text)


def add_python_reference(folder):
    """The functions and classes of the package, from its docstrings."""
    import knotwork
    from knotwork import signatures

    text = read(os.path.join(folder, "python_reference.md"))
    verbs = sorted([verb for verb, (name, _) in signatures.VERBS.items() if signatures.available(name)] + ["trim"])
    for verb in verbs:
        assert callable(getattr(knotwork, verb)), verb
        text += f"\n```{{eval-rst}}\n.. autofunction:: knotwork.{verb}\n```\n"
    write(os.path.join(folder, "python_reference.md"), text)


class Links(html.parser.HTMLParser):
    """What a page of the site points to, and what may be pointed at."""

    def __init__(self, file):
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(read(file))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.targets.append(value)


def broken_links(folder):
    """Local links, pictures, scripts and styles that lead nowhere, each with its page; and how many were followed."""
    pages = {file: Links(file) for file in glob.glob(os.path.join(folder, "**", "*.html"), recursive=True)}
    broken, followed = [], 0
    for file, page in pages.items():
        for target in page.targets:
            path, _, anchor = urllib.parse.unquote(target).partition("#")
            if re.match(r"\w+:", target) or target.startswith("//"):
                continue
            there = os.path.normpath(os.path.join(os.path.dirname(file), path.partition("?")[0])) if path else file
            followed += 1
            if not os.path.exists(there) or (anchor and there in pages and anchor not in pages[there].anchors):
                broken.append(f"{os.path.relpath(file, folder)}: {target}")
    return broken, followed


def missing_programs():
    missing = [name for name in ("sphinx", "myst_parser", "breathe", "furo") if importlib.util.find_spec(name) is None]
    return missing + [name for name in ("doxygen",) if shutil.which(name) is None]


def main(root, folder, version):
    missing = missing_programs()
    if missing:
        print(f"skipped: {', '.join(missing)} missing; CMake/install-dependencies.sh installs what the site needs")
        return 77
    root, folder = os.path.abspath(root), os.path.abspath(folder)
    stage, xml, made = (os.path.join(folder, name) for name in ("pages", "doxygen", "html"))
    Stage(root, stage).make()
    filters, kernels = filter_headers(root), kernel_headers(root)
    run_doxygen([file for each in (filters, kernels) for files in each.values() for file in files], xml)
    add_cxx_reference(filters, kernels, stage)
    add_python_reference(stage)
    shutil.rmtree(made, ignore_errors=True)
    environment = dict(os.environ, KNOTWORK_VERSION=version, KNOTWORK_DOXYGEN_XML=os.path.join(xml, "xml"), PYTHONDONTWRITEBYTECODE="1")
    subprocess.run([sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-E", "-c", HERE, "-d", os.path.join(folder, "doctrees"), "-b", "html",
                    stage, made], env=environment, check=True)
    broken, followed = broken_links(made)
    for each in broken:
        print("leads nowhere:", each)
    print(f"{len(glob.glob(os.path.join(made, '**', '*.html'), recursive=True))} pages, {followed} local links followed, {len(broken)} broken")
    return 1 if broken or not followed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
