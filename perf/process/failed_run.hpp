#pragma once

#include <filesystem>
#include <string>

#include "common/program/failure.hpp"

namespace drogue::perf {

/// Failure of a run of a program of this suite on some `units`, such as "2 ranks", that ended with `status`
/// and wrote `log`. Its code is that of the program; usage if mpirun refused to start it; io_error for a
/// signal, a foreign code, or an end without a result. Its sentence holds that of the program or of mpirun.
/// Throws only std::bad_alloc.
Failure failed_run(const std::string& units, int status, const std::filesystem::path& log);

}  // namespace drogue::perf
