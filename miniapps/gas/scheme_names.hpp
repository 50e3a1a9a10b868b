#pragma once

#include <string>

#include "kernels/gas/parameters.hpp"

namespace drogue::gas_app {

/// A scheme as scenes spell it, and a label that says how it differs from WENO over lf-stencil, ssprk3,
/// double.
struct SchemeNames {
  std::string label, weno, splitting, time, precision;
};

SchemeNames scheme_names(const gas::Parameters& parameters);

}  // namespace drogue::gas_app
