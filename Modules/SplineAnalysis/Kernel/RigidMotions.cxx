// SPDX-License-Identifier: BSD-3-Clause
#include "RigidMotions.h"

#include "StiffnessMatrix.h"
#include <knotwork/SplineCore/DisjointSets.h>

#include <Eigen/Eigenvalues>

#include <map>
#include <string>

namespace knotwork
{
namespace
{
constexpr const char* Axes[] = { "x", "y", "z" };

/// A motion a column, values of one coefficient a row: translations, then rotations about the
/// centre. Coefficients of a rotation are those of the points, since functions make both.
Eigen::MatrixXd MotionsAt(const Eigen::VectorXd& offset, int components)
{
  const int rotations = components == 1 ? 0 : components == 2 ? 1 : 3;
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(components, components + rotations);
  motions.leftCols(components).setIdentity();
  if (components == 2)
  {
    motions.col(2) << -offset[1], offset[0];
  }
  if (components == 3)
  {
    motions.col(3) << 0.0, -offset[2], offset[1];
    motions.col(4) << offset[2], 0.0, -offset[0];
    motions.col(5) << -offset[1], offset[0], 0.0;
  }
  return motions;
}

/// Names of motions that span the kernel, a column each.
std::string NameMotions(Eigen::MatrixXd kernel, int components)
{
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (int c = 0; c < components; ++c)
  {
    // the unit vector lies in the kernel when its projection has length one
    if (kernel.row(c).norm() > 1.0 - 1e-6)
    {
      add(components == 1 ? "the constant" : std::string("translation along ") + Axes[c]);
    }
  }
  const Eigen::Index turns = kernel.rows() - components;
  if (turns > 0)
  {
    const Eigen::MatrixXd part = kernel.bottomRows(turns);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(part * part.transpose());
    for (Eigen::Index k = 0; k < turns; ++k)
    {
      if (axes.eigenvalues()[k] > 1e-9)
      {
        Eigen::Index largest = 0;
        const Eigen::VectorXd axis = axes.eigenvectors().col(k);
        axis.cwiseAbs().maxCoeff(&largest);
        if (components == 2)
        {
          add("rotation in the plane");
        }
        else if (std::abs(axis[largest]) > 1.0 - 1e-6)
        {
          add(std::string("rotation about ") + Axes[largest]);
        }
        else
        {
          add("rotation about (" + std::to_string(axis[0]) + ", " + std::to_string(axis[1]) + ", " +
            std::to_string(axis[2]) + ")");
        }
      }
    }
  }
  return names.empty() ? "a translation along no axis" : names;
}
}

Status CheckRigidMotions(
  const GalerkinSpace& space, GalerkinEquation equation, const std::vector<char>& isGiven)
{
  const int components = NumSolutionComponents(equation);
  DisjointSets parts(space.NumFunctions());
  std::map<int, int> elementOf;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    for (int a = 1; a < space.NumAlive(e); ++a)
    {
      parts.Unite(space.Alive(e)[0], space.Alive(e)[a]);
    }
  }
  for (int e = 0; e < space.NumElements(); ++e)
  {
    elementOf.emplace(parts.Find(space.Alive(e)[0]), e);
  }
  for (const auto& part : elementOf)
  {
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(space.Dimension);
    std::vector<int> functions;
    for (int f = 0; f < space.NumFunctions(); ++f)
    {
      if (parts.Find(f) == part.first)
      {
        functions.push_back(f);
        centre += space.Points.row(f).transpose();
      }
    }
    centre /= static_cast<double>(functions.size());
    double size = 0.0;
    for (const int f : functions)
    {
      size = std::max(size, (space.Points.row(f).transpose() - centre).norm());
    }
    const Eigen::Index modes = MotionsAt(centre, components).cols();
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(modes, modes);
    for (const int f : functions)
    {
      const Eigen::MatrixXd motions =
        MotionsAt((space.Points.row(f).transpose() - centre) / size, components);
      for (int c = 0; c < components; ++c)
      {
        if (isGiven[static_cast<std::size_t>(f * components + c)])
        {
          gram += motions.row(c).transpose() * motions.row(c);
        }
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> system(gram);
    Eigen::Index free = 0;
    while (free < modes && system.eigenvalues()[free] <= 1e-12)
    {
      ++free;
    }
    if (free > 0)
    {
      return { ErrorCode::SingularSystem,
        "the part with element " + std::to_string(part.second) + " is not held against " +
          NameMotions(system.eigenvectors().leftCols(free), components) +
          "; prescribe values or supports that prevent it" };
    }
  }
  return {};
}
}
