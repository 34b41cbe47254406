#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a property of a filter is, is said once: in the filter's header. This script reads the headers and makes the rest.

usage: properties.py print-self OUT.cxx HEADER...     PrintSelf of the classes
       properties.py menus OUT.xml IN.xml...          ParaView's menus and toolbar: what is neither reader nor writer
       properties.py options OUT HEADER...            OUT.h, OUT.cxx: options of the command line for the classes
       properties.py proxies OUT.xml IN.xml HEADER... ParaView's proxies: IN.xml with its short forms written out
       properties.py python OUT.py IN.xml... HEADER... what Python knows of the classes: types, ranges, names of choices, sentences; ports and lists
       properties.py defaults ROOT                    compares defaults of filters with those of the kernel fields they go to
       properties.py pages [--check] ROOT             what stands between marks on the pages of the tree, <!-- properties of CLASS --> or
                                                      <!-- jobs --> and <!-- end -->: rewritten or compared; and every class has its row in README.md

A property is a setter macro of VTK under a comment:

    /** Share of the largest error from which on elements are split. Default 0.1, valid range [0, 1]. Advanced. For
     * Threshold LARGEST_ERRORS, MOST_POINTS. */
    vtkSetClampMacro(ThresholdShare, double, 0.0, 1.0);

First what it is, for every reader; then "Default ...", held against the initializer of the member, and "valid range [a, b]"
or ">= a", held against the macro; then, where they apply,

    Advanced.             ParaView shows it on demand, --help under a title of its own
    For NAME VALUE, ....  it counts with these values (or on, off) of another property: ParaView shows it with them only; "not" before
                          the values: with the other ones. Several sentences: all must hold. "For Input CLASS, ...": with data of these
                          classes as the first input.
    Components a, b, ...  what its numbers are called
    Group "Name".         properties that ParaView frames together, and --help lists under that title
    Kernel default 0.     the kernel's default, where it is another one

A property between two enumerators is a choice of that enumeration. A label in quotes that begins an enumerator's comment is
what people see, else the enumerator's words are; on the command line it is the same in lower case, or what the label has in brackets.
Enumerators and properties that a sentence names become what they are called where it is shown.

IN.xml is XML of ParaView's server manager with short forms: <Properties/> in a proxy stands for all properties of its class that the proxy
does not write itself (<Properties until="NAME"/>: those before that one), <Input name= types="..."> for an input (without types: splines), <Outputs names="..."/> for
its output ports, <Array name= arrays="domain of the input"> for a choice of an array (index= of SetInputArrayToProcess, a property of the class, or a
list of arrays: repeat_command="1"), and the
attributes components="..." and for="NAME VALUE" of any other property or input label its numbers and hide it. Of outputs in short form only the
first one is shown. In the menu it has the icon of its name; with toolbar="1" it is in the toolbar too."""
import glob
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

STATUS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Modules", "SplineCore", "Kernel", "Base", "Status.h")
SPLINE_TYPES = "vtkUnstructuredGrid vtkPartitionedDataSetCollection"
CLASS = re.compile(r"^class VTK\w+_EXPORT (\w+) : public (\w+)", re.M)
SETTER = re.compile(r"vtkSet(Clamp|Vector\d|String|FilePath|)Macro\(([^;]*)\);")
GETTER = re.compile(r"vtkGet(?:Vector\d|String|FilePath|Object|)Macro\((\w+)[^;]*\);")
LIST = re.compile(r"^  std::vector<[^;]*> (\w+);", re.M)
TITLES = ("Outputs", "Advanced", "General")  # of the program's own
SENTENCES = re.compile(r"(?<=\.)\s+(?=Advanced\.|For \w+ |Components |Group \"|Kernel default )")


class Fault(Exception):
    """What is wrong with a header or page, as one line."""


def words_of(name):
    """LRStrategy -> LR Strategy, as ParaView labels properties."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)


def option_name(name):
    """As Options::KebabCase does."""
    return re.sub(r"^max-", "maximum-", words_of(name).lower().replace(" ", "-"))


def number(text):
    """As short as it can be written; None: not a number, or one that stands for no bound."""
    try:
        value = float(text)
    except ValueError:
        return None
    if abs(value) >= 1e29:
        return None
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else repr(value).replace("e-0", "e-")


def parse_condition(text):
    """NAME [not] VALUE, ...: name, values, whether it is the other values."""
    name, *values = text.replace(",", "").split()
    inverse = values[0] == "not"
    return name, values[inverse:], inverse


class Choice:
    def __init__(self, enumerator, comment):
        label = re.match(r'"([^"]*)"', comment)
        self.enumerator = enumerator
        self.label = label[1] if label else words_of(enumerator) if enumerator[-1].islower() else \
            enumerator.replace("_", " ").title()
        bracket = re.search(r"\((\w+)\)", self.label)
        squeezed = re.sub(r"\W", "", self.label).lower().startswith(enumerator.replace("_", "").lower())
        self.option = (bracket[1] if bracket else enumerator if squeezed else self.label).lower().replace("_", "-")
        self.option = re.sub(r"\s+", "-", self.option)


class Property:
    def __init__(self, name, macro, arguments, comment, header):
        self.name = name
        self.where = f"{header.file}: {name}"
        self.type = "string" if macro in ("String", "FilePath") or "string" in arguments[0] else arguments[0]
        self.is_characters = macro in ("String", "FilePath")
        self.count = int(macro[-1]) if macro.startswith("Vector") else 1
        self.macro_bounds = arguments[1:3] if macro == "Clamp" else None
        self.choices = header.choices_between(*self.macro_bounds) if self.macro_bounds else []
        if self.macro_bounds and not self.choices and not all(re.match(r"-?\d|VTK_", each) for each in self.macro_bounds):
            raise Fault(f"{self.where}: {' and '.join(self.macro_bounds)} are no enumerators of one enumeration")
        self.default = self.initial(header)
        self.advanced, self.conditions, self.components, self.group, self.kernel = False, [], [], None, None
        self.low = self.high = None
        self.parse(" ".join(comment.split()))

    def initial(self, header):
        found = re.search(rf"^ +[\w:]+\*? {self.name}(?:\[\d\])?(?: = ([^;]*))?;", header.text, re.M)
        if not found:
            raise Fault(f"{self.where}: no member")
        words = (found[1] or '""').strip("{ }").split(",")
        return [word.strip().replace("nullptr", '""').strip('"') for word in words]

    def default_words(self):
        if self.type == "bool":
            return "on" if self.default[0] == "true" else "off"
        if self.type == "string":
            return self.default[0] or "empty"
        return " ".join(word if self.choices else number(word) or word for word in self.default)

    def parse(self, comment):
        found = re.fullmatch(r"(.*?)(?: Default (.+?)(?:, valid range (\[.*?\]|\(.*?\]|>= \S+?))?\.( .*)?)?", comment)
        self.text, default, bounds, marks = found.groups()
        if default is None:
            if self.default_words() != "empty":
                raise Fault(f"{self.where}: the comment says no default")
        elif default != self.default_words():
            raise Fault(f"{self.where}: default is {default} in the comment and {self.default_words()} in the member")
        if bounds:
            limits = re.findall(r"[^\[\](),>= ]+", bounds)
            self.low, self.high = number(limits[0]), number(limits[1]) if len(limits) > 1 else None
        if self.macro_bounds and not self.choices:
            macro = [None if "VTK_" in limit else number(limit) for limit in self.macro_bounds]
            if [self.low, self.high] != macro:
                raise Fault(f"{self.where}: range is {bounds} in the comment and {macro} in the macro")
        self.open_low = bool(bounds) and bounds.startswith("(")
        for mark in SENTENCES.split((marks or "").strip()):
            self.parse_mark(mark.rstrip("."))
        if self.count > 1 and not self.components:
            raise Fault(f"{self.where}: {self.count} numbers without names: Components ...")

    def parse_mark(self, mark):
        words = mark.replace(",", "").split()
        if mark == "Advanced":
            self.advanced = True
        elif mark.startswith("For "):
            self.conditions.append(parse_condition(mark[len("For "):]))
        elif mark.startswith("Components "):
            self.components = words[1:]
            if len(self.components) != self.count:
                raise Fault(f"{self.where}: {len(self.components)} names of {self.count} components")
        elif mark.startswith("Group "):
            self.group = mark[len("Group "):].strip('"')
            if self.group in TITLES:
                raise Fault(f"{self.where}: a group is not called {self.group}, which --help has for other options")
        elif mark.startswith("Kernel default "):
            self.kernel = words[2]
        elif mark:
            raise Fault(f"{self.where}: what does '{mark}' behind the default mean?")

    def range_words(self, choice=lambda choice: choice.enumerator):
        if self.choices:
            return ", ".join(map(choice, self.choices))
        if self.low is None and self.high is None:
            return ""
        if self.high is None:
            return f"at least {self.low}"
        return f"{'above ' if self.open_low else ''}{self.low} to {self.high}"


def without_enumeration(text):
    return re.sub(r"[,;]? one of [A-Z]\w+", "", text)


class Header:
    """A class with its properties in the order of the header."""

    def __init__(self, file):
        with open(file, encoding="utf-8") as stream:
            self.text = stream.read()
        self.file = os.path.basename(file)
        found = CLASS.search(self.text)
        if not found:
            raise Fault(f"{self.file}: no class")
        self.name, self.base = found.groups()
        self.enumerations = [self.enumerators(body) for body in re.findall(r"enum \w+\s*\{(.*?)\};", self.text, re.S)]
        public = self.text.partition("\nprotected:")[0]
        self.properties = []
        for comment, code in re.findall(r"/\*\*(.*?)\*/\s*\n(.*?)(?=///@\}|\n\n|/\*\*|\Z)", public, re.S):
            for macro, arguments in SETTER.findall(code):
                name, *rest = [argument.strip() for argument in arguments.split(",")]
                self.properties.append(Property(name, macro, rest or ["string"], re.sub(r"\n\s*\*", " ", comment), self))
        for setter in SETTER.findall(public):
            name = setter[1].split(",")[0].strip()
            if name not in self.named():
                raise Fault(f"{self.file}: {name} has no comment")

    @staticmethod
    def enumerators(body):
        found = re.findall(r"^\s*(\w+)(?:\s*=\s*\d+)?,?[ \t]*(?:///<\s*(.*))?$", body, re.M)
        return [Choice(*each) for each in found]

    def choices_between(self, low, high):
        for choices in self.enumerations:
            names = [choice.enumerator for choice in choices]
            if low in names and high in names:
                return choices[names.index(low):names.index(high) + 1]
        return []

    def named(self):
        return {each.name: each for each in self.properties}

    def sentence(self, each, of_choice, of_property):
        """The text of a property with choices and properties as they are called."""
        names = {choice.enumerator: of_choice(choice) for choices in self.enumerations for choice in choices
                 if len(choice.enumerator) > 3}
        names.update({name: of_property(name) for name in self.named() if len(words_of(name).split()) > 1})
        return re.sub(r"\b\w+\b", lambda found: names.get(found[0], found[0]), without_enumeration(each.text))


def print_self(out, headers):
    lines = ["// Generated from the headers by CMake/properties.py"]
    lines += [f'#include "{header.name}.h"' for header in headers]
    for header in headers:
        if "void PrintSelf(" not in header.text:
            continue
        lines += ["", f"void {header.name}::PrintSelf(ostream& os, vtkIndent indent)", "{",
                  "  this->Superclass::PrintSelf(os, indent);"]
        shown = header.named()
        for name in GETTER.findall(header.text):
            each = shown.get(name)
            values = [f"this->{name}"]
            if each and each.is_characters:
                values = [f'(this->{name} ? this->{name} : "(none)")']
            elif each and each.count > 1:
                values = [f"this->{name}[{i}]" for i in range(each.count)]
            joined = ' << " " << '.join(values)
            lines.append(f'  os << indent << "{name}: " << {joined} << "\\n";')
        for name in LIST.findall(header.text):
            lines.append(f'  os << indent << "{name}: " << this->{name}.size() << "\\n";')
        lines.append("}")
    write(out, lines)


def literal(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


DEFAULT_GROUP = "Options"  # of --help
ICON = ":/Knotwork/Icons/{}.svg"  # of a proxy in ParaView's menus


def chain_of(header, classes):
    """The class behind those of its bases whose properties count as its own: not the one of all filters and of all readers."""
    base = classes.get(header.base)
    return ([*chain_of(base, classes)] if base and base.name not in ("vtkSplineAlgorithm", "vtkSplineFileReader") else []) + [header]


def options(out, headers):
    classes = {header.name: header for header in headers}
    bases = {header.base for header in headers}
    headers = [header for header in headers
               if header.name not in bases and chain_of(header, classes)[0].base in ("vtkSplineAlgorithm", "vtkWriter")
               and any(each.name != "FileName" for each in header.properties)]
    write(out + ".h", [
        "// Generated from the headers of the filters by CMake/properties.py", "#pragma once", "",
        *(f"class {header.name};" for header in headers), "", "namespace knotwork", "{", "class Options;",
        "/// The properties of a filter as options.",
        *(f"void AddProperties(Options& options, {header.name}* filter);" for header in headers), "}"])
    lines = ["// Generated from the headers of the filters by CMake/properties.py",
             f'#include "{os.path.basename(out)}.h"', '#include "Options.h"']
    lines += [f"#include <knotwork/{header.module}/{header.name}.h>" for header in headers]
    lines += ["namespace knotwork", "{"]
    for header in headers:
        lines += [f"void AddProperties(Options& options, {header.name}* filter)", "{"]
        group = DEFAULT_GROUP
        for owner, each in [(owner, each) for owner in chain_of(header, classes) for each in owner.properties]:
            if each.name == "FileName":
                continue
            own = each.group or ("Advanced" if each.advanced else DEFAULT_GROUP)
            if own != group:
                lines.append(f'  options.Group("{own}");')
                group = own
            lines.append(option_line(owner, each))
        lines += [f'  options.Group("{DEFAULT_GROUP}");', "}"]
    write(out + ".cxx", lines + ["}"])


def option_line(header, each):
    text = header.sentence(each, lambda choice: choice.option, lambda name: "--" + option_name(name)).rstrip(".")
    if len(text) > 1 and not text[1].isupper():
        text = text[0].lower() + text[1:]
    name, get, put = f'"{each.name}"', f"filter->Get{each.name}()", f"filter->Set{each.name}"
    text = literal(text)
    if each.choices:
        names = ", ".join(f'"{choice.option}"' for choice in each.choices)
        return f"  options.AddChoice({name}, {{ {names} }}, {get}, [filter](int v) {{ {put}(v); }}, {text});"
    if each.type == "string" and each.is_characters:
        return (f"  options.Add<std::string>({name}, {get} ? {get} : \"\", "
                f"[filter](const std::string& v) {{ {put}(v.c_str()); }}, {text});")
    if each.count > 1:
        kind = f"std::vector<{each.type}>"
        values = ", ".join(f"v[{i}]" for i in range(each.count))
        return (f"  options.Add<{kind}>({name}, {kind}({get}, {get} + {each.count}), "
                f"[filter](const {kind}& v) {{ {put}({values}); }}, {text});")
    kind = "std::string" if each.type == "string" else each.type
    bounds = f", InRange(filter->Get{each.name}MinValue(), filter->Get{each.name}MaxValue())" if each.macro_bounds else ""
    return f"  options.Add<{kind}>({name}, {get}, [filter](const {kind}& v) {{ {put}(v); }}, {text}{bounds});"


def element(tag, content=None, /, **attributes):
    made = ElementTree.Element(tag, {key: str(value) for key, value in attributes.items() if value is not None})
    made.text = content
    return made


def proxies(out, source, headers):
    classes = {header.name: header for header in headers}
    root = ElementTree.parse(source).getroot()
    for proxy in [*root.iter("SourceProxy"), *root.iter("WriterProxy")]:
        chain = []
        name = proxy.get("class")
        if name not in classes:
            raise Fault(f"{os.path.basename(source)}: no header of {name}")
        while name in classes:
            chain.append(classes[name])
            name = chain[-1].base
        expand(proxy, chain)
    ElementTree.indent(root)
    write(out, ["<!-- Generated by CMake/properties.py -->", ElementTree.tostring(root, encoding="unicode")])


def expand(proxy, chain):
    """Writes the short forms of a proxy out. chain: its class and the bases."""
    written = {child.get("name") for child in proxy}
    left = [(header, each) for header in chain for each in header.properties if each.name not in written]
    children, outputs = [], []
    for child in list(proxy):
        if child.tag == "Properties":
            names = [each.name for _, each in left]
            if child.get("until", names[0] if names else None) not in names + [None]:
                raise Fault(f"{proxy.get('name')}: no property {child.get('until')} is left to be written out")
            until = names.index(child.get("until")) if child.get("until") else len(left)
            children += [proxy_property(header, each) for header, each in left[:until]]
            left = left[until:]
        elif child.tag == "Input":
            condition = child.attrib.pop("for", "")
            children.append(input_property(child))
            hide(children[-1], chain[0], [parse_condition(condition)] if condition else [])
        elif child.tag == "Array":
            children.append(array_property(child, chain))
        elif child.tag == "Outputs":
            outputs = child.get("names").split()
            children += [element("OutputPort", name=name, index=i, id=f"port{i}") for i, name in enumerate(outputs)]
        else:
            label_components(child, child.attrib.pop("components", "").split())
            condition = child.attrib.pop("for", "")
            hide(child, chain[0], [parse_condition(condition)] if condition else [])
            children.append(child)
    if proxy.find("Hints") is None:
        children.append(element("Hints"))
    hints = next(child for child in children if child.tag == "Hints")
    if hints.find("View") is None:
        hints.extend(element("View", type="None", port=i) for i in range(1, len(outputs)))
    proxy[:] = framed(children)
    proxy.attrib.pop("toolbar", None)


def in_menus(sources):
    """Group and element of every proxy that is neither reader nor writer."""
    for source in sources:
        for group in ElementTree.parse(source).getroot().iter("ProxyGroup"):
            yield from ((group.get("name"), proxy) for proxy in group.iter("SourceProxy") if proxy.find("Hints/ReaderFactory") is None)


def menus(out, sources):
    """ParaView's configuration of the category Knotwork of its menus. A hint ShowInMenu of the proxies could not leave some out of the toolbar."""
    root = element("Menus")
    categories = {}
    for group, menu in (("sources", "ParaViewSources"), ("filters", "ParaViewFilters")):
        root.append(element(menu))
        categories[group] = element("Category", name="Knotwork", show_in_toolbar=1 if group == "filters" else None)
        root[-1].append(categories[group])
    for group, proxy in in_menus(sources):
        name = proxy.get("name")
        categories[group].append(element("Proxy", group=group, name=name, icon=ICON.format(name),
                                         omit_from_toolbar=None if proxy.get("toolbar") == "1" else 1))
    ElementTree.indent(root)
    write(out, ["<!-- Generated by CMake/properties.py -->", ElementTree.tostring(root, encoding="unicode")])


def label_components(made, names):
    """What the numbers of a property are called in the panel."""
    if names:
        if made.find("Hints") is None:
            made.append(element("Hints"))
        labels = element("ShowComponentLabels")
        labels.extend(element("ComponentLabel", component=i, label=name) for i, name in enumerate(names))
        made.find("Hints").append(labels)


def array_property(short, chain):
    """A choice among the arrays of an input: which one SetInputArrayToProcess takes, a property of the class, or a list of arrays."""
    given = dict(short.attrib)
    declared = None if "index" in given else chain[0].named().get(given["name"])
    conditions = [parse_condition(given.pop("for"))] if "for" in given else declared.conditions if declared else []
    domain = element("ArrayListDomain", name="array_list", none_string=given.pop("none_string", None),
                     input_domain_name=given.pop("arrays"), attribute_type=None if "repeat_command" in given else "Scalars")
    domain.append(element("RequiredProperties"))
    domain[0].append(element("Property", name=given.pop("input", "Input"), function="Input"))
    if "index" in given:
        made = element("StringVectorProperty", command="SetInputArrayToProcess", number_of_elements=5, element_types="0 0 0 0 2",
                       animateable=0, default_values=given.pop("index"), **given)
    elif "repeat_command" in given:
        made = element("StringVectorProperty", number_of_elements_per_command=1, **given)
    else:
        made = element("StringVectorProperty", number_of_elements=1, default_values="None", command="Set" + given["name"],
                       panel_visibility="advanced" if declared.advanced else None, group=declared.group, **given)
    text = " ".join((short.text or "").split()) or declared.text
    made.extend([domain, element("Documentation", text), *short])
    if "repeat_command" in given:  # none is chosen first
        made.append(element("Hints"))
        made[-1].append(element("NoDefault"))
    hide(made, chain[0], conditions)
    return made


def hide(made, header, conditions):
    """Hides a property that the proxy writes itself unless conditions as those of the mark "For" hold."""
    if conditions:
        if made.find("Hints") is None:
            made.append(element("Hints"))
        made.find("Hints").extend(decorators(header, header.file, conditions))


def framed(properties):
    """The properties with frames of those of one group, each behind its first property's place."""
    groups = {}
    for each in properties:
        groups.setdefault(each.attrib.pop("group", None), []).append(each.get("name"))
    frames = []
    for label, names in groups.items():
        if label:
            frame = element("PropertyGroup", label=label)
            frame.extend(element("Property", name=name) for name in names)
            frames.append(frame)
    return properties + frames


def input_property(short):
    given = {"command": "SetInputConnection", **short.attrib}
    accepted = given.pop("types", SPLINE_TYPES).split()
    composite = given.pop("composite_data_supported", None)
    made = element("InputProperty", **given)
    groups = element("ProxyGroupDomain", name="groups")
    groups.extend([element("Group", name="sources"), element("Group", name="filters")])
    types = element("DataTypeDomain", name="input_type", composite_data_supported=composite)
    types.extend(element("DataType", value=value) for value in accepted)
    made.extend([groups, types, *[child for child in short if child.tag != "Hints"],
                 element("Documentation", " ".join(short.text.split()))])
    made.extend(child for child in short if child.tag == "Hints")
    return made


def proxy_property(header, each):
    label = lambda choice: choice.label  # noqa: E731
    kind = {"int": "Int", "bool": "Int", "vtkIdType": "Int", "double": "Double", "string": "String"}[each.type]
    default = {"true": "1", "false": "0"}
    enumerators = [choice.enumerator for choices in header.enumerations for choice in choices]
    words = [str(place_of(each.choices, word)) if word in enumerators else default.get(word, number(word) or word)
             for word in each.default]
    made = element(kind + "VectorProperty", name=each.name, command="Set" + each.name, number_of_elements=each.count,
                   default_values=" ".join(words), panel_visibility="advanced" if each.advanced else None,
                   group=each.group)
    if each.type == "bool":
        made.append(element("BooleanDomain", name="bool"))
    elif each.choices:
        domain = element("EnumerationDomain", name="enum")
        domain.extend(element("Entry", value=place, text=choice.label) for place, choice in enumerate(each.choices))
        made.append(domain)
    elif each.type != "string":
        made.append(element(kind + "RangeDomain", name="range", min=each.low, max=each.high))
    made.append(element("Documentation", header.sentence(each, label, words_of)))
    hints = decorators(header, each.where, each.conditions)
    if hints:
        made.append(element("Hints"))
        made[-1].extend(hints)
    label_components(made, each.components)
    return made


def place_of(choices, enumerator):
    return [choice.enumerator for choice in choices].index(enumerator)


def decorators(header, where, conditions):
    """What hides a property while it does not count."""
    parts = []
    for name, values, inverse in conditions:
        if name == "Input":
            parts.append({"type": "InputDataTypeDecorator", "mode": "visibility", "name": " ".join(values),
                          **({"exclude": "1"} if inverse else {})})
            continue
        other = header.named().get(name)
        if other is None:
            raise Fault(f"{where}: for {name}: there is no such property")
        try:
            places = [{"on": 1, "off": 0}[value] if other.type == "bool" else place_of(other.choices, value)
                      if other.choices else float(value) for value in values]
        except (KeyError, ValueError):
            raise Fault(f"{where}: for {name} {', '.join(values)}: it has no such value") from None
        parts.append({"type": "GenericDecorator", "mode": "visibility", "property": name,
                      "value" if len(places) == 1 else "values": " ".join(f"{place:g}" for place in places)})
        if inverse:
            parts[-1]["inverse"] = "1"
    if len(parts) < 2:
        return [element("PropertyWidgetDecorator", **part) for part in parts]
    both = element("PropertyWidgetDecorator", type="CompositeDecorator")
    both.append(element("Expression", type="and"))
    both[0].extend(element("PropertyWidgetDecorator", **part) for part in parts)
    return [both]


def python(out, sources, headers):
    classes = {header.name: header for header in headers}
    lines = ["# Generated from the headers of the filters and ParaView's proxies by CMake/properties.py",
             "# class: property: type, how many, lowest and highest value, names of the values", "PROPERTIES = {"]
    for header in headers:
        lines.append(f'    "{header.name}": {{')
        for each in [each for owner in chain_of(header, classes) for each in owner.properties]:
            low, high = (each.low, each.high) if each.macro_bounds else (None, None)
            names = [(choice.option, choice.enumerator) for choice in each.choices]
            lines.append(f'        "{each.name}": ("{each.type}", {each.count}, {low}, {high}, {names}),')
        lines.append("    },")
    lines += ["}", "# class: property: default, what it is", "MEANINGS = {"]
    for header in headers:
        lines.append(f'    "{header.name}": {{')
        for owner, each in [(owner, each) for owner in chain_of(header, classes) for each in owner.properties]:
            text = owner.sentence(each, lambda choice: repr(choice.option), lambda name: "`" + snake_case(name) + "`")
            lines.append(f'        "{each.name}": ({python_default(each)!r}, {text!r}),')
        lines.append("    },")
    lines += ["}", "# class: inputs (name, port, many, types), outputs, lists (name, adds, clears, how many, what it is), objects (name, sets), arrays (name, index, of points or cells, what it is)",
              "FILTERS = {"]
    for source in sources:
        for proxy in ElementTree.parse(source).getroot().iter("SourceProxy"):
            lines.append(f'    "{proxy.get("class")}": {python_ports(proxy)!r},')
    with open(STATUS, encoding="utf-8") as stream:
        codes = re.findall(r"^  (\w+)(?: = 0)?,? +///< (.*)", stream.read(), re.M)
    write(out, lines + ["}", "# names of the kernel's errors, by their numbers from 1 on", f"CODES = {[name for name, _ in codes]!r}"])


def snake_case(name):
    """LRStrategy -> lr_strategy, as Python's keyword is called."""
    return words_of(name).lower().replace(" ", "_")


def python_default(each):
    """A property's default as Python writes it; choices by name."""
    if each.choices:
        return each.choices[place_of(each.choices, each.default[0])].option
    if each.type == "bool":
        return each.default[0] == "true"
    if each.type == "string":
        return each.default[0]
    values = [{"double": float}.get(each.type, int)(word) for word in each.default]
    return values[0] if each.count == 1 else tuple(values)


def python_ports(proxy):
    """Of a proxy what the headers do not say: inputs, outputs, lists, objects, arrays to process."""
    inputs = []
    for child in proxy.iter("Input"):
        command = child.get("command", "SetInputConnection")
        named = re.fullmatch(r"Set(\w+)Connection", command)
        inputs.append((snake_case(child.get("name")), int(child.get("port_index", 0)) if command == "SetInputConnection" or not named
                       else command, child.get("multiple_input") == "1", child.get("types", SPLINE_TYPES).split()))
    outputs = [snake_case(name) for child in proxy.iter("Outputs") for name in child.get("names").split()]
    outputs += [child.get("name").lower().replace(" ", "_") for child in proxy.iter("OutputPort")]
    lists = [(snake_case(child.get("name")), child.get("command"), child.get("clean_command"),
              int(child.get("number_of_elements_per_command", 1)), " ".join("".join(child.itertext()).split()))
             for child in proxy if child.get("repeat_command") == "1"]
    objects = [(snake_case(child.get("name")), child.get("command")) for child in proxy.iter("ProxyProperty")]
    kinds = {child.get("name"): child.get("attribute_type") for child in proxy.iter("InputArrayDomain")}
    arrays = [(snake_case(child.get("name")), int(child.get("index")), kinds[child.get("arrays")], " ".join((child.text or "").split()))
              for child in proxy.iter("Array") if child.get("index")]
    return {"inputs": inputs, "outputs": outputs, "lists": lists, "objects": objects, "arrays": arrays}


MADE = re.compile(r"(<!-- (properties of (\w+)|jobs) -->\n)(.*?)(<!-- end -->)", re.S)
JOB = re.compile(r'JobRegistration Registration\{\s*"([^"]*)",\s*((?:"[^"]*"\s*)+),\s*((?:"[^"]*"\s*)+),')


def table(name, classes):
    yield "| property | default | range | meaning |"
    yield "| --- | --- | --- | --- |"
    while name in classes:
        for each in classes[name].properties:
            text = without_enumeration(each.text).rstrip(".").replace("|", "\\|")
            conditions = [f"with `{other}` {'not ' if inverse else ''}{', '.join(values)}"
                          for other, values, inverse in each.conditions]
            text += f" ({'; '.join(conditions)})" if conditions else ""
            yield f"| `{each.name}` | {each.default_words()} | {each.range_words()} | {text} |"
        name = classes[name].base


def jobs(root):
    """The table of the jobs of the command line, from their registrations."""
    found = {}
    for file in glob.glob(os.path.join(root, "Modules", "CommandLine", "*Job.cxx")):
        with open(file, encoding="utf-8") as stream:
            for name, *strings in JOB.findall(stream.read()):
                found[name] = ["".join(re.findall(r'"([^"]*)"', each)) for each in strings]
    yield "| job | what it does | example |"
    yield "| --- | --- | --- |"
    for name, (sentence, example) in sorted(found.items()):
        yield f"| `{name}` | {sentence} | `knotwork {name} {example}` |"


def made_table(found, root, classes):
    if found[3] and found[3] not in classes:
        raise Fault(f"no header of {found[3]}, whose properties a page wants")
    lines = table(found[3], classes) if found[3] else jobs(root)
    return found[1] + "\n".join(lines) + "\n" + found[5]


def check_list(root, classes):
    """Every class that can be made has its row in the README, and has its properties on a page if it has any."""
    with open(os.path.join(root, "README.md"), encoding="utf-8") as stream:
        rows = re.findall(r"`(vtk\w+)`", "".join(line for line in stream if line.startswith("|")))
    bases = {header.base for header in classes.values()}
    for name in classes.keys() - bases - set(rows):
        raise Fault(f"README.md: its table has no {name}")
    for name in set(rows) - classes.keys():
        raise Fault(f"README.md: its table has {name}, which is no class")


def pages(root, check):
    headers = read(sorted(glob.glob(os.path.join(root, "Modules", "*", "vtk*.h"))))
    classes = {header.name: header for header in headers}
    check_list(root, classes)
    listed = ""
    for file in glob.glob(os.path.join(root, "Modules", "*", "README.md")):
        with open(file, encoding="utf-8") as stream:
            text = stream.read()
        listed += text
        new = MADE.sub(lambda found: made_table(found, root, classes), text)
        if new != text and check:
            raise Fault(f"{file}: a table is not what headers and jobs say; `cmake --build . --target pages` rewrites it")
        if new != text:
            write(file, new.rstrip("\n").split("\n"))
    bases = {header.base for header in headers}
    for header in headers:
        # those of bases stand in the tables of the classes behind them
        if header.name not in bases and any(each.name not in ("FileName", "Threads") for each in header.properties):
            if f"<!-- properties of {header.name} -->" not in listed:
                raise Fault(f"{header.file}: no page has '<!-- properties of {header.name} -->'")


STRUCT = re.compile(r"^(?:template <[^>]*>\n)?struct (\w+Params)[^;{]*\{(.*?)^\};", re.M | re.S)
FIELD = re.compile(r"^  [\w:<>]+(?: \w+)? (\w+) = ([^;]+);", re.M)
CONSTANT = re.compile(r"^(?:inline )?constexpr \w+(?: \w+)? (\w+) = ([^;]+);", re.M)
HANDED = re.compile(r"\.(\w+) = (?:static_cast<[^>]*>\()?this->(\w+)\)?;")


def kernel_fields(root):
    """Defaults of the fields of the kernels' structs: (field, struct) -> words; constants are looked up."""
    fields, constants = {}, {}
    for file in glob.glob(os.path.join(root, "Modules", "*", "Kernel", "**", "*.h"), recursive=True):
        with open(file, encoding="utf-8") as stream:
            text = stream.read()
        constants.update(CONSTANT.findall(text))
        for struct, body in STRUCT.findall(text):
            fields.update({(field, struct): words for field, words in FIELD.findall(body)})
    return {key: constants.get(words, words) for key, words in fields.items()}


def says_default(each, words):
    """Whether a kernel's words are a property's default; enumerators by their name, label or initials."""
    if not each.choices:
        return (number(words) or words) == (number(each.default[0]) or each.default[0])
    name = words.split("::")[-1]
    choice = each.choices[place_of(each.choices, each.default[0])]
    wanted = {re.sub(r"\W|_", "", text).lower() for text in (choice.enumerator, choice.label, choice.option)}
    return bool({name.lower(), re.sub("[a-z]", "", name).lower()} & wanted)


def defaults(root):
    """What filters hand to kernels as it is: parameters that the filter names have the same default, or what the mark "Kernel default" says."""
    fields = kernel_fields(root)
    compared = 0
    for header in read(sorted(glob.glob(os.path.join(root, "Modules", "*", "vtk*.h")))):
        source = os.path.join(root, "Modules", header.module, header.name + ".cxx")
        if not os.path.exists(source):
            continue
        with open(source, encoding="utf-8") as stream:
            text = stream.read() + header.text
        for field, name in HANDED.findall(text):
            each = header.named().get(name)
            found = [words for (other, struct), words in fields.items()
                     if other == field and re.search(rf"\b{struct[:-len('Params')]}(Params)?\b", text)]
            if each is None or each.count > 1 or each.default == [""] or not found:
                continue
            compared += 1
            if not any(number(words) == each.kernel if each.kernel else says_default(each, words) for words in found):
                raise Fault(f"{each.where}: default is {each.default_words()}, of the kernel's {field} {' or '.join(found)}")
    print(f"{compared} defaults compared")


def write(file, lines):
    text = "\n".join(lines) + "\n"
    if os.path.exists(file):
        with open(file, encoding="utf-8") as stream:
            if stream.read() == text:  # whatever is made of it stays as it is
                return
    with open(file, "w", encoding="utf-8") as stream:
        stream.write(text)


def read(files):
    headers = []
    for file in files:
        header = Header(file)
        header.module = os.path.basename(os.path.dirname(os.path.abspath(file)))
        headers.append(header)
    return headers


def main(command, *arguments):
    try:
        if command == "print-self":
            print_self(arguments[0], read(arguments[1:]))
        elif command == "options":
            options(arguments[0], read(arguments[1:]))
        elif command == "proxies":
            proxies(arguments[0], arguments[1], read(arguments[2:]))
        elif command == "menus":
            menus(arguments[0], arguments[1:])
        elif command == "python":
            python(arguments[0], [each for each in arguments[1:] if each.endswith(".xml")],
                   read(each for each in arguments[1:] if not each.endswith(".xml")))
        elif command == "defaults":
            defaults(arguments[0])
        elif command == "pages":
            pages(arguments[-1], arguments[0] == "--check")
        else:
            raise Fault(f"no command {command}")
    except (Fault, OSError) as fault:
        return f"properties.py: {fault}"
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) > 1 else __doc__)
