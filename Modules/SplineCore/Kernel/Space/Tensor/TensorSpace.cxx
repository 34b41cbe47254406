// SPDX-License-Identifier: BSD-3-Clause
#include "TensorSpace.h"

#include "FactorPool.h"

#include <limits>

namespace knotwork
{
template <int Dim>
Result<SplineSpacePtr<Dim>> MakeTensorSpace(const std::array<KnotVector, Dim>& knots)
{
  constexpr double limit = std::numeric_limits<int>::max();
  double functions = 1.0;
  double elements = 1.0;
  IntArray<Dim> degree;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    functions *= knots[d].NumFunctions();
    elements *= knots[d].NumElements();
    degree[d] = knots[d].Degree();
  }
  if (functions > limit || elements > limit)
  {
    return { ErrorCode::TooLarge,
      "a tensor-product space has at most 2^31 - 1 functions and elements" };
  }
  auto space = std::make_shared<SplineSpace<Dim>>();
  space->Kind = SpaceKind::Tensor;
  space->Knots = knots;
  space->NumFunctions = static_cast<int>(functions);
  space->NumLocalFunctions = space->NumFunctions;

  FactorPool pool(space->FactorData);
  std::array<std::vector<int>, Dim> factors; // of every 1D element
  for (std::size_t d = 0; d < Dim; ++d)
  {
    double matrix[(MaxDegree + 1) * (MaxDegree + 1)];
    for (int e = 0; e < knots[d].NumElements(); ++e)
    {
      knots[d].Extraction(e, matrix);
      factors[d].push_back(pool.Add(degree[d], matrix));
    }
  }

  const std::size_t numElements = static_cast<std::size_t>(elements);
  const std::size_t perElement = static_cast<std::size_t>(NumTensorFunctions<Dim>(degree));
  // function ids of an element relative to its first one
  std::vector<int> offsets(perElement);
  for (std::size_t i = 0; i < perElement; ++i)
  {
    int rest = static_cast<int>(i);
    int stride = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      offsets[i] += stride * (rest % (degree[d] + 1));
      rest /= degree[d] + 1;
      stride *= knots[d].NumFunctions();
    }
  }
  space->Elements.resize(numElements);
  space->LocalFunctionIds.resize(numElements * perElement);
  space->RootCells.resize(numElements);
  IntArray<Dim> index{};
  for (std::size_t e = 0; e < numElements; ++e)
  {
    auto& element = space->Elements[e];
    element.Degree = degree;
    element.FirstLocal = e * perElement;
    int first = 0;
    int stride = 1;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      const std::size_t k = static_cast<std::size_t>(index[d]);
      element.Box.Lower[d] = knots[d].Breaks()[k];
      element.Box.Upper[d] = knots[d].Breaks()[k + 1];
      element.Factor[d] = factors[d][k];
      first += stride * (knots[d].Span(index[d]) - degree[d]);
      stride *= knots[d].NumFunctions();
    }
    int* ids = space->LocalFunctionIds.data() + element.FirstLocal;
    for (std::size_t i = 0; i < perElement; ++i)
    {
      ids[i] = first + offsets[i];
    }
    space->RootCells[e] = static_cast<int>(e);
    for (std::size_t d = 0; d < Dim && ++index[d] == knots[d].NumElements(); ++d)
    {
      index[d] = 0;
    }
  }
  return SplineSpacePtr<Dim>(std::move(space));
}

template Result<SplineSpacePtr<1>> MakeTensorSpace<1>(const std::array<KnotVector, 1>&);
template Result<SplineSpacePtr<2>> MakeTensorSpace<2>(const std::array<KnotVector, 2>&);
template Result<SplineSpacePtr<3>> MakeTensorSpace<3>(const std::array<KnotVector, 3>&);
}
