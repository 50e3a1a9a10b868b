#include "miniapps/springs/simulation/contact_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/expression/expression.hpp"
#include "kernels/reference/fabric/bodies.hpp"
#include "kernels/reference/fabric/intersections.hpp"

namespace drogue::springs_app {
namespace {

using fabric::BodyKind;
using fabric::Vector;

std::vector<Vector> places(const std::vector<Vector>& x, const std::array<int, 3>& triangle) {
  std::vector<Vector> corners;
  for (const int i : triangle) corners.push_back(x[static_cast<std::size_t>(i)]);
  return corners;
}

void find_within(const SpringsScene& scene, std::size_t number, const std::vector<Vector>& x,
                 ContactState& state) {
  const ContactObject& object = scene.contact.objects[number];
  const auto meets = [&](const std::string& part, std::size_t k) {
    if (state.meeting.empty())
      state.meeting =
          part + " " + std::to_string(k) + " meets contact.objects[" + std::to_string(number) + "]";
    ++state.intersections;
  };
  if (object.kind == BodyKind::level_set) {
    const expression::Expression level(object.expression, {"x", "y", "z"});
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double value = level(x[i]);
      if (std::isnan(value) && state.meeting.empty())
        state.meeting = "contact.objects[" + std::to_string(number) +
                        "].expression is not a number at vertex " + std::to_string(i);
      if (!(value > 0.0)) meets("vertex", i);
    }
    return;
  }
  const fabric::Body body = object.body();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double distance = reference::distance_from(body, x[i]);
    state.penetration = std::max(state.penetration, 1.0 - distance / scene.contact.thickness);
    if (!(distance > 0.0)) meets("vertex", i);
  }
  const fabric::Mesh& mesh = scene.mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::vector<Vector> at = places(x, mesh.triangles[t]);
    if (reference::enters(body, std::array{at[0], at[1], at[2]})) meets("face", t);
  }
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    const auto end = [&](std::size_t which) { return x[static_cast<std::size_t>(mesh.lines[k][which])]; };
    if (reference::enters(body, std::array{end(0), end(1)})) meets("line", k);
  }
}

}  // namespace

ContactState contact_state(const SpringsScene& scene, const std::vector<Vector>& x) {
  ContactState state;
  for (std::size_t k = 0; k < scene.contact.objects.size(); ++k) find_within(scene, k, x, state);
  if (!scene.contact.self) return state;
  const auto found = reference::intersections(x, scene.mesh.triangles, scene.mesh.lines);
  state.intersections += static_cast<int>(found.size());
  if (state.meeting.empty() && !found.empty())
    state.meeting = "the edge of vertices " + std::to_string(found[0].segment[0]) + " and " +
                    std::to_string(found[0].segment[1]) + " meets face " + std::to_string(found[0].triangle);
  return state;
}

}  // namespace drogue::springs_app
