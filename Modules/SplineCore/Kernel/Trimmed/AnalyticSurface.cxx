// SPDX-License-Identifier: BSD-3-Clause
#include "AnalyticSurface.h"
#include "SurfaceProfile.h"

#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
namespace
{
/// Cylindrical coordinates about an axis.
struct AroundAxis
{
  AroundAxis(const AnalyticSurface& surface, const Eigen::Vector3d& point)
  {
    const Eigen::Vector3d offset = point - surface.Point;
    this->Height = offset.dot(surface.Axis);
    this->Outward = offset - this->Height * surface.Axis;
    this->Radius = this->Outward.norm();
    if (this->Radius > 0.0)
    {
      this->Outward /= this->Radius;
    }
  }
  double Height;
  double Radius;
  Eigen::Vector3d Outward; ///< of length 1, or 0 on the axis
};
}

const char* ToString(SurfaceType type)
{
  switch (type)
  {
    case SurfaceType::Plane:
      return "plane";
    case SurfaceType::Cylinder:
      return "cylinder";
    case SurfaceType::Sphere:
      return "sphere";
    case SurfaceType::Cone:
      return "cone";
    case SurfaceType::Torus:
      return "torus";
    case SurfaceType::FreeForm:
      return "free form";
    case SurfaceType::Extrusion:
      return "extrusion";
    case SurfaceType::Revolution:
      return "revolution";
  }
  return "";
}

double AnalyticSurface::Distance(const Eigen::Vector3d& point) const
{
  const Eigen::Vector3d offset = point - this->Point;
  const double height = offset.dot(this->Axis);
  const auto outside = [&] { return (offset - height * this->Axis).norm() - this->Radius; };
  switch (this->Type)
  {
    case SurfaceType::Plane:
      return height;
    case SurfaceType::Cylinder:
      return outside();
    case SurfaceType::Sphere:
      return offset.norm() - this->Radius;
    case SurfaceType::Cone:
      return outside() * std::cos(this->Angle) - height * std::sin(this->Angle);
    case SurfaceType::Torus:
      return Eigen::Vector2d(outside(), height).norm() - this->MinorRadius;
    case SurfaceType::Extrusion:
    case SurfaceType::Revolution:
      return this->Profile->Distance(this->InProfile(point));
    case SurfaceType::FreeForm:
      break;
  }
  return 0.0;
}

Eigen::Vector3d AnalyticSurface::Normal(const Eigen::Vector3d& point) const
{
  const AroundAxis at(*this, point);
  switch (this->Type)
  {
    case SurfaceType::Plane:
      return this->Axis;
    case SurfaceType::Cylinder:
      return at.Outward;
    case SurfaceType::Sphere:
      return (point - this->Point).normalized();
    case SurfaceType::Cone:
      return at.Radius > 0.0
        ? Eigen::Vector3d(std::cos(this->Angle) * at.Outward - std::sin(this->Angle) * this->Axis)
        : Eigen::Vector3d(Eigen::Vector3d::Zero());
    case SurfaceType::Torus:
      return ((at.Radius - this->Radius) * at.Outward + at.Height * this->Axis).normalized();
    case SurfaceType::Extrusion:
    {
      const Eigen::Vector2d normal = this->Profile->Normal(this->InProfile(point));
      const Eigen::Vector3d& across = this->Profile->Across();
      return normal[0] * across + normal[1] * this->Axis.cross(across);
    }
    case SurfaceType::Revolution:
    {
      const Eigen::Vector2d normal = this->Profile->Normal({ at.Radius, at.Height });
      return normal[0] * at.Outward + normal[1] * this->Axis;
    }
    case SurfaceType::FreeForm:
      break;
  }
  return Eigen::Vector3d::Zero();
}
Eigen::Vector2d AnalyticSurface::InProfile(const Eigen::Vector3d& point) const
{
  if (this->Type == SurfaceType::Revolution)
  {
    const AroundAxis at(*this, point);
    return { at.Radius, at.Height };
  }
  const Eigen::Vector3d offset = point - this->Point;
  const Eigen::Vector3d& across = this->Profile->Across();
  return { offset.dot(across), offset.dot(this->Axis.cross(across)) };
}
}
