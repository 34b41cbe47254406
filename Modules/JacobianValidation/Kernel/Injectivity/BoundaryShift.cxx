// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryShift.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// x - o w, rounded once. @return whether that is exact: by Dekker's sums and products.
bool Move(double o, double w, double& x)
{
  const double moved = std::fma(-o, w, x);
  const double product = o * w;
  const double productRest = std::fma(o, w, -product);
  const auto sum = [](double a, double b, double& rest)
  {
    const double s = a + b;
    const double part = s - a;
    rest = (a - (s - part)) + (b - part);
    return s;
  };
  double rests[3];
  const double difference = sum(x, -product, rests[0]);
  const double second = sum(difference, -moved, rests[1]);
  const double third = sum(second, rests[0], rests[2]);
  x = moved;
  return third == productRest && rests[1] == 0.0 && rests[2] == 0.0;
}
}

BoundaryShift MoveToMiddle(const BernsteinCells& cells, std::vector<BoundarySide>& boundary)
{
  BoundaryShift shift;
  constexpr double far = 8.0;
  const std::size_t components = static_cast<std::size_t>(cells.NumComponents);
  const std::size_t planes = static_cast<std::size_t>(cells.NumPlanes());
  std::array<double, 3> low;
  std::array<double, 3> high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  const auto weight = [&](const BoundarySide& b, std::size_t i)
  { return cells.Rational ? b.Data[components * (b.Data.size() / planes) + i] : 1.0; };
  for (const BoundarySide& b : boundary)
  {
    const std::size_t n = b.Data.size() / planes;
    for (std::size_t k = 0; k < components * n; ++k)
    {
      const double x = b.Data[k] / weight(b, k % n);
      low[k / n] = std::min(low[k / n], x);
      high[k / n] = std::max(high[k / n], x);
    }
  }
  double size = 0.0;
  double distance = 0.0;
  for (std::size_t c = 0; c < components; ++c)
  {
    size = std::max(size, high[c] - low[c]);
    distance = std::max(distance, std::abs(0.5 * (low[c] + high[c])));
  }
  if (!(size > 0.0 && distance > far * size && std::isfinite(distance)))
  {
    return shift;
  }
  shift.Distance = distance;
  const double step = 2.0 * std::exp2(std::ceil(std::log2(size)));
  for (std::size_t c = 0; c < components; ++c)
  {
    shift.Middle[c] = step * std::round(0.5 * (low[c] + high[c]) / step);
  }
  for (BoundarySide& b : boundary)
  {
    const std::size_t cell = static_cast<std::size_t>(b.Cell);
    const CellShape shape = cells.Shapes[cell];
    const auto indices = SideCoefficients(shape, cells.Degrees[cell], b.Frame);
    const int all = NumCellCoefficients(shape, cells.Degrees[cell]);
    const double* rests =
      cells.Remainders.empty() ? nullptr : cells.Remainders.data() + cells.Offsets[cell];
    const std::size_t n = indices.size();
    double rounded = 0.0; // the largest number that was
    for (std::size_t k = 0; k < components * n; ++k)
    {
      double& x = b.Data[k];
      rounded =
        Move(shift.Middle[k / n], weight(b, k % n), x) ? rounded : std::max(rounded, std::abs(x));
      const double rest = rests ? rests[static_cast<int>(k / n) * all + indices[k % n]] : 0.0;
      if (rest != 0.0)
      {
        x += rest;
        rounded = std::max(rounded, std::abs(x));
      }
    }
    // two roundings a number
    b.Error = cells.Uncertainty(b.Cell) + 0x1.01p-52 * rounded;
  }
  return shift;
}
}
