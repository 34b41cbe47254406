// SPDX-License-Identifier: BSD-3-Clause
#include "../Kernel/TemplateCases.h"
#include "SplineModel.h"
#include "TemplateMap.h"
#include "vtkJacobianValidator.h"
#include "vtkTemplateMapping.h"

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <functional>

using namespace knotwork;
using cases::CircleTemplate;
using cases::LobedTarget;

namespace
{
vtkSmartPointer<vtkPolyData> ToPolyData(const Skeleton<2>& skeleton)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> ids;
  ids->SetName("PatchId");
  vtkNew<vtkDoubleArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (const SkeletonPatch<2>& patch : skeleton)
  {
    lines->InsertNextCell(static_cast<int>(patch.Points.rows()));
    ids->InsertNextValue(patch.Id);
    const PointMatrix normal = patch.Normals.rows() > 0 ? patch.Normals : UnitNormals(patch);
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i)
    {
      lines->InsertCellPoint(points->InsertNextPoint(patch.Points(i, 0), patch.Points(i, 1), 0.0));
      normals->InsertNextTuple3(normal(i, 0), normal(i, 1), 0.0);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  data->GetCellData()->AddArray(ids);
  data->GetPointData()->AddArray(normals);
  return data;
}

/// The filter with what it reported.
struct Mapping
{
  vtkNew<vtkTemplateMapping> Filter;
  std::vector<std::string> Errors;

  Mapping()
  {
    vtkNew<vtkCallbackCommand> record;
    record->SetClientData(&this->Errors);
    record->SetCallback(
      [](vtkObject*, unsigned long, void* errors, void* text) {
        static_cast<std::vector<std::string>*>(errors)->push_back(static_cast<const char*>(text));
      });
    this->Filter->AddObserver(vtkCommand::ErrorEvent, record);
    this->Filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, record);
  }
  Mapping& On(vtkPolyData* templateData, vtkPolyData* target)
  {
    this->Filter->SetInputData(0, templateData);
    this->Filter->SetTargetData(target);
    this->Filter->Update();
    return *this;
  }
  vtkUnstructuredGrid* Map()
  {
    return vtkUnstructuredGrid::SafeDownCast(this->Filter->GetOutputDataObject(0));
  }
  vtkPolyData* Mapped() { return vtkPolyData::SafeDownCast(this->Filter->GetOutputDataObject(1)); }
  vtkTable* Table() { return vtkTable::SafeDownCast(this->Filter->GetOutputDataObject(2)); }
  double Last(const char* column)
  {
    return this->Table()->GetValueByName(this->Table()->GetNumberOfRows() - 1, column).ToDouble();
  }
};
}

TEST(TemplateMappingFilter, OutputsAreTheKernelsResult_CrossOracle)
{
  const Skeleton<2> skeleton = CircleTemplate(501);
  Skeleton<2> target = LobedTarget();
  target.erase(target.begin() + 2); // edge 2 is free
  for (SkeletonPatch<2>& patch : target)
  {
    patch.Normals = UnitNormals(patch); // the same for both, to the last bit
  }
  TemplateMapParams<2> params;
  params.Iterations = 4;
  params.Degree = 2;
  params.InnerKnots = { 7, 7 };
  const auto expected = MapTemplate(skeleton, target, params);
  ASSERT_TRUE(expected);

  Mapping run;
  run.Filter->SetIterations(4);
  run.Filter->SetDegree(2);
  run.Filter->SetInnerKnots(7);
  run.On(ToPolyData(skeleton), ToPolyData(target));
  ASSERT_TRUE(run.Errors.empty()) << run.Errors[0];

  const auto model = DecodeSplineModel(run.Map());
  ASSERT_TRUE(model) << model.Status.Message();
  ASSERT_EQ(model->Patches.size(), 1u);
  const auto& map = std::get<Spline<2>>(model->Patches[0].Geometry);
  EXPECT_EQ(map.ControlPoints.leftCols(2), expected->Map.ControlPoints);
  EXPECT_EQ(map.ControlPoints.col(2).cwiseAbs().maxCoeff(), 0.0);
  vtkDataArray* errors = run.Map()->GetCellData()->GetArray("MaxError");
  ASSERT_TRUE(errors);
  for (std::size_t e = 0; e < expected->ElementErrors.size(); ++e)
  {
    EXPECT_EQ(errors->GetComponent(model->Patches[0].Cells[e], 0), expected->ElementErrors[e]);
  }

  vtkPolyData* mapped = run.Mapped();
  ASSERT_EQ(mapped->GetNumberOfLines(), 5);
  vtkIdType row = 0;
  for (std::size_t k = 0; k < 5; ++k)
  {
    const MappedSkeletonPatch& patch = expected->Skeleton[k];
    EXPECT_EQ(
      mapped->GetCellData()->GetArray("PatchId")->GetTuple1(static_cast<vtkIdType>(k)), patch.Id);
    for (Eigen::Index i = 0; i < patch.Points.rows(); ++i, ++row)
    {
      EXPECT_EQ(mapped->GetPoint(row)[0], patch.Points(i, 0));
      EXPECT_EQ(mapped->GetPoint(row)[1], patch.Points(i, 1));
      EXPECT_EQ(mapped->GetPointData()->GetArray("Distance")->GetTuple1(row), patch.Distances(i));
      EXPECT_EQ(mapped->GetPointData()->GetArray("Parameter")->GetTuple1(row), patch.Places(i, 0));
      EXPECT_EQ(mapped->GetPointData()->GetArray("PatchId")->GetTuple1(row), patch.Id);
    }
  }
  EXPECT_EQ(row, mapped->GetNumberOfPoints());

  ASSERT_EQ(run.Table()->GetNumberOfRows(), 4);
  for (vtkIdType i = 0; i < 4; ++i)
  {
    const TemplateMapIteration& record = expected->History[static_cast<std::size_t>(i)];
    const auto value = [&](const char* column)
    { return run.Table()->GetValueByName(i, column).ToDouble(); };
    EXPECT_EQ(value("Iteration"), record.Iteration);
    EXPECT_EQ(value("SquaredL2Error"), record.SquaredError);
    EXPECT_EQ(value("MaxError"), record.MaxError);
    EXPECT_EQ(value("NegativeJacobianPercent"), 100.0 * record.NegativeShare);
    EXPECT_EQ(value("Functions"), record.Functions);
    EXPECT_GT(value("Seconds"), 0.0);
  }
}

TEST(TemplateMappingFilter, MapsAreCertified_PropertyOracle)
{
  Mapping run;
  run.Filter->SetTemplateSamples(2001);
  run.On(ToPolyData(CircleTemplate(501)), ToPolyData(LobedTarget()));
  ASSERT_TRUE(run.Errors.empty()) << run.Errors[0];
  EXPECT_EQ(run.Last("NegativeJacobianPercent"), 0.0);
  vtkNew<vtkJacobianValidator> validator; // what the percentage only looks at
  validator->SetInputConnection(run.Filter->GetOutputPort());
  validator->Update();
  EXPECT_EQ(validator->GetVerdict(), 1);
  auto* table = vtkTable::SafeDownCast(validator->GetOutputDataObject(2));
  EXPECT_EQ(
    table->GetValueByName(table->GetNumberOfRows() - 1, "Injective").ToString(), "injective");
}

TEST(TemplateMappingFilter, EveryPropertyReachesTheKernel_PropertyOracle)
{
  const auto skeleton = ToPolyData(CircleTemplate(301));
  const auto target = ToPolyData(LobedTarget());
  const auto errorWith = [&](const std::function<void(vtkTemplateMapping*)>& change)
  {
    Mapping run;
    run.Filter->SetMethod(vtkTemplateMapping::PDM);
    run.Filter->SetIterations(2);
    change(run.Filter);
    run.On(skeleton, target);
    EXPECT_TRUE(run.Errors.empty());
    return run.Last("SquaredL2Error");
  };
  const double base = errorWith([](vtkTemplateMapping*) {});
  EXPECT_NE(errorWith([](auto* f) { f->SetMethod(vtkTemplateMapping::FIXED); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetMethod(vtkTemplateMapping::TDM); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetIterations(3); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetDegree(2); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetInnerKnots(5); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetTemplateSamples(50); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetNewtonSteps(0); }), base);
  EXPECT_NE(errorWith([](auto* f) { f->SetTikhonovWeight(0.5); }), base);
  EXPECT_EQ(errorWith([](auto* f) { f->SetThreads(1); }), base);
}

TEST(TemplateMappingFilter, CellsOfOnePatchAreJoined_CrossOracle)
{
  // The circle cut into 4 cells: with shared points, with points of their own, in between others.
  const Skeleton<2> whole = CircleTemplate(401);
  const auto skeleton = ToPolyData(whole);
  vtkNew<vtkPolyData> cut;
  cut->DeepCopy(skeleton);
  vtkNew<vtkCellArray> lines;
  vtkNew<vtkIntArray> ids;
  ids->SetName("PatchId");
  const auto piece = [&](int id, vtkIdType first, vtkIdType last)
  {
    lines->InsertNextCell(static_cast<int>(last - first + 1));
    for (vtkIdType p = first; p <= last; ++p)
    {
      lines->InsertCellPoint(p);
    }
    ids->InsertNextValue(id);
  };
  piece(0, 0, 400);
  piece(4, 1604, 1700);
  piece(1, 401, 801);
  piece(4, 1700, 1701);
  const vtkIdType twin = cut->GetPoints()->InsertNextPoint(cut->GetPoint(1701));
  vtkDataArray* normals = cut->GetPointData()->GetArray("Normals");
  normals->InsertNextTuple(1701, normals);
  lines->InsertNextCell({ twin, 1702, 1703 });
  ids->InsertNextValue(4);
  piece(2, 802, 1202);
  piece(3, 1203, 1603);
  piece(4, 1703, 2004);
  cut->SetLines(lines);
  cut->GetCellData()->AddArray(ids);

  Mapping plain;
  Mapping joined;
  for (Mapping* run : { &plain, &joined })
  {
    run->Filter->SetIterations(2);
    run->On(run == &plain ? skeleton.Get() : cut.Get(), ToPolyData(LobedTarget()));
    ASSERT_TRUE(run->Errors.empty()) << run->Errors[0];
  }
  EXPECT_EQ(joined.Mapped()->GetNumberOfPoints(), plain.Mapped()->GetNumberOfPoints());
  // The patches come in another order, so sums do too: rounding.
  EXPECT_NEAR(joined.Last("SquaredL2Error"), plain.Last("SquaredL2Error"),
    1e-9 * plain.Last("SquaredL2Error"));
}

TEST(TemplateMappingFilter, BadInputIsOneClearError)
{
  const auto good = ToPolyData(CircleTemplate(101));
  const auto goodTarget = ToPolyData(LobedTarget({}, 50));
  const auto expect = [](ErrorCode code, const std::string& words, vtkPolyData* templateData,
                        vtkPolyData* target, const std::function<void(vtkTemplateMapping*)>& set)
  {
    SCOPED_TRACE(words);
    Mapping run;
    set(run.Filter);
    run.On(templateData, target);
    std::vector<std::string> own; // the executive adds one of its own
    for (const std::string& error : run.Errors)
    {
      if (error.find("Algorithm vtkTemplateMapping") == std::string::npos)
      {
        own.push_back(error);
      }
    }
    ASSERT_EQ(own.size(), 1u);
    EXPECT_NE(own[0].find(words), std::string::npos) << own[0];
    EXPECT_EQ(run.Filter->GetErrorCode(), vtkErrorCode::UserError + static_cast<int>(code));
    EXPECT_EQ(run.Map()->GetNumberOfPoints(), 0);
    EXPECT_EQ(run.Mapped()->GetNumberOfPoints(), 0);
    EXPECT_EQ(run.Table()->GetNumberOfRows(), 0);
  };
  const auto nothing = [](vtkTemplateMapping*) {};
  const auto damaged = [](vtkPolyData* data, const std::function<void(vtkPolyData*)>& damage)
  {
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->DeepCopy(data);
    damage(copy);
    return copy;
  };
  vtkNew<vtkPolyData> empty;
  expect(ErrorCode::EmptyInput, "template has no patches", empty, goodTarget, nothing);
  expect(ErrorCode::EmptyInput, "target has no patches", good, empty, nothing);

  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  expect(ErrorCode::InvalidTopology, "faces", sphere->GetOutput(), goodTarget, nothing);

  auto bad = damaged(good, [](auto* d) { d->GetCellData()->RemoveArray("PatchId"); });
  expect(ErrorCode::InvalidTopology, "no cell array PatchId", bad, goodTarget, nothing);
  bad =
    damaged(goodTarget, [](auto* d) { d->GetCellData()->GetArray("PatchId")->SetTuple1(3, 9); });
  expect(ErrorCode::InvalidTopology, "target patches 9 have no patch", good, bad, nothing);
  bad =
    damaged(goodTarget, [](auto* d) { d->GetCellData()->GetArray("PatchId")->SetTuple1(3, 1); });
  expect(ErrorCode::InvalidTopology, "target patch 1 is open: cell 3 does not begin where cell 1",
    good, bad, nothing);
  bad = damaged(goodTarget,
    [](auto* d)
    {
      vtkNew<vtkDoubleArray> ids;
      ids->SetName("PatchId");
      for (double id : { 0.0, 1.0, 2.5, 3.0, 4.0 })
      {
        ids->InsertNextValue(id);
      }
      d->GetCellData()->AddArray(ids);
    });
  expect(ErrorCode::InvalidTopology, "PatchId of cell 2", good, bad, nothing);
  bad = damaged(goodTarget, [](auto* d) { d->GetPoints()->SetPoint(60, 1.0, 0.3, 0.01); });
  expect(ErrorCode::DimensionMismatch, "target patch 1, point 10 has z", good, bad, nothing);
  bad = damaged(goodTarget, [](auto* d) { d->GetPoints()->SetPoint(60, NAN, 0.3, 0.0); });
  expect(ErrorCode::NonFiniteInput, "target patch 1, point 10", good, bad, nothing);
  bad = damaged(goodTarget, [](auto* d) { d->GetPoints()->SetPoint(60, 1.0, 0.3, NAN); });
  expect(ErrorCode::NonFiniteInput, "target patch 1, point 10", good, bad, nothing);
  bad = damaged(
    goodTarget, [](auto* d) { d->GetPointData()->GetArray("Normals")->SetTuple3(7, 0, 0, 1); });
  expect(ErrorCode::DimensionMismatch, "target patch 0, normal 7", good, bad, nothing);
  bad = damaged(goodTarget,
    [](auto* d)
    {
      vtkNew<vtkDoubleArray> wrong;
      wrong->SetName("Parameter");
      wrong->SetNumberOfComponents(2);
      wrong->SetNumberOfTuples(d->GetNumberOfPoints());
      d->GetPointData()->AddArray(wrong);
    });
  expect(ErrorCode::SizeMismatch, "Parameter of the target has 2 components", good, bad, nothing);
  bad = damaged(goodTarget,
    [](auto* d)
    {
      vtkNew<vtkCellArray> lines;
      lines->InsertNextCell({ 0, 1, 2 });
      for (vtkIdType cell = 1; cell < 5; ++cell)
      {
        lines->InsertNextCell({ 50 * cell });
      }
      d->SetLines(lines);
    });
  expect(ErrorCode::InvalidTopology, "target patch 1 has 1 points", good, bad, nothing);
  bad = damaged(goodTarget,
    [](auto* d)
    {
      vtkNew<vtkCellArray> lines;
      lines->DeepCopy(d->GetLines());
      d->SetLines(lines);
      vtkNew<vtkPoints> few;
      few->InsertNextPoint(0, 0, 0);
      few->InsertNextPoint(1, 0, 0);
      d->SetPoints(few);
    });
  expect(ErrorCode::InvalidTopology, "has the point id 2 of 2", good, bad, nothing);

  expect(ErrorCode::InvalidParameter, "template samples", good, goodTarget,
    [](auto* f) { f->SetTemplateSamples(1); });
  expect(ErrorCode::SingularSystem, "Tikhonov", good, goodTarget,
    [](auto* f) { f->SetTikhonovWeight(0.0); });
}

TEST(TemplateMappingFilter, NothingOntoNothingIsNothing_ExactOracle)
{
  vtkNew<vtkPolyData> empty;
  Mapping run;
  run.On(empty, empty);
  EXPECT_TRUE(run.Errors.empty());
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 0);
}

TEST(TemplateMappingFilter, ReportsProgressAndAborts_PropertyOracle)
{
  Mapping run;
  std::vector<double> shares;
  vtkNew<vtkCallbackCommand> watch;
  watch->SetClientData(&shares);
  watch->SetCallback(
    [](vtkObject* filter, unsigned long, void* data, void* share)
    {
      auto* seen = static_cast<std::vector<double>*>(data);
      seen->push_back(*static_cast<double*>(share));
      if (seen->back() > 0.3)
      {
        vtkAlgorithm::SafeDownCast(filter)->SetAbortExecute(1);
      }
    });
  run.Filter->AddObserver(vtkCommand::ProgressEvent, watch);
  run.Filter->SetIterations(10);
  run.On(ToPolyData(CircleTemplate(101)), ToPolyData(LobedTarget({}, 50)));
  EXPECT_TRUE(run.Errors.empty());
  EXPECT_EQ(run.Map()->GetNumberOfCells(), 0);
  const auto beyond = [](double share) { return share > 0.3 && share < 1.0; };
  EXPECT_EQ(std::count_if(shares.begin(), shares.end(), beyond), 1);
}

TEST(TemplateMappingFilter, RunsAgainOnlyWhenSomethingChanged_PropertyOracle)
{
  Mapping run;
  run.On(ToPolyData(CircleTemplate(101)), ToPolyData(LobedTarget({}, 50)));
  const vtkMTimeType first = run.Map()->GetMTime();
  run.Filter->SetDegree(3);
  run.Filter->Update();
  EXPECT_EQ(run.Map()->GetMTime(), first);
  run.Filter->SetDegree(2);
  run.Filter->Update();
  EXPECT_GT(run.Map()->GetMTime(), first);
}

// The case as files, where the environment variable KNOTWORK_TEMPLATE_CASES names their folder.
TEST(TemplateMappingFilter, FiveLobesFromFiles_GoldenOracle)
{
  const char* folder = std::getenv("KNOTWORK_TEMPLATE_CASES");
  const std::string stem = std::string(folder ? folder : "") + "/flower5_";
  if (!folder || !std::ifstream(stem + "template.vtp"))
  {
    GTEST_SKIP() << "KNOTWORK_TEMPLATE_CASES names no folder with flower5_template.vtp";
  }
  vtkNew<vtkXMLPolyDataReader> skeleton;
  vtkNew<vtkXMLPolyDataReader> target;
  skeleton->SetFileName((stem + "template.vtp").c_str());
  target->SetFileName((stem + "target.vtp").c_str());
  skeleton->Update();
  target->Update();
  const double expected[3][2] = { { 3.530e-05, 1.59 }, { 1.985e-05, 0.483 }, { 8.715e-06, 0.0 } };
  for (int method = vtkTemplateMapping::FIXED; method <= vtkTemplateMapping::TDM; ++method)
  {
    Mapping run;
    run.Filter->SetMethod(method);
    run.Filter->GuardOff(); // as published
    run.On(skeleton->GetOutput(), target->GetOutput());
    EXPECT_NEAR(run.Last("SquaredL2Error"), expected[method][0], 0.03 * expected[method][0]);
    EXPECT_NEAR(
      run.Last("NegativeJacobianPercent"), expected[method][1], 0.03 * expected[method][1]);
  }
}
