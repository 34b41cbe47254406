# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package: their names, the filters behind them, and their parameters, from the tables of _properties.py. Needs
no VTK: the stubs are made with it, too."""
import inspect
import re

from ._properties import FILTERS, MEANINGS, PROPERTIES

# function: filter, parameters besides its inputs that may be given without their names
VERBS = {
    "align": ("vtkRigidAlignment", []),
    "approximate": ("vtkSplineVolumeFit", []),
    "boundary": ("vtkSplineBoundary", []),
    "cadfit": ("vtkCADFit", []),
    "cadmodify": ("vtkCADModifier", []),
    "combine": ("vtkSplineCombine", []),
    "compare": ("vtkVolumeComparison", []),
    "compare_solutions": ("vtkSplineVersusMesh", []),
    "contour": ("vtkSplineContour", ["levels"]),
    "control_net": ("vtkSplineControlNet", []),
    "crop": ("vtkSplineTrimToPoints", []),
    "curve_elements": ("vtkElementCurving", []),
    "datum": ("vtkDatumAlignment", []),
    "deviation": ("vtkDeviationMap", []),
    "distance": ("vtkSplinePointDistance", []),
    "evaluate": ("vtkSplineEvaluate", []),
    "extract": ("vtkSplineExtract", []),
    "extrema": ("vtkSplineExtrema", []),
    "features": ("vtkMeshFeatures", []),
    "fit": ("vtkSplineSurfaceFit", []),
    "flatten": ("vtkMeshParameterization", []),
    "hexes": ("vtkCADHexahedra", []),
    "intersections": ("vtkFaceIntersections", []),
    "map": ("vtkTemplateMapping", []),
    "parameterize": ("vtkDomainParameterization", []),
    "parametric_mesh": ("vtkSplineParametricMesh", []),
    "patches": ("vtkMeshPatches", []),
    "quadremesh": ("vtkQuadRemesher", []),
    "quads": ("vtkCADQuads", []),
    "recognize": ("vtkSurfaceRecognition", []),
    "refine": ("vtkSplineRefine", []),
    "remesh": ("vtkSurfaceRemesh", []),
    "repair": ("vtkSurfaceRepair", []),
    "solve": ("vtkSplineAnalysis", []),
    "source": ("vtkSplineSource", ["shape"]),
    "stitch": ("vtkSplineStitch", []),
    "sweep": ("vtkSweepToHexahedra", []),
    "tessellate": ("vtkSplineTessellate", []),
    "tetrahedralize": ("vtkTetGenMesher", []),
    "unstructured": ("vtkUnstructuredSpline", []),
    "validate": ("vtkJacobianValidator", []),
    "warp": ("vtkSplineWarp", []),
}
# outputs that a function returns where it is not the first one
RESULTS = {"vtkAnalyticModel": "surfaces", "vtkTrimmedSurface": "surfaces", "vtkSplineTrimToPoints": "surfaces"}


def snake_case(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def available(filter_name):
    """Whether this build has the filter."""
    return filter_name in FILTERS


def is_method(verb):
    """Whether data have the function as a method: its first parameter is data."""
    return parameters(verb)[0][3] == "input"


def properties(filter_name):
    """{keyword: (property, default, sentence)} of a filter and its bases."""
    found = {}
    for owner in (filter_name, "vtkSplineAlgorithm"):
        for name, (default, sentence) in MEANINGS.get(owner, {}).items():
            found[snake_case(name)] = (name, default, sentence)
    return found


def parameters(verb):
    """[(name, default, sentence, kind)] of a function: kind is file, input, list, object, array or property; no default: it must be given."""
    filter_name, _ = VERBS[verb]
    ports = FILTERS[filter_name]
    found = []
    own = properties(filter_name)
    if "file_name" in own:
        found.append(("file", inspect.Parameter.empty, own.pop("file_name")[2], "file"))
    for place, (name, _, many, _) in enumerate(ports["inputs"]):
        first = place == 0 and not found
        found.append((name, inspect.Parameter.empty if first else None, "Data, a file's name, an array of points" +
                      (", or a list of such." if many else "."), "input"))
    found += [(name, (), sentence, "list") for name, _, _, _, sentence in ports["lists"]]
    found += [(name, None, "A vtkImplicitFunction.", "object") for name, _ in ports["objects"]]
    found += [(name, None, sentence or "An array's name.", "array") for name, _, _, sentence in ports["arrays"]]
    found += [(name, default, sentence, "property") for name, (_, default, sentence) in own.items()]
    return found


def signature(verb):
    """As inspect shows it; inputs and a few others may be given by their places."""
    by_place = set(VERBS[verb][1])
    listed = sorted(parameters(verb), key=lambda each: each[3] not in ("file", "input") and each[0] not in by_place)
    kinds = {True: inspect.Parameter.POSITIONAL_OR_KEYWORD, False: inspect.Parameter.KEYWORD_ONLY}
    made = [inspect.Parameter(name, kinds[kind in ("file", "input") or name in by_place], default=default)
            for name, default, _, kind in listed]
    made.append(inspect.Parameter("progress", inspect.Parameter.KEYWORD_ONLY, default=None))
    return inspect.Signature(made)


def help_text(verb, summary):
    """The docstring: what the filter says of itself, then a line a parameter."""
    filter_name, _ = VERBS[verb]
    lines = [summary.strip(), "", f"Filter {filter_name}. Parameters:", ""]
    for name, default, sentence, kind in parameters(verb):
        declared = PROPERTIES.get(filter_name, {}).get(properties(filter_name).get(name, ("",))[0])
        limits = ""
        if declared:
            _, _, low, high, names = declared
            limits = (" One of " + ", ".join(option for option, _ in names) + "." if names else
                      f" At least {low}." if low is not None and high is None else f" {low} to {high}." if low is not None else "")
        shown = "" if default is inspect.Parameter.empty else f" = {default!r}"
        lines.append(f"{name}{shown}: {sentence}{limits}")
    outputs = FILTERS[filter_name]["outputs"]
    lines += ["progress = None: called with the share that is done, 0 to 1; the work stops where it returns False."]
    if len(outputs) > 1:
        lines += ["", f"Returns the output `{RESULTS.get(filter_name, outputs[0])}`; all of them are in its `outputs`: {', '.join(outputs)}."]
    return "\n".join(lines)
