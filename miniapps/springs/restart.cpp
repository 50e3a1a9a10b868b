#include "miniapps/springs/restart.hpp"

#include <span>

#include "common/run/restart_file.hpp"
#include "miniapps/springs/vectors.hpp"

namespace drogue::springs_app {
namespace {

/// The one list of what a restart file holds beside the vertices: `number` and `integer` write or read one
/// entry.
template <class State, class Number, class Integer>
void visit(State& state, const Number& number, const Integer& integer) {
  integer("step", state.clock.step);
  number("dt", state.clock.dt);
  integer("since", state.clock.since);
  number("start", state.clock.start);
  integer("stop_step", state.stop_step);
  number("stop_time", state.stop_time);
  number("dt_min", state.dt_min);
  number("dt_max", state.dt_max);
  number("asked_dt", state.asked.dt);
  number("asked_safety", state.asked.safety);
}

/// What is kept of contact; its work under the names that history.csv has for it.
constexpr std::pair<const char*, double fabric::ContactWork::*> work_parts[] = {
    {"contact_work", &fabric::ContactWork::normal},
    {"friction_work", &fabric::ContactWork::friction},
    {"contact_kick_x", &fabric::ContactWork::kick_x},
    {"contact_kick_y", &fabric::ContactWork::kick_y},
    {"contact_kick_z", &fabric::ContactWork::kick_z}};

}  // namespace

AskedSteps asked_steps(const SpringsScene& scene) { return {scene.time.dt.value_or(0.0), scene.time.safety}; }

std::string scene_fingerprint(SpringsScene scene) {
  scene.description.clear();
  scene.output = {};
  scene.verify = {};
  scene.driver = fabric::Driver::automatic;
  scene.time.end_time = 0.0;
  scene.time.dt.reset();
  scene.time.safety = Time{}.safety;
  // What a file holds counts, not where it lies.
  std::string contents;
  if (!scene.source.file.empty()) {
    const auto bytes = std::as_bytes(numbers(scene.mesh.rest));
    contents.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (const auto& triangle : scene.mesh.triangles)
      for (const int i : triangle) contents += std::to_string(i) + " ";
    for (const auto& line : scene.mesh.lines)
      for (const int i : line) contents += std::to_string(i) + " ";
    scene.source.file = "mesh.obj";
  }
  return run::fingerprint(print_springs_scene(scene) + contents);
}

void write_restart(const std::filesystem::path& file, const std::string& fingerprint,
                   const RestartState& state) {
  run::RestartWriter writer(file, fingerprint);
  visit(
      state, [&](const std::string& name, double value) { writer.number(name, value); },
      [&](const std::string& name, std::int64_t value) { writer.integer(name, value); });
  for (const auto& [name, vectors] : {std::pair{"position", &state.x}, std::pair{"velocity", &state.v}}) {
    writer.array(name, 3 * vectors->size());
    writer.write(name, 0, numbers(*vectors));
  }
  for (const auto& [name, part] : work_parts) {
    if (state.contact_work.empty()) break;
    std::vector<double> values;
    for (const fabric::ContactWork& work : state.contact_work) values.push_back(work.*part);
    writer.array(name, values.size());
    writer.write(name, 0, values);
  }
  writer.commit();
}

RestartState read_restart(const std::filesystem::path& file, const SpringsScene& scene) {
  const run::RestartReader reader(file, scene_fingerprint(scene));
  RestartState state;
  visit(
      state, [&](const std::string& name, double& value) { value = reader.number(name); },
      [&](const std::string& name, std::int64_t& value) { value = reader.integer(name); });
  state.x.resize(scene.mesh.rest.size());
  state.v.resize(scene.mesh.rest.size());
  reader.read("position", 0, numbers(state.x));
  reader.read("velocity", 0, numbers(state.v));
  if (!scene.contact.asked_for()) return state;
  state.contact_work.resize(scene.mesh.rest.size());
  for (const auto& [name, part] : work_parts) {
    std::vector<double> values(scene.mesh.rest.size());
    reader.read(name, 0, values);
    for (std::size_t i = 0; i < values.size(); ++i) state.contact_work[i].*part = values[i];
  }
  return state;
}

}  // namespace drogue::springs_app
