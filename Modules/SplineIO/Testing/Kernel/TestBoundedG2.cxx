// SPDX-License-Identifier: BSD-3-Clause
#include "FileCases.h"
#include <knotwork/SplineIO/GoToolsG2.h>

#include <filesystem>

using namespace knotwork;
using namespace knotwork::testing;

namespace
{
const std::string Bilinear = "3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n2 0 0\n0 1 0\n2 1 0.5\n";
const std::string Edge = "2 0\n2 2\n0 0 1 1\n0.2 0.2\n0.8 0.2\n";
const std::string EdgeInSpace = "3 0\n2 2\n0 0 1 1\n0.4 0.2 0\n1.6 0.2 0\n";

std::string Bounded(const std::string& loops)
{
  return "210 1 0 0\n200\n" + Bilinear + loops + "\n";
}
}

TEST(BoundedG2, ReadsWhatIsWrittenByHand_GoldenOracle)
{
  const std::string text = Bounded("2\n1 1e-06\n1 100 0\n" + Edge + "2 0.5\n0 100 100\n" + Edge +
                             EdgeInSpace + "0 0 100\n" + EdgeInSpace) +
    "100 1 0 0\n" + EdgeInSpace + "\n";
  const auto file = ReadG2(text);
  ASSERT_TRUE(file) << file.Status.Message();
  ASSERT_EQ(file->Splines.size(), 2U);
  ASSERT_EQ(file->Bounded.size(), 1U);
  const BoundedSurface& bounded = file->Bounded[0];
  EXPECT_EQ(bounded.Spline, 0);
  ASSERT_EQ(bounded.Loops.size(), 2U);
  EXPECT_EQ(bounded.Loops[0].Tolerance, 1e-6);
  ASSERT_EQ(bounded.Loops[1].Curves.size(), 2U);
  const LoopCurve& both = bounded.Loops[1].Curves[0];
  EXPECT_FALSE(both.PreferParameter);
  EXPECT_EQ(both.Parameter.ControlPoints(1, 0), 0.8);
  EXPECT_EQ(both.Space.ControlPoints(1, 0), 1.6);
  EXPECT_FALSE(bounded.Loops[1].Curves[1].Parameter.Space);
  EXPECT_EQ(WriteG2File(file.Value).Value, text);
  // older files have 1 where others have 100
  const auto legacy = ReadG2(Bounded("1\n1 1e-06\n1 1 0\n" + Edge));
  ASSERT_TRUE(legacy) << legacy.Status.Message();
  EXPECT_EQ(WriteG2File(legacy.Value).Value, Bounded("1\n1 1e-06\n1 100 0\n" + Edge));
}

TEST(BoundedG2, SamplesComeBackUnchanged_PropertyOracle)
{
  const char* folder = std::getenv("KNOTWORK_LR_CASES");
  if (!folder)
  {
    GTEST_SKIP() << "KNOTWORK_LR_CASES does not name the folder of the LR cases";
  }
  for (const char* name : { "g2_bounded_surface.g2", "g2_bounded_lr_surface_trimmed.g2" })
  {
    SCOPED_TRACE(name);
    std::ifstream stream(std::filesystem::path(folder) / "oracle" / name, std::ios::binary);
    const std::string text{ std::istreambuf_iterator<char>(stream), {} };
    const auto file = ReadG2(text);
    ASSERT_TRUE(file) << file.Status.Message();
    ASSERT_EQ(file->Bounded.size(), 1U);
    const auto written = WriteG2File(file.Value);
    ASSERT_TRUE(written) << written.Status.Message();
    const auto again = ReadG2(written.Value);
    ASSERT_TRUE(again) << again.Status.Message();
    EXPECT_EQ(std::get<Spline<2>>(again->Splines[0]).ControlPoints,
      std::get<Spline<2>>(file->Splines[0]).ControlPoints);
    ASSERT_EQ(again->Bounded[0].Loops.size(), file->Bounded[0].Loops.size());
    for (std::size_t l = 0; l < file->Bounded[0].Loops.size(); ++l)
    {
      const auto& before = file->Bounded[0].Loops[l].Curves;
      const auto& after = again->Bounded[0].Loops[l].Curves;
      ASSERT_EQ(after.size(), before.size());
      for (std::size_t c = 0; c < before.size(); ++c)
      {
        EXPECT_TRUE(SameSpline(after[c].Parameter, before[c].Parameter));
        // the loop is closed: every curve ends where the next one begins
        const PointMatrix& here = before[c].Parameter.ControlPoints;
        const PointMatrix& next = before[(c + 1) % before.size()].Parameter.ControlPoints;
        EXPECT_LE(
          (here.row(here.rows() - 1) - next.row(0)).norm(), file->Bounded[0].Loops[l].Tolerance);
      }
    }
    EXPECT_EQ(WriteG2File(again.Value).Value, written.Value);
  }
}

TEST(BoundedG2, EveryDamageIsOneErrorWithItsPlace_ExactOracle)
{
  const struct
  {
    std::string Text;
    const char* Words;
  } cases[] = {
    { "210 1 0 0\n700\n", "surface must be of class 200 or 293" },
    { "210 1 0 0\n200\n" + Bilinear, "number of loops is missing" },
    { Bounded("1\n0 1e-6\n"), "number of curves of a loop: '0'" },
    { Bounded("1\n1 nan\n"), "tolerance of a loop: 'nan'" },
    { Bounded("1\n1 1e-6\n2 100 0\n"), "preference of a boundary curve: '2'" },
    { Bounded("1\n1 1e-6\n1 0 0\n"), "neither in the parameter plane nor in space" },
    { Bounded("1\n1 1e-6\n1 130 0\n"), "a boundary curve of class 130" },
    { Bounded("1\n1 1e-6\n1 100 0\n" + EdgeInSpace), "3 coordinates where 2 are needed" },
    { Bounded("1\n1 1e-6\n0 0 100\n" + Edge), "2 coordinates where 3 are needed" },
    { Bounded("2000000000\n1 1e-6\n1 100 0\n" + Edge), "truncated" },
  };
  for (const auto& test : cases)
  {
    SCOPED_TRACE(test.Text);
    const auto file = ReadG2(test.Text);
    ASSERT_FALSE(file);
    EXPECT_NE(file.Status.Detail.find(test.Words), std::string::npos) << file.Status.Detail;
    EXPECT_EQ(file.Status.Detail.compare(0, 5, "line "), 0) << file.Status.Detail;
  }
  auto file = ReadG2("100 1 0 0\n" + EdgeInSpace);
  ASSERT_TRUE(file);
  file->Bounded.resize(1);
  EXPECT_EQ(WriteG2File(file.Value).Status.Code, ErrorCode::DimensionMismatch);
}
