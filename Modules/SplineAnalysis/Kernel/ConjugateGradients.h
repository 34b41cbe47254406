// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SymmetricMatrix.h"
#include <knotwork/SplineCore/Status.h>

namespace knotwork
{
template <int Width>
class Preconditioner
{
public:
  virtual ~Preconditioner() = default;
  /// An approximate solution of each column.
  virtual void Apply(const UnknownColumns<Width>& side, UnknownColumns<Width>& x) = 0;
};

/// When conjugate gradients end.
struct IterationLimits
{
  double Tolerance = 1e-12; ///< residual over right-hand side
  int Iterations = 20000;
};

/// Conjugate gradients from 0, each column on its own. @param x  right-hand sides; become the
/// solutions. @param iterations  that were done. @return NotConverged.
/// @source  Hestenes, Stiefel, J. Res. NBS 49 (1952) 409-436.
template <int Width>
Status Iterate(SymmetricMatrix<Width>& matrix, Preconditioner<Width>& preconditioner,
  const IterationLimits& limits, int threads, UnknownColumns<Width>& x, int& iterations);
}
