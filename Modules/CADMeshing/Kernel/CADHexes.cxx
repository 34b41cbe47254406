// SPDX-License-Identifier: BSD-3-Clause
#include "CADHexes.h"

#include "BodyGroups.h"
#include "CornerFill.h"
#include "HexFacets.h"
#include "HexPadding.h"
#include "SolidFaceMesh.h"
#include "Sweep.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

// shares of the progress
constexpr double OfFaces = 0.5;
constexpr double OfFilling = 0.3;
constexpr double OfPadding = 0.2;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// What the mesh on its faces says of a solid.
struct SolidFaces
{
  SolidSweep Sweep;
  QuadSides Source;
  std::map<int, std::vector<int>> Columns; ///< of nodes of the source's rim, to the target's
  std::map<int, int> Images;               ///< nodes of the target, of those of the source
};

/// Meshes the faces one after the other and fills solids between them.
class HexMesher
{
public:
  /// @param leftOut  ways to mesh solids that are not taken.
  HexMesher(
    const CADTopology& model, const CADHexesParams& params, const std::set<SweepNumber>& leftOut)
    : Model(model), Params(params), LeftOut(leftOut), Faces(model, params.Faces),
      Surface(model, Faces)
  {
  }

  Result<CADHexes> Run();
  /// The ways that were taken for bodies with cells that are not valid.
  std::set<SweepNumber> NotValid(const CADHexes& made) const;

private:
  void FindGrids();
  void FollowSpacing();
  Status MeshFaces();
  Status MeshRoot(const std::vector<SolidSweep>& pending);
  Status MeshEnds(const SolidSweep& sweep);
  Status Fill(const SolidFaces& solid);
  Status FillCorners(const SolidSweep& sweep);
  Status Finish();

  const CADTopology& Model;
  const CADHexesParams& Params;
  const std::set<SweepNumber>& LeftOut;
  FaceMesher Faces;
  std::vector<SolidSweep> Sweeps;
  std::vector<bool> IsGrid; ///< faces
  std::optional<EdgeNodes> Nodes;
  SolidFaceMesh Surface;
  std::vector<SolidFaces> Solids;
  CADHexes Made;
};

/// Linking faces, and those that blocks join where nothing else does.
void HexMesher::FindGrids()
{
  const auto numFaces = static_cast<int>(this->Model.Faces.size());
  DisjointSets sets(numFaces);
  this->IsGrid.assign(At(numFaces), false);
  for (const SolidSweep& sweep : this->Sweeps)
  {
    for (const auto* faces : { &sweep.Source, &sweep.Target })
    {
      for (const int face : *faces)
      {
        sets.Unite(sweep.Source.front(), face);
      }
    }
    for (const int face : sweep.Linking) // of corners all
    {
      this->IsGrid[At(face)] = true;
    }
  }
  std::set<int> others;
  for (const SolidSweep& sweep : this->Sweeps)
  {
    if (!sweep.IsBlock && !sweep.Corners)
    {
      others.insert(sets.Find(sweep.Source.front()));
    }
  }
  for (const SolidSweep& sweep : this->Sweeps)
  {
    if (!sweep.Corners && others.count(sets.Find(sweep.Source.front())) == 0)
    {
      this->IsGrid[At(sweep.Source.front())] = true;
      this->IsGrid[At(sweep.Target.front())] = true;
    }
  }
}

/// An edge of a grid whose opposite side has several edges gets that side's spacing, and hands it
/// on.
void HexMesher::FollowSpacing()
{
  // places of the nodes of a side, along its loop
  const auto placesOf = [&](const std::vector<CADTopologyUse>& side)
  {
    std::vector<double> places{ 0.0 };
    double before = 0.0;
    for (const CADTopologyUse& use : side)
    {
      const double length = this->Model.Edges[At(use.Edge)].Length;
      const int count = this->Nodes->Counts[At(use.Edge)];
      for (int i = 1; i <= count; ++i)
      {
        const double share = use.Reversed ? 1.0 - this->Nodes->ShareOf(use.Edge, count - i)
                                          : this->Nodes->ShareOf(use.Edge, i);
        places.push_back(before + share * length);
      }
      before += length;
    }
    for (double& place : places)
    {
      place /= before;
    }
    return places;
  };
  bool changed = true;
  while (changed)
  {
    changed = false;
    for (const RectangleFace& rectangle : this->Faces.Rectangles())
    {
      const auto sides = this->Faces.Sides(rectangle.Face);
      for (std::size_t side = 0; this->IsGrid[At(rectangle.Face)] && side < 4; ++side)
      {
        const auto& from = sides[(side + 2) % 4];
        const CADTopologyUse& to = sides[side].front();
        std::vector<double>& shares = this->Nodes->Shares[At(to.Edge)];
        if (sides[side].size() > 1 || !shares.empty() ||
          (from.size() == 1 && this->Nodes->Shares[At(from[0].Edge)].empty()))
        {
          continue;
        }
        // the opposite side runs the other way
        shares = placesOf(from);
        if (!to.Reversed)
        {
          std::reverse(shares.begin(), shares.end());
          std::transform(
            shares.begin(), shares.end(), shares.begin(), [](double share) { return 1.0 - share; });
        }
        changed = true;
      }
    }
  }
}

/// Meshes an end from which others get their mesh: one with faces that have it already, as they
/// link elsewhere, then one with imprints, then the one with most faces.
Status HexMesher::MeshRoot(const std::vector<SolidSweep>& pending)
{
  std::vector<int> best;
  std::array<int, 3> mostReasons{ -1, -1, -1 };
  for (const SolidSweep& sweep : pending)
  {
    for (const auto* faces : { &sweep.Source, &sweep.Target })
    {
      if (faces == &sweep.Target && !sweep.BothWays)
      {
        continue;
      }
      const auto meshed = static_cast<int>(std::count_if(
        faces->begin(), faces->end(), [&](int face) { return this->Surface.IsMeshed(face); }));
      const std::array<int, 3> reasons{ meshed, sweep.BothWays ? 0 : 1,
        static_cast<int>(faces->size()) };
      if (reasons > mostReasons)
      {
        mostReasons = reasons;
        best = *faces;
      }
    }
  }
  for (const int face : best)
  {
    if (!this->Surface.IsMeshed(face))
    {
      const FaceMethod method = this->Faces.Kind(face) == LogicalShapeKind::Other
        ? FaceMethod::Paved
        : FaceMethod::GridIfGood;
      if (Status meshed = this->Surface.MeshFace(face, method); !meshed)
      {
        return meshed;
      }
    }
  }
  return {};
}

/// The source has its mesh: the target gets it, or must have the same.
Status HexMesher::MeshEnds(const SolidSweep& sweep)
{
  SolidFaces solid;
  solid.Sweep = sweep;
  solid.Source = this->Surface.QuadsOf(sweep.Body, sweep.Source);
  if (Status found = this->Surface.FindColumns(sweep, solid.Source, solid.Columns); !found)
  {
    return found;
  }
  const bool known = std::any_of(sweep.Target.begin(), sweep.Target.end(),
    [&](int face) { return this->Surface.IsMeshed(face); });
  const Status ended = known ? this->Surface.Match(sweep, solid.Source, solid.Columns, solid.Images)
                             : this->Surface.Copy(sweep, solid.Source, solid.Columns, solid.Images);
  this->Solids.push_back(std::move(solid));
  return ended;
}

/// Linking faces first, then ends of sweeps, one from the other where they can.
Status HexMesher::MeshFaces()
{
  this->Surface.Begin(*this->Nodes);
  this->Solids.clear();
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    if (this->IsGrid[At(face)])
    {
      if (Status meshed = this->Surface.MeshFace(face, FaceMethod::Grid); !meshed)
      {
        return meshed;
      }
    }
  }
  std::vector<SolidSweep> pending;
  std::copy_if(this->Sweeps.begin(), this->Sweeps.end(), std::back_inserter(pending),
    [](const SolidSweep& sweep) { return !sweep.Corners; });
  while (!pending.empty())
  {
    auto next = std::find_if(pending.begin(), pending.end(),
      [&](const SolidSweep& sweep) { return this->Surface.IsMeshed(sweep.Source); });
    if (next == pending.end())
    {
      next = std::find_if(pending.begin(), pending.end(),
        [&](const SolidSweep& sweep)
        { return sweep.BothWays && this->Surface.IsMeshed(sweep.Target); });
      if (next == pending.end())
      {
        if (Status meshed = this->MeshRoot(pending); !meshed)
        {
          return meshed;
        }
        continue;
      }
      *next = Reversed(*next);
    }
    if (Status ended = this->MeshEnds(*next); !ended)
    {
      return ended;
    }
    pending.erase(next);
    const auto all = static_cast<double>(this->Sweeps.size());
    if (this->Params.Faces.Progress &&
      !this->Params.Faces.Progress(OfFaces * (all - static_cast<double>(pending.size())) / all))
    {
      return { ErrorCode::Aborted, "meshing was stopped" };
    }
  }
  return {};
}

Status HexMesher::Fill(const SolidFaces& solid)
{
  const SolidSweep& sweep = solid.Sweep;
  const SourceMesh source(solid.Source, this->Surface.Mesh().Points);
  const auto numLayers = static_cast<int>(solid.Columns.begin()->second.size()) - 1;
  const auto hexahedra = static_cast<double>(source.Mesh.NumCells()) * numLayers;
  if (Status small = CheckSize(hexahedra + this->Made.Mesh.NumCells(), this->Params.MaxHexahedra,
        "hexahedra", "MaximumHexahedra");
      !small)
  {
    return small;
  }
  LinkedSweepParams params;
  // of layers, of points of the source; -1: inside
  std::vector<std::vector<int>> nodes(
    At(numLayers + 1), std::vector<int>(source.Numbers.size(), -1));
  for (const auto& [node, column] : solid.Columns)
  {
    params.Rim.push_back(source.Numbers.at(node));
    PointMatrix& places = params.Columns.emplace_back(numLayers + 1, 3);
    for (int k = 0; k <= numLayers; ++k)
    {
      places.row(k) = this->Surface.Mesh().Points[At(column[At(k)])].transpose();
      nodes[At(k)][At(params.Rim.back())] = column[At(k)];
    }
  }
  params.Target.resize(source.Mesh.NumPoints, 3);
  for (const auto& [node, number] : source.Numbers)
  {
    nodes.front()[At(number)] = node;
    nodes.back()[At(number)] = solid.Images.at(node);
    params.Target.row(number) = this->Surface.Mesh().Points[At(solid.Images.at(node))].transpose();
  }
  const auto swept = SweepBetween(source.Mesh, source.Points, params);
  if (!swept)
  {
    return { swept.Status.Code, SolidName(sweep.Body) + ": " + swept.Status.Detail };
  }
  CADMesh& mesh = this->Surface.Mesh();
  for (int k = 1; k < numLayers; ++k)
  {
    for (int v = 0; v < source.Mesh.NumPoints; ++v)
    {
      int& node = nodes[At(k)][At(v)];
      if (node < 0)
      {
        node = static_cast<int>(mesh.Points.size());
        mesh.Points.emplace_back(swept->Points.row(k * source.Mesh.NumPoints + v).transpose());
        mesh.PointDimension.push_back(3);
        mesh.PointEntity.push_back(sweep.Body);
      }
    }
  }
  for (const int corner : swept->Mesh.Corners)
  {
    this->Made.Mesh.Corners.push_back(
      nodes[At(corner / source.Mesh.NumPoints)][At(corner % source.Mesh.NumPoints)]);
  }
  for (int c = 0; c < swept->Mesh.NumCells(); ++c)
  {
    this->Made.HexBody.push_back(sweep.Body);
    this->Made.HexLayer.push_back(c / source.Mesh.NumCells());
  }
  CADSolidHexes numbers;
  numbers.Body = sweep.Body;
  numbers.Source = sweep.Source;
  numbers.Target = sweep.Target;
  numbers.Linking = sweep.Linking;
  numbers.Layers = numLayers;
  this->Made.Solids.push_back(std::move(numbers));
  return {};
}

Status HexMesher::FillCorners(const SolidSweep& sweep)
{
  std::map<int, QuadSides> quads;
  for (const int face : sweep.Linking)
  {
    quads[face] = this->Surface.QuadsOf(sweep.Body, { face });
  }
  CornerFill filling(this->Model, *sweep.Corners, *this->Nodes, quads, this->Surface.Mesh());
  const double number =
    static_cast<double>(sweep.Corners->Corners.size()) * std::pow(filling.HalfSegments(), 3);
  if (Status small = CheckSize(number + this->Made.Mesh.NumCells(), this->Params.MaxHexahedra,
        "hexahedra", "MaximumHexahedra");
      !small)
  {
    return small;
  }
  CADSolidHexes numbers;
  numbers.Body = sweep.Body;
  numbers.Linking = sweep.Linking;
  for (const auto& hexahedron : filling.Fill(sweep.Body))
  {
    this->Made.Mesh.Corners.insert(
      this->Made.Mesh.Corners.end(), hexahedron.begin(), hexahedron.end());
    this->Made.HexBody.push_back(sweep.Body);
    this->Made.HexLayer.push_back(0);
  }
  this->Made.Solids.push_back(std::move(numbers));
  return {};
}

/// Takes the points that hexahedra have, and measures these.
Status HexMesher::Finish()
{
  const CADMesh& mesh = this->Surface.Mesh();
  std::vector<int> numbers(mesh.Points.size(), -1);
  for (const int corner : this->Made.Mesh.Corners)
  {
    numbers[At(corner)] = 0;
  }
  int count = 0;
  for (std::size_t p = 0; p < numbers.size(); ++p)
  {
    if (numbers[p] == 0)
    {
      numbers[p] = count++;
      this->Made.PointDimension.push_back(mesh.PointDimension[p]);
      this->Made.PointEntity.push_back(mesh.PointEntity[p]);
    }
  }
  this->Made.Points.resize(count, 3);
  for (std::size_t p = 0; p < numbers.size(); ++p)
  {
    if (numbers[p] >= 0)
    {
      this->Made.Points.row(numbers[p]) = mesh.Points[p].transpose();
    }
  }
  for (int& corner : this->Made.Mesh.Corners)
  {
    corner = numbers[At(corner)];
  }
  this->Made.Mesh.NumPoints = count;
  auto quality = MeasureHexahedra(this->Made.Mesh, this->Made.Points, this->Params.Threads);
  if (!quality)
  {
    return quality.Status;
  }
  this->Made.Quality = std::move(quality.Value);
  std::map<int, double> least;
  std::map<int, int> number;
  for (std::size_t c = 0; c < this->Made.HexBody.size(); ++c)
  {
    ++number[this->Made.HexBody[c]];
    double& ofBody = least.try_emplace(this->Made.HexBody[c], 1.0).first->second;
    ofBody = std::min(ofBody, this->Made.Quality.ScaledJacobians[c]);
  }
  std::sort(this->Made.Solids.begin(), this->Made.Solids.end(),
    [](const CADSolidHexes& a, const CADSolidHexes& b) { return a.Body < b.Body; });
  for (CADSolidHexes& solid : this->Made.Solids)
  {
    solid.LeastScaledJacobian = least[solid.Body];
    solid.Hexahedra = number[solid.Body];
  }
  return {};
}

std::set<SweepNumber> HexMesher::NotValid(const CADHexes& made) const
{
  std::set<SweepNumber> numbers;
  for (std::size_t c = 0; c < made.HexBody.size(); ++c)
  {
    if (made.Quality.Certificate.Cells[c].Verdict != Verdict::Valid)
    {
      const auto sweep = std::find_if(this->Sweeps.begin(), this->Sweeps.end(),
        [&](const SolidSweep& one) { return one.Body == made.HexBody[c]; });
      numbers.insert({ sweep->Body, sweep->Rank });
    }
  }
  return numbers;
}

Result<CADHexes> HexMesher::Run()
{
  constexpr int Rounds = 4;
  auto wishes = this->Faces.Wishes("MaximumHexahedra");
  if (!wishes)
  {
    return wishes.Status;
  }
  this->Faces.FindShapes();
  auto sweeps = ChooseSweeps(this->Model, this->Faces, this->LeftOut);
  if (!sweeps)
  {
    return sweeps.Status;
  }
  this->Sweeps = std::move(sweeps.Value);
  this->FindGrids();
  std::vector<EqualChains> required;
  for (const SolidSweep& sweep : this->Sweeps)
  {
    required.insert(required.end(), sweep.Equal.begin(), sweep.Equal.end());
  }
  for (const RectangleFace& rectangle : this->Faces.Rectangles())
  {
    if (this->IsGrid[At(rectangle.Face)])
    {
      this->Faces.RaiseWishes(rectangle, wishes.Value);
      required.push_back({ rectangle.Sides[0], rectangle.Sides[2] });
      required.push_back({ rectangle.Sides[1], rectangle.Sides[3] });
    }
  }
  for (int round = 0;; ++round)
  {
    std::vector<RectangleFace> rings = this->Faces.Rings();
    auto divided = DivideEdges(this->Model, wishes.Value, required, rings);
    if (!divided)
    {
      return divided.Status;
    }
    this->Nodes.emplace(this->Model, std::move(divided.Value));
    this->FollowSpacing();
    const Status meshed = this->MeshFaces();
    if (this->Surface.Poor().empty() || round + 1 == Rounds || meshed.Code == ErrorCode::TooLarge ||
      meshed.Code == ErrorCode::Aborted)
    {
      if (!meshed)
      {
        return meshed;
      }
      break;
    }
    for (const int face : this->Surface.Poor())
    {
      this->Faces.Halve(face, *this->Nodes, wishes.Value);
    }
  }
  for (const SolidFaces& solid : this->Solids)
  {
    if (Status filled = this->Fill(solid); !filled)
    {
      return filled;
    }
    const auto done = static_cast<double>(this->Made.Solids.size());
    if (this->Params.Faces.Progress &&
      !this->Params.Faces.Progress(
        OfFaces + OfFilling * done / static_cast<double>(this->Solids.size())))
    {
      return { ErrorCode::Aborted, "meshing was stopped" };
    }
  }
  for (const SolidSweep& sweep : this->Sweeps)
  {
    if (Status filled = sweep.Corners ? this->FillCorners(sweep) : Status(); !filled)
    {
      return filled;
    }
  }
  HexCells cells{ std::move(this->Made.Mesh.Corners), std::move(this->Made.HexBody),
    std::move(this->Made.HexLayer) };
  ProgressCallback padding;
  if (this->Params.Faces.Progress)
  {
    padding = [&](double done)
    { return this->Params.Faces.Progress(OfFaces + OfFilling + OfPadding * done); };
  }
  const auto padded = PadSmoothSurfaces(this->Model, this->Faces, *this->Nodes,
    this->Surface.Mesh(), cells, this->Params.Threads, padding);
  if (!padded)
  {
    return padded.Status;
  }
  this->Made.OnFaces = FindFacetsOnFaces(this->Model, this->Surface.Mesh(), cells);
  this->Made.Mesh.Corners = std::move(cells.Corners);
  this->Made.HexBody = std::move(cells.Bodies);
  this->Made.HexLayer = std::move(cells.Layers);
  this->Made.PaddedHexes = padded.Value;
  if (Status finished = this->Finish(); !finished)
  {
    return finished;
  }
  return std::move(this->Made);
}

/// Where hexahedra of solids are not valid, these are meshed in other ways; the mesh with the best
/// corners is kept.
Result<CADHexes> BestOfWays(const CADTopology& model, const CADHexesParams& params)
{
  constexpr int MostWays = 6;
  std::set<SweepNumber> leftOut;
  Result<CADHexes> best;
  for (int way = 0; way < MostWays; ++way)
  {
    HexMesher mesher(model, params, leftOut);
    auto made = mesher.Run();
    if (!made)
    {
      return way == 0 || made.Status.Code != ErrorCode::InvalidTopology ? made : best;
    }
    const std::set<SweepNumber> bad = mesher.NotValid(made.Value);
    leftOut.insert(bad.begin(), bad.end());
    if (way == 0 || bad.empty() ||
      made->Quality.LeastScaledJacobian > best->Quality.LeastScaledJacobian)
    {
      best = std::move(made);
    }
    if (bad.empty())
    {
      break;
    }
  }
  return best;
}

void SeparateBodies(const CADTopology& model, CADHexes& made)
{
  const std::vector<int> groups = GroupsOfBodies(model);
  std::vector<int> groupOf;
  for (const int body : made.HexBody)
  {
    groupOf.push_back(groups[At(body)]);
  }
  const std::vector<int> added = SeparatePoints(made.Mesh.Corners, groupOf, made.Mesh.NumPoints);
  made.Points.conservativeResize(made.Mesh.NumPoints + static_cast<int>(added.size()), 3);
  for (const int point : added)
  {
    made.Points.row(made.Mesh.NumPoints++) = made.Points.row(point);
    made.PointDimension.push_back(made.PointDimension[At(point)]);
    made.PointEntity.push_back(made.PointEntity[At(point)]);
  }
}
}

std::array<int, 4> CornersOfHexSide(int side)
{
  const int d = side / 2;
  int u = (d + 1) % 3;
  int w = (d + 2) % 3;
  if (side % 2 == 0)
  {
    std::swap(u, w);
  }
  std::array<int, 4> corners{};
  for (int i = 0; i < 4; ++i)
  {
    corners[At(i)] = ((side % 2) << d) | ((i & 1) << u) | ((i >> 1) << w);
  }
  return corners;
}

Result<CADHexes> MeshHexes(const CADTopology& model, const CADHexesParams& params)
{
  if (Status valid = CheckParams(params.Faces); !valid)
  {
    return valid;
  }
  if (params.MaxHexahedra < 1)
  {
    return { ErrorCode::InvalidParameter, "MaxHexahedra must be positive" };
  }
  if (model.Bodies.empty())
  {
    return { ErrorCode::EmptyInput, "the model has no solids" };
  }
  try
  {
    auto made = BestOfWays(model, params);
    if (made)
    {
      SeparateBodies(model, made.Value);
    }
    return made;
  }
  catch (...)
  {
    return StatusOfException();
  }
}
}
