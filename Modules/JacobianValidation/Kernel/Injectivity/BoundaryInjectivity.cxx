// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryInjectivity.h"

#include "BoundarySeparation.h"
#include "ComponentCount.h"
#include "InnerCollapse.h"

#include <algorithm>
#include <string>
#include <utility>

namespace knotwork
{
namespace
{
/// Parts of MaxBoxes: a cell's, and that of few cells.
constexpr std::int64_t PartOfCell = 7500;
constexpr std::int64_t PartOfFew = 125;

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
    std::vector<int> signs; // of det J, one a cell
    for (const CellCertificate& c : this->Local.Cells)
    {
      signs.push_back(c.Verdict == Verdict::Reversed ? -1 : 1);
    }
    this->Gluing = GlueCells(this->Cells, this->Complex, signs, this->Params);
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
    const MapBoundary boundary(this->Cells, this->Gluing, signs, this->Params.Threads);
    BoundarySeparation separation;
    if (!report(0.2) ||
      !SeparateBoundary(boundary, this->Params, this->MaxBoxes, report, separation))
    {
      return false;
    }
    this->Out.Boxes = separation.Boxes;
    this->Out.Gaps = std::move(separation.Gaps);
    if (separation.Overlap)
    {
      this->Set(InjectivityVerdict::NotInjective, InjectivityReason::Overlap, *separation.Overlap);
    }
    else if (!this->FindObstacles(separation))
    {
      this->FindMultiplicity(boundary);
    }
    return report(1.0);
  }

  InjectivityCertificate Out;

private:
  using Place = InjectivityWitness::Place;

  void Set(InjectivityVerdict verdict, InjectivityReason reason, const InjectivityWitness& witness)
  {
    this->Out.Verdict = verdict;
    this->Out.Reason = reason;
    this->Out.HasWitness = true;
    this->Out.Witness = witness;
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
        const Place place = PlaceInCell(this->Cells, static_cast<int>(c), -1, witness.Parameters);
        this->Set(InjectivityVerdict::NotInjective, InjectivityReason::FoldedCell,
          { { place, place }, 0.0 });
        return true;
      }
    }
    const auto& folded = this->Gluing.Folded;
    if (folded[0] >= 0 && this->IsDecided(folded[0]) && this->IsDecided(folded[2]))
    {
      const Place first = MiddleOfSide(this->Cells, folded[0], folded[1]);
      const Place second = MiddleOfSide(this->Cells, folded[2], folded[3]);
      this->Set(InjectivityVerdict::NotInjective, InjectivityReason::FoldedSide,
        { { first, second }, 0.0 });
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
    const CellShape shape = this->Cells.Shapes[static_cast<std::size_t>(found[0])];
    const Place first = PlaceInCell(this->Cells, found[0], -1, CornerParameters(shape, found[1]));
    const Place second = PlaceInCell(this->Cells, found[0], -1, CornerParameters(shape, found[2]));
    this->Set(
      InjectivityVerdict::NotInjective, InjectivityReason::Overlap, { { first, second }, 0.0 });
    return true;
  }

  /// What keeps the theorem's conditions from being proved.
  bool FindObstacles(const BoundarySeparation& separation)
  {
    const auto undecided = [&](InjectivityReason reason, const Place& a, const Place& b)
    {
      this->Set(InjectivityVerdict::Undecided, reason, { { a, b }, 0.0 });
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
        const Place place = PlaceInCell(this->Cells, c, -1, u);
        return undecided(InjectivityReason::LocalJacobian, place, place);
      }
    }
    const CellGluing& g = this->Gluing;
    if (g.Partial[0] >= 0)
    {
      const Place place = MiddleOfSide(this->Cells, g.Partial[0], g.Partial[1]);
      return undecided(InjectivityReason::OpenSide, place, place);
    }
    if (g.Torn[0] >= 0)
    {
      InterfaceGap gap;
      gap.Cells = { g.Torn[0], g.Torn[2] };
      gap.Sides = { g.Torn[1], g.Torn[3] };
      gap.Size = g.TornSize;
      gap.Position = MiddleOfSide(this->Cells, g.Torn[0], g.Torn[1]).Position;
      this->Out.Gaps.insert(this->Out.Gaps.begin(), gap);
    }
    if (!this->Out.Gaps.empty())
    {
      const auto largest = std::max_element(this->Out.Gaps.begin(), this->Out.Gaps.end(),
        [](const InterfaceGap& a, const InterfaceGap& b) { return a.Size < b.Size; });
      return undecided(InjectivityReason::Gap,
        MiddleOfSide(this->Cells, largest->Cells[0], largest->Sides[0]),
        MiddleOfSide(this->Cells, largest->Cells[1], largest->Sides[1]));
    }
    if (g.Open[0] >= 0 || g.Boundary.empty())
    {
      const Place place = MiddleOfSide(this->Cells, g.Open[0], g.Open[1]);
      return undecided(InjectivityReason::OpenBoundary, place, place);
    }
    if (separation.Obstacle != SeparationState::Separate)
    {
      return undecided(separation.Obstacle == SeparationState::Boxes ? InjectivityReason::Boxes
                                                                     : InjectivityReason::TooClose,
        separation.ObstaclePlaces[0], separation.ObstaclePlaces[1]);
    }
    return false;
  }

  /// The map is injective when nothing is in the way and it covers all places just once.
  void FindMultiplicity(const MapBoundary& boundary)
  {
    const ComponentCount count =
      CountAtComponents(boundary, this->MaxBoxes - this->Out.Boxes, this->Params.Threads);
    this->Out.Boxes += count.Boxes;
    if (count.Verdict != InjectivityVerdict::Injective)
    {
      this->Set(count.Verdict, count.Reason, count.Witness);
      return;
    }
    bool collapsed = this->Gluing.NumCollapsed > 0;
    for (const BoundarySide& b : this->Gluing.Boundary)
    {
      collapsed = collapsed ||
        std::find(b.CollapsedEdges.begin(), b.CollapsedEdges.end(), true) != b.CollapsedEdges.end();
    }
    this->Out.Reason = this->Gluing.NumSeams > 0 ? InjectivityReason::Seam
      : collapsed                                ? InjectivityReason::CollapsedSide
      : this->Gluing.NumTouching > 0             ? InjectivityReason::Touching
                                                 : InjectivityReason::None;
    this->Out.Verdict = this->Out.Reason == InjectivityReason::None
      ? InjectivityVerdict::Injective
      : InjectivityVerdict::InjectiveUpToSeam;
  }

  const BernsteinCells& Cells;
  const CellComplex& Complex;
  const JacobianCertificate& Local;
  const InjectivityParams& Params;
  std::int64_t MaxBoxes; ///< of these cells
  CellGluing Gluing;
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
