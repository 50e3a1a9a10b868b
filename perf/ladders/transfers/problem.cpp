#include "perf/ladders/transfers/problem.hpp"

#include <utility>

namespace drogue::perf::ladder {

TransferProblem make_transfer_problem(std::size_t values, long steps) {
  TransferProblem problem{{}, {}, steps};
  double before = 0.0, fibonacci = 1.0;  // F_k and F_{k+1}
  for (long k = 0; k < steps; ++k) before = std::exchange(fibonacci, before + fibonacci);
  for (std::size_t i = 0; i < values; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(values);
    problem.start.push_back(x);
    problem.expected.push_back(((fibonacci - before) * x + before) / (before * x + fibonacci));
  }
  return problem;
}

Work transfer_work(const TransferProblem& problem, double launches, double copies, double moves) {
  const auto values = static_cast<double>(problem.start.size());
  Work work;
  work.launches = launches;
  work.copies = copies;
  work.copied_bytes = 8.0 * moves * values;
  work.bytes = 16.0 * values;
  work.flops = work.divisions = values;
  work.packed = true;
  return work;
}

}  // namespace drogue::perf::ladder
