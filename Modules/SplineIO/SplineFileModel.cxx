// SPDX-License-Identifier: BSD-3-Clause
#include "SplineFileModel.h"

#include <knotwork/SplineCore/FunctionGraph.h>

#include <algorithm>
#include <set>

namespace knotwork
{
Result<SplineModel> ModelFromFile(const SplineFile& file)
{
  SplineModel model;
  model.Warnings = file.Warnings;
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    SplinePatch patch;
    patch.Id = file.Ids.empty() ? static_cast<int>(i) : file.Ids[i];
    patch.Geometry = file.Splines[i];
    const Status status = std::visit(
      [&](auto& spline) -> Status
      {
        const Eigen::Index columns = spline.ControlPoints.cols();
        if (columns > 3)
        {
          return { ErrorCode::DimensionMismatch,
            "geometry " + std::to_string(patch.Id) + " has " + std::to_string(columns) +
              " coordinates; a grid has three" };
        }
        PointMatrix points = PointMatrix::Zero(spline.ControlPoints.rows(), 3);
        points.leftCols(columns) = spline.ControlPoints;
        if constexpr (std::is_same_v<std::decay_t<decltype(spline)>, Spline<2>>)
        {
          // the graph of a rational function is not in its space
          if (columns == 1 && spline.Space->Kind == SpaceKind::LocallyRefined &&
            !spline.IsRational())
          {
            Result<Spline<2>> graph = GraphOfFunction(spline, 1);
            if (!graph)
            {
              return graph.Status;
            }
            points = std::move(graph->ControlPoints);
          }
        }
        spline.ControlPoints = std::move(points);
        return {};
      },
      patch.Geometry);
    if (!status)
    {
      return status;
    }
    model.Patches.push_back(std::move(patch));
  }
  PatchTopology& all = model.Topology;
  for (const auto& [dimension, splines, stated] : file.MultiPatches)
  {
    all.Interfaces.insert(all.Interfaces.end(), stated.Interfaces.begin(), stated.Interfaces.end());
    all.Boundary.insert(all.Boundary.end(), stated.Boundary.begin(), stated.Boundary.end());
  }
  return model;
}

namespace
{
/// One multi-patch of every parametric dimension that has several patches or topology.
void AddMultiPatches(const SplineModel& model, SplineFile& file)
{
  const auto& all = model.Topology.Interfaces;
  const auto partial = std::count_if(
    all.begin(), all.end(), [](const PatchInterface& interface) { return interface.Partial; });
  if (partial > 0)
  {
    file.Warnings.push_back(std::to_string(partial) +
      " interfaces of sides that are one in part are left out: the format has whole ones only");
  }
  const auto dimensionOf = [&](const PatchSide& side)
  { return static_cast<int>(file.Splines[static_cast<std::size_t>(side.Patch)].index()) + 1; };
  for (int dimension = 1; dimension <= 3; ++dimension)
  {
    StatedPatches patches;
    patches.Dimension = dimension;
    for (int i = 0; i < static_cast<int>(file.Splines.size()); ++i)
    {
      if (dimensionOf({ i, 0 }) == dimension)
      {
        patches.Splines.push_back(i);
      }
    }
    for (const PatchInterface& interface : all)
    {
      if (dimensionOf(interface.Sides[0]) == dimension && !interface.Partial)
      {
        patches.Topology.Interfaces.push_back(interface);
      }
    }
    for (const PatchSide& side : model.Topology.Boundary)
    {
      if (dimensionOf(side) == dimension)
      {
        patches.Topology.Boundary.push_back(side);
      }
    }
    if (patches.Splines.size() > 1 || !patches.Topology.Interfaces.empty() ||
      !patches.Topology.Boundary.empty())
    {
      file.MultiPatches.push_back(std::move(patches));
    }
  }
}
}

Result<SplineFile> FileFromModel(const SplineModel& model, int coordinates)
{
  SplineFile file;
  file.Warnings = model.Warnings;
  std::set<int> distinct;
  std::set<std::string> fields;
  Eigen::Index needed = 2; // coordinates that are not 0
  for (const SplinePatch& patch : model.Patches)
  {
    file.Splines.push_back(patch.Geometry);
    file.Ids.push_back(patch.Id);
    distinct.insert(patch.Id);
    for (const SplineField& field : patch.Fields)
    {
      fields.insert(field.Name);
    }
    std::visit(
      [&](const auto& spline)
      {
        const bool inPlane = (spline.ControlPoints.col(2).array() == 0.0).all();
        needed = inPlane && patch.Geometry.index() < 2 ? needed : 3;
      },
      patch.Geometry);
  }
  if (distinct.size() != file.Ids.size() || (!distinct.empty() && *distinct.begin() < 0))
  {
    for (std::size_t i = 0; i < file.Ids.size(); ++i)
    {
      file.Ids[i] = static_cast<int>(i);
    }
    file.Warnings.emplace_back("patches have been numbered anew: their ids were not distinct");
  }
  for (const std::string& field : fields)
  {
    file.Warnings.push_back("the field " + field + " is left out: the format has no fields");
  }
  const Eigen::Index columns = coordinates > 0 ? coordinates : needed;
  for (std::size_t i = 0; i < file.Splines.size(); ++i)
  {
    const bool fits = std::visit(
      [&](auto& spline)
      {
        const Eigen::Index rest = spline.ControlPoints.cols() - columns;
        if (!(spline.ControlPoints.rightCols(rest).array() == 0.0).all())
        {
          return false;
        }
        spline.ControlPoints = PointMatrix(spline.ControlPoints.leftCols(columns));
        return true;
      },
      file.Splines[i]);
    if (!fits)
    {
      return { ErrorCode::InvalidParameter,
        "patch " + std::to_string(file.Ids[i]) + " does not lie in the space of the first " +
          std::to_string(columns) + " coordinates; write all three" };
    }
  }
  AddMultiPatches(model, file);
  return file;
}
}
