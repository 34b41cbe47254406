# SPDX-License-Identifier: BSD-3-Clause
# What find_package(Knotwork) reads, in the install tree and in the build tree.
include(CMakePackageConfigHelpers)
get_property(kernels GLOBAL PROPERTY KNOTWORK_KERNELS)
set(KNOTWORK_COMPONENTS ${kernels} ${KNOTWORK_FILTER_MODULES})
list(TRANSFORM KNOTWORK_COMPONENTS REPLACE "^Knotwork::" "")
set(package_dir "${CMAKE_BINARY_DIR}/${KNOTWORK_CMAKE_DIR}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/KnotworkConfig.cmake.in" "${package_dir}/KnotworkConfig.cmake"
  INSTALL_DESTINATION "${KNOTWORK_CMAKE_DIR}")
write_basic_package_version_file("${package_dir}/KnotworkConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${package_dir}/KnotworkConfig.cmake" "${package_dir}/KnotworkConfigVersion.cmake"
  DESTINATION "${KNOTWORK_CMAKE_DIR}")

if(kernels)
  install(EXPORT KnotworkKernels NAMESPACE Knotwork:: FILE Knotwork-kernels.cmake DESTINATION "${KNOTWORK_CMAKE_DIR}")
  export(EXPORT KnotworkKernels NAMESPACE Knotwork:: FILE "${package_dir}/Knotwork-kernels.cmake")
endif()
install(FILES "${CMAKE_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
