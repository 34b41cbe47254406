// SPDX-License-Identifier: BSD-3-Clause
#include "SideFrames.h"

#include "BoundaryInjectivity.h"

namespace knotwork
{
namespace
{
const std::vector<SideFrame>& Frames(CellShape shape)
{
  constexpr CellShape curve = CellShape::Curve;
  constexpr CellShape quad = CellShape::Quadrilateral;
  constexpr CellShape triangle = CellShape::Triangle;
  static const std::vector<SideFrame> none;
  static const std::vector<SideFrame> quads{ { curve, 2, { 2, 0, 0, 0 } },
    { curve, 2, { 1, 3, 0, 0 } }, { curve, 2, { 0, 1, 0, 0 } }, { curve, 2, { 3, 2, 0, 0 } } };
  static const std::vector<SideFrame> triangles{ { curve, 2, { 0, 1, 0, 0 } },
    { curve, 2, { 1, 2, 0, 0 } }, { curve, 2, { 2, 0, 0, 0 } } };
  static const std::vector<SideFrame> hexahedra{ { quad, 4, { 0, 4, 2, 6 } },
    { quad, 4, { 1, 3, 5, 7 } }, { quad, 4, { 0, 1, 4, 5 } }, { quad, 4, { 2, 6, 3, 7 } },
    { quad, 4, { 0, 2, 1, 3 } }, { quad, 4, { 4, 5, 6, 7 } } };
  static const std::vector<SideFrame> tetrahedra{ { triangle, 3, { 0, 3, 2, 0 } },
    { triangle, 3, { 0, 1, 3, 0 } }, { triangle, 3, { 0, 2, 1, 0 } },
    { triangle, 3, { 1, 2, 3, 0 } } };
  static const std::vector<SideFrame> wedges{ { quad, 4, { 0, 1, 3, 4 } },
    { quad, 4, { 1, 2, 4, 5 } }, { quad, 4, { 0, 3, 2, 5 } }, { triangle, 3, { 0, 2, 1, 0 } },
    { triangle, 3, { 3, 4, 5, 0 } } };
  switch (shape)
  {
    case CellShape::Quadrilateral:
      return quads;
    case CellShape::Triangle:
      return triangles;
    case CellShape::Hexahedron:
      return hexahedra;
    case CellShape::Tetrahedron:
      return tetrahedra;
    case CellShape::Wedge:
      return wedges;
    case CellShape::Curve:
      break;
  }
  return none;
}

}

int NumSides(CellShape shape)
{
  return static_cast<int>(Frames(shape).size());
}

const SideFrame& GetSideFrame(CellShape shape, int side)
{
  return Frames(shape)[static_cast<std::size_t>(side)];
}

CellDegree SideDegree(CellShape shape, const CellDegree& degree, const SideFrame& frame)
{
  const auto along = [&](int from, int to)
  {
    const auto a = CornerParameters(shape, from);
    const auto b = CornerParameters(shape, to);
    for (std::size_t d = 0; d < 3; ++d)
    {
      if (a[d] != b[d])
      {
        return degree[d];
      }
    }
    return 0;
  };
  CellDegree out{ along(frame.Corners[0], frame.Corners[1]), 0, 0 };
  if (frame.NumCorners > 2)
  {
    out[1] = along(frame.Corners[0], frame.Corners[2]);
  }
  return out;
}

std::vector<int> SideCoefficients(CellShape shape, const CellDegree& degree, const SideFrame& frame)
{
  const CellDegree side = SideDegree(shape, degree, frame);
  std::array<std::array<int, 3>, 3> corner{};
  for (std::size_t k = 0; k < std::min<std::size_t>(3, static_cast<std::size_t>(frame.NumCorners));
       ++k)
  {
    const auto u = CornerParameters(shape, frame.Corners[k]);
    for (std::size_t d = 0; d < 3; ++d)
    {
      corner[k][d] = static_cast<int>(u[d]);
    }
  }
  std::vector<int> coefficients;
  for (int j = 0; j <= side[1]; ++j)
  {
    for (int i = 0; i <= side[0]; ++i)
    {
      if (frame.Shape == CellShape::Triangle && i + j > side[0])
      {
        continue;
      }
      int at[3];
      for (std::size_t d = 0; d < 3; ++d)
      {
        at[d] = corner[0][d] * degree[d] + i * (corner[1][d] - corner[0][d]) +
          (frame.NumCorners > 2 ? j * (corner[2][d] - corner[0][d]) : 0);
      }
      coefficients.push_back(CellCoefficient(shape, degree, at[0], at[1], at[2]));
    }
  }
  return coefficients;
}

std::array<double, 3> SideToCell(CellShape shape, const SideFrame& frame, const double* s)
{
  const auto a = CornerParameters(shape, frame.Corners[0]);
  const auto b = CornerParameters(shape, frame.Corners[1]);
  const auto c = CornerParameters(shape, frame.Corners[2]);
  std::array<double, 3> u{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    u[d] = a[d] + s[0] * (b[d] - a[d]) + (frame.NumCorners > 2 ? s[1] * (c[d] - a[d]) : 0.0);
  }
  return u;
}

int NumSideEdges(CellShape side)
{
  return side == CellShape::Quadrilateral ? 4 : side == CellShape::Triangle ? 3 : 0;
}

std::array<int, 2> SideEdge(CellShape side, int edge)
{
  static constexpr std::array<int, 2> quad[4] = { { 0, 1 }, { 1, 3 }, { 3, 2 }, { 2, 0 } };
  static constexpr std::array<int, 2> triangle[3] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
  return side == CellShape::Triangle ? triangle[edge] : quad[edge];
}

double EdgeParameter(CellShape side, int edge, const std::array<double, 3>& s)
{
  const bool triangle = side == CellShape::Triangle;
  switch (edge)
  {
    case 0:
      return s[1] == 0.0 ? s[0] : -1.0;
    case 1:
      return (triangle ? s[0] + s[1] == 1.0 : s[0] == 1.0) ? s[1] : -1.0;
    case 2:
      return triangle ? (s[0] == 0.0 ? 1.0 - s[1] : -1.0) : (s[1] == 1.0 ? 1.0 - s[0] : -1.0);
    default:
      return s[0] == 0.0 ? 1.0 - s[1] : -1.0;
  }
}
}
