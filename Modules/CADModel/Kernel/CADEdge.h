// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADSurface.h"
#include <knotwork/SplineCore/Spline.h>

#include <Geom2d_Curve.hxx>
#include <TopoDS_Edge.hxx>

namespace knotwork
{
/// A pcurve of an edge on a face.
struct CADPcurve
{
  opencascade::handle<Geom2d_Curve> Curve; ///< in the parameters of the face's own surface
  double First = 0.0;
  double Last = 1.0;
  const CADSurface* Surface = nullptr;
  PointMatrix UV; ///< result: control points in the edge's space, parameters of Surface->Surface()
};

struct CADEdge
{
  Spline<1> Curve;
  bool Refitted = false;
  double Deviation = 0.0; ///< of refitting, found at samples
};

/// Brings the curve of an edge and all its pcurves to one spline space: exactly where they have one
/// in common (that of the curve, with the pcurves' knots, or of one degree more), else as cubics
/// that agree within the tolerance. May throw OpenCASCADE's exceptions.
/// @param uses  at least one; an edge without a curve in space takes the image of the first.
/// @return NotConverged when the tolerance is out of reach; failures of knot vectors.
Result<CADEdge> UnifyEdge(const TopoDS_Edge& edge, std::vector<CADPcurve>& uses, double tolerance);
}
