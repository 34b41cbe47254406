// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <vtkSmartPointer.h>

class vtkRenderWindow;

namespace knotwork
{
/// A window without a display, drawn by Mesa's software: an OpenGL context of EGL's platform
/// without surfaces, which VTK takes as one that the caller has made. Debian's VTK 9.1 has neither
/// OSMesa nor EGL windows of its own, and its X windows end the process where there is no display.
/// It lives until the process ends.
/// @return LibraryError with the packages that are missing.
Result<vtkSmartPointer<vtkRenderWindow>> MakeOffScreenWindow(int width, int height);
}
