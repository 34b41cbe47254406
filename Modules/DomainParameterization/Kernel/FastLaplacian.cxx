// SPDX-License-Identifier: BSD-3-Clause
#include "FastLaplacian.h"

#include <knotwork/SplineCore/TensorLaplacian.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace knotwork
{
template <int Dim>
FastLaplacian<Dim>::FastLaplacian(const std::array<KnotVector, Dim>& knots)
{
  std::vector<Eigen::MatrixXd> masses;
  std::vector<Eigen::MatrixXd> stiffnesses;
  for (const KnotVector& line : knots)
  {
    const Eigen::Index n = std::max(0, line.NumFunctions() - 2);
    const LineIntegrals integrals = IntegrateLine(line);
    masses.emplace_back(integrals.Mass.block(1, 1, n, n));
    stiffnesses.emplace_back(integrals.Stiffness.block(1, 1, n, n));
  }
  TensorModes found = FindTensorModes(masses, stiffnesses);
  this->Modes = std::move(found.Modes);
  this->Inverse = found.Sums.cwiseInverse();
  this->Temporary.resize(this->Inverse.size());
}

template <int Dim>
void FastLaplacian<Dim>::Apply(Eigen::VectorXd& planes)
{
  const Eigen::Index size = this->Size();
  if (size == 0)
  {
    return;
  }
  const auto multiply = [&](Eigen::Map<Eigen::VectorXd> plane, bool transposed)
  {
    Eigen::Index inner = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const Eigen::MatrixXd& modes = this->Modes[d];
      const Eigen::Index n = modes.rows();
      if (d == 0)
      {
        Eigen::Map<Eigen::MatrixXd> all(plane.data(), n, size / n);
        Eigen::Map<Eigen::MatrixXd> to(this->Temporary.data(), n, size / n);
        if (transposed)
        {
          to.noalias() = modes.transpose() * all;
        }
        else
        {
          to.noalias() = modes * all;
        }
      }
      else
      {
        for (Eigen::Index k = 0; k < size / (inner * n); ++k)
        {
          Eigen::Map<Eigen::MatrixXd> all(plane.data() + k * inner * n, inner, n);
          Eigen::Map<Eigen::MatrixXd> to(this->Temporary.data() + k * inner * n, inner, n);
          if (transposed)
          {
            to.noalias() = all * modes;
          }
          else
          {
            to.noalias() = all * modes.transpose();
          }
        }
      }
      plane = this->Temporary;
      inner *= n;
    }
  };
  for (Eigen::Index first = 0; first < planes.size(); first += size)
  {
    Eigen::Map<Eigen::VectorXd> plane(planes.data() + first, size);
    multiply(plane, true);
    plane.array() *= this->Inverse.array();
    multiply(plane, false);
  }
}

template class FastLaplacian<2>;
template class FastLaplacian<3>;
}
