// SPDX-License-Identifier: BSD-3-Clause
#include "SolidFaceMesh.h"

#include "RimMap.h"
#include "Sweep.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <tuple>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}
}

std::string SolidName(int body)
{
  return "solid " + std::to_string(body);
}

SourceMesh::SourceMesh(const QuadSides& quads, const std::vector<Vector3d>& points)
{
  for (const QuadSides::Quad& quad : quads.Quads)
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

void SolidFaceMesh::Begin(const EdgeNodes& nodes)
{
  this->Nodes = &nodes;
  this->Surface = this->Faces.Begin(nodes);
  this->QuadsOfFaces.assign(this->Model.Faces.size(), {});
  this->PoorFaces.clear();
}

bool SolidFaceMesh::IsMeshed(const std::vector<int>& faces) const
{
  return std::all_of(
    faces.begin(), faces.end(), [&](int face) { return !this->QuadsOfFaces[At(face)].empty(); });
}

QuadSides SolidFaceMesh::QuadsOf(int body, const std::vector<int>& faces) const
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

Status SolidFaceMesh::FindColumns(
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

Status SolidFaceMesh::Match(const SolidSweep& sweep, const QuadSides& source,
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
Status SolidFaceMesh::MatchImprints(const SolidSweep& sweep, std::map<int, int>& images) const
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
Status SolidFaceMesh::FacesOfCopies(const SolidSweep& sweep, const QuadSides& source,
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
std::map<int, int> SolidFaceMesh::TakeCopy(int face, const QuadSides& source,
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

Status SolidFaceMesh::Copy(const SolidSweep& sweep, const QuadSides& source,
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

std::vector<int> SolidFaceMesh::AppendFace(int face)
{
  const auto first = static_cast<int>(this->Surface.Mesh.Quads.size());
  std::vector<int> ids = this->Faces.Append(face, this->Surface);
  for (int q = first; q < static_cast<int>(this->Surface.Mesh.Quads.size()); ++q)
  {
    this->QuadsOfFaces[At(face)].push_back(q);
  }
  return ids;
}

Status SolidFaceMesh::MeshFace(int face, FaceMethod method)
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
    this->PoorFaces.push_back(face);
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
}
