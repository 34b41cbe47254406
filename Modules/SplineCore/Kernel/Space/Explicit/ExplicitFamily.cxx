// SPDX-License-Identifier: BSD-3-Clause
// Splines that are given by their extraction operators as a family.
#include "ControlNet.h"
#include "ExplicitSpace.h"
#include "FamilyWithoutDomain.h"
#include "Refinement.h"

#include <algorithm>
#include <limits>

namespace knotwork
{
namespace
{
std::size_t At(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

enum Table
{
  Elements,
  Functions,
  Coefficients,
  NumTables
};

/// Columns of the first two tables.
constexpr std::size_t ElementColumns = 4; ///< degrees, number of functions
constexpr std::size_t FunctionColumns = 2;

/// Bernstein polynomials of an element in a table of a definition; 0 where its degrees are none.
std::size_t NumPolynomials(const std::int64_t* element, int dimension)
{
  std::size_t size = 1;
  for (int d = 0; d < dimension; ++d)
  {
    size *= element[d] >= 1 && element[d] <= MaxDegree ? At(element[d] + 1) : 0;
  }
  return size;
}

constexpr const char* NoMesh =
  "a spline that is given by extraction operators (as of a BEXT file) has no mesh to refine; "
  "refine the spline that they were made of";

template <int Dim>
class ByOperators final : public FamilyWithoutDomain<Dim>
{
public:
  const char* Name() const override { return "explicit"; }
  int StoredNumber() const override { return 5; }
  const std::vector<DefinitionTableLayout>& Tables() const override
  {
    static const std::vector<DefinitionTableLayout> tables{
      { "ExtractionElements", { "Degree0", "Degree1", "Degree2", "Functions" }, true },
      { "ExtractionFunctions", { "Function", "Vector" }, true },
      { "ExtractionCoefficients", { "" }, false }
    };
    return tables;
  }
  /// Vectors are numbered in the order of their first use, so that their lengths follow. The last
  /// row of the functions holds how many functions and vectors there are. Numbers that cannot be
  /// ask for more rows than there are.
  std::size_t NumRows(const SpaceDefinition& definition, int, std::size_t table) const override
  {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    const std::vector<std::int64_t>& elements = definition.Tables[Elements].Whole;
    const std::vector<std::int64_t>& functions = definition.Tables[Functions].Whole;
    std::size_t numFunctions = 0;
    std::size_t numCoefficients = 0;
    std::int64_t numVectors = 0;
    for (std::size_t e = 0; e + ElementColumns <= elements.size(); e += ElementColumns)
    {
      const std::int64_t count = elements[e + 3];
      if (count < 0 || count > std::numeric_limits<int>::max())
      {
        return none;
      }
      const std::size_t size = NumPolynomials(elements.data() + e, definition.Dimension);
      for (std::int64_t k = 0; table == Coefficients && k < count; ++k, ++numFunctions)
      {
        const std::int64_t vector = functions[numFunctions * FunctionColumns + 1];
        numCoefficients += vector == numVectors ? size : 0;
        numVectors += vector == numVectors ? 1 : 0;
      }
      numFunctions += table == Functions ? At(count) : 0;
    }
    return table == Functions ? numFunctions + 1 : numCoefficients;
  }
  SpaceDefinition Describe(const SplineSpace<Dim>& space) const override
  {
    const ExtractionTable<Dim>& extraction = *space.Extraction;
    SpaceDefinition definition;
    definition.Kind = SpaceKind::Explicit;
    definition.Dimension = Dim;
    definition.Tables.resize(NumTables);
    for (std::size_t e = 0; e < extraction.NumElements(); ++e)
    {
      std::array<std::int64_t, ElementColumns> row{};
      std::copy(extraction.Degrees[e].begin(), extraction.Degrees[e].end(), row.begin());
      row[3] =
        static_cast<std::int64_t>(extraction.FirstFunction[e + 1] - extraction.FirstFunction[e]);
      std::vector<std::int64_t>& rows = definition.Tables[Elements].Whole;
      rows.insert(rows.end(), row.begin(), row.end());
    }
    for (std::size_t k = 0; k < extraction.Functions.size(); ++k)
    {
      definition.Tables[Functions].Whole.push_back(extraction.Functions[k]);
      definition.Tables[Functions].Whole.push_back(extraction.Vectors[k]);
    }
    definition.Tables[Functions].Whole.push_back(space.NumFunctions);
    definition.Tables[Functions].Whole.push_back(
      static_cast<std::int64_t>(extraction.NumVectors()));
    definition.Tables[Coefficients].Real = extraction.Coefficients;
    return definition;
  }
  Result<SplineSpacePtr<Dim>> Build(const SpaceDefinition& definition, int) const override
  {
    const std::vector<std::int64_t>& elements = definition.Tables[Elements].Whole;
    const std::vector<std::int64_t>& functions = definition.Tables[Functions].Whole;
    const auto bounded = [](std::int64_t value)
    { return static_cast<int>(std::clamp<std::int64_t>(value, -1, MostNumbers)); };
    ExtractionTable<Dim> extraction;
    extraction.Coefficients = definition.Tables[Coefficients].Real;
    for (std::size_t e = 0; e + ElementColumns <= elements.size(); e += ElementColumns)
    {
      IntArray<Dim> degree{};
      for (std::size_t d = 0; d < Dim; ++d)
      {
        degree[d] = bounded(elements[e + d]);
      }
      const std::size_t size = NumPolynomials(elements.data() + e, Dim);
      for (std::int64_t k = 0; k < elements[e + 3]; ++k)
      {
        const std::size_t row = extraction.Functions.size() * FunctionColumns;
        if (functions[row + 1] == static_cast<std::int64_t>(extraction.NumVectors()))
        {
          extraction.FirstCoefficient.push_back(extraction.FirstCoefficient.back() + size);
        }
        extraction.Functions.push_back(bounded(functions[row]));
        extraction.Vectors.push_back(bounded(functions[row + 1]));
      }
      extraction.EndElement(degree);
    }
    return MakeExplicitSpace<Dim>(extraction, bounded(functions[functions.size() - 2]));
  }

  /// The functions have no order that would make neighbours of them.
  std::vector<NetEdge> ControlNetEdges(const SplineSpace<Dim>&) const override { return {}; }
  ElementPoints NumberPoints(const SplineSpace<Dim>& space) const override
  {
    ElementPoints points;
    points.Ids.assign(space.LocalFunctionIds.begin(), space.LocalFunctionIds.end());
    points.Count = space.NumLocalFunctions;
    return points;
  }
  double FunctionsAfterRefinement(const SplineSpace<Dim>& space, int, int) const override
  {
    return space.NumFunctions;
  }

  Result<RefinedSpline<Dim>> RefineAll(const Spline<Dim>&) const override
  {
    return { ErrorCode::DimensionMismatch, NoMesh };
  }
  Result<RefinedSpline<Dim>> RefineMarked(
    const Spline<Dim>&, const std::vector<int>&, const RefinementParams&) const override
  {
    return { ErrorCode::DimensionMismatch, NoMesh };
  }
  Result<Spline<Dim>> ElevateDegrees(const Spline<Dim>&, int) const override
  {
    return { ErrorCode::DimensionMismatch, NoMesh };
  }
  Result<Spline<Dim>> TensorForm(const Spline<Dim>&, int, int) const override
  {
    return { ErrorCode::DimensionMismatch,
      "a spline that is given by extraction operators is no tensor product; write .vtu or .bext" };
  }

private:
  static constexpr std::int64_t MostNumbers = std::numeric_limits<int>::max() - 1;
};
}

template <int Dim>
const SpaceFamily<Dim>& ExplicitFamily()
{
  static const ByOperators<Dim> family;
  return family;
}

template const SpaceFamily<1>& ExplicitFamily<1>();
template const SpaceFamily<2>& ExplicitFamily<2>();
template const SpaceFamily<3>& ExplicitFamily<3>();
}
