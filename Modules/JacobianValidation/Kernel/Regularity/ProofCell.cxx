// SPDX-License-Identifier: BSD-3-Clause
#include "ProofCell.h"

#include "ExactForm.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
ProofCell::ProofCell(
  const BernsteinCells& cells, int cell, const JacobianParams& params, LayoutCache& cache)
  : Number(cell), CollapseTolerance(params.CollapseTolerance)
{
  const std::size_t c = static_cast<std::size_t>(cell);
  this->Shape = cells.Shapes[c];
  this->Degree = cells.Degrees[c];
  this->Layout = &cache.Get(this->Shape, this->Degree);
  this->Components = cells.NumComponents;
  this->Rational = cells.Rational;
  const double* block = cells.Block(cell);
  this->Block.assign(block, block + cells.NumPlanes() * this->Layout->Size);
  this->Given = cells.Uncertainty(cell);
  if (!cells.Remainders.empty())
  {
    const double* rest = cells.Remainders.data() + cells.Offsets[c];
    const double* end = rest + this->Block.size();
    if (std::any_of(rest, end, [](double x) { return x != 0.0; }))
    {
      this->Remainders.assign(rest, end);
    }
  }
  this->DropConstantComponent();
  this->Norm = this->Components > NumParameters(this->Shape);
  this->MeasureNet();
}

/// A surface in a plane x, y or z = const is a planar map.
void ProofCell::DropConstantComponent()
{
  if (NumParameters(this->Shape) != 2 || this->Components != 3 || this->Given > 0.0)
  {
    return;
  }
  const int n = this->Size();
  for (int c = 0; c < 3; ++c)
  {
    if (this->IsConstant(c))
    {
      for (std::vector<double>* values : { &this->Block, &this->Remainders })
      {
        if (values->empty())
        {
          continue;
        }
        values->erase(values->begin() + c * n, values->begin() + (c + 1) * n);
        if (c == 1)
        {
          // (z, x), as in the normal's component y
          std::swap_ranges(values->begin(), values->begin() + n, values->begin() + n);
        }
      }
      this->Components = 2;
      this->Flat = true;
      return;
    }
  }
}

bool ProofCell::HasWeights() const
{
  const double* w = this->Plane(this->Components);
  return !this->Rational || *std::min_element(w, w + this->Size()) > this->Given;
}

/// All control points have the same coordinate, exactly.
bool ProofCell::IsConstant(int c) const
{
  const double* p = this->Plane(c);
  const double* w = this->Plane(this->Components);
  double first = 0.0;
  for (int i = 0; i < this->Size(); ++i)
  {
    double x = p[i];
    if (this->Rational && x != 0.0 && !Quotient(p[i], this->Remainder(c, i), w[i], x))
    {
      return false;
    }
    first = i == 0 ? x : first;
    if (x != first)
    {
      return false;
    }
  }
  return true;
}

/// Size of the control net, for what CollapseTolerance means here: moving control points by the
/// tolerance changes the Jacobian at a corner by at most this, up to a small factor.
void ProofCell::MeasureNet()
{
  const int n = this->Size();
  double coordinate = 0.0;
  double step = 0.0;
  const auto point = [&](int c, int i)
  {
    const double x = this->Plane(c)[i];
    return this->Rational ? x / this->Plane(this->Components)[i] : x;
  };
  for (int c = 0; c < this->Components; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      coordinate = std::max(coordinate, std::fabs(point(c, i)));
    }
    for (const FormLayout::Edge& edge : this->Layout->Edges)
    {
      for (const FormLayout::Line& line : edge.Lines)
      {
        const int* at = edge.LineIndices.data() + line.First;
        for (int i = 0; i + 1 < line.Size; ++i)
        {
          step = std::max(step, std::fabs(point(c, at[i + 1]) - point(c, at[i])));
        }
      }
    }
  }
  this->PointTolerance = this->CollapseTolerance * coordinate;
  const double* w = this->Plane(this->Components);
  this->GivenTolerance =
    this->PointTolerance * (this->Rational ? *std::min_element(w, w + n) : 1.0);
  double change = 4.0 * this->PointTolerance;
  for (int d = 0; d < NumParameters(this->Shape); ++d)
  {
    change *= this->Degree[static_cast<std::size_t>(d)] * (d > 0 ? step : 1.0);
  }
  this->ValueTolerance = change;
}

double ProofCell::CornerScale(int corner, int power) const
{
  const double* w = this->Plane(this->Components);
  const int at = this->Layout->Corners[static_cast<std::size_t>(corner)];
  double ratio = 1.0;
  int left = NumParameters(this->Shape);
  for (const FormLayout::Edge& edge : this->Layout->Edges)
  {
    for (const FormLayout::Line& line : edge.Lines)
    {
      const int* indices = edge.LineIndices.data() + line.First;
      for (const bool end : { false, true })
      {
        if (line.Size > 1 && left > 0 && indices[end ? line.Size - 1 : 0] == at)
        {
          ratio *= w[indices[end ? line.Size - 2 : 1]] / w[at];
          --left;
        }
      }
    }
  }
  return std::pow(w[at], power) * (this->Norm ? ratio * ratio : ratio);
}
}
