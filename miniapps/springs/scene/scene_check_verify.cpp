#include <algorithm>
#include <cmath>

#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/simulation/energy_balance.hpp"
#include "miniapps/springs/simulation/history.hpp"
#include "miniapps/springs/verify/probe.hpp"
#include "miniapps/springs/verify/verify.hpp"

namespace drogue::springs_app {
namespace {

using scene::Place;

void require(const Place& verify, bool holds, const std::string& key, const std::string& needs) {
  verify.refuse_if(!holds, key, " needs ", needs);
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
void check_hanging(const Place& verify, const SpringsScene& scene) {
  const Verify& wanted = scene.verify;
  if (!wanted.catenary && !wanted.stretch) return;
  const std::size_t last = scene.mesh.rest.size() - 1;
  const std::optional<fabric::Vector> begin = fixed_place(scene, 0), end = fixed_place(scene, last);
  const std::vector<double>& g = scene.loads[0].gravity;
  for (const char* name : {"catenary", "stretch"})
    if (verify.given(name)) require(verify, !is_zero(g), name, "gravity other than 0");
  if (wanted.stretch)
    require(verify, begin && !end, "stretch",
            "a pin that holds the first end of the string, and none that holds the other");
  if (!wanted.catenary) return;
  require(verify, begin && end, "catenary", "pins that hold both ends of the string");
  require(verify, scene.payloads.empty(), "catenary", "a string without payloads");
  fabric::Vector normal{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    normal[a] = ((*end)[b] - (*begin)[b]) * g[c] - ((*end)[c] - (*begin)[c]) * g[b];
  }
  require(verify, !is_zero({normal.begin(), normal.end()}), "catenary",
          "ends that are not one above the other at the end: the error is relative to their span");
}

/// Checks that the closed form of a pulled sheet holds, and that it is pulled at all.
void check_pulled(const Place& verify, const SpringsScene& scene, const std::string& name) {
  require(
      verify,
      (scene.source.strip || scene.source.rectangle) && fabric::has_triangles(scene.fabric.material.model),
      name, "mesh.strip or mesh.rectangle, and model quadratic or biquadratic");
  require(verify, std::ranges::any_of(scene.pins, [](const Pin& pin) { return !pin.motion.x.empty(); }), name,
          "a pin with motion.x, which pulls");
  require(verify,
          std::ranges::any_of(scene.pins,
                              [&scene](const Pin& pin) {
                                return !is_zero(values_at(pin.motion.x, scene.mesh, scene.time.end_time));
                              }),
          name, "a motion.x that is not 0 at the end");
  require(verify, even_line_stiffness(scene.mesh).has_value(), name,
          "reinforcements that run along x from end to end, with the same stiffness all the way");
}

void check_frequency(const Place& frequency, const SpringsScene& scene) {
  const Frequency& f = *scene.verify.frequency;
  const std::size_t numbers = f.mode.size();
  require(frequency, std::ranges::all_of(f.mode, [](double m) { return m == std::floor(m); }), "mode",
          "integers");
  if (scene.source.disk)
    require(frequency, numbers == 0 || (numbers == 2 && f.mode[1] >= 1.0), "mode",
            "two numbers for a disk: nodal diameters, and circles from 1, the rim");
  if (scene.source.string)
    require(frequency, numbers == 0 || (numbers == 1 && f.mode[0] >= 1.0), "mode",
            "one number from 1 for a string");
  const bool has_closed_form = numbers > 0 && (scene.source.disk || scene.source.string);
  require(frequency, f.value || (has_closed_form && scene.reinforcements.empty()), "",
          "a value, or a mode of a disk or of a string without reinforcement, whose closed form is known");
  if (scene.source.disk && !f.value)
    require(frequency, scene.initial.prestretch > 0.0 && fabric::has_triangles(scene.fabric.material.model),
            "mode", "initial.prestretch > 0 and model quadratic or biquadratic");
  require(frequency, static_cast<std::size_t>(f.probe) < scene.output.probes.size(), "probe",
          "a probe of that number in output.probes");
}

}  // namespace

void check_verify(const Place& root, const SpringsScene& scene) {
  const Verify& wanted = scene.verify;
  const Place verify = root.at("verify");
  framework::require_measurable(root, wanted.history, scene.output, {scene.time.end_time, "time.end_time"},
                                history_columns(scene));
  const auto require_for = [&](std::initializer_list<const char*> keys, bool holds, const char* needs) {
    for (const char* key : keys)
      if (verify.given(key)) require(verify, holds, key, needs);
  };
  const MeshSource& source = scene.source;
  const bool meets = scene.contact.is_enabled(),
             has_membrane = fabric::has_triangles(scene.fabric.material.model),
             has_level_set = std::ranges::any_of(scene.contact.objects, [](const ContactObject&object) {
               return object.kind == fabric::BodyKind::level_set;
             });
  const auto require_rows = [&](std::initializer_list<const char*> keys) {
    require_for(keys, scene.output.history_every > 0, "rows of history.csv: output.history_every > 0");
  };
  require_for({"energy_drift"}, !meets, "a scene without contact, of which energy_balance counts the work");
  require_rows({"energy_drift", "energy_balance"});
  require_for({"energy_drift", "energy_balance"},
              scene.damping.absolute == 0.0 && scene.damping.relative == 0.0, "a scene without damping");
  if (wanted.energy_drift || wanted.energy_balance)
    require_for({"energy_drift", "energy_balance"}, conserves_energy(scene),
                "pins that stay and loads that do not change; a follower pressure needs cloth that is closed "
                "or whose rim is held");
  require_for({"energy_balance", "intersections"}, meets, "contact.self or contact.objects");
  require_rows({"intersections"});
  require_for({"intersections"}, !has_level_set,
              "contact.objects without a level-set, which keeps out only vertices");
  require_for({"penetration"}, !scene.contact.objects.empty() && !has_level_set,
              "contact.objects, none of them a level-set");
  require_rows({"momentum", "angular_momentum"});
  for (const char* name : {"young", "poisson"})
    if (verify.given(name)) check_pulled(verify, scene, name);
  require_for({"hencky", "catenary", "stretch"}, scene.reinforcements.empty(),
              "a scene without reinforcement");
  if (wanted.hencky) {
    const bool has_one_load = scene.loads.size() == 1;
    const std::optional<double> pressure =
        has_one_load ? constant_value(scene.loads[0].pressure) : std::nullopt;
    require(verify, source.disk && has_membrane && pressure, "hencky",
            "mesh.disk, model quadratic or biquadratic, and one load, a constant pressure");
    require(verify, pressure != 0.0, "hencky", "a pressure other than 0");
    require(verify, scene.initial.prestretch == 0.0 && scene.fabric.material.bending_stiffness == 0.0,
            "hencky", "a membrane without prestretch and without bending stiffness");
    require(verify, !scene.pins.empty(), "hencky", "a pin, which clamps the rim");
  }
  require_for({"catenary", "stretch"},
              source.string && scene.loads.size() == 1 && !scene.loads[0].gravity.empty(),
              "mesh.string and one load, gravity");
  check_hanging(verify, scene);
  if (wanted.equilibrium)
    require(verify, has_reaction_or_load(scene), "equilibrium",
            "a pin, or a dead pressure or force: the error is relative to the largest reaction or dead load");
  require_rows({"frequency"});
  if (wanted.frequency) check_frequency(verify.at("frequency"), scene);
  for (std::size_t k = 0; k < wanted.values.size(); ++k) {
    const auto& [quantity, at, value, tolerance] = wanted.values[k];
    const Place of = verify.at("values", k);
    require(of, value != 0.0, "value", "a number other than 0, since the error is relative");
    if (is_of_vertex(quantity))
      require(of, !at.empty(), "quantity", "at, a position");
    else
      require(of, at.empty(), "at", "a quantity of a vertex");
    if (quantity == FinalQuantity::von_mises || quantity == FinalQuantity::area_growth)
      require(of, !scene.mesh.triangles.empty(), "quantity", "a mesh with triangles");
  }
  if (!wanted.front_speed) return;
  require_rows({"front_speed"});
  require(verify, scene.output.probes.size() >= 2, "front_speed", "two output.probes");
  const auto place = [&scene](std::size_t k) {
    return nearest_vertex(scene.mesh, scene.output.probes[k].at);
  };
  require(verify, place(0) != place(1), "front_speed", "two output.probes at different vertices");
}

}  // namespace drogue::springs_app
