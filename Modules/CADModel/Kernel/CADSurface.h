// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Geom_BSplineSurface.hxx>
#include <TopoDS_Face.hxx>
#include <gp_XY.hxx>

#include <array>

namespace knotwork
{
/// The B-spline surface of a face and how parameters of the face's own surface go over to it. May
/// throw OpenCASCADE's exceptions.
class CADSurface
{
public:
  explicit CADSurface(const TopoDS_Face& face);

  const opencascade::handle<Geom_BSplineSurface>& Surface() const { return this->To; }
  /// Parameters of the same point, within the domain.
  gp_XY Map(const gp_XY& parameters) const;
  /// Whether Map only keeps parameters within the domain.
  bool IsIdentity() const
  {
    return this->Kind == Transfer::Identity && this->Shift.SquareModulus() == 0.0;
  }

private:
  enum class Transfer
  {
    Identity,
    Separate, ///< the new u depends on u alone, the new v on v
    General
  };
  gp_XY Invert(const gp_XY& parameters, const gp_XY& guess) const;
  gp_XY MapAs(Transfer kind, const gp_XY& parameters) const;
  /// @param u, v  of From, the face's.
  double WorstResidual(
    Transfer kind, const std::array<double, 2>& u, const std::array<double, 2>& v) const;

  opencascade::handle<Geom_Surface> From;
  opencascade::handle<Geom_BSplineSurface> To;
  double Lower[2] = { 0.0, 0.0 }; ///< of To
  double Upper[2] = { 0.0, 0.0 };
  double Size = 0.0;
  gp_XY Shift{ 0.0, 0.0 }; ///< by periods of From
  Transfer Kind = Transfer::Identity;
};
}
