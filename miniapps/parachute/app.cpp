#include "miniapps/parachute/app.hpp"

#include <sstream>

#include "common/program/program.hpp"
#include "kernels/fabric/host_threads.hpp"
#include "kernels/flow/diffusive_step.hpp"
#include "kernels/flow/host_threads.hpp"
#include "kernels/mesh/quality.hpp"
#include "miniapps/framework/metrics.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/parachute/scene/run_size.hpp"
#include "miniapps/parachute/scene/scene_keys.hpp"
#include "miniapps/parachute/simulation/cloth_simulation.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"
#include "miniapps/parachute/verify/ensemble.hpp"
#include "miniapps/parachute/verify/flight.hpp"
#include "miniapps/parachute/verify/study.hpp"

namespace drogue::parachute_app {
namespace {

/// Prints a notice if explicit diffusion alone needs more steps than a run may take.
void print_diffusive_limit(const FlowScene& scene) {
  constexpr double many_steps = 1e7;
  const double dt = flow::largest_diffusive_dt(scene.parameters), steps = scene.end_time / dt;
  if (scene.parameters.fixed_dt > 0.0 || !(steps > many_steps)) return;
  std::ostringstream text;
  text.precision(2);
  text << "viscosity limits a step to " << dt << " s, so that the run needs more than " << steps
       << " of them; flow.diffusion = \"crank-nicolson\" has no such limit";
  print_notice("drogue-parachute", text.str());
}

/// A flow, or a cloth drop.
class ParachuteScene final : public framework::TypedScene<FlowScene, Simulation> {
 public:
  using TypedScene::TypedScene;

  [[nodiscard]] std::unique_ptr<framework::Simulation> create(
      const framework::SimulationSettings& settings) const override {
    if (!content().has_fluid()) return std::make_unique<ClothSimulation>(content(), settings);
    if (!settings.quiet) print_diffusive_limit(content());
    return TypedScene::create(settings);
  }

  [[nodiscard]] std::string check_report() const override {
    std::string text = content().has_fluid() ? run_size_report(content()) : std::string();
    for (std::size_t i = 0; i < content().bodies.size(); ++i)
      if (const Body& body = content().bodies[i]; body.kind == BodyKind::file)
        text += "body[" + std::to_string(i) + "] " + quality_report(body.surface);
    return text;
  }

  [[nodiscard]] int useful_threads(int ranks) const override {
    const FlowScene& scene = content();
    if (scene.has_fluid()) return flow::host_threads(scene.parameters, ranks);
    return fabric::host_threads(cloth_sheets(scene).positions.size());
  }
};

std::unique_ptr<framework::Scene> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& assignments, bool baseline) {
  return std::make_unique<ParachuteScene>(
      read_flow_scene(file, assignments, baseline ? SchemeSource::baseline : SchemeSource::scene),
      declare_flow_scene);
}

}  // namespace

framework::MiniApp mini_app() {
  framework::MiniApp app;
  app.name = "parachute";
  app.description =
      "Parachutes in incompressible flow on a staggered grid, the flow alone, or the cloth alone.";
  app.scene_folder = scene_folder();
  app.has_baseline = true;
  app.read = read;
  app.study = run_study;
  app.check_study = check_study;
  app.report = flight_report;
  app.runs_on_ranks = true;
  framework::set_no_limiter(app.metrics);
  return app;
}

}  // namespace drogue::parachute_app
