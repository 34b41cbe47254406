# SPDX-License-Identifier: BSD-3-Clause
"""The package imports, offers the classes of every module, and each can be made and says what it is."""
import importlib
import sys

import knotwork
import knotwork_testing


def classes():
    return {name: item for name, item in vars(knotwork).items()
            if name.startswith("vtk") and isinstance(item, type)}


def test_every_module_is_offered():
    assert len(sys.argv) > 1
    for extension in sys.argv[1:]:
        module = importlib.import_module("knotwork." + extension)
        names = [name for name in vars(module) if name.startswith("vtk") and isinstance(getattr(module, name), type)]
        assert names, f"{extension} has no class"
        for name in names:
            assert issubclass(getattr(knotwork, name), getattr(module, name)), name


def test_classes_can_be_made_and_have_help():
    from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

    algorithms = [item for item in classes().values() if issubclass(item, vtkAlgorithm)]
    assert algorithms
    for item in algorithms:
        try:
            made = item()
        except TypeError:
            continue  # an abstract class
        assert made.GetClassName() == item.__name__
        assert len(item.__doc__.split()) > 5, f"{item.__name__} has no help: {item.__doc__}"


def refused(error, setter, *values):
    try:
        setter(*values)
    except error as fault:
        return str(fault)
    raise AssertionError(f"{setter.__name__}{values} raised no {error.__name__}")


def test_setters_refuse_what_is_out_of_range_or_of_another_type():
    fit = knotwork.vtkSplineSurfaceFit()
    assert "10 is not in 1 to 9" in refused(ValueError, fit.SetDegree, 10)
    assert "at least 0" in refused(ValueError, fit.SetTolerance, -1e-9)
    assert "none of least-squares, mba, combined" in refused(ValueError, fit.SetMethod, "mbb")
    assert "2 combined" in refused(ValueError, fit.SetMethod, 3)
    refused(TypeError, fit.SetDegree, 2.5)
    refused(TypeError, fit.SetDegree, "2")
    refused(TypeError, fit.SetTolerance, "0.1")
    refused(TypeError, fit.SetFindOutliers, "off")
    refused(TypeError, fit.SetFindOutliers, 2)
    refused(TypeError, fit.SetDomain, 0.0, 1.0, 0.0)
    refused(TypeError, fit.SetDomain, (0.0, 1.0, 0.0, "1"))
    refused(ValueError, fit.SetThreads, 1025)  # of the base class
    refused(TypeError, knotwork.vtkSplineContour().SetFieldName, 3)
    assert (fit.GetDegree(), fit.GetTolerance(), fit.GetMethod(), fit.GetDomain()) == (2, 0.0, 0, (0.0, 0.0, 0.0, 0.0))


def test_setters_take_what_is_in_range_as_before():
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetDegree(True + 2)
    fit.SetTolerance(1)
    fit.SetFindOutliers(1)
    fit.SetDomain((0, 1, 0, 2))
    fit.SetMethod("MBA")
    fit.SetSide("ABOVE")
    fit.SetStrategy("minimum-span")
    fit.SetSpace(fit.THB)
    assert (fit.GetDegree(), fit.GetTolerance(), fit.GetFindOutliers(), fit.GetDomain()) == (3, 1.0, True, (0.0, 1.0, 0.0, 2.0))
    assert (fit.GetMethod(), fit.GetSide(), fit.GetStrategy(), fit.GetSpace()) == (fit.MBA, fit.ABOVE, fit.MINIMUM_SPAN, fit.THB)
    fit.SetTolerance(float("nan"))  # for the filter to refuse, with its reason


def test_setters_of_every_class_refuse():
    count = 0
    for name, properties in knotwork._properties.PROPERTIES.items():
        made = None
        try:
            made = getattr(knotwork, name)()
        except TypeError:
            continue  # an abstract class
        for each, (kind, number, low, high, names) in properties.items():
            setter, before = getattr(made, "Set" + each), getattr(made, "Get" + each)()
            refused(TypeError, setter, *([object()] * number))
            beyond = [-1, len(names)] if names else [low - 1 if low is not None else None, 2 * high + 1 if high is not None else None]
            for value in (value for value in beyond if value is not None):
                refused(ValueError, setter, *([value] * number))
                count += 1
            assert getattr(made, "Get" + each)() == before, each
    assert count > 200, count


def test_version():
    assert knotwork.__version__.count(".") == 2


knotwork_testing.main(globals())
