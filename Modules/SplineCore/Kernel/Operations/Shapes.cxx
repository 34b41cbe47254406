// SPDX-License-Identifier: BSD-3-Clause
#include "Shapes.h"

#include "Numbers.h"

#include "Bernstein.h"
#include "TensorSpace.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

/// Control net in homogeneous coordinates (wx, wy, wz, w), first direction fastest.
template <int Dim>
struct Net
{
  std::array<KnotVector, Dim> Knots;
  PointMatrix Points;
};
using Curve = Net<1>;
using Surface = Net<2>;
using Volume = Net<3>;

/// A net with, for every direction, the number of ShapeParams::Elements that applies.
struct Patch
{
  std::variant<Curve, Surface, Volume> Shape;
  std::array<int, 3> Roles{ 0, 1, 2 };
};

/// Cosine and sine of an angle in degrees, exact at multiples of 90 and symmetric about 45.
std::array<double, 2> CosSin(double degrees)
{
  const double rest = std::remainder(degrees, 90.0);
  const double quarter = std::remainder(std::round((degrees - rest) / 90.0), 4.0);
  const double c = std::cos(rest * Pi / 180.0);
  const double s = std::sin(rest * Pi / 180.0);
  switch (static_cast<int>(quarter))
  {
    case 0:
      return { c, s };
    case 1:
      return { -s, c };
    case -1:
      return { s, -c };
    default:
      return { -c, -s };
  }
}

/// Arc of radius 1 about z: rational quadratic pieces of at most 90 degrees.
Curve UnitArc(double begin, double angle)
{
  const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / 90.0 - 1e-12)));
  const double half = angle / (2 * pieces);
  Curve arc{ { KnotVector::Uniform(2, pieces, 0.0, 1.0, 2) }, PointMatrix(2 * pieces + 1, 4) };
  for (int i = 0; i <= 2 * pieces; ++i)
  {
    const auto [c, s] = CosSin(begin + half * i);
    arc.Points.row(i) << c, s, 0.0, i % 2 ? CosSin(half)[0] : 1.0;
  }
  return arc;
}

/// Arcs of a row of sectors; neighbours' common ends are equal bit for bit.
Curve SectorArc(const ShapeParams& s, int sector)
{
  const double begin = s.Angle * sector / s.Sectors;
  const double end = s.Angle * (sector + 1) / s.Sectors;
  Curve arc = UnitArc(begin, end - begin);
  const auto [cosine, sine] = CosSin(end);
  arc.Points.bottomRows<1>() << cosine, sine, 0.0, 1.0;
  return arc;
}

Curve Scaled(Curve curve, double factor)
{
  curve.Points.leftCols<3>() *= factor;
  return curve;
}

/// Straight line in the knots of a curve; linear there because the weights are 1.
Curve LineLike(const Curve& curve, const Eigen::Vector3d& begin, const Eigen::Vector3d& end)
{
  Curve line{ curve.Knots, PointMatrix(curve.Points.rows(), 4) };
  for (int i = 0; i < line.Knots[0].NumFunctions(); ++i)
  {
    const double t = line.Knots[0].Greville(i);
    line.Points.row(i) << ((1 - t) * begin + t * end).transpose(), 1.0;
  }
  return line;
}

/// Straight rulings from a curve to another of the same knots; the new direction comes first.
Surface Ruled(const Curve& from, const Curve& to)
{
  Surface surface{ { KnotVector(), from.Knots[0] }, PointMatrix(2 * from.Points.rows(), 4) };
  for (Eigen::Index i = 0; i < from.Points.rows(); ++i)
  {
    surface.Points.row(2 * i) = from.Points.row(i);
    surface.Points.row(2 * i + 1) = to.Points.row(i);
  }
  return surface;
}

/// Box of the given size about the origin as a multilinear map in given degrees.
template <int Dim>
Net<Dim> Box(const std::array<double, 3>& size, int degree)
{
  Net<Dim> box;
  box.Knots.fill(KnotVector::Uniform(degree, 1));
  box.Points.resize(NumTensorFunctions<Dim>(
                      [&]
                      {
                        IntArray<Dim> p;
                        p.fill(degree);
                        return p;
                      }()),
    4);
  for (Eigen::Index row = 0; row < box.Points.rows(); ++row)
  {
    box.Points.row(row) << 0.0, 0.0, 0.0, 1.0;
    Eigen::Index rest = row;
    for (std::size_t d = 0; d < Dim; ++d, rest /= degree + 1)
    {
      box.Points(row, static_cast<Eigen::Index>(d)) =
        size[d] * (static_cast<double>(rest % (degree + 1)) / degree - 0.5);
    }
  }
  return box;
}

/// Moved along z from -height / 2 to height / 2; the new direction comes last.
template <int Dim>
Net<Dim + 1> Extruded(const Net<Dim>& base, double height)
{
  const Eigen::Index n = base.Points.rows();
  Net<Dim + 1> result;
  std::copy(base.Knots.begin(), base.Knots.end(), result.Knots.begin());
  result.Points.resize(2 * n, 4);
  result.Points.topRows(n) = base.Points;
  result.Points.bottomRows(n) = base.Points;
  result.Points.col(2).head(n) -= 0.5 * height * base.Points.col(3);
  result.Points.col(2).tail(n) += 0.5 * height * base.Points.col(3);
  return result;
}

/// A net of the plane y = 0 turned about z from +x through an angle; the new direction comes last.
template <int Dim>
Net<Dim + 1> Revolved(const Net<Dim>& base, double angle)
{
  const Eigen::Index n = base.Points.rows();
  const Curve arc = UnitArc(0.0, angle);
  Net<Dim + 1> result;
  std::copy(base.Knots.begin(), base.Knots.end(), result.Knots.begin());
  result.Knots.back() = arc.Knots[0];
  result.Points.resize(n * arc.Points.rows(), 4);
  for (Eigen::Index i = 0; i < arc.Points.rows(); ++i)
  {
    auto block = result.Points.middleRows(i * n, n);
    block.col(0) = base.Points.col(0) * arc.Points(i, 0);
    block.col(1) = base.Points.col(0) * arc.Points(i, 1);
    block.col(2) = base.Points.col(2) * arc.Points(i, 3);
    block.col(3) = base.Points.col(3) * arc.Points(i, 3);
  }
  return result;
}

/// Direction d of the result is direction order[d] of the net.
template <int Dim>
Net<Dim> Reordered(const Net<Dim>& net, const IntArray<Dim>& order)
{
  Net<Dim> result;
  IntArray<Dim> stride;
  stride[0] = 1;
  for (std::size_t d = 1; d < Dim; ++d)
  {
    stride[d] = stride[d - 1] * net.Knots[d - 1].NumFunctions();
  }
  for (std::size_t d = 0; d < Dim; ++d)
  {
    result.Knots[d] = net.Knots[static_cast<std::size_t>(order[d])];
  }
  result.Points.resize(net.Points.rows(), 4);
  for (Eigen::Index row = 0; row < net.Points.rows(); ++row)
  {
    Eigen::Index rest = row;
    Eigen::Index from = 0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      from += rest % result.Knots[d].NumFunctions() * stride[static_cast<std::size_t>(order[d])];
      rest /= result.Knots[d].NumFunctions();
    }
    result.Points.row(row) = net.Points.row(from);
  }
  return result;
}

/// The rows' points multiplied by a matrix.
template <int Dim>
Net<Dim> Mapped(Net<Dim> net, const Eigen::Matrix3d& matrix)
{
  net.Points.template leftCols<3>() =
    (net.Points.template leftCols<3>() * matrix.transpose()).eval();
  return net;
}

/// Core square first, then the patches around it, counterclockwise from +x.
std::vector<Surface> DiscPatches(double inner, double outer)
{
  const double side = inner * std::sqrt(2.0);
  std::vector<Surface> patches{ Box<2>({ side, side, 0.0 }, 2) };
  for (int k = 0; k < 4; ++k)
  {
    const Curve arc = UnitArc(90.0 * k - 45.0, 90.0);
    const Eigen::Vector3d begin =
      0.5 * side * std::sqrt(2.0) * arc.Points.row(0).head<3>().transpose();
    const Eigen::Vector3d end =
      0.5 * side * std::sqrt(2.0) * arc.Points.row(2).head<3>().transpose();
    patches.push_back(Ruled(LineLike(arc, begin, end), Scaled(arc, outer)));
  }
  return patches;
}

/// The part z >= |x|, |y| of the sphere of radius 1: the inverse stereographic image of the planar
/// biquadratic patch whose sides are the images of the great circles through the cube's edges.
Surface SphereFace()
{
  const double corner = 0.5 * (std::sqrt(3.0) - 1.0);
  const double weight = std::cos(Pi / 12.0);
  const double middle = std::sqrt(2.0) - weight; // times the weight
  std::vector<double> x(9), y(9), w(9);
  for (std::size_t i = 0; i < 9; ++i)
  {
    const int s = static_cast<int>(i % 3) - 1;
    const int t = static_cast<int>(i / 3) - 1;
    const bool isCorner = s != 0 && t != 0;
    x[i] = s * (isCorner ? corner : middle);
    y[i] = t * (isCorner ? corner : middle);
    w[i] = isCorner ? 1.0 : (s == 0 && t == 0 ? weight * weight : weight);
  }
  const IntArray<2> p{ 2, 2 };
  const std::vector<double> xw = BernsteinProduct<2>(p, x, p, w);
  const std::vector<double> yw = BernsteinProduct<2>(p, y, p, w);
  const std::vector<double> xx = BernsteinProduct<2>(p, x, p, x);
  const std::vector<double> yy = BernsteinProduct<2>(p, y, p, y);
  const std::vector<double> ww = BernsteinProduct<2>(p, w, p, w);
  Surface face{ { KnotVector::Uniform(4, 1), KnotVector::Uniform(4, 1) }, PointMatrix(25, 4) };
  for (std::size_t i = 0; i < 25; ++i)
  {
    const double square = xx[i] + yy[i];
    face.Points.row(static_cast<Eigen::Index>(i)) << 2 * xw[i], 2 * yw[i], ww[i] - square,
      ww[i] + square;
  }
  face.Points /= 1.0 + 2 * corner * corner; // corners get weight 1
  return face;
}

/// Rotations that take +z to +z, -z, +x, -x, +y, -y.
std::array<Eigen::Matrix3d, 6> CubeRotations()
{
  std::array<Eigen::Matrix3d, 6> r;
  r[0] << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  r[1] << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  r[2] << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  r[3] << 0, 0, -1, -1, 0, 0, 0, 1, 0;
  r[4] << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  r[5] << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  return r;
}

/// Rulings from a flat face of the core cube to a face of the sphere, outward along the last
/// direction.
Volume BallPatch(double inner, double outer)
{
  const Surface sphere = SphereFace();
  const double side = 2.0 * inner / std::sqrt(3.0);
  const Surface flat = Box<2>({ side, side, 0.0 }, 4);
  Volume patch{ { sphere.Knots[0], sphere.Knots[1], KnotVector() }, PointMatrix(50, 4) };
  patch.Points.topRows(25) = flat.Points;
  patch.Points.col(2).head(25).setConstant(0.5 * side);
  patch.Points.bottomRows(25) = sphere.Points;
  patch.Points.bottomLeftCorner(25, 3) *= outer;
  return patch;
}

/// A rectangle whose slices turn; exact because the turning of a rational arc is a rotation.
Volume Twisted(const std::array<double, 3>& size, double twist)
{
  const Surface base = Box<2>(size, 1);
  const Curve arc = UnitArc(0.0, twist);
  const Eigen::Index n = arc.Points.rows();
  Volume bar{ { base.Knots[0], base.Knots[1], arc.Knots[0] }, PointMatrix(4 * n, 4) };
  for (Eigen::Index i = 0; i < n; ++i)
  {
    const double c = arc.Points(i, 0);
    const double s = arc.Points(i, 1);
    const double w = arc.Points(i, 3);
    const double z = size[2] * (static_cast<double>(i) / static_cast<double>(n - 1) - 0.5);
    for (Eigen::Index k = 0; k < 4; ++k)
    {
      const double x = base.Points(k, 0);
      const double y = base.Points(k, 1);
      bar.Points.row(4 * i + k) << c * x - s * y, s * x + c * y, w * z, w;
    }
  }
  return bar;
}

/// Straight edge of the plate from angle to angle against the hole's arc.
Surface PlatePatch(
  double radius, double begin, double angle, const Eigen::Vector3d& from, const Eigen::Vector3d& to)
{
  const Curve arc = UnitArc(begin, angle);
  return Ruled(Scaled(arc, radius), LineLike(arc, from, to));
}

std::vector<Patch> MakePatches(const ShapeParams& s)
{
  const Eigen::Vector3d corner(0.5 * s.Size[0], 0.5 * s.Size[1], 0.0);
  std::vector<Patch> patches;
  switch (s.Kind)
  {
    case ShapeKind::Line:
      patches.push_back({ Box<1>(s.Size, 1) });
      break;
    case ShapeKind::Arc:
      patches.push_back({ Scaled(UnitArc(0.0, s.Angle), s.OuterRadius) });
      break;
    case ShapeKind::Square:
      patches.push_back({ Box<2>(s.Size, 1) });
      break;
    case ShapeKind::AnnulusSector:
    case ShapeKind::SolidTube:
      for (int k = 0; k < s.Sectors; ++k)
      {
        const Curve arc = SectorArc(s, k);
        const Surface sector = Ruled(Scaled(arc, s.InnerRadius), Scaled(arc, s.OuterRadius));
        if (s.Kind == ShapeKind::AnnulusSector)
        {
          patches.push_back({ sector });
        }
        else
        {
          patches.push_back({ Extruded(sector, s.Height) });
        }
      }
      break;
    case ShapeKind::Disc:
    case ShapeKind::SolidCylinder:
      for (const Surface& patch : DiscPatches(s.InnerRadius, s.OuterRadius))
      {
        const std::array<int, 3> roles{ patches.empty() ? 1 : 0, 1, 2 };
        if (s.Kind == ShapeKind::Disc)
        {
          patches.push_back({ patch, roles });
        }
        else
        {
          patches.push_back({ Extruded(patch, s.Height), roles });
        }
      }
      break;
    case ShapeKind::PlateWithHole:
      for (int k = 0; k < 4; ++k)
      {
        const auto [c, t] = CosSin(90.0 * k);
        // the corners at k * 90 -+ 45 degrees
        const Eigen::Vector3d from((c + t) * corner.x(), (t - c) * corner.y(), 0.0);
        const Eigen::Vector3d to((c - t) * corner.x(), (t + c) * corner.y(), 0.0);
        patches.push_back({ PlatePatch(s.InnerRadius, 90.0 * k - 45.0, 90.0, from, to) });
      }
      break;
    case ShapeKind::QuarterPlateWithHole:
      patches.push_back({ PlatePatch(s.InnerRadius, 0.0, 45.0, { corner.x(), 0.0, 0.0 }, corner) });
      patches.push_back(
        { PlatePatch(s.InnerRadius, 45.0, 45.0, corner, { 0.0, corner.y(), 0.0 }) });
      break;
    case ShapeKind::CylinderSurface:
      patches.push_back({ Extruded(Scaled(UnitArc(0.0, s.Angle), s.OuterRadius), s.Height) });
      break;
    case ShapeKind::SphereSurface:
      for (const Eigen::Matrix3d& rotation : CubeRotations())
      {
        patches.push_back({ Mapped(SphereFace(), s.OuterRadius * rotation), { 0, 0, 2 } });
      }
      break;
    case ShapeKind::PolarSphereSurface:
    {
      // the meridian in the plane y = 0: (x, y) of the arc become (x, z)
      const Curve meridian = Mapped(UnitArc(-90.0, 180.0),
        s.OuterRadius * (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, 1, 0).finished());
      patches.push_back({ Reordered<2>(Revolved(meridian, s.Angle), { 1, 0 }) });
      break;
    }
    case ShapeKind::TorusSurface:
    {
      Curve tube = Mapped(UnitArc(0.0, 360.0),
        s.InnerRadius * (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, 1, 0).finished());
      tube.Points.col(0) += s.OuterRadius * tube.Points.col(3);
      patches.push_back({ Reordered<2>(Revolved(tube, s.Angle), { 1, 0 }) });
      break;
    }
    case ShapeKind::Cube:
      patches.push_back({ Box<3>(s.Size, 1) });
      break;
    case ShapeKind::BallSector:
    {
      const Curve meridian = Mapped(UnitArc(-0.5 * s.PolarAngle, s.PolarAngle),
        (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, 1, 0).finished());
      const Surface sector =
        Ruled(Scaled(meridian, s.InnerRadius), Scaled(meridian, s.OuterRadius));
      patches.push_back({ Reordered<3>(Revolved(sector, s.Angle), { 0, 2, 1 }) });
      break;
    }
    case ShapeKind::Ball:
    {
      const double side = 2.0 * s.InnerRadius / std::sqrt(3.0);
      patches.push_back({ Box<3>({ side, side, side }, 4), { 1, 1, 1 } });
      for (const Eigen::Matrix3d& rotation : CubeRotations())
      {
        patches.push_back(
          { Mapped(BallPatch(s.InnerRadius, s.OuterRadius), rotation), { 1, 1, 0 } });
      }
      break;
    }
    case ShapeKind::TwistedBar:
      patches.push_back({ Twisted(s.Size, s.Twist) });
      break;
    case ShapeKind::SolidTorus:
      for (Surface patch : DiscPatches(0.5 * s.InnerRadius, s.InnerRadius))
      {
        const std::array<int, 3> roles{ patches.empty() ? 1 : 0, 1, 2 };
        // (x, y) become (x, -z), so that the third direction is right-handed
        patch = Mapped(patch, (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 0, 0, -1, 0).finished());
        patch.Points.col(0) += s.OuterRadius * patch.Points.col(3);
        patches.push_back({ Revolved(patch, s.Angle), roles });
      }
      break;
  }
  return patches;
}

/// Which parameters a shape reads.
bool Uses(ShapeKind kind, std::initializer_list<ShapeKind> kinds)
{
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

Status CheckParams(const ShapeParams& s)
{
  using K = ShapeKind;
  const auto bad = [](const std::string& detail)
  { return Status(ErrorCode::InvalidParameter, detail); };
  const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
  if (!ToString(s.Kind))
  {
    return bad("there is no shape number " + std::to_string(static_cast<int>(s.Kind)));
  }
  if (s.Degree < 0 || s.Degree > MaxDegree)
  {
    return bad("the degree must be in [0, 9], it is " + std::to_string(s.Degree));
  }
  for (std::size_t d = 0; d < 3; ++d)
  {
    if (s.Elements[d] < 1)
    {
      return bad("the number of elements must be positive, it is " + std::to_string(s.Elements[d]) +
        " in direction " + std::to_string(d));
    }
    if (!std::isfinite(s.Center[d]))
    {
      return bad("the centre must be finite");
    }
  }
  const int sizes = Uses(s.Kind, { K::Line })                                ? 1
    : Uses(s.Kind, { K::Square, K::PlateWithHole, K::QuarterPlateWithHole }) ? 2
    : Uses(s.Kind, { K::Cube, K::TwistedBar })                               ? 3
                                                                             : 0;
  for (std::size_t d = 0; d < static_cast<std::size_t>(sizes); ++d)
  {
    if (!positive(s.Size[d]))
    {
      return bad("sizes must be positive, size " + std::to_string(d) + " is " + Digits(s.Size[d]));
    }
  }
  const bool plate = Uses(s.Kind, { K::PlateWithHole, K::QuarterPlateWithHole });
  const bool inner = plate ||
    Uses(s.Kind,
      { K::AnnulusSector, K::Disc, K::TorusSurface, K::SolidTube, K::SolidCylinder, K::BallSector,
        K::Ball, K::SolidTorus });
  const bool outer = !plate && sizes == 0;
  const bool mayVanish = s.Kind == K::BallSector && s.InnerRadius == 0.0;
  if (inner && !mayVanish && !positive(s.InnerRadius))
  {
    return bad("the inner radius must be positive, it is " + Digits(s.InnerRadius));
  }
  if (outer && !positive(s.OuterRadius))
  {
    return bad("the outer radius must be positive, it is " + Digits(s.OuterRadius));
  }
  if (inner && outer && !(s.InnerRadius < s.OuterRadius))
  {
    return bad("the inner radius must be less than the outer radius, they are " +
      Digits(s.InnerRadius) + " and " + Digits(s.OuterRadius));
  }
  if (plate && !(2 * s.InnerRadius < std::min(s.Size[0], s.Size[1])))
  {
    return bad("the hole of radius " + Digits(s.InnerRadius) + " does not fit in the plate");
  }
  if (!(s.Angle > 0.0 && s.Angle <= 360.0))
  {
    return bad("the angle must be in (0, 360] degrees, it is " + Digits(s.Angle));
  }
  if (s.Sectors < 1 || s.Sectors > 4096)
  {
    return bad("the sectors must be in [1, 4096], they are " + std::to_string(s.Sectors));
  }
  if (!(s.PolarAngle > 0.0 && s.PolarAngle <= 180.0))
  {
    return bad("the polar angle must be in (0, 180] degrees, it is " + Digits(s.PolarAngle));
  }
  if (!(std::abs(s.Twist) <= 3600.0))
  {
    return bad("the twist must be in [-3600, 3600] degrees, it is " + Digits(s.Twist));
  }
  if (!positive(s.Height))
  {
    return bad("the height must be positive, it is " + Digits(s.Height));
  }
  return {};
}

/// That a net will have as a spline of the wanted degree and elements.
template <int Dim>
double CountFunctions(
  const Net<Dim>& net, const std::array<int, 3>& roles, const ShapeParams& params)
{
  double functions = 1.0;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    functions *=
      1.0 * net.Knots[d].NumElements() * params.Elements[static_cast<std::size_t>(roles[d])] +
      std::max(params.Degree, net.Knots[d].Degree());
  }
  return functions;
}

/// The net as a spline of the wanted degree and elements.
template <int Dim>
Result<Spline<Dim>> Finish(Net<Dim> net, const std::array<int, 3>& roles, const ShapeParams& params)
{
  for (Eigen::Index d = 0; d < 3; ++d)
  {
    net.Points.col(d) += params.Center[static_cast<std::size_t>(d)] * net.Points.col(3);
  }
  auto space = MakeTensorSpace<Dim>(net.Knots);
  if (!space)
  {
    return space.Status;
  }
  Spline<Dim> spline;
  spline.Space = std::move(space.Value);
  const bool rational = (net.Points.col(3).array() != 1.0).any();
  spline.SetHomogeneousPoints(
    rational ? net.Points : PointMatrix(net.Points.template leftCols<3>()), rational);

  for (std::size_t d = 0; d < Dim; ++d)
  {
    const int times = params.Degree - spline.Space->Knots[d].Degree();
    if (times > 0)
    {
      auto elevated = ElevateDegree<Dim>(spline, static_cast<int>(d), times);
      if (!elevated)
      {
        return elevated;
      }
      spline = std::move(elevated.Value);
    }
    const int elements = params.Elements[static_cast<std::size_t>(roles[d])];
    const std::vector<double> breaks = spline.Space->Knots[d].Breaks();
    std::vector<double> inserted;
    for (std::size_t b = 0; b + 1 < breaks.size(); ++b)
    {
      for (int i = 1; i < elements; ++i)
      {
        inserted.push_back(breaks[b] + (breaks[b + 1] - breaks[b]) * i / elements);
      }
    }
    if (!inserted.empty())
    {
      auto refined = InsertKnots<Dim>(spline, static_cast<int>(d), inserted);
      if (!refined)
      {
        return refined;
      }
      spline = std::move(refined.Value);
    }
  }
  return spline;
}
}

const char* ToString(ShapeKind kind)
{
  switch (kind)
  {
    case ShapeKind::Line:
      return "Line";
    case ShapeKind::Arc:
      return "Arc";
    case ShapeKind::Square:
      return "Square";
    case ShapeKind::AnnulusSector:
      return "AnnulusSector";
    case ShapeKind::Disc:
      return "Disc";
    case ShapeKind::PlateWithHole:
      return "PlateWithHole";
    case ShapeKind::QuarterPlateWithHole:
      return "QuarterPlateWithHole";
    case ShapeKind::CylinderSurface:
      return "CylinderSurface";
    case ShapeKind::SphereSurface:
      return "SphereSurface";
    case ShapeKind::PolarSphereSurface:
      return "PolarSphereSurface";
    case ShapeKind::TorusSurface:
      return "TorusSurface";
    case ShapeKind::Cube:
      return "Cube";
    case ShapeKind::SolidTube:
      return "SolidTube";
    case ShapeKind::SolidCylinder:
      return "SolidCylinder";
    case ShapeKind::BallSector:
      return "BallSector";
    case ShapeKind::Ball:
      return "Ball";
    case ShapeKind::TwistedBar:
      return "TwistedBar";
    case ShapeKind::SolidTorus:
      return "SolidTorus";
  }
  return nullptr;
}

int NumParameters(ShapeKind kind)
{
  if (kind <= ShapeKind::Arc)
  {
    return 1;
  }
  return kind <= ShapeKind::TorusSurface ? 2 : 3;
}

Result<std::vector<AnySpline>> MakeShape(const ShapeParams& params)
{
  if (const Status status = CheckParams(params); !status)
  {
    return status;
  }
  const auto patches = MakePatches(params);
  double functions = 0.0;
  for (const Patch& patch : patches)
  {
    functions += std::visit(
      [&](const auto& net) { return CountFunctions(net, patch.Roles, params); }, patch.Shape);
  }
  if (Status status = CheckSize(functions, params.MaxFunctions); !status)
  {
    return status;
  }
  std::vector<AnySpline> splines;
  for (const Patch& patch : patches)
  {
    const Status status = std::visit(
      [&](const auto& net)
      {
        auto spline = Finish(net, patch.Roles, params);
        if (spline)
        {
          splines.push_back(std::move(spline.Value));
        }
        return spline.Status;
      },
      patch.Shape);
    if (!status)
    {
      return status;
    }
  }
  return splines;
}
}
