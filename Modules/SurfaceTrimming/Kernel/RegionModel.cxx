// SPDX-License-Identifier: BSD-3-Clause
#include "ChartedModel.h"
#include "EdgeMeasures.h"
#include "RegionEvidence.h"
#include "RegionLoops.h"
#include "TriangleSag.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double ExactShare = 1e-9;  ///< of the diagonal
constexpr double NearFree = 0.1;     ///< of the tolerance: way of points of free form
constexpr double FollowShare = 0.02; ///< of the tolerance, along edges of free form
constexpr int MaxAttempts = 3;       ///< to make loops that do not cross

/// A curve of the model: of a chain, a seam or a pole.
struct ModelCurve
{
  EdgeShape Shape;
  std::array<int, 2> Vertices{ -1, -1 };
  std::vector<EdgeOnPatch> Images;  ///< one a use
  bool IsGiven = false;             ///< the shape's curve is that of faces of free form
  std::vector<PointMatrix> GivenUV; ///< their images, which come last in Spline
  EdgeSpline Spline;
};

/// Where a step of a loop is kept.
struct StepUse
{
  std::size_t Curve = 0;
  std::size_t Image = 0;
  bool Reversed = false;
};

class RegionModeler
{
public:
  /// @param charts  of regions of free form; null: there are none.
  RegionModeler(const DiscMesh& surface, const SurfaceRecognition& recognition,
    ChartedRegions* charts, const RegionModelParams& params)
    : Surface(surface), Recognition(recognition), Charts(charts), Params(params),
      Size((surface.Points.colwise().maxCoeff() - surface.Points.colwise().minCoeff()).norm()),
      Farthest(2.0 * recognition.Tolerance), Loops(recognition.Regions.size()),
      Steps(recognition.Regions.size())
  {
    for (const RecognizedRegion& region : recognition.Regions)
    {
      this->Surfaces.push_back(region.Surface);
    }
  }

  /// Regions that are no faces as they are, or whose surfaces are too far from common edges.
  const std::vector<int>& Failed() const { return this->FailedRegions; }

  Result<RegionModel> Run()
  {
    for (const auto stage :
      { &RegionModeler::FindChains, &RegionModeler::OpenRegions, &RegionModeler::FitFree })
    {
      if (Status status = (this->*stage)(); !status)
      {
        return status;
      }
    }
    this->Follows.assign(this->Chains.Chains.size(), 0);
    Status status;
    for (int attempt = 0; attempt < MaxAttempts; ++attempt)
    {
      if (this->Params.Progress &&
        !this->Params.Progress(static_cast<double>(attempt) / MaxAttempts))
      {
        return { ErrorCode::Aborted, "the model was stopped" };
      }
      this->Crossing.clear();
      for (const auto stage : { &RegionModeler::ShapeChains, &RegionModeler::LayOut,
             &RegionModeler::FitCurves, &RegionModeler::MakeFaces })
      {
        status = status.Code == ErrorCode::Ok || stage == &RegionModeler::ShapeChains
          ? (this->*stage)()
          : status;
      }
      if (!this->FollowAlongCrossing())
      {
        break;
      }
    }
    this->FailedRegions.assign(this->Crossing.begin(), this->Crossing.end());
    if (!status)
    {
      return status;
    }
    this->FindApart();
    this->Measure();
    this->MeasureJoints();
    const Status certified = this->Certify();
    return certified ? Result<RegionModel>(std::move(this->Made)) : Result<RegionModel>(certified);
  }

private:
  template <typename Regions>
  std::vector<AnalyticSurface> SurfacesOf(const Regions& regions) const
  {
    return knotwork::SurfacesOf(regions, this->Surfaces);
  }
  bool IsFree(std::size_t region) const
  {
    return this->Surfaces[region].Type == SurfaceType::FreeForm;
  }
  Status FindChains();
  Status OpenRegions();
  Status FitFree();
  void AddFreeFace(std::size_t region, TrimmedModel& model) const;
  Status ShapeChains();
  Status LayOut();
  Status FitCurves();
  Status MakeFaces();
  bool FollowAlongCrossing();
  void FindApart();
  void Measure();
  Status Certify();
  StepUse AddImage(std::size_t region, const LoopStep& step);
  void SetVerticesOfSeam(const std::vector<StepUse>& loop, std::size_t seam);
  double BoundChain(const RegionChain& chain, const ModelCurve& curve) const;
  void MeasureJoints();
  int SmoothRegionOf(std::size_t region) const
  {
    return this->Charts->SmoothRegion[region - static_cast<std::size_t>(this->Charts->FirstChart)];
  }

  const DiscMesh& Surface;
  const SurfaceRecognition& Recognition;
  ChartedRegions* Charts;
  const RegionModelParams& Params;
  double Size;
  double Farthest; ///< surfaces that hardly meet do so anywhere
  std::vector<AnalyticSurface> Surfaces;
  RegionChains Chains;
  FreeFaces Free;
  std::vector<int> FailedRegions;
  std::vector<int> EdgeOfChain;      ///< of the free faces' edges; -1: of none
  std::vector<RegionLoops> Loops;    ///< one a region
  std::vector<std::size_t> Crossing; ///< regions whose loops do
  std::vector<char>
    Follows; ///< chains whose curves go along the mesh's edges wherever surfaces meet
  std::vector<ModelCurve> Curves;                       ///< one a chain, then seams and poles
  std::vector<std::vector<std::vector<StepUse>>> Steps; ///< of each region's loops
  int NumVertices = 0;                                  ///< with poles
  RegionModel Made;
};

/// Chains, and where surfaces meet next to them.
Status RegionModeler::FindChains()
{
  for (std::size_t r = 0; r < this->Surfaces.size(); ++r)
  {
    if (this->IsFree(r) && !this->Charts)
    {
      const int triangle = this->Recognition.Regions[r].Triangles.front();
      const Eigen::Vector3d at =
        this->Surface.Point(this->Surface.Triangles[static_cast<std::size_t>(triangle)].front());
      return { ErrorCode::NotInSpace,
        "region " + std::to_string(r) + " at (" + Digits(at.x()) + ", " + Digits(at.y()) + ", " +
          Digits(at.z()) + ") is of free form; raise the tolerance, or make spline faces" };
    }
    this->Loops[r].Reversed = this->Recognition.Regions[r].Reversed;
  }
  this->Chains = FindRegionChains(this->Surface, this->Recognition.RegionOfTriangle,
    static_cast<int>(this->Surfaces.size()), this->Params.CornerAngle);
  if (Status status = this->Charts
        ? SplitAtChartCorners(this->Charts->Charts, this->Params.CornerAngle, this->Chains)
        : Status();
      !status)
  {
    return status;
  }
  const auto place = [&](const auto& regions, const Eigen::Vector3d& point) -> Eigen::Vector3d
  {
    const std::vector<AnalyticSurface> surfaces = this->SurfacesOf(regions);
    if (surfaces.empty())
    {
      return point;
    }
    const Eigen::Vector3d move = MoveOnto(surfaces, point, this->Farthest) - point;
    const bool touchesFree = std::any_of(regions.begin(), regions.end(),
      [&](int region) { return region >= 0 && this->IsFree(static_cast<std::size_t>(region)); });
    const double most = touchesFree ? NearFree * this->Recognition.Tolerance : HUGE_VAL;
    return point + std::min(1.0, most / std::max(move.norm(), 1e-300)) * move;
  };
  for (RegionVertex& vertex : this->Chains.Vertices)
  {
    vertex.Point = place(vertex.Regions, vertex.MeshPoint);
  }
  for (RegionChain& chain : this->Chains.Chains)
  {
    const std::size_t last = chain.Points.size() - 1;
    for (std::size_t i = 0; i <= last; ++i)
    {
      const int vertex = i == 0 ? chain.Vertices[0] : i == last ? chain.Vertices[1] : -1;
      chain.Points[i] = vertex >= 0 ? this->Chains.Vertices[static_cast<std::size_t>(vertex)].Point
                                    : place(chain.Regions, chain.MeshPoints[i]);
    }
  }
  return {};
}

/// Seams of faces that close around, and a vertex of every edge.
Status RegionModeler::OpenRegions()
{
  for (std::size_t r = 0; r < this->Loops.size(); ++r)
  {
    Status status = this->IsFree(r) ? Status()
                                    : OpenRegion(this->Surfaces, static_cast<int>(r),
                                        this->Farthest, this->Chains, this->Loops[r]);
    if (!status)
    {
      this->FailedRegions = { static_cast<int>(r) };
      return status;
    }
  }
  for (std::size_t c = 0; c < this->Chains.Chains.size(); ++c)
  {
    if (this->Chains.Chains[c].Vertices[0] < 0)
    {
      this->Chains.Split(static_cast<int>(c), 0);
    }
  }
  return {};
}

/// Spline faces, and their edges, which analytic neighbours share.
Status RegionModeler::FitFree()
{
  this->EdgeOfChain.assign(this->Chains.Chains.size(), -1);
  if (!this->Charts)
  {
    return {};
  }
  TrimParams params = this->Params.Trim;
  params.Tolerance = this->Recognition.Tolerance;
  params.CornerAngle = this->Params.CornerAngle;
  params.Triangulation = false;
  params.Threads = this->Params.Threads;
  params.Progress = this->Params.Progress;
  auto fitted = FitFreeFaces(*this->Charts, this->Surfaces, this->Chains, params);
  if (!fitted)
  {
    return fitted.Status;
  }
  this->Free = std::move(fitted.Value);
  for (std::size_t e = 0; e < this->Free.ChainOfEdge.size(); ++e)
  {
    this->EdgeOfChain[static_cast<std::size_t>(this->Free.ChainOfEdge[e])] = static_cast<int>(e);
  }
  return {};
}

Status RegionModeler::ShapeChains()
{
  EdgeShapeParams params;
  params.Exact = ExactShare * this->Size;
  this->Curves.clear();
  this->Made = {};
  for (std::size_t c = 0; c < this->Chains.Chains.size(); ++c)
  {
    const RegionChain& chain = this->Chains.Chains[c];
    params.Farthest = this->Follows[c] ? 0.0 : this->Farthest;
    params.Loose = params.Exact;
    params.Along = chain.IsRim() ? this->Recognition.Tolerance : HUGE_VAL;
    for (const int region : chain.Regions)
    {
      if (region >= 0 && !this->Follows[c])
      {
        params.Loose = std::max(params.Loose,
          2.0 * this->Recognition.Regions[static_cast<std::size_t>(region)].MaxDistance);
      }
    }
    ModelCurve& curve = this->Curves.emplace_back();
    curve.Vertices = chain.Vertices;
    if (this->EdgeOfChain[c] >= 0)
    {
      curve.IsGiven = true;
      continue;
    }
    curve.Shape = FindEdgeShape(chain.Points, this->SurfacesOf(chain.Regions), params);
    this->Made.NumLines += curve.Shape.Kind == EdgeShapeKind::Line ? 1 : 0;
    this->Made.NumCircles += curve.Shape.Kind == EdgeShapeKind::Circle ? 1 : 0;
  }
  for (const TrimmedFace& face : this->Free.Trimmed.Model.Faces)
  {
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& use : loop.Curves)
      {
        const int c = this->Free.ChainOfEdge[static_cast<std::size_t>(use.Edge)];
        ModelCurve& curve = this->Curves[static_cast<std::size_t>(c)];
        curve.Shape.Kind = EdgeShapeKind::Spline;
        curve.Shape.Curve = use.Curve;
        const PointMatrix& points = use.Curve.ControlPoints;
        curve.Shape.Ends = { points.row(0).transpose(), points.row(points.rows() - 1).transpose() };
        curve.GivenUV.push_back(use.UV);
        for (std::size_t e = 0; e < 2; ++e)
        {
          this->Chains.Vertices[static_cast<std::size_t>(curve.Vertices[e])].Point =
            curve.Shape.Ends[e];
        }
      }
    }
  }
  this->Made.NumEdges = static_cast<int>(this->Curves.size());
  this->NumVertices = static_cast<int>(this->Chains.Vertices.size());
  this->Made.NumVertices = this->NumVertices;
  return {};
}

StepUse RegionModeler::AddImage(std::size_t region, const LoopStep& step)
{
  const RegionLoops& loops = this->Loops[region];
  StepUse use;
  use.Reversed = step.Reversed;
  if (step.Kind == LoopStepKind::Chain)
  {
    use.Curve = static_cast<std::size_t>(step.Chain);
  }
  else if (step.Kind == LoopStepKind::Pole)
  {
    use.Curve = this->Curves.size();
    ModelCurve& pole = this->Curves.emplace_back();
    pole.Shape.Ends = { loops.Patch.Point(step.Ends[0]), loops.Patch.Point(step.Ends[0]) };
    pole.Vertices = { this->NumVertices, this->NumVertices };
    ++this->NumVertices;
  }
  else if (!step.Reversed)
  {
    use.Curve = this->Curves.size();
    this->Curves.emplace_back();
  }
  else // a seam is used first as it runs, and no other one is in between
  {
    use.Curve = this->Curves.size() - 1;
    while (this->Curves[use.Curve].Images.empty() || this->Curves[use.Curve].Images[0].Fixed < 0)
    {
      --use.Curve;
    }
  }
  ModelCurve& curve = this->Curves[use.Curve];
  EdgeOnPatch image;
  image.Patch = &loops.Patch;
  image.Ends = step.Ends;
  image.Fixed = step.Kind == LoopStepKind::Seam ? loops.Winding : -1;
  use.Image = curve.Images.size();
  curve.Images.push_back(image);
  return use;
}

/// A seam begins and ends where its neighbours do.
void RegionModeler::SetVerticesOfSeam(const std::vector<StepUse>& loop, std::size_t seam)
{
  ModelCurve& curve = this->Curves[loop[seam].Curve];
  const StepUse& before = loop[seam - 1];
  const StepUse& after = loop[seam + 1];
  const ModelCurve& from = this->Curves[before.Curve];
  const ModelCurve& to = this->Curves[after.Curve];
  const std::size_t end = before.Reversed ? 0 : 1;
  const std::size_t begin = after.Reversed ? 1 : 0;
  curve.Vertices = { from.Vertices[end], to.Vertices[begin] };
  const EdgeOnPatch& image = curve.Images.front();
  curve.Shape = IsoparametricShape(*image.Patch, image.Ends, image.Fixed);
  curve.Shape.Ends = { from.Shape.Ends[end], to.Shape.Ends[begin] };
}

Status RegionModeler::LayOut()
{
  std::vector<EdgeShape> shapes;
  for (const ModelCurve& curve : this->Curves)
  {
    shapes.push_back(curve.Shape);
  }
  for (std::size_t r = 0; r < this->Loops.size(); ++r)
  {
    this->Steps[r].clear();
    if (this->IsFree(r))
    {
      continue;
    }
    if (Status status = LayOutLoops(static_cast<int>(r), this->Chains, shapes, this->Loops[r]);
        !status)
    {
      this->Crossing.push_back(r);
      return status;
    }
    for (const std::vector<LoopStep>& loop : this->Loops[r].Steps)
    {
      std::vector<StepUse>& uses = this->Steps[r].emplace_back();
      for (const LoopStep& step : loop)
      {
        uses.push_back(this->AddImage(r, step));
      }
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        if (loop[i].Kind == LoopStepKind::Seam && !loop[i].Reversed)
        {
          this->SetVerticesOfSeam(uses, i);
        }
      }
    }
  }
  return {};
}

Status RegionModeler::FitCurves()
{
  for (ModelCurve& curve : this->Curves)
  {
    auto spline = curve.IsGiven
      ? FollowCurve(
          curve.Shape.Curve, curve.Images, curve.GivenUV, FollowShare * this->Recognition.Tolerance)
      : MakeEdgeSpline(curve.Shape, curve.Images, ExactShare * this->Size);
    if (!spline)
    {
      return spline.Status;
    }
    curve.Spline = std::move(spline.Value);
    this->Made.MaxEdgeGap = std::max(this->Made.MaxEdgeGap, curve.Spline.Gap);
  }
  return {};
}

Status RegionModeler::MakeFaces()
{
  TrimmedModel& model = this->Made.Model;
  model.NumEdges = static_cast<int>(this->Curves.size());
  model.NumVertices = this->NumVertices;
  for (std::size_t r = 0; r < this->Loops.size(); ++r)
  {
    if (this->IsFree(r))
    {
      this->AddFreeFace(r, model);
      this->Made.Verdicts.push_back(
        this->Free.Trimmed.Loops.Verdicts[r - static_cast<std::size_t>(this->Charts->FirstChart)]);
      continue;
    }
    TrimmedFace& face = model.Faces.emplace_back();
    face.Surface = this->Loops[r].Patch.MakeSpline();
    face.Type = this->Surfaces[r].Type;
    face.Reversed = this->Loops[r].Reversed;
    for (const std::vector<StepUse>& steps : this->Steps[r])
    {
      TrimmedLoop& loop = face.Loops.emplace_back();
      for (const StepUse& step : steps)
      {
        const ModelCurve& curve = this->Curves[step.Curve];
        TrimmingCurve& use = loop.Curves.emplace_back();
        use.Curve = curve.Spline.Curve;
        use.UV = curve.Spline.UV[step.Image];
        use.Edge = static_cast<int>(step.Curve);
        use.Vertices = curve.Vertices;
        use.Reversed = step.Reversed;
      }
    }
    const auto verdict = ProveLoops(face);
    this->Made.Verdicts.push_back(verdict ? verdict.Value : LoopVerdict::Undecided);
    if (this->Made.Verdicts.back() != LoopVerdict::SimpleNested)
    {
      this->Crossing.push_back(r);
    }
  }
  return model.Check();
}

/// With the knots that its neighbours inserted into its edges.
void RegionModeler::AddFreeFace(std::size_t region, TrimmedModel& model) const
{
  const std::vector<TrimmedFace>& faces = this->Free.Trimmed.Model.Faces;
  const std::size_t own = region - static_cast<std::size_t>(this->Charts->FirstChart);
  TrimmedFace& face = model.Faces.emplace_back(faces[own]);
  for (TrimmedLoop& loop : face.Loops)
  {
    for (TrimmingCurve& use : loop.Curves)
    {
      const int chain = this->Free.ChainOfEdge[static_cast<std::size_t>(use.Edge)];
      const ModelCurve& curve = this->Curves[static_cast<std::size_t>(chain)];
      // of two faces the first one's image came first
      std::size_t image = curve.Images.size();
      image += curve.GivenUV.front() == use.UV ? 0 : 1;
      use.Curve = curve.Spline.Curve;
      use.UV = curve.Spline.UV[image];
      use.Edge = chain;
      use.Vertices = curve.Vertices;
    }
  }
}

/// Where surfaces touch, the curves in which they meet may cross each other although the mesh's
/// edges do not. @return whether there is something to try again.
bool RegionModeler::FollowAlongCrossing()
{
  bool isNew = false;
  for (const std::size_t r : this->Crossing)
  {
    for (const auto& loop : this->Chains.Loops[r])
    {
      for (const ChainUseOfRegion& use : loop)
      {
        if (this->EdgeOfChain[static_cast<std::size_t>(use.Chain)] >= 0)
        {
          continue;
        }
        char& follows = this->Follows[static_cast<std::size_t>(use.Chain)];
        isNew = isNew || follows == 0;
        follows = 1;
      }
    }
  }
  return isNew;
}

/// Where surfaces are farther than the tolerance from a common edge, the region with the smaller
/// area is not on its surface there.
void RegionModeler::FindApart()
{
  const auto area = [&](int region)
  {
    double sum = 0.0;
    for (const int t : this->Recognition.Regions[static_cast<std::size_t>(region)].Triangles)
    {
      sum +=
        TriangleArea(this->Surface.Points, this->Surface.Triangles[static_cast<std::size_t>(t)]);
    }
    return sum;
  };
  for (std::size_t c = 0; c < this->Chains.Chains.size(); ++c)
  {
    const auto& [left, right] = this->Chains.Chains[c].Regions;
    const bool isApart = this->Curves[c].Spline.Gap > this->Recognition.Tolerance;
    if (isApart && !this->Curves[c].IsGiven && left >= 0 && right >= 0 && left != right)
    {
      this->FailedRegions.push_back(area(left) < area(right) ? left : right);
    }
  }
}

/// Of the curve from the chain's edges and back. The curve is cut next to the mesh's points; each
/// part lies in the hull of its control points, and runs from one end of its edge to the other.
double RegionModeler::BoundChain(const RegionChain& chain, const ModelCurve& curve) const
{
  const std::vector<double> cuts = curve.Shape.SharesOf(chain.Points);
  const std::vector<double> inner(cuts.begin() + 1, cuts.end() - 1);
  const auto cut = InsertKnots<1>(curve.Spline.Curve, 0, inner);
  if (!cut)
  {
    return HUGE_VAL;
  }
  const BezierForm<1> form = MakeBezierForm<1>(cut.Value, 1);
  double bound = 0.0;
  std::size_t segment = 0;
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const auto& element = form.Space->Elements[static_cast<std::size_t>(e)];
    const double middle = 0.5 * (element.Box.Lower[0] + element.Box.Upper[0]);
    while (cuts[segment + 1] < middle)
    {
      ++segment;
    }
    const Eigen::Vector3d& a = chain.MeshPoints[segment];
    const Eigen::Vector3d along = chain.MeshPoints[segment + 1] - a;
    const int count = form.Space->Knots[0].Degree() + 1;
    for (int i = 0; i < count; ++i)
    {
      const double* block = form.Block(e) + i;
      const Eigen::Vector3d offset = Eigen::Vector3d(block[0], block[count], block[2 * count]) - a;
      const double share = std::min(std::max(offset.dot(along) / along.squaredNorm(), 0.0), 1.0);
      bound = std::max(bound, (offset - share * along).norm());
    }
  }
  return bound;
}

/// Surfaces of these types are regular but at poles, where their parameters are not: faces with a
/// pole are taken for what they are.
Status RegionModeler::Certify()
{
  FaceCertificateParams params;
  params.Threads = this->Params.Threads;
  for (std::size_t r = 0; r < this->Made.Model.Faces.size(); ++r)
  {
    if (this->IsFree(r))
    {
      this->Made.Certificates.push_back(
        this->Free.Trimmed.Certificates[r - static_cast<std::size_t>(this->Charts->FirstChart)]);
      continue;
    }
    const AnalyticPatch& patch = this->Loops[r].Patch;
    const std::array<double, 2> poles = patch.Poles();
    if (patch.Lower()[1] <= poles[0] || patch.Upper()[1] >= poles[1])
    {
      FaceCertificate known;
      known.Verdict = Verdict::Valid;
      this->Made.Certificates.push_back(known);
      ++this->Made.NumPoleFaces;
      continue;
    }
    const auto certificate = CertifyFace(this->Made.Model.Faces[r], params);
    if (!certificate)
    {
      return certificate.Status;
    }
    this->Made.Certificates.push_back(certificate.Value);
  }
  return {};
}

/// Edges between faces: gaps, and whether they are sharp.
void RegionModeler::MeasureJoints()
{
  constexpr double Sharp = 5.0; // degrees
  const std::vector<EdgeMeasure> edges = MeasureEdges(this->Made.Model, this->Params.Threads);
  for (const EdgeMeasure& edge : edges)
  {
    this->Made.MaxEdgeGap = std::max(this->Made.MaxEdgeGap, edge.Gap);
    if (edge.Faces.size() != 2 || edge.Faces[0] == edge.Faces[1])
    {
      continue;
    }
    const auto first = static_cast<std::size_t>(edge.Faces[0]);
    const auto second = static_cast<std::size_t>(edge.Faces[1]);
    const bool isFree = this->IsFree(first) || this->IsFree(second);
    const bool isInside = this->IsFree(first) && this->IsFree(second) &&
      this->SmoothRegionOf(first) == this->SmoothRegionOf(second);
    if (isInside)
    {
      this->Made.MaxNormalAngle = std::max(this->Made.MaxNormalAngle, edge.MaxAngle);
    }
    // splines follow normals less well than points
    this->Made.NumSharpEdges += edge.MedianAngle >= (isFree ? SharpDegrees : Sharp) ? 1 : 0;
  }
}

void RegionModeler::Measure()
{
  this->Made.NumOfType = this->Recognition.NumOfType;
  this->Made.Tolerance = this->Recognition.Tolerance;
  if (this->Charts)
  {
    this->Made.FreeDeviation = this->Free.Trimmed.MaxDeviation + this->Free.MaxMove;
  }
  this->Made.Work = this->Free.Trimmed.Work;
  this->Made.NumRims = static_cast<int>(this->Surface.Loops.size());
  for (std::size_t t = 0; t < this->Surface.Triangles.size(); ++t)
  {
    const auto r = static_cast<std::size_t>(this->Recognition.RegionOfTriangle[t]);
    if (this->IsFree(r))
    {
      continue;
    }
    const auto& triangle = this->Surface.Triangles[t];
    const std::array<Eigen::Vector3d, 3> corners{ this->Surface.Point(triangle[0]),
      this->Surface.Point(triangle[1]), this->Surface.Point(triangle[2]) };
    for (const Eigen::Vector3d& corner : corners)
    {
      this->Made.MaxPointDistance =
        std::max(this->Made.MaxPointDistance, std::abs(this->Surfaces[r].Distance(corner)));
    }
    this->Made.MaxDistance =
      std::max(this->Made.MaxDistance, BoundDistance(this->Surfaces[r], corners));
  }
  for (std::size_t c = 0; c < this->Chains.Chains.size(); ++c)
  {
    const RegionChain& chain = this->Chains.Chains[c];
    for (std::size_t i = 0; i + 1 < chain.MeshPoints.size(); ++i)
    {
      for (const AnalyticSurface& beside : this->SurfacesOf(chain.Regions))
      {
        this->Made.MaxDistance = std::max(this->Made.MaxDistance,
          BoundDistance(
            beside, { chain.MeshPoints[i], chain.MeshPoints[i + 1], chain.MeshPoints[i + 1] }));
      }
    }
    this->Made.MaxEdgeDistance =
      std::max(this->Made.MaxEdgeDistance, this->BoundChain(chain, this->Curves[c]));
    if (chain.IsRim() && !this->Curves[c].IsGiven)
    {
      this->Made.MaxPointDistance =
        std::max(this->Made.MaxPointDistance, this->Curves[c].Shape.DistanceOf(chain.MeshPoints));
    }
  }
  for (const RegionVertex& vertex : this->Chains.Vertices)
  {
    this->Made.MaxVertexDistance =
      std::max(this->Made.MaxVertexDistance, (vertex.Point - vertex.MeshPoint).norm());
  }
}
}

Result<RegionModel> ModelCharted(const DiscMesh& surface, const SurfaceRecognition& recognition,
  ChartedRegions* charts, const RegionModelParams& params, std::vector<int>& failed)
{
  RegionModeler modeler(surface, recognition, charts, params);
  auto model = modeler.Run();
  failed = modeler.Failed();
  return model;
}

Result<RegionModel> ModelRegions(
  const DiscMesh& surface, const SurfaceRecognition& recognition, const RegionModelParams& params)
{
  if (!(params.CornerAngle > 0.0 && params.CornerAngle <= 180.0))
  {
    return { ErrorCode::InvalidParameter, "CornerAngle must lie in (0, 180]" };
  }
  if (recognition.RegionOfTriangle.size() != surface.Triangles.size() ||
    recognition.Regions.empty())
  {
    return { ErrorCode::SizeMismatch, "the regions are of another mesh" };
  }
  std::vector<int> failed;
  return ModelCharted(surface, recognition, nullptr, params, failed);
}
}
