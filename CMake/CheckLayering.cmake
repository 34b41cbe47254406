# SPDX-License-Identifier: BSD-3-Clause
# usage: cmake -DROOT=<source tree> -P CheckLayering.cmake
# The wall between the layers. Fails when a file below some Modules/<X>/Kernel
#   - includes a VTK header or one for input and output,
#   - includes a header of another kernel that is not below it in the order of the layers, or of SplineIO,
# when a kernel's build file lists a module of which no file of the kernel includes a header,
# when two kernels have a header of the same name or a type of the same name (their programs would mix them up without a
# word), and when there is no kernel file at all.
cmake_minimum_required(VERSION 3.22)

# Modules on one line are peers and may not use each other.
set(layers
  "SplineCore"
  "JacobianValidation"
  "DomainParameterization MeshParameterization"
  "TemplateMapping"
  "SurfaceTrimming CADFitting"
  "SurfaceFitting"
  "SplineIO")
set(rank 0)
foreach(layer IN LISTS layers)
  string(REPLACE " " ";" modules "${layer}")
  foreach(module IN LISTS modules)
    set(rank_${module} ${rank})
  endforeach()
  math(EXPR rank "${rank} + 1")
endforeach()

set(problems "")
file(GLOB_RECURSE files RELATIVE "${ROOT}" "${ROOT}/Modules/*/Kernel/*.h" "${ROOT}/Modules/*/Kernel/*.cxx")
list(FILTER files INCLUDE REGEX "^Modules/[^/]+/Kernel/")
if(NOT files)
  message(FATAL_ERROR "no kernel file below ${ROOT}/Modules: the check would be empty")
endif()

# Which module a header belongs to: kernels are used by plain file name.
file(GLOB_RECURSE headers RELATIVE "${ROOT}" "${ROOT}/Modules/*.h")
foreach(header IN LISTS headers)
  string(REGEX MATCH "^Modules/([^/]+)/" match "${header}")
  set(module ${CMAKE_MATCH_1})
  get_filename_component(name "${header}" NAME)
  if(DEFINED "owner_${name}" AND NOT "${owner_${name}}" STREQUAL module AND header MATCHES "/Kernel/")
    list(APPEND problems "${header}: ${owner_${name}} has a header of this name too")
  endif()
  set("owner_${name}" ${module})
endforeach()

# All kernels are one namespace.
foreach(header IN LISTS headers)
  if(header MATCHES "^Modules/[^/]+/Kernel/")
    file(STRINGS "${ROOT}/${header}" types REGEX "^(struct|class|enum class) [A-Za-z0-9]+( :.*)?$")
    foreach(line IN LISTS types)
      string(REGEX REPLACE "^(struct|class|enum class) ([A-Za-z0-9]+).*" "\\2" type "${line}")
      if(DEFINED "type_${type}")
        list(APPEND problems "${header}: ${type_${type}} defines ${type} too")
      endif()
      set("type_${type}" "${header}")
    endforeach()
  endif()
endforeach()

foreach(file IN LISTS files)
  string(REGEX MATCH "^Modules/([^/]+)/" match "${file}")
  set(module ${CMAKE_MATCH_1})
  file(STRINGS "${ROOT}/${file}" includes REGEX "^[ \t]*#[ \t]*include")
  foreach(line IN LISTS includes)
    string(REGEX REPLACE "^[^<\"]*[<\"]([^>\"]*)[>\"].*" "\\1" path "${line}")
    get_filename_component(name "${path}" NAME)
    if(name MATCHES "^vtk" OR path MATCHES "^vtk")
      list(APPEND problems "${file}: a kernel includes VTK: ${path}")
    elseif(path MATCHES "^(iostream|ostream|istream|fstream|cstdio|stdio\\.h|filesystem|print)$")
      list(APPEND problems "${file}: a kernel includes input and output: ${path}")
    elseif(path MATCHES "SplineIO")
      list(APPEND problems "${file}: a kernel uses SplineIO: ${path}")
    elseif(DEFINED "owner_${name}" AND NOT "${owner_${name}}" STREQUAL module)
      set(other ${owner_${name}})
      set("uses_${module}_${other}" TRUE)
      if(NOT DEFINED rank_${module} OR NOT DEFINED rank_${other})
        list(APPEND problems "${file}: no order is known for ${module} -> ${other}: ${path}")
      elseif(NOT rank_${other} LESS rank_${module})
        list(APPEND problems "${file}: ${module} may not use ${other}: ${path}")
      endif()
    endif()
  endforeach()
endforeach()

# The same edges as the build files state them.
file(GLOB lists RELATIVE "${ROOT}" "${ROOT}/Modules/*/Kernel/CMakeLists.txt")
foreach(list_file IN LISTS lists)
  string(REGEX MATCH "^Modules/([^/]+)/" match "${list_file}")
  set(module ${CMAKE_MATCH_1})
  file(READ "${ROOT}/${list_file}" text)
  string(REGEX MATCH "DEPENDS([ \t\r\n]+[A-Za-z]+)+" depends "${text}")
  string(REGEX MATCHALL "[A-Za-z]+" words "${depends}")
  list(POP_FRONT words)
  foreach(other IN LISTS words)
    if(other MATCHES "^[A-Z]+$") # the next keyword: no longer dependencies
      break()
    endif()
    if(NOT DEFINED rank_${module} OR NOT DEFINED rank_${other} OR NOT rank_${other} LESS rank_${module})
      list(APPEND problems "${list_file}: ${module} may not depend on ${other}")
    elseif(NOT "${uses_${module}_${other}}")
      list(APPEND problems "${list_file}: ${module} lists ${other} and includes none of its headers")
    endif()
  endforeach()
endforeach()

if(problems)
  list(JOIN problems "\n  " text)
  message(FATAL_ERROR "layering:\n  ${text}")
endif()
list(LENGTH files count)
message(STATUS "layering: ${count} kernel files are clean")
