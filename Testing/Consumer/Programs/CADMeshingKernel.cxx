// SPDX-License-Identifier: BSD-3-Clause
// usage: CADMeshingKernel FOLDER      a square from a STEP file as a grid of quadrilaterals
#include <knotwork/CADMeshing/CADQuads.h>
#include <knotwork/SplineCore/Shapes.h>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    return 2;
  }
  const auto square = knotwork::MakeShape({});
  knotwork::TrimmedModel model;
  model.Faces.emplace_back();
  model.Faces[0].Surface = std::get<knotwork::Spline<2>>(square->front());
  const std::string file = argv[1] + std::string("/face.step");
  if (!knotwork::WriteCAD(model, file))
  {
    return 1;
  }
  const auto topology = knotwork::CADTopology::Read(file);
  const auto quads = knotwork::MeshQuads(topology.Value);
  return quads && quads->EulerNumber == 1 && quads->Faces[0].Mapped ? 0 : 1;
}
