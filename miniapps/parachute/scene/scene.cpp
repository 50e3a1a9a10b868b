#include "miniapps/parachute/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "kernels/coupling/sheet/added_mass.hpp"
#include "miniapps/framework/mini_app.hpp"
#include "miniapps/framework/obj_file.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"

namespace drogue::parachute_app {
namespace {

/// Cloth of the input files of [Shi]: 134 times as heavy as that of a C-9.
constexpr double baseline_area_density = 5.0;  // kg/m^2

/// Scheme of [Shi], chapter 3: weights of Jiang and Shu (1996), SSP Runge-Kutta of three stages, explicit
/// coupling of the canopy, and its cloth unless the scene gives an area density.
void set_baseline_scheme(FlowScene& scene) {
  scene.advection = AdvectionScheme::weno5;
  scene.weights = Weights::js;
  scene.parameters.time_scheme = flow::TimeScheme::rk3;
  scene.parameters.diffusion = flow::Diffusion::explicit_;
  if (scene.has_fluid() && scene.has_sheets()) scene.coupling.method = coupling::CouplingMethod::explicit_;
  for (Canopy& canopy : scene.canopies) {
    if (canopy.cloth == Fabric::custom) continue;
    canopy.cloth = Fabric::custom;
    canopy.area_density = baseline_area_density;
  }
}

}  // namespace

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> names = {"velocity",    "pressure", "vorticity",
                                                 "q_criterion", "position", "von_mises"};
  return names;
}

bool is_canopy_field(const std::string& name) { return name == "position" || name == "von_mises"; }

FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& sets,
                          SchemeSource source, framework::InitialCheck check) {
  return framework::read_scene<FlowScene>(
      file, sets, declare_flow_scene, [&](const scene::Table& root, FlowScene& scene) {
        if (source == SchemeSource::baseline) {
          if (!scene.has_fluid()) throw Failure(ExitCode::usage, "--seed-mode needs a scene with [fluid]");
          set_baseline_scheme(scene);
        }
        complete_and_check(root, scene, check);
      });
}

double FlowScene::added_mass_ratio(const Canopy& canopy) const {
  return coupling::added_mass_ratio(parameters.density, canopy.diameter, canopy.area_density);
}

double FlowScene::largest_added_mass_ratio() const {
  double largest = 0.0;
  for (const Canopy& canopy : canopies) largest = std::max(largest, added_mass_ratio(canopy));
  return largest;
}

std::optional<std::array<double, 3>> FlowScene::stream() const { return constant_value(velocity); }

std::size_t FlowScene::owner_of(std::size_t canopy) const {
  return static_cast<std::size_t>(canopies[canopy].payload.shared.value_or(static_cast<int>(canopy)));
}

bool FlowScene::descends(std::size_t canopy) const {
  return has_fluid() && canopies[canopy].has_lines() && !canopies[owner_of(canopy)].payload.fixed &&
         gravity != std::array<double, 3>{};
}

std::string FlowScene::lack_of_airspeed(std::size_t canopy) const {
  if (!has_fluid()) return "which needs [fluid]";
  const std::optional<std::array<double, 3>> constant = stream();
  if (!constant) return "which needs a fluid.velocity that does not vary";
  const bool is_drum = canopies[canopy].kind == CanopyKind::drum;
  const std::size_t owner = owner_of(canopy);
  const bool moves = !is_drum && !(canopies[owner].has_lines() && canopies[owner].payload.fixed);
  if (moves || *constant != std::array<double, 3>{}) return "";
  return "which is 0: fluid.velocity is 0 and canopy[" + std::to_string(is_drum ? canopy : owner) + "]" +
         (is_drum ? ".kind is \"drum\", whose rim rests" : ".payload.fixed is true");
}

bool FlowScene::has_free_sheets() const {
  return !canopies.empty() || !flags.empty() ||
         std::ranges::any_of(bodies, [](const Body& body) { return body.mount.has_value(); });
}

std::array<bool, 3> FlowScene::open_axes() const {
  std::array<bool, 3> axes{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    axes[axis] =
        is_open(parameters.boundary[2 * axis].kind) && is_open(parameters.boundary[2 * axis + 1].kind);
  return axes;
}

double core_width(const flow::Parameters& p, std::size_t axis) { return flow::core_of(p).spacing[axis]; }

double least_width(const flow::Parameters& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (p.cells[axis] > 1) least = std::min(least, core_width(p, axis));
  return least;
}

std::array<double, 2> sheet_extent(const flow::Parameters& p, std::size_t axis) {
  const flow::Core box = flow::force_box(p);
  return {box.low[axis], box.high[axis]};
}

std::string print_flow_scene(const FlowScene& scene) {
  return framework::print_scene(scene, declare_flow_scene);
}

framework::SceneIdentity scene_identity(FlowScene scene) {
  const FlowScene neutral;
  scene.description.clear();
  scene.output = neutral.output;
  scene.output.restart_every = 0;  // its former default, as in older restart files
  scene.verify = neutral.verify;
  scene.end_time = 1.0;
  const auto keep = [&](auto flow::Parameters::*member) {
    scene.parameters.*member = neutral.parameters.*member;
  };
  keep(&flow::Parameters::max_steps);
  keep(&flow::Parameters::driver);
  keep(&flow::Parameters::block);
  scene.contact_block = 0;
  scene.parameters.cfl = 0.5;  // its default follows from the time scheme
  keep(&flow::Parameters::fixed_dt);
  keep(&flow::Parameters::max_dt);
  for (Canopy& canopy : scene.canopies) {
    canopy.payload.release.reset();
    if (canopy.reefing) canopy.reefing->cut.reset();
  }
  // The content of a mesh file counts, not its path.
  std::string surfaces;
  for (Body& body : scene.bodies) {
    if (body.kind != BodyKind::file) continue;
    surfaces += framework::contents_of(body.surface);
    body.file = "mesh.obj";
  }
  return {print_flow_scene(scene), surfaces};
}

std::filesystem::path scene_folder() {
  return framework::find_scene_folder("parachute", DROGUE_PARACHUTE_SCENES);
}

std::string document_flow_scene() {
  return framework::document_scene(
      declare_flow_scene, "Parachute", "FlowSceneDocument",
      R"(A component of a velocity is a number or an expression in muParser syntax. Expressions of t, and the velocities of
sides unless they are numbers, are evaluated in every step: each has at most 96 operations, names and numbers, of them
at most 32 numbers, and waits with at most 16 operands.
)");
}

}  // namespace drogue::parachute_app
