// SPDX-License-Identifier: BSD-3-Clause
#include "Skeleton.h"
#include "Numbers.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <string>

namespace knotwork
{
namespace
{
std::string Name(const char* skeleton, int id)
{
  return std::string(skeleton) + " patch " + std::to_string(id);
}

template <int Dim>
double Length(const PointMatrix& points)
{
  double length = 0.0;
  for (Eigen::Index i = 1; i < points.rows(); ++i)
  {
    length += (points.row(i) - points.row(i - 1)).norm();
  }
  return length;
}

/// Index of the first row that is not finite, or -1.
Eigen::Index FirstNonFinite(const PointMatrix& rows)
{
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    if (!rows.row(i).allFinite())
    {
      return i;
    }
  }
  return -1;
}

template <int Dim>
Status CheckPatch(const char* skeleton, const SkeletonPatch<Dim>& patch)
{
  const std::string name = Name(skeleton, patch.Id);
  const Eigen::Index n = patch.Points.rows();
  if (n < 2)
  {
    return { ErrorCode::InvalidTopology,
      name + " has " + std::to_string(n) + " points; a patch needs at least 2" };
  }
  if (patch.Points.cols() != Dim)
  {
    return { ErrorCode::DimensionMismatch,
      name + " has points of " + std::to_string(patch.Points.cols()) + " coordinates, not " +
        std::to_string(Dim) };
  }
  struct Part
  {
    const char* What;
    const PointMatrix& Rows;
    int Columns;
  };
  for (const Part& part : { Part{ "point", patch.Points, Dim },
         Part{ "parameter", patch.Parameters, Dim - 1 }, Part{ "normal", patch.Normals, Dim } })
  {
    if (part.Rows.size() > 0 && (part.Rows.rows() != n || part.Rows.cols() != part.Columns))
    {
      return { ErrorCode::SizeMismatch,
        name + " has " + std::to_string(n) + " points but " + std::to_string(part.Rows.rows()) +
          " x " + std::to_string(part.Rows.cols()) + " values as " + part.What + "s" };
    }
    const Eigen::Index bad = FirstNonFinite(part.Rows);
    if (bad >= 0)
    {
      return { ErrorCode::NonFiniteInput, name + ", " + part.What + " " + std::to_string(bad) };
    }
    if (!AllWithinLimit(part.Rows))
    {
      return { ErrorCode::TooLarge, name + ", a " + part.What + ": " + BeyondLimit() };
    }
  }
  if (!(Length<Dim>(patch.Points) > 0.0))
  {
    return { ErrorCode::InvalidTopology,
      name + " is a single point; remove it or give it a length" };
  }
  for (Eigen::Index i = 0; i < patch.Normals.rows(); ++i)
  {
    if (!(patch.Normals.row(i).norm() > 0.0))
    {
      return { ErrorCode::InvalidParameter, name + ", normal " + std::to_string(i) + " is zero" };
    }
  }
  return {};
}

template <int Dim>
Status CheckIds(const char* skeleton, const Skeleton<Dim>& patches, std::set<int>& ids)
{
  for (const SkeletonPatch<Dim>& patch : patches)
  {
    if (!ids.insert(patch.Id).second)
    {
      return { ErrorCode::InvalidTopology,
        std::string("two patches of the ") + skeleton + " have the id " +
          std::to_string(patch.Id) };
    }
  }
  return {};
}

std::string Join(const std::set<int>& ids)
{
  std::string text;
  for (int id : ids)
  {
    text += (text.empty() ? "" : ", ") + std::to_string(id);
  }
  return text;
}
}

template <int Dim>
Status CheckSkeletons(const Skeleton<Dim>& templateSkeleton, const Skeleton<Dim>& target)
{
  if (templateSkeleton.empty() || target.empty())
  {
    return { ErrorCode::EmptyInput,
      templateSkeleton.empty() ? "the template has no patches" : "the target has no patches" };
  }
  std::set<int> templateIds;
  std::set<int> targetIds;
  if (Status ids = CheckIds("template", templateSkeleton, templateIds); !ids)
  {
    return ids;
  }
  if (Status ids = CheckIds("target", target, targetIds); !ids)
  {
    return ids;
  }
  std::set<int> lost;
  std::set_difference(targetIds.begin(), targetIds.end(), templateIds.begin(), templateIds.end(),
    std::inserter(lost, lost.end()));
  if (!lost.empty())
  {
    return { ErrorCode::InvalidTopology,
      "target patches " + Join(lost) + " have no patch of the same id in the template, which has " +
        Join(templateIds) };
  }
  for (const SkeletonPatch<Dim>& patch : templateSkeleton)
  {
    if (Status status = CheckPatch("template", patch); !status)
    {
      return status;
    }
    for (Eigen::Index i = 1; i < patch.Parameters.rows(); ++i)
    {
      if (!(patch.Parameters(i, 0) > patch.Parameters(i - 1, 0)))
      {
        return { ErrorCode::InvalidParameter,
          Name("template", patch.Id) + ", point " + std::to_string(i) +
            ": parameters must increase from point to point" };
      }
    }
  }
  for (const SkeletonPatch<Dim>& patch : target)
  {
    if (Status status = CheckPatch("target", patch); !status)
    {
      return status;
    }
    const SkeletonPatch<Dim>& source = *std::find_if(templateSkeleton.begin(),
      templateSkeleton.end(), [&](const SkeletonPatch<Dim>& t) { return t.Id == patch.Id; });
    const bool given = source.Parameters.rows() > 0;
    const double begin = given ? source.Parameters(0, 0) : 0.0;
    const double end = given ? source.Parameters(source.Parameters.rows() - 1, 0) : 1.0;
    const double slack = 1e-6 * (end - begin); // parameters may have been single precision
    for (Eigen::Index i = 0; i < patch.Parameters.rows(); ++i)
    {
      const double t = patch.Parameters(i, 0);
      if (t < begin - slack || t > end + slack)
      {
        return { ErrorCode::InvalidParameter,
          Name("target", patch.Id) + ", point " + std::to_string(i) + ": parameter " +
            std::to_string(t) + " is outside the template patch's [" + std::to_string(begin) +
            ", " + std::to_string(end) + "]" };
      }
    }
  }
  return {};
}

template <int Dim>
ParametricBox<Dim> BoundingBox(const Skeleton<Dim>& skeleton)
{
  ParametricBox<Dim> box;
  box.Lower.fill(std::numeric_limits<double>::infinity());
  box.Upper.fill(-std::numeric_limits<double>::infinity());
  for (const SkeletonPatch<Dim>& patch : skeleton)
  {
    for (int d = 0; d < Dim; ++d)
    {
      const std::size_t k = static_cast<std::size_t>(d);
      box.Lower[k] = std::min(box.Lower[k], patch.Points.col(d).minCoeff());
      box.Upper[k] = std::max(box.Upper[k], patch.Points.col(d).maxCoeff());
    }
  }
  return box;
}

PointMatrix ParametersOrUniform(const SkeletonPatch<2>& patch, double begin, double end)
{
  if (patch.Parameters.rows() > 0)
  {
    return patch.Parameters;
  }
  const Eigen::Index n = patch.Points.rows();
  PointMatrix uniform(n, 1);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    uniform(i, 0) = begin + (end - begin) * double(i) / double(n - 1);
  }
  return uniform;
}

PointMatrix UnitNormals(const SkeletonPatch<2>& patch)
{
  if (patch.Normals.rows() > 0)
  {
    return patch.Normals.rowwise().normalized();
  }
  const PointMatrix& p = patch.Points;
  const Eigen::Index n = p.rows();
  const double joint = 1e-9 * Length<2>(p); // ends computed by different roundings
  const bool closed = n > 2 && (p.row(0) - p.row(n - 1)).norm() <= joint;
  // The next point that is not the point itself, in the direction of step; i where there is none.
  const auto neighbour = [&](Eigen::Index i, Eigen::Index step)
  {
    Eigen::Index k = i;
    for (Eigen::Index count = 0; count < n; ++count)
    {
      k += step;
      if (k < 0 || k >= n)
      {
        if (!closed)
        {
          return i;
        }
        k = k < 0 ? n - 2 : 1;
      }
      if (p.row(k) != p.row(i))
      {
        return k;
      }
    }
    return i;
  };
  PointMatrix normals(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    Eigen::RowVector2d tangent = p.row(neighbour(i, 1)) - p.row(neighbour(i, -1));
    if (!(tangent.norm() > 0.0)) // a spike: the way in
    {
      tangent = p.row(i) - p.row(neighbour(i, -1));
    }
    tangent.normalize();
    normals.row(i) << tangent.y(), -tangent.x();
  }
  return normals;
}

PatchCurve::PatchCurve(PointMatrix points, Eigen::VectorXd parameters)
  : Points(std::move(points)), Parameters(std::move(parameters))
{
}

void PatchCurve::Evaluate(double t, double* point, double* derivative) const
{
  const double* first = this->Parameters.data();
  const Eigen::Index n = this->Parameters.size();
  t = std::min(std::max(t, this->Begin()), this->End());
  // Parameters are often equally spaced: guess, and search only when the guess is wrong.
  const double guess = double(n - 1) * ((t - this->Begin()) / (this->End() - this->Begin()));
  Eigen::Index piece = std::min(static_cast<Eigen::Index>(guess), n - 2);
  if (!(first[piece] <= t && (t < first[piece + 1] || piece == n - 2)))
  {
    piece = std::min<Eigen::Index>(std::upper_bound(first, first + n, t) - first - 1, n - 2);
  }
  const double width = first[piece + 1] - first[piece];
  const double share = (t - first[piece]) / width;
  for (Eigen::Index d = 0; d < this->Points.cols(); ++d)
  {
    const double a = this->Points(piece, d);
    const double b = this->Points(piece + 1, d);
    point[d] = share == 1.0 ? b : a + share * (b - a); // vertices exactly
    if (derivative)
    {
      derivative[d] = (b - a) / width;
    }
  }
}

Eigen::VectorXd PatchCurve::SampleParameters(int count) const
{
  if (count == 0)
  {
    return this->Parameters;
  }
  Eigen::VectorXd samples(count);
  for (int i = 0; i < count; ++i)
  {
    samples(i) = this->Begin() + (this->End() - this->Begin()) * i / (count - 1);
  }
  samples(count - 1) = this->End();
  return samples;
}

template Status CheckSkeletons(const Skeleton<2>&, const Skeleton<2>&);
template ParametricBox<2> BoundingBox(const Skeleton<2>&);
}
