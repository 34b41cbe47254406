// SPDX-License-Identifier: BSD-3-Clause
#include "DirectFit.h"

#include "LocatedSamples.h"
#include <knotwork/SplineCore/BasisEvaluation.h>
#include <knotwork/SplineCore/Quadrature.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
using ColumnMatrix = Eigen::SparseMatrix<double>;

/// Adds the lower triangle of a dense matrix at ascending unknowns; all entries exist.
void Scatter(ColumnMatrix& matrix, const std::vector<int>& unknowns, const Eigen::MatrixXd& values)
{
  double* stored = matrix.valuePtr();
  for (std::size_t j = 0; j < unknowns.size(); ++j)
  {
    int k = matrix.outerIndexPtr()[unknowns[j]];
    for (std::size_t i = j; i < unknowns.size(); ++i)
    {
      while (matrix.innerIndexPtr()[k] != unknowns[i])
      {
        ++k;
      }
      stored[k] += values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
}

template <int Dim>
class DirectFit final : public FitEquations<Dim>
{
public:
  DirectFit(SplineSpacePtr<Dim> space, bool coupled, int threads)
    : Space(std::move(space)), Coupled(coupled), Threads(threads)
  {
  }

  Result<PointMatrix> Step(const FitSamples<Dim>& samples, const FitWeights& weights,
    const PointMatrix& present, const PointMatrix* guess) override;

private:
  void Analyze();
  std::vector<int> Unknowns(const std::vector<int>& functions) const;
  void AddData(
    const LocatedSamples<Dim>& located, const FitSamples<Dim>& samples, const FitWeights& weights);
  void AddQuadratic(const FitWeights& weights, const PointMatrix& present);
  void AddStiffness(const FitWeights& weights);
  void AddSymmetric(const ColumnMatrix& lower);
  void AddMeasures(const FitWeights& weights, const PointMatrix& present);

  SplineSpacePtr<Dim> Space;
  bool Coupled;
  int Threads;
  bool IsAnalyzed = false;
  ColumnMatrix Matrix; // lower triangle; unknown f * Dim + d when coupled, else f
  PointMatrix Right;
  Eigen::SimplicialLDLT<ColumnMatrix, Eigen::Lower> Solver;
  ColumnMatrix Quadratic; // lower triangle of the weighted quadratic functionals, in the functions
  double QuadraticWeights[2] = { -1.0, -1.0 };
};

template <int Dim>
std::vector<int> DirectFit<Dim>::Unknowns(const std::vector<int>& functions) const
{
  if (!this->Coupled)
  {
    return functions;
  }
  std::vector<int> unknowns;
  unknowns.reserve(functions.size() * Dim);
  for (int f : functions)
  {
    for (int d = 0; d < Dim; ++d)
    {
      unknowns.push_back(f * Dim + d);
    }
  }
  return unknowns;
}

/// Pattern: functions that are alive on one element.
template <int Dim>
void DirectFit<Dim>::Analyze()
{
  const std::size_t numFunctions = static_cast<std::size_t>(this->Space->NumFunctions);
  std::vector<std::vector<int>> alive;
  std::vector<std::vector<int>> elementsOf(numFunctions);
  for (int e = 0; e < this->Space->NumElements(); ++e)
  {
    alive.push_back(this->Space->AliveFunctions(e));
    for (int f : alive.back())
    {
      elementsOf[static_cast<std::size_t>(f)].push_back(e);
    }
  }
  std::vector<std::vector<int>> columns(numFunctions);
  std::vector<int> seenBy(numFunctions, -1);
  std::size_t entries = 0;
  for (std::size_t j = 0; j < numFunctions; ++j)
  {
    std::vector<int>& column = columns[j];
    const int f = static_cast<int>(j);
    column.push_back(f);
    for (int e : elementsOf[j])
    {
      for (int g : alive[static_cast<std::size_t>(e)])
      {
        if (g > f && seenBy[static_cast<std::size_t>(g)] != f)
        {
          seenBy[static_cast<std::size_t>(g)] = f;
          column.push_back(g);
        }
      }
    }
    std::sort(column.begin(), column.end());
    entries += column.size();
  }
  const int width = this->Coupled ? Dim : 1;
  const int size = this->Space->NumFunctions * width;
  this->Matrix = ColumnMatrix(size, size);
  this->Matrix.reserve(static_cast<Eigen::Index>(entries) * width * width);
  for (int j = 0; j < size; ++j)
  {
    this->Matrix.startVec(j);
    for (int f : columns[static_cast<std::size_t>(j / width)])
    {
      for (int i = std::max(f * width, j); i < (f + 1) * width; ++i)
      {
        this->Matrix.insertBack(i, j) = 0.0;
      }
    }
  }
  this->Matrix.finalize();
  this->Solver.analyzePattern(this->Matrix);
  this->IsAnalyzed = true;
}

template <int Dim>
void DirectFit<Dim>::AddData(
  const LocatedSamples<Dim>& located, const FitSamples<Dim>& samples, const FitWeights& weights)
{
  FunctionValues values;
  const bool hasNormals = weights.Normal > 0.0;
  for (const auto& group : located.Groups)
  {
    const Eigen::Index rows = static_cast<Eigen::Index>(group.Last - group.First);
    // Rows: samples of the element. tau: values of the alive functions; along: tau times normal.
    Eigen::MatrixXd tau;
    Eigen::MatrixXd along;
    PointMatrix pull(rows, Dim); // what right-hand side a sample adds, times tau
    for (Eigen::Index r = 0; r < rows; ++r)
    {
      const Eigen::Index i = located.Order[group.First + static_cast<std::size_t>(r)];
      EvaluateFunctions(
        *this->Space, group.Element, located.Local.row(i).data(), 0, nullptr, values);
      const Eigen::Index alive = static_cast<Eigen::Index>(values.Functions.size());
      if (r == 0)
      {
        tau.resize(rows, alive);
        along.resize(hasNormals ? rows : 0, alive * Dim);
      }
      tau.row(r) = values.Values.col(0).transpose();
      pull.row(r) = weights.Point * samples.Residuals.row(i);
      if (hasNormals)
      {
        const auto normal = samples.Normals.row(i);
        pull.row(r) += weights.Normal * samples.Residuals.row(i).dot(normal) * normal;
        for (Eigen::Index f = 0; f < alive; ++f)
        {
          along.row(r).segment(f * Dim, Dim) = tau(r, f) * normal;
        }
      }
    }
    const std::vector<int> unknowns = this->Unknowns(values.Functions);
    const Eigen::MatrixXd gram = weights.Point * tau.transpose() * tau;
    if (this->Coupled)
    {
      Eigen::MatrixXd block = weights.Normal * along.transpose() * along;
      for (int d = 0; d < Dim; ++d)
      {
        for (Eigen::Index j = 0; j < gram.cols(); ++j)
        {
          for (Eigen::Index i = 0; i < gram.rows(); ++i)
          {
            block(i * Dim + d, j * Dim + d) += gram(i, j);
          }
        }
      }
      Scatter(this->Matrix, unknowns, block);
    }
    else
    {
      Scatter(this->Matrix, unknowns, gram);
    }
    const PointMatrix sums = tau.transpose() * pull;
    for (std::size_t f = 0; f < values.Functions.size(); ++f)
    {
      this->Right.row(values.Functions[f]) += sums.row(static_cast<Eigen::Index>(f));
    }
  }
}

template <int Dim>
void DirectFit<Dim>::AddQuadratic(const FitWeights& weights, const PointMatrix& present)
{
  if (!(weights.Uniformity > 0.0 || weights.Length > 0.0))
  {
    return;
  }
  if (weights.Uniformity != this->QuadraticWeights[0] ||
    weights.Length != this->QuadraticWeights[1])
  {
    this->Quadratic = LowerInFunctions<Dim>(*this->Space,
      QuadraticMatrix<Dim>(*this->Space, weights.Uniformity, weights.Length, this->Threads));
    this->QuadraticWeights[0] = weights.Uniformity;
    this->QuadraticWeights[1] = weights.Length;
  }
  const Eigen::MatrixXd columns = present;
  this->Right -= this->Quadratic.template selfadjointView<Eigen::Lower>() * columns;
  this->AddSymmetric(this->Quadratic);
}

template <int Dim>
void DirectFit<Dim>::AddStiffness(const FitWeights& weights)
{
  const auto isHeld = [](double weight) { return weight > 0.0; };
  if (std::any_of(weights.Stiffness.begin(), weights.Stiffness.end(), isHeld))
  {
    this->AddSymmetric(LowerInFunctions<Dim>(*this->Space,
      QuadraticMatrix<Dim>(*this->Space, 0.0, 0.0, this->Threads, weights.Stiffness)));
  }
}

/// The same for every coordinate. @param lower  triangle, in the functions.
template <int Dim>
void DirectFit<Dim>::AddSymmetric(const ColumnMatrix& lower)
{
  const int width = this->Coupled ? Dim : 1;
  double* stored = this->Matrix.valuePtr();
  for (int j = 0; j < this->Matrix.cols(); ++j)
  {
    int k = this->Matrix.outerIndexPtr()[j];
    for (ColumnMatrix::InnerIterator entry(lower, j / width); entry; ++entry)
    {
      const int row = static_cast<int>(entry.row()) * width + j % width;
      while (this->Matrix.innerIndexPtr()[k] != row)
      {
        ++k;
      }
      stored[k] += entry.value();
    }
  }
}

template <int Dim>
void DirectFit<Dim>::AddMeasures(const FitWeights& weights, const PointMatrix& present)
{
  const int order = weights.Eccentricity > 0.0 ? 2 : 1;
  FunctionValues values;
  QualityResidual<Dim> residuals[3];
  for (int e = 0; e < this->Space->NumElements(); ++e)
  {
    const auto& element = this->Space->Elements[static_cast<std::size_t>(e)];
    IntArray<Dim> numPoints = element.Degree;
    double volume = 1.0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      ++numPoints[d];
      volume *= element.Box.Upper[d] - element.Box.Lower[d];
    }
    const ElementQuadrature<Dim> rule = MakeElementQuadrature<Dim>(numPoints);
    Eigen::MatrixXd rows; // a column a q_i: its derivatives times the root of its weight
    Eigen::VectorXd negative;
    Eigen::Index count = 0;
    for (Eigen::Index q = 0; q < rule.Weights.size(); ++q)
    {
      EvaluateFunctions(*this->Space, e, rule.Local.row(q).data(), order, nullptr, values);
      const Eigen::Index alive = static_cast<Eigen::Index>(values.Functions.size());
      PointMatrix terms = PointMatrix::Zero(alive, 2 * Dim); // as the rows of a jet
      terms.leftCols(Dim) = values.Values.middleCols(1, Dim);
      for (int k = 0, pair = 1 + Dim; order == 2 && k < Dim; pair += Dim - k, ++k)
      {
        terms.col(Dim + k) = values.Values.col(pair);
      }
      if (q == 0)
      {
        rows.resize(alive * Dim, rule.Weights.size() * 3 * NumQualityKinds);
        negative.resize(rows.cols());
      }
      QualityJet<Dim> jet = QualityJet<Dim>::Zero();
      for (Eigen::Index f = 0; f < alive; ++f)
      {
        jet += terms.row(f).transpose() *
          present.row(values.Functions[static_cast<std::size_t>(f)]).template head<Dim>();
      }
      for (int k = 0; k < NumQualityKinds; ++k)
      {
        const QualityKind kind = static_cast<QualityKind>(k);
        const double weight = QualityWeight(weights, kind);
        if (IsQuadratic(kind) || !(weight > 0.0))
        {
          continue;
        }
        const double root = std::sqrt(weight * volume * rule.Weights(q));
        const int found = QualityResiduals<Dim>(kind, jet, residuals);
        for (int r = 0; r < found; ++r, ++count)
        {
          Eigen::Map<PointMatrix>(rows.col(count).data(), alive, Dim) =
            root * terms * residuals[r].Gradient;
          negative(count) = -root * residuals[r].Value;
        }
      }
    }
    const auto used = rows.leftCols(count);
    const Eigen::VectorXd sums = used * negative.head(count);
    Scatter(this->Matrix, this->Unknowns(values.Functions), used * used.transpose());
    for (std::size_t f = 0; f < values.Functions.size(); ++f)
    {
      this->Right.row(values.Functions[f]) +=
        sums.segment(static_cast<Eigen::Index>(f) * Dim, Dim).transpose();
    }
  }
}

template <int Dim>
Result<PointMatrix> DirectFit<Dim>::Step(const FitSamples<Dim>& samples, const FitWeights& weights,
  const PointMatrix& present, const PointMatrix*)
{
  const Result<LocatedSamples<Dim>> located = LocateSamples(*this->Space, samples.Parameters);
  if (!located)
  {
    return located.Status;
  }
  const bool hasMeasures = HasMeasures(weights);
  if (!this->Coupled && (hasMeasures || weights.Normal > 0.0))
  {
    this->Coupled = true;
    this->IsAnalyzed = false;
  }
  if (!this->IsAnalyzed)
  {
    this->Analyze();
  }
  std::fill(this->Matrix.valuePtr(), this->Matrix.valuePtr() + this->Matrix.nonZeros(), 0.0);
  this->Right = PointMatrix::Zero(this->Space->NumFunctions, Dim);
  this->AddData(located.Value, samples, weights);
  this->AddQuadratic(weights, present);
  this->AddStiffness(weights);
  if (hasMeasures)
  {
    this->AddMeasures(weights, present);
  }
  for (Eigen::Index j = 0; j < this->Matrix.cols(); ++j) // the diagonal is a column's first entry
  {
    this->Matrix.valuePtr()[this->Matrix.outerIndexPtr()[j]] += weights.Proximal;
  }

  this->Solver.factorize(this->Matrix);
  const auto pivots = this->Solver.vectorD();
  // Below this a pivot is what rounding left of zero.
  if (this->Solver.info() != Eigen::Success || !pivots.allFinite() ||
    pivots.minCoeff() <= 1e-14 * pivots.maxCoeff())
  {
    return UndeterminedControlPoints();
  }
  PointMatrix step(this->Space->NumFunctions, Dim);
  if (this->Coupled)
  {
    const Eigen::Map<const Eigen::VectorXd> flat(this->Right.data(), this->Right.size());
    Eigen::Map<Eigen::VectorXd>(step.data(), step.size()) = this->Solver.solve(flat);
  }
  else
  {
    const Eigen::MatrixXd columns = this->Right; // the solver's column order
    step = this->Solver.solve(columns);
  }
  return step;
}
}

template <int Dim>
std::unique_ptr<FitEquations<Dim>> MakeDirectFit(
  SplineSpacePtr<Dim> space, bool coupled, int threads)
{
  return std::make_unique<DirectFit<Dim>>(std::move(space), coupled, threads);
}

template std::unique_ptr<FitEquations<2>> MakeDirectFit(SplineSpacePtr<2>, bool, int);
template std::unique_ptr<FitEquations<3>> MakeDirectFit(SplineSpacePtr<3>, bool, int);
}
