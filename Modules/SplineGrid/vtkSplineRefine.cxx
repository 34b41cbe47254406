// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineRefine.h"

#include "PatchFields.h"
#include "ReferenceSystem.h"
#include "SegmentTable.h"
#include "SplineBlocks.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/LRVolume.h>
#include <knotwork/SplineCore/Refinement.h>
#include <knotwork/SplineCore/SizeLimit.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkExtractSelection.h"
#include "vtkImplicitFunction.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <numeric>
#include <set>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineRefine);
vtkCxxSetObjectMacro(vtkSplineRefine, ImplicitFunction, vtkImplicitFunction);

/// Which elements are marked, by what the mode looks at.
class vtkSplineRefine::Marker
{
public:
  explicit Marker(vtkSplineRefine* filter) : Filter(filter) {}
  Status Prepare(vtkDataObject* input, vtkSelection* selection);

  /// Marks of a patch as it came in.
  std::vector<char> MarkCells(const knotwork::SplinePatch& patch) const;
  /// Marked elements of a spline whose first three components are positions.
  template <int Dim>
  Status MarkByFunction(const knotwork::Spline<Dim>& spline, std::vector<char>& marks) const;

private:
  Status PrepareArray(vtkDataObject* input);
  Status PrepareSelection(vtkDataObject* input, vtkSelection* selection);

  vtkSplineRefine* Filter;
  std::map<int, std::vector<char>> Cells; ///< by block
};

Status vtkSplineRefine::Marker::Prepare(vtkDataObject* input, vtkSelection* selection)
{
  switch (this->Filter->Mode)
  {
    case CELL_ARRAY:
      return this->PrepareArray(input);
    case SELECTION:
      return this->PrepareSelection(input, selection);
    case IMPLICIT_FUNCTION:
      if (!this->Filter->ImplicitFunction)
      {
        return { ErrorCode::InvalidParameter, "set the implicit function to refine by" };
      }
      break;
    default:
      break;
  }
  return {};
}

Status vtkSplineRefine::Marker::PrepareArray(vtkDataObject* input)
{
  bool found = false;
  bool empty = true;
  for (const auto& [block, grid] : knotwork::GridsByBlock(input))
  {
    empty = empty && grid->GetNumberOfCells() == 0;
    int association = vtkDataObject::FIELD_ASSOCIATION_CELLS;
    vtkDataArray* array = this->Filter->GetInputArrayToProcess(0, grid, association);
    if (!array)
    {
      continue;
    }
    if (association != vtkDataObject::FIELD_ASSOCIATION_CELLS ||
      array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != grid->GetNumberOfCells())
    {
      return { ErrorCode::InvalidParameter,
        std::string("the array to refine by must have one value a cell, '") +
          (array->GetName() ? array->GetName() : "") + "' has not" };
    }
    found = true;
    std::vector<char>& marks = this->Cells[block];
    for (vtkIdType cell = 0; cell < array->GetNumberOfTuples(); ++cell)
    {
      const double value = array->GetTuple1(cell);
      marks.push_back(
        value >= this->Filter->LowerThreshold && value <= this->Filter->UpperThreshold ? 1 : 0);
    }
  }
  if (!found && !empty)
  {
    return { ErrorCode::InvalidParameter, "there is no such cell array to refine by" };
  }
  return {};
}

Status vtkSplineRefine::Marker::PrepareSelection(vtkDataObject* input, vtkSelection* selection)
{
  if (!selection)
  {
    return { ErrorCode::InvalidParameter, "set the selection to refine by (input port 1)" };
  }
  if (selection->GetNumberOfNodes() == 0) // nothing is selected
  {
    return {};
  }
  for (unsigned int n = 0; n < selection->GetNumberOfNodes(); ++n)
  {
    vtkSelectionNode* node = selection->GetNode(n);
    // those that vtkExtractSelection itself knows; it crashes on others
    static const std::set<int> known{ vtkSelectionNode::GLOBALIDS, vtkSelectionNode::PEDIGREEIDS,
      vtkSelectionNode::VALUES, vtkSelectionNode::INDICES, vtkSelectionNode::FRUSTUM,
      vtkSelectionNode::LOCATIONS, vtkSelectionNode::THRESHOLDS, vtkSelectionNode::BLOCKS };
    if (node->GetFieldType() != vtkSelectionNode::CELL)
    {
      return { ErrorCode::InvalidParameter, "the selection to refine by must select cells" };
    }
    if (known.count(node->GetContentType()) == 0)
    {
      return { ErrorCode::InvalidParameter,
        "queries cannot be followed: freeze the selection, so that it is a list of cells" };
    }
  }
  vtkNew<vtkExtractSelection> extract;
  extract->SetInputDataObject(0, input);
  extract->SetInputDataObject(1, selection);
  extract->PreserveTopologyOn();
  extract->Update();
  for (const auto& [block, grid] : knotwork::GridsByBlock(extract->GetOutputDataObject(0)))
  {
    vtkDataArray* inside = grid->GetCellData()->GetArray("vtkInsidedness");
    if (!inside && grid->GetNumberOfCells() > 0)
    {
      return { ErrorCode::InvalidParameter, "the selection does not fit the input" };
    }
    std::vector<char>& marks = this->Cells[block];
    for (vtkIdType cell = 0; inside && cell < inside->GetNumberOfTuples(); ++cell)
    {
      marks.push_back(inside->GetTuple1(cell) > 0 ? 1 : 0);
    }
  }
  return {};
}

std::vector<char> vtkSplineRefine::Marker::MarkCells(const knotwork::SplinePatch& patch) const
{
  std::vector<char> marks(patch.Cells.size(), 0);
  const auto found = this->Cells.find(patch.Block);
  for (std::size_t e = 0; found != this->Cells.end() && e < marks.size(); ++e)
  {
    const auto cell = static_cast<std::size_t>(patch.Cells[e]);
    marks[e] = cell < found->second.size() ? found->second[cell] : char(0);
  }
  return marks;
}

template <int Dim>
Status vtkSplineRefine::Marker::MarkByFunction(
  const knotwork::Spline<Dim>& spline, std::vector<char>& marks) const
{
  constexpr int samples = Dim == 1 ? 3 : Dim == 2 ? 9 : 27;
  const int numElements = spline.Space->NumElements();
  std::vector<int> elements;
  knotwork::PointMatrix local(static_cast<Eigen::Index>(numElements) * samples, Dim);
  for (int e = 0; e < numElements; ++e)
  {
    elements.insert(elements.end(), samples, e);
    for (int i = 0; i < samples; ++i)
    {
      int rest = i;
      for (int d = 0; d < Dim; ++d, rest /= 3)
      {
        local(static_cast<Eigen::Index>(e) * samples + i, d) = 0.5 * (rest % 3);
      }
    }
  }
  knotwork::EvaluationParams params;
  params.Threads = this->Filter->KernelThreads();
  knotwork::EvaluationBatch batch;
  const Status status =
    EvaluateElements(MakeBezierForm(spline, params.Threads), elements, local, params, batch);
  if (!status)
  {
    return status;
  }
  marks.assign(static_cast<std::size_t>(numElements), 0);
  for (int e = 0; e < numElements; ++e)
  {
    bool inside = false;
    bool outside = false;
    for (int i = 0; i < samples; ++i)
    {
      double x[3];
      Eigen::Map<Eigen::RowVector3d>(x, 3) =
        batch.Values.row(static_cast<Eigen::Index>(e) * samples + i).template head<3>();
      const double value = this->Filter->ImplicitFunction->FunctionValue(x);
      if (std::isnan(value))
      {
        return { ErrorCode::NonFiniteInput,
          "the implicit function has no value at element " + std::to_string(e) };
      }
      inside = inside || value <= 0.0;
      outside = outside || value >= 0.0;
    }
    marks[static_cast<std::size_t>(e)] =
      inside && (outside || this->Filter->ImplicitRegion == CROSSED_OR_INSIDE) ? 1 : 0;
  }
  return {};
}

namespace
{
/// Values of elements become those of their children.
template <typename Value>
void PassToChildren(const std::vector<int>& parents, std::vector<Value>& values)
{
  std::vector<Value> passed;
  passed.reserve(parents.size());
  for (const int parent : parents)
  {
    passed.push_back(values[static_cast<std::size_t>(parent)]);
  }
  values = std::move(passed);
}

/// Smallest extension for which a marked element brings new functions in every direction.
template <int Dim>
int AutomaticExtension(const knotwork::SplineSpace<Dim>& space)
{
  int extension = 0;
  for (const knotwork::KnotVector& knots : space.Knots)
  {
    extension = std::max(extension, knots.Degree() / 2);
  }
  return extension;
}
}

vtkSplineRefine::vtkSplineRefine()
{
  this->SetInputTypes(
    { Splines(), Optional({ { "vtkSelection" } }), Optional({ { "vtkTable", "vtkPolyData" } }) });
  knotwork::KeepReferenceSystem(this);
}

vtkSplineRefine::~vtkSplineRefine()
{
  this->SetImplicitFunction(nullptr);
}

vtkMTimeType vtkSplineRefine::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  if (this->ImplicitFunction)
  {
    time = std::max(time, this->ImplicitFunction->GetMTime());
  }
  return time;
}

void vtkSplineRefine::SetSelectionConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineRefine::SetSelectionData(vtkDataObject* selection)
{
  this->SetInputDataObject(1, selection);
}

void vtkSplineRefine::SetSegmentsConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(2, output);
}

void vtkSplineRefine::SetSegmentsData(vtkDataObject* segments)
{
  this->SetInputDataObject(2, segments);
}

/// A refinement of a patch, by the properties of the filter.
class vtkSplineRefine::Stepper
{
public:
  explicit Stepper(vtkSplineRefine* filter) : Filter(filter) {}

  /// @param round  number of the refinement.
  template <int Dim>
  knotwork::Result<knotwork::RefinedSpline<Dim>> Refine(
    const knotwork::Spline<Dim>& spline, std::vector<int> marked, int round) const
  {
    const knotwork::SpaceKind kind = spline.Space->Kind;
    const bool everywhere = this->Filter->Mode == UNIFORM || this->Filter->GlobalRefinement;
    if constexpr (Dim == 2)
    {
      if (kind == knotwork::SpaceKind::LocallyRefined && everywhere)
      {
        marked.resize(spline.Space->Elements.size());
        std::iota(marked.begin(), marked.end(), 0);
      }
      if (kind == knotwork::SpaceKind::LocallyRefined ||
        (kind == knotwork::SpaceKind::Tensor && !everywhere &&
          this->Filter->LocalSpace == LOCALLY_REFINED))
      {
        return RefineMarkedLR(spline, marked, this->LRParams(round));
      }
    }
    if constexpr (Dim == 3)
    {
      if (!everywhere &&
        (kind == knotwork::SpaceKind::LocallyRefined ||
          (kind == knotwork::SpaceKind::Tensor && this->Filter->LocalSpace == LOCALLY_REFINED)))
      {
        knotwork::LRVolumeStrategyParams params;
        params.Strategy = static_cast<knotwork::LRStrategy>(this->Filter->LRStrategy);
        return RefineMarkedLRVolume(
          spline, marked, params, knotwork::DefaultMaxFunctions, this->Filter->KernelThreads());
      }
    }
    if (everywhere)
    {
      return RefineAllElements(spline);
    }
    knotwork::RefinementParams params;
    params.Extension =
      this->Filter->Extension < 0 ? AutomaticExtension(*spline.Space) : this->Filter->Extension;
    params.AdmissibleClass = this->Filter->AdmissibleClass;
    params.MaxLevel = this->Filter->MaxLevel;
    return RefineMarkedElements(spline, marked, params);
  }

  /// Inserts segments. @param most  functions that the patch may have.
  template <int Dim>
  knotwork::Result<knotwork::RefinedSpline<Dim>> Insert(const knotwork::Spline<Dim>& spline,
    const std::vector<knotwork::LRSegment>& segments, double most) const
  {
    if constexpr (Dim == 2)
    {
      const double limit = std::min<double>(most, VTK_INT_MAX);
      return RefineBySegments(spline, segments, static_cast<int>(limit), this->LRParams(0));
    }
    return Status(ErrorCode::DimensionMismatch, "only surfaces have segments of mesh lines");
  }

  /// About the functions that a refinement of marked elements adds.
  template <int Dim>
  double Growth(const knotwork::Spline<Dim>& spline, std::size_t numMarked) const
  {
    const int elements =
      this->Filter->GlobalRefinement ? spline.Space->NumElements() : static_cast<int>(numMarked);
    return ((1 << Dim) - 1.0) * elements;
  }

  /// A dependence that came in goes, also when nothing was refined.
  template <int Dim>
  Status Finish(knotwork::Spline<Dim>& spline, std::vector<vtkIdType>& cells) const
  {
    if constexpr (Dim == 2)
    {
      if (this->Filter->KeepIndependent &&
        spline.Space->Kind == knotwork::SpaceKind::LocallyRefined)
      {
        auto refined = RefineMarkedLR(spline, {}, this->LRParams(0));
        if (!refined)
        {
          return refined.Status;
        }
        spline = std::move(refined->Value);
        PassToChildren(refined->Parents, cells);
      }
    }
    return {};
  }

private:
  knotwork::LRRefinementParams LRParams(int round) const
  {
    const int directions = this->Filter->LRDirections;
    const int first = directions == ALTERNATING ? round % 2 : directions - FIRST;
    knotwork::LRRefinementParams params;
    params.Segments.Strategy = static_cast<knotwork::LRStrategy>(this->Filter->LRStrategy);
    params.Segments.Directions = { directions == BOTH || first == 0,
      directions == BOTH || first == 1 };
    params.ByFunction = this->Filter->LRTarget == FUNCTIONS;
    params.KeepIndependent = this->Filter->KeepIndependent;
    params.Threads = this->Filter->KernelThreads();
    return params;
  }

  vtkSplineRefine* Filter;
};

Status vtkSplineRefine::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  auto decoded = this->DecodeInput(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  knotwork::SplineModel& model = decoded.Value;
  if (this->AdmissibleClass == 1)
  {
    return { ErrorCode::InvalidParameter, "the admissible class is 0 (none) or at least 2" };
  }
  Marker marker(this);
  if (const Status status = marker.Prepare(input, vtkSelection::GetData(inputs[1], 0)); !status)
  {
    return status;
  }

  knotwork::SegmentsByPatch segments;
  if (this->Mode == SEGMENTS && !model.Patches.empty())
  {
    auto read = knotwork::ReadSegments(vtkDataObject::GetData(inputs[2], 0), model);
    if (!read)
    {
      return read.Status;
    }
    segments = std::move(read.Value);
  }

  double total = 0.0;
  double given = 0.0; // is not refused
  for (const knotwork::SplinePatch& patch : model.Patches)
  {
    total += std::visit(
      [this, &given](const auto& spline)
      {
        given += spline.Space->NumFunctions;
        return FunctionsAfterRefinement(*spline.Space, this->DegreeElevation,
          this->Mode == UNIFORM ? this->NumberOfRefinements : 0);
      },
      patch.Geometry);
  }
  const double limit = std::max(given, 1.0 * this->MaximumFunctions);
  if (const Status status = knotwork::CheckSize(total, limit); !status)
  {
    return status;
  }

  const Stepper stepper(this);
  const knotwork::ProgressCallback progress = this->Progress();
  std::map<int, std::vector<vtkIdType>> sources; // cells by block
  for (std::size_t p = 0; p < model.Patches.size(); ++p)
  {
    if (!progress(static_cast<double>(p) / static_cast<double>(model.Patches.size())))
    {
      return { ErrorCode::Aborted, "" };
    }
    knotwork::SplinePatch& patch = model.Patches[p];
    std::vector<vtkIdType> cells = patch.Cells;
    const auto refine = [&](const auto& geometry)
    {
      auto elevated = ElevateAllDegrees(JoinFields(geometry, patch.Fields), this->DegreeElevation);
      if (!elevated)
      {
        return elevated.Status;
      }
      auto spline = std::move(elevated.Value);
      const auto lines = segments.find(patch.Id);
      if (lines != segments.end())
      {
        const int before = spline.Space->NumFunctions;
        auto refined = stepper.Insert(spline, lines->second, limit - total + before);
        if (!refined)
        {
          return refined.Status;
        }
        spline = std::move(refined->Value);
        total += spline.Space->NumFunctions - before;
        PassToChildren(refined->Parents, cells);
      }
      std::vector<char> marks = marker.MarkCells(patch);
      const int rounds = this->Mode == SEGMENTS ? 0 : this->NumberOfRefinements;
      for (int round = 0; round < rounds; ++round)
      {
        if (this->Mode == IMPLICIT_FUNCTION)
        {
          if (const Status status = marker.MarkByFunction(spline, marks); !status)
          {
            return status;
          }
        }
        std::vector<int> marked;
        for (std::size_t e = 0; e < marks.size(); ++e)
        {
          if (marks[e])
          {
            marked.push_back(static_cast<int>(e));
          }
        }
        if (this->Mode != UNIFORM && marked.empty())
        {
          break;
        }
        const double more = this->Mode == UNIFORM ? 0.0 : stepper.Growth(spline, marked.size());
        if (const Status status = knotwork::CheckSize(total + more, limit); !status)
        {
          return status;
        }
        const int before = spline.Space->NumFunctions;
        auto refined = stepper.Refine(spline, marked, round);
        if (!refined)
        {
          return refined.Status;
        }
        spline = std::move(refined->Value);
        total += this->Mode == UNIFORM ? 0 : spline.Space->NumFunctions - before;
        PassToChildren(refined->Parents, cells);
        PassToChildren(refined->Parents, marks);
        if (!progress((static_cast<double>(p) + (round + 1.0) / rounds) /
              static_cast<double>(model.Patches.size())))
        {
          return Status(ErrorCode::Aborted, "");
        }
      }
      if (const Status status = stepper.Finish(spline, cells); !status)
      {
        return status;
      }
      SeparateFields(spline, patch);
      return Status();
    };
    const knotwork::AnySpline geometry = patch.Geometry;
    const Status status = std::visit(refine, geometry);
    if (!status)
    {
      return { status.Code, "patch " + std::to_string(patch.Id) + ": " + status.Detail };
    }
    patch.Cells = cells;
    auto& blockCells = sources[patch.Block];
    blockCells.insert(blockCells.end(), cells.begin(), cells.end());
  }

  if (const Status status = knotwork::EncodeSplineModel(model, input, output); !status)
  {
    return status;
  }
  const auto from = knotwork::GridsByBlock(input);
  for (const auto& [block, grid] : knotwork::GridsByBlock(output))
  {
    const auto source = from.find(block);
    if (source != from.end())
    {
      knotwork::PassCellData(source->second, sources[block], grid);
    }
  }
  return {};
}
