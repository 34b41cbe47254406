// SPDX-License-Identifier: BSD-3-Clause
// Insertion of mesh rectangles: the mesh of all of them, then splits until nothing is traversed.
#include "LRKnotHash.h"
#include "LRVolumeParts.h"
#include "Numbers.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double KnotTolerance = 1e-12; // of the domain's size

std::size_t At(std::ptrdiff_t i)
{
  return static_cast<std::size_t>(i);
}

std::string Describe(const LRRectangle& rectangle)
{
  const char* names = "uvw";
  const auto across = LRVolumeBasis::Across(rectangle.Direction);
  std::string text =
    std::string("rectangle ") + names[rectangle.Direction] + " = " + Digits(rectangle.Value);
  for (std::size_t i = 0; i < 2; ++i)
  {
    text += std::string(", ") + names[across[i]] + " from " + Digits(rectangle.Lower[i]) + " to " +
      Digits(rectangle.Upper[i]);
  }
  return text;
}

Status CheckRectangle(const LRVolumeBasis& basis, const LRRectangle& rectangle)
{
  const int d = rectangle.Direction;
  if (d < 0 || d > 2)
  {
    return { ErrorCode::InvalidParameter,
      "a rectangle has direction " + std::to_string(d) + ", choose 0, 1 or 2" };
  }
  bool isFinite = std::isfinite(rectangle.Value);
  for (std::size_t i = 0; i < 2; ++i)
  {
    isFinite = isFinite && std::isfinite(rectangle.Lower[i]) && std::isfinite(rectangle.Upper[i]);
  }
  if (!isFinite)
  {
    return { ErrorCode::NonFiniteInput, Describe(rectangle) };
  }
  if (rectangle.Lower[0] >= rectangle.Upper[0] || rectangle.Lower[1] >= rectangle.Upper[1])
  {
    return { ErrorCode::InvalidParameter, Describe(rectangle) + ": it has no area" };
  }
  const int most = basis.Degree[At(d)] + 1;
  if (rectangle.Multiplicity < 1 || rectangle.Multiplicity > most)
  {
    return { ErrorCode::InvalidParameter,
      Describe(rectangle) + ": multiplicity " + std::to_string(rectangle.Multiplicity) +
        " is outside [1, " + std::to_string(most) + "]" };
  }
  const std::vector<double>& knots = basis.Knots[At(d)];
  const double slack = KnotTolerance * (knots.back() - knots.front());
  if (rectangle.Value < knots.front() - slack || rectangle.Value > knots.back() + slack)
  {
    return { ErrorCode::OutsideDomain, Describe(rectangle) + ": it is outside the domain" };
  }
  return {};
}

/// The knot at a value, -1 when there is none.
int FindKnot(const std::vector<double>& knots, double value)
{
  const double slack = KnotTolerance * (knots.back() - knots.front());
  const auto above = std::lower_bound(knots.begin(), knots.end(), value - slack);
  int best = -1;
  for (auto k = above; k != knots.end() && *k <= value + slack; ++k)
  {
    if (best < 0 || std::fabs(*k - value) < std::fabs(knots[At(best)] - value))
    {
      best = static_cast<int>(k - knots.begin());
    }
  }
  return best;
}

/// The same space on the grid that has the rectangles' knots as well.
Status AddKnots(const std::vector<LRRectangle>& rectangles, LRVolumeBasis& basis)
{
  LRVolumeBasis fine;
  fine.Degree = basis.Degree;
  fine.Knots = basis.Knots;
  for (std::size_t d = 0; d < 3; ++d)
  {
    std::vector<double> values;
    for (const LRRectangle& rectangle : rectangles)
    {
      if (rectangle.Direction == static_cast<int>(d) &&
        FindKnot(basis.Knots[d], rectangle.Value) < 0)
      {
        values.push_back(rectangle.Value);
      }
    }
    std::sort(values.begin(), values.end());
    const double slack = KnotTolerance * (basis.Knots[d].back() - basis.Knots[d].front());
    double last = -std::numeric_limits<double>::infinity();
    for (const double value : values)
    {
      if (value - last > slack)
      {
        fine.Knots[d].push_back(value);
        last = value;
      }
    }
    std::sort(fine.Knots[d].begin(), fine.Knots[d].end());
  }
  if (fine.Knots == basis.Knots)
  {
    return {};
  }
  if (Status status = CheckLRVolumeSize(fine); !status)
  {
    return status;
  }
  std::array<std::vector<int>, 3> ranks; // new numbers of the old knots
  std::array<std::vector<int>, 3> spans; // old spans that hold the new ones
  for (std::size_t d = 0; d < 3; ++d)
  {
    for (std::size_t k = 0; k < fine.Knots[d].size(); ++k)
    {
      const bool isOld = ranks[d].size() < basis.Knots[d].size() &&
        fine.Knots[d][k] == basis.Knots[d][ranks[d].size()];
      if (isOld)
      {
        ranks[d].push_back(static_cast<int>(k));
      }
      spans[d].push_back(static_cast<int>(ranks[d].size()) - 1);
    }
  }
  for (int d = 0; d < 3; ++d)
  {
    const auto [first, second] = LRVolumeBasis::Across(d);
    fine.Faces[At(d)].assign(
      fine.Knots[At(d)].size() * At(fine.Spans(first)) * At(fine.Spans(second)), 0);
    for (std::size_t k = 0; k < ranks[At(d)].size(); ++k)
    {
      for (int b = 0; b < fine.Spans(second); ++b)
      {
        for (int a = 0; a < fine.Spans(first); ++a)
        {
          fine.Faces[At(d)][fine.FaceIndex(d, ranks[At(d)][k], a, b)] =
            basis.Faces[At(d)][basis.FaceIndex(
              d, static_cast<int>(k), spans[At(first)][At(a)], spans[At(second)][At(b)])];
        }
      }
    }
  }
  fine.LocalKnots = std::move(basis.LocalKnots);
  fine.Scaling = std::move(basis.Scaling);
  const auto stride = At(fine.Stride());
  const auto first = At(fine.Degree[0] + 2);
  const auto second = first + At(fine.Degree[1] + 2);
  for (std::size_t i = 0; i < fine.LocalKnots.size(); ++i)
  {
    const std::size_t place = i % stride;
    const std::size_t d = place < first ? 0 : place < second ? 1 : 2;
    fine.LocalKnots[i] = ranks[d][At(fine.LocalKnots[i])];
  }
  basis = std::move(fine);
  return {};
}

/// The faces of a rectangle; its knots are there.
Result<LRCrossSection> Resolve(const LRVolumeBasis& basis, const LRRectangle& rectangle)
{
  const int d = rectangle.Direction;
  LRCrossSection section{ d, FindKnot(basis.Knots[At(d)], rectangle.Value), {}, {} };
  const auto across = LRVolumeBasis::Across(d);
  for (std::size_t i = 0; i < 2; ++i)
  {
    section.Lower[i] = FindKnot(basis.Knots[At(across[i])], rectangle.Lower[i]);
    section.Upper[i] = FindKnot(basis.Knots[At(across[i])], rectangle.Upper[i]);
    if (section.Lower[i] < 0 || section.Upper[i] < 0)
    {
      return { ErrorCode::InvalidTopology,
        Describe(rectangle) + ": no mesh rectangle for it to " +
          (section.Lower[i] < 0 ? "start" : "end") + " at" };
    }
    if (section.Lower[i] >= section.Upper[i])
    {
      return { ErrorCode::InvalidParameter, Describe(rectangle) + ": it has no area" };
    }
  }
  return section;
}

/// Calls use(multiplicity) for the faces of a cross-section.
template <typename Use>
void ForEachFace(LRVolumeBasis& basis, const LRCrossSection& section, Use&& use)
{
  const int d = section.Direction;
  for (int b = section.Lower[1]; b < section.Upper[1]; ++b)
  {
    for (int a = section.Lower[0]; a < section.Upper[0]; ++a)
    {
      use(basis.Faces[At(d)][basis.FaceIndex(d, section.Plane, a, b)]);
    }
  }
}

/// Functions while they are split, found by a hash of their local knots.
class Splitter
{
public:
  Splitter(const LRVolumeBasis& basis, int columns)
    : Basis(basis), Stride(At(basis.Stride())), Columns(At(columns)), Table(1024, 0)
  {
    this->First = { 0, basis.Degree[0] + 2, basis.Degree[0] + basis.Degree[1] + 4 };
  }

  void Add(const int* local, double gamma, const double* row)
  {
    if (2 * (this->Scaling.size() + 1) > this->Table.size())
    {
      this->Grow();
    }
    const std::size_t slot = this->Slot(local);
    if (this->Table[slot] == 0)
    {
      this->Local.insert(this->Local.end(), local, local + this->Stride);
      this->Scaling.push_back(gamma);
      this->Rows.insert(this->Rows.end(), row, row + this->Columns);
      this->Table[slot] = static_cast<int>(this->Scaling.size());
      this->Queue.push_back(static_cast<int>(this->Scaling.size()) - 1);
      ++this->Count;
      return;
    }
    const auto f = At(this->Table[slot] - 1);
    const double old = this->Scaling[f];
    if (old == 0.0) // it was split before, and comes back
    {
      this->Queue.push_back(static_cast<int>(f));
      ++this->Count;
    }
    const double sum = old + gamma;
    for (std::size_t c = 0; c < this->Columns; ++c)
    {
      double& value = this->Rows[f * this->Columns + c];
      value = old == 0.0 ? row[c] : (old * value + gamma * row[c]) / sum;
    }
    this->Scaling[f] = sum;
  }

  /// @return whether there are no more functions than allowed.
  bool Run(int maxFunctions)
  {
    std::vector<int> local;
    std::vector<double> row;
    while (!this->Queue.empty() && this->Count <= maxFunctions)
    {
      const auto f = At(this->Queue.front());
      this->Queue.pop_front();
      const auto begin = this->Local.begin() + static_cast<std::ptrdiff_t>(f * this->Stride);
      local.assign(begin, begin + static_cast<std::ptrdiff_t>(this->Stride));
      int d = 0;
      int plane = -1;
      for (; d < 3; ++d)
      {
        plane = this->Traversing(local.data(), d);
        if (plane >= 0)
        {
          break;
        }
      }
      if (plane < 0)
      {
        continue;
      }
      const double gamma = this->Scaling[f];
      const auto from = this->Rows.begin() + static_cast<std::ptrdiff_t>(f * this->Columns);
      row.assign(from, from + static_cast<std::ptrdiff_t>(this->Columns));
      this->Scaling[f] = 0.0;
      --this->Count;
      this->Split(local, d, plane, gamma, row);
    }
    return this->Count <= maxFunctions;
  }

  /// The functions in their order.
  void Finish(LRVolumeBasis& basis, PointMatrix& rows) const
  {
    std::vector<int> order;
    for (std::size_t f = 0; f < this->Scaling.size(); ++f)
    {
      if (this->Scaling[f] > 0.0)
      {
        order.push_back(static_cast<int>(f));
      }
    }
    const auto stride = static_cast<std::ptrdiff_t>(this->Stride);
    std::sort(order.begin(), order.end(),
      [&](int a, int b)
      {
        const int* left = this->Local.data() + a * stride;
        const int* right = this->Local.data() + b * stride;
        for (std::size_t d = 3; d-- > 0;)
        {
          const int n = basis.Degree[d] + 2;
          const int* x = left + this->First[d];
          const int* y = right + this->First[d];
          if (!std::equal(x, x + n, y))
          {
            return std::lexicographical_compare(x, x + n, y, y + n);
          }
        }
        return false;
      });
    basis.LocalKnots.clear();
    basis.Scaling.clear();
    rows.resize(static_cast<Eigen::Index>(order.size()), static_cast<Eigen::Index>(this->Columns));
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      const auto begin = this->Local.begin() + order[i] * stride;
      basis.LocalKnots.insert(basis.LocalKnots.end(), begin, begin + stride);
      basis.Scaling.push_back(this->Scaling[At(order[i])]);
      for (std::size_t c = 0; c < this->Columns; ++c)
      {
        rows(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
          this->Rows[At(order[i]) * this->Columns + c];
      }
    }
  }

private:
  std::size_t Slot(const int* local) const
  {
    const std::size_t mask = this->Table.size() - 1;
    std::size_t slot = LRKnotHash(local, static_cast<int>(this->Stride)) & mask;
    while (this->Table[slot] > 0 &&
      !std::equal(
        local, local + this->Stride, this->Local.data() + At(this->Table[slot] - 1) * this->Stride))
    {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  void Grow()
  {
    this->Table.assign(2 * this->Table.size(), 0);
    for (std::size_t f = 0; f < this->Scaling.size(); ++f)
    {
      this->Table[this->Slot(this->Local.data() + f * this->Stride)] = static_cast<int>(f) + 1;
    }
  }

  /// A plane inside the support that is not among the knots as often as rectangles traverse it.
  int Traversing(const int* local, int d) const
  {
    const int* knots = local + this->First[At(d)];
    const int last = this->Basis.Degree[At(d)] + 1;
    LRCrossSection section = CrossSectionOf(this->Basis, local, d, 0);
    int next = 0; // first knot at the plane or above
    for (int k = knots[0] + 1; k < knots[last]; ++k)
    {
      while (knots[next] < k)
      {
        ++next;
      }
      int has = 0;
      while (knots[next + has] == k)
      {
        ++has;
      }
      section.Plane = k;
      if (Exceeds(this->Basis, section, has))
      {
        return k;
      }
    }
    return -1;
  }

  void Split(
    const std::vector<int>& local, int d, int plane, double gamma, const std::vector<double>& row)
  {
    const auto first = this->First[At(d)];
    const int last = this->Basis.Degree[At(d)] + 1;
    const std::vector<double>& t = this->Basis.Knots[At(d)];
    std::vector<int> knots(local.begin() + first, local.begin() + first + last + 1);
    const double z = t[At(plane)];
    const auto value = [&](int i) { return t[At(knots[At(i)])]; };
    const double left =
      plane >= knots[At(last - 1)] ? 1.0 : (z - value(0)) / (value(last - 1) - value(0));
    const double right = plane <= knots[1] ? 1.0 : (value(last) - z) / (value(last) - value(1));
    knots.insert(std::upper_bound(knots.begin(), knots.end(), plane), plane);
    std::vector<int> child = local;
    std::copy(knots.begin(), knots.end() - 1, child.begin() + first);
    this->Add(child.data(), left * gamma, row.data());
    std::copy(knots.begin() + 1, knots.end(), child.begin() + first);
    this->Add(child.data(), right * gamma, row.data());
  }

  const LRVolumeBasis& Basis;
  std::size_t Stride;
  std::size_t Columns;
  std::array<int, 3> First{}; // of a direction's knots
  std::vector<int> Local;
  std::vector<double> Scaling; // 0 of those that are split
  std::vector<double> Rows;
  std::vector<int> Table; // function + 1, open addressing
  std::deque<int> Queue;
  int Count = 0;
};

/// Whether a function has the plane among its knots that often, and its support meets the section.
bool IsUsed(const LRVolumeBasis& basis, const LRCrossSection& section, int multiplicity)
{
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    const int* knots = basis.Local(f, section.Direction);
    const auto has =
      std::count(knots, knots + basis.Degree[At(section.Direction)] + 2, section.Plane);
    if (has < multiplicity)
    {
      continue;
    }
    const LRCrossSection own =
      CrossSectionOf(basis, basis.Local(f, 0), section.Direction, section.Plane);
    if (own.Lower[0] < section.Upper[0] && section.Lower[0] < own.Upper[0] &&
      own.Lower[1] < section.Upper[1] && section.Lower[1] < own.Upper[1])
    {
      return true;
    }
  }
  return false;
}

/// @param areChecked  rectangles are a user's: each must traverse the support of a function.
Result<Spline<3>> Insert(const Spline<3>& spline, const std::vector<LRRectangle>& rectangles,
  int maxFunctions, bool areChecked, int threads)
{
  if (Status status = spline.Check(); !status)
  {
    return status;
  }
  LRVolumeBasis basis;
  if (spline.Space->Kind == SpaceKind::LocallyRefined)
  {
    basis = LRVolumeOf(*spline.Space).Basis;
  }
  else
  {
    Result<LRVolumeBasis> made = LRVolumeBasisOfTensor(*spline.Space);
    if (!made)
    {
      return made.Status;
    }
    basis = std::move(made.Value);
  }
  for (std::size_t i = 0; i < rectangles.size(); ++i)
  {
    if (Status status = CheckRectangle(basis, rectangles[i]); !status)
    {
      return { status.Code, "rectangle " + std::to_string(i) + ": " + status.Detail };
    }
  }
  if (Status status = AddKnots(rectangles, basis); !status)
  {
    return status;
  }
  std::vector<LRCrossSection> sections;
  for (std::size_t i = 0; i < rectangles.size(); ++i)
  {
    const Result<LRCrossSection> section = Resolve(basis, rectangles[i]);
    if (!section)
    {
      return { section.Status.Code,
        "rectangle " + std::to_string(i) + ": " + section.Status.Detail };
    }
    sections.push_back(section.Value);
  }
  std::vector<bool> isNew(sections.size(), false); // some of it is not there yet
  for (std::size_t i = 0; areChecked && i < sections.size(); ++i)
  {
    ForEachFace(basis, sections[i],
      [&](std::uint8_t face) { isNew[i] = isNew[i] || face < rectangles[i].Multiplicity; });
  }
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    const auto multiplicity = static_cast<std::uint8_t>(rectangles[i].Multiplicity);
    ForEachFace(basis, sections[i],
      [multiplicity](std::uint8_t& face) { face = std::max(face, multiplicity); });
  }
  const PointMatrix points = spline.HomogeneousPoints();
  Splitter splitter(basis, static_cast<int>(points.cols()));
  for (int f = 0; f < basis.NumFunctions(); ++f)
  {
    splitter.Add(basis.Local(f, 0), basis.Scaling[At(f)], points.row(f).data());
  }
  if (!splitter.Run(maxFunctions))
  {
    return { ErrorCode::TooLarge,
      "the refined space has more than " + std::to_string(maxFunctions) + " functions" };
  }
  PointMatrix rows;
  splitter.Finish(basis, rows);
  for (std::size_t i = 0; i < isNew.size(); ++i)
  {
    if (isNew[i] && !IsUsed(basis, sections[i], rectangles[i].Multiplicity))
    {
      return { ErrorCode::InvalidTopology,
        "rectangle " + std::to_string(i) + ": " + Describe(rectangles[i]) +
          ": it traverses the support of no function; make it larger" };
    }
  }
  Result<SplineSpacePtr<3>> space = AssembleLRVolume(std::move(basis), threads);
  if (!space)
  {
    return space.Status;
  }
  Spline<3> result;
  result.Space = space.Value;
  result.SetHomogeneousPoints(rows, spline.IsRational());
  return result;
}

/// A function alive on an element with the smallest support, the first of equals.
int SmallestFunction(const LRVolume& volume, int element)
{
  int best = -1;
  double least = 0.0;
  for (std::size_t k = volume.AliveStart[At(element)]; k < volume.AliveStart[At(element) + 1]; ++k)
  {
    const int f = volume.AliveFunctions[k];
    double size = 1.0;
    for (int d = 0; d < 3; ++d)
    {
      const int* knots = volume.Basis.Local(f, d);
      const std::vector<double>& t = volume.Basis.Knots[At(d)];
      size *= t[At(knots[volume.Basis.Degree[At(d)] + 1])] - t[At(knots[0])];
    }
    if (best < 0 || size < least)
    {
      best = f;
      least = size;
    }
  }
  return best;
}

LRRectangle Across(const LRVolumeBasis& basis, int f, int d, double value)
{
  const LRCrossSection section = CrossSectionOf(basis, basis.Local(f, 0), d, 0);
  LRRectangle rectangle;
  rectangle.Direction = d;
  rectangle.Value = value;
  const auto across = LRVolumeBasis::Across(d);
  for (std::size_t i = 0; i < 2; ++i)
  {
    rectangle.Lower[i] = basis.Knots[At(across[i])][At(section.Lower[i])];
    rectangle.Upper[i] = basis.Knots[At(across[i])][At(section.Upper[i])];
  }
  return rectangle;
}

Result<RefinedSpline<3>> WithParents(const Spline<3>& given, Result<Spline<3>> refined)
{
  if (!refined)
  {
    return refined.Status;
  }
  RefinedSpline<3> result;
  result.Value = std::move(refined.Value);
  result.Parents = ParentElements(*given.Space, *result.Value.Space, 1);
  return result;
}
}

Result<Spline<3>> InsertRectangles(const Spline<3>& spline,
  const std::vector<LRRectangle>& rectangles, int maxFunctions, int threads)
{
  return Insert(spline, rectangles, maxFunctions, true, threads);
}

Result<RefinedSpline<3>> RefineByRectangles(const Spline<3>& spline,
  const std::vector<LRRectangle>& rectangles, int maxFunctions, int threads)
{
  return WithParents(spline, InsertRectangles(spline, rectangles, maxFunctions, threads));
}

Result<std::vector<LRRectangle>> RectanglesForElements(const SplineSpace<3>& space,
  const std::vector<int>& elements, const LRVolumeStrategyParams& params)
{
  if (space.Kind != SpaceKind::LocallyRefined)
  {
    return { ErrorCode::DimensionMismatch, "the space is not locally refined" };
  }
  const LRVolume& volume = LRVolumeOf(space);
  const LRVolumeBasis& basis = volume.Basis;
  std::vector<bool> isMarked(space.Elements.size(), false);
  for (const int e : elements)
  {
    if (e < 0 || e >= space.NumElements())
    {
      return { ErrorCode::InvalidParameter,
        "there is no element " + std::to_string(e) + " among " +
          std::to_string(space.NumElements()) };
    }
    isMarked[At(e)] = true;
  }
  // a rectangle as direction, function, and the knots between whose values it lies
  std::vector<std::array<int, 4>> chosen;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    if (!isMarked[At(e)])
    {
      continue;
    }
    const std::array<int, 6>& box = volume.ElementKnots[At(e)];
    for (int d = 0; d < 3; ++d)
    {
      if (!params.Directions[At(d)])
      {
        continue;
      }
      if (params.Strategy == LRStrategy::FullSpan)
      {
        for (std::size_t k = volume.AliveStart[At(e)]; k < volume.AliveStart[At(e) + 1]; ++k)
        {
          chosen.push_back({ d, volume.AliveFunctions[k], box[At(d)], box[At(d) + 3] });
        }
        continue;
      }
      const int f = SmallestFunction(volume, e);
      if (params.Strategy == LRStrategy::MinimumSpan)
      {
        chosen.push_back({ d, f, box[At(d)], box[At(d) + 3] });
        continue;
      }
      const int* knots = basis.Local(f, d);
      const std::vector<double>& t = basis.Knots[At(d)];
      double longest = 0.0;
      for (int i = 0; i <= basis.Degree[At(d)]; ++i)
      {
        longest = std::max(longest, t[At(knots[i + 1])] - t[At(knots[i])]);
      }
      for (int i = 0; i <= basis.Degree[At(d)]; ++i)
      {
        const bool isThere = knots[i] < knots[i + 1];
        const bool holds = knots[i] <= box[At(d)] && box[At(d) + 3] <= knots[i + 1];
        const bool isLong = t[At(knots[i + 1])] - t[At(knots[i])] > 0.5 * longest;
        if (isThere && (params.Strategy == LRStrategy::StructuredMesh || (holds && isLong)))
        {
          chosen.push_back({ d, f, knots[i], knots[i + 1] });
        }
      }
    }
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  std::vector<LRRectangle> rectangles;
  for (const auto& [d, f, low, high] : chosen)
  {
    const std::vector<double>& t = basis.Knots[At(d)];
    rectangles.push_back(Across(basis, f, d, 0.5 * (t[At(low)] + t[At(high)])));
  }
  return rectangles;
}

Result<RefinedSpline<3>> RefineMarkedLRVolume(const Spline<3>& spline,
  const std::vector<int>& marked, const LRVolumeStrategyParams& params, int maxFunctions,
  int threads)
{
  // elements and functions keep their numbers when a tensor-product space becomes locally refined
  Result<Spline<3>> start = spline.Space && spline.Space->Kind == SpaceKind::LocallyRefined
    ? Result<Spline<3>>(spline)
    : Insert(spline, {}, maxFunctions, false, threads);
  if (!start || marked.empty())
  {
    return start ? WithParents(spline, std::move(start)) : start.Status;
  }
  const auto rectangles = RectanglesForElements(*start->Space, marked, params);
  return rectangles
    ? WithParents(spline, Insert(start.Value, rectangles.Value, maxFunctions, false, threads))
    : rectangles.Status;
}
}
