// SPDX-License-Identifier: BSD-3-Clause
#include "CADAreas.h"

#include "CADExchange.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TrimmedRegion.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr std::size_t MaxBoundaryCells = 1024; ///< that are halved in both directions once more
constexpr int MaxLevels = 12;
constexpr double SmallShare = 1e-3; ///< of the parameters inside, that may stay undecided
/// Relative: OpenCASCADE's quadrature of surfaces with poles is 4e-4 off, ours less.
constexpr double QuadratureSlack = 5e-3;
constexpr double BoxSlack = 1e-3; ///< of the size of the box

struct Cell
{
  RealArray<2> Lower;
  RealArray<2> Upper;
  double Area() const
  {
    return (this->Upper[0] - this->Lower[0]) * (this->Upper[1] - this->Lower[1]);
  }
};

std::vector<Cell> ElementsOf(const SplineSpace<2>& space)
{
  std::vector<Cell> cells;
  const std::vector<double>& u = space.Knots[0].Breaks();
  const std::vector<double>& v = space.Knots[1].Breaks();
  for (std::size_t j = 0; j + 1 < v.size(); ++j)
  {
    for (std::size_t i = 0; i + 1 < u.size(); ++i)
    {
      cells.push_back({ { u[i], v[j] }, { u[i + 1], v[j + 1] } });
    }
  }
  return cells;
}

void Divide(const Cell& cell, std::vector<Cell>& parts)
{
  const RealArray<2> middle{ 0.5 * (cell.Lower[0] + cell.Upper[0]),
    0.5 * (cell.Lower[1] + cell.Upper[1]) };
  for (int part = 0; part < 4; ++part)
  {
    Cell quarter = cell;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const bool isUpper = (part >> d & 1) != 0;
      (isUpper ? quarter.Lower : quarter.Upper)[d] = middle[d];
    }
    parts.push_back(quarter);
  }
}

/// Sums of |S_u x S_v| over cells. @param box  takes in the points.
Result<double> Integrate(const BezierForm<2>& form, const std::vector<Cell>& cells, int numPoints,
  Eigen::AlignedBox3d& box)
{
  const ElementQuadrature<2> rule = MakeElementQuadrature<2>({ numPoints, numPoints });
  const Eigen::Index n = rule.Local.rows();
  PointMatrix at(n * static_cast<Eigen::Index>(cells.size()), 2);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (Eigen::Index k = 0; k < n; ++k)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        const auto column = static_cast<Eigen::Index>(d);
        at(static_cast<Eigen::Index>(c) * n + k, column) =
          cells[c].Lower[d] + rule.Local(k, column) * (cells[c].Upper[d] - cells[c].Lower[d]);
      }
    }
  }
  EvaluationParams params;
  params.Derivatives = 1;
  EvaluationBatch batch;
  if (Status status = EvaluateParameters<2>(form, at, params, batch); !status)
  {
    return status;
  }
  double sum = 0.0;
  for (Eigen::Index i = 0; i < at.rows(); ++i)
  {
    const Eigen::Vector3d du = batch.First.row(i).head<3>();
    const Eigen::Vector3d dv = batch.First.row(i).tail<3>();
    sum +=
      rule.Weights[i % n] * cells[static_cast<std::size_t>(i / n)].Area() * du.cross(dv).norm();
    box.extend(Eigen::Vector3d(batch.Values.row(i)));
  }
  return sum;
}

std::string PlaceOfFace(const TrimmedModel& model, std::size_t f)
{
  const std::string& name = model.Faces[f].Name;
  return "face " + std::to_string(f) + (name.empty() ? "" : " ('" + name + "')");
}

bool IsWithin(double area, const AreaBounds& bounds)
{
  return area >= (1.0 - QuadratureSlack) * bounds.Lower &&
    area <= (1.0 + QuadratureSlack) * bounds.Upper;
}

constexpr const char* OtherFormats =
  "write .igs in place of .step (or .step in place of .igs), or .vtu";

std::string Difference(double found, const AreaBounds& bounds)
{
  return "the area " + Digits(found) + " when OpenCASCADE reads it again, which lies between " +
    Digits(bounds.Lower) + " and " + Digits(bounds.Upper) + ": " + OtherFormats;
}

/// One to one: faces in the order of their upper bounds take the least area left that they can.
/// @param left  numbers of the areas that are left.
Status MatchFaces(const TrimmedModel& model, const std::vector<AreaBounds>& bounds,
  const std::vector<double>& areas, std::vector<std::size_t>& left)
{
  std::vector<std::size_t> order(bounds.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  left = order;
  std::stable_sort(order.begin(), order.end(),
    [&](std::size_t a, std::size_t b) { return bounds[a].Upper < bounds[b].Upper; });
  std::stable_sort(
    left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return areas[a] < areas[b]; });
  std::vector<std::size_t> unmatched;
  for (const std::size_t f : order)
  {
    const auto found = std::find_if(
      left.begin(), left.end(), [&](std::size_t a) { return IsWithin(areas[a], bounds[f]); });
    if (found == left.end())
    {
      unmatched.push_back(f);
      continue;
    }
    left.erase(found);
  }
  if (unmatched.empty())
  {
    return {};
  }
  return { ErrorCode::InvalidFormat,
    PlaceOfFace(model, unmatched.front()) + " has " +
      Difference(areas[left.front()], bounds[unmatched.front()]) };
}
}

Result<AreaBounds> BoundArea(const TrimmedFace& face)
{
  auto region = TrimmedRegion::Create(face.Loops);
  if (!region)
  {
    return region.Status;
  }
  const BezierForm<2> form = MakeBezierForm<2>(face.Surface);
  std::vector<Cell> cells = ElementsOf(*face.Surface.Space);
  // fewer points where cells are many or small
  int numPoints = cells.size() > 100 ? 4 : 8;
  double decided = 0.0;
  AreaBounds result;
  Eigen::AlignedBox3d box;
  for (int level = 0; !cells.empty(); ++level)
  {
    std::vector<Cell> inside;
    std::vector<Cell> boundary;
    double undecided = 0.0;
    for (const Cell& cell : cells)
    {
      const RegionPlace place = region->Classify(cell.Lower, cell.Upper);
      if (place != RegionPlace::Outside)
      {
        (place == RegionPlace::Inside ? inside : boundary).push_back(cell);
        (place == RegionPlace::Inside ? decided : undecided) += cell.Area();
      }
    }
    const auto area = Integrate(form, inside, numPoints, box);
    if (!area)
    {
      return area.Status;
    }
    result.Lower += area.Value;
    result.Upper += area.Value;
    cells.clear();
    if (level == MaxLevels || boundary.size() > MaxBoundaryCells ||
      undecided <= SmallShare * decided)
    {
      Eigen::AlignedBox3d unused;
      const auto rest = Integrate(form, boundary, 3, unused);
      if (!rest)
      {
        return rest.Status;
      }
      result.Upper += rest.Value;
      break;
    }
    for (const Cell& cell : boundary)
    {
      Divide(cell, cells);
    }
    numPoints = std::max(numPoints - 1, 3);
  }
  if (!box.isEmpty())
  {
    Eigen::Map<Eigen::Vector3d>(result.BoxLower.data()) = box.min();
    Eigen::Map<Eigen::Vector3d>(result.BoxUpper.data()) = box.max();
  }
  return result;
}

Status CompareCAD(
  const TrimmedModel& model, const CADSummary& summary, std::vector<std::size_t>* others)
{
  std::vector<AreaBounds> bounds;
  AreaBounds sum;
  Eigen::AlignedBox3d found(Eigen::Map<const Eigen::Vector3d>(summary.BoxLower.data()),
    Eigen::Map<const Eigen::Vector3d>(summary.BoxUpper.data()));
  const double slack = BoxSlack * found.diagonal().norm();
  found.extend(Eigen::Vector3d(found.min().array() - slack));
  found.extend(Eigen::Vector3d(found.max().array() + slack));
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const auto area = BoundArea(model.Faces[f]);
    if (!area)
    {
      return { area.Status.Code, PlaceOfFace(model, f) + ": " + area.Status.Detail };
    }
    const Eigen::AlignedBox3d own(Eigen::Map<const Eigen::Vector3d>(area->BoxLower.data()),
      Eigen::Map<const Eigen::Vector3d>(area->BoxUpper.data()));
    if (own.diagonal().norm() > 0.0 && !found.contains(own))
    {
      return { ErrorCode::InvalidFormat,
        PlaceOfFace(model, f) + " lies outside of what OpenCASCADE reads again: " + OtherFormats };
    }
    sum.Lower += area->Lower;
    sum.Upper += area->Upper;
    bounds.push_back(area.Value);
  }
  if (bounds.size() == summary.FaceAreas.size())
  {
    std::vector<std::size_t> left;
    const Status status = MatchFaces(model, bounds, summary.FaceAreas, left);
    if (others)
    {
      *others = std::move(left);
    }
    return status;
  }
  if (summary.FaceAreas.size() < bounds.size())
  {
    return { ErrorCode::InvalidFormat,
      "OpenCASCADE reads " + std::to_string(summary.FaceAreas.size()) + " of its " +
        std::to_string(bounds.size()) + " faces again: " + OtherFormats };
  }
  return IsWithin(summary.Area, sum)
    ? Status()
    : Status(ErrorCode::InvalidFormat, "the faces have together " + Difference(summary.Area, sum));
}
}
