// SPDX-License-Identifier: BSD-3-Clause
// Trimmed models in two grids: what they carry, what filters do to them, what damage is refused.
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "ModelCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkThreshold.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridReader.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

using namespace knotwork;

namespace
{
using GridPointer = vtkSmartPointer<vtkUnstructuredGrid>;

struct Grids
{
  GridPointer Surfaces = GridPointer::New();
  GridPointer Curves = GridPointer::New();

  explicit Grids(const TrimmedModel& model)
  {
    const Status status = EncodeTrimmedModel(model, this->Surfaces, this->Curves);
    EXPECT_TRUE(status) << status.Message();
  }
  Grids(GridPointer surfaces, GridPointer curves)
    : Surfaces(std::move(surfaces)), Curves(std::move(curves))
  {
  }
  TrimmedModel Decode() const
  {
    std::vector<std::string> warnings;
    auto model = DecodeTrimmedModel(this->Surfaces, this->Curves, &warnings);
    EXPECT_TRUE(model) << model.Status.Message();
    EXPECT_EQ(warnings, std::vector<std::string>());
    return model.Value;
  }
};

GridPointer Appended(const std::vector<GridPointer>& grids)
{
  vtkNew<vtkAppendFilter> append;
  for (const GridPointer& grid : grids)
  {
    append->AddInputData(grid);
  }
  append->Update();
  return append->GetOutput();
}

GridPointer Moved(vtkUnstructuredGrid* grid, vtkTransform* transform)
{
  vtkNew<vtkTransformFilter> filter; // as ParaView's Transform does it
  filter->SetInputData(grid);
  filter->SetTransform(transform);
  filter->SetTransformAllInputVectors(true);
  filter->Update();
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutput());
}

GridPointer Selected(vtkUnstructuredGrid* grid, double lower, double upper)
{
  vtkNew<vtkThreshold> threshold;
  threshold->SetInputData(grid);
  threshold->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "PatchId");
  threshold->SetLowerThreshold(lower);
  threshold->SetUpperThreshold(upper);
  threshold->Update();
  return threshold->GetOutput();
}

/// Faces a, then faces b, nothing shared.
TrimmedModel Joined(const TrimmedModel& a, const TrimmedModel& b)
{
  TrimmedModel both = a;
  for (TrimmedFace face : b.Faces)
  {
    for (TrimmedLoop& loop : face.Loops)
    {
      for (TrimmingCurve& use : loop.Curves)
      {
        use.Edge += a.NumEdges;
        use.Vertices[0] += a.NumVertices;
        use.Vertices[1] += a.NumVertices;
      }
    }
    both.Faces.push_back(face);
  }
  both.NumEdges += b.NumEdges;
  both.NumVertices += b.NumVertices;
  return both;
}

/// Edges and vertices in the order of their first use, as decoding numbers them.
TrimmedModel Renumbered(TrimmedModel model)
{
  std::map<int, int> edges;
  std::map<int, int> vertices;
  for (TrimmedFace& face : model.Faces)
  {
    for (TrimmedLoop& loop : face.Loops)
    {
      for (TrimmingCurve& use : loop.Curves)
      {
        use.Edge = edges.emplace(use.Edge, static_cast<int>(edges.size())).first->second;
        for (int& vertex : use.Vertices)
        {
          vertex = vertices.emplace(vertex, static_cast<int>(vertices.size())).first->second;
        }
      }
    }
  }
  model.NumEdges = static_cast<int>(edges.size());
  model.NumVertices = static_cast<int>(vertices.size());
  return model;
}

TEST(TrimmedGrids, CarryTheWholeModel_ExactOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TrimmedModel model = Renumbered(TwoFaces(seed));
    const Grids grids(model);
    EXPECT_TRUE(Identical(grids.Decode(), model));
    EXPECT_TRUE(Identical(Grids(grids.Decode()).Decode(), model));
    EXPECT_EQ(grids.Surfaces->GetNumberOfCells(), 6 + 4);
    EXPECT_EQ(grids.Curves->GetNumberOfCells(), (4 + 3) + 2 + (4 + 5));
    // a difference is found
    TrimmedModel other = model;
    other.Faces[1].Loops[0].Curves[0].UV(0, 1) += 1e-12;
    EXPECT_FALSE(Identical(grids.Decode(), other));
  }
}

TEST(TrimmedGrids, CarryTheTypesOfSurfaces_ExactOracle)
{
  TrimmedModel model = Renumbered(TwoFaces());
  EXPECT_FALSE(Grids(model).Surfaces->GetCellData()->HasArray("SurfaceType"));
  for (int type = 0; type < static_cast<int>(SurfaceType::FreeForm); ++type)
  {
    model.Faces[1].Type = static_cast<SurfaceType>(type); // beside a free form
    const Grids grids(model);
    auto* array = grids.Surfaces->GetCellData()->GetArray("SurfaceType");
    ASSERT_NE(array, nullptr);
    EXPECT_EQ(array->GetTuple1(0), static_cast<int>(SurfaceType::FreeForm));
    EXPECT_EQ(array->GetTuple1(6), type);
    const TrimmedModel found = grids.Decode();
    EXPECT_TRUE(Identical(found, model));
    EXPECT_EQ(found.Faces[0].Type, SurfaceType::FreeForm);
    EXPECT_EQ(found.Faces[1].Type, model.Faces[1].Type);
  }
}

TEST(TrimmedGrids, AreBezierGridsThatVtkReadsAndWrites_ExactOracle)
{
  const TrimmedModel model = Renumbered(TwoFaces());
  const Grids grids(model);
  const auto through = [](vtkUnstructuredGrid* grid, int mode)
  {
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetInputData(grid);
    writer->SetWriteToOutputString(true);
    writer->SetDataMode(mode);
    EXPECT_EQ(writer->Write(), 1);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetReadFromInputString(true);
    reader->SetInputString(writer->GetOutputString());
    reader->Update();
    return GridPointer(reader->GetOutput());
  };
  for (int mode : { vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended })
  {
    SCOPED_TRACE(mode);
    const Grids read(through(grids.Surfaces, mode), through(grids.Curves, mode));
    EXPECT_TRUE(Identical(read.Decode(), model));
  }
}

TEST(TrimmedGrids, MoveWithTheirPoints_ExactOracle)
{
  TrimmedModel model = Renumbered(TwoFaces());
  const Grids grids(model);
  vtkNew<vtkTransform> transform;
  transform->Translate(3, -2, 1);
  transform->RotateWXYZ(37, 1, 2, 3);
  transform->Scale(2, 1, 0.5);
  const Grids moved(Moved(grids.Surfaces, transform), Moved(grids.Curves, transform));
  const TrimmedModel found = moved.Decode();
  ASSERT_EQ(found.Faces.size(), model.Faces.size());
  const auto distance = [&](const PointMatrix& from, const PointMatrix& to)
  {
    double largest = 0.0;
    for (Eigen::Index i = 0; i < from.rows(); ++i)
    {
      Eigen::RowVector3d image;
      transform->TransformPoint(from.row(i).data(), image.data());
      largest = std::max(largest, (image - to.row(i)).cwiseAbs().maxCoeff());
    }
    return largest;
  };
  // recovery from Bezier points of size 8: rounding times its amplification, below 100 here
  const double tolerance = 64 * 100 * 8 * std::numeric_limits<double>::epsilon();
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    EXPECT_LE(distance(model.Faces[f].Surface.ControlPoints, found.Faces[f].Surface.ControlPoints),
      tolerance);
    model.Faces[f].Surface = found.Faces[f].Surface;
    for (std::size_t l = 0; l < model.Faces[f].Loops.size(); ++l)
    {
      for (std::size_t c = 0; c < model.Faces[f].Loops[l].Curves.size(); ++c)
      {
        TrimmingCurve& before = model.Faces[f].Loops[l].Curves[c];
        const TrimmingCurve& after = found.Faces[f].Loops[l].Curves[c];
        EXPECT_LE(distance(before.Curve.ControlPoints, after.Curve.ControlPoints), tolerance);
        EXPECT_LE((before.UV - after.UV).cwiseAbs().maxCoeff(), tolerance);
        before.Curve = after.Curve;
        before.UV = after.UV;
      }
    }
  }
  EXPECT_TRUE(Identical(found, model)) << "names, colours, numbers";
}

TEST(TrimmedGrids, ASelectedFaceKeepsItsLoops_ExactOracle)
{
  const TrimmedModel model = TwoFaces();
  const Grids grids(model);
  for (int face : { 0, 1 })
  {
    TrimmedModel alone = model;
    alone.Faces = { model.Faces[static_cast<std::size_t>(face)] };
    const Grids selected(Selected(grids.Surfaces, face, face), grids.Curves);
    EXPECT_TRUE(Identical(selected.Decode(), Renumbered(alone)));
  }
}

constexpr const char* CarriedArrays[] = { "CarriedCurveNumbers", "CarriedCurveValues",
  "CarriedFaces", "CarriedFacePoints" };

/// The model of the surfaces alone.
TrimmedModel DecodeAlone(vtkDataObject* surfaces)
{
  std::vector<std::string> warnings;
  auto model = DecodeTrimmedModel(surfaces, nullptr, &warnings);
  EXPECT_TRUE(model) << model.Status.Message();
  EXPECT_EQ(warnings, std::vector<std::string>());
  return model.Value;
}

TEST(TrimmedGrids, SurfacesAloneAreTheModel_ExactOracle)
{
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TrimmedModel model = Renumbered(TwoFaces(seed));
    const Grids grids(model);
    EXPECT_TRUE(Identical(DecodeAlone(grids.Surfaces), model));
    // a face of them
    for (int face : { 0, 1 })
    {
      TrimmedModel alone = model;
      alone.Faces = { model.Faces[static_cast<std::size_t>(face)] };
      EXPECT_TRUE(Identical(DecodeAlone(Selected(grids.Surfaces, face, face)), Renumbered(alone)));
    }
    // two models, in blocks of their own
    vtkNew<vtkPartitionedDataSetCollection> both;
    both->SetPartition(0, 0, grids.Surfaces);
    both->SetPartition(1, 0, Grids(TwoFaces(seed + 10)).Surfaces);
    EXPECT_TRUE(
      Identical(DecodeAlone(both), Renumbered(Joined(model, Renumbered(TwoFaces(seed + 10))))));
  }
}

TEST(TrimmedGrids, CarriedCurvesMoveWithTheSurfaces_CrossOracle)
{
  const Grids grids(TwoFaces());
  vtkNew<vtkTransform> transform;
  transform->Translate(3, -2, 1);
  transform->RotateWXYZ(37, 1, 2, 3);
  transform->Scale(2, 1, 0.5);
  const GridPointer surfaces = Moved(grids.Surfaces, transform);
  const TrimmedModel expected = Grids(surfaces, Moved(grids.Curves, transform)).Decode();
  const TrimmedModel found = DecodeAlone(surfaces);
  ASSERT_EQ(found.Faces.size(), expected.Faces.size());
  // ten times the recovery's of MoveWithTheirPoints: least squares of a few points of that size
  const double tolerance = 10 * 64 * 100 * 8 * std::numeric_limits<double>::epsilon();
  for (std::size_t f = 0; f < expected.Faces.size(); ++f)
  {
    ASSERT_EQ(found.Faces[f].Loops.size(), expected.Faces[f].Loops.size());
    for (std::size_t l = 0; l < expected.Faces[f].Loops.size(); ++l)
    {
      for (std::size_t c = 0; c < expected.Faces[f].Loops[l].Curves.size(); ++c)
      {
        const TrimmingCurve& a = expected.Faces[f].Loops[l].Curves[c];
        const TrimmingCurve& b = found.Faces[f].Loops[l].Curves[c];
        EXPECT_LE((a.Curve.ControlPoints - b.Curve.ControlPoints).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_LE((a.UV - b.UV).cwiseAbs().maxCoeff(), tolerance);
        EXPECT_EQ(a.Edge, b.Edge);
      }
    }
  }
  // the curves have moved
  const TrimmedModel decoded = grids.Decode();
  const auto& before = decoded.Faces[0].Loops[0].Curves[0].Curve.ControlPoints;
  const auto& after = found.Faces[0].Loops[0].Curves[0].Curve.ControlPoints;
  EXPECT_GT((before - after).cwiseAbs().maxCoeff(), 0.5);
}

TEST(TrimmedGrids, CarriedCurvesThatDoNotFitAreRefused)
{
  struct Damage
  {
    const char* Name;
    std::function<void(vtkUnstructuredGrid*)> Do;
    ErrorCode Code;
    const char* Words;
  };
  const auto numbers = [](int column, int value)
  {
    return [column, value](vtkUnstructuredGrid* grid)
    { grid->GetFieldData()->GetArray(CarriedArrays[0])->SetComponent(0, column, value); };
  };
  std::vector<Damage> damages = {
    { "bent",
      [](vtkUnstructuredGrid* grid)
      {
        for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
        {
          double x[3];
          grid->GetPoint(i, x);
          grid->GetPoints()->SetPoint(i, x[0], x[1], x[2] + 0.1 * x[0] * x[0]);
        }
      },
      ErrorCode::InvalidTopology, "were bent" },
    { "degree", numbers(7, 12), ErrorCode::InvalidTopology, CarriedArrays[0] },
    { "functions", numbers(8, 1000000000), ErrorCode::InvalidTopology, CarriedArrays[0] },
    { "fewer functions", numbers(8, 2), ErrorCode::InvalidKnots, CarriedArrays[1] },
    { "loop", numbers(1, 5), ErrorCode::InvalidTopology, "loop" },
    { "vertex", numbers(4, 77), ErrorCode::InvalidTopology, "two different curves" },
    { "knots",
      [](vtkUnstructuredGrid* grid)
      { grid->GetFieldData()->GetArray(CarriedArrays[1])->SetComponent(0, 0, 1e9); },
      ErrorCode::InvalidKnots, CarriedArrays[1] },
    { "values",
      [](vtkUnstructuredGrid* grid)
      { grid->GetFieldData()->GetArray(CarriedArrays[1])->InsertNextTuple1(1.0); },
      ErrorCode::InvalidTopology, CarriedArrays[1] },
    { "no number",
      [](vtkUnstructuredGrid* grid)
      {
        vtkDataArray* values = grid->GetFieldData()->GetArray(CarriedArrays[1]);
        values->SetComponent(values->GetNumberOfTuples() - 1, 0, std::nan(""));
      },
      ErrorCode::NonFiniteInput, "face 1" },
    { "rows",
      [](vtkUnstructuredGrid* grid)
      { grid->GetFieldData()->GetArray(CarriedArrays[2])->SetComponent(0, 2, 1e9); },
      ErrorCode::InvalidTopology, CarriedArrays[2] },
    { "other surfaces",
      [](vtkUnstructuredGrid* grid)
      { grid->GetFieldData()->GetArray(CarriedArrays[2])->SetComponent(0, 2, 3); },
      ErrorCode::InvalidTopology, "other control points" },
  };
  for (const char* name : { CarriedArrays[1], CarriedArrays[2], CarriedArrays[3] })
  {
    damages.push_back(
      { name, [name](vtkUnstructuredGrid* grid) { grid->GetFieldData()->RemoveArray(name); },
        ErrorCode::InvalidTopology, name });
  }
  for (const Damage& damage : damages)
  {
    SCOPED_TRACE(damage.Name);
    const Grids grids(TwoFaces());
    damage.Do(grids.Surfaces);
    const auto found = DecodeTrimmedModel(grids.Surfaces, nullptr);
    EXPECT_EQ(found.Status.Code, damage.Code) << found.Status.Message();
    EXPECT_NE(found.Status.Detail.find(damage.Words), std::string::npos) << found.Status.Detail;
  }
}

TEST(TrimmedGrids, SeveralModelsInOneGrid_ExactOracle)
{
  const TrimmedModel first = TwoFaces(1);
  const TrimmedModel second = TwoFaces(2); // the same bases, other points
  const Grids a(first);
  const Grids b(second);
  const auto decode =
    [](const std::vector<GridPointer>& surfaces, const std::vector<GridPointer>& curves)
  {
    auto model = DecodeTrimmedModel(Appended(surfaces), Appended(curves));
    EXPECT_TRUE(model) << model.Status.Message();
    return model.Value;
  };
  const TrimmedModel both = decode({ a.Surfaces, b.Surfaces }, { a.Curves, b.Curves });
  EXPECT_EQ(both.NumEdges, 8);
  EXPECT_EQ(both.NumVertices, 6);
  // what is appended last has lost its cached control points: recovered, to rounding
  const TrimmedModel expected = Renumbered(Joined(first, second));
  ASSERT_EQ(both.Faces.size(), 4U);
  for (std::size_t f = 0; f < 4; ++f)
  {
    const TrimmedFace& face = expected.Faces[f];
    EXPECT_LE((both.Faces[f].Surface.ControlPoints - face.Surface.ControlPoints).norm(), 1e-12);
    ASSERT_EQ(both.Faces[f].Loops.size(), face.Loops.size());
    for (std::size_t l = 0; l < face.Loops.size(); ++l)
    {
      ASSERT_EQ(both.Faces[f].Loops[l].Curves.size(), face.Loops[l].Curves.size());
      for (std::size_t c = 0; c < face.Loops[l].Curves.size(); ++c)
      {
        const TrimmingCurve& x = face.Loops[l].Curves[c];
        const TrimmingCurve& y = both.Faces[f].Loops[l].Curves[c];
        EXPECT_LE(
          (x.UV - y.UV).norm() + (x.Curve.ControlPoints - y.Curve.ControlPoints).norm(), 1e-12);
        EXPECT_EQ(x.Edge, y.Edge);
        EXPECT_EQ(x.Vertices, y.Vertices);
      }
    }
  }
  // a model and its moved copy
  vtkNew<vtkTransform> transform;
  transform->Translate(0, 0, 5);
  const TrimmedModel copies =
    decode({ a.Surfaces, Moved(a.Surfaces, transform) }, { a.Curves, Moved(a.Curves, transform) });
  ASSERT_EQ(copies.Faces.size(), 4U);
  EXPECT_EQ(copies.NumEdges, 8);
  const auto height = [&](std::size_t face)
  { return copies.Faces[face].Loops[0].Curves[0].Curve.ControlPoints(0, 2); };
  EXPECT_NEAR(height(2) - height(0), 5.0, 1e-12);
  EXPECT_NEAR(height(3) - height(1), 5.0, 1e-12);
}

TEST(TrimmedGrids, AppendedModelsOfOtherBasesKeepTheirMaps_CrossOracle)
{
  const TrimmedModel first = TwoFaces(1);
  const TrimmedModel second = TwoFaces(2, 5);
  const Grids a(first);
  const Grids b(second);
  std::vector<std::string> warnings;
  const auto both = DecodeTrimmedModel(
    Appended({ a.Surfaces, b.Surfaces }), Appended({ a.Curves, b.Curves }), &warnings);
  ASSERT_TRUE(both) << both.Status.Message();
  EXPECT_EQ(both->NumEdges, 8);
  EXPECT_FALSE(warnings.empty());
  ASSERT_EQ(both->Faces.size(), 4U);
  EXPECT_EQ(both->Faces[0].Surface.ControlPoints, first.Faces[0].Surface.ControlPoints);
  const Spline<2>& before = second.Faces[0].Surface;
  const Spline<2>& after = both->Faces[2].Surface;
  EXPECT_GT(after.Space->NumFunctions, before.Space->NumFunctions);
  const PointMatrix parameters = 0.5 * (PointMatrix::Random(100, 2).array() + 1.0);
  EvaluationBatch x;
  EvaluationBatch y;
  ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(before), parameters, { 1, 0 }, x));
  ASSERT_TRUE(EvaluateParameters<2>(MakeBezierForm(after), parameters, { 1, 0 }, y));
  EXPECT_LE((x.Values - y.Values).norm() + (x.First - y.First).norm(), 1e-11);
}

TEST(TrimmedGrids, CollectionsOfModels_ExactOracle)
{
  const TrimmedModel first = TwoFaces(1);
  const TrimmedModel second = TwoFaces(2, 4);
  const Grids a(first);
  const Grids b(second);
  const auto collect = [](const std::vector<GridPointer>& grids)
  {
    auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
    for (unsigned int i = 0; i < grids.size(); ++i)
    {
      vtkNew<vtkPartitionedDataSet> block;
      block->SetPartition(0, grids[i]);
      collection->SetPartitionedDataSet(i, block);
    }
    return collection;
  };
  const auto model =
    DecodeTrimmedModel(collect({ a.Surfaces, b.Surfaces }), collect({ a.Curves, b.Curves }));
  ASSERT_TRUE(model) << model.Status.Message();
  EXPECT_TRUE(Identical(model.Value, Renumbered(Joined(first, second))));
}

TEST(TrimmedGrids, FacesWithoutCurves_PropertyOracle)
{
  TrimmedModel whole = TwoFaces();
  const Grids trimmed(whole);
  for (const char* name : CarriedArrays)
  {
    trimmed.Surfaces->GetFieldData()->RemoveArray(name);
  }
  std::vector<std::string> warnings;
  auto found = DecodeTrimmedModel(trimmed.Surfaces, nullptr, &warnings);
  ASSERT_TRUE(found) << found.Status.Message();
  EXPECT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(found->Faces[0].Loops.empty());
  for (TrimmedFace& face : whole.Faces)
  {
    face.Loops.clear();
  }
  whole.NumEdges = whole.NumVertices = 0;
  EXPECT_TRUE(Identical(found.Value, whole));
  // never trimmed: nothing is missing, with and without an (empty) grid of curves
  const Grids untrimmed(whole);
  EXPECT_EQ(untrimmed.Curves->GetNumberOfCells(), 0);
  EXPECT_TRUE(Identical(untrimmed.Decode(), whole));
  // any spline grid of surfaces is a model
  for (const char* name : { "ModelId", "FaceId", "FaceReversed", "Body", "TrimmingCurves" })
  {
    untrimmed.Surfaces->GetCellData()->RemoveArray(name);
  }
  warnings.clear();
  found = DecodeTrimmedModel(untrimmed.Surfaces, nullptr, &warnings);
  ASSERT_TRUE(found) << found.Status.Message();
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(found->Faces.size(), 2U);
}

void SetAll(vtkUnstructuredGrid* grid, const char* name, double from, double to)
{
  vtkDataArray* array = grid->GetCellData()->GetArray(name);
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (array->GetComponent(cell, 0) == from)
    {
      array->SetComponent(cell, 0, to);
    }
  }
}

TEST(TrimmedGrids, DamageIsRefused)
{
  struct Damage
  {
    const char* Name;
    std::function<void(Grids&)> Do;
    ErrorCode Code;
    const char* Words;
  };
  const auto without = [](const char* name)
  { return [name](Grids& grids) { grids.Curves->GetCellData()->RemoveArray(name); }; };
  const auto setType = [](Grids& grids, int type)
  {
    vtkNew<vtkIntArray> types;
    types->SetName("SurfaceType");
    types->SetNumberOfTuples(grids.Surfaces->GetNumberOfCells());
    types->Fill(type);
    grids.Surfaces->GetCellData()->AddArray(types);
  };
  std::vector<Damage> damages = {
    { "plane curves", [](Grids& grids) { grids.Curves->GetPointData()->RemoveArray("UV"); },
      ErrorCode::InvalidTopology, "'UV'" },
    { "NaN in UV",
      [](Grids& grids)
      {
        grids.Curves->GetPointData()->GetArray("UV")->SetComponent(
          3, 1, std::numeric_limits<double>::quiet_NaN());
      },
      ErrorCode::NonFiniteInput, "UV" },
    { "NaN in a point",
      [](Grids& grids) { grids.Surfaces->GetPoints()->SetPoint(4, std::nan(""), 0.0, 0.0); },
      ErrorCode::NonFiniteInput, "surfaces" },
    { "curves of another model", [](Grids& grids) { grids.Curves = Grids(TwoFaces(7)).Curves; },
      ErrorCode::InvalidTopology, "face 0 has 0 of its 3" },
    { "a curve is missing", [](Grids& grids) { grids.Curves = Selected(grids.Curves, 1, 9); },
      ErrorCode::InvalidTopology, "face 0 has 2 of its 3" },
    { "an element is missing",
      [](Grids& grids)
      {
        vtkNew<vtkThreshold> threshold;
        threshold->SetInputData(grids.Surfaces);
        threshold->SetInputArrayToProcess(
          0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "ElementId");
        threshold->SetLowerThreshold(1);
        threshold->SetUpperThreshold(99);
        threshold->Update();
        grids.Surfaces = threshold->GetOutput();
      },
      ErrorCode::InvalidTopology, "missing: 0" },
    { "one edge, two curves", [](Grids& grids) { SetAll(grids.Curves, "EdgeId", 1, 0); },
      ErrorCode::InvalidTopology, "edge 0 has two different" },
    { "open loop", [](Grids& grids) { SetAll(grids.Curves, "BeginVertex", 1, 2); },
      ErrorCode::InvalidTopology, "does not end where" },
    { "loop left out", [](Grids& grids) { SetAll(grids.Curves, "LoopId", 1, 2); },
      ErrorCode::InvalidTopology, "loop 2" },
    { "place taken twice", [](Grids& grids) { SetAll(grids.Curves, "CurveId", 1, 0); },
      ErrorCode::InvalidTopology, "face 0 has 2 of its 3" },
    { "numbers differ within a patch",
      [](Grids& grids) { grids.Curves->GetCellData()->GetArray("LoopId")->SetTuple1(1, 1); },
      ErrorCode::InvalidTopology, "differs between its cells" },
    { "no whole number",
      [](Grids& grids)
      {
        vtkNew<vtkDoubleArray> body;
        body->SetName("Body");
        body->SetNumberOfTuples(grids.Surfaces->GetNumberOfCells());
        body->Fill(0.5);
        grids.Surfaces->GetCellData()->AddArray(body);
      },
      ErrorCode::InvalidTopology, "'Body' is not a whole number" },
    { "numbers of two components",
      [](Grids& grids)
      {
        vtkNew<vtkIntArray> body;
        body->SetName("Body");
        body->SetNumberOfComponents(2);
        body->SetNumberOfTuples(grids.Surfaces->GetNumberOfCells());
        body->Fill(0.0);
        grids.Surfaces->GetCellData()->AddArray(body);
      },
      ErrorCode::InvalidTopology, "'Body' is not one number a cell" },
    { "a type that is none", [=](Grids& grids) { setType(grids, NumSurfaceTypes); },
      ErrorCode::InvalidTopology, "cell array 'SurfaceType' is 8" },
    { "a type below none", [=](Grids& grids) { setType(grids, -1); }, ErrorCode::InvalidTopology,
      "cell array 'SurfaceType' is -1" },
    { "curves in the place of surfaces",
      [](Grids& grids) { std::swap(grids.Surfaces, grids.Curves); }, ErrorCode::DimensionMismatch,
      "no tensor-product surface" },
    { "no surfaces", [](Grids& grids) { grids.Surfaces = GridPointer::New(); },
      ErrorCode::EmptyInput, "no surfaces" },
  };
  for (const char* name : { "FaceId", "LoopId", "CurveId", "EdgeId", "BeginVertex", "EndVertex" })
  {
    damages.push_back({ name, without(name), ErrorCode::InvalidTopology, "is missing" });
  }
  for (const Damage& damage : damages)
  {
    SCOPED_TRACE(damage.Name);
    Grids grids(TwoFaces());
    damage.Do(grids);
    const auto found = DecodeTrimmedModel(grids.Surfaces, grids.Curves);
    EXPECT_EQ(found.Status.Code, damage.Code) << found.Status.Message();
    EXPECT_NE(found.Status.Detail.find(damage.Words), std::string::npos) << found.Status.Detail;
  }
  EXPECT_EQ(DecodeTrimmedModel(nullptr, nullptr).Status.Code, ErrorCode::InvalidTopology);
}

TEST(TrimmedGrids, BadModelsAreNotWritten)
{
  TrimmedModel model = TwoFaces();
  model.Faces[0].Loops[0].Curves[0].Edge = 9;
  vtkNew<vtkUnstructuredGrid> surfaces;
  vtkNew<vtkUnstructuredGrid> curves;
  EXPECT_EQ(EncodeTrimmedModel(model, surfaces, curves).Code, ErrorCode::InvalidTopology);
  EXPECT_EQ(EncodeTrimmedModel({}, surfaces, curves).Code, ErrorCode::EmptyInput);
}
}
