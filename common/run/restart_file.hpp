#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace drogue::run {

/// 16 hexadecimal digits that stand for a text; equal texts, equal digits on every machine.
std::string fingerprint(std::string_view text);

/// Throws Failure(io_error) where the state of `file`, at `time`, s, is later than the end, which `key` of a
/// scene gives.
void require_not_after(const std::filesystem::path& file, double time, const char* key, double end);

/// Writes a restart file: named numbers, texts and arrays of doubles. Until commit() a former file stays
/// whole.
///
/// `scene` is the fingerprint of all that must agree between the run that writes and the run that reads. All
/// calls throw Failure(io_error). They may come from another thread than the constructor, one at a time.
class RestartWriter {
 public:
  RestartWriter(std::filesystem::path file, const std::string& scene);
  ~RestartWriter();
  RestartWriter(const RestartWriter&) = delete;
  RestartWriter& operator=(const RestartWriter&) = delete;

  void number(const std::string& name, double value);
  void integer(const std::string& name, std::int64_t value);
  void text(const std::string& name, const std::string& value);

  /// Declares an array of `size` doubles, then filled in pieces by write().
  void array(const std::string& name, std::uint64_t size);
  void write(const std::string& name, std::uint64_t first, std::span<const double> values);

  /// Completes the file, checksum included, syncs it and puts it under its name.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> _state;
};

/// Reads a restart file. The constructor checks every byte of it before anything is used: a file that is
/// truncated, damaged, of another format version or of another scene is Failure(io_error), with what is
/// wrong.
class RestartReader {
 public:
  RestartReader(const std::filesystem::path& file, const std::string& scene);
  ~RestartReader();
  RestartReader(const RestartReader&) = delete;
  RestartReader& operator=(const RestartReader&) = delete;

  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] std::int64_t integer(const std::string& name) const;
  [[nodiscard]] std::string text(const std::string& name) const;
  [[nodiscard]] std::uint64_t size(const std::string& name) const;

  /// Reads entries [first, first + values.size()) of an array.
  void read(const std::string& name, std::uint64_t first, std::span<double> values) const;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace drogue::run
