// SPDX-License-Identifier: BSD-3-Clause
#include "ChordalBound.h"
#include "SizeLimit.h"
#include "TessellationParts.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Elements with equal steps.
class CurveCuts : public TessellationCuts
{
public:
  Status Divide(const std::vector<BezierForm<1>>& patches, const TessellationParams& params,
    TessellationMesh& mesh)
  {
    int numCharts = 0;
    const auto cells = MakeCharts<1>(patches, numCharts);
    SideMatcher matcher(patches.front().NumComponents + 1, LargestValue<1>(patches));
    double numPoints = 0.0;
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
        if (Status status = CheckSize(
              numPoints + static_cast<double>(n), params.MaxCells, "points", "MaximumCells");
            !status)
        {
          return status;
        }
        numPoints += static_cast<double>(n + 1);
        this->Elements.push_back({ static_cast<int>(p), static_cast<int>(e), n, cell });
        this->AddEnds(form, matcher);
      }
    }
    for (const PatchInterface& shared : matcher.Interfaces())
    {
      this->Shared.push_back({ this->Ends[static_cast<std::size_t>(shared.Sides[0].Patch)],
        this->Ends[static_cast<std::size_t>(shared.Sides[1].Patch)] });
    }
    return {};
  }

  std::size_t Count() const override { return this->Elements.size(); }
  CutElement ElementOf(std::size_t cut) const override
  {
    CutElement element;
    element.Patch = this->Elements[cut].Patch;
    element.Element = this->Elements[cut].Element;
    return element;
  }
  double NumCells(std::size_t cut) const override
  {
    return static_cast<double>(this->Elements[cut].Steps);
  }
  std::int64_t Border(std::size_t cut, std::vector<BorderVertex>& border) const override
  {
    const std::int64_t n = this->Elements[cut].Steps;
    border.clear();
    border.push_back({ this->End(cut, 0), 0, { 0.0, 0.0, 0.0 } });
    border.push_back({ this->End(cut, 1), n, { 1.0, 0.0, 0.0 } });
    return n + 1;
  }
  void Make(std::size_t cut, Cut& made) const override
  {
    const auto n = static_cast<int>(this->Elements[cut].Steps);
    made.Clear();
    for (int i = 0; i <= n; ++i)
    {
      made.Local.push_back({ static_cast<double>(i) / static_cast<double>(n), 0.0, 0.0 });
      if (i > 0)
      {
        made.AddCell(TessellationShape::Line, { i - 1, i });
      }
    }
  }
  void Unite(VertexTable& vertices) const override
  {
    for (const auto& [a, b] : this->Shared)
    {
      vertices.Sets.Unite(vertices.NumberOf(a), vertices.NumberOf(b));
    }
  }

private:
  struct CurveElement
  {
    int Patch = 0;
    int Element = 0;
    std::int64_t Steps = 1;
    ChartCell<1> Cell;
  };

  ChartPoint End(std::size_t cut, int end) const
  {
    const ChartCell<1>& cell = this->Elements[cut].Cell;
    return { cell.Chart, { cell.Lower[0] + (end == 0 ? 0 : cell.Size[0]), 0, 0 } };
  }

  void AddEnds(const BezierForm<1>& form, SideMatcher& matcher)
  {
    const CurveElement& element = this->Elements.back();
    for (int end = 0; end < 2; ++end)
    {
      if (end == 0 ? element.Cell.RimLow[0] : element.Cell.RimHigh[0])
      {
        BlockSide side = ExtractSide<1>(form, element.Element, 0, end);
        for (double& x : side.Points) // a point has no weight
        {
          x /= side.Points.back();
        }
        matcher.Add({ static_cast<int>(this->Ends.size()), end }, side.Count, side.Points);
        this->Ends.push_back(this->End(this->Elements.size() - 1, end));
      }
    }
  }

  std::vector<CurveElement> Elements;
  std::vector<ChartPoint> Ends;
  std::vector<std::array<ChartPoint, 2>> Shared;
};
}

Status TessellateCurves(const std::vector<BezierForm<1>>& patches, const TessellationParams& params,
  TessellationMesh& mesh)
{
  CurveCuts cuts;
  if (Status status = cuts.Divide(patches, params, mesh); !status)
  {
    return status;
  }
  return AssembleTessellation<1>(patches, params, cuts, mesh);
}
}
