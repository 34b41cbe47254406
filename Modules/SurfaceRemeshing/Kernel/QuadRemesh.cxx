// SPDX-License-Identifier: BSD-3-Clause
#include "QuadRemesh.h"

#include "FarthestDistance.h"
#include "QuadQuality.h"
#include "SoupTopology.h"
#include "TriangleCollapse.h"
#include "TrianglePairs.h"

#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Numbers.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

namespace knotwork
{
namespace
{
constexpr double ShortestEdge = 2e-3; ///< of scaled triangles: QuadriFlow refuses shorter ones
constexpr double SizeOfScaled = 10.0; ///< diagonal of scaled triangles at least
constexpr double SizeFactors[] = { 1.0, 1.4, 0.7 };
constexpr int DivisionFactors[] = { 1, 2, 4, 8 };
constexpr int MostExhausted = 2;        ///< tries of a part that ran into limits of time or memory
constexpr double ToleranceShare = 2e-3; ///< of the diagonal: of distances
constexpr double LeastArea = 1e-9;      ///< of a quadrilateral, of the square of its longest edge
constexpr int FewestFaces = 8;
constexpr int FewestOfPart = 100; ///< of small parts beside larger ones: QuadriFlow refuses fewer
constexpr int MostFaces = 1000000;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

std::string Count(std::int64_t count, const std::string& one, const std::string& more)
{
  return std::to_string(count) + " " + (count == 1 ? one : more);
}

double DiagonalOf(const PointMatrix& points)
{
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

/// Points that are used, in their order.
PointMatrix UsedPoints(const PointMatrix& points, std::vector<MeshQuad>& quads)
{
  std::vector<int> numbers(At(static_cast<int>(points.rows())), -1);
  for (const MeshQuad& quad : quads)
  {
    for (const int corner : quad)
    {
      numbers[At(corner)] = 0;
    }
  }
  PointMatrix used(points.rows(), 3);
  int count = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    if (numbers[static_cast<std::size_t>(i)] == 0)
    {
      numbers[static_cast<std::size_t>(i)] = count;
      used.row(count++) = points.row(i);
    }
  }
  used.conservativeResize(count, 3);
  for (MeshQuad& quad : quads)
  {
    for (int& corner : quad)
    {
      corner = numbers[At(corner)];
    }
  }
  return used;
}

Result<MeshTopology<2>> TopologyOf(const std::vector<MeshQuad>& quads, Eigen::Index numPoints)
{
  CellMesh<2> mesh;
  mesh.NumPoints = static_cast<int>(numPoints);
  mesh.Corners.reserve(4 * quads.size());
  for (const auto& [a, b, c, d] : quads)
  {
    mesh.Corners.insert(mesh.Corners.end(), { a, b, d, c });
  }
  return MeshTopology<2>::Make(mesh);
}

/// Quadrilaterals of the largest of several parts: QuadriFlow leaves small balls beside the
/// surface.
/// @param others  number of these.
std::vector<MeshQuad> LargestPart(
  const std::vector<MeshQuad>& quads, Eigen::Index numPoints, int& others)
{
  DisjointSets sets(static_cast<int>(numPoints));
  for (const MeshQuad& quad : quads)
  {
    for (const int corner : quad)
    {
      sets.Unite(quad[0], corner);
    }
  }
  std::vector<std::size_t> sizes(static_cast<std::size_t>(numPoints), 0);
  for (const MeshQuad& quad : quads)
  {
    ++sizes[At(sets.Find(quad[0]))];
  }
  others = static_cast<int>(
    std::count_if(sizes.begin(), sizes.end(), [](std::size_t size) { return size > 0; }) - 1);
  const auto largest =
    static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<MeshQuad> kept;
  std::copy_if(quads.begin(), quads.end(), std::back_inserter(kept),
    [&](const MeshQuad& quad) { return sets.Find(quad[0]) == largest; });
  return kept;
}

/// One closed surface of the input.
class ClosedPart
{
public:
  ClosedPart(const DiscMesh& mesh, double diagonal)
    : Surface(mesh.Points, mesh.Triangles), Diagonal(diagonal), Area(mesh.Area),
      Volume(SignedVolume(mesh.Points, mesh.Triangles)), Euler(EulerNumber(mesh.Triangles))
  {
  }

  /// The triangles about the origin, as large as asked.
  TriangleMesh Scaled() const
  {
    return { (this->Surface.Points().rowwise() - this->Middle()) * this->Scale(),
      this->Surface.Triangles() };
  }
  /// Back from there.
  PointMatrix Unscaled(const PointMatrix& points) const
  {
    return (points / this->Scale()).rowwise() + this->Middle();
  }
  /// The triangles, collapsed to a third of so many faces, each divided into three quadrilaterals.
  Result<PolygonMesh> Divided(int faces) const;
  /// Why an answer does not hold; empty: it does, and is in Points and Quads.
  std::string Take(const PolygonMesh& answer, const QuadRemeshParams& params);

  TriangleIndex<3> Surface;
  double Diagonal;
  double Area;
  double Volume;
  int Euler;
  PointMatrix Points;
  std::vector<MeshQuad> Quads;
  bool IsDivided = false;
  int LooseParts = 0;
  int Extraordinary = 0;
  double JacobianBefore = 1.0;
  double FromInput = 0.0;
  double ToInput = 0.0;

private:
  Eigen::RowVector3d Middle() const
  {
    const PointMatrix& points = this->Surface.Points();
    return 0.5 * (points.colwise().maxCoeff() + points.colwise().minCoeff());
  }
  double Scale() const
  {
    double shortest = std::numeric_limits<double>::infinity();
    for (const MeshTriangle& corners : this->Surface.Triangles())
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        shortest = std::min(shortest,
          (this->Surface.Points().row(corners[k]) -
            this->Surface.Points().row(corners[(k + 1) % 3]))
            .norm());
      }
    }
    return std::max(SizeOfScaled / DiagonalOf(this->Surface.Points()), ShortestEdge / shortest);
  }
  double LeastJacobian() const
  {
    double least = 1.0;
    for (const MeshQuad& quad : this->Quads)
    {
      least = std::min(least, ScaledJacobian(this->Points, quad));
    }
    return least;
  }
  std::string TakeTopology(const std::vector<MeshQuad>& quads, Eigen::Index numPoints);
  std::string CheckShape(double limit);
};

/// Every triangle as three quadrilaterals around its middle, between the middles of its edges.
PolygonMesh DividedAtMiddles(const PointMatrix& points, const std::vector<MeshTriangle>& triangles)
{
  PolygonMesh divided;
  const Eigen::Index numPoints = points.rows();
  const auto numTriangles = static_cast<Eigen::Index>(triangles.size());
  divided.Points.resize(numPoints + 4 * numTriangles, 3); // at most
  divided.Points.topRows(numPoints) = points;
  auto count = static_cast<int>(numPoints);
  const auto add = [&](const Eigen::RowVector3d& place)
  {
    divided.Points.row(count) = place;
    return count++;
  };
  std::map<std::pair<int, int>, int> middles;
  for (const MeshTriangle& corners : triangles)
  {
    std::array<int, 3> between{};
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = corners[k];
      const int b = corners[(k + 1) % 3];
      const auto [found, added] = middles.try_emplace(std::minmax(a, b), count);
      if (added)
      {
        add(0.5 * (points.row(a) + points.row(b)));
      }
      between[k] = found->second;
      sum += points.row(a);
    }
    const int middle = add(sum / 3.0);
    for (std::size_t k = 0; k < 3; ++k)
    {
      divided.Faces.push_back({ corners[k], between[k], middle, between[(k + 2) % 3] });
    }
  }
  divided.Points.conservativeResize(count, 3);
  return divided;
}

Result<PolygonMesh> ClosedPart::Divided(int faces) const
{
  TriangleMesh mesh = this->Scaled();
  const std::size_t before = mesh.Triangles.size();
  const auto meet = [](const TriangleMesh& triangles)
  { return !FindIntersections(triangles.Points, triangles.Triangles, 1).empty(); };
  CollapseEdges(std::max(faces / 3, 4), mesh.Points, mesh.Triangles);
  if (mesh.Triangles.size() < before && meet(mesh) && !meet(this->Scaled()))
  {
    return { ErrorCode::NotConverged, "triangles meet that do not before edges are collapsed" };
  }
  return DividedAtMiddles(mesh.Points, mesh.Triangles);
}

/// Whether quadrilaterals are one closed surface like that of the triangles.
std::string ClosedPart::TakeTopology(const std::vector<MeshQuad>& quads, Eigen::Index numPoints)
{
  const auto topology = TopologyOf(quads, numPoints);
  if (!topology)
  {
    return topology.Status.Detail;
  }
  if (topology->NumBoundaryFacets > 0)
  {
    return Count(topology->NumBoundaryFacets, "edge is", "edges are") + " open";
  }
  if (!topology->IsOrientable)
  {
    return "it has one side only";
  }
  const auto euler =
    numPoints - topology->NumInteriorFacets + static_cast<Eigen::Index>(quads.size());
  if (euler != this->Euler)
  {
    return "its Euler number is " + std::to_string(euler) + " instead of " +
      std::to_string(this->Euler);
  }
  this->Extraordinary = static_cast<int>(topology->NumExtraordinaryRidges);
  return {};
}

/// Areas, orientation and distances of the points as they are; the distances are measured.
std::string ClosedPart::CheckShape(double limit)
{
  int withoutArea = 0;
  for (const MeshQuad& quad : this->Quads)
  {
    double longest = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
    {
      longest =
        std::max(longest, (this->Points.row(quad[k]) - this->Points.row(quad[(k + 1) % 4])).norm());
    }
    withoutArea +=
      DiagonalProduct(this->Points, quad).norm() > LeastArea * longest * longest ? 0 : 1;
  }
  if (withoutArea > 0)
  {
    return Count(withoutArea, "quadrilateral has", "quadrilaterals have") + " no area";
  }
  const std::vector<MeshTriangle> halves = HalvesOf(this->Points, this->Quads);
  if (!(SignedVolume(this->Points, halves) * this->Volume > 0.0))
  {
    return "it is inside out";
  }
  const double tolerance = ToleranceShare * this->Diagonal;
  this->FromInput = FarthestFrom(this->Surface, this->Points, halves, tolerance).Value;
  this->ToInput = FarthestFrom(TriangleIndex<3>(this->Points, halves), this->Surface.Points(),
    this->Surface.Triangles(), tolerance)
                    .Value;
  const double allowed = limit * this->Diagonal;
  const auto share = [&](double distance)
  { return Digits(distance / this->Diagonal, 3) + " of the diagonal from "; };
  return this->FromInput > allowed ? "it is " + share(this->FromInput) + "the input"
    : this->ToInput > allowed      ? "the input is " + share(this->ToInput) + "it"
                                   : "";
}

std::string ClosedPart::Take(const PolygonMesh& answer, const QuadRemeshParams& params)
{
  if (answer.Faces.empty())
  {
    return "no faces came back";
  }
  if (answer.Points.cols() != 3 || !AllWithinLimit(answer.Points))
  {
    return "points that are no finite numbers came back";
  }
  std::vector<MeshQuad> quads;
  for (const std::vector<int>& face : answer.Faces)
  {
    for (const int corner : face)
    {
      if (corner < 0 || corner >= answer.Points.rows())
      {
        return "a corner that is no point came back";
      }
    }
    if (face.size() == 4)
    {
      quads.push_back({ face[0], face[1], face[2], face[3] });
    }
  }
  if (quads.empty() && answer.Faces.size() == this->Surface.Triangles().size())
  {
    return "it was refused: the triangles came back as they are";
  }
  if (quads.size() < answer.Faces.size())
  {
    return Count(static_cast<std::int64_t>(answer.Faces.size() - quads.size()), "face is",
             "faces are") +
      " no quadrilateral";
  }
  this->Quads = LargestPart(quads, answer.Points.rows(), this->LooseParts);
  this->Points = UsedPoints(this->Unscaled(answer.Points), this->Quads);
  if (std::string refusal = this->TakeTopology(this->Quads, this->Points.rows()); !refusal.empty())
  {
    return refusal;
  }
  std::string refusal = this->CheckShape(params.Limit);
  this->JacobianBefore = this->LeastJacobian();
  const double before = std::max(this->FromInput, this->ToInput);
  PointMatrix kept = this->Points;
  if (SmoothQuads(this->Surface, this->Quads, params.Smoothing, this->Points))
  {
    const double fromInput = this->FromInput;
    const double toInput = this->ToInput;
    const std::string moved = this->CheckShape(params.Limit);
    const double after = std::max(this->FromInput, this->ToInput);
    if (moved.empty() && (!refusal.empty() || after <= before + ToleranceShare * this->Diagonal))
    {
      return {};
    }
    this->Points = kept;
    this->FromInput = fromInput;
    this->ToInput = toInput;
  }
  return refusal;
}

Status CheckParams(const QuadRemeshParams& params)
{
  if (params.Faces < FewestFaces || params.Faces > MostFaces)
  {
    return { ErrorCode::InvalidParameter,
      "between " + std::to_string(FewestFaces) + " and " + std::to_string(MostFaces) +
        " faces are made; " + std::to_string(params.Faces) + " were asked for" };
  }
  if (!(params.Limit > 0.0 && params.Limit <= 1.0))
  {
    return { ErrorCode::InvalidParameter,
      "Limit is a share of the diagonal, above 0 and at most 1; " + Digits(params.Limit) +
        " was given" };
  }
  if (params.Smoothing < 0 || params.Smoothing > 1000)
  {
    return { ErrorCode::InvalidParameter,
      "points move 0 to 1000 times; " + std::to_string(params.Smoothing) + " was given" };
  }
  return {};
}

/// All closed parts, or what is wrong with the first that is none.
Result<std::vector<ClosedPart>> ClosedParts(const TriangleMesh& mesh)
{
  if (mesh.Triangles.empty() || mesh.Points.rows() == 0)
  {
    return { ErrorCode::EmptyInput, "the mesh has no triangles" };
  }
  if (!AllWithinLimit(mesh.Points))
  {
    return { ErrorCode::NonFiniteInput,
      "a point is not finite, or " + BeyondLimit() + "; remove it and its triangles" };
  }
  std::vector<ClosedPart> parts;
  const double diagonal = DiagonalOf(mesh.Points);
  for (const MeshComponent& component : ConnectedComponents(mesh))
  {
    const auto part = CheckComponent(mesh, component);
    if (!part)
    {
      return { part.Status.Code, part.Status.Detail + "; repair the mesh first" };
    }
    if (!part->Loops.empty())
    {
      const Eigen::Vector3d place = part->Point(part->Loops.front().front());
      return { ErrorCode::InvalidTopology,
        Count(static_cast<std::int64_t>(part->Loops.size()), "hole", "holes") +
          ", the largest at " + PointText(place.data(), 3) + "; repair the mesh first" };
    }
    parts.emplace_back(part.Value, diagonal);
  }
  if (parts.empty())
  {
    return { ErrorCode::EmptyInput, "no triangle of the mesh has an area" };
  }
  return parts;
}

std::vector<QuadRequest> RequestsFor(double faces, bool keepSharp)
{
  std::vector<QuadRequest> requests;
  for (const double factor : SizeFactors)
  {
    const double asked = std::clamp(
      std::round(factor * faces), static_cast<double>(FewestFaces), static_cast<double>(MostFaces));
    if (keepSharp)
    {
      requests.push_back({ static_cast<int>(asked), true });
    }
    requests.push_back({ static_cast<int>(asked), false });
  }
  return requests;
}

/// Sizes in which triangles are divided, up to the first that needs no edge collapsed.
std::vector<QuadRequest> DivisionsFor(double faces, std::size_t numTriangles)
{
  std::vector<QuadRequest> requests;
  const auto most =
    std::min(3.0 * static_cast<double>(numTriangles), static_cast<double>(MostFaces));
  for (const int factor : DivisionFactors)
  {
    const double asked = std::round(factor * faces);
    requests.push_back({ static_cast<int>(std::min(asked, most)), false });
    if (asked >= most)
    {
      break;
    }
  }
  return requests;
}

std::string InWords(const QuadTry& tried)
{
  return std::to_string(tried.Request.Faces) + " faces" +
    (tried.OfTriangles            ? " of triangles: "
        : tried.Request.KeepSharp ? " with sharp edges: "
                                  : ": ") +
    tried.Refusal;
}

/// What is to be made, and what was tried, of one part.
class PartSearch
{
public:
  PartSearch(const QuadMaker& maker, const QuadRemeshParams& params, ClosedPart& part, int number)
    : Maker(maker), Params(params), Part(part), Number(number)
  {
  }
  /// Requests until an answer holds.
  Status Run(double faces, double done);

  std::vector<QuadTry> Tries;

private:
  /// @return failures that end the search; whether it is filled the last of Tries says.
  Status AskProgram(double faces, double done);
  Status DivideTriangles(double faces, double done);
  bool IsFilled() const { return !this->Tries.empty() && this->Tries.back().Refusal.empty(); }
  bool GoesOn(double done) const { return !this->Params.Progress || this->Params.Progress(done); }
  void Note(const QuadRequest& request, bool ofTriangles, const Result<PolygonMesh>& answer)
  {
    this->Tries.push_back({ this->Number, request, ofTriangles,
      answer ? this->Part.Take(answer.Value, this->Params) : answer.Status.Detail });
  }

  const QuadMaker& Maker;
  const QuadRemeshParams& Params;
  ClosedPart& Part;
  int Number;
};

Status PartSearch::AskProgram(double faces, double done)
{
  const TriangleMesh scaled = this->Part.Scaled();
  int exhausted = 0;
  for (const QuadRequest& request : RequestsFor(faces, this->Params.KeepSharp))
  {
    if (!this->GoesOn(done))
    {
      return { ErrorCode::Aborted, "" };
    }
    const auto answer = this->Maker(scaled, request);
    const bool tooLarge = answer.Status.Code == ErrorCode::TooLarge;
    if (!answer && !tooLarge && answer.Status.Code != ErrorCode::NotConverged)
    {
      return answer.Status;
    }
    exhausted += tooLarge ? 1 : 0;
    this->Note(request, false, answer);
    if (this->IsFilled() || exhausted >= MostExhausted)
    {
      break;
    }
  }
  return {};
}

Status PartSearch::DivideTriangles(double faces, double done)
{
  for (const QuadRequest& request : DivisionsFor(faces, this->Part.Surface.Triangles().size()))
  {
    if (!this->GoesOn(done))
    {
      return { ErrorCode::Aborted, "" };
    }
    this->Note(request, true, this->Part.Divided(request.Faces));
    if (this->IsFilled())
    {
      this->Part.IsDivided = true;
      break;
    }
  }
  return {};
}

Status PartSearch::Run(double faces, double done)
{
  Status ended;
  if (this->Params.Way != QuadWay::Triangles)
  {
    ended = this->AskProgram(faces, done);
  }
  if (ended && !this->IsFilled() && this->Params.Way != QuadWay::Program)
  {
    ended = this->DivideTriangles(faces, done);
  }
  if (!ended || this->IsFilled())
  {
    return ended;
  }
  std::string refusals;
  for (const QuadTry& tried : this->Tries)
  {
    refusals += (refusals.empty() ? "" : "; ") + InWords(tried);
  }
  const Eigen::RowVector3d place = this->Part.Surface.Points().row(0);
  return { ErrorCode::NotConverged,
    "none of " + Count(static_cast<std::int64_t>(this->Tries.size()), "try", "tries") +
      " gave quadrilaterals that hold on the part at " + PointText(place.data(), 3) + " (" +
      refusals + "); ask for another number of faces, raise Limit, or repair the mesh" };
}
}

Result<QuadRemesh> RemeshToQuads(
  const TriangleMesh& mesh, const QuadMaker& maker, const QuadRemeshParams& params)
{
  if (Status valid = CheckParams(params); !valid)
  {
    return valid;
  }
  auto parts = ClosedParts(mesh);
  if (!parts)
  {
    return parts.Status;
  }
  double area = 0.0;
  for (const ClosedPart& part : parts.Value)
  {
    area += part.Area;
  }
  QuadRemesh made;
  made.Parts = static_cast<int>(parts->size());
  made.Diagonal = DiagonalOf(mesh.Points);
  Eigen::Index numPoints = 0;
  const double fewest = std::min(params.Faces, FewestOfPart);
  double done = 0.0;
  for (int number = 0; number < made.Parts; ++number)
  {
    ClosedPart& part = parts.Value[At(number)];
    const double share = part.Area / area;
    PartSearch search(maker, params, part, number);
    if (Status filled = search.Run(std::max(share * params.Faces, fewest), 0.95 * done); !filled)
    {
      return filled;
    }
    made.Tries.insert(made.Tries.end(), search.Tries.begin(), search.Tries.end());
    made.DividedParts += part.IsDivided ? 1 : 0;
    done += share;
    numPoints += part.Points.rows();
    made.LooseParts += part.LooseParts;
    made.EulerNumber += part.Euler;
    made.ExtraordinaryPoints += part.Extraordinary;
    made.LeastScaledJacobianBefore = std::min(made.LeastScaledJacobianBefore, part.JacobianBefore);
    made.DistanceFromInput = std::max(made.DistanceFromInput, part.FromInput);
    made.DistanceToInput = std::max(made.DistanceToInput, part.ToInput);
    made.InputVolume += part.Volume;
    made.Volume += SignedVolume(part.Points, HalvesOf(part.Points, part.Quads));
  }
  made.Points.resize(numPoints, 3);
  int first = 0;
  for (int number = 0; number < made.Parts; ++number)
  {
    const ClosedPart& part = parts.Value[At(number)];
    made.Points.middleRows(first, part.Points.rows()) = part.Points;
    for (const auto& [a, b, c, d] : part.Quads)
    {
      made.Quads.push_back({ first + a, first + b, first + c, first + d });
      made.PartIds.push_back(number);
      made.ScaledJacobians.push_back(ScaledJacobian(made.Points, made.Quads.back()));
    }
    first += static_cast<int>(part.Points.rows());
  }
  made.LeastScaledJacobian =
    *std::min_element(made.ScaledJacobians.begin(), made.ScaledJacobians.end());
  return made;
}
}
