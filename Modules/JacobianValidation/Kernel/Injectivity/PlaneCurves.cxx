// SPDX-License-Identifier: BSD-3-Clause
#include "PlaneCurves.h"

#include "SideSeparation.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/BoxTree.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
using Vector = Eigen::Vector2d;
constexpr double UnitRoundoff = 0x1p-53;
constexpr std::int64_t FirstBoxes = 4096;
constexpr int MaxDepth = 50;
constexpr double Slack = 1.0 + 1e-9;

Vector Across(const Vector& d)
{
  return { -d[1], d[0] };
}

CellLatticeTable MakeLattices(const BernsteinCells& curves)
{
  CellLatticeTable lattices;
  for (const CellDegree& degree : curves.Degrees)
  {
    lattices.try_emplace({ static_cast<int>(CellShape::Curve), degree }, CellShape::Curve, degree);
  }
  return lattices;
}
const CellLattice& LatticeOf(
  const CellLatticeTable& lattices, const BernsteinCells& curves, int curve)
{
  return lattices.at(
    { static_cast<int>(CellShape::Curve), curves.Degrees[static_cast<std::size_t>(curve)] });
}

CellPiece WholeCurve(const BernsteinCells& curves, const CellLattice& lattice, int curve)
{
  return MakePiece(lattice, curves.NumPlanes(), curves.Block(curve),
    curves.Errors.empty() ? 0.0 : curves.Errors[static_cast<std::size_t>(curve)]);
}

Vector HullPoint(const PieceHull& hull, int i)
{
  return { hull.Point(i)[0], hull.Point(i)[1] };
}

double LargestCoordinate(const PieceHull& hull)
{
  double largest = 0.0;
  for (std::size_t d = 0; d < 2; ++d)
  {
    largest = std::max({ largest, std::abs(hull.Lower[d]), std::abs(hull.Upper[d]) });
  }
  return largest;
}

// ---- crossings ---------------------------------------------------------------------------------

/// A part of a curve.
struct CurvePart
{
  int Curve = 0;
  double Begin = 0.0;
  double End = 1.0;
};

/// Parts end to end, as the hull of all of them and the ends.
struct Arc
{
  std::vector<CurvePart> Parts;
  std::vector<Vector> Points;
  Vector Begin = Vector::Zero();
  Vector End = Vector::Zero();
  double Error = 0.0;
  double Largest = 0.0;
};

class CrossingProver
{
public:
  CrossingProver(const BernsteinCells& curves, const CellLatticeTable& lattices,
    const std::vector<std::array<int, 2>>& ends)
    : Curves(curves), Lattices(lattices), Ends(ends)
  {
    int points = 0;
    for (const auto& pair : ends)
    {
      points = std::max({ points, pair[0] + 1, pair[1] + 1 });
    }
    this->AtPoint.resize(static_cast<std::size_t>(points));
    for (std::size_t c = 0; c < ends.size(); ++c)
    {
      for (const std::size_t end : { std::size_t{ 0 }, std::size_t{ 1 } })
      {
        this->AtPoint[static_cast<std::size_t>(ends[c][end])].push_back(
          { static_cast<int>(c), end == 1 });
      }
    }
  }

  /// Looks for arcs that cross around parameters of two curves, from wide ones to narrow ones.
  bool Prove(const std::array<int, 2>& pair, const std::array<double, 2>& at) const
  {
    for (int k = 2; k <= 36; ++k)
    {
      const double half = std::ldexp(1.0, -k);
      const Arc a = this->MakeArc(pair[0], at[0], half);
      const Arc b = this->MakeArc(pair[1], at[1], half);
      if (Disjoint(a, b) && Passes(a, b) && Passes(b, a))
      {
        return true;
      }
    }
    return false;
  }

private:
  /// The end of another curve in a point where just two of them end.
  const CurveStep* Neighbour(int curve, bool atEnd) const
  {
    const auto& here = this->AtPoint[static_cast<std::size_t>(
      this->Ends[static_cast<std::size_t>(curve)][atEnd ? 1 : 0])];
    if (here.size() != 2)
    {
      return nullptr;
    }
    return &here[here[0].Curve == curve && here[0].Reversed == atEnd ? 1 : 0];
  }

  void Append(Arc& arc, const CurvePart& part, Vector ends[2]) const
  {
    const CellLattice& lattice = LatticeOf(this->Lattices, this->Curves, part.Curve);
    CellPiece piece = WholeCurve(this->Curves, lattice, part.Curve);
    double largest = 0.0;
    for (int plane = 0; plane < this->Curves.NumPlanes(); ++plane)
    {
      const auto begin = piece.Data.begin() + plane * lattice.Size;
      const std::vector<double> whole(begin, begin + lattice.Size);
      const auto restricted =
        BernsteinRestrict<1>({ lattice.Degree[0] }, whole, 0, part.Begin, part.End);
      for (int i = 0; i < lattice.Size; ++i)
      {
        const std::size_t at = static_cast<std::size_t>(i);
        largest = std::max(largest, std::abs(whole[at]));
        begin[i] = restricted[at];
      }
    }
    // as many means of two numbers as the degree, at two parameters
    piece.Error = (piece.Error + 16.0 * lattice.Degree[0] * UnitRoundoff * largest) * Slack;
    const PieceHull hull =
      MakeHull(lattice, this->Curves.NumComponents, this->Curves.Rational, piece);
    for (int i = 0; i < lattice.Size; ++i)
    {
      arc.Points.push_back(HullPoint(hull, i));
    }
    ends[0] = HullPoint(hull, lattice.Corners[0]);
    ends[1] = HullPoint(hull, lattice.Corners[1]);
    arc.Error = std::max(arc.Error, hull.Error);
    arc.Largest = std::max(arc.Largest, LargestCoordinate(hull));
    arc.Parts.push_back(part);
  }

  Arc MakeArc(int curve, double at, double half) const
  {
    Arc arc;
    Vector ends[2];
    this->Append(arc, { curve, std::max(0.0, at - half), std::min(1.0, at + half) }, ends);
    arc.Begin = ends[0];
    arc.End = ends[1];
    for (const bool atEnd : { false, true })
    {
      if (atEnd ? at + half < 1.0 : at - half > 0.0)
      {
        continue;
      }
      const CurveStep* next = this->Neighbour(curve, atEnd);
      if (next)
      {
        // Reversed: it is entered at its end
        const CurvePart part{ next->Curve, next->Reversed ? 1.0 - half : 0.0,
          next->Reversed ? 1.0 : half };
        this->Append(arc, part, ends);
        (atEnd ? arc.End : arc.Begin) = ends[next->Reversed ? 0 : 1];
      }
    }
    return arc;
  }

  static bool Disjoint(const Arc& a, const Arc& b)
  {
    for (const CurvePart& p : a.Parts)
    {
      for (const CurvePart& q : b.Parts)
      {
        if (p.Curve == q.Curve && p.Begin <= q.End && q.Begin <= p.End)
        {
          return false;
        }
      }
    }
    return true;
  }

  /// Whether a begins on one side of all of b, seen across b's chord, and ends on the other. When
  /// both arcs do so, each connects two opposite sides of the parallelogram that is bounded by b's
  /// extent across b and a's extent across a, and leaves it through no other side: they cross.
  static bool Passes(const Arc& a, const Arc& b)
  {
    const Vector d = Across(b.End - b.Begin);
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vector& x : b.Points)
    {
      low = std::min(low, d.dot(x));
      high = std::max(high, d.dot(x));
    }
    const double margin = (std::abs(d[0]) + std::abs(d[1])) *
      (a.Error + b.Error + 8.0 * UnitRoundoff * std::max(a.Largest, b.Largest)) * Slack;
    const double begin = d.dot(a.Begin);
    const double end = d.dot(a.End);
    return std::isfinite(margin) && std::min(begin, end) + margin < low &&
      high + margin < std::max(begin, end);
  }

  const BernsteinCells& Curves;
  const CellLatticeTable& Lattices;
  const std::vector<std::array<int, 2>>& Ends;
  std::vector<std::vector<CurveStep>> AtPoint; ///< Reversed: the curve's end is there
};

// ---- simple curves -----------------------------------------------------------------------------

Status CheckPlaneCurves(const BernsteinCells& curves)
{
  Status status = curves.Check();
  if (status &&
    (curves.NumComponents != 2 ||
      std::any_of(curves.Shapes.begin(), curves.Shapes.end(),
        [](CellShape shape) { return shape != CellShape::Curve; })))
  {
    return { ErrorCode::DimensionMismatch, "the cells must be curves in the plane" };
  }
  return status;
}

class SimpleProver
{
public:
  SimpleProver(const BernsteinCells& curves, const std::vector<std::array<int, 2>>& ends,
    const SimpleCurvesParams& params)
    : Curves(curves), Params(params), Lattices(MakeLattices(curves)),
      Crossings(curves, this->Lattices, ends)
  {
    for (int c = 0; c < curves.NumCells(); ++c)
    {
      const std::size_t at = static_cast<std::size_t>(c);
      const CellLattice& lattice = LatticeOf(this->Lattices, curves, c);
      BoundarySide side;
      side.Cell = c;
      side.Frame.Shape = CellShape::Curve;
      side.Frame.NumCorners = 2;
      side.Degree = curves.Degrees[at];
      side.Data.assign(curves.Block(c), curves.Block(c) + curves.NumPlanes() * lattice.Size);
      side.Error = curves.Errors.empty() ? 0.0 : curves.Errors[at];
      side.Places = { ends[at][0], ends[at][1], -1, -1 };
      this->Sides.push_back(std::move(side));
    }
  }

  SimpleCurvesProof Run()
  {
    this->FindPairs();
    this->States.resize(this->Pairs.size());
    std::vector<std::size_t> all(this->Pairs.size());
    for (std::size_t k = 0; k < all.size(); ++k)
    {
      all[k] = k;
    }
    const std::int64_t share = std::min(FirstBoxes, this->Params.MaxBoxes);
    this->Separate(all, share, false);
    std::vector<std::size_t> open;
    bool crossing = false;
    for (const std::size_t k : all)
    {
      crossing = crossing || this->States[k].Crosses;
      if (this->States[k].Separation.State == SeparationState::Boxes)
      {
        open.push_back(k);
      }
    }
    if (!open.empty() && !crossing)
    {
      const std::int64_t left = this->Params.MaxBoxes - this->Out.Boxes;
      this->Separate(open, std::max(left / static_cast<std::int64_t>(open.size()), share), true);
    }
    this->Out.Verdict = CurvesVerdict::Simple;
    for (std::size_t k = 0; k < this->States.size(); ++k)
    {
      const State& state = this->States[k];
      const bool isOpen = state.Separation.State != SeparationState::Separate;
      if (state.Crosses || (isOpen && this->Out.Verdict == CurvesVerdict::Simple))
      {
        this->SetPlace(k);
        this->Out.Verdict = state.Crosses ? CurvesVerdict::Crossing : CurvesVerdict::Undecided;
        if (state.Crosses)
        {
          break;
        }
      }
    }
    return this->Out;
  }

private:
  struct State
  {
    SeparationResult Separation;
    bool Crosses = false;
  };

  /// Pairs of curves whose boxes meet.
  void FindPairs()
  {
    const int n = this->Curves.NumCells();
    if (n == 0)
    {
      return;
    }
    PointMatrix lower(n, 2);
    PointMatrix upper(n, 2);
    for (int c = 0; c < n; ++c)
    {
      const CellLattice& lattice = LatticeOf(this->Lattices, this->Curves, c);
      const PieceHull hull =
        MakeHull(lattice, 2, this->Curves.Rational, WholeCurve(this->Curves, lattice, c));
      lower.row(c) << hull.Lower[0], hull.Lower[1];
      upper.row(c) << hull.Upper[0], hull.Upper[1];
    }
    const BoxTree tree(lower, upper);
    for (int a = 0; a < n; ++a)
    {
      const std::size_t first = this->Pairs.size();
      this->Pairs.push_back({ a, a });
      tree.ForNear(lower.row(a).data(), upper.row(a).data(),
        [&](int b)
        {
          if (b > a && (lower.row(b).array() <= upper.row(a).array()).all() &&
            (lower.row(a).array() <= upper.row(b).array()).all())
          {
            this->Pairs.push_back({ a, b });
          }
        });
      std::sort(this->Pairs.begin() + static_cast<std::ptrdiff_t>(first), this->Pairs.end());
    }
  }

  void Separate(const std::vector<std::size_t>& which, std::int64_t limit, bool last)
  {
    SeparationInput input;
    input.Sides = &this->Sides;
    input.Lattices = &this->Lattices;
    input.NumComponents = 2;
    input.Rational = this->Curves.Rational;
    ParallelFor(which.size(), 16, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t i = begin; i < end; ++i)
        {
          State& state = this->States[which[i]];
          const auto& pair = this->Pairs[which[i]];
          state.Separation = SeparateSides(input, pair[0], pair[1], limit);
          if (state.Separation.State == SeparationState::Stuck ||
            (last && state.Separation.State == SeparationState::Boxes))
          {
            state.Crosses =
              this->Crossings.Prove(pair, { state.Separation.At[0][0], state.Separation.At[1][0] });
          }
        }
      });
    for (const std::size_t k : which)
    {
      this->Out.Boxes += this->States[k].Separation.Boxes;
    }
  }

  void SetPlace(std::size_t k)
  {
    const auto& at = this->States[k].Separation.At;
    this->Out.Curves = this->Pairs[k];
    this->Out.Parameters = { at[0][0], at[1][0] };
    EvaluateCell(this->Curves, this->Pairs[k][0], at[0], this->Out.Position.data());
  }

  const BernsteinCells& Curves;
  const SimpleCurvesParams& Params;
  CellLatticeTable Lattices;
  CrossingProver Crossings;
  std::vector<BoundarySide> Sides;
  std::vector<std::array<int, 2>> Pairs;
  std::vector<State> States;
  SimpleCurvesProof Out;
};

// ---- closed curves -----------------------------------------------------------------------------

/// Angle under which a piece is seen from a point, in units of a full turn.
std::optional<double> Turn(const BernsteinCells& curves, const CellLattice& lattice,
  const CellPiece& piece, const Vector& point, double error)
{
  const PieceHull hull = MakeHull(lattice, 2, curves.Rational, piece);
  Vector middle = Vector::Zero();
  for (int i = 0; i < lattice.Size; ++i)
  {
    middle += HullPoint(hull, i) / lattice.Size;
  }
  const Vector d = middle - point;
  const double margin = (std::abs(d[0]) + std::abs(d[1])) *
    (hull.Error + error +
      8.0 * UnitRoundoff * std::max(LargestCoordinate(hull), point.cwiseAbs().maxCoeff()));
  // a million errors away: where two steps meet, angles are off by less than 1e-5
  bool isBeside = std::isfinite(margin);
  for (int i = 0; i < lattice.Size && isBeside; ++i)
  {
    isBeside = d.dot(HullPoint(hull, i) - point) > 1e6 * margin;
  }
  if (isBeside)
  {
    const Vector a = HullPoint(hull, lattice.Corners[0]) - point;
    const Vector b = HullPoint(hull, lattice.Corners[1]) - point;
    const double turn = std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
    return turn / (2.0 * std::acos(-1.0));
  }
  if (piece.Depth >= MaxDepth)
  {
    return {};
  }
  double sum = 0.0;
  for (const CellPiece& half : Bisect(lattice, curves.NumPlanes(), piece, 0))
  {
    const auto turn = Turn(curves, lattice, half, point, error);
    if (!turn)
    {
      return {};
    }
    sum += *turn;
  }
  return sum;
}

/// A piece's share of the enclosed area, seen from an origin, and how far it may be off.
struct AreaPiece
{
  int Curve = 0;
  double Sign = 1.0;
  CellPiece Piece;
  double Area = 0.0;
  double Doubt = 0.0;
};

void MeasureArea(
  const BernsteinCells& curves, const CellLattice& lattice, const Vector& origin, AreaPiece& piece)
{
  const PieceHull hull = MakeHull(lattice, 2, curves.Rational, piece.Piece);
  const Vector a = HullPoint(hull, lattice.Corners[0]) - origin;
  const Vector b = HullPoint(hull, lattice.Corners[1]) - origin;
  const Vector chord = b - a;
  const double length = chord.norm();
  double away = 0.0;
  double polygon = 0.0;
  for (int i = 0; i < lattice.Size; ++i)
  {
    const Vector x = HullPoint(hull, i) - origin;
    away =
      std::max(away, length > 0.0 ? std::abs(Across(chord).dot(x - a)) / length : (x - a).norm());
    polygon += i == 0 ? 0.0 : (HullPoint(hull, i) - HullPoint(hull, i - 1)).norm();
  }
  const double error = 2.0 * hull.Error + 16.0 * UnitRoundoff * LargestCoordinate(hull);
  piece.Area = piece.Sign * 0.5 * (a[0] * b[1] - a[1] * b[0]);
  piece.Doubt = ((away + 2.0 * error) * (polygon + 2.0 * lattice.Size * error) +
                  2.0 * error * (a.cwiseAbs().sum() + b.cwiseAbs().sum() + error)) *
    (1.0 + 1e-6);
}
}

Result<SimpleCurvesProof> ProveSimpleCurves(const BernsteinCells& curves,
  const std::vector<std::array<int, 2>>& ends, const SimpleCurvesParams& params)
{
  if (Status status = CheckPlaneCurves(curves); !status)
  {
    return status;
  }
  if (ends.size() != curves.Shapes.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(ends.size()) + " pairs of ends for " + std::to_string(curves.NumCells()) +
        " curves" };
  }
  if (params.MaxBoxes < 1 || params.Threads < 0 ||
    std::any_of(
      ends.begin(), ends.end(), [](const auto& pair) { return pair[0] < 0 || pair[1] < 0; }))
  {
    return { ErrorCode::InvalidParameter,
      "MaxBoxes must be at least 1, Threads and the numbers of ends at least 0" };
  }
  return SimpleProver(curves, ends, params).Run();
}

std::optional<int> CountWindings(const BernsteinCells& curves, const std::vector<CurveStep>& loop,
  const std::array<double, 2>& point, double error)
{
  const CellLatticeTable lattices = MakeLattices(curves);
  double sum = 0.0;
  for (const CurveStep& step : loop)
  {
    const CellLattice& lattice = LatticeOf(lattices, curves, step.Curve);
    const auto turn =
      Turn(curves, lattice, WholeCurve(curves, lattice, step.Curve), { point[0], point[1] }, error);
    if (!turn)
    {
      return {};
    }
    sum += step.Reversed ? -*turn : *turn;
  }
  // steps meet within their errors, so angles add up to whole turns but for those
  const double turns = std::round(sum);
  if (!(std::abs(sum - turns) + 1e-5 * static_cast<double>(loop.size()) < 0.5))
  {
    return {};
  }
  return static_cast<int>(turns);
}

std::optional<int> FindOrientation(const BernsteinCells& curves, const std::vector<CurveStep>& loop)
{
  if (loop.empty())
  {
    return {};
  }
  const CellLatticeTable lattices = MakeLattices(curves);
  const double* first = curves.Block(loop[0].Curve);
  const int n = LatticeOf(lattices, curves, loop[0].Curve).Size;
  Vector origin(first[0], first[n]);
  if (curves.Rational)
  {
    origin /= first[2 * n];
  }
  std::vector<AreaPiece> pieces;
  for (const CurveStep& step : loop)
  {
    const CellLattice& lattice = LatticeOf(lattices, curves, step.Curve);
    AreaPiece piece;
    piece.Curve = step.Curve;
    piece.Sign = step.Reversed ? -1.0 : 1.0;
    piece.Piece = WholeCurve(curves, lattice, step.Curve);
    MeasureArea(curves, lattice, origin, piece);
    pieces.push_back(std::move(piece));
  }
  for (int round = 0; round < 24; ++round)
  {
    double area = 0.0;
    double doubt = 0.0;
    double size = 0.0;
    for (const AreaPiece& piece : pieces)
    {
      area += piece.Area;
      doubt += piece.Doubt;
      size += std::abs(piece.Area);
    }
    const double count = static_cast<double>(pieces.size());
    const double rounding = 2.0 * count * UnitRoundoff * (size + doubt);
    if (std::abs(area) > (doubt + rounding) * Slack)
    {
      return area > 0.0 ? 1 : -1;
    }
    std::vector<AreaPiece> finer;
    for (AreaPiece& piece : pieces)
    {
      if (piece.Doubt <= 0.25 * doubt / count)
      {
        finer.push_back(std::move(piece));
        continue;
      }
      const CellLattice& lattice = LatticeOf(lattices, curves, piece.Curve);
      for (CellPiece& half : Bisect(lattice, curves.NumPlanes(), piece.Piece, 0))
      {
        AreaPiece part;
        part.Curve = piece.Curve;
        part.Sign = piece.Sign;
        part.Piece = std::move(half);
        MeasureArea(curves, lattice, origin, part);
        finer.push_back(std::move(part));
      }
    }
    pieces = std::move(finer);
    if (pieces.size() > std::max<std::size_t>(16384, 64 * loop.size()))
    {
      break;
    }
  }
  return {};
}
}
