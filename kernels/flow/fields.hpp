#pragma once

#include <array>
#include <string>
#include <vector>

#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/solver.hpp"
#include "kernels/flow/turbulence/eddy_viscosity.hpp"

namespace drogue::flow {

/// Arrays of a flow on this rank. Those on faces hold three components in the layout of `MacGrid`, with ghost
/// cells; those at cells have none, x fastest.
template <class ExecutionSpace>
struct Fields {
  using Values = List<ExecutionSpace>;

  // State, with which a run continues; listed by `make_state`.
  Values velocity;  ///< m/s, on faces
  Values rate;      ///< m/s^2, on faces: change of the velocity in the last step without pressure; AB2 only
  Values pressure;  ///< m^2/s^2, kinematic, at cells: that of the last step

  Values force;  ///< N/m^3, on faces: of other kernels; empty unless `Parameters::external_force`

  // Work arrays of a step.
  Values predicted;   ///< m/s, on faces: velocity before the projection; between steps a buffer of copies
  Values stage;       ///< m/s, on faces: velocity after a stage; RK3 only
  Values divergence;  ///< 1/s^2, at cells: right-hand side of the pressure equation
  /// m^2/s^2, at cells: solution of the pressure equation, in the memory of `divergence`. That is the
  /// pressure of a stage, which changes with the velocity, in the correction. With implicit diffusion it is
  /// an increment, in memory of its own.
  Values solution;
  Values eddy_viscosity;     ///< m^2/s, at `EddyCells`; empty without a turbulence model
  Values eddy_acceleration;  ///< m/s^2, on faces; empty without a turbulence model
};

/// Arrays that a flow with these parameters needs, all zero. Throws std::runtime_error if memory runs out.
template <class ExecutionSpace>
Fields<ExecutionSpace> make_fields(const Parameters& p, const MacGrid& grid, const EddyCells& eddy_cells) {
  using Values = List<ExecutionSpace>;
  const auto on_faces = [&](const std::string& name, bool is_needed = true) {
    // Packs may load beyond the last cell.
    return is_needed ? Values("drogue::flow::" + name, static_cast<std::size_t>(3 * grid.component + 64))
                     : Values();
  };
  const auto at_centres = [&](const std::string& name) {
    return Values("drogue::flow::" + name, static_cast<std::size_t>(grid.cells()));
  };
  const bool has_model = p.turbulence != Turbulence::none;
  const Values divergence = at_centres("divergence");
  return {.velocity = on_faces("velocity"),
          .rate = on_faces("rate", p.time_scheme == TimeScheme::ab2),
          .pressure = at_centres("pressure"),
          .force = on_faces("force", p.external_force),
          .predicted = on_faces("predicted_velocity"),
          .stage = on_faces("stage", p.time_scheme == TimeScheme::rk3),
          .divergence = divergence,
          .solution = p.diffusion == Diffusion::explicit_ ? divergence : at_centres("pressure_increment"),
          .eddy_viscosity = has_model ? Values("drogue::flow::eddy_viscosity", eddy_cells.size()) : Values(),
          .eddy_acceleration = on_faces("eddy_acceleration", has_model)};
}

/// Array of the state, and where it stands.
template <class ExecutionSpace>
struct StateEntry {
  stepping::StateArray array;
  List<ExecutionSpace> values;
  std::size_t normal;  ///< axis that its faces are normal to, or `at_cells`
};

/// The state on a rank: with these arrays and `Progress`, an equal solver continues bit for bit. A new member
/// is one line here. Throws std::bad_alloc.
template <class ExecutionSpace>
std::vector<StateEntry<ExecutionSpace>> make_state(const Fields<ExecutionSpace>& fields, const Parameters& p,
                                                   const linear::PencilRanks& ranks) {
  std::vector<StateEntry<ExecutionSpace>> state;
  const auto add = [&](const std::string& name, const char* unit, const List<ExecutionSpace>& values,
                       std::size_t normal) {
    const std::array<int, 3> whole = extents(p, normal);
    const linear::CellBox part = part_of(whole, p, ranks);
    const auto z_first = [](const std::array<int, 3>& n) {
      return std::vector<std::size_t>(n.rbegin(), n.rend());
    };
    state.push_back({{.name = name,
                      .unit = unit,
                      .extent = z_first(part.cells),
                      .whole = z_first(whole),
                      .begin = z_first(part.begin)},
                     values,
                     normal});
  };
  const auto add_on_faces = [&](const std::string& name, const char* unit,
                                const List<ExecutionSpace>& values) {
    if (values.data() == nullptr) return;
    for (std::size_t c = 0; c < 3; ++c) add(name + "_" + "xyz"[c], unit, values, c);
  };
  add_on_faces("velocity", "m/s", fields.velocity);
  add("pressure", "m^2/s^2", fields.pressure, at_cells);
  add_on_faces("rate", "m/s^2", fields.rate);
  return state;
}

}  // namespace drogue::flow
