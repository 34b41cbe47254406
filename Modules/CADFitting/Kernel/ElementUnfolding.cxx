// SPDX-License-Identifier: BSD-3-Clause
#include "ElementUnfolding.h"

#include "ElementMending.h"
#include "ElementPatch.h"

#include <knotwork/DomainParameterization/Minimize.h>
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/UnstructuredSpace.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// Passes, each with the target's normals where the surface is then.
constexpr int MostPasses = 3;
/// Area of an element of a surface that counts for one that has less, as share of the mean; side of
/// an element, as share of its longest.
constexpr double LeastSize = 0.2;
/// Side of an element that counts for one that has less, as share of the mean.
constexpr double LeastShare = 1e-3;
/// How much size counts beside shape.
constexpr double SizeWeight = 0.3;

template <int Dim>
using Jacobian = Eigen::Matrix<double, 3, Dim>;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// An element with values and derivatives of its functions at samples.
template <int Dim>
struct SampledElement
{
  std::vector<int> Functions;
  Eigen::MatrixXd Values; ///< samples x functions
  std::array<Eigen::MatrixXd, Dim> Derivatives;
  Eigen::Array<double, 1, Dim> Scales; ///< one over the length of the sides that it should have
  PointMatrix Normals;                 ///< of samples of surfaces
  Eigen::Vector3d Normal = Eigen::Vector3d::Zero(); ///< mean
  double Energy = 0.0;
  PointMatrix Slopes; ///< of its functions
};

/// Equally spaced samples, the sides included.
template <int Dim>
std::vector<SampledElement<Dim>> SampleElements(const SplineSpace<Dim>& space)
{
  std::vector<SampledElement<Dim>> elements;
  FunctionValues values;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    SampledElement<Dim>& element = elements.emplace_back();
    element.Functions = space.AliveFunctions(e);
    const int across = space.Elements[At(e)].Degree[0] + 2;
    const int samples = Dim == 2 ? across * across : across * across * across;
    const auto count = static_cast<Eigen::Index>(element.Functions.size());
    element.Values.resize(samples, count);
    for (Eigen::MatrixXd& matrix : element.Derivatives)
    {
      matrix.resize(samples, count);
    }
    for (int i = 0; i < samples; ++i)
    {
      const double step = 1.0 / (across - 1);
      const double local[] = { step * (i % across), step * (i / across % across),
        step * (i / (across * across)) };
      EvaluateFunctions<Dim>(space, e, local, 1, nullptr, values);
      element.Values.row(i) = values.Values.col(0).transpose();
      for (std::size_t d = 0; d < Dim; ++d)
      {
        element.Derivatives[d].row(i) =
          values.Values.col(1 + static_cast<Eigen::Index>(d)).transpose();
      }
    }
  }
  return elements;
}

/// det J, of surfaces along a normal, and its derivative.
template <int Dim>
double Determinant(const Jacobian<Dim>& map, const Eigen::Vector3d& normal, Jacobian<Dim>& slope)
{
  const Eigen::Vector3d u = map.col(0);
  const Eigen::Vector3d v = map.col(1);
  if constexpr (Dim == 2)
  {
    slope.col(0) = v.cross(normal);
    slope.col(1) = normal.cross(u);
    return normal.dot(u.cross(v));
  }
  else
  {
    const Eigen::Vector3d w = map.col(2);
    slope.col(0) = v.cross(w);
    slope.col(1) = w.cross(u);
    slope.col(2) = u.cross(v);
    return u.dot(Eigen::Vector3d(slope.col(0)));
  }
}

/// The functional of one sample, and its derivative.
template <int Dim>
double DensityOf(const Jacobian<Dim>& map, const Eigen::Vector3d& normal, double sign,
  double epsilon, Jacobian<Dim>& slope)
{
  Jacobian<Dim> byMap;
  const double d = sign * Determinant<Dim>(map, normal, byMap);
  const double root = std::sqrt(epsilon * epsilon + d * d);
  const double c = d > 0.0 ? 0.5 * (d + root) : 0.5 * epsilon * epsilon / (root - d);
  const double power = Dim == 2 ? c : std::cbrt(c * c);
  const double shape = map.squaredNorm() / power;
  const double size = SizeWeight * (d * d + 1.0) / c;
  // d c / d d = c / root
  const double byDet = sign * (-2.0 / Dim * shape / root + 2.0 * SizeWeight * d / c - size / root);
  slope = 2.0 / power * map + byDet * byMap;
  return shape + size;
}

/// A patch of a spline, with what its control points may do.
template <int Dim>
class Unfolding
{
public:
  Unfolding(const Spline<Dim>& part, const std::vector<char>& isFree, bool isReversed,
    const ControlPointPlaces& places, const FitTarget& target, const UnfoldingParams& params)
    : Part(part), IsReversed(isReversed), Places(places), Target(target), Params(params),
      Elements(SampleElements<Dim>(*part.Space))
  {
    for (std::size_t i = 0; i < isFree.size(); ++i)
    {
      if (isFree[i] != 0)
      {
        this->Free.push_back(static_cast<Eigen::Index>(i));
        if (places.IsOnSurface[i] != 0)
        {
          this->Sliding.push_back(static_cast<Eigen::Index>(i));
          this->SlidingParts.push_back(places.Parts[i]);
        }
      }
    }
  }

  bool HasFree() const { return !this->Free.empty(); }
  const Spline<Dim>& Result() const { return this->Part; }

  Status Pass()
  {
    const PointMatrix before = this->Part.ControlPoints;
    this->FindSizes();
    Status status = this->FindNormals();
    status = status ? this->FindFrames() : status;
    if (!status)
    {
      return status;
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(this->NumUnknowns);
    bool isStopped = false;
    // many elements of volumes are thin, and invert where e is not small
    constexpr double first = Dim == 2 ? 0.3 : 0.03;
    for (const double epsilon : { first, first / 3.0, first / 10.0, first / 30.0 })
    {
      MinimizeParams minimize;
      minimize.MaxIterations = 100;
      minimize.EnergyTolerance = 1e-4;
      MinimizeLbfgs(
        x,
        [&](const Eigen::VectorXd& at, Eigen::VectorXd& gradient)
        { return this->Energy(before, epsilon, at, gradient); },
        minimize, {},
        [&](const MinimizeState&)
        {
          isStopped = isStopped || (this->Params.Progress && !this->Params.Progress(0.0));
          return !isStopped;
        });
      if (isStopped)
      {
        return { ErrorCode::Aborted, "unfolding elements stopped" };
      }
    }
    this->Take(before, x);
    return KeepOffsets(
      this->Target, before, this->Sliding, this->SlidingParts, this->Part.ControlPoints);
  }

private:
  PointMatrix PointsOf(const SampledElement<Dim>& element) const
  {
    return this->Part.ControlPoints(element.Functions, Eigen::all);
  }

  /// Visits the Jacobians of an element.
  template <class Visit>
  void ForSamples(const SampledElement<Dim>& element, Visit&& visit) const
  {
    const PointMatrix points = this->PointsOf(element);
    std::array<PointMatrix, Dim> derivatives;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      derivatives[d] = element.Derivatives[d] * points;
    }
    Jacobian<Dim> map;
    for (Eigen::Index i = 0; i < element.Values.rows(); ++i)
    {
      for (std::size_t d = 0; d < Dim; ++d)
      {
        map.col(static_cast<Eigen::Index>(d)) = derivatives[d].row(i).transpose();
      }
      visit(i, map);
    }
  }

  /// Surfaces are to have square elements of the areas that they have; volumes keep the shares of
  /// their sides, for their elements may be thin.
  void FindSizes()
  {
    std::vector<double> sizes;
    double mean = 0.0;
    for (SampledElement<Dim>& element : this->Elements)
    {
      double size = 0.0;
      element.Scales.setZero();
      this->ForSamples(element,
        [&](Eigen::Index, const Jacobian<Dim>& map)
        {
          element.Scales += map.colwise().norm().array();
          if constexpr (Dim == 2)
          {
            size += Eigen::Vector3d(map.col(0)).cross(Eigen::Vector3d(map.col(1))).norm();
          }
          else
          {
            size += std::abs(map.determinant());
          }
        });
      const auto count = static_cast<double>(element.Values.rows());
      element.Scales /= count;
      sizes.push_back(size / count);
      mean += sizes.back() / static_cast<double>(this->Elements.size());
    }
    this->Size = std::pow(mean, 1.0 / Dim);
    for (std::size_t e = 0; e < sizes.size(); ++e)
    {
      SampledElement<Dim>& element = this->Elements[e];
      if (Dim == 2)
      {
        element.Scales.setConstant(std::sqrt(std::max(sizes[e], LeastSize * mean)));
      }
      const double least = std::max(LeastSize * element.Scales.maxCoeff(), LeastShare * this->Size);
      element.Scales = element.Scales.max(least).inverse().eval();
    }
  }

  /// Of every sample of a surface the mean of the target's normal there and that of the element;
  /// all turned to the side of the surface's.
  Status FindNormals()
  {
    if (Dim == 3)
    {
      return {};
    }
    double side = 0.0;
    TargetPoints feet;
    for (SampledElement<Dim>& element : this->Elements)
    {
      const PointMatrix places = element.Values * this->PointsOf(element);
      if (Status status = this->Target.Find({}, places, feet); !status)
      {
        return status;
      }
      element.Normals = feet.Normals;
      element.Normal = feet.Normals.colwise().sum().normalized();
      this->ForSamples(element,
        [&](Eigen::Index i, const Jacobian<Dim>& map)
        {
          element.Normals.row(i) += element.Normal.transpose();
          element.Normals.row(i).normalize();
          side += Eigen::Vector3d(map.col(0))
                    .cross(Eigen::Vector3d(map.col(1)))
                    .dot(Eigen::Vector3d(feet.Normals.row(i).transpose()));
        });
    }
    if (side < 0.0)
    {
      for (SampledElement<Dim>& element : this->Elements)
      {
        element.Normals *= -1.0;
        element.Normal *= -1.0;
      }
    }
    return {};
  }

  /// Directions of every free control point: on the surface across the mean normal of its elements,
  /// or that of the target.
  Status FindFrames()
  {
    PointMatrix normals = PointMatrix::Zero(this->Part.ControlPoints.rows(), 3);
    for (const SampledElement<Dim>& element : this->Elements)
    {
      for (const int function : element.Functions)
      {
        normals.row(function) += element.Normal.transpose();
      }
    }
    this->Frames.clear();
    this->NumUnknowns = 0;
    TargetPoints foot;
    for (const Eigen::Index i : this->Free)
    {
      const auto at = static_cast<std::size_t>(i);
      Eigen::Matrix<double, 3, Eigen::Dynamic> frame = Eigen::Matrix3d::Identity();
      if (this->Places.IsOnSurface[at] != 0)
      {
        Eigen::Vector3d normal = normals.row(i).transpose();
        if (Dim == 3)
        {
          const PointMatrix query = this->Part.ControlPoints.row(i);
          if (Status status = this->Target.Find(this->Places.Parts[at], query, foot); !status)
          {
            return status;
          }
          normal = foot.Normals.row(0).transpose();
        }
        normal.normalize();
        frame.resize(3, 2);
        frame.col(0) = normal.unitOrthogonal();
        frame.col(1) = normal.cross(Eigen::Vector3d(frame.col(0)));
      }
      this->NumUnknowns += frame.cols();
      this->Frames.emplace_back(this->Size * frame);
    }
    return {};
  }

  void Take(const PointMatrix& before, const Eigen::VectorXd& x)
  {
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < this->Free.size(); ++i)
    {
      const auto& frame = this->Frames[i];
      this->Part.ControlPoints.row(this->Free[i]) =
        before.row(this->Free[i]) + (frame * x.segment(at, frame.cols())).transpose();
      at += frame.cols();
    }
  }

  void Evaluate(double epsilon, SampledElement<Dim>& element) const
  {
    const double weight = 1.0 / static_cast<double>(element.Values.rows());
    std::array<PointMatrix, Dim> by;
    by.fill(PointMatrix(element.Values.rows(), 3));
    element.Energy = 0.0;
    this->ForSamples(element,
      [&](Eigen::Index i, const Jacobian<Dim>& map)
      {
        const Eigen::Vector3d normal =
          Dim == 2 ? Eigen::Vector3d(element.Normals.row(i).transpose()) : Eigen::Vector3d::Zero();
        Jacobian<Dim> slope;
        element.Energy += weight *
          DensityOf<Dim>(map * element.Scales.matrix().asDiagonal(), normal,
            Dim == 3 && this->IsReversed ? -1.0 : 1.0, epsilon, slope);
        for (std::size_t d = 0; d < Dim; ++d)
        {
          by[d].row(i) = weight * element.Scales[static_cast<Eigen::Index>(d)] *
            slope.col(static_cast<Eigen::Index>(d)).transpose();
        }
      });
    element.Slopes = element.Derivatives[0].transpose() * by[0];
    for (std::size_t d = 1; d < Dim; ++d)
    {
      element.Slopes += element.Derivatives[d].transpose() * by[d];
    }
  }

  double Energy(
    const PointMatrix& before, double epsilon, const Eigen::VectorXd& x, Eigen::VectorXd& gradient)
  {
    this->Take(before, x);
    ParallelFor(this->Elements.size(), 16, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          this->Evaluate(epsilon, this->Elements[e]);
        }
      });
    PointMatrix slopes = PointMatrix::Zero(this->Part.ControlPoints.rows(), 3);
    double sum = 0.0;
    for (const SampledElement<Dim>& element : this->Elements) // in their order, for any threads
    {
      sum += element.Energy;
      for (std::size_t k = 0; k < element.Functions.size(); ++k)
      {
        slopes.row(element.Functions[k]) += element.Slopes.row(static_cast<Eigen::Index>(k));
      }
    }
    gradient.resize(x.size());
    Eigen::Index at = 0;
    for (std::size_t i = 0; i < this->Free.size(); ++i)
    {
      const auto& frame = this->Frames[i];
      gradient.segment(at, frame.cols()) =
        frame.transpose() * slopes.row(this->Free[i]).transpose();
      at += frame.cols();
    }
    return sum;
  }

  Spline<Dim> Part;
  bool IsReversed;
  const ControlPointPlaces Places; ///< of the part
  const FitTarget& Target;
  const UnfoldingParams& Params;
  std::vector<SampledElement<Dim>> Elements;
  std::vector<Eigen::Index> Free;
  std::vector<Eigen::Index> Sliding; ///< of these
  std::vector<TargetPart> SlidingParts;
  std::vector<Eigen::Matrix<double, 3, Eigen::Dynamic>> Frames; ///< of the free ones
  Eigen::Index NumUnknowns = 0;
  double Size = 1.0; ///< of an element
};
}

Status KeepOffsets(const FitTarget& target, const PointMatrix& before,
  const std::vector<Eigen::Index>& moved, const std::vector<TargetPart>& parts, PointMatrix& now)
{
  TargetPoints feetBefore;
  TargetPoints feet;
  for (std::size_t k = 0; k < moved.size(); ++k)
  {
    const PointMatrix from = before.row(moved[k]);
    const PointMatrix to = now.row(moved[k]);
    Status status = target.Find(parts[k], from, feetBefore);
    status = status ? target.Find(parts[k], to, feet) : status;
    if (!status)
    {
      return status;
    }
    now.row(moved[k]) = feet.Points.row(0) + from.row(0) - feetBefore.Points.row(0);
  }
  return {};
}

template <int Dim>
Result<int> Unfold(Spline<Dim>& spline, const std::vector<int>& elements, bool isReversed,
  const ControlPointPlaces& places, const FitTarget& target, const UnfoldingParams& params)
{
  const CellMesh<Dim>& mesh = MeshOf(*spline.Space);
  Result<int> changed(0);
  for (const std::vector<int>& patch :
    ConnectedParts<Dim>(mesh, Rings<Dim>(mesh, elements, params.Rings)))
  {
    const PatchFunctions functions = FunctionsOf<Dim>(*spline.Space, patch, places.IsHeld);
    Spline<Dim> part;
    part.Space = std::make_shared<SplineSpace<Dim>>(Restrict<Dim>(*spline.Space, patch, functions));
    part.ControlPoints = spline.ControlPoints(functions.Functions, Eigen::all);
    ControlPointPlaces own;
    for (const int f : functions.Functions)
    {
      own.IsOnSurface.push_back(places.IsOnSurface[At(f)]);
      own.Parts.push_back(places.Parts[At(f)]);
    }
    Unfolding<Dim> unfolding(part, functions.IsFree, isReversed, own, target, params);
    if (!unfolding.HasFree())
    {
      continue;
    }
    // of a patch by itself most elements may be bad
    const auto count = [&](const Spline<Dim>& of)
    {
      const auto verdicts = CertifyElements<Dim>(of, params.Threads);
      if (!verdicts)
      {
        return patch.size();
      }
      const Verdict good = isReversed ? Verdict::Reversed : Verdict::Valid;
      const auto& cells = verdicts->Certificate.Cells;
      return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(),
        [&](const CellCertificate& cell) { return cell.Verdict != good; }));
    };
    std::size_t least = count(part);
    const std::size_t before = least;
    for (int pass = 0; pass < MostPasses && least > 0; ++pass)
    {
      if (Status status = unfolding.Pass(); !status)
      {
        return status;
      }
      const std::size_t now = count(unfolding.Result());
      if (now < least)
      {
        least = now;
        part.ControlPoints = unfolding.Result().ControlPoints;
      }
    }
    if (least < before)
    {
      spline.ControlPoints(functions.Functions, Eigen::all) = part.ControlPoints;
      changed.Value += static_cast<int>(patch.size());
    }
  }
  return changed;
}

template Result<int> Unfold(Spline<2>&, const std::vector<int>&, bool, const ControlPointPlaces&,
  const FitTarget&, const UnfoldingParams&);
template Result<int> Unfold(Spline<3>&, const std::vector<int>&, bool, const ControlPointPlaces&,
  const FitTarget&, const UnfoldingParams&);
}
