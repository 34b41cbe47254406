// SPDX-License-Identifier: BSD-3-Clause
#include "FitLikelihood.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace knotwork
{
namespace
{
constexpr std::size_t PointChunk = 16384;
constexpr int ClassBits = 4; // classes an octave: 2^4
constexpr int Octaves = 61;  // up to that of the largest distance
constexpr std::size_t NumClasses = std::size_t{ Octaves } << ClassBits;
constexpr double LeastFreedom = 0.5;
constexpr double MostFreedom = 200.0;
constexpr double Pi = 3.14159265358979323846;

/// Classes of positive numbers by exponent and leading digits.
class Classes
{
public:
  explicit Classes(double largest)
    : LowestOctave(std::max(largest > 0.0 ? std::ilogb(largest) : 0, -900) - Octaves + 1),
      FirstCode(static_cast<std::uint64_t>(this->LowestOctave + 1023) << ClassBits)
  {
  }

  std::size_t Of(double x) const
  {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    const std::uint64_t code = bits >> (52 - ClassBits);
    return code <= this->FirstCode
      ? 0
      : std::min<std::size_t>(static_cast<std::size_t>(code - this->FirstCode), NumClasses - 1);
  }

  double Middle(std::size_t number) const
  {
    const auto octave = static_cast<int>(number >> ClassBits) + this->LowestOctave;
    const auto part = static_cast<double>(number & ((1U << ClassBits) - 1)) + 0.5;
    return std::ldexp(1.0 + part / (1U << ClassBits), octave);
  }

private:
  int LowestOctave;
  std::uint64_t FirstCode;
};

struct Class
{
  double Square;
  double Count;
};

double LogLikelihood(const std::vector<Class>& classes, double total, double scale, double freedom)
{
  double sum = 0.0;
  for (const Class& c : classes)
  {
    sum += c.Count * std::log1p(c.Square / (freedom * scale * scale));
  }
  return total *
    (std::lgamma(0.5 * (freedom + 1.0)) - std::lgamma(0.5 * freedom) -
      0.5 * std::log(freedom * Pi) - std::log(scale)) -
    0.5 * (freedom + 1.0) * sum;
}

/// The most likely scale at given degrees of freedom by Newton's method in logarithms.
/// @param most   no scale is larger: the root of the mean square.
/// @param scale  to begin with.
double FitScale(
  const std::vector<Class>& classes, double total, double most, double scale, double freedom)
{
  double least = 0.0;
  for (int k = 0; k < 100; ++k)
  {
    double sum = 0.0;
    double slope = 0.0;
    for (const Class& c : classes)
    {
      const double share = c.Square / (freedom * scale * scale + c.Square);
      sum += c.Count * share;
      slope += c.Count * share * (1.0 - share);
    }
    const double gain = (freedom + 1.0) * sum / total; // 1 at the scale sought, falling
    const double step = std::log(gain) * 0.5 * sum / slope;
    if (std::fabs(step) <= 1e-6)
    {
      break;
    }
    (gain > 1.0 ? least : most) = scale;
    const double next = scale * std::exp(step);
    scale = next > least && next < most ? next : 0.5 * (least + most);
  }
  return scale;
}
}

TDistribution FitTDistribution(const FitPoints& points, int threads, const FitDivision& division)
{
  const std::size_t chunks = (points.Size() + PointChunk - 1) / PointChunk;
  std::vector<double> largest(chunks, 0.0);
  ParallelFor(points.Size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      double own = 0.0;
      for (std::size_t i = begin; i < end; ++i)
      {
        own = std::max(own, points.Base[i] > 0.0 ? std::fabs(points.Distance[i]) : 0.0);
      }
      largest[begin / PointChunk] = own;
    });
  const Classes all(
    division.Largest(chunks > 0 ? *std::max_element(largest.begin(), largest.end()) : 0.0));
  std::vector<std::vector<int>> counts(chunks);
  ParallelFor(points.Size(), PointChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<int>& own = counts[begin / PointChunk];
      own.assign(NumClasses, 0);
      for (std::size_t i = begin; i < end; ++i)
      {
        if (points.Base[i] > 0.0)
        {
          ++own[all.Of(std::fabs(points.Distance[i]))];
        }
      }
    });
  std::vector<Class> classes;
  double total = 0.0;
  double squares = 0.0;
  std::vector<double> inClass(NumClasses, 0.0);
  for (const std::vector<int>& own : counts)
  {
    std::transform(own.begin(), own.end(), inClass.begin(), inClass.begin(), std::plus<>());
  }
  division.AddUp(inClass);
  for (std::size_t k = 0; k < NumClasses; ++k)
  {
    const double count = inClass[k];
    if (count > 0.0)
    {
      const double x = all.Middle(k);
      classes.push_back({ x * x, count });
      total += count;
      squares += count * x * x;
    }
  }
  TDistribution best;
  if (total == 0.0)
  {
    return best;
  }
  const double most = std::sqrt(squares / total);
  // one-dimensional search over the logarithm of the degrees of freedom, scale the best for each
  const auto at = [&](double logFreedom)
  {
    TDistribution t;
    t.DegreesOfFreedom = std::exp(logFreedom);
    t.Scale =
      FitScale(classes, total, most, best.Scale > 0.0 ? best.Scale : most, t.DegreesOfFreedom);
    t.LogLikelihood = LogLikelihood(classes, total, t.Scale, t.DegreesOfFreedom);
    return t;
  };
  double low = std::log(LeastFreedom);
  double high = std::log(MostFreedom);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  TDistribution atA = at(a);
  best = atA;
  TDistribution atB = at(b);
  while (high - low > 1e-3)
  {
    if (atA.LogLikelihood >= atB.LogLikelihood)
    {
      high = b;
      b = a;
      atB = atA;
      a = high - golden * (high - low);
      atA = at(a);
    }
    else
    {
      low = a;
      a = b;
      atA = atB;
      b = low + golden * (high - low);
      atB = at(b);
    }
    best = atA.LogLikelihood >= atB.LogLikelihood ? atA : atB;
  }
  return best;
}
}
