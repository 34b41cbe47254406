// SPDX-License-Identifier: BSD-3-Clause
#include "RasterPoints.h"

#include "GeoFiles.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr std::uint64_t MostCellsAtOnce = 100000000;
constexpr std::uint64_t MostCells = 1000000000000;
constexpr int CellsOfBand = 1 << 20;

std::uint64_t CellsOf(const RasterGrid& grid)
{
  return static_cast<std::uint64_t>(grid.Columns) * static_cast<std::uint64_t>(grid.Rows);
}

/// Middle of a cell.
RealArray<2> MiddleOf(const RasterGrid& grid, int column, int row)
{
  const auto& t = grid.Transform;
  const double c = column + 0.5;
  const double r = row + 0.5;
  return { t[0] + c * t[1] + r * t[2], t[3] + c * t[4] + r * t[5] };
}

/// Reads a raster from its first row to its last.
class RowReader
{
public:
  explicit RowReader(RasterSource& source) : Source(source)
  {
    const int columns = source.Grid.Columns;
    const int most = std::max(1, CellsOfBand / columns);
    this->RowsAtOnce = std::min({ std::max(1, source.RowsOfBlock), most, source.Grid.Rows });
  }

  bool IsDone() const { return this->Row == this->Source.Grid.Rows; }
  int NumRowsDone() const { return this->Row; }

  /// Calls take(x, y, z) for the cells with data of the next rows.
  template <typename Take>
  Status Next(const Take& take)
  {
    const RasterGrid& grid = this->Source.Grid;
    const int rows = std::min(this->RowsAtOnce, grid.Rows - this->Row);
    this->Values.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(grid.Columns));
    if (Status status = this->Source.Read(this->Row, rows, this->Values.data()); !status)
    {
      return status;
    }
    const double* value = this->Values.data();
    for (int row = this->Row; row < this->Row + rows; ++row)
    {
      for (int column = 0; column < grid.Columns; ++column, ++value)
      {
        if (!std::isnan(*value))
        {
          const RealArray<2> place = MiddleOf(grid, column, row);
          take(place[0], place[1], *value);
        }
      }
    }
    this->Row += rows;
    return {};
  }

private:
  RasterSource& Source;
  int RowsAtOnce = 1;
  int Row = 0;
  std::vector<double> Values;
};

class RasterStream : public PointStream
{
public:
  explicit RasterStream(std::shared_ptr<RasterSource> source)
    : Source(std::move(source)), Rows(*this->Source)
  {
    const RasterGrid& grid = this->Source->Grid;
    this->Ending = ".ply";
    this->RecordBytes = 3 * sizeof(double);
    this->MostPoints = CellsOf(grid);
    this->ReferenceSystem = grid.ReferenceSystem;
    this->LeftOut = this->Source->LeftOut;
    this->HasBox = true;
    this->Lower.fill(HUGE_VAL);
    this->Upper.fill(-HUGE_VAL);
    for (const int column : { 0, grid.Columns - 1 })
    {
      for (const int row : { 0, grid.Rows - 1 })
      {
        const RealArray<2> corner = MiddleOf(grid, column, row);
        for (std::size_t d = 0; d < 2; ++d)
        {
          this->Lower[d] = std::min(this->Lower[d], corner[d]);
          this->Upper[d] = std::max(this->Upper[d], corner[d]);
        }
      }
    }
  }

  Status Next(PointBlock& block) override
  {
    block.Positions.clear();
    while (block.Positions.empty() && !this->Rows.IsDone())
    {
      const Status status = this->Rows.Next(
        [&block](double x, double y, double z) {
          block.Positions.insert(block.Positions.end(), { x, y, z });
        });
      if (!status)
      {
        return status;
      }
    }
    block.Count = block.Positions.size() / 3;
    block.Records = reinterpret_cast<const char*>(block.Positions.data());
    return {};
  }

  std::string Head(const PointSummary& summary) const override
  {
    return HeadOfNumbers({}, summary.Count);
  }

private:
  std::shared_ptr<RasterSource> Source;
  RowReader Rows;
};

Status TooManyCells(const std::string& file, const RasterGrid& grid, const std::string& remedy)
{
  return { ErrorCode::TooLarge,
    "'" + file + "' has " + std::to_string(grid.Columns) + " x " + std::to_string(grid.Rows) +
      " cells, more than " + remedy };
}
}

bool IsRasterEnding(const std::string& ending)
{
  return ending == ".tif" || ending == ".tiff";
}

Result<RasterPoints> ReadRasterPoints(const std::string& file, const ProgressCallback& progress)
{
  auto source = OpenRaster(file);
  if (!source)
  {
    return source.Status;
  }
  const RasterGrid& grid = source.Value->Grid;
  const std::uint64_t cells = CellsOf(grid);
  if (cells > MostCellsAtOnce)
  {
    return TooManyCells(file, grid,
      std::to_string(MostCellsAtOnce) +
        " at once; divide it (knotwork tiles), or take a part of it (gdal_translate -srcwin)");
  }
  RasterPoints found;
  found.Points.LeftOut = source.Value->LeftOut;
  found.Points.ReferenceSystem = grid.ReferenceSystem;
  PointMatrix& points = found.Points.Points;
  points.resize(static_cast<Eigen::Index>(cells), 3);
  double* to = points.data();
  RowReader rows(*source.Value);
  while (!rows.IsDone())
  {
    const Status status = rows.Next(
      [&to](double x, double y, double z)
      {
        *to++ = x;
        *to++ = y;
        *to++ = z;
      });
    if (!status)
    {
      return status;
    }
    if (progress && !progress(static_cast<double>(rows.NumRowsDone()) / grid.Rows))
    {
      return { ErrorCode::Aborted, "" };
    }
  }
  const auto count = static_cast<std::uint64_t>(to - points.data()) / 3;
  if (count == 0)
  {
    return { ErrorCode::EmptyInput, "'" + file + "' has no cell with data; choose another" };
  }
  points.conservativeResize(static_cast<Eigen::Index>(count), 3);
  found.NumWithoutData = cells - count;
  return found;
}

Result<std::shared_ptr<PointStream>> OpenRasterStream(const std::string& file)
{
  auto source = OpenRaster(file);
  if (!source)
  {
    return source.Status;
  }
  const RasterGrid& grid = source.Value->Grid;
  if (CellsOf(grid) > MostCells)
  {
    return TooManyCells(file, grid,
      std::to_string(MostCells) +
        "; its header is damaged, or take a part of it (gdal_translate -srcwin)");
  }
  return std::shared_ptr<PointStream>(std::make_shared<RasterStream>(source.Value));
}
}
