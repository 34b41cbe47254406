// SPDX-License-Identifier: BSD-3-Clause
#include "AlignmentSamples.h"

#include "AlignmentSteps.h"
#include "TriangleSamples.h"

#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr int SpreadSamples = 20000; ///< on target and scan, for the search
constexpr int CellsOfMoments = 2000;
constexpr double LikeRadii = 0.95;   ///< of inertia: axes are ambiguous above
constexpr double FarRadii = 6.0;     ///< of half of the points: what is farther is not the part
constexpr double LargestRatio = 5.0; ///< of the scan's size to the target's
constexpr double LeastRatio = 0.01;

/// Number of a point's cell of 2^10 a direction, neighbours near each other.
std::uint64_t MortonCode(const Eigen::RowVector3d& cell)
{
  std::uint64_t code = 0;
  for (int d = 0; d < 3; ++d)
  {
    const auto n = static_cast<std::uint64_t>(std::clamp(cell[d], 0.0, 1023.0));
    for (int bit = 0; bit < 10; ++bit)
    {
      code |= (n >> bit & 1) << (3 * bit + d);
    }
  }
  return code;
}

/// In an order in which neighbours follow each other: closest points are found faster so.
PointMatrix Ordered(const PointMatrix& points)
{
  const Eigen::RowVector3d lower = points.colwise().minCoeff();
  const double size = (points.colwise().maxCoeff() - lower).maxCoeff();
  std::vector<std::pair<std::uint64_t, Eigen::Index>> order;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const Eigen::RowVector3d share = (points.row(i) - lower) / (size > 0.0 ? size : 1.0);
    order.emplace_back(MortonCode(1023.0 * share), i);
  }
  std::sort(order.begin(), order.end());
  PointMatrix ordered(points.rows(), 3);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    ordered.row(static_cast<Eigen::Index>(i)) = points.row(order[i].second);
  }
  return ordered;
}

/// Weights that make up for uneven density: points of a cell share the median count of cells where
/// they are more.
Eigen::VectorXd DensityWeights(const PointMatrix& points)
{
  const Eigen::RowVector3d lower = points.colwise().minCoeff();
  const double size = (points.colwise().maxCoeff() - lower).maxCoeff();
  std::vector<std::uint64_t> code(static_cast<std::size_t>(points.rows()));
  std::map<std::uint64_t, int> counts;
  for (double cells = 256.0; cells >= 4.0; cells /= 1.5)
  {
    counts.clear();
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const Eigen::RowVector3d share = (points.row(i) - lower) / (size > 0.0 ? size : 1.0);
      const std::uint64_t cell = MortonCode(cells * share);
      code[static_cast<std::size_t>(i)] = cell;
      ++counts[cell];
    }
    if (counts.size() <= CellsOfMoments)
    {
      break;
    }
  }
  std::vector<int> sorted;
  for (const auto& [cell, count] : counts)
  {
    sorted.push_back(count);
  }
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  const int median = sorted[sorted.size() / 2];
  Eigen::VectorXd weights(points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const int count = counts[code[static_cast<std::size_t>(i)]];
    weights[i] = static_cast<double>(std::min(count, median)) / count;
  }
  return weights;
}

/// Of every coordinate.
Eigen::RowVector3d MedianOf(const PointMatrix& points)
{
  return { QuantileOf(points.col(0), 0.5), QuantileOf(points.col(1), 0.5),
    QuantileOf(points.col(2), 0.5) };
}

/// Half of the points are nearer to their median.
double RadiusOf(const PointMatrix& points)
{
  return QuantileOf((points.rowwise() - MedianOf(points)).rowwise().norm(), 0.5);
}

/// Middle, principal axes and radii of inertia of weighted points, the longest one first.
struct Moments
{
  Eigen::Vector3d Middle;
  Eigen::Matrix3d Axes; ///< columns, right-handed
  Eigen::Vector3d Radii;

  Moments(const PointMatrix& points, const Eigen::VectorXd& weights)
  {
    const double all = weights.sum();
    this->Middle = (weights.transpose() * points).transpose() / all;
    const PointMatrix arms = points.rowwise() - this->Middle.transpose();
    const Eigen::Matrix3d matrix = arms.transpose() * weights.asDiagonal() * arms / all;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    this->Axes = solver.eigenvectors().rowwise().reverse();
    this->Axes.col(2) = this->Axes.col(0).cross(this->Axes.col(1));
    this->Radii = solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
  }
  bool IsAmbiguous() const
  {
    return this->Radii[1] > LikeRadii * this->Radii[0] ||
      this->Radii[2] > LikeRadii * this->Radii[1];
  }
};

/// The 24 proper rotations that take axes to axes.
std::vector<Eigen::Matrix3d> AxisRotations()
{
  std::vector<Eigen::Matrix3d> rotations;
  std::array<int, 3> order{ 0, 1, 2 };
  do
  {
    for (int signs = 0; signs < 8; ++signs)
    {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
      for (int d = 0; d < 3; ++d)
      {
        rotation(order[static_cast<std::size_t>(d)], d) = (signs >> d & 1) != 0 ? -1.0 : 1.0;
      }
      if (rotation.determinant() > 0.0)
      {
        rotations.push_back(rotation);
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  // the identity and half turns first: they are the likely ones
  std::stable_sort(rotations.begin(), rotations.end(),
    [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b)
    { return a.diagonal().cwiseAbs().sum() > b.diagonal().cwiseAbs().sum(); });
  return rotations;
}

/// Whether the points determine a motion.
Status CheckExtent(const PointMatrix& points)
{
  const Moments moments(points, Eigen::VectorXd::Ones(points.rows()));
  if (!(moments.Radii[1] > 1e-6 * moments.Radii[0]))
  {
    return { ErrorCode::SingularSystem,
      "the " + std::to_string(points.rows()) +
        " points of the scan lie on one line: three that do not are needed" };
  }
  return {};
}

/// Points as dense as their weights say: every sum of weights that is a multiple of a step.
PointMatrix EvenSubset(const PointMatrix& points, const Eigen::VectorXd& weights)
{
  const double step = weights.sum() / SpreadSamples;
  std::vector<Eigen::Index> taken;
  double sum = 0.0;
  double next = 0.5 * step;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    sum += weights[i];
    if (sum >= next)
    {
      taken.push_back(i);
      next = std::max(next + step, sum);
    }
  }
  PointMatrix subset(static_cast<Eigen::Index>(taken.size()), 3);
  for (std::size_t i = 0; i < taken.size(); ++i)
  {
    subset.row(static_cast<Eigen::Index>(i)) = points.row(taken[i]);
  }
  return subset;
}

/// Leaves out points that are far from most; half of the others are nearer than the result.
double DropFar(PointMatrix& points, Eigen::VectorXd& weights, bool isMesh)
{
  const PointMatrix even = isMesh ? EvenSubset(points, weights) : points;
  const double radius = RadiusOf(even);
  const Eigen::RowVector3d middle = MedianOf(even);
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if ((points.row(i) - middle).norm() <= FarRadii * radius)
    {
      points.row(kept) = points.row(i);
      weights[kept++] = weights[i];
    }
  }
  points.conservativeResize(kept, 3);
  weights.conservativeResize(kept);
  return radius;
}
}

PointMatrix SubsetOf(const PointMatrix& points, Eigen::Index atMost)
{
  if (points.rows() <= atMost)
  {
    return points;
  }
  constexpr double golden = 0.6180339887498949;
  PointMatrix subset(atMost, points.cols());
  for (Eigen::Index i = 0; i < atMost; ++i)
  {
    const double jitter = std::fmod(static_cast<double>(i) * golden, 1.0);
    const double share = (static_cast<double>(i) + jitter) / static_cast<double>(atMost);
    subset.row(i) = points.row(std::min(
      points.rows() - 1, static_cast<Eigen::Index>(share * static_cast<double>(points.rows()))));
  }
  return subset;
}

double AlignmentSamples::Between(const RigidMotion& a, const RigidMotion& b) const
{
  const double angle = Eigen::AngleAxisd(a.Rotation * b.Rotation.transpose()).angle();
  const Eigen::Vector3d shift = a.Rotation * this->MiddleOfScan + a.Translation -
    b.Rotation * this->MiddleOfScan - b.Translation;
  return 0.5 * this->Size * angle + shift.norm();
}

Result<AlignmentSamples> SampleForAlignment(
  const TriangleMesh& scan, const FitTarget& target, int numPoints)
{
  if (Status status = CheckExtent(scan.Points); !status)
  {
    return status;
  }
  if (!target.HasSurface())
  {
    return { ErrorCode::EmptyInput,
      "the target has no faces: give triangles, spline surfaces, a CAD file or a volume" };
  }
  AlignmentSamples found;
  const TargetSamples samples = target.Samples(SpreadSamples);
  const PointMatrix& points = samples.Points;
  found.Size =
    points.rows() > 0 ? (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm() : 0.0;
  if (!(found.Size > 0.0) || !(samples.Areas.sum() > 0.0))
  {
    return { ErrorCode::EmptyInput, "the target has no extent: its faces have no area" };
  }
  found.IsMesh = !scan.Triangles.empty();
  PointMatrix spread = scan.Points;
  Eigen::VectorXd weights;
  if (found.IsMesh)
  {
    TriangleSamples own = SampleTriangles(scan.Points, scan.Triangles, SpreadSamples);
    spread = std::move(own.Points);
    weights = std::move(own.Areas);
  }
  found.IsMesh = found.IsMesh && weights.sum() > 0.0;
  if (!found.IsMesh)
  {
    spread = SubsetOf(scan.Points, SpreadSamples);
    weights = DensityWeights(spread);
  }
  const double targetRadius = RadiusOf(EvenSubset(points, samples.Areas));
  const double ratio = DropFar(spread, weights, found.IsMesh) / targetRadius;
  if (ratio > LargestRatio || ratio < LeastRatio)
  {
    return { ErrorCode::InvalidParameter,
      "the scan is " + Digits(ratio, 3) +
        " times as large as the target: give both in the same unit" };
  }
  found.SizeRatio = ratio;
  const Moments ofScan(spread, weights);
  const Moments ofTarget(points, samples.Areas);
  found.Spread = Ordered(found.IsMesh ? EvenSubset(spread, weights) : spread);
  found.Points = Ordered(SubsetOf(scan.Points, numPoints));
  for (const Eigen::Matrix3d& turn : AxisRotations())
  {
    found.Rotations.push_back(ofTarget.Axes * turn * ofScan.Axes.transpose());
  }
  found.AreAxesAmbiguous = ofScan.IsAmbiguous() || ofTarget.IsAmbiguous();
  found.MiddleOfScan = ofScan.Middle;
  found.MiddleOfTarget = ofTarget.Middle;
  found.TargetSpread = Ordered(EvenSubset(points, samples.Areas));
  return found;
}
}
