#pragma once

#include <string>

#include "miniapps/parachute/canopy/canopy.hpp"

namespace drogue::parachute_app {

/// Part of a canopy that oscillates faster than all others.
struct StiffPart {
  std::string key;     ///< below the canopy
  double value = 0.0;  ///< in `unit`
  std::string unit;
  double frequency = 0.0;            ///< bound of its angular frequencies, rad/s
  std::string remedy = "a smaller";  ///< with the key: what makes it slower
};

/// Stiffest part of the mesh of a canopy: its unstretched cloth by the bound that `fabric::frequency_bound`
/// has for it, or a line with the masses at its ends. Throws only std::bad_alloc.
[[nodiscard]] StiffPart stiffest_part(const Canopy& canopy, const CanopyMesh& mesh);

}  // namespace drogue::parachute_app
