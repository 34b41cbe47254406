// SPDX-License-Identifier: BSD-3-Clause
// Parts that cannot be swept as they are, and how many cuts are known to be enough.
#include "PartFiles.h"
#include <knotwork/CADMeshing/CADHexes.h>
#include <knotwork/CADMeshing/HexahedronQuality.h>
#include <knotwork/CADMeshing/SweepCuts.h>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>

#include <gtest/gtest.h>

using namespace knotwork;

namespace
{
constexpr double Pi = 3.14159265358979323846;

CADPieces PiecesOf(const TopoDS_Shape& shape)
{
  auto pieces = CADPieces::Read(BREPFile(shape));
  EXPECT_TRUE(pieces) << pieces.Status.Message();
  return std::move(pieces.Value);
}

struct Part
{
  const char* Name;
  TopoDS_Shape Shape;
  std::size_t Cuts; ///< the fewest
  std::size_t Solids;
  double Volume;
};

std::vector<Part> Parts()
{
  const gp_Dir up(0, 0, 1);
  const gp_Dir along(1, 0, 0);
  const auto cylinder = [&](double z, double radius, double height)
  { return CylinderAt(gp_Pnt(0, 0, z), up, radius, height); };
  const TopoDS_Shape stepped = BRepAlgoAPI_Fuse(cylinder(0, 2, 3), cylinder(3, 1, 2)).Shape();
  const TopoDS_Shape thrice = BRepAlgoAPI_Fuse(
    BRepAlgoAPI_Fuse(cylinder(0, 1, 2), cylinder(2, 2, 2)).Shape(), cylinder(4, 1.5, 2))
                                .Shape();
  const TopoDS_Shape angle =
    BRepAlgoAPI_Fuse(BoxAt(gp_Pnt(0, 0, 0), 4, 3, 1), BoxAt(gp_Pnt(0, 0, 1), 1, 3, 3)).Shape();
  const TopoDS_Shape bored =
    BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(angle, CylinderAt(gp_Pnt(2.5, 1.5, -1), up, 0.5, 3)).Shape(),
      CylinderAt(gp_Pnt(-1, 1.5, 2.5), along, 0.5, 3))
      .Shape();
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(1).Shape();
  return { { "cylinder", cylinder(0, 1, 1), 0, 1, Pi }, { "two diameters", stepped, 1, 2, 14 * Pi },
    { "three diameters", thrice, 2, 3, 14.5 * Pi },
    { "angle with bores both ways", bored, 1, 2, 12 + 9 - 0.5 * Pi },
    { "torus", BRepPrimAPI_MakeTorus(3, 1).Shape(), 1, 2, 6 * Pi * Pi },
    { "tip", BRepPrimAPI_MakeCone(2, 0, 3).Shape(), 2, 4, 4 * Pi },
    { "ball", ball, 3, 8, 4 * Pi / 3 } };
}
}

TEST(SweepCuts, TheFewestCutsAreFound_ExactOracle)
{
  for (const Part& part : Parts())
  {
    SCOPED_TRACE(part.Name);
    CADHexes made;
    const PieceMeshing meshing = [&](const CADTopology& model) -> Result<double>
    {
      auto hexes = MeshHexes(model);
      made = hexes ? std::move(hexes.Value) : CADHexes();
      return hexes ? Result<double>(ShareNotValid(made.Quality.Certificate))
                   : Result<double>(hexes.Status);
    };
    SweepCutsParams params;
    params.MaxCuts = 3;
    const auto found = FindSweepCuts(PiecesOf(part.Shape), meshing, params);
    ASSERT_TRUE(found) << found.Status.Message();
    EXPECT_EQ(found->Cuts.size(), part.Cuts);
    EXPECT_EQ(found->Model.Bodies.size(), part.Solids);
    EXPECT_EQ(made.Solids.size(), part.Solids);
    EXPECT_EQ(made.Quality.Certificate.Verdict, Verdict::Valid);
    EXPECT_NEAR(made.Quality.Volume, part.Volume, 0.06 * part.Volume);
    // one fewer is not enough
    if (part.Cuts > 0)
    {
      params.MaxCuts = static_cast<int>(part.Cuts) - 1;
      const auto none = FindSweepCuts(PiecesOf(part.Shape), meshing, params);
      EXPECT_EQ(none.Status.Code, ErrorCode::InvalidTopology);
      EXPECT_NE(none.Status.Detail.find("solid 0 is neither mapped nor swept"), std::string::npos)
        << none.Status.Message();
    }
  }
}

TEST(SweepCuts, CutsThatCannotBeMeshedAreNotTaken)
{
  const CADPieces pieces = PiecesOf(Parts()[1].Shape);
  int tried = 0;
  const auto refused = FindSweepCuts(pieces,
    [&](const CADTopology&) -> Status {
      return { ErrorCode::InvalidTopology, "number " + std::to_string(++tried) };
    });
  EXPECT_EQ(refused.Status.Detail, "number 1"); // that of the part as it is
  EXPECT_GT(tried, 2);
  const auto large = FindSweepCuts(pieces,
    [&](const CADTopology& model) -> Result<double>
    {
      return model.Bodies.size() == 1 ? Status(ErrorCode::InvalidTopology, "one")
                                      : Status(ErrorCode::TooLarge, "more");
    });
  EXPECT_EQ(large.Status.Code, ErrorCode::TooLarge);
  // some cells that are not valid are better than none: where there are the fewest, meshed again at
  // the end
  std::vector<std::size_t> bodies;
  double share = 0.05;
  const PieceMeshing folds = [&](const CADTopology& model) -> Result<double>
  {
    bodies.push_back(model.Bodies.size());
    return model.Bodies.size() == 1 ? Result<double>(Status{ ErrorCode::InvalidTopology, "one" })
      : model.Bodies.size() == 2    ? Result<double>(2.0 * share)
                                    : Result<double>(share);
  };
  const auto folded = FindSweepCuts(pieces, folds);
  ASSERT_TRUE(folded);
  EXPECT_GT(folded->Model.Bodies.size(), 2u);
  EXPECT_EQ(folded->Model.Bodies.size(), bodies.back());
  share = 2.0 * MostInvalidCells;
  const auto useless = FindSweepCuts(pieces, folds);
  EXPECT_EQ(useless.Status.Code, ErrorCode::InvalidTopology);
  EXPECT_NE(useless.Status.Detail.find("20 in a hundred fold over"), std::string::npos)
    << useless.Status.Message();
  SweepCutsParams stopped;
  stopped.Progress = [](double) { return false; };
  EXPECT_EQ(
    FindSweepCuts(
      pieces, [](const CADTopology& model) -> Result<double> { return MeshHexes(model).Status; },
      stopped)
      .Status.Code,
    ErrorCode::Aborted);
}
