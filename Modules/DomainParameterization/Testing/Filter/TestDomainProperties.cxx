// SPDX-License-Identifier: BSD-3-Clause
// Every property of the filter reaches the kernel: the filter with the property set ends where the
// kernel with its own option ends, number by number, and elsewhere than with the default.
#include "DomainCases.h"
#include <knotwork/DomainParameterization/DomainParameterization.h>
#include <knotwork/DomainParameterization/OutlineCurves.h>
#include <knotwork/DomainParameterization/vtkDomainParameterization.h>
#include <knotwork/SplineIO/vtkDomainBoundaryReader.h>

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using knotwork::DomainBoundary;
using knotwork::DomainParams;
using knotwork::Spline;
using Filter = vtkDomainParameterization;

/// A deep bite under a low roof: the Coons map folds.
DomainBoundary<2> Low()
{
  DomainBoundary<2> boundary = knotwork::cases::Square();
  for (Spline<1>& side : boundary.Sides)
  {
    side.ControlPoints.col(1) *= 1.2;
  }
  boundary.Sides[0] = knotwork::ElevateDegree<1>(boundary.Sides[0], 0, 2).Value;
  boundary.Sides[2] = knotwork::cases::Curve(knotwork::KnotVector::Uniform(3, 4),
    { { 0, 0 }, { 0.7, 0.1 }, { 0.1, 0.7 }, { 0.5, 1.1 }, { 0.9, 0.7 }, { 0.3, 0.1 }, { 1, 0 } });
  return boundary;
}

/// No inner control points: refined, or no valid map.
DomainBoundary<2> Poor()
{
  return knotwork::cases::Bite(0.4, 0.5, 0.5, 1);
}

/// Arcs on the south side.
DomainBoundary<2> Rational()
{
  return knotwork::cases::Bite(0.4, 0.5, 1.2, 3);
}

/// A square whose east side ends 1e-6 away from the corner.
DomainBoundary<2> Open()
{
  DomainBoundary<2> boundary = knotwork::cases::Square();
  boundary.Sides[1].ControlPoints(1, 1) += 1e-6;
  return boundary;
}

void Write(const DomainBoundary<2>& boundary, const std::string& name)
{
  std::ofstream file(name);
  file.precision(17);
  file << "{\"curves\": [";
  for (std::size_t s = 0; s < boundary.Sides.size(); ++s)
  {
    const Spline<1>& side = boundary.Sides[s];
    const knotwork::KnotVector& knots = side.Space->Knots[0];
    file << (s ? ", " : "") << "{\"degree\": " << knots.Degree() << ", \"knots\": [";
    for (std::size_t i = 0; i < knots.Knots().size(); ++i)
    {
      file << (i ? ", " : "") << knots.Knots()[i];
    }
    file << "], \"control_points\": [";
    for (Eigen::Index i = 0; i < side.ControlPoints.rows(); ++i)
    {
      file << (i ? ", [" : "[") << side.ControlPoints(i, 0) << ", " << side.ControlPoints(i, 1)
           << "]";
    }
    file << "]";
    for (Eigen::Index i = 0; i < side.Weights.size(); ++i)
    {
      file << (i ? ", " : ", \"weights\": [") << side.Weights[i];
    }
    file << (side.IsRational() ? "]}" : "}");
  }
  file << "]}";
}

/// What a run says of itself, number by number.
using Trace = std::vector<double>;

Trace OfKernel(const DomainBoundary<2>& boundary, const DomainParams& params)
{
  const auto result = knotwork::ParameterizeDomain<2>(boundary, params);
  if (!result)
  {
    return {};
  }
  Trace trace{ result->MinDetLower, result->MinDetUpper, result->Metrics.MinDetOverArea,
    result->Metrics.MeanConditionNumber, double(result->Iterations),
    double(result->Map.Space->NumFunctions), double(result->Stop) };
  for (const auto& row : result->History)
  {
    trace.push_back(row.Energy);
    trace.push_back(row.GradientNorm);
  }
  return trace;
}

Trace OfFilter(Filter* filter)
{
  filter->Update();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  if (grid->GetNumberOfCells() == 0)
  {
    return {};
  }
  vtkFieldData* data = grid->GetFieldData();
  Trace trace;
  for (const char* name : { "JacobianMinLower", "JacobianMinUpper", "MinDetOverArea",
         "MeanConditionNumber", "Iterations", "Functions" })
  {
    trace.push_back(data->GetArray(name)->GetTuple1(0));
  }
  const std::string stopped =
    vtkStringArray::SafeDownCast(data->GetAbstractArray("Stopped"))->GetValue(0);
  trace.push_back(stopped == "finished" ? 0 : stopped == "effort" ? 1 : 2);
  auto* table = vtkTable::SafeDownCast(filter->GetOutputDataObject(2));
  for (vtkIdType i = 0; i < table->GetNumberOfRows(); ++i)
  {
    trace.push_back(table->GetValueByName(i, "Energy").ToDouble());
    trace.push_back(table->GetValueByName(i, "GradientNorm").ToDouble());
  }
  return trace;
}

struct Property
{
  const char* Name;
  DomainBoundary<2> (*Boundary)();
  std::function<void(Filter*, DomainParams&)> Before; ///< so that the property matters
  std::function<void(Filter*)> Set;
  std::function<void(DomainParams&)> Option;
};

void Folding(Filter* filter, DomainParams& params)
{
  filter->SetInitialMap(Filter::COONS);
  params.InitialMap = knotwork::InitialMapMethod::Coons;
}
void Relu(Filter* filter, DomainParams& params)
{
  Folding(filter, params);
  filter->SetFoldover(Filter::RELU);
  params.Foldover = knotwork::FoldoverRemoval::Relu;
}
void Weighted(Filter* filter, DomainParams& params)
{
  filter->SetWeights(Filter::WEIGHTS_OPTIMIZED);
  params.Weights = knotwork::WeightMode::Optimized;
}
void Nothing(Filter*, DomainParams&) {}

std::vector<Property> Properties()
{
  using P = DomainParams;
  return {
    { "InitialMap", Low, Nothing, [](Filter* f) { f->SetInitialMap(Filter::HARMONIC); },
      [](P& p) { p.InitialMap = knotwork::InitialMapMethod::Harmonic; } },
    { "InitialMap variational", Low, Nothing,
      [](Filter* f) { f->SetInitialMap(Filter::VARIATIONAL_HARMONIC); },
      [](P& p) { p.InitialMap = knotwork::InitialMapMethod::VariationalHarmonic; } },
    { "InitialWeights", Rational, Nothing, [](Filter* f) { f->SetInitialWeights(Filter::ONES); },
      [](P& p) { p.FirstWeights = knotwork::InitialWeights::Ones; } },
    { "Optimizer", Low, Nothing, [](Filter* f) { f->SetOptimizer(Filter::NEWTON); },
      [](P& p) { p.Optimizer = knotwork::DomainOptimizer::Newton; } },
    { "Foldover", Low, Folding, [](Filter* f) { f->SetFoldover(Filter::PENALTY); },
      [](P& p) { p.Foldover = knotwork::FoldoverRemoval::Penalty; } },
    { "Weights", Low, Nothing, [](Filter* f) { f->SetWeights(Filter::WEIGHTS_OPTIMIZED); },
      [](P& p) { p.Weights = knotwork::WeightMode::Optimized; } },
    { "Objective", Low, Nothing, [](Filter* f) { f->SetObjective(Filter::LEAST_JACOBIAN); },
      [](P& p) { p.Objective = knotwork::DomainObjective::LeastJacobian; } },
    { "Effort", Low, Nothing, [](Filter* f) { f->SetEffort(1e-4); },
      [](P& p) { p.Effort = 1e-4; } },
    { "TimeLimit", Low, Nothing, [](Filter* f) { f->SetTimeLimit(1e-9); },
      [](P& p) { p.TimeLimit = 1e-9; } },
    { "FoldoverMargin", Low, Relu, [](Filter* f) { f->SetFoldoverMargin(0.2); },
      [](P& p) { p.FoldoverMargin = 0.2; } },
    { "WinslowEpsilon", Low, Nothing, [](Filter* f) { f->SetWinslowEpsilon(0.1); },
      [](P& p) { p.WinslowEpsilon = 0.1; } },
    { "AlternationTolerance", Low, Weighted, [](Filter* f) { f->SetAlternationTolerance(1e3); },
      [](P& p) { p.AlternationTolerance = 1e3; } },
    { "UniformityWeight", Low, Nothing, [](Filter* f) { f->SetUniformityWeight(7.0); },
      [](P& p) { p.UniformityWeight = 7.0; } },
    { "MaximumIterations", Low, Nothing, [](Filter* f) { f->SetMaximumIterations(3); },
      [](P& p) { p.MaxIterations = 3; } },
    { "EnergyTolerance", Low, Nothing, [](Filter* f) { f->SetEnergyTolerance(0.1); },
      [](P& p) { p.EnergyTolerance = 0.1; } },
    { "MaximumAlternations", Low, Weighted, [](Filter* f) { f->SetMaximumAlternations(1); },
      [](P& p) { p.MaxAlternations = 1; } },
    { "MaximumRefinements", Poor, Nothing, [](Filter* f) { f->SetMaximumRefinements(0); },
      [](P& p) { p.MaxRefinements = 0; } },
    { "GapTolerance", Open, Nothing, [](Filter* f) { f->SetGapTolerance(1e-3); },
      [](P& p) { p.GapTolerance = 1e-3; } },
    { "MetricSamples", Low, Nothing, [](Filter* f) { f->SetMetricSamples(2); },
      [](P& p) { p.MetricSamples = 2; } },
    { "CertificateGap", Low, Nothing, [](Filter* f) { f->SetCertificateGap(1e-9); },
      [](P& p) { p.CertificateGap = 1e-9; } },
    { "MaximumFunctions", Low, Nothing, [](Filter* f) { f->SetMaximumFunctions(3); },
      [](P& p) { p.MaxFunctions = 3; } },
  };
}

class DomainProperties : public testing::TestWithParam<int>
{
};

TEST_P(DomainProperties, ReachTheKernel_CrossOracle)
{
  const Property property = Properties()[static_cast<std::size_t>(GetParam())];
  SCOPED_TRACE(property.Name);
  const DomainBoundary<2> boundary = property.Boundary();
  const std::string name =
    std::string(KNOTWORK_OUTPUT_DIR) + "/domain_property_" + property.Name + ".json";
  Write(boundary, name);
  vtkNew<vtkDomainBoundaryReader> reader;
  reader->SetFileName(name.c_str());
  vtkNew<vtkDomainParameterization> filter;
  filter->SetInputConnection(reader->GetOutputPort());
  // errors and warnings are looked at elsewhere
  filter->AddObserver(vtkCommand::ErrorEvent, vtkNew<vtkCallbackCommand>().Get());
  filter->AddObserver(vtkCommand::WarningEvent, vtkNew<vtkCallbackCommand>().Get());
  filter->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, vtkNew<vtkCallbackCommand>().Get());
  DomainParams params;
  property.Before(filter, params);
  const Trace usual = OfKernel(boundary, params);
  EXPECT_EQ(OfFilter(filter), usual);
  property.Set(filter);
  property.Option(params);
  const Trace changed = OfKernel(boundary, params);
  EXPECT_NE(changed, usual) << "the option changes nothing here";
  EXPECT_EQ(OfFilter(filter), changed);
}

INSTANTIATE_TEST_SUITE_P(
  All, DomainProperties, testing::Range(0, static_cast<int>(Properties().size())));

TEST(DomainPropertiesOfOutlines, ReachTheKernel_CrossOracle)
{
  // a square with a bite of 45 degrees, shaken
  knotwork::PointMatrix line(401, 2);
  std::mt19937 random(11);
  std::normal_distribution<double> shake(0.0, 2e-4);
  const std::array<std::array<double, 2>, 6> corners{ { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0.6, 1 },
    { 0.5, 0.9 }, { 0, 0.9 } } };
  for (Eigen::Index i = 0; i < line.rows(); ++i)
  {
    const double at = 6.0 * static_cast<double>(i % 400) / 400.0;
    const auto side = static_cast<std::size_t>(at);
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double from = corners[side][d];
      line(i, static_cast<Eigen::Index>(d)) = from +
        (at - static_cast<double>(side)) * (corners[(side + 1) % 6][d] - from) + shake(random);
    }
  }
  line(400, 0) = line(0, 0);
  line(400, 1) = line(0, 1);
  vtkNew<vtkPoints> points;
  vtkNew<vtkPolyData> drawn; // points alone: in drawing order
  points->SetDataTypeToDouble();
  for (Eigen::Index i = 0; i < line.rows(); ++i)
  {
    points->InsertNextPoint(line(i, 0), line(i, 1), 0.5);
  }
  drawn->SetPoints(points);
  knotwork::OutlineParams coarse;
  coarse.Tolerance = 0.02;
  knotwork::OutlineParams blunt;
  blunt.CornerAngle = 80.0;
  knotwork::OutlineParams wide;
  wide.CornerWindow = 0.2; // more than the bite
  std::vector<std::string> results;
  for (const knotwork::OutlineParams& params : { knotwork::OutlineParams(), coarse, blunt, wide })
  {
    const auto outline = knotwork::FitOutline({ line }, params);
    ASSERT_TRUE(outline) << outline.Status.Detail;
    vtkNew<vtkDomainParameterization> filter;
    filter->SetInputDataObject(drawn);
    filter->SetOutlineTolerance(params.Tolerance);
    filter->SetCornerAngle(params.CornerAngle);
    filter->SetCornerWindow(params.CornerWindow);
    filter->Update();
    auto* map = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
    ASSERT_GT(map->GetNumberOfCells(), 0);
    EXPECT_EQ(map->GetPoint(0)[2], 0.5);
    const auto number = [map](const char* name)
    { return map->GetFieldData()->GetArray(name)->GetTuple1(0); };
    EXPECT_EQ(number("OutlineDistance"), outline.Value.MaxDistance);
    EXPECT_EQ(number("OutlineCorners"), outline.Value.NumCorners);
    EXPECT_EQ(number("OutlineLines"), outline.Value.NumLines);
    EXPECT_EQ(number("OutlineArcs"), outline.Value.NumArcs);
    EXPECT_EQ(number("OutlineCurves"), outline.Value.NumCurves);
    results.push_back(
      std::to_string(number("OutlineDistance")) + " " + std::to_string(number("OutlineCorners")));
  }
  for (std::size_t i = 1; i < results.size(); ++i)
  {
    EXPECT_NE(results[i], results[0]) << "property " << i << " changes nothing";
  }
}

TEST(DomainPropertiesAll, AreInTheTable_PropertyOracle)
{
  // results, and what layouts or drawn lines alone look at or changes no result: tests of their own
  std::set<std::string> known{ "Verdict", "Injectivity", "SecondsWithCertificate", "MinimumDegree",
    "MinimumElements", "MoveInterfaces", "OutlineTolerance", "CornerAngle", "CornerWindow" };
  for (const Property& property : Properties())
  {
    known.insert(property.Name);
  }
  vtkNew<vtkDomainParameterization> filter;
  std::ostringstream own;
  std::ostringstream base;
  filter->Print(own);
  vtkNew<vtkDomainBoundaryReader> other;
  other->Print(base);
  std::istringstream lines(own.str());
  int found = 0;
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t colon = line.find(':');
    const std::size_t begin = line.find_first_not_of(' ');
    if (colon == std::string::npos || begin >= colon)
    {
      continue;
    }
    const std::string name = line.substr(begin, colon - begin);
    const bool inherited = base.str().find(name + ":") != std::string::npos || name == "Threads";
    if (!inherited)
    {
      ++found;
      EXPECT_EQ(known.count(name), 1u) << name << " has no row in the table";
    }
  }
  EXPECT_GE(found, 20);
}
}
