// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FormLayout.h"
#include "RoundingBound.h"
#include <knotwork/SplineCore/WideVectors.h>

#include <algorithm>
#include <type_traits>

/// Numerators of Jacobians as forms of minimal degree, in any arithmetic: doubles, packs of doubles
/// (a cell a lane) with a static error bound, integers (exact).
///
/// Error bound. Let u = 2^-53. Every computed coefficient is a sum of products of stored numbers,
/// and each such term has gone through at most r roundings, so it carries a factor (1 + d) with |d|
/// <= r u / (1 - r u). In the scaled basis the binomial weights of a convolution sum to the
/// multinomial of the result (Vandermonde), so if `Magnitude` bounds the unscaled coefficients of
/// the factors, the product of the magnitudes bounds the sum of the absolute terms of every
/// unscaled coefficient of the product. Hence for all coefficients at once
///   |computed - exact| <= r u / (1 - r u) * Magnitude + Absolute,
/// where Absolute carries errors that are not relative (a given uncertainty of the input, the shift
/// to a cell's centre).
///   product:  r = rA + rB + 1 + additions,  M = MA MB,  A = MA AB + MB AA + AA AB
///   sum:      r = max(rA, rB) + 1,          M = MA + MB, A = AA + AB
/// Magnitudes are themselves rounded; a factor 1 + 2^-30 on the result covers that. Underflow is
/// kept away by the caller (magnitudes within 2^-200 .. 2^200 of one).
namespace knotwork
{
/// Packs of doubles: those of as many cells, a cell a lane.
template <typename Pack>
inline constexpr int LanesOf = static_cast<int>(sizeof(Pack) / sizeof(double));
template <typename T>
inline constexpr bool IsPack = !std::is_class_v<T> && !std::is_arithmetic_v<T>;

template <typename T>
using CoefficientArray = std::conditional_t<IsPack<T>, VectorArray<T>, std::vector<T>>;

template <typename T>
struct Form
{
  const FormLayout* Layout = nullptr;
  CoefficientArray<T> C; ///< scaled coefficients
  T Magnitude{};
  T Absolute{};
  int Roundings = 0;

  void Clear(const FormLayout& layout)
  {
    this->Layout = &layout;
    this->C.assign(static_cast<std::size_t>(layout.Size), T{});
    this->Magnitude = T{};
    this->Absolute = T{};
    this->Roundings = 0;
  }
};

template <typename Pack, typename = std::enable_if_t<IsPack<Pack>>>
inline Pack Magnitude(const Pack& a)
{
  return a < 0.0 ? -a : a;
}
template <typename Pack, typename = std::enable_if_t<IsPack<Pack>>>
inline Pack Larger(const Pack& a, const Pack& b)
{
  return a > b ? a : b;
}
template <typename Pack, typename = std::enable_if_t<IsPack<Pack>>>
inline Pack Smaller(const Pack& a, const Pack& b)
{
  return a < b ? a : b;
}

template <typename T>
class JacobianForms
{
public:
  /// Exact arithmetic needs no bounds.
  static constexpr bool HasErrors = !std::is_class_v<T>;

  explicit JacobianForms(LayoutCache& cache) : Cache(cache) {}

  /// @param planes    components, then the weights when rational; unscaled coefficients, kept by
  ///                  reference.
  /// @param absolute  error of every plane's coefficients.
  void Set(CellShape shape, const CellDegree& degree, int numComponents, bool rational,
    const std::array<const T*, 4>& planes, const std::array<T, 4>& absolute)
  {
    this->Shape = shape;
    this->Degree = degree;
    this->Layout = &this->Cache.Get(shape, degree);
    this->Planes = planes;
    this->Absolute = absolute;
    this->Components = numComponents;
    this->Rational = rational;
  }

  /// Numerator of det J; as many components as parameters (2 or 3).
  const Form<T>& Determinant()
  {
    if (NumParameters(this->Shape) == 2)
    {
      this->PlanarMinor(0, 1, this->Components, this->Result);
    }
    else if (!this->Rational)
    {
      this->SpatialDeterminant();
    }
    else
    {
      this->RationalSpatialDeterminant();
    }
    return this->Result;
  }

  /// Components of the numerator of S_u x S_v (3), or of C_u (as many as the curve has).
  int NumNormals() const { return NumParameters(this->Shape) == 1 ? this->Components : 3; }
  const Form<T>& Normal(int component)
  {
    Form<T>& normal = this->Normals[static_cast<std::size_t>(component)];
    if (NumParameters(this->Shape) == 1)
    {
      this->Tangent(component, normal);
    }
    else
    {
      this->PlanarMinor((component + 1) % 3, (component + 2) % 3, this->Components, normal);
    }
    return normal;
  }
  /// Sum of the squares of the normals (which must have been made).
  const Form<T>& SquaredNorm()
  {
    const Form<T>& first = this->Normals[0];
    this->Result.Clear(this->ProductLayout(first, first));
    for (int c = 0; c < this->NumNormals(); ++c)
    {
      const Form<T>& n = this->Normals[static_cast<std::size_t>(c)];
      this->AddProduct(n, n, false, 0, this->Result);
    }
    return this->Result;
  }

  /// Power of the weight function below the numerator.
  int WeightPower() const { return this->Rational ? NumParameters(this->Shape) + 1 : 0; }
  /// The weight function to a power, as a form.
  const Form<T>& WeightToPower(int power)
  {
    this->Pick(this->Components, this->Degree, { 0, 0, 0 }, this->Left[0]);
    this->Result = this->Left[0];
    for (int k = 1; k < power; ++k)
    {
      this->Partial[0] = this->Result;
      this->Result.Clear(this->ProductLayout(this->Partial[0], this->Left[0]));
      this->AddProduct(this->Partial[0], this->Left[0], false, 0, this->Result);
    }
    return this->Result;
  }
  /// The same polynomial with a higher degree (every group's, by the amounts), as a form.
  void Elevate(const Form<T>& form, const CellDegree& target, Form<T>& out)
  {
    CellDegree difference{};
    for (std::size_t d = 0; d < 3; ++d)
    {
      difference[d] = target[d] - form.Layout->Degree[d];
    }
    const FormLayout& layout = this->Cache.Get(form.Layout->Shape, difference);
    Form<T>& ones = this->Left[0]; // the scaled coefficients of 1
    ones.Clear(layout);
    for (int i = 0; i < layout.Size; ++i)
    {
      ones.C[static_cast<std::size_t>(i)] = T{} + this->MultinomialOf(layout, i);
    }
    ones.Roundings = layout.MultinomialRoundings;
    if constexpr (HasErrors)
    {
      ones.Magnitude = T{} + 1.0;
    }
    out.Clear(this->Cache.Get(form.Layout->Shape, target));
    this->AddProduct(form, ones, false, 0, out);
  }

private:
  using Offset = std::array<int, 3>;

  const FormLayout& ProductLayout(const Form<T>& a, const Form<T>& b)
  {
    CellDegree degree = a.Layout->Degree;
    for (std::size_t d = 0; d < 3; ++d)
    {
      degree[d] += b.Layout->Degree[d];
    }
    return this->Cache.Get(this->Shape, degree);
  }

  static auto MultinomialOf(const FormLayout& layout, int i)
  {
    if constexpr (HasErrors)
    {
      return layout.Multinomials[static_cast<std::size_t>(i)];
    }
    else
    {
      return T::Multinomial(layout, i);
    }
  }

  /// Control points of a sub-net of the given degree, shifted by an offset: a derivative by slots
  /// up to a factor.
  void Pick(int plane, const CellDegree& degree, const Offset& offset, Form<T>& out)
  {
    const FormLayout& layout = this->Cache.Get(this->Shape, degree);
    out.Clear(layout);
    const T* p = this->Planes[static_cast<std::size_t>(plane)];
    for (const FormLayout::Row& row : layout.Rows)
    {
      const T* from = p + this->Layout->Index(offset[0], row.J + offset[1], row.K + offset[2]);
      for (int i = 0; i < row.Length; ++i)
      {
        const std::size_t at = static_cast<std::size_t>(row.Start + i);
        if constexpr (HasErrors)
        {
          out.Magnitude = Larger(out.Magnitude, Magnitude(from[i]));
        }
        out.C[at] = from[i] * this->MultinomialOf(layout, row.Start + i);
      }
    }
    out.Absolute = this->Absolute[static_cast<std::size_t>(plane)];
    out.Roundings = 1 + layout.MultinomialRoundings;
  }

  /// First differences along a direction: the derivative but for the factor degree.
  void Difference(int plane, int direction, Form<T>& out)
  {
    const FormLayout& layout =
      this->Cache.Get(this->Shape, ChangedDegree(this->Shape, this->Degree, direction, -1));
    out.Clear(layout);
    const T* p = this->Planes[static_cast<std::size_t>(plane)];
    for (const FormLayout::Row& row : layout.Rows)
    {
      const T* from = p + this->Layout->Index(0, row.J, row.K);
      const T* to =
        p + this->Layout->Index(direction == 0, row.J + (direction == 1), row.K + (direction == 2));
      for (int i = 0; i < row.Length; ++i)
      {
        const T difference = to[i] - from[i];
        if constexpr (HasErrors)
        {
          out.Magnitude = Larger(out.Magnitude, Magnitude(difference));
        }
        out.C[static_cast<std::size_t>(row.Start + i)] =
          difference * this->MultinomialOf(layout, row.Start + i);
      }
    }
    if constexpr (HasErrors)
    {
      out.Absolute = this->Absolute[static_cast<std::size_t>(plane)] * 2.0;
    }
    out.Roundings = 2 + layout.MultinomialRoundings;
  }

  /// out += a b, or -=, times the slot whose parameter is `shift - 1` when shift > 0.
  void AddProduct(const Form<T>& a, const Form<T>& b, bool subtract, int shift, Form<T>& out)
  {
    const int si = shift == 1;
    const int sj = shift == 2;
    const int sk = shift == 3;
    for (const FormLayout::Row& rowA : a.Layout->Rows)
    {
      for (const FormLayout::Row& rowB : b.Layout->Rows)
      {
        T* to = out.C.data() + out.Layout->Index(si, rowA.J + rowB.J + sj, rowA.K + rowB.K + sk);
        const T* pa = a.C.data() + rowA.Start;
        const T* pb = b.C.data() + rowB.Start;
        for (int i = 0; i < rowA.Length; ++i)
        {
          for (int j = 0; j < rowB.Length; ++j)
          {
            if (subtract)
            {
              to[i + j] -= pa[i] * pb[j];
            }
            else
            {
              to[i + j] += pa[i] * pb[j];
            }
          }
        }
      }
    }
    if constexpr (HasErrors)
    {
      out.Roundings = std::max(out.Roundings, a.Roundings + b.Roundings + 1) +
        std::min(a.Layout->Size, b.Layout->Size);
      out.Magnitude = out.Magnitude + a.Magnitude * b.Magnitude;
      out.Absolute = out.Absolute + a.Magnitude * b.Absolute + b.Magnitude * a.Absolute +
        a.Absolute * b.Absolute;
    }
  }

  void Multiply(double factor, Form<T>& form)
  {
    for (T& c : form.C)
    {
      c = c * factor;
    }
    if constexpr (HasErrors)
    {
      form.Magnitude = form.Magnitude * factor;
      form.Absolute = form.Absolute * factor;
    }
    form.Roundings += 1;
  }

  /// out = b x c . of three-vectors of forms, component k: b_i c_j - b_j c_i.
  void CrossComponent(
    const Form<T>& bi, const Form<T>& bj, const Form<T>& ci, const Form<T>& cj, Form<T>& out)
  {
    out.Clear(this->ProductLayout(bi, cj));
    this->AddProduct(bi, cj, false, 0, out);
    this->AddProduct(bj, ci, true, 0, out);
  }

  /// Numerator of the determinant of components a and b with respect to the first two parameters;
  /// c is the plane of the weights. Degree (2p - 1, 2q - 1), rational (3p - 2, 3q - 2); in the
  /// triangle 2 (p - 1), rational 3 (p - 1).
  ///
  /// Rational quadrilateral: at a point the map has the same first derivatives as the bilinear
  /// patch of the four points A, B, C, E that all but one de Casteljau step in each direction
  /// leave. For that patch
  ///   X ^ X_u ^ X_v = u [v0 A + v1 C, B, E] - (1 - u) [A, C, v0 B + v1 E]
  /// because (v0 A + v1 C) ^ (C - A) = A ^ C when v0 + v1 = 1; this is of degree 3p - 2, not 3p
  /// - 1.
  void PlanarMinor(int a, int b, int c, Form<T>& out)
  {
    const CellDegree lower0 = ChangedDegree(this->Shape, this->Degree, 0, -1);
    const double p = this->Degree[0];
    const double q = this->Degree[1];
    if (!this->Rational)
    {
      this->Difference(a, 0, this->Left[0]);
      this->Difference(b, 0, this->Left[1]);
      this->Difference(a, 1, this->Right[0]);
      this->Difference(b, 1, this->Right[1]);
      this->CrossComponent(this->Left[0], this->Left[1], this->Right[0], this->Right[1], out);
    }
    else if (GroupOfDirection(this->Shape, 1) == 0)
    {
      this->TripleProduct({ a, b, c }, lower0, { 0, 0, 0 }, lower0, { 1, 0, 0 }, lower0,
        { 0, 1, 0 }, 0, false, out, true);
    }
    else
    {
      const CellDegree both = ChangedDegree(this->Shape, lower0, 1, -1);
      this->TripleProduct({ a, b, c }, lower0, { 0, 0, 0 }, both, { 1, 0, 0 }, both, { 1, 1, 0 }, 1,
        false, out, true);
      this->TripleProduct({ a, b, c }, lower0, { 1, 0, 0 }, both, { 0, 0, 0 }, both, { 0, 1, 0 }, 0,
        true, out, false);
    }
    this->Multiply(p * q, out);
  }

  /// out += or -= [first, second, third], each a sub-net of the three planes; times parameter
  /// shift - 1.
  void TripleProduct(const std::array<int, 3>& planes, const CellDegree& degree0, const Offset& o0,
    const CellDegree& degree1, const Offset& o1, const CellDegree& degree2, const Offset& o2,
    int shift, bool subtract, Form<T>& out, bool clear)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      this->Pick(planes[k], degree1, o1, this->Left[k]);
      this->Pick(planes[k], degree2, o2, this->Right[k]);
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t i = (k + 1) % 3;
      const std::size_t j = (k + 2) % 3;
      this->CrossComponent(
        this->Left[i], this->Left[j], this->Right[i], this->Right[j], this->Cross);
      this->Pick(planes[k], degree0, o0, this->Third);
      if (clear && k == 0)
      {
        CellDegree degree = this->ProductLayout(this->Cross, this->Third).Degree;
        degree[0] += GroupOfDirection(this->Shape, 1) != 0 ? 1 : 0; // room for the shift
        out.Clear(this->Cache.Get(this->Shape, degree));
      }
      this->AddProduct(this->Cross, this->Third, subtract, shift, out);
    }
  }

  /// Polynomial volumes: degree 3p - 1 per direction; tetrahedron 3 (p - 1); wedge (3p - 2, 3q -
  /// 1).
  void SpatialDeterminant()
  {
    for (int k = 0; k < 3; ++k)
    {
      this->Difference(k, 0, this->Left[static_cast<std::size_t>(k)]);
      this->Difference(k, 1, this->Right[static_cast<std::size_t>(k)]);
    }
    for (std::size_t k = 0; k < 3; ++k)
    {
      const std::size_t i = (k + 1) % 3;
      const std::size_t j = (k + 2) % 3;
      this->CrossComponent(
        this->Left[i], this->Left[j], this->Right[i], this->Right[j], this->Cross);
      this->Difference(static_cast<int>(k), 2, this->Third);
      if (k == 0)
      {
        this->Result.Clear(this->ProductLayout(this->Cross, this->Third));
      }
      this->AddProduct(this->Cross, this->Third, false, 0, this->Result);
    }
    this->Multiply(this->DegreeProduct(), this->Result);
  }

  double DegreeProduct() const
  {
    return static_cast<double>(this->Degree[0] * this->Degree[1] * this->Degree[2]);
  }

  /// Rational volumes: det J = -[X, X_u, X_v, X_w] / W^4, expanded along X_w; degree 4p - 2 per
  /// direction, tetrahedron 4 (p - 1), wedge (4p - 3, 4q - 2). The expansion is minimal in the
  /// first two parameters; in the third its degree falls by one through division by the sum of the
  /// slots.
  void RationalSpatialDeterminant()
  {
    const CellDegree lower = ChangedDegree(this->Shape, this->Degree, 0, -1);
    const bool tetrahedron = this->Shape == CellShape::Tetrahedron;
    Form<T> total;
    Form<T> minor;
    for (int k = 0; k < 4; ++k)
    {
      std::array<int, 3> others{};
      for (int c = 0, at = 0; c < 4; ++c)
      {
        if (c != k)
        {
          others[static_cast<std::size_t>(at++)] = c;
        }
      }
      if (tetrahedron)
      {
        this->TripleProduct(others, lower, { 0, 0, 0 }, lower, { 1, 0, 0 }, lower, { 0, 1, 0 }, 0,
          false, minor, true);
        this->Pick(k, lower, { 0, 0, 1 }, this->Third);
      }
      else
      {
        this->PlanarMinor(others[0], others[1], others[2], minor);
        this->Difference(k, 2, this->Third);
      }
      if (k == 0)
      {
        total.Clear(this->ProductLayout(minor, this->Third));
      }
      this->AddProduct(minor, this->Third, k % 2 == 1, 0, total);
    }
    if (tetrahedron)
    {
      this->Result = std::move(total);
      this->Multiply(this->DegreeProduct(), this->Result);
      return;
    }
    this->Multiply(this->Degree[2], total);
    this->DivideBySlotSum(total, this->Result);
  }

  /// Quotient by the sum of the two slots of the third parameter, from both ends to the middle:
  /// with n the degree, coefficient i of the quotient is an alternating sum of the first i + 1
  /// scaled coefficients (or of the last n - i), whose binomials sum to at most about 4 times its
  /// own.
  void DivideBySlotSum(const Form<T>& form, Form<T>& out)
  {
    const FormLayout& from = *form.Layout;
    const int n = from.Degree[2];
    const FormLayout& to =
      this->Cache.Get(this->Shape, ChangedDegree(this->Shape, from.Degree, 2, -1));
    out.Clear(to);
    const std::size_t layer = static_cast<std::size_t>(from.Size / (n + 1));
    for (std::size_t s = 0; s < layer; ++s)
    {
      const auto at = [&](int k) { return static_cast<std::size_t>(k) * layer + s; };
      for (int k = 0; 2 * k < n; ++k)
      {
        out.C[at(k)] = form.C[at(k)];
        if (k > 0)
        {
          out.C[at(k)] -= out.C[at(k - 1)];
        }
      }
      for (int k = n - 1; 2 * k >= n; --k)
      {
        out.C[at(k)] = form.C[at(k + 1)];
        if (k + 1 < n)
        {
          out.C[at(k)] -= out.C[at(k + 1)];
        }
      }
    }
    if constexpr (HasErrors)
    {
      const FormLayout& line = this->Cache.Get(CellShape::Curve, { n, 0, 0 });
      const FormLayout& shorter = this->Cache.Get(CellShape::Curve, { n - 1, 0, 0 });
      double growth = 1.0;
      double sum = 0.0;
      for (int i = 0; 2 * i <= n; ++i)
      {
        sum += line.Multinomials[static_cast<std::size_t>(i)];
        growth =
          std::max(growth, i < n ? sum / shorter.Multinomials[static_cast<std::size_t>(i)] : 1.0);
      }
      out.Magnitude = form.Magnitude * (growth * (1.0 + 0x1p-40));
      out.Absolute = form.Absolute * (growth * (1.0 + 0x1p-40));
      out.Roundings = form.Roundings + n;
    }
  }

  /// Numerator of a component of C_u: degree p - 1, rational 2p - 2 over W^2.
  void Tangent(int component, Form<T>& out)
  {
    if (!this->Rational)
    {
      this->Difference(component, 0, out);
    }
    else
    {
      const CellDegree lower = ChangedDegree(this->Shape, this->Degree, 0, -1);
      const int w = this->Components;
      this->Pick(w, lower, { 0, 0, 0 }, this->Left[0]);
      this->Pick(component, lower, { 0, 0, 0 }, this->Left[1]);
      this->Pick(w, lower, { 1, 0, 0 }, this->Right[0]);
      this->Pick(component, lower, { 1, 0, 0 }, this->Right[1]);
      this->CrossComponent(this->Left[0], this->Left[1], this->Right[0], this->Right[1], out);
    }
    this->Multiply(this->Degree[0], out);
  }

  LayoutCache& Cache;
  CellShape Shape = CellShape::Curve;
  CellDegree Degree{};
  const FormLayout* Layout = nullptr;
  std::array<const T*, 4> Planes{};
  std::array<T, 4> Absolute{};
  int Components = 0;
  bool Rational = false;
  std::array<Form<T>, 3> Left;
  std::array<Form<T>, 3> Right;
  std::array<Form<T>, 2> Partial;
  std::array<Form<T>, 3> Normals;
  Form<T> Cross;
  Form<T> Third;
  Form<T> Result;
};
}
