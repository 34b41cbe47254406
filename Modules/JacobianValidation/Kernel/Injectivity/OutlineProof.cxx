// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineProof.h"

#include "HullsApart.h"
#include "PlaneJacobian.h"

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;

bool IsOnLeft(const DiskFacet& facet)
{
  const CellShape shape = facet.Lattice->Shape;
  const auto from = CornerParameters(shape, facet.Ends[0]);
  const auto to = CornerParameters(shape, facet.Ends[1]);
  double sum = 0.0;
  for (int c = 0; c < NumCorners(shape); ++c)
  {
    const auto at = CornerParameters(shape, c);
    sum += (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]);
  }
  return sum > 0.0;
}

Vector NormalOf(const PieceMeasures& measures, const DiskFacet& facet)
{
  const CellLattice& lattice = *facet.Lattice;
  const auto corner = [&](std::size_t c)
  { return measures.PointOf(*facet.Piece, lattice.Corners[c]); };
  return lattice.Corners.size() == 3 ? Vector((corner(1) - corner(0)).cross(corner(2) - corner(0)))
                                     : Vector((corner(3) - corner(0)).cross(corner(2) - corner(1)));
}

/// Neighbours in the first and the second parameter of a surface.
template <typename Function>
void ForEachStep(const CellLattice& lattice, const Function& function)
{
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (const auto& line : lattice.Directions[d].Lines)
    {
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        function(line[i], line[i + 1], d == 0);
      }
    }
  }
}

bool HasPositiveProjection(const PieceMeasures& measures, const DiskFacet& facet,
  const Vector& alpha, const Vector& beta, double orientation)
{
  const CellLattice& lattice = *facet.Lattice;
  const BoundaryPiece& node = *facet.Piece;
  const double* data = node.Piece.Data.data();
  const int n = lattice.Size;
  const std::size_t size = static_cast<std::size_t>(n);
  // relative to the middle and of size one, by a power of two
  const Vector centre = measures.Centre(node);
  const double scale = std::ldexp(1.0, -std::ilogb(std::max(node.Size, 1e-280)));
  PlanePiece plane;
  plane.Shape = lattice.Shape;
  plane.Degree = lattice.Degree;
  plane.X.resize(size);
  plane.Y.resize(size);
  double largestWeight = 1.0;
  double largest = 0.0;
  if (measures.Input.Rational)
  {
    plane.W.assign(data + 3 * n, data + 4 * n);
    plane.WeightError = node.Piece.Error;
    largestWeight = *std::max_element(plane.W.begin(), plane.W.end());
  }
  for (int i = 0; i < n; ++i)
  {
    const double w = measures.Input.Rational ? plane.W[static_cast<std::size_t>(i)] : 1.0;
    Vector x;
    for (int d = 0; d < 3; ++d)
    {
      x[d] = data[d * n + i] - centre[d] * w;
      largest = std::max(largest, std::abs(data[d * n + i]));
    }
    plane.X[static_cast<std::size_t>(i)] = scale * alpha.dot(x);
    plane.Y[static_cast<std::size_t>(i)] = scale * beta.dot(x);
  }
  const double far = centre.cwiseAbs().maxCoeff();
  plane.Error = scale * std::max(OneNorm(alpha), OneNorm(beta)) *
    (node.Piece.Error * (measures.Input.Rational ? 1.0 + far : 1.0) +
      8.0 * UnitRoundoff * (largest + far * largestWeight)) *
    (1.0 + 1e-9);
  if (!measures.Input.Rational)
  {
    plane.SameNextS.assign(size, false);
    plane.SameNextT.assign(size, false);
    ForEachStep(lattice,
      [&](int i, int j, bool alongS)
      {
        auto& same = alongS ? plane.SameNextS : plane.SameNextT;
        same[static_cast<std::size_t>(i)] = measures.IsOnePoint(node, i, j);
      });
  }
  return HasPositiveInside(plane, orientation);
}

/// An edge of a facet in the plane.
struct OutlineEdge
{
  CellLattice Lattice;
  BoundaryPiece Curve; ///< third coordinate 0
  std::array<int, 2> Corners{};
};

/// Coordinates in a plane, relative to a point beside the pieces, so that they are as small as
/// those.
struct Projection
{
  Vector Alpha;
  Vector Beta;
  Vector Origin;
  double Largest; ///< coordinate of the pieces
};

/// @return false when points that are apart become one in the plane.
bool ProjectEdge(const PieceMeasures& measures, const DiskFacet& facet, int number,
  const Projection& plane, OutlineEdge& edge)
{
  const CellLattice& lattice = *facet.Lattice;
  const BoundaryPiece& node = *facet.Piece;
  const auto ends = SideEdge(lattice.Shape, number);
  const int first = lattice.Corners[static_cast<std::size_t>(ends[0])];
  const int last = lattice.Corners[static_cast<std::size_t>(ends[1])];
  std::vector<int> line;
  for (const auto& direction : lattice.Directions)
  {
    for (const auto& some : direction.Lines)
    {
      if (some.front() == first && some.back() == last)
      {
        line = some;
      }
      else if (some.front() == last && some.back() == first)
      {
        line.assign(some.rbegin(), some.rend());
      }
    }
  }
  if (line.empty())
  {
    return false;
  }
  const int degree = static_cast<int>(line.size()) - 1;
  edge.Lattice = CellLattice(CellShape::Curve, { degree, 0, 0 });
  PieceHull& hull = edge.Curve.Hull;
  hull.NumComponents = 3;
  hull.Error = std::max(OneNorm(plane.Alpha), OneNorm(plane.Beta)) *
    (node.Hull.Error + 8.0 * UnitRoundoff * plane.Largest) * (1.0 + 1e-9);
  hull.Lower.fill(std::numeric_limits<double>::infinity());
  hull.Upper.fill(-std::numeric_limits<double>::infinity());
  for (const int i : line)
  {
    const Vector x = measures.PointOf(node, i) - plane.Origin;
    const Vector y(plane.Alpha.dot(x), plane.Beta.dot(x), 0.0);
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double value = y[static_cast<Eigen::Index>(d)];
      hull.Points.push_back(value);
      hull.Lower[d] = std::min(hull.Lower[d], value - hull.Error);
      hull.Upper[d] = std::max(hull.Upper[d], value + hull.Error);
    }
  }
  edge.Curve.Size = std::max(hull.Upper[0] - hull.Lower[0], hull.Upper[1] - hull.Lower[1]);
  // tolerances are of the model's coordinates
  edge.Curve.Largest = plane.Largest;
  for (std::size_t i = 0; i < line.size(); ++i)
  {
    for (std::size_t j = i + 1; j < line.size(); ++j)
    {
      const int at[2] = { static_cast<int>(i), static_cast<int>(j) };
      const double distance =
        (measures.PointOf(edge.Curve, at[0]) - measures.PointOf(edge.Curve, at[1]))
          .cwiseAbs()
          .maxCoeff();
      if (distance <= 4.0 * measures.CollapseDistance(plane.Largest) &&
        !measures.IsOnePoint(node, line[i], line[j]))
      {
        return false;
      }
    }
  }
  return true;
}

bool IsOutlineSimple(const PieceMeasures& measures, const std::vector<DiskFacet>& facets,
  const Vector& alpha, const Vector& beta)
{
  Projection plane{ alpha, beta, measures.Centre(*facets[0].Piece), 0.0 };
  for (const DiskFacet& facet : facets)
  {
    plane.Largest = std::max(plane.Largest, facet.Piece->Largest);
  }
  std::vector<OutlineEdge> outline;
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    const CellShape shape = facets[k].Lattice->Shape;
    for (int e = 0; e < NumSideEdges(shape); ++e)
    {
      if (e == facets[k].Edge)
      {
        continue;
      }
      OutlineEdge edge;
      if (!ProjectEdge(measures, facets[k], e, plane, edge) ||
        !measures.IsMonotoneCurve(edge.Curve))
      {
        return false;
      }
      for (std::size_t end = 0; end < 2; ++end)
      {
        const int corner = SideEdge(shape, e)[end];
        // the second piece's corners on the common edge are the first one's
        edge.Corners[end] = k == 0      ? corner
          : corner == facets[1].Ends[0] ? facets[0].Ends[0]
          : corner == facets[1].Ends[1] ? facets[0].Ends[1]
                                        : 4 + corner;
      }
      outline.push_back(std::move(edge));
    }
  }
  for (std::size_t i = 0; i < outline.size(); ++i)
  {
    for (std::size_t j = i + 1; j < outline.size(); ++j)
    {
      const OutlineEdge& a = outline[i];
      const OutlineEdge& b = outline[j];
      int shared = 0;
      std::array<PieceCone, 2> cones{ { { &a.Lattice, &a.Curve, 0 },
        { &b.Lattice, &b.Curve, 0 } } };
      for (int p = 0; p < 2; ++p)
      {
        for (int q = 0; q < 2; ++q)
        {
          if (a.Corners[static_cast<std::size_t>(p)] == b.Corners[static_cast<std::size_t>(q)])
          {
            ++shared;
            cones[0].Corner = p;
            cones[1].Corner = q;
          }
        }
      }
      const bool apart = shared == 0
        ? HullsApart(measures, { &a.Lattice, &a.Curve, 0 }, { &b.Lattice, &b.Curve, 0 })
        : shared == 1 && ConesApart(measures, cones);
      if (!apart)
      {
        return false;
      }
    }
  }
  return true;
}
}

bool HaveOutline(const PieceMeasures& measures, const std::vector<DiskFacet>& facets)
{
  std::array<double, 2> orientation{ 1.0, 1.0 };
  Vector normal = Vector::Zero();
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    const DiskFacet& facet = facets[k];
    if (facet.Edge >= 0)
    {
      // one piece on the left of the common edge, the other one on its right
      orientation[k] = (k == 0) == IsOnLeft(facet) ? 1.0 : -1.0;
    }
    const Vector n = NormalOf(measures, facet);
    const double length = n.norm();
    if (!(length > 0.0))
    {
      return false;
    }
    normal += orientation[k] / length * n;
  }
  const double length = normal.norm();
  if (!(length > 0x1p-20))
  {
    return false;
  }
  normal /= length;
  Eigen::Index axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Vector alpha = normal.cross(Vector::Unit(axis)).normalized();
  const Vector beta = normal.cross(alpha);
  for (std::size_t k = 0; k < facets.size(); ++k)
  {
    if (!HasPositiveProjection(measures, facets[k], alpha, beta, orientation[k]))
    {
      return false;
    }
  }
  return IsOutlineSimple(measures, facets, alpha, beta);
}
}
