#include "kernels/reference/flow/step.hpp"

#include <cmath>
#include <functional>

#include "kernels/reference/flow/momentum.hpp"

namespace drogue::reference {

using flow::BoundaryKind;

namespace {

/// Linear combination of fields.
StaggeredField combine(const FlowDomain& domain,
                       std::initializer_list<std::pair<double, const StaggeredField*>> terms) {
  StaggeredField sum = domain.zero_field();
  for (const auto& [factor, field] : terms)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < sum[c].size(); ++i) sum[c][i] += factor * (*field)[c][i];
  return sum;
}

/// Integral of a product; the operators below are symmetric in this inner product.
double dot(const std::vector<double>& volumes, const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += volumes[i] * a[i] * b[i];
  return sum;
}

void subtract_mean(const std::vector<double>& volumes, std::vector<double>& values) {
  double integral = 0.0, volume = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    integral += volumes[i] * values[i];
    volume += volumes[i];
  }
  for (double& value : values) value -= integral / volume;
}

std::vector<double> cell_volumes(const FlowDomain& domain) {
  std::vector<double> volumes;
  domain.for_each_cell([&](const GridIndex& cell) { volumes.push_back(domain.volume(cell)); });
  return volumes;
}

/// Control volumes of a component, m^3.
std::vector<double> control_volumes(const FlowDomain& domain, std::size_t c) {
  std::vector<double> volumes;
  domain.for_each_face([&](std::size_t component, const GridIndex& face) {
    if (component != c) return;
    volumes.push_back(domain.extent(c, 0, face[0]) * domain.extent(c, 1, face[1]) *
                      domain.extent(c, 2, face[2]));
  });
  return volumes;
}

bool has_outflow(const FlowDomain& domain) {
  for (std::size_t side = 0; side < 6; ++side)
    if (domain.kind(side) == BoundaryKind::outflow) return true;
  return false;
}

bool is_beside_outflow(const FlowDomain& domain, const GridIndex& cell) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (domain.cells(axis) == 1) continue;
    if (cell[axis] == 0 && domain.kind(2 * axis) == BoundaryKind::outflow) return true;
    if (cell[axis] + 1 == domain.cells(axis) && domain.kind(2 * axis + 1) == BoundaryKind::outflow)
      return true;
  }
  return false;
}

/// Solves div grad p = f with zero pressure on outflows.
std::vector<double> solve_pressure(const FlowDomain& domain, std::vector<double> f) {
  const bool singular = !has_outflow(domain);
  const std::vector<double> volumes = cell_volumes(domain);
  if (singular) subtract_mean(volumes, f);
  std::vector<double> p(f.size(), 0.0), residual = f, direction = f;
  double norm = dot(volumes, residual, residual);
  const double target = 1e-31 * norm;
  for (std::size_t iteration = 0; iteration < 20 * f.size() && norm > target; ++iteration) {
    const std::vector<double> image = divergence(domain, pressure_gradient(domain, direction));
    const double alpha = norm / dot(volumes, direction, image);
    for (std::size_t i = 0; i < p.size(); ++i) {
      p[i] += alpha * direction[i];
      residual[i] -= alpha * image[i];
    }
    if (singular) subtract_mean(volumes, residual);
    const double next = dot(volumes, residual, residual);
    for (std::size_t i = 0; i < p.size(); ++i) direction[i] = residual[i] + next / norm * direction[i];
    norm = next;
  }
  if (singular) subtract_mean(volumes, p);
  return p;
}

/// Laplacian of the change of a velocity component in a step at the faces inside the domain; zero on its
/// sides. Changes on walls and inflows are known: `on_wall(side, face beyond it)`.
std::vector<double> change_laplacian(const FlowDomain& domain, const StaggeredField& change, std::size_t c,
                                     const std::function<double(std::size_t, const GridIndex&)>& on_wall) {
  std::vector<double> laplacian(change[c].size(), 0.0);
  domain.for_each_face([&](std::size_t component, const GridIndex& face) {
    if (component != c || domain.side_of(c, face) >= 0) return;
    const double own = change[c][domain.at(c, face)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (domain.cells(axis) == 1) continue;
      for (const int direction : {-1, 1}) {
        GridIndex next = face;
        next[axis] += direction;
        const int n = domain.cells(axis);
        double value = own;  // beyond slip sides and outflows
        if (!domain.is_bounded(axis) || axis == c || (next[axis] >= 0 && next[axis] < n)) {
          if (!domain.is_bounded(axis)) next[axis] = (next[axis] + n) % n;
          value = change[c][domain.at(c, next)];
        } else {
          const std::size_t side = 2 * axis + (direction > 0 ? 1 : 0);
          if (domain.kind(side) == BoundaryKind::wall || domain.kind(side) == BoundaryKind::inflow)
            value = 2.0 * on_wall(side, next) - own;
        }
        laplacian[domain.at(c, face)] += (value - own) /
                                         domain.step(c, axis, direction > 0 ? face[axis] + 1 : face[axis]) /
                                         domain.extent(c, axis, face[axis]);
      }
    }
  });
  return laplacian;
}

/// Solves (1 - a lap) x = source inside the domain by conjugate gradients, for component c of a change whose
/// values on the sides are known.
void solve_change(const FlowDomain& domain, StaggeredField& change, std::size_t c, double a,
                  const std::vector<double>& source,
                  const std::function<double(std::size_t, const GridIndex&)>& on_wall) {
  std::vector<bool> inside(change[c].size(), false);
  domain.for_each_face([&](std::size_t component, const GridIndex& face) {
    if (component == c) inside[domain.at(c, face)] = domain.side_of(c, face) < 0;
  });
  const auto at_rest = [](std::size_t, const GridIndex&) { return 0.0; };
  const std::vector<double> volumes = control_volumes(domain, c);
  const std::vector<double> known = change_laplacian(domain, change, c, on_wall);
  std::vector<double> residual(source.size(), 0.0);
  for (std::size_t i = 0; i < source.size(); ++i)
    if (inside[i]) residual[i] = source[i] + a * known[i] - change[c][i];
  StaggeredField direction = domain.zero_field();
  direction[c] = residual;
  double norm = dot(volumes, residual, residual);
  const double target = 1e-31 * norm;
  for (std::size_t iteration = 0; iteration < 20 * source.size() && norm > target; ++iteration) {
    const std::vector<double> laplacian = change_laplacian(domain, direction, c, at_rest);
    std::vector<double> image = direction[c];
    for (std::size_t i = 0; i < image.size(); ++i) image[i] -= a * laplacian[i];
    const double alpha = norm / dot(volumes, direction[c], image);
    for (std::size_t i = 0; i < image.size(); ++i) {
      change[c][i] += alpha * direction[c][i];
      residual[i] -= alpha * image[i];
    }
    const double next = dot(volumes, residual, residual);
    for (std::size_t i = 0; i < image.size(); ++i)
      direction[c][i] = residual[i] + next / norm * direction[c][i];
    norm = next;
  }
}

}  // namespace

std::vector<double> present_pressure(const FlowDomain& domain, const StaggeredField& u, double time) {
  constexpr double dt = 1e-6;
  const StaggeredField before = with_side_velocity(domain, domain.zero_field(), time - dt);
  const StaggeredField after = with_side_velocity(domain, domain.zero_field(), time + dt);
  const StaggeredField rate = momentum_rate(domain, u, time);
  return solve_pressure(
      domain, divergence(domain, combine(domain, {{1.0, &rate}, {0.5 / dt, &after}, {-0.5 / dt, &before}})));
}

StaggeredField with_side_velocity(const FlowDomain& domain, StaggeredField u, double time) {
  domain.for_each_face([&](std::size_t c, const GridIndex& face) {
    const int side = domain.side_of(c, face);
    if (side >= 0 && domain.kind(static_cast<std::size_t>(side)) != BoundaryKind::outflow)
      u[c][domain.at(c, face)] = domain.normal_velocity(static_cast<std::size_t>(side), face, time);
  });
  return u;
}

std::vector<double> project(const FlowDomain& domain, StaggeredField& u, double dt) {
  std::vector<double> f = divergence(domain, u);
  for (double& value : f) value /= dt;
  const std::vector<double> p = solve_pressure(domain, f);
  const StaggeredField gradient = pressure_gradient(domain, p);
  u = combine(domain, {{1.0, &u}, {-dt, &gradient}});
  return p;
}

FlowState adams_bashforth_step(const FlowDomain& domain, const FlowState& state, double time, double dt) {
  FlowState next;
  next.old_rate = momentum_rate(domain, state.velocity, time);
  next.last_dt = dt;
  const double r = state.last_dt > 0.0 ? dt / state.last_dt : 0.0;
  const StaggeredField zero = domain.zero_field();
  next.velocity = combine(domain, {{1.0, &state.velocity},
                                   {dt * (1.0 + 0.5 * r), &next.old_rate},
                                   {-0.5 * dt * r, r > 0.0 ? &state.old_rate : &zero}});
  next.velocity = with_side_velocity(domain, next.velocity, time + dt);
  next.pressure = project(domain, next.velocity, dt);
  return next;
}

FlowState crank_nicolson_step(const FlowDomain& domain, const FlowState& state, double time, double dt) {
  const double nu = domain.parameters().viscosity / domain.parameters().density;
  const StaggeredField zero = domain.zero_field();
  const StaggeredField& u = state.velocity;
  const StaggeredField viscous = viscous_rate(domain, u, time);
  FlowState next;
  next.last_dt = dt;
  const StaggeredField rate = momentum_rate(domain, u, time);
  next.old_rate = combine(domain, {{1.0, &rate}, {-1.0, &viscous}});
  const double r = state.last_dt > 0.0 ? dt / state.last_dt : 0.0;
  const StaggeredField gradient = pressure_gradient(domain, state.pressure);
  const StaggeredField source = combine(domain, {{dt * (1.0 + 0.5 * r), &next.old_rate},
                                                 {-0.5 * dt * r, r > 0.0 ? &state.old_rate : &zero},
                                                 {dt, &viscous},
                                                 {-dt, &gradient}});
  const StaggeredField explicit_velocity = combine(domain, {{1.0, &u}, {1.0, &source}});
  const StaggeredField with_sides = with_side_velocity(domain, explicit_velocity, time + dt);
  StaggeredField change = combine(domain, {{1.0, &with_sides}, {-1.0, &u}});
  for (std::size_t c = 0; c < 3; ++c)
    solve_change(domain, change, c, 0.5 * nu * dt, source[c], [&](std::size_t, const GridIndex& beyond) {
      // Beyond a wall, the velocity is twice that of the wall less the one inside, here zero.
      return 0.5 * (domain.velocity(zero, c, beyond, time + dt) - domain.velocity(zero, c, beyond, time));
    });
  next.velocity = combine(domain, {{1.0, &u}, {1.0, &change}});
  next.pressure = project(domain, next.velocity, dt);
  const std::vector<double> laplacian = divergence(domain, pressure_gradient(domain, next.pressure));
  domain.for_each_cell([&](const GridIndex& cell) {
    const std::size_t i = domain.cell_at(cell);
    next.pressure[i] += state.pressure[i];
    if (!is_beside_outflow(domain, cell)) next.pressure[i] -= 0.5 * nu * dt * laplacian[i];
  });
  return next;
}

FlowState runge_kutta_step(const FlowDomain& domain, const FlowState& state, double time, double dt) {
  /// Stage: result = S + a (U - S) + b dt L(S), with b = 1 - a, an approximation at the time fraction `end`;
  /// S at the fraction `begin`. A uniform state stays bit for bit.
  struct Stage {
    double a, b, begin, end;
  };
  FlowState next;
  next.last_dt = dt;
  StaggeredField s = state.velocity;
  for (const Stage& stage :
       {Stage{0.0, 1.0, 0.0, 1.0}, Stage{0.75, 0.25, 1.0, 0.5}, Stage{1.0 / 3.0, 2.0 / 3.0, 0.5, 1.0}}) {
    const StaggeredField rate = momentum_rate(domain, s, time + stage.begin * dt);
    const StaggeredField behind = combine(domain, {{1.0, &state.velocity}, {-1.0, &s}});
    s = combine(domain, {{1.0, &s}, {stage.a, &behind}, {stage.b * dt, &rate}});
    s = with_side_velocity(domain, s, time + stage.end * dt);
    next.pressure = project(domain, s, stage.b * dt);
  }
  next.velocity = s;
  return next;
}

}  // namespace drogue::reference
