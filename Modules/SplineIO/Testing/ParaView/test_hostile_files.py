# SPDX-License-Identifier: BSD-3-Clause
"""A file that crashes OpenCASCADE leaves ParaView standing; sound ones are read."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import STEPIGESReader  # noqa: E402


def read(file):
    reader = STEPIGESReader(FileName=file)
    reader.UpdatePipeline()
    return reader.GetDataInformation(0).GetNumberOfCells(), reader.GetDataInformation(2).GetNumberOfCells()


def test_a_file_that_crashes_opencascade_is_an_error():
    assert read(knotwork_testing.data("Hostile/crashes_opencascade.iges")) == (0, 0)


def test_a_sound_file_is_read():
    assert STEPIGESReader().SeparateProcess == 1
    for name in ("sound.step", "sound.brep"):
        surfaces, triangles = read(knotwork_testing.data("Hostile/" + name))
        assert surfaces >= 1 and triangles >= 2, (name, surfaces, triangles)


knotwork_testing.main(globals())
