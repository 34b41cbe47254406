// SPDX-License-Identifier: BSD-3-Clause
#include "GmshKinds.h"

#include <algorithm>

namespace knotwork
{
namespace
{
using Place = std::array<int, 3>;
using Places = std::vector<Place>;

struct Row
{
  int Type;
  ElementShape Shape;
  int Degree;
  bool IsComplete;
};

constexpr auto Segment = ElementShape::Segment;
constexpr auto Triangle = ElementShape::Triangle;
constexpr auto Square = ElementShape::Quadrilateral;
constexpr auto Tetrahedron = ElementShape::Tetrahedron;
constexpr auto Cube = ElementShape::Hexahedron;
constexpr auto Wedge = ElementShape::Wedge;
constexpr auto Pyramid = ElementShape::Pyramid;

// of Gmsh's manual, "Node ordering" and "MSH file format"
constexpr Row Rows[] = { { 15, ElementShape::Point, 1, true }, { 1, Segment, 1, true },
  { 8, Segment, 2, true }, { 26, Segment, 3, true }, { 27, Segment, 4, true },
  { 28, Segment, 5, true }, { 2, Triangle, 1, true }, { 9, Triangle, 2, true },
  { 21, Triangle, 3, true }, { 23, Triangle, 4, true }, { 25, Triangle, 5, true },
  { 3, Square, 1, true }, { 10, Square, 2, true }, { 36, Square, 3, true }, { 37, Square, 4, true },
  { 38, Square, 5, true }, { 16, Square, 2, false }, { 4, Tetrahedron, 1, true },
  { 11, Tetrahedron, 2, true }, { 29, Tetrahedron, 3, true }, { 30, Tetrahedron, 4, true },
  { 31, Tetrahedron, 5, true }, { 5, Cube, 1, true }, { 12, Cube, 2, true }, { 92, Cube, 3, true },
  { 93, Cube, 4, true }, { 94, Cube, 5, true }, { 17, Cube, 2, false }, { 6, Wedge, 1, true },
  { 13, Wedge, 2, true }, { 18, Wedge, 2, false }, { 7, Pyramid, 1, true },
  { 19, Pyramid, 2, false } };

/// Edges and faces in the order in which Gmsh numbers the nodes on them.
struct Sides
{
  std::vector<std::array<int, 2>> Edges;
  std::vector<std::vector<int>> Faces;
};

const Sides& SidesOf(ElementShape shape)
{
  static const Sides none;
  static const Sides segment = { { { 0, 1 } }, {} };
  static const Sides triangle = { { { 0, 1 }, { 1, 2 }, { 2, 0 } }, {} };
  static const Sides square = { { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } }, {} };
  static const Sides tetrahedron = { { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 0 }, { 3, 2 }, { 3, 1 } },
    { { 0, 2, 1 }, { 0, 1, 3 }, { 0, 3, 2 }, { 3, 1, 2 } } };
  static const Sides cube = { { { 0, 1 }, { 0, 3 }, { 0, 4 }, { 1, 2 }, { 1, 5 }, { 2, 3 },
                                { 2, 6 }, { 3, 7 }, { 4, 5 }, { 4, 7 }, { 5, 6 }, { 6, 7 } },
    { { 0, 3, 2, 1 }, { 0, 1, 5, 4 }, { 0, 4, 7, 3 }, { 1, 2, 6, 5 }, { 2, 3, 7, 6 },
      { 4, 5, 6, 7 } } };
  static const Sides wedge = { { { 0, 1 }, { 0, 2 }, { 0, 3 }, { 1, 2 }, { 1, 4 }, { 2, 5 },
                                 { 3, 4 }, { 3, 5 }, { 4, 5 } },
    { { 0, 1, 4, 3 }, { 0, 3, 5, 2 }, { 1, 2, 5, 4 } } };
  static const Sides pyramid = {
    { { 0, 1 }, { 0, 3 }, { 0, 4 }, { 1, 2 }, { 1, 4 }, { 2, 3 }, { 2, 4 }, { 3, 4 } }, {}
  };
  switch (shape)
  {
    case ElementShape::Point:
      return none;
    case ElementShape::Segment:
      return segment;
    case ElementShape::Triangle:
      return triangle;
    case ElementShape::Quadrilateral:
      return square;
    case ElementShape::Tetrahedron:
      return tetrahedron;
    case ElementShape::Hexahedron:
      return cube;
    case ElementShape::Wedge:
      return wedge;
    case ElementShape::Pyramid:
      break;
  }
  return pyramid;
}

Place Sum(const Place& a, const Place& b, int times)
{
  return { a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2] };
}

/// One step from a to b, which are so many apart.
Place Step(const Place& a, const Place& b, int steps)
{
  return { (b[0] - a[0]) / steps, (b[1] - a[1]) / steps, (b[2] - a[2]) / steps };
}

/// Nodes at corners, along edges, in faces, inside; the inner ones of a face or cell are those of
/// an element of lower degree with corners next to the outer ones.
void Append(ElementShape shape, const Places& corners, int degree, Places& found)
{
  if (degree == 0)
  {
    found.push_back(corners.front());
    return;
  }
  found.insert(found.end(), corners.begin(), corners.end());
  const Sides& sides = SidesOf(shape);
  for (const auto& edge : sides.Edges)
  {
    const Place& a = corners[static_cast<std::size_t>(edge[0])];
    const Place step = Step(a, corners[static_cast<std::size_t>(edge[1])], degree);
    for (int i = 1; i < degree; ++i)
    {
      found.push_back(Sum(a, step, i));
    }
  }
  const auto inside = [&](ElementShape of, const Places& outer, int dimension)
  {
    const bool isSimplex = of == Triangle || of == Tetrahedron;
    const int lower = degree - (isSimplex ? dimension + 1 : 2);
    if (lower < 0)
    {
      return;
    }
    // the directions at the first corner: to the second, the last around it, and upward
    const std::size_t ends[3] = { 1, of == Square || of == Cube ? 3U : 2U, of == Cube ? 4U : 3U };
    Place start = outer[0];
    std::array<Place, 3> steps{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    {
      steps[d] = Step(outer[0], outer[ends[d]], degree);
      start = Sum(start, steps[d], 1);
    }
    Places inner;
    for (const Place& corner : CornersOf(of))
    {
      Place place = start;
      for (std::size_t d = 0; d < 3; ++d)
      {
        place = Sum(place, steps[d], lower * corner[d]);
      }
      inner.push_back(place);
    }
    Append(of, inner, lower, found);
  };
  for (const auto& face : sides.Faces)
  {
    Places outer;
    for (const int corner : face)
    {
      outer.push_back(corners[static_cast<std::size_t>(corner)]);
    }
    inside(face.size() == 3 ? Triangle : Square, outer, 2);
  }
  if (shape == Segment || shape == Wedge || shape == Pyramid || shape == ElementShape::Point)
  {
    return; // wedges and pyramids have degree 2 at most
  }
  inside(shape, corners, DimensionOf(shape));
}

std::vector<ElementKind> MakeKinds()
{
  std::vector<ElementKind> kinds;
  for (const Row& row : Rows)
  {
    ElementKind kind{ row.Shape, row.Degree, row.IsComplete, {} };
    if (row.IsComplete)
    {
      Places corners = CornersOf(row.Shape);
      for (Place& corner : corners)
      {
        corner = Sum({}, corner, row.Degree);
      }
      Append(row.Shape, corners, row.Degree, kind.Places);
    }
    else
    {
      kind.Places = QuadraticPlaces(row.Shape, SidesOf(row.Shape).Edges);
    }
    kinds.push_back(std::move(kind));
  }
  return kinds;
}
}

Result<ElementKind> GmshKind(int type)
{
  static const std::vector<ElementKind> kinds = MakeKinds();
  for (std::size_t k = 0; k < kinds.size(); ++k)
  {
    if (Rows[k].Type == type)
    {
      return kinds[k];
    }
  }
  const std::string name = "elements of type " + std::to_string(type);
  if (type == 14)
  {
    return { ErrorCode::InvalidParameter,
      name +
        " (pyramids of 14 nodes) have no cell; save them with 13: Mesh.SecondOrderIncomplete = 1" };
  }
  return { ErrorCode::InvalidParameter,
    name +
      " are not read; save lines, triangles, quadrilaterals, tetrahedra and hexahedra of order 1 "
      "to 5 "
      "with all their nodes, wedges and pyramids of order 1 and 2" };
}

int GmshType(ElementShape shape, int degree, bool isComplete)
{
  const auto* found = std::find_if(std::begin(Rows), std::end(Rows),
    [&](const Row& row)
    { return row.Shape == shape && row.Degree == degree && row.IsComplete == isComplete; });
  return found == std::end(Rows) ? 0 : found->Type;
}
}
