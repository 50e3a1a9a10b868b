#include <cstdio>
#include <memory>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/sod.hpp"
#include "perf/tables/baseline_case.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Steps of a sample of some milliseconds.
constexpr long fused_steps = 200;

Case fused_case(const std::string& name, device::Backend backend, const gas::Parameters& p) {
  const auto solver = std::make_shared<std::unique_ptr<gas::Solver>>();
  return {name,
          device::needs_device(backend),
          "step",
          "launch latency, and teams that wait for room",
          [=] {
            *solver = gas::create_solver(backend, p);
            return sod::steps(p, **solver, fused_steps);
          },
          [=] { return sod::l1_error(p, **solver); },
          sod::tolerance(p)};
}

/// Baseline solver or fused step; records name them "seed" and "step".
enum class Form { baseline, fused };
constexpr const char* name_of(Form form) { return form == Form::baseline ? "seed" : "step"; }

/// Rows and columns of the table.
struct Axes {
  std::vector<int> cells, blocks;
};

Axes axes(bool quick) {
  if (quick) return {{1024, 8192}, {32, 128, 512}};
  Axes all;
  for (const dissertation::TransferRow& row : dissertation::table_5_5) all.cells.push_back(row.cells);
  for (const int block : dissertation::figure_4_4_blocks) all.blocks.push_back(block);
  return all;
}

/// Times the flux kernel alone for the baseline solver, as in the figure, and the whole fused step otherwise.
/// The fused step runs as a graph, because the persistent driver divides the mesh by multiprocessors, not by
/// blocks.
Case case_of(device::Backend backend, Form form, int cells, int block) {
  gas::Parameters p = sod::parameters(cells);
  p.block = block;
  p.driver = gas::Driver::graph;
  const std::string name = "gas-block/" + std::string(device::name(backend)) + "/" + name_of(form) + "/" +
                           std::to_string(block) + "/" + std::to_string(cells);
  if (form == Form::fused) return fused_case(name, backend, p);
  return baseline_case(name, "launch latency, and blocks that wait for room", backend, p,
                       [](const gas::PhaseTimes& times) {
                         return std::map<std::string, double>{{"compute", times.compute}};
                       });
}

/// Prints the records of one form, mesh by mesh; `record` is the first.
void print_form(Form form, const Axes& axes, const Record* record) {
  std::printf("\n%s, microseconds per step (median); cells down, threads of a block across\n%8s",
              form == Form::baseline ? "The flux kernel of [Shi], three stages"
                                     : "The fused step, one graph per step",
              "");
  for (const int block : axes.blocks) std::printf("%10d", block);
  for (const int cells : axes.cells) {
    std::printf("\n%8d", cells);
    for (std::size_t k = 0; k < axes.blocks.size(); ++k, ++record)
      std::printf("%9.2f%c", 1e6 * run::median(record->samples), record->passed() ? ' ' : '!');
  }
  std::printf("\n");
}

}  // namespace

Table print_block_sizes(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const Axes all = axes(quick);
  std::vector<Case> cases;
  std::vector<nlohmann::json> facts;
  for (const Form form : {Form::baseline, Form::fused})
    for (const int cells : all.cells)
      for (const int block : all.blocks) {
        cases.push_back(case_of(backend, form, cells, block));
        facts.push_back({{"backend", device::name(backend)},
                         {"form", name_of(form)},
                         {"block", block},
                         {"cells", cells}});
      }
  const std::vector<Record> records = measure(cases, warm_up_rounds, kept_rounds(quick));
  Table table;
  for (std::size_t i = 0; i < records.size(); ++i) table.add(records[i], provenance, facts[i]);
  std::printf("Figure 4.4 on %s; ! marks a time whose result failed its check\n",
              std::string(device::name(backend)).c_str());
  print_form(Form::baseline, all, records.data());
  print_form(Form::fused, all, records.data() + records.size() / 2);
  return table;
}

}  // namespace drogue::perf
