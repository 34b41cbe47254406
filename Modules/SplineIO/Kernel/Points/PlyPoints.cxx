// SPDX-License-Identifier: BSD-3-Clause
#include "PlyPoints.h"

#include "PlyVertices.h"
#include "TextWords.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace knotwork
{
namespace
{
enum class Encoding
{
  Ascii,
  LittleEndian,
  BigEndian
};

constexpr const char* VertexName = "vertex";

using Scalar = PlyScalar;

struct ScalarName
{
  const char* Name;
  Scalar Type;
};
constexpr ScalarName ScalarNames[] = { { "char", Scalar::Int8 }, { "int8", Scalar::Int8 },
  { "uchar", Scalar::UInt8 }, { "uint8", Scalar::UInt8 }, { "short", Scalar::Int16 },
  { "int16", Scalar::Int16 }, { "ushort", Scalar::UInt16 }, { "uint16", Scalar::UInt16 },
  { "int", Scalar::Int32 }, { "int32", Scalar::Int32 }, { "uint", Scalar::UInt32 },
  { "uint32", Scalar::UInt32 }, { "float", Scalar::Float }, { "float32", Scalar::Float },
  { "double", Scalar::Double }, { "float64", Scalar::Double } };

struct Property
{
  std::string Name;
  bool IsList = false;
  Scalar Count = Scalar::UInt8; ///< of a list
  Scalar Type = Scalar::Float;
};

struct Element
{
  std::string Name;
  long long Count = 0;
  std::vector<Property> Properties;
};

bool FindScalar(std::string_view name, Scalar& type)
{
  for (const ScalarName& known : ScalarNames)
  {
    if (name == known.Name)
    {
      type = known.Type;
      return true;
    }
  }
  return false;
}

class PlyParser
{
public:
  explicit PlyParser(std::string_view text) : Text(text), Words(text) {}

  /// Of a file whose beginning is the text.
  Result<PlyVertices> FindVertices()
  {
    this->ReadHeader();
    const bool areFirst = !this->Elements.empty() && this->Elements.front().Name == VertexName;
    if (!areFirst)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "its vertices do not come first, so they cannot be read piece by piece; convert it to "
        ".xyz");
    }
    PlyVertices found;
    if (this->Outcome)
    {
      const Element& element = this->Elements.front();
      found.IsAscii = this->Format == Encoding::Ascii;
      found.IsBigEndian = this->Format == Encoding::BigEndian;
      found.Begin = this->Position;
      found.HeadLines = this->LineNumber;
      found.Count = static_cast<std::uint64_t>(element.Count);
      this->PlaceProperties(element, found.Position, found.Channels, found.Names);
      for (const Property& property : element.Properties)
      {
        found.Types.push_back(property.Type);
      }
      for (std::size_t i = 1; i < this->Elements.size(); ++i)
      {
        const Element& other = this->Elements[i];
        if (other.Count > 0)
        {
          found.LeftOut.push_back(std::to_string(other.Count) + " elements " + Shown(other.Name) +
            " are left out; only vertices are read piece by piece");
        }
      }
    }
    return this->Outcome ? Result<PlyVertices>(std::move(found))
                         : Result<PlyVertices>(this->Outcome);
  }

  /// Numbers of whole rows of binary vertices. @param first  number of the first row, for messages.
  Status ReadRows(const PlyVertices& vertices, std::uint64_t first, std::vector<double>& numbers)
  {
    static const std::string name = VertexName;
    this->Format = vertices.IsBigEndian ? Encoding::BigEndian : Encoding::LittleEndian;
    this->RowName = &name;
    this->Row = static_cast<long long>(first);
    for (; this->Position < this->Text.size() && this->Outcome; ++this->Row)
    {
      for (std::size_t i = 0; i < vertices.Types.size(); ++i)
      {
        numbers.push_back(this->Number(vertices.Types[i]));
        this->CheckFinite(numbers.back(), "a property");
      }
    }
    return this->Outcome;
  }

  Result<PointFile> Read()
  {
    this->ReadHeader();
    PointFile file;
    for (std::size_t i = 0; i < this->Elements.size() && this->Outcome; ++i)
    {
      this->ReadElement(this->Elements[i], file);
    }
    if (this->Outcome && file.Points.rows() == 0)
    {
      return { ErrorCode::EmptyInput, "the PLY file holds no vertices" };
    }
    if (this->Outcome)
    {
      this->CheckPolygons(file);
      this->CheckEnd();
    }
    return this->Outcome ? Result<PointFile>(std::move(file)) : Result<PointFile>(this->Outcome);
  }

private:
  void Fail(ErrorCode code, std::string what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, std::move(what) };
    }
  }

  std::string_view HeaderLine()
  {
    const std::size_t end = this->Text.find('\n', this->Position);
    if (end == std::string_view::npos)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "line " + std::to_string(this->LineNumber + 1) +
          ": the header of the PLY file does not end; the file is truncated");
      return {};
    }
    std::string_view line = this->Text.substr(this->Position, end - this->Position);
    this->Position = end + 1;
    ++this->LineNumber;
    if (!line.empty() && line.back() == '\r')
    {
      line.remove_suffix(1);
    }
    return line;
  }

  void FailLine(const std::string& what)
  {
    this->Fail(ErrorCode::InvalidFormat, "line " + std::to_string(this->LineNumber) + ": " + what);
  }

  void ReadHeader()
  {
    if (this->HeaderLine() != "ply")
    {
      this->FailLine("a PLY file begins with the line 'ply'");
    }
    while (this->Outcome)
    {
      WordScanner words(this->HeaderLine());
      const std::string_view word = words.Next();
      if (word == "end_header")
      {
        break;
      }
      if (word == "format")
      {
        this->SetEncoding(words.Next());
      }
      else if (word == "element")
      {
        Element element;
        element.Name = std::string(words.Next());
        const bool again = std::any_of(this->Elements.begin(), this->Elements.end(),
          [&](const Element& other) { return other.Name == element.Name; });
        if (again && element.Name == VertexName)
        {
          this->FailLine("a second element 'vertex'; put all vertices into one");
        }
        const Status status =
          ParseInteger(words.Next(), 0, std::numeric_limits<int>::max(), element.Count);
        if (!status)
        {
          this->FailLine("number of elements: " + status.Detail);
        }
        this->Elements.push_back(std::move(element));
      }
      else if (word == "property")
      {
        this->AddProperty(words);
      }
      else if (word != "comment" && word != "obj_info" && !word.empty())
      {
        this->FailLine(Shown(word) + " is no word of a PLY header");
      }
    }
    this->Words = WordScanner(
      this->Text.substr(std::min(this->Position, this->Text.size())), this->LineNumber + 1);
  }

  void SetEncoding(std::string_view name)
  {
    if (name == "ascii")
    {
      this->Format = Encoding::Ascii;
    }
    else if (name == "binary_little_endian")
    {
      this->Format = Encoding::LittleEndian;
    }
    else if (name == "binary_big_endian")
    {
      this->Format = Encoding::BigEndian;
    }
    else
    {
      this->FailLine(Shown(name) + " is no format of PLY files");
    }
  }

  void AddProperty(WordScanner& words)
  {
    Property property;
    std::string_view word = words.Next();
    if (word == "list")
    {
      property.IsList = true;
      word = words.Next();
      if (!FindScalar(word, property.Count))
      {
        this->FailLine(Shown(word) + " is no type of a number");
      }
      word = words.Next();
    }
    if (!FindScalar(word, property.Type))
    {
      this->FailLine(Shown(word) + " is no type of a number");
    }
    property.Name = std::string(words.Next());
    if (this->Elements.empty() || property.Name.empty())
    {
      this->FailLine("a property without a name or an element");
      return;
    }
    Element& element = this->Elements.back();
    const bool again = std::any_of(element.Properties.begin(), element.Properties.end(),
      [&](const Property& other) { return other.Name == property.Name; });
    if (again && element.Name == VertexName)
    {
      this->FailLine("vertices have the property " + Shown(property.Name) + " twice; rename one");
    }
    element.Properties.push_back(std::move(property));
  }

  template <typename T>
  double Binary()
  {
    std::array<char, sizeof(T)> bytes{};
    if (this->Text.size() - this->Position < sizeof(T))
    {
      this->FailRow("the file ends; it is truncated, or its counts are too large");
      return 0.0;
    }
    std::memcpy(bytes.data(), this->Text.data() + this->Position, sizeof(T));
    this->Position += sizeof(T);
    if (this->Format == Encoding::BigEndian)
    {
      std::reverse(bytes.begin(), bytes.end());
    }
    T value{};
    std::memcpy(&value, bytes.data(), sizeof(T));
    return static_cast<double>(value);
  }

  double Number(Scalar type)
  {
    if (!this->Outcome)
    {
      return 0.0;
    }
    if (this->Format == Encoding::Ascii)
    {
      double value = 0.0;
      const std::string_view word = this->Words.Next();
      const Status status = word.empty()
        ? Status(
            ErrorCode::InvalidFormat, "the file ends; it is truncated, or its counts are too large")
        : ParseReal(word, value);
      if (!status)
      {
        this->Fail(status.Code,
          "line " + std::to_string(this->Words.Line()) + ", " + *this->RowName + " " +
            std::to_string(this->Row) + ": " + status.Detail);
      }
      return value;
    }
    switch (type)
    {
      case Scalar::Int8:
        return this->Binary<std::int8_t>();
      case Scalar::UInt8:
        return this->Binary<std::uint8_t>();
      case Scalar::Int16:
        return this->Binary<std::int16_t>();
      case Scalar::UInt16:
        return this->Binary<std::uint16_t>();
      case Scalar::Int32:
        return this->Binary<std::int32_t>();
      case Scalar::UInt32:
        return this->Binary<std::uint32_t>();
      case Scalar::Float:
        return this->Binary<float>();
      case Scalar::Double:
        break;
    }
    return this->Binary<double>();
  }

  void FailRow(const std::string& what)
  {
    this->Fail(
      ErrorCode::InvalidFormat, *this->RowName + " " + std::to_string(this->Row) + ": " + what);
  }

  /// Words or bytes that are left bound what counts may claim.
  bool Fits(const Element& element)
  {
    if (static_cast<double>(element.Count) * static_cast<double>(element.Properties.size()) >
      static_cast<double>(this->Text.size()))
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::to_string(element.Count) + " elements '" + element.Name +
          "' are more than the file has room for; it is truncated, or the count too large");
    }
    return static_cast<bool>(this->Outcome);
  }

  void ReadElement(const Element& element, PointFile& file)
  {
    this->RowName = &element.Name;
    this->Row = 0;
    if (element.Properties.empty() || !this->Fits(element))
    {
      return;
    }
    if (element.Name == VertexName)
    {
      this->ReadVertices(element, file);
      return;
    }
    const bool isFace = element.Name == "face";
    if (!isFace && element.Count > 0)
    {
      file.LeftOut.push_back(std::to_string(element.Count) + " elements " + Shown(element.Name) +
        " are left out; only vertices and faces are read");
    }
    for (; this->Row < element.Count && this->Outcome; ++this->Row)
    {
      for (const Property& property : element.Properties)
      {
        const bool corners =
          isFace && (property.Name == "vertex_indices" || property.Name == "vertex_index");
        this->ReadList(property, corners, file);
      }
    }
  }

  void ReadList(const Property& property, bool corners, PointFile& file)
  {
    if (!property.IsList)
    {
      this->Number(property.Type);
      return;
    }
    const double count = this->Number(property.Count);
    if (this->Outcome &&
      (!(count >= 0.0) || count > static_cast<double>(this->Text.size()) ||
        count != std::floor(count)))
    {
      this->FailRow("a list of so many numbers has no room in the file");
    }
    std::vector<int> polygon;
    for (double i = 0.0; i < count && this->Outcome; i += 1.0)
    {
      const double number = this->Number(property.Type);
      const bool isIndex =
        number >= 0.0 && number < std::numeric_limits<int>::max() && number == std::floor(number);
      if (corners && this->Outcome && !isIndex)
      {
        this->FailRow("a corner is no number of a vertex");
      }
      else if (corners)
      {
        polygon.push_back(static_cast<int>(number));
      }
    }
    if (corners && this->Outcome && polygon.size() < 3)
    {
      this->FailRow("it has " + std::to_string(polygon.size()) +
        " corners, a face has three or more; remove it");
    }
    else if (corners && this->Outcome)
    {
      file.Polygons.push_back(std::move(polygon));
    }
  }

  void CheckFinite(double number, const std::string& what)
  {
    if (this->Outcome && !std::isfinite(number))
    {
      this->Fail(ErrorCode::NonFiniteInput,
        "vertex " + std::to_string(this->Row) + " has " + what +
          " that is not finite; remove the vertex");
    }
  }

  /// Which properties of the vertices are coordinates, and which channels the others are.
  void PlaceProperties(const Element& element, std::array<std::size_t, 3>& position,
    std::vector<Eigen::Index>& channel, std::vector<std::string>& names)
  {
    int found = 0;
    for (std::size_t i = 0; i < element.Properties.size(); ++i)
    {
      const Property& property = element.Properties[i];
      constexpr std::string_view coordinates = "xyz";
      const std::size_t d = property.Name.size() == 1 ? coordinates.find(property.Name[0]) : 3;
      channel.push_back(-1);
      if (property.IsList)
      {
        this->Fail(ErrorCode::InvalidFormat,
          "the property " + Shown(property.Name) + " of vertices is a list; remove it");
      }
      else if (d < 3)
      {
        position[d] = i;
        ++found;
      }
      else
      {
        channel.back() = static_cast<Eigen::Index>(names.size());
        names.push_back(property.Name);
      }
    }
    if (found != 3)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "vertices have " + std::to_string(found) +
          " of the properties x, y, z; all three are needed");
    }
  }

  void ReadVertices(const Element& element, PointFile& file)
  {
    std::array<std::size_t, 3> position{};
    std::vector<Eigen::Index> channel;
    this->PlaceProperties(element, position, channel, file.Names);
    if (!this->Outcome)
    {
      return;
    }
    file.Points.resize(element.Count, 3);
    file.Channels.resize(element.Count, static_cast<Eigen::Index>(file.Names.size()));
    std::vector<double> numbers(element.Properties.size());
    for (; this->Row < element.Count && this->Outcome; ++this->Row)
    {
      for (std::size_t i = 0; i < numbers.size(); ++i)
      {
        numbers[i] = this->Number(element.Properties[i].Type);
        this->CheckFinite(numbers[i], "a property " + Shown(element.Properties[i].Name));
        if (channel[i] >= 0)
        {
          file.Channels(this->Row, channel[i]) = numbers[i];
        }
      }
      for (std::size_t d = 0; d < 3; ++d)
      {
        file.Points(this->Row, static_cast<Eigen::Index>(d)) = numbers[position[d]];
      }
    }
  }

  void CheckPolygons(const PointFile& file)
  {
    for (std::size_t i = 0; i < file.Polygons.size() && this->Outcome; ++i)
    {
      for (int corner : file.Polygons[i])
      {
        if (corner >= file.Points.rows())
        {
          this->Fail(ErrorCode::InvalidTopology,
            "face " + std::to_string(i) + " has the corner " + std::to_string(corner) +
              ", but there are " + std::to_string(file.Points.rows()) + " vertices");
        }
      }
    }
  }

  /// Nothing stands behind the last element; bytes of 0 and line ends fill up binary files.
  void CheckEnd()
  {
    if (this->Format == Encoding::Ascii && !this->Words.AtEnd())
    {
      const std::string word = Shown(this->Words.Next());
      this->Fail(ErrorCode::InvalidFormat,
        "line " + std::to_string(this->Words.Line()) + ": " + word +
          " stands behind the last element; correct the counts of the header");
    }
    const std::string_view fill("\0\n\r", 3);
    if (this->Format != Encoding::Ascii &&
      this->Text.find_first_not_of(fill, this->Position) != std::string_view::npos)
    {
      this->Fail(ErrorCode::InvalidFormat,
        std::to_string(this->Text.size() - this->Position) +
          " bytes stand behind the last element; correct the counts of the header");
    }
  }

  std::string_view Text;
  std::size_t Position = 0;
  std::size_t LineNumber = 0;
  WordScanner Words;
  Encoding Format = Encoding::Ascii;
  std::vector<Element> Elements;
  const std::string* RowName = nullptr; ///< of the element that is read
  long long Row = 0;
  Status Outcome;
};
}

Result<PointFile> ReadPly(std::string_view text)
{
  return PlyParser(text).Read();
}

Result<PlyVertices> FindPlyVertices(std::string_view beginning)
{
  return PlyParser(beginning).FindVertices();
}

std::size_t PlyVertices::RowBytes() const
{
  std::size_t bytes = 0;
  for (const PlyScalar type : this->Types)
  {
    bytes += type <= PlyScalar::UInt8 ? 1
      : type <= PlyScalar::UInt16     ? 2
      : type <= PlyScalar::Float      ? 4
                                      : 8;
  }
  return bytes;
}

Status ReadPlyRows(const PlyVertices& vertices, std::string_view rows, std::uint64_t first,
  std::vector<double>& numbers)
{
  return PlyParser(rows).ReadRows(vertices, first, numbers);
}
}
