# SPDX-License-Identifier: BSD-3-Clause
# The modules in the order of the layers, and what each of them uses: the one list that the build, the check of the layers
# (CheckLayering.cmake, which also compares the vtk.module files with it) and the picture (draw_modules.py) read.

# knotwork_module(MODULE [KERNELS module...] [FILTERS module...])
#   KERNELS: modules whose kernels its kernel uses. FILTERS: modules whose filters its filters use, and those whose kernels they
#   use where its own kernel does not.
set(KNOTWORK_MODULES "")
macro(knotwork_module module)
  cmake_parse_arguments(knotwork "" "" "KERNELS;FILTERS" ${ARGN})
  list(APPEND KNOTWORK_MODULES ${module})
  set(KNOTWORK_KERNELS_OF_${module} "${knotwork_KERNELS}")
  set(KNOTWORK_FILTERS_OF_${module} "${knotwork_FILTERS}")
endmacro()

knotwork_module(SplineCore)
knotwork_module(SplineGrid FILTERS SplineCore)
knotwork_module(JacobianValidation KERNELS SplineCore FILTERS SplineGrid)
knotwork_module(CADModel KERNELS SplineCore)
knotwork_module(MeshParameterization KERNELS SplineCore FILTERS SplineGrid)
knotwork_module(DomainParameterization KERNELS SplineCore JacobianValidation FILTERS SplineGrid)
knotwork_module(SurfaceFitting KERNELS SplineCore FILTERS SplineGrid MeshParameterization)
knotwork_module(TemplateMapping KERNELS SplineCore JacobianValidation DomainParameterization FILTERS SplineGrid JacobianValidation)
knotwork_module(SurfaceFeatures KERNELS SplineCore FILTERS SplineGrid)
knotwork_module(SurfaceTrimming KERNELS SplineCore JacobianValidation MeshParameterization DomainParameterization
  FILTERS SplineGrid MeshParameterization)
knotwork_module(CADFitting KERNELS SplineCore JacobianValidation MeshParameterization DomainParameterization SurfaceTrimming
  FILTERS SplineGrid CADModel MeshParameterization SurfaceTrimming)
knotwork_module(CADMeshing KERNELS SplineCore JacobianValidation CADModel MeshParameterization FILTERS SplineGrid CADModel)
if(NOT KNOTWORK_PERMISSIVE) # CGAL is under the GPL, TetGen under the AGPL
  knotwork_module(SurfaceRemeshing KERNELS SplineCore MeshParameterization FILTERS SplineGrid MeshParameterization)
  knotwork_module(TetMeshing
    KERNELS SplineCore JacobianValidation MeshParameterization CADFitting SurfaceRemeshing
    FILTERS SplineGrid JacobianValidation MeshParameterization SurfaceTrimming CADFitting)
endif()
knotwork_module(SplineAnalysis KERNELS SplineCore JacobianValidation MeshParameterization FILTERS SplineGrid JacobianValidation)
knotwork_module(SplineIO KERNELS SplineCore FILTERS SplineGrid CADModel SurfaceTrimming)
