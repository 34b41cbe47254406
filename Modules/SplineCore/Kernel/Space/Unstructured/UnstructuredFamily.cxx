// SPDX-License-Identifier: BSD-3-Clause
// Splines on unstructured meshes as a family.
#include "ControlNet.h"
#include "FamilyWithoutDomain.h"
#include "UnstructuredData.h"
#include "UnstructuredRefinement.h"
#include "UnstructuredSpace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

enum Table
{
  MeshCorners,
  FacetContinuity,
  NumTables
};

/// Corners of cells are points of the mesh, edges and faces have their inner points once.
template <int Dim>
class PointNumbers
{
public:
  explicit PointNumbers(const UnstructuredData<Dim>& data)
    : Data(data), P(data.Degree), Next(data.Mesh.NumPoints),
      FirstOfFacet(At(data.Topology.NumCells()) * NumSides)
  {
    const std::int64_t inside = Dim == 2 ? this->P - 1 : (this->P - 1) * (this->P - 1);
    for (int c = 0; c < data.Topology.NumCells(); ++c)
    {
      for (int side = 0; side < NumSides; ++side)
      {
        const int other = data.Topology.Neighbour(c, side);
        const bool isOwner = other < 0 || other > c;
        this->FirstOfFacet[At(c * NumSides + side)] = isOwner
          ? this->Next
          : this->FirstOfFacet[At(other * NumSides + data.Topology.Crossing(c, side).Side)];
        this->Next += isOwner ? inside : 0;
      }
    }
  }

  ElementPoints Number()
  {
    ElementPoints numbering;
    IntArray<Dim> degree;
    degree.fill(this->P);
    const int count = NumTensorFunctions<Dim>(degree);
    numbering.Ids.reserve(At(this->Data.Topology.NumCells()) * At(count));
    for (int c = 0; c < this->Data.Topology.NumCells(); ++c)
    {
      IntArray<Dim> x{};
      for (int i = 0; i < count; ++i)
      {
        numbering.Ids.push_back(this->PointAt(c, x));
        for (std::size_t d = 0; d < Dim && ++x[d] > this->P; ++d)
        {
          x[d] = 0;
        }
      }
    }
    numbering.Count = this->Next;
    return numbering;
  }

private:
  static constexpr int NumSides = 2 * Dim;

  std::int64_t PointAt(int cell, const IntArray<Dim>& x)
  {
    int low = 0; // corner with all free directions at their lower ends
    int free = -1;
    int across = -1;
    int numFree = 0;
    for (int d = 0; d < Dim; ++d)
    {
      const bool isFree = x[At(d)] > 0 && x[At(d)] < this->P;
      numFree += isFree ? 1 : 0;
      free = isFree ? d : free;
      across = isFree ? across : 2 * d + (x[At(d)] > 0 ? 1 : 0);
      low |= x[At(d)] == this->P ? 1 << d : 0;
    }
    if (numFree == 0)
    {
      return this->Data.Mesh.Cell(cell)[low];
    }
    if (numFree == Dim)
    {
      return this->Next++;
    }
    if (numFree == Dim - 1)
    {
      return this->OnFacet(cell, across, x);
    }
    const std::int64_t a = this->Data.Mesh.Cell(cell)[low];
    const std::int64_t b = this->Data.Mesh.Cell(cell)[low | 1 << free];
    const auto [place, isNew] =
      this->FirstOfEdge.try_emplace(std::min(a, b) << 32 | std::max(a, b), this->Next);
    this->Next += isNew ? this->P - 1 : 0;
    return place->second + (a < b ? x[At(free)] : this->P - x[At(free)]) - 1;
  }

  /// Inner points of a facet in the order of its owner, the lower cell.
  std::int64_t OnFacet(int cell, int side, const IntArray<Dim>& x) const
  {
    const int other = this->Data.Topology.Neighbour(cell, side);
    IntArray<Dim> at = x;
    int owned = side;
    if (other >= 0 && other < cell)
    {
      const FacetCrossing<Dim>& crossing = this->Data.Topology.Crossing(cell, side);
      owned = crossing.Side;
      for (int d = 0; d < Dim; ++d)
      {
        const int image = crossing.Image[At(2 * d)];
        at[At(image / 2)] = image % 2 == 0 ? x[At(d)] : this->P - x[At(d)];
      }
    }
    std::int64_t offset = 0;
    for (int d = Dim; d-- > 0;)
    {
      offset = d == owned / 2 ? offset : offset * (this->P - 1) + at[At(d)] - 1;
    }
    return this->FirstOfFacet[At(cell * NumSides + side)] + offset;
  }

  const UnstructuredData<Dim>& Data;
  int P;
  std::int64_t Next;
  std::vector<std::int64_t> FirstOfFacet;
  std::unordered_map<std::int64_t, std::int64_t> FirstOfEdge; ///< of hexahedra
};

/// Neighbours in the grid of a cell's local functions, where both are functions.
template <int Dim>
std::vector<NetEdge> NetOfCells(const SplineSpace<Dim>& space)
{
  const auto functionOf = [&space](int local)
  {
    if (space.IsIdentityMap())
    {
      return local;
    }
    const std::size_t first = space.RowStart[At(local)];
    return space.RowStart[At(local) + 1] - first == 1 ? space.RowFunction[first] : -1;
  };
  std::vector<NetEdge> edges;
  std::set<std::array<int, 2>> seen;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int* ids = space.LocalFunctions(e);
    const int width = space.Elements[At(e)].Degree[0] + 1;
    const int count = NumTensorFunctions<Dim>(space.Elements[At(e)].Degree);
    for (int d = 0, stride = 1; d < Dim; ++d, stride *= width)
    {
      for (int i = 0; i < count; ++i)
      {
        if (i / stride % width + 1 == width)
        {
          continue;
        }
        const int a = functionOf(ids[i]);
        const int b = functionOf(ids[i + stride]);
        if (a >= 0 && b >= 0 && seen.insert({ std::min(a, b), std::max(a, b) }).second)
        {
          edges.push_back({ a, b, d });
        }
      }
    }
  }
  return edges;
}

constexpr const char* NoCurves = "unstructured spaces have two or three parameters";

/// Curves have no such spaces, and no definition makes one.
template <int Dim>
class OnMesh final : public FamilyWithoutDomain<Dim>
{
public:
  const char* Name() const override { return "unstructured"; }
  int StoredNumber() const override { return 4; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> tables{ { "MeshCorners", { "" }, true },
      { "FacetContinuity", { "" }, true } };
    return tables;
  }
  std::size_t NumRows(const SpaceDefinition& definition, int, std::size_t) const override
  {
    return (definition.Tables[MeshCorners].Whole.size() >> definition.Dimension) * 2 *
      At(definition.Dimension);
  }
  /// The knots of the first direction are the intervals of the sheets.
  SpaceDefinition Describe([[maybe_unused]] const SplineSpace<Dim>& space) const override
  {
    SpaceDefinition definition;
    definition.Kind = SpaceKind::Unstructured;
    definition.Dimension = Dim;
    definition.Tables.resize(NumTables);
    if constexpr (Dim > 1)
    {
      const UnstructuredData<Dim>& data = *space.Unstructured;
      std::fill_n(definition.Degree.begin(), Dim, data.Degree);
      definition.Knots[0] = data.Lengths;
      definition.Tables[MeshCorners].Whole.assign(
        data.Mesh.Corners.begin(), data.Mesh.Corners.end());
      definition.Tables[FacetContinuity].Whole.assign(
        data.Continuity.begin(), data.Continuity.end());
    }
    return definition;
  }
  Result<SplineSpacePtr<Dim>> Build(
    [[maybe_unused]] const SpaceDefinition& definition, int) const override
  {
    if constexpr (Dim > 1)
    {
      constexpr std::int64_t most = std::numeric_limits<int>::max() - 1;
      CellMesh<Dim> mesh;
      std::vector<int> continuity;
      for (const std::int64_t point : definition.Tables[MeshCorners].Whole)
      {
        if (point < 0 || point > most)
        {
          return { ErrorCode::InvalidTopology, "a corner of the mesh is out of range" };
        }
        mesh.Corners.push_back(static_cast<int>(point));
        mesh.NumPoints = std::max(mesh.NumPoints, mesh.Corners.back() + 1);
      }
      if (static_cast<std::size_t>(mesh.NumPoints) > mesh.Corners.size())
      {
        return { ErrorCode::InvalidTopology, "the mesh has points without cells" };
      }
      for (const std::int64_t r : definition.Tables[FacetContinuity].Whole)
      {
        continuity.push_back(static_cast<int>(std::clamp<std::int64_t>(r, -1, MaxDegree)));
      }
      for (std::size_t d = 1; d < Dim; ++d)
      {
        if (definition.Degree[d] != definition.Degree[0])
        {
          return { ErrorCode::InvalidTopology, "the degrees of an unstructured space differ" };
        }
      }
      return MakeUnstructuredSpace<Dim>(
        mesh, definition.Degree[0], continuity, definition.Knots[0]);
    }
    return { ErrorCode::InvalidTopology, NoCurves };
  }

  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space) const override
  {
    return NetOfCells(space);
  }
  ElementPoints NumberPoints([[maybe_unused]] const SplineSpace<Dim>& space) const override
  {
    if constexpr (Dim > 1)
    {
      return PointNumbers<Dim>(*space.Unstructured).Number();
    }
    return {};
  }
  double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int elevation, int refinements) const override
  {
    const double pieces = std::ldexp(1.0, refinements); // of an element in a direction
    return space.NumFunctions + space.NumElements() * (std::pow(elevation + pieces, Dim) - 1.0);
  }

  Result<RefinedSpline<Dim>> RefineAll([[maybe_unused]] const Spline<Dim>& spline) const override
  {
    if constexpr (Dim > 1)
    {
      return HalveAllSheets(spline);
    }
    return { ErrorCode::DimensionMismatch, NoCurves };
  }
  Result<RefinedSpline<Dim>> RefineMarked([[maybe_unused]] const Spline<Dim>& spline,
    [[maybe_unused]] const std::vector<int>& marked, const RefinementParams&) const override
  {
    if constexpr (Dim > 1)
    {
      return HalveSheetsOfCells(spline, marked);
    }
    return { ErrorCode::DimensionMismatch, NoCurves };
  }
  Result<Spline<Dim>> ElevateDegrees(
    [[maybe_unused]] const Spline<Dim>& spline, [[maybe_unused]] int times) const override
  {
    if constexpr (Dim > 1)
    {
      return ElevateUnstructured(spline, times);
    }
    return { ErrorCode::DimensionMismatch, NoCurves };
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>&, int, int) const override
  {
    return { ErrorCode::DimensionMismatch,
      "a spline on an unstructured mesh is no tensor product; write .vtu" };
  }
};
}

template <int Dim>
const SpaceFamily<Dim>& UnstructuredFamily()
{
  static const OnMesh<Dim> family;
  return family;
}

template const SpaceFamily<1>& UnstructuredFamily<1>();
template const SpaceFamily<2>& UnstructuredFamily<2>();
template const SpaceFamily<3>& UnstructuredFamily<3>();
}
