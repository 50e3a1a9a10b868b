#include "miniapps/parachute/scene/scene.hpp"

#include "common/run/restart/restart_file.hpp"
#include "miniapps/framework/mini_app.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> names = {"velocity",    "pressure", "vorticity",
                                                 "q_criterion", "position", "von_mises"};
  return names;
}

bool is_canopy_field(const std::string& name) { return name == "position" || name == "von_mises"; }

FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  return framework::read_scene<FlowScene>(file, sets, declare_flow_scene, complete_and_check);
}

std::array<bool, 3> FlowScene::open_axes() const {
  const auto is_open = [this](std::size_t side) {
    const flow::BoundaryKind kind = parameters.boundary[side].kind;
    return kind == flow::BoundaryKind::inflow || kind == flow::BoundaryKind::outflow;
  };
  std::array<bool, 3> axes{};
  for (std::size_t axis = 0; axis < 3; ++axis) axes[axis] = is_open(2 * axis) && is_open(2 * axis + 1);
  return axes;
}

std::string print_flow_scene(const FlowScene& scene) {
  return framework::print_scene(scene, declare_flow_scene);
}

std::string scene_fingerprint(FlowScene scene) {
  const FlowScene neutral;
  scene.description.clear();
  scene.output = neutral.output;
  scene.verify = neutral.verify;
  scene.end_time = 1.0;
  const auto keep = [&](auto flow::Parameters::*member) {
    scene.parameters.*member = neutral.parameters.*member;
  };
  keep(&flow::Parameters::max_steps);
  keep(&flow::Parameters::driver);
  keep(&flow::Parameters::cfl);
  keep(&flow::Parameters::fixed_dt);
  keep(&flow::Parameters::max_dt);
  // The content of a mesh file counts, not its path.
  std::string surfaces;
  for (Body& body : scene.bodies) {
    if (body.kind != BodyKind::file) continue;
    surfaces += framework::contents_of(body.surface);
    body.file = "mesh.obj";
  }
  return run::fingerprint(print_flow_scene(scene) + surfaces);
}

std::filesystem::path scene_folder() {
  return framework::find_scene_folder("parachute", DROGUE_PARACHUTE_SCENES);
}

std::string document_flow_scene() {
  return framework::document_scene(
      declare_flow_scene, "Parachute", "FlowSceneDocument",
      "A component of a velocity is a number or an expression in muParser syntax.\n");
}

}  // namespace drogue::parachute_app
