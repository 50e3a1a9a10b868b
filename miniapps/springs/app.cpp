#include "miniapps/springs/app.hpp"

#include "kernels/fabric/host_threads.hpp"
#include "kernels/mesh/quality.hpp"
#include "miniapps/framework/metrics.hpp"
#include "miniapps/framework/typed_scene.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"
#include "miniapps/springs/simulation/simulation.hpp"
#include "miniapps/springs/verify/study.hpp"

namespace drogue::springs_app {
namespace {

class RunnableScene final : public framework::TypedScene<SpringsScene, Simulation> {
 public:
  using TypedScene::TypedScene;
  [[nodiscard]] std::string check_report() const override { return quality_report(content().mesh); }
  [[nodiscard]] int useful_threads(int) const override {
    return fabric::host_threads(content().mesh.rest.size());
  }
};

}  // namespace

framework::MiniApp mini_app() {
  framework::MiniApp app;
  app.name = "springs";
  app.description = "Cloth and strings as springs that equal a membrane.";
  app.scene_folder = scene_folder();
  app.has_baseline = true;
  app.read = [](const std::filesystem::path& file, const std::vector<std::string>& assignments, bool) {
    return std::make_unique<RunnableScene>(read_springs_scene(file, assignments), declare_springs_scene);
  };
  app.study = run_study;
  app.metrics.add_group("energy");
  framework::set_no_limiter(app.metrics);
  return app;
}

}  // namespace drogue::springs_app
