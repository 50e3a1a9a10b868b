# How tests are made: one executable per label, for kernels one per area and backend.

include(GoogleTest)

# All tests that run on a backend; scripts/bundle.sh carries them to other machines.
add_custom_target(drogue_kernel_tests)
# The tests with the label exact: those of tests/exact, and on the first backend those that a marker names.
add_custom_target(drogue_exact_tests)

# drogue_share_headers(<test>): the test takes Kokkos and GoogleTest from headers precompiled for all tests; nvcc takes none.
# tests/layering finds a standard header that a test uses and does not include.
function(drogue_share_headers target)
  if(NOT DROGUE_CUDA)
    drogue_test_headers()
    target_precompile_headers(${target} REUSE_FROM drogue_test_headers)
  endif()
endfunction()
function(drogue_test_headers)
  if(TARGET drogue_test_headers)
    return()
  endif()
  set(_source "${PROJECT_BINARY_DIR}/generated/test_headers.cpp")
  file(CONFIGURE OUTPUT "${_source}" CONTENT "int main() {}\n")
  drogue_use_device_language("${_source}")
  # A program, like the tests: gcc accepts no precompiled headers of a library.
  add_executable(drogue_test_headers EXCLUDE_FROM_ALL "${_source}")
  target_link_libraries(drogue_test_headers PRIVATE drogue_kernels drogue_private GTest::gtest)
  drogue_optimise_little(drogue_test_headers)
  target_precompile_headers(drogue_test_headers PRIVATE <Kokkos_Core.hpp> <gtest/gtest.h>)
endfunction()

# Options of all kernel tests, on any backend.
function(drogue_kernel_test_options target)
  # Helpers of these tests have the same names in many files: they share precompiled headers instead of a unity source.
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  # The library under test is optimised as users have it; the tests themselves need not be.
  drogue_optimise_little(${target})
  drogue_share_headers(${target})
endfunction()

# drogue_add_kernel_test_objects(<name> <sources>): test sources without an execution space, compiled once for all backends. They
# run on the backend of tests/support/backend.hpp.
function(drogue_add_kernel_test_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_link_libraries(${name} PRIVATE drogue_kernels drogue_reference drogue_private GTest::gtest)
  drogue_use_device_language(${ARGN})
  drogue_kernel_test_options(${name})
  # Compiled like a program: gcc accepts no precompiled headers of another kind.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  drogue_host_option(${name} PRIVATE -fPIE)
endfunction()

# drogue_add_test(NAME <name> SOURCES <files> LABEL <label> [OBJECTS <files>] [LIBRARIES <targets>] [BACKEND <backend>]
#   [CASES <files>])
# One GoogleTest executable; each of its cases becomes a ctest test `<label>.<Suite>.<Case>`. CASES are the sources whose markers
# `// ctest-label: NAME...` give cases more labels (cmake/test_properties.cmake), by default SOURCES.
# With BACKEND the sources see DROGUE_TEST_SPACE (Kokkos::OpenMP), go through nvcc in a CUDA build, and a test of a device backend
# has the label gpu. A name that ends in _long has the label long.
function(drogue_add_test)
  cmake_parse_arguments(_test "" "NAME;LABEL;BACKEND" "SOURCES;OBJECTS;LIBRARIES;CASES" ${ARGN})
  if(NOT _test_CASES)
    set(_test_CASES ${_test_SOURCES})
  endif()
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
    if(_test_BACKEND IN_LIST DROGUE_DEVICE_BACKENDS)
      set(_label gpu)
    elseif(_test_BACKEND STREQUAL "openmp")
      set(_threads 2)
    endif()
  endif()
  if(_test_BACKEND OR _test_LABEL STREQUAL "exact")
    add_dependencies(drogue_kernel_tests ${_test_NAME})
  endif()
  set(_exact_cases)
  if(NOT _test_BACKEND OR "${DROGUE_BACKENDS};" MATCHES "^${_test_BACKEND};")
    foreach(_source IN LISTS _test_CASES)
      file(STRINGS "${_source}" _marked REGEX "^// ctest-label: (.* )?exact( |$)")
      list(APPEND _exact_cases ${_marked})
    endforeach()
  endif()
  if(_exact_cases OR _test_LABEL STREQUAL "exact")
    add_dependencies(drogue_exact_tests ${_test_NAME})
  endif()
  if(_test_NAME MATCHES "_long(_[a-z]+)?$" AND NOT _label STREQUAL "gpu")
    set(_label long)
  endif()
  # Listing the cases before a test run, not while building, lets a machine without a GPU build the CUDA tests.
  gtest_discover_tests(${_test_NAME} TEST_PREFIX "${_prefix}" DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${_label}" TIMEOUT 600)
  # A test of two threads counts as work for one core: most of it is its oracle's, and waiting threads yield the core.
  set(_environment "OMP_NUM_THREADS=${_threads};OMP_WAIT_POLICY=passive")
  set(_properties "${CMAKE_CURRENT_BINARY_DIR}/${_test_NAME}_properties.cmake")
  file(CONFIGURE OUTPUT "${_properties}" @ONLY CONTENT [[
if(@_test_NAME@_TESTS)
  include("@PROJECT_SOURCE_DIR@/cmake/test_properties.cmake")
  drogue_test_properties("@_prefix@" "@_label@" "@_environment@" TESTS ${@_test_NAME@_TESTS} SOURCES "@_test_CASES@")
endif()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${_properties}")
endfunction()

# drogue_add_python_test(<file> <label>): a unittest module, run with the standard library's runner.
# Its environment names the programs (DROGUE_BIN), the sources (DROGUE_SOURCE), the build folder (DROGUE_BUILD) and the folder of
# the modules that tests share (PYTHONPATH).
# A line `# ctest-label: NAME...` before its docstring adds labels.
function(drogue_add_python_test file label)
  cmake_path(GET file PARENT_PATH _folder)
  cmake_path(GET file FILENAME _filename)
  cmake_path(GET file STEM _stem)
  if(_stem MATCHES "_long$")
    set(_labels long)
    set(_timeout 3600)
  else()
    set(_labels "${label}")
    set(_timeout 900)
  endif()
  file(STRINGS "${file}" _marked REGEX "^# ctest-label: ")
  string(REGEX REPLACE "# ctest-label: |[ ;]+" ";" _marked "${_marked}")
  list(APPEND _labels ${_marked})
  set(_name "${label}.${_stem}")
  add_test(NAME "${_name}"
    COMMAND "${Python3_EXECUTABLE}" -B -m unittest discover -v -s "${_folder}" -t "${_folder}" -p "${_filename}")
  # Python tests take longest: first, so that none runs alone at the end. Waiting threads yield their cores to other tests;
  # those of numpy's linear algebra spin, so that it gets one.
  set_tests_properties("${_name}" PROPERTIES LABELS "${_labels}" COST 100 TIMEOUT ${_timeout} ENVIRONMENT
    "DROGUE_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};DROGUE_SOURCE=${PROJECT_SOURCE_DIR};DROGUE_BUILD=${PROJECT_BINARY_DIR};PYTHONPATH=${PROJECT_SOURCE_DIR}/tests/support;OMP_NUM_THREADS=2;OMP_WAIT_POLICY=passive;OPENBLAS_NUM_THREADS=1")
endfunction()

# drogue_first_include(result <file>): the own header before which a file includes only Kokkos and standard headers, or nothing.
function(drogue_first_include result file)
  file(STRINGS "${file}" _lines REGEX "^#include ")
  list(FILTER _lines EXCLUDE REGEX "<([a-z_]+|Kokkos_Core.hpp)>")
  set(${result} "" PARENT_SCOPE)
  if(_lines MATCHES "^#include \"([^\"]+)")
    set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  endif()
endfunction()

# drogue_add_header_test(<headers and sources>): compiles alone, as part of the build, every header that none of the others includes
# first and so compiles alone. Headers that include Kokkos take it precompiled; the others are compiled without it, so that a
# missing include is found. Missing standard headers are found by tests/layering.
function(drogue_add_header_test)
  foreach(_file IN LISTS ARGN)
    cmake_path(RELATIVE_PATH _file BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE _name)
    drogue_first_include(_first_of_${_name} "${_file}")
    if(_name MATCHES "hpp$")
      list(APPEND _names "${_name}")
      drogue_includes_kokkos(_kokkos_of_${_name} "${_file}")
    else()
      list(APPEND _shown "${_first_of_${_name}}")
    endif()
  endforeach()
  foreach(_name IN LISTS _names)
    set(_first "${_first_of_${_name}}")
    if(_first AND _kokkos_of_${_first} STREQUAL _kokkos_of_${_name})
      list(APPEND _shown "${_first}")
    endif()
  endforeach()
  list(REMOVE_ITEM _names ${_shown})
  set(_plain)
  set(_kokkos)
  foreach(_name IN LISTS _names)
    set(_source "${PROJECT_BINARY_DIR}/generated/headers/${_name}.cpp")
    file(CONFIGURE OUTPUT "${_source}" CONTENT "#include \"${_name}\"\n")
    if(_kokkos_of_${_name})
      list(APPEND _kokkos "${_source}")
    else()
      list(APPEND _plain "${_source}")
    endif()
  endforeach()
  add_library(drogue_header_test OBJECT ${_plain})
  add_library(drogue_kokkos_header_test OBJECT ${_kokkos})
  drogue_precompile_standard(drogue_header_test)
  target_precompile_headers(drogue_kokkos_header_test PRIVATE <Kokkos_Core.hpp>)
  foreach(_test drogue_header_test drogue_kokkos_header_test)
    target_link_libraries(${_test} PRIVATE drogue_gas_app drogue_springs_app drogue_options_app drogue_parachute_app drogue_private drogue_toml muparser::muparser)
    # Each header compiles alone; nothing runs.
    set_target_properties(${_test} PROPERTIES UNITY_BUILD OFF)
    target_compile_options(${_test} PRIVATE -O0)
  endforeach()
endfunction()
