#include "miniapps/parachute/parallel/parameters_message.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <vector>

namespace drogue::parachute_app {
namespace {

template <class T, class Of>
concept IsMaybeConst = std::same_as<std::remove_const_t<T>, Of>;

// References to all members of what is not copied bytewise. A new member does not compile until it stands
// here.

auto members(IsMaybeConst<flow::Boundary> auto& side) {
  auto& [kind, velocity, velocity_expressions] = side;
  return std::tie(kind, velocity, velocity_expressions);
}

auto members(IsMaybeConst<flow::Parameters> auto& parameters) {
  auto& [cells, low, high, density, viscosity, boundary, body_force, pressure_drop, advection, time_scheme,
         diffusion, turbulence, turbulence_constant, pressure_solver, pressure_tolerance, external_force, cfl,
         fixed_dt, max_dt, max_steps, horizon, motion, watches_extremes, driver, block] = parameters;
  return std::tie(cells, low, high, density, viscosity, boundary, body_force, pressure_drop, advection,
                  time_scheme, diffusion, turbulence, turbulence_constant, pressure_solver,
                  pressure_tolerance, external_force, cfl, fixed_dt, max_dt, max_steps, horizon, motion,
                  watches_extremes, driver, block);
}

auto members(IsMaybeConst<mesh::Mesh> auto& mesh) {
  auto& [rest, triangles, lines, line_stiffness, line_density, line_length] = mesh;
  return std::tie(rest, triangles, lines, line_stiffness, line_density, line_length);
}

auto members(IsMaybeConst<fabric::TimedLoad> auto& load) {
  auto& [strength, direction] = load;
  return std::tie(strength, direction);
}

auto members(IsMaybeConst<fabric::FollowerPressure> auto& pressure) {
  auto& [strength, weight] = pressure;
  return std::tie(strength, weight);
}

auto members(IsMaybeConst<fabric::Motion> auto& motion) {
  auto& [axis, vertices, displacement] = motion;
  return std::tie(axis, vertices, displacement);
}

auto members(IsMaybeConst<fabric::Contact> auto& contact) {
  auto& [bodies, self, thickness, friction, interval, block] = contact;
  return std::tie(bodies, self, thickness, friction, interval, block);
}

auto members(IsMaybeConst<fabric::Parameters> auto& parameters) {
  auto& [mesh, material, mass, pinned, load, gravity, timed_loads, follower_pressures, motions, damping,
         relative_damping, contact, integrator, dt, driver, patch] = parameters;
  return std::tie(mesh, material, mass, pinned, load, gravity, timed_loads, follower_pressures, motions,
                  damping, relative_damping, contact, integrator, dt, driver, patch);
}

auto members(IsMaybeConst<coupling::SheetParameters> auto& sheet) {
  auto& [delta, law, law_of_vertex, filter, defect_filter, edge_inset, method, closing] = sheet;
  return std::tie(delta, law, law_of_vertex, filter, defect_filter, edge_inset, method, closing);
}

auto members(IsMaybeConst<coupling::LineCut> auto& cut) {
  auto& [time, lines] = cut;
  return std::tie(time, lines);
}

auto members(IsMaybeConst<coupling::Parameters> auto& parameters) {
  auto& [flow, fabric, sheet, follow, substeps, contact_interval, longest_batch, cuts, line_strength] =
      parameters;
  return std::tie(flow, fabric, sheet, follow, substeps, contact_interval, longest_batch, cuts,
                  line_strength);
}

template <class>
inline constexpr bool is_vector = false;
template <class Element>
inline constexpr bool is_vector<std::vector<Element>> = true;
template <class>
inline constexpr bool is_array = false;
template <class Element, std::size_t n>
inline constexpr bool is_array<std::array<Element, n>> = true;

template <class Value>
void put(MessageWriter& message, const Value& value) {
  const auto put_each = [&](const auto& elements) {
    for (const auto& element : elements) put(message, element);
  };
  if constexpr (std::is_trivially_copyable_v<Value>) {
    message.put(value);
  } else if constexpr (is_vector<Value>) {
    if constexpr (std::is_trivially_copyable_v<typename Value::value_type>) {
      message.put_all(value);
    } else {
      message.put(value.size());
      put_each(value);
    }
  } else if constexpr (is_array<Value>) {
    put_each(value);
  } else {
    std::apply([&](const auto&... member) { (put(message, member), ...); }, members(value));
  }
}

template <class Value>
void get(MessageReader& message, Value& value) {
  const auto get_each = [&](auto& elements) {
    for (auto& element : elements) get(message, element);
  };
  if constexpr (std::is_trivially_copyable_v<Value>) {
    value = message.get<Value>();
  } else if constexpr (is_vector<Value>) {
    if constexpr (std::is_trivially_copyable_v<typename Value::value_type>) {
      value = message.get_all<typename Value::value_type>();
    } else {
      value.resize(message.get<std::size_t>());
      get_each(value);
    }
  } else if constexpr (is_array<Value>) {
    get_each(value);
  } else {
    std::apply([&](auto&... member) { (get(message, member), ...); }, members(value));
  }
}

}  // namespace

void put_parameters(MessageWriter& message, const coupling::Parameters& parameters) {
  put(message, parameters);
}

coupling::Parameters get_parameters(MessageReader& message) {
  coupling::Parameters parameters;
  get(message, parameters);
  return parameters;
}

}  // namespace drogue::parachute_app
