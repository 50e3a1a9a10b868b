#pragma once

#include "perf/ladders/weno/differences.hpp"

namespace drogue::perf::ladder {

/// Rung 4 of the WENO ladder on packs of cells on a host, in which a division takes several times as long as
/// in numbers.
template <class ExecutionSpace, class Flux = DifferenceFlux>
class PackedDifferencesRung final : public WenoRung<ExecutionSpace> {
  using R = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

 public:
  static constexpr RungText text = DifferencesRung<ExecutionSpace>::text;

  static Work work(const WenoProblem& problem) {
    Work work = DifferencesRung<ExecutionSpace>::work(problem);
    work.packed = true;
    return work;
  }

  using WenoRung<ExecutionSpace>::WenoRung;

 protected:
  void step() override { launch_stages<Flux, R>(*this, "drogue::perf::ladder::packed_differences"); }
};

}  // namespace drogue::perf::ladder
