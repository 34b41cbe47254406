// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/QualityFunctionals.h>
#include <knotwork/SplineCore/Spline.h>

#include <memory>

namespace knotwork
{
/// Points that a spline map should take somewhere: rows of equal number.
template <int Dim>
struct FitSamples
{
  PointMatrix Parameters; ///< n x Dim, inside the domain
  PointMatrix Residuals;  ///< n x Dim, r_i = p_i - s(u_i) under the present control points
  PointMatrix Normals;    ///< n x Dim unit normals; not read when the normal weight is 0
};

/// Weights of the terms of a fit, >= 0.
struct FitWeights
{
  double Point = 0.0;    ///< of sum |s(u_i) - p_i|^2
  double Normal = 0.0;   ///< of sum ((s(u_i) - p_i) . N_i)^2
  double Proximal = 0.0; ///< of sum |c - c_present|^2 over the control points
  // of the functionals of QualityFunctionals.h, of the map after the step:
  double Uniformity = 0.0;       ///< thin plate
  double Length = 0.0;           ///< sum of the squared first derivatives
  double Orthogonality = 0.0;    ///< products of first derivatives, squared
  double Skewness = 0.0;         ///< fourth powers of the cosines between first derivatives
  double Eccentricity = 0.0;     ///< squared slopes of the logarithms of speeds
  double Area = 0.0;             ///< (det J)^2
  double SelfIntersection = 0.0; ///< inverse fourth powers of speeds
  /// Empty, or a weight an element, of the integral over it of sum_k |d_k|^2, d_k the derivatives
  /// of the step: holds single elements back.
  std::vector<double> Stiffness = {};
};

/// The weight of a functional.
double QualityWeight(const FitWeights& weights, QualityKind kind);
/// Whether a functional that is not quadratic has a weight.
bool HasMeasures(const FitWeights& weights);

enum class FitSolver
{
  Automatic,         ///< Direct for Dim = 2, ConjugateGradients for Dim = 3
  Direct,            ///< sparse LDL^T, minimum-degree order
  ConjugateGradients ///< preconditioned, the matrix of the data is never formed
};

/// The diagnosis of all solvers for a singular matrix.
Status UndeterminedControlPoints();

/// What a solver of the normal equations is: see FitSystem::Step.
template <int Dim>
class FitEquations
{
public:
  virtual ~FitEquations() = default;
  virtual Result<PointMatrix> Step(const FitSamples<Dim>& samples, const FitWeights& weights,
    const PointMatrix& present, const PointMatrix* guess) = 0;
  /// Of the last step; 0 without iterations.
  virtual int Iterations() const { return 0; }
};

/// One least-squares step for the control points of a polynomial spline map. What depends on the
/// space alone (patterns, quadratic functionals) is made once and used by all steps.
template <int Dim>
class FitSystem
{
public:
  /// @param coupled  whether steps will have normal terms or measures that are not quadratic, which
  ///   couple the coordinates: Dim n unknowns instead of Dim systems of n. A step that needs it is
  ///   coupled anyway.
  /// @param threads  0: all cores. Results do not depend on it.
  FitSystem(SplineSpacePtr<Dim> space, bool coupled, FitSolver solver = FitSolver::Automatic,
    int threads = 0);

  /// Change d of the control points, NumFunctions x Dim, that minimizes
  ///     Point sum |r_i - s_d(u_i)|^2 + Normal sum ((r_i - s_d(u_i)) . N_i)^2 + Proximal |d|^2
  ///     + Uniformity Q_u(c + d) + Length Q_l(c + d)
  ///     + sum_e Stiffness_e int_e sum_k |d_k|^2
  ///     + the Gauss-Newton models at c of the others, int sum (q_i(c) + dq_i(c) d)^2,
  /// s_d the spline with control points d. A model is good near c only: whoever takes the step
  /// halves it until the functionals themselves fall.
  /// @param present  c, NumFunctions x Dim.
  /// @param guess    nullptr, or a first guess of d for ConjugateGradients.
  /// @return SizeMismatch; OutsideDomain for a parameter outside; SingularSystem when a control
  /// point is determined by nothing (possible without a proximal term), or when the step is not
  /// finite; NotConverged (ConjugateGradients, on systems near singular).
  /// @complexity Direct: O(samples (p+1)^(2 Dim)) plus the factorization. ConjugateGradients: as
  /// much for the preconditioner, then O((samples + n) (p+1)^Dim) an iteration, 20 to 60 of them
  /// for usual weights; relative residual 1e-11.
  Result<PointMatrix> Step(const FitSamples<Dim>& samples, const FitWeights& weights,
    const PointMatrix& present, const PointMatrix* guess = nullptr);

  /// Iterations of the last step; 0 for Direct.
  int Iterations() const { return this->Equations->Iterations(); }

private:
  SplineSpacePtr<Dim> Space;
  std::unique_ptr<FitEquations<Dim>> Equations;
};
}
