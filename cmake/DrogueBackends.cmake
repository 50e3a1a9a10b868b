# The compiled-in backends, and the files that are written once for each of them.

option(DROGUE_SERIAL "The Serial backend" ON)
option(DROGUE_OPENMP "The OpenMP backend, where Kokkos has it" ON)

set(DROGUE_BACKENDS)
if(DROGUE_SERIAL)
  list(APPEND DROGUE_BACKENDS serial)
  set(DROGUE_EXECUTION_SPACE_serial Kokkos::Serial)
endif()
if(DROGUE_OPENMP AND Kokkos_ENABLE_OPENMP)
  list(APPEND DROGUE_BACKENDS openmp)
  set(DROGUE_EXECUTION_SPACE_openmp Kokkos::OpenMP)
endif()
if(DROGUE_CUDA)
  list(APPEND DROGUE_BACKENDS cuda)
  set(DROGUE_EXECUTION_SPACE_cuda Kokkos::Cuda)
endif()
if(NOT DROGUE_BACKENDS)
  message(FATAL_ERROR "There is no backend left: turn DROGUE_SERIAL, DROGUE_OPENMP or DROGUE_CUDA on.")
endif()

# Writes NAME_<backend>.cpp from NAME.cpp.in for each backend and appends the names to `sources`.
# The template may use @DROGUE_BACKEND@ (serial), @DROGUE_BACKEND_ENUM@ (the same word, as an enumerator) and
# @DROGUE_EXECUTION_SPACE@ (Kokkos::Serial).
function(drogue_instantiate sources template)
  cmake_path(RELATIVE_PATH template BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE _relative)
  string(REGEX REPLACE "\\.cpp\\.in$" "" _stem "${_relative}")
  set(_generated ${${sources}})
  foreach(DROGUE_BACKEND IN LISTS DROGUE_BACKENDS)
    set(DROGUE_BACKEND_ENUM ${DROGUE_BACKEND})
    set(DROGUE_EXECUTION_SPACE ${DROGUE_EXECUTION_SPACE_${DROGUE_BACKEND}})
    set(_file "${PROJECT_BINARY_DIR}/generated/${_stem}_${DROGUE_BACKEND}.cpp")
    configure_file("${template}" "${_file}" @ONLY)
    # The instances of a template use the same aliases, each for its backend.
    set_source_files_properties("${_file}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    list(APPEND _generated "${_file}")
  endforeach()
  set(${sources} ${_generated} PARENT_SCOPE)
endfunction()

# drogue_includes_kokkos(result <file>): whether it does, itself or by our headers that it includes.
function(drogue_includes_kokkos result file)
  file(STRINGS "${file}" _lines REGEX "^#include [<\"](Kokkos_|[a-z]+/).*")
  set(${result} NO PARENT_SCOPE)
  foreach(_line IN LISTS _lines)
    if(_line MATCHES "<Kokkos_")
      set(_found YES)
    elseif(_line MATCHES "\"(.*)\"" AND EXISTS "${PROJECT_SOURCE_DIR}/${CMAKE_MATCH_1}")
      drogue_includes_kokkos(_found "${PROJECT_SOURCE_DIR}/${CMAKE_MATCH_1}")
    endif()
    if(_found)
      set(${result} YES PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Sources that include Kokkos go through nvcc in a CUDA build.
function(drogue_use_device_language)
  if(DROGUE_CUDA)
    set_source_files_properties(${ARGN} PROPERTIES LANGUAGE CUDA)
  endif()
endfunction()
