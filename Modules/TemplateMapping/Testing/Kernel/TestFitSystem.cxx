// SPDX-License-Identifier: BSD-3-Clause
#include "FitCases.h"

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
template <int D, FitSolver S>
struct Variant
{
  static constexpr int Dim = D;
  static constexpr FitSolver Solver = S;
};
template <typename T>
class FitSystemTest : public ::testing::Test
{
};
using Variants =
  ::testing::Types<Variant<2, FitSolver::Direct>, Variant<2, FitSolver::ConjugateGradients>,
    Variant<3, FitSolver::Direct>, Variant<3, FitSolver::ConjugateGradients>>;
TYPED_TEST_SUITE(FitSystemTest, Variants);

FitWeights Weights(
  double point, double normal, double proximal, double uniformity = 0.0, double length = 0.0)
{
  FitWeights weights;
  weights.Point = point;
  weights.Normal = normal;
  weights.Proximal = proximal;
  weights.Uniformity = uniformity;
  weights.Length = length;
  return weights;
}
const FitWeights Quadratic[] = { Weights(1.0, 0.0, 2e-2), Weights(0.0, 1.0, 2e-2),
  Weights(0.3, 0.7, 1e-3), Weights(1.0, 0.0, 0.0, 1e-2, 0.0), Weights(0.0, 1.0, 1e-3, 0.0, 1e-2),
  Weights(0.3, 0.7, 1e-3, 1e-3, 1e-2) };

double FitWeights::*const Measures[] = { &FitWeights::Orthogonality, &FitWeights::Skewness,
  &FitWeights::Eccentricity, &FitWeights::Area, &FitWeights::SelfIntersection };

/// Every functional once, and all together.
std::vector<FitWeights> WithMeasures()
{
  std::vector<FitWeights> all;
  FitWeights together = Weights(0.3, 0.7, 1e-2, 1e-3, 1e-3);
  for (double FitWeights::*measure : Measures)
  {
    all.push_back(Weights(0.3, 0.7, 1e-2));
    all.back().*measure = 0.1;
    together.*measure = 0.05;
  }
  all.push_back(together);
  return all;
}

template <int Dim>
std::vector<SplineSpacePtr<Dim>> Spaces()
{
  return { cases::FitSpace<Dim>(), cases::HierarchicalFitSpace<Dim>() };
}
/// Small enough for dense matrices.
template <int Dim>
std::vector<SplineSpacePtr<Dim>> SmallSpaces()
{
  if constexpr (Dim == 2)
  {
    return Spaces<Dim>();
  }
  else
  {
    const KnotVector line = KnotVector::Uniform(2, 1, 0.0, 1.5);
    const SplineSpacePtr<3> space =
      MakeTensorSpace<3>({ KnotVector::Uniform(2, 2), KnotVector::Uniform(1, 1), line }).Value;
    return { space, RefineElements<3>(space, { 0 }).Value };
  }
}
int NumSamples(int dim)
{
  return dim == 2 ? 150 : 600;
}

/// The functional of a step that has no measures, from evaluations of the map: nothing of the
/// system is used.
template <int Dim>
double Functional(
  const cases::FitCase<Dim>& c, const PointMatrix& controlPoints, const FitWeights& weights)
{
  const PointMatrix gap = c.Values(controlPoints) - c.Points;
  double sum = weights.Point * gap.squaredNorm() +
    weights.Normal * (gap.cwiseProduct(c.Samples.Normals)).rowwise().sum().squaredNorm() +
    weights.Proximal * (controlPoints - c.Map.ControlPoints).squaredNorm();
  for (QualityKind kind : { QualityKind::Uniformity, QualityKind::Length })
  {
    sum += QualityWeight(weights, kind) > 0.0
      ? QualityWeight(weights, kind) * QualityValue<Dim>(c.Map.Space, controlPoints, kind, 1)
      : 0.0;
  }
  return sum;
}

/// The same step as one dense least-squares problem: a row a square, by differences of evaluations.
template <int Dim>
PointMatrix DenseStep(const cases::FitCase<Dim>& c, const FitWeights& weights)
{
  const SplineSpace<Dim>& space = *c.Map.Space;
  std::vector<int> elements;
  std::vector<double> roots; // of the quadrature weights
  PointMatrix local(0, Dim);
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> counts = element.Degree;
    double volume = 1.0;
    for (int d = 0; d < Dim; ++d)
    {
      ++counts[d];
      volume *= element.Box.Upper[d] - element.Box.Lower[d];
    }
    const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(counts);
    local.conservativeResize(local.rows() + rule.Local.rows(), Dim);
    local.bottomRows(rule.Local.rows()) = rule.Local;
    for (double w : rule.Weights)
    {
      elements.push_back(e);
      roots.push_back(std::sqrt(volume * w));
    }
  }
  // All q_i at control points, weights included; the data's are negative residuals.
  const auto squares = [&](const PointMatrix& controlPoints)
  {
    std::vector<double> q;
    const PointMatrix gap = c.Values(controlPoints) - c.Points;
    for (Eigen::Index i = 0; i < gap.rows(); ++i)
    {
      q.push_back(std::sqrt(weights.Normal) * gap.row(i).dot(c.Samples.Normals.row(i)));
      for (int d = 0; d < Dim; ++d)
      {
        q.push_back(std::sqrt(weights.Point) * gap(i, d));
      }
    }
    for (Eigen::Index k = 0; k < controlPoints.size(); ++k)
    {
      q.push_back(
        std::sqrt(weights.Proximal) * (controlPoints.data()[k] - c.Map.ControlPoints.data()[k]));
    }
    Spline<Dim> map = c.Map;
    map.ControlPoints = controlPoints;
    EvaluationBatch batch;
    EvaluationParams params;
    params.Derivatives = 2;
    EvaluateElements(MakeBezierForm(map), elements, local, params, batch);
    for (std::size_t i = 0; i < elements.size(); ++i)
    {
      const auto add = [&](double weight, double value)
      { q.push_back(weight > 0.0 ? roots[i] * std::sqrt(weight) * value : 0.0); };
      const auto first = [&](int k) -> Eigen::RowVectorXd
      { return batch.First.row(static_cast<Eigen::Index>(i)).segment(k * Dim, Dim); };
      int pair = 0;
      Eigen::MatrixXd jacobian(Dim, Dim);
      for (int k = 0; k < Dim; ++k)
      {
        jacobian.row(k) = first(k);
        const double square = first(k).squaredNorm();
        add(weights.SelfIntersection, 1.0 / (square + 1e-7));
        for (int d = 0; d < Dim; ++d)
        {
          add(weights.Length, first(k)(d));
        }
        for (int l = k; l < Dim; ++l, ++pair)
        {
          const Eigen::RowVectorXd second =
            batch.Second.row(static_cast<Eigen::Index>(i)).segment(pair * Dim, Dim);
          for (int d = 0; d < Dim; ++d)
          {
            add(weights.Uniformity * (k == l ? 1.0 : 2.0), second(d));
          }
          if (k == l)
          {
            add(weights.Eccentricity, first(k).dot(second) / square);
            continue;
          }
          const double dot = first(k).dot(first(l));
          add(weights.Orthogonality, dot);
          add(weights.Skewness, dot * dot / (square * first(l).squaredNorm()));
        }
      }
      add(weights.Area, jacobian.determinant());
    }
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(q.data(), Eigen::Index(q.size())));
  };
  const Eigen::VectorXd at = squares(c.Map.ControlPoints);
  Eigen::MatrixXd slopes(at.size(), c.Map.ControlPoints.size());
  const double h = 1e-5;
  for (Eigen::Index k = 0; k < slopes.cols(); ++k)
  {
    PointMatrix moved = c.Map.ControlPoints;
    moved.data()[k] += h;
    slopes.col(k) = squares(moved);
    moved.data()[k] -= 2.0 * h;
    slopes.col(k) = (slopes.col(k) - squares(moved)) / (2.0 * h);
  }
  const Eigen::MatrixXd normal = slopes.transpose() * slopes;
  const Eigen::VectorXd step = normal.ldlt().solve(-(slopes.transpose() * at));
  return Eigen::Map<const PointMatrix>(step.data(), c.Map.ControlPoints.rows(), Dim);
}
}

TYPED_TEST(FitSystemTest, GradientOfTheFunctionalVanishes_CrossOracle)
{
  constexpr int Dim = TypeParam::Dim;
  for (const FitWeights& weights : Quadratic)
  {
    const cases::FitCase<Dim> c(cases::FitSpace<Dim>(), 5, NumSamples(Dim));
    FitSystem<Dim> system(c.Map.Space, weights.Normal > 0, TypeParam::Solver);
    const Result<PointMatrix> step = system.Step(c.Samples, weights, c.Map.ControlPoints);
    ASSERT_TRUE(step) << step.Status.Message();
    const PointMatrix at = c.Map.ControlPoints + step.Value;
    // Central differences are exact for a quadratic functional up to the rounding of its values
    // (size below 10) over the difference 2 h, and the tolerance of the iteration.
    const double h = 1e-3;
    double largest = 0.0;
    double before = 0.0;
    for (Eigen::Index k = 0; k < at.size(); k += Dim == 2 ? 1 : 11)
    {
      const auto slope = [&](PointMatrix x)
      {
        x.data()[k] += h;
        const double up = Functional<Dim>(c, x, weights);
        x.data()[k] -= 2 * h;
        return (up - Functional<Dim>(c, x, weights)) / (2 * h);
      };
      largest = std::max(largest, std::abs(slope(at)));
      before = std::max(before, std::abs(slope(c.Map.ControlPoints)));
    }
    EXPECT_LE(largest, TypeParam::Solver == FitSolver::Direct ? 2e-11 : 1e-9);
    EXPECT_GT(before, 1e-2);
    EXPECT_LT(Functional<Dim>(c, at, weights), Functional<Dim>(c, c.Map.ControlPoints, weights));
  }
}

TYPED_TEST(FitSystemTest, StepsSolveTheDenseNormalEquations_CrossOracle)
{
  constexpr int Dim = TypeParam::Dim;
  for (const SplineSpacePtr<Dim>& space : SmallSpaces<Dim>())
  {
    const cases::FitCase<Dim> c(space, 6, 150);
    FitSystem<Dim> system(space, true, TypeParam::Solver);
    for (const FitWeights& weights : WithMeasures())
    {
      const Result<PointMatrix> step = system.Step(c.Samples, weights, c.Map.ControlPoints);
      ASSERT_TRUE(step) << step.Status.Message();
      const PointMatrix expected = DenseStep<Dim>(c, weights);
      // Differences of evaluations: errors of 1e-9 in the slopes, times the condition.
      EXPECT_LE((step.Value - expected).norm(), 1e-6 * expected.norm());
    }
  }
}

TYPED_TEST(FitSystemTest, SolversAgree_CrossOracle)
{
  constexpr int Dim = TypeParam::Dim;
  if (TypeParam::Solver == FitSolver::Direct)
  {
    return; // compared with itself
  }
  std::vector<FitWeights> all(std::begin(Quadratic), std::end(Quadratic));
  all.push_back(WithMeasures().back());
  for (const SplineSpacePtr<Dim>& space : Spaces<Dim>())
  {
    const cases::FitCase<Dim> c(space, 8, NumSamples(Dim));
    all.push_back(Weights(0.3, 0.7, 1e-3, 1e-3, 0.0)); // and a stiff element
    all.back().Stiffness.assign(static_cast<std::size_t>(space->NumElements()), 0.0);
    all.back().Stiffness[1] = 10.0;
    FitSystem<Dim> direct(space, true, FitSolver::Direct);
    FitSystem<Dim> iterative(space, true, TypeParam::Solver);
    for (const FitWeights& weights : all)
    {
      const Result<PointMatrix> expected = direct.Step(c.Samples, weights, c.Map.ControlPoints);
      const Result<PointMatrix> step = iterative.Step(c.Samples, weights, c.Map.ControlPoints);
      ASSERT_TRUE(step) << step.Status.Message();
      EXPECT_LE((step.Value - expected.Value).norm(), 1e-8 * expected.Value.norm());
      EXPECT_EQ(direct.Iterations(), 0);
      EXPECT_GT(iterative.Iterations(), 0);
    }
    all.pop_back();
  }
}

TYPED_TEST(FitSystemTest, ASystemIsUsedAgain_CrossOracle)
{
  constexpr int Dim = TypeParam::Dim;
  const cases::FitCase<Dim> first(cases::FitSpace<Dim>(), 1, NumSamples(Dim));
  const cases::FitCase<Dim> second(first.Map.Space, 2, 2 * NumSamples(Dim));
  FitSystem<Dim> system(first.Map.Space, true, TypeParam::Solver);
  // The first step leaves terms behind that the second one must not have.
  ASSERT_TRUE(system.Step(first.Samples, WithMeasures().back(), first.Map.ControlPoints));
  const Result<PointMatrix> used =
    system.Step(second.Samples, Quadratic[1], second.Map.ControlPoints);
  const Result<PointMatrix> fresh = FitSystem<Dim>(first.Map.Space, true, TypeParam::Solver)
                                      .Step(second.Samples, Quadratic[1], second.Map.ControlPoints);
  EXPECT_EQ(used.Value, fresh.Value);
  // Now a preconditioner of other samples serves: the solvers' tolerance.
  const Result<PointMatrix> again =
    system.Step(first.Samples, Quadratic[1], first.Map.ControlPoints);
  const Result<PointMatrix> alone = FitSystem<Dim>(first.Map.Space, true, TypeParam::Solver)
                                      .Step(first.Samples, Quadratic[1], first.Map.ControlPoints);
  EXPECT_LE((again.Value - alone.Value).norm(), 1e-9 * alone->norm());
}

TYPED_TEST(FitSystemTest, UncoupledSystemsAreCoupledWhenNeeded_CrossOracle)
{
  constexpr int Dim = TypeParam::Dim;
  const cases::FitCase<Dim> c(cases::FitSpace<Dim>(), 9, NumSamples(Dim));
  FitSystem<Dim> plain(c.Map.Space, false, TypeParam::Solver);
  FitSystem<Dim> coupled(c.Map.Space, true, TypeParam::Solver);
  for (const FitWeights& weights :
    { Quadratic[0], Quadratic[3], Quadratic[1], WithMeasures().front() })
  {
    const Result<PointMatrix> a = plain.Step(c.Samples, weights, c.Map.ControlPoints);
    const Result<PointMatrix> b = coupled.Step(c.Samples, weights, c.Map.ControlPoints);
    ASSERT_TRUE(a);
    ASSERT_TRUE(b);
    EXPECT_LE((a.Value - b.Value).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TYPED_TEST(FitSystemTest, ThreadsDoNotChangeABit_PropertyOracle)
{
  constexpr int Dim = TypeParam::Dim;
  const cases::FitCase<Dim> c(cases::HierarchicalFitSpace<Dim>(), 3, NumSamples(Dim));
  const FitWeights weights = WithMeasures().back();
  PointMatrix steps[2];
  for (int k = 0; k < 2; ++k)
  {
    FitSystem<Dim> system(c.Map.Space, true, TypeParam::Solver, 1 + k);
    steps[k] = system.Step(c.Samples, weights, c.Map.ControlPoints).Value;
  }
  EXPECT_GT(steps[0].norm(), 0.0);
  EXPECT_EQ(steps[0], steps[1]);
}

TYPED_TEST(FitSystemTest, NothingToCorrectIsNoStep_ExactOracle)
{
  constexpr int Dim = TypeParam::Dim;
  cases::FitCase<Dim> c(cases::FitSpace<Dim>(), 4, NumSamples(Dim));
  c.Samples.Residuals.setZero();
  FitSystem<Dim> system(c.Map.Space, true, TypeParam::Solver);
  const Result<PointMatrix> step = system.Step(c.Samples, Quadratic[1], c.Map.ControlPoints);
  ASSERT_TRUE(step);
  EXPECT_EQ(step.Value.norm(), 0.0);
}

TYPED_TEST(FitSystemTest, EveryFunctionalFalls_PropertyOracle)
{
  constexpr int Dim = TypeParam::Dim;
  const cases::FitCase<Dim> c(cases::HierarchicalFitSpace<Dim>(), 12, 0);
  FitSystem<Dim> system(c.Map.Space, true, TypeParam::Solver);
  for (int k = 0; k < NumQualityKinds; ++k)
  {
    const QualityKind kind = static_cast<QualityKind>(k);
    FitWeights weights = Weights(1.0, 0.0, 1.0);
    double FitWeights::*const members[] = { &FitWeights::Uniformity, &FitWeights::Length,
      &FitWeights::Orthogonality, &FitWeights::Skewness, &FitWeights::Eccentricity,
      &FitWeights::Area, &FitWeights::SelfIntersection };
    weights.*members[k] = 1.0;
    EXPECT_EQ(QualityWeight(weights, kind), 1.0);
    EXPECT_EQ(HasMeasures(weights), !IsQuadratic(kind));
    const Result<PointMatrix> step = system.Step(c.Samples, weights, c.Map.ControlPoints);
    ASSERT_TRUE(step) << step.Status.Message();
    const double before = QualityValue<Dim>(c.Map.Space, c.Map.ControlPoints, kind);
    const auto after = [&](double share)
    { return QualityValue<Dim>(c.Map.Space, c.Map.ControlPoints + share * step.Value, kind); };
    EXPECT_LT(std::min({ after(1.0), after(0.5), after(0.25), after(0.125) }), 0.99 * before) << k;
  }
}

TYPED_TEST(FitSystemTest, EveryFailureIsReachable)
{
  constexpr int Dim = TypeParam::Dim;
  cases::FitCase<Dim> c(cases::FitSpace<Dim>(), 3, NumSamples(Dim));
  FitSystem<Dim> system(c.Map.Space, false, TypeParam::Solver);
  const auto codeOf = [&](const FitSamples<Dim>& samples, const FitWeights& weights)
  { return system.Step(samples, weights, c.Map.ControlPoints).Status; };
  const FitWeights free = Weights(1.0, 0.0, 0.0);
  EXPECT_TRUE(codeOf(c.Samples, free));

  FitSamples<Dim> half = c.Samples; // samples in one part: the other control points are free
  half.Parameters.col(0) *= 0.25;
  EXPECT_EQ(codeOf(half, free).Code, ErrorCode::SingularSystem);
  EXPECT_NE(codeOf(half, free).Detail.find("Tikhonov"), std::string::npos);

  FitSamples<Dim> few = c.Samples; // every function is reached, but by too few samples
  const Eigen::Index count = c.Map.Space->NumFunctions / 2;
  few.Parameters.conservativeResize(count, Dim);
  few.Residuals.conservativeResize(count, Dim);
  EXPECT_EQ(codeOf(few, free).Code, ErrorCode::SingularSystem);

  FitSamples<Dim> sliding = c.Samples; // all may slide along the first axis
  sliding.Normals.setZero();
  sliding.Normals.col(1).setOnes();
  EXPECT_EQ(codeOf(sliding, Weights(0.0, 1.0, 0.0)).Code, ErrorCode::SingularSystem);
  // Quadratic functionals alone leave translations free.
  EXPECT_EQ(codeOf({ PointMatrix(0, Dim), PointMatrix(0, Dim), PointMatrix(0, Dim) },
              Weights(0.0, 0.0, 0.0, 1.0, 1.0))
              .Code,
    ErrorCode::SingularSystem);

  FitSamples<Dim> huge = c.Samples;
  huge.Residuals.setConstant(1e308);
  EXPECT_EQ(codeOf(huge, Weights(1.0, 0.0, 1.0)).Code, ErrorCode::SingularSystem);
  EXPECT_EQ(codeOf(huge, Weights(1.0, 0.0, 1.0)).Detail, "the step is not finite");

  FitSamples<Dim> outside = c.Samples;
  outside.Parameters(7, 0) = 1.5;
  EXPECT_EQ(codeOf(outside, free).Code, ErrorCode::OutsideDomain);
  EXPECT_EQ(codeOf(outside, free).Detail, "sample 7");

  FitSamples<Dim> uneven = c.Samples;
  uneven.Normals.resize(1, Dim);
  EXPECT_TRUE(codeOf(uneven, free)); // not read
  EXPECT_EQ(codeOf(uneven, Weights(0.0, 1.0, 1.0)).Code, ErrorCode::SizeMismatch);
  EXPECT_EQ(
    system.Step(c.Samples, free, c.Samples.Parameters).Status.Code, ErrorCode::SizeMismatch);
  FitWeights stiff = Weights(1.0, 0.0, 1.0);
  stiff.Stiffness = { 1.0 };
  EXPECT_EQ(codeOf(c.Samples, stiff).Code, ErrorCode::SizeMismatch);
}

TEST(FitSystem, AGoodGuessSavesIterations_PropertyOracle)
{
  const cases::FitCase<3> c(cases::HierarchicalFitSpace<3>(), 3, 600);
  FitSystem<3> system(c.Map.Space, true); // the default in space
  const FitWeights weights = Quadratic[5];
  const Result<PointMatrix> step = system.Step(c.Samples, weights, c.Map.ControlPoints);
  ASSERT_TRUE(step);
  const int cold = system.Iterations();
  ASSERT_GT(cold, 10);
  const PointMatrix near = step.Value + 1e-6 * PointMatrix::Random(step.Value.rows(), 3);
  const Result<PointMatrix> again = system.Step(c.Samples, weights, c.Map.ControlPoints, &near);
  EXPECT_LT(system.Iterations(), cold);
  EXPECT_GT(system.Iterations(), 0);
  EXPECT_LE((again.Value - step.Value).norm(), 1e-8 * step.Value.norm());
  ASSERT_TRUE(system.Step(c.Samples, weights, c.Map.ControlPoints, &step.Value));
  EXPECT_LE(system.Iterations(), 1);
}

TEST(FitSystem, DefaultsAreDirectInThePlaneAndIterativeInSpace_ExactOracle)
{
  const cases::FitCase<2> plane(cases::FitSpace<2>(), 3, 100);
  FitSystem<2> direct(plane.Map.Space, true);
  ASSERT_TRUE(direct.Step(plane.Samples, Quadratic[1], plane.Map.ControlPoints));
  EXPECT_EQ(direct.Iterations(), 0);
}
