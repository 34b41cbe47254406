// SPDX-License-Identifier: BSD-3-Clause
#include "TangentPlanes.h"

#include "Bernstein.h"
#include "Quadrature.h"
#include "VertexWindow.h"

#include <Eigen/Dense>

#include <algorithm>
#include <map>
#include <set>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Distance from the plane, as share of the points' extent, at which they lie in it: normals differ
/// by less than 1e-7 degrees.
constexpr double InPlane = 1e-10;
constexpr int MostSweeps = 1000;

/// Integrals over the mesh of products of functions, where they are asked for.
class Integrals
{
public:
  explicit Integrals(const SplineSpace<2>& space)
    : Space(space), Cells(At(space.NumFunctions)), Local(MakeLocal(space.Unstructured->Degree))
  {
    for (int e = 0; e < space.NumElements(); ++e)
    {
      for (const int function : space.AliveFunctions(e))
      {
        this->Cells[At(function)].push_back(e);
      }
    }
  }

  /// Of functions with each other.
  Eigen::MatrixXd Gram(const std::vector<int>& functions) const
  {
    const auto size = static_cast<Eigen::Index>(functions.size());
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(size, size);
    this->ForCells(functions,
      [&](int, const std::vector<int>& alive, const Eigen::MatrixXd& extraction, double area)
      {
        const Eigen::MatrixXd own = extraction * this->Local * extraction.transpose() * area;
        for (std::size_t a = 0; a < alive.size(); ++a)
        {
          for (std::size_t b = 0; b < alive.size(); ++b)
          {
            if (alive[a] >= 0 && alive[b] >= 0)
            {
              gram(alive[a], alive[b]) +=
                own(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
            }
          }
        }
      });
    return gram;
  }

  /// Of functions with what a surface lacks to the interpolation of the vertices.
  Eigen::MatrixX3d Lack(const std::vector<int>& functions, const PointMatrix& controlPoints,
    const PointMatrix& vertices) const
  {
    const int p = this->Space.Unstructured->Degree;
    const auto rule = MakeElementQuadrature<2>({ p + 2, p + 2 });
    Eigen::MatrixXd basis(rule.Local.rows(), (p + 1) * (p + 1));
    for (Eigen::Index q = 0; q < basis.rows(); ++q)
    {
      double u[MaxDegree + 1];
      double v[MaxDegree + 1];
      BernsteinValues(p, rule.Local(q, 0), u);
      BernsteinValues(p, rule.Local(q, 1), v);
      for (int i = 0; i < basis.cols(); ++i)
      {
        basis(q, i) = u[i % (p + 1)] * v[i / (p + 1)];
      }
    }
    Eigen::MatrixX3d lack = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(functions.size()), 3);
    PointMatrix target(rule.Local.rows(), vertices.cols());
    this->ForCells(functions,
      [&](int cell, const std::vector<int>& alive, const Eigen::MatrixXd& extraction, double area)
      {
        InterpolateAround(*this->Space.Unstructured, cell, rule.Local, vertices, target);
        const std::vector<int> ids = this->Space.AliveFunctions(cell);
        Eigen::MatrixX3d own(static_cast<Eigen::Index>(ids.size()), 3);
        for (std::size_t a = 0; a < ids.size(); ++a)
        {
          own.row(static_cast<Eigen::Index>(a)) = controlPoints.row(ids[a]).head<3>();
        }
        const Eigen::MatrixXd values = basis * extraction.transpose(); // of the alive functions
        const Eigen::MatrixX3d missing =
          rule.Weights.asDiagonal() * (target.leftCols<3>() - values * own);
        const Eigen::MatrixX3d shares = values.transpose() * missing * area;
        for (std::size_t a = 0; a < alive.size(); ++a)
        {
          if (alive[a] >= 0)
          {
            lack.row(alive[a]) += shares.row(static_cast<Eigen::Index>(a));
          }
        }
      });
    return lack;
  }

private:
  /// Visits the cells of functions: visit(cell, places of the alive functions among them or -1,
  /// extraction, area).
  template <typename Visit>
  void ForCells(const std::vector<int>& functions, const Visit& visit) const
  {
    std::set<int> cells;
    for (const int function : functions)
    {
      cells.insert(this->Cells[At(function)].begin(), this->Cells[At(function)].end());
    }
    for (const int cell : cells)
    {
      std::vector<int> places = this->Space.AliveFunctions(cell);
      for (int& place : places)
      {
        const auto found = std::lower_bound(functions.begin(), functions.end(), place);
        place = found != functions.end() && *found == place
          ? static_cast<int>(found - functions.begin())
          : -1;
      }
      visit(cell, places, this->Space.ExtractionOperator(cell),
        this->Space.Unstructured->Length(cell, 0) * this->Space.Unstructured->Length(cell, 1));
    }
  }

  /// Of the Bernstein polynomials of two parameters on the unit square.
  static Eigen::MatrixXd MakeLocal(int p)
  {
    const int n = p + 1;
    Eigen::MatrixXd local(n * n, n * n);
    const auto line = [p](int j, int k)
    { return Binomial(p, j) * Binomial(p, k) / ((2 * p + 1) * Binomial(2 * p, j + k)); };
    for (int a = 0; a < n * n; ++a)
    {
      for (int b = 0; b < n * n; ++b)
      {
        local(a, b) = line(a % n, b % n) * line(a / n, b / n);
      }
    }
    return local;
  }

  const SplineSpace<2>& Space;
  std::vector<std::vector<int>> Cells; ///< of every function
  Eigen::MatrixXd Local;
};

/// Functions of a local coefficient, with their shares.
std::vector<std::pair<int, double>> RowOf(const SplineSpace<2>& space, int local)
{
  if (space.IsIdentityMap())
  {
    return { { local, 1.0 } };
  }
  std::vector<std::pair<int, double>> row;
  for (std::size_t i = space.RowStart[At(local)]; i < space.RowStart[At(local) + 1]; ++i)
  {
    row.emplace_back(space.RowFunction[i], space.RowCoefficient[i]);
  }
  return row;
}

/// An extraordinary point: the local coefficients of its corner and next to it on its edges, which
/// are combinations of control points.
class Star
{
public:
  /// @param locals  of the corner, and next to it on the edges where one comes from the cell before
  /// and goes to the next one.
  void Add(const SplineSpace<2>& space, int cell, const std::array<int, 3>& locals)
  {
    std::array<Eigen::Index, 3> numbers{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto row = RowOf(space, locals[i]);
      const auto found = std::find(this->Rows.begin(), this->Rows.end(), row);
      numbers[i] = found - this->Rows.begin();
      if (found == this->Rows.end())
      {
        this->Rows.push_back(row);
      }
    }
    this->Corners.push_back(numbers);
    this->Cells.push_back(cell);
  }

  /// Whether cells lie over each other when they are laid into a plane, as at a sharp corner.
  bool IsFolded(const PointMatrix& points) const
  {
    Eigen::MatrixX3d coefficients = this->Coefficients(points);
    coefficients.rowwise() -= coefficients.colwise().mean().eval();
    const Eigen::JacobiSVD<Eigen::MatrixX3d> parts(coefficients, Eigen::ComputeFullV);
    bool isLeft = false;
    bool isRight = false;
    for (const auto& [corner, in, out] : this->Corners)
    {
      const Eigen::Vector3d a = coefficients.row(in) - coefficients.row(corner);
      const Eigen::Vector3d b = coefficients.row(out) - coefficients.row(corner);
      const double turn = a.cross(b).dot(parts.matrixV().col(2));
      isLeft = isLeft || turn >= 0.0;
      isRight = isRight || turn <= 0.0;
    }
    return isLeft && isRight;
  }

  /// Functions that determine the coefficients.
  std::set<int> OwnFunctions() const
  {
    std::set<int> own;
    for (const auto& row : this->Rows)
    {
      for (const auto& [function, coefficient] : row)
      {
        own.insert(function);
      }
    }
    return own;
  }

  /// What moves: the own functions, and those around that no star has.
  void Finish(const SplineSpace<2>& space, const Integrals& integrals, const std::set<int>& ofStars)
  {
    std::set<int> moved = this->OwnFunctions();
    for (const int cell : this->Cells)
    {
      for (const int function : space.AliveFunctions(cell))
      {
        if (ofStars.count(function) == 0)
        {
          moved.insert(function);
        }
      }
    }
    this->Functions.assign(moved.begin(), moved.end());
    this->Matrix.setZero(static_cast<Eigen::Index>(this->Rows.size()),
      static_cast<Eigen::Index>(this->Functions.size()));
    for (std::size_t i = 0; i < this->Rows.size(); ++i)
    {
      for (const auto& [function, coefficient] : this->Rows[i])
      {
        const auto at = std::lower_bound(this->Functions.begin(), this->Functions.end(), function);
        this->Matrix(static_cast<Eigen::Index>(i), at - this->Functions.begin()) = coefficient;
      }
    }
    this->Gram = integrals.Gram(this->Functions);
    const Eigen::MatrixXd back =
      this->Gram.ldlt().solve(this->Matrix.transpose()); // shares of the moves
    this->Metric = (this->Matrix * back).completeOrthogonalDecomposition().pseudoInverse();
    this->Moves = back * this->Metric;
  }

  /// Moves control points 0.6 of the way to where the surface is as near to the vertices'
  /// interpolation as can be: all of it would cost smoothness across creases.
  void Approach(const Integrals& integrals, const PointMatrix& vertices, PointMatrix& points) const
  {
    const Eigen::MatrixX3d moves =
      this->Gram.ldlt().solve(integrals.Lack(this->Functions, points, vertices));
    for (std::size_t f = 0; f < this->Functions.size(); ++f)
    {
      points.row(this->Functions[f]).head<3>() += 0.6 * moves.row(static_cast<Eigen::Index>(f));
    }
  }

  /// Moves control points so that the coefficients lie in a plane, and the surface as little as can
  /// be in the mean square. @return how far they were from a plane, as share of their extent;
  /// negative when they have none.
  double Flatten(PointMatrix& points) const
  {
    Eigen::MatrixX3d coefficients = this->Coefficients(points);
    coefficients.rowwise() -= coefficients.colwise().mean().eval();
    const Eigen::JacobiSVD<Eigen::MatrixX3d> parts(coefficients, Eigen::ComputeFullV);
    const Eigen::Vector3d sizes = parts.singularValues();
    if (!(sizes[1] > 1e-9 * sizes[0]))
    {
      return -1.0;
    }
    // heights over the plane of least squares, from that plane over it that is the nearest
    const Eigen::VectorXd heights = coefficients * parts.matrixV().col(2);
    Eigen::MatrixX3d planes(coefficients.rows(), 3);
    planes << Eigen::VectorXd::Ones(coefficients.rows()),
      coefficients * parts.matrixV().leftCols<2>() / sizes[0];
    const Eigen::Matrix3d normalEquations = planes.transpose() * this->Metric * planes;
    const Eigen::Vector3d plane =
      normalEquations.ldlt().solve(planes.transpose() * (this->Metric * heights));
    const Eigen::VectorXd moves = this->Moves * (heights - planes * plane);
    for (std::size_t f = 0; f < this->Functions.size(); ++f)
    {
      points.row(this->Functions[f]).head<3>() -=
        moves[static_cast<Eigen::Index>(f)] * parts.matrixV().col(2).transpose();
    }
    return heights.cwiseAbs().maxCoeff() / coefficients.rowwise().norm().maxCoeff();
  }

private:
  Eigen::MatrixX3d Coefficients(const PointMatrix& points) const
  {
    Eigen::MatrixX3d coefficients =
      Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(this->Rows.size()), 3);
    for (std::size_t i = 0; i < this->Rows.size(); ++i)
    {
      for (const auto& [function, share] : this->Rows[i])
      {
        coefficients.row(static_cast<Eigen::Index>(i)) += share * points.row(function).head<3>();
      }
    }
    return coefficients;
  }

  std::vector<std::vector<std::pair<int, double>>> Rows; ///< functions and their shares
  std::vector<std::array<Eigen::Index, 3>> Corners;      ///< rows of every cell, in their turn
  std::vector<int> Cells;
  std::vector<int> Functions; ///< that are moved, ascending
  Eigen::MatrixXd Gram;       ///< of the functions that are moved
  Eigen::MatrixXd Matrix;     ///< coefficients from control points
  Eigen::MatrixXd Metric;     ///< mean square of the surface's moves by those of the coefficients
  Eigen::MatrixXd Moves;      ///< control points' from those of the coefficients
};

/// The stars of extraordinary points, not finished; points that are left out are counted.
std::vector<Star> FindStars(const SplineSpace<2>& space, const std::vector<CellSide>& features,
  const PointMatrix& points, int& numLeftOut)
{
  const UnstructuredData<2>& data = *space.Unstructured;
  std::vector<char> isFeature(data.Continuity.size(), 0);
  for (const CellSide& side : features)
  {
    isFeature[At(4 * side.Cell + side.Side)] = 1;
    isFeature[At(4 * data.Topology.Neighbour(side.Cell, side.Side) +
      data.Topology.Crossing(side.Cell, side.Side).Side)] = 1;
  }
  std::vector<char> isDone(At(data.Mesh.NumPoints), 0);
  std::vector<Star> stars;
  const int p = data.Degree;
  for (int c = 0; c < data.Topology.NumCells(); ++c)
  {
    for (int ridge = 0; ridge < 4; ++ridge)
    {
      const int point = data.Mesh.Cell(c)[ridge];
      if (!data.Topology.IsExtraordinary(c, ridge) || isDone[At(point)]++ != 0)
      {
        continue;
      }
      Star star;
      bool isIn = p > 1;
      data.Topology.Around(c, ridge,
        [&](int cell, int in, int out)
        {
          const int corner = data.Mesh.Cell(cell)[0] == point ? 0
            : data.Mesh.Cell(cell)[1] == point                ? 1
            : data.Mesh.Cell(cell)[2] == point                ? 2
                                                              : 3;
          const auto step = [&](int axis) // into the cell
          { return ((corner >> axis & 1) != 0 ? -1 : 1) * (axis == 0 ? 1 : p + 1); };
          const int* locals = space.LocalFunctions(cell);
          const int first = (corner & 1) * p + (corner >> 1) * p * (p + 1);
          // the edge of a side runs along the other direction
          star.Add(space, cell,
            { locals[first], locals[first + step(1 - in / 2)], locals[first + step(1 - out / 2)] });
          for (const int side : { in, out })
          {
            // a boundary is as good as a crease
            isIn =
              isIn && data.ContinuityOf(cell, side) <= 0 && isFeature[At(4 * cell + side)] == 0;
          }
        });
      if (isIn && !star.IsFolded(points))
      {
        stars.push_back(std::move(star));
      }
      else
      {
        ++numLeftOut;
      }
    }
  }
  return stars;
}

void FinishStars(const SplineSpace<2>& space, const Integrals& integrals, std::vector<Star>& stars)
{
  std::set<int> ofStars;
  for (const Star& star : stars)
  {
    const std::set<int> own = star.OwnFunctions();
    ofStars.insert(own.begin(), own.end());
  }
  for (Star& star : stars)
  {
    star.Finish(space, integrals, ofStars);
  }
}

Status CheckInput(const Spline<2>& surface, const PointMatrix& vertices)
{
  if (!surface.Space)
  {
    return { ErrorCode::EmptyInput, "no space" };
  }
  if (surface.Space->Kind != SpaceKind::Unstructured)
  {
    return { ErrorCode::DimensionMismatch, "the spline is none on an unstructured mesh" };
  }
  if (Status status = surface.Check(); !status)
  {
    return status;
  }
  if (surface.NumComponents() < 3 || surface.IsRational())
  {
    return { ErrorCode::SizeMismatch, "tangent planes need a polynomial surface in space" };
  }
  if (vertices.rows() > 0 &&
    (vertices.rows() != MeshOf(*surface.Space).NumPoints || vertices.cols() < 3))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(vertices.rows()) + " vertices for a mesh of " +
        std::to_string(MeshOf(*surface.Space).NumPoints) };
  }
  return vertices.allFinite() ? Status() : Status(ErrorCode::NonFiniteInput, "the vertices");
}
}

Result<TangentPlaneResult> MakeTangentPlanes(
  const Spline<2>& surface, const std::vector<CellSide>& features, const PointMatrix& vertices)
{
  if (Status status = CheckInput(surface, vertices); !status)
  {
    return status;
  }
  Result<TangentPlaneResult> result;
  result->Value = surface;
  PointMatrix& points = result->Value.ControlPoints;
  std::vector<Star> stars = FindStars(*surface.Space, features, points, result->NumLeftOut);
  if (stars.empty())
  {
    return result;
  }
  const Integrals integrals(*surface.Space);
  FinishStars(*surface.Space, integrals, stars);
  if (vertices.rows() > 0 && surface.Space->Unstructured->Degree == 2)
  {
    // a plane takes much of the freedom that degree 2 has there: some accuracy first
    for (const Star& star : stars)
    {
      star.Approach(integrals, vertices, points);
    }
  }
  std::vector<char> isFlat(stars.size(), 0);
  bool isDone = false;
  for (int sweep = 0; sweep < MostSweeps && !isDone; ++sweep)
  {
    isDone = true;
    for (std::size_t s = 0; s < stars.size(); ++s)
    {
      const double distance = stars[s].Flatten(points);
      isFlat[s] = distance >= 0.0 && distance <= InPlane ? 1 : 0;
      isDone = isDone && (isFlat[s] != 0 || distance < 0.0);
    }
  }
  result->NumVertices = static_cast<int>(std::count(isFlat.begin(), isFlat.end(), 1));
  result->NumLeftOut += static_cast<int>(stars.size()) - result->NumVertices;
  result->LargestMove = (points - surface.ControlPoints).leftCols(3).rowwise().norm().maxCoeff();
  return result;
}
}
