// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkCADQuads
 * @brief   conforming quadrilaterals on the faces of a CAD part
 *
 * Reads a STEP, IGES or BREP file. Every edge of the part is divided once, so that the mesh
 * conforms across all faces, also those of solids that touch face to face. Rectangles, rings, discs
 * and polygons become grids, other faces are meshed with triangles that are joined and divided to
 * quadrilaterals; inner points are moved on the surface.
 *
 * Output 0 (vtkPolyData): the quadrilaterals, counterclockwise about the normal that leads out of
 * their solid (the first of two), with the cell arrays CADFaceId (FaceId of vtkCADReader, the
 * smaller of two), SolidId (Body of vtkCADReader), SecondSolidId (at the other side, -1: none),
 * ScaledJacobian and,
 * where faces are in composites (CADComposite.h), CompositeId (from 0, -1 in none; the composite is
 * meshed as one face, with the FaceId of its first), and the point
 * arrays CADEntityDimension (0 on a vertex, 1 on an edge, 2 on a face) and CADEntityId (number of
 * the vertex or edge, FaceId of the face).
 *
 * Output 1 (vtkTable): one row with Quads, Points, Faces, MappedFaces, UnstructuredFaces, Edges,
 * Solids, LeastScaledJacobian, ExtraordinaryPoints, EulerNumber, Closed, Distance and Diagonal.
 *
 * Output 2 (vtkTable): a row a face with FaceId, SecondFaceId (of the same face in the other
 * solid, -1: none), SolidId, SecondSolidId, Name, Composite, JoinedFaces
 * (faces of the file in a composite's face, 0: it is one of these), Mapped, Quads,
 * ExtraordinaryPoints, LeastScaledJacobian and Distance.
 *
 * Errors: those of knotwork::CADTopology::Read and MeshQuads.
 */
#ifndef vtkCADQuads_h
#define vtkCADQuads_h
#include "vtkKnotworkCADMeshingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

class VTKKNOTWORKCADMESHING_EXPORT vtkCADQuads : public vtkSplineAlgorithm
{
public:
  static vtkCADQuads* New();
  vtkTypeMacro(vtkCADQuads, vtkSplineAlgorithm);
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
  enum Methods
  {
    AUTOMATIC = 0,
    MAPPED,
    UNSTRUCTURED
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
  /** How faces are meshed, one of Methods: AUTOMATIC, grids in rectangles, rings, discs and
   * polygons whose sides have numbers of segments that allow it, else unstructured; MAPPED, grids
   * on all faces, an error names one that has none; UNSTRUCTURED, no grids. Default AUTOMATIC. */
  vtkSetClampMacro(Method, int, AUTOMATIC, UNSTRUCTURED);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** Length of the quadrilaterals' sides; 0: a twentieth of the part's diagonal. Default 0, valid
   * range >= 0. */
  vtkSetClampMacro(EdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(EdgeLength, double);
  ///@}
  ///@{
  /** Degrees that an edge or a surface turns along a side of a quadrilateral. Default 30, valid
   * range [1, 90]. */
  vtkSetClampMacro(Curvature, double, 1.0, 90.0);
  vtkGetMacro(Curvature, double);
  ///@}
  ///@{
  /** Segments of every edge; their number is always even. Default 2, valid range [1, 100000]. */
  vtkSetClampMacro(MinimumDivisions, int, 1, 100000);
  vtkGetMacro(MinimumDivisions, int);
  ///@}
  ///@{
  /** Whether every solid has points and quadrilaterals of its own, of the faces that it shares,
   * too: closed surfaces, as CAD Fit takes them. Else shared faces are meshed once, and three faces
   * may meet at an edge. Default off. */
  vtkSetMacro(SolidsApart, bool);
  vtkGetMacro(SolidsApart, bool);
  vtkBooleanMacro(SolidsApart, bool);
  ///@}
  ///@{
  /** More quadrilaterals are an error. Default 1000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumQuads, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumQuads, int);
  ///@}

protected:
  vtkCADQuads();
  ~vtkCADQuads() override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkCADQuads(const vtkCADQuads&) = delete;
  void operator=(const vtkCADQuads&) = delete;

  char* FileName = nullptr;
  int Unit = Millimetre;
  int Method = AUTOMATIC;
  double EdgeLength = 0.0;
  double Curvature = 30.0;
  int MinimumDivisions = 2;
  int MaximumQuads = 1000000;
  bool SolidsApart = false;
};
#endif
