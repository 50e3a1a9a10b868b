#pragma once

#include <stdexcept>

#include "kernels/device/launch.hpp"
#include "kernels/stepping/state_array.hpp"

namespace drogue::stepping {

/// Arrays of the state of a solver where they lie in the memory of an execution space. Checkpoints, rollback
/// and restart loop over this one list, so that a new member of the state is one line of the function that
/// makes it.
template <class ExecutionSpace>
class StateList {
 public:
  /// Values of all arrays, one after another, each with the index that varies fastest last.
  using Packed = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Adds the first rows of a View of rank 2. Throws std::length_error if the list is full.
  template <class Table>
  void add(const char* name, const char* unit, const Table& values, int rows) {
    add({.name = name,
         .unit = unit,
         .first = values.data(),
         .rows = rows,
         .columns = static_cast<int>(values.extent(1)),
         .row_stride = static_cast<int>(values.stride(0)),
         .column_stride = static_cast<int>(values.stride(1))});
  }

  /// Adds a member of the structs of a View of rank 1, unless that is empty. Throws std::length_error if the
  /// list is full.
  template <class Structs, class Struct>
  void add(const char* name, const char* unit, const Structs& of, double Struct::*member) {
    static_assert(sizeof(Struct) % sizeof(double) == 0);
    if (of.extent(0) == 0) return;
    add({.name = name,
         .unit = unit,
         .first = &(of.data()->*member),
         .rows = static_cast<int>(of.extent(0)),
         .columns = 1,
         .row_stride = static_cast<int>(sizeof(Struct) / sizeof(double)),
         .column_stride = 0});
  }

  /// Number of values, and of the rows of the longest array. Do not throw.
  [[nodiscard]] std::size_t size() const { return _size; }
  [[nodiscard]] int most_rows() const { return _most_rows; }

  /// Names, units and extents in the order of the packed values.
  [[nodiscard]] std::vector<StateArray> arrays() const {
    std::vector<StateArray> arrays;
    for (int k = 0; k < _count; ++k) {
      const Entry& of = _entry[k];
      arrays.push_back({of.name, of.unit, {static_cast<std::size_t>(of.rows)}});
      if (of.columns > 1) arrays.back().extent.push_back(static_cast<std::size_t>(of.columns));
    }
    return arrays;
  }

  /// Calls `copy(value, place)` for the values of row i of all arrays and their places in packed values.
  template <class Copy>
  KOKKOS_FUNCTION void each(int i, const Copy& copy) const {
    std::size_t begin = 0;
    for (int k = 0; k < _count; ++k) {
      const Entry& of = _entry[k];
      if (i < of.rows)
        for (int column = 0; column < of.columns; ++column)
          copy(of.first[i * of.row_stride + column * of.column_stride],
               begin + static_cast<std::size_t>(i * of.columns + column));
      begin += static_cast<std::size_t>(of.rows) * static_cast<std::size_t>(of.columns);
    }
  }

 private:
  struct Entry {
    const char *name, *unit;
    double* first;
    int rows, columns, row_stride, column_stride;
  };
  static constexpr int most = 12;

  void add(const Entry& entry) {
    if (_count == most) throw std::length_error("the list of a state is full");
    _entry[_count++] = entry;
    _size += static_cast<std::size_t>(entry.rows) * static_cast<std::size_t>(entry.columns);
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
