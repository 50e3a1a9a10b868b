#include "perf/benchmark/problems.hpp"

#include <array>
#include <numbers>

#include "perf/rows/printed.hpp"

namespace drogue::perf::benchmark {

namespace {

/// Values of a number by size.
template <class Number>
using BySize = std::array<Number, 3>;

template <class Number>
Number of(Size size, const BySize<Number>& values) {
  return values[static_cast<std::size_t>(size)];
}

/// Arguments of a scene with changed keys.
std::vector<std::string> scene(const std::string& name, const std::vector<std::string>& changes) {
  std::vector<std::string> words = {name};
  for (const std::string& change : changes) words.insert(words.end(), {"--set", change});
  return words;
}

/// Sod's shock tube until its waves fill 1600 cells. It is self-similar, so the steps are those of 1600 cells
/// to t = 0.4 at every size, and the error is that of 1600 cells in proportion to the width of a cell.
Problem gas_problem(Size size) {
  constexpr double error_1600 = 7.3225e-4;
  const std::int64_t cells = of<std::int64_t>(size, {12800, 1 << 20, 1 << 25});
  const double share = 1600.0 / static_cast<double>(cells), error = error_1600 * share;
  return {
      .name = "sod",
      .program = "drogue-gas",
      .extent = printed("%lld cells", static_cast<long long>(cells)),
      .items = cells,
      .arguments = scene(
          "sod", {printed("mesh.cells=%lld", static_cast<long long>(cells)),
                  printed("run.end_time=%.10g", 0.4 * share), "output={fields=[],restart_every=0}",
                  printed("verify={exact=\"riemann\",l1_density=%.4g,conservation=1e-12}", 1.02 * error)}),
      .quantity = "l1_density",
      .low = 0.98 * error,
      .high = 1.02 * error,
      .merit = "cell_steps_per_s"};
}

/// The first mode of a drum; the error of its frequency is of second order in the edges.
Problem springs_problem(Size size) {
  const std::int64_t finer = of<std::int64_t>(size, {1, 2, 8}), rings = 64 * finer,
                     vertices = 1 + 3 * rings * (rings + 1);
  const double error = 6.46e-5 / static_cast<double>(finer * finer);
  return {
      .name = "drum",
      .program = "drogue-springs",
      .extent = printed("%lld vertices", static_cast<long long>(vertices)),
      .items = vertices,
      .arguments = scene(
          "drum", {printed("mesh.disk={radius=0.4,vertices=%lld}", static_cast<long long>(vertices)),
                   "output={probes=[{at=[0,0,0]}],history_every=10,fields=[],restart_every=0}",
                   printed("verify={frequency={mode=[0,1],tolerance=%.4g},energy_drift=3e-8}", 1.1 * error)}),
      .quantity = "frequency",
      .low = 0.9 * error,
      .high = 1.1 * error,
      .merit = "vertex_steps_per_s"};
}

/// Puts whose tolerance chooses the mesh; the largest error of those with known prices is one of that mesh.
Problem options_problem(Size size) {
  const std::size_t puts = of<std::size_t>(size, {16384, 131072, 1048576});
  return {.name = "puts",
          .program = "drogue-options",
          .extent = printed("%zu options", puts),
          .items = static_cast<std::int64_t>(puts),
          .arguments = {"price", printed("puts-%zu.csv", puts), "--tolerance", "1e-5"},
          .quantity = "price",
          .low = 1.74e-6,
          .high = 2.13e-6,
          .merit = "options_per_s",
          .puts = puts};
}

/// A C-9 that opens: the deviation of its drag coefficient from the middle of published ones. The flow is
/// chaotic, so that the bound is that of the scene.
Problem parachute_problem(Size size) {
  const std::string output = "output={history_every=2,fields=[],restart_every=0}";
  const std::vector<std::string> arguments = of<std::vector<std::string>>(
      size, {scene("c9-flat", {output}),
             scene("c9-flat-full",
                   {output, "grid.spacing=0.2", "canopy[0].edge_length=0.14", "run.end_time=2",
                    "verify={history=[{column=\"canopy_0_drag_coefficient\",statistic=\"mean\",from=1.2,to=2,"
                    "value=0.775,tolerance=0.1}],divergence=1e-11,force_balance=1e-14}"}),
             scene("c9-flat-full", {output})});
  const std::int64_t cells = of<std::int64_t>(size, {257725, 1545564, 8105276});
  return {.name = "c9-flat",
          .program = "drogue-parachute",
          .extent = printed("%lld cells", static_cast<long long>(cells)),
          .items = cells,
          .arguments = arguments,
          .quantity = "canopy_0_drag_coefficient_mean",
          .high = 0.1,
          .merit = "simulated_s_per_s"};
}

}  // namespace

/// Boxes of Taylor and Green in a row along z. The energies of one are those of
/// docs/evidence/taylor-green-1600.txt, and the deviation from them is of second order in the cells.
Problem flow_problem(Size size, int ranks) {
  const int finer = of<int>(size, {1, 4, 10}), cells = 64 * finer;
  const double error = 2.066e-3 / (finer * finer);
  constexpr double length = 2.0 * std::numbers::pi;
  const auto energy = [&](double of_one) { return printed("%.10g", of_one * ranks); };
  return {.name = "taylor-green",
          .program = "drogue-parachute",
          .extent = printed("%dx%dx%d cells", cells, cells, cells * ranks),
          .items = static_cast<std::int64_t>(cells) * cells * cells * ranks,
          .arguments =
              scene("taylor-green-3d",
                    {printed("grid.cells=[%d,%d,%d]", cells, cells, cells * ranks),
                     printed("grid.domain=[[0,%.16g],[0,%.16g],[0,%.16g]]", length, length, length * ranks),
                     "run.end_time=3", "output={history_every=1,fields=[],restart_every=0}",
                     "verify={kinetic_energy_curve=[{points=[[1," + energy(30.88604) + "],[2," +
                         energy(30.73758) + "],[3," + energy(30.5161) +
                         printed("]],tolerance=%.4g}],energy_growth=0,divergence=1e-10}", 1.1 * error)}),
          .quantity = "kinetic_energy_curve_0",
          .low = 0.9 * error,
          .high = 1.1 * error,
          .merit = "cell_steps_per_s",
          .parallel = true};
}

std::vector<Problem> problems(Size size) {
  return {gas_problem(size), springs_problem(size), options_problem(size), flow_problem(size, 1),
          parachute_problem(size)};
}

}  // namespace drogue::perf::benchmark
