#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

// Forward declarations, which let code without Kokkos name the execution spaces.
namespace Kokkos {
class Serial;
class OpenMP;
class HIP;
class Cuda;
}  // namespace Kokkos

// CMake defines DROGUE_HAVE_NAME for each backend in DROGUE_BACKENDS (cmake/DrogueBackends.cmake).
#if defined(DROGUE_HAVE_SERIAL)
#define DROGUE_COMPILED_SERIAL true
#define DROGUE_EXTERN_SERIAL(Class, ...) \
  extern template Class<Kokkos::Serial __VA_OPT__(, __VA_ARGS__<Kokkos::Serial>)>;
#else
#define DROGUE_COMPILED_SERIAL false
#define DROGUE_EXTERN_SERIAL(...)
#endif
#if defined(DROGUE_HAVE_OPENMP)
#define DROGUE_COMPILED_OPENMP true
#define DROGUE_EXTERN_OPENMP(Class, ...) \
  extern template Class<Kokkos::OpenMP __VA_OPT__(, __VA_ARGS__<Kokkos::OpenMP>)>;
#else
#define DROGUE_COMPILED_OPENMP false
#define DROGUE_EXTERN_OPENMP(...)
#endif
#if defined(DROGUE_HAVE_HIP)
#define DROGUE_COMPILED_HIP true
#define DROGUE_EXTERN_HIP(Class, ...) \
  extern template Class<Kokkos::HIP __VA_OPT__(, __VA_ARGS__<Kokkos::HIP>)>;
#else
#define DROGUE_COMPILED_HIP false
#define DROGUE_EXTERN_HIP(...)
#endif
#if defined(DROGUE_HAVE_CUDA)
#define DROGUE_COMPILED_CUDA true
#define DROGUE_EXTERN_CUDA(Class, ...) \
  extern template Class<Kokkos::Cuda __VA_OPT__(, __VA_ARGS__<Kokkos::Cuda>)>;
#else
#define DROGUE_COMPILED_CUDA false
#define DROGUE_EXTERN_CUDA(...)
#endif

// Declares the instances of a class template that a source of a folder instances/ compiles for each backend.
// The second argument is a template of its second argument, if it has one.
#define DROGUE_EXTERN_INSTANCES(...) \
  DROGUE_EXTERN_SERIAL(__VA_ARGS__)  \
  DROGUE_EXTERN_OPENMP(__VA_ARGS__)  \
  DROGUE_EXTERN_HIP(__VA_ARGS__)     \
  DROGUE_EXTERN_CUDA(__VA_ARGS__)

namespace drogue::device {

/// Backends that the sources support, slowest first. A build contains some of them.
enum class Backend { serial, openmp, hip, cuda };

/// Entry of the backend list: the identifier, its name on the command line, the preset that builds it,
/// whether it starts on no machine without a device, whether this build has it, and its execution space. The
/// class may be incomplete. cmake/DrogueBackends.cmake holds the same list, and CMake stops if one differs.
struct SerialBackend {
  static constexpr Backend backend = Backend::serial;
  static constexpr std::string_view name = "serial";
  static constexpr std::string_view preset = "host";
  static constexpr bool needs_device = false;
  static constexpr bool is_compiled = DROGUE_COMPILED_SERIAL;
  using ExecutionSpace = Kokkos::Serial;
};

struct OpenMPBackend {
  static constexpr Backend backend = Backend::openmp;
  static constexpr std::string_view name = "openmp";
  static constexpr std::string_view preset = "host";
  static constexpr bool needs_device = false;
  static constexpr bool is_compiled = DROGUE_COMPILED_OPENMP;
  using ExecutionSpace = Kokkos::OpenMP;
};

struct HipBackend {
  static constexpr Backend backend = Backend::hip;
  static constexpr std::string_view name = "hip";
  static constexpr std::string_view preset = "hip";
  static constexpr bool needs_device = true;
  static constexpr bool is_compiled = DROGUE_COMPILED_HIP;
  using ExecutionSpace = Kokkos::HIP;
};

struct CudaBackend {
  static constexpr Backend backend = Backend::cuda;
  static constexpr std::string_view name = "cuda";
  static constexpr std::string_view preset = "cuda";
  static constexpr bool needs_device = true;
  static constexpr bool is_compiled = DROGUE_COMPILED_CUDA;
  using ExecutionSpace = Kokkos::Cuda;
};

/// Supported backends in the order of `Backend`.
using KnownBackends = std::tuple<SerialBackend, OpenMPBackend, HipBackend, CudaBackend>;

namespace implementation {

template <class Entry>
using OneIfCompiled = std::conditional_t<Entry::is_compiled, std::tuple<Entry>, std::tuple<>>;

template <class... Entries>
auto compiled_of(std::tuple<Entries...>) -> decltype(std::tuple_cat(OneIfCompiled<Entries>{}...));

template <class ExecutionSpace, class... Entries>
constexpr Backend backend_of(std::tuple<Entries...>) {
  Backend found{};
  ((std::is_same_v<ExecutionSpace, typename Entries::ExecutionSpace> ? void(found = Entries::backend)
                                                                     : void()),
   ...);
  return found;
}

template <class Function, class Entry, class... Entries>
auto dispatch(Backend backend, const Function& function, std::tuple<Entry, Entries...>) {
  if (backend == Entry::backend) return function.template operator()<typename Entry::ExecutionSpace>();
  if constexpr (sizeof...(Entries) > 0)
    return dispatch(backend, function, std::tuple<Entries...>{});
  else
    throw std::invalid_argument("this build lacks the requested backend");
}

}  // namespace implementation

/// Backends that this build contains, slowest first.
using CompiledBackends = decltype(implementation::compiled_of(KnownBackends{}));

/// Backend of an execution space, which must be in the list.
template <class ExecutionSpace>
inline constexpr Backend backend_of = implementation::backend_of<ExecutionSpace>(KnownBackends{});

/// Calls `function.operator()<ExecutionSpace>()` for the execution space of `backend` and returns its result.
/// Instantiates the function for each compiled backend. Throws std::invalid_argument if the build lacks the
/// backend.
///
///     device::dispatch(backend, [&]<class ExecutionSpace>() { return make_solver<ExecutionSpace>(p); });
template <class Function>
auto dispatch(Backend backend, const Function& function) {
  return implementation::dispatch(backend, function, CompiledBackends{});
}

/// Calls `function(entry)` for each entry of the list `Backends`.
template <class Backends, class Function>
constexpr void for_each_backend(const Function& function) {
  std::apply([&](const auto&... entries) { (function(entries), ...); }, Backends{});
}

/// Whether the backend starts on no machine without a device, such as a GPU. Does not throw.
constexpr bool needs_device(Backend backend) {
  bool needs = false;
  for_each_backend<KnownBackends>([&](const auto& entry) {
    if (entry.backend == backend) needs = entry.needs_device;
  });
  return needs;
}

}  // namespace drogue::device
