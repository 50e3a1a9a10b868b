#pragma once

struct CUstream_st;

/// Kernels of the suite written again in CUDA without Kokkos, to measure what the abstraction costs.
namespace drogue::perf::raw {

/// `cudaStream_t`, for headers without CUDA.
using Stream = CUstream_st*;

}  // namespace drogue::perf::raw
