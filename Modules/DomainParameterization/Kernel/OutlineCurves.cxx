// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineCurves.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
using Point = Eigen::Vector2d;
using Line = std::vector<Point>;

constexpr double Pi = 3.14159265358979323846;
constexpr double JoinDistance = 0.02; ///< of ends, a share of the size
constexpr int MaxSpans = 512;

std::string NameOf(std::size_t line)
{
  return "line " + std::to_string(line);
}

/// Part of a side: a clamped spline on knots from 0 to 1 with homogeneous points.
struct Piece
{
  int Degree = 1;
  std::vector<double> Knots;
  std::vector<Eigen::Vector3d> Points; ///< (w x, w y, w)
  double Length = 0.0;
  double Distance = 0.0; ///< largest of the points
};

/// A line with the lengths along it.
class Track
{
public:
  Track(Line points, bool isClosed) : Points(std::move(points)), IsClosed(isClosed)
  {
    this->Lengths.assign(1, 0.0);
    for (std::size_t i = 1; i < this->Points.size(); ++i)
    {
      this->Lengths.push_back(
        this->Lengths.back() + (this->Points[i] - this->Points[i - 1]).norm());
    }
  }

  double Length() const { return this->Lengths.back(); }

  /// Periodic where it is closed, else held at the ends.
  Point At(double length) const
  {
    const double total = this->Length();
    length =
      this->IsClosed ? length - total * std::floor(length / total) : std::clamp(length, 0.0, total);
    const auto next = std::upper_bound(this->Lengths.begin() + 1, this->Lengths.end() - 1, length);
    const auto i = static_cast<std::size_t>(next - this->Lengths.begin());
    const double span = this->Lengths[i] - this->Lengths[i - 1];
    const double share = span > 0.0 ? (length - this->Lengths[i - 1]) / span : 0.0;
    return this->Points[i - 1] + share * (this->Points[i] - this->Points[i - 1]);
  }

  /// Turn at a point in radians, to the left positive, between the chords before and behind it.
  double Turn(std::size_t i, double window) const
  {
    const double at = this->Lengths[i];
    const Point before = this->Points[i] - this->At(at - window);
    const Point behind = this->At(at + window) - this->Points[i];
    return std::atan2(before.x() * behind.y() - before.y() * behind.x(), before.dot(behind));
  }

  Line Points; ///< of a closed one the last is the first
  std::vector<double> Lengths;
  bool IsClosed;
};

/// Points between those that are far from each other: places where a side may end.
Line Densified(const Line& line)
{
  constexpr double parts = 256.0; // of the length
  const double step = Track(line, false).Length() / parts;
  Line dense{ line.front() };
  for (std::size_t i = 1; i < line.size(); ++i)
  {
    const Point along = line[i] - line[i - 1];
    const int count = static_cast<int>(std::ceil(along.norm() / step));
    for (int k = 1; k < count; ++k)
    {
      dense.emplace_back(line[i - 1] + along * (static_cast<double>(k) / count));
    }
    dense.push_back(line[i]);
  }
  return dense;
}

struct Corner
{
  std::size_t Point;
  double Turn;
};

/// Points that turn by at least the angle, and most within the window.
std::vector<Corner> FindCorners(const Track& track, const OutlineParams& params)
{
  const double window = params.CornerWindow * track.Length();
  const double least = params.CornerAngle * Pi / 180.0;
  const std::size_t first = track.IsClosed ? 0 : 1;
  std::vector<Corner> found;
  for (std::size_t i = first; i + 1 < track.Points.size(); ++i)
  {
    const double turn = track.Turn(i, window);
    // in a bend a quarter of the window turns by a quarter, at a corner by all
    if (std::abs(turn) < least || track.Turn(i, window / 4.0) / turn < 0.5)
    {
      continue;
    }
    if (!found.empty() && track.Lengths[i] - track.Lengths[found.back().Point] < window)
    {
      if (std::abs(turn) > std::abs(found.back().Turn))
      {
        found.back() = { i, turn };
      }
      continue;
    }
    found.push_back({ i, turn });
  }
  if (track.IsClosed && found.size() > 1 &&
    track.Lengths[found.front().Point] + track.Length() - track.Lengths[found.back().Point] <
      window)
  {
    const bool keepsFirst = std::abs(found.front().Turn) >= std::abs(found.back().Turn);
    found.erase(keepsFirst ? found.end() - 1 : found.begin());
  }
  return found;
}

Piece Straight(const Line& points)
{
  Piece piece;
  piece.Knots = { 0.0, 0.0, 1.0, 1.0 };
  piece.Points = { points.front().homogeneous(), points.back().homogeneous() };
  const Point along = points.back() - points.front();
  for (const Point& point : points)
  {
    const double share =
      std::clamp((point - points.front()).dot(along) / along.squaredNorm(), 0.0, 1.0);
    piece.Distance = std::max(piece.Distance, (point - points.front() - share * along).norm());
  }
  return piece;
}

/// The circle through the ends that is nearest to the points; an infinite distance where they do
/// not run around it.
Piece Arc(const Line& points)
{
  Piece piece;
  piece.Degree = 2;
  piece.Distance = std::numeric_limits<double>::infinity();
  const Point middle = (points.front() + points.back()) / 2.0;
  const Point chord = points.back() - points.front();
  const double half = chord.norm() / 2.0;
  const Point normal = Point(-chord.y(), chord.x()).normalized();
  double squares = 0.0;
  double products = 0.0;
  for (const Point& point : points)
  {
    const double height = (point - middle).dot(normal);
    squares += height * height;
    products += height * ((point - middle).squaredNorm() - half * half);
  }
  if (points.size() < 4 || !(squares > 0.0))
  {
    return piece;
  }
  const Point centre = middle + products / (2.0 * squares) * normal;
  const double radius = (points.front() - centre).norm();
  double angle = 0.0;
  double distance = 0.0;
  int backwards = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    const Point a = points[i - 1] - centre;
    const Point b = points[i] - centre;
    const double step = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    backwards += step * (angle + step) < 0.0 ? 1 : 0;
    angle += step;
    distance = std::max(distance, std::abs(b.norm() - radius));
  }
  constexpr double largest = 1.9 * Pi;
  if (std::abs(angle) > largest || backwards > static_cast<int>(points.size()) / 3)
  {
    return piece;
  }
  piece.Distance = distance;
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / (Pi / 2.0) - 1e-9)));
  const double step = angle / count;
  const double weight = std::cos(step / 2.0);
  piece.Knots.assign(3, 0.0);
  piece.Points.emplace_back(points.front().homogeneous());
  Point at = points.front() - centre;
  for (int k = 1; k <= count; ++k)
  {
    const Point shoulder = Eigen::Rotation2Dd(step / 2.0) * at / weight;
    at = k == count ? Point(points.back() - centre) : Point(Eigen::Rotation2Dd(step) * at);
    piece.Points.emplace_back(weight * Point(centre + shoulder).homogeneous());
    piece.Points.emplace_back(
      k == count ? points.back().homogeneous() : Point(centre + at).homogeneous());
    piece.Knots.insert(piece.Knots.end(), k == count ? 3 : 2, static_cast<double>(k) / count);
  }
  return piece;
}

/// The cubic B-splines that are not zero at a parameter, and the number of the first of them.
std::size_t Basis(const std::vector<double>& knots, double at, std::array<double, 4>& values)
{
  constexpr std::size_t degree = 3;
  const auto last = knots.end() - static_cast<std::ptrdiff_t>(degree) - 1;
  const auto next = std::upper_bound(knots.begin() + degree, last, at);
  const auto span =
    std::min(static_cast<std::size_t>(next - knots.begin()) - 1, knots.size() - degree - 2);
  values = { 1.0, 0.0, 0.0, 0.0 };
  for (std::size_t p = 1; p <= degree; ++p)
  {
    double carried = 0.0;
    for (std::size_t r = 0; r < p; ++r)
    {
      const double right = knots[span + r + 1];
      const double left = knots[span + 1 + r - p];
      const double part = values[r] / (right - left);
      values[r] = carried + (right - at) * part;
      carried = (at - left) * part;
    }
    values[p] = carried;
  }
  return span - degree;
}

/// Least squares on given knots, ends kept. @return control points, or none where points are
/// missing on spans.
std::vector<Point> LeastSquares(
  const Line& points, const std::vector<double>& at, const std::vector<double>& knots)
{
  const std::size_t count = knots.size() - 4;
  const auto inner = static_cast<Eigen::Index>(count) - 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(inner, inner);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner, 2);
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const std::size_t first = Basis(knots, at[i], values);
    Point rest = points[i];
    for (std::size_t a = 0; a < 4; ++a)
    {
      rest -= first + a == 0     ? Point(values[a] * points.front())
        : first + a == count - 1 ? Point(values[a] * points.back())
                                 : Point::Zero();
    }
    for (std::size_t a = 0; a < 4; ++a)
    {
      const auto row = static_cast<Eigen::Index>(first + a) - 1;
      if (row < 0 || row >= inner)
      {
        continue;
      }
      right.row(row) += values[a] * rest.transpose();
      for (std::size_t b = 0; b < 4; ++b)
      {
        const auto column = static_cast<Eigen::Index>(first + b) - 1;
        if (column >= 0 && column < inner)
        {
          normal(row, column) += values[a] * values[b];
        }
      }
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  const Eigen::MatrixXd found = solver.solve(right);
  if (solver.info() != Eigen::Success || !found.allFinite())
  {
    return {};
  }
  std::vector<Point> control{ points.front() };
  for (Eigen::Index i = 0; i < inner; ++i)
  {
    control.emplace_back(found.row(i));
  }
  control.push_back(points.back());
  return control;
}

/// Closest points of the curve near the parameters, which go there; the largest distance.
double Correct(const Line& points, const std::vector<double>& knots,
  const std::vector<Point>& control, std::vector<double>& at)
{
  const auto value = [&](double parameter)
  {
    std::array<double, 4> values{};
    const std::size_t first = Basis(knots, parameter, values);
    Point sum = Point::Zero();
    for (std::size_t a = 0; a < 4; ++a)
    {
      sum += values[a] * control[first + a];
    }
    return sum;
  };
  double largest = 0.0;
  constexpr double step = 1e-5;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
  {
    for (int round = 0; round < 2; ++round)
    {
      const double low = std::max(0.0, at[i] - step);
      const double high = std::min(1.0, at[i] + step);
      const Point tangent = (value(high) - value(low)) / (high - low);
      const double square = tangent.squaredNorm();
      const double move = square > 0.0 ? (points[i] - value(at[i])).dot(tangent) / square : 0.0;
      const double next = std::clamp(at[i] + move, 0.0, 1.0);
      if ((points[i] - value(next)).squaredNorm() <= (points[i] - value(at[i])).squaredNorm())
      {
        at[i] = next;
      }
    }
    largest = std::max(largest, (points[i] - value(at[i])).norm());
  }
  return largest;
}

/// A cubic spline near the points; its distance tells whether it is.
Piece Curve(Line points, double tolerance)
{
  constexpr std::size_t fewest = 8;
  while (points.size() < fewest)
  {
    Line denser;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
    {
      denser.push_back(points[i]);
      denser.emplace_back((points[i] + points[i + 1]) / 2.0);
    }
    denser.push_back(points.back());
    points = std::move(denser);
  }
  const Track track(points, false);
  Piece best;
  best.Degree = 3;
  best.Distance = std::numeric_limits<double>::infinity();
  const int most = std::min(MaxSpans, static_cast<int>(points.size()) - 3);
  for (int spans = 1; best.Distance > tolerance; spans = std::min(2 * spans, most))
  {
    std::vector<double> at = track.Lengths;
    for (double& parameter : at)
    {
      parameter /= track.Length();
    }
    std::vector<double> knots(4, 0.0);
    for (int k = 1; k < spans; ++k) // as many points on every span
    {
      const double place = static_cast<double>(k) * static_cast<double>(points.size() - 1) / spans;
      const auto i = std::min(static_cast<std::size_t>(place), points.size() - 2);
      knots.push_back(at[i] + (place - static_cast<double>(i)) * (at[i + 1] - at[i]));
    }
    knots.insert(knots.end(), 4, 1.0);
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round)
    {
      const std::vector<Point> control = LeastSquares(points, at, knots);
      if (control.empty())
      {
        break;
      }
      const double distance = Correct(points, knots, control, at);
      if (distance < best.Distance)
      {
        best.Distance = distance;
        best.Knots = knots;
        best.Points.clear();
        for (const Point& point : control)
        {
          best.Points.emplace_back(point.homogeneous());
        }
      }
      if (!std::is_sorted(at.begin(), at.end()))
      {
        break;
      }
    }
    if (spans == most)
    {
      break;
    }
  }
  return best;
}

/// Segments of Bezier form, one degree higher.
void Elevate(Piece& piece)
{
  const auto p = static_cast<std::size_t>(piece.Degree);
  const std::size_t segments = (piece.Points.size() - 1) / p;
  std::vector<Eigen::Vector3d> points{ piece.Points.front() };
  std::vector<double> knots(p + 2, 0.0);
  for (std::size_t s = 0; s < segments; ++s)
  {
    for (std::size_t i = 1; i <= p; ++i)
    {
      const double share = static_cast<double>(i) / static_cast<double>(p + 1);
      points.emplace_back(
        share * piece.Points[s * p + i - 1] + (1.0 - share) * piece.Points[s * p + i]);
    }
    points.push_back(piece.Points[(s + 1) * p]);
    knots.insert(knots.end(), s + 1 == segments ? p + 2 : p + 1, piece.Knots[(s + 1) * p + 1]);
  }
  ++piece.Degree;
  piece.Points = std::move(points);
  piece.Knots = std::move(knots);
}

/// One spline of pieces that follow each other, continuous between them.
Result<Spline<1>> Join(std::vector<Piece> pieces)
{
  int degree = 1;
  double length = 0.0;
  for (const Piece& piece : pieces)
  {
    degree = std::max(degree, piece.Degree);
    length += piece.Length;
  }
  std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
  std::vector<Eigen::Vector3d> points;
  double begin = 0.0;
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    Piece& piece = pieces[k];
    while (piece.Degree < degree)
    {
      Elevate(piece);
    }
    const double end = k + 1 == pieces.size() ? 1.0 : begin + piece.Length / length;
    const auto p = static_cast<std::size_t>(degree);
    for (std::size_t i = p + 1; i + p + 1 < piece.Knots.size(); ++i)
    {
      knots.push_back(begin + piece.Knots[i] * (end - begin));
    }
    knots.insert(knots.end(), k + 1 == pieces.size() ? p + 1 : p, end);
    points.insert(points.end(), piece.Points.begin() + (k == 0 ? 0 : 1), piece.Points.end());
    begin = end;
  }
  auto made = KnotVector::Create(degree, knots);
  if (!made)
  {
    return made.Status;
  }
  auto space = MakeTensorSpace<1>({ made.Value });
  if (!space)
  {
    return space.Status;
  }
  Spline<1> spline;
  spline.Space = space.Value;
  PointMatrix rows(static_cast<Eigen::Index>(points.size()), 3);
  bool isRational = false;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    isRational = isRational || points[i].z() != 1.0;
  }
  if (isRational)
  {
    spline.SetHomogeneousPoints(rows, true);
  }
  else
  {
    spline.ControlPoints = rows.leftCols(2);
  }
  return spline;
}

class Fitter
{
public:
  Fitter(const OutlineParams& params, double size) : Params(params), Size(size) {}

  OutlineSides Found;

  /// An open line is a side, cut into pieces at its corners.
  Status AddOpen(const Line& points, std::size_t number)
  {
    const Track track(points, false);
    std::vector<std::size_t> ends{ 0 };
    for (const Corner& corner : FindCorners(track, this->Params))
    {
      ends.push_back(corner.Point);
      ++this->Found.NumCorners;
    }
    ends.push_back(points.size() - 1);
    return this->AddSide(points, ends, number);
  }

  /// A closed line begins and ends with one point.
  Status AddClosed(Line points, std::size_t number)
  {
    Track track(points, true);
    std::vector<Corner> corners = FindCorners(track, this->Params);
    this->AddFlatCorners(track, corners);
    this->Found.NumCorners += static_cast<int>(corners.size());
    std::vector<std::size_t> chosen = this->Choose(track, corners, number);
    std::vector<std::size_t> all = chosen;
    for (const Corner& corner : corners)
    {
      all.push_back(corner.Point);
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (std::size_t s = 0; s < chosen.size(); ++s)
    {
      const std::size_t from = chosen[s];
      const std::size_t count = points.size() - 1;
      const std::size_t to = s + 1 < chosen.size() ? chosen[s + 1] : chosen.front() + count;
      Line side;
      std::vector<std::size_t> ends;
      for (std::size_t i = from; i <= to; ++i)
      {
        if (i == from || i == to || std::binary_search(all.begin(), all.end(), i % count))
        {
          ends.push_back(side.size());
        }
        side.push_back(points[i % count]);
      }
      if (Status status = this->AddSide(side, ends, number); !status)
      {
        return status;
      }
    }
    return {};
  }

private:
  /// Where corners are missing: those that turn by half of the angle at least, most first.
  void AddFlatCorners(const Track& track, std::vector<Corner>& corners) const
  {
    const auto wanted = static_cast<std::size_t>(this->Params.NumSides);
    if (corners.size() >= wanted)
    {
      return;
    }
    OutlineParams half = this->Params;
    half.CornerAngle /= 2.0;
    std::vector<Corner> flat = FindCorners(track, half);
    std::stable_sort(flat.begin(), flat.end(),
      [](const Corner& a, const Corner& b) { return std::abs(a.Turn) > std::abs(b.Turn); });
    for (const Corner& corner : flat)
    {
      const bool isKnown = std::any_of(corners.begin(), corners.end(),
        [&corner](const Corner& known) { return known.Point == corner.Point; });
      if (!isKnown && corners.size() < wanted)
      {
        corners.push_back(corner);
      }
    }
    std::sort(corners.begin(), corners.end(),
      [](const Corner& a, const Corner& b) { return a.Point < b.Point; });
  }

  /// Points where sides begin, ascending.
  std::vector<std::size_t> Choose(
    const Track& track, std::vector<Corner> corners, std::size_t number)
  {
    const std::size_t wanted = this->Params.NumSides > 0
      ? static_cast<std::size_t>(this->Params.NumSides)
      : std::max<std::size_t>(corners.size(), 1);
    double area = 0.0;
    for (std::size_t i = 0; i + 1 < track.Points.size(); ++i)
    {
      const Point& a = track.Points[i];
      const Point& b = track.Points[i + 1];
      area += a.x() * b.y() - a.y() * b.x();
    }
    const double sense = area < 0.0 ? -1.0 : 1.0;
    std::stable_sort(corners.begin(), corners.end(),
      [sense](const Corner& a, const Corner& b) { return sense * a.Turn > sense * b.Turn; });
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < std::min(wanted, corners.size()); ++i)
    {
      chosen.push_back(corners[i].Point);
    }
    std::sort(chosen.begin(), chosen.end());
    const std::size_t missing = wanted - chosen.size();
    if (chosen.empty())
    {
      chosen.push_back(0);
    }
    while (chosen.size() < wanted)
    {
      this->HalveLongest(track, chosen);
    }
    if (missing > 0)
    {
      this->Found.Messages.push_back(NameOf(number) + " has " + std::to_string(wanted - missing) +
        " corners: its longest sides are halved, and no map is regular where a smooth line is cut; "
        "lower the corner angle, or give a layout");
    }
    return chosen;
  }

  static void HalveLongest(const Track& track, std::vector<std::size_t>& chosen)
  {
    const double total = track.Length();
    double longest = -1.0;
    double middle = 0.0;
    for (std::size_t s = 0; s < chosen.size(); ++s)
    {
      const double from = track.Lengths[chosen[s]];
      const double to = s + 1 < chosen.size() ? track.Lengths[chosen[s + 1]]
                                              : track.Lengths[chosen.front()] + total;
      if (to - from > longest * (1.0 + 1e-9))
      {
        longest = to - from;
        middle = std::fmod((from + to) / 2.0, total);
      }
    }
    // the nearest point that begins no side yet
    std::size_t best = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < track.Points.size(); ++i)
    {
      const double distance = std::abs(track.Lengths[i] - middle);
      if (std::find(chosen.begin(), chosen.end(), i) == chosen.end() && distance < nearest)
      {
        nearest = distance;
        best = i;
      }
    }
    chosen.push_back(best);
    std::sort(chosen.begin(), chosen.end());
  }

  Status AddSide(const Line& points, const std::vector<std::size_t>& ends, std::size_t number)
  {
    const double tolerance = this->Params.Tolerance * this->Size;
    std::vector<Piece> pieces;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
    {
      const Line part(points.begin() + static_cast<std::ptrdiff_t>(ends[k]),
        points.begin() + static_cast<std::ptrdiff_t>(ends[k + 1]) + 1);
      Piece piece = Straight(part);
      int* counter = &this->Found.NumLines;
      if (piece.Distance > tolerance)
      {
        piece = Arc(part);
        counter = &this->Found.NumArcs;
      }
      if (piece.Distance > tolerance)
      {
        piece = Curve(part, tolerance);
        counter = &this->Found.NumCurves;
      }
      if (piece.Distance > tolerance)
      {
        return { ErrorCode::NotConverged,
          NameOf(number) + ": no curve of " + std::to_string(MaxSpans) +
            " spans is near enough to its points from (" + std::to_string(part.front().x()) + ", " +
            std::to_string(part.front().y()) + ") on; raise the outline's tolerance" };
      }
      ++*counter;
      piece.Length = Track(part, false).Length();
      this->Found.MaxDistance = std::max(this->Found.MaxDistance, piece.Distance);
      pieces.push_back(std::move(piece));
    }
    auto side = Join(std::move(pieces));
    this->Found.Sides.push_back(std::move(side.Value));
    return side.Status;
  }

  const OutlineParams& Params;
  double Size;
};

Status CheckParams(const OutlineParams& params)
{
  const auto isWithin = [](double value, double low, double high)
  { return value >= low && value <= high; };
  if (!isWithin(params.Tolerance, 1e-9, 0.1) || !isWithin(params.CornerAngle, 5.0, 170.0) ||
    !isWithin(params.CornerWindow, 1e-4, 0.2) || params.NumSides < 0)
  {
    return { ErrorCode::InvalidParameter,
      "tolerance, corner angle or corner window of an outline are outside of their ranges" };
  }
  return {};
}

/// The ends of open lines that are near to each other become one point.
Status JoinEnds(std::vector<Line>& lines, const std::vector<bool>& isClosed, double most)
{
  struct End
  {
    std::size_t Line;
    bool IsLast;
  };
  std::vector<End> ends;
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    if (!isClosed[i])
    {
      ends.push_back({ i, false });
      ends.push_back({ i, true });
    }
  }
  const auto at = [&lines](const End& end) -> Point&
  { return end.IsLast ? lines[end.Line].back() : lines[end.Line].front(); };
  std::vector<bool> isDone(ends.size(), false);
  for (std::size_t i = 0; i < ends.size(); ++i)
  {
    if (isDone[i])
    {
      continue;
    }
    std::vector<std::size_t> group{ i };
    Point sum = at(ends[i]);
    for (std::size_t k = i + 1; k < ends.size(); ++k)
    {
      if (!isDone[k] && (at(ends[k]) - at(ends[i])).norm() <= most)
      {
        group.push_back(k);
        sum += at(ends[k]);
      }
    }
    if (group.size() < 2)
    {
      const Point& lone = at(ends[i]);
      return { ErrorCode::InvalidTopology,
        NameOf(ends[i].Line) + " " + (ends[i].IsLast ? "ends" : "begins") + " at (" +
          std::to_string(lone.x()) + ", " + std::to_string(lone.y()) +
          "), where no other line has an end; draw it to where the next one begins" };
    }
    for (const std::size_t k : group)
    {
      isDone[k] = true;
      at(ends[k]) = sum / static_cast<double>(group.size());
    }
  }
  return {};
}
}

Result<OutlineSides> FitOutline(const std::vector<PointMatrix>& given, const OutlineParams& params)
{
  if (Status status = CheckParams(params); !status)
  {
    return status;
  }
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    if (given[i].cols() != 2)
    {
      return { ErrorCode::SizeMismatch, NameOf(i) + " has points that are not of two numbers" };
    }
    for (Eigen::Index k = 0; k < given[i].rows(); ++k)
    {
      const Point point = given[i].row(k);
      if (!point.allFinite())
      {
        return { ErrorCode::NonFiniteInput,
          NameOf(i) + ": point " + std::to_string(k) + " is not finite" };
      }
      box.extend(point);
    }
  }
  if (given.empty() || box.isEmpty() || !(box.diagonal().norm() > 0.0))
  {
    return { ErrorCode::EmptyInput, "there is no line; draw one closed line or the sides" };
  }
  const double size = box.diagonal().norm();
  std::vector<Line> lines;
  std::vector<bool> isClosed;
  for (std::size_t i = 0; i < given.size(); ++i)
  {
    Line line;
    for (Eigen::Index k = 0; k < given[i].rows(); ++k)
    {
      const Point point = given[i].row(k);
      if (line.empty() || (point - line.back()).norm() > 1e-12 * size)
      {
        line.push_back(point);
      }
    }
    if (line.size() < 2)
    {
      return { ErrorCode::EmptyInput, NameOf(i) + " has less than two different points" };
    }
    const double gap = (line.back() - line.front()).norm();
    const double length = Track(line, false).Length();
    isClosed.push_back(line.size() > 3 && gap <= JoinDistance * size && gap < length / 4.0);
    if (isClosed.back())
    {
      line.front() = line.back() = (line.front() + line.back()) / 2.0;
      line = Densified(line);
    }
    lines.push_back(std::move(line));
  }
  const auto numClosed = std::count(isClosed.begin(), isClosed.end(), true);
  const bool isOne = lines.size() == 1;
  if (isOne && numClosed == 0)
  {
    return { ErrorCode::InvalidTopology,
      "the line ends " + std::to_string((lines[0].back() - lines[0].front()).norm()) +
        " from where it begins; close it, or draw every side as a line of its own" };
  }
  if (params.NumSides > 0 && !isOne &&
    (numClosed > 0 || lines.size() != static_cast<std::size_t>(params.NumSides)))
  {
    return { ErrorCode::InvalidTopology,
      "there are " + std::to_string(lines.size()) + " lines, " + std::to_string(numClosed) +
        " of them closed; draw one closed line or " + std::to_string(params.NumSides) +
        " open ones, or give a layout" };
  }
  if (Status status = JoinEnds(lines, isClosed, JoinDistance * size); !status)
  {
    return status;
  }
  Fitter fitter(params, size);
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    const Status status = isClosed[i] ? fitter.AddClosed(lines[i], i) : fitter.AddOpen(lines[i], i);
    if (!status)
    {
      return status;
    }
  }
  return std::move(fitter.Found);
}
}
