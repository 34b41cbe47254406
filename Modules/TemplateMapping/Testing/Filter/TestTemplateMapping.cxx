// SPDX-License-Identifier: BSD-3-Clause
#include "../Kernel/SurfaceCases.h"
#include "../Kernel/TemplateCases.h"
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/TemplateMapping/TemplateMap.h>
#include <knotwork/TemplateMapping/vtkTemplateMapping.h>

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <gtest/gtest.h>

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

double FieldNumber(vtkDataObject* data, const char* name)
{
  vtkDataArray* array = data->GetFieldData()->GetArray(name);
  return array ? array->GetComponent(0, 0) : NAN;
}

std::string FieldText(vtkDataObject* data, const char* name)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  return array ? array->GetValue(0) : "none";
}

/// A sphere about (0.5, 0.5, 0.5), id 3, its points moved.
template <typename Move>
vtkSmartPointer<vtkPolyData> SphereData(int levels, const Move& move)
{
  const SkeletonPatch<3> sphere = cases::Sphere(levels);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < sphere.Points.rows(); ++i)
  {
    const Eigen::RowVector3d x = move(Eigen::RowVector3d(sphere.Points.row(i)));
    points->InsertNextPoint(x(0), x(1), x(2));
  }
  vtkNew<vtkCellArray> faces;
  vtkNew<vtkIntArray> ids;
  ids->SetName("PatchId");
  for (const auto& triangle : sphere.Simplices)
  {
    faces->InsertNextCell({ triangle[0], triangle[1], triangle[2] });
    ids->InsertNextValue(3);
  }
  data->SetPoints(points);
  data->SetPolys(faces);
  data->GetCellData()->AddArray(ids);
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

  const auto model = DecodeSplineModel(run.Map(), 0);
  ASSERT_TRUE(model) << model.Status.Message();
  ASSERT_EQ(model->Patches.size(), 1u);
  const auto& map = std::get<Spline<2>>(model->Patches[0].Geometry);
  EXPECT_EQ(map.ControlPoints.leftCols(2), expected->Map.ControlPoints);
  EXPECT_EQ(map.ControlPoints.col(2).cwiseAbs().maxCoeff(), 0.0);
  const auto expectCells = [&](const char* name, const std::vector<double>& values)
  {
    vtkDataArray* array = run.Map()->GetCellData()->GetArray(name);
    ASSERT_TRUE(array) << name;
    for (std::size_t e = 0; e < values.size(); ++e)
    {
      EXPECT_EQ(array->GetComponent(model->Patches[0].Cells[e], 0), values[e]) << name;
    }
  };
  expectCells("MaxError", expected->ElementErrors);
  expectCells("JacobianMinLower", expected->ElementMinJacobian);
  expectCells("JacobianMaxUpper", expected->ElementMaxJacobian);
  EXPECT_EQ(FieldNumber(run.Map(), "MinJacobianBound"), expected->MinJacobianBound);
  EXPECT_EQ(FieldText(run.Map(), "Injective"), ToString(expected->Injectivity.Verdict));
  EXPECT_EQ(FieldText(run.Map(), "InjectivityReason"), ToString(expected->Injectivity.Reason));

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
    EXPECT_EQ(value("StepLength"), record.StepLength);
    EXPECT_EQ(value("HeldElements"), record.HeldElements);
    EXPECT_EQ(value("Functions"), record.Functions);
    EXPECT_EQ(run.Table()->GetColumnByName("Seconds"), nullptr); // measured: no output has them
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

TEST(TemplateMappingFilter, EveryPropertyReachesTheKernel_CrossOracle)
{
  using F = vtkTemplateMapping;
  using P = TemplateMapParams<2>;
  struct Change
  {
    const char* Name;
    std::function<void(F*)> Set;
    std::function<void(P&)> Expect;
  };
  const auto skewed = [](F* f)
  {
    f->SetMethod(F::FIXED);
    f->GuardOff();
  };
  const auto skewedParams = [](P& p)
  {
    p.Method = TemplateMapMethod::Fixed;
    p.Guard = false;
  };
  const auto local = [](F* f) { f->SetRefinement(F::LOCAL); };
  const auto localParams = [](P& p) { p.Refinement = TemplateRefinement::Local; };
  // In groups: the first of each is what the others of it change.
  const std::vector<std::vector<Change>> groups = {
    {
      { "nothing", [](F*) {}, [](P&) {} },
      { "Method fixed", [](F* f) { f->SetMethod(F::FIXED); },
        [](P& p) { p.Method = TemplateMapMethod::Fixed; } },
      { "Method pdm", [](F* f) { f->SetMethod(F::PDM); },
        [](P& p) { p.Method = TemplateMapMethod::Pdm; } },
      { "Iterations", [](F* f) { f->SetIterations(3); }, [](P& p) { p.Iterations = 3; } },
      { "Degree", [](F* f) { f->SetDegree(2); }, [](P& p) { p.Degree = 2; } },
      { "InnerKnots", [](F* f) { f->SetInnerKnots(5); },
        [](P& p) {
          p.InnerKnots = { 5, 5 };
        } },
      { "InnerKnotsPerDirection", [](F* f) { f->SetInnerKnotsPerDirection(0, -1, 7); },
        [](P& p) {
          p.InnerKnots = { 0, 11 };
        } },
      { "TemplateSamples", [](F* f) { f->SetTemplateSamples(50); },
        [](P& p) { p.TemplateSamples = 50; } },
      { "NewtonSteps", [](F* f) { f->SetNewtonSteps(0); }, [](P& p) { p.NewtonSteps = 0; } },
      { "TikhonovWeight", [](F* f) { f->SetTikhonovWeight(0.5); },
        [](P& p) { p.TikhonovWeight = 0.5; } },
      { "UniformityWeight", [](F* f) { f->SetUniformityWeight(1e-4); },
        [](P& p) { p.UniformityWeight = 1e-4; } },
      { "LengthWeight", [](F* f) { f->SetLengthWeight(1e-2); },
        [](P& p) { p.LengthWeight = 1e-2; } },
      { "OrthogonalityWeight", [](F* f) { f->SetOrthogonalityWeight(1e-2); },
        [](P& p) { p.OrthogonalityWeight = 1e-2; } },
      { "SkewnessWeight", [](F* f) { f->SetSkewnessWeight(1e-2); },
        [](P& p) { p.SkewnessWeight = 1e-2; } },
      { "EccentricityWeight", [](F* f) { f->SetEccentricityWeight(1e-5); },
        [](P& p) { p.EccentricityWeight = 1e-5; } },
      { "AreaWeight", [](F* f) { f->SetAreaWeight(1e-2); }, [](P& p) { p.AreaWeight = 1e-2; } },
      { "SelfIntersectionWeight", [](F* f) { f->SetSelfIntersectionWeight(1e-5); },
        [](P& p) { p.SelfIntersectionWeight = 1e-5; } },
      { "Accuracy", [](F* f) { f->SetAccuracy(0.02); }, [](P& p) { p.Accuracy = 0.02; } },
      { "InitialMap", [](F* f) { f->SetInitialMap(F::MOVED); },
        [](P& p) { p.Start = TemplateInitialMap::Moved; } },
      { "InitialMap quadratic", [](F* f) { f->SetInitialMap(F::QUADRATIC); },
        [](P& p) { p.Start = TemplateInitialMap::Quadratic; } },
      { "InitialUniformityWeight",
        [](F* f)
        {
          f->SetInitialMap(F::QUADRATIC);
          f->SetInitialUniformityWeight(10.0);
        },
        [](P& p)
        {
          p.Start = TemplateInitialMap::Quadratic;
          p.InitialUniformityWeight = 10.0;
        } },
      { "Domain",
        [](F* f)
        {
          f->UseDomainOn();
          f->SetDomain(-1.0, 2.0, -0.5, 1.5, 7.0, 8.0);
        },
        [](P& p) {
          p.Domain = ParametricBox<2>{ { -1.0, -0.5 }, { 2.0, 1.5 } };
        } },
      { "Refinement global",
        [](F* f)
        {
          f->SetRefinement(F::GLOBAL);
          f->SetIterations(2);
        },
        [](P& p)
        {
          p.Refinement = TemplateRefinement::Global;
          p.Iterations = 2;
        } },
      { "Refinement local", local, localParams },
    },
    {
      { "weighted", [](F* f) { f->SetMethod(F::WEIGHTED); },
        [](P& p) { p.Method = TemplateMapMethod::Weighted; } },
      { "PdmWeight",
        [](F* f)
        {
          f->SetMethod(F::WEIGHTED);
          f->SetPdmWeight(0.1);
        },
        [](P& p)
        {
          p.Method = TemplateMapMethod::Weighted;
          p.PdmWeight = 0.1;
        } },
      { "TdmWeight",
        [](F* f)
        {
          f->SetMethod(F::WEIGHTED);
          f->SetTdmWeight(0.1);
        },
        [](P& p)
        {
          p.Method = TemplateMapMethod::Weighted;
          p.TdmWeight = 0.1;
        } },
    },
    {
      { "without the guard", skewed, skewedParams },
      { "Guard", [](F* f) { f->SetMethod(F::FIXED); },
        [](P& p) { p.Method = TemplateMapMethod::Fixed; } },
      { "Refinement held",
        [](F* f)
        {
          f->SetMethod(F::FIXED);
          f->SetRefinement(F::HELD);
          f->SetMaxLevel(1);
        },
        [](P& p)
        {
          p.Method = TemplateMapMethod::Fixed;
          p.Refinement = TemplateRefinement::Held;
          p.MaxLevel = 1;
        } },
      { "MaxIrregularShare",
        [&](F* f)
        {
          skewed(f);
          f->SetMaxIrregularShare(0.0);
        },
        [&](P& p)
        {
          skewedParams(p);
          p.MaxIrregularShare = 0.0;
        } },
    },
    {
      { "local", local, localParams },
      { "RefineEvery",
        [&](F* f)
        {
          local(f);
          f->SetRefineEvery(2);
        },
        [&](P& p)
        {
          localParams(p);
          p.RefineEvery = 2;
        } },
      { "RefineThreshold",
        [&](F* f)
        {
          local(f);
          f->SetRefineThreshold(1e-2);
        },
        [&](P& p)
        {
          localParams(p);
          p.RefineThreshold = 1e-2;
        } },
      { "RefineShare",
        [&](F* f)
        {
          local(f);
          f->SetRefineShare(0.01);
        },
        [&](P& p)
        {
          localParams(p);
          p.RefineShare = 0.01;
        } },
      { "Extension",
        [&](F* f)
        {
          local(f);
          f->SetExtension(3);
        },
        [&](P& p)
        {
          localParams(p);
          p.Extension = 3;
        } },
      { "MaxLevel",
        [&](F* f)
        {
          local(f);
          f->SetMaxLevel(0);
        },
        [&](P& p)
        {
          localParams(p);
          p.MaxLevel = 0;
        } },
      { "MaxFunctions",
        [&](F* f)
        {
          local(f);
          f->SetMaxFunctions(230);
        },
        [&](P& p)
        {
          localParams(p);
          p.MaxFunctions = 230;
        } },
    },
    {
      { "at stagnation",
        [&](F* f)
        {
          local(f);
          f->SetRefineEvery(0);
        },
        [&](P& p)
        {
          localParams(p);
          p.RefineEvery = 0;
        } },
      { "StagnationRatio",
        [&](F* f)
        {
          local(f);
          f->SetRefineEvery(0);
          f->SetStagnationRatio(0.999);
        },
        [&](P& p)
        {
          localParams(p);
          p.RefineEvery = 0;
          p.StagnationRatio = 0.999;
        } },
    },
  };
  const Skeleton<2> skeleton = CircleTemplate(301);
  Skeleton<2> target = LobedTarget();
  for (SkeletonPatch<2>& patch : target)
  {
    patch.Normals = UnitNormals(patch);
  }
  const auto templateData = ToPolyData(skeleton);
  const auto targetData = ToPolyData(target);
  for (const std::vector<Change>& group : groups)
  {
    std::vector<PointMatrix> maps;
    for (const Change& change : group)
    {
      SCOPED_TRACE(change.Name);
      TemplateMapParams<2> params;
      params.Iterations = 4;
      change.Expect(params);
      const auto expected = MapTemplate(skeleton, target, params);
      ASSERT_TRUE(expected) << expected.Status.Message();
      Mapping run;
      run.Filter->SetIterations(4);
      change.Set(run.Filter);
      run.On(templateData, targetData);
      ASSERT_TRUE(run.Errors.empty()) << run.Errors[0];
      EXPECT_EQ(run.Table()->GetNumberOfRows(), static_cast<vtkIdType>(expected->History.size()));
      const auto model = DecodeSplineModel(run.Map(), 0);
      const auto& map = std::get<Spline<2>>(model->Patches[0].Geometry);
      EXPECT_EQ(PointMatrix(map.ControlPoints.leftCols(2)), expected->Map.ControlPoints);
      maps.push_back(expected->Map.ControlPoints);
      EXPECT_TRUE(
        maps.size() == 1 || maps.back().rows() != maps[0].rows() || maps.back() != maps[0])
        << "no effect";
    }
  }
}

TEST(TemplateMappingFilter, InjectivityIsLeftOutWhenNotAskedFor_ExactOracle)
{
  Mapping run;
  run.Filter->SetIterations(1);
  run.Filter->InjectivityOff();
  run.On(ToPolyData(CircleTemplate(301)), ToPolyData(LobedTarget()));
  EXPECT_EQ(FieldText(run.Map(), "Injective"), "none");
  run.Filter->InjectivityOn();
  run.Filter->Update();
  EXPECT_EQ(FieldText(run.Map(), "Injective"), "injective");
}

TEST(TemplateMappingFilter, SkewedTargetsStayRegular_CrossOracle)
{
  const auto skeleton = ToPolyData(CircleTemplate(2001));
  const auto target = ToPolyData(LobedTarget({ 0.3, 6, 0.8, 0.0 }));
  double errors[2];
  for (const bool guard : { false, true })
  {
    Mapping run;
    run.Filter->SetGuard(guard);
    run.On(skeleton, target);
    ASSERT_TRUE(run.Errors.empty()) << run.Errors[0];
    errors[guard] = run.Last("SquaredL2Error");
    EXPECT_EQ(run.Last("NegativeJacobianPercent") == 0.0, guard);
    EXPECT_EQ(FieldNumber(run.Map(), "MinJacobianBound") > 0.0, guard);
    EXPECT_EQ(FieldText(run.Map(), "Injective") == "injective", guard);
    vtkNew<vtkJacobianValidator> validator; // reads the encoded map
    validator->SetInputConnection(run.Filter->GetOutputPort());
    validator->Update();
    EXPECT_EQ(validator->GetVerdict() == 1, guard);
  }
  EXPECT_LE(errors[1], errors[0]);
}

TEST(TemplateMappingFilter, AGivenMapIsContinued_PropertyOracle)
{
  const auto skeleton = ToPolyData(CircleTemplate(1001));
  const auto target = ToPolyData(LobedTarget());
  Mapping first;
  first.Filter->SetIterations(5);
  first.Filter->SetDegree(2);
  first.On(skeleton, target);
  Mapping second;
  second.Filter->SetIterations(3);
  second.Filter->SetInitialMapConnection(first.Filter->GetOutputPort());
  second.On(skeleton, target);
  ASSERT_TRUE(second.Errors.empty()) << second.Errors[0];
  EXPECT_EQ(second.Last("Functions"), 14 * 14); // of degree 2, as given
  EXPECT_LT(second.Last("SquaredL2Error"), first.Last("SquaredL2Error"));
}

TEST(TemplateMappingFilter, ASphereIsCarriedOntoAnEgg_PropertyOracle)
{
  const auto same = [](const Eigen::RowVector3d& x) { return x; };
  const auto egg = [](const Eigen::RowVector3d& x)
  {
    return Eigen::RowVector3d(
      0.1 + 0.8 * x(0), 0.5 + (1.2 + 0.4 * (x(0) - 0.5)) * (x(1) - 0.5), x(2) + 0.1 * x(0));
  };
  for (const int refinement : { vtkTemplateMapping::NONE, vtkTemplateMapping::LOCAL })
  {
    Mapping run;
    run.Filter->SetInnerKnots(2);
    run.Filter->SetIterations(3);
    run.Filter->SetRefinement(refinement);
    run.Filter->SetExtension(0);
    run.Filter->UseDomainOn();
    run.On(SphereData(3, same), SphereData(3, egg));
    ASSERT_TRUE(run.Errors.empty()) << run.Errors[0];
    EXPECT_LT(run.Last("SquaredL2Error"), 1e-3);
    EXPECT_EQ(run.Last("NegativeJacobianPercent"), 0.0);
    EXPECT_GT(FieldNumber(run.Map(), "MinJacobianBound"), 0.0);
    EXPECT_EQ(FieldText(run.Map(), "Injective"), "injective");
    EXPECT_EQ(run.Last("Functions") > 216, refinement == vtkTemplateMapping::LOCAL);
    EXPECT_EQ(run.Map()->GetCellType(0), VTK_BEZIER_HEXAHEDRON);
    EXPECT_EQ(run.Mapped()->GetNumberOfLines(), 0);
    EXPECT_GE(run.Mapped()->GetNumberOfPolys(), 512);
    vtkDataArray* distance = run.Mapped()->GetPointData()->GetArray("Distance");
    ASSERT_TRUE(distance);
    EXPECT_LE(distance->GetRange()[1], run.Last("MaxError") * (1 + 1e-12));
    double bounds[6];
    run.Map()->GetCellData()->GetArray("ParametricBounds")->GetTuple(0, bounds);
    EXPECT_EQ(bounds[0], 0.0); // of the given box, which is larger than the sphere's
  }
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

  expect(ErrorCode::InvalidTopology, "curves", good, SphereData(1, [](const auto& x) { return x; }),
    nothing);

  const auto withMap = [](vtkDataObject* map)
  { return [map](vtkTemplateMapping* f) { f->SetInitialMapData(map); }; };
  Mapping mapping;
  mapping.Filter->SetIterations(1);
  vtkUnstructuredGrid* map = mapping.On(good, goodTarget).Map();
  const auto damagedMap = [&](const std::function<void(SplineModel&)>& damage)
  {
    SplineModel model = DecodeSplineModel(map, 0).Value;
    damage(model);
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    EXPECT_TRUE(EncodeSplineGrid(model, grid));
    return grid;
  };
  const auto spline = [](SplineModel& model) -> Spline<2>&
  { return std::get<Spline<2>>(model.Patches[0].Geometry); };
  vtkNew<vtkUnstructuredGrid> none;
  expect(ErrorCode::InvalidTopology, "initial map has 0 patches", good, goodTarget, withMap(none));
  auto badMap = damagedMap(
    [](auto& model)
    {
      model.Patches.push_back(model.Patches[0]);
      model.Patches[1].Id = 7;
    });
  expect(
    ErrorCode::InvalidTopology, "initial map has 2 patches", good, goodTarget, withMap(badMap));
  badMap = damagedMap([&](auto& model) { spline(model).ControlPoints(5, 2) = 0.1; });
  expect(ErrorCode::DimensionMismatch, "control point 5 of the initial map has z", good, goodTarget,
    withMap(badMap));
  badMap = damagedMap([&](auto& model)
    { spline(model).Weights = Eigen::VectorXd::Ones(spline(model).ControlPoints.rows()); });
  expect(ErrorCode::DimensionMismatch, "polynomial", good, goodTarget, withMap(badMap));
  badMap = damagedMap([&](auto& model) { spline(model).ControlPoints.col(0) *= -1.0; });
  expect(ErrorCode::InvalidParameter, "initial map has folds", good, goodTarget, withMap(badMap));
  vtkNew<vtkUnstructuredGrid> nanMap;
  nanMap->DeepCopy(map);
  nanMap->GetPoints()->SetPoint(3, NAN, 0.0, 0.0);
  expect(ErrorCode::NonFiniteInput, "initial map", good, goodTarget, withMap(nanMap));
  {
    Mapping cube;
    cube.Filter->SetInnerKnots(0);
    cube.Filter->SetIterations(1);
    const auto ball = SphereData(1, [](const auto& x) { return x; });
    expect(ErrorCode::DimensionMismatch, "does not have 2 parameters", good, goodTarget,
      withMap(cube.On(ball, ball).Map()));
    expect(ErrorCode::DimensionMismatch, "does not have 3 parameters", ball, ball, withMap(map));
  }

  const auto withDomain = [](std::array<double, 4> box)
  {
    return [box](vtkTemplateMapping* f)
    {
      f->UseDomainOn();
      f->SetDomain(box[0], box[1], box[2], box[3], 0.0, 0.0);
    };
  };
  expect(ErrorCode::InvalidParameter, "outside the domain in direction 1", good, goodTarget,
    withDomain({ 0, 1, 0.5, 1 }));
  expect(ErrorCode::InvalidParameter, "domain is empty in direction 0", good, goodTarget,
    withDomain({ 1, 0, 0, 1 }));
  expect(ErrorCode::InvalidParameter, "domain is empty in direction 1", good, goodTarget,
    withDomain({ 0, 1, 0, NAN }));
  expect(ErrorCode::InvalidParameter, "both 0", good, goodTarget,
    [](auto* f)
    {
      f->SetMethod(vtkTemplateMapping::WEIGHTED);
      f->SetPdmWeight(0.0);
      f->SetTdmWeight(0.0);
    });
  expect(ErrorCode::InvalidParameter, "uniformity weight", good, goodTarget,
    [](auto* f) { f->SetUniformityWeight(NAN); });
  expect(ErrorCode::InvalidParameter, "inner knots", good, goodTarget,
    [](auto* f) { f->SetInnerKnotsPerDirection(-2, 3, 3); });
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
  const auto same = [](const Eigen::RowVector3d& x) { return x; };
  const auto wide = [](const Eigen::RowVector3d& x)
  { return Eigen::RowVector3d(x(0), 1.2 * x(1), x(2)); };
  for (const bool inSpace : { false, true })
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
    run.Filter->SetInnerKnots(2);
    run.Filter->SetRefinement(vtkTemplateMapping::LOCAL);
    run.On(inSpace ? SphereData(2, same) : ToPolyData(CircleTemplate(101)),
      inSpace ? SphereData(2, wide) : ToPolyData(LobedTarget({}, 50)));
    EXPECT_TRUE(run.Errors.empty());
    EXPECT_EQ(run.Map()->GetNumberOfCells(), 0);
    EXPECT_EQ(run.Mapped()->GetNumberOfCells(), 0);
    EXPECT_EQ(run.Table()->GetNumberOfRows(), 0);
    const auto beyond = [](double share) { return share > 0.3 && share < 1.0; };
    EXPECT_EQ(std::count_if(shares.begin(), shares.end(), beyond), 1);
  }
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

vtkSmartPointer<vtkPolyData> ThroughAFile(vtkPolyData* data, const std::string& name)
{
  const std::string file = std::string(KNOTWORK_OUTPUT_DIR) + "/" + name;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(file.c_str());
  EXPECT_EQ(writer->Write(), 1);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutput();
}

// The published case, with its numbers of samples, as files.
TEST(TemplateMappingFilter, FiveLobesFromFiles_GoldenOracle)
{
  const auto skeleton = ThroughAFile(ToPolyData(CircleTemplate(10001)), "flower5_template.vtp");
  const auto target = ThroughAFile(ToPolyData(LobedTarget()), "flower5_target.vtp");
  const double expected[3][2] = { { 3.530e-05, 1.59 }, { 1.985e-05, 0.483 }, { 8.715e-06, 0.0 } };
  for (int method = vtkTemplateMapping::FIXED; method <= vtkTemplateMapping::TDM; ++method)
  {
    // As published; where nothing folds the guard changes nothing.
    for (const bool guard : { false, true })
    {
      Mapping run;
      run.Filter->SetMethod(method);
      run.Filter->SetGuard(guard);
      run.On(skeleton, target);
      if (!guard || method == vtkTemplateMapping::TDM)
      {
        EXPECT_NEAR(run.Last("SquaredL2Error"), expected[method][0], 0.03 * expected[method][0]);
        EXPECT_NEAR(
          run.Last("NegativeJacobianPercent"), expected[method][1], 0.03 * expected[method][1]);
      }
      EXPECT_TRUE(!guard || FieldNumber(run.Map(), "MinJacobianBound") > 0.0);
    }
  }
  for (const int extension : { 1, 2 })
  {
    Mapping run;
    run.Filter->SetRefinement(vtkTemplateMapping::LOCAL);
    run.Filter->SetRefineThreshold(5e-6);
    run.Filter->SetExtension(extension);
    run.Filter->SetIterations(8);
    run.On(skeleton, target);
    EXPECT_LE(run.Last("SquaredL2Error"), 7.3e-11); // of global refinement to 9801 functions
    EXPECT_LE(run.Last("Functions"), 980);
    EXPECT_EQ(run.Last("NegativeJacobianPercent"), 0.0);
    EXPECT_GT(FieldNumber(run.Map(), "MinJacobianBound"), 0.0);
  }
}
