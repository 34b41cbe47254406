// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SurfaceFitting/SurfaceFit.h>

#include <string>
#include <vector>

class vtkDataArray;
class vtkImageData;
class vtkPointSet;
class vtkPolyData;
class vtkTable;
class vtkUnstructuredGrid;

namespace knotwork
{
struct SplineModel;

enum class CloudParameters
{
  HeightField, ///< x, y; z is what is fitted
  Given,       ///< an array; x, y, z are fitted
  /// Of closest points of the surface that the fit starts from; without one of the triangles when
  /// there are some, else in the plane of least squares.
  Computed
};

/// What of a data set is fitted.
struct CloudChoice
{
  CloudParameters Parameters = CloudParameters::HeightField;
  vtkDataArray* Given = nullptr;       ///< two components
  vtkDataArray* Tolerances = nullptr;  ///< one component, > 0
  vtkDataArray* Significant = nullptr; ///< one component
  std::vector<std::string> Fields;     ///< point arrays to fit along
  bool AllFields = false;              ///< all other numeric point arrays
  const Spline<2>* Start = nullptr;    ///< the surface that the fit starts from
  int Threads = 0;
  ProgressCallback Progress; ///< of the search for closest points
};

struct DecodedCloud
{
  PointCloud Cloud;
  int NumMeasured = 1;
  const char* Over = nullptr; ///< what points may lie over in layers; triangles do not
  /// Of the arrays fitted along, in the order of the columns, then of the start's other fields.
  std::vector<std::string> Names;
  std::vector<int> Components; ///< of each of them
};

/// The points of a data set with parameters and values.
/// @return EmptyInput; SizeMismatch and InvalidParameter for arrays; failures of PlaneParameters,
/// ClosestParameters and FlattenMesh; NotInSpace for triangles that flip in the plane
/// or whose map lies over itself. Numbers that
/// are not finite or too large are FitSurface's to refuse.
Result<DecodedCloud> DecodeCloud(vtkPointSet* data, const CloudChoice& choice);

/// The one surface of a model that a fit may start from. @return EmptyInput, DimensionMismatch.
Result<const Spline<2>*> FindStart(const SplineModel& model);

/// The start of a fit to the points: the surface's heights or points and the fields that are fitted
/// along; its other fields are carried along, and their names are added to those of the cloud.
/// @param model  with one surface (FindStart).
/// @return InvalidParameter: it is no height field but the points are; it lacks a field.
Result<FitStart> MakeStart(const SplineModel& model, DecodedCloud& cloud, int threads);

/// The surface (x, y, z) with the arrays fitted along as fields on the same space, features of its
/// elements as cell arrays.
Status EncodeFit(const DecodedCloud& cloud, const SurfaceFit& fit, vtkUnstructuredGrid* output);

/// Adds the point arrays `Distance`, `Tolerance`, `Outlier`, and with other parameters than x, y
/// the parameters `UV`.
void EncodeDistances(const DecodedCloud& cloud, const SurfaceFit& fit, vtkPointSet* output);

/// A row an iteration, the last one that of the result: Iteration, Method, Functions, Elements,
/// MaxError, MeanError, RmsError, PointsOutside, Outliers, SignificantPoints, MaxSignificantError,
/// MeanSignificantError, SignificantOutside, LogLikelihood, DegreesOfFreedom, AIC, BIC.
void EncodeIterations(const SurfaceFit& fit, vtkTable* output);

/// A cell a cell of the feature grid with FitFeatureNames as cell arrays; a layer an iteration, of
/// height 1, when there are several.
void EncodeGridFeatures(const SurfaceFit& fit, vtkImageData* output);

/// A rectangle of the parameter plane an element, with FitFeatureNames, `ElementId` and `Iteration`
/// as cell arrays.
void EncodeElementFeatures(const SurfaceFit& fit, vtkPolyData* output);
}
