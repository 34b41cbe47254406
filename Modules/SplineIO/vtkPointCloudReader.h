// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPointCloudReader
 * @brief   points and meshes from text, g2, LAS, GeoTIFF, OFF, OBJ, PLY, STL and VTK files
 *
 * The ending says the format: .xyz, .txt and .csv have a point a line (PointText.h), .g2 point
 * clouds of class 400, .las laser scans (LasFile.h), .tif rasters of heights (a point in the middle
 * of every cell that has data), .ply vertices with all properties and faces,
 * .off, .obj and .stl meshes (MeshFiles.h), .vtp what VTK wrote. Output: vtkPolyData with double
 * coordinates, a vertex a point where there are no faces and lines, further columns and properties
 * as point arrays, `CloudId` where there are several clouds, `Color` where they have one, `TCoords`
 * where every point of an OBJ mesh has texture coordinates, and the field data string
 * `CoordinateReferenceSystem` where a LAS or GeoTIFF file has one; of a GeoTIFF the field data
 * number `CellsWithoutData`. Errors: a file that is missing or cannot be read (EmptyInput), and
 * those of the formats, with the place in the file.
 */
#ifndef vtkPointCloudReader_h
#define vtkPointCloudReader_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKSPLINEIO_EXPORT vtkPointCloudReader : public vtkSplineAlgorithm
{
public:
  static vtkPointCloudReader* New();
  vtkTypeMacro(vtkPointCloudReader, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The file to read: .xyz, .txt, .csv, .g2, .las, .tif, .off, .obj, .ply, .stl or .vtp. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /** 1 when the ending and the beginning of a file are those of points, else 0; the file may still
   * be damaged. */
  int CanReadFile(const char* fileName);

protected:
  vtkPointCloudReader();
  ~vtkPointCloudReader() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  char* FileName = nullptr;

private:
  vtkPointCloudReader(const vtkPointCloudReader&) = delete;
  void operator=(const vtkPointCloudReader&) = delete;
};
#endif
