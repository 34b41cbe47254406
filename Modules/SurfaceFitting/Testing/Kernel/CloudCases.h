// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceFitting/SurfaceFit.h>

#include <cmath>
#include <random>

/// Point clouds that are the same on every machine: std::mt19937_64 and no distribution of the
/// standard library.
namespace knotwork::clouds
{
inline constexpr double Pi = 3.14159265358979323846;

class Random
{
public:
  explicit Random(std::uint64_t seed) : Engine(seed) {}
  /// In [0, 1).
  double Uniform() { return static_cast<double>(this->Engine() >> 11) * 0x1.0p-53; }
  /// Mean 0, variance 1.
  double Normal()
  {
    const double a = std::max(this->Uniform(), 1e-300);
    const double b = this->Uniform();
    return std::sqrt(-2.0 * std::log(a)) * std::cos(2.0 * Pi * b);
  }

private:
  std::mt19937_64 Engine;
};

/// Two cones with soft feet: heights 2/3 and 1/3, infinite curvature at the tips.
inline double Peaks(double x, double y)
{
  return 2.0 / 3.0 * std::exp(-std::hypot(10.0 * x - 6.0, 10.0 * y - 6.0)) +
    1.0 / 3.0 * std::exp(-std::hypot(10.0 * x - 3.0, 10.0 * y - 8.0));
}

/// Eight octaves of hills and a cliff of height 0.2 and width 0.001.
class Terrain
{
public:
  Terrain()
  {
    Random random(7777);
    for (int k = 0; k < 8; ++k)
    {
      this->Angle[k] = 2.0 * Pi * random.Uniform();
      this->PhaseS[k] = 2.0 * Pi * random.Uniform();
      this->PhaseT[k] = 2.0 * Pi * random.Uniform();
    }
  }
  double operator()(double x, double y) const
  {
    double z = 0.0;
    for (int k = 0; k < 8; ++k)
    {
      const double frequency = 2.0 * Pi * std::ldexp(1.0, k);
      const double s = x * std::cos(this->Angle[k]) + y * std::sin(this->Angle[k]);
      const double t = -x * std::sin(this->Angle[k]) + y * std::cos(this->Angle[k]);
      z += 0.15 * std::ldexp(1.0, -k) * std::sin(frequency * s + this->PhaseS[k]) *
        std::cos(frequency * t + this->PhaseT[k]);
    }
    return z + 0.1 * (1.0 + std::tanh((y - (0.4 + 0.1 * std::sin(6.0 * x))) / 0.001));
  }

private:
  double Angle[8];
  double PhaseS[8];
  double PhaseT[8];
};

/// Heights of a function over random points of the unit square.
template <typename Function>
PointCloud HeightField(std::size_t n, std::uint64_t seed, Function&& height)
{
  Random random(seed);
  PointCloud cloud;
  cloud.Parameters.resize(static_cast<Eigen::Index>(n), 2);
  cloud.Values.resize(static_cast<Eigen::Index>(n), 1);
  for (Eigen::Index i = 0; i < cloud.Parameters.rows(); ++i)
  {
    const double x = random.Uniform();
    const double y = random.Uniform();
    cloud.Parameters.row(i) << x, y;
    cloud.Values(i, 0) = height(x, y);
  }
  return cloud;
}

/// The clouds that fits are measured with.
inline PointCloud PeaksCloud()
{
  return HeightField(100000, 1001, Peaks);
}
inline PointCloud LargePeaksCloud()
{
  return HeightField(1000000, 1002, Peaks);
}
inline PointCloud TerrainCloud()
{
  return HeightField(500000, 1003, Terrain());
}
/// PeaksCloud with noise of deviation 0.002 and 534 outliers that are off by 0.1 to 0.5.
/// @param labels  1 where a point is an outlier.
inline PointCloud NoisyPeaksCloud(std::vector<std::uint8_t>& labels)
{
  PointCloud cloud = PeaksCloud();
  labels.assign(static_cast<std::size_t>(cloud.Values.rows()), 0);
  Random random(1004);
  for (Eigen::Index i = 0; i < cloud.Values.rows(); ++i)
  {
    cloud.Values(i, 0) += 0.002 * random.Normal();
    const double which = random.Uniform();
    const double size = random.Uniform();
    const double sign = random.Uniform();
    if (which < 0.005)
    {
      cloud.Values(i, 0) += (sign < 0.5 ? -1.0 : 1.0) * (0.1 + 0.4 * size);
      labels[static_cast<std::size_t>(i)] = 1;
    }
  }
  return cloud;
}
}
