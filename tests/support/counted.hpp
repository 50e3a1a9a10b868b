#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <set>
#include <vector>

#include "kernels/device/pack.hpp"
#include "perf/models/arithmetic.hpp"

// A number type that records its operations, for the point functions of kernels/. Include this header before
// them: they call `device::root` and other functions by qualified names, which only earlier overloads match.

namespace drogue::perf {

/// Shows counts that differ in a test.
inline void PrintTo(const Arithmetic& a, std::ostream* out) {
  *out << '{' << a.additions << ", " << a.multiplications << ", " << a.divisions << ", " << a.roots << ", "
       << a.comparisons << '}';
}

}  // namespace drogue::perf

namespace drogue::testing {

/// Operations up to `input` have no operands, up to `root` one, then two; `select` has three.
enum class Operation {
  constant,
  input,
  absolute,
  negate,
  binary_reciprocal,
  root,
  add,
  subtract,
  multiply,
  divide,
  less,
  less_or_equal,
  maximum,
  minimum,
  select
};

/// Expression graph of an evaluation. Equal operations on equal operands share a node, and only nodes that a
/// result depends on are counted.
class Trace {
 public:
  using Operands = std::array<std::int64_t, 3>;

  std::int64_t node(Operation operation, const Operands& operands) {
    const auto next = static_cast<std::int64_t>(_nodes.size());
    const auto [place, added] = _known.try_emplace(Node{operation, operands}, next);
    if (added) _nodes.push_back(place->first);
    return place->second;
  }
  std::int64_t input() { return node(Operation::input, {_inputs++, 0, 0}); }
  void keep(std::int64_t result) { _results.push_back(result); }

  /// Value at `address`; repeated reads are the same input.
  std::int64_t load(const double* address) {
    read.insert(address);
    const auto place = _memory.find(address);
    return place != _memory.end() ? place->second : _memory[address] = input();
  }
  void store(const double* address, std::int64_t result) {
    written.insert(address);
    _memory[address] = result;
    keep(result);
  }

  /// Starts a new evaluation, which must not use values of the previous one.
  void clear() { _nodes.clear(), _known.clear(), _memory.clear(), _results.clear(); }

  [[nodiscard]] perf::Arithmetic arithmetic() const {
    perf::Arithmetic sum;
    std::vector<bool> seen(_nodes.size());
    std::vector<std::int64_t> open = _results;
    while (!open.empty()) {
      const auto at = static_cast<std::size_t>(open.back());
      open.pop_back();
      if (seen[at]) continue;
      seen[at] = true;
      const auto& [operation, operands] = _nodes[at];
      add(operation, sum);
      for (std::size_t k = 0; k < operands_of(operation); ++k) open.push_back(operands[k]);
    }
    return sum;
  }

  std::set<const double*> read, written;  ///< addresses since the last clear of the sets

 private:
  using Node = std::pair<Operation, Operands>;

  static std::size_t operands_of(Operation operation) {
    if (operation == Operation::select) return 3;
    return operation <= Operation::input ? 0 : operation <= Operation::root ? 1 : 2;
  }
  static void add(Operation operation, perf::Arithmetic& sum) {
    if (operation == Operation::root) ++sum.roots;
    if (operation == Operation::add || operation == Operation::subtract) ++sum.additions;
    if (operation == Operation::multiply) ++sum.multiplications;
    if (operation == Operation::divide) ++sum.divisions;
    if (operation >= Operation::less) ++sum.comparisons;
  }

  std::vector<Node> _nodes;
  std::map<Node, std::int64_t> _known;
  std::map<const double*, std::int64_t> _memory;
  std::vector<std::int64_t> _results;
  std::int64_t _inputs = 0;
};

inline Trace trace;

/// Number of operations on which the stores and kept results of `evaluate` depend.
template <class Evaluate>
perf::Arithmetic arithmetic_of(const Evaluate& evaluate) {
  trace.clear();
  evaluate();
  return trace.arithmetic();
}

/// Number that records its operations in `trace`.
class Counted {
 public:
  Counted() = default;
  Counted(double constant) : value(constant) {}  // NOLINT: implicit, to mix numbers and counted numbers

  /// Value that is not a compile-time constant.
  static Counted input(double number) { return Counted(number, trace.input()); }
  static Counted load(const double* address) { return Counted(*address, trace.load(address)); }

  void store(double* address) const {
    trace.store(address, node());
    *address = value;
  }
  void keep() const { trace.keep(node()); }

  /// Result of an operation; a constant if all operands are constants.
  template <class... Operand>
  static Counted of(Operation operation, double result, const Operand&... operand) {
    if ((operand.is_constant() && ...)) return Counted(result);
    return Counted(result, trace.node(operation, {operand.node()...}));
  }

  friend Counted operator+(const Counted& a, const Counted& b) {
    const bool in_order = a.node() <= b.node();
    return of(Operation::add, a.value + b.value, in_order ? a : b, in_order ? b : a);
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    const bool in_order = a.node() <= b.node();
    return of(Operation::multiply, a.value * b.value, in_order ? a : b, in_order ? b : a);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    return of(Operation::subtract, a.value - b.value, a, b);
  }
  friend Counted operator/(const Counted& a, const Counted& b) {
    return of(Operation::divide, a.value / b.value, a, b);
  }
  friend Counted operator-(const Counted& a) { return of(Operation::negate, -a.value, a); }

  /// Comparisons return one or zero, a condition of `device::select`.
  friend Counted operator<(const Counted& a, const Counted& b) {
    return of(Operation::less, a.value < b.value ? 1.0 : 0.0, a, b);
  }
  friend Counted operator<=(const Counted& a, const Counted& b) {
    return of(Operation::less_or_equal, a.value <= b.value ? 1.0 : 0.0, a, b);
  }
  friend Counted operator>(const Counted& a, const Counted& b) { return b < a; }
  friend Counted operator>=(const Counted& a, const Counted& b) { return b <= a; }

  /// Whether a condition holds; the branch that follows is not recorded.
  explicit operator bool() const { return value != 0.0; }

  Counted& operator+=(const Counted& other) { return *this = *this + other; }
  Counted& operator-=(const Counted& other) { return *this = *this - other; }
  Counted& operator*=(const Counted& other) { return *this = *this * other; }
  Counted& operator/=(const Counted& other) { return *this = *this / other; }

  double value = 0.0;

 private:
  Counted(double number, std::int64_t node) : value(number), _node(node) {}
  [[nodiscard]] bool is_constant() const { return _node < 0; }
  [[nodiscard]] std::int64_t node() const {
    if (!is_constant()) return _node;
    return trace.node(Operation::constant, {Kokkos::bit_cast<std::int64_t>(value), 0, 0});
  }

  std::int64_t _node = -1;  ///< negative: a constant
};

}  // namespace drogue::testing

namespace drogue::device {

using testing::Counted;
using testing::Operation;

inline Counted absolute(Counted a) { return Counted::of(Operation::absolute, std::abs(a.value), a); }
inline Counted square_root(Counted a) { return Counted::of(Operation::root, std::sqrt(a.value), a); }
inline Counted reciprocal(Counted a) { return Counted(1.0) / a; }
inline Counted binary_reciprocal(Counted a) {
  return Counted::of(Operation::binary_reciprocal, binary_reciprocal(a.value), a);
}
inline Root<Counted> root(Counted a) {
  const Counted value = square_root(a), inverse = reciprocal(a);
  return {value, value * inverse, inverse};
}
inline Counted maximum(Counted a, Counted b) {
  return Counted::of(Operation::maximum, a.value > b.value ? a.value : b.value, a, b);
}
inline Counted minimum(Counted a, Counted b) {
  return Counted::of(Operation::minimum, a.value < b.value ? a.value : b.value, a, b);
}
inline bool all(Counted condition) { return condition.value != 0.0; }
inline Counted select(Counted condition, Counted yes, Counted no) {
  return Counted::of(Operation::select, condition.value != 0.0 ? yes.value : no.value, condition, yes, no);
}

template <>
struct Access<Counted> {
  using Element = double;
  static constexpr int lanes = 1;
  static Counted load(const double* address) { return Counted::load(address); }
  static void store(double* address, Counted value) { value.store(address); }
  static double lane(Counted value, int) { return value.value; }
};

}  // namespace drogue::device
