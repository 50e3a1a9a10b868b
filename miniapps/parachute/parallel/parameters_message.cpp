#include "miniapps/parachute/parallel/parameters_message.hpp"

#include <type_traits>

namespace drogue::parachute_app {
namespace {

/// Calls `visit` with every member. A new member does not compile until it stands here.
template <class Parameters, class Visit>
void visit_members(Parameters& parameters, const Visit& visit) {
  auto& [cells, low, high, density, viscosity, boundary, body_force, pressure_drop, advection, time_scheme,
         diffusion, turbulence, turbulence_constant, pressure_solver, pressure_tolerance, external_force, cfl,
         fixed_dt, max_dt, max_steps, driver] = parameters;
  const auto visit_all = [&](auto&... members) { (visit(members), ...); };
  visit_all(cells, low, high, density, viscosity, body_force, pressure_drop, advection, time_scheme,
            diffusion, turbulence, turbulence_constant, pressure_solver, pressure_tolerance, external_force,
            cfl, fixed_dt, max_dt, max_steps, driver);
  for (auto& side : boundary) {
    auto& [kind, velocity, velocity_expressions] = side;
    visit_all(kind, velocity, velocity_expressions);
  }
}

template <class Member>
constexpr bool is_list = std::is_same_v<std::remove_const_t<Member>, std::vector<device::ExpressionProgram>>;

}  // namespace

void put_parameters(MessageWriter& message, const flow::Parameters& parameters) {
  visit_members(parameters, [&](const auto& member) {
    if constexpr (is_list<std::remove_reference_t<decltype(member)>>)
      message.put_all(member);
    else
      message.put(member);
  });
}

flow::Parameters get_parameters(MessageReader& message) {
  flow::Parameters parameters;
  visit_members(parameters, [&]<class Member>(Member& member) {
    if constexpr (is_list<Member>)
      member = message.get_all<device::ExpressionProgram>();
    else
      member = message.get<Member>();
  });
  return parameters;
}

}  // namespace drogue::parachute_app
