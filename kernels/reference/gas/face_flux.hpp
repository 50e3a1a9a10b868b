#pragma once

#include <array>
#include <span>

#include "kernels/gas/parameters.hpp"
#include "kernels/reference/gas/euler.hpp"

namespace drogue::reference {

/// Largest wave speeds over a set of cells.
struct SpeedBounds {
  std::array<double, 3> field{};  ///< of |u-c|, |u|, |u+c|
  double largest = 0.0;           ///< of |u|+c
};

[[nodiscard]] SpeedBounds speed_bounds(std::span<const Conserved> cells, double gamma);

/// Alpha of each characteristic field at a face: from the mesh's bounds, or from the stencil's (lf_stencil).
[[nodiscard]] std::array<double, 3> splitting_alpha(gas::Splitting splitting, const SpeedBounds& mesh,
                                                    std::span<const Conserved, 6> stencil, double gamma);

/// Characteristic WENO flux at i+1/2 from the cells i-2 .. i+3, in dense form: every state and every flux of
/// the stencil is projected with full matrices, split as F+- = (F +- alpha U)/2, reconstructed and projected
/// back.
[[nodiscard]] Conserved face_flux(std::span<const Conserved, 6> stencil, const std::array<double, 3>& alpha,
                                  const gas::Parameters& parameters);

/// First-order Lax-Friedrichs flux with one alpha.
[[nodiscard]] Conserved lax_friedrichs_flux(const Conserved& a, const Conserved& b, double alpha,
                                            double gamma);

}  // namespace drogue::reference
