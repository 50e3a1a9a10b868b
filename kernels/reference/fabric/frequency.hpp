#pragma once

#include <cstdint>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// The largest angular frequency of small oscillations about `now`, rad/s: of M^-1 K by power iteration, K v
/// from central differences of `forces`, pinned axes held (bits 1, 2, 4 of `pinned`, which may be empty).
/// From below, to about 1e-4 of it.
[[nodiscard]] double largest_frequency(const fabric::Material& material, const Mesh& mesh,
                                       const std::vector<double>& mass,
                                       const std::vector<std::uint8_t>& pinned,
                                       const std::vector<Vector>& now);

}  // namespace drogue::reference
