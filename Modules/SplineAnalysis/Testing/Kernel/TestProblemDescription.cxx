// SPDX-License-Identifier: BSD-3-Clause
// Problems from JSON: what they choose, what they mean, and what is wrong with them.
#include "AnalysisCases.h"
#include <knotwork/SplineAnalysis/ProblemDescription.h>

#include <gtest/gtest.h>

namespace knotwork::testing
{
namespace
{
/// Stands for a parser: "x", "left" (x < 0.5) and "ny" are known.
Result<ScalarFunction> Compile(const std::string& text)
{
  if (text == "x")
  {
    return ScalarFunction([](const double* x, const double*) { return x[0]; });
  }
  if (text == "left")
  {
    return ScalarFunction([](const double* x, const double*) { return x[0] < 0.5 ? 1.0 : 0.0; });
  }
  if (text == "ny")
  {
    return ScalarFunction([](const double*, const double* n) { return n[1]; });
  }
  return { ErrorCode::InvalidParameter, "\"" + text + "\" is no expression" };
}

BoundaryGroups GroupsOf(const AnalysisCase& body)
{
  BoundaryGroups groups;
  groups.Facets = body.Boundary;
  return groups;
}

Status Read(const std::string& text, GalerkinEquation equation = GalerkinEquation::PlaneStress)
{
  return ReadProblem(text, equation, {}).Status;
}

/// The status of a problem of the unit square of 4 x 4 elements, or what its conditions chose.
Status Choose(
  const std::string& condition, std::vector<ConditionPlace>* places = nullptr, bool isNodal = false)
{
  const AnalysisCase body =
    isNodal ? LagrangeCase(CellShape::Triangle, 2, 4) : CaseOf<2>("square", BentBox<2>(2, 4, 0.0));
  const auto problem =
    ReadProblem("{\"conditions\": [" + condition + "]}", GalerkinEquation::PlaneStress, {});
  EXPECT_TRUE(problem) << problem.Status.Message();
  BoundaryGroups groups = GroupsOf(body);
  return MakeProblem(problem.Value, body.Space, groups, Compile, places).Status;
}

void ExpectWords(const Status& status, ErrorCode code, const std::string& words)
{
  EXPECT_EQ(status.Code, code) << status.Message();
  EXPECT_NE(status.Detail.find(words), std::string::npos) << status.Message();
}
}

TEST(ProblemDescription, EveryWrongKeyIsNamed_ExactOracle)
{
  const std::pair<const char*, const char*> wrong[] = {
    { "{", "not JSON" },
    { "{\"source\": 1e999}", "beyond all doubles" },
    { "[]", "the problem is not an object" },
    { "{\"loads\": []}", "unknown key \"loads\"" },
    { "{\"material\": {}, \"materials\": [{}]}", "stands beside" },
    { "{\"materials\": []}", "not a list of materials" },
    { "{\"materials\": [{\"number\": 1}, {\"number\": 1}], \"material_array\": \"M\"}", "another" },
    { "{\"materials\": [{}, {}]}", "material_array" },
    { "{\"material\": {\"conductivity\": 1}}", "unknown key" },
    { "{\"material\": {\"youngs_modulus\": \"1\"}}", "not a number" },
    { "{\"source\": 1}", "not a list of 2 entries" },
    { "{\"source\": [1, null]}", "neither a number nor an expression" },
    { "{\"conditions\": {}}", "not a list" },
    { "{\"conditions\": [{\"displacement\": [0, 0]}]}", "needs one of \"on\"" },
    { "{\"conditions\": [{\"on\": \"boundary\"}]}", "says nothing" },
    { "{\"conditions\": [{\"on\": {}, \"pressure\": 1}]}", "is empty" },
    { "{\"conditions\": [{\"on\": {\"side\": -1}, \"pressure\": 1}]}", "from 0 on" },
    { "{\"conditions\": [{\"on\": {\"box\": [1, 0, 0, 1, 0, 0]}, \"pressure\": 1}]}", "lower end" },
    { "{\"conditions\": [{\"on\": \"boundary\", \"pressure\": 1, \"traction\": [1, 1]}]}", "both" },
    { "{\"conditions\": [{\"on\": \"boundary\", \"force\": [1, 1]}]}", "forces act \"at\" points" },
    { "{\"conditions\": [{\"at\": [0, 0], \"pressure\": 1}]}", "acts \"on\" facets" },
    { "{\"conditions\": [{\"along\": {\"side\": 1}, \"traction\": [1, 1]}]}",
      "acts \"on\" facets" },
    { "{\"conditions\": [{\"along\": {\"sides\": [1, 9]}, \"force\": [1, 1]}]}",
      "two of the sides" },
    { "{\"conditions\": [{\"on\": \"boundary\", \"value\": 1}]}", "unknown key \"value\"" },
  };
  for (const auto& [text, words] : wrong)
  {
    ExpectWords(Read(text), ErrorCode::InvalidFormat, words);
  }
  EXPECT_TRUE(Read("{\"source\": 1, \"conditions\": [{\"on\": \"boundary\", \"value\": \"x\"}]}",
    GalerkinEquation::Poisson));
}

TEST(ProblemDescription, ConditionsChoose_ExactOracle)
{
  const auto count = [](const std::string& on, bool isNodal = false)
  {
    std::vector<ConditionPlace> places;
    const Status status =
      Choose("{\"on\": " + on + ", \"displacement\": [0, null]}", &places, isNodal);
    EXPECT_TRUE(status) << status.Message();
    return places.empty() ? std::size_t{ 0 } : places[0].Facets.size();
  };
  EXPECT_EQ(count("\"boundary\""), 16U);
  EXPECT_EQ(count("{\"side\": 1}"), 4U);
  EXPECT_EQ(count("{\"patch\": 0, \"side\": 3}"), 4U);
  EXPECT_EQ(count("{\"box\": [0, 0.5, 0, 0, 0, 0]}"), 2U);
  EXPECT_EQ(count("{\"where\": \"left\"}"), 6U); // the facets that end at x = 0.5 do not hold there
  EXPECT_EQ(count("{\"where\": \"ny\"}"), 8U);
  EXPECT_EQ(count("{\"side\": 2, \"where\": \"left\"}"), 1U);
}

TEST(ProblemDescription, WhatSelectsNothingIsAnError_ExactOracle)
{
  const auto refused = [](
                         const std::string& condition, const std::string& words, bool nodal = false)
  { ExpectWords(Choose(condition, nullptr, nodal), ErrorCode::InvalidParameter, words); };
  refused("{\"on\": {\"side\": 7}, \"pressure\": 1}", "no facet of the boundary is on side 7");
  refused("{\"on\": {\"patch\": 3}, \"pressure\": 1}", "of patch 3");
  refused("{\"on\": {\"box\": [5, 6, 0, 1, 0, 0]}, \"pressure\": 1}", "between (0, 0) and (1, 1)");
  refused("{\"on\": {\"where\": \"nonsense\"}, \"pressure\": 1}", "is no expression");
  refused("{\"on\": \"boundary\", \"pressure\": \"nonsense\"}", "condition 0: \"nonsense\"");
  refused("{\"on\": {\"group\": 4}, \"pressure\": 1}", "no groups of facets");
  refused("{\"on\": {\"group\": \"inlet\"}, \"pressure\": 1}", "names no groups");
  refused("{\"on\": {\"side\": 0}, \"pressure\": 1}", "a mesh has no sides", true);
  refused("{\"at\": [0.3, 0.3], \"force\": [1, 0]}", "the nearest node or control point");
  // inside, where a spline has a control point that it does not pass through
  refused("{\"at\": [0.375, 0.375], \"force\": [1, 0]}", "nor a corner of a spline");
  refused("{\"along\": {\"side\": 0}, \"displacement\": [0, 0]}", "for edges of bodies in space");
  EXPECT_TRUE(Choose("{\"at\": [1, 0], \"force\": [1, 0]}"));
}

TEST(ProblemDescription, EdgesAreHeld_PropertyOracle)
{
  const AnalysisCase body = CaseOf<3>("cube", BentBox<3>(2, 3, 0.0));
  const auto read =
    ReadProblem("{\"conditions\": ["
                "{\"along\": {\"box\": [0, 0, 0, 0, 0, 1]}, \"displacement\": [0, 0, null]},"
                "{\"at\": [0, 0, 0], \"displacement\": [null, null, 0]},"
                "{\"at\": [1, 0, 0], \"displacement\": [null, 0, 0]},"
                "{\"on\": {\"side\": 5}, \"pressure\": 2}]}",
      GalerkinEquation::Solid, { 1.0, 10.0, 0.25 });
  ASSERT_TRUE(read) << read.Status.Message();
  std::vector<ConditionPlace> places;
  const auto problem = MakeProblem(read.Value, body.Space, GroupsOf(body), Compile, &places);
  ASSERT_TRUE(problem) << problem.Status.Message();
  EXPECT_EQ(places[0].Functions.size(), 5U); // along an edge of 3 elements of degree 2
  for (const int function : places[0].Functions)
  {
    EXPECT_EQ(body.Space.Points(function, 0), 0.0);
    EXPECT_EQ(body.Space.Points(function, 1), 0.0);
  }
  const auto solution = SolveGalerkin(body.Space, problem.Value);
  ASSERT_TRUE(solution) << solution.Status.Message();
  EXPECT_NEAR(solution->TotalLoad[2], -2.0, 1e-12); // pressure times area
}
}
