// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceBounds.h"

#include <knotwork/SplineCore/ChordalBound.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int MaxElements = 16;

/// Largest length of p times the differences of coefficients in a direction.
double FirstDifference(const IntArray<2>& degree, const double* block, int direction)
{
  const int row = degree[0] + 1;
  const int n = row * (degree[1] + 1);
  const int step = direction == 0 ? 1 : row;
  double largest = 0.0;
  for (int j = 0; j <= degree[1] - (direction == 1 ? 1 : 0); ++j)
  {
    for (int i = 0; i <= degree[0] - (direction == 0 ? 1 : 0); ++i)
    {
      double square = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        const double* x = block + c * n + j * row + i;
        square += (x[step] - x[0]) * (x[step] - x[0]);
      }
      largest = std::max(largest, square);
    }
  }
  return degree[static_cast<std::size_t>(direction)] * std::sqrt(largest);
}
}

void DerivativeBounds::Merge(const DerivativeBounds& other)
{
  this->U = std::max(this->U, other.U);
  this->V = std::max(this->V, other.V);
  this->UU = std::max(this->UU, other.UU);
  this->UV = std::max(this->UV, other.UV);
  this->VV = std::max(this->VV, other.VV);
  this->IsSmooth = this->IsSmooth && other.IsSmooth;
}

SurfaceBounds::SurfaceBounds(const Spline<2>& surface, int threads)
  : Bezier(MakeBezierForm(surface, threads)), Box(surface.Space->Domain())
{
  const SplineSpace<2>& space = *surface.Space;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    for (int b = 0; b <= knots.NumElements(); ++b)
    {
      this->Creases[d].push_back(knots.Multiplicity(b) >= knots.Degree());
    }
  }
  this->Elements.resize(space.Elements.size());
  ParallelFor(this->Elements.size(), 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const auto& element = space.Elements[e];
        const double* block = this->Bezier.Block(static_cast<int>(e));
        const double hu = element.Box.Upper[0] - element.Box.Lower[0];
        const double hv = element.Box.Upper[1] - element.Box.Lower[1];
        const auto second = BoundSecondDerivatives<2>(element.Degree, 3, false, block);
        DerivativeBounds& bounds = this->Elements[e];
        bounds.U = FirstDifference(element.Degree, block, 0) / hu;
        bounds.V = FirstDifference(element.Degree, block, 1) / hv;
        bounds.UU = second[0] / (hu * hu);
        bounds.UV = second[1] / (hu * hv);
        bounds.VV = second[3] / (hv * hv);
      }
    });
  for (const DerivativeBounds& bounds : this->Elements)
  {
    this->Total.Merge(bounds);
  }
  for (const auto& creases : this->Creases)
  {
    this->Total.IsSmooth = this->Total.IsSmooth &&
      std::none_of(creases.begin() + 1, creases.end() - 1, [](bool crease) { return crease; });
  }
}

bool SurfaceBounds::Over(const ParametricBox<2>& box, DerivativeBounds& bounds) const
{
  const SplineSpace<2>& space = *this->Bezier.Space;
  std::array<int, 2> low{};
  std::array<int, 2> high{};
  bool isSmooth = true;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    low[d] = knots.FindElement(box.Lower[d]);
    high[d] = knots.FindElement(box.Upper[d]);
    if (box.Lower[d] == knots.Breaks()[static_cast<std::size_t>(low[d])])
    {
      low[d] = std::max(0, low[d] - 1);
    }
  }
  if ((high[0] - low[0] + 1) * (high[1] - low[1] + 1) > MaxElements)
  {
    bounds = this->Total;
    return false;
  }
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (int b = low[d] + 1; b <= high[d]; ++b)
    {
      isSmooth = isSmooth && !this->Creases[d][static_cast<std::size_t>(b)];
    }
  }
  bounds = {};
  const int columns = space.Knots[0].NumElements();
  for (int j = low[1]; j <= high[1]; ++j)
  {
    for (int i = low[0]; i <= high[0]; ++i)
    {
      bounds.Merge(this->Elements[static_cast<std::size_t>(j * columns + i)]);
    }
  }
  bounds.IsSmooth = isSmooth;
  return true;
}

int SurfaceBounds::ElementsAcross(const ParametricBox<2>& box) const
{
  int count = 1;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = this->Bezier.Space->Knots[d];
    count += knots.FindElement(box.Upper[d]) - knots.FindElement(box.Lower[d]);
  }
  return count;
}
}
