// SPDX-License-Identifier: BSD-3-Clause
#include "Recovery.h"

#include "CellWeightFactors.h"
#include "DualFunctionals.h"
#include "Parallel.h"
#include "RowEquations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
template <int Dim>
int BlockSize(const SplineSpace<Dim>& space, int e)
{
  return NumTensorFunctions<Dim>(space.Elements[static_cast<std::size_t>(e)].Degree);
}

template <int Dim>
Status CheckForm(const BezierForm<Dim>& form)
{
  if (!form.Space)
  {
    return { ErrorCode::EmptyInput, "the Bezier form has no space" };
  }
  if (form.NumComponents < 1)
  {
    return { ErrorCode::SizeMismatch, "a Bezier form needs at least one component" };
  }
  const SplineSpace<Dim>& space = *form.Space;
  if (form.Offsets.size() != space.Elements.size() + 1)
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(form.Offsets.size()) + " offsets for " + std::to_string(space.NumElements()) +
        " elements, expected one more than elements" };
  }
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const std::string name = "element " + std::to_string(e);
    const std::size_t begin = form.Offsets[static_cast<std::size_t>(e)];
    const std::size_t end = form.Offsets[static_cast<std::size_t>(e) + 1];
    const auto size = static_cast<std::size_t>(BlockSize(space, e));
    const auto planes = static_cast<std::size_t>(form.NumPlanes());
    if (begin > end || end - begin != planes * size || end > form.Data.size())
    {
      return { ErrorCode::SizeMismatch,
        name + " needs a block of " + std::to_string(planes * size) + " values" };
    }
    const double* block = form.Block(e);
    if (!std::all_of(block, block + planes * size, [](double v) { return std::isfinite(v); }))
    {
      return { ErrorCode::NonFiniteInput, name + " has a value that is not finite" };
    }
    if (form.Rational &&
      !std::all_of(
        block + (planes - 1) * size, block + planes * size, [](double w) { return w > 0.0; }))
    {
      return { ErrorCode::InvalidWeight, name + " has a weight that is not positive" };
    }
  }
  return {};
}

/// Reads coefficients off the planes of a form.
template <int Dim>
class Reader
{
public:
  Reader(const SplineSpacePtr<Dim>& space, int threads)
    : Threads(threads), Space(*space), Duals(*space), Sites(ChooseSites(*space, this->Duals))
  {
    this->Known.resize(this->Sites.size());
    for (std::size_t f = 0; f < this->Sites.size(); ++f)
    {
      this->Known[f] = this->Sites[f].Element >= 0;
      this->Growth = std::max(this->Growth, this->Sites[f].Amplification);
    }
  }

  const DualFunctionals<Dim>& Functionals() const { return this->Duals; }
  double Amplification() const { return this->Growth; }
  int NumThreads() const { return this->Threads; }

  /// Coefficients of `count` planes from plane `first` of the form, NumFunctions x count.
  /// @param factors  empty, or one number an element by which its block is divided.
  /// @param scale    nullptr, or the weights: minimum norm is meant after division by them.
  /// @param start    what functions without a functional are nearest to when undetermined.
  PointMatrix Read(const BezierForm<Dim>& form, int first, int count,
    const std::vector<double>& factors, const Eigen::VectorXd* scale, double start)
  {
    PointMatrix result = PointMatrix::Constant(this->Space.NumFunctions, count, start);
    ParallelFor(this->Sites.size(), 256, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        std::vector<double> row;
        for (std::size_t f = begin; f < end; ++f)
        {
          if (this->Known[f])
          {
            this->Apply(form, first, count, factors, this->Sites[f].Element, this->Sites[f].Local,
              row, result.row(static_cast<Eigen::Index>(f)).data());
          }
        }
      });
    this->ReadMixedRows(form, first, factors, scale, result);
    return result;
  }

private:
  void Apply(const BezierForm<Dim>& form, int first, int count, const std::vector<double>& factors,
    int e, int local, std::vector<double>& row, double* values) const
  {
    const int size = BlockSize(this->Space, e);
    row.resize(static_cast<std::size_t>(size));
    this->Duals.Functional(e, local, row.data());
    const double divisor = factors.empty() ? 1.0 : factors[static_cast<std::size_t>(e)];
    for (int c = 0; c < count; ++c)
    {
      const double* plane = form.Block(e) + (first + c) * size;
      double sum = 0.0;
      for (int k = 0; k < size; ++k)
      {
        sum += row[static_cast<std::size_t>(k)] * plane[k];
      }
      values[c] = sum / divisor;
    }
  }

  void ReadMixedRows(const BezierForm<Dim>& form, int first, const std::vector<double>& factors,
    const Eigen::VectorXd* scale, PointMatrix& result)
  {
    const int count = static_cast<int>(result.cols());
    RowEquations equations(this->Space, this->Known, count);
    if (equations.IsEmpty())
    {
      return;
    }
    std::vector<double> row;
    std::vector<double> values(static_cast<std::size_t>(count));
    for (int e = 0; e < this->Space.NumElements(); ++e)
    {
      for (int i = 0; i < BlockSize(this->Space, e); ++i)
      {
        const int equation = equations.Equation(this->Space.LocalFunctions(e)[i]);
        const double amplification = this->Duals.Amplification(e, i);
        if (equation >= 0 && std::isfinite(amplification))
        {
          this->Apply(form, first, count, factors, e, i, row, values.data());
          equations.Add(equation, 1.0 / (amplification * amplification), values.data());
          this->Growth = std::max(this->Growth, amplification);
        }
      }
    }
    equations.Solve(scale, result, this->Threads);
  }

  int Threads;
  const SplineSpace<Dim>& Space;
  DualFunctionals<Dim> Duals;
  std::vector<FunctionalSite> Sites;
  std::vector<char> Known;
  double Growth = 1.0;
};

/// Largest over the elements of a number that is computed for each.
double LargestOverElements(int elements, int threads, const std::function<double(int)>& measure)
{
  constexpr std::size_t chunk = 64;
  const auto count = static_cast<std::size_t>(elements);
  std::vector<double> largest((count + chunk - 1) / chunk, 0.0);
  ParallelFor(count, chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      double value = 0.0;
      for (std::size_t e = begin; e < end; ++e)
      {
        value = std::max(value, measure(static_cast<int>(e)));
      }
      largest[begin / chunk] = value;
    });
  return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

/// Bezier form of the weight function alone.
template <int Dim>
BezierForm<Dim> WeightForm(
  const SplineSpacePtr<Dim>& space, const Eigen::VectorXd& weights, int threads)
{
  return MakeBezierForm(Spline<Dim>{ space, PointMatrix(weights), {} }, threads);
}

template <int Dim>
struct Weights
{
  Eigen::VectorXd Values;
  std::vector<double> Factors; ///< empty: the cells' weights are used as they are
  double Residual = 0.0;
};

template <int Dim>
Weights<Dim> ReadWeights(
  Reader<Dim>& reader, const BezierForm<Dim>& form, std::vector<double> factors)
{
  const SplineSpace<Dim>& space = *form.Space;
  const int plane = form.NumComponents;
  const double divisor = factors.empty() ? 1.0 : factors.front();
  const double start = space.NumElements() > 0 ? form.Block(0)[plane * BlockSize(space, 0)] : 1.0;
  Weights<Dim> weights;
  weights.Values = reader.Read(form, plane, 1, factors, nullptr, start / divisor).col(0);
  const BezierForm<Dim> found = WeightForm(form.Space, weights.Values, reader.NumThreads());
  weights.Residual = LargestOverElements(space.NumElements(), reader.NumThreads(),
    [&](int e)
    {
      const int size = BlockSize(space, e);
      const double factor = factors.empty() ? 1.0 : factors[static_cast<std::size_t>(e)];
      const Eigen::Map<const Eigen::ArrayXd> given(form.Block(e) + plane * size, size);
      const Eigen::Map<const Eigen::ArrayXd> reached(found.Block(e), size);
      return (reached * factor / given - 1.0).abs().maxCoeff();
    });
  weights.Factors = std::move(factors);
  return weights;
}

/// The cells' weights as they are when they are those of a spline, or else with the factors that
/// their faces ask for, unless that fits no better: so exact weights stay exact.
template <int Dim>
Weights<Dim> FitWeights(Reader<Dim>& reader, const BezierForm<Dim>& form)
{
  Weights<Dim> plain = ReadWeights(reader, form, {});
  const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * reader.Amplification();
  if (plain.Residual <= rounding)
  {
    return plain;
  }
  Weights<Dim> scaled =
    ReadWeights(reader, form, CellWeightFactors(form, reader.Functionals(), reader.NumThreads()));
  return scaled.Residual < 0.5 * plain.Residual ? scaled : plain;
}

/// Size and Residual: Euclidean points of a form against those of the result.
template <int Dim>
void Compare(const BezierForm<Dim>& form, int threads, RecoveryResult<Dim>& result)
{
  const SplineSpace<Dim>& space = *form.Space;
  const BezierForm<Dim> found = MakeBezierForm(result.Value, threads);
  const auto points = [&](const BezierForm<Dim>& from, int e) -> PointMatrix
  {
    const Eigen::Map<const PointMatrix> planes(
      from.Block(e), from.NumPlanes(), BlockSize(space, e));
    PointMatrix euclidean = planes.topRows(from.NumComponents);
    if (from.Rational)
    {
      euclidean.array().rowwise() /= planes.row(from.NumComponents).array();
    }
    return euclidean;
  };
  result.Size = LargestOverElements(
    space.NumElements(), threads, [&](int e) { return points(form, e).cwiseAbs().maxCoeff(); });
  result.Residual = LargestOverElements(space.NumElements(), threads,
    [&](int e) { return (points(form, e) - points(found, e)).colwise().norm().maxCoeff(); });
}

/// Coefficients from the homogeneous planes, once the weights are known.
template <int Dim>
void ReadCoefficients(Reader<Dim>& reader, const BezierForm<Dim>& form,
  const std::vector<double>& factors, RecoveryResult<Dim>& result)
{
  const Eigen::VectorXd& weights = result.Value.Weights;
  const Eigen::VectorXd* scale = weights.size() > 0 ? &weights : nullptr;
  result.Value.ControlPoints = reader.Read(form, 0, form.NumComponents, factors, scale, 0.0);
  if (scale)
  {
    result.Value.ControlPoints.array().colwise() /= weights.array();
  }
  result.Amplification = reader.Amplification();
}

Status CheckWeights(const Eigen::VectorXd& weights, const std::string& reason)
{
  for (Eigen::Index f = 0; f < weights.size(); ++f)
  {
    if (!(weights[f] > 0.0 && weights[f] <= std::numeric_limits<double>::max()))
    {
      return { ErrorCode::InvalidWeight,
        "function " + std::to_string(f) + " has the weight " + std::to_string(weights[f]) +
          reason };
    }
  }
  return {};
}
}

template <int Dim>
RecoveryResult<Dim> RecoverSpline(const BezierForm<Dim>& form, int threads)
{
  RecoveryResult<Dim> result;
  result.Status = CheckForm(form);
  if (!result)
  {
    return result;
  }
  Reader<Dim> reader(form.Space, threads);
  result.Value.Space = form.Space;
  std::vector<double> factors;
  if (form.Rational)
  {
    Weights<Dim> weights = FitWeights(reader, form);
    result.Status =
      CheckWeights(weights.Values, ": the cells' weights are not those of a spline of the space");
    if (!result)
    {
      result.Value = {};
      return result;
    }
    result.Value.Weights = std::move(weights.Values);
    result.WeightResidual = weights.Residual;
    factors = std::move(weights.Factors);
  }
  ReadCoefficients(reader, form, factors, result);
  Compare(form, threads, result);
  return result;
}

template <int Dim>
RecoveryResult<Dim> RecoverField(
  const BezierForm<Dim>& form, const Eigen::VectorXd& weights, int threads)
{
  RecoveryResult<Dim> result;
  result.Status = CheckForm(form);
  if (!result)
  {
    return result;
  }
  if (form.Rational || (weights.size() != 0 && weights.size() != form.Space->NumFunctions))
  {
    result.Status = { ErrorCode::SizeMismatch,
      form.Rational ? "a field's form has no plane of weights"
                    : std::to_string(weights.size()) + " weights for " +
          std::to_string(form.Space->NumFunctions) + " functions" };
    return result;
  }
  result.Status = CheckWeights(weights, "");
  if (!result)
  {
    return result;
  }
  Reader<Dim> reader(form.Space, threads);
  result.Value.Space = form.Space;
  result.Value.Weights = weights;
  if (weights.size() == 0)
  {
    ReadCoefficients(reader, form, {}, result);
  }
  else
  {
    BezierForm<Dim> product = form;
    const BezierForm<Dim> factor = WeightForm(form.Space, weights, threads);
    for (int e = 0; e < form.Space->NumElements(); ++e)
    {
      const int size = BlockSize(*form.Space, e);
      Eigen::Map<PointMatrix>(product.Block(e), form.NumComponents, size).array().rowwise() *=
        Eigen::Map<const Eigen::RowVectorXd>(factor.Block(e), size).array();
    }
    ReadCoefficients(reader, product, {}, result);
  }
  Compare(form, threads, result);
  return result;
}

template RecoveryResult<1> RecoverSpline(const BezierForm<1>&, int);
template RecoveryResult<2> RecoverSpline(const BezierForm<2>&, int);
template RecoveryResult<3> RecoverSpline(const BezierForm<3>&, int);
template RecoveryResult<1> RecoverField(const BezierForm<1>&, const Eigen::VectorXd&, int);
template RecoveryResult<2> RecoverField(const BezierForm<2>&, const Eigen::VectorXd&, int);
template RecoveryResult<3> RecoverField(const BezierForm<3>&, const Eigen::VectorXd&, int);
}
