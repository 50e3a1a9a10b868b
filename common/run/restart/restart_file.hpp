#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "common/program/communicator.hpp"
#include "common/run/hdf5/blocks.hpp"

namespace drogue::run {

/// 16 hexadecimal digits that identify a text; equal on every machine.
std::string fingerprint(std::string_view text);

/// Throws `Failure` (io_error) if the state of `file`, at `time`, s, is later than `end`, s, which `key` of
/// the scene sets.
void require_not_after(const std::filesystem::path& file, double time, const char* key, double end);

/// Describes how the scene with a fingerprint differs from the present one; empty if that is not known.
using DescribeDifference = std::function<std::string(const std::string& fingerprint)>;

/// Writes a restart file: named numbers, texts and arrays of doubles. A former file stays whole until
/// commit().
///
/// `scene` is the fingerprint of everything that must agree between the writing and the reading run. All
/// functions throw `Failure` (io_error). One thread at a time may call them, also another thread than the
/// constructor's.
///
/// On several ranks rank 0 writes, and the functions of the others do nothing. None communicates but
/// commit(), which is collective and throws the first failure of rank 0 on all ranks.
class RestartWriter {
 public:
  RestartWriter(const std::filesystem::path& file, const std::string& scene,
                Communicator& communicator = Communicator::self());
  ~RestartWriter();
  RestartWriter(const RestartWriter&) = delete;
  RestartWriter& operator=(const RestartWriter&) = delete;

  void number(const std::string& name, double value);
  void integer(const std::string& name, std::int64_t value);
  void text(const std::string& name, const std::string& value);

  /// Declares an array of `size` doubles; write() fills it in pieces.
  void array(const std::string& name, std::uint64_t size);
  void write(const std::string& name, std::uint64_t first, std::span<const double> values);
  void write(const std::string& name, const Blocks& blocks, std::span<const double> values);

  /// Adds the checksum, syncs the file and renames it to its final name.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> _state;
};

/// Reads a restart file. The constructor verifies every byte first. Throws `Failure` (io_error), with the
/// fault, for a truncated or damaged file and for another format version or scene, how that differs
/// according to `describe_difference`.
///
/// On several ranks, rank 0 verifies the file, and all read from it. Functions are collective, and throw on
/// all ranks what one throws.
class RestartReader {
 public:
  RestartReader(const std::filesystem::path& file, const std::string& scene,
                const DescribeDifference& describe_difference = {},
                Communicator& communicator = Communicator::self());
  ~RestartReader();
  RestartReader(const RestartReader&) = delete;
  RestartReader& operator=(const RestartReader&) = delete;

  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] std::int64_t integer(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] std::uint64_t size(const std::string& name) const;

  /// Reads entries [first, first + values.size()) of an array.
  void read(const std::string& name, std::uint64_t first, std::span<double> values) const;
  /// Reads blocks of an array; each rank may give others.
  void read(const std::string& name, const Blocks& blocks, std::span<double> values) const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace drogue::run
