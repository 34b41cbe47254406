// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestPoints.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr std::size_t Chunk = 256;
}

template <int Dim>
MappedPatch<Dim>::MappedPatch(
  const SkeletonPatch<Dim>& patch, int samples, const SplineSpace<Dim>& space)
  : Template(patch), Domain(space.Domain())
{
  this->Samples = this->Template.SamplePlaces(samples, this->Simplices);
  const PointMatrix points = this->DomainPoints(this->Samples);
  this->Index = SampleIndex(points);
  if constexpr (Dim == 3)
  {
    this->Mapped = TriangleIndex<3>(points, this->Simplices);
  }
  this->SetSpace(space);
}

template <int Dim>
void MappedPatch<Dim>::SetSpace(const SplineSpace<Dim>& space)
{
  const PointMatrix points = this->DomainPoints(this->Samples);
  this->Local.resize(points.rows(), Dim);
  this->Elements.resize(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    this->Elements[static_cast<std::size_t>(i)] =
      space.Locate(points.row(i).data(), this->Local.row(i).data());
  }
}

template <int Dim>
void MappedPatch<Dim>::Update(const BezierForm<Dim>& form, int threads)
{
  EvaluationBatch batch;
  EvaluateElements(form, this->Elements, this->Local, { 0, threads }, batch);
  this->Index.Move(batch.Values);
  if constexpr (Dim == 3)
  {
    this->Mapped.Move(batch.Values);
  }
}

template <int Dim>
void MappedPatch<Dim>::Clamp(double* point) const
{
  for (std::size_t d = 0; d < Dim; ++d)
  {
    point[d] = std::min(std::max(point[d], this->Domain.Lower[d]), this->Domain.Upper[d]);
  }
}

template <int Dim>
PointMatrix MappedPatch<Dim>::DomainPoints(const PointMatrix& places) const
{
  PointMatrix points(places.rows(), Dim);
  for (Eigen::Index i = 0; i < places.rows(); ++i)
  {
    this->Template.Evaluate(places.row(i).data(), points.row(i).data(), nullptr);
    this->Clamp(points.row(i).data());
  }
  return points;
}

template <int Dim>
PatchFeet MappedPatch<Dim>::At(const BezierForm<Dim>& form, const PointMatrixView& points,
  const PointMatrix& places, int threads) const
{
  EvaluationBatch batch;
  EvaluateParameters(form, this->DomainPoints(places), { 0, threads }, batch);
  PatchFeet result;
  result.Places = places;
  result.SquaredDistances = (points - batch.Values).rowwise().squaredNorm();
  result.Feet = std::move(batch.Values);
  return result;
}

template <>
void MappedPatch<2>::Step(const double* place, const double* target, const double* foot,
  const double* first, double* next) const
{
  using Row = Eigen::RowVector2d;
  using Map = Eigen::Map<const Row>;
  double position[2];
  double along[2];
  this->Template.Evaluate(place, position, along);
  Row tangent = Row::Zero();
  for (int d = 0; d < 2; ++d)
  {
    tangent += along[d] * Map(first + 2 * d);
  }
  const double length = tangent.squaredNorm();
  next[0] = place[0];
  if (length > 0.0)
  {
    const Row residual = Map(target) - Map(foot);
    next[0] = std::min(std::max(place[0] + residual.dot(tangent) / length, this->Template.Begin()),
      this->Template.End());
  }
}

template <>
void MappedPatch<3>::Step(const double* place, const double* target, const double* foot,
  const double* first, double* next) const
{
  using Row = Eigen::RowVector3d;
  using Map = Eigen::Map<const Row>;
  TriangleFoot best;
  this->Template.ForTrianglesAt(place,
    [&](const double* same)
    {
      Row position;
      double along[6];
      this->Template.Evaluate(same, position.data(), along);
      std::array<Row, 2> tangents{ Row::Zero(), Row::Zero() };
      for (int k = 0; k < 2; ++k)
      {
        for (int d = 0; d < 3; ++d)
        {
          tangents[static_cast<std::size_t>(k)] += along[3 * k + d] * Map(first + 3 * d);
        }
      }
      // The image of the triangle under the linear model at the place.
      const Row a = Map(foot) - same[1] * tangents[0] - same[2] * tangents[1];
      const Row b = a + tangents[0];
      const Row c = a + tangents[1];
      const TriangleFoot inside =
        ClosestOnTriangle<3>(a.data(), b.data(), c.data(), target, static_cast<int>(same[0]));
      if (inside.SquaredDistance < best.SquaredDistance)
      {
        best = inside;
      }
    });
  next[0] = double(best.Triangle);
  next[1] = best.Second;
  next[2] = best.Third;
}

template <int Dim>
PatchFeet MappedPatch<Dim>::Project(const BezierForm<Dim>& form, const PointMatrixView& points,
  const PointMatrix& known, int newtonSteps, int threads) const
{
  constexpr int Size = PlaceSize<Dim>;
  const Eigen::Index n = points.rows();
  PatchFeet best;
  if (known.rows() > 0)
  {
    best = this->At(form, points, known, threads);
  }
  else
  {
    best.Places = PointMatrix::Zero(n, Size);
    best.Feet = PointMatrix::Zero(n, Dim);
    best.SquaredDistances = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  }
  const auto each = [&](const auto& body)
  {
    ParallelFor(static_cast<std::size_t>(n), Chunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
        {
          body(i);
        }
      });
  };
  EvaluationBatch batch;
  // Takes a candidate place with its point of the mapped patch if it is nearer.
  const auto take = [&](Eigen::Index i, const double* place, const double* foot, double distance)
  {
    if (!(distance < best.SquaredDistances(i)))
    {
      return false;
    }
    std::copy(place, place + Size, best.Places.row(i).data());
    std::copy(foot, foot + Dim, best.Feet.row(i).data());
    best.SquaredDistances(i) = distance;
    return true;
  };
  each(
    [&](Eigen::Index i)
    {
      const NearestItem seed = this->Index.Nearest(points.row(i).data(), best.SquaredDistances(i));
      if (seed.Item >= 0)
      {
        take(i, this->Samples.row(seed.Item).data(), this->Index.Samples().row(seed.Item).data(),
          seed.SquaredDistance);
      }
    });
  PointMatrix trial = best.Places;
  if constexpr (Dim == 3)
  {
    const TriangleIndex<3>& mesh = this->Template.Mesh();
    each(
      [&](Eigen::Index i)
      {
        const TriangleFoot foot =
          this->Mapped.Nearest(points.row(i).data(), best.SquaredDistances(i));
        if (foot.Triangle < 0)
        {
          return;
        }
        // Sample triangles lie in one template triangle each, in its order.
        const std::size_t pieces = this->Simplices.size() / mesh.Triangles().size();
        const auto sample = static_cast<std::size_t>(foot.Triangle);
        std::array<Eigen::RowVector3d, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
        {
          this->Template.Evaluate(
            this->Samples.row(this->Simplices[sample][k]).data(), corners[k].data(), nullptr);
        }
        const Eigen::RowVector3d position = PointOfTriangle<3>(
          corners[0].data(), corners[1].data(), corners[2].data(), foot.Second, foot.Third);
        const TriangleFoot place = mesh.Foot(static_cast<int>(sample / pieces), position.data());
        trial.row(i) << double(place.Triangle), place.Second, place.Third;
      });
    PatchFeet between = this->At(form, points, trial, threads);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      take(
        i, between.Places.row(i).data(), between.Feet.row(i).data(), between.SquaredDistances(i));
    }
    trial = best.Places;
  }

  for (int step = 0; step <= newtonSteps; ++step)
  {
    EvaluateParameters(
      form, this->DomainPoints(trial), { step < newtonSteps ? 1 : 0, threads }, batch);
    each(
      [&](Eigen::Index i)
      {
        const double distance = (points.row(i) - batch.Values.row(i)).squaredNorm();
        const bool moved = trial.row(i) != best.Places.row(i);
        if (moved && !take(i, trial.row(i).data(), batch.Values.row(i).data(), distance))
        {
          trial.row(i) = best.Places.row(i);
          return; // the same step would fail again: this point is done
        }
        if ((moved || step == 0) && step < newtonSteps)
        {
          this->Step(best.Places.row(i).data(), points.row(i).data(), batch.Values.row(i).data(),
            batch.First.row(i).data(), trial.row(i).data());
        }
      });
  }
  return best;
}

template <int Dim>
TargetIndex<Dim>::TargetIndex(const SkeletonPatch<Dim>& patch)
{
  if constexpr (Dim == 3)
  {
    this->Triangles = TriangleIndex<3>(patch.Points, patch.Simplices);
    this->Neighbours =
      TriangleNeighbours(ReplaceCorners(patch.Simplices, FirstOfEqualPoints(patch.Points)));
  }
  else
  {
    this->Points = patch.Points;
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
}

template <>
double TargetIndex<2>::ItemDistance(int segment, const double* point) const
{
  const double* a = this->Points.data() + static_cast<std::ptrdiff_t>(segment) * 2;
  const double* b = a + 2;
  double along = 0.0;
  for (int d = 0; d < 2; ++d)
  {
    along += (point[d] - a[d]) * (b[d] - a[d]);
  }
  const double share =
    std::min(std::max(along * this->InverseLengths[static_cast<std::size_t>(segment)], 0.0), 1.0);
  double sum = 0.0;
  for (int d = 0; d < 2; ++d)
  {
    const double gap = point[d] - (share == 1.0 ? b[d] : a[d] + share * (b[d] - a[d]));
    sum += gap * gap;
  }
  return sum;
}

template <>
double TargetIndex<3>::ItemDistance(int triangle, const double* point) const
{
  return this->Triangles.Foot(triangle, point).SquaredDistance;
}

template <>
double TargetIndex<2>::Descend(int& segment, const double* point) const
{
  const int last = static_cast<int>(this->Points.rows()) - 2;
  double distance = this->ItemDistance(segment, point);
  for (const int step : { 1, -1 })
  {
    while (segment + step >= 0 && segment + step <= last)
    {
      const double next = this->ItemDistance(segment + step, point);
      if (!(next < distance))
      {
        break;
      }
      distance = next;
      segment += step;
    }
  }
  return distance;
}

template <>
double TargetIndex<3>::Descend(int& triangle, const double* point) const
{
  double distance = this->ItemDistance(triangle, point);
  for (bool nearer = true; nearer;)
  {
    nearer = false;
    for (const int next : this->Neighbours[static_cast<std::size_t>(triangle)])
    {
      const double other = next < 0 ? distance : this->ItemDistance(next, point);
      if (other < distance)
      {
        distance = other;
        triangle = next;
        nearer = true;
        break;
      }
    }
  }
  return distance;
}

template <int Dim>
NearestItem TargetIndex<Dim>::Nearest(const double* point, double bound) const
{
  if constexpr (Dim == 3)
  {
    const TriangleFoot foot = this->Triangles.Nearest(point, bound);
    return { foot.Triangle, foot.SquaredDistance };
  }
  else
  {
    return this->Tree.Nearest(
      point, [&](int segment) { return this->ItemDistance(segment, point); }, bound);
  }
}

template <int Dim>
Eigen::VectorXd TargetIndex<Dim>::Walk(const PointMatrixView& sequence, int threads) const
{
  Eigen::VectorXd bounds(sequence.rows());
  ParallelFor(static_cast<std::size_t>(sequence.rows()), 1024, threads,
    [&](std::size_t begin, std::size_t end)
    {
      int item = -1;
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
      {
        const double* point = sequence.row(i).data();
        if (item >= 0)
        {
          bounds(i) = this->Descend(item, point);
          continue;
        }
        const NearestItem first = this->Nearest(point);
        item = first.Item;
        bounds(i) = first.SquaredDistance;
      }
    });
  return bounds;
}

template <int Dim>
Eigen::VectorXd TargetIndex<Dim>::SquaredDistances(
  const PointMatrixView& sequence, int threads) const
{
  Eigen::VectorXd distances = this->Walk(sequence, threads);
  ParallelFor(static_cast<std::size_t>(sequence.rows()), Chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
      {
        // Rounding may find nothing within the bound.
        distances(i) = std::min(
          distances(i), this->Nearest(sequence.row(i).data(), distances(i)).SquaredDistance);
      }
    });
  return distances;
}

template <int Dim>
double TargetIndex<Dim>::LargestSquaredDistance(const PointMatrixView& sequence, int threads) const
{
  const Eigen::VectorXd bounds = this->Walk(sequence, threads);
  const auto exact = [&](Eigen::Index i)
  { return std::min(bounds(i), this->Nearest(sequence.row(i).data(), bounds(i)).SquaredDistance); };
  Eigen::Index first = 0;
  bounds.maxCoeff(&first);
  double largest = exact(first);
  for (Eigen::Index i = 0; i < bounds.size(); ++i)
  {
    if (bounds(i) > largest)
    {
      largest = std::max(largest, exact(i));
    }
  }
  return largest;
}

template class MappedPatch<2>;
template class MappedPatch<3>;
template class TargetIndex<2>;
template class TargetIndex<3>;
}
