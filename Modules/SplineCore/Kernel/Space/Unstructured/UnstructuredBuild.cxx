// SPDX-License-Identifier: BSD-3-Clause
#include "UnstructuredBuild.h"

#include "DisjointSets.h"
#include "FactorPool.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Coefficients of classes, ascending.
using Combination = std::vector<std::pair<int, double>>;

/// Coefficients smaller than this come from rounding; the sum of a row is 1.
constexpr double RowRounding = 1e-10;

template <int Dim>
class MeshSpaceAssembly
{
public:
  explicit MeshSpaceAssembly(std::shared_ptr<const UnstructuredData<Dim>> data)
    : Data(std::move(data)), P(this->Data->Degree), NumLocal(LocalFunctions(this->P)),
      Windows(this->P)
  {
  }

  /// @return none when something is inadmissible.
  std::shared_ptr<SplineSpace<Dim>> Run()
  {
    this->WindowOf = FindWindows(*this->Data, this->Windows);
    this->UniteAcrossFacets();
    this->RelateAcrossFacets();
    this->Resolve();
    return this->Places.empty() ? this->Finish() : nullptr;
  }
  const std::vector<Inadmissible>& Found() const { return this->Places; }

private:
  using Topology = MeshTopology<Dim>;
  static constexpr int NumSides = 2 * Dim;
  struct Facet
  {
    int Cell;
    int Side;
  };
  /// A class of local functions and the combination of others that it is, from a facet.
  struct Relation
  {
    int Class;
    Combination Value;
    Facet Where;
  };

  static int LocalFunctions(int p)
  {
    IntArray<Dim> degree;
    degree.fill(p);
    return NumTensorFunctions<Dim>(degree);
  }
  /// Window of the neighbour along the direction that continues direction d, read as the cell
  /// reads it.
  int WindowAcross(int cell, int side, int d) const
  {
    const int image = this->Data->Topology.Crossing(cell, side).Image[At(2 * d)];
    const int other = this->Data->Topology.Neighbour(cell, side);
    const int window = this->WindowOf[At(other * Dim + image / 2)];
    return image % 2 == 0 ? window : this->Windows.Reversed(window);
  }
  bool HasEqualWindows(int cell, int side) const
  {
    for (int d = 0; d < Dim; ++d)
    {
      if (d != side / 2 && this->WindowOf[At(cell * Dim + d)] != this->WindowAcross(cell, side, d))
      {
        return false;
      }
    }
    return true;
  }

  /// Local functions of two cells whose coefficients belong together across a facet where the
  /// windows along it are equal, by crossing and multiplicity. Tangential indices first, so that
  /// entry i of every depth is tangential index i.
  const std::vector<std::array<int, 2>>& Pairs(int crossing, int side, int multiplicity)
  {
    auto& pairs = this->PairTable[At(crossing * (MaxDegree + 1) + multiplicity)];
    if (!pairs.empty())
    {
      return pairs;
    }
    const FacetCrossing<Dim>& across = this->Data->Topology.CrossingOfNumber(crossing);
    const int width = this->P + 1;
    for (int depth = 0; depth <= this->P - multiplicity; ++depth)
    {
      for (int i = 0; i < this->NumLocal / width; ++i)
      {
        IntArray<Dim> own{};
        IntArray<Dim> other{};
        const auto set = [&](IntArray<Dim>& index, int toward, int k)
        { index[At(toward / 2)] = toward % 2 == 0 ? k : this->P - k; };
        set(own, side, depth);
        set(other, across.Side, this->P - multiplicity - depth);
        int rest = i;
        for (int d = 0; d < Dim; ++d)
        {
          if (d != side / 2)
          {
            set(own, 2 * d, rest % width);
            set(other, across.Image[At(2 * d)], rest % width);
            rest /= width;
          }
        }
        pairs.push_back({ this->Flat(own), this->Flat(other) });
      }
    }
    return pairs;
  }
  int Flat(const IntArray<Dim>& index) const
  {
    int flat = 0;
    for (int d = Dim; d-- > 0;)
    {
      flat = flat * (this->P + 1) + index[At(d)];
    }
    return flat;
  }

  /// Numbers of classes of local functions that have one coefficient, where nothing else is to be
  /// done: cells take the numbers of their neighbours before them.
  void UniteAcrossFacets()
  {
    const Topology& topology = this->Data->Topology;
    this->PairTable.resize(At(Topology::NumCrossings * (MaxDegree + 1)));
    this->Ids.assign(At(topology.NumCells()) * At(this->NumLocal), -1);
    for (int c = 0; c < topology.NumCells(); ++c)
    {
      int* ids = this->Ids.data() + At(c) * At(this->NumLocal);
      for (int side = 0; side < NumSides; ++side)
      {
        const int other = topology.Neighbour(c, side);
        if (other < 0 || other > c)
        {
          continue;
        }
        if (!this->HasEqualWindows(c, side))
        {
          this->Unequal.push_back({ c, side });
          continue;
        }
        const int* others = this->Ids.data() + At(other) * At(this->NumLocal);
        for (const auto& [a, b] :
          this->Pairs(topology.CrossingNumber(c, side), side, this->Data->Multiplicity(c, side)))
        {
          if (ids[a] < 0)
          {
            ids[a] = others[b];
          }
          else if (ids[a] != others[b])
          {
            this->Classes.Unite(ids[a], others[b]);
          }
        }
      }
      for (int a = 0; a < this->NumLocal; ++a)
      {
        ids[a] = ids[a] < 0 ? this->Classes.Add() : ids[a];
      }
    }
  }

  /// Facets where the windows along them differ.
  void RelateAcrossFacets()
  {
    const Topology& topology = this->Data->Topology;
    std::vector<Relation> relations;
    for (const Facet& facet : this->Unequal)
    {
      const int other = topology.Neighbour(facet.Cell, facet.Side);
      std::array<const WindowConversion*, 2> toOwn{};
      std::array<const WindowConversion*, 2> toOther{};
      bool ownFollows = true;
      bool otherFollows = true;
      for (int d = 0, k = 0; d < Dim; ++d)
      {
        if (d == facet.Side / 2)
        {
          continue;
        }
        const int own = this->WindowOf[At(facet.Cell * Dim + d)];
        const int across = this->WindowAcross(facet.Cell, facet.Side, d);
        toOwn[At(k)] = &this->Windows.Conversion(own, across);
        toOther[At(k)] = &this->Windows.Conversion(across, own);
        ownFollows = ownFollows && toOwn[At(k)]->IsConvex;
        otherFollows = otherFollows && toOther[At(k)]->IsConvex;
        ++k;
      }
      if (!ownFollows && !otherFollows)
      {
        this->Places.push_back({ Inadmissible::Reason::Negative, facet.Cell, facet.Side });
        continue;
      }
      const auto& pairs = this->Pairs(topology.CrossingNumber(facet.Cell, facet.Side), facet.Side,
        this->Data->Multiplicity(facet.Cell, facet.Side));
      const int* ownIds = this->Ids.data() + At(facet.Cell) * At(this->NumLocal);
      const int* otherIds = this->Ids.data() + At(other) * At(this->NumLocal);
      const auto id = [&](std::size_t pair, bool ofOwn)
      { return ofOwn ? ownIds[pairs[pair][0]] : otherIds[pairs[pair][1]]; };
      const auto& conversions = ownFollows ? toOwn : toOther;
      const std::size_t width = At(this->P + 1);
      const std::size_t layer = At(this->NumLocal) / width; // tangential indices
      for (std::size_t pair = 0; pair < pairs.size(); ++pair)
      {
        const std::size_t first = pair / layer * layer;
        const std::size_t row = pair % layer;
        Combination value;
        for (std::size_t column = 0; column < layer; ++column)
        {
          double weight = 1.0;
          for (std::size_t k = 0, stride = 1; k + 1 < Dim; ++k, stride *= width)
          {
            weight *=
              conversions[k]->Matrix[row / stride % width * width + column / stride % width];
          }
          if (weight != 0.0)
          {
            value.emplace_back(id(first + column, !ownFollows), weight);
          }
        }
        if (value.size() == 1)
        {
          this->Classes.Unite(id(pair, ownFollows), value[0].first);
        }
        else
        {
          relations.push_back({ id(pair, ownFollows), std::move(value), facet });
        }
      }
    }
    this->NumberClasses();
    for (Relation& relation : relations)
    {
      relation.Class = this->ClassOf[At(relation.Class)];
      for (auto& [term, weight] : relation.Value)
      {
        term = this->ClassOf[At(term)];
      }
      this->RelationsOf[relation.Class].push_back(std::move(relation));
    }
  }

  void NumberClasses()
  {
    this->ClassOf.resize(At(this->Classes.Size()));
    for (int i = 0; i < this->Classes.Size(); ++i)
    {
      const int first = this->Classes.Find(i); // the smallest
      this->ClassOf[At(i)] = first == i ? this->NumClasses++ : this->ClassOf[At(first)];
    }
    for (int& id : this->Ids)
    {
      id = this->ClassOf[At(id)];
    }
  }

  static Combination Sum(const Combination& terms, const std::map<int, Combination>& rows)
  {
    std::map<int, double> sum;
    for (const auto& [term, weight] : terms)
    {
      const auto row = rows.find(term);
      if (row == rows.end())
      {
        sum[term] += weight;
        continue;
      }
      for (const auto& [function, share] : row->second)
      {
        sum[function] += weight * share;
      }
    }
    return { sum.begin(), sum.end() };
  }

  /// Classes with relations as combinations of those without.
  void Resolve()
  {
    enum class State
    {
      Open,
      Busy,
      Done
    };
    std::map<int, State> states;
    for (const auto& [root, unused] : this->RelationsOf)
    {
      // depth first, without recursion
      std::vector<int> stack{ root };
      while (!stack.empty())
      {
        const int at = stack.back();
        State& state = states[at];
        if (state == State::Done)
        {
          stack.pop_back();
          continue;
        }
        const Relation& relation = this->RelationsOf[at].front();
        const bool isSecond = state == State::Busy;
        state = State::Busy;
        if (!isSecond)
        {
          for (const auto& [term, weight] : relation.Value)
          {
            if (this->RelationsOf.count(term) == 0)
            {
              continue;
            }
            const State other = states[term];
            if (other == State::Open)
            {
              stack.push_back(term);
            }
            else if (other == State::Busy)
            {
              this->Places.push_back(
                { Inadmissible::Reason::Cycle, relation.Where.Cell, relation.Where.Side });
              return;
            }
          }
          if (stack.back() != at)
          {
            continue;
          }
        }
        this->Rows[at] = Sum(relation.Value, this->Rows);
        states[at] = State::Done;
        stack.pop_back();
      }
    }
    for (const auto& [dependent, relations] : this->RelationsOf)
    {
      for (std::size_t i = 1; i < relations.size(); ++i)
      {
        Combination difference = relations[i].Value;
        for (auto& term : difference)
        {
          term.second = -term.second;
        }
        difference.emplace_back(dependent, 1.0);
        for (const auto& [function, weight] : Sum(difference, this->Rows))
        {
          if (std::fabs(weight) > RowRounding)
          {
            this->Places.push_back({ Inadmissible::Reason::Disagreement, relations[i].Where.Cell,
              relations[i].Where.Side });
            break;
          }
        }
      }
    }
    this->CheckCells();
  }

  /// Whether the functions alive on a cell are (p + 1)^Dim and independent there.
  bool IsIndependent(const int* classes) const
  {
    std::map<int, int> column;
    std::vector<const Combination*> combined;
    for (int a = 0; a < this->NumLocal; ++a)
    {
      const auto row = this->Rows.find(classes[a]);
      if (row == this->Rows.end())
      {
        // a function of its own: its column is this row's alone
        if (!column.emplace(classes[a], -1).second)
        {
          return false;
        }
      }
      else
      {
        combined.push_back(&row->second);
      }
    }
    int others = 0;
    for (const Combination* row : combined)
    {
      for (const auto& [function, weight] : *row)
      {
        others += column.emplace(function, others).second ? 1 : 0;
      }
    }
    if (others != static_cast<int>(combined.size()))
    {
      return false;
    }
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(others, others);
    for (std::size_t i = 0; i < combined.size(); ++i)
    {
      for (const auto& [function, weight] : *combined[i])
      {
        const int k = column[function];
        if (k >= 0)
        {
          matrix(static_cast<Eigen::Index>(i), k) = weight;
        }
      }
    }
    if (others == 0)
    {
      return true;
    }
    Eigen::FullPivLU<Eigen::MatrixXd> lu(matrix);
    lu.setThreshold(RowRounding);
    return lu.isInvertible();
  }

  void CheckCells()
  {
    std::vector<int> seen(At(this->NumClasses), -1);
    std::vector<char> isDependent(At(this->NumClasses), 0);
    for (const auto& [dependent, row] : this->Rows)
    {
      isDependent[At(dependent)] = 1;
    }
    for (int c = 0; c < this->Data->Topology.NumCells(); ++c)
    {
      const int* classes = this->Ids.data() + At(c) * At(this->NumLocal);
      bool isPlain = true;
      bool isGood = true;
      for (int a = 0; a < this->NumLocal; ++a)
      {
        const std::size_t k = At(classes[a]);
        isPlain = isPlain && isDependent[k] == 0;
        isGood = isGood && seen[k] != c;
        seen[k] = c;
      }
      if (!isGood || (!isPlain && !this->IsIndependent(classes)))
      {
        this->Places.push_back({ Inadmissible::Reason::Dependence, c, -1 });
      }
    }
  }

  std::shared_ptr<SplineSpace<Dim>> Finish()
  {
    auto space = std::make_shared<SplineSpace<Dim>>();
    space->Kind = SpaceKind::Unstructured;
    space->NumLocalFunctions = this->NumClasses;
    space->NumFunctions = this->NumClasses - static_cast<int>(this->Rows.size());
    if (!this->Rows.empty())
    {
      std::vector<int> number(At(this->NumClasses));
      int next = 0;
      std::size_t entries = 0;
      for (int k = 0; k < this->NumClasses; ++k)
      {
        const auto row = this->Rows.find(k);
        number[At(k)] = row == this->Rows.end() ? next++ : -1;
        entries += row == this->Rows.end() ? 1 : row->second.size();
      }
      space->RowStart.reserve(At(this->NumClasses) + 1);
      space->RowFunction.reserve(entries);
      space->RowCoefficient.reserve(entries);
      space->RowStart.push_back(0);
      auto row = this->Rows.begin();
      for (int k = 0; k < this->NumClasses; ++k)
      {
        if (number[At(k)] >= 0)
        {
          space->RowFunction.push_back(number[At(k)]);
          space->RowCoefficient.push_back(1.0);
        }
        else
        {
          for (const auto& [function, weight] : row->second)
          {
            space->RowFunction.push_back(number[At(function)]);
            space->RowCoefficient.push_back(weight);
          }
          ++row;
        }
        space->RowStart.push_back(space->RowFunction.size());
      }
    }
    FactorPool pool(space->FactorData);
    std::vector<int> factors;
    for (int w = 0; w < this->Windows.Count(); ++w)
    {
      double matrix[(MaxDegree + 1) * (MaxDegree + 1)];
      this->Windows.Extraction(w, matrix);
      factors.push_back(pool.Add(this->P, matrix));
    }
    space->Elements.resize(At(this->Data->Topology.NumCells()));
    for (std::size_t e = 0; e < space->Elements.size(); ++e)
    {
      auto& element = space->Elements[e];
      element.Degree.fill(this->P);
      element.Box.Upper.fill(1.0);
      element.FirstLocal = e * At(this->NumLocal);
      for (std::size_t d = 0; d < Dim; ++d)
      {
        element.Factor[d] = factors[At(this->WindowOf[e * Dim + d])];
      }
    }
    space->LocalFunctionIds = std::move(this->Ids);
    return space;
  }

  std::shared_ptr<const UnstructuredData<Dim>> Data;
  int P;
  int NumLocal;
  KnotWindows Windows;
  std::vector<int> WindowOf; ///< Dim a cell
  std::vector<std::vector<std::array<int, 2>>> PairTable;
  std::vector<int> Ids; ///< NumLocal a cell
  DisjointSets Classes;
  std::vector<Facet> Unequal;
  std::vector<int> ClassOf;
  int NumClasses = 0;
  std::map<int, std::vector<Relation>> RelationsOf;
  std::map<int, Combination> Rows; ///< of the dependent classes
  std::vector<Inadmissible> Places;
};
}

std::string Describe(const Inadmissible& place)
{
  const std::string where = place.Side < 0
    ? "on cell " + std::to_string(place.Cell)
    : "across side " + std::to_string(place.Side) + " of cell " + std::to_string(place.Cell);
  switch (place.Why)
  {
    case Inadmissible::Reason::Negative:
      return where + " neither cell's functions are averages of the other's";
    case Inadmissible::Reason::Cycle:
      return where + " functions depend on each other in a circle";
    case Inadmissible::Reason::Disagreement:
      return where + " functions would have to meet more conditions than they can";
    case Inadmissible::Reason::Dependence:
      break;
  }
  return where + " the functions are not independent";
}

namespace
{
/// Topology, continuities and lengths in another order of the cells: what the builder takes.
template <int Dim>
std::shared_ptr<const UnstructuredData<Dim>> Reordered(
  const UnstructuredData<Dim>& data, const std::vector<int>& order)
{
  auto made = std::make_shared<UnstructuredData<Dim>>();
  made->Topology = data.Topology.Reordered(order);
  made->Degree = data.Degree;
  made->Lengths = data.Lengths;
  made->Sheets.Count = data.Sheets.Count;
  made->Sheets.Of.resize(data.Sheets.Of.size());
  made->Continuity.resize(data.Continuity.size());
  for (std::size_t c = 0; c < order.size(); ++c)
  {
    const std::size_t old = At(order[c]);
    std::copy_n(data.Continuity.begin() + static_cast<std::ptrdiff_t>(old * 2 * Dim), 2 * Dim,
      made->Continuity.begin() + static_cast<std::ptrdiff_t>(c * 2 * Dim));
    for (std::size_t d = 0; !made->Sheets.Of.empty() && d < Dim; ++d)
    {
      made->Sheets.Of[c * Dim + d] = data.Sheets.Of[old * Dim + d];
    }
  }
  return made;
}

/// Gives the cells of a space their old order.
template <int Dim>
void RestoreOrder(const std::vector<int>& order, SplineSpace<Dim>& space)
{
  const std::size_t numLocal = space.LocalFunctionIds.size() / order.size();
  std::vector<typename SplineSpace<Dim>::Element> elements(order.size());
  std::vector<int> ids(space.LocalFunctionIds.size());
  for (std::size_t c = 0; c < order.size(); ++c)
  {
    const std::size_t old = At(order[c]);
    elements[old] = space.Elements[c];
    elements[old].FirstLocal = old * numLocal;
    std::copy_n(space.LocalFunctionIds.begin() + static_cast<std::ptrdiff_t>(c * numLocal),
      numLocal, ids.begin() + static_cast<std::ptrdiff_t>(old * numLocal));
  }
  space.Elements = std::move(elements);
  space.LocalFunctionIds = std::move(ids);
}
}

template <int Dim>
UnstructuredBuild<Dim> BuildUnstructured(std::shared_ptr<const UnstructuredData<Dim>> data)
{
  // cells whose neighbours are far away in memory are worth being sorted
  const std::vector<int> order = data->Topology.LocalOrder();
  MeshSpaceAssembly<Dim> assembly(order.empty() ? data : Reordered(*data, order));
  UnstructuredBuild<Dim> result;
  const std::shared_ptr<SplineSpace<Dim>> space = assembly.Run();
  result.Places = assembly.Found();
  if (!order.empty())
  {
    for (Inadmissible& place : result.Places)
    {
      place.Cell = order[At(place.Cell)];
    }
    if (space)
    {
      RestoreOrder(order, *space);
    }
  }
  if (space)
  {
    space->Unstructured = std::move(data);
  }
  result.Space = space;
  return result;
}

template UnstructuredBuild<2> BuildUnstructured<2>(std::shared_ptr<const UnstructuredData<2>>);
template UnstructuredBuild<3> BuildUnstructured<3>(std::shared_ptr<const UnstructuredData<3>>);
}
