#include "miniapps/parachute/scene.hpp"

#include "common/run/restart/restart_file.hpp"
#include "common/scene/document.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "miniapps/framework/mini_app.hpp"
#include "miniapps/parachute/scene_check.hpp"
#include "miniapps/parachute/scene_keys.hpp"

namespace drogue::parachute_app {

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> names = {"velocity", "pressure", "vorticity", "q_criterion"};
  return names;
}

FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  FlowScene scene;
  scene.file = file;
  scene.name = file.stem().string();
  scene::Table root;
  declare_flow_scene(root, scene);
  scene::read_file(root, file, sets);
  complete_and_check(root, scene);
  return scene;
}

std::string print_flow_scene(const FlowScene& scene) {
  FlowScene copy = scene;
  scene::Table root;
  declare_flow_scene(root, copy);
  return scene::print(root);
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
  return run::fingerprint(print_flow_scene(scene));
}

std::filesystem::path scene_folder() {
  return framework::find_scene_folder("parachute", DROGUE_PARACHUTE_SCENES);
}

std::string document_flow_scene() {
  FlowScene defaults;
  scene::Table root;
  declare_flow_scene(root, defaults);
  return R"(# Parachute scenes: all keys

Written from the declarations that also read, check and print a scene; do not edit. After a change of them:
`DROGUE_UPDATE_DOCS=1 ctest --test-dir build/host -R FlowSceneDocument`.

A scene is a TOML file. Unknown keys are refused. Numbers are in SI units; an integer is accepted for a real.
A component of a velocity is a number or an expression in muParser syntax.

)" + scene::document(root);
}

}  // namespace drogue::parachute_app
