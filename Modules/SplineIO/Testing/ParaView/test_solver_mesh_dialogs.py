# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of Gmsh in ParaView's File > Open and Save Data."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import OpenDataFile, SaveData  # noqa: E402

TRIANGLE = ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
            "$Elements\n1\n17 2 2 5 1 1 2 3\n$EndElements\n")


def test_a_mesh_is_opened_and_saved():
    file = knotwork_testing.output("triangle.msh")
    with open(file, "w") as stream:
        stream.write(TRIANGLE)
    for name in (file, knotwork_testing.output("saved.msh")):
        source = OpenDataFile(name)
        source.UpdatePipeline()
        assert source.GetXMLLabel() == "Gmsh/Abaqus Mesh Reader", source.GetXMLLabel()
        assert source.CellData["ElementNumber"].GetRange() == (17, 17) and source.CellData["PhysicalGroup"].GetRange() == (5, 5)
        SaveData(knotwork_testing.output("saved.msh"), proxy=source)


knotwork_testing.main(globals())
