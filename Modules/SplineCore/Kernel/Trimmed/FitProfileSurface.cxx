// SPDX-License-Identifier: BSD-3-Clause
#include "FitProfileSurface.h"
#include "SurfaceProfile.h"
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <queue>

namespace knotwork
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int Degree = 5;
constexpr double Margin = 0.03;          ///< of the profile's length
constexpr double Smoothing = 1e-5;       ///< weight of third differences of control points
constexpr double PointsOfFunction = 2.0; ///< places along the profile
constexpr int Turns = 8;
constexpr double FarShare = 128.0; ///< of what is near, after the first turn: another surface

using Neighbours = std::vector<std::vector<int>>;

/// Lengths of shortest paths in the plane; infinite where there is none.
std::vector<double> PathsFrom(
  int source, const std::vector<Vector2d>& plane, const Neighbours& neighbours)
{
  std::vector<double> lengths(plane.size(), HUGE_VAL);
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  lengths[static_cast<std::size_t>(source)] = 0.0;
  queue.emplace(0.0, source);
  while (!queue.empty())
  {
    const auto [length, at] = queue.top();
    queue.pop();
    if (length > lengths[static_cast<std::size_t>(at)])
    {
      continue;
    }
    for (const int next : neighbours[static_cast<std::size_t>(at)])
    {
      const auto n = static_cast<std::size_t>(next);
      const double other = length + (plane[n] - plane[static_cast<std::size_t>(at)]).norm();
      if (other < lengths[n])
      {
        lengths[n] = other;
        queue.emplace(other, next);
      }
    }
  }
  return lengths;
}

/// Parameters along the curve that points in the plane lie on: from one of its ends.
bool Order(
  const std::vector<Vector2d>& plane, const Neighbours& neighbours, std::vector<double>& order)
{
  const std::vector<double> first = PathsFrom(0, plane, neighbours);
  const auto end = std::max_element(first.begin(), first.end());
  order = PathsFrom(static_cast<int>(end - first.begin()), plane, neighbours);
  const double length = *std::max_element(order.begin(), order.end());
  return std::isfinite(length) && length > 0.0;
}

/// Parameters that differ by more than a hundredth of the length.
int CountPlaces(std::vector<double> order)
{
  std::sort(order.begin(), order.end());
  const double apart = 0.01 * (order.back() - order.front());
  int count = 1;
  double last = order.front();
  for (const double place : order)
  {
    if (place > last + apart)
    {
      ++count;
      last = place;
    }
  }
  return count;
}

/// Least squares of so many spans with points at parameters.
bool FitCurve(const std::vector<Vector2d>& plane, const std::vector<double>& order, double length,
  int spans, Spline<1>& curve)
{
  const KnotVector knots =
    KnotVector::Uniform(Degree, spans, -Margin * length, (1.0 + Margin) * length);
  const int count = knots.NumFunctions();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 2);
  std::array<double, Degree + 1> values{};
  for (std::size_t i = 0; i < plane.size(); ++i)
  {
    const int element = knots.FindElement(order[i]);
    knots.EvaluateFunctions(element, order[i], 0, values.data());
    const int first = knots.Span(element) - Degree;
    const Eigen::Map<const Eigen::VectorXd> row(values.data(), Degree + 1);
    normal.block(first, first, Degree + 1, Degree + 1) += row * row.transpose();
    right.middleRows(first, Degree + 1) += row * plane[i].transpose();
  }
  const double weight = Smoothing * static_cast<double>(plane.size()) / count;
  const Eigen::RowVector4d third(-1.0, 3.0, -3.0, 1.0);
  for (int i = 0; i + 3 < count; ++i)
  {
    normal.block(i, i, 4, 4) += weight * third.transpose() * third;
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  curve.Space = MakeTensorSpace<1>({ knots }).Value;
  curve.ControlPoints = solver.solve(right);
  return solver.info() == Eigen::Success && curve.ControlPoints.allFinite();
}

/// Sum of squares and the largest one of distances.
struct Residual
{
  double Sum = HUGE_VAL;
  double Largest = HUGE_VAL;
};

Residual ResidualOf(const std::vector<Vector3d>& points, const AnalyticSurface& surface)
{
  Residual residual{ 0.0, 0.0 };
  for (const Vector3d& point : points)
  {
    const double distance = std::abs(surface.Distance(point));
    residual.Sum += distance * distance;
    residual.Largest = std::max(residual.Largest, distance);
  }
  return residual;
}

class ProfileFit
{
public:
  ProfileFit(
    const std::vector<Vector3d>& points, const std::vector<std::array<int, 2>>& edges, double near)
    : Points(points), Near(near), Beside(points.size())
  {
    for (const auto& [a, b] : edges)
    {
      this->Beside[static_cast<std::size_t>(a)].push_back(b);
      this->Beside[static_cast<std::size_t>(b)].push_back(a);
    }
  }

  /// The profile of a surface whose axis is known.
  /// @param taken  the fewest spans of the profile; result: as many as it took.
  bool FitProfile(AnalyticSurface& surface, int& taken) const
  {
    const Vector3d across = surface.Axis.unitOrthogonal();
    std::vector<Vector2d> plane;
    for (const Vector3d& point : this->Points)
    {
      const Vector3d offset = point - surface.Point;
      const double height = offset.dot(surface.Axis);
      plane.push_back(surface.Type == SurfaceType::Extrusion
          ? Vector2d(offset.dot(across), offset.dot(surface.Axis.cross(across)))
          : Vector2d((offset - height * surface.Axis).norm(), height));
    }
    std::vector<double> order;
    if (!Order(plane, this->Beside, order))
    {
      return false;
    }
    const double length = *std::max_element(order.begin(), order.end());
    const int places = CountPlaces(order);
    Residual best;
    int missed = 0; // that were not worth it
    int found = 0;
    for (const int spans : { 1, 2, 3, 4, 6, 8, 12, 16 })
    {
      if ((PointsOfFunction * (spans + Degree) > places && spans > 1) || missed == 3)
      {
        break;
      }
      if (spans < taken)
      {
        continue;
      }
      AnalyticSurface trial = surface;
      if (places < Degree || !this->FitSpans(plane, order, length, spans, across, trial))
      {
        continue;
      }
      const Residual residual = ResidualOf(this->Points, trial);
      constexpr double WorthIt = 0.7;
      ++missed;
      if (residual.Sum < WorthIt * best.Sum)
      {
        best = residual;
        surface.Profile = trial.Profile;
        found = spans;
        missed = 0;
      }
      if (best.Largest <= this->Near)
      {
        break;
      }
    }
    taken = found;
    return found > 0;
  }

  /// A Gauss-Newton step of the axis with the profile as it is.
  bool Turn(AnalyticSurface& surface) const
  {
    const Vector3d u = surface.Axis.unitOrthogonal();
    const Vector3d v = surface.Axis.cross(u);
    const int count = surface.Type == SurfaceType::Extrusion ? 2 : 4;
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& point : this->Points)
    {
      middle += point / static_cast<double>(this->Points.size());
    }
    surface.Point += (middle - surface.Point).dot(surface.Axis) * surface.Axis; // turns about it
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Vector3d& point : this->Points)
    {
      const Vector3d offset = point - surface.Point;
      const Vector3d normal = surface.Normal(point);
      const Eigen::Vector4d row(-normal.dot(surface.Axis.cross(u).cross(offset)),
        -normal.dot(surface.Axis.cross(v).cross(offset)), -normal.dot(u), -normal.dot(v));
      matrix += row * row.transpose();
      right -= surface.Distance(point) * row;
    }
    const Eigen::VectorXd step = matrix.topLeftCorner(count, count).ldlt().solve(right.head(count));
    if (!step.allFinite())
    {
      return false;
    }
    surface.Axis = (surface.Axis + step[0] * u + step[1] * v).normalized();
    if (count == 4)
    {
      surface.Point += step[2] * u + step[3] * v;
    }
    return true;
  }

private:
  bool FitSpans(const std::vector<Vector2d>& plane, std::vector<double> order, double length,
    int spans, const Vector3d& across, AnalyticSurface& surface) const
  {
    constexpr int Passes = 4; // places of points are those of the curve before
    for (int pass = 0; pass < Passes; ++pass)
    {
      Spline<1> curve;
      if (!FitCurve(plane, order, length, spans, curve))
      {
        return false;
      }
      surface.Profile = std::make_shared<const SurfaceProfile>(std::move(curve), across);
      if (!std::isfinite(surface.Profile->MaxCurvature()))
      {
        return false;
      }
      for (std::size_t i = 0; i < plane.size(); ++i)
      {
        order[i] = std::min(
          std::max(surface.Profile->NearestFrom(plane[i], order[i]), surface.Profile->Begin()),
          surface.Profile->End());
      }
    }
    return true;
  }

  const std::vector<Vector3d>& Points;
  double Near;
  Neighbours Beside;
};

/// The direction across which all normals are.
bool GuessDirection(const std::vector<Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface)
{
  constexpr double Flat = 1e-4;
  constexpr double Across = 0.1; // of the normals' second moment, of what is not across
  Matrix3d moments = Matrix3d::Zero();
  for (const FlatPiece& piece : pieces)
  {
    moments += piece.Normal * piece.Normal.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moments);
  const Vector3d values = solver.eigenvalues();
  if (!(values[1] > Flat * values[2]) || values[0] > Across * values[1])
  {
    return false;
  }
  surface.Axis = solver.eigenvectors().col(0);
  surface.Point = points.front();
  return true;
}

/// An edge, with points on it if it is straight.
void AddSide(const std::array<int, 2>& edge, bool straight, std::vector<Vector3d>& points,
  std::vector<std::array<int, 2>>& sides)
{
  constexpr int Parts = 4;
  const Vector3d from = points[static_cast<std::size_t>(edge[0])];
  const Vector3d to = points[static_cast<std::size_t>(edge[1])];
  int last = edge[0];
  for (int k = 1; straight && k < Parts; ++k)
  {
    const double share = static_cast<double>(k) / Parts;
    points.emplace_back((1.0 - share) * from + share * to);
    const int added = static_cast<int>(points.size()) - 1;
    sides.push_back({ last, added });
    last = added;
  }
  sides.push_back({ last, edge[1] });
}

/// Whether the motion that makes the surface leads along the pieces, in the mean: cheap to see.
bool MovesAlong(const AnalyticSurface& surface, const std::vector<FlatPiece>& pieces)
{
  constexpr double MostLean = 0.03; // mean square of sines
  double sum = 0.0;
  for (const FlatPiece& piece : pieces)
  {
    const Vector3d way = surface.Type == SurfaceType::Extrusion
      ? surface.Axis
      : surface.Axis.cross(piece.Centre - surface.Point).normalized();
    sum += way.dot(piece.Normal) * way.dot(piece.Normal);
  }
  return sum <= MostLean * static_cast<double>(pieces.size());
}

bool ReachesAxis(const std::vector<Vector3d>& points, const AnalyticSurface& surface)
{
  constexpr double Near = 0.02; // of the farthest
  double least = HUGE_VAL;
  double most = 0.0;
  for (const Vector3d& point : points)
  {
    const double out = surface.InProfile(point)[0];
    least = std::min(least, out);
    most = std::max(most, out);
  }
  return least <= Near * most;
}
}

bool FitProfileSurface(SurfaceType type, const std::vector<Vector3d>& points,
  const std::vector<std::array<int, 2>>& edges, const std::vector<char>& straight,
  const std::vector<FlatPiece>& pieces, double near, AnalyticSurface& surface)
{
  constexpr double WorthIt = 0.9;
  if (!HasProfile(type) || points.size() < 2 * Degree || pieces.size() < 3)
  {
    return false;
  }
  const bool turns = type == SurfaceType::Revolution;
  AnalyticSurface trial = surface.Type == type ? surface : AnalyticSurface();
  if (surface.Type != type &&
    !(turns ? GuessAxis(points, pieces, trial) : GuessDirection(points, pieces, trial)))
  {
    return false;
  }
  trial.Type = type;
  if (!MovesAlong(trial, pieces))
  {
    return false;
  }
  std::vector<Vector3d> all = points;
  std::vector<std::array<int, 2>> sides;
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    AddSide(edges[e], straight[e] != 0, all, sides);
  }
  const ProfileFit fit(all, sides, near);
  Residual best;
  int spans = 0;
  for (int turn = 0; turn < Turns; ++turn)
  {
    if ((turns && ReachesAxis(points, trial)) || !fit.FitProfile(trial, spans))
    {
      break;
    }
    const Residual residual = ResidualOf(all, trial);
    const bool isWorthIt = residual.Sum < WorthIt * best.Sum;
    if (residual.Sum < best.Sum)
    {
      best = residual;
      surface = trial;
    }
    if (!isWorthIt || residual.Largest > FarShare * near || !fit.Turn(trial))
    {
      break;
    }
  }
  return best.Sum < HUGE_VAL;
}
}
