// SPDX-License-Identifier: BSD-3-Clause
#include "TrimmedModel.h"

#include <algorithm>

namespace knotwork
{
namespace
{
Status CheckCurve(const TrimmingCurve& use, const TrimmedModel& model, const std::string& place)
{
  const Spline<1>& curve = use.Curve;
  if (Status status = curve.Check(); !status)
  {
    return { status.Code, place + ": " + status.Detail };
  }
  if (curve.NumComponents() != 3 || use.UV.cols() != 2 ||
    use.UV.rows() != curve.ControlPoints.rows() || curve.Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch,
      place + ": a tensor space with 3 + 2 coordinates a control point is needed" };
  }
  if (!use.UV.allFinite())
  {
    return { ErrorCode::NonFiniteInput, place + ": parameter curve" };
  }
  if (use.Edge < 0 || use.Edge >= model.NumEdges)
  {
    return { ErrorCode::InvalidTopology, place + ": edge " + std::to_string(use.Edge) };
  }
  for (int vertex : use.Vertices)
  {
    if (vertex < 0 || vertex >= model.NumVertices)
    {
      return { ErrorCode::InvalidTopology, place + ": vertex " + std::to_string(vertex) };
    }
  }
  return {};
}

Status CheckLoop(const TrimmedLoop& loop, const TrimmedModel& model, const std::string& place)
{
  if (loop.Curves.empty())
  {
    return { ErrorCode::EmptyInput, place + " has no curves" };
  }
  for (std::size_t c = 0; c < loop.Curves.size(); ++c)
  {
    const TrimmingCurve& use = loop.Curves[c];
    const std::string curvePlace = place + ", curve " + std::to_string(c);
    if (Status status = CheckCurve(use, model, curvePlace); !status)
    {
      return status;
    }
    const TrimmingCurve& next = loop.Curves[(c + 1) % loop.Curves.size()];
    if (use.Vertices[use.Reversed ? 0 : 1] != next.Vertices[next.Reversed ? 1 : 0])
    {
      return { ErrorCode::InvalidTopology, curvePlace + " does not end where the next one begins" };
    }
  }
  return {};
}
}

Spline<1> TrimmingCurve::ParameterCurve() const
{
  return { this->Curve.Space, this->UV, this->Curve.Weights };
}

Status TrimmedModel::Check() const
{
  if (this->Faces.empty())
  {
    return { ErrorCode::EmptyInput, "a model without faces" };
  }
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    const TrimmedFace& face = this->Faces[f];
    const std::string place = "face " + std::to_string(f);
    if (Status status = face.Surface.Check(); !status)
    {
      return { status.Code, place + ": " + status.Detail };
    }
    if (face.Surface.NumComponents() != 3 || face.Surface.Space->Kind != SpaceKind::Tensor)
    {
      return { ErrorCode::DimensionMismatch,
        place + ": the surface must be a tensor product in space" };
    }
    for (std::size_t l = 0; l < face.Loops.size(); ++l)
    {
      if (Status status = CheckLoop(face.Loops[l], *this, place + ", loop " + std::to_string(l));
          !status)
      {
        return status;
      }
    }
  }
  return {};
}

void AppendFaces(TrimmedModel& model, TrimmedModel other)
{
  int body = 0;
  for (const TrimmedFace& face : model.Faces)
  {
    body = std::max(body, face.Body + 1);
  }
  for (TrimmedFace& face : other.Faces)
  {
    face.Body += body;
    for (TrimmedLoop& loop : face.Loops)
    {
      for (TrimmingCurve& use : loop.Curves)
      {
        use.Edge += model.NumEdges;
        use.Vertices[0] += model.NumVertices;
        use.Vertices[1] += model.NumVertices;
      }
    }
    model.Faces.push_back(std::move(face));
  }
  model.NumEdges += other.NumEdges;
  model.NumVertices += other.NumVertices;
}

double SizeOf(const TrimmedModel& model)
{
  if (model.Faces.empty())
  {
    return 0.0;
  }
  Eigen::RowVector3d lower = model.Faces.front().Surface.ControlPoints.row(0);
  Eigen::RowVector3d upper = lower;
  for (const TrimmedFace& face : model.Faces)
  {
    lower = lower.cwiseMin(face.Surface.ControlPoints.colwise().minCoeff());
    upper = upper.cwiseMax(face.Surface.ControlPoints.colwise().maxCoeff());
  }
  return (upper - lower).norm();
}
}
