// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>
#include <knotwork/SplineCore/Status.h>

namespace knotwork
{
template <int Dim>
struct Spline;
template <int Dim>
struct RefinedSpline;
struct RefinementParams;
template <int Dim>
struct FunctionInfo;
template <int Dim>
struct ChartCell;
struct NetEdge;

/// Rows of numbers that a definition has beside degrees and knots: whole or real ones.
struct DefinitionTable
{
  std::vector<std::int64_t> Whole;
  std::vector<double> Real;

  bool operator==(const DefinitionTable& other) const
  {
    return this->Whole == other.Whole && this->Real == other.Real;
  }
};

/// How a family stores a table of its definitions.
struct DefinitionTableLayout
{
  const char* Name;                 ///< of the array that holds it, without a prefix
  std::vector<const char*> Columns; ///< names; one empty name for a plain list
  bool IsWhole;
};

/// What a space is made from, in the form in which it is stored; equal ones make equal spaces.
struct SpaceDefinition
{
  SpaceKind Kind = SpaceKind::Bezier; ///< a Bezier space is defined by its elements alone
  int Dimension = 0;
  std::array<int, 3> Degree{};
  std::array<std::vector<double>, 3> Knots;
  std::vector<DefinitionTable> Tables; ///< one a layout of the family, or none

  bool operator==(const SpaceDefinition& other) const
  {
    return this->Kind == other.Kind && this->Dimension == other.Dimension &&
      this->Degree == other.Degree && this->Knots == other.Knots && this->Tables == other.Tables;
  }
};

/// Numbers of the Bernstein points of all elements, first direction fastest within an element.
/// Points of two elements are one where the family knows that every spline of the space has one
/// value there.
struct ElementPoints
{
  std::vector<std::int64_t> Ids;
  std::int64_t Count = 0;
};

/// What a family of spaces knows and does; the operations of the same names in the headers of
/// Operations and Space check their input and ask the family. A new family is one folder with a
/// class of this kind and a line in each exhaustive switch over SpaceKind (SplineSpace.h,
/// SpaceFamilies.cxx, LocallyRefinedForm.cxx).
template <int Dim>
class SpaceFamily
{
public:
  virtual ~SpaceFamily() = default;

  /// As users read it: "tensor-product".
  virtual const char* Name() const = 0;
  /// Number of the kind in stored grids, > 0; 0 when the space is not stored.
  virtual int StoredNumber() const = 0;
  /// Tables of a definition, in the order of SpaceDefinition::Tables.
  virtual const std::vector<DefinitionTableLayout>& Tables() const = 0;
  /// Rows of a table after the first, whose number is stored.
  /// @param definition  its degrees and knots.
  virtual std::size_t NumRows(
    const SpaceDefinition& definition, int numFunctions, std::size_t table) const = 0;
  virtual SpaceDefinition Describe(const SplineSpace<Dim>& space) const = 0;
  /// @return InvalidTopology for numbers out of range and where there are no such spaces; the
  /// builder's errors. @param threads  0 = all cores.
  virtual Result<SplineSpacePtr<Dim>> Build(
    const SpaceDefinition& definition, int threads) const = 0;

  /// Elements and local parameters of points, as SplineSpace::Locate.
  virtual void Locate(const SplineSpace<Dim>& space, const double* u, std::ptrdiff_t stride,
    std::size_t n, int* elements, double* local) const = 0;
  /// One a function; empty when functions have neither levels nor anchors.
  virtual std::vector<FunctionInfo<Dim>> DescribeFunctions(const SplineSpace<Dim>& space) const = 0;
  virtual std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>& space) const = 0;
  /// Charts of the elements, numbered from numCharts on, which grows by their number.
  virtual std::vector<ChartCell<Dim>> Charts(
    const SplineSpace<Dim>& space, int& numCharts) const = 0;
  virtual ElementPoints NumberPoints(const SplineSpace<Dim>& space) const = 0;
  virtual double FunctionsAfterRefinement(
    const SplineSpace<Dim>& space, int elevation, int refinements) const = 0;

  virtual Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>& spline) const = 0;
  /// @param marked  element ids, not empty.
  virtual Result<RefinedSpline<Dim>> RefineMarked(const Spline<Dim>& spline,
    const std::vector<int>& marked, const RefinementParams& params) const = 0;
  /// @param times  > 0, no degree grows above MaxDegree.
  virtual Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>& spline, int times) const = 0;
  virtual Result<Spline<Dim>> TensorForm(
    const Spline<Dim>& spline, int threads, int maxFunctions) const = 0;
};

template <int Dim>
const SpaceFamily<Dim>& FamilyOf(SpaceKind kind);
template <int Dim>
const SpaceFamily<Dim>& FamilyOf(const SplineSpace<Dim>& space)
{
  return FamilyOf<Dim>(space.Kind);
}
}
