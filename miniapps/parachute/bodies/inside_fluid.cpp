#include "miniapps/parachute/bodies/inside_fluid.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/mesh/orientation.hpp"
#include "kernels/mesh/topology.hpp"

namespace drogue::parachute_app {
namespace {

/// True for a tube that continues in its images, or in two dimensions.
bool spans_its_axis(const Body& body, const flow::Parameters& p) {
  const auto along = static_cast<std::size_t>(body.axis);
  const bool repeats = p.cells[along] == 1 || p.boundary[2 * along].kind == flow::BoundaryKind::periodic;
  return repeats && body.length >= (1.0 - 1e-9) * (p.high[along] - p.low[along]);
}

/// Integral of a coordinate across the axis of a tube times that component of the normal: the ends, whose
/// normals have no such component, add nothing.
double volume_of_tube(const mesh::Mesh& tube, std::size_t across) {
  double sum = 0.0;
  for (const auto& triangle : tube.triangles) {
    double mean = 0.0;
    for (const int i : triangle) mean += tube.rest[static_cast<std::size_t>(i)][across] / 3.0;
    sum += 0.5 * mean * mesh::doubled_area(tube.rest, triangle)[across];
  }
  return std::abs(sum);
}

}  // namespace

double inside_volume(const Body& body, const flow::Parameters& p) {
  Body whole = body;
  whole.retraction = 0.0;
  const mesh::Mesh surface = mesh_of(whole);
  if (body.kind == BodyKind::cylinder && !body.has_ends)
    return spans_its_axis(body, p) ? volume_of_tube(surface, (static_cast<std::size_t>(body.axis) + 1) % 3)
                                   : 0.0;
  const mesh::Orientation sides = orientation_of(surface);
  return sides.one_sided ? 0.0 : mesh::enclosed_volume(surface, sides);
}

InsideFluid::InsideFluid(const Body& body, const flow::Parameters& p) : _motion(body) {
  if (body.moves() && body.porosity.law == PorosityLaw::none) _mass = p.density * inside_volume(body, p);
}

fabric::Vector InsideFluid::inertia(double time, double dt) {
  fabric::Vector force{};
  if (!moves() || !(dt > 0.0)) return force;
  const auto velocity = [&](double at) {
    // There may be no displacement before time 0.
    const double before = std::max(at - 0.5 * dt, 0.0), after = at + 0.5 * dt;
    const fabric::Vector from = _motion.at(before), to = _motion.at(after);
    fabric::Vector result{};
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = (to[axis] - from[axis]) / (after - before);
    return result;
  };
  const fabric::Vector now = velocity(time), before = velocity(time - dt);
  for (std::size_t axis = 0; axis < 3; ++axis) force[axis] = _mass * (now[axis] - before[axis]) / dt;
  return force;
}

}  // namespace drogue::parachute_app
