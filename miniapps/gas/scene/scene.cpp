#include "miniapps/gas/scene/scene.hpp"

#include "common/run/restart/restart_file.hpp"
#include "common/scene/document.hpp"
#include "common/scene/print.hpp"
#include "common/scene/read.hpp"
#include "miniapps/framework/mini_app.hpp"
#include "miniapps/gas/scene/scene_check.hpp"
#include "miniapps/gas/scene/scene_keys.hpp"

namespace drogue::gas_app {
namespace {

/// Scheme of [Shi]: one alpha per field over the mesh, weights of Jiang and Shu (1996), eigenvectors at the
/// arithmetic mean of the conserved variables, SSP Runge-Kutta of three stages.
void set_baseline_scheme(gas::Parameters& parameters) {
  parameters.weno = gas::Weno::js;
  parameters.splitting = gas::Splitting::lf_global;
  parameters.time_scheme = gas::TimeScheme::ssprk3;
  parameters.face_average = gas::FaceAverage::conserved;
  parameters.positivity = gas::Positivity::off;
  parameters.precision = gas::Precision::full;
}

}  // namespace

GasScene read_gas_scene(const std::filesystem::path& file, const std::vector<std::string>& sets,
                        SchemeSource source) {
  GasScene result;
  result.file = file;
  result.name = file.stem().string();
  scene::Table root;
  declare_gas_scene(root, result);
  scene::read_file(root, file, sets);
  if (source == SchemeSource::baseline) set_baseline_scheme(result.parameters);
  complete_and_check(root, result);
  return result;
}

std::string print_gas_scene(const GasScene& scene) {
  GasScene copy = scene;
  scene::Table root;
  declare_gas_scene(root, copy);
  return scene::print(root);
}

std::string scene_fingerprint(GasScene scene) {
  scene.description.clear();
  scene.output = {};
  scene.verify = {};
  scene.end_time = 1.0;
  scene.parameters.max_steps = 1;
  scene.parameters.block = 0;
  scene.parameters.driver = gas::Driver::automatic;
  return run::fingerprint(print_gas_scene(scene));
}

std::filesystem::path scene_folder() { return framework::find_scene_folder("gas", DROGUE_GAS_SCENES); }

std::string document_gas_scene() {
  GasScene defaults;
  scene::Table root;
  declare_gas_scene(root, defaults);
  return R"(# Gas scenes: all keys

Written from the declarations that also read, check and print a scene; do not edit. After a change of them:
`DROGUE_UPDATE_DOCS=1 ctest --test-dir build/host -R GasSceneDocument`.

A scene is a TOML file. Unknown keys are refused. Numbers are in SI units; an integer is accepted for a real.

)" + scene::document(root);
}

}  // namespace drogue::gas_app
