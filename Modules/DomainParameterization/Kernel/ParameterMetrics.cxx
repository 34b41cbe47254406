// SPDX-License-Identifier: BSD-3-Clause
#include "ParameterMetrics.h"

#include "BezierForm.h"
#include "JacobianField.h"
#include "NumberText.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// Scaled Jacobians below this are what rounding leaves of a degenerate point.
constexpr double DegenerateScaled = 1e-10;

/// Sums and extremes over points that come one by one.
template <int Dim>
class Collector
{
public:
  /// @param j  Dim * c + k: derivative of component c along direction k
  void Add(const std::array<double, Dim * Dim>& j)
  {
    double det = 0.0;
    double cofactors = 0.0; // squared norm
    double f = 0.0;
    double product = 1.0;
    for (std::size_t k = 0; k < Dim; ++k)
    {
      double length = 0.0;
      for (std::size_t c = 0; c < Dim; ++c)
      {
        length += j[Dim * c + k] * j[Dim * c + k];
      }
      f += length;
      product *= length;
    }
    if constexpr (Dim == 2)
    {
      det = j[0] * j[3] - j[1] * j[2];
      cofactors = f;
    }
    else
    {
      for (std::size_t c = 0; c < 3; ++c)
      {
        const double* a = j.data() + 3 * ((c + 1) % 3);
        const double* b = j.data() + 3 * ((c + 2) % 3);
        const double n[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0] };
        cofactors += n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        det = j[3 * c] * n[0] + j[3 * c + 1] * n[1] + j[3 * c + 2] * n[2];
      }
    }
    const double scaled = product > 0.0 ? det / std::sqrt(product) : 0.0;
    this->MinDet = std::min(this->MinDet, det);
    this->MaxDet = std::max(this->MaxDet, det);
    this->MinScaled = std::min(this->MinScaled, scaled);
    this->SumScaled += scaled;
    this->NonPositive += det > 0.0 ? 0 : 1;
    if (std::abs(scaled) > DegenerateScaled)
    {
      // in the plane both norms are one
      this->SumCondition += (Dim == 2 ? f : std::sqrt(f * cofactors)) / std::abs(det);
      ++this->NumConditions;
    }
    ++this->Count;
  }

  DomainMetrics Result(double area, int samples) const
  {
    DomainMetrics metrics;
    metrics.Samples = samples;
    metrics.Area = area;
    metrics.MinDet = this->MinDet;
    metrics.MaxDet = this->MaxDet;
    metrics.MinDetOverArea = this->MinDet / area;
    metrics.MaxDetOverArea = this->MaxDet / area;
    metrics.MinScaledJacobian = this->MinScaled;
    metrics.MeanScaledJacobian = this->SumScaled / static_cast<double>(this->Count);
    metrics.MeanConditionNumber =
      this->SumCondition / static_cast<double>(std::max<std::int64_t>(1, this->NumConditions));
    metrics.NonPositive = this->NonPositive;
    return metrics;
  }

private:
  double MinDet = std::numeric_limits<double>::infinity();
  double MaxDet = -std::numeric_limits<double>::infinity();
  double MinScaled = std::numeric_limits<double>::infinity();
  double SumScaled = 0.0;
  double SumCondition = 0.0;
  std::int64_t NumConditions = 0;
  int NonPositive = 0;
  std::int64_t Count = 0;
};

template <int Dim>
class MetricBody final : public RowBody
{
public:
  MetricBody(bool rational, Collector<Dim>& sums) : Rational(rational), Sums(sums) {}

  void Row(
    int n, const double* fields, double*, const double*, double, const double* padding) override
  {
    const int numPlanes = Dim + (this->Rational ? 1 : 0);
    for (int i = 0; i < n && padding[i] == 0.0; ++i)
    {
      const auto at = [&](int t, int c) { return fields[(t * numPlanes + c) * n + i]; };
      const double inverse = this->Rational ? 1.0 / at(0, Dim) : 1.0;
      std::array<double, Dim * Dim> j;
      for (int c = 0; c < Dim; ++c)
      {
        for (int k = 0; k < Dim; ++k)
        {
          double& entry = j[static_cast<std::size_t>(Dim * c + k)];
          entry = at(k + 1, c);
          if (this->Rational)
          {
            entry = (entry - at(0, c) * inverse * at(k + 1, Dim)) * inverse;
          }
        }
      }
      this->Sums.Add(j);
    }
  }

private:
  bool Rational;
  Collector<Dim>& Sums;
};

/// All samples of one patch.
template <int Dim>
void CollectPatch(const Spline<Dim>& map, int samples, Collector<Dim>& sums)
{
  if (map.Space->Kind == SpaceKind::Tensor)
  {
    std::array<LinePoints, Dim> lines;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      lines[d] = UniformLine(map.Space->Knots[d], samples);
    }
    const PointMatrix rows = map.HomogeneousPoints();
    const Eigen::MatrixXd planes = rows; // by columns
    MetricBody<Dim> body(map.IsRational(), sums);
    MakeTensorField<Dim>(map.Space->Knots, lines)
      ->Visit(planes.data(), nullptr, static_cast<int>(planes.cols()), map.IsRational(), body);
    return;
  }
  const BezierForm<Dim> form = MakeBezierForm<Dim>(map, 1);
  const ParametricBox<Dim> domain = map.Space->Domain();
  EvaluationParams params;
  params.Derivatives = 1;
  params.Threads = 1;
  EvaluationBatch batch;
  PointMatrix line(samples, Dim);
  const int numLines = Dim == 2 ? samples : samples * samples;
  for (int l = 0; l < numLines; ++l)
  {
    for (int i = 0; i < samples; ++i)
    {
      const int index[3] = { i, l % samples, l / samples };
      for (int d = 0; d < Dim; ++d)
      {
        const std::size_t at = static_cast<std::size_t>(d);
        line(i, d) =
          domain.Lower[at] + (domain.Upper[at] - domain.Lower[at]) * index[d] / (samples - 1);
      }
    }
    EvaluateParameters<Dim>(form, line, params, batch);
    for (int i = 0; i < samples; ++i)
    {
      std::array<double, Dim * Dim> j;
      for (int c = 0; c < Dim; ++c)
      {
        for (int k = 0; k < Dim; ++k)
        {
          j[static_cast<std::size_t>(Dim * c + k)] = batch.First(i, k * Dim + c);
        }
      }
      sums.Add(j);
    }
  }
}

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
  explicit FoldSearch(const CompatibleBoundary<Dim>& boundary) : Boundary(boundary) {}

  /// @param tangents  column k: derivative along direction k
  void Try(const std::array<double, Dim>& u, const Eigen::Matrix<double, Dim, Dim>& tangents,
    const Eigen::Matrix<double, 1, Dim>& position, const std::vector<int>& sides)
  {
    const double lengths = tangents.colwise().norm().prod();
    const double det = tangents.determinant();
    const double scaled = lengths > 0.0 ? det / lengths : 0.0;
    if (scaled < -DegenerateScaled && scaled < this->Worst)
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
    std::string position;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double u = this->Found.Parameters[d];
      corner = corner && (u == 0.0 || u == 1.0);
      parameters += std::string(d ? ", " : "") + names[d] + " = " + NumberText(u);
      position += (d ? ", " : "") + NumberText(this->Found.Position[d]);
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
      (corner ? "corner (" : "point (") + parameters + ") of the map, at (" + position +
      "), where " + sides + " meet: their tangents there have a scaled Jacobian of " +
      NumberText(this->Worst) + ", so no interior makes the map valid";
    folds.push_back(this->Found);
    this->Worst = 0.0;
  }

private:
  const CompatibleBoundary<Dim>& Boundary;
  BoundaryFold Found;
  double Worst = 0.0;
};
}

template <int Dim>
DomainMetrics MeasureMaps(const std::vector<Spline<Dim>>& patches, double area, int samples)
{
  Collector<Dim> sums;
  for (const Spline<Dim>& patch : patches)
  {
    CollectPatch<Dim>(patch, samples, sums);
  }
  return sums.Result(area, samples);
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
  return folds;
}

template DomainMetrics MeasureMaps<2>(const std::vector<Spline<2>>&, double, int);
template DomainMetrics MeasureMaps<3>(const std::vector<Spline<3>>&, double, int);
}
