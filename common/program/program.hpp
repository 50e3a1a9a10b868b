#pragma once

#include <functional>
#include <string>

#include "common/program/failure.hpp"

namespace drogue {

/// The exception being handled, as what the user is told. Call it inside a catch block only.
///
/// A Failure stays itself; a CLI11 error becomes `usage`; lack of memory and everything unforeseen become
/// `io_error`, the first line of what() kept, so that no program ends with an exit code that is not
/// documented.
Failure current_failure();

/// Runs `body` and returns the exit code of the process. Whatever `body` throws ends as one sentence on
/// stderr: `program: sentence`, or for an invalid scene the sentence alone, which starts with FILE:LINE.
/// Under mpirun only rank 0 prints: what the others write to stdout goes nowhere.
int run_program(const std::string& program, const std::function<ExitCode()>& body);

}  // namespace drogue
