#pragma once

#include <functional>
#include <string>

#include "common/program/failure.hpp"

namespace drogue {

/// Converts the exception that is being handled; call it in a catch block only.
///
/// A `Failure` is kept. A CLI11 error becomes `usage`. Lack of memory and all other exceptions become
/// `io_error` with the first line of what(), so that every program ends with a documented exit code.
Failure current_failure();

/// Prints `program: sentence` on stderr, under mpirun on rank 0 alone. Does not throw.
void print_notice(const std::string& program, const std::string& sentence);

/// Runs `body` and returns the exit code of the process. Prints an exception as one sentence on stderr:
/// `program: sentence`, or only the sentence for an invalid scene, which starts with FILE:LINE. Under mpirun
/// only rank 0 prints; stdout of the other ranks is discarded. Does not throw.
int run_program(const std::string& program, const std::function<ExitCode()>& body);

}  // namespace drogue
