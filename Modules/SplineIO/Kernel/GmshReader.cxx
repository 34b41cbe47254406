// SPDX-License-Identifier: BSD-3-Clause
#include "GmshKinds.h"
#include "GmshMesh.h"
#include "MshCursor.h"
#include "NumberIndex.h"

#include <map>

namespace knotwork
{
namespace
{
class Reader
{
public:
  explicit Reader(std::string_view text) : Cursor(text), Rows(text.size() / 64) {}

  Result<ElementMesh> Read()
  {
    this->ReadFormat();
    while (this->Cursor.Outcome && !this->Cursor.AtEnd())
    {
      const std::string_view word = this->Cursor.Line();
      if (word.size() < 2 || word[0] != '$')
      {
        this->Cursor.Fail(ErrorCode::InvalidFormat,
          Shown(word) + " stands where a section ($Nodes, ...) must begin; a count is wrong");
        break;
      }
      this->Cursor.Section = std::string(word.substr(1));
      this->ReadSection(this->Cursor.Section);
      this->Cursor.Section.clear();
    }
    if (this->Cursor.Outcome)
    {
      this->Finish();
    }
    if (!this->Cursor.Outcome)
    {
      return this->Cursor.Outcome;
    }
    return std::move(this->Mesh);
  }

private:
  void ReadFormat()
  {
    MshCursor& cursor = this->Cursor;
    if (const std::string_view word = cursor.Word(); word != "$MeshFormat")
    {
      cursor.Fail(ErrorCode::InvalidFormat,
        Shown(word) + " stands where $MeshFormat must; save the mesh as MSH 4.1");
      return;
    }
    cursor.Section = "MeshFormat";
    const std::string version(cursor.Word());
    this->IsNew = version == "4.1";
    if (!this->IsNew && version != "2.2" && version != "2.1" && version != "2")
    {
      cursor.Fail(ErrorCode::InvalidParameter,
        "version " + Shown(version) +
          " is not read; save it with Mesh.MshFileVersion = 4.1 or 2.2");
      return;
    }
    this->IsBinary = cursor.TextInteger("the kind of file (0 text, 1 binary)", 0, 1) == 1;
    cursor.TextInteger("the size of numbers", 8, 8);
    if (this->IsBinary && cursor.Outcome)
    {
      cursor.Line(); // the end of this one
      cursor.IsBinary = true;
      const int one = cursor.Int("the number 1 that tells the byte order");
      cursor.IsSwapped = one == 0x01000000;
      if (one != 1 && !cursor.IsSwapped)
      {
        cursor.Fail(ErrorCode::InvalidFormat,
          "the number that tells the byte order is not 1; the file is damaged");
      }
    }
    this->End();
  }

  /// Behind a section's numbers.
  void End()
  {
    const bool wasBinary = this->Cursor.IsBinary;
    this->Cursor.ExpectEnd(this->Cursor.Section);
    this->Cursor.IsBinary = this->Cursor.Outcome ? false : wasBinary;
    this->Cursor.Section.clear();
  }

  void ReadSection(const std::string& name)
  {
    MshCursor& cursor = this->Cursor;
    cursor.IsBinary = this->IsBinary && name != "PhysicalNames";
    if (name == "PhysicalNames")
    {
      this->ReadNames();
    }
    else if (name == "Entities" && this->IsNew)
    {
      this->ReadEntities();
    }
    else if (name == "Nodes")
    {
      this->IsNew ? this->ReadNodeBlocks() : this->ReadOldNodes();
    }
    else if (name == "Elements")
    {
      this->IsNew ? this->ReadElementBlocks() : this->ReadOldElements();
    }
    else if (name == "PartitionedEntities" || name == "ParametricNodes")
    {
      cursor.Fail(ErrorCode::InvalidParameter,
        "this section is not read; save the mesh without partitions and parametric coordinates");
    }
    else
    {
      if (name == "NodeData" || name == "ElementData" || name == "ElementNodeData")
      {
        this->Mesh.LeftOut.push_back("$" + name + " (values of a view)");
      }
      cursor.SkipSection(name);
      cursor.IsBinary = false;
      return;
    }
    this->End();
  }

  void ReadNames()
  {
    MshCursor& cursor = this->Cursor;
    const std::int64_t count = cursor.TextInteger("the number of names", 0, 2147483647);
    cursor.CheckRoom("names", count, 3);
    for (std::int64_t i = 0; i < count && cursor.Outcome; ++i)
    {
      ElementGroup group;
      group.Dimension = cursor.Int("the dimension of a group", 0, 3);
      group.Id = cursor.Int("the number of a group");
      const std::string_view name = cursor.Line();
      if (name.size() < 2 || name.front() != '"' || name.back() != '"')
      {
        cursor.Fail(ErrorCode::InvalidFormat, "the name " + Shown(name) + " is not in quotes");
      }
      else
      {
        group.Name = std::string(name.substr(1, name.size() - 2));
        this->Mesh.Groups.push_back(std::move(group));
      }
    }
  }

  void ReadEntities()
  {
    MshCursor& cursor = this->Cursor;
    std::int64_t counts[4];
    for (std::int64_t& count : counts)
    {
      count = cursor.Size("the number of entities");
    }
    for (int dimension = 0; dimension < 4; ++dimension)
    {
      cursor.CheckRoom("entities", counts[dimension], 5);
      for (std::int64_t i = 0; i < counts[dimension] && cursor.Outcome; ++i)
      {
        const int tag = cursor.Int("the number of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k)
        {
          cursor.Real("a coordinate of an entity");
        }
        this->GroupsOf[{ dimension, tag }] = this->ListOf(this->ReadInts("groups of an entity"));
        if (dimension > 0)
        {
          this->ReadInts("boundary of an entity");
        }
      }
    }
  }

  std::vector<int> ReadInts(const char* meaning)
  {
    std::vector<int> list;
    const std::int64_t count = this->Cursor.Size(meaning);
    this->Cursor.CheckRoom(meaning, count, 1);
    for (std::int64_t i = 0; i < count && this->Cursor.Outcome; ++i)
    {
      list.push_back(this->Cursor.Int(meaning));
    }
    return list;
  }

  int ListOf(const std::vector<int>& groups)
  {
    const auto [found, isNew] =
      this->Lists.emplace(groups, static_cast<int>(this->Mesh.GroupLists.size()));
    if (isNew)
    {
      this->Mesh.GroupLists.push_back(groups);
    }
    return found->second;
  }

  void AddNode(std::int64_t number)
  {
    if (this->Cursor.Outcome &&
      !this->Rows.Add(number, static_cast<std::int64_t>(this->Mesh.NodeNumbers.size())))
    {
      this->Cursor.Fail(ErrorCode::InvalidTopology,
        "node " + std::to_string(number) + " is there twice; give it another number");
    }
    this->Mesh.NodeNumbers.push_back(number);
  }

  void AddCoordinates()
  {
    for (int d = 0; d < 3; ++d)
    {
      this->Coordinates.push_back(this->Cursor.Real("a coordinate"));
    }
  }

  void ReadOldNodes()
  {
    MshCursor& cursor = this->Cursor;
    const std::int64_t count = cursor.TextCount("the number of nodes");
    cursor.CheckRoom("nodes", count, 4);
    for (std::int64_t i = 0; i < count && cursor.Outcome; ++i)
    {
      this->AddNode(cursor.Int("the number of a node", 0));
      this->AddCoordinates();
    }
  }

  void ReadNodeBlocks()
  {
    MshCursor& cursor = this->Cursor;
    const std::int64_t blocks = cursor.Size("the number of blocks");
    const std::int64_t count = cursor.Size("the number of nodes");
    cursor.Size("the smallest number");
    cursor.Size("the largest number");
    cursor.CheckRoom("nodes", count, 4);
    std::int64_t left = count;
    for (std::int64_t b = 0; b < blocks && cursor.Outcome; ++b)
    {
      const int dimension = cursor.Int("the dimension of an entity", 0, 3);
      cursor.Int("the number of an entity");
      const int parameters = cursor.Int("whether nodes have parameters", 0, 1) == 1 ? dimension : 0;
      const std::int64_t size = this->BlockSize("nodes", left, 4);
      for (std::int64_t i = 0; i < size && cursor.Outcome; ++i)
      {
        this->AddNode(cursor.Size("the number of a node"));
      }
      for (std::int64_t i = 0; i < size && cursor.Outcome; ++i)
      {
        this->AddCoordinates();
        for (int k = 0; k < parameters; ++k)
        {
          cursor.Real("a parameter of a node");
        }
      }
    }
    this->CheckAll("nodes", left);
  }

  std::int64_t BlockSize(const char* what, std::int64_t& left, std::int64_t numbers)
  {
    const std::int64_t size = this->Cursor.Size(what);
    if (this->Cursor.CheckRoom(what, size, numbers) && size > left)
    {
      this->Cursor.Fail(ErrorCode::InvalidFormat,
        std::string("the blocks have more ") + what + " than the section says; a count is wrong");
    }
    left -= size;
    return size;
  }

  void CheckAll(const char* what, std::int64_t left)
  {
    if (left != 0)
    {
      this->Cursor.Fail(ErrorCode::InvalidFormat,
        std::string("the blocks have ") + std::to_string(left) + " " + what +
          " less than the section says; a count is wrong");
    }
  }

  /// Row of the kinds of a type of elements.
  int KindOf(int type)
  {
    const auto found = this->KindRows.find(type);
    if (found != this->KindRows.end() || !this->Cursor.Outcome)
    {
      return found == this->KindRows.end() ? -1 : found->second;
    }
    Result<ElementKind> kind = GmshKind(type);
    if (!kind)
    {
      this->Cursor.Fail(kind.Status.Code, kind.Status.Detail);
      return -1;
    }
    const int row = static_cast<int>(this->Mesh.Kinds.size());
    this->Mesh.Kinds.push_back(std::move(kind.Value));
    return this->KindRows[type] = row;
  }

  void BeginElement(int kind, std::int64_t number, int entity, int list)
  {
    if (!this->Cursor.Outcome ||
      this->Mesh.Kinds[static_cast<std::size_t>(kind)].Shape == ElementShape::Point)
    {
      return;
    }
    this->Mesh.KindOf.push_back(kind);
    this->Mesh.ElementNumbers.push_back(number);
    this->Mesh.Entities.push_back(entity);
    this->Mesh.GroupListOf.push_back(list);
    this->Mesh.Begin.push_back(static_cast<std::int64_t>(this->Mesh.Nodes.size()));
  }

  /// Nodes stand by their numbers until all are known.
  void AddElementNode(int kind, std::int64_t node, int list)
  {
    if (!this->Cursor.Outcome)
    {
      return;
    }
    if (this->Mesh.Kinds[static_cast<std::size_t>(kind)].Shape != ElementShape::Point)
    {
      this->Mesh.Nodes.push_back(node);
    }
    else if (const auto& groups = this->Mesh.GroupLists[static_cast<std::size_t>(list)];
             !groups.empty())
    {
      this->PointGroups.emplace_back(node, groups.front());
    }
  }

  void ReadOldElements()
  {
    MshCursor& cursor = this->Cursor;
    const std::int64_t count = cursor.TextCount("the number of elements");
    cursor.CheckRoom("elements", count, 3);
    std::int64_t done = 0;
    int lastGroup = 0;
    int list = this->ListOf({});
    while (done < count && cursor.Outcome)
    {
      // text: number, type, tags; binary: type, how many, how many tags, then number and tags
      std::int64_t number = this->IsBinary ? 0 : cursor.Int("the number of an element", 0);
      const int type = cursor.Int("the type of an element");
      const std::int64_t size = this->IsBinary ? cursor.Int("the number of elements", 1) : 1;
      const int tags = cursor.Int("the number of tags", 0, 100000);
      const int kind = this->KindOf(type);
      if (size > count - done)
      {
        cursor.Fail(ErrorCode::InvalidFormat,
          "a block has more elements than the section says; a count is wrong");
      }
      for (std::int64_t i = 0; i < size && cursor.Outcome; ++i)
      {
        number = this->IsBinary ? cursor.Int("the number of an element", 0) : number;
        int group = 0;
        int entity = 0;
        for (int t = 0; t < tags && cursor.Outcome; ++t)
        {
          const int tag = cursor.Int("a tag of an element");
          group = t == 0 ? tag : group;
          entity = t == 1 ? tag : entity;
        }
        if (!cursor.Outcome)
        {
          break;
        }
        if (group != lastGroup)
        {
          list = this->ListOf(group == 0 ? std::vector<int>() : std::vector<int>{ group });
          lastGroup = group;
        }
        this->BeginElement(kind, number, entity, list);
        const std::size_t nodes = this->Mesh.Kinds[static_cast<std::size_t>(kind)].Places.size();
        for (std::size_t k = 0; k < nodes && cursor.Outcome; ++k)
        {
          this->AddElementNode(kind, cursor.Int("a node of an element"), list);
        }
      }
      done += size;
    }
  }

  void ReadElementBlocks()
  {
    MshCursor& cursor = this->Cursor;
    const std::int64_t blocks = cursor.Size("the number of blocks");
    std::int64_t left = cursor.Size("the number of elements");
    cursor.Size("the smallest number");
    cursor.Size("the largest number");
    cursor.CheckRoom("elements", left, 2);
    for (std::int64_t b = 0; b < blocks && cursor.Outcome; ++b)
    {
      const int dimension = cursor.Int("the dimension of an entity", 0, 3);
      const int entity = cursor.Int("the number of an entity");
      const int kind = this->KindOf(cursor.Int("the type of elements"));
      const std::int64_t size = this->BlockSize("elements", left, 2);
      const auto groups = this->GroupsOf.find({ dimension, entity });
      const int list = groups == this->GroupsOf.end() ? this->ListOf({}) : groups->second;
      for (std::int64_t i = 0; i < size && cursor.Outcome; ++i)
      {
        this->BeginElement(kind, cursor.Size("the number of an element"), entity, list);
        const std::size_t nodes = this->Mesh.Kinds[static_cast<std::size_t>(kind)].Places.size();
        for (std::size_t k = 0; k < nodes && cursor.Outcome; ++k)
        {
          this->AddElementNode(kind, cursor.Size("a node of an element"), list);
        }
      }
    }
    this->CheckAll("elements", left);
  }

  void Finish()
  {
    ElementMesh& mesh = this->Mesh;
    if (mesh.KindOf.empty())
    {
      this->Cursor.Outcome = { ErrorCode::EmptyInput,
        "the file has no elements but points; mesh its curves, surfaces or volumes" };
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
        const std::int64_t row = this->Rows.Find(node);
        if (row < 0)
        {
          this->FailMissing("element " + std::to_string(mesh.ElementNumbers[e]), node);
          return;
        }
        node = row;
      }
    }
    mesh.NodeGroups.resize(this->PointGroups.empty() ? 0 : mesh.NodeNumbers.size());
    for (const auto& [node, group] : this->PointGroups)
    {
      const std::int64_t row = this->Rows.Find(node);
      if (row < 0)
      {
        this->FailMissing("a point element", node);
        return;
      }
      mesh.NodeGroups[static_cast<std::size_t>(row)] = group;
    }
  }

  void FailMissing(const std::string& owner, std::int64_t node)
  {
    this->Cursor.Outcome = { ErrorCode::InvalidTopology,
      "$Elements: " + owner + " has node " + std::to_string(node) +
        ", which $Nodes does not have; correct the number or add the node" };
  }

  MshCursor Cursor;
  NumberIndex Rows; ///< of nodes
  ElementMesh Mesh;
  bool IsNew = false; ///< 4.1
  bool IsBinary = false;
  std::vector<double> Coordinates;
  std::map<int, int> KindRows;
  std::map<std::vector<int>, int> Lists;
  std::map<std::pair<int, int>, int> GroupsOf; ///< list of an entity by dimension and number
  std::vector<std::pair<std::int64_t, int>> PointGroups;
};
}

Result<ElementMesh> ReadGmshMesh(std::string_view text)
{
  return Reader(text).Read();
}

bool LooksLikeGmshMesh(std::string_view beginning)
{
  return beginning.find("$MeshFormat") != std::string_view::npos;
}
}
