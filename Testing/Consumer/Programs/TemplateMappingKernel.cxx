// SPDX-License-Identifier: BSD-3-Clause
// A square of lines is carried onto a bent one by a regular map.
#include <knotwork/TemplateMapping/TemplateMap.h>

namespace
{
knotwork::SkeletonPatch<2> Line(int id, double ax, double ay, double bx, double by, double bend)
{
  knotwork::SkeletonPatch<2> patch;
  patch.Id = id;
  patch.Points.resize(21, 2);
  for (int i = 0; i <= 20; ++i)
  {
    const double t = i / 20.0;
    patch.Points.row(i) << ax + t * (bx - ax), ay + t * (by - ay) + bend * t * (1.0 - t);
  }
  return patch;
}
}

int main()
{
  const auto square = [](double bend) -> knotwork::Skeleton<2>
  {
    return { Line(0, 0, 0, 1, 0, bend), Line(1, 1, 0, 1, 1, 0), Line(2, 1, 1, 0, 1, bend),
      Line(3, 0, 1, 0, 0, 0) };
  };
  knotwork::TemplateMapParams<2> params;
  params.Iterations = 3;
  const auto map = knotwork::MapTemplate<2>(square(0.0), square(0.2), params);
  return map && map->History.size() == 3 && map->MinJacobianBound > 0.0 ? 0 : 1;
}
