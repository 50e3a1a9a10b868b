#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// DROGUE_FOR_EACH_BACKEND(X) is X(serial) X(openmp) X(cuda) for those that this build holds: for what is
/// written once a backend and found by its name.
#if defined(DROGUE_HAVE_SERIAL)
#define DROGUE_ON_SERIAL(X) X(serial)
#else
#define DROGUE_ON_SERIAL(X)
#endif
#if defined(DROGUE_HAVE_OPENMP)
#define DROGUE_ON_OPENMP(X) X(openmp)
#else
#define DROGUE_ON_OPENMP(X)
#endif
#if defined(DROGUE_HAVE_CUDA)
#define DROGUE_ON_CUDA(X) X(cuda)
#else
#define DROGUE_ON_CUDA(X)
#endif
#define DROGUE_FOR_EACH_BACKEND(X) DROGUE_ON_SERIAL(X) DROGUE_ON_OPENMP(X) DROGUE_ON_CUDA(X)

namespace drogue::device {

enum class Backend { serial, openmp, cuda };

[[nodiscard]] std::string_view name(Backend backend);
[[nodiscard]] std::optional<Backend> backend_from_name(std::string_view name);

/// Those this build holds, slowest first.
[[nodiscard]] std::vector<Backend> compiled_backends();

/// Asks the driver, without initialising Kokkos. Host backends are always present.
[[nodiscard]] bool is_present(Backend backend);

/// The fastest backend that is compiled in and present.
[[nodiscard]] Backend fastest_backend();

/// What the value of an option `--backend` means: the fastest for "auto", else the one of that name, which
/// must be one (std::bad_optional_access).
[[nodiscard]] Backend wanted_backend(std::string_view option);

/// Why `backend` cannot run here, or nothing: not compiled in, or no device. Says which build has it.
[[nodiscard]] std::optional<std::string> why_unavailable(Backend backend);

}  // namespace drogue::device
