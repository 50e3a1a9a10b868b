#include "kernels/fabric/payload.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace drogue::fabric {

int add_payload(Parameters& p, const Payload& payload, std::span<const int> attachments) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(std::string("fabric payload: ") + rule);
  };
  const int vertex = static_cast<int>(p.mesh.rest.size());
  require(p.mass.size() == p.mesh.rest.size(), "the vertices of the mesh must have their masses");
  require(payload.mass > 0.0 && std::isfinite(payload.mass), "the mass must be positive");
  require(payload.axial_stiffness >= 0.0 && std::isfinite(payload.axial_stiffness),
          "the stiffness of the lines must not be negative");
  require(std::ranges::all_of(payload.rest, [](double x) { return std::isfinite(x); }),
          "the position must be finite");
  require(!attachments.empty() &&
              std::ranges::all_of(attachments, [vertex](int i) { return i >= 0 && i < vertex; }),
          "each line needs a vertex of the mesh");
  Mesh& mesh = p.mesh;
  if (!mesh.line_length.empty()) mesh.line_length.resize(mesh.lines.size() + attachments.size(), 0.0);
  if (mesh.line_stiffness.empty()) mesh.line_stiffness.assign(mesh.lines.size(), p.material.axial_stiffness);
  mesh.rest.push_back(payload.rest);
  for (const int i : attachments) {
    mesh.lines.push_back({i, vertex});
    mesh.line_stiffness.push_back(payload.axial_stiffness);
    if (!mesh.line_density.empty()) mesh.line_density.push_back(0.0);
  }
  p.mass.push_back(payload.mass);
  if (!p.pinned.empty()) p.pinned.push_back(0);
  if (!p.load.empty()) p.load.push_back({});
  for (TimedLoad& load : p.timed_loads) load.direction.push_back({});
  for (FollowerPressure& pressure : p.follower_pressures)
    if (!pressure.weight.empty()) pressure.weight.push_back(0.0);
  return vertex;
}

}  // namespace drogue::fabric
