// SPDX-License-Identifier: BSD-3-Clause
#include "GismoHierarchy.h"
#include "GismoXml.h"
#include "TextWords.h"
#include <knotwork/SplineCore/PatchDirections.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
constexpr long long MaxInt = std::numeric_limits<int>::max();
constexpr int MaxComponents = 64;
/// A hierarchy may have this many functions on elements, counted by element, beside 64 for every
/// character of the text: far more than one that the text has all coefficients for.
constexpr double FreeLocalFunctions = 4.0 * 1024.0 * 1024.0;

struct GeometryType
{
  const char* Name;
  int Dimension;
  bool Rational;
  bool Hierarchical;
};
constexpr GeometryType Types[] = {
  { "BSpline", 1, false, false },
  { "TensorBSpline1", 1, false, false },
  { "TensorBSpline2", 2, false, false },
  { "TensorBSpline3", 3, false, false },
  { "Nurbs", 1, true, false },
  { "TensorNurbs1", 1, true, false },
  { "TensorNurbs2", 2, true, false },
  { "TensorNurbs3", 3, true, false },
  { "THBSpline", 1, false, true },
  { "THBSpline1", 1, false, true },
  { "THBSpline2", 2, false, true },
  { "THBSpline3", 3, false, true },
  { "RationalTHBSpline", 1, true, true },
  { "RationalTHBSpline1", 1, true, true },
  { "RationalTHBSpline2", 2, true, true },
  { "RationalTHBSpline3", 3, true, true },
};

/// A real number, or the quotient of two as in 1/3.
Status ParseQuotient(std::string_view word, double& value)
{
  const std::size_t slash = word.find('/');
  if (slash == std::string_view::npos)
  {
    return ParseReal(word, value);
  }
  double numerator = 0.0;
  double denominator = 0.0;
  const Status above = ParseReal(word.substr(0, slash), numerator);
  const Status below = ParseReal(word.substr(slash + 1), denominator);
  value = numerator / denominator;
  return above && below && denominator != 0.0 && std::isfinite(value)
    ? Status()
    : Status(ErrorCode::InvalidFormat, Shown(word) + " is not a number or quotient of numbers");
}

/// Reads one text; the first failure stays in Outcome and every later step does nothing.
class XmlParser
{
public:
  explicit XmlParser(std::string_view text) : Text(text) {}
  Result<SplineFile> Read();

private:
  /// Counts on from the place that was asked for last: most questions come in the text's order.
  std::size_t LineAt(std::ptrdiff_t offset)
  {
    const auto to =
      std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), this->Text.size());
    if (to < this->CountedTo)
    {
      this->CountedTo = 0;
      this->CountedLines = 0;
    }
    const auto begin = this->Text.begin();
    this->CountedLines +=
      static_cast<std::size_t>(std::count(begin + this->CountedTo, begin + to, '\n'));
    this->CountedTo = to;
    return this->CountedLines + 1;
  }
  void Fail(ErrorCode code, std::size_t line, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(line) + ", " + what };
    }
  }
  void Fail(ErrorCode code, pugi::xml_node node, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Fail(code, this->LineAt(node.offset_debug()), Name(node) + ": " + what);
    }
  }
  static std::string Name(pugi::xml_node node)
  {
    return "<" + Shown(node.name()).substr(1, std::string_view(node.name()).size()) + ">";
  }

  /// The only child of a name. Fails when there is none.
  pugi::xml_node Child(pugi::xml_node node, const char* name)
  {
    const pugi::xml_node child = node.child(name);
    if (this->Outcome && !child)
    {
      this->Fail(ErrorCode::InvalidFormat, node,
        std::string("has no element <") + name + ">; the file is incomplete");
    }
    return child;
  }
  int IntegerAttribute(pugi::xml_node node, const char* name, long long lowest, long long highest,
    ErrorCode code = ErrorCode::InvalidFormat)
  {
    long long value = lowest;
    if (!this->Outcome)
    {
      return static_cast<int>(value);
    }
    const pugi::xml_attribute attribute = node.attribute(name);
    if (!attribute)
    {
      this->Fail(ErrorCode::InvalidFormat, node, std::string("has no attribute ") + name);
    }
    else if (const Status status = ParseInteger(attribute.value(), lowest, highest, value); !status)
    {
      this->Fail(code, node, std::string("attribute ") + name + ": " + status.Detail);
      value = lowest;
    }
    return static_cast<int>(value);
  }
  /// Calls visit(word) for every word of an element's own text; visit's failure is the element's.
  template <typename Visit>
  void ForEachWord(pugi::xml_node node, Visit&& visit);
  std::vector<double> Reals(pugi::xml_node node);
  std::vector<long long> Integers(pugi::xml_node node, long long lowest, long long highest);

  void ReadElement(pugi::xml_node node, int depth, SplineFile& file);
  void ReadGeometry(pugi::xml_node node, SplineFile& file);
  template <int Dim>
  void ReadSpline(pugi::xml_node node, const GeometryType& type, SplineFile& file);
  template <int Dim>
  SplineSpacePtr<Dim> ReadSpace(pugi::xml_node basis, bool hierarchical, std::size_t numbers,
    long long components, pugi::xml_node coefficients);
  KnotVector ReadKnots(pugi::xml_node basis);
  void ReadId(pugi::xml_node node);
  void NumberSplines(SplineFile& file);
  void ReadMultiPatch(pugi::xml_node node, SplineFile& file);

  std::string_view Text;
  std::size_t CountedTo = 0; ///< see LineAt
  std::size_t CountedLines = 0;
  Status Outcome;
  pugi::xml_document Document;
  std::vector<int> Ids; // of the splines as the file says, -1 for none
  std::map<int, int> SplineOfId;
};

template <typename Visit>
void XmlParser::ForEachWord(pugi::xml_node node, Visit&& visit)
{
  if (!this->Outcome)
  {
    return;
  }
  const std::string_view format = node.attribute("format").value();
  if (!format.empty() && format != "ASCII" && format != "ascii")
  {
    this->Fail(ErrorCode::InvalidFormat, node,
      "has the format " + Shown(format) +
        "; only numbers as text can be read: write the file as ASCII");
    return;
  }
  std::size_t number = 0;
  for (pugi::xml_node part : node.children())
  {
    if (part.type() == pugi::node_element)
    {
      this->Fail(ErrorCode::InvalidFormat, part, "stands where numbers are expected");
      return;
    }
    const std::string_view text = part.value();
    WordScanner words(text);
    while (!words.AtEnd())
    {
      const Status status = visit(words.Next());
      ++number;
      if (!status)
      {
        this->Fail(status.Code, this->LineAt(part.offset_debug()) + words.Line() - 1,
          Name(node) + ", number " + std::to_string(number) + ": " + status.Detail);
        return;
      }
    }
  }
}

std::vector<double> XmlParser::Reals(pugi::xml_node node)
{
  std::vector<double> values;
  this->ForEachWord(node,
    [&](std::string_view word)
    {
      values.push_back(0.0);
      return ParseQuotient(word, values.back());
    });
  return values;
}

std::vector<long long> XmlParser::Integers(pugi::xml_node node, long long lowest, long long highest)
{
  std::vector<long long> values;
  this->ForEachWord(node,
    [&](std::string_view word)
    {
      values.push_back(0);
      return ParseInteger(word, lowest, highest, values.back());
    });
  return values;
}

Result<SplineFile> XmlParser::Read()
{
  if (this->Text.empty())
  {
    return { ErrorCode::EmptyInput, "the XML text is empty" };
  }
  const pugi::xml_parse_result parsed = this->Document.load_buffer(
    this->Text.data(), this->Text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed)
  {
    return { ErrorCode::InvalidFormat,
      "line " + std::to_string(this->LineAt(parsed.offset)) + ": this is not well-formed XML (" +
        parsed.description() + "); the file is damaged or truncated" };
  }
  const pugi::xml_node root = this->Document.document_element();
  if (std::string_view(root.name()) != "xml")
  {
    return { ErrorCode::InvalidFormat,
      "line " + std::to_string(this->LineAt(root.offset_debug())) + ": the root element is " +
        Name(root) + ", that of a G+Smo file is <xml>" };
  }
  SplineFile file;
  for (pugi::xml_node node : root.children())
  {
    this->ReadElement(node, 0, file);
  }
  if (this->Outcome && file.Splines.empty())
  {
    this->Outcome = { ErrorCode::EmptyInput,
      file.LeftOut.empty() ? "the file holds no <Geometry>" : file.LeftOut.front() };
  }
  this->NumberSplines(file);
  for (pugi::xml_node node : root.children("MultiPatch"))
  {
    this->ReadMultiPatch(node, file);
  }
  if (!this->Outcome)
  {
    return this->Outcome;
  }
  return file;
}

/// Geometries, also those within the loops of a planar domain. Other elements that hold geometry
/// are named, those that hold none (functions, matrices, options) are nothing that is read.
void XmlParser::ReadElement(pugi::xml_node node, int depth, SplineFile& file)
{
  const std::string_view name = node.name();
  if (name == "Geometry")
  {
    this->ReadGeometry(node, file);
  }
  else if ((name == "PlanarDomain" && depth == 0) || (name == "CurveLoop" && depth < 2))
  {
    for (pugi::xml_node part : node.children())
    {
      this->ReadElement(part, depth + 1, file);
    }
  }
  else if (name == "Mesh" ||
    node.find_node(
      [](pugi::xml_node inner) { return std::string_view(inner.name()) == "Geometry"; }))
  {
    file.LeftOut.push_back("line " + std::to_string(this->LineAt(node.offset_debug())) + ", " +
      Name(node) +
      " is left out; geometries are read at the top of the file and in <PlanarDomain>");
  }
}

void XmlParser::ReadGeometry(pugi::xml_node node, SplineFile& file)
{
  if (!this->Outcome)
  {
    return;
  }
  const std::string_view name = node.attribute("type").value();
  const auto type = std::find_if(std::begin(Types), std::end(Types),
    [&](const GeometryType& known) { return name == known.Name; });
  if (type == std::end(Types))
  {
    file.LeftOut.push_back("line " + std::to_string(this->LineAt(node.offset_debug())) +
      ", <Geometry> of type " + Shown(name) +
      " is left out; types that can be read: BSpline, Nurbs, TensorBSpline, TensorNurbs, "
      "THBSpline, "
      "RationalTHBSpline with 1 to 3 parameters");
    return;
  }
  type->Dimension == 1     ? this->ReadSpline<1>(node, *type, file)
    : type->Dimension == 2 ? this->ReadSpline<2>(node, *type, file)
                           : this->ReadSpline<3>(node, *type, file);
}

KnotVector XmlParser::ReadKnots(pugi::xml_node basis)
{
  const std::string_view periodic = basis.attribute("periodic").value();
  if (this->Outcome && !periodic.empty() && periodic != "0" && periodic != "false")
  {
    this->Fail(ErrorCode::InvalidFormat, basis,
      "a periodic basis cannot be read; convert it to a clamped one");
  }
  const pugi::xml_node node = this->Child(basis, "KnotVector");
  const int degree = this->IntegerAttribute(node, "degree", 1, MaxDegree, ErrorCode::InvalidDegree);
  std::vector<double> knots = this->Reals(node);
  if (!this->Outcome)
  {
    return {};
  }
  Result<KnotVector> made = KnotVector::Create(degree, std::move(knots));
  if (!made)
  {
    this->Fail(made.Status.Code, node, made.Status.Detail);
  }
  return made.Value;
}

template <int Dim>
SplineSpacePtr<Dim> XmlParser::ReadSpace(pugi::xml_node basis, bool hierarchical,
  std::size_t numbers, long long components, pugi::xml_node coefficients)
{
  const pugi::xml_node tensor = hierarchical ? this->Child(basis, "Basis") : basis;
  std::array<KnotVector, Dim> knots;
  double functions = 1.0;
  if (Dim == 1 && this->Outcome && !tensor.child("Basis"))
  {
    knots[0] = this->ReadKnots(tensor);
    functions = knots[0].NumFunctions();
  }
  else if (this->Outcome)
  {
    const auto bases = tensor.children("Basis");
    const auto count = std::distance(bases.begin(), bases.end());
    if (count != Dim)
    {
      this->Fail(ErrorCode::InvalidFormat, tensor,
        "has " + std::to_string(count) + " elements <Basis>, its geometry has " +
          std::to_string(Dim) + " parameters");
      return {};
    }
    std::size_t d = 0;
    for (pugi::xml_node direction : bases)
    {
      knots[d] = this->ReadKnots(direction);
      functions *= knots[d++].NumFunctions();
    }
  }
  const auto expect = [&](double rows)
  {
    if (rows * static_cast<double>(components) != static_cast<double>(numbers))
    {
      this->Fail(ErrorCode::SizeMismatch, coefficients,
        std::to_string(numbers) + " numbers; the basis has " +
          std::to_string(static_cast<long long>(std::min(rows, 9e18))) + " functions, with " +
          std::to_string(components) + " coordinates each");
    }
  };
  Result<SplineSpacePtr<Dim>> space;
  if (hierarchical)
  {
    std::vector<HierarchyBox<Dim>> boxes;
    for (pugi::xml_node node : basis.children("box"))
    {
      HierarchyBox<Dim> box;
      box.Level = this->IntegerAttribute(node, "level", 0, MaxInt, ErrorCode::InvalidTopology);
      const std::vector<long long> corners = this->Integers(node, 0, MaxInt);
      if (this->Outcome && corners.size() != 2 * Dim)
      {
        this->Fail(ErrorCode::InvalidFormat, node,
          std::to_string(corners.size()) + " numbers; a box has " + std::to_string(2 * Dim) +
            ": its lower and its upper corner");
      }
      if (!this->Outcome)
      {
        return {};
      }
      std::copy_n(corners.begin(), Dim, box.Lower.begin());
      std::copy_n(corners.begin() + Dim, Dim, box.Upper.begin());
      boxes.push_back(box);
    }
    if (!this->Outcome)
    {
      return {};
    }
    space = MakeGismoSpace<Dim>(
      knots, std::move(boxes), FreeLocalFunctions + 64.0 * static_cast<double>(this->Text.size()));
    if (space)
    {
      expect(space.Value->NumFunctions);
    }
  }
  else
  {
    if (this->Outcome)
    {
      expect(functions);
    }
    if (!this->Outcome)
    {
      return {};
    }
    space = MakeTensorSpace<Dim>(knots);
  }
  if (!space)
  {
    this->Fail(space.Status.Code, basis, space.Status.Detail);
  }
  return space.Value;
}

template <int Dim>
void XmlParser::ReadSpline(pugi::xml_node node, const GeometryType& type, SplineFile& file)
{
  const pugi::xml_node basis = this->Child(node, "Basis");
  const pugi::xml_node coefficients = this->Child(node, "coefs");
  const int components = this->IntegerAttribute(coefficients, "geoDim", 1, MaxComponents);
  if (this->Outcome && node.child("transform"))
  {
    this->Fail(ErrorCode::InvalidFormat, node.child("transform"),
      "transformations cannot be read; apply them to the coefficients");
  }
  const std::vector<double> points = this->Reals(coefficients);
  const pugi::xml_node source = type.Rational ? this->Child(basis, "Basis") : basis;
  if (!this->Outcome)
  {
    return;
  }
  Spline<Dim> spline;
  spline.Space =
    this->ReadSpace<Dim>(source, type.Hierarchical, points.size(), components, coefficients);
  if (!this->Outcome)
  {
    return;
  }
  spline.ControlPoints =
    Eigen::Map<const PointMatrix>(points.data(), spline.Space->NumFunctions, components);
  if (type.Rational)
  {
    const pugi::xml_node weightNode = this->Child(basis, "weights");
    const std::vector<double> weights = this->Reals(weightNode);
    if (this->Outcome && weights.size() != static_cast<std::size_t>(spline.Space->NumFunctions))
    {
      this->Fail(ErrorCode::SizeMismatch, weightNode,
        std::to_string(weights.size()) + " weights for " +
          std::to_string(spline.Space->NumFunctions) + " functions");
    }
    for (std::size_t i = 0; i < weights.size() && this->Outcome; ++i)
    {
      if (!(weights[i] > 0.0))
      {
        this->Fail(ErrorCode::InvalidWeight, weightNode,
          "number " + std::to_string(i + 1) + " is not positive; weights must be");
      }
    }
    if (!this->Outcome)
    {
      return;
    }
    spline.Weights = Eigen::Map<const Eigen::VectorXd>(weights.data(), spline.Space->NumFunctions);
  }
  if (Status status = spline.Check(); !status)
  {
    this->Fail(status.Code, node, status.Detail);
    return;
  }
  this->ReadId(node);
  file.Splines.emplace_back(std::move(spline));
}

/// An empty id is none. Ids within a planar domain count within it alone.
void XmlParser::ReadId(pugi::xml_node node)
{
  const bool hasId =
    *node.attribute("id").value() != '\0' && node.parent() == this->Document.document_element();
  const int id = hasId ? this->IntegerAttribute(node, "id", 0, MaxInt) : -1;
  if (this->Outcome && id >= 0 &&
    !this->SplineOfId.emplace(id, static_cast<int>(this->Ids.size())).second)
  {
    this->Fail(ErrorCode::InvalidFormat, node,
      "another <Geometry> has the id " + std::to_string(id) + " too; give every one its own");
  }
  this->Ids.push_back(id);
}

/// Splines without an id get the smallest ids that are free.
void XmlParser::NumberSplines(SplineFile& file)
{
  int next = 0;
  for (std::size_t i = 0; i < this->Ids.size() && this->Outcome; ++i)
  {
    if (this->Ids[i] < 0)
    {
      while (!this->SplineOfId.emplace(next, static_cast<int>(i)).second)
      {
        ++next;
      }
      this->Ids[i] = next;
    }
  }
  file.Ids = this->Ids;
}

void XmlParser::ReadMultiPatch(pugi::xml_node node, SplineFile& file)
{
  if (!this->Outcome)
  {
    return;
  }
  StatedPatches made;
  made.Dimension = this->IntegerAttribute(node, "parDim", 1, MaxInt);
  const pugi::xml_node patches = this->Child(node, "patches");
  const std::string_view type = patches.attribute("type").value();
  std::vector<long long> ids = this->Integers(patches, 0, MaxInt);
  if (this->Outcome && type == "id_range")
  {
    if (ids.size() != 2 || ids[0] > ids[1] ||
      ids[1] - ids[0] >= static_cast<long long>(file.Splines.size()))
    {
      this->Fail(ErrorCode::InvalidFormat, patches,
        "a range is the first and the last id of geometries of this file");
      return;
    }
    const long long last = ids[1];
    ids.pop_back();
    while (ids.back() < last)
    {
      ids.push_back(ids.back() + 1);
    }
  }
  else if (this->Outcome && type != "id_index")
  {
    this->Fail(ErrorCode::InvalidFormat, patches,
      "has the type " + Shown(type) + "; types are id_range and id_index");
  }
  std::set<int> members;
  for (std::size_t i = 0; i < ids.size() && this->Outcome; ++i)
  {
    const auto found = this->SplineOfId.find(static_cast<int>(ids[i]));
    const bool fits = found != this->SplineOfId.end() &&
      static_cast<int>(file.Splines[static_cast<std::size_t>(found->second)].index()) + 1 ==
        made.Dimension;
    if (!fits || !members.insert(found->second).second)
    {
      this->Fail(ErrorCode::InvalidFormat, patches,
        "id " + std::to_string(ids[i]) +
          (!fits ? " is not that of a geometry of " + std::to_string(made.Dimension) +
                " parameters that can be read"
                 : std::string(" occurs twice")));
      return;
    }
    made.Splines.push_back(found->second);
  }

  // Patches are given by id; returns the index of the spline, or -1 for a patch that is no member.
  const auto member = [&](long long id)
  {
    const auto found = this->SplineOfId.find(static_cast<int>(id));
    return found != this->SplineOfId.end() && members.count(found->second) > 0 ? found->second : -1;
  };
  const auto dimension = static_cast<std::size_t>(made.Dimension);
  const auto readSide = [&](const long long* pair, pugi::xml_node list)
  {
    const PatchSide side{ member(pair[0]), static_cast<int>(pair[1]) - 1 };
    if (side.Patch < 0 || side.Side < 0 || side.Side >= 2 * made.Dimension)
    {
      this->Fail(ErrorCode::InvalidFormat, list,
        "there is no side " + std::to_string(pair[1]) + " of a patch with id " +
          std::to_string(pair[0]) + "; sides are 1 to " + std::to_string(2 * made.Dimension));
    }
    return side;
  };
  for (pugi::xml_node list : node.children("interfaces"))
  {
    const std::vector<long long> rows = this->Integers(list, 0, MaxInt);
    const std::size_t columns = 4 + 2 * dimension;
    if (this->Outcome && rows.size() % columns != 0)
    {
      this->Fail(ErrorCode::InvalidFormat, list,
        std::to_string(rows.size()) + " numbers; an interface has " + std::to_string(columns) +
          ": patch, side, patch, side, directions, orientations");
    }
    for (std::size_t i = 0; i < rows.size() && this->Outcome; i += columns)
    {
      const long long* row = rows.data() + i;
      PatchInterface next;
      next.Sides = { readSide(row, list), readSide(row + 2, list) };
      if (!this->Outcome)
      {
        return;
      }
      PatchDirections directions;
      std::copy_n(row + 4, dimension, directions.Direction.begin());
      std::copy_n(row + 4 + dimension, dimension, directions.Sense.begin());
      if (!SetDirections(directions, made.Dimension, next))
      {
        this->Fail(ErrorCode::InvalidFormat, list,
          "interface " + std::to_string(i / columns) +
            ": directions are a permutation of 0, 1, ... that sends the one across the first side "
            "to that across the second, orientations are 0 or 1");
        return;
      }
      made.Topology.Interfaces.push_back(next);
    }
  }
  for (pugi::xml_node list : node.children("boundary"))
  {
    const std::vector<long long> rows = this->Integers(list, 0, MaxInt);
    if (this->Outcome && rows.size() % 2 != 0)
    {
      this->Fail(ErrorCode::InvalidFormat, list,
        std::to_string(rows.size()) + " numbers; a side has 2: patch and side");
    }
    for (std::size_t i = 0; i < rows.size() && this->Outcome; i += 2)
    {
      made.Topology.Boundary.push_back(readSide(rows.data() + i, list));
    }
  }
  if (this->Outcome)
  {
    file.MultiPatches.push_back(std::move(made));
  }
}
}

bool LooksLikeGismoXml(std::string_view beginning)
{
  std::size_t at = 0;
  const auto startsWith = [&](std::string_view word)
  { return beginning.substr(at, word.size()) == word; };
  const auto skipTo = [&](std::string_view end)
  {
    at = beginning.find(end, at);
    at = at == std::string_view::npos ? beginning.size() : at + end.size();
  };
  at += startsWith("\xef\xbb\xbf") ? 3 : 0;
  while (at < beginning.size())
  {
    at = std::min(beginning.find_first_not_of(" \t\r\n", at), beginning.size());
    if (startsWith("<?"))
    {
      skipTo("?>");
    }
    else if (startsWith("<!--"))
    {
      skipTo("-->");
    }
    else
    {
      return startsWith("<xml>") || startsWith("<xml ") || startsWith("<xml\n");
    }
  }
  return false;
}

Result<SplineFile> ReadGismoXml(std::string_view text)
{
  return XmlParser(text).Read();
}
}
