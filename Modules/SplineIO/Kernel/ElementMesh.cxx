// SPDX-License-Identifier: BSD-3-Clause
#include "ElementMesh.h"

namespace knotwork
{
int DimensionOf(ElementShape shape)
{
  switch (shape)
  {
    case ElementShape::Point:
      return 0;
    case ElementShape::Segment:
      return 1;
    case ElementShape::Triangle:
    case ElementShape::Quadrilateral:
      return 2;
    default:
      return 3;
  }
}

const std::vector<std::array<int, 3>>& CornersOf(ElementShape shape)
{
  using Corners = std::vector<std::array<int, 3>>;
  static const Corners point = { { 0, 0, 0 } };
  static const Corners segment = { { 0, 0, 0 }, { 1, 0, 0 } };
  static const Corners triangle = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
  static const Corners square = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  static const Corners tetrahedron = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  static const Corners cube = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
    { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
  static const Corners wedge = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
    { 0, 1, 1 } };
  static const Corners pyramid = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
    { 0, 0, 1 } };
  switch (shape)
  {
    case ElementShape::Point:
      return point;
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

std::vector<std::array<int, 3>> QuadraticPlaces(
  ElementShape shape, const std::vector<std::array<int, 2>>& edges)
{
  const auto& corners = CornersOf(shape);
  std::vector<std::array<int, 3>> places;
  for (const auto& corner : corners)
  {
    places.push_back({ 2 * corner[0], 2 * corner[1], 2 * corner[2] });
  }
  for (const auto& edge : edges)
  {
    const auto& a = corners[static_cast<std::size_t>(edge[0])];
    const auto& b = corners[static_cast<std::size_t>(edge[1])];
    const bool toApex = shape == ElementShape::Pyramid && edge[1] == 4;
    places.push_back(toApex ? std::array<int, 3>{ 2 * a[0], 2 * a[1], 1 }
                            : std::array<int, 3>{ a[0] + b[0], a[1] + b[1], a[2] + b[2] });
  }
  return places;
}
}
