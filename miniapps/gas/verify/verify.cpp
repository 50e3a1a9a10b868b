#include <cmath>
#include <limits>

#include "common/run/fields/fields_writer.hpp"
#include "common/run/statistics.hpp"
#include "miniapps/gas/simulation/fields.hpp"
#include "miniapps/gas/simulation/simulation.hpp"
#include "miniapps/gas/verify/exact.hpp"

namespace drogue::gas_app {

namespace {

/// Largest relative change of mass, momentum and energy that the boundary fluxes do not explain. The scale of
/// momentum is sqrt(2 M E), which bounds it (Cauchy-Schwarz), because its total may be zero.
double conservation_error(const gas::HistoryRow& first, const gas::HistoryRow& last) {
  const double mass = last.mass - first.mass + last.boundary[0];
  const double momentum = last.momentum - first.momentum + last.boundary[1];
  const double energy = last.energy - first.energy + last.boundary[2];
  const double relative[3] = {std::abs(mass) / first.mass,
                              std::abs(momentum) / std::sqrt(2.0 * first.mass * first.energy),
                              std::abs(energy) / first.energy};
  double largest = 0.0;
  for (const double value : relative) largest = run::maximum_or_nan(largest, value);
  return largest;
}

/// Writes the finer run beside the fields of the scene, for pictures.
void write_reference(const GasScene& scene, const std::vector<run::DatasetSpec>& fields,
                     const run::RunDirectory& directory, const Reference& reference) {
  const auto cells = static_cast<std::int64_t>(reference.x.size());
  run::ReferenceSolution solution;
  solution.scheme = weno_name(scene.verify.reference->weno);
  solution.datasets = {{cell_centre_spec(cells), reference.x}};
  for (const std::string& name : scene.output.fields)
    solution.datasets.emplace_back(field_spec(name, cells), name == "rho" ? reference.rho
                                                            : name == "u" ? reference.u
                                                                          : reference.p);
  constexpr double every_step = std::numeric_limits<double>::infinity();
  run::FieldsWriter(directory.path(), scene.name, fields, every_step).add_reference(solution);
}

}  // namespace

ExitCode Simulation::verify(const run::RunDirectory* directory, run::ResultDocument& result) {
  const Verify& wanted = _scene.verify;
  if (wanted.exact) {
    std::optional<Reference> reference = Reference{};
    if (*wanted.exact == Exact::reference)
      reference = run_reference(_scene, _settings.backend, _settings.quiet);
    if (!reference) return ExitCode::interrupted;
    if (directory != nullptr && !reference->x.empty() && !_scene.output.fields.empty())
      write_reference(_scene, field_specs(), *directory, *reference);
    result.errors = error_norms(*_solver, _scene.parameters, exact_solution(_scene, result.time, *reference));
    for (const auto& [name, tolerance] : wanted.tolerances)
      result.add_check(name, result.errors.at(name), tolerance);
  }
  if (wanted.max_density) {
    double largest = 0.0;
    for_cells(*_solver, _scene.parameters,
              [&](std::int64_t, const Primitive& w) { largest = run::maximum_or_nan(largest, w.rho); });
    result.add_check("max_density", std::abs(largest / wanted.max_density->value - 1.0),
                     wanted.max_density->tolerance);
  }
  if (wanted.conservation) result.add_check("conservation", conservation(), *wanted.conservation);
  return ExitCode::ok;
}

double Simulation::conservation() { return conservation_error(_initial, _solver->totals()); }

}  // namespace drogue::gas_app
