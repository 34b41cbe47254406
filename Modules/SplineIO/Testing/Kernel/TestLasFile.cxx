// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineIO/LasFile.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
template <typename T>
void Put(std::string& bytes, std::size_t at, T value)
{
  // tests run on little-endian machines
  bytes.replace(at, sizeof(T), reinterpret_cast<const char*>(&value), sizeof(T));
}

const std::string Wkt = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";

/// A file of version 1.minor: a record with the WKT, three points of a format with `extra` bytes,
/// and (1.4) a record behind them.
std::string MakeLas(int minor, int format, std::size_t extra = 0)
{
  const std::size_t head = minor < 3 ? 227 : minor == 3 ? 235 : 375;
  const std::size_t sizes[] = { 20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67 };
  const std::size_t record = sizes[format] + extra;
  const std::size_t begin = head + 54 + Wkt.size();
  std::string bytes(begin + 3 * record, '\0');
  std::memcpy(bytes.data(), "LASF", 4);
  Put<std::uint8_t>(bytes, 24, 1);
  Put<std::uint8_t>(bytes, 25, static_cast<std::uint8_t>(minor));
  Put<std::uint16_t>(bytes, 94, static_cast<std::uint16_t>(head));
  Put<std::uint32_t>(bytes, 96, static_cast<std::uint32_t>(begin));
  Put<std::uint32_t>(bytes, 100, 1);
  Put<std::uint8_t>(bytes, 104, static_cast<std::uint8_t>(format));
  Put<std::uint16_t>(bytes, 105, static_cast<std::uint16_t>(record));
  Put<std::uint32_t>(bytes, 107, format < 6 ? 3 : 0);
  for (std::size_t d = 0; d < 3; ++d)
  {
    Put<double>(bytes, 131 + 8 * d, 0.01);
    Put<double>(bytes, 155 + 8 * d, 500000.0);
    Put<double>(bytes, 179 + 16 * d, 500010.0);
    Put<double>(bytes, 187 + 16 * d, 499990.0);
  }
  std::memcpy(bytes.data() + head + 2, "LASF_Projection", 15);
  Put<std::uint16_t>(bytes, head + 18, 2112);
  Put<std::uint16_t>(bytes, head + 20, static_cast<std::uint16_t>(Wkt.size()));
  std::memcpy(bytes.data() + head + 54, Wkt.data(), Wkt.size());
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::size_t at = begin + i * record;
    for (std::size_t d = 0; d < 3; ++d)
    {
      Put<std::int32_t>(bytes, at + 4 * d, static_cast<std::int32_t>(100 * i + d) - 100);
    }
    Put<std::uint16_t>(bytes, at + 12, static_cast<std::uint16_t>(65000 + i));
  }
  if (minor == 4)
  {
    Put<std::uint64_t>(bytes, 247, 3);
    Put<std::uint64_t>(bytes, 235, bytes.size());
    Put<std::uint32_t>(bytes, 243, 1);
    bytes.resize(bytes.size() + 60 + 8);
    Put<std::uint64_t>(bytes, bytes.size() - 48, 8);
  }
  return bytes;
}

template <typename T>
std::string With(std::string bytes, std::size_t at, T value)
{
  Put<T>(bytes, at, value);
  return bytes;
}

struct BadHeader
{
  const char* Name;
  std::string Bytes;
  ErrorCode Code;
  std::vector<std::string> Words; ///< that the message must have
};

void PrintTo(const BadHeader& one, std::ostream* stream)
{
  *stream << one.Name;
}

std::vector<BadHeader> BadHeaders()
{
  const auto format = ErrorCode::InvalidFormat;
  const std::string old = MakeLas(2, 2);
  const std::string now = MakeLas(4, 6);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
    { "Empty", "", format, { "begins with 'LASF'" } },
    { "OtherFile", "ply\nformat ascii 1.0\n", format, { "begins with 'LASF'" } },
    { "HeaderEnds", old.substr(0, 200), format, { "200 bytes", "truncated" } },
    { "LongHeaderEnds", now.substr(0, 300), format, { "300 bytes", "truncated" } },
    { "Version2", With<std::uint8_t>(old, 24, 2), format, { "version 2.2" } },
    { "Version15", With<std::uint8_t>(old, 25, 5), format, { "version 1.5", "convert" } },
    { "ShortHeader", With<std::uint16_t>(old, 94, 100), format, { "100 bytes", "227" } },
    { "ShortHeader14", With<std::uint16_t>(now, 94, 227), format, { "227 bytes", "375" } },
    { "Compressed", With<std::uint8_t>(old, 104, 130), format, { "LAZ", "laszip", "pdal" } },
    { "FormatOfLater", With<std::uint8_t>(old, 104, 6), format, { "point format 6", "0 to 3" } },
    { "FormatUnknown", With<std::uint8_t>(now, 104, 11), format, { "point format 11", "0 to 10" } },
    { "ShortRecord", With<std::uint16_t>(old, 105, 25), format, { "25 bytes", "at least 26" } },
    { "NoRecord", With<std::uint16_t>(old, 105, 0), format, { "0 bytes", "at least 26" } },
    { "PointsInHeader", With<std::uint32_t>(old, 96, 226), format, { "byte 226", "227" } },
    { "PointsBehindEnd", With<std::uint32_t>(old, 96, 4000000000U), format, { "truncated" } },
    { "ManyPoints", With<std::uint32_t>(old, 107, 4), format, { "4 points", "room for 3" } },
    { "CountOverflows", With<std::uint64_t>(now, 247, ~std::uint64_t{ 0 }), format,
      { "18446744073709551615 points", "room for" } },
    { "CountsDiffer", With<std::uint32_t>(now, 107, 2), format, { "3 points", "2 in 32" } },
    { "NoPoints", With<std::uint32_t>(old, 107, 0), ErrorCode::EmptyInput, { "no points" } },
    { "Truncated", old.substr(0, old.size() - 1), format, { "3 points", "room for 2" } },
    { "NoScale", With<double>(old, 131, 0.0), format, { "coordinate 0", "scale 0" } },
    { "ScaleIsNan", With<double>(old, 139, nan), format, { "coordinate 1", "nan" } },
    { "OffsetIsInfinite", With<double>(old, 171, HUGE_VAL), format, { "coordinate 2", "inf" } },
    { "ScaleOverflows", With<double>(old, 147, 1e300), format, { "coordinate 2", "1e+300" } },
    { "ManyRecords", With<std::uint32_t>(old, 100, 4000000000U), format,
      { "record 1 of 4000000000" } },
    { "LongRecord", With<std::uint16_t>(old, 247, 60000), format, { "record 0 of 1" } },
    { "RecordsBehindEnd", With<std::uint64_t>(now, 235, std::uint64_t{ 1 } << 60U), format,
      { "1152921504606846976", "truncated" } },
    { "RecordsAmongPoints", With<std::uint64_t>(now, 235, 400), format, { "byte 400" } },
    { "ManyRecordsBehind", With<std::uint32_t>(now, 243, 3), format, { "record 1 of 3" } },
    { "LongRecordBehind", With<std::uint64_t>(now, now.size() - 48, ~std::uint64_t{ 0 }), format,
      { "record 0 of 1", "ends within it" } },
  };
}

class LasHeaders : public ::testing::TestWithParam<BadHeader>
{
};
}

TEST(LasFile, EveryFormatHasItsPoints_GoldenOracle)
{
  for (int format = 0; format <= 10; ++format)
  {
    const int least = format < 2 ? 0 : format < 4 ? 2 : format < 6 ? 3 : 4;
    for (int minor = least; minor <= 4; ++minor)
    {
      SCOPED_TRACE(std::to_string(minor) + ", format " + std::to_string(format));
      const auto file = ReadLas(MakeLas(minor, format, format % 3));
      ASSERT_TRUE(file) << file.Status.Message();
      ASSERT_EQ(file->Points.rows(), 3);
      EXPECT_EQ(file->Points(0, 0), 0.01 * -100 + 500000.0);
      EXPECT_EQ(file->Points(2, 2), 0.01 * 102 + 500000.0);
      EXPECT_EQ(file->Names, LasChannels(format));
      EXPECT_EQ(file->Channels(1, 0), 65001);
      EXPECT_EQ(file->ReferenceSystem, Wkt);
      EXPECT_TRUE(file->Warnings.empty());
    }
  }
}

TEST(LasFile, BitsOfARecordMeanWhatTheSpecificationSays_GoldenOracle)
{
  std::string old = MakeLas(2, 3);
  const std::size_t at = 227 + 54 + Wkt.size();
  Put<std::uint8_t>(old, at + 14, 0b11'011'010);
  Put<std::uint8_t>(old, at + 15, 0b101'00010);
  Put<double>(old, at + 20, 0.1);
  Put<std::uint16_t>(old, at + 30, 40000);
  auto file = ReadLas(old);
  ASSERT_TRUE(file) << file.Status.Message();
  Eigen::RowVectorXd values(9);
  values << 65000, 2, 3, 2, 5, 0.1, 0, 40000, 0;
  EXPECT_EQ(file->Channels.row(0), values);
  std::string now = MakeLas(4, 8);
  const std::size_t there = 375 + 54 + Wkt.size();
  Put<std::uint8_t>(now, there + 14, 0xc9);
  Put<std::uint8_t>(now, there + 15, 0b1101'1010);
  Put<std::uint8_t>(now, there + 16, 200);
  Put<double>(now, there + 22, 1e9 + 0.25);
  Put<std::uint16_t>(now, there + 34, 3);
  Put<std::uint16_t>(now, there + 36, 65535);
  file = ReadLas(now);
  ASSERT_TRUE(file) << file.Status.Message();
  values.resize(10);
  values << 65000, 9, 12, 200, 10, 1e9 + 0.25, 0, 0, 3, 65535;
  EXPECT_EQ(file->Channels.row(0), values);
}

TEST(LasFile, OldCountAloneCounts)
{
  EXPECT_TRUE(ReadLas(With<std::uint64_t>(With<std::uint32_t>(MakeLas(4, 1), 107, 3), 247, 0)));
}

TEST(LasFile, ACountThatIsTooSmallIsTold)
{
  const auto file = ReadLas(With<std::uint32_t>(MakeLas(2, 2), 107, 2));
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Points.rows(), 2);
  ASSERT_EQ(file->Warnings.size(), 1U);
  EXPECT_NE(file->Warnings[0].find("26 bytes"), std::string::npos) << file->Warnings[0];
}

TEST(LasFile, KeysOfTheReferenceSystemAreKept_GoldenOracle)
{
  std::string bytes = With<std::uint16_t>(MakeLas(2, 2), 227 + 18, 34735);
  for (std::size_t i = 0; i < Wkt.size(); ++i)
  {
    bytes[227 + 54 + i] = static_cast<char>(i % 2 == 0 ? i : 0);
  }
  const auto file = ReadLas(bytes);
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->ReferenceSystem, "GeoKeyDirectory 0 2 4 6 8 10 12 14 16 18 20 22 24 26 28 30");
}

TEST_P(LasHeaders, AreOneClearError)
{
  const BadHeader& one = GetParam();
  const auto file = ReadLas(one.Bytes);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.Status.Code, one.Code) << file.Status.Message();
  EXPECT_EQ(file.Status.Detail.find('\n'), std::string::npos);
  for (const std::string& word : one.Words)
  {
    EXPECT_NE(file.Status.Detail.find(word), std::string::npos) << file.Status.Detail;
  }
}

INSTANTIATE_TEST_SUITE_P(
  All, LasHeaders, ::testing::ValuesIn(BadHeaders()), [](const auto& i) { return i.param.Name; });

TEST(LasFile, DamagedBytesAreAnErrorOrPointsWithinTheFile_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 4000; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::string bytes = random() % 2 == 0 ? MakeLas(2, 3) : MakeLas(4, 7);
    for (unsigned i = 0; i < 1 + seed % 4; ++i)
    {
      bytes[random() % std::min<std::size_t>(bytes.size(), 460)] = static_cast<char>(random());
    }
    bytes.resize(seed % 3 == 0 ? random() % bytes.size() : bytes.size());
    const auto file = ReadLas(bytes);
    if (file)
    {
      EXPECT_LE(static_cast<std::size_t>(file->Points.rows()) * 20, bytes.size());
      EXPECT_TRUE(file->Points.allFinite());
    }
    else
    {
      EXPECT_FALSE(file.Status.Detail.empty());
    }
  }
}

TEST(LasFile, BytesThatCannotBeReadAreAnError)
{
  const ByteSource source{ 1000, [](std::uint64_t, char*, std::size_t) { return false; } };
  EXPECT_EQ(ReadLasHeader(source).Status.Code, ErrorCode::FileError);
}
