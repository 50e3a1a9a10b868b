#pragma once

#include <vector>

#include "kernels/options/batch/price_batch.hpp"

namespace drogue::options {

template <class ExecutionSpace>
using DeviceNumbers = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

/// Copy of numbers in the memory of `ExecutionSpace`.
template <class ExecutionSpace>
[[nodiscard]] DeviceNumbers<ExecutionSpace> on_backend(const std::vector<double>& numbers) {
  const DeviceNumbers<ExecutionSpace> view("numbers", numbers.size());
  Kokkos::deep_copy(view, Kokkos::View<const double*, Kokkos::HostSpace>(numbers.data(), numbers.size()));
  return view;
}

}  // namespace drogue::options
