// SPDX-License-Identifier: BSD-3-Clause
// VTK cells in Bernstein form. Oracle: vtkCell::EvaluateLocation of the cells themselves.
#include <knotwork/JacobianValidation/CellsFromGrid.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

using namespace knotwork;

namespace
{
struct CellCase
{
  int Type;
  int NumPoints;
  std::array<int, 3> Degree; // for the attribute; 0: no attribute
};

/// One cell with random points.
vtkSmartPointer<vtkUnstructuredGrid> RandomCell(const CellCase& c, unsigned seed)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> random(-1.0, 1.0);
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < c.NumPoints; ++i)
  {
    ids->InsertNextId(i);
    points->InsertNextPoint(random(generator), random(generator), random(generator));
  }
  if (c.Type == VTK_VOXEL || c.Type == VTK_PIXEL) // VTK takes them as axis-aligned
  {
    for (vtkIdType i = 0; i < c.NumPoints; ++i)
    {
      points->SetPoint(i, 1.5 * (i & 1), 0.5 * (i >> 1 & 1), 0.25 * (i >> 2 & 1));
    }
  }
  grid->SetPoints(points);
  grid->Allocate(1);
  grid->InsertNextCell(c.Type, ids);
  if (c.Degree[0] > 0)
  {
    vtkNew<vtkDoubleArray> degrees;
    degrees->SetName("HigherOrderDegrees");
    degrees->SetNumberOfComponents(3);
    degrees->InsertNextTuple3(c.Degree[0], c.Degree[1], c.Degree[2]);
    grid->GetCellData()->SetHigherOrderDegrees(degrees);
  }
  return grid;
}

std::array<double, 3> RandomParameters(CellShape shape, std::mt19937_64& generator)
{
  std::uniform_real_distribution<double> random(0.0, 1.0);
  std::array<double, 3> t{};
  for (int d = 0; d < NumParameters(shape); ++d)
  {
    t[static_cast<std::size_t>(d)] = random(generator);
  }
  const int simplex = shape == CellShape::Tetrahedron           ? 3
    : shape == CellShape::Triangle || shape == CellShape::Wedge ? 2
                                                                : 0;
  const double sum = std::accumulate(t.begin(), t.begin() + simplex, 0.0);
  for (int d = 0; d < simplex && sum > 1.0; ++d)
  {
    t[static_cast<std::size_t>(d)] /= 1.25 * sum;
  }
  return t;
}

std::vector<CellCase> CellCases()
{
  std::vector<CellCase> cases{ { VTK_LINE, 2, {} }, { VTK_QUADRATIC_EDGE, 3, {} },
    { VTK_QUAD, 4, {} }, { VTK_PIXEL, 4, {} }, { VTK_QUADRATIC_LINEAR_QUAD, 6, {} },
    { VTK_QUADRATIC_QUAD, 8, {} }, { VTK_BIQUADRATIC_QUAD, 9, {} }, { VTK_HEXAHEDRON, 8, {} },
    { VTK_VOXEL, 8, {} }, { VTK_QUADRATIC_HEXAHEDRON, 20, {} },
    { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24, {} }, { VTK_TRIQUADRATIC_HEXAHEDRON, 27, {} },
    { VTK_TRIANGLE, 3, {} }, { VTK_QUADRATIC_TRIANGLE, 6, {} }, { VTK_TETRA, 4, {} },
    { VTK_QUADRATIC_TETRA, 10, {} }, { VTK_WEDGE, 6, {} }, { VTK_QUADRATIC_LINEAR_WEDGE, 12, {} },
    { VTK_QUADRATIC_WEDGE, 15, {} }, { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18, {} },
    { VTK_PYRAMID, 5, {} }, { VTK_QUADRATIC_PYRAMID, 13, {} }, { VTK_TRIQUADRATIC_PYRAMID, 19, {} },
    { VTK_LAGRANGE_QUADRILATERAL, 12, { 3, 2, 0 } }, { VTK_BEZIER_QUADRILATERAL, 12, { 3, 2, 0 } },
    { VTK_LAGRANGE_HEXAHEDRON, 24, { 1, 2, 3 } }, { VTK_BEZIER_HEXAHEDRON, 24, { 1, 2, 3 } } };
  for (int p = 1; p <= 4; ++p)
  {
    const int line = p + 1;
    const int triangle = (p + 1) * (p + 2) / 2;
    const int tetrahedron = triangle * (p + 3) / 3;
    cases.push_back({ VTK_LAGRANGE_CURVE, line, {} });
    cases.push_back({ VTK_BEZIER_CURVE, line, {} });
    cases.push_back({ VTK_LAGRANGE_TRIANGLE, triangle, {} });
    cases.push_back({ VTK_BEZIER_TRIANGLE, triangle, {} });
    cases.push_back({ VTK_LAGRANGE_TETRAHEDRON, tetrahedron, {} });
    cases.push_back({ VTK_BEZIER_TETRAHEDRON, tetrahedron, {} });
    cases.push_back({ VTK_LAGRANGE_QUADRILATERAL, line * line, {} });
    cases.push_back({ VTK_LAGRANGE_HEXAHEDRON, line * line * line, {} });
    cases.push_back({ VTK_LAGRANGE_WEDGE, triangle * line, { p, p, p } });
    cases.push_back({ VTK_BEZIER_WEDGE, triangle * line, { p, p, p } });
  }
  return cases;
}

class CellConversions : public testing::TestWithParam<CellCase>
{
};
}

TEST_P(CellConversions, GeometryIsVtksOwn_CrossOracle)
{
  const auto grid = RandomCell(GetParam(), 17);
  const auto read = ReadGridCells({ grid });
  ASSERT_TRUE(read) << read.Status.Message();
  ASSERT_EQ(read->Cells.NumCells(), 1);
  EXPECT_TRUE(read->Cells.Check()) << read->Cells.Check().Message();
  vtkNew<vtkGenericCell> cell;
  grid->GetCell(0, cell);
  std::mt19937_64 generator(5);
  std::vector<double> weights(static_cast<std::size_t>(GetParam().NumPoints));
  for (int k = 0; k < 20; ++k)
  {
    auto at = RandomParameters(read->Cells.Shapes[0], generator);
    double expected[3];
    double actual[3];
    int subId = 0;
    EvaluateCell(read->Cells, 0, at, actual);
    if (GetParam().Type == VTK_TRIQUADRATIC_PYRAMID) // VTK's parameters are those of a pyramid
    {
      at = { 0.5 + (at[0] - 0.5) * (1.0 - at[2]), 0.5 + (at[1] - 0.5) * (1.0 - at[2]),
        0.5 + 0.5 * at[2] };
    }
    cell->EvaluateLocation(subId, at.data(), expected, weights.data());
    for (int d = 0; d < 3; ++d)
    {
      // coordinates of at most 1, shape functions of at most some tens, rounding of VTK's sums
      EXPECT_NEAR(actual[d], expected[d], 1e-12) << "component " << d;
    }
  }
  // Points of a Bezier or linear cell are coefficients, with nothing lost.
  for (std::size_t k = 0; k < read->Points.size(); ++k)
  {
    if (read->Points[k] >= 0)
    {
      EXPECT_EQ(read->Cells.Block(0)[k], grid->GetPoint(read->Points[k])[0]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CellConversions, testing::ValuesIn(CellCases()),
  [](const auto& cell)
  {
    return "Type" + std::to_string(cell.param.Type) + "Points" +
      std::to_string(cell.param.NumPoints);
  });

TEST(CellsFromGrid, RoundingOfAConversionCoversIt_PropertyOracle)
{
  // The affine image of the lattice is exact in theory, so what is off is rounding.
  for (const CellCase& c :
    { CellCase{ VTK_LAGRANGE_CURVE, 7, {} }, CellCase{ VTK_LAGRANGE_CURVE, 10, {} } })
  {
    const auto grid = RandomCell(c, 1);
    const int p = c.NumPoints - 1;
    for (vtkIdType i = 0; i < c.NumPoints; ++i)
    {
      const double t = i == 0 ? 0.0 : i == 1 ? 1.0 : static_cast<double>(i - 1) / p;
      grid->GetPoints()->SetPoint(i, 1.0 + t, 0.0, 0.0);
    }
    const auto read = ReadGridCells({ grid });
    ASSERT_TRUE(read);
    ASSERT_EQ(read->Cells.Errors.size(), 1u);
    EXPECT_LT(read->Cells.Errors[0], 1e-10);
    for (int k = 0; k <= p; ++k)
    {
      const double exact = 1.0 + static_cast<double>(k) / p; // and half an ulp of the points
      EXPECT_NEAR(read->Cells.Block(0)[k], exact, read->Cells.Errors[0] + 1e-12);
    }
  }
}

TEST(CellsFromGrid, RoundingOfAConversionIsOfTheCellsSize_ExactOracle)
{
  // Offsets of a serendipity cell that are whole numbers over 64: its coefficients are over 256,
  // and known. With remainders nothing of the distance is left in the uncertainty.
  auto grid = RandomCell({ VTK_QUADRATIC_QUAD, 8, {} }, 1);
  std::mt19937_64 generator(9);
  for (const double far : { 0.0, 1e6 + 0.1, -7.3e9 })
  {
    std::array<double, 8> offsets{};
    double z = std::round(64.0 * far) / 64.0;
    for (vtkIdType i = 0; i < 8; ++i)
    {
      offsets[static_cast<std::size_t>(i)] =
        i == 0 ? 0.0 : static_cast<double>(generator() % 65) / 64.0;
      grid->GetPoints()->SetPoint(i, z + offsets[static_cast<std::size_t>(i)], 0.0, 0.0);
    }
    const auto read = ReadGridCells({ grid });
    ASSERT_TRUE(read);
    const BernsteinCells& cells = read->Cells;
    EXPECT_LT(cells.Uncertainty(0), 1e-14) << far;
    // a side's middle is 2 m - (a + b) / 2: the first row, coefficients 0, 1, 2, of points 0, 4, 1
    const double middle = 2.0 * offsets[4] - 0.5 * (offsets[0] + offsets[1]);
    const double rest = cells.Remainders.empty() ? 0.0 : cells.Remainders[1];
    EXPECT_NEAR((cells.Data[1] - z) + rest, middle, cells.Uncertainty(0)) << far;
    EXPECT_LE(std::fabs(cells.Data[1] - z - middle), 1.01 * cells.Errors[0] + 1e-14) << far;
  }
}

TEST(CellsFromGrid, HomogeneousCoefficientsSayTheirRounding_ExactOracle)
{
  const auto grid = RandomCell({ VTK_BEZIER_QUADRILATERAL, 4, { 1, 1, 0 } }, 3);
  vtkNew<vtkDoubleArray> weights;
  weights->SetName("RationalWeights");
  for (const double w : { 0.1, 1.0, 3.0, 1.0 / 3.0 })
  {
    weights->InsertNextValue(w);
  }
  grid->GetPointData()->SetRationalWeights(weights);
  const auto read = ReadGridCells({ grid });
  ASSERT_TRUE(read);
  ASSERT_TRUE(read->Cells.Rational);
  ASSERT_EQ(read->Cells.Errors.size(), 1u);
  EXPECT_GT(read->Cells.Errors[0], 0.0);
  EXPECT_LE(read->Cells.Errors[0], 3.0 * 0x1p-53);
  EXPECT_EQ(read->Cells.Uncertainty(0), 0.0); // the remainders are all of it
  weights->FillComponent(0, 2.0);             // products with 2 are exact
  EXPECT_TRUE(ReadGridCells({ grid })->Cells.Errors.empty());
  weights->FillComponent(0, 1.0);
  EXPECT_FALSE(ReadGridCells({ grid })->Cells.Rational);
}

TEST(CellsFromGrid, BadCellsAreNamed_PropertyOracle)
{
  const auto expect = [](const CellCase& c, ErrorCode code, const std::string& words)
  {
    const auto read = ReadGridCells({ RandomCell(c, 1) });
    EXPECT_EQ(read.Status.Code, code);
    EXPECT_NE(read.Status.Detail.find("cell 0"), std::string::npos) << read.Status.Detail;
    EXPECT_NE(read.Status.Detail.find(words), std::string::npos) << read.Status.Detail;
  };
  expect({ VTK_POLYGON, 5, {} }, ErrorCode::InvalidTopology, "vtkPolygon");
  expect({ VTK_LAGRANGE_TRIANGLE, 7, {} }, ErrorCode::InvalidDegree, "7 points");
  expect({ VTK_BEZIER_QUADRILATERAL, 6, { 2, 2, 0 } }, ErrorCode::InvalidDegree, "6");
  auto grid = RandomCell({ VTK_QUAD, 4, {} }, 1);
  grid->GetPoints()->SetPoint(2, NAN, 0.0, 0.0);
  EXPECT_EQ(ReadGridCells({ grid }).Status.Code, ErrorCode::NonFiniteInput);
}
