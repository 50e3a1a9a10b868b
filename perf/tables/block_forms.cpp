#include "perf/tables/block_forms.hpp"

#include <array>
#include <memory>

#include "kernels/gas/tile/team_shape.hpp"
#include "perf/problems/baseline_case.hpp"
#include "perf/problems/inflation.hpp"
#include "perf/problems/puts.hpp"
#include "perf/problems/sod.hpp"
#include "perf/problems/streams.hpp"
#include "perf/tables/dissertation.hpp"

namespace drogue::perf {
namespace {

const std::vector<int> quick_blocks = {32, 128, 512}, all_blocks = {32, 64, 96, 128, 192, 256, 384, 512};

constexpr const char* blocks_bound = "launch latency, and blocks that wait for room";

/// Largest number of registers of a thread under launch bounds of 512 threads.
constexpr int bounded_registers = 128;

/// Shared memory of a team of Kokkos without scratch memory, bytes: its reduction buffer.
constexpr int team_buffer(int block) { return 8 * (block + 2); }

gas::Parameters gas_parameters(std::int64_t cells, int block) {
  gas::Parameters p = sod::parameters(cells);
  p.block = block;
  // The persistent driver divides the mesh by multiprocessors, not by blocks.
  p.driver = gas::Driver::graph;
  return p;
}

/// The flux kernel of the baseline solver alone, as in figure 4.4.
Case flux_case(device::Backend backend, const std::string& name, std::int64_t cells, int block) {
  return baseline_case(name, blocks_bound, backend, gas_parameters(cells, block),
                       [](const gas::PhaseTimes& times) {
                         return std::map<std::string, double>{{"compute", times.compute}};
                       });
}

Case fused_case(device::Backend backend, const std::string& name, std::int64_t cells, int block) {
  constexpr long steps = 200;  // some milliseconds
  const gas::Parameters p = gas_parameters(cells, block);
  const auto solver = std::make_shared<std::unique_ptr<gas::Solver>>();
  return {.name = name,
          .on_device = device::needs_device(backend),
          .unit_of_work = "step",
          .bound = blocks_bound,
          .prepare =
              [=] {
                *solver = gas::create_solver(backend, p);
                return sod::steps(p, backend, **solver, steps);
              },
          .error = [=] { return sod::l1_error(p, **solver); },
          .tolerance = sod::tolerance(p)};
}

Block flux_block(int block) {
  return {block, bounded_registers,
          gas::shared_bytes(gas::cell_rows, gas::fitting_slots(gas::cell_rows, block, block), block)};
}

Block fused_block(int block) {
  return {block, block <= gas::default_team ? 168 : bounded_registers,
          gas::shared_bytes(gas::device_rows, gas::fitting_slots(gas::device_rows, block, block), block)};
}

std::vector<BlockForm> gas_forms(device::Backend backend, bool quick) {
  std::vector<int> blocks = quick_blocks;
  std::vector<std::int64_t> cells = {1024, 8192};
  if (!quick) {
    blocks.assign(std::begin(dissertation::figure_4_4_blocks), std::end(dissertation::figure_4_4_blocks));
    cells.clear();
    for (const dissertation::TransferRow& row : dissertation::table_5_5) cells.push_back(row.cells);
  }
  const auto form = [&](const char* name, const char* title, const char* kernel, auto make, auto resources) {
    return BlockForm{.records = "gas-block",
                     .name = name,
                     .title = title,
                     .unit = "step",
                     .kernel = kernel,
                     .blocks = blocks,
                     .cells = cells,
                     .make = [=](const std::string& case_name, std::size_t mesh,
                                 int block) { return make(backend, case_name, cells[mesh], block); },
                     .resources = resources};
  };
  return {form("seed", "The flux kernel of [Shi], three stages", "drogue::gas::BaselineFluxFunctor",
               flux_case, flux_block),
          form("step", "The fused step, one graph per step", "drogue::gas::StepFunctor", fused_case,
               fused_block)};
}

using Grid = std::array<int, 3>;

std::int64_t cells_of(const Grid& grid) { return static_cast<std::int64_t>(grid[0]) * grid[1] * grid[2]; }

std::vector<BlockForm> flow_forms(device::Backend backend, bool quick) {
  struct Mesh {
    Grid grid;
    long steps;
  };
  const std::vector<Mesh> meshes = quick ? std::vector<Mesh>{{{32, 32, 32}, 100}}
                                         : std::vector<Mesh>{{{64, 64, 64}, 200}, {{128, 128, 128}, 50}};
  std::vector<std::int64_t> cells;
  for (const Mesh& mesh : meshes) cells.push_back(cells_of(mesh.grid));
  return {
      {.records = "flow-block",
       .name = "momentum",
       .title = "A step of flow; momentum stage and pressure correction have the block, transforms their own",
       .unit = "step",
       .kernel = "drogue::flow::MomentumFunctor",
       .blocks = quick ? quick_blocks : all_blocks,
       .cells = cells,
       .make =
           [=](const std::string& name, std::size_t mesh, int block) {
             flow::Parameters p = streams::parameters(meshes[mesh].grid, streams::Sides::periodic);
             p.block = block;
             const auto solver = std::make_shared<std::unique_ptr<flow::Solver>>();
             return Case{.name = name,
                         .on_device = device::needs_device(backend),
                         .unit_of_work = "step",
                         .bound = blocks_bound,
                         .prepare =
                             [=] {
                               *solver = flow::create_solver(backend, p);
                               return streams::steps(p, **solver, meshes[mesh].steps);
                             },
                         .error = [=] { return streams::relative_divergence(p, **solver); },
                         .tolerance = 1e-12};
           },
       .resources =
           [](int block) {
             return Block{block, bounded_registers, team_buffer(block)};
           }}};
}

std::vector<BlockForm> parachute_forms(device::Backend backend, bool quick) {
  const Grid grid = quick ? Grid{24, 24, 48} : Grid{60, 60, 120};
  const double lead = quick ? 0.05 : 0.8;  // s
  return {
      {.records = "parachute-block",
       .name = "contact",
       .title =
           "Flight of a canopy; the kernel that resolves contact has the block, one on each multiprocessor",
       .unit = "ms of flight",
       .kernel = "drogue::fabric::PersistentResolutionFunctor",
       .blocks = quick ? quick_blocks : all_blocks,
       .cells = {cells_of(grid)},
       .make =
           [=](const std::string& name, std::size_t /*mesh*/, int block) {
             const auto solver = std::make_shared<std::unique_ptr<coupling::Solver>>();
             const auto problem = std::make_shared<inflation::Problem>();
             return Case{.name = name,
                         .on_device = device::needs_device(backend),
                         .unit_of_work = "ms of flight",
                         .bound = blocks_bound,
                         .prepare =
                             [=] {
                               *problem = inflation::problem({.cells = grid, .with_contact = true});
                               problem->parameters.fabric.contact.block = block;
                               *solver = coupling::create_solver(backend, problem->parameters);
                               return inflation::flight(*problem, **solver, lead, 10);
                             },
                         .error = [=] { return inflation::imbalance(problem->parameters, **solver); },
                         .tolerance = 1e-12};
           },
       .resources =
           [](int block) {
             return Block{block, bounded_registers, 0};
           },
       .most_blocks = 1}};
}

std::vector<BlockForm> options_forms(device::Backend backend, bool quick) {
  const std::int64_t count = quick ? 4 : 256;
  const double loose = 1e-3;  // at 1e-4 a batch of blocks of 32 takes too long for a round of all blocks
  return {{.records = "options-block",
           .name = "cos",
           .title = "Puts by cosine series; a put has a team, tables of the host are included",
           .unit = "batch",
           .kernel = "drogue::options::PriceBermudansFunctor",
           .blocks = quick ? quick_blocks : all_blocks,
           .cells = {count},
           .make =
               [=](const std::string& name, std::size_t /*mesh*/, int block) {
                 return puts::batch(name, backend, HostMemory::pinned, static_cast<std::size_t>(count),
                                    {.method = options::Method::cos, .tolerance = loose, .block = block},
                                    puts::loose_cosine_error);
               },
           .resources =
               [](int block) {
                 // Its launch states no bounds, but one compiled kernel serves all blocks, up to the largest.
                 return Block{block, bounded_registers, team_buffer(block)};
               }}};
}

}  // namespace

std::vector<BlockForm> block_forms(const std::string& app, device::Backend backend, bool quick) {
  if (app == "gas") return gas_forms(backend, quick);
  if (app == "flow") return flow_forms(backend, quick);
  if (app == "options") return options_forms(backend, quick);
  if (app == "parachute") return parachute_forms(backend, quick);
  return {};
}

}  // namespace drogue::perf
