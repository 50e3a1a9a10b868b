#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/device/backend_list.hpp"

namespace drogue::device {

/// Name of a backend as on the command line, for example "openmp". Does not throw.
[[nodiscard]] std::string_view name(Backend backend);

/// Backend of that name, compiled in or not. Empty for an unknown name. Does not throw.
[[nodiscard]] std::optional<Backend> backend_from_name(std::string_view name);

/// Backends that this build contains, slowest first. Does not throw.
[[nodiscard]] std::vector<Backend> compiled_backends();

/// Whether the backend is compiled in and has a device. Queries the driver without initialising Kokkos. A
/// compiled host backend is always present. Does not throw.
[[nodiscard]] bool is_present(Backend backend);

/// Fastest backend that is compiled in and present; the slowest compiled one if none is present. Does not
/// throw.
[[nodiscard]] Backend fastest_backend();

/// Backend of an option `--backend`: the fastest for "auto", else the backend of that name. Throws
/// std::bad_optional_access for an unknown name.
[[nodiscard]] Backend wanted_backend(std::string_view option);

/// Reason why `backend` cannot run here, as a sentence that names the preset to build; empty if it can run.
/// Does not throw.
[[nodiscard]] std::optional<std::string> why_unavailable(Backend backend);

}  // namespace drogue::device
