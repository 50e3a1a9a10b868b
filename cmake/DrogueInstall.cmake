# Installs the CMake package Drogue, with the kernels and its component framework, and the programs.

include(CMakePackageConfigHelpers)

set(_package "${CMAKE_INSTALL_LIBDIR}/cmake/Drogue")
install(TARGETS drogue_kernels drogue_arithmetic EXPORT DrogueTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
set_target_properties(drogue_kernels PROPERTIES EXPORT_NAME kernels)
set_target_properties(drogue_arithmetic PROPERTIES EXPORT_NAME arithmetic)
install(EXPORT DrogueTargets NAMESPACE Drogue:: DESTINATION "${_package}")
# The component for mini-apps outside of this repository.
install(TARGETS drogue_common drogue_framework EXPORT DrogueFrameworkTargets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
set_target_properties(drogue_common PROPERTIES EXPORT_NAME common)
set_target_properties(drogue_framework PROPERTIES EXPORT_NAME framework)
install(EXPORT DrogueFrameworkTargets NAMESPACE Drogue:: DESTINATION "${_package}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/common" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/drogue"
  FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/miniapps/framework" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/drogue/miniapps"
  FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/kernels" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/drogue"
  FILES_MATCHING PATTERN "*.hpp" PATTERN "reference" EXCLUDE)

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/DrogueConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/DrogueConfig.cmake" INSTALL_DESTINATION "${_package}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/DrogueConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/DrogueConfig.cmake" "${PROJECT_BINARY_DIR}/DrogueConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindFFTW.cmake" "${PROJECT_SOURCE_DIR}/cmake/FindHYPRE.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindNCCL.cmake"
  DESTINATION "${_package}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/miniapps/options/batches/"
  DESTINATION "${CMAKE_INSTALL_DATADIR}/drogue/batches" FILES_MATCHING PATTERN "*.csv")
if(DROGUE_CUDA)
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/cuda13_kokkos45.hpp" DESTINATION "${_package}")
endif()
