// SPDX-License-Identifier: BSD-3-Clause
#include "PointLayers.h"

#include <knotwork/SplineCore/Median.h>
#include <knotwork/SplineCore/Numbers.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t MostPlaces = 2048;
constexpr std::size_t PointsOfPlace = 24; // at most; half of them at least
constexpr double ShareOfLayers = 0.15;    // of the places, above which a cloud is refused
constexpr double LeastRest = 0.4;         // of the variance, that a quadratic leaves of layers
constexpr double Rounding = 1e-6;         // of coordinates, single precision
constexpr std::size_t FewLevels = 5;      // of heights in all
constexpr double LeastGap = 1.5;          // between groups of rounded heights, in steps

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
/// @param gap  that groups are apart at least; asked for when there are such.
template <class Gap>
bool HaveGroups(Eigen::VectorXd heights, Gap&& gap)
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
    std::vector<std::vector<std::size_t>> begins; // of the last group of the first ones
    for (std::size_t end = least; end <= n; ++end)
    {
      best[end] = rest(0, end);
    }
    for (int group = 1; group < grouping.Groups; ++group)
    {
      std::vector<double> next(n + 1, std::numeric_limits<double>::infinity());
      begins.emplace_back(n + 1, 0);
      for (std::size_t end = least; end <= n; ++end)
      {
        for (std::size_t begin = least; begin + least <= end; ++begin)
        {
          const double whole = best[begin] + rest(begin, end);
          if (whole < next[end])
          {
            next[end] = whole;
            begins.back()[end] = begin;
          }
        }
      }
      best = std::move(next);
    }
    bool apart = best[n] < grouping.Rest * squares[n];
    for (std::size_t end = n; apart && !begins.empty(); begins.pop_back())
    {
      const auto begin = static_cast<Eigen::Index>(begins.back()[end]);
      apart = heights[begin] - heights[begin - 1] > gap();
      end = static_cast<std::size_t>(begin);
    }
    if (apart)
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

/// Step of numbers that are rounded; 0 when there are two, next to nothing when they are of all
/// sizes.
double StepOf(const Eigen::VectorXd& column)
{
  std::vector<double> sorted(column.data(), column.data() + column.size());
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> steps;
  for (std::size_t i = 1; i < sorted.size(); ++i)
  {
    const double step = sorted[i] - sorted[i - 1];
    if (step > 1e-9 * (sorted.back() - sorted.front()))
    {
      steps.push_back(step);
    }
  }
  if (steps.size() < 2)
  {
    return 0.0;
  }
  return steps.size() + 1 < FewLevels ? *std::min_element(steps.begin(), steps.end())
                                      : Median(steps);
}

class Places
{
public:
  Places(const PointMatrix& parameters, const PointMatrix& values)
    : Values(values), Largest(values.cwiseAbs().maxCoeff())
  {
    this->Sites.resize(static_cast<std::size_t>(parameters.rows()));
    for (std::size_t i = 0; i < this->Sites.size(); ++i)
    {
      const auto row = static_cast<Eigen::Index>(i);
      this->Sites[i] = { { parameters(row, 0), parameters(row, 1) }, row };
    }
    this->Look(0, this->Sites.size(), MostPlaces);
  }

  LayeredPlaces Found() const
  {
    return { this->Count == 0 ? 0.0 : static_cast<double>(this->Layered) / this->Count,
      this->First };
  }

private:
  struct Site
  {
    RealArray<2> At;
    Eigen::Index Row;
  };

  /// @param places  to look at: whole ones, as points that are drawn from all would make places as
  /// wide as what is between ribs or blocks.
  void Look(std::size_t begin, std::size_t end, std::size_t places)
  {
    RealArray<2> lower = this->Sites[begin].At;
    RealArray<2> upper = lower;
    for (std::size_t i = begin; i < end; ++i)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        lower[d] = std::min(lower[d], this->Sites[i].At[d]);
        upper[d] = std::max(upper[d], this->Sites[i].At[d]);
      }
    }
    const RealArray<2> size{ upper[0] - lower[0], upper[1] - lower[1] };
    if (end - begin <= PointsOfPlace)
    {
      ++this->Count;
      if (this->HasLayers(begin, end, lower, size))
      {
        ++this->Layered;
        this->First = this->First < 0 ? this->Sites[begin + (end - begin) / 2].Row : this->First;
      }
      return;
    }
    const std::size_t direction = size[1] > size[0] ? 1 : 0;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i)
    { return this->Sites.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end),
      [direction](const Site& a, const Site& b) {
        return a.At[direction] != b.At[direction] ? a.At[direction] < b.At[direction]
                                                  : a.Row < b.Row;
      });
    const std::size_t odd = places % 2 == 0 ? 0 : this->Random() % 2;
    if (places / 2 + odd > 0)
    {
      this->Look(begin, middle, places / 2 + odd);
    }
    if (places - places / 2 - odd > 0)
    {
      this->Look(middle, end, places - places / 2 - odd);
    }
  }

  bool HasLayers(
    std::size_t begin, std::size_t end, const RealArray<2>& lower, const RealArray<2>& size)
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
      const Site& site = this->Sites[begin + static_cast<std::size_t>(i)];
      const double u = size[0] > 0.0 ? (site.At[0] - lower[0]) / size[0] - 0.5 : 0.0;
      const double v = size[1] > 0.0 ? (site.At[1] - lower[1]) / size[1] - 0.5 : 0.0;
      columns.row(i) << 1.0, u, v, u * u, u * v, v * v;
      values.row(i) = this->Values.row(site.Row);
    }
    values.rowwise() -= Eigen::RowVectorXd(values.colwise().mean());
    Eigen::VectorXd heights = values.col(0);
    Eigen::VectorXd direction = Eigen::VectorXd::Ones(1);
    if (values.cols() > 1)
    {
      const Eigen::MatrixXd rough = Residual(columns.leftCols(3), values);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rough.transpose() * rough);
      direction = solver.eigenvectors().rightCols(1);
      heights = values * direction;
    }
    const double deviation = std::sqrt(heights.squaredNorm() / static_cast<double>(n));
    if (!(deviation > Rounding * this->Largest))
    {
      return false;
    }
    const auto gap = [&] { return LeastGap * direction.cwiseAbs().dot(this->StepsOfAll()); };
    return HaveGroups(heights, gap) &&
      Residual(columns, heights).squaredNorm() > LeastRest * heights.squaredNorm();
  }

  /// Of each component, of all points: few clouds have groups anywhere.
  const Eigen::VectorXd& StepsOfAll()
  {
    if (this->Steps.size() == 0)
    {
      this->Steps.resize(this->Values.cols());
      for (Eigen::Index c = 0; c < this->Values.cols(); ++c)
      {
        this->Steps[c] = StepOf(this->Values.col(c));
      }
    }
    return this->Steps;
  }

  const PointMatrix& Values;
  Eigen::VectorXd Steps;
  double Largest;
  std::vector<Site> Sites;
  std::mt19937 Random{ 1 };
  int Count = 0;
  int Layered = 0;
  Eigen::Index First = -1;
};
}

LayeredPlaces FindLayers(const PointMatrix& parameters, const PointMatrix& values)
{
  if (parameters.rows() == 0 || !parameters.allFinite() || !values.allFinite())
  {
    return {};
  }
  return Places(parameters, values).Found();
}

Status CheckLayers(
  const PointMatrix& parameters, const PointMatrix& values, const char* over, bool isNumbered)
{
  const LayeredPlaces places = FindLayers(parameters, values);
  if (places.Share <= ShareOfLayers)
  {
    return {};
  }
  const RealArray<2> at{ parameters(places.Point, 0), parameters(places.Point, 1) };
  return { ErrorCode::NotInSpace,
    "the points lie in layers over " + std::string(over) + " (at " +
      std::to_string(static_cast<int>(std::lround(100.0 * places.Share))) +
      " % of the places, the first one " +
      (isNumbered ? "around point " + std::to_string(places.Point) + " " : std::string()) + "at " +
      PointText(at.data(), 2) +
      "), as those of a closed object do, and no one surface follows them; mesh the scan and "
      "`trim` it, fit each layer alone, or give parameters over which the layers lie apart" };
}
}
