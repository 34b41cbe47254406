// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GalerkinSpace.h"

namespace knotwork
{
/// What is solved.
enum class GalerkinEquation
{
  Poisson,     ///< -div(k grad u) = f
  PlaneStress, ///< linear elasticity of a thin plate (thickness 1), in the plane
  PlaneStrain, ///< linear elasticity of a long body (per unit of its length), in the plane
  Solid        ///< linear elasticity in space
};

/// In any consistent units.
struct GalerkinMaterial
{
  double Conductivity = 1.0;  ///< Poisson: > 0
  double YoungsModulus = 1.0; ///< elasticity: > 0
  double PoissonsRatio = 0.3; ///< elasticity: in (-1, 0.5); PlaneStress: (-1, 1)
};

/// A function of the position (2 or 3 coordinates) with as many values as the solution.
using PointFunction = std::function<void(const double* x, double* values)>;
/// A function of position and outward unit normal.
using FacetFunction = std::function<void(const double* x, const double* normal, double* values)>;

/// The solution is given on facets: projected onto the functions that are not 0 there.
struct PrescribedValues
{
  std::vector<CellSide> Facets;
  int Component = -1;   ///< of the solution; -1: all
  PointFunction Values; ///< unset: 0
};

/// Flux k du/dn (Poisson) or traction on facets. A pressure p is the traction -p n.
struct FacetLoad
{
  std::vector<CellSide> Facets;
  FacetFunction Values;
};

/// An edge of an element in space: straight in its parameters, from one to another.
struct ElementEdge
{
  int Cell = -1;
  std::array<std::array<double, 3>, 2> Ends{};
};

/// A load for each length along edges of a body in space: force (elasticity) or source (Poisson).
struct EdgeLoad
{
  std::vector<ElementEdge> Edges;
  PointFunction Values;
};

/// The coefficient of a function (of Lagrange elements: the value at its node) is given.
struct PointSupport
{
  int Function = -1;
  int Component = 0;
  double Value = 0.0;
};

/// A coefficient's share of a load at a point.
struct PointLoad
{
  int Function = -1;
  int Component = 0;
  double Value = 0.0;
};

struct GalerkinProblem
{
  GalerkinEquation Equation = GalerkinEquation::Poisson;
  std::vector<GalerkinMaterial> Materials{ GalerkinMaterial{} };
  std::vector<int> MaterialIds; ///< one an element, or empty: the first for all
  PointFunction Source;         ///< f, or the force per volume; unset: 0
  std::vector<PrescribedValues> Prescribed;
  std::vector<FacetLoad> Loads;
  std::vector<EdgeLoad> EdgeLoads;
  std::vector<PointSupport> Supports;
  std::vector<PointLoad> PointLoads;
};

struct GalerkinParams
{
  /// Of quadrature on rational elements, in (0, 1).
  double QuadratureTolerance = 1e-15;
  /// Unknowns up to which the system is factorized, a tenth of it on one tensor-product volume;
  /// above, preconditioned conjugate gradients. >= 0.
  int DirectLimit = 300000;
  /// Of conjugate gradients: residual over right-hand side, in (0, 1).
  double Tolerance = 1e-12;
  int MaxIterations = 20000;   ///< of conjugate gradients, >= 1
  int MaxEntries = 2147483647; ///< of the lower triangle of the matrix, >= 1
  int Threads = 0;             ///< 0 = all cores; the result is the same for any number
};

struct GalerkinSolution
{
  PointMatrix Coefficients; ///< functions x components of the solution
  /// Forces (fluxes) that keep the prescribed coefficients, functions x components; 0 elsewhere.
  PointMatrix Reactions;
  double Energy = 0.0;           ///< half of a(u, u)
  double Potential = 0.0;        ///< Energy less the work of loads: what the solution makes least
  Eigen::VectorXd TotalLoad;     ///< sum over functions, a component each
  Eigen::VectorXd TotalReaction; ///< likewise: the load's opposite, up to rounding
  double Residual = 0.0;         ///< of the free equations, over the right-hand side
  int Unknowns = 0;
  int Iterations = 0; ///< of conjugate gradients; 0: factorized
  /// Of conjugate gradients: "fast diagonalization" on one tensor-product patch, else "Gauss-Seidel
  /// and constants of cells"; empty: factorized.
  std::string Preconditioner;
  double SecondsCertificate = 0.0;
  double SecondsAssembly = 0.0;
  double SecondsSolve = 0.0;
};

/// Solves by Galerkin's method. Callables are called from the calling thread alone.
/// @return SizeMismatch, DimensionMismatch, InvalidParameter, NonFiniteInput: what names a wrong
/// condition; InvalidTopology with the witness when an element is proved to fold;
/// SingularSystem that names the rigid motions that are left; TooLarge; NotConverged; Aborted.
/// @complexity O(elements q (p+1)^(2 Dim)) for q quadrature points, and a sparse factorization.
/// @source  Hughes, The Finite Element Method, 2000, chapters 1 to 3; Hughes, Cottrell, Bazilevs,
/// CMAME 194 (2005) 4135-4195.
Result<GalerkinSolution> SolveGalerkin(const GalerkinSpace& space, const GalerkinProblem& problem,
  const GalerkinParams& params = {}, const ProgressCallback& progress = {});

/// The solution at a point of an element.
struct GalerkinPoint
{
  Eigen::VectorXd Position;
  Eigen::VectorXd Value;    ///< a row a component
  Eigen::MatrixXd Gradient; ///< components x dimension
  /// Elasticity: 3 x 3, with the stress across the plane; else empty.
  Eigen::MatrixXd Stress;
};
/// @param u  local parameters.
GalerkinPoint EvaluateSolution(const GalerkinSpace& space, const GalerkinProblem& problem,
  const PointMatrixView& coefficients, int element, const double* u);

/// Of elasticity, with the stress across the plane. @param gradient  of displacements, components x
/// dimension.
Eigen::Matrix3d ElasticStress(
  const GalerkinProblem& problem, int element, const Eigen::Ref<const Eigen::MatrixXd>& gradient);

/// Half of the density of a(u, u). @param gradient  of the solution, components x dimension.
double EnergyDensity(
  const GalerkinProblem& problem, int element, const Eigen::Ref<const Eigen::MatrixXd>& gradient);

/// sqrt(3/2) of the norm of the deviator of a 3 x 3 stress.
double VonMisesStress(const Eigen::Matrix3d& stress);

/// Exact solution to compare with.
struct ErrorNorms
{
  double L2 = 0.0;
  double H1 = 0.0; ///< of the gradient alone
};
/// @param gradient  fills components x dimension, by rows. @param extraPoints  Gauss points a
/// direction beyond those of the matrix, >= 0.
ErrorNorms SolutionError(const GalerkinSpace& space, const PointMatrixView& coefficients,
  const PointFunction& exact, const PointFunction& gradient, int extraPoints = 2);
}
