#pragma once

#include <cstddef>

namespace drogue::perf::ladder {

/// Exercise `chunks`, a fault in rung 3 of the transfer ladder: division of values into chunks. Some values
/// never reach the device; which, and for which numbers of values?
struct ChunksExercise {
  template <class Enqueue>
  static void for_each(std::size_t values, std::size_t chunks, const Enqueue& enqueue) {
    const std::size_t count = values / chunks;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) enqueue(chunk, chunk * count, count);
  }
};

}  // namespace drogue::perf::ladder
