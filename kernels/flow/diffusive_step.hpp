#pragma once

#include "kernels/flow/parameters.hpp"

namespace drogue::flow {

/// Largest variable dt that explicit diffusion admits, s; infinite without that limit. Does not throw.
[[nodiscard]] double largest_diffusive_dt(const Parameters& parameters);

}  // namespace drogue::flow
