#pragma once

#include <array>
#include <string_view>

namespace drogue::linear {

/// How messages between ranks travel, the fastest for devices first.
enum class Transport {
  nccl,            ///< between devices, enqueued on a stream; a GPU for each rank
  cuda_aware_mpi,  ///< between devices, by an MPI that takes their memory
  host_staging,    ///< through page-locked host memory, by any MPI
  mpi,             ///< between hosts
  none,            ///< one rank
};

inline constexpr std::array<std::string_view, 5> transport_names = {"nccl", "cuda-aware-mpi", "host-staging",
                                                                    "mpi", "none"};

/// Name of a transport, as in results. Does not throw.
[[nodiscard]] constexpr std::string_view name(Transport transport) {
  return transport_names[static_cast<std::size_t>(transport)];
}

}  // namespace drogue::linear
