#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "common/scene/node.hpp"
#include "miniapps/parachute/canopy/stiffness.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/simulation/sheet_output.hpp"
#include "miniapps/parachute/simulation/simulation.hpp"

// Steps that fail, and their messages.

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Cell of an index whose x varies fastest, and its centre.
std::string cell_text(const flow::Parameters& p, std::int64_t index) {
  const Lattice cells = lattice_of(p);
  const auto centre = cells.place(static_cast<std::size_t>(index));
  std::ostringstream text;
  text << "cell (" << index % cells.n[0] << ", " << index / cells.n[0] % cells.n[1] << ", "
       << index / cells.n[0] / cells.n[1] << ") at " << place_text(centre) << " m";
  return text.str();
}

}  // namespace

std::string Simulation::flow_failure_text() {
  std::ostringstream text;
  text.precision(9);
  const flow::StepFailure failure = _solver->failure();
  const double fixed_dt = _scene.parameters.fixed_dt;
  const bool is_unstable = failure.reason == flow::FailureReason::time_step && failure.dt < fixed_dt;
  // The velocity has grown within the last step beyond what that could resolve.
  const double last_dt = _solver->progress().last_dt;
  const bool outgrows = failure.reason == flow::FailureReason::time_step && !(fixed_dt > 0.0) &&
                        failure.dt > 0.0 && failure.dt < last_dt;
  // Without a finite velocity of the start the first step has no dt, and before that step there is none.
  const bool is_initial =
      failure.step == 1 && (std::isnan(failure.dt) ||
                            (failure.reason == flow::FailureReason::pressure_solver && failure.dt == 0.0));
  if (outgrows)
    text << "in a step of " << last_dt << " s the velocity has grown so much that the largest stable one is "
         << failure.dt << " s,";
  else if (is_unstable)
    text << "run.dt = " << fixed_dt << " s exceeds the largest stable time step, " << failure.dt << " s,";
  else
    text << flow::failure_text(failure.reason);
  if (failure.reason == flow::FailureReason::side_velocity)
    text << " on the side " << side_names[static_cast<std::size_t>(failure.index)];
  else if (failure.index >= 0)
    text << " in " << cell_text(_scene.parameters, failure.index);
  text << " at " << (is_initial ? "the initial projection" : "step " + std::to_string(failure.step))
       << ", t = " << failure.time << " s";
  if (!is_initial && !is_unstable && !outgrows) text << ", dt = " << failure.dt << " s";
  if (failure.reason == flow::FailureReason::net_inflow)
    text << ": " << failure.net_inflow << " m^3/s; grid.boundary needs an \"outflow\" side";
  if (failure.reason == flow::FailureReason::pressure_solver)
    text << residual_text(failure.pressure_residual);
  if (failure.reason == flow::FailureReason::not_finite && !is_initial)
    text << "; a smaller " << step_key() << " may save the run";
  if (outgrows) text << "; a smaller run.max_dt may save the run";
  return text.str();
}

/// End of the message of a solve that did not converge, with its relative residual.
std::string Simulation::residual_text(double residual) const {
  std::ostringstream text;
  text.precision(3);
  text << "; its relative residual is " << residual << ": it may with a flow.pressure_tolerance above "
       << scene::real_text(_scene.parameters.pressure_tolerance);
  return text.str();
}

/// Throws `Failure` (numerical_failure) if `field` is the pressure, whose solve, the last one, did not
/// converge.
void Simulation::require_converged_pressure(flow::CellField field) {
  const auto solve = _solver->last_pressure_solve();
  if (field != flow::CellField::pressure || !solve || solve->residual <= _scene.parameters.pressure_tolerance)
    return;
  // An output at the start comes before the first step, which names a start that failed.
  if (_solver->failure().reason == flow::FailureReason::pressure_solver)
    throw Failure(ExitCode::numerical_failure, flow_failure_text());
  throw Failure(ExitCode::numerical_failure, flow::failure_text(flow::FailureReason::pressure_solver) +
                                                 (" for the pressure at " + now_text()) +
                                                 residual_text(solve->residual));
}

/// Last step that was taken, and its time.
std::string Simulation::now_text() {
  std::ostringstream text;
  text.precision(9);
  text << "step " << now().step << ", t = " << now().time << " s";
  return text.str();
}

/// Key that shortens the steps of the flow.
const char* Simulation::step_key() const { return _scene.parameters.fixed_dt > 0.0 ? "run.dt" : "run.cfl"; }

/// End of the message of a failure for which explicit coupling of light cloth is the likely cause.
std::string Simulation::light_cloth_text() const {
  if (!_scene.is_explicit() || _scene.largest_added_mass_ratio() <= 1.0) return "";
  std::ostringstream text;
  text.precision(3);
  text << "; coupling.method = \"explicit\" is unstable for cloth that moves "
       << _scene.largest_added_mass_ratio() << " times its own mass of fluid";
  return text.str();
}

std::string Simulation::vertex_text(std::int64_t vertex) const {
  std::ostringstream text;
  const auto row = static_cast<std::size_t>(vertex);
  if (row < vertices_of(_scene.bodies)) text << "vertex " << row << " of the bodies";
  text << canopy_vertex_text(_sheets, row);
  return text.str();
}

/// Cloth that needs too many steps within one of the flow, and the keys that may help.
std::string Simulation::stiff_cloth_text() {
  std::ostringstream text;
  text.precision(9);
  text << "the cloth needs more than " << coupling::most_substeps << " steps in the step of the flow after "
       << now_text();
  std::optional<StiffPart> stiffest;
  std::string canopy;
  for (std::size_t i = 0; i < _scene.canopies.size(); ++i) {
    const StiffPart part = stiffest_part(_scene.canopies[i], make_canopy(_scene.canopies[i]));
    if (stiffest && part.frequency <= stiffest->frequency) continue;
    stiffest = part;
    canopy = "canopy[" + std::to_string(i) + "].";
  }
  if (stiffest)
    text << "; " << stiffest->remedy << " " << canopy << stiffest->key << " or a smaller " << step_key()
         << " may save the run";
  return text.str();
}

/// Line that carries more than its strength.
std::string Simulation::broken_line_text() {
  std::ostringstream text;
  text.precision(9);
  const int line = _coupled->failure().line;
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _coupled->fabric().download(positions, velocities);
  const Vector& skirt =
      positions[static_cast<std::size_t>(_sheets.fabric.mesh.lines[static_cast<std::size_t>(line)][0])];
  for (std::size_t i = 0; i < _sheets.canopies.size(); ++i) {
    const std::vector<int>& lines = _sheets.canopies[i].suspension;
    const auto found = std::ranges::find(lines, line);
    if (found == lines.end()) continue;
    text << "line " << found - lines.begin() << " of canopy[" << i << "] breaks at " << place_text(skirt)
         << " m: it carries more than canopy[" << i
         << "].lines.strength = " << _scene.canopies[i].lines.strength.value_or(0.0)
         << " N in the step after " << now_text();
  }
  return text.str();
}

/// Body, canopy or flag that leaves the domain, or the core of its grid, with the vertex.
std::string Simulation::leaving_part_text(std::size_t vertex, bool leaves_core) const {
  const std::string leaves = leaves_core ? "] leaves the core of the grid: " : "] leaves the domain: ";
  std::size_t end = 0;
  for (std::size_t i = 0; i < _scene.bodies.size(); ++i) {
    const std::size_t begin = end;
    end += static_cast<std::size_t>(_scene.bodies[i].vertices());
    if (vertex >= begin && vertex < end) return "body[" + std::to_string(i) + leaves + "a vertex";
  }
  for (std::size_t i = 0; i < _sheets.canopies.size(); ++i) {
    const CanopyRows& rows = _sheets.canopies[i];
    if (vertex < rows.begin || vertex >= rows.end) continue;
    return "canopy[" + std::to_string(i) + leaves + "its " + rows.part_of(vertex);
  }
  for (std::size_t i = 0; i < _sheets.flags.size(); ++i)
    if (vertex >= _sheets.flags[i].begin && vertex < _sheets.flags[i].end)
      return "flag[" + std::to_string(i) + leaves + "a vertex";
  return "";
}

/// Vertex that is closest to a side of the domain, or to an end of the core, in cells.
std::string Simulation::leaving_vertex_text() {
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _coupled->fabric().download(positions, velocities);
  const flow::Parameters& p = _scene.parameters;
  const flow::Core box = flow::force_box(p);
  double least = std::numeric_limits<double>::infinity();
  std::size_t vertex = 0, closest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (std::size_t side = 0; side < 6; ++side) {
      const std::size_t axis = side / 2;
      const bool repeats =
          p.boundary[side].kind == flow::BoundaryKind::periodic && !flow::is_stretched(p, axis);
      if (p.cells[axis] == 1 || repeats) continue;
      const double distance =
          (side % 2 == 0 ? positions[i][axis] - box.low[axis] : box.high[axis] - positions[i][axis]) /
          box.spacing[axis];
      if (distance < least) least = distance, vertex = i, closest = side;
    }
  const bool is_sharp = _scene.coupling.method == coupling::CouplingMethod::sharp;
  const std::size_t axis = closest / 2;
  const bool follows = _scene.frame == Frame::follow, is_open = _scene.open_axes()[axis],
             may_open = std::ranges::none_of(_scene.canopies, [](const Canopy&canopy) {
               return canopy.payload.guided || canopy.payload.fixed;
             });
  std::string remedy;
  if (follows && is_open)
    // A grid that follows takes over the velocity of the payload at the beginning of each block of steps.
    remedy = scene::sentence("a smaller ", p.fixed_dt > 0.0 ? "run.dt" : "run.max_dt",
                             ", with which the grid follows sooner, ");
  else if (follows && may_open)
    remedy = scene::sentence("grid.boundary.", axis_names[axis],
                             " = \"outflow\", with which it follows along ", axis_names[axis], ", ");
  const bool leaves_core = closest % 2 == 0 ? box.low[axis] > p.low[axis] : box.high[axis] < p.high[axis];
  const char* const beside = leaves_core ? (is_sharp ? "lies beyond" : "comes closer than two cells to")
                                         : (is_sharp ? "lies beyond" : "comes closer than a cell to");
  return leaving_part_text(vertex, leaves_core) + " at " + place_text(positions[vertex]) + " m " + beside +
         (leaves_core ? " its end towards " : " the side ") + side_names[closest] + " after " + now_text() +
         "; " + remedy + "a larger " +
         (leaves_core ? (_scene.faces ? "grid.faces" : "grid.core") : "grid.domain") +
         " or a shorter run.end_time may save the run" + (leaves_core ? leans_text(vertex, positions) : "");
}

/// End of the message of a canopy that leaves the core: how far it leans. Its room has been checked for
/// `expected_lean`.
std::string Simulation::leans_text(std::size_t vertex, const std::vector<Vector>& positions) const {
  for (std::size_t i = 0; i < _sheets.canopies.size(); ++i) {
    const CanopyRows& rows = _sheets.canopies[i];
    if (_scene.canopies[i].has_lines() && vertex >= rows.begin && vertex < rows.end)
      return scene::sentence("; it leans by ",
                             scene::rough_text(lean_of(rows, _sheets.fabric.mesh, positions)), " degrees");
  }
  return "";
}

/// Motion of the body with the failed vertex that is not finite near the failed step; empty if there is none.
std::string Simulation::lost_motion_text(const fabric::StepFailure& failure) const {
  std::size_t end = 0;
  for (std::size_t i = 0; i < _scene.bodies.size(); ++i) {
    const Body& body = _scene.bodies[i];
    const std::size_t begin = end;
    end += static_cast<std::size_t>(body.vertices());
    const auto vertex = static_cast<std::size_t>(failure.index);
    if (vertex < begin || vertex >= end) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const SpaceTimeFunction displacement(body.motion[axis].empty() ? "0" : body.motion[axis]);
      for (const double steps : {1.0, 2.0, 0.0, 1.5, 0.5})
        if (const double time = failure.time + steps * failure.dt; !std::isfinite(displacement({}, time))) {
          std::ostringstream text;
          text.precision(9);
          text << "body[" << i << "].motion."
               << "xyz"[axis] << " = " << scene::shortened(body.motion[axis])
               << " is not finite at t = " << time << " s";
          return text.str();
        }
    }
  }
  return "";
}

std::string Simulation::sheet_failure_text(coupling::FailureReason reason) {
  std::ostringstream text;
  text.precision(9);
  switch (reason) {
    case coupling::FailureReason::not_spread:
      text << "a force on a sheet is not finite after " << now_text();
      return text.str();
    case coupling::FailureReason::cloth: {
      const auto failure = _coupled->failure().cloth.value_or(fabric::StepFailure{});
      if (const std::string motion = lost_motion_text(failure); !motion.empty()) return motion;
      text << cloth_failure_text(failure.reason) << " at " << vertex_text(failure.index) << " after "
           << now_text() << "; a smaller " << step_key() << " may save the run";
      return text.str();
    }
    case coupling::FailureReason::too_stiff:
      return stiff_cloth_text();
    case coupling::FailureReason::line:
      return broken_line_text();
    case coupling::FailureReason::left_domain:
      return leaving_vertex_text();
    case coupling::FailureReason::flow:
      break;  // `flow_failure_text` has the reason
  }
  return "";
}

bool Simulation::meets_image() {
  std::vector<Vector> positions(_sheets.positions.size()), velocities(positions.size());
  _coupled->fabric().download(positions, velocities);
  const flow::Progress now = _solver->progress();
  _met_image = _images.look({.step = now.step,
                             .time = now.time,
                             .dt = now.last_dt,
                             .positions = positions,
                             .velocities = velocities});
  return _met_image.has_value();
}

std::string Simulation::failure_cause() {
  if (_met_image)
    return *_met_image + " after " + now_text() +
           "; a larger grid.domain or a shorter run.end_time may save the run";
  if (_stop == flow::Stop::max_steps) return step_limit_text(_scene, now().time);
  const auto reason = _coupled != nullptr ? _coupled->failure().reason : coupling::FailureReason::flow;
  return reason == coupling::FailureReason::flow ? flow_failure_text() : sheet_failure_text(reason);
}

std::string Simulation::failure_text(bool) { return failure_cause() + light_cloth_text(); }

}  // namespace drogue::parachute_app
