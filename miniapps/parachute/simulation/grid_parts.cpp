#include "miniapps/parachute/simulation/grid_parts.hpp"

#include <algorithm>

namespace drogue::parachute_app {
namespace {

constexpr int root = 0;

std::uint64_t product(int a, int b) { return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b); }

}  // namespace

Lattice GridParts::lattice(flow::StateField field) const {
  const linear::CellBox own = box(field, _group.rank());
  Lattice lattice = lattice_of(_parameters, field);
  lattice.n = own.cells;
  lattice.origin = own.begin;
  return lattice;
}

run::Blocks GridParts::blocks(flow::StateField field, int rank) const {
  const linear::CellBox part = box(field, rank);
  const std::array<int, 3> n = flow::extents(_parameters, field);  // x is not divided
  const std::uint64_t plane = product(n[0], n[1]), length = product(n[0], part.cells[1]),
                      planes = static_cast<std::uint64_t>(part.cells[2]),
                      first =
                          product(n[0], part.begin[1]) + plane * static_cast<std::uint64_t>(part.begin[2]);
  if (length == plane) return {first, plane * planes, 1, plane * planes};
  return {first, length, planes, plane};
}

run::ArrayPart GridParts::cells(const std::vector<std::uint64_t>& shape) const {
  const linear::CellBox own = box(flow::StateField::pressure, _group.rank());
  run::ArrayPart part{shape, {own.begin.begin(), own.begin.end()}, {own.cells.begin(), own.cells.end()}};
  part.begin.resize(shape.size(), 0);
  if (shape.size() > 3) part.extent.push_back(shape[3]);  // components
  return part;
}

void GridParts::collect(flow::StateField field, std::vector<double>& own,
                        const std::function<void(const run::Blocks&, std::span<const double>)>& take) const {
  if (_group.rank() != root) {
    const linear::Message message{root, 0, 0, own, {}};
    return _group.exchange({&message, 1});
  }
  take(blocks(field, root), own);
  for (int rank = 1; rank < _group.size(); ++rank) {
    own.resize(box(field, rank).size());
    const linear::Message message{rank, 0, 0, {}, own};
    _group.exchange({&message, 1});
    take(blocks(field, rank), own);
  }
}

std::vector<double> GridParts::whole(flow::StateField field, std::vector<double> own) const {
  if (_group.size() == 1) return own;
  std::vector<double> values(_group.rank() == root ? flow::state_size(_parameters, field) : 0);
  collect(field, own, [&](const run::Blocks& to, std::span<const double> part) {
    for (std::uint64_t k = 0; k < to.count; ++k)
      std::ranges::copy(part.subspan(k * to.length, to.length),
                        values.begin() + static_cast<std::ptrdiff_t>(to.first + k * to.stride));
  });
  return values;
}

}  // namespace drogue::parachute_app
