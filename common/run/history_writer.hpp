#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace drogue::run {

/// Column of history.csv. The header reads `name [unit]`, or `name` for an empty unit.
struct Column {
  std::string name;
  std::string unit;
};

/// Header line of history.csv, including its line end.
[[nodiscard]] std::string history_header(const std::vector<Column>& columns);

/// Throws `Failure` (io_error) if `file` must not be written or has a header that is not that of `columns`,
/// so that a run cannot continue it. An absent file may be, and an empty one has none.
void require_same_columns(const std::filesystem::path& file, const std::vector<Column>& columns);

/// Writes history.csv: first column `time [s]`, one row per reported step, numbers in the shortest form that
/// reads back equal. Rows reach the operating system once per second, at flush() and at destruction.
class HistoryWriter {
 public:
  /// With `resume_time`, s, removes the later rows of an existing file and continues it; otherwise begins a
  /// new file. Throws `Failure` (io_error), also for a different header.
  HistoryWriter(std::filesystem::path file, const std::vector<Column>& columns,
                std::optional<double> resume_time = std::nullopt);
  ~HistoryWriter();
  HistoryWriter(const HistoryWriter&) = delete;
  HistoryWriter& operator=(const HistoryWriter&) = delete;

  /// True if rows of an existing file were kept.
  [[nodiscard]] bool continues() const { return _continues; }

  /// Appends a row at `time`, s; `values` has one entry per column after the time.
  void append(double time, std::span<const double> values);

  /// Writes all rows to the operating system; required before the commit of a later restart file.
  void flush();

  /// Flushes, syncs and closes the file. Throws `Failure` (io_error).
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
