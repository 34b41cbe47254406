// SPDX-License-Identifier: BSD-3-Clause
#include "StiffnessMatrix.h"

#include "ElementGeometry.h"
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace knotwork
{
namespace
{
/// Parts that the columns are dealt to, so that threads add to different ones.
constexpr unsigned NumLanes = 8;

/// The lower triangle of A^T A, or adds it to that of the matrix; what is above the diagonal is not
/// defined. Squares of 4 x 4 entries are summed in registers.
/// @param rows  of A. @param size  of a row and of the matrix, a multiple of 4.
void FillGram(const double* rows, int count, int size, bool add, double* matrix)
{
  for (int i = 0; i < size; i += 4)
  {
    for (int j = 0; j <= i; j += 4)
    {
      Two sums[4][2] = {};
      const double* row = rows;
      for (int q = 0; q < count; ++q, row += size)
      {
        Two right[2];
        Load(right[0], row + j);
        Load(right[1], row + j + 2);
        for (int k = 0; k < 4; ++k)
        {
          sums[k][0] += row[i + k] * right[0];
          sums[k][1] += row[i + k] * right[1];
        }
      }
      for (int k = 0; k < 4; ++k)
      {
        double* to = matrix + std::ptrdiff_t{ i + k } * size + j;
        for (int half = 0; half < 2; ++half)
        {
          Two sum{};
          if (add)
          {
            Load(sum, to + 2 * half);
          }
          sum += sums[k][half];
          std::memcpy(to + 2 * half, &sum, sizeof(Two));
        }
      }
    }
  }
}

/// What the matrix of an element is made with. One a thread.
class ElementAssembler
{
public:
  ElementAssembler(
    const GalerkinSpace& space, const GalerkinProblem& problem, const RuleTables& tables)
    : Space(space), Problem(problem), Tables(tables)
  {
  }

  /// @param pairs  components x components entries a pair of functions, the one of the trial
  /// function's component j and the test function's component i at j * components + i.
  /// @return whether all are finite.
  bool Fill(int element, double* pairs)
  {
    const int dimension = this->Space.Dimension;
    this->Current = this->Tables.Functions(this->Space, element, this->Memory);
    SortFunctions(this->Space, element, this->Order);
    const GalerkinMaterial& material = MaterialOf(this->Problem, element);
    if (NumSolutionComponents(this->Problem.Equation) == 1)
    {
      // grad N_a . grad N_b: components of gradients are points more
      this->Size = this->Current.Stride;
      dimension == 2 ? this->Integrate<2>(element) : this->Integrate<3>(element);
      this->PackPoisson(material.Conductivity, pairs);
    }
    else
    {
      this->Size = dimension * this->Current.Stride;
      const LameConstants lame = MakeLameConstants(this->Problem.Equation, material);
      dimension == 2 ? this->Integrate<2>(element) : this->Integrate<3>(element);
      dimension == 2 ? this->PackElastic<2>(lame, pairs) : this->PackElastic<3>(lame, pairs);
    }
    // all entries are bounded by those of the diagonal (Cauchy, Schwarz)
    bool finite = true;
    for (int i = 0; i < this->Size; ++i)
    {
      finite = finite && std::isfinite(this->Gram[Entry(i, i)]);
    }
    return finite;
  }

private:
  std::size_t Entry(int row, int column) const
  {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(this->Size) +
      static_cast<std::size_t>(column);
  }

  /// Gram matrix of the gradients, times the roots of the points' volumes, as rows of Size entries:
  /// where these are all components of a point, it has the integrals of d_i N_a d_j N_b at
  /// (i * stride + a, j * stride + b).
  template <int Dim>
  void Integrate(int element)
  {
    constexpr int Block = 32; // points at a time, as many as the nearest cache holds
    const int stride = this->Current.Stride;
    ElementGeometry<Dim>& geometry = std::get<ElementGeometry<Dim>>(this->Geometry);
    geometry.Take(this->Space, element, stride);
    this->Gradients.resize(Block * Dim * static_cast<std::size_t>(stride));
    this->Gram.resize(static_cast<std::size_t>(this->Size) * static_cast<std::size_t>(this->Size));
    for (int first = 0; first < this->Current.NumPoints; first += Block)
    {
      const int count = std::min(Block, this->Current.NumPoints - first);
      double* to = this->Gradients.data();
      for (int q = first; q < first + count; ++q)
      {
        const double* slopes = this->Current.Rows + (std::ptrdiff_t{ q } * (Dim + 1) + 1) * stride;
        const Eigen::Matrix<double, Dim, Dim> jacobian = geometry.Jacobian(slopes);
        const double volume = this->Current.Weights[q] * std::abs(jacobian.determinant());
        const Eigen::Matrix<double, Dim, Dim> inverse = std::sqrt(volume) * jacobian.inverse();
        for (int c = 0; c < Dim; ++c, to += stride)
        {
          for (int a = 0; a < stride; ++a)
          {
            to[a] = inverse(0, c) * slopes[a];
            for (int k = 1; k < Dim; ++k)
            {
              to[a] += inverse(k, c) * slopes[k * stride + a];
            }
          }
        }
      }
      FillGram(this->Gradients.data(), count * Dim * stride / this->Size, this->Size, first > 0,
        this->Gram.data());
    }
  }

  void PackPoisson(double conductivity, double* pairs) const
  {
    for (int a = 0; a < this->Current.NumFunctions; ++a)
    {
      const int row = this->Order[static_cast<std::size_t>(a)];
      for (int b = 0; b <= a; ++b)
      {
        const int column = this->Order[static_cast<std::size_t>(b)];
        *pairs++ = conductivity * this->Gram[Entry(std::max(row, column), std::min(row, column))];
      }
    }
  }

  /// lambda d_i N_a d_j N_b + mu (d_j N_a d_i N_b + delta_ij grad N_a . grad N_b)
  template <int Dim>
  void PackElastic(const LameConstants& lame, double* pairs) const
  {
    const int stride = this->Current.Stride;
    for (int a = 0; a < this->Current.NumFunctions; ++a)
    {
      const int row = this->Order[static_cast<std::size_t>(a)];
      for (int b = 0; b <= a; ++b, pairs += Dim * Dim)
      {
        const int column = this->Order[static_cast<std::size_t>(b)];
        const int high = std::max(row, column);
        const int low = std::min(row, column);
        double products[Dim][Dim]; // integral of d_i N_row d_j N_column
        double laplace = 0.0;
        for (int i = 0; i < Dim; ++i)
        {
          products[i][i] = this->Gram[Entry(i * stride + high, i * stride + low)];
          laplace += products[i][i];
          for (int j = 0; j < i; ++j)
          {
            products[i][j] = this->Gram[Entry(i * stride + row, j * stride + column)];
            products[j][i] = this->Gram[Entry(i * stride + column, j * stride + row)];
          }
        }
        for (int j = 0; j < Dim; ++j)
        {
          for (int i = 0; i < Dim; ++i)
          {
            pairs[j * Dim + i] = lame.First * products[i][j] + lame.Shear * products[j][i] +
              (i == j ? lame.Shear * laplace : 0.0);
          }
        }
      }
    }
  }

  const GalerkinSpace& Space;
  const GalerkinProblem& Problem;
  const RuleTables& Tables;
  QuadratureFunctions Current;
  int Size = 0; ///< of the Gram matrix
  std::vector<int> Order;
  std::tuple<ElementGeometry<2>, ElementGeometry<3>> Geometry;
  std::vector<double> Memory, Gradients, Gram;
};

/// The elements that each function is alive on, ascending.
struct FunctionSupports
{
  std::vector<std::size_t> First; ///< NumFunctions + 1 offsets
  std::vector<int> Elements;
};
FunctionSupports MakeSupports(const GalerkinSpace& space)
{
  FunctionSupports supports;
  supports.First.assign(static_cast<std::size_t>(space.NumFunctions()) + 1, 0);
  for (const int f : space.Functions)
  {
    ++supports.First[static_cast<std::size_t>(f) + 1];
  }
  std::partial_sum(supports.First.begin(), supports.First.end(), supports.First.begin());
  std::vector<std::size_t> next = supports.First;
  supports.Elements.resize(space.Functions.size());
  for (int e = 0; e < space.NumElements(); ++e)
  {
    for (int a = 0; a < space.NumAlive(e); ++a)
    {
      supports.Elements[next[static_cast<std::size_t>(space.Alive(e)[a])]++] = e;
    }
  }
  return supports;
}

}

Status MakePattern(
  const GalerkinSpace& space, int components, int threads, Eigen::SparseMatrix<double>& matrix)
{
  const auto n = static_cast<std::size_t>(space.NumFunctions());
  const std::size_t chunk = std::max<std::size_t>(1024, n / 64 + 1);
  // functions that meet a function and are not before it, ascending: those of a chunk on end
  std::vector<std::vector<int>> lists((n + chunk - 1) / chunk);
  std::vector<int> sizes(n);
  {
    const FunctionSupports supports = MakeSupports(space);
    ParallelFor(n, chunk, threads,
      [&](std::size_t begin, std::size_t end)
      {
        std::vector<int>& list = lists[begin / chunk];
        std::vector<int> seenBy(n, -1);
        for (std::size_t f = begin; f < end; ++f)
        {
          const int own = static_cast<int>(f);
          const auto start = static_cast<std::ptrdiff_t>(list.size());
          for (std::size_t k = supports.First[f]; k < supports.First[f + 1]; ++k)
          {
            const int e = supports.Elements[k];
            for (int a = 0; a < space.NumAlive(e); ++a)
            {
              const int other = space.Alive(e)[a];
              int& seen = seenBy[static_cast<std::size_t>(other)];
              if (other >= own && seen != own)
              {
                seen = own;
                list.push_back(other);
              }
            }
          }
          std::sort(list.begin() + start, list.end());
          sizes[f] = static_cast<int>(static_cast<std::ptrdiff_t>(list.size()) - start);
        }
      });
  }
  const Eigen::Index c = components;
  Eigen::Index entries = 0;
  for (const int size : sizes)
  {
    entries += size * c * c - (size > 0 ? c * (c - 1) / 2 : 0); // no upper triangle in the block
  }
  if (entries > std::numeric_limits<int>::max())
  {
    return { ErrorCode::TooLarge,
      "the matrix has " + std::to_string(entries) +
        " entries, more than 2147483647; take fewer elements, or such of a lower degree" };
  }
  matrix.resize(space.NumFunctions() * c, space.NumFunctions() * c);
  matrix.resizeNonZeros(entries);
  int* outer = matrix.outerIndexPtr();
  int next = 0;
  for (const int size : sizes)
  {
    for (int j = 0; j < components; ++j)
    {
      *outer++ = next;
      next += size > 0 ? size * components - j : 0;
    }
  }
  *outer = next;
  ParallelFor(n, chunk, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<int>& list = lists[begin / chunk];
      const int* rows = list.data();
      for (std::size_t f = begin; f < end; ++f)
      {
        for (int j = 0; j < components; ++j)
        {
          const int column = static_cast<int>(f) * components + j;
          int* inner = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
          for (int k = 0; k < sizes[f]; ++k)
          {
            for (int i = k == 0 ? j : 0; i < components; ++i)
            {
              *inner++ = rows[k] * components + i;
            }
          }
        }
        rows += sizes[f];
      }
      std::fill(matrix.valuePtr() + matrix.outerIndexPtr()[begin * static_cast<std::size_t>(c)],
        matrix.valuePtr() + matrix.outerIndexPtr()[end * static_cast<std::size_t>(c)], 0.0);
      list = {};
    });
  return {};
}

namespace
{
/// Adds entries of an element's pairs to the columns of its function at place b in ascending order.
template <int Components>
void AddColumns(const int* alive, const std::vector<int>& order, int b, const double* pairs,
  Eigen::SparseMatrix<double>& matrix)
{
  const int first = alive[order[static_cast<std::size_t>(b)]] * Components;
  const int* outer = matrix.outerIndexPtr() + first;
  const int* rows = matrix.innerIndexPtr() + outer[0];
  int k = 0; // of the functions that the columns have
  for (int a = b; a < static_cast<int>(order.size()); ++a)
  {
    const int row = alive[order[static_cast<std::size_t>(a)]] * Components;
    while (rows[k * Components] < row)
    {
      ++k;
    }
    const double* block = pairs +
      PairOf(a, b) * static_cast<std::size_t>(Components) * static_cast<std::size_t>(Components);
    double* values = matrix.valuePtr() + k * Components;
    for (int j = 0; j < Components; ++j, block += Components)
    {
      // a column begins with its diagonal
      double* column = values + outer[j] - j;
      for (int i = k == 0 ? j : 0; i < Components; ++i)
      {
        column[i] += block[i];
      }
    }
  }
}

/// The same of a batch of elements, those functions that are dealt to a lane.
template <int Components>
void AddLane(const GalerkinSpace& space, int first, std::size_t count, unsigned lane,
  const std::vector<double>& pairs, std::size_t width, Eigen::SparseMatrix<double>& matrix)
{
  std::vector<int> order;
  for (std::size_t i = 0; i < count; ++i)
  {
    const int element = first + static_cast<int>(i);
    const int* alive = space.Alive(element);
    SortFunctions(space, element, order);
    for (int b = 0; b < space.NumAlive(element); ++b)
    {
      const auto function = static_cast<unsigned>(alive[order[static_cast<std::size_t>(b)]]);
      if (function / 8 % NumLanes == lane)
      {
        AddColumns<Components>(alive, order, b, pairs.data() + i * width, matrix);
      }
    }
  }
}
}

void SortFunctions(const GalerkinSpace& space, int element, std::vector<int>& order)
{
  const int* alive = space.Alive(element);
  const int count = space.NumAlive(element);
  order.resize(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  if (!std::is_sorted(alive, alive + count))
  {
    std::sort(order.begin(), order.end(), [alive](int a, int b) { return alive[a] < alive[b]; });
  }
}

void AddElements(const GalerkinSpace& space, int first, std::size_t count,
  const std::vector<double>& pairs, std::size_t width, int components, int threads,
  Eigen::SparseMatrix<double>& matrix)
{
  // every entry is of one lane, which adds in the order of the elements
  const auto add = components == 1 ? AddLane<1> : components == 2 ? AddLane<2> : AddLane<3>;
  ParallelFor(NumLanes, 1, threads,
    [&](std::size_t lane, std::size_t)
    { add(space, first, count, static_cast<unsigned>(lane), pairs, width, matrix); });
}

int MostFunctions(const GalerkinSpace& space)
{
  int most = 0;
  for (int e = 0; e < space.NumElements(); ++e)
  {
    most = std::max(most, space.NumAlive(e));
  }
  return most;
}

int NumSolutionComponents(GalerkinEquation equation)
{
  switch (equation)
  {
    case GalerkinEquation::Poisson:
      return 1;
    case GalerkinEquation::PlaneStress:
    case GalerkinEquation::PlaneStrain:
      return 2;
    case GalerkinEquation::Solid:
      break;
  }
  return 3;
}

LameConstants MakeLameConstants(GalerkinEquation equation, const GalerkinMaterial& material)
{
  const double nu = material.PoissonsRatio;
  const double shear = material.YoungsModulus / (2.0 * (1.0 + nu));
  const double first = equation == GalerkinEquation::PlaneStress
    ? 2.0 * shear * nu / (1.0 - nu)
    : 2.0 * shear * nu / (1.0 - 2.0 * nu);
  return { first, shear };
}

const GalerkinMaterial& MaterialOf(const GalerkinProblem& problem, int element)
{
  return problem.Materials[problem.MaterialIds.empty()
      ? 0
      : static_cast<std::size_t>(problem.MaterialIds[static_cast<std::size_t>(element)])];
}

Result<Eigen::SparseMatrix<double>> AssembleStiffness(const GalerkinSpace& space,
  const GalerkinProblem& problem, const GalerkinParams& params, const ProgressCallback& progress)
{
  constexpr std::size_t BatchBytes = std::size_t{ 2 } << 20; // of elements' entries at a time
  const int components = NumSolutionComponents(problem.Equation);
  Result<Eigen::SparseMatrix<double>> matrix;
  if (const Status status = MakePattern(space, components, params.Threads, matrix.Value); !status)
  {
    return status;
  }
  RuleTables tables(params.QuadratureTolerance);
  tables.Prepare(space);
  const int count = space.NumElements();
  const std::size_t width =
    PairOf(MostFunctions(space), 0) * static_cast<std::size_t>(components * components);
  const auto batch =
    static_cast<int>(std::clamp<std::size_t>(BatchBytes / (width * sizeof(double)), 8, 1024));
  std::vector<double> pairs(static_cast<std::size_t>(batch) * width);
  std::vector<char> finite(static_cast<std::size_t>(batch));
  for (int first = 0; first < count; first += batch)
  {
    const auto size = static_cast<std::size_t>(std::min(batch, count - first));
    ParallelFor(size, static_cast<std::size_t>(batch) / 8, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        ElementAssembler assembler(space, problem, tables);
        for (std::size_t i = begin; i < end; ++i)
        {
          finite[i] = assembler.Fill(first + static_cast<int>(i), pairs.data() + i * width) ? 1 : 0;
        }
      });
    const auto bad =
      std::find(finite.begin(), finite.begin() + static_cast<std::ptrdiff_t>(size), 0);
    if (bad != finite.begin() + static_cast<std::ptrdiff_t>(size))
    {
      return { ErrorCode::InvalidTopology,
        "the map of element " + std::to_string(first + (bad - finite.begin())) +
          " is singular; mend the geometry" };
    }
    AddElements(space, first, size, pairs, width, components, params.Threads, matrix.Value);
    if (progress && !progress(0.1 + 0.4 * (first + static_cast<double>(size)) / count))
    {
      return { ErrorCode::Aborted, "while the matrix was assembled" };
    }
  }
  return matrix;
}
}
