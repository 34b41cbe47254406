// SPDX-License-Identifier: BSD-3-Clause
#include "SplineModel.h"

#include "vtkHigherOrderHexahedron.h"
#include "vtkHigherOrderQuadrilateral.h"

namespace knotwork
{
namespace
{
int VtkIndex(const IntArray<1>& degree, int i, int, int)
{
  return i == 0 ? 0 : i == degree[0] ? 1 : i + 1; // ends first
}

int VtkIndex(const IntArray<2>& degree, int i, int j, int)
{
  return vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, degree.data());
}

int VtkIndex(const IntArray<3>& degree, int i, int j, int k)
{
  return vtkHigherOrderHexahedron::PointIndexFromIJK(i, j, k, degree.data());
}
}

template <int Dim>
std::vector<int> VtkPointOrder(const IntArray<Dim>& degree)
{
  std::vector<int> order(static_cast<std::size_t>(NumTensorFunctions<Dim>(degree)));
  const int q = Dim > 1 ? degree[Dim > 1 ? 1 : 0] : 0;
  const int r = Dim > 2 ? degree[Dim > 2 ? 2 : 0] : 0;
  int bernstein = 0;
  for (int k = 0; k <= r; ++k)
  {
    for (int j = 0; j <= q; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        order[static_cast<std::size_t>(VtkIndex(degree, i, j, k))] = bernstein++;
      }
    }
  }
  return order;
}

template VTKKNOTWORKSPLINEGRID_EXPORT std::vector<int> VtkPointOrder<1>(const IntArray<1>&);
template VTKKNOTWORKSPLINEGRID_EXPORT std::vector<int> VtkPointOrder<2>(const IntArray<2>&);
template VTKKNOTWORKSPLINEGRID_EXPORT std::vector<int> VtkPointOrder<3>(const IntArray<3>&);
}
