// SPDX-License-Identifier: BSD-3-Clause
#include "SampledDistances.h"

#include <knotwork/SplineCore/ClosestPoint.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Quadrature.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 16; ///< elements
constexpr std::size_t QueriesAtOnce = 1024;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sums of squares in a fixed order, and the largest.
struct Accumulator
{
  double Squares = 0.0;
  double Weights = 0.0;
  double Largest = -1.0;
  Eigen::RowVector3d Place = Eigen::RowVector3d::Zero();

  void Add(double distance, double weight, const Eigen::RowVector3d& place)
  {
    this->Squares += weight * distance * distance;
    this->Weights += weight;
    if (distance > this->Largest)
    {
      this->Largest = distance;
      this->Place = place;
    }
  }
  void Add(const Accumulator& other)
  {
    this->Squares += other.Squares;
    this->Weights += other.Weights;
    if (other.Largest > this->Largest)
    {
      this->Largest = other.Largest;
      this->Place = other.Place;
    }
  }
  DistanceSummary Summary() const
  {
    DistanceSummary summary;
    if (this->Weights > 0.0)
    {
      summary.Largest = this->Largest;
      summary.RootMeanSquare = std::sqrt(this->Squares / this->Weights);
      summary.Place = { this->Place[0], this->Place[1], this->Place[2] };
    }
    return summary;
  }
};

class DistanceSampling
{
public:
  DistanceSampling(const Spline<2>& surface, const SurfaceMesh& mesh,
    const std::vector<std::array<double, 8>>& corners, const MeshClassification& parts,
    const PointMatrix& points, const FitTarget& target, const SampledDistanceParams& params)
    : Form(MakeBezierForm(surface, params.Threads)), Mesh(mesh), Corners(corners), Parts(parts),
      Points(points), Target(target), Params(params),
      Count(params.Samples > 0 ? params.Samples : surface.Space->Elements[0].Degree[0] + 2)
  {
  }

  Result<FitDistances> Run()
  {
    Status status;
    if (this->Target.HasSurface() && this->Params.Surfaces)
    {
      status = this->MeasureElements();
    }
    status = status ? this->MeasureEdges() : status;
    if (status && this->Params.TargetSamples > 0 && this->Target.HasSurface() &&
      this->Params.Surfaces)
    {
      status = this->MeasureTarget();
    }
    return status ? Result<FitDistances>(std::move(this->Distances)) : status;
  }

private:
  bool IsStopped(double share) const
  {
    return this->Params.Progress && !this->Params.Progress(share);
  }

  /// Gauss points, and the corners with weight 0.
  Status MeasureElements()
  {
    const ElementQuadrature<2> rule = MakeElementQuadrature<2>({ this->Count, this->Count });
    const Eigen::Index inner = rule.Local.rows();
    PointMatrix local(inner + 4, 2);
    local.topRows(inner) = rule.Local;
    local.bottomRows(4) << 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0;
    const std::size_t count = this->Mesh.Quads.size();
    std::vector<std::array<Accumulator, 2>> of(count); // spline, mesh
    std::vector<Status> statuses((count + ChunkSize - 1) / ChunkSize);
    constexpr std::size_t atOnce = 4096;
    for (std::size_t first = 0; first < count; first += atOnce)
    {
      if (this->IsStopped(0.5 * static_cast<double>(first) / static_cast<double>(count)))
      {
        return { ErrorCode::Aborted, "measuring distances stopped" };
      }
      ParallelFor(std::min(atOnce, count - first), ChunkSize, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          EvaluationParams evaluation;
          evaluation.Threads = 1;
          EvaluationBatch batch;
          TargetPoints feet;
          PointMatrix values; // of all elements of the chunk: near queries find each other's feet
          Status& status = statuses[(first + begin) / ChunkSize];
          for (const int k : { 0, 1 })
          {
            const Eigen::Index each = k == 0 ? local.rows() : inner;
            values.resize(each * static_cast<Eigen::Index>(end - begin), 3);
            for (std::size_t q = begin; q < end; ++q)
            {
              auto own = values.middleRows(each * static_cast<Eigen::Index>(q - begin), each);
              if (k == 0)
              {
                EvaluateElements<2>(this->Form,
                  std::vector<int>(static_cast<std::size_t>(each), static_cast<int>(first + q)),
                  local, evaluation, batch);
                own = batch.Values.leftCols<3>();
              }
              else
              {
                own = this->Bilinear(first + q, rule.Local);
              }
            }
            status = status ? this->Target.Find({}, values, feet) : status;
            for (Eigen::Index row = 0; status && row < values.rows(); ++row)
            {
              const Eigen::Index i = row % each;
              of[first + begin + static_cast<std::size_t>(row / each)][At(k)].Add(
                (values.row(row) - feet.Points.row(row)).norm(), i < inner ? rule.Weights[i] : 0.0,
                values.row(row));
            }
          }
        });
    }
    std::array<Accumulator, 2> all;
    std::map<int, std::pair<int, Accumulator>> ofFaces;
    for (const Status& status : statuses)
    {
      if (!status)
      {
        return status;
      }
    }
    for (std::size_t q = 0; q < count; ++q)
    {
      all[0].Add(of[q][0]);
      all[1].Add(of[q][1]);
      auto& face = ofFaces[this->Parts.FaceOf[q]];
      ++face.first;
      face.second.Add(of[q][0]);
      this->Distances.OfElements.push_back(of[q][0].Largest);
    }
    this->Distances.ToTarget = all[0].Summary();
    this->Distances.MeshToTarget = all[1].Summary();
    for (const auto& [face, sum] : ofFaces)
    {
      this->Distances.Entities.push_back(
        { { face < 0 ? TargetEntity::Surface : TargetEntity::Face, face }, sum.first,
          sum.second.Summary() });
    }
    return {};
  }

  PointMatrix Bilinear(std::size_t q, const PointMatrix& local) const
  {
    const auto& quad = this->Mesh.Quads[q];
    PointMatrix values(local.rows(), 3);
    for (Eigen::Index i = 0; i < local.rows(); ++i)
    {
      const double u = local(i, 0);
      const double v = local(i, 1);
      values.row(i) =
        (1.0 - v) * ((1.0 - u) * this->Points.row(quad[0]) + u * this->Points.row(quad[1])) +
        v * ((1.0 - u) * this->Points.row(quad[3]) + u * this->Points.row(quad[2]));
    }
    return values;
  }

  /// Edges on curves; without a surface they are all that there is.
  Status MeasureEdges()
  {
    const QuadratureRule rule = GaussLegendre(this->Count);
    std::map<int, std::pair<int, Accumulator>> ofCurves;
    Accumulator all;
    Accumulator allMesh;
    EvaluationParams evaluation;
    evaluation.Threads = 1;
    EvaluationBatch batch;
    TargetPoints feet;
    const auto count = static_cast<Eigen::Index>(rule.Nodes.size());
    const bool isAlone = !this->Target.HasSurface() || !this->Params.Surfaces;
    for (std::size_t e = 0; e < this->Mesh.Edges.size(); ++e)
    {
      const int curve = this->Parts.CurveOf[e];
      const bool isRim = this->Mesh.QuadsOf[e][1] < 0;
      if (curve < 0 && !(isAlone && isRim && this->Target.HasSurface()))
      {
        continue;
      }
      const TargetPart part = curve < 0 ? TargetPart() : TargetPart{ TargetEntity::Curve, curve };
      const int quad = this->Mesh.QuadsOf[e][0];
      const auto& edges = this->Mesh.EdgesOf[At(quad)];
      const int k = static_cast<int>(
        std::find(edges.begin(), edges.end(), static_cast<int>(e)) - edges.begin());
      const auto& corners = this->Corners[At(quad)];
      PointMatrix local(count + 2, 2);
      PointMatrix straight(count, 3);
      const auto& own = this->Mesh.Quads[At(quad)];
      for (Eigen::Index i = 0; i < count + 2; ++i)
      {
        const double t =
          i < count ? rule.Nodes[static_cast<std::size_t>(i)] : static_cast<double>(i - count);
        for (int d = 0; d < 2; ++d)
        {
          local(i, d) = (1.0 - t) * corners[At(2 * k + d)] + t * corners[At(2 * ((k + 1) % 4) + d)];
        }
        if (i < count)
        {
          straight.row(i) =
            (1.0 - t) * this->Points.row(own[At(k)]) + t * this->Points.row(own[At((k + 1) % 4)]);
        }
      }
      EvaluateElements<2>(this->Form,
        std::vector<int>(static_cast<std::size_t>(local.rows()), quad), local, evaluation, batch);
      const PointMatrix values = batch.Values.leftCols<3>();
      if (Status status = this->Target.Find(part, values, feet); !status)
      {
        return status;
      }
      auto& of = ofCurves[curve];
      ++of.first;
      for (Eigen::Index i = 0; i < values.rows(); ++i)
      {
        const double weight = i < count ? rule.Weights[static_cast<std::size_t>(i)] : 0.0;
        const double distance = (values.row(i) - feet.Points.row(i)).norm();
        of.second.Add(distance, weight, values.row(i));
        all.Add(distance, weight, values.row(i));
      }
      if (Status status = this->Target.Find(part, straight, feet); !status)
      {
        return status;
      }
      for (Eigen::Index i = 0; i < count; ++i)
      {
        allMesh.Add((straight.row(i) - feet.Points.row(i)).norm(),
          rule.Weights[static_cast<std::size_t>(i)], straight.row(i));
      }
    }
    for (const auto& [curve, sum] : ofCurves)
    {
      this->Distances.Entities.push_back(
        { curve < 0 ? TargetPart() : TargetPart{ TargetEntity::Curve, curve }, sum.first,
          sum.second.Summary() });
    }
    if (isAlone)
    {
      this->Distances.ToTarget = all.Summary();
      this->Distances.MeshToTarget = allMesh.Summary();
    }
    return {};
  }

  Status MeasureTarget()
  {
    TargetSamples samples = this->Target.Samples(this->Params.TargetSamples);
    if (samples.Points.rows() == 0)
    {
      return {};
    }
    ClosestPointParams params;
    params.Threads = this->Params.Threads;
    params.Progress = [this](double share) { return !this->IsStopped(0.5 + 0.5 * share); };
    const auto search = ClosestPointSearch<2>::Create({ this->Form }, params);
    if (!search)
    {
      return search.Status;
    }
    ClosestPoints feet;
    if (Status status = search.Value.Find(samples.Points, feet); !status)
    {
      return status;
    }
    std::vector<MeshTriangle> triangles;
    for (const auto& quad : this->Mesh.Quads)
    {
      triangles.push_back({ quad[0], quad[1], quad[2] });
      triangles.push_back({ quad[0], quad[2], quad[3] });
    }
    const TriangleIndex<3> flat(this->Points, std::move(triangles));
    Eigen::VectorXd flatDistances(samples.Points.rows());
    ParallelFor(static_cast<std::size_t>(samples.Points.rows()), QueriesAtOnce,
      this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        const auto first = static_cast<Eigen::Index>(begin);
        std::vector<TriangleFoot> own;
        flat.Nearest(samples.Points.middleRows(first, static_cast<Eigen::Index>(end - begin)), own);
        for (std::size_t i = begin; i < end; ++i)
        {
          flatDistances[static_cast<Eigen::Index>(i)] = std::sqrt(own[i - begin].SquaredDistance);
        }
      });
    Accumulator spline;
    Accumulator mesh;
    for (Eigen::Index i = 0; i < samples.Points.rows(); ++i)
    {
      const Eigen::RowVector3d point = samples.Points.row(i);
      spline.Add(feet.Distances[i], samples.Areas[i], point);
      mesh.Add(flatDistances[i], samples.Areas[i], point);
    }
    this->Distances.FromTarget = spline.Summary();
    this->Distances.MeshFromTarget = mesh.Summary();
    this->Distances.OfSamples = std::move(feet.Distances);
    this->Distances.Samples = std::move(samples);
    return {};
  }

  const BezierForm<2> Form;
  const SurfaceMesh& Mesh;
  const std::vector<std::array<double, 8>>& Corners;
  const MeshClassification& Parts;
  const PointMatrix& Points;
  const FitTarget& Target;
  const SampledDistanceParams& Params;
  const int Count;
  FitDistances Distances;
};
}

Result<FitDistances> MeasureDistances(const Spline<2>& surface, const SurfaceMesh& mesh,
  const std::vector<std::array<double, 8>>& corners, const MeshClassification& parts,
  const PointMatrix& points, const FitTarget& target, const SampledDistanceParams& params)
{
  return DistanceSampling(surface, mesh, corners, parts, points, target, params).Run();
}
}
