// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryInjectivity.h"

#include "BoundaryShift.h"
#include "InnerCollapse.h"
#include "InterfaceGaps.h"
#include "PreimageProof.h"
#include "SideSeparation.h"
#include "StarShape.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace knotwork
{
namespace
{
/// A pair of sides gets so many boxes at first, and so many when there are many pairs.
constexpr std::int64_t FirstBoxes = 4096;
constexpr std::int64_t LeastBoxes = 256;
/// Parts of MaxBoxes: a cell's, and that of few cells.
constexpr std::int64_t PartOfCell = 7500;
constexpr std::int64_t PartOfFew = 125;
/// Sides whose neighbours are looked up at a time, and pairs worked on before an overlap among them
/// ends the proof: the first so many, then twice as many each time, up to the last.
constexpr std::size_t SidesAtOnce = 256;
constexpr std::size_t FirstPairs = 32;
constexpr std::size_t MostPairs = 8192;
/// Of those worked on at a time, so many that cannot be separated are searched for an overlap, and
/// so many of which nothing is known but that boxes were not enough.
constexpr std::size_t MostSuspects = 16;
constexpr std::size_t MostUnknown = 2;
/// Sides of a component at which it is tried to count preimages.
constexpr int PlacesOfComponent = 4;

Status CheckInput(const BernsteinCells& cells, const CellComplex& complex,
  const JacobianCertificate& certificate, const InjectivityParams& params)
{
  Status status = cells.Check();
  if (!status)
  {
    return status;
  }
  const std::size_t n = cells.Shapes.size();
  if (n == 0)
  {
    return { ErrorCode::EmptyInput, "there are no cells" };
  }
  for (std::size_t c = 0; c < n; ++c)
  {
    const int dim = NumParameters(cells.Shapes[c]);
    if (dim != cells.NumComponents || dim < 2)
    {
      return { ErrorCode::DimensionMismatch,
        "cell " + std::to_string(c) + " has " + std::to_string(dim) + " parameters and " +
          std::to_string(cells.NumComponents) +
          " components; global injectivity is of plane maps and volumes" };
    }
  }
  if ((!complex.Patches.empty() && complex.Patches.size() != n) ||
    (!complex.Boxes.empty() && complex.Boxes.size() != n))
  {
    return { ErrorCode::SizeMismatch, "patches and boxes must be empty or one a cell" };
  }
  if (!complex.PointIds.empty() &&
    complex.PointIds.size() * static_cast<std::size_t>(cells.NumPlanes()) != cells.Data.size())
  {
    return { ErrorCode::SizeMismatch, "point ids must be empty or one a coefficient" };
  }
  if (certificate.Cells.size() != n)
  {
    return { ErrorCode::SizeMismatch,
      "the certificate is of " + std::to_string(certificate.Cells.size()) + " cells, not of " +
        std::to_string(n) };
  }
  const auto outside = [](const char* name, const char* range)
  { return Status(ErrorCode::InvalidParameter, std::string(name) + " must lie in " + range); };
  if (params.MaxBoxes < 1)
  {
    return outside("MaxBoxes", "[1, ...)");
  }
  if (!(params.GapTolerance >= 0.0 && params.GapTolerance <= 1.0))
  {
    return outside("GapTolerance", "[0, 1]");
  }
  if (!(params.InnerTolerance >= 0.0 && params.InnerTolerance <= 1e-6))
  {
    return outside("InnerTolerance", "[0, 1e-6]");
  }
  if (!(params.InterfaceTolerance >= 0.0 && params.InterfaceTolerance <= 1e-6))
  {
    return outside("InterfaceTolerance", "[0, 1e-6]");
  }
  if (!(params.CollapseTolerance >= 0.0 && params.CollapseTolerance <= 1e-6))
  {
    return outside("CollapseTolerance", "[0, 1e-6]");
  }
  if (params.Threads < 0)
  {
    return outside("Threads", "[0, ...)");
  }
  return {};
}

/// One run of the proof.
class BoundaryProof
{
public:
  BoundaryProof(const BernsteinCells& cells, const CellComplex& complex,
    const JacobianCertificate& certificate, const InjectivityParams& params)
    : Cells(cells), Complex(complex), Local(certificate), Params(params),
      MaxBoxes(std::max<std::int64_t>(1,
        std::min(params.MaxBoxes,
          std::max(params.MaxBoxes / PartOfFew, params.MaxBoxes / PartOfCell * cells.NumCells()))))
  {
  }

  /// @return false when aborted.
  bool Prove(const ProgressCallback& progress)
  {
    const auto report = [&](double part) { return !progress || progress(part); };
    for (const CellCertificate& c : this->Local.Cells)
    {
      this->Signs.push_back(c.Verdict == Verdict::Reversed ? -1 : 1);
    }
    this->Gluing = GlueCells(this->Cells, this->Complex, this->Signs, this->Params);
    this->Out.NumBoundarySides = static_cast<int>(this->Gluing.Boundary.size());
    this->Out.NumBoundaryComponents = this->Gluing.NumComponents;
    this->Out.NumInterfaces = this->Gluing.NumInterfaces;
    this->Out.NumSeams = this->Gluing.NumSeams;
    this->Out.NumCollapsedSides = this->Gluing.NumCollapsed;
    this->Out.NumTouching = this->Gluing.NumTouching;
    this->Out.InnerRounding = this->Gluing.InnerRounding;
    if (!report(0.1))
    {
      return false;
    }
    if (this->FindFolds() || this->FindInnerCollapse())
    {
      return true;
    }
    this->Shift = MoveToMiddle(this->Cells, this->Gluing.Boundary);
    this->MakeTables();
    this->StarShaped = FindStarShaped(this->Gluing.Boundary, this->Gluing.NumComponents,
      this->SideCells, this->Signs, this->Params.Threads);
    if (!report(0.2) || !this->SeparateAll(report))
    {
      return false;
    }
    if (this->Out.Verdict != InjectivityVerdict::NotInjective && !this->FindObstacles())
    {
      this->CountAtComponents();
    }
    return report(1.0);
  }

  InjectivityCertificate Out;

private:
  using Place = InjectivityWitness::Place;

  const BoundarySide& Side(int i) const
  {
    return this->Gluing.Boundary[static_cast<std::size_t>(i)];
  }
  CellShape Shape(int cell) const { return this->Cells.Shapes[static_cast<std::size_t>(cell)]; }
  const CellLattice& LatticeOf(int cell) const
  {
    return this->Lattices.at(
      { static_cast<int>(this->Shape(cell)), this->Cells.Degrees[static_cast<std::size_t>(cell)] });
  }
  Place MakePlace(int cell, int side, const std::array<double, 3>& u) const
  {
    return { cell, side, u, EvaluateCell(this->Cells, cell, u.data()).Position };
  }
  Place SidePlace(int side, const std::array<double, 3>& s) const
  {
    const BoundarySide& b = this->Side(side);
    return this->MakePlace(b.Cell, b.Number, SideToCell(this->Shape(b.Cell), b.Frame, s.data()));
  }
  Place SideMiddle(int cell, int number) const
  {
    if (cell < 0)
    {
      return {};
    }
    const SideFrame& frame = GetSideFrame(this->Shape(cell), number);
    const double middle = frame.Shape == CellShape::Triangle ? 0.25 : 0.5;
    const double s[2] = { middle, middle };
    return this->MakePlace(cell, number, SideToCell(this->Shape(cell), frame, s));
  }
  void Set(InjectivityVerdict verdict, InjectivityReason reason)
  {
    this->Out.Verdict = verdict;
    this->Out.Reason = reason;
  }
  void SetWitness(const Place& a, const Place& b, double radius)
  {
    this->Out.HasWitness = true;
    this->Out.Witness = { { a, b }, radius };
  }

  void MakeTables()
  {
    for (std::size_t c = 0; c < this->Cells.Shapes.size(); ++c)
    {
      this->Lattices.try_emplace(
        { static_cast<int>(this->Cells.Shapes[c]), this->Cells.Degrees[c] }, this->Cells.Shapes[c],
        this->Cells.Degrees[c]);
    }
    this->SideCells.NumComponents = this->Cells.NumComponents;
    this->SideCells.Rational = this->Cells.Rational;
    for (const BoundarySide& b : this->Gluing.Boundary)
    {
      this->SideLattices.try_emplace(
        { static_cast<int>(b.Frame.Shape), b.Degree }, b.Frame.Shape, b.Degree);
      const int i = this->SideCells.Add(b.Frame.Shape, b.Degree);
      std::copy(b.Data.begin(), b.Data.end(), this->SideCells.Block(i));
      this->SideCells.Errors.push_back(b.Error);
    }
  }

  /// Boxes of cells, n x d each.
  static void MakeBoxes(const BernsteinCells& cells, const CellLatticeTable& lattices,
    PointMatrix& lower, PointMatrix& upper, int threads)
  {
    const Eigen::Index n = cells.NumCells();
    lower.resize(n, cells.NumComponents);
    upper.resize(n, cells.NumComponents);
    ParallelFor(static_cast<std::size_t>(n), 256, threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t c = begin; c < end; ++c)
        {
          const auto& lattice =
            lattices.at({ static_cast<int>(cells.Shapes[c]), cells.Degrees[c] });
          const int cell = static_cast<int>(c);
          const PieceHull hull = MakeHull(lattice, cells.NumComponents, cells.Rational,
            MakePiece(lattice, cells.NumPlanes(), cells.Block(cell),
              cells.Errors.empty() ? 0.0 : cells.Errors[c]));
          for (int d = 0; d < cells.NumComponents; ++d)
          {
            const std::size_t at = static_cast<std::size_t>(d);
            lower(cell, d) = hull.Lower[at];
            upper(cell, d) = hull.Upper[at];
          }
        }
      });
  }

  /// A pair of sides, and what is known of it.
  struct PairState
  {
    std::array<int, 2> Sides{};
    /// Sides of two patches within reach of each other.
    bool MayBeGap = false;
    bool Meet = false; ///< their boxes
    bool IsGap = false;
    InterfaceGap Gap;
    SeparationResult Separation;
    bool HasOverlap = false;
    Place First;
    Place Second;
    double Radius = 0.0;
  };

  /// Works through all pairs of sides that come near each other, in their order.
  /// @return false when aborted.
  template <typename Report>
  bool SeparateAll(const Report& report)
  {
    const std::size_t n = static_cast<std::size_t>(this->SideCells.NumCells());
    if (n == 0)
    {
      return true;
    }
    PointMatrix lower;
    PointMatrix upper;
    MakeBoxes(this->SideCells, this->SideLattices, lower, upper, this->Params.Threads);
    const BoxTree tree(lower, upper);
    this->ModelSize =
      (upper.colwise().maxCoeff() - lower.colwise().minCoeff()).cwiseAbs().maxCoeff();
    this->FindLonely(lower, upper);
    std::vector<PairState> open;
    std::size_t batch = FirstPairs;
    for (std::size_t first = 0; first < n; first += SidesAtOnce)
    {
      const std::vector<PairState> pairs =
        this->FindPairs(tree, lower, upper, first, std::min(n, first + SidesAtOnce));
      for (std::size_t done = 0; done < pairs.size();)
      {
        const std::size_t end = std::min(pairs.size(), done + batch);
        const std::int64_t share = (this->MaxBoxes - this->Out.Boxes) /
          static_cast<std::int64_t>(std::max<std::size_t>(end - done, 1));
        std::vector<PairState> now(pairs.begin() + static_cast<std::ptrdiff_t>(done),
          pairs.begin() + static_cast<std::ptrdiff_t>(end));
        this->Work(
          now, std::min(std::clamp(share, LeastBoxes, FirstBoxes), this->Params.MaxBoxes), false);
        if (this->FindFirstOverlap(now))
        {
          return true;
        }
        for (PairState& pair : now)
        {
          if (pair.IsGap)
          {
            this->Out.Gaps.push_back(pair.Gap);
          }
          else if (pair.Separation.State != SeparationState::Separate)
          {
            open.push_back(std::move(pair));
          }
        }
        done = end;
        batch = std::min(2 * batch, MostPairs);
        if (this->Out.Boxes >= this->MaxBoxes && !open.empty())
        {
          this->WorkOnOpen(open);
          return report(0.8);
        }
      }
      if (!report(0.2 + 0.5 * static_cast<double>(first) / static_cast<double>(n)))
      {
        return false;
      }
    }
    this->WorkOnOpen(open);
    return report(0.8);
  }

  /// Pairs of the sides from first to end - 1 with those that follow, whose boxes meet or come
  /// within reach of a gap, without those of star-shaped components.
  std::vector<PairState> FindPairs(const BoxTree& tree, const PointMatrix& lower,
    const PointMatrix& upper, std::size_t first, std::size_t end) const
  {
    const double reach = this->Params.GapTolerance * this->ModelSize;
    std::vector<std::vector<PairState>> near(end - first);
    ParallelFor(end - first, 64, this->Params.Threads,
      [&](std::size_t from, std::size_t to)
      {
        for (std::size_t i = from; i < to; ++i)
        {
          const int a = static_cast<int>(first + i);
          double low[3];
          double high[3];
          for (int d = 0; d < this->Cells.NumComponents; ++d)
          {
            low[d] = lower(a, d) - reach;
            high[d] = upper(a, d) + reach;
          }
          const auto add = [&](int b, bool meet, bool close)
          {
            const int component = this->Side(a).Component;
            const bool isSimple = component == this->Side(b).Component &&
              this->StarShaped[static_cast<std::size_t>(component)];
            PairState pair;
            pair.Sides = { a, b };
            pair.MayBeGap = close && this->Side(a).Patch != this->Side(b).Patch;
            pair.Meet = meet && !isSimple;
            if (pair.MayBeGap || pair.Meet)
            {
              near[i].push_back(std::move(pair));
            }
          };
          add(a, true, false);
          tree.ForNear(low, high,
            [&](int b)
            {
              if (b > a)
              {
                bool meet = true;
                bool close = true;
                for (int d = 0; d < this->Cells.NumComponents; ++d)
                {
                  close = close && lower(b, d) <= high[d] && low[d] <= upper(b, d);
                  meet = meet && lower(b, d) <= upper(a, d) && lower(a, d) <= upper(b, d);
                }
                add(b, meet, close);
              }
            });
          std::sort(near[i].begin(), near[i].end(),
            [](const PairState& x, const PairState& y) { return x.Sides < y.Sides; });
        }
      });
    std::vector<PairState> pairs;
    for (auto& some : near)
    {
      std::move(some.begin(), some.end(), std::back_inserter(pairs));
    }
    return pairs;
  }

  /// @param last  no other attempt follows: overlaps are looked for where the limit was reached
  /// too.
  void Work(std::vector<PairState>& pairs, std::int64_t limit, bool last)
  {
    SeparationInput input;
    input.Sides = &this->Gluing.Boundary;
    input.Lattices = &this->SideLattices;
    input.NumComponents = this->Cells.NumComponents;
    input.Rational = this->Cells.Rational;
    input.CollapseTolerance = this->Params.CollapseTolerance;
    input.Distance = this->Shift.Distance;
    const InterfaceGaps gaps(this->Gluing.Boundary, this->SideCells, this->SideLattices,
      this->Params.GapTolerance * this->ModelSize, this->Shift.Middle);
    ParallelFor(pairs.size(), 4, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          PairState& pair = pairs[k];
          pair.IsGap = pair.MayBeGap && gaps.IsGap(pair.Sides[0], pair.Sides[1], pair.Gap);
          pair.MayBeGap = false;
          if (pair.IsGap || !pair.Meet)
          {
            continue;
          }
          pair.Separation = SeparateSides(input, pair.Sides[0], pair.Sides[1], limit);
        }
      });
    std::vector<PairState*> suspects;
    const auto add = [&](SeparationState state, std::size_t most)
    {
      for (auto pair = pairs.begin(); pair != pairs.end() && most > 0; ++pair)
      {
        if (pair->Separation.State == state)
        {
          suspects.push_back(&*pair);
          --most;
        }
      }
    };
    add(SeparationState::Stuck, MostSuspects);
    add(SeparationState::Boxes, last ? MostUnknown : 0);
    ParallelFor(suspects.size(), 1, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          this->FindOverlap(*suspects[k]);
        }
      });
    for (const PairState& pair : pairs)
    {
      this->Out.Boxes += pair.Separation.Boxes;
    }
  }

  bool FindFirstOverlap(const std::vector<PairState>& pairs)
  {
    for (const PairState& pair : pairs)
    {
      if (pair.HasOverlap)
      {
        this->Set(InjectivityVerdict::NotInjective, InjectivityReason::Overlap);
        this->SetWitness(pair.First, pair.Second, pair.Radius);
        return true;
      }
    }
    return false;
  }

  /// What the first attempt left open shares the boxes that are left.
  void WorkOnOpen(std::vector<PairState>& open)
  {
    std::vector<PairState> limited;
    for (const PairState& pair : open)
    {
      if (pair.Separation.State == SeparationState::Boxes)
      {
        limited.push_back(pair);
      }
    }
    const std::int64_t left = this->MaxBoxes - this->Out.Boxes;
    if (left > static_cast<std::int64_t>(limited.size()) && !limited.empty())
    {
      this->Work(limited, left / static_cast<std::int64_t>(limited.size()), true);
      if (this->FindFirstOverlap(limited))
      {
        return;
      }
      auto next = limited.begin();
      for (PairState& pair : open)
      {
        if (pair.Separation.State == SeparationState::Boxes)
        {
          pair = *next++;
        }
      }
    }
    for (const PairState& pair : open)
    {
      const auto& separation = pair.Separation;
      if (separation.State != SeparationState::Separate &&
        (this->Obstacle == SeparationState::Separate ||
          (this->Obstacle == SeparationState::Boxes && separation.State == SeparationState::Stuck)))
      {
        this->Obstacle = separation.State;
        this->ObstaclePlaces = { this->SidePlace(pair.Sides[0], separation.At[0]),
          this->SidePlace(pair.Sides[1], separation.At[1]) };
      }
    }
  }

  bool IsDecided(int cell) const
  {
    const Verdict v = this->Local.Cells[static_cast<std::size_t>(cell)].Verdict;
    return v == Verdict::Valid || v == Verdict::Reversed;
  }

  /// What contradicts injectivity without a look at the boundary: det J of both signs in one cell,
  /// or two cells on one side of a side.
  bool FindFolds()
  {
    for (std::size_t c = 0; c < this->Local.Cells.size(); ++c)
    {
      const CellCertificate& cell = this->Local.Cells[c];
      if (cell.Verdict != Verdict::Invalid || !(cell.MaxLower > 0.0) || cell.Witness < 0)
      {
        continue;
      }
      const JacobianWitness& witness =
        this->Local.Witnesses[static_cast<std::size_t>(cell.Witness)];
      if (witness.Upper < 0.0)
      {
        this->Set(InjectivityVerdict::NotInjective, InjectivityReason::FoldedCell);
        const Place place = this->MakePlace(static_cast<int>(c), -1, witness.Parameters);
        this->SetWitness(place, place, 0.0);
        return true;
      }
    }
    const auto& folded = this->Gluing.Folded;
    if (folded[0] >= 0 && this->IsDecided(folded[0]) && this->IsDecided(folded[2]))
    {
      this->Set(InjectivityVerdict::NotInjective, InjectivityReason::FoldedSide);
      this->SetWitness(
        this->SideMiddle(folded[0], folded[1]), this->SideMiddle(folded[2], folded[3]), 0.0);
      return true;
    }
    return false;
  }

  /// Inside of a patch, or between patches that are glued all around, no edge may be a point.
  bool FindInnerCollapse()
  {
    const std::array<int, 3> found = this->Gluing.InnerPoint[0] >= 0
      ? this->Gluing.InnerPoint
      : knotwork::FindInnerCollapse(
          this->Cells, this->Complex, this->Local, this->Params.CollapseTolerance);
    if (found[0] < 0)
    {
      return false;
    }
    const CellShape shape = this->Shape(found[0]);
    this->Set(InjectivityVerdict::NotInjective, InjectivityReason::Overlap);
    this->SetWitness(this->MakePlace(found[0], -1, CornerParameters(shape, found[1])),
      this->MakePlace(found[0], -1, CornerParameters(shape, found[2])), 0.0);
    return true;
  }

  /// Where boundaries cross, the insides beside them overlap: points just inside one cell whose
  /// images another cell takes too.
  void FindOverlap(PairState& pair) const
  {
    // from where the proof stopped along the side, and inside by as much or, where the boundaries
    // cross at an acute angle, by less
    for (int halving = 2; halving <= 41; halving += 3)
    {
      for (int less = 0; less <= 15; less += 5)
      {
        const double along = std::ldexp(1.0, -halving);
        const double inside = std::ldexp(along, -less);
        if (this->TryOverlap(0, along, inside, pair) || this->TryOverlap(1, along, inside, pair))
        {
          return;
        }
      }
    }
  }

  bool TryOverlap(int turn, double along, double inside, PairState& pair) const
  {
    const bool plane = this->Cells.NumComponents == 2;
    const std::size_t at = static_cast<std::size_t>(turn);
    const BoundarySide& from = this->Side(pair.Sides[at]);
    const BoundarySide& to = this->Side(pair.Sides[1 - at]);
    const CellLattice& lattice = this->LatticeOf(to.Cell);
    const auto start =
      SideToCell(this->Shape(to.Cell), to.Frame, pair.Separation.At[1 - at].data());
    const CellShape shape = this->Shape(from.Cell);
    std::array<double, 3> middle{};
    for (int c = 0; c < NumCorners(shape); ++c)
    {
      const auto u = CornerParameters(shape, c);
      for (std::size_t d = 0; d < 3; ++d)
      {
        middle[d] += u[d] / NumCorners(shape);
      }
    }
    for (int k = 0; k < (plane ? 3 : 9); ++k)
    {
      auto s = pair.Separation.At[at];
      s[0] = std::clamp(s[0] + (k % 3 - 1) * along, 0.0, 1.0);
      s[1] = plane ? 0.0 : std::clamp(s[1] + (k / 3 - 1) * along, 0.0, 1.0);
      if (from.Frame.Shape == CellShape::Triangle && s[0] + s[1] > 1.0)
      {
        continue;
      }
      auto u = SideToCell(shape, from.Frame, s.data());
      for (std::size_t d = 0; d < 3; ++d)
      {
        u[d] += inside * (middle[d] - u[d]);
      }
      const ImagePoint image = EvaluateImage(this->Cells, from.Cell, u.data());
      const auto preimage = ProvePreimage(this->Cells, lattice, to.Cell, start, image);
      if (!preimage)
      {
        continue;
      }
      double apart = 0.0;
      for (std::size_t d = 0; d < 3; ++d)
      {
        apart = std::max(apart, std::abs(preimage->Parameters[d] - u[d]));
      }
      if (from.Cell != to.Cell || apart > 2.0 * preimage->Radius)
      {
        pair.HasOverlap = true;
        pair.First = this->MakePlace(from.Cell, -1, u);
        pair.Second = this->MakePlace(to.Cell, -1, preimage->Parameters);
        pair.Radius = preimage->Radius;
        return true;
      }
    }
    return false;
  }

  /// What keeps the theorem's conditions from being proved.
  bool FindObstacles()
  {
    const auto undecided = [&](InjectivityReason reason, const Place& a, const Place& b)
    {
      this->Set(InjectivityVerdict::Undecided, reason);
      this->SetWitness(a, b, 0.0);
      return true;
    };
    for (int c = 0; c < this->Cells.NumCells(); ++c)
    {
      if (!this->IsDecided(c))
      {
        const std::int32_t w = this->Local.Cells[static_cast<std::size_t>(c)].Witness;
        std::array<double, 3> u{};
        if (w >= 0)
        {
          u = this->Local.Witnesses[static_cast<std::size_t>(w)].Parameters;
        }
        const Place place = this->MakePlace(c, -1, u);
        return undecided(InjectivityReason::LocalJacobian, place, place);
      }
    }
    const CellGluing& g = this->Gluing;
    if (g.Partial[0] >= 0)
    {
      const Place place = this->SideMiddle(g.Partial[0], g.Partial[1]);
      return undecided(InjectivityReason::OpenSide, place, place);
    }
    if (g.Torn[0] >= 0)
    {
      InterfaceGap gap;
      gap.Cells = { g.Torn[0], g.Torn[2] };
      gap.Sides = { g.Torn[1], g.Torn[3] };
      gap.Size = g.TornSize;
      gap.Position = this->SideMiddle(g.Torn[0], g.Torn[1]).Position;
      this->Out.Gaps.insert(this->Out.Gaps.begin(), gap);
    }
    if (!this->Out.Gaps.empty())
    {
      const auto largest = std::max_element(this->Out.Gaps.begin(), this->Out.Gaps.end(),
        [](const InterfaceGap& a, const InterfaceGap& b) { return a.Size < b.Size; });
      return undecided(InjectivityReason::Gap,
        this->SideMiddle(largest->Cells[0], largest->Sides[0]),
        this->SideMiddle(largest->Cells[1], largest->Sides[1]));
    }
    if (g.Open[0] >= 0 || g.Boundary.empty())
    {
      const Place place = this->SideMiddle(g.Open[0], g.Open[1]);
      return undecided(InjectivityReason::OpenBoundary, place, place);
    }
    if (this->Obstacle != SeparationState::Separate)
    {
      return undecided(this->Obstacle == SeparationState::Boxes ? InjectivityReason::Boxes
                                                                : InjectivityReason::TooClose,
        this->ObstaclePlaces[0], this->ObstaclePlaces[1]);
    }
    return false;
  }

  /// Components whose boxes meet no other's. The number of preimages is the sum of the components'
  /// winding numbers: near such a component it is 0 on one side and 1 on the other.
  void FindLonely(const PointMatrix& lower, const PointMatrix& upper)
  {
    const Eigen::Index n = this->Gluing.NumComponents;
    const double infinity = std::numeric_limits<double>::infinity();
    PointMatrix low = PointMatrix::Constant(n, lower.cols(), infinity);
    PointMatrix high = PointMatrix::Constant(n, lower.cols(), -infinity);
    for (std::size_t i = 0; i < this->Gluing.Boundary.size(); ++i)
    {
      const int component = this->Gluing.Boundary[i].Component;
      const Eigen::Index at = static_cast<Eigen::Index>(i);
      low.row(component) = low.row(component).cwiseMin(lower.row(at));
      high.row(component) = high.row(component).cwiseMax(upper.row(at));
    }
    const BoxTree tree(low, high);
    this->Lonely.assign(static_cast<std::size_t>(n), true);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const Eigen::RowVectorXd from = low.row(i);
      const Eigen::RowVectorXd to = high.row(i);
      tree.ForNear(from.data(), to.data(),
        [&](int other)
        {
          if (other != i && (low.row(other).array() <= to.array()).all() &&
            (from.array() <= high.row(other).array()).all())
          {
            this->Lonely[static_cast<std::size_t>(i)] = false;
          }
        });
    }
  }

  /// The map covers a neighbourhood of one point of every component once, where that is not known.
  /// A single simple component needs no look: the degree is 0 on one side of it and 1 on the other.
  /// Components that touch are looked at side by side.
  void CountAtComponents()
  {
    std::vector<std::vector<int>> places; // any of them is enough
    std::vector<int> first(static_cast<std::size_t>(this->Gluing.NumComponents), -1);
    for (std::size_t i = 0; i < this->Gluing.Boundary.size(); ++i)
    {
      const std::size_t component = static_cast<std::size_t>(this->Gluing.Boundary[i].Component);
      if (this->Gluing.NumTouching > 0)
      {
        places.push_back({ static_cast<int>(i) });
      }
      else if (!this->Lonely[component])
      {
        if (first[component] < 0)
        {
          first[component] = static_cast<int>(places.size());
          places.emplace_back();
        }
        std::vector<int>& some = places[static_cast<std::size_t>(first[component])];
        if (some.size() < PlacesOfComponent)
        {
          some.push_back(static_cast<int>(i));
        }
      }
    }
    if (places.size() > 1)
    {
      PointMatrix lower;
      PointMatrix upper;
      MakeBoxes(this->Cells, this->Lattices, lower, upper, this->Params.Threads);
      const BoxTree tree(lower, upper);
      std::vector<MultiplicityResult> results(places.size());
      const std::int64_t each = std::max<std::int64_t>(
        FirstBoxes, (this->MaxBoxes - this->Out.Boxes) / static_cast<std::int64_t>(places.size()));
      ParallelFor(places.size(), 4, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t k = begin; k < end; ++k)
          {
            for (const int place : places[k])
            {
              const BoundarySide& side = this->Side(place);
              const std::int64_t before = results[k].Boxes;
              results[k] = CountPreimages(this->Cells, this->Lattices, tree, side.Cell,
                this->SideMiddle(side.Cell, side.Number).Parameters, each - before);
              results[k].Boxes += before;
              if (results[k].State != Multiplicity::Unknown || results[k].Boxes > each)
              {
                places[k] = { place };
                break;
              }
            }
          }
        });
      for (std::size_t k = 0; k < results.size(); ++k)
      {
        const MultiplicityResult& result = results[k];
        this->Out.Boxes += result.Boxes;
        const BoundarySide& side = this->Side(places[k][0]);
        const Place place = this->SideMiddle(side.Cell, side.Number);
        if (result.State == Multiplicity::Several)
        {
          this->Set(InjectivityVerdict::NotInjective, InjectivityReason::Overlap);
          this->SetWitness(
            place, this->MakePlace(result.Cell, -1, result.Other.Parameters), result.Other.Radius);
          return;
        }
        if (result.State == Multiplicity::Unknown && !this->Out.HasWitness)
        {
          this->Set(InjectivityVerdict::Undecided,
            result.Boxes > each ? InjectivityReason::Boxes : InjectivityReason::TooClose);
          this->SetWitness(place, place, 0.0);
        }
      }
      if (this->Out.HasWitness)
      {
        return;
      }
    }
    bool collapsed = this->Gluing.NumCollapsed > 0;
    for (const BoundarySide& b : this->Gluing.Boundary)
    {
      collapsed = collapsed ||
        std::find(b.CollapsedEdges.begin(), b.CollapsedEdges.end(), true) != b.CollapsedEdges.end();
    }
    const InjectivityReason reason = this->Gluing.NumSeams > 0 ? InjectivityReason::Seam
      : collapsed                                              ? InjectivityReason::CollapsedSide
      : this->Gluing.NumTouching > 0                           ? InjectivityReason::Touching
                                                               : InjectivityReason::None;
    this->Set(reason == InjectivityReason::None ? InjectivityVerdict::Injective
                                                : InjectivityVerdict::InjectiveUpToSeam,
      reason);
  }

  const BernsteinCells& Cells;
  const CellComplex& Complex;
  const JacobianCertificate& Local;
  const InjectivityParams& Params;
  std::int64_t MaxBoxes; ///< of these cells
  CellGluing Gluing;
  CellLatticeTable Lattices;
  CellLatticeTable SideLattices;
  BernsteinCells SideCells;
  double ModelSize = 0.0;
  BoundaryShift Shift;
  std::vector<int> Signs;       ///< of det J, one a cell
  std::vector<char> StarShaped; ///< one a component of the boundary
  std::vector<bool> Lonely;     ///< one a component of the boundary
  SeparationState Obstacle = SeparationState::Separate;
  std::array<Place, 2> ObstaclePlaces;
};
}

const char* ToString(InjectivityVerdict verdict)
{
  switch (verdict)
  {
    case InjectivityVerdict::Injective:
      return "injective";
    case InjectivityVerdict::InjectiveUpToSeam:
      return "injective_up_to_seam";
    case InjectivityVerdict::NotInjective:
      return "not_injective";
    default:
      return "undecided";
  }
}

const char* ToString(InjectivityReason reason)
{
  switch (reason)
  {
    case InjectivityReason::None:
      return "the map is injective";
    case InjectivityReason::Seam:
      return "two sides of one patch have the same control points";
    case InjectivityReason::CollapsedSide:
      return "a side or an edge of the boundary is a point or a curve";
    case InjectivityReason::Touching:
      return "corners or edges of the boundary coincide exactly";
    case InjectivityReason::FoldedCell:
      return "the Jacobian determinant takes both signs in a cell";
    case InjectivityReason::FoldedSide:
      return "two cells lie on the same side of the side they share";
    case InjectivityReason::Overlap:
      return "two different points have the same image";
    case InjectivityReason::LocalJacobian:
      return "the local certificate does not prove a nonzero Jacobian determinant in a cell";
    case InjectivityReason::Gap:
      return "sides of two patches nearly agree, but are not equal";
    case InjectivityReason::OpenSide:
      return "a side of an element is only partly covered by its neighbours";
    case InjectivityReason::OpenBoundary:
      return "the boundary does not consist of closed curves or surfaces";
    case InjectivityReason::Boxes:
      return "the limit of boxes was reached";
    case InjectivityReason::TooClose:
      return "boundary points touch, or are too close to be told apart";
  }
  return "";
}

Result<InjectivityCertificate> ProveInjectivity(const BernsteinCells& cells,
  const CellComplex& complex, const JacobianCertificate& certificate,
  const InjectivityParams& params, const ProgressCallback& progress)
{
  Status status = CheckInput(cells, complex, certificate, params);
  if (!status)
  {
    return status;
  }
  BoundaryProof run(cells, complex, certificate, params);
  if (!run.Prove(progress))
  {
    return Status(ErrorCode::Aborted, "the injectivity proof was stopped");
  }
  return std::move(run.Out);
}
}
