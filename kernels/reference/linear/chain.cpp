#include "kernels/reference/linear/chain.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <utility>

namespace drogue::reference {

namespace {

using Number = boost::multiprecision::cpp_bin_float_50;
using Row = std::vector<Number>;

/// Rows of the matrix, and the right side in a last column.
std::vector<Row> equations(const Chain& chain, const std::vector<double>& source) {
  const std::size_t n = chain.shunts.size();
  std::vector<Row> rows(n, Row(n + 1, 0));
  for (std::size_t k = 0; k < n; ++k) {
    rows[k][k] += chain.shunts[k];
    rows[k][n] = source[k];
    rows[k][k] += chain.conductances[k];
    rows[k][k] += chain.conductances[k + 1];
    if (k > 0 || chain.is_ring) rows[k][(k + n - 1) % n] -= chain.conductances[k];
    if (k + 1 < n || chain.is_ring) rows[k][(k + 1) % n] -= chain.conductances[k + 1];
  }
  if (chain.weights.empty()) return rows;
  Number sum = 0, whole = 0;
  for (std::size_t k = 0; k < n; ++k) {
    sum += source[k];
    whole += chain.weights[k];
  }
  for (std::size_t k = 0; k < n; ++k) rows[k][n] -= sum / whole * chain.weights[k];
  // The last equation follows from the others; that of the mean takes its place.
  for (std::size_t k = 0; k < n; ++k) rows[n - 1][k] = chain.weights[k];
  rows[n - 1][n] = 0;
  return rows;
}

}  // namespace

std::vector<double> solve_chain(const Chain& chain, const std::vector<double>& source) {
  std::vector<Row> rows = equations(chain, source);
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (abs(rows[i][k]) > abs(rows[pivot][k])) pivot = i;
    std::swap(rows[k], rows[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      if (rows[i][k] == 0) continue;
      const Number factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  std::vector<Number> unknowns(n);
  for (std::size_t k = n; k-- > 0;) {
    Number sum = rows[k][n];
    for (std::size_t j = k + 1; j < n; ++j) sum -= rows[k][j] * unknowns[j];
    unknowns[k] = sum / rows[k][k];
  }
  std::vector<double> result;
  for (const Number& unknown : unknowns) result.push_back(static_cast<double>(unknown));
  return result;
}

}  // namespace drogue::reference
