// SPDX-License-Identifier: BSD-3-Clause
#include "FitTargetData.h"

#include <knotwork/CADFitting/ImplicitTarget.h>
#include <knotwork/CADFitting/MeshTarget.h>
#include <knotwork/CADFitting/ModelTarget.h>
#include <knotwork/CADModel/BoundaryFaces.h>
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineCore/PatchFaces.h>
#include <knotwork/SplineCore/TensorForm.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>
#include <knotwork/SurfaceTrimming/TrimmedMesh.h>

#include "vtkCellType.h"
#include "vtkImplicitFunction.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <sstream>

namespace knotwork
{
namespace
{
constexpr double ChordShare = 1e-3; ///< of the size, between faces and triangles

bool HasLinearFaces(vtkDataObject* data)
{
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(data);
  for (vtkIdType c = 0; grid && c < grid->GetNumberOfCells(); ++c)
  {
    const int type = grid->GetCellType(c);
    if (type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON)
    {
      return true;
    }
  }
  return vtkPolyData::SafeDownCast(data) != nullptr;
}

Result<FitTargetPtr> FromTriangles(vtkDataObject* data, const FitTargetOptions& options)
{
  auto decoded = DecodeMesh(vtkPointSet::SafeDownCast(data));
  if (!decoded)
  {
    return decoded.Status;
  }
  if (decoded->Mesh.Triangles.empty())
  {
    return { ErrorCode::EmptyInput,
      "the target has no faces: give triangles, spline surfaces, a CAD file or a volume" };
  }
  MeshFeatureParams features;
  features.SharpAngle = options.SharpAngle;
  features.WeakAngle = std::min(options.WeakAngle, options.SharpAngle);
  features.CornerAngle = options.CornerAngle;
  auto target = MakeMeshTarget(decoded->Mesh, features);
  if (options.Triangles)
  {
    *options.Triangles = std::move(decoded->Mesh);
  }
  return target;
}

/// "0,1,2;5,6" as the group of every face.
Result<std::vector<int>> ParseGroups(const std::string& text, std::size_t numFaces)
{
  std::vector<int> groups;
  if (text.empty())
  {
    return groups;
  }
  groups.assign(numFaces, -1);
  std::istringstream lists(text);
  std::string list;
  for (int group = 0; std::getline(lists, list, ';'); ++group)
  {
    const auto faces = ParseNumbers(list, static_cast<int>(numFaces),
      "in the groups of faces is no number of a face, 0 to " + std::to_string(numFaces - 1));
    if (!faces)
    {
      return faces.Status;
    }
    for (const int face : faces.Value)
    {
      groups[static_cast<std::size_t>(face)] = group;
    }
  }
  return groups;
}

Result<TriangleMesh> TriangulateModel(
  const TrimmedModel& model, int threads, const ProgressCallback& progress)
{
  TrimmedMeshParams params;
  params.Tolerance = ChordShare * SizeOf(model);
  params.Threads = threads;
  params.Progress = progress;
  auto mesh = TriangulateFacesFiner(model, params);
  return mesh ? Result<TriangleMesh>({ std::move(mesh->Points), std::move(mesh->Triangles) })
              : Result<TriangleMesh>(mesh.Status);
}

Result<FitTargetPtr> FromModel(
  const TrimmedModel& model, const FitTargetOptions& options, int threads)
{
  ModelTargetParams params;
  params.SharpAngle = std::min(options.WeakAngle, options.SharpAngle);
  params.CornerAngle = options.CornerAngle;
  auto groups = ParseGroups(options.FaceGroups, model.Faces.size());
  if (!groups)
  {
    return groups.Status;
  }
  params.Groups = std::move(groups.Value);
  auto target = MakeModelTarget(model, params);
  if (target && options.Triangles)
  {
    auto mesh = TriangulateModel(model, threads, options.Progress);
    if (!mesh)
    {
      return mesh.Status;
    }
    *options.Triangles = std::move(mesh.Value);
  }
  return target;
}

Result<FitTargetPtr> FromVolumes(
  const std::vector<SplinePatch>& patches, const FitTargetOptions& options, int threads)
{
  std::vector<Spline<3>> volumes;
  for (const SplinePatch& patch : patches)
  {
    volumes.push_back(std::get<Spline<3>>(patch.Geometry));
  }
  const auto model = BoundaryFaces(volumes);
  return model ? FromModel(model.Value, options, threads) : Result<FitTargetPtr>(model.Status);
}

Result<FitTargetPtr> FromSurfaces(vtkDataObject* data, const std::vector<SplinePatch>& patches,
  const FitTargetOptions& options, int threads)
{
  TrimmedModel model;
  bool isTrimmable = true;
  for (const SplinePatch& patch : patches)
  {
    const auto& surface = std::get<Spline<2>>(patch.Geometry);
    if (surface.Space->Kind == SpaceKind::Unstructured)
    {
      isTrimmable = false;
      auto faces = FacesOfPatches(surface, threads);
      if (!faces)
      {
        return faces.Status;
      }
      AppendFaces(model, std::move(faces.Value));
    }
    else if (!surface.Space->HasDomain())
    {
      return { ErrorCode::DimensionMismatch,
        "the target's Bezier elements have no common domain: give the surface as one of its "
        "families, or as triangles (tessellate)" };
    }
    else
    {
      isTrimmable = isTrimmable && surface.Space->Kind == SpaceKind::Tensor;
      auto tensor = ToTensor(surface, threads);
      if (!tensor)
      {
        return tensor.Status;
      }
      model.Faces.emplace_back();
      model.Faces.back().Surface = std::move(tensor.Value);
    }
  }
  if (isTrimmable)
  {
    auto trimmed = DecodeTrimmedModel(data, nullptr);
    if (!trimmed)
    {
      return trimmed.Status;
    }
    model = std::move(trimmed.Value);
  }
  return FromModel(model, options, threads);
}
}

Result<std::vector<int>> ParseNumbers(const std::string& text, int below, const std::string& remedy)
{
  std::vector<int> numbers;
  std::istringstream words(text);
  std::string word;
  while (std::getline(words, word, ','))
  {
    std::istringstream read(word);
    int number = -1;
    if (!(read >> number) || !(read >> std::ws).eof() || number < 0 || number >= below)
    {
      return { ErrorCode::InvalidParameter, "'" + word + "' " + remedy };
    }
    numbers.push_back(number);
  }
  return numbers;
}

Result<FitTargetPtr> DecodeFitTarget(
  vtkDataObject* data, const FitTargetOptions& options, int threads)
{
  if (HasLinearFaces(data))
  {
    return FromTriangles(data, options);
  }
  const auto decoded = DecodeSplineModel(data, threads);
  if (!decoded)
  {
    return decoded.Status;
  }
  if (decoded->Patches.empty())
  {
    return { ErrorCode::EmptyInput,
      "the target has no faces: give triangles, spline surfaces, a CAD file or a volume" };
  }
  const std::size_t dimension = decoded->Patches.front().Geometry.index();
  for (const SplinePatch& patch : decoded->Patches)
  {
    if (patch.Geometry.index() != dimension)
    {
      return { ErrorCode::DimensionMismatch,
        "the target has patches of several dimensions: select those of one" };
    }
  }
  if (dimension == 0)
  {
    std::vector<Spline<1>> curves;
    for (const SplinePatch& patch : decoded->Patches)
    {
      curves.push_back(std::get<Spline<1>>(patch.Geometry));
    }
    return MakeCurveTarget(curves, options.CornerAngle);
  }
  return dimension == 1 ? FromSurfaces(data, decoded->Patches, options, threads)
                        : FromVolumes(decoded->Patches, options, threads);
}

Result<FitTargetPtr> AdaptImplicitFunction(vtkImplicitFunction* function, const double* box)
{
  if (!function)
  {
    return { ErrorCode::EmptyInput, "set the implicit function to fit to" };
  }
  ImplicitTargetParams params;
  for (std::size_t d = 0; d < 3; ++d)
  {
    params.Lower[d] = box[2 * d];
    params.Upper[d] = box[2 * d + 1];
  }
  return MakeImplicitTarget(
    [function](const double* point, double* gradient)
    {
      function->FunctionGradient(point, gradient);
      return function->FunctionValue(point);
    },
    params);
}
}
