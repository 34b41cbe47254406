// SPDX-License-Identifier: BSD-3-Clause
#include "StiffnessMatrix.h"

#include "ElementGeometry.h"
#include <knotwork/SplineCore/LargePages.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/WideVectors.h>

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

/// What the matrix of an element is made with. One a thread.
/// @tparam Width  doubles a register.
template <int Width>
class ElementAssembler
{
public:
  ElementAssembler(
    const GalerkinSpace& space, const GalerkinProblem& problem, const RuleTables& tables)
    : Space(space), Problem(problem), Tables(tables)
  {
  }

  /// @param matrix  as AddElements takes it. @return whether all are finite.
  bool Fill(int element, double* matrix)
  {
    this->Current = this->Tables.Functions(this->Space, element, this->Memory);
    this->IsSorted = SortFunctions(this->Space, element, this->Order);
    for (int a = this->Current.NumFunctions; a < this->Current.Stride; ++a)
    {
      this->Order.push_back(a);
    }
    return this->Space.Dimension == 2 ? this->Fill<2>(element, matrix)
                                      : this->Fill<3>(element, matrix);
  }

private:
  using Vector = Doubles<Width>;
  static constexpr int NumVectors = FunctionBlock / Width;

  template <int Dim>
  bool Fill(int element, double* matrix)
  {
    this->FillGradients<Dim>(element);
    const GalerkinMaterial& material = MaterialOf(this->Problem, element);
    const int stride = this->Current.Stride;
    const bool isElastic = this->Problem.Equation != GalerkinEquation::Poisson;
    const LameConstants lame = MakeLameConstants(this->Problem.Equation, material);
    for (int a = 0; a < stride; a += FunctionBlock)
    {
      for (int b = 0; b <= a; b += FunctionBlock)
      {
        if (isElastic)
        {
          this->FillElastic<Dim>(a, b, lame, matrix + Dim * Dim * FirstEntry(b, stride));
        }
        else
        {
          this->FillPoisson<Dim>(a, b, material.Conductivity, matrix + FirstEntry(b, stride));
        }
      }
    }
    // all entries are bounded by those of the diagonal (Cauchy, Schwarz)
    const int components = isElastic ? Dim : 1;
    bool finite = true;
    for (int b = 0; b < this->Current.NumFunctions; ++b)
    {
      const double* rows = matrix + components * components * FirstEntry(b, stride);
      for (int i = 0; i < components; ++i)
      {
        finite = finite &&
          std::isfinite(rows[(components + 1) * i * RowLength(b, stride) + b % FunctionBlock]);
      }
    }
    return finite;
  }

  /// Derivatives of functions in ascending order, times the roots of the points' volumes: a block
  /// of functions after the other, of each block Dim rows a point.
  template <int Dim>
  void FillGradients(int element)
  {
    const int stride = this->Current.Stride;
    ElementGeometry<Dim>& geometry = std::get<ElementGeometry<Dim>>(this->Geometry);
    geometry.Take(this->Space, element, stride);
    this->BlockSize = std::ptrdiff_t{ this->Current.NumPoints } * Dim * FunctionBlock;
    this->Gradients.resize(static_cast<std::size_t>(stride / FunctionBlock * this->BlockSize));
    // in registers: what is written may be anywhere for all that the compiler knows
    const int* order = this->Order.data();
    double* gradients = this->Gradients.data();
    const std::ptrdiff_t blockSize = this->BlockSize;
    const int numPoints = this->Current.NumPoints;
    const bool isSorted = this->IsSorted;
    for (int q = 0; q < numPoints; ++q)
    {
      const double* slopes = this->Current.Rows + (std::ptrdiff_t{ q } * (Dim + 1) + 1) * stride;
      const Eigen::Matrix<double, Dim, Dim> jacobian = geometry.Jacobian(slopes);
      const double volume = this->Current.Weights[q] * std::abs(jacobian.determinant());
      const Eigen::Matrix<double, Dim, Dim> inverse = std::sqrt(volume) * jacobian.inverse();
      for (int a = 0; a < stride; a += Width)
      {
        Vector slope[Dim] = {};
        for (int k = 0; k < Dim; ++k)
        {
          const double* row = slopes + std::ptrdiff_t{ k } * stride;
          if (isSorted)
          {
            std::memcpy(&slope[k], row + a, sizeof(Vector));
          }
          else
          {
            if constexpr (Width == 4)
            {
              slope[k] =
                Vector{ row[order[a]], row[order[a + 1]], row[order[a + 2]], row[order[a + 3]] };
            }
            else
            {
              slope[k] = Vector{ row[order[a]], row[order[a + 1]] };
            }
          }
        }
        double* to =
          gradients + a / FunctionBlock * blockSize + q * Dim * FunctionBlock + a % FunctionBlock;
        for (int c = 0; c < Dim; ++c, to += FunctionBlock)
        {
          Vector sum = inverse(0, c) * slope[0];
          for (int k = 1; k < Dim; ++k)
          {
            sum += inverse(k, c) * slope[k];
          }
          std::memcpy(to, &sum, sizeof(Vector));
        }
      }
    }
  }

  /// lambda d_i N_a d_j N_b + mu (d_j N_a d_i N_b + delta_ij grad N_a . grad N_b) of a block of
  /// functions from a on with one from b on. The sums of all pairs of directions stay in registers.
  template <int Dim>
  void FillElastic(int a, int b, const LameConstants& lame, double* matrix) const
  {
    const std::ptrdiff_t length = RowLength(b, this->Current.Stride);
    const double* left = this->Gradients.data() + a / FunctionBlock * this->BlockSize;
    const double* right = this->Gradients.data() + b / FunctionBlock * this->BlockSize;
    for (int k = 0; k < FunctionBlock; ++k)
    {
      for (int v = 0; v < NumVectors; ++v)
      {
        Vector sums[Dim][Dim] = {}; // integrals of d_i N_a d_j N_b
        const double* l = left + v * Width;
        const double* r = right + k;
        for (int q = 0; q < this->Current.NumPoints; ++q)
        {
          Vector slopes[Dim];
          for (int i = 0; i < Dim; ++i)
          {
            std::memcpy(&slopes[i], l + i * FunctionBlock, sizeof(Vector));
          }
          for (int j = 0; j < Dim; ++j)
          {
            const double slope = r[j * FunctionBlock];
            for (int i = 0; i < Dim; ++i)
            {
              sums[i][j] += slope * slopes[i];
            }
          }
          l += Dim * FunctionBlock;
          r += Dim * FunctionBlock;
        }
        Vector laplace = sums[0][0];
        for (int i = 1; i < Dim; ++i)
        {
          laplace += sums[i][i];
        }
        double* to = matrix + Dim * Dim * k * length + a - b + v * Width;
        for (int j = 0; j < Dim; ++j)
        {
          for (int i = 0; i < Dim; ++i, to += length)
          {
            Vector entry = lame.First * sums[i][j] + lame.Shear * sums[j][i];
            if (i == j)
            {
              entry += lame.Shear * laplace;
            }
            std::memcpy(to, &entry, sizeof(Vector));
          }
        }
      }
    }
  }

  /// The same of conductivity grad N_a . grad N_b.
  template <int Dim>
  void FillPoisson(int a, int b, double conductivity, double* matrix) const
  {
    const std::ptrdiff_t length = RowLength(b, this->Current.Stride);
    const double* left = this->Gradients.data() + a / FunctionBlock * this->BlockSize;
    const double* right = this->Gradients.data() + b / FunctionBlock * this->BlockSize;
    Vector sums[FunctionBlock][NumVectors] = {};
    for (int q = 0; q < Dim * this->Current.NumPoints; ++q)
    {
      for (int v = 0; v < NumVectors; ++v)
      {
        Vector slope;
        std::memcpy(&slope, left + v * Width, sizeof(Vector));
        for (int k = 0; k < FunctionBlock; ++k)
        {
          sums[k][v] += right[k] * slope;
        }
      }
      left += FunctionBlock;
      right += FunctionBlock;
    }
    for (int k = 0; k < FunctionBlock; ++k)
    {
      for (int v = 0; v < NumVectors; ++v)
      {
        const Vector entry = conductivity * sums[k][v];
        std::memcpy(matrix + k * length + a - b + v * Width, &entry, sizeof(Vector));
      }
    }
  }

  const GalerkinSpace& Space;
  const GalerkinProblem& Problem;
  const RuleTables& Tables;
  QuadratureFunctions Current;
  std::vector<int> Order;
  bool IsSorted = false;
  std::ptrdiff_t BlockSize = 0; ///< numbers that a block of functions has in Gradients
  std::tuple<ElementGeometry<2>, ElementGeometry<3>> Geometry;
  std::vector<double> Memory, Gradients;
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

Status MakePattern(const GalerkinSpace& space, int components, const GalerkinParams& params,
  Eigen::SparseMatrix<double>& matrix)
{
  const auto n = static_cast<std::size_t>(space.NumFunctions());
  const std::size_t chunk = std::max<std::size_t>(1024, n / 64 + 1);
  // functions that meet a function and are not before it, ascending: those of a chunk on end
  std::vector<std::vector<int>> lists((n + chunk - 1) / chunk);
  std::vector<int> sizes(n);
  {
    const FunctionSupports supports = MakeSupports(space);
    ParallelFor(n, chunk, params.Threads,
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
  if (entries > params.MaxEntries)
  {
    return { ErrorCode::TooLarge,
      "the matrix has " + std::to_string(entries) + " entries, more than " +
        std::to_string(params.MaxEntries) + "; take fewer elements, or such of a lower degree" };
  }
  matrix.resize(space.NumFunctions() * c, space.NumFunctions() * c);
  matrix.resizeNonZeros(entries);
  const auto count = static_cast<std::size_t>(entries);
  PreferLargePages(matrix.valuePtr(), count * sizeof(double));
  PreferLargePages(matrix.innerIndexPtr(), count * sizeof(int));
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
  ParallelFor(n, chunk, params.Threads,
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
/// Adds entries of an element's matrix to the columns of its function at place b in ascending
/// order.
/// @param functions  of the element, ascending. @param entries  those of b.
template <int Components>
void AddColumns(const int* functions, int count, int b, const double* entries,
  std::ptrdiff_t length, Eigen::SparseMatrix<double>& matrix)
{
  const int first = functions[b] * Components;
  const int* outer = matrix.outerIndexPtr() + first;
  const int* rows = matrix.innerIndexPtr() + outer[0];
  double* values = matrix.valuePtr();
  entries -= b / FunctionBlock * FunctionBlock; // begin with the block of b
  // the block on the diagonal: a column begins with its diagonal
  for (int j = 0; j < Components; ++j)
  {
    for (int i = j; i < Components; ++i)
    {
      values[outer[j] - j + i] += entries[(j * Components + i) * length + b];
    }
  }
  int k = 0; // of the functions that the columns have
  for (int a = b + 1; a < count; ++a)
  {
    const int row = functions[a] * Components;
    while (rows[k * Components] < row)
    {
      ++k;
    }
    for (int j = 0; j < Components; ++j)
    {
      double* column = values + outer[j] - j + k * Components;
      for (int i = 0; i < Components; ++i)
      {
        column[i] += entries[(j * Components + i) * length + a];
      }
    }
  }
}

/// The same of a batch of elements, those functions that are dealt to a lane.
/// @param functions  of each element, ascending, `most` apart.
template <int Components>
void AddLane(const GalerkinSpace& space, int first, std::size_t count, unsigned lane,
  unsigned numLanes, const std::vector<int>& functions, std::size_t most,
  const std::vector<double>& matrices, std::size_t width, Eigen::SparseMatrix<double>& matrix)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const int alive = space.NumAlive(first + static_cast<int>(i));
    const int padded = PaddedFunctions(alive);
    const int* own = functions.data() + i * most;
    const double* entries = matrices.data() + i * width;
    for (int b = 0; b < alive; ++b)
    {
      if (static_cast<unsigned>(own[b]) / 8 % numLanes == lane)
      {
        AddColumns<Components>(own, alive, b,
          entries + Components * Components * FirstEntry(b, padded), RowLength(b, padded), matrix);
      }
    }
  }
}
}

bool SortFunctions(const GalerkinSpace& space, int element, std::vector<int>& order)
{
  const int* alive = space.Alive(element);
  const int count = space.NumAlive(element);
  order.resize(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  const bool sorted = std::is_sorted(alive, alive + count);
  if (!sorted)
  {
    std::sort(order.begin(), order.end(), [alive](int a, int b) { return alive[a] < alive[b]; });
  }
  return sorted;
}

void AddElements(const GalerkinSpace& space, int first, std::size_t count,
  const std::vector<double>& matrices, std::size_t width, int components, int threads,
  Eigen::SparseMatrix<double>& matrix)
{
  int mostAlive = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    mostAlive = std::max(mostAlive, space.NumAlive(first + static_cast<int>(i)));
  }
  const auto most = static_cast<std::size_t>(mostAlive);
  std::vector<int> functions(count * most);
  for (std::size_t i = 0; i < count; ++i)
  {
    const int element = first + static_cast<int>(i);
    int* own = functions.data() + i * most;
    std::copy_n(space.Alive(element), space.NumAlive(element), own);
    if (!std::is_sorted(own, own + space.NumAlive(element)))
    {
      std::sort(own, own + space.NumAlive(element));
    }
  }
  // every entry is of one lane, which adds in the order of the elements
  const unsigned numLanes = threads == 1 ? 1 : NumLanes;
  const auto add = components == 1 ? AddLane<1> : components == 2 ? AddLane<2> : AddLane<3>;
  ParallelFor(numLanes, 1, threads,
    [&](std::size_t lane, std::size_t)
    {
      add(space, first, count, static_cast<unsigned>(lane), numLanes, functions, most, matrices,
        width, matrix);
    });
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

std::size_t NumEntries(const GalerkinSpace& space, int components)
{
  const int most = PaddedFunctions(MostFunctions(space));
  return static_cast<std::size_t>(components * components * FirstEntry(most, most));
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
  Result<Eigen::SparseMatrix<double>> matrix; // all returns name it: another one would copy entries
  matrix.Status = MakePattern(space, components, params, matrix.Value);
  if (!matrix)
  {
    return matrix;
  }
  RuleTables tables(params.QuadratureTolerance);
  tables.Prepare(space);
  const int count = space.NumElements();
  const std::size_t width = NumEntries(space, components);
  const auto batch =
    static_cast<int>(std::clamp<std::size_t>(BatchBytes / (width * sizeof(double)), 8, 1024));
  std::vector<double> matrices(static_cast<std::size_t>(batch) * width);
  std::vector<char> finite(static_cast<std::size_t>(batch));
  for (int first = 0; first < count; first += batch)
  {
    const auto size = static_cast<std::size_t>(std::min(batch, count - first));
    ParallelFor(size, static_cast<std::size_t>(batch) / 8, params.Threads,
      [&](std::size_t begin, std::size_t end)
      {
        WithWidestVectors(
          [&](auto vector)
          {
            ElementAssembler<decltype(vector)::value> assembler(space, problem, tables);
            for (std::size_t i = begin; i < end; ++i)
            {
              double* own = matrices.data() + i * width;
              finite[i] = assembler.Fill(first + static_cast<int>(i), own) ? 1 : 0;
            }
          });
      });
    const auto bad =
      std::find(finite.begin(), finite.begin() + static_cast<std::ptrdiff_t>(size), 0);
    if (bad != finite.begin() + static_cast<std::ptrdiff_t>(size))
    {
      matrix.Status = { ErrorCode::InvalidTopology,
        "the map of element " + std::to_string(first + (bad - finite.begin())) +
          " is singular; mend the geometry" };
      return matrix;
    }
    AddElements(space, first, size, matrices, width, components, params.Threads, matrix.Value);
    if (progress && !progress(0.1 + 0.4 * (first + static_cast<double>(size)) / count))
    {
      matrix.Status = { ErrorCode::Aborted, "while the matrix was assembled" };
      return matrix;
    }
  }
  return matrix;
}
}
