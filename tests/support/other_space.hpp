#pragma once

#include <Kokkos_Core.hpp>
#include <tuple>
#include <type_traits>

#include "kernels/device/backend_list.hpp"

namespace drogue::testing {

namespace implementation {

/// First execution space in host memory that differs from `Space`; `Space` if there is none.
template <class Space, class... Entries>
auto other_host_space(std::tuple<Entries...>) {
  std::tuple<std::type_identity<Space>> itself;
  const auto candidate = []<class Entry>(std::type_identity<Entry>) {
    using Other = typename Entry::ExecutionSpace;
    if constexpr (!std::is_same_v<Other, Space> &&
                  std::is_same_v<typename Other::memory_space, Kokkos::HostSpace>)
      return std::tuple<std::type_identity<Other>>{};
    else
      return std::tuple<>{};
  };
  return std::get<0>(std::tuple_cat(candidate(std::type_identity<Entries>{})..., itself));
}

}  // namespace implementation

/// Another backend of the build, on a host, for comparison with `Space`; `Space` itself if there is none.
template <class Space>
using OtherHostSpace =
    typename decltype(implementation::other_host_space<Space>(device::CompiledBackends{}))::type;

}  // namespace drogue::testing
