// SPDX-License-Identifier: BSD-3-Clause
#include "LRSpace.h"

#include "Numbers.h"

#include <algorithm>

namespace knotwork
{
namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// Sweeps the mesh from below: the elements that are open at a height, by their left side. Vertical
/// lines (first parameter fixed) divide a row, horizontal ones close elements.
class ElementSweep
{
public:
  explicit ElementSweep(const LRBasis& basis)
    : Basis(basis), Width(static_cast<int>(basis.Knots[0].size()) - 1),
      Height(static_cast<int>(basis.Knots[1].size()) - 1), Vertical(At(this->Width) + 1, false),
      Right(At(this->Width), 0), Bottom(At(this->Width), 0)
  {
    this->Changes.resize(At(this->Height) + 1);
    for (int x = 0; x <= this->Width; ++x)
    {
      bool before = false;
      for (const LRPiece& piece : basis.Lines[0][At(x)])
      {
        const bool is = piece.Multiplicity > 0;
        if (is != before)
        {
          this->Changes[At(piece.Knot)].push_back(x);
        }
        before = is;
      }
    }
  }

  Result<std::vector<std::array<int, 4>>> Run()
  {
    this->Toggle(0);
    this->Open(0, this->Width, 0);
    for (int y = 1; y <= this->Height; ++y)
    {
      const auto segments = this->Segments(y);
      for (const auto& [from, to] : segments)
      {
        if (!this->Close(from, to, y))
        {
          return this->Broken(from, y);
        }
      }
      if (y == this->Height)
      {
        break;
      }
      for (const int x : this->Changes[At(y)])
      {
        const bool crossed = std::any_of(segments.begin(), segments.end(),
          [x = x](const auto& s) { return s[0] < x && x < s[1]; });
        if (!crossed)
        {
          return this->Broken(x, y);
        }
      }
      this->Toggle(y);
      for (const auto& [from, to] : segments)
      {
        this->Open(from, to, y);
      }
    }
    std::sort(this->Elements.begin(), this->Elements.end(),
      [](const auto& a, const auto& b) { return a[1] != b[1] ? a[1] < b[1] : a[0] < b[0]; });
    return std::move(this->Elements);
  }

private:
  /// Parts of a horizontal line that are there, joined where only the multiplicity changes.
  std::vector<std::array<int, 2>> Segments(int y) const
  {
    std::vector<std::array<int, 2>> segments;
    const LRLine& line = this->Basis.Lines[1][At(y)];
    for (std::size_t k = 0; k < line.size(); ++k)
    {
      const int end = k + 1 < line.size() ? line[k + 1].Knot : this->Width;
      if (line[k].Multiplicity == 0)
      {
        continue;
      }
      if (!segments.empty() && segments.back()[1] == line[k].Knot)
      {
        segments.back()[1] = end;
      }
      else
      {
        segments.push_back({ line[k].Knot, end });
      }
    }
    return segments;
  }

  void Toggle(int y)
  {
    for (const int x : this->Changes[At(y)])
    {
      this->Vertical[At(x)] = !this->Vertical[At(x)];
    }
  }

  void Open(int from, int to, int y)
  {
    for (int x = from; x < to;)
    {
      int right = x + 1;
      while (right < to && !this->Vertical[At(right)])
      {
        ++right;
      }
      this->Right[At(x)] = right;
      this->Bottom[At(x)] = y;
      x = right;
    }
  }

  bool Close(int from, int to, int y)
  {
    int x = from;
    while (x<to&& this->Right[At(x)]> x)
    {
      const int right = this->Right[At(x)];
      this->Elements.push_back({ x, this->Bottom[At(x)], right, y });
      this->Right[At(x)] = 0;
      x = right;
    }
    return x == to;
  }

  Status Broken(int x, int y) const
  {
    return { ErrorCode::InvalidTopology,
      "a mesh line ends inside an element near (" + Digits(this->Basis.Knots[0][At(x)]) + ", " +
        Digits(this->Basis.Knots[1][At(y)]) + ")" };
  }

  const LRBasis& Basis;
  int Width;
  int Height;
  std::vector<std::vector<int>> Changes; // vertical lines that start or end at a height
  std::vector<bool> Vertical;            // lines that are there above the present height
  std::vector<int> Right;                // right side of the open element with this left side
  std::vector<int> Bottom;
  std::vector<std::array<int, 4>> Elements;
};
}

Result<std::vector<std::array<int, 4>>> LRElements(const LRBasis& basis)
{
  return ElementSweep(basis).Run();
}
}
