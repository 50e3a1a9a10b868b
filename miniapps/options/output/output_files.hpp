#pragma once

#include <optional>
#include <string>

#include "common/run/atomic_file.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/price_text.hpp"

namespace drogue::options_app {

/// What the rows of a run's prices hold.
[[nodiscard]] Layout layout_of(const Command& command);

/// Throws Failure(usage) where an output is the input, another output or a directory. Devices may be given
/// twice.
void check_outputs(const Command& command, const std::filesystem::path& input);

/// The files of prices and, if asked for, of exercise boundaries; each appears under its name when all of it
/// is on disk, but for a device or a pipe, which is written to as prices come. All functions throw
/// Failure(io_error).
class Outputs {
 public:
  explicit Outputs(const Command& command);

  /// Writes the rows of the next piece.
  void write(const Piece& piece);
  void commit();

  /// Removes what has been written, which no commit() may follow.
  void discard();

  [[nodiscard]] const Tally& tally() const { return _tally; }

 private:
  /// Joins small pieces: a call of the system costs more than a row.
  struct File {
    explicit File(const std::filesystem::path& path) : file(path) {}
    void write(std::string_view rows);
    void commit();

    run::AtomicFile file;
    std::string text;
  };

  std::optional<File> _prices, _boundaries;
  Tally _tally;
};

}  // namespace drogue::options_app
