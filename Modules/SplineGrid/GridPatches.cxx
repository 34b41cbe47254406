// SPDX-License-Identifier: BSD-3-Clause
#include "GridReader.h"

#include <knotwork/SplineCore/BezierSpace.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Recovery.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace knotwork
{
namespace
{
PointMatrix ValuesOf(vtkDataArray* array, const std::vector<vtkIdType>& points)
{
  PointMatrix values(static_cast<Eigen::Index>(points.size()), array->GetNumberOfComponents());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    array->GetTuple(points[i], values.row(static_cast<Eigen::Index>(i)).data());
  }
  return values;
}

// Bezier form from gathered rows (x, y, z, w), homogeneous when rational.
template <int Dim>
BezierForm<Dim> FormOf(const SplineSpacePtr<Dim>& space, const PointMatrix& rows, int components,
  const Eigen::Index weightColumn)
{
  BezierForm<Dim> form;
  form.Space = space;
  form.NumComponents = components;
  form.Rational = weightColumn >= 0;
  form.Offsets.assign(1, 0);
  form.Data.reserve(static_cast<std::size_t>(rows.rows()) * form.NumPlanes());
  Eigen::Index first = 0;
  for (const auto& element : space->Elements)
  {
    const int n = NumTensorFunctions<Dim>(element.Degree);
    for (int c = 0; c < form.NumPlanes(); ++c)
    {
      for (Eigen::Index i = first; i < first + n; ++i)
      {
        const double w = form.Rational ? rows(i, weightColumn) : 1.0;
        form.Data.push_back(c < components ? w * rows(i, c) : w);
      }
    }
    first += n;
    form.Offsets.push_back(form.Data.size());
  }
  return form;
}
}

template <int Dim>
Status GridReader::Gather(
  const std::string& where, const SplineSpace<Dim>* space, PatchCells<Dim>& cells) const
{
  std::vector<vtkIdType> points;
  for (vtkIdType cell : cells.Cells)
  {
    IntArray<Dim> degree{};
    const IntArray<Dim>* expected = space ? &space->Elements[cells.Degrees.size()].Degree : nullptr;
    if (Status status = this->Bezier.Read<Dim>(where + ", ", cell, expected, degree, points);
        !status)
    {
      return status;
    }
    if (cells.Points.empty())
    {
      cells.Degrees.reserve(cells.Cells.size());
      cells.Points.reserve(cells.Cells.size() * points.size());
    }
    cells.Points.insert(cells.Points.end(), points.begin(), points.end());
    cells.Degrees.push_back(degree);
  }
  // not kept: of many elements, Bezier points of all need more memory than the grid
  cells.Sum = BeginGeometryChecksum<Dim>(cells.Degrees);
  const std::string opening = where + ", ";
  std::size_t i = 0;
  for (std::size_t e = 0; e < cells.Cells.size(); ++e)
  {
    for (int k = 0; k < NumTensorFunctions<Dim>(cells.Degrees[e]); ++k, ++i)
    {
      std::array<double, 4> row{};
      if (Status status =
            this->Bezier.ReadPoint(opening, cells.Cells[e], cells.Points[i], row.data());
          !status)
      {
        return status;
      }
      std::for_each(row.begin(), row.end(), [&](double value) { cells.Sum.Add(value); });
      cells.Weighted = cells.Weighted || row[3] != 1.0;
    }
  }
  return {};
}

/// Of gathered cells x, y, z, w of all points.
template <int Dim>
PointMatrix GridReader::RowsOf(const PatchCells<Dim>& cells) const
{
  PointMatrix rows(static_cast<Eigen::Index>(cells.Points.size()), 4);
  std::size_t i = 0;
  for (std::size_t e = 0; e < cells.Cells.size(); ++e)
  {
    for (int k = 0; k < NumTensorFunctions<Dim>(cells.Degrees[e]); ++k, ++i)
    {
      static_cast<void>(this->Bezier.ReadPoint({}, cells.Cells[e], cells.Points[i],
        rows.row(static_cast<Eigen::Index>(i)).data())); // has been checked
    }
  }
  return rows;
}

/// @param sum     of the values.
/// @param isZero  whether all are 0.
Status GridReader::CheckField(const std::string& where, vtkDataArray* array,
  const std::vector<vtkIdType>& points, Checksum& sum, bool& isZero) const
{
  Eigen::RowVectorXd row(array->GetNumberOfComponents());
  sum.Add(static_cast<std::uint64_t>(row.size()));
  isZero = true;
  bool isFinite = true;
  bool isWithinLimit = true;
  for (const vtkIdType point : points)
  {
    array->GetTuple(point, row.data());
    for (const double value : row)
    {
      isFinite = isFinite && std::isfinite(value);
      isWithinLimit = isWithinLimit && std::abs(value) <= LargestNumber;
      isZero = isZero && value == 0.0;
      sum.Add(value);
    }
  }
  if (!isFinite)
  {
    return { ErrorCode::NonFiniteInput,
      where + ": the point array '" + array->GetName() + "' has a value that is not finite" };
  }
  if (!isWithinLimit)
  {
    return { ErrorCode::TooLarge,
      where + ": point array '" + array->GetName() + "': " + BeyondLimit() };
  }
  return {};
}

template <int Dim>
Status GridReader::CheckBounds(const std::string& where, const SplineSpace<Dim>& space,
  const std::vector<vtkIdType>& cells) const
{
  vtkDataArray* bounds = this->Grid->GetCellData()->GetArray(name::Bounds);
  if (!space.HasDomain() || !bounds || bounds->GetNumberOfComponents() != 6 ||
    bounds->GetNumberOfTuples() != this->Grid->GetNumberOfCells())
  {
    return {};
  }
  const ParametricBox<Dim> domain = space.Domain();
  for (std::size_t e = 0; e < cells.size(); ++e)
  {
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const double slack = 1e-6 * (domain.Upper[d] - domain.Lower[d]); // the array may be float
      const int c = 2 * static_cast<int>(d);
      const ParametricBox<Dim>& box = space.Elements[e].Box;
      if (!(std::abs(bounds->GetComponent(cells[e], c) - box.Lower[d]) <= slack) ||
        !(std::abs(bounds->GetComponent(cells[e], c + 1) - box.Upper[d]) <= slack))
      {
        return { ErrorCode::InvalidTopology,
          where + ", " + CellName(cells[e]) + ": " + name::Bounds + " and " + name::ElementId +
            " " + std::to_string(e) + " do not fit together" };
      }
    }
  }
  return {};
}

template <int Dim>
Result<SplineSpacePtr<Dim>> GridReader::Space(const PatchRecord& record)
{
  const int hash = HashOf(record.Basis);
  const auto known = this->Spaces.find(hash);
  if (known != this->Spaces.end() && known->second.first == record.Basis)
  {
    return std::get<SplineSpacePtr<Dim>>(known->second.second);
  }
  Result<SplineSpacePtr<Dim>> made =
    FamilyOf<Dim>(record.Basis.Kind).Build(record.Basis, this->Threads);
  if (made &&
    (made.Value->NumElements() != record.NumElements ||
      made.Value->NumFunctions != record.NumFunctions))
  {
    made.Status = { ErrorCode::InvalidTopology,
      "its basis has " + std::to_string(made.Value->NumElements()) + " elements and " +
        std::to_string(made.Value->NumFunctions) + " functions, its record " +
        std::to_string(record.NumElements) + " and " + std::to_string(record.NumFunctions) };
  }
  if (made)
  {
    this->Spaces[hash] = { record.Basis, made.Value };
  }
  return made;
}

template <int Dim>
Status GridReader::ReadStructured(const CellGroup& group, const PatchRecord& record)
{
  std::vector<std::vector<vtkIdType>> copies;
  if (Status status = this->SplitCopies(group, record.NumElements, copies); !status)
  {
    return status;
  }
  const std::string where = PatchName(group.Id);
  Result<SplineSpacePtr<Dim>> space = this->Space<Dim>(record);
  if (!space)
  {
    return { space.Status.Code, where + ": " + space.Status.Detail };
  }
  if (record.Rational && !this->Bezier.HasWeights())
  {
    return { ErrorCode::InvalidWeight,
      where + " is rational, and its weights are missing (point array " + name::Weights + ")" };
  }
  for (const std::vector<vtkIdType>& copy : copies)
  {
    PatchCells<Dim> cells;
    cells.Cells = copy;
    if (Status status = this->Gather<Dim>(where, space.Value.get(), cells); !status)
    {
      return status;
    }
    if (Status status = this->CheckBounds<Dim>(where, *space.Value, copy); !status)
    {
      return status;
    }
    const bool rational = record.Rational || cells.Weighted;
    SplinePatch patch;
    Spline<Dim> spline;
    spline.Space = space.Value;

    // A record of the same basis whose checksum fits holds the control points.
    const PatchRecord* cached =
      this->FindCache(cells.Sum, record.Basis, space.Value->NumFunctions, group.Id);
    if (cached)
    {
      spline.ControlPoints = cached->ControlPoints.Rows.leftCols(3);
      if (cached->Rational)
      {
        spline.Weights = cached->ControlPoints.Rows.col(3);
      }
    }
    else
    {
      RecoveryResult<Dim> recovered = RecoverSpline(
        FormOf<Dim>(space.Value, this->RowsOf(cells), 3, rational ? 3 : -1), this->Threads);
      if (!recovered)
      {
        return { recovered.Status.Code, where + ": " + recovered.Status.Detail };
      }
      spline = std::move(recovered.Value);
      spline.Space = space.Value;
      patch.Recovered = true;
      patch.Residual = recovered.Residual;
      patch.Amplification = recovered.Amplification;
      const double rounding = 64.0 * this->Epsilon() * recovered.Amplification;
      if (recovered.Residual > rounding * recovered.Size || recovered.WeightResidual > rounding)
      {
        this->Warn(where +
          ": the points are not those of a spline of its space; they were projected, the largest "
          "distance is " +
          Digits(recovered.Residual));
      }
    }
    const Status status =
      this->ReadFields<Dim>(where, cached ? *cached : record, cells, spline, patch);
    if (!status)
    {
      return status;
    }
    patch.Id = this->TakeId(group.Id);
    patch.Block = this->Block;
    patch.Geometry = std::move(spline);
    for (vtkIdType cell : copy)
    {
      patch.Cells.push_back(this->FirstCell + cell);
    }
    this->Model.Patches.push_back(std::move(patch));
  }
  return {};
}

template <int Dim>
Status GridReader::ReadFields(const std::string& where, const PatchRecord& record,
  const PatchCells<Dim>& cells, const Spline<Dim>& spline, SplinePatch& patch)
{
  for (vtkDataArray* array : this->Fields)
  {
    SplineField field;
    field.Name = array->GetName();
    Checksum sum;
    bool isZero = true;
    if (Status status = this->CheckField(where, array, cells.Points, sum, isZero); !status)
    {
      return status;
    }
    const auto known = std::find_if(record.Fields.begin(), record.Fields.end(),
      [&](const FieldRecord& candidate) { return candidate.Name == field.Name; });
    if (known == record.Fields.end() && isZero)
    {
      continue; // a field of other patches
    }
    // Coefficients of a rational field belong to its weights: recovered weights, recovered field.
    if (known != record.Fields.end() && known->Cache.Matches(sum) &&
      known->Cache.Rows.rows() == spline.Space->NumFunctions &&
      known->Cache.Rows.cols() == array->GetNumberOfComponents() && known->Cache.Rows.allFinite() &&
      !(patch.Recovered && spline.IsRational()))
    {
      field.Coefficients = known->Cache.Rows;
    }
    else
    {
      RecoveryResult<Dim> recovered =
        RecoverField(FormOf<Dim>(spline.Space, ValuesOf(array, cells.Points),
                       array->GetNumberOfComponents(), -1),
          spline.Weights, this->Threads);
      if (!recovered)
      {
        return { recovered.Status.Code,
          where + ", field '" + field.Name + "': " + recovered.Status.Detail };
      }
      field.Coefficients = std::move(recovered.Value.ControlPoints);
      const double epsilon = array->GetDataType() == VTK_FLOAT
        ? static_cast<double>(std::numeric_limits<float>::epsilon())
        : this->Epsilon();
      if (recovered.Residual > 64.0 * epsilon * recovered.Amplification * recovered.Size)
      {
        this->Warn(where + ", field '" + field.Name +
          "': the values are not those of a spline of the patch's space; they were projected, the "
          "largest distance is " +
          Digits(recovered.Residual));
      }
    }
    patch.Fields.push_back(std::move(field));
  }
  return {};
}

template <int Dim>
Status GridReader::ReadBezier(const CellGroup& group)
{
  const std::string where = PatchName(group.Id);
  PatchCells<Dim> cells;
  cells.Cells = group.Cells;
  if (!this->ElementIds.empty()) // in element order, if there is one
  {
    const auto id = [&](vtkIdType cell)
    { return this->ElementIds[static_cast<std::size_t>(cell)]; };
    std::stable_sort(cells.Cells.begin(), cells.Cells.end(),
      [&](vtkIdType a, vtkIdType b) { return id(a) < id(b); });
    const auto same = std::adjacent_find(cells.Cells.begin(), cells.Cells.end(),
      [&](vtkIdType a, vtkIdType b) { return id(a) == id(b); });
    if (same != cells.Cells.end())
    {
      cells.Cells = group.Cells;
    }
  }
  if (Status status = this->Gather<Dim>(where, nullptr, cells); !status)
  {
    return status;
  }
  // The points are the control points, numbered as in the grid.
  std::vector<vtkIdType> used = cells.Points;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<int> functions;
  functions.reserve(cells.Points.size());
  PointMatrix rows(static_cast<Eigen::Index>(used.size()), 4);
  std::size_t i = 0;
  for (std::size_t e = 0; e < cells.Cells.size(); ++e)
  {
    for (int k = 0; k < NumTensorFunctions<Dim>(cells.Degrees[e]); ++k, ++i)
    {
      const auto at = std::lower_bound(used.begin(), used.end(), cells.Points[i]) - used.begin();
      functions.push_back(static_cast<int>(at));
      static_cast<void>(this->Bezier.ReadPoint({}, cells.Cells[e], cells.Points[i],
        rows.row(at).data())); // has been checked
    }
  }
  Result<SplineSpacePtr<Dim>> space =
    MakeBezierSpace<Dim>(cells.Degrees, functions, static_cast<int>(used.size()));
  if (!space)
  {
    return { space.Status.Code, where + ": " + space.Status.Detail };
  }
  SplinePatch patch;
  Spline<Dim> spline;
  spline.Space = space.Value;
  spline.ControlPoints = rows.leftCols(3);
  if ((rows.col(3).array() != 1.0).any())
  {
    spline.Weights = rows.col(3);
  }
  for (vtkDataArray* array : this->Fields)
  {
    Checksum ignored;
    bool isZero = true;
    if (Status status = this->CheckField(where, array, used, ignored, isZero); !status)
    {
      return status;
    }
    SplineField field{ array->GetName(), ValuesOf(array, used) };
    patch.Fields.push_back(std::move(field));
  }
  patch.Id = this->TakeId(group.Id);
  patch.Block = this->Block;
  patch.Geometry = std::move(spline);
  for (vtkIdType cell : cells.Cells)
  {
    patch.Cells.push_back(this->FirstCell + cell);
  }
  this->Model.Patches.push_back(std::move(patch));
  return {};
}

template Status GridReader::ReadStructured<1>(const CellGroup&, const PatchRecord&);
template Status GridReader::ReadStructured<2>(const CellGroup&, const PatchRecord&);
template Status GridReader::ReadStructured<3>(const CellGroup&, const PatchRecord&);
template Status GridReader::ReadBezier<1>(const CellGroup&);
template Status GridReader::ReadBezier<2>(const CellGroup&);
template Status GridReader::ReadBezier<3>(const CellGroup&);
}
