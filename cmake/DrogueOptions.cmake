# Compiler settings of our own targets, as two interface targets:
#   drogue_arithmetic  options that decide rounding; exported, so that users of the kernels compile alike
#   drogue_private     warnings, include root, sanitizers; never exported

option(DROGUE_EXACT "No fused multiply-add: backends agree bit for bit" OFF)
option(DROGUE_WARNINGS_AS_ERRORS "Stop at a warning in our own code" OFF)
option(DROGUE_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
option(DROGUE_UNITY "Compile several sources without instances of kernels as one" ON)
option(DROGUE_SYSTEM "Ignore build/deps: take every library from the system" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_EXTENSIONS OFF)
# CMake 3.25 lacks nvcc's option for C++20.
if(DROGUE_CUDA AND NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
endif()
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# A program loads only the libraries that it calls: hypre alone needs twenty others.
add_link_options(LINKER:--as-needed)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

if(DROGUE_HIP AND NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "DROGUE_HIP=ON, but the C++ compiler ${CMAKE_CXX_COMPILER} (${CMAKE_CXX_COMPILER_ID}) compiles no HIP: "
                      "configure with -DCMAKE_CXX_COMPILER=hipcc, or unset CXX and remove the build folder.")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
  message(FATAL_ERROR "g++ ${CMAKE_CXX_COMPILER_VERSION} is too old for C++20 as used here: install g++-12 or newer "
                      "and pass -DCMAKE_CXX_COMPILER=g++-12.")
endif()

# Gives `target` a host-compiler option in both languages: nvcc hands it on with -Xcompiler.
function(drogue_host_option target scope)
  foreach(_option IN LISTS ARGN)
    target_compile_options(${target} ${scope}
      "$<$<COMPILE_LANGUAGE:CXX>:${_option}>" "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=${_option}>")
  endforeach()
endfunction()

add_library(drogue_arithmetic INTERFACE)
# Neither flag changes a rounding: without errno and traps loops vectorise.
drogue_host_option(drogue_arithmetic INTERFACE -fno-math-errno -fno-trapping-math)
# Options of the host compiler without fused operations. In spite of the first, gcc 12.2 fuses products of complex numbers where it
# vectorises code outside of loops; tests/exact/test_unfused.py reads the machine code.
set(_unfused -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND _unfused -fno-tree-slp-vectorize)
endif()
set(DROGUE_UNFUSED_OPTIONS "${_unfused}" CACHE INTERNAL "options of the host compiler in the preset exact")
if(DROGUE_EXACT)
  drogue_host_option(drogue_arithmetic INTERFACE ${DROGUE_UNFUSED_OPTIONS})
  target_compile_options(drogue_arithmetic INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:--fmad=false>)
  target_compile_definitions(drogue_arithmetic INTERFACE DROGUE_EXACT=1)
endif()

add_library(drogue_private INTERFACE)
target_link_libraries(drogue_private INTERFACE drogue_arithmetic)
target_include_directories(drogue_private INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
drogue_host_option(drogue_private INTERFACE -Wall -Wextra -Wshadow -Wconversion)
# nvcc writes line directives that -Wpedantic rejects, so it is for the host compiler alone.
target_compile_options(drogue_private INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wpedantic>)
# nvcc writes named initialisers as unnamed ones, of which the host compiler then misses the members that are left out.
target_compile_options(drogue_private INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wno-missing-field-initializers>)
# gcc 12 invents overlapping copies in inlined std::string code (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  drogue_host_option(drogue_private INTERFACE -Wno-restrict)
  # In a unity build every source is an included file, where gcc warns of anonymous members of its own classes.
  if(CMAKE_UNITY_BUILD)
    target_compile_options(drogue_private INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>)
  endif()
endif()
# Clang's -Wconversion warns of indices of another signedness, which that of gcc does not.
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  drogue_host_option(drogue_private INTERFACE -Wno-sign-conversion)
endif()
# nvcc only warns of a host function that a kernel calls, and the kernel then does nothing.
target_compile_options(drogue_private INTERFACE "$<$<COMPILE_LANGUAGE:CUDA>:--diag-error=20011,20013,20014,20015>")
if(DROGUE_WARNINGS_AS_ERRORS)
  drogue_host_option(drogue_private INTERFACE -Werror)
  target_compile_options(drogue_private INTERFACE "$<$<COMPILE_LANGUAGE:CUDA>:--Werror=cross-execution-space-call>")
endif()
if(DROGUE_SANITIZE)
  # The address sanitizer finds null pointers and ends of objects too; these checks take a quarter of the compile time.
  drogue_host_option(drogue_private INTERFACE -fsanitize=address,undefined
    -fno-sanitize=null,alignment,object-size -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Each check holds a pointer to its source line; a position-independent program would relocate all of them at each start.
  target_link_options(drogue_private INTERFACE -fsanitize=address,undefined -no-pie)
  # gcc 12 gives false warnings about instrumented variables.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    drogue_host_option(drogue_private INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

# Numerical code is optimised under sanitizers too: for the rest the compile time exceeds the time that its tests gain. Uses of a
# variable after its scope are not checked there: gcc then keeps every inlined variable in memory, and compiles gas/instances/stage
# in 29 s in place of 11 s of processor time (gcc 12.2). Tests compile most kernels anew, without optimisation and with this check.
function(drogue_optimise_sanitized target)
  if(DROGUE_SANITIZE)
    target_compile_options(${target} PRIVATE -O1 -fno-sanitize-address-use-after-scope)
  endif()
endfunction()

# Code that reads, writes and decides takes longer to optimise than it runs.
function(drogue_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>)
endfunction()

# Compiles sources with an optimisation of their own in a release, such as -O2 for code that runs once per row of a batch. Not in
# a unity build, which would have to leave them out. Headers are precompiled for one optimisation.
function(drogue_optimise_sources optimisation)
  if(NOT CMAKE_UNITY_BUILD)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS "$<$<CONFIG:Release>:${optimisation}>")
    set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# drogue_precompile_standard(<target> [header...]): precompiles the headers of the standard library that most sources without
# Kokkos read, half of their compile time, and others. tests/layering finds a standard header that a source uses and does not
# include.
function(drogue_precompile_standard target)
  if(NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory>
      <optional> <span> <sstream> <stdexcept> <string> <string_view> <utility> <variant> <vector> ${ARGN})
  endif()
endfunction()

# drogue_share_standard(<target> <other>): takes them from another target with the same options, which precompiles them.
function(drogue_share_standard target other)
  if(NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()

# drogue_share_kokkos(<target>): takes Kokkos from the compiled headers of drogue_kernels, with the same options and macros.
function(drogue_share_kokkos target)
  if(NOT DROGUE_CUDA)
    target_compile_definitions(${target} PRIVATE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)
    target_precompile_headers(${target} REUSE_FROM drogue_kernels)
  endif()
endfunction()

# drogue_unite(<sources> <name>): replaces the sources in a list, which are no instances of kernels, by fewer ones that include up to
# eight each, which read their headers once. Unlike CMake's unity builds they name paths relative to the repository, so that the
# compiler cache serves other clones. tests/layering finds a type of this repository that a source uses without its header.
function(drogue_unite sources name)
  if(CMAKE_UNITY_BUILD OR NOT DROGUE_UNITY OR NOT ${sources})
    return()
  endif()
  list(TRANSFORM ${sources} REPLACE "^${PROJECT_SOURCE_DIR}/(.*)" "#include \"\\1\"\n" OUTPUT_VARIABLE _includes)
  list(LENGTH _includes _count)
  math(EXPR _parts "(${_count} + 7) / 8")
  set(_result)
  foreach(_part RANGE 1 ${_parts})
    math(EXPR _begin "(${_part} - 1) * ${_count} / ${_parts}")
    math(EXPR _size "${_part} * ${_count} / ${_parts} - ${_begin}")
    list(SUBLIST _includes ${_begin} ${_size} _of_part)
    list(JOIN _of_part "" _content)
    set(_united "${PROJECT_BINARY_DIR}/generated/united/${name}_${_part}.cpp")
    file(CONFIGURE OUTPUT "${_united}" CONTENT "${_content}" @ONLY)
    # An included file is no source for gcc, which warns of anonymous members of its classes.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      set_source_files_properties("${_united}" PROPERTIES COMPILE_OPTIONS "$<$<COMPILE_LANGUAGE:CXX>:-Wno-subobject-linkage>")
    endif()
    list(APPEND _result "${_united}")
  endforeach()
  set(${sources} ${_result} PARENT_SCOPE)
endfunction()

if(DROGUE_CUDA)
  # See the header: Kokkos 4.5 calls three functions by signatures that CUDA 13 dropped.
  target_compile_options(drogue_arithmetic INTERFACE
    "$<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-include ${PROJECT_SOURCE_DIR}/cmake/cuda13_kokkos45.hpp>>")
  target_compile_options(drogue_arithmetic INTERFACE $<$<COMPILE_LANGUAGE:CUDA>:--extended-lambda>)
  # Users of the kernels need the standard too, also with a CMake that lacks nvcc's option.
  target_compile_options(drogue_arithmetic INTERFACE "$<INSTALL_INTERFACE:$<$<COMPILE_LANGUAGE:CUDA>:-std=c++20>>")
endif()
