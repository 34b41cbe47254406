# SPDX-License-Identifier: BSD-3-Clause
"""usage: check_paraview_xml.py FILE.xml...

Holds each proxy of ParaView's XML against the filter that it shows: the class and every command exist, defaults are those
of a newly constructed filter, ranges are those that it clamps to and no longer than ten digits, every choice of a list is accepted, numbers of a
list have labels, what hides a property is a property with that value, every
proxy and property has help of its own. Then breaks a copy of each
proxy in one place after the other and insists on noticing.
"""
import copy
import re
import sys
import xml.etree.ElementTree as ElementTree

import knotwork

VECTORS = ("IntVectorProperty", "DoubleVectorProperty", "IdTypeVectorProperty", "StringVectorProperty")
PROPERTIES = VECTORS + ("InputProperty", "ProxyProperty")
VAGUE = re.compile(r"\b(t[o]do|tbd|fix[m]e|xxx|place[h]older|lorem|st[u]b|no help|description here|to be written)\b", re.I)


def help_problems(element, name):
    documentation = element.find("Documentation")
    text = " ".join((documentation.text or "").split()) if documentation is not None else ""
    if len(text) < 15 or len(text.split()) < 3:
        yield f"{name}: no help: '{text}'"
    elif VAGUE.search(text):
        yield f"{name}: vague help: '{text}'"
    if element.tag in ("SourceProxy", "WriterProxy") and documentation is not None:
        short = documentation.get("short_help", "")
        if len(short) < 10 or VAGUE.search(short):
            yield f"{name}: no short_help"


def as_list(value):
    return list(value) if isinstance(value, (tuple, list)) else [value]


def expected_defaults(element):
    words = element.get("default_values")
    if words is None:
        return None
    if element.tag == "StringVectorProperty":
        return ["" if words in ("none", "None") else words]
    return [float(word) for word in words.split()]


def current_values(instance, command, element):
    """What Get... returns for Set..., as a list; None where there is no such method."""
    getter = getattr(instance, "Get" + command[len("Set"):], None)
    if getter is None:
        return None
    values = as_list(getter())
    if element.tag == "StringVectorProperty":
        return ["" if value is None else str(value) for value in values]
    return [float(value) for value in values]


def list_problems(element, name):
    count = element.get("number_of_elements_per_command" if element.get("repeat_command") == "1" else "number_of_elements", "1")
    labels = element.findall("Hints/ShowComponentLabels/ComponentLabel")
    if (element.get("repeat_command") == "1" and element.find("ArrayListDomain") is None) or labels:
        if [label.get("component") for label in labels] != [str(i) for i in range(int(count))]:
            yield f"{name}: {len(labels)} labels of {count} numbers"
    for domain in element:
        for bound in (domain.get("min"), domain.get("max")):
            if bound and max(map(len, bound.split())) > 13:
                yield f"{name}: a bound of many digits: {bound}"


def decorator_problems(proxy):
    choices = {each.get("name"): [entry.get("value") for entry in each.iter("Entry")] or (["0", "1"] if each.find("BooleanDomain") is not None else [])
               for each in proxy if each.tag in VECTORS}
    for decorator in proxy.iter("PropertyWidgetDecorator"):
        other = decorator.get("property")
        if other is None:
            continue
        values = (decorator.get("value") or decorator.get("values", "")).split()
        if other not in choices:
            yield f"{proxy.get('name')}: hides by {other}, which is no property"
        elif not values or not (set(values) <= set(choices[other]) if choices[other] else all(map(str.isdecimal, values))):
            yield f"{proxy.get('name')}: hides by {other} {values}, which it cannot be"


def property_problems(element, instance, where):
    command = element.get("command")
    name = f"{where}.{element.get('name')}"
    yield from list_problems(element, name)
    if element.get("information_only") == "1":
        if command and not hasattr(instance, command):
            yield f"{name}: {instance.GetClassName()} has no {command}"
        return
    yield from help_problems(element, name)
    if not command:
        yield f"{name}: no command"
        return
    if not hasattr(instance, command):
        yield f"{name}: {instance.GetClassName()} has no {command}"
        return
    if element.tag not in VECTORS or command == "SetInputArrayToProcess" or element.get("repeat_command") == "1":
        return
    if not command.startswith("Set"):
        return

    defaults = expected_defaults(element)
    values = current_values(instance, command, element)
    if values is None:
        yield f"{name}: nothing to compare with: {instance.GetClassName()} has no Get{command[3:]}"
        return
    if defaults is None:
        yield f"{name}: no default_values"
    elif defaults != values:
        yield f"{name}: default is {defaults} here and {values} in {instance.GetClassName()}"
    count = element.get("number_of_elements")
    if count is not None and int(count) != len(values):
        yield f"{name}: {count} elements here and {len(values)} in {instance.GetClassName()}"

    low = getattr(instance, "Get" + command[3:] + "MinValue", None)
    high = getattr(instance, "Get" + command[3:] + "MaxValue", None)
    domains = [domain for tag in ("IntRangeDomain", "DoubleRangeDomain") for domain in element.findall(tag)]
    choices = element.find("EnumerationDomain")
    boolean = element.find("BooleanDomain")
    if low and not domains and choices is None and boolean is None:
        yield f"{name}: {instance.GetClassName()} clamps to [{low()}, {high()}], but there is no range here"
    for domain in domains:
        for key, bound, unbounded in (("min", low, -1e9), ("max", high, 1e9)):
            words = domain.get(key)
            if bound is None:
                # No clamp to compare with: the filter must at least take the bound itself.
                if words is not None and len(values) == 1:
                    value = float(words)
                    getattr(instance, command)(int(value) if element.tag == "IntVectorProperty" else value)
                    if current_values(instance, command, element) != [value]:
                        yield f"{name}: {key} is {words} here, which {instance.GetClassName()} does not take"
                    restore(instance, command, element, values)
                continue
            limit = float(bound())
            if words is None:
                if abs(limit) < abs(unbounded):
                    yield f"{name}: no {key} here and {limit} in {instance.GetClassName()}"
            elif {float(word) for word in words.split()} != {limit}:
                yield f"{name}: {key} is {words} here and {limit} in {instance.GetClassName()}"
    if choices is not None:
        for entry in choices.findall("Entry"):
            getattr(instance, command)(int(entry.get("value")))
            if current_values(instance, command, element) != [float(entry.get("value"))]:
                yield f"{name}: {instance.GetClassName()} does not take the choice {entry.get('text')}"
        restore(instance, command, element, values)
        if low and high:
            numbers = {int(entry.get("value")) for entry in choices.findall("Entry")}
            wanted = set(range(int(low()), int(high()) + 1))
            if numbers != wanted:
                yield f"{name}: choices are {sorted(numbers)} here and {sorted(wanted)} in {instance.GetClassName()}"


def restore(instance, command, element, values):
    typed = [int(value) for value in values] if element.tag in ("IntVectorProperty", "IdTypeVectorProperty") else values
    getattr(instance, command)(*typed)


def proxy_problems(proxy):
    name = proxy.get("name")
    factory = getattr(knotwork, proxy.get("class", ""), None)
    if factory is None:
        yield f"{name}: knotwork has no class {proxy.get('class')}"
        return
    instance = factory()
    yield from help_problems(proxy, name)
    yield from decorator_problems(proxy)
    for element in proxy.iter():
        if element.tag in PROPERTIES:
            yield from property_problems(element, instance, name)


def broken_copies(proxy):
    """Copies of the proxy with one fault each, and what the fault is."""
    def change(describe, match, alter):
        for index, element in enumerate(proxy.iter()):
            if match(element):
                broken = copy.deepcopy(proxy)
                alter(list(broken.iter())[index])
                yield f"{describe} of {element.get('name') or element.tag}", broken

    def compared(element):
        return (element.tag in VECTORS and element.get("default_values") and element.get("command", "").startswith("Set")
                and element.get("command") != "SetInputArrayToProcess" and element.get("repeat_command") != "1"
                and element.get("information_only") != "1")

    def numeric(element):
        return compared(element) and element.tag != "StringVectorProperty"

    def shift_default(element):
        words = element.get("default_values").split()
        words[-1] = str(float(words[-1]) + abs(float(words[-1])) + 1)
        element.set("default_values", " ".join(words))

    yield from change("default", numeric, shift_default)
    yield from change("default", lambda e: compared(e) and e.tag == "StringVectorProperty",
                      lambda e: e.set("default_values", e.get("default_values") + "x"))
    yield from change("help", lambda e: e.tag == "Documentation", lambda e: setattr(e, "text", "Set the value."[:3]))
    yield from change("help", lambda e: e.tag == "Documentation",
                      lambda e: setattr(e, "text", "Lorem ipsum dolor sit amet."))
    yield from change("command", lambda e: e.tag in PROPERTIES and e.get("command"),
                      lambda e: e.set("command", e.get("command") + "NoSuchMethod"))
    yield from change("class", lambda e: e.tag in ("SourceProxy", "WriterProxy"), lambda e: e.set("class", "vtkNoSuchClass"))
    yield from change("label", lambda e: e.tag == "ShowComponentLabels", lambda e: e.remove(e[-1]))
    yield from change("bound", lambda e: e.tag in ("IntRangeDomain", "DoubleRangeDomain") and e.get("min"),
                      lambda e: e.set("max", "1" + 300 * "0"))
    yield from change("condition", lambda e: e.tag == "PropertyWidgetDecorator" and e.get("property"),
                      lambda e: e.set("property", "NoSuchProperty"))
    yield from change("condition", lambda e: e.tag == "PropertyWidgetDecorator" and e.get("value"), lambda e: e.set("value", "-77"))


def check(path):
    root = ElementTree.parse(path).getroot()
    proxies = root.findall(".//SourceProxy") + root.findall(".//WriterProxy")
    if not proxies:
        yield f"{path}: no proxy"
    noticed = 0
    for proxy in proxies:
        problems = list(proxy_problems(proxy))
        yield from problems
        if problems:
            continue
        for fault, broken in broken_copies(proxy):
            if not list(proxy_problems(broken)):
                yield f"{proxy.get('name')}: this check did not notice a wrong {fault}"
            noticed += 1
    print(f"{path}: {len(proxies)} proxies, {noticed} faults planted")


def main(paths):
    problems = [problem for path in paths for problem in check(path)]
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems or not paths else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
