// SPDX-License-Identifier: BSD-3-Clause
#include "TemplateProblem.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
template <int Dim>
TemplateProblem<Dim>::TemplateProblem(const Skeleton<Dim>& skeleton, const Skeleton<Dim>& target,
  const SplineSpace<Dim>& space, const TemplateMapParams<Dim>& params)
  : Threads(params.Threads), NewtonSteps(params.NewtonSteps)
{
  const bool hasNormals =
    params.Method == TemplateMapMethod::Tdm || params.Method == TemplateMapMethod::Weighted;
  for (const SkeletonPatch<Dim>& patch : skeleton)
  {
    this->Ids.push_back(patch.Id);
    this->Patches.emplace_back(patch, params.TemplateSamples, space);
  }
  for (const SkeletonPatch<Dim>& patch : target)
  {
    TargetConstraint<Dim> constraint;
    while (this->Ids[constraint.Template] != patch.Id)
    {
      ++constraint.Template;
    }
    constraint.Points = patch.Points;
    if (hasNormals)
    {
      constraint.Normals = UnitNormals(patch);
    }
    constraint.Surface = TargetIndex<Dim>(patch);
    this->FirstPlaces.push_back(this->Patches[constraint.Template].FirstPlaces(patch));
    constraint.Closest.Places = this->FirstPlaces.back();
    this->Constraints.push_back(std::move(constraint));
  }
}

template <int Dim>
void TemplateProblem<Dim>::SetSpace(const SplineSpace<Dim>& space)
{
  for (MappedPatch<Dim>& patch : this->Patches)
  {
    patch.SetSpace(space);
  }
}

template <int Dim>
bool TemplateProblem<Dim>::HasGivenPlaces() const
{
  return std::any_of(this->FirstPlaces.begin(), this->FirstPlaces.end(),
    [](const PointMatrix& places) { return places.rows() > 0; });
}

template <int Dim>
void TemplateProblem<Dim>::ForgetPlaces()
{
  for (std::size_t k = 0; k < this->Constraints.size(); ++k)
  {
    this->Constraints[k].Closest.Places = this->FirstPlaces[k];
  }
}

template <int Dim>
void TemplateProblem<Dim>::Update(const BezierForm<Dim>& form)
{
  for (MappedPatch<Dim>& patch : this->Patches)
  {
    patch.Update(form, this->Threads);
  }
  for (TargetConstraint<Dim>& c : this->Constraints)
  {
    const MappedPatch<Dim>& patch = this->Patches[c.Template];
    c.Closest = c.Closest.Places.rows() > 0
      ? patch.At(form, c.Points, c.Closest.Places, this->Threads)
      : patch.Project(form, c.Points, c.Closest.Places, this->NewtonSteps, this->Threads);
  }
}

template <int Dim>
FitSamples<Dim> TemplateProblem<Dim>::Samples() const
{
  Eigen::Index total = 0;
  Eigen::Index withNormals = 0;
  for (const TargetConstraint<Dim>& c : this->Constraints)
  {
    total += c.Points.rows();
    withNormals += c.Normals.rows();
  }
  FitSamples<Dim> samples;
  samples.Parameters.resize(total, Dim);
  samples.Residuals.resize(total, Dim);
  samples.Normals.resize(withNormals, Dim);
  Eigen::Index row = 0;
  for (const TargetConstraint<Dim>& c : this->Constraints)
  {
    const Eigen::Index n = c.Points.rows();
    samples.Parameters.middleRows(row, n) =
      this->Patches[c.Template].DomainPoints(c.Closest.Places);
    samples.Residuals.middleRows(row, n) = c.Points - c.Closest.Feet;
    if (withNormals > 0)
    {
      samples.Normals.middleRows(row, n) = c.Normals;
    }
    row += n;
  }
  return samples;
}

template <int Dim>
void TemplateProblem<Dim>::Project(
  const BezierForm<Dim>& form, bool keep, TemplateMapIteration& record)
{
  double largest = 0.0;
  record.SquaredError = 0.0;
  for (TargetConstraint<Dim>& c : this->Constraints)
  {
    const MappedPatch<Dim>& patch = this->Patches[c.Template];
    PatchFeet closest =
      patch.Project(form, c.Points, c.Closest.Places, this->NewtonSteps, this->Threads);
    largest = std::max({ largest, closest.SquaredDistances.maxCoeff(),
      c.Surface.LargestSquaredDistance(patch.MappedSamples(), this->Threads) });
    if (!keep)
    {
      c.Closest = std::move(closest);
    }
    record.SquaredError += c.Closest.SquaredDistances.sum();
  }
  record.MaxError = std::sqrt(largest);
}

template <int Dim>
PointMatrix TemplateProblem<Dim>::FarSamples(double threshold, double share) const
{
  if (share > 0.0)
  {
    std::vector<double> squares;
    for (const TargetConstraint<Dim>& c : this->Constraints)
    {
      const double* first = c.Closest.SquaredDistances.data();
      squares.insert(squares.end(), first, first + c.Closest.SquaredDistances.size());
    }
    const double size = double(squares.size());
    const auto rank =
      static_cast<std::ptrdiff_t>(std::min(size - 1.0, std::floor(size * (1.0 - share))));
    std::nth_element(squares.begin(), squares.begin() + rank, squares.end());
    threshold = std::max(threshold, std::sqrt(squares[static_cast<std::size_t>(rank)]));
  }
  std::vector<double> far;
  for (const TargetConstraint<Dim>& c : this->Constraints)
  {
    const PointMatrix places = this->Patches[c.Template].DomainPoints(c.Closest.Places);
    for (Eigen::Index i = 0; i < places.rows(); ++i)
    {
      if (c.Closest.SquaredDistances(i) >= threshold * threshold)
      {
        far.insert(far.end(), places.row(i).data(), places.row(i).data() + Dim);
      }
    }
  }
  return Eigen::Map<const PointMatrix>(
    far.data(), static_cast<Eigen::Index>(far.size() / Dim), Dim);
}

template <int Dim>
void TemplateProblem<Dim>::Report(TemplateMapResult<Dim>& result) const
{
  const SplineSpace<Dim>& space = *result.Map.Space;
  result.ElementErrors.assign(static_cast<std::size_t>(space.NumElements()), 0.0);
  const auto raise = [&](int element, double error)
  {
    double& largest = result.ElementErrors[static_cast<std::size_t>(element)];
    largest = std::max(largest, error);
  };
  for (std::size_t k = 0; k < this->Patches.size(); ++k)
  {
    const MappedPatch<Dim>& patch = this->Patches[k];
    MappedSkeletonPatch mapped;
    mapped.Id = this->Ids[k];
    mapped.Free = true;
    mapped.Places = patch.SamplePlaces();
    mapped.Points = patch.MappedSamples();
    if constexpr (Dim == 3)
    {
      mapped.Triangles = patch.SampleSimplices();
    }
    mapped.Distances = Eigen::VectorXd::Constant(mapped.Points.rows(), -1.0);
    result.Skeleton.push_back(std::move(mapped));
  }
  for (const TargetConstraint<Dim>& c : this->Constraints)
  {
    const MappedPatch<Dim>& patch = this->Patches[c.Template];
    MappedSkeletonPatch& mapped = result.Skeleton[c.Template];
    mapped.Free = false;
    mapped.Distances = c.Surface.SquaredDistances(mapped.Points, this->Threads).cwiseSqrt();
    for (Eigen::Index i = 0; i < mapped.Distances.size(); ++i)
    {
      raise(patch.SampleElements()[static_cast<std::size_t>(i)], mapped.Distances(i));
    }
    result.Places.push_back(c.Closest.Places);
    result.SampleErrors.push_back(c.Closest.SquaredDistances.cwiseSqrt());
    const PointMatrix places = patch.DomainPoints(c.Closest.Places);
    for (Eigen::Index i = 0; i < places.rows(); ++i)
    {
      double local[Dim];
      raise(space.Locate(places.row(i).data(), local), result.SampleErrors.back()(i));
    }
  }
}

template class TemplateProblem<2>;
template class TemplateProblem<3>;
}
