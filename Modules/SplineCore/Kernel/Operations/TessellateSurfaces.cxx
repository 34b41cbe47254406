// SPDX-License-Identifier: BSD-3-Clause
#include "ChordalBound.h"
#include "Parallel.h"
#include "SizeLimit.h"
#include "TessellationParts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace knotwork
{
namespace
{
using Pair = std::array<std::int64_t, 2>;

std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

/// A Bezier quadrilateral to tessellate: an element with two parameters, or one side of an element
/// with three.
struct Face
{
  int Patch = 0;
  int Element = 0;
  int Chart = 0;
  std::array<int, 2> Axes{ 0, 1 }; ///< parameters of the element along the face
  int Fixed = -1;                  ///< the third one, if any, and its end
  int End = 0;
  bool Flip = false;
  Pair Lower{};
  Pair Size{};
  std::array<bool, 4> Rim{}; ///< sides
  IntArray<2> Degree{};
  /// (p + 1)(q + 1) homogeneous points (w x, ..., w); of surfaces only on the rim of a chart.
  std::vector<double> Points;
  IntArray<2> Halvings{};
};

/// Direction along a side, and the fixed chart coordinate of the side.
int SideAxis(int side)
{
  return 1 - side / 2;
}
std::int64_t SideFixed(const Face& face, int side)
{
  const std::size_t across = AcrossSide(side);
  return face.Lower[across] + (side % 2 == 0 ? 0 : face.Size[across]);
}

/// Points of a side in ascending parameter.
std::vector<double> SidePoints(const Face& face, int side, int planes)
{
  const std::vector<int> places =
    EntityIndices<2>({ face.Degree[0] + 1, face.Degree[1] + 1 }, EntityOfSide<2>(side));
  std::vector<double> points;
  points.reserve(places.size() * At(planes));
  for (const int at : places)
  {
    points.insert(points.end(), face.Points.begin() + std::int64_t{ at } * planes,
      face.Points.begin() + std::int64_t{ at + 1 } * planes);
  }
  return points;
}
/// All control points of a side at one place, but for rounding.
bool IsCollapsed(const std::vector<double>& points, int planes)
{
  const std::size_t n = points.size() / At(planes);
  for (int c = 0; c + 1 < planes; ++c)
  {
    double size = 0.0;
    double lower = std::numeric_limits<double>::infinity();
    double upper = -lower;
    for (std::size_t i = 0; i < n; ++i)
    {
      const double x = points[i * At(planes) + At(c)] / points[(i + 1) * At(planes) - 1];
      size = std::max(size, std::abs(x));
      lower = std::min(lower, x);
      upper = std::max(upper, x);
    }
    if (upper - lower > PointClusters::RelativeTolerance * size)
    {
      return false;
    }
  }
  return true;
}

std::vector<Face> MakeFaces(const std::vector<BezierForm<2>>& patches, int& numCharts)
{
  const auto cells = MakeCharts<2>(patches, numCharts);
  std::vector<Face> faces;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const BezierForm<2>& form = patches[p];
    for (std::size_t e = 0; e < cells[p].size(); ++e)
    {
      const ChartCell<2>& cell = cells[p][e];
      Face face;
      face.Patch = static_cast<int>(p);
      face.Element = static_cast<int>(e);
      face.Chart = cell.Chart;
      face.Lower = cell.Lower;
      face.Size = cell.Size;
      face.Rim = { cell.RimLow[0], cell.RimHigh[0], cell.RimLow[1], cell.RimHigh[1] };
      face.Degree = form.Space->Elements[e].Degree;
      if (std::find(face.Rim.begin(), face.Rim.end(), true) != face.Rim.end())
      {
        const int n = NumTensorFunctions<2>(face.Degree);
        const double* block = form.Block(static_cast<int>(e));
        for (int i = 0; i < n; ++i)
        {
          for (int c = 0; c < form.NumComponents; ++c)
          {
            face.Points.push_back(block[c * n + i]);
          }
          face.Points.push_back(form.Rational ? block[form.NumComponents * n + i] : 1.0);
        }
      }
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

/// The outer faces: sides on the rim of their chart that match no other side.
std::vector<Face> MakeFaces(const std::vector<BezierForm<3>>& patches, int& numCharts)
{
  const auto cells = MakeCharts<3>(patches, numCharts);
  std::vector<Face> faces;
  SideMatcher matcher(patches.front().NumComponents + 1, LargestValue<3>(patches));
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const BezierForm<3>& form = patches[p];
    for (std::size_t e = 0; e < cells[p].size(); ++e)
    {
      const ChartCell<3>& cell = cells[p][e];
      for (int d = 0; d < 3; ++d)
      {
        for (int end = 0; end < 2; ++end)
        {
          if (!(end == 0 ? cell.RimLow[At(d)] : cell.RimHigh[At(d)]))
          {
            continue;
          }
          BlockSide side = ExtractSide<3>(form, static_cast<int>(e), d, end);
          Face face;
          face.Patch = static_cast<int>(p);
          face.Element = static_cast<int>(e);
          face.Chart = cell.Chart * 6 + 2 * d + end;
          face.Axes = side.Axes;
          face.Fixed = d;
          face.End = end;
          // Axes ascend: (1, 2), (0, 2), (0, 1); outward normals need (0, 2) turned round.
          face.Flip = (end == 0) != (d == 1);
          for (std::size_t a = 0; a < 2; ++a)
          {
            const std::size_t axis = At(side.Axes[a]);
            face.Lower[a] = cell.Lower[axis];
            face.Size[a] = cell.Size[axis];
            face.Degree[a] = static_cast<int>(side.Count[a]) - 1;
          }
          const std::size_t u = At(side.Axes[0]);
          const std::size_t v = At(side.Axes[1]);
          face.Rim = { cell.RimLow[u], cell.RimHigh[u], cell.RimLow[v], cell.RimHigh[v] };
          face.Points = std::move(side.Points);
          matcher.Add({ static_cast<int>(faces.size()), 2 * d + end }, side.Count, face.Points);
          faces.push_back(std::move(face));
        }
      }
    }
  }
  std::vector<char> isInner(faces.size(), 0);
  for (const PatchInterface& shared : matcher.Interfaces())
  {
    isInner[At(shared.Sides[0].Patch)] = isInner[At(shared.Sides[1].Patch)] = 1;
  }
  std::vector<Face> outer;
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    if (!isInner[f])
    {
      outer.push_back(std::move(faces[f]));
    }
  }
  return outer;
}

/// Bernstein planes of a face for the bounds.
template <int Dim>
SecondDerivativeBound<2> FaceBound(const BezierForm<Dim>& form, const Face& face)
{
  if (Dim == 2)
  {
    return BoundSecondDerivatives<2>(
      face.Degree, form.NumComponents, form.Rational, form.Block(face.Element));
  }
  const int planes = form.NumPlanes();
  const int n = NumTensorFunctions<2>(face.Degree);
  std::vector<double> net(At(n * planes));
  for (int i = 0; i < n; ++i)
  {
    for (int c = 0; c < planes; ++c)
    {
      net[At(c * n + i)] = face.Points[At(i * (form.NumComponents + 1) + c)];
    }
  }
  return BoundSecondDerivatives<2>(face.Degree, form.NumComponents, form.Rational, net.data());
}

/// Vertices on the mesh lines of all charts: (chart and direction, fixed coordinate, position).
class LinePoints
{
public:
  /// Counts after the next Sort().
  void Add(const Face& face, int side, std::int64_t position)
  {
    this->New.emplace_back(
      2 * std::int64_t{ face.Chart } + SideAxis(side), SideFixed(face, side), position);
  }
  /// Takes up what was added; false when nothing of it is new.
  bool Sort()
  {
    if (this->New.empty())
    {
      return false;
    }
    const std::size_t size = this->All.size();
    this->All.insert(this->All.end(), this->New.begin(), this->New.end());
    this->New.clear();
    std::sort(this->All.begin(), this->All.end());
    this->All.erase(std::unique(this->All.begin(), this->All.end()), this->All.end());
    return this->All.size() > size;
  }
  /// Positions on a side, ends included, ascending.
  std::vector<std::int64_t> Along(const Face& face, int side) const
  {
    const int axis = SideAxis(side);
    const std::int64_t line = 2 * std::int64_t{ face.Chart } + axis;
    const std::int64_t fixed = SideFixed(face, side);
    const std::int64_t begin = face.Lower[At(axis)];
    const std::int64_t end = begin + face.Size[At(axis)];
    std::vector<std::int64_t> positions;
    auto it = std::lower_bound(this->All.begin(), this->All.end(), Entry{ line, fixed, begin });
    for (; it != this->All.end() && *it <= Entry{ line, fixed, end }; ++it)
    {
      positions.push_back(std::get<2>(*it));
    }
    return positions;
  }

private:
  using Entry = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  std::vector<Entry> All;
  std::vector<Entry> New;
};

/// Position on side B of a match that belongs to a position on side A. Charts may have sides of
/// different lengths; positions of dyadic points stay whole.
std::int64_t Transfer(
  std::int64_t position, const Face& a, int sideA, const Face& b, int sideB, bool reversed)
{
  const std::size_t axisA = At(SideAxis(sideA));
  const std::size_t axisB = At(SideAxis(sideB));
  std::int64_t offset = position - a.Lower[axisA];
  const std::int64_t lengthA = a.Size[axisA];
  const std::int64_t lengthB = b.Size[axisB];
  offset = lengthA >= lengthB ? offset / (lengthA / lengthB) : offset * (lengthB / lengthA);
  return b.Lower[axisB] + (reversed ? lengthB - offset : offset);
}

ChartPoint PointOnSide(const Face& face, int side, std::int64_t position)
{
  const std::int64_t fixed = SideFixed(face, side);
  return SideAxis(side) == 0 ? ChartPoint{ face.Chart, { position, fixed, 0 } }
                             : ChartPoint{ face.Chart, { fixed, position, 0 } };
}

/// Visits the vertices on the border of a face in the order of their numbers, side by side.
/// @param visit  (side, position along it)
template <typename Visit>
void ForBorder(const Face& face, const LinePoints& lines, const Visit& visit)
{
  for (const int side : { 2, 1, 3, 0 })
  {
    // corners that sides before have
    const std::size_t skipFirst = side == 1 || side == 0 ? 1 : 0;
    const std::size_t skipLast = side == 3 || side == 0 ? 1 : 0;
    const std::vector<std::int64_t> along = lines.Along(face, side);
    for (std::size_t i = skipFirst; i + skipLast < along.size(); ++i)
    {
      visit(side, along[i]);
    }
  }
}

Pair PositionOnSide(const Face& face, int side, std::int64_t position)
{
  return SideAxis(side) == 0 ? Pair{ position, SideFixed(face, side) }
                             : Pair{ SideFixed(face, side), position };
}

/// Cell along a side that a position lies in, and whether it lies between grid points.
std::pair<std::int64_t, bool> CellAlong(const Face& face, int side, std::int64_t position)
{
  const auto axis = static_cast<std::size_t>(SideAxis(side));
  const std::int64_t offset = position - face.Lower[axis];
  const std::int64_t step = face.Size[axis] >> face.Halvings[axis];
  return { offset / step, offset % step != 0 };
}

std::array<double, 3> LocalOf(const Face& face, const Pair& x)
{
  std::array<double, 3> local{};
  if (face.Fixed >= 0)
  {
    local[At(face.Fixed)] = face.End;
  }
  for (std::size_t a = 0; a < 2; ++a)
  {
    local[At(face.Axes[a])] =
      static_cast<double>(x[a] - face.Lower[a]) / static_cast<double>(face.Size[a]);
  }
  return local;
}

/// Cuts one face: its vertices are those of its border, those within, and the middles of cells with
/// vertices on their sides.
class FaceCutter
{
public:
  FaceCutter(const Face& face, const LinePoints& lines) : F(face), Lines(lines)
  {
    this->N = { std::int64_t{ 1 } << face.Halvings[0], std::int64_t{ 1 } << face.Halvings[1] };
    this->Step = { face.Size[0] >> face.Halvings[0], face.Size[1] >> face.Halvings[1] };
  }

  void Cut(knotwork::Cut& made)
  {
    made.Clear();
    this->Grid.assign(At((this->N[0] + 1) * (this->N[1] + 1)), -1);
    for (std::size_t side = 0; side < 4; ++side)
    {
      this->Extra[side].assign(At(this->N[At(SideAxis(static_cast<int>(side)))]), {});
    }
    ForBorder(this->F, this->Lines,
      [&](int side, std::int64_t position) { this->AddBorder(side, position, made); });
    for (std::int64_t j = 1; j < this->N[1]; ++j)
    {
      for (std::int64_t i = 1; i < this->N[0]; ++i)
      {
        this->At2(i, j) = this->Add(
          { this->F.Lower[0] + i * this->Step[0], this->F.Lower[1] + j * this->Step[1] }, made);
      }
    }
    for (std::int64_t j = 0; j < this->N[1]; ++j)
    {
      for (std::int64_t i = 0; i < this->N[0]; ++i)
      {
        this->MakeCell(i, j, made);
      }
    }
  }

private:
  int& At2(std::int64_t i, std::int64_t j) { return this->Grid[At(i + (this->N[0] + 1) * j)]; }

  int Add(const Pair& x, knotwork::Cut& made) const
  {
    made.Local.push_back(LocalOf(this->F, x));
    return static_cast<int>(made.Local.size()) - 1;
  }

  /// Vertices between grid points are kept by the cell they lie at.
  void AddBorder(int side, std::int64_t position, knotwork::Cut& made)
  {
    const int vertex = this->Add(PositionOnSide(this->F, side, position), made);
    const auto [cell, isBetween] = CellAlong(this->F, side, position);
    const std::int64_t end = side % 2 == 0 ? 0 : this->N[AcrossSide(side)];
    if (isBetween)
    {
      this->Extra[At(side)][At(cell)].push_back(vertex);
    }
    else
    {
      (SideAxis(side) == 0 ? this->At2(cell, end) : this->At2(end, cell)) = vertex;
    }
  }

  void MakeCell(std::int64_t i, std::int64_t j, knotwork::Cut& made)
  {
    std::vector<int>& loop = this->Loop;
    loop.clear();
    const auto append = [&](int side, std::int64_t cell, bool onSide, bool backward)
    {
      if (onSide)
      {
        const std::vector<int>& extra = this->Extra[At(side)][At(cell)];
        if (backward)
        {
          loop.insert(loop.end(), extra.rbegin(), extra.rend());
        }
        else
        {
          loop.insert(loop.end(), extra.begin(), extra.end());
        }
      }
    };
    loop.push_back(this->At2(i, j));
    append(2, i, j == 0, false);
    loop.push_back(this->At2(i + 1, j));
    append(1, j, i + 1 == this->N[0], false);
    loop.push_back(this->At2(i + 1, j + 1));
    append(3, i, j + 1 == this->N[1], true);
    loop.push_back(this->At2(i, j + 1));
    append(0, j, i == 0, true);
    if (this->F.Flip)
    {
      std::reverse(loop.begin(), loop.end());
    }
    if (loop.size() == 4)
    {
      made.AddCell(TessellationShape::Quadrilateral, { loop[0], loop[1], loop[2], loop[3] });
      return;
    }
    const int middle = this->Add({ this->F.Lower[0] + i * this->Step[0] + this->Step[0] / 2,
                                   this->F.Lower[1] + j * this->Step[1] + this->Step[1] / 2 },
      made);
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
      made.AddCell(TessellationShape::Triangle, { middle, loop[k], loop[(k + 1) % loop.size()] });
    }
  }

  const Face& F;
  const LinePoints& Lines;
  Pair N{};
  Pair Step{};
  std::vector<int> Grid;
  std::array<std::vector<std::vector<int>>, 4> Extra;
  std::vector<int> Loop;
};

/// Faces with the vertices on their sides.
class FaceCuts : public TessellationCuts
{
public:
  /// Every face by its own bound, every side by the needs of all faces at it.
  template <int Dim>
  Status Divide(const std::vector<BezierForm<Dim>>& patches, const TessellationParams& params,
    TessellationMesh& mesh)
  {
    int numCharts = 0;
    this->Faces = MakeFaces(patches, numCharts);
    const auto bounds = FindBounds<2>(this->Faces.size(), params,
      [&](std::size_t f)
      { return FaceBound<Dim>(patches[At(this->Faces[f].Patch)], this->Faces[f]); });
    if (!bounds)
    {
      return bounds.Status;
    }
    double count = 0.0;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      const SecondDerivativeBound<2>& bound = bounds.Value[f];
      Face& face = this->Faces[f];
      face.Halvings = HalvingsForTolerance<2>(bound, params.Tolerance, params.MaximumSubdivision);
      mesh.Bound = std::max(mesh.Bound, ChordalBound<2>(bound, face.Halvings));
      count += this->NumCells(f);
    }
    if (Status status = CheckSize(count, params.MaxCells, "polygons", "MaximumCells"); !status)
    {
      return status;
    }
    this->MatchSides(patches.front().NumComponents + 1, LargestValue<Dim>(patches));
    for (Face& face : this->Faces) // for bounds and matches alone
    {
      face.Points = {};
    }
    this->DivideSides();
    return params.Progress && !params.Progress(0.2) ? Status(ErrorCode::Aborted, "") : Status();
  }

  std::size_t Count() const override { return this->Faces.size(); }
  CutElement ElementOf(std::size_t cut) const override
  {
    const Face& face = this->Faces[cut];
    return { face.Patch, face.Element, face.Axes, face.Flip,
      face.Fixed < 0 ? -1 : 2 * face.Fixed + face.End };
  }
  double NumCells(std::size_t cut) const override
  {
    return std::ldexp(1.0, this->Faces[cut].Halvings[0] + this->Faces[cut].Halvings[1]);
  }
  std::int64_t Border(std::size_t cut, std::vector<BorderVertex>& border) const override
  {
    const Face& face = this->Faces[cut];
    const Pair n{ std::int64_t{ 1 } << face.Halvings[0], std::int64_t{ 1 } << face.Halvings[1] };
    std::vector<Pair> withMiddle;
    border.clear();
    ForBorder(face, this->Lines,
      [&](int side, std::int64_t position)
      {
        const Pair x = PositionOnSide(face, side, position);
        border.push_back({ { face.Chart, { x[0], x[1], 0 } },
          static_cast<std::int64_t>(border.size()), LocalOf(face, x) });
        const auto [at, isBetween] = CellAlong(face, side, position);
        if (isBetween)
        {
          Pair cell{};
          cell[At(SideAxis(side))] = at;
          cell[AcrossSide(side)] = side % 2 == 0 ? 0 : n[AcrossSide(side)] - 1;
          withMiddle.push_back(cell);
        }
      });
    std::sort(withMiddle.begin(), withMiddle.end());
    const auto end = std::unique(withMiddle.begin(), withMiddle.end());
    return static_cast<std::int64_t>(border.size()) + (n[0] - 1) * (n[1] - 1) +
      (end - withMiddle.begin());
  }
  void Make(std::size_t cut, Cut& made) const override
  {
    FaceCutter(this->Faces[cut], this->Lines).Cut(made);
  }
  void Unite(VertexTable& vertices) const override
  {
    for (const PatchInterface& shared : this->Shared)
    {
      const auto& [sideA, sideB] = shared.Sides;
      const Face& a = this->Faces[At(sideA.Patch)];
      const Face& b = this->Faces[At(sideB.Patch)];
      const bool reversed = shared.Orientation.Reversed[0];
      for (const std::int64_t position : this->Lines.Along(a, sideA.Side))
      {
        const std::int64_t other = Transfer(position, a, sideA.Side, b, sideB.Side, reversed);
        vertices.Sets.Unite(vertices.NumberOf(PointOnSide(a, sideA.Side, position)),
          vertices.NumberOf(PointOnSide(b, sideB.Side, other)));
      }
    }
    for (const PatchSide& side : this->Collapsed)
    {
      const Face& face = this->Faces[At(side.Patch)];
      const std::vector<std::int64_t> along = this->Lines.Along(face, side.Side);
      for (const std::int64_t position : along)
      {
        vertices.Sets.Unite(vertices.NumberOf(PointOnSide(face, side.Side, along.front())),
          vertices.NumberOf(PointOnSide(face, side.Side, position)));
      }
    }
  }

private:
  /// Finds the sides that are one and those that are points.
  void MatchSides(int planes, double largest)
  {
    SideMatcher matcher(planes, largest);
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      const Face& face = this->Faces[f];
      for (int side = 0; side < 4; ++side)
      {
        if (face.Rim[At(side)])
        {
          const std::vector<double> points = SidePoints(face, side, planes);
          matcher.Add(
            { static_cast<int>(f), side }, { face.Degree[At(SideAxis(side))] + 1, 1 }, points);
          if (IsCollapsed(points, planes))
          {
            this->Collapsed.push_back({ static_cast<int>(f), side });
          }
        }
      }
    }
    this->Shared = matcher.Interfaces();
  }

  void DivideSides()
  {
    for (const Face& face : this->Faces)
    {
      for (int side = 0; side < 4; ++side)
      {
        const std::size_t axis = At(SideAxis(side));
        const std::int64_t step = face.Size[axis] >> face.Halvings[axis];
        for (std::int64_t i = 0; i <= std::int64_t{ 1 } << face.Halvings[axis]; ++i)
        {
          this->Lines.Add(face, side, face.Lower[axis] + i * step);
        }
      }
    }
    this->Lines.Sort();
    do
    {
      for (const PatchInterface& shared : this->Shared)
      {
        const bool reversed = shared.Orientation.Reversed[0];
        this->AddMissing(shared.Sides[0], shared.Sides[1], reversed);
        this->AddMissing(shared.Sides[1], shared.Sides[0], reversed);
      }
    } while (this->Lines.Sort());
  }

  /// What is on one side and not on the other one yet.
  void AddMissing(const PatchSide& from, const PatchSide& to, bool reversed)
  {
    const Face& a = this->Faces[At(from.Patch)];
    const Face& b = this->Faces[At(to.Patch)];
    const std::vector<std::int64_t> there = this->Lines.Along(b, to.Side);
    for (const std::int64_t position : this->Lines.Along(a, from.Side))
    {
      const std::int64_t other = Transfer(position, a, from.Side, b, to.Side, reversed);
      if (!std::binary_search(there.begin(), there.end(), other))
      {
        this->Lines.Add(b, to.Side, other);
      }
    }
  }

  std::vector<Face> Faces;
  LinePoints Lines;
  std::vector<PatchInterface> Shared; ///< of faces
  std::vector<PatchSide> Collapsed;   ///< of faces
};
}

template <int Dim>
Status TessellateSurfaces(const std::vector<BezierForm<Dim>>& patches,
  const TessellationParams& params, TessellationMesh& mesh)
{
  FaceCuts cuts;
  if (Status status = cuts.Divide(patches, params, mesh); !status)
  {
    return status;
  }
  return AssembleTessellation<Dim>(patches, params, cuts, mesh);
}

template Status TessellateSurfaces<2>(
  const std::vector<BezierForm<2>>&, const TessellationParams&, TessellationMesh&);
template Status TessellateSurfaces<3>(
  const std::vector<BezierForm<3>>&, const TessellationParams&, TessellationMesh&);
}
