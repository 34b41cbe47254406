// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "TextWords.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

namespace knotwork
{
namespace
{
constexpr std::size_t HeadBytes = 84; ///< of a binary file: 80 of anything, number of facets
constexpr std::size_t FacetBytes = 50;

using Point = std::array<double, 3>;

struct PointHash
{
  std::size_t operator()(const Point& point) const
  {
    std::size_t hash = 0;
    for (double x : point)
    {
      hash = 1000003 * hash + std::hash<double>()(x); // the same of 0 and -0
    }
    return hash;
  }
};

/// Corners of equal coordinates as one point.
class PointMerger
{
public:
  int Add(const Point& point)
  {
    const auto [place, isNew] =
      this->Rows.emplace(point, static_cast<int>(this->Coordinates.size() / 3));
    if (isNew)
    {
      this->Coordinates.insert(this->Coordinates.end(), point.begin(), point.end());
    }
    return place->second;
  }
  PointMatrix Points() const
  {
    return Eigen::Map<const PointMatrix>(
      this->Coordinates.data(), static_cast<Eigen::Index>(this->Coordinates.size() / 3), 3);
  }

private:
  std::unordered_map<Point, int, PointHash> Rows; ///< -0 is 0
  std::vector<double> Coordinates;
};

class StlParser
{
public:
  explicit StlParser(std::string_view text) : Text(text), Words(text) {}

  Result<PointFile> Read()
  {
    this->IsBinary() ? this->ReadBinary() : this->ReadText();
    if (this->Outcome && this->File.Polygons.empty())
    {
      this->Outcome = { ErrorCode::EmptyInput, "the STL file holds no facet" };
    }
    if (!this->Outcome)
    {
      return this->Outcome;
    }
    if (this->NumDegenerate > 0)
    {
      this->File.Warnings.push_back(std::to_string(this->NumDegenerate) +
        " facets with equal corners are no facets (the first is facet " +
        std::to_string(this->FirstDegenerate) + ")");
    }
    this->File.Points = this->Merger.Points();
    this->File.Channels.resize(this->File.Points.rows(), 0);
    return std::move(this->File);
  }

private:
  void Fail(ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, what };
    }
  }
  void FailWord(ErrorCode code, const std::string& what)
  {
    this->Fail(code, "line " + std::to_string(this->Words.Line()) + ": " + what);
  }

  std::uint32_t NumFacetsOfHead() const
  {
    std::uint32_t count = 0; // little-endian, as on every machine that Debian's packages are for
    for (std::size_t i = 0; i < 4; ++i)
    {
      const auto byte = static_cast<unsigned char>(this->Text[HeadBytes - 4 + i]);
      count |= static_cast<std::uint32_t>(byte) << (8 * i);
    }
    return count;
  }

  /// Binary files may begin with "solid" too: then their size tells, or a character that is none.
  bool IsBinary() const
  {
    const std::size_t first = this->Text.find_first_not_of(" \t\r\n");
    const bool solid =
      first != std::string_view::npos && Lower(this->Text.substr(first, 5)) == "solid";
    if (this->Text.size() < HeadBytes)
    {
      return false;
    }
    const std::size_t size = HeadBytes + FacetBytes * std::size_t(this->NumFacetsOfHead());
    return !solid || this->Text.size() == size ||
      this->Text.substr(0, HeadBytes + 512).find('\0') != std::string_view::npos;
  }

  static std::string Lower(std::string_view word)
  {
    std::string lower(word);
    for (char& c : lower)
    {
      c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return lower;
  }

  void AddFacet(const std::array<int, 3>& corners)
  {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    {
      this->FirstDegenerate = this->NumDegenerate == 0 ? this->Facet : this->FirstDegenerate;
      ++this->NumDegenerate;
    }
    else
    {
      this->File.Polygons.push_back({ corners[0], corners[1], corners[2] });
    }
    ++this->Facet;
  }

  void ReadBinary()
  {
    const std::uint32_t count = this->NumFacetsOfHead();
    const std::size_t room = (this->Text.size() - HeadBytes) / FacetBytes;
    if (count != room || this->Text.size() != HeadBytes + FacetBytes * room)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "the binary STL file tells of " + std::to_string(count) + " facets, but has " +
          std::to_string(this->Text.size() - HeadBytes) + " bytes for them, not " +
          std::to_string(FacetBytes) + " each; it is truncated or damaged");
    }
    for (std::uint32_t f = 0; f < count && this->Outcome; ++f)
    {
      std::array<int, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k)
      {
        Point point{};
        for (std::size_t c = 0; c < 3; ++c)
        {
          const std::size_t at = HeadBytes + FacetBytes * std::size_t(f) + 12 + 12 * k + 4 * c;
          point[c] = this->FloatAt(at);
          if (!std::isfinite(point[c]))
          {
            this->Fail(ErrorCode::NonFiniteInput,
              "facet " + std::to_string(f) + " has a coordinate that is not finite; remove it");
            return;
          }
        }
        corners[k] = this->Merger.Add(point);
      }
      this->AddFacet(corners);
    }
  }

  double FloatAt(std::size_t at) const
  {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(this->Text[at + i])) << (8 * i);
    }
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return static_cast<double>(value);
  }

  std::string_view Word()
  {
    const std::string_view word = this->Words.Next();
    if (word.empty())
    {
      this->FailWord(
        ErrorCode::InvalidFormat, "the text ends within a solid; the file is truncated");
    }
    return word;
  }

  void Expect(const char* keyword)
  {
    if (!this->Outcome)
    {
      return;
    }
    const std::string_view word = this->Word();
    if (this->Outcome && Lower(word) != keyword)
    {
      this->FailWord(
        ErrorCode::InvalidFormat, Shown(word) + " stands where '" + keyword + "' is expected");
    }
  }

  /// Names of solids are the rest of their line.
  void SkipName()
  {
    const std::size_t line = this->Words.Line();
    WordScanner ahead = this->Words;
    while (!ahead.AtEnd())
    {
      ahead.Next();
      if (ahead.Line() != line)
      {
        return;
      }
      this->Words = ahead;
    }
  }

  void ReadText()
  {
    do
    {
      this->Expect("solid");
      this->SkipName();
      std::string word;
      while (this->Outcome && (word = Lower(this->Word())) == "facet")
      {
        this->ReadFacet();
      }
      if (this->Outcome && word != "endsolid")
      {
        this->FailWord(ErrorCode::InvalidFormat,
          Shown(word) + " stands where 'facet' or 'endsolid' is expected");
      }
      this->SkipName();
    } while (this->Outcome && !this->Words.AtEnd());
  }

  void ReadFacet()
  {
    this->Expect("normal");
    for (int c = 0; c < 3 && this->Outcome; ++c)
    {
      this->Word(); // follows from the corners
    }
    this->Expect("outer");
    this->Expect("loop");
    std::array<int, 3> corners{};
    for (int& corner : corners)
    {
      this->Expect("vertex");
      Point point{};
      for (double& coordinate : point)
      {
        const std::string_view word = this->Outcome ? this->Word() : std::string_view();
        const Status status = this->Outcome ? ParseReal(word, coordinate) : Status();
        if (!status)
        {
          this->FailWord(status.Code, status.Detail);
        }
      }
      corner = this->Outcome ? this->Merger.Add(point) : 0;
    }
    this->Expect("endloop");
    this->Expect("endfacet");
    if (this->Outcome)
    {
      this->AddFacet(corners);
    }
  }

  std::string_view Text;
  WordScanner Words;
  PointMerger Merger;
  PointFile File;
  std::uint64_t Facet = 0;
  std::uint64_t FirstDegenerate = 0;
  std::uint64_t NumDegenerate = 0;
  Status Outcome;
};
}

Result<PointFile> ReadStl(std::string_view text)
{
  return StlParser(text).Read();
}
}
