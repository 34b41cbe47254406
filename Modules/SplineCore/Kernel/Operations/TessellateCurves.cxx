// SPDX-License-Identifier: BSD-3-Clause
#include "ChordalBound.h"
#include "SizeLimit.h"
#include "TessellationParts.h"

#include <algorithm>

namespace knotwork
{
Status TessellateCurves(const std::vector<BezierForm<1>>& patches, const TessellationParams& params,
  TessellationMesh& mesh)
{
  int numCharts = 0;
  const auto cells = MakeCharts<1>(patches, numCharts);
  VertexTable vertices;
  CellSoup soup;
  const int planes = patches.front().NumComponents + 1;
  SideMatcher matcher(planes, LargestValue<1>(patches));
  std::vector<ChartPoint> ends;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const BezierForm<1>& form = patches[p];
    for (std::size_t e = 0; e < cells[p].size(); ++e)
    {
      const ChartCell<1>& cell = cells[p][e];
      const auto bound = BoundSecondDerivatives<1>(form.Space->Elements[e].Degree,
        form.NumComponents, form.Rational, form.Block(static_cast<int>(e)));
      const IntArray<1> halvings =
        HalvingsForTolerance<1>(bound, params.Tolerance, params.MaximumSubdivision);
      mesh.Bound = std::max(mesh.Bound, ChordalBound<1>(bound, halvings));
      const std::int64_t n = std::int64_t{ 1 } << halvings[0];
      const double count = static_cast<double>(soup.Uses.size()) + static_cast<double>(n);
      if (Status status = CheckSize(count, params.MaxCells, "points", "MaximumCells"); !status)
      {
        return status;
      }
      for (std::int64_t i = 0; i <= n; ++i)
      {
        VertexUse use;
        use.Patch = static_cast<int>(p);
        use.Element = static_cast<int>(e);
        use.Local[0] = static_cast<double>(i) / static_cast<double>(n);
        const std::int64_t x = cell.Lower[0] + i * (cell.Size[0] / n);
        use.Vertex = i == 0 || i == n ? vertices.At({ cell.Chart, { x, 0, 0 } }) : vertices.Add();
        soup.Uses.push_back(use);
        if (i > 0)
        {
          const int last = static_cast<int>(soup.Uses.size()) - 1;
          const std::array<int, 2> corners{ last - 1, last };
          soup.AddCell(TessellationShape::Line, corners.data(), 2, use.Patch, use.Element);
        }
      }
      for (int end = 0; end < 2; ++end)
      {
        if (end == 0 ? cell.RimLow[0] : cell.RimHigh[0])
        {
          BlockSide side = ExtractSide<1>(form, static_cast<int>(e), 0, end);
          for (double& x : side.Points) // a point has no weight
          {
            x /= side.Points.back();
          }
          matcher.Add({ static_cast<int>(ends.size()), end }, side.Count, side.Points);
          ends.push_back({ cell.Chart, { cell.Lower[0] + (end == 0 ? 0 : cell.Size[0]), 0, 0 } });
        }
      }
    }
  }
  for (const PatchInterface& shared : matcher.Interfaces())
  {
    vertices.Sets.Unite(vertices.At(ends[static_cast<std::size_t>(shared.Sides[0].Patch)]),
      vertices.At(ends[static_cast<std::size_t>(shared.Sides[1].Patch)]));
  }
  return FinishTessellation<1>(patches, params, vertices, soup, mesh);
}
}
