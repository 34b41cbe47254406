# SPDX-License-Identifier: BSD-3-Clause
"""Files by the endings of their names."""
import os
import warnings

from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from . import data as _data
from . import vtkDataFile
from .errors import make_error


def _outcome(exchange, good):
    """Raises what went wrong, warns of the rest."""
    if not good:
        raise make_error(exchange.GetErrorCode(), exchange.GetErrorText())
    for number in range(exchange.GetNumberOfWarnings()):
        warnings.warn(exchange.GetWarning(number), stacklevel=3)
    for number in range(exchange.GetNumberOfPartsLeftOut()):
        warnings.warn("left out: " + exchange.GetPartLeftOut(number), stacklevel=3)


def read(file, with_curves=False):
    """The data of a file: a spline grid (vtkUnstructuredGrid, or a vtkPartitionedDataSetCollection of them), or vtkPolyData of a
    mesh or of points. The ending of its name says the format: .vtu .vtp .vtpc .vtk .xml .g2 .bext .mesh .msh .inp .step .stp .iges .igs .brep .off
    .obj .ply .stl .las .tif .xyz .txt .csv .json.

    with_curves: a pair of the data and of the curves that trim (STEP, IGES) or bound (g2) its surfaces, None without any.

    The data have the functions of this package as methods. Raises knotwork.FileError (an OSError) where the file cannot be read,
    knotwork.Error (a ValueError) where it is damaged, empty, or of an unknown format; warns of parts that were left out."""
    exchange = vtkDataFile()
    found = exchange.Read(os.fspath(file))
    _outcome(exchange, found is not None)
    result, curves = _data.wrap(found), _data.wrap(exchange.GetCurves())
    if isinstance(result, _data.Data):
        result.curves = curves
    return (result, curves) if with_curves else result


def write(data, file, curves=None, encoding="binary"):
    """Writes data, or the first output of a filter, in the format that the ending of the name says; a file of that name is replaced
    when all has been written.

    curves: what trims the faces of STEP and IGES, or bounds the surfaces of g2; as read(..., with_curves=True) gives them.
    encoding: of numbers in VTK's formats, "ascii", "binary" or "appended".

    Raises knotwork.FileError (an OSError) where the file cannot be written, knotwork.Error (a ValueError) where the format does not
    hold such data."""
    if isinstance(data, vtkAlgorithm):
        data = _data.as_data(data)
    exchange = vtkDataFile()
    exchange.SetCurves(curves)
    exchange.SetEncoding(encoding)
    _outcome(exchange, exchange.Write(data, os.fspath(file)))
