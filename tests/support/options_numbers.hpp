#pragma once

#include <vector>

#include "kernels/device/memory.hpp"
#include "kernels/device/pack.hpp"

/// What tests of a backend's arithmetic compute with.
namespace drogue::options {

using Space = DROGUE_TEST_SPACE;
using Numbers = Kokkos::View<double*, Space::memory_space>;
using R = std::conditional_t<device::is_host<Space>, device::HostPack<double>, double>;
inline constexpr int members = device::Access<R>::lanes;

inline Numbers on_backend(const std::vector<double>& numbers) {
  const Numbers view("numbers", numbers.size());
  Kokkos::deep_copy(view, Kokkos::View<const double*, Kokkos::HostSpace>(numbers.data(), numbers.size()));
  return view;
}

}  // namespace drogue::options
