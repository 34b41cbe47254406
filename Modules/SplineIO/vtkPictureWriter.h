// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPictureWriter
 * @brief   PNG pictures of splines, meshes, points and collections of them
 *
 * Splines are tessellated, with exact normals; solids show their outer surface, quadratic and
 * Lagrange cells are subdivided. Lines of two widths show elements (of splines, or cells of meshes)
 * and patches (also CAD faces, and what boundaries and edges of more than 45 degrees enclose).
 *
 * The picture is drawn by Mesa's software in a process of its own: no X display, no graphics card
 * and no setting of the caller matters, and the same data give the same bytes on one machine.
 *
 * Errors: no points (EmptyInput), an array, a direction or a colour that there is not
 * (InvalidParameter), those of decoding splines, drawing that is not installed (LibraryError).
 */
#ifndef vtkPictureWriter_h
#define vtkPictureWriter_h
#include "vtkKnotworkSplineIOModule.h" // for export macro
#include "vtkWriter.h"
#include <knotwork/SplineCore/Status.h> // for knotwork::Status

#include <string> // for properties

class VTKKNOTWORKSPLINEIO_EXPORT vtkPictureWriter : public vtkWriter
{
public:
  static vtkPictureWriter* New();
  vtkTypeMacro(vtkPictureWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum EdgeLines
  {
    AUTO,     ///< "Auto"
    NONE,     ///< "None"
    PATCHES,  ///< "Patches"
    ELEMENTS, ///< "Elements"
    CELLS     ///< "Cells"
  };

  ///@{
  /** The file to write: .png. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Width and height in pixels. Default 1200 900. Components width, height. */
  vtkSetVector2Macro(Size, int);
  vtkGetVector2Macro(Size, int);
  ///@}
  ///@{
  /** Point or cell array to colour by, with a legend; empty: one colour. Default empty. */
  vtkSetMacro(Array, std::string);
  vtkGetMacro(Array, std::string);
  ///@}
  ///@{
  /** Component of Array, from 0; -1: the length of its vectors. Default -1, valid range [-1, 100].
   */
  vtkSetClampMacro(Component, int, -1, 100);
  vtkGetMacro(Component, int);
  ///@}
  ///@{
  /** Where the eye is: +x, -x, +y, -y, +z, -z, iso (a corner), three numbers such as 1,-2,0.5, or
   * auto: above the plane of flat data, else iso. Default auto. */
  vtkSetMacro(Direction, std::string);
  vtkGetMacro(Direction, std::string);
  ///@}
  ///@{
  /** Lines on surfaces: auto: elements as long as there are at most 5000, else patches; none; edges
   * of patches and faces, and sharp edges of meshes; these and edges of elements, or of cells of
   * meshes; edges of all that is drawn. Default AUTO. */
  vtkSetClampMacro(Edges, int, AUTO, CELLS);
  vtkGetMacro(Edges, int);
  ///@}
  ///@{
  /** Colour of what no array colours: a name of CSS or #rrggbb. Default lightsteelblue. */
  vtkSetMacro(Color, std::string);
  vtkGetMacro(Color, std::string);
  ///@}
  ///@{
  /** Colour behind it: a name of CSS or #rrggbb. Default white. */
  vtkSetMacro(Background, std::string);
  vtkGetMacro(Background, std::string);
  ///@}
  ///@{
  /** Distance of what is drawn from splines, a share of the size of each block. Default 0.0005,
   * valid range [1e-06, 0.1]. Advanced. */
  vtkSetClampMacro(ChordalTolerance, double, 1e-6, 0.1);
  vtkGetMacro(ChordalTolerance, double);
  ///@}

protected:
  vtkPictureWriter() = default;
  ~vtkPictureWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  int Size[2] = { 1200, 900 };
  std::string Array;
  int Component = -1;
  std::string Direction = "auto";
  int Edges = AUTO;
  std::string Color = "lightsteelblue";
  std::string Background = "white";
  double ChordalTolerance = 5e-4;

private:
  vtkPictureWriter(const vtkPictureWriter&) = delete;
  void operator=(const vtkPictureWriter&) = delete;
  knotwork::Status Draw();
};
#endif
