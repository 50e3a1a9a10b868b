#include "miniapps/springs/simulation/energy_balance.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "miniapps/springs/scene/expressions.hpp"

namespace drogue::springs_app {
namespace {

bool moves(const Pin& pin) {
  return depends_on_time(pin.motion.x) || depends_on_time(pin.motion.y) || depends_on_time(pin.motion.z);
}

/// True for vertices that pins hold in place along all axes.
std::vector<bool> fixed_vertices(const SpringsScene& scene) {
  std::vector<unsigned> axes(scene.mesh.rest.size(), 0);
  for (const Pin& pin : scene.pins) {
    if (moves(pin)) continue;
    for (const int i : selected(pin.where, scene.mesh))
      for (const char axis : pin.axes) axes[static_cast<std::size_t>(i)] |= 1U << (axis - 'x');
  }
  std::vector<bool> fixed;
  for (const unsigned each : axes) fixed.push_back(each == 7U);
  return fixed;
}

/// True if every edge of a single triangle is fixed: then pressure has the potential -p V.
bool is_closed_or_fixed(const SpringsScene& scene) {
  std::map<std::pair<int, int>, int> triangles;
  for (const auto& triangle : scene.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++triangles[std::minmax({triangle[k], triangle[(k + 1) % 3]})];
  const std::vector<bool> fixed = fixed_vertices(scene);
  return std::ranges::all_of(triangles, [&fixed](const auto& entry) {
    const auto& [a, b] = entry.first;
    return entry.second > 1 || (fixed[static_cast<std::size_t>(a)] && fixed[static_cast<std::size_t>(b)]);
  });
}

bool has_potential(const Load& load, bool is_closed) {
  if (!load.follower_pressure.empty()) return is_closed && constant_value(load.follower_pressure);
  if (load.force)
    return !(depends_on_time(load.force->x) || depends_on_time(load.force->y) ||
             depends_on_time(load.force->z));
  return !depends_on_time(load.pressure);
}

bool has_follower_pressure(const SpringsScene& scene) {
  return std::ranges::any_of(scene.loads, [](const Load& load) { return !load.follower_pressure.empty(); });
}

}  // namespace

double pressure_with_potential(const SpringsScene& scene) {
  if (!has_follower_pressure(scene) || !is_closed_or_fixed(scene)) return 0.0;
  double sum = 0.0;
  for (const Load& load : scene.loads) sum += constant_value(load.follower_pressure).value_or(0.0);
  return sum;
}

bool conserves_energy(const SpringsScene& scene) {
  if (scene.damping.absolute > 0.0 || scene.damping.relative > 0.0 || std::ranges::any_of(scene.pins, moves))
    return false;
  const bool is_closed = has_follower_pressure(scene) && is_closed_or_fixed(scene);
  return std::ranges::all_of(scene.loads, [&](const Load& load) { return has_potential(load, is_closed); });
}

}  // namespace drogue::springs_app
