#include <algorithm>
#include <cmath>

#include "common/scene/read.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/simulation/energy_balance.hpp"
#include "miniapps/springs/simulation/history.hpp"
#include "miniapps/springs/verify/probe.hpp"
#include "miniapps/springs/verify/verify.hpp"

namespace drogue::springs_app {
namespace {

using scene::contradict;
using scene::Table;

void require(const Table& root, bool holds, const std::string& path, const std::string& needs) {
  if (!holds) contradict(root, path, path + " needs " + needs);
}

bool is_zero(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return value == 0.0; });
}

/// True if something measures the forces that are left at the end: a reaction of a pin, or a dead load.
bool has_reaction_or_load(const SpringsScene& scene) {
  const auto acts = [&scene](const std::string& strength) {
    return !strength.empty() && !depends_on_time(strength) && !is_zero(values_at(strength, scene.mesh));
  };
  return !scene.pins.empty() || std::ranges::any_of(scene.loads, [&](const Load& load) {
    return acts(load.pressure) ||
           (load.force && (acts(load.force->x) || acts(load.force->y) || acts(load.force->z)));
  });
}

/// Position at the end of the run of a vertex that pins hold along all axes; nothing for any other vertex.
std::optional<fabric::Vector> fixed_place(const SpringsScene& scene, std::size_t vertex) {
  const fabric::Vector& rest = scene.mesh.rest[vertex];
  fabric::Vector place = values_at(scene.initial.displacement, scene.mesh)[vertex];
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += (1.0 + scene.initial.prestretch) * rest[axis];
  unsigned fixed = 0;
  for (const Pin& pin : scene.pins) {
    if (std::ranges::count(selected(pin.where, scene.mesh), static_cast<int>(vertex)) == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (pin.axes.find("xyz"[axis]) == std::string::npos) continue;
      fixed |= 1U << axis;
      if (const std::string& motion = pin.motion.of(axis); !motion.empty())
        place[axis] = rest[axis] + values_at(motion, scene.mesh, scene.time.end_time)[vertex];
    }
  }
  return fixed == 7U ? std::optional(place) : std::nullopt;
}

/// Checks that the closed forms of hanging strings hold: of the catenary, and of the stretch below one end.
void check_hanging(const Table& root, const SpringsScene& scene) {
  const Verify& verify = scene.verify;
  if (!verify.catenary && !verify.stretch) return;
  const std::size_t last = scene.mesh.rest.size() - 1;
  const std::optional<fabric::Vector> begin = fixed_place(scene, 0), end = fixed_place(scene, last);
  const std::vector<double>& g = scene.loads[0].gravity;
  for (const auto& [name, tolerance] :
       {std::pair{"verify.catenary", verify.catenary}, std::pair{"verify.stretch", verify.stretch}})
    if (tolerance) require(root, !is_zero(g), name, "gravity other than 0");
  if (verify.stretch)
    require(root, begin && !end, "verify.stretch",
            "a pin that holds the first end of the string, and none that holds the other");
  if (!verify.catenary) return;
  require(root, begin && end, "verify.catenary", "pins that hold both ends of the string");
  require(root, scene.payloads.empty(), "verify.catenary", "a string without payloads");
  fabric::Vector normal{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    normal[a] = ((*end)[b] - (*begin)[b]) * g[c] - ((*end)[c] - (*begin)[c]) * g[b];
  }
  require(root, !is_zero({normal.begin(), normal.end()}), "verify.catenary",
          "ends that are not one above the other at the end: the error is relative to their span");
}

/// Checks that the closed form of a pulled sheet holds, and that it is pulled at all.
void check_pulled(const Table& root, const SpringsScene& scene, const std::string& name) {
  require(
      root,
      (scene.source.strip || scene.source.rectangle) && fabric::has_triangles(scene.fabric.material.model),
      name, "mesh.strip or mesh.rectangle, and model quadratic or biquadratic");
  require(root, std::ranges::any_of(scene.pins, [](const Pin& pin) { return !pin.motion.x.empty(); }), name,
          "a pin with motion.x, which pulls");
  require(root,
          std::ranges::any_of(scene.pins,
                              [&scene](const Pin& pin) {
                                return !is_zero(values_at(pin.motion.x, scene.mesh, scene.time.end_time));
                              }),
          name, "a motion.x that is not 0 at the end");
  require(root, even_line_stiffness(scene.mesh).has_value(), name,
          "reinforcements that run along x from end to end, with the same stiffness all the way");
}

void check_frequency(const Table& root, const SpringsScene& scene) {
  const Frequency& f = *scene.verify.frequency;
  const std::size_t numbers = f.mode.size();
  require(root, std::ranges::all_of(f.mode, [](double m) { return m == std::floor(m); }),
          "verify.frequency.mode", "integers");
  if (scene.source.disk)
    require(root, numbers == 0 || (numbers == 2 && f.mode[1] >= 1.0), "verify.frequency.mode",
            "two numbers for a disk: nodal diameters, and circles from 1, the rim");
  if (scene.source.string)
    require(root, numbers == 0 || (numbers == 1 && f.mode[0] >= 1.0), "verify.frequency.mode",
            "one number from 1 for a string");
  const bool has_closed_form = numbers > 0 && (scene.source.disk || scene.source.string);
  require(root, f.value || (has_closed_form && scene.reinforcements.empty()), "verify.frequency",
          "a value, or a mode of a disk or of a string without reinforcement, whose closed form is known");
  if (scene.source.disk && !f.value)
    require(root, scene.initial.prestretch > 0.0 && fabric::has_triangles(scene.fabric.material.model),
            "verify.frequency.mode", "initial.prestretch > 0 and model quadratic or biquadratic");
  require(root, static_cast<std::size_t>(f.probe) < scene.output.probes.size(), "verify.frequency.probe",
          "a probe of that number in output.probes");
}

}  // namespace

void check_verify(const Table& root, const SpringsScene& scene) {
  const Verify& verify = scene.verify;
  framework::require_measurable(root, verify.history, scene.output, {scene.time.end_time, "time.end_time"},
                                history_columns(scene));
  const MeshSource& source = scene.source;
  const bool has_rows = scene.output.history_every > 0;
  const std::string rows = "rows of history.csv: output.history_every > 0";
  const bool meets = scene.contact.is_enabled();
  if (verify.energy_drift)
    require(root, !meets, "verify.energy_drift",
            "a scene without contact, of which energy_balance counts the work");
  for (const auto& [name, tolerance] : {std::pair{"verify.energy_drift", verify.energy_drift},
                                        std::pair{"verify.energy_balance", verify.energy_balance}}) {
    if (!tolerance) continue;
    require(root, has_rows, name, rows);
    require(root, scene.damping.absolute == 0.0 && scene.damping.relative == 0.0, name,
            "a scene without damping");
    require(root, conserves_energy(scene), name,
            "pins that stay and loads that do not change; a follower pressure needs cloth that is closed or "
            "whose "
            "rim is held");
  }
  for (const auto& [name, tolerance] : {std::pair{"verify.energy_balance", verify.energy_balance},
                                        std::pair{"verify.intersections", verify.intersections}})
    if (tolerance) require(root, meets, name, "contact.self or contact.objects");
  const bool has_level_set = std::ranges::any_of(scene.contact.objects, [](const ContactObject& object) {
    return object.kind == fabric::BodyKind::level_set;
  });
  if (verify.intersections) {
    require(root, has_rows, "verify.intersections", rows);
    require(root, !has_level_set, "verify.intersections",
            "contact.objects without a level-set, which keeps out only vertices");
  }
  if (verify.penetration)
    require(root, !scene.contact.objects.empty() && !has_level_set, "verify.penetration",
            "contact.objects, none of them a level-set");
  if (verify.momentum) require(root, has_rows, "verify.momentum", rows);
  if (verify.angular_momentum) require(root, has_rows, "verify.angular_momentum", rows);
  for (const auto& [name, tolerance] :
       {std::pair{"verify.young", verify.young}, std::pair{"verify.poisson", verify.poisson}}) {
    if (tolerance) check_pulled(root, scene, name);
  }
  for (const auto& [name, tolerance] :
       {std::pair{"verify.hencky", verify.hencky}, std::pair{"verify.catenary", verify.catenary},
        std::pair{"verify.stretch", verify.stretch}})
    if (tolerance) require(root, scene.reinforcements.empty(), name, "a scene without reinforcement");
  if (verify.hencky) {
    require(root,
            source.disk && fabric::has_triangles(scene.fabric.material.model) && scene.loads.size() == 1 &&
                constant_value(scene.loads[0].pressure),
            "verify.hencky", "mesh.disk, model quadratic or biquadratic, and one load, a constant pressure");
    require(root, constant_value(scene.loads[0].pressure) != 0.0, "verify.hencky", "a pressure other than 0");
    require(root, scene.initial.prestretch == 0.0 && scene.fabric.material.bending_stiffness == 0.0,
            "verify.hencky", "a membrane without prestretch and without bending stiffness");
    require(root, !scene.pins.empty(), "verify.hencky", "a pin, which clamps the rim");
  }
  for (const auto& [name, tolerance] :
       {std::pair{"verify.catenary", verify.catenary}, std::pair{"verify.stretch", verify.stretch}})
    if (tolerance)
      require(root, source.string && scene.loads.size() == 1 && !scene.loads[0].gravity.empty(), name,
              "mesh.string and one load, gravity");
  check_hanging(root, scene);
  if (verify.equilibrium)
    require(root, has_reaction_or_load(scene), "verify.equilibrium",
            "a pin, or a dead pressure or force: the error is relative to the largest reaction or dead load");
  if (verify.frequency) {
    require(root, has_rows, "verify.frequency", rows);
    check_frequency(root, scene);
  }
  for (std::size_t k = 0; k < verify.values.size(); ++k) {
    const FinalValue& value = verify.values[k];
    const std::string path = "verify.values[" + std::to_string(k) + "].";
    require(root, value.value != 0.0, path + "value", "a number other than 0, since the error is relative");
    if (is_of_vertex(value.quantity))
      require(root, !value.at.empty(), path + "quantity", "at, a position");
    else
      require(root, value.at.empty(), path + "at", "a quantity of a vertex");
    if (value.quantity == FinalQuantity::von_mises || value.quantity == FinalQuantity::area_growth)
      require(root, !scene.mesh.triangles.empty(), path + "quantity", "a mesh with triangles");
  }
  if (verify.front_speed) {
    require(root, has_rows, "verify.front_speed", rows);
    require(root, scene.output.probes.size() >= 2, "verify.front_speed", "two output.probes");
    const auto place = [&scene](std::size_t k) {
      return nearest_vertex(scene.mesh, scene.output.probes[k].at);
    };
    require(root, place(0) != place(1), "verify.front_speed", "two output.probes at different vertices");
  }
}

}  // namespace drogue::springs_app
