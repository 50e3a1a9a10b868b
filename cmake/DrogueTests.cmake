# How tests are made: one executable per label, for kernels one per area and backend.

include(GoogleTest)

# All tests that run on a backend; scripts/bundle.sh carries them to other machines.
add_custom_target(drogue_kernel_tests)

# drogue_share_headers(<test>): takes what tests include from headers that are compiled once for all of them, in a unity build.
function(drogue_share_headers target)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  drogue_test_headers()
  target_precompile_headers(${target} REUSE_FROM drogue_test_headers)
endfunction()
function(drogue_test_headers)
  if(TARGET drogue_test_headers)
    return()
  endif()
  set(_source "${PROJECT_BINARY_DIR}/generated/test_headers.cpp")
  file(CONFIGURE OUTPUT "${_source}" CONTENT "int main() {}\n")
  drogue_use_device_language("${_source}")
  # A program as the tests are: gcc takes no headers that were compiled for a library.
  add_executable(drogue_test_headers EXCLUDE_FROM_ALL "${_source}")
  target_link_libraries(drogue_test_headers PRIVATE drogue_kernels drogue_private GTest::gtest)
  drogue_optimise_little(drogue_test_headers)
  target_precompile_headers(drogue_test_headers PRIVATE <Kokkos_Core.hpp> <gtest/gtest.h>)
endfunction()

# How tests of kernels are compiled, whatever they run on.
function(drogue_kernel_test_options target)
  # Helpers of these tests have the same names in many files: a unity build shares what they include instead.
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  # What they ask of the kernels is asked of the library, which is optimised as users have it.
  drogue_optimise_little(${target})
  drogue_share_headers(${target})
endfunction()

# drogue_add_kernel_test_objects(<name> <sources>): those that name no execution space, compiled once for all backends. What
# they run on they learn from tests/support/backend.hpp.
function(drogue_add_kernel_test_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_link_libraries(${name} PRIVATE drogue_kernels drogue_reference drogue_private GTest::gtest)
  drogue_use_device_language(${ARGN})
  drogue_kernel_test_options(${name})
  # As a program is compiled: gcc takes no compiled headers of another kind.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  drogue_host_option(${name} PRIVATE -fPIE)
endfunction()

# drogue_add_test(NAME <name> SOURCES <files> LABEL <label> [OBJECTS <files>] [LIBRARIES <targets>] [BACKEND <backend>])
# One GoogleTest executable; each of its cases becomes a ctest test `<label>.<Suite>.<Case>`.
# With BACKEND the sources see DROGUE_TEST_SPACE (Kokkos::OpenMP), go through nvcc in a CUDA build, and a test of the cuda backend
# has the label gpu. A name that ends in _long has the label long.
function(drogue_add_test)
  cmake_parse_arguments(_test "" "NAME;LABEL;BACKEND" "SOURCES;OBJECTS;LIBRARIES" ${ARGN})
  add_executable(${_test_NAME} ${_test_SOURCES} ${_test_OBJECTS})
  set_target_properties(${_test_NAME} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  target_link_libraries(${_test_NAME} PRIVATE ${_test_LIBRARIES} drogue_private GTest::gtest)
  target_compile_definitions(${_test_NAME} PRIVATE
    DROGUE_SOURCE_DIR="${PROJECT_SOURCE_DIR}" DROGUE_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  set(_prefix "${_test_LABEL}.")
  set(_label ${_test_LABEL})
  set(_threads 1)
  if(_test_BACKEND)
    drogue_use_device_language(${_test_SOURCES})
    drogue_kernel_test_options(${_test_NAME})
    target_compile_definitions(${_test_NAME} PRIVATE DROGUE_TEST_SPACE=${DROGUE_EXECUTION_SPACE_${_test_BACKEND}})
    string(APPEND _prefix "${_test_BACKEND}.")
    if(_test_BACKEND STREQUAL "cuda")
      set(_label gpu)
    elseif(_test_BACKEND STREQUAL "openmp")
      set(_threads 2)
    endif()
  endif()
  if(_test_BACKEND OR _test_LABEL STREQUAL "exact")
    add_dependencies(drogue_kernel_tests ${_test_NAME})
  endif()
  if(_test_NAME MATCHES "_long(_[a-z]+)?$" AND NOT _label STREQUAL "gpu")
    set(_label long)
  endif()
  # Listing the cases before a test run, not while building, lets a machine without a GPU build the CUDA tests. A test of
  # two threads counts as work for one core: most of it is its oracle's, and threads that wait do so without turning.
  gtest_discover_tests(${_test_NAME} TEST_PREFIX "${_prefix}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${_label}" TIMEOUT 600 ENVIRONMENT "OMP_NUM_THREADS=${_threads};OMP_WAIT_POLICY=passive")
endfunction()

# drogue_add_python_test(<file> <label>): a unittest module, run with the standard library's runner.
# Its environment names the programs (DROGUE_BIN), the sources (DROGUE_SOURCE) and the build folder (DROGUE_BUILD).
function(drogue_add_python_test file label)
  cmake_path(GET file PARENT_PATH _folder)
  cmake_path(GET file FILENAME _filename)
  cmake_path(GET file STEM _stem)
  if(_stem MATCHES "_long$")
    set(_labels long)
  else()
    set(_labels "${label}")
  endif()
  set(_name "${label}.${_stem}")
  add_test(NAME "${_name}"
    COMMAND "${Python3_EXECUTABLE}" -B -m unittest discover -v -s "${_folder}" -t "${_folder}" -p "${_filename}")
  # These are the long ones: first, so that none is left alone at the end. Threads that wait leave the cores to other tests.
  set_tests_properties("${_name}" PROPERTIES LABELS "${_labels}" COST 100 TIMEOUT 900 ENVIRONMENT
    "DROGUE_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};DROGUE_SOURCE=${PROJECT_SOURCE_DIR};DROGUE_BUILD=${PROJECT_BINARY_DIR};OMP_NUM_THREADS=2;OMP_WAIT_POLICY=passive")
endfunction()

# drogue_first_include(result <header>): the header of ours with which it begins, or nothing.
function(drogue_first_include result header)
  file(STRINGS "${header}" _lines LIMIT_COUNT 2 REGEX "^[^/]")
  list(POP_BACK _lines _second)
  set(${result} "" PARENT_SCOPE)
  if(_lines STREQUAL "#pragma once" AND _second MATCHES "^#include \"(.*)\"")
    set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  endif()
endfunction()

# drogue_add_header_test(<headers>): compiles every header alone, twice in one source, as part of the build. A header that begins
# with another shows that that one compiles alone, too: its source includes both. Those that include Kokkos find it compiled
# already, which shows nothing of one that does not.
function(drogue_add_header_test)
  foreach(_header IN LISTS ARGN)
    cmake_path(RELATIVE_PATH _header BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE _name)
    drogue_includes_kokkos(_kokkos_of_${_name} "${_header}")
    list(APPEND _names "${_name}")
  endforeach()
  set(_shown)
  foreach(_name IN LISTS _names)
    drogue_first_include(_first "${PROJECT_SOURCE_DIR}/${_name}")
    set(_first_of_${_name})
    if(_first IN_LIST _names AND _kokkos_of_${_first} STREQUAL _kokkos_of_${_name})
      set(_first_of_${_name} "${_first}")
      list(APPEND _shown "${_first}")
    endif()
  endforeach()
  set(_plain)
  set(_kokkos)
  foreach(_name IN LISTS _names)
    if(_name IN_LIST _shown)
      continue()
    endif()
    set(_source "${PROJECT_BINARY_DIR}/generated/headers/${_name}.cpp")
    set(_content "#include \"${_name}\"\n")
    set(_next "${_name}")
    while(_next)
      string(APPEND _content "#include \"${_next}\"\n")
      set(_next "${_first_of_${_next}}")
    endwhile()
    file(CONFIGURE OUTPUT "${_source}" CONTENT "${_content}")
    if(_kokkos_of_${_name})
      list(APPEND _kokkos "${_source}")
    else()
      list(APPEND _plain "${_source}")
    endif()
  endforeach()
  add_library(drogue_header_test OBJECT ${_plain})
  add_library(drogue_kokkos_header_test OBJECT ${_kokkos})
  target_precompile_headers(drogue_kokkos_header_test PRIVATE <Kokkos_Core.hpp>)
  foreach(_test drogue_header_test drogue_kokkos_header_test)
    target_link_libraries(${_test} PRIVATE drogue_gas_app drogue_springs_app drogue_options_app drogue_private drogue_toml muparser::muparser)
    # Each is to compile alone. Nothing runs: only whether it compiles is asked.
    set_target_properties(${_test} PROPERTIES UNITY_BUILD OFF)
    target_compile_options(${_test} PRIVATE -O0)
  endforeach()
endfunction()
