// SPDX-License-Identifier: BSD-3-Clause
// usage: SplineIOKernel FOLDER      a square as a face in a STEP file, and as text of GoTools
#include <CADExchange.h>
#include <GoToolsG2.h>
#include <Shapes.h>

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
  if (!summary || summary->NumFaces != 1)
  {
    return 1;
  }
  const auto text = knotwork::WriteG2(square.Value);
  return text && knotwork::ReadG2(text.Value) ? 0 : 1;
}
