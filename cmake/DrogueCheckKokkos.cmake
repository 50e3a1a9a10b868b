# Refuses a Kokkos that is known to be miscompiled, that does not fit the build, or whose release was not tried.

# drogue_refuse_kokkos(<sentence> <command>): stops. The command is a remedy too, unless Kokkos is named or of the system.
function(drogue_refuse_kokkos sentence command)
  if(NOT DROGUE_SYSTEM AND NOT Kokkos_NAMED)
    string(APPEND sentence ", or run ${command}")
  endif()
  message(FATAL_ERROR "${sentence}.")
endfunction()

if(DROGUE_CUDA AND NOT Kokkos_ENABLE_CUDA)
  drogue_refuse_kokkos("DROGUE_CUDA=ON, but the Kokkos in ${Kokkos_DIR} has no CUDA: point Kokkos_ROOT at a CUDA build"
    "scripts/setup.sh where nvcc is installed")
endif()
if(Kokkos_ENABLE_CUDA AND NOT DROGUE_CUDA)
  message(FATAL_ERROR "The Kokkos in ${Kokkos_DIR} is a CUDA build: configure with -DDROGUE_CUDA=ON (preset cuda).")
endif()
if(DROGUE_HIP AND NOT Kokkos_ENABLE_HIP)
  drogue_refuse_kokkos("DROGUE_HIP=ON, but the Kokkos in ${Kokkos_DIR} has no HIP: point Kokkos_ROOT at a HIP build"
    "scripts/setup.sh --hip")
endif()
if(Kokkos_ENABLE_HIP AND NOT DROGUE_HIP)
  message(FATAL_ERROR "The Kokkos in ${Kokkos_DIR} is a HIP build: configure with -DDROGUE_HIP=ON (preset hip).")
endif()
if(NOT Kokkos_ENABLE_SERIAL)
  message(FATAL_ERROR "The Kokkos in ${Kokkos_DIR} lacks the Serial backend, which the tests compare against: "
                      "build it with Kokkos_ENABLE_SERIAL=ON.")
endif()
if(NOT Kokkos_ENABLE_OPENMP)
  message(STATUS "Kokkos has no OpenMP: --backend openmp will not be compiled in")
endif()

# Programs are compiled for the processor of Kokkos, in whose vectors they pack cells and vertices.
set(_processors "${Kokkos_ARCH}")
list(FILTER _processors EXCLUDE REGEX "KEPLER|MAXWELL|PASCAL|VOLTA|TURING|AMPERE|ADA|HOPPER|BLACKWELL|GFX|VEGA|^INTEL_")
if(NOT _processors AND NOT CMAKE_CXX_FLAGS MATCHES "-m(arch|cpu)=")
  message(WARNING "The Kokkos in ${Kokkos_DIR} was built for no processor, and programs may take 1.8 times as long: build it with "
                  "-DKokkos_ARCH_NATIVE=ON, or configure with -DCMAKE_CXX_FLAGS=-march=native.")
endif()

if(DROGUE_CUDA)
  # The mdspan-based View of Kokkos 4.7.0, compiled by nvcc 13.0 as C++20, computes wild addresses in a plain deep_copy. The old View
  # implementation of the same release is right.
  if(Kokkos_VERSION VERSION_GREATER_EQUAL "4.7.0" AND Kokkos_VERSION VERSION_LESS "5" AND NOT Kokkos_ENABLE_IMPL_VIEW_LEGACY)
    message(FATAL_ERROR "Kokkos ${Kokkos_VERSION} in ${Kokkos_DIR} has the mdspan View, which nvcc miscompiles as C++20 in 4.7.0 "
                        "(wrong addresses in a deep_copy; later patches were not tried): use Kokkos 4.5.1, or rebuild it with "
                        "-DKokkos_ENABLE_IMPL_VIEW_LEGACY=ON.")
  endif()
  # Kokkos 4.5 has no name for Blackwell: scripts/setup.sh builds it as Hopper with machine code for both.
  set(_accepted "${Kokkos_CUDA_ARCHITECTURES}")
  if(Kokkos_VERSION VERSION_LESS "4.6" AND "90" IN_LIST Kokkos_CUDA_ARCHITECTURES)
    list(APPEND _accepted 100)
  endif()
  if(NOT DROGUE_CUDA_ARCH_RESOLVED IN_LIST _accepted)
    drogue_refuse_kokkos("The Kokkos in ${Kokkos_DIR} was built for architecture ${Kokkos_CUDA_ARCHITECTURES}, not \
${DROGUE_CUDA_ARCH_RESOLVED}: configure with -DDROGUE_CUDA_ARCH=${Kokkos_CUDA_ARCHITECTURES}, or point Kokkos_ROOT at one for \
${DROGUE_CUDA_ARCH_RESOLVED}" "DROGUE_CUDA_ARCH=${DROGUE_CUDA_ARCH_RESOLVED} scripts/setup.sh")
  endif()
  # Sources that use Kokkos are compiled in the CUDA language, not by a wrapper that poses as the C++ compiler.
  if(NOT Kokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE)
    message(FATAL_ERROR "The Kokkos in ${Kokkos_DIR} was built for nvcc_wrapper: rebuild it with "
                        "-DKokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE=ON.")
  endif()
endif()

option(DROGUE_UNTRIED_KOKKOS "Take releases of Kokkos and Kokkos Kernels that were not tried" OFF)
if(NOT DROGUE_UNTRIED_KOKKOS)
  if(NOT Kokkos_VERSION IN_LIST DROGUE_TRIED_KOKKOS)
    message(FATAL_ERROR "Kokkos ${Kokkos_VERSION} in ${Kokkos_DIR} was not tried, as ${_tried} were: point Kokkos_ROOT at one of "
                        "these, or try it with -DDROGUE_UNTRIED_KOKKOS=ON.")
  elseif(NOT KokkosKernels_VERSION STREQUAL Kokkos_VERSION)
    message(FATAL_ERROR "Kokkos Kernels ${KokkosKernels_VERSION} in ${KokkosKernels_DIR} was not tried with Kokkos "
                        "${Kokkos_VERSION}: point KokkosKernels_ROOT at release ${Kokkos_VERSION}, or try it with "
                        "-DDROGUE_UNTRIED_KOKKOS=ON.")
  endif()
elseif(NOT Kokkos_VERSION IN_LIST DROGUE_TRIED_KOKKOS OR NOT KokkosKernels_VERSION STREQUAL Kokkos_VERSION)
  set(_views "")
  if(DROGUE_CUDA AND Kokkos_VERSION VERSION_GREATER_EQUAL 5)
    set(_views " Its View is of mdspan, which nvcc miscompiled in 4.7.0: wrong addresses, thus wrong numbers.")
  endif()
  message(WARNING "Kokkos ${Kokkos_VERSION} with Kokkos Kernels ${KokkosKernels_VERSION} was not tried.${_views} Run the tests before "
                  "you trust a number.")
endif()
