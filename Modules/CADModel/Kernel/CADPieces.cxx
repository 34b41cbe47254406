// SPDX-License-Identifier: BSD-3-Clause
#include "CADPieces.h"

#include "EdgePlaces.h"
#include "LoadedDocument.h"
#include "ModelDocument.h"

#include <Eigen/Geometry>

#include <BRepAdaptor_Surface.hxx>
#include <gp_Ax1.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include <algorithm>
#include <cmath>
#include <optional>

namespace knotwork
{
namespace
{
using Eigen::Vector3d;

std::optional<gp_Ax1> AxisOf(const BRepAdaptor_Surface& surface)
{
  switch (surface.GetType())
  {
    case GeomAbs_Cylinder:
      return surface.Cylinder().Axis();
    case GeomAbs_Cone:
      return surface.Cone().Axis();
    case GeomAbs_Torus:
      return surface.Torus().Axis();
    default:
      return std::nullopt;
  }
}

CADOperation PlaneCut(const Vector3d& point, const Vector3d& normal)
{
  CADOperation cut;
  cut.Kind = CADOperationKind::CutByPlane;
  cut.Point = point;
  cut.Direction = normal;
  return cut;
}

/// Planes once, however their normals point.
class CutList
{
public:
  explicit CutList(double size) : Nearness(1e-7 * size) {}

  void Add(const CADOperation& cut)
  {
    const bool isKnown = cut.Kind == CADOperationKind::CutByPlane &&
      std::any_of(this->List.begin(), this->List.end(),
        [&](const CADOperation& known)
        {
          return known.Kind == CADOperationKind::CutByPlane &&
            known.Direction.cross(cut.Direction).norm() < 1e-9 &&
            std::abs(known.Direction.dot(cut.Point - known.Point)) < this->Nearness;
        });
    if (!isKnown)
    {
      this->List.push_back(cut);
    }
  }

  std::vector<CADOperation> List;

private:
  double Nearness;
};

void AddAxialPlanes(const std::vector<FacePlace>& faces, CutList& cuts)
{
  constexpr double Square = 1e-6; ///< cosine
  struct Axis
  {
    Vector3d Place;
    Vector3d Direction; ///< of a ball none
  };
  std::vector<Axis> axes;
  std::vector<Vector3d> directions;
  for (const FacePlace& place : faces)
  {
    const BRepAdaptor_Surface surface(place.Face, false);
    if (surface.GetType() == GeomAbs_Sphere)
    {
      axes.push_back({ ToVector(surface.Sphere().Location().XYZ()), Vector3d::Zero() });
    }
    else if (const auto axis = AxisOf(surface))
    {
      axes.push_back({ ToVector(axis->Location().XYZ()), ToVector(axis->Direction().XYZ()) });
      directions.push_back(axes.back().Direction);
    }
    else if (surface.GetType() == GeomAbs_Plane)
    {
      directions.push_back(ToVector(surface.Plane().Axis().Direction().XYZ()));
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    directions.push_back(Vector3d::Unit(i));
  }
  for (const Axis& axis : axes)
  {
    for (const Vector3d& direction : directions)
    {
      if (std::abs(direction.dot(axis.Direction)) < Square)
      {
        cuts.Add(PlaneCut(axis.Place, direction));
      }
    }
  }
}
}

Result<CADPieces> CADPieces::Read(const std::string& file, LengthUnit unit)
{
  CADPieces pieces;
  pieces.Place = "'" + file + "'";
  CADSession session(unit);
  const Status status = session.Run(pieces.Place,
    [&]() -> Status
    {
      LoadedDocument loaded;
      if (Status read = LoadDocument(session, file, unit, loaded); !read)
      {
        return read;
      }
      pieces.Bodies = std::make_shared<ModelBodies>(ModelDocument(loaded.Document).Take());
      return {};
    });
  return status ? Result<CADPieces>(std::move(pieces)) : Result<CADPieces>(status);
}

Result<CADTopology> CADPieces::Topology() const
{
  CADTopology model;
  CADSession session(LengthUnit::Millimetre);
  const Status status =
    session.Run(this->Place, [&] { return model.Build(*this->Bodies, this->Place); });
  return status ? Result<CADTopology>(std::move(model)) : Result<CADTopology>(status);
}

Result<std::vector<CADOperation>> CADPieces::Cuts() const
{
  constexpr double Smooth = 1.0 / 180.0 * 3.14159265358979323846; ///< edges that are not concave
  CADSession session(LengthUnit::Millimetre);
  const double size = SizeOf(*this->Bodies);
  CutList cuts(size);
  const Status status = session.Run(this->Place,
    [&]() -> Status
    {
      const std::vector<FacePlace> faces = FacesOf(*this->Bodies);
      const auto edges = EdgesOf(*this->Bodies, faces, Smooth, false);
      for (const CutTool& tool : CutTools(edges, faces, size))
      {
        const BRepAdaptor_Surface surface(faces[static_cast<std::size_t>(tool.Face)].Face, false);
        if (surface.GetType() == GeomAbs_Plane)
        {
          const gp_Ax1 axis = surface.Plane().Axis();
          cuts.Add(PlaneCut(ToVector(axis.Location().XYZ()), ToVector(axis.Direction().XYZ())));
          continue;
        }
        CADOperation cut;
        cut.Kind = CADOperationKind::CutByFace;
        cut.Tool = tool.Face;
        cuts.Add(cut);
      }
      AddAxialPlanes(faces, cuts);
      return {};
    });
  return status ? Result<std::vector<CADOperation>>(std::move(cuts.List))
                : Result<std::vector<CADOperation>>(status);
}

Result<CADPieces> CADPieces::Cut(const CADOperation& operation) const
{
  constexpr double MostVolume = 1e-6; ///< that a cut may change, a share
  ModelBodies cut = *this->Bodies;
  CADSession session(LengthUnit::Millimetre);
  const Status status = session.Run(this->Place,
    [&]() -> Status
    {
      CADStep step;
      if (Status done = RunOperation(operation, 1.0, cut, step); !done)
      {
        return { done.Code, this->Place + ": " + done.Detail };
      }
      return step.VolumeChange <= MostVolume
        ? Status()
        : Status{ ErrorCode::InvalidTopology, this->Place + ": the cut changes the volume" };
    });
  if (!status)
  {
    return status;
  }
  CADPieces pieces;
  pieces.Place = this->Place;
  pieces.Bodies = std::make_shared<ModelBodies>(std::move(cut));
  return pieces;
}
}
