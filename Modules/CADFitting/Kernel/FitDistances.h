// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Distances in the unit of the points; -1: not measured.
struct DistanceSummary
{
  double Largest = -1.0;
  double RootMeanSquare = -1.0;
  std::array<double, 3> Place{}; ///< of the largest
};

/// What lies on one face or curve of a target.
struct EntityDistance
{
  TargetPart Part;
  int Count = 0; ///< elements, or edges of elements
  DistanceSummary Distance;
};

struct FitDistances
{
  DistanceSummary ToTarget;       ///< of the spline's surface: elements' parameters weigh alike
  DistanceSummary FromTarget;     ///< of the target's surface from the spline's, by area
  DistanceSummary MeshToTarget;   ///< the same of the mesh that was given, bilinear
  DistanceSummary MeshFromTarget; ///< of the target from its quadrilaterals, as two triangles
  std::vector<EntityDistance> Entities;
  std::vector<double> OfElements; ///< largest of every element of the surface
  TargetSamples Samples;          ///< of the target
  Eigen::VectorXd OfSamples;      ///< their distances from the spline
};
}
