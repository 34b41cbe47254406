// SPDX-License-Identifier: BSD-3-Clause
// Solids of known volume, meshed in a process; what cannot be meshed is one error.
#include "FilterCases.h"
#include <knotwork/JacobianValidation/vtkJacobianValidator.h>
#include <knotwork/SplineGrid/WorkerProcess.h>
#include <knotwork/TetMeshing/vtkTetGenMesher.h>

#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCubeSource.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkReverseSense.h"
#include "vtkSphereSource.h"
#include "vtkTable.h"
#include "vtkTetra.h"
#include "vtkVariant.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

using namespace knotwork;

namespace
{
vtkSmartPointer<vtkPolyData> Box(double size, double at = 0.0, bool inward = false)
{
  vtkNew<vtkCubeSource> source;
  source->SetXLength(size);
  source->SetYLength(size);
  source->SetZLength(size);
  source->SetCenter(at, 0.0, 0.0);
  vtkNew<vtkReverseSense> reverse;
  reverse->SetInputConnection(source->GetOutputPort());
  reverse->Update();
  source->Update();
  auto box = vtkSmartPointer<vtkPolyData>::New();
  box->DeepCopy(inward ? reverse->GetOutput() : source->GetOutput());
  return box;
}

vtkSmartPointer<vtkPolyData> Together(vtkPolyData* a, vtkPolyData* b)
{
  vtkNew<vtkAppendPolyData> append;
  append->AddInputData(a);
  append->AddInputData(b);
  append->Update();
  return append->GetOutput();
}

double Number(vtkTetGenMesher* filter, const char* name)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(2))->GetValueByName(0, name).ToDouble();
}

vtkUnstructuredGrid* Cells(vtkTetGenMesher* filter)
{
  return vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
}

std::vector<std::string> ErrorsOf(vtkTetGenMesher* filter)
{
  vtkNew<MessageRecorder> recorder;
  recorder->Watch(filter);
  filter->Modified();
  filter->Update();
  EXPECT_EQ(Cells(filter)->GetNumberOfCells(), 0);
  // the pipeline says that the filter failed, too
  std::vector<std::string> errors;
  for (const std::string& error : recorder->Errors)
  {
    if (error.find("returned failure") == std::string::npos)
    {
      errors.push_back(error);
    }
  }
  filter->RemoveObserver(recorder);
  filter->GetExecutive()->RemoveObserver(recorder);
  return errors;
}
}

TEST(vtkTetGenMesher, BoxesHaveTheirVolumes)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  filter->SetEdgeLength(0.5);
  for (const bool kept : { true, false })
  {
    filter->SetKeepBoundary(kept);
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    EXPECT_NEAR(Number(filter, "Volume"), 8.0, 1e-11);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 8.0, 1e-11);
    EXPECT_EQ(Number(filter, "BoundaryTriangles") == 12, kept);
    EXPECT_NEAR(Number(filter, "DistanceToSurface"), 0.0, 1e-3);
    if (!kept) // beside large triangles that stay cells stay large
    {
      EXPECT_GE(Cells(filter)->GetNumberOfCells(), 8.0 / (0.125 / 6.0 / std::sqrt(2.0)));
    }
  }
}

/// Triangles of any order behind the tetrahedra: on the faces of a box by number, outward, each
/// with the points that its tetrahedron has there; those between two regions once.
TEST(vtkTetGenMesher, TrianglesOfTheBoundaryAreCells_ExactOracle)
{
  const auto surface = Together(Box(2.0), Box(1.0));
  vtkNew<vtkIntArray> faces;
  faces->SetName("FaceId");
  for (int i = 0; i < 12; ++i) // six quadrilaterals each
  {
    faces->InsertNextValue(10 + i);
  }
  surface->GetCellData()->AddArray(faces);
  for (const int order : { 1, 2, 3 })
  {
    vtkNew<vtkTetGenMesher> filter;
    filter->SetInputDataObject(surface);
    filter->SetInner(vtkTetGenMesher::REGIONS);
    filter->SetEdgeLength(0.6);
    filter->SetKeepBoundary(false);
    filter->SetOrder(order);
    filter->BoundaryCellsOn();
    filter->Update();
    ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
    vtkUnstructuredGrid* grid = Cells(filter);
    const auto tetrahedra = static_cast<vtkIdType>(Number(filter, "Tetrahedra"));
    ASSERT_EQ(grid->GetNumberOfCells(), tetrahedra + Number(filter, "BoundaryTriangles"));
    vtkDataArray* ids = grid->GetCellData()->GetArray("BoundaryId");
    vtkDataArray* regions = grid->GetCellData()->GetArray("Region");
    ASSERT_EQ(ids->GetNumberOfTuples(), grid->GetNumberOfCells());
    std::map<std::array<vtkIdType, 3>, std::vector<vtkIdType>> cellsWith; // three corners
    for (vtkIdType c = 0; c < tetrahedra; ++c)
    {
      EXPECT_EQ(ids->GetTuple1(c), -1.0);
      const vtkIdType* points = grid->GetCell(c)->GetPointIds()->GetPointer(0);
      for (int opposite = 0; opposite < 4; ++opposite)
      {
        std::array<vtkIdType, 3> corners{ points[(opposite + 1) % 4], points[(opposite + 2) % 4],
          points[(opposite + 3) % 4] };
        std::sort(corners.begin(), corners.end());
        cellsWith[corners].push_back(c);
      }
    }
    std::map<int, double> areas;
    for (vtkIdType c = tetrahedra; c < grid->GetNumberOfCells(); ++c)
    {
      vtkCell* cell = grid->GetCell(c);
      ASSERT_EQ(cell->GetCellDimension(), 2);
      vtkIdList* points = cell->GetPointIds();
      ASSERT_EQ(points->GetNumberOfIds(), (order + 1) * (order + 2) / 2);
      std::array<vtkIdType, 3> corners{ points->GetId(0), points->GetId(1), points->GetId(2) };
      double x[3][3];
      for (int k = 0; k < 3; ++k)
      {
        grid->GetPoint(corners[static_cast<std::size_t>(k)], x[k]);
      }
      const Eigen::Vector3d a(x[0]);
      const Eigen::Vector3d normal =
        (Eigen::Vector3d(x[1]) - a).cross(Eigen::Vector3d(x[2]) - a) / 2.0;
      const int id = static_cast<int>(ids->GetTuple1(c));
      areas[id] += normal.norm();
      std::sort(corners.begin(), corners.end());
      const auto& beside = cellsWith.at(corners);
      EXPECT_EQ(beside.size(), id < 16 ? 1u : 2u);
      if (id < 16)
      {
        EXPECT_GT(normal.dot(a), 0.0); // outward of the box around the origin
      }
      EXPECT_EQ(regions->GetTuple1(c), regions->GetTuple1(beside.front()));
      for (vtkIdType k = 0; k < points->GetNumberOfIds(); ++k)
      {
        for (const vtkIdType tetrahedron : beside)
        {
          EXPECT_GE(grid->GetCell(tetrahedron)->GetPointIds()->IsId(points->GetId(k)), 0);
        }
      }
      // points of an edge in the order of VTK: the first one behind the corners is on the edge 0, 1
      if (order > 1)
      {
        double middle[3];
        grid->GetPoint(points->GetId(3), middle);
        const double share = order == 2 ? 0.5 : 1.0 / 3.0;
        EXPECT_LT(
          (Eigen::Vector3d(middle) - a - share * (Eigen::Vector3d(x[1]) - a)).norm(), 1e-12);
      }
    }
    ASSERT_EQ(areas.size(), 12u);
    for (const auto& [id, area] : areas)
    {
      EXPECT_NEAR(area, id < 16 ? 4.0 : 1.0, 1e-12);
    }
  }
}

TEST(vtkTetGenMesher, PartsWithinAreVoidsOrRegions)
{
  for (const bool inward : { false, true })
  {
    vtkNew<vtkTetGenMesher> filter;
    filter->SetInputDataObject(Together(Together(Box(3.0), Box(2.0, 0.0, inward)), Box(1.0, 0.0)));
    filter->Update();
    EXPECT_NEAR(Number(filter, "Volume"), 27.0 - 8.0 + 1.0, 1e-10);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 20.0, 1e-10);
    EXPECT_EQ(Number(filter, "Regions"), 2);
    filter->SetInner(vtkTetGenMesher::REGIONS);
    filter->Update();
    EXPECT_NEAR(Number(filter, "Volume"), 27.0, 1e-10);
    EXPECT_NEAR(Number(filter, "SurfaceVolume"), 27.0, 1e-10);
    EXPECT_EQ(Number(filter, "Regions"), 3);
  }
}

/// Curved cells of a ball and a torus: the volume's error falls with the fourth power of the size,
/// the distance is far below that of straight cells, and the validator agrees with the certificate.
/// Half of a box gets edges of a quarter of those of the other half; every cell keeps to the bound
/// at its middle.
TEST(vtkTetGenMesher, SizesAreThoseOfAField)
{
  vtkNew<vtkImageData> field;
  field->SetDimensions(5, 2, 2);
  field->SetOrigin(-1.0, -1.0, -1.0);
  field->SetSpacing(0.5, 2.0, 2.0);
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  const auto lengthAt = [](double x) { return 0.5 + 0.375 * x; };
  for (vtkIdType p = 0; p < field->GetNumberOfPoints(); ++p)
  {
    lengths->InsertNextValue(lengthAt(field->GetPoint(p)[0]));
  }
  field->GetPointData()->AddArray(lengths);
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  filter->SetKeepBoundary(false);
  filter->SetRadiusEdgeRatio(0.0);
  filter->SetMinDihedralAngle(0.0);
  filter->SetSizeData(field);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NEAR(Number(filter, "Volume"), 8.0, 1e-11);
  std::array<int, 2> counts{};
  vtkUnstructuredGrid* cells = Cells(filter);
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    vtkPoints* corners = cells->GetCell(c)->GetPoints();
    std::array<std::array<double, 3>, 4> x{};
    double middle = 0.0;
    for (vtkIdType k = 0; k < 4; ++k)
    {
      corners->GetPoint(k, x[static_cast<std::size_t>(k)].data());
      middle += x[static_cast<std::size_t>(k)][0] / 4.0;
    }
    const double volume =
      std::abs(vtkTetra::ComputeVolume(x[0].data(), x[1].data(), x[2].data(), x[3].data()));
    EXPECT_LE(volume, std::pow(lengthAt(middle), 3) / (6.0 * std::sqrt(2.0)) * (1.0 + 1e-9)) << c;
    ++counts[middle < 0.0 ? 0 : 1];
  }
  EXPECT_GT(counts[0], 5 * counts[1]);
}

TEST(vtkTetGenMesher, RegionsHaveSizesOfTheirOwn)
{
  vtkNew<vtkPolyData> seeds;
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(1.4, 1.4, 1.4); // between the boxes
  seeds->SetPoints(places);
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  lengths->InsertNextValue(0.4);
  seeds->GetPointData()->AddArray(lengths);
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Together(Box(4.0), Box(2.0)));
  filter->SetInner(vtkTetGenMesher::REGIONS);
  filter->SetKeepBoundary(false);
  filter->SetSizeData(seeds);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  std::map<bool, double> largest; // volume of a cell, inside or outside of the inner box
  vtkUnstructuredGrid* cells = Cells(filter);
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    double bounds[6];
    cells->GetCell(c)->GetBounds(bounds);
    const bool isInside = *std::max_element(bounds, bounds + 6) <= 1.0 + 1e-9 &&
      *std::min_element(bounds, bounds + 6) >= -1.0 - 1e-9;
    double x[4][3];
    for (vtkIdType k = 0; k < 4; ++k)
    {
      cells->GetCell(c)->GetPoints()->GetPoint(k, x[k]);
    }
    double& most = largest[isInside];
    most = std::max(most, std::abs(vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3])));
  }
  const double bound = std::pow(0.4, 3) / (6.0 * std::sqrt(2.0));
  EXPECT_LE(largest[false], bound * (1.0 + 1e-9));
  EXPECT_GT(largest[true], bound);
}

TEST(vtkTetGenMesher, CellsLargerThanAskedForAreToldOf)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  filter->SetEdgeLength(0.3);
  filter->SetKeepBoundary(false);
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->Update();
  const double bound = std::pow(0.3, 3) / (6.0 * std::sqrt(2.0)) * (1.0 + 1e-9);
  const auto count = [&]
  {
    int larger = 0;
    vtkUnstructuredGrid* cells = Cells(filter);
    for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
    {
      double x[4][3];
      for (vtkIdType k = 0; k < 4; ++k)
      {
        cells->GetCell(c)->GetPoints()->GetPoint(k, x[k]);
      }
      larger += std::abs(vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3])) > bound ? 1 : 0;
    }
    return larger;
  };
  EXPECT_EQ(count(), 0);
  EXPECT_EQ(Number(filter, "OversizedElements"), 0.0);
  EXPECT_TRUE(messages->Warnings.empty());
  filter->SetMaxSteinerPoints(20); // too few
  filter->Update();
  EXPECT_GT(count(), 0);
  EXPECT_EQ(Number(filter, "OversizedElements"), count());
  ASSERT_EQ(messages->Warnings.size(), 1U);
  EXPECT_NE(messages->Warnings[0].find("larger than was asked for"), std::string::npos);

  // the same of a field
  vtkNew<vtkImageData> field;
  field->SetDimensions(2, 2, 2);
  field->SetOrigin(-1.0, -1.0, -1.0);
  field->SetSpacing(2.0, 2.0, 2.0);
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  lengths->SetNumberOfTuples(8);
  lengths->Fill(0.3);
  field->GetPointData()->AddArray(lengths);
  filter->SetEdgeLength(0.0);
  filter->SetSizeData(field);
  filter->Update();
  EXPECT_GT(count(), 0);
  EXPECT_EQ(Number(filter, "OversizedElements"), count());
}

TEST(vtkTetGenMesher, OptionsOfOtherInputsAreToldOf)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  filter->SetSolid(vtkTetGenMesher::ABOVE);
  filter->SetLevel(1.0);
  vtkNew<MessageRecorder> messages;
  messages->Watch(filter);
  filter->Update();
  ASSERT_EQ(messages->Warnings.size(), 1U);
  EXPECT_NE(messages->Warnings[0].find("Solid, Level did not count"), std::string::npos)
    << messages->Warnings[0];
}

TEST(vtkTetGenMesher, SizesThatAreNoneAreErrors)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(2.0));
  vtkNew<vtkPolyData> seeds;
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(0.0, 0.0, 0.0);
  seeds->SetPoints(places);
  filter->SetSizeData(seeds);
  const auto error = [&]
  {
    const auto errors = ErrorsOf(filter);
    return errors.size() == 1 ? errors.front() : std::to_string(errors.size()) + " errors";
  };
  EXPECT_NE(error().find("0 arrays of one component"), std::string::npos) << error();
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  lengths->InsertNextValue(-0.4);
  seeds->GetPointData()->AddArray(lengths);
  EXPECT_NE(error().find("'Length' is not above 0 at point 0"), std::string::npos) << error();
  lengths->SetValue(0, 0.4);
  filter->SetSizeArray("Width");
  EXPECT_NE(error().find("no array 'Width'"), std::string::npos) << error();
  filter->SetSizeArray("Length");
  places->SetPoint(0, 3.0, 0.0, 0.0);
  EXPECT_NE(error().find("(3, 0, 0)"), std::string::npos) << error();
  const auto polygons = Box(1.0);
  vtkNew<vtkDoubleArray> eight;
  eight->SetName("Length");
  eight->SetNumberOfTuples(polygons->GetNumberOfPoints());
  eight->Fill(1.0);
  polygons->GetPointData()->AddArray(eight);
  filter->SetSizeData(polygons);
  EXPECT_NE(error().find("no volumes"), std::string::npos) << error();
}

namespace
{
/// Values in the cube [-1, 1]^3.
template <typename Array = vtkDoubleArray, typename Value>
vtkSmartPointer<vtkImageData> Image(int points, const Value& valueAt)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(points, points, points);
  image->SetOrigin(-1.0, -1.0, -1.0);
  const double step = 2.0 / (points - 1);
  image->SetSpacing(step, step, step);
  vtkNew<Array> values;
  values->SetName("Values");
  for (vtkIdType p = 0; p < image->GetNumberOfPoints(); ++p)
  {
    double x[3];
    image->GetPoint(p, x);
    values->InsertNextValue(valueAt(x));
  }
  image->GetPointData()->SetScalars(values);
  return image;
}

double DistanceFrom(const double* x, double cx, double cy, double cz)
{
  return std::sqrt(
    (x[0] - cx) * (x[0] - cx) + (x[1] - cy) * (x[1] - cy) + (x[2] - cz) * (x[2] - cz));
}

/// Volumes of the tetrahedra of each label.
std::map<int, double> VolumesOfLabels(vtkTetGenMesher* filter)
{
  std::map<int, double> volumes;
  vtkUnstructuredGrid* cells = Cells(filter);
  vtkDataArray* labels = cells->GetCellData()->GetArray("Label");
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c)
  {
    double x[4][3];
    for (vtkIdType k = 0; k < 4; ++k)
    {
      cells->GetCell(c)->GetPoints()->GetPoint(k, x[k]);
    }
    volumes[static_cast<int>(labels->GetComponent(c, 0))] +=
      std::abs(vtkTetra::ComputeVolume(x[0], x[1], x[2], x[3]));
  }
  return volumes;
}
}

TEST(vtkTetGenMesher, ImplicitFunctionsAreFilled)
{
  constexpr double radius = 0.8;
  const auto ball = Image(41, [](const double* x) { return DistanceFrom(x, 0, 0, 0) - radius; });
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(ball);
  filter->SetEdgeLength(0.25);
  filter->SetChordalTolerance(2e-3);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, "Regions"), 1);
  EXPECT_EQ(VolumesOfLabels(filter).count(1), 1u);
  const double volume = 4.0 / 3.0 * std::acos(-1.0) * radius * radius * radius;
  EXPECT_NEAR(Number(filter, "Volume"), volume, 0.02 * volume); // chords, and interpolation
  auto* boundary = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_GT(boundary->GetNumberOfCells(), 100);
  vtkCellArray* triangles = boundary->GetPolys();
  vtkNew<vtkIdList> corners;
  for (vtkIdType t = 0; t < triangles->GetNumberOfCells(); ++t)
  {
    triangles->GetCellAtId(t, corners);
    for (vtkIdType k = 0; k < 3; ++k)
    {
      // the values are interpolated between points that are 0.05 apart: 0.05^2 / (8 radius)
      const double* x = boundary->GetPoint(corners->GetId(k));
      EXPECT_NEAR(DistanceFrom(x, 0, 0, 0), radius, 1.5e-3);
    }
  }
  for (vtkIdType c = 0; c < Cells(filter)->GetNumberOfCells(); ++c)
  {
    ASSERT_EQ(Cells(filter)->GetCellData()->GetArray("Verdict")->GetComponent(c, 0), 1.0);
  }
  // the same mesh each time, whether the values have a name or not
  ball->GetPointData()->GetScalars()->SetName(nullptr);
  vtkNew<vtkTetGenMesher> again;
  again->SetInputDataObject(ball);
  again->SetEdgeLength(0.25);
  again->SetChordalTolerance(2e-3);
  again->Update();
  ASSERT_EQ(Cells(again)->GetNumberOfPoints(), Cells(filter)->GetNumberOfPoints());
  for (vtkIdType p = 0; p < Cells(filter)->GetNumberOfPoints(); ++p)
  {
    std::array<double, 3> x{};
    Cells(filter)->GetPoint(p, x.data());
    ASSERT_EQ(DistanceFrom(Cells(again)->GetPoint(p), x[0], x[1], x[2]), 0.0);
  }
  // what is above is the rest of the cube
  filter->SetSolid(vtkTetGenMesher::ABOVE);
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 8.0 - volume, 0.04 * volume);
  // onto the sphere itself
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(radius);
  sphere->SetThetaResolution(200);
  sphere->SetPhiResolution(200);
  sphere->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  sphere->Update();
  filter->SetSolid(vtkTetGenMesher::BELOW);
  filter->SetTargetData(sphere->GetOutput());
  filter->SetOrder(2);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Cells(filter)->GetCellType(0), VTK_QUADRATIC_TETRA);
  EXPECT_NEAR(Number(filter, "Volume"), volume, 1e-3 * volume);
  EXPECT_LT(Number(filter, "CurvedToTarget"), 0.2 * Number(filter, "StraightToTarget"));
  EXPECT_EQ(Cells(filter)->GetCellData()->GetArray("Label")->GetNumberOfTuples(),
    Cells(filter)->GetNumberOfCells());
}

/// A ball of two labels, and a small one that no ray from the middle is sure to meet.
TEST(vtkTetGenMesher, LabelsOfAnImageAreRegions)
{
  const auto image = Image<vtkIntArray>(41,
    [](const double* x)
    {
      return DistanceFrom(x, -0.2, 0, 0) < 0.6  ? (x[2] < 0.0 ? 3 : 7)
        : DistanceFrom(x, 0.8, 0.8, 0.8) < 0.12 ? 5
                                                : 0;
    });
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(image);
  filter->SetSolid(vtkTetGenMesher::LABELS);
  filter->SetChordalTolerance(5e-3);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Number(filter, "Regions"), 3);
  const auto volumes = VolumesOfLabels(filter);
  ASSERT_EQ(volumes.size(), 3u);
  const double half = 2.0 / 3.0 * std::acos(-1.0) * 0.6 * 0.6 * 0.6;
  EXPECT_NEAR(volumes.at(3), half, 0.1 * half); // borders lie anywhere between points
  EXPECT_NEAR(volumes.at(7), half, 0.1 * half);
  EXPECT_GT(volumes.at(5), 0.003); // of 0.007
  const vtkIdType coarse = Cells(filter)->GetNumberOfCells();
  // one of the regions finer
  vtkNew<vtkPolyData> seeds;
  vtkNew<vtkPoints> places;
  places->InsertNextPoint(-0.2, 0.0, 0.3);
  seeds->SetPoints(places);
  vtkNew<vtkDoubleArray> lengths;
  lengths->SetName("Length");
  lengths->InsertNextValue(0.1);
  seeds->GetPointData()->AddArray(lengths);
  filter->SetSizeData(seeds);
  filter->Update();
  ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
  std::map<int, int> counts;
  for (vtkIdType c = 0; c < Cells(filter)->GetNumberOfCells(); ++c)
  {
    ++counts[static_cast<int>(Cells(filter)->GetCellData()->GetArray("Label")->GetComponent(c, 0))];
  }
  EXPECT_GT(Cells(filter)->GetNumberOfCells(), coarse);
  EXPECT_GT(counts[7], 2 * counts[3]);
}

TEST(vtkTetGenMesher, ImagesThatAreNoneAreErrors)
{
  vtkNew<vtkTetGenMesher> filter;
  const auto error = [&](vtkImageData* image)
  {
    filter->SetInputDataObject(image);
    const auto errors = ErrorsOf(filter);
    return errors.size() == 1 ? errors.front() : std::to_string(errors.size()) + " errors";
  };
  auto image = Image(5, [](const double* x) { return DistanceFrom(x, 0, 0, 0) + 1.0; });
  EXPECT_NE(error(image).find("nothing is solid"), std::string::npos) << error(image);
  filter->SetImageArray("Heights");
  EXPECT_NE(error(image).find("no point array 'Heights'"), std::string::npos) << error(image);
  filter->SetImageArray(nullptr);
  vtkDataArray* values = image->GetPointData()->GetScalars();
  filter->SetSolid(vtkTetGenMesher::LABELS);
  EXPECT_NE(error(image).find("at point 0 is no whole number"), std::string::npos) << error(image);
  filter->SetSolid(vtkTetGenMesher::BELOW);
  values->SetComponent(7, 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(error(image).find("at point 7 is no number"), std::string::npos) << error(image);
  vtkNew<vtkImageData> flat;
  flat->SetDimensions(5, 5, 1);
  flat->AllocateScalars(VTK_DOUBLE, 1);
  vtkNew<vtkTetGenMesher> other;
  other->SetInputDataObject(flat);
  const auto errors = ErrorsOf(other);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors.front().find("5 x 5 x 1"), std::string::npos) << errors.front();
}

TEST(vtkTetGenMesher, CurvedCellsFollowTheirTarget)
{
  const struct
  {
    int Shape;
    double Volume;
    double Tolerances[2];
  } cases[] = { { vtkSplineSource::BALL, 4.0 / 3.0 * M_PI, { 0.02, 0.005 } },
    { vtkSplineSource::SOLID_TORUS, M_PI * M_PI / 8.0, { 0.004, 0.001 } } };
  for (const auto& c : cases)
  {
    for (const int order : { 2, 3 })
    {
      SCOPED_TRACE(std::to_string(c.Shape) + ", order " + std::to_string(order));
      double errors[2] = {};
      for (int i = 0; i < 2; ++i)
      {
        vtkNew<vtkTetGenMesher> filter;
        filter->SetInputDataObject(ShapeGrid(c.Shape));
        filter->SetChordalTolerance(c.Tolerances[i]);
        filter->SetOrder(order);
        filter->Update();
        ASSERT_EQ(filter->GetErrorCode(), vtkErrorCode::NoError);
        errors[i] = std::abs(Number(filter, "Volume") - c.Volume);
        EXPECT_LE(Number(filter, "CurvedToTarget"), 0.1 * Number(filter, "StraightToTarget"));
        EXPECT_LE(Number(filter, "RelaxedElements"), 0.02 * Number(filter, "BoundaryElements"));
        vtkNew<vtkJacobianValidator> validator;
        validator->SetInputDataObject(Cells(filter));
        validator->SetInjectivity(false);
        validator->SetMeasures(false);
        validator->Update();
        double verdicts[2];
        vtkUnstructuredGrid::SafeDownCast(validator->GetOutputDataObject(0))
          ->GetCellData()
          ->GetArray("JacobianVerdict")
          ->GetRange(verdicts);
        EXPECT_EQ(verdicts[0], 1.0);
        EXPECT_GT(Number(filter, "MinJacobianLower"), 0.0);
      }
      EXPECT_GT(errors[0] / errors[1], 10.0) << errors[0] << " " << errors[1];
    }
  }
}

TEST(vtkTetGenMesher, DamageIsOneErrorWithItsPlace)
{
  vtkNew<vtkTetGenMesher> filter;
  const auto expect = [&](vtkPolyData* surface, const char* words)
  {
    filter->SetInputDataObject(surface);
    const auto errors = ErrorsOf(filter);
    ASSERT_EQ(errors.size(), 1u) << words;
    EXPECT_NE(errors[0].find(words), std::string::npos) << errors[0];
  };
  auto open = Box(1.0);
  vtkNew<vtkCellArray> faces;
  for (vtkIdType f = 1; f < 6; ++f)
  {
    faces->InsertNextCell(open->GetCell(f));
  }
  open->SetPolys(faces);
  expect(open, "4 open edges");
  expect(Together(Box(1.0), Box(1.0, 0.4)), "intersect");
  auto flipped = Box(1.0);
  flipped->BuildCells();
  flipped->ReverseCell(0);
  expect(flipped, "turned against each other");
  auto spoiled = Box(1.0);
  spoiled->GetPoints()->SetPoint(0, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  expect(spoiled, "cannot be divided"); // of triangles it is the kernel that looks
  auto flat = Box(1.0);
  for (vtkIdType i = 0; i < flat->GetNumberOfPoints(); ++i)
  {
    double x[3];
    flat->GetPoint(i, x);
    flat->GetPoints()->SetPoint(i, x[0], x[1], 0.0);
  }
  expect(flat, "cannot be divided");
  // it goes on living
  filter->SetInputDataObject(Box(1.0));
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  filter->SetInputDataObject(open);
  filter->SetRepair(true);
  filter->Update();
  EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-12);
  EXPECT_EQ(Number(filter, "Repaired"), 1);
}

TEST(vtkTetGenMesher, LimitsEndTheProcessAndNothingElse)
{
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(1.0));
  filter->SetEdgeLength(0.002);
  filter->SetKeepBoundary(false);
  filter->SetMaxSteinerPoints(VTK_INT_MAX);
  filter->SetMemoryLimit(60);
  filter->SetTimeLimit(60);
  auto errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("MemoryLimit"), std::string::npos) << errors[0];
  filter->SetMemoryLimit(100000);
  filter->SetTimeLimit(1);
  errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("TimeLimit"), std::string::npos) << errors[0];
}

/// A program that crashes, or does not end, the first time is started again; the points are those
/// of the surface.
TEST(vtkTetGenMesher, ACrashOrAHangIsTriedAgainWithOtherPoints)
{
  const char* workers = std::getenv("KNOTWORK_WORKERS");
  const std::string before = workers ? workers : "";
  const std::string real = PathOfWorkerScript("knotwork-tetgen");
  ASSERT_FALSE(real.empty());
  for (const char* fault : { "kill -SEGV $$", "sleep 60" })
  {
    SCOPED_TRACE(fault);
    const TemporaryFolder folder;
    const std::string program = folder.Path() + "/knotwork-tetgen";
    std::ofstream(program) << "#!/bin/sh\nif [ -e '" << folder.Path() << "/again' ]; then exec '"
                           << real << "' \"$@\"; fi\ntouch '" << folder.Path() << "/again'\n"
                           << fault << "\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("KNOTWORK_WORKERS", folder.Path().c_str(), 1);
    vtkNew<vtkTetGenMesher> filter;
    filter->SetInputDataObject(Box(1.0));
    filter->SetTimeLimit(6);
    filter->Update();
    EXPECT_EQ(filter->GetErrorCode(), 0u);
    EXPECT_NEAR(Number(filter, "Volume"), 1.0, 1e-15);
    EXPECT_EQ(
      vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetLength(), std::sqrt(3.0));
    EXPECT_TRUE(std::filesystem::exists(folder.Path() + "/again"));
  }
  before.empty() ? unsetenv("KNOTWORK_WORKERS") : setenv("KNOTWORK_WORKERS", before.c_str(), 1);
}

TEST(vtkTetGenMesher, AProgramThatCrashesOrIsNotThereIsAnError)
{
  const TemporaryFolder folder;
  setenv("KNOTWORK_WORKERS", folder.Path().c_str(), 1);
  vtkNew<vtkTetGenMesher> filter;
  filter->SetInputDataObject(Box(1.0));
  auto errors = ErrorsOf(filter);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("is missing"), std::string::npos) << errors[0];
  std::ofstream(folder.Path() + "/knotwork-tetgen") << "#!/bin/sh\nkill -SEGV $$\n";
  std::filesystem::permissions(
    folder.Path() + "/knotwork-tetgen", std::filesystem::perms::owner_all);
  filter->Modified();
  errors = ErrorsOf(filter);
  unsetenv("KNOTWORK_WORKERS");
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors[0].find("TetGen crashed"), std::string::npos) << errors[0];
}
