// SPDX-License-Identifier: BSD-3-Clause
#include "LRVolume.h"

#include "LRLineRows.h"
#include "LRVolumeParts.h"
#include "Numbers.h"
#include "Parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace knotwork
{
namespace
{
constexpr double UnityTolerance = 1e-9;
constexpr std::size_t ElementChunk = 32;
constexpr std::size_t FunctionChunk = 256;
constexpr std::size_t MaxOverload = 16; // functions on an element on average, over those of a box

std::size_t At(std::ptrdiff_t i)
{
  return static_cast<std::size_t>(i);
}

std::size_t CellNumber(const LRVolumeBasis& basis, int i, int j, int k)
{
  return (At(k) * At(basis.Spans(1)) + At(j)) * At(basis.Spans(0)) + At(i);
}

/// Joins the cells of the grid between which there is no mesh rectangle.
class BoxFinder
{
public:
  explicit BoxFinder(LRVolume& volume) : Volume(volume), Basis(volume.Basis) {}

  Status Run()
  {
    const IntArray<3> spans{ this->Basis.Spans(0), this->Basis.Spans(1), this->Basis.Spans(2) };
    this->Volume.Cells.assign(At(spans[0]) * At(spans[1]) * At(spans[2]), -1);
    std::size_t cell = 0;
    for (int k = 0; k < spans[2]; ++k)
    {
      for (int j = 0; j < spans[1]; ++j)
      {
        for (int i = 0; i < spans[0]; ++i, ++cell)
        {
          if (this->Volume.Cells[cell] < 0 && !this->Grow({ i, j, k }))
          {
            return { ErrorCode::InvalidTopology,
              "a mesh rectangle ends inside an element near (" +
                Digits(this->Basis.Knots[0][At(i)]) + ", " + Digits(this->Basis.Knots[1][At(j)]) +
                ", " + Digits(this->Basis.Knots[2][At(k)]) + ")" };
          }
        }
      }
    }
    return {};
  }

private:
  bool Grow(const IntArray<3>& corner)
  {
    std::array<int, 6> box{ corner[0], corner[1], corner[2], corner[0], corner[1], corner[2] };
    for (int d = 0; d < 3; ++d)
    {
      const auto across = LRVolumeBasis::Across(d);
      const int a = corner[At(across[0])];
      const int b = corner[At(across[1])];
      int& end = box[At(d) + 3];
      do
      {
        ++end;
      } while (end < this->Basis.Spans(d) &&
        this->Basis.Faces[At(d)][this->Basis.FaceIndex(d, end, a, b)] == 0);
    }
    for (int d = 0; d < 3; ++d)
    {
      const auto across = LRVolumeBasis::Across(d);
      for (int plane = box[At(d)]; plane <= box[At(d) + 3]; ++plane)
      {
        const bool isSide = plane == box[At(d)] || plane == box[At(d) + 3];
        for (int b = box[At(across[1])]; b < box[At(across[1]) + 3]; ++b)
        {
          for (int a = box[At(across[0])]; a < box[At(across[0]) + 3]; ++a)
          {
            if ((this->Basis.Faces[At(d)][this->Basis.FaceIndex(d, plane, a, b)] > 0) != isSide)
            {
              return false;
            }
          }
        }
      }
    }
    const auto id = static_cast<int>(this->Volume.ElementKnots.size());
    for (int k = box[2]; k < box[5]; ++k)
    {
      for (int j = box[1]; j < box[4]; ++j)
      {
        const std::size_t row = CellNumber(this->Basis, 0, j, k);
        std::fill(this->Volume.Cells.begin() + static_cast<std::ptrdiff_t>(row) + box[0],
          this->Volume.Cells.begin() + static_cast<std::ptrdiff_t>(row) + box[3], id);
      }
    }
    this->Volume.ElementKnots.push_back(box);
    return true;
  }

  LRVolume& Volume;
  const LRVolumeBasis& Basis;
};

/// Calls use(element) for the elements of a function's support.
template <typename Use>
void ForEachElement(const LRVolume& volume, int function, Use&& use)
{
  const LRVolumeBasis& basis = volume.Basis;
  std::array<int, 6> box{};
  for (int d = 0; d < 3; ++d)
  {
    const int* knots = basis.Local(function, d);
    box[At(d)] = knots[0];
    box[At(d) + 3] = knots[basis.Degree[At(d)] + 1];
  }
  for (int k = box[2]; k < box[5]; ++k)
  {
    for (int j = box[1]; j < box[4]; ++j)
    {
      const std::size_t row = CellNumber(basis, 0, j, k);
      for (int i = box[0]; i < box[3];)
      {
        const int e = volume.Cells[row + At(i)];
        const std::array<int, 6>& element = volume.ElementKnots[At(e)];
        if (element[2] == k && element[1] == j)
        {
          use(e);
        }
        i = element[3];
      }
    }
  }
}

Status FindAlive(LRVolume& volume)
{
  const std::size_t limit =
    MaxOverload * At(NumTensorFunctions<3>(volume.Basis.Degree)) * volume.ElementKnots.size();
  volume.AliveStart.assign(volume.ElementKnots.size() + 1, 0);
  const int n = volume.Basis.NumFunctions();
  std::size_t total = 0;
  for (int f = 0; f < n && total <= limit; ++f)
  {
    ForEachElement(volume, f,
      [&](int e)
      {
        ++volume.AliveStart[At(e) + 1];
        ++total;
      });
  }
  if (total > limit)
  {
    return { ErrorCode::TooLarge, "more than " + std::to_string(limit) + " functions on elements" };
  }
  std::partial_sum(volume.AliveStart.begin(), volume.AliveStart.end(), volume.AliveStart.begin());
  volume.AliveFunctions.resize(total);
  std::vector<std::size_t> next(volume.AliveStart.begin(), volume.AliveStart.end() - 1);
  for (int f = 0; f < n; ++f)
  {
    ForEachElement(volume, f, [&](int e) { volume.AliveFunctions[next[At(e)]++] = f; });
  }
  return {};
}

/// The rows of T: Bernstein coefficients of all functions on all elements.
class RowBuilder
{
public:
  RowBuilder(SplineSpace<3>& space, const LRVolume& volume, int threads)
    : Space(space), Volume(volume), Threads(threads)
  {
  }

  Status Build()
  {
    ParallelFor(3, 1, this->Threads,
      [this](std::size_t d, std::size_t) { this->FindLineRows(static_cast<int>(d)); });
    const std::size_t n = this->Volume.ElementKnots.size();
    this->First.assign(n + 1, 0);
    ParallelFor(n, ElementChunk, this->Threads,
      [this](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          std::size_t entries = 0;
          this->ForEachEntry(e, [&entries](std::size_t, int, double) { ++entries; });
          this->First[e + 1] = entries;
        }
      });
    std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
    this->Space.RowFunction.resize(this->First.back());
    this->Space.RowCoefficient.resize(this->First.back());
    this->Space.RowStart.resize(At(this->Space.NumLocalFunctions) + 1);
    this->Space.RowStart.back() = this->First.back();
    std::vector<double> off(n, 0.0);
    ParallelFor(n, ElementChunk, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          off[e] = this->WriteElement(e);
        }
      });
    const auto bad =
      std::find_if(off.begin(), off.end(), [](double x) { return !(x <= UnityTolerance); });
    if (bad != off.end())
    {
      return { ErrorCode::InvalidTopology,
        "the functions' sum on element " + std::to_string(bad - off.begin()) + " is not 1" };
    }
    return {};
  }

private:
  void FindLineRows(int d)
  {
    const LRVolumeBasis& basis = this->Volume.Basis;
    auto& lines = this->Lines[At(d)].emplace(basis, d);
    std::vector<int>& numbers = this->Numbers[At(d)];
    numbers.resize(this->Volume.AliveFunctions.size());
    for (std::size_t e = 0; e < this->Volume.ElementKnots.size(); ++e)
    {
      const std::array<int, 6>& box = this->Volume.ElementKnots[e];
      for (std::size_t k = this->Volume.AliveStart[e]; k < this->Volume.AliveStart[e + 1]; ++k)
      {
        numbers[k] = lines.Number(this->Volume.AliveFunctions[k], box[At(d)], box[At(d) + 3]);
      }
    }
    lines.Allocate();
    const std::vector<double>& t = basis.Knots[At(d)];
    lines.Fill(0, lines.Size(),
      [&](const int* knots, int low, int high, double* row)
      {
        LRBlossomRow(
          basis.Degree[At(d)], knots, low, high,
          [&t](int u, int lower, int upper, double a, double b)
          {
            return ((t[At(upper)] - t[At(u)]) * a + (t[At(u)] - t[At(lower)]) * b) /
              (t[At(upper)] - t[At(lower)]);
          },
          row);
      });
  }

  /// Calls use(polynomial, function, coefficient) for what is positive, by polynomials.
  template <typename Use>
  void ForEachEntry(std::size_t e, Use&& use) const
  {
    const IntArray<3>& p = this->Volume.Basis.Degree;
    const std::size_t first = this->Volume.AliveStart[e];
    const std::size_t last = this->Volume.AliveStart[e + 1];
    std::size_t polynomial = 0;
    for (int k = 0; k <= p[2]; ++k)
    {
      for (int j = 0; j <= p[1]; ++j)
      {
        for (int i = 0; i <= p[0]; ++i, ++polynomial)
        {
          for (std::size_t a = first; a < last; ++a)
          {
            const double w = this->Lines[2]->Row(this->Numbers[2][a])[k];
            const double v = w > 0.0 ? this->Lines[1]->Row(this->Numbers[1][a])[j] : 0.0;
            const double u = v > 0.0 ? this->Lines[0]->Row(this->Numbers[0][a])[i] : 0.0;
            if (u > 0.0)
            {
              const int f = this->Volume.AliveFunctions[a];
              use(polynomial, f, this->Volume.Basis.Scaling[At(f)] * (u * v * w));
            }
          }
        }
      }
    }
  }

  /// @return largest distance of a row's sum from 1.
  double WriteElement(std::size_t e)
  {
    std::size_t entry = this->First[e];
    const auto n = At(NumTensorFunctions<3>(this->Volume.Basis.Degree));
    std::vector<double> sums(n, 0.0);
    std::vector<std::size_t> counts(n, 0);
    this->ForEachEntry(e,
      [&](std::size_t polynomial, int function, double coefficient)
      {
        this->Space.RowFunction[entry] = function;
        this->Space.RowCoefficient[entry++] = coefficient;
        sums[polynomial] += coefficient;
        ++counts[polynomial];
      });
    double off = 0.0;
    std::size_t begin = this->First[e];
    for (std::size_t b = 0; b < n; ++b)
    {
      this->Space.RowStart[this->Space.Elements[e].FirstLocal + b] = begin;
      begin += counts[b];
      off = std::max(off, std::fabs(sums[b] - 1.0));
    }
    return off;
  }

  SplineSpace<3>& Space;
  const LRVolume& Volume;
  int Threads;
  std::array<std::optional<LRLineRows<double, LRVolumeBasis>>, 3> Lines;
  std::array<std::vector<int>, 3> Numbers; // of the rows of the functions on the elements
  std::vector<std::size_t> First;          // entry of T of every element
};

void AppendElements(SplineSpace<3>& space, const LRVolume& volume)
{
  const LRVolumeBasis& basis = volume.Basis;
  const int perElement = NumTensorFunctions<3>(basis.Degree);
  space.NumFunctions = basis.NumFunctions();
  space.NumLocalFunctions = perElement * static_cast<int>(volume.ElementKnots.size());
  space.LocalFunctionIds.resize(At(space.NumLocalFunctions));
  std::iota(space.LocalFunctionIds.begin(), space.LocalFunctionIds.end(), 0);
  space.Elements.resize(volume.ElementKnots.size());
  for (std::size_t e = 0; e < space.Elements.size(); ++e)
  {
    auto& element = space.Elements[e];
    element.Degree = basis.Degree;
    element.FirstLocal = e * At(perElement);
    element.Factor.fill(-1);
    for (std::size_t d = 0; d < 3; ++d)
    {
      element.Box.Lower[d] = basis.Knots[d][At(volume.ElementKnots[e][d])];
      element.Box.Upper[d] = basis.Knots[d][At(volume.ElementKnots[e][d + 3])];
    }
  }
}

Result<KnotVector> TensorKnots(const LRVolumeBasis& basis, int d)
{
  std::vector<double> knots;
  const std::vector<std::uint8_t>& faces = basis.Faces[At(d)];
  const std::size_t plane = faces.size() / basis.Knots[At(d)].size();
  for (std::size_t k = 0; k < basis.Knots[At(d)].size(); ++k)
  {
    const auto begin = faces.begin() + static_cast<std::ptrdiff_t>(k * plane);
    const auto most = *std::max_element(begin, begin + static_cast<std::ptrdiff_t>(plane));
    knots.insert(knots.end(), most, basis.Knots[At(d)][k]);
  }
  return KnotVector::Create(basis.Degree[At(d)], std::move(knots));
}

Status CheckMesh(const LRVolumeBasis& basis)
{
  for (int d = 0; d < 3; ++d)
  {
    const int p = basis.Degree[At(d)];
    const std::vector<double>& knots = basis.Knots[At(d)];
    const std::string where = "direction " + std::to_string(d) + ": ";
    if (p < 1 || p > MaxDegree)
    {
      return { ErrorCode::InvalidDegree, "degree " + std::to_string(p) };
    }
    if (knots.size() < 2)
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
  }
  if (Status status = CheckLRVolumeSize(basis); !status)
  {
    return status;
  }
  for (int d = 0; d < 3; ++d)
  {
    const auto [a, b] = LRVolumeBasis::Across(d);
    const std::size_t plane = At(basis.Spans(a)) * At(basis.Spans(b));
    const std::vector<std::uint8_t>& faces = basis.Faces[At(d)];
    const std::string where = "direction " + std::to_string(d) + ": ";
    const int full = basis.Degree[At(d)] + 1;
    if (faces.size() != plane * basis.Knots[At(d)].size())
    {
      return { ErrorCode::SizeMismatch, where + "there must be one multiplicity a face" };
    }
    const auto isFull = [full](std::uint8_t m) { return m == full; };
    const auto end = static_cast<std::ptrdiff_t>(plane);
    if (!std::all_of(faces.begin(), faces.begin() + end, isFull) ||
      !std::all_of(faces.end() - end, faces.end(), isFull))
    {
      return { ErrorCode::InvalidTopology,
        where + "the ends of the domain must have multiplicity " + std::to_string(full) +
          " all over" };
    }
    if (std::any_of(faces.begin(), faces.end(), [full](std::uint8_t m) { return m > full; }))
    {
      return { ErrorCode::InvalidTopology, where + "a multiplicity is above degree + 1" };
    }
  }
  return {};
}

Status CheckFunction(const LRVolumeBasis& basis, int f)
{
  const auto fail = [f](const std::string& what)
  { return Status(ErrorCode::InvalidTopology, "function " + std::to_string(f) + " " + what); };
  if (!(basis.Scaling[At(f)] > 0.0) || !std::isfinite(basis.Scaling[At(f)]))
  {
    return { ErrorCode::InvalidParameter,
      "the scaling factor of function " + std::to_string(f) + " is not positive" };
  }
  for (int d = 0; d < 3; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    if (knots[0] < 0 || knots[last] > basis.Spans(d) || knots[0] >= knots[last] ||
      !std::is_sorted(knots, knots + last + 1))
    {
      return fail("has knots out of order or out of range");
    }
  }
  for (int d = 0; d < 3; ++d)
  {
    const int last = basis.Degree[At(d)] + 1;
    const int* knots = basis.Local(f, d);
    for (int k = knots[0]; k <= knots[last]; ++k)
    {
      const auto has = static_cast<int>(std::count(knots, knots + last + 1, k));
      const LRCrossSection section = CrossSectionOf(basis, basis.Local(f, 0), d, k);
      if (has > 0 && !Exceeds(basis, section, has - 1))
      {
        return fail("has a knot where no mesh rectangle crosses its support");
      }
      if (k != knots[0] && k != knots[last] && Exceeds(basis, section, has))
      {
        return fail("has not minimal support: mesh rectangles traverse it that are not its knots");
      }
    }
  }
  for (int d = 2; f > 0 && d >= 0; --d)
  {
    const int n = basis.Degree[At(d)] + 2;
    const int* before = basis.Local(f - 1, d);
    const int* own = basis.Local(f, d);
    if (!std::equal(own, own + n, before))
    {
      return std::lexicographical_compare(before, before + n, own, own + n)
        ? Status()
        : fail("is out of order");
    }
    if (d == 0)
    {
      return fail("is there twice");
    }
  }
  return {};
}

Status CheckFunctions(const LRVolumeBasis& basis, int threads)
{
  const std::size_t n = basis.Scaling.size();
  if (n == 0 || basis.LocalKnots.size() != n * At(basis.Stride()))
  {
    return { ErrorCode::SizeMismatch, "local knots and scaling factors do not fit together" };
  }
  std::vector<Status> first((n + FunctionChunk - 1) / FunctionChunk); // of every chunk
  ParallelFor(n, FunctionChunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Status& status = first[begin / FunctionChunk];
      for (std::size_t f = begin; f < end && status; ++f)
      {
        status = CheckFunction(basis, static_cast<int>(f));
      }
    });
  const auto bad =
    std::find_if(first.begin(), first.end(), [](const Status& status) { return !status; });
  return bad == first.end() ? Status() : *bad;
}
}

LRCrossSection CrossSectionOf(const LRVolumeBasis& basis, const int* local, int d, int plane)
{
  LRCrossSection section{ d, plane, {}, {} };
  const auto across = LRVolumeBasis::Across(d);
  for (std::size_t i = 0; i < 2; ++i)
  {
    const int e = across[i];
    const int* knots =
      local + (e > 0 ? basis.Degree[0] + 2 : 0) + (e > 1 ? basis.Degree[1] + 2 : 0);
    section.Lower[i] = knots[0];
    section.Upper[i] = knots[basis.Degree[At(e)] + 1];
  }
  return section;
}

bool Exceeds(const LRVolumeBasis& basis, const LRCrossSection& section, int multiplicity)
{
  const int d = section.Direction;
  for (int b = section.Lower[1]; b < section.Upper[1]; ++b)
  {
    const std::uint8_t* row = basis.Faces[At(d)].data() + basis.FaceIndex(d, section.Plane, 0, b);
    for (int a = section.Lower[0]; a < section.Upper[0]; ++a)
    {
      if (row[a] <= multiplicity)
      {
        return false;
      }
    }
  }
  return true;
}

const LRVolume& LRVolumeOf(const SplineSpace<3>& space)
{
  return static_cast<const LRVolumeData&>(*space.LocallyRefined).Volume;
}

Status CheckLRVolumeSize(const LRVolumeBasis& basis)
{
  const double cells =
    static_cast<double>(basis.Spans(0)) * basis.Spans(1) * static_cast<double>(basis.Spans(2));
  return cells <= static_cast<double>(MaxLRVolumeCells)
    ? Status()
    : Status(ErrorCode::TooLarge,
        "the grid of all knots has " + Digits(cells) + " cells; at most " +
          std::to_string(MaxLRVolumeCells) + " are possible");
}

Result<SplineSpacePtr<3>> MakeLRVolumeSpace(LRVolumeBasis basis, int threads)
{
  Status status = CheckMesh(basis);
  status = status ? CheckFunctions(basis, threads) : status;
  return status ? AssembleLRVolume(std::move(basis), threads) : status;
}

Result<SplineSpacePtr<3>> AssembleLRVolume(LRVolumeBasis basis, int threads)
{
  auto space = std::make_shared<SplineSpace<3>>();
  auto data = std::make_shared<LRVolumeData>();
  LRVolume& volume = data->Volume;
  volume.Basis = std::move(basis);
  space->Kind = SpaceKind::LocallyRefined;
  for (int d = 0; d < 3; ++d)
  {
    Result<KnotVector> knots = TensorKnots(volume.Basis, d);
    if (!knots)
    {
      return knots.Status;
    }
    space->Knots[At(d)] = std::move(knots.Value);
  }
  if (Status status = BoxFinder(volume).Run(); !status)
  {
    return status;
  }
  const auto limit =
    At(std::numeric_limits<int>::max() / NumTensorFunctions<3>(volume.Basis.Degree));
  if (volume.ElementKnots.size() > limit)
  {
    return { ErrorCode::TooLarge, std::to_string(volume.ElementKnots.size()) + " elements" };
  }
  AppendElements(*space, volume);
  Status status = FindAlive(volume);
  status = status ? RowBuilder(*space, volume, threads).Build() : status;
  if (!status)
  {
    return status;
  }
  space->LocallyRefined = std::move(data);
  return SplineSpacePtr<3>(std::move(space));
}

Result<LRVolumeBasis> LRVolumeBasisOfTensor(const SplineSpace<3>& space)
{
  if (space.Kind != SpaceKind::Tensor)
  {
    return { ErrorCode::DimensionMismatch, "only a tensor-product space becomes locally refined" };
  }
  LRVolumeBasis basis;
  std::array<std::vector<int>, 3> ranks; // of every knot
  for (std::size_t d = 0; d < 3; ++d)
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
      ranks[d].insert(ranks[d].end(), At(knots.Multiplicity(b)), b);
    }
  }
  if (Status status = CheckLRVolumeSize(basis); !status)
  {
    return status;
  }
  for (int d = 0; d < 3; ++d)
  {
    const auto [a, b] = LRVolumeBasis::Across(d);
    const std::size_t plane = At(basis.Spans(a)) * At(basis.Spans(b));
    for (int k = 0; k <= basis.Spans(d); ++k)
    {
      basis.Faces[At(d)].insert(basis.Faces[At(d)].end(), plane,
        static_cast<std::uint8_t>(space.Knots[At(d)].Multiplicity(k)));
    }
  }
  const IntArray<3> n{ space.Knots[0].NumFunctions(), space.Knots[1].NumFunctions(),
    space.Knots[2].NumFunctions() };
  for (int f = 0; f < n[0] * n[1] * n[2]; ++f)
  {
    const IntArray<3> index{ f % n[0], f / n[0] % n[1], f / n[0] / n[1] };
    for (std::size_t d = 0; d < 3; ++d)
    {
      const auto begin = ranks[d].begin() + index[d];
      basis.LocalKnots.insert(basis.LocalKnots.end(), begin, begin + basis.Degree[d] + 2);
    }
  }
  basis.Scaling.assign(At(n[0]) * At(n[1]) * At(n[2]), 1.0);
  return basis;
}
}
