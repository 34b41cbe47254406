// SPDX-License-Identifier: BSD-3-Clause
// What LRRefinement holds: mesh lines, functions and the lists that find them.
#pragma once
#include "LRRefinement.h"

#include <algorithm>

namespace knotwork
{
struct LRRefinement::State
{
  /// Where a function's support lies, beside the list that it is in.
  struct Stretch
  {
    double Low; // in the list's other direction
    double High;
    double End; // in the list's own direction
    int Function;
  };

  /// What is asked of every line, in the order of their values.
  struct LineSummary
  {
    double Low = 0.0; // ends of the part with a positive multiplicity
    double High = 0.0;
    int Most = 0; // largest multiplicity
    int Line = 0;
  };

  static std::size_t At(int i) { return static_cast<std::size_t>(i); }

  std::array<int, 2> Order{}; // p + 2
  int Stride = 0;
  std::array<std::vector<double>, 2> Values; // of the knots, in the order of their creation
  RealArray<2> Begin{};
  RealArray<2> End{};
  std::array<std::vector<int>, 2> Ranks;
  std::array<std::vector<LineSummary>, 2> Sorted;
  std::array<std::vector<LRLine>, 2> Lines;

  int Columns = 0;
  std::vector<int> Local;
  std::vector<double> Scaling;
  std::vector<double> Rows;
  std::vector<std::uint64_t> Hashes;
  std::vector<unsigned char> Pending; // bit d: lines of direction d are to be looked at
  std::vector<int> Free;
  std::vector<int> Table; // function + 1, open addressing
  int Count = 0;
  std::array<std::vector<std::vector<Stretch>>, 2> Starts; // [d][knot]
  std::array<std::vector<int>, 2> Places;                  // of a function in its list
  std::vector<int> Queue;

  const int* Knots(int f, int d) const
  {
    return this->Local.data() + std::ptrdiff_t{ f } * this->Stride + (d == 0 ? 0 : this->Order[0]);
  }
  double Value(int d, int knot) const { return this->Values[At(d)][At(knot)]; }
  double Low(int f, int d) const { return this->Value(d, this->Knots(f, d)[0]); }
  double High(int f, int d) const
  {
    return this->Value(d, this->Knots(f, d)[this->Order[At(d)] - 1]);
  }

  // mesh lines (LRLines.cxx)

  /// Smallest multiplicity of a line of direction d between two values of the other direction.
  int Multiplicity(int d, const LRLine& line, double low, double high) const
  {
    const auto after = std::upper_bound(line.begin(), line.end(), low,
      [&](double value, const LRPiece& piece) { return value < this->Value(1 - d, piece.Knot); });
    auto piece = after == line.begin() ? after : after - 1;
    int least = piece->Multiplicity;
    for (++piece; piece != line.end() && this->Value(1 - d, piece->Knot) < high; ++piece)
    {
      least = std::min(least, piece->Multiplicity);
    }
    return least;
  }

  /// The line with at least a multiplicity between two knots of the other direction.
  LRLine Raised(int d, const LRLine& line, int start, int end, int multiplicity) const;

  LineSummary Summary(int d, int id) const;

  /// Knot at a value up to the tolerance, -1 when there is none.
  int FindKnot(int d, double value) const;

  int AddKnot(int d, double value);

  // functions (LRFunctions.cxx)

  std::uint64_t HashOf(const int* local) const;

  std::size_t Home(std::uint64_t hash) const { return hash & (this->Table.size() - 1); }

  /// Slot of a function with these local knots, or the empty slot where it belongs.
  std::size_t Slot(const int* local, std::uint64_t hash) const;

  void GrowTable();
  void Link(int f);
  void Unlink(int f);
  int NewFunction();

  /// Adds gamma * row to the function with these local knots, which is made when there is none.
  void Add(const int* local, double gamma, const double* row, unsigned char pending);

  /// A line that traverses the support of a function, and how often it is missing among its knots.
  struct Traverse
  {
    int Function;
    int Line;
    int Times;
  };

  /// Replaces a function by its parts at a line of direction d inside its support.
  void Split(const Traverse& traverse, int d, unsigned char pending);

  /// Adds gamma * row to the parts of a function at a knot that comes in some times; a knot that is
  /// not inside the support is not missing.
  void AddParts(const int* local, double gamma, const double* row, int d, int knot, int times,
    unsigned char pending);

  static int CountKnot(const int* local, int n, int knot)
  {
    return static_cast<int>(std::count(local, local + n, knot));
  }

  /// A line of direction d that traverses the support of a function and is not among its knots
  /// often enough; of line -1 when there is none.
  Traverse Traversing(int f, int d) const;

  /// Splits what is in the queue until nothing is traversed.
  void RestoreMinimalSupport();

  // insertion (LRRefinement.cxx)

  /// What an insertion is about, in knots. Line is -1 while there is no such line.
  struct Request
  {
    int Direction;
    int Line;
    double Value;
    int Start;
    int End;
    int Multiplicity;
  };
  Status Resolve(const LRSegment& segment, Request& request) const;
  Status CheckEnds(const Request& request, const LRLine& before, const LRLine& after) const;
  std::vector<Traverse> FindTraversed(const Request& request, const LRLine& after) const;
};
}
