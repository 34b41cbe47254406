// SPDX-License-Identifier: BSD-3-Clause
#include "IGESSplines.h"

#include <IGESBasic_HArray1OfHArray1OfIGESEntity.hxx>
#include <IGESBasic_HArray1OfHArray1OfInteger.hxx>
#include <IGESData_HArray1OfIGESEntity.hxx>
#include <IGESGeom_BSplineCurve.hxx>
#include <IGESGeom_BSplineSurface.hxx>
#include <IGESGeom_CompositeCurve.hxx>
#include <IGESGeom_CurveOnSurface.hxx>
#include <IGESSolid_Loop.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <TColStd_HArray1OfInteger.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColStd_IndexedMapOfTransient.hxx>
#include <TColgp_HArray1OfXYZ.hxx>

#include <cmath>
#include <functional>

namespace knotwork
{
namespace
{
using Entity = Handle(IGESData_IGESEntity);

/// @param knot  of -degree ... numPoles.
bool AreKnots(int degree, int numPoles, const std::function<double(int)>& knot)
{
  if (degree < 1 || numPoles < degree + 1)
  {
    return false;
  }
  int equal = 1;
  for (int i = -degree; i <= numPoles; ++i)
  {
    const double before = i > -degree ? knot(i - 1) : -HUGE_VAL;
    equal = knot(i) == before ? equal + 1 : 1;
    if (!std::isfinite(knot(i)) || knot(i) < before || equal > degree + 1)
    {
      return false;
    }
  }
  return true;
}

bool IsDamaged(const IGESGeom_BSplineCurve& curve)
{
  return !AreKnots(curve.Degree(), curve.NbPoles(), [&](int i) { return curve.Knot(i); });
}

bool IsDamaged(const IGESGeom_BSplineSurface& surface)
{
  return !AreKnots(
           surface.DegreeU(), surface.NbPolesU(), [&](int i) { return surface.KnotU(i); }) ||
    !AreKnots(surface.DegreeV(), surface.NbPolesV(), [&](int i) { return surface.KnotV(i); });
}

class Mender
{
public:
  explicit Mender(const Handle(IGESData_IGESModel) & model) : Model(model) {}
  Status Run();
  int NumDropped = 0;

private:
  Status Damaged(const char* what, const Entity& entity) const
  {
    return { ErrorCode::InvalidFormat,
      std::string("the file is damaged: the knots of the ") + what + " at directory entry " +
        std::to_string(this->Model->DNum(entity)) + " are no knot vector; write it again" };
  }
  template <class Type, class Function>
  void ForAll(const Function& function) const
  {
    for (int i = 1; i <= this->Model->NbEntities(); ++i)
    {
      const auto entity = Handle(Type)::DownCast(this->Model->Value(i));
      if (!entity.IsNull())
      {
        function(entity);
      }
    }
  }
  bool IsBad(const Entity& entity) const { return !entity.IsNull() && this->Bad.Contains(entity); }
  void FindComposites();
  void DropFrom(const Handle(IGESSolid_Loop) & loop);
  void DropFrom(const Handle(IGESGeom_CurveOnSurface) & curve);

  Handle(IGESData_IGESModel) Model;
  TColStd_IndexedMapOfTransient Bad; ///< curves that are damaged, and what is composed of them
};

void Mender::FindComposites()
{
  int before = 0;
  while (before < this->Bad.Extent())
  {
    before = this->Bad.Extent();
    this->ForAll<IGESGeom_CompositeCurve>(
      [&](const Handle(IGESGeom_CompositeCurve) & composite)
      {
        for (int i = 1; i <= composite->NbCurves(); ++i)
        {
          if (this->IsBad(composite->Curve(i)))
          {
            this->Bad.Add(composite);
          }
        }
      });
  }
}

/// Neither a pole nor one of the two uses of a seam: of these the pcurves alone know where they
/// lie.
bool IsSingleEdge(const IGESSolid_Loop& loop, int edge)
{
  constexpr int Pole = 1;
  bool single = loop.EdgeType(edge) != Pole;
  for (int e = 1; e <= loop.NbEdges(); ++e)
  {
    single = single &&
      (e == edge || loop.Edge(e) != loop.Edge(edge) || loop.ListIndex(e) != loop.ListIndex(edge));
  }
  return single;
}

void Mender::DropFrom(const Handle(IGESSolid_Loop) & loop)
{
  const int n = loop->NbEdges();
  Handle(TColStd_HArray1OfInteger) types = new TColStd_HArray1OfInteger(1, n);
  Handle(TColStd_HArray1OfInteger) indices = new TColStd_HArray1OfInteger(1, n);
  Handle(TColStd_HArray1OfInteger) senses = new TColStd_HArray1OfInteger(1, n);
  Handle(TColStd_HArray1OfInteger) counts = new TColStd_HArray1OfInteger(1, n);
  Handle(IGESData_HArray1OfIGESEntity) edges = new IGESData_HArray1OfIGESEntity(1, n);
  Handle(IGESBasic_HArray1OfHArray1OfInteger) flags = new IGESBasic_HArray1OfHArray1OfInteger(1, n);
  Handle(IGESBasic_HArray1OfHArray1OfIGESEntity) curves =
    new IGESBasic_HArray1OfHArray1OfIGESEntity(1, n);
  int dropped = 0;
  for (int e = 1; e <= n; ++e)
  {
    types->SetValue(e, loop->EdgeType(e));
    indices->SetValue(e, loop->ListIndex(e));
    senses->SetValue(e, loop->Orientation(e) ? 1 : 0);
    edges->SetValue(e, loop->Edge(e));
    int count = loop->NbParameterCurves(e);
    for (int c = 1; c <= loop->NbParameterCurves(e) && IsSingleEdge(*loop, e); ++c)
    {
      count = this->IsBad(loop->ParametricCurve(e, c)) ? 0 : count;
    }
    dropped += count < loop->NbParameterCurves(e) ? 1 : 0;
    counts->SetValue(e, count);
    if (count > 0)
    {
      Handle(TColStd_HArray1OfInteger) along = new TColStd_HArray1OfInteger(1, count);
      Handle(IGESData_HArray1OfIGESEntity) kept = new IGESData_HArray1OfIGESEntity(1, count);
      for (int c = 1; c <= count; ++c)
      {
        along->SetValue(c, loop->IsIsoparametric(e, c) ? 1 : 0);
        kept->SetValue(c, loop->ParametricCurve(e, c));
      }
      flags->SetValue(e, along);
      curves->SetValue(e, kept);
    }
  }
  if (dropped > 0)
  {
    loop->Init(types, edges, indices, senses, counts, flags, curves);
    this->NumDropped += dropped;
  }
}

/// Whether pcurves may lie along a seam. Of other surfaces than splines, planes alone have none.
bool IsClosed(const Entity& surface)
{
  constexpr int Plane = 108;
  constexpr int PlaneSurface = 190;
  const auto spline = Handle(IGESGeom_BSplineSurface)::DownCast(surface);
  if (spline.IsNull())
  {
    return surface.IsNull() ||
      (surface->TypeNumber() != Plane && surface->TypeNumber() != PlaneSurface);
  }
  return spline->IsClosedU() || spline->IsClosedV();
}

void Mender::DropFrom(const Handle(IGESGeom_CurveOnSurface) & curve)
{
  constexpr int PreferParameters = 1;
  constexpr int PreferInSpace = 2;
  const bool bad = this->IsBad(curve->CurveUV());
  const bool badInSpace = this->IsBad(curve->Curve3D());
  const bool isOther = !(bad ? curve->Curve3D() : curve->CurveUV()).IsNull();
  if (bad != badInSpace && isOther && !(bad && IsClosed(curve->Surface())))
  {
    curve->Init(curve->CreationMode(), curve->Surface(), bad ? Entity() : curve->CurveUV(),
      bad ? curve->Curve3D() : Entity(), bad ? PreferInSpace : PreferParameters);
    ++this->NumDropped;
  }
}

/// A segment, so that whoever converts all curves of a file meets no damage.
void MakeHarmless(IGESGeom_BSplineCurve& curve)
{
  Handle(TColStd_HArray1OfReal) knots = new TColStd_HArray1OfReal(-1, 2, 0.0);
  knots->SetValue(1, 1.0);
  knots->SetValue(2, 1.0);
  Handle(TColgp_HArray1OfXYZ) poles = new TColgp_HArray1OfXYZ(0, 1, gp_XYZ(0.0, 0.0, 0.0));
  poles->SetValue(1, gp_XYZ(1.0, 0.0, 0.0));
  curve.Init(1, 1, true, false, true, false, knots, new TColStd_HArray1OfReal(0, 1, 1.0), poles,
    0.0, 1.0, gp_XYZ(0.0, 0.0, 1.0));
}

Status Mender::Run()
{
  Status status;
  this->ForAll<IGESGeom_BSplineSurface>(
    [&](const Handle(IGESGeom_BSplineSurface) & surface)
    {
      if (status && IsDamaged(*surface))
      {
        status = this->Damaged("surface", surface);
      }
    });
  TColStd_IndexedMapOfTransient splines;
  this->ForAll<IGESGeom_BSplineCurve>(
    [&](const Handle(IGESGeom_BSplineCurve) & curve)
    {
      if (IsDamaged(*curve))
      {
        splines.Add(curve);
      }
    });
  if (!status || splines.IsEmpty())
  {
    return status;
  }
  this->Bad = splines;
  this->FindComposites();
  const Interface_Graph before(this->Model);
  this->ForAll<IGESSolid_Loop>([&](const Handle(IGESSolid_Loop) & loop) { this->DropFrom(loop); });
  this->ForAll<IGESGeom_CurveOnSurface>(
    [&](const Handle(IGESGeom_CurveOnSurface) & curve) { this->DropFrom(curve); });
  const Interface_Graph after(this->Model);
  for (int b = 1; b <= this->Bad.Extent(); ++b)
  {
    const auto curve = Handle(IGESData_IGESEntity)::DownCast(this->Bad(b));
    bool used = !before.Sharings(curve).More(); // by the file itself
    for (Interface_EntityIterator users = after.Sharings(curve); users.More(); users.Next())
    {
      used = used || !this->Bad.Contains(users.Value());
    }
    if (used)
    {
      return this->Damaged("curve", curve);
    }
  }
  for (int s = 1; s <= splines.Extent(); ++s)
  {
    MakeHarmless(*Handle(IGESGeom_BSplineCurve)::DownCast(splines(s)));
  }
  return {};
}
}

Status MendIGESSplines(const Handle(IGESData_IGESModel) & model, int& dropped)
{
  Mender mender(model);
  const Status status = mender.Run();
  dropped = mender.NumDropped;
  return status;
}
}
