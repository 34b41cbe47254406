// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/DomainParameterization/DomainEnergy.h>
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/GluedMap.h>
#include <knotwork/DomainParameterization/Minimize.h>
#include <knotwork/DomainParameterization/WorkBudget.h>

namespace knotwork
{
/// The stages of an optimization on one space: holds the map, moves its free control points and
/// weights, keeps the history.
template <int Dim>
class DomainSolver
{
public:
  /// @param map  polynomial or rational, the boundary set; its fixed functions are never changed.
  /// @param area  S > 0, a patch.
  /// @param budget  what evaluations cost is taken from it; minimizations end when it is used up.
  DomainSolver(
    const GluedMap<Dim>& map, double area, const DomainParams& params, WorkBudget& budget);

  const GluedMap<Dim>& Map() const { return this->Current; }
  /// @pre the spaces and numbers are those of the first map.
  void SetMap(const GluedMap<Dim>& map);

  /// Gauss points a direction: degree + 1 + extra[e] on element e (patch after patch); the rows and
  /// columns of such elements get them too on tensor-product spaces.
  void SetQuadrature(const std::vector<int>& extra);

  /// At the quadrature points, over S.
  double MinDet();
  double Energy();

  /// @return true when det J > 0 at all quadrature points afterwards.
  bool RemoveFolds();
  /// Minimizes the quality functional in the control points. @pre MinDet() > 0
  void ImprovePoints();
  /// The same in the logarithms of the inner weights (all 1 when the map was polynomial).
  void ImproveWeights();
  /// RemoveFolds in control points and weights, in turn.
  bool RemoveFoldsWithWeights();
  /// Minimizes int (det J)^-power, which for large powers is the largest least det J, and a little
  /// of the quality functional. @pre MinDet() > 0
  void RaiseLeastJacobian(double power);

  std::vector<DomainIteration> History;
  int Iterations = 0;
  int Evaluations = 0;

private:
  bool UnfoldRelu(int rounds, int iterations);
  bool UnfoldPenalty();
  void Gather(Eigen::VectorXd& free) const;
  void Scatter(const Eigen::VectorXd& free);
  void Publish();
  EnergyValue Evaluate(const Density& density, double* gradient, double* weightGradient);
  void Minimize(
    DomainStage stage, const Density& density, const MinimizeParams& params, double stopAtMinDet);
  void MinimizeQuality(DomainStage stage, const Density& density);
  void MakeRational();

  const DomainParams& Params;
  WorkBudget& Budget;
  double Cost = 0.0; ///< of an evaluation, in the unit of WorkBudget::Spend
  GluedMap<Dim> Current;
  int NumFunctions;
  double Scale;
  Eigen::Matrix<double, 1, Dim> Center;
  std::vector<int> NumPoints;                 ///< Gauss points a direction of each element
  std::vector<int> Free;                      ///< functions that may move
  std::vector<double> Planes, PlaneGradients; ///< scaled control points
  std::vector<double> Weights, WeightGradients;
  std::unique_ptr<DomainEnergy<Dim>> Functional;
  Preconditioner Precondition;
};
}
