#include "miniapps/gas/app.hpp"

#include "kernels/gas/host_threads.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/gas/scene/scene_keys.hpp"
#include "miniapps/gas/simulation/simulation.hpp"
#include "miniapps/gas/verify/study.hpp"

namespace drogue::gas_app {
namespace {

class RunnableScene final : public framework::TypedScene<GasScene, Simulation> {
 public:
  using TypedScene::TypedScene;
  [[nodiscard]] std::string precision() const override { return precision_name(content().parameters); }
  [[nodiscard]] int useful_threads(int) const override { return gas::host_threads(content().parameters); }
};

std::unique_ptr<framework::Scene> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& assignments, bool baseline) {
  return std::make_unique<RunnableScene>(
      read_gas_scene(file, assignments, baseline ? SchemeSource::baseline : SchemeSource::scene),
      declare_gas_scene);
}

std::string limiter_summary(const run::ResultDocument& result) {
  const auto count = [&](const char* name) {
    return std::to_string(result.metrics.integer("limiter", name));
  };
  return ", limiter touches " + count("touches") + ", redone steps " + count("redone_steps");
}

}  // namespace

framework::MiniApp mini_app() {
  framework::MiniApp app;
  app.name = "gas";
  app.description = "One-dimensional Euler equations with characteristic WENO5.";
  app.scene_folder = scene_folder();
  app.has_baseline = true;
  app.read = read;
  app.study = run_study;
  app.check_study = check_study;
  app.summary = limiter_summary;
  set_limiter_metrics({}, app.metrics);
  return app;
}

}  // namespace drogue::gas_app
