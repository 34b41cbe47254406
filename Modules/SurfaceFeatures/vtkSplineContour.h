// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineContour
 * @brief   iso-curves of a spline surface to a guaranteed tolerance
 *
 * Contours of the height of a spline surface, or of a field of the spline grid. Everywhere on a
 * contour, not at its points alone, the value is proved to be within the tolerance of the level
 * (straight in the parameter plane between points), and contours have the components and the ends
 * that the surface's have: loops smaller than an element are found, branches near a saddle do not
 * touch. Contours are closed where the surface's are, also over seams of closed surfaces; they end
 * on the boundary of patches and at jumps of the value. What lies on the level belongs to the upper
 * set.
 *
 * Output 0 are polylines with the cell arrays Level, ComponentId, Closed, PatchId, MaxError and the
 * point arrays Value, ElementId, UV. Output 1 are, with Curves on, the same as cubic spline curves
 * (a spline grid, a patch a component) within the same tolerance. Output 2 is a table of the
 * levels. Output 3 are the parts of the surface where a limit stopped the division of elements
 * before the contour was decided; there is a warning then.
 *
 * The patches of a vtkPartitionedDataSetCollection are contoured together. Of several processes
 * each contours the patches that it has, at levels and with tolerances of the whole; polylines and
 * what stays undecided are pieces, curves and table stand in the first process.
 *
 * The module's page has methods, conventions, limits, errors.
 */
#ifndef vtkSplineContour_h
#define vtkSplineContour_h
#include "vtkKnotworkSurfaceFeaturesModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <memory> // for Prepared
#include <string> // for FieldName
#include <vector> // for Levels

class VTKKNOTWORKSURFACEFEATURES_EXPORT vtkSplineContour : public vtkSplineAlgorithm
{
public:
  static vtkSplineContour* New();
  vtkTypeMacro(vtkSplineContour, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Values of the contours; finite. Default none (NumberOfLevels of them are chosen). */
  void AddLevel(double level);
  void ClearLevels();
  int GetNumberOfGivenLevels() { return static_cast<int>(this->Levels.size()); }
  double GetLevel(int index) { return this->Levels.at(static_cast<std::size_t>(index)); }
  ///@}
  ///@{
  /** How many levels are chosen when none are given: evenly in Range, its ends included, or
   * inside the range of the values at the corners of elements. Default 10, valid range [1,
   * 10000]. */
  vtkSetClampMacro(NumberOfLevels, int, 1, 10000);
  vtkGetMacro(NumberOfLevels, int);
  ///@}
  ///@{
  /** Range of the levels that are chosen, ends included; without a length the inside of the
   * range of the values. Default 0 0. Advanced. Components from, to. */
  vtkSetVector2Macro(Range, double);
  vtkGetVector2Macro(Range, double);
  ///@}
  ///@{
  /** Field of the spline grid whose contours are wanted; empty or `None`: the coordinates.
   * Default empty. Group "Values". */
  vtkSetMacro(FieldName, std::string);
  vtkGetMacro(FieldName, std::string);
  ///@}
  ///@{
  /** Component of the field, or coordinate; -1: the last one, of the coordinates the height.
   * Default -1, valid range [-1, 1000]. Group "Values". */
  vtkSetClampMacro(Component, int, -1, 1000);
  vtkGetMacro(Component, int);
  ///@}
  ///@{
  /** Largest difference between value and level anywhere on a contour; 0: a ten-thousandth of
   * the range of the values. Default 0, valid range >= 0. Group "Accuracy". */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Largest distance in space between straight pieces (spline curves) and the surface; 0: a
   * thousandth of the diagonal of the box around the corners of elements. Default 0, valid range
   * >= 0. Advanced. Group "Accuracy". */
  vtkSetClampMacro(ChordalTolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ChordalTolerance, double);
  ///@}
  ///@{
  /** Whether contours go on over the seams of closed surfaces. Default on. Advanced. Group
   * "Curves". */
  vtkSetMacro(JoinSeams, bool);
  vtkGetMacro(JoinSeams, bool);
  vtkBooleanMacro(JoinSeams, bool);
  ///@}
  ///@{
  /** Whether the third coordinate of points becomes the level. Default off. Group "Curves". */
  vtkSetMacro(ProjectToLevel, bool);
  vtkGetMacro(ProjectToLevel, bool);
  vtkBooleanMacro(ProjectToLevel, bool);
  ///@}
  ///@{
  /** Whether the contours are made as cubic spline curves, too: output 1. Default off. Group
   * "Curves". */
  vtkSetMacro(Curves, bool);
  vtkGetMacro(Curves, bool);
  vtkBooleanMacro(Curves, bool);
  ///@}
  ///@{
  /** Cells an element is divided into for a level at most, before it counts as undecided.
   * Default 65536, valid range [16, 1048576]. Advanced. */
  vtkSetClampMacro(MaximumCells, int, 16, 1048576);
  vtkGetMacro(MaximumCells, int);
  ///@}
  ///@{
  /** Points of the contours of a surface at most (5000000 take about 1.5 GB); more are an error.
   * Default 5000000, valid range >= 1. Advanced. */
  vtkSetClampMacro(MaximumPoints, int, 1, VTK_INT_MAX);
  vtkGetMacro(MaximumPoints, int);
  ///@}

protected:
  vtkSplineContour();
  ~vtkSplineContour() override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  knotwork::Status Gather(vtkInformationVector** inputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  struct Preparation;
  knotwork::Status Prepare(vtkInformationVector** inputs);

  vtkSplineContour(const vtkSplineContour&) = delete;
  void operator=(const vtkSplineContour&) = delete;

  std::unique_ptr<Preparation> Prepared; ///< from Gather to Compute
  std::vector<double> Levels;
  int NumberOfLevels = 10;
  double Range[2] = { 0.0, 0.0 };
  std::string FieldName;
  int Component = -1;
  double Tolerance = 0.0;
  double ChordalTolerance = 0.0;
  bool JoinSeams = true;
  bool ProjectToLevel = false;
  bool Curves = false;
  int MaximumCells = 65536;
  int MaximumPoints = 5000000;
};
#endif
