#include "miniapps/parachute/scene/run_size.hpp"

#include <algorithm>
#include <cmath>

#include "common/scene/node.hpp"
#include "kernels/flow/axis_lines.hpp"
#include "kernels/flow/diffusive_step.hpp"
#include "miniapps/parachute/canopy/stiffness.hpp"
#include "miniapps/parachute/scene/exchange.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using scene::rough_text, scene::sentence;

/// Cells of an array with ghost cells (`flow::make_grid`).
double cells_with_ghosts(const flow::Parameters& p) {
  constexpr int ghosts = 6;
  double cells = 1.0;
  for (const int n : p.cells) cells *= n > 1 ? n + ghosts : 1;
  return cells;
}

/// Numbers of the arrays of `flow::make_fields`, of the direct solver of the pressure, of the sums of the
/// coupling and of the two snapshots of an output.
double numbers_of(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const double cells = scene.cells(), on_faces = 3.0 * cells_with_ghosts(p);
  const bool has_model = p.turbulence != flow::Turbulence::none,
             is_implicit = p.diffusion == flow::Diffusion::crank_nicolson;
  double numbers = on_faces * (3.0 + (scene.has_sheets() ? 1.0 : 0.0) + (has_model ? 1.0 : 0.0)) +
                   cells * (3.0 + (has_model ? 1.0 : 0.0) + (is_implicit ? 2.0 : 0.0));
  for (const int n : p.cells) numbers += static_cast<double>(n) * n;  // eigenvectors
  if (scene.has_sheets()) {
    const flow::Core box = flow::force_box(p);
    numbers += 3.0 * box.cells[0] * box.cells[1] * box.cells[2];
  }
  for (const std::string& field : scene.output.fields)
    if (!is_canopy_field(field))
      numbers += 2.0 * cells * (field == "velocity" || field == "vorticity" ? 3 : 1);
  return numbers;
}

/// Speed that limits steps over that of the start. Of six canopies, held and falling, it was 2 to 3, of which
/// the air beside an edge has 1.8.
double speed_ratio(const FlowScene& scene) {
  return std::ranges::any_of(scene.canopies, &Canopy::has_lines) ? 2.5 : 1.0;
}

/// Largest speed along gravity, m/s, at which a canopy descends in the end with a drag coefficient of 0.75; 0
/// without one.
double descent_speed(const FlowScene& scene) {
  double speed = 0.0;
  for (std::size_t i = 0; i < scene.canopies.size(); ++i) {
    if (!scene.descends(i)) continue;
    double area = 0.0;
    for (std::size_t k = 0; k < scene.canopies.size(); ++k)
      if (scene.owner_of(k) == scene.owner_of(i)) area += scene.canopies[k].nominal_area();
    const auto [x, y, z] = scene.gravity;
    speed = std::max(speed, std::sqrt(2.0 * scene.canopies[scene.owner_of(i)].payload.mass *
                                      std::hypot(x, y, z) / (0.75 * scene.parameters.density * area)));
  }
  return speed;
}

/// Time of a step on a machine, s, of which the parts are measured.
struct StepTime {
  double cell;            ///< of a cell in a step of AB2 with explicit diffusion
  double stretched_cell;  ///< the same with products with matrices, of a stretched grid
  double cloth_step;      ///< of a step of the cloth
  double vertex;          ///< of a vertex in a step of the cloth
};

/// Time of a run, s.
double time_of(const FlowScene& scene, const RunSize& size, const StepTime& of) {
  const flow::Parameters& p = scene.parameters;
  const double cell = scene.has_stretched_axes() ? of.stretched_cell : of.cell;
  double stages = p.time_scheme == flow::TimeScheme::rk3 ? 2.8 : 1.0;
  if (p.diffusion == flow::Diffusion::crank_nicolson) stages *= 3.0;
  if (p.turbulence != flow::Turbulence::none) stages *= 2.0;
  double vertices = 0.0;
  for (const Canopy& canopy : scene.canopies) vertices += static_cast<double>(canopy.vertices());
  return size.steps *
         (size.cells * stages * cell + size.cloth_steps * (of.cloth_step + vertices * of.vertex));
}

}  // namespace

double step_length(const FlowScene& scene, double times_as_fast) {
  const flow::Parameters& p = scene.parameters;
  if (p.fixed_dt > 0.0) return p.fixed_dt;
  double rate = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<double> speed = constant_value(scene.initial_velocity()[axis]);
    if (!speed) return 0.0;
    rate += times_as_fast * std::abs(*speed) / core_width(p, axis);
  }
  double dt = flow::largest_diffusive_dt(p);
  if (p.max_dt > 0.0) dt = std::min(dt, p.max_dt);
  if (rate > 0.0) dt = std::min(dt, scene.cfl() / rate);
  return std::isfinite(dt) ? dt : 0.0;
}

RunSize run_size(const FlowScene& scene) {
  RunSize size{scene.cells(), sizeof(double) * numbers_of(scene)};
  double dt = step_length(scene, speed_ratio(scene));
  if (dt == 0.0) dt = scene.parameters.max_dt;
  if (dt == 0.0) return size;
  if (const double speed = speed_ratio(scene) * descent_speed(scene);
      speed > 0.0 && !(scene.parameters.fixed_dt > 0.0))
    dt = std::min(dt, scene.cfl() * core_width(scene.parameters, 2) / speed);
  size.steps = std::ceil(scene.end_time / dt);
  for (const Canopy& canopy : scene.canopies)
    size.cloth_steps =
        std::max(size.cloth_steps, std::ceil(stiffest_part(canopy, make_canopy(canopy)).frequency * dt));
  return size;
}

std::string duration_text(double seconds) {
  if (seconds < 90.0) return rough_text(std::ceil(seconds)) + " s";
  if (seconds < 5400.0) return rough_text(std::ceil(seconds / 60.0)) + " min";
  return rough_text(std::ceil(seconds / 3600.0)) + " h";
}

RunTime run_time(const FlowScene& scene) {
  // `drogue-perf run --filter '^flow-step'`, 60 x 60 x 120 tunnel (docs/flow-notebook.md), and c9-duct.
  constexpr StepTime two_cores{44e-9, 120e-9, 10e-6, 80e-9}, h200{0.33e-9, 0.4e-9, 25e-6, 0.0};
  const RunSize size = run_size(scene);
  return {time_of(scene, size, two_cores), time_of(scene, size, h200)};
}

std::string run_size_report(const FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  const RunSize size = run_size(scene);
  std::string text = sentence("grid         ", p.cells[0], " x ", p.cells[1], " x ", p.cells[2], " cells, ",
                              static_cast<std::int64_t>(size.cells), " in all");
  const flow::Core core = flow::core_of(p);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!flow::is_stretched(p, axis)) continue;
    double widest = 0.0;
    for (int i = 0; i < p.cells[axis]; ++i) widest = std::max(widest, flow::cell_width(p, axis, i));
    text += sentence("\n             along ", axis_names[axis], " a core of ", core.cells[axis], " of ",
                     rough_text(core.spacing[axis]), " m, others up to ", rough_text(widest), " m");
  }
  if (scene.has_sheets() && scene.coupling.method != coupling::CouplingMethod::sharp)
    text += sentence("\ncoupling     edge_inset = ", rough_text(edge_inset(scene)),
                     ", leak_filter = ", rough_text(leak_filter(scene)), ", filter = ", filter_text(scene));
  text += sentence("\nmemory       ", rough_text(size.bytes / 1048576.0), " MiB for its arrays\n");
  if (size.steps == 0.0) return text + "time         not known: it depends on the speed of the fluid\n";
  const RunTime time = run_time(scene);
  const double ratio = speed_ratio(scene);
  return text + sentence("time         about ", duration_text(time.two_cores), " on two cores, ",
                         duration_text(time.h200), " on one H200, an estimate: ", rough_text(size.steps),
                         " steps at ", ratio > 1.0 ? rough_text(ratio) + " times " : "",
                         descent_speed(scene) > 0.0 ? "the speed of the start or the descent"
                                                    : "the speed of the start",
                         size.cloth_steps > 0.0
                             ? sentence(", each with ", rough_text(size.cloth_steps), " of the cloth")
                             : std::string(),
                         "\n");
}

}  // namespace drogue::parachute_app
