#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "common/csv/fields.hpp"
#include "common/csv/header.hpp"
#include "common/csv/line_reader.hpp"
#include "common/csv/numbers.hpp"
#include "common/program/failure.hpp"
#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {

namespace {

constexpr std::string_view ours = "drogue::";

/// The qualified name at `begin`, up to template arguments or parameters.
std::string_view qualified_name(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_' || text[end] == ':'))
    ++end;
  return text.substr(begin, end - begin);
}

}  // namespace

std::string kernel_label(std::string_view demangled) {
  for (std::size_t at = demangled.find(ours); at != std::string_view::npos;
       at = demangled.find(ours, at + ours.size())) {
    const std::string_view name = qualified_name(demangled, at);
    // The kernel of a cooperative launch has the functor as its template argument.
    if (name != "drogue::device::persistent_kernel") return std::string(name);
  }
  const std::string_view head = demangled.substr(0, demangled.find_first_of("<("));
  const std::size_t blank = head.rfind(' ');
  return std::string(blank == std::string_view::npos ? head : head.substr(blank + 1));
}

namespace {

constexpr const char* remedy = "; drogue-perf ncu CASE prints the command that makes such a file";

/// A table of `ncu --csv --page raw`: names of columns, then their units, then a kernel per line.
struct RawTable {
  std::vector<std::string> columns, units;
};

/// A line of a table with its place, for messages.
class Row {
 public:
  Row(const std::filesystem::path& file, std::int64_t line, const RawTable& table, const csv::Fields& fields)
      : _file(file), _line(line), _table(table), _fields(fields) {}

  [[nodiscard]] Failure wrong(const std::string& sentence) const {
    return csv::invalid_at(_file, _line, sentence);
  }
  [[nodiscard]] std::string place() const { return _file.string() + ":" + std::to_string(_line); }

  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const {
    const auto found = std::ranges::find(_table.columns, name);
    if (found == _table.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - _table.columns.begin());
  }
  [[nodiscard]] std::string text(std::string_view name) const {
    const auto at = column(name);
    if (!at) throw wrong("the table has no column '" + std::string(name) + "'" + remedy);
    return std::string(_fields[*at]);
  }

  /// Number of a column; none if the column is absent or the metric was not collected.
  [[nodiscard]] std::optional<double> number_if_present(std::string_view name) const {
    const auto at = column(name);
    if (!at) return std::nullopt;
    std::string digits(_fields[*at]);
    std::erase(digits, ',');  // of thousands
    if (digits.empty() || digits.find("n/a") != std::string::npos || digits.find("nan") != std::string::npos)
      return std::nullopt;
    double value = 0.0;
    if (csv::parse_number(digits, value) != csv::NumberError::none)
      throw wrong(csv::shown(_fields[*at]) + " of column '" + std::string(name) + "' is no number");
    return value;
  }

  /// Whole number of a column that must be there.
  [[nodiscard]] int whole(std::string_view name) const {
    const auto value = number_if_present(name);
    if (!value) throw wrong("column '" + std::string(name) + "' is absent or has no number" + remedy);
    if (*value < 0.0 || *value > std::numeric_limits<int>::max() || *value != std::floor(*value))
      throw wrong("column '" + std::string(name) + "' is no whole number");
    return static_cast<int>(*value);
  }

  /// Bytes of a column. Larger units are rounded to two decimals.
  [[nodiscard]] int bytes(std::string_view name) const {
    if (const auto at = column(name); at && *at < _table.units.size()) {
      const std::string& unit = _table.units[*at];
      if (!unit.empty() && !unit.starts_with("byte"))
        throw wrong("column '" + std::string(name) + "' is in " + csv::shown(unit) +
                    ", which is rounded: give ncu --print-units base");
    }
    return whole(name);
  }

 private:
  const std::filesystem::path& _file;
  std::int64_t _line;
  const RawTable& _table;
  const csv::Fields& _fields;
};

/// "9.0", of the column or of the attributes of the device.
std::string capability_of(const Row& row) {
  if (row.column("CC")) return row.text("CC");
  return std::to_string(row.whole("device__attribute_compute_capability_major")) + "." +
         std::to_string(row.whole("device__attribute_compute_capability_minor"));
}

KernelProfile profile_of(const Row& row) {
  KernelProfile k;
  k.kernel = kernel_label(row.text("Kernel Name"));
  k.place = row.place();
  if (row.column("device__attribute_display_name")) k.device = row.text("device__attribute_display_name");
  k.capability = capability_of(row);
  k.threads = row.whole("launch__block_size");
  if (k.threads == 0) throw row.wrong("the block has no threads");
  k.registers = row.whole("launch__registers_per_thread");
  k.shared_bytes =
      row.bytes("launch__shared_mem_per_block_static") + row.bytes("launch__shared_mem_per_block_dynamic");
  if (row.number_if_present("launch__shared_mem_config_size"))
    k.carve_out = row.bytes("launch__shared_mem_config_size");
  k.by_registers = row.whole("launch__occupancy_limit_registers");
  k.by_shared_memory = row.whole("launch__occupancy_limit_shared_mem");
  k.by_threads = row.whole("launch__occupancy_limit_warps");
  k.by_limit = row.whole("launch__occupancy_limit_blocks");
  k.grid = row.number_if_present("launch__grid_size").value_or(0.0);
  k.multiprocessors =
      static_cast<int>(row.number_if_present("device__attribute_multiprocessor_count").value_or(0.0));
  k.active_fraction =
      0.01 *
      row.number_if_present("sm__warps_active.avg.pct_of_peak_sustained_active").value_or(std::nan(""));
  k.launches = 1;
  k.duration = 1e-9 * row.number_if_present("gpu__time_duration.sum").value_or(0.0);
  return k;
}

using Key = std::tuple<std::string, int, int, int, int, std::string, std::string>;
using Profiles = std::map<Key, KernelProfile>;

void merge(Profiles& into, const KernelProfile& k) {
  const auto [known, is_new] = into.try_emplace(
      {k.kernel, k.threads, k.registers, k.shared_bytes, k.carve_out, k.capability, k.device}, k);
  if (is_new) return;
  KernelProfile& sum = known->second;
  ++sum.launches;
  sum.duration += k.duration;
  if (k.grid <= sum.grid && !std::isnan(sum.active_fraction)) return;
  sum.grid = k.grid;
  sum.active_fraction = k.active_fraction;
}

void read_file(Profiles& into, const std::filesystem::path& file) {
  csv::LineReader reader(file);
  RawTable table;
  std::string said;  // by ncu, of an error
  std::int64_t kernels = 0;
  for (csv::Line line; reader.next(line);) {
    if (line.text.starts_with("==")) {
      if (line.text.starts_with("==ERROR==") && said.empty()) said = line.text;
      continue;
    }
    if (line.too_long) throw csv::invalid_at(file, line.number, "the line is longer than any of ncu");
    csv::Fields fields;
    const std::string_view fault = fields.split(line.text);
    const bool is_header = fields.size() > 1 && fields[0] == "ID";
    // The profiled program may print between the lines of ncu, but not into a table.
    if (table.columns.empty() && !is_header) continue;
    if (!fault.empty()) throw csv::invalid_at(file, line.number, std::string(fault));
    if (is_header) {
      table = {};
      for (std::size_t i = 0; i < fields.size(); ++i) table.columns.emplace_back(fields[i]);
      continue;
    }
    if (fields.size() != table.columns.size())
      throw csv::invalid_at(file, line.number,
                            "the line has " + std::to_string(fields.size()) + " fields, the table " +
                                std::to_string(table.columns.size()) + " columns; is the file truncated?");
    if (fields[0].empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) table.units.emplace_back(fields[i]);
      continue;
    }
    merge(into, profile_of(Row(file, line.number, table, fields)));
    ++kernels;
  }
  // A program that ncu ends after the last launch may return an error code, which is no fault of the profile.
  const bool is_complete = said.empty() || said.find("returned an error code") != std::string::npos;
  if (kernels > 0 && !is_complete)
    throw Failure(ExitCode::invalid_scene,
                  file.string() + ": ncu reports beside the profiled kernels: " + said);
  if (kernels > 0) return;
  throw Failure(ExitCode::invalid_scene, file.string() + ": no kernel in the layout of ncu --csv --page raw" +
                                             (said.empty() ? remedy : "; ncu reports: " + said));
}

}  // namespace

std::vector<KernelProfile> read_profiles(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    for (const auto& entry : std::filesystem::directory_iterator(path, ignored))
      if (entry.path().extension() == ".csv") files.push_back(entry.path());
    std::ranges::sort(files);
    if (files.empty())
      throw Failure(ExitCode::usage, "there is no *.csv in '" + path.string() + "'" + remedy);
  } else {
    files.push_back(path);
  }
  Profiles profiles;
  for (const std::filesystem::path& file : files) read_file(profiles, file);
  std::vector<KernelProfile> list;
  for (const auto& [key, profile] : profiles) list.push_back(profile);
  return list;
}

}  // namespace drogue::perf
