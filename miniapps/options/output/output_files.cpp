#include "miniapps/options/outputs.hpp"

#include <vector>

#include "common/program/failure.hpp"
#include "common/run/output_path.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t block = std::size_t{1} << 18;

}  // namespace

Layout layout_of(const Command& command) {
  return {command.action == Action::surface, command.settings.greeks, command.settings.mesh != 0};
}

void check_outputs(const Command& command, const std::filesystem::path& input) {
  namespace fs = std::filesystem;
  std::vector<fs::path> taken = {input};
  for (const fs::path* path : {&command.out, &command.result, &command.boundary}) {
    if (path->empty()) continue;
    std::error_code error;
    if (fs::is_directory(*path, error))
      throw Failure(ExitCode::usage, "'" + path->string() + "' is a directory: name another output");
    if (fs::is_character_file(*path, error)) continue;
    for (const fs::path& other : taken)
      if (fs::weakly_canonical(*path, error) == fs::weakly_canonical(other, error) ||
          run::is_same_file(*path, other))
        throw Failure(ExitCode::usage,
                      "'" + path->string() + "' is read or written already: name another output");
    taken.push_back(*path);
  }
}

Outputs::Outputs(const Command& command) {
  _prices.emplace(command.out);
  _prices->write(price_header(layout_of(command)));
  if (command.boundary.empty()) return;
  _boundaries.emplace(command.boundary);
  _boundaries->write(boundary_header);
}

void Outputs::write(const Piece& piece) {
  _prices->write(piece.prices);
  if (_boundaries) _boundaries->write(piece.boundaries);
  _tally.add(piece.tally);
}

void Outputs::commit() {
  if (_boundaries) _boundaries->commit();
  _prices->commit();
}

void Outputs::discard() {
  _boundaries.reset();
  _prices.reset();
}

void Outputs::File::write(std::string_view rows) {
  text += rows;
  if (text.size() < block) return;
  file.write(text);
  text.clear();
}

void Outputs::File::commit() {
  file.write(text);
  text.clear();
  file.commit();
}

}  // namespace drogue::options_app
