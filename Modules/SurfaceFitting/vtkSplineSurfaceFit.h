// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplineSurfaceFit
 * @brief   fits a spline surface to scattered points
 *
 * Input 0 is a vtkPointSet. By default its points are those of a height field z(x, y); a surface in
 * space is fitted to points with parameters, which are given or computed. Point arrays are fitted
 * along. Elements are split where points are farther away than their tolerance, until none is.
 *
 * Input 1 (optional) is a spline grid of one surface that the fit starts from and updates: it stays
 * what it is where no function's support holds a point.
 *
 * SetInputArrayToProcess: 0 the parameters (two components; without it the array `UV`, then the
 * texture coordinates), 1 tolerances of the points, 2 where a point is significant (not 0). The
 * name `None` stands for no array.
 *
 * Output 0 is the surface (x, y, z) as a spline grid of kind LR or THB; arrays fitted along are
 * fields on the same space. Output 1 are the points with `Distance` (value minus surface; of
 * surfaces in space its length), `Tolerance` and `Outlier`, and with the parameters `UV` of a
 * surface in space. Output 2 is the table of iterations, whose last row is the result. Output 3 is
 * the feature grid (vtkImageData), empty when FeatureGridSize is 0; with FeatureIterations it has a
 * layer a row of the table. Output 4 are the elements (vtkPolyData, rectangles of the parameter
 * plane) with the same features and `Iteration`, empty unless ElementFeatures.
 *
 * A fit that ends by a limit is an output with a warning.
 *
 * In several processes that each have points they fit one surface together, the one of one process
 * to the last bit: output 0 and the tables are in the first process, output 1 are every one's
 * points. What NeedsWholeInput names is refused there, unless one process has all points.
 *
 * @source Skytt, Barrowclough, Dokken (2015). The module's page has options, limits, errors.
 */
#ifndef vtkSplineSurfaceFit_h
#define vtkSplineSurfaceFit_h
#include "vtkKnotworkSurfaceFittingModule.h" // for export macro
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>

#include <array>  // for tolerance boxes
#include <string> // for names

class vtkDataArray;

namespace knotwork
{
struct DecodedCloud;
struct FitParams;
struct SplineModel;
struct SurfaceFit;
}

class VTKKNOTWORKSURFACEFITTING_EXPORT vtkSplineSurfaceFit : public vtkSplineAlgorithm
{
public:
  static vtkSplineSurfaceFit* New();
  vtkTypeMacro(vtkSplineSurfaceFit, vtkSplineAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Parameterizations
  {
    HEIGHT_FIELD = 0, ///< parameters x, y; z is fitted
    GIVEN,            ///< parameters are an array; x, y, z are fitted
    COMPUTED ///< closest points of the start, plane coordinates of triangles, or of the plane
             ///< of least squares
  };
  enum Spaces
  {
    LR = 0, ///< "LR"
    THB     ///< "THB"
  };
  enum Methods
  {
    LEAST_SQUARES = 0,
    MBA,     ///< "MBA"
    COMBINED ///< least squares until SwitchIteration, then MBA
  };
  enum Distances
  {
    NO_DISTANCE = 0, ///< "None"
    VALUE_DISTANCE,  ///< "Value" tolerances grow with the height's absolute value
    POINT_DISTANCE   ///< "Point" tolerances grow with the distance from DistanceCentre
  };
  enum Sides
  {
    BOTH_SIDES = 0, ///< "Both"
    ABOVE,          ///< no point above the surface
    BELOW           ///< no point below the surface
  };
  enum Deviations
  {
    ROBUST = 0, ///< median absolute deviation
    STANDARD    ///< standard deviation
  };
  enum Criteria
  {
    TOLERANCE = 0,
    AIC, ///< "AIC"
    BIC  ///< "BIC"
  };
  enum Thresholds
  {
    ALL_ELEMENTS = 0, ///< "All"
    LARGEST_ERRORS,
    MOST_POINTS
  };
  enum DirectionChoices
  {
    BOTH_DIRECTIONS = 0, ///< "Both"
    ALTERNATING,
    BY_ERROR
  };
  enum EdgeHolds
  {
    NO_EDGES = 0, ///< "None"
    VALUES,
    DERIVATIVES ///< values and derivatives across the edge
  };
  enum Strategies
  {
    FULL_SPAN = 0,
    MINIMUM_SPAN,
    STRUCTURED_MESH,
    RESTRICTED_MESH
  };

  ///@{
  /** Input 1 (optional): the surface that the fit starts from. */
  void SetStartConnection(vtkAlgorithmOutput* output);
  void SetStartData(vtkDataObject* surface);
  ///@}
  ///@{
  /** Where the parameters of the points come from, one of Parameterizations. HEIGHT_FIELD: x and
   * y, and z is fitted. GIVEN: an array of two components. COMPUTED: closest points of the start
   * surface, without one plane coordinates of the triangles, or without triangles of the plane of
   * least squares. Default HEIGHT_FIELD. Group "Points". */
  vtkSetClampMacro(Parameterization, int, HEIGHT_FIELD, COMPUTED);
  vtkGetMacro(Parameterization, int);
  ///@}
  ///@{
  /** Whether the parameters of points in space become those of the closest points of every
   * iteration's surface (slower). Default off. Advanced. For Parameterization not HEIGHT_FIELD.
   * Group "Points". */
  vtkSetMacro(CorrectParameters, bool);
  vtkGetMacro(CorrectParameters, bool);
  vtkBooleanMacro(CorrectParameters, bool);
  ///@}
  ///@{
  /** Point arrays that are fitted along, besides those of AllFields. */
  void AddFieldArray(const char* name);
  void ClearFieldArrays();
  ///@}
  ///@{
  /** Whether all other point arrays of numbers are fitted along. Default off. Group "Points". */
  vtkSetMacro(AllFields, bool);
  vtkGetMacro(AllFields, bool);
  vtkBooleanMacro(AllFields, bool);
  ///@}
  ///@{
  /** Kind of the spline space, one of Spaces: locally refined or truncated hierarchical
   * B-splines. A start surface of one of these kinds keeps its own. Default LR. Group "Space and
   * Domain". */
  vtkSetClampMacro(Space, int, LR, THB);
  vtkGetMacro(Space, int);
  ///@}
  ///@{
  /** Degree in the first parameter. Default 2, valid range [1, 9]. Group "Space and Domain". */
  vtkSetClampMacro(Degree, int, 1, 9);
  vtkGetMacro(Degree, int);
  ///@}
  ///@{
  /** Degree in the second parameter; 0: as the first. Default 0, valid range [0, 9]. Advanced.
   * Group "Space and Domain". */
  vtkSetClampMacro(SecondDegree, int, 0, 9);
  vtkGetMacro(SecondDegree, int);
  ///@}
  ///@{
  /** Elements of the initial space in the first parameter; 0: chosen by the number of points.
   * Default 0, valid range [0, 10000]. Advanced. Group "Space and Domain". */
  vtkSetClampMacro(InitialElementsU, int, 0, 10000);
  vtkGetMacro(InitialElementsU, int);
  ///@}
  ///@{
  /** Elements of the initial space in the second parameter; 0: chosen by the number of points.
   * Default 0, valid range [0, 10000]. Advanced. Group "Space and Domain". */
  vtkSetClampMacro(InitialElementsV, int, 0, 10000);
  vtkGetMacro(InitialElementsV, int);
  ///@}
  ///@{
  /** Parameter domain u0, u1, v0, v1; without an area the box of the parameters. Default 0 0 0
   * 0. Advanced. Components u0, u1, v0, v1. Group "Space and Domain". */
  vtkSetVector4Macro(Domain, double);
  vtkGetVector4Macro(Domain, double);
  ///@}
  ///@{
  /** What of the start surface stays on its HeldSides through all refinement, one of EdgeHolds:
   * nothing, its edge curves, or these and the derivatives across them. Default NO_EDGES. Advanced.
   * Group "Space and Domain". */
  vtkSetClampMacro(HoldEdges, int, NO_EDGES, DERIVATIVES);
  vtkGetMacro(HoldEdges, int);
  ///@}
  ///@{
  /** Which sides HoldEdges is about: not 0 for the lower and upper end of the first parameter,
   * then of the second. Default 1 1 1 1. Advanced. For HoldEdges not NO_EDGES. Components u0, u1,
   * v0, v1. Group "Space and Domain". */
  vtkSetVector4Macro(HeldSides, int);
  vtkGetVector4Macro(HeldSides, int);

  /** What updates a surface with points that it was fitted to need not look for layers of them
   * again. False at the start. */
  void AssumeNoLayers(bool are) { this->LayersAreChecked = are; }
  ///@}
  ///@{
  /** How control points are found, one of Methods: least squares with smoothing, multilevel
   * B-spline approximation (averages of local solutions), or the one and then the other. Default
   * LEAST_SQUARES. Group "Method". */
  vtkSetClampMacro(Method, int, LEAST_SQUARES, COMBINED);
  vtkGetMacro(Method, int);
  ///@}
  ///@{
  /** First iteration of multilevel B-spline approximation. Default 6, valid range [0, 1000].
   * Advanced. For Method COMBINED. Group "Method". */
  vtkSetClampMacro(SwitchIteration, int, 0, 1000);
  vtkGetMacro(SwitchIteration, int);
  ///@}
  ///@{
  /** Weight of the thin-plate energy in least squares, relative to the data term. Default 1e-9,
   * valid range [0, 1000]. Advanced. For Method not MBA. Group "Method". */
  vtkSetClampMacro(Smoothing, double, 0.0, 1e3);
  vtkGetMacro(Smoothing, double);
  ///@}
  ///@{
  /** How many times a significant point counts. Default 10, valid range [1, 1000000]. Advanced.
   * Group "Method". */
  vtkSetClampMacro(SignificantWeight, double, 1.0, 1e6);
  vtkGetMacro(SignificantWeight, double);
  ///@}
  ///@{
  /** Largest distance of points from the surface, unit of the values; 0: a thousandth of the
   * range of the values. Default 0, valid range >= 0. Group "Tolerance". */
  vtkSetClampMacro(Tolerance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Tolerance, double);
  ///@}
  ///@{
  /** Times the tolerance, for points above the surface. Default 1, valid range [1e-6, 1000000].
   * Advanced. For Side BOTH_SIDES. Group "Tolerance". */
  vtkSetClampMacro(ToleranceFactorAbove, double, 1e-6, 1e6);
  vtkGetMacro(ToleranceFactorAbove, double);
  ///@}
  ///@{
  /** Times the tolerance, for points below the surface. Default 1, valid range [1e-6, 1000000].
   * Advanced. For Side BOTH_SIDES. Group "Tolerance". */
  vtkSetClampMacro(ToleranceFactorBelow, double, 1e-6, 1e6);
  vtkGetMacro(ToleranceFactorBelow, double);
  ///@}
  ///@{
  /** Points with parameters in [u0, u1] x [v0, v1] have a tolerance of their own; the smallest one
   * where boxes overlap. */
  void AddToleranceBox(double u0, double u1, double v0, double v1, double tolerance);
  void ClearToleranceBoxes();
  ///@}
  ///@{
  /** What the tolerance grows with, one of Distances: nothing, the absolute value of the height,
   * or the distance from DistanceCentre. Default NO_DISTANCE. Advanced. Group "Tolerance". */
  vtkSetClampMacro(DistanceMode, int, NO_DISTANCE, POINT_DISTANCE);
  vtkGetMacro(DistanceMode, int);
  ///@}
  ///@{
  /** Growth of the tolerance a unit of distance. Default 0, valid range >= 0. Advanced. For
   * DistanceMode not NO_DISTANCE. Group "Tolerance". */
  vtkSetClampMacro(DistanceSlope, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(DistanceSlope, double);
  ///@}
  ///@{
  /** Parameters from which distances are measured. Default 0 0. Advanced. For DistanceMode
   * POINT_DISTANCE. Components u, v. Group "Tolerance". */
  vtkSetVector2Macro(DistanceCentre, double);
  vtkGetVector2Macro(DistanceCentre, double);
  ///@}
  ///@{
  /** On which side of the surface points may be, one of Sides: both, no point above the surface,
   * no point below it. Default BOTH_SIDES. Group "Tolerance". */
  vtkSetClampMacro(Side, int, BOTH_SIDES, BELOW);
  vtkGetMacro(Side, int);
  ///@}
  ///@{
  /** Whether outliers are looked for; they do not count. Default off. Group "Outliers". */
  vtkSetMacro(FindOutliers, bool);
  vtkGetMacro(FindOutliers, bool);
  vtkBooleanMacro(FindOutliers, bool);
  ///@}
  ///@{
  /** Standard deviations of the distances nearby beyond which a point is an outlier. Default
   * 4.5, valid range [0.1, 1000]. Advanced. For FindOutliers on. Group "Outliers". */
  vtkSetClampMacro(OutlierScale, double, 0.1, 1000.0);
  vtkGetMacro(OutlierScale, double);
  ///@}
  ///@{
  /** What these are, one of Deviations: median absolute deviations times 1.4826 from the median, on
   * which other outliers have hardly any influence, or standard deviations from the mean. Default
   * ROBUST. Advanced. For FindOutliers on. Group "Outliers". */
  vtkSetClampMacro(OutlierDeviation, int, ROBUST, STANDARD);
  vtkGetMacro(OutlierDeviation, int);
  ///@}
  ///@{
  /** Refinements at most. Default 30, valid range [0, 1000]. Group "Termination". */
  vtkSetClampMacro(MaximumIterations, int, 0, 1000);
  vtkGetMacro(MaximumIterations, int);
  ///@}
  ///@{
  /** Functions at most; 0: ten times the number of points but at most a million, or the number
   * of points if that is more. Default 0, valid range [0, 1000000000]. Advanced. Group
   * "Termination". */
  vtkSetClampMacro(MaximumFunctions, int, 0, 1000000000);
  vtkGetMacro(MaximumFunctions, int);
  ///@}
  ///@{
  /** Seconds after which no iteration begins, nor one that would probably end later; 0: no
   * limit. Default 0, valid range >= 0. Advanced. Group "Termination". */
  vtkSetClampMacro(MaximumSeconds, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumSeconds, double);
  ///@}
  ///@{
  /** What ends the fit besides tolerance and limits, one of Criteria: nothing, or an information
   * criterion that has risen twice. Default TOLERANCE. Advanced. Group "Termination". */
  vtkSetClampMacro(Criterion, int, TOLERANCE, BIC);
  vtkGetMacro(Criterion, int);
  ///@}
  ///@{
  /** Which elements with points outside their tolerance are split, one of Thresholds. Default
   * LARGEST_ERRORS. Advanced. Group "Refinement". */
  vtkSetClampMacro(Threshold, int, ALL_ELEMENTS, MOST_POINTS);
  vtkGetMacro(Threshold, int);
  ///@}
  ///@{
  /** Share of the largest error, or of the most points outside, from which on elements are
   * split. Default 0.1, valid range [0, 1]. Advanced. For Threshold LARGEST_ERRORS, MOST_POINTS.
   * Group "Refinement". */
  vtkSetClampMacro(ThresholdShare, double, 0.0, 1.0);
  vtkGetMacro(ThresholdShare, double);
  ///@}
  ///@{
  /** Directions in which elements of LR spaces are split, one of DirectionChoices; THB elements
   * are split in both. Default BY_ERROR. Advanced. For Space LR. Group "Refinement". */
  vtkSetClampMacro(Directions, int, BOTH_DIRECTIONS, BY_ERROR);
  vtkGetMacro(Directions, int);
  ///@}
  ///@{
  /** How far the lines that split an LR element reach, one of Strategies: across all functions on
   * it, across the smallest, all knot spans of the smallest halved, or those of them that hold
   * elements to be split and are longer than half the longest. Default FULL_SPAN. Advanced. For
   * Space LR. Group "Refinement". */
  vtkSetClampMacro(Strategy, int, FULL_SPAN, RESTRICTED_MESH);
  vtkGetMacro(Strategy, int);
  ///@}
  ///@{
  /** First iteration whose lines are those of LaterStrategy; 0: none. Default 0, valid range [0,
   * 1000]. Advanced. For Space LR. Group "Refinement". */
  vtkSetClampMacro(StrategySwitch, int, 0, 1000);
  vtkGetMacro(StrategySwitch, int);
  ///@}
  ///@{
  /** Strategy from the iteration StrategySwitch on, one of Strategies. Default FULL_SPAN. Advanced.
   * For Space LR. Group "Refinement". */
  vtkSetClampMacro(LaterStrategy, int, FULL_SPAN, RESTRICTED_MESH);
  vtkGetMacro(LaterStrategy, int);
  ///@}
  ///@{
  /** Whether no step of an LR space leaves linearly dependent functions (slower). Default off.
   * Advanced. For Space LR. Group "Refinement". */
  vtkSetMacro(Independent, bool);
  vtkGetMacro(Independent, bool);
  vtkBooleanMacro(Independent, bool);
  ///@}
  ///@{
  /** Elements whose halves would be a smaller share of the domain are not split. Default 1e-7,
   * valid range [1e-12, 0.5]. Advanced. Group "Refinement". */
  vtkSetClampMacro(MinimumElementSize, double, 1e-12, 0.5);
  vtkGetMacro(MinimumElementSize, double);
  ///@}
  ///@{
  /** Cells of the feature grid in each direction; 0: no grid. Default 0, valid range [0, 4096].
   * Advanced. Group "Features". */
  vtkSetClampMacro(FeatureGridSize, int, 0, 4096);
  vtkGetMacro(FeatureGridSize, int);
  ///@}
  ///@{
  /** Whether the elements have features: cell arrays of the surface, and output 4. Default off.
   * Advanced. Group "Features". */
  vtkSetMacro(ElementFeatures, bool);
  vtkGetMacro(ElementFeatures, bool);
  vtkBooleanMacro(ElementFeatures, bool);
  ///@}
  ///@{
  /** Whether the feature grid and output 4 have the features of every iteration, not of the result
   * alone. Default off. Advanced. Group "Features". */
  vtkSetMacro(FeatureIterations, bool);
  vtkGetMacro(FeatureIterations, bool);
  vtkBooleanMacro(FeatureIterations, bool);
  ///@}

  /**
   * What of the properties needs all points in one process, by name; empty: nothing, and several
   * processes may fit together.
   */
  std::string NeedsWholeInput() const;

  /**
   * Measured seconds of the last run. They are in no output: outputs are the same from run to run.
   */
  vtkGetMacro(Seconds, double);

protected:
  vtkSplineSurfaceFit();
  ~vtkSplineSurfaceFit() override = default;
  int RequestDataObject(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  knotwork::Status Compute(vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  bool WorksOnPieces() const override { return true; }
  bool SumsUpPieces() const override { return true; }
  int WholeInputPort() const override { return 1; }
  knotwork::Status Merge(vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSplineSurfaceFit(const vtkSplineSurfaceFit&) = delete;
  void operator=(const vtkSplineSurfaceFit&) = delete;
  knotwork::Status FindArray(
    int index, const char* what, vtkInformationVector** inputs, vtkDataArray*& array);
  knotwork::Status DecodeStart(vtkInformationVector** inputs, knotwork::SplineModel& start);
  knotwork::Status DecodePoints(vtkInformationVector** inputs, const knotwork::SplineModel& start,
    knotwork::DecodedCloud& decoded);
  knotwork::Status MakeParams(const knotwork::SplineModel& start, knotwork::DecodedCloud& decoded,
    knotwork::FitParams& params);
  /** A fit to all points, which this process has. */
  knotwork::Status FitAlone(vtkInformationVector** inputs, vtkInformationVector* outputs);
  /** A fit to those of all processes. */
  knotwork::Status FitTogether(vtkInformationVector** inputs, vtkInformationVector* outputs);
  void EncodePoints(vtkInformationVector** inputs, vtkInformationVector* outputs,
    const knotwork::DecodedCloud& decoded, const knotwork::SurfaceFit& fit);
  knotwork::Status EncodeResult(vtkInformationVector* outputs,
    const knotwork::DecodedCloud& decoded, const knotwork::SurfaceFit& fit);

  int Parameterization = HEIGHT_FIELD;
  bool CorrectParameters = false;
  std::vector<std::string> FieldArrays;
  bool AllFields = false;
  int Space = LR;
  int Degree = 2;
  int SecondDegree = 0;
  int InitialElementsU = 0;
  int InitialElementsV = 0;
  double Domain[4] = { 0.0, 0.0, 0.0, 0.0 };
  double Seconds = 0.0;
  int HoldEdges = NO_EDGES;
  int HeldSides[4] = { 1, 1, 1, 1 };
  bool LayersAreChecked = false;
  int Method = LEAST_SQUARES;
  int SwitchIteration = 6;
  double Smoothing = 1e-9;
  double SignificantWeight = 10.0;
  double Tolerance = 0.0;
  double ToleranceFactorAbove = 1.0;
  double ToleranceFactorBelow = 1.0;
  std::vector<std::array<double, 5>> ToleranceBoxes;
  int DistanceMode = NO_DISTANCE;
  double DistanceSlope = 0.0;
  double DistanceCentre[2] = { 0.0, 0.0 };
  int Side = BOTH_SIDES;
  bool FindOutliers = false;
  double OutlierScale = 4.5;
  int OutlierDeviation = ROBUST;
  int MaximumIterations = 30;
  int MaximumFunctions = 0;
  double MaximumSeconds = 0.0;
  int Criterion = TOLERANCE;
  int Threshold = LARGEST_ERRORS;
  double ThresholdShare = 0.1;
  int Directions = BY_ERROR;
  int Strategy = FULL_SPAN;
  int StrategySwitch = 0;
  int LaterStrategy = FULL_SPAN;
  bool Independent = false;
  double MinimumElementSize = 1e-7;
  int FeatureGridSize = 0;
  bool ElementFeatures = false;
  bool FeatureIterations = false;
};
#endif
