# SPDX-License-Identifier: BSD-3-Clause
"""Problems of `solve` and `compare_solutions` as dictionaries, in which functions of Python may stand where expressions may."""
import inspect
import json

from . import _update


class Function:
    """A function of x, y, z, or of x, y, z, nx, ny, nz, as a filter calls it: with six numbers, for three. What it raises is kept."""

    def __init__(self, place, function):
        self.place = place
        self.function = function
        self.count = self._count_parameters()
        self.failure = None
        self.last = None  # of a list's components each asks on its own

    def _count_parameters(self):
        try:
            parameters = inspect.signature(self.function).parameters.values()
        except ValueError:  # one in C that does not tell
            return 3
        if any(each.kind is each.VAR_POSITIONAL for each in parameters):
            return 6
        by_place = [each for each in parameters if each.kind in (each.POSITIONAL_ONLY, each.POSITIONAL_OR_KEYWORD)]
        needed = sum(each.default is each.empty for each in by_place)
        for count in (6, 3):
            if needed <= count <= len(by_place):
                return count
        raise TypeError(f"{self.place}: {self.function!r} takes neither x, y, z nor x, y, z, nx, ny, nz")

    def __call__(self, *position):
        if self.failure:
            return (float("nan"),) * 3
        if self.last is None or self.last[0] != position:
            try:
                self.last = position, self._values(self.function(*position[:self.count]))
            except BaseException as failure:  # a filter knows no exceptions; it is raised when the filter has ended
                self.failure = failure
                return (float("nan"),) * 3
        return self.last[1]

    def _values(self, returned):
        if hasattr(returned, "__len__") and not isinstance(returned, (str, bytes)):
            values = [float(each) for each in returned]
        else:
            values = [float(returned)]
        if not 1 <= len(values) <= 3:
            raise TypeError(f"{self.place}: the function returns {len(values)} numbers; it may return up to 3")
        return (*values, *(float("nan"),) * (3 - len(values)))


class Problem:
    """The text of a problem, and its functions by name."""

    def __init__(self, given):
        self.functions = {}
        try:
            self.text = given if isinstance(given, str) else json.dumps(self._without_functions(given, "problem"))
        except ValueError as fault:  # a dictionary in itself
            raise ValueError(f"problem: {fault}") from None

    def _without_functions(self, part, place):
        if isinstance(part, dict):
            return {str(key): self._without_functions(each, f"{place}[{key!r}]") for key, each in part.items()}
        if isinstance(part, (list, tuple)):
            return [self._without_functions(each, f"{place}[{index}]") for index, each in enumerate(part)]
        if callable(part):
            name = f"function{len(self.functions)}"
            self.functions[name] = Function(place, part)
            return "@" + name
        if hasattr(part, "tolist"):  # a number or an array of numpy
            return self._without_functions(part.tolist(), place)
        if part is not None and not isinstance(part, (str, bool, int, float)):
            raise TypeError(f"{place}: {part!r} is no number, text, list, dictionary or function")
        return part

    def attach(self, algorithm):
        for name, function in self.functions.items():
            _update.set_function(algorithm, name, function)

    def raise_failure(self):
        """What a function raised while the filter ran."""
        for function in self.functions.values():
            if function.failure:
                raise function.failure from None
