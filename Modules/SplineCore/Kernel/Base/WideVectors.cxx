// SPDX-License-Identifier: BSD-3-Clause
#include "WideVectors.h"

#ifdef KNOTWORK_HAS_WIDE_VECTORS
#include <sys/platform/x86.h>

namespace knotwork
{
bool HasWideVectors()
{
  static const bool has = CPU_FEATURE_ACTIVE(AVX2) && CPU_FEATURE_ACTIVE(FMA);
  return has;
}
}
#endif
