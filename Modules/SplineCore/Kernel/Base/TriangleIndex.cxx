// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleIndex.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
template <int Dim>
using Row = Eigen::Matrix<double, 1, Dim>;

/// Coordinate of the closest point of the segment from 0 to side, for a point at offset.
template <int Dim>
double AlongSegment(const Row<Dim>& side, const Row<Dim>& offset)
{
  const double length = side.squaredNorm();
  return length >= std::numeric_limits<double>::min()
    ? std::min(std::max(offset.dot(side) / length, 0.0), 1.0)
    : 0.0;
}

constexpr double FairFill =
  0.125; ///< area of a triangle over that of its box, of fair ones at least
constexpr double FairShare = 4.0; ///< of a triangle in the box of all, times their number, at most
constexpr int MostStrips = 64;
constexpr double FootMargin = 1e-13; ///< of the coordinates: of boxes of strips

/// Half of the surface of a box.
template <int Dim>
double HalfArea(const Row<Dim>& sides)
{
  double sum = 0.0;
  for (int i = 0; i < Dim; ++i)
  {
    for (int j = 0; j < i; ++j)
    {
      sum += sides(i) * sides(j);
    }
  }
  return sum;
}

/// The corner at which the longest edge of a triangle begins.
template <int Dim>
std::size_t LongestEdge(const std::array<Row<Dim>, 3>& corners)
{
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const double squared = (corners[(k + 1) % 3] - corners[k]).squaredNorm();
    if (squared > length)
    {
      length = squared;
      longest = k;
    }
  }
  return longest;
}
}

template <int Dim>
TriangleFoot ClosestOnTriangle(
  const double* a, const double* b, const double* c, const double* point, int triangle)
{
  using Map = Eigen::Map<const Row<Dim>>;
  const Row<Dim> ab = Map(b) - Map(a);
  const Row<Dim> ac = Map(c) - Map(a);
  const Row<Dim> offset = Map(point) - Map(a);
  const Row<Dim> lower = Map(a).cwiseMin(Map(b)).cwiseMin(Map(c));
  const Row<Dim> upper = Map(a).cwiseMax(Map(b)).cwiseMax(Map(c));

  TriangleFoot best;
  best.Triangle = triangle;
  const auto take = [&](double second, double third)
  {
    const Row<Dim> foot =
      PointOfTriangle<Dim>(a, b, c, second, third).cwiseMax(lower).cwiseMin(upper);
    double sum = 0.0; // summed as the tree sums its boxes
    for (int d = 0; d < Dim; ++d)
    {
      sum += (point[d] - foot(d)) * (point[d] - foot(d));
    }
    if (sum < best.SquaredDistance)
    {
      best.Second = second;
      best.Third = third;
      best.SquaredDistance = sum;
    }
  };

  // Foot in the plane, by one step of Gram and Schmidt from the longer side: however flat the
  // triangle, errors in the one coordinate are made good by the other, while normal equations would
  // square the loss of digits.
  const bool swapped = ac.squaredNorm() > ab.squaredNorm();
  const Row<Dim>& side = swapped ? ac : ab;
  const Row<Dim>& other = swapped ? ab : ac;
  const double length = side.squaredNorm();
  double first = -1.0;
  double second = -1.0;
  double third = -1.0;
  if (length >= std::numeric_limits<double>::min())
  {
    const Row<Dim> height = other - (other.dot(side) / length) * side;
    const double squaredHeight = height.squaredNorm();
    if (squaredHeight >= std::numeric_limits<double>::min())
    {
      third = offset.dot(height) / squaredHeight;
      second = (offset - third * other).dot(side) / length;
      if (swapped)
      {
        std::swap(second, third);
      }
      first = 1.0 - second - third;
    }
  }
  if (first >= 0.0 && second >= 0.0 && third >= 0.0)
  {
    take(second, third);
    return best;
  }
  // From outside, the closest point lies on an edge beyond which the query is; without area, on any
  // of the three.
  if (third < 0.0)
  {
    take(AlongSegment<Dim>(ab, offset), 0.0);
  }
  if (second < 0.0)
  {
    take(0.0, AlongSegment<Dim>(ac, offset));
  }
  if (first < 0.0)
  {
    const double share = AlongSegment<Dim>(Map(c) - Map(b), Map(point) - Map(b));
    take(1.0 - share, share);
  }
  return best;
}

std::vector<int> FirstOfEqualPoints(const PointMatrix& points)
{
  const auto n = static_cast<std::size_t>(points.rows());
  const auto before = [&](int a, int b)
  {
    for (Eigen::Index d = 0; d < points.cols(); ++d)
    {
      if (points(a, d) != points(b, d))
      {
        return points(a, d) < points(b, d);
      }
    }
    return false;
  };
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
    [&](int a, int b) { return before(a, b) || (!before(b, a) && a < b); });
  std::vector<int> first(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const bool equal = i > 0 && !before(order[i - 1], order[i]);
    first[static_cast<std::size_t>(order[i])] =
      equal ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

std::vector<MeshTriangle> ReplaceCorners(
  std::vector<MeshTriangle> triangles, const std::vector<int>& replacement)
{
  for (MeshTriangle& corners : triangles)
  {
    for (int& corner : corners)
    {
      corner = replacement[static_cast<std::size_t>(corner)];
    }
  }
  return triangles;
}

std::vector<MeshTriangle> TriangleNeighbours(const std::vector<MeshTriangle>& triangles)
{
  struct Side
  {
    int Low;
    int High;
    int Triangle;
    std::size_t Edge;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const int a = triangles[t][k];
      const int b = triangles[t][(k + 1) % 3];
      sides.push_back({ std::min(a, b), std::max(a, b), static_cast<int>(t), k });
    }
  }
  std::sort(sides.begin(), sides.end(),
    [](const Side& a, const Side& b)
    {
      return std::tie(a.Low, a.High, a.Triangle, a.Edge) <
        std::tie(b.Low, b.High, b.Triangle, b.Edge);
    });
  std::vector<MeshTriangle> neighbours(triangles.size(), MeshTriangle{ -1, -1, -1 });
  for (std::size_t i = 0; i < sides.size();)
  {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].Low == sides[i].Low && sides[end].High == sides[i].High)
    {
      ++end;
    }
    const Side& one = sides[i];
    const Side& two = sides[end - 1];
    if (end == i + 2 && one.Low != one.High && one.Triangle != two.Triangle)
    {
      neighbours[static_cast<std::size_t>(one.Triangle)][one.Edge] = two.Triangle;
      neighbours[static_cast<std::size_t>(two.Triangle)][two.Edge] = one.Triangle;
    }
    i = end;
  }
  return neighbours;
}

namespace
{
constexpr Eigen::Index GroupSize = 16;      ///< queries that share the triangles near them
constexpr Eigen::Index SmallestGroup = 4;   ///< for which gathering these pays
constexpr Eigen::Index MostCandidates = 96; ///< triangles a group; one with more is no group

/// Of equally near triangles the first.
void TakeNearer(const TriangleFoot& foot, TriangleFoot& best)
{
  if (foot.SquaredDistance < best.SquaredDistance ||
    (foot.SquaredDistance == best.SquaredDistance &&
      (best.Triangle < 0 || foot.Triangle < best.Triangle)))
  {
    best = foot;
  }
}

/// The box of three corners.
template <int Dim>
struct Box
{
  double Lower[Dim];
  double Upper[Dim];

  Box(const double* a, const double* b, const double* c)
  {
    for (int d = 0; d < Dim; ++d)
    {
      this->Lower[d] = std::min({ a[d], b[d], c[d] });
      this->Upper[d] = std::max({ a[d], b[d], c[d] });
    }
  }
  /// Not above that of a foot in the box, by rounding either: summed as that is.
  double SquaredDistance(const double* point) const
  {
    double sum = 0.0;
    for (int d = 0; d < Dim; ++d)
    {
      const double gap = std::max({ this->Lower[d] - point[d], point[d] - this->Upper[d], 0.0 });
      sum += gap * gap;
    }
    return sum;
  }
};

/// The triangles that may be nearest to one of a group of queries, side by side.
template <int Dim>
class NearTriangles
{
public:
  /// @param known    a triangle near the group, which is gathered, too.
  /// @param forNear  calls its last argument for triangles near a box, until that is false.
  /// @return whether they are few.
  template <class ForNear>
  bool Gather(
    const TriangleIndex<Dim>& index, const PointMatrixView& queries, int known, ForNear&& forNear)
  {
    double reach = 0.0;
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
    {
      reach = std::max(reach, index.Foot(known, queries.row(i).data()).SquaredDistance);
    }
    Row<Dim> lower = queries.colwise().minCoeff();
    Row<Dim> upper = queries.colwise().maxCoeff();
    const double size = lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).maxCoeff();
    const double radius = std::sqrt(reach) * (1.0 + FootMargin) + FootMargin * size;
    lower.array() -= radius;
    upper.array() += radius;
    this->Count = 0;
    bool areFew = true;
    forNear(lower.data(), upper.data(),
      [&](int triangle)
      {
        const Box<Dim> box(
          index.Corner(triangle, 0), index.Corner(triangle, 1), index.Corner(triangle, 2));
        bool meets = true;
        for (int d = 0; d < Dim; ++d)
        {
          meets = meets && box.Lower[d] <= upper(d) && lower(d) <= box.Upper[d];
        }
        areFew = !meets || this->Count < MostCandidates;
        if (meets && areFew)
        {
          this->Add(index, triangle, box);
        }
        return areFew;
      });
    return areFew;
  }

  /// The triangles whose boxes are nearest come first: most others are farther than their feet.
  TriangleFoot Nearest(const double* query)
  {
    auto distances = this->Distances.head(this->Count);
    distances.setZero();
    for (int d = 0; d < Dim; ++d)
    {
      const auto gap = (this->Lower.col(d).head(this->Count) - query[d])
                         .max(query[d] - this->Upper.col(d).head(this->Count))
                         .max(0.0);
      distances += gap * gap;
    }
    const double least = distances.minCoeff();
    TriangleFoot best;
    for (const bool isFirst : { true, false })
    {
      for (Eigen::Index i = 0; i < this->Count; ++i)
      {
        if (isFirst == (distances[i] == least) && distances[i] <= best.SquaredDistance)
        {
          const double* corners = this->Corners[static_cast<std::size_t>(i)].data();
          TakeNearer(ClosestOnTriangle<Dim>(corners, corners + Dim, corners + 2 * Dim, query,
                       this->Triangles[static_cast<std::size_t>(i)]),
            best);
        }
      }
    }
    return best;
  }

private:
  void Add(const TriangleIndex<Dim>& index, int triangle, const Box<Dim>& box)
  {
    const auto at = static_cast<std::size_t>(this->Count);
    this->Triangles[at] = triangle;
    for (int k = 0; k < 3; ++k)
    {
      std::copy_n(index.Corner(triangle, k), Dim, this->Corners[at].data() + k * Dim);
    }
    for (int d = 0; d < Dim; ++d)
    {
      this->Lower(this->Count, d) = box.Lower[d];
      this->Upper(this->Count, d) = box.Upper[d];
    }
    ++this->Count;
  }

  static constexpr auto Most = static_cast<std::size_t>(MostCandidates);
  Eigen::Index Count = 0;
  std::array<int, Most> Triangles;
  std::array<std::array<double, 3 * Dim>, Most> Corners;
  Eigen::Array<double, MostCandidates, Dim> Lower;
  Eigen::Array<double, MostCandidates, Dim> Upper;
  Eigen::Array<double, MostCandidates, 1> Distances;
};
}

template <int Dim>
TriangleIndex<Dim>::TriangleIndex(PointMatrix points, std::vector<MeshTriangle> triangles)
  : Corners(std::move(points)), Mesh(std::move(triangles))
{
  this->MakeStrips();
  PointMatrix lower;
  PointMatrix upper;
  this->Boxes(lower, upper);
  this->Tree = BoxTree(lower, upper);
}

template <int Dim>
void TriangleIndex<Dim>::MakeStrips()
{
  // n strips have boxes of a share 1 / n^2 of the triangle's each
  const double whole = HalfArea<Dim>(
    Row<Dim>(this->Corners.colwise().maxCoeff()) - Row<Dim>(this->Corners.colwise().minCoeff()));
  const double largest = FairShare * whole / static_cast<double>(this->Mesh.size());
  for (std::size_t t = 0; t < this->Mesh.size(); ++t)
  {
    const auto& [a, b, c] = this->Mesh[t];
    const Row<Dim> ab = this->Corners.row(b) - this->Corners.row(a);
    const Row<Dim> ac = this->Corners.row(c) - this->Corners.row(a);
    const double box = HalfArea<Dim>(ab.cwiseMax(ac).cwiseMax(0.0) - ab.cwiseMin(ac).cwiseMin(0.0));
    const double area =
      0.5 * std::sqrt(std::max(ab.squaredNorm() * ac.squaredNorm() - ab.dot(ac) * ab.dot(ac), 0.0));
    int count = 1;
    if (box > largest && FairFill * box > area)
    {
      const double wanted = std::min(std::sqrt(box / largest), FairFill * box / area);
      count = static_cast<int>(std::ceil(std::min(wanted, static_cast<double>(MostStrips))));
    }
    for (int i = 0; i < count; ++i)
    {
      this->Strips.push_back({ static_cast<int>(t), i, count });
    }
  }
}

template <int Dim>
void TriangleIndex<Dim>::Move(const PointMatrixView& points)
{
  this->Corners = points;
  PointMatrix lower;
  PointMatrix upper;
  this->Boxes(lower, upper);
  this->Tree.Refit(lower, upper);
}

template <int Dim>
void TriangleIndex<Dim>::Boxes(PointMatrix& lower, PointMatrix& upper) const
{
  const auto n = static_cast<Eigen::Index>(this->Strips.size());
  lower.resize(n, Dim);
  upper.resize(n, Dim);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const auto& [triangle, number, count] = this->Strips[static_cast<std::size_t>(i)];
    const MeshTriangle& ids = this->Mesh[static_cast<std::size_t>(triangle)];
    const std::array<Row<Dim>, 3> corners = { this->Corners.row(ids[0]), this->Corners.row(ids[1]),
      this->Corners.row(ids[2]) };
    const Row<Dim> low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Row<Dim> high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    lower.row(i) = low;
    upper.row(i) = high;
    if (count > 1)
    {
      const std::size_t k = LongestEdge<Dim>(corners);
      const Row<Dim>& a = corners[k];
      const Row<Dim>& b = corners[(k + 1) % 3];
      const Row<Dim>& c = corners[(k + 2) % 3];
      // what is cut across the longest edge, at the shares of it where the strip begins and ends,
      // and a little more, for feet are rounded
      const Row<Dim> side = b - a;
      const double foot = AlongSegment<Dim>(side, c - a);
      const double first = static_cast<double>(number) / count;
      const double last = static_cast<double>(number + 1) / count;
      Row<Dim> least = Row<Dim>::Constant(std::numeric_limits<double>::infinity());
      Row<Dim> most = -least;
      const auto add = [&](const Row<Dim>& point)
      {
        least = least.cwiseMin(point);
        most = most.cwiseMax(point);
      };
      for (const double share : { first, last })
      {
        add(a + share * side);
        add(share < foot ? Row<Dim>(a + share / foot * (c - a))
                         : Row<Dim>(b + (1.0 - share) / std::max(1.0 - foot, 1e-300) * (c - b)));
      }
      if (first <= foot && foot <= last)
      {
        add(c);
      }
      const double margin = FootMargin * low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
      lower.row(i) = (least.array() - margin).matrix().cwiseMax(low);
      upper.row(i) = (most.array() + margin).matrix().cwiseMin(high);
    }
  }
}

template <int Dim>
TriangleFoot TriangleIndex<Dim>::Nearest(const double* point, double bound) const
{
  TriangleFoot best;
  best.SquaredDistance = bound;
  this->Tree.Nearest(
    point,
    [&](int strip)
    {
      const int triangle = this->TriangleOf(strip);
      const Box<Dim> box(
        this->Corner(triangle, 0), this->Corner(triangle, 1), this->Corner(triangle, 2));
      if (const double distance = box.SquaredDistance(point); distance > best.SquaredDistance)
      {
        return distance;
      }
      const TriangleFoot foot = this->Foot(triangle, point);
      TakeNearer(foot, best);
      return foot.SquaredDistance;
    },
    bound);
  return best.Triangle < 0 ? TriangleFoot{} : best;
}

template <int Dim>
void TriangleIndex<Dim>::Nearest(
  const PointMatrixView& queries, std::vector<TriangleFoot>& feet) const
{
  feet.resize(static_cast<std::size_t>(queries.rows()));
  NearTriangles<Dim> near;
  TriangleFoot last;
  for (Eigen::Index begin = 0; begin < queries.rows(); begin += GroupSize)
  {
    const Eigen::Index end = std::min(begin + GroupSize, queries.rows());
    // that of the middle one bounds the distances of all
    const double* middle = queries.row(begin + (end - begin) / 2).data();
    last = this->Nearest(middle,
      last.Triangle < 0 ? std::numeric_limits<double>::infinity()
                        : this->Foot(last.Triangle, middle).SquaredDistance);
    const bool isGathered = end - begin >= SmallestGroup &&
      near.Gather(*this, queries.middleRows(begin, end - begin), last.Triangle,
        [&](const double* lower, const double* upper, auto&& use) {
          this->Tree.ForNear(lower, upper, [&](int strip) { return use(this->TriangleOf(strip)); });
        });
    for (Eigen::Index i = begin; i < end; ++i)
    {
      const double* query = queries.row(i).data();
      last = isGathered ? near.Nearest(query)
                        : this->Nearest(query, this->Foot(last.Triangle, query).SquaredDistance);
      feet[static_cast<std::size_t>(i)] = last;
    }
  }
}

template TriangleFoot ClosestOnTriangle<2>(
  const double*, const double*, const double*, const double*, int);
template TriangleFoot ClosestOnTriangle<3>(
  const double*, const double*, const double*, const double*, int);
template class TriangleIndex<2>;
template class TriangleIndex<3>;
}
