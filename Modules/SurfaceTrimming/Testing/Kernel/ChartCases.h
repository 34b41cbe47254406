// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TensorSpace.h>
#include <knotwork/SurfaceTrimming/ChartMesh.h>

#include <Eigen/LU>

#include <cmath>
#include <functional>

/// Charts and surfaces that the tests of this module make.
namespace knotwork::testing
{
using Place2 = std::function<Eigen::RowVector2d(int, int)>;
using Place3 = std::function<Eigen::RowVector3d(double, double)>;

/// Cells (i, j) of a grid that are kept, split into triangles; points that no cell has are left
/// out. Columns may close up: point column `columns` is column 0 then. PointIds are grid numbers.
struct GridChart
{
  int Columns = 1;
  int Rows = 1;
  bool Periodic = false;
  Place2 Plane; ///< UV of a grid point
  Place3 Lift;  ///< point in space of its UV
  std::function<bool(int, int)> Keep = [](int, int) { return true; };

  ChartMesh Make() const
  {
    const int points = this->Columns + (this->Periodic ? 0 : 1);
    std::vector<int> number(static_cast<std::size_t>(points * (this->Rows + 1)), -1);
    std::vector<std::array<int, 2>> used;
    ChartMesh chart;
    const auto point = [&](int i, int j)
    {
      i %= points;
      int& n = number[static_cast<std::size_t>(j * points + i)];
      if (n < 0)
      {
        n = static_cast<int>(used.size());
        used.push_back({ i, j });
        chart.PointIds.push_back(j * points + i);
      }
      return n;
    };
    for (int j = 0; j < this->Rows; ++j)
    {
      for (int i = 0; i < this->Columns; ++i)
      {
        if (this->Keep(i, j))
        {
          const int a = point(i, j);
          const int b = point(i + 1, j);
          const int c = point(i + 1, j + 1);
          const int d = point(i, j + 1);
          chart.Triangles.push_back({ a, b, c });
          chart.Triangles.push_back({ a, c, d });
        }
      }
    }
    const Eigen::Index n = static_cast<Eigen::Index>(used.size());
    chart.Points.resize(n, 3);
    chart.UV.resize(n, 2);
    for (Eigen::Index k = 0; k < n; ++k)
    {
      const auto [i, j] = used[static_cast<std::size_t>(k)];
      chart.UV.row(k) = this->Plane(i, j);
      chart.Points.row(k) = this->Lift(chart.UV(k, 0), chart.UV(k, 1));
    }
    return chart;
  }
};

/// [0, 1]^2 in n x n cells without the middle third in both directions (n a multiple of 3).
inline ChartMesh SquareWithSquareHole(int n, const Place3& lift)
{
  GridChart grid;
  grid.Columns = grid.Rows = n;
  grid.Plane = [n](int i, int j)
  { return Eigen::RowVector2d(static_cast<double>(i) / n, static_cast<double>(j) / n); };
  grid.Lift = lift;
  grid.Keep = [n](int i, int j) { return i / (n / 3) != 1 || j / (n / 3) != 1; };
  return grid.Make();
}

/// Between two circles around the origin, counterclockwise.
inline ChartMesh Annulus(int n, int rings, double inner, double outer, const Place3& lift)
{
  GridChart grid;
  grid.Columns = n;
  grid.Rows = rings;
  grid.Periodic = true;
  // columns run clockwise, so that cells are counterclockwise
  grid.Plane = [=](int i, int j)
  {
    const double angle = -2.0 * std::acos(-1.0) * i / n;
    const double r = inner + (outer - inner) * j / rings;
    return Eigen::RowVector2d(r * std::cos(angle), r * std::sin(angle));
  };
  grid.Lift = lift;
  return grid.Make();
}

inline Eigen::RowVector3d Flat(double u, double v)
{
  return { u, v, 0.0 };
}
/// A quadratic graph, which a biquadratic spline is exactly.
inline Eigen::RowVector3d Saddle(double u, double v)
{
  return { u, v, 0.3 * u * u - 0.4 * v * v + 0.2 * u * v };
}

/// Surface of uniform elements that interpolates a function at the Greville points: exact for
/// polynomials of the degree.
inline Spline<2> InterpolatingSurface(
  const Place3& place, int degree, int elements, const Eigen::RowVector4d& box)
{
  const auto space = MakeTensorSpace<2>({ KnotVector::Uniform(degree, elements, box[0], box[1]),
                                          KnotVector::Uniform(degree, elements, box[2], box[3]) })
                       .Value;
  const PointMatrix greville = GrevillePoints(*space);
  PointMatrix values(greville.rows(), 3);
  Eigen::MatrixXd matrix(greville.rows(), greville.rows());
  for (Eigen::Index k = 0; k < greville.rows(); ++k)
  {
    values.row(k) = place(greville(k, 0), greville(k, 1));
  }
  Eigen::MatrixXd lines[2];
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space->Knots[d];
    const int n = knots.NumFunctions();
    lines[d] = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
    {
      const double u = knots.Greville(i);
      const int e = knots.FindElement(u);
      std::vector<double> row(static_cast<std::size_t>(degree + 1));
      knots.EvaluateFunctions(e, u, 0, row.data());
      for (int k = 0; k <= degree; ++k)
      {
        lines[d](i, knots.Span(e) - degree + k) = row[static_cast<std::size_t>(k)];
      }
    }
  }
  const Eigen::Index n0 = lines[0].rows();
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
  {
    for (Eigen::Index l = 0; l < matrix.rows(); ++l)
    {
      matrix(k, l) = lines[0](k % n0, l % n0) * lines[1](k / n0, l / n0);
    }
  }
  return { space, matrix.partialPivLu().solve(Eigen::MatrixXd(values)), {} };
}

/// The same surface over a plane that is moved by a rotation and a shift: S(R^T (u - shift)), as a
/// function to interpolate.
struct Motion
{
  double Angle = 0.0;
  Eigen::RowVector2d Shift = Eigen::RowVector2d::Zero();

  Eigen::RowVector2d Apply(const Eigen::RowVector2d& p) const
  {
    const double c = std::cos(this->Angle);
    const double s = std::sin(this->Angle);
    return Eigen::RowVector2d(c * p[0] - s * p[1], s * p[0] + c * p[1]) + this->Shift;
  }
  Place3 Undo(const Place3& place) const
  {
    return [*this, place](double u, double v)
    {
      const double c = std::cos(this->Angle);
      const double s = std::sin(this->Angle);
      const double x = u - this->Shift[0];
      const double y = v - this->Shift[1];
      return place(c * x + s * y, -s * x + c * y);
    };
  }
};

/// The box of a chart's UV with a margin: u0, u1, v0, v1.
inline Eigen::RowVector4d BoxOf(const ChartMesh& chart, double margin = 0.05)
{
  const Eigen::RowVector2d low = chart.UV.colwise().minCoeff().array() - margin;
  const Eigen::RowVector2d high = chart.UV.colwise().maxCoeff().array() + margin;
  return { low[0], high[0], low[1], high[1] };
}
}
