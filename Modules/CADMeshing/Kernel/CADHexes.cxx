// SPDX-License-Identifier: BSD-3-Clause
#include "CADHexes.h"

#include "CornerFill.h"
#include "HexPadding.h"
#include "QuadSides.h"
#include "RimMap.h"
#include "SolidSweeps.h"
#include "Sweep.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;
using Quad = QuadSides::Quad;
using Side = QuadSides::Side;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::string SolidName(int body)
{
  return "solid " + std::to_string(body);
}

/// The quadrilaterals of a source, with points of their own.
struct SourceMesh
{
  SourceMesh(const QuadSides& quads, const std::vector<Vector3d>& points)
  {
    for (const Quad& quad : quads.Quads)
    {
      for (const std::size_t corner : { 0, 1, 3, 2 })
      {
        const auto [number, isNew] =
          this->Numbers.try_emplace(quad[corner], static_cast<int>(this->Numbers.size()));
        this->Mesh.Corners.push_back(number->second);
      }
    }
    this->Mesh.NumPoints = static_cast<int>(this->Numbers.size());
    this->Points.resize(this->Mesh.NumPoints, 3);
    for (const auto& [node, number] : this->Numbers)
    {
      this->Points.row(number) = points[At(node)].transpose();
    }
  }

  std::map<int, int> Numbers; ///< of nodes
  CellMesh<2> Mesh;
  PointMatrix Points;
};

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
    : Model(model), Params(params), LeftOut(leftOut), Faces(model, params.Faces)
  {
  }

  Result<CADHexes> Run();
  /// The ways that were taken for bodies with cells that are not valid.
  std::set<SweepNumber> NotValid(const CADHexes& made) const;

private:
  void FindGrids();
  void FollowSpacing();
  Status MeshFace(int face, FaceMethod method);
  std::vector<int> AppendFace(int face);
  Status MeshFaces();
  Status MeshRoot(const std::vector<SolidSweep>& pending);
  Status MeshEnds(const SolidSweep& sweep);
  QuadSides QuadsOf(int body, const std::vector<int>& faces) const;
  bool IsMeshed(const std::vector<int>& faces) const;
  Status Columns(const SolidSweep& sweep, const QuadSides& source,
    std::map<int, std::vector<int>>& columns) const;
  Status Match(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, std::vector<int>>& columns, std::map<int, int>& images) const;
  Status MatchImprints(const SolidSweep& sweep, std::map<int, int>& images) const;
  Status Copy(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, std::vector<int>>& columns, std::map<int, int>& images);
  Status FacesOfCopies(const SolidSweep& sweep, const QuadSides& source,
    const std::map<int, int>& images, std::vector<int>& faceOfQuads) const;
  std::map<int, int> TakeCopy(int face, const QuadSides& source, const std::vector<int>& quads,
    const std::map<int, int>& images, const std::map<int, Vector3d>& places);
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
  CADQuads Surface;
  std::vector<std::vector<int>> QuadsOfFaces;
  std::vector<int> Poor; ///< faces whose quadrilaterals are none or bad
  std::vector<SolidFaces> Solids;
  CADHexes Made;
};

bool HexMesher::IsMeshed(const std::vector<int>& faces) const
{
  return std::all_of(
    faces.begin(), faces.end(), [&](int face) { return !this->QuadsOfFaces[At(face)].empty(); });
}

/// Counterclockwise about the normal that leads out of a body of theirs.
QuadSides HexMesher::QuadsOf(int body, const std::vector<int>& faces) const
{
  QuadSides quads;
  const auto& sides = this->Model.Bodies[At(body)].Sides;
  for (const int face : faces)
  {
    const auto side = std::find_if(
      sides.begin(), sides.end(), [&](const CADTopologySide& one) { return one.Face == face; });
    for (const int id : this->QuadsOfFaces[At(face)])
    {
      Quad quad = this->Surface.Mesh.Quads[At(id)];
      if (side->Reversed)
      {
        std::swap(quad[1], quad[3]);
      }
      quads.Add(quad);
    }
  }
  return quads;
}

/// The nodes from the rim of the source along the linking faces.
Status HexMesher::Columns(
  const SolidSweep& sweep, const QuadSides& source, std::map<int, std::vector<int>>& columns) const
{
  const QuadSides links = this->QuadsOf(sweep.Body, sweep.Linking);
  const Status failure{ ErrorCode::InvalidTopology,
    SolidName(sweep.Body) + " has sides with different numbers of layers; lower EdgeLength" };
  std::size_t layers = 0;
  const auto take = [&](int node, std::vector<int> column)
  {
    const auto [known, isNew] = columns.try_emplace(node, column);
    layers = layers == 0 ? column.size() : layers;
    return column.size() == layers && known->second == column && layers > 1;
  };
  for (const auto& [side, quads] : source.Sides)
  {
    if (quads.size() != 1)
    {
      continue;
    }
    auto [a, b] = side;
    std::vector<int> ofA{ a };
    std::vector<int> ofB{ b };
    int quad = links.Beside(a, b, -1);
    while (quad >= 0 && ofA.size() <= links.Quads.size())
    {
      std::tie(b, a) = links.Across(quad, a, b);
      ofA.push_back(a);
      ofB.push_back(b);
      quad = links.Beside(a, b, quad);
    }
    if (!take(side.first, ofA) || !take(side.second, ofB))
    {
      return failure;
    }
  }
  return {};
}

/// Both ends have a mesh: from the rim on, quadrilateral by quadrilateral, they must be one.
Status HexMesher::Match(const SolidSweep& sweep, const QuadSides& source,
  const std::map<int, std::vector<int>>& columns, std::map<int, int>& images) const
{
  const QuadSides target = this->QuadsOf(sweep.Body, sweep.Target);
  const Status failure{ ErrorCode::InvalidTopology,
    SolidName(sweep.Body) + ": the meshes of " + FaceName(this->Model, sweep.Source.front()) +
      " and " + FaceName(this->Model, sweep.Target.front()) +
      ", which its neighbours give, do not match; cut it (cadmodify), or mesh it alone" };
  for (const auto& [node, column] : columns)
  {
    images[node] = column.back();
  }
  std::vector<std::array<int, 2>> pairs(source.Quads.size(), { -1, -1 });
  std::vector<std::array<int, 4>> open; ///< a side, the quadrilateral of the source, of the target
  for (const auto& [side, quads] : source.Sides)
  {
    if (quads.size() == 1)
    {
      open.push_back({ side.first, side.second, quads[0],
        target.Beside(images.at(side.first), images.at(side.second), -1) });
    }
  }
  std::vector<int> partner(source.Quads.size(), -1);
  while (!open.empty())
  {
    const auto [a, b, quad, image] = open.back();
    open.pop_back();
    if (image < 0 || (partner[At(quad)] >= 0 && partner[At(quad)] != image))
    {
      return failure;
    }
    if (partner[At(quad)] == image)
    {
      continue;
    }
    partner[At(quad)] = image;
    const Side far = source.Across(quad, a, b);
    const Side farImage = target.Across(image, images.at(a), images.at(b));
    for (const auto& [node, there] :
      { Side{ far.first, farImage.first }, Side{ far.second, farImage.second } })
    {
      if (images.try_emplace(node, there).first->second != there)
      {
        return failure;
      }
    }
    for (const auto& [from, to] :
      { Side{ b, far.first }, Side{ far.first, far.second }, Side{ far.second, a } })
    {
      const int next = source.Beside(from, to, quad);
      if (next >= 0)
      {
        open.push_back({ from, to, next, target.Beside(images.at(from), images.at(to), image) });
      }
    }
  }
  return target.Quads.size() == source.Quads.size() ? Status() : failure;
}

/// Nodes of edges inside of the target are images of nodes of edges inside of the source.
Status HexMesher::MatchImprints(const SolidSweep& sweep, std::map<int, int>& images) const
{
  const RimMap map(sweep.Origin, sweep.Arrival, sweep.Mirrored);
  for (const EdgePair& pair : sweep.Imprints)
  {
    const int count = this->Nodes->Counts[At(pair.Source)];
    const auto& ends = this->Model.Edges[At(pair.Source)].Vertices;
    const bool closed = ends[0] == ends[1];
    const auto placeOf = [&](int edge, int i)
    { return this->Model.EdgePoint(edge, this->Nodes->ShareOf(edge, i)); };
    const auto shifted = [&](int i, int shift, bool backward)
    {
      const int at = backward ? count - i : i;
      return closed ? (at + shift) % count : at;
    };
    int best = 0;
    bool bestBackward = false;
    double least = std::numeric_limits<double>::max();
    for (int shift = 0; shift < (closed ? count : 1); ++shift)
    {
      for (const bool backward : { false, true })
      {
        double sum = 0.0;
        for (int i = 0; i <= count; ++i)
        {
          sum += (map(placeOf(pair.Source, i).transpose()).transpose() -
            placeOf(pair.Target, shifted(i, shift, backward)))
                   .squaredNorm();
        }
        if (sum < least)
        {
          least = sum;
          best = shift;
          bestBackward = backward;
        }
      }
    }
    for (int i = 0; i <= count; ++i)
    {
      const int node = this->Nodes->NodeOf(this->Model, pair.Source, i);
      const int image =
        this->Nodes->NodeOf(this->Model, pair.Target, shifted(i, best, bestBackward));
      if (images.try_emplace(node, image).first->second != image)
      {
        return { ErrorCode::InvalidTopology,
          SolidName(sweep.Body) + ": edges inside of " +
            FaceName(this->Model, sweep.Target.front()) + " do not match those of " +
            FaceName(this->Model, sweep.Source.front()) + "; cut it (cadmodify)" };
      }
    }
  }
  return {};
}

/// Which face of the target every quadrilateral comes to: regions between imprints go to the face
/// that has all edges around them; one that could go to several takes what others leave.
Status HexMesher::FacesOfCopies(const SolidSweep& sweep, const QuadSides& source,
  const std::map<int, int>& images, std::vector<int>& faceOfQuads) const
{
  faceOfQuads.assign(source.Quads.size(), sweep.Target.front());
  if (sweep.Target.size() == 1)
  {
    return {};
  }
  std::map<Side, std::set<int>> facesOfSides; ///< of the target
  for (const int face : sweep.Target)
  {
    for (const auto& loop : this->Model.Faces[At(face)].Loops)
    {
      for (const CADTopologyUse& use : loop)
      {
        for (int i = 0; use.Edge >= 0 && i < this->Nodes->Counts[At(use.Edge)]; ++i)
        {
          facesOfSides[QuadSides::SideOf(this->Nodes->NodeOf(this->Model, use.Edge, i),
                         this->Nodes->NodeOf(this->Model, use.Edge, i + 1))]
            .insert(face);
        }
      }
    }
  }
  const auto facesAt = [&](const Side& side) -> const std::set<int>*
  {
    const auto a = images.find(side.first);
    const auto b = images.find(side.second);
    if (a == images.end() || b == images.end())
    {
      return nullptr;
    }
    const auto found = facesOfSides.find(QuadSides::SideOf(a->second, b->second));
    return found == facesOfSides.end() ? nullptr : &found->second;
  };
  DisjointSets regions(static_cast<int>(source.Quads.size()));
  for (const auto& [side, quads] : source.Sides)
  {
    if (quads.size() == 2 && !facesAt(side))
    {
      regions.Unite(quads[0], quads[1]);
    }
  }
  std::map<int, std::set<int>> candidates;
  for (const auto& [side, quads] : source.Sides)
  {
    const std::set<int>* faces = facesAt(side);
    for (const int quad : quads)
    {
      if (faces)
      {
        auto [known, isNew] = candidates.try_emplace(regions.Find(quad), *faces);
        std::set<int> both;
        std::set_intersection(known->second.begin(), known->second.end(), faces->begin(),
          faces->end(), std::inserter(both, both.begin()));
        known->second = std::move(both);
      }
    }
  }
  std::map<int, int> faceOfRegions;
  while (faceOfRegions.size() < sweep.Target.size())
  {
    const auto sure = std::find_if(candidates.begin(), candidates.end(),
      [](const auto& entry) { return entry.second.size() == 1; });
    if (sure == candidates.end())
    {
      return { ErrorCode::InvalidTopology,
        SolidName(sweep.Body) +
          ": the faces of its source do not match those of its target; cut it "
          "(cadmodify)" };
    }
    const int face = *sure->second.begin();
    faceOfRegions[sure->first] = face;
    candidates.erase(sure);
    for (auto& [region, faces] : candidates)
    {
      faces.erase(face);
    }
  }
  for (std::size_t q = 0; q < faceOfQuads.size(); ++q)
  {
    faceOfQuads[q] = faceOfRegions[regions.Find(static_cast<int>(q))];
  }
  return {};
}

/// Quadrilaterals of the source on a face of the target.
/// @return points of the face's mesh by nodes of the source.
std::map<int, int> HexMesher::TakeCopy(int face, const QuadSides& source,
  const std::vector<int>& quads, const std::map<int, int>& images,
  const std::map<int, Vector3d>& places)
{
  const FaceChart& chart = this->Faces.Chart(face);
  std::vector<std::pair<Vector3d, Eigen::Vector2d>> guesses;
  std::map<int, Eigen::Vector2d> ofNodes;
  for (const ChartLoop& loop : ChartLoops(this->Model, chart, *this->Nodes))
  {
    for (const LoopPoint& point : loop)
    {
      guesses.emplace_back(chart.Point(point.Place), point.Place);
      ofNodes.emplace(point.Node, point.Place);
    }
  }
  Eigen::AlignedBox2d box;
  for (const auto& [point, place] : guesses)
  {
    box.extend(place);
  }
  constexpr int Guesses = 16; ///< a direction
  for (int i = 0; i < Guesses * Guesses; ++i)
  {
    const Eigen::Vector2d share((i % Guesses + 0.5) / Guesses, (i / Guesses + 0.5) / Guesses);
    const Eigen::Vector2d place = box.min() + share.cwiseProduct(box.sizes());
    guesses.emplace_back(chart.Point(place), place);
  }
  FaceQuads copy;
  std::map<int, int> numbers; ///< of nodes of the source
  for (const int quad : quads)
  {
    copy.Quads.emplace_back();
    for (std::size_t i = 0; i < 4; ++i)
    {
      const int node = source.Quads[At(quad)][i];
      const auto [number, isNew] = numbers.try_emplace(node, static_cast<int>(copy.Points.size()));
      copy.Quads.back()[i] = number->second;
      if (!isNew)
      {
        continue;
      }
      const auto image = images.find(node);
      Vector3d point = places.at(node);
      Eigen::Vector2d place = std::min_element(guesses.begin(), guesses.end(),
        [&](const auto& a, const auto& b) {
          return (a.first - point).squaredNorm() < (b.first - point).squaredNorm();
        })->second;
      if (image == images.end())
      {
        point = chart.Project(point, place);
      }
      else if (const auto known = ofNodes.find(image->second); known != ofNodes.end())
      {
        place = known->second;
      }
      copy.Places.push_back(place);
      copy.Points.push_back(point);
      copy.Nodes.push_back(image == images.end() ? -1 : image->second);
    }
  }
  const std::vector<Vector3d> normals = NormalsOf(chart, copy);
  double sum = 0.0;
  for (int q = 0; q < static_cast<int>(copy.Quads.size()); ++q)
  {
    sum += ScaledJacobian(copy, normals, q);
  }
  for (Quad& quad : copy.Quads)
  {
    if (sum < 0.0)
    {
      std::swap(quad[1], quad[3]);
    }
  }
  this->Faces.Take(face, std::move(copy));
  return numbers;
}

/// Gives the target the mesh of the source.
/// @param images  result: nodes of the target for those of the source.
Status HexMesher::Copy(const SolidSweep& sweep, const QuadSides& source,
  const std::map<int, std::vector<int>>& columns, std::map<int, int>& images)
{
  for (const auto& [node, column] : columns)
  {
    images[node] = column.back();
  }
  if (Status matched = this->MatchImprints(sweep, images); !matched)
  {
    return matched;
  }
  const SourceMesh from(source, this->Surface.Mesh.Points);
  LinkedSweepParams params;
  for (const auto& [node, image] : images)
  {
    params.Rim.push_back(from.Numbers.at(node));
    PointMatrix& column = params.Columns.emplace_back(2, 3);
    column.row(0) = this->Surface.Mesh.Points[At(node)].transpose();
    column.row(1) = this->Surface.Mesh.Points[At(image)].transpose();
  }
  const auto swept = SweepBetween(from.Mesh, from.Points, params);
  if (!swept)
  {
    return { swept.Status.Code, SolidName(sweep.Body) + ": " + swept.Status.Detail };
  }
  std::map<int, Vector3d> places;
  for (const auto& [node, number] : from.Numbers)
  {
    places[node] = swept->Points.row(from.Mesh.NumPoints + number).transpose();
  }
  std::vector<int> faceOfQuads;
  if (Status found = this->FacesOfCopies(sweep, source, images, faceOfQuads); !found)
  {
    return found;
  }
  for (const int face : sweep.Target)
  {
    std::vector<int> quads;
    for (std::size_t q = 0; q < faceOfQuads.size(); ++q)
    {
      if (faceOfQuads[q] == face)
      {
        quads.push_back(static_cast<int>(q));
      }
    }
    const std::map<int, int> pointOf = this->TakeCopy(face, source, quads, images, places);
    const std::vector<int> ids = this->AppendFace(face);
    for (const auto& [node, point] : pointOf)
    {
      images.try_emplace(node, ids[At(point)]);
    }
  }
  return {};
}

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

std::vector<int> HexMesher::AppendFace(int face)
{
  const auto first = static_cast<int>(this->Surface.Mesh.Quads.size());
  std::vector<int> ids = this->Faces.Append(face, this->Surface);
  for (int q = first; q < static_cast<int>(this->Surface.Mesh.Quads.size()); ++q)
  {
    this->QuadsOfFaces[At(face)].push_back(q);
  }
  return ids;
}

Status HexMesher::MeshFace(int face, FaceMethod method)
{
  constexpr double LeastGood = 0.05; ///< scaled Jacobian
  const Status& meshed = this->Faces.Mesh(face, *this->Nodes, method);
  if (meshed.Code == ErrorCode::TooLarge)
  {
    return { meshed.Code,
      FaceName(this->Model, face) + ": " + meshed.Detail +
        "; raise EdgeLength, Curvature or MaximumHexahedra" };
  }
  if (!meshed || this->Faces.Of(face).Least < LeastGood)
  {
    this->Poor.push_back(face);
  }
  if (!meshed)
  {
    return { ErrorCode::InvalidTopology,
      FaceName(this->Model, face) + " cannot be meshed: " + meshed.Detail +
        "; lower EdgeLength or Curvature, or split it (cadmodify)" };
  }
  this->AppendFace(face);
  return {};
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
      const auto meshed = static_cast<int>(std::count_if(faces->begin(), faces->end(),
        [&](int face) { return !this->QuadsOfFaces[At(face)].empty(); }));
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
    if (this->QuadsOfFaces[At(face)].empty())
    {
      const FaceMethod method = this->Faces.Kind(face) == LogicalShapeKind::Other
        ? FaceMethod::Paved
        : FaceMethod::GridIfGood;
      if (Status meshed = this->MeshFace(face, method); !meshed)
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
  solid.Source = this->QuadsOf(sweep.Body, sweep.Source);
  if (Status found = this->Columns(sweep, solid.Source, solid.Columns); !found)
  {
    return found;
  }
  const bool known = std::any_of(sweep.Target.begin(), sweep.Target.end(),
    [&](int face) { return !this->QuadsOfFaces[At(face)].empty(); });
  const Status ended = known ? this->Match(sweep, solid.Source, solid.Columns, solid.Images)
                             : this->Copy(sweep, solid.Source, solid.Columns, solid.Images);
  this->Solids.push_back(std::move(solid));
  return ended;
}

/// Linking faces first, then ends of sweeps, one from the other where they can.
Status HexMesher::MeshFaces()
{
  this->Surface = this->Faces.Begin(*this->Nodes);
  this->QuadsOfFaces.assign(this->Model.Faces.size(), {});
  this->Poor.clear();
  this->Solids.clear();
  for (int face = 0; face < static_cast<int>(this->Model.Faces.size()); ++face)
  {
    if (this->IsGrid[At(face)])
    {
      if (Status meshed = this->MeshFace(face, FaceMethod::Grid); !meshed)
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
      [&](const SolidSweep& sweep) { return this->IsMeshed(sweep.Source); });
    if (next == pending.end())
    {
      next = std::find_if(pending.begin(), pending.end(),
        [&](const SolidSweep& sweep) { return sweep.BothWays && this->IsMeshed(sweep.Target); });
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
      !this->Params.Faces.Progress(0.5 * (all - static_cast<double>(pending.size())) / all))
    {
      return { ErrorCode::Aborted, "meshing was stopped" };
    }
  }
  return {};
}

Status HexMesher::Fill(const SolidFaces& solid)
{
  const SolidSweep& sweep = solid.Sweep;
  const SourceMesh source(solid.Source, this->Surface.Mesh.Points);
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
      places.row(k) = this->Surface.Mesh.Points[At(column[At(k)])].transpose();
      nodes[At(k)][At(params.Rim.back())] = column[At(k)];
    }
  }
  params.Target.resize(source.Mesh.NumPoints, 3);
  for (const auto& [node, number] : source.Numbers)
  {
    nodes.front()[At(number)] = node;
    nodes.back()[At(number)] = solid.Images.at(node);
    params.Target.row(number) = this->Surface.Mesh.Points[At(solid.Images.at(node))].transpose();
  }
  const auto swept = SweepBetween(source.Mesh, source.Points, params);
  if (!swept)
  {
    return { swept.Status.Code, SolidName(sweep.Body) + ": " + swept.Status.Detail };
  }
  CADMesh& mesh = this->Surface.Mesh;
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
    quads[face] = this->QuadsOf(sweep.Body, { face });
  }
  CornerFill filling(this->Model, *sweep.Corners, *this->Nodes, quads, this->Surface.Mesh);
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
  const CADMesh& mesh = this->Surface.Mesh;
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
    if (this->Poor.empty() || round + 1 == Rounds || meshed.Code == ErrorCode::TooLarge ||
      meshed.Code == ErrorCode::Aborted)
    {
      if (!meshed)
      {
        return meshed;
      }
      break;
    }
    for (const int face : this->Poor)
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
      !this->Params.Faces.Progress(0.5 + 0.5 * done / static_cast<double>(this->Solids.size())))
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
  const auto padded =
    PadSmoothSurfaces(this->Model, this->Faces, *this->Nodes, this->Surface.Mesh, cells);
  if (!padded)
  {
    return padded.Status;
  }
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
    return BestOfWays(model, params);
  }
  catch (...)
  {
    return StatusOfException();
  }
}
}
