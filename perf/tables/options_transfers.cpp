#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/dissertation.hpp"
#include "perf/puts.hpp"
#include "perf/record.hpp"
#include "perf/tables/tables.hpp"

namespace drogue::perf {
namespace {

/// A line of a table: the dissertation's scheme with as many steps as intervals, or ours with a fourth of
/// them, solved on two grids for its error.
struct OptionsLine {
  dissertation::OptionsRow printed;
  options::Method method;
};

/// A put of the largest meshes takes seconds, and their scheme's steps rise with the mesh.
constexpr int rounds_kept = 5, rounds_to_warm_up = 1;
/// The seed scheme's own choices (docs/options.md) cost accuracy at mesh 128.
constexpr double seed_tolerance = 2e-3;

std::vector<OptionsLine> options_lines(bool quick) {
  std::vector<OptionsLine> lines;
  const auto add = [&](const dissertation::OptionsRow& row) {
    if (quick && (row.mesh > 128 || row.options > 64)) return;
    for (const auto method : {options::Method::baseline, options::Method::pide})
      lines.push_back({row, method});
  };
  for (const auto& row : dissertation::table_5_7) add(row);
  for (const auto& row : dissertation::table_5_8) add(row);
  return lines;
}

const char* word(options::Method method) { return method == options::Method::baseline ? "seed" : "pide"; }

Case case_of(device::Backend backend, const OptionsLine& line) {
  const std::string name = "options-transfers/" + std::string(device::name(backend)) + "/" +
                           word(line.method) + "/" + std::to_string(line.printed.options) + "/" +
                           std::to_string(line.printed.mesh);
  return puts::batch(name, backend, static_cast<std::size_t>(line.printed.options),
                     {.method = line.method, .mesh = line.printed.mesh, .time_copies = true},
                     line.method == options::Method::baseline ? seed_tolerance : puts::tolerance);
}

nlohmann::json facts_of(device::Backend backend, const OptionsLine& line, const Record& record) {
  nlohmann::json thesis = {{"h2d_us", line.printed.h2d},
                           {"compute_us", line.printed.compute},
                           {"d2h_us", line.printed.d2h},
                           {"total_us", line.printed.total}};
  if (line.printed.cpu > 0.0) thesis["cpu_us"] = line.printed.cpu;
  return {{"backend", device::name(backend)},
          {"cells", line.printed.options},
          {"mesh", line.printed.mesh},
          {"method", word(line.method)},
          {"h2d_s", run::median(record.parts.at("h2d"))},
          {"compute_s", run::median(record.parts.at("compute"))},
          {"d2h_s", run::median(record.parts.at("d2h"))},
          {"thesis", thesis}};
}

}  // namespace

Table print_options_transfers(device::Backend backend, bool quick, const nlohmann::json& provenance) {
  const std::vector<OptionsLine> lines = options_lines(quick);
  std::vector<Case> cases;
  for (const OptionsLine& line : lines) cases.push_back(case_of(backend, line));
  const std::vector<Record> records = measure(cases, rounds_to_warm_up, rounds_kept);
  std::printf(
      "Tables 5.7 and 5.8: American puts on %s, microseconds from host to host; in brackets the "
      "dissertation's\nQuadro 6000, whose first copy holds the start of CUDA. seed is its scheme, pide ours, "
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
                printed.options, printed.mesh, word(lines[i].method), part("h2d"), printed.h2d,
                part("compute"), printed.compute, part("d2h"), printed.d2h, 1e6 * run::median(record.samples),
                printed.total, record.error, verdict(record));
    table.add(record, provenance, facts_of(backend, lines[i], record));
  }
  return table;
}

}  // namespace drogue::perf
