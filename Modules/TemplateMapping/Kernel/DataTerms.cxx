// SPDX-License-Identifier: BSD-3-Clause
#include "DataTerms.h"

#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Parallel.h>

#include <cmath>

namespace knotwork
{
namespace
{
/// Two registers without AVX, one with it.
typedef double Four __attribute__((vector_size(32)));

/// The same anywhere in memory.
typedef double FourAt __attribute__((vector_size(32), aligned(8), may_alias));

inline const FourAt& At(const double* p)
{
  return *reinterpret_cast<const FourAt*>(p);
}
inline FourAt& At(double* p)
{
  return *reinterpret_cast<FourAt*>(p);
}
inline double Sum(const Four& v)
{
  return (v[0] + v[1]) + (v[2] + v[3]);
}
constexpr std::size_t SampleChunk = 256;
}

template <int Dim>
DataTerms<Dim>::DataTerms(const SplineSpace<Dim>& space, const LocatedSamples<Dim>& located,
  const FitSamples<Dim>& samples, const FitWeights& weights, int threads)
  : Groups(located.Groups), Point(weights.Point), Normal(weights.Normal)
{
  const int numLocal = NumTensorFunctions<Dim>(space.Elements.front().Degree);
  this->Padded = static_cast<std::size_t>(Stride(numLocal));
  const std::size_t n = located.Order.size();
  this->Tau.assign(n * this->Padded, 0.0);
  this->Normals.assign(n * Dim, 0.0);
  this->Pulls.assign(n * Dim, 0.0);
  std::vector<int> elements(n);
  for (const auto& group : this->Groups)
  {
    std::fill(elements.begin() + static_cast<std::ptrdiff_t>(group.First),
      elements.begin() + static_cast<std::ptrdiff_t>(group.Last), group.Element);
  }
  ParallelFor(n, SampleChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        const Eigen::Index i = located.Order[k];
        const int e = elements[k];
        const auto& element = space.Elements[static_cast<std::size_t>(e)];
        double lines[3][MaxDegree + 1] = { {}, { 1.0 }, { 1.0 } };
        IntArray<3> size{ 1, 1, 1 };
        for (std::size_t d = 0; d < Dim; ++d)
        {
          size[d] = element.Degree[d] + 1;
          EvaluateLocalLine(element.Degree[d], space.Factor(e, static_cast<int>(d)),
            located.Local(i, static_cast<Eigen::Index>(d)),
            element.Box.Upper[d] - element.Box.Lower[d], 0, lines[d]);
        }
        double* tau = this->Tau.data() + k * this->Padded;
        for (int c = 0; c < size[2]; ++c)
        {
          for (int b = 0; b < size[1]; ++b)
          {
            for (int a = 0; a < size[0]; ++a)
            {
              *tau++ = lines[0][a] * lines[1][b] * lines[2][c];
            }
          }
        }
        Eigen::Matrix<double, 1, Dim> pull = weights.Point * samples.Residuals.row(i);
        if (weights.Normal > 0.0)
        {
          const Eigen::Matrix<double, 1, Dim> normal = samples.Normals.row(i);
          pull += weights.Normal * samples.Residuals.row(i).dot(normal) * normal;
          Eigen::Map<Eigen::Matrix<double, 1, Dim>>(this->Normals.data() + k * Dim) =
            std::sqrt(weights.Normal) * normal;
        }
        Eigen::Map<Eigen::Matrix<double, 1, Dim>>(this->Pulls.data() + k * Dim) = pull;
      }
    });
}

template <int Dim>
void DataTerms<Dim>::Apply(int group, const double* x, double* sum) const
{
  const auto& range = this->Groups[static_cast<std::size_t>(group)];
  const std::size_t padded = this->Padded;
  for (std::size_t k = range.First; k < range.Last; k += 2)
  {
    const bool isPair = k + 1 < range.Last;
    const double* first = this->Tau.data() + k * padded;
    const double* second = isPair ? first + padded : first;
    Four sums[2][Dim] = {};
    for (std::size_t j = 0; j < padded; j += NumLanes)
    {
      const Four a = At(first + j);
      const Four b = At(second + j);
      for (int d = 0; d < Dim; ++d)
      {
        const Four along = At(x + static_cast<std::size_t>(d) * padded + j);
        sums[0][d] += a * along;
        sums[1][d] += b * along;
      }
    }
    double pulls[2][Dim];
    for (std::size_t s = 0; s < 2; ++s)
    {
      const double* normal = this->Normals.data() + (isPair ? k + s : k) * Dim;
      double value[Dim];
      double along = 0.0;
      for (int d = 0; d < Dim; ++d)
      {
        value[d] = Sum(sums[s][d]);
        along += value[d] * normal[d];
      }
      const double used = s == 0 || isPair ? 1.0 : 0.0;
      for (int d = 0; d < Dim; ++d)
      {
        pulls[s][d] = used * (this->Point * value[d] + along * normal[d]);
      }
    }
    for (std::size_t j = 0; j < padded; j += NumLanes)
    {
      const Four a = At(first + j);
      const Four b = At(second + j);
      for (int d = 0; d < Dim; ++d)
      {
        double* out = sum + static_cast<std::size_t>(d) * padded + j;
        At(out) += a * pulls[0][d] + b * pulls[1][d];
      }
    }
  }
}

template <int Dim>
void DataTerms<Dim>::AddRight(int group, double* sum) const
{
  const auto& range = this->Groups[static_cast<std::size_t>(group)];
  for (std::size_t k = range.First; k < range.Last; ++k)
  {
    const double* tau = this->Tau.data() + k * this->Padded;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      for (std::size_t j = 0; j < this->Padded; ++j)
      {
        sum[d * this->Padded + j] += tau[j] * this->Pulls[k * Dim + d];
      }
    }
  }
}

template <int Dim>
int DataTerms<Dim>::NumSamples(int group) const
{
  const auto& range = this->Groups[static_cast<std::size_t>(group)];
  return static_cast<int>(range.Last - range.First);
}

template <int Dim>
const double* DataTerms<Dim>::Values(int group, int sample) const
{
  return this->Tau.data() +
    (this->Groups[static_cast<std::size_t>(group)].First + static_cast<std::size_t>(sample)) *
    this->Padded;
}

template <int Dim>
Eigen::Matrix<double, Dim, 1> DataTerms<Dim>::ScaledNormal(int group, int sample) const
{
  const std::size_t k =
    this->Groups[static_cast<std::size_t>(group)].First + static_cast<std::size_t>(sample);
  return Eigen::Map<const Eigen::Matrix<double, Dim, 1>>(this->Normals.data() + k * Dim);
}

template <int Dim>
Eigen::Matrix<double, Dim, Dim> DataTerms<Dim>::Weight(int group, int sample) const
{
  const Eigen::Matrix<double, Dim, 1> normal = this->ScaledNormal(group, sample);
  return this->Point * Eigen::Matrix<double, Dim, Dim>::Identity() + normal * normal.transpose();
}

template class DataTerms<2>;
template class DataTerms<3>;
}
