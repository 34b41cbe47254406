// SPDX-License-Identifier: BSD-3-Clause
#include "BezierRefinement.h"

#include "Bernstein.h"
#include "BezierSpace.h"

#include <algorithm>
#include <map>

namespace knotwork
{
namespace
{
/// Numbers the points of finer lattices on glued Bezier elements. Points inside a vertex, edge or
/// face belong to the list of functions that the elements share there, read in the one of its
/// orientations that comes first, so every element finds the same numbers.
template <int Dim>
class LatticeNumbers
{
public:
  /// Ids of the lattice with steps[d] + 1 points a direction on an element whose functions are ids.
  std::vector<int> Number(const IntArray<Dim>& degree, const int* ids, const IntArray<Dim>& steps)
  {
    std::vector<int> result(static_cast<std::size_t>(NumTensorFunctions<Dim>(steps)));
    for (auto& entity : this->Cached)
    {
      entity.Known = false;
    }
    IntArray<Dim> x{};
    for (int& id : result)
    {
      std::size_t code = 0; // base 3: 0 lower, 1 upper, 2 inside
      std::size_t unit = 1;
      for (std::size_t d = 0; d < Dim; ++d, unit *= 3)
      {
        code += unit * (x[d] == 0 ? 0 : x[d] == steps[d] ? 1 : 2);
      }
      Entity& entity = this->Cached[code];
      if (!entity.Known)
      {
        this->Identify(entity, code, degree, ids, steps);
      }
      int offset = 0;
      int stride = 1;
      for (std::size_t j = 0; j < entity.NumFree; ++j)
      {
        const std::size_t d = entity.Axis[j];
        const int inside = (entity.Flip[j] ? steps[d] - x[d] : x[d]) - 1;
        offset += stride * inside;
        stride *= steps[d] - 1;
      }
      id = entity.First + offset;
      for (std::size_t d = 0; d < Dim && ++x[d] > steps[d]; ++d)
      {
        x[d] = 0;
      }
    }
    return result;
  }
  int Count() const { return this->Next; }

private:
  struct Entity
  {
    bool Known = false;
    int First = 0;
    std::size_t NumFree = 0;
    std::array<std::size_t, Dim> Axis{}; ///< of the j-th direction in the chosen orientation
    std::array<bool, Dim> Flip{};
  };

  void Identify(Entity& entity, std::size_t code, const IntArray<Dim>& degree, const int* ids,
    const IntArray<Dim>& steps)
  {
    entity.Known = true;
    entity.NumFree = 0;
    std::array<int, Dim> stride{};
    int corner = 0;
    int next = 1;
    for (std::size_t d = 0; d < Dim; ++d, code /= 3)
    {
      stride[d] = next;
      next *= degree[d] + 1;
      if (code % 3 == 2)
      {
        entity.Axis[entity.NumFree++] = d;
      }
      else
      {
        corner += code % 3 == 1 ? degree[d] * stride[d] : 0;
      }
    }
    int inside = 1;
    for (std::size_t j = 0; j < entity.NumFree; ++j)
    {
      inside *= steps[entity.Axis[j]] - 1;
    }
    entity.Flip.fill(false);
    if (entity.NumFree == Dim) // nobody else's
    {
      entity.First = this->Next;
      this->Next += inside;
      return;
    }
    std::vector<int> best;
    std::array<std::size_t, Dim> axis = entity.Axis;
    do
    {
      for (std::size_t flips = 0; flips < (std::size_t{ 1 } << entity.NumFree); ++flips)
      {
        const std::vector<int> key = Read(axis, flips, entity.NumFree, corner, degree, stride, ids);
        if (best.empty() || key < best)
        {
          best = key;
          entity.Axis = axis;
          for (std::size_t j = 0; j < entity.NumFree; ++j)
          {
            entity.Flip[j] = (flips >> j & 1) != 0;
          }
        }
      }
    } while (std::next_permutation(
      axis.begin(), axis.begin() + static_cast<std::ptrdiff_t>(entity.NumFree)));
    const auto [position, isNew] = this->Firsts.emplace(best, this->Next);
    entity.First = position->second;
    this->Next += isNew ? inside : 0;
  }

  /// Degrees and function ids of an entity in one orientation.
  static std::vector<int> Read(const std::array<std::size_t, Dim>& axis, std::size_t flips,
    std::size_t numFree, int corner, const IntArray<Dim>& degree,
    const std::array<int, Dim>& stride, const int* ids)
  {
    std::vector<int> key;
    std::size_t count = 1;
    for (std::size_t j = 0; j < numFree; ++j)
    {
      key.push_back(degree[axis[j]]);
      count *= static_cast<std::size_t>(degree[axis[j]] + 1);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      int rest = static_cast<int>(i);
      int at = corner;
      for (std::size_t j = 0; j < numFree; ++j)
      {
        const int p = degree[axis[j]];
        const int k = rest % (p + 1);
        rest /= p + 1;
        at += ((flips >> j & 1) != 0 ? p - k : k) * stride[axis[j]];
      }
      key.push_back(ids[at]);
    }
    return key;
  }

  int Next = 0;
  std::map<std::vector<int>, int> Firsts;
  std::array<Entity, Dim == 1 ? 3 : Dim == 2 ? 9 : 27> Cached;
};

/// The pieces of an element, and their lattice: what splitting and elevation differ in.
template <int Dim>
struct Lattice
{
  IntArray<Dim> Steps;       ///< points a direction - 1
  IntArray<Dim> PieceDegree; ///< of the pieces that cover the lattice
  IntArray<Dim> Pieces;      ///< a direction
};

template <int Dim, typename MakeLattice, typename Coefficients>
Result<RefinedSpline<Dim>> Rebuild(
  const Spline<Dim>& spline, MakeLattice makeLattice, Coefficients coefficients)
{
  const SplineSpace<Dim>& space = *spline.Space;
  const PointMatrix old = spline.HomogeneousPoints();
  LatticeNumbers<Dim> numbers;
  RefinedSpline<Dim> result;
  std::vector<IntArray<Dim>> degrees;
  std::vector<int> pieceIds;
  std::vector<double> points; // rows of old.cols()
  const std::size_t columns = static_cast<std::size_t>(old.cols());
  std::vector<char> isSet;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    const int* ids = space.LocalFunctions(e);
    const int count = NumTensorFunctions<Dim>(element.Degree);
    std::vector<int> sorted(ids, ids + count);
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    {
      return { ErrorCode::InvalidTopology,
        "element " + std::to_string(e) + " has a control point twice" };
    }
    const Lattice<Dim> lattice = makeLattice(element.Degree);
    const std::vector<int> lids = numbers.Number(element.Degree, ids, lattice.Steps);
    points.resize(static_cast<std::size_t>(numbers.Count()) * columns);
    isSet.resize(static_cast<std::size_t>(numbers.Count()), 0);
    for (std::size_t c = 0; c < columns; ++c)
    {
      std::vector<double> in(static_cast<std::size_t>(count));
      for (std::size_t i = 0; i < in.size(); ++i)
      {
        in[i] = old(ids[i], static_cast<Eigen::Index>(c));
      }
      const std::vector<double> out = coefficients(element.Degree, in);
      for (std::size_t i = 0; i < out.size(); ++i)
      {
        const std::size_t id = static_cast<std::size_t>(lids[i]);
        if (!isSet[id])
        {
          points[id * columns + c] = out[i];
        }
      }
    }
    for (const int id : lids)
    {
      isSet[static_cast<std::size_t>(id)] = 1;
    }

    IntArray<Dim> piece{};
    bool more = true;
    while (more)
    {
      IntArray<Dim> i{};
      for (int k = 0; k < NumTensorFunctions<Dim>(lattice.PieceDegree); ++k)
      {
        int at = 0;
        int stride = 1;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          at += stride * (piece[d] * lattice.PieceDegree[d] + i[d]);
          stride *= lattice.Steps[d] + 1;
        }
        pieceIds.push_back(lids[static_cast<std::size_t>(at)]);
        for (std::size_t d = 0; d < Dim && ++i[d] > lattice.PieceDegree[d]; ++d)
        {
          i[d] = 0;
        }
      }
      degrees.push_back(lattice.PieceDegree);
      result.Parents.push_back(e);
      more = false;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        if (++piece[d] < lattice.Pieces[d])
        {
          more = true;
          break;
        }
        piece[d] = 0;
      }
    }
  }
  auto made = MakeBezierSpace<Dim>(degrees, pieceIds, numbers.Count());
  if (!made)
  {
    return made.Status;
  }
  result.Value.Space = std::move(made.Value);
  result.Value.SetHomogeneousPoints(
    Eigen::Map<const PointMatrix>(points.data(), numbers.Count(), old.cols()), spline.IsRational());
  return result;
}
}

template <int Dim>
Result<RefinedSpline<Dim>> SplitBezierElements(const Spline<Dim>& spline)
{
  const auto makeLattice = [](const IntArray<Dim>& p)
  {
    Lattice<Dim> lattice{ p, p, {} };
    for (int& steps : lattice.Steps)
    {
      steps *= 2;
    }
    lattice.Pieces.fill(2);
    return lattice;
  };
  const auto coefficients = [](const IntArray<Dim>& p, const std::vector<double>& in)
  {
    std::size_t size = 1;
    for (const int degree : p)
    {
      size *= static_cast<std::size_t>(2 * degree + 1);
    }
    std::vector<double> lattice(size);
    for (std::size_t piece = 0; piece < (std::size_t{ 1 } << Dim); ++piece)
    {
      std::vector<double> part = in;
      for (int d = 0; d < Dim; ++d)
      {
        const bool upper = (piece >> d & 1) != 0;
        part = BernsteinRestrict<Dim>(p, part, d, upper ? 0.5 : 0.0, upper ? 1.0 : 0.5);
      }
      for (std::size_t i = 0; i < part.size(); ++i)
      {
        int rest = static_cast<int>(i);
        int at = 0;
        int stride = 1;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          at += stride * (rest % (p[d] + 1) + ((piece >> d & 1) != 0 ? p[d] : 0));
          rest /= p[d] + 1;
          stride *= 2 * p[d] + 1;
        }
        lattice[static_cast<std::size_t>(at)] = part[i];
      }
    }
    return lattice;
  };
  return Rebuild<Dim>(spline, makeLattice, coefficients);
}

template <int Dim>
Result<Spline<Dim>> ElevateBezierElements(const Spline<Dim>& spline, int times)
{
  const auto raised = [times](IntArray<Dim> p)
  {
    for (int& degree : p)
    {
      degree += times;
    }
    return p;
  };
  const auto makeLattice = [&raised](const IntArray<Dim>& p)
  {
    Lattice<Dim> lattice{ raised(p), raised(p), {} };
    lattice.Pieces.fill(1);
    return lattice;
  };
  const auto coefficients = [&raised](const IntArray<Dim>& p, const std::vector<double>& in)
  { return BernsteinElevate<Dim>(p, in, raised(p)); };
  auto result = Rebuild<Dim>(spline, makeLattice, coefficients);
  return result ? Result<Spline<Dim>>(std::move(result.Value.Value)) : result.Status;
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Result<RefinedSpline<Dim>> SplitBezierElements<Dim>(const Spline<Dim>&);                \
  template Result<Spline<Dim>> ElevateBezierElements<Dim>(const Spline<Dim>&, int);
KNOTWORK_INSTANTIATE(1)
KNOTWORK_INSTANTIATE(2)
KNOTWORK_INSTANTIATE(3)
#undef KNOTWORK_INSTANTIATE
}
