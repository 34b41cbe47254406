// SPDX-License-Identifier: BSD-3-Clause
// From a refinement tree to a SplineSpace: elements, truncation rows, factors.
#include "FactorPool.h"
#include "Hierarchy.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace knotwork
{
namespace
{
/// Rows of T for the functions of one level; empty for covered functions.
struct TruncationRows
{
  std::vector<std::size_t> Start{ 0 };
  std::vector<int> Function;
  std::vector<double> Coefficient;
};

/// Sums sparse rows of positive coefficients in a dense array that is zero between two sums.
class RowSum
{
public:
  explicit RowSum(int functions)
    : Sum(static_cast<std::size_t>(functions), 0.0),
      Touched(static_cast<std::size_t>(functions) + 1)
  {
  }
  void Add(const TruncationRows& rows, std::size_t row, double weight)
  {
    for (std::size_t k = rows.Start[row]; k < rows.Start[row + 1]; ++k)
    {
      double& sum = this->Sum[static_cast<std::size_t>(rows.Function[k])];
      this->Touched[this->NumTouched] = rows.Function[k]; // kept when it is new: no branch
      this->NumTouched += sum == 0.0 ? 1 : 0;
      sum += weight * rows.Coefficient[k];
    }
  }
  /// Appends the sum to the rows and clears it.
  void MoveTo(TruncationRows& rows)
  {
    const auto end = this->Touched.begin() + static_cast<std::ptrdiff_t>(this->NumTouched);
    std::sort(this->Touched.begin(), end);
    rows.Function.insert(rows.Function.end(), this->Touched.begin(), end);
    rows.Coefficient.resize(rows.Function.size());
    double* coefficient = rows.Coefficient.data() + (rows.Function.size() - this->NumTouched);
    for (std::size_t i = 0; i < this->NumTouched; ++i)
    {
      coefficient[i] = std::exchange(this->Sum[static_cast<std::size_t>(this->Touched[i])], 0.0);
    }
    this->NumTouched = 0;
  }

private:
  std::vector<double> Sum;
  std::vector<int> Touched;
  std::size_t NumTouched = 0;
};

/// The recursion of truncation: a function inside Omega^level has a unit row, any other is what its
/// parents make of it. Covered functions never contribute, since a child's support lies in its
/// parents'.
template <int Dim>
TruncationRows MakeRows(const std::vector<DyadicKnots>& knots, const Hierarchy<Dim>& hierarchy,
  std::size_t level, const TruncationRows& coarse, RowSum& sum)
{
  const HierarchyLevel<Dim>& fine = hierarchy.Levels[level];
  TruncationRows rows;
  rows.Start.reserve(fine.Ids.size() + 1);
  // Rows grow from level to level and soon keep their mean length.
  rows.Function.reserve(fine.Ids.size() + 3 * coarse.Function.size());
  rows.Coefficient.reserve(rows.Function.capacity());
  ParentStencil<Dim> parents(knots, static_cast<int>(level));
  for (std::size_t i = 0; i < fine.Ids.size(); ++i)
  {
    if (fine.Ids[i] >= 0)
    {
      rows.Function.push_back(fine.Ids[i]);
      rows.Coefficient.push_back(1.0);
    }
    else if (fine.Ids[i] == HierarchyLevel<Dim>::Partial)
    {
      parents.Find(hierarchy.Levels[level - 1].Functions, fine.Functions.Index(i));
      for (std::size_t k = 0; k < parents.Numbers.size(); ++k)
      {
        sum.Add(coarse, static_cast<std::size_t>(parents.Numbers[k]), parents.Weights[k]);
      }
      sum.MoveTo(rows);
    }
    rows.Start.push_back(rows.Function.size());
  }
  return rows;
}

/// Pool offsets of the 1D operators of one level and direction, computed when first asked for.
class LevelFactors
{
public:
  LevelFactors(const DyadicKnots& knots, int level, FactorPool& pool)
    : Knots(knots), Level(level), Pool(pool),
      Offsets(static_cast<std::size_t>(knots.NumRootCells()) *
          static_cast<std::size_t>(knots.NumExtractionClasses()),
        Unknown)
  {
  }
  int Get(std::int64_t cell)
  {
    const std::int64_t key = (cell >> this->Level) * this->Knots.NumExtractionClasses() +
      this->Knots.ExtractionClass(this->Level, cell);
    int& offset = this->Offsets[static_cast<std::size_t>(key)];
    if (offset == Unknown)
    {
      double matrix[(MaxDegree + 1) * (MaxDegree + 1)];
      this->Knots.Extraction(this->Level, cell, matrix);
      offset = this->Pool.Add(this->Knots.Degree(), matrix);
    }
    return offset;
  }

private:
  static constexpr int Unknown = -2;
  const DyadicKnots& Knots;
  int Level;
  FactorPool& Pool;
  std::vector<int> Offsets;
};

/// Copies the tree in its canonical order into the space and lists the cells by level.
template <int Dim>
HierarchyCells<Dim> NumberElements(const RefinementTree<Dim>& tree, SplineSpace<Dim>& space)
{
  constexpr std::size_t children = RefinementTree<Dim>::NumChildren;
  HierarchyCells<Dim> cells;
  std::array<std::size_t, MaxHierarchyLevel + 2> next{}; // place in Tree of a level's next cell
  int elements = 0;
  tree.ForEachCell(
    [&](int level, const LevelIndex<Dim>& index, bool isRefined)
    {
      const std::size_t l = static_cast<std::size_t>(level);
      cells.resize(std::max(cells.size(), l + 1));
      const int link = isRefined ? -1 - static_cast<int>(space.Tree.size() / children) : elements++;
      cells[l].push_back({ index, isRefined ? -1 : link });
      if (level == 0)
      {
        space.RootCells.push_back(link);
      }
      else
      {
        space.Tree[next[l]++] = link;
      }
      if (isRefined)
      {
        next[l + 1] = space.Tree.size();
        space.Tree.resize(space.Tree.size() + children);
      }
    });
  space.Elements.resize(static_cast<std::size_t>(elements));
  return cells;
}

/// Everything of a level's elements but the rows: LocalFunctionIds get the numbers of the level's
/// functions.
template <int Dim>
void FillElements(const std::vector<DyadicKnots>& knots, int level,
  const std::vector<HierarchyCell<Dim>>& cells, const FunctionMap<Dim>& functions, FactorPool& pool,
  SplineSpace<Dim>& space)
{
  IntArray<Dim> degree, shape;
  std::vector<LevelFactors> factors;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    degree[d] = knots[d].Degree();
    shape[d] = degree[d] + 1;
    factors.emplace_back(knots[d], level, pool);
  }
  const std::size_t perElement = static_cast<std::size_t>(NumTensorFunctions<Dim>(degree));
  for (const auto& cell : cells)
  {
    if (cell.Element < 0)
    {
      continue;
    }
    auto& element = space.Elements[static_cast<std::size_t>(cell.Element)];
    element.Degree = degree;
    element.Level = level;
    element.FirstLocal = static_cast<std::size_t>(cell.Element) * perElement;
    LevelIndex<Dim> first;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      element.Box.Lower[d] = knots[d].Break(level, cell.Index[d]);
      element.Box.Upper[d] = knots[d].Break(level, cell.Index[d] + 1);
      element.Factor[d] = factors[d].Get(cell.Index[d]);
      first[d] = knots[d].FirstFunction(level, cell.Index[d]);
    }
    functions.FindBlock(first, shape, space.LocalFunctionIds.data() + element.FirstLocal);
  }
}

/// Appends the rows that a level's elements use to T and replaces the numbers of the level's
/// functions in LocalFunctionIds by the rows' numbers.
template <int Dim>
void AppendRows(const std::vector<HierarchyCell<Dim>>& cells, const TruncationRows& rows,
  std::size_t perElement, SplineSpace<Dim>& space)
{
  constexpr int unused = -1;
  std::vector<int> row(rows.Start.size() - 1, unused);
  const auto forEachId = [&](auto&& visit)
  {
    for (const auto& cell : cells)
    {
      if (cell.Element >= 0)
      {
        int* ids =
          space.LocalFunctionIds.data() + static_cast<std::size_t>(cell.Element) * perElement;
        std::for_each(ids, ids + perElement, visit);
      }
    }
  };
  forEachId([&](int number) { row[static_cast<std::size_t>(number)] = 0; });
  for (std::size_t i = 0; i < row.size(); ++i)
  {
    if (row[i] == unused)
    {
      continue;
    }
    row[i] = space.NumLocalFunctions++;
    const auto begin = static_cast<std::ptrdiff_t>(rows.Start[i]);
    const auto end = static_cast<std::ptrdiff_t>(rows.Start[i + 1]);
    space.RowFunction.insert(
      space.RowFunction.end(), rows.Function.begin() + begin, rows.Function.begin() + end);
    space.RowCoefficient.insert(
      space.RowCoefficient.end(), rows.Coefficient.begin() + begin, rows.Coefficient.begin() + end);
    space.RowStart.push_back(space.RowFunction.size());
  }
  forEachId([&](int& number) { number = row[static_cast<std::size_t>(number)]; });
}
}

template <int Dim>
Result<SplineSpacePtr<Dim>> MakeSpaceOfTree(
  const std::array<KnotVector, Dim>& knots, const RefinementTree<Dim>& tree)
{
  IntArray<Dim> degree;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    degree[d] = knots[d].Degree();
  }
  const std::size_t perElement = static_cast<std::size_t>(NumTensorFunctions<Dim>(degree));
  const double cells = static_cast<double>(tree.NumElements()) * RefinementTree<Dim>::NumChildren;
  if (cells > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge,
      "a hierarchical space has at most 2^31 - 1 cells, this one has " +
        std::to_string(tree.NumElements()) + " elements" };
  }

  auto space = std::make_shared<SplineSpace<Dim>>();
  space->Kind = SpaceKind::Hierarchical;
  space->Knots = knots;
  // The arithmetic refers to the space's own knots, which live as long as the space.
  const std::vector<DyadicKnots> dyadic = MakeDyadicKnots<Dim>(space->Knots);
  const HierarchyCells<Dim> levelCells = NumberElements(tree, *space);
  auto hierarchy = std::make_shared<Hierarchy<Dim>>(SelectFunctions<Dim>(dyadic, levelCells));
  space->NumFunctions = hierarchy->NumFunctions;
  space->LocalFunctionIds.resize(space->Elements.size() * perElement);

  FactorPool pool(space->FactorData);
  RowSum sum(space->NumFunctions);
  TruncationRows rows;
  space->RowStart.push_back(0);
  for (std::size_t l = 0; l < levelCells.size(); ++l)
  {
    rows = MakeRows(dyadic, *hierarchy, l, rows, sum);
    FillElements(
      dyadic, static_cast<int>(l), levelCells[l], hierarchy->Levels[l].Functions, pool, *space);
    AppendRows(levelCells[l], rows, perElement, *space);
  }
  if (levelCells.size() == 1) // nothing refined: row j is function j
  {
    space->RowStart.clear();
    space->RowFunction.clear();
    space->RowCoefficient.clear();
  }
  space->Levels = std::move(hierarchy);
  return SplineSpacePtr<Dim>(std::move(space));
}

template Result<SplineSpacePtr<1>> MakeSpaceOfTree<1>(
  const std::array<KnotVector, 1>&, const RefinementTree<1>&);
template Result<SplineSpacePtr<2>> MakeSpaceOfTree<2>(
  const std::array<KnotVector, 2>&, const RefinementTree<2>&);
template Result<SplineSpacePtr<3>> MakeSpaceOfTree<3>(
  const std::array<KnotVector, 3>&, const RefinementTree<3>&);
}
