#include "miniapps/springs/app.hpp"

#include <cmath>
#include <cstdio>

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

/// ", 1.2e-3 J of energy lost (0.04 %)", or gained, where energy is conserved; empty elsewhere.
std::string energy_summary(const run::ResultDocument& result) {
  const std::optional<double> lost = result.metrics.real("energy", "lost");
  if (!lost) return {};
  char text[80];
  std::snprintf(text, sizeof text, ", %.2g J of energy %s (%.2g %%)", std::abs(*lost),
                *lost < 0.0 ? "gained" : "lost",
                100.0 * std::abs(result.metrics.real("energy", "lost_share").value_or(0.0)));
  return text;
}

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
  app.check_study = check_study;
  app.summary = energy_summary;
  app.metrics.add_group("energy");
  framework::set_no_limiter(app.metrics);
  return app;
}

}  // namespace drogue::springs_app
