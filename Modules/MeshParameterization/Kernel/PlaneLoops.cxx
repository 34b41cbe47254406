// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneLoops.h"

#include "BoxTree.h"

namespace knotwork
{
bool LoopsCross(const DiscMesh& mesh, const PointMatrix& uv)
{
  std::vector<std::array<int, 2>> edges;
  for (const auto& loop : mesh.Loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      edges.push_back({ loop[i], loop[(i + 1) % loop.size()] });
    }
  }
  const auto n = static_cast<Eigen::Index>(edges.size());
  PointMatrix lower(n, 2);
  PointMatrix upper(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const auto& edge = edges[static_cast<std::size_t>(i)];
    lower.row(i) = uv.row(edge[0]).cwiseMin(uv.row(edge[1]));
    upper.row(i) = uv.row(edge[0]).cwiseMax(uv.row(edge[1]));
  }
  const BoxTree tree(lower, upper);
  const auto side = [&](int a, int b, int c) // of the line a -> b
  {
    const Eigen::RowVector2d p = uv.row(b) - uv.row(a);
    const Eigen::RowVector2d q = uv.row(c) - uv.row(a);
    return p[0] * q[1] - p[1] * q[0];
  };
  bool cross = false;
  for (Eigen::Index i = 0; i < n && !cross; ++i)
  {
    const auto [a, b] = edges[static_cast<std::size_t>(i)];
    tree.ForNear(lower.row(i).data(), upper.row(i).data(),
      [&, a = a, b = b](int item)
      {
        const auto [c, d] = edges[static_cast<std::size_t>(item)];
        const bool neighbours = a == c || a == d || b == c || b == d;
        cross = cross ||
          (!neighbours && side(a, b, c) * side(a, b, d) <= 0.0 &&
            side(c, d, a) * side(c, d, b) <= 0.0);
      });
  }
  return cross;
}
}
