// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ArrangedPatch.h"
#include "PatchLayout.h"

#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Numbers.h>

#include <map>
#include <numeric>

/// Private to MakeCompatible: the steps that bring the patches of a layout together.
namespace knotwork
{
/// Words with commas and `and` between them.
inline std::string Join(const std::vector<std::string>& words)
{
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
}

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
  Status CheckInput();
  Status PrepareSides();
  /// Which patches share sides.
  Status FindSides();
  /// Which given side lies where; every side on the boundary needs one.
  Status MatchSides();
  /// Directions of patches that have the same knots, and which run backwards; the sides as splines
  /// in their patch's order of directions, all running as the first of their row.
  Status OrientSides();
  /// Mirrors what encloses a negative area; true when there was something.
  Result<bool> Mirror();
  /// A constant factor a side makes weights at vertices equal, in the plane a linear one where no
  /// constants do.
  Status MatchAllWeights();
  /// Directions of one row get one degree and one knot vector.
  Status UniteRows();
  Status CheckDirections();
  Status MakeSpaces();
  /// Control points of the given sides, and what is fixed.
  Status SetPoints();
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
}
