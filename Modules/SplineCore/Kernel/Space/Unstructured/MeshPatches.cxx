// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPatches.h"

#include "Creases.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Lays the cells between cuts on grids.
template <int Dim>
class Layout
{
public:
  explicit Layout(const UnstructuredData<Dim>& data) : Data(data) {}

  /// @return a facet to cut where cells between cuts are no box; Cell = -1 when all are.
  CellSide Run(MeshPatches<Dim>& result)
  {
    const int numCells = this->Data.Topology.NumCells();
    result.Patches.clear();
    result.PatchOf.assign(At(numCells), -1);
    result.IndexOf.assign(At(numCells), {});
    result.AheadOf.assign(At(numCells), {});
    for (int c = 0; c < numCells; ++c)
    {
      if (result.PatchOf[At(c)] >= 0)
      {
        continue;
      }
      const CellSide conflict = this->LayPatch(c, result);
      if (conflict.Cell >= 0)
      {
        return conflict;
      }
    }
    return {};
  }

private:
  /// The cells that hang together with one, placed by steps across facets.
  CellSide LayPatch(int root, MeshPatches<Dim>& result) const
  {
    const MeshTopology<Dim>& topology = this->Data.Topology;
    const int patch = static_cast<int>(result.Patches.size());
    std::vector<int> cells{ root };
    result.PatchOf[At(root)] = patch;
    for (int d = 0; d < Dim; ++d)
    {
      result.AheadOf[At(root)][At(d)] = 2 * d + 1;
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
    {
      const int c = cells[i];
      for (int d = 0; d < Dim; ++d)
      {
        for (const int step : { -1, 1 })
        {
          const int ahead = result.AheadOf[At(c)][At(d)];
          const int side = step > 0 ? ahead : ahead ^ 1;
          if (this->Data.ContinuityOf(c, side) <= 0)
          {
            continue;
          }
          const int other = topology.Neighbour(c, side);
          IntArray<Dim> index = result.IndexOf[At(c)];
          index[At(d)] += step;
          IntArray<Dim> aheadThere{};
          for (std::size_t k = 0; k < Dim; ++k)
          {
            aheadThere[k] = topology.Crossing(c, side).Image[At(result.AheadOf[At(c)][k])];
          }
          if (result.PatchOf[At(other)] < 0)
          {
            result.PatchOf[At(other)] = patch;
            result.IndexOf[At(other)] = index;
            result.AheadOf[At(other)] = aheadThere;
            cells.push_back(other);
          }
          else if (result.IndexOf[At(other)] != index || result.AheadOf[At(other)] != aheadThere)
          {
            return { c, side };
          }
        }
      }
    }
    return this->Finish(cells, result);
  }

  /// Moves indices to begin at 0 and fills the grid.
  CellSide Finish(const std::vector<int>& cells, MeshPatches<Dim>& result) const
  {
    IntArray<Dim> lower = result.IndexOf[At(cells.front())];
    IntArray<Dim> upper = lower;
    for (const int c : cells)
    {
      for (std::size_t d = 0; d < Dim; ++d)
      {
        lower[d] = std::min(lower[d], result.IndexOf[At(c)][d]);
        upper[d] = std::max(upper[d], result.IndexOf[At(c)][d]);
      }
    }
    MeshPatch<Dim> patch;
    double size = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      patch.Size[d] = upper[d] - lower[d] + 1;
      size *= patch.Size[d];
    }
    if (size != static_cast<double>(cells.size()))
    {
      return this->CutOfRoom(cells);
    }
    patch.Cells.assign(cells.size(), -1);
    for (const int c : cells)
    {
      std::size_t at = 0;
      for (std::size_t d = Dim; d-- > 0;)
      {
        result.IndexOf[At(c)][d] -= lower[d];
        at = at * At(patch.Size[d]) + At(result.IndexOf[At(c)][d]);
      }
      if (patch.Cells[at] >= 0) // two sheets of cells over one place
      {
        return this->CutOfRoom(cells);
      }
      patch.Cells[at] = c;
    }
    const CellSide slit = this->FindSlit(cells, result);
    if (slit.Cell < 0)
    {
      result.Patches.push_back(std::move(patch));
    }
    return slit;
  }

  /// A cut between cells that lie side by side in a box: it ends inside.
  CellSide FindSlit(const std::vector<int>& cells, const MeshPatches<Dim>& result) const
  {
    const MeshTopology<Dim>& topology = this->Data.Topology;
    for (const int c : cells)
    {
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const int ahead = result.AheadOf[At(c)][d];
        if (this->Data.ContinuityOf(c, ahead) != 0)
        {
          continue;
        }
        const int other = topology.Neighbour(c, ahead);
        IntArray<Dim> index = result.IndexOf[At(c)];
        ++index[d];
        if (result.PatchOf[At(other)] == result.PatchOf[At(c)] &&
          result.IndexOf[At(other)] == index)
        {
          return { c, ahead };
        }
      }
    }
    return {};
  }

  /// A facet that goes on from a cut into cells that are no box; else the first that is not cut.
  CellSide CutOfRoom(const std::vector<int>& cells) const
  {
    const MeshTopology<Dim>& topology = this->Data.Topology;
    CellSide any;
    for (const int c : cells)
    {
      for (int side = 0; side < 2 * Dim; ++side)
      {
        if (this->Data.ContinuityOf(c, side) <= 0)
        {
          continue;
        }
        any = any.Cell < 0 ? CellSide{ c, side } : any;
        for (int across = 0; across < 2 * Dim; ++across)
        {
          if (across / 2 != side / 2 &&
            topology.IsRegularInside(c, MeshTopology<Dim>::RidgeOf(side, across)))
          {
            const CellSide opposite = topology.Opposite(c, side, across);
            if (this->Data.ContinuityOf(opposite.Cell, opposite.Side) == 0)
            {
              return { c, side };
            }
          }
        }
      }
    }
    return any;
  }

  const UnstructuredData<Dim>& Data;
};

/// Cuts between patches, and where one ends on another.
template <int Dim>
void FindCuts(const UnstructuredData<Dim>& data, MeshPatches<Dim>& result)
{
  const MeshTopology<Dim>& topology = data.Topology;
  for (int c = 0; c < topology.NumCells(); ++c)
  {
    for (int side = 0; side < 2 * Dim; ++side)
    {
      if (data.ContinuityOf(c, side) == 0 && c < topology.Neighbour(c, side))
      {
        result.Cuts.push_back({ c, side });
      }
    }
    for (int corner = 0; Dim == 2 && corner < 4; ++corner)
    {
      int lowest = c;
      int cuts = 0;
      if (topology.IsRegularInside(c, corner))
      {
        topology.Around(c, corner,
          [&](int cell, int, int out)
          {
            lowest = std::min(lowest, cell);
            cuts += data.ContinuityOf(cell, out) == 0 ? 1 : 0;
          });
      }
      if (cuts == 3 && lowest == c)
      {
        result.TJoints.push_back({ c, corner });
      }
    }
  }
}

/// C^0 across a facet and all its opposites.
template <int Dim>
void CutThrough(UnstructuredData<Dim>& data, const CellSide& facet)
{
  const auto slot = [](const CellSide& at) { return At(2 * Dim * at.Cell + at.Side); };
  std::vector<char> seen(data.Continuity.size(), 0); // from either cell
  std::vector<CellSide> open;
  const auto visit = [&](const CellSide& at)
  {
    const CellSide other{ data.Topology.Neighbour(at.Cell, at.Side),
      data.Topology.Crossing(at.Cell, at.Side).Side };
    if (seen[slot(at)]++ == 0)
    {
      seen[slot(other)] = 1;
      data.Lower(at.Cell, at.Side, 0);
      open.push_back(at);
    }
  };
  visit(facet);
  while (!open.empty())
  {
    const CellSide at = open.back();
    open.pop_back();
    for (int across = 0; across < 2 * Dim; ++across)
    {
      if (across / 2 != at.Side / 2 &&
        data.Topology.IsRegularInside(at.Cell, MeshTopology<Dim>::RidgeOf(at.Side, across)))
      {
        visit(data.Topology.Opposite(at.Cell, at.Side, across));
      }
    }
  }
}
}

template <int Dim>
MeshPatches<Dim> FindSpacePatches(const SplineSpace<Dim>& space)
{
  UnstructuredData<Dim> data = *space.Unstructured;
  MeshPatches<Dim> result;
  Layout<Dim> layout(data);
  for (CellSide cut = layout.Run(result); cut.Cell >= 0; cut = layout.Run(result))
  {
    CutThrough(data, cut);
  }
  FindCuts(data, result);
  return result;
}

template <int Dim>
Result<MeshPatches<Dim>> FindMeshPatches(
  const CellMesh<Dim>& mesh, CreasePolicy policy, const std::vector<CellSide>& features)
{
  if (policy != CreasePolicy::Full && (policy != CreasePolicy::Motorcycle || Dim == 3))
  {
    return { ErrorCode::InvalidParameter,
      "patches are between the facets of the base complex, or of quadrilaterals between tracks" };
  }
  UnstructuredData<Dim> data;
  auto topology = MeshTopology<Dim>::Make(mesh);
  if (!topology)
  {
    return topology.Status;
  }
  data.Mesh = mesh;
  data.Topology = std::move(topology.Value);
  data.Degree = 2; // smooth or not
  if (const Status status = CheckFeatures(data.Topology, features); !status)
  {
    return status;
  }
  Creases<Dim> creases(data, features, policy);
  MeshPatches<Dim> result;
  Layout<Dim> layout(data);
  for (CellSide cut = layout.Run(result); cut.Cell >= 0; cut = layout.Run(result))
  {
    creases.CreaseFully({ cut });
  }
  FindCuts(data, result);
  return result;
}

template MeshPatches<2> FindSpacePatches<2>(const SplineSpace<2>&);
template MeshPatches<3> FindSpacePatches<3>(const SplineSpace<3>&);
template Result<MeshPatches<2>> FindMeshPatches<2>(
  const CellMesh<2>&, CreasePolicy, const std::vector<CellSide>&);
template Result<MeshPatches<3>> FindMeshPatches<3>(
  const CellMesh<3>&, CreasePolicy, const std::vector<CellSide>&);
}
