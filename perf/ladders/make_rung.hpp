#pragma once

#include <memory>

#include "perf/ladders/ladder.hpp"

namespace drogue::perf::ladder {

/// Rung of class `Type`, which has a `text` and a static function `work`, and is made from the problem.
/// `Type::available` and `Type::tolerance` replace the defaults if present. `problem` lives as long as the
/// rung and its runs.
template <class Type, class Problem>
Rung make_rung(const std::shared_ptr<const Problem>& problem, double tolerance) {
  Rung rung{.text = Type::text,
            .work = Type::work(*problem),
            .tolerance = tolerance,
            .available = true,
            .make = [problem]() -> std::unique_ptr<RungRun> { return std::make_unique<Type>(*problem); }};
  if constexpr (requires { Type::available; }) rung.available = Type::available;
  if constexpr (requires { Type::tolerance; }) rung.tolerance = Type::tolerance;
  return rung;
}

}  // namespace drogue::perf::ladder
