#include "miniapps/springs/verify/verify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/run/history_reader.hpp"
#include "common/run/statistics.hpp"
#include "miniapps/springs/scene/expressions.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"
#include "miniapps/springs/simulation/contact_state.hpp"
#include "miniapps/springs/verify/closed_forms.hpp"
#include "miniapps/springs/verify/probe.hpp"
#include "miniapps/springs/verify/samples.hpp"
#include "miniapps/springs/verify/sinusoid.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Vector;
using run::History;

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = run::maximum_or_nan(result, value);
  return result;
}

/// Largest distance of a vector in the history from its first value.
double largest_change(const History& history, const std::string& name) {
  const auto &x = history.at(name + "_x"), &y = history.at(name + "_y"), &z = history.at(name + "_z");
  double change = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    change = run::maximum_or_nan(change, std::hypot(x[k] - x[0], y[k] - y[0], z[k] - z[0]));
  return change;
}

/// Largest kinetic energy, J, that occurred or that the released elastic and potential energy would produce:
/// covers the maximum between two rows.
double energy_scale(const History& history) {
  const auto &kinetic = history.at("kinetic"), &elastic = history.at("elastic"),
             &potential = history.at("potential");
  double scale = 0.0;
  for (std::size_t k = 0; k < kinetic.size(); ++k)
    scale =
        run::maximum_or_nan(scale, run::maximum_or_nan(kinetic[k], kinetic[0] + (elastic[0] - elastic[k]) +
                                                                       potential[0] - potential[k]));
  return scale;
}

/// A change over the scale that measures it; where nothing moved, both are 0.
double share_of(double change, double scale) { return change == 0.0 ? 0.0 : change / scale; }

double energy_drift(const History& history) {
  const std::vector<double>& energy = history.at("energy");
  double change = 0.0;
  for (const double value : energy) change = run::maximum_or_nan(change, std::abs(value - energy[0]));
  return share_of(change, energy_scale(history));
}

/// Largest increase of a series above its running minimum.
double largest_rise(const std::vector<double>& values) {
  double rise = 0.0, least = values[0];
  for (const double value : values) {
    rise = run::maximum_or_nan(rise, value - least);
    least = std::min(least, value);
  }
  return rise;
}

/// Increase of the energy without the work of contact and friction, and the increase of either work above its
/// minimum: resting bodies and layers only dissipate.
double energy_imbalance(const History& history) {
  const std::vector<double>&energy = history.at("energy"), &contact = history.at("contact_work"),
        &friction = history.at("friction_work");
  double change = run::maximum_or_nan(largest_rise(contact), largest_rise(friction));
  const auto rest = [&](std::size_t k) { return energy[k] - contact[k] - friction[k]; };
  for (std::size_t k = 0; k < energy.size(); ++k)
    change = run::maximum_or_nan(change, std::abs(rest(k) - rest(0)));
  return share_of(change, energy_scale(history));
}

double extent(const fabric::Mesh& mesh) {
  double result = 0.0;
  for (const Vector& x : mesh.rest) result = std::max(result, distance(x, mesh.rest.front()));
  return result;
}

double relative_error(double value, double expected) { return std::abs(value / expected - 1.0); }

double hencky_error(const SpringsScene& scene, const FinalState& state) {
  const fabric::Material& m = scene.fabric.material;
  const double radius = scene.source.disk->radius, pressure = *constant_value(scene.loads[0].pressure);
  const double expected =
      hencky(m.poisson).deflection * radius * std::cbrt(std::abs(pressure) * radius / m.membrane_modulus);
  // The generator places a vertex there.
  return relative_error(std::abs(state.x.front()[2]), expected);
}

double catenary_error(const SpringsScene& scene, const FinalState& state) {
  const std::vector<double>& g = scene.loads[0].gravity;
  const double strength = std::hypot(g[0], g[1], g[2]);
  Vector down, across;
  const Vector &first = state.x.front(), &last = state.x.back();
  double drop = 0.0;
  for (std::size_t a = 0; a < 3; ++a) down[a] = g[a] / strength, drop += (last[a] - first[a]) * down[a];
  for (std::size_t a = 0; a < 3; ++a) across[a] = last[a] - first[a] - drop * down[a];
  const double span = std::hypot(across[0], across[1], across[2]);
  std::vector<double> arc = {0.0};
  for (std::size_t i = 1; i < state.x.size(); ++i)
    arc.push_back(arc.back() + distance(scene.mesh.rest[i], scene.mesh.rest[i - 1]));
  const std::vector<CatenaryPoint> points =
      catenary_points({.span = span,
                       .drop = drop,
                       .length = arc.back(),
                       .weight = scene.fabric.line_density * strength,
                       .axial_stiffness = scene.fabric.material.axial_stiffness},
                      arc);
  double error = points.empty() ? std::numeric_limits<double>::quiet_NaN() : 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vector expected;
    for (std::size_t a = 0; a < 3; ++a)
      expected[a] = first[a] + points[i].along * across[a] / span + points[i].down * down[a];
    error = run::maximum_or_nan(error, distance(state.x[i], expected));
  }
  return error / span;
}

double stretch_error(const SpringsScene& scene, const FinalState& state) {
  const std::vector<double>& g = scene.loads[0].gravity;
  const double strength = std::hypot(g[0], g[1], g[2]);
  const double length = distance(scene.source.string->from, scene.source.string->to);
  const double expected =
      hanging_stretch(scene.fabric.material.axial_stiffness, scene.fabric.line_density * strength, length,
                      state.payload * strength);
  return relative_error(distance(state.x.front(), state.x.back()) - length, expected);
}

double expected_frequency(const SpringsScene& scene, const FinalState& state) {
  const Frequency& wanted = *scene.verify.frequency;
  if (wanted.value) return *wanted.value;
  const fabric::Material& m = scene.fabric.material;
  const auto number = [&](std::size_t k) { return static_cast<int>(wanted.mode[k]); };
  if (scene.source.disk)
    return drum_frequency(m, scene.fabric.area_density, scene.source.disk->radius, scene.initial.prestretch,
                          number(0), number(1));
  return string_frequency(m.axial_stiffness, scene.fabric.line_density,
                          distance(scene.source.string->from, scene.source.string->to), state.payload,
                          number(0));
}

double front_speed(const SpringsScene& scene, const History& history) {
  const std::string& axis = scene.verify.front_speed->axis;
  const auto rise = [&](const char* probe) {
    return half_rise_time(history.at("time"), history.at(probe + axis));
  };
  const auto place = [&](std::size_t k) {
    return scene.mesh.rest[static_cast<std::size_t>(nearest_vertex(scene.mesh, scene.output.probes[k].at))];
  };
  return distance(place(0), place(1)) / (rise("probe_1_") - rise("probe_0_"));
}

/// Value of the final state that `wanted` names.
double final_value(const SpringsScene& scene, const FinalState& state, const FinalValue& wanted) {
  if (wanted.quantity == FinalQuantity::elastic_energy) return state.elastic_energy;
  if (wanted.quantity == FinalQuantity::area_growth)
    return total_area(scene.mesh, state.x) / total_area(scene.mesh, scene.mesh.rest) - 1.0;
  const auto vertex = static_cast<std::size_t>(nearest_vertex(scene.mesh, wanted.at));
  if (wanted.quantity == FinalQuantity::von_mises) return state.von_mises[vertex];
  const std::size_t axis = wanted.quantity == FinalQuantity::displacement_x   ? 0
                           : wanted.quantity == FinalQuantity::displacement_y ? 1
                                                                              : 2;
  return state.x[vertex][axis] - scene.mesh.rest[vertex][axis];
}

}  // namespace

double imbalance(const FinalState& state) {
  double on_free = 0.0, on_fixed = state.largest_load;
  for (std::size_t i = 0; i < state.force.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double& place = (state.pinned[i] >> axis & 1U) != 0U ? on_fixed : on_free;
      place = run::maximum_or_nan(place, std::abs(state.force[i][axis]));
    }
  return share_of(on_free, on_fixed);
}

Response pulled_response(const fabric::Mesh& mesh, const FinalState& state) {
  struct Side {
    double rest, moved = 0.0, force = 0.0;
    int count = 0;
  };
  // Sides along an axis: vertices at its minimum and maximum coordinate.
  const auto sides = [&](std::size_t axis) {
    const auto [low, high] = std::ranges::minmax_element(
        mesh.rest, [axis](const Vector& a, const Vector& b) { return a[axis] < b[axis]; });
    std::array<Side, 2> found{Side{(*low)[axis]}, Side{(*high)[axis]}};
    const double near = 1e-9 * (found[1].rest - found[0].rest);
    for (std::size_t i = 0; i < mesh.rest.size(); ++i)
      for (Side& side : found) {
        if (std::abs(mesh.rest[i][axis] - side.rest) > near) continue;
        side.moved += state.x[i][axis] - side.rest;
        side.force += state.force[i][axis];
        ++side.count;
      }
    for (Side& side : found) side.moved /= side.count;
    return found;
  };
  const auto ends = sides(0), flanks = sides(1);
  const double width = flanks[1].rest - flanks[0].rest;
  Response response;
  response.width = width;
  response.strain = (ends[1].moved - ends[0].moved) / (ends[1].rest - ends[0].rest);
  // The reaction at the last column is minus the force of the cloth.
  response.young = -ends[1].force / width / response.strain;
  response.poisson = -(flanks[1].moved - flanks[0].moved) / width / response.strain;
  return response;
}

std::optional<double> even_line_stiffness(const fabric::Mesh& mesh) {
  std::vector<double> ahead(mesh.rest.size(), 0.0), behind = ahead;
  for (std::size_t k = 0; k < mesh.lines.size(); ++k) {
    auto [a, b] = mesh.lines[k];
    const auto place = [&](int i) -> const Vector& { return mesh.rest[static_cast<std::size_t>(i)]; };
    if (place(a)[0] > place(b)[0]) std::swap(a, b);
    if (place(a)[0] == place(b)[0] || place(a)[1] != place(b)[1] || place(a)[2] != place(b)[2])
      return std::nullopt;
    ahead[static_cast<std::size_t>(a)] += mesh.line_stiffness[k];
    behind[static_cast<std::size_t>(b)] += mesh.line_stiffness[k];
  }
  const auto [low, high] = std::ranges::minmax(mesh.rest, {}, [](const Vector& x) { return x[0]; });
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.rest.size(); ++i) {
    const double x = mesh.rest[i][0];
    if (x > low[0] && x < high[0] && ahead[i] != behind[i]) return std::nullopt;
    if (x == high[0]) sum += behind[i];
  }
  return sum;
}

bool needs_history(const Verify& wanted) {
  return wanted.frequency || wanted.front_speed || wanted.energy_drift || wanted.energy_balance ||
         wanted.intersections || wanted.momentum || wanted.angular_momentum;
}

std::optional<EnergyLoss> energy_loss(const History& history) {
  const std::vector<double>& energy = history.at("energy");
  if (energy.empty()) return std::nullopt;
  const double scale = energy_scale(history);
  double lost = energy.front() - energy.back();
  for (const char* work : {"contact_work", "friction_work"})
    if (const auto at = history.find(work); at != history.end())
      lost += at->second.back() - at->second.front();
  if (!(scale > 0.0)) return std::nullopt;
  return EnergyLoss{lost, lost / scale};
}

void verify(const SpringsScene& scene, const FinalState& state, const History& history,
            run::ResultDocument& result) {
  const Verify& wanted = scene.verify;
  const auto add = [&result](const std::string& name, double error, double tolerance) {
    result.errors[name] = error;
    result.add_check(name, error, tolerance);
  };
  // A check of the rows of the history.
  const auto add_of_rows = [&](const std::string& name, double error, double tolerance, double period = 0.0) {
    add(name, error, tolerance);
    result.state_rows(history.at("time").size(), period);
  };
  if (wanted.frequency) {
    const Frequency& f = *wanted.frequency;
    const auto &time = history.at("time"),
               &column = history.at("probe_" + std::to_string(f.probe) + "_" + f.axis);
    const double frequency = fitted_frequency(time, column);
    add_of_rows("frequency", relative_error(frequency, expected_frequency(scene, state)), f.tolerance,
                static_cast<double>(time.size()) / (time.back() * frequency));
  }
  if (wanted.hencky) add("hencky", hencky_error(scene, state), *wanted.hencky);
  if (wanted.catenary) add("catenary", catenary_error(scene, state), *wanted.catenary);
  if (wanted.stretch) add("stretch", stretch_error(scene, state), *wanted.stretch);
  if (wanted.young || wanted.poisson) {
    const fabric::Material& m = scene.fabric.material;
    const Response response = pulled_response(scene.mesh, state);
    // Reinforcements bear E A e beside the cloth.
    const double expected = m.membrane_modulus * nominal_stress_factor(m.model, response.strain) +
                            *even_line_stiffness(scene.mesh) / response.width;
    if (wanted.young) add("young", relative_error(response.young, expected), *wanted.young);
    if (wanted.poisson) add("poisson", std::abs(response.poisson - m.poisson), *wanted.poisson);
  }
  if (wanted.front_speed)
    add_of_rows("front_speed", relative_error(front_speed(scene, history), wanted.front_speed->value),
                wanted.front_speed->tolerance);
  for (std::size_t k = 0; k < wanted.values.size(); ++k) {
    const FinalValue& value = wanted.values[k];
    add("values_" + std::to_string(k) + "_" + name_of(value.quantity),
        relative_error(final_value(scene, state, value), value.value), value.tolerance);
  }
  if (wanted.equilibrium) add("equilibrium", imbalance(state), *wanted.equilibrium);
  if (wanted.energy_drift) add_of_rows("energy_drift", energy_drift(history), *wanted.energy_drift);
  if (wanted.energy_balance) add_of_rows("energy_balance", energy_imbalance(history), *wanted.energy_balance);
  if (wanted.intersections || wanted.penetration) {
    const ContactState now = contact_state(scene, state.x);
    if (wanted.intersections)
      add_of_rows("intersections",
                  run::maximum_or_nan(largest(history.at("intersections")), now.intersections),
                  *wanted.intersections);
    if (wanted.penetration) add("penetration", now.penetration, *wanted.penetration);
  }
  const double impulse = std::sqrt(2.0 * state.mass * (history.empty() ? 0.0 : energy_scale(history)));
  if (wanted.momentum)
    add_of_rows("momentum", share_of(largest_change(history, "momentum"), impulse), *wanted.momentum);
  if (wanted.angular_momentum)
    add_of_rows("angular_momentum",
                share_of(largest_change(history, "angular_momentum"), extent(scene.mesh) * impulse),
                *wanted.angular_momentum);
}

}  // namespace drogue::springs_app
