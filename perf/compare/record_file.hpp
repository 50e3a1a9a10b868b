#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace drogue::perf {

/// Measurement of one case by one run of the program: a line of a file of records.
struct MeasuredCase {
  std::string name, unit;
  std::vector<double>
      samples;  ///< s per unit of work, in the order of measurement; empty for computed values
  std::optional<double> error;  ///< none if it is not finite
  bool passed = false;
  nlohmann::json facts, provenance;  ///< objects, possibly empty
  nlohmann::json clocks;             ///< of the GPU, null without one
  bool cold_caches = false;          ///< before each work
  nlohmann::json document;           ///< all of the line
  std::string place;                 ///< FILE:LINE

  /// Entry of the provenance as text, empty if absent. Does not throw.
  [[nodiscard]] std::string origin(const std::string& key) const;
};

/// Records of a file in the order of its lines; empty lines are skipped. Throws Failure: usage for a missing
/// file or a folder, io_error for an unreadable file, invalid_scene with FILE:LINE for a file without
/// records, a line that is no record of schema drogue.perf/1, or a sample that is not a positive finite time.
std::vector<MeasuredCase> read_records(const std::string& file);

}  // namespace drogue::perf
