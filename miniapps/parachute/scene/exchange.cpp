#include "miniapps/parachute/scene/exchange.hpp"

#include <algorithm>
#include <cmath>

#include "common/scene/node.hpp"
#include "kernels/coupling/sheet/corrections.hpp"

namespace drogue::parachute_app {
namespace {

/// Largest sum of the speeds along the axes beside a plate across a stream, over that of the stream.
constexpr double faster_beside_edges = 1.8;

/// Canopies take the filter of their law. Modes of bodies, flags and drums, whose periods are longer than a
/// step, decay with any filter.
bool takes_filter_of_law(const Canopy& canopy) { return canopy.kind != CanopyKind::drum; }

std::vector<coupling::AirFilter> filters_by_law(const FlowScene& scene, const Sheets& sheets) {
  std::vector<coupling::AirFilter> filters(sheets.positions.size());
  for (std::size_t i = 0; i < scene.canopies.size(); ++i)
    for (std::size_t k = sheets.canopies[i].begin; k < sheets.canopies[i].end; ++k)
      filters[k].by_law = takes_filter_of_law(scene.canopies[i]);
  return filters;
}

bool is_corrected(const Exchange& exchange) {
  return exchange.corrections == Corrections::all && exchange.method == coupling::CouplingMethod::spread;
}

bool has_retraction(const FlowScene& scene) {
  return std::ranges::any_of(scene.bodies, [](const Body& body) { return body.retraction > 0.0; });
}

}  // namespace

double courant_number(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const double dt = p.fixed_dt > 0.0 ? p.fixed_dt : p.max_dt, given = p.fixed_dt > 0.0 ? 1.0 : scene.cfl();
  double passed = 0.0;  // cells of the stream in a step
  const std::array<double, 3> stream = scene.stream().value_or(std::array<double, 3>{});
  for (std::size_t axis = 0; axis < 3; ++axis) passed += std::abs(stream[axis]) * dt / core_width(p, axis);
  return passed > 0.0 ? std::min(given, faster_beside_edges * passed) : given;
}

double standard_edge_inset(const FlowScene& scene) {
  return coupling::standard_edge_inset(coupling::SheetParameters().delta, courant_number(scene));
}

double edge_inset(const FlowScene& scene) {
  // A retraction moves the edges of a cup inwards, too.
  const bool is_wide = is_corrected(scene.coupling) && !has_retraction(scene);
  return scene.coupling.edge_inset.value_or(is_wide ? standard_edge_inset(scene) : 0.0);
}

double leak_filter(const FlowScene& scene) {
  // Flags enclose no air, and their amplitude is nearer to its limit with the leak.
  const bool can_leak = is_corrected(scene.coupling) && scene.flags.empty();
  return scene.coupling.leak_filter.value_or(can_leak ? coupling::standard_leak_filter : 0.0);
}

std::string filter_text(const FlowScene& scene) {
  const Exchange& exchange = scene.coupling;
  const bool is_by_law =
      is_corrected(exchange) && !exchange.filter && std::ranges::any_of(scene.canopies, takes_filter_of_law);
  return is_by_law ? "by the law of the cloth" : scene::rough_text(exchange.filter.value_or(standard_filter));
}

coupling::SheetParameters exchange_parameters(const FlowScene& scene, const Sheets& sheets) {
  const Exchange& exchange = scene.coupling;
  coupling::SheetParameters p;
  p.method = exchange.method;
  p.law_of_vertex = sheets.laws;
  p.filter = exchange.filter.value_or(standard_filter);
  if (is_corrected(exchange) && !exchange.filter) p.filter_of_vertex = filters_by_law(scene, sheets);
  p.leak_filter = leak_filter(scene);
  p.edge_inset = edge_inset(scene);
  return p;
}

}  // namespace drogue::parachute_app
