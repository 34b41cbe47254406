// SPDX-License-Identifier: BSD-3-Clause
#include "DatumAlignment.h"

#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
namespace
{
constexpr double LeastSine = 0.05; ///< of the angle between directions that are not one
constexpr double LeastArm = 1e-3;  ///< of the size: what is nearer does not tell a direction

/// The place of the origin, one equation after the other: each moves it across those before.
class Origin
{
public:
  explicit Origin(const Eigen::Vector3d& start) : Place(start) {}

  /// @return whether it fixed anything.
  bool Add(const Eigen::Vector3d& direction, const Eigen::Vector3d& point)
  {
    Eigen::Vector3d across = direction;
    for (const Eigen::Vector3d& fixed : this->Fixed)
    {
      across -= fixed * fixed.dot(across);
    }
    if (across.norm() < LeastSine || this->Fixed.size() == 3)
    {
      return false;
    }
    across.normalize();
    this->Place += across * (direction.dot(point - this->Place) / direction.dot(across));
    this->Fixed.push_back(across);
    return true;
  }
  bool Add(const AnalyticSurface& surface)
  {
    const std::size_t before = this->Fixed.size();
    switch (surface.Type)
    {
      case SurfaceType::Plane:
        this->Add(surface.Axis, surface.Point);
        break;
      case SurfaceType::Cylinder:
      case SurfaceType::Cone:
      case SurfaceType::Revolution:
      {
        const Eigen::Vector3d across = surface.Axis.unitOrthogonal();
        this->Add(across, surface.Point);
        this->Add(surface.Axis.cross(across), surface.Point);
        break;
      }
      case SurfaceType::Sphere:
      case SurfaceType::Torus:
        for (int d = 0; d < 3; ++d)
        {
          this->Add(Eigen::Vector3d::Unit(d), surface.Point);
        }
        break;
      case SurfaceType::FreeForm:
      case SurfaceType::Extrusion:
        break;
    }
    return this->Fixed.size() > before;
  }
  int NumFree() const { return 3 - static_cast<int>(this->Fixed.size()); }

  Eigen::Vector3d Place;

private:
  std::vector<Eigen::Vector3d> Fixed;
};

Eigen::Vector3d MiddleOf(const TriangleMesh& mesh)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double areas = 0.0;
  for (const auto& triangle : mesh.Triangles)
  {
    const double area = TriangleArea(mesh.Points, triangle);
    areas += area;
    for (const int corner : triangle)
    {
      sum += area / 3.0 * mesh.Points.row(corner).transpose();
    }
  }
  return areas > 0.0 ? Eigen::Vector3d(sum / areas) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// An axis in the sense in which its largest coordinate is positive.
Eigen::Vector3d Positive(const Eigen::Vector3d& axis)
{
  Eigen::Index largest;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0.0 ? Eigen::Vector3d(-axis) : axis;
}

class Datums
{
public:
  Datums(const TriangleMesh& mesh, const std::vector<RecognizedRegion>& regions,
    const DatumParams& params)
    : Mesh(mesh), Regions(regions), Params(params)
  {
  }

  Result<DatumAlignment> Run() const
  {
    if (Status status = this->Check(); !status)
    {
      return status;
    }
    const RecognizedRegion* const plane = this->Find(this->Params.Plane);
    const RecognizedRegion* const axis = this->Find(this->Params.Axis);
    const Eigen::Vector3d z = this->DirectionOf(plane ? *plane : *axis);
    Origin origin(MiddleOf(this->Mesh));
    for (const int region : this->Params.Point)
    {
      if (!origin.Add(this->Find(region)->Surface))
      {
        return { ErrorCode::InvalidParameter,
          "region " + std::to_string(region) +
            " of the datum point fixes nothing that those before it leave free: leave it out, or "
            "give one across them" };
      }
    }
    if (plane)
    {
      origin.Add(plane->Surface);
    }
    if (axis)
    {
      origin.Add(axis->Surface);
    }
    DatumAlignment found;
    found.FreeMotions = origin.NumFree();
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    if (plane && axis)
    {
      const Eigen::Vector3d direction = this->DirectionOf(*axis);
      x = direction - z * z.dot(direction);
      if (x.norm() < LeastSine && axis->Surface.Type == SurfaceType::Plane)
      {
        return { ErrorCode::InvalidParameter,
          "the planes " + std::to_string(this->Params.Plane) + " and " +
            std::to_string(this->Params.Axis) +
            " are parallel: give a second plane, or an axis, that is not" };
      }
      if (x.norm() < LeastSine)
      {
        const Eigen::Vector3d arm = axis->Surface.Point - origin.Place;
        x = arm - z * z.dot(arm);
        const double size =
          (this->Mesh.Points.colwise().maxCoeff() - this->Mesh.Points.colwise().minCoeff()).norm();
        x = x.norm() < LeastArm * size ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : x;
      }
    }
    if (x.isZero())
    {
      ++found.FreeMotions;
      // the first of the old axes that is not along z
      for (int d = 0; d < 3 && x.norm() < 0.5; ++d)
      {
        x = Eigen::Vector3d::Unit(d) - z * z[d];
      }
    }
    x.normalize();
    found.Motion.Rotation.row(0) = x.transpose();
    found.Motion.Rotation.row(1) = z.cross(x).transpose();
    found.Motion.Rotation.row(2) = z.transpose();
    found.Motion.Translation = -(found.Motion.Rotation * origin.Place);
    return found;
  }

private:
  const RecognizedRegion* Find(int region) const
  {
    return region < 0 ? nullptr : &this->Regions[static_cast<std::size_t>(region)];
  }

  Eigen::Vector3d DirectionOf(const RecognizedRegion& region) const
  {
    if (region.Surface.Type != SurfaceType::Plane)
    {
      return Positive(region.Surface.Axis);
    }
    return region.Reversed != this->Params.Inward ? Eigen::Vector3d(-region.Surface.Axis)
                                                  : region.Surface.Axis;
  }

  Status CheckRegion(int region, const char* what, std::initializer_list<SurfaceType> types) const
  {
    if (region < 0 || region >= static_cast<int>(this->Regions.size()))
    {
      return { ErrorCode::InvalidParameter,
        std::string("the datum ") + what + " is region " + std::to_string(region) +
          ", but there are " + std::to_string(this->Regions.size()) +
          ", from 0 on: recognize shows their numbers" };
    }
    const SurfaceType type = this->Find(region)->Surface.Type;
    std::string allowed;
    for (const SurfaceType each : types)
    {
      if (each == type)
      {
        return {};
      }
      allowed += (allowed.empty() ? "" : ", ") + std::string(ToString(each));
    }
    return { ErrorCode::InvalidParameter,
      std::string("the datum ") + what + " is region " + std::to_string(region) + ", a " +
        ToString(type) + ": give one of these types: " + allowed };
  }

  Status Check() const
  {
    const DatumParams& params = this->Params;
    if (params.Plane == -1 && params.Axis == -1)
    {
      return { ErrorCode::InvalidParameter, "give the region of a datum plane, or of an axis" };
    }
    if (params.Point.size() > 3)
    {
      return { ErrorCode::InvalidParameter, "at most three regions make a datum point" };
    }
    Status status;
    if (params.Plane != -1)
    {
      status = this->CheckRegion(params.Plane, "plane", { SurfaceType::Plane });
    }
    if (status && params.Axis != -1)
    {
      status = this->CheckRegion(params.Axis, "axis",
        { SurfaceType::Plane, SurfaceType::Cylinder, SurfaceType::Cone, SurfaceType::Torus });
    }
    for (const int region : params.Point)
    {
      status = status ? this->CheckRegion(region, "point",
                          { SurfaceType::Plane, SurfaceType::Cylinder, SurfaceType::Sphere,
                            SurfaceType::Cone, SurfaceType::Torus })
                      : status;
    }
    return status;
  }

  const TriangleMesh& Mesh;
  const std::vector<RecognizedRegion>& Regions;
  const DatumParams& Params;
};
}

Result<DatumAlignment> AlignToDatums(
  const TriangleMesh& mesh, const std::vector<RecognizedRegion>& regions, const DatumParams& params)
{
  return Datums(mesh, regions, params).Run();
}
}
