# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of MFEM in ParaView's File > Open."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import OpenDataFile  # noqa: E402


def test_files_are_opened():
    for name, cells in (("linear.mesh", 5), ("curved.mesh", 48), ("nurbs.mesh", 9)):
        source = OpenDataFile(knotwork_testing.data("SplineIO/" + name))
        source.UpdatePipeline()
        assert (source.GetXMLLabel(), source.GetDataInformation(0).GetNumberOfCells()) == ("MFEM Mesh Reader", cells), name


knotwork_testing.main(globals())
