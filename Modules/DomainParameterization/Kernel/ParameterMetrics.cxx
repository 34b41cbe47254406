// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterMetrics.h"

#include "JacobianField.h"
#include <knotwork/SplineCore/BezierForm.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Scaled Jacobians below this are what rounding leaves of a degenerate point.
constexpr double DegenerateScaled = 1e-10;

/// Sums and extremes over points that come one by one.
template <int Dim>
class Collector
{
public:
  /// @param j  Dim * c + k: derivative of component c along direction k
  void Add(const std::array<double, Dim * Dim>& j)
  {
    double det = 0.0;
    double cofactors = 0.0; // squared norm
    double f = 0.0;
    double product = 1.0;
    for (std::size_t k = 0; k < Dim; ++k)
    {
      double length = 0.0;
      for (std::size_t c = 0; c < Dim; ++c)
      {
        length += j[Dim * c + k] * j[Dim * c + k];
      }
      f += length;
      product *= length;
    }
    if constexpr (Dim == 2)
    {
      det = j[0] * j[3] - j[1] * j[2];
      cofactors = f;
    }
    else
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        const double* a = j.data() + 3 * ((c + 1) % 3);
        const double* b = j.data() + 3 * ((c + 2) % 3);
        const double n[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0] };
        cofactors += n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        det = j[3 * c] * n[0] + j[3 * c + 1] * n[1] + j[3 * c + 2] * n[2];
      }
    }
    const double scaled = product > 0.0 ? det / std::sqrt(product) : 0.0;
    this->MinDet = std::min(this->MinDet, det);
    this->MaxDet = std::max(this->MaxDet, det);
    this->MinScaled = std::min(this->MinScaled, scaled);
    this->SumScaled += scaled;
    this->NonPositive += det > 0.0 ? 0 : 1;
    if (std::abs(scaled) > DegenerateScaled)
    {
      // in the plane both norms are one
      this->SumCondition += (Dim == 2 ? f : std::sqrt(f * cofactors)) / std::abs(det);
      ++this->NumConditions;
    }
    ++this->Count;
  }

  DomainMetrics Result(double area, int samples) const
  {
    DomainMetrics metrics;
    metrics.Samples = samples;
    metrics.Area = area;
    metrics.MinDet = this->MinDet;
    metrics.MaxDet = this->MaxDet;
    metrics.MinDetOverArea = this->MinDet / area;
    metrics.MaxDetOverArea = this->MaxDet / area;
    metrics.MinScaledJacobian = this->MinScaled;
    metrics.MeanScaledJacobian = this->SumScaled / static_cast<double>(this->Count);
    metrics.MeanConditionNumber =
      this->SumCondition / static_cast<double>(std::max<std::int64_t>(1, this->NumConditions));
    metrics.NonPositive = this->NonPositive;
    return metrics;
  }

private:
  double MinDet = std::numeric_limits<double>::infinity();
  double MaxDet = -std::numeric_limits<double>::infinity();
  double MinScaled = std::numeric_limits<double>::infinity();
  double SumScaled = 0.0;
  double SumCondition = 0.0;
  std::int64_t NumConditions = 0;
  int NonPositive = 0;
  std::int64_t Count = 0;
};

template <int Dim>
class MetricBody final : public RowBody
{
public:
  MetricBody(bool rational, Collector<Dim>& sums, const std::function<bool()>& goOn)
    : Rational(rational), Sums(sums), GoOn(goOn)
  {
  }

  void Row(
    int n, const double* fields, double*, const double*, double, const double* padding) override
  {
    // a row is quick; a call of the caller's may not be
    if (++this->Rows % 256 == 0 && this->GoOn)
    {
      this->Stopped = this->Stopped || !this->GoOn();
    }
    const int numPlanes = Dim + (this->Rational ? 1 : 0);
    for (int i = 0; i < n && !this->Stopped && padding[i] == 0.0; ++i)
    {
      const auto at = [&](int t, int c) { return fields[(t * numPlanes + c) * n + i]; };
      const double inverse = this->Rational ? 1.0 / at(0, Dim) : 1.0;
      std::array<double, Dim * Dim> j;
      for (int c = 0; c < Dim; ++c)
      {
        for (int k = 0; k < Dim; ++k)
        {
          double& entry = j[static_cast<std::size_t>(Dim * c + k)];
          entry = at(k + 1, c);
          if (this->Rational)
          {
            entry = (entry - at(0, c) * inverse * at(k + 1, Dim)) * inverse;
          }
        }
      }
      this->Sums.Add(j);
    }
  }

private:
  bool Rational;
  Collector<Dim>& Sums;
  const std::function<bool()>& GoOn;
  int Rows = 0;
  bool Stopped = false;
};

/// All samples of one patch.
template <int Dim>
void CollectPatch(
  const Spline<Dim>& map, int samples, Collector<Dim>& sums, const std::function<bool()>& goOn)
{
  if (map.Space->Kind == SpaceKind::Tensor)
  {
    std::array<LinePoints, Dim> lines;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      lines[d] = UniformLine(map.Space->Knots[d], samples);
    }
    const PointMatrix rows = map.HomogeneousPoints();
    const Eigen::MatrixXd planes = rows; // by columns
    MetricBody<Dim> body(map.IsRational(), sums, goOn);
    MakeTensorField<Dim>(map.Space->Knots, lines)
      ->Visit(planes.data(), nullptr, static_cast<int>(planes.cols()), map.IsRational(), body);
    return;
  }
  const BezierForm<Dim> form = MakeBezierForm<Dim>(map, 1);
  const ParametricBox<Dim> domain = map.Space->Domain();
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  PointMatrix line(samples, Dim);
  const int numLines = Dim == 2 ? samples : samples * samples;
  for (int l = 0; l < numLines && !(l % 64 == 0 && goOn && !goOn()); ++l)
  {
    for (int i = 0; i < samples; ++i)
    {
      const int index[3] = { i, l % samples, l / samples };
      for (int d = 0; d < Dim; ++d)
      {
        const std::size_t at = static_cast<std::size_t>(d);
        line(i, d) =
          domain.Lower[at] + (domain.Upper[at] - domain.Lower[at]) * index[d] / (samples - 1);
      }
    }
    EvaluateParameters<Dim>(form, line, params, batch);
    for (int i = 0; i < samples; ++i)
    {
      std::array<double, Dim * Dim> j;
      for (int c = 0; c < Dim; ++c)
      {
        for (int k = 0; k < Dim; ++k)
        {
          j[static_cast<std::size_t>(Dim * c + k)] = batch.First(i, k * Dim + c);
        }
      }
      sums.Add(j);
    }
  }
}
}

template <int Dim>
DomainMetrics MeasureMaps(const std::vector<Spline<Dim>>& patches, double area, int samples,
  const std::function<bool()>& goOn)
{
  Collector<Dim> sums;
  for (const Spline<Dim>& patch : patches)
  {
    CollectPatch<Dim>(patch, samples, sums, goOn);
  }
  return sums.Result(area, samples);
}

template DomainMetrics MeasureMaps<2>(
  const std::vector<Spline<2>>&, double, int, const std::function<bool()>&);
template DomainMetrics MeasureMaps<3>(
  const std::vector<Spline<3>>&, double, int, const std::function<bool()>&);
}
