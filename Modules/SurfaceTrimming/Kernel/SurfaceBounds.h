// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BezierForm.h>

/// Private to FitLoops: bounds of a surface's derivatives, to bound what curves on it do.
namespace knotwork
{
/// Of the lengths of derivatives with respect to the parameters.
struct DerivativeBounds
{
  double U = 0.0;
  double V = 0.0;
  double UU = 0.0;
  double UV = 0.0;
  double VV = 0.0;
  bool IsSmooth = true; ///< first derivatives are continuous, so the second ones count

  void Merge(const DerivativeBounds& other);
};

class SurfaceBounds
{
public:
  /// @pre surface.Check() is Ok; polynomial, tensor product.
  /// @complexity O((p + 1)^2) an element.
  explicit SurfaceBounds(const Spline<2>& surface, int threads = 0);

  const BezierForm<2>& Form() const { return this->Bezier; }
  const ParametricBox<2>& Domain() const { return this->Box; }
  /// Over the whole surface.
  const DerivativeBounds& Everywhere() const { return this->Total; }
  /// Over a box of parameters; false (and Everywhere) when it meets too many elements.
  bool Over(const ParametricBox<2>& box, DerivativeBounds& bounds) const;

  /// Elements that a curve inside a box may meet, when it runs straight.
  int ElementsAcross(const ParametricBox<2>& box) const;

private:
  BezierForm<2> Bezier;
  ParametricBox<2> Box;
  std::array<std::vector<bool>, 2> Creases; ///< whether derivatives jump at a break
  std::vector<DerivativeBounds> Elements;
  DerivativeBounds Total;
};
}
