// SPDX-License-Identifier: BSD-3-Clause
#include "PointLayers.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t MostPoints = 32768;
constexpr std::size_t PointsOfPlace = 24; // at most; half of them at least
constexpr double ShareOfLayers = 0.15;    // of the places, above which a cloud is refused
constexpr double LeastRest = 0.4;         // of the variance, that a quadratic leaves of layers
constexpr double Rounding = 1e-6;         // of coordinates, single precision
constexpr std::size_t FewLevels = 5;      // fewer heights in all are layers themselves
constexpr double Steps = 4.0;             // of rounded heights

/// Groups of heights: how much of the variance they leave at most, and the least share of points.
struct Grouping
{
  int Groups;
  double Rest;
  double Share;
};
constexpr std::array<Grouping, 3> Groupings{ { { 2, 0.1, 0.25 }, { 3, 0.035, 0.15 },
  { 4, 0.015, 0.15 } } };

/// Whether some numbers form groups, by the best division of the sorted ones.
bool HaveGroups(Eigen::VectorXd heights)
{
  std::sort(heights.data(), heights.data() + heights.size());
  heights.array() -= heights.mean();
  const auto n = static_cast<std::size_t>(heights.size());
  std::vector<double> sums(n + 1, 0.0);
  std::vector<double> squares(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i)
  {
    const double height = heights[static_cast<Eigen::Index>(i)];
    sums[i + 1] = sums[i] + height;
    squares[i + 1] = squares[i] + height * height;
  }
  const auto rest = [&](std::size_t begin, std::size_t end)
  {
    const double sum = sums[end] - sums[begin];
    return squares[end] - squares[begin] - sum * sum / static_cast<double>(end - begin);
  };
  for (const Grouping& grouping : Groupings)
  {
    const auto least = std::max<std::size_t>(
      2, static_cast<std::size_t>(std::ceil(grouping.Share * static_cast<double>(n))));
    std::vector<double> best(n + 1, std::numeric_limits<double>::infinity());
    for (std::size_t end = least; end <= n; ++end)
    {
      best[end] = rest(0, end);
    }
    for (int group = 1; group < grouping.Groups; ++group)
    {
      std::vector<double> next(n + 1, std::numeric_limits<double>::infinity());
      for (std::size_t end = least; end <= n; ++end)
      {
        for (std::size_t begin = least; begin + least <= end; ++begin)
        {
          next[end] = std::min(next[end], best[begin] + rest(begin, end));
        }
      }
      best = std::move(next);
    }
    if (best[n] < grouping.Rest * squares[n])
    {
      return true;
    }
  }
  return false;
}

/// What least squares of the columns leave of b.
Eigen::MatrixXd Residual(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& b)
{
  return b - columns * columns.colPivHouseholderQr().solve(b);
}

/// Step of heights that are rounded; 0 when they are few, or of all sizes.
double StepOfHeights(const PointMatrix& values)
{
  if (values.cols() != 1)
  {
    return 0.0;
  }
  std::vector<double> heights(values.data(), values.data() + values.rows());
  std::sort(heights.begin(), heights.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < heights.size(); ++i)
  {
    const double step = heights[i] - heights[i - 1];
    if (step > 1e-9 * (heights.back() - heights.front()))
    {
      steps.push_back(step);
    }
  }
  if (steps.size() + 1 < FewLevels)
  {
    return 0.0;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

class Places
{
public:
  Places(const PointMatrix& parameters, const PointMatrix& values)
    : Parameters(parameters), Values(values), Step(StepOfHeights(values)),
      Largest(values.cwiseAbs().maxCoeff()), Rows(static_cast<std::size_t>(parameters.rows()))
  {
    std::iota(this->Rows.begin(), this->Rows.end(), Eigen::Index{ 0 });
    this->Look(0, this->Rows.size());
  }

  double Share() const
  {
    return this->Count == 0 ? 0.0 : static_cast<double>(this->Layered) / this->Count;
  }

private:
  void Look(std::size_t begin, std::size_t end)
  {
    Eigen::RowVector2d lower = this->Parameters.row(this->Rows[begin]);
    Eigen::RowVector2d upper = lower;
    for (std::size_t i = begin; i < end; ++i)
    {
      lower = lower.cwiseMin(this->Parameters.row(this->Rows[i]));
      upper = upper.cwiseMax(this->Parameters.row(this->Rows[i]));
    }
    const Eigen::RowVector2d size = upper - lower;
    if (end - begin <= PointsOfPlace)
    {
      ++this->Count;
      this->Layered += this->HasLayers(begin, end, lower, size) ? 1 : 0;
      return;
    }
    const Eigen::Index direction = size[1] > size[0] ? 1 : 0;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i)
    { return this->Rows.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
      [&](Eigen::Index a, Eigen::Index b)
      {
        const double first = this->Parameters(a, direction);
        const double second = this->Parameters(b, direction);
        return first != second ? first < second : a < b;
      });
    this->Look(begin, middle);
    this->Look(middle, end);
  }

  bool HasLayers(std::size_t begin, std::size_t end, const Eigen::RowVector2d& lower,
    const Eigen::RowVector2d& size) const
  {
    const auto n = static_cast<Eigen::Index>(end - begin);
    if (2 * static_cast<std::size_t>(n) < PointsOfPlace)
    {
      return false; // all points are fewer
    }
    Eigen::MatrixXd columns(n, 6);
    Eigen::MatrixXd values(n, this->Values.cols());
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const Eigen::Index row = this->Rows[begin + static_cast<std::size_t>(i)];
      const Eigen::RowVector2d from = this->Parameters.row(row) - lower;
      const double u = size[0] > 0.0 ? from[0] / size[0] - 0.5 : 0.0;
      const double v = size[1] > 0.0 ? from[1] / size[1] - 0.5 : 0.0;
      columns.row(i) << 1.0, u, v, u * u, u * v, v * v;
      values.row(i) = this->Values.row(row);
    }
    values.rowwise() -= Eigen::RowVectorXd(values.colwise().mean());
    Eigen::VectorXd heights = values.col(0);
    if (values.cols() > 1)
    {
      const Eigen::MatrixXd rough = Residual(columns.leftCols(3), values);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rough.transpose() * rough);
      heights = values * solver.eigenvectors().rightCols(1);
    }
    const double deviation = std::sqrt(heights.squaredNorm() / static_cast<double>(n));
    if (!(deviation > Rounding * this->Largest && deviation > Steps * this->Step))
    {
      return false;
    }
    return HaveGroups(heights) &&
      Residual(columns, heights).squaredNorm() > LeastRest * heights.squaredNorm();
  }

  const PointMatrix& Parameters;
  const PointMatrix& Values;
  double Step;
  double Largest;
  std::vector<Eigen::Index> Rows;
  int Count = 0;
  int Layered = 0;
};
}

double LayeredShare(const PointMatrix& parameters, const PointMatrix& values)
{
  const auto n = static_cast<std::size_t>(parameters.rows());
  if (n == 0 || !parameters.allFinite() || !values.allFinite())
  {
    return 0.0;
  }
  if (n <= MostPoints)
  {
    return Places(parameters, values).Share();
  }
  // one of each of so many equal parts of the rows, at random: rows may be those of a grid
  std::mt19937 random(1);
  PointMatrix someParameters(MostPoints, parameters.cols());
  PointMatrix someValues(MostPoints, values.cols());
  for (std::size_t i = 0; i < MostPoints; ++i)
  {
    const std::size_t first = i * n / MostPoints;
    const std::size_t last = (i + 1) * n / MostPoints;
    const auto row = static_cast<Eigen::Index>(first + random() % (last - first));
    someParameters.row(static_cast<Eigen::Index>(i)) = parameters.row(row);
    someValues.row(static_cast<Eigen::Index>(i)) = values.row(row);
  }
  return Places(someParameters, someValues).Share();
}

Status CheckLayers(const PointMatrix& parameters, const PointMatrix& values, const char* over)
{
  const double share = LayeredShare(parameters, values);
  if (share <= ShareOfLayers)
  {
    return {};
  }
  return { ErrorCode::NotInSpace,
    "the points lie in layers over " + std::string(over) + " (at " +
      std::to_string(static_cast<int>(std::lround(100.0 * share))) +
      " % of the places), as those of a closed object do, and no one surface follows them; mesh "
      "the "
      "scan and `trim` it, or give parameters of other places" };
}
}
