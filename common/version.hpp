#pragma once

#include <string_view>

namespace drogue {

/// Facts about this build, fixed at compile time.
struct BuildInfo {
  std::string_view version;   ///< of the project, "0.1.0"
  std::string_view git;       ///< 12 digits, "-dirty" after them if files were changed; "unknown" without git
  std::string_view compiler;  ///< "GNU 12.2.0", in a CUDA build with nvcc and the architecture
  std::string_view
      flags;  ///< of the compile commands of the kernels, but what they include, define and warn of
  std::string_view build_type;  ///< "Release"
  std::string_view kokkos;
  std::string_view kokkos_kernels;
  std::string_view mpi;
  std::string_view hdf5;  ///< version and "serial" or "parallel"
  std::string_view fftw;
  std::string_view hypre;           ///< "none" without it
  std::string_view nccl;            ///< "none" without it
  std::string_view backends;        ///< compiled in, separated by blanks: "serial openmp"
  std::string_view known_backends;  ///< that the sources support, likewise: "serial openmp hip cuda"
  bool exact;                       ///< no fused multiply-add: backends agree bit for bit
};

[[nodiscard]] const BuildInfo& build_info() noexcept;

}  // namespace drogue
