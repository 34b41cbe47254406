// SPDX-License-Identifier: BSD-3-Clause
#include "FileCases.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineIO/GismoXml.h>

#include <algorithm>
#include <numeric>

using namespace knotwork;
using namespace knotwork::testing;

TEST(GismoXml, HandWrittenFile_GoldenOracle)
{
  const Result<SplineFile> file = ReadGismoXml(HandWrittenXml);
  ASSERT_TRUE(file) << file.Status.Message();
  ASSERT_EQ(file->Splines.size(), 4u);
  EXPECT_EQ(file->Ids, (std::vector<int>{ 4, 7, 0, 9 })); // the third has none: the smallest free
  EXPECT_TRUE(file->Warnings.empty());

  const auto& left = std::get<Spline<2>>(file->Splines[0]);
  PointMatrix points(4, 2); // first parameter fastest
  points << 0, 0, 1, 0, 0, 1, 1, 1;
  EXPECT_EQ(left.ControlPoints, points);
  EXPECT_EQ(left.Space->Kind, SpaceKind::Tensor);

  const auto& curve = std::get<Spline<1>>(file->Splines[2]);
  EXPECT_EQ(curve.Weights, Eigen::Vector3d(1, 0.5, 2));
  EXPECT_EQ(curve.ControlPoints.row(1), Eigen::RowVector3d(1, 1, 0)); // not divided by the weight

  ASSERT_EQ(file->MultiPatches.size(), 1u);
  const StatedPatches& patches = file->MultiPatches[0];
  EXPECT_EQ(patches.Dimension, 2);
  EXPECT_EQ(patches.Splines, (std::vector<int>{ 0, 1 }));
  ASSERT_EQ(patches.Topology.Interfaces.size(), 1u);
  const PatchInterface& interface = patches.Topology.Interfaces[0];
  EXPECT_EQ(interface.Sides[0], (PatchSide{ 0, 1 }));
  EXPECT_EQ(interface.Sides[1], (PatchSide{ 1, 0 }));
  EXPECT_EQ(interface.Orientation.Number(), 0);
  ASSERT_EQ(patches.Topology.Boundary.size(), 6u);
  EXPECT_EQ(patches.Topology.Boundary[3], (PatchSide{ 1, 1 }));
}

TEST(GismoXml, OrderOfHierarchicalCoefficients_GoldenOracle)
{
  const Result<SplineFile> file = ReadGismoXml(HandWrittenXml);
  ASSERT_TRUE(file) << file.Status.Message();
  const auto& function = std::get<Spline<2>>(file->Splines[3]);
  EXPECT_EQ(function.Space->Kind, SpaceKind::Hierarchical);
  ASSERT_EQ(function.Space->NumFunctions, 10);
  const BezierForm<2> form = MakeBezierForm(function);
  // Of degree 1 the coefficients are values: first the four of level 0, u fastest, then those of
  // level 1. Half-way along the edge at u = 1 nothing is refined: the mean of 1 and 3.
  PointMatrix at(11, 2);
  at << 1, 0, 2, 0, 1, 1, 2, 1, 0, 0, 0.5, 0, 0, 0.5, 0.5, 0.5, 0, 1, 0.5, 1, 1, 0.5;
  EvaluationBatch batch;
  ASSERT_TRUE(EvaluateParameters(form, at, {}, batch));
  const double expected[] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 2 };
  for (int i = 0; i < 11; ++i)
  {
    EXPECT_DOUBLE_EQ(batch.Values(i, 0), expected[i]) << "point " << i;
  }
}

TEST(GismoXml, WrittenFile_GoldenOracle)
{
  const std::string expected = R"(<?xml version="1.0" encoding="UTF-8"?>
<xml>
<Geometry type="BSpline" id="0">
<Basis type="BSplineBasis"><KnotVector degree="1">0 0 1 1</KnotVector></Basis>
<coefs geoDim="2">
0.1 -2.5
1e+50 3
</coefs>
</Geometry>
<MultiPatch parDim="1" id="1">
<patches type="id_index">0</patches>
<boundary>
0 1
0 2
</boundary>
</MultiPatch>
</xml>
)";
  Spline<1> line;
  line.Space = MakeTensorSpace<1>({ KnotVector::Uniform(1, 1) }).Value;
  line.ControlPoints = PointMatrix(2, 2);
  line.ControlPoints << 0.1, -2.5, 1e50, 3;
  SplineFile file;
  file.Splines = { line };
  file.MultiPatches = { { 1, { 0 }, { {}, { { 0, 0 }, { 0, 1 } } } } };
  const Result<std::string> text = WriteGismoXml(file);
  ASSERT_TRUE(text) << text.Status.Message();
  EXPECT_EQ(text.Value, expected);
}

TEST(GismoXml, WrittenTypesAndBoxes_GoldenOracle)
{
  const Result<SplineFile> file = ReadGismoXml(HandWrittenXml);
  const std::string text = WriteGismoXml(file.Value).Value;
  for (const char* part : { "<Geometry type=\"TensorBSpline2\" id=\"4\">",
         "<Basis type=\"TensorBSplineBasis2\">\n<Basis type=\"BSplineBasis\" index=\"0\">",
         "<Geometry type=\"Nurbs\" id=\"0\">\n<Basis type=\"NurbsBasis\">\n<Basis "
         "type=\"BSplineBasis\">",
         "<weights>\n1\n0.5\n2\n</weights>\n</Basis>\n<coefs geoDim=\"3\">",
         "<Geometry type=\"THBSpline2\" id=\"9\">\n<Basis type=\"THBSplineBasis2\">",
         "<box level=\"1\">0 0 2 2</box>", "<interfaces>\n4 2 7 1 0 1 1 1\n</interfaces>",
         "<MultiPatch parDim=\"2\" id=\"10\">" })
  {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

TEST(GismoXml, RoundTripsAreExact_PropertyOracle)
{
  for (unsigned seed = 1; seed <= 60; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SplineFile file = RandomFile(seed, true);
    const Result<std::string> text = WriteGismoXml(file);
    ASSERT_TRUE(text) << text.Status.Message();
    const Result<SplineFile> again = ReadGismoXml(text.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    ASSERT_TRUE(SameSplines(file.Splines, again->Splines));
    ASSERT_EQ(file.Ids, again->Ids);
    ASSERT_EQ(WriteGismoXml(again.Value).Value, text.Value);
  }
}

TEST(GismoXml, MultiPatchesComeBack_PropertyOracle)
{
  const Result<SplineFile> file = ReadGismoXml(HandWrittenXml);
  const std::string text = WriteGismoXml(file.Value).Value;
  const Result<SplineFile> again = ReadGismoXml(text);
  ASSERT_TRUE(again) << again.Status.Message();
  EXPECT_TRUE(SameSplines(file->Splines, again->Splines));
  EXPECT_EQ(again->Ids, file->Ids);
  EXPECT_EQ(WriteGismoXml(again.Value).Value, text);
  ASSERT_EQ(again->MultiPatches.size(), 1u);
  EXPECT_EQ(again->MultiPatches[0].Splines, file->MultiPatches[0].Splines);
  EXPECT_EQ(again->MultiPatches[0].Topology.Boundary.size(), 6u);
}

TEST(GismoXml, InterfacesInEveryOrientation_PropertyOracle)
{
  std::string squares;
  std::string cubes;
  const std::string knots = "\"><KnotVector degree=\"1\">0 0 1 1</KnotVector></Basis>";
  for (int id = 0; id < 2; ++id)
  {
    for (const int dim : { 2, 3 })
    {
      std::string& text = dim == 2 ? squares : cubes;
      const std::string number = std::to_string(dim);
      text += "<Geometry type=\"TensorBSpline" + number + "\" id=\"" + std::to_string(id) +
        "\"><Basis type=\"TensorBSplineBasis" + number + "\">";
      for (int d = 0; d < dim; ++d)
      {
        text += "<Basis type=\"BSplineBasis\" index=\"" + std::to_string(d) + knots;
      }
      text += std::string("</Basis><coefs geoDim=\"1\">") +
        (dim == 2 ? "1 2 3 4" : "1 2 3 4 5 6 7 8") + "</coefs></Geometry>\n";
    }
  }
  int read = 0;
  for (const int dim : { 2, 3 })
  {
    for (int a = 1; a <= 2 * dim; ++a)
    {
      for (int b = 1; b <= 2 * dim; ++b)
      {
        std::vector<int> directions(static_cast<std::size_t>(dim));
        std::iota(directions.begin(), directions.end(), 0);
        do
        {
          for (int senses = 0; senses < (1 << dim); ++senses)
          {
            // all rows; those that state another sense across the sides than they have are the same
            std::string row = "0 " + std::to_string(a) + " 1 " + std::to_string(b);
            std::string written = row;
            for (const int d : directions)
            {
              row += " " + std::to_string(d);
            }
            written = row;
            for (int d = 0; d < dim; ++d)
            {
              const int sense = senses >> d & 1;
              row += " " + std::to_string(sense);
              written += " " + std::to_string(d == (a - 1) / 2 ? (a + b) % 2 : sense);
            }
            const std::string patches = "<MultiPatch parDim=\"" + std::to_string(dim) +
              "\" id=\"2\"><patches type=\"id_range\">0 1</patches><interfaces>" + row +
              "</interfaces></MultiPatch></xml>";
            const auto file = ReadGismoXml("<xml>" + (dim == 2 ? squares : cubes) + patches);
            const bool fits = directions[static_cast<std::size_t>((a - 1) / 2)] == (b - 1) / 2;
            ASSERT_EQ(static_cast<bool>(file), fits) << row;
            if (!fits)
            {
              EXPECT_EQ(file.Status.Code, ErrorCode::InvalidFormat);
              continue;
            }
            EXPECT_NE(
              WriteGismoXml(file.Value)->find("<interfaces>\n" + written + "\n</interfaces>"),
              std::string::npos)
              << row;
            ++read;
          }
        } while (std::next_permutation(directions.begin(), directions.end()));
      }
    }
  }
  EXPECT_EQ(read, 2 * 4 * 4 * 2 + 2 * 6 * 6 * 8);
}

namespace
{
/// A biquadratic THB surface on 4 x 4 elements with the boxes given.
std::string WithBoxes(const std::string& boxes, int coefficients)
{
  const std::string knots = "\"><KnotVector degree=\"2\">0 0 0 1 2 3 4 4 4</KnotVector></Basis>";
  std::string numbers;
  for (int i = 0; i < coefficients; ++i)
  {
    numbers += std::to_string(i) + " ";
  }
  return "<xml><Geometry type=\"THBSpline2\"><Basis type=\"THBSplineBasis2\">"
         "<Basis type=\"TensorBSplineBasis2\"><Basis type=\"BSplineBasis\" index=\"0" +
    knots + "<Basis type=\"BSplineBasis\" index=\"1" + knots + "</Basis>" + boxes +
    "</Basis><coefs geoDim=\"1\">" + numbers + "</coefs></Geometry></xml>";
}
}

TEST(GismoXml, BoxesOfOneHierarchyInManyForms_CrossOracle)
{
  // Omega^1 = [0, 3]^2 in elements, Omega^2 = [0.5, 1.5] x [0, 1]
  const std::string whole = "<box level=\"1\">0 0 6 6</box><box level=\"2\">2 0 6 4</box>";
  // leaves that do not overlap, some of which end inside an element of level 0, as G+Smo writes
  const std::string leaves = "<box level=\"2\">2 0 6 4</box><box level=\"1\">0 0 1 6</box>"
                             "<box level=\"1\">1 2 3 6</box><box level=\"1\">3 0 6 6</box>";
  const std::array<KnotVector, 2> knots = {
    KnotVector::Create(2, { 0, 0, 0, 1, 2, 3, 4, 4, 4 }).Value,
    KnotVector::Create(2, { 0, 0, 0, 1, 2, 3, 4, 4, 4 }).Value
  };
  const auto space =
    MakeHierarchicalSpace<2>(knots, { { 1, { 0, 0 }, { 6, 6 } }, { 2, { 2, 0 }, { 6, 4 } } });
  const int n = space->get()->NumFunctions;
  for (const std::string& boxes : { whole, leaves, leaves + whole, leaves + leaves })
  {
    const Result<SplineFile> file = ReadGismoXml(WithBoxes(boxes, n));
    ASSERT_TRUE(file) << file.Status.Message() << "\n" << boxes;
    EXPECT_EQ(std::get<Spline<2>>(file->Splines[0]).Space->LocalFunctionIds,
      space->get()->LocalFunctionIds);
  }
}

TEST(GismoXml, BoxesWithinCoarserElementsAreRefused_ExactOracle)
{
  const Result<SplineFile> file = ReadGismoXml(WithBoxes("<box level=\"1\">1 0 6 6</box>", 36));
  EXPECT_EQ(file.Status.Code, ErrorCode::InvalidTopology) << file.Status.Message();
  EXPECT_NE(file.Status.Detail.find("whole elements"), std::string::npos);
}

TEST(GismoXml, OtherTypesAreNamedAsLeftOut_ExactOracle)
{
  std::string text = HandWrittenXml;
  text.replace(text.find("<Geometry type=\"Nurbs\""), 22, "<Geometry type=\"Other\"");
  const Result<SplineFile> file = ReadGismoXml(text);
  ASSERT_TRUE(file) << file.Status.Message();
  EXPECT_EQ(file->Splines.size(), 3u);
  ASSERT_EQ(file->LeftOut.size(), 1u);
  EXPECT_NE(file->LeftOut[0].find("line 21"), std::string::npos) << file->LeftOut[0];
  EXPECT_NE(file->LeftOut[0].find("'Other'"), std::string::npos);
}

TEST(GismoXml, CurvesOfAPlanarDomainAreRead_GoldenOracle)
{
  const std::string curve = "<Geometry type=\"BSpline\" id=\"0\"><Basis type=\"BSplineBasis\">"
                            "<KnotVector degree=\"1\">0 0 1/3 2/4 1 1</KnotVector></Basis>"
                            "<coefs geoDim=\"2\">0 0 1/8 0 -3/-4 1 1 1</coefs></Geometry>";
  const std::string noId =
    "<Geometry type=\"BSpline\" id=\"\"" + curve.substr(curve.find("><Basis"));
  const auto file = ReadGismoXml("<xml>\n<PlanarDomain id=\"0\"><CurveLoop index=\"0\">" + curve +
    "</CurveLoop><CurveLoop>" + curve + "</CurveLoop></PlanarDomain>\n<CurveLoop>" + curve +
    "</CurveLoop>" + curve + noId + "<Matrix>1 2</Matrix>\n<TrimSurface>" + curve +
    "</TrimSurface><Mesh/></xml>");
  ASSERT_TRUE(file) << file.Status.Message();
  ASSERT_EQ(file->Splines.size(), 5u);
  // ids within a domain are not those of the file; an empty one is none
  EXPECT_EQ(file->Ids, (std::vector<int>{ 1, 2, 3, 0, 4 }));
  for (const AnySpline& spline : file->Splines)
  {
    const auto& read = std::get<Spline<1>>(spline);
    EXPECT_EQ(read.Space->Knots[0].Breaks(), (std::vector<double>{ 0.0, 1.0 / 3.0, 0.5, 1.0 }));
    EXPECT_EQ(read.ControlPoints(1, 0), 0.125);
    EXPECT_EQ(read.ControlPoints(2, 0), 0.75);
  }
  ASSERT_EQ(file->LeftOut.size(), 2u);
  EXPECT_NE(file->LeftOut[0].find("line 4, <TrimSurface>"), std::string::npos);
  EXPECT_NE(file->LeftOut[1].find("<Mesh>"), std::string::npos);
  for (const char* word : { "1/0", "1/", "/3", "1/2/3", "1/x", "1e300/1e-300" })
  {
    std::string text = "<xml>" + curve + "</xml>";
    text.replace(text.find("1/3"), 3, word);
    const auto damaged = ReadGismoXml(text);
    EXPECT_EQ(damaged.Status.Code, ErrorCode::InvalidFormat) << word;
    EXPECT_NE(damaged.Status.Detail.find("quotient"), std::string::npos) << damaged.Status.Detail;
  }
}

TEST(GismoXml, WhatTheFormatHasNotIsRefused_ExactOracle)
{
  EXPECT_EQ(WriteGismoXml({}).Status.Code, ErrorCode::EmptyInput);
  SplineFile file = RandomFile(1, false);
  file.Ids.assign(file.Splines.size(), 1);
  EXPECT_EQ(WriteGismoXml(file).Status.Code, ErrorCode::InvalidTopology);
  file.Ids.clear();
  EXPECT_TRUE(WriteGismoXml(file));
  file.MultiPatches = { { 2, { 0 }, {} } };
  EXPECT_EQ(WriteGismoXml(file).Status.Code, ErrorCode::InvalidTopology);
  file.MultiPatches = { { 1, { 0 }, { {}, { { 0, 2 } } } } };
  EXPECT_EQ(WriteGismoXml(file).Status.Code, ErrorCode::InvalidTopology);
}
