#include <algorithm>
#include <cmath>

#include "common/scene/read.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/scene/scene_check.hpp"
#include "miniapps/springs/verify/verify.hpp"

namespace drogue::springs_app {
namespace {

using scene::contradict;
using scene::Table;

void require(const Table& root, bool holds, const std::string& path, const std::string& needs) {
  if (!holds) contradict(root, path, path + " needs " + needs);
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
    const bool steady =
        std::ranges::none_of(scene.pins, [](const Pin& pin) { return pin.motion.given(); }) &&
        std::ranges::all_of(scene.loads, [](const Load& load) {
          return load.follower_pressure.empty() && !depends_on_time(load.pressure) &&
                 (!load.force || !(depends_on_time(load.force->x) || depends_on_time(load.force->y) ||
                                   depends_on_time(load.force->z)));
        });
    require(root, steady, name, "pins that stay and loads that do not change");
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
    if (!tolerance) continue;
    require(root, (source.strip || source.rectangle) && fabric::has_triangles(scene.fabric.material.model),
            name, "mesh.strip or mesh.rectangle, and model quadratic or biquadratic");
    require(root, std::ranges::any_of(scene.pins, [](const Pin& pin) { return !pin.motion.x.empty(); }), name,
            "a pin with motion.x, which pulls");
    require(root, even_line_stiffness(scene.mesh).has_value(), name,
            "reinforcements that run along x from end to end, with the same stiffness all the way");
  }
  for (const auto& [name, tolerance] :
       {std::pair{"verify.hencky", verify.hencky}, std::pair{"verify.catenary", verify.catenary},
        std::pair{"verify.stretch", verify.stretch}})
    if (tolerance) require(root, scene.reinforcements.empty(), name, "a scene without reinforcement");
  if (verify.hencky)
    require(root,
            source.disk && fabric::has_triangles(scene.fabric.material.model) && scene.loads.size() == 1 &&
                constant_value(scene.loads[0].pressure),
            "verify.hencky", "mesh.disk, model quadratic or biquadratic, and one load, a constant pressure");
  for (const auto& [name, tolerance] :
       {std::pair{"verify.catenary", verify.catenary}, std::pair{"verify.stretch", verify.stretch}})
    if (tolerance)
      require(root, source.string && scene.loads.size() == 1 && !scene.loads[0].gravity.empty(), name,
              "mesh.string and one load, gravity");
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
  }
}

}  // namespace drogue::springs_app
