// SPDX-License-Identifier: BSD-3-Clause
#include "ElementFacets.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
Eigen::VectorXd PositionAt(const GalerkinSpace& space, int element, const std::array<double, 3>& u)
{
  PointValues values;
  EvaluateFunctions(space, element, u.data(), values);
  return values.Position;
}

bool IsBefore(const CellSide& a, const CellSide& b)
{
  return a.Cell != b.Cell ? a.Cell < b.Cell : a.Side < b.Side;
}

/// A side's frame from another corner, its tangents in either order.
std::vector<FacetFrame> Turned(CellShape shape, const FacetFrame& frame)
{
  std::vector<FacetFrame> frames;
  const auto combined = [&](double a0, double b0, double a1, double b1, double a2,
                          double b2) -> FacetFrame
  {
    FacetFrame turned = frame;
    turned.Origin = frame.Point({ a0, b0 });
    for (std::size_t d = 0; d < 3; ++d)
    {
      turned.Tangents[0][d] = a1 * frame.Tangents[0][d] + b1 * frame.Tangents[1][d];
      turned.Tangents[1][d] = a2 * frame.Tangents[0][d] + b2 * frame.Tangents[1][d];
    }
    return turned;
  };
  if (NumParameters(shape) == 2)
  {
    return { combined(0, 0, 1, 0, 0, 0), combined(1, 0, -1, 0, 0, 0) };
  }
  if (shape == CellShape::Tetrahedron)
  {
    return { combined(0, 0, 1, 0, 0, 1), combined(0, 0, 0, 1, 1, 0), combined(1, 0, -1, 0, -1, 1),
      combined(1, 0, -1, 1, -1, 0), combined(0, 1, 0, -1, 1, -1), combined(0, 1, 1, -1, 0, -1) };
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const double a = corner & 1;
    const double b = corner >> 1;
    frames.push_back(combined(a, b, 1 - 2 * a, 0, 0, 1 - 2 * b));
    frames.push_back(combined(a, b, 0, 1 - 2 * b, 1 - 2 * a, 0));
  }
  return frames;
}

InnerFacet MatchedFacet(const GalerkinSpace& space, const std::array<CellSide, 2>& pair)
{
  InnerFacet facet;
  facet.Sides = pair;
  const CellShape shape = space.Shapes[static_cast<std::size_t>(pair[0].Cell)];
  const CellShape other = space.Shapes[static_cast<std::size_t>(pair[1].Cell)];
  facet.Frames[0] = MakeFacetFrame(shape, pair[0].Side);
  const std::array<double, 2> probe{ 0.3, 0.2 }; // no symmetry of a side keeps it
  const Eigen::VectorXd at = PositionAt(space, pair[0].Cell, facet.Frames[0].Point(probe));
  double best = -1.0;
  for (const FacetFrame& frame : Turned(other, MakeFacetFrame(other, pair[1].Side)))
  {
    const double distance = (PositionAt(space, pair[1].Cell, frame.Point(probe)) - at).norm();
    if (best < 0.0 || distance < best)
    {
      best = distance;
      facet.Frames[1] = frame;
    }
  }
  return facet;
}

/// Sides on one hyperplane of a patch's domain, of the elements below and above it.
struct Plane
{
  std::array<std::vector<int>, 2> Elements;
};

/// The part of an element's side that a box of the domain covers.
FacetFrame PartOfSide(
  const ParametricBox<3>& element, const ParametricBox<3>& part, CellShape shape, int side)
{
  FacetFrame frame = MakeFacetFrame(shape, side);
  const std::size_t across = AcrossSide(side);
  const auto dimension = static_cast<std::size_t>(NumParameters(shape));
  for (std::size_t d = 0, k = 0; d < dimension; ++d)
  {
    if (d != across)
    {
      const double length = element.Upper[d] - element.Lower[d];
      const double share = (part.Upper[d] - part.Lower[d]) / length;
      frame.Origin[d] = (part.Lower[d] - element.Lower[d]) / length;
      frame.Tangents[k++][d] = share;
      frame.Normal[across] *= share;
    }
  }
  return frame;
}

/// Appends the facets of a plane across direction d.
void AddFacets(
  const GalerkinSpace& space, std::size_t d, const Plane& plane, std::vector<InnerFacet>& facets)
{
  const auto box = [&](int element) -> const ParametricBox<3>&
  { return space.Boxes[static_cast<std::size_t>(element)]; };
  const auto dimension = static_cast<std::size_t>(space.Dimension);
  const std::size_t sweep = d == 0 ? 1 : 0;
  std::vector<int> above = plane.Elements[1];
  std::sort(above.begin(), above.end(),
    [&](int a, int b) { return box(a).Lower[sweep] < box(b).Lower[sweep]; });
  std::vector<double> reach; // largest upper end so far
  for (const int e : above)
  {
    reach.push_back(
      std::max(box(e).Upper[sweep], reach.empty() ? box(e).Upper[sweep] : reach.back()));
  }
  for (const int below : plane.Elements[0])
  {
    const double lower = box(below).Lower[sweep];
    auto i =
      static_cast<std::size_t>(std::upper_bound(reach.begin(), reach.end(), lower) - reach.begin());
    for (; i < above.size() && box(above[i]).Lower[sweep] < box(below).Upper[sweep]; ++i)
    {
      ParametricBox<3> part;
      bool meet = true;
      for (std::size_t k = 0; k < dimension; ++k)
      {
        part.Lower[k] = std::max(box(below).Lower[k], box(above[i]).Lower[k]);
        part.Upper[k] = std::min(box(below).Upper[k], box(above[i]).Upper[k]);
        meet = meet && (k == d || part.Lower[k] < part.Upper[k]);
      }
      if (meet)
      {
        const int side = 2 * static_cast<int>(d);
        InnerFacet facet;
        facet.Sides = { CellSide{ below, side + 1 }, CellSide{ above[i], side } };
        for (std::size_t s = 0; s < 2; ++s)
        {
          const int cell = facet.Sides[s].Cell;
          facet.Frames[s] = PartOfSide(
            box(cell), part, space.Shapes[static_cast<std::size_t>(cell)], facet.Sides[s].Side);
        }
        facets.push_back(facet);
      }
    }
  }
}
}

Result<MatchedSides> MatchSides(const GalerkinSpace& space)
{
  // sides with the same functions alone may be both ends of a ring
  struct Facet
  {
    CellSide Side;
    Eigen::VectorXd Middle;
  };
  std::map<std::vector<int>, std::vector<Facet>> facets;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const CellShape shape = space.Shapes[static_cast<std::size_t>(e)];
    for (int side = 0; side < NumElementSides(shape); ++side)
    {
      if ((space.InnerSides[static_cast<std::size_t>(e)] >> side & 1U) != 0)
      {
        continue;
      }
      const FacetFrame frame = MakeFacetFrame(shape, side);
      const double share = shape == CellShape::Tetrahedron ? 1.0 / 3.0 : 0.5;
      facets[TraceFunctions(space, { e, side })].push_back(
        { { e, side }, PositionAt(space, e, frame.Point({ share, share })) });
    }
  }
  const double size = space.Points.cwiseAbs().maxCoeff();
  MatchedSides sides;
  for (const auto& group : facets)
  {
    for (std::size_t i = 0; i < group.second.size(); ++i)
    {
      const Facet& facet = group.second[i];
      std::vector<std::size_t> same;
      for (std::size_t j = 0; j < group.second.size(); ++j)
      {
        if ((facet.Middle - group.second[j].Middle).norm() <= 1e-9 * size)
        {
          same.push_back(j);
        }
      }
      if (same.size() > 2)
      {
        return { ErrorCode::InvalidTopology,
          "side " + std::to_string(facet.Side.Side) + " of element " +
            std::to_string(facet.Side.Cell) + " belongs to three elements; remove one" };
      }
      if (same.size() == 1)
      {
        sides.Alone.push_back(facet.Side);
      }
      else if (same[0] == i)
      {
        sides.Pairs.push_back({ facet.Side, group.second[same[1]].Side });
      }
    }
  }
  std::sort(sides.Alone.begin(), sides.Alone.end(), IsBefore);
  std::sort(sides.Pairs.begin(), sides.Pairs.end(),
    [](const auto& a, const auto& b) { return IsBefore(a[0], b[0]); });
  return sides;
}

Result<std::vector<CellSide>> BoundaryFacets(const GalerkinSpace& space)
{
  auto sides = MatchSides(space);
  if (!sides)
  {
    return sides.Status;
  }
  return std::move(sides.Value.Alone);
}

Result<ElementFacets> FindFacets(const GalerkinSpace& space, bool withSmooth)
{
  auto sides = MatchSides(space);
  if (!sides)
  {
    return sides.Status;
  }
  ElementFacets facets;
  facets.Boundary = std::move(sides.Value.Alone);
  for (const auto& pair : sides.Value.Pairs)
  {
    facets.Inner.push_back(MatchedFacet(space, pair));
  }
  // neighbours have the same knot there, bit by bit
  std::map<std::tuple<int, std::size_t, double>, Plane> planes;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto index = static_cast<std::size_t>(e);
    const unsigned chosen =
      withSmooth ? space.InnerSides[index] : space.InnerSides[index] & ~space.SmoothSides[index];
    for (int side = 0; side < NumElementSides(space.Shapes[index]); ++side)
    {
      if ((chosen >> side & 1U) != 0)
      {
        const double value = SideValue(space.Boxes[index], side);
        planes[{ space.Patches[index], AcrossSide(side), value }].Elements[1 - side % 2].push_back(
          e);
      }
    }
  }
  for (const auto& plane : planes)
  {
    AddFacets(space, std::get<1>(plane.first), plane.second, facets.Inner);
  }
  return facets;
}
}
