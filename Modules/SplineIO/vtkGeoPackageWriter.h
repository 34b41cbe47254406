// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkGeoPackageWriter
 * @brief   lines, such as contours, to GeoPackage files
 *
 * Input: vtkPolyData; its polylines become one layer (LINESTRING Z, named as the file without its
 * ending), cell arrays of one number become attributes: `Level` is `elevation`, other names are
 * written as `patch_id`. The coordinate reference system is ReferenceSystem, else the field data
 * string `CoordinateReferenceSystem`; without one the layer has none. Written by GDAL. The file
 * takes its place when it is whole.
 *
 * Errors: no lines (EmptyInput), a coordinate that is not finite (NonFiniteInput), an unknown
 * ReferenceSystem, another ending (InvalidParameter), a file that cannot be written (FileError), no
 * GDAL (LibraryError). Warnings: a reference system of the data that is unknown, points and
 * polygons beside the lines, arrays of several components are left out.
 */
#ifndef vtkGeoPackageWriter_h
#define vtkGeoPackageWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h> // for knotwork::Status

#include <string> // for properties

class VTKKNOTWORKSPLINEIO_EXPORT vtkGeoPackageWriter : public vtkWriter
{
public:
  static vtkGeoPackageWriter* New();
  vtkTypeMacro(vtkGeoPackageWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to write: .gpkg. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Coordinate reference system: EPSG:25832, or WKT; empty: that of the data. Default empty. */
  vtkSetMacro(ReferenceSystem, std::string);
  vtkGetMacro(ReferenceSystem, std::string);
  ///@}

protected:
  vtkGeoPackageWriter() = default;
  ~vtkGeoPackageWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  std::string ReferenceSystem;

private:
  vtkGeoPackageWriter(const vtkGeoPackageWriter&) = delete;
  void operator=(const vtkGeoPackageWriter&) = delete;
  knotwork::Status WriteLines();
};
#endif
