// SPDX-License-Identifier: BSD-3-Clause
#include "PatchLayout.h"

#include "ArrangedPatch.h"
#include "DomainMeasure.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numeric>

namespace knotwork
{
namespace
{
std::string Join(const std::vector<std::string>& words)
{
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

/// Functions of a map of one patch in one direction.
constexpr int MostInADirection = 4096;

template <int Dim>
class LayoutAssembly
{
public:
  static constexpr int D = Dim - 1;
  static constexpr int NumSides = 2 * Dim;
  static constexpr int NumSideCorners = 1 << D;
  using SideCorners = std::array<int, NumSideCorners>; ///< vertices

  LayoutAssembly(const PatchLayout<Dim>& layout, const LayoutParams& params)
    : Layout(layout), Params(params)
  {
  }

  /// One patch with the given sides, which lie so on its own.
  void Arrange(const SideList<Dim>& sides, const std::array<SideOrigin, NumSides>& origins)
  {
    this->Arranged = true;
    this->Prepared = sides.Sides;
    this->Out.Size = sides.Size;
    this->Out.Corners.resize(1);
    std::iota(this->Out.Corners[0].begin(), this->Out.Corners[0].end(), 0);
    this->SideOf.resize(1);
    for (int s = 0; s < NumSides; ++s)
    {
      const std::size_t at = static_cast<std::size_t>(s);
      Side side;
      side.Patch = 0;
      side.Number = s;
      side.Vertices = this->VerticesOf(0, s);
      side.Input = origins[at].Input;
      side.Origin = origins[at];
      this->SideOf[0][at] = this->Sides.size();
      this->Sides.push_back(side);
    }
  }

  Status CheckInput()
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

  Status PrepareSides()
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

  /// Which patches share sides.
  Status FindSides()
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
              this->Names(side.Vertices) +
              ": list the corners of one of them the other way round" };
        }
        this->Out.Shared.push_back(shared);
      }
    }
    return {};
  }

  /// Which given side lies where; every side on the boundary needs one.
  Status MatchSides()
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
              ") between the corner of " + GivenSide(input) + " at " +
              PointText(point.data(), Dim) + " and the nearest vertex of the layout, " +
              this->Name(nearest) };
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

  /// Directions of patches that have the same knots, and which run backwards; the sides as splines
  /// in their patch's order of directions, all running as the first of their row.
  Status OrientSides()
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

  /// Mirrors what encloses a negative area; true when there was something.
  Result<bool> Mirror()
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

  /// A constant factor a side makes weights at vertices equal, in the plane a linear one where no
  /// constants do.
  Status MatchAllWeights()
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

  /// Directions of one row get one degree and one knot vector.
  Status UniteRows()
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

  Status CheckDirections()
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

  Status MakeSpaces()
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

  /// Control points of the given sides, and what is fixed.
  Status SetPoints()
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
            "gap of " + Digits(gap) + " (allowed " + Digits(tolerance) +
              ") between control points" + where };
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
            patch.Weights[static_cast<Eigen::Index>(i)] =
              weights[static_cast<Eigen::Index>(number)];
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

  CompatibleLayout<Dim> Out;

private:
  struct Side
  {
    int Patch = -1; ///< the first that has it
    int Number = -1;
    SideCorners Vertices{};
    bool Shared = false;
    int Input = -1;
    SideOrientation Origin;          ///< how the given side lies in the first patch's
    Spline<D> Shape;                 ///< directions in the patch's order, running as their rows
    std::array<bool, D> Backwards{}; ///< rows that run against the patch
  };

  Status MatchWeights(Side& side);

  static int Row(int patch, std::size_t direction)
  {
    return patch * Dim + static_cast<int>(direction);
  }

  SideCorners VerticesOf(int patch, int side) const
  {
    SideCorners vertices;
    for (int c = 0; c < NumSideCorners; ++c)
    {
      vertices[static_cast<std::size_t>(c)] = this->Out.Corners[static_cast<std::size_t>(
        patch)][static_cast<std::size_t>(PatchCorner<Dim>(side, c))];
    }
    return vertices;
  }

  /// How a given side lies on another with the same vertices.
  static bool Lies(const SideCorners& own, const SideCorners& given, SideOrientation& origin)
  {
    for (const SideOrientation& candidate : SideOrientations(D))
    {
      bool fits = true;
      for (int c = 0; c < NumSideCorners; ++c)
      {
        fits = fits &&
          own[static_cast<std::size_t>(c)] == given[static_cast<std::size_t>(candidate.Corner(c))];
      }
      if (fits)
      {
        origin = candidate;
        return true;
      }
    }
    return false;
  }

  std::string Name(int vertex) const
  {
    return "vertex " + std::to_string(vertex) + " at " +
      PointText(this->Out.Vertices.row(vertex).data(), Dim);
  }
  std::string Names(const SideCorners& vertices) const
  {
    std::vector<std::string> names;
    for (int v : vertices)
    {
      names.push_back(this->Name(v));
    }
    return Join(names);
  }
  static std::string NamedSide(const Side& side)
  {
    return GivenSide(side.Input) + " (" + SideName<Dim>(side.Number) + ")";
  }
  static std::string Pair(int a, int b)
  {
    return "patches " + std::to_string(a) + " and " + std::to_string(b);
  }

  const PatchLayout<Dim>& Layout;
  const LayoutParams& Params;
  std::vector<Spline<D>> Prepared;
  std::vector<Side> Sides;
  std::vector<std::array<std::size_t, NumSides>> SideOf; ///< per patch
  SignedSets Rows;
  std::map<int, double> VertexWeights;
  std::vector<std::array<KnotVector, Dim>> Knots; ///< of the patches
  bool Arranged = false;
};

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
}

template <int Dim>
Result<GluedMap<Dim>> Glue(
  const MultiPatch<Dim>& layout, const std::vector<std::array<int, 1 << Dim>>& corners)
{
  const std::vector<Spline<Dim>>& patches = layout.Patches;
  std::vector<std::int64_t> first{ 0 };
  for (const Spline<Dim>& patch : patches)
  {
    first.push_back(first.back() + patch.Space->NumFunctions);
  }
  if (first.back() > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge, "the layout has more than 2^31 - 1 control points" };
  }
  DisjointSets same(static_cast<int>(first.back()));
  for (const PatchInterface& shared : layout.Topology.Interfaces)
  {
    std::array<std::size_t, 2> patch{};
    std::array<std::vector<int>, 2> along;
    for (std::size_t i = 0; i < 2; ++i)
    {
      patch[i] = static_cast<std::size_t>(shared.Sides[i].Patch);
      along[i] = SideFunctions<Dim>(*patches[patch[i]].Space, shared.Sides[i].Side);
    }
    std::array<std::int64_t, 2> count{ 1, 1 };
    std::size_t k = 0;
    for (const std::size_t d : SideDirections<Dim>(shared.Sides[1].Side))
    {
      count[k++] = patches[patch[1]].Space->Knots[d].NumFunctions();
    }
    const std::int64_t width = shared.Orientation.OtherCount(count)[0];
    for (std::size_t j = 0; j < along[1].size(); ++j)
    {
      const std::int64_t own = static_cast<std::int64_t>(j);
      const auto at = shared.Orientation.OtherPoint({ own % count[0], own / count[0] }, count);
      const auto other = static_cast<std::size_t>(at[0] + width * at[1]);
      same.Unite(static_cast<int>(first[patch[0]]) + along[0][other],
        static_cast<int>(first[patch[1]]) + along[1][j]);
    }
  }
  GluedMap<Dim> map;
  map.Patches = patches;
  std::vector<int> numbers(static_cast<std::size_t>(first.back()), -1);
  std::vector<std::size_t> source; // where a number comes from
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    map.Functions.emplace_back();
    for (Eigen::Index row = 0; row < patches[p].Space->NumFunctions; ++row)
    {
      const int i = static_cast<int>(first[p] + row);
      const int root = same.Find(i);
      const std::size_t at = static_cast<std::size_t>(root);
      if (root == i)
      {
        numbers[at] = static_cast<int>(source.size());
        source.push_back(p);
      }
      map.Functions.back().push_back(numbers[at]);
      const std::size_t from = source[static_cast<std::size_t>(numbers[at])];
      const Eigen::Index fromRow = root - first[from];
      map.Patches[p].ControlPoints.row(row) = patches[from].ControlPoints.row(fromRow);
      if (map.Patches[p].IsRational())
      {
        map.Patches[p].Weights[row] = patches[from].Weights[fromRow];
      }
    }
  }
  map.Fixed.assign(source.size(), false);
  // a vertex, and in space an edge, is the same function in all patches that have it
  std::map<std::array<int, 2>, std::array<int, 2>> seen; // vertices; number, patch
  const auto meet = [&](std::array<int, 2> key, int number, std::size_t p) -> Status
  {
    const auto at = seen.emplace(key, std::array<int, 2>{ number, static_cast<int>(p) }).first;
    if (at->second[0] == number)
    {
      return {};
    }
    return { ErrorCode::InvalidTopology,
      "patches " + std::to_string(at->second[1]) + " and " + std::to_string(p) + " meet at " +
        (key[0] == key[1] ? "the vertex " + std::to_string(key[0])
                          : "the edge between the vertices " + std::to_string(key[0]) + " and " +
              std::to_string(key[1])) +
        ", but no patches with common sides join them there" };
  };
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const SplineSpace<Dim>& space = *patches[p].Space;
    for (int c = 0; c < (1 << Dim); ++c)
    {
      const int vertex = corners[p][static_cast<std::size_t>(c)];
      const int corner = CornerFunction<Dim>(space, c);
      const auto number = [&](int f) { return map.Functions[p][static_cast<std::size_t>(f)]; };
      if (const Status status = meet({ vertex, vertex }, number(corner), p); !status)
      {
        return status;
      }
      int stride = 1;
      for (int d = 0; d < Dim; ++d)
      {
        const int n = space.Knots[static_cast<std::size_t>(d)].NumFunctions();
        const int end = corners[p][static_cast<std::size_t>(c ^ (1 << d))];
        if (Dim == 3 && n > 2 && vertex < end)
        {
          // the first inner one seen from the lower vertex
          const int inner = corner + ((c >> d & 1) ? -stride : stride);
          if (const Status status = meet({ vertex, end }, number(inner), p); !status)
          {
            return status;
          }
        }
        stride *= n;
      }
    }
  }
  return map;
}

template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(
  const PatchLayout<Dim>& layout, const LayoutParams& params)
{
  LayoutAssembly<Dim> assembly(layout, params);
  Status status = assembly.CheckInput();
  if (status)
  {
    status = assembly.PrepareSides();
  }
  bool mirrored = true;
  while (status && mirrored) // once more after something was mirrored
  {
    for (const auto step : { &LayoutAssembly<Dim>::FindSides, &LayoutAssembly<Dim>::MatchSides,
           &LayoutAssembly<Dim>::OrientSides })
    {
      status = status ? (assembly.*step)() : status;
    }
    if (status)
    {
      const auto found = assembly.Mirror();
      status = found.Status;
      mirrored = found.Value;
    }
  }
  for (const auto step : { &LayoutAssembly<Dim>::MatchAllWeights, &LayoutAssembly<Dim>::UniteRows,
         &LayoutAssembly<Dim>::MakeSpaces, &LayoutAssembly<Dim>::SetPoints })
  {
    status = status ? (assembly.*step)() : status;
  }
  if (!status)
  {
    return status;
  }
  return std::move(assembly.Out);
}

template <int Dim>
Result<CompatibleLayout<Dim>> MakeCompatible(const SideList<Dim>& sides,
  const std::array<SideOrigin, 2 * Dim>& origins, const BoundaryParams& params)
{
  const LayoutParams layoutParams{ params.GapTolerance, 1, 1, params.MaxFunctions };
  const PatchLayout<Dim> none;
  LayoutAssembly<Dim> assembly(none, layoutParams);
  assembly.Arrange(sides, origins);
  Status status;
  for (const auto step : { &LayoutAssembly<Dim>::OrientSides, &LayoutAssembly<Dim>::MatchAllWeights,
         &LayoutAssembly<Dim>::UniteRows, &LayoutAssembly<Dim>::CheckDirections,
         &LayoutAssembly<Dim>::MakeSpaces, &LayoutAssembly<Dim>::SetPoints })
  {
    status = status ? (assembly.*step)() : status;
  }
  return status ? Result<CompatibleLayout<Dim>>(std::move(assembly.Out)) : status;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<GluedMap<Dim>> Glue<Dim>(                                                        \
    const MultiPatch<Dim>&, const std::vector<std::array<int, 1 << Dim>>&);                        \
  template Result<CompatibleLayout<Dim>> MakeCompatible<Dim>(                                      \
    const SideList<Dim>&, const std::array<SideOrigin, 2 * Dim>&, const BoundaryParams&);          \
  template Result<CompatibleLayout<Dim>> MakeCompatible<Dim>(                                      \
    const PatchLayout<Dim>&, const LayoutParams&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
