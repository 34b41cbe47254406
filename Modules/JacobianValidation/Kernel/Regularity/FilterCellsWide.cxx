// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCells.h"

#include "FormLayout.h"
#include "RoundingBound.h"
#include <knotwork/SplineCore/WideVectors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

// All headers but those of templates on the pack stand above: what any other source may share with
// this one has to run on every processor.
#ifdef KNOTWORK_HAS_WIDE_VECTORS
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
#include "FilterRun.h"

namespace knotwork
{
template <>
bool FilterCells<4>(const BernsteinCells& cells, const JacobianParams& params, std::size_t begin,
  std::size_t end, CellCertificate* results)
{
  return FilterRun<Doubles<4>>(cells, params).Run(begin, end, results);
}
}
#ifdef KNOTWORK_HAS_WIDE_VECTORS
#pragma GCC pop_options
#endif
