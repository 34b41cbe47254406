// SPDX-License-Identifier: BSD-3-Clause
#include "FuzzPointFile.h"
#include <knotwork/SplineIO/MeshFiles.h>
#include <knotwork/SplineIO/PointText.h>

namespace
{
/// Corners are points.
void CheckCells(const knotwork::PointFile& file)
{
  for (const auto* cells : { &file.Polygons, &file.Lines })
  {
    for (const std::vector<int>& cell : *cells)
    {
      for (int corner : cell)
      {
        if (corner < 0 || corner >= file.Points.rows())
        {
          std::abort();
        }
      }
    }
  }
}
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace knotwork;
  for (const auto read : { ReadOff, ReadObj, ReadStl })
  {
    CheckPoints(
      data, size, [&](std::string_view text) { return read(text); },
      [](const PointFile& file)
      {
        CheckCells(file);
        return WritePointText(file, ',');
      },
      [](std::string_view text) { return ReadPointText(text, 1); });
  }
  return 0;
}
