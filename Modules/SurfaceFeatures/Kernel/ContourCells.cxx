// SPDX-License-Identifier: BSD-3-Clause
#include "ContourCells.h"

#include "ContourArcs.h"
#include "SignRoots.h"
#include <knotwork/SplineCore/Bernstein.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double SmallestCell = 0x1p-40; // of the element

/// A place on the contour where cells or elements meet.
struct Root
{
  RealArray<2> Point{};
  int Id = -1;       // of the surface, on the border of the element
  int Arc = -1;      // that leaves it
  bool Ends = false; // an arc ends here
};

struct Crossing
{
  double Position = 0.0;
  int Root = 0;
};

/// A straight line between cells: crossings [First, Last) ascending.
struct Line
{
  std::size_t First = 0;
  std::size_t Last = 0;
  bool Positive = false; // at its lower end
};

struct Cell
{
  RealArray<2> Lower{};
  RealArray<2> Upper{};
  std::array<int, 4> Lines{}; // by side
  std::size_t Block = 0;
};

/// Crossings on the four sides of a cell.
struct CellBorder
{
  std::array<std::size_t, 4> First{};
  std::array<std::size_t, 4> Last{};
  std::array<bool, 4> Begin{}; // sign at the lower end of the side
  std::size_t Count() const
  {
    std::size_t n = 0;
    for (std::size_t s = 0; s < 4; ++s)
    {
      n += this->Last[s] - this->First[s];
    }
    return n;
  }
};

struct Arc
{
  int From = 0;
  int To = 0;
  std::size_t FirstPoint = 0;
  std::size_t LastPoint = 0;
  double MaxValue = 0.0;
};

/// Signs of the differences of neighbouring coefficients along a direction.
struct Trend
{
  bool Rises = true;
  bool Falls = true;
  double Bend = 0.0; // sum of the second differences
};
}

class ContourCells::Work
{
public:
  void Trace(const ContourElement& element, const double* g, const std::array<BorderSide, 4>& sides,
    ContourPieces& pieces)
  {
    this->Start(element, g, sides);
    for (std::size_t cell = 0; cell < this->Cells.size(); ++cell)
    {
      if (!this->Decide(cell, element.MaxCells))
      {
        const Cell& stuck = this->Cells[cell];
        pieces.Undecided.push_back(
          { element.Level, element.Element, { stuck.Lower, stuck.Upper } });
      }
    }
    this->Connect(element, pieces);
  }

private:
  void Start(const ContourElement& element, const double* g, const std::array<BorderSide, 4>& sides)
  {
    const IntArray<2>& degree = element.Degree;
    if (degree != this->Degree)
    {
      this->Degree = degree;
      for (std::size_t d = 0; d < 2; ++d)
      {
        const std::size_t n = static_cast<std::size_t>(degree[d] + 1);
        this->Halves[d][0].resize(n * n);
        this->Halves[d][1].resize(n * n);
        BernsteinRestriction(degree[d], 0.0, 0.5, this->Halves[d][0].data());
        BernsteinRestriction(degree[d], 0.5, 1.0, this->Halves[d][1].data());
      }
    }
    this->Refiner.SetElement(element);
    this->Size = static_cast<std::size_t>(NumTensorFunctions<2>(degree));
    this->Blocks.assign(g, g + this->Size);
    this->Roots.clear();
    this->Crossings.clear();
    this->Lines.clear();
    this->Arcs.clear();
    this->ArcPoints.clear();
    this->Cells.assign(1, Cell{ { 0.0, 0.0 }, { 1.0, 1.0 }, { 0, 1, 2, 3 }, 0 });
    for (std::size_t s = 0; s < 4; ++s)
    {
      this->BeginLine(sides[s].Positive);
      for (const BorderRoot& root : sides[s].Roots)
      {
        RealArray<2> point;
        point[s / 2] = static_cast<double>(s % 2);
        point[1 - s / 2] = root.Position;
        this->AddRoot(point, root.Position, root.Id);
      }
    }
  }
  void BeginLine(bool positive)
  {
    this->Lines.push_back({ this->Crossings.size(), this->Crossings.size(), positive });
  }
  void AddRoot(const RealArray<2>& point, double position, int id)
  {
    this->Crossings.push_back({ position, static_cast<int>(this->Roots.size()) });
    this->Lines.back().Last = this->Crossings.size();
    this->Roots.push_back({ point, id, -1, false });
  }

  /// First crossing of a line at or above a position.
  std::size_t FindCrossing(const Line& line, double position) const
  {
    std::size_t i = line.First;
    while (i < line.Last && this->Crossings[i].Position < position)
    {
      ++i;
    }
    return i;
  }
  bool IsPositiveBefore(const Line& line, std::size_t crossing) const
  {
    return line.Positive != ((crossing - line.First) % 2 == 1);
  }
  CellBorder Border(const Cell& cell) const
  {
    CellBorder border;
    for (std::size_t s = 0; s < 4; ++s)
    {
      const Line& line = this->Lines[static_cast<std::size_t>(cell.Lines[s])];
      const std::size_t along = 1 - s / 2;
      border.First[s] = this->FindCrossing(line, cell.Lower[along]);
      border.Last[s] = this->FindCrossing(line, cell.Upper[along]);
      border.Begin[s] = this->IsPositiveBefore(line, border.First[s]);
    }
    return border;
  }

  Trend FindTrend(const double* g, std::size_t d) const
  {
    const int width = this->Degree[0] + 1;
    const int step = d == 0 ? 1 : width;
    Trend trend;
    for (int j = 0; j <= this->Degree[1] - (d == 1 ? 1 : 0); ++j)
    {
      for (int i = 0; i <= this->Degree[0] - (d == 0 ? 1 : 0); ++i)
      {
        const double* c = g + j * width + i;
        const double difference = c[step] - c[0];
        trend.Rises &= difference >= 0.0;
        trend.Falls &= difference <= 0.0;
        if ((d == 0 ? i : j) > 0)
        {
          trend.Bend += std::abs(difference - (c[0] - c[-step]));
        }
      }
    }
    return trend;
  }

  /// False when the cell stays undecided; its arcs are then as if it were one point of the upper
  /// set.
  bool Decide(std::size_t index, int maxCells)
  {
    const Cell cell = this->Cells[index];
    const double* g = this->Blocks.data() + cell.Block;
    const CellBorder border = this->Border(cell);
    const std::size_t numRoots = border.Count();
    const auto positive = std::count_if(g, g + this->Size, IsPositive);
    if (positive == 0 || positive == static_cast<std::ptrdiff_t>(this->Size))
    {
      return numRoots == 0 || this->CutOff(cell, border, positive > 0);
    }
    const std::array<Trend, 2> trends{ this->FindTrend(g, 0), this->FindTrend(g, 1) };
    const std::array<bool, 2> monotone{ trends[0].Rises || trends[0].Falls,
      trends[1].Rises || trends[1].Falls };
    if ((monotone[0] || monotone[1]) && numRoots == 0)
    {
      return true;
    }
    for (std::size_t d = 0; d < 2; ++d)
    {
      if (monotone[d] && this->Sweep(cell, border, d, trends[d].Rises, monotone))
      {
        return true;
      }
    }
    const RealArray<2> size{ cell.Upper[0] - cell.Lower[0], cell.Upper[1] - cell.Lower[1] };
    if (std::min(size[0], size[1]) < SmallestCell ||
      this->Cells.size() >= static_cast<std::size_t>(maxCells))
    {
      this->CutOff(cell, border, true);
      return false;
    }
    std::size_t d = size[1] > size[0] ? 1 : 0;
    if (trends[d].Bend * 2.0 < trends[1 - d].Bend && size[d] < 4096.0 * size[1 - d])
    {
      d = 1 - d;
    }
    this->Split(cell, d);
    return true;
  }

  void Split(const Cell& cell, std::size_t d)
  {
    const std::size_t along = 1 - d;
    const double middle = 0.5 * (cell.Lower[d] + cell.Upper[d]);
    std::array<Cell, 2> halves{ cell, cell };
    for (std::size_t k = 0; k < 2; ++k)
    {
      halves[k].Block = this->Blocks.size();
      this->Blocks.resize(this->Blocks.size() + this->Size);
      std::array<const double*, 2> factors{ nullptr, nullptr };
      factors[d] = this->Halves[d][k].data();
      ApplyFactors<2>(this->Degree, factors, this->Blocks.data() + cell.Block,
        this->Blocks.data() + halves[k].Block);
    }
    // the line between the halves
    const int width = this->Degree[0] + 1;
    const int n = this->Degree[along];
    const double* upper = this->Blocks.data() + halves[1].Block;
    double values[MaxDegree + 1];
    for (int k = 0; k <= n; ++k)
    {
      values[k] = upper[along == 0 ? k : k * width];
    }
    std::array<bool, 2> ends;
    for (std::size_t end = 0; end < 2; ++end)
    {
      const Line& line = this->Lines[static_cast<std::size_t>(cell.Lines[2 * along + end])];
      ends[end] = this->IsPositiveBefore(line, this->FindCrossing(line, middle));
    }
    SetEndSigns(n, values, ends[0], ends[1]);
    this->Places.clear();
    FindSignChanges(n, values, this->Places);
    const int line = static_cast<int>(this->Lines.size());
    this->BeginLine(ends[0]);
    const double low = cell.Lower[along];
    const double high = cell.Upper[along];
    double previous = low;
    for (double place : this->Places)
    {
      const double position =
        std::clamp(low + place * (high - low), previous, std::nextafter(high, low));
      RealArray<2> point;
      point[d] = middle;
      point[along] = previous = position;
      this->AddRoot(point, position, -1);
    }
    halves[0].Upper[d] = halves[1].Lower[d] = middle;
    halves[0].Lines[2 * d + 1] = halves[1].Lines[2 * d] = line;
    this->Cells.push_back(halves[0]);
    this->Cells.push_back(halves[1]);
  }

  /// Arcs of a cell in which g is monotone along d: for every place along the other direction at
  /// most one. False when the crossings do not fit.
  bool Sweep(const Cell& cell, const CellBorder& border, std::size_t d, bool rises,
    const std::array<bool, 2>& monotone)
  {
    const std::size_t along = 1 - d;
    const std::size_t low = 2 * d + (rises ? 0 : 1); // g rises from here
    const std::size_t high = 2 * d + (rises ? 1 : 0);
    const std::size_t first = 2 * along;
    const std::size_t last = first + 1;
    bool positiveLow = border.Begin[low];
    bool positiveHigh = border.Begin[high];
    int open = -1;
    this->Pairs.clear();
    const auto one = [&](std::size_t side, bool wanted)
    { return border.Last[side] - border.First[side] == (wanted ? 1u : 0u); };
    if ((positiveLow && !positiveHigh) || !one(first, positiveLow != positiveHigh))
    {
      return false;
    }
    if (positiveLow != positiveHigh)
    {
      open = this->Crossings[border.First[first]].Root;
    }
    std::size_t i = border.First[low];
    std::size_t j = border.First[high];
    while (i < border.Last[low] || j < border.Last[high])
    {
      const bool hasLow = i < border.Last[low];
      const bool hasHigh = j < border.Last[high];
      bool takeLow =
        hasLow && (!hasHigh || this->Crossings[i].Position <= this->Crossings[j].Position);
      if (positiveLow == positiveHigh && takeLow != positiveLow)
      {
        // only one of the sides can change; right where both are the same place but for rounding
        if (!(hasLow && hasHigh) ||
          std::abs(this->Crossings[i].Position - this->Crossings[j].Position) >
            1e-9 * (cell.Upper[along] - cell.Lower[along]))
        {
          return false;
        }
        takeLow = !takeLow;
      }
      const int root = this->Crossings[takeLow ? i++ : j++].Root;
      bool& side = takeLow ? positiveLow : positiveHigh;
      side = !side;
      if (open < 0)
      {
        open = root;
      }
      else
      {
        this->Pairs.push_back({ open, root });
        open = -1;
      }
    }
    if (!one(last, open >= 0))
    {
      return false;
    }
    if (open >= 0)
    {
      this->Pairs.push_back({ open, this->Crossings[border.First[last]].Root });
    }
    MonotoneCell place;
    place.G = this->Blocks.data() + cell.Block;
    place.Lower = cell.Lower;
    place.Upper = cell.Upper;
    place.Monotone = monotone;
    const bool forward = (d == 1) == rises; // the upper set is on the left
    for (const std::array<int, 2>& pair : this->Pairs)
    {
      this->AddArc(place, forward ? pair[0] : pair[1], forward ? pair[1] : pair[0]);
    }
    return true;
  }

  /// Straight arcs around what is not of the middle's sign. @return false.
  bool CutOff(const Cell& cell, const CellBorder& border, bool positive)
  {
    this->Around.clear();
    for (std::size_t side : { 2, 1 })
    {
      for (std::size_t i = border.First[side]; i < border.Last[side]; ++i)
      {
        this->Around.push_back(this->Crossings[i].Root);
      }
    }
    for (std::size_t side : { 3, 0 })
    {
      for (std::size_t i = border.Last[side]; i > border.First[side]; --i)
      {
        this->Around.push_back(this->Crossings[i - 1].Root);
      }
    }
    // the contour enters where the upper set ends on the way around
    const std::size_t n = this->Around.size();
    const std::size_t entry = border.Begin[2] ? 0 : 1;
    MonotoneCell place;
    place.G = this->Blocks.data() + cell.Block;
    place.Lower = cell.Lower;
    place.Upper = cell.Upper;
    for (std::size_t i = entry; i < n; i += 2)
    {
      this->AddArc(place, this->Around[i], this->Around[(i + (positive ? 1 : n - 1)) % n]);
    }
    return false;
  }

  void AddArc(const MonotoneCell& cell, int from, int to)
  {
    Root& start = this->Roots[static_cast<std::size_t>(from)];
    Root& end = this->Roots[static_cast<std::size_t>(to)];
    start.Arc = static_cast<int>(this->Arcs.size());
    end.Ends = true;
    Arc arc{ from, to, this->ArcPoints.size(), 0, 0.0 };
    arc.MaxValue = this->Refiner.Refine(cell, start.Point, end.Point, this->ArcPoints);
    arc.LastPoint = this->ArcPoints.size();
    this->Arcs.push_back(arc);
  }

  /// Arcs one after another: first those that enter the element, then loops.
  void Connect(const ContourElement& element, ContourPieces& pieces)
  {
    this->Used.assign(this->Arcs.size(), false);
    for (const Root& root : this->Roots)
    {
      if (root.Arc >= 0 && !root.Ends)
      {
        this->Follow(root.Arc, element, pieces);
      }
    }
    for (std::size_t arc = 0; arc < this->Arcs.size(); ++arc)
    {
      if (!this->Used[arc])
      {
        this->Follow(static_cast<int>(arc), element, pieces);
      }
    }
  }
  void Follow(int first, const ContourElement& element, ContourPieces& pieces)
  {
    ContourPath path;
    path.Level = element.Level;
    path.Element = element.Element;
    path.FirstPoint = pieces.Points.size();
    const int start = this->Arcs[static_cast<std::size_t>(first)].From;
    int at = start;
    do
    {
      const Root& root = this->Roots[static_cast<std::size_t>(at)];
      const Arc& arc = this->Arcs[static_cast<std::size_t>(root.Arc)];
      this->Used[static_cast<std::size_t>(root.Arc)] = true;
      pieces.Points.push_back(root.Point);
      pieces.Points.insert(pieces.Points.end(),
        this->ArcPoints.begin() + static_cast<std::ptrdiff_t>(arc.FirstPoint),
        this->ArcPoints.begin() + static_cast<std::ptrdiff_t>(arc.LastPoint));
      path.MaxValue = std::max(path.MaxValue, arc.MaxValue);
      at = arc.To;
    } while (at != start && this->Roots[static_cast<std::size_t>(at)].Arc >= 0);
    if (at != start)
    {
      path.From = this->Roots[static_cast<std::size_t>(start)].Id;
      path.To = this->Roots[static_cast<std::size_t>(at)].Id;
      pieces.Points.push_back(this->Roots[static_cast<std::size_t>(at)].Point);
    }
    path.NumPoints = pieces.Points.size() - path.FirstPoint;
    pieces.Paths.push_back(path);
  }

  ContourArcs Refiner;
  IntArray<2> Degree{ -1, -1 };
  std::array<std::array<std::vector<double>, 2>, 2> Halves;
  std::size_t Size = 0;
  std::vector<double> Blocks;
  std::vector<Cell> Cells;
  std::vector<Line> Lines;
  std::vector<Crossing> Crossings;
  std::vector<Root> Roots;
  std::vector<Arc> Arcs;
  std::vector<RealArray<2>> ArcPoints;
  std::vector<double> Places;
  std::vector<std::array<int, 2>> Pairs;
  std::vector<int> Around;
  std::vector<bool> Used;
};

ContourCells::ContourCells() : Scratch(std::make_unique<Work>()) {}

ContourCells::~ContourCells() = default;

void ContourCells::Trace(const ContourElement& element, const double* g,
  const std::array<BorderSide, 4>& sides, ContourPieces& pieces)
{
  this->Scratch->Trace(element, g, sides, pieces);
}
}
