#include "miniapps/parachute/canopy/stiffness.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/mesh/edges.hpp"

namespace drogue::parachute_app {

StiffPart stiffest_part(const Canopy& canopy, const CanopyMesh& mesh) {
  const fabric::Parameters& p = mesh.fabric;
  StiffPart stiffest = {"membrane_modulus", canopy.membrane_modulus, "N/m",
                        std::sqrt(canopy.membrane_modulus / canopy.area_density) / canopy.edge_length};
  const auto compare = [&](const std::string& key, double stiffness, int line) {
    const auto k = static_cast<std::size_t>(line);
    double inverse_mass = 0.0;
    for (const int i : p.mesh.lines[k])
      if (const auto end = static_cast<std::size_t>(i); p.pinned[end] != 7) inverse_mass += 1.0 / p.mass[end];
    const double frequency =
        std::sqrt(p.mesh.line_stiffness[k] / mesh::rest_length(p.mesh, k) * inverse_mass);
    if (frequency > stiffest.frequency) stiffest = {key, stiffness, "N", frequency};
  };
  for (const int line : mesh.suspension) compare("lines.stiffness", canopy.lines.stiffness, line);
  if (canopy.reefing)
    for (const int line : mesh.reefing) compare("reefing.stiffness", canopy.reefing->stiffness, line);
  if (canopy.riser && mesh.riser) compare("riser.stiffness", canopy.riser->stiffness, *mesh.riser);
  if (canopy.vent_lines)
    for (const int line : mesh.vent_lines)
      compare("vent_lines.stiffness", canopy.vent_lines->stiffness, line);
  // Bands come before all other lines.
  const int bands = static_cast<int>(p.mesh.lines.size() - mesh.suspension.size() - mesh.reefing.size() -
                                     mesh.vent_lines.size()) -
                    (mesh.riser ? 1 : 0);
  for (int line = 0; line < bands; ++line)
    compare("reinforcement", p.mesh.line_stiffness[static_cast<std::size_t>(line)], line);
  return stiffest;
}

}  // namespace drogue::parachute_app
