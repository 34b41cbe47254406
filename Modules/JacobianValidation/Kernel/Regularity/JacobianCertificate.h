// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BernsteinCells.h>

namespace knotwork
{
/// What is proved of a cell's Jacobian: of det J for cells of as many components as parameters, of
/// |S_u x S_v| for surfaces and |C_u| for curves in a space of more components. Derivatives are
/// with respect to the cell's local parameters.
enum class Verdict : std::int8_t
{
  Invalid = -1,  ///< it is <= 0 at the witness, and not < 0 throughout
  Undecided = 0, ///< a limit stopped the proof: CellCertificate::Limit
  Valid = 1,     ///< it is > 0 throughout (but for the degenerate places, when there are some)
  Reversed = 2   ///< det J < 0 throughout (never of surfaces and curves in space)
};

/// "valid", "invalid", "reversed", "undecided".
const char* ToString(Verdict verdict);

/// Which limit stopped an undecided cell.
enum class JacobianLimit : std::uint8_t
{
  None,
  Boxes,     ///< JacobianParams::MaxBoxes: more would go on
  Depth,     ///< sub-boxes whose corners are multiples of 2^-51: a zero that no finite subdivision
             ///< separates
  Precision, ///< the errors that BernsteinCells::Errors states hide the sign
  Rounding ///< degenerate within the rounding of its coordinates: on an edge or a side the Jacobian
           ///< is as near to zero, on either side of it, as control points that move by
           ///< CollapseTolerance make it, and with zeros there the cell would be valid
};

/// One plain sentence, without a full stop; empty for None.
const char* ToString(JacobianLimit limit);

/// Bits of CellCertificate::Degenerate: where det J is exactly zero although the cell is valid.
enum DegeneratePlace : std::uint8_t
{
  DegenerateVertex = 1,
  DegenerateEdge = 2,
  DegenerateFace = 4
};

struct JacobianParams
{
  /// Of the bounds asked for: Upper - Lower <= RelativeGap * max(|Lower|, |Upper|), in (0, 1]. 1
  /// asks for the sign only; the bounds are then what the proof of the sign gave.
  double RelativeGap = 1.0;
  /// Also bring the bounds of the maximum to the gap; otherwise they are the first bounds found.
  bool ComputeMax = false;
  /// Boxes over all cells that needed subdivision, >= 1. Each such cell gets an equal share, at
  /// least 4096, and those still open share what the others left.
  std::int64_t MaxBoxes = 1000000;
  /// Control points on a cell's edges and faces that agree with the end of their line within this
  /// part of its largest coordinate are taken as that point exactly, and corner values of det J
  /// within this part of its terms as zero: both are what rounding makes of a degenerate map. 0:
  /// the stored numbers and nothing else. Cells where it was used say so (Snapped). In [0, 1e-6].
  double CollapseTolerance = 0x1p-48;
  int Threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct CellCertificate
{
  knotwork::Verdict Verdict = knotwork::Verdict::Undecided;
  JacobianLimit Limit = JacobianLimit::None;
  std::uint8_t Degenerate = 0; ///< DegeneratePlace bits
  bool Snapped = false;        ///< CollapseTolerance changed the cell within that tolerance
  /// Surfaces and curves in space: proved that the normal (tangent) stays on one side of a plane.
  bool OneSided = false;
  std::int32_t Witness = -1; ///< into JacobianCertificate::Witnesses
  /// Limit Rounding: control points known to less than this length would decide. Else 0.
  double Rounding = 0.0;
  std::int64_t Boxes = 0; ///< sub-boxes looked at; 0: the cell's own coefficients decided
  /// Rounded outward: MinLower <= min det J <= MinUpper, MaxLower <= max det J <= MaxUpper.
  double MinLower = 0.0;
  double MinUpper = 0.0;
  double MaxLower = 0.0;
  double MaxUpper = 0.0;
};

/// A point where det J <= 0 is proved (of surfaces in a plane x, y or z = const: where the normal
/// is turned against that of other points of the cell; of other surfaces and of curves: where the
/// Jacobian is zero).
struct JacobianWitness
{
  int Cell = -1;
  std::array<double, 3> Parameters{}; ///< local, exact dyadic numbers
  double Upper = 0.0;                 ///< det J there is <= Upper <= 0
  /// The sub-box of the cell that has the witness for a corner: its corners' local parameters in
  /// the cell's order of corners (CornerParameters).
  int NumCorners = 0;
  std::array<std::array<double, 3>, 8> Corners{};
};

struct JacobianCertificate
{
  std::vector<CellCertificate> Cells;     ///< one a cell
  std::vector<JacobianWitness> Witnesses; ///< by ascending cell
  /// Valid or Reversed if all cells are, Invalid if one is or if some are valid and some reversed,
  /// else Undecided.
  knotwork::Verdict Verdict = knotwork::Verdict::Undecided;
  int NumValid = 0;
  int NumReversed = 0;
  int NumInvalid = 0;
  int NumUndecided = 0;
  int NumDegenerate = 0;
  std::int64_t Boxes = 0;
  /// Over all cells, as in CellCertificate.
  double MinLower = 0.0;
  double MinUpper = 0.0;
  double MaxLower = 0.0;
  double MaxUpper = 0.0;
};

/// Proves for every cell where its Jacobian is positive, for the geometry that the stored doubles
/// are: Bernstein coefficients of the numerator of minimal degree with a static error bound, then
/// subdivision in outward-rounded arithmetic, then exact arithmetic for what these leave open.
/// @return what BernsteinCells::Check says; DimensionMismatch for fewer components than parameters
/// or more than 3; InvalidParameter; Aborted.
/// @complexity two convolutions a cell when its own coefficients decide.
/// @source  Johnen, Remacle, Geuzaine, JCP 233 (2013) 359-372 (adaptive Bernstein bounds).
Result<JacobianCertificate> ValidateJacobian(const BernsteinCells& cells,
  const JacobianParams& params = {}, const ProgressCallback& progress = {});

/// Fills in what the certificate says of all cells from what it says of each.
void Summarize(JacobianCertificate& certificate);

struct CertificateCheck
{
  int Confirmed = 0;
  int Unchecked = 0; ///< undecided or snapped cells, and those that the budget did not settle
  int Refuted = 0;
  std::string FirstRefuted; ///< which cell, and what is wrong
};

/// Checks a certificate by other and simpler means: integers throughout, det J by its definition
/// and not by minimal forms, subdivision of its own. Witnesses are evaluated; signs are proved
/// anew, and so are the four bounds (to 1e-9 of the largest, since a bound may be attained). Slow:
/// for tests and doubts.
/// @pre cells.Errors is empty.  @param maxBoxes  a proof.
CertificateCheck VerifyCertificate(
  const BernsteinCells& cells, const JacobianCertificate& certificate, int maxBoxes = 2000);
}
