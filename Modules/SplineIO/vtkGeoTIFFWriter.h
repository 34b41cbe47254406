// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGeoTIFFWriter
 * @brief   heights of spline surfaces on a raster, to GeoTIFF files
 *
 * Input: a spline grid of surfaces whose x and y are their parameters, such as fits of heights, a
 * collection of them, or trimmed faces on them (vtkSplineTrimToPoints). A square cell has the
 * height in its middle, exactly; cells whose middle is outside of all surfaces, or is trimmed away,
 * have none. Corners of cells lie at whole multiples of CellSize from Corner, so that rasters of
 * one cell size fit together. The file is tiled and deflated, by GDAL, and made block by block:
 * memory is that of the surfaces. It takes its place when it is whole.
 *
 * Errors: no surfaces (EmptyInput), one that is no height function (InvalidTopology), no CellSize,
 * an unknown ReferenceSystem, a height of NoData, another ending (InvalidParameter), more cells
 * than MaximumCells (TooLarge), a height beyond single precision (NonFiniteInput), a file that
 * cannot be written (FileError), no GDAL (LibraryError). Warning: a reference system of the data
 * that is unknown is left out.
 */
#ifndef vtkGeoTIFFWriter_h
#define vtkGeoTIFFWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h>      // for knotwork::Status
#include <knotwork/SplineIO/RasterSummary.h> // for knotwork::RasterSummary

#include <string> // for properties

class VTKKNOTWORKSPLINEIO_EXPORT vtkGeoTIFFWriter : public vtkWriter
{
public:
  static vtkGeoTIFFWriter* New();
  vtkTypeMacro(vtkGeoTIFFWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write: .tif or .tiff. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Side of the square cells, unit of the coordinates; must be given. Default 0, valid range >= 0.
   */
  vtkSetClampMacro(CellSize, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(CellSize, double);
  ///@}
  ///@{
  /** Where a corner of cells lies, within the raster or not. Default 0 0. Advanced. Components x,
   * y.
   */
  vtkSetVector2Macro(Corner, double);
  vtkGetVector2Macro(Corner, double);
  ///@}
  ///@{
  /** Number of cells without a height. Default -9999. */
  vtkSetMacro(NoData, double);
  vtkGetMacro(NoData, double);
  ///@}
  ///@{
  /** Whether heights are written in double precision, else in single. Default off. */
  vtkSetMacro(DoublePrecision, bool);
  vtkGetMacro(DoublePrecision, bool);
  vtkBooleanMacro(DoublePrecision, bool);
  ///@}
  ///@{
  /** Coordinate reference system: EPSG:25832, or WKT; empty: that of the data. Default empty. */
  vtkSetMacro(ReferenceSystem, std::string);
  vtkGetMacro(ReferenceSystem, std::string);
  ///@}
  ///@{
  /** Cells that a raster may have; more are an error before memory is taken. Default 1000000000,
   * valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumCells, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumCells, int);
  ///@}

  /** Threads that evaluate, 0: all cores. The file does not depend on it. */
  void UseThreads(int threads) { this->Threads = threads; }
  /** Of the raster that was written last. */
  const knotwork::RasterSummary& GetSummary() const { return this->Summary; }

protected:
  vtkGeoTIFFWriter() = default;
  ~vtkGeoTIFFWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  double CellSize = 0.0;
  double Corner[2] = { 0.0, 0.0 };
  double NoData = -9999.0;
  bool DoublePrecision = false;
  std::string ReferenceSystem;
  int MaximumCells = 1000000000;

private:
  vtkGeoTIFFWriter(const vtkGeoTIFFWriter&) = delete;
  void operator=(const vtkGeoTIFFWriter&) = delete;
  knotwork::Status WriteRaster();

  int Threads = 0;
  knotwork::RasterSummary Summary;
};
#endif
