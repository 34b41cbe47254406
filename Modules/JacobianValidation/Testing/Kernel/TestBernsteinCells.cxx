// SPDX-License-Identifier: BSD-3-Clause
#include "JacobianCorpus.h"
#include "RandomSplines.h"

#include <gtest/gtest.h>

#include <limits>

namespace knotwork
{
namespace
{
TEST(BernsteinCells, OrderOfCoefficientsIsDocumented_GoldenOracle)
{
  EXPECT_EQ(NumCellCoefficients(CellShape::Curve, { 3, 0, 0 }), 4);
  EXPECT_EQ(NumCellCoefficients(CellShape::Quadrilateral, { 3, 2, 0 }), 12);
  EXPECT_EQ(NumCellCoefficients(CellShape::Hexahedron, { 1, 2, 3 }), 24);
  EXPECT_EQ(NumCellCoefficients(CellShape::Triangle, { 2, 2, 0 }), 6);
  EXPECT_EQ(NumCellCoefficients(CellShape::Tetrahedron, { 2, 2, 2 }), 10);
  EXPECT_EQ(NumCellCoefficients(CellShape::Wedge, { 2, 2, 1 }), 12);
  EXPECT_EQ(CellCoefficient(CellShape::Triangle, { 2, 2, 0 }, 1, 1, 0), 4);    // after the row of 3
  EXPECT_EQ(CellCoefficient(CellShape::Tetrahedron, { 2, 2, 2 }, 0, 1, 1), 8); // 6 below, row of 2
  EXPECT_EQ(CellCoefficient(CellShape::Wedge, { 2, 2, 1 }, 0, 2, 1), 11);
}

TEST(BernsteinCells, CoefficientsOfAShapeAreNumberedOnce_PropertyOracle)
{
  for (int s = 0; s < NumCellShapes; ++s)
  {
    const CellShape shape = static_cast<CellShape>(s);
    const CellDegree degree = corpus::DegreeOf(shape, 4, 3, 2);
    std::vector<int> seen;
    for (int k = 0; k <= degree[2]; ++k)
    {
      for (int j = 0; j <= degree[1]; ++j)
      {
        for (int i = 0; i <= degree[0]; ++i)
        {
          const bool triangle = shape == CellShape::Triangle || shape == CellShape::Wedge;
          const bool tetrahedron = shape == CellShape::Tetrahedron;
          if ((triangle && i + j > 4) || (tetrahedron && i + j + k > 4))
          {
            continue;
          }
          seen.push_back(CellCoefficient(shape, degree, i, j, k));
        }
      }
    }
    ASSERT_EQ(static_cast<int>(seen.size()), NumCellCoefficients(shape, degree));
    for (std::size_t k = 0; k < seen.size(); ++k)
    {
      EXPECT_EQ(seen[k], static_cast<int>(k));
    }
  }
}

TEST(BernsteinCells, CellsOfAFormAreItsBlocks_CrossOracle)
{
  oracle::Random random(3);
  const auto space = testing::RandomHierarchicalSpace<2>(random, 3, 4, 2);
  const auto form = MakeBezierForm(testing::RandomSpline<2>(random, space, 2, true));
  const BernsteinCells cells = MakeBernsteinCells(form);
  EXPECT_TRUE(cells.Check()) << cells.Check().Message();
  ASSERT_EQ(cells.NumCells(), space->NumElements());
  EXPECT_EQ(cells.Data, form.Data);
  EXPECT_EQ(cells.Degrees[0][1], space->Elements[0].Degree[1]);
  EXPECT_EQ(cells.Shapes[0], CellShape::Quadrilateral);
}

TEST(BernsteinCells, DamageIsNamed)
{
  BernsteinCells good;
  good.NumComponents = 2;
  good.Rational = true;
  good.Add(CellShape::Triangle, { 1, 1, 0 });
  std::fill(good.Data.begin(), good.Data.end(), 1.0);
  ASSERT_TRUE(good.Check());
  BernsteinCells bad = good;
  bad.Data.pop_back();
  EXPECT_EQ(bad.Check().Code, ErrorCode::SizeMismatch);
  bad = good;
  bad.Degrees[0] = { 1, 2, 0 };
  EXPECT_EQ(bad.Check().Code, ErrorCode::InvalidDegree);
  bad = good;
  bad.Data[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(bad.Check().Code, ErrorCode::NonFiniteInput);
  bad = good;
  bad.Data.back() = 0.0;
  EXPECT_EQ(bad.Check().Code, ErrorCode::InvalidWeight);
  bad = good;
  bad.Errors = { -1.0 };
  EXPECT_EQ(bad.Check().Code, ErrorCode::NonFiniteInput);
}
}
}
