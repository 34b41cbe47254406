// SPDX-License-Identifier: BSD-3-Clause
#include "PreimageProof.h"

#include <Eigen/Dense>

#include <cmath>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;

/// F(x) = N(x) - y W(x) of one cell, as coefficients.
struct Equations
{
  int Dim = 2;
  Eigen::MatrixXd Coefficients; ///< n x Dim
  double Largest = 0.0;         ///< of what the coefficients are made of
  double Rounding = 0.0;        ///< of every coefficient, the image's error included
};

Equations MakeEquations(
  const BernsteinCells& cells, const CellLattice& lattice, int cell, const ImagePoint& image)
{
  Equations f;
  f.Dim = cells.NumComponents;
  const int n = lattice.Size;
  f.Coefficients.resize(n, f.Dim);
  const double* data = cells.Block(cell);
  double largestWeight = 1.0;
  double largestPosition = 0.0;
  for (int c = 0; c < f.Dim; ++c)
  {
    const double y = image.Position[static_cast<std::size_t>(c)];
    largestPosition = std::max(largestPosition, std::abs(y));
    for (int i = 0; i < n; ++i)
    {
      const double w = cells.Rational ? data[f.Dim * n + i] : 1.0;
      f.Coefficients(i, c) = data[c * n + i] - y * w;
      f.Largest = std::max(f.Largest, std::abs(data[c * n + i]) + std::abs(y * w));
      largestWeight = std::max(largestWeight, w);
    }
  }
  const double stored = cells.Errors.empty() ? 0.0 : cells.Errors[static_cast<std::size_t>(cell)];
  f.Rounding = (3.0 * UnitRoundoff * f.Largest + image.Error * largestWeight +
                 stored * (1.0 + (cells.Rational ? largestPosition + image.Error : 0.0))) *
    (1.0 + 1e-9);
  return f;
}

struct Linearized
{
  Eigen::Vector3d Value = Eigen::Vector3d::Zero();
  Eigen::Matrix3d Slope = Eigen::Matrix3d::Identity();
};

Linearized Linearize(const CellLattice& lattice, const Equations& f, const double* u)
{
  const int n = lattice.Size;
  std::vector<double> basis(static_cast<std::size_t>(n * (1 + f.Dim)));
  EvaluateCellBasis(lattice.Shape, lattice.Degree, u, basis.data(), basis.data() + n);
  const Eigen::Map<const Eigen::MatrixXd> b(basis.data(), n, 1 + f.Dim);
  const Eigen::MatrixXd product = f.Coefficients.transpose() * b; // Dim x (1 + Dim)
  Linearized l;
  l.Value.head(f.Dim) = product.col(0);
  l.Slope.topLeftCorner(f.Dim, f.Dim) = product.rightCols(f.Dim);
  return l;
}

/// Bounds of the second derivatives of F's components: differences of differences, times degrees.
/// Row: component; summed over both parameters.
Eigen::Vector3d SecondDerivatives(const CellLattice& lattice, const Equations& f)
{
  const int n = lattice.Size;
  std::vector<const CellLattice::Direction*> along;
  std::vector<double> factor;
  for (int d = 0; d < f.Dim; ++d)
  {
    const std::size_t at = static_cast<std::size_t>(d);
    along.push_back(&lattice.Directions[lattice.Shape == CellShape::Wedge && d == 2 ? 3 : at]);
    factor.push_back(lattice.Degree[at]);
  }
  std::vector<std::vector<int>> next(
    static_cast<std::size_t>(f.Dim), std::vector<int>(static_cast<std::size_t>(n), -1));
  for (std::size_t d = 0; d < along.size(); ++d)
  {
    for (const auto& line : along[d]->Lines)
    {
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        next[d][static_cast<std::size_t>(line[i])] = line[i + 1];
      }
    }
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t d = 0; d < next.size(); ++d)
  {
    for (std::size_t e = 0; e < next.size(); ++e)
    {
      for (int c = 0; c < f.Dim; ++c)
      {
        double largest = 0.0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
        {
          const int right = next[d][i];
          const int up = next[e][i];
          if (right < 0 || up < 0 || next[e][static_cast<std::size_t>(right)] < 0)
          {
            continue;
          }
          const int both = next[e][static_cast<std::size_t>(right)];
          largest = std::max(largest,
            std::abs((f.Coefficients(both, c) - f.Coefficients(up, c)) -
              (f.Coefficients(right, c) - f.Coefficients(static_cast<Eigen::Index>(i), c))));
        }
        sum[c] += factor[d] * factor[e] * (largest + 4.0 * f.Rounding);
      }
    }
  }
  return sum * (1.0 + 1e-9);
}

double LargestOf(const Eigen::Vector3d& v, int n)
{
  double largest = v[0];
  for (int i = 1; i < n; ++i)
  {
    largest = std::max(largest, v[i]);
  }
  return largest;
}

/// |I - Y F'(x')| <= Start + Growth * |x' - x|, and |Y F(x)| <= Step.
struct Contraction
{
  double Start = 1.0;
  double Growth = 0.0;
  double Step = 0.0;
};

Contraction Contract(const CellLattice& lattice, const Equations& f, const Linearized& l)
{
  Contraction c;
  const Eigen::Matrix3d y = l.Slope.inverse();
  if (!y.allFinite())
  {
    return c;
  }
  const Eigen::Matrix3d size = y.cwiseAbs();
  const int degrees = lattice.Degree[0] + lattice.Degree[1] + lattice.Degree[2];
  // rounding of values and slopes of Bernstein sums
  const double value =
    (f.Rounding + (16.0 + 8.0 * degrees + lattice.Size) * UnitRoundoff * f.Largest);
  const double slope = 4.0 * degrees * value;
  const Eigen::Vector3d ones(1.0, f.Dim > 1 ? 1.0 : 0.0, f.Dim > 2 ? 1.0 : 0.0);
  const Eigen::Matrix3d rest = (Eigen::Matrix3d::Identity() - y * l.Slope).cwiseAbs();
  c.Start = (LargestOf(rest * ones, f.Dim) + 1e-13 + LargestOf(size * ones, f.Dim) * f.Dim * slope);
  c.Growth = LargestOf(size * SecondDerivatives(lattice, f), f.Dim) * (1.0 + 1e-9);
  const Eigen::Vector3d v = (y * l.Value).cwiseAbs() + size * ones * value;
  c.Step = LargestOf(v, f.Dim) * (1.0 + 1e-9);
  return c;
}

/// The box of half width r around x lies in the shape's parameter domain.
bool IsInside(CellShape shape, const std::array<double, 3>& x, double r)
{
  const int dim = NumParameters(shape);
  double sum = 0.0;
  for (int d = 0; d < dim; ++d)
  {
    const double v = x[static_cast<std::size_t>(d)];
    const bool simplex = shape == CellShape::Tetrahedron || shape == CellShape::Triangle ||
      (shape == CellShape::Wedge && d < 2);
    if (!(v - r >= 0.0) || (!simplex && !(v + r <= 1.0)))
    {
      return false;
    }
    sum += simplex ? v + r : 0.0;
  }
  return sum <= 1.0;
}
}

ImagePoint EvaluateImage(const BernsteinCells& cells, int cell, const double* u)
{
  ImagePoint image;
  image.Position = EvaluateCell(cells, cell, u).Position;
  const std::size_t at = static_cast<std::size_t>(cell);
  const CellDegree& degree = cells.Degrees[at];
  const int n = NumCellCoefficients(cells.Shapes[at], degree);
  const double* data = cells.Block(cell);
  double largest = 0.0;
  double least = 1.0;
  double most = 1.0;
  for (int i = 0; i < n * cells.NumComponents; ++i)
  {
    largest = std::max(largest, std::abs(data[i]));
  }
  if (cells.Rational)
  {
    const double* w = data + n * cells.NumComponents;
    least = *std::min_element(w, w + n);
    most = *std::max_element(w, w + n);
  }
  const double stored = cells.Errors.empty() ? 0.0 : cells.Errors[at];
  const double relative = (16.0 + 8.0 * (degree[0] + degree[1] + degree[2]) + n) * UnitRoundoff;
  // of N and W, both by at most the largest weight over the least
  image.Error = 2.0 * (largest / least) * (most / least) * relative +
    2.0 * stored * (1.0 + largest / least) / least;
  return image;
}

std::optional<Preimage> ProvePreimage(const BernsteinCells& cells, const CellLattice& lattice,
  int cell, const std::array<double, 3>& start, const ImagePoint& image)
{
  const Equations f = MakeEquations(cells, lattice, cell, image);
  std::array<double, 3> x = start;
  Linearized l;
  for (int step = 0; step < 12; ++step)
  {
    l = Linearize(lattice, f, x.data());
    const Eigen::Vector3d change = l.Slope.partialPivLu().solve(l.Value);
    bool wild = !change.allFinite();
    double size = 0.0;
    for (int d = 0; d < f.Dim && !wild; ++d)
    {
      x[static_cast<std::size_t>(d)] -= change[d];
      size = std::max(size, std::abs(change[d]));
      wild = std::abs(x[static_cast<std::size_t>(d)] - 0.5) > 1.0;
    }
    if (wild)
    {
      return std::nullopt;
    }
    if (size < 1e-15)
    {
      break;
    }
  }
  if (!IsInside(lattice.Shape, x, 0.0))
  {
    return std::nullopt;
  }
  l = Linearize(lattice, f, x.data());
  const Contraction c = Contract(lattice, f, l);
  const double radius = 2.0 * c.Step + 1e-300;
  if (c.Start + c.Growth * radius <= 0.5 && IsInside(lattice.Shape, x, radius))
  {
    return Preimage{ x, radius };
  }
  return std::nullopt;
}

MultiplicityResult CountPreimages(const BernsteinCells& cells, const CellLatticeTable& lattices,
  const BoxTree& tree, int cell, const std::array<double, 3>& u, std::int64_t maxBoxes)
{
  MultiplicityResult result;
  const auto latticeOf = [&](int c) -> const CellLattice&
  {
    const std::size_t at = static_cast<std::size_t>(c);
    return lattices.at({ static_cast<int>(cells.Shapes[at]), cells.Degrees[at] });
  };
  const ImagePoint image = EvaluateImage(cells, cell, u.data());
  // around u the map is one-to-one within this distance
  const CellLattice& own = latticeOf(cell);
  const Equations f = MakeEquations(cells, own, cell, image);
  const Contraction c = Contract(own, f, Linearize(own, f, u.data()));
  if (!(c.Start < 0.5))
  {
    return result;
  }
  const double reach = c.Growth > 0.0 ? (0.9 - c.Start) / c.Growth : 2.0;

  double lower[3];
  double upper[3];
  for (int d = 0; d < cells.NumComponents; ++d)
  {
    lower[d] = image.Position[static_cast<std::size_t>(d)] - image.Error;
    upper[d] = image.Position[static_cast<std::size_t>(d)] + image.Error;
  }
  std::vector<int> near;
  tree.ForNear(lower, upper, [&](int item) { near.push_back(item); });
  for (const int other : near)
  {
    const CellLattice& lattice = latticeOf(other);
    const int planes = cells.NumPlanes();
    const int dim = NumParameters(lattice.Shape);
    std::vector<CellPiece> open{ MakePiece(lattice, planes, cells.Block(other),
      cells.Errors.empty() ? 0.0 : cells.Errors[static_cast<std::size_t>(other)]) };
    while (!open.empty())
    {
      const CellPiece piece = std::move(open.back());
      open.pop_back();
      if (++result.Boxes > maxBoxes)
      {
        return result;
      }
      const PieceHull hull = MakeHull(lattice, cells.NumComponents, cells.Rational, piece);
      bool holds = true;
      for (std::size_t d = 0; d < static_cast<std::size_t>(cells.NumComponents); ++d)
      {
        holds = holds && hull.Lower[d] <= upper[d] && lower[d] <= hull.Upper[d];
      }
      if (!holds)
      {
        continue;
      }
      double distance = 0.0;
      std::array<double, 3> centre{};
      const int corners = NumCorners(lattice.Shape);
      for (int k = 0; k < corners; ++k)
      {
        for (int d = 0; d < dim; ++d)
        {
          const std::size_t at = static_cast<std::size_t>(d);
          const double v = piece.Corners[static_cast<std::size_t>(k)][at];
          distance = std::max(distance, std::abs(v - u[at]));
          centre[at] += v / corners;
        }
      }
      if (other == cell && distance <= reach)
      {
        continue;
      }
      if (piece.Depth % (3 * dim) == 2 * dim)
      {
        const auto preimage = ProvePreimage(cells, lattice, other, centre, image);
        if (preimage)
        {
          double apart = 0.0;
          for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d)
          {
            apart = std::max(apart, std::abs(preimage->Parameters[d] - u[d]));
          }
          if (other != cell || apart > 2.0 * preimage->Radius)
          {
            result.State = Multiplicity::Several;
            result.Cell = other;
            result.Other = *preimage;
            return result;
          }
        }
      }
      if (piece.Depth > 40 * dim)
      {
        return result;
      }
      for (CellPiece& half : Bisect(lattice, planes, piece, LongestDirection(lattice, hull)))
      {
        open.push_back(std::move(half));
      }
    }
  }
  result.State = Multiplicity::Once;
  return result;
}
}
