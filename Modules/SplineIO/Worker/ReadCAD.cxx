// SPDX-License-Identifier: BSD-3-Clause
// usage: knotwork-read-cad PARENT BYTES SECONDS FILE UNIT TOLERANCE
// Reads STEP and IGES files by OpenCASCADE for another process, see WorkerMain.h.
#include "CADParts.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineGrid/WorkerMain.h>

namespace
{
using namespace knotwork;

Status Read(const Parts& words, const Parts&, Parts& found)
{
  if (words.size() != 3)
  {
    return { ErrorCode::InvalidParameter, "file, unit or tolerance is missing" };
  }
  const std::string& file = words[0];
  CADReadParams params;
  params.Unit = static_cast<LengthUnit>(std::stoi(words[1]));
  params.Tolerance = ExactNumber(words[2]);
  const auto contents = ReadCAD(file, params);
  return contents ? AppendCAD(contents.Value, found) : contents.Status;
}
}

int main(int argc, char* argv[])
{
  knotwork::WorkerMain(argc, argv, Read);
}
