// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADHexahedra
 * @brief   conforming hexahedra in the solids of a CAD part
 *
 * Reads a STEP, IGES or BREP file. Every solid is swept: from faces (its source) along linking
 * faces, which are grids, to all others (its target). What is swept from where is found by itself,
 * such that faces between solids have one mesh. Where a solid cannot be swept as it is, up to
 * MaximumCuts cuts are looked for that leave solids which can; numbers of solids and faces are
 * those behind the cuts then. Every hexahedron is certified.
 *
 * Output 0 (vtkUnstructuredGrid): the hexahedra, with the cell arrays SolidId (Body of
 * vtkCADReader), Layer (from the source of its solid), ScaledJacobian and Verdict (of
 * vtkJacobianValidator), and the point arrays CADEntityDimension (0 on a vertex, 1 on an edge, 2 on
 * a face, 3 inside) and CADEntityId (number of the vertex or edge, FaceId of the face, SolidId).
 * With BoundaryCells also quadrilaterals on the faces, counterclockwise as seen from outside of
 * their solid (the first of two), with the values of their hexahedron, and the cell array
 * CADFaceId: FaceId of vtkCADReader, the smaller one of a shared face; -1 of hexahedra.
 *
 * Output 1 (vtkTable): one row with Hexahedra, Points, Solids, PaddedHexahedra (in layers
 * under surfaces that go on smoothly at a rim), Verdict, ValidCells, ReversedCells,
 * InvalidCells, UndecidedCells, MinJacobianLower, LeastScaledJacobian, Volume, Diagonal and Cuts,
 * the operations of vtkCADModifier that were made, one a line.
 *
 * Output 2 (vtkTable): a row a solid with SolidId, SourceFaces, TargetFaces and LinkingFaces
 * (FaceId of vtkCADReader, with blanks between), Layers, Hexahedra and LeastScaledJacobian.
 *
 * Errors: those of knotwork::CADPieces::Read, FindSweepCuts and MeshHexes.
 */
#ifndef vtkCADHexahedra_h
#define vtkCADHexahedra_h
#include "vtkKnotworkCADMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADMESHING_EXPORT vtkCADHexahedra : public vtkSplineAlgorithm
{
public:
  static vtkCADHexahedra* New();
  vtkTypeMacro(vtkCADHexahedra, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Units
  {
    Micrometre = 0,
    Millimetre,
    Centimetre,
    Metre,
    Inch,
    Foot
  };

  ///@{
  /** The part: .step, .stp, .iges, .igs or .brep. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}
  ///@{
  /** Unit of lengths in the mesh and in properties, one of Units. Default Millimetre. */
  vtkSetClampMacro(Unit, int, Micrometre, Foot);
  vtkGetMacro(Unit, int);
  ///@}
  ///@{
  /** Length of the hexahedra's sides; 0: a twentieth of the part's diagonal. Default 0, valid range
   * >= 0. */
  vtkSetClampMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}
  ///@{
  /** Degrees that an edge or a surface turns along a side of a hexahedron. Default 30, valid range
   * [1, 90]. */
  vtkSetClampMacro(Curvature, double, 1.0, 90.0);
  vtkGetMacro(Curvature, double);
  ///@}
  ///@{
  /** Segments of every edge; their number is always even. Default 2, valid range [1, 100000]. */
  vtkSetClampMacro(MinimumDivisions, int, 1, 100000);
  vtkGetMacro(MinimumDivisions, int);
  ///@}
  ///@{
  /** Cuts through all solids, at most, that are made where one of them cannot be swept: along faces
   * at concave edges and planes through axes. 0: none. Default 3, valid range [0, 4]. */
  vtkSetClampMacro(MaximumCuts, int, 0, 4);
  vtkGetMacro(MaximumCuts, int);
  ///@}
  ///@{
  /** Whether quadrilaterals of the part's faces are cells, too, behind the hexahedra: what solvers
   * know loads and supports by. Default off. */
  vtkSetMacro(BoundaryCells, bool);
  vtkGetMacro(BoundaryCells, bool);
  vtkBooleanMacro(BoundaryCells, bool);
  ///@}
  ///@{
  /** More hexahedra, or quadrilaterals of a face, are an error. Default 1000000, valid range >= 1.
   * Advanced. */
  vtkSetClampMacro(MaximumHexahedra, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumHexahedra, int);
  ///@}

protected:
  vtkCADHexahedra();
  ~vtkCADHexahedra() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkCADHexahedra(const vtkCADHexahedra&) = delete;
  void operator=(const vtkCADHexahedra&) = delete;

  char* FileName = nullptr;
  int Unit = Millimetre;
  double EdgeLength = 0.0;
  double Curvature = 30.0;
  int MinimumDivisions = 2;
  int MaximumCuts = 3;
  bool BoundaryCells = false;
  int MaximumHexahedra = 1000000;
};
#endif
