#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "kernels/device/runtime.hpp"
#include "miniapps/framework/run_loop.hpp"
#include "miniapps/gas/simulation/simulation.hpp"

// Every check of a scene must fail for an invalid state: the tests change one cell of a finished run.

namespace drogue::gas_app {
namespace {

const std::string shipped = std::string(DROGUE_SOURCE_DIR) + "/miniapps/gas/scenes/";

class GasVerify : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { runtime = std::make_unique<device::Runtime>(std::vector<std::string>{}); }
  static void TearDownTestSuite() { runtime.reset(); }
  static std::unique_ptr<device::Runtime> runtime;
};
std::unique_ptr<device::Runtime> GasVerify::runtime;

/// Names of failed and passed checks.
struct Verdict {
  std::set<std::string> failed, passed;
};

/// Finished run of a scene.
class FinishedRun {
 public:
  FinishedRun(const std::string& name, const std::vector<std::string>& sets)
      : _scene(read_gas_scene(shipped + name + ".toml", sets)),
        _simulation(_scene, {device::Backend::serial, false, true}) {
    _simulation.start();
    EXPECT_EQ(framework::run_to_end(_simulation, {{}, true, true, {}}, _result), ExitCode::ok);
  }

  Verdict verify() {
    run::ResultDocument result = _result;
    _simulation.verify(nullptr, result);
    Verdict verdict;
    for (const run::Check& check : result.checks)
      (check.passed ? verdict.passed : verdict.failed).insert(check.name);
    EXPECT_EQ(verdict.failed.empty(), result.failed_check().empty());
    errors = result.errors;
    return verdict;
  }

  /// Verdict with `change(rho, m, E)` applied to one cell, which is restored afterwards.
  template <class Change>
  Verdict verify_with(std::int64_t cell, const Change& change) {
    std::array<std::vector<double>, 3> u = {std::vector<double>(1), std::vector<double>(1),
                                            std::vector<double>(1)};
    _simulation.solver().download(cell, {u[0], u[1], u[2]});
    auto changed = u;
    change(changed[0][0], changed[1][0], changed[2][0]);
    _simulation.solver().upload(cell, {changed[0], changed[1], changed[2]});
    const Verdict verdict = verify();
    _simulation.solver().upload(cell, {u[0], u[1], u[2]});
    return verdict;
  }

  std::map<std::string, double> errors;  ///< of the last verdict

 private:
  GasScene _scene;
  run::ResultDocument _result;
  Simulation _simulation;
};

/// Sod's tube with tolerances 1 % above its nine errors, and its conservation.
FinishedRun strict_sod() {
  std::vector<std::string> sets = {"output.fields=[]"};
  FinishedRun run("sod", sets);
  run.verify();
  for (const auto& [name, error] : run.errors)
    sets.push_back("verify." + name + "=" + std::to_string(1.01 * error));
  return {"sod", sets};
}

TEST_F(GasVerify, DetectsAnErrorInOneCell) {
  FinishedRun run = strict_sod();
  const Verdict honest = run.verify();
  EXPECT_EQ(honest.failed, std::set<std::string>());
  EXPECT_EQ(honest.passed.size(), 10U);
  for (const std::int64_t cell : {0, 77, 199}) {
    // Density alone: velocity and pressure are kept.
    const Verdict density = run.verify_with(cell, [](double& rho, double& m, double& e) {
      const double u = m / rho;
      e += 0.5 * 0.9 * m * u;
      rho *= 1.9;
      m = rho * u;
    });
    for (const char* name : {"l1_density", "l2_density", "linf_density", "conservation"})
      EXPECT_TRUE(density.failed.count(name)) << name << " in cell " << cell;
    EXPECT_TRUE(density.passed.count("linf_velocity"));
    const Verdict velocity = run.verify_with(cell, [](double& rho, double& m, double& e) {
      e -= 0.5 * m * m / rho;
      m += 2.0 * rho;
      e += 0.5 * m * m / rho;
    });
    for (const char* name : {"l1_velocity", "l2_velocity", "linf_velocity", "conservation"})
      EXPECT_TRUE(velocity.failed.count(name)) << name << " in cell " << cell;
    EXPECT_TRUE(velocity.passed.count("linf_density"));
    EXPECT_TRUE(velocity.passed.count("l1_pressure"));
    const Verdict pressure = run.verify_with(cell, [](double&, double&, double& e) { e += 2.5; });
    for (const char* name : {"l1_pressure", "l2_pressure", "linf_pressure", "conservation"})
      EXPECT_TRUE(pressure.failed.count(name)) << name << " in cell " << cell;
    EXPECT_TRUE(pressure.passed.count("l1_density"));
  }
  EXPECT_EQ(run.verify().failed, std::set<std::string>()) << "the state is what it was";
}

TEST_F(GasVerify, ConservationDetectsRelativeChangesOf1e12) {
  FinishedRun run = strict_sod();
  // The tolerance is 1e-12 of the total, and one of 200 cells is changed.
  const auto fails = [&](auto&& change) {
    return run.verify_with(50, change).failed.count("conservation") == 1;
  };
  EXPECT_TRUE(fails([](double& rho, double&, double&) { rho *= 1.0 + 1e-9; }));
  EXPECT_TRUE(fails([](double&, double& m, double&) { m += 1e-9; }));
  EXPECT_TRUE(fails([](double&, double&, double& e) { e *= 1.0 + 1e-9; }));
  EXPECT_FALSE(fails([](double& rho, double&, double&) { rho *= 1.0 + 1e-15; }));
}

TEST_F(GasVerify, NaNFailsEveryAffectedCheck) {
  FinishedRun run = strict_sod();
  for (const std::int64_t cell : {0, 77, 199})
    for (int k = 0; k < 3; ++k) {
      const Verdict verdict = run.verify_with(cell, [&](double& rho, double& m, double& e) {
        (k == 0 ? rho : k == 1 ? m : e) = std::numeric_limits<double>::quiet_NaN();
      });
      EXPECT_TRUE(verdict.failed.count("conservation")) << k;
      // Density stands alone, velocity needs density and momentum, pressure all three.
      for (const std::string norm : {"l1_", "l2_", "linf_"}) {
        EXPECT_EQ(verdict.failed.count(norm + "density"), k == 0 ? 1U : 0U);
        EXPECT_EQ(verdict.failed.count(norm + "velocity"), k <= 1 ? 1U : 0U);
        EXPECT_EQ(verdict.failed.count(norm + "pressure"), 1U);
      }
    }
}

TEST_F(GasVerify, ChecksTheDensityPeak) {
  FinishedRun run("sedov",
                  {"mesh.cells=51", "output.fields=[]", "verify.max_density={value=4.22,tolerance=0.1}"});
  const Verdict honest = run.verify();
  EXPECT_EQ(honest.passed, (std::set<std::string>{"conservation", "max_density"}));
  const auto fails = [&](std::int64_t cell, double factor) {
    return run.verify_with(cell, [&](double& rho, double&, double&) { rho *= factor; })
               .failed.count("max_density") == 1;
  };
  EXPECT_TRUE(fails(2, 6.0)) << "undisturbed gas of density 1";
  EXPECT_TRUE(fails(2, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(fails(2, 1.5));
}

TEST_F(GasVerify, VerifiesAgainstAReferenceRun) {
  FinishedRun run("shu-osher", {"mesh.cells=100", "verify.reference.cells=400", "output.fields=[]",
                                "verify.l1_density=2"});
  EXPECT_EQ(run.verify().failed, std::set<std::string>());
  EXPECT_GT(run.errors.at("l1_density"), 0.1);
  EXPECT_TRUE(
      run.verify_with(40, [](double& rho, double&, double&) { rho += 30.0; }).failed.count("l1_density"));
}

}  // namespace
}  // namespace drogue::gas_app
