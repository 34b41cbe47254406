// SPDX-License-Identifier: BSD-3-Clause
#include "MfemMesh.h"

#include "MfemParser.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
const char* NameOf(MfemShape shape)
{
  const char* const names[] = { "point", "segment", "triangle", "quadrilateral", "tetrahedron",
    "hexahedron", "wedge", "pyramid" };
  return names[static_cast<int>(shape)];
}

class Parser
{
public:
  explicit Parser(std::string_view text) : Words(text) {}

  Result<MfemMesh> Read()
  {
    this->ReadHead();
    this->Words.Expect("dimension");
    this->Mesh.Dimension = this->Words.Integer("dimension", 1, 3);
    this->Words.Expect("elements");
    this->Mesh.Cells = this->ReadCells("element", this->Mesh.Dimension);
    if (this->Words.Outcome && this->Mesh.Cells.empty())
    {
      this->Words.Fail(ErrorCode::EmptyInput, "the mesh has no elements");
    }
    this->SkipSets("attribute_sets");
    this->Words.Expect("boundary");
    std::vector<MfemCell> boundary = this->ReadCells("boundary element", this->Mesh.Dimension - 1);
    this->SkipSets("bdr_attribute_sets");
    if (this->Words.Peek() == "vertex_parents")
    {
      this->Words.Fail(ErrorCode::InvalidParameter,
        "the mesh is not conforming (vertex_parents); save a conforming one");
    }
    if (this->Mesh.IsSpline)
    {
      this->ReadEdges();
    }
    this->Words.Expect("vertices");
    // every vertex is a corner, which is a word
    this->Mesh.NumVertices = this->Words.Count("number of vertices", 1.0);
    this->CheckCorners(this->Mesh.Cells, "element");
    this->CheckCorners(boundary, "boundary element");
    if (this->Words.Outcome)
    {
      this->Mesh.IsSpline ? ReadNurbs(this->Words, this->Edges, this->EdgeKnots, this->Mesh)
                          : this->ReadGeometry();
    }
    this->ReadEnd();
    return this->Words.Outcome ? Result<MfemMesh>(std::move(this->Mesh))
                               : Result<MfemMesh>(this->Words.Outcome);
  }

private:
  void ReadHead()
  {
    const std::string_view first = this->Words.Peek();
    if (first.empty())
    {
      this->Words.Outcome = { ErrorCode::EmptyInput, "the mesh file is empty" };
      return;
    }
    if (first.substr(0, 20) == "MeshVersionFormatted" || first == "MeshVersionUnformatted")
    {
      this->Words.Fail(ErrorCode::InvalidParameter,
        "this is a mesh of Medit; only those of MFEM are read under this ending, convert it "
        "to .vtk, .vtu or .off");
      return;
    }
    if (first != "MFEM")
    {
      this->Words.Fail(ErrorCode::InvalidFormat,
        Shown(first) + " stands where 'MFEM mesh v1.0' or 'MFEM NURBS mesh v1.0' must");
      return;
    }
    std::string kind;
    while (this->Words.Outcome && kind.find(" v") == std::string::npos && kind.size() < 40)
    {
      kind += (kind.empty() ? "" : " ") + std::string(this->Words.Word("the kind of mesh"));
    }
    this->Mesh.IsSpline = kind == "MFEM NURBS mesh v1.0";
    if (!this->Mesh.IsSpline && kind != "MFEM mesh v1.0" && kind != "MFEM mesh v1.1" &&
      kind != "MFEM mesh v1.2" && kind != "MFEM mesh v1.3")
    {
      this->Words.Fail(ErrorCode::InvalidParameter,
        Shown(kind) +
          " is not read; save the mesh as 'MFEM mesh v1.0', conforming, or as 'MFEM NURBS mesh "
          "v1.0'");
    }
  }

  std::vector<MfemCell> ReadCells(const std::string& what, int dimension)
  {
    std::vector<MfemCell> cells;
    const int count = this->Words.Count("number of " + what + "s", 3.0);
    cells.reserve(static_cast<std::size_t>(count));
    for (int c = 0; c < count && this->Words.Outcome; ++c)
    {
      const std::string name = what + " " + std::to_string(c);
      MfemCell cell;
      cell.Attribute = this->Words.Integer("attribute of " + name, -2147483647, 2147483647);
      cell.Shape = static_cast<MfemShape>(this->Words.Integer("geometry type of " + name, 0, 7));
      const MfemReference& reference = ReferenceOf(cell.Shape);
      const bool isSpline = this->Mesh.IsSpline && !reference.IsTensor && dimension > 0;
      if (this->Words.Outcome && (reference.Dimension != dimension || isSpline))
      {
        this->Words.Fail(ErrorCode::InvalidTopology,
          name + " is a " + NameOf(cell.Shape) + ", which " +
            (isSpline ? "is no patch of a NURBS mesh"
                      : "is not of dimension " + std::to_string(dimension)) +
            "; leave it out");
      }
      for (int k = 0; k < reference.NumCorners; ++k)
      {
        cell.Corners[static_cast<std::size_t>(k)] =
          this->Words.Integer("vertex of " + name, 0, 2147483646, ErrorCode::InvalidTopology);
      }
      cells.push_back(cell);
    }
    return cells;
  }

  /// Names in quotes with the attributes that they stand for, which are not kept.
  void SkipSets(const std::string& section)
  {
    if (!this->Words.Outcome || this->Words.Peek() != section)
    {
      return;
    }
    this->Words.Expect(section);
    const int sets = this->Words.Count("number of " + section, 2.0);
    for (int s = 0; s < sets && this->Words.Outcome; ++s)
    {
      std::string_view word = this->Words.Word("name of a set");
      bool isOpen = !word.empty() && word.front() == '"' && (word.size() < 2 || word.back() != '"');
      while (isOpen && this->Words.Outcome)
      {
        word = this->Words.Word("name of a set");
        isOpen = !word.empty() && word.back() != '"';
      }
      const int attributes = this->Words.Count("size of a set", 1.0);
      for (int a = 0; a < attributes && this->Words.Outcome; ++a)
      {
        this->Words.Integer("attribute of a set", -2147483647, 2147483647);
      }
    }
  }

  void ReadEdges()
  {
    this->Words.Expect("edges");
    const int count = this->Words.Count("number of edges", 3.0);
    for (int e = 0; e < count && this->Words.Outcome; ++e)
    {
      const std::string name = "edge " + std::to_string(e);
      this->EdgeKnots.push_back(
        this->Words.Integer("knot vector of " + name, 0, 2147483646, ErrorCode::InvalidTopology));
      std::array<int, 2> ends{};
      for (int& end : ends)
      {
        end = this->Words.Integer("vertex of " + name, 0, 2147483646, ErrorCode::InvalidTopology);
      }
      this->Edges.push_back(ends);
    }
  }

  void CheckCorners(const std::vector<MfemCell>& cells, const std::string& what)
  {
    for (std::size_t c = 0; c < cells.size() && this->Words.Outcome; ++c)
    {
      const int last = *std::max_element(cells[c].Corners.begin(), cells[c].Corners.end());
      if (last >= this->Mesh.NumVertices)
      {
        this->Words.Fail(ErrorCode::InvalidTopology,
          what + " " + std::to_string(c) + " has vertex " + std::to_string(last) + ", there are " +
            std::to_string(this->Mesh.NumVertices) +
            " (from 0); the file is damaged or a count is too small");
      }
    }
  }

  void ReadGeometry()
  {
    if (this->Words.Peek() == "nodes")
    {
      this->Words.Expect("nodes");
      this->ReadCurved();
      return;
    }
    MfemNodesHead head;
    head.Components = this->Words.Integer("coordinates of a vertex", 1, 3);
    this->Mesh.Points = ReadNodes(this->Words, head, this->Mesh.NumVertices);
  }

  void ReadCurved()
  {
    const MfemNodesHead head = ReadNodesHead(this->Words, this->Mesh.Dimension);
    const std::vector<MfemCell>& cells = this->Mesh.Cells;
    if (this->Words.Outcome && head.Collection.IsNurbs)
    {
      this->Words.Fail(ErrorCode::InvalidParameter,
        "NURBS are the nodes of an 'MFEM NURBS mesh v1.0' alone; save the mesh as one");
    }
    for (std::size_t c = 0; c < cells.size() && this->Words.Outcome; ++c)
    {
      std::array<int, 8> sorted = cells[c].Corners;
      std::sort(sorted.begin(), sorted.end());
      const auto begin = std::upper_bound(sorted.begin(), sorted.end(), -1);
      if (cells[c].Shape == MfemShape::Pyramid)
      {
        this->Words.Fail(ErrorCode::InvalidParameter,
          "element " + std::to_string(c) +
            " is a pyramid with nodes, which has no Bernstein form; split it into tetrahedra");
      }
      else if (std::adjacent_find(begin, sorted.end()) != sorted.end())
      {
        this->Words.Fail(ErrorCode::InvalidTopology,
          "element " + std::to_string(c) +
            " has a vertex twice, so that its nodes cannot be told apart; a periodic mesh needs "
            "three elements a direction");
      }
    }
    if (!this->Words.Outcome)
    {
      return;
    }
    const int p = head.Collection.Degree;
    this->Mesh.Degree = p;
    std::map<MfemShape, std::pair<MfemConversion, std::vector<MfemPlace>>> shapes;
    const auto of = [&](std::size_t c) -> const auto&
    {
      const MfemShape shape = cells[c].Shape;
      const auto found = shapes.find(shape);
      return found != shapes.end() ? found->second
                                   : shapes
                                       .emplace(shape,
                                         std::pair(MfemConversion(shape, head.Collection),
                                           LatticeOf(shape, { p + 1, p + 1, p + 1 })))
                                       .first->second;
    };
    const MfemEntities entities(cells);
    MfemNumbering numbering(cells, this->Mesh.NumVertices, entities);
    std::int64_t begin = 0;
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      if (!numbering.Add(of(c).second))
      {
        this->Words.Fail(ErrorCode::InvalidTopology,
          "element " + std::to_string(c) + " shares a quadrilateral with a triangle of another");
        return;
      }
      this->Mesh.CellBegin.push_back(begin);
      begin += of(c).first.NumNodes();
    }
    this->Mesh.CellBegin.push_back(begin);
    const std::int64_t shared = numbering.Finish();
    const PointMatrix nodes =
      ReadNodes(this->Words, head, head.Collection.IsContinuous ? shared : begin);
    if (!this->Words.Outcome)
    {
      return;
    }
    this->MakePoints(numbering, shared, nodes, head.Collection.IsContinuous, of);
  }

  /// Points of the cells' Bernstein coefficients. Those that cells have in common by topology are
  /// one where they agree: of a periodic mesh, cells across the seam have others.
  template <typename OfShape>
  void MakePoints(const MfemNumbering& numbering, std::int64_t shared, const PointMatrix& nodes,
    bool isContinuous, const OfShape& of)
  {
    constexpr double Agreeing = 1e-9; // of the largest coordinate
    const double tolerance = Agreeing * nodes.cwiseAbs().maxCoeff();
    std::vector<int> first(static_cast<std::size_t>(shared), -1);
    std::vector<int> next; // further points of the same node
    std::vector<double> points;
    this->Mesh.CellPoints.reserve(static_cast<std::size_t>(this->Mesh.CellBegin.back()));
    for (std::size_t c = 0; c < this->Mesh.Cells.size(); ++c)
    {
      const auto& [conversion, places] = of(c);
      PointMatrix values(conversion.NumNodes(), 3);
      for (std::size_t k = 0; k < places.size(); ++k)
      {
        const std::int64_t node = isContinuous
          ? numbering.Node(c, places[k])
          : this->Mesh.CellBegin[c] + static_cast<std::int64_t>(k);
        values.row(static_cast<Eigen::Index>(k)) = nodes.row(node);
      }
      values = conversion.Apply(std::move(values));
      for (std::size_t k = 0; k < places.size(); ++k)
      {
        const auto row = values.row(static_cast<Eigen::Index>(k));
        int* at = &first[static_cast<std::size_t>(numbering.Node(c, places[k]))];
        while (*at >= 0 &&
          !((Eigen::Map<const Eigen::RowVector3d>(&points[3 * static_cast<std::size_t>(*at)]) - row)
              .cwiseAbs()
              .maxCoeff() <= tolerance))
        {
          at = &next[static_cast<std::size_t>(*at)];
        }
        if (*at < 0)
        {
          *at = static_cast<int>(next.size());
          this->Mesh.CellPoints.push_back(*at);
          next.push_back(-1); // may move `at`
          points.insert(points.end(), { row[0], row[1], row[2] });
        }
        else
        {
          this->Mesh.CellPoints.push_back(*at);
        }
      }
    }
    this->Mesh.Points =
      Eigen::Map<const PointMatrix>(points.data(), static_cast<Eigen::Index>(next.size()), 3);
  }

  void ReadEnd()
  {
    if (!this->Words.Outcome)
    {
      return;
    }
    if (this->Words.Peek() == "mfem_serial_mesh_end")
    {
      this->Mesh.Warnings.emplace_back(
        "the file is one part of a mesh of several processes; the others are not read");
      return;
    }
    if (this->Words.Peek() == "mfem_mesh_end")
    {
      this->Words.Expect("mfem_mesh_end");
    }
    if (const std::string_view behind = this->Words.Peek(); !behind.empty())
    {
      this->Words.Fail(ErrorCode::InvalidFormat,
        Shown(behind) +
          " stands behind the last number of the mesh; a count is too small, or it "
          "is to be removed");
    }
  }

  MfemWords Words;
  MfemMesh Mesh;
  std::vector<std::array<int, 2>> Edges;
  std::vector<int> EdgeKnots;
};
}

MfemNodesHead ReadNodesHead(MfemWords& words, int dimension)
{
  MfemNodesHead head;
  words.Expect("FiniteElementSpace");
  words.Expect("FiniteElementCollection:");
  const std::string name(words.Word("the name of the finite elements"));
  if (words.Outcome)
  {
    const auto found = ParseMfemCollection(name, dimension);
    if (!found)
    {
      words.Fail(found.Status.Code, found.Status.Detail);
    }
    head.Collection = found.Value;
  }
  words.Expect("VDim:");
  head.Components = words.Integer("VDim", 1, 3);
  words.Expect("Ordering:");
  head.ByNodes = words.Integer("Ordering", 0, 1) == 0;
  return head;
}

PointMatrix ReadNodes(MfemWords& words, const MfemNodesHead& head, std::int64_t count)
{
  words.CheckRoom("coordinates", static_cast<double>(count) * head.Components);
  if (!words.Outcome)
  {
    return {};
  }
  PointMatrix points = PointMatrix::Zero(count, 3);
  const std::int64_t numbers = count * head.Components;
  for (std::int64_t i = 0; i < numbers && words.Outcome; ++i)
  {
    const std::int64_t row = head.ByNodes ? i % count : i / head.Components;
    const std::int64_t column = head.ByNodes ? i / count : i % head.Components;
    points(row, column) = words.Real("coordinate");
  }
  return points;
}

Result<MfemMesh> ReadMfemMesh(std::string_view text)
{
  return Parser(text).Read();
}

bool LooksLikeMfemMesh(std::string_view beginning)
{
  return beginning.substr(0, 5) == "MFEM ";
}
}
