// SPDX-License-Identifier: BSD-3-Clause
#include "SidePieces.h"

#include <Eigen/Geometry>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;
}

Vector PieceMeasures::Centre(const BoundaryPiece& node) const
{
  Vector c = Vector::Zero();
  for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
  {
    c[static_cast<Eigen::Index>(d)] = 0.5 * (node.Hull.Lower[d] + node.Hull.Upper[d]);
  }
  return c;
}

bool PieceMeasures::IsOnePoint(const BoundaryPiece& node, int i, int j) const
{
  return this->Input.CollapseTolerance > 0.0 &&
    (this->PointOf(node, i) - this->PointOf(node, j)).cwiseAbs().maxCoeff() <=
    std::min(node.Size * 1e-6, this->CollapseDistance(node.Largest));
}

bool PieceMeasures::IsCollapsed(
  const CellLattice& lattice, const BoundaryPiece& node, int edge) const
{
  const auto ends = SideEdge(lattice.Shape, edge);
  const double tolerance = std::min(node.Size * 1e-6, this->CollapseDistance(node.Largest));
  for (const auto& direction : lattice.Directions)
  {
    for (const auto& line : direction.Lines)
    {
      const int first = lattice.Corners[static_cast<std::size_t>(ends[0])];
      const int last = lattice.Corners[static_cast<std::size_t>(ends[1])];
      if ((line.front() == first && line.back() == last) ||
        (line.front() == last && line.back() == first))
      {
        return std::all_of(line.begin(), line.end(),
          [&](int i)
          {
            return (this->PointOf(node, i) - this->PointOf(node, first)).cwiseAbs().maxCoeff() <=
              tolerance;
          });
      }
    }
  }
  return false;
}

void PieceMeasures::Complete(const CellLattice& lattice, BoundaryPiece& node) const
{
  node.Hull = MakeHull(lattice, this->Input.NumComponents, this->Input.Rational, node.Piece);
  for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
  {
    node.Size = std::max(node.Size, node.Hull.Upper[d] - node.Hull.Lower[d]);
    node.Largest =
      std::max({ node.Largest, std::abs(node.Hull.Lower[d]), std::abs(node.Hull.Upper[d]) });
  }
}

PieceSlopes PieceMeasures::MakeSlopes(
  const CellLattice& lattice, const BoundaryPiece& node, int from, int to) const
{
  PieceSlopes slopes;
  slopes.Of = &node;
  const Vector centre = this->Centre(node);
  const double* data = node.Piece.Data.data();
  const int n = lattice.Size;
  const int components = this->Input.NumComponents;
  const double* weights = this->Input.Rational ? data + components * n : nullptr;
  for (const auto& direction : lattice.Directions)
  {
    double sign = 0.0;
    for (const auto& pair : direction.CornerPairs)
    {
      sign = pair[0] == from && pair[1] == to ? 1.0
        : pair[1] == from && pair[0] == to    ? -1.0
                                              : sign;
    }
    if (sign == 0.0)
    {
      continue;
    }
    double largest = 0.0;
    for (const auto& line : direction.Lines)
    {
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        const int a = line[i];
        const int b = line[i + 1];
        const double dw = weights ? weights[b] - weights[a] : 0.0;
        Vector x = Vector::Zero();
        for (int d = 0; d < components; ++d)
        {
          x[d] = sign * ((data[d * n + b] - data[d * n + a]) - centre[d] * dw);
          largest = std::max({ largest, std::abs(data[d * n + a]), std::abs(data[d * n + b]) });
        }
        slopes.Differences.push_back(x);
        slopes.Mean += x;
        slopes.WeightSlope = std::max(slopes.WeightSlope, std::abs(dw));
      }
    }
    slopes.Rounding =
      (weights ? 2.0 * node.Piece.Error * (1.0 + node.Largest) : 2.0 * node.Piece.Error) +
      8.0 * UnitRoundoff * (largest + (weights ? node.Largest * slopes.WeightSlope : 0.0));
    if (weights)
    {
      slopes.WeightSlope += 2.0 * node.Piece.Error + UnitRoundoff * slopes.WeightSlope;
    }
    slopes.Mean /= static_cast<double>(slopes.Differences.size());
    break;
  }
  return slopes;
}

FunctionalRange PieceMeasures::RangeOf(const Vector& functional, const PieceSlopes& slopes) const
{
  FunctionalRange range;
  double largest = 0.0;
  for (const Vector& x : slopes.Differences)
  {
    range.Add(functional.dot(x));
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  double wide = OneNorm(functional) * (slopes.Rounding + 8.0 * UnitRoundoff * largest);
  if (slopes.WeightSlope > 0.0)
  {
    // S - c: half the box
    double reach = 0.0;
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
    {
      reach += std::abs(functional[static_cast<Eigen::Index>(d)]) * 0.5 *
        (slopes.Of->Hull.Upper[d] - slopes.Of->Hull.Lower[d]);
    }
    wide += reach * slopes.WeightSlope;
  }
  range.Widen(wide * (1.0 + 1e-9));
  return range;
}

PieceTurn PieceMeasures::FindTurn(const CellLattice& lattice, const BoundaryPiece& node) const
{
  if (lattice.Shape != CellShape::Quadrilateral)
  {
    return {};
  }
  std::array<Vector, 4> normals;
  for (int c = 0; c < NumCorners(lattice.Shape); ++c)
  {
    std::array<Vector, 2> slopes{ Vector::Zero(), Vector::Zero() };
    int found = 0;
    for (const auto& direction : lattice.Directions)
    {
      for (const auto& line : direction.Lines)
      {
        const int corner = lattice.Corners[static_cast<std::size_t>(c)];
        const bool first = line.front() == corner;
        if (found < 2 && (first || line.back() == corner))
        {
          const int next = first ? line[1] : line[line.size() - 2];
          if (!this->IsOnePoint(node, next, corner))
          {
            slopes[static_cast<std::size_t>(found)] =
              (first ? 1.0 : -1.0) * (this->PointOf(node, next) - this->PointOf(node, corner));
          }
          ++found;
        }
      }
    }
    normals[static_cast<std::size_t>(c)] = slopes[0].cross(slopes[1]).stableNormalized();
  }
  PieceTurn most;
  for (std::size_t d = 0; d < lattice.Directions.size(); ++d)
  {
    double turn = 0.0;
    for (const auto& pair : lattice.Directions[d].CornerPairs)
    {
      const Vector& from = normals[static_cast<std::size_t>(pair[0])];
      const Vector& to = normals[static_cast<std::size_t>(pair[1])];
      // none at a pole, and where the piece stands still
      if (!from.isZero() && !to.isZero())
      {
        turn = std::max(turn, (from - to).norm());
      }
    }
    if (turn > most.Size)
    {
      most = { static_cast<int>(d), turn };
    }
  }
  return most;
}

bool PieceMeasures::IsMonotoneCurve(const BoundaryPiece& a) const
{
  const int n = static_cast<int>(a.Hull.Points.size()) / a.Hull.NumComponents;
  const Vector along = this->PointOf(a, n - 1) - this->PointOf(a, 0);
  const double margin =
    OneNorm(along) * (2.0 * a.Hull.Error + 8.0 * UnitRoundoff * a.Largest) * (1.0 + 1e-9);
  bool moves = false;
  for (int i = 0; i + 1 < n; ++i)
  {
    if (this->IsOnePoint(a, i, i + 1))
    {
      continue;
    }
    if (!(along.dot(this->PointOf(a, i + 1) - this->PointOf(a, i)) > margin))
    {
      return false;
    }
    moves = true;
  }
  return moves;
}
}
