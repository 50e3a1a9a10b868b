#include "miniapps/parachute/verify/flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "common/run/history_statistics.hpp"
#include "common/run/uncertainty.hpp"
#include "common/scene/node.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Factor of Maskell's relation for a single parachute (Macha and Buffington, SAND89-1485, 1990).
constexpr double blockage_factor = 1.85;

/// Largest ratio of dynamic pressures that it corrects. Boxes in which it is at most that agree with wider
/// ones (docs/parachute-notebook.md, drag); at 1.9, in `c9-duct`, the corrected drag is a fifth too small.
constexpr double largest_pressure_ratio = 1.3;

/// Part of the area in flight that a canopy has at the start if it opens at all.
constexpr double closed_area = 0.9;

/// Direction in which the air passes a canopy in steady flight: upwards if its payload falls, else that of
/// the stream; zero without either.
Vector direction_of(const FlowScene& scene, std::size_t i) {
  Vector direction = scene.stream().value_or(Vector{});
  if (scene.descends(i))
    for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = -scene.gravity[axis];
  const double length = length_of(direction);
  for (double& component : direction) component = length > 0.0 ? component / length : 0.0;
  return direction;
}

/// True for the direction across which `projected_area` is.
bool is_along_z(const Vector& direction) { return std::abs(direction[2]) > 1.0 - 1e-9; }

/// Area of the domain across a direction, m^2; infinite for one along no axis, whose section varies.
double section_of(const flow::Parameters& p, const Vector& direction) {
  double section = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(direction[axis]) < 1.0 - 1e-9) {
      if (std::abs(direction[axis]) > 1e-9) return run::never;
      section *= p.high[axis] - p.low[axis];
    }
  return section;
}

/// True if the relation of `blockage_factor` holds: closed sides across the direction hold the stream
/// together, and the canopy is on its axis. One that glides has another factor (docs/parachute-notebook.md,
/// blockage).
bool is_blocked_by_sides(const FlowScene& scene, std::size_t i, const Vector& direction) {
  const CanopyPayload& payload = scene.canopies[scene.owner_of(i)].payload;
  if (!payload.fixed && !payload.guided) return false;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (direction[axis] == 0.0 && scene.open_axes()[axis]) return false;
  return true;
}

/// Begin of the interval of the means, s.
double begin_of_means(const FlowScene& scene) {
  double changed = 0.0;
  for (const Canopy& canopy : scene.canopies)
    if (canopy.reefing && canopy.reefing->cut) changed = std::max(changed, *canopy.reefing->cut);
  return 0.5 * (changed + scene.end_time);
}

/// Rows of one canopy.
class FlightRows {
 public:
  /// `direction`: as of `direction_of`.
  FlightRows(const FlowScene& scene, const run::History& history, std::size_t i, const Vector& direction)
      : _history(history), _name("canopy_" + std::to_string(i) + "_"), _time(history.at("time")) {
    const Vector stream = scene.stream().value_or(Vector{});
    const auto vector_at = [&](const std::string& name, std::size_t row) {
      Vector v{};
      for (std::size_t axis = 0; axis < 3; ++axis) v[axis] = history.at(name + axis_names[axis])[row];
      return v;
    };
    const auto along = [&](const Vector& v) {
      return v[0] * direction[0] + v[1] * direction[1] + v[2] * direction[2];
    };
    for (std::size_t row = 0; row < _time.size(); ++row) {
      Vector relative = stream;
      const Vector payload = vector_at(_name + "payload_velocity_", row);
      for (std::size_t axis = 0; axis < 3; ++axis) relative[axis] -= payload[axis];
      _speed.push_back(along(relative));
      for (std::size_t axis = 0; axis < 3; ++axis) relative[axis] -= _speed.back() * direction[axis];
      _across.push_back(length_of(relative));
      _force.push_back(along(vector_at(_name + "force_", row)));
      _all_forces.push_back(0.0);
      for (std::size_t k = 0; k < scene.canopies.size(); ++k)
        _all_forces.back() += along(vector_at("canopy_" + std::to_string(k) + "_force_", row));
    }
  }

  [[nodiscard]] double speed(double from, double to) const { return mean(_speed, from, to); }
  [[nodiscard]] double across(double from, double to) const { return mean(_across, from, to); }
  [[nodiscard]] double force(double from, double to) const { return mean(_force, from, to); }
  [[nodiscard]] double all_forces(double from, double to) const { return mean(_all_forces, from, to); }
  [[nodiscard]] double column(const char* name, double from, double to) const {
    return mean(_history.at(_name + name), from, to);
  }

  /// Time, s, at which the payload has come down by `height`, m, through the air, and its speed down then,
  /// m/s; NaN if it has not.
  [[nodiscard]] std::array<double, 2> touch_down(double height) const {
    double fallen = 0.0;
    for (std::size_t k = 1; k < _time.size(); ++k) {
      const double part = 0.5 * (_speed[k - 1] + _speed[k]) * (_time[k] - _time[k - 1]);
      if (fallen + part >= height) {
        const double share = (height - fallen) / part;
        return {std::lerp(_time[k - 1], _time[k], share), std::lerp(_speed[k - 1], _speed[k], share)};
      }
      fallen += part;
    }
    return {NAN, NAN};
  }

  /// Time, s, at which the projected area first reaches `area`, m^2, from one that is closed; NaN if it does
  /// not.
  [[nodiscard]] double opening_time(double area) const {
    const std::vector<double>& areas = _history.at(_name + "projected_area");
    const auto open = std::ranges::find_if(areas, [&](double value) { return value >= area; });
    if (open == areas.end() || !(areas.front() < closed_area * area)) return NAN;
    const auto k = static_cast<std::size_t>(open - areas.begin());
    return std::lerp(_time[k - 1], _time[k], (area - areas[k - 1]) / (areas[k] - areas[k - 1]));
  }

 private:
  [[nodiscard]] double mean(const std::vector<double>& values, double from, double to) const {
    return run::mean_between({_time, values}, from, to);
  }

  const run::History& _history;
  std::string _name;
  const std::vector<double>& _time;
  std::vector<double> _speed,
      _across;  ///< of the air relative to the payload, along and across the direction, m/s
  std::vector<double> _force, _all_forces;  ///< of the air on this canopy and on all, along it, N
};

/// Statistic of an interval of time, s.
using Statistic = std::function<double(double from, double to)>;

/// Means of a flight by their keys.
std::vector<std::pair<std::string, Statistic>> means_of(const FlowScene& scene, const FlightRows& rows,
                                                        std::size_t i, const Vector& direction) {
  const double density = scene.parameters.density, area = scene.canopies[i].nominal_area();
  const double section = section_of(scene.parameters, direction);
  const auto drag = [=, &rows](double from, double to) {
    return 2.0 * rows.force(from, to) / (density * std::pow(rows.speed(from, to), 2) * area);
  };
  // Dynamic pressure at the canopies over that of the stream far away: Maskell, R&M 3400, 1963.
  const auto pressure_ratio = [=, &rows](double from, double to) {
    return 1.0 + blockage_factor * 2.0 * rows.all_forces(from, to) /
                     (density * std::pow(rows.speed(from, to), 2) * section);
  };
  const bool is_blocked = is_blocked_by_sides(scene, i, direction) &&
                          pressure_ratio(begin_of_means(scene), scene.end_time) <= largest_pressure_ratio;
  std::vector<std::pair<std::string, Statistic>> means;
  const auto add = [&](std::string key, Statistic statistic) {
    means.emplace_back(std::move(key), std::move(statistic));
  };
  if (scene.descends(i)) {
    add("rate_of_descent", [&rows](double from, double to) { return rows.speed(from, to); });
    if (is_blocked)
      add("rate_of_descent_free_air", [=, &rows](double from, double to) {
        return rows.speed(from, to) * std::sqrt(pressure_ratio(from, to));
      });
    add("drift", [&rows](double from, double to) { return rows.across(from, to); });
  }
  add("drag_coefficient", drag);
  if (is_blocked)
    add("drag_coefficient_free_air",
        [=](double from, double to) { return drag(from, to) / pressure_ratio(from, to); });
  if (!is_along_z(direction)) return means;
  add("inflated_diameter_ratio", [=, &rows](double from, double to) {
    return std::sqrt(rows.column("projected_area", from, to) / area);
  });
  add("leak", [&rows](double from, double to) {
    return rows.column("leak", from, to) /
           (rows.column("airspeed", from, to) * rows.column("projected_area", from, to));
  });
  return means;
}

/// A key of a group.
struct Title {
  const char* key;
  const char* text;
  bool is_mean = false;
};

/// Keys of a group in the order in which they are printed.
constexpr std::array<Title, 13> titles = {
    {{"rate_of_descent", "rate of descent, m/s", true},
     {"rate_of_descent_free_air", "rate of descent in free air, m/s", true},
     {"drift", "drift, m/s", true},
     {"drag_coefficient", "C_D0", true},
     {"drag_coefficient_free_air", "C_D0 in free air", true},
     {"inflated_diameter_ratio", "D_p/D_0", true},
     {"leak", "flow through the cloth/(U A)", true},
     {"largest_lean", "largest lean, degrees"},
     {"opening_time", "opening time, s"},
     {"peak_line_force", "peak line force, N"},
     {"peak_line_force_time", "peak line force at, s"},
     {"touchdown_time", "touch-down at, s"},
     {"touchdown_speed", "rate of descent then, m/s"}}};

/// "canopy[0]" of the group `canopy_0`, and likewise of bodies.
std::string part_name(const std::string& group) {
  const std::size_t separator = group.find('_');
  return group.substr(0, separator) + "[" + group.substr(separator + 1) + "]";
}

/// Title of a key of a group; the key if it has none.
std::string title_of(const std::string& group, const std::string& key) {
  if (group.starts_with("body_") && key == "drag_coefficient") return "C_D";  // of its frontal area
  const auto found = std::ranges::find_if(titles, [&](const Title& title) { return title.key == key; });
  return found == titles.end() ? key : found->text;
}

void describe_means(const FlowScene& scene, const run::History& history, std::size_t i,
                    run::ResultDocument& result) {
  const Vector direction = direction_of(scene, i);
  if (history.empty() || !scene.lack_of_airspeed(i).empty() ||
      scene.canopies[scene.owner_of(i)].payload.release || direction == Vector{})
    return;
  const FlightRows rows(scene, history, i, direction);
  const std::string group = "canopy_" + std::to_string(i);
  const double from = begin_of_means(scene), to = scene.end_time;
  const auto set = [&](const std::string& name, double value) {
    if (std::isfinite(value)) result.metrics.set(group, name, value);
  };
  set("from", from);
  for (const auto& [name, statistic] : means_of(scene, rows, i, direction)) {
    set(name, statistic(from, to));
    set(name + "_error", run::batch_half_width(statistic, from, to));
  }
  if (scene.drop && scene.drop->height && scene.descends(i)) {
    const auto [time, speed] = rows.touch_down(*scene.drop->height);
    set("touchdown_time", time);
    set("touchdown_speed", speed);
    if (std::isnan(time))
      result.warnings.push_back(
          scene::sentence("drop.height = ", scene::rough_text(*scene.drop->height),
                          " m is not reached before run.end_time = ", scene::rough_text(to), " s"));
  }
  if (is_along_z(direction)) set("opening_time", rows.opening_time(rows.column("projected_area", from, to)));
}

/// Describes how far a canopy leans in rows. Warns of one that leans farther than its room in the core was
/// checked for, and has none for that.
void describe_lean(const FlowScene& scene, const run::History& history, std::size_t i,
                   run::ResultDocument& result) {
  if (history.empty() || scene.canopies[scene.owner_of(i)].payload.release) return;
  const std::string group = "canopy_" + std::to_string(i);
  const std::vector<double>& leans = history.at(group + "_lean");
  const double largest = std::ranges::max(leans);
  result.metrics.set(group, "largest_lean", largest);
  if (!(largest > std::max(expected_lean, leans.front()))) return;
  if (const std::string text = narrow_core_text(scene, i, largest, ", as it did in this run,"); !text.empty())
    result.warnings.push_back(text);
}

/// True of a time, s, at which the air has passed less than a twentieth of a canopy.
bool is_of_the_start(const FlowScene& scene, const run::History& history, std::size_t i, double time) {
  if (history.empty() || !scene.lack_of_airspeed(i).empty()) return false;
  const double speed = std::ranges::max(history.at("canopy_" + std::to_string(i) + "_airspeed"));
  return speed * time < 0.05 * scene.canopies[i].nominal_diameter();
}

}  // namespace

void describe_flights(const FlowScene& scene, const PeakPulls& peaks, const run::History& history,
                      run::ResultDocument& result) {
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    if (!scene.canopies[i].has_lines()) continue;
    describe_means(scene, history, i, result);
    describe_lean(scene, history, i, result);
    const auto [force, time] = peaks.values().at(i);
    if (!(force > 0.0)) continue;
    const std::string group = "canopy_" + std::to_string(i);
    result.metrics.set(group, "peak_line_force", force);
    result.metrics.set(group, "peak_line_force_time", time);
    if (time > 0.98 * scene.end_time)
      result.warnings.push_back(part_name(group) +
                                ": the largest line force is that of the end of the run, and may still grow; "
                                "a longer run.end_time shows the peak");
    else if (is_of_the_start(scene, history, i, time))
      result.warnings.push_back(part_name(group) + ": the largest line force is that of the start, " +
                                scene::rough_text(time) +
                                " s, before the air has passed a twentieth of the canopy, and not of the "
                                "opening: cloth and lines that start strained pull so, as by a "
                                "perturbation.amplitude of more than some percent of edge_length");
  }
}

std::string flight_report(const run::ResultDocument& result) {
  std::string text;
  const auto& groups = result.metrics.groups();
  const auto rate = result.metrics.real("figure_of_merit", "simulated_s_per_s");
  if (rate &&
      std::ranges::any_of(groups, [](const auto& group) { return group.name.starts_with("canopy_"); }))
    text += "  " + scene::rough_text(*rate) + " s of flight per second of steps\n";
  for (const run::Metrics::Group& group : groups) {
    if (!(group.name.starts_with("canopy_") || group.name.starts_with("body_")) || group.values.empty())
      continue;
    const auto value = [&](const std::string& name) { return result.metrics.real(group.name, name); };
    text += part_name(group.name);
    if (const auto area = value("frontal_area")) text += " of " + scene::rough_text(*area) + " m^2";
    if (const auto from = value("from"))
      text += ", means from " + scene::rough_text(*from) + " s on; +- is 95 % by the scatter in this run";
    text += '\n';
    for (const auto& [key, ignored, is_mean] : titles) {
      const std::string name = key;
      const auto number = value(name), error = value(name + "_error");
      if (!number) continue;
      const std::string shown = title_of(group.name, name);
      text += "  " + shown + std::string(34 - shown.size(), ' ') +
              run::bar_text(*number, error.value_or(NAN)) +
              (is_mean && !error ? "  (no error bar: too short a run, or a drift)" : "") + '\n';
    }
  }
  return text;
}

std::string flight_title(const std::string& quantity) {
  const std::size_t dot = quantity.find('.');
  if (dot == std::string::npos) return quantity;
  const std::string group = quantity.substr(0, dot);
  return part_name(group) + " " + title_of(group, quantity.substr(dot + 1));
}

}  // namespace drogue::parachute_app
