#include "miniapps/gas/scene/scene_survey.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/program/thread_parts.hpp"
#include "common/scene/node.hpp"

namespace drogue::gas_app {
namespace {

double total_energy(const Primitive& state, double gamma) {
  return state.p / (gamma - 1.0) + 0.5 * state.rho * state.u * state.u;
}

bool is_gas(const Primitive& state, double gamma) {
  return state.rho > 0.0 && state.p > 0.0 && std::isfinite(state.rho) &&
         std::isfinite(total_energy(state, gamma)) && std::isfinite(gamma * state.p / state.rho);
}

Survey survey_cells(const InitialState& state, const gas::Parameters& parameters, std::int64_t begin,
                    std::int64_t end, std::int64_t stride) {
  Survey seen;
  for (std::int64_t i = begin; i < end; i += stride) {
    const Primitive cell = state(cell_centre(parameters, i));
    if (!is_gas(cell, parameters.gamma)) {
      seen.first_bad = i;
      return seen;
    }
    const double sound = std::sqrt(parameters.gamma * cell.p / cell.rho);
    seen.merge({cell.p, cell.p, cell.u, cell.u, std::abs(cell.u) + sound});
  }
  return seen;
}

}  // namespace

bool Survey::uniform_flow() const {
  return u_max - u_min <= 1e-12 * std::abs(u_max) && p_max - p_min <= 1e-12 * p_max;
}

void Survey::merge(const Survey& other) {
  p_min = std::min(p_min, other.p_min);
  p_max = std::max(p_max, other.p_max);
  u_min = std::min(u_min, other.u_min);
  u_max = std::max(u_max, other.u_max);
  speed_max = std::max(speed_max, other.speed_max);
  first_bad = std::min(first_bad, other.first_bad);
}

Survey survey_initial_state(const GasScene& scene, framework::InitialCheck check) {
  constexpr std::size_t cells_per_thread = 100'000;
  const auto cells = static_cast<std::size_t>(scene.parameters.cells);
  const auto stride = static_cast<std::int64_t>(framework::check_stride(check, cells));
  const InitialState state(scene);
  std::vector<Survey> seen(thread_parts(cells, cells_per_thread));
  for_thread_parts(seen.size(), cells, [&](std::size_t part, std::size_t begin, std::size_t end) {
    const InitialState own = state;  // its evaluation changes it
    seen[part] = survey_cells(own, scene.parameters, static_cast<std::int64_t>(begin),
                              static_cast<std::int64_t>(end), stride);
  });
  for (const Survey& part : seen) seen.front().merge(part);
  return seen.front();
}

BadCell describe_bad_cell(const GasScene& scene, std::int64_t cell) {
  const double x = cell_centre(scene.parameters, cell);
  const Primitive state = InitialState(scene)(x);
  const bool by_expression = scene.initial.expression.has_value();
  const std::string table = by_expression           ? "initial.expression"
                            : scene.initial.riemann ? "initial.riemann"
                                                    : "initial.regions";
  const std::string place = " at x = " + scene::real_text(x) + " (cell " + std::to_string(cell) + ")";
  const auto bad = [&](const std::string& name, double value, const std::string& must) {
    const std::string path = by_expression ? table + "." + name : table;
    return BadCell{
        path, path + " gives " + name + " = " + scene::real_text(value) + place + "; it must be " + must};
  };
  if (!(state.rho > 0.0) || !std::isfinite(state.rho)) return bad("rho", state.rho, "> 0 and finite");
  if (!std::isfinite(state.u)) return bad("u", state.u, "finite");
  if (!(state.p > 0.0) || !std::isfinite(state.p)) return bad("p", state.p, "> 0 and finite");
  return {table, table + " gives an energy or a speed of sound that FP64 does not hold" + place};
}

}  // namespace drogue::gas_app
