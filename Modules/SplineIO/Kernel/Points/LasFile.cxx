// SPDX-License-Identifier: BSD-3-Clause
#include "LasFile.h"

#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace knotwork
{
namespace
{
constexpr std::size_t RecordHead = 54;          ///< of a variable length record
constexpr std::size_t ExtendedRecordHead = 60;  ///< the same behind the points
constexpr std::size_t ShortestHead = 227;       ///< header of versions 1.0 to 1.2
constexpr std::size_t LongestHead = 375;        ///< header of version 1.4
constexpr unsigned CompressedBits = 128U | 64U; ///< of the point format, as LAZ sets them
constexpr const char* Repair = "; write the file again by the program that made it";

/// Least bytes of the header, and the largest point format, of version 1.0 to 1.4.
constexpr std::array<std::size_t, 5> HeadBytes = { 227, 227, 227, 235, 375 };
constexpr std::array<int, 5> LargestFormat = { 1, 1, 3, 5, 10 };
/// Least bytes of a point of format 0 to 10.
constexpr std::array<std::size_t, 11> PointBytes = { 20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67 };
/// Where a point of format 0 to 10 has its time, its colour and its infrared; 0: nowhere.
constexpr std::array<std::size_t, 11> TimeAt = { 0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22 };
constexpr std::array<std::size_t, 11> ColorAt = { 0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30 };
constexpr std::array<std::size_t, 11> InfraredAt = { 0, 0, 0, 0, 0, 0, 0, 0, 36, 0, 36 };

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Little-endian, as LAS files are on every machine.
template <typename T>
T Number(const char* bytes)
{
  std::uint64_t bits = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
  {
    bits = bits << 8U | static_cast<unsigned char>(bytes[i]);
  }
  if constexpr (std::is_same_v<T, double>)
  {
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  else
  {
    return static_cast<T>(bits);
  }
}

unsigned Byte(const char* record, std::size_t at)
{
  return static_cast<unsigned char>(record[at]);
}

/// The fewest digits that give the same number.
std::string ExactText(double value)
{
  std::array<char, 32> text{};
  return { text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr };
}

/// Text of a fixed room, up to its first 0.
std::string TextOf(const std::string& bytes)
{
  return bytes.substr(0, bytes.find('\0'));
}

class HeaderReader
{
public:
  explicit HeaderReader(const ByteSource& source) : Source(source) {}

  Result<LasHeader> Read()
  {
    this->ReadHead();
    this->CheckPoints();
    this->ReadRecords();
    this->ReadExtendedRecords();
    if (!this->Outcome)
    {
      return this->Outcome;
    }
    this->JoinReferenceSystem();
    return std::move(this->Header);
  }

private:
  void Fail(const std::string& what, ErrorCode code = ErrorCode::InvalidFormat)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, what };
    }
  }

  /// Bytes of the file; none where it has fewer.
  std::string Bytes(std::uint64_t at, std::uint64_t count)
  {
    std::string bytes;
    if (this->Outcome && at <= this->Source.Size && count <= this->Source.Size - at)
    {
      bytes.resize(static_cast<std::size_t>(count));
      if (count > 0 && !this->Source.Read(at, bytes.data(), bytes.size()))
      {
        this->Fail("its bytes cannot be read; check the disk", ErrorCode::FileError);
        bytes.clear();
      }
    }
    return bytes;
  }

  template <typename T>
  T Get(std::size_t at) const
  {
    return Number<T>(this->Head.data() + at);
  }

  void ReadHead()
  {
    this->Head = this->Bytes(0, std::min<std::uint64_t>(this->Source.Size, LongestHead));
    if (this->Head.substr(0, 4) != "LASF")
    {
      this->Fail("a LAS file begins with 'LASF'; check what kind of file it is");
      return;
    }
    if (this->Head.size() < ShortestHead)
    {
      this->Fail("the header of the LAS file ends after " + std::to_string(this->Head.size()) +
        " bytes; the file is truncated, fetch it again");
      return;
    }
    const unsigned major = Byte(this->Head.data(), 24);
    const unsigned minor = Byte(this->Head.data(), 25);
    if (major != 1 || minor > 4)
    {
      this->Fail("it has version " + std::to_string(major) + "." + std::to_string(minor) +
        " of LAS; versions 1.0 to 1.4 are read, convert it");
      return;
    }
    this->Header.Minor = static_cast<int>(minor);
    const auto headBytes = std::size_t{ this->Get<std::uint16_t>(94) };
    if (headBytes < HeadBytes[minor] || this->Head.size() < HeadBytes[minor])
    {
      this->Fail(headBytes < HeadBytes[minor]
          ? "its header tells " + std::to_string(headBytes) + " bytes for itself, version 1." +
            std::to_string(minor) + " has at least " + std::to_string(HeadBytes[minor]) + Repair
          : "the header of the LAS file ends after " + std::to_string(this->Head.size()) +
            " bytes; the file is truncated, fetch it again");
      return;
    }
    this->HeadEnd = headBytes;
    const unsigned format = Byte(this->Head.data(), 104);
    if ((format & CompressedBits) != 0)
    {
      this->Fail("its points are compressed (LAZ or COPC); decompress it with `laszip` or `pdal "
                 "translate` to .las");
      return;
    }
    if (format > static_cast<unsigned>(LargestFormat[minor]))
    {
      this->Fail("it has point format " + std::to_string(format) + ", version 1." +
        std::to_string(minor) + " has 0 to " + std::to_string(LargestFormat[minor]) + Repair);
      return;
    }
    this->Header.PointFormat = static_cast<int>(format);
    this->Header.RecordBytes = this->Get<std::uint16_t>(105);
    if (this->Header.RecordBytes < PointBytes[format])
    {
      this->Fail("its points have " + std::to_string(this->Header.RecordBytes) +
        " bytes each, those of point format " + std::to_string(format) + " have at least " +
        std::to_string(PointBytes[format]) + Repair);
    }
    this->Header.Begin = this->Get<std::uint32_t>(96);
    this->ReadCounts();
    this->ReadScales();
  }

  void ReadCounts()
  {
    const std::uint64_t legacy = this->Get<std::uint32_t>(107);
    const std::uint64_t count = this->Header.Minor < 4 ? legacy : this->Get<std::uint64_t>(247);
    // some writers of version 1.4 fill in the old count alone
    this->Header.NumPoints = count == 0 ? legacy : count;
    if (legacy != 0 && legacy != this->Header.NumPoints)
    {
      this->Fail("its header tells " + std::to_string(count) + " points in 64 bits, but " +
        std::to_string(legacy) + " in 32" + Repair);
    }
  }

  void ReadScales()
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      this->Header.Scale[d] = this->Get<double>(131 + 8 * d);
      this->Header.Offset[d] = this->Get<double>(155 + 8 * d);
      this->Header.Upper[d] = this->Get<double>(179 + 16 * d);
      this->Header.Lower[d] = this->Get<double>(187 + 16 * d);
      constexpr double largest = 2147483648.0; // of stored integers
      if (!(this->Header.Scale[d] > 0.0) ||
        !std::isfinite(this->Header.Scale[d] * largest + std::fabs(this->Header.Offset[d])))
      {
        this->Fail("its coordinate " + std::to_string(d) + " has the scale " +
          Digits(this->Header.Scale[d]) + " and the offset " + Digits(this->Header.Offset[d]) +
          "; a scale is above 0 and both are numbers" + Repair);
      }
    }
  }

  void CheckPoints()
  {
    if (!this->Outcome)
    {
      return;
    }
    if (this->Header.Begin < this->HeadEnd)
    {
      this->Fail("its points would begin at byte " + std::to_string(this->Header.Begin) +
        ", within the header of " + std::to_string(this->HeadEnd) + " bytes" + Repair);
      return;
    }
    const std::uint64_t size = this->Source.Size;
    const std::uint64_t room =
      size < this->Header.Begin ? 0 : (size - this->Header.Begin) / this->Header.RecordBytes;
    if (size < this->Header.Begin || this->Header.NumPoints > room)
    {
      this->Fail("its header tells " + std::to_string(this->Header.NumPoints) +
        " points, the file has room for " + std::to_string(room) +
        "; it is truncated, fetch it again");
      return;
    }
    if (this->Header.NumPoints == 0)
    {
      this->Fail("the LAS file holds no points", ErrorCode::EmptyInput);
      return;
    }
    this->PointsEnd = this->Header.Begin + this->Header.NumPoints * this->Header.RecordBytes;
    if (this->Header.Minor < 3 && room > this->Header.NumPoints)
    {
      this->Header.Warnings.push_back(std::to_string(size - this->PointsEnd) +
        " bytes stand behind the last point of the LAS file; its count of points may be too small");
    }
  }

  void ReadRecords()
  {
    const std::uint32_t count = this->Outcome ? this->Get<std::uint32_t>(100) : 0;
    std::uint64_t at = this->HeadEnd;
    for (std::uint32_t i = 0; i < count && this->Outcome; ++i)
    {
      const std::uint64_t room = this->Header.Begin - at;
      const std::string head = room < RecordHead ? "" : this->Bytes(at, RecordHead);
      const std::uint64_t length = head.empty() ? 0 : Number<std::uint16_t>(head.data() + 20);
      if (head.empty() || length > room - RecordHead)
      {
        this->FailRecord(i, count, "the points begin within it");
        return;
      }
      this->Take(head, at + RecordHead, length);
      at += RecordHead + length;
    }
  }

  void ReadExtendedRecords()
  {
    if (!this->Outcome || this->Header.Minor < 4)
    {
      return;
    }
    std::uint64_t at = this->Get<std::uint64_t>(235);
    const std::uint32_t count = this->Get<std::uint32_t>(243);
    if (count > 0 && (at < this->PointsEnd || at > this->Source.Size))
    {
      this->Fail("its records behind the points would begin at byte " + std::to_string(at) +
        ", the points end at " + std::to_string(this->PointsEnd) + " and the file at " +
        std::to_string(this->Source.Size) + "; it is truncated or damaged, fetch it again");
    }
    for (std::uint32_t i = 0; i < count && this->Outcome; ++i)
    {
      const std::uint64_t room = this->Source.Size - at;
      const std::string head = room < ExtendedRecordHead ? "" : this->Bytes(at, ExtendedRecordHead);
      const std::uint64_t length = head.empty() ? 0 : Number<std::uint64_t>(head.data() + 20);
      if (head.empty() || length > room - ExtendedRecordHead)
      {
        this->FailRecord(i, count, "the file ends within it");
        return;
      }
      this->Take(head, at + ExtendedRecordHead, length);
      at += ExtendedRecordHead + length;
    }
  }

  void FailRecord(std::uint32_t record, std::uint32_t count, const std::string& what)
  {
    this->Fail("variable length record " + std::to_string(record) + " of " + std::to_string(count) +
      ": " + what + "; the file is truncated or damaged, fetch it again");
  }

  /// What a record says of the coordinate reference system.
  void Take(const std::string& head, std::uint64_t at, std::uint64_t length)
  {
    if (TextOf(head.substr(2, 16)) != "LASF_Projection")
    {
      return;
    }
    switch (Number<std::uint16_t>(head.data() + 18))
    {
      case 2112:
        this->Wkt = TextOf(this->Bytes(at, length));
        break;
      case 34735:
        this->Keys = this->Bytes(at, length);
        break;
      case 34736:
        this->Doubles = this->Bytes(at, length);
        break;
      case 34737:
        this->Ascii = TextOf(this->Bytes(at, length));
        break;
      default:
        break;
    }
  }

  void JoinReferenceSystem()
  {
    const bool isWkt = (this->Get<std::uint16_t>(6) & 16U) != 0; // bit of the global encoding
    std::string& text = this->Header.ReferenceSystem;
    if (this->Keys.empty() || (isWkt && !this->Wkt.empty()))
    {
      text = this->Wkt;
      return;
    }
    text = "GeoKeyDirectory";
    for (std::size_t i = 0; i + 2 <= this->Keys.size(); i += 2)
    {
      text += " " + std::to_string(Number<std::uint16_t>(this->Keys.data() + i));
    }
    text += this->Doubles.empty() ? "" : "; GeoDoubleParams";
    for (std::size_t i = 0; i + 8 <= this->Doubles.size(); i += 8)
    {
      text += " " + ExactText(Number<double>(this->Doubles.data() + i));
    }
    text += this->Ascii.empty() ? "" : "; GeoAsciiParams " + this->Ascii;
  }

  const ByteSource& Source;
  std::string Head;
  std::uint64_t HeadEnd = 0;
  std::uint64_t PointsEnd = 0;
  LasHeader Header;
  std::string Wkt;
  std::string Keys;
  std::string Doubles;
  std::string Ascii;
  Status Outcome;
};
}

Result<LasHeader> ReadLasHeader(const ByteSource& source)
{
  return HeaderReader(source).Read();
}

std::vector<std::string> LasChannels(int pointFormat)
{
  std::vector<std::string> names = { "Intensity", "ReturnNumber", "NumberOfReturns",
    "Classification", "Flags" };
  if (TimeAt[At(pointFormat)] > 0)
  {
    names.emplace_back("GpsTime");
  }
  if (ColorAt[At(pointFormat)] > 0)
  {
    names.insert(names.end(), { "RGB:0", "RGB:1", "RGB:2" });
  }
  if (InfraredAt[At(pointFormat)] > 0)
  {
    names.emplace_back("NearInfrared");
  }
  return names;
}

RealArray<3> LasPoint(const LasHeader& header, const char* record)
{
  RealArray<3> point{};
  for (std::size_t d = 0; d < 3; ++d)
  {
    // the specification's two steps, each rounded
    const double scaled = header.Scale[d] * Number<std::int32_t>(record + 4 * d);
    point[d] = scaled + header.Offset[d];
  }
  return point;
}

void LasValues(const LasHeader& header, const char* record, double* values)
{
  const std::size_t format = At(header.PointFormat);
  const unsigned returns = Byte(record, 14);
  const unsigned flags = Byte(record, 15);
  *values++ = Number<std::uint16_t>(record + 12);
  if (format < 6)
  {
    *values++ = returns & 7U;
    *values++ = returns >> 3U & 7U;
    *values++ = flags & 31U;
    *values++ = flags >> 5U;
  }
  else
  {
    *values++ = returns & 15U;
    *values++ = returns >> 4U;
    *values++ = Byte(record, 16);
    *values++ = flags & 15U;
  }
  if (TimeAt[format] > 0)
  {
    *values++ = Number<double>(record + TimeAt[format]);
  }
  for (std::size_t c = 0; c < 3 && ColorAt[format] > 0; ++c)
  {
    *values++ = Number<std::uint16_t>(record + ColorAt[format] + 2 * c);
  }
  if (InfraredAt[format] > 0)
  {
    *values++ = Number<std::uint16_t>(record + InfraredAt[format]);
  }
}

Result<PointFile> ReadLas(std::string_view text)
{
  const ByteSource source{ text.size(),
    [text](std::uint64_t at, char* to, std::size_t count)
    {
      std::memcpy(to, text.data() + at, count);
      return true;
    } };
  auto header = ReadLasHeader(source);
  if (!header)
  {
    return header.Status;
  }
  PointFile file;
  file.Names = LasChannels(header->PointFormat);
  file.ReferenceSystem = header->ReferenceSystem;
  file.Warnings = header->Warnings;
  const auto n = static_cast<Eigen::Index>(header->NumPoints);
  file.Points.resize(n, 3);
  file.Channels.resize(n, static_cast<Eigen::Index>(file.Names.size()));
  const char* record = text.data() + header->Begin;
  for (Eigen::Index i = 0; i < n; ++i, record += header->RecordBytes)
  {
    const RealArray<3> point = LasPoint(header.Value, record);
    std::copy(point.begin(), point.end(), file.Points.row(i).data());
    LasValues(header.Value, record, file.Channels.row(i).data());
  }
  return file;
}
}
