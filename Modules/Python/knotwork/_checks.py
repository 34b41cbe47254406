# SPDX-License-Identifier: BSD-3-Clause
"""Setters that refuse what VTK's would clamp, truncate or take for something else: a value out of range and a name that is none raise
ValueError, a value of another type raises TypeError. What they accept is what the headers say (_properties.py is generated from them).
Choices are numbers, as in VTK, or names: SetMethod(fit.MBA), SetMethod("mba")."""
import operator

from ._properties import PROPERTIES


def _number(where, value, kind, low, high):
    convert = float if kind == "double" else operator.index
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        number = convert(value)
    except (TypeError, ValueError):
        raise TypeError(f"{where}: {value!r} is no {'number' if kind == 'double' else 'whole number'}") from None
    if (low is not None and number < low) or (high is not None and number > high):
        bounds = f"at least {low}" if high is None else f"in {low} to {high}"
        raise ValueError(f"{where}: {value!r} is not {bounds}")
    return number


def _choice(where, value, names):
    if isinstance(value, str):
        word = value.lower()
        for place, both in enumerate(names):
            if word in (name.lower() for name in both):
                return place
        raise ValueError(f"{where}: {value!r} is none of {', '.join(name for name, _ in names)}")
    place = _number(where, value, "int", None, None)
    if not 0 <= place < len(names):
        listed = ", ".join(f"{i} {name}" for i, (name, _) in enumerate(names))
        raise ValueError(f"{where}: {value!r} is none of {listed}")
    return place


def _truth(where, value):
    try:
        if operator.index(bool(value)) == value and not isinstance(value, (str, bytes)):
            return bool(value)
    except ValueError:
        pass  # an array has no truth value
    raise TypeError(f"{where}: {value!r} is neither True nor False")


def _checked(where, value, kind, low, high, names):
    if names:
        return _choice(where, value, names)
    if kind == "bool":
        return _truth(where, value)
    if kind == "string":
        if value is not None and not isinstance(value, str) and not hasattr(value, "__fspath__"):
            raise TypeError(f"{where}: {value!r} is no text")
        return value
    return _number(where, value, kind, low, high)


def _setter(base, name, kind, count, low, high, names):
    original = getattr(base, "Set" + name)
    where = f"{base.__name__}.Set{name}"

    def set_property(self, *values):
        if count > 1 and len(values) == 1:
            values = tuple(values[0])
        if len(values) != count:
            raise TypeError(f"{where}: takes {count} value{'s' if count > 1 else ''}, not {len(values)}")
        original(self, *(_checked(where, value, kind, low, high, names) for value in values))

    set_property.__name__ = "Set" + name
    set_property.__doc__ = original.__doc__
    return set_property


def checked(base):
    """The class with setters that check."""
    members = {"__doc__": base.__doc__, "__module__": "knotwork"}
    for parent in reversed(base.__mro__):
        for name, declared in PROPERTIES.get(parent.__name__, {}).items():
            members["Set" + name] = _setter(base, name, *declared)
    return type(base.__name__, (base,), members)


def check_all(namespace):
    """Replaces the classes that can be made; those that others derive from stay what they are."""
    classes = {name: item for name, item in namespace.items() if name in PROPERTIES}
    bases = {parent.__name__ for item in classes.values() for parent in item.__mro__[1:]}
    namespace.update({name: checked(item) for name, item in classes.items() if name not in bases})
