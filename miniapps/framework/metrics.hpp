#pragma once

#include "common/run/result_document.hpp"

namespace drogue::framework {

/// Sets the counts of a flux limiter to zero, for a program without one: result.json has them by its schema.
/// Throws only std::bad_alloc.
void set_no_limiter(run::Metrics& metrics);

}  // namespace drogue::framework
