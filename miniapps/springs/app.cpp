#include "miniapps/springs/app.hpp"

#include <utility>

#include "kernels/mesh/quality.hpp"
#include "miniapps/springs/simulation/simulation.hpp"
#include "miniapps/springs/verify/study.hpp"

namespace drogue::springs_app {
namespace {

class RunnableScene final : public framework::Scene {
 public:
  explicit RunnableScene(SpringsScene scene) : _scene(std::move(scene)) {}

  [[nodiscard]] std::string print() const override { return print_springs_scene(_scene); }
  [[nodiscard]] std::string fingerprint() const override { return scene_fingerprint(_scene); }
  [[nodiscard]] std::string check_report() const override { return quality_report(_scene.mesh); }
  [[nodiscard]] std::unique_ptr<framework::Simulation> create(
      const framework::SimulationSettings& settings) const override {
    return std::make_unique<Simulation>(_scene, settings);
  }

 private:
  SpringsScene _scene;
};

}  // namespace

framework::MiniApp mini_app() {
  framework::MiniApp app;
  app.name = "springs";
  app.description = "Cloth and strings as springs that equal a membrane.";
  app.scene_folder = scene_folder();
  app.has_baseline = true;
  app.read = [](const std::filesystem::path& file, const std::vector<std::string>& assignments, bool) {
    return std::make_unique<RunnableScene>(read_springs_scene(file, assignments));
  };
  app.study = run_study;
  app.metrics.add_group("energy");
  // The schema of result.json holds the counts of a flux limiter for every program.
  for (const char* count : {"touches", "cells", "redone_steps"})
    app.metrics.set("limiter", count, std::int64_t{0});
  return app;
}

}  // namespace drogue::springs_app
