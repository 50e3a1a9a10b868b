#include "miniapps/parachute/app.hpp"

#include <utility>

#include "miniapps/parachute/parallel/serve.hpp"
#include "miniapps/parachute/simulation.hpp"
#include "miniapps/parachute/study.hpp"

namespace drogue::parachute_app {
namespace {

class RunnableScene final : public framework::Scene {
 public:
  explicit RunnableScene(FlowScene scene) : _scene(std::move(scene)) {}

  [[nodiscard]] std::string print() const override { return print_flow_scene(_scene); }
  [[nodiscard]] std::string fingerprint() const override { return scene_fingerprint(_scene); }
  [[nodiscard]] std::unique_ptr<framework::Simulation> create(
      const framework::SimulationSettings& settings) const override {
    return std::make_unique<Simulation>(_scene, settings);
  }

 private:
  FlowScene _scene;
};

std::unique_ptr<framework::Scene> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& assignments, bool /*baseline*/) {
  return std::make_unique<RunnableScene>(read_flow_scene(file, assignments));
}

}  // namespace

framework::MiniApp mini_app() {
  framework::MiniApp app;
  app.name = "parachute";
  app.description = "Incompressible flow on a staggered grid.";
  app.scene_folder = scene_folder();
  app.read = read;
  app.study = run_study;
  app.serve = serve;
  // The schema of result.json holds the counts of a flux limiter for every program.
  for (const char* count : {"touches", "cells", "redone_steps"})
    app.metrics.set("limiter", count, std::int64_t{0});
  return app;
}

}  // namespace drogue::parachute_app
