#include "kernels/linear/symmetric_eigenpairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace drogue::linear {

namespace {

/// Product of two vectors from entry `first` on.
double product(const double* a, const double* b, std::size_t first, std::size_t n) {
  return std::inner_product(a + first, a + n, b + first, 0.0);
}

/// y += factor x from entry `first` on.
void add(double factor, const double* x, double* y, std::size_t first, std::size_t n) {
  for (std::size_t i = first; i < n; ++i) y[i] += factor * x[i];
}

/// Square matrix and the vectors of its reduction.
class Reduction {
 public:
  explicit Reduction(std::vector<double> matrix)
      : _n(static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(matrix.size()))))),
        _matrix(std::move(matrix)),
        _vectors(_n * _n, 0.0),
        _diagonal(_n),
        _next(_n, 0.0) {
    for (std::size_t k = 0; k < _n; ++k) _vectors[k * _n + k] = 1.0;
  }

  void tridiagonalise() {
    for (std::size_t k = 0; k + 2 < _n; ++k) reflect(k);
    for (std::size_t k = 0; k < _n; ++k) _diagonal[k] = column(k)[k];
    for (std::size_t k = 0; k + 1 < _n; ++k) _next[k] = column(k)[k + 1];
  }

  /// Makes the tridiagonal matrix diagonal.
  void diagonalise() {
    // Two to three steps an eigenvalue are usual.
    std::size_t steps = 0;
    for (std::size_t high = _n; high > 1;) {
      if (is_negligible(high - 2)) {
        --high;
        continue;
      }
      std::size_t low = high - 1;
      while (low > 0 && !is_negligible(low - 1)) --low;
      if (++steps > 60 * _n) throw std::runtime_error("the eigenvalues of a matrix do not converge");
      step(low, high);
    }
  }

  [[nodiscard]] Eigenpairs sorted() const {
    std::vector<std::size_t> order(_n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t k) { return _diagonal[k]; });
    Eigenpairs pairs;
    for (const std::size_t k : order) {
      pairs.values.push_back(_diagonal[k]);
      pairs.vectors.insert(pairs.vectors.end(), &_vectors[k * _n], &_vectors[k * _n] + _n);
    }
    return pairs;
  }

 private:
  [[nodiscard]] double* column(std::size_t k) { return &_matrix[k * _n]; }

  /// Makes the entries of column and row k below entry k + 1 zero, by H = 1 - beta v v^T.
  void reflect(std::size_t k) {
    std::vector<double> v(column(k), column(k) + _n), w(_n, 0.0);
    const double tail = product(v.data(), v.data(), k + 2, _n);
    if (tail == 0.0) return;
    const double entry = -std::copysign(std::sqrt(v[k + 1] * v[k + 1] + tail), v[k + 1]);
    v[k + 1] -= entry;
    const double beta = 2.0 / (v[k + 1] * v[k + 1] + tail);
    for (std::size_t j = k + 1; j < _n; ++j) w[j] = beta * product(column(j), v.data(), k + 1, _n);
    add(-0.5 * beta * product(v.data(), w.data(), k + 1, _n), v.data(), w.data(), k + 1, _n);
    for (std::size_t j = k + 1; j < _n; ++j) {
      add(-v[j], w.data(), column(j), k + 1, _n);
      add(-w[j], v.data(), column(j), k + 1, _n);
    }
    column(k)[k + 1] = entry;
    std::vector<double> image(_n, 0.0);
    for (std::size_t j = k + 1; j < _n; ++j) add(beta * v[j], &_vectors[j * _n], image.data(), 0, _n);
    for (std::size_t j = k + 1; j < _n; ++j) add(-v[j], image.data(), &_vectors[j * _n], 0, _n);
  }

  [[nodiscard]] bool is_negligible(std::size_t k) const {
    return std::abs(_next[k]) <=
           std::numeric_limits<double>::epsilon() * (std::abs(_diagonal[k]) + std::abs(_diagonal[k + 1]));
  }

  /// One implicit QR step of rows `low` to `high` - 1.
  void step(std::size_t low, std::size_t high) {
    const double half = 0.5 * (_diagonal[high - 2] - _diagonal[high - 1]), last = _next[high - 2];
    const double shift =
        _diagonal[high - 1] - last / (half + std::copysign(std::hypot(half, last), half)) * last;
    double x = _diagonal[low] - shift, z = _next[low];
    for (std::size_t k = low; k + 1 < high; ++k) {
      const double r = std::hypot(x, z);
      const double c = r > 0.0 ? x / r : 1.0, s = r > 0.0 ? z / r : 0.0;
      const double a = _diagonal[k], b = _next[k], d = _diagonal[k + 1];
      const double moved = s * (s * (d - a) + 2.0 * c * b);
      if (k > low) _next[k - 1] = r;
      _diagonal[k] = a + moved;
      _diagonal[k + 1] = d - moved;
      _next[k] = c * s * (d - a) + (c - s) * (c + s) * b;
      x = _next[k];
      if (k + 2 < high) {
        z = s * _next[k + 1];
        _next[k + 1] *= c;
      }
      rotate(&_vectors[k * _n], c, s);
    }
  }

  /// Rotates a vector and the one after it.
  void rotate(double* vector, double c, double s) const {
    for (std::size_t i = 0; i < _n; ++i) {
      const double first = vector[i], second = vector[i + _n];
      vector[i] = c * first + s * second;
      vector[i + _n] = c * second - s * first;
    }
  }

  std::size_t _n;
  std::vector<double> _matrix, _vectors, _diagonal;
  std::vector<double> _next;  ///< entries beside the diagonal
};

}  // namespace

Eigenpairs symmetric_eigenpairs(std::vector<double> matrix) {
  Reduction reduction(std::move(matrix));
  reduction.tridiagonalise();
  reduction.diagonalise();
  return reduction.sorted();
}

}  // namespace drogue::linear
