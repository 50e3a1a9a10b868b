#pragma once

#include "perf/ladders/weno/library_rung.hpp"

namespace drogue::perf::ladder {

/// Rung 10. Nonlinear weights in single precision, differences, linear flux and update in double. The
/// corrections are small where the flow is smooth, and so is their error.
///
/// Prediction: nine tenths of the operations in single precision, at half the cost: 0.55 of the arithmetic.
template <class ExecutionSpace>
Rung split_precision_rung(const Shared<WenoProblem>& problem) {
  Work work = library_work(*problem,
                           device::is_host<ExecutionSpace> ? 2.0 : 1.0 / static_cast<double>(problem->steps));
  work.flops *= 0.55, work.divisions *= 0.55;
  Rung rung = make_rung<LibraryRung<ExecutionSpace>>(
      RungText{"split-precision", "Nonlinear terms in single precision.",
               "On a host this rung loses: conversions and the scaling that keeps products of weights "
               "within the range of a float cost more than narrow operations save. On an H100 at 8192 "
               "cells, where waiting is the bound, it loses too: 5.63 us, after 5.25 us in double "
               "precision (docs/lessons/tables.md). On an H200 it wins from a million cells on "
               "(docs/gas-notebook.md)."},
      work, problem, gas::Driver::automatic, gas::Precision::split);
  rung.tolerance = 1e-5;
  return rung;
}

}  // namespace drogue::perf::ladder
