// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineSource.h"

#include "SplineModel.h"
#include <knotwork/SplineCore/Shapes.h>

#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

static_assert(vtkSplineSource::SOLID_TORUS + 1 == knotwork::NumShapeKinds &&
    vtkSplineSource::SOLID_TORUS == static_cast<int>(knotwork::ShapeKind::SolidTorus) &&
    vtkSplineSource::CUBE == static_cast<int>(knotwork::ShapeKind::Cube),
  "the shapes are those of the kernel");

vtkStandardNewMacro(vtkSplineSource);

vtkSplineSource::vtkSplineSource()
{
  this->SetNumberOfInputPorts(0);
}

void vtkSplineSource::SetShapeName(const char* name)
{
  for (int shape = LINE; name && shape <= SOLID_TORUS; ++shape)
  {
    if (std::string(name) == knotwork::ToString(static_cast<knotwork::ShapeKind>(shape)))
    {
      this->SetShape(shape);
      return;
    }
  }
  vtkErrorMacro("there is no shape '" << (name ? name : "") << "'");
}

const char* vtkSplineSource::GetShapeName()
{
  return knotwork::ToString(static_cast<knotwork::ShapeKind>(this->Shape));
}

knotwork::Status vtkSplineSource::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  knotwork::ShapeParams params;
  params.Kind = static_cast<knotwork::ShapeKind>(this->Shape);
  params.MaxFunctions = this->MaximumFunctions;
  params.Degree = this->Degree;
  params.InnerRadius = this->InnerRadius;
  params.OuterRadius = this->OuterRadius;
  params.Angle = this->Angle;
  params.Sectors = this->Sectors;
  params.PolarAngle = this->PolarAngle;
  params.Height = this->Height;
  params.Twist = this->Twist;
  std::copy(this->Elements, this->Elements + 3, params.Elements.begin());
  std::copy(this->Size, this->Size + 3, params.Size.begin());
  std::copy(this->Center, this->Center + 3, params.Center.begin());

  auto shape = knotwork::MakeShape(params);
  if (!shape)
  {
    return shape.Status;
  }
  knotwork::SplineModel model;
  for (knotwork::AnySpline& spline : shape.Value)
  {
    knotwork::SplinePatch patch;
    patch.Id = static_cast<int>(model.Patches.size());
    patch.Geometry = std::move(spline);
    model.Patches.push_back(std::move(patch));
  }
  return knotwork::EncodeSplineGrid(model, vtkUnstructuredGrid::GetData(outputs));
}
