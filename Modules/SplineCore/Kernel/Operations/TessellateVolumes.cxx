// SPDX-License-Identifier: BSD-3-Clause
#include "ChordalBound.h"
#include "Parallel.h"
#include "SizeLimit.h"
#include "TessellationParts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// The least n with 2^n at least the size.
int ExponentOf(std::int64_t size)
{
  int exponent = 0;
  while ((std::int64_t{ 1 } << exponent) < size)
  {
    ++exponent;
  }
  return exponent;
}

/// A side of an element on the rim of its chart.
struct RimFace
{
  int Patch = 0;
  int Element = 0;
  int Direction = 0;
  int End = 0;
  std::array<int, 2> Axes{};
};

/// Per chart and direction the level of the uniform grid: its cells are 2^-Level of a level-0 cell.
using GridLevels = std::vector<std::array<int, 3>>;

/// Elements with the grids of their charts.
class VolumeCuts : public TessellationCuts
{
  static constexpr int MaximumGridLevel = 24; ///< halvings of an element for its neighbours' sake

public:
  VolumeCuts(const std::vector<BezierForm<3>>& patches, const TessellationParams& params)
    : Patches(patches), Params(params)
  {
    this->Cells = MakeCharts<3>(patches, this->NumCharts);
    for (const auto& cells : this->Cells)
    {
      this->First.push_back(this->First.back() + cells.size());
    }
  }

  /// @return the largest chordal deviation.
  Result<double> ChooseLevels()
  {
    const auto bounds = FindBounds<3>(this->Count(), this->Params,
      [this](std::size_t cut)
      {
        const CutElement element = this->ElementOf(cut);
        const BezierForm<3>& form = this->Patches[At(element.Patch)];
        return BoundSecondDerivatives<3>(form.Space->Elements[At(element.Element)].Degree,
          form.NumComponents, form.Rational, form.Block(element.Element));
      });
    if (!bounds)
    {
      return bounds.Status;
    }
    this->Levels.assign(At(this->NumCharts), { 0, 0, 0 });
    for (std::size_t cut = 0; cut < this->Count(); ++cut)
    {
      const CutElement element = this->ElementOf(cut);
      const ChartCell<3>& cell = this->Cell(element.Patch, element.Element);
      const IntArray<3> halvings = HalvingsForTolerance<3>(
        bounds.Value[cut], this->Params.Tolerance, this->Params.MaximumSubdivision);
      auto& levels = this->Levels[At(cell.Chart)];
      for (std::size_t d = 0; d < 3; ++d)
      {
        levels[d] = std::max(levels[d], cell.Level + halvings[d]);
      }
    }
    this->MatchFaces();
    double largest = 0.0;
    for (std::size_t cut = 0; cut < this->Count(); ++cut)
    {
      const CutElement element = this->ElementOf(cut);
      largest = std::max(largest,
        ChordalBound<3>(bounds.Value[cut], this->Halvings(element.Patch, element.Element)));
    }
    return largest;
  }

  std::size_t Count() const override { return this->First.back(); }
  CutElement ElementOf(std::size_t cut) const override
  {
    const auto next = std::upper_bound(this->First.begin(), this->First.end(), cut);
    CutElement element;
    element.Patch = static_cast<int>(next - this->First.begin()) - 1;
    element.Element = static_cast<int>(cut - *(next - 1));
    return element;
  }
  double NumCells(std::size_t cut) const override
  {
    const CutElement element = this->ElementOf(cut);
    const IntArray<3> s = this->Halvings(element.Patch, element.Element);
    return std::ldexp(1.0, s[0] + s[1] + s[2]);
  }
  std::int64_t Border(std::size_t cut, std::vector<BorderVertex>& border) const override
  {
    const CutElement element = this->ElementOf(cut);
    const ChartCell<3>& cell = this->Cell(element.Patch, element.Element);
    const IntArray<3> s = this->Halvings(element.Patch, element.Element);
    const auto n = this->Steps(element);
    border.clear();
    std::array<std::int64_t, 3> i{};
    for (i[2] = 0; i[2] <= n[2]; ++i[2])
    {
      for (i[1] = 0; i[1] <= n[1]; ++i[1])
      {
        const bool isInner = i[1] > 0 && i[1] < n[1] && i[2] > 0 && i[2] < n[2];
        for (i[0] = 0; i[0] <= n[0]; i[0] += isInner ? n[0] : 1)
        {
          BorderVertex vertex;
          vertex.Position.Chart = cell.Chart;
          vertex.Number = i[0] + (n[0] + 1) * (i[1] + (n[1] + 1) * i[2]);
          for (std::size_t d = 0; d < 3; ++d)
          {
            vertex.Position.X[d] = cell.Lower[d] + i[d] * (cell.Size[d] >> s[d]);
            vertex.Local[d] = static_cast<double>(i[d]) / static_cast<double>(n[d]);
          }
          border.push_back(vertex);
        }
      }
    }
    return (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
  }
  void Make(std::size_t cut, Cut& made) const override
  {
    const auto n = this->Steps(this->ElementOf(cut));
    made.Clear();
    for (std::int64_t c = 0; c <= n[2]; ++c)
    {
      for (std::int64_t b = 0; b <= n[1]; ++b)
      {
        for (std::int64_t a = 0; a <= n[0]; ++a)
        {
          made.Local.push_back({ static_cast<double>(a) / static_cast<double>(n[0]),
            static_cast<double>(b) / static_cast<double>(n[1]),
            static_cast<double>(c) / static_cast<double>(n[2]) });
        }
      }
    }
    const auto at = [&](std::int64_t a, std::int64_t b, std::int64_t c)
    { return static_cast<int>(a + (n[0] + 1) * (b + (n[1] + 1) * c)); };
    for (std::int64_t c = 0; c < n[2]; ++c)
    {
      for (std::int64_t b = 0; b < n[1]; ++b)
      {
        for (std::int64_t a = 0; a < n[0]; ++a)
        {
          made.AddCell(TessellationShape::Hexahedron,
            { at(a, b, c), at(a + 1, b, c), at(a + 1, b + 1, c), at(a, b + 1, c), at(a, b, c + 1),
              at(a + 1, b, c + 1), at(a + 1, b + 1, c + 1), at(a, b + 1, c + 1) });
        }
      }
    }
  }
  /// By lattices, where the elements of every chart have one grid and the numbers are not too
  /// large.
  VertexTable MakeTable() const override
  {
    std::vector<ChartLattice> lattices(At(this->NumCharts));
    std::vector<std::array<std::int64_t, 3>> upper(lattices.size());
    for (std::size_t cut = 0; cut < this->Count(); ++cut)
    {
      const CutElement element = this->ElementOf(cut);
      const ChartCell<3>& cell = this->Cell(element.Patch, element.Element);
      const auto n = this->Steps(element);
      ChartLattice& lattice = lattices[At(cell.Chart)];
      const bool isFirst = lattice.Count[0] == 0;
      for (std::size_t d = 0; d < 3; ++d)
      {
        const std::int64_t step = cell.Size[d] / n[d];
        const int shift = ExponentOf(step);
        if (step != std::int64_t{ 1 } << shift || cell.Lower[d] % step != 0 ||
          (!isFirst && shift != lattice.Shift[d]))
        {
          return VertexTable();
        }
        const std::int64_t end = cell.Lower[d] + cell.Size[d];
        lattice.Shift[d] = shift;
        lattice.Lower[d] = isFirst ? cell.Lower[d] : std::min(lattice.Lower[d], cell.Lower[d]);
        std::int64_t& last = upper[At(cell.Chart)][d];
        last = isFirst ? end : std::max(last, end);
        lattice.Count[d] = 1;
      }
    }
    double count = 0.0;
    for (std::size_t c = 0; c < lattices.size(); ++c)
    {
      ChartLattice& lattice = lattices[c];
      lattice.First = static_cast<int>(count);
      double points = lattice.Count[0] == 0 ? 0.0 : 1.0;
      for (std::size_t d = 0; d < 3; ++d)
      {
        lattice.Count[d] = ((upper[c][d] - lattice.Lower[d]) >> lattice.Shift[d]) + 1;
        points *= static_cast<double>(lattice.Count[d]);
      }
      count += points;
      if (count > std::numeric_limits<int>::max())
      {
        return VertexTable();
      }
    }
    return VertexTable(std::move(lattices), static_cast<int>(count));
  }
  void Unite(VertexTable& vertices) const override
  {
    for (const PatchInterface& shared : this->Interfaces)
    {
      const RimFace& a = this->Faces[At(shared.Sides[0].Patch)];
      const RimFace& b = this->Faces[At(shared.Sides[1].Patch)];
      const auto count = this->FaceCount(b);
      if (shared.Orientation.OtherCount(count) != this->FaceCount(a))
      {
        continue; // grids that cannot agree: see MatchFaces
      }
      for (std::int64_t j = 0; j < count[1]; ++j)
      {
        for (std::int64_t i = 0; i < count[0]; ++i)
        {
          vertices.Sets.Unite(
            vertices.NumberOf(this->FacePoint(a, shared.Orientation.OtherPoint({ i, j }, count))),
            vertices.NumberOf(this->FacePoint(b, { i, j })));
        }
      }
    }
  }

private:
  const ChartCell<3>& Cell(int patch, int element) const
  {
    return this->Cells[At(patch)][At(element)];
  }

  IntArray<3> Halvings(int patch, int element) const
  {
    const ChartCell<3>& cell = this->Cell(patch, element);
    IntArray<3> s;
    for (std::size_t d = 0; d < 3; ++d)
    {
      s[d] = this->Levels[At(cell.Chart)][d] - cell.Level;
    }
    return s;
  }

  std::array<std::int64_t, 2> FaceCount(const RimFace& face) const
  {
    const IntArray<3> s = this->Halvings(face.Patch, face.Element);
    return { (std::int64_t{ 1 } << s[At(face.Axes[0])]) + 1,
      (std::int64_t{ 1 } << s[At(face.Axes[1])]) + 1 };
  }

  ChartPoint FacePoint(const RimFace& face, const std::array<std::int64_t, 2>& at) const
  {
    const ChartCell<3>& cell = this->Cell(face.Patch, face.Element);
    const IntArray<3> s = this->Halvings(face.Patch, face.Element);
    ChartPoint point{ cell.Chart, cell.Lower };
    point.X[At(face.Direction)] += face.End == 0 ? 0 : cell.Size[At(face.Direction)];
    for (std::size_t a = 0; a < 2; ++a)
    {
      const std::size_t axis = At(face.Axes[a]);
      point.X[axis] += at[a] * (cell.Size[axis] >> s[axis]);
    }
    return point;
  }

  /// Finds the faces that are one and raises levels until their grids agree. The limit of levels
  /// ends a model whose hierarchies contradict each other; such faces stay apart.
  void MatchFaces()
  {
    SideMatcher matcher(this->Patches.front().NumComponents + 1, LargestValue<3>(this->Patches));
    for (std::size_t p = 0; p < this->Cells.size(); ++p)
    {
      for (std::size_t e = 0; e < this->Cells[p].size(); ++e)
      {
        const ChartCell<3>& cell = this->Cells[p][e];
        for (int side = 0; side < 6; ++side)
        {
          const int d = side / 2;
          const int end = side % 2;
          if (end == 0 ? cell.RimLow[At(d)] : cell.RimHigh[At(d)])
          {
            const BlockSide block = ExtractSide<3>(this->Patches[p], static_cast<int>(e), d, end);
            matcher.Add({ static_cast<int>(this->Faces.size()), side }, block.Count, block.Points);
            this->Faces.push_back({ static_cast<int>(p), static_cast<int>(e), d, end, block.Axes });
          }
        }
      }
    }
    this->Interfaces = matcher.Interfaces();
    std::vector<std::vector<std::size_t>> ofChart(At(this->NumCharts));
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < this->Interfaces.size(); ++i)
    {
      for (const PatchSide& side : this->Interfaces[i].Sides)
      {
        ofChart[At(this->ChartOf(this->Faces[At(side.Patch)]))].push_back(i);
      }
      open.push_back(i);
    }
    while (!open.empty())
    {
      const PatchInterface& shared = this->Interfaces[open.back()];
      open.pop_back();
      for (const PatchSide& raised : this->RaiseLevels(shared))
      {
        const auto& others = ofChart[At(this->ChartOf(this->Faces[At(raised.Patch)]))];
        open.insert(open.end(), others.begin(), others.end());
      }
    }
  }

  /// Raises the levels of two grids to the finer one at their common side.
  /// @return the sides whose charts have another level.
  std::vector<PatchSide> RaiseLevels(const PatchInterface& shared)
  {
    const RimFace& a = this->Faces[At(shared.Sides[0].Patch)];
    const RimFace& b = this->Faces[At(shared.Sides[1].Patch)];
    const int levelA = this->Cell(a.Patch, a.Element).Level;
    const int levelB = this->Cell(b.Patch, b.Element).Level;
    std::vector<PatchSide> raised;
    for (std::size_t i = 0; i < 2; ++i)
    {
      int& gridA = this->GridLevel(a, At(shared.Orientation.Axis[i]));
      int& gridB = this->GridLevel(b, i);
      const int needed = std::max(gridA - levelA, gridB - levelB);
      if (needed > MaximumGridLevel)
      {
        continue;
      }
      if (gridA - levelA < needed)
      {
        gridA = levelA + needed;
        raised.push_back(shared.Sides[0]);
      }
      if (gridB - levelB < needed)
      {
        gridB = levelB + needed;
        raised.push_back(shared.Sides[1]);
      }
    }
    return raised;
  }

  int ChartOf(const RimFace& face) const { return this->Cell(face.Patch, face.Element).Chart; }

  int& GridLevel(const RimFace& face, std::size_t axis)
  {
    return this->Levels[At(this->Cell(face.Patch, face.Element).Chart)][At(face.Axes[axis])];
  }

  /// Cells along the directions.
  std::array<std::int64_t, 3> Steps(const CutElement& element) const
  {
    const IntArray<3> s = this->Halvings(element.Patch, element.Element);
    return { std::int64_t{ 1 } << s[0], std::int64_t{ 1 } << s[1], std::int64_t{ 1 } << s[2] };
  }

  const std::vector<BezierForm<3>>& Patches;
  const TessellationParams& Params;
  int NumCharts = 0;
  std::vector<std::vector<ChartCell<3>>> Cells;
  std::vector<std::size_t> First{ 0 }; ///< cut of every patch, and their number
  GridLevels Levels;
  std::vector<RimFace> Faces;
  std::vector<PatchInterface> Interfaces;
};
}

Status TessellateVolumes(const std::vector<BezierForm<3>>& patches,
  const TessellationParams& params, TessellationMesh& mesh)
{
  VolumeCuts cuts(patches, params);
  const auto largest = cuts.ChooseLevels();
  if (!largest)
  {
    return largest.Status;
  }
  mesh.Bound = largest.Value;
  double count = 0.0;
  for (std::size_t cut = 0; cut < cuts.Count(); ++cut)
  {
    count += cuts.NumCells(cut);
  }
  if (Status status = CheckSize(count, params.MaxCells, "hexahedra", "MaximumCells"); !status)
  {
    return status;
  }
  if (params.Progress && !params.Progress(0.1))
  {
    return { ErrorCode::Aborted, "" };
  }
  return AssembleTessellation<3>(patches, params, cuts, mesh);
}
}
