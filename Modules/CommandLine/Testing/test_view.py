# SPDX-License-Identifier: BSD-3-Clause
"""Pictures by the job `view`: without a display, of everything that is read; what is drawn is where it should be."""
import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

import job_inputs
import knotwork_testing
from refusals import good, path, refuse

SIZE = (160, 120)


def drawn(file, *options, size=SIZE):
    """The picture of a file: rows from below, pixels, red, green and blue."""
    name = path("picture.png")
    good("view", file, "--size", *size, "--output", name, *options)
    reader = vtkPNGReader()
    reader.SetFileName(name)
    reader.Update()
    image = reader.GetOutput()
    assert image.GetDimensions()[:2] == size, image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(size[1], size[0], -1)[:, :, :3].astype(int)


def near(pixels, colour, most=12):
    return np.abs(pixels - np.array(colour)).max(axis=-1) <= most


def share(file, *options):
    """Share of the pixels that are not white."""
    return np.mean(~near(drawn(file, *options), (255, 255, 255), 3))


def test_everything_that_is_read_is_drawn_PropertyOracle():
    job_inputs.make_files()
    good("convert", path("square.vtu"), "--output", path("parts.vtpc"))
    for name in ("square.vtu", "parts.vtpc", "square.g2", "square.step", "solid.step", "mesh.off", "mesh.stl", "quads.vtu", "quads.obj",
                 "cloud.xyz", "cloud.ply", "target.vtp", "boundary.json", "cube.vtu"):
        assert share(path(name)) > 0.01, name


def test_square_lies_where_the_camera_puts_it_ExactOracle():
    good("source", "--elements", 2, 2, 1, "--output", path("two.vtu"))
    picture = drawn(path("two.vtu"), "--color", "#3366cc", "--background", "#ffeedd", "--edges", "none", size=(200, 200))
    assert near(picture[0, 0], (255, 238, 221), 0)
    half = 100 / 1.05  # the square fills the picture but for a margin of a twentieth
    inside = np.abs(np.arange(200) + 0.5 - 100) < half - 1
    outside = np.abs(np.arange(200) + 0.5 - 100) > half + 1
    blue = picture[:, :, 2] > picture[:, :, 0] + 20
    assert blue[np.ix_(inside, inside)].all() and not blue[outside].any() and not blue[:, outside].any()
    def lined(edges):  # darker than the surface, by a line that may lie between two rows of pixels
        picture = drawn(path("two.vtu"), "--edges", edges, size=(200, 200)).sum(axis=-1)
        return picture < 0.85 * picture[50, 50]

    assert lined("elements")[98:102, 20:180].any(axis=0).all() and lined("elements")[20:180, 98:102].any(axis=1).all()
    assert not lined("patches")[20:180, 20:180].any() and lined("patches")[2:8].any()


def test_directions_PropertyOracle():
    good("source", "--shape", "cube", "--output", path("box.vtu"))
    good("fit", path("cloud.csv"), "--output", path("wave.vtu"), "--field", "Heat")
    top = drawn(path("box.vtu"), "--direction", "+z", "--edges", "none")
    assert np.array_equal(drawn(path("box.vtu"), "--direction", "0,0,3", "--edges", "none"), top)
    assert not np.array_equal(drawn(path("box.vtu"), "--direction", "iso", "--edges", "none"), top)
    assert np.array_equal(drawn(path("box.vtu"), "--direction", "iso"), drawn(path("box.vtu")))
    assert not np.array_equal(drawn(path("wave.vtu"), "--direction", "-x"), drawn(path("wave.vtu"), "--direction", "+x"))


def test_array_colours_and_has_a_legend_ExactOracle():
    picture = drawn(path("cloud.csv"), "--array", "Heat", "--direction", "+z")
    main, legend = picture[:, :134], picture[:, 134:]
    assert not near(legend, (255, 255, 255), 3).all() and not near(main, (255, 255, 255), 3).all()
    values = drawn(path("samples.vtp"), "--array", "Temperature", "--direction", "+z", size=(400, 300))[:, :330]
    coloured = ~near(values, (255, 255, 255), 3)
    rows, columns = np.nonzero(coloured)
    bright = values.sum(axis=-1)
    # x - 2 y: largest at the lower right, least at the upper left, and bright where it is large
    assert bright[rows, columns][(rows < 120) & (columns > 190)].mean() > bright[rows, columns][(rows > 180) & (columns < 140)].mean() + 60


def test_no_display_and_the_same_bytes_PropertyOracle():
    pictures = []
    before = os.environ.pop("DISPLAY", None)
    try:
        for display in (None, ":no-such-display"):
            if display:
                os.environ["DISPLAY"] = display
            good("view", path("cube.vtu"), "--size", *SIZE, "--output", path("one.png"))
            with open(path("one.png"), "rb") as stream:
                pictures.append(stream.read())
    finally:
        os.environ.pop("DISPLAY", None)
        if before is not None:
            os.environ["DISPLAY"] = before
    assert pictures[0] == pictures[1]


def test_refusals():
    for options, words in ((["--array", "Heaat"], ["'Heaat'", "Heat"]), (["--array", "Heat", "--component", 1], ["component"]),
                           (["--direction", "1,2"], ["'1,2'", "iso"]), (["--direction", "0,0,0"], ["'0,0,0'"]),
                           (["--color", "blau"], ["'blau'", "CSS"]), (["--background", "#12345g"], ["'#12345g'"]),
                           (["--size", 8, 100], ["8 x 100", "8192"]), (["--size", 100, 100000], ["8192"])):
        refuse(["view", path("cloud.csv"), *options, "--output", "out.png"], *words)
    refuse(["view", path("cloud.csv"), "--output", "out.jpg"], "'.png'")


knotwork_testing.main(globals())
