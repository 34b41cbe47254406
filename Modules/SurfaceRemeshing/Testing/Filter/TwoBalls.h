// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkAppendPolyData.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"

/// Two balls that overlap, as one surface.
inline vtkSmartPointer<vtkPolyData> TwoBalls()
{
  vtkNew<vtkAppendPolyData> both;
  for (const double x : { -0.35, 0.4 })
  {
    vtkNew<vtkSphereSource> ball;
    ball->SetCenter(x, 0.1 * x, 0.05 * x);
    ball->SetThetaResolution(24);
    ball->SetPhiResolution(16);
    both->AddInputConnection(ball->GetOutputPort());
  }
  both->Update();
  return both->GetOutput();
}
