#include "miniapps/parachute/scene/sound.hpp"

#include <algorithm>
#include <cmath>

#include "common/scene/node.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using scene::rough_text, scene::sentence;

/// Largest Mach number of an incompressible flow: air that is stopped without losses rises in pressure by
/// 1 + Mach^2 / 4 of the dynamic one, 2 % more than without compressibility.
constexpr double largest_mach = 0.3;

/// Fluid by its properties, in SI units.
struct Fluid {
  const char* name;
  double least_density, largest_density, largest_viscosity, speed_of_sound;
};

/// Air up to a height of 11 km, and water. Viscosities may be less: they hardly count at high speeds.
constexpr std::array<Fluid, 2> fluids = {
    {{"air", 0.3, 1.6, 2.5e-5, 340.0}, {"water", 900.0, 1100.0, 2e-3, 1480.0}}};

double speed_of(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

/// Largest speed of `fluid.velocity` in the middle of the domain, m/s.
double largest_stream(const FlowScene& scene) {
  const SpaceTimeVector velocity(scene.velocity);
  const std::array<double, 3> middle = middle_of(scene.parameters);
  double largest = 0.0;
  constexpr int times = 100;
  for (int k = 0; k <= times; ++k)
    largest = std::max(largest, speed_of(velocity(middle, scene.end_time * k / times)));
  return largest;
}

}  // namespace

std::optional<std::string> compressibility_text(const flow::Parameters& p, double speed) {
  const auto found = std::ranges::find_if(fluids, [&](const Fluid& fluid) {
    return p.density >= fluid.least_density && p.density <= fluid.largest_density &&
           p.viscosity <= fluid.largest_viscosity;
  });
  if (found == fluids.end() || !(speed > largest_mach * found->speed_of_sound)) return {};
  return sentence(rough_text(speed), " m/s are Mach ", rough_text(speed / found->speed_of_sound), " in ",
                  found->name, ", beyond the ", largest_mach,
                  " up to which an incompressible flow stands for it: drag and forces lack its "
                  "compressibility, and shocks");
}

void note_compressibility(FlowScene& scene) {
  const auto note = [&](const std::string& key, double speed) {
    const auto text = compressibility_text(scene.parameters, speed);
    if (text) scene.notices.push_back(key + ": " + *text);
    return text.has_value();
  };
  if (note("fluid.velocity", largest_stream(scene))) return;
  const std::array<double, 3> stream = scene.stream().value_or(std::array<double, 3>{});
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    std::array<double, 3> relative = scene.canopies[i].start_velocity;
    for (std::size_t axis = 0; axis < 3; ++axis) relative[axis] -= stream[axis];
    if (note(scene.drop ? "drop.speed" : scene::element("canopy", i) + ".payload.velocity",
             speed_of(relative)))
      return;
  }
}

}  // namespace drogue::parachute_app
