#include "miniapps/gas/scene/scene.hpp"

#include "miniapps/framework/mini_app.hpp"
#include "miniapps/framework/typed_scene.hpp"
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
                        SchemeSource source, framework::InitialCheck check) {
  return framework::read_scene<GasScene>(file, sets, declare_gas_scene,
                                         [&](const scene::Table& root, GasScene& scene) {
                                           if (source == SchemeSource::baseline)
                                             set_baseline_scheme(scene.parameters);
                                           complete_and_check(root, scene, check);
                                         });
}

std::string print_gas_scene(const GasScene& scene) {
  return framework::print_scene(scene, declare_gas_scene);
}

framework::SceneIdentity scene_identity(GasScene scene) {
  scene.description.clear();
  scene.output = {};
  scene.output.restart_every = 0;  // its former default, as in older restart files
  scene.verify = {};
  scene.end_time = 1.0;
  scene.parameters.max_steps = 1;
  scene.parameters.block = 0;
  scene.parameters.driver = gas::Driver::automatic;
  return {print_gas_scene(scene)};
}

std::filesystem::path scene_folder() { return framework::find_scene_folder("gas", DROGUE_GAS_SCENES); }

std::string document_gas_scene() {
  return framework::document_scene(declare_gas_scene, "Gas", "GasSceneDocument");
}

}  // namespace drogue::gas_app
