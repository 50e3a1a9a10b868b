# Build facts that programs print. Git hash and flags are read at build time, so that a commit recompiles one small file.

set(DROGUE_VERSION_SOURCE "${PROJECT_BINARY_DIR}/generated/common/version.cpp")
string(TOUPPER "${CMAKE_BUILD_TYPE}" _type)
get_target_property(_options drogue_arithmetic INTERFACE_COMPILE_OPTIONS)
string(REGEX MATCHALL "COMPILE_LANGUAGE:CXX>:[^>]+" _options "${_options}")
list(TRANSFORM _options REPLACE "COMPILE_LANGUAGE:CXX>:" "")
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_type}} ${_options}" DROGUE_FLAGS)
string(REPLACE ";" " " DROGUE_FLAGS "${DROGUE_FLAGS}")
string(REPLACE ";" " " DROGUE_BACKEND_NAMES "${DROGUE_BACKENDS}")
string(REPLACE ";" " " DROGUE_KNOWN_BACKEND_NAMES "${DROGUE_KNOWN_BACKENDS}")
set(DROGUE_COMPILER "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
if(DROGUE_CUDA)
  string(APPEND DROGUE_COMPILER ", nvcc ${CMAKE_CUDA_COMPILER_VERSION} sm_${DROGUE_CUDA_ARCH_RESOLVED}")
endif()
if(DROGUE_HIP)
  string(APPEND DROGUE_COMPILER ", HIP for ${Kokkos_HIP_ARCHITECTURES} (not tested)")
endif()
execute_process(COMMAND "${MPIEXEC_EXECUTABLE}" --version
  OUTPUT_VARIABLE _mpi ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REGEX MATCH "^[^\n]+" DROGUE_MPI "${_mpi}")
string(REGEX REPLACE "^mpi[a-z]+ \\((OpenRTE|Open MPI)\\)" "Open MPI" DROGUE_MPI "${DROGUE_MPI}")
if(NOT DROGUE_MPI)
  set(DROGUE_MPI "MPI ${MPI_C_VERSION}")
endif()
if(DROGUE_EXACT)
  set(DROGUE_EXACT_BOOL true)
else()
  set(DROGUE_EXACT_BOOL false)
endif()

set(_template "${PROJECT_BINARY_DIR}/generated/common/version.cpp.in")
configure_file("${PROJECT_SOURCE_DIR}/common/version.cpp.in" "${_template}" @ONLY)
add_custom_target(drogue_version
  COMMAND "${CMAKE_COMMAND}" -DSOURCE=${PROJECT_SOURCE_DIR} -DTEMPLATE=${_template} -DOUTPUT=${DROGUE_VERSION_SOURCE}
          -DCOMMANDS=${PROJECT_BINARY_DIR}/compile_commands.json -P "${PROJECT_SOURCE_DIR}/cmake/write_version.cmake"
  BYPRODUCTS "${DROGUE_VERSION_SOURCE}"
  COMMENT "Reading git hash and compiler flags"
  VERBATIM)
