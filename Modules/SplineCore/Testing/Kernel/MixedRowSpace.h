// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork::testing
{
/// A chain of Bezier elements whose functions are the columns of a matrix: row j holds their values
/// of Bezier point j of the chain.
inline SplineSpacePtr<1> MixedRowSpace(const Eigen::MatrixXd& map, int elements, int degree)
{
  auto space = std::make_shared<SplineSpace<1>>();
  space->Kind = SpaceKind::Bezier;
  space->NumFunctions = static_cast<int>(map.cols());
  space->NumLocalFunctions = static_cast<int>(map.rows());
  space->RowStart.push_back(0);
  for (Eigen::Index j = 0; j < map.rows(); ++j)
  {
    for (Eigen::Index f = 0; f < map.cols(); ++f)
    {
      if (map(j, f) != 0.0)
      {
        space->RowFunction.push_back(static_cast<int>(f));
        space->RowCoefficient.push_back(map(j, f));
      }
    }
    space->RowStart.push_back(space->RowFunction.size());
  }
  for (int e = 0; e < elements; ++e)
  {
    SplineSpace<1>::Element element;
    element.Degree = { degree };
    element.Factor = { -1 };
    element.Box.Upper = { 1.0 };
    element.FirstLocal = space->LocalFunctionIds.size();
    for (int i = 0; i <= degree; ++i)
    {
      space->LocalFunctionIds.push_back(e * degree + i); // neighbours share an end
    }
    space->Elements.push_back(element);
  }
  return space;
}
}
