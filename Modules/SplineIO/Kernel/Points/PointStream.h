// SPDX-License-Identifier: BSD-3-Clause
// Clouds of points that are read block by block, in memory that does not depend on their size.
#pragma once
#include <knotwork/SplineIO/LasFile.h>

#include <array>
#include <cmath>
#include <memory>

namespace knotwork
{
/// Some points of a stream.
struct PointBlock
{
  std::size_t Count = 0;         ///< 0: the end
  std::vector<double> Positions; ///< 3 Count
  /// A record a point, for a file that PointStream::Head begins; the stream's until the next block.
  const char* Records = nullptr;
};

/// What the header of a file of points tells.
struct PointSummary
{
  std::uint64_t Count = 0;
  RealArray<3> Lower{ HUGE_VAL, HUGE_VAL, HUGE_VAL };
  RealArray<3> Upper{ -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  std::array<std::uint64_t, 16> Returns{}; ///< points by the number of their return

  /// @param returnNumber  below 16.
  void Add(const double* position, unsigned returnNumber);
};

/// Reads a cloud once from its beginning to its end. The records of its points go unchanged into
/// smaller files of points: those of LAS files as they are, points of text and PLY files as all
/// their numbers in double precision.
class PointStream
{
public:
  PointStream() = default;
  PointStream(const PointStream&) = delete;
  PointStream& operator=(const PointStream&) = delete;
  virtual ~PointStream() = default;

  /// The next points. @return failures of the formats, with the place in the file; FileError.
  virtual Status Next(PointBlock& block) = 0;
  /// The beginning of a file of some of the records; its length does not depend on the summary.
  virtual std::string Head(const PointSummary& summary) const = 0;

  std::string Ending; ///< of files of the records: .las or .ply
  std::size_t RecordBytes = 0;
  unsigned ReturnMask = 0;      ///< bits of byte 14 of a record that are its return; 0: it has none
  std::uint64_t NumPoints = 0;  ///< that the header tells; 0: none
  std::uint64_t MostPoints = 0; ///< that there may be, where the header tells no number; 0: any
  bool HasBox = false;
  RealArray<3> Lower{}; ///< that the header tells
  RealArray<3> Upper{};
  std::string ReferenceSystem;
  std::vector<std::string> Warnings;
  std::vector<std::string> LeftOut;

protected:
  std::uint64_t Size = 0;  ///< of the file, bytes
  std::uint64_t Place = 0; ///< bytes that have been read
};

/// The beginning of a binary PLY file of points whose records are all their numbers in double
/// precision. @param names  of those behind x, y, z.
std::string HeadOfNumbers(const std::vector<std::string>& names, std::uint64_t count);

/// Endings of the files that are streams: .las .xyz .txt .csv .ply (and .laz, to refuse it).
bool IsStreamed(const std::string& ending);

/// Opens a cloud: the header, or the first lines, are read and verified.
/// @param ending  of the file's name, in lower case with the dot: its format.
/// @param source  must outlive the stream.
/// @return InvalidParameter for another ending; failures of ReadLasHeader; InvalidFormat,
/// EmptyInput as ReadPointText and ReadPly say, also for PLY files that the points do not begin.
Result<std::shared_ptr<PointStream>> OpenPointStream(
  const std::string& ending, const ByteSource& source, int threads);
}
