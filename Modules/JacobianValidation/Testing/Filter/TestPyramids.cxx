// SPDX-License-Identifier: BSD-3-Clause
// Pyramids of 5, 13 and 19 nodes. Oracles: differences of VTK's own points of the cells, and
// pyramids whose determinants are known by hand.
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace
{
using Points = std::vector<Eigen::Vector3d>;

constexpr int PyramidTypes[] = { VTK_PYRAMID, VTK_QUADRATIC_PYRAMID, VTK_TRIQUADRATIC_PYRAMID };

/// The pyramid over the unit square with its apex at height 1 above the middle; other nodes at
/// the middles of edges and faces as the cell has them.
Points RegularPyramid(int type)
{
  Points points = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 1 } };
  const auto mean = [&](std::initializer_list<std::size_t> corners)
  {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::size_t corner : corners)
    {
      sum += points[corner] / static_cast<double>(corners.size());
    }
    return sum;
  };
  if (type != VTK_PYRAMID)
  {
    for (const auto& [a, b] : { std::pair(0, 1), std::pair(1, 2), std::pair(2, 3), std::pair(3, 0),
           std::pair(0, 4), std::pair(1, 4), std::pair(2, 4), std::pair(3, 4) })
    {
      points.push_back(mean({ static_cast<std::size_t>(a), static_cast<std::size_t>(b) }));
    }
  }
  if (type == VTK_TRIQUADRATIC_PYRAMID)
  {
    points.push_back(mean({ 0, 1, 2, 3 }));
    for (const auto& [a, b] :
      { std::pair(0, 1), std::pair(1, 2), std::pair(2, 3), std::pair(3, 0) })
    {
      points.push_back(mean({ static_cast<std::size_t>(a), static_cast<std::size_t>(b), 4 }));
    }
    points.emplace_back(0.5, 0.5, 0.25); // where VTK has its last node
  }
  return points;
}

vtkSmartPointer<vtkUnstructuredGrid> OneCell(int type, const Points& coordinates)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<vtkIdType> ids;
  for (const Eigen::Vector3d& x : coordinates)
  {
    ids.push_back(points->InsertNextPoint(x.data()));
  }
  grid->SetPoints(points);
  grid->Allocate(1);
  grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
  return grid;
}

/// det J over (1 - w)^2 at (u, v, w) of the unit cube, w < 1: of differences of VTK's points, which
/// are exact for polynomials of degree 4. VTK's own derivatives of 13 nodes are not those of its
/// shape functions (9.1).
double QuotientBelowApex(vtkCell* cell, const std::array<double, 3>& at)
{
  const auto point = [&](const std::array<double, 3>& cube)
  {
    const double width = 1.0 - cube[2];
    const bool overPyramid = cell->GetCellType() == VTK_TRIQUADRATIC_PYRAMID;
    double vtks[3] = { cube[0], cube[1], cube[2] };
    if (overPyramid)
    {
      vtks[0] = 0.5 + (cube[0] - 0.5) * width;
      vtks[1] = 0.5 + (cube[1] - 0.5) * width;
      vtks[2] = 0.5 + 0.5 * cube[2];
    }
    int subId = 0;
    double weights[19];
    Eigen::Vector3d x;
    cell->EvaluateLocation(subId, vtks, x.data(), weights);
    return x;
  };
  constexpr double step = 0x1p-6;
  Eigen::Matrix3d jacobian;
  for (std::size_t d = 0; d < 3; ++d)
  {
    const auto moved = [&](double by)
    {
      std::array<double, 3> to = at;
      to[d] += by * step;
      return point(to);
    };
    jacobian.col(static_cast<Eigen::Index>(d)) =
      (8.0 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))) / (12.0 * step);
  }
  return jacobian.determinant() / ((1.0 - at[2]) * (1.0 - at[2]));
}

/// The same up to the apex: the quotient is a polynomial of degree 6 in w at most.
double Quotient(vtkCell* cell, double u, double v, double w)
{
  constexpr int n = 7;
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
  {
    const auto node = [](int k) { return 0.45 * (1.0 - std::cos((k + 0.5) * M_PI / n)); };
    double factor = QuotientBelowApex(cell, { u, v, node(i) });
    for (int k = 0; k < n; ++k)
    {
      factor *= k == i ? 1.0 : (w - node(k)) / (node(i) - node(k));
    }
    sum += factor;
  }
  return sum;
}

struct Verdict
{
  int Value = 0;
  bool Reversed = false;
  double Measure = 0.0;
  std::vector<std::array<double, 3>> Witnesses; ///< local parameters
};

Verdict Validate(vtkUnstructuredGrid* grid)
{
  vtkNew<vtkJacobianValidator> filter;
  filter->SetInputData(grid);
  filter->Update();
  auto* cells = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0))->GetCellData();
  Verdict verdict;
  verdict.Value = static_cast<int>(cells->GetArray("JacobianVerdict")->GetTuple1(0));
  verdict.Reversed = cells->GetArray("JacobianReversed")->GetTuple1(0) != 0.0;
  verdict.Measure = cells->GetArray("CellMeasure")->GetTuple1(0);
  auto* witnesses = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(1));
  for (vtkIdType i = 0; i < witnesses->GetNumberOfCells(); ++i)
  {
    if (witnesses->GetCellData()->GetArray("Kind")->GetTuple1(i) == 0.0)
    {
      std::array<double, 3> at{};
      witnesses->GetPointData()
        ->GetArray("LocalParameters")
        ->GetTuple(witnesses->GetCell(i)->GetPointId(0), at.data());
      verdict.Witnesses.push_back(at);
    }
  }
  return verdict;
}
}

TEST(Pyramids, KnownOnes_ExactOracle)
{
  for (const int type : PyramidTypes)
  {
    SCOPED_TRACE(type);
    const Points regular = RegularPyramid(type);
    const Verdict good = Validate(OneCell(type, regular));
    EXPECT_EQ(good.Value, 1);
    EXPECT_NEAR(good.Measure, 1.0 / 3.0, 1e-14);

    Points mirrored = regular;
    for (Eigen::Vector3d& x : mirrored)
    {
      x.z() = -x.z();
    }
    const Verdict bad = Validate(OneCell(type, mirrored));
    EXPECT_EQ(bad.Value, -1);
    EXPECT_TRUE(bad.Reversed);
    EXPECT_NEAR(bad.Measure, -1.0 / 3.0, 1e-14);

    // a corner of the base moved over the diagonal of the others: folded there, as in the square
    Points folded = regular;
    folded[2] = { 0.4, 0.4, 0.0 };
    EXPECT_EQ(Validate(OneCell(type, folded)).Value, -1);

    // an affine image, far away
    Eigen::Matrix3d affine;
    affine << 2, 1, 0, 0, 0.1, 3, -1, 5, 0.5;
    Points moved = regular;
    for (Eigen::Vector3d& x : moved)
    {
      x = (affine * x + Eigen::Vector3d(1e4, -2e5, 0.1)).eval();
    }
    const Verdict image = Validate(OneCell(type, moved));
    EXPECT_EQ(image.Value, affine.determinant() > 0.0 ? 1 : -1);
    EXPECT_NEAR(image.Measure, affine.determinant() / 3.0, 1e-9); // rounding at 2e5
  }
}

TEST(Pyramids, QuadraticEdgesStandStillAtTheApex_ExactOracle)
{
  // the node of each edge to the apex at the same height h: z = t (4 h - 1) + t^2 (2 - 4 h) along
  // it, so that z_t = 3 - 4 h at t = 1, and 4 h - 1 at t = 0: det J changes sign at 3/4 and 1/4.
  // Horizontally the nodes are at (1 - h) of the base's half sides, by the same polynomial.
  const auto lifted = [](double h)
  {
    Points points = RegularPyramid(VTK_QUADRATIC_PYRAMID);
    for (std::size_t k = 0; k < 4; ++k)
    {
      points[9 + k] = (1.0 - h) * points[k] + h * points[4];
    }
    return OneCell(VTK_QUADRATIC_PYRAMID, points);
  };
  for (const double h : { 0.26, 0.4, 0.6, 0.74 })
  {
    EXPECT_EQ(Validate(lifted(h)).Value, 1) << h;
  }
  for (const double h : { 0.2, 0.24, 0.76, 0.9 })
  {
    EXPECT_EQ(Validate(lifted(h)).Value, -1) << h;
  }
}

TEST(Pyramids, VerdictsAgreeWithVtksPoints_CrossOracle)
{
  for (const int type : PyramidTypes)
  {
    int valid = 0;
    int invalid = 0;
    for (unsigned seed = 1; seed <= 40; ++seed)
    {
      SCOPED_TRACE(testing::Message() << "type " << type << ", seed " << seed);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> real(-1.0, 1.0);
      const double noise = type == VTK_PYRAMID ? 0.6 : type == VTK_QUADRATIC_PYRAMID ? 0.15 : 0.07;
      Points points = RegularPyramid(type);
      for (Eigen::Vector3d& x : points)
      {
        x += noise * Eigen::Vector3d(real(random), real(random), real(random));
      }
      const auto grid = OneCell(type, points);
      const Verdict verdict = Validate(grid);
      ASSERT_NE(verdict.Value, 0);
      vtkNew<vtkGenericCell> cell;
      grid->GetCell(0, cell);
      double least = std::numeric_limits<double>::infinity();
      double most = -least;
      constexpr int n = 6;
      for (int i = 0; i < (n + 1) * (n + 1) * (n + 1); ++i)
      {
        const auto at = [i](int stride) { return static_cast<double>(i / stride % (n + 1)) / n; };
        const double quotient = Quotient(cell, at(1), at(n + 1), at((n + 1) * (n + 1)));
        least = std::min(least, quotient);
        most = std::max(most, quotient);
      }
      constexpr double rounding = 1e-9; // of differences over (1 - w)^2 and of interpolation
      if (verdict.Value == 1)
      {
        ++valid;
        EXPECT_GT(least, -rounding);
      }
      else if (verdict.Reversed)
      {
        EXPECT_LT(most, rounding);
      }
      else
      {
        ++invalid;
        ASSERT_FALSE(verdict.Witnesses.empty());
        const auto& at = verdict.Witnesses[0];
        EXPECT_LT(Quotient(cell, at[0], at[1], at[2]), rounding);
      }
      if (least < -rounding && most > rounding)
      {
        EXPECT_EQ(verdict.Value, -1);
      }
    }
    EXPECT_GE(valid, 10) << type;
    EXPECT_GE(invalid, 10) << type;
  }
}
