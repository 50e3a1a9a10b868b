#include "miniapps/parachute/scene/scene_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "common/program/mpi_guard.hpp"
#include "kernels/flow/diffusive_step.hpp"
#include "miniapps/parachute/scene/exchange.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/sound.hpp"

namespace drogue::parachute_app {
namespace {

using flow::BoundaryKind;
using scene::Place, scene::rough_text, scene::rounded_text, scene::sentence;

/// Largest relative difference of inflow and outflow that rounded expressions explain.
constexpr double flux_tolerance = 1e-10;

std::string key_of_wall(std::size_t side) { return std::string("grid.wall_velocity.") + side_names[side]; }

void complete_sides(const Place& root, FlowScene& scene) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::optional<SidePair>& sides = scene.sides[axis];
    const std::string key = std::string("grid.boundary.") + axis_names[axis];
    const bool single = scene.parameters.cells[axis] == 1;
    if (!sides && !single)
      root.contradict("grid.boundary", "missing key \"", key, "\" (needed with more than one cell along ",
                      axis_names[axis], "): the sides normal to this axis");
    if (!sides) sides = SidePair{BoundaryKind::periodic, BoundaryKind::periodic};
    const auto is_refused = [](BoundaryKind kind) {
      return kind != BoundaryKind::periodic && kind != BoundaryKind::slip;
    };
    root.refuse_if(single && std::ranges::any_of(*sides, is_refused), key, ": with one cell along ",
                   axis_names[axis], ", its sides are periodic or slip");
    for (std::size_t end = 0; end < 2; ++end) scene.parameters.boundary[2 * axis + end].kind = (*sides)[end];
  }
}

void complete_scheme(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  switch (scene.advection) {
    case AdvectionScheme::central:
      p.advection = flow::Advection::central;
      break;
    case AdvectionScheme::weno5:
      p.advection = scene.weights == Weights::js ? flow::Advection::weno_js : flow::Advection::weno_z;
      break;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    root.refuse_if(p.pressure_drop[axis] != 0.0 && p.boundary[2 * axis].kind != BoundaryKind::periodic,
                   "flow.pressure_drop", ": the axis ", axis_names[axis], " has no periodic sides");
  const bool is_implicit = p.diffusion == flow::Diffusion::crank_nicolson;
  if (is_implicit && !root.given("flow.time")) p.time_scheme = flow::TimeScheme::ab2;
  root.refuse_if(is_implicit && p.time_scheme != flow::TimeScheme::ab2, "flow.diffusion",
                 " = \"crank-nicolson\" needs flow.time = \"ab2\"");
  const double most = flow::stable_cfl(p.time_scheme);
  root.refuse_if(p.cfl > most, "run.cfl", " = ", p.cfl, " is unstable: at most ", most,
                 " with flow.time = \"", name_of(p.time_scheme), "\"");
}

/// Points on a side: the centres of the cell faces, or of the faces normal to an axis.
Lattice side_lattice(const flow::Parameters& p, std::size_t side, std::size_t normal = flow::at_cells) {
  const std::size_t axis = side / 2;
  Lattice lattice = lattice_of(p, normal);
  lattice.n[axis] = 1;
  lattice.coordinates[axis] = {side % 2 == 0 ? p.low[axis] : p.high[axis]};
  lattice.widths[axis] = {1.0};
  return lattice;
}

/// True if the slip sides of an axis with one cell leave no velocity along it.
bool is_closed(const flow::Parameters& p, std::size_t axis) {
  return p.cells[axis] == 1 && p.boundary[2 * axis].kind == BoundaryKind::slip;
}

/// Checks a prescribed velocity at time 0, and at some of its points during the run, and that walls move
/// along themselves.
void check_velocity(const Place& root, const FlowScene& scene, const std::string& key,
                    const VectorExpression& text, std::size_t side) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const SpaceTimeFunction velocity(text[axis]);
    const std::string component = sentence("[", axis, "] = ", scene::shortened(text[axis]));
    const bool is_wall = scene.parameters.boundary[side].kind == BoundaryKind::wall;
    root.refuse_if(is_wall && axis == side / 2 && velocity.constant() != 0.0, key, component,
                   " is normal to the wall: it must be 0");
    root.refuse_if(is_closed(scene.parameters, axis) && velocity.constant() != 0.0, key, component,
                   " is normal to the slip sides of an axis with one cell: it must be 0");
    // Tangential components belong to faces that begin at the edges of the side.
    const Lattice lattice = side_lattice(scene.parameters, side, axis);
    const auto require_finite = [&](double value, std::size_t entry, double time) {
      if (!std::isfinite(value))
        root.refuse(key, component, " is not finite at ", place_text(lattice.place(entry)), " on the side ",
                    side_names[side], " at t = ", time, time > 0.0 ? " s" : "");
    };
    const std::vector<double> values = evaluate(velocity, lattice, 0.0);
    for (std::size_t entry = 0; entry < values.size(); ++entry) require_finite(values[entry], entry, 0.0);
    constexpr std::size_t points = 64;
    for (const double time : velocity.sample_times(scene.end_time))
      for (std::size_t entry = 0; entry < values.size(); entry += 1 + values.size() / points)
        require_finite(velocity(lattice.place(entry), time), entry, time);
  }
}

void complete_velocities(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  for (std::size_t side = 0; side < 6; ++side) {
    flow::Boundary& boundary = p.boundary[side];
    const BoundaryKind kind = boundary.kind;
    const VectorExpression& wall = scene.wall_velocity[side];
    root.refuse_if(!wall[0].empty() && kind != BoundaryKind::wall, key_of_wall(side),
                   ": this side is no wall");
    if (kind == BoundaryKind::outflow)  // outside of it: the stream, at rest where that is not uniform
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!is_closed(p, axis)) boundary.velocity[axis] = constant_value(scene.velocity[axis]).value_or(0.0);
    const bool is_inflow = kind == BoundaryKind::inflow;
    if (!is_inflow && wall[0].empty()) continue;
    const std::string key = is_inflow ? "fluid.velocity" : key_of_wall(side);
    const VectorExpression& text = is_inflow ? scene.velocity : wall;
    check_velocity(root, scene, key, text, side);
    if (const auto constant = constant_value(text))
      boundary.velocity = *constant;
    else
      for (std::size_t axis = 0; axis < 3; ++axis)
        boundary.velocity_expressions.push_back(
            checked_program(root, sentence(key, "[", axis, "]"), text[axis]));
  }
}

/// Net flow rate through all inflow sides into the domain, m^3/s, and the sum of its parts' magnitudes.
std::array<double, 2> inflow_at(const FlowScene& scene, double time) {
  std::array<double, 2> rates{};
  const flow::Parameters& p = scene.parameters;
  for (std::size_t side = 0; side < 6; ++side) {
    if (p.boundary[side].kind != BoundaryKind::inflow) continue;
    const Lattice lattice = side_lattice(p, side);
    const std::size_t axis = side / 2;
    double mean_area = side % 2 == 0 ? 1.0 : -1.0;  // of a face, positive where inwards is along the axis
    for (const std::size_t across : {(axis + 1) % 3, (axis + 2) % 3})
      mean_area *= length_of(p, across) / p.cells[across];
    const std::vector<double> values = evaluate(SpaceTimeFunction(scene.velocity[axis]), lattice, time);
    for (std::size_t entry = 0; entry < values.size(); ++entry) {
      const double rate = values[entry] * (mean_area * lattice.volume(entry));
      rates[0] += rate;
      rates[1] += std::abs(rate);
    }
  }
  return rates;
}

/// Without an outflow, what flows in must flow out through other inflow sides: checked at several times of
/// the run.
void check_net_inflow(const Place& root, const FlowScene& scene) {
  for (const flow::Boundary& side : scene.parameters.boundary)
    if (side.kind == BoundaryKind::outflow) return;
  constexpr int intervals = 17;
  for (int i = 0; i <= intervals; ++i) {
    const double time = scene.end_time * i / intervals;
    const auto [net, magnitude] = inflow_at(scene, time);
    root.refuse_if(std::abs(net) > flux_tolerance * magnitude, "fluid.velocity", ": at t = ", time, " s, ",
                   net,
                   " m^3/s flow into a domain without an outflow; grid.boundary needs an \"outflow\" side");
  }
}

/// Lets the solver check what remains; its sentence becomes that of the scene.
void check_solver(const Place& root, const flow::Parameters& p) {
  try {
    flow::check_parameters(p);
  } catch (const std::invalid_argument& refused) {
    root.contradict(root.given("flow") ? "flow" : "grid", refused.what());
  }
}

void check_initial(const Place& root, const FlowScene& scene, framework::InitialCheck check) {
  const std::string key = scene.initial[0].empty() ? "fluid.velocity" : "initial.velocity";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& text = scene.initial_velocity()[axis];
    const Lattice lattice = lattice_of(scene.parameters, axis);
    const SpaceTimeFunction function(text);
    // No other check finds a velocity along a closed axis.
    std::size_t stride = is_closed(scene.parameters, axis) ? 1 : stride_of_check(check, lattice);
    if (function.constant()) stride = lattice.size();
    const std::vector<double> values = evaluate(function, lattice, 0.0, stride);
    const auto refuse = [&](const auto& is_bad, const char* reason) {
      const auto bad = std::ranges::find_if(values, is_bad);
      if (bad == values.end()) return;
      root.refuse(key, "[", axis, "] = ", scene::shortened(text), " is ", reason, " at ",
                  place_text(lattice.place(stride * static_cast<std::size_t>(bad - values.begin()))),
                  " at t = 0");
    };
    refuse([](double value) { return !std::isfinite(value); }, "not finite");
    if (is_closed(scene.parameters, axis))
      refuse([](double value) { return value != 0.0; }, "normal to the slip sides of an axis with one cell");
  }
}

/// Notes the one scheme without any dissipation whose steps amplify waves.
void note_growing_energy(FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  if (p.time_scheme == flow::TimeScheme::ab2 && p.advection == flow::Advection::central &&
      p.viscosity == 0.0 && p.turbulence == flow::Turbulence::none)
    scene.note(
        "fluid.viscosity = 0.0: with flow.advection = \"central\" the kinetic energy grows by about a "
        "percent in steps of \"ab2\", which \"crank-nicolson\" takes too; flow.time = \"rk3\" keeps it from "
        "growing");
}

/// Speed with which sheets and fluid will meet, as far as it is known, m/s: that of the stream and the walls,
/// that of canopies at the start, that of free fall along a cell, and that of plates on springs.
double known_speed(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  double speed = 0.0, gravity = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double stream = constant_value(scene.velocity[axis]).value_or(0.0);
    speed = std::max(speed, std::abs(stream));
    for (const Canopy& canopy : scene.canopies)
      speed = std::max(speed, std::abs(canopy.start_velocity[axis] - stream));
    for (const flow::Boundary& side : p.boundary) speed = std::max(speed, std::abs(side.velocity[axis]));
    if (!scene.canopies.empty() || !scene.flags.empty()) gravity = std::hypot(gravity, scene.gravity[axis]);
  }
  for (const Body& body : scene.bodies)
    if (body.mount)
      speed =
          std::max(speed, std::abs(body.mount->offset) * std::sqrt(body.mount->stiffness / body.mount->mass));
  return std::max(speed, std::sqrt(gravity * least_width(p)));
}

/// True if the velocity of the fluid bounds dt by itself: that of the start, and sides that change in time.
bool fluid_moves(const FlowScene& scene) {
  const auto is_zero = [](const std::string& text) { return constant_value(text) == 0.0; };
  return !std::ranges::all_of(scene.initial_velocity(), is_zero) ||
         std::ranges::any_of(scene.parameters.boundary,
                             [](const flow::Boundary& side) { return !side.velocity_expressions.empty(); });
}

/// Angular frequency, 1/s, with which a plate on a spring and all of the fluid oscillate.
double mount_frequency(const flow::Parameters& p, const Mount& mount) {
  return std::sqrt(mount.stiffness / (mount.mass + fluid_mass(p)));
}

/// Step, s, with which the fluid that a plate on a spring moves beyond its own 2.1 cells lags by a part
/// `error` of its mass: (L / (2.1 h) - 1) (omega dt)^2 / filter.
double mount_step(const FlowScene& scene, const Body& body, double error) {
  const double others =
      std::max(1.0, scene.parameters.cells[static_cast<std::size_t>(body.axis)] / 2.1 - 1.0);
  return std::sqrt(error * scene.coupling.filter.value_or(standard_filter) / others) /
         mount_frequency(scene.parameters, *body.mount);
}

/// Bounds dt by the oscillations of plates on springs, unless it is given: a frequency then has an error of
/// some half a percent. Notes a given one that does not resolve them.
void bound_step_by_mounts(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  const double given = p.fixed_dt > 0.0 ? p.fixed_dt : p.max_dt;
  for (const auto& [at, body] : root.each("body", scene.bodies)) {
    if (!body.mount) continue;
    constexpr double error = 0.01, most = 0.1;
    const double enough = mount_step(scene, body, error);
    if (given == 0.0) {
      p.max_dt = p.max_dt > 0.0 ? std::min(p.max_dt, enough) : enough;
    } else if (given > mount_step(scene, body, most)) {
      scene.note(p.fixed_dt > 0.0 ? "run.dt = " : "run.max_dt = ", rough_text(given), " s does not resolve ",
                 at.path("mount"), ", which oscillates with ",
                 rough_text(mount_frequency(p, *body.mount) / (2.0 * std::numbers::pi)),
                 " Hz: its frequency will be wrong by more than 5 %; ", rough_text(enough),
                 " s give it to 0.5 %");
    }
  }
}

/// Gives run.max_dt its default. Fluid at rest would leave dt without a bound, while sheets that it moves
/// need one; steps resolve prescribed motion by themselves.
void complete_time_step(const Place& root, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  const double given = p.fixed_dt > 0.0 ? p.fixed_dt : p.max_dt;
  bound_step_by_mounts(root, scene);
  if (!scene.has_sheets()) return;
  // In h^2 / nu, implicit diffusion spreads the force of a sheet over a cell. The coupling takes the response
  // of the fluid for that without diffusion, and corrects this within some nu dt / h^2 steps. Explicit steps
  // are shorter.
  const double h = least_width(p), resolved = p.diffusion == flow::Diffusion::crank_nicolson
                                                  ? h * h * p.density / p.viscosity
                                                  : std::numeric_limits<double>::infinity();
  if (given > 2.0 * resolved)
    scene.note(
        p.fixed_dt > 0.0 ? "run.dt = " : "run.max_dt = ", rough_text(given),
        " s: viscosity spreads the force of a sheet over several cells in a step, so that forces follow "
        "changes of the flow late; ",
        rough_text(resolved), " s do not");
  if (given > 0.0) return;
  p.max_dt = std::min({p.max_dt > 0.0 ? p.max_dt : scene.end_time, scene.end_time, resolved});
  const double speed = known_speed(scene);
  if (speed > 0.0)
    p.max_dt = std::min(p.max_dt, scene.cfl() * h / speed);
  else if (!(scene.canopies.empty() && scene.flags.empty()) && !fluid_moves(scene))
    root.contradict("run",
                    "missing key \"run.max_dt\" (needed where neither stream nor gravity moves a sheet): the "
                    "largest dt");
}

/// Refuses a dt, a largest one, or a viscosity that limits it, with which the run would need more steps than
/// it may take.
void check_steps(const Place& root, const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const auto refuse = [&](const std::string& key, const char* sets, double dt, const char* remedy) {
    const std::string text = framework::too_many_steps(root, key + sets, dt, scene.end_time, p.max_steps);
    if (!text.empty()) root.contradict(key, text, remedy);
  };
  if (p.fixed_dt > 0.0) return refuse("run.dt", " = ", p.fixed_dt, "");
  if (!scene.has_fluid()) return;
  if (p.max_dt > 0.0) refuse("run.max_dt", " = ", p.max_dt, "");
  refuse("fluid.viscosity", " limits a step to ", flow::largest_diffusive_dt(p),
         "; flow.diffusion = \"crank-nicolson\" has no such limit");
}

/// Refuses gravity under which an edge of cloth would double its length by its own weight: neither the cloth
/// nor its mesh are meant for it.
void check_gravity(const Place& root, const FlowScene& scene) {
  const auto [x, y, z] = scene.gravity;
  const double gravity = std::hypot(x, y, z);
  const auto check_all = [&](const char* array, const auto& cloths) {
    for (const auto& [at, cloth] : root.each(array, cloths)) {
      const double most = cloth.membrane_modulus / (cloth.area_density * cloth.edge_length);
      root.refuse_if(!(gravity <= most), "coupling.gravity", ": ", rough_text(gravity),
                     " m/s^2 would stretch an edge of ", at.path(), " of ", rough_text(cloth.edge_length),
                     " m to twice its length by the weight of its own cloth; at most ", rough_text(most),
                     " m/s^2");
    }
  };
  check_all("canopy", scene.canopies);
  check_all("flag", scene.flags);
}

void complete_fields(const Place& root, FlowScene& scene) {
  std::vector<std::string> by_default;
  if (scene.has_fluid()) by_default = {"velocity", "pressure", "vorticity"};
  if (!scene.canopies.empty()) by_default.insert(by_default.end(), {"position", "von_mises"});
  framework::complete_output(root, scene.output, by_default, {scene.end_time, "run.end_time"});
  for (const std::string& field : scene.output.fields)
    if (is_canopy_field(field) ? scene.canopies.empty() : !scene.has_fluid())
      root.refuse("output.fields", ": \"", field, "\" needs ",
                  is_canopy_field(field) ? "a [[canopy]]" : "[fluid]");
}

}  // namespace

device::ExpressionProgram checked_program(const Place& at, const std::string& key, const std::string& text) {
  try {
    return device_program(text);
  } catch (const std::invalid_argument& refused) {
    at.refuse(key, ": ", refused.what());
  }
}

bool is_bounded(const flow::Parameters& p, std::size_t axis) {
  return p.cells[axis] > 1 &&
         (flow::is_stretched(p, axis) || p.boundary[2 * axis].kind != BoundaryKind::periodic);
}

std::string reach_text(const SheetReach& sheet) {
  return sentence(sheet.name, " reaches from ", rounded_text(sheet.low), " to ", rounded_text(sheet.high),
                  " m along ", axis_names[sheet.axis], sheet.when);
}

void check_margin(const Place& at, const flow::Parameters& p, const std::string& key, const SheetReach& sheet,
                  double margin, const std::string& remedy) {
  const std::size_t axis = sheet.axis;
  const auto [begin, end] = sheet_extent(p, axis);
  const double width = core_width(p, axis), rounding = 1e-9 * length_of(p, axis),
               least = margin > 0.0 ? margin + rounding : -rounding;
  if (sheet.low >= begin + least && sheet.high <= end - least) return;
  const bool has_core = flow::is_stretched(p, axis);
  if (has_core && begin + width >= end - width)
    at.contradict(key, sheet.name, " has no room in the core of the grid, which has ",
                  flow::core_of(p).cells[axis], " cells along ", axis_names[axis],
                  ": cells of the core have widths that agree to 1e-9 of them");
  at.contradict(key, reach_text(sheet), ", beyond ",
                has_core       ? "the core of the grid less two cells at each end"
                : margin > 0.0 ? "the cells beside the sides of the domain"
                               : "the domain",
                margin > 0.0 ? ": it must lie strictly between " : ": it must lie between ",
                rounded_text(begin + margin), " and ", rounded_text(end - margin), " m", remedy);
}

void check_margin(const Place& at, const flow::Parameters& p, const std::string& key, const std::string& name,
                  std::size_t axis, const std::vector<fabric::Vector>& positions, const std::string& remedy) {
  const auto [low, high] =
      std::ranges::minmax(positions, {}, [axis](const fabric::Vector& x) { return x[axis]; });
  check_margin(at, p, key, {name, axis, low[axis], high[axis]}, core_width(p, axis), remedy);
}

void complete_and_check(const Place& root, FlowScene& scene, framework::InitialCheck check) {
  flow::Parameters& p = scene.parameters;
  complete_drop(root, scene);
  if (scene.has_fluid()) {
    complete_and_check_grid(root, scene);
    complete_sides(root, scene);
    complete_scheme(root, scene);
    note_growing_energy(scene);
    complete_velocities(root, scene);
    complete_time_step(root, scene);
    p.horizon = scene.end_time;
    check_net_inflow(root, scene);
    check_solver(root, p);
    check_steps(root, scene);
    complete_and_check_bodies(root, scene);
  } else if (scene.canopies.empty()) {
    root.contradict("", "missing table \"fluid\": the fluid, without which a scene needs a [[canopy]]");
  }
  complete_and_check_canopies(root, scene);
  Sheets sheets = make_all_sheets(scene.bodies, scene.canopies, p.density, p.viscosity);
  check_contact(root, scene, sheets.fabric.mesh);
  if (scene.has_fluid()) {
    check_frame(root, scene);
    check_method(root, scene);
    check_canopies_beside_bodies(root, scene, sheets);
    complete_and_check_flags(root, scene);
    if (!scene.flags.empty()) sheets = make_all_sheets({}, {}, p.density, p.viscosity, scene.flags);
    check_images(root, scene, sheets);
    note_narrow_channels(root, scene, sheets);
    note_unfit_canopies(root, scene);
    note_unfit_bodies(scene);
    note_compressibility(scene);
  } else {
    check_steps(root, scene);
  }
  check_gravity(root, scene);
  complete_fields(root, scene);
  check_verify(root, scene, check);
  if (!scene.has_fluid()) return;
  p.watches_extremes = scene.verify.needs_extremes();
  // The other ranks leave a check at all points of the grid to rank 0, with which they fail.
  if (launched_rank().rank == 0) check_initial(root, scene, check);
}

}  // namespace drogue::parachute_app
