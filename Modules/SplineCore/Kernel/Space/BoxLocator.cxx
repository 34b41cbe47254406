// SPDX-License-Identifier: BSD-3-Clause
#include "BoxLocator.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double BucketsPerBox = 4.0;

/// A cut that leaves few boxes on both sides.
struct Candidate
{
  double Value = 0.0;
  std::size_t Direction = 0;
  std::size_t Cost = 0; // boxes below + boxes above; 0: none
};

using BoxList = std::vector<ParametricBox<2>>;

Candidate MedianCut(const BoxList& boxes, const int* begin, const int* end, std::size_t direction,
  double lower, std::vector<double>& values)
{
  values.clear();
  for (const int* i = begin; i != end; ++i)
  {
    const double value = boxes[static_cast<std::size_t>(*i)].Lower[direction];
    if (value > lower)
    {
      values.push_back(value);
    }
  }
  if (values.empty())
  {
    return {};
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  Candidate cut{ *middle, direction, 0 };
  for (const int* i = begin; i != end; ++i)
  {
    const ParametricBox<2>& box = boxes[static_cast<std::size_t>(*i)];
    cut.Cost += (box.Lower[direction] < cut.Value) + (box.Upper[direction] > cut.Value);
  }
  return cut;
}
}

/// Divides places into trees of cuts.
class BoxLocator::Divider
{
public:
  Divider(const BoxList& boxes, std::vector<Cut>& cuts) : Boxes(boxes), Cuts(cuts) {}

  /// Node of the place above a corner that the boxes [begin, end) of the list cover; all of them
  /// reach above the corner.
  int Divide(std::size_t begin, std::size_t end, const RealArray<2>& floor)
  {
    if (end - begin == 1)
    {
      return this->List[begin];
    }
    if (end - begin == 2)
    {
      return this->DividePair(this->List[begin], this->List[begin + 1]);
    }
    return this->DivideMany(begin, end, floor);
  }

  std::vector<int> List;

private:
  const ParametricBox<2>& Box(int i) const { return this->Boxes[static_cast<std::size_t>(i)]; }

  int DividePair(int a, int b)
  {
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (this->Box(a).Lower[d] >= this->Box(b).Upper[d])
      {
        std::swap(a, b);
      }
      if (this->Box(b).Lower[d] >= this->Box(a).Upper[d])
      {
        this->Cuts.push_back({ this->Box(b).Lower[d], static_cast<int>(d), a, b });
        break;
      }
    }
    return -static_cast<int>(this->Cuts.size());
  }

  /// Cuts lie above the corner and above the lowest box, so both parts hold boxes; of two disjoint
  /// boxes one has a side that separates them, so there is a cut while two boxes are left.
  int DivideMany(std::size_t begin, std::size_t end, const RealArray<2>& floor)
  {
    RealArray<2> lower = this->Box(this->List[begin]).Lower;
    for (std::size_t i = begin + 1; i < end; ++i)
    {
      const RealArray<2>& corner = this->Box(this->List[i]).Lower;
      lower = { std::min(lower[0], corner[0]), std::min(lower[1], corner[1]) };
    }
    lower = { std::max(lower[0], floor[0]), std::max(lower[1], floor[1]) };
    const int* list = this->List.data();
    const Candidate first =
      MedianCut(this->Boxes, list + begin, list + end, 0, lower[0], this->Values);
    const Candidate second =
      MedianCut(this->Boxes, list + begin, list + end, 1, lower[1], this->Values);
    const bool useFirst = second.Cost == 0 || (first.Cost > 0 && first.Cost <= second.Cost);
    const Candidate cut = useFirst ? first : second;
    // the parts follow in the list while they are divided
    const std::size_t below = this->List.size();
    for (std::size_t i = begin; i < end; ++i)
    {
      if (this->Box(this->List[i]).Lower[cut.Direction] < cut.Value)
      {
        this->List.push_back(this->List[i]);
      }
    }
    const std::size_t above = this->List.size();
    for (std::size_t i = begin; i < end; ++i)
    {
      if (this->Box(this->List[i]).Upper[cut.Direction] > cut.Value)
      {
        this->List.push_back(this->List[i]);
      }
    }
    const std::size_t node = this->Cuts.size();
    this->Cuts.push_back({ cut.Value, static_cast<int>(cut.Direction), 0, 0 });
    RealArray<2> raised = lower;
    raised[cut.Direction] = cut.Value;
    const int over = this->Divide(above, this->List.size(), raised);
    this->List.resize(above);
    const int under = this->Divide(below, above, lower);
    this->List.resize(below);
    this->Cuts[node].Below = under;
    this->Cuts[node].Above = over;
    return -1 - static_cast<int>(node);
  }

  const BoxList& Boxes;
  std::vector<Cut>& Cuts;
  std::vector<double> Values;
};

BoxLocator::BoxLocator(
  const ParametricBox<2>& domain, const BoxList& boxes, const std::array<std::size_t, 2>& shape)
{
  const double buckets = BucketsPerBox * static_cast<double>(boxes.size());
  const double ratio = static_cast<double>(shape[0]) / static_cast<double>(shape[1]);
  const double across = std::clamp(std::sqrt(buckets * ratio), 1.0, buckets);
  this->Size = { static_cast<std::size_t>(across), static_cast<std::size_t>(buckets / across) };
  for (std::size_t d = 0; d < 2; ++d)
  {
    this->Size[d] = std::max<std::size_t>(this->Size[d], 1);
    this->Begin[d] = domain.Lower[d];
    this->Scale[d] = static_cast<double>(this->Size[d]) / (domain.Upper[d] - domain.Lower[d]);
    this->Last[d] = static_cast<double>(this->Size[d] - 1);
  }
  // Bucket() is monotone, so a box meets exactly the buckets between those of its corners
  const std::size_t numBuckets = this->Size[0] * this->Size[1];
  std::vector<std::size_t> starts(numBuckets + 1, 0);
  const auto visit = [&](const ParametricBox<2>& box, auto&& use)
  {
    for (std::size_t y = this->Bucket(1, box.Lower[1]); y <= this->Bucket(1, box.Upper[1]); ++y)
    {
      for (std::size_t x = this->Bucket(0, box.Lower[0]); x <= this->Bucket(0, box.Upper[0]); ++x)
      {
        use(y * this->Size[0] + x);
      }
    }
  };
  for (const ParametricBox<2>& box : boxes)
  {
    visit(box, [&](std::size_t bucket) { ++starts[bucket + 1]; });
  }
  for (std::size_t b = 0; b < numBuckets; ++b)
  {
    starts[b + 1] += starts[b];
  }
  // what all buckets meet first, then the parts of the bucket that is divided
  Divider divider(boxes, this->Cuts);
  std::vector<int>& members = divider.List;
  members.resize(starts.back());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    visit(boxes[i], [&](std::size_t bucket) { members[next[bucket]++] = static_cast<int>(i); });
  }
  this->Buckets.resize(numBuckets);
  for (std::size_t b = 0; b < numBuckets; ++b)
  {
    this->Buckets[b] = divider.Divide(starts[b], starts[b + 1], domain.Lower);
  }
}
}
