#include "miniapps/gas/app.hpp"

#include <utility>

#include "miniapps/gas/simulation/simulation.hpp"
#include "miniapps/gas/verify/study.hpp"

namespace drogue::gas_app {
namespace {

class RunnableScene final : public framework::Scene {
 public:
  explicit RunnableScene(GasScene scene) : _scene(std::move(scene)) {}

  [[nodiscard]] std::string print() const override { return print_gas_scene(_scene); }
  [[nodiscard]] std::string fingerprint() const override { return scene_fingerprint(_scene); }
  [[nodiscard]] std::string precision() const override { return precision_name(_scene.parameters); }
  [[nodiscard]] std::unique_ptr<framework::Simulation> create(
      const framework::SimulationSettings& settings) const override {
    return std::make_unique<Simulation>(_scene, settings);
  }

 private:
  GasScene _scene;
};

std::unique_ptr<framework::Scene> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& assignments, bool baseline) {
  return std::make_unique<RunnableScene>(
      read_gas_scene(file, assignments, baseline ? SchemeSource::baseline : SchemeSource::scene));
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
  app.summary = limiter_summary;
  set_limiter_metrics({}, app.metrics);
  return app;
}

}  // namespace drogue::gas_app
