// SPDX-License-Identifier: BSD-3-Clause
#include "LayoutAssembly.h"

#include "DomainMeasure.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace knotwork
{
template <int Dim>
Status LayoutAssembly<Dim>::CheckInput()
{
  const PatchLayout<Dim>& layout = this->Layout;
  if (!(this->Params.GapTolerance >= 0.0 && this->Params.GapTolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter,
      "gap tolerance " + Digits(this->Params.GapTolerance) + " is outside [0, 0.1]" };
  }
  if (this->Params.MinDegree < 1 || this->Params.MinDegree > 9)
  {
    return { ErrorCode::InvalidParameter, "the smallest degree must lie in [1, 9]" };
  }
  if (this->Params.MinElements < 1 || this->Params.MinElements > 1000)
  {
    return { ErrorCode::InvalidParameter, "the number of elements must lie in [1, 1000]" };
  }
  // so many at least: before faces have as many elements
  const double least = static_cast<double>(layout.Patches.size()) *
    std::pow(this->Params.MinDegree + this->Params.MinElements, Dim);
  if (Status status = CheckSize(least, this->Params.MaxFunctions); !status)
  {
    return status;
  }
  if (layout.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "the layout has no patches" };
  }
  if (layout.Sides.empty())
  {
    return { ErrorCode::EmptyInput, "the layout has no sides on the boundary" };
  }
  if (layout.Vertices.cols() != Dim)
  {
    return { ErrorCode::DimensionMismatch,
      "vertices have " + std::to_string(layout.Vertices.cols()) + " coordinates, not " +
        std::to_string(Dim) };
  }
  for (std::size_t p = 0; p < layout.Patches.size(); ++p)
  {
    const std::string patch = "patch " + std::to_string(p);
    for (std::size_t c = 0; c < layout.Patches[p].size(); ++c)
    {
      const int v = layout.Patches[p][c];
      if (v < 0 || v >= layout.Vertices.rows())
      {
        return { ErrorCode::InvalidTopology,
          patch + " has the vertex " + std::to_string(v) + ", which does not exist" };
      }
      if (!layout.Vertices.row(v).allFinite())
      {
        return { ErrorCode::NonFiniteInput, "vertex " + std::to_string(v) };
      }
      if (std::count(layout.Patches[p].begin(), layout.Patches[p].end(), v) > 1)
      {
        return { ErrorCode::InvalidTopology,
          patch + " has the vertex " + std::to_string(v) + " twice" };
      }
    }
  }
  this->Out.Corners = layout.Patches;
  this->Out.Vertices = layout.Vertices;
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::PrepareSides()
{
  auto prepared = PreparedSides<Dim>(this->Layout.Sides);
  if (!prepared)
  {
    return prepared.Status;
  }
  this->Prepared = std::move(prepared->Sides);
  this->Out.Size = prepared->Size;
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::FindSides()
{
  this->Sides.clear();
  this->Out.Shared.clear();
  const int numPatches = static_cast<int>(this->Out.Corners.size());
  std::map<SideCorners, std::size_t> known;
  this->SideOf.assign(this->Out.Corners.size(), {});
  for (int p = 0; p < numPatches; ++p)
  {
    for (int s = 0; s < NumSides; ++s)
    {
      Side side;
      side.Patch = p;
      side.Number = s;
      side.Vertices = this->VerticesOf(p, s);
      SideCorners key = side.Vertices;
      std::sort(key.begin(), key.end());
      const auto [at, isNew] = known.emplace(key, this->Sides.size());
      this->SideOf[std::size_t(p)][std::size_t(s)] = at->second;
      if (isNew)
      {
        this->Sides.push_back(side);
        continue;
      }
      Side& first = this->Sides[at->second];
      if (first.Shared)
      {
        return { ErrorCode::InvalidTopology,
          "more than two patches have the side between " + this->Names(side.Vertices) };
      }
      first.Shared = true;
      PatchInterface shared;
      shared.Sides = { PatchSide{ first.Patch, first.Number }, PatchSide{ p, s } };
      if (!Lies(side.Vertices, first.Vertices, shared.Orientation))
      {
        return { ErrorCode::InvalidTopology,
          this->Pair(first.Patch, p) + " have the same vertices at a side (" +
            this->Names(side.Vertices) + ") but in different orders" };
      }
      if (SideSign(first.Number) * SideSign(s) * shared.Orientation.Sign() != -1)
      {
        return { ErrorCode::InvalidTopology,
          this->Pair(first.Patch, p) + " are oriented differently at their side between " +
            this->Names(side.Vertices) + ": list the corners of one of them the other way round" };
      }
      this->Out.Shared.push_back(shared);
    }
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::MatchSides()
{
  const double tolerance = this->Params.GapTolerance * this->Out.Size;
  std::vector<bool> used(static_cast<std::size_t>(this->Out.Vertices.rows()), false);
  for (const auto& corners : this->Out.Corners)
  {
    for (int v : corners)
    {
      used[static_cast<std::size_t>(v)] = true;
    }
  }
  std::map<SideCorners, std::size_t> known;
  for (std::size_t i = 0; i < this->Sides.size(); ++i)
  {
    SideCorners key = this->Sides[i].Vertices;
    std::sort(key.begin(), key.end());
    known[key] = i;
  }
  for (std::size_t g = 0; g < this->Prepared.size(); ++g)
  {
    const Spline<D>& given = this->Prepared[g];
    const int input = static_cast<int>(g);
    SideCorners ends;
    for (int c = 0; c < NumSideCorners; ++c)
    {
      const auto point = given.ControlPoints.row(CornerFunction<D>(*given.Space, c));
      int nearest = -1;
      double distance = std::numeric_limits<double>::infinity();
      for (Eigen::Index v = 0; v < this->Out.Vertices.rows(); ++v)
      {
        const double d = (this->Out.Vertices.row(v) - point).norm();
        if (used[static_cast<std::size_t>(v)] && d < distance)
        {
          distance = d;
          nearest = static_cast<int>(v);
        }
      }
      if (!(distance <= tolerance))
      {
        return { ErrorCode::InvalidTopology,
          "gap of " + Digits(distance) + " (allowed " + Digits(tolerance) +
            ") between the corner of " + GivenSide(input) + " at " + PointText(point.data(), Dim) +
            " and the nearest vertex of the layout, " + this->Name(nearest) };
      }
      this->Out.LargestGap = std::max(this->Out.LargestGap, distance);
      ends[static_cast<std::size_t>(c)] = nearest;
    }
    SideCorners key = ends;
    std::sort(key.begin(), key.end());
    const auto at = known.find(key);
    SideOrientation origin;
    if (at == known.end() || !Lies(this->Sides[at->second].Vertices, ends, origin))
    {
      return { ErrorCode::InvalidTopology,
        GivenSide(input) + " joins " + this->Names(ends) + ", which is no side of a patch" };
    }
    Side& side = this->Sides[at->second];
    if (side.Input >= 0)
    {
      return { ErrorCode::InvalidTopology,
        GivenSide(side.Input) + " and " + GivenSide(input) + " both join " + this->Names(ends) };
    }
    side.Input = input;
    side.Origin = origin;
  }
  for (const Side& side : this->Sides)
  {
    if (!side.Shared && side.Input < 0)
    {
      return { ErrorCode::InvalidTopology,
        "the side of patch " + std::to_string(side.Patch) + " between " +
          this->Names(side.Vertices) + " is on the boundary and has no " +
          (Dim == 2 ? "curve" : "face") };
    }
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::OrientSides()
{
  this->Rows = SignedSets(static_cast<int>(this->Out.Corners.size()) * Dim);
  for (const PatchInterface& shared : this->Out.Shared)
  {
    const auto a = SideDirections<Dim>(shared.Sides[0].Side);
    const auto b = SideDirections<Dim>(shared.Sides[1].Side);
    for (std::size_t k = 0; k < D; ++k)
    {
      const std::size_t along = a[static_cast<std::size_t>(shared.Orientation.Axis[k])];
      if (!this->Rows.Unite(Row(shared.Sides[0].Patch, along), Row(shared.Sides[1].Patch, b[k]),
            shared.Orientation.Reversed[k]))
      {
        return { ErrorCode::InvalidTopology,
          "a row of patches comes back to patch " + std::to_string(shared.Sides[1].Patch) +
            " the other way round" };
      }
    }
  }
  for (Side& side : this->Sides)
  {
    if (side.Input < 0)
    {
      continue;
    }
    SideOrientation origin = side.Origin;
    const auto directions = SideDirections<Dim>(side.Number);
    for (std::size_t k = 0; k < D; ++k)
    {
      side.Backwards[k] = this->Rows.IsTurned(Row(side.Patch, directions[k]));
      origin.Reversed[k] = origin.Reversed[k] != side.Backwards[k];
    }
    side.Shape = Reoriented<D>(this->Prepared[static_cast<std::size_t>(side.Input)], origin);
  }
  return {};
}

template <int Dim>
Result<bool> LayoutAssembly<Dim>::Mirror()
{
  DisjointSets pieces(static_cast<int>(this->Out.Corners.size()));
  for (const PatchInterface& shared : this->Out.Shared)
  {
    pieces.Unite(shared.Sides[0].Patch, shared.Sides[1].Patch);
  }
  std::map<int, double> areas;
  const Eigen::Matrix<double, 1, Dim> center = this->Prepared.front().ControlPoints.row(0);
  for (const Side& side : this->Sides)
  {
    if (!side.Shared)
    {
      double own = 0.0;
      AddSideMeasure<Dim>(side.Shape, side.Number, center, own);
      for (bool backwards : side.Backwards)
      {
        own = backwards ? -own : own;
      }
      areas[pieces.Find(side.Patch)] += own;
    }
  }
  this->Out.Area = 0.0;
  bool mirrored = false;
  for (const auto& [piece, area] : areas)
  {
    if (!(std::abs(area) > 1e-14 * std::pow(this->Out.Size, Dim)))
    {
      return { ErrorCode::InvalidTopology,
        std::string("the sides enclose no ") + (Dim == 2 ? "area" : "volume") };
    }
    this->Out.Area += std::abs(area);
    for (std::size_t p = 0; area < 0.0 && p < this->Out.Corners.size(); ++p)
    {
      mirrored = true;
      if (pieces.Find(static_cast<int>(p)) == piece)
      {
        auto& corners = this->Out.Corners[p];
        const auto half = corners.begin() + (1 << D);
        std::swap_ranges(corners.begin(), half, half);
      }
    }
  }
  return mirrored;
}

template Status LayoutAssembly<2>::CheckInput();
template Status LayoutAssembly<2>::PrepareSides();
template Status LayoutAssembly<2>::FindSides();
template Status LayoutAssembly<2>::MatchSides();
template Status LayoutAssembly<2>::OrientSides();
template Result<bool> LayoutAssembly<2>::Mirror();
template Status LayoutAssembly<3>::CheckInput();
template Status LayoutAssembly<3>::PrepareSides();
template Status LayoutAssembly<3>::FindSides();
template Status LayoutAssembly<3>::MatchSides();
template Status LayoutAssembly<3>::OrientSides();
template Result<bool> LayoutAssembly<3>::Mirror();
}
