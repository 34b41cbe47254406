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

Candidate MedianCut(const std::vector<ParametricBox<2>>& boxes, const std::vector<int>& inside,
  std::size_t direction, double lower)
{
  std::vector<double> values;
  for (const int i : inside)
  {
    const double value = boxes[static_cast<std::size_t>(i)].Lower[direction];
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
  for (const int i : inside)
  {
    const ParametricBox<2>& box = boxes[static_cast<std::size_t>(i)];
    cut.Cost += (box.Lower[direction] < cut.Value) + (box.Upper[direction] > cut.Value);
  }
  return cut;
}
}

BoxLocator::BoxLocator(const ParametricBox<2>& domain, const std::vector<ParametricBox<2>>& boxes,
  const std::array<std::size_t, 2>& shape)
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
  std::vector<int> members(starts.back());
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    visit(boxes[i], [&](std::size_t bucket) { members[next[bucket]++] = static_cast<int>(i); });
  }
  this->Buckets.resize(numBuckets);
  std::vector<int> inside;
  for (std::size_t b = 0; b < numBuckets; ++b)
  {
    inside.assign(members.begin() + static_cast<std::ptrdiff_t>(starts[b]),
      members.begin() + static_cast<std::ptrdiff_t>(starts[b + 1]));
    this->Buckets[b] = this->Divide(boxes, inside, domain.Lower);
  }
}

/// @param floor  lower corner of the place to divide; all boxes of `inside` reach above it. Cuts
/// lie above it and above the lowest box, so both parts hold boxes; of two disjoint boxes one has a
/// side that separates them, so there is a cut while two boxes are left.
int BoxLocator::Divide(const std::vector<ParametricBox<2>>& boxes, const std::vector<int>& inside,
  const RealArray<2>& floor)
{
  if (inside.size() == 1)
  {
    return inside[0];
  }
  RealArray<2> lower = boxes[static_cast<std::size_t>(inside[0])].Lower;
  for (const int i : inside)
  {
    const RealArray<2>& corner = boxes[static_cast<std::size_t>(i)].Lower;
    lower = { std::min(lower[0], corner[0]), std::min(lower[1], corner[1]) };
  }
  lower = { std::max(lower[0], floor[0]), std::max(lower[1], floor[1]) };
  const Candidate first = MedianCut(boxes, inside, 0, lower[0]);
  const Candidate second = MedianCut(boxes, inside, 1, lower[1]);
  const bool useFirst = second.Cost == 0 || (first.Cost > 0 && first.Cost <= second.Cost);
  const Candidate& cut = useFirst ? first : second;
  std::vector<int> below, above;
  for (const int i : inside)
  {
    const ParametricBox<2>& box = boxes[static_cast<std::size_t>(i)];
    if (box.Lower[cut.Direction] < cut.Value)
    {
      below.push_back(i);
    }
    if (box.Upper[cut.Direction] > cut.Value)
    {
      above.push_back(i);
    }
  }
  const std::size_t node = this->Cuts.size();
  this->Cuts.push_back({ cut.Value, static_cast<int>(cut.Direction), 0, 0 });
  const int under = this->Divide(boxes, below, lower);
  RealArray<2> raised = lower;
  raised[cut.Direction] = cut.Value;
  const int over = this->Divide(boxes, above, raised);
  this->Cuts[node].Below = under;
  this->Cuts[node].Above = over;
  return -1 - static_cast<int>(node);
}
}
