// SPDX-License-Identifier: BSD-3-Clause
#include "MultiPatch.h"

#include "BezierForm.h"
#include "BoxTree.h"
#include "FunctionMap.h"
#include "LROperations.h"
#include "PatchTraces.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

std::string SideText(const PatchSide& side)
{
  return "side " + std::to_string(side.Side) + " of patch " + std::to_string(side.Patch);
}
}

Status CheckTopology(const PatchTopology& topology, int numPatches, int dimension)
{
  const auto check = [&](const PatchSide& side) -> Status
  {
    if (side.Patch < 0 || side.Patch >= numPatches || side.Side < 0 || side.Side >= 2 * dimension)
    {
      return { ErrorCode::InvalidTopology, "there is no " + SideText(side) };
    }
    return {};
  };
  const int orientations = static_cast<int>(SideOrientations(dimension - 1).size());
  for (const PatchInterface& interface : topology.Interfaces)
  {
    for (const PatchSide& side : interface.Sides)
    {
      if (Status status = check(side); !status)
      {
        return status;
      }
    }
    if (interface.Orientation.Number() >= orientations)
    {
      return { ErrorCode::InvalidTopology,
        SideText(interface.Sides[1]) + " has no orientation " +
          std::to_string(interface.Orientation.Number()) };
    }
  }
  for (const PatchSide& side : topology.Boundary)
  {
    if (Status status = check(side); !status)
    {
      return status;
    }
  }
  return {};
}

void SharedSides::Add(
  const PatchSide& side, const std::array<std::int64_t, 2>& count, const std::vector<int>& numbers)
{
  // the least of the ways to write the numbers down
  std::string key;
  First own{ side, {} };
  const int numDirections = count[1] > 1 ? 2 : count[0] > 1 ? 1 : 0;
  for (const SideOrientation& orientation : SideOrientations(numDirections))
  {
    const std::array<std::int64_t, 2> size = orientation.OtherCount(count);
    std::vector<int> ordered{ static_cast<int>(size[0]), static_cast<int>(size[1]) };
    for (std::int64_t j = 0; j < size[1]; ++j)
    {
      for (std::int64_t i = 0; i < size[0]; ++i)
      {
        const auto at = orientation.OwnPoint({ i, j }, count);
        ordered.push_back(numbers[At(at[0] + count[0] * at[1])]);
      }
    }
    std::string bytes(reinterpret_cast<const char*>(ordered.data()), ordered.size() * sizeof(int));
    if (key.empty() || bytes < key)
    {
      key = std::move(bytes);
      own.Orientation = orientation;
    }
  }
  const auto [found, isNew] = this->Known.emplace(std::move(key), own);
  if (!isNew && !(found->second.Side == side))
  {
    PatchInterface interface;
    interface.Sides = { found->second.Side, side };
    interface.Orientation = Chained(own.Orientation, found->second.Orientation.Inverse());
    this->Interfaces.push_back(interface);
  }
}

template <int Dim>
std::vector<PatchInterface> FindInterfaces(const std::vector<Spline<Dim>>& patches)
{
  const std::vector<PatchTrace<Dim>> traces = FindSharedTraces<Dim>(patches);
  const auto sideOf = [](const PatchTrace<Dim>& trace)
  {
    PatchSide side{ trace.Patch, 0 };
    while (trace.Entity[AcrossSide(side.Side)] != side.Side % 2)
    {
      ++side.Side;
    }
    return side;
  };
  std::vector<PatchInterface> interfaces;
  for (std::size_t i = 0; i < traces.size(); ++i)
  {
    if (traces[i].Free == Dim - 1 && traces[i].Owner != static_cast<int>(i))
    {
      PatchInterface interface;
      interface.Sides = { sideOf(traces[At(traces[i].Owner)]), sideOf(traces[i]) };
      interface.Orientation = traces[i].OnOwner;
      interfaces.push_back(interface);
    }
  }
  return interfaces;
}

template <int Dim>
Result<std::vector<SideSamples>> SampleSides(
  const std::vector<Spline<Dim>>& patches, int samples, int threads)
{
  if (samples < 2)
  {
    return { ErrorCode::InvalidParameter, "sides are compared at 2 or more samples a direction" };
  }
  IntArray<Dim - 1> shape;
  shape.fill(samples);
  std::vector<SideSamples> sides;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const Spline<Dim>& patch = patches[p];
    Status status = patch.Check();
    if (status && !patch.Space->HasDomain())
    {
      status = { ErrorCode::DimensionMismatch, "a patch without a parameter domain" };
    }
    if (!status)
    {
      return { status.Code, "patch " + std::to_string(p) + ": " + status.Detail };
    }
    const BezierForm<Dim> form = MakeBezierForm<Dim>(patch, threads);
    const ParametricBox<Dim> domain = patch.Space->Domain();
    for (int number = 0; number < 2 * Dim; ++number)
    {
      SideSamples side;
      side.Side = { static_cast<int>(p), number };
      std::fill_n(side.Count.begin(), Dim - 1, samples);
      PointMatrix parameters(side.Count[0] * side.Count[1], Dim);
      Eigen::Index row = 0;
      ForEachOffset<Dim - 1>(shape,
        [&](const IntArray<Dim - 1>& at)
        {
          parameters(row, number / 2) = SideValue<Dim>(domain, number);
          const auto directions = SideDirections<Dim>(number);
          for (std::size_t k = 0; k + 1 < Dim; ++k)
          {
            const double s = static_cast<double>(at[k]) / (samples - 1);
            parameters(row, static_cast<Eigen::Index>(directions[k])) =
              (1.0 - s) * domain.Lower[directions[k]] + s * domain.Upper[directions[k]];
          }
          ++row;
        });
      EvaluationParams params;
      params.Threads = threads;
      EvaluationBatch batch;
      EvaluateParameters<Dim>(form, parameters, params, batch);
      side.Points = std::move(batch.Values);
      sides.push_back(std::move(side));
    }
  }
  return sides;
}

std::vector<SideOrientation> FittingOrientations(
  const SideSamples& side, const SideSamples& on, double tolerance)
{
  std::vector<SideOrientation> fitting;
  const auto& count = side.Count;
  for (const SideOrientation& orientation : SideOrientations(count[1] > 1 ? 2
           : count[0] > 1                                                 ? 1
                                                                          : 0))
  {
    bool fits = orientation.OtherCount(count) == on.Count;
    for (std::int64_t j = 0; fits && j < count[1]; ++j)
    {
      for (std::int64_t i = 0; fits && i < count[0]; ++i)
      {
        const auto at = orientation.OtherPoint({ i, j }, count);
        fits =
          (side.Points.row(i + count[0] * j) - on.Points.row(at[0] + on.Count[0] * at[1])).norm() <=
          tolerance;
      }
    }
    if (fits)
    {
      fitting.push_back(orientation);
    }
  }
  return fitting;
}

bool IsCollapsed(const SideSamples& side, double tolerance)
{
  const auto near = [&](std::int64_t a, std::int64_t b)
  { return (side.Points.row(a) - side.Points.row(b)).norm() <= tolerance; };
  bool rows = true;
  bool columns = side.Count[1] > 1;
  for (std::int64_t j = 0; j < side.Count[1]; ++j)
  {
    for (std::int64_t i = 0; i < side.Count[0]; ++i)
    {
      rows = rows && near(i + side.Count[0] * j, side.Count[0] * j);
      columns = columns && near(i + side.Count[0] * j, i);
    }
  }
  return rows || columns;
}

std::vector<PatchInterface> FindInterfaces(const std::vector<SideSamples>& sides, double tolerance)
{
  std::vector<PatchInterface> interfaces;
  if (sides.empty())
  {
    return interfaces;
  }
  // Centres of sides that are one are that near; more components than the tree has tell no more.
  const Eigen::Index columns =
    std::min<Eigen::Index>(BoxTree::MaxDimension, sides.front().Points.cols());
  PointMatrix centers(static_cast<Eigen::Index>(sides.size()), columns);
  for (std::size_t s = 0; s < sides.size(); ++s)
  {
    centers.row(static_cast<Eigen::Index>(s)) = sides[s].Points.colwise().mean().leftCols(columns);
  }
  const double reach = tolerance + 1e-12 * centers.cwiseAbs().maxCoeff(); // rounding of the means
  const BoxTree tree(centers, centers);
  for (std::size_t b = 0; b < sides.size(); ++b)
  {
    const Eigen::RowVectorXd center = centers.row(static_cast<Eigen::Index>(b));
    const Eigen::RowVectorXd lower = center.array() - reach;
    const Eigen::RowVectorXd upper = center.array() + reach;
    std::vector<int> near;
    tree.ForNear(lower.data(), upper.data(),
      [&](int a)
      {
        const auto apart = (centers.row(a) - center).cwiseAbs();
        if (At(a) <= b && apart.maxCoeff() <= reach)
        {
          near.push_back(a);
        }
      });
    std::sort(near.begin(), near.end());
    for (const int a : near)
    {
      const auto fitting = FittingOrientations(sides[b], sides[At(a)], tolerance);
      const bool itself = At(a) == b;
      if (itself ? fitting.size() > 1 && !IsCollapsed(sides[b], tolerance) : !fitting.empty())
      {
        PatchInterface interface;
        interface.Sides = { sides[At(a)].Side, sides[b].Side };
        interface.Orientation = fitting[itself ? 1 : 0];
        interfaces.push_back(interface);
      }
    }
  }
  return interfaces;
}

template <int Dim>
std::vector<PatchInterface> FindInterfaces(const std::vector<ParametricBox<Dim>>& boxes)
{
  std::vector<PatchInterface> interfaces;
  for (std::size_t a = 0; a < boxes.size(); ++a)
  {
    for (std::size_t b = a + 1; b < boxes.size(); ++b)
    {
      ParametricBox<Dim> common;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        common.Lower[d] = std::max(boxes[a].Lower[d], boxes[b].Lower[d]);
        common.Upper[d] = std::min(boxes[a].Upper[d], boxes[b].Upper[d]);
      }
      for (int d = 0; d < Dim; ++d)
      {
        bool meet = common.Lower[At(d)] == common.Upper[At(d)];
        const int end = boxes[a].Upper[At(d)] == common.Lower[At(d)] ? 1 : 0; // of a's side
        PatchInterface interface;
        interface.Sides = { PatchSide{ static_cast<int>(a), 2 * d + end },
          PatchSide{ static_cast<int>(b), 2 * d + 1 - end } };
        const auto along = SideDirections<Dim>(2 * d);
        for (std::size_t k = 0; k + 1 < Dim; ++k)
        {
          const double lower = common.Lower[along[k]];
          const double upper = common.Upper[along[k]];
          meet = meet && lower < upper;
          for (std::size_t i = 0; i < 2; ++i)
          {
            const ParametricBox<Dim>& box = boxes[i == 0 ? a : b];
            interface.Parts[i].Lower[k] = lower;
            interface.Parts[i].Upper[k] = upper;
            interface.Partial =
              interface.Partial || box.Lower[along[k]] != lower || box.Upper[along[k]] != upper;
          }
        }
        if (meet)
        {
          interfaces.push_back(interface);
        }
      }
    }
  }
  return interfaces;
}

template <int Dim>
int CornerFunction(const SplineSpace<Dim>& space, int corner)
{
  int function = 0;
  int stride = 1;
  for (std::size_t k = 0; k < Dim; ++k)
  {
    const int n = space.Knots[k].NumFunctions();
    function += (corner >> k & 1) ? stride * (n - 1) : 0;
    stride *= n;
  }
  return function;
}

template <int Dim>
std::vector<int> SideFunctions(const SplineSpace<Dim>& space, int side)
{
  IntArray<Dim> count{};
  for (std::size_t d = 0; d < Dim; ++d)
  {
    count[d] = space.Knots[d].NumFunctions();
  }
  return EntityIndices<Dim>(count, EntityOfSide<Dim>(side));
}

template <int Dim>
Result<Spline<Dim - 1>> SideSpline(const Spline<Dim>& patch, int side)
{
  if (Status status = patch.Check(); !status)
  {
    return status;
  }
  if (side < 0 || side >= 2 * Dim)
  {
    return { ErrorCode::InvalidParameter,
      "there is no side " + std::to_string(side) + "; sides are 0 to " +
        std::to_string(2 * Dim - 1) };
  }
  const SplineSpace<Dim>& space = *patch.Space;
  if (!space.HasDomain())
  {
    return { ErrorCode::DimensionMismatch, "a patch without a parameter domain" };
  }
  if constexpr (Dim == 2)
  {
    if (space.Kind == SpaceKind::LocallyRefined)
    {
      return IsoCurve(patch, side / 2, SideValue<2>(space.Domain(), side), 1);
    }
  }
  const PatchEntity<Dim> entity = EntityOfSide<Dim>(side);
  if (!HasTrace<Dim>(space, entity))
  {
    return { ErrorCode::InvalidKnots,
      "the knots across side " + std::to_string(side) +
        " are not clamped: it has no control points of its own" };
  }
  const auto trace = MakeTrace<Dim, Dim - 1>(space, entity);
  return trace ? Result<Spline<Dim - 1>>(TraceOf<Dim, Dim - 1>(patch, trace.Value)) : trace.Status;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template std::vector<PatchInterface> FindInterfaces<Dim>(const std::vector<Spline<Dim>>&);       \
  template Result<std::vector<SideSamples>> SampleSides<Dim>(                                      \
    const std::vector<Spline<Dim>>&, int, int);                                                    \
  template std::vector<PatchInterface> FindInterfaces<Dim>(                                        \
    const std::vector<ParametricBox<Dim>>&);                                                       \
  template std::vector<int> SideFunctions<Dim>(const SplineSpace<Dim>&, int);                      \
  template Result<Spline<Dim - 1>> SideSpline<Dim>(const Spline<Dim>&, int);
template int CornerFunction<1>(const SplineSpace<1>&, int);
template int CornerFunction<2>(const SplineSpace<2>&, int);
template int CornerFunction<3>(const SplineSpace<3>&, int);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
