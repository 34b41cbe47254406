// SPDX-License-Identifier: BSD-3-Clause
#include "HeightRaster.h"

#include "GeoFiles.h"
#include <knotwork/SplineCore/BezierForm.h>
#include <knotwork/SplineCore/HeightField.h>
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/TrimmedRegion.h>
#include <knotwork/SplineGrid/SplineBlocks.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double Slack = 1e-9; // of a cell: middles on the edge of a domain are in it

/// A surface over its domain, or the part of it that loops enclose.
struct HeightPatch
{
  BezierForm<2> Form;
  ParametricBox<2> Box;
  TrimmedRegion Region;
};

Status AddPatch(
  const Spline<2>& surface, const std::string& name, int threads, std::vector<HeightPatch>& patches)
{
  HeightPatch patch;
  patch.Form = MakeBezierForm(surface, threads);
  if (!IsHeightField(patch.Form))
  {
    return { ErrorCode::InvalidTopology,
      name +
        " is no height function: a raster needs polynomial surfaces whose x and y are their "
        "parameters, as fits of heights are" };
  }
  patch.Box = patch.Form.Space->Domain();
  patches.push_back(std::move(patch));
  return {};
}

bool IsTrimmed(vtkDataObject* splines)
{
  for (const auto& [block, grid] : GridsByBlock(splines))
  {
    vtkDataArray* curves = grid->GetCellData()->GetArray("TrimmingCurves");
    if (curves && curves->GetRange()[1] > 0.0)
    {
      return true;
    }
  }
  return false;
}

Result<std::vector<HeightPatch>> PatchesOf(vtkDataObject* splines, int threads)
{
  std::vector<HeightPatch> patches;
  Status status;
  if (IsTrimmed(splines))
  {
    auto model = DecodeTrimmedModel(splines, nullptr);
    status = model.Status;
    for (std::size_t f = 0; status && f < model->Faces.size(); ++f)
    {
      const TrimmedFace& face = model->Faces[f];
      status = AddPatch(face.Surface, "face " + std::to_string(f), threads, patches);
      auto region = status ? TrimmedRegion::Create(face.Loops) : status;
      status = region.Status;
      if (status)
      {
        patches.back().Region = std::move(region.Value);
      }
    }
    return status ? Result<std::vector<HeightPatch>>(std::move(patches)) : status;
  }
  auto model = DecodeSplineModel(splines, threads);
  status = model.Status;
  for (std::size_t p = 0; status && p < model->Patches.size(); ++p)
  {
    const std::string name = "patch " + std::to_string(model->Patches[p].Id);
    const auto* surface = std::get_if<Spline<2>>(&model->Patches[p].Geometry);
    status = surface ? AddPatch(*surface, name, threads, patches)
                     : Status(ErrorCode::DimensionMismatch,
                         name + " is no surface; a raster has heights of surfaces");
    model->Patches[p].Geometry = {}; // its Bezier form is enough
  }
  return status ? Result<std::vector<HeightPatch>>(std::move(patches)) : status;
}

/// Cells [Begin, End) of rows or columns.
struct CellRange
{
  int Begin = 0;
  int End = 0;

  int Count() const { return this->End - this->Begin; }
};

class RasterMaker
{
public:
  RasterMaker(const std::vector<HeightPatch>& patches, const HeightRasterParams& params)
    : Patches(patches), Params(params)
  {
  }

  /// Where the raster lies.
  Status FindGrid()
  {
    const double size = this->Params.CellSize;
    if (!(size > 0.0) || !std::isfinite(size))
    {
      return { ErrorCode::InvalidParameter,
        "the size of cells is " + Digits(size) + "; give one above 0" };
    }
    RealArray<2> lower{ HUGE_VAL, HUGE_VAL };
    RealArray<2> upper{ -HUGE_VAL, -HUGE_VAL };
    for (const HeightPatch& patch : this->Patches)
    {
      for (std::size_t d = 0; d < 2; ++d)
      {
        lower[d] = std::min(lower[d], patch.Box.Lower[d]);
        upper[d] = std::max(upper[d], patch.Box.Upper[d]);
      }
    }
    RealArray<2> count{};
    for (std::size_t d = 0; d < 2; ++d)
    {
      const double corner = this->Params.Corner[d];
      const double first = std::floor((lower[d] - corner) / size + Slack);
      const double last = std::max(first + 1.0, std::ceil((upper[d] - corner) / size - Slack));
      count[d] = last - first;
      this->Summary.Lower[d] = corner + first * size;
      this->Summary.Upper[d] = corner + last * size;
    }
    constexpr double mostOfSide = std::numeric_limits<int>::max() / 2;
    if (!(count[0] * count[1] <= static_cast<double>(this->Params.MaxCells)) ||
      count[0] > mostOfSide || count[1] > mostOfSide)
    {
      return { ErrorCode::TooLarge,
        "cells of " + Digits(size) + " would be " + Digits(count[0]) + " x " + Digits(count[1]) +
          ", more than MaximumCells = " + std::to_string(this->Params.MaxCells) +
          "; choose a larger CellSize" };
    }
    this->Summary.Columns = static_cast<int>(count[0]);
    this->Summary.Rows = static_cast<int>(count[1]);
    this->Summary.Lowest = HUGE_VAL;
    this->Summary.Highest = -HUGE_VAL;
    return {};
  }

  Status Write(const std::string& file)
  {
    RasterGrid grid;
    grid.Columns = this->Summary.Columns;
    grid.Rows = this->Summary.Rows;
    const double size = this->Params.CellSize;
    grid.Transform = { this->Summary.Lower[0], size, 0.0, this->Summary.Upper[1], 0.0, -size };
    grid.ReferenceSystem = this->Params.ReferenceSystem;
    auto target = CreateRaster(file, grid, { this->Params.IsDouble, this->Params.NoData });
    if (!target)
    {
      return target.Status;
    }
    constexpr int side = RasterTarget::BlockSide;
    for (int row = 0; row < grid.Rows; row += side)
    {
      const CellRange rows{ row, std::min(row + side, grid.Rows) };
      for (int column = 0; column < grid.Columns; column += side)
      {
        const CellRange columns{ column, std::min(column + side, grid.Columns) };
        Status status = this->FillBlock(columns, rows);
        status = status
          ? target.Value->Write(column, row, columns.Count(), rows.Count(), this->Values.data())
          : status;
        if (!status)
        {
          return status;
        }
      }
      if (this->Params.Progress &&
        !this->Params.Progress(static_cast<double>(rows.End) / grid.Rows))
      {
        return { ErrorCode::Aborted, "" };
      }
    }
    if (this->Summary.NumWithData == 0)
    {
      return { ErrorCode::EmptyInput,
        "no cell has its middle on the surface; choose a smaller CellSize" };
    }
    return target.Value->Finish();
  }

  RasterSummary Summary;

private:
  double MiddleX(int column) const
  {
    return this->Summary.Lower[0] + (column + 0.5) * this->Params.CellSize;
  }
  double MiddleY(int row) const
  {
    return this->Summary.Upper[1] - (row + 0.5) * this->Params.CellSize;
  }

  /// Columns whose middle is in an interval, within some.
  CellRange ColumnsIn(double lower, double upper, const CellRange& within) const
  {
    const double size = this->Params.CellSize;
    const double begin = std::ceil((lower - this->Summary.Lower[0]) / size - 0.5 - Slack);
    const double end = std::floor((upper - this->Summary.Lower[0]) / size - 0.5 + Slack) + 1.0;
    return Clamped(begin, end, within);
  }
  /// Rows, which count from the north.
  CellRange RowsIn(double lower, double upper, const CellRange& within) const
  {
    const double size = this->Params.CellSize;
    const double begin = std::ceil((this->Summary.Upper[1] - upper) / size - 0.5 - Slack);
    const double end = std::floor((this->Summary.Upper[1] - lower) / size - 0.5 + Slack) + 1.0;
    return Clamped(begin, end, within);
  }
  static CellRange Clamped(double begin, double end, const CellRange& within)
  {
    const auto clamp = [&within](double x)
    { return static_cast<int>(std::clamp<double>(x, within.Begin, within.End)); };
    const int first = clamp(begin);
    return { first, std::max(first, clamp(end)) };
  }

  Status FillBlock(const CellRange& columns, const CellRange& rows)
  {
    const std::size_t cells =
      static_cast<std::size_t>(columns.Count()) * static_cast<std::size_t>(rows.Count());
    this->Values.assign(cells, std::numeric_limits<double>::quiet_NaN());
    for (const HeightPatch& patch : this->Patches)
    {
      const CellRange c = this->ColumnsIn(patch.Box.Lower[0], patch.Box.Upper[0], columns);
      const CellRange r = this->RowsIn(patch.Box.Lower[1], patch.Box.Upper[1], rows);
      this->Places.clear();
      this->Cells.clear();
      this->Collect(patch, c, r, columns, rows);
      if (Status status = this->Evaluate(patch); !status)
      {
        return status;
      }
    }
    return this->Store();
  }

  /// Cells of a patch that have no height yet: squares of them at once where the loops allow it.
  void Collect(const HeightPatch& patch, const CellRange& columns, const CellRange& rows,
    const CellRange& blockColumns, const CellRange& blockRows)
  {
    constexpr int side = 16;
    for (int row = rows.Begin; row < rows.End; row += side)
    {
      const CellRange r{ row, std::min(row + side, rows.End) };
      for (int column = columns.Begin; column < columns.End; column += side)
      {
        const CellRange c{ column, std::min(column + side, columns.End) };
        const RegionPlace place = patch.Region.IsWholePlane()
          ? RegionPlace::Inside
          : patch.Region.Classify({ this->MiddleX(c.Begin), this->MiddleY(r.End - 1) },
              { this->MiddleX(c.End - 1), this->MiddleY(r.Begin) });
        if (place != RegionPlace::Outside)
        {
          this->CollectSquare(patch, c, r, place == RegionPlace::Inside, blockColumns.Begin,
            blockRows.Begin, blockColumns.Count());
        }
      }
    }
  }

  void CollectSquare(const HeightPatch& patch, const CellRange& columns, const CellRange& rows,
    bool isInside, int firstColumn, int firstRow, int width)
  {
    for (int row = rows.Begin; row < rows.End; ++row)
    {
      for (int column = columns.Begin; column < columns.End; ++column)
      {
        const std::size_t cell =
          static_cast<std::size_t>(row - firstRow) * static_cast<std::size_t>(width) +
          static_cast<std::size_t>(column - firstColumn);
        const RealArray<2> middle{ this->MiddleX(column), this->MiddleY(row) };
        if (std::isnan(this->Values[cell]) &&
          (isInside || patch.Region.Contains(middle) != RegionPlace::Outside))
        {
          for (std::size_t d = 0; d < 2; ++d)
          {
            this->Places.push_back(std::clamp(middle[d], patch.Box.Lower[d], patch.Box.Upper[d]));
          }
          this->Cells.push_back(cell);
        }
      }
    }
  }

  Status Evaluate(const HeightPatch& patch)
  {
    if (this->Cells.empty())
    {
      return {};
    }
    const PointMatrix places = Eigen::Map<const PointMatrix>(
      this->Places.data(), static_cast<Eigen::Index>(this->Cells.size()), 2);
    EvaluationParams params;
    params.Threads = this->Params.Threads;
    const Status status = EvaluateParameters<2>(patch.Form, places, params, this->Batch);
    for (std::size_t i = 0; status && i < this->Cells.size(); ++i)
    {
      this->Values[this->Cells[i]] = this->Batch.Values(static_cast<Eigen::Index>(i), 2);
    }
    return status;
  }

  /// Numbers as the file has them.
  Status Store()
  {
    const bool isDouble = this->Params.IsDouble;
    const double noData = isDouble ? this->Params.NoData : static_cast<float>(this->Params.NoData);
    for (double& value : this->Values)
    {
      if (std::isnan(value))
      {
        value = noData;
        continue;
      }
      ++this->Summary.NumWithData;
      this->Summary.Lowest = std::min(this->Summary.Lowest, value);
      this->Summary.Highest = std::max(this->Summary.Highest, value);
      const double stored = isDouble ? value : static_cast<float>(value);
      if (!std::isfinite(stored))
      {
        return { ErrorCode::NonFiniteInput,
          "the height " + Digits(value) +
            " is too large for single precision; turn DoublePrecision on" };
      }
      if (stored == noData)
      {
        return { ErrorCode::InvalidParameter,
          "there is a height of NoData = " + Digits(noData) + "; choose another number" };
      }
    }
    return {};
  }

  const std::vector<HeightPatch>& Patches;
  const HeightRasterParams& Params;
  std::vector<double> Values;     ///< of a block
  std::vector<double> Places;     ///< of cells that are evaluated
  std::vector<std::size_t> Cells; ///< in the block
  EvaluationBatch Batch;
};
}

Result<RasterSummary> WriteHeightRaster(
  vtkDataObject* splines, const std::string& file, const HeightRasterParams& params)
{
  const auto patches = PatchesOf(splines, params.Threads);
  if (!patches)
  {
    return patches.Status;
  }
  if (patches->empty())
  {
    return { ErrorCode::EmptyInput, "there are no surfaces; give fitted ones" };
  }
  RasterMaker maker(patches.Value, params);
  Status status = maker.FindGrid();
  status = status ? maker.Write(file) : status;
  return status ? Result<RasterSummary>(maker.Summary) : status;
}
}
