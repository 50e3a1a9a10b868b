#pragma once

#include <memory_resource>

#include "kernels/device/memory.hpp"

namespace drogue::device {

/// Page-locked host memory for containers whose values travel to a device and back: the device copies it
/// without a detour. On host backends it is like any other.
template <class ExecutionSpace>
class PinnedMemory final : public std::pmr::memory_resource {
  using Space = ReportSpace<ExecutionSpace>;

  void* do_allocate(std::size_t bytes, std::size_t /*alignment*/) override {
    return Kokkos::kokkos_malloc<Space>("drogue::device::pinned", bytes);
  }
  void do_deallocate(void* memory, std::size_t /*bytes*/, std::size_t /*alignment*/) override {
    Kokkos::kokkos_free<Space>(memory);
  }
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }
};

}  // namespace drogue::device
