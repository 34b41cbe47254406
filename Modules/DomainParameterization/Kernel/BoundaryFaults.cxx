// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaults.h"

#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/JacobianValidation/PlaneCurves.h>
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Scaled Jacobians below this are what rounding leaves of a degenerate point.
constexpr double DegenerateScaled = 1e-10;
/// Of the largest coordinate: what conversions (knots inserted, degrees elevated, files of few
/// digits read as doubles) may have done to control points.
constexpr double CoordinateRounding = 256.0 * 0x1p-52;

/// First derivatives of a side at points; row: direction 0, direction 1.
template <int D>
PointMatrix Derivatives(const Spline<D>& side, const PointMatrix& parameters)
{
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<D>(MakeBezierForm<D>(side, 1), parameters, params, batch);
  return batch.First;
}

/// Directions of the map's side 2 d + e.
int PositionOf(int direction, int side)
{
  return direction > side / 2 ? direction - 1 : direction;
}

/// Keeps the worst fold of a corner or edge.
template <int Dim>
class FoldSearch
{
public:
  explicit FoldSearch(const CompatibleBoundary<Dim>& boundary) : Boundary(boundary)
  {
    double largest = 0.0;
    for (const auto& side : boundary.Sides)
    {
      largest = std::max(largest, side.ControlPoints.cwiseAbs().maxCoeff());
    }
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::vector<double>& breaks = boundary.Knots[d].Breaks();
      double shortest = 1.0;
      for (std::size_t e = 0; e + 1 < breaks.size(); ++e)
      {
        shortest = std::min(shortest, breaks[e + 1] - breaks[e]);
      }
      this->SlopeErrors[d] = CoordinateRounding * largest * boundary.Knots[d].Degree() / shortest;
    }
  }

  /// @param tangents  column k: derivative along direction k
  void Try(const std::array<double, Dim>& u, const Eigen::Matrix<double, Dim, Dim>& tangents,
    const Eigen::Matrix<double, 1, Dim>& position, const std::vector<int>& sides)
  {
    const double lengths = tangents.colwise().norm().prod();
    const double det = tangents.determinant();
    const double scaled = lengths > 0.0 ? det / lengths : 0.0;
    // what rounding of the coordinates makes of the determinant: a zero stays one
    double rounding = 0.0;
    for (int k = 0; k < Dim; ++k)
    {
      double product = this->SlopeErrors[static_cast<std::size_t>(k)];
      for (int m = 0; m < Dim; ++m)
      {
        product *= m == k ? 1.0 : tangents.col(m).norm();
      }
      rounding += product;
    }
    if (det < -rounding && scaled < -DegenerateScaled && scaled < this->Worst)
    {
      this->Worst = scaled;
      this->Found.Det = det;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        this->Found.Parameters[d] = u[d];
        this->Found.Position[d] = position[static_cast<Eigen::Index>(d)];
      }
      for (std::size_t s = 0; s < 3; ++s)
      {
        this->Found.Sides[s] = s < sides.size() ? sides[s] : -1;
      }
    }
  }

  /// Appends the worst one, if any, with its sentence.
  void Close(std::vector<BoundaryFold>& folds)
  {
    if (this->Worst == 0.0)
    {
      return;
    }
    constexpr const char* names = "uvw";
    bool corner = true;
    std::string parameters;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double u = this->Found.Parameters[d];
      corner = corner && (u == 0.0 || u == 1.0);
      parameters += std::string(d ? ", " : "") + names[d] + " = " + Digits(u);
    }
    std::string sides;
    for (int s : this->Found.Sides)
    {
      if (s >= 0)
      {
        const int input = this->Boundary.Origins[static_cast<std::size_t>(s)].Input;
        sides += (sides.empty() ? "" : " and ") +
          (input >= 0 ? "side " + std::to_string(input) : "the straight side " + SideName<Dim>(s));
      }
    }
    this->Found.Message = std::string("the boundary folds at the ") +
      (corner ? "corner (" : "point (") + parameters + ") of the map, at " +
      PointText(this->Found.Position.data(), Dim) + ", where " + sides +
      " meet: their tangents there have a scaled Jacobian of " + Digits(this->Worst) +
      ", so no interior makes the map valid";
    folds.push_back(this->Found);
    this->Worst = 0.0;
  }

private:
  const CompatibleBoundary<Dim>& Boundary;
  std::array<double, Dim> SlopeErrors{}; ///< of a tangent's length
  BoundaryFold Found;
  double Worst = 0.0;
};

/// "side 3", or the straight side of a layout.
template <int Dim>
std::string NameOf(const CompatibleBoundary<Dim>& boundary, int side)
{
  const int input = boundary.Origins[static_cast<std::size_t>(side)].Input;
  return input >= 0 ? "side " + std::to_string(input) : "the straight side " + SideName<Dim>(side);
}

/// The face in the coordinates of its plane; nothing when it does not lie in one.
std::optional<Spline<2>> InItsPlane(const Spline<2>& face)
{
  const Eigen::RowVector3d middle = face.ControlPoints.colwise().mean();
  const Eigen::MatrixXd offsets = face.ControlPoints.rowwise() - middle;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(offsets.transpose() * offsets, Eigen::ComputeFullU);
  const Eigen::Matrix3d axes = svd.matrixU();
  const double away = (offsets * axes.col(2)).cwiseAbs().maxCoeff();
  if (!(away <= 1e-12 * face.ControlPoints.cwiseAbs().maxCoeff()))
  {
    return {};
  }
  Spline<2> flat = face;
  flat.ControlPoints = offsets * axes.leftCols(2);
  return flat;
}

/// A plane face that turns over: where its tangents span no area, the map's det J is zero.
void FindFaceFold(const CompatibleBoundary<3>& boundary, int side, std::vector<BoundaryFold>& folds)
{
  const Spline<2>& face = boundary.Sides[static_cast<std::size_t>(side)];
  const auto flat = InItsPlane(face);
  if (!flat)
  {
    return;
  }
  // both signs, beyond rounding, at Gauss points and corners of elements
  constexpr int perElement = 8;
  std::array<std::vector<double>, 2> lines;
  double slopes[2];
  const double largest = face.ControlPoints.cwiseAbs().maxCoeff();
  for (std::size_t d = 0; d < 2; ++d)
  {
    const std::vector<double>& breaks = face.Space->Knots[d].Breaks();
    double shortest = 1.0;
    for (std::size_t e = 0; e + 1 < breaks.size(); ++e)
    {
      shortest = std::min(shortest, breaks[e + 1] - breaks[e]);
      for (int i = 0; i < perElement; ++i)
      {
        lines[d].push_back(breaks[e] + (breaks[e + 1] - breaks[e]) * i / perElement);
      }
    }
    lines[d].push_back(breaks.back());
    slopes[d] = CoordinateRounding * largest * face.Space->Knots[d].Degree() / shortest;
  }
  PointMatrix points(static_cast<Eigen::Index>(lines[0].size() * lines[1].size()), 2);
  Eigen::Index row = 0;
  for (const double v : lines[1])
  {
    for (const double u : lines[0])
    {
      points.row(row++) << u, v;
    }
  }
  const PointMatrix tangents = Derivatives<2>(*flat, points);
  double extremes[2] = { 0.0, 0.0 };
  Eigen::Index where[2] = { 0, 0 };
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    const auto u = tangents.row(i).head<2>();
    const auto v = tangents.row(i).tail<2>();
    const double det = u[0] * v[1] - u[1] * v[0];
    const double rounding =
      slopes[0] * v.norm() + slopes[1] * u.norm() + DegenerateScaled * u.norm() * v.norm();
    for (int k = 0; k < 2; ++k)
    {
      const double value = k ? det : -det;
      if (value > rounding && value > extremes[k])
      {
        extremes[k] = value;
        where[k] = i;
      }
    }
  }
  if (extremes[0] == 0.0 || extremes[1] == 0.0)
  {
    return;
  }
  // the lesser of the two signs is the fold
  const Eigen::Index worst = where[extremes[0] < extremes[1] ? 0 : 1];
  EvaluationParams params;
  params.Threads = 1;
  EvaluationBatch batch;
  EvaluateParameters<2>(MakeBezierForm<2>(face, 1), points.row(worst), params, batch);
  BoundaryFold fold;
  fold.Det = -std::min(extremes[0], extremes[1]);
  fold.Parameters[static_cast<std::size_t>(side / 2)] = side % 2;
  for (int d = 0; d < 3; ++d)
  {
    if (d != side / 2)
    {
      fold.Parameters[static_cast<std::size_t>(d)] = points(worst, PositionOf(d, side));
    }
    fold.Position[static_cast<std::size_t>(d)] = batch.Values(0, d);
  }
  fold.Sides[0] = side;
  fold.Message = NameOf<3>(boundary, side) +
    " is a plane face that folds onto itself: it turns over at " +
    PointText(fold.Position.data(), 3) + ", so no interior makes the map valid";
  folds.push_back(std::move(fold));
}
}

template <>
std::vector<BoundaryFold> FindBoundaryFolds<2>(
  const CompatibleBoundary<2>& boundary, const std::array<bool, 4>& given)
{
  std::vector<BoundaryFold> folds;
  FoldSearch<2> search(boundary);
  PointMatrix ends(2, 1);
  ends << 0.0, 1.0;
  std::array<PointMatrix, 4> tangents;
  for (std::size_t s = 0; s < 4; ++s)
  {
    tangents[s] = Derivatives<1>(boundary.Sides[s], ends);
  }
  for (int corner = 0; corner < 4; ++corner)
  {
    const int u = corner & 1;
    const int v = corner >> 1;
    if (!given[static_cast<std::size_t>(u)] || !given[static_cast<std::size_t>(2 + v)])
    {
      continue;
    }
    Eigen::Matrix2d j;
    j.col(0) = tangents[static_cast<std::size_t>(2 + v)].row(u).transpose();
    j.col(1) = tangents[static_cast<std::size_t>(u)].row(v).transpose();
    const PointMatrix& points = boundary.Sides[static_cast<std::size_t>(u)].ControlPoints;
    const Eigen::RowVector2d position = points.row(v ? points.rows() - 1 : 0);
    search.Try({ double(u), double(v) }, j, position, { u, 2 + v });
    search.Close(folds);
  }
  return folds;
}

template <>
std::vector<BoundaryFold> FindBoundaryFolds<3>(
  const CompatibleBoundary<3>& boundary, const std::array<bool, 6>& given)
{
  constexpr int perElement = 64;
  std::vector<BoundaryFold> folds;
  FoldSearch<3> search(boundary);
  for (int along = 0; along < 3; ++along)
  {
    const int a = along == 0 ? 1 : 0; // the two directions across the edge
    const int b = along == 2 ? 1 : 2;
    const std::vector<double>& breaks = boundary.Knots[static_cast<std::size_t>(along)].Breaks();
    std::vector<double> samples{ breaks.front() };
    for (std::size_t e = 0; e + 1 < breaks.size(); ++e)
    {
      for (int i = 1; i <= perElement; ++i)
      {
        samples.push_back(i == perElement
            ? breaks[e + 1]
            : breaks[e] + (breaks[e + 1] - breaks[e]) * i / perElement);
      }
    }
    for (int ends = 0; ends < 4; ++ends)
    {
      const int endA = ends & 1;
      const int endB = ends >> 1;
      const int sideA = 2 * a + endA; // holds the edge and direction b
      const int sideB = 2 * b + endB;
      if (!given[static_cast<std::size_t>(sideA)] || !given[static_cast<std::size_t>(sideB)])
      {
        continue;
      }
      PointMatrix onA(static_cast<Eigen::Index>(samples.size()), 2);
      PointMatrix onB(onA.rows(), 2);
      for (Eigen::Index i = 0; i < onA.rows(); ++i)
      {
        onA(i, PositionOf(along, sideA)) = onB(i, PositionOf(along, sideB)) =
          samples[static_cast<std::size_t>(i)];
        onA(i, PositionOf(b, sideA)) = endB;
        onB(i, PositionOf(a, sideB)) = endA;
      }
      const Spline<2>& faceA = boundary.Sides[static_cast<std::size_t>(sideA)];
      const Spline<2>& faceB = boundary.Sides[static_cast<std::size_t>(sideB)];
      EvaluationParams params;
      params.Derivatives = 1;
      params.Threads = 1;
      EvaluationBatch atA;
      EvaluateParameters<2>(MakeBezierForm<2>(faceA, 1), onA, params, atA);
      const PointMatrix firstB = Derivatives<2>(faceB, onB);
      for (Eigen::Index i = 0; i < onA.rows(); ++i)
      {
        const bool corner = i == 0 || i + 1 == onA.rows();
        Eigen::Matrix3d j;
        j.col(along) = atA.First.row(i).segment<3>(3 * PositionOf(along, sideA)).transpose();
        j.col(b) = atA.First.row(i).segment<3>(3 * PositionOf(b, sideA)).transpose();
        j.col(a) = firstB.row(i).segment<3>(3 * PositionOf(a, sideB)).transpose();
        std::array<double, 3> u{};
        u[static_cast<std::size_t>(along)] = samples[static_cast<std::size_t>(i)];
        u[static_cast<std::size_t>(a)] = endA;
        u[static_cast<std::size_t>(b)] = endB;
        std::vector<int> sides{ sideA, sideB };
        if (corner)
        {
          sides.push_back(2 * along + (i == 0 ? 0 : 1));
        }
        search.Try(u, j, atA.Values.row(i), sides);
      }
      search.Close(folds);
    }
  }
  for (int side = 0; side < 6; ++side)
  {
    if (given[static_cast<std::size_t>(side)])
    {
      FindFaceFold(boundary, side, folds);
    }
  }
  return folds;
}

template <int Dim>
std::string CrossingText(
  const CompatibleBoundary<Dim>& boundary, const std::array<int, 2>& sides, const double* position)
{
  return "the boundary crosses itself: " + NameOf<Dim>(boundary, sides[0]) +
    (sides[0] == sides[1] ? " meets itself" : " and " + NameOf<Dim>(boundary, sides[1]) + " meet") +
    " at " + PointText(position, Dim) +
    ", so no map onto what it encloses is regular and one-to-one";
}
template std::string CrossingText<2>(
  const CompatibleBoundary<2>&, const std::array<int, 2>&, const double*);
template std::string CrossingText<3>(
  const CompatibleBoundary<3>&, const std::array<int, 2>&, const double*);

template <>
Result<std::vector<BoundaryCrossing>> FindBoundaryCrossings<2>(
  const CompatibleBoundary<2>& boundary, int threads)
{
  BernsteinCells cells;
  cells.NumComponents = 2;
  cells.Rational = boundary.IsRational();
  std::vector<std::array<int, 2>> ends;
  std::vector<int> sides;
  int next = 4; // numbers 0 to 3 are the corners
  for (int s = 0; s < 4; ++s)
  {
    const BezierForm<1> form = MakeBezierForm<1>(boundary.Sides[static_cast<std::size_t>(s)], 1);
    const int first = s < 2 ? s : 2 * (s - 2);
    const int last = s < 2 ? s + 2 : first + 1;
    const int elements = form.Space->NumElements();
    for (int e = 0; e < elements; ++e)
    {
      const int degree = form.Space->Elements[static_cast<std::size_t>(e)].Degree[0];
      const int cell = cells.Add(CellShape::Curve, { degree, 0, 0 });
      const int count = form.NumPlanes() * (degree + 1);
      std::copy(form.Block(e), form.Block(e) + count, cells.Block(cell));
      double largest = 0.0;
      for (int i = 0; i < count; ++i)
      {
        largest = std::max(largest, std::abs(form.Block(e)[i]));
      }
      cells.Errors.push_back(16.0 * 0x1p-53 * degree * largest);
      ends.push_back({ e == 0 ? first : next, e + 1 == elements ? last : next + 1 });
      next += e + 1 == elements ? 2 : 1;
      sides.push_back(s);
    }
  }
  SimpleCurvesParams params;
  params.MaxBoxes = 100000;
  params.Threads = threads;
  const auto proof = ProveSimpleCurves(cells, ends, params);
  if (!proof)
  {
    return proof.Status;
  }
  std::vector<BoundaryCrossing> crossings;
  if (proof->Verdict == CurvesVerdict::Crossing)
  {
    BoundaryCrossing crossing;
    std::array<int, 2> s{};
    for (std::size_t k = 0; k < 2; ++k)
    {
      s[k] = sides[static_cast<std::size_t>(proof->Curves[k])];
      crossing.Sides[k] = boundary.Origins[static_cast<std::size_t>(s[k])].Input;
      crossing.Position[k] = proof->Position[k];
    }
    crossing.Message = CrossingText<2>(boundary, s, crossing.Position.data());
    crossings.push_back(std::move(crossing));
  }
  return crossings;
}
}
