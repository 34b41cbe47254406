// SPDX-License-Identifier: BSD-3-Clause
#include "RemeshLoop.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double LongEdge = 4.0 / 3.0;  ///< of the length asked for: longer ones are divided
constexpr double ShortEdge = 4.0 / 5.0; ///< shorter ones are joined
constexpr double LeastAgreement = 0.5;  ///< cosine between normals of a triangle and below it
constexpr double FairShape = 0.3;       ///< shapes above may become worse for better lengths
constexpr double LeastGain = 1.02;      ///< of a shape, for which edges are turned
constexpr int MostRounds = 40;          ///< of divisions in an iteration: each halves
constexpr int Polishing = 5;            ///< times that shapes are improved at last
constexpr int InnerValence = 6;
constexpr int RimValence = 4;
constexpr double Sixty = M_PI / 3.0;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// How free a point is to move.
enum class Freedom
{
  Surface = 0,
  Chain,
  Corner
};

struct Link
{
  int Other;
  int Chain;
};

struct Vertex
{
  Eigen::Vector3d Place = Eigen::Vector3d::Zero();
  double Size = 0.0;
  Freedom Free = Freedom::Surface;
  int Chain = -1;             ///< of Freedom::Chain
  int Valence = InnerValence; ///< that is best
  bool OnSurface = true;
  bool OnRim = false;
  std::vector<int> Triangles;
  std::vector<Link> Links; ///< edges on chains
};

/// A triangle against the surface.
struct Shape
{
  double Quality = 0.0;   ///< 1: equilateral, 0: no area
  double Agreement = 1.0; ///< cosine between its normal and that of the surface below its middle
  double Distance = 0.0;  ///< of its middle, and those of its edges where asked for
  int Hint = -1;
};

/// The worst of several.
struct Worst
{
  double Quality = 1.0;
  double Agreement = 1.0;
  double Distance = 0.0;
  void Add(const Shape& shape)
  {
    this->Quality = std::min(this->Quality, shape.Quality);
    this->Agreement = std::min(this->Agreement, shape.Agreement);
    this->Distance = std::max(this->Distance, shape.Distance);
  }
};

struct Edge
{
  int First;
  int Second;
  double Ratio; ///< of its length and that asked for
};

class Loop
{
public:
  Loop(const DiscMesh& surface, const MeshFeatures& features, const std::vector<double>& sizes,
    double limit)
    : Reference(surface, features, sizes), Limit(limit)
  {
    this->Start(surface, features, sizes);
  }

  bool Run(int iterations, const std::function<bool(double)>& goesOn)
  {
    const double steps = iterations + Polishing;
    for (int i = 0; i < iterations; ++i)
    {
      this->SplitLongEdges();
      this->CollapseShortEdges();
      this->FlipEdges(true);
      this->MovePoints(false);
      if (!goesOn((i + 1) / steps))
      {
        return false;
      }
    }
    for (int i = 0; i < Polishing; ++i)
    {
      this->FlipEdges(false);
      this->MovePoints(true);
      if (!goesOn((iterations + i + 1) / steps))
      {
        return false;
      }
    }
    return true;
  }

  RemeshedPart Take() const;

private:
  // ----------------------------------------------------------------- what there is

  void Start(
    const DiscMesh& surface, const MeshFeatures& features, const std::vector<double>& sizes)
  {
    this->Vertices.resize(At(surface.NumPoints()));
    std::vector<double> angles(this->Vertices.size(), 0.0);
    for (std::size_t i = 0; i < this->Vertices.size(); ++i)
    {
      this->Vertices[i].Place = surface.Point(static_cast<int>(i));
      this->Vertices[i].Size = sizes[i];
      this->Vertices[i].OnRim = surface.OnBoundary[i] != 0;
    }
    for (std::size_t c = 0; c < features.Chains.size(); ++c)
    {
      const FeatureChain& chain = features.Chains[c];
      const std::size_t n = chain.Points.size();
      for (std::size_t i = 0; i < n; ++i)
      {
        Vertex& here = this->Vertices[At(chain.Points[i])];
        here.Free = Freedom::Chain;
        here.Chain = static_cast<int>(c);
        if (i + (chain.Closed ? 0 : 1) < n)
        {
          const int next = chain.Points[(i + 1) % n];
          here.Links.push_back({ next, static_cast<int>(c) });
          this->Vertices[At(next)].Links.push_back({ chain.Points[i], static_cast<int>(c) });
        }
      }
    }
    for (const int corner : features.Corners)
    {
      this->Vertices[At(corner)].Free = Freedom::Corner;
    }
    this->Triangles = surface.Triangles;
    this->Regions = features.Regions;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const MeshTriangle& corners = this->Triangles[t];
      for (std::size_t k = 0; k < 3; ++k)
      {
        this->Vertices[At(corners[k])].Triangles.push_back(static_cast<int>(t));
        const Eigen::Vector3d a = this->Place(corners[(k + 1) % 3]) - this->Place(corners[k]);
        const Eigen::Vector3d b = this->Place(corners[(k + 2) % 3]) - this->Place(corners[k]);
        angles[At(corners[k])] += std::atan2(a.cross(b).norm(), a.dot(b));
      }
      this->Shapes.push_back(this->Measure(corners, this->Regions[t], -1, false));
    }
    for (std::size_t i = 0; i < this->Vertices.size(); ++i)
    {
      Vertex& vertex = this->Vertices[i];
      vertex.Valence = vertex.OnRim ? RimValence : InnerValence;
      if (vertex.Free == Freedom::Corner)
      {
        const int triangles = std::max(1, static_cast<int>(std::lround(angles[i] / Sixty)));
        vertex.Valence = vertex.OnRim ? triangles + 1 : std::max(3, triangles);
      }
    }
  }

  const Eigen::Vector3d& Place(int i) const { return this->Vertices[At(i)].Place; }
  double TargetOf(int a, int b) const
  {
    return 0.5 * (this->Vertices[At(a)].Size + this->Vertices[At(b)].Size);
  }
  double RatioOf(int a, int b) const
  {
    return (this->Place(a) - this->Place(b)).norm() / this->TargetOf(a, b);
  }
  /// Chain of an edge, -1: of none.
  int ChainOf(int a, int b) const
  {
    for (const Link& link : this->Vertices[At(a)].Links)
    {
      if (link.Other == b)
      {
        return link.Chain;
      }
    }
    return -1;
  }
  static bool Has(const MeshTriangle& corners, int point)
  {
    return corners[0] == point || corners[1] == point || corners[2] == point;
  }
  /// Corner of a triangle beside those of an edge.
  static int Opposite(const MeshTriangle& corners, int a, int b)
  {
    for (const int corner : corners)
    {
      if (corner != a && corner != b)
      {
        return corner;
      }
    }
    return -1;
  }
  static MeshTriangle Replaced(MeshTriangle corners, int from, int to)
  {
    std::replace(corners.begin(), corners.end(), from, to);
    return corners;
  }
  std::vector<int> TrianglesOf(int a, int b) const
  {
    std::vector<int> both;
    for (const int t : this->Vertices[At(a)].Triangles)
    {
      if (Has(this->Triangles[At(t)], b))
      {
        both.push_back(t);
      }
    }
    return both;
  }
  bool AreNeighbours(int a, int b) const
  {
    const auto& around = this->Vertices[At(a)].Triangles;
    return std::any_of(
      around.begin(), around.end(), [&](int t) { return Has(this->Triangles[At(t)], b); });
  }
  /// Ascending.
  std::vector<int> NeighboursOf(int point) const
  {
    std::vector<int> neighbours;
    for (const int t : this->Vertices[At(point)].Triangles)
    {
      for (const int corner : this->Triangles[At(t)])
      {
        if (corner != point)
        {
          neighbours.push_back(corner);
        }
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    return neighbours;
  }
  /// Edges whose ratio is asked for, in the order of points.
  template <typename Wanted>
  std::vector<Edge> EdgesOf(Wanted&& wanted) const
  {
    std::vector<Edge> edges;
    for (int i = 0; i < static_cast<int>(this->Vertices.size()); ++i)
    {
      for (const int j : this->NeighboursOf(i))
      {
        if (i < j)
        {
          const double ratio = this->RatioOf(i, j);
          if (wanted(ratio))
          {
            edges.push_back({ i, j, ratio });
          }
        }
      }
    }
    return edges;
  }

  // ----------------------------------------------------------------- shapes

  /// @param withEdges  middles of edges count for the distance, too.
  Shape Measure(const MeshTriangle& corners, int region, int hint, bool withEdges) const
  {
    const Eigen::Vector3d& a = this->Place(corners[0]);
    const Eigen::Vector3d& b = this->Place(corners[1]);
    const Eigen::Vector3d& c = this->Place(corners[2]);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double twiceArea = normal.norm();
    const double edges = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    Shape shape;
    shape.Quality = edges > 0.0 ? 2.0 * std::sqrt(3.0) * twiceArea / edges : 0.0;
    const ReferenceFoot foot = this->Reference.OnRegion(region, (a + b + c) / 3.0, hint);
    shape.Agreement = twiceArea > 0.0 ? normal.dot(foot.Normal) / twiceArea : -1.0;
    shape.Distance = foot.Distance;
    shape.Hint = foot.Hint;
    if (withEdges)
    {
      const Eigen::Vector3d middles[] = { 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a) };
      for (const Eigen::Vector3d& middle : middles)
      {
        shape.Distance =
          std::max(shape.Distance, this->Reference.OnRegion(region, middle, foot.Hint).Distance);
      }
    }
    return shape;
  }
  bool IsAllowed(const Worst& before, const Worst& after) const
  {
    return after.Agreement >= std::min(LeastAgreement, before.Agreement) &&
      after.Distance <= std::max(this->Limit, before.Distance) &&
      after.Quality >= std::min(FairShape, before.Quality);
  }
  /// Where a point would be on its region or chain.
  ReferenceFoot FootOf(Freedom free, int chain, int region, const Eigen::Vector3d& place) const
  {
    return free == Freedom::Chain ? this->Reference.OnChain(chain, place)
                                  : this->Reference.OnRegion(region, place);
  }
  /// Moves a point if its triangles allow it.
  /// @param better  only if the worst shape becomes better.
  bool Move(int point, const ReferenceFoot& foot, bool better)
  {
    Vertex& vertex = this->Vertices[At(point)];
    const Eigen::Vector3d old = vertex.Place;
    vertex.Place = foot.Place;
    Worst before;
    Worst after;
    std::vector<Shape> shapes;
    for (const int t : vertex.Triangles)
    {
      before.Add(this->Shapes[At(t)]);
      shapes.push_back(this->Measure(
        this->Triangles[At(t)], this->Regions[At(t)], this->Shapes[At(t)].Hint, false));
      after.Add(shapes.back());
    }
    if (!this->IsAllowed(before, after) || (better && after.Quality < before.Quality))
    {
      vertex.Place = old;
      return false;
    }
    vertex.Size = foot.Size;
    vertex.OnSurface = true;
    for (std::size_t i = 0; i < shapes.size(); ++i)
    {
      this->Shapes[At(vertex.Triangles[i])] = shapes[i];
    }
    return true;
  }

  // ----------------------------------------------------------------- long edges

  void SplitLongEdges()
  {
    for (int round = 0; round < MostRounds; ++round)
    {
      auto edges = this->EdgesOf([](double ratio) { return ratio > LongEdge; });
      if (edges.empty())
      {
        return;
      }
      std::stable_sort(
        edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.Ratio > b.Ratio; });
      for (const Edge& edge : edges)
      {
        this->Split(edge.First, edge.Second);
      }
    }
  }
  void Split(int a, int b)
  {
    const std::vector<int> both = this->TrianglesOf(a, b);
    const int chain = this->ChainOf(a, b);
    const int middle = static_cast<int>(this->Vertices.size());
    this->Vertices.emplace_back();
    Vertex& vertex = this->Vertices.back();
    vertex.Place = 0.5 * (this->Place(a) + this->Place(b));
    vertex.Size = this->TargetOf(a, b);
    vertex.Free = chain >= 0 ? Freedom::Chain : Freedom::Surface;
    vertex.Chain = chain;
    vertex.OnRim = both.size() == 1;
    vertex.Valence = vertex.OnRim ? RimValence : InnerValence;
    vertex.OnSurface = false;
    if (chain >= 0)
    {
      vertex.Links = { { a, chain }, { b, chain } };
      for (const auto& [end, other] : { std::pair(a, b), std::pair(b, a) })
      {
        for (Link& link : this->Vertices[At(end)].Links)
        {
          if (link.Other == other && link.Chain == chain)
          {
            link.Other = middle;
          }
        }
      }
    }
    for (const int t : both)
    {
      const MeshTriangle old = this->Triangles[At(t)];
      const int fresh = static_cast<int>(this->Triangles.size());
      this->Triangles[At(t)] = Replaced(old, b, middle);
      this->Triangles.push_back(Replaced(old, a, middle));
      this->Regions.push_back(this->Regions[At(t)]);
      auto& atEnd = this->Vertices[At(b)].Triangles;
      std::replace(atEnd.begin(), atEnd.end(), t, fresh);
      this->Vertices[At(Opposite(old, a, b))].Triangles.push_back(fresh);
      vertex.Triangles.push_back(t);
      vertex.Triangles.push_back(fresh);
      const Shape shape = this->Shapes[At(t)];
      this->Shapes.push_back(shape);
      for (const int half : { t, fresh })
      {
        this->Shapes[At(half)] =
          this->Measure(this->Triangles[At(half)], this->Regions[At(half)], shape.Hint, false);
      }
    }
    this->Move(
      middle, this->FootOf(vertex.Free, chain, this->Regions[At(both[0])], vertex.Place), false);
  }

  // ----------------------------------------------------------------- short edges

  void CollapseShortEdges()
  {
    auto edges = this->EdgesOf([](double ratio) { return ratio < ShortEdge; });
    std::stable_sort(
      edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.Ratio < b.Ratio; });
    for (const Edge& edge : edges)
    {
      // what came before may have taken a point away, or made the edge longer
      if (this->AreNeighbours(edge.First, edge.Second) &&
        this->RatioOf(edge.First, edge.Second) < ShortEdge)
      {
        this->Collapse(edge.First, edge.Second);
      }
    }
  }
  /// Whether the surface hangs together as before without the edge and its triangles.
  bool CanCollapse(int goes, int stays, const std::vector<int>& both) const
  {
    const Vertex& gone = this->Vertices[At(goes)];
    const int chain = this->ChainOf(goes, stays);
    if (chain >= 0)
    {
      if (gone.Free != Freedom::Chain)
      {
        return false;
      }
      for (const Link& link : gone.Links)
      {
        if (link.Other != stays && this->ChainOf(link.Other, stays) >= 0)
        {
          return false; // the chain would run along the edge twice
        }
      }
    }
    else if (gone.Free != Freedom::Surface)
    {
      return false;
    }
    const std::vector<int> ofGone = this->NeighboursOf(goes);
    const std::vector<int> ofKept = this->NeighboursOf(stays);
    std::vector<int> common;
    std::set_intersection(
      ofGone.begin(), ofGone.end(), ofKept.begin(), ofKept.end(), std::back_inserter(common));
    if (common.size() != both.size())
    {
      return false;
    }
    return std::all_of(both.begin(), both.end(),
      [&](int t)
      {
        const Vertex& opposite = this->Vertices[At(Opposite(this->Triangles[At(t)], goes, stays))];
        return opposite.Triangles.size() > (opposite.OnRim ? 1U : 3U);
      });
  }
  bool Collapse(int a, int b)
  {
    if (this->Vertices[At(a)].Free > this->Vertices[At(b)].Free)
    {
      std::swap(a, b);
    }
    const std::vector<int> both = this->TrianglesOf(a, b);
    if (!this->CanCollapse(a, b, both))
    {
      return false;
    }
    const Vertex& gone = this->Vertices[At(a)];
    const Vertex& kept = this->Vertices[At(b)];
    std::vector<ReferenceFoot> feet;
    const ReferenceFoot stays{ kept.Place, Eigen::Vector3d::Zero(), kept.Size, 0.0, -1 };
    if (gone.Free == kept.Free)
    {
      feet.push_back(this->FootOf(
        gone.Free, gone.Chain, this->Regions[At(both[0])], 0.5 * (gone.Place + kept.Place)));
      feet.push_back(stays);
      feet.push_back({ gone.Place, Eigen::Vector3d::Zero(), gone.Size, 0.0, -1 });
    }
    else
    {
      feet.push_back(stays);
    }
    return std::any_of(feet.begin(), feet.end(),
      [&](const ReferenceFoot& foot) { return this->CollapseTo(a, b, both, foot); });
  }
  bool CollapseTo(int a, int b, const std::vector<int>& both, const ReferenceFoot& foot)
  {
    const Eigen::Vector3d old = this->Place(b);
    const double oldSize = this->Vertices[At(b)].Size;
    const Eigen::Vector3d lost = this->Place(a);
    this->Vertices[At(b)].Place = foot.Place;
    this->Vertices[At(b)].Size = foot.Size;
    Worst before;
    Worst after;
    std::vector<std::pair<int, Shape>> shapes;
    double nearest = std::numeric_limits<double>::infinity(); // of what was at the point that goes
    bool allowed = true;
    for (const int end : { a, b })
    {
      for (const int t : this->Vertices[At(end)].Triangles)
      {
        before.Add(this->Shapes[At(t)]);
        if (!allowed || std::find(both.begin(), both.end(), t) != both.end())
        {
          continue;
        }
        const MeshTriangle corners = Replaced(this->Triangles[At(t)], a, b);
        for (const int corner : corners)
        {
          allowed = allowed && (corner == b || this->RatioOf(corner, b) <= LongEdge);
        }
        if (!allowed)
        {
          continue;
        }
        shapes.emplace_back(
          t, this->Measure(corners, this->Regions[At(t)], this->Shapes[At(t)].Hint, true));
        after.Add(shapes.back().second);
        nearest = std::min(nearest,
          ClosestOnTriangle<3>(this->Place(corners[0]).data(), this->Place(corners[1]).data(),
            this->Place(corners[2]).data(), lost.data())
            .SquaredDistance);
      }
    }
    if (!allowed || !this->IsAllowed(before, after) || std::sqrt(nearest) > this->Limit)
    {
      this->Vertices[At(b)].Place = old;
      this->Vertices[At(b)].Size = oldSize;
      return false;
    }
    this->Remove(a, b, both);
    for (const auto& [t, shape] : shapes)
    {
      this->Shapes[At(t)] = shape;
    }
    return true;
  }
  /// Point a and the triangles of the edge go.
  void Remove(int a, int b, const std::vector<int>& both)
  {
    for (const int t : both)
    {
      for (const int corner : this->Triangles[At(t)])
      {
        auto& around = this->Vertices[At(corner)].Triangles;
        around.erase(std::find(around.begin(), around.end(), t));
      }
      this->Triangles[At(t)] = { -1, -1, -1 };
    }
    Vertex& gone = this->Vertices[At(a)];
    Vertex& kept = this->Vertices[At(b)];
    for (const int t : gone.Triangles)
    {
      this->Triangles[At(t)] = Replaced(this->Triangles[At(t)], a, b);
      kept.Triangles.push_back(t);
    }
    const bool onChain = this->ChainOf(a, b) >= 0;
    if (onChain)
    {
      auto& links = kept.Links;
      links.erase(std::find_if(
        links.begin(), links.end(), [a](const Link& link) { return link.Other == a; }));
      for (const Link& link : gone.Links)
      {
        if (link.Other != b)
        {
          links.push_back(link);
          for (Link& back : this->Vertices[At(link.Other)].Links)
          {
            if (back.Other == a)
            {
              back.Other = b;
            }
          }
        }
      }
    }
    gone = Vertex();
  }

  // ----------------------------------------------------------------- turned edges

  /// @param byValence  where that brings numbers of neighbours nearer to what is best, too.
  void FlipEdges(bool byValence)
  {
    for (const Edge& edge : this->EdgesOf([](double) { return true; }))
    {
      this->Flip(edge.First, edge.Second, byValence);
    }
  }
  int Excess(int point) const
  {
    const Vertex& vertex = this->Vertices[At(point)];
    return static_cast<int>(vertex.Triangles.size()) + (vertex.OnRim ? 1 : 0) - vertex.Valence;
  }
  void Flip(int a, int b, bool byValence)
  {
    const std::vector<int> both = this->TrianglesOf(a, b);
    if (both.size() != 2 || this->ChainOf(a, b) >= 0)
    {
      return;
    }
    const int c = Opposite(this->Triangles[At(both[0])], a, b);
    const int d = Opposite(this->Triangles[At(both[1])], a, b);
    if (this->Vertices[At(a)].Triangles.size() <= (this->Vertices[At(a)].OnRim ? 1U : 3U) ||
      this->Vertices[At(b)].Triangles.size() <= (this->Vertices[At(b)].OnRim ? 1U : 3U) ||
      this->AreNeighbours(c, d))
    {
      return;
    }
    const auto squared = [](int x) { return x * x; };
    int gain = 0;
    for (const auto& [point, step] :
      { std::pair(a, -1), std::pair(b, -1), std::pair(c, 1), std::pair(d, 1) })
    {
      gain += squared(this->Excess(point)) - squared(this->Excess(point) + step);
    }
    if (byValence && gain < 0)
    {
      return;
    }
    // the first keeps a and gets d for b, the second keeps b and gets c for a
    const MeshTriangle first = Replaced(this->Triangles[At(both[0])], b, d);
    const MeshTriangle second = Replaced(this->Triangles[At(both[1])], a, c);
    Worst before;
    Worst after;
    Shape shapes[2];
    for (std::size_t i = 0; i < 2; ++i)
    {
      const Shape& old = this->Shapes[At(both[i])];
      before.Add(old);
      shapes[i] =
        this->Measure(i == 0 ? first : second, this->Regions[At(both[i])], old.Hint, true);
      after.Add(shapes[i]);
    }
    const bool isBetter = after.Quality > LeastGain * before.Quality;
    if (!this->IsAllowed(before, after) || !(isBetter || (byValence && gain > 0)))
    {
      return;
    }
    this->Triangles[At(both[0])] = first;
    this->Triangles[At(both[1])] = second;
    const auto erase = [&](int point, int triangle)
    {
      auto& around = this->Vertices[At(point)].Triangles;
      around.erase(std::find(around.begin(), around.end(), triangle));
    };
    erase(b, both[0]);
    erase(a, both[1]);
    this->Vertices[At(d)].Triangles.push_back(both[0]);
    this->Vertices[At(c)].Triangles.push_back(both[1]);
    this->Shapes[At(both[0])] = shapes[0];
    this->Shapes[At(both[1])] = shapes[1];
  }

  // ----------------------------------------------------------------- points

  /// Moves points between their neighbours, along the surface.
  void MovePoints(bool better)
  {
    for (int i = 0; i < static_cast<int>(this->Vertices.size()); ++i)
    {
      const Vertex& vertex = this->Vertices[At(i)];
      if (vertex.Triangles.empty() || vertex.Free == Freedom::Corner)
      {
        continue;
      }
      // neighbours pull with a strength that is equal when each is as far away as it should be
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weights = 0.0;
      const auto add = [&](int other)
      {
        const double weight = 1.0 / this->TargetOf(i, other);
        sum += weight * this->Place(other);
        weights += weight;
      };
      if (vertex.Free == Freedom::Chain)
      {
        for (const Link& link : vertex.Links)
        {
          add(link.Other);
        }
      }
      else
      {
        for (const int other : this->NeighboursOf(i))
        {
          add(other);
        }
      }
      const int region = this->Regions[At(vertex.Triangles[0])];
      const Eigen::Vector3d wish = sum / weights;
      const bool moved =
        this->Move(i, this->FootOf(vertex.Free, vertex.Chain, region, wish), better) ||
        this->Move(
          i, this->FootOf(vertex.Free, vertex.Chain, region, 0.5 * (wish + vertex.Place)), better);
      if (!moved && !vertex.OnSurface)
      {
        this->Move(i, this->FootOf(vertex.Free, vertex.Chain, region, vertex.Place), false);
      }
    }
  }

  ReferenceSurface Reference;
  double Limit;
  std::vector<Vertex> Vertices;
  std::vector<MeshTriangle> Triangles; ///< -1: taken away
  std::vector<int> Regions;
  std::vector<Shape> Shapes;
};

RemeshedPart Loop::Take() const
{
  RemeshedPart part;
  std::vector<int> numbers(this->Vertices.size(), -1);
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    const Vertex& vertex = this->Vertices[i];
    if (vertex.Triangles.empty())
    {
      continue;
    }
    numbers[i] = static_cast<int>(part.Points.size());
    if (vertex.Free == Freedom::Corner)
    {
      part.Corners.push_back(numbers[i]);
    }
    part.Points.push_back(vertex.Place);
    part.Sizes.push_back(vertex.Size);
  }
  for (std::size_t i = 0; i < this->Vertices.size(); ++i)
  {
    for (const Link& link : this->Vertices[i].Links)
    {
      if (static_cast<int>(i) < link.Other)
      {
        part.Lines.push_back({ numbers[i], numbers[At(link.Other)] });
        part.LineChains.push_back(link.Chain);
      }
    }
  }
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    const auto& [a, b, c] = this->Triangles[t];
    if (a >= 0)
    {
      part.Triangles.push_back({ numbers[At(a)], numbers[At(b)], numbers[At(c)] });
      part.Regions.push_back(this->Regions[t]);
      part.TriangleIds.push_back(
        this->Reference.TriangleOf(this->Regions[t], this->Shapes[t].Hint));
    }
  }
  return part;
}
}

bool RemeshPart(const DiscMesh& surface, const MeshFeatures& features,
  const std::vector<double>& sizes, double limit, int iterations,
  const std::function<bool(double)>& goesOn, RemeshedPart& part)
{
  Loop loop(surface, features, sizes, limit);
  if (!loop.Run(iterations, goesOn))
  {
    return false;
  }
  part = loop.Take();
  return true;
}
}
