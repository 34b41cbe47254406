// SPDX-License-Identifier: BSD-3-Clause
#include "FitAnalyticSurface.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace knotwork
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double Degree = 0.017453292519943295;
constexpr double LargestRadius = 1e3; // sizes of the points
constexpr double FlattestCone = 85.0; // degrees
constexpr double SteepestCone = 1e-3; // degrees: a cylinder
constexpr double Negligible = 1e-14;  // eigenvalues, of the largest one

/// Columns of the Jacobian: shifts and turns of the axis, radii, angle.
enum Parameter
{
  ShiftU,
  ShiftV,
  ShiftAxis,
  TurnU,
  TurnV,
  GrowRadius,
  GrowMinor,
  GrowAngle,
  NumParameters
};
using Row = Eigen::Matrix<double, NumParameters, 1>;

std::array<bool, NumParameters> FreeParameters(SurfaceType type)
{
  switch (type)
  {
    case SurfaceType::Cylinder:
      return { true, true, false, true, true, true, false, false };
    case SurfaceType::Sphere:
      return { true, true, true, false, false, true, false, false };
    case SurfaceType::Cone:
      return { true, true, false, true, true, true, false, true };
    case SurfaceType::Torus:
      return { true, true, true, true, true, true, true, false };
    case SurfaceType::Plane:
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      break;
  }
  return {};
}

struct Frame
{
  explicit Frame(const Vector3d& axis) : U(axis.unitOrthogonal()), V(axis.cross(this->U)) {}
  Vector3d U;
  Vector3d V;
};

struct Cloud
{
  explicit Cloud(const std::vector<Vector3d>& points)
  {
    Vector3d lower = points.front();
    Vector3d upper = lower;
    for (const Vector3d& p : points)
    {
      this->Centre += p;
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
    this->Centre /= static_cast<double>(points.size());
    this->Size = (upper - lower).norm();
  }
  Vector3d Centre = Vector3d::Zero();
  double Size = 0.0;
};

bool FitPlane(const std::vector<Vector3d>& points, AnalyticSurface& surface)
{
  const Cloud cloud(points);
  Matrix3d moments = Matrix3d::Zero();
  for (const Vector3d& p : points)
  {
    moments += (p - cloud.Centre) * (p - cloud.Centre).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moments);
  if (!(solver.eigenvalues()[1] > Negligible * solver.eigenvalues()[2]))
  {
    return false; // points of a line
  }
  surface.Type = SurfaceType::Plane;
  surface.Point = cloud.Centre;
  surface.Axis = solver.eigenvectors().col(0);
  return true;
}

bool GuessSphere(const std::vector<Vector3d>& points, AnalyticSurface& surface)
{
  const Cloud cloud(points);
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd squares(rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    const Vector3d p = (points[static_cast<std::size_t>(i)] - cloud.Centre) / cloud.Size;
    rows.row(i) << p.transpose(), 1.0;
    squares[i] = p.squaredNorm();
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(rows);
  if (solver.rank() < 4)
  {
    return false;
  }
  const Eigen::Vector4d x = solver.solve(squares);
  const Vector3d centre = x.head<3>() / 2.0;
  const double square = x[3] + centre.squaredNorm();
  surface.Type = SurfaceType::Sphere;
  surface.Point = cloud.Centre + cloud.Size * centre;
  surface.Radius = cloud.Size * std::sqrt(std::max(square, 0.0));
  return square > 0.0;
}

/// Circle by linear least squares. @return false: points of a line.
bool FitCircle(const std::vector<Eigen::Vector2d>& points, Eigen::Vector2d& centre, double& radius)
{
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points)
  {
    middle += p / static_cast<double>(points.size());
  }
  Matrix3d matrix = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double size = 0.0;
  for (const Eigen::Vector2d& p : points)
  {
    size = std::max(size, (p - middle).norm());
  }
  if (!(size > 0.0))
  {
    return false;
  }
  for (const Eigen::Vector2d& p : points)
  {
    const Eigen::Vector2d q = (p - middle) / size;
    const Vector3d row(q.x(), q.y(), 1.0);
    matrix += row * row.transpose();
    right += row * q.squaredNorm();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(matrix);
  if (!(solver.eigenvalues()[0] > Negligible * solver.eigenvalues()[2]))
  {
    return false;
  }
  const Vector3d x = solver.eigenvectors() *
    (solver.eigenvectors().transpose() * right).cwiseQuotient(solver.eigenvalues());
  const Eigen::Vector2d relative = x.head<2>() / 2.0;
  const double square = x[2] + relative.squaredNorm();
  centre = middle + size * relative;
  radius = size * std::sqrt(std::max(square, 0.0));
  return square > 0.0;
}

bool GuessCylinder(const std::vector<Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface)
{
  Matrix3d moments = Matrix3d::Zero();
  for (const FlatPiece& piece : pieces)
  {
    moments += piece.Normal * piece.Normal.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(moments);
  if (!(solver.eigenvalues()[1] > 1e-8 * solver.eigenvalues()[2]))
  {
    return false; // one normal
  }
  surface.Type = SurfaceType::Cylinder;
  surface.Axis = solver.eigenvectors().col(0);
  const Frame frame(surface.Axis);
  const Vector3d middle = Cloud(points).Centre;
  std::vector<Eigen::Vector2d> plane;
  for (const Vector3d& p : points)
  {
    plane.emplace_back((p - middle).dot(frame.U), (p - middle).dot(frame.V));
  }
  Eigen::Vector2d centre;
  if (!FitCircle(plane, centre, surface.Radius))
  {
    return false;
  }
  surface.Point = middle + centre.x() * frame.U + centre.y() * frame.V;
  return true;
}

bool GuessCone(const std::vector<Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface)
{
  Vector3d mean = Vector3d::Zero();
  for (const FlatPiece& piece : pieces)
  {
    mean += piece.Normal / static_cast<double>(pieces.size());
  }
  Matrix3d spread = Matrix3d::Zero();
  Matrix3d moments = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  const Vector3d middle = Cloud(points).Centre;
  for (const FlatPiece& piece : pieces)
  {
    spread += (piece.Normal - mean) * (piece.Normal - mean).transpose();
    moments += piece.Normal * piece.Normal.transpose();
    right += piece.Normal * piece.Normal.dot(piece.Centre - middle);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> turns(spread);
  const Eigen::SelfAdjointEigenSolver<Matrix3d> planes(moments);
  if (!(turns.eigenvalues()[1] > 1e-12 * planes.eigenvalues()[2]) ||
    !(planes.eigenvalues()[0] > 1e-12 * planes.eigenvalues()[2]))
  {
    return false; // normals of a line, or planes without a common point: a cylinder
  }
  const Vector3d apex = middle +
    planes.eigenvectors() *
      (planes.eigenvectors().transpose() * right).cwiseQuotient(planes.eigenvalues());
  surface.Type = SurfaceType::Cone;
  surface.Axis = turns.eigenvectors().col(0);
  double height = (middle - apex).dot(surface.Axis);
  if (height < 0.0)
  {
    surface.Axis = -surface.Axis;
    height = -height;
  }
  surface.Point = apex + height * surface.Axis;
  const double sine = std::abs(mean.dot(surface.Axis));
  surface.Angle = std::asin(std::min(sine, 1.0));
  surface.Radius = height * std::tan(surface.Angle);
  return surface.Radius > 0.0 && std::isfinite(surface.Radius);
}

}

// Lines along normals meet the axis: a (p x n) + b n = 0 for its Pluecker coordinates (a, b).
bool GuessAxis(const std::vector<Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface)
{
  const Cloud cloud(points);
  Matrix3d mm = Matrix3d::Zero();
  Matrix3d mn = Matrix3d::Zero();
  Matrix3d nn = Matrix3d::Zero();
  for (const FlatPiece& piece : pieces)
  {
    const Vector3d moment = ((piece.Centre - cloud.Centre) / cloud.Size).cross(piece.Normal);
    mm += moment * moment.transpose();
    mn += moment * piece.Normal.transpose();
    nn += piece.Normal * piece.Normal.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> normals(nn);
  if (!(normals.eigenvalues()[0] > 1e-10 * normals.eigenvalues()[2]))
  {
    return false;
  }
  const Matrix3d inverse = normals.eigenvectors() *
    normals.eigenvalues().cwiseInverse().asDiagonal() * normals.eigenvectors().transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(mm - mn * inverse * mn.transpose());
  surface.Axis = axes.eigenvectors().col(0);
  const Vector3d moment = -inverse * mn.transpose() * surface.Axis;
  surface.Point = cloud.Centre + cloud.Size * surface.Axis.cross(moment);
  return true;
}

double SumOfSquaredDistances(const std::vector<Vector3d>& points, const AnalyticSurface& surface)
{
  double sum = 0.0;
  for (const Vector3d& p : points)
  {
    const double distance = surface.Distance(p);
    sum += distance * distance;
  }
  return sum;
}

namespace
{
bool GuessTorus(const std::vector<Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface)
{
  return GuessAxis(points, pieces, surface) && GuessTorusAbout(points, surface);
}
}

bool GuessCircleAxis(const std::vector<Vector3d>& points, AnalyticSurface& surface)
{
  if (!FitPlane(points, surface))
  {
    return false;
  }
  const Frame frame(surface.Axis);
  std::vector<Eigen::Vector2d> plane;
  for (const Vector3d& p : points)
  {
    plane.emplace_back((p - surface.Point).dot(frame.U), (p - surface.Point).dot(frame.V));
  }
  Eigen::Vector2d centre;
  double radius = 0.0;
  if (!FitCircle(plane, centre, radius))
  {
    return false;
  }
  surface.Point += centre.x() * frame.U + centre.y() * frame.V;
  return true;
}

bool GuessTorusAbout(const std::vector<Vector3d>& points, AnalyticSurface& surface)
{
  surface.Type = SurfaceType::Torus;
  const Vector3d onAxis = surface.Point;
  std::vector<Eigen::Vector2d> profile;
  for (const Vector3d& p : points)
  {
    const double height = (p - onAxis).dot(surface.Axis);
    profile.emplace_back((p - onAxis - height * surface.Axis).norm(), height);
  }
  Eigen::Vector2d centre;
  if (!FitCircle(profile, centre, surface.MinorRadius))
  {
    return false;
  }
  surface.Radius = centre.x();
  surface.Point = onAxis + centre.y() * surface.Axis;
  surface.Angle = 0.0;
  return surface.Radius > 0.0;
}

namespace
{
/// Distance and its derivatives by the parameters, of surfaces but planes.
class Derivation
{
public:
  explicit Derivation(const AnalyticSurface& surface)
    : Surface(surface), Around(surface.Axis), Cosine(std::cos(surface.Angle)),
      Sine(std::sin(surface.Angle)), AcrossU(surface.Axis.cross(this->Around.U)),
      AcrossV(surface.Axis.cross(this->Around.V))
  {
  }
  const Frame& Axes() const { return this->Around; }
  double At(const Vector3d& point, Row& row) const
  {
    const AnalyticSurface& s = this->Surface;
    const Vector3d offset = point - s.Point;
    const double height = offset.dot(s.Axis);
    Vector3d normal = offset - height * s.Axis; // away from the axis
    const double radius = normal.norm();
    normal = radius > 0.0 ? Vector3d(normal / radius) : Vector3d(Vector3d::Zero());
    double distance = radius - s.Radius;
    row[GrowRadius] = -1.0;
    row[GrowMinor] = -1.0;
    row[GrowAngle] = 0.0;
    if (s.Type == SurfaceType::Sphere)
    {
      const double length = offset.norm();
      normal = length > 0.0 ? Vector3d(offset / length) : Vector3d(Vector3d::Zero());
      distance = length - s.Radius;
    }
    else if (s.Type == SurfaceType::Cone)
    {
      row[GrowRadius] = -this->Cosine;
      row[GrowAngle] = -distance * this->Sine - height * this->Cosine;
      distance = distance * this->Cosine - height * this->Sine;
      normal = this->Cosine * normal - (radius > 0.0 ? this->Sine : 0.0) * s.Axis;
    }
    else if (s.Type == SurfaceType::Torus)
    {
      const double length = Eigen::Vector2d(distance, height).norm();
      const double inverse = length > 0.0 ? 1.0 / length : 0.0;
      row[GrowRadius] = -distance * inverse;
      normal = inverse * (distance * normal + height * s.Axis);
      distance = length - s.MinorRadius;
    }
    row[ShiftU] = -normal.dot(this->Around.U);
    row[ShiftV] = -normal.dot(this->Around.V);
    row[ShiftAxis] = -normal.dot(s.Axis);
    row[TurnU] = -normal.dot(this->AcrossU.cross(offset));
    row[TurnV] = -normal.dot(this->AcrossV.cross(offset));
    return distance;
  }

private:
  const AnalyticSurface& Surface;
  Frame Around;
  double Cosine;
  double Sine;
  Vector3d AcrossU;
  Vector3d AcrossV;
};

AnalyticSurface Changed(const AnalyticSurface& surface, const Frame& frame, const Row& step)
{
  AnalyticSurface result = surface;
  result.Point += step[ShiftU] * frame.U + step[ShiftV] * frame.V + step[ShiftAxis] * surface.Axis;
  result.Axis = (surface.Axis + step[TurnU] * frame.U + step[TurnV] * frame.V).normalized();
  result.Radius += step[GrowRadius];
  result.MinorRadius += step[GrowMinor];
  result.Angle += step[GrowAngle];
  return result;
}

bool IsDegenerate(const AnalyticSurface& s)
{
  const double angle = std::abs(s.Angle) / Degree;
  const bool largest = s.Radius < LargestRadius && s.MinorRadius < LargestRadius;
  switch (s.Type)
  {
    case SurfaceType::Cylinder:
    case SurfaceType::Sphere:
      return !(largest && s.Radius > 0.0);
    case SurfaceType::Cone:
      return !(largest && angle < FlattestCone && angle > SteepestCone);
    case SurfaceType::Torus:
      return !(largest && s.Radius > 0.0 && s.MinorRadius > 0.0);
    case SurfaceType::Plane:
      return false;
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      break;
  }
  return true;
}

std::array<bool, NumParameters> FreeParameters(SurfaceType type, const HeldParameters& held)
{
  std::array<bool, NumParameters> isFree = FreeParameters(type);
  const auto hold = [&isFree](bool isHeld, std::initializer_list<Parameter> parameters)
  {
    for (const Parameter parameter : parameters)
    {
      bool& free = isFree[static_cast<std::size_t>(parameter)];
      free = free && !isHeld;
    }
  };
  hold(held.Direction, { TurnU, TurnV });
  hold(held.Position, { ShiftU, ShiftV });
  hold(held.Size && type != SurfaceType::Torus && type != SurfaceType::Cone, { GrowRadius });
  hold(held.Size, { GrowMinor, GrowAngle });
  return isFree;
}

/// Damped Gauss-Newton steps on points about the origin of size 1.
/// @param hopeless  a sum of squares with which it is given up after some steps.
void Minimize(const std::vector<Vector3d>& points, const std::array<bool, NumParameters>& isFree,
  double hopeless, int steps, AnalyticSurface& surface)
{
  constexpr int StepsOfHope = 8;
  double damping = 1e-6;
  double sum = SumOfSquaredDistances(points, surface);
  const double zero = 1e-30 * static_cast<double>(points.size());
  for (int step = 0; step < steps && sum > zero; ++step)
  {
    if (step >= StepsOfHope && sum > hopeless)
    {
      return;
    }
    const Derivation derivation(surface);
    Eigen::Matrix<double, NumParameters, NumParameters> matrix;
    matrix.setZero();
    Row right = Row::Zero();
    Row row;
    for (const Vector3d& p : points)
    {
      const double distance = derivation.At(p, row);
      matrix.noalias() += row * row.transpose();
      right -= distance * row;
    }
    for (int k = 0; k < NumParameters; ++k)
    {
      if (!isFree[static_cast<std::size_t>(k)])
      {
        matrix.row(k).setZero();
        matrix.col(k).setZero();
        matrix(k, k) = 1.0;
        right[k] = 0.0;
      }
    }
    bool better = false;
    double gain = 0.0;
    while (!better && damping < 1e8)
    {
      auto damped = matrix;
      damped.diagonal() *= 1.0 + damping;
      damped.diagonal().array() += 1e-14 * matrix.diagonal().maxCoeff();
      const AnalyticSurface next = Changed(surface, derivation.Axes(), damped.ldlt().solve(right));
      const double nextSum = SumOfSquaredDistances(points, next);
      better = nextSum < sum;
      damping *= better ? 0.1 : 10.0;
      if (better)
      {
        gain = (sum - nextSum) / sum;
        surface = next;
        sum = nextSum;
      }
    }
    if (!better || gain < 1e-9)
    {
      return;
    }
    damping = std::max(damping, 1e-12);
  }
}

void Move(AnalyticSurface& surface, const Vector3d& shift, double scale)
{
  surface.Point = scale * (surface.Point + shift);
  surface.Radius *= scale;
  surface.MinorRadius *= scale;
}

/// The same surface with Point beside the points, and a cone that opens along its axis.
void Normalize(AnalyticSurface& s)
{
  if (s.Type == SurfaceType::Cylinder || s.Type == SurfaceType::Cone)
  {
    const double height = -s.Point.dot(s.Axis);
    s.Point += height * s.Axis;
    s.Radius += height * std::tan(s.Angle);
  }
  if (s.Angle < 0.0)
  {
    s.Angle = -s.Angle;
    s.Axis = -s.Axis;
  }
}

/// The steps of a surface but a plane, with points about the origin of size 1.
bool FitCurved(const std::vector<Vector3d>& points, const std::array<bool, NumParameters>& isFree,
  double hopeless, int steps, AnalyticSurface& surface)
{
  const Cloud cloud(points);
  if (!(cloud.Size > 0.0))
  {
    return false;
  }
  std::vector<Vector3d> unit;
  unit.reserve(points.size());
  for (const Vector3d& p : points)
  {
    unit.emplace_back((p - cloud.Centre) / cloud.Size);
  }
  AnalyticSurface moved = surface;
  Move(moved, -cloud.Centre, 1.0 / cloud.Size);
  Normalize(moved);
  if (IsDegenerate(moved))
  {
    return false;
  }
  const double far = hopeless / cloud.Size;
  Minimize(unit, isFree, far * far * static_cast<double>(points.size()), steps, moved);
  Normalize(moved);
  if (IsDegenerate(moved) || !moved.Point.allFinite() || !moved.Axis.allFinite())
  {
    return false;
  }
  Move(moved, Vector3d::Zero(), cloud.Size);
  moved.Point += cloud.Centre;
  surface = moved;
  return true;
}
}

int NumSurfaceParameters(SurfaceType type)
{
  switch (type)
  {
    case SurfaceType::Plane:
      return 3;
    case SurfaceType::Cylinder:
      return 5;
    case SurfaceType::Sphere:
      return 4;
    case SurfaceType::Cone:
      return 6;
    case SurfaceType::Torus:
      return 7;
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      break;
  }
  return 0;
}

bool GuessSurface(SurfaceType type, const std::vector<Vector3d>& points,
  const std::vector<FlatPiece>& pieces, AnalyticSurface& surface)
{
  surface = AnalyticSurface();
  if (static_cast<int>(points.size()) < NumSurfaceParameters(type) || points.size() < 3)
  {
    return false;
  }
  switch (type)
  {
    case SurfaceType::Plane:
      return FitPlane(points, surface);
    case SurfaceType::Cylinder:
      return pieces.size() >= 2 && GuessCylinder(points, pieces, surface);
    case SurfaceType::Sphere:
      return GuessSphere(points, surface);
    case SurfaceType::Cone:
      return pieces.size() >= 3 && GuessCone(points, pieces, surface);
    case SurfaceType::Torus:
      return pieces.size() >= 5 && GuessTorus(points, pieces, surface);
    case SurfaceType::FreeForm:
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      break;
  }
  return false;
}

bool FitSurface(
  const std::vector<Vector3d>& points, AnalyticSurface& surface, double hopeless, int steps)
{
  if (static_cast<int>(points.size()) < NumSurfaceParameters(surface.Type) || points.size() < 3)
  {
    return false;
  }
  if (surface.Type == SurfaceType::Plane)
  {
    const Vector3d axis = surface.Axis;
    const bool found = FitPlane(points, surface);
    surface.Axis = surface.Axis.dot(axis) < 0.0 ? Vector3d(-surface.Axis) : surface.Axis;
    return found;
  }
  return FitCurved(points, FreeParameters(surface.Type), hopeless, steps, surface);
}

bool FitSurface(
  const std::vector<Vector3d>& points, const HeldParameters& held, AnalyticSurface& surface)
{
  if (points.empty() || surface.Type == SurfaceType::FreeForm || HasProfile(surface.Type))
  {
    return false;
  }
  if (surface.Type != SurfaceType::Plane)
  {
    constexpr int MostSteps = 60;
    return FitCurved(points, FreeParameters(surface.Type, held),
      std::numeric_limits<double>::infinity(), MostSteps, surface);
  }
  if (!held.Direction)
  {
    return FitSurface(points, surface);
  }
  if (!held.Position)
  {
    surface.Point = Cloud(points).Centre;
  }
  return true;
}

double MaxDistance(const std::vector<Vector3d>& points, const AnalyticSurface& surface)
{
  double largest = 0.0;
  for (const Vector3d& p : points)
  {
    largest = std::max(largest, std::abs(surface.Distance(p)));
  }
  return largest;
}
}
