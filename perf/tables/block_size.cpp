#include <algorithm>
#include <cstdio>

#include "perf/measure/device_clocks.hpp"
#include "perf/measure/record.hpp"
#include "perf/profile/kernel_profile.hpp"
#include "perf/rows/block_rows.hpp"
#include "perf/tables/block_forms.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

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
