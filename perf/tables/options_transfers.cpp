#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/measure/record.hpp"
#include "perf/problems/puts.hpp"
#include "perf/tables/dissertation.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// Line of a table: the baseline scheme with as many steps as intervals, or the `pide` method with a fourth
/// of them, solved on two grids for its error estimate.
struct OptionsTransfer {
  dissertation::OptionsRow printed;
  options::Method method;
};

/// Fewer rounds than elsewhere: a put on the largest meshes takes seconds.
constexpr int options_rounds = 5, options_warm_up_rounds = 1;
/// Error of the baseline scheme at mesh 128, relative to the strike (docs/options.md).
constexpr double baseline_tolerance = 4.4e-4;

std::vector<OptionsTransfer> options_transfers_of(bool quick) {
  std::vector<OptionsTransfer> lines;
  const auto add = [&](const dissertation::OptionsRow& row) {
    if (quick && (row.mesh > 128 || row.options > 64)) return;
    for (const auto method : {options::Method::baseline, options::Method::pide})
      lines.push_back({row, method});
  };
  for (const auto& row : dissertation::table_5_7) add(row);
  for (const auto& row : dissertation::table_5_8) add(row);
  return lines;
}

const char* method_name(options::Method method) {
  return method == options::Method::baseline ? "seed" : "pide";
}

Case case_of(device::Backend backend, const OptionsTransfer& line) {
  const std::string name = "options-transfers/" + std::string(device::name(backend)) + "/" +
                           method_name(line.method) + "/" + std::to_string(line.printed.options) + "/" +
                           std::to_string(line.printed.mesh);
  return puts::batch(
      name, backend, static_cast<std::size_t>(line.printed.options),
      {.method = line.method, .mesh = line.printed.mesh, .time_copies = true},
      line.method == options::Method::baseline ? baseline_tolerance : puts::tolerance(line.printed.mesh));
}

nlohmann::json facts_of(device::Backend backend, const OptionsTransfer& line, const Record& record) {
  nlohmann::json thesis = {{"h2d_us", line.printed.h2d},
                           {"compute_us", line.printed.compute},
                           {"d2h_us", line.printed.d2h},
                           {"total_us", line.printed.total}};
  if (line.printed.cpu > 0.0) thesis["cpu_us"] = line.printed.cpu;
  return {{"backend", device::name(backend)},
          {"cells", line.printed.options},
          {"mesh", line.printed.mesh},
          {"method", method_name(line.method)},
          {"h2d_s", run::median(record.parts.at("h2d"))},
          {"compute_s", run::median(record.parts.at("compute"))},
          {"d2h_s", run::median(record.parts.at("d2h"))},
          {"thesis", thesis}};
}

}  // namespace

Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<OptionsTransfer> lines = options_transfers_of(quick);
  std::vector<Case> cases;
  for (const OptionsTransfer& line : lines) cases.push_back(case_of(backend, line));
  const std::vector<Record> records = measure(cases, options_warm_up_rounds, options_rounds);
  std::printf(
      "Tables 5.7 and 5.8: American puts on %s, microseconds from host to host; in brackets [Shi], "
      "on a\nQuadro 6000, whose first copy holds the start of CUDA. Method seed is its scheme, "
      "pide ours, "
      "two solves for a stated error\n"
      "options  mesh  scheme  H2D               compute                 D2H              total               "
      "   error\n",
      std::string(device::name(backend)).c_str());
  Table table;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Record& record = records[i];
    const dissertation::OptionsRow& printed = lines[i].printed;
    const auto part = [&](const char* name) { return 1e6 * run::median(record.parts.at(name)); };
    std::printf("%7d  %4d  %s    %7.1f (%6.0f)  %10.1f (%8.0f)  %7.1f (%4.0f)  %10.1f (%8.0f)  %.2g  %s\n",
                printed.options, printed.mesh, method_name(lines[i].method), part("h2d"), printed.h2d,
                part("compute"), printed.compute, part("d2h"), printed.d2h, 1e6 * run::median(record.samples),
                printed.total, record.error, verdict(record));
    table.add(record, provenance, facts_of(backend, lines[i], record));
  }
  return table;
}

}  // namespace drogue::perf
