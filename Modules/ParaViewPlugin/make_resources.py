#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""usage: make_resources.py ROOT FOLDER PROXIES.xml...: what ParaView's window shows of the plugin, FOLDER/Knotwork.qrc for Qt's resource compiler.

Icons of all proxies in menus, the configuration of menus and toolbar, and Knotwork.qch: the pages of the modules, and for each proxy a page with its
section of them, which the question mark of its panel opens. Needs python3-markdown and qhelpgenerator."""
import glob
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

try:
    import markdown
except ImportError:
    sys.exit("make_resources.py: there is no python3-markdown")

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "..", "CMake")]
import draw_icons  # noqa: E402
import properties  # noqa: E402

STYLE = "body{font-family:sans-serif;margin:1em} table{border-collapse:collapse} td,th{border:1px solid #ccc;padding:3px} pre{background:#f4f4f4;padding:6px}"
TITLE = re.compile(r"^# (.*)", re.M)


def write(file, text):
    os.makedirs(os.path.dirname(file), exist_ok=True)
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(text)


def html(title, text):
    return (f'<html><head><meta charset="utf-8"/><title>{title}</title><style>{STYLE}</style></head><body>'
            f'{markdown.markdown(text, extensions=["tables", "fenced_code", "toc"])}</body></html>')


def plain(text):
    """Without pictures, comments, and links to what the help has not; links between pages go to their HTML."""
    text = re.sub(r"<!--.*?-->\n?", "", text, flags=re.S)
    text = re.sub(r"!\[([^\]]*)\]\([^)]*\)", "", text)
    text = re.sub(r"\[([^\]]*)\]\((?:\.\./|Modules/)*(\w+)/README\.md(#[^)]*)?\)", r"[\1](\2.html\3)", text)
    return re.sub(r"\[([^\]]*)\]\((?!\w+\.html|#|https?:)[^)]*\)", r"\1", text)


def read(file):
    with open(file, encoding="utf-8") as stream:
        return stream.read()


def section(page, name):
    """The part of a page under the title that names the class."""
    found = re.search(rf"^(##+) [^\n]*\b{name}\b[^\n]*\n.*?(?=^\1 |\Z)", page, re.M | re.S)
    return found[0] if found else page


def pages(root):
    """HTML of the modules' pages, by name: title, text."""
    found = {"index": ("Knotwork", read(os.path.join(root, "Modules", "README.md")).replace("](", "](../Modules/"))}
    for file in sorted(glob.glob(os.path.join(root, "Modules", "*", "README.md"))):
        name = os.path.basename(os.path.dirname(file))
        text = read(file)
        found[name] = (TITLE.search(text)[1].replace("`", ""), text)
    return found


def help_of(proxy, module, page):
    documentation = proxy.find("Documentation")
    text = " ".join((documentation.text or "").split())
    return (f"# {proxy.get('label')}\n\n**{documentation.get('short_help')}.** {text}\n\nAll of it: [{module}]({module}.html).\n\n"
            + section(page, proxy.get("class")))


def make_help(root, folder, sources):
    files, sections = [], []
    found = pages(root)
    for name, (title, text) in found.items():
        write(os.path.join(folder, "help", name + ".html"), html(title, plain(text)))
        files.append(name + ".html")
        sections.append(f'<section title="{title.replace("&", "&amp;")}" ref="{name}.html"/>')
    for source in sources:
        module = os.path.splitext(os.path.basename(source))[0]
        for group in ElementTree.parse(source).getroot().iter("ProxyGroup"):
            for proxy in group:
                name = f"{group.get('name')}.{proxy.get('name')}.html"
                write(os.path.join(folder, "help", name), html(proxy.get("label"), plain(help_of(proxy, module, found[module][1]))))
                files.append(name)
    listed = "".join(f"<file>{name}</file>" for name in files)
    write(os.path.join(folder, "help", "Knotwork.qhp"),
          '<?xml version="1.0" encoding="UTF-8"?><QtHelpProject version="1.0"><namespace>knotwork</namespace><virtualFolder>knotwork</virtualFolder>'
          f'<filterSection><toc><section title="Knotwork" ref="index.html">{"".join(sections[1:])}</section></toc><files>{listed}</files>'
          '</filterSection></QtHelpProject>')
    subprocess.run(["qhelpgenerator", os.path.join(folder, "help", "Knotwork.qhp"), "-o", os.path.join(folder, "Knotwork.qch")], check=True,
                   stdout=subprocess.DEVNULL, env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "QT_LOGGING_RULES": "*=false"})


def make_icons(folder, sources):
    names = [proxy.get("name") for _, proxy in properties.in_menus(sources)]
    draw_icons.main(os.path.join(folder, "Icons"), *names)
    return [f"Icons/{name}.svg" for name in names]


def main(root, folder, *sources):
    os.makedirs(folder, exist_ok=True)
    icons = make_icons(folder, sources)
    properties.menus(os.path.join(folder, "menus.xml"), sources)
    make_help(root, folder, sources)
    entries = [("Knotwork", name, name) for name in icons] + \
        [("Knotwork/ParaViewResources", "menus.xml", "menus.xml"), ("Knotwork/Documentation", "Knotwork.qch", "Knotwork.qch")]
    lines = [f'<qresource prefix="/{prefix}"><file alias="{alias}">{name}</file></qresource>' for prefix, alias, name in entries]
    write(os.path.join(folder, "Knotwork.qrc"), "<RCC>" + "\n".join(lines) + "</RCC>\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
