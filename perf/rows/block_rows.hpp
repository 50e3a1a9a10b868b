#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "perf/measure/measurement.hpp"

namespace drogue::perf {

/// Row of a table of block sizes without its line end: size and the medians of its blocks, us, `FAILED` for
/// records that failed their check, then whether the order of the speeds is that of the `occupancies`, by
/// those that passed. Sides have the same length. Does not throw.
std::string block_row(std::int64_t cells, const std::vector<const Record*>& records,
                      const std::vector<double>& occupancies);

}  // namespace drogue::perf
