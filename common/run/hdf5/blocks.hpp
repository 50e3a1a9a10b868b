#pragma once

#include <cstdint>

namespace drogue::run {

/// `count` blocks of `length` entries of a list: the first from entry `first` on, the others each `stride`
/// entries behind the one before.
struct Blocks {
  std::uint64_t first = 0, length = 0, count = 1, stride = 1;
};

}  // namespace drogue::run
