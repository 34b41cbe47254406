// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedElements.h"

#include "TargetNodes.h"

#include <knotwork/JacobianValidation/CellMeasures.h>
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <numeric>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Status CheckElement(const StraightElements& elements, int e)
{
  const CellShape shape = elements.Shapes[At(e)];
  const std::size_t begin = elements.Begin[At(e)];
  const std::size_t end = elements.Begin[At(e) + 1];
  if (end - begin != At(NumCorners(shape)) || end > elements.Corners.size() ||
    NumParameters(shape) < 2 || NumParameters(shape) != NumParameters(elements.Shapes.front()))
  {
    return { ErrorCode::InvalidTopology,
      elements.ElementName(e) +
        " is none of a surface, or none of a volume, as the first one is; give elements "
        "of one dimension" };
  }
  std::vector<int> corners(elements.Corners.begin() + static_cast<std::ptrdiff_t>(begin),
    elements.Corners.begin() + static_cast<std::ptrdiff_t>(end));
  std::sort(corners.begin(), corners.end());
  if (corners.front() < 0 || corners.back() >= static_cast<int>(elements.Points.rows()))
  {
    return { ErrorCode::InvalidTopology,
      elements.ElementName(e) + " has a corner that is no point" };
  }
  if (std::adjacent_find(corners.begin(), corners.end()) != corners.end())
  {
    return { ErrorCode::InvalidTopology,
      elements.ElementName(e) +
        " has one point at two corners; give it as an element of fewer corners" };
  }
  return {};
}

Status CheckInput(const StraightElements& elements, const CurvedElementsParams& params)
{
  if (params.Order < 1 || params.Order > 4 || !(params.FarShare > 0.0))
  {
    return { ErrorCode::InvalidParameter,
      "the order is 1, 2, 3 or 4, the far share above 0; order " + std::to_string(params.Order) +
        " was given" };
  }
  if (elements.NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, "the mesh has no elements to curve" };
  }
  for (Eigen::Index i = 0; i < elements.Points.rows(); ++i)
  {
    if (!elements.Points.row(i).allFinite())
    {
      return { ErrorCode::NonFiniteInput,
        elements.PointName(static_cast<int>(i)) +
          " has a coordinate that is not finite; correct it" };
    }
  }
  if (!params.Regions.empty() && params.Regions.size() != elements.Shapes.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(params.Regions.size()) + " regions of " +
        std::to_string(elements.NumElements()) + " elements" };
  }
  for (int e = 0; e < elements.NumElements(); ++e)
  {
    if (Status status = CheckElement(elements, e); !status)
    {
      return status;
    }
  }
  return {};
}

/// Exchanges the ends of the first parameter.
void Mirror(StraightElements& elements, int e)
{
  int* corners = elements.Corners.data() + elements.Begin[At(e)];
  switch (elements.Shapes[At(e)])
  {
    case CellShape::Wedge:
      std::swap(corners[4], corners[5]);
      std::swap(corners[1], corners[2]);
      break;
    case CellShape::Triangle:
    case CellShape::Tetrahedron:
      std::swap(corners[1], corners[2]);
      break;
    default:
      for (int c = 0; c < NumCorners(elements.Shapes[At(e)]); c += 2)
      {
        std::swap(corners[c], corners[c + 1]);
      }
  }
}

/// Of every face, the elements that have it.
std::vector<std::vector<int>> ElementsOfFaces(const NodeLattice& lattice)
{
  std::vector<std::vector<int>> elements(lattice.Faces.size());
  for (int e = 0; e < lattice.NumElements(); ++e)
  {
    for (const int face : lattice.FacesAt[At(e)])
    {
      elements[At(face)].push_back(e);
    }
  }
  return elements;
}

class Curving
{
public:
  Curving(StraightElements elements, const FitTarget* target, const CurvedElementsParams& params)
    : Elements(std::move(elements)), Target(target), Params(params)
  {
  }

  Result<CurvedElements> Make()
  {
    if (Status status = this->TurnReversed(); !status)
    {
      return status;
    }
    const NodeLattice lattice(this->Elements, this->Params.Order);
    CurvedNodes nodes(lattice, this->Elements.Points, this->Params.Bezier);
    if (Status status = this->Params.IsConforming ? Status() : this->CheckConforming(lattice);
        !status)
    {
      return status;
    }
    if (Status status = this->FindFacets(lattice); !status)
    {
      return status;
    }
    if (this->Target && this->Params.Order > 1)
    {
      if (Status status = PlaceOnTarget(*this->Target, this->Facets, lattice, this->Elements.Points,
            this->Params, nodes, this->Found.Placed, this->Found.UnmatchedCurves);
          !status)
      {
        return status;
      }
    }
    if (!this->Report(0.4))
    {
      return { ErrorCode::Aborted, "" };
    }
    auto certificate =
      nodes.Relax(this->Elements, this->Params.Threads, this->Params.Progress, this->Found.Relaxed);
    if (!certificate)
    {
      return certificate.Status;
    }
    this->Found.Certificate = std::move(certificate.Value);
    this->Found.Following = nodes.NumFollowing();
    if (!this->Report(0.7))
    {
      return { ErrorCode::Aborted, "" };
    }
    this->TakeOver(lattice, nodes);
    if (Status status = this->Measure(lattice, nodes); !status)
    {
      return status;
    }
    return std::move(this->Found);
  }

private:
  bool Report(double share) const { return !this->Params.Progress || this->Params.Progress(share); }

  /// Straight elements must be valid: what is relaxed ends there.
  Status TurnReversed()
  {
    BernsteinCells cells;
    cells.NumComponents = 3;
    for (int e = 0; e < this->Elements.NumElements(); ++e)
    {
      const CellShape shape = this->Elements.Shapes[At(e)];
      double* block = cells.Block(cells.Add(shape, DegreeOf(shape, 1)));
      const int count = NumCorners(shape);
      for (int c = 0; c < count; ++c) // of degree 1 the coefficients are the corners, in order
      {
        const int corner = this->Elements.Corners[this->Elements.Begin[At(e)] + At(c)];
        for (int d = 0; d < 3; ++d)
        {
          block[d * count + c] = this->Elements.Points(corner, d);
        }
      }
    }
    JacobianParams params;
    params.Threads = this->Params.Threads;
    const auto certificate = ValidateJacobian(cells, params);
    if (!certificate)
    {
      return certificate.Status;
    }
    for (int e = 0; e < this->Elements.NumElements(); ++e)
    {
      const Verdict verdict = certificate->Cells[At(e)].Verdict;
      if (verdict == Verdict::Reversed)
      {
        Mirror(this->Elements, e);
        ++this->Found.Turned;
      }
      else if (verdict != Verdict::Valid || certificate->Cells[At(e)].Degenerate != 0)
      {
        const int corner = this->Elements.Corners[this->Elements.Begin[At(e)]];
        return { ErrorCode::NotConverged,
          this->Elements.ElementName(e) + " at " +
            PointText(this->Elements.Points.row(corner).data(), 3) +
            " is not valid though it is straight, so no curved one is: mend its corners, or leave "
            "it out" };
      }
    }
    return {};
  }

  Status CheckConforming(const NodeLattice& lattice) const
  {
    if (const HangingPoint found = FindHangingPoint(lattice.Edges, this->Elements.Points);
        found.Point >= 0)
    {
      return { ErrorCode::InvalidTopology,
        this->Elements.PointName(found.Point) + " lies on the edge from " +
          this->Elements.PointName(found.Edge[0]) + " to " +
          this->Elements.PointName(found.Edge[1]) +
          ": the mesh is not conforming; divide the elements of that edge, too" };
    }
    for (const FaceCorners& face : lattice.Faces)
    {
      for (std::size_t without = 0; face[3] >= 0 && without < 4; ++without)
      {
        const FaceCorners triangle{ face[(without + 1) % 4], face[(without + 2) % 4],
          face[(without + 3) % 4], -1 };
        if (lattice.FindFace(triangle) >= 0)
        {
          return { ErrorCode::InvalidTopology,
            "a quadrilateral is met by triangles at " + this->Elements.PointName(triangle[0]) +
              ", " + this->Elements.PointName(triangle[1]) + " and " +
              this->Elements.PointName(triangle[2]) +
              ": the mesh is not conforming; divide the element of the quadrilateral, too" };
        }
      }
    }
    return {};
  }

  Status FindFacets(const NodeLattice& lattice)
  {
    const auto elements = ElementsOfFaces(lattice);
    const std::size_t most = lattice.IsVolume() ? 2 : 1;
    for (std::size_t f = 0; f < elements.size(); ++f)
    {
      if (elements[f].size() > most)
      {
        return { ErrorCode::InvalidTopology,
          std::to_string(elements[f].size()) + " elements, " +
            this->Elements.ElementName(elements[f][0]) + " and " +
            this->Elements.ElementName(elements[f][most]) +
            " among them, have one face: leave out what is there twice" };
      }
      const auto& regions = this->Params.Regions;
      const bool isWall = elements[f].size() == 1 ||
        (!regions.empty() && regions[At(elements[f][0])] != regions[At(elements[f][1])]);
      if (this->Params.Facets.empty() && isWall)
      {
        this->Facets.push_back(static_cast<int>(f));
      }
    }
    for (const FaceCorners& corners : this->Params.Facets)
    {
      this->Facets.push_back(lattice.FindFace(corners));
      if (this->Facets.back() < 0)
      {
        return { ErrorCode::InvalidTopology,
          "no element has the facet of points " + std::to_string(corners[0]) + ", " +
            std::to_string(corners[1]) + ", " + std::to_string(corners[2]) };
      }
    }
    this->FacetOf.assign(lattice.Faces.size(), -1);
    for (std::size_t i = 0; i < this->Facets.size(); ++i)
    {
      this->FacetOf[At(this->Facets[i])] = static_cast<int>(i);
    }
    this->Found.NumFacets = static_cast<int>(this->Facets.size());
    for (const auto& faces : lattice.FacesAt)
    {
      this->Found.BoundaryElements += std::any_of(
        faces.begin(), faces.end(), [this](int face) { return this->FacetOf[At(face)] >= 0; });
    }
    return {};
  }

  void TakeOver(const NodeLattice& lattice, const CurvedNodes& nodes)
  {
    this->Found.Points = nodes.Output();
    this->Found.Shapes = lattice.Shapes;
    this->Found.Nodes = lattice.Nodes;
    this->Found.Begin = lattice.Begin;
  }

  Status Measure(const NodeLattice& lattice, const CurvedNodes& nodes)
  {
    Eigen::VectorXd errors;
    const auto area = this->MeasureFacets(lattice, nodes.ControlPoints(errors));
    if (!area)
    {
      return area.Status;
    }
    this->Found.Area = area.Value;
    if (lattice.IsVolume())
    {
      std::vector<int> all(lattice.Shapes.size());
      std::iota(all.begin(), all.end(), 0);
      const auto volume = this->Sum(nodes.MakeCells(all));
      if (!volume)
      {
        return volume.Status;
      }
      this->Found.Volume = volume.Value;
    }
    this->Found.Distance.assign(lattice.Shapes.size(), 0.0);
    if (!this->Target || this->Facets.empty())
    {
      return {};
    }
    // the same faces: they do not depend on the order
    const NodeLattice flat(this->Elements, 1);
    std::vector<double> farthest;
    auto before = knotwork::MeasureFacets(
      *this->Target, this->Facets, flat, this->Elements.Points, this->Params.Threads, farthest);
    if (!before)
    {
      return before.Status;
    }
    if (!this->Report(0.85))
    {
      return { ErrorCode::Aborted, "" };
    }
    auto after = knotwork::MeasureFacets(
      *this->Target, this->Facets, lattice, nodes.Positions(), this->Params.Threads, farthest);
    this->Found.StraightToTarget = before.Value;
    this->Found.CurvedToTarget = after.Value;
    for (std::size_t e = 0; after && e < lattice.FacesAt.size(); ++e)
    {
      for (const int face : lattice.FacesAt[e])
      {
        const int facet = this->FacetOf[At(face)];
        this->Found.Distance[e] =
          std::max(this->Found.Distance[e], facet < 0 ? 0.0 : farthest[At(facet)]);
      }
    }
    return after.Status;
  }

  Result<double> Sum(const BernsteinCells& cells) const
  {
    CellMeasuresParams params;
    params.BoundBoxes = 0;
    params.SamplesPerEdge = 2;
    params.Threads = this->Params.Threads;
    const auto measured = MeasureCells(cells, params);
    return measured ? Result<double>(measured->Total.Measure) : Result<double>(measured.Status);
  }

  Result<double> MeasureFacets(const NodeLattice& lattice, const PointMatrix& control) const
  {
    BernsteinCells cells;
    cells.NumComponents = 3;
    for (const int facet : this->Facets)
    {
      const CellShape shape = lattice.FaceShape(facet);
      const int* nodes = lattice.FaceNodes.data() + lattice.FaceBegin[At(facet)];
      const auto count =
        static_cast<Eigen::Index>(lattice.FaceBegin[At(facet) + 1] - lattice.FaceBegin[At(facet)]);
      double* block = cells.Block(cells.Add(shape, DegreeOf(shape, lattice.Order)));
      for (Eigen::Index i = 0; i < count; ++i)
      {
        for (Eigen::Index c = 0; c < 3; ++c)
        {
          block[c * count + i] = control(nodes[i], c);
        }
      }
    }
    return this->Facets.empty() ? Result<double>(0.0) : this->Sum(cells);
  }

  StraightElements Elements;
  const FitTarget* Target;
  const CurvedElementsParams& Params;
  CurvedElements Found;
  std::vector<int> Facets;  ///< faces of the lattice
  std::vector<int> FacetOf; ///< of every face, -1: none
};
}

void StraightElements::Add(CellShape shape, const std::vector<int>& corners)
{
  this->Shapes.push_back(shape);
  this->Corners.insert(this->Corners.end(), corners.begin(), corners.end());
  this->Begin.push_back(this->Corners.size());
}

std::string StraightElements::ElementName(int element) const
{
  return "element " +
    std::to_string(this->ElementNumbers.empty() ? element : this->ElementNumbers[At(element)]);
}

std::string StraightElements::PointName(int point) const
{
  return "point " +
    std::to_string(this->PointNumbers.empty() ? point : this->PointNumbers[At(point)]);
}

Result<CurvedElements> CurveElements(
  const StraightElements& elements, const FitTarget* target, const CurvedElementsParams& params)
{
  if (Status status = CheckInput(elements, params); !status)
  {
    return status;
  }
  return Curving(elements, target, params).Make();
}
}
