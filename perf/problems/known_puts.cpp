#include "perf/problems/known_puts.hpp"

namespace drogue::perf {
namespace {

constexpr options::Contract thesis_contract{.rate = 0.1, .variance = 0.4, .jump = {1.0, 8.15, -2.5, 0.767}};
constexpr double day = 1.0 / 365.0;

}  // namespace

const KnownPuts& thesis_puts() {
  static const KnownPuts puts = {"thesis",
                                 thesis_contract,
                                 {1.0, 0.8, 0.9, 1.1, 1.2},
                                 {0.239004005, 0.318658312, 0.275403193, 0.208230166, 0.182096749}};
  return puts;
}

const std::vector<KnownPuts>& known_puts() {
  static const std::vector<KnownPuts> all = {
      thesis_puts(),
      {"five-years",
       {.rate = 0.1, .maturity = 5.0, .variance = 0.4, .jump = {1.0, 8.15, -2.5, 0.767}},
       {0.8, 0.9, 1.0, 1.1, 1.2},
       {0.439214241, 0.412142144, 0.388679947, 0.368075278, 0.349783538}},
      {"pure-jumps",
       {.rate = 0.05, .jump = {-0.5, 15.0, -5.0, 0.5}},
       {0.8, 0.9, 1.0, 1.1, 1.2},
       {0.2, 0.11228793, 0.05995326, 0.031011482, 0.015910025}},
      {"day",
       {.rate = 0.05, .maturity = day, .variance = 0.04, .jump = {-0.5, 15.0, -5.0, 0.5}},
       {0.95, 0.98, 1.0, 1.02, 1.05},
       {0.05, 0.020285823, 0.004904692, 0.000657209, 0.000216626}},
      {"merton",
       {.model = options::JumpModel::merton,
        .rate = 0.05,
        .maturity = 0.25,
        .variance = 0.0225,
        .jump = {0.1, -0.9, 0.45}},
       {0.9, 1.0, 1.1},
       {0.1000379, 0.03241251, 0.01419803}},
      {"black-scholes",
       {.model = options::JumpModel::black_scholes, .rate = 0.05, .variance = 0.04},
       {1.0},
       {0.06090371}}};
  return all;
}

}  // namespace drogue::perf
