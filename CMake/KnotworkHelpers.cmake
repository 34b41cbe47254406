# SPDX-License-Identifier: BSD-3-Clause
# What the modules' CMakeLists.txt call. Each function names a module first and takes lists of files, so that adding a
# class or a test is adding a file name.

# knotwork_list_headers(MODULE TARGET file...): the headers that others include as <knotwork/MODULE/Header.h>, whatever
# folder they are in: links in the build tree, the property KNOTWORK_HEADERS of the target.
function(knotwork_list_headers module target)
  set(headers "")
  foreach(file IN LISTS ARGN)
    get_filename_component(name "${file}" NAME)
    list(APPEND headers "knotwork/${module}/${name}")
    if(NOT IS_ABSOLUTE "${file}")
      file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/include/knotwork/${module}")
      file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}/${file}" "${CMAKE_BINARY_DIR}/include/knotwork/${module}/${name}" SYMBOLIC)
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES KNOTWORK_HEADERS "${headers}" EXPORT_PROPERTIES KNOTWORK_HEADERS)
endfunction()

# knotwork_precompile(KIND TARGET): headers that nearly every source of a kind reads (half of its time) are compiled once.
# The first target of a kind has them compiled, others that are built with the same flags take them over. A source includes
# what it uses all the same: the presets `native` and `paraview` build without.
set(KNOTWORK_PRECOMPILED_kernel <algorithm> <array> <cmath> <functional> <map> <memory> <numeric> <sstream> <string> <tuple>
  <unordered_map> <variant> <vector> <Eigen/Core>)
set(KNOTWORK_PRECOMPILED_kernel_tests ${KNOTWORK_PRECOMPILED_kernel} <random> <set> <gtest/gtest.h>)
set(KNOTWORK_PRECOMPILED_filters ${KNOTWORK_PRECOMPILED_kernel} <vtkIdTypeArray.h> <vtkInformation.h> <vtkInformationVector.h>
  <vtkIntArray.h> <vtkNew.h> <vtkObjectFactory.h> <vtkPolyData.h> <vtkSmartPointer.h> <vtkTable.h> <vtkUnstructuredGrid.h>)
set(KNOTWORK_PRECOMPILED_filter_tests ${KNOTWORK_PRECOMPILED_filters} <gtest/gtest.h>)
set(KNOTWORK_PRECOMPILED_program ${KNOTWORK_PRECOMPILED_filters} <CLI/CLI.hpp> <nlohmann/json.hpp>)
function(knotwork_precompile kind target)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  get_property(first GLOBAL PROPERTY KNOTWORK_PRECOMPILED_FOR_${kind})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
    return()
  endif()
  if(kind STREQUAL "filters") # shared libraries differ in a macro for what they export: a target without it comes first
    file(GENERATE OUTPUT "${CMAKE_BINARY_DIR}/CMakeFiles/PrecompiledFilterHeaders.cxx" CONTENT "")
    add_library(PrecompiledFilterHeaders OBJECT "${CMAKE_BINARY_DIR}/CMakeFiles/PrecompiledFilterHeaders.cxx")
    target_link_libraries(PrecompiledFilterHeaders PRIVATE Knotwork::SplineCoreKernel VTK::CommonExecutionModel)
    target_compile_options(PrecompiledFilterHeaders PRIVATE ${KNOTWORK_WARNINGS})
    target_precompile_headers(${target} REUSE_FROM PrecompiledFilterHeaders)
    set(target PrecompiledFilterHeaders)
  endif()
  target_precompile_headers(${target} PRIVATE ${KNOTWORK_PRECOMPILED_${kind}})
  set_property(GLOBAL PROPERTY KNOTWORK_PRECOMPILED_FOR_${kind} ${target})
endfunction()

# knotwork_add_kernel(MODULE SOURCES file... HEADERS file... [LIBRARIES target...] [STRICT_FLOAT file...])
#   Static library Knotwork::<MODULE>Kernel, without VTK, which links the kernels that KnotworkModules.cmake states. HEADERS are
#   for other modules, the other ones stay among the SOURCES; LIBRARIES are further link targets; sources under STRICT_FLOAT
#   are compiled without contraction to fused multiply-add.
function(knotwork_add_kernel module)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS;LIBRARIES;STRICT_FLOAT")
  if(NOT arg_SOURCES)
    return()
  endif()
  if(TARGET Knotwork::${module}Kernel) # imported from another build tree (KNOTWORK_KERNELS_FROM)
    return()
  endif()
  set(target ${module}Kernel)
  add_library(${target} STATIC ${arg_SOURCES} ${arg_HEADERS})
  add_library(Knotwork::${target} ALIAS ${target})
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE ${KNOTWORK_WARNINGS} -Wconversion -Wno-sign-conversion)
  # Eigen's alignment is pinned, so that owning types may cross to callers built with other architecture flags
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
  set_source_files_properties(${arg_STRICT_FLOAT} PROPERTIES COMPILE_OPTIONS -ffp-contract=off SKIP_PRECOMPILE_HEADERS ON)
  knotwork_precompile(kernel ${target})
  set(folders "")
  foreach(file IN LISTS arg_SOURCES arg_HEADERS)
    get_filename_component(folder "${file}" DIRECTORY)
    list(APPEND folders "${CMAKE_CURRENT_SOURCE_DIR}/${folder}")
  endforeach()
  list(REMOVE_DUPLICATES folders)
  target_include_directories(${target} PRIVATE ${folders} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/include>" "$<INSTALL_INTERFACE:${KNOTWORK_INCLUDE_DIR}>")
  set_target_properties(${target} PROPERTIES KNOTWORK_FOLDERS "${folders}")
  target_link_libraries(${target} PUBLIC Eigen3::Eigen TBB::tbb ${arg_LIBRARIES})
  foreach(dependency IN LISTS KNOTWORK_KERNELS_OF_${module})
    target_link_libraries(${target} PUBLIC ${dependency}Kernel)
  endforeach()
  install(TARGETS ${target} EXPORT KnotworkKernels ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(FILES ${arg_HEADERS} DESTINATION "${KNOTWORK_INCLUDE_DIR}/knotwork/${module}")
  knotwork_list_headers(${module} ${target} ${arg_HEADERS})
  set_property(GLOBAL APPEND PROPERTY KNOTWORK_KERNELS ${target})
endfunction()

# knotwork_add_worker(NAME SOURCES file... [LIBRARIES target...] [AUTOINIT VTK module...]): a program that works for another process,
# see RunWorker. KNOTWORK_WORKER_DIR is the folder of such programs in the install tree, and in the build tree.
function(knotwork_add_worker name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES;AUTOINIT")
  set(common "${CMAKE_SOURCE_DIR}/Modules/SplineGrid/Worker")
  add_executable(${name} ${arg_SOURCES} "${common}/WorkerMain.cxx")
  target_include_directories(${name} PRIVATE
    "$<TARGET_PROPERTY:Knotwork::SplineCoreKernel,INTERFACE_INCLUDE_DIRECTORIES>")
  target_compile_options(${name} PRIVATE ${KNOTWORK_WARNINGS})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES})
  if(arg_AUTOINIT)
    vtk_module_autoinit(TARGETS ${name} MODULES ${arg_AUTOINIT})
  endif()
  file(RELATIVE_PATH libraries "${CMAKE_INSTALL_PREFIX}/${KNOTWORK_WORKER_DIR}"
    "${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}")
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${KNOTWORK_WORKER_DIR}"
    INSTALL_RPATH "$ORIGIN;$ORIGIN/${libraries}")
  install(TARGETS ${name} RUNTIME DESTINATION "${KNOTWORK_WORKER_DIR}")
  set_property(GLOBAL APPEND PROPERTY KNOTWORK_PRODUCTS ${name})
endfunction()

# knotwork_add_worker_script(FILE): a script for a program of others, beside the programs of knotwork_add_worker; see
# PathOfWorkerScript.
function(knotwork_add_worker_script file)
  configure_file("${file}" "${CMAKE_BINARY_DIR}/${KNOTWORK_WORKER_DIR}/${file}" COPYONLY)
  install(FILES "${file}" DESTINATION "${KNOTWORK_WORKER_DIR}")
endfunction()

# knotwork_generate(COMMAND OUTPUT file... ARGUMENTS argument... HEADERS header... [DEPENDS file...]): what properties.py makes of
# the properties that headers declare, at build time.
function(knotwork_generate command)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "OUTPUT;ARGUMENTS;HEADERS;DEPENDS")
  set(script "${CMAKE_SOURCE_DIR}/CMake/properties.py")
  add_custom_command(OUTPUT ${arg_OUTPUT}
    COMMAND "${Python3_EXECUTABLE}" "${script}" ${command} ${arg_ARGUMENTS} ${arg_HEADERS}
    DEPENDS "${script}" ${arg_HEADERS} ${arg_DEPENDS}
    COMMENT "Properties: ${command}"
    VERBATIM)
endfunction()

# knotwork_generate_proxies(OUT module...): Modules/<module>/ParaView/*.xml with their short forms written out, in the build tree;
# OUT_<module> and OUT are lists of the files.
function(knotwork_generate_proxies out)
  file(GLOB headers CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/Modules/*/vtk*.h")
  set(all "")
  foreach(module IN LISTS ARGN)
    set(made "")
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/Modules/${module}/ParaView/*.xml")
    foreach(source IN LISTS sources)
      get_filename_component(name "${source}" NAME)
      set(file "${CMAKE_CURRENT_BINARY_DIR}/${name}")
      knotwork_generate(proxies OUTPUT "${file}" ARGUMENTS "${file}" "${source}" HEADERS ${headers} DEPENDS "${source}")
      list(APPEND made "${file}")
    endforeach()
    set(${out}_${module} "${made}" PARENT_SCOPE)
    list(APPEND all ${made})
  endforeach()
  set(${out} "${all}" PARENT_SCOPE)
endfunction()

# knotwork_add_filters(MODULE CLASSES class... [HEADERS file...] [SOURCES file...] [PRIVATE_CLASSES class...])
#   The VTK module Knotwork::<MODULE> that Modules/<MODULE>/vtk.module describes; PrintSelf of its classes is generated. Links its kernel, and the kernels of what
#   KnotworkModules.cmake states under FILTERS.
function(knotwork_add_filters module)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "CLASSES;HEADERS;SOURCES;PRIVATE_CLASSES")
  set(headers ${arg_CLASSES})
  list(TRANSFORM headers PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  list(TRANSFORM headers APPEND ".h")
  set(print_self "${CMAKE_CURRENT_BINARY_DIR}/PrintSelf.cxx")
  set_property(GLOBAL APPEND PROPERTY KNOTWORK_FILTER_HEADERS ${headers})
  knotwork_generate(print-self OUTPUT "${print_self}" ARGUMENTS "${print_self}" HEADERS ${headers})
  vtk_module_add_module(Knotwork::${module}
    CLASSES ${arg_CLASSES} NOWRAP_HEADERS ${arg_HEADERS} SOURCES ${arg_SOURCES} "${print_self}"
    PRIVATE_CLASSES ${arg_PRIVATE_CLASSES}
    HEADERS_SUBDIR "knotwork/${module}")
  vtk_module_compile_features(Knotwork::${module} PUBLIC cxx_std_17)
  list(TRANSFORM arg_CLASSES APPEND ".h")
  get_target_property(target Knotwork::${module} ALIASED_TARGET)
  knotwork_list_headers(${module} ${target} ${arg_CLASSES} ${arg_HEADERS} "${CMAKE_CURRENT_BINARY_DIR}/vtkKnotwork${module}Module.h")
  # VTK's function does not heed the folder in what it tells of the install tree
  get_target_property(installed ${target} INTERFACE_vtk_module_headers_install)
  if(installed)
    string(REGEX REPLACE "/([^/;]+\\.h)" "/knotwork/${module}/\\1" installed "${installed}")
    set_target_properties(${target} PROPERTIES INTERFACE_vtk_module_headers_install "${installed}")
  endif()
  vtk_module_include(Knotwork::${module} PUBLIC "$<BUILD_INTERFACE:${CMAKE_BINARY_DIR}/include>")
  vtk_module_compile_options(Knotwork::${module} PRIVATE ${KNOTWORK_WARNINGS})
  knotwork_precompile(filters ${target})
  if(TARGET Knotwork::CADModelOnDemand AND "CADModel" IN_LIST KNOTWORK_FILTERS_OF_${module})
    vtk_module_link(Knotwork::${module} PRIVATE Knotwork::CADModelOnDemand) # first: in place of the kernel's functions
    vtk_module_link_options(Knotwork::${module} PRIVATE "LINKER:--as-needed")
  endif()
  foreach(kernel IN LISTS module KNOTWORK_FILTERS_OF_${module})
    if(TARGET Knotwork::${kernel}Kernel)
      vtk_module_link(Knotwork::${module} PUBLIC Knotwork::${kernel}Kernel)
    endif()
  endforeach()
endfunction()

# The modules that are VTK modules too: their names and their vtk.module files.
function(knotwork_find_filter_modules names files)
  set(found_names "")
  set(found_files "")
  foreach(module IN LISTS KNOTWORK_MODULES)
    file(GLOB description CONFIGURE_DEPENDS "${CMAKE_SOURCE_DIR}/Modules/${module}/vtk.module")
    if(description)
      list(APPEND found_names ${module})
      list(APPEND found_files "${description}")
    endif()
  endforeach()
  set(${names} "${found_names}" PARENT_SCOPE)
  set(${files} "${found_files}" PARENT_SCOPE)
endfunction()

# Where tests find and leave files; the same names are environment variables for scripts.
set(KNOTWORK_DATA_DIR "${CMAKE_SOURCE_DIR}/Testing/Data")
set(KNOTWORK_BASELINE_DIR "${CMAKE_SOURCE_DIR}/Testing/Baseline")
set(KNOTWORK_OUTPUT_DIR "${CMAKE_BINARY_DIR}/Testing/Temporary")
file(MAKE_DIRECTORY "${KNOTWORK_OUTPUT_DIR}")
set(KNOTWORK_WITH_DISPLAY "${CMAKE_SOURCE_DIR}/CMake/with-display.sh")

# A list of labels as gtest_discover_tests wants it: the key repeated (of "a;b" it keeps only the first).
function(knotwork_label_properties out)
  set(properties "")
  foreach(label IN LISTS ARGN)
    list(APPEND properties LABELS ${label})
  endforeach()
  set(${out} "${properties}" PARENT_SCOPE)
endfunction()

# A GoogleTest program whose cases become the tests <MODULE>.<Suite>.<Name>.
function(knotwork_add_gtest target module)
  if(KNOTWORK_PARAVIEW) # VTK's module system enters the modules' Testing folders; the tests are the main tree's
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 2 arg "DISPLAY" "TIMEOUT;PRECOMPILED" "SOURCES;LIBRARIES;LABELS")
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  target_compile_options(${target} PRIVATE ${KNOTWORK_WARNINGS})
  foreach(name IN ITEMS KNOTWORK_DATA_DIR KNOTWORK_BASELINE_DIR KNOTWORK_OUTPUT_DIR)
    target_compile_definitions(${target} PRIVATE "${name}=\"${${name}}\"")
  endforeach()
  if(arg_PRECOMPILED)
    knotwork_precompile(${arg_PRECOMPILED} ${target})
  endif()
  if(arg_DISPLAY) # ctest starts the tests (not the discovery) through it
    set_target_properties(${target} PROPERTIES CROSSCOMPILING_EMULATOR "${KNOTWORK_WITH_DISPLAY}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  knotwork_label_properties(labels ${arg_LABELS} ${module})
  set(environment "")
  if(arg_DISPLAY AND CMAKE_CXX_FLAGS MATCHES "fsanitize=address")
    # drivers of OpenGL leak, and are unloaded before leaks are counted: no suppression can name them
    set(environment ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0:detect_stack_use_after_return=1")
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${module}." DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES ${labels} ${environment} TIMEOUT ${arg_TIMEOUT})
endfunction()

# knotwork_add_kernel_tests(MODULE [SLOW] SOURCES Kernel/Test*.cxx... [LIBRARIES target...])
function(knotwork_add_kernel_tests module)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SLOW" "" "SOURCES;LIBRARIES")
  if(NOT arg_SOURCES)
    return()
  endif()
  set(labels kernel)
  set(target ${module}KernelTests)
  if(arg_SLOW)
    list(APPEND labels slow)
    set(target ${module}KernelSlowTests)
  endif()
  knotwork_add_gtest(${target} ${module} SOURCES ${arg_SOURCES} LABELS ${labels}
    PRECOMPILED kernel_tests LIBRARIES Knotwork::${module}Kernel ${arg_LIBRARIES})
  if(TARGET ${target} AND TARGET ${module}Kernel) # tests see the kernel's own headers too
    target_include_directories(${target} PRIVATE "$<TARGET_PROPERTY:${module}Kernel,KNOTWORK_FOLDERS>")
  endif()
endfunction()

# knotwork_add_filter_tests(MODULE [IMAGE] [SLOW] SOURCES Filter/Test*.cxx... [LIBRARIES target...])
#   IMAGE tests may render: they link the harness and run on a display of their own.
function(knotwork_add_filter_tests module)
  cmake_parse_arguments(PARSE_ARGV 1 arg "IMAGE;SLOW" "" "SOURCES;LIBRARIES")
  if(NOT KNOTWORK_FILTERS OR NOT TARGET Knotwork::${module} OR NOT arg_SOURCES)
    return()
  endif()
  set(kind "")
  set(labels filter)
  set(display "")
  set(libraries Knotwork::${module} VTK::FiltersExtraction VTK::FiltersGeneral VTK::FiltersGeometry
    VTK::FiltersSources VTK::IOXML VTK::IOLegacy ${arg_LIBRARIES})
  if(arg_IMAGE)
    string(APPEND kind Image)
    list(APPEND labels image)
    set(display DISPLAY)
    list(APPEND libraries Knotwork::TestingHarness)
  endif()
  if(arg_SLOW)
    string(APPEND kind Slow)
    list(APPEND labels slow)
  endif()
  knotwork_add_gtest(${module}Filter${kind}Tests ${module} ${display} SOURCES ${arg_SOURCES}
    LABELS ${labels} PRECOMPILED filter_tests LIBRARIES ${libraries})
endfunction()

# A test that runs a command with the scripts' environment. Exit status 77: it is listed as skipped.
# knotwork_add_command_test(NAME [DISPLAY] LABELS label... COMMAND command... [TIMEOUT s])
function(knotwork_add_command_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "DISPLAY" "TIMEOUT" "LABELS;COMMAND;ENVIRONMENT")
  if(arg_DISPLAY)
    list(PREPEND arg_COMMAND "${KNOTWORK_WITH_DISPLAY}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  add_test(NAME ${name} COMMAND ${arg_COMMAND})
  list(APPEND arg_ENVIRONMENT "KNOTWORK_BIN_DIR=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}" PYTHONDONTWRITEBYTECODE=1)
  foreach(dir IN ITEMS KNOTWORK_DATA_DIR KNOTWORK_BASELINE_DIR KNOTWORK_OUTPUT_DIR)
    list(APPEND arg_ENVIRONMENT "${dir}=${${dir}}")
  endforeach()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${arg_LABELS}" SKIP_RETURN_CODE 77
    ENVIRONMENT "${arg_ENVIRONMENT}")
endfunction()

# knotwork_add_python_test(MODULE script.py [IMAGE] [SLOW] [PROGRAM] [TIMEOUT s] [LABELS label...] [ARGUMENTS ...])
#   Runs the script on the Python that has VTK with `import knotwork` and `import knotwork_testing` at hand; exit
#   status 0 passes. PROGRAM: the script runs the program and does not import knotwork. The test is <MODULE>.Python.<script>.
function(knotwork_add_python_test module script)
  cmake_parse_arguments(PARSE_ARGV 2 arg "IMAGE;SLOW;PROGRAM" "NAME;TIMEOUT" "LABELS;ARGUMENTS")
  if(NOT KNOTWORK_FILTERS OR (NOT KNOTWORK_PYTHON AND NOT arg_PROGRAM))
    return()
  endif()
  get_filename_component(path "${script}" ABSOLUTE)
  get_filename_component(stem "${script}" NAME_WE)
  if(arg_NAME)
    set(stem "${arg_NAME}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set(labels python ${module} ${arg_LABELS})
  set(display "")
  if(arg_IMAGE)
    list(APPEND labels image)
    set(display DISPLAY)
  endif()
  if(arg_SLOW)
    list(APPEND labels slow)
  endif()
  knotwork_add_command_test(${module}.Python.${stem} ${display} LABELS ${labels}
    COMMAND "${Python3_EXECUTABLE}" "${path}" ${arg_ARGUMENTS}
    TIMEOUT ${arg_TIMEOUT}
    ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/${KNOTWORK_PYTHON_DIR}:${CMAKE_SOURCE_DIR}/Testing/Harness")
endfunction()

# knotwork_add_paraview_test(MODULE script.py [SLOW] [PROGRAM program] [TIMEOUT s] [ARGUMENTS ...])
#   Runs the script in pvbatch (PROGRAM: in another one, that starts pvbatch itself) with the plugin of the ParaView build
#   tree at hand (KNOTWORK_PARAVIEW_TREE); the test is <MODULE>.ParaView.<script>. Without such a tree configured there are no
#   ParaView tests.
function(knotwork_add_paraview_test module script)
  cmake_parse_arguments(PARSE_ARGV 2 arg "SLOW" "PROGRAM;TIMEOUT" "LABELS;ARGUMENTS")
  if(NOT KNOTWORK_PARAVIEW_TREE)
    return()
  endif()
  if(NOT arg_PROGRAM)
    set(arg_PROGRAM pvbatch)
  endif()
  get_filename_component(path "${script}" ABSOLUTE)
  get_filename_component(stem "${script}" NAME_WE)
  set(labels paraview ${module} ${arg_LABELS})
  if(arg_SLOW)
    list(APPEND labels slow)
  endif()
  knotwork_add_command_test(${module}.ParaView.${stem} DISPLAY LABELS ${labels} TIMEOUT ${arg_TIMEOUT}
    COMMAND "${arg_PROGRAM}" "${path}" ${arg_ARGUMENTS}
    ENVIRONMENT
      "PYTHONPATH=${KNOTWORK_PARAVIEW_PREFIX}/usr/lib/python3/dist-packages:${CMAKE_SOURCE_DIR}/Testing/Harness"
      "KNOTWORK_PLUGIN=${KNOTWORK_PARAVIEW_TREE}/lib/knotwork-paraview/Knotwork/Knotwork.so")
endfunction()
