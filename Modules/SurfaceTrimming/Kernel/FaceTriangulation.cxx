// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTriangulation.h"

#include "ConstrainedDelaunay.h"
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/Parallel.h>

#include <cmath>
#include <tuple>
#include <unordered_set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

double SquaredDistance(const PlanarPoint& p, const PlanarPoint& a, const PlanarPoint& b)
{
  const Eigen::Vector2d ab(b[0] - a[0], b[1] - a[1]);
  const Eigen::Vector2d ap(p[0] - a[0], p[1] - a[1]);
  const double length = ab.squaredNorm();
  const double share = length > 0.0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0.0;
  return (ap - share * ab).squaredNorm();
}

/// Segments for questions of distance.
class SegmentTree
{
public:
  SegmentTree(const std::vector<PlanarPoint>& points, const std::vector<PlanarSegment>& segments)
    : Points(points), Segments(segments), Tree(SegmentBoxes(points, segments).Tree)
  {
  }

  /// Segment nearer than a distance, -1: none.
  int Nearest(const PlanarPoint& p, double distance) const
  {
    return this->Tree
      .Nearest(
        p.data(),
        [&](int s)
        {
          return SquaredDistance(p, this->Points[At(this->Segments[At(s)][0])],
            this->Points[At(this->Segments[At(s)][1])]);
        },
        distance * distance)
      .Item;
  }

  double Length(int s) const
  {
    const PlanarPoint& a = this->Points[At(this->Segments[At(s)][0])];
    const PlanarPoint& b = this->Points[At(this->Segments[At(s)][1])];
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  }

private:
  const std::vector<PlanarPoint>& Points;
  const std::vector<PlanarSegment>& Segments;
  BoxTree Tree;
};

/// The first crease between two parameters that does not run through one of them, or null.
const double* CreaseBetween(const std::vector<double>& creases, double a, double b, double margin)
{
  const auto crease = std::upper_bound(creases.begin(), creases.end(), std::min(a, b) + margin);
  return crease != creases.end() && *crease < std::max(a, b) - margin ? &*crease : nullptr;
}

/// Bound of linear interpolation in a box with a crease at `at` across direction d. Let S be
/// continued from the longer side over the crease by 2 S(at) - S(reflected): this is smooth, has at
/// most the second derivatives of S but for three times the one along the crease, and differs from
/// S by at most twice the first derivative times the width of the shorter side, in the corners and
/// in the point between them.
double CreasedDeviation(CellBounds bounds, const ParametricBox<2>& box, std::size_t d, double at)
{
  bounds.Second[d == 0 ? 2 : 0] *= 3.0;
  const double width = std::min(at - box.Lower[d], box.Upper[d] - at);
  return ChordalDeviation(bounds, { box.Upper[0] - box.Lower[0], box.Upper[1] - box.Lower[1] }) +
    4.0 * bounds.First[d] * width;
}

constexpr double Shear = 1.0 / 65536.0;
/// Points nearer than this to a polygon are taken for points of it.
constexpr double Touching = 1024.0;
/// A new point nearer to a segment than this share of the edge that it divides divides the segment
/// instead.
constexpr double Encroachment = 0.05;
}

/// Scaled, and sheared a little: the rectangles of the cells' corners are cocircular no more, and
/// their diagonals are all the same.
PlanarPoint FaceTriangulation::Planar(const std::array<double, 2>& uv) const
{
  const double x = this->Scale[0] * (uv[0] - this->Middle[0]);
  const double y = this->Scale[1] * (uv[1] - this->Middle[1]);
  const auto round = [this](double value)
  { return std::clamp(std::round(this->Grid * value), -PlanarGridSize, PlanarGridSize); };
  return { round(x + Shear * y), round(y) };
}

void FaceTriangulation::SetPlane(const std::vector<SampledEdge>& edges)
{
  this->Scale = this->Cells.MeanSpeeds();
  this->CollectBoundary(edges);
  std::array<double, 2> lower{};
  std::array<double, 2> upper{};
  double largest = 0.0;
  for (std::size_t d = 0; d < 2; ++d)
  {
    lower[d] = upper[d] = this->Points.front().UV[d];
    for (const FacePoint& point : this->Points)
    {
      lower[d] = std::min(lower[d], point.UV[d]);
      upper[d] = std::max(upper[d], point.UV[d]);
    }
    this->Middle[d] = 0.5 * (lower[d] + upper[d]);
    largest = std::max(largest, this->Scale[d] * (upper[d] - lower[d]));
  }
  this->Grid = largest > 0.0 ? PlanarGridSize / (2.0 * largest) : 1.0;
}

/// Polygons of the loops: Points, Plane, Segments and Sides.
void FaceTriangulation::CollectBoundary(const std::vector<SampledEdge>& edges)
{
  this->Points.clear();
  this->Plane.clear();
  this->Segments.clear();
  this->Sides.clear();
  const ParametricBox<2> domain = this->Form.Space->Domain();
  std::vector<std::array<double, 2>> outside;
  std::vector<int> atVertex; // points that are vertices
  const auto addPoint = [&](std::array<double, 2> uv, const FacePoint& origin, bool mayTouch)
  {
    std::array<double, 2> off{};
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double inside = std::clamp(uv[d], domain.Lower[d], domain.Upper[d]);
      off[d] = std::abs(uv[d] - inside);
      uv[d] = inside;
    }
    const PlanarPoint plane = this->Planar(uv);
    if (mayTouch) // loops may touch at vertices
    {
      for (int other : atVertex)
      {
        if (this->Points[At(other)].Vertex == origin.Vertex &&
          std::abs(this->Plane[At(other)][0] - plane[0]) < Touching &&
          std::abs(this->Plane[At(other)][1] - plane[1]) < Touching)
        {
          return other;
        }
      }
      atVertex.push_back(static_cast<int>(this->Points.size()));
    }
    this->Points.push_back(origin);
    this->Points.back().UV = uv;
    this->Plane.push_back(plane);
    outside.push_back(off);
    return static_cast<int>(this->Points.size()) - 1;
  };
  for (const std::vector<EdgeSide>& loop : this->Loops)
  {
    const std::size_t firstSegment = this->Segments.size();
    for (const EdgeSide& side : loop)
    {
      const SampledEdge& edge = edges[At(side.Edge)];
      const PointMatrix uv = EvaluateCurve(side.Curve.Form, edge.Parameters);
      const int n = static_cast<int>(edge.Parameters.size());
      for (int i = 0; i + 1 < n; ++i)
      {
        const int sample = side.Reversed ? n - 1 - i : i;
        const int next = side.Reversed ? sample - 1 : sample + 1;
        FacePoint origin;
        if (i == 0 || edge.Collapsed)
        {
          origin.Vertex = side.Vertices[side.Reversed ? 1 : 0];
        }
        else
        {
          origin.Edge = side.Edge;
          origin.Sample = sample;
        }
        const int point = addPoint({ uv(sample, 0), uv(sample, 1) }, origin, i == 0);
        this->Segments.push_back({ point, point });
        this->Sides.push_back(
          { side.Edge, { edge.Parameters[At(sample)], edge.Parameters[At(next)] }, &side.Curve,
            outside[At(point)] });
      }
    }
    const std::size_t count = this->Segments.size() - firstSegment;
    for (std::size_t s = 0; s < count; ++s)
    {
      PlanarSegment& segment = this->Segments[firstSegment + s];
      segment[1] = this->Segments[firstSegment + (s + 1) % count][0];
      for (std::size_t d = 0; d < 2; ++d)
      {
        this->Sides[firstSegment + s].Outside[d] =
          std::max(outside[At(segment[0])][d], outside[At(segment[1])][d]);
      }
    }
  }
}

void FaceTriangulation::MeasureGaps(
  const std::vector<SampledEdge>& edges, const PointMatrix& vertices)
{
  PointMatrix uv(static_cast<Eigen::Index>(this->Points.size()), 2);
  for (Eigen::Index i = 0; i < uv.rows(); ++i)
  {
    uv.row(i) << this->Points[static_cast<std::size_t>(i)].UV[0],
      this->Points[static_cast<std::size_t>(i)].UV[1];
  }
  EvaluationBatch batch;
  EvaluateParameters<2>(this->Form, uv, { 0, 1 }, batch);
  for (Eigen::Index i = 0; i < uv.rows(); ++i)
  {
    FacePoint& point = this->Points[static_cast<std::size_t>(i)];
    point.Gap = point.Vertex >= 0
      ? (batch.Values.row(i) - vertices.row(point.Vertex)).norm()
      : (batch.Values.row(i) - edges[At(point.Edge)].Points.row(point.Sample)).norm();
  }
}

/// Corners of cells that lie inside the polygons and keep a distance from them.
void FaceTriangulation::ChooseInterior()
{
  struct Corner
  {
    std::array<double, 2> UV;
    double Clearance;
  };
  std::vector<Corner> corners;
  for (const SurfaceCells::Cell& cell : this->Cells.Cells())
  {
    if (cell.Children >= 0)
    {
      continue;
    }
    const std::array<double, 2> sides{ this->Scale[0] * (cell.Box.Upper[0] - cell.Box.Lower[0]),
      this->Scale[1] * (cell.Box.Upper[1] - cell.Box.Lower[1]) };
    const double clearance = 0.3 * this->Grid * std::min(sides[0], sides[1]);
    for (int c = 0; c < 4; ++c)
    {
      corners.push_back({ { (c % 2 == 0 ? cell.Box.Lower : cell.Box.Upper)[0],
                            (c / 2 == 0 ? cell.Box.Lower : cell.Box.Upper)[1] },
        clearance });
    }
  }
  std::sort(corners.begin(), corners.end(),
    [](const Corner& a, const Corner& b)
    { return std::tie(a.UV, a.Clearance) < std::tie(b.UV, b.Clearance); });
  corners.erase(std::unique(corners.begin(), corners.end(),
                  [](const Corner& a, const Corner& b) { return a.UV == b.UV; }),
    corners.end());
  std::vector<PlanarPoint> plane;
  for (const Corner& corner : corners)
  {
    plane.push_back(this->Planar(corner.UV));
  }
  const std::vector<bool> inside = InsidePolygons(this->Plane, this->Segments, plane);
  const SegmentTree tree(this->Plane, this->Segments);
  for (std::size_t c = 0; c < corners.size(); ++c)
  {
    if (inside[c] && tree.Nearest(plane[c], corners[c].Clearance) < 0)
    {
      this->Interior.push_back(corners[c].UV);
    }
  }
}

/// Asks for a point of the edge of a segment.
void FaceTriangulation::RequestSide(std::size_t side, double excess, double share)
{
  const auto& [begin, end] = this->Sides[side].Parameters;
  PointRequest request;
  request.Excess = excess;
  request.Edge = this->Sides[side].Edge;
  // From the lower end: the sides of both faces have the same middle, bit for bit.
  request.Parameter =
    begin < end ? begin + share * (end - begin) : end + (1.0 - share) * (begin - end);
  if (request.Parameter != begin && request.Parameter != end)
  {
    this->Requests.push_back(request);
  }
}

/// Bound of |S(chord) - S(pcurve)| along a segment.
double FaceTriangulation::OffSide(std::size_t s) const
{
  const Side& side = this->Sides[s];
  const auto& [a, b] = side.Parameters;
  std::array<double, 2> off = side.Curve->Deviation(std::min(a, b), std::max(a, b));
  ParametricBox<2> box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double p = this->Points[At(this->Segments[s][0])].UV[d];
    const double q = this->Points[At(this->Segments[s][1])].UV[d];
    off[d] += side.Outside[d];
    box.Lower[d] = std::min(p, q) - off[d];
    box.Upper[d] = std::max(p, q) + off[d];
  }
  if (off[0] == 0.0 && off[1] == 0.0)
  {
    return 0.0;
  }
  const CellBounds bounds = this->Cells.Bound(box);
  return bounds.First[0] * off[0] + bounds.First[1] * off[1];
}

/// The segment between two points, -1: none.
int FaceTriangulation::FindSide(int a, int b) const
{
  const auto found = std::lower_bound(
    this->SidesByEnds.begin(), this->SidesByEnds.end(), std::make_pair(PlanarSegment{ a, b }, -1));
  return found != this->SidesByEnds.end() && found->first == PlanarSegment{ a, b } ? found->second
                                                                                   : -1;
}

/// Bound of a triangle, and where it is to be divided when that is above the tolerance.
/// @param off  of segments: bound of |S(chord) - S(pcurve)|.
FaceTriangulation::Verdict FaceTriangulation::CheckTriangle(
  std::size_t t, const std::vector<double>& off, double tolerance) const
{
  const ParametricBox<2> domain = this->Form.Space->Domain();
  std::array<double, 2> margin{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    margin[d] = 1e-12 * (domain.Upper[d] - domain.Lower[d]);
  }
  const std::array<int, 3>& corners = this->Triangles[t];
  ParametricBox<2> box{ this->Points[At(corners[0])].UV, this->Points[At(corners[0])].UV };
  double gap = 0.0;
  double largestOff = 0.0;
  int offEdge = 0;
  for (int i = 0; i < 3; ++i)
  {
    const FacePoint& point = this->Points[At(corners[At(i)])];
    gap = std::max(gap, point.Gap);
    for (std::size_t d = 0; d < 2; ++d)
    {
      box.Lower[d] = std::min(box.Lower[d], point.UV[d]);
      box.Upper[d] = std::max(box.Upper[d], point.UV[d]);
    }
    const int side = this->FindSide(corners[At(i)], corners[At((i + 1) % 3)]);
    if (side >= 0 && off[At(side)] > largestOff)
    {
      largestOff = off[At(side)];
      offEdge = i;
    }
  }
  const CellBounds bounds = this->Cells.Bound(box);
  const std::array<double, 2> extent{ box.Upper[0] - box.Lower[0], box.Upper[1] - box.Lower[1] };
  double chord = ChordalDeviation(bounds, extent);
  std::array<const double*, 2> crease{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    crease[d] = CreaseBetween(this->Cells.Creases()[d], box.Lower[d], box.Upper[d], margin[d]);
  }
  const bool creased = crease[0] != nullptr || crease[1] != nullptr;
  if (creased)
  {
    chord = bounds.First[0] * extent[0] + bounds.First[1] * extent[1];
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (crease[d] != nullptr && crease[1 - d] == nullptr &&
        CreaseBetween(this->Cells.Creases()[d], *crease[d], box.Upper[d], margin[d]) == nullptr)
      {
        chord = std::min(chord, CreasedDeviation(bounds, box, d, *crease[d]));
      }
    }
  }
  Verdict verdict;
  verdict.Bound = chord + largestOff + gap;
  verdict.Excess = chord + largestOff - std::max(tolerance - gap, 0.5 * tolerance);
  if (verdict.Excess <= 0.0)
  {
    verdict.Excess = 0.0;
    return verdict;
  }
  if (largestOff > chord)
  {
    verdict.Edge = offEdge;
    return verdict;
  }
  double largest = -1.0;
  for (int i = 0; i < 3; ++i)
  {
    const std::array<double, 2>& p = this->Points[At(corners[At(i)])].UV;
    const std::array<double, 2>& q = this->Points[At(corners[At((i + 1) % 3)])].UV;
    const std::array<double, 2> along{ std::abs(q[0] - p[0]), std::abs(q[1] - p[1]) };
    double share = 0.5;
    double need = ChordalDeviation(bounds, along);
    if (creased)
    {
      need = -1.0;
      for (std::size_t d = 0; d < 2; ++d)
      {
        const double* at = CreaseBetween(this->Cells.Creases()[d], p[d], q[d], margin[d]);
        if (at != nullptr && bounds.First[0] * along[0] + bounds.First[1] * along[1] > need)
        {
          need = bounds.First[0] * along[0] + bounds.First[1] * along[1];
          share = (*at - p[d]) / (q[d] - p[d]);
        }
      }
    }
    if (need > largest)
    {
      largest = need;
      verdict.Edge = i;
      verdict.Share = share;
    }
  }
  return verdict;
}

/// Bounds of all triangles, and requests for those above the tolerance.
void FaceTriangulation::CheckTriangles(double tolerance, int threads)
{
  this->SidesByEnds.clear();
  for (std::size_t s = 0; s < this->Segments.size(); ++s)
  {
    this->SidesByEnds.emplace_back(this->Segments[s], static_cast<int>(s));
  }
  std::sort(this->SidesByEnds.begin(), this->SidesByEnds.end());
  std::vector<double> off(this->Segments.size());
  ParallelFor(off.size(), 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        off[s] = this->OffSide(s);
      }
    });

  std::vector<Verdict> verdicts(this->Triangles.size());
  ParallelFor(verdicts.size(), 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t t = begin; t < end; ++t)
      {
        verdicts[t] = this->CheckTriangle(t, off, tolerance);
      }
    });

  this->Bound = 0.0;
  for (const Verdict& verdict : verdicts)
  {
    this->Bound = std::max(this->Bound, verdict.Bound);
  }
  this->RequestPoints(verdicts);
}

/// Points that divide the triangles above the tolerance, the worst ones first.
void FaceTriangulation::RequestPoints(const std::vector<Verdict>& verdicts)
{
  std::vector<int> bad;
  for (std::size_t t = 0; t < verdicts.size(); ++t)
  {
    if (verdicts[t].Excess > 0.0)
    {
      bad.push_back(static_cast<int>(t));
    }
  }
  std::sort(bad.begin(), bad.end(),
    [&](int a, int b)
    {
      return verdicts[At(a)].Excess != verdicts[At(b)].Excess
        ? verdicts[At(a)].Excess > verdicts[At(b)].Excess
        : a < b;
    });
  // A triangle one of whose edges is divided already goes away.
  const SegmentTree tree(this->Plane, this->Segments);
  std::vector<bool> sideAsked(this->Segments.size(), false);
  const auto edgeOf = [&](int t, int i) -> std::array<int, 2>
  {
    const int a = this->Triangles[At(t)][At(i)];
    const int b = this->Triangles[At(t)][At((i + 1) % 3)];
    return { std::min(a, b), std::max(a, b) };
  };
  std::unordered_set<std::uint64_t> taken;
  const auto key = [](const std::array<int, 2>& edge)
  { return (static_cast<std::uint64_t>(edge[0]) << 32) | static_cast<std::uint64_t>(edge[1]); };
  for (int t : bad)
  {
    const Verdict& verdict = verdicts[At(t)];
    if (taken.count(key(edgeOf(t, 0))) + taken.count(key(edgeOf(t, 1))) +
        taken.count(key(edgeOf(t, 2))) >
      0)
    {
      continue;
    }
    taken.insert(key(edgeOf(t, verdict.Edge)));
    const int a = this->Triangles[At(t)][At(verdict.Edge)];
    const int b = this->Triangles[At(t)][At((verdict.Edge + 1) % 3)];
    int side = this->FindSide(a, b);
    double share = verdict.Share;
    const std::array<double, 2>& p = this->Points[At(a)].UV;
    const std::array<double, 2>& q = this->Points[At(b)].UV;
    const std::array<double, 2> uv{ p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]) };
    if (side < 0)
    {
      const double length = std::hypot(this->Plane[At(b)][0] - this->Plane[At(a)][0],
        this->Plane[At(b)][1] - this->Plane[At(a)][1]);
      const int near = tree.Nearest(this->Planar(uv), Encroachment * length);
      if (near >= 0 && tree.Length(near) > 4.0 * Encroachment * length)
      {
        side = near;
        share = 0.5;
      }
    }
    if (side < 0)
    {
      PointRequest request;
      request.Excess = verdict.Excess;
      request.UV = uv;
      this->Requests.push_back(request);
    }
    else if (!sideAsked[At(side)])
    {
      sideAsked[At(side)] = true;
      this->RequestSide(At(side), verdict.Excess, share);
    }
  }
}

Status FaceTriangulation::Update(
  const std::vector<SampledEdge>& edges, const PointMatrix& vertices, double tolerance, int threads)
{
  this->CollectBoundary(edges);
  this->Requests.clear();
  this->Triangles.clear();
  this->Simple = false;
  const auto askFor = [this](const std::vector<int>& segments)
  {
    for (int s : segments)
    {
      this->RequestSide(At(s), 0.0);
    }
  };
  std::vector<int> crossing;
  for (const auto& pair : FindCrossings(this->Plane, this->Segments))
  {
    crossing.insert(crossing.end(), pair.begin(), pair.end());
  }
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  if (!crossing.empty())
  {
    askFor(crossing);
    return {};
  }
  this->MeasureGaps(edges, vertices);
  if (!this->HasInterior)
  {
    this->ChooseInterior();
    this->HasInterior = true;
  }
  const SegmentTree tree(this->Plane, this->Segments);
  this->Interior.erase(std::remove_if(this->Interior.begin(), this->Interior.end(),
                         [&](const std::array<double, 2>& uv)
                         { return tree.Nearest(this->Planar(uv), Touching) >= 0; }),
    this->Interior.end());
  for (const std::array<double, 2>& uv : this->Interior)
  {
    this->Points.push_back({ uv, -1, -1, -1, 0.0 });
    this->Plane.push_back(this->Planar(uv));
  }
  const auto triangles = ConstrainedDelaunay(this->Plane, this->Segments);
  if (!triangles)
  {
    return triangles.Status;
  }
  PlanarRegion region = SelectRegion(this->Plane.size(), triangles.Value, this->Segments);
  if (!region.Misplaced.empty())
  {
    askFor(region.Misplaced);
    return {};
  }
  this->Simple = true;
  this->Triangles = std::move(region.Triangles);
  this->CheckTriangles(tolerance, threads);
  return {};
}
}
