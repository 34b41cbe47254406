// SPDX-License-Identifier: BSD-3-Clause
#include "BezierProjection.h"

#include "DualFunctionals.h"
#include "LocalConstraints.h"
#include "Parallel.h"
#include "Quadrature.h"
#include "RowEquations.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
/// Elements computed between two calls of the progress callback, and in one piece of work.
constexpr int BatchSize = 256;
constexpr std::size_t ChunkSize = 8;

/// out = in with index `direction` of an array of sizes `sizes` (first fastest) run through an
/// n x sizes[direction] matrix; sizes[direction] becomes n.
template <int Dim>
void Contract(const PointMatrix& matrix, std::size_t direction, IntArray<Dim>& sizes,
  const std::vector<double>& in, std::vector<double>& out)
{
  Eigen::Index inner = 1;
  Eigen::Index outer = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    if (d != direction)
    {
      (d < direction ? inner : outer) *= sizes[d];
    }
  }
  out.resize(static_cast<std::size_t>(inner * outer * matrix.rows()));
  for (Eigen::Index o = 0; o < outer; ++o)
  {
    const Eigen::Map<const PointMatrix> from(
      in.data() + o * inner * matrix.cols(), matrix.cols(), inner);
    Eigen::Map<PointMatrix>(out.data() + o * inner * matrix.rows(), matrix.rows(), inner)
      .noalias() = matrix.lazyProduct(from);
  }
  sizes[direction] = static_cast<int>(matrix.rows());
}

/// The L2 projection on one element: from values at its Gauss points to local coefficients, by one
/// matrix a direction.
template <int Dim>
class LocalProjection
{
public:
  LocalProjection(const SplineSpace<Dim>& space, const DualFunctionals<Dim>& duals, int extraPoints)
    : Space(space), ExtraPoints(extraPoints)
  {
    for (int e = 0; e < space.NumElements(); ++e)
    {
      const auto& element = space.Elements[static_cast<std::size_t>(e)];
      if (this->Quadratures.count(element.Degree) == 0)
      {
        IntArray<Dim> points = element.Degree;
        for (int& n : points)
        {
          n += 1 + extraPoints;
        }
        this->Quadratures.emplace(element.Degree, MakeElementQuadrature<Dim>(points).Local);
      }
      for (std::size_t d = 0; d < Dim; ++d)
      {
        const Key key{ element.Degree[d], element.Factor[d] };
        if (this->Operators.count(key) == 0)
        {
          this->Operators.emplace(
            key, this->MakeOperator(key.first, duals.Inverse(e, static_cast<int>(d))));
          this->Integrals.emplace(
            key, IntegralsOf(key.first, space.Factor(e, static_cast<int>(d))));
        }
      }
    }
  }

  /// Gauss points of an element in [0, 1]^Dim.
  const PointMatrix& Points(int e) const
  {
    return this->Quadratures.at(this->Space.Elements[static_cast<std::size_t>(e)].Degree);
  }

  /// Local coefficients, prod(p_d + 1) x c, of values at the Gauss points, n x c.
  PointMatrix Apply(int e, const PointMatrix& values) const
  {
    const auto& element = this->Space.Elements[static_cast<std::size_t>(e)];
    PointMatrix result(NumTensorFunctions<Dim>(element.Degree), values.cols());
    std::vector<double> current;
    std::vector<double> next;
    for (Eigen::Index c = 0; c < values.cols(); ++c)
    {
      current.resize(static_cast<std::size_t>(values.rows()));
      Eigen::Map<Eigen::VectorXd>(current.data(), values.rows()) = values.col(c);
      IntArray<Dim> sizes = element.Degree;
      for (int& n : sizes)
      {
        n += 1 + this->ExtraPoints;
      }
      for (std::size_t d = 0; d < Dim; ++d)
      {
        Contract<Dim>(
          this->Operators.at({ element.Degree[d], element.Factor[d] }), d, sizes, current, next);
        current.swap(next);
      }
      result.col(c) = Eigen::Map<const Eigen::VectorXd>(current.data(), result.rows());
    }
    return result;
  }

  /// Integral of a local function over its element, in the parameters of the domain.
  double Integral(int e, int local) const
  {
    const auto& element = this->Space.Elements[static_cast<std::size_t>(e)];
    const auto index = TensorIndex<Dim>(element.Degree, local);
    double integral = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      integral *= (element.Box.Upper[d] - element.Box.Lower[d]) *
        this->Integrals.at({ element.Degree[d], element.Factor[d] })[index[d]];
    }
    return integral;
  }

private:
  using Key = std::pair<int, int>; ///< degree, offset of the factor

  PointMatrix MakeOperator(int degree, const double* inverse) const
  {
    PointMatrix toBernstein = GaussToBernstein(degree, degree + 1 + this->ExtraPoints);
    if (!inverse)
    {
      return toBernstein;
    }
    return Eigen::Map<const PointMatrix>(inverse, degree + 1, degree + 1).transpose() * toBernstein;
  }

  const SplineSpace<Dim>& Space;
  int ExtraPoints;
  std::map<IntArray<Dim>, PointMatrix> Quadratures;
  std::map<Key, PointMatrix> Operators;
  std::map<Key, Eigen::VectorXd> Integrals;
};

template <int Dim>
Status ProjectElement(const SplineSpace<Dim>& space, const LocalProjection<Dim>& projection,
  const ElementFunction& function, int e, int numComponents, PointMatrix& coefficients)
{
  const ParametricBox<Dim>& box = space.Elements[static_cast<std::size_t>(e)].Box;
  const PointMatrix& local = projection.Points(e);
  PointMatrix parameters(local.rows(), Dim);
  for (int d = 0; d < Dim; ++d)
  {
    const double lower = box.Lower[static_cast<std::size_t>(d)];
    const double size = box.Upper[static_cast<std::size_t>(d)] - lower;
    parameters.col(d) = (lower + size * local.col(d).array()).matrix();
  }
  PointMatrix values(local.rows(), numComponents);
  const std::string name = "element " + std::to_string(e);
  if (!function(e, local, parameters, values))
  {
    return { ErrorCode::OutsideDomain, "the function is not defined on " + name };
  }
  if (values.rows() != local.rows() || values.cols() != numComponents)
  {
    return { ErrorCode::SizeMismatch, "the function changed the size of its values on " + name };
  }
  if (!values.allFinite())
  {
    return { ErrorCode::NonFiniteInput, "the function is not finite on " + name };
  }
  coefficients = projection.Apply(e, values);
  return {};
}

/// Weighted averages of local coefficients, filled in the order of the elements.
template <int Dim>
class Averages
{
public:
  Averages(const SplineSpace<Dim>& space, const DualFunctionals<Dim>& duals, int numComponents)
    : Space(space), Duals(duals), Known(FunctionsWithRows(space, duals)),
      Equations(space, this->Known, numComponents),
      Sums(PointMatrix::Zero(space.NumFunctions, numComponents)),
      Weights(Eigen::VectorXd::Zero(space.NumFunctions))
  {
  }

  void Add(int e, const LocalProjection<Dim>& projection, const PointMatrix& coefficients)
  {
    for (Eigen::Index i = 0; i < coefficients.rows(); ++i)
    {
      const int local = static_cast<int>(i);
      const double weight = projection.Integral(e, local);
      if (!(weight > 0.0) || !std::isfinite(this->Duals.Amplification(e, local)))
      {
        continue;
      }
      const int row = this->Space.LocalFunctions(e)[local];
      const int function = OwnFunction(this->Space, row);
      if (function >= 0)
      {
        this->Sums.row(function) += weight * coefficients.row(i);
        this->Weights[function] += weight;
      }
      const int equation = this->Equations.Equation(row);
      if (equation >= 0)
      {
        this->Equations.Add(equation, weight, coefficients.row(i).data());
      }
    }
  }

  PointMatrix Finish(int threads)
  {
    for (Eigen::Index f = 0; f < this->Sums.rows(); ++f)
    {
      if (this->Weights[f] > 0.0)
      {
        this->Sums.row(f) /= this->Weights[f];
      }
    }
    this->Equations.Solve(nullptr, this->Sums, threads);
    return std::move(this->Sums);
  }

private:
  static std::vector<char> FunctionsWithRows(
    const SplineSpace<Dim>& space, const DualFunctionals<Dim>& duals)
  {
    const std::vector<FunctionalSite> sites = ChooseSites(space, duals);
    std::vector<char> known(sites.size());
    std::transform(sites.begin(), sites.end(), known.begin(),
      [](const FunctionalSite& site) { return static_cast<char>(site.Element >= 0); });
    return known;
  }

  const SplineSpace<Dim>& Space;
  const DualFunctionals<Dim>& Duals;
  std::vector<char> Known;
  RowEquations Equations;
  PointMatrix Sums;
  Eigen::VectorXd Weights;
};

/// Coefficients that are given, put into the projections on elements.
template <int Dim>
class Constraints
{
public:
  Constraints(
    const SplineSpace<Dim>& space, const std::vector<int>& functions, const PointMatrix& values)
    : Space(space), Functions(functions), Values(values), Local(space),
      RowOf(functions.empty() ? 0 : static_cast<std::size_t>(space.NumFunctions), -1)
  {
    for (std::size_t i = 0; i < functions.size(); ++i)
    {
      this->RowOf[static_cast<std::size_t>(functions[i])] = static_cast<int>(i);
    }
  }

  void Apply(int e, PointMatrix& coefficients)
  {
    if (this->RowOf.empty())
    {
      return;
    }
    PointMatrix change = PointMatrix::Zero(coefficients.rows(), coefficients.cols());
    std::vector<char> isGiven(static_cast<std::size_t>(coefficients.rows()), 0);
    bool isAny = false;
    for (Eigen::Index i = 0; i < coefficients.rows(); ++i)
    {
      const int function =
        OwnFunction(this->Space, this->Space.LocalFunctions(e)[static_cast<int>(i)]);
      const int row = function < 0 ? -1 : this->RowOf[static_cast<std::size_t>(function)];
      if (row >= 0)
      {
        isGiven[static_cast<std::size_t>(i)] = 1;
        change.row(i) = this->Values.row(row) - coefficients.row(i);
        isAny = true;
      }
    }
    if (isAny)
    {
      coefficients += this->Local.Spread(e, isGiven) * change;
    }
  }

  void Finish(PointMatrix& coefficients) const
  {
    for (std::size_t i = 0; i < this->Functions.size(); ++i)
    {
      coefficients.row(this->Functions[i]) = this->Values.row(static_cast<Eigen::Index>(i));
    }
  }

private:
  const SplineSpace<Dim>& Space;
  const std::vector<int>& Functions;
  const PointMatrix& Values;
  LocalConstraints<Dim> Local;
  std::vector<int> RowOf; ///< of every function, -1: it is free
};

template <int Dim>
Result<Spline<Dim>> Project(const SplineSpacePtr<Dim>& space, int numComponents,
  const ElementFunction& function, Constraints<Dim>& constraints, const ProjectionParams& params)
{
  const DualFunctionals<Dim> duals(*space);
  const LocalProjection<Dim> projection(*space, duals, params.ExtraPoints);
  Averages<Dim> averages(*space, duals, numComponents);
  std::vector<PointMatrix> coefficients(BatchSize);
  std::vector<Status> statuses(BatchSize);
  for (int first = 0; first < space->NumElements(); first += BatchSize)
  {
    if (params.Progress &&
      !params.Progress(static_cast<double>(first) / static_cast<double>(space->NumElements())))
    {
      return { ErrorCode::Aborted, "projection stopped before element " + std::to_string(first) };
    }
    const int count = std::min(BatchSize, space->NumElements() - first);
    ParallelFor(static_cast<std::size_t>(count), ChunkSize, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          statuses[k] = ProjectElement(*space, projection, function, first + static_cast<int>(k),
            numComponents, coefficients[k]);
        }
      });
    for (int k = 0; k < count; ++k)
    {
      if (!statuses[static_cast<std::size_t>(k)])
      {
        return statuses[static_cast<std::size_t>(k)];
      }
      constraints.Apply(first + k, coefficients[static_cast<std::size_t>(k)]);
      averages.Add(first + k, projection, coefficients[static_cast<std::size_t>(k)]);
    }
  }
  if (params.Progress && !params.Progress(1.0))
  {
    return { ErrorCode::Aborted, "projection stopped after the last element" };
  }
  Spline<Dim> spline{ space, averages.Finish(params.Threads), {} };
  constraints.Finish(spline.ControlPoints);
  return spline;
}

template <int Dim>
Status Check(const SplineSpacePtr<Dim>& space, int numComponents, const ElementFunction& function,
  const ProjectionParams& params)
{
  if (!space || space->NumElements() == 0)
  {
    return { ErrorCode::EmptyInput, "no space to project onto" };
  }
  if (numComponents < 1 || !function)
  {
    return { ErrorCode::InvalidParameter, "a projection needs a function of at least 1 component" };
  }
  if (params.ExtraPoints < 0 || params.ExtraPoints > 16)
  {
    return { ErrorCode::InvalidParameter,
      "ExtraPoints is " + std::to_string(params.ExtraPoints) + ", valid are 0 to 16" };
  }
  return {};
}
}

template <int Dim>
Result<Spline<Dim>> ProjectOntoSpace(const SplineSpacePtr<Dim>& space, int numComponents,
  const ElementFunction& function, const ProjectionParams& params)
{
  return ProjectWithCoefficients<Dim>(
    space, function, {}, PointMatrix(0, std::max(numComponents, 0)), params);
}

template <int Dim>
Result<Spline<Dim>> ProjectWithCoefficients(const SplineSpacePtr<Dim>& space,
  const ElementFunction& function, const std::vector<int>& functions, const PointMatrix& values,
  const ProjectionParams& params)
{
  const int numComponents = static_cast<int>(values.cols());
  if (Status status = Check<Dim>(space, numComponents, function, params); !status)
  {
    return status;
  }
  if (values.rows() != static_cast<Eigen::Index>(functions.size()))
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(values.rows()) + " coefficients of " + std::to_string(functions.size()) +
        " functions" };
  }
  for (const int f : functions)
  {
    if (f < 0 || f >= space->NumFunctions)
    {
      return { ErrorCode::InvalidParameter, "there is no function " + std::to_string(f) };
    }
  }
  Constraints<Dim> constraints(*space, functions, values);
  return Project<Dim>(space, numComponents, function, constraints, params);
}

template Result<Spline<1>> ProjectOntoSpace(
  const SplineSpacePtr<1>&, int, const ElementFunction&, const ProjectionParams&);
template Result<Spline<2>> ProjectOntoSpace(
  const SplineSpacePtr<2>&, int, const ElementFunction&, const ProjectionParams&);
template Result<Spline<3>> ProjectOntoSpace(
  const SplineSpacePtr<3>&, int, const ElementFunction&, const ProjectionParams&);
template Result<Spline<1>> ProjectWithCoefficients(const SplineSpacePtr<1>&, const ElementFunction&,
  const std::vector<int>&, const PointMatrix&, const ProjectionParams&);
template Result<Spline<2>> ProjectWithCoefficients(const SplineSpacePtr<2>&, const ElementFunction&,
  const std::vector<int>&, const PointMatrix&, const ProjectionParams&);
template Result<Spline<3>> ProjectWithCoefficients(const SplineSpacePtr<3>&, const ElementFunction&,
  const std::vector<int>&, const PointMatrix&, const ProjectionParams&);
}
