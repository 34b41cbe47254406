// SPDX-License-Identifier: BSD-3-Clause
#include "HigherOrderCells.h"

#include "SplineModel.h"

#include "vtkCellType.h"
#include "vtkHigherOrderTetra.h"
#include "vtkHigherOrderTriangle.h"
#include "vtkHigherOrderWedge.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Of a simplex or wedge.
vtkIdType VtkIndex(CellShape shape, int p, int i, int j, int k)
{
  if (shape == CellShape::Wedge)
  {
    const int order[4] = { p, p, p, (p + 1) * (p + 1) * (p + 2) / 2 };
    return vtkHigherOrderWedge::PointIndexFromIJK(i, j, k, order);
  }
  const vtkIdType exponents[4] = { i, j, shape == CellShape::Triangle ? p - i - j : k,
    p - i - j - k };
  return shape == CellShape::Triangle ? vtkHigherOrderTriangle::Index(exponents, p)
                                      : vtkHigherOrderTetra::Index(exponents, p);
}
}

std::vector<int> HigherOrderPointOrder(CellShape shape, int degree)
{
  switch (shape)
  {
    case CellShape::Curve:
      return VtkPointOrder<1>({ degree });
    case CellShape::Quadrilateral:
      return VtkPointOrder<2>({ degree, degree });
    case CellShape::Hexahedron:
      return VtkPointOrder<3>({ degree, degree, degree });
    default:
      break;
  }
  std::vector<int> order;
  int coefficient = 0;
  for (int k = 0; k <= (shape == CellShape::Triangle ? 0 : degree); ++k)
  {
    const int left = degree - (shape == CellShape::Tetrahedron ? k : 0);
    for (int j = 0; j <= left; ++j)
    {
      for (int i = 0; i <= left - j; ++i)
      {
        const auto at = static_cast<std::size_t>(VtkIndex(shape, degree, i, j, k));
        order.resize(std::max(order.size(), at + 1));
        order[at] = coefficient++;
      }
    }
  }
  return order;
}

int HigherOrderCellType(CellShape shape, bool isBezier)
{
  switch (shape)
  {
    case CellShape::Curve:
      return isBezier ? VTK_BEZIER_CURVE : VTK_LAGRANGE_CURVE;
    case CellShape::Quadrilateral:
      return isBezier ? VTK_BEZIER_QUADRILATERAL : VTK_LAGRANGE_QUADRILATERAL;
    case CellShape::Hexahedron:
      return isBezier ? VTK_BEZIER_HEXAHEDRON : VTK_LAGRANGE_HEXAHEDRON;
    case CellShape::Triangle:
      return isBezier ? VTK_BEZIER_TRIANGLE : VTK_LAGRANGE_TRIANGLE;
    case CellShape::Tetrahedron:
      return isBezier ? VTK_BEZIER_TETRAHEDRON : VTK_LAGRANGE_TETRAHEDRON;
    case CellShape::Wedge:
      break;
  }
  return isBezier ? VTK_BEZIER_WEDGE : VTK_LAGRANGE_WEDGE;
}
}
