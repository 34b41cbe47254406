// SPDX-License-Identifier: BSD-3-Clause
#include "HeatFlow.h"

#include "MeshWeights.h"
#include "SparseCholesky.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
Status FlowHeat(const DiscMesh& mesh, const std::vector<char>& held, double time, int steps,
  Eigen::VectorXd& values)
{
  std::vector<int> number;
  int unknowns = 0;
  for (char h : held)
  {
    number.push_back(h ? -1 : unknowns++);
  }
  if (unknowns == 0)
  {
    return {};
  }
  const bool steady = !std::isfinite(time);
  const double scale = steady ? 1.0 : time;
  const Eigen::VectorXd masses =
    steady ? Eigen::VectorXd(Eigen::VectorXd::Zero(mesh.NumPoints())) : VertexAreas(mesh);
  const Eigen::SparseMatrix<double> laplacian = CotangentLaplacian(mesh);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd ofHeld = Eigen::VectorXd::Zero(unknowns); // what held values add to the right
  for (int column = 0; column < mesh.NumPoints(); ++column)
  {
    const int q = number[static_cast<std::size_t>(column)];
    for (Eigen::SparseMatrix<double>::InnerIterator at(laplacian, column); at; ++at)
    {
      const auto row = static_cast<int>(at.row());
      const int p = number[static_cast<std::size_t>(row)];
      const double value = scale * at.value() + (row == column ? masses[row] : 0.0);
      if (p >= 0 && q >= 0)
      {
        entries.emplace_back(std::max(p, q), std::min(p, q), value);
      }
      else if (p >= 0)
      {
        ofHeld[p] -= value * values[column];
      }
      else if (q >= 0)
      {
        ofHeld[q] -= value * values[row];
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  SparseCholesky factor;
  if (Status status = factor.Factorize(matrix); !status)
  {
    return status;
  }
  for (int step = 0; step < steps; ++step)
  {
    Eigen::MatrixXd side = ofHeld;
    for (std::size_t v = 0; v < number.size(); ++v)
    {
      const auto at = static_cast<Eigen::Index>(v);
      if (number[v] >= 0)
      {
        side(number[v], 0) += masses[at] * values[at];
      }
    }
    factor.Solve(side);
    for (std::size_t v = 0; v < number.size(); ++v)
    {
      if (number[v] >= 0)
      {
        values[static_cast<Eigen::Index>(v)] = side(number[v], 0);
      }
    }
  }
  return {};
}
}
