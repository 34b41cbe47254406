// SPDX-License-Identifier: BSD-3-Clause
#include "FilterCells.h"

#include "FilterRun.h"
#include <knotwork/SplineCore/WideVectors.h>

namespace knotwork
{
template <>
bool FilterCells<2>(const BernsteinCells& cells, const JacobianParams& params, std::size_t begin,
  std::size_t end, CellCertificate* results)
{
  return FilterRun<Doubles<2>>(cells, params).Run(begin, end, results);
}
}
