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
            assert getattr(knotwork, name) is getattr(module, name), name


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


def test_version():
    assert knotwork.__version__.count(".") == 2


knotwork_testing.main(globals())
