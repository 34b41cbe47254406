// SPDX-License-Identifier: BSD-3-Clause
// LAS files, the format of laser scans, uncompressed. Records are decoded as they come, so a file
// need not be in memory.
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <cstdint>
#include <functional>
#include <string_view>

namespace knotwork
{
/// Bytes of a file that need not be in memory.
struct ByteSource
{
  std::uint64_t Size = 0;
  /// Copies `count` bytes from `at` on. @return false: they cannot be read.
  std::function<bool(std::uint64_t at, char* to, std::size_t count)> Read;
};

/// Where the records of a LAS file are and what they mean.
struct LasHeader
{
  int Minor = 2;               ///< of version 1.Minor
  int PointFormat = 0;         ///< 0 to 10
  std::size_t RecordBytes = 0; ///< of a point, extra bytes included
  std::uint64_t NumPoints = 0;
  std::uint64_t Begin = 0; ///< of the first point
  RealArray<3> Scale{};    ///< coordinate = Scale * stored integer + Offset
  RealArray<3> Offset{};
  RealArray<3> Lower{}; ///< of the box that the header tells; not verified
  RealArray<3> Upper{};
  /// The WKT of the file, or its GeoTIFF keys as text: `GeoKeyDirectory` and the numbers, then
  /// `GeoDoubleParams` and `GeoAsciiParams` where there are such. Empty: the file has none.
  std::string ReferenceSystem;
  std::vector<std::string> Warnings;
};

/// Reads and verifies the header and the records of the coordinate reference system of a LAS file,
/// versions 1.0 to 1.4. Counts are those of 64 bits where the version has them.
/// @return InvalidFormat naming the field: no LAS file, a version, point format or sizes that do
/// not go together, counts that contradict each other, scales or offsets that are no numbers,
/// records or points that the file has no room for (it is truncated), a compressed file (LAZ, COPC:
/// it names a program that decompresses); EmptyInput without points; FileError.
/// @complexity time and memory O(bytes before the points and of records behind them).
/// @source  ASPRS, LAS Specification 1.4 - R15 (2019), and those of versions 1.0 to 1.3.
Result<LasHeader> ReadLasHeader(const ByteSource& source);

/// Names of the channels of a point format: Intensity, ReturnNumber, NumberOfReturns,
/// Classification, Flags (1 synthetic, 2 key point, 4 withheld, 8 overlap, added up), then, where
/// the format has them, GpsTime, RGB:0 to RGB:2 (of 16 bits), NearInfrared.
std::vector<std::string> LasChannels(int pointFormat);

/// The coordinates of a record, in double precision as the specification says.
RealArray<3> LasPoint(const LasHeader& header, const char* record);

/// The channels of a record. @param values  as many as LasChannels has names.
void LasValues(const LasHeader& header, const char* record, double* values);

/// All points of a LAS file with their channels. Extra bytes and wave packets are skipped.
/// @return failures of ReadLasHeader. @complexity time and memory O(size of the text), whatever
/// counts the header claims.
Result<PointFile> ReadLas(std::string_view text);
}
