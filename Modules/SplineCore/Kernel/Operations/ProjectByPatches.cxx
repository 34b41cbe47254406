// SPDX-License-Identifier: BSD-3-Clause
#include "CompositeProjection.h"

#include "DualFunctionals.h"
#include "Parallel.h"
#include "PatchSpaces.h"
#include "Quadrature.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <map>
#include <string>

namespace knotwork
{
namespace
{
/// Cells computed between two calls of the progress callback, unless a patch has more.
constexpr int BatchSize = 32768;
/// Numbers of a line that are reduced at a time: they stay in the nearest cache.
constexpr std::size_t LineSize = 512;

std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// From values at the Gauss points of a row of elements to coefficients of its B-splines: means of
/// the local L2 projections by the shares of the function's integral, elements as unit intervals.
struct LineProjection
{
  LineProjection(const KnotVector& knots, const PointMatrix& toBernstein)
    : Elements(knots.NumElements()), Functions(knots.NumFunctions()), Alive(knots.Degree() + 1),
      Points(static_cast<int>(toBernstein.cols()))
  {
    Eigen::VectorXd totals = Eigen::VectorXd::Zero(this->Functions);
    std::vector<PointMatrix> factors(At(this->Elements), PointMatrix(this->Alive, this->Alive));
    for (int e = 0; e < this->Elements; ++e)
    {
      knots.Extraction(e, factors[At(e)].data());
      this->First.push_back(knots.Span(e) - knots.Degree());
      totals.segment(this->First.back(), this->Alive) += factors[At(e)].rowwise().sum();
    }
    for (int e = 0; e < this->Elements; ++e)
    {
      const Eigen::VectorXd shares = factors[At(e)].rowwise().sum().array() /
        totals.segment(this->First[At(e)], this->Alive).array();
      if (e == 0 || factors[At(e)] != factors[At(e - 1)])
      {
        const PointMatrix inverse = factors[At(e)].partialPivLu().inverse();
        this->Local = inverse.transpose() * toBernstein;
      }
      this->Blocks.push_back(shares.asDiagonal() * this->Local);
    }
  }

  int Elements;
  int Functions;
  int Alive;                       ///< functions an element
  int Points;                      ///< Gauss points an element
  std::vector<int> First;          ///< function alive on an element
  std::vector<PointMatrix> Blocks; ///< an element: alive functions x Gauss points

private:
  PointMatrix Local;
};

/// sums += block * values of n components; as a template the loop over components is unrolled.
template <int Components>
void AddProducts(const PointMatrix& block, const double* values, int components, double* sums)
{
  if constexpr (Components > 0)
  {
    for (Eigen::Index i = 0; i < block.rows(); ++i, sums += Components)
    {
      const double* row = block.row(i).data();
      std::array<double, Components> sum{}; // not in memory that the values might lie in
      for (Eigen::Index g = 0; g < block.cols(); ++g)
      {
        for (int k = 0; k < Components; ++k)
        {
          sum[At(k)] += row[g] * values[g * Components + k];
        }
      }
      for (int k = 0; k < Components; ++k)
      {
        sums[k] += sum[At(k)];
      }
    }
  }
  else
  {
    Eigen::Map<PointMatrix>(sums, block.rows(), components) +=
      block.lazyProduct(Eigen::Map<const PointMatrix>(values, block.cols(), components));
  }
}

/// A patch while it is reduced, one direction after the other.
template <int Dim>
struct PatchWork
{
  int Patch = 0;
  std::vector<LineProjection> Lines;
  std::vector<double> Values; ///< components fastest, then the directions
  std::vector<double> Reduced;
};

/// A piece of the work on a patch: a row of cells; or part of a layer of lines.
struct Piece
{
  std::size_t Work;
  std::size_t Outer;
  std::size_t Inner;
};

template <int Dim>
class PatchProjection
{
public:
  PatchProjection(const CompositeProjection<Dim>& composite, int numComponents,
    const ElementFunction& function, const ProjectionParams& params)
    : Composite(composite), Components(numComponents), Function(function), Params(params),
      Degree(composite.Space->Unstructured->Degree), Points(this->Degree + 1 + params.ExtraPoints),
      ToBernstein(GaussToBernstein(this->Degree, this->Points)),
      Coefficients(composite.First.back(), numComponents)
  {
    IntArray<Dim> points;
    points.fill(this->Points);
    const PointMatrix local = MakeElementQuadrature<Dim>(points).Local;
    for (const IntArray<Dim>& ahead : composite.Layout.AheadOf)
    {
      if (this->Places.count(ahead) == 0)
      {
        const std::vector<int> turned = TurnedEntries<Dim>(this->Points, ahead);
        PointMatrix& own = this->Places[ahead];
        own.resize(local.rows(), Dim);
        for (Eigen::Index k = 0; k < own.rows(); ++k)
        {
          own.row(k) = local.row(turned[static_cast<std::size_t>(k)]);
        }
      }
    }
  }

  Status Run()
  {
    const int numPatches = static_cast<int>(this->Composite.Patches.size());
    std::size_t done = 0;
    for (int first = 0, end = 0; first < numPatches; first = end)
    {
      if (this->Params.Progress &&
        !this->Params.Progress(static_cast<double>(done) / this->Composite.Space->NumElements()))
      {
        return { ErrorCode::Aborted, "projection stopped before patch " + std::to_string(first) };
      }
      std::size_t cells = 0;
      while (end < numPatches && (end == first || cells < At(BatchSize)))
      {
        cells += this->Composite.Layout.Patches[At(end++)].Cells.size();
      }
      done += cells;
      if (Status status = this->Project(first, end); !status)
      {
        return status;
      }
    }
    if (this->Params.Progress && !this->Params.Progress(1.0))
    {
      return { ErrorCode::Aborted, "projection stopped after the last patch" };
    }
    return {};
  }

  PointMatrix Result() const { return this->Composite.Restriction * this->Coefficients; }

private:
  Status Project(int first, int end)
  {
    this->Works.clear();
    for (int k = first; k < end; ++k)
    {
      PatchWork<Dim> work;
      work.Patch = k;
      for (const KnotVector& knots : this->Composite.Patches[At(k)]->Knots)
      {
        work.Lines.emplace_back(knots, this->ToBernstein);
      }
      this->Works.push_back(std::move(work));
    }
    if (Status status = this->EvaluateRows(); !status)
    {
      return status;
    }
    for (std::size_t d = 1; d < Dim; ++d)
    {
      this->ReduceLines(d);
    }
    for (const PatchWork<Dim>& work : this->Works)
    {
      std::copy(work.Values.begin(), work.Values.end(),
        this->Coefficients.data() +
          At(this->Composite.First[At(work.Patch)]) * At(this->Components));
    }
    return {};
  }

  /// Evaluates the function and reduces the first direction.
  Status EvaluateRows()
  {
    std::vector<Piece> pieces;
    for (std::size_t w = 0; w < this->Works.size(); ++w)
    {
      PatchWork<Dim>& work = this->Works[w];
      std::size_t rows = 1;
      std::size_t values = At(this->Components * work.Lines[0].Functions);
      for (std::size_t d = 1; d < Dim; ++d)
      {
        rows *= At(work.Lines[d].Elements);
        values *= At(work.Lines[d].Elements * this->Points);
      }
      work.Values.assign(values, 0.0);
      for (std::size_t row = 0; row < rows; ++row)
      {
        pieces.push_back({ w, row, 0 });
      }
    }
    std::vector<Status> statuses(pieces.size());
    std::vector<int> failed(pieces.size(), -1);
    ParallelFor(pieces.size(), 1, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        PointMatrix values;
        for (std::size_t k = begin; k < end; ++k)
        {
          statuses[k] = this->EvaluateRow(pieces[k], values, failed[k]);
        }
      });
    std::size_t lowest = pieces.size();
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      if (failed[k] >= 0 && (lowest == pieces.size() || failed[k] < failed[lowest]))
      {
        lowest = k;
      }
    }
    return lowest < pieces.size() ? statuses[lowest] : Status{};
  }

  Status EvaluateRow(const Piece& piece, PointMatrix& values, int& failed)
  {
    switch (this->Components)
    {
      case 1:
        return this->EvaluateRowOf<1>(piece, values, failed);
      case 2:
        return this->EvaluateRowOf<2>(piece, values, failed);
      case 3:
        return this->EvaluateRowOf<3>(piece, values, failed);
      default:
        return this->EvaluateRowOf<0>(piece, values, failed);
    }
  }

  template <int Fixed>
  Status EvaluateRowOf(const Piece& piece, PointMatrix& values, int& failed)
  {
    PatchWork<Dim>& work = this->Works[piece.Work];
    const MeshPatches<Dim>& layout = this->Composite.Layout;
    const LineProjection& line = work.Lines[0];
    const std::size_t width = At(line.Functions * this->Components);
    const std::size_t across = At(work.Lines[1].Elements);
    const std::size_t q = At(this->Points);
    // lines of the row's Gauss points: of the second direction, and of the third
    const std::size_t first = piece.Outer % across * q + piece.Outer / across * q * q * across;
    const std::size_t layers = Dim == 3 ? q : 1;
    const Eigen::Index numPoints = static_cast<Eigen::Index>(layers * q * q);
    for (int e = 0; e < line.Elements; ++e)
    {
      const int cell =
        layout.Patches[At(work.Patch)].Cells[piece.Outer * At(line.Elements) + At(e)];
      const PointMatrix& local = this->Places.find(layout.AheadOf[At(cell)])->second;
      values.resize(numPoints, this->Components);
      failed = cell;
      if (!this->Function(cell, local, local, values))
      {
        return { ErrorCode::OutsideDomain,
          "the function is not defined on element " + std::to_string(cell) };
      }
      if (values.rows() != numPoints || values.cols() != this->Components)
      {
        return { ErrorCode::SizeMismatch,
          "the function changed the size of its values on element " + std::to_string(cell) };
      }
      if (!((values.array() * 0.0).sum() == 0.0))
      {
        return { ErrorCode::NonFiniteInput,
          "the function is not finite on element " + std::to_string(cell) };
      }
      const double* from = values.data();
      for (std::size_t layer = 0; layer < layers; ++layer)
      {
        for (std::size_t g = 0; g < q; ++g, from += q * At(this->Components))
        {
          AddProducts<Fixed>(line.Blocks[At(e)], from, this->Components,
            work.Values.data() + (first + g + layer * across * q) * width +
              At(line.First[At(e)] * this->Components));
        }
      }
    }
    failed = -1;
    return {};
  }

  /// Reduces a direction above the first: lines that are next to each other in memory at a time.
  void ReduceLines(std::size_t direction)
  {
    std::vector<Piece> pieces;
    for (std::size_t w = 0; w < this->Works.size(); ++w)
    {
      PatchWork<Dim>& work = this->Works[w];
      const LineProjection& line = work.Lines[direction];
      const std::size_t inner = this->Inner(work, direction);
      const std::size_t outer = work.Values.size() / (inner * At(line.Elements * this->Points));
      work.Reduced.assign(outer * inner * At(line.Functions), 0.0);
      for (std::size_t o = 0; o < outer; ++o)
      {
        for (std::size_t i = 0; i < inner; i += LineSize)
        {
          pieces.push_back({ w, o, i });
        }
      }
    }
    ParallelFor(pieces.size(), 8, this->Params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t k = begin; k < end; ++k)
        {
          this->ReducePiece(direction, pieces[k]);
        }
      });
    for (PatchWork<Dim>& work : this->Works)
    {
      work.Values.swap(work.Reduced);
    }
  }

  void ReducePiece(std::size_t direction, const Piece& piece)
  {
    PatchWork<Dim>& work = this->Works[piece.Work];
    const LineProjection& line = work.Lines[direction];
    const std::size_t inner = this->Inner(work, direction);
    const std::size_t n = std::min(LineSize, inner - piece.Inner);
    const double* from =
      work.Values.data() + piece.Outer * inner * At(line.Elements * line.Points) + piece.Inner;
    double* to = work.Reduced.data() + piece.Outer * inner * At(line.Functions) + piece.Inner;
    const auto columns = static_cast<Eigen::Index>(n);
    const Eigen::OuterStride<> stride(static_cast<Eigen::Index>(inner));
    for (int e = 0; e < line.Elements; ++e, from += inner * At(line.Points))
    {
      const Eigen::Map<const PointMatrix, 0, Eigen::OuterStride<>> values(
        from, line.Points, columns, stride);
      Eigen::Map<PointMatrix, 0, Eigen::OuterStride<>>(to + At(line.First[At(e)]) * inner,
        line.Alive, columns, stride) += line.Blocks[At(e)].lazyProduct(values);
    }
  }

  std::size_t Inner(const PatchWork<Dim>& work, std::size_t direction) const
  {
    std::size_t inner = At(this->Components);
    for (std::size_t d = 0; d < direction; ++d)
    {
      inner *= At(work.Lines[d].Functions);
    }
    return inner;
  }

  const CompositeProjection<Dim>& Composite;
  int Components;
  const ElementFunction& Function;
  const ProjectionParams& Params;
  int Degree;
  int Points;
  PointMatrix ToBernstein;
  PointMatrix Coefficients;                    ///< of all patches
  std::map<IntArray<Dim>, PointMatrix> Places; ///< Gauss points in a cell's own parameters
  std::vector<PatchWork<Dim>> Works;
};
}

template <int Dim>
Result<Spline<Dim>> ProjectByPatches(const CompositeProjection<Dim>& composite, int numComponents,
  const ElementFunction& function, const ProjectionParams& params)
{
  if (!composite.Space || composite.Patches.empty())
  {
    return { ErrorCode::EmptyInput, "no space to project onto" };
  }
  if (numComponents < 1 || !function)
  {
    return { ErrorCode::InvalidParameter, "a projection needs a function of at least 1 component" };
  }
  if (params.ExtraPoints < 0 || params.ExtraPoints > 16)
  {
    return { ErrorCode::InvalidParameter,
      "ExtraPoints is " + std::to_string(params.ExtraPoints) + ", valid are 0 to 16" };
  }
  PatchProjection<Dim> projection(composite, numComponents, function, params);
  if (Status status = projection.Run(); !status)
  {
    return status;
  }
  return Spline<Dim>{ composite.Space, projection.Result(), {} };
}

template Result<Spline<2>> ProjectByPatches(
  const CompositeProjection<2>&, int, const ElementFunction&, const ProjectionParams&);
template Result<Spline<3>> ProjectByPatches(
  const CompositeProjection<3>&, int, const ElementFunction&, const ProjectionParams&);
}
