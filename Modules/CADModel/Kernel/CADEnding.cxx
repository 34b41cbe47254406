// SPDX-License-Identifier: BSD-3-Clause
// Apart from all that needs OpenCASCADE.
#include "CADExchange.h"

#include <knotwork/SplineCore/FileEnding.h>

namespace knotwork
{
bool HasCADEnding(const std::string& file)
{
  const std::string ending = LowerEnding(file);
  return ending == ".step" || ending == ".stp" || ending == ".iges" || ending == ".igs" ||
    ending == ".brep";
}
}
