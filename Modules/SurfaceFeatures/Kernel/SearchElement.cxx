// SPDX-License-Identifier: BSD-3-Clause
#include "UniquenessBox.h"

namespace knotwork
{
namespace
{
class ElementSearch
{
public:
  ElementSearch(
    const ScalarPieces& pieces, int e, const CriticalPointParams& params, FoundPoints& result)
    : Pieces(pieces), Piece(pieces[e]), Element(e), Params(params), Result(result),
      FirstPoint(result.Points.size())
  {
  }

  void Run()
  {
    std::vector<PlaneBox> active{ { Interval(0.0, 1.0), Interval(0.0, 1.0) } };
    std::vector<PlaneBox> next;
    for (int depth = 0; !active.empty(); ++depth)
    {
      next.clear();
      const bool last = depth == this->Params.MaxDepth ||
        active.size() > 4 * static_cast<std::size_t>(this->Params.MaxBoxes);
      for (const PlaneBox& local : active)
      {
        if (this->IsSettled(local, last))
        {
          continue;
        }
        const double u = 0.5 * (local[0].Lo + local[0].Hi);
        const double v = 0.5 * (local[1].Lo + local[1].Hi);
        next.push_back({ Interval(local[0].Lo, u), Interval(local[1].Lo, v) });
        next.push_back({ Interval(u, local[0].Hi), Interval(local[1].Lo, v) });
        next.push_back({ Interval(local[0].Lo, u), Interval(v, local[1].Hi) });
        next.push_back({ Interval(u, local[0].Hi), Interval(v, local[1].Hi) });
      }
      active.swap(next);
    }
  }

private:
  /// True when the box needs no halving: it holds nothing, or only what is found already, or goes
  /// to the undecided ones.
  bool IsSettled(const PlaneBox& local, bool last)
  {
    ++this->Result.NumTested;
    bool noise = true;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const BernsteinField& g = this->Piece.Gradient[d];
      const Interval range = g.Range(local);
      if (range.Sign() != 0)
      {
        return true;
      }
      noise = noise && range.Width() <= 4.0 * g.Noise();
    }
    const PlaneBox box = BoxInPlane(this->Piece, local);
    for (std::size_t i = this->FirstPoint; i < this->Result.Points.size(); ++i)
    {
      if (Holds(this->Result.Points[i].Reach, box))
      {
        return true;
      }
    }
    if (this->Resolve(box))
    {
      return true;
    }
    if (noise || last)
    {
      this->Result.Undecided.push_back({ this->Element, box });
      return true;
    }
    return false;
  }

  /// Shows that the box holds no zero, or finds one and covers the box by its uniqueness box.
  bool Resolve(const PlaneBox& box)
  {
    const std::vector<int> self{ this->Element };
    const IntervalMatrix hessian = BoundHessian(this->Pieces, self, box);
    RealArray<2> z{ box[0].Middle(), box[1].Middle() };
    const KrawczykStep step = Krawczyk(this->Pieces, this->Element, z, box, hessian);
    if (step.Valid && !Meet(step.K, box))
    {
      return true;
    }
    if (Determinant(hessian).Sign() == 0)
    {
      return false;
    }
    int home = this->Element;
    const RealArray<2> limit{ 2.0 * box[0].Width(), 2.0 * box[1].Width() };
    if (!FindZero(this->Pieces, limit, z, home) || this->IsKnown(z))
    {
      return false;
    }
    // centred: where the Hessian jumps at the zero, Krawczyk's operator is as large on both sides
    PlaneBox cover;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double radius = 1.1 * std::max(std::abs(box[d].Hi - z[d]), std::abs(box[d].Lo - z[d]));
      cover[d] = Interval(z[d] - radius, z[d] + radius);
    }
    FoundPoint point;
    if (ProveUniqueness(this->Pieces, home, z, cover, true, point) ||
      ProveUniqueness(this->Pieces, home, z, cover, false, point) ||
      this->ProveSmall(home, z, cover, point))
    {
      this->Result.Points.push_back(point);
      return Holds(point.Reach, box);
    }
    return false;
  }

  /// A box centred at the zero, on its piece.
  bool ProveSmall(int home, const RealArray<2>& z, const PlaneBox& cover, FoundPoint& point) const
  {
    PlaneBox box;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const Interval& side = this->Pieces[home].Box[d];
      const double radius =
        0.5 * std::min(std::min(z[d] - side.Lo, side.Hi - z[d]), 0.5 * cover[d].Width());
      box[d] = Interval(z[d] - radius, z[d] + radius);
    }
    return ProveUniqueness(this->Pieces, home, z, box, false, point);
  }

  bool IsKnown(const RealArray<2>& z) const
  {
    const PlaneBox at{ Interval(z[0]), Interval(z[1]) };
    for (std::size_t i = this->FirstPoint; i < this->Result.Points.size(); ++i)
    {
      if (Holds(this->Result.Points[i].Reach, at))
      {
        return true;
      }
    }
    return false;
  }

  const ScalarPieces& Pieces;
  const ScalarPiece& Piece;
  int Element;
  const CriticalPointParams& Params;
  FoundPoints& Result;
  std::size_t FirstPoint;
};
}

PlaneBox BoxInPlane(const ScalarPiece& piece, const PlaneBox& local)
{
  PlaneBox box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    const Interval& side = piece.Box[d];
    const auto place = [&](double t)
    { return Interval(side.Lo) + Interval(t) * (Interval(side.Hi) - Interval(side.Lo)); };
    box[d].Lo = local[d].Lo <= 0.0 ? side.Lo : std::max(side.Lo, place(local[d].Lo).Lo);
    box[d].Hi = local[d].Hi >= 1.0 ? side.Hi : std::min(side.Hi, place(local[d].Hi).Hi);
  }
  return box;
}

PlaneBox OffLines(const ScalarPieces& pieces, const std::vector<int>& elements, const PlaneBox& box,
  const PlaneBox& enclosure)
{
  PlaneBox result = box;
  for (std::size_t d = 0; d < 2; ++d)
  {
    for (const int e : elements)
    {
      const Interval& side = pieces[e].Box[d];
      if (box[d].Lo == side.Lo || box[d].Lo == side.Hi)
      {
        result[d].Lo = box[d].Lo + 0.5 * (enclosure[d].Lo - box[d].Lo);
      }
      if (box[d].Hi == side.Lo || box[d].Hi == side.Hi)
      {
        result[d].Hi = box[d].Hi + 0.5 * (enclosure[d].Hi - box[d].Hi);
      }
    }
  }
  return result;
}

void SearchElement(
  const ScalarPieces& pieces, int e, const CriticalPointParams& params, FoundPoints& result)
{
  ElementSearch(pieces, e, params, result).Run();
}
}
