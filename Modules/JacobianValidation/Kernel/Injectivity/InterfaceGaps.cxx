// SPDX-License-Identifier: BSD-3-Clause
#include "InterfaceGaps.h"

#include <Eigen/Dense>

#include <algorithm>

namespace knotwork
{
namespace
{
/// Sides with common corners are an interface when they are nearer than this part of their size.
constexpr double Slender = 0.05;

/// Length of the diagonal of the box around points.
double Diagonal(const std::vector<Eigen::Vector3d>& points)
{
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const Eigen::Vector3d& x : points)
  {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return (high - low).norm();
}
}

std::vector<std::array<double, 3>> InterfaceGaps::SideSamples(int side, int n) const
{
  const CellShape shape = this->Side(side).Frame.Shape;
  std::vector<std::array<double, 3>> samples;
  for (int j = 0; j <= (shape == CellShape::Curve ? 0 : n); ++j)
  {
    for (int i = 0; i <= n; ++i)
    {
      if (shape != CellShape::Triangle || i + j <= n)
      {
        samples.push_back({ static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0 });
      }
    }
  }
  return samples;
}

double InterfaceGaps::SideDistance(int side, const std::vector<std::array<double, 3>>& samples,
  const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& x) const
{
  std::size_t best = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    if ((points[i] - x).squaredNorm() < (points[best] - x).squaredNorm())
    {
      best = i;
    }
  }
  double distance = (points[best] - x).norm();
  const CellShape shape = this->Side(side).Frame.Shape;
  const int dim = NumParameters(shape);
  std::array<double, 3> s = samples[best];
  for (int step = 0; step < 8; ++step)
  {
    const CellPoint p = EvaluateCell(this->SideCells, side, s.data());
    const Eigen::Vector3d r = x - Eigen::Vector3d(p.Position.data());
    distance = std::min(distance, r.norm());
    Eigen::MatrixXd j(3, dim);
    for (int d = 0; d < dim; ++d)
    {
      j.col(d) = Eigen::Vector3d(p.Derivative[static_cast<std::size_t>(d)].data());
    }
    const Eigen::VectorXd change = (j.transpose() * j).ldlt().solve(j.transpose() * r);
    if (!change.allFinite())
    {
      break;
    }
    for (int d = 0; d < dim; ++d)
    {
      const std::size_t at = static_cast<std::size_t>(d);
      s[at] = std::clamp(s[at] + change[d], 0.0, 1.0);
    }
    if (shape == CellShape::Triangle && s[0] + s[1] > 1.0)
    {
      const double over = 0.5 * (s[0] + s[1] - 1.0);
      s[0] = std::clamp(s[0] - over, 0.0, 1.0);
      s[1] = 1.0 - s[0];
    }
  }
  return distance;
}

std::vector<Eigen::Vector3d> InterfaceGaps::SidePoints(
  int side, const std::vector<std::array<double, 3>>& samples) const
{
  std::vector<Eigen::Vector3d> points;
  points.reserve(samples.size());
  for (const auto& s : samples)
  {
    points.emplace_back(EvaluateCell(this->SideCells, side, s.data()).Position.data());
  }
  return points;
}

bool InterfaceGaps::IsFar(
  int to, const std::vector<Eigen::Vector3d>& samples, bool haveSameCorners) const
{
  const BoundarySide& side = this->Side(to);
  const CellLattice& lattice =
    this->Lattices.at({ static_cast<int>(side.Frame.Shape), side.Degree });
  const int components = this->SideCells.NumComponents;
  Eigen::Matrix3Xd hull = Eigen::Matrix3Xd::Zero(3, lattice.Size);
  const double* data = this->SideCells.Block(to);
  for (int i = 0; i < lattice.Size; ++i)
  {
    const double w = this->SideCells.Rational ? data[components * lattice.Size + i] : 1.0;
    for (int d = 0; d < components; ++d)
    {
      hull(d, i) = data[d * lattice.Size + i] / w;
    }
  }
  const auto corner = [&](std::size_t c) { return hull.col(lattice.Corners[c]); };
  Eigen::Matrix3Xd directions(3, 4);
  directions.leftCols(3).setIdentity();
  const Eigen::Vector3d along = corner(1) - corner(0);
  directions.col(3) = components == 2 ? Eigen::Vector3d(-along[1], along[0], 0.0)
                                      : along.cross(corner(2) - corner(0)).eval();
  directions.col(3).normalize();
  const Eigen::MatrixXd places = directions.transpose() * hull;
  const Eigen::Vector4d least = places.rowwise().minCoeff();
  const Eigen::Vector4d most = places.rowwise().maxCoeff();
  const double tolerance = this->Tolerance;
  std::size_t far = 0;
  double farthest = 0.0;
  for (const Eigen::Vector3d& x : samples)
  {
    double distance = 0.0;
    for (int k = 0; k < 4; ++k)
    {
      const double at = directions.col(k).dot(x);
      distance = std::max({ distance, at - most[k], least[k] - at });
    }
    far += distance > tolerance ? 1 : 0;
    farthest = std::max(farthest, distance);
  }
  return 2 * far >= samples.size() && !(haveSameCorners && farthest <= Slender * Diagonal(samples));
}

bool InterfaceGaps::IsGap(int a, int b, InterfaceGap& gap) const
{
  const double tolerance = this->Tolerance;
  const bool curve = this->SideCells.NumComponents == 2;
  std::vector<int> placesA(
    this->Side(a).Places.begin(), this->Side(a).Places.begin() + this->Side(a).Frame.NumCorners);
  std::vector<int> placesB(
    this->Side(b).Places.begin(), this->Side(b).Places.begin() + this->Side(b).Frame.NumCorners);
  std::sort(placesA.begin(), placesA.end());
  std::sort(placesB.begin(), placesB.end());
  const bool sameCorners = placesA == placesB;
  bool isGap = false;
  for (int turn = 0; turn < 2; ++turn)
  {
    const int from = turn == 0 ? a : b;
    const int to = turn == 0 ? b : a;
    const auto samples = this->SidePoints(from, this->SideSamples(from, curve ? 12 : 5));
    if (this->IsFar(to, samples, sameCorners))
    {
      continue;
    }
    const auto targets = this->SideSamples(to, curve ? 32 : 8);
    const auto points = this->SidePoints(to, targets);
    std::size_t close = 0;
    double largestClose = 0.0;
    double largest = 0.0;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& x : samples)
    {
      const double distance = this->SideDistance(to, targets, points, x);
      if (distance > largest)
      {
        largest = distance;
        at = x;
      }
      if (distance <= tolerance)
      {
        ++close;
        largestClose = std::max(largestClose, distance);
      }
    }
    const bool unequal = sameCorners && largest <= Slender * Diagonal(samples);
    if (unequal || 2 * close > samples.size())
    {
      isGap = true;
      const double found = unequal ? largest : largestClose;
      if (found >= gap.Size)
      {
        gap.Size = found;
        gap.Position = { at[0] + this->Middle[0], at[1] + this->Middle[1],
          at[2] + this->Middle[2] };
      }
    }
  }
  gap.Cells = { this->Side(a).Cell, this->Side(b).Cell };
  gap.Sides = { this->Side(a).Number, this->Side(b).Number };
  return isGap;
}
}
