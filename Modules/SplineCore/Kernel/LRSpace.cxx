// SPDX-License-Identifier: BSD-3-Clause
#include "LRSpace.h"

#include "LRLineRows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace knotwork
{
namespace
{
constexpr double UnityTolerance = 1e-9;
constexpr std::size_t MaxOverload = 16; // functions on an element on average, over (p + 1)(q + 1)

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

Status CheckLines(const LRBasis& basis)
{
  for (int d = 0; d < 2; ++d)
  {
    const int p = basis.Degree[At(d)];
    if (p < 1 || p > MaxDegree)
    {
      return { ErrorCode::InvalidDegree, "degree " + std::to_string(p) };
    }
    const std::vector<double>& knots = basis.Knots[At(d)];
    const std::string where = "direction " + std::to_string(d) + ": ";
    if (knots.size() < 2 || knots.size() > At(std::numeric_limits<int>::max()))
    {
      return { ErrorCode::InvalidKnots, where + "it needs at least two distinct knots" };
    }
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      if (!std::isfinite(knots[k]) || (k > 0 && !(knots[k] > knots[k - 1])))
      {
        return { ErrorCode::InvalidKnots,
          where + "knot " + std::to_string(k) + " is not finite or not above the one before" };
      }
    }
    if (basis.Lines[At(d)].size() != knots.size())
    {
      return { ErrorCode::SizeMismatch, where + "there must be one line a knot" };
    }
    const auto end = static_cast<int>(basis.Knots[At(1 - d)].size()) - 1;
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      const LRLine& line = basis.Lines[At(d)][k];
      const std::string what = where + "line " + std::to_string(k);
      if (line.empty() || line.front().Knot != 0)
      {
        return { ErrorCode::InvalidTopology, what + " does not start at knot 0" };
      }
      for (std::size_t i = 0; i < line.size(); ++i)
      {
        if (line[i].Knot >= end || line[i].Multiplicity < 0 || line[i].Multiplicity > p + 1 ||
          (i > 0 &&
            (line[i].Knot <= line[i - 1].Knot || line[i].Multiplicity == line[i - 1].Multiplicity)))
        {
          return { ErrorCode::InvalidTopology,
            what + ", piece " + std::to_string(i) + " is out of order or out of range" };
        }
      }
      if ((k == 0 || k + 1 == knots.size()) && line != LRLine{ { 0, p + 1 } })
      {
        return { ErrorCode::InvalidTopology,
          what + " is an end of the domain and must have multiplicity " + std::to_string(p + 1) +
            " all along" };
      }
    }
  }
  return {};
}

/// The function's knots are lines across its support as often as it says, and all such lines are
/// among its knots.
Status CheckMinimalSupport(const LRBasis& basis, int f)
{
  const auto fail = [&](const std::string& what)
  { return Status(ErrorCode::InvalidTopology, "function " + std::to_string(f) + " " + what); };
  for (int d = 0; d < 2; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    if (knots[0] < 0 || knots[last] >= static_cast<int>(basis.Knots[At(d)].size()) ||
      knots[0] >= knots[last] || !std::is_sorted(knots, knots + last + 1))
    {
      return fail("has knots out of order or out of range");
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    const int low = basis.Local(f, 1 - d)[0];
    const int high = basis.Local(f, 1 - d)[basis.Degree[At(1 - d)] + 1];
    for (int k = knots[0]; k <= knots[last]; ++k)
    {
      const auto has = static_cast<int>(std::count(knots, knots + last + 1, k));
      const LRLine& line = basis.Lines[At(d)][At(k)];
      if (has == 0 && line.size() == 1 && line[0].Multiplicity == 0)
      {
        continue;
      }
      const int there = LRMultiplicity(line, low, high);
      const bool isEnd = k == knots[0] || k == knots[last];
      if (there < has)
      {
        return fail("has a knot where no mesh line crosses its support");
      }
      if (!isEnd && there > has)
      {
        return fail("has not minimal support: a mesh line traverses it that is not its knot");
      }
    }
  }
  return {};
}

Status CheckFunctions(const LRBasis& basis)
{
  if (basis.LocalKnots.size() != basis.Scaling.size() * At(basis.Stride()) || basis.Scaling.empty())
  {
    return { ErrorCode::SizeMismatch, "local knots and scaling factors do not fit together" };
  }
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    if (!(basis.Scaling[At(f)] > 0.0) || !std::isfinite(basis.Scaling[At(f)]))
    {
      return { ErrorCode::InvalidParameter,
        "the scaling factor of function " + std::to_string(f) + " is not positive" };
    }
    if (Status status = CheckMinimalSupport(basis, f); !status)
    {
      return status;
    }
    if (f > 0)
    {
      const int n0 = basis.Degree[0] + 2;
      const int n1 = basis.Degree[1] + 2;
      const auto key = [&](int i, int d) { return basis.Local(i, d); };
      const bool same = std::equal(key(f, 1), key(f, 1) + n1, key(f - 1, 1));
      const bool ascends = same
        ? std::lexicographical_compare(key(f - 1, 0), key(f - 1, 0) + n0, key(f, 0), key(f, 0) + n0)
        : std::lexicographical_compare(
            key(f - 1, 1), key(f - 1, 1) + n1, key(f, 1), key(f, 1) + n1);
      if (!ascends)
      {
        return { ErrorCode::InvalidTopology,
          "function " + std::to_string(f) + " is out of order or there twice" };
      }
    }
  }
  return {};
}

using LineRows = LRLineRows<double>;

void MakeRow(const LRBasis& basis, int direction, const int* knots, int low, int high, double* row)
{
  const std::vector<double>& t = basis.Knots[At(direction)];
  LRBlossomRow(
    basis.Degree[At(direction)], knots, low, high,
    [&t](int u, int lower, int upper, double a, double b)
    {
      return ((t[At(upper)] - t[At(u)]) * a + (t[At(u)] - t[At(lower)]) * b) /
        (t[At(upper)] - t[At(lower)]);
    },
    row);
}

/// A function on an element.
struct Incidence
{
  int Function;
  int RowU;
  int RowV;
};

/// Functions and rows of every element, functions ascending; fills AliveStart. Empty when there are
/// more than limit.
std::vector<Incidence> FindIncidences(
  LRData& data, std::array<LineRows, 2>& rows, std::size_t limit)
{
  const LRBasis& basis = data.Basis;
  const std::vector<std::array<int, 4>>& elements = data.ElementKnots;
  std::vector<std::size_t> first(basis.Knots[1].size() + 1, 0); // element of a height
  for (const auto& e : elements)
  {
    ++first[At(e[1]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());

  struct Pair
  {
    std::size_t Element;
    Incidence Item;
  };
  const auto make = [&basis](int d)
  {
    return [&basis, d](const int* knots, int low, int high, double* row)
    { MakeRow(basis, d, knots, low, high, row); };
  };
  std::vector<Pair> pairs;
  data.AliveStart.assign(elements.size() + 1, 0);
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    const int* u = basis.Local(f, 0);
    const int* v = basis.Local(f, 1);
    const int right = u[basis.Degree[0] + 1];
    for (int y = v[0]; y < v[basis.Degree[1] + 1]; ++y)
    {
      const auto end = elements.begin() + static_cast<std::ptrdiff_t>(first[At(y) + 1]);
      auto e = std::lower_bound(elements.begin() + static_cast<std::ptrdiff_t>(first[At(y)]), end,
        u[0], [](const auto& element, int x) { return element[0] < x; });
      for (; e != end && (*e)[0] < right; ++e)
      {
        const auto id = static_cast<std::size_t>(e - elements.begin());
        pairs.push_back({ id,
          { f, rows[0].Find(f, (*e)[0], (*e)[2], make(0)),
            rows[1].Find(f, (*e)[1], (*e)[3], make(1)) } });
        ++data.AliveStart[id + 1];
      }
    }
    if (pairs.size() > limit)
    {
      return {};
    }
  }
  std::partial_sum(data.AliveStart.begin(), data.AliveStart.end(), data.AliveStart.begin());
  std::vector<Incidence> incidences(pairs.size());
  std::vector<std::size_t> next(data.AliveStart.begin(), data.AliveStart.end() - 1);
  for (const Pair& pair : pairs)
  {
    incidences[next[pair.Element]++] = pair.Item;
  }
  return incidences;
}

/// The rows of T: Bernstein coefficients of all functions on all elements.
class RowBuilder
{
public:
  RowBuilder(SplineSpace<2>& space, LRData& data)
    : Space(space), Data(data), Rows{ LineRows(data.Basis, 0), LineRows(data.Basis, 1) },
      Incidences(FindIncidences(data, this->Rows, MostAlive(data))), N0(data.Basis.Degree[0] + 1),
      N1(data.Basis.Degree[1] + 1)
  {
  }

  Status Build()
  {
    if (this->Incidences.empty())
    {
      return { ErrorCode::TooLarge,
        "more than " + std::to_string(MostAlive(this->Data)) + " functions on elements" };
    }
    this->Data.AliveFunctions.reserve(this->Incidences.size());
    std::size_t entries = 0;
    for (const Incidence& item : this->Incidences)
    {
      this->Data.AliveFunctions.push_back(item.Function);
      entries += CountPositive(this->Rows[0].Row(item.RowU), this->N0) *
        CountPositive(this->Rows[1].Row(item.RowV), this->N1);
    }
    this->Space.RowFunction.resize(entries + 1);
    this->Space.RowCoefficient.resize(entries + 1);
    this->Space.RowStart.reserve(At(this->Space.NumLocalFunctions) + 1);
    this->Space.RowStart.push_back(0);
    for (std::size_t e = 0; e < this->Data.ElementKnots.size(); ++e)
    {
      if (const double off = this->AppendElement(e); !(off <= UnityTolerance))
      {
        return { ErrorCode::InvalidTopology,
          "the functions' sum on element " + std::to_string(e) + " is not 1" };
      }
    }
    this->Space.RowFunction.resize(this->Space.RowStart.back());
    this->Space.RowCoefficient.resize(this->Space.RowStart.back());
    return {};
  }

private:
  /// Functions on elements, counted by element: a bound on what damaged definitions may ask for.
  static std::size_t MostAlive(const LRData& data)
  {
    return MaxOverload * At(NumTensorFunctions<2>(data.Basis.Degree)) * data.ElementKnots.size();
  }

  static std::size_t CountPositive(const double* row, int n)
  {
    return At(static_cast<int>(std::count_if(row, row + n, [](double x) { return x > 0.0; })));
  }

  /// @return largest distance of a row's sum from 1.
  double AppendElement(std::size_t e)
  {
    const std::size_t first = this->Data.AliveStart[e];
    const std::size_t alive = this->Data.AliveStart[e + 1] - first;
    this->U.resize(alive * At(this->N0));
    this->V.resize(alive * At(this->N1));
    for (std::size_t k = 0; k < alive; ++k)
    {
      const Incidence& item = this->Incidences[first + k];
      const double gamma = this->Data.Basis.Scaling[At(item.Function)];
      const double* v = this->Rows[1].Row(item.RowV);
      std::copy_n(this->Rows[0].Row(item.RowU), this->N0, this->U.data() + k * At(this->N0));
      std::transform(v, v + this->N1, this->V.data() + k * At(this->N1),
        [gamma](double x) { return gamma * x; });
    }
    double off = 0.0;
    std::size_t next = this->Space.RowStart.back();
    for (int j = 0; j < this->N1; ++j)
    {
      for (int i = 0; i < this->N0; ++i)
      {
        const double* u = this->U.data() + i;
        const double* v = this->V.data() + j;
        double sum = 0.0;
        for (std::size_t k = first; k < first + alive; ++k, u += this->N0, v += this->N1)
        {
          // written in any case, kept when positive: a branch would be a matter of luck
          const double value = *u * *v;
          this->Space.RowFunction[next] = this->Incidences[k].Function;
          this->Space.RowCoefficient[next] = value;
          next += value > 0.0 ? 1 : 0;
          sum += value;
        }
        this->Space.RowStart.push_back(next);
        off = std::max(off, std::fabs(sum - 1.0));
      }
    }
    return off;
  }

  SplineSpace<2>& Space;
  LRData& Data;
  std::array<LineRows, 2> Rows;
  std::vector<Incidence> Incidences;
  int N0;
  int N1;
  std::vector<double> U; // rows of the alive functions, one after the other
  std::vector<double> V; // times the scaling factors
};

void AppendElements(SplineSpace<2>& space, LRData& data)
{
  const LRBasis& basis = data.Basis;
  const int perElement = NumTensorFunctions<2>(basis.Degree);
  const std::size_t numElements = data.ElementKnots.size();
  space.NumFunctions = basis.NumFunctions();
  space.NumLocalFunctions = perElement * static_cast<int>(numElements);
  space.LocalFunctionIds.resize(At(space.NumLocalFunctions));
  std::iota(space.LocalFunctionIds.begin(), space.LocalFunctionIds.end(), 0);
  space.Elements.resize(numElements);
  std::vector<ParametricBox<2>> boxes;
  boxes.reserve(numElements);
  for (std::size_t e = 0; e < numElements; ++e)
  {
    const std::array<int, 4>& corners = data.ElementKnots[e];
    auto& element = space.Elements[e];
    element.Degree = basis.Degree;
    element.FirstLocal = e * At(perElement);
    element.Factor.fill(-1);
    for (std::size_t d = 0; d < 2; ++d)
    {
      element.Box.Lower[d] = basis.Knots[d][At(corners[d])];
      element.Box.Upper[d] = basis.Knots[d][At(corners[d + 2])];
    }
    boxes.push_back(element.Box);
  }
  data.Locator =
    BoxLocator(space.Domain(), boxes, { basis.Knots[0].size() - 1, basis.Knots[1].size() - 1 });
}

Result<KnotVector> TensorKnots(const LRBasis& basis, int d)
{
  std::vector<double> knots;
  for (std::size_t k = 0; k < basis.Knots[At(d)].size(); ++k)
  {
    int most = 0;
    for (const LRPiece& piece : basis.Lines[At(d)][k])
    {
      most = std::max(most, piece.Multiplicity);
    }
    knots.insert(knots.end(), At(most), basis.Knots[At(d)][k]);
  }
  return KnotVector::Create(basis.Degree[At(d)], std::move(knots));
}
}

int LRMultiplicity(const LRLine& line, int low, int high)
{
  auto piece = std::upper_bound(line.begin(), line.end(), low,
                 [](int knot, const LRPiece& p) { return knot < p.Knot; }) -
    1;
  int least = piece->Multiplicity;
  for (++piece; piece != line.end() && piece->Knot < high; ++piece)
  {
    least = std::min(least, piece->Multiplicity);
  }
  return least;
}

Result<SplineSpacePtr<2>> MakeLRSpace(LRBasis basis)
{
  Status status = CheckLines(basis);
  if (status)
  {
    status = CheckFunctions(basis);
  }
  if (!status)
  {
    return status;
  }
  auto elements = LRElements(basis);
  if (!elements)
  {
    return elements.Status;
  }
  const auto limit = At(std::numeric_limits<int>::max() / NumTensorFunctions<2>(basis.Degree));
  if (elements.Value.size() > limit)
  {
    return { ErrorCode::TooLarge, std::to_string(elements.Value.size()) + " elements" };
  }
  auto space = std::make_shared<SplineSpace<2>>();
  auto data = std::make_shared<LRData>();
  space->Kind = SpaceKind::LocallyRefined;
  for (int d = 0; d < 2; ++d)
  {
    Result<KnotVector> knots = TensorKnots(basis, d);
    if (!knots)
    {
      return knots.Status;
    }
    space->Knots[At(d)] = std::move(knots.Value);
  }
  data->Basis = std::move(basis);
  data->ElementKnots = std::move(elements.Value);
  AppendElements(*space, *data);
  if (status = RowBuilder(*space, *data).Build(); !status)
  {
    return status;
  }
  space->LocallyRefined = std::move(data);
  return SplineSpacePtr<2>(std::move(space));
}

Result<LRBasis> LRBasisOfTensor(const SplineSpace<2>& space)
{
  if (space.Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "only a tensor-product space becomes locally refined" };
  }
  LRBasis basis;
  std::array<std::vector<int>, 2> ranks; // of every knot
  for (std::size_t d = 0; d < 2; ++d)
  {
    const KnotVector& knots = space.Knots[d];
    const int p = knots.Degree();
    basis.Degree[d] = p;
    basis.Knots[d] = knots.Breaks();
    if (knots.Knots().front() != knots.Begin() || knots.Knots().back() != knots.End() ||
      knots.Multiplicity(0) != p + 1 || knots.Multiplicity(knots.NumElements()) != p + 1)
    {
      return { ErrorCode::InvalidKnots,
        "the ends of direction " + std::to_string(d) + " must have multiplicity " +
          std::to_string(p + 1) + "; insert knots at the ends first" };
    }
    for (int b = 0; b <= knots.NumElements(); ++b)
    {
      basis.Lines[d].push_back({ { 0, knots.Multiplicity(b) } });
      ranks[d].insert(ranks[d].end(), At(knots.Multiplicity(b)), b);
    }
  }
  const int n0 = space.Knots[0].NumFunctions();
  const int n1 = space.Knots[1].NumFunctions();
  for (int j = 0; j < n1; ++j)
  {
    for (int i = 0; i < n0; ++i)
    {
      basis.LocalKnots.insert(
        basis.LocalKnots.end(), ranks[0].begin() + i, ranks[0].begin() + i + basis.Degree[0] + 2);
      basis.LocalKnots.insert(
        basis.LocalKnots.end(), ranks[1].begin() + j, ranks[1].begin() + j + basis.Degree[1] + 2);
    }
  }
  basis.Scaling.assign(At(n0) * At(n1), 1.0);
  return basis;
}
}
