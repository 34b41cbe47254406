// SPDX-License-Identifier: BSD-3-Clause
#include "AbaqusInput.h"
#include "NumberIndex.h"
#include "TextWords.h"
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
std::string Upper(std::string_view text)
{
  std::string upper(text);
  for (char& c : upper)
  {
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return upper;
}

std::string_view Trimmed(std::string_view text)
{
  const char* blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string_view::npos
    ? std::string_view()
    : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// The next field of a line that commas separate, taken off it.
std::string_view NextField(std::string_view& line)
{
  const std::size_t comma = std::min(line.find(','), line.size());
  const std::string_view field = Trimmed(line.substr(0, comma));
  line.remove_prefix(std::min(comma + 1, line.size()));
  return field;
}

constexpr auto Segment = ElementShape::Segment;
constexpr auto Triangle = ElementShape::Triangle;
constexpr auto Square = ElementShape::Quadrilateral;
constexpr auto Tetrahedron = ElementShape::Tetrahedron;
constexpr auto Cube = ElementShape::Hexahedron;
constexpr auto Wedge = ElementShape::Wedge;
constexpr auto Pyramid = ElementShape::Pyramid;

struct Kind
{
  ElementShape Shape;
  int Degree;
};

/// Names of element types begin with a family and the number of their nodes.
bool KindOf(const std::string& type, Kind& kind)
{
  static const std::map<std::string, Kind> whole = { { "STRI65", { Triangle, 2 } },
    { "B21", { Segment, 1 } }, { "B31", { Segment, 1 } }, { "B22", { Segment, 2 } },
    { "B32", { Segment, 2 } }, { "B21H", { Segment, 1 } }, { "B31H", { Segment, 1 } },
    { "B22H", { Segment, 2 } }, { "B32H", { Segment, 2 } }, { "B32R", { Segment, 2 } },
    { "B31R", { Segment, 1 } } };
  static const std::map<int, Kind> solids = { { 4, { Tetrahedron, 1 } }, { 5, { Pyramid, 1 } },
    { 6, { Wedge, 1 } }, { 8, { Cube, 1 } }, { 10, { Tetrahedron, 2 } }, { 15, { Wedge, 2 } },
    { 20, { Cube, 2 } } };
  static const std::map<int, Kind> surfaces = { { 3, { Triangle, 1 } }, { 4, { Square, 1 } },
    { 6, { Triangle, 2 } }, { 8, { Square, 2 } } };
  static const std::map<int, Kind> lines = { { 2, { Segment, 1 } }, { 3, { Segment, 2 } } };
  static const std::map<std::string, const std::map<int, Kind>*> families = { { "C3D", &solids },
    { "DC3D", &solids }, { "AC3D", &solids }, { "SC", &solids }, { "S", &surfaces },
    { "STRI", &surfaces }, { "CPS", &surfaces }, { "CPE", &surfaces }, { "CPEG", &surfaces },
    { "CAX", &surfaces }, { "M3D", &surfaces }, { "R3D", &surfaces }, { "DS", &surfaces },
    { "DC2D", &surfaces }, { "DCAX", &surfaces }, { "AC2D", &surfaces }, { "T2D", &lines },
    { "T3D", &lines }, { "R2D", &lines }, { "DC1D", &lines } };
  if (const auto found = whole.find(type); found != whole.end())
  {
    kind = found->second;
    return true;
  }
  for (const auto& [family, numbers] : families)
  {
    if (type.compare(0, family.size(), family) != 0)
    {
      continue;
    }
    std::size_t at = family.size();
    int number = 0;
    while (at < type.size() && type[at] >= '0' && type[at] <= '9' && number < 1000)
    {
      number = 10 * number + (type[at++] - '0');
    }
    if (const auto found = numbers->find(number); found != numbers->end())
    {
      kind = found->second;
      return true;
    }
  }
  return false;
}

/// Middle nodes come edge by edge: around below, around above, upward.
ElementKind MakeKind(const Kind& kind)
{
  using Edges = std::vector<std::array<int, 2>>;
  static const std::map<ElementShape, Edges> edges = {
    { Segment, { { 0, 1 } } }, { Triangle, { { 0, 1 }, { 1, 2 }, { 2, 0 } } },
    { Square, { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } } },
    { Tetrahedron, { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } } },
    { Cube,
      { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 }, { 0, 4 },
        { 1, 5 }, { 2, 6 }, { 3, 7 } } },
    { Wedge,
      { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 3, 4 }, { 4, 5 }, { 5, 3 }, { 0, 3 }, { 1, 4 }, { 2, 5 } } }
  };
  ElementKind made{ kind.Shape, kind.Degree, true, {} };
  if (kind.Degree == 1)
  {
    made.Places = CornersOf(kind.Shape);
    return made;
  }
  made.IsComplete = kind.Shape == Segment || kind.Shape == Triangle || kind.Shape == Tetrahedron;
  made.Places = QuadraticPlaces(kind.Shape, edges.at(kind.Shape));
  if (kind.Shape == Segment)
  {
    std::swap(made.Places[1], made.Places[2]); // the middle stands between the ends
  }
  return made;
}

/// A set as its lines say it.
struct SetText
{
  std::string Name;
  bool OfNodes = false;
  std::vector<std::array<std::int64_t, 3>> Ranges; ///< first, last, step
  std::vector<std::int64_t> Numbers;
  std::vector<std::string> Sets; ///< whose members are its own too
  std::size_t Line = 0;
};

class Reader
{
public:
  explicit Reader(std::string_view text)
    : Text(text), NodeRows(text.size() / 64), ElementRows(text.size() / 64)
  {
  }

  Result<ElementMesh> Read()
  {
    while (this->Outcome && this->At < this->Text.size())
    {
      const std::string_view line = this->NextLine();
      if (line.empty() || line.substr(0, 2) == "**")
      {
        continue;
      }
      if (line[0] == '*')
      {
        this->ReadKeyword(line);
      }
      else
      {
        this->ReadData(line);
      }
    }
    this->CheckElementComplete();
    if (this->Outcome)
    {
      this->Finish();
    }
    if (!this->Outcome)
    {
      return this->Outcome;
    }
    return std::move(this->Mesh);
  }

private:
  enum class Section
  {
    None, ///< data that is passed over
    Node,
    Element,
    Set,
    Instance
  };

  std::string_view NextLine()
  {
    const std::size_t end = std::min(this->Text.find('\n', this->At), this->Text.size());
    const std::string_view line = Trimmed(this->Text.substr(this->At, end - this->At));
    this->At = end + 1;
    ++this->LineNumber;
    return line;
  }

  void FailAt(std::size_t line, ErrorCode code, const std::string& what)
  {
    if (this->Outcome)
    {
      this->Outcome = { code, "line " + std::to_string(line) + ": " + what };
    }
  }
  void Fail(ErrorCode code, const std::string& what) { this->FailAt(this->LineNumber, code, what); }

  std::string Parameter(const char* name) const
  {
    const auto found = this->Parameters.find(name);
    return found == this->Parameters.end() ? "" : found->second;
  }

  void ReadKeyword(std::string_view line)
  {
    this->CheckElementComplete();
    std::string all(line);
    while (!all.empty() && all.back() == ',' && this->At < this->Text.size())
    {
      all += this->NextLine(); // a keyword line that ends in a comma is continued
    }
    std::string_view rest = all;
    rest.remove_prefix(1);
    std::string keyword = Upper(NextField(rest));
    keyword.erase(std::remove(keyword.begin(), keyword.end(), ' '), keyword.end());
    this->Parameters.clear();
    while (!rest.empty())
    {
      const std::string_view field = NextField(rest);
      const std::size_t equal = std::min(field.find('='), field.size());
      std::string_view value = Trimmed(field.substr(std::min(equal + 1, field.size())));
      if (value.size() > 1 && value.front() == '"' && value.back() == '"')
      {
        value = value.substr(1, value.size() - 2);
      }
      this->Parameters[Upper(Trimmed(field.substr(0, equal)))] = std::string(value);
    }
    this->Current = Section::None;
    this->Begin(keyword);
  }

  void Begin(const std::string& keyword)
  {
    const bool isSet = keyword == "NSET" || keyword == "ELSET";
    const bool isOfMesh = isSet || keyword == "NODE" || keyword == "ELEMENT";
    if (keyword == "INCLUDE" || (isOfMesh && this->Parameters.count("INPUT") != 0))
    {
      this->Fail(ErrorCode::InvalidParameter,
        "*" + keyword + " of another file is not followed; put its lines in place of this one");
    }
    else if (keyword == "NGEN" || keyword == "NFILL" || keyword == "NCOPY" || keyword == "NMAP" ||
      keyword == "ELGEN" || keyword == "ELCOPY" || keyword == "SYSTEM")
    {
      this->Fail(ErrorCode::InvalidParameter,
        "*" + keyword + " is not read; write all nodes and elements out, in Cartesian coordinates");
    }
    else if (keyword == "PART" && ++this->Parts > 1)
    {
      this->Fail(ErrorCode::InvalidParameter, "there is a second *PART; write one part a file");
    }
    else if (keyword == "INSTANCE")
    {
      this->Current = Section::Instance;
      if (++this->Instances > 1)
      {
        this->Fail(ErrorCode::InvalidParameter,
          "there is a second *INSTANCE; write one instance of one part a file");
      }
    }
    else if (keyword == "NODE")
    {
      this->Current = Section::Node;
      const std::string system = Upper(this->Parameter("SYSTEM"));
      if (!system.empty() && system != "R")
      {
        this->Fail(ErrorCode::InvalidParameter,
          "*NODE, SYSTEM=" + system + " is not read; write Cartesian coordinates");
      }
      this->BeginSet(this->Parameter("NSET"), true);
    }
    else if (keyword == "ELEMENT")
    {
      this->BeginElements();
    }
    else if (isSet)
    {
      this->Current = Section::Set;
      const std::string name = this->Parameter(keyword.c_str());
      if (name.empty())
      {
        this->Fail(
          ErrorCode::InvalidFormat, "*" + keyword + " has no name; add " + keyword + "=...");
      }
      this->BeginSet(name, keyword == "NSET");
    }
  }

  /// What follows is added to this set; none without a name.
  void BeginSet(const std::string& name, bool ofNodes)
  {
    this->CurrentSet = -1;
    if (name.empty())
    {
      return;
    }
    const auto [found, isNew] = this->SetRows.emplace(
      std::make_pair(ofNodes, Upper(name)), static_cast<int>(this->Sets.size()));
    this->CurrentSet = found->second;
    if (isNew)
    {
      this->Sets.push_back({});
      this->Sets.back().Name = name;
      this->Sets.back().OfNodes = ofNodes;
      this->Sets.back().Line = this->LineNumber;
    }
  }

  void BeginElements()
  {
    this->Current = Section::Element;
    const std::string type = Upper(this->Parameter("TYPE"));
    Kind kind{};
    if (!KindOf(type, kind))
    {
      this->Fail(ErrorCode::InvalidParameter,
        "elements of type " + Shown(type) +
          " are not read; leave them out, or write solids of 4 to 20 nodes, surfaces of 3 to 8, "
          "lines");
      return;
    }
    const auto [found, isNew] = this->KindRows.emplace(
      std::make_pair(kind.Shape, kind.Degree), static_cast<int>(this->Mesh.Kinds.size()));
    this->CurrentKind = found->second;
    if (isNew)
    {
      this->Mesh.Kinds.push_back(MakeKind(kind));
    }
    this->BeginSet(this->Parameter("ELSET"), false);
  }

  std::int64_t Integer(std::string_view field, const char* meaning, std::int64_t lowest)
  {
    long long value = lowest;
    if (const Status status = ParseInteger(field, lowest, 2147483647999, value); !status)
    {
      this->Fail(ErrorCode::InvalidFormat, std::string(meaning) + ": " + status.Detail);
    }
    return value;
  }

  double Real(std::string_view field)
  {
    double value = 0.0;
    std::string own(field);
    std::replace_if(
      own.begin(), own.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e'); // of Fortran
    const Status status = field.empty() ? Status() : ParseReal(own, value);
    if (!status)
    {
      this->Fail(status.Code, "a coordinate: " + status.Detail);
    }
    else if (std::abs(value) > LargestNumber)
    {
      this->Fail(ErrorCode::TooLarge, "a coordinate: " + BeyondLimit());
    }
    return value;
  }

  void ReadData(std::string_view line)
  {
    switch (this->Current)
    {
      case Section::None:
        break;
      case Section::Node:
        this->ReadNode(line);
        break;
      case Section::Element:
        this->ReadElement(line);
        break;
      case Section::Set:
        this->ReadSet(line);
        break;
      case Section::Instance:
        while (!line.empty())
        {
          if (this->Real(NextField(line)) != 0.0)
          {
            this->Fail(ErrorCode::InvalidParameter,
              "the *INSTANCE is moved, which is not read; write the part where it is");
          }
        }
        break;
    }
  }

  void ReadNode(std::string_view line)
  {
    const std::int64_t number = this->Integer(NextField(line), "the number of a node", 1);
    for (int d = 0; d < 3; ++d)
    {
      this->Coordinates.push_back(this->Real(NextField(line)));
    }
    if (this->Outcome &&
      !this->NodeRows.Add(number, static_cast<std::int64_t>(this->Mesh.NodeNumbers.size())))
    {
      this->Fail(ErrorCode::InvalidTopology,
        "node " + std::to_string(number) + " is there twice; give it another number");
    }
    this->Mesh.NodeNumbers.push_back(number);
    this->AddToSet(number);
  }

  void AddToSet(std::int64_t number)
  {
    if (this->CurrentSet >= 0)
    {
      this->Sets[static_cast<std::size_t>(this->CurrentSet)].Numbers.push_back(number);
    }
  }

  void ReadElement(std::string_view line)
  {
    const auto size = this->Mesh.Kinds[static_cast<std::size_t>(this->CurrentKind)].Places.size();
    if (this->Missing == 0)
    {
      const std::int64_t number = this->Integer(NextField(line), "the number of an element", 1);
      if (this->Outcome &&
        !this->ElementRows.Add(number, static_cast<std::int64_t>(this->Mesh.KindOf.size())))
      {
        this->Fail(ErrorCode::InvalidTopology,
          "element " + std::to_string(number) + " is there twice; give it another number");
      }
      this->Mesh.KindOf.push_back(this->CurrentKind);
      this->Mesh.ElementNumbers.push_back(number);
      this->Mesh.Begin.push_back(static_cast<std::int64_t>(this->Mesh.Nodes.size()));
      this->AddToSet(number);
      this->Missing = size;
    }
    while (!line.empty() && this->Outcome)
    {
      if (this->Missing == 0)
      {
        this->Fail(ErrorCode::InvalidFormat,
          "element " + std::to_string(this->Mesh.ElementNumbers.back()) + " has more than its " +
            std::to_string(size) + " nodes; TYPE or the line is wrong");
        return;
      }
      this->Mesh.Nodes.push_back(this->Integer(NextField(line), "a node of an element", 1));
      --this->Missing;
    }
  }

  void CheckElementComplete()
  {
    if (this->Missing > 0)
    {
      this->Fail(ErrorCode::InvalidFormat,
        "element " + std::to_string(this->Mesh.ElementNumbers.back()) + " lacks " +
          std::to_string(this->Missing) + " nodes; TYPE is wrong, or the file is truncated");
    }
    this->Missing = 0;
  }

  void ReadSet(std::string_view line)
  {
    if (this->CurrentSet < 0)
    {
      return;
    }
    SetText& set = this->Sets[static_cast<std::size_t>(this->CurrentSet)];
    if (this->Parameters.count("GENERATE") != 0)
    {
      const std::int64_t first = this->Integer(NextField(line), "the first number of a set", 1);
      const std::int64_t last =
        line.empty() ? first : this->Integer(NextField(line), "the last number of a set", first);
      const std::int64_t step =
        line.empty() ? 1 : this->Integer(NextField(line), "the step of a set", 1);
      set.Ranges.push_back({ first, last, step });
      return;
    }
    while (!line.empty())
    {
      std::string_view field = NextField(line);
      if (field.empty())
      {
        continue;
      }
      if (field[0] >= '0' && field[0] <= '9')
      {
        // a number of the instance "Part-1-1.7" is one of its part
        set.Numbers.push_back(this->Integer(field, "a number of a set", 1));
      }
      else
      {
        set.Sets.push_back(Upper(field));
      }
    }
  }

  void AddRanges(const SetText& set, std::vector<std::int64_t>& members) const
  {
    const auto& numbers = set.OfNodes ? this->Mesh.NodeNumbers : this->Mesh.ElementNumbers;
    const NumberIndex& rows = set.OfNodes ? this->NodeRows : this->ElementRows;
    for (const auto& [first, last, step] : set.Ranges)
    {
      if ((last - first) / step <= static_cast<std::int64_t>(numbers.size()))
      {
        for (std::int64_t number = first; number <= last; number += step)
        {
          if (const std::int64_t row = rows.Find(number); row >= 0)
          {
            members.push_back(row);
          }
        }
        continue;
      }
      for (std::size_t row = 0; row < numbers.size(); ++row)
      {
        if (numbers[row] >= first && numbers[row] <= last && (numbers[row] - first) % step == 0)
        {
          members.push_back(static_cast<std::int64_t>(row));
        }
      }
    }
  }

  void FinishSets()
  {
    std::size_t total = 0;
    for (const SetText& set : this->Sets)
    {
      ElementSet made{ set.Name, set.OfNodes, {} };
      this->AddRanges(set, made.Members);
      const NumberIndex& rows = set.OfNodes ? this->NodeRows : this->ElementRows;
      for (const std::int64_t number : set.Numbers)
      {
        const std::int64_t row = rows.Find(number);
        if (row < 0)
        {
          this->FailAt(set.Line, ErrorCode::InvalidTopology,
            "set " + Shown(set.Name) + " has " + (set.OfNodes ? "node " : "element ") +
              std::to_string(number) + ", which is not there; correct the number or leave it out");
        }
        made.Members.push_back(row);
      }
      for (const std::string& other : set.Sets)
      {
        const auto found = this->SetRows.find({ set.OfNodes, other });
        if (found == this->SetRows.end() ||
          static_cast<std::size_t>(found->second) >= this->Mesh.Sets.size())
        {
          this->FailAt(set.Line, ErrorCode::InvalidFormat,
            "set " + Shown(set.Name) + " has the set " + Shown(other) +
              ", which is none that stands before it");
          return;
        }
        const auto& members = this->Mesh.Sets[static_cast<std::size_t>(found->second)].Members;
        made.Members.insert(made.Members.end(), members.begin(), members.end());
      }
      std::sort(made.Members.begin(), made.Members.end());
      made.Members.erase(std::unique(made.Members.begin(), made.Members.end()), made.Members.end());
      total += made.Members.size();
      if (total > 100'000'000 + this->Text.size())
      {
        this->FailAt(set.Line, ErrorCode::TooLarge,
          "the sets have more than 100000000 members; leave out those that are not needed");
      }
      if (!this->Outcome)
      {
        return;
      }
      this->Mesh.Sets.push_back(std::move(made));
    }
  }

  /// Element sets as groups.
  void FinishGroups()
  {
    ElementMesh& mesh = this->Mesh;
    std::vector<std::vector<int>> lists(mesh.KindOf.size());
    int id = 0;
    for (const ElementSet& set : mesh.Sets)
    {
      if (set.OfNodes)
      {
        continue;
      }
      ++id;
      bool has[4] = {};
      for (const std::int64_t row : set.Members)
      {
        lists[static_cast<std::size_t>(row)].push_back(id);
        const int kind = mesh.KindOf[static_cast<std::size_t>(row)];
        has[DimensionOf(mesh.Kinds[static_cast<std::size_t>(kind)].Shape)] = true;
      }
      for (int dimension = 1; dimension <= 3; ++dimension)
      {
        if (has[dimension])
        {
          mesh.Groups.push_back({ set.Name, dimension, id });
        }
      }
    }
    std::map<std::vector<int>, int> rows;
    for (std::vector<int>& list : lists)
    {
      const auto [found, isNew] = rows.emplace(list, static_cast<int>(mesh.GroupLists.size()));
      mesh.GroupListOf.push_back(found->second);
      if (isNew)
      {
        mesh.GroupLists.push_back(std::move(list));
      }
    }
  }

  void Finish()
  {
    ElementMesh& mesh = this->Mesh;
    if (mesh.KindOf.empty())
    {
      this->Outcome = { ErrorCode::EmptyInput, "the file has no *ELEMENT; write the mesh into it" };
      return;
    }
    mesh.Begin.push_back(static_cast<std::int64_t>(mesh.Nodes.size()));
    mesh.Points = Eigen::Map<const PointMatrix>(
      this->Coordinates.data(), static_cast<Eigen::Index>(this->Coordinates.size() / 3), 3);
    for (std::size_t e = 0; e < mesh.KindOf.size(); ++e)
    {
      for (std::int64_t k = mesh.Begin[e]; k < mesh.Begin[e + 1]; ++k)
      {
        std::int64_t& node = mesh.Nodes[static_cast<std::size_t>(k)];
        const std::int64_t row = this->NodeRows.Find(node);
        if (row < 0)
        {
          this->Outcome = { ErrorCode::InvalidTopology,
            "element " + std::to_string(mesh.ElementNumbers[e]) + " has node " +
              std::to_string(node) +
              ", which *NODE does not have; correct the number or add the node" };
          return;
        }
        node = row;
      }
    }
    this->FinishSets();
    if (this->Outcome)
    {
      this->FinishGroups();
    }
  }

  std::string_view Text;
  std::size_t At = 0;
  std::size_t LineNumber = 0;
  Status Outcome;
  ElementMesh Mesh;
  std::vector<double> Coordinates;
  NumberIndex NodeRows;
  NumberIndex ElementRows;
  std::map<std::pair<ElementShape, int>, int> KindRows;
  std::map<std::pair<bool, std::string>, int> SetRows;
  std::vector<SetText> Sets;
  std::map<std::string, std::string> Parameters; ///< of the keyword, in upper case
  Section Current = Section::None;
  int CurrentKind = 0;
  int CurrentSet = -1;
  std::size_t Missing = 0; ///< nodes of the element that is being read
  int Parts = 0;
  int Instances = 0;
};
}

Result<ElementMesh> ReadAbaqusInput(std::string_view text)
{
  return Reader(text).Read();
}

bool LooksLikeAbaqusInput(std::string_view beginning)
{
  const std::size_t begin = beginning.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && beginning[begin] == '*';
}
}
