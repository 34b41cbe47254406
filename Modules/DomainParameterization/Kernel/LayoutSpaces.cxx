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
namespace
{
/// Functions of a map of one patch in one direction.
constexpr int MostInADirection = 4096;
}

template <int Dim>
Status LayoutAssembly<Dim>::MatchWeights(Side& side)
{
  MakeRational<D>(side.Shape);
  // corners of the shape: backwards where the row runs against the patch
  const auto vertexOf = [&](int corner)
  {
    int own = corner;
    for (int k = 0; k < D; ++k)
    {
      own ^= side.Backwards[static_cast<std::size_t>(k)] ? 1 << k : 0;
    }
    return side.Vertices[static_cast<std::size_t>(own)];
  };
  const auto weightAt = [&](int corner) -> double
  { return side.Shape.Weights[CornerFunction<D>(*side.Shape.Space, corner)]; };
  bool scaled = false;
  for (int c = 0; c < NumSideCorners; ++c)
  {
    const auto known = this->VertexWeights.find(vertexOf(c));
    if (known == this->VertexWeights.end())
    {
      continue;
    }
    if (!scaled)
    {
      side.Shape.Weights *= known->second / weightAt(c);
      scaled = true;
    }
    else if constexpr (Dim == 2)
    {
      if (!SameWeight(weightAt(1), known->second))
      {
        auto product = TimesLinear(side.Shape, known->second / weightAt(1));
        if (!product)
        {
          return knotwork::NamedSide(product.Status, side.Input);
        }
        side.Shape = std::move(product.Value);
      }
    }
  }
  for (int c = 0; c < NumSideCorners; ++c)
  {
    this->VertexWeights.emplace(vertexOf(c), weightAt(c));
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::MatchAllWeights()
{
  bool rational = false;
  std::map<int, std::vector<std::size_t>> touching;
  for (std::size_t i = 0; i < this->Sides.size(); ++i)
  {
    if (this->Sides[i].Input >= 0)
    {
      rational = rational || this->Sides[i].Shape.IsRational();
      for (int v : this->Sides[i].Vertices)
      {
        touching[v].push_back(i);
      }
    }
  }
  if (!rational)
  {
    return {};
  }
  std::vector<bool> done(this->Sides.size(), false);
  for (std::size_t start = 0; start < this->Sides.size(); ++start)
  {
    std::deque<std::size_t> open{ start };
    while (!open.empty())
    {
      const std::size_t i = open.front();
      open.pop_front();
      if (done[i] || this->Sides[i].Input < 0)
      {
        continue;
      }
      done[i] = true;
      if (const Status status = this->MatchWeights(this->Sides[i]); !status)
      {
        return status;
      }
      for (int v : this->Sides[i].Vertices)
      {
        open.insert(open.end(), touching[v].begin(), touching[v].end());
      }
    }
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::UniteRows()
{
  std::map<int, std::vector<SideDirection<D>>> users;
  for (Side& side : this->Sides)
  {
    const auto directions = SideDirections<Dim>(side.Number);
    for (std::size_t k = 0; side.Input >= 0 && k < D; ++k)
    {
      users[this->Rows.Find(Row(side.Patch, directions[k]))].push_back(
        { &side.Shape, static_cast<int>(k), side.Input });
    }
  }
  std::map<int, KnotVector> knots;
  for (const auto& [row, sides] : users)
  {
    auto united = UniteKnots<D>(sides, this->Params.MinDegree, this->Params.MinElements);
    if (!united)
    {
      return united.Status;
    }
    knots[row] = std::move(united.Value);
  }
  for (std::size_t p = 0; p < this->Out.Corners.size(); ++p)
  {
    std::array<KnotVector, Dim> own;
    for (int d = 0; d < Dim; ++d)
    {
      const int row = Row(static_cast<int>(p), static_cast<std::size_t>(d));
      const auto found = knots.find(this->Rows.Find(row));
      own[static_cast<std::size_t>(d)] = found == knots.end()
        ? KnotVector::Uniform(this->Params.MinDegree, this->Params.MinElements)
        : this->Rows.IsTurned(row) ? ReversedKnots(found->second)
                                   : found->second;
    }
    this->Knots.push_back(std::move(own));
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::CheckDirections()
{
  for (const KnotVector& knots : this->Knots.front())
  {
    // the Laplacian of a direction is diagonalized as a full matrix
    if (knots.NumFunctions() > MostInADirection)
    {
      return { ErrorCode::TooLarge,
        "the map would have " + std::to_string(knots.NumFunctions()) +
          " functions in one direction, the limit is " + std::to_string(MostInADirection) +
          "; give sides with fewer elements, or parts of the domain" };
    }
  }
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::MakeSpaces()
{
  bool rational = false;
  for (const Side& side : this->Sides)
  {
    rational = rational || (side.Input >= 0 && side.Shape.IsRational());
  }
  double functions = 0.0;
  for (const auto& own : this->Knots)
  {
    double count = 1.0;
    for (const KnotVector& knots : own)
    {
      count *= knots.NumFunctions();
    }
    functions += count;
  }
  if (Status status = CheckSize(functions, this->Params.MaxFunctions); !status)
  {
    return status;
  }
  MultiPatch<Dim> patches;
  patches.Topology.Interfaces = this->Out.Shared;
  for (const auto& own : this->Knots)
  {
    auto space = MakeTensorSpace<Dim>(own);
    if (!space)
    {
      return space.Status;
    }
    Spline<Dim> patch;
    patch.Space = space.Value;
    patch.ControlPoints = PointMatrix::Zero(patch.Space->NumFunctions, Dim);
    patch.Weights.setOnes(rational ? patch.Space->NumFunctions : 0);
    patches.Patches.push_back(std::move(patch));
  }
  auto glued = Glue<Dim>(patches, this->Out.Corners);
  if (!glued)
  {
    return glued.Status;
  }
  this->Out.Map = std::move(glued.Value);
  return {};
}

template <int Dim>
Status LayoutAssembly<Dim>::SetPoints()
{
  GluedMap<Dim>& map = this->Out.Map;
  // each may be as far from the vertex of a layout
  const double tolerance =
    (this->Arranged ? 1.0 : 2.0) * this->Params.GapTolerance * this->Out.Size;
  const std::size_t n = map.Fixed.size();
  std::vector<int> owner(n, -1); // side
  PointMatrix points = PointMatrix::Zero(static_cast<Eigen::Index>(n), Dim);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < this->Sides.size(); ++i)
  {
    const Side& side = this->Sides[i];
    const std::size_t p = static_cast<std::size_t>(side.Patch);
    const std::vector<int> along = SideFunctions<Dim>(*map.Patches[p].Space, side.Number);
    std::vector<int> numbers;
    for (int f : along)
    {
      numbers.push_back(map.Functions[p][static_cast<std::size_t>(f)]);
      if (!side.Shared || !this->Params.MoveInterfaces)
      {
        map.Fixed[static_cast<std::size_t>(numbers.back())] = true;
      }
    }
    if (side.Input < 0)
    {
      continue;
    }
    // as the patch runs; knots do not matter any more
    SideOrientation turned;
    std::copy(side.Backwards.begin(), side.Backwards.end(), turned.Reversed.begin());
    const Spline<D> own = Reoriented<D>(side.Shape, turned);
    for (std::size_t k = 0; k < numbers.size(); ++k)
    {
      const std::size_t number = static_cast<std::size_t>(numbers[k]);
      const Eigen::Index at = static_cast<Eigen::Index>(number);
      const Eigen::Index row = static_cast<Eigen::Index>(k);
      if (owner[number] < 0)
      {
        owner[number] = static_cast<int>(i);
        points.row(at) = own.ControlPoints.row(row);
        weights[at] = own.IsRational() ? own.Weights[row] : 1.0;
        continue;
      }
      const Side& other = this->Sides[static_cast<std::size_t>(owner[number])];
      const std::string where = this->Arranged
        ? " along the edge between " + NamedSide(other) + " and " + NamedSide(side)
        : " where " + GivenSide(other.Input) + " and " + GivenSide(side.Input) + " meet";
      const double gap = (own.ControlPoints.row(row) - points.row(at)).norm();
      this->Out.LargestGap = std::max(this->Out.LargestGap, gap);
      if (!(gap <= tolerance))
      {
        return { ErrorCode::InvalidTopology,
          "gap of " + Digits(gap) + " (allowed " + Digits(tolerance) + ") between control points" +
            where };
      }
      if (own.IsRational() && !SameWeight(own.Weights[row], weights[at]))
      {
        return { ErrorCode::InvalidWeight,
          "weights " + Digits(weights[at]) + " and " + Digits(own.Weights[row]) + where +
            " are not proportional" };
      }
    }
  }
  this->Out.Given.assign(n, false);
  for (std::size_t p = 0; p < map.Patches.size(); ++p)
  {
    Spline<Dim>& patch = map.Patches[p];
    for (std::size_t i = 0; i < map.Functions[p].size(); ++i)
    {
      const std::size_t number = static_cast<std::size_t>(map.Functions[p][i]);
      if (owner[number] >= 0)
      {
        this->Out.Given[number] = true;
        patch.ControlPoints.row(static_cast<Eigen::Index>(i)) =
          points.row(static_cast<Eigen::Index>(number));
        if (patch.IsRational())
        {
          patch.Weights[static_cast<Eigen::Index>(i)] = weights[static_cast<Eigen::Index>(number)];
        }
      }
    }
    this->Out.Inputs.emplace_back();
    this->Out.Fixed.emplace_back();
    for (std::size_t s = 0; s < NumSides; ++s)
    {
      const Side& side = this->Sides[this->SideOf[p][s]];
      this->Out.Inputs.back()[s] = side.Input;
      this->Out.Fixed.back()[s] = !side.Shared || !this->Params.MoveInterfaces;
    }
  }
  return {};
}

template Status LayoutAssembly<2>::MatchAllWeights();
template Status LayoutAssembly<2>::UniteRows();
template Status LayoutAssembly<2>::CheckDirections();
template Status LayoutAssembly<2>::MakeSpaces();
template Status LayoutAssembly<2>::SetPoints();
template Status LayoutAssembly<3>::MatchAllWeights();
template Status LayoutAssembly<3>::UniteRows();
template Status LayoutAssembly<3>::CheckDirections();
template Status LayoutAssembly<3>::MakeSpaces();
template Status LayoutAssembly<3>::SetPoints();
}
