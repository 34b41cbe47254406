// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinBasis.h"
#include "BezierForm.h"
#include "Parallel.h"
#include "QuotientRule.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 512;
constexpr int MaxFixedDegree = 5;
constexpr int MaxFixedPlanes = 5; // four components and a weight

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
  typedef double Type __attribute__((vector_size(32)));
};

/// N doubles in registers: vectors of four and two, then a scalar. A bicubic row is one AVX
/// register; without AVX the compiler splits the vectors.
template <int N>
class Lanes
{
  static constexpr int Width = N >= 4 ? 4 : (N >= 2 ? 2 : 1);
  using Vector = typename VectorOf<Width>::Type;
  Vector Head{};
  Lanes<N - Width> Tail;

public:
  void Load(const double* p)
  {
    std::memcpy(&this->Head, p, sizeof(Vector));
    this->Tail.Load(p + Width);
  }
  /// this += w * row
  void Add(double w, const Lanes& row)
  {
    this->Head += w * row.Head;
    this->Tail.Add(w, row.Tail);
  }
  double Dot(const Lanes& other) const
  {
    const Vector product = this->Head * other.Head;
    if constexpr (Width == 4)
    {
      return ((product[0] + product[2]) + (product[1] + product[3])) + this->Tail.Dot(other.Tail);
    }
    else if constexpr (Width == 2)
    {
      return (product[0] + product[1]) + this->Tail.Dot(other.Tail);
    }
    else
    {
      return product;
    }
  }
};
template <>
class Lanes<0>
{
public:
  void Load(const double*) {}
  void Add(double, const Lanes&) {}
  double Dot(const Lanes&) const { return 0.0; }
};

/// The same for a row whose length is known at run time only.
class AnyLanes
{
  int Count = 0;
  std::array<double, MaxDegree + 1> Values{};

public:
  AnyLanes() = default;
  explicit AnyLanes(int count) : Count(count) {}
  void Load(const double* p) { std::copy_n(p, this->Count, this->Values.begin()); }
  void Add(double w, const AnyLanes& row)
  {
    for (int i = 0; i < this->Count; ++i)
    {
      this->Values[static_cast<std::size_t>(i)] += w * row.Values[static_cast<std::size_t>(i)];
    }
  }
  double Dot(const AnyLanes& other) const
  {
    return std::inner_product(
      this->Values.begin(), this->Values.begin() + this->Count, other.Values.begin(), 0.0);
  }
};

/// The points start, start + 1, ... of a batch and where their results go.
template <int Dim>
struct Job
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
constexpr int SetOrderV[6] = { 0, 1, 0, 2, 1, 0 };
constexpr int SetOrderW[6] = { 0, 0, 1, 0, 1, 2 };

/// Terms of one component; dot(m, k) = set m contracted with the k-th derivatives of direction 0.
template <int Dim, int Order, typename DotFunction>
inline void GatherTerms(const DotFunction& dot, double* terms)
{
  terms[0] = dot(0, 0);
  if constexpr (Order >= 1)
  {
    terms[1] = dot(0, 1);
    for (int d = 1; d < Dim; ++d)
    {
      terms[1 + d] = dot(d, 0);
    }
  }
  if constexpr (Order >= 2)
  {
    double* second = terms + 1 + Dim;
    second[0] = dot(0, 2);
    for (int d = 1; d < Dim; ++d)
    {
      second[d] = dot(d, 1);
    }
    for (int k = Dim; k < NumRowSets(Dim, Order); ++k)
    {
      second[k] = dot(k, 0);
    }
  }
}

/// Terms of the component whose plane begins at q.
/// @param basis  functions of direction d and their derivatives at basis + d * (Order + 1) *
/// stride.
/// @param u      those of direction 0 as rows.
/// @param zero   a row of zeros.
/// @return the end of the plane.
template <int Dim, int Order, typename Row, typename DegreeFunction>
inline const double* ContractPlane(const DegreeFunction& degree, const double* basis, int stride,
  const Row* u, const Row& zero, const double* q, double* terms)
{
  constexpr int numSets = NumRowSets(Dim, Order);
  const int length = degree(0) + 1;
  std::array<Row, numSets> sets;
  sets.fill(zero);
  Row row = zero;
  if constexpr (Dim == 1)
  {
    sets[0].Load(q);
    q += length;
  }
  else
  {
    const int numRows = degree(1) + 1;
    const int numSlices = Dim == 3 ? degree(Dim - 1) + 1 : 1;
    const double* v = basis + (Order + 1) * stride;
    const double* w = basis + (Dim - 1) * (Order + 1) * stride;
    for (int k = 0; k < numSlices; ++k)
    {
      std::array<Row, Order + 1> slice;
      slice.fill(zero);
      for (int j = 0; j < numRows; ++j, q += length)
      {
        row.Load(q);
        for (std::size_t a = 0; a <= Order; ++a)
        {
          slice[a].Add(v[static_cast<int>(a) * stride + j], row);
        }
      }
      if constexpr (Dim == 2)
      {
        sets = slice;
      }
      else
      {
        for (std::size_t m = 0; m < numSets; ++m)
        {
          sets[m].Add(w[SetOrderW[m] * stride + k], slice[static_cast<std::size_t>(SetOrderV[m])]);
        }
      }
    }
  }
  const auto dot = [&](int m, int k) { return sets[static_cast<std::size_t>(m)].Dot(u[k]); };
  GatherTerms<Dim, Order>(dot, terms);
  return q;
}

/// Writes the terms of all components of point i.
/// @param terms  planes x NumDerivativeTerms(Dim, Order), those of the weight last when rational.
template <int Dim, int Order, typename Count>
inline void WriteTerms(
  const Job<Dim>& job, std::size_t i, double* terms, const Count numComponents, bool rational)
{
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  if (rational)
  {
    const double* w = terms + numComponents * numTerms;
    for (int c = 0; c < numComponents; ++c)
    {
      DivideTerms<Dim>(Order, w, terms + c * numTerms);
    }
  }
  const auto write = [&](double* rows, int first, int count)
  {
    double* row = rows + i * static_cast<std::size_t>(count * numComponents);
    for (int k = 0; k < count; ++k)
    {
      for (int c = 0; c < numComponents; ++c)
      {
        row[k * numComponents + c] = terms[c * numTerms + first + k];
      }
    }
  };
  write(job.Values, 0, 1);
  if constexpr (Order >= 1)
  {
    write(job.First, 1, Dim);
  }
  if constexpr (Order >= 2)
  {
    write(job.Second, 1 + Dim, Dim * (Dim + 1) / 2);
  }
}

template <int Dim, int Order>
void WriteNaN(const Job<Dim>& job, std::size_t i)
{
  const std::size_t c = static_cast<std::size_t>(job.Form.NumComponents);
  const auto fill = [&](double* rows, std::size_t width)
  { std::fill_n(rows + i * width, width, std::numeric_limits<double>::quiet_NaN()); };
  fill(job.Values, c);
  if constexpr (Order >= 1)
  {
    fill(job.First, Dim * c);
  }
  if constexpr (Order >= 2)
  {
    fill(job.Second, Dim * (Dim + 1) / 2 * c);
  }
}

/// Bernstein polynomials of all directions at the point, derivatives by the domain's parameters.
/// @param degree  of a direction; an integral constant when compiled for it.
template <int Dim, int Order, typename DegreeFunction>
inline void PointBasis(const SplineSpace<Dim>& space, int element, const DegreeFunction& degree,
  const double* local, double* basis, int stride)
{
  for (int d = 0; d < Dim; ++d)
  {
    double scale = 1.0;
    if constexpr (Order >= 1)
    {
      const auto& box = space.Elements[static_cast<std::size_t>(element)].Box;
      scale = 1.0 / (box.Upper[d] - box.Lower[d]);
    }
    BernsteinBasis<Order>(degree(d), local[d], scale, basis + d * (Order + 1) * stride, stride);
  }
}

/// Points on elements of one degree P in all directions.
template <int Dim, int P, int Planes, int Order>
void EvaluateFixed(const Job<Dim>& job, std::size_t begin, std::size_t end)
{
  constexpr int n = P + 1;
  constexpr int rows = Dim == 1 ? 1 : (Dim == 2 ? n : n * n);
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  constexpr std::size_t blockBytes = sizeof(double) * Planes * rows * n;
  constexpr std::size_t ahead =
    std::max<std::size_t>(2, std::min<std::size_t>(8, 3072 / blockBytes));
  const SplineSpace<Dim>& space = *job.Form.Space;
  const auto degree = [](int) { return std::integral_constant<int, P>(); };
  for (std::size_t i = begin; i < end; ++i)
  {
    // in place: GCC drops calls of functions that only prefetch
    const int next = job.Elements[std::min(i + ahead, end - 1)];
    const auto* line = reinterpret_cast<const char*>(
      job.Form.Data.data() + job.Form.Offsets[static_cast<std::size_t>(std::max(next, 0))]);
    for (std::size_t k = 0; k < blockBytes; k += 64)
    {
      __builtin_prefetch(line + k);
    }
    if constexpr (Order >= 1)
    {
      __builtin_prefetch(&space.Elements[static_cast<std::size_t>(std::max(next, 0))].Box);
    }
    const int e = job.Elements[i];
    if (e < 0)
    {
      WriteNaN<Dim, Order>(job, i);
      continue;
    }
    double basis[Dim * (Order + 1) * n];
    PointBasis<Dim, Order>(space, e, degree, job.Local + i * Dim, basis, n);
    Lanes<n> u[Order + 1];
    for (int k = 0; k <= Order; ++k)
    {
      u[k].Load(basis + k * n);
    }
    double terms[Planes * numTerms];
    const double* q = job.Form.Block(e);
    for (int c = 0; c < Planes; ++c)
    {
      q = ContractPlane<Dim, Order>(degree, basis, n, u, Lanes<n>(), q, terms + c * numTerms);
    }
    if (job.Form.Rational)
    {
      WriteTerms<Dim, Order>(job, i, terms, std::integral_constant<int, Planes - 1>(), true);
    }
    else
    {
      WriteTerms<Dim, Order>(job, i, terms, std::integral_constant<int, Planes>(), false);
    }
  }
}

/// Points on elements of any degrees.
template <int Dim, int Order>
void EvaluateAny(const Job<Dim>& job, std::size_t begin, std::size_t end)
{
  constexpr int n = MaxDegree + 1;
  constexpr int numTerms = NumDerivativeTerms(Dim, Order);
  const SplineSpace<Dim>& space = *job.Form.Space;
  const int planes = job.Form.NumPlanes();
  std::vector<double> terms(static_cast<std::size_t>(planes * numTerms));
  double basis[Dim * (Order + 1) * n];

  for (std::size_t i = begin; i < end; ++i)
  {
    const int e = job.Elements[i];
    if (e < 0)
    {
      WriteNaN<Dim, Order>(job, i);
      continue;
    }
    const IntArray<Dim>& degrees = space.Elements[static_cast<std::size_t>(e)].Degree;
    const auto degree = [&](int d) { return degrees[static_cast<std::size_t>(d)]; };
    PointBasis<Dim, Order>(space, e, degree, job.Local + i * Dim, basis, n);
    const AnyLanes zero(degree(0) + 1);
    std::array<AnyLanes, Order + 1> u;
    u.fill(zero);
    for (std::size_t k = 0; k <= Order; ++k)
    {
      u[k].Load(basis + static_cast<int>(k) * n);
    }
    const double* q = job.Form.Block(e);
    for (int c = 0; c < planes; ++c)
    {
      q =
        ContractPlane<Dim, Order>(degree, basis, n, u.data(), zero, q, terms.data() + c * numTerms);
    }
    WriteTerms<Dim, Order>(job, i, terms.data(), job.Form.NumComponents, job.Form.Rational);
  }
}

template <int Dim>
using RangeFunction = void (*)(const Job<Dim>&, std::size_t, std::size_t);

template <int Dim, int P, int Order>
RangeFunction<Dim> SelectPlanes(int planes)
{
  switch (planes)
  {
    case 1:
      return &EvaluateFixed<Dim, P, 1, Order>;
    case 2:
      return &EvaluateFixed<Dim, P, 2, Order>;
    case 3:
      return &EvaluateFixed<Dim, P, 3, Order>;
    case 4:
      return &EvaluateFixed<Dim, P, 4, Order>;
    case 5:
      return &EvaluateFixed<Dim, P, 5, Order>;
    default:
      return &EvaluateAny<Dim, Order>;
  }
}

/// One function a degree; entry 0 is for degrees above 5 or unequal ones.
template <int Dim>
struct Dispatch
{
  std::array<RangeFunction<Dim>, MaxFixedDegree + 1> Functions;

  Dispatch(int planes, int order)
  {
    if (order == 0)
    {
      this->Fill<0>(planes);
    }
    else if (order == 1)
    {
      this->Fill<1>(planes);
    }
    else
    {
      this->Fill<2>(planes);
    }
  }
  RangeFunction<Dim> operator()(int degreeClass) const
  {
    return this->Functions[static_cast<std::size_t>(degreeClass)];
  }

private:
  template <int Order>
  void Fill(int planes)
  {
    this->Functions = { &EvaluateAny<Dim, Order>, SelectPlanes<Dim, 1, Order>(planes),
      SelectPlanes<Dim, 2, Order>(planes), SelectPlanes<Dim, 3, Order>(planes),
      SelectPlanes<Dim, 4, Order>(planes), SelectPlanes<Dim, 5, Order>(planes) };
  }
};

/// The common degree of an element when it is one of the compiled ones, else 0.
template <int Dim>
int DegreeClass(const IntArray<Dim>& degree)
{
  const bool equal =
    std::all_of(degree.begin(), degree.end(), [&](int p) { return p == degree[0]; });
  return equal && degree[0] <= MaxFixedDegree ? degree[0] : 0;
}

/// Evaluates located points, run by run of one degree class; only a Bezier space has several.
template <int Dim>
void EvaluateChunk(const Job<Dim>& job, const Dispatch<Dim>& dispatch, std::size_t count)
{
  const SplineSpace<Dim>& space = *job.Form.Space;
  const auto degreeClass = [&](std::size_t i)
  {
    const int e = job.Elements[i];
    return DegreeClass<Dim>(space.Elements[static_cast<std::size_t>(std::max(e, 0))].Degree);
  };
  std::size_t begin = 0;
  while (begin < count)
  {
    const int runClass = degreeClass(begin);
    std::size_t end = space.Kind == SpaceKind::Bezier ? begin + 1 : count;
    while (end < count && degreeClass(end) == runClass)
    {
      ++end;
    }
    dispatch(runClass)(job, begin, end);
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

  const Dispatch<Dim> dispatch(form.NumPlanes(), order);
  ParallelFor(static_cast<std::size_t>(n), ChunkSize, params.Threads,
    [&](std::size_t begin, std::size_t end)
    {
      double buffer[ChunkSize * Dim];
      const double* local = locate(begin, end, buffer);
      const auto row = static_cast<Eigen::Index>(begin);
      const Job<Dim> job{ form, local, batch.Elements.data() + begin, batch.Values.data() + row * c,
        batch.First.data() + row * batch.First.cols(),
        batch.Second.data() + row * batch.Second.cols() };
      EvaluateChunk<Dim>(job, dispatch, end - begin);
    });

  const auto outside = std::find(batch.Elements.begin(), batch.Elements.end(), -1);
  if (outside != batch.Elements.end())
  {
    const auto i = outside - batch.Elements.begin();
    std::string detail = "point " + std::to_string(i) + " (";
    for (int d = 0; d < Dim; ++d)
    {
      detail += (d > 0 ? ", " : "") + std::to_string(points(i, d));
    }
    return { ErrorCode::OutsideDomain, detail + ")" };
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
  if (!space.HasDomain)
  {
    return { ErrorCode::DimensionMismatch,
      "the space has no parameter domain; give elements and local parameters" };
  }
  const auto stride = parameters.outerStride();
  const auto locate = [&](std::size_t begin, std::size_t end, double* local)
  {
    const double* u = parameters.data() + static_cast<Eigen::Index>(begin) * stride;
    for (std::size_t i = begin; i < end; ++i, u += stride)
    {
      batch.Elements[i] = space.Locate(u, local + (i - begin) * Dim);
    }
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
