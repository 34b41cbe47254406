// SPDX-License-Identifier: BSD-3-Clause
#include "UnstructuredSpace.h"

#include "Creases.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Everything but continuities.
template <int Dim>
Result<std::shared_ptr<UnstructuredData<Dim>>> MakeData(
  const CellMesh<Dim>& mesh, int degree, const std::vector<double>& lengths)
{
  auto topology = MeshTopology<Dim>::Make(mesh);
  if (!topology)
  {
    return topology.Status;
  }
  if (degree < 1 || degree > MaxDegree)
  {
    return { ErrorCode::InvalidDegree, "degree " + std::to_string(degree) };
  }
  IntArray<Dim> degrees;
  degrees.fill(degree);
  if (static_cast<double>(mesh.NumCells()) * NumTensorFunctions<Dim>(degrees) >
    std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge,
      std::to_string(mesh.NumCells()) + " cells of degree " + std::to_string(degree) +
        " have more than 2^31 - 1 local functions" };
  }
  auto data = std::make_shared<UnstructuredData<Dim>>();
  data->Mesh = mesh;
  data->Topology = std::move(topology.Value);
  data->Degree = degree;
  data->Lengths = lengths;
  if (!lengths.empty()) // without lengths the sheets do not matter
  {
    data->Sheets = data->Topology.FindSheets();
    if (lengths.size() != static_cast<std::size_t>(data->Sheets.Count))
    {
      return { ErrorCode::SizeMismatch,
        std::to_string(lengths.size()) + " lengths for " + std::to_string(data->Sheets.Count) +
          " sheets of parallel edges" };
    }
    for (std::size_t i = 0; i < lengths.size(); ++i)
    {
      if (!(lengths[i] > 0.0) || !std::isfinite(lengths[i]))
      {
        return { ErrorCode::InvalidParameter,
          "sheet " + std::to_string(i) + " has a length that is not positive and finite" };
      }
    }
  }
  return data;
}

std::string SideName(const CellSide& side)
{
  return "side " + std::to_string(side.Side) + " of cell " + std::to_string(side.Cell);
}
}

template <int Dim>
Result<UnstructuredResult<Dim>> MakeUnstructuredSpace(
  const CellMesh<Dim>& mesh, const UnstructuredParams& params)
{
  if (Dim == 3 && params.Policy == CreasePolicy::Motorcycle)
  {
    return { ErrorCode::InvalidParameter, "tracks of motorcycles are for quadrilaterals" };
  }
  auto made = MakeData<Dim>(mesh, params.Degree, params.Lengths);
  if (!made)
  {
    return made.Status;
  }
  std::shared_ptr<UnstructuredData<Dim>> data = std::move(made.Value);
  const MeshTopology<Dim>& topology = data->Topology;
  if (const Status status = CheckFeatures(topology, params.Features); !status)
  {
    return status;
  }
  UnstructuredResult<Dim> result;
  result.InnerFacets = topology.NumInteriorFacets;
  result.ExtraordinaryRidges = topology.NumExtraordinaryRidges;
  result.IsOrientable = topology.IsOrientable;
  Creases<Dim> creases(*data, params.Features, params.Policy);
  result.Policy = creases.Policy();
  const std::vector<signed char> asked = data->Continuity;
  for (;;)
  {
    UnstructuredBuild<Dim> build = BuildUnstructured<Dim>(data);
    if (build.Space)
    {
      result.Space = std::move(build.Space);
      break;
    }
    if (!creases.Repair(build.Places))
    {
      return { ErrorCode::NotInSpace, Describe(build.Places.front()) };
    }
  }
  for (std::size_t i = 0; i < asked.size(); ++i)
  {
    result.Repairs += asked[i] != data->Continuity[i] ? 1 : 0;
  }
  result.Repairs /= 2; // seen from both cells
  result.CreasedFacets = creases.NumCreased();
  return result;
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakeUnstructuredSpace(const CellMesh<Dim>& mesh, int degree,
  const std::vector<int>& continuity, const std::vector<double>& lengths)
{
  auto made = MakeData<Dim>(mesh, degree, lengths);
  if (!made)
  {
    return made.Status;
  }
  UnstructuredData<Dim>& data = *made.Value;
  const MeshTopology<Dim>& topology = data.Topology;
  if (continuity.size() != static_cast<std::size_t>(topology.NumCells()) * 2 * Dim)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(continuity.size()) + " continuities for " +
        std::to_string(topology.NumCells()) + " cells of " + std::to_string(2 * Dim) + " sides" };
  }
  data.Continuity.assign(continuity.size(), -1);
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      if (topology.IsBoundary(c, side))
      {
        continue;
      }
      const auto at = [&](int cell, int s) {
        return continuity[static_cast<std::size_t>(cell) * 2 * Dim + static_cast<std::size_t>(s)];
      };
      const int r = at(c, side);
      if (r < 0 || r >= degree)
      {
        return { ErrorCode::InvalidParameter,
          SideName({ c, side }) + " has continuity " + std::to_string(r) + ", expected 0 to " +
            std::to_string(degree - 1) };
      }
      if (at(topology.Neighbour(c, side), topology.Crossing(c, side).Side) != r)
      {
        return { ErrorCode::InvalidParameter,
          SideName({ c, side }) + " has another continuity than the neighbour's side there" };
      }
      data.ContinuityOf(c, side) = static_cast<signed char>(r);
    }
  }
  UnstructuredBuild<Dim> build = BuildUnstructured<Dim>(made.Value);
  if (!build.Space)
  {
    return { ErrorCode::NotInSpace, Describe(build.Places.front()) };
  }
  return build.Space;
}

template <int Dim>
const CellMesh<Dim>& MeshOf(const SplineSpace<Dim>& space)
{
  return space.Unstructured->Mesh;
}

template <int Dim>
std::vector<int> ContinuityOf(const SplineSpace<Dim>& space)
{
  return { space.Unstructured->Continuity.begin(), space.Unstructured->Continuity.end() };
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<UnstructuredResult<Dim>> MakeUnstructuredSpace<Dim>(                             \
    const CellMesh<Dim>&, const UnstructuredParams&);                                              \
  template Result<SplineSpacePtr<Dim>> MakeUnstructuredSpace<Dim>(                                 \
    const CellMesh<Dim>&, int, const std::vector<int>&, const std::vector<double>&);               \
  template const CellMesh<Dim>& MeshOf<Dim>(const SplineSpace<Dim>&);                              \
  template std::vector<int> ContinuityOf<Dim>(const SplineSpace<Dim>&);
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
