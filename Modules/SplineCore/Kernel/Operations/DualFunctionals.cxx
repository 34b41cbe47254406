// SPDX-License-Identifier: BSD-3-Clause
#include "DualFunctionals.h"

#include "Bernstein.h"
#include "Quadrature.h"

#include <Eigen/LU>
#include <Eigen/QR>

#include <limits>

namespace knotwork
{
/// Least squares on p + 1 or more Gauss points is the L2 projection, as the rule is exact for
/// products of two polynomials of degree p; by QR it loses only the root of the condition of the
/// Gram matrix (9e4 for degree 9).
PointMatrix GaussToBernstein(int degree, int points)
{
  const QuadratureRule rule = GaussLegendre(points);
  const Eigen::VectorXd roots =
    Eigen::Map<const Eigen::VectorXd>(rule.Weights.data(), points).cwiseSqrt();
  PointMatrix basis(points, degree + 1);
  for (Eigen::Index q = 0; q < points; ++q)
  {
    BernsteinValues(degree, rule.Nodes[static_cast<std::size_t>(q)], basis.row(q).data());
  }
  const Eigen::MatrixXd weighted = roots.asDiagonal() * basis;
  return weighted.householderQr().solve(Eigen::MatrixXd(roots.asDiagonal()));
}

template <int Dim>
DualFunctionals<Dim>::DualFunctionals(const SplineSpace<Dim>& space)
  : Space(space), InverseData(space.FactorData.size(), 0.0), SumData(space.FactorData.size(), 0.0)
{
  std::vector<char> done(space.FactorData.size(), 0);
  for (const auto& element : space.Elements)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      if (element.Factor[d] < 0 || done[static_cast<std::size_t>(element.Factor[d])])
      {
        continue;
      }
      done[static_cast<std::size_t>(element.Factor[d])] = 1;
      const int size = element.Degree[d] + 1;
      const PointMatrix inverse =
        Eigen::Map<const PointMatrix>(space.FactorData.data() + element.Factor[d], size, size)
          .partialPivLu()
          .inverse();
      Eigen::Map<Eigen::RowVectorXd> sums(this->SumData.data() + element.Factor[d], size);
      if (inverse.allFinite())
      {
        Eigen::Map<PointMatrix>(this->InverseData.data() + element.Factor[d], size, size) = inverse;
        sums = inverse.cwiseAbs().colwise().sum();
      }
      else
      {
        sums.setConstant(std::numeric_limits<double>::infinity());
      }
    }
  }
}

template <int Dim>
double DualFunctionals<Dim>::Amplification(int e, int local) const
{
  const auto index =
    TensorIndex<Dim>(this->Space.Elements[static_cast<std::size_t>(e)].Degree, local);
  double amplification = 1.0;
  for (int d = 0; d < Dim; ++d)
  {
    const int f = this->Offset(e, d);
    if (f >= 0)
    {
      amplification *=
        this->SumData[static_cast<std::size_t>(f + index[static_cast<std::size_t>(d)])];
    }
  }
  return amplification;
}

template <int Dim>
void DualFunctionals<Dim>::Functional(int e, int local, double* row) const
{
  const auto& degree = this->Space.Elements[static_cast<std::size_t>(e)].Degree;
  const auto index = TensorIndex<Dim>(degree, local);
  row[0] = 1.0;
  int filled = 1;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    const double* inverse = this->Inverse(e, static_cast<int>(d));
    const int size = degree[d] + 1;
    for (int k = size - 1; k >= 0; --k) // downwards: block 0 is the source of all others
    {
      const double share = inverse ? inverse[k * size + index[d]] : (k == index[d] ? 1.0 : 0.0);
      for (int j = 0; j < filled; ++j)
      {
        row[k * filled + j] = share * row[j];
      }
    }
    filled *= size;
  }
}

template <int Dim>
std::vector<FunctionalSite> ChooseSites(
  const SplineSpace<Dim>& space, const DualFunctionals<Dim>& duals)
{
  std::vector<FunctionalSite> sites(static_cast<std::size_t>(space.NumFunctions));
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const int size = NumTensorFunctions<Dim>(space.Elements[static_cast<std::size_t>(e)].Degree);
    for (int i = 0; i < size; ++i)
    {
      const int function = OwnFunction(space, space.LocalFunctions(e)[i]);
      if (function < 0)
      {
        continue;
      }
      const double amplification = duals.Amplification(e, i);
      FunctionalSite& site = sites[static_cast<std::size_t>(function)];
      if (amplification <= std::numeric_limits<double>::max() &&
        (site.Element < 0 || amplification < site.Amplification))
      {
        site = { e, i, amplification };
      }
    }
  }
  return sites;
}

template class DualFunctionals<1>;
template class DualFunctionals<2>;
template class DualFunctionals<3>;
template std::vector<FunctionalSite> ChooseSites(const SplineSpace<1>&, const DualFunctionals<1>&);
template std::vector<FunctionalSite> ChooseSites(const SplineSpace<2>&, const DualFunctionals<2>&);
template std::vector<FunctionalSite> ChooseSites(const SplineSpace<3>&, const DualFunctionals<3>&);
}
