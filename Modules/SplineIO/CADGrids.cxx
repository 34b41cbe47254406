// SPDX-License-Identifier: BSD-3-Clause
#include "CADGrids.h"

#include <knotwork/CADModel/CADComposite.h>
#include <knotwork/SurfaceTrimming/TrimData.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
/// The composites of faces, on cells that have a FaceId; nothing where there are none.
void AddComposites(const TrimmedModel& model, vtkDataSet* cells)
{
  std::vector<std::string> names;
  for (const TrimmedFace& face : model.Faces)
  {
    names.push_back(face.Name);
  }
  const std::vector<int> ids = CompositeIds(names);
  vtkDataArray* faces = cells->GetCellData()->GetArray("FaceId");
  if (!faces || std::all_of(ids.begin(), ids.end(), [](int id) { return id < 0; }))
  {
    return;
  }
  vtkNew<vtkIntArray> composites;
  composites->SetName("CompositeId");
  for (vtkIdType c = 0; c < faces->GetNumberOfTuples(); ++c)
  {
    composites->InsertNextValue(ids[static_cast<std::size_t>(faces->GetTuple1(c))]);
  }
  cells->GetCellData()->AddArray(composites);
}

/// What the file says of the faces, on their triangles.
void AddAttributes(const TrimmedModel& model, const TrimmedMesh& mesh, vtkPolyData* triangles)
{
  vtkNew<vtkIntArray> patches;
  patches->SetName("PatchId");
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(3);
  for (int f : mesh.TriangleFace)
  {
    const TrimmedFace& face = model.Faces[static_cast<std::size_t>(f)];
    patches->InsertNextValue(f);
    names->InsertNextValue(face.Name);
    for (double share : face.Color)
    {
      colors->InsertNextValue(
        static_cast<unsigned char>(face.HasColor ? std::lround(255.0 * share) : 255));
    }
  }
  AddComposites(model, triangles);
  triangles->GetCellData()->AddArray(patches);
  triangles->GetCellData()->AddArray(names);
  triangles->GetCellData()->AddArray(colors);
}
}

Status EncodeCAD(const TrimmedModel& model, const TrimmedMeshParams* meshing,
  vtkUnstructuredGrid* surfaces, vtkUnstructuredGrid* curves, vtkPolyData* triangles)
{
  Status status = EncodeTrimmedModel(model, surfaces, curves);
  if (!status)
  {
    return status;
  }
  AddComposites(model, surfaces);
  if (!meshing)
  {
    return {};
  }
  const auto mesh = TriangulateFaces(model, *meshing);
  if (!mesh)
  {
    return { mesh.Status.Code, "the triangles of output 2: " + mesh.Status.Detail };
  }
  EncodeTriangles(mesh.Value, triangles);
  AddAttributes(model, mesh.Value, triangles);
  return {};
}
}
