// SPDX-License-Identifier: BSD-3-Clause
#include "ImplicitTarget.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
class ImplicitTarget final : public FitTarget
{
public:
  ImplicitTarget(ImplicitFunction function, const ImplicitTargetParams& params)
    : Function(std::move(function)), Params(params)
  {
    this->FaceCount = 1;
    this->Closed = true;
    this->VertexList.resize(0, 3);
  }

  Status Find(
    const TargetPart&, const PointMatrixView& queries, TargetPoints& result) const override
  {
    result.Points.resize(queries.rows(), 3);
    result.Normals.resize(queries.rows(), 3);
    result.Faces.assign(static_cast<std::size_t>(queries.rows()), 0);
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      Eigen::Vector3d point;
      Eigen::Vector3d normal;
      if (!this->Foot(queries.row(i).transpose(), point, normal))
      {
        return { ErrorCode::NotConverged,
          "no closest point of the implicit surface from (" + std::to_string(queries(i, 0)) + ", " +
            std::to_string(queries(i, 1)) + ", " + std::to_string(queries(i, 2)) +
            "): the mesh must lie near it, where its gradient does not vanish" };
      }
      result.Points.row(i) = point;
      result.Normals.row(i) = normal;
    }
    return {};
  }

  TargetSamples Samples(int atLeast) const override
  {
    TargetSamples samples;
    const Eigen::Map<const Eigen::Array3d> lower(this->Params.Lower.data());
    const Eigen::Map<const Eigen::Array3d> upper(this->Params.Upper.data());
    if (!((upper - lower).minCoeff() > 0.0))
    {
      return samples;
    }
    // lines through the box, more and more
    for (int n = 16; n <= 1024 && samples.Points.rows() < atLeast; n *= 2)
    {
      samples = this->SamplesOnLines(lower, upper, n);
    }
    return samples;
  }

private:
  TargetSamples SamplesOnLines(
    const Eigen::Array3d& lower, const Eigen::Array3d& upper, int n) const
  {
    TargetSamples samples;
    const Eigen::Array3d step = (upper - lower) / n;
    std::vector<Eigen::RowVector3d> points;
    std::vector<double> areas;
    const auto value = [&](const Eigen::Array3d& at)
    {
      Eigen::Vector3d gradient;
      return this->Function(at.data(), gradient.data());
    };
    // crossings of the lines of the grid along each direction: a line stands for the area of its
    // cell over the share of the normal along it; weighted by that share squared, the three
    // directions add up to the area
    for (int d = 0; d < 3; ++d)
    {
      const int a = (d + 1) % 3;
      const int b = (d + 2) % 3;
      for (int i = 0; i < n; ++i)
      {
        for (int j = 0; j < n; ++j)
        {
          Eigen::Array3d at = lower;
          at[a] += (i + 0.5) * step[a];
          at[b] += (j + 0.5) * step[b];
          double last = value(at);
          for (int k = 1; k <= n; ++k)
          {
            const double before = at[d];
            at[d] = lower[d] + k * step[d];
            const double next = value(at);
            if ((last < 0.0) != (next < 0.0))
            {
              this->AddCrossing(at, d, before, last, step[a] * step[b], points, areas);
            }
            last = next;
          }
        }
      }
    }
    samples.Points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      samples.Points.row(static_cast<Eigen::Index>(i)) = points[i];
    }
    samples.Areas = Eigen::Map<Eigen::VectorXd>(areas.data(), samples.Points.rows());
    samples.Faces.assign(points.size(), 0);
    return samples;
  }

  void AddCrossing(Eigen::Array3d at, int d, double low, double atLow, double cell,
    std::vector<Eigen::RowVector3d>& points, std::vector<double>& areas) const
  {
    double high = at[d];
    Eigen::Vector3d gradient;
    for (int halving = 0; halving < 60; ++halving)
    {
      at[d] = 0.5 * (low + high);
      const bool isLow = (this->Function(at.data(), gradient.data()) < 0.0) == (atLow < 0.0);
      (isLow ? low : high) = at[d];
    }
    this->Function(at.data(), gradient.data());
    const double share = std::abs(gradient[d]) / gradient.norm();
    if (share > 0.0)
    {
      points.emplace_back(at.matrix().transpose());
      areas.push_back(cell * share);
    }
  }

  /// Along the gradient onto the surface.
  bool MoveOnto(Eigen::Vector3d& point, Eigen::Vector3d& normal, double scale) const
  {
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < this->Params.MaxIterations; ++i)
    {
      Eigen::Vector3d gradient;
      const double value = this->Function(point.data(), gradient.data());
      const double square = gradient.squaredNorm();
      if (!std::isfinite(value) || !(square > 0.0))
      {
        return false;
      }
      normal = gradient / std::sqrt(square);
      const double step = std::abs(value) / std::sqrt(square);
      point -= value / square * gradient;
      // at rounding steps do not become shorter
      if (step <= this->Params.Tolerance * scale || (step <= 1e-9 * scale && step >= last))
      {
        return true;
      }
      last = step;
    }
    return false;
  }

  /// On the surface along the query's difference in the tangent plane, as long as that comes
  /// nearer.
  bool Foot(const Eigen::Vector3d& query, Eigen::Vector3d& point, Eigen::Vector3d& normal) const
  {
    point = query;
    const double scale = std::max(query.norm(), 1e-300);
    if (!this->MoveOnto(point, normal, scale))
    {
      return false;
    }
    double share = 1.0;
    for (int i = 0; i < this->Params.MaxIterations; ++i)
    {
      const Eigen::Vector3d difference = query - point;
      const Eigen::Vector3d tangential = difference - difference.dot(normal) * normal;
      if (!(tangential.norm() > this->Params.Tolerance * scale))
      {
        break;
      }
      Eigen::Vector3d next = point + share * tangential;
      Eigen::Vector3d nextNormal = normal;
      const bool isOn = this->MoveOnto(next, nextNormal, scale);
      const Eigen::Vector3d ahead = query - next;
      const Eigen::Vector3d left = ahead - ahead.dot(nextNormal) * nextNormal;
      if (isOn && left.norm() < tangential.norm() &&
        ahead.norm() <= difference.norm() + this->Params.Tolerance * scale)
      {
        point = next;
        normal = nextNormal;
        // as much of the step as was right
        share = std::min(1.0, 2.0 * share);
        if (left.norm() > 0.5 * tangential.norm())
        {
          share *= 0.5;
        }
      }
      else if (share > 1e-12)
      {
        share *= 0.5;
      }
      else
      {
        break;
      }
    }
    return true;
  }

  ImplicitFunction Function;
  ImplicitTargetParams Params;
};
}

Result<FitTargetPtr> MakeImplicitTarget(
  ImplicitFunction function, const ImplicitTargetParams& params)
{
  if (!function)
  {
    return { ErrorCode::EmptyInput, "no implicit function" };
  }
  if (params.MaxIterations < 1 || !(params.Tolerance > 0.0))
  {
    return { ErrorCode::InvalidParameter,
      "an implicit target needs an iteration at least, and a tolerance above 0" };
  }
  return FitTargetPtr(std::make_shared<ImplicitTarget>(std::move(function), params));
}
}
