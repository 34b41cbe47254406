// SPDX-License-Identifier: BSD-3-Clause
#include "ContourCurves.h"

#include "CubicComposition.h"
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// A cubic on one element, with its image in space.
struct Piece
{
  int Element = 0;
  PlaneCubic Local{};
  std::array<std::vector<double>, 4> Space;
  double MaxError = 0.0;
  double SpaceDistance = 0.0;
};

class CurveFitter
{
public:
  CurveFitter(const BezierForm<2>& form, const ContourSet& contours, const ContourParams& params)
    : Form(form), Contours(contours),
      Component(params.Component < 0 ? form.NumComponents - 1 : params.Component),
      NumSpace(params.NumSpaceComponents < 0 ? this->Component : params.NumSpaceComponents),
      SpaceTolerance(params.ChordTolerance > 0.0 ? params.ChordTolerance : HUGE_VAL)
  {
  }

  ContourCurve Fit(int number) const
  {
    const ContourComponent& component = this->Contours.Components[static_cast<std::size_t>(number)];
    const std::size_t first = component.First;
    const std::size_t last = first + component.NumPoints - (component.Closed ? 0 : 1);
    const double level = this->Contours.Levels[static_cast<std::size_t>(component.Level)];
    std::vector<Piece> pieces;
    for (std::size_t i = first; i < last;)
    {
      std::size_t end = i + 1;
      if (this->HasLength(i))
      {
        while (end < last && this->Contours.Elements[end] == this->Contours.Elements[i] &&
          this->HasLength(end))
        {
          ++end;
        }
        this->FitRun(i, end, level, component.MaxError, pieces);
      }
      i = end;
    }
    ContourCurve curve = this->Join(pieces, component.Closed);
    curve.Component = number;
    return curve;
  }

private:
  bool HasLength(std::size_t i) const
  {
    const Eigen::Index row = static_cast<Eigen::Index>(i);
    return this->Contours.Local.row(row) != this->Contours.PieceEnds.row(row);
  }
  RealArray<2> Begin(std::size_t i) const
  {
    const auto row = this->Contours.Local.row(static_cast<Eigen::Index>(i));
    return { row[0], row[1] };
  }
  RealArray<2> End(std::size_t i) const
  {
    const auto row = this->Contours.PieceEnds.row(static_cast<Eigen::Index>(i));
    return { row[0], row[1] };
  }

  /// Straight pieces [begin, end) of one element.
  void FitRun(std::size_t begin, std::size_t end, double level, double straightError,
    std::vector<Piece>& pieces) const
  {
    const RealArray<2> from = this->Begin(begin);
    const RealArray<2> to = this->End(end - 1);
    const int e = this->Contours.Elements[begin];
    Piece piece;
    piece.Element = e;
    const double allowed = 0.99 * this->Contours.Tolerance;
    const bool curved = this->MakeHermite(e, from, to, piece.Local);
    if (curved)
    {
      this->Measure(level, piece);
    }
    const bool near = curved && piece.MaxError <= allowed;
    if (near && (piece.SpaceDistance <= this->SpaceTolerance || end == begin + 1))
    {
      pieces.push_back(piece);
      return;
    }
    if (end > begin + 1)
    {
      const std::size_t middle = begin + (end - begin) / 2;
      this->FitRun(begin, middle, level, straightError, pieces);
      this->FitRun(middle, end, level, straightError, pieces);
      return;
    }
    for (std::size_t k = 0; k < 4; ++k)
    {
      const double t = static_cast<double>(k) / 3.0;
      piece.Local[k] = { from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]) };
    }
    this->Measure(level, piece);
    piece.MaxError = std::min(piece.MaxError, straightError);
    pieces.push_back(piece);
  }

  /// Unit vector along the contour, the upper set on its left; false where the value is flat.
  bool Direction(int e, const RealArray<2>& at, RealArray<2>& direction) const
  {
    const IntArray<2> degree = this->Form.Space->Elements[static_cast<std::size_t>(e)].Degree;
    const int size = NumTensorFunctions<2>(degree);
    const double* values = this->Form.Block(e) + this->Component * size;
    const double* weights =
      this->Form.Rational ? this->Form.Block(e) + this->Form.NumComponents * size : nullptr;
    double basis[2][2 * (MaxDegree + 1)];
    for (std::size_t d = 0; d < 2; ++d)
    {
      BernsteinDerivatives(degree[d], at[d], 1, basis[d]);
    }
    const auto sum = [&](const double* c, int du, int dv)
    {
      double total = 0.0;
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          total += c[j * (degree[0] + 1) + i] * basis[0][du * (degree[0] + 1) + i] *
            basis[1][dv * (degree[1] + 1) + j];
        }
      }
      return total;
    };
    RealArray<2> gradient{ sum(values, 1, 0), sum(values, 0, 1) };
    if (weights)
    {
      const double value = sum(values, 0, 0) / sum(weights, 0, 0); // times w: direction only
      gradient[0] -= value * sum(weights, 1, 0);
      gradient[1] -= value * sum(weights, 0, 1);
    }
    const double length = std::hypot(gradient[0], gradient[1]);
    direction = { gradient[1] / length, -gradient[0] / length };
    return length > 0.0 && std::isfinite(direction[0]) && std::isfinite(direction[1]);
  }

  bool MakeHermite(int e, const RealArray<2>& from, const RealArray<2>& to, PlaneCubic& curve) const
  {
    RealArray<2> begin;
    RealArray<2> end;
    if (!this->Direction(e, from, begin) || !this->Direction(e, to, end))
    {
      return false;
    }
    const RealArray<2> way{ to[0] - from[0], to[1] - from[1] };
    const double length = std::hypot(way[0], way[1]);
    const auto forward = [&](const RealArray<2>& d)
    { return d[0] * way[0] + d[1] * way[1] > 0.5 * length; };
    if (!forward(begin) || !forward(end))
    {
      return false;
    }
    curve = { from, from, to, to };
    for (std::size_t d = 0; d < 2; ++d)
    {
      curve[1][d] += length / 3.0 * begin[d];
      curve[2][d] -= length / 3.0 * end[d];
      if (std::min(curve[1][d], curve[2][d]) < 0.0 || std::max(curve[1][d], curve[2][d]) > 1.0)
      {
        return false; // leaves the element, perhaps
      }
    }
    return true;
  }

  void Measure(double level, Piece& piece) const
  {
    const IntArray<2> degree =
      this->Form.Space->Elements[static_cast<std::size_t>(piece.Element)].Degree;
    const int size = NumTensorFunctions<2>(degree);
    const double* block = this->Form.Block(piece.Element);
    const CubicComposition composition(degree, piece.Local);
    const double* weights = this->Form.Rational ? block + this->Form.NumComponents * size : nullptr;
    std::vector<double> g(block + this->Component * size, block + (this->Component + 1) * size);
    for (std::size_t k = 0; k < g.size(); ++k)
    {
      g[k] -= level * (weights ? weights[k] : 1.0);
    }
    const std::vector<double> ones(g.size(), 1.0);
    const ScaledPolynomial weight = composition.Of(weights ? weights : ones.data());
    const double least = weights ? SmallestCoefficient(weight) : 1.0;
    piece.MaxError = LargestCoefficient(composition.Of(g.data())) / least;

    double squared = 0.0;
    for (std::vector<double>& point : piece.Space)
    {
      point.clear();
    }
    for (int c = 0; c < this->NumSpace; ++c)
    {
      const ScaledPolynomial x = composition.Of(block + c * size);
      // ends and derivatives of x / w; x[1] is n times the second Bernstein coefficient
      const double begin = x.front() / weight.front();
      const double end = x.back() / weight.back();
      const double leave = (x[1] - begin * weight[1]) / weight.front();
      const double arrive = (end * weight[weight.size() - 2] - x[x.size() - 2]) / weight.back();
      const std::array<double, 4> cubic{ begin, begin + leave / 3.0, end - arrive / 3.0, end };
      for (std::size_t k = 0; k < 4; ++k)
      {
        piece.Space[k].push_back(cubic[k]);
      }
      ScaledPolynomial difference = Multiply(x, { 1.0, 3.0, 3.0, 1.0 });
      const ScaledPolynomial product = Multiply(weight, ScaledCubic(cubic));
      for (std::size_t k = 0; k < difference.size(); ++k)
      {
        difference[k] -= product[k];
      }
      const double largest = LargestCoefficient(difference) / least;
      squared += largest * largest;
    }
    piece.SpaceDistance = std::sqrt(squared);
  }

  std::array<double, 2> Parameter(int e, const RealArray<2>& local) const
  {
    const ParametricBox<2>& box = this->Form.Space->Elements[static_cast<std::size_t>(e)].Box;
    return { box.Lower[0] + local[0] * (box.Upper[0] - box.Lower[0]),
      box.Lower[1] + local[1] * (box.Upper[1] - box.Lower[1]) };
  }

  ContourCurve Join(const std::vector<Piece>& pieces, bool closed) const
  {
    ContourCurve result;
    std::vector<double> knots(4, 0.0);
    std::vector<std::vector<double>> points;
    const auto point = [&](const Piece& piece, std::size_t k)
    {
      const auto uv = this->Parameter(piece.Element, piece.Local[k]);
      std::vector<double> row{ uv[0], uv[1] };
      row.insert(row.end(), piece.Space[k].begin(), piece.Space[k].end());
      return row;
    };
    const bool domain = this->Form.Space->HasDomain();
    const ParametricBox<2> box = domain ? this->Form.Space->Domain() : ParametricBox<2>();
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
      result.MaxError = std::max(result.MaxError, pieces[i].MaxError);
      result.SpaceDistance = std::max(result.SpaceDistance, pieces[i].SpaceDistance);
      const std::vector<double> begin = point(pieces[i], 0);
      bool jumps = i > 0 && !domain && pieces[i].Element != pieces[i - 1].Element;
      for (std::size_t d = 0; i > 0 && domain && d < 2; ++d)
      {
        jumps |= std::abs(begin[d] - points.back()[d]) > 1e-6 * (box.Upper[d] - box.Lower[d]);
      }
      if (i > 0)
      {
        knots.insert(knots.end(), jumps ? 4 : 3, static_cast<double>(i));
      }
      if (i == 0 || jumps)
      {
        points.push_back(begin);
      }
      for (std::size_t k = 1; k < 4; ++k)
      {
        points.push_back(point(pieces[i], k));
      }
    }
    knots.insert(knots.end(), 4, static_cast<double>(pieces.size()));
    if (closed) // its two ends are one point but for rounding; parameters at a seam are not
    {
      std::copy(points.front().begin() + 2, points.front().end(), points.back().begin() + 2);
    }
    result.Curve.Space = MakeTensorSpace<1>({ KnotVector::Create(3, knots).Value }).Value;
    result.Curve.ControlPoints.resize(static_cast<Eigen::Index>(points.size()), 2 + this->NumSpace);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      for (std::size_t c = 0; c < points[i].size(); ++c)
      {
        result.Curve.ControlPoints(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
          points[i][c];
      }
    }
    return result;
  }

  const BezierForm<2>& Form;
  const ContourSet& Contours;
  int Component;
  int NumSpace;
  double SpaceTolerance;
};
}

Result<std::vector<ContourCurve>> FitContourCurves(
  const BezierForm<2>& form, const ContourSet& contours, const ContourParams& params)
{
  const int component = params.Component < 0 ? form.NumComponents - 1 : params.Component;
  if (component >= form.NumComponents || params.NumSpaceComponents > form.NumComponents)
  {
    return { ErrorCode::DimensionMismatch,
      "the surface has " + std::to_string(form.NumComponents) + " components; choose fewer" };
  }
  const CurveFitter fitter(form, contours, params);
  std::vector<ContourCurve> curves(contours.Components.size());
  ParallelFor(curves.size(), 1, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        curves[i] = fitter.Fit(static_cast<int>(i));
      }
    });
  return curves;
}
}
