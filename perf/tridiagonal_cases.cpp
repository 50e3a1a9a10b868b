#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "kernels/linear/positive.hpp"
#include "kernels/options/line_solve.hpp"
#include "kernels/reference/linear/tridiagonal.hpp"
#include "perf/measurement.hpp"

namespace drogue::perf {

namespace {

constexpr double tridiagonal_bar = 1e-12;  ///< of the largest unknown
constexpr int checked_lines = 64;

/// The equations of a step of as many options: diffusion, drift and length of a step that differ.
options::Lines random_lines(int count, int nodes) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  options::Lines all;
  all.nodes = nodes;
  for (int k = 0; k < count; ++k) {
    const double diffusion = between(20.0, 500.0), drift = between(-0.3, 0.3) * diffusion;
    const double rate = between(20.0, 300.0), lower = diffusion - drift, upper = diffusion + drift;
    all.lines.push_back({lower, rate + lower + upper, upper, between(0.0, 1.0)});
    for (int i = 0; i < nodes; ++i) all.right.push_back(rate * between(0.0, 1.0));
  }
  return all;
}

/// x_i = scale^i z_i makes a line's matrix symmetric; node 0 goes to the right side.
double scale_of(const options::Line& line) { return std::sqrt(line.lower / line.upper); }

linear::PositiveSystems positive_systems(const options::Lines& lines) {
  linear::PositiveSystems all;
  all.batch = static_cast<int>(lines.lines.size());
  all.unknowns = lines.nodes - 1;
  const double* right = lines.right.data();
  for (const options::Line& line : lines.lines) {
    const double scale = scale_of(line);
    double power = 1.0;
    for (int i = 1; i < lines.nodes; ++i) {
      power *= scale;
      const bool last = i + 1 == lines.nodes;
      all.diagonal.push_back(last ? options::pivot(line) : line.diagonal);
      if (!last) all.beside.push_back(-std::sqrt(line.lower * line.upper));
      all.right.push_back((right[i] + (i == 1 ? line.lower * line.edge : 0.0)) / power);
    }
    right += lines.nodes;
  }
  return all;
}

/// The lines' unknowns, without node 0, where that is not part of `solved`.
std::vector<double> unknowns_of(const options::Lines& lines, int k, const std::vector<double>& solved) {
  const auto width = solved.size() / lines.lines.size(), nodes = static_cast<std::size_t>(lines.nodes);
  const auto row = solved.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * width);
  std::vector<double> x(row + static_cast<std::ptrdiff_t>(width + 1 - nodes),
                        row + static_cast<std::ptrdiff_t>(width));
  if (width == nodes) return x;
  const double scale = scale_of(lines.lines[static_cast<std::size_t>(k)]);
  double power = 1.0;
  for (double& value : x) value *= power *= scale;
  return x;
}

/// Of the first lines: elimination with pivots in long double takes its time.
double error_of_lines(const options::Lines& lines, const std::vector<double>& solved) {
  double largest = 0.0;
  const auto n = static_cast<std::size_t>(lines.nodes);
  for (int k = 0; k < std::min(checked_lines, static_cast<int>(lines.lines.size())); ++k) {
    const options::Line& line = lines.lines[static_cast<std::size_t>(k)];
    std::vector<double> below(n, -line.lower), diagonal(n, line.diagonal), above(n, -line.upper);
    const auto first = lines.right.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * n);
    std::vector<double> right(first, first + static_cast<std::ptrdiff_t>(n));
    diagonal.front() = 1.0, above.front() = 0.0, right.front() = line.edge;
    diagonal.back() = options::pivot(line);
    const std::vector<double> truth = reference::solve_tridiagonal(below, diagonal, above, right);
    const std::vector<double> x = unknowns_of(lines, k, solved);
    const double most = std::abs(*std::ranges::max_element(truth, {}, [](double v) { return std::abs(v); }));
    for (std::size_t i = 0; i < x.size(); ++i)
      largest = std::max(largest, std::abs(x[i] - truth[i + 1]) / most);
  }
  return largest;
}

Case tridiagonal_case(device::Backend backend, bool by_pttrf, int count, int nodes) {
  struct Run {
    options::Lines lines;
    std::unique_ptr<linear::BatchSolve> solve;
  };
  const auto run = std::make_shared<Run>();
  const std::string name(device::name(backend));
  const std::string variant = (by_pttrf ? "pttrf/" : "scan/") + std::to_string(nodes);
  return {"tridiagonal/" + name + "/" + std::to_string(count) + "/" + variant,
          "batch",
          by_pttrf ? "memory, on a host divisions that wait for one another" : "memory, on a host arithmetic",
          [=] {
            run->lines = random_lines(count, nodes);
            run->solve = by_pttrf ? create_positive_solve(backend, positive_systems(run->lines))
                                  : create_line_solve(backend, run->lines);
            return Sample{[=] { run->solve->reset(); },
                          [=] {
                            run->solve->run();
                            return 1L;
                          }};
          },
          [=] { return error_of_lines(run->lines, run->solve->solution()); },
          tridiagonal_bar,
          [=] {
            return Facts{name, count, variant};
          }};
}

}  // namespace

std::vector<Case> tridiagonal_cases(bool quick) {
  std::vector<Case> cases;
  for (const device::Backend backend : device::compiled_backends()) {
    if (!device::is_present(backend)) continue;
    for (const int nodes : quick ? std::vector{64} : std::vector{128, 256})
      for (const bool by_pttrf : {true, false})
        cases.push_back(tridiagonal_case(backend, by_pttrf, quick ? 64 : 4096, nodes));
  }
  return cases;
}

}  // namespace drogue::perf
