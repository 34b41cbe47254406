// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/HierarchicalSpace.h>

#include <Eigen/QR>

#include <algorithm>
#include <vector>

namespace knotwork::testing
{
/// What MakeHierarchicalSpace takes.
template <int Dim>
struct HierarchyProblem
{
  std::array<KnotVector, Dim> Knots;
  std::vector<HierarchyBox<Dim>> Boxes;
};

/// The definition of the truncated basis, word by word, in the tensor-product basis of the finest
/// level: dense matrices, grids of all cells of all levels, knot vectors by repeated halving.
template <int Dim>
class DenseHierarchy
{
public:
  explicit DenseHierarchy(const HierarchyProblem<Dim>& problem)
  {
    int levels = 1;
    for (const auto& box : problem.Boxes)
    {
      levels = std::max(levels, box.Level + 1);
    }
    this->Knots.push_back(problem.Knots);
    for (int l = 1; l < levels; ++l)
    {
      this->Knots.push_back(this->Knots.back());
      for (auto& k : this->Knots.back())
      {
        k = k.Dyadic();
      }
    }
    for (int l = 0; l < levels; ++l)
    {
      std::vector<bool> omega(this->Count(l, true), l == 0);
      for (std::size_t c = 0; l > 0 && c < omega.size(); ++c)
      {
        omega[c] = this->IsRefinedTo(problem, l, this->MultiIndex(l, true, c));
      }
      this->Omega.push_back(omega);
    }
    for (int l = 0; l < levels; ++l)
    {
      for (std::size_t f = 0; f < this->Count(l, false); ++f)
      {
        if (this->IsInside(l, f, l) && !(l + 1 < levels && this->IsInside(l, f, l + 1)))
        {
          this->Level.push_back(l);
          this->Index.push_back(this->MultiIndex(l, false, f));
          this->Columns.push_back(this->Truncate(l, f));
        }
      }
    }
  }

  /// Values of all active truncated functions.
  Eigen::VectorXd Values(const RealArray<Dim>& u) const
  {
    const int finest = static_cast<int>(this->Knots.size()) - 1;
    Eigen::VectorXd basis = Eigen::VectorXd::Zero(this->Count(finest, false));
    std::array<Eigen::VectorXd, Dim> values;
    for (int d = 0; d < Dim; ++d)
    {
      const KnotVector& k = this->Knots[finest][d];
      double alive[MaxDegree + 1];
      const int e = k.FindElement(u[d]);
      k.EvaluateFunctions(e, u[d], 0, alive);
      values[d] = Eigen::VectorXd::Zero(k.NumFunctions());
      for (int i = 0; i <= k.Degree(); ++i)
      {
        values[d][k.Span(e) - k.Degree() + i] = alive[i];
      }
    }
    for (Eigen::Index f = 0; f < basis.size(); ++f)
    {
      const auto index = this->MultiIndex(finest, false, static_cast<std::size_t>(f));
      basis[f] = 1.0;
      for (int d = 0; d < Dim; ++d)
      {
        basis[f] *= values[d][index[d]];
      }
    }
    Eigen::VectorXd result(this->Columns.size());
    for (std::size_t i = 0; i < this->Columns.size(); ++i)
    {
      result[static_cast<Eigen::Index>(i)] = this->Columns[i].dot(basis);
    }
    return result;
  }

  std::vector<int> Level;
  std::vector<std::array<std::int64_t, Dim>> Index;

private:
  int Size(int level, bool cells, int d) const
  {
    const KnotVector& k = this->Knots[level][d];
    return cells ? k.NumElements() : k.NumFunctions();
  }
  std::size_t Count(int level, bool cells) const
  {
    std::size_t n = 1;
    for (int d = 0; d < Dim; ++d)
    {
      n *= static_cast<std::size_t>(this->Size(level, cells, d));
    }
    return n;
  }
  std::array<std::int64_t, Dim> MultiIndex(int level, bool cells, std::size_t linear) const
  {
    std::array<std::int64_t, Dim> index;
    for (int d = 0; d < Dim; ++d)
    {
      const std::size_t n = static_cast<std::size_t>(this->Size(level, cells, d));
      index[d] = static_cast<std::int64_t>(linear % n);
      linear /= n;
    }
    return index;
  }
  /// A cell of this level is in Omega^level when its parent meets a box of this level, or an
  /// ancestor relation makes it necessary: a box of a finer level meets the parent.
  static bool IsRefinedTo(
    const HierarchyProblem<Dim>& problem, int level, const std::array<std::int64_t, Dim>& cell)
  {
    return std::any_of(problem.Boxes.begin(), problem.Boxes.end(),
      [&](const HierarchyBox<Dim>& box)
      {
        bool meets = box.Level >= level;
        for (int d = 0; meets && d < Dim; ++d)
        {
          const std::int64_t parent = cell[d] / 2, parts = std::int64_t(2) << (box.Level - level);
          meets = parent * parts < box.Upper[d] && (parent + 1) * parts > box.Lower[d];
        }
        return meets;
      });
  }
  /// The support (within the domain) lies inside Omega^omega, omega = level or level + 1.
  bool IsInside(int level, std::size_t function, int omega) const
  {
    const auto index = this->MultiIndex(level, false, function);
    const int shift = omega - level;
    for (std::size_t c = 0; c < this->Omega[omega].size(); ++c)
    {
      const auto cell = this->MultiIndex(omega, true, c);
      bool inSupport = true;
      for (int d = 0; d < Dim; ++d)
      {
        const auto support = this->Knots[level][d].Support(static_cast<int>(index[d]));
        inSupport = inSupport && cell[d] >> shift >= support[0] && cell[d] >> shift <= support[1];
      }
      if (inSupport && !this->Omega[omega][c])
      {
        return false;
      }
    }
    return true;
  }
  /// Two-scale matrix (fine x coarse) of one direction by interpolation: no knot insertion.
  static Eigen::MatrixXd TwoScale(const KnotVector& coarse, const KnotVector& fine)
  {
    const int p = coarse.Degree(), points = p + 1;
    const int rows = points * fine.NumElements();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, fine.NumFunctions());
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(rows, coarse.NumFunctions());
    for (int r = 0; r < rows; ++r)
    {
      const int e = r / points;
      const double t = (r % points + 0.5) / points;
      const double u = (1.0 - t) * fine.Breaks()[e] + t * fine.Breaks()[e + 1];
      double values[MaxDegree + 1];
      fine.EvaluateFunctions(e, u, 0, values);
      for (int i = 0; i <= p; ++i)
      {
        a(r, fine.Span(e) - p + i) = values[i];
      }
      coarse.EvaluateFunctions(e / 2, u, 0, values);
      for (int i = 0; i <= p; ++i)
      {
        b(r, coarse.Span(e / 2) - p + i) = values[i];
      }
    }
    return a.colPivHouseholderQr().solve(b);
  }
  Eigen::VectorXd Truncate(int level, std::size_t function) const
  {
    Eigen::VectorXd c = Eigen::VectorXd::Unit(
      static_cast<Eigen::Index>(this->Count(level, false)), static_cast<Eigen::Index>(function));
    for (int l = level + 1; l < static_cast<int>(this->Knots.size()); ++l)
    {
      c = this->RefineOnce(l, c);
      for (Eigen::Index f = 0; f < c.size(); ++f)
      {
        if (c[f] != 0.0 && this->IsInside(l, static_cast<std::size_t>(f), l))
        {
          c[f] = 0.0;
        }
      }
    }
    return c;
  }
  Eigen::VectorXd RefineOnce(int level, const Eigen::VectorXd& coarse) const
  {
    while (static_cast<int>(this->Scales.size()) < level)
    {
      const std::size_t l = this->Scales.size();
      std::array<Eigen::MatrixXd, Dim> scale;
      for (int d = 0; d < Dim; ++d)
      {
        scale[d] = TwoScale(this->Knots[l][d], this->Knots[l + 1][d]);
      }
      this->Scales.push_back(scale);
    }
    Eigen::VectorXd c = coarse;
    Eigen::Index before = 1, after = c.size();
    for (int d = 0; d < Dim; ++d)
    {
      const Eigen::MatrixXd& r = this->Scales[level - 1][d];
      after /= r.cols();
      Eigen::VectorXd next = Eigen::VectorXd::Zero(before * r.rows() * after);
      for (Eigen::Index k = 0; k < after; ++k)
      {
        Eigen::Map<const Eigen::MatrixXd> in(c.data() + k * before * r.cols(), before, r.cols());
        Eigen::Map<Eigen::MatrixXd>(next.data() + k * before * r.rows(), before, r.rows()) =
          in * r.transpose();
      }
      c = next;
      before *= r.rows();
    }
    return c;
  }

  std::vector<std::array<KnotVector, Dim>> Knots;
  std::vector<std::vector<bool>> Omega;
  std::vector<Eigen::VectorXd> Columns;
  mutable std::vector<std::array<Eigen::MatrixXd, Dim>> Scales;
};
}
