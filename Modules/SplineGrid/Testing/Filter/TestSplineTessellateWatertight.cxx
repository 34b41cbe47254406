// SPDX-License-Identifier: BSD-3-Clause
// No cracks, by point ids alone: levels of a surface, the boundary of a solid, patches that touch.
#include "FilterCases.h"
#include <knotwork/SplineGrid/vtkSplineRefine.h>
#include <knotwork/SplineGrid/vtkSplineTessellate.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSphere.h"

#include <array>
#include <map>
#include <random>
#include <set>

using namespace knotwork;

namespace
{
using Edge = std::pair<vtkIdType, vtkIdType>;
using Place = std::array<double, 3>;

/// The grid refined three times around a ball: levels 0 to 3.
vtkSmartPointer<vtkUnstructuredGrid> RefineAround(
  vtkUnstructuredGrid* grid, double x, double y, double z, double radius)
{
  vtkNew<vtkSphere> ball;
  ball->SetCenter(x, y, z);
  ball->SetRadius(radius);
  vtkNew<vtkSplineRefine> refine;
  refine->SetInputDataObject(grid);
  refine->SetMode(vtkSplineRefine::IMPLICIT_FUNCTION);
  refine->SetImplicitFunction(ball);
  refine->SetNumberOfRefinements(3);
  refine->Update();
  EXPECT_EQ(refine->GetErrorCode(), vtkErrorCode::NoError);
  auto refined = vtkSmartPointer<vtkUnstructuredGrid>::New();
  refined->DeepCopy(refine->GetOutputDataObject(0));
  EXPECT_EQ(refined->GetCellData()->GetArray("Level")->GetRange()[0], 0.0);
  EXPECT_EQ(refined->GetCellData()->GetArray("Level")->GetRange()[1], 3.0);
  return refined;
}

vtkSmartPointer<vtkPolyData> Tessellate(
  vtkDataObject* data, double tolerance, bool splitting = false)
{
  vtkNew<vtkSplineTessellate> filter;
  filter->SetInputDataObject(data);
  filter->SetChordalTolerance(tolerance);
  filter->SetSplitting(splitting);
  filter->Update();
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0));
}

/// How often polygons use an edge along (first) and against (second) ascending ids. The number of a
/// point may be replaced by that of another.
struct Topology
{
  std::map<Edge, std::pair<int, int>> Edges;
  std::set<vtkIdType> Points;
  vtkIdType Polygons = 0;

  explicit Topology(vtkPolyData* mesh, const std::vector<vtkIdType>& number = {})
  {
    vtkCellArray* polygons = mesh->GetPolys();
    this->Polygons = polygons->GetNumberOfCells();
    for (vtkIdType c = 0; c < this->Polygons; ++c)
    {
      vtkIdType n = 0;
      const vtkIdType* ids = nullptr;
      polygons->GetCellAtId(c, n, ids);
      for (vtkIdType k = 0; k < n; ++k)
      {
        const auto of = [&](vtkIdType i)
        { return number.empty() ? ids[i] : number[static_cast<std::size_t>(ids[i])]; };
        const vtkIdType a = of(k);
        const vtkIdType b = of((k + 1) % n);
        EXPECT_NE(a, b) << "polygon " << c << " has an edge without length";
        std::pair<int, int>& use = this->Edges[std::minmax(a, b)];
        ++(a < b ? use.first : use.second);
        this->Points.insert(a);
      }
    }
  }

  /// Edges of one polygon only; every other edge must have two of opposite direction.
  std::vector<Edge> Open() const
  {
    std::vector<Edge> open;
    for (const auto& [edge, use] : this->Edges)
    {
      if (use.first + use.second == 1)
      {
        open.push_back(edge);
        continue;
      }
      EXPECT_EQ(use.first, 1) << edge.first << " " << edge.second;
      EXPECT_EQ(use.second, 1) << edge.first << " " << edge.second;
    }
    return open;
  }

  long EulerCharacteristic() const
  {
    return long(this->Points.size()) - long(this->Edges.size()) + long(this->Polygons);
  }
};

/// True when the edges form one closed line without a branch.
bool IsOneLoop(const std::vector<Edge>& edges)
{
  std::map<vtkIdType, std::vector<vtkIdType>> neighbours;
  for (const Edge& edge : edges)
  {
    neighbours[edge.first].push_back(edge.second);
    neighbours[edge.second].push_back(edge.first);
  }
  if (edges.empty() ||
    std::any_of(neighbours.begin(), neighbours.end(),
      [](const auto& point) { return point.second.size() != 2; }))
  {
    return false;
  }
  const vtkIdType start = edges[0].first;
  vtkIdType before = start;
  vtkIdType at = edges[0].second;
  std::size_t steps = 1;
  for (; at != start; ++steps)
  {
    const std::vector<vtkIdType>& ways = neighbours[at];
    const vtkIdType next = ways[0] == before ? ways[1] : ways[0];
    before = at;
    at = next;
  }
  return steps == edges.size();
}

/// For every point the first one with the same coordinates, bit for bit.
std::vector<vtkIdType> FirstWithSameBits(vtkPolyData* mesh)
{
  std::map<Place, vtkIdType> first;
  std::vector<vtkIdType> number;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    const double* x = mesh->GetPoint(i);
    number.push_back(first.emplace(Place{ x[0], x[1], x[2] }, i).first->second);
  }
  return number;
}

/// Parameters of a point in the domain of the only patch; dyadic knots make them exact.
std::array<double, 2> Parameters(vtkPolyData* mesh, const SplineSpace<2>& space, vtkIdType point)
{
  const auto element =
    static_cast<std::size_t>(mesh->GetPointData()->GetArray("ElementId")->GetTuple1(point));
  vtkDataArray* local = mesh->GetPointData()->GetArray("LocalParameters");
  std::array<double, 2> result{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    const auto& box = space.Elements[element].Box;
    result[d] = box.Lower[d] + local->GetComponent(point, int(d)) * (box.Upper[d] - box.Lower[d]);
  }
  return result;
}

/// A square over which random heights lie.
vtkSmartPointer<vtkUnstructuredGrid> Hills(unsigned seed)
{
  SplineModel model =
    DecodePatches(ShapeGrid(vtkSplineSource::SQUARE, 1 + int(seed % 3), { 4, 4, 1 }));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> height(-0.2, 0.2);
  auto& spline = std::get<Spline<2>>(model.Patches[0].Geometry);
  for (Eigen::Index i = 0; i < spline.ControlPoints.rows(); ++i)
  {
    spline.ControlPoints(i, 2) = height(random);
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  EXPECT_TRUE(EncodeSplineGrid(model, grid));
  return grid;
}
}

TEST(SplineTessellateWatertight, SurfaceOfSeveralLevelsHasOnlyItsFourSides_ExactOracle)
{
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    // in the middle, at a side, at a corner
    const double at[3] = { 0.01, -0.25, -0.5 };
    auto grid = RefineAround(Hills(seed), at[seed % 3], at[(seed / 3) % 3], 0.0, 0.25);
    const SplineModel model = DecodePatches(grid);
    const auto& space = *std::get<Spline<2>>(model.Patches[0].Geometry).Space;
    for (const double tolerance : { 1e-2, 1e-3 })
    {
      auto mesh = Tessellate(grid, tolerance);
      const Topology topology(mesh);
      EXPECT_EQ(topology.EulerCharacteristic(), 1);
      EXPECT_EQ(topology.Points.size(), std::size_t(mesh->GetNumberOfPoints()));
      const std::vector<Edge> open = topology.Open();
      EXPECT_TRUE(IsOneLoop(open));
      // An open edge lies on one of the sides u = 0, u = 1, v = 0, v = 1; every side is a row of
      // edges from corner to corner.
      std::array<std::map<double, double>, 4> sides;
      for (const Edge& edge : open)
      {
        const auto a = Parameters(mesh, space, edge.first);
        const auto b = Parameters(mesh, space, edge.second);
        int found = 0;
        for (std::size_t side = 0; side < 4; ++side)
        {
          const std::size_t d = side / 2;
          const double end = side % 2 == 0 ? 0.0 : 1.0;
          if (a[d] == end && b[d] == end)
          {
            ++found;
            sides[side][std::min(a[1 - d], b[1 - d])] = std::max(a[1 - d], b[1 - d]);
          }
        }
        EXPECT_EQ(found, 1) << "a crack at " << a[0] << " " << a[1];
      }
      std::size_t rows = 0;
      for (const auto& side : sides)
      {
        double position = 0.0;
        for (const auto& [begin, end] : side)
        {
          EXPECT_EQ(begin, position);
          position = end;
        }
        EXPECT_EQ(position, 1.0);
        rows += side.size();
      }
      EXPECT_EQ(rows, open.size());
    }
  }
}

TEST(SplineTessellateWatertight, BoundaryOfASolidOfSeveralLevelsIsClosed_ExactOracle)
{
  auto bar = ShapeGrid(vtkSplineSource::TWISTED_BAR, 2, { 6, 6, 6 });
  for (const double corner : { 0.0, 0.3, 0.5 }) // inside, below the faces, at a corner
  {
    SCOPED_TRACE("refined at " + std::to_string(corner));
    auto grid = RefineAround(bar, corner, corner, corner, 0.1);
    for (const double tolerance : { 3e-2, 2e-3 })
    {
      auto mesh = Tessellate(grid, tolerance);
      const Topology topology(mesh);
      EXPECT_TRUE(topology.Open().empty());
      EXPECT_EQ(topology.EulerCharacteristic(), 2);
      EXPECT_EQ(mesh->GetCellData()->GetArray("Level")->GetRange()[1], corner == 0.0 ? 0.0 : 3.0);
    }
  }
}

TEST(SplineTessellateWatertight, PatchesThatTouchShareTheirPoints_ExactOracle)
{
  // At a corner of the core three patches meet; each is refined there alike.
  const double middle = 0.5 / std::sqrt(2.0);
  auto disc =
    RefineAround(ShapeGrid(vtkSplineSource::DISC, 3, { 4, 4, 1 }), middle, middle, 0.0, 1e-6);
  std::set<double> refinedPatches;
  for (vtkIdType c = 0; c < disc->GetNumberOfCells(); ++c)
  {
    if (disc->GetCellData()->GetArray("Level")->GetTuple1(c) == 3.0)
    {
      refinedPatches.insert(disc->GetCellData()->GetArray("PatchId")->GetTuple1(c));
    }
  }
  EXPECT_EQ(refinedPatches.size(), 3u);
  for (const double tolerance : { 1e-2, 1e-4 })
  {
    auto mesh = Tessellate(disc, tolerance);
    const Topology topology(mesh);
    const std::vector<Edge> open = topology.Open();
    EXPECT_TRUE(IsOneLoop(open));
    EXPECT_EQ(topology.EulerCharacteristic(), 1);
    for (const Edge& edge : open)
    {
      const double* x = mesh->GetPoint(edge.first);
      EXPECT_NEAR(std::hypot(x[0], x[1]), 1.0, 1e-14) << "rounding of a point of the rim";
    }
    // Splitting repeats the points of the interfaces bit for bit: cut there, and whole again when
    // equal coordinates are one point.
    auto split = Tessellate(disc, tolerance, true);
    EXPECT_GT(Topology(split).Open().size(), open.size());
    const Topology joined(split, FirstWithSameBits(split));
    EXPECT_EQ(joined.Open().size(), open.size());
    EXPECT_EQ(joined.Points.size(), topology.Points.size());
    EXPECT_EQ(joined.EulerCharacteristic(), 1);
  }

  auto cylinder = RefineAround(
    ShapeGrid(vtkSplineSource::SOLID_CYLINDER, 2, { 4, 4, 3 }), middle, middle, 0.5, 1e-6);
  auto mesh = Tessellate(cylinder, 5e-3);
  const Topology topology(mesh);
  EXPECT_TRUE(topology.Open().empty());
  EXPECT_EQ(topology.EulerCharacteristic(), 2);
}
