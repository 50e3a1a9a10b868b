#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/options/levy/hankel_table.hpp"
#include "kernels/options/pricer.hpp"
#include "kernels/reference/options/levy.hpp"
#include "kernels/reference/options/printed_scheme.hpp"
#include "kernels/reference/options/scheme.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/option_sets.hpp"

// Node values against a serial reference solve with weights from quadrature of the printed density.

namespace drogue::options {
namespace {

constexpr const auto& backend = testing::tested_backend;

/// Moves the part of the shortest jumps to finite differences that leaves the same variance and the same
/// drift to the weights as on the grid of step 2 h, whose weights are twice those of even d, and once that
/// of 2.
void share_with_coarser_grid(reference::JumpTable& table, double h) {
  double variance = 0.0, price = 0.0;
  for (std::size_t d = 1; d < table.up.size(); ++d) {
    const double y = static_cast<double>(d) * h, more = d % 2 == 1 ? 1.0 : d == 2 ? 0.0 : -1.0;
    variance += more * (table.up[d] + table.down[d]) * y * y;
    price += more * (table.up[d] * std::expm1(y) + table.down[d] * std::expm1(-y));
  }
  table.moved = std::clamp(0.5 * variance, 0.0, std::max(0.0, 0.5 * table.remaining_variance));
  const double both = 2.0 * table.moved / (h * h),
               up = (price - both * std::expm1(-h)) / (std::expm1(h) - std::expm1(-h));
  table.up[1] -= up;
  table.down[1] -= both - up;
  table.remaining_variance += 2.0 * table.moved;
}

/// Jumps of a put on a grid, by adaptive quadrature of the density.
reference::JumpTable table_of(const reference::GeneralizedHyperbolic& measure, double variance, int mesh,
                              double h) {
  reference::JumpTable table;
  table.up.resize(static_cast<std::size_t>(mesh) + 1);
  table.down = table.up;
  const double length = mesh * h;
  table.remaining_variance =
      variance + reference::levy_variance(measure) - reference::levy_tail_variance(measure, length);
  for (int d = 1; d <= mesh; ++d) {
    const double y = d * h, part = d == 1 || d == mesh ? 0.5 * h : h;
    const double up = part * reference::levy_density(measure, y),
                 down = part * reference::levy_density(measure, -y);
    table.up[static_cast<std::size_t>(d)] = up;
    table.down[static_cast<std::size_t>(d)] = down;
    table.remaining_variance -= (up + down) * y * y;
  }
  share_with_coarser_grid(table, h);
  table.tail_up = reference::levy_tail(measure, length, 1, 0);
  table.tail_down = reference::levy_tail(measure, length, -1, 0);
  table.tail_up_price = reference::levy_tail(measure, length, 1, 1);
  table.tail_down_price = reference::levy_tail(measure, length, -1, 1);
  return table;
}

/// Largest difference of a node value, as a fraction of the strike.
double difference(const Contract& c, int mesh, int steps) {
  Settings settings;
  settings.mesh = mesh;
  settings.steps = steps;
  std::vector<ProfilePoint> profile = create_pricer(backend, settings)->profile(c);
  const bool call = c.type == Type::call;
  reference::PutProblem problem{};
  problem.rate = call ? c.dividend : c.rate;
  problem.dividend = call ? c.rate : c.dividend;
  problem.maturity = c.maturity;
  problem.american = c.style == Style::american;
  problem.mesh = mesh;
  problem.steps = steps;
  if (call) std::reverse(profile.begin(), profile.end());
  const auto x = [&](std::size_t k) { return std::log(profile[k].spot / c.strike) * (call ? -1.0 : 1.0); };
  problem.h = (x(static_cast<std::size_t>(mesh)) - x(0)) / mesh;
  problem.strike = static_cast<int>(std::lround(-x(0) / problem.h));
  const reference::GeneralizedHyperbolic measure{c.jump[0], c.jump[1], call ? -c.jump[2] - 1.0 : c.jump[2],
                                                 c.jump[3]};
  const std::vector<double> expected = solve_put(problem, table_of(measure, c.variance, mesh, problem.h));
  double worst = 0.0;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const double unit = call ? profile[k].spot : c.strike;
    worst = std::max(worst, std::abs(profile[k].price / unit - expected[k]));
  }
  return worst;
}

// ctest-label: smoke
TEST(OptionsOracle, NodeValuesOfRandomContractsMatchTheSerialSolve) {
  for (const Contract& c : testing::random_contracts(12, 5))
    EXPECT_LT(difference(c, 48, 12), 1e-7) << "lambda " << c.jump[0] << " alpha " << c.jump[1] << " beta "
                                           << c.jump[2] << " delta " << c.jump[3];
}

// For large orders the nodes of the mixture are denser in places. Maturities of a day: steps are dominated by
// jumps.
// ctest-label: no-sanitizer
TEST(OptionsOracle, NodeValuesOfLargeOrdersMatchTheSerialSolve) {
  const double rows[6][4] = {{-2.5, 8.0, -2.0, 0.8},   {6.0, 18.0, -2.0, 0.8},   {-9.5, 12.0, 4.0, 1.5},
                             {-30.0, 20.0, -8.0, 3.0}, {50.0, 30.0, -2.5, 10.0}, {-127.0, 30.0, -2.5, 10.0}};
  Contract c;
  c.rate = 0.05;
  for (const auto& row : rows) {
    for (int k = 0; k < 4; ++k) c.jump[k] = row[k];
    c.maturity = c.maturity == 1.0 ? 1.0 / 365 : 1.0;
    EXPECT_LT(difference(c, 48, 12), 3e-7) << row[0];
  }
}

// Stiff jumps require the added implicit diffusion; a high rate truncates the grid at the exercise boundary.
TEST(OptionsOracle, NodeValuesOfStiffAndPureJumpsMatchTheSerialSolve) {
  Contract c;
  c.rate = 0.2;
  c.maturity = 3.0;
  const double rows[4][4] = {
      {-0.5, 15.0, -5.0, 0.5}, {2.0, 11.0, -5.0, 0.0}, {5.0, 18.0, -2.0, 0.8}, {-0.5, 15.0, -0.5, 5.0}};
  for (const auto& row : rows) {
    for (int k = 0; k < 4; ++k) c.jump[k] = row[k];
    EXPECT_LT(difference(c, 64, 16), 1e-6) << row[0];
  }
}

// This mesh sums over jumps by transforms; `solve_put` sums directly.
TEST(OptionsOracle, NodeValuesOfATransformedMeshMatchTheSerialSolve) {
  EXPECT_LT(difference(testing::random_contracts(1, 6)[0], 256, 12), 1e-7);
}

/// Largest difference between prices of the baseline and a serial solve of the printed scheme, at nodes with
/// half to twice the strike.
double baseline_difference(Contract c, int mesh, int steps) {
  Settings settings;
  settings.method = Method::baseline;
  settings.mesh = mesh;
  settings.steps = steps;
  const reference::PrintedPut put{c.rate,
                                  c.dividend,
                                  c.maturity,
                                  c.variance,
                                  {c.jump[0], c.jump[1], c.jump[2], c.jump[3]},
                                  c.style == Style::american,
                                  4.0,
                                  mesh,
                                  steps};
  const std::vector<double> expected = solve_printed_put(put);
  std::vector<Contract> contracts;
  std::vector<double> nodes;
  for (int i = 0; i <= mesh; ++i) {
    const double x = 8.0 * i / mesh - 4.0;
    if (std::abs(x) > std::log(2.0)) continue;
    c.spot = c.strike * std::exp(x);
    contracts.push_back(c);
    nodes.push_back(expected[static_cast<std::size_t>(i)]);
  }
  std::vector<Price> prices(contracts.size());
  create_pricer(backend, settings)->price(contracts, prices);
  double worst = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    worst = std::max(worst, std::abs(prices[k].price / c.strike - nodes[k]));
  return worst;
}

TEST(OptionsOracle, BaselineMatchesTheSerialSolveOfThePrintedScheme) {
  Contract c;
  c.rate = 0.1;
  c.dividend = 0.03;
  const double rows[4][5] = {{1.0, 8.15, -2.5, 0.767, 0.4},
                             {-0.5, 15.0, -5.0, 0.5, 0.1},
                             {-1.2, 9.0, 3.0, 0.3, 0.2},
                             {2.0, 11.0, -5.0, 0.0, 0.3}};
  for (const auto& row : rows)
    for (const Style style : {Style::american, Style::european}) {
      for (int k = 0; k < 4; ++k) c.jump[k] = row[k];
      c.variance = row[4];
      c.style = style;
      c.strike = style == Style::american ? 1.0 : 2.0;
      EXPECT_LT(baseline_difference(c, 48, 48), 1e-7) << row[0];
    }
}

/// Node of the table and the tabulated density there.
struct TableNode {
  double z, density;
};

TableNode table_node(double order, int node) {
  const std::vector<double> panel = hankel_panel(panel_of(order));
  const double begin = panel_begin(panel_of(order)), end = panel_end(panel_of(order));
  const double angle = std::acos((2.0 * order - begin - end) / (end - begin));
  double sum = 0.0;
  for (int k = 0; k < HankelGrid::terms; ++k)
    sum += panel[static_cast<std::size_t>(HankelGrid::log_m + node * HankelGrid::terms + k)] *
           std::cos(k * angle);
  return {std::exp(panel[static_cast<std::size_t>(HankelGrid::log_z + node)]), std::exp(sum)};
}

TEST(OptionsOracle, SpectralDensityMatchesBesselFunctions) {
  for (const double order : {0.0, 0.01, 0.3, 0.5, 0.77, 1.0, 1.6})
    for (int node = 40; node < HankelGrid::count; node += 5) {
      const auto [z, density] = table_node(order, node);
      const double j = std::cyl_bessel_j(order, z), y = std::cyl_neumann(order, z);
      const double expected = order == 0.5 ? z : 2.0 / (3.141592653589793 * (j * j + y * y));
      if (z > 900.0 && order != 0.5) continue;  // beyond the accuracy of the standard library
      EXPECT_NEAR(density / expected, 1.0, 2e-8) << order << ", z = " << z;
    }
}

}  // namespace
}  // namespace drogue::options
