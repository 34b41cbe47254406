# SPDX-License-Identifier: BSD-3-Clause
# The VTK modules: every Modules/<name>/vtk.module.
set(KNOTWORK_PYTHON_DIR "")
set(python_component "")
if(KNOTWORK_PYTHON)
  find_package(Python3 COMPONENTS Interpreter Development REQUIRED)
  set(KNOTWORK_PYTHON_DIR
    "${CMAKE_INSTALL_LIBDIR}/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages")
  set(python_component WrappingPythonCore)
endif()
set(test_components "")
if(BUILD_TESTING)
  set(test_components ${KNOTWORK_VTK_TEST_COMPONENTS})
endif()
find_package(VTK 9.1 REQUIRED COMPONENTS ${KNOTWORK_VTK_COMPONENTS} ${KNOTWORK_VTK_PICTURE_COMPONENTS} ${python_component} ${test_components}
  OPTIONAL_COMPONENTS ParallelMPI)

knotwork_find_filter_modules(module_names module_files)

set(KNOTWORK_FILTER_MODULES "")
if(module_files)
  vtk_module_scan(
    MODULE_FILES ${module_files}
    PROVIDES_MODULES KNOTWORK_FILTER_MODULES
    WANT_BY_DEFAULT ON
    HIDE_MODULES_FROM_CACHE ON)
  vtk_module_build(
    MODULES ${KNOTWORK_FILTER_MODULES}
    PACKAGE Knotwork
    INSTALL_EXPORT Knotwork
    INSTALL_HEADERS ON
    HEADERS_DESTINATION "${KNOTWORK_INCLUDE_DIR}"
    CMAKE_DESTINATION "${KNOTWORK_CMAKE_DIR}"
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}
    TEST_DIRECTORY_NAME NONE)
endif()
