#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/run/atomic_file.hpp"
#include "kernels/options/contract.hpp"
#include "miniapps/options/batch_reader.hpp"

namespace drogue::options_app {

/// How many rows ended how, and the first of those that did not end well.
struct Tally {
  std::int64_t rows = 0, coarse = 0, invalid = 0, failed = 0;
  std::int64_t invalid_line = 0, failed_line = 0;
  std::string invalid_fault;
};

/// Writes rows of prices; the file appears under its name when all of them are on disk.
class PriceWriter {
 public:
  /// What the rows hold beside prices.
  struct Layout {
    bool surface = false;  ///< the strike and the maturity, behind the id
    bool greeks = false;   ///< delta, gamma, theta; else their fields are empty
  };

  /// Throws Failure(io_error).
  PriceWriter(const std::filesystem::path& file, Layout layout);

  /// A row that was priced: a number that is none gives an empty field.
  void write(const Row& row, const options::Contract& contract, const options::Price& price);

  /// A row with a fault.
  void write_invalid(const Row& row);

  void commit();

  [[nodiscard]] const Tally& tally() const { return _tally; }

 private:
  void end_row();

  run::AtomicFile _file;
  Layout _layout;
  std::string _text;
  Tally _tally;
};

}  // namespace drogue::options_app
