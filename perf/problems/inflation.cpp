#include "perf/problems/inflation.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "common/program/failure.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"
#include "miniapps/parachute/canopy/canopy_state.hpp"

namespace drogue::perf::inflation {

namespace {

constexpr double speed = 10.0;  // m/s
constexpr std::array<flow::StateField, 7> saved_fields = {
    flow::StateField::velocity_x, flow::StateField::velocity_y, flow::StateField::velocity_z,
    flow::StateField::rate_x,     flow::StateField::rate_y,     flow::StateField::rate_z,
    flow::StateField::pressure};

parachute_app::Sheets sheets(const flow::Parameters& p) {
  parachute_app::Canopy c9;
  c9.edge_length = 0.7 * (p.high[0] - p.low[0]) / p.cells[0];
  c9.payload.fixed = true;
  return parachute_app::make_all_sheets({}, {c9}, p.density, p.viscosity);
}

/// State that a sample begins from.
struct State {
  std::array<std::vector<double>, saved_fields.size()> fields;
  std::vector<fabric::Vector> x, v, acceleration;
  flow::Progress progress;
  coupling::BlockProgress block;
};

std::size_t values_of(const flow::Parameters& p, flow::StateField field) {
  std::size_t count = 1;
  for (const int n : flow::extents(p, field)) count *= static_cast<std::size_t>(n);
  return count;
}

void save(coupling::Solver& solver, const coupling::Parameters& p, State& state) {
  for (std::size_t k = 0; k < saved_fields.size(); ++k) {
    state.fields[k].resize(values_of(p.flow, saved_fields[k]));
    solver.download(saved_fields[k], state.fields[k]);
  }
  for (auto* values : {&state.x, &state.v, &state.acceleration}) values->resize(p.fabric.mass.size());
  solver.download_cloth(state.x, state.v);
  solver.download_air_acceleration(state.acceleration);
  state.progress = solver.progress();
  state.block = solver.block();
}

void restore(coupling::Solver& solver, const State& state) {
  for (std::size_t k = 0; k < saved_fields.size(); ++k) solver.upload(saved_fields[k], state.fields[k]);
  solver.upload_cloth(state.x, state.v);
  solver.restore(state.progress);
  solver.upload_air_acceleration(state.acceleration);
  solver.set_block(state.block);
}

void fly_to(coupling::Solver& solver, double time) {
  if (solver.advance(time, -1, {}) != flow::Stop::target)
    throw Failure(ExitCode::numerical_failure, "a step of the parachute benchmark failed");
}

}  // namespace

coupling::Parameters parameters(const std::array<int, 3>& cells, bool with_contact) {
  coupling::Parameters p;
  p.flow.cells = cells;
  p.flow.low = {-6.0, -6.0, -9.0};
  p.flow.high = {6.0, 6.0, 15.0};
  p.flow.density = 1.225;
  p.flow.viscosity = 1.8e-5;
  for (std::size_t side = 0; side < 4; ++side) p.flow.boundary[side].kind = flow::BoundaryKind::slip;
  p.flow.boundary[4].kind = flow::BoundaryKind::inflow;
  p.flow.boundary[4].velocity = {0.0, 0.0, speed};
  p.flow.boundary[5].kind = flow::BoundaryKind::outflow;
  p.flow.time_scheme = flow::TimeScheme::ab2;
  p.flow.cfl = 0.25;
  p.flow.max_dt = 0.01;
  const parachute_app::Sheets canopy = sheets(p.flow);
  p.fabric = canopy.fabric;
  p.sheet.law_of_vertex = canopy.laws;
  p.fabric.contact.self = with_contact;
  return p;
}

Sample flight(const coupling::Parameters& p, coupling::Solver& solver, double lead, long milliseconds) {
  const auto state = std::make_shared<State>();
  return {[=, &solver] {
            if (!state->x.empty()) return restore(solver, *state);
            const std::vector<double> stream(values_of(p.flow, flow::StateField::velocity_z), speed);
            solver.upload(flow::StateField::velocity_z, stream);
            const auto x = sheets(p.flow).positions;
            solver.upload_cloth(x, std::vector<fabric::Vector>(x.size()));
            solver.start();
            fly_to(solver, lead);
            save(solver, p, *state);
          },
          [=, &solver] {
            fly_to(solver, state->progress.time + 1e-3 * static_cast<double>(milliseconds));
            return milliseconds;
          }};
}

double imbalance(const coupling::Parameters& p, coupling::Solver& solver) {
  const flow::Totals totals = solver.totals();
  const double spacing = (p.flow.high[0] - p.flow.low[0]) / p.flow.cells[0];
  std::vector<fabric::Vector> on_air(p.fabric.mass.size());
  solver.forces(on_air);
  return std::max(totals.divergence_rms * spacing / totals.max_speed,
                  parachute_app::force_balance(solver.total_force_on_air(), on_air));
}

}  // namespace drogue::perf::inflation
