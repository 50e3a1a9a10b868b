#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/gas/tile/team_shape.hpp"
#include "perf/measure/measurement.hpp"
#include "perf/measure/record.hpp"
#include "perf/models/occupancy.hpp"
#include "perf/problems/inflation.hpp"
#include "perf/problems/puts.hpp"
#include "perf/problems/sod.hpp"
#include "perf/problems/streams.hpp"
#include "perf/profile/kernel_profile.hpp"
#include "perf/rows/rows.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {

namespace {

/// Kernel with a block size that parameters select, and the work in which it is timed.
struct BlockForm {
  std::string records;  ///< first part of the names of its cases: "gas-block"
  std::string name;     ///< second part after the backend: "seed"
  std::string title;    ///< of its table
  std::string unit;     ///< of the times: "step"
  std::string kernel;   ///< label in a profile: "drogue::gas::StepFunctor"
  std::vector<int> blocks;
  std::vector<std::int64_t> cells;  ///< of the meshes, or options
  /// Case of a mesh, the index of its number of cells, and a block.
  std::function<Case(const std::string& case_name, std::size_t mesh, int block)> make;
  /// Block with the registers that the launch bounds allow, or a launch of the largest block.
  std::function<Block(int block)> resources;
  int most_blocks = 0;  ///< on a multiprocessor, by the launch; 0: as many as fit
};

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
  return sod::baseline_case(name, blocks_bound, backend, gas_parameters(cells, block), true);
}

Case fused_case(device::Backend backend, const std::string& name, std::int64_t cells, int block) {
  constexpr long steps = 200;  // some milliseconds
  const gas::Parameters p = gas_parameters(cells, block);
  return {.name = name,
          .backend = backend,
          .unit_of_work = "step",
          .bound = blocks_bound,
          .tolerance = sod::tolerance(p),
          .prepare = [=] { return sod::steps(p, backend, gas::create_solver(backend, p), steps); }};
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
             return Case{.name = name,
                         .backend = backend,
                         .unit_of_work = "step",
                         .bound = blocks_bound,
                         .tolerance = streams::divergence_tolerance,
                         .prepare = [=, steps = meshes[mesh].steps] {
                           return streams::steps(p, flow::create_solver(backend, p), steps);
                         }};
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
             return Case{.name = name,
                         .backend = backend,
                         .unit_of_work = "ms of flight",
                         .bound = blocks_bound,
                         .tolerance = inflation::largest_imbalance,
                         .prepare = [=] {
                           inflation::Problem problem =
                               inflation::problem({.cells = grid, .with_contact = true});
                           problem.parameters.fabric.contact.block = block;
                           return inflation::flight(backend, problem, lead, 10);
                         }};
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

/// Kernels of `app` with a block size: of gas, options, flow and parachute. Springs have none.
std::vector<BlockForm> block_forms(const std::string& app, device::Backend backend, bool quick) {
  if (app == "gas") return gas_forms(backend, quick);
  if (app == "flow") return flow_forms(backend, quick);
  if (app == "options") return options_forms(backend, quick);
  if (app == "parachute") return parachute_forms(backend, quick);
  return {};
}

/// Fewer rounds than elsewhere: a sweep has a hundred cases.
constexpr int sweep_rounds = 11;

/// Registers per thread of the kernel of a form in a profile: the most of its variants that were launched
/// with `block`, or of all that the launch allows; without any, those that it allows.
int registers_of(const std::vector<KernelProfile>& profile, const BlockForm& form, const Block& block) {
  int of_block = 0, of_all = 0;
  for (const KernelProfile& kernel : profile) {
    if (kernel.kernel != form.kernel || kernel.registers > block.registers) continue;
    of_all = std::max(of_all, kernel.registers);
    if (kernel.threads == block.threads) of_block = std::max(of_block, kernel.registers);
  }
  return of_block > 0 ? of_block : of_all > 0 ? of_all : block.registers;
}

/// Origin of the registers without a profile; the kernel of options is launched without bounds.
const char* registers_source(const std::string& app) {
  return app == "options" ? "the limit of a launch without bounds" : "launch bounds";
}

/// Block with its occupancy.
struct Predicted {
  Block block;
  Occupancy occupancy;
};

/// Predictions for all blocks of a form.
std::vector<Predicted> predictions(const Architecture& on, const BlockForm& form,
                                   const std::vector<KernelProfile>& profile) {
  std::vector<Predicted> list;
  for (const int threads : form.blocks) {
    Block block = form.resources(threads);
    block.registers = registers_of(profile, form, block);
    Occupancy o = occupancy(on, block);
    if (form.most_blocks > 0 && o.blocks > form.most_blocks) {
      o.blocks = form.most_blocks;
      o.threads = o.blocks * threads;
      o.occupancy = static_cast<double>(o.threads) / on.threads;
    }
    list.push_back({block, o});
  }
  return list;
}

/// Prints the records of one form, mesh by mesh; `record` is the first.
void print_form(const BlockForm& form, const std::vector<Predicted>& predicted, const Record* record) {
  std::printf("\n%s, microseconds per %s (median); cells down, threads of a block across\n%10s",
              form.title.c_str(), form.unit.c_str(), "");
  for (const int block : form.blocks) std::printf("%12d", block);
  std::printf("\n%10s", "registers");
  for (const Predicted& p : predicted) std::printf("%12d", p.block.registers);
  std::printf("\n%10s", "blocks");
  for (const Predicted& p : predicted) std::printf("%12d", p.occupancy.blocks);
  std::printf("\n%10s", "occupancy");
  for (const Predicted& p : predicted) std::printf("%10.1f %%", 100.0 * p.occupancy.occupancy);
  std::vector<double> occupancies;
  for (const Predicted& p : predicted) occupancies.push_back(p.occupancy.occupancy);
  for (const std::int64_t cells : form.cells) {
    std::vector<const Record*> row;
    for (std::size_t k = 0; k < form.blocks.size(); ++k) row.push_back(record++);
    std::printf("\n%s", block_row(cells, row, occupancies).c_str());
  }
  std::printf("\n");
}

nlohmann::json facts_of(device::Backend backend, const BlockForm& form, std::int64_t cells,
                        const Predicted& p) {
  return {{"backend", device::name(backend)}, {"form", form.name},
          {"block", p.block.threads},         {"cells", cells},
          {"registers", p.block.registers},   {"shared_bytes", p.block.shared_bytes},
          {"blocks", p.occupancy.blocks},     {"occupancy", p.occupancy.occupancy}};
}

}  // namespace

Table print_block_sizes(const std::string& app, device::Backend backend, bool quick,
                        const std::string& capability, const std::string& profile,
                        const nlohmann::json& provenance) {
  const std::vector<KernelProfile> profiled =
      profile.empty() ? std::vector<KernelProfile>{} : read_profiles(profile);
  const Architecture* known = find_architecture(capability);
  const Architecture on = known != nullptr ? *known : hopper();
  const std::vector<BlockForm> forms = block_forms(app, backend, quick);
  std::vector<Case> cases;
  std::vector<nlohmann::json> facts;
  std::vector<std::vector<Predicted>> predicted;
  for (const BlockForm& form : forms) {
    predicted.push_back(predictions(on, form, profiled));
    for (std::size_t mesh = 0; mesh < form.cells.size(); ++mesh)
      for (const Predicted& p : predicted.back()) {
        cases.push_back(form.make(form.records + "/" + std::string(device::name(backend)) + "/" + form.name +
                                      "/" + std::to_string(p.block.threads) + "/" +
                                      std::to_string(form.cells[mesh]),
                                  mesh, p.block.threads));
        facts.push_back(facts_of(backend, form, form.cells[mesh], p));
      }
  }
  const std::vector<Record> records =
      measure(cases, warm_up_rounds, std::min(sweep_rounds, kept_rounds(quick)), {&device_clocks()});
  Table table;
  for (std::size_t i = 0; i < records.size(); ++i) table.add(records[i], provenance, facts[i]);
  std::printf(
      "%s on %s: times beside the occupancy that the model predicts for %s, registers by %s;\n"
      "FAILED: the result failed its check and has no time; rho: rank correlation of occupancy and speed, p: "
      "the\n"
      "probability of one at least as large by chance, 0.05 or less where occupancy explains the order\n",
      app == "gas" ? "Figure 4.4" : "Block sizes", std::string(device::name(backend)).c_str(), on.name.data(),
      profile.empty() ? registers_source(app) : profile.c_str());
  const Record* first = records.data();
  for (std::size_t k = 0; k < forms.size(); ++k) {
    print_form(forms[k], predicted[k], first);
    first += forms[k].cells.size() * forms[k].blocks.size();
  }
  return table;
}

}  // namespace drogue::perf
