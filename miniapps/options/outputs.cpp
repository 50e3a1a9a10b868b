#include "miniapps/options/outputs.hpp"

namespace drogue::options_app {
namespace {

constexpr std::size_t block = std::size_t{1} << 18;

}  // namespace

Layout layout_of(const Command& command) {
  return {command.action == Action::surface, command.settings.greeks};
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
