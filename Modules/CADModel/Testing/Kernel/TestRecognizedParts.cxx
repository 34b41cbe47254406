// SPDX-License-Identifier: BSD-3-Clause
// Parts that OpenCASCADE makes and tessellates. Oracle: its faces.
#include "OutputFile.h"
#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/MeshParameterization/ScanFeatures.h>
#include <knotwork/SurfaceTrimming/RegionModel.h>
#include <knotwork/SurfaceTrimming/SurfaceRecognition.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax2.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace knotwork
{
namespace
{
constexpr double Tolerance = 1e-3; // of the diagonal
constexpr double Pi = 3.14159265358979323846;

struct Part
{
  TriangleMesh Mesh;
  std::vector<int> FaceOfTriangle;
  std::vector<BRepAdaptor_Surface> Faces;
  double Diagonal = 0.0;
};

class PartMaker
{
public:
  explicit PartMaker(unsigned seed) : Random(seed) {}
  TopoDS_Shape Make();

private:
  double Between(double a, double b)
  {
    return a + (b - a) * static_cast<double>(this->Random()) / 4294967296.0;
  }
  void AddFeature(TopoDS_Shape& shape, double x, double y, double top, double room);
  std::mt19937 Random;
};

/// Something round at a place on top of a box.
void PartMaker::AddFeature(TopoDS_Shape& shape, double x, double y, double top, double room)
{
  const double r = this->Between(0.4, 0.9) * room;
  const gp_Ax2 up(gp_Pnt(x, y, top), gp_Dir(0, 0, 1));
  const gp_Ax2 down(gp_Pnt(x, y, top), gp_Dir(0, 0, -1));
  const gp_Ax2 below(gp_Pnt(x, y, -1), gp_Dir(0, 0, 1));
  switch (static_cast<int>(this->Between(0, 6)))
  {
    case 0: // a hole
      shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCylinder(below, r, top + 2).Shape()).Shape();
      break;
    case 1: // a countersink
      shape =
        BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeCone(down, r, 0.4 * r, 0.5 * top).Shape()).Shape();
      break;
    case 2: // a boss
      shape = BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeCylinder(up, r, this->Between(1, 4)).Shape())
                .Shape();
      break;
    case 3: // a dimple
      shape = BRepAlgoAPI_Cut(
        shape, BRepPrimAPI_MakeSphere(gp_Pnt(x, y, top + this->Between(0.0, 0.3) * r), r).Shape())
                .Shape();
      break;
    case 4: // a cone with a flat top
      shape =
        BRepAlgoAPI_Fuse(shape, BRepPrimAPI_MakeCone(up, r, this->Between(0.3, 0.6) * r, r).Shape())
          .Shape();
      break;
    default: // a boss with a round edge: a torus
    {
      const TopoDS_Shape boss = BRepPrimAPI_MakeCylinder(up, r, this->Between(2, 4)).Shape();
      BRepFilletAPI_MakeFillet fillet(boss);
      const double round = this->Between(0.3, 0.45) * r;
      for (TopExp_Explorer edges(boss, TopAbs_EDGE); edges.More(); edges.Next())
      {
        double first;
        double last;
        const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
        const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
        if (std::min(curve->Value(first).Z(), curve->Value((first + last) / 2.0).Z()) > top + 1.0)
        {
          fillet.Add(round, edge);
          break;
        }
      }
      shape = BRepAlgoAPI_Fuse(shape, fillet.Shape()).Shape();
    }
  }
}

TopoDS_Shape PartMaker::Make()
{
  const double a = this->Between(16, 24);
  const double b = this->Between(8, 12);
  const double top = this->Between(4, 7);
  TopoDS_Shape shape = BRepPrimAPI_MakeBox(a, b, top).Shape();
  BRepFilletAPI_MakeFillet fillet(shape); // some upright edges are round
  bool any = false;
  for (TopExp_Explorer edges(shape, TopAbs_EDGE); edges.More(); edges.Next())
  {
    double first;
    double last;
    const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    const gp_Vec along(curve->Value(first), curve->Value(last));
    if (std::abs(along.Z()) > 1.0 && this->Between(0, 1) < 0.25)
    {
      fillet.Add(this->Between(0.6, 1.5), edge);
      any = true;
    }
  }
  shape = any ? fillet.Shape() : shape;
  this->AddFeature(shape, 0.25 * a, 0.5 * b, top, 0.3 * b);
  this->AddFeature(shape, 0.7 * a, 0.5 * b, top, 0.3 * b);
  return shape;
}

/// Tessellates at half the tolerance; points are rounded to float as in STL files.
Part Tessellate(const TopoDS_Shape& shape, double noise, unsigned seed)
{
  Part part;
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  part.Diagonal = box.CornerMin().Distance(box.CornerMax());
  const BRepMesh_IncrementalMesh mesher(shape, 0.5 * Tolerance * part.Diagonal);
  std::map<std::array<float, 3>, int> numbers;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
  {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    TopLoc_Location place;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
    for (int t = 1; !mesh.IsNull() && t <= mesh->NbTriangles(); ++t)
    {
      std::array<int, 3> corners{};
      int ids[3];
      mesh->Triangle(t).Get(ids[0], ids[1], ids[2]);
      for (std::size_t k = 0; k < 3; ++k)
      {
        const gp_Pnt p = mesh->Node(ids[k]).Transformed(place);
        const std::array<float, 3> key = { static_cast<float>(p.X()), static_cast<float>(p.Y()),
          static_cast<float>(p.Z()) };
        corners[k] = numbers.emplace(key, static_cast<int>(numbers.size())).first->second;
      }
      if (face.Orientation() == TopAbs_REVERSED)
      {
        std::swap(corners[0], corners[1]);
      }
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      {
        part.Mesh.Triangles.push_back(corners);
        part.FaceOfTriangle.push_back(static_cast<int>(part.Faces.size()));
      }
    }
    part.Faces.emplace_back(face);
  }
  part.Mesh.Points.resize(static_cast<Eigen::Index>(numbers.size()), 3);
  std::mt19937 random(seed);
  for (const auto& [key, id] : numbers)
  {
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double share = static_cast<double>(random()) / 2147483648.0 - 1.0;
      part.Mesh.Points(id, static_cast<Eigen::Index>(d)) =
        static_cast<double>(key[d]) + noise * Tolerance * part.Diagonal * share / std::sqrt(3.0);
    }
  }
  return part;
}

SurfaceType TypeOf(const BRepAdaptor_Surface& face)
{
  switch (face.GetType())
  {
    case GeomAbs_Plane:
      return SurfaceType::Plane;
    case GeomAbs_Cylinder:
      return SurfaceType::Cylinder;
    case GeomAbs_Cone:
      return SurfaceType::Cone;
    case GeomAbs_Sphere:
      return SurfaceType::Sphere;
    case GeomAbs_Torus:
      return SurfaceType::Torus;
    default:
      return SurfaceType::FreeForm;
  }
}

/// Distance of the recognised axis from the true one, and of the radii.
double ErrorOf(const BRepAdaptor_Surface& face, const AnalyticSurface& found)
{
  gp_Ax1 axis;
  double error = 0.0;
  if (found.Type == SurfaceType::Cylinder)
  {
    axis = face.Cylinder().Axis();
    error = std::abs(face.Cylinder().Radius() - found.Radius);
  }
  else if (found.Type == SurfaceType::Torus)
  {
    axis = face.Torus().Axis();
    error = std::max(std::abs(face.Torus().MajorRadius() - found.Radius),
      std::abs(face.Torus().MinorRadius() - found.MinorRadius));
  }
  else if (found.Type == SurfaceType::Sphere)
  {
    const gp_Pnt centre = face.Sphere().Location();
    return std::max(std::abs(face.Sphere().Radius() - found.Radius),
      (found.Point - Eigen::Vector3d(centre.X(), centre.Y(), centre.Z())).norm());
  }
  else
  {
    return 0.0;
  }
  const Eigen::Vector3d origin(axis.Location().X(), axis.Location().Y(), axis.Location().Z());
  const Eigen::Vector3d along(axis.Direction().X(), axis.Direction().Y(), axis.Direction().Z());
  return std::max(error, (found.Point - origin).cross(along).norm());
}

struct Tally
{
  std::array<int, NumSurfaceTypes> Faces{};
  std::array<int, NumSurfaceTypes> Right{};
  double LargestError = 0.0; ///< of the diagonal
  int AllFaces = 0;
  int AllRight = 0;
  double Share() const { return static_cast<double>(this->AllRight) / this->AllFaces; }
};

void Count(const Part& part, Tally& tally)
{
  const auto surface = CheckSurface(part.Mesh);
  ASSERT_TRUE(surface) << surface.Status.Message();
  RecognitionParams params;
  params.Tolerance = Tolerance * part.Diagonal;
  const auto result = RecognizeSurfaces(surface.Value, params);
  ASSERT_TRUE(result) << result.Status.Message();
  std::vector<std::map<int, int>> regionsOfFace(part.Faces.size());
  std::vector<std::map<int, int>> facesOfRegion(result->Regions.size());
  for (std::size_t t = 0; t < surface->Triangles.size(); ++t)
  {
    const int face = part.FaceOfTriangle[static_cast<std::size_t>(surface->TriangleIds[t])];
    const int region = result->RegionOfTriangle[t];
    ++regionsOfFace[static_cast<std::size_t>(face)][region];
    ++facesOfRegion[static_cast<std::size_t>(region)][face];
  }
  for (std::size_t f = 0; f < part.Faces.size(); ++f)
  {
    const SurfaceType type = TypeOf(part.Faces[f]);
    const auto at = static_cast<std::size_t>(type);
    ++tally.Faces[at];
    ++tally.AllFaces;
    if (regionsOfFace[f].size() != 1)
    {
      continue;
    }
    const auto region = static_cast<std::size_t>(regionsOfFace[f].begin()->first);
    const AnalyticSurface& found = result->Regions[region].Surface;
    if (found.Type == type && facesOfRegion[region].size() == 1)
    {
      ++tally.Right[at];
      ++tally.AllRight;
      tally.LargestError =
        std::max(tally.LargestError, ErrorOf(part.Faces[f], found) / part.Diagonal);
    }
  }
}

/// Counts of the types are properties of the test.
Tally CountFamily(unsigned parts, double noise)
{
  Tally tally;
  for (unsigned seed = 1; seed <= parts; ++seed)
  {
    Count(Tessellate(PartMaker(seed).Make(), noise, seed), tally);
  }
  for (int t = 0; t < NumSurfaceTypes; ++t)
  {
    const auto at = static_cast<std::size_t>(t);
    ::testing::Test::RecordProperty(ToString(static_cast<SurfaceType>(t)),
      std::to_string(tally.Right[at]) + " of " + std::to_string(tally.Faces[at]));
  }
  return tally;
}
}

/// Every type at least 50 times; errors of radii and axes in diagonals.
TEST(RecognizedParts, FacesOfTessellatedPartsComeBack_IndependentOracle)
{
  const Tally tally = CountFamily(200, 0.0);
  EXPECT_GE(tally.Share(), 0.99);
  EXPECT_LE(tally.LargestError, 1e-5);
  for (int t = 0; t < static_cast<int>(SurfaceType::FreeForm); ++t)
  {
    EXPECT_GE(tally.Faces[static_cast<std::size_t>(t)], 50);
  }
}

/// Noise of a quarter of the tolerance.
TEST(RecognizedParts, FacesOfNoisyParts_IndependentOracle)
{
  EXPECT_GE(CountFamily(60, 0.25).Share(), 0.975);
}

namespace
{
using Edge = std::array<int, 2>;

Edge EdgeOf(int a, int b)
{
  return { std::min(a, b), std::max(a, b) };
}

/// Edges between triangles of two faces that do not meet smoothly.
std::set<Edge> TrueEdges(const Part& exact)
{
  const auto normal = [&](std::size_t t)
  {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d
    { return exact.Mesh.Points.row(exact.Mesh.Triangles[t][k]).transpose(); };
    return Eigen::Vector3d((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized());
  };
  std::set<Edge> edges;
  std::map<Edge, std::size_t> first;
  for (std::size_t t = 0; t < exact.Mesh.Triangles.size(); ++t)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      const auto& corners = exact.Mesh.Triangles[t];
      const Edge edge = EdgeOf(corners[k], corners[(k + 1) % 3]);
      const auto [other, isNew] = first.emplace(edge, t);
      if (!isNew && exact.FaceOfTriangle[t] != exact.FaceOfTriangle[other->second] &&
        normal(t).dot(normal(other->second)) < std::cos(40.0 * Pi / 180.0))
      {
        edges.insert(edge);
      }
    }
  }
  return edges;
}

struct EdgeTally
{
  int True = 0;
  int Found = 0;
  int False = 0;
  int WrongNoise = 0; ///< parts
  double ShareFound() const { return static_cast<double>(this->Found) / this->True; }
  double ShareFalse() const { return static_cast<double>(this->False) / this->True; }
};

void Add(const FeatureChain& chain, const std::set<Edge>& trueEdges, EdgeTally& tally)
{
  const std::size_t count = chain.Points.size();
  for (std::size_t i = 0; i + 1 < count + (chain.Closed ? 1 : 0); ++i)
  {
    const bool isTrue = trueEdges.count(EdgeOf(chain.Points[i], chain.Points[(i + 1) % count])) > 0;
    ++(isTrue ? tally.Found : tally.False);
  }
}

/// Of fitted normals, and of the triangles' own.
std::array<EdgeTally, 2> CountSharpEdges(unsigned parts, double noise)
{
  std::array<EdgeTally, 2> tallies;
  for (unsigned seed = 1; seed <= parts; ++seed)
  {
    const TopoDS_Shape shape = PartMaker(seed).Make();
    const std::set<Edge> trueEdges = TrueEdges(Tessellate(shape, 0.0, seed));
    const Part part = Tessellate(shape, noise, seed);
    ScanFeatureParams params;
    const auto fitted = FindScanFeatures(part.Mesh, params);
    params.Noise = 0.0;
    const auto plain = FindScanFeatures(part.Mesh, params);
    EXPECT_TRUE(fitted && plain) << fitted.Status.Message();
    // uniform in a cube of that half width
    const double deviation = noise * Tolerance * part.Diagonal / 3.0;
    const bool isRight =
      fitted->Noise <= 1e-5 * part.Diagonal + 2.0 * deviation && fitted->Noise >= 0.5 * deviation;
    tallies[0].WrongNoise += isRight ? 0 : 1;
    for (std::size_t i = 0; i < 2; ++i)
    {
      tallies[i].True += static_cast<int>(trueEdges.size());
      for (const FeatureLine& line : (i == 0 ? fitted : plain)->Lines)
      {
        Add(line.Chain, trueEdges, tallies[i]);
      }
    }
  }
  return tallies;
}

std::string Describe(const EdgeTally& tally)
{
  return std::to_string(tally.Found) + " of " + std::to_string(tally.True) + " found, " +
    std::to_string(tally.False) + " false ones, the noise of " + std::to_string(tally.WrongNoise) +
    " parts is wrong";
}

void ExpectSharpEdges(double noise, double leastFound, double mostFalse, double mostFalseOfPlain)
{
  const auto [fitted, plain] = CountSharpEdges(60, noise);
  const std::string name = "noise of " + std::to_string(noise) + " tolerances, ";
  SCOPED_TRACE(name);
  ::testing::Test::RecordProperty(name + "fitted", Describe(fitted));
  ::testing::Test::RecordProperty(name + "plain", Describe(plain));
  EXPECT_EQ(fitted.WrongNoise, 0);
  EXPECT_GE(fitted.ShareFound(), leastFound) << Describe(fitted);
  EXPECT_LE(fitted.ShareFalse(), mostFalse) << Describe(fitted);
  EXPECT_LE(fitted.False, mostFalseOfPlain * plain.False) << Describe(plain);
}
}

/// All of them and no other, with noise of a quarter of the tolerance too.
TEST(SharpEdges, EdgesOfTessellatedParts_IndependentOracle)
{
  ExpectSharpEdges(0.0, 1.0, 0.0, 1.0);
  ExpectSharpEdges(0.25, 1.0, 0.0, 1.0);
}

/// Noise of the tolerance: then the normals of the triangles see many more that are none.
TEST(SharpEdges, EdgesOfVeryNoisyParts_IndependentOracle)
{
  ExpectSharpEdges(0.5, 0.995, 0.005, 0.6);
  ExpectSharpEdges(1.0, 0.975, 0.035, 0.25);
}

namespace
{
struct ModelledParts
{
  int Parts = 0;
  int Right = 0;
  int Faces = 0;     ///< of the parts
  int SameTypes = 0; ///< of them: as many faces of the type are in the model
  std::string Faults;
};

void CountTypes(const Part& part, const RegionModel& model, ModelledParts& tally)
{
  std::array<int, NumSurfaceTypes> counts{};
  for (const BRepAdaptor_Surface& face : part.Faces)
  {
    ++counts[static_cast<std::size_t>(TypeOf(face))];
    ++tally.Faces;
  }
  for (std::size_t type = 0; type < counts.size(); ++type)
  {
    tally.SameTypes += std::min(counts[type], model.NumOfType[type]);
  }
}

/// What is wrong with the CAD file of a part that was modelled from its triangles; empty: nothing.
std::string FaultOf(
  const TopoDS_Shape& shape, const Part& part, double volumeShare, ModelledParts& tally)
{
  RecognitionParams recognition;
  recognition.Tolerance = Tolerance * part.Diagonal;
  const auto model = ModelMesh(part.Mesh, recognition);
  if (!model)
  {
    return model.Status.Message();
  }
  CountTypes(part, model.Value, tally);
  for (const LoopVerdict verdict : model->Verdicts)
  {
    if (verdict != LoopVerdict::SimpleNested)
    {
      return "loops";
    }
  }
  for (const FaceCertificate& certificate : model->Certificates)
  {
    if (certificate.Verdict != Verdict::Valid)
    {
      return "regularity";
    }
  }
  const std::string file = OutputFile("modelled_part.step");
  if (const Status written = WriteCAD(model->Model, file); !written)
  {
    return written.Message();
  }
  const auto found = CheckWrittenCAD(model->Model, file);
  const auto summary = CheckCAD(file);
  if (!found || !summary)
  {
    return found.Status.Message() + ", " + summary.Status.Message();
  }
  if (!summary->Valid || summary->NumSolids != 1 || !summary->Closed)
  {
    return "no valid solid" + (summary->Defects.empty() ? "" : ": " + summary->Defects.front());
  }
  GProp_GProps exact;
  BRepGProp::VolumeProperties(shape, exact, 1e-9);
  if (std::abs(summary->Volume / exact.Mass() - 1.0) > volumeShare)
  {
    return "a volume of " + std::to_string(summary->Volume) + " instead of " +
      std::to_string(exact.Mass());
  }
  return summary->MaxEdgeTolerance > recognition.Tolerance ? "an edge tolerance" : "";
}

ModelledParts ModelFamily(unsigned first, unsigned parts, double noise, double volumeShare)
{
  ModelledParts tally;
  for (unsigned seed = first; seed < first + parts; ++seed)
  {
    const TopoDS_Shape shape = PartMaker(seed).Make();
    const std::string fault = FaultOf(shape, Tessellate(shape, noise, seed), volumeShare, tally);
    ++tally.Parts;
    tally.Right += fault.empty() ? 1 : 0;
    tally.Faults += fault.empty() ? "" : "part " + std::to_string(seed) + ": " + fault + "\n";
  }
  ::testing::Test::RecordProperty(
    "types", std::to_string(tally.SameTypes) + " of " + std::to_string(tally.Faces));
  ::testing::Test::RecordProperty(
    "solids", std::to_string(tally.Right) + " of " + std::to_string(tally.Parts));
  return tally;
}
}

/// Triangles -> faces -> STEP: valid solids of the part's volume. (Points are rounded to float.) In
/// 1170 and 1216 a wide plane between two fillets is near to a cylinder through both.
TEST(ModelledParts, SolidsOfTessellatedParts_IndependentOracle)
{
  const ModelledParts tally = ModelFamily(1150, 100, 0.0, 1e-5);
  EXPECT_EQ(tally.Right, tally.Parts) << tally.Faults;
  EXPECT_EQ(tally.SameTypes, tally.Faces);
}

/// Noise of a quarter of the tolerance: faces that are not recognised become ones of free form.
TEST(ModelledParts, SolidsOfNoisyParts_IndependentOracle)
{
  const ModelledParts tally = ModelFamily(1, 40, 0.25, 2e-2);
  EXPECT_GE(tally.Right, 0.95 * tally.Parts) << tally.Faults;
  EXPECT_GE(tally.SameTypes, 0.93 * tally.Faces);
}
}
