# SPDX-License-Identifier: BSD-3-Clause
# Languages, folders, warnings and the libraries that every module may use.
set(CMAKE_INSTALL_LIBDIR lib CACHE PATH "Folder of libraries in the install tree") # the same for every prefix
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# One folder per kind, laid out as an install tree, so that both trees are used alike.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
# Headers that other modules may include are <knotwork/Module/Header.h> here as there: links in the build tree.
set(KNOTWORK_INCLUDE_DIR "${CMAKE_INSTALL_INCLUDEDIR}")
file(REMOVE_RECURSE "${CMAKE_BINARY_DIR}/include/knotwork")
set(KNOTWORK_CMAKE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/Knotwork")

# Programs and libraries in bin/ and lib/, Python modules three folders below lib/ (python3.x/site-packages/knotwork).
set(CMAKE_INSTALL_RPATH
  "$ORIGIN;$ORIGIN/../../..;$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")

find_program(KNOTWORK_CCACHE ccache)
mark_as_advanced(KNOTWORK_CCACHE)
if(KNOTWORK_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # what it must be told to keep what was compiled with precompiled headers
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${KNOTWORK_CCACHE}")
  set(CMAKE_C_COMPILER_LAUNCHER "${KNOTWORK_CCACHE}")
endif()

if(KNOTWORK_NATIVE)
  # For everything: code built for two instruction sets may not exchange Eigen objects.
  add_compile_options(-march=native)
endif()
# Eigen peels a sum until an entry is aligned for its packets. With packets wider than what every allocation and the
# stack are aligned to (16 bytes) the address of a buffer would decide how a sum is rounded: other bits for other
# numbers of threads. So Eigen's packets stay at 16 bytes where flags allow wider ones; the compiler uses those.
include(CheckCXXSourceCompiles)
if(KNOTWORK_NATIVE)
  set(CMAKE_REQUIRED_FLAGS -march=native)
endif()
check_cxx_source_compiles("#ifndef __AVX__\n#error\n#endif\nint main() { return 0; }" KNOTWORK_HAS_AVX)
unset(CMAKE_REQUIRED_FLAGS)
if(KNOTWORK_HAS_AVX)
  add_compile_options(-U__AVX__ -U__AVX2__ -U__AVX512F__ -U__FMA__)
endif()

set(KNOTWORK_WARNINGS -Wall -Wextra -Wshadow)
if(KNOTWORK_WERROR)
  list(APPEND KNOTWORK_WARNINGS -Werror)
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(pugixml REQUIRED)
find_package(nlohmann_json REQUIRED)
# The components below data exchange, and what its own libraries need; KnotworkConfig.cmake asks for them too.
set(KNOTWORK_OPENCASCADE_COMPONENTS FoundationClasses ModelingData ModelingAlgorithms Visualization
  ApplicationFramework DataExchange)
find_package(OpenCASCADE REQUIRED COMPONENTS ${KNOTWORK_OPENCASCADE_COMPONENTS})
if(BUILD_TESTING AND NOT KNOTWORK_PARAVIEW)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# The Python that has VTK's modules is the system's; another one may come first on PATH.
set(Python3_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "Python with VTK's modules")

# The VTK components that our modules and tests use; KnotworkConfig.cmake asks for the first list.
set(KNOTWORK_VTK_COMPONENTS CommonCore CommonDataModel CommonExecutionModel CommonMath CommonMisc
  CommonTransforms FiltersCore FiltersGeneral FiltersExtraction FiltersGeometry FiltersSources IOCore IOXML
  IOLegacy IOGeometry IOParallelXML IOPLY ParallelCore)
# Those of the program that draws pictures (knotwork-view), and those that tests use beside them.
set(KNOTWORK_VTK_PICTURE_COMPONENTS CommonColor IOImage RenderingAnnotation RenderingCore RenderingFreeType RenderingOpenGL2)
set(KNOTWORK_VTK_TEST_COMPONENTS ImagingCore InteractionStyle)
