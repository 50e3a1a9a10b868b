#pragma once

#include <new>
#include <stdexcept>
#include <string_view>

namespace drogue::device {

/// Calls `make`, which allocates Views, and returns its result. Translates the `std::runtime_error` that
/// Kokkos throws for a failed allocation into `std::bad_alloc`; otherwise throws what `make` throws.
template <class Make>
auto allocate(const Make& make) {
  try {
    return make();
  } catch (const std::runtime_error& error) {
    if (std::string_view(error.what()).find("failed to allocate") != std::string_view::npos)
      throw std::bad_alloc();
    throw;
  }
}

}  // namespace drogue::device
