// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenProcess.h"

#include "MesherProcess.h"
#include "TetGenParts.h"
#include <knotwork/SplineCore/Numbers.h>

namespace knotwork
{
namespace
{
constexpr MesherProgram Program = { "knotwork-tetgen", "TetGen", "the surface",
  "repair the surface, or give it better triangles or other bounds of quality" };

/// For the mesh, and for refining it by volumes of its tetrahedra.
std::vector<std::string> SwitchesOf(const TetrahedraParams& params)
{
  std::string common = "zQ"; // numbers from 0 on; quiet
  common += params.KeepBoundary ? "Y" : "";
  const bool areSizes = !params.RegionSizes.empty() || !params.Sizes.Cells.empty();
  if (params.RadiusEdgeRatio > 0.0 || params.MinDihedralAngle > 0.0 || params.MaxVolume > 0.0 ||
    areSizes)
  {
    // a ratio that is no bound, for TetGen has one of its own where none is given
    common += "q" + Digits(params.RadiusEdgeRatio > 0.0 ? params.RadiusEdgeRatio : 1e3, 10) + "/" +
      Digits(params.MinDihedralAngle, 10);
  }
  if (params.MaxVolume > 0.0)
  {
    common += "a" + Digits(params.MaxVolume, 10);
  }
  const std::string most = "S" + std::to_string(params.MaxSteinerPoints);
  // numbers of regions, and their bounds
  return { "p" + common + (params.RegionSizes.empty() ? "" : "Aa") + most,
    "r" + common + "a" + most };
}

std::vector<std::string> Encode(const TriangleMesh& surface, const TetrahedraParams& params)
{
  const SizeField& sizes = params.Sizes;
  std::vector<double> regions;
  for (const RegionSize& size : params.RegionSizes)
  {
    regions.insert(regions.end(), size.Point.data(), size.Point.data() + size.Point.size());
    regions.push_back(VolumeOfEdge(size.Length));
  }
  const auto points = [](const PointMatrix& matrix)
  { return PackNumbers(matrix.data(), static_cast<std::size_t>(matrix.size())); };
  std::vector<std::string> parts(static_cast<std::size_t>(TetGenInput::Count));
  const auto part = [&](TetGenInput which) -> std::string&
  { return parts[static_cast<std::size_t>(which)]; };
  part(TetGenInput::Points) = points(surface.Points);
  part(TetGenInput::Triangles) = PackGroups(surface.Triangles);
  part(TetGenInput::Regions) = PackNumbers(regions.data(), regions.size());
  part(TetGenInput::SizePoints) = points(sizes.Points);
  part(TetGenInput::SizeCells) = PackGroups(sizes.Cells);
  part(TetGenInput::Sizes) = PackGroups(sizes.Lengths);
  return parts;
}

Result<Tetrahedra> Decode(const std::vector<std::string>& parts)
{
  const auto part = [&](TetGenAnswer which) -> const std::string&
  { return parts[static_cast<std::size_t>(which)]; };
  if (parts.size() != static_cast<std::size_t>(TetGenAnswer::Count))
  {
    return { ErrorCode::LibraryError, std::string(Program.File) + " is of another version" };
  }
  Tetrahedra found;
  const std::vector<double> points = UnpackNumbers<double>(part(TetGenAnswer::Points));
  found.Points =
    Eigen::Map<const PointMatrix>(points.data(), static_cast<Eigen::Index>(points.size() / 3), 3);
  found.Cells = UnpackGroups<4>(part(TetGenAnswer::Tetrahedra));
  found.Triangles = UnpackGroups<3>(part(TetGenAnswer::Triangles));
  found.Sources = UnpackNumbers<int>(part(TetGenAnswer::Sources));
  return found;
}
}

Result<Tetrahedra> RunTetGen(const TriangleMesh& surface, const TetrahedraParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  const auto parts = RunMesher(Program, SwitchesOf(params), Encode(surface, params), limits, goOn);
  return parts ? Decode(parts.Value) : Result<Tetrahedra>(parts.Status);
}
}
