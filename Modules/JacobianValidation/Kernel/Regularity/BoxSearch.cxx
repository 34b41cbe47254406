// SPDX-License-Identifier: BSD-3-Clause
#include "BoxSearch.h"

#include <cfloat>
#include <limits>

namespace knotwork
{
namespace
{
constexpr std::size_t SafeDepth = 48; // so many halvings leave parameters multiples of 2^-51
constexpr std::size_t MaxQueued = std::size_t(1)
  << 25;                      // doubles in the queue before going depth first
constexpr int ExactCost = 16; // boxes that an exact one counts for

struct Box
{
  std::vector<double> C; ///< numerator, then denominator
  double Error = 0.0;
  double DenominatorError = 0.0;
  double Lower = 0.0;
  bool ExactSigns = false;
  /// Per slot, of the corner of the box that it belongs to in its group: the slots of the cell that
  /// vanish there.
  SlotExponents Vanishing{};
  std::vector<std::uint8_t> Path;
  std::shared_ptr<const ExactForm> Base; ///< exact form of the ancestor after BaseLength halvings
  std::size_t BaseLength = 0;
};

struct Worse
{
  bool operator()(const Box& a, const Box& b) const { return a.Lower > b.Lower; }
};

/// The box's own corner of every slot, in its group's directions.
std::array<std::array<double, 3>, MaxSlots> BoxVertices(
  const FormLayout& layout, const std::vector<std::uint8_t>& path)
{
  std::array<std::array<double, 3>, MaxSlots> vertices{};
  for (int d = 0; d < NumParameters(layout.Shape); ++d)
  {
    vertices[static_cast<std::size_t>(SlotOfDirection(layout.Shape, d))]
            [static_cast<std::size_t>(d)] = 1.0;
  }
  for (std::uint8_t step : path)
  {
    const FormLayout::Edge& edge = layout.Edges[static_cast<std::size_t>(step / 2)];
    const auto& a = vertices[static_cast<std::size_t>(edge.From)];
    const auto& b = vertices[static_cast<std::size_t>(edge.To)];
    std::array<double, 3> middle{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      middle[d] = 0.5 * (a[d] + b[d]);
    }
    vertices[static_cast<std::size_t>(step % 2 == 0 ? edge.To : edge.From)] = middle;
  }
  return vertices;
}

class BoxBisection
{
public:
  BoxBisection(const BoxProblem& problem, const BoxSearchParams& params)
    : P(problem), Params(params), L(*problem.Layout), Size(static_cast<std::size_t>(L.Size))
  {
  }

  BoxSearchResult Run()
  {
    this->R.Lower = std::numeric_limits<double>::infinity();
    this->R.Upper = std::numeric_limits<double>::infinity();
    Box root;
    root.C = this->P.Numerator;
    root.C.insert(root.C.end(), this->P.Denominator.begin(), this->P.Denominator.end());
    root.Error = this->P.NumeratorError;
    root.DenominatorError = this->P.DenominatorError;
    for (int g = 0; g < this->L.NumGroups; ++g)
    {
      const int group = this->L.GroupMasks[static_cast<std::size_t>(g)];
      for (int slot = 0; slot < this->L.NumSlots; ++slot)
      {
        if (group >> slot & 1)
        {
          root.Vanishing[static_cast<std::size_t>(slot)] =
            static_cast<std::uint8_t>(group & ~(1 << slot));
        }
      }
    }
    root.Base = this->P.Exact;
    root.ExactSigns = static_cast<bool>(this->P.Exact);
    this->Take(std::move(root));
    while (!this->Done())
    {
      Box box = this->Next();
      if (this->IsAccepted(box.Lower)) // the upper bound may have fallen since it was queued
      {
        this->R.Lower = std::min(this->R.Lower, box.Lower);
        continue;
      }
      if (this->R.Boxes >= this->Params.MaxBoxes)
      {
        this->R.Limit = JacobianLimit::Boxes;
        this->R.Lower = std::min(this->R.Lower, box.Lower);
        this->Undecided = true;
        break;
      }
      this->Split(std::move(box));
    }
    for (const Box& box : this->Heap)
    {
      this->R.Lower = std::min(this->R.Lower, box.Lower);
    }
    for (const Box& box : this->Stack)
    {
      this->R.Lower = std::min(this->R.Lower, box.Lower);
    }
    this->R.Lower = std::min(this->R.Lower, this->R.Upper);
    this->R.Positive = !this->R.NonPositive && !this->Undecided && !this->R.NeedsExact;
    return this->R;
  }

private:
  bool Done() const
  {
    return (this->Heap.empty() && this->Stack.empty()) || this->R.NeedsExact ||
      (this->R.NonPositive && this->Params.NeedSign && this->Params.RelativeGap >= 1.0);
  }

  Box Next()
  {
    Box box;
    if (!this->Stack.empty())
    {
      box = std::move(this->Stack.back());
      this->Stack.pop_back();
      return box;
    }
    std::pop_heap(this->Heap.begin(), this->Heap.end(), Worse());
    box = std::move(this->Heap.back());
    this->Heap.pop_back();
    return box;
  }

  bool IsAccepted(double lower) const
  {
    if (this->Params.NeedSign && !this->R.NonPositive && !(lower > 0.0))
    {
      return false;
    }
    return this->R.Upper - lower <=
      this->Params.RelativeGap * std::max(std::fabs(this->R.Upper), std::fabs(lower));
  }

  /// A coefficient belongs to the face of the box that the corners of its non-zero exponents span.
  /// Does that lie on a zero face of the cell?
  bool IsOnZeroFace(const Box& box, const SlotExponents& exponents) const
  {
    for (const std::uint8_t face : this->P.ZeroFaces)
    {
      bool on = true;
      for (int g = 0; on && g < this->L.NumGroups; ++g)
      {
        const int group = this->L.GroupMasks[static_cast<std::size_t>(g)];
        const int wanted = face & group;
        for (int slot = 0; wanted && on && slot < this->L.NumSlots; ++slot)
        {
          const std::size_t s = static_cast<std::size_t>(slot);
          on = !(group >> slot & 1) || exponents[s] == 0 || (box.Vanishing[s] & wanted) == wanted;
        }
      }
      if (on)
      {
        return true;
      }
    }
    return false;
  }
  bool TouchesZeroFace(const Box& box) const
  {
    return std::any_of(this->P.ZeroFaces.begin(), this->P.ZeroFaces.end(),
      [&](std::uint8_t face)
      {
        bool touches = true;
        for (int g = 0; touches && g < this->L.NumGroups; ++g)
        {
          const int group = this->L.GroupMasks[static_cast<std::size_t>(g)];
          const int wanted = face & group;
          bool some = wanted == 0;
          for (int slot = 0; !some && slot < this->L.NumSlots; ++slot)
          {
            some = (group >> slot & 1) &&
              (box.Vanishing[static_cast<std::size_t>(slot)] & wanted) == wanted;
          }
          touches = some;
        }
        return touches;
      });
  }

  /// Of a box with exact, non-negative coefficients, positive but on the zero faces: no face of the
  /// box has zeros alone unless they all lie on zero faces.
  bool IsPositiveInside(const Box& box) const
  {
    for (int mask = 0; mask < 1 << this->L.NumSlots; ++mask)
    {
      bool allZero = true;
      bool anyOutside = false;
      for (std::size_t k = 0; allZero && k < this->Size; ++k)
      {
        const SlotExponents& e = this->L.Exponents[k];
        bool on = true;
        for (int s = 0; on && s < this->L.NumSlots; ++s)
        {
          on = !(mask >> s & 1) || e[static_cast<std::size_t>(s)] == 0;
        }
        if (on)
        {
          allZero = box.C[k] == 0.0;
          anyOutside = anyOutside || !this->IsOnZeroFace(box, e);
        }
      }
      if (allZero && anyOutside)
      {
        return false;
      }
    }
    return true;
  }

  double Value(const Box& box, std::size_t k) const
  {
    return this->P.Denominator.empty() ? box.C[k] : box.C[k] / box.C[this->Size + k];
  }

  /// Bounds from the box's coefficients; then it is dropped, queued, or sent to exact arithmetic.
  void Take(Box box)
  {
    ++this->R.Boxes;
    const bool touches = this->TouchesZeroFace(box);
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0.0;
    double denominator = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < this->Size; ++k)
    {
      if (!this->P.Denominator.empty())
      {
        denominator = std::min(denominator, box.C[this->Size + k]);
      }
      if (touches && this->IsOnZeroFace(box, this->L.Exponents[k]))
      {
        continue;
      }
      const double v = this->Value(box, k);
      smallest = std::min(smallest, v);
      largest = std::max(largest, std::fabs(v));
    }
    if (smallest == std::numeric_limits<double>::infinity())
    {
      return; // a zero face and nothing else
    }
    double error = box.Error;
    if (!this->P.Denominator.empty())
    {
      // |F / W - fl(f / w)| <= (e_F + |q| e_W) / (w - e_W) + u |q|
      const double floor = denominator - box.DenominatorError;
      error = floor > 0.0 ? (box.Error + largest * box.DenominatorError) / floor * (1.0 + 0x1p-40) +
          4.0 * UnitRoundoff * largest
                          : std::numeric_limits<double>::infinity();
    }
    this->UseCorners(box, error, touches);
    // exact signs: the smallest coefficient is as certain as a relative error of 8 u allows
    if (box.ExactSigns)
    {
      box.Lower = smallest - 16.0 * UnitRoundoff * std::fabs(smallest);
      if (smallest == 0.0 && touches && this->IsPositiveInside(box))
      {
        return;
      }
    }
    else
    {
      box.Lower = smallest - error * (1.0 + 0x1p-50) - DBL_MIN;
    }
    if (this->IsAccepted(box.Lower))
    {
      this->R.Lower = std::min(this->R.Lower, box.Lower);
      return;
    }
    const double wanted = this->Params.NeedSign && !this->R.NonPositive
      ? std::fabs(smallest)
      : this->Params.RelativeGap * std::fabs(smallest);
    if (!box.ExactSigns && error >= 0.25 * wanted)
    {
      if (!this->P.Exact && this->Params.NeedSign)
      {
        this->R.NeedsExact = true;
        return;
      }
      if (!this->P.Exact || !this->P.Denominator.empty() || !this->Params.NeedSign)
      {
        this->R.Lower = std::min(this->R.Lower, box.Lower); // as far as rounding lets it go
        this->Undecided = this->Undecided || this->Params.NeedSign;
        return;
      }
      this->R.Boxes += ExactCost;
      this->MakeExact(box);
      this->Take(std::move(box));
      return;
    }
    const std::size_t queued = this->Heap.size() * this->P.Numerator.size();
    if (queued > MaxQueued)
    {
      this->Stack.push_back(std::move(box));
      return;
    }
    this->Heap.push_back(std::move(box));
    std::push_heap(this->Heap.begin(), this->Heap.end(), Worse());
  }

  void UseCorners(const Box& box, double error, bool touches)
  {
    for (std::size_t c = 0; c < this->L.Corners.size(); ++c)
    {
      const std::size_t k = static_cast<std::size_t>(this->L.Corners[c]);
      if (touches && this->IsOnZeroFace(box, this->L.Exponents[k]))
      {
        continue;
      }
      const double v = this->Value(box, k);
      double upper = v + error * (1.0 + 0x1p-50) + DBL_MIN;
      if (box.ExactSigns)
      {
        upper = v + 16.0 * UnitRoundoff * std::fabs(v);
      }
      if (upper < this->R.Upper)
      {
        this->R.Upper = upper;
        this->R.WitnessCorners = BoxCorners(this->L, box.Path);
        this->R.Witness = this->R.WitnessCorners[c];
        this->R.NonPositive = upper <= 0.0;
      }
    }
  }

  void MakeExact(Box& box)
  {
    std::shared_ptr<const ExactForm> form = box.Base;
    for (std::size_t i = box.BaseLength; i < box.Path.size(); ++i)
    {
      form = std::make_shared<ExactForm>(form->Half(box.Path[i] / 2, box.Path[i] % 2));
    }
    box.Base = form;
    box.BaseLength = box.Path.size();
    box.C = form->CoefficientsAt(this->P.Scale);
    double largest = 0.0;
    for (double c : box.C)
    {
      largest = std::max(largest, std::fabs(c));
    }
    box.Error = 8.0 * UnitRoundoff * largest;
    box.ExactSigns = true;
  }

  /// The edge along which the coefficients are most curved and whose group may be halved again; -1:
  /// none.
  int BestEdge(const Box& box) const
  {
    int best = -1;
    double score = -1.0;
    for (std::size_t e = 0; e < this->L.Edges.size(); ++e)
    {
      const FormLayout::Edge& edge = this->L.Edges[e];
      if (box.Path.size() >= SafeDepth && !this->MayCut(box, edge))
      {
        continue;
      }
      double curvature = 0.0;
      int longest = 0;
      for (const FormLayout::Line& line : edge.Lines)
      {
        const int* at = edge.LineIndices.data() + line.First;
        longest = std::max(longest, line.Size - 1);
        for (int i = 0; i + 2 < line.Size; ++i)
        {
          const auto second = [&](std::size_t offset)
          {
            const double* c = box.C.data() + offset;
            return std::fabs(c[at[i]] - 2.0 * c[at[i + 1]] + c[at[i + 2]]);
          };
          double value = second(0);
          if (!this->P.Denominator.empty())
          {
            value +=
              second(this->Size) * std::fabs(this->Value(box, static_cast<std::size_t>(at[i])));
          }
          curvature = std::max(curvature, value);
        }
      }
      curvature *= longest;
      if (curvature > score)
      {
        score = curvature;
        best = static_cast<int>(e);
      }
    }
    return best;
  }

  /// The middle of the edge is a multiple of 2^-51 still.
  bool MayCut(const Box& box, const FormLayout::Edge& edge) const
  {
    const auto vertices = BoxVertices(this->L, box.Path);
    for (std::size_t d = 0; d < 3; ++d)
    {
      const double middle = 0.5 *
        (vertices[static_cast<std::size_t>(edge.From)][d] +
          vertices[static_cast<std::size_t>(edge.To)][d]);
      if (std::rint(middle * 0x1p51) != middle * 0x1p51)
      {
        return false;
      }
    }
    return true;
  }

  void Split(Box box)
  {
    const int best = this->BestEdge(box);
    if (best < 0)
    {
      this->R.Lower = std::min(this->R.Lower, box.Lower);
      this->R.Limit = JacobianLimit::Depth;
      this->Undecided = true;
      return;
    }
    const FormLayout::Edge& edge = this->L.Edges[static_cast<std::size_t>(best)];
    Box upper;
    upper.C.resize(box.C.size());
    upper.Path = box.Path;
    upper.Base = box.Base;
    upper.BaseLength = box.BaseLength;
    // the middle of two corners vanishes where both do
    const std::size_t slotFrom = static_cast<std::size_t>(edge.From);
    const std::size_t slotTo = static_cast<std::size_t>(edge.To);
    const std::uint8_t middle =
      static_cast<std::uint8_t>(box.Vanishing[slotFrom] & box.Vanishing[slotTo]);
    upper.Vanishing = box.Vanishing;
    upper.Vanishing[slotFrom] = middle;
    box.Vanishing[slotTo] = middle;
    double line[64];
    double largest[2] = { 0.0, 0.0 };
    int most = 0;
    for (std::size_t part = 0; part * this->Size < box.C.size(); ++part)
    {
      double* low = box.C.data() + part * this->Size;
      double* high = upper.C.data() + part * this->Size;
      for (const FormLayout::Line& l : edge.Lines)
      {
        const int* at = edge.LineIndices.data() + l.First;
        const int n = l.Size - 1;
        most = std::max(most, n);
        for (int i = 0; i <= n; ++i)
        {
          line[i] = low[at[i]];
          largest[part] = std::max(largest[part], std::fabs(line[i]));
        }
        for (int i = 0; i <= n; ++i)
        {
          low[at[i]] = line[0];
          high[at[n - i]] = line[n - i];
          for (int k = 0; k < n - i; ++k)
          {
            line[k] = 0.5 * (line[k] + line[k + 1]);
          }
        }
      }
    }
    const double grow = most * UnitRoundoff * (1.0 + 0x1p-20);
    box.Error = upper.Error =
      box.Error * (1.0 + 0x1p-50) + grow * (largest[0] + box.Error) + DBL_MIN;
    box.DenominatorError = upper.DenominatorError =
      box.DenominatorError * (1.0 + 0x1p-50) + grow * (largest[1] + box.DenominatorError);
    box.ExactSigns = false;
    box.Path.push_back(static_cast<std::uint8_t>(2 * best));
    upper.Path.push_back(static_cast<std::uint8_t>(2 * best + 1));
    this->Take(std::move(box));
    this->Take(std::move(upper));
  }

  const BoxProblem& P;
  const BoxSearchParams& Params;
  const FormLayout& L;
  std::size_t Size;
  BoxSearchResult R;
  bool Undecided = false;
  std::vector<Box> Heap;
  std::vector<Box> Stack;
};
}

std::array<std::array<double, 3>, 8> BoxCorners(
  const FormLayout& layout, const std::vector<std::uint8_t>& path)
{
  const auto vertices = BoxVertices(layout, path);
  std::array<std::array<double, 3>, 8> corners{};
  for (std::size_t c = 0; c < layout.CornerMasks.size(); ++c)
  {
    for (int s = 0; s < layout.NumSlots; ++s)
    {
      if (!(layout.CornerMasks[c] >> s & 1))
      {
        for (std::size_t d = 0; d < 3; ++d)
        {
          corners[c][d] += vertices[static_cast<std::size_t>(s)][d];
        }
      }
    }
  }
  return corners;
}

BoxSearchResult SearchMinimum(const BoxProblem& problem, const BoxSearchParams& params)
{
  return BoxBisection(problem, params).Run();
}
}
