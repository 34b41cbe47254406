// SPDX-License-Identifier: BSD-3-Clause
// usage: CADModelKernel FOLDER      a square as a face in a STEP file
#include <knotwork/CADModel/CADExchange.h>
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
  const std::string file = argv[1] + std::string("/square.step");
  if (!knotwork::WriteCAD(model, file))
  {
    return 1;
  }
  const auto summary = knotwork::CheckCAD(file);
  return summary && summary->NumFaces == 1 ? 0 : 1;
}
