#include "miniapps/parachute/simulation/grid_parts.hpp"

#include <algorithm>

namespace drogue::parachute_app {
namespace {

constexpr int root = 0;

std::uint64_t product(int a, int b) { return static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(b); }

}  // namespace

Lattice GridParts::lattice(std::size_t normal) const {
  Lattice lattice = lattice_of(_parameters, normal);
  const linear::CellBox own = box(lattice.n, _group.rank());
  lattice.n = own.cells;
  lattice.origin = own.begin;
  return lattice;
}

run::Blocks GridParts::blocks(const std::array<int, 3>& n, int rank) const {
  const linear::CellBox part = box(n, rank);  // x is not divided
  const auto plane = product(n[0], n[1]), length = product(n[0], part.cells[1]);
  const auto first = product(n[0], part.begin[1]) + product(1, part.begin[2]) * plane;
  const auto planes = product(1, part.cells[2]);
  if (length == plane) return run::one_block(first, plane * planes);
  return {first, length, planes, plane};
}

run::ArrayPart GridParts::cells(const std::vector<std::uint64_t>& shape) const {
  const linear::CellBox own = box(_parameters.cells, _group.rank());
  run::ArrayPart part{shape, {own.begin.begin(), own.begin.end()}, {own.cells.begin(), own.cells.end()}};
  part.begin.resize(shape.size(), 0);
  if (shape.size() > 3) part.extent.push_back(shape[3]);  // components
  return part;
}

void GridParts::collect(const std::array<int, 3>& whole, std::vector<double>& own,
                        const std::function<void(const run::Blocks&, std::span<const double>)>& take) const {
  if (_group.rank() != root) {
    const linear::Message message{root, 0, 0, own, {}};
    return _group.exchange({&message, 1});
  }
  take(blocks(whole, root), own);
  for (int rank = 1; rank < _group.size(); ++rank) {
    own.resize(box(whole, rank).size());
    const linear::Message message{rank, 0, 0, {}, own};
    _group.exchange({&message, 1});
    take(blocks(whole, rank), own);
  }
}

std::vector<double> GridParts::whole(const std::array<int, 3>& shape, std::vector<double> own) const {
  if (_group.size() == 1) return own;
  std::vector<double> values(_group.rank() == root ? linear::CellBox{{}, shape}.size() : 0);
  collect(shape, own, [&](const run::Blocks& to, std::span<const double> part) {
    for (std::uint64_t k = 0; k < to.count; ++k)
      std::ranges::copy(part.subspan(k * to.length, to.length),
                        values.begin() + static_cast<std::ptrdiff_t>(to.first + k * to.stride));
  });
  return values;
}

}  // namespace drogue::parachute_app
