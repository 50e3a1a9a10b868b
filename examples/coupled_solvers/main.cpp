#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/fabric/fabric_solver.hpp"
#include "kernels/flow/face_views.hpp"
#include "kernels/flow/flow_solver.hpp"
#include "kernels/mesh/generators.hpp"

// coupled_solvers [BACKEND [STEPS]]: a porous sheet of cloth drifts in a periodic duct of air. Its drag per
// area is alpha w, with w the velocity of the sheet relative to the air, so that w = w0 exp(-t / tau), where
// 1 / tau = alpha (1 / sheet density + 1 / (air density times length)). No step copies to the host or waits
// for it.
using namespace drogue;

constexpr int n = 8, length = 4;  // cells across the duct, 1 m wide; length of the duct, m
constexpr double h = 1.0 / n;
constexpr double sheet_density = 1.0, air_density = 1.2;           // kg/m^2, kg/m^3
constexpr double alpha = 2.0, start_speed = 1.0, end_time = 0.32;  // Pa s/m, of the sheet in m/s, s

/// Kicks vertex i of the cloth by the drag of a step, and keeps the opposite force for the air, N.
template <class ExecutionSpace>
struct PorousDragFunctor {
  fabric::PointsView<ExecutionSpace> velocity, air;  ///< of the cloth and of the air beside it, m/s
  fabric::PointsView<ExecutionSpace> force_on_air;   ///< N
  double drag;                                       ///< of a vertex, N s/m
  double dt_over_mass;                               ///< s/kg

  KOKKOS_FUNCTION void operator()(const int i) const {
    for (int c = 0; c < 3; ++c) {
      const double force = drag * (velocity(i, c) - air(i, c));
      velocity(i, c) -= dt_over_mass * force;
      force_on_air(i, c) = force;
    }
  }
};

/// One vertex for each column of cells: the delta function spreads their equal forces uniformly.
fabric::Parameters cloth(double dt) {
  fabric::Parameters p;
  p.mesh = mesh::rectangle(1.0 - h, 1.0 - h, n - 1, n - 1);
  for (mesh::Vector& x : p.mesh.rest) x = {x[0] + 0.5 * h, x[1] + 0.5 * h, 1.0};
  p.mass.assign(p.mesh.rest.size(), sheet_density * h * h);
  p.material.membrane_modulus = 20.0;  // N/m: soft enough for the steps of the flow
  p.dt = dt;
  return p;
}

flow::Parameters air(double dt) {
  flow::Parameters p;
  p.cells = {n, n, n * length};
  p.high = {1.0, 1.0, length};
  p.density = air_density;
  p.external_force = true;
  p.fixed_dt = dt;
  return p;
}

template <class ExecutionSpace>
int run(int steps) {
  const double dt = end_time / steps;
  const device::Instance<ExecutionSpace> instance(8);
  const ExecutionSpace& space = instance.space();
  flow::FlowSolver<ExecutionSpace> flow(instance, air(dt));
  fabric::FabricSolver<ExecutionSpace> fabric(instance, cloth(dt));
  const int vertices = fabric.vertices();
  const coupling::GridTransfer<ExecutionSpace> transfer(space, flow::coupling_grid(flow.grid()),
                                                        coupling::DeltaFunction::cbs43, vertices);
  const fabric::PointsView<ExecutionSpace> beside("example::air", n * n);
  const fabric::PointsView<ExecutionSpace> force("example::force_on_air", n * n);
  const auto [positions, velocities] = fabric.state();
  // Where the flow keeps its velocity and takes forces per volume.
  const auto air_velocity = flow::face_views<ExecutionSpace>(flow.grid(), flow.velocity());
  const auto air_force = flow::face_views<ExecutionSpace>(flow.grid(), flow.force());

  flow.start();
  std::vector<mesh::Vector> x = cloth(dt).mesh.rest, v(x.size(), {0.0, 0.0, start_speed});
  fabric.upload(x, v);
  flow.enqueue_begin(2.0 * end_time);
  for (int step = 0; step < steps; ++step) {
    coupling::clear_spread(space, transfer, air_force);
    coupling::freeze_positions(space, transfer, positions, velocities, 0.5 * dt);
    coupling::interpolate(space, transfer, air_velocity, beside);
    device::launch_each(space, "example::porous_drag", vertices,
                        PorousDragFunctor<ExecutionSpace>{velocities, beside, force, alpha * h * h,
                                                          dt / (sheet_density * h * h)});
    fabric.enqueue_steps(1);
    coupling::spread(space, transfer, force, air_force);
    flow.enqueue_step();
  }
  flow.enqueue_end();

  if (flow.condition().has_failed || fabric.failure()) return 4;
  fabric.download(x, v);
  const double air_mass = air_density * length, sheet = v[0][2], momentum = sheet_density * start_speed;
  const double of_air = flow.totals().momentum[2], w = sheet - of_air / air_mass;
  const double exact = start_speed * std::exp(-end_time * alpha * (1.0 / sheet_density + 1.0 / air_mass));
  std::printf("sheet %.9f m/s, relative to the air %.9f m/s, exact %.9f m/s\n", sheet, w, exact);
  std::printf("momentum %.15f of %.15f N s\n", sheet_density * sheet + of_air, momentum);
  return 0;
}

int main(int argc, char** argv) try {
  const device::Backend backend = device::wanted_backend(argc > 1 ? argv[1] : "auto");
  if (const auto why = device::why_unavailable(backend))
    return std::fprintf(stderr, "%s\n", why->c_str()), 77;
  const device::Runtime runtime({});
  const int steps = argc > 2 ? std::stoi(argv[2]) : 64;
  return device::dispatch(backend, [=]<class ExecutionSpace>() { return run<ExecutionSpace>(steps); });
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\nusage: coupled_solvers [BACKEND [STEPS]]\n", error.what()), 2;
}
