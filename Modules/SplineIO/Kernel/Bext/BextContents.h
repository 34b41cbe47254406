// SPDX-License-Identifier: BSD-3-Clause
// What files of extraction operators hold, whether text or JSON; private to the kernel.
#pragma once
#include <knotwork/SplineCore/ExplicitSpace.h>
#include <knotwork/SplineIO/SplineFile.h>

#include <string_view>

namespace knotwork
{
struct BextContents
{
  int PatchId = 0;
  int Dimension = 0;
  bool Rational = false;
  PointMatrix Nodes;        ///< x, y, z, weight
  ExtractionTable<3> Table; ///< degrees 0 in directions that there are not
};

/// Neighbouring elements of the same degrees and number of functions.
struct BextBlock
{
  std::size_t Begin = 0;
  std::size_t End = 0;
};
std::vector<BextBlock> BlocksOf(const ExtractionTable<3>& table);

/// @param first  number of the first element, control point and vector in messages.
Result<SplineFile> FileOfContents(const BextContents& contents, int first);

Result<BextContents> ContentsOfFile(const SplineFile& file);

Result<SplineFile> ReadBextText(std::string_view text);
Result<SplineFile> ReadBextJson(std::string_view text);
}
