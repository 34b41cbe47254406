# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package: a filter each, run at once. Functions that take data are methods of data, too."""
import difflib
import inspect
import os
import sys
import warnings

from vtkmodules.vtkCommonDataModel import vtkImplicitFunction
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer

from . import _properties, signatures
from . import data as _data
from .errors import Error
from .problems import Problem
from .running import run

ASSOCIATIONS = {"point": 0, "cell": 1}  # vtkDataObject::FIELD_ASSOCIATION_...


def _made(filter_name):
    """A new filter, of the classes whose setters check."""
    return getattr(sys.modules[__package__], filter_name)()


def _refuse_unknown(verb, names, known):
    for name in names:
        close = difflib.get_close_matches(name, known, 1)
        raise TypeError(f"{verb}() has no parameter {name!r}" + (f"; did you mean {close[0]!r}?" if close else f"; it has {', '.join(known)}"))


def _connect(algorithm, where, value, place, many, types):
    """place: a port, or the name of the method that takes a connection."""
    for each in (value if many and isinstance(value, (list, tuple)) else [value]):
        found = _data.as_data(each)
        if not any(found.IsA(name) for name in types):
            raise TypeError(f"{where} is of type {found.GetClassName()}; {' or '.join(types)} is wanted")
        producer = vtkTrivialProducer()
        producer.SetOutput(found)
        if isinstance(place, str):
            getattr(algorithm, place)(producer.GetOutputPort())
        elif many:
            algorithm.AddInputConnection(place, producer.GetOutputPort())
        else:
            algorithm.SetInputConnection(place, producer.GetOutputPort())


def _adjust(algorithm, filter_name, values):
    """Sets what is no input; values: {keyword: value}, left out ones None."""
    ports = _properties.FILTERS[filter_name]
    properties = signatures.properties(filter_name)
    for name, adds, clears, count, _ in ports["lists"]:
        getattr(algorithm, clears)()
        given = values.get(name) if values.get(name) is not None else ()
        if isinstance(given, str) or not hasattr(given, "__iter__"):
            raise TypeError(f"{name}: {given!r} is not a list")
        for each in given:
            getattr(algorithm, adds)(*(tuple(each) if count > 1 else (each,)))
    for name, sets in ports["objects"]:
        if values.get(name) is not None:
            if not isinstance(values[name], vtkImplicitFunction):
                raise TypeError(f"{name}: {values[name]!r} is not a vtkImplicitFunction")
            getattr(algorithm, sets)(values[name])
    for name, index, kind, _ in ports["arrays"]:
        if values.get(name) is not None:
            if not isinstance(values[name], str):
                raise TypeError(f"{name}: {values[name]!r} is not a string, the name of an array")
            algorithm.SetInputArrayToProcess(index, 0, 0, ASSOCIATIONS.get(kind, 2), values[name])
    for keyword, (name, default, _) in properties.items():
        value = values.get(keyword, default)
        if value is None or value is default:
            continue
        if isinstance(default, tuple) and (isinstance(value, str) or not hasattr(value, "__iter__")):
            raise TypeError(f"{keyword}: {value!r} is not a list of {len(default)}")
        getattr(algorithm, "Set" + name)(*(value if isinstance(default, tuple) else (value,)))


def _result(algorithm, filter_name):
    names = _properties.FILTERS[filter_name]["outputs"] or ["result"]
    outputs = {name: _data.wrap(algorithm.GetOutputDataObject(port)) for port, name in enumerate(names)
               if port < algorithm.GetNumberOfOutputPorts()}
    result = outputs[signatures.RESULTS.get(filter_name, names[0])]
    if isinstance(result, _data.Data):
        result.outputs = {name: each for name, each in outputs.items() if each is not result}
        result.curves = outputs.get("trimming_curves", outputs.get("curves")) if "surfaces" in outputs else None
    return result


def _apply(verb, arguments, keywords):
    filter_name, _ = signatures.VERBS[verb]
    signature = signatures.signature(verb)
    _refuse_unknown(verb, [name for name in keywords if name not in signature.parameters], list(signature.parameters))
    try:
        given = signature.bind(*arguments, **keywords).arguments
    except TypeError as fault:
        raise TypeError(f"{verb}{signature.replace(parameters=list(signature.parameters.values())[:4])}: {fault}") from None
    progress = given.pop("progress", None)
    problem = Problem(given.get("problem") or "")
    if problem.text:
        given["problem"] = problem.text
    algorithm = _made(filter_name)
    if "file" in given:
        algorithm.SetFileName(os.fspath(given.pop("file")))
    for name, place, many, types in _properties.FILTERS[filter_name]["inputs"]:
        required = signature.parameters[name].default is inspect.Parameter.empty
        value = given.pop(name, None)
        if required or value is not None:
            _connect(algorithm, f"{verb}(): {name}", value, place, many, types)
    _adjust(algorithm, filter_name, given)
    problem.attach(algorithm)
    try:
        run(algorithm, progress)
    finally:
        problem.raise_failure()
    return _result(algorithm, filter_name)


def _make(verb, summary):
    def function(*arguments, **keywords):
        return _apply(verb, arguments, keywords)

    function.__name__ = function.__qualname__ = verb
    function.__module__ = "knotwork"
    function.__signature__ = signatures.signature(verb)
    function.__doc__ = signatures.help_text(verb, summary)
    return function


def trim(input, *, features=True, flatten_method=None, maximum_stretch=3.0, progress=None, **properties):
    """Turns a triangle mesh into trimmed spline faces, with planes, cylinders, spheres, cones and tori as such where the mesh has
    them: knotwork.trim("scan.stl").save("scan.step").

    features: False makes splines alone. Others: those of vtkTrimmedSurface (tolerance, degree, ...; help(knotwork.vtkTrimmedSurface)).
    flatten_method: how the mesh is laid into the plane (laplacian, isomap, ...). maximum_stretch: charts that a single map would
    stretch more are cut. Returns the surfaces; `curves` trim them, `outputs` has the triangles and numbers. Raises knotwork.Error."""
    known = signatures.properties("vtkTrimmedSurface")
    _refuse_unknown("trim", [name for name in properties if name not in known], ["input", "features", "flatten_method", "maximum_stretch",
                                                                                 "progress", *known])
    mesh = _data.as_data(input)
    trimmer = _made("vtkTrimmedSurface")
    _adjust(trimmer, "vtkTrimmedSurface", properties)
    has_plane = hasattr(mesh, "GetPointData") and mesh.GetPointData().GetArray("UV") is not None
    if features and not has_plane:
        model = _made("vtkAnalyticModel")
        model.SetMaximumStretch(maximum_stretch)
        for name in ("Tolerance", "CornerAngle", "ChordalTolerance", "Effort", "TimeLimit", "Threads"):
            getattr(model, "Set" + name)(getattr(trimmer, "Get" + name)())
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # a model with a warning is none: splines are tried, as the job does
                model.SetInputDataObject(mesh)
                run(model, progress)
            return _result(model, "vtkAnalyticModel")
        except (Error, Warning) as reason:
            if isinstance(reason, Error) and reason.code == "Aborted":
                raise
    if not has_plane:
        flatten = _made("vtkMeshParameterization")
        flatten.SetMaximumStretch(maximum_stretch)
        if flatten_method is not None:
            flatten.SetMethod(flatten_method)
        flatten.SetThreads(trimmer.GetThreads())
        flatten.SetInputDataObject(mesh)
        run(flatten, progress)
        mesh = flatten.GetOutputDataObject(0)
    trimmer.SetInputDataObject(mesh)
    run(trimmer, progress)
    return _result(trimmer, "vtkTrimmedSurface")


def _as_method(function):
    def method(self, *arguments, **keywords):
        return function(self, *arguments, **keywords)

    method.__name__ = function.__name__
    method.__doc__ = function.__doc__
    return method


def make_functions(namespace):
    """Adds the functions to the package, and to data as methods."""
    made = {}
    for verb, (filter_name, _) in signatures.VERBS.items():
        if signatures.available(filter_name) and filter_name in namespace:
            made[verb] = _make(verb, _summary(namespace[filter_name]))
    made["trim"] = trim
    for verb, function in made.items():
        if verb == "trim" or signatures.is_method(verb):
            setattr(_data.Data, verb, _as_method(function))
    namespace.update(made)


def _summary(filter_class):
    """The filter's own words without VTK's heading."""
    text = " ".join((filter_class.__doc__ or "").split())
    _, _, words = text.partition(" - ")
    return words or text
