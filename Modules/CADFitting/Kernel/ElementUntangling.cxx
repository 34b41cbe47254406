// SPDX-License-Identifier: BSD-3-Clause
#include "ElementUntangling.h"

#include <knotwork/DomainParameterization/Minimize.h>
#include <knotwork/JacobianValidation/CellPieces.h>
#include <knotwork/SplineCore/LatticeInterpolation.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// Derivatives of the polynomials that belong to the points of a shape, at parameters.
Basis NodeDerivatives(const NodeLattice& lattice, CellShape shape, const double* parameters)
{
  const Eigen::MatrixXd& toBezier = lattice.Table(shape).ToBezier;
  const auto count = static_cast<int>(toBezier.rows());
  Eigen::VectorXd values(count);
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> derivatives(3, count);
  EvaluateCellBasis(
    shape, DegreeOf(shape, lattice.Order), parameters, values.data(), derivatives.data());
  return derivatives * toBezier;
}

/// An element with derivatives, at its samples, of its points' polynomials with respect to places
/// of the straight element; and what it adds to a sum.
struct ShapeElement
{
  int Element;
  std::vector<Basis> Gradients;
  double Energy = 0.0;
  Basis Slope; ///< of its points
};

Eigen::Matrix3d MapOf(
  const NodeLattice& lattice, int element, const Basis& gradients, const PointMatrix& points)
{
  const int* nodes = lattice.Nodes.data() + lattice.Begin[At(element)];
  Eigen::Matrix3d map = Eigen::Matrix3d::Zero(); // [component][direction]
  for (Eigen::Index i = 0; i < gradients.cols(); ++i)
  {
    map += points.row(nodes[i]).transpose() * gradients.col(i).transpose();
  }
  return map;
}

/// The energy of a map and its derivative.
double Density(const Eigen::Matrix3d& map, double epsilon, Eigen::Matrix3d& slope)
{
  const double det = map.determinant();
  const double root = std::sqrt(epsilon * epsilon + det * det);
  const double c = det > 0.0 ? 0.5 * (det + root) : 0.5 * epsilon * epsilon / (root - det);
  const double cSlope = c / root; // dc / d det
  const double shape = map.squaredNorm() / std::cbrt(c * c);
  const double size = (det * det + 1.0) / c;
  Eigen::Matrix3d cofactors; // d det / d map
  for (Eigen::Index d = 0; d < 3; ++d)
  {
    const Eigen::Vector3d next = map.col((d + 1) % 3);
    cofactors.col(d) = next.cross(Eigen::Vector3d(map.col((d + 2) % 3)));
  }
  const double byDet = -2.0 / 3.0 * shape / c * cSlope + 2.0 * det / c - size / c * cSlope;
  slope = 2.0 / std::cbrt(c * c) * map + byDet * cofactors;
  return shape + size;
}

/// Without samples at which the straight element is not valid.
std::vector<ShapeElement> MakeElements(
  const NodeLattice& lattice, const std::vector<int>& elements, const PointMatrix& straight)
{
  std::map<CellShape, std::vector<Basis>> bases;
  std::vector<ShapeElement> made;
  for (const int element : elements)
  {
    const CellShape shape = lattice.Shapes[At(element)];
    std::vector<Basis>& ofShape = bases[shape];
    if (ofShape.empty())
    {
      for (const auto& parameters : LatticeParameters(shape, DegreeOf(shape, lattice.Order + 1)))
      {
        ofShape.push_back(NodeDerivatives(lattice, shape, parameters.data()));
      }
    }
    made.push_back({ element, {}, 0.0, {} });
    for (const Basis& basis : ofShape)
    {
      const Eigen::Matrix3d ideal = MapOf(lattice, element, basis, straight);
      if (ideal.determinant() > 0.0)
      {
        made.back().Gradients.emplace_back(ideal.inverse().transpose() * basis);
      }
    }
  }
  return made;
}

void Evaluate(
  const NodeLattice& lattice, const PointMatrix& points, double epsilon, ShapeElement& element)
{
  element.Energy = 0.0;
  element.Slope =
    Basis::Zero(3, lattice.Table(lattice.Shapes[At(element.Element)]).ToBezier.rows());
  for (const Basis& gradients : element.Gradients)
  {
    Eigen::Matrix3d slope;
    element.Energy += Density(MapOf(lattice, element.Element, gradients, points), epsilon, slope);
    element.Slope += slope * gradients;
  }
}
}

double CornerDeterminant(const NodeLattice& lattice, const PointMatrix& straight, int element)
{
  const CellShape shape = lattice.Shapes[At(element)];
  double least = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < NumCorners(shape); ++corner)
  {
    const auto parameters = CornerParameters(shape, corner);
    const Basis basis = NodeDerivatives(lattice, shape, parameters.data());
    least = std::min(least, MapOf(lattice, element, basis, straight).determinant());
  }
  return least;
}

Status UntangleInside(const NodeLattice& lattice, const std::vector<int>& elements,
  const PointMatrix& straight, const std::vector<char>& isFree, int threads,
  const ProgressCallback& progress, PointMatrix& points)
{
  std::vector<ShapeElement> parts = MakeElements(lattice, elements, straight);
  std::vector<int> free;
  std::vector<Eigen::Index> unknownOf(isFree.size(), -1);
  for (std::size_t node = 0; node < isFree.size(); ++node)
  {
    if (isFree[node] != 0)
    {
      unknownOf[node] = static_cast<Eigen::Index>(3 * free.size());
      free.push_back(static_cast<int>(node));
    }
  }
  // unknowns in lengths of about an element
  const PointMatrix places = straight(free, Eigen::all);
  const double extent = (places.colwise().maxCoeff() - places.colwise().minCoeff()).norm();
  const double scale =
    extent > 0.0 ? extent / std::cbrt(static_cast<double>(elements.size())) : 1.0;
  const PointMatrix begin = points;
  const auto take = [&](const Eigen::VectorXd& x)
  {
    for (std::size_t i = 0; i < free.size(); ++i)
    {
      points.row(free[i]) =
        begin.row(free[i]) + scale * x.segment<3>(static_cast<Eigen::Index>(3 * i)).transpose();
    }
  };
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * free.size()));
  bool isStopped = false;
  for (const double epsilon : { 0.3, 0.1, 0.03, 0.01 })
  {
    const auto energy = [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient)
    {
      take(at);
      ParallelFor(parts.size(), 64, threads,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t i = first; i < last; ++i)
          {
            Evaluate(lattice, points, epsilon, parts[i]);
          }
        });
      gradient = Eigen::VectorXd::Zero(at.size());
      double sum = 0.0;
      for (const ShapeElement& part : parts) // in their order, for any number of threads
      {
        sum += part.Energy;
        const int* nodes = lattice.Nodes.data() + lattice.Begin[At(part.Element)];
        for (Eigen::Index i = 0; i < part.Slope.cols(); ++i)
        {
          if (const Eigen::Index unknown = unknownOf[At(nodes[i])]; unknown >= 0)
          {
            gradient.segment<3>(unknown) += scale * part.Slope.col(i);
          }
        }
      }
      return sum;
    };
    MinimizeParams params;
    params.MaxIterations = 100;
    params.EnergyTolerance = 1e-4;
    MinimizeLbfgs(x, energy, params, {},
      [&](const MinimizeState&)
      {
        isStopped = isStopped || (progress && !progress(0.5));
        return !isStopped;
      });
    if (isStopped)
    {
      return { ErrorCode::Aborted, "" };
    }
  }
  take(x);
  return {};
}
}
