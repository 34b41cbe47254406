// SPDX-License-Identifier: BSD-3-Clause
#include "BezierSkeleton.h"

#include "SkeletonCells.h"
#include <knotwork/JacobianValidation/CellsFromGrid.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/TemplateMapping/SkeletonSampling.h>

#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
std::string PatchName(const std::string& name, int id)
{
  return name + " patch " + std::to_string(id);
}

Result<SkeletonPatch<2>> Sample(int id, const Spline<1>& curve, int samples)
{
  return SampleCurve(id, curve, samples);
}

Result<SkeletonPatch<3>> Sample(int id, const Spline<2>& surface, int samples)
{
  return SampleSurface(id, surface, samples);
}

/// Bezier triangles, alone or among quadrilaterals: no spline spaces, cells.
Result<Skeleton<3>> SampleByCell(
  vtkUnstructuredGrid* grid, const SkeletonCells& cells, const std::string& name, int samples)
{
  const Result<GridCells> read = ReadGridCells({ grid });
  if (!read)
  {
    return { read.Status.Code, "the " + name + ": " + read.Status.Detail };
  }
  const BernsteinCells& all = read.Value.Cells;
  std::vector<int> ids; // in the order of their first cells
  std::map<int, BernsteinCells> patches;
  for (int cell = 0; cell < all.NumCells(); ++cell)
  {
    const int id = cells.PatchId(cell);
    const auto [place, isNew] = patches.try_emplace(id);
    BernsteinCells& patch = place->second;
    if (isNew)
    {
      ids.push_back(id);
      patch.NumComponents = all.NumComponents;
      patch.Rational = all.Rational;
    }
    const auto c = static_cast<std::size_t>(cell);
    const int added = patch.Add(all.Shapes[c], all.Degrees[c]);
    std::copy(all.Block(cell), all.Data.data() + all.Offsets[c + 1], patch.Block(added));
  }
  Skeleton<3> skeleton;
  for (int id : ids)
  {
    Result<SkeletonPatch<3>> patch = SampleCells(id, patches[id], samples);
    if (!patch)
    {
      return { patch.Status.Code, PatchName(name, id) + ": " + patch.Status.Detail };
    }
    skeleton.push_back(std::move(patch.Value));
  }
  return skeleton;
}
}

template <int Dim>
Result<Skeleton<Dim>> DecodeBezierSkeleton(vtkUnstructuredGrid* grid, const SkeletonCells& cells,
  const std::string& name, int samples, std::vector<std::string>* warnings)
{
  if constexpr (Dim == 3)
  {
    if (cells.HasBezierTriangles())
    {
      return SampleByCell(grid, cells, name, samples);
    }
  }
  const Result<SplineModel> model = DecodeSplineModel(grid, 1);
  if (!model)
  {
    return { model.Status.Code, "the " + name + ": " + model.Status.Detail };
  }
  Skeleton<Dim> skeleton;
  for (const SplinePatch& patch : model.Value.Patches)
  {
    const int id = cells.PatchId(patch.Cells.front());
    if (id != patch.Id)
    {
      return { ErrorCode::InvalidTopology,
        "two patches of the " + name + " have the id " + std::to_string(id) };
    }
    Result<SkeletonPatch<Dim>> sampled =
      Sample(id, std::get<Spline<Dim - 1>>(patch.Geometry), samples);
    if (!sampled)
    {
      return { sampled.Status.Code, PatchName(name, id) + ": " + sampled.Status.Detail };
    }
    skeleton.push_back(std::move(sampled.Value));
  }
  for (std::size_t i = 0; warnings && i < model.Value.Warnings.size(); ++i)
  {
    warnings->push_back("the " + name + ": " + model.Value.Warnings[i]);
  }
  return skeleton;
}

template Result<Skeleton<2>> DecodeBezierSkeleton<2>(
  vtkUnstructuredGrid*, const SkeletonCells&, const std::string&, int, std::vector<std::string>*);
template Result<Skeleton<3>> DecodeBezierSkeleton<3>(
  vtkUnstructuredGrid*, const SkeletonCells&, const std::string&, int, std::vector<std::string>*);
}
