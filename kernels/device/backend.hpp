#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Why `backend` cannot run here, or nothing: not compiled in, or no device. Says which build has it.
[[nodiscard]] std::optional<std::string> why_unavailable(Backend backend);

}  // namespace drogue::device
