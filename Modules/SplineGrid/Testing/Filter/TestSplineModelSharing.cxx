// SPDX-License-Identifier: BSD-3-Clause
// Points are shared by topology, and the order of points is VTK's.
#include "RandomModels.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HierarchicalSpace.h>
#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkBezierCurve.h"
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

#include <cmath>
#include <limits>
#include <random>

using namespace knotwork;

namespace
{
template <int Dim>
vtkIdType NumPoints(const SplineSpacePtr<Dim>& space)
{
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Geometry = Spline<Dim>{ space, PointMatrix::Random(space->NumFunctions, 3), {} };
  return Encode(model)->GetNumberOfPoints();
}

TEST(SplineModelSharing, TensorGrids_GoldenOracle)
{
  // n elements of degree p in a row have n p + 1 points.
  const KnotVector cubic = KnotVector::Uniform(3, 4);
  const KnotVector quadratic = KnotVector::Uniform(2, 5, 0, 1, 2); // C^0 still shares
  EXPECT_EQ(NumPoints<1>(MakeTensorSpace<1>({ cubic }).Value), 13);
  EXPECT_EQ(NumPoints<2>(MakeTensorSpace<2>({ cubic, quadratic }).Value), 13 * 11);
  EXPECT_EQ(NumPoints<3>(MakeTensorSpace<3>({ cubic, quadratic, cubic }).Value), 13 * 11 * 13);
  // A jump at every one of the 4 inner breaks doubles their points.
  const KnotVector broken = KnotVector::Uniform(2, 5, 0, 1, 3);
  EXPECT_EQ(NumPoints<1>(MakeTensorSpace<1>({ broken }).Value), 15);
  EXPECT_EQ(NumPoints<2>(MakeTensorSpace<2>({ cubic, broken }).Value), 13 * 15);
}

TEST(SplineModelSharing, LevelsShareNothingWithEachOther_GoldenOracle)
{
  // 2 x 2 bilinear cells, one of them in four. Level 0: the 3 x 3 lattice without the corner of the
  // refined cell; level 1: another 3 x 3 lattice.
  const std::array<KnotVector, 2> knots{ KnotVector::Uniform(1, 2), KnotVector::Uniform(1, 2) };
  const auto space = MakeHierarchicalSpace<2>(knots, { { 1, { 0, 0 }, { 2, 2 } } });
  ASSERT_TRUE(space) << space.Status.Message();
  EXPECT_EQ(NumPoints<2>(space.Value), 8 + 9);
  // Two refined cells that touch in a corner share that point.
  const auto diagonal =
    MakeHierarchicalSpace<2>(knots, { { 1, { 0, 0 }, { 2, 2 } }, { 1, { 2, 2 }, { 4, 4 } } });
  ASSERT_TRUE(diagonal) << diagonal.Status.Message();
  EXPECT_EQ(NumPoints<2>(diagonal.Value), 7 + 17);
}

TEST(SplineModelSharing, CollapsedEdgeKeepsItsPoints_GoldenOracle)
{
  // All control points of one edge are equal: by coordinates they would be one.
  const auto space =
    MakeTensorSpace<2>({ KnotVector::Uniform(2, 2), KnotVector::Uniform(2, 2) }).Value;
  Spline<2> spline{ space, PointMatrix::Random(16, 3), Eigen::VectorXd::LinSpaced(16, 1, 2) };
  for (int i = 0; i < 4; ++i)
  {
    spline.ControlPoints.row(i).setZero();
  }
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Geometry = spline;
  const auto grid = Encode(model);
  EXPECT_EQ(grid->GetNumberOfPoints(), 25);
  EXPECT_TRUE(Identical(model, Decode(grid)));
}

// VTK's own cells evaluate to the values of the kernel: order of points, degrees and weights agree.
class SplineModelCells : public ::testing::TestWithParam<ModelCase>
{
};

template <int Dim>
void CheckCells(vtkUnstructuredGrid* grid, const SplinePatch& patch)
{
  const auto form = MakeBezierForm(std::get<Spline<Dim>>(patch.Geometry));
  std::mt19937 random(7);
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    PointMatrix local(1, Dim);
    double pcoords[3] = { 0, 0, 0 };
    for (int d = 0; d < Dim; ++d)
    {
      pcoords[d] = local(0, d) = random() / 4294967296.0;
    }
    EvaluationBatch batch;
    ASSERT_TRUE(EvaluateElements(form, { e }, local, {}, batch));
    vtkCell* cell = grid->GetCell(patch.Cells[static_cast<std::size_t>(e)]);
    int subId = 0;
    double x[3];
    std::vector<double> weights(static_cast<std::size_t>(cell->GetNumberOfPoints()));
    cell->EvaluateLocation(subId, pcoords, x, weights.data());
    const double tolerance = 64 * std::numeric_limits<double>::epsilon() *
      SizeOf(ControlPoints(patch)); // sums of at most 64 terms with positive weights
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(batch.Values(0, c), x[c], tolerance) << "element " << e;
    }
  }
}

TEST_P(SplineModelCells, EvaluateLikeTheKernel_CrossOracle)
{
  const auto grid = Encode(RandomModel(GetParam()));
  for (const SplinePatch& patch : Decode(grid).Patches)
  {
    switch (patch.Geometry.index())
    {
      case 0:
        CheckCells<1>(grid, patch);
        break;
      case 1:
        CheckCells<2>(grid, patch);
        break;
      default:
        CheckCells<3>(grid, patch);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SplineModelCells, ::testing::ValuesIn(AllModelCases()), NameOf);

TEST(SplineModelCellData, IsPassedBySourceCell_GoldenOracle)
{
  const auto grid = Encode(RandomModel({ 2, SpaceKind::Tensor, false, 1, 1 }));
  vtkNew<vtkIntArray> marks;
  marks->SetName("Mark");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    marks->InsertNextValue(static_cast<int>(10 * c));
    names->InsertNextValue("cell " + std::to_string(c));
  }
  grid->GetCellData()->AddArray(marks);
  grid->GetCellData()->AddArray(names);
  const auto output = Encode(RandomModel({ 1, SpaceKind::Tensor, false, 1, 3 }));
  std::vector<vtkIdType> sources(static_cast<std::size_t>(output->GetNumberOfCells()), -1);
  sources[1] = 2;
  PassCellData(grid, sources, output);
  ASSERT_TRUE(output->GetCellData()->GetArray("Mark"));
  EXPECT_EQ(output->GetCellData()->GetArray("Mark")->GetComponent(0, 0), 0);
  EXPECT_EQ(output->GetCellData()->GetArray("Mark")->GetComponent(1, 0), 20);
  auto* copied = vtkStringArray::SafeDownCast(output->GetCellData()->GetAbstractArray("Name"));
  ASSERT_TRUE(copied);
  EXPECT_EQ(copied->GetValue(1), "cell 2");
  EXPECT_EQ(output->GetCellData()->GetArray("ElementId")->GetComponent(1, 0), 1);
}
}
