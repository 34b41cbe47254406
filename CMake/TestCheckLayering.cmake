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

# Low has a kernel, Middle and High have filters too.
set(modules CMake/KnotworkModules.cmake "set(KNOTWORK_MODULES Low Middle High)
set(KNOTWORK_KERNELS_OF_Middle Low)\nset(KNOTWORK_KERNELS_OF_High Low)\nset(KNOTWORK_FILTERS_OF_High Middle)")
set(low Modules/Low/Kernel/Knots.h "#include <vector>")
set(middle Modules/Middle/Kernel/Map.cxx "#include \"Knots.h\"" Modules/Middle/Kernel/Form.h "// empty"
  Modules/Middle/vtk.module "NAME\n  Knotwork::Middle\nDEPENDS\n  VTK::CommonCore"
  Modules/Middle/vtkMap.h "#include <vtkObject.h>" Modules/Middle/Grid.h "#include \"vtkMap.h\"")
set(high Modules/High/Kernel/Plan.cxx "#include \"Knots.h\"" Modules/High/vtkPlan.cxx "#include \"vtkMap.h\"" Modules/High/Plan.h "// empty"
  Modules/High/vtk.module "NAME\n  Knotwork::High\nDEPENDS\n  Knotwork::Middle\n  VTK::CommonCore")
set(clean ${modules} ${low} ${middle} ${high})
set(bad Modules/Low/Kernel/Bad.cxx)
expect(pass Clean ${clean} Modules/CommandLine/main.cxx "#include \"Knots.h\"" Modules/Low/Testing/Kernel/Test.cxx "#include \"Plan.h\"")
expect("no kernel file" Empty ${modules})
expect("no kernel file" OnlyFilters ${modules} Modules/Low/vtkLow.h "#include <vtkObject.h>")
expect("includes VTK" Vtk ${clean} ${bad} "#include <vtkPoints.h>")
expect("includes VTK" QuotedVtk ${clean} ${bad} "  #  include \"vtkPoints.h\"")
expect("includes VTK" VtkFolder ${clean} ${bad} "#include <vtk-9.1/vtkPoints.h>")
expect("input and output" Stream ${clean} ${bad} "#include <iostream>")
expect("a header of filters" FilterHeader ${clean} Modules/Middle/Kernel/Bad.cxx "#include \"Grid.h\"")
expect("Low may not use Middle" Upward ${clean} ${bad} "#include \"Form.h\"")
expect("Low may not use Middle" UpwardByPath ${clean} ${bad} "#include \"../../Middle/Kernel/Form.h\"")
expect("Middle may not use High" UpwardFilter ${clean} Modules/Middle/vtkBad.cxx "#include \"Plan.h\"")
expect("High may not use Middle" KernelOfFilters ${clean} Modules/High/Kernel/Bad.cxx "#include \"Form.h\"")
expect("defines Span too" SameType ${clean} Modules/Low/Kernel/Span.h "struct Span\n{\n}\n" Modules/Middle/Kernel/Range.h "struct Span\n{\n}\n")
expect("has a header of this name" SameName ${clean} Modules/Middle/Kernel/Knots.h "")
expect("has no module Odd" UnknownModule ${clean} Modules/Odd/Kernel/Odd.cxx "")
expect("KERNELS of High state Low, and include none" UnusedKernel ${clean} Modules/High/Kernel/Plan.cxx "")
expect("FILTERS of High state Middle, and include none" UnusedFilter ${clean} Modules/High/vtkPlan.cxx "")
expect("vtk.module: states ''" VtkModule ${clean} Modules/High/vtk.module "NAME\n  Knotwork::High\nDEPENDS\n  VTK::CommonCore")
expect("Low stands before High" Order ${clean}
  CMake/KnotworkModules.cmake "set(KNOTWORK_MODULES Low Middle High)\nset(KNOTWORK_KERNELS_OF_Low High)")
