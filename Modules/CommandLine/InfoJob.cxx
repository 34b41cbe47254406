// SPDX-License-Identifier: BSD-3-Clause
#include "Jobs.h"
#include "Session.h"
#include <knotwork/SplineCore/ExplicitSpace.h>
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/LRDependence.h>
#include <knotwork/SplineCore/SpaceFamily.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/FileFormats.h>
#include <knotwork/SplineIO/OneLine.h>

#include <CLI/CLI.hpp>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>

namespace knotwork
{
namespace
{
/// "3 x 2"; "mixed" when elements differ.
template <int Dim>
std::string Degrees(const SplineSpace<Dim>& space)
{
  const IntArray<Dim>& first = space.Elements.front().Degree;
  for (const auto& element : space.Elements)
  {
    if (element.Degree != first)
    {
      return "mixed";
    }
  }
  std::string text;
  for (int p : first)
  {
    text += (text.empty() ? "" : " x ") + std::to_string(p);
  }
  return text;
}

template <int Dim>
int NumLevels(const SplineSpace<Dim>& space)
{
  int level = 0;
  for (const auto& element : space.Elements)
  {
    level = std::max(level, element.Level);
  }
  return level + 1;
}

/// Whether the functions are linearly independent; those of all kinds but LR and given operators
/// always are.
template <int Dim>
std::string Dependence(const SplineSpace<Dim>& space)
{
  if (space.Extraction && !AreLocallyIndependent<Dim>(*space.Extraction, space.NumFunctions))
  {
    return "undecided";
  }
  if constexpr (Dim > 1)
  {
    if (space.Kind == SpaceKind::LocallyRefined)
    {
      switch (DecideDependence(space)->Verdict)
      {
        case LRVerdict::Independent:
          break;
        case LRVerdict::Dependent:
          return "dependent";
        case LRVerdict::Undecided:
          return "undecided";
      }
    }
  }
  return "independent";
}

struct InfoJob
{
  std::string Input;

  /// Says how many points there are, where, and what they carry.
  Status DescribePoints(Session& session, vtkPointSet* points)
  {
    std::array<double, 6> box{};
    points->GetBounds(box.data());
    const bool finite =
      std::all_of(box.begin(), box.end(), [](double side) { return std::isfinite(side); });
    if (!finite)
    {
      return { ErrorCode::NonFiniteInput,
        "'" + this->Input + "' has points that are not finite; remove them" };
    }
    std::vector<std::string> arrays;
    std::cout << points->GetNumberOfPoints() << " points, box [" << box[0] << ", " << box[1]
              << "] x [" << box[2] << ", " << box[3] << "] x [" << box[4] << ", " << box[5] << "]";
    for (int i = 0; i < points->GetPointData()->GetNumberOfArrays(); ++i)
    {
      const char* name = points->GetPointData()->GetArrayName(i);
      arrays.emplace_back(name ? name : "");
      std::cout << ", array " << OneLine(arrays.back());
    }
    std::cout << "\n";
    session.Report["input"] = this->Input;
    session.Report["points"] = points->GetNumberOfPoints();
    session.Report["lower"] = { box[0], box[2], box[4] };
    session.Report["upper"] = { box[1], box[3], box[5] };
    session.Report["arrays"] = arrays;
    return {};
  }

  /// Whether the file is a mesh of a solver, whose cells are no splines.
  bool IsMesh() const
  {
    const FileFormat* format = FormatOfEnding(LowerEnding(this->Input));
    return format && (format->Reads & GridContent) != 0 && (format->Reads & SplineGridContent) == 0;
  }

  Status DescribeMesh(Session& session, vtkUnstructuredGrid* mesh)
  {
    std::map<int, vtkIdType> types;
    for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
    {
      ++types[mesh->GetCellType(c)];
    }
    std::cout << mesh->GetNumberOfCells() << " cells";
    for (const auto& [type, count] : types)
    {
      std::cout << ", " << count << " of VTK's type " << type;
    }
    std::vector<std::string> groups;
    auto* names =
      vtkStringArray::SafeDownCast(mesh->GetFieldData()->GetAbstractArray("PhysicalGroupNames"));
    for (vtkIdType i = 0; names && i < names->GetNumberOfValues(); ++i)
    {
      groups.push_back(names->GetValue(i));
      std::cout << ", group " << OneLine(groups.back());
    }
    std::cout << "\n";
    session.Report["cells"] = mesh->GetNumberOfCells();
    session.Report["groups"] = groups;
    return this->DescribePoints(session, mesh);
  }

  Status Run(Session& session)
  {
    auto input = session.Read(this->Input);
    if (!input)
    {
      return input.Status;
    }
    if (vtkPolyData* points = vtkPolyData::SafeDownCast(input.Value))
    {
      return this->DescribePoints(session, points);
    }
    auto* mesh = vtkUnstructuredGrid::SafeDownCast(input.Value);
    if (mesh && this->IsMesh())
    {
      return this->DescribeMesh(session, mesh);
    }
    Result<SplineModel> model = DecodeSplineModel(input.Value, session.Threads);
    if (!model)
    {
      return { model.Status.Code, "'" + this->Input + "': " + model.Status.Message() };
    }
    if (model->Patches.empty())
    {
      return { ErrorCode::EmptyInput, "'" + this->Input + "' holds no splines, only points" };
    }
    long long functions = 0;
    long long elements = 0;
    std::vector<int> patchIds;
    std::vector<std::string> kinds;
    std::vector<std::string> degrees;
    std::vector<std::string> dependences;
    bool rational = false;
    int dimension = 0;
    int levels = 0;
    double residual = 0.0;
    for (const SplinePatch& patch : model->Patches)
    {
      std::visit(
        [&](const auto& spline)
        {
          const auto& space = *spline.Space;
          std::cout << "patch " << patch.Id << ": " << FamilyOf(space).Name() << ", degree "
                    << Degrees(space) << ", " << space.NumFunctions << " functions, "
                    << space.NumElements() << " elements, " << NumLevels(space) << " level(s), "
                    << (spline.IsRational() ? "rational" : "polynomial");
          for (const SplineField& field : patch.Fields)
          {
            std::cout << ", field " << OneLine(field.Name) << " (" << field.Coefficients.cols()
                      << ")";
          }
          const std::string dependence = Dependence(space);
          if (dependence != "independent")
          {
            std::cout << ", functions linearly " << dependence
                      << " (refine --keep-independent resolves it)";
          }
          dependences.push_back(dependence);
          if (patch.Recovered)
          {
            std::cout << ", control points recovered with residual " << patch.Residual;
          }
          std::cout << "\n";
          functions += space.NumFunctions;
          elements += space.NumElements();
          levels = std::max(levels, NumLevels(space));
          rational = rational || spline.IsRational();
          kinds.emplace_back(FamilyOf(space).Name());
          degrees.push_back(Degrees(space));
        },
        patch.Geometry);
      patchIds.push_back(patch.Id);
      dimension = std::max(dimension, static_cast<int>(patch.Geometry.index()) + 1);
      residual = std::max(residual, patch.Residual);
    }
    session.Warn(model->Warnings);
    session.Report["input"] = this->Input;
    session.Report["patches"] = model->Patches.size();
    session.Report["patch_ids"] = patchIds;
    session.Report["kinds"] = kinds;
    session.Report["degrees"] = degrees;
    session.Report["dependences"] = dependences;
    session.Report["parametric_dimension"] = dimension;
    session.Report["functions"] = functions;
    session.Report["elements"] = elements;
    session.Report["levels"] = levels;
    session.Report["rational"] = rational;
    session.Report["recovery_residual"] = residual;
    return {};
  }
};

Job Make(CLI::App& app)
{
  auto job = std::make_shared<InfoJob>();
  app
    .add_option("input", job->Input,
      "spline grid, mesh or points (.vtu .vtpc .vtk .xml .g2 .bext .mesh .msh .inp .step .iges "
      ".xyz .txt .csv .las .tif .ply "
      ".vtp)")
    ->required();
  return [job](Session& session) { return job->Run(session); };
}

const JobRegistration Registration{ "info", "say what a spline file holds", "plate.vtu", Make };
}
}
