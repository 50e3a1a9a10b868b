# Finds hypre, which Debian ships without a CMake configuration.
#
# Defines the target HYPRE::HYPRE and HYPRE_FOUND, HYPRE_VERSION, HYPRE_PARALLEL (built with MPI).
# HYPRE_ROOT names another installation.

find_path(HYPRE_INCLUDE_DIR HYPRE.h PATH_SUFFIXES hypre)
find_library(HYPRE_LIBRARY HYPRE)

if(HYPRE_INCLUDE_DIR AND EXISTS "${HYPRE_INCLUDE_DIR}/HYPRE_config.h")
  file(STRINGS "${HYPRE_INCLUDE_DIR}/HYPRE_config.h" _hypre_version REGEX "define +HYPRE_RELEASE_VERSION +")
  string(REGEX REPLACE ".*\"([^\"]+)\".*" "\\1" HYPRE_VERSION "${_hypre_version}")
  file(STRINGS "${HYPRE_INCLUDE_DIR}/HYPRE_config.h" _hypre_serial REGEX "define +HYPRE_SEQUENTIAL +1")
  if(_hypre_serial)
    set(HYPRE_PARALLEL FALSE)
  else()
    set(HYPRE_PARALLEL TRUE)
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HYPRE REQUIRED_VARS HYPRE_LIBRARY HYPRE_INCLUDE_DIR VERSION_VAR HYPRE_VERSION)

if(HYPRE_FOUND AND NOT TARGET HYPRE::HYPRE)
  add_library(HYPRE::HYPRE UNKNOWN IMPORTED)
  set_target_properties(HYPRE::HYPRE PROPERTIES
    IMPORTED_LOCATION "${HYPRE_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${HYPRE_INCLUDE_DIR}")
endif()
mark_as_advanced(HYPRE_INCLUDE_DIR HYPRE_LIBRARY)
