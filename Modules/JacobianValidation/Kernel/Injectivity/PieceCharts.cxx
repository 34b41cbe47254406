// SPDX-License-Identifier: BSD-3-Clause
#include "PieceCharts.h"

#include "HullsApart.h"
#include "OutlineProof.h"
#include "PolarChart.h"

#include <Eigen/Dense>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;

std::size_t At(int k)
{
  return static_cast<std::size_t>(k);
}

/// A map g of the plane with derivatives in these ranges is one-to-one on convex sets: after
/// scaling one of its components its derivative has a positive definite symmetric part.
bool IsMonotone(const FunctionalRange& ss, const FunctionalRange& st, const FunctionalRange& ts,
  const FunctionalRange& tt)
{
  return ss.Low > 0.0 && tt.Low > 0.0 && ss.Low * tt.Low > st.Size() * ts.Size() * (1.0 + 1e-9);
}
}

bool HasChart(const PieceMeasures& measures, const CellLattice& lattice, const BoundaryPiece& a)
{
  const CellShape shape = lattice.Shape;
  if (shape == CellShape::Curve)
  {
    return measures.IsMonotoneCurve(a);
  }
  const PieceSlopes s = measures.MakeSlopes(lattice, a, 0, 1);
  const PieceSlopes t = measures.MakeSlopes(lattice, a, 0, 2);
  Eigen::Matrix<double, 3, 2> frame;
  frame << s.Mean, t.Mean;
  const Eigen::Matrix2d gram = frame.transpose() * frame;
  if (gram.determinant() > 0.0)
  {
    const Eigen::Matrix<double, 2, 3> dual = gram.inverse() * frame.transpose();
    const Vector alpha = dual.row(0);
    const Vector beta = dual.row(1);
    if (dual.allFinite() &&
      IsMonotone(measures.RangeOf(alpha, s), measures.RangeOf(alpha, t), measures.RangeOf(beta, s),
        measures.RangeOf(beta, t)))
    {
      return true;
    }
  }
  for (int e = 0; e < NumSideEdges(shape); ++e)
  {
    if (shape == CellShape::Quadrilateral && measures.IsCollapsed(lattice, a, e))
    {
      const auto ends = SideEdge(shape, e);
      return HavePolarChart(measures, { { &lattice, &a, ends[0], ends[1] } });
    }
  }
  return HaveOutline(measures, { { &lattice, &a, -1, {} } });
}

bool HaveChart(const PieceMeasures& measures, const std::array<const CellLattice*, 2>& lattices,
  const PieceRelation& relation, const BoundaryPiece& a, const BoundaryPiece& b)
{
  const CellShape shapes[2] = { lattices[0]->Shape, lattices[1]->Shape };
  std::array<int, 2> ends[2] = { SideEdge(shapes[0], relation.A), SideEdge(shapes[1], relation.B) };
  if (relation.Reversed)
  {
    std::swap(ends[1][0], ends[1][1]);
  }
  // the corner across from the edge's first one
  const auto across = [](CellShape shape, const std::array<int, 2>& edge)
  {
    return shape == CellShape::Triangle ? 3 - edge[0] - edge[1]
                                        : 3 - edge[1]; // opposite of the edge's second corner
  };
  const PieceSlopes s[2] = { measures.MakeSlopes(*lattices[0], a, ends[0][0], ends[0][1]),
    measures.MakeSlopes(*lattices[1], b, ends[1][0], ends[1][1]) };
  const PieceSlopes t[2] = { measures.MakeSlopes(
                               *lattices[0], a, ends[0][0], across(shapes[0], ends[0])),
    measures.MakeSlopes(*lattices[1], b, ends[1][0], across(shapes[1], ends[1])) };
  const Vector along = s[0].Mean + s[1].Mean;
  const double square = along.squaredNorm();
  if (square > 0.0)
  {
    Vector away[2];
    double shear[2];
    for (int k = 0; k < 2; ++k)
    {
      shear[k] = along.dot(t[k].Mean) / square;
      away[k] = t[k].Mean - shear[k] * along;
    }
    const double na = away[0].norm();
    const double nb = away[1].norm();
    if (na > 0.0 && nb > 0.0)
    {
      const Vector beta = away[0] / na - away[1] / nb;
      const double ua = beta.dot(away[0]);
      const double ub = -beta.dot(away[1]);
      if (ua > 0.0 && ub > 0.0)
      {
        // alpha sees as little as possible of both shears
        const double gamma = -(shear[0] * ua - shear[1] * ub) / (ua * ua + ub * ub);
        const Vector alpha = along / square + gamma * beta;
        FunctionalRange ss;
        FunctionalRange st;
        FunctionalRange ts;
        FunctionalRange tt;
        const auto merge = [](FunctionalRange& to, const FunctionalRange& r, double sign)
        {
          to.Add(sign * r.Low);
          to.Add(sign * r.High);
        };
        for (int k = 0; k < 2; ++k)
        {
          const double sign = k == 0 ? 1.0 : -1.0;
          merge(ss, measures.RangeOf(alpha, s[k]), 1.0);
          merge(ts, measures.RangeOf(beta, s[k]), 1.0);
          merge(st, measures.RangeOf(alpha, t[k]), sign);
          merge(tt, measures.RangeOf(beta, t[k]), sign);
        }
        if (IsMonotone(ss, st, ts, tt))
        {
          return true;
        }
      }
    }
  }
  // Both may end in one point, where a collapsed edge meets the common one.
  const bool quadrilaterals =
    shapes[0] == CellShape::Quadrilateral && shapes[1] == CellShape::Quadrilateral;
  for (int end = 0; end < 2 && quadrilaterals; ++end)
  {
    int pole[2] = { -1, -1 };
    const BoundaryPiece* nodes[2] = { &a, &b };
    const int edges[2] = { relation.A, relation.B };
    for (int k = 0; k < 2; ++k)
    {
      for (int e = 0; e < 4; ++e)
      {
        const auto corners = SideEdge(shapes[k], e);
        if (e != edges[k] && (corners[0] == ends[k][end] || corners[1] == ends[k][end]) &&
          measures.IsCollapsed(*lattices[At(k)], *nodes[k], e))
        {
          pole[k] = e;
        }
      }
    }
    const auto polar = [&](int k)
    {
      const auto corners = SideEdge(shapes[k], pole[k]);
      return PolarPiece{ lattices[At(k)], nodes[k], ends[k][end],
        corners[0] == ends[k][end] ? corners[1] : corners[0] };
    };
    if (pole[0] >= 0 && pole[1] >= 0)
    {
      return HavePolarChart(measures, { polar(0), polar(1) });
    }
    if (pole[0] >= 0 || pole[1] >= 0)
    {
      // The other piece is regular there: cut along its diagonal, it is two with a collapsed
      // edge, one at the common edge, one that has the end alone in common.
      const int k = pole[0] >= 0 ? 0 : 1;
      const int apex = ends[1 - k][end];
      const int next = ends[1 - k][1 - end];
      const PieceHalf beside = MakeHalf(measures, *lattices[At(1 - k)], *nodes[1 - k], apex, next);
      const PieceHalf rest =
        MakeHalf(measures, *lattices[At(1 - k)], *nodes[1 - k], apex, 3 - next);
      const PolarPiece piece = polar(k);
      return HavePolarChart(measures, { piece, { &beside.Lattice, &beside.Piece, 0, 1 } }) &&
        ConesApart(measures,
          { { { piece.Lattice, piece.Piece, piece.From }, { &rest.Lattice, &rest.Piece, 0 } } });
    }
  }
  return HaveOutline(measures,
    { { lattices[0], &a, relation.A, ends[0] }, { lattices[1], &b, relation.B, ends[1] } });
}
}
