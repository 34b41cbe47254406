// SPDX-License-Identifier: BSD-3-Clause
#include "RepairDistances.h"

#include "FarthestDistance.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <set>

namespace knotwork
{
namespace
{
constexpr double ToleranceShare = 1e-4; ///< of the diagonal

/// The input and the triangles that closed its holes, which patches may lie on.
TriangleIndex<3> InputAndFillings(
  const TriangleMesh& input, std::vector<MeshTriangle> triangles, const OngoingRepair& repair)
{
  auto count = input.Points.rows();
  PointMatrix points(count + 3 * static_cast<Eigen::Index>(repair.Fillings.size()), 3);
  points.topRows(count) = input.Points;
  for (const auto& corners : repair.Fillings)
  {
    const auto first = static_cast<int>(count);
    triangles.push_back({ first, first + 1, first + 2 });
    for (const Eigen::Vector3d& corner : corners)
    {
      points.row(count++) = corner.transpose();
    }
  }
  return { std::move(points), std::move(triangles) };
}

/// What was done next to a place, in words.
std::string NearestAction(const std::vector<RepairAction>& actions, const Eigen::Vector3d& place)
{
  const RepairAction* nearest = nullptr;
  for (const RepairAction& action : actions)
  {
    if (!nearest || (action.Place - place).squaredNorm() < (nearest->Place - place).squaredNorm())
    {
      nearest = &action;
    }
  }
  std::string words = nearest ? ToString(nearest->Kind) : "points";
  std::replace(words.begin(), words.end(), '_', ' ');
  return words + " were repaired";
}
}

Status CheckDistances(const TriangleMesh& input, const std::vector<int>& firstOfEqual,
  const OngoingRepair& repair, SurfaceRepair& result)
{
  const std::vector<MeshTriangle> given = ReplaceCorners(input.Triangles, firstOfEqual);
  std::set<MeshTriangle> stay;
  std::vector<MeshTriangle> changed; // of the result, but not in holes
  std::set<MeshTriangle> all;
  for (const MeshTriangle& corners : given)
  {
    all.insert(Sorted(corners));
  }
  for (std::size_t t = 0; t < result.Mesh.Triangles.size(); ++t)
  {
    const MeshTriangle& corners = result.Mesh.Triangles[t];
    MeshTriangle ids{};
    bool same = true;
    for (std::size_t k = 0; k < 3 && same; ++k)
    {
      const int id = result.PointIds[static_cast<std::size_t>(corners[k])];
      same = id >= 0 && result.Mesh.Points.row(corners[k]) == input.Points.row(id);
      ids[k] = same ? firstOfEqual[static_cast<std::size_t>(id)] : -1;
    }
    ids = Sorted(ids);
    if (same && all.count(ids) > 0)
    {
      stay.insert(ids);
    }
    else if (result.TriangleIds[t] >= 0)
    {
      changed.push_back(corners);
    }
  }
  std::vector<MeshTriangle> lost;
  for (const MeshTriangle& corners : given)
  {
    if (stay.count(Sorted(corners)) == 0)
    {
      lost.push_back(corners);
    }
  }
  const double tolerance = ToleranceShare * result.Diagonal;
  const LargestDistance from =
    FarthestFrom(InputAndFillings(input, given, repair), result.Mesh.Points, changed, tolerance);
  const LargestDistance to = FarthestFrom(
    TriangleIndex<3>(result.Mesh.Points, result.Mesh.Triangles), input.Points, lost, tolerance);
  result.DistanceFromInput = from.Value;
  result.DistanceToInput = to.Value;
  const LargestDistance& larger = from.Value > to.Value ? from : to;
  if (larger.Value <= repair.Params.Limit * result.Diagonal)
  {
    return {};
  }
  return { ErrorCode::NotConverged,
    "the repaired surface is " + Digits(larger.Value / result.Diagonal, 3) +
      " of the diagonal from the given one at " + PlaceText(larger.Place) + ", where " +
      NearestAction(result.Actions, larger.Place) + "; mend the triangles there, or raise Limit" };
}
}
