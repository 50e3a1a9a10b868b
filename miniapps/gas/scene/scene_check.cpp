#include "miniapps/gas/scene/scene_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/scene/read.hpp"
#include "kernels/reference/gas/exact_riemann.hpp"
#include "miniapps/framework/scene_keys.hpp"
#include "miniapps/gas/scene/scene_survey.hpp"
#include "miniapps/gas/simulation/simulation.hpp"

namespace drogue::gas_app {
namespace {

using framework::InitialCheck, scene::Place, scene::sentence;

/// Largest ratio of initial pressures that the FP32 part of the split precision resolves.
constexpr double split_pressure_ratio = 1e11;

/// Least quotient of the cells of a reference run and of the run. Errors of first order then appear as three
/// quarters of their size at least; a mesh that is hardly finer has the same error.
constexpr std::int64_t least_refinement = 4;

std::string domain_text(const gas::Parameters& p) {
  return sentence("the domain [", p.x_min, ", ", p.x_max, "]");
}

bool inside(const gas::Parameters& parameters, double x) {
  return x > parameters.x_min && x < parameters.x_max;
}

void check_mesh(const Place& root, const GasScene& scene) {
  const gas::Parameters& parameters = scene.parameters;
  const double length = parameters.x_max - parameters.x_min;
  const double largest = std::max(std::abs(parameters.x_min), std::abs(parameters.x_max));
  const double spacing = std::numeric_limits<double>::epsilon() * largest;
  root.refuse_if(!std::isfinite(length) || length / static_cast<double>(parameters.cells) < 16.0 * spacing,
                 "mesh.domain", ": ", domain_text(parameters), " cannot be divided into ", parameters.cells,
                 " cells whose centres differ in FP64");
}

void check_boundary(const Place& root, const gas::Parameters& parameters) {
  const bool left = parameters.left == gas::Boundary::periodic;
  const bool right = parameters.right == gas::Boundary::periodic;
  if (left == right) return;
  const std::string here = left ? "boundary.left" : "boundary.right";
  const std::string other = left ? "boundary.right" : "boundary.left";
  root.refuse(here, " = \"periodic\" needs ", other, " = \"periodic\" too");
}

void check_riemann(const Place& root, const GasScene& scene) {
  const double x0 = scene.initial.riemann->x0;
  root.refuse_if(!inside(scene.parameters, x0), "initial.riemann.x0", " = ", x0, " is not inside ",
                 domain_text(scene.parameters));
}

void check_regions(const Place& root, const GasScene& scene) {
  const std::vector<Region>& regions = scene.initial.regions;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Place at = root.at("initial.regions", i);
    const bool last = i + 1 == regions.size();
    if (!regions[i].until && !last)
      at.contradict("rho", at.path(), " needs \"until\": only the last region has none");
    if (!regions[i].until) continue;
    const double until = *regions[i].until;
    at.refuse_if(last, "until", " = ", until, ": the last region reaches the end of the domain and has none");
    at.refuse_if(!inside(scene.parameters, until), "until", " = ", until, " is not inside ",
                 domain_text(scene.parameters));
    if (i > 0 && until <= *regions[i - 1].until)
      at.refuse("until", " = ", until, " is not greater than the one before it, ", *regions[i - 1].until);
  }
}

/// Refuses an exact solution of two half spaces that the ends of the domain have disturbed by the end of the
/// run. Waves leave through an outflow.
void check_exact_riemann(const Place& root, const GasScene& scene) {
  const gas::Parameters& p = scene.parameters;
  const std::string without_ends = " = \"riemann\" is the solution without ends: ";
  root.refuse_if(p.left == gas::Boundary::periodic, "verify.exact", without_ends,
                 "periodic boundaries add a second jump; take \"outflow\"");
  if (p.left != gas::Boundary::reflecting && p.right != gas::Boundary::reflecting) return;
  const Riemann& r = *scene.initial.riemann;
  const auto state = [](const Primitive& w) { return reference::Primitive{w.rho, w.u, w.p}; };
  const auto is_gas = [](const Primitive& w) { return w.rho > 0.0 && w.p > 0.0; };
  if (!is_gas(r.left) || !is_gas(r.right)) return;  // refused with its cell
  const reference::ExactRiemann exact(state(r.left), state(r.right), p.gamma);
  const auto check_wall = [&](const char* side, const Primitive& gas, std::optional<double> speed,
                              double distance) {
    const std::string wall = sentence(without_ends, "the reflecting ", side, " end ");
    root.refuse_if(gas.u != 0.0, "verify.exact", wall,
                   "sends a wave from the start, since the gas beside it moves at ", gas.u, " m/s");
    if (speed && !(distance / *speed < 0.0) && !(scene.end_time <= distance / *speed))
      root.refuse("verify.exact", wall, "reflects a wave from t = ", distance / *speed,
                  " s on, before run.end_time = ", scene.end_time, " s");
  };
  if (p.left == gas::Boundary::reflecting) check_wall("left", r.left, exact.left_wave(), p.x_min - r.x0);
  if (p.right == gas::Boundary::reflecting) check_wall("right", r.right, exact.right_wave(), p.x_max - r.x0);
}

void complete_verify(const Place& root, GasScene& scene) {
  Verify& verify = scene.verify;
  root.refuse_if(verify.exact == Exact::riemann && !scene.initial.riemann, "verify.exact",
                 " = \"riemann\" needs initial.riemann");
  if (verify.exact == Exact::riemann) check_exact_riemann(root, scene);
  root.refuse_if(verify.exact == Exact::advection &&
                     (!scene.initial.expression || scene.parameters.left != gas::Boundary::periodic),
                 "verify.exact", " = \"advection\" needs initial.expression and periodic boundaries");
  if (!verify.reference) return;
  gas::Parameters& reference = *verify.reference;
  root.refuse_if(reference.cells / least_refinement < scene.parameters.cells, "verify.reference.cells", " = ",
                 reference.cells, " is less than ", least_refinement,
                 " times mesh.cells = ", scene.parameters.cells,
                 ", so that the reference shares the error of the run");
  reference.gamma = scene.parameters.gamma;
  reference.x_min = scene.parameters.x_min;
  reference.x_max = scene.parameters.x_max;
  reference.left = scene.parameters.left;
  reference.right = scene.parameters.right;
  reference.block = scene.parameters.block;
}

/// Surveys the initial state at cell centres. Throws `Failure` for the first invalid one.
Survey require_gas(const Place& root, const GasScene& scene, InitialCheck check) {
  const Survey seen = survey_initial_state(scene, check);
  if (seen.first_bad < scene.parameters.cells) {
    const BadCell bad = describe_bad_cell(scene, seen.first_bad);
    root.contradict(bad.path, bad.sentence);
  }
  return seen;
}

/// Refuses a given dt with which the run would need more steps than it may take. Notes one that follows from
/// the CFL condition at the start, since it may grow.
void check_steps(const Place& root, GasScene& scene, double largest_speed) {
  const gas::Parameters& p = scene.parameters;
  const bool is_fixed = p.fixed_dt > 0.0;
  const double cells = static_cast<double>(p.cells), dx = (p.x_max - p.x_min) / cells;
  const std::string text = framework::too_many_steps(
      root, is_fixed ? "scheme.fixed_dt = " : "the CFL condition limits the first steps to ",
      is_fixed ? p.fixed_dt : p.cfl * dx / largest_speed, scene.end_time, p.max_steps);
  if (text.empty()) return;
  if (is_fixed) root.contradict("scheme.fixed_dt", text);
  scene.notices.push_back(text + ", at which a run fails");
}

void check_initial(const Place& root, GasScene& scene, InitialCheck check) {
  const Survey seen = require_gas(root, scene, check);
  check_steps(root, scene, seen.speed_max);
  if (scene.verify.reference) {
    GasScene finer = scene;
    finer.parameters = *scene.verify.reference;
    require_gas(root, finer, check);
  }
  const double ratio = seen.p_max / seen.p_min;
  root.refuse_if(scene.parameters.precision == gas::Precision::split && ratio > split_pressure_ratio,
                 "scheme.precision",
                 " = \"split\" does its nonlinear part in FP32, which does not carry the ratio of initial "
                 "pressures ",
                 ratio, " of this scene; at most 1e11 is allowed");
  root.refuse_if(scene.verify.exact == Exact::advection && !seen.uniform_flow(), "verify.exact",
                 " = \"advection\" needs initial u and p that do not vary");
}

}  // namespace

void complete_and_check(const Place& root, GasScene& scene, InitialCheck check) {
  check_mesh(root, scene);
  check_boundary(root, scene.parameters);
  if (scene.initial.riemann) check_riemann(root, scene);
  check_regions(root, scene);
  framework::complete_output(root, scene.output, {"rho", "u", "p"}, {scene.end_time, "run.end_time"});
  complete_verify(root, scene);
  framework::require_measurable(root, scene.verify.history, scene.output, {scene.end_time, "run.end_time"},
                                history_columns());
  check_initial(root, scene, check);
}

}  // namespace drogue::gas_app
