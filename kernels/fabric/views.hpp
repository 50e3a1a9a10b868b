#pragma once

#include <array>
#include <string>
#include <vector>

#include <Kokkos_Core.hpp>

#include "kernels/device/copy.hpp"

namespace drogue::fabric {

template <class ExecutionSpace, class T>
using ListView = Kokkos::View<T*, typename ExecutionSpace::memory_space>;

template <class ExecutionSpace, class T, int columns>
using TableView = Kokkos::View<T* [columns], Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// Copy of a list, in any unit, in the memory of an execution space. Blocks. Throws only if memory runs out.
template <class ExecutionSpace, class T>
[[nodiscard]] ListView<ExecutionSpace, T> list_view(const ExecutionSpace& space, const std::string& label,
                                                    const std::vector<T>& from) {
  ListView<ExecutionSpace, T> to(label, from.size());
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < from.size(); ++i) mirror(i) = from[i];
  device::copy(space, to, mirror);
  space.fence("drogue::fabric::list_view");
  return to;
}

/// Copy of columns of equal length, in any unit, in the memory of an execution space. Blocks. Throws only
/// if memory runs out.
template <class ExecutionSpace, class T, std::size_t columns>
[[nodiscard]] auto table_view(const ExecutionSpace& space, const std::string& label,
                              const std::array<std::vector<T>, columns>& from) {
  TableView<ExecutionSpace, T, static_cast<int>(columns)> to(label, from[0].size());
  const auto mirror = Kokkos::create_mirror_view(to);
  for (std::size_t column = 0; column < columns; ++column)
    for (std::size_t i = 0; i < from[column].size(); ++i) mirror(i, column) = from[column][i];
  device::copy(space, to, mirror);
  space.fence("drogue::fabric::table_view");
  return to;
}

}  // namespace drogue::fabric
