// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-read-cad PARENT BYTES SECONDS FILE UNIT TOLERANCE
// Reads STEP and IGES files by OpenCASCADE for another process, see Worker.h.
#include "CADParts.h"
#include "Worker.h"
#include <knotwork/CADModel/CADExchange.h>

namespace
{
using namespace knotwork;

Status Read(const std::string& file, const Parts& options, Parts& found)
{
  CADReadParams params;
  if (options.size() != 2)
  {
    return { ErrorCode::InvalidParameter, "'" + file + "': unit and tolerance are missing" };
  }
  params.Unit = static_cast<LengthUnit>(std::stoi(options[0]));
  params.Tolerance = ExactNumber(options[1]);
  const auto contents = ReadCAD(file, params);
  return contents ? AppendCAD(contents.Value, found) : contents.Status;
}
}

int main(int argc, char* argv[])
{
  knotwork::RunWorker(argc, argv, Read);
}
