// SPDX-License-Identifier: BSD-3-Clause
#include "OffScreen.h"

#include <vtkGenericOpenGLRenderWindow.h>

#include <array>
#include <cstdlib>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>

/// GLEW's, which VTK calls: it loads the functions of OpenGL and then looks for a display of X.
/// That there is none is no failure here. The linker takes this one, for it is the program's.
extern "C" __attribute__((visibility("default"))) unsigned int glewInit()
{
  constexpr unsigned int noDisplay = 4; // GLEW_ERROR_NO_GLX_DISPLAY
  auto* original = reinterpret_cast<unsigned int (*)()>(dlsym(RTLD_NEXT, "glewInit"));
  const unsigned int result = original ? original() : 1;
  return result == noDisplay ? 0 : result;
}

namespace knotwork
{
namespace
{
Status NoDrawing(const char* what)
{
  return { ErrorCode::LibraryError,
    std::string("no picture can be drawn: ") + what +
      "; install Debian's packages libegl1 and libgl1-mesa-dri" };
}

/// Makes a context and makes it current.
Status BeginOpenGL()
{
  // the same pixels on every machine, and no files: a process that works for another writes none
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  const EGLDisplay display =
    eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
  {
    return NoDrawing("EGL does not start without a display");
  }
  eglBindAPI(EGL_OPENGL_API);
  const std::array<EGLint, 5> wanted{ EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
    EGL_OPENGL_BIT, EGL_NONE };
  EGLConfig config = nullptr;
  EGLint count = 0;
  const std::array<EGLint, 7> version{ EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2,
    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE };
  EGLContext context = EGL_NO_CONTEXT;
  if (eglChooseConfig(display, wanted.data(), &config, 1, &count) == EGL_TRUE && count > 0)
  {
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
  }
  if (context == EGL_NO_CONTEXT ||
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE)
  {
    return NoDrawing("EGL has no OpenGL 3.2");
  }
  return {};
}
}

Result<vtkSmartPointer<vtkRenderWindow>> MakeOffScreenWindow(int width, int height)
{
  if (Status status = BeginOpenGL(); !status)
  {
    return status;
  }
  constexpr int samples = 4; // a pixel: as many as Mesa's software has
  auto window = vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New();
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(samples);
  window->SetSupportsOpenGL(1);
  window->SetIsDirect(1);
  window->SetIsCurrent(true);
  window->SetMapped(1);
  window->SetReadyForRendering(true);
  window->SetSize(width, height);
  return vtkSmartPointer<vtkRenderWindow>(window);
}
}
