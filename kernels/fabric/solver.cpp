#include "kernels/fabric/solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/device/block_size.hpp"
#include "kernels/fabric/contact/features.hpp"
#include "kernels/mesh/edges.hpp"

namespace drogue::fabric {

// Defined and instantiated for each backend in instances/solver.cpp.
template <class ExecutionSpace>
std::unique_ptr<Solver> make_solver(const Parameters& parameters);

namespace {

template <class Require>
void check_contact(const Parameters& p, const Require& require) {
  const Contact& contact = p.contact;
  if (!contact.is_enabled()) return;
  const auto not_negative = [](double x) { return x >= 0.0 && std::isfinite(x); };
  require(contact.thickness > 0.0 && std::isfinite(contact.thickness), "contact needs a positive thickness");
  require(!contact.self || contact.thickness < shortest_altitude(p.mesh),
          "contact of fabric with itself needs triangles that are higher than the thickness");
  require(not_negative(contact.friction), "friction must not be negative");
  require(contact.interval >= 1, "the interval of contact must be at least one step");
  require(device::is_block_size(contact.block),
          "the block of contact must be a multiple of 32 between 32 and 512");
  for (const Body& body : contact.bodies) {
    const double size = std::hypot(body.normal[0], body.normal[1], body.normal[2]);
    require(std::abs(size - 1.0) < 1e-9, "a body's normal must have unit length");
    require(not_negative(body.friction), "friction must not be negative");
    const bool round = body.kind == BodyKind::disk || body.kind == BodyKind::sphere;
    require(!round || body.radius > 0.0, "a disk and a sphere need a radius");
    require(body.kind != BodyKind::level_set || body.level_set.length > 0, "a level set needs an expression");
  }
}

}  // namespace

void check_parameters(const Parameters& p) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("fabric solver: ") + what);
  };
  const std::size_t n = p.mesh.rest.size();
  const auto finite = [](const Vector& v) {
    return std::ranges::all_of(v, [](double x) { return std::isfinite(x); });
  };
  const auto is_vertex = [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < n; };
  require(n > 0 && std::ranges::all_of(p.mesh.rest, finite),
          "there must be a vertex, and all must be somewhere");
  for (const auto& t : p.mesh.triangles) {
    require(std::ranges::all_of(t, is_vertex), "a triangle names a vertex that is not there");
    require(has_area(p.mesh, t), "a triangle has no area");
  }
  for (const auto& line : p.mesh.lines) {
    require(std::ranges::all_of(line, is_vertex), "a line names a vertex that is not there");
    require(rest_distance(p.mesh, line[0], line[1]) > 0.0, "a line has no length");
  }
  const auto positive = [](double x) { return x > 0.0 && std::isfinite(x); };
  const auto not_negative = [](double x) { return x >= 0.0 && std::isfinite(x); };
  require(p.mass.size() == n && std::ranges::all_of(p.mass, positive), "every vertex needs a positive mass");
  require(p.pinned.empty() || p.pinned.size() == n, "pins must be given for every vertex, or for none");
  require(p.load.empty() || (p.load.size() == n && std::ranges::all_of(p.load, finite)),
          "finite loads must be given for every vertex, or for none");
  const auto one_a_vertex = [&](const auto& values, const auto& good) {
    return values.size() == n && std::ranges::all_of(values, good);
  };
  require(p.mesh.line_stiffness.empty() || (p.mesh.line_stiffness.size() == p.mesh.lines.size() &&
                                            std::ranges::all_of(p.mesh.line_stiffness, not_negative)),
          "stiffness must be given for every line, or for none, and not be negative");
  require(p.mesh.line_length.empty() || (p.mesh.line_length.size() == p.mesh.lines.size() &&
                                         std::ranges::all_of(p.mesh.line_length, not_negative)),
          "lengths must be given for every line, or for none, and not be negative");
  for (const TimedLoad& load : p.timed_loads)
    require(load.strength.length > 0 && one_a_vertex(load.direction, finite),
            "a load that changes needs a strength, and a finite direction for every vertex");
  for (const FollowerPressure& pressure : p.follower_pressures)
    require(pressure.strength.length > 0 &&
                (pressure.weight.empty() ||
                 one_a_vertex(pressure.weight, [](double w) { return std::isfinite(w); })),
            "a pressure needs a strength, and finite weights for every vertex, or for none");
  std::vector<std::uint8_t> moved(n, 0);
  for (const Motion& motion : p.motions) {
    require(motion.displacement.length > 0 && motion.axis >= 0 && motion.axis < 3,
            "a motion needs a displacement and an axis");
    for (const int i : motion.vertices) {
      require(is_vertex(i), "a motion names a vertex that is not there");
      std::uint8_t& axes = moved[static_cast<std::size_t>(i)];
      const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(motion.axis));
      require((axes & bit) == 0, "two motions move the same axis of a vertex");
      axes |= bit;
    }
  }
  require(finite(p.gravity), "gravity must be finite");
  require(p.patch >= 0, "a patch cannot have fewer vertices than none");
  check_contact(p, require);
  require(positive(p.dt), "dt must be positive");
  require(not_negative(p.damping) && not_negative(p.relative_damping), "damping must not be negative");
  const Material& m = p.material;
  require(not_negative(m.membrane_modulus) && not_negative(m.stiffness) && not_negative(m.axial_stiffness) &&
              not_negative(m.bending_stiffness),
          "no stiffness may be negative");
  require(!m.tension_only || m.model != Model::linear_vector,
          "springs of vectors (Model I) have no compressed state: tension_only does not apply to them");
  if (has_triangles(m.model))
    require(m.poisson > -1.0 && m.poisson <= 0.5, "Poisson's ratio must lie between -1 and 1/2");
}

bool has_area(const Mesh& mesh, const std::array<int, 3>& t) {
  // Heron's formula in the order without cancellation (Kahan 2014), since the area is compared with the
  // rounding of the coordinates.
  double side[3] = {rest_distance(mesh, t[0], t[1]), rest_distance(mesh, t[1], t[2]),
                    rest_distance(mesh, t[2], t[0])};
  std::ranges::sort(side);
  return side[0] + side[1] - side[2] > 1e-14 * side[2] && side[2] > 1e-70 && side[2] < 1e70;
}

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters) {
  return device::dispatch(backend,
                          [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(parameters); });
}

}  // namespace drogue::fabric
