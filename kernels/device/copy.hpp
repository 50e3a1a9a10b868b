#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <Kokkos_Core.hpp>

#include "kernels/device/memory.hpp"

namespace drogue::device {

/// Source and destination of a copy: from host memory to the device, back to host memory or to
/// `HostPinnedSpace`, or within device memory.
enum class CopyKind { to_device, to_host, to_host_pinned, within };

/// Kokkos::deep_copy of `bytes` bytes. Asynchronous. Compiled once per backend, because Kokkos::deep_copy
/// instantiates about fifty kernels for each new pair of View types. Throws std::runtime_error if CUDA
/// rejected the launch of an earlier kernel, which Kokkos does not report.
template <class ExecutionSpace>
void copy_bytes(const ExecutionSpace& space, CopyKind kind, void* to, const void* from, std::size_t bytes);

/// Kind of a copy from memory space `From` to memory space `To`.
template <class ExecutionSpace, class To, class From>
[[nodiscard]] constexpr CopyKind copy_kind() {
  using Device = typename ExecutionSpace::memory_space;
  using Host = Kokkos::HostSpace;
  if constexpr (std::is_same_v<To, Device>) {
    static_assert(std::is_same_v<From, Device> || std::is_same_v<From, Host>);
    return std::is_same_v<From, Device> ? CopyKind::within : CopyKind::to_device;
  } else {
    static_assert(std::is_same_v<From, Device>);
    static_assert(std::is_same_v<To, Host> || std::is_same_v<To, HostPinnedSpace<ExecutionSpace>>);
    return std::is_same_v<To, Host> ? CopyKind::to_host : CopyKind::to_host_pinned;
  }
}

/// Copies all values of `from` to `to`; both are contiguous Views of one layout. Asynchronous. Throws
/// std::invalid_argument for Views of different sizes and for Views that are not contiguous.
template <class ExecutionSpace, class To, class From>
void copy(const ExecutionSpace& space, const To& to, const From& from) {
  static_assert(std::is_same_v<typename To::value_type, typename From::non_const_value_type>);
  static_assert(To::rank() == From::rank());
  static_assert(To::rank() < 2 || std::is_same_v<typename To::array_layout, typename From::array_layout>);
  if (to.size() != from.size() || !to.span_is_contiguous() || !from.span_is_contiguous())
    throw std::invalid_argument("cannot copy '" + from.label() + "' to '" + to.label() +
                                "': their sizes differ, or they have gaps");
  copy_bytes(space, copy_kind<ExecutionSpace, typename To::memory_space, typename From::memory_space>(),
             to.data(), from.data(), to.size() * sizeof(typename To::value_type));
}

/// Copies `count` values from host memory to the beginning of a contiguous View. Asynchronous: the source
/// must stay unchanged until the next fence. Throws as `copy_bytes` does.
template <class ExecutionSpace, class To>
void copy_in(const ExecutionSpace& space, const To& to, const typename To::value_type* from,
             std::size_t count) {
  copy_bytes(space, copy_kind<ExecutionSpace, typename To::memory_space, Kokkos::HostSpace>(), to.data(),
             from, count * sizeof *from);
}

/// Copies the first `count` values of a contiguous View to host memory. Asynchronous. Throws as `copy_bytes`
/// does.
template <class ExecutionSpace, class From>
void copy_out(const ExecutionSpace& space, typename From::non_const_value_type* to, const From& from,
              std::size_t count) {
  copy_bytes(space, copy_kind<ExecutionSpace, Kokkos::HostSpace, typename From::memory_space>(), to,
             from.data(), count * sizeof *to);
}

}  // namespace drogue::device
