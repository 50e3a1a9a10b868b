# Choices that must be made before project(): build type, compiler cache, GPU architecture.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()

option(DROGUE_CUDA "Build the CUDA backend; needs nvcc and a Kokkos with CUDA" OFF)
option(DROGUE_HIP "Build the HIP backend; needs hipcc and a Kokkos with HIP" OFF)
set(DROGUE_CUDA_ARCH 90 CACHE STRING "GPU architecture: 80, 86, 89, 90, 100 or native")
set_property(CACHE DROGUE_CUDA_ARCH PROPERTY STRINGS 80 86 89 90 100 native)

find_program(DROGUE_CCACHE ccache)
mark_as_advanced(DROGUE_CCACHE)
if(DROGUE_CCACHE)
  # Without this sloppiness ccache keeps no object that takes precompiled headers, which are most. Paths below the sources count
  # relative to them, so that another clone on the same machine finds the objects too.
  set(_launcher "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}"
    CCACHE_NOHASHDIR=1 "${DROGUE_CCACHE}")
  foreach(_language C CXX CUDA)
    if(NOT DEFINED CMAKE_${_language}_COMPILER_LAUNCHER)
      set(CMAKE_${_language}_COMPILER_LAUNCHER "${_launcher}")
    endif()
  endforeach()
endif()

if(DROGUE_CUDA AND DROGUE_HIP)
  message(FATAL_ERROR "DROGUE_CUDA and DROGUE_HIP are both ON, and Kokkos has one device backend: choose one.")
endif()
if(DROGUE_CUDA)
  include(DrogueCuda)
endif()
# The C++ compiler of a HIP build compiles for the device too; Kokkos names the architecture. CMake precompiles headers for the host
# alone.
if(DROGUE_HIP)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
if(DROGUE_HIP AND NOT CMAKE_CXX_COMPILER AND NOT DEFINED ENV{CXX})
  find_program(CMAKE_CXX_COMPILER NAMES hipcc amdclang++ HINTS ENV ROCM_PATH PATHS /opt/rocm PATH_SUFFIXES bin)
  if(NOT CMAKE_CXX_COMPILER)
    message(FATAL_ERROR "DROGUE_HIP=ON needs hipcc: run scripts/setup.sh --hip, load a module of ROCm, or set CMAKE_CXX_COMPILER.")
  endif()
endif()
