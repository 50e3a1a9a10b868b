# The list of backends, which programs, tests and benchmarks share, and the sources that are compiled once for each of them.

option(DROGUE_SERIAL "The Serial backend" ON)
option(DROGUE_OPENMP "The OpenMP backend, where Kokkos has it" ON)

set(DROGUE_BACKENDS)
set(DROGUE_DEVICE_BACKENDS)
set(DROGUE_KNOWN_BACKENDS)
# drogue_backend(<name> <Kokkos option> <execution space> <wanted> [DEVICE]): an entry of the list, slowest first. The same names
# stand in kernels/device/backend_list.hpp. A backend of a DEVICE starts on no machine without one; its tests have the label gpu,
# and a build that has it tests no other.
macro(drogue_backend name option execution_space wanted)
  list(APPEND DROGUE_KNOWN_BACKENDS ${name})
  if(${wanted})
    if(NOT Kokkos_ENABLE_${option})
      message(FATAL_ERROR "The backend ${name} needs a Kokkos with Kokkos_ENABLE_${option}=ON; Kokkos at ${Kokkos_DIR} lacks it.")
    endif()
    list(APPEND DROGUE_BACKENDS ${name})
    set(DROGUE_EXECUTION_SPACE_${name} ${execution_space})
    if("${ARGN}" STREQUAL "DEVICE")
      list(APPEND DROGUE_DEVICE_BACKENDS ${name})
    endif()
  endif()
endmacro()

set(_openmp ${DROGUE_OPENMP})
if(NOT Kokkos_ENABLE_OPENMP)
  set(_openmp OFF)
endif()
drogue_backend(serial SERIAL Kokkos::Serial "${DROGUE_SERIAL}")
drogue_backend(openmp OPENMP Kokkos::OpenMP "${_openmp}")
drogue_backend(cuda CUDA Kokkos::Cuda "${DROGUE_CUDA}" DEVICE)
if(NOT DROGUE_BACKENDS)
  message(FATAL_ERROR "No backend is left: turn DROGUE_SERIAL, DROGUE_OPENMP or DROGUE_CUDA on.")
endif()

# drogue_instantiate(sources <file>): appends one generated source per backend, which includes the file with
# DROGUE_INSTANCE_SPACE defined as the backend's execution space. Sources of one target keep one language setting and one
# compiled header, which a library per backend would not share.
function(drogue_instantiate sources file)
  cmake_path(RELATIVE_PATH file BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE _relative)
  string(REGEX REPLACE "\\.cpp$" "" _stem "${_relative}")
  set(_instances ${${sources}})
  foreach(_backend IN LISTS DROGUE_BACKENDS)
    set(_instance "${PROJECT_BINARY_DIR}/generated/${_stem}_${_backend}.cpp")
    file(CONFIGURE OUTPUT "${_instance}" CONTENT
      "#define DROGUE_INSTANCE_SPACE ${DROGUE_EXECUTION_SPACE_${_backend}}\n#include \"${_relative}\"\n")
    # Two backends define the macro differently.
    set_source_files_properties("${_instance}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    list(APPEND _instances "${_instance}")
  endforeach()
  set(${sources} ${_instances} PARENT_SCOPE)
endfunction()

# drogue_includes_kokkos(result <file>): YES if the file includes Kokkos, itself or through own headers.
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

# drogue_unite_device(sources name): replaces those of `sources` that nvcc compiles by one that includes them. A unity build of
# CMake leaves CUDA out before version 3.31, and nvcc takes longest to read Kokkos.
function(drogue_unite_device sources name)
  set(_kept)
  set(_includes)
  foreach(_source IN LISTS ${sources})
    get_source_file_property(_language "${_source}" LANGUAGE)
    if(_language STREQUAL "CUDA")
      string(APPEND _includes "#include \"${_source}\"\n")
    else()
      list(APPEND _kept "${_source}")
    endif()
  endforeach()
  if(_includes)
    set(_united "${PROJECT_BINARY_DIR}/generated/${name}.cpp")
    file(CONFIGURE OUTPUT "${_united}" CONTENT "${_includes}" @ONLY)
    drogue_use_device_language("${_united}")
    list(APPEND _kept "${_united}")
  endif()
  set(${sources} ${_kept} PARENT_SCOPE)
endfunction()
