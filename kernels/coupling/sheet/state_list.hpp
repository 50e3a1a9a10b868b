#pragma once

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::coupling {

/// Array of a state on a device: a row of numbers for each vertex, or one number in each row.
template <class ExecutionSpace>
using StateView = Kokkos::View<double**, Kokkos::LayoutLeft, typename ExecutionSpace::memory_space>;

/// Copies row i of several arrays.
template <class ExecutionSpace>
struct CopyRowsFunctor {
  static constexpr int most = 8;

  int count = 0;
  StateView<ExecutionSpace> from[most], to[most];

  KOKKOS_FUNCTION void operator()(const int i) const {
    const auto row = static_cast<std::size_t>(i);
    // A loop of fixed length, so that no index into the arguments of the kernel varies.
    for (int k = 0; k < most; ++k)
      if (k < count)
        for (std::size_t c = 0; c < from[k].extent(1); ++c) to[k](row, c) = from[k](row, c);
  }
};

/// Arrays of cloth in air, listed in one place. Loops over the list save the state at the beginning of a
/// step, return to it after a failed one, and write and read restarts by name: a new member costs one line.
/// That of a fabric, `stepping::StateList`, packs its arrays into one checkpoint instead.
template <class ExecutionSpace>
class StateList {
 public:
  using View = StateView<ExecutionSpace>;

  /// What happens to a member.
  struct Use {
    /// Saved at the beginning of a step. Not necessary if failed steps do not change it.
    bool saved = true;
    bool restarted = true;  ///< a part of the state that a restart needs
  };

  /// List whose saved members have a row for each of so many vertices.
  explicit StateList(int vertices) : _vertices(vertices) {}

  /// Adds an array. Allocates if it is saved. Throws std::logic_error for more than `CopyRowsFunctor::most`
  /// saved members.
  void add(const std::string& name, const std::string& unit, const View& values, const Use& use = {}) {
    std::vector<std::size_t> extent = {values.extent(0)};
    if (values.extent(1) > 1) extent.push_back(values.extent(1));
    _members.push_back({{name, unit, extent}, values, use.restarted});
    if (!use.saved) return;
    if (_save.count == CopyRowsFunctor<ExecutionSpace>::most)
      throw std::logic_error("state list: too many members are saved");
    _save.from[_save.count] = values;
    _save.to[_save.count++] = View("drogue::coupling::saved_" + name, values.extent(0), values.extent(1));
  }

  /// Members that a restart needs. Throws std::bad_alloc.
  [[nodiscard]] std::vector<stepping::StateArray> arrays() const {
    std::vector<stepping::StateArray> result;
    for (const Member& member : _members)
      if (member.is_restarted) result.push_back(member.array);
    return result;
  }

  /// Kernel that saves the row of a vertex. Does not throw.
  [[nodiscard]] const CopyRowsFunctor<ExecutionSpace>& save() const { return _save; }

  /// Enqueues the return of all saved members to what was saved. Throws only after a failed kernel.
  void roll_back(const ExecutionSpace& space) const {
    CopyRowsFunctor<ExecutionSpace> back = _save;
    for (int k = 0; k < back.count; ++k) std::swap(back.from[k], back.to[k]);
    device::launch_each(space, "drogue::coupling::roll_back", _vertices, back);
  }

  /// Enqueues zeros for the members of restarts. Throws only after a failed kernel.
  void clear(const ExecutionSpace& space) const {
    for (const Member& member : _members)
      if (member.is_restarted) Kokkos::deep_copy(space, member.values, 0.0);
  }

  /// Copies a member, in its unit, by rows. Blocks. Throws std::invalid_argument for an unknown name and a
  /// span of the wrong length.
  void download(const ExecutionSpace& space, std::string_view name, std::span<double> values) const {
    const View& from = find(name, values.size());
    std::vector<double> columns(from.span());
    device::copy_out(space, columns.data(), from, columns.size());
    space.fence("drogue::coupling::download");
    for_each(from,
             [&](std::size_t by_rows, std::size_t by_columns) { values[by_rows] = columns[by_columns]; });
  }

  /// Sets a member, and the padding of its columns to zero. Blocks. Throws as `download`.
  void upload(const ExecutionSpace& space, std::string_view name, std::span<const double> values) const {
    const View& to = find(name, values.size());
    std::vector<double> columns(to.span());
    for_each(to, [&](std::size_t by_rows, std::size_t by_columns) { columns[by_columns] = values[by_rows]; });
    device::copy_in(space, to, columns.data(), columns.size());
    space.fence("drogue::coupling::upload");
  }

 private:
  struct Member {
    stepping::StateArray array;
    View values;
    bool is_restarted;
  };

  [[nodiscard]] const View& find(std::string_view name, std::size_t size) const {
    for (const Member& member : _members) {
      if (member.array.name != name) continue;
      if (member.array.size() != size)
        throw std::invalid_argument("coupled solver: array '" + member.array.name + "' has " +
                                    std::to_string(member.array.size()) + " entries");
      return member.values;
    }
    throw std::invalid_argument("coupled solver: its state has no array '" + std::string(name) + "'");
  }
  /// Calls `visit(by_rows, by_columns)` with the place of each number on the host and in the View.
  template <class Visit>
  static void for_each(const View& view, const Visit& visit) {
    const std::size_t columns = view.extent(1);
    for (std::size_t i = 0; i < view.extent(0); ++i)
      for (std::size_t c = 0; c < columns; ++c) visit(columns * i + c, i + c * view.stride(1));
  }

  int _vertices;
  std::vector<Member> _members;
  CopyRowsFunctor<ExecutionSpace> _save;
};

}  // namespace drogue::coupling
