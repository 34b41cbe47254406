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
    file(WRITE "${tree}/${file}" "${text}\n")
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

# Low has a kernel, Middle and High have filters too; CADModel and High are what the check knows by name or by its lists.
set(modules CMake/KnotworkModules.cmake "set(KNOTWORK_MODULES Low CADModel Middle High)
set(KNOTWORK_KERNELS_OF_Middle Low)\nset(KNOTWORK_KERNELS_OF_High Low)\nset(KNOTWORK_FILTERS_OF_High Middle)")
set(low Modules/Low/Kernel/CMakeLists.txt "knotwork_add_kernel(Low\n  HEADERS\n    Base/Knots.h\n  SOURCES\n    Own.h)"
  Modules/Low/Kernel/Base/Knots.h "#include <vector>" Modules/Low/Kernel/Own.h "#include \"Knots.h\"")
set(middle Modules/Middle/Kernel/Map.cxx "#include <knotwork/Low/Knots.h>"
  Modules/Middle/CMakeLists.txt "knotwork_add_filters(Middle\n  HEADERS\n    Grid.h\n  CLASSES\n    vtkMap)"
  Modules/Middle/vtk.module "NAME\n  Knotwork::Middle\nDEPENDS\n  VTK::CommonCore"
  Modules/Middle/vtkMap.h "#include <vtkObject.h>" Modules/Middle/Grid.h "#include \"vtkMap.h\"")
set(high Modules/High/Kernel/Plan.cxx "#include <knotwork/Low/Knots.h>" Modules/High/vtkPlan.cxx "#include <knotwork/Middle/vtkMap.h>"
  Modules/High/vtk.module "NAME\n  Knotwork::High\nDEPENDS\n  Knotwork::Middle\n  VTK::CommonCore")
set(clean ${modules} ${low} ${middle} ${high})
set(bad Modules/Low/Kernel/Bad.cxx)
set(bad_filter Modules/High/vtkBad.cxx)
expect(pass Clean ${clean} Modules/CommandLine/main.cxx "#include <knotwork/Low/Knots.h>" Modules/High/Testing/Kernel/Test.cxx "#include \"Own.h\"")
expect("no kernel file" Empty ${modules})
expect("no kernel file" OnlyFilters ${modules} Modules/Low/vtkLow.h "#include <vtkObject.h>")
expect("includes VTK" Vtk ${clean} ${bad} "#include <vtkPoints.h>")
expect("includes VTK" QuotedVtk ${clean} ${bad} "  #  include \"vtkPoints.h\"")
expect("includes VTK" VtkFolder ${clean} ${bad} "#include <vtk-9.1/vtkPoints.h>")
expect("input and output" Stream ${clean} ${bad} "#include <iostream>")
expect("a header of filters" FilterHeader ${clean} Modules/Middle/Kernel/Bad.cxx "#include <knotwork/Middle/Grid.h>")
expect("Low may not use Middle" Upward ${clean} ${bad} "#include <knotwork/Middle/Grid.h>")
expect("Middle may not use High" UpwardFilter ${clean} Modules/High/CMakeLists.txt "knotwork_add_filters(High\n  HEADERS\n    Plan.h)"
  Modules/High/Plan.h "" Modules/Middle/vtkBad.cxx "#include <knotwork/High/Plan.h>")
expect("High may not use Middle" KernelOfFilters ${clean} Modules/Middle/Kernel/CMakeLists.txt "knotwork_add_kernel(Middle\n  HEADERS\n    Form.h)"
  Modules/Middle/Kernel/Form.h "" Modules/High/Kernel/Bad.cxx "#include <knotwork/Middle/Form.h>")
expect("Low lists no header Own.h" Unlisted ${clean} ${bad_filter} "#include <knotwork/Low/Own.h>")
expect("Low lists no header Own.h" UnlistedByProgram ${clean} Modules/CommandLine/main.cxx "#include <knotwork/Low/Own.h>")
expect("Middle lists no header Knots.h" OtherModule ${clean} ${bad_filter} "#include <knotwork/Middle/Knots.h>")
expect("not as <knotwork/Low/Knots.h>" PlainName ${clean} ${bad_filter} "#include \"Knots.h\"")
expect("not as <knotwork/Low/Knots.h>" PlainPath ${clean} ${bad_filter} "#include \"../Low/Kernel/Base/Knots.h\"")
expect("belong to CADModel" OpenCascade ${clean} ${bad} "#include <gp_Pnt.hxx>")
expect(pass OpenCascadeThere ${clean} Modules/CADModel/Kernel/Shape.cxx "#include <gp_Pnt.hxx>")
expect("defines Span too" SameType ${clean} Modules/Low/Kernel/Span.h "struct Span\n{\n}\n" Modules/Middle/Kernel/Range.h "struct Span\n{\n}\n")
expect("has a header of this name" SameName ${clean} Modules/Middle/Kernel/Knots.h "")
expect("has no module Odd" UnknownModule ${clean} Modules/Odd/Kernel/Odd.cxx "")
expect("KERNELS of High state Low, and include none" UnusedKernel ${clean} Modules/High/Kernel/Plan.cxx "")
expect("FILTERS of High state Middle, and include none" UnusedFilter ${clean} Modules/High/vtkPlan.cxx "")
expect("vtk.module: states ''" VtkModule ${clean} Modules/High/vtk.module "NAME\n  Knotwork::High\nDEPENDS\n  VTK::CommonCore")
expect("Low stands before High" Order ${clean}
  CMake/KnotworkModules.cmake "set(KNOTWORK_MODULES Low CADModel Middle High)\nset(KNOTWORK_KERNELS_OF_Low High)")
