#pragma once

#include <optional>
#include <string>

#include "common/run/files/atomic_file.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/output/price_rows.hpp"
#include "miniapps/options/output/result_batch.hpp"

namespace drogue::options_app {

/// Layout of the rows of prices that a command line requests.
[[nodiscard]] RowLayout row_layout(const Command& command);

/// Throws `Failure` (usage) if an output is the input, another output or a directory. A device may serve
/// several outputs.
void check_outputs(const Command& command, const std::filesystem::path& input);

/// Files of prices and, if requested, of exercise boundaries. Each appears complete under its name at the
/// commit; a device or pipe is written directly. All functions throw `Failure` (io_error).
class OutputFiles {
 public:
  /// Opens the files and writes their headers.
  explicit OutputFiles(const Command& command);

  /// Appends the rows of a batch of results and adds its counts.
  void write(const ResultBatch& batch);

  /// Writes all rows to disk and gives the files their names.
  void commit();

  /// Removes the unfinished files. No other function may follow.
  void discard();

  /// Counts of all rows written.
  [[nodiscard]] const RowCounts& counts() const { return _counts; }

 private:
  /// File behind a buffer: a system call costs more than formatting a row.
  struct File {
    explicit File(const std::filesystem::path& path) : file(path) {}
    void write(std::string_view rows);
    void commit();

    run::AtomicFile file;
    std::string buffer;
  };

  std::optional<File> _prices, _boundaries;
  RowCounts _counts;
};

}  // namespace drogue::options_app
