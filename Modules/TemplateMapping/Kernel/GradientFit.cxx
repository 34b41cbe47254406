// SPDX-License-Identifier: BSD-3-Clause
#include "GradientFit.h"

#include "DataTerms.h"
#include "IncompleteFactor.h"
#include "MeasureTerms.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

namespace knotwork
{
namespace
{
constexpr std::size_t ElementChunk = 8;
constexpr std::size_t RowChunk = 512;
/// Of the residual in the preconditioner's norm, against that of the right-hand side: steps then
/// agree with those of the factorization to about 1e-9 of their size.
constexpr double Tolerance = 1e-11;
constexpr int MaxIterations = 3000;
/// A factor is made anew when it needs so many times the iterations that it needed at first.
constexpr int MoreIterations = 2;
/// A curvature below this part of the preconditioner's is what rounding left of zero.
constexpr double LeastCurvature = 1e-13;

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using ColumnMatrix = Eigen::SparseMatrix<double>;

template <int Dim>
class GradientFit final : public FitEquations<Dim>
{
public:
  GradientFit(SplineSpacePtr<Dim> space, int threads);
  Result<PointMatrix> Step(const FitSamples<Dim>& samples, const FitWeights& weights,
    const PointMatrix& present, const PointMatrix* guess) override;
  int Iterations() const override { return this->NumIterations; }

private:
  using Block = Eigen::Matrix<double, Dim, Dim>;
  static constexpr std::size_t MaxStride = 1000 + DataTerms<Dim>::NumLanes; // of degree 9

  PointMatrix ToLocal(const PointMatrix& x) const;
  PointMatrix FromLocal(const PointMatrix& x) const;
  void SetQuadratic(const FitWeights& weights);
  void SetStiffness(const FitWeights& weights);
  void SetElements(const LocatedSamples<Dim>& located, bool all);
  template <typename Fill>
  PointMatrix SumOverElements(const Fill& fill);
  PointMatrix RightSide(const PointMatrix& present);
  PointMatrix Apply(const PointMatrix& x);
  std::vector<Block> DiagonalBlocks() const;
  Status MakePreconditioner(const FitWeights& weights);
  bool IsFactorOfUse(const FitWeights& weights) const;
  PointMatrix Precondition(const PointMatrix& r) const;
  Status Solve(const PointMatrix& right, PointMatrix& x);
  Status CheckDetermined();

  SplineSpacePtr<Dim> Space;
  int Threads;
  std::size_t NumLocal;                       // local functions of an element
  std::size_t Stride;                         // numbers of a plane of an element's vectors
  RowMatrix Truncation, TruncationTransposed; // empty when local functions are the functions
  RowMatrix Quadratic;                        // in local functions
  ColumnMatrix QuadraticLower;                // in functions
  double QuadraticWeights[2] = { 0.0, 0.0 };
  RowMatrix Stiffness; // of the step, likewise
  ColumnMatrix StiffnessLower;
  int NumIterations = 0;

  // of the present step
  double Proximal = 0.0;
  std::unique_ptr<DataTerms<Dim>> Data;
  std::unique_ptr<MeasureTerms<Dim>> Measures; // kept between steps
  bool HasMeasureTerms = false;
  struct Place
  {
    int Element;
    int Group; // of the data; -1: none
  };
  std::vector<Place> Elements;
  std::vector<double> Sums;             // per entry of Elements: Dim planes
  std::vector<std::size_t> FirstOffset; // by local function, into Offsets
  std::vector<std::size_t> Offsets;     // of the first plane in Sums
  std::vector<Block> Inverse;           // of the diagonal blocks
  IncompleteFactor<Dim> Factor;         // kept between steps
  bool UsesFactor = false;
  FitWeights FactorWeights;  // with which it was made
  int FactorIterations = -1; // of the first solve with it; -1: none yet
};

template <int Dim>
GradientFit<Dim>::GradientFit(SplineSpacePtr<Dim> space, int threads)
  : Space(std::move(space)), Threads(threads)
{
  const int numLocal = NumTensorFunctions<Dim>(this->Space->Elements.front().Degree);
  this->NumLocal = static_cast<std::size_t>(numLocal);
  this->Stride = static_cast<std::size_t>(DataTerms<Dim>::Stride(numLocal));
  if (!this->Space->IsIdentityMap())
  {
    this->Truncation = TruncationMatrix<Dim>(*this->Space);
    this->TruncationTransposed = this->Truncation.transpose();
  }
}

/// Rows of matrix * x.
PointMatrix Multiply(const RowMatrix& matrix, const PointMatrix& x, int threads)
{
  PointMatrix result(matrix.rows(), x.cols());
  ParallelFor(static_cast<std::size_t>(matrix.rows()), RowChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      const int* outer = matrix.outerIndexPtr();
      const int* inner = matrix.innerIndexPtr();
      const double* value = matrix.valuePtr();
      for (std::size_t i = begin; i < end; ++i)
      {
        double sum[3] = {};
        for (int k = outer[i]; k < outer[i + 1]; ++k)
        {
          const double* row = x.data() + static_cast<std::ptrdiff_t>(inner[k]) * x.cols();
          for (Eigen::Index d = 0; d < x.cols(); ++d)
          {
            sum[d] += value[k] * row[d];
          }
        }
        std::copy_n(sum, x.cols(), result.data() + static_cast<std::ptrdiff_t>(i) * x.cols());
      }
    });
  return result;
}

template <int Dim>
PointMatrix GradientFit<Dim>::ToLocal(const PointMatrix& x) const
{
  return this->Truncation.rows() == 0 ? x : Multiply(this->Truncation, x, this->Threads);
}

template <int Dim>
PointMatrix GradientFit<Dim>::FromLocal(const PointMatrix& x) const
{
  return this->Truncation.rows() == 0 ? x : Multiply(this->TruncationTransposed, x, this->Threads);
}

template <int Dim>
void GradientFit<Dim>::SetQuadratic(const FitWeights& weights)
{
  if (weights.Uniformity == this->QuadraticWeights[0] &&
    weights.Length == this->QuadraticWeights[1])
  {
    return;
  }
  this->QuadraticWeights[0] = weights.Uniformity;
  this->QuadraticWeights[1] = weights.Length;
  this->Quadratic = RowMatrix();
  if (weights.Uniformity > 0.0 || weights.Length > 0.0)
  {
    this->Quadratic =
      QuadraticMatrix<Dim>(*this->Space, weights.Uniformity, weights.Length, this->Threads);
    this->QuadraticLower = LowerInFunctions<Dim>(*this->Space, this->Quadratic);
  }
}

template <int Dim>
void GradientFit<Dim>::SetStiffness(const FitWeights& weights)
{
  this->Stiffness = RowMatrix();
  if (std::any_of(weights.Stiffness.begin(), weights.Stiffness.end(),
        [](double weight) { return weight > 0.0; }))
  {
    this->Stiffness =
      QuadraticMatrix<Dim>(*this->Space, 0.0, 0.0, this->Threads, weights.Stiffness);
    this->StiffnessLower = LowerInFunctions<Dim>(*this->Space, this->Stiffness);
  }
}

/// The elements of the step, and where the sums of every local function lie.
template <int Dim>
void GradientFit<Dim>::SetElements(const LocatedSamples<Dim>& located, bool all)
{
  this->Elements.clear();
  for (int e = 0; all && e < this->Space->NumElements(); ++e)
  {
    this->Elements.push_back({ e, -1 });
  }
  for (std::size_t g = 0; g < located.Groups.size(); ++g)
  {
    const int e = located.Groups[g].Element;
    if (all)
    {
      this->Elements[static_cast<std::size_t>(e)].Group = static_cast<int>(g);
    }
    else
    {
      this->Elements.push_back({ e, static_cast<int>(g) });
    }
  }
  const std::size_t size = static_cast<std::size_t>(
    this->Space->IsIdentityMap() ? this->Space->NumFunctions : this->Space->NumLocalFunctions);
  this->FirstOffset.assign(size + 1, 0);
  const auto visit = [&](const auto& add)
  {
    for (std::size_t k = 0; k < this->Elements.size(); ++k)
    {
      const int* ids = this->Space->LocalFunctions(this->Elements[k].Element);
      for (std::size_t j = 0; j < this->NumLocal; ++j)
      {
        add(static_cast<std::size_t>(ids[j]), k * Dim * this->Stride + j);
      }
    }
  };
  visit([&](std::size_t function, std::size_t) { ++this->FirstOffset[function + 1]; });
  for (std::size_t j = 0; j < size; ++j)
  {
    this->FirstOffset[j + 1] += this->FirstOffset[j];
  }
  std::vector<std::size_t> next(this->FirstOffset.begin(), this->FirstOffset.end() - 1);
  this->Offsets.resize(this->FirstOffset.back());
  visit(
    [&](std::size_t function, std::size_t offset) { this->Offsets[next[function]++] = offset; });
  this->Sums.resize(this->Elements.size() * Dim * this->Stride);
}

/// fill(place, sums) adds to the planes of an element of the step; the result is by local function.
template <int Dim>
template <typename Fill>
PointMatrix GradientFit<Dim>::SumOverElements(const Fill& fill)
{
  const std::size_t size = Dim * this->Stride;
  ParallelFor(this->Elements.size(), ElementChunk, this->Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t k = begin; k < end; ++k)
      {
        double* sums = this->Sums.data() + k * size;
        std::fill_n(sums, size, 0.0);
        fill(this->Elements[k], sums);
      }
    });
  PointMatrix result(static_cast<Eigen::Index>(this->FirstOffset.size() - 1), Dim);
  ParallelFor(this->FirstOffset.size() - 1, RowChunk, this->Threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t j = begin; j < end; ++j)
      {
        double sum[Dim] = {};
        for (std::size_t k = this->FirstOffset[j]; k < this->FirstOffset[j + 1]; ++k)
        {
          for (std::size_t d = 0; d < Dim; ++d)
          {
            sum[d] += this->Sums[this->Offsets[k] + d * this->Stride];
          }
        }
        std::copy_n(sum, Dim, result.data() + j * Dim);
      }
    });
  return result;
}

template <int Dim>
PointMatrix GradientFit<Dim>::RightSide(const PointMatrix& present)
{
  PointMatrix right = this->SumOverElements(
    [&](const Place& place, double* sums)
    {
      if (place.Group >= 0)
      {
        this->Data->AddRight(place.Group, sums);
      }
      if (this->HasMeasureTerms)
      {
        this->Measures->AddRight(place.Element, sums);
      }
    });
  if (this->Quadratic.rows() > 0)
  {
    right -= Multiply(this->Quadratic, this->ToLocal(present), this->Threads);
  }
  return this->FromLocal(right);
}

/// The matrix of the normal equations times x.
template <int Dim>
PointMatrix GradientFit<Dim>::Apply(const PointMatrix& x)
{
  const PointMatrix local = this->ToLocal(x);
  PointMatrix sum = this->SumOverElements(
    [&](const Place& place, double* sums)
    {
      const int* ids = this->Space->LocalFunctions(place.Element);
      double planes[Dim * MaxStride];
      for (std::size_t d = 0; d < Dim; ++d)
      {
        for (std::size_t j = 0; j < this->NumLocal; ++j)
        {
          planes[d * this->Stride + j] = local.data()[static_cast<std::size_t>(ids[j]) * Dim + d];
        }
        for (std::size_t j = this->NumLocal; j < this->Stride; ++j)
        {
          planes[d * this->Stride + j] = 0.0;
        }
      }
      if (place.Group >= 0)
      {
        this->Data->Apply(place.Group, planes, sums);
      }
      if (this->HasMeasureTerms)
      {
        this->Measures->Apply(place.Element, planes, sums);
      }
    });
  if (this->Quadratic.rows() > 0)
  {
    sum += Multiply(this->Quadratic, local, this->Threads);
  }
  if (this->Stiffness.rows() > 0)
  {
    sum += Multiply(this->Stiffness, local, this->Threads);
  }
  PointMatrix result = this->FromLocal(sum);
  result += this->Proximal * x;
  return result;
}

/// Dim x Dim blocks of the matrix, one a function. Exact for the data and the quadratic
/// functionals; those of the measures are estimates.
template <int Dim>
std::vector<typename GradientFit<Dim>::Block> GradientFit<Dim>::DiagonalBlocks() const
{
  const std::size_t n = static_cast<std::size_t>(this->Space->NumFunctions);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(this->Space->NumFunctions, this->Proximal);
  if (this->Quadratic.rows() > 0)
  {
    diagonal += this->QuadraticLower.diagonal();
  }
  if (this->Stiffness.rows() > 0)
  {
    diagonal += this->StiffnessLower.diagonal();
  }
  std::vector<Block> blocks(n);
  for (std::size_t f = 0; f < n; ++f)
  {
    blocks[f] = diagonal(static_cast<Eigen::Index>(f)) * Block::Identity();
  }
  const bool isIdentity = this->Truncation.rows() == 0;
  std::vector<double> values(isIdentity ? 0 : n, 0.0); // of all functions at a sample
  std::vector<Block> ofElement(this->NumLocal);
  for (const Place& place : this->Elements)
  {
    const int* ids = this->Space->LocalFunctions(place.Element);
    const std::vector<int> alive =
      isIdentity ? std::vector<int>() : this->Space->AliveFunctions(place.Element);
    for (int s = 0; place.Group >= 0 && s < this->Data->NumSamples(place.Group); ++s)
    {
      const double* tau = this->Data->Values(place.Group, s);
      const Block w = this->Data->Weight(place.Group, s);
      for (std::size_t j = 0; j < this->NumLocal; ++j)
      {
        if (isIdentity)
        {
          blocks[static_cast<std::size_t>(ids[j])] += tau[j] * tau[j] * w;
          continue;
        }
        for (RowMatrix::InnerIterator k(this->Truncation, ids[j]); k; ++k)
        {
          values[static_cast<std::size_t>(k.col())] += tau[j] * k.value();
        }
      }
      for (int f : alive)
      {
        double& value = values[static_cast<std::size_t>(f)];
        blocks[static_cast<std::size_t>(f)] += value * value * w;
        value = 0.0;
      }
    }
    if (!this->HasMeasureTerms)
    {
      continue;
    }
    std::fill(ofElement.begin(), ofElement.end(), Block::Zero());
    this->Measures->AddDiagonal(place.Element, ofElement.data());
    for (std::size_t j = 0; j < this->NumLocal; ++j)
    {
      if (isIdentity)
      {
        blocks[static_cast<std::size_t>(ids[j])] += ofElement[j];
        continue;
      }
      for (RowMatrix::InnerIterator k(this->Truncation, ids[j]); k; ++k)
      {
        blocks[static_cast<std::size_t>(k.col())] += k.value() * k.value() * ofElement[j];
      }
    }
  }
  return blocks;
}

/// Inverts the diagonal blocks (a singular one makes the matrix singular, which is semidefinite)
/// and factors.
template <int Dim>
Status GradientFit<Dim>::MakePreconditioner(const FitWeights& weights)
{
  const std::vector<Block> blocks = this->DiagonalBlocks();
  double largest = 0.0;
  for (const Block& block : blocks)
  {
    largest = std::max(largest, block.trace());
  }
  this->Inverse.resize(blocks.size());
  for (std::size_t f = 0; f < blocks.size(); ++f)
  {
    const Eigen::SelfAdjointEigenSolver<Block> solver(blocks[f], Eigen::EigenvaluesOnly);
    // a direction without samples has what rounding left of zero, against the others of its block
    const double least = solver.eigenvalues()(0);
    if (!(least > 1e-13 * blocks[f].trace() && least > 1e-15 * largest))
    {
      return UndeterminedControlPoints();
    }
    this->Inverse[f] = blocks[f].inverse();
  }
  if (this->IsFactorOfUse(weights))
  {
    return {};
  }
  std::vector<const ColumnMatrix*> scalar;
  if (this->Quadratic.rows() > 0)
  {
    scalar.push_back(&this->QuadraticLower);
  }
  if (this->Stiffness.rows() > 0)
  {
    scalar.push_back(&this->StiffnessLower);
  }
  this->UsesFactor = this->Factor.Compute(
    *this->Space, *this->Data, this->Truncation, blocks, scalar, this->Threads);
  this->FactorWeights = weights;
  this->FactorIterations = -1;
  return {};
}

/// The factor of an earlier step serves while the samples have moved little, which the number of
/// iterations tells.
template <int Dim>
bool GradientFit<Dim>::IsFactorOfUse(const FitWeights& weights) const
{
  const FitWeights& then = this->FactorWeights;
  return this->UsesFactor && this->FactorIterations >= 0 &&
    this->NumIterations <= MoreIterations * std::max(1, this->FactorIterations) &&
    weights.Point == then.Point && weights.Normal == then.Normal &&
    weights.Proximal == then.Proximal && weights.Uniformity == then.Uniformity &&
    weights.Length == then.Length && weights.Stiffness == then.Stiffness;
}

template <int Dim>
PointMatrix GradientFit<Dim>::Precondition(const PointMatrix& r) const
{
  if (this->UsesFactor)
  {
    return this->Factor.Solve(r);
  }
  using Row = Eigen::Matrix<double, 1, Dim>;
  PointMatrix z(r.rows(), Dim);
  for (Eigen::Index j = 0; j < r.rows(); ++j)
  {
    const Eigen::Map<const Row> row(r.data() + j * Dim);
    Eigen::Map<Row>(z.data() + j * Dim).noalias() =
      row * this->Inverse[static_cast<std::size_t>(j)];
  }
  return z;
}

double Dot(const PointMatrix& a, const PointMatrix& b)
{
  return a.cwiseProduct(b).sum();
}

/// Conjugate gradients from x on.
/// @source  Hestenes, Stiefel, J. Res. Nat. Bur. Standards 49 (1952) 409-436.
template <int Dim>
Status GradientFit<Dim>::Solve(const PointMatrix& right, PointMatrix& x)
{
  this->NumIterations = 0;
  const double size = Dot(right, this->Precondition(right));
  if (!std::isfinite(size))
  {
    return { ErrorCode::SingularSystem, "the step is not finite" };
  }
  PointMatrix r = right - this->Apply(x);
  PointMatrix p = this->Precondition(r);
  double square = Dot(r, p);   // of the residual, in the norm of the inverse preconditioner
  double ofDirection = square; // of p, in the norm of the preconditioner
  for (; square > Tolerance * Tolerance * size; ++this->NumIterations)
  {
    if (this->NumIterations == MaxIterations)
    {
      return { ErrorCode::NotConverged,
        "conjugate gradients; use a larger Tikhonov weight or the direct solver" };
    }
    const PointMatrix ap = this->Apply(p);
    const double curvature = Dot(p, ap);
    if (!(curvature > LeastCurvature * ofDirection))
    {
      return UndeterminedControlPoints();
    }
    const double alpha = square / curvature;
    x += alpha * p;
    r -= alpha * ap;
    const PointMatrix z = this->Precondition(r);
    const double next = Dot(r, z);
    const double beta = next / square;
    p = z + beta * p;
    ofDirection = next + beta * beta * ofDirection;
    square = next;
  }
  return {};
}

/// Whether the matrix is regular: the right-hand side of a fit lies in the range of the matrix and
/// does not tell, a random one does. With the inverse blocks as preconditioner: a factor would be
/// as singular as the matrix.
template <int Dim>
Status GradientFit<Dim>::CheckDetermined()
{
  std::mt19937 random(1);
  PointMatrix right(this->Space->NumFunctions, Dim);
  for (Eigen::Index k = 0; k < right.size(); ++k)
  {
    right.data()[k] = static_cast<double>(random()) / 4294967296.0 - 0.5;
  }
  // The same share of each function, whatever its size.
  for (Eigen::Index f = 0; f < right.rows(); ++f)
  {
    right.row(f) /= std::sqrt(this->Inverse[static_cast<std::size_t>(f)].trace());
  }
  PointMatrix x = PointMatrix::Zero(right.rows(), Dim);
  const bool usesFactor = this->UsesFactor;
  this->UsesFactor = false;
  Status status = this->Solve(right, x);
  this->UsesFactor = usesFactor;
  return status;
}

template <int Dim>
Result<PointMatrix> GradientFit<Dim>::Step(const FitSamples<Dim>& samples,
  const FitWeights& weights, const PointMatrix& present, const PointMatrix* guess)
{
  const Result<LocatedSamples<Dim>> located = LocateSamples(*this->Space, samples.Parameters);
  if (!located)
  {
    return located.Status;
  }
  this->Proximal = weights.Proximal;
  this->HasMeasureTerms = HasMeasures(weights);
  this->Data =
    std::make_unique<DataTerms<Dim>>(*this->Space, located.Value, samples, weights, this->Threads);
  this->SetElements(located.Value, this->HasMeasureTerms);
  this->SetQuadratic(weights);
  this->SetStiffness(weights);
  if (this->HasMeasureTerms)
  {
    if (!this->Measures)
    {
      this->Measures =
        std::make_unique<MeasureTerms<Dim>>(this->Space, this->Stride, this->Threads);
    }
    this->Measures->Linearize(weights, this->ToLocal(present));
  }
  const PointMatrix right = this->RightSide(present);
  Status status = this->MakePreconditioner(weights);
  if (status && !(weights.Proximal > 0.0))
  {
    status = this->CheckDetermined();
  }
  if (!status)
  {
    return status;
  }
  PointMatrix x = guess ? *guess : PointMatrix(PointMatrix::Zero(right.rows(), Dim));
  status = this->Solve(right, x);
  if (!status)
  {
    return status;
  }
  if (this->FactorIterations < 0)
  {
    this->FactorIterations = this->NumIterations;
  }
  return x;
}
}

template <int Dim>
std::unique_ptr<FitEquations<Dim>> MakeGradientFit(SplineSpacePtr<Dim> space, int threads)
{
  return std::make_unique<GradientFit<Dim>>(std::move(space), threads);
}

template std::unique_ptr<FitEquations<2>> MakeGradientFit(SplineSpacePtr<2>, int);
template std::unique_ptr<FitEquations<3>> MakeGradientFit(SplineSpacePtr<3>, int);
}
