// SPDX-License-Identifier: BSD-3-Clause
#include "MfemParser.h"

#include <knotwork/SplineCore/KnotVector.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Corners of a cell in the order of a tensor product: bit k is the end in direction k.
constexpr int TensorCorners[] = { 0, 1, 3, 2, 4, 5, 7, 6 };

class NurbsParser
{
public:
  NurbsParser(MfemWords& words, const std::vector<std::array<int, 2>>& edges,
    const std::vector<int>& edgeKnots, MfemMesh& mesh)
    : Words(words), Edges(edges), EdgeKnots(edgeKnots), Mesh(mesh), Entities(mesh.Cells, edges)
  {
  }

  void Read()
  {
    this->CheckEdges();
    if (this->Words.Outcome && this->Words.Peek() == "patches")
    {
      this->Words.Expect("patches");
      this->ReadPatches();
    }
    else
    {
      this->ReadShared();
    }
    if (this->Words.Outcome)
    {
      this->StateTopology();
    }
  }

private:
  void Fail(ErrorCode code, const std::string& what) { this->Words.Fail(code, what); }

  void CheckEdges()
  {
    std::set<std::array<int, 2>> known;
    for (const auto& [a, b] : this->Edges)
    {
      if (std::max(a, b) >= this->Mesh.NumVertices)
      {
        return this->Fail(ErrorCode::InvalidTopology,
          "an edge has vertex " + std::to_string(std::max(a, b)) + ", there are " +
            std::to_string(this->Mesh.NumVertices) + " (from 0)");
      }
      if (!known.insert({ std::min(a, b), std::max(a, b) }).second)
      {
        return this->Fail(ErrorCode::InvalidTopology,
          "the edge from vertex " + std::to_string(a) + " to " + std::to_string(b) +
            " is there twice");
      }
    }
    if (this->Mesh.Dimension > 1 && this->Entities.NumEdges != static_cast<int>(known.size()))
    {
      this->Fail(ErrorCode::InvalidTopology,
        "the patches have " + std::to_string(this->Entities.NumEdges) + " edges, of which " +
          std::to_string(known.size()) + " have a knot vector; list all of them under 'edges'");
    }
  }

  KnotVector ReadKnots(int number)
  {
    const std::string name = "knot vector " + std::to_string(number);
    const int degree =
      this->Words.Integer("degree of " + name, 1, MaxDegree, ErrorCode::InvalidDegree);
    const int points = this->Words.Count("number of control points of " + name, 1.0);
    std::vector<double> knots;
    for (int k = 0; k < points + degree + 1 && this->Words.Outcome; ++k)
    {
      knots.push_back(this->Words.Real("knot"));
    }
    if (!this->Words.Outcome)
    {
      return {};
    }
    auto made = KnotVector::Create(degree, std::move(knots));
    if (!made)
    {
      this->Fail(made.Status.Code, name + ": " + made.Status.Detail);
      return {};
    }
    const int last = made->NumElements();
    if (made->Multiplicity(0) != degree + 1 || made->Multiplicity(last) != degree + 1)
    {
      this->Fail(ErrorCode::InvalidKnots,
        name + ": its first and last knot are not there " + std::to_string(degree + 1) +
          " times; insert them");
    }
    return made.Value;
  }

  KnotVector Reversed(const KnotVector& knots)
  {
    const double sum = knots.Begin() + knots.End();
    std::vector<double> turned(knots.Knots().rbegin(), knots.Knots().rend());
    for (double& knot : turned)
    {
      knot = sum - knot;
    }
    // the ends stay what they are
    const auto p = At(knots.Degree());
    std::fill_n(turned.begin(), p + 1, knots.Begin());
    std::fill_n(turned.rbegin(), p + 1, knots.End());
    auto made = KnotVector::Create(knots.Degree(), std::move(turned));
    if (!made)
    {
      this->Fail(made.Status.Code, "a knot vector run backwards: " + made.Status.Detail);
    }
    return made.Value;
  }

  /// Along an edge of a patch, from its first corner to its second; `edge` is that of the file.
  KnotVector KnotsAlong(int edge, int from)
  {
    const int number = this->EdgeKnots[At(edge)];
    if (number >= static_cast<int>(this->Knots.size()))
    {
      this->Fail(ErrorCode::InvalidTopology,
        "edge " + std::to_string(edge) + " has knot vector " + std::to_string(number) +
          ", there are " + std::to_string(this->Knots.size()) + " (from 0)");
      return {};
    }
    const KnotVector& knots = this->Knots[At(number)];
    return this->Edges[At(edge)][0] == from ? knots : this->Reversed(knots);
  }

  /// Knot vectors of a patch, which all edges of a direction have.
  std::array<KnotVector, 3> KnotsOf(std::size_t patch)
  {
    std::array<KnotVector, 3> all;
    const MfemCell& cell = this->Mesh.Cells[patch];
    if (this->Mesh.Dimension == 1)
    {
      const std::array<int, 2> ends{ cell.Corners[0], cell.Corners[1] };
      for (int e = 0; e < static_cast<int>(this->Edges.size()); ++e)
      {
        const auto& [a, b] = this->Edges[At(e)];
        if ((a == ends[0] && b == ends[1]) || (a == ends[1] && b == ends[0]))
        {
          all[0] = this->KnotsAlong(e, ends[0]);
          return all;
        }
      }
      this->Fail(ErrorCode::InvalidTopology,
        "element " + std::to_string(patch) + " has no knot vector; list it under 'edges'");
      return all;
    }
    const MfemReference& reference = ReferenceOf(cell.Shape);
    std::array<bool, 3> isThere{};
    for (std::size_t e = 0; e < reference.Edges.size() && this->Words.Outcome; ++e)
    {
      auto [from, to] = reference.Edges[e];
      std::size_t d = 0;
      while (reference.Corners[At(from)][d] == reference.Corners[At(to)][d])
      {
        ++d;
      }
      from = reference.Corners[At(from)][d] == 0 ? from : to; // some run backwards
      const KnotVector knots =
        this->KnotsAlong(this->Entities.Edge(patch, static_cast<int>(e)), cell.Corners[At(from)]);
      const bool fits = !isThere[d] || Agree(all[d], knots);
      if (this->Words.Outcome && !fits)
      {
        this->Fail(ErrorCode::InvalidTopology,
          "element " + std::to_string(patch) +
            " has other knots on one of its edges of direction " + std::to_string(d) +
            " than on another; correct 'edges', also the order of vertices");
      }
      all[d] = isThere[d] ? all[d] : knots;
      isThere[d] = true;
    }
    return all;
  }

  static bool Agree(const KnotVector& a, const KnotVector& b)
  {
    const std::vector<double>& x = a.Knots();
    const std::vector<double>& y = b.Knots();
    const double tolerance = 1e-12 * std::max(std::abs(a.Begin()), std::abs(a.End()));
    return a.Degree() == b.Degree() && x.size() == y.size() &&
      std::equal(x.begin(), x.end(), y.begin(),
        [tolerance](double left, double right) { return std::abs(left - right) <= tolerance; });
  }

  /// Coefficients that patches share.
  void ReadShared()
  {
    this->Words.Expect("knotvectors");
    const int count = this->Words.Count("number of knot vectors", 4.0);
    for (int k = 0; k < count && this->Words.Outcome; ++k)
    {
      this->Knots.push_back(this->ReadKnots(k));
    }
    for (const char* section : { "mesh_elements", "periodic" })
    {
      if (this->Words.Outcome && this->Words.Peek() == section)
      {
        return this->Fail(ErrorCode::InvalidParameter,
          std::string("'") + section +
            "' is not read; save the mesh without it, with all of its elements");
      }
    }
    MfemNumbering numbering(this->Mesh.Cells, this->Mesh.NumVertices, this->Entities);
    std::vector<std::array<KnotVector, 3>> knots;
    std::vector<std::vector<MfemPlace>> places;
    double coefficients = 0.0;
    for (std::size_t patch = 0; patch < this->Mesh.Cells.size() && this->Words.Outcome; ++patch)
    {
      knots.push_back(this->KnotsOf(patch));
      std::array<int, 3> counts{ 1, 1, 1 };
      double inside = 1.0;
      for (std::size_t d = 0; d < At(this->Mesh.Dimension); ++d)
      {
        counts[d] = knots.back()[d].NumFunctions();
        inside *= counts[d] - 2;
      }
      coefficients += inside;
      this->Words.CheckRoom("weights", coefficients); // before a lattice of that size
      if (!this->Words.Outcome)
      {
        return;
      }
      places.push_back(LatticeOf(this->Mesh.Cells[patch].Shape, counts));
      if (!numbering.Add(places.back()))
      {
        this->Fail(ErrorCode::InvalidTopology,
          "element " + std::to_string(patch) +
            " has another number of control points on a side than its neighbour");
      }
    }
    const std::int64_t all = this->Words.Outcome ? numbering.Finish() : 0;
    this->Words.Expect("weights");
    this->Words.CheckRoom("weights", static_cast<double>(all));
    Eigen::VectorXd weights(this->Words.Outcome ? all : 0);
    for (double& weight : weights)
    {
      weight = this->Words.Real("weight");
      if (this->Words.Outcome && !(weight > 0.0))
      {
        this->Fail(ErrorCode::InvalidWeight,
          "weight " + std::to_string(weight) + " is not positive; correct it");
      }
    }
    const MfemNodesHead head = ReadNodesHead(this->Words, this->Mesh.Dimension);
    if (this->Words.Outcome && !head.Collection.IsNurbs)
    {
      this->Fail(ErrorCode::InvalidParameter,
        "the nodes of a NURBS mesh are those of a collection NURBS2 or of another degree, not "
        "other finite elements");
    }
    const PointMatrix nodes = ReadNodes(this->Words, head, all);
    for (std::size_t patch = 0; patch < places.size() && this->Words.Outcome; ++patch)
    {
      const auto rows = static_cast<Eigen::Index>(places[patch].size());
      PointMatrix points(rows, head.Components);
      Eigen::VectorXd own(rows);
      for (Eigen::Index row = 0; row < rows; ++row)
      {
        const std::int64_t node =
          numbering.Node(patch, places[patch][static_cast<std::size_t>(row)]);
        points.row(row) = nodes.row(node).head(head.Components);
        own[row] = weights[node];
      }
      this->AddSpline(knots[patch], std::move(points), std::move(own));
    }
  }

  /// Patches with knots and control points of their own.
  void ReadPatches()
  {
    for (std::size_t patch = 0; patch < this->Mesh.Cells.size() && this->Words.Outcome; ++patch)
    {
      this->Words.Expect("knotvectors");
      this->Words.Integer("number of knot vectors of element " + std::to_string(patch),
        this->Mesh.Dimension, this->Mesh.Dimension);
      std::array<KnotVector, 3> knots;
      double rows = 1.0;
      for (int d = 0; d < this->Mesh.Dimension; ++d)
      {
        knots[At(d)] = this->ReadKnots(d);
        rows *= knots[At(d)].NumFunctions();
      }
      this->Words.Expect("dimension");
      const int columns = this->Words.Integer("coordinates of a control point", 1, 3);
      const std::string kind(this->Words.Word("'controlpoints'"));
      const bool isCartesian = kind == "controlpoints_cartesian";
      if (this->Words.Outcome && !isCartesian && kind != "controlpoints" &&
        kind != "controlpoints_homogeneous")
      {
        this->Fail(ErrorCode::InvalidFormat,
          Shown(kind) + " stands where 'controlpoints' or 'controlpoints_cartesian' must");
      }
      this->Words.CheckRoom("control points", rows * (columns + 1));
      if (!this->Words.Outcome)
      {
        return;
      }
      PointMatrix points(static_cast<Eigen::Index>(rows), columns);
      Eigen::VectorXd weights(points.rows());
      for (Eigen::Index row = 0; row < points.rows() && this->Words.Outcome; ++row)
      {
        for (int c = 0; c < columns; ++c)
        {
          points(row, c) = this->Words.Real("coordinate");
        }
        weights[row] = this->Words.Real("weight");
        if (this->Words.Outcome && !(weights[row] > 0.0))
        {
          this->Fail(ErrorCode::InvalidWeight,
            "weight " + std::to_string(weights[row]) + " is not positive; correct it");
        }
        if (!isCartesian)
        {
          points.row(row) /= weights[row];
        }
      }
      if (this->Words.Outcome)
      {
        this->AddSpline(knots, std::move(points), std::move(weights));
      }
    }
  }

  template <int Dim>
  void AddPatch(const std::array<KnotVector, 3>& knots, PointMatrix points, Eigen::VectorXd weights)
  {
    std::array<KnotVector, Dim> own;
    std::copy_n(knots.begin(), Dim, own.begin());
    auto space = MakeTensorSpace<Dim>(own);
    if (!space)
    {
      return this->Fail(space.Status.Code, space.Status.Detail);
    }
    Spline<Dim> spline;
    spline.Space = std::move(space.Value);
    spline.ControlPoints = std::move(points);
    const bool isRational = (weights.array() != 1.0).any();
    spline.Weights = isRational ? std::move(weights) : Eigen::VectorXd();
    if (const Status status = spline.Check(); !status)
    {
      return this->Fail(status.Code,
        "element " + std::to_string(this->Mesh.Splines.Splines.size()) + ": " + status.Detail);
    }
    this->Mesh.Splines.Splines.emplace_back(std::move(spline));
  }

  void AddSpline(
    const std::array<KnotVector, 3>& knots, PointMatrix points, Eigen::VectorXd weights)
  {
    switch (this->Mesh.Dimension)
    {
      case 1:
        return this->AddPatch<1>(knots, std::move(points), std::move(weights));
      case 2:
        return this->AddPatch<2>(knots, std::move(points), std::move(weights));
      default:
        return this->AddPatch<3>(knots, std::move(points), std::move(weights));
    }
  }

  /// Sides of the same vertices are one.
  template <int Dim>
  void AddSides(SharedSides& shared, std::vector<PatchSide>& sides) const
  {
    for (int patch = 0; patch < static_cast<int>(this->Mesh.Cells.size()); ++patch)
    {
      for (int side = 0; side < 2 * Dim; ++side)
      {
        std::vector<int> corners;
        for (int k = 0; k < 1 << (Dim - 1); ++k)
        {
          const int corner = TensorCorners[PatchCorner<Dim>(side, k)];
          corners.push_back(this->Mesh.Cells[At(patch)].Corners[At(corner)]);
        }
        const std::array<std::int64_t, 2> count{ Dim > 1 ? 2 : 1, Dim > 2 ? 2 : 1 };
        shared.Add({ patch, side }, count, corners);
        sides.push_back({ patch, side });
      }
    }
  }

  void StateTopology()
  {
    StatedPatches patches;
    patches.Dimension = this->Mesh.Dimension;
    for (int i = 0; i < static_cast<int>(this->Mesh.Splines.Splines.size()); ++i)
    {
      patches.Splines.push_back(i);
    }
    SharedSides shared;
    std::vector<PatchSide> sides;
    switch (this->Mesh.Dimension)
    {
      case 1:
        this->AddSides<1>(shared, sides);
        break;
      case 2:
        this->AddSides<2>(shared, sides);
        break;
      default:
        this->AddSides<3>(shared, sides);
        break;
    }
    std::set<PatchSide> inner;
    for (const PatchInterface& one : shared.Interfaces)
    {
      inner.insert(one.Sides.begin(), one.Sides.end());
    }
    std::copy_if(sides.begin(), sides.end(), std::back_inserter(patches.Topology.Boundary),
      [&inner](const PatchSide& side) { return inner.count(side) == 0; });
    patches.Topology.Interfaces = std::move(shared.Interfaces);
    this->Mesh.Splines.MultiPatches.push_back(std::move(patches));
  }

  MfemWords& Words;
  const std::vector<std::array<int, 2>>& Edges;
  const std::vector<int>& EdgeKnots;
  MfemMesh& Mesh;
  MfemEntities Entities;
  std::vector<KnotVector> Knots;
};
}

void ReadNurbs(MfemWords& words, const std::vector<std::array<int, 2>>& edges,
  const std::vector<int>& knots, MfemMesh& mesh)
{
  NurbsParser(words, edges, knots, mesh).Read();
}
}
