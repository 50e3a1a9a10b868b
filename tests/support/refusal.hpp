#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/program/failure.hpp"

namespace drogue::testing {

/// Message of the `Failure` with this exit code that an action ends in; empty if it succeeds.
template <class Action>
std::string refusal_of(const Action& action, ExitCode code = ExitCode::invalid_scene) {
  try {
    static_cast<void>(action());
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), code) << failure.what();
    return failure.what();
  }
  return {};
}

}  // namespace drogue::testing
