// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryFaults.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BoxTree.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace knotwork
{
namespace
{
using Vector = Eigen::RowVector3d;

/// Samples a direction of an element.
constexpr int PerElement = 4;
/// Newton's method is tried at so many places that look like crossings.
constexpr int MostCandidates = 400;
/// Half the size of the box in which a crossing is proved, of an element's interval.
constexpr double ProofRadius = 1e-7;

/// Bounds of an element's derivatives with respect to its own parameters in [0, 1].
struct SlopeBounds
{
  double First = 0.0;
  double Second = 0.0;
};

/// One face, sampled, and its elements.
class Face
{
public:
  explicit Face(const Spline<2>& face) : Form(MakeBezierForm<2>(face, 1))
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      const std::vector<double>& breaks = face.Space->Knots[d].Breaks();
      this->Breaks[d] = breaks;
      for (std::size_t e = 0; e + 1 < breaks.size(); ++e)
      {
        for (int i = 0; i < PerElement; ++i)
        {
          this->Lines[d].push_back(breaks[e] + (breaks[e + 1] - breaks[e]) * i / PerElement);
        }
      }
      this->Lines[d].push_back(breaks.back());
    }
    PointMatrix parameters(this->Count(0) * this->Count(1), 2);
    for (int i = 0; i < parameters.rows(); ++i)
    {
      parameters.row(i) << this->Lines[0][static_cast<std::size_t>(i % this->Count(0))],
        this->Lines[1][static_cast<std::size_t>(i / this->Count(0))];
    }
    EvaluationParams params;
    params.Threads = 1;
    EvaluationBatch batch;
    EvaluateParameters<2>(this->Form, parameters, params, batch);
    this->Points = batch.Values;
  }

  int Count(std::size_t d) const { return static_cast<int>(this->Lines[d].size()); }
  Vector Point(int i, int j) const { return this->Points.row(j * this->Count(0) + i); }
  double Line(std::size_t d, int i) const { return this->Lines[d][static_cast<std::size_t>(i)]; }

  /// Value and both tangents. @pre u in [0, 1]^2
  void Evaluate(const std::array<double, 2>& u, Vector& x, std::array<Vector, 2>& tangents) const
  {
    PointMatrix parameters(1, 2);
    parameters << u[0], u[1];
    EvaluationParams params;
    params.Derivatives = 1;
    params.Threads = 1;
    EvaluationBatch batch;
    EvaluateParameters<2>(this->Form, parameters, params, batch);
    x = batch.Values.row(0);
    tangents = { batch.First.row(0).head<3>(), batch.First.row(0).tail<3>() };
  }

  /// The element around u, when u +- radius of its intervals lies inside it; -1 otherwise.
  /// @param lengths  of its intervals.
  int ElementAround(const std::array<double, 2>& u, std::array<double, 2>& lengths) const
  {
    int element = 0;
    int stride = 1;
    for (std::size_t d = 0; d < 2; ++d)
    {
      const std::vector<double>& breaks = this->Breaks[d];
      const auto above = std::upper_bound(breaks.begin(), breaks.end(), u[d]);
      if (above == breaks.begin() || above == breaks.end())
      {
        return -1;
      }
      const double length = *above - *(above - 1);
      const double share = (u[d] - *(above - 1)) / length;
      if (!(share > 4.0 * ProofRadius && share < 1.0 - 4.0 * ProofRadius))
      {
        return -1;
      }
      lengths[d] = length;
      element += stride * static_cast<int>(above - 1 - breaks.begin());
      stride *= static_cast<int>(breaks.size()) - 1;
    }
    return element;
  }

  /// Coarse bounds from the control points; of the quotient when rational.
  SlopeBounds Bounds(int element) const
  {
    const auto& degrees = this->Form.Space->Elements[static_cast<std::size_t>(element)].Degree;
    const int n = (degrees[0] + 1) * (degrees[1] + 1);
    const double p = std::max(degrees[0], degrees[1]);
    const double* block = this->Form.Block(element);
    const auto weight = [&](int i) { return this->Form.Rational ? block[3 * n + i] : 1.0; };
    double leastWeight = std::numeric_limits<double>::infinity();
    double mostWeight = 0.0;
    double reach = 0.0; // of the homogeneous points, the first one taken for the origin
    double extent = 0.0;
    for (int i = 0; i < n; ++i)
    {
      leastWeight = std::min(leastWeight, weight(i));
      mostWeight = std::max(mostWeight, weight(i));
      for (int c = 0; c < 3; ++c)
      {
        const double away = block[c * n + i] / weight(i) - block[c * n] / weight(0);
        extent = std::max(extent, std::abs(away));
        reach = std::max(reach, std::abs(away) * weight(i));
      }
    }
    // a k-th difference of numbers within [-r, r] is at most 2^k r
    const double first = 2.0 * p * reach;
    const double second = 4.0 * p * p * reach;
    const double spread = this->Form.Rational ? mostWeight - leastWeight : 0.0;
    SlopeBounds bounds;
    bounds.First = (first + extent * 2.0 * p * spread) / leastWeight;
    bounds.Second =
      (second + 2.0 * bounds.First * 2.0 * p * spread + extent * 4.0 * p * p * spread) /
      leastWeight;
    return bounds;
  }

private:
  BezierForm<2> Form;
  std::array<std::vector<double>, 2> Breaks;
  std::array<std::vector<double>, 2> Lines;
  PointMatrix Points;
};

/// Whether the segment from a to b passes through the triangle.
bool Passes(const Vector& a, const Vector& b, const std::array<Vector, 3>& t)
{
  const Vector normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double da = normal.dot(a - t[0]);
  const double db = normal.dot(b - t[0]);
  if (!(da * db < 0.0))
  {
    return false;
  }
  const Vector x = a + da / (da - db) * (b - a);
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Vector edge = t[(k + 1) % 3] - t[k];
    if (normal.dot(edge.cross(x - t[k])) < 0.0)
    {
      return false;
    }
  }
  return true;
}

/// A line of face A (its direction `along`, from u) and face B.
struct Candidate
{
  int A = 0;
  int B = 0;
  std::size_t Along = 0;
  std::array<double, 2> OnA{};
  std::array<double, 2> OnB{};
};

class FaceCrossingSearch
{
public:
  explicit FaceCrossingSearch(const CompatibleBoundary<3>& boundary)
  {
    for (const Spline<2>& side : boundary.Sides)
    {
      this->Faces.emplace_back(side);
      this->Largest = std::max(this->Largest, side.ControlPoints.cwiseAbs().maxCoeff());
    }
    this->MakeTree();
  }

  /// The first crossing that is proved.
  bool Find(std::array<int, 2>& sides, Vector& position)
  {
    int tries = 0;
    for (int a = 0; a < 6; ++a)
    {
      const Face& face = this->Faces[static_cast<std::size_t>(a)];
      for (std::size_t along = 0; along < 2; ++along)
      {
        for (int j = 1; j + 1 < face.Count(1 - along); ++j)
        {
          for (int i = 0; i + 1 < face.Count(along); ++i)
          {
            if (this->TrySegment(a, along, i, j, tries, sides, position))
            {
              return true;
            }
            if (tries >= MostCandidates)
            {
              return false;
            }
          }
        }
      }
    }
    return false;
  }

private:
  struct Triangle
  {
    int Face, I, J, Half;
  };

  std::array<Vector, 3> Corners(const Triangle& t) const
  {
    const Face& face = this->Faces[static_cast<std::size_t>(t.Face)];
    if (t.Half == 0)
    {
      return { face.Point(t.I, t.J), face.Point(t.I + 1, t.J), face.Point(t.I, t.J + 1) };
    }
    return { face.Point(t.I + 1, t.J + 1), face.Point(t.I, t.J + 1), face.Point(t.I + 1, t.J) };
  }

  void MakeTree()
  {
    for (int f = 0; f < 6; ++f)
    {
      const Face& face = this->Faces[static_cast<std::size_t>(f)];
      for (int j = 0; j + 1 < face.Count(1); ++j)
      {
        for (int i = 0; i + 1 < face.Count(0); ++i)
        {
          this->Triangles.push_back({ f, i, j, 0 });
          this->Triangles.push_back({ f, i, j, 1 });
        }
      }
    }
    const Eigen::Index n = static_cast<Eigen::Index>(this->Triangles.size());
    PointMatrix lower(n, 3);
    PointMatrix upper(n, 3);
    for (Eigen::Index k = 0; k < n; ++k)
    {
      const auto corners = this->Corners(this->Triangles[static_cast<std::size_t>(k)]);
      lower.row(k) = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      upper.row(k) = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    }
    this->Tree = BoxTree(lower, upper);
  }

  bool TrySegment(int a, std::size_t along, int i, int j, int& tries, std::array<int, 2>& sides,
    Vector& position) const
  {
    const Face& face = this->Faces[static_cast<std::size_t>(a)];
    const auto at = [&](int k) { return along == 0 ? face.Point(k, j) : face.Point(j, k); };
    const Vector begin = at(i);
    const Vector end = at(i + 1);
    const Vector lower = begin.cwiseMin(end);
    const Vector upper = begin.cwiseMax(end);
    bool found = false;
    this->Tree.ForNear(lower.data(), upper.data(),
      [&](int item)
      {
        const Triangle& t = this->Triangles[static_cast<std::size_t>(item)];
        const int onA[2] = { along == 0 ? i : j, along == 0 ? j : i };
        const bool beside =
          t.Face == a && std::abs(t.I - onA[0]) <= 2 && std::abs(t.J - onA[1]) <= 2;
        if (found || beside || tries >= MostCandidates || !Passes(begin, end, this->Corners(t)))
        {
          return;
        }
        ++tries;
        const Face& other = this->Faces[static_cast<std::size_t>(t.Face)];
        Candidate candidate;
        candidate.A = a;
        candidate.B = t.Face;
        candidate.Along = along;
        candidate.OnA[along] = 0.5 * (face.Line(along, i) + face.Line(along, i + 1));
        candidate.OnA[1 - along] = face.Line(1 - along, j);
        candidate.OnB = { 0.5 * (other.Line(0, t.I) + other.Line(0, t.I + 1)),
          0.5 * (other.Line(1, t.J) + other.Line(1, t.J + 1)) };
        // off the knots: elements meet there
        const double step = face.Line(1 - along, j + 1) - face.Line(1 - along, j);
        candidate.OnA[1 - along] += 0.137 * step;
        if (this->Prove(candidate, position))
        {
          sides = { a, t.Face };
          found = true;
        }
      });
    return found;
  }

  /// Newton's method for A(t) = B(u, v), then Brouwer's theorem: x -> x - Y F(x) takes a box of
  /// half the size r into itself, since there |Y F(c)| + |Y| M r^2 / 2 * 9 < r, M the largest
  /// second derivative.
  bool Prove(const Candidate& candidate, Vector& position) const
  {
    const Face& a = this->Faces[static_cast<std::size_t>(candidate.A)];
    const Face& b = this->Faces[static_cast<std::size_t>(candidate.B)];
    std::array<double, 2> s = candidate.OnA;
    std::array<double, 2> u = candidate.OnB;
    Vector xa, xb;
    std::array<Vector, 2> ta, tb;
    Eigen::Matrix3d jacobian;
    for (int iteration = 0; iteration < 12; ++iteration)
    {
      a.Evaluate(s, xa, ta);
      b.Evaluate(u, xb, tb);
      jacobian.col(0) = tb[0].transpose();
      jacobian.col(1) = tb[1].transpose();
      jacobian.col(2) = -ta[candidate.Along].transpose();
      const Eigen::Vector3d step = jacobian.fullPivLu().solve((xa - xb).transpose());
      if (!step.allFinite())
      {
        return false;
      }
      u[0] = std::clamp(u[0] + step[0], 0.0, 1.0);
      u[1] = std::clamp(u[1] + step[1], 0.0, 1.0);
      s[candidate.Along] = std::clamp(s[candidate.Along] + step[2], 0.0, 1.0);
    }
    std::array<double, 2> lengthsA, lengthsB;
    const int elementA = a.ElementAround(s, lengthsA);
    const int elementB = b.ElementAround(u, lengthsB);
    if (elementA < 0 || elementB < 0)
    {
      return false;
    }
    if (candidate.A == candidate.B &&
      std::max(std::abs(s[0] - u[0]) / lengthsA[0], std::abs(s[1] - u[1]) / lengthsA[1]) < 1e-3)
    {
      return false; // the same point
    }
    a.Evaluate(s, xa, ta);
    b.Evaluate(u, xb, tb);
    jacobian.col(0) = lengthsB[0] * tb[0].transpose();
    jacobian.col(1) = lengthsB[1] * tb[1].transpose();
    jacobian.col(2) = -lengthsA[candidate.Along] * ta[candidate.Along].transpose();
    const Eigen::Matrix3d inverse = jacobian.inverse();
    if (!inverse.allFinite())
    {
      return false;
    }
    const double norm = inverse.cwiseAbs().rowwise().sum().maxCoeff();
    const double evaluation = 1e-13 * this->Largest; // far above the rounding of a point
    const double residual = (xa - xb).cwiseAbs().maxCoeff() + evaluation;
    const double curvature = a.Bounds(elementA).Second + b.Bounds(elementB).Second;
    const double slopes = 1e-10 * (a.Bounds(elementA).First + b.Bounds(elementB).First);
    const double moved =
      norm * (residual + 3.0 * slopes * ProofRadius + 4.5 * curvature * ProofRadius * ProofRadius);
    position = 0.5 * (xa + xb);
    for (double& x : position)
    {
      x = std::abs(x) > evaluation ? x : 0.0; // what rounding leaves of a zero
    }
    return moved < 0.5 * ProofRadius;
  }

  std::vector<Face> Faces;
  std::vector<Triangle> Triangles;
  BoxTree Tree;
  double Largest = 0.0;
};
}

template <>
Result<std::vector<BoundaryCrossing>> FindBoundaryCrossings<3>(
  const CompatibleBoundary<3>& boundary, int)
{
  std::vector<BoundaryCrossing> crossings;
  std::array<int, 2> sides{};
  Vector position;
  if (FaceCrossingSearch(boundary).Find(sides, position))
  {
    BoundaryCrossing crossing;
    for (std::size_t k = 0; k < 2; ++k)
    {
      crossing.Sides[k] = boundary.Origins[static_cast<std::size_t>(sides[k])].Input;
    }
    std::copy(position.data(), position.data() + 3, crossing.Position.begin());
    crossing.Message = CrossingText<3>(boundary, sides, crossing.Position.data());
    crossings.push_back(std::move(crossing));
  }
  return crossings;
}
}
