#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/program/signals.hpp"
#include "common/program/stopwatch.hpp"
#include "common/study/repeats.hpp"
#include "kernels/options/pricer.hpp"
#include "perf/problems/known_puts.hpp"
#include "perf/work_precision/solution.hpp"

namespace drogue::perf {

namespace {

constexpr study::Repeats options_repeats{20, 0.2};

/// Point of a curve: a method with its settings.
struct OptionsPoint {
  const char *method, *exercise = "", *grids = "";
  int intervals_per_step = 0;  ///< 0: the default number of steps
  options::Settings settings;
  options::Style style = options::Style::american;
};

std::vector<OptionsPoint> pide_points(bool quick) {
  std::vector<OptionsPoint> points;
  for (const int mesh : quick ? std::vector{64, 128} : std::vector{64, 128, 256, 512})
    for (const int intervals : {4, 2, 1})
      for (const bool single_grid : {false, true})
        for (const char* exercise : {"exact", "split", "none"}) {
          const bool split = *exercise == 's', none = *exercise == 'n';
          if (quick && intervals != 4) continue;
          points.push_back(
              {.method = "pide",
               .exercise = exercise,
               .grids = single_grid ? "one" : "two",
               .intervals_per_step = intervals,
               .settings = {.mesh = mesh,
                            .steps = mesh / intervals,
                            .exercise = split ? options::ExerciseRule::split : options::ExerciseRule::exact,
                            .single_grid = single_grid},
               .style = none ? options::Style::european : options::Style::american});
        }
  return points;
}

std::vector<OptionsPoint> other_points(const KnownPuts& puts, bool quick) {
  std::vector<OptionsPoint> points;
  if (puts.contract.model == options::JumpModel::generalized_hyperbolic)
    for (const int mesh : quick ? std::vector{64} : std::vector{64, 128, 256, 512})
      points.push_back({.method = "seed", .settings = {.method = options::Method::baseline, .mesh = mesh}});
  for (const double tolerance : quick ? std::vector{1e-2} : std::vector{1e-2, 1e-4, 1e-5, 1e-6, 1e-7})
    points.push_back({.method = "cos", .settings = {.method = options::Method::cos, .tolerance = tolerance}});
  return points;
}

/// Batch of `count` contracts that repeats the spots of `puts` cyclically.
std::vector<options::Contract> contracts_of(const KnownPuts& puts, options::Style style, std::size_t count) {
  std::vector<options::Contract> contracts(count, puts.contract);
  for (std::size_t k = 0; k < count; ++k) {
    contracts[k].style = style;
    contracts[k].spot = puts.spots[k % puts.spots.size()];
  }
  return contracts;
}

/// True prices of the contracts of a style, in the order of the spots.
std::vector<double> truths_of(const KnownPuts& puts, options::Style style) {
  if (style == options::Style::american) return puts.prices;
  const std::vector<options::Contract> contracts = contracts_of(puts, style, puts.spots.size());
  std::vector<options::Price> prices(contracts.size());
  options::create_pricer(device::Backend::serial, {.method = options::Method::cos})->price(contracts, prices);
  std::vector<double> truths;
  for (const options::Price& price : prices) truths.push_back(price.price);
  return truths;
}

/// Largest error of the batch; infinite if a price is not finite.
double largest_error(const std::vector<options::Price>& prices, const std::vector<double>& truths) {
  double largest = 0.0;
  for (std::size_t k = 0; k < prices.size(); ++k) {
    const double error = std::abs(prices[k].price - truths[k % truths.size()]);
    largest = std::isfinite(error) ? std::max(largest, error) : std::numeric_limits<double>::infinity();
  }
  return largest;
}

std::string label_of(const OptionsPoint& point) {
  std::string label = point.method;
  if (const std::string exercise = point.exercise; exercise == "split" || exercise == "none")
    label += " " + exercise;
  if (point.settings.single_grid) label += " one-grid";
  if (point.intervals_per_step == 2 || point.intervals_per_step == 1)
    label += " mesh/" + std::to_string(point.intervals_per_step);
  return label;
}

/// Size of a batch: a multiple of the lanes of every vector register, or enough to fill a large GPU. `cos`
/// spends most of its time on tables per contract, and gets smaller batches.
std::size_t batch_of(const KnownPuts& puts, device::Backend backend, options::Method method) {
  const bool gpu = backend == device::Backend::cuda;
  if (method == options::Method::cos) return gpu ? 256 : puts.spots.size();
  return gpu ? 4096 : 40;
}

Solution options_solution(const KnownPuts& puts, device::Backend backend, const OptionsPoint& point) {
  const std::size_t count = batch_of(puts, backend, point.settings.method);
  const std::vector<options::Contract> contracts = contracts_of(puts, point.style, count);
  std::vector<options::Price> prices(count);
  Solution s;
  s.problem = puts.name;
  s.backend = backend;
  s.label = label_of(point);
  s.scheme = {{"method", point.method}, {"exercise", point.exercise}, {"grids", point.grids}};
  if (point.intervals_per_step != 0) s.scheme["intervals_a_step"] = std::to_string(point.intervals_per_step);
  const auto pricer = create_pricer(backend, point.settings);
  if (point.settings.method != options::Method::cos)
    pricer->price(contracts, prices);  // allocates memory and tables for later batches
  while (!options_repeats.reached(s.samples)) {
    const Stopwatch stopwatch;
    pricer->price(contracts, prices);
    s.samples.push_back(stopwatch.seconds() / static_cast<double>(count));
  }
  s.steps = prices[0].steps;
  // The resolution of `cos` is its number of exercise dates.
  s.cells = point.settings.method == options::Method::cos ? prices[0].steps : prices[0].mesh;
  s.error = largest_error(prices, truths_of(puts, point.style));
  s.sound = std::isfinite(s.error);
  return s;
}

}  // namespace

bool options_work_precision(const Selection& selection, const SolutionSink& sink) {
  const bool quick = selection.quick;
  for (const KnownPuts& puts : known_puts()) {
    if (quick && &puts != &known_puts()[0] && std::string(puts.name) != "merton") continue;
    if (!selection.wants(puts.name)) continue;
    std::vector<OptionsPoint> points = pide_points(quick);
    std::ranges::copy(other_points(puts, quick), std::back_inserter(points));
    for (const device::Backend backend : selection.backends) {
      std::set<std::pair<std::string, std::int64_t>> done;
      for (const OptionsPoint& point : points) {
        if (interrupted()) return false;
        const Solution solution = options_solution(puts, backend, point);
        // Two tolerances may lead to the same number of dates.
        if (done.emplace(solution.label, solution.cells).second) sink(solution);
      }
    }
  }
  return true;
}

}  // namespace drogue::perf
