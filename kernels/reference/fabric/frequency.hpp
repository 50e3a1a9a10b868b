#pragma once

#include <cstdint>

#include "kernels/reference/fabric/membrane.hpp"

namespace drogue::reference {

/// Largest angular frequency of small oscillations about the positions `now`, rad/s. Power iteration on M^-1
/// K, with K v by central differences of `forces`. `pinned`: bits 1, 2, 4 fix the axes of a vertex; may be
/// empty. The result is a lower bound with a relative error of about 1e-4.
[[nodiscard]] double largest_frequency(const fabric::Material& material, const Mesh& mesh,
                                       const std::vector<double>& mass,
                                       const std::vector<std::uint8_t>& pinned,
                                       const std::vector<Vector>& now);

}  // namespace drogue::reference
