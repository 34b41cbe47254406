// SPDX-License-Identifier: BSD-3-Clause
#include "TrimmedGrids.h"

#include "CarriedCurves.h"
#include <knotwork/SplineCore/JoinElements.h>
#include <knotwork/SplineCore/PatchFaces.h>
#include <knotwork/SplineCore/SharedEdges.h>
#include <knotwork/SplineCore/TensorForm.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/SplineSchema.h>
#include <knotwork/SurfaceTrimming/AffineMap.h>

#include "vtkCellData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>

namespace knotwork
{
namespace
{
constexpr const char* PlaneCurve = "UV";

/// Of the size: what lies between points of single precision, after a filter that moved them.
constexpr double MovedRounding =
  1024.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

/// Equal for equal models; tells the faces and edges of several models apart.
int ModelNumber(const TrimmedModel& model)
{
  Checksum sum;
  for (const TrimmedFace& face : model.Faces)
  {
    sum.Add(face.Surface.ControlPoints);
    for (const TrimmedLoop& loop : face.Loops)
    {
      for (const TrimmingCurve& use : loop.Curves)
      {
        sum.Add(use.Curve.ControlPoints);
        sum.Add(use.UV);
      }
    }
  }
  return static_cast<int>(
    sum.Value() & static_cast<std::uint64_t>(std::numeric_limits<int>::max()));
}

/// One number a patch as a cell array.
void AddNumbers(vtkUnstructuredGrid* grid, const char* arrayName, const std::vector<int>& ofPatch)
{
  vtkDataArray* patches = grid->GetCellData()->GetArray(name::PatchId);
  vtkNew<vtkIntArray> array;
  array->SetName(arrayName);
  array->SetNumberOfTuples(grid->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    array->SetValue(cell, ofPatch[static_cast<std::size_t>(patches->GetTuple1(cell))]);
  }
  grid->GetCellData()->AddArray(array);
}

void AddColors(vtkUnstructuredGrid* grid, const std::vector<TrimmedFace>& faces)
{
  vtkDataArray* patches = grid->GetCellData()->GetArray(name::PatchId);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("Color");
  colors->SetNumberOfComponents(4); // filters that turn vectors leave these alone
  colors->SetNumberOfTuples(grid->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const TrimmedFace& face = faces[static_cast<std::size_t>(patches->GetTuple1(cell))];
    for (int c = 0; c < 3; ++c)
    {
      const double value = std::clamp(face.Color[static_cast<std::size_t>(c)], 0.0, 1.0);
      colors->SetTypedComponent(cell, c, static_cast<unsigned char>(std::lround(255.0 * value)));
    }
    colors->SetTypedComponent(cell, 3, face.HasColor ? 255 : 0);
  }
  grid->GetCellData()->AddArray(colors);
}

void AddNames(vtkUnstructuredGrid* grid, const std::vector<TrimmedFace>& faces)
{
  vtkDataArray* patches = grid->GetCellData()->GetArray(name::PatchId);
  vtkNew<vtkStringArray> names;
  names->SetName("Name");
  names->SetNumberOfValues(grid->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    names->SetValue(cell, faces[static_cast<std::size_t>(patches->GetTuple1(cell))].Name);
  }
  grid->GetCellData()->AddArray(names);
}

/// Geometry and fields of a patch of Bezier elements in a tensor-product space, see JoinElements.
template <int Dim>
Status JoinPatch(vtkDataArray* bounds, Spline<Dim>& spline, SplinePatch& patch)
{
  std::vector<ParametricBox<Dim>> boxes;
  for (vtkIdType cell : patch.Cells)
  {
    boxes.emplace_back();
    for (int d = 0; d < Dim; ++d)
    {
      boxes.back().Lower[static_cast<std::size_t>(d)] = bounds->GetComponent(cell, 2 * d);
      boxes.back().Upper[static_cast<std::size_t>(d)] = bounds->GetComponent(cell, 2 * d + 1);
    }
  }
  Eigen::Index columns = 3;
  for (const SplineField& field : patch.Fields)
  {
    columns += field.Coefficients.cols();
  }
  Spline<Dim> all{ spline.Space, PointMatrix(spline.ControlPoints.rows(), columns),
    spline.Weights };
  all.ControlPoints.leftCols(3) = spline.ControlPoints;
  columns = 3;
  for (const SplineField& field : patch.Fields)
  {
    all.ControlPoints.middleCols(columns, field.Coefficients.cols()) = field.Coefficients;
    columns += field.Coefficients.cols();
  }
  auto joined = JoinElements<Dim>(all, boxes);
  if (!joined)
  {
    return joined.Status;
  }
  spline = { joined->Space, joined->ControlPoints.leftCols(3), joined->Weights };
  columns = 3;
  for (SplineField& field : patch.Fields)
  {
    const Eigen::Index width = field.Coefficients.cols();
    field.Coefficients = joined->ControlPoints.middleCols(columns, width);
    columns += width;
  }
  return {};
}

/// A decoded grid, its patches in the order of the cells, whose cell arrays are looked up by patch.
class PatchReader
{
public:
  PatchReader(std::string what, vtkDataObject* data) : What(std::move(what))
  {
    auto decoded = DecodeSplineModel(data, 1);
    this->Outcome = decoded.Status;
    if (!decoded)
    {
      this->Outcome.Detail = this->What + ": " + this->Outcome.Detail;
      return;
    }
    this->Model = std::move(decoded.Value);
    const auto begin = [](const SplinePatch& patch) {
      return std::make_pair(patch.Block, *std::min_element(patch.Cells.begin(), patch.Cells.end()));
    };
    std::sort(this->Model.Patches.begin(), this->Model.Patches.end(),
      [&](const SplinePatch& a, const SplinePatch& b) { return begin(a) < begin(b); });
    this->Grids = GridsByBlock(data);
    for (SplinePatch& patch : this->Model.Patches)
    {
      Status status = this->Join(patch);
      this->Outcome = this->Outcome ? status : this->Outcome;
    }
  }

  std::string Place(const SplinePatch& patch) const
  {
    return this->What + ", patch " + std::to_string(patch.Id);
  }

  template <typename Array>
  Array* Find(const SplinePatch& patch, const char* arrayName) const
  {
    vtkUnstructuredGrid* grid = this->Grids.at(patch.Block);
    return Array::SafeDownCast(grid->GetCellData()->GetAbstractArray(arrayName));
  }

  /// A whole number, the same in all cells of the patch.
  /// @param otherwise  when there is no such array; nothing: that is an error.
  Status ReadNumber(const SplinePatch& patch, const char* arrayName, std::optional<int> otherwise,
    int& number) const
  {
    const std::string where = this->Place(patch) + ": cell array '" + arrayName + "' ";
    vtkUnstructuredGrid* grid = this->Grids.at(patch.Block);
    if (!grid->GetCellData()->HasArray(arrayName))
    {
      if (!otherwise)
      {
        return { ErrorCode::InvalidTopology, where + "is missing" };
      }
      number = *otherwise;
      return {};
    }
    auto* array = this->Find<vtkDataArray>(patch, arrayName);
    if (!array || array->GetNumberOfComponents() != 1)
    {
      return { ErrorCode::InvalidTopology, where + "is not one number a cell" };
    }
    const double value = array->GetComponent(patch.Cells.front(), 0);
    if (!(std::abs(value) <= std::numeric_limits<int>::max()) || value != std::floor(value))
    {
      return { ErrorCode::InvalidTopology, where + "is not a whole number" };
    }
    const auto differs = [&](vtkIdType cell) { return array->GetComponent(cell, 0) != value; };
    if (std::any_of(patch.Cells.begin(), patch.Cells.end(), differs))
    {
      return { ErrorCode::InvalidTopology, where + "differs between its cells" };
    }
    number = static_cast<int>(value);
    return {};
  }

  const std::map<int, vtkSmartPointer<vtkUnstructuredGrid>>& Blocks() const { return this->Grids; }

  std::string What;
  Status Outcome;
  SplineModel Model;

private:
  /// A patch that lost its knots (appended behind others) is put together from its elements.
  Status Join(SplinePatch& patch) const
  {
    return std::visit(
      [&](auto& spline) -> Status
      {
        auto* bounds = this->Find<vtkDataArray>(patch, name::Bounds);
        if (spline.Space->Kind != SpaceKind::Bezier || !bounds)
        {
          return {};
        }
        const Status status = JoinPatch(bounds, spline, patch);
        return { status.Code, status ? "" : this->Place(patch) + ": " + status.Detail };
      },
      patch.Geometry);
  }

  std::map<int, vtkSmartPointer<vtkUnstructuredGrid>> Grids;
};

/// The numbers that place a use of an edge.
struct UseNumbers
{
  int Model = 0;
  int Face = 0;
  int Loop = 0;
  int Curve = 0;
  int Edge = 0;
  int Begin = 0;
  int End = 0;
  int Reversed = 0;
};

/// Block, model, number within the model, which of its copies.
using Key = std::array<int, 4>;

struct FaceUses
{
  int Index = 0;                                     ///< in TrimmedModel::Faces
  int Expected = 0;                                  ///< trimming curves; -1: not known
  std::map<std::pair<int, int>, TrimmingCurve> Uses; ///< by loop and place in it
};

class ModelReader
{
public:
  ModelReader(vtkDataObject* surfaces, std::vector<std::string>* warnings)
    : Surfaces("surfaces", surfaces), Warnings(warnings)
  {
  }
  Result<TrimmedModel> Read(vtkDataObject* curves);

private:
  Result<TrimmedModel> ReadPatches(vtkDataObject* curves);
  Status ReadFace(const SplinePatch& patch);
  Status ReadFacesOfMesh(const SplinePatch& patch, const Spline<2>& surface);
  void AppendFacesOfMeshes();
  void ReadLook(const SplinePatch& patch, TrimmedFace& face) const;
  Status ReadUse(const PatchReader& curves, const SplinePatch& patch);
  Status AddUse(
    const std::string& place, int block, const UseNumbers& numbers, int copy, TrimmingCurve use);
  Status ReadCarried(int block, const CarriedCurves& carried);
  Result<AffineMap> MoveOf(int block, const CarriedCurves& carried) const;
  Status Assemble();
  Status ShareEdge(const std::string& place, const Key& edge, TrimmingCurve& use);
  Status AssembleLoops(const std::string& place, const FaceUses& uses, TrimmedFace& face) const;
  void Warn(const std::vector<std::string>& texts)
  {
    if (this->Warnings)
    {
      this->Warnings->insert(this->Warnings->end(), texts.begin(), texts.end());
    }
  }

  PatchReader Surfaces;
  std::vector<std::string>* Warnings;
  TrimmedModel Model;
  std::vector<TrimmedModel> OnMeshes; ///< of surfaces on unstructured meshes
  std::map<Key, FaceUses> Faces;
  std::map<std::array<int, 5>, int> Copies; // of a use: block, model, face, loop, curve
  std::map<Key, TrimmingCurve> Edges;       // the first use of each
  std::map<Key, int> Vertices;
};

/// A surface on a mesh is several faces with loops of their own.
Status ModelReader::ReadFacesOfMesh(const SplinePatch& patch, const Spline<2>& surface)
{
  auto faces = FacesOfPatches(surface, 1);
  if (!faces)
  {
    return { faces.Status.Code, this->Surfaces.Place(patch) + ": " + faces.Status.Detail };
  }
  this->Warn({ this->Surfaces.Place(patch) + " lies on an unstructured mesh and becomes " +
    std::to_string(faces->Faces.size()) + " faces" });
  for (TrimmedFace& face : faces->Faces)
  {
    this->ReadLook(patch, face);
  }
  this->OnMeshes.push_back(std::move(faces.Value));
  return {};
}

/// Appends the faces of surfaces on meshes, as bodies of their own.
void ModelReader::AppendFacesOfMeshes()
{
  for (TrimmedModel& faces : this->OnMeshes)
  {
    AppendFaces(this->Model, std::move(faces));
  }
}

Status ModelReader::ReadFace(const SplinePatch& patch)
{
  const auto* surface = std::get_if<Spline<2>>(&patch.Geometry);
  if (surface && surface->Space->Kind == SpaceKind::Unstructured)
  {
    return this->ReadFacesOfMesh(patch, *surface);
  }
  if (!surface || surface->Space->Kind == SpaceKind::Bezier)
  {
    return { ErrorCode::DimensionMismatch,
      this->Surfaces.Place(patch) + " is no tensor-product surface" };
  }
  auto tensor = ToTensor(*surface, 1);
  if (!tensor)
  {
    return { tensor.Status.Code,
      this->Surfaces.Place(patch) + " as a tensor product: " + tensor.Status.Detail };
  }
  if (surface->Space->Kind != SpaceKind::Tensor)
  {
    this->Warn({ this->Surfaces.Place(patch) + " becomes a tensor product of " +
      std::to_string(tensor.Value.Space->NumFunctions) + " functions instead of " +
      std::to_string(surface->Space->NumFunctions) });
  }
  TrimmedFace face;
  face.Surface = std::move(tensor.Value);
  FaceUses uses;
  int model = 0;
  int id = 0;
  int reversed = 0;
  int type = static_cast<int>(SurfaceType::FreeForm);
  const std::tuple<const char*, int, int*> numbers[] = { { "ModelId", 0, &model },
    { "FaceId", patch.Id, &id }, { "FaceReversed", 0, &reversed }, { "Body", 0, &face.Body },
    { "TrimmingCurves", -1, &uses.Expected }, { "SurfaceType", type, &type } };
  for (const auto& [arrayName, otherwise, number] : numbers)
  {
    if (Status status = this->Surfaces.ReadNumber(patch, arrayName, otherwise, *number); !status)
    {
      return status;
    }
  }
  face.Reversed = reversed != 0;
  if (type < 0 || type >= NumSurfaceTypes)
  {
    return { ErrorCode::InvalidTopology,
      this->Surfaces.Place(patch) + ": cell array 'SurfaceType' is " + std::to_string(type) +
        ", not a type from 0 to " + std::to_string(NumSurfaceTypes - 1) };
  }
  face.Type = static_cast<SurfaceType>(type);
  this->ReadLook(patch, face);
  uses.Index = static_cast<int>(this->Model.Faces.size());
  Key key{ patch.Block, model, id, 0 };
  while (!this->Faces.emplace(key, uses).second)
  {
    ++key[3];
  }
  this->Model.Faces.push_back(std::move(face));
  return {};
}

void ModelReader::ReadLook(const SplinePatch& patch, TrimmedFace& face) const
{
  const vtkIdType cell = patch.Cells.front();
  if (auto* names = this->Surfaces.Find<vtkStringArray>(patch, "Name"))
  {
    face.Name = names->GetValue(cell);
  }
  auto* colors = this->Surfaces.Find<vtkUnsignedCharArray>(patch, "Color");
  if (colors && colors->GetNumberOfComponents() >= 3)
  {
    face.HasColor = colors->GetNumberOfComponents() == 3 || colors->GetTypedComponent(cell, 3) > 0;
    for (int c = 0; c < 3; ++c)
    {
      face.Color[static_cast<std::size_t>(c)] =
        face.HasColor ? colors->GetTypedComponent(cell, c) / 255.0 : 0.0;
    }
  }
}

/// Uses of one edge have one curve: the first one that was read.
Status ModelReader::ShareEdge(const std::string& place, const Key& edge, TrimmingCurve& use)
{
  const auto [found, isNew] = this->Edges.emplace(edge, use);
  if (isNew)
  {
    found->second.Edge = this->Model.NumEdges++;
  }
  const TrimmingCurve& first = found->second;
  const Spline<1>& a = first.Curve;
  const Spline<1>& b = use.Curve;
  const double size = a.ControlPoints.cwiseAbs().maxCoeff();
  if (!(a.Space->Knots[0] == b.Space->Knots[0]) || a.IsRational() != b.IsRational() ||
    !((a.ControlPoints - b.ControlPoints).cwiseAbs().maxCoeff() <= MovedRounding * size) ||
    first.Vertices != use.Vertices)
  {
    return { ErrorCode::InvalidTopology,
      place + ": edge " + std::to_string(edge[2]) + " has two different curves" };
  }
  use.Curve = a;
  use.Edge = first.Edge;
  return {};
}

Status ModelReader::ReadUse(const PatchReader& curves, const SplinePatch& patch)
{
  const std::string place = curves.Place(patch);
  UseNumbers n;
  const std::tuple<const char*, std::optional<int>, int*> numbers[] = { { "ModelId", 0, &n.Model },
    { "FaceId", {}, &n.Face }, { "LoopId", {}, &n.Loop }, { "CurveId", {}, &n.Curve },
    { "EdgeId", {}, &n.Edge }, { "BeginVertex", {}, &n.Begin }, { "EndVertex", {}, &n.End },
    { "Reversed", 0, &n.Reversed } };
  for (const auto& [arrayName, otherwise, number] : numbers)
  {
    if (Status status = curves.ReadNumber(patch, arrayName, otherwise, *number); !status)
    {
      return status;
    }
  }
  const int copy = this->Copies[{ patch.Block, n.Model, n.Face, n.Loop, n.Curve }]++;
  const auto face = this->Faces.find({ patch.Block, n.Model, n.Face, copy });
  if (face == this->Faces.end()) // was not selected
  {
    return {};
  }
  const auto* curve = std::get_if<Spline<1>>(&patch.Geometry);
  if (!curve || curve->Space->Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, place + " is no B-spline curve" };
  }
  const auto field = std::find_if(patch.Fields.begin(), patch.Fields.end(),
    [](const SplineField& candidate) { return candidate.Name == PlaneCurve; });
  if (field == patch.Fields.end() || field->Coefficients.cols() != 2)
  {
    return { ErrorCode::InvalidTopology,
      place + ": the point array 'UV' with two components is missing" };
  }
  TrimmingCurve use;
  use.Curve = *curve;
  use.UV = field->Coefficients;
  use.Reversed = n.Reversed != 0;
  return this->AddUse(place, patch.Block, n, copy, std::move(use));
}

/// Edges and vertices get the numbers that they have here. @pre the face is there.
Status ModelReader::AddUse(
  const std::string& place, int block, const UseNumbers& n, int copy, TrimmingCurve use)
{
  for (std::size_t end = 0; end < 2; ++end)
  {
    const Key vertex{ block, n.Model, end == 0 ? n.Begin : n.End, copy };
    const int next = static_cast<int>(this->Vertices.size());
    use.Vertices[end] = this->Vertices.emplace(vertex, next).first->second;
  }
  if (Status status = this->ShareEdge(place, { block, n.Model, n.Edge, copy }, use); !status)
  {
    return status;
  }
  this->Faces.at({ block, n.Model, n.Face, copy }).Uses[{ n.Loop, n.Curve }] = std::move(use);
  return {};
}

/// How the surfaces of a block were moved since their curves were stored.
Result<AffineMap> ModelReader::MoveOf(int block, const CarriedCurves& carried) const
{
  std::vector<const PointMatrix*> before;
  std::vector<const PointMatrix*> after;
  Eigen::Index rows = 0;
  bool moved = false;
  for (const auto& [face, points] : carried.Surfaces)
  {
    const auto found = this->Faces.find({ block, carried.ModelId, face, 0 });
    if (found == this->Faces.end()) // was not selected
    {
      continue;
    }
    const PointMatrix& now =
      this->Model.Faces[static_cast<std::size_t>(found->second.Index)].Surface.ControlPoints;
    if (now.rows() != points.rows())
    {
      return { ErrorCode::InvalidTopology,
        "face " + std::to_string(face) +
          " has other control points than when its trimming curves were made; give the curves" };
    }
    before.push_back(&points);
    after.push_back(&now);
    rows += now.rows();
    moved = moved || now != points;
  }
  if (!moved)
  {
    return AffineMap();
  }
  PointMatrix from(rows, 3);
  PointMatrix to(rows, 3);
  Eigen::Index row = 0;
  for (std::size_t f = 0; f < before.size(); row += before[f]->rows(), ++f)
  {
    from.middleRows(row, before[f]->rows()) = *before[f];
    to.middleRows(row, after[f]->rows()) = *after[f];
  }
  auto map = FitAffineMap(from, to);
  if (map && !(map->MaxResidual <= MovedRounding * to.cwiseAbs().maxCoeff()))
  {
    return { ErrorCode::InvalidTopology,
      "the surfaces were bent after they were trimmed; give the trimming curves, bent alike" };
  }
  return map;
}

/// The curves that travel with the surfaces of a block.
Status ModelReader::ReadCarried(int block, const CarriedCurves& carried)
{
  const auto map = this->MoveOf(block, carried);
  if (!map)
  {
    return map.Status;
  }
  const bool moved = map->Linear != Eigen::Matrix3d::Identity() || !map->Shift.isZero(0.0);
  for (const CarriedCurve& curve : carried.Curves)
  {
    UseNumbers n;
    n.Model = carried.ModelId;
    n.Face = curve.Face;
    n.Loop = curve.Loop;
    n.Curve = curve.Curve;
    n.Edge = curve.Use.Edge;
    n.Begin = curve.Use.Vertices[0];
    n.End = curve.Use.Vertices[1];
    if (this->Faces.count({ block, n.Model, n.Face, 0 }) == 0)
    {
      continue;
    }
    TrimmingCurve use = curve.Use;
    if (moved)
    {
      use.Curve.ControlPoints = map->Apply(use.Curve.ControlPoints);
    }
    const std::string place = "the trimming curves of face " + std::to_string(n.Face);
    if (Status status = this->AddUse(place, block, n, 0, std::move(use)); !status)
    {
      return status;
    }
  }
  return {};
}

Status ModelReader::AssembleLoops(
  const std::string& place, const FaceUses& uses, TrimmedFace& face) const
{
  const auto found = static_cast<int>(uses.Uses.size());
  if (uses.Expected >= 0 && uses.Expected != found)
  {
    return { ErrorCode::InvalidTopology,
      place + " has " + std::to_string(found) + " of its " + std::to_string(uses.Expected) +
        " trimming curves; keep or remove whole faces, and use curves of the same model" };
  }
  for (const auto& [at, use] : uses.Uses)
  {
    const auto [loop, curve] = at;
    if (loop == static_cast<int>(face.Loops.size()))
    {
      face.Loops.emplace_back();
    }
    if (loop + 1 != static_cast<int>(face.Loops.size()) ||
      curve != static_cast<int>(face.Loops.back().Curves.size()))
    {
      return { ErrorCode::InvalidTopology,
        place + ": LoopId and CurveId leave out what comes before loop " + std::to_string(loop) +
          ", curve " + std::to_string(curve) };
    }
    face.Loops.back().Curves.push_back(use);
  }
  return {};
}

Result<TrimmedModel> ModelReader::Read(vtkDataObject* curves)
{
  const auto read = this->ReadPatches(curves);
  if (read)
  {
    this->AppendFacesOfMeshes();
  }
  return read ? Result<TrimmedModel>(this->Model) : read;
}

Result<TrimmedModel> ModelReader::ReadPatches(vtkDataObject* curves)
{
  if (!this->Surfaces.Outcome)
  {
    return this->Surfaces.Outcome;
  }
  this->Warn(this->Surfaces.Model.Warnings);
  if (this->Surfaces.Model.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "there are no surfaces" };
  }
  for (const SplinePatch& patch : this->Surfaces.Model.Patches)
  {
    if (Status status = this->ReadFace(patch); !status)
    {
      return status;
    }
  }
  if (!curves)
  {
    bool carries = false;
    for (const auto& [block, grid] : this->Surfaces.Blocks())
    {
      const auto carried = LoadCurves(grid);
      Status status = carried ? this->ReadCarried(block, carried.Value) : carried.Status;
      if (!status)
      {
        return status;
      }
      carries = carries || !carried->Curves.empty();
    }
    if (carries)
    {
      Status status = this->Assemble();
      return status ? Result<TrimmedModel>(this->Model) : Result<TrimmedModel>(status);
    }
    const auto trimmed = [](const auto& face) { return face.second.Expected > 0; };
    if (std::any_of(this->Faces.begin(), this->Faces.end(), trimmed))
    {
      this->Warn({ "trimming curves are not given: the faces are the whole surfaces" });
    }
    return this->Model;
  }
  const PatchReader reader("curves", curves);
  if (!reader.Outcome)
  {
    return reader.Outcome;
  }
  this->Warn(reader.Model.Warnings);
  for (const SplinePatch& patch : reader.Model.Patches)
  {
    if (Status status = this->ReadUse(reader, patch); !status)
    {
      return status;
    }
  }
  if (Status status = this->Assemble(); !status)
  {
    return status;
  }
  return this->Model;
}

/// Loops of the faces from the uses that were read.
Status ModelReader::Assemble()
{
  this->Model.NumVertices = static_cast<int>(this->Vertices.size());
  for (const auto& [key, uses] : this->Faces)
  {
    TrimmedFace& face = this->Model.Faces[static_cast<std::size_t>(uses.Index)];
    const std::string place = "face " + std::to_string(key[2]);
    if (Status status = this->AssembleLoops(place, uses, face); !status)
    {
      return status;
    }
  }
  return this->Model.Check();
}
}

Status EncodeTrimmedModel(
  const TrimmedModel& model, vtkUnstructuredGrid* surfaces, vtkUnstructuredGrid* curves)
{
  if (Status status = model.Check(); !status)
  {
    return status;
  }
  SplineModel faces;
  SplineModel uses;
  std::map<std::string, std::vector<int>> ofFace;
  std::map<std::string, std::vector<int>> ofUse;
  const int modelNumber = ModelNumber(model);
  const auto any = [&](auto has)
  { return std::any_of(model.Faces.begin(), model.Faces.end(), has); };
  const bool isAnyAnalytic =
    any([](const TrimmedFace& face) { return face.Type != SurfaceType::FreeForm; });
  for (const TrimmedFace& face : model.Faces)
  {
    const auto f = static_cast<int>(faces.Patches.size());
    faces.Patches.emplace_back();
    faces.Patches.back().Id = f;
    faces.Patches.back().Geometry = face.Surface;
    const std::size_t before = uses.Patches.size();
    for (std::size_t l = 0; l < face.Loops.size(); ++l)
    {
      for (std::size_t c = 0; c < face.Loops[l].Curves.size(); ++c)
      {
        const TrimmingCurve& use = face.Loops[l].Curves[c];
        SplinePatch patch;
        patch.Id = static_cast<int>(uses.Patches.size());
        patch.Geometry = use.Curve;
        patch.Fields = { { PlaneCurve, use.UV } };
        uses.Patches.push_back(std::move(patch));
        ofUse["ModelId"].push_back(modelNumber);
        ofUse["FaceId"].push_back(f);
        ofUse["LoopId"].push_back(static_cast<int>(l));
        ofUse["CurveId"].push_back(static_cast<int>(c));
        ofUse["EdgeId"].push_back(use.Edge);
        ofUse["BeginVertex"].push_back(use.Vertices[0]);
        ofUse["EndVertex"].push_back(use.Vertices[1]);
        ofUse["Reversed"].push_back(use.Reversed ? 1 : 0);
      }
    }
    ofFace["ModelId"].push_back(modelNumber);
    ofFace["FaceId"].push_back(f);
    ofFace["FaceReversed"].push_back(face.Reversed ? 1 : 0);
    ofFace["Body"].push_back(face.Body);
    ofFace["TrimmingCurves"].push_back(static_cast<int>(uses.Patches.size() - before));
    if (isAnyAnalytic)
    {
      ofFace["SurfaceType"].push_back(static_cast<int>(face.Type));
    }
  }
  faces.Topology = SharedEdges(model);
  Status status = EncodeSplineGrid(faces, surfaces);
  status = status ? EncodeSplineGrid(uses, curves) : status;
  if (!status)
  {
    return status;
  }
  for (const auto& [arrayName, numbers] : ofFace)
  {
    AddNumbers(surfaces, arrayName.c_str(), numbers);
  }
  for (const auto& [arrayName, numbers] : ofUse)
  {
    AddNumbers(curves, arrayName.c_str(), numbers);
  }
  if (any([](const TrimmedFace& face) { return face.HasColor; }))
  {
    AddColors(surfaces, model.Faces);
  }
  if (any([](const TrimmedFace& face) { return !face.Name.empty(); }))
  {
    AddNames(surfaces, model.Faces);
  }
  StoreCurves(model, modelNumber, surfaces);
  return {};
}

Result<TrimmedModel> DecodeTrimmedModel(
  vtkDataObject* surfaces, vtkDataObject* curves, std::vector<std::string>* warnings)
{
  return ModelReader(surfaces, warnings).Read(curves);
}
}
