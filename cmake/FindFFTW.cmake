# Finds FFTW 3 in double precision, whose own CMake configuration many packages leave out.
#
# Defines the target FFTW::FFTW and FFTW_FOUND, FFTW_VERSION ("unknown" without pkg-config). FFTW_ROOT names another installation.

find_package(PkgConfig QUIET)
if(PKG_CONFIG_FOUND)
  pkg_check_modules(_fftw QUIET fftw3)
endif()
find_path(FFTW_INCLUDE_DIR fftw3.h HINTS ${_fftw_INCLUDE_DIRS})
find_library(FFTW_LIBRARY fftw3 HINTS ${_fftw_LIBRARY_DIRS})
set(FFTW_VERSION unknown)
if(_fftw_FOUND)
  set(FFTW_VERSION "${_fftw_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(FFTW REQUIRED_VARS FFTW_LIBRARY FFTW_INCLUDE_DIR)

if(FFTW_FOUND AND NOT TARGET FFTW::FFTW)
  add_library(FFTW::FFTW UNKNOWN IMPORTED)
  set_target_properties(FFTW::FFTW PROPERTIES
    IMPORTED_LOCATION "${FFTW_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${FFTW_INCLUDE_DIR}")
endif()
mark_as_advanced(FFTW_INCLUDE_DIR FFTW_LIBRARY)
