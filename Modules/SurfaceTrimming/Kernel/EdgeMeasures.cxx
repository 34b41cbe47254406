// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeMeasures.h"
#include <knotwork/SplineCore/AngleBetween.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/CurveInterpolation.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Angles in degrees between rows; none where one of them vanishes.
std::vector<double> AnglesBetween(const PointMatrix& first, const PointMatrix& second)
{
  constexpr double Degrees = 180.0 / 3.14159265358979323846;
  std::vector<double> angles;
  for (Eigen::Index i = 0; i < first.rows(); ++i)
  {
    const Eigen::Vector3d a = first.row(i).transpose();
    const Eigen::Vector3d b = second.row(i).transpose();
    if (a.norm() > 0.0 && b.norm() > 0.0)
    {
      angles.push_back(Degrees * AngleBetween(a, b));
    }
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}
}

std::vector<EdgeMeasure> MeasureEdges(const TrimmedModel& model, int threads)
{
  constexpr int Samples = 5;
  std::vector<EdgeMeasure> edges(static_cast<std::size_t>(model.NumEdges));
  std::vector<PointMatrix> normals(edges.size()); // of the first use
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = threads;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const TrimmedFace& face = model.Faces[f];
    const BezierForm<2> form = MakeBezierForm<2>(face.Surface, threads);
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& use : loop.Curves)
      {
        const PointMatrix t = ParametersInSpans(use.Curve.Space->Knots[0], Samples);
        EvaluationBatch batch;
        EvaluateParameters<2>(form, CurvePoints({ use.Curve.Space, use.UV, {} }, t), params, batch);
        PointMatrix own(t.rows(), 3);
        for (Eigen::Index i = 0; i < t.rows(); ++i)
        {
          const Eigen::Vector3d u = batch.First.row(i).head(3).transpose();
          const Eigen::Vector3d v = batch.First.row(i).tail(3).transpose();
          own.row(i) = (face.Reversed ? v.cross(u) : u.cross(v)).transpose();
        }
        EdgeMeasure& edge = edges[static_cast<std::size_t>(use.Edge)];
        edge.Faces.push_back(static_cast<int>(f));
        edge.Gap = std::max(
          edge.Gap, (batch.Values - CurvePoints(use.Curve, t)).rowwise().norm().maxCoeff());
        PointMatrix& first = normals[static_cast<std::size_t>(use.Edge)];
        if (edge.Faces.size() == 1)
        {
          first = std::move(own);
          continue;
        }
        const std::vector<double> angles = AnglesBetween(first, own);
        if (!angles.empty())
        {
          edge.MaxAngle = angles.back();
          edge.MedianAngle = angles[angles.size() / 2];
        }
      }
    }
  }
  return edges;
}
}
