#include "kernels/linear/poisson/axis_modes.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "kernels/linear/symmetric_eigenpairs.hpp"

namespace drogue::linear {

namespace {

void check_widths(const PoissonProblem& problem, std::size_t axis) {
  const std::vector<double>& widths = problem.widths[axis];
  const int cells = problem.cells[axis] + (problem.axes[axis].on_inner_faces() ? 1 : 0);
  if (widths.size() != static_cast<std::size_t>(cells))
    throw std::invalid_argument("Poisson solver: " + std::to_string(widths.size()) + " widths for " +
                                std::to_string(cells) + " cells");
  for (const double width : widths)
    if (!(width > 0.0) || !std::isfinite(width))
      throw std::invalid_argument("Poisson solver: widths of cells must be positive and finite");
}

/// Matrix W^(-1/2) K W^(-1/2) of minus the second difference.
std::vector<double> similar_matrix(const StretchedAxis& axis, bool periodic) {
  const std::size_t n = axis.lengths.size();
  std::vector<double> matrix(n * n, 0.0);
  const auto add = [&](std::size_t i, std::size_t j, double value) {
    matrix[j * n + i] += value / std::sqrt(axis.lengths[i] * axis.lengths[j]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    add(i, i, axis.conductances[i] + axis.conductances[i + 1]);
    if (i + 1 == n && !periodic) continue;
    const std::size_t next = (i + 1) % n;
    add(i, next, -axis.conductances[i + 1]);
    add(next, i, -axis.conductances[i + 1]);
  }
  return matrix;
}

/// Rayleigh quotient of a column of `forward`, by differences of values, which lose no digits of small
/// eigenvalues: its error is the square of that of the eigenvector.
double rayleigh_quotient(const StretchedAxis& axis, bool periodic, const double* eigenvector) {
  const std::size_t n = axis.lengths.size();
  const auto value = [&](std::size_t i) { return eigenvector[i] / std::sqrt(axis.lengths[i]); };
  double energy = 0.0;
  double before = periodic ? value(n - 1) : 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double step = value(i) - before;
    energy += axis.conductances[i] * step * step;
    before = value(i);
  }
  if (!periodic) energy += axis.conductances[n] * before * before;
  return energy / std::inner_product(eigenvector, eigenvector + n, eigenvector, 0.0);
}

/// Replaces the first of the normalised vectors by the square roots of the lengths, and makes the others
/// orthogonal to it: round-off has mixed those of the smallest eigenvalues.
void make_constant_exact(const std::vector<double>& lengths, std::vector<double>& vectors) {
  const std::size_t n = lengths.size();
  const double whole = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  for (std::size_t i = 0; i < n; ++i) vectors[i] = std::sqrt(lengths[i] / whole);
  for (std::size_t k = 1; k < n; ++k) {
    double* vector = &vectors[k * n];
    const double part = std::inner_product(vector, vector + n, vectors.data(), 0.0);
    for (std::size_t i = 0; i < n; ++i) vector[i] -= part * vectors[i];
  }
}

AxisModes analytic_modes(const PoissonProblem& problem, std::size_t axis) {
  const int n = problem.cells[axis];
  AxisModes modes;
  modes.eigenvalues = axis_eigenvalues(problem, axis);
  if (!problem.varies_along(axis)) return modes;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) modes.forward.push_back(axis_eigenvector(problem.axes[axis], n, k, i));
  return modes;
}

}  // namespace

StretchedAxis stretched_axis(const PoissonProblem& problem, std::size_t axis) {
  check_widths(problem, axis);
  const std::vector<double>& widths = problem.widths[axis];
  const AxisConditions& conditions = problem.axes[axis];
  // The distances of the centres on either side of each face, which half a cell follows at an end.
  std::vector<double> distances;
  double before = conditions.periodic ? widths.back() : 0.0;
  for (const double width : widths) {
    distances.push_back(0.5 * (before + width));
    before = width;
  }
  distances.push_back(conditions.periodic ? distances.front() : 0.5 * before);
  StretchedAxis result{.lengths = widths, .conductances = distances};
  if (conditions.on_inner_faces()) {
    result = {.lengths = {distances.begin() + 1, distances.end() - 1}, .conductances = widths};
  } else if (conditions.on_faces) {
    result = {.lengths = {distances.begin(), distances.end() - 1}, .conductances = {widths.back()}};
    result.conductances.insert(result.conductances.end(), widths.begin(), widths.end());
  }
  for (double& conductance : result.conductances) conductance = 1.0 / conductance;
  if (conditions.periodic || conditions.on_faces) return result;
  if (conditions.low == EndCondition::neumann) result.conductances.front() = 0.0;
  if (conditions.high == EndCondition::neumann) result.conductances.back() = 0.0;
  return result;
}

AxisModes axis_modes(const PoissonProblem& problem, std::size_t axis) {
  if (!problem.is_stretched(axis)) return analytic_modes(problem, axis);
  const StretchedAxis difference = stretched_axis(problem, axis);
  const std::size_t n = difference.lengths.size();
  const bool periodic = problem.axes[axis].periodic;
  AxisModes modes;
  modes.forward = symmetric_eigenpairs(similar_matrix(difference, periodic)).vectors;
  const bool has_constant =
      periodic || (difference.conductances.front() == 0.0 && difference.conductances.back() == 0.0);
  if (has_constant) make_constant_exact(difference.lengths, modes.forward);
  for (std::size_t k = 0; k < n; ++k)
    modes.eigenvalues.push_back(
        k == 0 && has_constant ? 0.0 : -rayleigh_quotient(difference, periodic, &modes.forward[k * n]));
  modes.backward = modes.forward;
  for (std::size_t entry = 0; entry < n * n; ++entry) {
    const double root = std::sqrt(difference.lengths[entry % n]);
    modes.forward[entry] *= root;
    modes.backward[entry] /= root;
  }
  return modes;
}

}  // namespace drogue::linear
