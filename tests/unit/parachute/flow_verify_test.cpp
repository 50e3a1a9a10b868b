#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "kernels/device/runtime.hpp"
#include "miniapps/framework/run_loop.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

// The shipped uniform stream has no errors: every error below is that of one changed value. The pressure is
// that of the velocity, so that one wrong velocity makes both wrong.

namespace drogue::parachute_app {
namespace {

class FlowVerify : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { runtime = std::make_unique<device::Runtime>(std::vector<std::string>{}); }
  static void TearDownTestSuite() { runtime.reset(); }
  static std::unique_ptr<device::Runtime> runtime;

  void SetUp() override {
    const std::string file = std::string(DROGUE_SOURCE_DIR) + "/miniapps/parachute/scenes/uniform.toml";
    _scene = read_flow_scene(file, {"verify.exact.pressure=0", "verify.divergence=1e-12",
                                    "verify.l1_velocity=1e-12", "verify.l2_pressure=1e-12",
                                    "verify.profile=[{component='x',along='x',through=[0,0,1.5],"
                                    "maximum={value=1.1,tolerance=1e-12}}]"});
    _simulation = std::make_unique<Simulation>(
        _scene, framework::SimulationSettings{device::Backend::serial, false, true});
    _simulation->start();
    EXPECT_EQ(framework::run_to_end(*_simulation, {{}, true, true, {}}, _result), ExitCode::ok);
  }

  /// Changes one value of the velocity along an axis.
  void change(std::size_t axis, std::array<int, 3> point, double by) {
    const Lattice lattice = lattice_of(_scene.parameters, axis);
    std::vector<double> values(lattice.size());
    _simulation->solver().download(flow::velocity_name(axis), values);
    values[static_cast<std::size_t>(point[0] + lattice.n[0] * (point[1] + lattice.n[1] * point[2]))] += by;
    _simulation->solver().upload(flow::velocity_name(axis), values);
  }

  /// Names of the checks that fail, in order.
  std::vector<std::string> failed() {
    run::ResultDocument result = _result;
    EXPECT_EQ(_simulation->verify(nullptr, result), ExitCode::ok);
    std::vector<std::string> names;
    for (const run::Check& check : result.checks)
      if (!check.passed) names.push_back(check.name);
    return names;
  }

  FlowScene _scene;
  run::ResultDocument _result;
  std::unique_ptr<Simulation> _simulation;
};
std::unique_ptr<device::Runtime> FlowVerify::runtime;

using Names = std::vector<std::string>;

TEST_F(FlowVerify, UnchangedStatePasses) { EXPECT_EQ(failed(), Names{}); }

TEST_F(FlowVerify, RowsHaveTheKineticEnergy) {
  const auto columns = _simulation->history_columns();
  const auto column = std::ranges::find(columns, "kinetic_energy", &run::Column::name) - columns.begin();
  const double speed_squared = 1.1 * 1.1 + 0.7 * 0.7 + 0.3 * 0.3, volume = 6.0;
  const double energy = 0.5 * 1.225 * volume * speed_squared;
  const framework::HistoryRow row = _simulation->row();
  ASSERT_EQ(row.values.size(), columns.size());
  EXPECT_NEAR(row.values[static_cast<std::size_t>(column)], energy, 1e-12 * energy);
}

TEST_F(FlowVerify, NormsAreMeansOverTheVolume) {
  change(1, {3, 4, 5}, 0.5);
  const double points = 20.0 * 18.0 * 16.0;
  const auto norms = _simulation->error_norms();
  EXPECT_DOUBLE_EQ(norms.at("linf_velocity"), 0.5);
  EXPECT_NEAR(norms.at("l1_velocity"), 0.5 / points, 1e-15);
  EXPECT_NEAR(norms.at("l2_velocity"), 0.5 / std::sqrt(points), 1e-14);
  EXPECT_EQ(failed(), (Names{"l1_velocity", "l2_pressure", "linf_velocity", "divergence"}));
}

TEST_F(FlowVerify, FacesOnSidesCountHalf) {
  change(0, {0, 4, 5}, 0.5);
  EXPECT_NEAR(_simulation->error_norms().at("l1_velocity"), 0.25 / (20.0 * 18.0 * 16.0), 1e-15);
}

TEST_F(FlowVerify, ProfilesSeeTheirLineAlone) {
  // The line is at y = 0 between the cells 8 and 9, and at z = 1.5 between the cells 7 and 8.
  change(0, {10, 3, 3}, 0.5);
  EXPECT_EQ(failed(), (Names{"l1_velocity", "l2_pressure", "linf_velocity", "divergence"}));
  change(0, {10, 8, 7}, 0.5);
  EXPECT_EQ(failed(),
            (Names{"l1_velocity", "l2_pressure", "linf_velocity", "divergence", "profile_0_maximum"}));
}

TEST_F(FlowVerify, PressureErrorsFailTheirCheckAlone) {
  _scene.verify.exact->pressure = "1.225";
  EXPECT_NEAR(_simulation->error_norms().at("linf_pressure"), 1.225, 1e-12);
  EXPECT_EQ(failed(), Names{"l2_pressure"});
}

TEST_F(FlowVerify, NanFailsEveryCheckOfTheVelocity) {
  change(0, {10, 8, 7}, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(failed(),
            (Names{"l1_velocity", "l2_pressure", "linf_velocity", "divergence", "profile_0_maximum"}));
}

}  // namespace
}  // namespace drogue::parachute_app
