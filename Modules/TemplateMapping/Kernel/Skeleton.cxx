// SPDX-License-Identifier: BSD-3-Clause
#include "Skeleton.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Geometry>

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

double Length(const PointMatrix& points)
{
  double length = 0.0;
  for (Eigen::Index i = 1; i < points.rows(); ++i)
  {
    length += (points.row(i) - points.row(i - 1)).norm();
  }
  return length;
}

/// Normal of a triangle in space, as long as twice its area.
Eigen::RowVector3d AreaNormal(const PointMatrix& points, const MeshTriangle& t)
{
  const Eigen::RowVector3d ab = points.row(t[1]) - points.row(t[0]);
  const Eigen::RowVector3d ac = points.row(t[2]) - points.row(t[0]);
  return ab.cross(ac);
}

/// Twice the signed area of a triangle in the plane.
double TurnOf(const PointMatrix& points, int a, int b, int c)
{
  const Eigen::RowVector2d ab = points.row(b) - points.row(a);
  const Eigen::RowVector2d ac = points.row(c) - points.row(a);
  return ab.x() * ac.y() - ab.y() * ac.x();
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

/// The patch has a length.
Status CheckExtent(const std::string& name, const SkeletonPatch<2>& patch)
{
  if (!patch.Simplices.empty())
  {
    return { ErrorCode::SizeMismatch,
      name + " lists segments; those of a polyline are its consecutive points" };
  }
  if (!(Length(patch.Points) > 0.0))
  {
    return { ErrorCode::InvalidTopology,
      name + " is a single point; remove it or give it a length" };
  }
  return {};
}

/// The patch has triangles of its points, none without, and an area.
Status CheckExtent(const std::string& name, const SkeletonPatch<3>& patch)
{
  const auto n = static_cast<std::size_t>(patch.Points.rows());
  if (patch.Simplices.empty())
  {
    return { ErrorCode::InvalidTopology,
      name + " has no triangles; remove it or give it a surface" };
  }
  std::vector<bool> used(n, false);
  double area = 0.0;
  double edges = 0.0;
  for (std::size_t t = 0; t < patch.Simplices.size(); ++t)
  {
    const MeshTriangle& corners = patch.Simplices[t];
    for (int corner : corners)
    {
      if (corner < 0 || static_cast<std::size_t>(corner) >= n)
      {
        return { ErrorCode::InvalidTopology,
          name + ", triangle " + std::to_string(t) + " has the point " + std::to_string(corner) +
            " of " + std::to_string(n) };
      }
      used[static_cast<std::size_t>(corner)] = true;
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    {
      return { ErrorCode::InvalidTopology,
        name + ", triangle " + std::to_string(t) + " has a corner twice; remove it" };
    }
    area += 0.5 * AreaNormal(patch.Points, corners).norm();
    const auto from = patch.Points.row(corners[0]);
    edges +=
      (patch.Points.row(corners[1]) - from).norm() + (patch.Points.row(corners[2]) - from).norm();
  }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end())
  {
    return { ErrorCode::InvalidTopology,
      name + ", point " + std::to_string(unused - used.begin()) +
        " belongs to no triangle; remove it" };
  }
  // Triangles on a line have an area of rounding errors: those of coordinates, times edges.
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double rounding = 4.0 * epsilon * patch.Points.cwiseAbs().maxCoeff() * edges;
  const double size =
    (patch.Points.colwise().maxCoeff() - patch.Points.colwise().minCoeff()).squaredNorm();
  if (!(area > 1e-12 * size + rounding))
  {
    return { ErrorCode::InvalidTopology,
      name + " lies on a line or a point; remove it or give it an area" };
  }
  return {};
}

/// Parameters of a template polyline increase.
Status CheckParameters(const std::string& name, const SkeletonPatch<2>& patch)
{
  for (Eigen::Index i = 1; i < patch.Parameters.rows(); ++i)
  {
    if (!(patch.Parameters(i, 0) > patch.Parameters(i - 1, 0)))
    {
      return { ErrorCode::InvalidParameter,
        name + ", point " + std::to_string(i) + ": parameters must increase from point to point" };
    }
  }
  return {};
}

/// Parameters of a template mesh do not fold: triangles lie on the two sides of their common edge.
Status CheckParameters(const std::string& name, const SkeletonPatch<3>& patch)
{
  const PointMatrix& parameters = patch.Parameters;
  if (parameters.rows() == 0)
  {
    return {};
  }
  const std::vector<MeshTriangle> neighbours = TriangleNeighbours(patch.Simplices);
  const double rounding =
    1e-14 * (parameters.colwise().maxCoeff() - parameters.colwise().minCoeff()).squaredNorm();
  double area = 0.0;
  for (std::size_t t = 0; t < neighbours.size(); ++t)
  {
    const MeshTriangle& corners = patch.Simplices[t];
    const double own = TurnOf(parameters, corners[0], corners[1], corners[2]);
    area += 0.5 * std::abs(own);
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (neighbours[t][k] < 0)
      {
        continue;
      }
      const auto other = static_cast<std::size_t>(neighbours[t][k]);
      const MeshTriangle& back = neighbours[other];
      const auto edge = static_cast<std::size_t>(
        std::find(back.begin(), back.end(), static_cast<int>(t)) - back.begin());
      const double beyond = TurnOf(
        parameters, corners[k], corners[(k + 1) % 3], patch.Simplices[other][(edge + 2) % 3]);
      if (std::min(std::abs(own), std::abs(beyond)) > rounding && (own > 0.0) == (beyond > 0.0))
      {
        return { ErrorCode::InvalidParameter,
          name + ", triangles " + std::to_string(std::min(t, other)) + " and " +
            std::to_string(std::max(t, other)) +
            ": parameters fold over the common edge; repeat the points along a seam or leave the "
            "parameters away" };
      }
    }
  }
  if (!(area > rounding))
  {
    return { ErrorCode::InvalidParameter,
      name + ": the parameters of its points lie on a line; leave them away" };
  }
  return {};
}

/// Signs that turn the triangles alike across shared edges, 1 for the first of each connected part.
std::vector<double> AlikeTurns(
  const std::vector<MeshTriangle>& triangles, const std::vector<MeshTriangle>& neighbours)
{
  std::vector<double> turns(triangles.size(), 0.0);
  std::vector<std::size_t> front;
  for (std::size_t seed = 0; seed < triangles.size(); ++seed)
  {
    if (turns[seed] != 0.0)
    {
      continue;
    }
    turns[seed] = 1.0;
    front.push_back(seed);
    while (!front.empty())
    {
      const std::size_t t = front.back();
      front.pop_back();
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int next = neighbours[t][k];
        if (next < 0 || turns[static_cast<std::size_t>(next)] != 0.0)
        {
          continue;
        }
        const auto u = static_cast<std::size_t>(next);
        const auto edge = static_cast<std::size_t>(
          std::find(neighbours[u].begin(), neighbours[u].end(), static_cast<int>(t)) -
          neighbours[u].begin());
        const bool opposite = triangles[t][k] == triangles[u][(edge + 1) % 3];
        turns[u] = opposite ? turns[t] : -turns[t];
        front.push_back(u);
      }
    }
  }
  return turns;
}

template <int Dim>
Status CheckPatch(const char* skeleton, const SkeletonPatch<Dim>& patch)
{
  const std::string name = Name(skeleton, patch.Id);
  const Eigen::Index n = patch.Points.rows();
  if (n < Dim)
  {
    return { ErrorCode::InvalidTopology,
      name + " has " + std::to_string(n) + " points; a patch needs at least " +
        std::to_string(Dim) };
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
  if (Status extent = CheckExtent(name, patch); !extent)
  {
    return extent;
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

/// Target parameters lie in the range of the template patch's.
template <int Dim>
Status CheckRange(const SkeletonPatch<Dim>& source, const SkeletonPatch<Dim>& patch)
{
  if (Dim == 3 && source.Parameters.rows() == 0)
  {
    return {}; // not read
  }
  for (Eigen::Index d = 0; d < patch.Parameters.cols(); ++d)
  {
    const bool given = source.Parameters.rows() > 0;
    const double begin = given ? source.Parameters.col(d).minCoeff() : 0.0;
    const double end = given ? source.Parameters.col(d).maxCoeff() : 1.0;
    const double slack = 1e-6 * (end - begin); // parameters may have been single precision
    for (Eigen::Index i = 0; i < patch.Parameters.rows(); ++i)
    {
      const double t = patch.Parameters(i, d);
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
    if (Status status = CheckParameters(Name("template", patch.Id), patch); !status)
    {
      return status;
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
    if (Status status = CheckRange(source, patch); !status)
    {
      return status;
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
  const double joint = 1e-9 * Length(p); // ends computed by different roundings
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

PointMatrix UnitNormals(const SkeletonPatch<3>& patch)
{
  if (patch.Normals.rows() > 0)
  {
    return patch.Normals.rowwise().normalized();
  }
  const std::vector<int> first = FirstOfEqualPoints(patch.Points);
  const std::vector<MeshTriangle> triangles = ReplaceCorners(patch.Simplices, first);
  const std::vector<double> turns = AlikeTurns(triangles, TriangleNeighbours(triangles));
  const Eigen::Index n = patch.Points.rows();
  PointMatrix sums = PointMatrix::Zero(n, 3);
  PointMatrix largest = PointMatrix::Zero(n, 3); // of the triangles around, for sums that vanish
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const Eigen::RowVector3d normal = turns[t] * AreaNormal(patch.Points, triangles[t]);
    for (int corner : triangles[t])
    {
      sums.row(corner) += normal;
      if (normal.squaredNorm() > largest.row(corner).squaredNorm())
      {
        largest.row(corner) = normal;
      }
    }
  }
  std::vector<int> missing; // first points of equal ones without a direction
  for (Eigen::Index i = 0; i < n; ++i)
  {
    if (first[static_cast<std::size_t>(i)] == i)
    {
      // The sum of opposite normals is rounding.
      const bool vanishes = sums.row(i).norm() <= 1e-9 * largest.row(i).norm();
      sums.row(i) = vanishes ? largest.row(i) : sums.row(i);
      sums.row(i).normalize(); // zero stays zero
      if (sums.row(i).isZero(0.0))
      {
        missing.push_back(static_cast<int>(i));
      }
    }
  }
  for (bool grows = !missing.empty(); grows;)
  {
    PointMatrix next = sums;
    for (const MeshTriangle& corners : triangles)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        if (sums.row(corners[k]).isZero(0.0))
        {
          next.row(corners[k]) += sums.row(corners[(k + 1) % 3]) + sums.row(corners[(k + 2) % 3]);
        }
      }
    }
    grows = false;
    for (int i : missing)
    {
      grows = grows || (sums.row(i).isZero(0.0) && !next.row(i).isZero(0.0));
      next.row(i).normalize();
    }
    sums = std::move(next);
  }
  for (Eigen::Index i = 0; i < n; ++i)
  {
    sums.row(i) = sums.row(first[static_cast<std::size_t>(i)]);
  }
  return sums;
}

template Status CheckSkeletons(const Skeleton<2>&, const Skeleton<2>&);
template Status CheckSkeletons(const Skeleton<3>&, const Skeleton<3>&);
template ParametricBox<2> BoundingBox(const Skeleton<2>&);
template ParametricBox<3> BoundingBox(const Skeleton<3>&);
}
