// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FixedFilter.h"

namespace knotwork
{
/// Numerator of det J for a pack of planar or spatial cells of one shape and degree, with the error
/// bound of JacobianForms. Degrees 1 to 4 of polynomial quadrilaterals, 1 to 3 of rational ones and
/// of polynomial hexahedra are compiled for their size.
/// @param block  one a lane.
template <typename Pack>
class CoefficientFilter
{
public:
  CoefficientFilter() : Forms(this->Cache) {}
  void Determinant(CellShape shape, const CellDegree& degree, bool rational,
    const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds);
  /// Surfaces and curves in space: the normal (tangent) along the mean of its coefficients.
  void Norm(CellShape shape, const CellDegree& degree, int numComponents, bool rational,
    const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds);
  LayoutCache& Layouts() { return this->Cache; }

private:
  void Load(CellShape shape, const CellDegree& degree, int numComponents, bool rational,
    const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds);

  LayoutCache Cache;
  JacobianForms<Pack> Forms;
  VectorArray<Pack> Planes;
};

/// Square root a lane.
template <typename Pack>
inline Pack RootOf(const Pack& a)
{
  Pack root = a;
  for (int l = 0; l < LanesOf<Pack>; ++l)
  {
    root[l] = std::sqrt(a[l]);
  }
  return root;
}

template <typename Pack>
inline Pack PowerOf(const Pack& a, int n)
{
  Pack power = Pack{} + 1.0;
  for (int k = 0; k < n; ++k)
  {
    power = power * a;
  }
  return power;
}

template <typename Pack>
void CoefficientFilter<Pack>::Load(CellShape shape, const CellDegree& degree, int numComponents,
  bool rational, const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds)
{
  const int n = NumCellCoefficients(shape, degree);
  const int planes = numComponents + (rational ? 1 : 0);
  this->Planes.resize(static_cast<std::size_t>(planes * n));
  bounds = CoefficientBounds<Pack>{};
  for (int i = 0; i < planes * n; ++i)
  {
    Pack x;
    for (int l = 0; l < LanesOf<Pack>; ++l)
    {
      x[l] = blocks[static_cast<std::size_t>(l)][i];
    }
    this->Planes[static_cast<std::size_t>(i)] = x;
    bounds.NotFinite += 0.0 * x;
  }
  bounds.SmallestWeight = bounds.LargestWeight = Pack{} + 1.0;
  const Pack* w = this->Planes.data() + numComponents * n;
  if (rational)
  {
    bounds.SmallestWeight = bounds.LargestWeight = w[0];
    for (int i = 1; i < n; ++i)
    {
      bounds.SmallestWeight = Smaller(bounds.SmallestWeight, w[i]);
      bounds.LargestWeight = Larger(bounds.LargestWeight, w[i]);
    }
    bounds.Magnitude = bounds.LargestWeight;
  }
  std::array<const Pack*, 4> pointers{};
  std::array<Pack, 4> absolute{};
  for (int c = 0; c < planes; ++c)
  {
    Pack* p = this->Planes.data() + c * n;
    pointers[static_cast<std::size_t>(c)] = p;
    Pack size = Pack{};
    Pack error = given;
    if (rational && c < numComponents)
    {
      // to the cell's middle: two roundings a coefficient
      const Pack centre = 0.5 * (p[0] / w[0] + p[n - 1] / w[n - 1]);
      for (int i = 0; i < n; ++i)
      {
        p[i] = p[i] - centre * w[i];
        size = Larger(size, Magnitude(p[i]));
      }
      error = error + Magnitude(centre) * given +
        2.0 * UnitRoundoff * (Magnitude(centre) * bounds.LargestWeight + size);
    }
    else if (c < numComponents)
    {
      for (int i = 0; i < n; ++i)
      {
        size = Larger(size, Magnitude(p[i]));
      }
    }
    absolute[static_cast<std::size_t>(c)] = error;
    bounds.Magnitude = Larger(bounds.Magnitude, size);
  }
  this->Forms.Set(shape, degree, numComponents, rational, pointers, absolute);
}

template <typename Pack>
inline Pack ErrorOf(const Form<Pack>& form)
{
  const int roundings = form.Roundings + form.Layout->MultinomialRoundings + 1;
  return RoundingFactor(roundings) * form.Magnitude + form.Absolute * (1.0 + 0x1p-30) + 0x1p-700;
}

/// The usual degrees; false for the others.
template <typename Pack>
bool FixedDeterminant(CellShape shape, const CellDegree& degree, bool rational,
  const BlocksOf<Pack>& blocks, CoefficientBounds<Pack>& bounds)
{
  const int p = degree[0];
  if (shape == CellShape::Quadrilateral && degree[1] == p)
  {
    switch (rational ? -p : p)
    {
      case 1:
        fixed::PolynomialQuadrilateral<Pack, 1, 1>(blocks, bounds);
        return true;
      case 2:
        fixed::PolynomialQuadrilateral<Pack, 2, 2>(blocks, bounds);
        return true;
      case 3:
        fixed::PolynomialQuadrilateral<Pack, 3, 3>(blocks, bounds);
        return true;
      case 4:
        fixed::PolynomialQuadrilateral<Pack, 4, 4>(blocks, bounds);
        return true;
      case -1:
        fixed::RationalQuadrilateral<Pack, 1, 1>(blocks, bounds);
        return true;
      case -2:
        fixed::RationalQuadrilateral<Pack, 2, 2>(blocks, bounds);
        return true;
      case -3:
        fixed::RationalQuadrilateral<Pack, 3, 3>(blocks, bounds);
        return true;
      case -4:
        fixed::RationalQuadrilateral<Pack, 4, 4>(blocks, bounds);
        return true;
      default:
        return false;
    }
  }
  if (shape == CellShape::Hexahedron && !rational && degree[1] == p && degree[2] == p)
  {
    switch (p)
    {
      case 1:
        fixed::LinearHexahedron<Pack>(blocks, bounds);
        return true;
      case 2:
        fixed::PolynomialHexahedron<Pack, 2, 2, 2>(blocks, bounds);
        return true;
      case 3:
        fixed::PolynomialHexahedron<Pack, 3, 3, 3>(blocks, bounds);
        return true;
      default:
        return false;
    }
  }
  return false;
}

template <typename Pack>
void CoefficientFilter<Pack>::Determinant(CellShape shape, const CellDegree& degree, bool rational,
  const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds)
{
  bool exactInput = true;
  for (int l = 0; l < LanesOf<Pack>; ++l)
  {
    exactInput = exactInput && given[l] == 0.0;
  }
  if (exactInput && FixedDeterminant(shape, degree, rational, blocks, bounds))
  {
    return;
  }
  const int components = NumParameters(shape);
  this->Load(shape, degree, components, rational, blocks, given, bounds);
  const Form<Pack>& form = this->Forms.Determinant();
  const FormLayout& layout = *form.Layout;
  bounds.Smallest = Pack{} + std::numeric_limits<double>::infinity();
  bounds.Largest = -bounds.Smallest;
  for (int i = 0; i < layout.Size; ++i)
  {
    const std::size_t at = static_cast<std::size_t>(i);
    const Pack value = form.C[at] / layout.Multinomials[at];
    bounds.Smallest = Smaller(bounds.Smallest, value);
    bounds.Largest = Larger(bounds.Largest, value);
  }
  bounds.Error = ErrorOf(form);
  bounds.SmallestCorner = Pack{} + std::numeric_limits<double>::infinity();
  bounds.LargestCorner = -bounds.SmallestCorner;
  const FormLayout& cell = this->Cache.Get(shape, degree);
  const Pack* w = this->Planes.data() + components * cell.Size;
  for (std::size_t c = 0; c < layout.Corners.size(); ++c)
  {
    Pack value = form.C[static_cast<std::size_t>(layout.Corners[c])]; // its multinomial is 1
    if (rational)
    {
      value = value / PowerOf(w[cell.Corners[c]], this->Forms.WeightPower());
    }
    bounds.SmallestCorner = Smaller(bounds.SmallestCorner, value);
    bounds.LargestCorner = Larger(bounds.LargestCorner, value);
  }
}

template <typename Pack>
void CoefficientFilter<Pack>::Norm(CellShape shape, const CellDegree& degree, int numComponents,
  bool rational, const BlocksOf<Pack>& blocks, const Pack& given, CoefficientBounds<Pack>& bounds)
{
  this->Load(shape, degree, numComponents, rational, blocks, given, bounds);
  const int n = this->Forms.NumNormals();
  std::array<const Form<Pack>*, 3> normals{};
  std::array<Pack, 3> mean{};
  Pack length{};
  for (int c = 0; c < n; ++c)
  {
    const std::size_t k = static_cast<std::size_t>(c);
    normals[k] = &this->Forms.Normal(c);
    const FormLayout& layout = *normals[k]->Layout;
    for (int i = 0; i < layout.Size; ++i)
    {
      const std::size_t at = static_cast<std::size_t>(i);
      mean[k] += normals[k]->C[at] / layout.Multinomials[at];
    }
    length += mean[k] * mean[k];
  }
  length = RootOf(length);
  const FormLayout& layout = *normals[0]->Layout;
  bounds.Smallest = Pack{} + std::numeric_limits<double>::infinity();
  bounds.SmallestCorner = Pack{} + std::numeric_limits<double>::infinity();
  Pack magnitudes{};
  for (int c = 0; c < n; ++c)
  {
    const std::size_t k = static_cast<std::size_t>(c);
    // a direction within 8 u of unit length; none: the loop below finds zeros
    mean[k] = length > 0.0 ? mean[k] / length : Pack{};
    bounds.Error = bounds.Error + ErrorOf(*normals[k]);
    magnitudes = magnitudes + normals[k]->Magnitude;
  }
  for (int i = 0; i < layout.Size; ++i)
  {
    const std::size_t at = static_cast<std::size_t>(i);
    Pack along{};
    Pack square{};
    for (int c = 0; c < n; ++c)
    {
      const std::size_t k = static_cast<std::size_t>(c);
      const Pack value = normals[k]->C[at] / layout.Multinomials[at];
      along += value * mean[k];
      square += value * value;
    }
    bounds.Smallest = Smaller(bounds.Smallest, along);
    bounds.Largest = Larger(bounds.Largest, square);
    const auto corner = std::find(layout.Corners.begin(), layout.Corners.end(), i);
    if (corner != layout.Corners.end())
    {
      if (rational)
      {
        const FormLayout& cell = this->Cache.Get(shape, degree);
        const Pack* w = this->Planes.data() + numComponents * cell.Size;
        square = square /
          PowerOf(w[cell.Corners[static_cast<std::size_t>(corner - layout.Corners.begin())]],
            2 * this->Forms.WeightPower());
      }
      bounds.SmallestCorner = Smaller(bounds.SmallestCorner, square);
      bounds.LargestCorner = Larger(bounds.LargestCorner, square);
    }
  }
  bounds.Largest = RootOf(bounds.Largest) * (1.0 + 0x1p-48);
  bounds.SmallestCorner = RootOf(bounds.SmallestCorner);
  bounds.LargestCorner = RootOf(bounds.LargestCorner);
  // the products with the direction, and its length
  bounds.Error = bounds.Error + 16.0 * UnitRoundoff * magnitudes;
}
}
