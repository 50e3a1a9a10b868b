#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "kernels/device/copy.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::stepping {

/// Arrays of the state of a solver where they lie in the memory of an execution space, which others own.
/// Checkpoints, rollback and restart loop over this one list, so that a new member of the state is one line
/// of the function that makes it.
template <class ExecutionSpace>
class StateList {
 public:
  static constexpr int most = 12;

  /// Values of all saved arrays, one after another, each with the index that varies fastest last.
  using Packed = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// What happens to an array.
  struct Use {
    bool saved = true;      ///< in checkpoints. Not necessary if failed steps do not change it
    bool restarted = true;  ///< a part of the state that a restart needs
  };

  /// Adds the first rows of a View of rank 2. Throws std::length_error if the list is full.
  template <class Table>
  void add(const char* name, const char* unit, const Table& values, int rows, const Use& use = {}) {
    add({.name = name,
         .unit = unit,
         .first = values.data(),
         .rows = rows,
         .columns = static_cast<int>(values.extent(1)),
         .row_stride = static_cast<int>(values.stride(0)),
         .column_stride = static_cast<int>(values.stride(1)),
         .use = use});
  }

  /// Adds a member of the structs of a View of rank 1, unless that is empty. Throws std::length_error if the
  /// list is full.
  template <class Structs, class Struct>
  void add(const char* name, const char* unit, const Structs& of, double Struct::*member,
           const Use& use = {}) {
    static_assert(sizeof(Struct) % sizeof(double) == 0);
    if (of.extent(0) == 0) return;
    add({.name = name,
         .unit = unit,
         .first = &(of.data()->*member),
         .rows = static_cast<int>(of.extent(0)),
         .columns = 1,
         .row_stride = static_cast<int>(sizeof(Struct) / sizeof(double)),
         .column_stride = 0,
         .use = use});
  }

  /// Number of values, and of the rows of the longest array, of those that are saved. Do not throw.
  [[nodiscard]] std::size_t size() const { return _size; }
  [[nodiscard]] int most_rows() const { return _most_rows; }

  /// Names, units and extents of what a restart needs, in the order of the packed values.
  [[nodiscard]] std::vector<StateArray> arrays() const {
    std::vector<StateArray> arrays;
    for (const Entry& of : entries()) {
      if (!of.use.restarted) continue;
      arrays.push_back({of.name, of.unit, {static_cast<std::size_t>(of.rows)}});
      if (of.columns > 1) arrays.back().extent.push_back(static_cast<std::size_t>(of.columns));
    }
    return arrays;
  }

  /// Calls `copy(value, place)` for the values of row i of all saved arrays and their places in packed
  /// values.
  template <class Copy>
  KOKKOS_FUNCTION void each(int i, const Copy& copy) const {
    std::size_t begin = 0;
    for (int k = 0; k < _count; ++k) {
      const Entry& of = _entry[k];
      if (!of.use.saved) continue;
      if (i < of.rows)
        for (int column = 0; column < of.columns; ++column)
          copy(of.first[i * of.row_stride + column * of.column_stride],
               begin + static_cast<std::size_t>(i * of.columns + column));
      begin += static_cast<std::size_t>(of.rows) * static_cast<std::size_t>(of.columns);
    }
  }

  /// Enqueues zeros for the arrays of restarts, and between their columns. Throws only after a failed kernel.
  void clear(const ExecutionSpace& space) const {
    for (const Entry& of : entries())
      if (of.use.restarted) Kokkos::deep_copy(space, of.memory(), 0.0);
  }

  /// Copies an array, in its unit, by rows. Blocks. Throws std::invalid_argument for an unknown name and a
  /// span of the wrong length.
  void download(const ExecutionSpace& space, std::string_view name, std::span<double> values) const {
    const Entry& of = find(name, values.size());
    const std::vector<double> memory = read(space, of);
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = memory[of.place(k)];
  }

  /// Sets an array. Blocks. Throws as `download`.
  void upload(const ExecutionSpace& space, std::string_view name, std::span<const double> values) const {
    const Entry& of = find(name, values.size());
    std::vector<double> memory = read(space, of);
    for (std::size_t k = 0; k < values.size(); ++k) memory[of.place(k)] = values[k];
    device::copy_in(space, of.memory(), memory.data(), memory.size());
    space.fence("drogue::stepping::upload");
  }

 private:
  struct Entry {
    const char *name, *unit;
    double* first;
    int rows, columns, row_stride, column_stride;
    Use use;

    [[nodiscard]] std::size_t size() const {
      return static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    }
    /// Place in `memory` of a value, by rows.
    [[nodiscard]] std::size_t place(std::size_t k) const {
      const auto of_columns = static_cast<std::size_t>(columns);
      return k / of_columns * static_cast<std::size_t>(row_stride) +
             k % of_columns * static_cast<std::size_t>(column_stride);
    }
    /// From the first to the last value, with all that lies between.
    [[nodiscard]] Packed memory() const { return Packed(first, size() == 0 ? 0 : place(size() - 1) + 1); }
  };

  [[nodiscard]] std::span<const Entry> entries() const { return {_entry, static_cast<std::size_t>(_count)}; }
  [[nodiscard]] const Entry& find(std::string_view name, std::size_t size) const {
    for (const Entry& of : entries()) {
      if (of.name != name) continue;
      if (of.size() != size)
        throw std::invalid_argument("state: array '" + std::string(name) + "' has " +
                                    std::to_string(of.size()) + " entries");
      return of;
    }
    throw std::invalid_argument("state: there is no array '" + std::string(name) + "'");
  }
  static std::vector<double> read(const ExecutionSpace& space, const Entry& of) {
    const Packed from = of.memory();
    std::vector<double> memory(from.size());
    device::copy_out(space, memory.data(), from, memory.size());
    space.fence("drogue::stepping::download");
    return memory;
  }
  void add(const Entry& entry) {
    if (_count == most) throw std::length_error("the list of a state is full");
    _entry[_count++] = entry;
    if (!entry.use.saved) return;
    _size += entry.size();
    if (entry.rows > _most_rows) _most_rows = entry.rows;
  }

  Entry _entry[most] = {};
  int _count = 0, _most_rows = 0;
  std::size_t _size = 0;
};

/// Packs row i of a state, or restores it from packed values.
template <class ExecutionSpace>
struct CopyStateFunctor {
  StateList<ExecutionSpace> state;
  typename StateList<ExecutionSpace>::Packed packed;
  bool packs;

  KOKKOS_FUNCTION void operator()(const int i) const {
    state.each(i, [this](double& value, std::size_t at) {
      if (packs)
        packed(at) = value;
      else
        value = packed(at);
    });
  }
};

}  // namespace drogue::stepping
