#include "miniapps/options/output/output_files.hpp"

#include <vector>

#include "common/program/failure.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/run/files/output_path.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 18;

}  // namespace

RowLayout row_layout(const Command& command) {
  return {command.action == Action::surface, command.settings.greeks, command.settings.mesh != 0};
}

void check_outputs(const Command& command, const std::filesystem::path& input) {
  namespace fs = std::filesystem;
  std::vector<fs::path> used = {input};
  for (const fs::path* path : {&command.out, &command.result, &command.boundary}) {
    if (path->empty()) continue;
    std::error_code error;
    if (fs::is_directory(*path, error))
      throw Failure(ExitCode::usage, "'" + path->string() + "' is a directory: name another output");
    if (fs::is_character_file(*path, error)) continue;
    for (const fs::path& other : used)
      if (fs::weakly_canonical(*path, error) == fs::weakly_canonical(other, error) ||
          run::is_same_file(*path, other))
        throw Failure(ExitCode::usage,
                      "'" + path->string() + "' is read or written already: name another output");
    used.push_back(*path);
    run::require_writable(*path);
  }
}

OutputFiles::OutputFiles(const Command& command) {
  _prices.emplace(command.out);
  _prices->write(price_header(row_layout(command)));
  if (command.boundary.empty()) return;
  _boundaries.emplace(command.boundary);
  _boundaries->write(boundary_header);
}

void OutputFiles::write(const ResultBatch& batch) {
  _prices->write(batch.prices);
  if (_boundaries) _boundaries->write(batch.boundaries);
  _counts.add(batch.counts);
}

void OutputFiles::commit() {
  if (_boundaries) _boundaries->commit();
  _prices->commit();
}

void OutputFiles::discard() {
  _boundaries.reset();
  _prices.reset();
}

void OutputFiles::File::write(std::string_view rows) {
  buffer += rows;
  if (buffer.size() < buffer_bytes) return;
  file.write(buffer);
  buffer.clear();
}

void OutputFiles::File::commit() {
  file.write(buffer);
  buffer.clear();
  file.commit();
}

}  // namespace drogue::options_app
