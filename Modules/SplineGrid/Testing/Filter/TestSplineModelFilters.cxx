// SPDX-License-Identifier: BSD-3-Clause
// Filters of VTK that move points or join grids: the decoded splines are the moved ones.
#include "RandomModels.h"

#include <knotwork/SplineCore/TensorSpace.h>

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkThreshold.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkWarpScalar.h"
#include "vtkWarpVector.h"

#include <cmath>
#include <limits>

using namespace knotwork;

namespace
{
constexpr double Epsilon = std::numeric_limits<double>::epsilon();
constexpr double FloatEpsilon = std::numeric_limits<float>::epsilon();

class SplineModelFilters : public ::testing::TestWithParam<ModelCase>
{
protected:
  SplineModel Model = RandomModel(GetParam());
};

PointMatrix Moved(vtkTransform* transform, const PointMatrix& points)
{
  PointMatrix moved(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    transform->TransformPoint(points.row(i).data(), moved.row(i).data());
  }
  return moved;
}

const PointMatrix& CoefficientsOf(const SplinePatch& patch, const std::string& name)
{
  static const PointMatrix none(0, 0);
  const auto at = std::find_if(patch.Fields.begin(), patch.Fields.end(),
    [&](const SplineField& field) { return field.Name == name; });
  return at != patch.Fields.end() ? at->Coefficients : none;
}

TEST_P(SplineModelFilters, TransformMovesControlPoints_ExactOracle)
{
  vtkNew<vtkTransform> transform;
  transform->Translate(3, -2, 1);
  transform->RotateWXYZ(37, 1, 2, 3);
  transform->Scale(2, 1, 0.5);
  for (bool allVectors : { false, true }) // true: as ParaView does it
  {
    SCOPED_TRACE(allVectors);
    vtkNew<vtkTransformFilter> filter;
    filter->SetInputData(Encode(this->Model));
    filter->SetTransform(transform);
    filter->SetTransformAllInputVectors(allVectors);
    filter->Update();
    if (allVectors) // the degrees are spoilt, the copy decides
    {
      vtkDataArray* degrees = filter->GetOutput()->GetCellData()->GetArray("HigherOrderDegrees");
      ASSERT_TRUE(degrees);
      EXPECT_NE(degrees->GetComponent(0, 0), std::floor(degrees->GetComponent(0, 0)));
    }
    const SplineModel back = Decode(filter->GetOutput());
    EXPECT_EQ(back.Warnings, std::vector<std::string>());
    for (const SplinePatch& patch : this->Model.Patches)
    {
      const SplinePatch& moved = PatchOf(back, patch.Id);
      EXPECT_TRUE(moved.Recovered);
      const PointMatrix expected = Moved(transform, ControlPoints(patch));
      const double tolerance = 64 * Epsilon * moved.Amplification;
      EXPECT_TRUE(Near(moved, expected, Weights(patch), tolerance * SizeOf(expected), tolerance));
      ASSERT_EQ(moved.Fields.size(), patch.Fields.size());
      const double fieldTolerance =
        64 * Epsilon * moved.Amplification * 4; // stretched by 2, rational
      for (const SplineField& field : patch.Fields)
      {
        PointMatrix coefficients = field.Coefficients;
        if (allVectors && coefficients.cols() == 3)
        {
          for (Eigen::Index i = 0; i < coefficients.rows(); ++i)
          {
            const Eigen::RowVector3d vector = coefficients.row(i);
            transform->TransformVector(vector.data(), coefficients.row(i).data());
          }
        }
        const PointMatrix& found = CoefficientsOf(moved, field.Name); // the filter reorders arrays
        ASSERT_EQ(found.cols(), coefficients.cols());
        EXPECT_LE((found - coefficients).cwiseAbs().maxCoeff(), fieldTolerance) << field.Name;
      }
    }
  }
}

TEST_P(SplineModelFilters, WarpAddsCoefficients_ExactOracle)
{
  const auto grid = Encode(this->Model);
  vtkNew<vtkWarpVector> byVector;
  byVector->SetInputData(grid);
  byVector->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Velocity");
  byVector->SetScaleFactor(0.5);
  byVector->Update();
  const SplineModel vectors = Decode(byVector->GetOutput());
  vtkNew<vtkWarpScalar> byScalar;
  byScalar->SetInputData(grid);
  byScalar->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Temperature");
  byScalar->SetScaleFactor(2.0);
  byScalar->Update();
  const SplineModel scalars = Decode(byScalar->GetOutput());
  EXPECT_EQ(byScalar->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(vectors.Warnings, std::vector<std::string>());
  EXPECT_EQ(scalars.Warnings, std::vector<std::string>());
  for (const SplinePatch& patch : this->Model.Patches)
  {
    const SplinePatch& a = PatchOf(vectors, patch.Id);
    PointMatrix expected = ControlPoints(patch) + 0.5 * patch.Fields[1].Coefficients;
    const double weightTolerance = 64 * FloatEpsilon * a.Amplification;
    EXPECT_TRUE(
      Near(a, expected, Weights(patch), weightTolerance * SizeOf(expected), weightTolerance));
    const SplinePatch& b = PatchOf(scalars, patch.Id);
    expected = ControlPoints(patch);
    expected.col(2) += 2.0 * patch.Fields[0].Coefficients;
    EXPECT_TRUE(
      Near(b, expected, Weights(patch), weightTolerance * SizeOf(expected), weightTolerance));
  }
}

TEST_P(SplineModelFilters, MovesOutOfTheSpaceAreProjectedAndReported_PropertyOracle)
{
  const auto grid = Encode(this->Model);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    double x[3];
    grid->GetPoint(i, x);
    x[2] += 0.01 * std::sin(37.0 * i);
    grid->GetPoints()->SetPoint(i, x);
  }
  const SplineModel back = Decode(grid);
  for (const SplinePatch& patch : back.Patches)
  {
    EXPECT_TRUE(patch.Recovered);
    const bool projected = patch.Residual > 1e-6;
    const auto names = [&](const std::string& warning)
    { return warning.find("patch " + std::to_string(patch.Id) + ":") != std::string::npos; };
    EXPECT_EQ(projected, std::any_of(back.Warnings.begin(), back.Warnings.end(), names));
    // A space of Bernstein polynomials alone (all knots of full multiplicity) contains everything.
    EXPECT_TRUE(projected || NumFunctions(patch) > 0);
  }
}

// The grid of another spline of the same space, in the place of points and weights.
TEST_P(SplineModelFilters, EditedWeightsAreRecovered_ExactOracle)
{
  SplineModel other = this->Model;
  for (SplinePatch& patch : other.Patches)
  {
    std::visit(
      [&](auto& spline)
      {
        for (Eigen::Index i = 0; i < spline.Weights.size(); ++i)
        {
          spline.Weights[i] *= 1.0 + 0.3 * std::sin(i + 1.0);
        }
      },
      patch.Geometry);
  }
  const auto grid = Encode(this->Model);
  const auto edited = Encode(other);
  grid->GetPoints()->DeepCopy(edited->GetPoints());
  for (const char* field : { "Temperature", "Velocity", "Stress" })
  {
    grid->GetPointData()->GetArray(field)->DeepCopy(edited->GetPointData()->GetArray(field));
  }
  if (vtkDataArray* weights = grid->GetPointData()->GetRationalWeights())
  {
    weights->DeepCopy(edited->GetPointData()->GetRationalWeights()); // not the copy BezierWeights
  }
  const SplineModel back = Decode(grid);
  EXPECT_EQ(back.Warnings, std::vector<std::string>());
  for (const SplinePatch& patch : other.Patches)
  {
    const SplinePatch& found = PatchOf(back, patch.Id);
    EXPECT_EQ(found.Recovered, IsRational(patch));
    // Weights are determined up to one factor.
    const Eigen::VectorXd weights = Weights(patch) * (Weights(found)[0] / Weights(patch)[0]);
    const double tolerance = 64 * Epsilon * found.Amplification * 4; // ratio of the weights
    EXPECT_TRUE(Near(
      found, ControlPoints(patch), weights, tolerance * SizeOf(ControlPoints(patch)), tolerance));
    for (std::size_t f = 0; f < patch.Fields.size(); ++f)
    {
      EXPECT_LE((patch.Fields[f].Coefficients - found.Fields[f].Coefficients).cwiseAbs().maxCoeff(),
        tolerance);
    }
  }
}

// Other weights make another field of the same values: the cached coefficients no longer count.
TEST(SplineModelWeights, FieldsFollowTheirWeights_PropertyOracle)
{
  const auto space = // C^2: not every set of Bezier points is a spline
    MakeTensorSpace<2>({ KnotVector::Uniform(3, 3), KnotVector::Uniform(3, 3) }).Value;
  SplineModel model;
  model.Patches.resize(1);
  model.Patches[0].Geometry =
    Spline<2>{ space, PointMatrix::Random(36, 3), Eigen::VectorXd::LinSpaced(36, 1.0, 2.0) };
  model.Patches[0].Fields = { { "Temperature", PointMatrix::Random(36, 1) } };
  const auto grid = Encode(model);
  SplineModel other = model;
  auto& weights = std::get<Spline<2>>(other.Patches[0].Geometry).Weights;
  weights = weights.cwiseInverse();
  const auto edited = Encode(other);
  grid->GetPoints()->DeepCopy(edited->GetPoints());
  grid->GetPointData()->GetRationalWeights()->DeepCopy(
    edited->GetPointData()->GetRationalWeights());
  const SplineModel back = Decode(grid);
  ASSERT_EQ(back.Warnings.size(), 1U);
  EXPECT_NE(back.Warnings[0].find("field 'Temperature'"), std::string::npos) << back.Warnings[0];
}

TEST_P(SplineModelFilters, FieldsOfOtherToolsAreRecovered_ExactOracle)
{
  const auto grid = Encode(this->Model);
  vtkNew<vtkDoubleArray> height; // z as a field: its coefficients are those of z
  height->SetName("Height");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    height->InsertNextValue(grid->GetPoint(i)[2]);
  }
  grid->GetPointData()->AddArray(height);
  vtkDataArray* temperature = grid->GetPointData()->GetArray("Temperature");
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    temperature->SetComponent(i, 0, 2.0 * temperature->GetComponent(i, 0));
  }
  const SplineModel back = Decode(grid);
  EXPECT_EQ(back.Warnings, std::vector<std::string>());
  for (const SplinePatch& patch : this->Model.Patches)
  {
    const SplinePatch& found = PatchOf(back, patch.Id);
    EXPECT_FALSE(found.Recovered); // the geometry is as it was
    ASSERT_EQ(found.Fields.size(), patch.Fields.size() + 1);
    EXPECT_EQ(found.Fields[1].Coefficients, patch.Fields[1].Coefficients);
    // Amplification is reported for geometries; that of the moved grid is the same.
    vtkNew<vtkTransform> shift;
    shift->Translate(1, 0, 0);
    vtkNew<vtkTransformFilter> filter;
    filter->SetInputData(grid);
    filter->SetTransform(shift);
    filter->Update();
    const double amplification = PatchOf(Decode(filter->GetOutput()), patch.Id).Amplification;
    const double tolerance = 64 * Epsilon * amplification * 4;
    EXPECT_LE(
      (found.Fields[0].Coefficients - 2.0 * patch.Fields[0].Coefficients).cwiseAbs().maxCoeff(),
      tolerance);
    EXPECT_EQ(found.Fields.back().Name, "Height");
    EXPECT_LE(
      (found.Fields.back().Coefficients - ControlPoints(patch).col(2)).cwiseAbs().maxCoeff(),
      tolerance);
  }
}

SplineModel Renumbered(SplineModel model, int shift)
{
  for (SplinePatch& patch : model.Patches)
  {
    patch.Id += shift;
  }
  return model;
}

vtkSmartPointer<vtkUnstructuredGrid> Appended(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b)
{
  vtkNew<vtkAppendFilter> append;
  append->AddInputData(a);
  append->AddInputData(b);
  append->Update();
  return append->GetOutput();
}

// vtkAppendFilter keeps the field data of its first input only: the second model's control points
// must come back from the points where its bases are known, and as Bezier elements elsewhere.
TEST_P(SplineModelFilters, AppendedModelOfKnownBases_ExactOracle)
{
  vtkNew<vtkTransform> transform;
  transform->Translate(0, 0, 7);
  vtkNew<vtkTransformFilter> filter;
  const auto grid = Encode(this->Model);
  filter->SetInputData(grid);
  filter->SetTransform(transform);
  filter->Update();
  for (int shift : { 0, 100 }) // the same numbers, then others
  {
    SCOPED_TRACE(shift);
    vtkSmartPointer<vtkUnstructuredGrid> second =
      vtkUnstructuredGrid::SafeDownCast(filter->GetOutput());
    if (shift > 0)
    {
      second = Encode(Renumbered(Decode(second), shift));
    }
    const SplineModel back = Decode(Appended(grid, second));
    ASSERT_EQ(back.Patches.size(), 2 * this->Model.Patches.size());
    EXPECT_EQ(back.Warnings.empty(), shift > 0) << "numbers that occur twice are reported";
    for (const SplinePatch& patch : this->Model.Patches)
    {
      EXPECT_EQ(ControlPoints(PatchOf(back, patch.Id)), ControlPoints(patch));
      const PointMatrix expected = Moved(transform, ControlPoints(patch));
      const auto isCopy = [&](const SplinePatch& found)
      {
        const double tolerance = 64 * Epsilon * found.Amplification;
        return found.Id != patch.Id && KindOf(found) == KindOf(patch) &&
          NumFunctions(found) == NumFunctions(patch) &&
          Near(found, expected, Weights(patch), tolerance * SizeOf(expected), tolerance);
      };
      EXPECT_TRUE(std::any_of(back.Patches.begin(), back.Patches.end(), isCopy));
    }
  }
}

TEST_P(SplineModelFilters, AppendedModelOfUnknownBases_PropertyOracle)
{
  ModelCase otherCase = GetParam();
  otherCase.Seed += 100;
  const SplineModel other = RandomModel(otherCase);
  for (int shift : { 0, 100 })
  {
    SCOPED_TRACE(shift);
    const auto second = Encode(Renumbered(other, shift));
    const SplineModel back = Decode(Appended(Encode(this->Model), second));
    ASSERT_EQ(back.Patches.size(), this->Model.Patches.size() + other.Patches.size());
    EXPECT_FALSE(back.Warnings.empty());
    for (const SplinePatch& patch : this->Model.Patches)
    {
      EXPECT_EQ(ControlPoints(PatchOf(back, patch.Id)), ControlPoints(patch));
      EXPECT_EQ(KindOf(PatchOf(back, patch.Id)), KindOf(patch));
    }
    // The others are Bezier elements with the points of the grid.
    int numBezier = 0;
    for (const SplinePatch& patch : back.Patches)
    {
      if (KindOf(patch) == SpaceKind::Bezier)
      {
        numBezier += NumElements(patch);
      }
    }
    EXPECT_EQ(numBezier, second->GetNumberOfCells());
  }
}

INSTANTIATE_TEST_SUITE_P(All, SplineModelFilters, ::testing::ValuesIn(AllModelCases()), NameOf);
}
