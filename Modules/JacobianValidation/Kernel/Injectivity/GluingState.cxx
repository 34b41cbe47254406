// SPDX-License-Identifier: BSD-3-Clause
#include "GluingState.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
double Distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  return std::max({ std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2]) });
}

std::vector<Reframe> MakeReframes(CellShape shape, const CellDegree& degree)
{
  std::vector<std::array<int, 3>> frames;
  if (shape == CellShape::Curve)
  {
    frames = { { 0, 1, -1 }, { 1, 0, -1 } };
  }
  else if (shape == CellShape::Triangle)
  {
    frames = { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 0, 2, 1 }, { 2, 1, 0 }, { 1, 0, 2 } };
  }
  else
  {
    for (int o = 0; o < 4; ++o)
    {
      frames.push_back({ o, o ^ 1, o ^ 2 });
      frames.push_back({ o, o ^ 2, o ^ 1 });
    }
  }
  std::vector<Reframe> reframes;
  for (const auto& frame : frames)
  {
    Reframe r;
    int corner[3][2] = {};
    for (int k = 0; k < 3 && frame[static_cast<std::size_t>(k)] >= 0; ++k)
    {
      const auto u = CornerParameters(shape, frame[static_cast<std::size_t>(k)]);
      corner[k][0] = static_cast<int>(u[0]);
      corner[k][1] = static_cast<int>(u[1]);
    }
    const int a[2] = { corner[1][0] - corner[0][0], corner[1][1] - corner[0][1] };
    int b[2] = { 0, 0 };
    r.Corners = { frame[0], frame[1], frame[2], 3 - frame[0] };
    if (shape == CellShape::Curve)
    {
      r.Degree = { degree[0], 0 };
      r.Parity = a[0];
    }
    else
    {
      b[0] = corner[2][0] - corner[0][0];
      b[1] = corner[2][1] - corner[0][1];
      r.Degree = { degree[a[0] != 0 ? 0 : 1], degree[b[0] != 0 ? 0 : 1] };
      r.Parity = a[0] * b[1] - a[1] * b[0];
    }
    for (int j = 0; j <= r.Degree[1]; ++j)
    {
      for (int i = 0; i <= r.Degree[0]; ++i)
      {
        if (shape == CellShape::Triangle && i + j > degree[0])
        {
          continue;
        }
        const int at[2] = { corner[0][0] * degree[0] + i * a[0] + j * b[0],
          corner[0][1] * degree[1] + i * a[1] + j * b[1] };
        r.Coefficients.push_back(CellCoefficient(shape, degree, at[0], at[1], 0));
      }
    }
    reframes.push_back(std::move(r));
  }
  return reframes;
}

}

GluingState::GluingState(const BernsteinCells& cells, const CellComplex& complex,
  const std::vector<int>& signs, const InjectivityParams& params)
  : Cells(cells), Complex(complex), Signs(signs), Params(params), Corners(cells.NumCells() * 8),
    Edges(cells.NumCells() * 12)
{
  for (int s = 0; s < NumCellShapes; ++s)
  {
    const CellShape shape = static_cast<CellShape>(s);
    CellDegree one{};
    for (int d = 0; d < NumParameters(shape); ++d)
    {
      one[static_cast<std::size_t>(d)] = 1;
    }
    for (const auto& direction : CellLattice(shape, one).Directions)
    {
      for (const auto& pair : direction.CornerPairs)
      {
        this->EdgeCorners[s].push_back(pair);
      }
    }
  }
  this->Dim = NumParameters(cells.Shapes[0]);
}

int GluingState::EdgeId(int c, int a, int b) const
{
  const auto& edges = this->EdgeCorners[static_cast<int>(this->Shape(c))];
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
    {
      return c * 12 + static_cast<int>(e);
    }
  }
  return -1;
}

bool GluingState::HasBox(int c) const
{
  if (this->Complex.Boxes.empty())
  {
    return false;
  }
  const CellShape shape = this->Shape(c);
  const auto& box = this->Complex.Boxes[static_cast<std::size_t>(c)];
  bool has = shape == CellShape::Quadrilateral || shape == CellShape::Hexahedron;
  for (std::size_t d = 0; d < static_cast<std::size_t>(this->Dim); ++d)
  {
    has = has && box.Lower[d] < box.Upper[d];
  }
  return has;
}

std::array<double, 3> GluingState::BoxCorner(int c, int corner) const
{
  const auto& box = this->Complex.Boxes[static_cast<std::size_t>(c)];
  std::array<double, 3> u{};
  for (std::size_t d = 0; d < static_cast<std::size_t>(this->Dim); ++d)
  {
    u[d] = ((corner >> d) & 1 ? box.Upper[d] : box.Lower[d]) + 0.0;
  }
  return u;
}

std::array<double, 3> GluingState::Position(int c, int coefficient) const
{
  const int n = NumCellCoefficients(this->Shape(c), this->Degree(c));
  const double* x = this->Cells.Block(c);
  std::array<double, 3> position{};
  for (int d = 0; d < this->Cells.NumComponents; ++d)
  {
    const double w = this->Cells.Rational ? x[this->Cells.NumComponents * n + coefficient] : 1.0;
    position[static_cast<std::size_t>(d)] = x[d * n + coefficient] / w + 0.0;
  }
  return position;
}

double GluingState::LargestCoordinate(int c) const
{
  double largest = 0.0;
  const int n = NumCellCoefficients(this->Shape(c), this->Degree(c));
  for (int i = 0; i < n; ++i)
  {
    for (const double x : this->Position(c, i))
    {
      largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

const CellLattice& GluingState::Lattice(CellShape shape, const CellDegree& degree)
{
  return this->Lattices.try_emplace({ static_cast<int>(shape), degree }, shape, degree)
    .first->second;
}

const std::vector<Reframe>& GluingState::Reframes(CellShape shape, const CellDegree& degree)
{
  auto& entry = this->ReframeCache[{ static_cast<int>(shape), degree }];
  if (entry.empty())
  {
    entry = MakeReframes(shape, degree);
  }
  return entry;
}

void GluingState::KeepUnglued(const std::vector<bool>& glued)
{
  std::vector<SideOfCell> rest;
  for (std::size_t i = 0; i < this->Open.size(); ++i)
  {
    if (!glued[i])
    {
      rest.push_back(this->Open[i]);
    }
  }
  this->Open = std::move(rest);
}

void GluingState::SetFolded(SideOfCell a, SideOfCell b)
{
  if (this->Out.Folded[0] < 0)
  {
    this->Out.Folded = { a.Cell, a.Number, b.Cell, b.Number };
  }
}

bool GluingState::IsPoint(int c, const std::vector<int>& coefficients, double tolerance) const
{
  const auto first = this->Position(c, coefficients[0]);
  return std::all_of(coefficients.begin(), coefficients.end(),
    [&](int i) { return Distance(first, this->Position(c, i)) <= tolerance; });
}

void GluingState::JoinCorners(int a, int cornerA, int b, int cornerB)
{
  this->Corners.Unite(this->CornerId(a, cornerA), this->CornerId(b, cornerB));
}
}
