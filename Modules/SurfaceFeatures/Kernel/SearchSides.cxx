// SPDX-License-Identifier: BSD-3-Clause
#include "CriticalSearch.h"

namespace knotwork
{
namespace
{
/// Critical points of f along one part of a side, with the derivatives across it.
class SideSearch
{
public:
  SideSearch(const ScalarPieces& pieces, int e, const PieceJoin& join,
    const CriticalPointParams& params, FoundPoints& result)
    : Pieces(pieces), Element(e), Join(join), Params(params), Result(result),
      Normal(static_cast<std::size_t>(join.Side / 2)), Tangent(1 - this->Normal),
      Upper(join.Side % 2 == 1), FirstPoint(result.Points.size())
  {
    const Interval& side = pieces[e].Box[this->Normal];
    this->Line = this->Upper ? side.Hi : side.Lo;
  }

  void Run()
  {
    std::vector<Interval> active{ this->Join.Along };
    std::vector<Interval> next;
    for (int depth = 0; !active.empty(); ++depth)
    {
      next.clear();
      const bool last = depth == this->Params.MaxDepth ||
        active.size() > 2 * static_cast<std::size_t>(this->Params.MaxBoxes);
      for (const Interval& part : active)
      {
        const double middle = part.Middle();
        if (this->IsSettled(part, last || !(part.Lo < middle && middle < part.Hi)))
        {
          continue;
        }
        next.emplace_back(part.Lo, middle);
        next.emplace_back(middle, part.Hi);
      }
      active.swap(next);
    }
  }

private:
  int LayerOf() const
  {
    return this->Join.Kind == JoinKind::Crease ? Layer::Crease : Layer::Side + this->Join.Side;
  }
  /// A part of the line, with a thickness on one side of it.
  PlaneBox BoxOf(const Interval& along, double thickness = 0.0, bool above = false) const
  {
    PlaneBox box;
    box[this->Tangent] = along;
    box[this->Normal] = above ? Interval(this->Line, this->Line + thickness)
                              : Interval(this->Line - thickness, this->Line);
    return box;
  }
  Interval Slope(int e, const PlaneBox& box, std::size_t direction) const
  {
    const ScalarPiece& piece = this->Pieces[e];
    return piece.Gradient[direction].Range(piece.Local(box));
  }

  bool IsSettled(const Interval& part, bool last)
  {
    ++this->Result.NumTested;
    const PlaneBox box = this->BoxOf(part);
    const Interval slope = this->Slope(this->Element, box, this->Tangent);
    if (slope.Sign() != 0)
    {
      return true;
    }
    if (this->Join.Kind == JoinKind::Crease)
    {
      const int mine = this->Slope(this->Element, box, this->Normal).Sign();
      if (mine != 0 && mine == this->Slope(this->Join.Neighbor, box, this->Normal).Sign())
      {
        return true;
      }
    }
    for (std::size_t i = this->FirstPoint; i < this->Result.Points.size(); ++i)
    {
      if (Holds(this->Result.Points[i].Reach, box))
      {
        return true;
      }
    }
    if (this->Resolve(part))
    {
      return true;
    }
    const double noise = this->Pieces[this->Element].Gradient[this->Tangent].Noise();
    if (last || slope.Width() <= 4.0 * noise)
    {
      this->Result.Undecided.push_back({ this->Element, box, this->LayerOf() });
      return true;
    }
    return false;
  }

  /// Newton's method along the line, on the element's own polynomial.
  bool FindZero(const Interval& part, double& z) const
  {
    const ScalarPiece& piece = this->Pieces[this->Element];
    const Interval& side = piece.Box[this->Tangent];
    RealArray<2> local{};
    local[this->Normal] = this->Upper ? 1.0 : 0.0;
    z = part.Middle();
    for (int step = 0; step < 24; ++step)
    {
      local[this->Tangent] = (z - side.Lo) / side.Width();
      const double move = piece.Gradient[this->Tangent].Evaluate(local) /
        piece.Jacobian[this->Tangent][this->Tangent].Evaluate(local);
      z -= move;
      if (!(std::abs(z - part.Middle()) <= 2.0 * part.Width()))
      {
        return false;
      }
      if (std::abs(move) <= 0x1p-48 * side.Width())
      {
        return true;
      }
    }
    return true;
  }

  /// Elements on this side of the line around z, and beyond it, that a part of the line meets;
  /// the part is cut to where the line is of one kind and f smooth along it.
  bool GatherChain(double z, Interval& part, std::vector<int>& mine, std::vector<int>& beyond) const
  {
    mine.assign(1, this->Element);
    for (int end = 0; end < 2; ++end)
    {
      int at = this->Element;
      while (at >= 0)
      {
        const Interval& side = this->Pieces[at].Box[this->Tangent];
        if (end == 0 ? part.Lo >= side.Lo : part.Hi <= side.Hi)
        {
          break;
        }
        at = this->Following(at, end);
        if (at >= 0)
        {
          mine.push_back(at);
        }
        else
        {
          (end == 0 ? part.Lo : part.Hi) = end == 0 ? side.Lo : side.Hi;
        }
      }
    }
    beyond.clear();
    for (const int e : mine)
    {
      for (const PieceJoin* j = this->Pieces.BeginJoins(e); j != this->Pieces.EndJoins(e); ++j)
      {
        if (j->Side != this->Join.Side || j->Along.Lo >= part.Hi || j->Along.Hi <= part.Lo)
        {
          continue;
        }
        if ((j->Kind == JoinKind::Boundary) == (this->Join.Kind == JoinKind::Boundary))
        {
          beyond.push_back(j->Neighbor);
        }
        else if (j->Along.Lo >= z)
        {
          part.Hi = std::min(part.Hi, j->Along.Lo);
        }
        else
        {
          part.Lo = std::max(part.Lo, j->Along.Hi);
        }
      }
    }
    if (this->Join.Kind == JoinKind::Boundary)
    {
      beyond.clear();
    }
    return part.Lo < z && z < part.Hi;
  }

  /// The next element along the line on this side of it, across a smooth side; -1: none.
  int Following(int e, int end) const
  {
    const int side = 2 * static_cast<int>(this->Tangent) + end;
    for (const PieceJoin* j = this->Pieces.BeginJoins(e); j != this->Pieces.EndJoins(e); ++j)
    {
      if (j->Side == side && j->Kind == JoinKind::Smooth &&
        (this->Upper ? j->Along.Hi : j->Along.Lo) == this->Line)
      {
        const Interval& next = this->Pieces[j->Neighbor].Box[this->Normal];
        return (this->Upper ? next.Hi : next.Lo) == this->Line ? j->Neighbor : -1;
      }
    }
    return -1;
  }

  /// Hull of a derivative over those of the elements that a box meets.
  template <typename Field>
  Interval Hull(const std::vector<int>& elements, const PlaneBox& box, const Field& field) const
  {
    Interval hull;
    bool first = true;
    for (const int e : elements)
    {
      const ScalarPiece& piece = this->Pieces[e];
      if (!piece.Box[this->Tangent].Meets(box[this->Tangent]))
      {
        continue;
      }
      const Interval range = field(piece).Range(piece.Local(box));
      hull = first ? range : hull;
      hull.Merge(range);
      first = false;
    }
    return hull;
  }

  /// Sign of the normal derivative next to the line with the thickness for which it is proved.
  int NormalSign(
    const std::vector<int>& elements, const Interval& part, bool above, double& thickness) const
  {
    thickness = part.Width();
    for (const int e : elements)
    {
      thickness = std::min(thickness, 0.5 * this->Pieces[e].Box[this->Normal].Width());
    }
    for (int step = 0; step < 12; ++step, thickness /= 8.0)
    {
      const int sign = this
                         ->Hull(elements, this->BoxOf(part, thickness, above),
                           [&](const ScalarPiece& piece) -> const BernsteinField&
                           { return piece.Gradient[this->Normal]; })
                         .Sign();
      if (sign != 0)
      {
        return sign;
      }
    }
    return 0;
  }

  Interval SlopeAt(const std::vector<int>& elements, double x) const
  {
    return this->Hull(elements, this->BoxOf(Interval(x)),
      [&](const ScalarPiece& piece) -> const BernsteinField&
      { return piece.Gradient[this->Tangent]; });
  }

  /// Finds a point and covers the part by its uniqueness box.
  bool Resolve(const Interval& part)
  {
    double z = 0.0;
    if (!this->FindZero(part, z))
    {
      return false;
    }
    const double slack = 0.1 * part.Width();
    Interval cover(std::min(part.Lo, z) - slack, std::max(part.Hi, z) + slack);
    FoundPoint point;
    if (!this->Prove(z, cover, point))
    {
      cover = Interval(z - slack, z + slack);
      if (!this->Prove(z, cover, point))
      {
        return false;
      }
    }
    this->Result.Points.push_back(point);
    return point.Reach[this->Tangent].Holds(part);
  }

  bool Prove(double z, Interval part, FoundPoint& point) const
  {
    std::vector<int> mine;
    std::vector<int> beyond;
    if (!this->GatherChain(z, part, mine, beyond))
    {
      return false;
    }
    const auto curvature = [&](const ScalarPiece& piece) -> const BernsteinField&
    { return piece.Jacobian[this->Tangent][this->Tangent]; };
    const int bend = this->Hull(mine, this->BoxOf(part), curvature).Sign();
    if (bend == 0 || this->SlopeAt(mine, part.Lo).Sign() != -bend ||
      this->SlopeAt(mine, part.Hi).Sign() != bend)
    {
      return false;
    }
    double thickness = 0.0;
    double thicknessBeyond = 0.0;
    // derivatives away from the line on both sides
    const int grows =
      this->NormalSign(mine, part, !this->Upper, thickness) * (this->Upper ? -1 : 1);
    const int growsBeyond = beyond.empty()
      ? 0
      : this->NormalSign(beyond, part, this->Upper, thicknessBeyond) * (this->Upper ? 1 : -1);
    const bool isBoundary = this->Join.Kind == JoinKind::Boundary;
    if (grows == 0 || (!isBoundary && grows != growsBeyond))
    {
      return false;
    }
    Interval x = part;
    for (int step = 0; step < 60; ++step)
    {
      // interval Newton: x = m - f'(m) / f''(x)
      const double m = x.Middle();
      const Interval next =
        Interval(m) - this->SlopeAt(mine, m) / this->Hull(mine, this->BoxOf(x), curvature);
      const double width = x.Width();
      x = Interval(std::max(x.Lo, next.Lo), std::min(x.Hi, next.Hi));
      if (!(x.Width() < 0.9 * width))
      {
        break;
      }
    }
    this->Describe(x, mine, bend, grows, point);
    point.Reach = this->BoxOf(part);
    double& low = point.Reach[this->Normal].Lo;
    double& high = point.Reach[this->Normal].Hi;
    (this->Upper ? low : high) += this->Upper ? -thickness : thickness;
    if (!isBoundary)
    {
      (this->Upper ? high : low) += this->Upper ? thicknessBeyond : -thicknessBeyond;
    }
    // the ends of the part only: the line itself is where the point lies
    point.Box = point.Reach;
    point.Box[this->Tangent] =
      OffLines(this->Pieces, mine, this->BoxOf(part), point.Enclosure)[this->Tangent];
    return true;
  }

  void Describe(
    const Interval& x, const std::vector<int>& mine, int bend, int grows, FoundPoint& point) const
  {
    const bool isBoundary = this->Join.Kind == JoinKind::Boundary;
    point.Place = isBoundary ? CriticalPlace::Boundary : CriticalPlace::Crease;
    point.InwardSign = isBoundary ? grows : 0;
    point.Layer = this->LayerOf();
    if (bend == grows)
    {
      point.Kind = bend > 0 ? CriticalKind::Minimum : CriticalKind::Maximum;
      point.Index = isBoundary && bend < 0 ? 0 : 1;
    }
    else
    {
      point.Kind = CriticalKind::Saddle;
      point.Index = isBoundary && grows < 0 ? 0 : -1;
    }
    point.Enclosure = this->BoxOf(x);
    point.Element = -1;
    bool first = true;
    for (const int e : mine)
    {
      const ScalarPiece& piece = this->Pieces[e];
      const Interval& side = piece.Box[this->Tangent];
      if (!side.Meets(x))
      {
        continue;
      }
      const Interval value = this->Pieces.ValueRange(e, point.Enclosure);
      point.Value = first ? value : point.Value;
      point.Value.Merge(value);
      first = false;
      const double middle = x.Middle();
      if (side.Lo <= middle && middle <= side.Hi && (point.Element < 0 || e < point.Element))
      {
        point.Element = e;
        RealArray<2> local{};
        local[this->Normal] = this->Upper ? 1.0 : 0.0;
        local[this->Tangent] = (middle - side.Lo) / side.Width();
        const double w = this->Pieces.Rational ? piece.Weight.Evaluate(local) : 1.0;
        const double second =
          piece.Jacobian[this->Tangent][this->Tangent].Evaluate(local) / (w * w);
        point.Eigenvalues = { second, second };
      }
    }
  }

  const ScalarPieces& Pieces;
  int Element;
  const PieceJoin& Join;
  const CriticalPointParams& Params;
  FoundPoints& Result;
  std::size_t Normal;
  std::size_t Tangent;
  bool Upper;
  std::size_t FirstPoint;
  double Line = 0.0;
};
}

void SearchSides(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, FoundPoints& result)
{
  for (const PieceJoin* join = pieces.BeginJoins(e); join != pieces.EndJoins(e); ++join)
  {
    const bool crease = join->Kind == JoinKind::Crease && join->Side % 2 == 1;
    const bool boundary = join->Kind == JoinKind::Boundary && params.Boundary;
    if (crease || boundary)
    {
      SideSearch(pieces, e, *join, params, result).Run();
    }
  }
}
}
