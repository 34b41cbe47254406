// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestPoints.h"

#include "Parallel.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr std::size_t Chunk = 256;
}

template <int Dim>
MappedPatch<Dim>::MappedPatch(
  PatchCurve curve, Eigen::VectorXd samples, const SplineSpace<Dim>& space)
  : Template(std::move(curve)), Domain(space.Domain()), Samples(std::move(samples))
{
  const PointMatrix points = this->DomainPoints(this->Samples);
  this->Local.resize(points.rows(), Dim);
  this->Elements.resize(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    this->Elements[static_cast<std::size_t>(i)] =
      space.Locate(points.row(i).data(), this->Local.row(i).data());
  }
  this->Index = SampleIndex(points);
}

template <int Dim>
void MappedPatch<Dim>::Update(const BezierForm<Dim>& form, int threads)
{
  EvaluationBatch batch;
  EvaluateElements(form, this->Elements, this->Local, { 0, threads }, batch);
  this->Index.Move(batch.Values);
}

template <int Dim>
PointMatrix MappedPatch<Dim>::DomainPoints(const Eigen::VectorXd& parameters) const
{
  PointMatrix points(parameters.size(), Dim);
  for (Eigen::Index i = 0; i < parameters.size(); ++i)
  {
    this->Template.Evaluate(parameters(i), points.row(i).data(), nullptr);
    for (int d = 0; d < Dim; ++d)
    {
      const std::size_t k = static_cast<std::size_t>(d);
      points(i, d) = std::min(std::max(points(i, d), this->Domain.Lower[k]), this->Domain.Upper[k]);
    }
  }
  return points;
}

template <int Dim>
PatchFeet MappedPatch<Dim>::At(const BezierForm<Dim>& form, const PointMatrixView& points,
  const Eigen::VectorXd& parameters, int threads) const
{
  EvaluationBatch batch;
  EvaluateParameters(form, this->DomainPoints(parameters), { 0, threads }, batch);
  PatchFeet result;
  result.Parameters = parameters;
  result.SquaredDistances = (points - batch.Values).rowwise().squaredNorm();
  result.Feet = std::move(batch.Values);
  return result;
}

template <int Dim>
PatchFeet MappedPatch<Dim>::Project(const BezierForm<Dim>& form, const PointMatrixView& points,
  const Eigen::VectorXd& known, int newtonSteps, int threads) const
{
  PatchFeet best = this->At(form, points, known, threads);
  ParallelFor(static_cast<std::size_t>(points.rows()), Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Eigen::Index i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end);
           ++i)
      {
        const NearestItem seed =
          this->Index.Nearest(points.row(i).data(), best.SquaredDistances(i));
        if (seed.Item >= 0 && seed.SquaredDistance < best.SquaredDistances(i))
        {
          best.Parameters(i) = this->Samples(seed.Item);
          best.SquaredDistances(i) = seed.SquaredDistance;
          best.Feet.row(i) = this->Index.Samples().row(seed.Item);
        }
      }
    });

  EvaluationBatch batch;
  Eigen::VectorXd trial = best.Parameters;
  for (int step = 0; step <= newtonSteps; ++step)
  {
    EvaluateParameters(
      form, this->DomainPoints(trial), { step < newtonSteps ? 1 : 0, threads }, batch);
    for (Eigen::Index i = 0; i < trial.size(); ++i)
    {
      const Eigen::Matrix<double, 1, Dim> residual = points.row(i) - batch.Values.row(i);
      const double distance = residual.squaredNorm();
      const bool moved = trial(i) != best.Parameters(i);
      if (moved && !(distance < best.SquaredDistances(i)))
      {
        trial(i) = best.Parameters(i);
        continue; // the same step would fail again: this point is done
      }
      if (moved)
      {
        best.Parameters(i) = trial(i);
        best.SquaredDistances(i) = distance;
        best.Feet.row(i) = batch.Values.row(i);
      }
      else if (step > 0)
      {
        continue;
      }
      if (step < newtonSteps)
      {
        double position[Dim];
        double along[Dim];
        this->Template.Evaluate(trial(i), position, along);
        Eigen::Matrix<double, 1, Dim> tangent = Eigen::Matrix<double, 1, Dim>::Zero();
        for (int d = 0; d < Dim; ++d)
        {
          tangent += along[d] * batch.First.row(i).segment(d * Dim, Dim);
        }
        const double length = tangent.squaredNorm();
        if (length > 0.0)
        {
          trial(i) =
            std::min(std::max(trial(i) + residual.dot(tangent) / length, this->Template.Begin()),
              this->Template.End());
        }
      }
    }
  }
  return best;
}

template <int Dim>
PolylineIndex<Dim>::PolylineIndex(PointMatrix points) : Points(std::move(points))
{
  const Eigen::Index n = this->Points.rows() - 1;
  const PointMatrix lower = this->Points.topRows(n).cwiseMin(this->Points.bottomRows(n));
  const PointMatrix upper = this->Points.topRows(n).cwiseMax(this->Points.bottomRows(n));
  this->Tree = BoxTree(lower, upper);
  this->InverseLengths.resize(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const double length = (this->Points.row(i + 1) - this->Points.row(i)).squaredNorm();
    this->InverseLengths[static_cast<std::size_t>(i)] =
      length >= std::numeric_limits<double>::min() ? 1.0 / length : 0.0;
  }
}

template <int Dim>
double PolylineIndex<Dim>::SegmentDistance(int segment, const double* point) const
{
  const double* a = this->Points.data() + static_cast<std::ptrdiff_t>(segment) * Dim;
  const double* b = a + Dim;
  double along = 0.0;
  for (int d = 0; d < Dim; ++d)
  {
    along += (point[d] - a[d]) * (b[d] - a[d]);
  }
  const double share =
    std::min(std::max(along * this->InverseLengths[static_cast<std::size_t>(segment)], 0.0), 1.0);
  double sum = 0.0;
  for (int d = 0; d < Dim; ++d)
  {
    const double gap = point[d] - (share == 1.0 ? b[d] : a[d] + share * (b[d] - a[d]));
    sum += gap * gap;
  }
  return sum;
}

template <int Dim>
NearestItem PolylineIndex<Dim>::Nearest(const double* point, double bound) const
{
  return this->Tree.Nearest(
    point, [&](int segment) { return this->SegmentDistance(segment, point); }, bound);
}

template <int Dim>
Eigen::VectorXd PolylineIndex<Dim>::Walk(const PointMatrixView& sequence, int threads) const
{
  Eigen::VectorXd bounds(sequence.rows());
  const int last = static_cast<int>(this->Points.rows()) - 2;
  ParallelFor(static_cast<std::size_t>(sequence.rows()), 1024, threads,
    [&](std::size_t begin, std::size_t end)
    {
      int segment = -1;
      for (Eigen::Index i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end);
           ++i)
      {
        const double* point = sequence.row(i).data();
        if (segment < 0)
        {
          const NearestItem first = this->Nearest(point);
          segment = first.Item;
          bounds(i) = first.SquaredDistance;
          continue;
        }
        double distance = this->SegmentDistance(segment, point);
        for (const int step : { 1, -1 })
        {
          while (segment + step >= 0 && segment + step <= last)
          {
            const double next = this->SegmentDistance(segment + step, point);
            if (!(next < distance))
            {
              break;
            }
            distance = next;
            segment += step;
          }
        }
        bounds(i) = distance;
      }
    });
  return bounds;
}

template <int Dim>
Eigen::VectorXd PolylineIndex<Dim>::SquaredDistances(
  const PointMatrixView& sequence, int threads) const
{
  Eigen::VectorXd distances = this->Walk(sequence, threads);
  ParallelFor(static_cast<std::size_t>(sequence.rows()), Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (Eigen::Index i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end);
           ++i)
      {
        distances(i) = this->Nearest(sequence.row(i).data(), distances(i)).SquaredDistance;
      }
    });
  return distances;
}

template <int Dim>
double PolylineIndex<Dim>::LargestSquaredDistance(
  const PointMatrixView& sequence, int threads) const
{
  const Eigen::VectorXd bounds = this->Walk(sequence, threads);
  Eigen::Index first = 0;
  double largest = bounds.maxCoeff(&first);
  largest = this->Nearest(sequence.row(first).data(), largest).SquaredDistance;
  for (Eigen::Index i = 0; i < bounds.size(); ++i)
  {
    if (bounds(i) > largest)
    {
      largest = std::max(largest, this->Nearest(sequence.row(i).data(), bounds(i)).SquaredDistance);
    }
  }
  return largest;
}

template class MappedPatch<2>;
template class PolylineIndex<2>;
}
