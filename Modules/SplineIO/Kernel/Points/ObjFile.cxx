// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFiles.h"

#include "TextWords.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
constexpr int None = -1;

/// How a keyword is taken.
enum class Kind
{
  Point,
  Texture,
  Face,
  Line,
  Silent, ///< nothing that a mesh is made of
  LeftOut ///< geometry that is not read
};

struct Keyword
{
  std::string_view Name;
  Kind Meaning;
};
constexpr Keyword Keywords[] = { { "v", Kind::Point }, { "vt", Kind::Texture }, { "f", Kind::Face },
  { "fo", Kind::Face }, { "l", Kind::Line }, { "p", Kind::Silent }, { "vn", Kind::Silent },
  { "o", Kind::Silent }, { "g", Kind::Silent }, { "s", Kind::Silent }, { "mg", Kind::Silent },
  { "usemtl", Kind::Silent }, { "mtllib", Kind::Silent }, { "usemap", Kind::Silent },
  { "maplib", Kind::Silent }, { "lod", Kind::Silent }, { "bevel", Kind::Silent },
  { "c_interp", Kind::Silent }, { "d_interp", Kind::Silent }, { "shadow_obj", Kind::Silent },
  { "trace_obj", Kind::Silent }, { "vp", Kind::Silent }, { "cstype", Kind::Silent },
  { "deg", Kind::Silent }, { "bmat", Kind::Silent }, { "step", Kind::Silent },
  { "parm", Kind::Silent }, { "trim", Kind::Silent }, { "hole", Kind::Silent },
  { "scrv", Kind::Silent }, { "sp", Kind::Silent }, { "end", Kind::Silent },
  { "con", Kind::Silent }, { "ctech", Kind::Silent }, { "stech", Kind::Silent },
  { "curv", Kind::LeftOut }, { "curv2", Kind::Silent }, { "surf", Kind::LeftOut },
  { "t", Kind::LeftOut } }; // t: tags of subdivision

/// What a face or polyline names, of which it is known only at the end whether it is there.
struct Corner
{
  int Point = 0;
  int Texture = None;
  std::size_t Line = 0;
};

struct Cell
{
  std::size_t End = 0; ///< of its corners
  bool IsFace = true;
};

class ObjParser
{
public:
  explicit ObjParser(std::string_view text) : Text(text) {}

  Result<PointFile> Read()
  {
    while (this->Outcome && this->NextLine())
    {
      this->ReadLine();
    }
    PointFile file;
    this->CheckCorners();
    const auto n = static_cast<Eigen::Index>(this->Coordinates.size() / 3);
    if (this->Outcome && n == 0)
    {
      this->Outcome = { ErrorCode::EmptyInput, "the OBJ text holds no points (v)" };
    }
    if (!this->Outcome)
    {
      return this->Outcome;
    }
    file.Points = Eigen::Map<const PointMatrix>(this->Coordinates.data(), n, 3);
    file.Channels.resize(n, 0);
    this->AddTexture(file);
    std::size_t corner = 0;
    for (const Cell& cell : this->Cells)
    {
      std::vector<int>& rows = (cell.IsFace ? file.Polygons : file.Lines).emplace_back();
      for (; corner < cell.End; ++corner)
      {
        rows.push_back(this->Corners[corner].Point);
      }
    }
    if (this->NumLeftOut > 0)
    {
      file.LeftOut.push_back("line " + std::to_string(this->LineLeftOut) + ": " +
        std::to_string(this->NumLeftOut) +
        " curves, surfaces or tags (curv, surf, t) are left out; only points, faces and lines are "
        "read");
    }
    return file;
  }

private:
  void Fail(ErrorCode code, std::size_t line, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(line) + ": " + what };
    }
  }
  void Fail(ErrorCode code, const std::string& what) { this->Fail(code, this->Line, what); }

  /// The next line without its comment, lines that end with a backslash together with what follows.
  bool NextLine()
  {
    if (this->Position >= this->Text.size())
    {
      return false;
    }
    this->Line = this->FollowingLine;
    this->Joined.clear();
    std::string_view line;
    bool goesOn = true;
    bool first = true;
    while (goesOn && this->Position < this->Text.size())
    {
      const std::size_t end = std::min(this->Text.find('\n', this->Position), this->Text.size());
      std::string_view part = this->Text.substr(this->Position, end - this->Position);
      this->Position = end + 1;
      ++this->FollowingLine;
      part = part.substr(0, part.find('#'));
      part = part.substr(0, part.find_last_not_of(" \t\r") + 1);
      goesOn = !part.empty() && part.back() == '\\';
      if (goesOn)
      {
        part.remove_suffix(1);
      }
      if (first && !goesOn)
      {
        line = part;
        break;
      }
      first = false;
      this->Joined.append(part).push_back(' ');
    }
    this->Words = WordScanner(first ? line : std::string_view(this->Joined), this->Line);
    return true;
  }

  void ReadLine()
  {
    const std::string_view word = this->Words.Next();
    if (word.empty())
    {
      return;
    }
    const auto known = std::find_if(std::begin(Keywords), std::end(Keywords),
      [&](const Keyword& keyword) { return keyword.Name == word; });
    if (known == std::end(Keywords))
    {
      this->Fail(ErrorCode::InvalidFormat,
        Shown(word) + " is no keyword of an OBJ file; correct or remove the line");
      return;
    }
    switch (known->Meaning)
    {
      case Kind::Point:
        this->ReadNumbers(3, 7, "a point", this->Coordinates);
        break;
      case Kind::Texture:
        this->ReadTexture();
        break;
      case Kind::Face:
      case Kind::Line:
        this->ReadCorners(known->Meaning == Kind::Face);
        break;
      case Kind::LeftOut:
        this->LineLeftOut = this->NumLeftOut == 0 ? this->Line : this->LineLeftOut;
        ++this->NumLeftOut;
        break;
      case Kind::Silent:
        break;
    }
  }

  /// Keeps the first numbers of a line; the others are only looked at.
  void ReadNumbers(int needed, int most, const char* what, std::vector<double>& numbers)
  {
    int count = 0;
    for (; this->Outcome && !this->Words.AtEnd() && count < most; ++count)
    {
      double value = 0.0;
      if (const Status status = ParseReal(this->Words.Next(), value); !status)
      {
        this->Fail(status.Code, status.Detail);
      }
      if (count < needed)
      {
        numbers.push_back(value);
      }
    }
    if (this->Outcome && (count < needed || !this->Words.AtEnd()))
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::string(what) + " has " + std::to_string(needed) + " to " + std::to_string(most) +
          " numbers" +
          (count < needed ? ", here are " + std::to_string(count)
                          : "; remove " + Shown(this->Words.Next())));
    }
  }

  void ReadTexture()
  {
    std::vector<double> numbers;
    this->ReadNumbers(2, 3, "a texture coordinate", numbers);
    this->Texture.insert(this->Texture.end(), numbers.begin(), numbers.end());
  }

  /// A number from 1, or counted backwards from -1, as an index.
  int Index(std::string_view word, std::size_t count)
  {
    long long number = 0;
    const long long most = std::numeric_limits<int>::max();
    Status status = ParseInteger(word, -static_cast<long long>(count), most, number);
    if (status && number == 0)
    {
      status = { ErrorCode::InvalidFormat, "'0' is no number of a point; they count from 1" };
    }
    if (!status)
    {
      this->Fail(status.Code, status.Detail);
      return 0;
    }
    return static_cast<int>(number > 0 ? number - 1 : static_cast<long long>(count) + number);
  }

  void ReadCorners(bool isFace)
  {
    const std::size_t begin = this->Corners.size();
    while (this->Outcome && !this->Words.AtEnd())
    {
      std::string_view word = this->Words.Next();
      std::string_view parts[3];
      std::size_t count = 0;
      for (bool more = true; more && count < 3; ++count)
      {
        const std::size_t slash = word.find('/');
        parts[count] = word.substr(0, slash);
        more = slash != std::string_view::npos;
        word.remove_prefix(more ? slash + 1 : word.size());
      }
      if (!word.empty())
      {
        this->Fail(ErrorCode::InvalidFormat, "a corner has at most point/texture/normal");
      }
      Corner corner;
      corner.Point = this->Index(parts[0], this->Coordinates.size() / 3);
      corner.Texture = parts[1].empty() ? None : this->Index(parts[1], this->Texture.size() / 2);
      if (!parts[2].empty())
      {
        this->Index(parts[2], std::numeric_limits<int>::max()); // not looked at, but a number
      }
      corner.Line = this->Line;
      this->Corners.push_back(corner);
    }
    const std::size_t count = this->Corners.size() - begin;
    const std::size_t least = isFace ? 3 : 2;
    if (this->Outcome && count < least)
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::string(isFace ? "a face" : "a line") + " of " + std::to_string(count) +
          " corners, it has " + std::to_string(least) + " or more; remove it");
    }
    this->Cells.push_back({ this->Corners.size(), isFace });
  }

  void CheckCorners()
  {
    const auto points = static_cast<int>(this->Coordinates.size() / 3);
    const auto textures = static_cast<int>(this->Texture.size() / 2);
    for (const Corner& corner : this->Corners)
    {
      if (this->Outcome && corner.Point >= points)
      {
        this->Fail(ErrorCode::InvalidFormat, corner.Line,
          "a corner is point " + std::to_string(corner.Point + 1LL) + ", but there are " +
            std::to_string(points));
      }
      // programs write corners with numbers of texture coordinates that they leave out altogether
      if (this->Outcome && textures > 0 && corner.Texture >= textures)
      {
        this->Fail(ErrorCode::InvalidFormat, corner.Line,
          "a corner has the texture coordinates " + std::to_string(corner.Texture + 1LL) +
            ", but there are " + std::to_string(textures));
      }
    }
  }

  /// Texture coordinates as channels where every corner's point has one pair.
  void AddTexture(PointFile& file)
  {
    const bool used = std::any_of(this->Corners.begin(), this->Corners.end(),
      [](const Corner& corner) { return corner.Texture != None; });
    if (!used)
    {
      return;
    }
    if (this->Texture.empty())
    {
      file.Warnings.emplace_back(
        "corners have numbers of texture coordinates, and there are none; they are left out");
      return;
    }
    std::vector<int> textureOf(static_cast<std::size_t>(file.Points.rows()), None);
    for (const Corner& corner : this->Corners)
    {
      int& texture = textureOf[static_cast<std::size_t>(corner.Point)];
      if (corner.Texture == None)
      {
        continue;
      }
      const auto pair = [&](int index) { return this->Texture.data() + 2 * std::size_t(index); };
      if (texture != None && !std::equal(pair(texture), pair(texture) + 2, pair(corner.Texture)))
      {
        file.Warnings.push_back("line " + std::to_string(corner.Line) + ": point " +
          std::to_string(corner.Point + 1LL) +
          " has several pairs of texture coordinates; all are left out");
        return;
      }
      texture = corner.Texture;
    }
    if (std::find(textureOf.begin(), textureOf.end(), None) != textureOf.end())
    {
      file.Warnings.emplace_back(
        "some points have no texture coordinates; those of the others are left out");
      return;
    }
    file.Names = { "TCoords:0", "TCoords:1" };
    file.Channels.resize(file.Points.rows(), 2);
    for (Eigen::Index i = 0; i < file.Points.rows(); ++i)
    {
      const auto texture = 2 * static_cast<std::size_t>(textureOf[static_cast<std::size_t>(i)]);
      file.Channels.row(i) << this->Texture[texture], this->Texture[texture + 1];
    }
  }

  std::string_view Text;
  std::size_t Position = 0;
  std::size_t Line = 0;
  std::size_t FollowingLine = 1;
  std::string Joined;
  WordScanner Words{ {} };
  std::vector<double> Coordinates; ///< three a point
  std::vector<double> Texture;     ///< two a pair
  std::vector<Corner> Corners;     ///< of all faces and lines
  std::vector<Cell> Cells;
  std::size_t LineLeftOut = 0;
  int NumLeftOut = 0;
  Status Outcome;
};
}

Result<PointFile> ReadObj(std::string_view text)
{
  return ObjParser(text).Read();
}
}
