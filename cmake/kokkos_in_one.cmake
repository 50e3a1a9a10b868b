# Read by Kokkos's own CMakeLists.txt, as CMAKE_PROJECT_Kokkos_INCLUDE: compiles its core as one source. Each of its two dozen
# files reads all of Kokkos, which costs more than the rest; CMAKE_UNITY_BUILD leaves CUDA out before CMake 3.31.

function(drogue_kokkos_in_one)
  get_target_property(_sources kokkoscore SOURCES)
  list(FILTER _sources INCLUDE REGEX "\\.cpp$")
  list(TRANSFORM _sources REPLACE "(.+)" "#include \"\\1\"")
  list(JOIN _sources "\n" _includes)
  set(_all "${PROJECT_BINARY_DIR}/kokkos_in_one.cpp")
  file(CONFIGURE OUTPUT "${_all}" CONTENT "${_includes}\n" @ONLY)
  set_target_properties(kokkoscore PROPERTIES SOURCES "${_all}")
  if(Kokkos_ENABLE_CUDA)
    set_source_files_properties("${_all}" TARGET_DIRECTORY kokkoscore PROPERTIES LANGUAGE CUDA)
  endif()
endfunction()

cmake_language(DEFER CALL drogue_kokkos_in_one)
