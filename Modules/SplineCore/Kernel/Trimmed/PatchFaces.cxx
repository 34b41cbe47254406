// SPDX-License-Identifier: BSD-3-Clause
#include "PatchFaces.h"

#include "BezierForm.h"
#include "DisjointSets.h"
#include "MeshTraces.h"
#include "SplitIntoPatches.h"
#include "TensorRestriction.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sides around a face, and whether its outer loop segments them backwards.
constexpr struct
{
  int Side;
  bool Backwards;
} AroundFace[] = { { 2, false }, { 1, false }, { 3, true }, { 0, true } };

class FaceMaker
{
public:
  FaceMaker(
    const Spline<2>& surface, const MeshPatches<2>& layout, const std::vector<Spline<2>>& patches)
    : Space(*surface.Space), Mesh(MeshOf(*surface.Space)), Layout(layout), Patches(patches),
      IsCorner(At(this->Mesh.NumPoints), 0)
  {
    for (int p = 0; p < static_cast<int>(layout.Patches.size()); ++p)
    {
      for (int s = 0; s < 4; ++s)
      {
        const auto facets = FacetsOfSide(this->Space, layout, { p, s });
        this->IsCorner[At(this->EndOf({ p, s }, facets.front(), false))] = 1;
        this->IsCorner[At(this->EndOf({ p, s }, facets.back(), true))] = 1;
      }
    }
  }

  Status Run(TrimmedModel& model)
  {
    for (int p = 0; p < static_cast<int>(this->Patches.size()); ++p)
    {
      TrimmedFace face;
      face.Surface = this->Patches[At(p)];
      face.Loops.emplace_back();
      for (const auto& [side, backwards] : AroundFace)
      {
        if (Status status = this->AddSide({ p, side }, backwards, face.Loops[0]); !status)
        {
          return status;
        }
      }
      model.Faces.push_back(std::move(face));
    }
    model.NumEdges = static_cast<int>(this->Edges.size());
    model.NumVertices = static_cast<int>(this->Vertices.size());
    return {};
  }

private:
  /// Facets of a side between corners of patches, in the direction of the side.
  struct Segment
  {
    std::vector<SideFacet> Facets;
    std::array<int, 2> Ends; ///< points of the mesh
    ParametricBox<1> Box;    ///< in the parameter of the side
  };
  struct SharedEdge
  {
    Spline<1> Curve;
    CellSide First; ///< facet at its begin, of the patch that it was made for
    int Begin;      ///< point of the mesh
    std::array<int, 2> Vertices;
  };

  /// The point at the lower or upper end of a facet, in the direction of its side.
  int EndOf(const PatchSide& side, const SideFacet& facet, bool upper) const
  {
    const std::size_t along = SideDirections<2>(side.Side)[0];
    const int ahead = this->Layout.AheadOf[At(facet.Facet.Cell)][along];
    const int end = upper ? ahead : ahead ^ 1;
    const int corner = (end % 2 << end / 2) | (facet.Facet.Side % 2 << facet.Facet.Side / 2);
    return this->Mesh.Cell(facet.Facet.Cell)[corner];
  }

  std::vector<Segment> SegmentsOf(const PatchSide& side) const
  {
    const std::size_t along = SideDirections<2>(side.Side)[0];
    const std::vector<double>& breaks = this->Patches[At(side.Patch)].Space->Knots[along].Breaks();
    const auto facets = FacetsOfSide(this->Space, this->Layout, side);
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < facets.size(); ++i)
    {
      const int begin = this->EndOf(side, facets[i], false);
      if (i == 0 || this->IsCorner[At(begin)] != 0)
      {
        Segment segment;
        segment.Ends[0] = begin;
        segment.Box.Lower[0] = breaks[i];
        segments.push_back(std::move(segment));
      }
      segments.back().Facets.push_back(facets[i]);
      segments.back().Ends[1] = this->EndOf(side, facets[i], true);
      segments.back().Box.Upper[0] = breaks[i + 1];
    }
    return segments;
  }

  int VertexOf(int point)
  {
    return this->Vertices.emplace(point, static_cast<int>(this->Vertices.size())).first->second;
  }

  /// Number of the edge along a segment; the first patch that has it gives its curve.
  Result<int> EdgeOf(const PatchSide& side, const Segment& segment)
  {
    const SideFacet& first = segment.Facets.front();
    const auto key = [](const CellSide& facet) { return 4 * facet.Cell + facet.Side; };
    if (first.Other.Cell >= 0)
    {
      const auto known = this->EdgeOfFacet.find(key(first.Other));
      if (known != this->EdgeOfFacet.end())
      {
        return known->second;
      }
    }
    auto whole = SideSpline<2>(this->Patches[At(side.Patch)], side.Side);
    auto part = whole ? RestrictTensor<1>(whole.Value, segment.Box) : std::move(whole);
    if (!part)
    {
      return part.Status;
    }
    const int number = static_cast<int>(this->Edges.size());
    this->Edges.push_back({ std::move(part.Value), first.Facet, segment.Ends[0],
      { this->VertexOf(segment.Ends[0]), this->VertexOf(segment.Ends[1]) } });
    for (const SideFacet& facet : segment.Facets)
    {
      this->EdgeOfFacet[key(facet.Facet)] = number;
    }
    return number;
  }

  /// Whether a segment goes from the end of the edge to its begin.
  bool IsOpposed(const SharedEdge& edge, const Segment& segment) const
  {
    const auto is = [&](const CellSide& facet)
    { return facet.Cell == edge.First.Cell && facet.Side == edge.First.Side; };
    const SideFacet& first = segment.Facets.front();
    if (segment.Facets.size() == 1)
    {
      return segment.Ends[0] != edge.Begin;
    }
    return !is(first.Facet) && !is(first.Other);
  }

  Status AddSide(const PatchSide& side, bool backwards, TrimmedLoop& loop)
  {
    std::vector<Segment> segments = this->SegmentsOf(side);
    if (backwards)
    {
      std::reverse(segments.begin(), segments.end());
    }
    const std::size_t across = AcrossSide(side.Side);
    const double at = SideValue<2>(this->Patches[At(side.Patch)].Space->Domain(), side.Side);
    for (const Segment& segment : segments)
    {
      const auto number = this->EdgeOf(side, segment);
      if (!number)
      {
        return number.Status;
      }
      const SharedEdge& edge = this->Edges[At(number.Value)];
      const bool opposed = this->IsOpposed(edge, segment);
      TrimmingCurve use;
      use.Curve = edge.Curve;
      use.Edge = number.Value;
      use.Vertices = edge.Vertices;
      use.Reversed = opposed != backwards;
      const KnotVector& knots = edge.Curve.Space->Knots[0];
      use.UV.resize(knots.NumFunctions(), 2);
      for (int i = 0; i < knots.NumFunctions(); ++i)
      {
        // linear in the parameter of the curve: control points at Greville abscissae
        double t = (knots.Greville(i) - knots.Begin()) / (knots.End() - knots.Begin());
        t = opposed ? 1.0 - t : t;
        use.UV(i, static_cast<Eigen::Index>(across)) = at;
        use.UV(i, static_cast<Eigen::Index>(1 - across)) =
          (1.0 - t) * segment.Box.Lower[0] + t * segment.Box.Upper[0];
      }
      loop.Curves.push_back(std::move(use));
    }
    return {};
  }

  const SplineSpace<2>& Space;
  const CellMesh<2>& Mesh;
  const MeshPatches<2>& Layout;
  const std::vector<Spline<2>>& Patches;
  std::vector<char> IsCorner; ///< points of the mesh at corners of patches
  std::vector<SharedEdge> Edges;
  std::map<int, int> EdgeOfFacet;
  std::map<int, int> Vertices;
};

/// Cells that hang together by faces, and how they are turned.
struct CellBodies
{
  std::vector<int> Of;             ///< number of the body of every cell
  std::vector<double> Determinant; ///< of every body: sum of det J at the middles of its cells
};

CellBodies FindBodies(const Spline<3>& volume, const MeshTopology<3>& topology, int threads)
{
  DisjointSets sets(topology.NumCells());
  std::vector<int> cells;
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    cells.push_back(c);
    for (int side = 0; side < 6; ++side)
    {
      if (!topology.IsBoundary(c, side))
      {
        sets.Unite(c, topology.Neighbour(c, side));
      }
    }
  }
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  EvaluationBatch batch;
  const PointMatrix middles = PointMatrix::Constant(topology.NumCells(), 3, 0.5);
  EvaluateElements<3>(MakeBezierForm(volume, threads), cells, middles, params, batch);
  CellBodies bodies;
  std::map<int, int> numbers;
  for (const int c : cells)
  {
    const int number =
      numbers.try_emplace(sets.Find(c), static_cast<int>(numbers.size())).first->second;
    bodies.Of.push_back(number);
    bodies.Determinant.resize(numbers.size(), 0.0);
    const Eigen::Vector3d du = batch.First.row(c).segment<3>(0);
    const Eigen::Vector3d dv = batch.First.row(c).segment<3>(3);
    const Eigen::Vector3d dw = batch.First.row(c).segment<3>(6);
    bodies.Determinant[At(number)] += du.cross(dv).dot(dw);
  }
  return bodies;
}
}

Result<TrimmedModel> FacesOfPatches(const Spline<2>& surface, int threads)
{
  if (surface.Space && surface.ControlPoints.cols() != 3)
  {
    return { ErrorCode::SizeMismatch, "the surface needs 3 coordinates" };
  }
  MeshPatches<2> layout;
  const auto split = SplitIntoPatches(surface, threads, &layout);
  if (!split)
  {
    return split.Status;
  }
  Result<TrimmedModel> model;
  model.Status = FaceMaker(surface, layout, split->Patches).Run(model.Value);
  if (surface.IsRational()) // a linear image is not in the rational space of a curve
  {
    for (TrimmedFace& face : model->Faces)
    {
      face.Loops.clear();
    }
    model->NumEdges = model->NumVertices = 0;
  }
  return model;
}

Result<TrimmedModel> FacesOfPatches(const Spline<3>& volume, int threads)
{
  if (!volume.Space)
  {
    return { ErrorCode::EmptyInput, "no space" };
  }
  if (volume.Space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the volume is none on an unstructured mesh" };
  }
  if (Status status = volume.Check(); !status)
  {
    return status;
  }
  if (volume.NumComponents() != 3)
  {
    return { ErrorCode::SizeMismatch, "the volume needs 3 coordinates" };
  }
  const auto topology = MeshTopology<3>::Make(MeshOf(*volume.Space));
  if (!topology)
  {
    return topology.Status;
  }
  const auto trace = TraceOnFacets(*volume.Space, BoundaryFacets<3>(topology.Value));
  if (!trace)
  {
    return trace.Status;
  }
  auto model = FacesOfPatches(TraceOf<2>(volume, trace.Value), threads);
  if (!model)
  {
    return model;
  }
  const CellBodies bodies = FindBodies(volume, topology.Value, threads);
  const MeshPatches<2> layout = FindSpacePatches(*trace->Space); // a face a patch
  for (std::size_t f = 0; f < model->Faces.size(); ++f)
  {
    const int facet = layout.Patches[f].Cells.front();
    TrimmedFace& face = model->Faces[f];
    face.Body = bodies.Of[At(trace->Elements[At(facet)].Facet.Cell)];
    face.Reversed = bodies.Determinant[At(face.Body)] < 0.0;
  }
  return model;
}
}
