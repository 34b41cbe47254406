// SPDX-License-Identifier: BSD-3-Clause
#include "PointStream.h"

#include "PlyVertices.h"
#include "PointLayout.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace knotwork
{
namespace
{
constexpr std::size_t BlockBytes = std::size_t{ 1 } << 24U;
constexpr const char* Unreadable = "its bytes cannot be read; check the disk";

template <typename T>
void Put(std::string& bytes, std::size_t at, T value)
{
  std::uint64_t bits = 0;
  std::memcpy(
    &bits, &value, sizeof(T)); // little-endian, as on every machine that this is built for
  for (std::size_t i = 0; i < sizeof(T); ++i)
  {
    bytes[at + i] = static_cast<char>(bits >> (8 * i) & 255U);
  }
}

class LasStream : public PointStream
{
public:
  LasStream(const ByteSource& source, LasHeader header)
    : Source(source), Header(std::move(header)), Left(this->Header.NumPoints)
  {
    this->Size = source.Size;
    this->Place = this->Header.Begin;
    this->Ending = ".las";
    this->RecordBytes = this->Header.RecordBytes;
    this->ReturnMask = this->Header.PointFormat < 6 ? 7U : 15U;
    this->NumPoints = this->Header.NumPoints;
    this->HasBox = true;
    this->Lower = this->Header.Lower;
    this->Upper = this->Header.Upper;
    this->ReferenceSystem = this->Header.ReferenceSystem;
    this->Warnings = this->Header.Warnings;
  }

  /// Keeps what stands before the points, for the heads of other files.
  Status KeepHead()
  {
    this->Before.resize(static_cast<std::size_t>(this->Header.Begin));
    return this->Source.Read(0, this->Before.data(), this->Before.size())
      ? Status()
      : Status(ErrorCode::FileError, Unreadable);
  }

  Status Next(PointBlock& block) override
  {
    block.Count = static_cast<std::size_t>(std::min<std::uint64_t>(
      this->Left, std::max<std::size_t>(1, BlockBytes / this->RecordBytes)));
    this->Bytes.resize(block.Count * this->RecordBytes);
    if (block.Count > 0 && !this->Source.Read(this->Place, this->Bytes.data(), this->Bytes.size()))
    {
      return { ErrorCode::FileError, Unreadable };
    }
    this->Place += this->Bytes.size();
    this->Left -= block.Count;
    block.Records = this->Bytes.data();
    block.Positions.resize(3 * block.Count);
    for (std::size_t i = 0; i < block.Count; ++i)
    {
      const RealArray<3> point = LasPoint(this->Header, block.Records + i * this->RecordBytes);
      std::copy(point.begin(), point.end(), block.Positions.begin() + 3 * static_cast<long>(i));
    }
    return {};
  }

  std::string Head(const PointSummary& summary) const override
  {
    std::string head = this->Before;
    const bool hasOldCount = this->Header.PointFormat < 6 && summary.Count <= 0xffffffffU;
    const auto old = [&](std::uint64_t count)
    { return static_cast<std::uint32_t>(hasOldCount ? count : 0); };
    Put(head, 107, old(summary.Count));
    for (std::size_t r = 0; r < 5; ++r)
    {
      Put(head, 111 + 4 * r, old(summary.Returns[r + 1]));
    }
    for (std::size_t d = 0; d < 3; ++d)
    {
      Put(head, 179 + 16 * d, summary.Upper[d]);
      Put(head, 187 + 16 * d, summary.Lower[d]);
    }
    if (this->Header.Minor >= 3)
    {
      Put(head, 227, std::uint64_t{ 0 }); // no wave packets
    }
    if (this->Header.Minor >= 4)
    {
      Put(head, 235, std::uint64_t{ 0 }); // no records behind the points
      Put(head, 243, std::uint32_t{ 0 });
      Put(head, 247, summary.Count);
      for (std::size_t r = 0; r < 15; ++r)
      {
        Put(head, 255 + 8 * r, summary.Returns[r + 1]);
      }
    }
    return head;
  }

private:
  const ByteSource& Source;
  LasHeader Header;
  std::uint64_t Left; ///< points to be read
  std::string Before;
  std::string Bytes;
};

/// Points whose records are all their numbers.
class NumberStream : public PointStream
{
public:
  NumberStream(const ByteSource& source, std::vector<std::string> names)
    : Source(source), Names(std::move(names))
  {
    this->Size = source.Size;
    this->Ending = ".ply";
    this->RecordBytes = sizeof(double) * (3 + this->Names.size());
  }

  std::string Head(const PointSummary& summary) const override
  {
    return HeadOfNumbers(this->Names, summary.Count);
  }

protected:
  /// The next bytes of the file, at most as many.
  Result<std::string> Bytes(std::uint64_t most)
  {
    std::string bytes(
      static_cast<std::size_t>(std::min<std::uint64_t>(most, this->Size - this->Place)), '\0');
    if (!bytes.empty() && !this->Source.Read(this->Place, bytes.data(), bytes.size()))
    {
      return { ErrorCode::FileError, Unreadable };
    }
    this->Place += bytes.size();
    return bytes;
  }

  /// Rows of numbers become points. @param others  columns that are not coordinates.
  void AddRows(const std::vector<double>& numbers, std::size_t columns,
    const std::array<std::size_t, 3>& position, const std::vector<std::size_t>& others,
    PointBlock& block)
  {
    for (std::size_t at = 0; at + columns <= numbers.size(); at += columns)
    {
      for (const std::size_t column : position)
      {
        block.Positions.push_back(column == NoColumn ? 0.0 : numbers[at + column]);
        this->Records.push_back(numbers[at + column]);
      }
      for (const std::size_t column : others)
      {
        this->Records.push_back(numbers[at + column]);
      }
      ++block.Count;
    }
    block.Records = reinterpret_cast<const char*>(this->Records.data());
  }

  const ByteSource& Source;
  std::vector<std::string> Names;
  std::vector<double> Records;
};

/// Lines of numbers.
class TextStream : public NumberStream
{
public:
  /// @param most  points; 0: all lines.
  TextStream(const ByteSource& source, PointLayout layout, std::vector<std::string> names,
    std::vector<std::size_t> others, std::uint64_t most, int threads)
    : NumberStream(source, std::move(names)), Layout(std::move(layout)), Others(std::move(others)),
      Left(most), IsCounted(most > 0), Threads(threads)
  {
    this->Place = this->Layout.Begin;
    this->Layout.Begin = 0;
    this->NumPoints = most;
  }

  Status Next(PointBlock& block) override
  {
    block.Count = 0;
    block.Positions.clear();
    this->Records.clear();
    while (block.Count == 0 && (this->Place < this->Size || !this->Rest.empty()) &&
      !(this->IsCounted && this->Left == 0))
    {
      auto text = this->NextLines();
      if (!text)
      {
        return text.Status;
      }
      auto chunks = ReadColumns(text.Value, this->Layout, this->Threads);
      if (!chunks)
      {
        return chunks.Status;
      }
      for (const std::vector<double>& numbers : chunks.Value)
      {
        this->AddRows(numbers, this->Layout.Count, this->Layout.Position, this->Others, block);
      }
      this->Layout.LinesBefore +=
        static_cast<std::size_t>(std::count(text->begin(), text->end(), '\n'));
      this->Left -= this->IsCounted ? block.Count : 0;
    }
    if (this->IsCounted && block.Count == 0 && this->Left > 0)
    {
      return { ErrorCode::InvalidFormat,
        std::to_string(this->Left) + " of " + std::to_string(this->NumPoints) +
          " points are missing; the file is truncated, fetch it again" };
    }
    return {};
  }

private:
  /// Whole lines, as many as are still to be read.
  Result<std::string> NextLines()
  {
    auto bytes = this->Bytes(BlockBytes);
    if (!bytes)
    {
      return bytes;
    }
    std::string text = std::move(this->Rest);
    text += bytes.Value;
    const std::size_t end = text.rfind('\n');
    if (this->Place < this->Size && end == std::string::npos)
    {
      return { ErrorCode::InvalidFormat,
        "line " + std::to_string(this->Layout.LinesBefore + 1) +
          " is longer than 16 MB; a line has one point" };
    }
    this->Rest.clear();
    if (this->Place < this->Size)
    {
      this->Rest = text.substr(end + 1);
      text.resize(end + 1);
    }
    if (this->IsCounted)
    {
      std::uint64_t lines = 0;
      for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
      {
        if (++lines == this->Left)
        {
          this->Rest =
            text.substr(at + 1) + this->Rest; // other elements, unless there are comments
          text.resize(at + 1);
          break;
        }
      }
    }
    return text;
  }

  PointLayout Layout;
  std::vector<std::size_t> Others;
  std::uint64_t Left;
  bool IsCounted;
  int Threads;
  std::string Rest; ///< of the last block: a line that goes on
};

/// Binary vertices.
class VertexStream : public NumberStream
{
public:
  VertexStream(const ByteSource& source, const PlyVertices& vertices)
    : NumberStream(source, vertices.Names), Vertices(vertices)
  {
    this->Place = vertices.Begin;
    this->NumPoints = vertices.Count;
    for (std::size_t i = 0; i < vertices.Channels.size(); ++i)
    {
      if (vertices.Channels[i] >= 0)
      {
        this->Others.push_back(i);
      }
    }
  }

  Status Next(PointBlock& block) override
  {
    block.Count = 0;
    block.Positions.clear();
    this->Records.clear();
    const std::size_t row = this->Vertices.RowBytes();
    const std::uint64_t rows = std::min<std::uint64_t>(
      this->Vertices.Count - this->First, std::max<std::size_t>(1, BlockBytes / 4 / row));
    auto bytes = this->Bytes(rows * row);
    std::vector<double> numbers;
    Status status =
      bytes ? ReadPlyRows(this->Vertices, bytes.Value, this->First, numbers) : bytes.Status;
    if (status)
    {
      this->AddRows(
        numbers, this->Vertices.Types.size(), this->Vertices.Position, this->Others, block);
      this->First += rows;
    }
    return status;
  }

private:
  PlyVertices Vertices;
  std::vector<std::size_t> Others;
  std::uint64_t First = 0; ///< row of the next block
};

using StreamResult = Result<std::shared_ptr<PointStream>>;

StreamResult OpenLas(const ByteSource& source)
{
  auto header = ReadLasHeader(source);
  if (!header)
  {
    return header.Status;
  }
  auto stream = std::make_shared<LasStream>(source, std::move(header.Value));
  const Status status = stream->KeepHead();
  return status ? StreamResult(std::move(stream)) : StreamResult(status);
}

StreamResult OpenPly(const ByteSource& source, std::string_view beginning, int threads)
{
  auto vertices = FindPlyVertices(beginning);
  if (!vertices)
  {
    return vertices.Status;
  }
  if (vertices->Count == 0)
  {
    return { ErrorCode::EmptyInput, "the PLY file holds no vertices" };
  }
  const std::size_t least =
    vertices->IsAscii ? 2 * vertices->Types.size() - 1 : vertices->RowBytes();
  if (vertices->Count > (source.Size - vertices->Begin) / least)
  {
    return { ErrorCode::InvalidFormat,
      "its header tells " + std::to_string(vertices->Count) +
        " vertices, more than the file has room for; it is truncated, or the count too large" };
  }
  std::shared_ptr<PointStream> stream;
  if (vertices->IsAscii)
  {
    PointLayout layout;
    layout.Begin = vertices->Begin;
    layout.HeadLine = vertices->HeadLines + 1;
    layout.LinesBefore = vertices->HeadLines;
    layout.Count = vertices->Types.size();
    layout.IsFinite.assign(layout.Count, true);
    layout.Position = vertices->Position;
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < vertices->Channels.size(); ++i)
    {
      if (vertices->Channels[i] >= 0)
      {
        others.push_back(i);
      }
    }
    stream = std::make_shared<TextStream>(
      source, layout, vertices->Names, others, vertices->Count, threads);
  }
  else
  {
    stream = std::make_shared<VertexStream>(source, vertices.Value);
  }
  stream->LeftOut = vertices->LeftOut;
  return stream;
}

StreamResult OpenText(const ByteSource& source, std::string_view beginning, int threads)
{
  auto layout = FindPointLayout(beginning);
  if (!layout)
  {
    return layout.Status;
  }
  layout->LinesBefore = static_cast<std::size_t>(
    std::count(beginning.begin(), beginning.begin() + static_cast<long>(layout->Begin), '\n'));
  std::vector<std::string> names;
  const std::vector<std::size_t> others = layout->Others(names);
  return std::shared_ptr<PointStream>(
    std::make_shared<TextStream>(source, std::move(layout.Value), names, others, 0, threads));
}
}

void PointSummary::Add(const double* position, unsigned returnNumber)
{
  ++this->Count;
  ++this->Returns[returnNumber];
  for (std::size_t d = 0; d < 3; ++d)
  {
    this->Lower[d] = std::min(this->Lower[d], position[d]);
    this->Upper[d] = std::max(this->Upper[d], position[d]);
  }
}

std::string HeadOfNumbers(const std::vector<std::string>& names, std::uint64_t count)
{
  constexpr std::size_t digits = 20; // of the largest count
  std::string number = std::to_string(count);
  number.insert(0, digits - number.size(), ' ');
  std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex " + number +
    "\nproperty double x\nproperty double y\nproperty double z\n";
  for (const std::string& name : names)
  {
    std::string word = name;
    std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '\t' || c == '\n'; }, '_');
    head += "property double " + word + "\n";
  }
  return head + "end_header\n";
}

bool IsStreamed(const std::string& ending)
{
  return ending == ".las" || ending == ".laz" || ending == ".xyz" || ending == ".txt" ||
    ending == ".csv" || ending == ".ply";
}

StreamResult OpenPointStream(const std::string& ending, const ByteSource& source, int threads)
{
  if (!IsStreamed(ending))
  {
    return { ErrorCode::InvalidParameter,
      "points are read piece by piece from .las .tif .xyz .txt .csv .ply; convert it to one of "
      "these" };
  }
  if (ending == ".las" || ending == ".laz")
  {
    return OpenLas(source);
  }
  constexpr std::uint64_t headBytes = 1U << 16U;
  std::string beginning(
    static_cast<std::size_t>(std::min<std::uint64_t>(source.Size, headBytes)), '\0');
  if (!beginning.empty() && !source.Read(0, beginning.data(), beginning.size()))
  {
    return { ErrorCode::FileError, Unreadable };
  }
  return ending == ".ply" ? OpenPly(source, beginning, threads)
                          : OpenText(source, beginning, threads);
}
}
