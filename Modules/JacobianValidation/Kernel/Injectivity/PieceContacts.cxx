// SPDX-License-Identifier: BSD-3-Clause
#include "PieceContacts.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double EdgeEpsilon = 0x1p-44;

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

std::vector<OnEdge> FindOnEdge(CellShape shape, const CellPiece& piece, int edge)
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

bool EdgeOnPole(
  const BoundarySide& side, const std::array<double, 3>& p, const std::array<double, 3>& q)
{
  for (int e = 0; e < NumSideEdges(side.Frame.Shape); ++e)
  {
    if (side.CollapsedEdges[static_cast<std::size_t>(e)] &&
      EdgeParameter(side.Frame.Shape, e, p) >= 0.0 && EdgeParameter(side.Frame.Shape, e, q) >= 0.0)
    {
      return true;
    }
  }
  return false;
}
}

PieceContacts::PieceContacts(
  const SeparationInput& input, int a, int b, const std::array<const CellLattice*, 2>& lattices)
  : Input(input), SideA(a), SideB(b), Contacts(FindContacts(*input.Sides, a, b)), Lattice(lattices)
{
}

int PieceContacts::FirstOnPole(int k, const CellPiece& piece, int corner) const
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

const BoundarySide& PieceContacts::SideOf(int k) const
{
  return (*this->Input.Sides)[static_cast<std::size_t>(k == 0 ? this->SideA : this->SideB)];
}

bool PieceContacts::HasCorner(int k, const CellPiece& piece, int sideCorner, int& corner) const
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
      is = side.CollapsedEdges[static_cast<std::size_t>(e)] && EdgeParameter(shape, e, u) >= 0.0 &&
        EdgeParameter(shape, e, v) >= 0.0;
    }
    if (is)
    {
      corner = this->FirstOnPole(k, piece, c);
      return true;
    }
  }
  return false;
}

void PieceContacts::AddContacts(
  const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const
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
        shared.push_back({ PieceRelation::Corner, ca, cb, false });
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
          shared.push_back({ equal ? PieceRelation::Edge : PieceRelation::Mixed, p.Edge, q.Edge,
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
          shared.push_back({ ca >= 0 && cb >= 0 ? PieceRelation::Corner : PieceRelation::Mixed,
            ca >= 0 ? this->FirstOnPole(0, a, ca) : -1, cb >= 0 ? this->FirstOnPole(1, b, cb) : -1,
            false });
        }
      }
    }
  }
}

void PieceContacts::AddNeighbours(
  const CellPiece& a, const CellPiece& b, std::vector<Shared>& shared) const
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
          { PieceRelation::Corner, this->FirstOnPole(0, a, i), this->FirstOnPole(1, b, j), false });
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
        shared.push_back({ PieceRelation::Corner, this->FirstOnPole(0, a, onA[0].LowCorner),
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
        shared.push_back({ forward || backward ? PieceRelation::Edge : PieceRelation::Mixed, i, j,
          backward, 1.0 / std::abs(t1 - t0) });
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
          shared.push_back({ PieceRelation::Mixed, -1, -1, false });
        }
      }
    }
  };
  if (std::none_of(shared.begin(), shared.end(),
        [](const Shared& s) { return s.What == PieceRelation::Edge; }))
  {
    within(a, b);
    within(b, a);
  }
}

PieceRelation PieceContacts::Reduce(
  const CellPiece& a, const CellPiece& b, const std::vector<Shared>& shared) const
{
  PieceRelation relation;
  for (const Shared& s : shared)
  {
    if (s.What == PieceRelation::Mixed)
    {
      relation = {};
      relation.What = PieceRelation::Mixed;
      relation.Longer = s.Ratio > 1.5 ? 0 : s.Ratio < 0.75 ? 1 : -1;
      relation.LongerEdge = relation.Longer == 1 ? s.B : s.A;
      return relation;
    }
    if (s.What == PieceRelation::Edge)
    {
      if (relation.What == PieceRelation::Edge && (relation.A != s.A || relation.B != s.B))
      {
        relation.What = PieceRelation::Mixed;
        return relation;
      }
      relation = { PieceRelation::Edge, s.A, s.B, s.Reversed, -1, -1 };
    }
  }
  if (relation.What == PieceRelation::Edge)
  {
    const auto ea = SideEdge(this->Lattice[0]->Shape, relation.A);
    const auto eb = SideEdge(this->Lattice[1]->Shape, relation.B);
    for (const Shared& s : shared)
    {
      if (s.What == PieceRelation::Corner)
      {
        const auto isEnd = [&](int i)
        {
          return s.A == this->FirstOnPole(0, a, ea[static_cast<std::size_t>(i)]) &&
            s.B ==
            this->FirstOnPole(1, b, eb[static_cast<std::size_t>(relation.Reversed ? 1 - i : i)]);
        };
        if (!isEnd(0) && !isEnd(1))
        {
          relation.What = PieceRelation::Mixed;
          return relation;
        }
      }
    }
    return relation;
  }
  for (const Shared& s : shared)
  {
    if (relation.What == PieceRelation::None)
    {
      relation = { PieceRelation::Corner, s.A, s.B, false, -1, -1 };
    }
    else if (relation.A != s.A || relation.B != s.B)
    {
      relation.What = PieceRelation::Mixed;
      return relation;
    }
  }
  return relation;
}

PieceRelation PieceContacts::OwnContacts(
  const CellPiece& a, const CellPiece& b, bool contactsOnly) const
{
  std::vector<Shared> shared;
  this->AddContacts(a, b, shared);
  if (!contactsOnly)
  {
    this->AddNeighbours(a, b, shared);
  }
  return this->Reduce(a, b, shared);
}

PieceRelation PieceContacts::Relate(const CellPiece& a, const CellPiece& b) const
{
  return this->OwnContacts(a, b, this->SideA != this->SideB);
}

PieceRelation PieceContacts::RelateToItself(const CellPiece& a) const
{
  PieceRelation relation;
  relation.What =
    this->Contacts.empty() || this->OwnContacts(a, a, true).What == PieceRelation::None
    ? PieceRelation::Same
    : PieceRelation::Mixed;
  return relation;
}
}
