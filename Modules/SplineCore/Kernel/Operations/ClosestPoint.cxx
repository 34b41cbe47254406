// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestPoint.h"

#include "Numbers.h"
#include "Parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr std::size_t AtOnce = 4096; ///< elements that are sampled together

std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// Column of the mixed derivative (d, e) in EvaluationBatch::Second, d <= e.
template <int Dim>
int PairIndex(int d, int e)
{
  return d * Dim - d * (d - 1) / 2 + (e - d);
}

/// Regular grid on [0, 1]^Dim, first direction fastest.
template <int Dim>
RealArray<Dim> GridParameter(const std::array<int, Dim>& counts, std::int64_t index)
{
  RealArray<Dim> u;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    u[d] = static_cast<double>(index % counts[d]) / (counts[d] - 1);
    index /= counts[d];
  }
  return u;
}
}

template <int Dim>
Result<ClosestPointSearch<Dim>> ClosestPointSearch<Dim>::Create(
  std::vector<BezierForm<Dim>> patches, const ClosestPointParams& params)
{
  if ((params.Samples != 0 && (params.Samples < 2 || params.Samples > 64)) ||
    params.MaxIterations < 0 || params.MaxIterations > 1000)
  {
    return { ErrorCode::InvalidParameter,
      "samples must be 0 or in [2, 64] and iterations in [0, 1000]" };
  }
  ClosestPointSearch search;
  search.Params = params;
  std::vector<int> patchOf;
  std::int64_t numSamples = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    if (patches[p].NumComponents != patches[0].NumComponents || patches[p].NumComponents < 1 ||
      patches[p].NumComponents > BoxTree::MaxDimension)
    {
      return { ErrorCode::SizeMismatch, "all patches need the same 1 to 4 components" };
    }
    for (int e = 0; e < patches[p].Space->NumElements(); ++e)
    {
      Start start;
      start.Patch = static_cast<int>(p);
      start.Element = e;
      start.FirstSample = At(numSamples);
      std::int64_t count = 1;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        start.Counts[d] =
          params.Samples != 0 ? params.Samples : patches[p].Space->Elements[At(e)].Degree[d] + 2;
        count *= start.Counts[d];
      }
      numSamples += count;
      search.Starts.push_back(start);
    }
  }
  if (search.Starts.empty())
  {
    return { ErrorCode::EmptyInput, "no element to search" };
  }
  if (numSamples > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge, "more than 2^31 - 1 samples" };
  }
  const int c = patches[0].NumComponents;
  PointMatrix samples(numSamples, c);
  const auto numElements = static_cast<Eigen::Index>(search.Starts.size());
  PointMatrix lower(numElements, c);
  PointMatrix upper(numElements, c);
  EvaluationParams evaluation;
  evaluation.Threads = params.Threads;
  std::vector<int> elements;
  std::vector<double> parameters;
  EvaluationBatch batch;
  for (std::size_t next = 0; next < search.Starts.size();)
  {
    const BezierForm<Dim>& form = patches[At(search.Starts[next].Patch)];
    const std::size_t first = next;
    elements.clear();
    parameters.clear();
    for (; next < search.Starts.size() && next < first + AtOnce &&
         search.Starts[next].Patch == search.Starts[first].Patch;
         ++next)
    {
      const Start& start = search.Starts[next];
      std::int64_t count = 1;
      for (const int k : start.Counts)
      {
        count *= k;
      }
      for (std::int64_t i = 0; i < count; ++i)
      {
        const RealArray<Dim> u = GridParameter<Dim>(start.Counts, i);
        elements.push_back(start.Element);
        parameters.insert(parameters.end(), u.begin(), u.end());
      }
      // Convex hull property: the box of the control points holds the element.
      const int n = NumTensorFunctions<Dim>(form.Space->Elements[At(start.Element)].Degree);
      const double* block = form.Block(start.Element);
      const auto row = static_cast<Eigen::Index>(next);
      for (int d = 0; d < c; ++d)
      {
        for (int i = 0; i < n; ++i)
        {
          const double x = block[d * n + i] / (form.Rational ? block[c * n + i] : 1.0);
          lower(row, d) = i == 0 ? x : std::min(lower(row, d), x);
          upper(row, d) = i == 0 ? x : std::max(upper(row, d), x);
        }
      }
    }
    const auto count = static_cast<Eigen::Index>(elements.size());
    const Eigen::Map<const PointMatrix> local(parameters.data(), count, Dim);
    if (Status status = EvaluateElements<Dim>(form, elements, local, evaluation, batch); !status)
    {
      return status;
    }
    samples.middleRows(static_cast<Eigen::Index>(search.Starts[first].FirstSample), count) =
      batch.Values;
  }
  if (!samples.allFinite() || !lower.allFinite() || !upper.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "control points or weights of the map" };
  }
  search.Samples = std::move(samples);
  search.Hulls = BoxTree(lower, upper);
  search.Lower = std::move(lower);
  search.Upper = std::move(upper);
  search.Patches = std::move(patches);
  return search;
}

template <int Dim>
double ClosestPointSearch<Dim>::HullDistance(int item, const double* query) const
{
  double sum = 0.0;
  for (int d = 0; d < this->Hulls.Dimension(); ++d)
  {
    const double gap =
      std::max({ this->Lower(item, d) - query[d], query[d] - this->Upper(item, d), 0.0 });
    sum += gap * gap;
  }
  return sum;
}

template <int Dim>
typename ClosestPointSearch<Dim>::Candidate ClosestPointSearch<Dim>::SearchElement(
  const Start& start, const double* query, Workspace& work) const
{
  const int c = this->Hulls.Dimension();

  // Starts: the samples of the element that are nearer than their neighbours in the grid.
  std::int64_t count = 1;
  std::array<std::int64_t, Dim> stride;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    stride[d] = count;
    count *= start.Counts[d];
  }
  const double* samples = this->Samples.data() + static_cast<std::int64_t>(start.FirstSample) * c;
  std::vector<double>& distances = work.Distances;
  distances.resize(At(count));
  for (std::int64_t i = 0; i < count; ++i)
  {
    double sum = 0.0;
    for (int k = 0; k < c; ++k)
    {
      sum += (samples[i * c + k] - query[k]) * (samples[i * c + k] - query[k]);
    }
    distances[At(i)] = sum;
  }
  Candidate best;
  best.SquaredDistance = std::numeric_limits<double>::infinity();
  for (std::int64_t i = 0; i < count; ++i)
  {
    bool isStart = true;
    for (std::size_t d = 0; d < Dim && isStart; ++d)
    {
      const std::int64_t k = i / stride[d] % start.Counts[d];
      isStart = (k == 0 || distances[At(i)] < distances[At(i - stride[d])]) &&
        (k + 1 == start.Counts[d] || distances[At(i)] <= distances[At(i + stride[d])]);
    }
    if (isStart)
    {
      Candidate candidate;
      candidate.Local = GridParameter<Dim>(start.Counts, i);
      std::copy(samples + i * c, samples + (i + 1) * c, candidate.Point.begin());
      candidate.SquaredDistance = distances[At(i)];
      this->Improve(start, query, candidate, work);
      if (candidate.SquaredDistance < best.SquaredDistance)
      {
        best = candidate;
      }
    }
  }
  return best;
}

template <int Dim>
void ClosestPointSearch<Dim>::Improve(
  const Start& start, const double* query, Candidate& best, Workspace& work) const
{
  const BezierForm<Dim>& form = this->Patches[At(start.Patch)];
  const int c = form.NumComponents;
  using Vector = Eigen::Matrix<double, Dim, 1>;
  using Matrix = Eigen::Matrix<double, Dim, Dim>;

  // Derivatives come with respect to the domain: lengths of the element turn them local.
  Vector length = Vector::Ones();
  if (form.Space->HasDomain())
  {
    const auto& box = form.Space->Elements[At(start.Element)].Box;
    for (int d = 0; d < Dim; ++d)
    {
      length[d] = box.Upper[At(d)] - box.Lower[At(d)];
    }
  }
  work.Element.assign(1, start.Element);
  PointMatrix& local = work.Local;
  local.resize(1, Dim);
  EvaluationParams evaluation;
  evaluation.Threads = 1;
  evaluation.Derivatives = 2;
  const auto evaluate = [&](EvaluationBatch& at)
  { return static_cast<bool>(EvaluateElements<Dim>(form, work.Element, local, evaluation, at)); };
  for (int d = 0; d < Dim; ++d)
  {
    local(0, d) = best.Local[At(d)];
  }
  double size = 0.0;
  for (int k = 0; k < c; ++k)
  {
    size = std::max(size, std::abs(query[k]));
  }
  bool isKnown = this->Params.MaxIterations > 0 && evaluate(work.Here);
  for (int iteration = 0;
       isKnown && iteration < this->Params.MaxIterations && best.SquaredDistance > 0.0; ++iteration)
  {
    const EvaluationBatch& batch = work.Here;
    Vector gradient = Vector::Zero();
    Matrix gauss = Matrix::Zero();
    Matrix hessian = Matrix::Zero();
    for (int d = 0; d < Dim; ++d)
    {
      for (int k = 0; k < c; ++k)
      {
        const double r = batch.Values(0, k) - query[k];
        gradient[d] += r * batch.First(0, d * c + k) * length[d];
      }
      for (int e = d; e < Dim; ++e)
      {
        double tangents = 0.0;
        double curvature = 0.0;
        for (int k = 0; k < c; ++k)
        {
          const double r = batch.Values(0, k) - query[k];
          tangents += batch.First(0, d * c + k) * batch.First(0, e * c + k);
          curvature += r * batch.Second(0, PairIndex<Dim>(d, e) * c + k);
        }
        gauss(d, e) = gauss(e, d) = tangents * length[d] * length[e];
        hessian(d, e) = hessian(e, d) = (tangents + curvature) * length[d] * length[e];
      }
    }
    // Parameters at a bound that the descent direction would leave stay there.
    std::array<bool, Dim> fixed;
    for (int d = 0; d < Dim; ++d)
    {
      const double u = best.Local[At(d)];
      fixed[At(d)] = (u <= 0.0 && gradient[d] >= 0.0) || (u >= 1.0 && gradient[d] <= 0.0);
      if (fixed[At(d)])
      {
        gradient[d] = 0.0;
        for (int e = 0; e < Dim; ++e)
        {
          gauss(d, e) = gauss(e, d) = hessian(d, e) = hessian(e, d) = e == d ? 1.0 : 0.0;
        }
      }
    }
    Vector step;
    const Eigen::LLT<Matrix> newton(hessian);
    if (newton.info() == Eigen::Success)
    {
      step = -newton.solve(gradient);
    }
    else
    {
      gauss.diagonal().array() += 1e-12 * gauss.trace();
      step = -gauss.ldlt().solve(gradient);
    }
    if (!step.allFinite())
    {
      break;
    }
    // A step that promises less than what rounding makes of the distance is tried, not halved.
    const double noise = std::numeric_limits<double>::epsilon() *
      (best.SquaredDistance + 2.0 * std::sqrt(best.SquaredDistance) * size);
    const int halvings = std::abs(gradient.dot(step)) > noise ? 30 : 1;
    bool improved = false;
    double moved = 0.0;
    for (int halving = 0; halving < halvings && !improved; ++halving, step *= 0.5)
    {
      moved = 0.0;
      for (int d = 0; d < Dim; ++d)
      {
        local(0, d) = std::clamp(best.Local[At(d)] + step[d], 0.0, 1.0);
        moved = std::max(moved, std::abs(local(0, d) - best.Local[At(d)]));
      }
      if (moved == 0.0 || !evaluate(work.There))
      {
        break;
      }
      double sum = 0.0;
      for (int k = 0; k < c; ++k)
      {
        const double gap = work.There.Values(0, k) - query[k];
        sum += gap * gap;
      }
      if (sum < best.SquaredDistance)
      {
        improved = true;
        best.SquaredDistance = sum;
        for (int d = 0; d < Dim; ++d)
        {
          best.Local[At(d)] = local(0, d);
        }
        for (int k = 0; k < c; ++k)
        {
          best.Point[At(k)] = work.There.Values(0, k);
        }
        std::swap(work.Here, work.There);
      }
    }
    if (!improved || moved < 1e-15)
    {
      break;
    }
  }
}

template <int Dim>
Status ClosestPointSearch<Dim>::Find(const PointMatrixView& queries, ClosestPoints& result) const
{
  const int c = this->Hulls.Dimension();
  if (queries.cols() != c)
  {
    return { ErrorCode::SizeMismatch,
      "queries have " + std::to_string(queries.cols()) + " coordinates, the map has " +
        std::to_string(c) };
  }
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
  {
    if (!queries.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput, "query " + std::to_string(i) };
    }
    if (!AllWithinLimit(queries.row(i)))
    {
      return { ErrorCode::TooLarge, "query " + std::to_string(i) + ": " + BeyondLimit() };
    }
  }
  const PointMatrix points = queries; // rows contiguous
  const auto n = static_cast<std::size_t>(points.rows());
  result.Patches.assign(n, -1);
  result.Elements.assign(n, -1);
  result.Local.resize(points.rows(), Dim);
  result.Points.resize(points.rows(), c);
  result.Distances.resize(points.rows());

  const std::size_t block = 4096; // between progress reports
  for (std::size_t begin = 0; begin < n; begin += block)
  {
    const std::size_t size = std::min(block, n - begin);
    ParallelFor(size, 32, this->Params.Threads,
      [&](std::size_t from, std::size_t to)
      {
        Workspace work;
        for (std::size_t i = begin + from; i < begin + to; ++i)
        {
          const auto row = static_cast<Eigen::Index>(i);
          const double* query = points.data() + row * c;
          Candidate best;
          best.SquaredDistance = std::numeric_limits<double>::infinity();
          int bestItem = -1;
          this->Hulls.Nearest(query,
            [&](int item)
            {
              // rounding of box distances must not lose an element
              const double least = this->HullDistance(item, query) * (1.0 - 1e-9);
              if (least > best.SquaredDistance)
              {
                return least;
              }
              const Candidate candidate = this->SearchElement(this->Starts[At(item)], query, work);
              if (candidate.SquaredDistance < best.SquaredDistance ||
                (candidate.SquaredDistance == best.SquaredDistance && item < bestItem))
              {
                best = candidate;
                bestItem = item;
              }
              return candidate.SquaredDistance;
            });
          if (bestItem < 0) // not reached with finite data
          {
            continue;
          }
          result.Patches[i] = this->Starts[At(bestItem)].Patch;
          result.Elements[i] = this->Starts[At(bestItem)].Element;
          for (int d = 0; d < Dim; ++d)
          {
            result.Local(row, d) = best.Local[At(d)];
          }
          for (int k = 0; k < c; ++k)
          {
            result.Points(row, k) = best.Point[At(k)];
          }
          result.Distances[row] = std::sqrt(best.SquaredDistance);
        }
      });
    if (this->Params.Progress &&
      !this->Params.Progress(static_cast<double>(begin + size) / static_cast<double>(n)))
    {
      return { ErrorCode::Aborted, "" };
    }
  }
  return {};
}

template class ClosestPointSearch<1>;
template class ClosestPointSearch<2>;
template class ClosestPointSearch<3>;
}
