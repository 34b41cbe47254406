// SPDX-License-Identifier: BSD-3-Clause
#include "Contours.h"

#include "ContourChains.h"
#include "ContourRoots.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double RelativeShift = 0x1p-46;
constexpr double NearestPoints = 1e-10; // of an element
constexpr std::size_t Chunk = 64;
constexpr std::size_t Batch = 64 * Chunk; // between calls of the progress callback

class Tracer
{
public:
  Tracer(const BezierForm<2>& form, const ContourParams& params)
    : Form(form), Params(params), Space(*form.Space),
      Component(params.Component < 0 ? form.NumComponents - 1 : params.Component)
  {
  }

  Result<ContourSet> Run()
  {
    for (const auto& act : { &Tracer::CheckParams, &Tracer::FindRanges, &Tracer::FindLevels,
           &Tracer::FindSides, &Tracer::TraceElements })
    {
      if (const Status status = (this->*act)(); !status)
      {
        return status;
      }
    }
    this->Link();
    if (!this->Report(1.0))
    {
      return Status(ErrorCode::Aborted, "contours");
    }
    return std::move(this->Contours);
  }

private:
  bool Report(double share) const { return !this->Params.Progress || this->Params.Progress(share); }
  std::size_t Size(std::size_t e) const
  {
    return static_cast<std::size_t>(NumTensorFunctions<2>(this->Space.Elements[e].Degree));
  }
  const double* Values(std::size_t e) const
  {
    return this->Form.Block(static_cast<int>(e)) +
      static_cast<std::size_t>(this->Component) * this->Size(e);
  }
  const double* Weights(std::size_t e) const
  {
    return this->Form.Rational ? this->Form.Block(static_cast<int>(e)) +
        static_cast<std::size_t>(this->Form.NumComponents) * this->Size(e)
                               : nullptr;
  }

  Status CheckParams()
  {
    const auto bad = [](const std::string& what)
    { return Status(ErrorCode::InvalidParameter, what); };
    if (!this->Form.Space || this->Space.NumElements() == 0)
    {
      return { ErrorCode::EmptyInput, "the surface has no elements" };
    }
    if (this->Component >= this->Form.NumComponents)
    {
      return { ErrorCode::DimensionMismatch,
        "component " + std::to_string(this->Component) + " of a surface with " +
          std::to_string(this->Form.NumComponents) };
    }
    if (this->Params.NumSpaceComponents > this->Form.NumComponents)
    {
      return { ErrorCode::DimensionMismatch,
        std::to_string(this->Params.NumSpaceComponents) + " space components of " +
          std::to_string(this->Form.NumComponents) };
    }
    for (double level : this->Params.Levels)
    {
      if (!(std::abs(level) <= LargestNumber))
      {
        return bad("levels must be finite");
      }
    }
    if (this->Params.Levels.empty() && this->Params.NumLevels < 1)
    {
      return bad("the number of levels must be at least 1");
    }
    if (!(this->Params.Tolerance >= 0.0) || !(this->Params.Tolerance <= LargestNumber))
    {
      return bad("the tolerance must be positive (0: chosen)");
    }
    if (!(this->Params.ChordTolerance >= 0.0))
    {
      return bad("the chord tolerance must not be negative");
    }
    if (this->Params.MaxCells < 16 || this->Params.MaxCells > 1 << 20)
    {
      return bad("the number of cells must lie in [16, 1048576]");
    }
    if (this->Params.MaxPoints < 1)
    {
      return bad("the number of points must be at least 1");
    }
    return {};
  }

  Status FindRanges()
  {
    const std::size_t n = this->Space.Elements.size();
    this->Ranges.resize(n);
    this->LeastWeights.assign(n, 1.0);
    std::vector<std::uint8_t> bad(n, 0);
    ParallelFor(n, 16 * Chunk, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          const std::size_t size = this->Size(e);
          const double* values = this->Values(e);
          const double* weights = this->Weights(e);
          if (weights)
          {
            this->LeastWeights[e] = *std::min_element(weights, weights + size);
          }
          this->Ranges[e] = CoefficientRange(size, values, weights);
          bool good = this->LeastWeights[e] >= 1.0 / LargestWeight;
          for (std::size_t k = 0; k < size; ++k)
          {
            good = good && std::abs(values[k]) <= LargestNumber;
            good = good && (!weights || weights[k] <= LargestWeight);
          }
          bad[e] = good ? 0 : 1;
        }
      });
    const auto first = std::find(bad.begin(), bad.end(), 1);
    if (first != bad.end())
    {
      return { ErrorCode::NonFiniteInput,
        "values or weights of element " + std::to_string(first - bad.begin()) +
          " are not finite or too large" };
    }
    return {};
  }

  Status FindLevels()
  {
    const std::array<double, 2> corners = CornerRange(this->Form, this->Component);
    this->Contours.Tolerance = this->Params.Tolerance;
    if (this->Params.Tolerance == 0.0)
    {
      const double range = corners[1] - corners[0];
      this->Contours.Tolerance = 1e-4 * (range > 0.0 ? range : std::max(1.0, std::abs(corners[0])));
    }
    std::vector<double>& levels = this->Contours.Levels;
    levels = this->Params.Levels.empty() ? ContourLevels(corners, this->Params.NumLevels)
                                         : this->Params.Levels;
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return this->Report(0.1) ? Status() : Status(ErrorCode::Aborted, "contours");
  }

  Status FindSides()
  {
    this->Sides =
      FindElementSides(this->Form, this->Component, this->Params.JoinSeams, this->Params.Threads);
    if (const Status status = this->ShiftLevels(); !status)
    {
      return status;
    }
    this->Roots =
      FindSideRoots(this->Form, this->Component, this->Sides, this->Shifted, this->Params.Threads);
    return this->Report(0.3) ? Status() : Status(ErrorCode::Aborted, "contours");
  }
  Status ShiftLevels()
  {
    for (double level : this->Contours.Levels)
    {
      double size = std::abs(level);
      for (const std::array<double, 2>& range : this->Ranges)
      {
        if (range[0] <= level && level <= range[1])
        {
          size = std::max({ size, std::abs(range[0]), std::abs(range[1]) });
        }
      }
      ShiftedLevel shifted;
      shifted.Shift = std::max(RelativeShift * size, 4.0 * this->Sides.LargestGap);
      shifted.Value = level - shifted.Shift;
      this->Shifted.push_back(shifted);
      if (shifted.Shift > 0.25 * this->Contours.Tolerance)
      {
        return { ErrorCode::InvalidParameter,
          "tolerance " + Digits(this->Contours.Tolerance) +
            " is within rounding of values around " + Digits(level) + "; choose at least " +
            Digits(4.0 * shifted.Shift) };
      }
    }
    return {};
  }

  /// Largest change of g along a way of length 1 in both local parameters.
  static double Slope(const IntArray<2>& degree, const double* g)
  {
    double slope[2] = { 0.0, 0.0 };
    const int width = degree[0] + 1;
    for (int j = 0; j <= degree[1]; ++j)
    {
      for (int i = 0; i <= degree[0]; ++i)
      {
        const double* c = g + j * width + i;
        slope[0] = std::max(slope[0], i > 0 ? std::abs(c[0] - c[-1]) : 0.0);
        slope[1] = std::max(slope[1], j > 0 ? std::abs(c[0] - c[-width]) : 0.0);
      }
    }
    return degree[0] * slope[0] + degree[1] * slope[1];
  }

  /// Positions other than the traced component are polynomials of degree 1: straight pieces lie as
  /// near to the surface as their values to each other.
  bool IsFlat(std::size_t e) const
  {
    if (this->Form.Rational)
    {
      return false;
    }
    const IntArray<2>& degree = this->Space.Elements[e].Degree;
    const int size = NumTensorFunctions<2>(degree);
    const int width = degree[0] + 1;
    for (int c = 0; c < this->NumSpace(); ++c)
    {
      const double* x = this->Form.Block(static_cast<int>(e)) + c * size;
      const double du = (x[width - 1] - x[0]) / degree[0];
      const double dv = (x[size - width] - x[0]) / degree[1];
      const double rounding =
        1e-12 * std::max({ std::abs(x[0]), std::abs(x[width - 1]), std::abs(x[size - width]) });
      for (int k = 0; c != this->Component && k < size; ++k)
      {
        if (std::abs(x[k] - (x[0] + k % width * du + k / width * dv)) > rounding)
        {
          return false;
        }
      }
    }
    return true;
  }
  int NumSpace() const
  {
    return this->Params.NumSpaceComponents < 0 ? this->Component : this->Params.NumSpaceComponents;
  }

  struct Traced
  {
    ContourPieces Pieces;
    std::vector<double> Merges;    // a path
    std::vector<double> MaxErrors; // a path
  };

  bool HasTooManyPoints() const
  {
    return this->NumPoints > static_cast<std::size_t>(this->Params.MaxPoints);
  }

  void TraceElement(std::size_t e, ContourCells& cells, Traced& traced)
  {
    const std::size_t size = this->Size(e);
    const double* values = this->Values(e);
    const double* weights = this->Weights(e);
    ContourElement element;
    element.Degree = this->Space.Elements[e].Degree;
    element.Element = static_cast<int>(e);
    const bool easy = this->Params.ChordTolerance >= 2.0 * this->Contours.Tolerance;
    element.ChordTolerance = easy && this->IsFlat(e) ? 0.0 : this->Params.ChordTolerance;
    element.MaxCells = this->Params.MaxCells;
    element.NumComponents = this->Form.NumComponents;
    element.NumSpaceComponents = this->NumSpace();
    element.Rational = this->Form.Rational;
    element.Block = this->Form.Block(element.Element);
    const double least = this->LeastWeights[e];
    double g[(MaxDegree + 1) * (MaxDegree + 1)];
    std::array<BorderSide, 4> border;
    for (std::size_t l = 0; l < this->Shifted.size() && !this->HasTooManyPoints(); ++l)
    {
      const ShiftedLevel& level = this->Shifted[l];
      // neighbours that cross the level on a common side are that near here
      if (this->Ranges[e][0] >= level.Value + level.Shift ||
        this->Ranges[e][1] < level.Value - level.Shift)
      {
        continue;
      }
      for (std::size_t k = 0; k < size; ++k)
      {
        g[k] = values[k] - level.Value * (weights ? weights[k] : 1.0);
      }
      element.Level = static_cast<int>(l);
      element.Tolerance = (0.99 * this->Contours.Tolerance - level.Shift) * least;
      for (int s = 0; s < NumSides; ++s)
      {
        this->Roots.Collect(this->Sides, element.Element, s, element.Level, level.Value,
          border[static_cast<std::size_t>(s)]);
      }
      const std::size_t before = traced.Pieces.Points.size();
      cells.Trace(element, g, border, traced.Pieces);
      this->NumPoints += traced.Pieces.Points.size() - before;
      const double slope = Slope(element.Degree, g) / least;
      const double merge = std::min(NearestPoints, 1e-3 * this->Contours.Tolerance / slope);
      for (std::size_t p = traced.Merges.size(); p < traced.Pieces.Paths.size(); ++p)
      {
        traced.Merges.push_back(merge);
        traced.MaxErrors.push_back(
          traced.Pieces.Paths[p].MaxValue / least + level.Shift + 2.0 * merge * slope);
      }
    }
  }

  Status TraceElements()
  {
    const std::size_t n = this->Space.Elements.size();
    this->Chunks.resize((n + Chunk - 1) / Chunk);
    for (std::size_t start = 0; start < n; start += Batch)
    {
      ParallelFor(std::min(Batch, n - start), Chunk, this->Params.Threads,
        [&](std::size_t begin, std::size_t end)
        {
          ContourCells cells;
          for (std::size_t e = start + begin; e < start + end; ++e)
          {
            this->TraceElement(e, cells, this->Chunks[e / Chunk]);
          }
        });
      if (this->HasTooManyPoints())
      {
        return { ErrorCode::TooLarge,
          "the contours would have more than " + std::to_string(this->Params.MaxPoints) +
            " points; ask for fewer levels or a larger tolerance, or raise MaximumPoints if the "
            "memory suffices" };
      }
      if (!this->Report(0.3 + 0.6 * static_cast<double>(start) / static_cast<double>(n)))
      {
        return { ErrorCode::Aborted, "contours" };
      }
    }
    return {};
  }

  void Link()
  {
    std::vector<LinkedPath> paths;
    for (const Traced& traced : this->Chunks)
    {
      for (std::size_t p = 0; p < traced.Pieces.Paths.size(); ++p)
      {
        const ContourPath& path = traced.Pieces.Paths[p];
        paths.push_back({ path, traced.Pieces.Points.data() + path.FirstPoint, traced.Merges[p],
          traced.MaxErrors[p] });
      }
      for (UndecidedBox box : traced.Pieces.Undecided)
      {
        const ParametricBox<2>& element =
          this->Space.Elements[static_cast<std::size_t>(box.Element)].Box;
        for (std::size_t d = 0; d < 2; ++d)
        {
          const double length = element.Upper[d] - element.Lower[d];
          box.Box.Lower[d] = element.Lower[d] + box.Box.Lower[d] * length;
          box.Box.Upper[d] = element.Lower[d] + box.Box.Upper[d] * length;
        }
        this->Contours.Undecided.push_back(box);
      }
    }
    std::stable_sort(this->Contours.Undecided.begin(), this->Contours.Undecided.end(),
      [](const UndecidedBox& a, const UndecidedBox& b) { return a.Level < b.Level; });
    std::vector<std::uint8_t> seams(this->Roots.Places.size(), 0);
    for (std::size_t p = 0; p < this->Sides.Pieces.size(); ++p)
    {
      for (std::size_t r = this->Roots.Start[p]; r < this->Roots.Start[p + 1]; ++r)
      {
        seams[r] = this->Sides.Pieces[p].Seam ? 1 : 0;
      }
    }
    LinkContours(this->Space, paths, seams.size(), seams, this->Contours);
  }

  const BezierForm<2>& Form;
  const ContourParams& Params;
  const SplineSpace<2>& Space;
  int Component;
  std::vector<std::array<double, 2>> Ranges; // of the coefficients of elements
  std::vector<double> LeastWeights;
  std::vector<ShiftedLevel> Shifted;
  ElementSides Sides;
  SideRoots Roots;
  std::vector<Traced> Chunks;
  std::atomic<std::size_t> NumPoints{ 0 }; // of paths; whether they are too many is the same for
                                           // every order of elements
  ContourSet Contours;
};
}

std::array<double, 2> CornerRange(const BezierForm<2>& form, int component)
{
  std::array<double, 2> range{ HUGE_VAL, -HUGE_VAL };
  for (int e = 0; e < form.Space->NumElements(); ++e)
  {
    const IntArray<2> degree = form.Space->Elements[static_cast<std::size_t>(e)].Degree;
    const int size = NumTensorFunctions<2>(degree);
    for (int corner : { 0, degree[0], size - 1 - degree[0], size - 1 })
    {
      const double value = form.Block(e)[component * size + corner] /
        (form.Rational ? form.Block(e)[form.NumComponents * size + corner] : 1.0);
      range = { std::min(range[0], value), std::max(range[1], value) };
    }
  }
  return range;
}

std::vector<double> ContourLevels(const std::array<double, 2>& range, int n)
{
  std::vector<double> levels;
  for (int i = 1; i <= n; ++i)
  {
    const double share = static_cast<double>(i) / (n + 1);
    levels.push_back((1.0 - share) * range[0] + share * range[1]);
  }
  return levels;
}

Result<ContourSet> TraceContours(const BezierForm<2>& form, const ContourParams& params)
{
  if (!form.Space)
  {
    return { ErrorCode::EmptyInput, "the surface has no elements" };
  }
  return Tracer(form, params).Run();
}
}
