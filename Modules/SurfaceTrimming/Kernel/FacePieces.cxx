// SPDX-License-Identifier: BSD-3-Clause
#include "FacePieces.h"

#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
/// Of coordinates: covers the rounding of halving and restriction.
constexpr double Margin = 1e-13;
/// Points on an element's part of an edge at most.
constexpr double MostSamples = 100000.0;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Points of n control points, homogeneous when rational.
Eigen::Matrix3Xd Euclidean(const double* control, int n, bool isRational)
{
  Eigen::Matrix3Xd points(3, n);
  for (int i = 0; i < n; ++i)
  {
    const double weight = isRational ? control[3 * n + i] : 1.0;
    for (int c = 0; c < 3; ++c)
    {
      points(c, i) = control[c * n + i] / weight;
    }
  }
  return points;
}

double Length(const Eigen::Matrix3Xd& points, int first, int step, int count)
{
  double sum = 0.0;
  for (int i = 1; i < count; ++i)
  {
    sum += (points.col(first + i * step) - points.col(first + (i - 1) * step)).norm();
  }
  return sum;
}

int NumSamples(double length, double spacing)
{
  return 2 + static_cast<int>(std::min(MostSamples, 2.0 * length / spacing));
}

/// What is known of the tangents in one direction of a part of a rational element: a multiple of
/// S_u is N_u w - N w_u, whose origin is put into the middle of the part, where N is small.
class TangentBound
{
public:
  TangentBound(const double* control, const IntArray<2>& degree, bool isRational)
    : Control(control), Degree(degree), Rational(isRational), N(NumTensorFunctions<2>(degree))
  {
    if (isRational)
    {
      this->Origin = Euclidean(control, this->N, true).rowwise().mean();
    }
  }

  /// Mean of the differences of control points.
  Point3 Mean(int direction) const
  {
    const Eigen::Matrix3Xd points = Euclidean(this->Control, this->N, this->Rational);
    const int step = direction == 0 ? 1 : this->Degree[0] + 1;
    Point3 sum = Point3::Zero();
    this->ForDifferences(direction, [&](int i) { sum += points.col(i + step) - points.col(i); });
    return sum;
  }

  /// Whether w . S_d > 0 throughout.
  bool IsPositive(const Point3& w, int direction) const
  {
    const int step = direction == 0 ? 1 : this->Degree[0] + 1;
    double least = Infinity;
    double largest = 0.0;
    double change = 0.0; // of the weights
    this->ForDifferences(direction,
      [&](int i)
      {
        least = std::min(least, this->Value(w, i + step) - this->Value(w, i));
        if (this->Rational)
        {
          change = std::max(change,
            std::abs(this->Control[3 * this->N + i + step] - this->Control[3 * this->N + i]));
        }
      });
    double lightest = 1.0;
    if (this->Rational)
    {
      lightest = Infinity;
      for (int i = 0; i < this->N; ++i)
      {
        lightest = std::min(lightest, this->Control[3 * this->N + i]);
      }
    }
    double size = 0.0;
    for (int i = 0; i < this->N; ++i)
    {
      largest = std::max(largest, std::abs(this->Value(w, i)));
      for (int c = 0; c < 3; ++c)
      {
        size = std::max(size, std::abs(this->Control[c * this->N + i]));
      }
    }
    return least > 0.0 && least * lightest > largest * change + Margin * size * lightest;
  }

private:
  double Value(const Point3& w, int i) const
  {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      sum += w[c] * this->Control[c * this->N + i];
    }
    return this->Rational ? sum - w.dot(this->Origin) * this->Control[3 * this->N + i] : sum;
  }

  template <class Use>
  void ForDifferences(int direction, Use&& use) const
  {
    const int row = this->Degree[0] + 1;
    for (int i = 0; i < this->N; ++i)
    {
      if (direction == 0 ? i % row < this->Degree[0] : i / row < this->Degree[1])
      {
        use(i);
      }
    }
  }

  const double* Control;
  const IntArray<2>& Degree;
  bool Rational;
  int N;
  Point3 Origin = Point3::Zero();
};
}

Result<FaceShape> FaceShape::Create(const TrimmedFace& face, double spacing, int threads)
{
  FaceShape shape;
  auto region = TrimmedRegion::Create(face.Loops);
  if (!region)
  {
    return region.Status;
  }
  shape.Region = std::move(region.Value);
  shape.Form = MakeBezierForm<2>(face.Surface, threads);
  const auto& elements = shape.Form.Space->Elements;
  for (const auto& element : elements)
  {
    if (element.Box.Lower[1] == elements.front().Box.Lower[1])
    {
      shape.Breaks[0].push_back(element.Box.Lower[0]);
    }
    if (element.Box.Lower[0] == elements.front().Box.Lower[0])
    {
      shape.Breaks[1].push_back(element.Box.Lower[1]);
    }
  }
  shape.Number = { static_cast<int>(shape.Breaks[0].size()),
    static_cast<int>(shape.Breaks[1].size()) };
  shape.Box = { elements.front().Box.Lower, elements.back().Box.Upper };
  for (std::size_t d = 0; d < 2; ++d)
  {
    shape.Breaks[d].push_back(shape.Box.Upper[d]);
  }
  const auto count = static_cast<Eigen::Index>(elements.size());
  shape.ElementLower.resize(3, count);
  shape.ElementUpper.resize(3, count);
  shape.ElementPlaces.resize(elements.size());
  ParallelFor(elements.size(), 64, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const Eigen::Matrix3Xd points = Euclidean(shape.Form.Block(static_cast<int>(e)),
          NumTensorFunctions<2>(elements[e].Degree), shape.Form.Rational);
        const Point3 slack = Margin * points.rowwise().lpNorm<Eigen::Infinity>();
        const auto column = static_cast<Eigen::Index>(e);
        shape.ElementLower.col(column) = points.rowwise().minCoeff() - slack;
        shape.ElementUpper.col(column) = points.rowwise().maxCoeff() + slack;
        shape.ElementPlaces[e] =
          shape.Region.Classify(elements[e].Box.Lower, elements[e].Box.Upper);
      }
    });
  shape.BoxLower.setConstant(Infinity);
  shape.BoxUpper.setConstant(-Infinity);
  for (Eigen::Index e = 0; e < count; ++e)
  {
    if (shape.ElementPlaces[static_cast<std::size_t>(e)] != RegionPlace::Outside)
    {
      shape.BoxLower = shape.BoxLower.cwiseMin(shape.ElementLower.col(e));
      shape.BoxUpper = shape.BoxUpper.cwiseMax(shape.ElementUpper.col(e));
      shape.Empty = false;
    }
  }
  shape.SampleEdges(face, spacing, threads);
  return shape;
}

void FaceShape::SampleEdges(const TrimmedFace& face, double spacing, int threads)
{
  std::vector<PointMatrix> parts;
  for (const TrimmedLoop& loop : face.Loops)
  {
    for (const TrimmingCurve& curve : loop.Curves)
    {
      const BezierForm<1> form = MakeBezierForm<1>(curve.Curve, threads);
      for (int e = 0; e < form.Space->NumElements(); ++e)
      {
        const int n = form.Space->Elements[At(e)].Degree[0] + 1;
        const int samples =
          NumSamples(Length(Euclidean(form.Block(e), n, form.Rational), 0, 1, n), spacing);
        const PointMatrix local = Eigen::VectorXd::LinSpaced(samples, 0.0, 1.0);
        EvaluationBatch batch;
        EvaluateElements<1>(form, std::vector<int>(At(samples), e), local, { 0, 1 }, batch);
        parts.push_back(batch.Values);
      }
    }
  }
  // without loops the four sides
  for (std::size_t d = 0; d < 2 && face.Loops.empty(); ++d)
  {
    for (int end = 0; end < 2; ++end)
    {
      for (int k = 0; k < this->Number[d]; ++k)
      {
        const int across = end == 0 ? 0 : this->Number[1 - d] - 1;
        const int e = d == 0 ? this->Element(k, across) : this->Element(across, k);
        const IntArray<2>& degree = this->Form.Space->Elements[At(e)].Degree;
        const int row = degree[0] + 1;
        const Eigen::Matrix3Xd points =
          Euclidean(this->Form.Block(e), NumTensorFunctions<2>(degree), this->Form.Rational);
        const int first = end == 0 ? 0 : (d == 0 ? row * degree[1] : degree[0]);
        const int samples =
          NumSamples(Length(points, first, d == 0 ? 1 : row, degree[d] + 1), spacing);
        PointMatrix local = PointMatrix::Constant(samples, 2, end);
        local.col(static_cast<Eigen::Index>(d)) = Eigen::VectorXd::LinSpaced(samples, 0.0, 1.0);
        EvaluationBatch batch;
        EvaluateElements<2>(this->Form, std::vector<int>(At(samples), e), local, { 0, 1 }, batch);
        parts.push_back(batch.Values);
      }
    }
  }
  Eigen::Index rows = 0;
  for (const PointMatrix& part : parts)
  {
    rows += part.rows();
  }
  PointMatrix all(rows, 3);
  rows = 0;
  for (const PointMatrix& part : parts)
  {
    all.middleRows(rows, part.rows()) = part;
    rows += part.rows();
  }
  this->Edges = SampleIndex(std::move(all));
}

FacePiece FaceShape::Root() const
{
  FacePiece root;
  root.End = this->Number;
  this->SetExtent(root);
  return root;
}

void FaceShape::SetExtent(FacePiece& piece) const
{
  const int first = this->Element(piece.Begin[0], piece.Begin[1]);
  const bool isOne = piece.End[0] == piece.Begin[0] + 1 && piece.End[1] == piece.Begin[1] + 1;
  if (piece.Control.empty())
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      piece.Parameters.Lower[d] = this->Breaks[d][At(piece.Begin[d])];
      piece.Parameters.Upper[d] = this->Breaks[d][At(piece.End[d])];
    }
    piece.Lower.setConstant(Infinity);
    piece.Upper.setConstant(-Infinity);
    bool isOutside = true;
    for (int j = piece.Begin[1]; j < piece.End[1]; ++j)
    {
      for (int i = piece.Begin[0]; i < piece.End[0]; ++i)
      {
        const int e = this->Element(i, j);
        if (this->ElementPlaces[At(e)] != RegionPlace::Outside)
        {
          isOutside = false;
          piece.Lower = piece.Lower.cwiseMin(this->ElementLower.col(e));
          piece.Upper = piece.Upper.cwiseMax(this->ElementUpper.col(e));
        }
      }
    }
    piece.Place = isOutside ? RegionPlace::Outside
      : isOne               ? this->ElementPlaces[At(first)]
                            : RegionPlace::Boundary;
    if (!isOne || isOutside)
    {
      return;
    }
    const int n = NumTensorFunctions<2>(this->Form.Space->Elements[At(first)].Degree);
    piece.Control.assign(
      this->Form.Block(first), this->Form.Block(first) + this->Form.NumPlanes() * n);
  }
  const Eigen::Matrix3Xd points = this->ControlPoints(piece);
  const Point3 slack = Margin * points.rowwise().lpNorm<Eigen::Infinity>();
  piece.Lower = points.rowwise().minCoeff() - slack;
  piece.Upper = points.rowwise().maxCoeff() + slack;
  const int row = this->Form.Space->Elements[At(first)].Degree[0] + 1;
  const Eigen::Index last = points.cols() - 1;
  const Point3 normal = Point3(points.col(last) - points.col(0))
                          .cross(points.col(last - row + 1) - points.col(row - 1));
  if (normal.norm() > 0.0)
  {
    piece.Across = normal.normalized();
    const Eigen::RowVectorXd heights = piece.Across.transpose() * points;
    const double error = Margin * points.cwiseAbs().maxCoeff();
    piece.Least = heights.minCoeff() - error;
    piece.Most = heights.maxCoeff() + error;
  }
}

Eigen::Matrix3Xd FaceShape::ControlPoints(const FacePiece& piece) const
{
  const int n = static_cast<int>(piece.Control.size()) / this->Form.NumPlanes();
  return Euclidean(piece.Control.data(), n, this->Form.Rational);
}

void FaceShape::Divide(int number, std::vector<FacePiece>& pieces) const
{
  FacePiece piece = pieces[At(number)];
  std::array<FacePiece, 2> halves;
  if (piece.Control.empty())
  {
    const std::size_t d = piece.End[0] - piece.Begin[0] >= piece.End[1] - piece.Begin[1] ? 0 : 1;
    for (FacePiece& half : halves)
    {
      half.Begin = piece.Begin;
      half.End = piece.End;
    }
    halves[0].End[d] = halves[1].Begin[d] = (piece.Begin[d] + piece.End[d]) / 2;
    this->SetExtent(halves[0]);
    this->SetExtent(halves[1]);
  }
  else
  {
    const IntArray<2>& degree =
      this->Form.Space->Elements[At(this->Element(piece.Begin[0], piece.Begin[1]))].Degree;
    const int row = degree[0] + 1;
    const int n = row * (degree[1] + 1);
    const Eigen::Matrix3Xd points = this->ControlPoints(piece);
    std::array<double, 2> lengths{};
    for (int j = 0; j <= degree[1]; ++j)
    {
      lengths[0] = std::max(lengths[0], Length(points, j * row, 1, row));
    }
    for (int i = 0; i < row; ++i)
    {
      lengths[1] = std::max(lengths[1], Length(points, i, row, degree[1] + 1));
    }
    const std::size_t d = lengths[0] >= lengths[1] ? 0 : 1;
    const double middle = 0.5 * (piece.Parameters.Lower[d] + piece.Parameters.Upper[d]);
    std::vector<double> lower(piece.Control.size());
    for (int plane = 0; plane < this->Form.NumPlanes(); ++plane)
    {
      for (int line = 0; line <= degree[1 - d]; ++line)
      {
        const int at = plane * n + (d == 0 ? line * row : line);
        HalveBernstein(degree[d], piece.Control.data() + at, lower.data() + at, d == 0 ? 1 : row);
      }
    }
    for (FacePiece& half : halves)
    {
      half.Begin = piece.Begin;
      half.End = piece.End;
      half.Parameters = piece.Parameters;
      half.Place = piece.Place;
    }
    halves[0].Parameters.Upper[d] = halves[1].Parameters.Lower[d] = middle;
    halves[0].Control = std::move(lower);
    halves[1].Control = std::move(piece.Control);
    for (FacePiece& half : halves)
    {
      this->SetExtent(half);
      if (half.Place == RegionPlace::Boundary)
      {
        half.Place = this->Region.Classify(half.Parameters.Lower, half.Parameters.Upper);
      }
    }
  }
  const int first = static_cast<int>(pieces.size());
  int count = 0;
  for (FacePiece& half : halves)
  {
    if (half.Place != RegionPlace::Outside)
    {
      pieces.push_back(std::move(half));
      ++count;
    }
  }
  pieces[At(number)].Children = first;
  pieces[At(number)].NumChildren = count;
}

void FaceShape::Restrict(
  int element, const ParametricBox<2>& box, std::vector<double>& control) const
{
  const auto& own = this->Form.Space->Elements[At(element)];
  const int n = NumTensorFunctions<2>(own.Degree);
  const double* block = this->Form.Block(element);
  control.assign(block, block + this->Form.NumPlanes() * n);
  double matrices[2][(MaxDegree + 1) * (MaxDegree + 1)];
  std::array<const double*, 2> factors{ nullptr, nullptr };
  for (std::size_t d = 0; d < 2; ++d)
  {
    const double length = own.Box.Upper[d] - own.Box.Lower[d];
    const double lower = std::max(0.0, (box.Lower[d] - own.Box.Lower[d]) / length);
    const double upper = std::min(1.0, (box.Upper[d] - own.Box.Lower[d]) / length);
    if (lower > 0.0 || upper < 1.0)
    {
      BernsteinRestriction(own.Degree[d], lower, upper, matrices[d]);
      factors[d] = matrices[d];
    }
  }
  if (factors[0] || factors[1])
  {
    for (int plane = 0; plane < this->Form.NumPlanes(); ++plane)
    {
      ApplyFactors<2>(own.Degree, factors, block + plane * n, control.data() + plane * n);
    }
  }
}

bool FaceShape::IsSimple(const ParametricBox<2>& box) const
{
  std::array<int, 2> begin{};
  std::array<int, 2> end{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto& breaks = this->Breaks[d];
    begin[d] = static_cast<int>(
      std::upper_bound(breaks.begin(), breaks.end() - 1, box.Lower[d]) - breaks.begin() - 1);
    begin[d] = std::clamp(begin[d], 0, this->Number[d] - 1);
    end[d] = begin[d] + 1;
    while (end[d] < this->Number[d] && breaks[At(end[d])] < box.Upper[d])
    {
      ++end[d];
    }
  }
  const auto forElements = [&](auto&& use)
  {
    std::vector<double> control;
    for (int j = begin[1]; j < end[1]; ++j)
    {
      for (int i = begin[0]; i < end[0]; ++i)
      {
        const int e = this->Element(i, j);
        this->Restrict(e, box, control);
        if (!use(TangentBound(
              control.data(), this->Form.Space->Elements[At(e)].Degree, this->Form.Rational)))
        {
          return false;
        }
      }
    }
    return true;
  };
  Point3 u = Point3::Zero();
  Point3 v = Point3::Zero();
  forElements(
    [&](const TangentBound& tangents)
    {
      u += tangents.Mean(0);
      v += tangents.Mean(1);
      return true;
    });
  if (!(u.norm() > 0.0) || !(v.norm() > 0.0))
  {
    return false;
  }
  u.normalize();
  v.normalize();
  const Point3 w = u + v;
  const Point3 z = u - v;
  return forElements(
    [&](const TangentBound& tangents)
    {
      return tangents.IsPositive(w, 0) && tangents.IsPositive(w, 1) && tangents.IsPositive(z, 0) &&
        tangents.IsPositive(-z, 1);
    });
}

double FaceShape::DistanceToEdges(const Point3& point) const
{
  const NearestItem nearest = this->Edges.Nearest(point.data());
  return nearest.Item < 0 ? Infinity : std::sqrt(nearest.SquaredDistance);
}

Eigen::Matrix3d FaceShape::Evaluate(const RealArray<2>& parameters) const
{
  PointMatrix at(1, 2);
  at << parameters[0], parameters[1];
  EvaluationBatch batch;
  EvaluateParameters<2>(this->Form, at, { 1, 1 }, batch);
  Eigen::Matrix3d result;
  result.col(0) = batch.Values.row(0).transpose();
  result.col(1) = batch.First.row(0).head<3>().transpose();
  result.col(2) = batch.First.row(0).tail<3>().transpose();
  return result;
}
}
