// SPDX-License-Identifier: BSD-3-Clause
#include "ScanData.h"

#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

namespace knotwork
{
namespace
{
bool HasFaces(vtkPointSet* data)
{
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
  {
    const int type = data->GetCellType(c);
    if (type != VTK_EMPTY_CELL && type != VTK_VERTEX && type != VTK_POLY_VERTEX &&
      type != VTK_LINE && type != VTK_POLY_LINE)
    {
      return true;
    }
  }
  return false;
}

void TurnNormals(const RigidMotion& motion, vtkDataSetAttributes* attributes)
{
  vtkDataArray* const given = attributes->GetNormals();
  if (!given)
  {
    return;
  }
  const auto turned = NamedArray<vtkDoubleArray>(given->GetName(), 3, given->GetNumberOfTuples());
  for (vtkIdType i = 0; i < given->GetNumberOfTuples(); ++i)
  {
    Eigen::Vector3d normal;
    given->GetTuple(i, normal.data());
    normal = motion.Rotation * normal;
    turned->SetTuple(i, normal.data());
  }
  attributes->SetNormals(turned);
}
}

Result<TriangleMesh> DecodeScan(vtkPointSet* data)
{
  if (Status sampled = CheckSampledPoints(data, "the scan"); !sampled)
  {
    return sampled;
  }
  if (HasFaces(data))
  {
    auto decoded = DecodeMesh(data);
    return decoded ? Result<TriangleMesh>(std::move(decoded->Mesh)) : decoded.Status;
  }
  TriangleMesh scan;
  scan.Points.resize(data->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    data->GetPoint(i, scan.Points.data() + 3 * i);
  }
  return scan;
}

Result<ScanAndTarget> DecodeScanAndTarget(vtkInformationVector** inputs, const std::string& what,
  const FitTargetOptions& options, int threads)
{
  auto scan = DecodeScan(vtkPointSet::GetData(inputs[0], 0));
  if (!scan)
  {
    return scan.Status;
  }
  auto target = DecodeFitTarget(vtkDataObject::GetData(inputs[1], 0), options, threads);
  if (!target)
  {
    target.Status.Detail = what + ": " + target.Status.Detail;
    return target.Status;
  }
  return ScanAndTarget{ std::move(scan.Value), std::move(target.Value) };
}

void EncodeMoved(vtkPointSet* input, const RigidMotion& motion, vtkPointSet* output)
{
  output->ShallowCopy(input);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(input->GetNumberOfPoints());
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    Eigen::Vector3d point;
    input->GetPoint(i, point.data());
    point = motion.Rotation * point + motion.Translation;
    points->SetPoint(i, point.data());
  }
  output->SetPoints(points);
  TurnNormals(motion, output->GetPointData());
  TurnNormals(motion, output->GetCellData());
  const auto matrix = NamedArray<vtkDoubleArray>("Motion", 16, 1);
  matrix->SetTuple(0, motion.Matrix().data());
  output->GetFieldData()->AddArray(matrix);
}

void EncodeDistances(const TargetDistances& distances, vtkPointSet* output)
{
  const vtkIdType count = distances.Distances.size();
  const auto distance = NamedArray<vtkDoubleArray>("Distance", 1, count);
  const auto foot = NamedArray<vtkDoubleArray>("TargetPoint", 3, count);
  const auto face = NamedArray<vtkIntArray>("TargetFace", 1, count);
  std::copy(
    distances.Distances.data(), distances.Distances.data() + count, distance->GetPointer(0));
  const PointMatrix& feet = distances.Feet.Points;
  std::copy(feet.data(), feet.data() + feet.size(), foot->GetPointer(0));
  std::copy(distances.Feet.Faces.begin(), distances.Feet.Faces.end(), face->GetPointer(0));
  output->GetPointData()->AddArray(distance);
  output->GetPointData()->AddArray(foot);
  output->GetPointData()->AddArray(face);
  output->GetPointData()->SetActiveScalars("Distance");
}

void AddProfile(vtkTable* table, const std::string& prefix, const DistanceProfile& profile)
{
  AddColumn(table, (prefix + "Points").c_str(), profile.NumPoints);
  AddColumn(table, (prefix + "Min").c_str(), profile.Min);
  AddColumn(table, (prefix + "Max").c_str(), profile.Max);
  AddColumn(table, (prefix + "Mean").c_str(), profile.Mean);
  AddColumn(table, (prefix + "MeanAbsolute").c_str(), profile.MeanAbsolute);
  AddColumn(table, (prefix + "Rms").c_str(), profile.Rms);
}
}
