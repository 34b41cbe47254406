// SPDX-License-Identifier: BSD-3-Clause
#include "SkeletonSampling.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/PointClusters.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace knotwork
{
namespace
{
/// Number of samples to take, from what was asked for.
Result<long long> SampleCount(int samples, int standard)
{
  if (samples != 0 && (samples < 2 || samples > 10000000))
  {
    return { ErrorCode::InvalidParameter,
      "samples of a spline patch must be in [2, 10000000] or 0, not " + std::to_string(samples) };
  }
  return samples == 0 ? standard : samples;
}

/// What a patch of too many points is told.
Status CheckTotal(long long total)
{
  constexpr long long Largest = 100000000;
  return total <= Largest ? Status{}
                          : Status{ ErrorCode::TooLarge,
                              "the samples would be " + std::to_string(total) + ", more than " +
                                std::to_string(Largest) };
}

/// Values of one direction of an element's boxes and, between each two, cuts - 1 more.
class ParameterLines
{
public:
  template <int Dim>
  ParameterLines(const SplineSpace<Dim>& space, std::size_t direction)
  {
    for (const auto& element : space.Elements)
    {
      this->Sides.push_back(element.Box.Lower[direction]);
      this->Sides.push_back(element.Box.Upper[direction]);
    }
    std::sort(this->Sides.begin(), this->Sides.end());
    this->Sides.erase(std::unique(this->Sides.begin(), this->Sides.end()), this->Sides.end());
  }
  long long Count(long long cuts) const
  {
    return (static_cast<long long>(this->Sides.size()) - 1) * cuts + 1;
  }
  Eigen::VectorXd Values(int cuts) const
  {
    Eigen::VectorXd values(this->Count(cuts));
    for (std::size_t i = 0; i + 1 < this->Sides.size(); ++i)
    {
      for (int c = 0; c < cuts; ++c)
      {
        values(static_cast<Eigen::Index>(i) * cuts + c) =
          this->Sides[i] + (this->Sides[i + 1] - this->Sides[i]) * c / cuts;
      }
    }
    values(values.size() - 1) = this->Sides.back();
    return values;
  }

private:
  std::vector<double> Sides;
};

/// Where a direction vanishes it is not one: rows shorter than 1e-9 of the longest take those of
/// the patch without normals.
template <int Dim>
void SetNormals(PointMatrix directions, SkeletonPatch<Dim>& patch)
{
  const Eigen::VectorXd lengths = directions.rowwise().norm();
  const double least = 1e-9 * lengths.maxCoeff();
  if (!(lengths.minCoeff() > least))
  {
    const PointMatrix ofMesh = UnitNormals(patch);
    for (Eigen::Index i = 0; i < directions.rows(); ++i)
    {
      if (!(lengths(i) > least))
      {
        directions.row(i) = ofMesh.row(i);
      }
    }
  }
  patch.Normals = directions.rowwise().normalized();
}

/// Triangles of a grid of (columns + 1) x (rows + 1) points from row first on.
void AddGrid(int columns, int rows, int first, std::vector<std::array<int, 3>>& triangles)
{
  for (int j = 0; j < rows; ++j)
  {
    for (int i = 0; i < columns; ++i)
    {
      const int corner = first + j * (columns + 1) + i;
      triangles.push_back({ corner, corner + 1, corner + columns + 2 });
      triangles.push_back({ corner, corner + columns + 2, corner + columns + 1 });
    }
  }
}

/// A cell's homogeneous coefficients as polynomials of four components, then their derivatives in
/// both directions.
BernsteinCells Derivatives(const BernsteinCells& cells, int cell)
{
  const CellShape shape = cells.Shapes[static_cast<std::size_t>(cell)];
  const CellDegree& degree = cells.Degrees[static_cast<std::size_t>(cell)];
  const auto size = static_cast<std::size_t>(NumCellCoefficients(shape, degree));
  BernsteinCells result;
  result.NumComponents = 4;
  double* whole = result.Block(result.Add(shape, degree));
  std::fill(whole + 3 * size, whole + 4 * size, 1.0);
  std::copy(cells.Block(cell),
    cells.Block(cell) + size * static_cast<std::size_t>(cells.NumPlanes()), whole);
  for (std::size_t d = 0; d < 2; ++d)
  {
    const bool triangle = shape == CellShape::Triangle;
    CellDegree lower = degree;
    lower[0] -= triangle || d == 0 ? 1 : 0;
    lower[1] -= triangle || d == 1 ? 1 : 0;
    const int added = result.Add(shape, lower);
    const double* from = result.Block(0);
    double* to = result.Block(added);
    const auto lowerSize = static_cast<std::size_t>(NumCellCoefficients(shape, lower));
    for (int j = 0; j <= lower[1]; ++j)
    {
      for (int i = 0; i <= (triangle ? lower[0] - j : lower[0]); ++i)
      {
        const auto here = static_cast<std::size_t>(CellCoefficient(shape, degree, i, j, 0));
        const auto next =
          static_cast<std::size_t>(CellCoefficient(shape, degree, i + (d == 0), j + (d == 1), 0));
        const auto place = static_cast<std::size_t>(CellCoefficient(shape, lower, i, j, 0));
        for (std::size_t c = 0; c < 4; ++c)
        {
          to[c * lowerSize + place] = degree[d] * (from[c * size + next] - from[c * size + here]);
        }
      }
    }
  }
  return result;
}

/// Point and normal direction of a cell at local parameters.
void EvaluateWithNormal(const BernsteinCells& derivatives, double u, double v,
  Eigen::RowVector3d& point, Eigen::RowVector3d& normal)
{
  Eigen::RowVector4d values[3];
  for (int k = 0; k < 3; ++k)
  {
    EvaluateCell(derivatives, k, { u, v, 0.0 }, values[k].data());
  }
  const double weight = values[0](3);
  point = values[0].head<3>() / weight;
  const Eigen::RowVector3d alongU = (values[1].head<3>() - values[1](3) * point) / weight;
  const Eigen::RowVector3d alongV = (values[2].head<3>() - values[2](3) * point) / weight;
  normal = alongU.cross(alongV);
}

/// Columns x and y of a curve with a chain of elements; all samples, then the join is checked.
Result<SkeletonPatch<2>> SampleChain(int id, const BezierForm<1>& form, int cuts, double size)
{
  const int numElements = form.Space->NumElements();
  std::vector<int> elements;
  PointMatrix local(static_cast<Eigen::Index>(numElements) * (cuts + 1), 1);
  for (int e = 0; e < numElements; ++e)
  {
    for (int c = 0; c <= cuts; ++c)
    {
      local(static_cast<Eigen::Index>(elements.size()), 0) = double(c) / cuts;
      elements.push_back(e);
    }
  }
  EvaluationBatch batch;
  if (Status status = EvaluateElements(form, elements, local, { 1, 1 }, batch); !status)
  {
    return status;
  }
  SkeletonPatch<2> patch;
  patch.Id = id;
  const Eigen::Index n = static_cast<Eigen::Index>(numElements) * cuts + 1;
  patch.Points.resize(n, 2);
  patch.Parameters.resize(n, 1);
  PointMatrix directions(n, 2);
  for (Eigen::Index i = 0; i < local.rows(); ++i)
  {
    const Eigen::Index element = i / (cuts + 1);
    if (i % (cuts + 1) == 0 && i > 0)
    {
      if (!((batch.Values.row(i) - batch.Values.row(i - 1)).norm() <= 1e-9 * size))
      {
        return { ErrorCode::InvalidTopology,
          "element " + std::to_string(element) + " does not begin where element " +
            std::to_string(element - 1) + " ends: the patch is open" };
      }
      continue;
    }
    const Eigen::Index row = i - element;
    patch.Points.row(row) = batch.Values.row(i).head<2>();
    patch.Parameters(row, 0) = double(element) + local(i, 0);
    directions.row(row) << batch.First(i, 1), -batch.First(i, 0);
  }
  SetNormals(directions, patch);
  return patch;
}
}

Result<SkeletonPatch<2>> SampleCurve(int id, const Spline<1>& curve, int samples)
{
  const Result<long long> count = SampleCount(samples, DefaultCurveSamples);
  if (!count)
  {
    return count.Status;
  }
  const PointMatrix& points = curve.ControlPoints;
  const double size =
    (points.leftCols(2).colwise().maxCoeff() - points.leftCols(2).colwise().minCoeff()).maxCoeff();
  for (Eigen::Index i = 0; points.cols() == 3 && i < points.rows(); ++i)
  {
    if (std::abs(points(i, 2)) > 1e-9 * size)
    {
      return { ErrorCode::DimensionMismatch,
        "control point " + std::to_string(i) + " has z = " + Digits(points(i, 2)) +
          "; curves lie in the plane z = 0, skeletons in space are faces" };
    }
  }
  const BezierForm<1> form = MakeBezierForm(curve, 1);
  if (!curve.Space->HasDomain())
  {
    const int numElements = curve.Space->NumElements();
    const auto cuts = static_cast<int>((count.Value - 2) / numElements + 1);
    return SampleChain(id, form, cuts, size);
  }
  const ParameterLines lines(*curve.Space, 0);
  int cuts = 1;
  while (lines.Count(cuts) < count.Value)
  {
    ++cuts;
  }
  SkeletonPatch<2> patch;
  patch.Id = id;
  patch.Parameters = lines.Values(cuts);
  EvaluationBatch batch;
  if (Status status = EvaluateParameters(form, patch.Parameters, { 1, 1 }, batch); !status)
  {
    return status;
  }
  patch.Points = batch.Values.leftCols(2);
  PointMatrix directions(patch.Points.rows(), 2);
  directions.col(0) = batch.First.col(1);
  directions.col(1) = -batch.First.col(0);
  SetNormals(directions, patch);
  return patch;
}

Result<SkeletonPatch<3>> SampleSurface(int id, const Spline<2>& surface, int samples)
{
  const Result<long long> count = SampleCount(samples, DefaultSurfaceSamples);
  if (!count)
  {
    return count.Status;
  }
  const BezierForm<2> form = MakeBezierForm(surface, 1);
  if (!surface.Space->HasDomain())
  {
    return SampleCells(id, MakeBernsteinCells(form), samples);
  }
  const ParameterLines lines[2] = { { *surface.Space, 0 }, { *surface.Space, 1 } };
  int cuts = 1;
  while (lines[0].Count(cuts) * lines[1].Count(cuts) < count.Value)
  {
    ++cuts;
  }
  if (Status status = CheckTotal(lines[0].Count(cuts) * lines[1].Count(cuts)); !status)
  {
    return status;
  }
  const Eigen::VectorXd u = lines[0].Values(cuts);
  const Eigen::VectorXd v = lines[1].Values(cuts);
  SkeletonPatch<3> patch;
  patch.Id = id;
  patch.Parameters.resize(u.size() * v.size(), 2);
  for (Eigen::Index i = 0; i < patch.Parameters.rows(); ++i)
  {
    patch.Parameters.row(i) << u(i % u.size()), v(i / u.size());
  }
  EvaluationBatch batch;
  if (Status status = EvaluateParameters(form, patch.Parameters, { 1, 1 }, batch); !status)
  {
    return status;
  }
  patch.Points = batch.Values;
  AddGrid(static_cast<int>(u.size()) - 1, static_cast<int>(v.size()) - 1, 0, patch.Simplices);
  PointMatrix directions(patch.Points.rows(), 3);
  for (Eigen::Index i = 0; i < directions.rows(); ++i)
  {
    const Eigen::RowVector3d alongU = batch.First.row(i).head<3>();
    const Eigen::RowVector3d alongV = batch.First.row(i).tail<3>();
    directions.row(i) = alongU.cross(alongV);
  }
  SetNormals(directions, patch);
  return patch;
}

Result<SkeletonPatch<3>> SampleCells(int id, const BernsteinCells& cells, int samples)
{
  const Result<long long> count = SampleCount(samples, DefaultSurfaceSamples);
  if (!count)
  {
    return count.Status;
  }
  const auto isTriangle = [&](int cell)
  { return cells.Shapes[static_cast<std::size_t>(cell)] == CellShape::Triangle; };
  const auto pointsOf = [&](int cell, long long cuts)
  { return isTriangle(cell) ? (cuts + 1) * (cuts + 2) / 2 : (cuts + 1) * (cuts + 1); };
  const auto total = [&](long long cuts)
  {
    long long sum = 0;
    for (int cell = 0; cell < cells.NumCells(); ++cell)
    {
      sum += pointsOf(cell, cuts);
    }
    return sum;
  };
  int cuts = 1;
  while (cells.NumCells() > 0 && total(cuts) < count.Value)
  {
    ++cuts;
  }
  if (Status status = CheckTotal(total(cuts)); !status)
  {
    return status;
  }
  const bool single = cells.NumCells() == 1;
  SkeletonPatch<3> patch;
  patch.Id = id;
  patch.Points.resize(total(cuts), 3);
  patch.Parameters.resize(single ? total(cuts) : 0, 2);
  PointMatrix directions(total(cuts), 3);
  int row = 0;
  for (int cell = 0; cell < cells.NumCells(); ++cell)
  {
    const BernsteinCells derivatives = Derivatives(cells, cell);
    const int first = row;
    for (int j = 0; j <= cuts; ++j)
    {
      const int last = isTriangle(cell) ? cuts - j : cuts;
      for (int i = 0; i <= last; ++i, ++row)
      {
        const double u = double(i) / cuts;
        const double v = double(j) / cuts;
        Eigen::RowVector3d point;
        Eigen::RowVector3d normal;
        EvaluateWithNormal(derivatives, u, v, point, normal);
        patch.Points.row(row) = point;
        directions.row(row) = normal;
        if (single)
        {
          patch.Parameters.row(row) << u, v;
        }
        if (isTriangle(cell) && i < last)
        {
          patch.Simplices.push_back({ row, row + 1, row + last + 1 });
          if (i + 1 < last)
          {
            patch.Simplices.push_back({ row + 1, row + last + 2, row + last + 1 });
          }
        }
      }
    }
    if (!isTriangle(cell))
    {
      AddGrid(cuts, cuts, first, patch.Simplices);
    }
  }
  // Copies on common sides differ by rounding.
  PointClusters clusters(3, patch.Points.cwiseAbs().maxCoeff() * PointClusters::RelativeTolerance);
  std::vector<Eigen::Index> firstOf;
  for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
  {
    const auto number = static_cast<std::size_t>(clusters.Number(patch.Points.row(i).data()));
    if (number == firstOf.size())
    {
      firstOf.push_back(i);
    }
    patch.Points.row(i) = patch.Points.row(firstOf[number]);
  }
  SetNormals(directions, patch);
  return patch;
}
}
