// SPDX-License-Identifier: BSD-3-Clause
#include "ExtremaData.h"

#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"
#include "vtkVariant.h"

#include <algorithm>

namespace knotwork
{
namespace
{
template <typename Array>
vtkSmartPointer<Array> NewArray(vtkDataSetAttributes* data, const char* name, int components = 1)
{
  auto array = NamedArray<Array>(name, components);
  data->AddArray(array);
  return array;
}

/// Places in the plane of the parameters, or on the surface.
class Places
{
public:
  Places(const SplinePatch& patch, const ExtremaChoice& choice) : Lifted(choice.OnSurface)
  {
    const auto& surface = std::get<Spline<2>>(patch.Geometry);
    this->HasDomain = surface.Space->HasDomain();
    if (this->Lifted)
    {
      this->Form = MakeBezierForm(surface, choice.Threads);
    }
    if (this->HasDomain)
    {
      this->Domain = surface.Space->Domain();
    }
    else
    {
      this->Domain = { { 0.0, 0.0 }, { 1.0, 1.0 } };
    }
  }

  Status Add(int element, double u, double v, vtkPoints* points) const
  {
    PointMatrix at(1, 2);
    at << std::min(std::max(u, this->Domain.Lower[0]), this->Domain.Upper[0]),
      std::min(std::max(v, this->Domain.Lower[1]), this->Domain.Upper[1]);
    if (!this->Lifted)
    {
      points->InsertNextPoint(at(0, 0), at(0, 1), 0.0);
      return {};
    }
    EvaluationParams params;
    params.Threads = 1;
    EvaluationBatch batch;
    const Status status = this->HasDomain
      ? EvaluateParameters<2>(this->Form, at, params, batch)
      : EvaluateElements<2>(this->Form, { element }, at, params, batch);
    if (status)
    {
      points->InsertNextPoint(batch.Values.data());
    }
    return status;
  }

private:
  bool Lifted;
  bool HasDomain = true;
  ParametricBox<2> Domain;
  BezierForm<2> Form;
};

struct PointArrays
{
  explicit PointArrays(vtkPolyData* data)
    : Kind(NewArray<vtkIntArray>(data->GetPointData(), "Kind")),
      Place(NewArray<vtkIntArray>(data->GetPointData(), "Place")),
      Value(NewArray<vtkDoubleArray>(data->GetPointData(), "Value")),
      ValueBounds(NewArray<vtkDoubleArray>(data->GetPointData(), "ValueBounds", 2)),
      Parameters(NewArray<vtkDoubleArray>(data->GetPointData(), "Parameters", 2)),
      Eigenvalues(NewArray<vtkDoubleArray>(data->GetPointData(), "Eigenvalues", 2)),
      Index(NewArray<vtkIntArray>(data->GetPointData(), "Index")),
      InwardSign(NewArray<vtkIntArray>(data->GetPointData(), "InwardSign")),
      ElementId(NewArray<vtkIntArray>(data->GetPointData(), "ElementId")),
      PatchId(NewArray<vtkIntArray>(data->GetPointData(), "PatchId")),
      Block(NewArray<vtkIntArray>(data->GetPointData(), "Block"))
  {
  }
  void Insert(const SplinePatch& patch, const CriticalPoint& point) const
  {
    this->Kind->InsertNextValue(static_cast<int>(point.Kind));
    this->Place->InsertNextValue(static_cast<int>(point.Place));
    this->Value->InsertNextValue(point.Value);
    this->ValueBounds->InsertNextTuple(point.ValueBounds.data());
    this->Parameters->InsertNextTuple(point.Parameters.data());
    this->Eigenvalues->InsertNextTuple(point.Eigenvalues.data());
    this->Index->InsertNextValue(point.Index);
    this->InwardSign->InsertNextValue(point.InwardSign);
    this->ElementId->InsertNextValue(point.Element);
    this->PatchId->InsertNextValue(patch.Id);
    this->Block->InsertNextValue(patch.Block);
  }

  vtkSmartPointer<vtkIntArray> Kind, Place;
  vtkSmartPointer<vtkDoubleArray> Value, ValueBounds, Parameters, Eigenvalues;
  vtkSmartPointer<vtkIntArray> Index, InwardSign, ElementId, PatchId, Block;
};

class BoxCells
{
public:
  explicit BoxCells(vtkPolyData* data)
    : Unique(NewArray<vtkIntArray>(data->GetCellData(), "Unique")),
      PointId(NewArray<vtkIdTypeArray>(data->GetCellData(), "PointId")),
      ClusterId(NewArray<vtkIntArray>(data->GetCellData(), "ClusterId")),
      ValueBounds(NewArray<vtkDoubleArray>(data->GetCellData(), "ValueBounds", 2)),
      ParametricBounds(NewArray<vtkDoubleArray>(data->GetCellData(), "ParametricBounds", 4)),
      ElementId(NewArray<vtkIntArray>(data->GetCellData(), "ElementId")),
      PatchId(NewArray<vtkIntArray>(data->GetCellData(), "PatchId")),
      Block(NewArray<vtkIntArray>(data->GetCellData(), "Block"))
  {
    this->Points->SetDataTypeToDouble();
    data->SetPoints(this->Points);
    data->SetPolys(this->Quads);
  }

  Status Insert(const SplinePatch& patch, const Places& places, int element,
    const ParametricBox<2>& box, vtkIdType point, int cluster, const RealArray<2>& values) const
  {
    const vtkIdType first = this->Points->GetNumberOfPoints();
    const double corners[4][2] = { { box.Lower[0], box.Lower[1] }, { box.Upper[0], box.Lower[1] },
      { box.Upper[0], box.Upper[1] }, { box.Lower[0], box.Upper[1] } };
    for (const double* corner : corners)
    {
      if (Status status = places.Add(element, corner[0], corner[1], this->Points); !status)
      {
        return status;
      }
    }
    this->Quads->InsertNextCell({ first, first + 1, first + 2, first + 3 });
    this->Unique->InsertNextValue(cluster < 0 ? 1 : 0);
    this->PointId->InsertNextValue(point);
    this->ClusterId->InsertNextValue(cluster);
    this->ValueBounds->InsertNextTuple(values.data());
    this->ParametricBounds->InsertNextTuple4(
      box.Lower[0], box.Upper[0], box.Lower[1], box.Upper[1]);
    this->ElementId->InsertNextValue(element);
    this->PatchId->InsertNextValue(patch.Id);
    this->Block->InsertNextValue(patch.Block);
    return {};
  }

private:
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Quads;
  vtkSmartPointer<vtkIntArray> Unique;
  vtkSmartPointer<vtkIdTypeArray> PointId;
  vtkSmartPointer<vtkIntArray> ClusterId;
  vtkSmartPointer<vtkDoubleArray> ValueBounds, ParametricBounds;
  vtkSmartPointer<vtkIntArray> ElementId, PatchId, Block;
};
}

Result<Spline<2>> FunctionOf(const SplinePatch& patch, const std::string& field, int& component)
{
  const std::string name = "patch " + std::to_string(patch.Id);
  const auto* surface = std::get_if<Spline<2>>(&patch.Geometry);
  if (!surface)
  {
    return { ErrorCode::DimensionMismatch,
      name + " is no surface; give patches of two parameters" };
  }
  Spline<2> function = *surface;
  if (!field.empty())
  {
    const auto found = std::find_if(patch.Fields.begin(), patch.Fields.end(),
      [&](const SplineField& candidate) { return candidate.Name == field; });
    if (found == patch.Fields.end())
    {
      return { ErrorCode::InvalidParameter,
        name + " has no field '" + field +
          "'; check FieldName, or leave it empty for the geometry" };
    }
    function.ControlPoints = found->Coefficients;
    component = function.NumComponents() == 1 ? 0 : component;
  }
  if (component >= function.NumComponents())
  {
    return { ErrorCode::InvalidParameter,
      "Component is " + std::to_string(component) + ", but " + name + " has " +
        std::to_string(function.NumComponents()) + " components" +
        (field.empty() ? std::string() : " of '" + field + "'") + ", counted from 0" };
  }
  return function;
}

Status EncodeExtrema(const std::vector<PatchPoints>& patches, const ExtremaChoice& choice,
  vtkPolyData* points, vtkPolyData* boxes)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  const PointArrays arrays(points);
  const BoxCells cells(boxes);
  int firstCluster = 0;
  for (const PatchPoints& patch : patches)
  {
    const Places plane(*patch.Patch, choice);
    const CriticalPoints& found = patch.Found;
    for (const CriticalPoint& point : found.Points)
    {
      if (!choice.Kinds[static_cast<std::size_t>(point.Kind)])
      {
        continue;
      }
      const vtkIdType id = places->GetNumberOfPoints();
      Status status = plane.Add(point.Element, point.Parameters[0], point.Parameters[1], places);
      if (status)
      {
        vertices->InsertNextCell(1, &id);
        arrays.Insert(*patch.Patch, point);
        status =
          cells.Insert(*patch.Patch, plane, point.Element, point.Box, id, -1, point.ValueBounds);
      }
      if (!status)
      {
        return status;
      }
    }
    for (std::size_t c = 0; c < found.Clusters.size(); ++c)
    {
      const CriticalCluster& cluster = found.Clusters[c];
      for (std::size_t b = cluster.FirstBox; b < cluster.FirstBox + cluster.NumBoxes; ++b)
      {
        const CriticalBox& box = found.Boxes[b];
        const Status status = cells.Insert(*patch.Patch, plane, box.Element, box.Box, -1,
          firstCluster + static_cast<int>(c), cluster.ValueBounds);
        if (!status)
        {
          return status;
        }
      }
    }
    firstCluster += static_cast<int>(found.Clusters.size());
  }
  points->SetPoints(places);
  points->SetVerts(vertices);
  return {};
}

void EncodeCounts(const std::vector<PatchPoints>& patches, vtkTable* table)
{
  int minima = 0;
  int maxima = 0;
  int saddles = 0;
  int boundary = 0;
  int clusters = 0;
  int boxes = 0;
  int sum = 0;
  int characteristic = 0;
  bool proved = true;
  vtkTypeInt64 tested = 0;
  for (const PatchPoints& patch : patches)
  {
    const CriticalPoints& found = patch.Found;
    minima += found.NumMinima;
    maxima += found.NumMaxima;
    saddles += found.NumSaddles;
    boundary += found.NumOnBoundary;
    clusters += static_cast<int>(found.Clusters.size());
    boxes += static_cast<int>(found.Boxes.size());
    sum += found.IndexSum;
    characteristic += found.EulerCharacteristic;
    proved = proved && found.Proved;
    tested += found.NumTested;
  }
  AddColumn(table, "Minima", minima);
  AddColumn(table, "Maxima", maxima);
  AddColumn(table, "Saddles", saddles);
  AddColumn(table, "OnBoundary", boundary);
  AddColumn(table, "Clusters", clusters);
  AddColumn(table, "ClusterBoxes", boxes);
  AddColumn(table, "IndexSum", sum);
  AddColumn(table, "EulerCharacteristic", characteristic);
  AddToRow<vtkTypeInt64Array>(table, "BoxesTested", tested);
  AddColumn(table, "Proved", proved ? 1 : 0);
}

void MergeExtrema(vtkPolyData* points, vtkPolyData* boxes, vtkTable* table)
{
  const auto countOn = [boxes](const char* name, int own)
  {
    const int before = Processes::SumBefore(own);
    vtkDataArray* numbers = boxes->GetCellData()->GetArray(name);
    for (vtkIdType i = 0; numbers && i < numbers->GetNumberOfTuples(); ++i)
    {
      const double number = numbers->GetTuple1(i);
      numbers->SetTuple1(i, number < 0.0 ? number : number + before);
    }
  };
  countOn("PointId", static_cast<int>(points->GetNumberOfPoints()));
  countOn(
    "ClusterId", table->GetNumberOfRows() == 0 ? 0 : table->GetValueByName(0, "Clusters").ToInt());
  MergedTable how;
  for (const char* counted : { "Minima", "Maxima", "Saddles", "OnBoundary", "Clusters",
         "ClusterBoxes", "IndexSum", "EulerCharacteristic", "BoxesTested" })
  {
    how.Columns.push_back({ counted, Merging::Sum });
  }
  how.Columns.push_back({ "Proved", Merging::Least });
  MergeTables(table, how);
}
}
