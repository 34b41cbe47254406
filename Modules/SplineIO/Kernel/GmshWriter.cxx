// SPDX-License-Identifier: BSD-3-Clause
#include "GmshKinds.h"
#include "GmshMesh.h"
#include "TextWords.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
struct Entity
{
  int Number = 0;
  int GroupList = -1;
  std::array<double, 3> Lower{};
  std::array<double, 3> Upper{};
};

class Writer
{
public:
  Writer(const ElementMesh& mesh, bool isBinary) : Mesh(mesh), IsBinary(isBinary) {}

  Result<std::string> Write()
  {
    if (this->Mesh.KindOf.empty())
    {
      return { ErrorCode::EmptyInput, "there are no elements to write" };
    }
    if (Status status = this->FindTypes(); !status)
    {
      return status;
    }
    this->FindEntities();
    this->Text = this->IsBinary ? "$MeshFormat\n4.1 1 8\n" : "$MeshFormat\n4.1 0 8\n";
    if (this->IsBinary)
    {
      this->Int(1);
      this->Text += '\n';
    }
    this->Text += "$EndMeshFormat\n";
    this->WriteNames();
    this->WriteEntities();
    this->WriteNodes();
    this->WriteElements();
    return std::move(this->Text);
  }

private:
  template <typename Number>
  void Raw(Number value)
  {
    this->Text.append(reinterpret_cast<const char*>(&value), sizeof(Number));
  }
  void Int(int value)
  {
    this->IsBinary ? this->Raw(static_cast<std::int32_t>(value)) : this->Word(value);
  }
  void Size(std::int64_t value) { this->IsBinary ? this->Raw(value) : this->Word(value); }
  void Real(double value)
  {
    if (this->IsBinary)
    {
      this->Raw(value);
      return;
    }
    AppendReal(this->Text, value);
    this->Text += ' ';
  }
  void Word(std::int64_t value) { this->Text += std::to_string(value) + ' '; }
  void EndLine()
  {
    if (!this->IsBinary)
    {
      this->Text.back() = '\n';
    }
  }
  void EndSection(const char* name)
  {
    this->Text += this->IsBinary ? "\n" : "";
    this->Text += std::string("$End") + name + "\n";
  }

  const ElementKind& Kind(std::size_t element) const
  {
    return this->Mesh.Kinds[static_cast<std::size_t>(this->Mesh.KindOf[element])];
  }

  /// Gmsh's type of every kind, and where its nodes stand in the order of the mesh.
  Status FindTypes()
  {
    for (const ElementKind& kind : this->Mesh.Kinds)
    {
      const int type = GmshType(kind.Shape, kind.Degree, kind.IsComplete);
      const auto places = type == 0 ? kind.Places : GmshKind(type)->Places;
      std::vector<std::size_t> order;
      for (const auto& place : places)
      {
        const auto found = std::find(kind.Places.begin(), kind.Places.end(), place);
        order.push_back(static_cast<std::size_t>(found - kind.Places.begin()));
      }
      const bool isKnown = std::find(order.begin(), order.end(), kind.Places.size()) == order.end();
      if (type == 0 || places.size() != kind.Places.size() || !isKnown)
      {
        return { ErrorCode::InvalidParameter,
          "elements of degree " + std::to_string(kind.Degree) + " with " +
            std::to_string(kind.Places.size()) +
            " nodes have no type of MSH 4.1 that is written; write .vtu" };
      }
      this->Types.push_back(type);
      this->Orders.push_back(std::move(order));
    }
    for (const ElementGroup& group : this->Mesh.Groups)
    {
      if (group.Name.find_first_of("\"\r\n") != std::string::npos)
      {
        return { ErrorCode::InvalidParameter,
          "the name of group " + std::to_string(group.Id) +
            " has a quote or a line's end in it; rename it" };
      }
    }
    return {};
  }

  /// An entity has its groups: elements of one entity and other groups get one of their own.
  void FindEntities()
  {
    std::map<std::array<int, 3>, int> rows; // of dimension, entity, list of groups
    std::map<std::pair<int, int>, int> taken;
    std::array<int, 4> next{ 1, 1, 1, 1 };
    std::array<std::set<int>, 4> all; // numbers that elements state
    const bool known = !this->Mesh.Entities.empty();
    for (std::size_t e = 0; known && e < this->Mesh.KindOf.size(); ++e)
    {
      all[static_cast<std::size_t>(DimensionOf(this->Kind(e).Shape))].insert(
        this->Mesh.Entities[e]);
    }
    for (std::size_t e = 0; e < this->Mesh.KindOf.size(); ++e)
    {
      const int dimension = DimensionOf(this->Kind(e).Shape);
      const auto d = static_cast<std::size_t>(dimension);
      const int list = this->Mesh.GroupListOf.empty() ? -1 : this->Mesh.GroupListOf[e];
      const int stated = known ? this->Mesh.Entities[e] : 0;
      const auto [row, isNew] = rows.emplace(
        std::array<int, 3>{ dimension, stated, list }, static_cast<int>(this->Entities[d].size()));
      if (isNew)
      {
        Entity entity;
        const bool isFree =
          stated > 0 && taken.emplace(std::make_pair(dimension, stated), 0).second;
        while (!isFree && all[d].count(next[d]) != 0)
        {
          ++next[d];
        }
        entity.Number = isFree ? stated : next[d]++;
        entity.GroupList = list;
        entity.Lower.fill(std::numeric_limits<double>::max());
        entity.Upper.fill(std::numeric_limits<double>::lowest());
        this->Entities[d].push_back(entity);
      }
      this->EntityOf.push_back(row->second);
      Entity& entity = this->Entities[d][static_cast<std::size_t>(row->second)];
      for (std::int64_t k = this->Mesh.Begin[e]; k < this->Mesh.Begin[e + 1]; ++k)
      {
        for (std::size_t c = 0; c < 3; ++c)
        {
          const double x = this->Mesh.Points(
            this->Mesh.Nodes[static_cast<std::size_t>(k)], static_cast<Eigen::Index>(c));
          entity.Lower[c] = std::min(entity.Lower[c], x);
          entity.Upper[c] = std::max(entity.Upper[c], x);
        }
      }
    }
    for (std::size_t node = 0; node < this->Mesh.NodeGroups.size(); ++node)
    {
      if (this->Mesh.NodeGroups[node] != 0)
      {
        this->GroupedNodes.push_back(node);
      }
    }
  }

  void WriteNames()
  {
    if (this->Mesh.Groups.empty())
    {
      return;
    }
    this->Text += "$PhysicalNames\n" + std::to_string(this->Mesh.Groups.size()) + "\n";
    for (const ElementGroup& group : this->Mesh.Groups)
    {
      this->Text += std::to_string(group.Dimension) + " " + std::to_string(group.Id) + " \"" +
        group.Name + "\"\n";
    }
    this->Text += "$EndPhysicalNames\n";
  }

  void WriteEntities()
  {
    this->Text += "$Entities\n";
    this->Size(static_cast<std::int64_t>(this->GroupedNodes.size()));
    for (int d = 1; d < 4; ++d)
    {
      this->Size(static_cast<std::int64_t>(this->Entities[static_cast<std::size_t>(d)].size()));
    }
    this->EndLine();
    int number = 0;
    for (const std::size_t node : this->GroupedNodes)
    {
      this->Int(++number);
      for (Eigen::Index c = 0; c < 3; ++c)
      {
        this->Real(this->Mesh.Points(static_cast<Eigen::Index>(node), c));
      }
      this->Size(1);
      this->Int(this->Mesh.NodeGroups[node]);
      this->EndLine();
    }
    for (const auto& entities : this->Entities)
    {
      for (const Entity& entity : entities)
      {
        this->Int(entity.Number);
        for (const auto* corner : { &entity.Lower, &entity.Upper })
        {
          for (const double x : *corner)
          {
            this->Real(x);
          }
        }
        static const std::vector<int> none;
        const std::vector<int>& groups = entity.GroupList < 0
          ? none
          : this->Mesh.GroupLists[static_cast<std::size_t>(entity.GroupList)];
        this->Size(static_cast<std::int64_t>(groups.size()));
        for (const int group : groups)
        {
          this->Int(group);
        }
        this->Size(0); // entities on its boundary
        this->EndLine();
      }
    }
    this->EndSection("Entities");
  }

  void WriteNodes()
  {
    const auto& numbers = this->Mesh.NodeNumbers;
    const auto count = static_cast<std::int64_t>(numbers.size());
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    this->Text += "$Nodes\n";
    for (const std::int64_t value : { std::int64_t{ 1 }, count, *least, *most })
    {
      this->Size(value);
    }
    this->EndLine();
    int dimension = 3; // all under one entity of the highest dimension: so they keep their order
    while (this->Entities[static_cast<std::size_t>(dimension)].empty())
    {
      --dimension;
    }
    this->Int(dimension);
    this->Int(this->Entities[static_cast<std::size_t>(dimension)].front().Number);
    this->Int(0);
    this->Size(count);
    this->EndLine();
    for (const std::int64_t number : numbers)
    {
      this->Size(number);
      this->EndLine();
    }
    for (Eigen::Index row = 0; row < this->Mesh.Points.rows(); ++row)
    {
      for (Eigen::Index c = 0; c < 3; ++c)
      {
        this->Real(this->Mesh.Points(row, c));
      }
      this->EndLine();
    }
    this->EndSection("Nodes");
  }

  void WriteElements()
  {
    const auto& numbers = this->Mesh.ElementNumbers;
    const std::size_t count = numbers.size();
    std::vector<std::size_t> starts; // of runs of one entity and kind, so elements keep their order
    for (std::size_t e = 0; e < count; ++e)
    {
      if (e == 0 || this->EntityOf[e] != this->EntityOf[e - 1] ||
        this->Mesh.KindOf[e] != this->Mesh.KindOf[e - 1])
      {
        starts.push_back(e);
      }
    }
    const std::int64_t points = static_cast<std::int64_t>(this->GroupedNodes.size());
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    const std::int64_t last = *most;
    this->Text += "$Elements\n";
    for (const std::int64_t value : { static_cast<std::int64_t>(starts.size()) + points,
           static_cast<std::int64_t>(count) + points, *least, last + points })
    {
      this->Size(value);
    }
    this->EndLine();
    for (std::int64_t p = 0; p < points; ++p)
    {
      this->Int(0);
      this->Int(static_cast<int>(p) + 1);
      this->Int(GmshType(ElementShape::Point, 1, true));
      this->Size(1);
      this->EndLine();
      this->Size(last + 1 + p);
      this->Size(this->Mesh.NodeNumbers[this->GroupedNodes[static_cast<std::size_t>(p)]]);
      this->EndLine();
    }
    starts.push_back(count);
    for (std::size_t s = 0; s + 1 < starts.size(); ++s)
    {
      const auto kind = static_cast<std::size_t>(this->Mesh.KindOf[starts[s]]);
      const int dimension = DimensionOf(this->Mesh.Kinds[kind].Shape);
      const auto entity = static_cast<std::size_t>(this->EntityOf[starts[s]]);
      this->Int(dimension);
      this->Int(this->Entities[static_cast<std::size_t>(dimension)][entity].Number);
      this->Int(this->Types[kind]);
      this->Size(static_cast<std::int64_t>(starts[s + 1] - starts[s]));
      this->EndLine();
      for (std::size_t e = starts[s]; e < starts[s + 1]; ++e)
      {
        this->Size(numbers[e]);
        for (const std::size_t place : this->Orders[kind])
        {
          const auto at = static_cast<std::size_t>(this->Mesh.Begin[e]) + place;
          this->Size(this->Mesh.NodeNumbers[static_cast<std::size_t>(this->Mesh.Nodes[at])]);
        }
        this->EndLine();
      }
    }
    this->EndSection("Elements");
  }

  const ElementMesh& Mesh;
  bool IsBinary;
  std::string Text;
  std::vector<int> Types;
  std::vector<std::vector<std::size_t>> Orders;
  std::array<std::vector<Entity>, 4> Entities;
  std::vector<int> EntityOf; ///< of every element: row of those of its dimension
  std::vector<std::size_t> GroupedNodes;
};
}

Result<std::string> WriteGmshMesh(const ElementMesh& mesh, bool isBinary)
{
  return Writer(mesh, isBinary).Write();
}
}
