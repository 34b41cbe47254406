// SPDX-License-Identifier: BSD-3-Clause
#include "SideSeparation.h"

#include "PlaneJacobian.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <memory>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector3d;
constexpr double UnitRoundoff = 0x1p-53;
/// Halvings of a piece a direction at most.
constexpr int DepthPerDirection = 34;
constexpr double EdgeEpsilon = 0x1p-44;

/// A piece of a side with what the tests need, and its halves once it was bisected.
struct Node
{
  CellPiece Piece;
  PieceHull Hull;
  double Size = 0.0;    ///< largest extent
  double Largest = 0.0; ///< largest coordinate
  int Children[2] = { -1, -1 };
};

struct Relation
{
  enum Kind
  {
    None,
    Same,
    Corner,
    Edge,
    Mixed
  } What = None;
  int A = -1;
  int B = -1;
  bool Reversed = false;
  /// Mixed: both have a part of an edge in common that is longer in one of them (0 or 1), and that
  /// edge of it. Cut to the common part, it is one edge.
  int Longer = -1;
  int LongerEdge = -1;
};

/// Range of a linear functional.
struct Range
{
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();
  void Add(double x)
  {
    this->Low = std::min(this->Low, x);
    this->High = std::max(this->High, x);
  }
  void Widen(double by)
  {
    this->Low -= by;
    this->High += by;
  }
  double Size() const { return std::max(std::abs(this->Low), std::abs(this->High)); }
};

double OneNorm(const Vector& d)
{
  return d.cwiseAbs().sum();
}

/// The two sides of one proof and the pieces made of them.
class Prover
{
public:
  Prover(const SeparationInput& input, int a, int b) : Input(input), SideA(a), SideB(b)
  {
    const auto& sides = *input.Sides;
    this->Contacts = FindContacts(sides, a, b);
    for (int k = 0; k < (a == b ? 1 : 2); ++k)
    {
      const BoundarySide& side = sides[static_cast<std::size_t>(k == 0 ? a : b)];
      this->Lattice[k] = &input.Lattices->at({ static_cast<int>(side.Frame.Shape), side.Degree });
      this->Pool[k].push_back(this->MakeNode(
        k, MakePiece(*this->Lattice[k], this->NumPlanes(), side.Data.data(), side.Error)));
    }
    if (a == b)
    {
      this->Lattice[1] = this->Lattice[0];
    }
    this->Which[1] = a == b ? 0 : 1;
  }

  SeparationResult Run(std::int64_t maxBoxes)
  {
    SeparationResult result;
    std::vector<std::array<int, 2>> open{ { 0, 0 } };
    const int largestDepth = DepthPerDirection * NumParameters(this->Lattice[0]->Shape);
    while (!open.empty())
    {
      const std::array<int, 2> pair = open.back();
      open.pop_back();
      if (++result.Boxes > maxBoxes)
      {
        result.State = SeparationState::Boxes;
        this->SetPlace(result, pair);
        return result;
      }
      const bool same = this->SideA == this->SideB && pair[0] == pair[1];
      const Node& a = this->NodeOf(0, pair[0]);
      const Node& b = this->NodeOf(1, pair[1]);
      Relation relation;
      if (same)
      {
        relation.What = this->Contacts.empty() ? Relation::Same : Relation::Mixed;
        if (!this->Contacts.empty() &&
          this->OwnContacts(a.Piece, a.Piece, true).What == Relation::None)
        {
          relation.What = Relation::Same;
        }
      }
      else
      {
        if (!this->BoxesMeet(a, b))
        {
          continue;
        }
        relation = this->Relate(a.Piece, b.Piece);
      }
      if (this->IsSeparate(relation, a, b))
      {
        continue;
      }
      const bool tooSmall = std::max(a.Size, b.Size) <=
        64.0 * (a.Hull.Error + b.Hull.Error) + 64.0 * UnitRoundoff * std::max(a.Largest, b.Largest);
      const bool splitA =
        same || relation.Longer == 0 || (relation.Longer < 0 && this->IsFirstToCut(relation, a, b));
      const Node& larger = splitA ? a : b;
      if (tooSmall || larger.Piece.Depth >= largestDepth)
      {
        result.State = SeparationState::Stuck;
        this->SetPlace(result, pair);
        return result;
      }
      if (same)
      {
        const auto halves = this->Split(0, pair[0], -1, true);
        open.push_back({ halves[0], halves[1] });
        open.push_back({ halves[1], halves[1] });
        open.push_back({ halves[0], halves[0] });
      }
      else
      {
        const int k = splitA ? 0 : 1;
        const auto halves = this->Split(k, pair[static_cast<std::size_t>(k)], relation.LongerEdge,
          relation.What == Relation::Edge);
        for (const int half : { halves[1], halves[0] })
        {
          auto next = pair;
          next[static_cast<std::size_t>(k)] = half;
          open.push_back(next);
        }
      }
    }
    return result;
  }

private:
  int NumPlanes() const { return this->Input.NumComponents + (this->Input.Rational ? 1 : 0); }
  const Node& NodeOf(int k, int index) const
  {
    return *this->Pool[this->Which[k]][static_cast<std::size_t>(index)];
  }

  std::unique_ptr<Node> MakeNode(int k, CellPiece piece) const
  {
    auto node = std::make_unique<Node>();
    node->Piece = std::move(piece);
    this->Complete(*this->Lattice[k], *node);
    return node;
  }
  void Complete(const CellLattice& lattice, Node& node) const
  {
    node.Hull = MakeHull(lattice, this->Input.NumComponents, this->Input.Rational, node.Piece);
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
    {
      node.Size = std::max(node.Size, node.Hull.Upper[d] - node.Hull.Lower[d]);
      node.Largest =
        std::max({ node.Largest, std::abs(node.Hull.Lower[d]), std::abs(node.Hull.Upper[d]) });
    }
  }

  /// Of two pieces the one whose normals turn more, if that is what is in the way, else the larger.
  bool IsFirstToCut(const Relation& relation, const Node& a, const Node& b) const
  {
    if (relation.What == Relation::Edge)
    {
      constexpr double muchLarger = 16.0;
      const double turnA = this->FindTurn(*this->Lattice[0], a).Size;
      const double turnB = this->FindTurn(*this->Lattice[1], b).Size;
      if (turnA > 2.0 * turnB && b.Size < muchLarger * a.Size)
      {
        return true;
      }
      if (turnB > 2.0 * turnA && a.Size < muchLarger * b.Size)
      {
        return false;
      }
    }
    return a.Size > b.Size || (a.Size == b.Size && a.Piece.Depth <= b.Piece.Depth);
  }

  /// Halves that are there already stay.
  /// @param edge  of the piece that is cut through, or -1.
  /// @param turns  it is the piece's normals that are in the way.
  std::array<int, 2> Split(int k, int index, int edge, bool turns)
  {
    auto& pool = this->Pool[this->Which[k]];
    Node& node = *pool[static_cast<std::size_t>(index)];
    if (node.Children[0] < 0)
    {
      const CellLattice& lattice = *this->Lattice[k];
      int direction = edge >= 0 ? DirectionOf(lattice, edge)
        : turns                 ? this->FindTurn(lattice, node).Direction
                                : -1;
      if (direction < 0)
      {
        direction = LongestDirection(lattice, node.Hull);
      }
      auto halves = Bisect(lattice, this->NumPlanes(), node.Piece, direction);
      for (int h = 0; h < 2; ++h)
      {
        node.Children[h] = static_cast<int>(pool.size());
        pool.push_back(this->MakeNode(k, std::move(halves[static_cast<std::size_t>(h)])));
      }
    }
    return { node.Children[0], node.Children[1] };
  }

  struct Turn
  {
    int Direction = -1;
    double Size = 0.1;
  };
  /// The direction in which the normals at the corners turn most, or -1 where they are nearly one.
  /// A face that turns in a narrow strip is cut along the strip, however long that is. Triangles
  /// are best kept equilateral.
  Turn FindTurn(const CellLattice& lattice, const Node& node) const
  {
    if (lattice.Shape != CellShape::Quadrilateral)
    {
      return {};
    }
    std::array<Vector, 4> normals;
    for (int c = 0; c < NumCorners(lattice.Shape); ++c)
    {
      std::array<Vector, 2> slopes{ Vector::Zero(), Vector::Zero() };
      int found = 0;
      for (const auto& direction : lattice.Directions)
      {
        for (const auto& line : direction.Lines)
        {
          const int corner = lattice.Corners[static_cast<std::size_t>(c)];
          const bool first = line.front() == corner;
          if (found < 2 && (first || line.back() == corner))
          {
            const int next = first ? line[1] : line[line.size() - 2];
            if (!this->IsOnePoint(node, next, corner))
            {
              slopes[static_cast<std::size_t>(found)] =
                (first ? 1.0 : -1.0) * (this->PointOf(node, next) - this->PointOf(node, corner));
            }
            ++found;
          }
        }
      }
      normals[static_cast<std::size_t>(c)] = slopes[0].cross(slopes[1]).stableNormalized();
    }
    Turn most;
    for (std::size_t d = 0; d < lattice.Directions.size(); ++d)
    {
      double turn = 0.0;
      for (const auto& pair : lattice.Directions[d].CornerPairs)
      {
        const Vector& from = normals[static_cast<std::size_t>(pair[0])];
        const Vector& to = normals[static_cast<std::size_t>(pair[1])];
        // none at a pole, and where the piece stands still
        if (!from.isZero() && !to.isZero())
        {
          turn = std::max(turn, (from - to).norm());
        }
      }
      if (turn > most.Size)
      {
        most = { static_cast<int>(d), turn };
      }
    }
    return most;
  }

  static int DirectionOf(const CellLattice& lattice, int edge)
  {
    const auto ends = SideEdge(lattice.Shape, edge);
    for (std::size_t d = 0; d < lattice.Directions.size(); ++d)
    {
      for (const auto& pair : lattice.Directions[d].CornerPairs)
      {
        if ((pair[0] == ends[0] && pair[1] == ends[1]) ||
          (pair[0] == ends[1] && pair[1] == ends[0]))
        {
          return static_cast<int>(d);
        }
      }
    }
    return 0;
  }

  void SetPlace(SeparationResult& result, const std::array<int, 2>& pair) const
  {
    for (int k = 0; k < 2; ++k)
    {
      const std::size_t at = static_cast<std::size_t>(k);
      const Node& node = this->NodeOf(k, pair[at]);
      const int corners = NumCorners(this->Lattice[k]->Shape);
      for (std::size_t d = 0; d < 2; ++d)
      {
        double sum = 0.0;
        for (int c = 0; c < corners; ++c)
        {
          sum += node.Piece.Corners[static_cast<std::size_t>(c)][d];
        }
        result.At[at][d] = sum / corners;
      }
    }
  }

  bool BoxesMeet(const Node& a, const Node& b) const
  {
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
    {
      if (a.Hull.Upper[d] < b.Hull.Lower[d] || b.Hull.Upper[d] < a.Hull.Lower[d])
      {
        return false;
      }
    }
    return true;
  }

  // ---- what two pieces share --------------------------------------------------------------

  struct Shared
  {
    Relation::Kind What;
    int A;
    int B;
    bool Reversed;
    double Ratio = 1.0; ///< of the lengths of the edges that have a part in common
  };

  /// A piece on an edge of its side: the part of the edge, by the piece's corners.
  struct OnEdge
  {
    bool IsSegment = false;
    int Edge = -1; ///< of the piece
    double Low = 0.0;
    double High = 0.0;
    bool Forward = true; ///< the piece's edge runs with the parameter
    int LowCorner = -1;
    int HighCorner = -1;
  };
  static std::vector<OnEdge> FindOnEdge(CellShape shape, const CellPiece& piece, int edge)
  {
    std::vector<OnEdge> found;
    double t[4];
    const int corners = NumCorners(shape);
    for (int c = 0; c < corners; ++c)
    {
      t[c] = EdgeParameter(shape, edge, piece.Corners[static_cast<std::size_t>(c)]);
    }
    for (int e = 0; e < NumSideEdges(shape); ++e)
    {
      const auto ends = SideEdge(shape, e);
      if (t[ends[0]] >= 0.0 && t[ends[1]] >= 0.0 && t[ends[0]] != t[ends[1]])
      {
        OnEdge on;
        on.IsSegment = true;
        on.Edge = e;
        on.Forward = t[ends[0]] < t[ends[1]];
        on.LowCorner = on.Forward ? ends[0] : ends[1];
        on.HighCorner = on.Forward ? ends[1] : ends[0];
        on.Low = t[on.LowCorner];
        on.High = t[on.HighCorner];
        return { on };
      }
    }
    for (int c = 0; c < corners; ++c)
    {
      if (t[c] >= 0.0)
      {
        OnEdge on;
        on.Low = on.High = t[c];
        on.LowCorner = on.HighCorner = c;
        found.push_back(on);
      }
    }
    return found;
  }

  /// The first corner of a piece on a collapsed edge of its side that also holds the given one: all
  /// of them are one point. Otherwise the corner itself.
  int FirstOnPole(int k, const CellPiece& piece, int corner) const
  {
    const BoundarySide& side = this->SideOf(k);
    const CellShape shape = side.Frame.Shape;
    for (int e = 0; e < NumSideEdges(shape); ++e)
    {
      if (!side.CollapsedEdges[static_cast<std::size_t>(e)] ||
        EdgeParameter(shape, e, piece.Corners[static_cast<std::size_t>(corner)]) < 0.0)
      {
        continue;
      }
      for (int c = 0; c < corner; ++c)
      {
        if (EdgeParameter(shape, e, piece.Corners[static_cast<std::size_t>(c)]) >= 0.0)
        {
          return c;
        }
      }
    }
    return corner;
  }

  const BoundarySide& SideOf(int k) const
  {
    return (*this->Input.Sides)[static_cast<std::size_t>(k == 0 ? this->SideA : this->SideB)];
  }

  /// Whether a piece has a corner of its side, or a point of a collapsed edge that is that corner.
  bool HasCorner(int k, const CellPiece& piece, int sideCorner, int& corner) const
  {
    const BoundarySide& side = this->SideOf(k);
    const CellShape shape = side.Frame.Shape;
    const auto u = CornerParameters(shape, sideCorner);
    for (int c = 0; c < NumCorners(shape); ++c)
    {
      const auto& v = piece.Corners[static_cast<std::size_t>(c)];
      bool is = v == u;
      for (int e = 0; e < NumSideEdges(shape) && !is; ++e)
      {
        is = side.CollapsedEdges[static_cast<std::size_t>(e)] &&
          EdgeParameter(shape, e, u) >= 0.0 && EdgeParameter(shape, e, v) >= 0.0;
      }
      if (is)
      {
        corner = this->FirstOnPole(k, piece, c);
        return true;
      }
    }
    return false;
  }

  void AddContacts(const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const
  {
    const CellShape shapeA = this->Lattice[0]->Shape;
    const CellShape shapeB = this->Lattice[1]->Shape;
    for (const SideContact& contact : this->Contacts)
    {
      if (!contact.IsEdge)
      {
        int ca = -1;
        int cb = -1;
        if (this->HasCorner(0, a, contact.A, ca) && this->HasCorner(1, b, contact.B, cb))
        {
          shared.push_back({ Relation::Corner, ca, cb, false });
        }
        continue;
      }
      const double scale = (contact.A1 - contact.A0) / (contact.B1 - contact.B0);
      for (OnEdge p : FindOnEdge(shapeA, a, contact.A))
      {
        for (OnEdge q : FindOnEdge(shapeB, b, contact.B))
        {
          q.Low = contact.A0 + (q.Low - contact.B0) * scale;
          q.High = contact.A0 + (q.High - contact.B0) * scale;
          if (q.Low > q.High)
          {
            std::swap(q.Low, q.High);
            std::swap(q.LowCorner, q.HighCorner);
            q.Forward = !q.Forward;
          }
          const double low = std::max({ p.Low, q.Low, std::min(contact.A0, contact.A1) });
          const double high = std::min({ p.High, q.High, std::max(contact.A0, contact.A1) });
          if (high - low > EdgeEpsilon)
          {
            const bool equal =
              std::abs(p.Low - q.Low) <= EdgeEpsilon && std::abs(p.High - q.High) <= EdgeEpsilon;
            shared.push_back({ equal ? Relation::Edge : Relation::Mixed, p.Edge, q.Edge,
              p.Forward != q.Forward, equal ? 1.0 : (p.High - p.Low) / (q.High - q.Low) });
          }
          else if (high - low >= -EdgeEpsilon)
          {
            const double at = 0.5 * (low + high);
            const auto cornerAt = [&](const OnEdge& on)
            {
              return std::abs(on.Low - at) <= EdgeEpsilon ? on.LowCorner
                : std::abs(on.High - at) <= EdgeEpsilon   ? on.HighCorner
                                                          : -1;
            };
            const int ca = cornerAt(p);
            const int cb = cornerAt(q);
            shared.push_back({ ca >= 0 && cb >= 0 ? Relation::Corner : Relation::Mixed,
              ca >= 0 ? this->FirstOnPole(0, a, ca) : -1,
              cb >= 0 ? this->FirstOnPole(1, b, cb) : -1, false });
          }
        }
      }
    }
  }

  static bool EdgeOnPole(
    const BoundarySide& side, const std::array<double, 3>& p, const std::array<double, 3>& q)
  {
    for (int e = 0; e < NumSideEdges(side.Frame.Shape); ++e)
    {
      if (side.CollapsedEdges[static_cast<std::size_t>(e)] &&
        EdgeParameter(side.Frame.Shape, e, p) >= 0.0 &&
        EdgeParameter(side.Frame.Shape, e, q) >= 0.0)
      {
        return true;
      }
    }
    return false;
  }

  /// Pieces of one side by their place in its parameters. Bisection keeps them convex, and apart
  /// but for their boundary.
  void AddNeighbours(const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const
  {
    const CellShape shape = this->Lattice[0]->Shape;
    const int corners = NumCorners(shape);
    const auto& p = a.Corners;
    const auto& q = b.Corners;
    for (int i = 0; i < corners; ++i)
    {
      for (int j = 0; j < corners; ++j)
      {
        if (p[static_cast<std::size_t>(i)] == q[static_cast<std::size_t>(j)])
        {
          shared.push_back(
            { Relation::Corner, this->FirstOnPole(0, a, i), this->FirstOnPole(1, b, j), false });
        }
      }
    }
    for (int e = 0; e < NumSideEdges(shape); ++e)
    {
      if (this->SideOf(0).CollapsedEdges[static_cast<std::size_t>(e)])
      {
        const auto onA = FindOnEdge(shape, a, e);
        const auto onB = FindOnEdge(shape, b, e);
        if (!onA.empty() && !onB.empty())
        {
          shared.push_back({ Relation::Corner, this->FirstOnPole(0, a, onA[0].LowCorner),
            this->FirstOnPole(1, b, onB[0].LowCorner), false });
        }
      }
    }
    for (int i = 0; i < NumSideEdges(shape); ++i)
    {
      const auto ei = SideEdge(shape, i);
      const auto& p0 = p[static_cast<std::size_t>(ei[0])];
      const auto& p1 = p[static_cast<std::size_t>(ei[1])];
      const double dx = p1[0] - p0[0];
      const double dy = p1[1] - p0[1];
      const double square = dx * dx + dy * dy;
      for (int j = 0; j < NumSideEdges(shape); ++j)
      {
        const auto ej = SideEdge(shape, j);
        const auto& q0 = q[static_cast<std::size_t>(ej[0])];
        const auto& q1 = q[static_cast<std::size_t>(ej[1])];
        // exact: dyadic numbers of few bits
        if (dx * (q0[1] - p0[1]) != dy * (q0[0] - p0[0]) ||
          dx * (q1[1] - p0[1]) != dy * (q1[0] - p0[0]))
        {
          continue;
        }
        const double t0 = (dx * (q0[0] - p0[0]) + dy * (q0[1] - p0[1])) / square;
        const double t1 = (dx * (q1[0] - p0[0]) + dy * (q1[1] - p0[1])) / square;
        const bool isPole = EdgeOnPole(this->SideOf(0), p0, p1);
        if (!isPole && std::min(1.0, std::max(t0, t1)) > std::max(0.0, std::min(t0, t1)))
        {
          const bool forward = p0 == q0 && p1 == q1;
          const bool backward = p0 == q1 && p1 == q0;
          shared.push_back({ forward || backward ? Relation::Edge : Relation::Mixed, i, j, backward,
            1.0 / std::abs(t1 - t0) });
        }
      }
    }
    // a corner of one within an edge of the other, without a common part of edges
    const auto within = [&](const CellPiece& x, const CellPiece& y)
    {
      for (int i = 0; i < corners; ++i)
      {
        const auto& c = x.Corners[static_cast<std::size_t>(i)];
        for (int j = 0; j < NumSideEdges(shape); ++j)
        {
          const auto e = SideEdge(shape, j);
          const auto& y0 = y.Corners[static_cast<std::size_t>(e[0])];
          const auto& y1 = y.Corners[static_cast<std::size_t>(e[1])];
          const double dx = y1[0] - y0[0];
          const double dy = y1[1] - y0[1];
          const double dot = dx * (c[0] - y0[0]) + dy * (c[1] - y0[1]);
          if (dx * (c[1] - y0[1]) == dy * (c[0] - y0[0]) && dot > 0.0 && dot < dx * dx + dy * dy)
          {
            shared.push_back({ Relation::Mixed, -1, -1, false });
          }
        }
      }
    };
    if (std::none_of(
          shared.begin(), shared.end(), [](const Shared& s) { return s.What == Relation::Edge; }))
    {
      within(a, b);
      within(b, a);
    }
  }

  Relation Reduce(const CellPiece& a, const CellPiece& b, const std::vector<Shared>& shared) const
  {
    Relation relation;
    for (const Shared& s : shared)
    {
      if (s.What == Relation::Mixed)
      {
        relation = {};
        relation.What = Relation::Mixed;
        relation.Longer = s.Ratio > 1.5 ? 0 : s.Ratio < 0.75 ? 1 : -1;
        relation.LongerEdge = relation.Longer == 1 ? s.B : s.A;
        return relation;
      }
      if (s.What == Relation::Edge)
      {
        if (relation.What == Relation::Edge && (relation.A != s.A || relation.B != s.B))
        {
          relation.What = Relation::Mixed;
          return relation;
        }
        relation = { Relation::Edge, s.A, s.B, s.Reversed, -1, -1 };
      }
    }
    if (relation.What == Relation::Edge)
    {
      const auto ea = SideEdge(this->Lattice[0]->Shape, relation.A);
      const auto eb = SideEdge(this->Lattice[1]->Shape, relation.B);
      for (const Shared& s : shared)
      {
        if (s.What == Relation::Corner)
        {
          const auto isEnd = [&](int i)
          {
            return s.A == this->FirstOnPole(0, a, ea[static_cast<std::size_t>(i)]) &&
              s.B ==
              this->FirstOnPole(1, b, eb[static_cast<std::size_t>(relation.Reversed ? 1 - i : i)]);
          };
          if (!isEnd(0) && !isEnd(1))
          {
            relation.What = Relation::Mixed;
            return relation;
          }
        }
      }
      return relation;
    }
    for (const Shared& s : shared)
    {
      if (relation.What == Relation::None)
      {
        relation = { Relation::Corner, s.A, s.B, false, -1, -1 };
      }
      else if (relation.A != s.A || relation.B != s.B)
      {
        relation.What = Relation::Mixed;
        return relation;
      }
    }
    return relation;
  }

  Relation OwnContacts(const CellPiece& a, const CellPiece& b, bool contactsOnly) const
  {
    std::vector<Shared> shared;
    this->AddContacts(a, b, shared);
    if (!contactsOnly)
    {
      this->AddNeighbours(a, b, shared);
    }
    return this->Reduce(a, b, shared);
  }

  Relation Relate(const CellPiece& a, const CellPiece& b) const
  {
    return this->OwnContacts(a, b, this->SideA != this->SideB);
  }

  // ---- tests -----------------------------------------------------------------------------

  Vector PointOf(const Node& node, int i) const
  {
    Vector x = Vector::Zero();
    const double* p = node.Hull.Point(i);
    for (int d = 0; d < this->Input.NumComponents; ++d)
    {
      x[d] = p[d];
    }
    return x;
  }

  bool IsSeparate(const Relation& relation, const Node& a, const Node& b) const
  {
    if (!std::isfinite(a.Hull.Error) || !std::isfinite(b.Hull.Error))
    {
      return false;
    }
    switch (relation.What)
    {
      case Relation::None:
        return this->HullsApart(a, b);
      case Relation::Corner:
        return this->ConesApart(relation, a, b);
      case Relation::Same:
        return this->HasChart(a);
      case Relation::Edge:
        return this->HaveChart(relation, a, b);
      case Relation::Mixed:
        break;
    }
    return false;
  }

  /// The point of the hull of at most four points that is nearest to the origin; keeps only the
  /// points it is a combination of.
  static Vector NearestInSimplex(std::vector<Vector>& simplex)
  {
    const std::size_t n = simplex.size();
    std::vector<Vector> best;
    Vector nearest = Vector::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (unsigned subset = 1; subset < (1u << n); ++subset)
    {
      std::vector<Vector> chosen;
      for (std::size_t i = 0; i < n; ++i)
      {
        if (subset & (1u << i))
        {
          chosen.push_back(simplex[i]);
        }
      }
      const int m = static_cast<int>(chosen.size());
      // p0 + E t, t >= 0, sum t <= 1
      Vector point = chosen[0];
      bool inside = true;
      if (m > 1)
      {
        Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, m - 1);
        for (int i = 1; i < m; ++i)
        {
          edges.col(i - 1) = chosen[static_cast<std::size_t>(i)] - chosen[0];
        }
        const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> t =
          edges.colPivHouseholderQr().solve(-chosen[0]);
        inside = t.allFinite() && t.minCoeff() >= 0.0 && t.sum() <= 1.0;
        point += edges * t;
      }
      if (inside && point.squaredNorm() < least)
      {
        least = point.squaredNorm();
        nearest = point;
        best = std::move(chosen);
      }
    }
    simplex = std::move(best);
    return nearest;
  }

  /// A direction in which all of a convex hull lies, if it does not hold the origin: the nearest
  /// point of simplices that grow towards the origin. What it finds is checked by the callers.
  /// @source  Gilbert, Johnson, Keerthi, IEEE J. Robotics and Automation 4 (1988) 193-203.
  template <typename Support>
  static bool FindDirection(const Vector& start, Support&& support, Vector& direction)
  {
    Vector v = start;
    std::vector<Vector> simplex;
    for (int step = 0; step < 24; ++step)
    {
      const Vector w = support(v);
      if (v.dot(w) > 0.0)
      {
        direction = v;
        // a few more steps widen the margin
        if (step > 3 || v.dot(w) > 0.5 * v.squaredNorm())
        {
          return true;
        }
      }
      if (simplex.size() == 4 || std::find(simplex.begin(), simplex.end(), w) != simplex.end())
      {
        return v.dot(w) > 0.0;
      }
      simplex.push_back(w);
      v = NearestInSimplex(simplex);
      if (simplex.empty() || !(v.squaredNorm() > 0.0))
      {
        return false;
      }
    }
    return false;
  }

  /// A piece seen from one of its corners.
  struct Cone
  {
    const CellLattice* Lattice;
    const Node* Piece;
    int Corner;
  };

  bool HullsApart(const Node& a, const Node& b) const
  {
    return this->HullsApart({ this->Lattice[0], &a, 0 }, { this->Lattice[1], &b, 0 });
  }
  bool HullsApart(const Cone& first, const Cone& second) const
  {
    const Node& a = *first.Piece;
    const Node& b = *second.Piece;
    const int na = first.Lattice->Size;
    const int nb = second.Lattice->Size;
    const double largest = std::max(a.Largest, b.Largest);
    const auto apart = [&](const Vector& d)
    {
      double high = -std::numeric_limits<double>::infinity();
      double low = std::numeric_limits<double>::infinity();
      for (int i = 0; i < na; ++i)
      {
        high = std::max(high, d.dot(this->PointOf(a, i)));
      }
      for (int i = 0; i < nb; ++i)
      {
        low = std::min(low, d.dot(this->PointOf(b, i)));
      }
      const double margin =
        OneNorm(d) * (a.Hull.Error + b.Hull.Error + 8.0 * UnitRoundoff * largest);
      return low - high > margin * (1.0 + 1e-9);
    };
    // across flat pieces first, then whatever the search finds
    for (const Node* node : { &a, &b })
    {
      const CellLattice& lattice = *(node == &a ? first : second).Lattice;
      const auto corner = [&](std::size_t c) { return this->PointOf(*node, lattice.Corners[c]); };
      const Vector x = corner(1) - corner(0);
      const Vector normal = lattice.Corners.size() == 2 ? Vector(-x[1], x[0], 0.0)
        : lattice.Corners.size() == 3
        ? Vector(x.cross(corner(2) - corner(0)))
        : Vector((corner(3) - corner(0)).cross(corner(2) - corner(1)));
      if (apart(normal) || apart(-normal))
      {
        return true;
      }
    }
    Vector start = Vector::Zero();
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
    {
      start[static_cast<Eigen::Index>(d)] =
        0.5 * (b.Hull.Lower[d] + b.Hull.Upper[d] - a.Hull.Lower[d] - a.Hull.Upper[d]);
    }
    Vector direction = Vector::Zero();
    const bool found = FindDirection(
      start,
      [&](const Vector& v)
      {
        Vector best[2];
        double low[2] = { std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::infinity() };
        for (int k = 0; k < 2; ++k)
        {
          const Node& node = k == 0 ? a : b;
          for (int i = 0; i < (k == 0 ? na : nb); ++i)
          {
            const Vector x = this->PointOf(node, i);
            const double at = k == 0 ? -v.dot(x) : v.dot(x);
            if (at < low[k])
            {
              low[k] = at;
              best[k] = x;
            }
          }
        }
        return Vector(best[1] - best[0]);
      },
      direction);
    return found && apart(direction);
  }

  bool ConesApart(const Relation& relation, const Node& a, const Node& b) const
  {
    return this->ConesApart(
      { { { this->Lattice[0], &a, relation.A }, { this->Lattice[1], &b, relation.B } } });
  }

  /// A plane through the common corner with one piece on either side: the pieces meet there only.
  bool ConesApart(const std::array<Cone, 2>& cones) const
  {
    const Node& a = *cones[0].Piece;
    const Node& b = *cones[1].Piece;
    const double largest = std::max(a.Largest, b.Largest);
    const double error = 2.0 * std::max(a.Hull.Error, b.Hull.Error) + 4.0 * UnitRoundoff * largest;
    std::vector<Vector> vectors;
    for (std::size_t k = 0; k < 2; ++k)
    {
      const Node& node = *cones[k].Piece;
      const CellLattice& lattice = *cones[k].Lattice;
      const int at = lattice.Corners[static_cast<std::size_t>(cones[k].Corner)];
      const Vector corner = this->PointOf(node, at);
      for (int i = 0; i < lattice.Size; ++i)
      {
        const Vector x = this->PointOf(node, i) - corner;
        // points of a collapsed edge are the corner itself
        const bool collapsed = i == at ||
          (this->Input.CollapseTolerance > 0.0 &&
            x.cwiseAbs().maxCoeff() <= std::min(node.Size * 1e-6, this->CollapseDistance(largest)));
        if (!collapsed)
        {
          vectors.push_back(k == 0 ? Vector(-x) : x);
        }
      }
    }
    if (vectors.empty())
    {
      return false;
    }
    Vector start = Vector::Zero();
    std::vector<Vector> units;
    for (const Vector& x : vectors)
    {
      const double length = x.norm();
      if (!(length > 0.0))
      {
        return false;
      }
      units.push_back(x / length);
      start += units.back() / static_cast<double>(vectors.size());
    }
    Vector direction = Vector::Zero();
    const bool found = FindDirection(
      start,
      [&](const Vector& v)
      {
        const Vector* best = nullptr;
        double low = std::numeric_limits<double>::infinity();
        for (const Vector& x : units)
        {
          const double at = v.dot(x);
          if (at < low)
          {
            low = at;
            best = &x;
          }
        }
        return *best;
      },
      direction);
    if (!found)
    {
      return false;
    }
    const double margin = OneNorm(direction) * error * (1.0 + 1e-9);
    return std::all_of(
      vectors.begin(), vectors.end(), [&](const Vector& x) { return direction.dot(x) > margin; });
  }

  /// Derivatives along a direction of a piece, from corner to corner, times the weight function:
  /// (N - c W)' - (S - c) W'. Any linear functional of them lies in the range of the differences,
  /// widened by what the second term and the rounding add.
  struct Slopes
  {
    std::vector<Vector> Differences;
    double WeightSlope = 0.0;
    double Rounding = 0.0; ///< of each coordinate
    const Node* Of = nullptr;
    Vector Mean = Vector::Zero();
  };
  Vector Centre(const Node& node) const
  {
    Vector c = Vector::Zero();
    for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
    {
      c[static_cast<Eigen::Index>(d)] = 0.5 * (node.Hull.Lower[d] + node.Hull.Upper[d]);
    }
    return c;
  }
  Slopes MakeSlopes(int k, const Node& node, int from, int to) const
  {
    return this->MakeSlopes(*this->Lattice[k], node, from, to);
  }
  Slopes MakeSlopes(const CellLattice& lattice, const Node& node, int from, int to) const
  {
    Slopes slopes;
    slopes.Of = &node;
    const Vector centre = this->Centre(node);
    const double* data = node.Piece.Data.data();
    const int n = lattice.Size;
    const int components = this->Input.NumComponents;
    const double* weights = this->Input.Rational ? data + components * n : nullptr;
    for (const auto& direction : lattice.Directions)
    {
      double sign = 0.0;
      for (const auto& pair : direction.CornerPairs)
      {
        sign = pair[0] == from && pair[1] == to ? 1.0
          : pair[1] == from && pair[0] == to    ? -1.0
                                                : sign;
      }
      if (sign == 0.0)
      {
        continue;
      }
      double largest = 0.0;
      for (const auto& line : direction.Lines)
      {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
        {
          const int a = line[i];
          const int b = line[i + 1];
          const double dw = weights ? weights[b] - weights[a] : 0.0;
          Vector x = Vector::Zero();
          for (int d = 0; d < components; ++d)
          {
            x[d] = sign * ((data[d * n + b] - data[d * n + a]) - centre[d] * dw);
            largest = std::max({ largest, std::abs(data[d * n + a]), std::abs(data[d * n + b]) });
          }
          slopes.Differences.push_back(x);
          slopes.Mean += x;
          slopes.WeightSlope = std::max(slopes.WeightSlope, std::abs(dw));
        }
      }
      slopes.Rounding =
        (weights ? 2.0 * node.Piece.Error * (1.0 + node.Largest) : 2.0 * node.Piece.Error) +
        8.0 * UnitRoundoff * (largest + (weights ? node.Largest * slopes.WeightSlope : 0.0));
      if (weights)
      {
        slopes.WeightSlope += 2.0 * node.Piece.Error + UnitRoundoff * slopes.WeightSlope;
      }
      slopes.Mean /= static_cast<double>(slopes.Differences.size());
      break;
    }
    return slopes;
  }
  Range RangeOf(const Vector& functional, const Slopes& slopes) const
  {
    Range range;
    double largest = 0.0;
    for (const Vector& x : slopes.Differences)
    {
      range.Add(functional.dot(x));
      largest = std::max(largest, x.cwiseAbs().maxCoeff());
    }
    double wide = OneNorm(functional) * (slopes.Rounding + 8.0 * UnitRoundoff * largest);
    if (slopes.WeightSlope > 0.0)
    {
      // S - c: half the box
      double reach = 0.0;
      for (std::size_t d = 0; d < static_cast<std::size_t>(this->Input.NumComponents); ++d)
      {
        reach += std::abs(functional[static_cast<Eigen::Index>(d)]) * 0.5 *
          (slopes.Of->Hull.Upper[d] - slopes.Of->Hull.Lower[d]);
      }
      wide += reach * slopes.WeightSlope;
    }
    range.Widen(wide * (1.0 + 1e-9));
    return range;
  }

  /// One piece: monotone after a linear projection, so one-to-one.
  bool HasChart(const Node& a) const
  {
    const CellShape shape = this->Lattice[0]->Shape;
    if (shape == CellShape::Curve)
    {
      return this->IsMonotoneCurve(a);
    }
    const Slopes s = this->MakeSlopes(0, a, 0, 1);
    const Slopes t = this->MakeSlopes(0, a, 0, 2);
    Eigen::Matrix<double, 3, 2> frame;
    frame << s.Mean, t.Mean;
    const Eigen::Matrix2d gram = frame.transpose() * frame;
    if (gram.determinant() > 0.0)
    {
      const Eigen::Matrix<double, 2, 3> dual = gram.inverse() * frame.transpose();
      const Vector alpha = dual.row(0);
      const Vector beta = dual.row(1);
      if (dual.allFinite() &&
        IsMonotone(this->RangeOf(alpha, s), this->RangeOf(alpha, t), this->RangeOf(beta, s),
          this->RangeOf(beta, t)))
      {
        return true;
      }
    }
    for (int e = 0; e < NumSideEdges(shape); ++e)
    {
      if (shape == CellShape::Quadrilateral && this->IsCollapsed(0, a, e))
      {
        const auto ends = SideEdge(shape, e);
        return this->HavePolarChart({ { this->Lattice[0], &a, ends[0], ends[1] } });
      }
    }
    return this->HaveOutline({ { 0, &a, -1, {} } });
  }

  /// A curve whose control points, projected to its chord, follow each other: it is one-to-one. The
  /// numerator of (f / w)' = (f' w - f w') / w^2 is a sum over i > k of non-negative Bernstein
  /// polynomials times (i - k) w_i w_k (x_i - x_k), x the projected points. Neighbours that are one
  /// point add nothing: the curve stands still at its end there, and goes on inside as long as some
  /// follow each other.
  bool IsMonotoneCurve(const Node& a) const
  {
    const int n = static_cast<int>(a.Hull.Points.size()) / a.Hull.NumComponents;
    const Vector along = this->PointOf(a, n - 1) - this->PointOf(a, 0);
    const double margin =
      OneNorm(along) * (2.0 * a.Hull.Error + 8.0 * UnitRoundoff * a.Largest) * (1.0 + 1e-9);
    bool moves = false;
    for (int i = 0; i + 1 < n; ++i)
    {
      if (this->IsOnePoint(a, i, i + 1))
      {
        continue;
      }
      if (!(along.dot(this->PointOf(a, i + 1) - this->PointOf(a, i)) > margin))
      {
        return false;
      }
      moves = true;
    }
    return moves;
  }

  /// @param largest  coordinate, of the moved sides.
  double CollapseDistance(double largest) const
  {
    return this->Input.CollapseTolerance * std::max(largest, this->Input.Distance);
  }

  /// Control points that rounding alone tells apart are one point.
  bool IsOnePoint(const Node& node, int i, int j) const
  {
    return this->Input.CollapseTolerance > 0.0 &&
      (this->PointOf(node, i) - this->PointOf(node, j)).cwiseAbs().maxCoeff() <=
      std::min(node.Size * 1e-6, this->CollapseDistance(node.Largest));
  }

  /// A map g of the plane with derivatives in these ranges is one-to-one on convex sets: after
  /// scaling one of its components its derivative has a positive definite symmetric part.
  static bool IsMonotone(const Range& ss, const Range& st, const Range& ts, const Range& tt)
  {
    return ss.Low > 0.0 && tt.Low > 0.0 && ss.Low * tt.Low > st.Size() * ts.Size() * (1.0 + 1e-9);
  }

  /// Two pieces with a common edge: one chart over both, the second unfolded to the other side.
  bool HaveChart(const Relation& relation, const Node& a, const Node& b) const
  {
    const CellShape shapes[2] = { this->Lattice[0]->Shape, this->Lattice[1]->Shape };
    std::array<int, 2> ends[2] = { SideEdge(shapes[0], relation.A),
      SideEdge(shapes[1], relation.B) };
    if (relation.Reversed)
    {
      std::swap(ends[1][0], ends[1][1]);
    }
    // the corner across from the edge's first one
    const auto across = [](CellShape shape, const std::array<int, 2>& edge)
    {
      return shape == CellShape::Triangle ? 3 - edge[0] - edge[1]
                                          : 3 - edge[1]; // opposite of the edge's second corner
    };
    const Slopes s[2] = { this->MakeSlopes(0, a, ends[0][0], ends[0][1]),
      this->MakeSlopes(1, b, ends[1][0], ends[1][1]) };
    const Slopes t[2] = { this->MakeSlopes(0, a, ends[0][0], across(shapes[0], ends[0])),
      this->MakeSlopes(1, b, ends[1][0], across(shapes[1], ends[1])) };
    const Vector along = s[0].Mean + s[1].Mean;
    const double square = along.squaredNorm();
    if (square > 0.0)
    {
      Vector away[2];
      double shear[2];
      for (int k = 0; k < 2; ++k)
      {
        shear[k] = along.dot(t[k].Mean) / square;
        away[k] = t[k].Mean - shear[k] * along;
      }
      const double na = away[0].norm();
      const double nb = away[1].norm();
      if (na > 0.0 && nb > 0.0)
      {
        const Vector beta = away[0] / na - away[1] / nb;
        const double ua = beta.dot(away[0]);
        const double ub = -beta.dot(away[1]);
        if (ua > 0.0 && ub > 0.0)
        {
          // alpha sees as little as possible of both shears
          const double gamma = -(shear[0] * ua - shear[1] * ub) / (ua * ua + ub * ub);
          const Vector alpha = along / square + gamma * beta;
          Range ss;
          Range st;
          Range ts;
          Range tt;
          const auto merge = [](Range& to, const Range& r, double sign)
          {
            to.Add(sign * r.Low);
            to.Add(sign * r.High);
          };
          for (int k = 0; k < 2; ++k)
          {
            const double sign = k == 0 ? 1.0 : -1.0;
            merge(ss, this->RangeOf(alpha, s[k]), 1.0);
            merge(ts, this->RangeOf(beta, s[k]), 1.0);
            merge(st, this->RangeOf(alpha, t[k]), sign);
            merge(tt, this->RangeOf(beta, t[k]), sign);
          }
          if (IsMonotone(ss, st, ts, tt))
          {
            return true;
          }
        }
      }
    }
    // Both may end in one point, where a collapsed edge meets the common one.
    const bool quadrilaterals =
      shapes[0] == CellShape::Quadrilateral && shapes[1] == CellShape::Quadrilateral;
    for (int end = 0; end < 2 && quadrilaterals; ++end)
    {
      int pole[2] = { -1, -1 };
      const Node* nodes[2] = { &a, &b };
      const int edges[2] = { relation.A, relation.B };
      for (int k = 0; k < 2; ++k)
      {
        for (int e = 0; e < 4; ++e)
        {
          const auto corners = SideEdge(shapes[k], e);
          if (e != edges[k] && (corners[0] == ends[k][end] || corners[1] == ends[k][end]) &&
            this->IsCollapsed(k, *nodes[k], e))
          {
            pole[k] = e;
          }
        }
      }
      const auto polar = [&](int k)
      {
        const auto corners = SideEdge(shapes[k], pole[k]);
        return PolarPiece{ this->Lattice[k], nodes[k], ends[k][end],
          corners[0] == ends[k][end] ? corners[1] : corners[0] };
      };
      if (pole[0] >= 0 && pole[1] >= 0)
      {
        return this->HavePolarChart({ polar(0), polar(1) });
      }
      if (pole[0] >= 0 || pole[1] >= 0)
      {
        // The other piece is regular there: cut along its diagonal, it is two with a collapsed
        // edge, one at the common edge, one that has the end alone in common.
        const int k = pole[0] >= 0 ? 0 : 1;
        const int apex = ends[1 - k][end];
        const int next = ends[1 - k][1 - end];
        const Half beside = this->MakeHalf(1 - k, *nodes[1 - k], apex, next);
        const Half rest = this->MakeHalf(1 - k, *nodes[1 - k], apex, 3 - next);
        const PolarPiece piece = polar(k);
        return this->HavePolarChart({ piece, { &beside.Lattice, &beside.Piece, 0, 1 } }) &&
          this->ConesApart(
            { { { piece.Lattice, piece.Piece, piece.From }, { &rest.Lattice, &rest.Piece, 0 } } });
      }
    }
    return this->HaveOutline({ { 0, &a, relation.A, ends[0] }, { 1, &b, relation.B, ends[1] } });
  }

  /// A piece of a disk that is projected to a plane.
  struct Facet
  {
    int K; ///< its side
    const Node* Piece;
    int Edge;                ///< that it shares with the other one, or -1
    std::array<int, 2> Ends; ///< corners of that edge, in an order that both have in common
  };

  /// One piece, or two with a common edge unfolded to one disk, are projected to a plane where
  /// - the Jacobian is positive inside of the pieces (it may vanish on their edges), and
  /// - the outline, the edges but the common one, is a simple closed curve.
  /// The degree of such a map of a disk is 1 inside of the outline's image and 0 outside, so almost
  /// every point has one preimage inside of the pieces at most. The map is open there, so no two
  /// points inside have one image, nor one inside and one on the outline, which is a limit of
  /// points inside; on the outline it is one-to-one. One piece is one-to-one so, and two meet in
  /// their common edge only. What holds of the projection holds of the pieces.
  bool HaveOutline(const std::vector<Facet>& facets) const
  {
    std::array<double, 2> orientation{ 1.0, 1.0 };
    Vector normal = Vector::Zero();
    for (std::size_t k = 0; k < facets.size(); ++k)
    {
      const Facet& facet = facets[k];
      if (facet.Edge >= 0)
      {
        // one piece on the left of the common edge, the other one on its right
        orientation[k] = (k == 0) == this->IsOnLeft(facet) ? 1.0 : -1.0;
      }
      const Vector n = this->NormalOf(facet);
      const double length = n.norm();
      if (!(length > 0.0))
      {
        return false;
      }
      normal += orientation[k] / length * n;
    }
    const double length = normal.norm();
    if (!(length > 0x1p-20))
    {
      return false;
    }
    normal /= length;
    Eigen::Index axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    const Vector alpha = normal.cross(Vector::Unit(axis)).normalized();
    const Vector beta = normal.cross(alpha);
    for (std::size_t k = 0; k < facets.size(); ++k)
    {
      if (!this->HasPositiveProjection(facets[k], alpha, beta, orientation[k]))
      {
        return false;
      }
    }
    return this->IsOutlineSimple(facets, alpha, beta);
  }

  bool IsOnLeft(const Facet& facet) const
  {
    const CellShape shape = this->Lattice[facet.K]->Shape;
    const auto from = CornerParameters(shape, facet.Ends[0]);
    const auto to = CornerParameters(shape, facet.Ends[1]);
    double sum = 0.0;
    for (int c = 0; c < NumCorners(shape); ++c)
    {
      const auto at = CornerParameters(shape, c);
      sum += (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0]);
    }
    return sum > 0.0;
  }

  Vector NormalOf(const Facet& facet) const
  {
    const CellLattice& lattice = *this->Lattice[facet.K];
    const auto corner = [&](std::size_t c)
    { return this->PointOf(*facet.Piece, lattice.Corners[c]); };
    return lattice.Corners.size() == 3
      ? Vector((corner(1) - corner(0)).cross(corner(2) - corner(0)))
      : Vector((corner(3) - corner(0)).cross(corner(2) - corner(1)));
  }

  bool HasPositiveProjection(
    const Facet& facet, const Vector& alpha, const Vector& beta, double orientation) const
  {
    const CellLattice& lattice = *this->Lattice[facet.K];
    const Node& node = *facet.Piece;
    const double* data = node.Piece.Data.data();
    const int n = lattice.Size;
    const std::size_t size = static_cast<std::size_t>(n);
    // relative to the middle and of size one, by a power of two
    const Vector centre = this->Centre(node);
    const double scale = std::ldexp(1.0, -std::ilogb(std::max(node.Size, 1e-280)));
    PlanePiece plane;
    plane.Shape = lattice.Shape;
    plane.Degree = lattice.Degree;
    plane.X.resize(size);
    plane.Y.resize(size);
    double largestWeight = 1.0;
    double largest = 0.0;
    if (this->Input.Rational)
    {
      plane.W.assign(data + 3 * n, data + 4 * n);
      plane.WeightError = node.Piece.Error;
      largestWeight = *std::max_element(plane.W.begin(), plane.W.end());
    }
    for (int i = 0; i < n; ++i)
    {
      const double w = this->Input.Rational ? plane.W[static_cast<std::size_t>(i)] : 1.0;
      Vector x;
      for (int d = 0; d < 3; ++d)
      {
        x[d] = data[d * n + i] - centre[d] * w;
        largest = std::max(largest, std::abs(data[d * n + i]));
      }
      plane.X[static_cast<std::size_t>(i)] = scale * alpha.dot(x);
      plane.Y[static_cast<std::size_t>(i)] = scale * beta.dot(x);
    }
    const double far = centre.cwiseAbs().maxCoeff();
    plane.Error = scale * std::max(OneNorm(alpha), OneNorm(beta)) *
      (node.Piece.Error * (this->Input.Rational ? 1.0 + far : 1.0) +
        8.0 * UnitRoundoff * (largest + far * largestWeight)) *
      (1.0 + 1e-9);
    if (!this->Input.Rational)
    {
      plane.SameNextS.assign(size, false);
      plane.SameNextT.assign(size, false);
      this->ForEachStep(lattice,
        [&](int i, int j, bool alongS)
        {
          auto& same = alongS ? plane.SameNextS : plane.SameNextT;
          same[static_cast<std::size_t>(i)] = this->IsOnePoint(node, i, j);
        });
    }
    return HasPositiveInside(plane, orientation);
  }

  /// Neighbours in the first and the second parameter of a surface.
  template <typename Function>
  static void ForEachStep(const CellLattice& lattice, const Function& function)
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      for (const auto& line : lattice.Directions[d].Lines)
      {
        for (std::size_t i = 0; i + 1 < line.size(); ++i)
        {
          function(line[i], line[i + 1], d == 0);
        }
      }
    }
  }

  /// An edge of a facet in the plane.
  struct OutlineEdge
  {
    CellLattice Lattice;
    Node Curve; ///< third coordinate 0
    std::array<int, 2> Corners{};
  };

  bool IsOutlineSimple(
    const std::vector<Facet>& facets, const Vector& alpha, const Vector& beta) const
  {
    Projection plane{ alpha, beta, this->Centre(*facets[0].Piece), 0.0 };
    for (const Facet& facet : facets)
    {
      plane.Largest = std::max(plane.Largest, facet.Piece->Largest);
    }
    std::vector<OutlineEdge> outline;
    for (std::size_t k = 0; k < facets.size(); ++k)
    {
      const CellShape shape = this->Lattice[facets[k].K]->Shape;
      for (int e = 0; e < NumSideEdges(shape); ++e)
      {
        if (e == facets[k].Edge)
        {
          continue;
        }
        OutlineEdge edge;
        if (!this->ProjectEdge(facets[k], e, plane, edge) || !this->IsMonotoneCurve(edge.Curve))
        {
          return false;
        }
        for (std::size_t end = 0; end < 2; ++end)
        {
          const int corner = SideEdge(shape, e)[end];
          // the second piece's corners on the common edge are the first one's
          edge.Corners[end] = k == 0      ? corner
            : corner == facets[1].Ends[0] ? facets[0].Ends[0]
            : corner == facets[1].Ends[1] ? facets[0].Ends[1]
                                          : 4 + corner;
        }
        outline.push_back(std::move(edge));
      }
    }
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
      for (std::size_t j = i + 1; j < outline.size(); ++j)
      {
        const OutlineEdge& a = outline[i];
        const OutlineEdge& b = outline[j];
        int shared = 0;
        std::array<Cone, 2> cones{ { { &a.Lattice, &a.Curve, 0 }, { &b.Lattice, &b.Curve, 0 } } };
        for (int p = 0; p < 2; ++p)
        {
          for (int q = 0; q < 2; ++q)
          {
            if (a.Corners[static_cast<std::size_t>(p)] == b.Corners[static_cast<std::size_t>(q)])
            {
              ++shared;
              cones[0].Corner = p;
              cones[1].Corner = q;
            }
          }
        }
        const bool apart = shared == 0
          ? this->HullsApart({ &a.Lattice, &a.Curve, 0 }, { &b.Lattice, &b.Curve, 0 })
          : shared == 1 && this->ConesApart(cones);
        if (!apart)
        {
          return false;
        }
      }
    }
    return true;
  }

  /// Coordinates in a plane, relative to a point beside the pieces, so that they are as small as
  /// those.
  struct Projection
  {
    Vector Alpha;
    Vector Beta;
    Vector Origin;
    double Largest; ///< coordinate of the pieces
  };

  /// @return false when points that are apart become one in the plane.
  bool ProjectEdge(const Facet& facet, int number, const Projection& plane, OutlineEdge& edge) const
  {
    const CellLattice& lattice = *this->Lattice[facet.K];
    const Node& node = *facet.Piece;
    const auto ends = SideEdge(lattice.Shape, number);
    const int first = lattice.Corners[static_cast<std::size_t>(ends[0])];
    const int last = lattice.Corners[static_cast<std::size_t>(ends[1])];
    std::vector<int> line;
    for (const auto& direction : lattice.Directions)
    {
      for (const auto& some : direction.Lines)
      {
        if (some.front() == first && some.back() == last)
        {
          line = some;
        }
        else if (some.front() == last && some.back() == first)
        {
          line.assign(some.rbegin(), some.rend());
        }
      }
    }
    if (line.empty())
    {
      return false;
    }
    const int degree = static_cast<int>(line.size()) - 1;
    edge.Lattice = CellLattice(CellShape::Curve, { degree, 0, 0 });
    PieceHull& hull = edge.Curve.Hull;
    hull.NumComponents = 3;
    hull.Error = std::max(OneNorm(plane.Alpha), OneNorm(plane.Beta)) *
      (node.Hull.Error + 8.0 * UnitRoundoff * plane.Largest) * (1.0 + 1e-9);
    hull.Lower.fill(std::numeric_limits<double>::infinity());
    hull.Upper.fill(-std::numeric_limits<double>::infinity());
    for (const int i : line)
    {
      const Vector x = this->PointOf(node, i) - plane.Origin;
      const Vector y(plane.Alpha.dot(x), plane.Beta.dot(x), 0.0);
      for (std::size_t d = 0; d < 3; ++d)
      {
        const double value = y[static_cast<Eigen::Index>(d)];
        hull.Points.push_back(value);
        hull.Lower[d] = std::min(hull.Lower[d], value - hull.Error);
        hull.Upper[d] = std::max(hull.Upper[d], value + hull.Error);
      }
    }
    edge.Curve.Size = std::max(hull.Upper[0] - hull.Lower[0], hull.Upper[1] - hull.Lower[1]);
    // tolerances are of the model's coordinates
    edge.Curve.Largest = plane.Largest;
    for (std::size_t i = 0; i < line.size(); ++i)
    {
      for (std::size_t j = i + 1; j < line.size(); ++j)
      {
        const int at[2] = { static_cast<int>(i), static_cast<int>(j) };
        const double distance =
          (this->PointOf(edge.Curve, at[0]) - this->PointOf(edge.Curve, at[1]))
            .cwiseAbs()
            .maxCoeff();
        if (distance <= 4.0 * this->CollapseDistance(plane.Largest) &&
          !this->IsOnePoint(node, line[i], line[j]))
        {
          return false;
        }
      }
    }
    return true;
  }

  bool IsCollapsed(int k, const Node& node, int edge) const
  {
    const CellLattice& lattice = *this->Lattice[k];
    const auto ends = SideEdge(lattice.Shape, edge);
    const double tolerance = std::min(node.Size * 1e-6, this->CollapseDistance(node.Largest));
    for (const auto& direction : lattice.Directions)
    {
      for (const auto& line : direction.Lines)
      {
        const int first = lattice.Corners[static_cast<std::size_t>(ends[0])];
        const int last = lattice.Corners[static_cast<std::size_t>(ends[1])];
        if ((line.front() == first && line.back() == last) ||
          (line.front() == last && line.back() == first))
        {
          return std::all_of(line.begin(), line.end(),
            [&](int i)
            {
              return (this->PointOf(node, i) - this->PointOf(node, first)).cwiseAbs().maxCoeff() <=
                tolerance;
            });
        }
      }
    }
    return false;
  }

  /// A quadrilateral whose edge t = 0 is one point P, seen with s from corner From to corner To of
  /// that edge. Of two such pieces the first corners are on their common edge.
  struct PolarPiece
  {
    const CellLattice* Lattice;
    const Node* Piece;
    int From;
    int To;
  };

  /// Half of a quadrilateral piece S.
  struct Half
  {
    CellLattice Lattice;
    Node Piece;
  };

  /// The half between the edge from the apex to the corner `along` and the diagonal, as the piece
  /// S(t, s t): s from that edge to the diagonal, t from the apex, which is the edge t = 0.
  /// Coefficients are means of those of S: B_j^q(s t) = sum over m of B_m^q(t) times the polynomial
  /// with the coefficients C(m, j) C(q - m, a - j) / C(q, a).
  Half MakeHalf(int k, const Node& node, int apex, int along) const
  {
    const CellLattice& lattice = *this->Lattice[k];
    const std::size_t ud = (apex ^ along) == 1 ? 0 : 1;
    const std::size_t vd = 1 - ud;
    const int p = lattice.Degree[ud];
    const int q = lattice.Degree[vd];
    Half half;
    half.Lattice = CellLattice(CellShape::Quadrilateral, { q, p + q, 0 });
    half.Piece.Piece.Data.resize(static_cast<std::size_t>(this->NumPlanes() * half.Lattice.Size));
    double largest = 0.0;
    for (int plane = 0; plane < this->NumPlanes(); ++plane)
    {
      const double* from = node.Piece.Data.data() + plane * lattice.Size;
      double* to = half.Piece.Piece.Data.data() + plane * half.Lattice.Size;
      const auto value = [&](int i, int j)
      {
        std::array<int, 2> at{};
        at[ud] = (apex >> ud & 1) == 0 ? i : p - i;
        at[vd] = (apex >> vd & 1) == 0 ? j : q - j;
        return from[CellCoefficient(lattice.Shape, lattice.Degree, at[0], at[1], 0)];
      };
      for (int n = 0; n <= p + q; ++n)
      {
        for (int a = 0; a <= q; ++a)
        {
          double sum = 0.0;
          for (int m = std::max(0, n - p); m <= std::min(n, q); ++m)
          {
            const double outer = Binomial(p, n - m) * Binomial(q, m) / Binomial(p + q, n);
            for (int j = std::max(0, a + m - q); j <= std::min(a, m); ++j)
            {
              const double inner = Binomial(m, j) * Binomial(q - m, a - j) / Binomial(q, a);
              sum += outer * inner * value(n - m, j);
            }
          }
          to[CellCoefficient(CellShape::Quadrilateral, half.Lattice.Degree, a, n, 0)] = sum;
        }
      }
      for (int i = 0; i < lattice.Size; ++i)
      {
        largest = std::max(largest, std::abs(from[i]));
      }
    }
    // a mean of at most (p + 1) (q + 1) values, its factors of six roundings each
    const double terms = (p + 1) * (q + 1) + 8;
    half.Piece.Piece.Error = 1.01 *
      (node.Piece.Error +
        terms * (UnitRoundoff * (largest + node.Piece.Error) + std::numeric_limits<double>::min()));
    this->Complete(half.Lattice, half.Piece);
    return half;
  }

  /// S - P = t R. The chart is (beta R / alpha R, alpha (S - P)): a projective one, regular at P.
  bool HavePolarChart(const std::vector<PolarPiece>& pieces) const
  {
    const bool rational = this->Input.Rational;
    const int components = this->Input.NumComponents;
    struct Blown
    {
      int P = 0;             ///< degree along s
      int Q = 0;             ///< of R along t
      std::vector<Vector> R; ///< homogeneous, s fastest
      double Error = 0.0;
    };
    std::vector<Blown> blown;
    Vector alpha = Vector::Zero();
    Vector turn = Vector::Zero();
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const PolarPiece& piece = pieces[k];
      const CellLattice& lattice = *piece.Lattice;
      const double* data = piece.Piece->Piece.Data.data();
      const int n = lattice.Size;
      const int pole = lattice.Corners[static_cast<std::size_t>(piece.From)];
      const Vector apex = this->PointOf(*piece.Piece, pole);
      // lattice steps along s and t
      const auto cornerIndex = [&](int corner, int d)
      { return ((corner >> d) & 1) * lattice.Degree[static_cast<std::size_t>(d)]; };
      const int sd = cornerIndex(piece.From, 0) != cornerIndex(piece.To, 0) ? 0 : 1;
      const int td = 1 - sd;
      Blown b;
      b.P = lattice.Degree[static_cast<std::size_t>(sd)];
      const int q = lattice.Degree[static_cast<std::size_t>(td)];
      b.Q = q - 1;
      double largest = 0.0;
      for (int j = 1; j <= q; ++j)
      {
        for (int i = 0; i <= b.P; ++i)
        {
          int at[2];
          at[sd] = cornerIndex(piece.From, sd) == 0 ? i : b.P - i;
          at[td] = cornerIndex(piece.From, td) == 0 ? j : q - j;
          const int c = CellCoefficient(lattice.Shape, lattice.Degree, at[0], at[1], 0);
          const double w = rational ? data[components * n + c] : 1.0;
          Vector x = Vector::Zero();
          for (int d = 0; d < components; ++d)
          {
            x[d] = (data[d * n + c] - apex[d] * w) * q / j;
            largest = std::max(largest, std::abs(data[d * n + c]) + std::abs(apex[d] * w));
          }
          b.R.push_back(x);
        }
      }
      // the collapsed edge is the point P up to the tolerance it was found with
      b.Error = q *
        (2.0 * piece.Piece->Piece.Error * (1.0 + piece.Piece->Largest) +
          2.0 * piece.Piece->Hull.Error + 8.0 * UnitRoundoff * largest);
      Vector mean = Vector::Zero();
      Vector slope = Vector::Zero();
      for (int j = 0; j <= b.Q; ++j)
      {
        for (int i = 0; i <= b.P; ++i)
        {
          mean += b.R[static_cast<std::size_t>(j * (b.P + 1) + i)];
        }
        slope += b.R[static_cast<std::size_t>(j * (b.P + 1) + b.P)] -
          b.R[static_cast<std::size_t>(j * (b.P + 1))];
      }
      alpha += mean / mean.norm();
      turn += (k == 0 ? 1.0 : -1.0) * slope / slope.norm();
      blown.push_back(std::move(b));
    }
    if (!alpha.allFinite() || !turn.allFinite() || !(alpha.norm() > 0.0))
    {
      return false;
    }
    alpha.normalize();
    const Vector beta0 = (turn - turn.dot(alpha) * alpha).normalized();
    if (!beta0.allFinite())
    {
      return false;
    }
    // the ratio at the middle is made zero
    Vector middle = Vector::Zero();
    for (const Blown& b : blown)
    {
      for (const Vector& x : b.R)
      {
        middle += x / static_cast<double>(b.R.size());
      }
    }
    const Vector beta = beta0 - beta0.dot(middle) / alpha.dot(middle) * alpha;

    double ss = std::numeric_limits<double>::infinity();
    double tt = ss;
    double st = 0.0;
    double ts = 0.0;
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const PolarPiece& piece = pieces[k];
      const Blown& b = blown[k];
      const CellLattice& lattice = *piece.Lattice;
      const double sign = k == 0 ? 1.0 : -1.0;
      const auto value = [&](const Vector& f, int i, int j)
      { return f.dot(b.R[static_cast<std::size_t>(j * (b.P + 1) + i)]); };
      const double ea = OneNorm(alpha) * b.Error;
      const double eb = OneNorm(beta) * b.Error;
      Range ar;
      double largest = 0.0;
      for (int j = 0; j <= b.Q; ++j)
      {
        for (int i = 0; i <= b.P; ++i)
        {
          ar.Add(value(alpha, i, j));
          largest =
            std::max({ largest, std::abs(value(alpha, i, j)), std::abs(value(beta, i, j)) });
        }
      }
      ar.Widen(ea + 4.0 * UnitRoundoff * largest);
      if (!(ar.Low > 0.0))
      {
        return false;
      }
      // (b/a)' = (a b' - b a') / a^2: a convex combination of the products of all coefficients,
      // with the degrees as factors
      const double error = 8.0 * (largest + ea + eb) * (ea + eb + 8.0 * UnitRoundoff * largest);
      Range crossS;
      Range crossT;
      crossT.Add(0.0);
      const auto addProducts = [&](Range& range, int i, int j, int di, int dj)
      {
        const double da = value(alpha, i + di, j + dj) - value(alpha, i, j);
        const double db = value(beta, i + di, j + dj) - value(beta, i, j);
        for (int l = 0; l <= b.Q; ++l)
        {
          for (int m = 0; m <= b.P; ++m)
          {
            range.Add(value(alpha, m, l) * db - value(beta, m, l) * da);
          }
        }
      };
      for (int j = 0; j <= b.Q; ++j)
      {
        for (int i = 0; i <= b.P; ++i)
        {
          if (i < b.P)
          {
            addProducts(crossS, i, j, 1, 0);
          }
          if (j < b.Q)
          {
            addProducts(crossT, i, j, 0, 1);
          }
        }
      }
      const double low = ((sign > 0.0 ? crossS.Low : -crossS.High) - error) * b.P;
      if (!(low > 0.0))
      {
        return false;
      }
      ss = std::min(ss, low / (ar.High * ar.High) * (1.0 - 1e-9));
      st = std::max(st, (crossT.Size() + error) * b.Q / (ar.Low * ar.Low) * (1.0 + 1e-9));
      // alpha (S - P) itself
      const int acrossS = piece.To;
      const int acrossT = 3 - acrossS; // of the edge's first corner, over to t = 1
      const Slopes slopesS = this->MakeSlopes(lattice, *piece.Piece, piece.From, piece.To);
      const Slopes slopesT = this->MakeSlopes(lattice, *piece.Piece, piece.From, acrossT);
      double lowWeight = 1.0;
      double highWeight = 1.0;
      if (rational)
      {
        const double* w = piece.Piece->Piece.Data.data() + components * lattice.Size;
        const auto [least, most] = std::minmax_element(w, w + lattice.Size);
        lowWeight = *least - piece.Piece->Piece.Error;
        highWeight = *most + piece.Piece->Piece.Error;
      }
      const Range tRange = this->RangeOf(alpha, slopesT);
      if (!(tRange.Low > 0.0) || !(lowWeight > 0.0))
      {
        return false;
      }
      tt = std::min(tt, tRange.Low * (b.Q + 1) / highWeight);
      ts = std::max(ts, this->RangeOf(alpha, slopesS).Size() * b.P / lowWeight);
    }
    return ss * tt > st * ts * (1.0 + 1e-9);
  }

  const SeparationInput& Input;
  int SideA;
  int SideB;
  int Which[2] = { 0, 1 };
  std::vector<SideContact> Contacts;
  const CellLattice* Lattice[2] = { nullptr, nullptr };
  std::vector<std::unique_ptr<Node>> Pool[2];
};
}

SeparationResult SeparateSides(const SeparationInput& input, int a, int b, std::int64_t maxBoxes)
{
  return Prover(input, a, b).Run(maxBoxes);
}
}
