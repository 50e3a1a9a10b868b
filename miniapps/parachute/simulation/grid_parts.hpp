#pragma once

#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "common/run/hdf5/blocks.hpp"
#include "common/run/hdf5/shared_write.hpp"
#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/linear/parallel/rank_group.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {

/// Parts of the arrays of a flow that ranks hold; a process alone holds all of them.
class GridParts {
 public:
  /// `on_device`: whether the flow is on a device, where ranks divide it otherwise.
  GridParts(const flow::Parameters& parameters, linear::RankGroup group, bool on_device = false)
      : _parameters(parameters), _group(std::move(group)), _on_device(on_device) {}

  [[nodiscard]] const linear::RankGroup& group() const { return _group; }

  /// This rank's cell centres, or faces normal to an axis. Does not throw.
  [[nodiscard]] Lattice lattice(std::size_t normal = flow::at_cells) const;

  /// Place of this rank's part in a whole array of that shape, x first. Does not throw.
  [[nodiscard]] run::Blocks blocks(const std::array<int, 3>& whole) const {
    return blocks(whole, _group.rank());
  }

  /// This rank's part of a dataset of that shape, in the order of `flow::Solver::sample`. Throws only
  /// std::bad_alloc.
  [[nodiscard]] run::ArrayPart cells(const std::vector<std::uint64_t>& shape) const;

  /// Passes the parts of all ranks of an array of that whole shape to `take` on rank 0, one after the other.
  /// `own` is this rank's part, and room for others on rank 0. `take` must not throw on several ranks.
  /// Collective.
  void collect(const std::array<int, 3>& whole, std::vector<double>& own,
               const std::function<void(const run::Blocks&, std::span<const double>)>& take) const;

  /// The whole array on rank 0, nothing on others. Collective.
  [[nodiscard]] std::vector<double> whole(const std::array<int, 3>& shape, std::vector<double> own) const;

 private:
  [[nodiscard]] linear::CellBox box(const std::array<int, 3>& whole, int rank) const {
    return flow::part_of(whole, _parameters, flow::ranks_of(_parameters, _group.size(), rank, _on_device));
  }
  [[nodiscard]] run::Blocks blocks(const std::array<int, 3>& whole, int rank) const;

  const flow::Parameters& _parameters;
  linear::RankGroup _group;
  bool _on_device;
};

}  // namespace drogue::parachute_app
