// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationPlaces.h"

#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// Unit normal of row i of a batch; false where the derivatives are parallel or vanish.
bool NormalOf(const EvaluationBatch& batch, Eigen::Index i, const CutElement& cut, int components,
  Eigen::Vector3d& normal)
{
  std::array<Eigen::Vector3d, 2> tangent{ Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() };
  for (std::size_t k = 0; k < 2; ++k)
  {
    for (int c = 0; c < components; ++c)
    {
      tangent[k][c] = batch.First(i, cut.Tangents[k] * components + c);
    }
  }
  normal = tangent[0].cross(tangent[1]);
  const double length = normal.norm();
  if (!(length > 1e-9 * tangent[0].norm() * tangent[1].norm()) || !std::isfinite(length))
  {
    return false;
  }
  normal *= (cut.Flip ? -1.0 : 1.0) / length;
  return true;
}
}

template <int Dim>
void Places<Dim>::Clear()
{
  this->Cuts.clear();
  this->Local.clear();
}

template <int Dim>
void Places<Dim>::Add(const CutElement& cut, const std::array<double, 3>& local)
{
  this->Cuts.push_back(cut);
  this->Local.push_back(local);
}

template <int Dim>
Status Places<Dim>::Evaluate(
  const std::vector<BezierForm<Dim>>& patches, bool withNormals, int threads)
{
  const auto count = static_cast<Eigen::Index>(this->Count());
  this->Values.resize(count, patches.front().NumComponents);
  this->Normals.setZero(withNormals ? count : 0, 3);
  this->Threads = threads;
  for (std::size_t begin = 0, end = 0; begin < this->Count(); begin = end)
  {
    while (end < this->Count() && this->Cuts[end].Patch == this->Cuts[begin].Patch)
    {
      ++end;
    }
    const Status status =
      this->EvaluatePatch(patches[At(this->Cuts[begin].Patch)], begin, end, withNormals);
    if (!status)
    {
      return status;
    }
  }
  return {};
}

template <int Dim>
Status Places<Dim>::EvaluatePatch(
  const BezierForm<Dim>& form, std::size_t begin, std::size_t end, bool withNormals)
{
  std::vector<std::size_t> places(end - begin);
  for (std::size_t i = begin; i < end; ++i)
  {
    places[i - begin] = i;
  }
  EvaluationBatch batch;
  Status status = this->EvaluateAt(form, places, 0.0, withNormals ? 1 : 0, batch);
  if (!status)
  {
    return status;
  }
  this->Values.middleRows(static_cast<Eigen::Index>(begin), batch.Values.rows()) = batch.Values;
  if (!withNormals)
  {
    return {};
  }
  std::vector<std::size_t> singular;
  this->TakeNormals(batch, places, form.NumComponents, singular);
  if (singular.empty())
  {
    return {};
  }
  // a collapsed edge or cusp: the limit from inside the element
  status = this->EvaluateAt(form, singular, 1e-4, 1, batch);
  if (status)
  {
    std::vector<std::size_t> without;
    this->TakeNormals(batch, singular, form.NumComponents, without);
  }
  return status;
}

template <int Dim>
void Places<Dim>::TakeNormals(const EvaluationBatch& batch, const std::vector<std::size_t>& places,
  int components, std::vector<std::size_t>& singular)
{
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    Eigen::Vector3d normal;
    if (NormalOf(batch, static_cast<Eigen::Index>(i), this->Cuts[places[i]], components, normal))
    {
      this->Normals.row(static_cast<Eigen::Index>(places[i])) = normal.transpose();
    }
    else
    {
      singular.push_back(places[i]);
    }
  }
}

template <int Dim>
Status Places<Dim>::EvaluateAt(const BezierForm<Dim>& form, const std::vector<std::size_t>& places,
  double shrink, int derivatives, EvaluationBatch& batch) const
{
  std::vector<int> elements(places.size());
  PointMatrix local(static_cast<Eigen::Index>(places.size()), Dim);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    elements[i] = this->Cuts[places[i]].Element;
    for (int d = 0; d < Dim; ++d)
    {
      const double x = this->Local[places[i]][At(d)];
      local(static_cast<Eigen::Index>(i), d) = x + shrink * (0.5 - x);
    }
  }
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = this->Threads;
  return EvaluateElements<Dim>(form, elements, local, params, batch);
}

template class Places<1>;
template class Places<2>;
template class Places<3>;
}
