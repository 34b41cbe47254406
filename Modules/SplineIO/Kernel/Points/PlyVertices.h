// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Private to the readers of PLY files.
namespace knotwork
{
/// Ascending by their sizes.
enum class PlyScalar
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Float,
  Double
};

/// The vertices of a PLY file whose rows are read piece by piece.
struct PlyVertices
{
  bool IsAscii = false;
  bool IsBigEndian = false;
  std::size_t Begin = 0;     ///< of the first row
  std::size_t HeadLines = 0; ///< lines before it
  std::uint64_t Count = 0;
  std::vector<PlyScalar> Types;          ///< of the properties
  std::array<std::size_t, 3> Position{}; ///< properties that are x, y, z
  std::vector<Eigen::Index> Channels;    ///< by property, -1 for coordinates
  std::vector<std::string> Names;        ///< of the channels
  std::vector<std::string> LeftOut;      ///< elements that are not vertices

  /// Of a binary row.
  std::size_t RowBytes() const;
};

/// Finds them in the beginning of a file, which holds its header.
/// @return InvalidFormat, also where another element comes first.
Result<PlyVertices> FindPlyVertices(std::string_view beginning);

/// Appends the numbers of binary rows, all properties of a row together.
/// @param first  number of the first row, for messages. @return NonFiniteInput naming the vertex.
Status ReadPlyRows(const PlyVertices& vertices, std::string_view rows, std::uint64_t first,
  std::vector<double>& numbers);
}
