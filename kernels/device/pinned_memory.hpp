#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory_resource>
#include <vector>

#include "kernels/device/memory.hpp"

namespace drogue::device {

/// Page-locked host memory for containers that are copied to or from a device, which avoids a staging buffer.
/// Ordinary memory on host backends. Allocation throws what Kokkos::kokkos_malloc throws.
template <class ExecutionSpace>
class PinnedMemory final : public std::pmr::memory_resource {
  using Space = HostPinnedSpace<ExecutionSpace>;

 public:
  /// True if the address lies in a live allocation of this resource. Does not throw.
  [[nodiscard]] bool holds(const void* address) const {
    return std::ranges::any_of(_blocks, [&](const Block& block) {
      return !std::less<>()(address, block.begin) && std::less<>()(address, block.end);
    });
  }

 private:
  struct Block {
    const void *begin, *end;
  };

  void* do_allocate(std::size_t bytes, std::size_t /*alignment*/) override {
    _blocks.reserve(_blocks.size() + 1);
    void* const memory = Kokkos::kokkos_malloc<Space>("drogue::device::pinned", bytes);
    _blocks.push_back({memory, static_cast<const std::byte*>(memory) + bytes});
    return memory;
  }
  void do_deallocate(void* memory, std::size_t /*bytes*/, std::size_t /*alignment*/) override {
    std::erase_if(_blocks, [&](const Block& block) { return block.begin == memory; });
    Kokkos::kokkos_free<Space>(memory);
  }
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  std::vector<Block> _blocks;
};

}  // namespace drogue::device
