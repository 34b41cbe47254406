// SPDX-License-Identifier: BSD-3-Clause
// IGES files whose B-splines have damaged or missing knots, and fields left blank.
#include "CADCases.h"
#include "OutputFile.h"
#include <knotwork/CADModel/CADExchange.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
constexpr double Outer = 2.0;
constexpr double Inner = 0.8;

/// Lines of a file. @param mode  of OpenCASCADE's writer, 0: trimmed surfaces, 1: solids.
std::vector<std::string> LinesOf(const TopoDS_Shape& shape, int mode)
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
  IGESControl_Controller::Init();
  IGESControl_Writer writer("MM", mode);
  EXPECT_TRUE(writer.AddShape(shape));
  writer.ComputeModel();
  std::stringstream stream;
  EXPECT_TRUE(writer.Write(stream));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
  {
    lines.push_back(line);
  }
  return lines;
}

constexpr std::size_t Width = 64; ///< of parameters in a line

/// A parameter of a record.
struct Field
{
  std::size_t Line = 0;
  std::size_t Begin = 0;
  std::string Text;
};

std::vector<std::vector<Field>> RecordsOf(const std::vector<std::string>& lines)
{
  std::vector<std::vector<Field>> records(1);
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const std::string text =
      lines[l].size() > 72 && lines[l][72] == 'P' ? lines[l].substr(0, Width) : std::string();
    std::size_t begin = 0;
    for (std::size_t end = text.find_first_of(",;"); end != std::string::npos;
         end = text.find_first_of(",;", begin))
    {
      records.back().push_back({ l, begin, text.substr(begin, end - begin) });
      begin = end + 1;
      if (text[end] == ';')
      {
        records.emplace_back();
      }
    }
  }
  records.pop_back();
  return records;
}

/// Another text, not a longer one, for a parameter; others of the line stay what they are.
void Replace(std::vector<std::string>& lines, const Field& field, const std::string& text)
{
  ASSERT_LE(text.size(), field.Text.size());
  std::string& line = lines[field.Line];
  line.replace(field.Begin, field.Text.size(), text);
  line.insert(Width - field.Text.size() + text.size(), field.Text.size() - text.size(), ' ');
}

void Write(const std::string& file, const std::vector<std::string>& lines)
{
  std::ofstream stream(file, std::ios::binary);
  for (const std::string& line : lines)
  {
    stream << line << '\n';
  }
}

/// A body whose measures are known.
struct Body
{
  TopoDS_Shape Shape;
  double Area = 0.0;
  double Volume = 0.0;
  std::size_t NumFaces = 0;
};

Body HollowSphere()
{
  const gp_Pnt middle(1.0, -2.0, 0.5);
  return { BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(middle, Outer).Shape(),
             BRepPrimAPI_MakeSphere(middle, Inner).Shape())
             .Shape(),
    4.0 * Pi * (Outer * Outer + Inner * Inner),
    4.0 / 3.0 * Pi * (std::pow(Outer, 3) - std::pow(Inner, 3)), 2 };
}

Body DrilledBlock()
{
  return { BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, 0), gp_Pnt(2, 2, 1)).Shape(),
             BRepPrimAPI_MakeCylinder(1.0, 1.0).Shape())
             .Shape(),
    48.0, 16.0 - Pi, 7 };
}

Body AsSplines(Body body)
{
  body.Shape = BRepBuilderAPI_NurbsConvert(body.Shape).Shape();
  return body;
}

/// The closed forms hold in the file, and in what is read of it.
void ExpectWhole(const std::string& file, const Body& body, bool isSolid)
{
  const auto found = CheckCAD(file);
  ASSERT_TRUE(found) << found.Status.Message();
  EXPECT_NEAR(found->Area, body.Area, 1e-5 * body.Area); // of OpenCASCADE's integration
  if (isSolid)
  {
    EXPECT_NEAR(found->Volume, body.Volume, 1e-5 * body.Volume);
  }
  const auto read = ReadCAD(file);
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(read->Model.Faces.size(), body.NumFaces);
  EXPECT_TRUE(read->LeftOut.empty());
  TrimmedMeshParams params;
  params.Tolerance = 2e-3;
  const auto mesh = TriangulateFaces(read->Model, params);
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  // triangles within t of a sphere of radius r miss about 2 t / r of its area
  EXPECT_NEAR(AreaOf(mesh.Value), body.Area, 0.01 * body.Area);
}

/// Damages one spline after the other: each is found anew, with the right measures, or is named.
/// @param step  1 of so many splines is damaged.
/// @return  numbers of files that were read and that were refused.
std::array<int, 2> DamageKnots(const Body& body, int mode, int step)
{
  const std::vector<std::string> lines = LinesOf(body.Shape, mode);
  std::array<int, 2> counts{};
  int number = 0;
  for (const std::vector<Field>& record : RecordsOf(lines))
  {
    const bool isCurve = record[0].Text == "126";
    if ((!isCurve && record[0].Text != "128") || number++ % step != 0)
    {
      continue;
    }
    SCOPED_TRACE("mode " + std::to_string(mode) + ", line " + std::to_string(record[0].Line + 1));
    const std::size_t degree = std::stoul(record[isCurve ? 2 : 3].Text);
    std::vector<std::string> damaged = lines;
    // the last one of the first knots, or the next one when that is no single digit
    const Field& first = record[(isCurve ? 7 : 10) + degree];
    Replace(damaged, first.Text.size() > 1 ? first : record[(isCurve ? 8 : 11) + degree], "99");
    const std::string file = OutputFile("damaged.igs");
    Write(file, damaged);
    const auto read = ReadCAD(file);
    if (read)
    {
      ++counts[0];
      EXPECT_EQ(read->Warnings.size(), 1U);
      EXPECT_NE(read->Warnings.at(0).find("the knots of 1 curve "), std::string::npos);
      ExpectWhole(file, body, mode == 1);
    }
    else
    {
      ++counts[1];
      EXPECT_EQ(read.Status.Code, ErrorCode::InvalidFormat);
      EXPECT_NE(read.Status.Detail.find("at directory entry "), std::string::npos)
        << read.Status.Detail;
    }
  }
  return counts;
}
}

TEST(IGESSplines, BlankFieldsAreZero_ExactOracle)
{
  for (const bool nurbs : { false, true })
  {
    const Body body = nurbs ? AsSplines(HollowSphere()) : HollowSphere();
    for (const int mode : { 0, 1 })
    {
      SCOPED_TRACE((nurbs ? "nurbs, mode " : "mode ") + std::to_string(mode));
      std::vector<std::string> lines = LinesOf(body.Shape, mode);
      int blanks = 0;
      auto records = RecordsOf(lines);
      for (auto& record : records)
      {
        // from the end of a line to its begin: what stands before does not move
        for (auto field = record.rbegin(); field != record.rend(); ++field)
        {
          if (field->Text == "0." || field->Text == "-0.")
          {
            Replace(lines, *field, "");
            ++blanks;
          }
        }
      }
      EXPECT_GE(blanks, 30);
      const std::string file = OutputFile("blank.igs");
      Write(file, lines);
      ExpectWhole(file, body, mode == 1);
    }
  }
}

TEST(IGESSplines, DamagedCurvesAreFoundAnewOrNamed_ExactOracle)
{
  for (const int mode : { 0, 1 })
  {
    SCOPED_TRACE("hollow sphere"); // seams and poles: nothing but their pcurves says where they are
    EXPECT_GE(DamageKnots(AsSplines(HollowSphere()), mode, 1)[1], 6);
    SCOPED_TRACE("drilled block");
    const std::array<int, 2> counts = DamageKnots(AsSplines(DrilledBlock()), mode, 7);
    EXPECT_GE(counts[0], 2);
    EXPECT_GE(counts[1], 1);
  }
}

TEST(IGESSplines, APcurveWithABlankKnotIsFoundAnew_ExactOracle)
{
  // a quarter of a torus of radii 1 and 1/2, written by Knotwork, a knot of a pcurve blanked
  const std::string file = KNOTWORK_DATA_DIR "/SplineIO/blank_knot.igs";
  const auto read = ReadCAD(file);
  ASSERT_TRUE(read) << read.Status.Message();
  EXPECT_EQ(read->Warnings.size(), 1U);
  EXPECT_TRUE(read->LeftOut.empty());
  TrimmedMeshParams params;
  params.Tolerance = 1e-4;
  const auto mesh = TriangulateFaces(read->Model, params);
  ASSERT_TRUE(mesh) << mesh.Status.Message();
  EXPECT_NEAR(AreaOf(mesh.Value), 0.5 * Pi * Pi, 1e-3 * 0.5 * Pi * Pi);
}
