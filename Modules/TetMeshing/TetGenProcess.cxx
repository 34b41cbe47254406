// SPDX-License-Identifier: BSD-3-Clause
#include "TetGenProcess.h"

#include "MesherProcess.h"
#include "TetGenParts.h"
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

namespace knotwork
{
namespace
{
constexpr MesherProgram Program = { "knotwork-tetgen", "TetGen", "the surface",
  "repair the surface, or give it better triangles or other bounds of quality" };

bool HasSizes(const TetrahedraParams& params)
{
  return params.MaxVolume > 0.0 || !params.RegionSizes.empty() || !params.Sizes.Cells.empty();
}

/// For the mesh, and for refining it by volumes of its tetrahedra.
std::vector<std::string> SwitchesOf(const TetrahedraParams& params)
{
  std::string common = "zQ"; // numbers from 0 on; quiet
  common += params.KeepBoundary ? "Y" : "";
  if (params.RadiusEdgeRatio > 0.0 || params.MinDihedralAngle > 0.0 || HasSizes(params))
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

/// Points that lie on one circle, sphere or plane to the last bit are more than TetGen bears at
/// times: it crashes, does not end, or finds facets that intersect where none do. Then it gets
/// points that are moved by this share of the diagonal at most, and what it makes gets those of the
/// surface.
constexpr double LargestShift = 1e-11;
constexpr int MostShifts = 3;

PointMatrix Shifted(const PointMatrix& points, int attempt)
{
  std::mt19937 random(static_cast<unsigned>(attempt));
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  PointMatrix shifted = points;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    for (Eigen::Index d = 0; d < 3; ++d)
    {
      const double share = static_cast<double>(random()) / 2147483648.0 - 1.0;
      shifted(i, d) += LargestShift * size * share;
    }
  }
  return shifted;
}

/// Of the time limit for the points as they are: half, or, where no sizes ask for more tetrahedra
/// than the surface does, 10 s and 2 ms a triangle (clean surfaces take a tenth of that or less).
int SecondsOfFirst(const TriangleMesh& surface, const TetrahedraParams& params, int limit)
{
  const int usual = 10 + static_cast<int>(surface.Triangles.size() / 500);
  return std::max(1, HasSizes(params) ? limit / 2 : std::min(limit / 2, usual));
}

/// Whether other points may help.
bool IsOfTetGen(WorkerEnd end, const Status& status)
{
  return end == WorkerEnd::Crashed || end == WorkerEnd::Late ||
    (end == WorkerEnd::Done &&
      (status.Code == ErrorCode::InvalidTopology || status.Code == ErrorCode::LibraryError));
}

std::vector<std::string> Encode(
  const PointMatrix& surfacePoints, const TriangleMesh& surface, const TetrahedraParams& params)
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
  part(TetGenInput::Points) = points(surfacePoints);
  part(TetGenInput::Triangles) = PackGroups(surface.Triangles);
  part(TetGenInput::Regions) = PackNumbers(regions.data(), regions.size());
  part(TetGenInput::SizePoints) = points(sizes.Points);
  part(TetGenInput::SizeCells) = PackGroups(sizes.Cells);
  part(TetGenInput::Sizes) = PackGroups(sizes.Lengths);
  return parts;
}

/// How many are larger than one for all.
int NumAbove(const Tetrahedra& mesh, double volume)
{
  const auto corner = [&](int point) -> Eigen::Vector3d { return mesh.Points.row(point); };
  return static_cast<int>(std::count_if(mesh.Cells.begin(), mesh.Cells.end(),
    [&](const std::array<int, 4>& cell)
    {
      const Eigen::Vector3d origin = corner(cell[0]);
      const Eigen::Vector3d normal = (corner(cell[1]) - origin).cross(corner(cell[2]) - origin);
      return std::abs(normal.dot(corner(cell[3]) - origin)) > 6.0 * volume * (1.0 + SizeMargin);
    }));
}

/// @param volume  of a tetrahedron at most; 0: any.
Result<Tetrahedra> Decode(const std::vector<std::string>& parts, double volume)
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
  found.Oversized = std::max(UnpackNumbers<int>(part(TetGenAnswer::Oversized)).at(0),
    volume > 0.0 ? NumAbove(found, volume) : 0);
  return found;
}
}

Result<Tetrahedra> RunTetGen(const TriangleMesh& surface, const TetrahedraParams& params,
  const WorkerLimits& limits, const std::function<bool()>& goOn)
{
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  WorkerLimits own = limits;
  own.Seconds = own.CpuSeconds = SecondsOfFirst(surface, params, limits.Seconds);
  WorkerEnd end = WorkerEnd::Done;
  auto parts = RunMesher(
    Program, SwitchesOf(params), Encode(surface.Points, surface, params), own, goOn, &end);
  int shifts = 0;
  for (; !parts && IsOfTetGen(end, parts.Status) && shifts < MostShifts; ++shifts)
  {
    const std::chrono::duration<double> gone = Clock::now() - begin;
    own.Seconds = own.CpuSeconds = limits.Seconds - static_cast<int>(gone.count());
    if (own.Seconds < 1)
    {
      break;
    }
    parts = RunMesher(Program, SwitchesOf(params),
      Encode(Shifted(surface.Points, shifts + 1), surface, params), own, goOn, &end);
  }
  if (!parts)
  {
    return end == WorkerEnd::Late ? LateMesher(Program, limits.Seconds) : parts.Status;
  }
  auto found = Decode(parts.Value, params.MaxVolume);
  if (found && shifts > 0 && found->Points.rows() >= surface.Points.rows())
  {
    found->Points.topRows(surface.Points.rows()) = surface.Points;
  }
  return found;
}
}
