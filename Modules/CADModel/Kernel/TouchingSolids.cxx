// SPDX-License-Identifier: BSD-3-Clause
#include "CADSession.h"
#include "CADTopologyShapes.h"

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <Bnd_Box.hxx>
#include <ShapeAnalysis_Surface.hxx>

#include <optional>

namespace knotwork
{
namespace
{
/// A place of a face that is not on its outline.
struct ContactPlace
{
  gp_Pnt Point;
  Eigen::Vector3d Normal; ///< of the surface, unit length
};

/// Places on a face of a solid, and whether others' lie on it.
class ContactFace
{
public:
  ContactFace(const TopologyFaceShape& shape, bool reversed, int body, double tolerance)
    : Body(body), Shape(shape), Reversed(reversed), Tolerance(tolerance)
  {
    BRepBndLib::Add(shape.Face, this->Box, false);
    this->Box.Enlarge(tolerance);
  }

  const std::vector<ContactPlace>& Places()
  {
    if (!this->Sampled)
    {
      this->Sampled.emplace();
      this->Sample();
    }
    return *this->Sampled;
  }

  bool Touches(const ContactPlace& place)
  {
    constexpr double Opposite = -0.999; ///< cosine
    if (this->Box.IsOut(place.Point))
    {
      return false;
    }
    if (this->Surface.IsNull())
    {
      this->Surface = new ShapeAnalysis_Surface(this->Shape.Surface);
    }
    const gp_Pnt2d there = this->Surface->ValueOfUV(place.Point, this->Tolerance);
    return this->Surface->Value(there).Distance(place.Point) <= this->Tolerance &&
      this->IsInside(there) && this->PlaceAt(there).Normal.dot(place.Normal) < Opposite;
  }

  int Body;
  Bnd_Box Box;

private:
  static constexpr int Count = 8; ///< places in a direction

  bool IsInside(const gp_Pnt2d& parameters)
  {
    if (!this->Outline)
    {
      this->Outline = std::make_unique<BRepTopAdaptor_FClass2d>(this->Shape.Face, this->Tolerance);
    }
    return this->Outline->Perform(parameters) == TopAbs_IN;
  }

  ContactPlace PlaceAt(const gp_Pnt2d& parameters) const
  {
    ContactPlace place;
    gp_Vec du;
    gp_Vec dv;
    this->Shape.Adaptor->D1(parameters.X(), parameters.Y(), place.Point, du, dv);
    const Eigen::Vector3d normal = ToEigen(du).cross(ToEigen(dv));
    place.Normal = normal.stableNormalized() * (this->Reversed ? -1.0 : 1.0);
    return place;
  }

  void Sample()
  {
    std::array<double, 2> lower{};
    std::array<double, 2> upper{};
    BRepTools::UVBounds(this->Shape.Face, lower[0], upper[0], lower[1], upper[1]);
    for (int i = 0; i < Count * Count; ++i)
    {
      const double u = (i % Count + 0.5) / Count;
      const double v = (i / Count + 0.5) / Count; // NOLINT(bugprone-integer-division): a row
      const gp_Pnt2d at((1.0 - u) * lower[0] + u * upper[0], (1.0 - v) * lower[1] + v * upper[1]);
      if (this->IsInside(at))
      {
        this->Sampled->push_back(this->PlaceAt(at));
      }
    }
  }

  const TopologyFaceShape& Shape;
  bool Reversed;
  double Tolerance;
  std::optional<std::vector<ContactPlace>> Sampled;
  std::unique_ptr<BRepTopAdaptor_FClass2d> Outline;
  Handle(ShapeAnalysis_Surface) Surface;
};

bool Touch(ContactFace& a, ContactFace& b)
{
  const auto hasPlaceOn = [](ContactFace& one, ContactFace& other)
  {
    const std::vector<ContactPlace>& places = one.Places();
    return std::any_of(places.begin(), places.end(),
      [&](const ContactPlace& place) { return other.Touches(place); });
  };
  return hasPlaceOn(a, b) || hasPlaceOn(b, a);
}
}

Result<std::vector<std::array<int, 2>>> CADTopology::TouchingSolids() const
{
  std::set<std::array<int, 2>> pairs;
  CADSession session(LengthUnit::Millimetre);
  const Status status = session.Run("contacts of solids",
    [&]() -> Status
    {
      pairs = this->Impl->FindContacts(*this);
      return {};
    });
  return status ? Result<std::vector<std::array<int, 2>>>({ pairs.begin(), pairs.end() })
                : Result<std::vector<std::array<int, 2>>>(status);
}

std::set<std::array<int, 2>> CADTopology::Shapes::FindContacts(const CADTopology& model) const
{
  constexpr double Nearness = 1e-6; ///< of the diagonal
  std::vector<ContactFace> faces;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const CADTopologyFace& face = model.Faces[f];
    if (face.Bodies.size() > 1 ||
      !model.Bodies[static_cast<std::size_t>(face.Bodies.front())].IsSolid)
    {
      continue;
    }
    const TopologyFaceShape& shape = this->Faces[f];
    const auto add = [&](const TopologyFaceShape& one, bool reversed)
    { faces.emplace_back(one, reversed, face.Bodies.front(), Nearness * model.Diagonal); };
    for (std::size_t i = 0; shape.Joined && i < shape.Joined->Faces.size(); ++i)
    {
      add(shape.Joined->Faces[i], shape.Joined->Reversed[i]);
    }
    if (!shape.Joined)
    {
      add(shape, face.Reversed);
    }
  }
  std::set<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      const std::array<int, 2> pair{ std::min(faces[i].Body, faces[j].Body),
        std::max(faces[i].Body, faces[j].Body) };
      if (pair[0] != pair[1] && pairs.count(pair) == 0 && !faces[i].Box.IsOut(faces[j].Box) &&
        Touch(faces[i], faces[j]))
      {
        pairs.insert(pair);
      }
    }
  }
  return pairs;
}
}
