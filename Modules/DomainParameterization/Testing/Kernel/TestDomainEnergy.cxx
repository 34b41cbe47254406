// SPDX-License-Identifier: BSD-3-Clause
#include "DomainCases.h"
#include "NewtonSystem.h"
#include "RandomSplines.h"
#include <knotwork/DomainParameterization/DomainEnergy.h>
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <complex>
#include <gtest/gtest.h>

namespace knotwork
{
namespace
{
using oracle::Random;
using Complex = std::complex<double>;

double Real(double x)
{
  return x;
}
double Real(Complex x)
{
  return x.real();
}

/// The functional by its definition, for real and complex control points and weights.
template <int Dim, typename T>
T PlainEnergy(const SplineSpace<Dim>& space, const Density& density, const std::vector<T>& points,
  const std::vector<T>& weights)
{
  const std::size_t n = static_cast<std::size_t>(space.NumFunctions);
  T total = 0.0;
  FunctionValues basis;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    IntArray<Dim> counts = space.Elements[static_cast<std::size_t>(e)].Degree;
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const auto& box = space.Elements[static_cast<std::size_t>(e)].Box;
      ++counts[d];
      volume *= box.Upper[d] - box.Lower[d];
    }
    const auto rule = MakeElementQuadrature<Dim>(counts);
    for (Eigen::Index q = 0; q < rule.Local.rows(); ++q)
    {
      EvaluateFunctions<Dim>(space, e, rule.Local.row(q).data(), 1, nullptr, basis);
      std::array<std::array<T, Dim + 1>, Dim + 1> x{}; // plane, term
      for (std::size_t f = 0; f < basis.Functions.size(); ++f)
      {
        const std::size_t i = static_cast<std::size_t>(basis.Functions[f]);
        for (std::size_t t = 0; t <= Dim; ++t)
        {
          const double b = basis.Values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(t));
          x[Dim][t] += weights[i] * b;
          for (std::size_t c = 0; c < Dim; ++c)
          {
            x[c][t] += weights[i] * points[c * n + i] * b;
          }
        }
      }
      Eigen::Matrix<T, Dim, Dim> j;
      T f = 0.0;
      for (std::size_t c = 0; c < Dim; ++c)
      {
        for (std::size_t k = 0; k < Dim; ++k)
        {
          const T value =
            x[c][k + 1] / x[Dim][0] - x[c][0] * x[Dim][k + 1] / (x[Dim][0] * x[Dim][0]);
          j(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) = value;
          f += value * value;
        }
      }
      T det;
      if constexpr (Dim == 2)
      {
        det = j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0);
      }
      else
      {
        det = j(0, 0) * (j(1, 1) * j(2, 2) - j(1, 2) * j(2, 1)) -
          j(0, 1) * (j(1, 0) * j(2, 2) - j(1, 2) * j(2, 0)) +
          j(0, 2) * (j(1, 0) * j(2, 1) - j(1, 1) * j(2, 0));
      }
      T value = 0.0;
      const T excess = det - 1.0;
      if (density.Kind == DensityKind::Relu)
      {
        value = Real(det) < density.Delta ? density.Delta - det : T(0.0);
      }
      else
      {
        const T root = std::sqrt(det * det + density.Delta * density.Delta);
        const T chi = density.Kind == DensityKind::Quality ? det + density.Epsilon
          : Real(det) > 0.0                                ? 0.5 * (det + root)
                            : 0.5 * density.Delta * density.Delta / (root - det);
        value = f / std::pow(chi, 2.0 / Dim) + density.Lambda * excess * excess;
      }
      total += volume * rule.Weights[q] * value;
    }
  }
  return total;
}

template <int Dim>
std::unique_ptr<JacobianField<Dim>> TensorPoints(const SplineSpace<Dim>& space)
{
  std::array<LinePoints, Dim> lines;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    lines[d] = GaussLine(
      knots, std::vector<int>(static_cast<std::size_t>(knots.NumElements()), knots.Degree() + 1));
  }
  return MakeTensorField<Dim>(space.Knots, lines);
}

/// A regular map near the identity (folded when fold), with weights.
template <int Dim>
void RandomPlanes(Random& random, const Spline<Dim>& identity, double amplitude,
  std::vector<double>& points, std::vector<double>& weights)
{
  const int n = identity.Space->NumFunctions;
  points.clear();
  weights.clear();
  for (int c = 0; c < Dim; ++c)
  {
    for (int i = 0; i < n; ++i)
    {
      points.push_back(identity.ControlPoints(i, c) + random.In(-amplitude, amplitude));
    }
  }
  for (int i = 0; i < n; ++i)
  {
    weights.push_back(random.In(0.7, 1.4));
  }
}

template <int Dim>
Spline<Dim> Identity(const std::array<KnotVector, Dim>& knots)
{
  return cases::GrevilleMap<Dim>(knots, [](const std::array<double, Dim>& u) { return u; });
}

/// Value and gradients of the kernel against complex steps on the plain definition: no
/// cancellation, so the tolerance is rounding of the sums relative to the largest component.
template <int Dim>
void ExpectExactGradients(unsigned seed, DensityKind kind, bool rational)
{
  Random random(seed);
  std::array<KnotVector, Dim> knots;
  for (KnotVector& k : knots)
  {
    k = KnotVector::Uniform(random.Int(1, 3), random.Int(1, 3));
  }
  const Spline<Dim> identity = Identity<Dim>(knots);
  std::vector<double> points, weights;
  RandomPlanes<Dim>(random, identity, kind == DensityKind::Quality ? 0.02 : 0.6, points, weights);
  if (!rational)
  {
    std::fill(weights.begin(), weights.end(), 1.0);
  }
  Density density;
  density.Kind = kind;
  density.Lambda = 0.7;
  density.Delta = kind == DensityKind::Relu ? 1.1 : 0.05;
  DomainEnergy<Dim> energy(TensorPoints<Dim>(*identity.Space), identity.Space->NumFunctions);
  std::vector<double> gradient(points.size()), weightGradient(weights.size());
  const EnergyValue value = energy.Evaluate(density, points.data(),
    rational ? weights.data() : nullptr, gradient.data(), weightGradient.data());
  const double plain = PlainEnergy<Dim, double>(*identity.Space, density, points, weights);
  ASSERT_NEAR(value.Energy, plain, 1e-12 * std::abs(plain));

  std::vector<Complex> z(points.begin(), points.end());
  std::vector<Complex> w(weights.begin(), weights.end());
  double scale = 0.0;
  for (double g : gradient)
  {
    scale = std::max(scale, std::abs(g));
  }
  constexpr double h = 1e-30;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 12)
  {
    z[i] += Complex(0.0, h);
    const double exact = PlainEnergy<Dim, Complex>(*identity.Space, density, z, w).imag() / h;
    z[i] = points[i];
    EXPECT_NEAR(gradient[i], exact, 1e-11 * scale) << "point " << i;
  }
  for (std::size_t i = 0; rational && i < weights.size(); i += 1 + weights.size() / 8)
  {
    w[i] *= std::exp(Complex(0.0, h)); // the logarithm of the weight is the unknown
    const double exact = PlainEnergy<Dim, Complex>(*identity.Space, density, z, w).imag() / h;
    w[i] = weights[i];
    EXPECT_NEAR(weightGradient[i], exact, 1e-11 * scale) << "weight " << i;
  }
}

TEST(DomainEnergy, GradientsMatchComplexSteps_ExactOracle)
{
  for (unsigned seed = 1; seed <= 8; ++seed)
  {
    for (DensityKind kind : { DensityKind::Quality, DensityKind::Penalty, DensityKind::Relu })
    {
      for (bool rational : { false, true })
      {
        SCOPED_TRACE("seed " + std::to_string(seed) + " kind " +
          std::to_string(static_cast<int>(kind)) + (rational ? " rational" : ""));
        ExpectExactGradients<2>(seed, kind, rational);
        if (seed <= 3)
        {
          ExpectExactGradients<3>(seed, kind, rational);
        }
      }
    }
  }
}

TEST(DomainEnergy, GradientMatchesCentralDifferences_CrossOracle)
{
  Random random(11);
  const Spline<2> identity = Identity<2>({ KnotVector::Uniform(3, 4), KnotVector::Uniform(2, 5) });
  std::vector<double> points, weights;
  RandomPlanes<2>(random, identity, 0.01, points, weights);
  DomainEnergy<2> energy(TensorPoints<2>(*identity.Space), identity.Space->NumFunctions);
  std::vector<double> gradient(points.size()), direction(points.size());
  energy.Evaluate({}, points.data(), nullptr, gradient.data(), nullptr);
  double slope = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    direction[i] = random.In(-1.0, 1.0);
    slope += gradient[i] * direction[i];
  }
  const auto at = [&](double t)
  {
    std::vector<double> moved = points;
    for (std::size_t i = 0; i < moved.size(); ++i)
    {
      moved[i] += t * direction[i];
    }
    return energy.Evaluate({}, moved.data(), nullptr, nullptr, nullptr).Energy;
  };
  constexpr double h = 1e-6; // error h^2 f''' / 6 + eps f / h, a few 1e-9 of the slope
  EXPECT_NEAR((at(h) - at(-h)) / (2 * h), slope, 1e-6 * std::abs(slope));
  EXPECT_GT(std::abs(slope), 1e-3);
}

TEST(DomainEnergy, TensorAndElementFieldsAgree_CrossOracle)
{
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    Random random(seed);
    const Spline<3> identity = Identity<3>({ KnotVector::Uniform(2, random.Int(1, 3)),
      KnotVector::Uniform(2, random.Int(1, 4)), KnotVector::Uniform(2, random.Int(1, 2)) });
    std::vector<double> points, weights;
    RandomPlanes<3>(random, identity, 0.02, points, weights);
    DomainEnergy<3> tensor(TensorPoints<3>(*identity.Space), identity.Space->NumFunctions);
    DomainEnergy<3> element(
      MakeElementField<3>(*identity.Space, std::vector<int>(identity.Space->Elements.size(), 3)),
      identity.Space->NumFunctions);
    EXPECT_EQ(tensor.Field().NumPoints(), element.Field().NumPoints());
    for (const double* w :
      { static_cast<const double*>(nullptr), static_cast<const double*>(weights.data()) })
    {
      std::vector<double> a(points.size()), b(points.size()), wa(weights.size()),
        wb(weights.size());
      const auto va = tensor.Evaluate({}, points.data(), w, a.data(), wa.data());
      const auto vb = element.Evaluate({}, points.data(), w, b.data(), wb.data());
      EXPECT_NEAR(va.Energy, vb.Energy, 1e-13 * va.Energy);
      EXPECT_NEAR(va.MinDet, vb.MinDet, 1e-13);
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        EXPECT_NEAR(a[i], b[i], 1e-12);
      }
    }
  }
}

TEST(DomainEnergy, HierarchicalFieldHasExactGradients_ExactOracle)
{
  const auto tensor =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 3), KnotVector::Uniform(2, 3) }).Value;
  const auto space = RefineElements<2>(tensor, { 4 }, { 1 }).Value;
  ASSERT_EQ(space->Kind, SpaceKind::Hierarchical);
  const Spline<2> identity = TransferToRefined<2>(Identity<2>(tensor->Knots), space).Value;
  Random random(2);
  std::vector<double> points, weights;
  RandomPlanes<2>(random, identity, 0.01, points, weights);
  std::fill(weights.begin(), weights.end(), 1.0);
  DomainEnergy<2> energy(
    MakeElementField<2>(*space, std::vector<int>(space->Elements.size(), 3)), space->NumFunctions);
  std::vector<double> gradient(points.size());
  energy.Evaluate({}, points.data(), nullptr, gradient.data(), nullptr);
  std::vector<Complex> z(points.begin(), points.end());
  const std::vector<Complex> w(weights.begin(), weights.end());
  for (std::size_t i = 0; i < points.size(); i += 5)
  {
    z[i] += Complex(0.0, 1e-30);
    const double exact = PlainEnergy<2, Complex>(*space, {}, z, w).imag() / 1e-30;
    EXPECT_NEAR(gradient[i], exact, 1e-10);
    z[i] = points[i];
  }
}

/// The Hessian times a direction against central differences of the exact gradient.
template <int Dim>
void ExpectExactHessian(unsigned seed, DensityKind kind, bool rational)
{
  Random random(seed);
  std::array<KnotVector, Dim> knots;
  knots.fill(KnotVector::Uniform(2, 2));
  const Spline<Dim> identity = Identity<Dim>(knots);
  std::vector<double> points, weights;
  RandomPlanes<Dim>(random, identity, kind == DensityKind::Quality ? 0.03 : 0.3, points, weights);
  Density density;
  density.Kind = kind;
  density.Delta = 0.1;
  const std::size_t n = weights.size();
  std::vector<int> free;
  for (std::size_t i = 0; i < n; i += 2)
  {
    free.push_back(static_cast<int>(i));
  }
  Spline<Dim> weighted = identity;
  if (rational)
  {
    weighted.Weights = Eigen::Map<Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(n));
  }
  NewtonSystem<Dim> system(
    SingleMap<Dim>(weighted), std::vector<int>(identity.Space->Elements.size(), 3), free);
  system.Assemble(density, points.data(), false);
  const Eigen::SparseMatrix<double> whole =
    system.Matrix().template selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd full = whole;
  DomainEnergy<Dim> energy(TensorPoints<Dim>(*identity.Space), identity.Space->NumFunctions);
  Eigen::VectorXd direction(full.rows());
  for (double& d : direction)
  {
    d = random.In(-1.0, 1.0);
  }
  const auto gradientAt = [&](double t)
  {
    std::vector<double> moved = points;
    std::vector<double> gradient(points.size());
    for (std::size_t c = 0; c < Dim; ++c)
    {
      for (std::size_t k = 0; k < free.size(); ++k)
      {
        moved[c * n + static_cast<std::size_t>(free[k])] +=
          t * direction[static_cast<Eigen::Index>(c * free.size() + k)];
      }
    }
    energy.Evaluate(
      density, moved.data(), rational ? weights.data() : nullptr, gradient.data(), nullptr);
    Eigen::VectorXd of(full.rows());
    for (std::size_t c = 0; c < Dim; ++c)
    {
      for (std::size_t k = 0; k < free.size(); ++k)
      {
        of[static_cast<Eigen::Index>(c * free.size() + k)] =
          gradient[c * n + static_cast<std::size_t>(free[k])];
      }
    }
    return of;
  };
  constexpr double h = 1e-6;
  const Eigen::VectorXd exact = full * direction;
  const Eigen::VectorXd difference = (gradientAt(h) - gradientAt(-h)) / (2 * h);
  // h^2 times fourth derivatives, which the penalty has of size 1 / delta^2 and more
  EXPECT_LE((exact - difference).norm(), 1e-5 * exact.norm());
}

TEST(DomainEnergy, HessiansMatchDifferencesOfGradients_CrossOracle)
{
  for (unsigned seed = 1; seed <= 4; ++seed)
  {
    for (bool rational : { false, true })
    {
      SCOPED_TRACE("seed " + std::to_string(seed) + (rational ? " rational" : ""));
      ExpectExactHessian<2>(seed, DensityKind::Quality, rational);
      ExpectExactHessian<2>(seed, DensityKind::Penalty, rational);
      ExpectExactHessian<3>(seed, DensityKind::Quality, rational);
      ExpectExactHessian<3>(seed, DensityKind::Penalty, rational);
    }
  }
}

TEST(DomainEnergy, SquareHasItsKnownEnergyAndFoldsAreInfinite_ExactOracle)
{
  const Spline<2> identity = Identity<2>({ KnotVector::Uniform(3, 2), KnotVector::Uniform(3, 2) });
  const Eigen::MatrixXd planes = identity.ControlPoints;
  DomainEnergy<2> energy(TensorPoints<2>(*identity.Space), identity.Space->NumFunctions);
  const auto square = energy.Evaluate({}, planes.data(), nullptr, nullptr, nullptr);
  EXPECT_NEAR(square.Energy, 2.0, 1e-9); // |J|^2 = 2, det = 1 + 1e-10
  EXPECT_NEAR(square.MinDet, 1.0, 1e-13);
  const Eigen::MatrixXd mirrored = planes.rowwise().reverse();
  const auto folded = energy.Evaluate({}, mirrored.data(), nullptr, nullptr, nullptr);
  EXPECT_TRUE(std::isinf(folded.Energy));
  EXPECT_NEAR(folded.MinDet, -1.0, 1e-13);
}
}
}
