// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ExactForm.h"
#include "JacobianCertificate.h"

namespace knotwork
{
/// A polynomial, or a quotient of two, on a cell, whose minimum is searched.
struct BoxProblem
{
  const FormLayout* Layout = nullptr;
  std::vector<double> Numerator;   ///< unscaled coefficients
  double NumeratorError = 0.0;     ///< of each
  std::vector<double> Denominator; ///< of the same layout, positive; empty: 1
  double DenominatorError = 0.0;
  /// Faces of the cell (sets of slots that vanish) where the numerator is exactly zero and its
  /// stored coefficients are too: legal there.
  std::vector<std::uint8_t> ZeroFaces;
  /// The numerator's exact form; its coefficients are those of Exact over 2^Scale. Null: unknown.
  std::shared_ptr<const ExactForm> Exact;
  int Scale = 0;
};

struct BoxSearchParams
{
  double RelativeGap = 1.0;
  bool NeedSign = true; ///< also go on until the minimum's sign is proved, and stop when it is <= 0
  std::int64_t MaxBoxes = 0;
};

struct BoxSearchResult
{
  bool Positive = false; ///< proved > 0 but on the zero faces
  bool NonPositive =
    false;                 ///< a point with a value <= 0, not on a zero face, is proved: WitnessBox
  bool NeedsExact = false; ///< rounding stopped it; nothing else is known
  JacobianLimit Limit = JacobianLimit::None;
  double Lower = 0.0;
  double Upper = 0.0;
  std::int64_t Boxes = 0;
  std::array<double, 3> Witness{}; ///< where Upper was found
  std::array<std::array<double, 3>, 8> WitnessCorners{};
};

/// Lower and upper bound of the minimum by subdivision, worst box first. A box is cut at the middle
/// of the edge direction along which its coefficients are most curved.
///
/// Rounding: the average of two coefficients within M of zero is off by at most u M (the halving is
/// exact), so n averages in a row (n the degree along the edge) add at most n u M to the error of
/// all coefficients of the box. M falls with the boxes near a small minimum, and so do the errors.
/// Where they are too large nevertheless, the coefficients of the box are made anew from the exact
/// form, and their signs are then exact.
BoxSearchResult SearchMinimum(const BoxProblem& problem, const BoxSearchParams& params);

/// Local parameters of the corners of the box that a path of halvings (2 edge + side each) leads
/// to.
std::array<std::array<double, 3>, 8> BoxCorners(
  const FormLayout& layout, const std::vector<std::uint8_t>& path);
}
