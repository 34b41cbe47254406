// SPDX-License-Identifier: BSD-3-Clause
#include "SvgPaths.h"

#include <Eigen/Geometry>
#include <pugixml.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>

namespace knotwork
{
namespace
{
using Point = Eigen::Vector2d;

constexpr double Pi = 3.14159265358979323846;
constexpr int Parts = 64; ///< of a curve
constexpr std::size_t MaxPoints = 10'000'000;
constexpr int MaxDepth = 200; ///< of elements in each other

/// Numbers, flags and words of attributes, in their order.
class Scanner
{
public:
  explicit Scanner(std::string_view text) : Text(text) {}

  bool AtEnd()
  {
    this->Skip();
    return this->At >= this->Text.size();
  }
  std::size_t Place() const { return this->At; }
  char Peek()
  {
    this->Skip();
    return this->At < this->Text.size() ? this->Text[this->At] : '\0';
  }
  char Take()
  {
    const char next = this->Peek();
    ++this->At;
    return next;
  }
  bool HasNumber()
  {
    const char next = this->Peek();
    return (next >= '0' && next <= '9') || next == '+' || next == '-' || next == '.';
  }
  /// False: there is none, or no finite one.
  bool Number(double& value)
  {
    if (!this->HasNumber())
    {
      return false;
    }
    const char* begin = this->Text.data() + this->At + (this->Text[this->At] == '+' ? 1 : 0);
    const char* end = this->Text.data() + this->Text.size();
    const auto read = std::from_chars(begin, end, value);
    if (read.ec != std::errc() || !std::isfinite(value))
    {
      return false;
    }
    this->At = static_cast<std::size_t>(read.ptr - this->Text.data());
    return true;
  }
  /// 0 or 1, which need no blank behind them.
  bool Flag(bool& value)
  {
    const char next = this->Take();
    value = next == '1';
    return next == '0' || next == '1';
  }
  std::string_view Word()
  {
    this->Skip();
    const std::size_t begin = this->At;
    while (this->At < this->Text.size() &&
      std::isalpha(static_cast<unsigned char>(this->Text[this->At])))
    {
      ++this->At;
    }
    return this->Text.substr(begin, this->At - begin);
  }

private:
  void Skip()
  {
    while (this->At < this->Text.size() && std::strchr(" \t\r\n\f,", this->Text[this->At]))
    {
      ++this->At;
    }
  }

  std::string_view Text;
  std::size_t At = 0;
};

using Lines = std::vector<std::vector<Point>>;

void AddCurve(std::vector<Point>& line, const std::array<Point, 4>& control)
{
  for (int k = 1; k <= Parts; ++k)
  {
    const double t = static_cast<double>(k) / Parts;
    const double s = 1.0 - t;
    line.emplace_back(s * s * s * control[0] + 3.0 * s * s * t * control[1] +
      3.0 * s * t * t * control[2] + t * t * t * control[3]);
  }
  line.back() = control[3];
}

/// An elliptic arc by its ends, as of the implementation notes of SVG 1.1, F.6.
void AddArc(std::vector<Point>& line, Point radii, double degrees, bool isLarge, bool isPositive,
  const Point& end)
{
  const Point begin = line.back();
  radii = radii.cwiseAbs();
  if (begin == end || !(radii.minCoeff() > 0.0))
  {
    line.push_back(end);
    return;
  }
  const Eigen::Rotation2Dd turn(degrees * Pi / 180.0);
  const Point half = turn.inverse() * Point((begin - end) / 2.0);
  const double excess = half.cwiseQuotient(radii).squaredNorm();
  if (excess > 1.0)
  {
    radii *= std::sqrt(excess);
  }
  const Point scaled = half.cwiseQuotient(radii); // where the ellipse is the unit circle
  const double rest = std::max(0.0, 1.0 / scaled.squaredNorm() - 1.0);
  const double side = isLarge == isPositive ? -1.0 : 1.0;
  const Point centre = side * std::sqrt(rest) * Point(scaled.y(), -scaled.x());
  const Point from = scaled - centre;
  const Point to = -scaled - centre;
  double angle = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  if (isPositive && angle < 0.0)
  {
    angle += 2.0 * Pi;
  }
  else if (!isPositive && angle > 0.0)
  {
    angle -= 2.0 * Pi;
  }
  const Point middle = (begin + end) / 2.0;
  for (int k = 1; k <= Parts; ++k)
  {
    const Point at = centre + Eigen::Rotation2Dd(angle * k / Parts) * from;
    line.push_back(middle + turn * Point(at.cwiseProduct(radii)));
  }
  line.back() = end;
}

/// The lines of the attribute d.
class PathReader
{
public:
  explicit PathReader(std::string_view text) : Words(text) {}

  Status Read(Lines& lines)
  {
    char command = '\0';
    while (!this->Words.AtEnd())
    {
      const std::size_t place = this->Words.Place();
      if (!this->Words.HasNumber())
      {
        command = this->Words.Take();
      }
      else if (command == '\0' || command == 'Z' || command == 'z')
      {
        return this->Fault(place, "a command is missing");
      }
      if (this->Line.empty() && command != 'M' && command != 'm')
      {
        return this->Fault(place, "a path begins with M");
      }
      if (!this->Draw(command, lines))
      {
        return this->Fault(
          place, std::string("the command ") + command + " is unknown or lacks numbers");
      }
      // further pairs behind a move are lines
      command = command == 'M' ? 'L' : command == 'm' ? 'l' : command;
    }
    this->Finish(lines);
    return {};
  }

private:
  static Status Fault(std::size_t place, const std::string& what)
  {
    return { ErrorCode::InvalidFormat,
      "d, at character " + std::to_string(place + 1) + ": " + what + "; draw the path again" };
  }

  void Finish(Lines& lines)
  {
    if (this->Line.size() > 1)
    {
      lines.push_back(this->Line);
    }
    this->Line.clear();
  }

  /// A pair of coordinates, of a relative command from where it begins.
  bool Pair(bool isRelative, const Point& from, Point& pair)
  {
    const bool isRead = this->Words.Number(pair.x()) && this->Words.Number(pair.y());
    pair += isRelative ? from : Point::Zero();
    return isRead;
  }

  bool Draw(char command, Lines& lines)
  {
    const bool isRelative = command >= 'a';
    const char kind = isRelative ? static_cast<char>(command - 'a' + 'A') : command;
    const Point at = this->Line.empty() ? this->Begin : this->Line.back();
    Point mirrored = at; // control point of a smooth curve
    if ((kind == 'S' && this->Last == 'C') || (kind == 'T' && this->Last == 'Q'))
    {
      mirrored = 2.0 * at - this->Control;
    }
    this->Last = kind == 'S' ? 'C' : kind == 'T' ? 'Q' : kind;
    Point a;
    Point b;
    Point end = at;
    switch (kind)
    {
      case 'M':
        this->Finish(lines);
        if (!this->Pair(isRelative, at, end))
        {
          return false;
        }
        this->Begin = end;
        this->Line.assign(1, end);
        return true;
      case 'Z':
        this->Line.push_back(this->Begin);
        this->Finish(lines);
        this->Line.assign(1, this->Begin);
        return true;
      case 'L':
        if (!this->Pair(isRelative, at, end))
        {
          return false;
        }
        this->Line.push_back(end);
        return true;
      case 'H':
      case 'V':
      {
        double& coordinate = kind == 'H' ? end.x() : end.y();
        const double from = coordinate;
        if (!this->Words.Number(coordinate))
        {
          return false;
        }
        coordinate += isRelative ? from : 0.0;
        this->Line.push_back(end);
        return true;
      }
      case 'C':
      case 'S':
        a = mirrored;
        if ((kind == 'C' && !this->Pair(isRelative, at, a)) || !this->Pair(isRelative, at, b) ||
          !this->Pair(isRelative, at, end))
        {
          return false;
        }
        AddCurve(this->Line, { at, a, b, end });
        this->Control = b;
        return true;
      case 'Q':
      case 'T':
        a = mirrored;
        if ((kind == 'Q' && !this->Pair(isRelative, at, a)) || !this->Pair(isRelative, at, end))
        {
          return false;
        }
        AddCurve(this->Line, { at, at + 2.0 / 3.0 * (a - at), end + 2.0 / 3.0 * (a - end), end });
        this->Control = a;
        return true;
      case 'A':
      {
        Point radii;
        double degrees = 0.0;
        bool isLarge = false;
        bool isPositive = false;
        if (!this->Pair(false, at, radii) || !this->Words.Number(degrees) ||
          !this->Words.Flag(isLarge) || !this->Words.Flag(isPositive) ||
          !this->Pair(isRelative, at, end))
        {
          return false;
        }
        AddArc(this->Line, radii, degrees, isLarge, isPositive, end);
        return true;
      }
      default:
        return false;
    }
  }

  Scanner Words;
  std::vector<Point> Line;
  Point Begin = Point::Zero();   ///< of the subpath
  Point Control = Point::Zero(); ///< the last one, absolute
  char Last = '\0';
};

Result<Eigen::Affine2d> ReadTransform(std::string_view text)
{
  Eigen::Affine2d all = Eigen::Affine2d::Identity();
  Scanner words(text);
  while (!words.AtEnd())
  {
    const std::string name(words.Word());
    std::vector<double> n;
    bool isRead = words.Take() == '(';
    while (isRead && words.HasNumber())
    {
      n.push_back(0.0);
      isRead = words.Number(n.back());
    }
    isRead = isRead && words.Take() == ')';
    Eigen::Affine2d one = Eigen::Affine2d::Identity();
    const auto radians = [&n] { return n[0] * Pi / 180.0; };
    if (isRead && name == "translate" && (n.size() == 1 || n.size() == 2))
    {
      one.translation() = Point(n[0], n.size() > 1 ? n[1] : 0.0);
    }
    else if (isRead && name == "scale" && (n.size() == 1 || n.size() == 2))
    {
      one.linear() = Point(n[0], n.back()).asDiagonal();
    }
    else if (isRead && name == "rotate" && (n.size() == 1 || n.size() == 3))
    {
      const Point centre = n.size() == 3 ? Point(n[1], n[2]) : Point(0.0, 0.0);
      one = Eigen::Translation2d(centre) * Eigen::Rotation2Dd(radians()) *
        Eigen::Translation2d(-centre);
    }
    else if (isRead && (name == "skewX" || name == "skewY") && n.size() == 1)
    {
      one.linear()(name == "skewX" ? 0 : 1, name == "skewX" ? 1 : 0) = std::tan(radians());
    }
    else if (isRead && name == "matrix" && n.size() == 6)
    {
      one.linear() << n[0], n[2], n[1], n[3];
      one.translation() = Point(n[4], n[5]);
    }
    else
    {
      return { ErrorCode::InvalidFormat,
        "'" + std::string(text) +
          "' is no transform; write translate, scale, rotate, skewX, skewY or "
          "matrix with their numbers" };
    }
    all = all * one;
  }
  return all;
}

class SvgReader
{
public:
  PointFile Found;
  std::vector<Point> Points;
  std::vector<std::vector<int>> Indices;

  Status Read(const pugi::xml_node& node, const Eigen::Affine2d& outer, int depth)
  {
    const std::string name = LocalName(node);
    static const std::set<std::string> passedOver{ "defs", "symbol", "clipPath", "mask", "marker",
      "pattern", "style", "script", "title", "desc", "metadata", "namedview", "linearGradient",
      "radialGradient", "filter" };
    if (node.type() != pugi::node_element || passedOver.count(name) != 0)
    {
      return {};
    }
    if (depth > MaxDepth)
    {
      return { ErrorCode::TooLarge,
        "more than " + std::to_string(MaxDepth) + " elements are in each other; ungroup them" };
    }
    const auto own = ReadTransform(node.attribute("transform").value());
    if (!own)
    {
      return About(node, own.Status);
    }
    const Eigen::Affine2d all = outer * own.Value;
    if (name == "svg" || name == "g" || name == "a" || name == "switch")
    {
      for (const pugi::xml_node& child : node.children())
      {
        if (Status status = this->Read(child, all, depth + 1); !status)
        {
          return status;
        }
      }
      return {};
    }
    Lines lines;
    bool isKnown = true;
    if (Status status = this->Draw(node, name, lines, isKnown); !status)
    {
      return About(node, status);
    }
    if (!isKnown)
    {
      this->Found.LeftOut.push_back(
        "<" + name + "> is left out: only paths and simple shapes are read");
    }
    return this->Add(lines, all);
  }

private:
  static std::string LocalName(const pugi::xml_node& node)
  {
    const std::string name = node.name();
    return name.substr(name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1);
  }

  static Status About(const pugi::xml_node& node, const Status& status)
  {
    const std::string id = node.attribute("id").value();
    return { status.Code,
      "<" + std::string(node.name()) + (id.empty() ? "" : " id=\"" + id + "\"") +
        ">: " + status.Detail };
  }

  static double Number(const pugi::xml_node& node, const char* name, bool& isSound)
  {
    const std::string_view text = node.attribute(name).value();
    double value = 0.0;
    isSound = isSound && (text.empty() || Scanner(text).Number(value));
    return value;
  }

  Status Draw(const pugi::xml_node& node, const std::string& name, Lines& lines, bool& isKnown)
  {
    bool isSound = true;
    const auto number = [&](const char* attribute) { return Number(node, attribute, isSound); };
    if (name == "path")
    {
      return PathReader(node.attribute("d").value()).Read(lines);
    }
    if (name == "polyline" || name == "polygon")
    {
      Scanner words(node.attribute("points").value());
      std::vector<Point> line;
      while (isSound && !words.AtEnd())
      {
        line.emplace_back(0.0, 0.0);
        isSound = words.Number(line.back().x()) && words.Number(line.back().y());
      }
      if (name == "polygon" && !line.empty())
      {
        line.push_back(line.front());
      }
      lines.push_back(std::move(line));
    }
    else if (name == "line")
    {
      lines.push_back({ { number("x1"), number("y1") }, { number("x2"), number("y2") } });
    }
    else if (name == "rect" && !node.attribute("rx") && !node.attribute("ry"))
    {
      const Point at(number("x"), number("y"));
      const Point size(number("width"), number("height"));
      lines.push_back(
        { at, { at.x() + size.x(), at.y() }, at + size, { at.x(), at.y() + size.y() }, at });
    }
    else if (name == "circle" || name == "ellipse")
    {
      const Point centre(number("cx"), number("cy"));
      const Point radii =
        name == "circle" ? Point(number("r"), number("r")) : Point(number("rx"), number("ry"));
      const Point right = centre + Point(radii.x(), 0.0);
      const Point left = centre - Point(radii.x(), 0.0);
      std::vector<Point> line{ right };
      AddArc(line, radii, 0.0, false, true, left);
      AddArc(line, radii, 0.0, false, true, right);
      lines.push_back(std::move(line));
    }
    else
    {
      isKnown = false;
    }
    return isSound ? Status()
                   : Status(ErrorCode::InvalidFormat,
                       "an attribute is not a finite number; draw the shape again");
  }

  Status Add(const Lines& lines, const Eigen::Affine2d& transform)
  {
    for (const std::vector<Point>& line : lines)
    {
      if (line.size() < 2)
      {
        continue;
      }
      if (this->Points.size() + line.size() > MaxPoints)
      {
        return { ErrorCode::TooLarge,
          "the lines have more than " + std::to_string(MaxPoints) +
            " points; keep those of the outline alone" };
      }
      this->Indices.emplace_back();
      for (const Point& point : line)
      {
        this->Indices.back().push_back(static_cast<int>(this->Points.size()));
        const Point moved = transform * point;
        this->Points.emplace_back(moved.x(), -moved.y());
        if (!moved.allFinite())
        {
          return { ErrorCode::NonFiniteInput,
            "a transform moves a point beyond all numbers; draw the path again" };
        }
      }
    }
    return {};
  }
};
}

Result<PointFile> ReadSvg(std::string_view text)
{
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size());
  const pugi::xml_node root = document.document_element();
  const std::string name = root.name();
  if (!parsed || name.substr(name.rfind(':') + 1) != "svg")
  {
    return { ErrorCode::InvalidFormat,
      parsed ? "the root element is <" + name + ">, not <svg>; save the picture as SVG"
             : std::string("this is not well-formed XML; the file is damaged or truncated") };
  }
  SvgReader reader;
  if (Status status = reader.Read(root, Eigen::Affine2d::Identity(), 0); !status)
  {
    return status;
  }
  if (reader.Points.empty())
  {
    return { ErrorCode::EmptyInput, "it draws no line; draw a path" };
  }
  PointFile found = std::move(reader.Found);
  found.Points = PointMatrix::Zero(static_cast<Eigen::Index>(reader.Points.size()), 3);
  for (std::size_t i = 0; i < reader.Points.size(); ++i)
  {
    found.Points.row(static_cast<Eigen::Index>(i)).head<2>() = reader.Points[i].transpose();
  }
  found.Lines = std::move(reader.Indices);
  return found;
}

bool LooksLikeSvg(std::string_view beginning)
{
  return beginning.find("<svg") != std::string_view::npos ||
    beginning.find("<?xml") != std::string_view::npos;
}
}
