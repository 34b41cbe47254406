// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinBasis.h"
#include "BezierForm.h"
#include "Numbers.h"
#include "Parallel.h"
#include "QuotientRule.h"
#include "WideVectors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 512;

/// Four points, or four neighbours of a row, in one register where AVX is, in two without.
typedef double Four __attribute__((vector_size(32)));
constexpr int NumLanes = 4;

template <int Width>
struct VectorOf
{
  using Type = double;
};
template <>
struct VectorOf<2>
{
  typedef double Type __attribute__((vector_size(16)));
};
template <>
struct VectorOf<4>
{
  using Type = Four;
};

/// N doubles in registers: vectors of four and two, then a scalar. A bicubic row is one AVX
/// register; without AVX the compiler splits the vectors.
template <int N>
class Row
{
  static constexpr int Width = N >= 4 ? 4 : (N >= 2 ? 2 : 1);
  using Vector = typename VectorOf<Width>::Type;
  Vector Head{};
  Row<N - Width> Tail;

public:
  void Load(const double* p)
  {
    std::memcpy(&this->Head, p, sizeof(Vector));
    this->Tail.Load(p + Width);
  }
  void Store(double* p) const
  {
    std::memcpy(p, &this->Head, sizeof(Vector));
    this->Tail.Store(p + Width);
  }
  /// this += w * row
  void Add(double w, const Row& row)
  {
    this->Head += w * row.Head;
    this->Tail.Add(w, row.Tail);
  }
};
template <>
class Row<0>
{
public:
  void Load(const double*) {}
  void Store(double*) const {}
  void Add(double, const Row&) {}
};

/// columns[i] = (rows[i], rows[stride + i], rows[2 stride + i], rows[3 stride + i]), i < N.
template <int N>
inline void Transpose(const double* rows, int stride, Four* columns)
{
  int i = 0;
  for (; i + NumLanes <= N; i += NumLanes)
  {
    Four r0, r1, r2, r3;
    std::memcpy(&r0, rows + i, sizeof(Four));
    std::memcpy(&r1, rows + stride + i, sizeof(Four));
    std::memcpy(&r2, rows + 2 * stride + i, sizeof(Four));
    std::memcpy(&r3, rows + 3 * stride + i, sizeof(Four));
    const Four a = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);
    const Four b = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
    const Four c = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);
    const Four d = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
    columns[i] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    columns[i + 1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    columns[i + 2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    columns[i + 3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
  }
  for (; i < N; ++i)
  {
    columns[i] = Four{ rows[i], rows[stride + i], rows[2 * stride + i], rows[3 * stride + i] };
  }
}

/// The points start, start + 1, ... of a batch and where their results go.
template <int Dim>
struct PointRange
{
  const BezierForm<Dim>& Form;
  const double* Local;
  const int* Elements;
  double* Values;
  double* First;
  double* Second;
};

/// A plane is contracted with the functions of the directions 1 .. Dim-1 first, which leaves one
/// row a set. Sets in 1D: {1}; in 2D: v, v', v''; in 3D: vw, v'w, vw', v''w, v'w', vw''.
constexpr int NumRowSets(int dim, int order)
{
  return dim == 1 ? 1 : NumDerivativeTerms(dim - 1, order);
}
template <int Dim>
constexpr int SetOrderV(int m)
{
  constexpr int orders[6] = { 0, 1, 0, 2, 1, 0 };
  return Dim == 3 ? orders[m] : m;
}
template <int Dim>
constexpr int SetOrderW(int m)
{
  constexpr int orders[6] = { 0, 0, 1, 0, 1, 2 };
  return Dim == 3 ? orders[m] : 0;
}

/// Terms of one component; dot(m, k) = set m contracted with the k-th derivatives of direction 0.
template <int Dim, int Order, typename Real, typename DotFunction>
inline void GatherTerms(const DotFunction& dot, Real* terms)
{
  dot(0, 0, terms[0]);
  if constexpr (Order >= 1)
  {
    dot(0, 1, terms[1]);
    for (int d = 1; d < Dim; ++d)
    {
      dot(d, 0, terms[1 + d]);
    }
  }
  if constexpr (Order >= 2)
  {
    Real* second = terms + 1 + Dim;
    dot(0, 2, second[0]);
    for (int d = 1; d < Dim; ++d)
    {
      dot(d, 1, second[d]);
    }
    for (int k = Dim; k < NumRowSets(Dim, Order); ++k)
    {
      dot(k, 0, second[k]);
    }
  }
}

/// Contracts the plane q with the directions 1 .. Dim-1; the sets go to sets, N numbers each.
/// @param functions  of all directions, (Order + 1) * N each, those of the a-th derivative from
///                   a * N on.
template <int Dim, int N, int Order>
inline void ContractPlane(const double* functions, const double* q, double* sets)
{
  if constexpr (Dim == 1)
  {
    std::copy_n(q, N, sets);
    return;
  }
  const double* v = functions + (Order + 1) * N;
  const double* w = functions + (Dim - 1) * (Order + 1) * N;
  constexpr int numSets = NumRowSets(Dim, Order);
  constexpr int numSlices = Dim == 3 ? N : 1;
  std::array<Row<N>, numSets> sums;
  for (int k = 0; k < numSlices; ++k)
  {
    std::array<Row<N>, Order + 1> slice;
    Row<N> row;
    for (int j = 0; j < N; ++j, q += N)
    {
      row.Load(q);
      for (int a = 0; a <= Order; ++a)
      {
        slice[static_cast<std::size_t>(a)].Add(v[a * N + j], row);
      }
    }
    if constexpr (Dim == 2)
    {
      sums = slice;
    }
    else
    {
      for (std::size_t m = 0; m < numSets; ++m)
      {
        const int index = static_cast<int>(m);
        sums[m].Add(
          w[SetOrderW<Dim>(index) * N + k], slice[static_cast<std::size_t>(SetOrderV<Dim>(index))]);
      }
    }
  }
  for (int m = 0; m < numSets; ++m)
  {
    sums[static_cast<std::size_t>(m)].Store(sets + m * N);
  }
}

/// Writes the terms of point i; those of its neighbours lie between them.
/// @param terms  planes x NumDerivativeTerms(Dim, Order), lanes apart.
template <int Dim, int Order>
inline void WriteTerms(const PointRange<Dim>& range, std::size_t i, const double* terms, int lanes)
{
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  const int numComponents = range.Form.NumComponents;
  const auto write = [&](double* rows, int first, int count)
  {
    double* row = rows + i * static_cast<std::size_t>(count * numComponents);
    for (int c = 0; c < numComponents; ++c)
    {
      for (int k = 0; k < count; ++k)
      {
        row[k * numComponents + c] = terms[(c * numTerms + first + k) * lanes];
      }
    }
  };
  write(range.Values, 0, 1);
  if constexpr (Order >= 1)
  {
    write(range.First, 1, Dim);
  }
  if constexpr (Order >= 2)
  {
    write(range.Second, 1 + Dim, Dim * (Dim + 1) / 2);
  }
}

/// Divides the terms of all components by those of the weight, which are the last.
template <int Dim, int Order, typename Real>
inline void DivideByWeight(int numComponents, Real* terms)
{
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  for (int c = 0; c < numComponents; ++c)
  {
    DivideTerms<Dim>(Order, terms + numComponents * numTerms, terms + c * numTerms);
  }
}

template <int Dim, int Order>
void WriteNaN(const PointRange<Dim>& range, std::size_t i)
{
  const std::size_t c = static_cast<std::size_t>(range.Form.NumComponents);
  const auto fill = [&](double* rows, std::size_t width)
  { std::fill_n(rows + i * width, width, std::numeric_limits<double>::quiet_NaN()); };
  fill(range.Values, c);
  if constexpr (Order >= 1)
  {
    fill(range.First, Dim * c);
  }
  if constexpr (Order >= 2)
  {
    fill(range.Second, Dim * (Dim + 1) / 2 * c);
  }
}

/// Points on elements of one degree P in all directions, four at a time: the functions and the last
/// contraction with a point a lane, the contractions before with a row of an element's control
/// points a register.
template <int Dim, int P, int Order>
void EvaluateFixed(const PointRange<Dim>& range, std::size_t begin, std::size_t end)
{
  constexpr int n = P + 1;
  constexpr int block = Dim == 1 ? n : (Dim == 2 ? n * n : n * n * n);
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  constexpr int numSets = NumRowSets(Dim, Order);
  constexpr int numBasis = (Order + 1) * n; // of one direction
  const SplineSpace<Dim>& space = *range.Form.Space;
  const int planes = range.Form.NumPlanes();
  const std::size_t blockBytes = sizeof(double) * static_cast<std::size_t>(planes * block);
  VectorArray<Four> terms(static_cast<std::size_t>(planes * numTerms));
  std::vector<double> sets(static_cast<std::size_t>(planes * NumLanes * numSets * n));

  for (std::size_t i = begin; i < end; i += NumLanes)
  {
    const std::size_t count = std::min<std::size_t>(NumLanes, end - i);
    std::array<int, NumLanes> elements{};
    Four local[Dim];
    Four scale[Dim];
    for (std::size_t l = 0; l < NumLanes; ++l)
    {
      const std::size_t point = i + std::min(l, count - 1);
      elements[l] = std::max(range.Elements[point], 0);
      const auto& box = space.Elements[static_cast<std::size_t>(elements[l])].Box;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        local[d][l] = range.Local[point * Dim + d];
        scale[d][l] = Order >= 1 ? box.Upper[d] - box.Lower[d] : 1.0;
      }
    }
    Four basis[Dim * numBasis];
    for (int d = 0; d < Dim; ++d)
    {
      BernsteinBasis<Order>(
        std::integral_constant<int, P>(), local[d], 1.0 / scale[d], basis + d * numBasis, n);
    }

    for (int l = 0; l < NumLanes; ++l)
    {
      // in place: GCC drops calls of functions that only prefetch
      const std::size_t ahead = std::min(i + NumLanes + static_cast<std::size_t>(l), end - 1);
      const int next = std::max(range.Elements[ahead], 0);
      const auto* line = reinterpret_cast<const char*>(range.Form.Block(next));
      for (std::size_t k = 0; k < blockBytes; k += 64)
      {
        __builtin_prefetch(line + k);
      }
      if constexpr (Order >= 1)
      {
        __builtin_prefetch(&space.Elements[static_cast<std::size_t>(next)].Box);
      }
      double functions[Dim * numBasis];
      for (int k = 0; k < Dim * numBasis; ++k)
      {
        functions[k] = basis[k][l];
      }
      const double* q = range.Form.Block(elements[static_cast<std::size_t>(l)]);
      for (int c = 0; c < planes; ++c)
      {
        ContractPlane<Dim, n, Order>(
          functions, q + c * block, sets.data() + (c * NumLanes + l) * numSets * n);
      }
    }
    for (int c = 0; c < planes; ++c)
    {
      Four columns[numSets * n];
      Transpose<numSets * n>(sets.data() + c * NumLanes * numSets * n, numSets * n, columns);
      const auto dot = [&](int m, int k, Four& sum)
      {
        sum = columns[m * n] * basis[k * n];
        for (int j = 1; j < n; ++j)
        {
          sum += columns[m * n + j] * basis[k * n + j];
        }
      };
      GatherTerms<Dim, Order>(dot, terms.data() + c * numTerms);
    }
    if (range.Form.Rational)
    {
      DivideByWeight<Dim, Order>(range.Form.NumComponents, terms.data());
    }
    for (std::size_t l = 0; l < count; ++l)
    {
      if (range.Elements[i + l] < 0)
      {
        WriteNaN<Dim, Order>(range, i + l);
      }
      else
      {
        WriteTerms<Dim, Order>(
          range, i + l, reinterpret_cast<const double*>(terms.data()) + l, NumLanes);
      }
    }
  }
}

/// Points on elements of unequal degrees.
template <int Dim, int Order>
void EvaluateAny(const PointRange<Dim>& range, std::size_t begin, std::size_t end)
{
  constexpr int stride = MaxDegree + 1;
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  constexpr int numSets = NumRowSets(Dim, Order);
  const SplineSpace<Dim>& space = *range.Form.Space;
  const int planes = range.Form.NumPlanes();
  std::vector<double> terms(static_cast<std::size_t>(planes * numTerms));
  double basis[3][(Order + 1) * stride] = {};
  basis[1][0] = basis[2][0] = 1.0;

  for (std::size_t i = begin; i < end; ++i)
  {
    const int e = range.Elements[i];
    if (e < 0)
    {
      WriteNaN<Dim, Order>(range, i);
      continue;
    }
    const auto& element = space.Elements[static_cast<std::size_t>(e)];
    IntArray<3> size{ 1, 1, 1 };
    for (std::size_t d = 0; d < Dim; ++d)
    {
      size[d] = element.Degree[d] + 1;
      BernsteinBasis<Order>(element.Degree[d], range.Local[i * Dim + d],
        1.0 / (element.Box.Upper[d] - element.Box.Lower[d]), basis[d], stride);
    }
    const double* q = range.Form.Block(e);
    for (int c = 0; c < planes; ++c)
    {
      double sets[numSets][stride] = {};
      for (int k = 0; k < size[2]; ++k)
      {
        for (int j = 0; j < size[1]; ++j, q += size[0])
        {
          for (int m = 0; m < numSets; ++m)
          {
            const double factor =
              basis[1][SetOrderV<Dim>(m) * stride + j] * basis[2][SetOrderW<Dim>(m) * stride + k];
            for (int l = 0; l < size[0]; ++l)
            {
              sets[m][l] += factor * q[l];
            }
          }
        }
      }
      const auto dot = [&](int m, int k, double& sum)
      { sum = std::inner_product(sets[m], sets[m] + size[0], basis[0] + k * stride, 0.0); };
      GatherTerms<Dim, Order>(dot, terms.data() + c * numTerms);
    }
    if (range.Form.Rational)
    {
      DivideByWeight<Dim, Order>(range.Form.NumComponents, terms.data());
    }
    WriteTerms<Dim, Order>(range, i, terms.data(), 1);
  }
}

/// Elements of degree P in all directions; 0: of unequal degrees.
template <int Dim, int P, int Order>
void EvaluateRange(const PointRange<Dim>& range, std::size_t begin, std::size_t end)
{
  WithWidestVectors(
    [&](auto)
    {
      if constexpr (P == 0)
      {
        EvaluateAny<Dim, Order>(range, begin, end);
      }
      else
      {
        EvaluateFixed<Dim, P, Order>(range, begin, end);
      }
    });
}

template <int Dim>
using RangeFunction = void (*)(const PointRange<Dim>&, std::size_t, std::size_t);

/// One function a degree; entry 0 is for elements of unequal degrees.
template <int Dim>
class Dispatch
{
  std::array<RangeFunction<Dim>, MaxDegree + 1> Functions;

  template <int Order, int... Degrees>
  void Fill(std::integer_sequence<int, Degrees...>)
  {
    this->Functions = { &EvaluateRange<Dim, Degrees, Order>... };
  }

public:
  explicit Dispatch(int order)
  {
    const auto degrees = std::make_integer_sequence<int, MaxDegree + 1>();
    if (order == 0)
    {
      this->template Fill<0>(degrees);
    }
    else if (order == 1)
    {
      this->template Fill<1>(degrees);
    }
    else
    {
      this->template Fill<2>(degrees);
    }
  }
  RangeFunction<Dim> operator()(int degreeClass) const
  {
    return this->Functions[static_cast<std::size_t>(degreeClass)];
  }
};

/// The common degree of an element in all directions, else 0.
template <int Dim>
int DegreeClass(const IntArray<Dim>& degree)
{
  const bool equal =
    std::all_of(degree.begin(), degree.end(), [&](int p) { return p == degree[0]; });
  return equal ? degree[0] : 0;
}

/// Whether elements of a space may have degrees of their own.
bool MayDifferInDegree(SpaceKind kind)
{
  return kind == SpaceKind::Bezier || kind == SpaceKind::Explicit;
}

/// Evaluates located points, run by run of one degree class.
template <int Dim>
void EvaluateChunk(const PointRange<Dim>& range, const Dispatch<Dim>& dispatch, std::size_t count)
{
  const SplineSpace<Dim>& space = *range.Form.Space;
  const auto degreeClass = [&](std::size_t i)
  {
    const int e = range.Elements[i];
    return DegreeClass<Dim>(space.Elements[static_cast<std::size_t>(std::max(e, 0))].Degree);
  };
  std::size_t begin = 0;
  while (begin < count)
  {
    const int runClass = degreeClass(begin);
    std::size_t end = MayDifferInDegree(space.Kind) ? begin + 1 : count;
    while (end < count && degreeClass(end) == runClass)
    {
      ++end;
    }
    dispatch(runClass)(range, begin, end);
    begin = end;
  }
}

template <int Dim>
Status CheckRequest(
  const BezierForm<Dim>& form, const PointMatrixView& points, const EvaluationParams& params)
{
  if (!form.Space || form.NumComponents < 1)
  {
    return { ErrorCode::EmptyInput, "the Bezier form is empty" };
  }
  if (points.cols() != Dim)
  {
    return { ErrorCode::SizeMismatch,
      "points have " + std::to_string(points.cols()) + " parameters, the space has " +
        std::to_string(Dim) };
  }
  if (params.Derivatives < 0 || params.Derivatives > 2)
  {
    return { ErrorCode::InvalidParameter,
      "derivatives of order " + std::to_string(params.Derivatives) + ", choose 0, 1 or 2" };
  }
  if (params.Threads < 0)
  {
    return { ErrorCode::InvalidParameter,
      "threads is " + std::to_string(params.Threads) + ", choose 0 (all) or more" };
  }
  return {};
}

/// Sizes the output, runs locate(begin, end, local) and the evaluation chunk by chunk.
/// @param locate  sets batch.Elements of a chunk and returns its local parameters, count x Dim; may
/// use the buffer it is given.
template <int Dim, typename LocateFunction>
Status EvaluateBatch(const BezierForm<Dim>& form, const PointMatrixView& points,
  const EvaluationParams& params, const LocateFunction& locate, EvaluationBatch& batch)
{
  const Eigen::Index n = points.rows();
  const Eigen::Index c = form.NumComponents;
  const int order = params.Derivatives;
  batch.Values.resize(n, c);
  batch.First.resize(order >= 1 ? n : 0, Dim * c);
  batch.Second.resize(order >= 2 ? n : 0, Dim * (Dim + 1) / 2 * c);
  batch.Elements.resize(static_cast<std::size_t>(n));

  const Dispatch<Dim> dispatch(order);
  ParallelFor(static_cast<std::size_t>(n), ChunkSize, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      double buffer[ChunkSize * Dim];
      const double* local = locate(begin, end, buffer);
      const auto row = static_cast<Eigen::Index>(begin);
      const PointRange<Dim> range{ form, local, batch.Elements.data() + begin,
        batch.Values.data() + row * c, batch.First.data() + row * batch.First.cols(),
        batch.Second.data() + row * batch.Second.cols() };
      EvaluateChunk<Dim>(range, dispatch, end - begin);
    });

  const auto outside = std::find(batch.Elements.begin(), batch.Elements.end(), -1);
  if (outside != batch.Elements.end())
  {
    const auto i = outside - batch.Elements.begin();
    return { ErrorCode::OutsideDomain,
      "point " + std::to_string(i) + " " + PointText(points.row(i).data(), Dim) };
  }
  return {};
}
}

template <int Dim>
Status EvaluateParameters(const BezierForm<Dim>& form, const PointMatrixView& parameters,
  const EvaluationParams& params, EvaluationBatch& batch)
{
  const Status status = CheckRequest(form, parameters, params);
  if (!status)
  {
    return status;
  }
  const SplineSpace<Dim>& space = *form.Space;
  if (!space.HasDomain())
  {
    return { ErrorCode::DimensionMismatch,
      "the space has no parameter domain; give elements and local parameters" };
  }
  const auto stride = parameters.outerStride();
  const auto locate = [&](std::size_t begin, std::size_t end, double* local)
  {
    const double* u = parameters.data() + static_cast<Eigen::Index>(begin) * stride;
    space.Locate(u, stride, end - begin, batch.Elements.data() + begin, local);
    return static_cast<const double*>(local);
  };
  return EvaluateBatch(form, parameters, params, locate, batch);
}

template <int Dim>
Status EvaluateElements(const BezierForm<Dim>& form, const std::vector<int>& elements,
  const PointMatrixView& local, const EvaluationParams& params, EvaluationBatch& batch)
{
  const Status status = CheckRequest(form, local, params);
  if (!status)
  {
    return status;
  }
  if (static_cast<Eigen::Index>(elements.size()) != local.rows())
  {
    return { ErrorCode::SizeMismatch,
      std::to_string(elements.size()) + " elements, " + std::to_string(local.rows()) + " points" };
  }
  const int numElements = form.Space->NumElements();
  const auto stride = local.outerStride();
  const auto locate = [&](std::size_t begin, std::size_t end, double* buffer)
  {
    for (std::size_t i = begin; i < end; ++i)
    {
      const double* u = local.data() + static_cast<Eigen::Index>(i) * stride;
      double* out = buffer + (i - begin) * Dim;
      bool valid = elements[i] >= 0 && elements[i] < numElements;
      for (int d = 0; d < Dim; ++d)
      {
        out[d] = u[d];
        valid = valid && std::isfinite(u[d]);
      }
      batch.Elements[i] = valid ? elements[i] : -1;
    }
    return static_cast<const double*>(buffer);
  };
  return EvaluateBatch(form, local, params, locate, batch);
}

#define KNOTWORK_INSTANTIATE(Dim)                                                                  \
  template Status EvaluateParameters<Dim>(                                                         \
    const BezierForm<Dim>&, const PointMatrixView&, const EvaluationParams&, EvaluationBatch&);    \
  template Status EvaluateElements<Dim>(const BezierForm<Dim>&, const std::vector<int>&,           \
    const PointMatrixView&, const EvaluationParams&, EvaluationBatch&)
KNOTWORK_INSTANTIATE(1);
KNOTWORK_INSTANTIATE(2);
KNOTWORK_INSTANTIATE(3);
#undef KNOTWORK_INSTANTIATE
}
