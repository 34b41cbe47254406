// SPDX-License-Identifier: BSD-3-Clause
#include "MfemWriter.h"

#include "TextWords.h"

#include <algorithm>
#include <cstdlib>

namespace knotwork
{
namespace
{
using Place = std::array<int, 3>;

/// Where nodes of an element stand in its row.
struct NodeOrder
{
  std::vector<std::size_t> Corners; ///< as MFEM counts them
  std::vector<std::size_t> Lattice; ///< all, the first direction fastest
};

NodeOrder OrderOf(const ElementKind& kind)
{
  NodeOrder order;
  for (const Place& corner : CornersOf(kind.Shape))
  {
    const Place place = { kind.Degree * corner[0], kind.Degree * corner[1],
      kind.Degree * corner[2] };
    const auto found = std::find(kind.Places.begin(), kind.Places.end(), place);
    order.Corners.push_back(static_cast<std::size_t>(found - kind.Places.begin()));
  }
  for (std::size_t i = 0; i < kind.Places.size(); ++i)
  {
    order.Lattice.push_back(i);
  }
  std::sort(order.Lattice.begin(), order.Lattice.end(),
    [&](std::size_t a, std::size_t b)
    {
      const Place& x = kind.Places[a];
      const Place& y = kind.Places[b];
      return std::lexicographical_compare(x.rbegin(), x.rend(), y.rbegin(), y.rend());
    });
  return order;
}

class Writer
{
public:
  explicit Writer(const ElementMesh& mesh) : Mesh(mesh) {}

  Result<MfemText> Write()
  {
    const Status status = this->Prepare();
    if (!status)
    {
      return status;
    }
    std::string& text = this->Found.Text;
    text = "MFEM mesh v1.0\n\ndimension\n" + std::to_string(this->Dimension) + "\n\n";
    this->WriteElements("elements", this->Dimension);
    this->WriteElements("boundary", this->Dimension - 1);
    const int components = this->NumComponents();
    text += "vertices\n" + std::to_string(this->Vertices.size()) + "\n";
    if (this->Degree == 1)
    {
      text += std::to_string(components) + "\n";
      for (const std::int64_t node : this->Vertices)
      {
        this->WritePoint(node, components);
      }
      return std::move(this->Found);
    }
    // nodes of Gauss and Lobatto are equidistant up to degree 2
    text += "\nnodes\nFiniteElementSpace\nFiniteElementCollection: L2_T" +
      std::string(this->Degree == 2 ? "1" : "4") + "_" + std::to_string(this->Dimension) + "D_P" +
      std::to_string(this->Degree) + "\nVDim: " + std::to_string(components) + "\nOrdering: 1\n\n";
    for (std::size_t e = 0; e < this->Mesh.KindOf.size(); ++e)
    {
      if (this->DimensionOfElement(e) == this->Dimension)
      {
        for (const std::size_t place : this->Order(e).Lattice)
        {
          this->WritePoint(this->Node(e, place), components);
        }
      }
    }
    return std::move(this->Found);
  }

private:
  const ElementKind& Kind(std::size_t element) const
  {
    return this->Mesh.Kinds[static_cast<std::size_t>(this->Mesh.KindOf[element])];
  }
  const NodeOrder& Order(std::size_t element) const
  {
    return this->Orders[static_cast<std::size_t>(this->Mesh.KindOf[element])];
  }
  int DimensionOfElement(std::size_t element) const
  {
    return DimensionOf(this->Kind(element).Shape);
  }
  std::int64_t Node(std::size_t element, std::size_t place) const
  {
    return this->Mesh.Nodes[static_cast<std::size_t>(this->Mesh.Begin[element]) + place];
  }
  int GroupOf(std::size_t element) const
  {
    if (this->Mesh.GroupListOf.empty())
    {
      return 0;
    }
    const auto list = static_cast<std::size_t>(this->Mesh.GroupListOf[element]);
    return this->Mesh.GroupLists[list].empty() ? 0 : this->Mesh.GroupLists[list].front();
  }

  Status Prepare()
  {
    std::size_t lower = 0;
    for (std::size_t e = 0; e < this->Mesh.KindOf.size(); ++e)
    {
      this->Dimension = std::max(this->Dimension, this->DimensionOfElement(e));
    }
    if (this->Dimension == 0)
    {
      return { ErrorCode::EmptyInput, "there are no elements to write" };
    }
    for (const ElementKind& kind : this->Mesh.Kinds)
    {
      this->Orders.push_back(OrderOf(kind));
    }
    std::vector<bool> isCorner(static_cast<std::size_t>(this->Mesh.Points.rows()));
    this->Degree = 0;
    for (std::size_t e = 0; e < this->Mesh.KindOf.size(); ++e)
    {
      const ElementKind& kind = this->Kind(e);
      const int dimension = this->DimensionOfElement(e);
      const std::string name = "element " + std::to_string(this->Mesh.ElementNumbers[e]);
      lower += dimension < this->Dimension - 1 ? 1 : 0;
      this->LargestGroup = std::max(this->LargestGroup, this->GroupOf(e));
      if (this->GroupOf(e) < 0 || this->GroupOf(e) == 2147483647)
      {
        return { ErrorCode::InvalidParameter,
          name + " is in group " + std::to_string(this->GroupOf(e)) +
            "; attributes are from 1 to 2147483646: renumber it" };
      }
      if (dimension == this->Dimension)
      {
        this->Degree = this->Degree == 0 ? kind.Degree : this->Degree;
        if (kind.Degree != this->Degree || !kind.IsComplete ||
          (kind.Shape == ElementShape::Pyramid && kind.Degree > 1))
        {
          return { ErrorCode::InvalidParameter,
            name +
              " is of another degree, lacks nodes in faces and inside, or is a curved pyramid; "
              "an MFEM mesh has complete elements of one degree: write .msh" };
        }
      }
      for (const std::size_t corner : this->Order(e).Corners)
      {
        isCorner[static_cast<std::size_t>(this->Node(e, corner))] =
          isCorner[static_cast<std::size_t>(this->Node(e, corner))] ||
          dimension >= this->Dimension - 1;
      }
    }
    this->VertexOf.resize(isCorner.size());
    for (std::size_t node = 0; node < isCorner.size(); ++node)
    {
      this->VertexOf[node] = static_cast<std::int64_t>(this->Vertices.size());
      if (isCorner[node])
      {
        this->Vertices.push_back(static_cast<std::int64_t>(node));
      }
    }
    if (lower > 0)
    {
      this->Found.LeftOut.push_back(std::to_string(lower) +
        " elements of lower dimension than the boundary, which an MFEM mesh does not have");
    }
    return {};
  }

  /// Two where all lies in the plane z = 0.
  int NumComponents() const
  {
    return this->Dimension < 3 && (this->Mesh.Points.col(2).array() == 0.0).all() ? 2 : 3;
  }

  void WriteElements(const char* section, int dimension)
  {
    std::string rows;
    std::size_t count = 0;
    for (std::size_t e = 0; e < this->Mesh.KindOf.size(); ++e)
    {
      if (this->DimensionOfElement(e) != dimension)
      {
        continue;
      }
      ++count;
      const int group = this->GroupOf(e);
      rows += std::to_string(group > 0 ? group : this->LargestGroup + 1) + " " +
        std::to_string(static_cast<int>(this->Kind(e).Shape));
      for (const std::size_t corner : this->Order(e).Corners)
      {
        const std::int64_t node = this->Node(e, corner);
        rows += " " + std::to_string(this->VertexOf[static_cast<std::size_t>(node)]);
      }
      rows += "\n";
    }
    this->Found.Text += std::string(section) + "\n" + std::to_string(count) + "\n" + rows + "\n";
  }

  void WritePoint(std::int64_t node, int components)
  {
    for (int c = 0; c < components; ++c)
    {
      AppendReal(this->Found.Text, this->Mesh.Points(node, c));
      this->Found.Text += c + 1 < components ? ' ' : '\n';
    }
  }

  const ElementMesh& Mesh;
  MfemText Found;
  int Dimension = 0;
  int Degree = 1;
  int LargestGroup = 0;
  std::vector<NodeOrder> Orders; ///< of the kinds
  std::vector<std::int64_t> Vertices;
  std::vector<std::int64_t> VertexOf; ///< of the nodes
};
}

Result<MfemText> WriteMfemMesh(const ElementMesh& mesh)
{
  return Writer(mesh).Write();
}
}
