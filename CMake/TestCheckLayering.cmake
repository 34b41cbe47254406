# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DWORK=<scratch folder> -P TestCheckLayering.cmake
# The layering check must pass a clean tree and fail each kind of dirty one.
cmake_minimum_required(VERSION 3.22)

# expect(RESULT NAME [FILE TEXT]...): makes the tree and compares what the check says with pass or a part of its message
function(expect expected name)
  set(tree "${WORK}/${name}")
  file(REMOVE_RECURSE "${tree}")
  file(MAKE_DIRECTORY "${tree}")
  while(ARGN)
    list(POP_FRONT ARGN file text)
    file(WRITE "${tree}/Modules/${file}" "${text}\n")
  endwhile()
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${tree}" -P "${CMAKE_CURRENT_LIST_DIR}/CheckLayering.cmake"
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(expected STREQUAL "pass")
    if(NOT status EQUAL 0)
      message(SEND_ERROR "${name}: refused a clean tree: ${output}")
    endif()
  elseif(status EQUAL 0)
    message(SEND_ERROR "${name}: let a dirty tree pass")
  elseif(NOT output MATCHES "${expected}")
    message(SEND_ERROR "${name}: expected '${expected}', got: ${output}")
  endif()
endfunction()

set(core SplineCore/Kernel/Knots.h "#include <vector>")
expect(pass Clean ${core}
  TemplateMapping/Kernel/Map.cxx "#include \"Knots.h\"" SplineGrid/vtkSplineSource.h "#include <vtkObject.h>")
expect("no kernel file" Empty)
expect("no kernel file" OnlyFilters SplineGrid/vtkSplineSource.h "#include <vtkObject.h>")
expect("includes VTK" Vtk ${core} SplineCore/Kernel/Bad.cxx "#include <vtkPoints.h>")
expect("includes VTK" QuotedVtk ${core} SplineCore/Kernel/Bad.cxx "  #  include \"vtkPoints.h\"")
expect("includes VTK" VtkFolder ${core} SplineCore/Kernel/Bad.cxx "#include <vtk-9.1/vtkPoints.h>")
expect("input and output" Stream ${core} SplineCore/Kernel/Bad.cxx "#include <iostream>")
expect("uses SplineIO" SplineIO ${core} SplineCore/Kernel/Bad.cxx "#include \"SplineIO/Reader.h\"")
expect("SplineCore may not use SplineIO" SplineIOByName ${core} SplineIO/Kernel/G2.h "" SplineCore/Kernel/Bad.cxx "#include \"G2.h\"")
expect("SplineCore may not use TemplateMapping" Upward ${core}
  TemplateMapping/Kernel/Map.h "" SplineCore/Kernel/Bad.cxx "#include \"Map.h\"")
expect("may not use SurfaceFitting" Sideways ${core}
  SurfaceFitting/Kernel/Fit.h "" MeshParameterization/Kernel/Bad.cxx "#include \"Fit.h\"")
expect("may not depend on TemplateMapping" BuildFile ${core}
  SplineCore/Kernel/CMakeLists.txt "knotwork_add_kernel(SplineCore DEPENDS TemplateMapping SOURCES a.cxx)")
expect("may not depend on SplineIO" BuildFileIO ${core}
  TemplateMapping/Kernel/CMakeLists.txt "knotwork_add_kernel(TemplateMapping\n  DEPENDS\n    SplineCore\n    SplineIO\n  SOURCES a.cxx)")
expect("lists JacobianValidation and includes none" UnusedDepends ${core} JacobianValidation/Kernel/Proof.h ""
  TemplateMapping/Kernel/Map.cxx "#include \"Knots.h\""
  TemplateMapping/Kernel/CMakeLists.txt "knotwork_add_kernel(TemplateMapping DEPENDS SplineCore JacobianValidation SOURCES Map.cxx)")
expect("defines Span too" SameType SplineCore/Kernel/Knots.h "struct Span\n{\n}\n"
  TemplateMapping/Kernel/Map.h "struct Span\n{\n}\n")
expect("has a header of this name" SameName ${core} TemplateMapping/Kernel/Knots.h "")
