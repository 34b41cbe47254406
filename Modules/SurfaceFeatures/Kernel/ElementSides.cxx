// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSides.h"

#include "SignRoots.h"
#include <knotwork/SplineCore/DisjointSets.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace knotwork
{
namespace
{
constexpr double JumpTolerance = 1e-9; // of the coefficients

/// A side of an element on a line of the domain, in ranks of the domain's coordinates.
struct LineSide
{
  int Line = 0;
  int Begin = 0;
  int End = 0;
  int Element = 0;
};

/// Coordinates that differ by rounding only are one.
class CoordinateRanks
{
public:
  CoordinateRanks(const SplineSpace<2>& space, std::size_t direction)
  {
    std::vector<double> all;
    all.reserve(2 * space.Elements.size());
    for (const SplineSpace<2>::Element& element : space.Elements)
    {
      all.push_back(element.Box.Lower[direction]);
      all.push_back(element.Box.Upper[direction]);
    }
    std::sort(all.begin(), all.end());
    this->Gap = 1e-13 * (all.back() - all.front());
    for (double value : all)
    {
      if (this->Values.empty() || value - this->Values.back() > this->Gap)
      {
        this->Values.push_back(value);
      }
    }
  }
  int Of(double value) const
  {
    return static_cast<int>(
      std::upper_bound(this->Values.begin(), this->Values.end(), value) - this->Values.begin() - 1);
  }
  int Last() const { return static_cast<int>(this->Values.size()) - 1; }
  double Value(int rank) const { return this->Values[static_cast<std::size_t>(rank)]; }

private:
  std::vector<double> Values;
  double Gap = 0.0;
};

class SideFinder
{
public:
  SideFinder(const BezierForm<2>& form, int component, bool seams, int threads)
    : Form(form), Space(*form.Space), Component(component), Seams(seams && form.NumComponents > 1),
      Threads(threads)
  {
  }

  ElementSides Run()
  {
    if (this->Space.HasDomain())
    {
      this->FindByBoxes();
    }
    else
    {
      this->FindByFunctions();
    }
    this->CutJumps();
    this->ListPieces();
    this->JoinVertices();
    return std::move(this->Sides);
  }

private:
  int NumElements() const { return this->Space.NumElements(); }
  IntArray<2> Degree(int e) const
  {
    return this->Space.Elements[static_cast<std::size_t>(e)].Degree;
  }

  // ---- values along sides
  /// Coefficients of a plane along a side.
  int SideValues(int e, int side, int plane, double* values) const
  {
    const IntArray<2> degree = this->Degree(e);
    const double* block = this->Form.Block(e) + plane * NumTensorFunctions<2>(degree);
    const int p = degree[SideDirections<2>(side)[0]];
    for (int k = 0; k <= p; ++k)
    {
      values[k] = block[SideCoefficient(degree, side, k)];
    }
    return p;
  }
  /// Largest difference of a component along a piece; size is that of the coefficients.
  double Difference(const SidePiece& piece, int component, double* size) const
  {
    double value[2][MaxDegree + 1];
    double weight[2][MaxDegree + 1];
    int degree[2];
    *size = 0.0;
    for (std::size_t k = 0; k < 2; ++k)
    {
      degree[k] = this->SideValues(piece.Element[k], piece.Side[k], component, value[k]);
      std::fill(weight[k], weight[k] + MaxDegree + 1, 1.0);
      if (this->Form.Rational)
      {
        this->SideValues(piece.Element[k], piece.Side[k], this->Form.NumComponents, weight[k]);
      }
      for (int i = 0; i <= degree[k]; ++i)
      {
        *size = std::max(*size, std::abs(value[k][i] / weight[k][i]));
      }
    }
    if (!this->Form.Rational && degree[0] == degree[1] && piece.Begin[0] == piece.Begin[1] &&
      piece.End[0] == piece.End[1])
    {
      double largest = 0.0; // bounds the difference
      for (int i = 0; i <= degree[0]; ++i)
      {
        largest = std::max(largest, std::abs(value[0][i] - value[1][i]));
      }
      return largest;
    }
    const int samples = degree[0] + degree[1]; // as many as a difference of degree p + q may vanish
    double difference = 0.0;
    for (int i = 0; i <= samples; ++i)
    {
      const double s = static_cast<double>(i) / samples;
      double f[2];
      for (std::size_t k = 0; k < 2; ++k)
      {
        const double t = piece.Begin[k] + s * (piece.End[k] - piece.Begin[k]);
        f[k] = EvaluateBernstein(degree[k], value[k], t, nullptr);
        f[k] /= this->Form.Rational ? EvaluateBernstein(degree[k], weight[k], t, nullptr) : 1.0;
      }
      difference = std::max(difference, std::abs(f[0] - f[1]));
    }
    return difference;
  }
  /// Difference of the values along a piece; -1 where they jump.
  double FindGap(const SidePiece& piece) const
  {
    double size;
    const double gap = this->Difference(piece, this->Component, &size);
    bool continuous = gap <= JumpTolerance * size;
    for (int c = 0; piece.Seam && continuous && c < this->Form.NumComponents; ++c)
    {
      continuous = this->Difference(piece, c, &size) <= JumpTolerance * size;
    }
    return continuous ? gap : -1.0;
  }

  // ---- pieces
  /// Pieces with a jump become two on the boundary.
  void CutJumps()
  {
    std::vector<SidePiece> pieces;
    pieces.swap(this->Sides.Pieces);
    std::vector<double> gaps(pieces.size(), 0.0);
    ParallelFor(pieces.size(), 512, this->Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t p = begin; p < end; ++p)
        {
          gaps[p] = pieces[p].Element[1] < 0 ? 0.0 : this->FindGap(pieces[p]);
        }
      });
    this->Sides.Pieces.reserve(pieces.size());
    for (std::size_t p = 0; p < pieces.size(); ++p)
    {
      const SidePiece& piece = pieces[p];
      this->Sides.LargestGap = std::max(this->Sides.LargestGap, gaps[p]);
      if (gaps[p] >= 0.0)
      {
        this->Sides.Pieces.push_back(piece);
        continue;
      }
      for (std::size_t k = 0; k < 2; ++k)
      {
        SidePiece alone;
        alone.Element[0] = piece.Element[k];
        alone.Side[0] = piece.Side[k];
        alone.Begin[0] = std::min(piece.Begin[k], piece.End[k]);
        alone.End[0] = std::max(piece.Begin[k], piece.End[k]);
        this->Sides.Pieces.push_back(alone);
      }
    }
  }

  /// Merges the sides below a line with those above it.
  void MergeLine(const CoordinateRanks& along, int direction, const std::vector<LineSide>& below,
    const std::vector<LineSide>& above, bool seam)
  {
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < below.size() && j < above.size())
    {
      const LineSide& a = below[i];
      const LineSide& b = above[j];
      const int begin = std::max(a.Begin, b.Begin);
      const int end = std::min(a.End, b.End);
      SidePiece piece;
      piece.Element = { a.Element, b.Element };
      piece.Side = { 2 * direction + 1, 2 * direction };
      piece.Seam = seam;
      for (std::size_t k = 0; k < 2; ++k)
      {
        const LineSide& side = k == 0 ? a : b;
        const double low = along.Value(side.Begin);
        const double length = along.Value(side.End) - low;
        piece.Begin[k] = begin == side.Begin ? 0.0 : (along.Value(begin) - low) / length;
        piece.End[k] = end == side.End ? 1.0 : (along.Value(end) - low) / length;
      }
      if (begin < end)
      {
        this->Sides.Pieces.push_back(piece);
      }
      i += a.End == end ? 1 : 0;
      j += b.End == end ? 1 : 0;
    }
  }
  void AddAlone(int side, const std::vector<LineSide>& sides)
  {
    for (const LineSide& alone : sides)
    {
      SidePiece piece;
      piece.Element[0] = alone.Element;
      piece.Side[0] = side;
      this->Sides.Pieces.push_back(piece);
    }
  }

  void FindByBoxes()
  {
    const std::array<CoordinateRanks, 2> ranks{ CoordinateRanks(this->Space, 0),
      CoordinateRanks(this->Space, 1) };
    for (int d = 0; d < 2; ++d)
    {
      const std::size_t across = static_cast<std::size_t>(d);
      const std::size_t along = 1 - across;
      // sides of all lines, those of elements below (0) and above (1)
      std::array<std::vector<std::vector<LineSide>>, 2> lines;
      lines[0].resize(static_cast<std::size_t>(ranks[across].Last() + 1));
      lines[1] = lines[0];
      for (int e = 0; e < this->NumElements(); ++e)
      {
        const ParametricBox<2>& box = this->Space.Elements[static_cast<std::size_t>(e)].Box;
        LineSide side;
        side.Begin = ranks[along].Of(box.Lower[along]);
        side.End = ranks[along].Of(box.Upper[along]);
        side.Element = e;
        lines[1][static_cast<std::size_t>(ranks[across].Of(box.Lower[across]))].push_back(side);
        lines[0][static_cast<std::size_t>(ranks[across].Of(box.Upper[across]))].push_back(side);
      }
      for (std::vector<std::vector<LineSide>>& half : lines)
      {
        for (std::vector<LineSide>& line : half)
        {
          std::sort(line.begin(), line.end(),
            [](const LineSide& a, const LineSide& b) { return a.Begin < b.Begin; });
        }
      }
      const std::size_t last = lines[0].size() - 1;
      for (std::size_t line = 1; line < last; ++line)
      {
        this->MergeLine(ranks[along], d, lines[0][line], lines[1][line], false);
      }
      if (this->Seams)
      {
        this->MergeLine(ranks[along], d, lines[0][last], lines[1][0], true);
      }
      else
      {
        this->AddAlone(2 * d, lines[1][0]);
        this->AddAlone(2 * d + 1, lines[0][last]);
      }
    }
  }

  void FindByFunctions()
  {
    struct Use
    {
      int Element;
      int Side;
      bool Reversed;
    };
    std::map<std::vector<int>, std::vector<Use>> sides;
    for (int e = 0; e < this->NumElements(); ++e)
    {
      const IntArray<2> degree = this->Degree(e);
      const int* ids = this->Space.LocalFunctions(e);
      for (int s = 0; s < NumSides; ++s)
      {
        std::vector<int> key;
        for (int k = 0; k <= degree[s < 2 ? 1 : 0]; ++k)
        {
          key.push_back(ids[SideCoefficient(degree, s, k)]);
        }
        std::vector<int> back(key.rbegin(), key.rend());
        const bool reversed = back < key;
        sides[reversed ? back : key].push_back({ e, s, reversed });
      }
    }
    for (const auto& [key, uses] : sides)
    {
      SidePiece piece;
      if (uses.size() == 2)
      {
        piece.Element = { uses[0].Element, uses[1].Element };
        piece.Side = { uses[0].Side, uses[1].Side };
        if (uses[0].Reversed != uses[1].Reversed)
        {
          piece.Begin[1] = 1.0;
          piece.End[1] = 0.0;
        }
        this->Sides.Pieces.push_back(piece);
        continue;
      }
      for (const Use& use : uses)
      {
        piece.Element[0] = use.Element;
        piece.Side[0] = use.Side;
        this->Sides.Pieces.push_back(piece);
      }
    }
  }

  // ---- lists and vertices
  void ListPieces()
  {
    std::vector<std::size_t>& start = this->Sides.Start;
    start.assign(static_cast<std::size_t>(NumSides * this->NumElements()) + 1, 0);
    const auto each = [this](auto&& body)
    {
      for (std::size_t p = 0; p < this->Sides.Pieces.size(); ++p)
      {
        const SidePiece& piece = this->Sides.Pieces[p];
        for (std::size_t k = 0; k < 2 && piece.Element[k] >= 0; ++k)
        {
          body(p, k, static_cast<std::size_t>(NumSides * piece.Element[k] + piece.Side[k]));
        }
      }
    };
    each([&](std::size_t, std::size_t, std::size_t side) { ++start[side + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    this->Sides.PieceIds.resize(start.back());
    this->Place.resize(2 * this->Sides.Pieces.size());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    each(
      [&](std::size_t p, std::size_t k, std::size_t side)
      {
        this->Place[2 * p + k] = static_cast<int>(next[side] - start[side]);
        this->Sides.PieceIds[next[side]++] = static_cast<int>(p);
      });
  }

  /// Number of a place on the border of an element: its corners, then the hanging ones of all
  /// elements. @param n  number on the side, 0 is the lower corner.
  int Node(int element, int side, int n) const
  {
    const std::size_t index = static_cast<std::size_t>(NumSides * element + side);
    const int pieces = static_cast<int>(this->Sides.Start[index + 1] - this->Sides.Start[index]);
    if (n > 0 && n < pieces)
    {
      return this->FirstHanging[index] + n - 1;
    }
    return 4 * element + PatchCorner<2>(side, n == 0 ? 0 : 1);
  }
  int PieceNode(std::size_t p, std::size_t k, bool atEnd) const
  {
    const SidePiece& piece = this->Sides.Pieces[p];
    const bool upper = atEnd == (piece.End[k] > piece.Begin[k]);
    return this->Node(piece.Element[k], piece.Side[k], this->Place[2 * p + k] + (upper ? 1 : 0));
  }
  void JoinVertices()
  {
    int numNodes = 4 * this->NumElements();
    this->FirstHanging.resize(this->Sides.Start.size() - 1);
    for (std::size_t s = 0; s < this->FirstHanging.size(); ++s)
    {
      this->FirstHanging[s] = numNodes;
      const std::size_t pieces = this->Sides.Start[s + 1] - this->Sides.Start[s];
      numNodes += pieces > 1 ? static_cast<int>(pieces) - 1 : 0;
    }
    this->Nodes = DisjointSets(numNodes); // a set's smallest is a corner when it has one
    for (std::size_t p = 0; p < this->Sides.Pieces.size(); ++p)
    {
      for (int end = 0; end < 2 && this->Sides.Pieces[p].Element[1] >= 0; ++end)
      {
        this->Nodes.Unite(this->PieceNode(p, 0, end == 1), this->PieceNode(p, 1, end == 1));
      }
    }
    this->NumberVertices(numNodes);
  }
  void NumberVertices(int numNodes)
  {
    std::vector<int> vertex(static_cast<std::size_t>(numNodes), -1);
    for (int node = 0; node < 4 * this->NumElements(); ++node)
    {
      if (this->Nodes.Find(node) == node)
      {
        vertex[static_cast<std::size_t>(node)] = static_cast<int>(this->Sides.Vertices.size());
        this->Sides.Vertices.push_back({ node / 4, { node % 2 * 1.0, node / 2 % 2 * 1.0 } });
      }
      this->Sides.Corners.push_back(vertex[static_cast<std::size_t>(this->Nodes.Find(node))]);
    }
    for (std::size_t p = 0; p < this->Sides.Pieces.size(); ++p)
    {
      SidePiece& piece = this->Sides.Pieces[p];
      for (std::size_t end = 0; end < 2; ++end)
      {
        const int node = this->Nodes.Find(this->PieceNode(p, 0, end == 1));
        int& number = vertex[static_cast<std::size_t>(node)];
        if (number < 0) // a hanging place at a jump
        {
          const double t = end == 0 ? piece.Begin[0] : piece.End[0];
          const double across = piece.Side[0] % 2;
          number = static_cast<int>(this->Sides.Vertices.size());
          this->Sides.Vertices.push_back({ piece.Element[0],
            piece.Side[0] < 2 ? RealArray<2>{ across, t } : RealArray<2>{ t, across } });
        }
        piece.Vertex[end] = number;
      }
    }
  }

  const BezierForm<2>& Form;
  const SplineSpace<2>& Space;
  int Component;
  bool Seams;
  int Threads;
  ElementSides Sides;
  std::vector<int> Place; // of a piece in the lists of its two sides
  std::vector<int> FirstHanging;
  DisjointSets Nodes;
};
}

ElementSides FindElementSides(const BezierForm<2>& form, int component, bool seams, int threads)
{
  return SideFinder(form, component, seams, threads).Run();
}
}
