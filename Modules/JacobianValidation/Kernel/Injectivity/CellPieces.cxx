// SPDX-License-Identifier: BSD-3-Clause
#include "CellPieces.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double UnitRoundoff = 0x1p-53;
/// Covers the rounding of the bounds' own few operations.
constexpr double Slack = 1.0 + 0x1p-40;

using Lattice3 = std::array<int, 3>;

bool InLattice(CellShape shape, const CellDegree& p, const Lattice3& i)
{
  for (std::size_t d = 0; d < 3; ++d)
  {
    if (i[d] < 0 || i[d] > p[d])
    {
      return false;
    }
  }
  switch (shape)
  {
    case CellShape::Triangle:
    case CellShape::Wedge:
      return i[0] + i[1] <= p[0];
    case CellShape::Tetrahedron:
      return i[0] + i[1] + i[2] <= p[0];
    default:
      return true;
  }
}

/// Corners between which the directions run.
std::vector<std::array<int, 2>> DirectionCorners(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Curve:
      return { { 0, 1 } };
    case CellShape::Quadrilateral:
      return { { 0, 1 }, { 0, 2 } };
    case CellShape::Hexahedron:
      return { { 0, 1 }, { 0, 2 }, { 0, 4 } };
    case CellShape::Triangle:
      return { { 0, 1 }, { 0, 2 }, { 1, 2 } };
    case CellShape::Tetrahedron:
      return { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 3 }, { 2, 3 } };
    case CellShape::Wedge:
      return { { 0, 1 }, { 0, 2 }, { 1, 2 }, { 0, 3 } };
  }
  return {};
}

/// All Bernstein polynomials of a simplex of degree p, in the order of CellCoefficient.
void SimplexValues(int numParameters, int p, const double* u, double* values)
{
  double powers[4][MaxDegree + 1];
  double last = 1.0;
  for (int d = 0; d < numParameters; ++d)
  {
    last -= u[d];
  }
  for (int d = 0; d <= numParameters; ++d)
  {
    const double x = d < numParameters ? u[d] : last;
    powers[d][0] = 1.0;
    for (int i = 1; i <= p; ++i)
    {
      powers[d][i] = powers[d][i - 1] * x;
    }
  }
  int n = 0;
  for (int k = 0; k <= (numParameters == 3 ? p : 0); ++k)
  {
    for (int j = 0; j + k <= p; ++j)
    {
      for (int i = 0; i + j + k <= p; ++i)
      {
        const double multinomial = Binomial(p, k) * Binomial(p - k, j) * Binomial(p - k - j, i);
        values[n++] = multinomial * powers[0][i] * powers[1][j] *
          (numParameters == 3 ? powers[2][k] * powers[3][p - i - j - k] : powers[2][p - i - j]);
      }
    }
  }
}

/// Values and derivatives of a simplex: the latter are p times differences of degree p - 1.
void SimplexBasis(int numParameters, int p, const double* u, double* values, double* derivatives)
{
  const CellShape shape = numParameters == 3 ? CellShape::Tetrahedron : CellShape::Triangle;
  const CellDegree degree{ p, p, numParameters == 3 ? p : 0 };
  SimplexValues(numParameters, p, u, values);
  if (!derivatives)
  {
    return;
  }
  const int n = NumCellCoefficients(shape, degree);
  const CellDegree lower{ p - 1, p - 1, numParameters == 3 ? p - 1 : 0 };
  double low[220];
  SimplexValues(numParameters, p - 1, u, low);
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j + k <= p; ++j)
    {
      for (int i = 0; i + j + k <= p; ++i)
      {
        const int at = CellCoefficient(shape, degree, i, j, k);
        const double same = i + j + k <= p - 1 ? low[CellCoefficient(shape, lower, i, j, k)] : 0.0;
        const Lattice3 index{ i, j, k };
        for (int d = 0; d < numParameters; ++d)
        {
          Lattice3 less = index;
          --less[static_cast<std::size_t>(d)];
          const double raised = less[static_cast<std::size_t>(d)] >= 0
            ? low[CellCoefficient(shape, lower, less[0], less[1], less[2])]
            : 0.0;
          derivatives[d * n + at] = p * (raised - same);
        }
      }
    }
  }
}
}

CellLattice::CellLattice(CellShape shape, const CellDegree& degree)
  : Shape(shape), Degree(degree), Size(NumCellCoefficients(shape, degree))
{
  const auto cornerIndex = [&](int corner)
  {
    const auto u = CornerParameters(shape, corner);
    Lattice3 i{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      i[d] = static_cast<int>(u[d]) * degree[d];
    }
    return i;
  };
  for (int c = 0; c < NumCorners(shape); ++c)
  {
    const Lattice3 i = cornerIndex(c);
    this->Corners.push_back(CellCoefficient(shape, degree, i[0], i[1], i[2]));
  }
  for (const auto& ends : DirectionCorners(shape))
  {
    Direction direction;
    direction.From = ends[0];
    direction.To = ends[1];
    const auto from = CornerParameters(shape, ends[0]);
    const auto to = CornerParameters(shape, ends[1]);
    Lattice3 step{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      step[d] = static_cast<int>(to[d] - from[d]);
    }
    const auto collect = [&](Lattice3 i)
    {
      Lattice3 before = i;
      for (std::size_t d = 0; d < 3; ++d)
      {
        before[d] -= step[d];
      }
      if (InLattice(shape, degree, before))
      {
        return;
      }
      std::vector<int> line;
      for (; InLattice(shape, degree, i);)
      {
        line.push_back(CellCoefficient(shape, degree, i[0], i[1], i[2]));
        for (std::size_t d = 0; d < 3; ++d)
        {
          i[d] += step[d];
        }
      }
      if (line.size() > 1)
      {
        direction.Lines.push_back(std::move(line));
      }
    };
    collect(cornerIndex(direction.From));
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          const Lattice3 index{ i, j, k };
          if (InLattice(shape, degree, index) && index != cornerIndex(direction.From))
          {
            collect(index);
          }
        }
      }
    }
    for (const auto& line : direction.Lines)
    {
      const auto corner = [&](int coefficient)
      {
        const auto at = std::find(this->Corners.begin(), this->Corners.end(), coefficient);
        return at == this->Corners.end() ? -1 : static_cast<int>(at - this->Corners.begin());
      };
      const std::array<int, 2> pair{ corner(line.front()), corner(line.back()) };
      if (pair[0] >= 0 && pair[1] >= 0)
      {
        direction.CornerPairs.push_back(pair);
      }
    }
    this->Directions.push_back(std::move(direction));
  }
}

CellPiece MakePiece(const CellLattice& lattice, int numPlanes, const double* data, double error)
{
  CellPiece piece;
  piece.Data.assign(data, data + static_cast<std::ptrdiff_t>(numPlanes) * lattice.Size);
  piece.Error = error;
  for (int c = 0; c < NumCorners(lattice.Shape); ++c)
  {
    piece.Corners[static_cast<std::size_t>(c)] = CornerParameters(lattice.Shape, c);
  }
  return piece;
}

std::array<CellPiece, 2> Bisect(
  const CellLattice& lattice, int numPlanes, const CellPiece& piece, int direction)
{
  const auto& along = lattice.Directions[static_cast<std::size_t>(direction)];
  double largest = 0.0;
  for (const double x : piece.Data)
  {
    largest = std::max(largest, std::abs(x));
  }
  const double steps = static_cast<double>(along.Lines.front().size() - 1);
  CellPiece left = piece;
  left.Error = (piece.Error + steps * (UnitRoundoff * (largest + piece.Error) + DBL_MIN)) * Slack;
  left.Depth = piece.Depth + 1;
  CellPiece right = left;
  for (int plane = 0; plane < numPlanes; ++plane)
  {
    double* a = left.Data.data() + static_cast<std::ptrdiff_t>(plane) * lattice.Size;
    double* b = right.Data.data() + static_cast<std::ptrdiff_t>(plane) * lattice.Size;
    for (const auto& line : along.Lines)
    {
      // b holds the triangle's current row: its first entry is the left half's next coefficient
      const int m = static_cast<int>(line.size()) - 1;
      for (int r = 1; r <= m; ++r)
      {
        for (int i = 0; i <= m - r; ++i)
        {
          double& x = b[line[static_cast<std::size_t>(i)]];
          x = 0.5 * (x + b[line[static_cast<std::size_t>(i + 1)]]);
        }
        a[line[static_cast<std::size_t>(r)]] = b[line[0]];
      }
    }
  }
  for (const auto& pair : along.CornerPairs)
  {
    const std::size_t from = static_cast<std::size_t>(pair[0]);
    const std::size_t to = static_cast<std::size_t>(pair[1]);
    std::array<double, 3> middle{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      middle[d] = 0.5 * (piece.Corners[from][d] + piece.Corners[to][d]);
    }
    left.Corners[to] = middle;
    right.Corners[from] = middle;
  }
  return { std::move(left), std::move(right) };
}

PieceHull MakeHull(
  const CellLattice& lattice, int numComponents, bool rational, const CellPiece& piece)
{
  PieceHull hull;
  hull.NumComponents = numComponents;
  hull.Points.resize(static_cast<std::size_t>(lattice.Size * numComponents));
  hull.Error = piece.Error;
  hull.Lower.fill(DBL_MAX);
  hull.Upper.fill(-DBL_MAX);
  const double* data = piece.Data.data();
  const double* weights = rational ? data + numComponents * lattice.Size : nullptr;
  for (int i = 0; i < lattice.Size; ++i)
  {
    double largest = 0.0;
    for (int d = 0; d < numComponents; ++d)
    {
      double x = data[d * lattice.Size + i];
      if (weights)
      {
        x /= weights[i];
      }
      hull.Points[static_cast<std::size_t>(i * numComponents + d)] = x;
      largest = std::max(largest, std::abs(x));
      double& low = hull.Lower[static_cast<std::size_t>(d)];
      double& high = hull.Upper[static_cast<std::size_t>(d)];
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (weights)
    {
      // |N/W - n/w| <= (e + |n/w| e) / (w - e), and the division rounds
      const double least = weights[i] - piece.Error;
      const double error = least > 0.0
        ? piece.Error * (1.0 + largest) / least + 2.0 * UnitRoundoff * largest
        : std::numeric_limits<double>::infinity();
      hull.Error = std::max(hull.Error, error * Slack);
    }
  }
  for (std::size_t d = 0; d < static_cast<std::size_t>(numComponents); ++d)
  {
    const double scale = std::max(std::abs(hull.Lower[d]), std::abs(hull.Upper[d]));
    const double wide = hull.Error + UnitRoundoff * 2.0 * (scale + hull.Error);
    hull.Lower[d] -= wide;
    hull.Upper[d] += wide;
  }
  return hull;
}

int LongestDirection(const CellLattice& lattice, const PieceHull& hull)
{
  int best = 0;
  double longest = -1.0;
  for (std::size_t d = 0; d < lattice.Directions.size(); ++d)
  {
    double length = 0.0;
    for (const auto& line : lattice.Directions[d].Lines)
    {
      double sum = 0.0;
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
      {
        double square = 0.0;
        for (int c = 0; c < hull.NumComponents; ++c)
        {
          const double x = hull.Point(line[i + 1])[c] - hull.Point(line[i])[c];
          square += x * x;
        }
        sum += std::sqrt(square);
      }
      length = std::max(length, sum);
    }
    if (length > longest)
    {
      longest = length;
      best = static_cast<int>(d);
    }
  }
  return best;
}

void EvaluateCellBasis(
  CellShape shape, const CellDegree& degree, const double* u, double* values, double* derivatives)
{
  const int n = NumCellCoefficients(shape, degree);
  switch (shape)
  {
    case CellShape::Triangle:
    case CellShape::Tetrahedron:
      SimplexBasis(NumParameters(shape), degree[0], u, values, derivatives);
      return;
    case CellShape::Wedge:
    {
      double base[(MaxDegree + 1) * (MaxDegree + 2) / 2];
      double slopes[(MaxDegree + 1) * (MaxDegree + 2)];
      double line[2 * (MaxDegree + 1)];
      const int m = n / (degree[2] + 1);
      SimplexBasis(2, degree[0], u, base, slopes);
      BernsteinDerivatives(degree[2], u[2], 1, line);
      for (int k = 0; k <= degree[2]; ++k)
      {
        for (int i = 0; i < m; ++i)
        {
          values[k * m + i] = base[i] * line[k];
          if (derivatives)
          {
            derivatives[k * m + i] = slopes[i] * line[k];
            derivatives[n + k * m + i] = slopes[m + i] * line[k];
            derivatives[2 * n + k * m + i] = base[i] * line[degree[2] + 1 + k];
          }
        }
      }
      return;
    }
    default:
      break;
  }
  const int d = NumParameters(shape);
  double line[3][2 * (MaxDegree + 1)] = { { 1.0 }, { 1.0 }, { 1.0 } };
  for (int c = 0; c < d; ++c)
  {
    BernsteinDerivatives(degree[static_cast<std::size_t>(c)], u[c], 1, line[c]);
  }
  int at = 0;
  for (int k = 0; k <= degree[2]; ++k)
  {
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i, ++at)
      {
        values[at] = line[0][i] * line[1][j] * line[2][k];
        if (derivatives)
        {
          derivatives[at] = line[0][degree[0] + 1 + i] * line[1][j] * line[2][k];
          if (d > 1)
          {
            derivatives[n + at] = line[0][i] * line[1][degree[1] + 1 + j] * line[2][k];
          }
          if (d > 2)
          {
            derivatives[2 * n + at] = line[0][i] * line[1][j] * line[2][degree[2] + 1 + k];
          }
        }
      }
    }
  }
}

CellPoint EvaluateCell(const BernsteinCells& cells, int cell, const double* u)
{
  const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
  const CellDegree& degree = cells.Degrees[static_cast<std::size_t>(cell)];
  const int n = NumCellCoefficients(shape, degree);
  const int dim = NumParameters(shape);
  std::vector<double> basis(static_cast<std::size_t>(n * (1 + dim)));
  EvaluateCellBasis(shape, degree, u, basis.data(), basis.data() + n);
  double sums[4][4] = {};
  for (int plane = 0; plane < cells.NumPlanes(); ++plane)
  {
    const double* x = cells.Block(cell) + plane * n;
    for (int d = 0; d <= dim; ++d)
    {
      double sum = 0.0;
      for (int i = 0; i < n; ++i)
      {
        sum += basis[static_cast<std::size_t>(d * n + i)] * x[i];
      }
      sums[d][plane] = sum;
    }
  }
  CellPoint point;
  const int c = cells.NumComponents;
  for (int k = 0; k < c; ++k)
  {
    const std::size_t at = static_cast<std::size_t>(k);
    const double w = cells.Rational ? sums[0][c] : 1.0;
    point.Position[at] = sums[0][k] / w;
    for (int d = 0; d < dim; ++d)
    {
      const double slope = cells.Rational ? sums[d + 1][c] : 0.0;
      point.Derivative[static_cast<std::size_t>(d)][at] =
        (sums[d + 1][k] - point.Position[at] * slope) / w;
    }
  }
  return point;
}
}
