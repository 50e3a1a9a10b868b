# Turns DROGUE_CUDA_ARCH into CMAKE_CUDA_ARCHITECTURES and adds what CUDA 13 needs; runs before enable_language(CUDA).

set(_known 80 86 89 90 100)
set(DROGUE_CUDA_ARCH_RESOLVED "${DROGUE_CUDA_ARCH}")
if(DROGUE_CUDA_ARCH STREQUAL "native")
  execute_process(
    COMMAND nvidia-smi --query-gpu=compute_cap --format=csv,noheader
    OUTPUT_VARIABLE _capabilities RESULT_VARIABLE _status ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT _status EQUAL 0 OR NOT _capabilities MATCHES "^([0-9]+)\\.([0-9]+)")
    message(FATAL_ERROR "DROGUE_CUDA_ARCH=native needs a GPU that nvidia-smi can see; name the architecture instead, "
                        "for example -DDROGUE_CUDA_ARCH=90.")
  endif()
  set(DROGUE_CUDA_ARCH_RESOLVED "${CMAKE_MATCH_1}${CMAKE_MATCH_2}")
endif()
if(NOT DROGUE_CUDA_ARCH_RESOLVED IN_LIST _known)
  message(FATAL_ERROR "DROGUE_CUDA_ARCH=${DROGUE_CUDA_ARCH_RESOLVED} is not one of 80, 86, 89, 90, 100, native.")
endif()
if(DROGUE_CUDA_ARCH_RESOLVED MATCHES "^(86|89)$")
  message(WARNING "Cards of architecture ${DROGUE_CUDA_ARCH_RESOLVED} run FP64 at 1/64 of their FP32 rate; "
                  "expect precision = \"full\" to be slow.")
endif()
set(CMAKE_CUDA_ARCHITECTURES "${DROGUE_CUDA_ARCH_RESOLVED}")

# The toolkit's installer puts nvcc into a folder outside PATH.
find_program(CMAKE_CUDA_COMPILER nvcc HINTS ENV CUDA_HOME ENV CUDACXX PATHS /usr/local/cuda/bin /opt/cuda/bin)
if(NOT CMAKE_CUDA_COMPILER)
  message(FATAL_ERROR "DROGUE_CUDA=ON needs nvcc: install the CUDA toolkit or put its bin folder in PATH.")
endif()
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
