// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FormLayout.h"
#include "JacobianCertificate.h"

/// Private to the proof of cells: the geometry that is proved, with its sizes.
namespace knotwork
{
/// A cell by itself. A surface in a plane x, y or z = const is a planar map: Flat.
struct ProofCell
{
  ProofCell(
    const BernsteinCells& cells, int cell, const JacobianParams& params, LayoutCache& cache);

  int Size() const { return this->Layout->Size; }
  const double* Plane(int c) const { return this->Block.data() + c * this->Size(); }
  double Remainder(int c, int i) const
  {
    return this->Remainders.empty()
      ? 0.0
      : this->Remainders[static_cast<std::size_t>(c * this->Size() + i)];
  }
  /// The weights are positive whatever the errors are.
  bool HasWeights() const;
  /// Of a rational cell: the numerator at a corner over the Jacobian of the map that has the same
  /// control points and no weights (its square when the numerator is squared). det J is that times
  /// the product of w_d / w, the weights of the corner's neighbours over its own.
  /// @param power  of the weight function below the numerator.
  double CornerScale(int corner, int power) const;

  int Number;
  CellShape Shape = CellShape::Curve;
  CellDegree Degree{};
  const FormLayout* Layout = nullptr;
  int Components = 0;
  bool Rational = false;
  double Given = 0.0; ///< what Block + Remainders may be off by
  std::vector<double> Block;
  std::vector<double> Remainders; ///< empty: none
  bool Norm = false;              ///< more components than parameters: numerators are squares
  bool Flat = false;
  double CollapseTolerance; ///< JacobianParams, and what it means here:
  double PointTolerance = 0.0;
  double GivenTolerance = 0.0; ///< PointTolerance for homogeneous coefficients
  double ValueTolerance = 0.0; ///< of the Jacobian at a corner

private:
  void DropConstantComponent();
  bool IsConstant(int c) const;
  void MeasureNet();
};
}
