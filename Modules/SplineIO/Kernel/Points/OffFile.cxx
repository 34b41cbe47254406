// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "TextWords.h"

#include <limits>

namespace knotwork
{
namespace
{
constexpr int MostColumns = 16; ///< of a point: coordinates, normals and colours are fewer
constexpr int MostColors = 4;   ///< behind the corners of a face

class OffParser
{
public:
  explicit OffParser(std::string_view text) : TextSize(text.size()), Lines(text, '#') {}

  Result<PointFile> Read()
  {
    PointFile file;
    this->ReadHead();
    this->ReadPoints(file);
    this->ReadFaces(file);
    if (this->Outcome && this->Lines.Next())
    {
      this->Fail(ErrorCode::InvalidFormat,
        Shown(this->Lines.Words().Next()) + " stands behind the last of " +
          std::to_string(this->NumFaces) + " faces; correct the counts in line " +
          std::to_string(this->CountLine));
    }
    return this->Outcome ? Result<PointFile>(std::move(file)) : Result<PointFile>(this->Outcome);
  }

private:
  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(this->Lines.Line()) + ": " + what };
    }
  }

  bool NextLine(const char* what, long long number, long long count)
  {
    if (this->Outcome && !this->Lines.Next())
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::string(what) + " " + std::to_string(number) + " of " + std::to_string(count) +
          " is missing: the text ends; it is truncated, or its counts are too large");
    }
    return static_cast<bool>(this->Outcome);
  }

  /// The next word of the line as an integer; the lowest value when it is none of the range.
  /// @param meaning  called when it is wrong.
  template <typename Meaning>
  long long Integer(long long lowest, long long highest, const Meaning& meaning)
  {
    long long value = lowest;
    if (this->Outcome)
    {
      const std::string_view word = this->Lines.Words().Next();
      const Status status = word.empty() ? Status(ErrorCode::InvalidFormat, "is missing")
                                         : ParseInteger(word, lowest, highest, value);
      if (!status)
      {
        this->Fail(status.Code, meaning() + ": " + status.Detail);
        value = lowest;
      }
    }
    return value;
  }

  void ReadHead()
  {
    if (!this->Lines.Next())
    {
      this->Outcome = { ErrorCode::EmptyInput, "the OFF text is empty" };
      return;
    }
    WordScanner& words = this->Lines.Words();
    const std::string_view head = words.Next();
    if (head != "OFF" && head != "COFF" && head != "NOFF" && head != "CNOFF")
    {
      this->Fail(ErrorCode::InvalidFormat,
        Shown(head) + " is not OFF, COFF, NOFF or CNOFF, with which a mesh in text begins");
      return;
    }
    if (words.AtEnd() && !this->Lines.Next()) // the counts may follow on the same line
    {
      this->Fail(ErrorCode::InvalidFormat, "the numbers of points and faces are missing");
      return;
    }
    this->CountLine = this->Lines.Line();
    constexpr long long Most = std::numeric_limits<int>::max() - 1;
    const auto count = [&](const char* of, long long lowest)
    { return this->Integer(lowest, Most, [of] { return std::string("number of ") + of; }); };
    this->NumPoints = count("points", 0);
    this->NumFaces = count("faces", 0);
    if (this->Outcome && !words.AtEnd())
    {
      count("edges", std::numeric_limits<int>::min()); // says nothing
    }
    this->EndLine([] { return std::string("the counts"); });
    // six characters are the shortest line of a point or face
    if (this->Outcome &&
      6.0 * static_cast<double>(this->NumPoints + this->NumFaces) >
        static_cast<double>(this->TextSize) + 6.0)
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::to_string(this->NumPoints) + " points and " + std::to_string(this->NumFaces) +
          " faces are more than the file has room for; it is truncated, or its counts are wrong");
    }
    if (this->Outcome && this->NumPoints == 0)
    {
      this->Fail(ErrorCode::EmptyInput, "the mesh has no points");
    }
  }

  template <typename Place>
  void EndLine(const Place& place)
  {
    if (this->Outcome && !this->Lines.Words().AtEnd())
    {
      const std::string word = Shown(this->Lines.Words().Next());
      this->Fail(ErrorCode::InvalidFormat, word + " stands behind " + place() + "; remove it");
    }
  }

  /// Numbers that nobody uses, but that are numbers.
  template <typename Place>
  void SkipNumbers(int most, const Place& place)
  {
    WordScanner& words = this->Lines.Words();
    for (int i = 0; i < most && this->Outcome && !words.AtEnd(); ++i)
    {
      double value = 0.0;
      if (const Status status = ParseReal(words.Next(), value); !status)
      {
        this->Fail(status.Code, place() + ": " + status.Detail);
      }
    }
    this->EndLine(place);
  }

  void ReadPoints(PointFile& file)
  {
    if (!this->Outcome)
    {
      return;
    }
    file.Points.resize(this->NumPoints, 3);
    file.Channels.resize(this->NumPoints, 0);
    for (long long i = 0; i < this->NumPoints && this->NextLine("point", i, this->NumPoints); ++i)
    {
      const auto place = [i] { return "point " + std::to_string(i); };
      for (Eigen::Index c = 0; c < 3 && this->Outcome; ++c)
      {
        const std::string_view word = this->Lines.Words().Next();
        const Status status = word.empty()
          ? Status(ErrorCode::InvalidFormat, "a point has three coordinates")
          : ParseReal(word, file.Points(i, c));
        if (!status)
        {
          this->Fail(status.Code, place() + ": " + status.Detail);
        }
      }
      this->SkipNumbers(MostColumns - 3, place);
    }
  }

  void ReadFaces(PointFile& file)
  {
    constexpr long long Most = std::numeric_limits<int>::max();
    for (long long i = 0; i < this->NumFaces && this->NextLine("face", i, this->NumFaces); ++i)
    {
      const auto place = [i] { return "face " + std::to_string(i); };
      const long long count =
        this->Integer(0, Most, [&] { return place() + ", number of corners"; });
      if (this->Outcome && count < 3)
      {
        this->Fail(ErrorCode::InvalidFormat,
          place() + " has " + std::to_string(count) +
            " corners, a face has three or more; remove it");
      }
      std::vector<int> corners;
      for (long long k = 0; k < count && this->Outcome; ++k)
      {
        corners.push_back(static_cast<int>(this->Integer(
          0, this->NumPoints - 1, [&] { return place() + ", corner " + std::to_string(k); })));
      }
      this->SkipNumbers(MostColors, place);
      file.Polygons.push_back(std::move(corners));
    }
  }

  std::size_t TextSize;
  LineScanner Lines;
  long long NumPoints = 0;
  long long NumFaces = 0;
  std::size_t CountLine = 1;
  Status Outcome;
};
}

Result<PointFile> ReadOff(std::string_view text)
{
  return OffParser(text).Read();
}
}
