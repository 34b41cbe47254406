// SPDX-License-Identifier: BSD-3-Clause
#include "ModelTarget.h"

#include "SharpChains.h"

#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/MultiPatch.h>
#include <knotwork/SplineCore/TrimmedRegion.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double SewTolerance = 1e-6; ///< of the model's size
constexpr int SamplesOfElement = 16;  ///< a curve's points for tracing
constexpr int SideSamplesOfFaces = 9;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Where an edge runs on a face: along a pcurve, or along a side.
struct EdgeUse
{
  int Face = 0;
  PointMatrix Parameters; ///< at equal shares of the edge's domain
};

struct ModelEdge
{
  Spline<1> Curve;
  std::vector<EdgeUse> Uses;
};

/// Parameters of equal shares of a domain, ends included.
PointMatrix EqualShares(const ParametricBox<1>& domain, int count)
{
  PointMatrix shares(count, 1);
  for (int i = 0; i < count; ++i)
  {
    const double t = static_cast<double>(i) / (count - 1);
    shares(i, 0) = (1.0 - t) * domain.Lower[0] + t * domain.Upper[0];
  }
  return shares;
}

PointMatrix ValuesAt(const Spline<1>& curve, int count)
{
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  const auto shares = EqualShares(curve.Space->Domain(), count);
  return EvaluateParameters<1>(MakeBezierForm(curve, 1), shares, params, batch) ? batch.Values
                                                                                : PointMatrix();
}

/// Edges of faces with loops by their numbers, then sides of faces without.
class EdgeList
{
public:
  Status Add(const TrimmedModel& model, double tolerance)
  {
    std::vector<int> edgeOf(At(model.NumEdges), -1);
    std::vector<Spline<2>> whole;
    std::vector<int> faceOf;
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      const TrimmedFace& face = model.Faces[f];
      for (const TrimmedLoop& loop : face.Loops)
      {
        for (const TrimmingCurve& curve : loop.Curves)
        {
          this->AddUse(curve, static_cast<int>(f), tolerance, edgeOf[At(curve.Edge)]);
        }
      }
      if (face.Loops.empty())
      {
        whole.push_back(face.Surface);
        faceOf.push_back(static_cast<int>(f));
      }
    }
    return whole.empty() ? Status() : this->AddSides(model, whole, faceOf, tolerance);
  }

  std::vector<ModelEdge> Edges;

private:
  void AddUse(const TrimmingCurve& curve, int face, double tolerance, int& edge)
  {
    const PointMatrix points = ValuesAt(curve.Curve, SideSamplesOfFaces);
    if ((points.rowwise() - points.row(0)).rowwise().norm().maxCoeff() <= tolerance)
    {
      return; // at a pole
    }
    if (edge < 0)
    {
      edge = static_cast<int>(this->Edges.size());
      this->Edges.push_back({ curve.Curve, {} });
    }
    this->Edges[At(edge)].Uses.push_back(
      { face, ValuesAt(curve.ParameterCurve(), SideSamplesOfFaces) });
  }

  Status AddSides(const TrimmedModel& model, const std::vector<Spline<2>>& whole,
    const std::vector<int>& faceOf, double tolerance)
  {
    const auto bodyOf = [&](const PatchSide& side)
    { return model.Faces[At(faceOf[At(side.Patch)])].Body; };
    const auto sides = SampleSides<2>(whole, SideSamplesOfFaces, 1);
    if (!sides)
    {
      return sides.Status;
    }
    std::vector<int> edgeOf(4 * whole.size(), -1);
    const auto parameters = [&](const PatchSide& side, bool reversed)
    {
      const ParametricBox<2> domain = whole[At(side.Patch)].Space->Domain();
      const std::size_t along = 1 - AcrossSide(side.Side);
      PointMatrix uv(SideSamplesOfFaces, 2);
      for (int i = 0; i < SideSamplesOfFaces; ++i)
      {
        const double share = static_cast<double>(i) / (SideSamplesOfFaces - 1);
        const double t = reversed ? 1.0 - share : share;
        uv(i, static_cast<Eigen::Index>(along)) =
          (1.0 - t) * domain.Lower[along] + t * domain.Upper[along];
        uv(i, static_cast<Eigen::Index>(1 - along)) = SideValue(domain, side.Side);
      }
      return uv;
    };
    for (const SideSamples& side : sides.Value)
    {
      if (IsCollapsed(side, tolerance))
      {
        continue;
      }
      auto curve = SideSpline(whole[At(side.Side.Patch)], side.Side.Side);
      if (!curve)
      {
        return curve.Status;
      }
      edgeOf[At(4 * side.Side.Patch + side.Side.Side)] = static_cast<int>(this->Edges.size());
      this->Edges.push_back({ std::move(curve.Value), {} });
      this->Edges.back().Uses.push_back(
        { faceOf[At(side.Side.Patch)], parameters(side.Side, false) });
    }
    std::vector<char> isGone(this->Edges.size(), 0);
    for (const PatchInterface& interface : FindInterfaces(sides.Value, tolerance))
    {
      const int first = edgeOf[At(4 * interface.Sides[0].Patch + interface.Sides[0].Side)];
      const int second = edgeOf[At(4 * interface.Sides[1].Patch + interface.Sides[1].Side)];
      if (first >= 0 && second >= 0 && first != second && isGone[At(second)] == 0 &&
        bodyOf(interface.Sides[0]) == bodyOf(interface.Sides[1]))
      {
        this->Edges[At(first)].Uses.push_back({ faceOf[At(interface.Sides[1].Patch)],
          parameters(interface.Sides[1], interface.Orientation.Reversed[0]) });
        isGone[At(second)] = 1;
      }
    }
    std::vector<ModelEdge> kept;
    for (std::size_t i = 0; i < this->Edges.size(); ++i)
    {
      if (isGone[i] == 0)
      {
        kept.push_back(std::move(this->Edges[i]));
      }
    }
    this->Edges = std::move(kept);
    return {};
  }
};

/// Closest points of curves and vertices.
class CurveParts : public FitTarget
{
protected:
  Status MakeCurves(const std::vector<Spline<1>>& edges, const std::vector<int>& bodies,
    double tolerance, double cornerAngle)
  {
    std::vector<PointMatrix> lines;
    for (const Spline<1>& edge : edges)
    {
      lines.push_back(ValuesAt(edge, SamplesOfElement * edge.Space->NumElements() + 1));
    }
    SharpChains chains = JoinChains(lines, bodies, tolerance, cornerAngle);
    this->CurveList = std::move(chains.Curves);
    this->VertexList = std::move(chains.Vertices);
    this->VertexBodies = std::move(chains.VertexBodies);
    for (const std::vector<int>& members : chains.Members)
    {
      std::vector<BezierForm<1>> forms;
      for (const int edge : members)
      {
        forms.push_back(MakeBezierForm(edges[At(edge)], 1));
      }
      ClosestPointParams params;
      params.Threads = 1;
      auto search = ClosestPointSearch<1>::Create(std::move(forms), params);
      if (!search)
      {
        return search.Status;
      }
      this->Searches.push_back(std::move(search.Value));
    }
    return {};
  }

  Status FindOnCurves(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const
  {
    result.Normals.setZero(queries.rows(), 3);
    result.Faces.assign(static_cast<std::size_t>(queries.rows()), -1);
    if (part.Entity == TargetEntity::Vertex)
    {
      result.Points = this->VertexList.row(part.Id).replicate(queries.rows(), 1);
      return {};
    }
    ClosestPoints feet;
    Status status = this->Searches[At(part.Id)].Find(queries, feet);
    result.Points = std::move(feet.Points);
    return status;
  }

private:
  std::vector<ClosestPointSearch<1>> Searches;
};

/// A face of the model.
class FaceSearch
{
public:
  static Result<FaceSearch> Make(const TrimmedFace& face)
  {
    FaceSearch search;
    search.Form = MakeBezierForm(face.Surface, 1);
    search.Reversed = face.Reversed;
    auto region = TrimmedRegion::Create(face.Loops);
    if (!region)
    {
      return region.Status;
    }
    search.Region = std::move(region.Value);
    ClosestPointParams params;
    params.Threads = 1;
    auto surface = ClosestPointSearch<2>::Create({ search.Form }, params);
    if (!surface)
    {
      return surface.Status;
    }
    search.Surface = std::move(surface.Value);
    std::vector<BezierForm<1>> edges;
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& curve : loop.Curves)
      {
        edges.push_back(MakeBezierForm(curve.Curve, 1));
        search.Pcurves.push_back(MakeBezierForm(curve.ParameterCurve(), 1));
      }
    }
    search.HasEdges = !edges.empty();
    if (search.HasEdges)
    {
      auto rim = ClosestPointSearch<1>::Create(std::move(edges), params);
      if (!rim)
      {
        return rim.Status;
      }
      search.Rim = std::move(rim.Value);
    }
    search.SetBox();
    return search;
  }

  double SquaredBoxDistance(const Eigen::RowVector3d& point) const
  {
    return (this->Lower - point).cwiseMax(point - this->Upper).cwiseMax(0.0).squaredNorm();
  }

  Status Find(const PointMatrixView& queries, PointMatrix& points, PointMatrix& normals) const
  {
    ClosestPoints feet;
    if (Status status = this->Surface.Find(queries, feet); !status)
    {
      return status;
    }
    points = feet.Points;
    PointMatrix parameters(queries.rows(), 2);
    std::vector<Eigen::Index> outside;
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      const auto& box =
        this->Form.Space->Elements[At(feet.Elements[static_cast<std::size_t>(i)])].Box;
      for (Eigen::Index d = 0; d < 2; ++d)
      {
        const auto k = static_cast<std::size_t>(d);
        parameters(i, d) = box.Lower[k] + feet.Local(i, d) * (box.Upper[k] - box.Lower[k]);
      }
      if (this->HasEdges && this->Contains(parameters.row(i)) == RegionPlace::Outside)
      {
        outside.push_back(i);
      }
    }
    if (!outside.empty())
    {
      if (Status status = this->MoveToRim(queries, outside, points, parameters); !status)
      {
        return status;
      }
    }
    normals = this->NormalsAt(parameters);
    return {};
  }

  /// Unit normals, zero where there is none.
  PointMatrix NormalsAt(const PointMatrix& parameters) const
  {
    EvaluationParams params;
    params.Derivatives = 1;
    params.Threads = 1;
    EvaluationBatch batch;
    PointMatrix normals = PointMatrix::Zero(parameters.rows(), 3);
    EvaluateParameters<2>(this->Form, parameters, params, batch);
    for (Eigen::Index i = 0; i < parameters.rows(); ++i)
    {
      const Eigen::RowVector3d u = batch.First.row(i).head<3>();
      const Eigen::RowVector3d v = batch.First.row(i).tail<3>();
      const Eigen::RowVector3d normal = u.cross(v);
      if (normal.norm() > 1e-12 * u.norm() * v.norm() && normal.allFinite())
      {
        normals.row(i) = normal.normalized() * (this->Reversed ? -1.0 : 1.0);
      }
    }
    return normals;
  }

  /// Middles of n x n parts of every element inside of the loops, with their areas.
  void AddSamples(int n, int number, std::vector<Eigen::RowVector3d>& points,
    std::vector<double>& areas, std::vector<int>& faces) const
  {
    EvaluationParams params;
    params.Derivatives = 1;
    params.Threads = 1;
    EvaluationBatch batch;
    for (const auto& element : this->Form.Space->Elements)
    {
      std::vector<RealArray<2>> inside;
      const double step[] = { (element.Box.Upper[0] - element.Box.Lower[0]) / n,
        (element.Box.Upper[1] - element.Box.Lower[1]) / n };
      for (int k = 0; k < n * n; ++k)
      {
        const RealArray<2> at{ element.Box.Lower[0] + (k % n + 0.5) * step[0],
          element.Box.Lower[1] + (k / n + 0.5) * step[1] };
        if (this->Region.IsWholePlane() || this->Region.Contains(at) != RegionPlace::Outside)
        {
          inside.push_back(at);
        }
      }
      PointMatrix parameters(static_cast<Eigen::Index>(inside.size()), 2);
      for (std::size_t i = 0; i < inside.size(); ++i)
      {
        parameters.row(static_cast<Eigen::Index>(i)) << inside[i][0], inside[i][1];
      }
      EvaluateParameters<2>(this->Form, parameters, params, batch);
      for (Eigen::Index i = 0; i < parameters.rows(); ++i)
      {
        const Eigen::RowVector3d u = batch.First.row(i).head<3>();
        const Eigen::RowVector3d v = batch.First.row(i).tail<3>();
        points.emplace_back(batch.Values.row(i));
        areas.push_back(u.cross(v).norm() * step[0] * step[1]);
        faces.push_back(number);
      }
    }
  }
  int NumElements() const { return this->Form.Space->NumElements(); }

private:
  RegionPlace Contains(const Eigen::RowVector2d& at) const
  {
    return this->Region.Contains({ at[0], at[1] });
  }

  Status MoveToRim(const PointMatrixView& queries, const std::vector<Eigen::Index>& outside,
    PointMatrix& points, PointMatrix& parameters) const
  {
    PointMatrix own(static_cast<Eigen::Index>(outside.size()), 3);
    for (std::size_t i = 0; i < outside.size(); ++i)
    {
      own.row(static_cast<Eigen::Index>(i)) = queries.row(outside[i]);
    }
    ClosestPoints feet;
    if (Status status = this->Rim.Find(own, feet); !status)
    {
      return status;
    }
    EvaluationParams params;
    params.Threads = 1;
    EvaluationBatch batch;
    const ParametricBox<2> domain = this->Form.Space->Domain();
    for (std::size_t i = 0; i < outside.size(); ++i)
    {
      const auto row = static_cast<Eigen::Index>(i);
      points.row(outside[i]) = feet.Points.row(row);
      EvaluateElements<1>(this->Pcurves[At(feet.Patches[i])], { feet.Elements[i] },
        feet.Local.row(row), params, batch);
      for (Eigen::Index d = 0; d < 2; ++d)
      {
        const auto k = static_cast<std::size_t>(d);
        parameters(outside[i], d) =
          std::clamp(batch.Values(0, d), domain.Lower[k], domain.Upper[k]);
      }
    }
    return {};
  }

  /// Of the Bernstein points, which have the surface in their hull.
  void SetBox()
  {
    this->Lower.setConstant(std::numeric_limits<double>::infinity());
    this->Upper = -this->Lower;
    for (int e = 0; e < this->NumElements(); ++e)
    {
      const double* block = this->Form.Block(e);
      const int count = NumTensorFunctions<2>(this->Form.Space->Elements[At(e)].Degree);
      for (int i = 0; i < count; ++i)
      {
        const double weight = this->Form.Rational ? block[3 * count + i] : 1.0;
        const Eigen::RowVector3d point(
          block[i] / weight, block[count + i] / weight, block[2 * count + i] / weight);
        this->Lower = this->Lower.cwiseMin(point);
        this->Upper = this->Upper.cwiseMax(point);
      }
    }
  }

  BezierForm<2> Form;
  bool Reversed = false;
  bool HasEdges = false;
  TrimmedRegion Region;
  ClosestPointSearch<2> Surface;
  ClosestPointSearch<1> Rim;
  std::vector<BezierForm<1>> Pcurves; ///< of the curves that Rim searches
  Eigen::RowVector3d Lower;
  Eigen::RowVector3d Upper;
};

class ModelTarget final : public CurveParts
{
public:
  Status Make(const TrimmedModel& model, const ModelTargetParams& params)
  {
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      auto face = FaceSearch::Make(model.Faces[f]);
      if (!face)
      {
        face.Status.Detail += " (face " + std::to_string(f) + ")";
        return face.Status;
      }
      this->Faces.push_back(std::move(face.Value));
    }
    const double tolerance = SewTolerance * SizeOf(model);
    EdgeList edges;
    if (Status status = edges.Add(model, tolerance); !status)
    {
      return status;
    }
    const std::vector<int> bodyOf = this->ClosedBodies(edges);
    std::vector<Spline<1>> sharp;
    std::vector<int> bodies; // of these
    DisjointSets smooth(static_cast<int>(model.Faces.size()));
    for (std::size_t i = 0; i < params.Groups.size(); ++i)
    {
      const auto first = std::find(params.Groups.begin(), params.Groups.end(), params.Groups[i]);
      if (params.Groups[i] >= 0)
      {
        smooth.Unite(static_cast<int>(first - params.Groups.begin()), static_cast<int>(i));
      }
    }
    this->Closed = true;
    for (const ModelEdge& edge : edges.Edges)
    {
      this->Closed = this->Closed && edge.Uses.size() > 1;
      if (edge.Uses.size() == 2 && this->Angle(edge) < params.SharpAngle)
      {
        smooth.Unite(edge.Uses[0].Face, edge.Uses[1].Face);
      }
    }
    for (ModelEdge& edge : edges.Edges)
    {
      // a sharp edge inside of a group is none
      const bool isInside = edge.Uses.size() == 2 &&
        smooth.Find(edge.Uses[0].Face) == smooth.Find(edge.Uses[1].Face) &&
        (this->Angle(edge) < params.SharpAngle || this->IsGrouped(edge, params.Groups));
      if (!isInside)
      {
        sharp.push_back(std::move(edge.Curve));
        bodies.push_back(bodyOf[At(edge.Uses.front().Face)]);
      }
    }
    this->NumberRegions(smooth);
    this->FaceBodies.assign(At(this->FaceCount), 0);
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      this->FaceBodies[At(this->RegionOf[f])] = bodyOf[f];
    }
    return this->MakeCurves(sharp, bodies, tolerance, params.CornerAngle);
  }

  Status Find(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const override
  {
    if (part.Entity == TargetEntity::Curve || part.Entity == TargetEntity::Vertex)
    {
      return this->FindOnCurves(part, queries, result);
    }
    const Eigen::Index n = queries.rows();
    result.Points.resize(n, 3);
    result.Normals.setZero(n, 3);
    result.Faces.assign(static_cast<std::size_t>(n), -1);
    if (n == 0)
    {
      return {};
    }
    // faces by their distances from the middle of the queries; those that are too far for a query
    // are not asked
    const Eigen::RowVector3d middle = queries.colwise().mean();
    std::vector<std::pair<double, int>> order;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      if (part.Entity == TargetEntity::Surface || this->RegionOf[f] == part.Id)
      {
        order.emplace_back(this->Faces[f].SquaredBoxDistance(middle), static_cast<int>(f));
      }
    }
    std::sort(order.begin(), order.end());
    Eigen::VectorXd best = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
    PointMatrix points;
    PointMatrix normals;
    for (const auto& [distance, f] : order)
    {
      const FaceSearch& face = this->Faces[At(f)];
      std::vector<Eigen::Index> rows;
      for (Eigen::Index i = 0; i < n; ++i)
      {
        if (face.SquaredBoxDistance(queries.row(i)) < best[i])
        {
          rows.push_back(i);
        }
      }
      if (rows.empty())
      {
        continue;
      }
      PointMatrix own(static_cast<Eigen::Index>(rows.size()), 3);
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        own.row(static_cast<Eigen::Index>(i)) = queries.row(rows[i]);
      }
      if (Status status = face.Find(own, points, normals); !status)
      {
        return status;
      }
      for (std::size_t i = 0; i < rows.size(); ++i)
      {
        const auto row = static_cast<Eigen::Index>(i);
        const double square = (points.row(row) - own.row(row)).squaredNorm();
        if (square < best[rows[i]])
        {
          best[rows[i]] = square;
          result.Points.row(rows[i]) = points.row(row);
          result.Normals.row(rows[i]) = normals.row(row);
          result.Faces[static_cast<std::size_t>(rows[i])] = this->RegionOf[At(f)];
        }
      }
    }
    return {};
  }

  TargetSamples Samples(int atLeast) const override
  {
    std::int64_t elements = 0;
    for (const FaceSearch& face : this->Faces)
    {
      elements += face.NumElements();
    }
    const double share = static_cast<double>(atLeast) / static_cast<double>(elements);
    const int n = std::clamp(static_cast<int>(std::ceil(std::sqrt(share))), 4, 1000);
    std::vector<Eigen::RowVector3d> points;
    std::vector<double> areas;
    TargetSamples samples;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      this->Faces[f].AddSamples(n, this->RegionOf[f], points, areas, samples.Faces);
    }
    samples.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      samples.Points.row(static_cast<Eigen::Index>(i)) = points[i];
    }
    samples.Areas = Eigen::Map<Eigen::VectorXd>(areas.data(), samples.Points.rows());
    return samples;
  }

private:
  /// Mean angle in degrees between the normals of an edge's two uses, but for its ends.
  double Angle(const ModelEdge& edge) const
  {
    const PointMatrix a = this->Faces[At(edge.Uses[0].Face)].NormalsAt(edge.Uses[0].Parameters);
    const PointMatrix b = this->Faces[At(edge.Uses[1].Face)].NormalsAt(edge.Uses[1].Parameters);
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index i = 1; i + 1 < a.rows(); ++i)
    {
      if (!a.row(i).isZero() && !b.row(i).isZero())
      {
        const Eigen::RowVector3d u = a.row(i);
        const Eigen::RowVector3d v = b.row(i);
        sum += std::atan2(u.cross(v).norm(), u.dot(v));
        ++count;
      }
    }
    return count > 0 ? sum / count * 180.0 / static_cast<double>(EIGEN_PI) : 0.0;
  }
  static bool IsGrouped(const ModelEdge& edge, const std::vector<int>& groups)
  {
    return !groups.empty() && groups[At(edge.Uses[0].Face)] >= 0 &&
      groups[At(edge.Uses[0].Face)] == groups[At(edge.Uses[1].Face)];
  }
  /// Faces that hang together by edges and enclose a body: its number, from 1 on; 0: others.
  std::vector<int> ClosedBodies(const EdgeList& edges) const
  {
    DisjointSets sets(static_cast<int>(this->Faces.size()));
    for (const ModelEdge& edge : edges.Edges)
    {
      for (const auto& use : edge.Uses)
      {
        sets.Unite(use.Face, edge.Uses.front().Face);
      }
    }
    std::vector<char> isOpen(this->Faces.size(), 0);
    for (const ModelEdge& edge : edges.Edges)
    {
      if (edge.Uses.size() < 2)
      {
        isOpen[At(sets.Find(edge.Uses.front().Face))] = 1;
      }
    }
    std::vector<int> numbers(this->Faces.size(), 0);
    std::vector<int> bodies;
    int count = 0;
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      const std::size_t root = At(sets.Find(static_cast<int>(f)));
      if (isOpen[root] == 0 && numbers[root] == 0)
      {
        numbers[root] = ++count;
      }
      bodies.push_back(numbers[root]);
    }
    return bodies;
  }
  void NumberRegions(const DisjointSets& smooth)
  {
    std::vector<int> number(this->Faces.size(), -1);
    for (std::size_t f = 0; f < this->Faces.size(); ++f)
    {
      int& of = number[At(smooth.Find(static_cast<int>(f)))];
      of = of < 0 ? this->FaceCount++ : of;
      this->RegionOf.push_back(of);
    }
  }

  std::vector<FaceSearch> Faces;
  std::vector<int> RegionOf; ///< of every face of the model
};

class CurveTarget final : public CurveParts
{
public:
  Status Make(const std::vector<Spline<1>>& curves, double tolerance, double cornerAngle)
  {
    return this->MakeCurves(curves, std::vector<int>(curves.size(), 0), tolerance, cornerAngle);
  }
  Status Find(
    const TargetPart& part, const PointMatrixView& queries, TargetPoints& result) const override
  {
    return this->FindOnCurves(part, queries, result);
  }
  TargetSamples Samples(int) const override { return {}; }
};
}

Result<FitTargetPtr> MakeModelTarget(const TrimmedModel& model, const ModelTargetParams& params)
{
  if (model.Faces.empty())
  {
    return { ErrorCode::EmptyInput, "the target has no faces" };
  }
  if (Status status = model.Check(); !status)
  {
    return status;
  }
  if (!(params.SharpAngle > 0.0 && params.SharpAngle < 180.0) ||
    !(params.CornerAngle > 0.0 && params.CornerAngle <= 180.0))
  {
    return { ErrorCode::InvalidParameter,
      "the sharp angle must be in (0, 180) degrees, the corner angle in (0, 180]" };
  }
  if (!params.Groups.empty() && params.Groups.size() != model.Faces.size())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(params.Groups.size()) + " groups for " + std::to_string(model.Faces.size()) +
        " faces" };
  }
  auto target = std::make_shared<ModelTarget>();
  const Status status = target->Make(model, params);
  return status ? Result<FitTargetPtr>(FitTargetPtr(target)) : Result<FitTargetPtr>(status);
}

Result<FitTargetPtr> MakeCurveTarget(const std::vector<Spline<1>>& curves, double cornerAngle)
{
  if (curves.empty())
  {
    return { ErrorCode::EmptyInput, "the target has no curves" };
  }
  double size = 0.0;
  for (const Spline<1>& curve : curves)
  {
    if (Status status = curve.Check(); !status)
    {
      return status;
    }
    if (curve.NumComponents() != 3 || !curve.Space->HasDomain())
    {
      return { ErrorCode::SizeMismatch, "a curve of a target has a domain and 3 coordinates" };
    }
    size = std::max(size,
      (curve.ControlPoints.colwise().maxCoeff() - curve.ControlPoints.colwise().minCoeff()).norm());
  }
  auto target = std::make_shared<CurveTarget>();
  const Status status = target->Make(curves, SewTolerance * size, cornerAngle);
  return status ? Result<FitTargetPtr>(FitTargetPtr(target)) : Result<FitTargetPtr>(status);
}
}
