// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryData.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/BezierCells.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace knotwork
{
namespace
{
double Diagonal(const SplineModel& model)
{
  Eigen::RowVector3d lower = Eigen::RowVector3d::Constant(LargestNumber);
  Eigen::RowVector3d upper = -lower;
  for (const SplinePatch& patch : model.Patches)
  {
    std::visit(
      [&](const auto& spline)
      {
        if (spline.ControlPoints.rows() > 0)
        {
          lower = lower.cwiseMin(spline.ControlPoints.colwise().minCoeff());
          upper = upper.cwiseMax(spline.ControlPoints.colwise().maxCoeff());
        }
      },
      patch.Geometry);
  }
  return (upper - lower).norm();
}

template <int Dim>
Result<BoundaryMesh> TriangulatePatches(const SplineModel& model, const TessellationParams& params)
{
  std::vector<BezierForm<Dim>> forms;
  for (const SplinePatch& patch : model.Patches)
  {
    forms.push_back(MakeBezierForm(std::get<Spline<Dim>>(patch.Geometry), params.Threads));
  }
  const auto polygons = Tessellate<Dim>(forms, params);
  if (!polygons)
  {
    return polygons.Status;
  }
  auto boundary = MakeBoundaryMesh(polygons.Value);
  for (int& patch : boundary->Patches)
  {
    patch = model.Patches[static_cast<std::size_t>(patch)].Id;
  }
  return boundary;
}

Result<BoundaryMesh> TriangulateTrimmed(
  const TrimmedModel& model, const SplineModel& patches, const TessellationParams& asked)
{
  TrimmedMeshParams params;
  params.Tolerance = asked.Tolerance;
  params.Threads = asked.Threads;
  params.Progress = asked.Progress;
  auto mesh = TriangulateFacesFiner(model, params);
  if (!mesh)
  {
    return mesh.Status;
  }
  BoundaryMesh boundary;
  boundary.Mesh = { std::move(mesh->Points), std::move(mesh->Triangles) };
  boundary.Faces = std::move(mesh->TriangleFace);
  boundary.Bound = mesh->Bound;
  for (const int face : boundary.Faces)
  {
    const auto patch = static_cast<std::size_t>(face);
    boundary.Patches.push_back(patch < patches.Patches.size() ? patches.Patches[patch].Id : face);
  }
  const Status status = FinishBoundary(boundary);
  return status ? Result<BoundaryMesh>(std::move(boundary)) : Result<BoundaryMesh>(status);
}
}

bool HasSplineCells(vtkDataObject* data)
{
  for (const auto& [block, grid] : GridsByBlock(data))
  {
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      if (BezierCellDimension(grid->GetCellType(cell)) > 1)
      {
        return true;
      }
    }
  }
  return false;
}

Result<BoundaryMesh> TriangulateBoundary(
  vtkDataObject* data, const SplineModel& model, const BoundaryOptions& options)
{
  const std::size_t dimension = model.Patches.front().Geometry.index();
  const bool mixed = std::any_of(model.Patches.begin(), model.Patches.end(),
    [&](const SplinePatch& patch) { return patch.Geometry.index() != dimension; });
  if (mixed || dimension == 0)
  {
    return { ErrorCode::DimensionMismatch,
      mixed ? "there are patches of several dimensions: select those of one"
            : "curves bound nothing: give surfaces or volumes" };
  }
  TessellationParams params;
  const double size = options.Relative ? Diagonal(model) : 1.0;
  params.Tolerance = options.Tolerance * (size > 0.0 ? size : 1.0);
  params.MaximumSubdivision = 10;
  params.Normals = false;
  params.Threads = options.Threads;
  params.Progress = options.Progress;
  if (dimension == 2)
  {
    return TriangulatePatches<3>(model, params);
  }
  const bool isTensor = std::all_of(model.Patches.begin(), model.Patches.end(),
    [](const SplinePatch& patch)
    { return std::get<Spline<2>>(patch.Geometry).Space->Kind == SpaceKind::Tensor; });
  if (isTensor)
  {
    const auto trimmed = DecodeTrimmedModel(data, nullptr);
    if (!trimmed)
    {
      return trimmed.Status;
    }
    if (std::any_of(trimmed->Faces.begin(), trimmed->Faces.end(),
          [](const TrimmedFace& face) { return !face.Loops.empty(); }))
    {
      return TriangulateTrimmed(trimmed.Value, model, params);
    }
  }
  return TriangulatePatches<2>(model, params);
}
}
