#pragma once

#include "perf/ladders/transfers/transfer_rung.hpp"

namespace drogue::perf::ladder {

/// When values are copied: up once, down once.
struct OneUpload {
  template <class Up, class Compute, class Down>
  static void run(long steps, const Up& up, const Compute& compute, const Down& down) {
    up();
    for (long step = 0; step < steps; ++step) compute();
    down();
  }
};

/// Runs that copy as `Uploads` says.
template <class ExecutionSpace, class Uploads>
class OneUploadRung final : public TransferRung<ExecutionSpace> {
 public:
  using TransferRung<ExecutionSpace>::TransferRung;

  void run() override {
    const ExecutionSpace& space = this->_instance.space();
    Uploads::run(
        this->_problem.steps,
        [&] { device::copy_in(space, this->_device, this->_host.data(), this->_host.size()); },
        [&] {
          device::launch_each(space, "drogue::perf::ladder::fractions", static_cast<int>(this->_host.size()),
                              FractionFunctor<ExecutionSpace>{this->_device});
        },
        [&] { device::copy_out(space, this->_host.data(), this->_device, this->_host.size()); });
    space.fence("drogue::perf::ladder: values are on the host");
  }
};

/// Rung 5. The device owns the values: one copy up before the first step, one down after the last.
///
/// Prediction: a launch and the kernel per step, and the copies of the second rung divided by the steps.
template <class ExecutionSpace, class Uploads = OneUpload>
Rung one_upload_rung(const Shared<TransferProblem>& problem) {
  const auto steps = static_cast<double>(problem->steps);
  Work work = transfer_work(*problem, 1, 2 / steps, 2 / steps);
  work.pinned = true;
  return make_rung<OneUploadRung<ExecutionSpace, Uploads>>(
      RungText{"one-upload", "The device owns the values between the first step and the last.",
               "The largest gain of the ladder comes from work that is left out, not from work that is "
               "done faster; on a host as on a GPU. On an H100 the prediction holds: 143 us, where the "
               "model has 147 us (docs/lessons/tables.md)."},
      work, problem);
}

}  // namespace drogue::perf::ladder
