// SPDX-License-Identifier: BSD-3-Clause
#include "TessellationParts.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

template <int Dim>
Status CheckPatch(const BezierForm<Dim>& form, std::size_t index)
{
  const std::string name = "patch " + std::to_string(index);
  if (!form.Space || form.Offsets.size() != form.Space->Elements.size() + 1)
  {
    return { ErrorCode::SizeMismatch, name + " has no Bezier form of its space" };
  }
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const int n = NumTensorFunctions<Dim>(form.Space->Elements[At(e)].Degree);
    const double* block = form.Block(e);
    const std::string place = name + ", element " + std::to_string(e);
    for (int i = 0; i < n * form.NumPlanes(); ++i)
    {
      if (!std::isfinite(block[i]))
      {
        return { ErrorCode::NonFiniteInput, place };
      }
      if (form.Rational && i >= n * form.NumComponents && !(block[i] > 0.0))
      {
        return { ErrorCode::InvalidWeight, place };
      }
    }
  }
  return {};
}

/// Values and first derivatives at uses of one patch.
template <int Dim>
Status EvaluateUses(const BezierForm<Dim>& form, const std::vector<const VertexUse*>& uses,
  double shrink, int derivatives, int threads, EvaluationBatch& batch)
{
  std::vector<int> elements(uses.size());
  PointMatrix local(static_cast<Eigen::Index>(uses.size()), Dim);
  for (std::size_t i = 0; i < uses.size(); ++i)
  {
    elements[i] = uses[i]->Element;
    for (int d = 0; d < Dim; ++d)
    {
      // A little towards the middle of the element where a limit is wanted.
      const double x = uses[i]->Local[At(d)];
      local(static_cast<Eigen::Index>(i), d) = x + shrink * (0.5 - x);
    }
  }
  EvaluationParams params;
  params.Derivatives = derivatives;
  params.Threads = threads;
  return EvaluateElements<Dim>(form, elements, local, params, batch);
}

/// Unit normal of row i of a batch; false where the derivatives are parallel or vanish.
bool NormalOf(const EvaluationBatch& batch, Eigen::Index i, const VertexUse& use, int components,
  Eigen::Vector3d& normal)
{
  std::array<Eigen::Vector3d, 2> tangent{ Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero() };
  for (std::size_t k = 0; k < 2; ++k)
  {
    for (int c = 0; c < components; ++c)
    {
      tangent[k][c] = batch.First(i, use.Tangents[k] * components + c);
    }
  }
  normal = tangent[0].cross(tangent[1]);
  const double length = normal.norm();
  if (!(length > 1e-9 * tangent[0].norm() * tangent[1].norm()) || !std::isfinite(length))
  {
    return false;
  }
  normal *= (use.Flip ? -1.0 : 1.0) / length;
  return true;
}
}

template <int Dim>
Status FinishTessellation(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, const VertexTable& vertices, const CellSoup& soup,
  TessellationMesh& mesh)
{
  const int components = patches.front().NumComponents;
  const bool polygons = Dim == 2 || (Dim == 3 && params.Output == TessellationOutput::Surface);
  const bool normals = params.Normals && polygons && (components == 2 || components == 3);

  // 1. Values at the first use of every vertex, normals at all.
  const std::size_t numUses = soup.Uses.size();
  std::vector<int> owner(At(vertices.Sets.Size()), -1);
  std::vector<char> needed(numUses, normals ? 1 : 0);
  for (std::size_t u = 0; u < numUses; ++u)
  {
    int& first = owner[At(vertices.Sets.Find(soup.Uses[u].Vertex))];
    if (first < 0)
    {
      first = static_cast<int>(u);
      needed[u] = 1;
    }
  }
  PointMatrix values(static_cast<Eigen::Index>(numUses), components);
  PointMatrix unit(normals ? static_cast<Eigen::Index>(numUses) : 0, 3);
  std::size_t next = 0; // uses follow each other patch after patch
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    std::vector<const VertexUse*> uses;
    std::vector<Eigen::Index> index;
    for (; next < numUses && soup.Uses[next].Patch == static_cast<int>(p); ++next)
    {
      if (needed[next])
      {
        uses.push_back(&soup.Uses[next]);
        index.push_back(static_cast<Eigen::Index>(next));
      }
    }
    EvaluationBatch batch;
    const BezierForm<Dim>& form = patches[p];
    Status status = EvaluateUses<Dim>(form, uses, 0.0, normals ? 1 : 0, params.Threads, batch);
    if (!status)
    {
      return status;
    }
    std::vector<const VertexUse*> singular;
    std::vector<Eigen::Index> singularIndex;
    for (std::size_t i = 0; i < uses.size(); ++i)
    {
      values.row(index[i]) = batch.Values.row(static_cast<Eigen::Index>(i));
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      if (normals && !NormalOf(batch, static_cast<Eigen::Index>(i), *uses[i], components, normal))
      {
        singular.push_back(uses[i]);
        singularIndex.push_back(index[i]);
      }
      if (normals)
      {
        unit.row(index[i]) = normal.transpose();
      }
    }
    if (!singular.empty()) // a collapsed edge or cusp: the limit from inside the element
    {
      status = EvaluateUses<Dim>(form, singular, 1e-4, 1, params.Threads, batch);
      if (!status)
      {
        return status;
      }
      for (std::size_t i = 0; i < singular.size(); ++i)
      {
        Eigen::Vector3d normal;
        if (!NormalOf(batch, static_cast<Eigen::Index>(i), *singular[i], components, normal))
        {
          normal.setZero();
        }
        unit.row(singularIndex[i]) = normal.transpose();
      }
    }
    if (params.Progress &&
      !params.Progress(
        0.3 + 0.6 * static_cast<double>(p + 1) / static_cast<double>(patches.size())))
    {
      return { ErrorCode::Aborted, "" };
    }
  }

  // 2. Points: one a vertex, or one for each patch and side of a crease.
  std::vector<int> point(numUses, -1);
  std::vector<int> source; // use of every point
  std::vector<std::vector<int>> copies(params.Splitting ? owner.size() : 0);
  std::vector<int> single(params.Splitting ? 0 : owner.size(), -1);
  std::vector<char> crease;
  PointMatrix sum;
  for (std::size_t u = 0; u < numUses; ++u)
  {
    const std::size_t v = At(vertices.Sets.Find(soup.Uses[u].Vertex));
    if (!params.Splitting)
    {
      if (single[v] < 0)
      {
        single[v] = static_cast<int>(source.size());
        source.push_back(static_cast<int>(u));
      }
      point[u] = single[v];
      continue;
    }
    for (const int candidate : copies[v])
    {
      const int other = source[At(candidate)];
      if (soup.Uses[At(other)].Patch == soup.Uses[u].Patch &&
        (!normals || (unit.row(other) - unit.row(static_cast<Eigen::Index>(u))).norm() <= 1e-6))
      {
        point[u] = candidate;
        break;
      }
    }
    if (point[u] < 0)
    {
      point[u] = static_cast<int>(source.size());
      copies[v].push_back(point[u]);
      source.push_back(static_cast<int>(u));
    }
  }
  const auto numPoints = static_cast<Eigen::Index>(source.size());
  mesh.Points.resize(numPoints, components);
  mesh.PointLocal.resize(numPoints, Dim);
  mesh.Normals.resize(normals ? numPoints : 0, 3);
  mesh.PointPatch.resize(source.size());
  mesh.PointElement.resize(source.size());
  for (Eigen::Index i = 0; i < numPoints; ++i)
  {
    const VertexUse& use = soup.Uses[At(source[At(i)])];
    mesh.Points.row(i) = values.row(owner[At(vertices.Sets.Find(use.Vertex))]);
    mesh.PointPatch[At(i)] = use.Patch;
    mesh.PointElement[At(i)] = use.Element;
    for (int d = 0; d < Dim; ++d)
    {
      mesh.PointLocal(i, d) = use.Local[At(d)];
    }
    if (normals)
    {
      mesh.Normals.row(i) = unit.row(source[At(i)]);
    }
  }
  if (normals && !params.Splitting)
  {
    // Where all uses agree the normal stays that of the owner, else it is the mean.
    sum = PointMatrix::Zero(numPoints, 3);
    crease.assign(source.size(), 0);
    for (std::size_t u = 0; u < numUses; ++u)
    {
      const auto row = static_cast<Eigen::Index>(u);
      sum.row(point[u]) += unit.row(row);
      if ((unit.row(row) - mesh.Normals.row(point[u])).norm() > 1e-6)
      {
        crease[At(point[u])] = 1;
      }
    }
    for (Eigen::Index i = 0; i < numPoints; ++i)
    {
      if (crease[At(i)] && sum.row(i).norm() > 1e-12)
      {
        mesh.Normals.row(i) = sum.row(i).normalized();
      }
    }
  }

  // 3. Cells; corners that became one vertex are dropped, and polygons without area with them.
  mesh.Offsets.push_back(0);
  for (std::size_t c = 0; c < soup.Shapes.size(); ++c)
  {
    TessellationShape shape = soup.Shapes[c];
    std::vector<int> corners;
    for (std::int64_t k = soup.Offsets[c]; k < soup.Offsets[c + 1]; ++k)
    {
      const int use = soup.Corners[At(k)];
      const auto vertex = [&](int u) { return vertices.Sets.Find(soup.Uses[At(u)].Vertex); };
      const bool repeated = polygons &&
        std::any_of(
          corners.begin(), corners.end(), [&](int other) { return vertex(other) == vertex(use); });
      if (!repeated)
      {
        corners.push_back(use);
      }
    }
    if (polygons)
    {
      if (corners.size() < 3)
      {
        continue;
      }
      shape = corners.size() == 3 ? TessellationShape::Triangle : TessellationShape::Quadrilateral;
    }
    for (const int use : corners)
    {
      mesh.Connectivity.push_back(point[At(use)]);
    }
    mesh.Offsets.push_back(static_cast<std::int64_t>(mesh.Connectivity.size()));
    mesh.Shapes.push_back(shape);
    mesh.CellPatch.push_back(soup.CellPatch[c]);
    mesh.CellElement.push_back(soup.CellElement[c]);
    if (Dim == 3 && polygons)
    {
      const VertexUse& use = soup.Uses[At(corners.front())];
      const int fixed = 3 - use.Tangents[0] - use.Tangents[1];
      mesh.CellSide.push_back(2 * fixed + (use.Local[At(fixed)] > 0.5 ? 1 : 0));
    }
  }
  return {};
}

template <int Dim>
Result<TessellationMesh> Tessellate(
  const std::vector<BezierForm<Dim>>& patches, const TessellationParams& params)
{
  if (!(params.Tolerance > 0.0) || !std::isfinite(params.Tolerance))
  {
    return { ErrorCode::InvalidParameter, "the tolerance must be positive" };
  }
  if (params.MaximumSubdivision < 0 || params.MaximumSubdivision > 10)
  {
    return { ErrorCode::InvalidParameter, "the maximum subdivision must be in [0, 10]" };
  }
  int elements = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    Status status = CheckPatch<Dim>(patches[p], p);
    if (!status)
    {
      return status;
    }
    elements += patches[p].Space->NumElements();
    if (patches[p].NumComponents != patches[0].NumComponents)
    {
      return { ErrorCode::SizeMismatch, "patches with different numbers of components" };
    }
  }
  if (elements == 0)
  {
    return { ErrorCode::EmptyInput, "no element to tessellate" };
  }
  TessellationMesh mesh;
  Status status;
  if constexpr (Dim == 1)
  {
    status = TessellateCurves(patches, params, mesh);
  }
  else if constexpr (Dim == 2)
  {
    status = TessellateSurfaces<2>(patches, params, mesh);
  }
  else
  {
    status = params.Output == TessellationOutput::Surface
      ? TessellateSurfaces<3>(patches, params, mesh)
      : TessellateVolumes(patches, params, mesh);
  }
  if (!status)
  {
    return status;
  }
  return mesh;
}

template Status FinishTessellation<1>(const std::vector<BezierForm<1>>&, const TessellationParams&,
  const VertexTable&, const CellSoup&, TessellationMesh&);
template Status FinishTessellation<2>(const std::vector<BezierForm<2>>&, const TessellationParams&,
  const VertexTable&, const CellSoup&, TessellationMesh&);
template Status FinishTessellation<3>(const std::vector<BezierForm<3>>&, const TessellationParams&,
  const VertexTable&, const CellSoup&, TessellationMesh&);
template Result<TessellationMesh> Tessellate<1>(
  const std::vector<BezierForm<1>>&, const TessellationParams&);
template Result<TessellationMesh> Tessellate<2>(
  const std::vector<BezierForm<2>>&, const TessellationParams&);
template Result<TessellationMesh> Tessellate<3>(
  const std::vector<BezierForm<3>>&, const TessellationParams&);
}
