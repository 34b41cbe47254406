// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CoefficientFilter.h"
#include "JacobianCertificate.h"

namespace knotwork
{
/// Filters cells [begin, end); the cells that it does not decide keep Undecided.
template <typename Pack>
class FilterRun
{
  static constexpr std::size_t NumLanes = LanesOf<Pack>;

public:
  FilterRun(const BernsteinCells& cells, const JacobianParams& params)
    : Cells(cells), Params(params)
  {
  }

  /// @return false when a value is not finite or a weight not positive.
  bool Run(std::size_t begin, std::size_t end, CellCertificate* results)
  {
    bool good = true;
    for (std::size_t c = begin; c < end;)
    {
      std::size_t count = 1;
      while (count < NumLanes && c + count < end && this->Cells.AreAlike(c + count, c))
      {
        ++count;
      }
      BlocksOf<Pack> blocks{};
      Pack given{};
      for (std::size_t l = 0; l < NumLanes; ++l)
      {
        const std::size_t cell = c + std::min(l, count - 1);
        blocks[l] = this->Cells.Block(static_cast<int>(cell));
        if (!this->Cells.Errors.empty())
        {
          given[l] = this->Cells.Errors[cell];
        }
      }
      const CellShape shape = this->Cells.Shapes[c];
      const bool norm = this->Cells.NumComponents > NumParameters(shape);
      if (norm)
      {
        this->Filter.Norm(shape, this->Cells.Degrees[c], this->Cells.NumComponents,
          this->Cells.Rational, blocks, given, this->Bounds);
      }
      else
      {
        this->Filter.Determinant(
          shape, this->Cells.Degrees[c], this->Cells.Rational, blocks, given, this->Bounds);
      }
      const int power = this->Cells.Rational ? NumParameters(shape) + 1 : 0;
      for (std::size_t l = 0; l < count; ++l)
      {
        good = this->Decide(static_cast<int>(l), norm, power, given[l], results[c + l]) && good;
      }
      c += count;
    }
    return good;
  }

private:
  bool Decide(int l, bool norm, int power, double given, CellCertificate& r) const
  {
    const CoefficientBounds<Pack>& b = this->Bounds;
    if (!(b.NotFinite[l] == 0.0) || !(b.SmallestWeight[l] > 0.0) || !(given >= 0.0) ||
      std::isinf(given))
    {
      return false;
    }
    if (!(b.Magnitude[l] >= 0x1p-200 && b.Magnitude[l] <= 0x1p200) ||
      !(b.SmallestWeight[l] > given) || (power > 0 && b.SmallestWeight[l] < 0x1p-200))
    {
      return true;
    }
    constexpr double Outward = 1.0 + 0x1p-48; // covers the few roundings from here on
    constexpr double Inward = 1.0 - 0x1p-48;
    const double e = b.Error[l];
    const bool reversed = !norm && b.Largest[l] < 0.0;
    double smallest = reversed ? -b.Largest[l] : b.Smallest[l];
    double largest = reversed ? -b.Smallest[l] : b.Largest[l];
    double corner = reversed ? -b.LargestCorner[l] : b.SmallestCorner[l];
    double largestCorner = reversed ? -b.SmallestCorner[l] : b.LargestCorner[l];
    if (!(smallest > e * Outward))
    {
      return true;
    }
    double lower = (smallest - e) * Inward;
    double upper = (largest + e) * Outward;
    double cornerError = e;
    if (power > 0)
    {
      double low = 1.0;
      double high = 1.0;
      for (int k = 0; k < power; ++k)
      {
        low *= b.SmallestWeight[l] - given;
        high *= b.LargestWeight[l] + given;
      }
      lower = lower / high * Inward;
      upper = upper / low * Outward;
      cornerError = e / low * Outward;
      if (given > 0.0)
      {
        cornerError += corner; // corner weights are uncertain too: a bound that is only safe
        cornerError = std::max(cornerError, upper);
      }
    }
    const double cornerUpper = std::min((corner + cornerError) * Outward, upper);
    const double cornerLower = std::max((largestCorner - cornerError) * Inward, lower);
    if (cornerUpper - lower > this->Params.RelativeGap * cornerUpper ||
      (this->Params.ComputeMax && upper - cornerLower > this->Params.RelativeGap * upper))
    {
      return true;
    }
    r.Verdict = reversed ? Verdict::Reversed : Verdict::Valid;
    r.OneSided = norm;
    r.MinLower = reversed ? -upper : lower;
    r.MinUpper = reversed ? -cornerLower : cornerUpper;
    r.MaxLower = reversed ? -cornerUpper : cornerLower;
    r.MaxUpper = reversed ? -lower : upper;
    return true;
  }

  const BernsteinCells& Cells;
  const JacobianParams& Params;
  CoefficientFilter<Pack> Filter;
  CoefficientBounds<Pack> Bounds;
};
}
