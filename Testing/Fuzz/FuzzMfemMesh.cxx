// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/MfemMesh.h>

#include <cstdint>
#include <cstdlib>

namespace
{
/// Cells have points, coefficients and vertices that are there.
bool IsSound(const knotwork::MfemMesh& mesh)
{
  const bool isCurved = mesh.Degree > 0;
  bool sound = !mesh.Cells.empty() && mesh.Points.allFinite() &&
    (mesh.IsSpline ? mesh.Splines.Splines.size() : mesh.Cells.size()) == mesh.Cells.size() &&
    (!isCurved || mesh.CellBegin.size() == mesh.Cells.size() + 1) &&
    (isCurved || mesh.IsSpline || mesh.Points.rows() == mesh.NumVertices);
  for (const knotwork::MfemCell& cell : mesh.Cells)
  {
    for (const int corner : cell.Corners)
    {
      sound = sound && corner >= -1 && corner < mesh.NumVertices;
    }
  }
  for (const int point : mesh.CellPoints)
  {
    sound = sound && point >= 0 && point < mesh.Points.rows();
  }
  return sound;
}
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  const Result<MfemMesh> mesh = ReadMfemMesh({ reinterpret_cast<const char*>(data), size });
  const bool isClear =
    !mesh.Status.Detail.empty() && mesh.Status.Detail.find('\n') == std::string::npos;
  if (mesh ? !IsSound(mesh.Value) : !isClear)
  {
    std::abort();
  }
  return 0;
}
