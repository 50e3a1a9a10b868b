#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drogue::run {

/// A column of history.csv; the header reads `name [unit]`, or `name` for a pure number (empty unit).
struct Column {
  std::string name;
  std::string unit;
};

/// The first line of history.csv, with its end.
[[nodiscard]] std::string history_header(const std::vector<Column>& columns);

/// history.csv: first column `time [s]`, one row per reported step, numbers in the shortest form that reads
/// back equal. Rows reach the system once a second, at flush() and at the end, also when a failure unwinds.
class HistoryWriter {
 public:
  /// With `resume_time` rows of an existing file after that time are cut off and the rest is continued;
  /// without, a new file is begun. Throws Failure(io_error), also if the existing header is another one.
  HistoryWriter(std::filesystem::path file, const std::vector<Column>& columns,
                std::optional<double> resume_time = std::nullopt);
  ~HistoryWriter();
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;

  /// Whether rows of the existing file were kept.
  [[nodiscard]] bool continues() const { return _continues; }

  /// Appends a row; `values` has one entry per column after the time.
  void append(double time, std::span<const double> values);

  /// Hands all rows to the system; needed before a restart file that comes after them is committed.
  void flush();

  /// Flushes, syncs to disk and closes. Throws Failure(io_error).
  void finish();

 private:
  std::filesystem::path _file;
  std::size_t _width;
  bool _continues = false;
  int _descriptor = -1;
  std::string _pending;
  std::chrono::steady_clock::time_point _last_flush;
};

}  // namespace drogue::run
