# SPDX-License-Identifier: BSD-3-Clause
"""Windows and pictures of data."""
import ctypes
import os
import tempfile

from vtkmodules.vtkCommonColor import vtkNamedColors
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataSet

from . import vtkPictureWriter
from .errors import Error
from .running import run

BEZIER = {75, 77, 79}  # VTK_BEZIER_CURVE, VTK_BEZIER_QUADRILATERAL, VTK_BEZIER_HEXAHEDRON


def _leaves(data):
    if isinstance(data, vtkDataSet):
        return [data]
    if isinstance(data, vtkCompositeDataSet):
        iterator = data.NewIterator()
        found = []
        iterator.InitTraversal()
        while not iterator.IsDoneWithTraversal():
            found.append(iterator.GetCurrentDataObject())
            iterator.GoToNextItem()
        return found
    raise TypeError(f"{data.GetClassName()} has no picture; ask for its columns")


def _drawn(data, tolerance):
    """What VTK draws faithfully: splines tessellated."""
    from . import tessellate

    if data.GetNumberOfCells() and data.GetCellType(0) in BEZIER:
        return tessellate(data, chordal_tolerance=tolerance * max(data.GetLength(), 1e-300))
    return data


def _check_display(window):
    """VTK ends the process where X11 cannot be reached."""
    if window.GetClassName() == "vtkXOpenGLRenderWindow":
        library = ctypes.CDLL("libX11.so.6")
        library.XOpenDisplay.restype = ctypes.c_void_p
        display = library.XOpenDisplay(None)
        if not display:
            raise Error("LibraryError", f"there is no X display {os.environ.get('DISPLAY', '')!r} to draw with; start the program in a desktop, "
                        "or with xvfb-run")
        library.XCloseDisplay(ctypes.c_void_p(display))


def _window(data, scalars, color, edges, background, size, tolerance):
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkRenderingCore import vtkActor, vtkDataSetMapper, vtkRenderer, vtkRenderWindow

    window = vtkRenderWindow()
    _check_display(window)
    colors = vtkNamedColors()
    renderer = vtkRenderer()
    renderer.SetBackground(colors.GetColor3d(background))
    for leaf in _leaves(data):
        drawn = _drawn(leaf, tolerance)
        mapper = vtkDataSetMapper()
        mapper.SetInputDataObject(drawn)
        _choose_scalars(mapper, drawn, scalars)
        actor = vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(colors.GetColor3d(color))
        actor.GetProperty().SetEdgeVisibility(edges)
        actor.GetProperty().SetPointSize(3)
        if drawn.GetNumberOfCells() == 0:
            actor.GetProperty().SetRepresentationToPoints()
        renderer.AddActor(actor)
    window.SetSize(*size)
    window.SetMultiSamples(8)
    window.SetWindowName("Knotwork")
    window.AddRenderer(renderer)
    _look(renderer)
    return window


def _choose_scalars(mapper, drawn, name):
    if name is None:
        mapper.ScalarVisibilityOff()
        return
    for attributes, by_cells in ((drawn.GetPointData(), False), (drawn.GetCellData(), True)):
        array = attributes.GetArray(name)
        if array is not None:
            mapper.SetScalarModeToUseCellFieldData() if by_cells else mapper.SetScalarModeToUsePointFieldData()
            mapper.SelectColorArray(name)
            mapper.SetScalarRange(array.GetRange())
            return
    raise ValueError(f"there is no array {name!r} on points or cells")


def _look(renderer):
    """From above the plane of flat data, from a corner with z upwards else."""
    bounds = renderer.ComputeVisiblePropBounds()
    sizes = [bounds[2 * d + 1] - bounds[2 * d] for d in range(3)]
    camera = renderer.GetActiveCamera()
    if sizes[2] > 1e-9 * max(sizes):
        camera.SetFocalPoint(0, 0, 0)
        camera.SetPosition(-0.6, -1.0, 0.7)
        camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera()


def picture(data, *, scalars=None, color="cornflower", edges=False, background="white", size=(800, 600), tolerance=5e-4):
    """The bytes of a PNG picture, drawn off-screen, without a display. Options as those of plot."""
    if scalars is not None and not any(attributes.HasArray(scalars) for leaf in _leaves(data)
                                       for attributes in (leaf.GetPointData(), leaf.GetCellData())):
        raise ValueError(f"there is no array {scalars!r} on points or cells")
    with tempfile.TemporaryDirectory() as folder:
        writer = vtkPictureWriter()
        writer.SetFileName(os.path.join(folder, "picture.png"))
        writer.SetInputDataObject(data)
        writer.SetArray(scalars or "")
        writer.SetColor(color)
        writer.SetEdges(vtkPictureWriter.CELLS if edges else vtkPictureWriter.NONE)
        writer.SetBackground(background)
        writer.SetSize(*size)
        writer.SetChordalTolerance(tolerance)
        run(writer)
        with open(writer.GetFileName(), "rb") as stream:
            return stream.read()


def plot(data, *, file=None, scalars=None, color="cornflower", edges=False, background="white", size=(800, 600), tolerance=5e-4):
    """Shows data in a window until it is closed, or writes a picture.

    file: name of a .png that is written off-screen instead. scalars: name of a point or cell array to colour by.
    color, background: names of colours. edges: whether edges of cells are drawn. size: width and height in pixels.
    tolerance: of the drawn splines, a share of their size."""
    if file is not None:
        content = picture(data, scalars=scalars, color=color, edges=edges, background=background, size=size, tolerance=tolerance)
        with open(os.fspath(file), "wb") as stream:
            stream.write(content)
        return
    import vtkmodules.vtkInteractionStyle  # noqa: F401
    from vtkmodules.vtkRenderingCore import vtkRenderWindowInteractor

    window = _window(data, scalars, color, edges, background, size, tolerance)
    interactor = vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    window.Render()
    interactor.Start()
