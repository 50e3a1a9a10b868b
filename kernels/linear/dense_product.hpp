#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"

#if defined(KOKKOS_ENABLE_CUDA) && !defined(DROGUE_EXACT)
#include <cublas_v2.h>
#endif

namespace drogue::linear {

/// Product of a three-dimensional array, x fastest, with a square matrix along an axis. Every entry is a sum
/// in the order of k, whatever computes it.
struct AxisProduct {
  int n;            ///< cells along the axis of the product
  int inner;        ///< numbers between neighbours along this axis
  bool transposed;  ///< multiplies by the transpose: forward transform
  const double *matrix, *from;
  double* to;

  /// Dimensionless factor of entry k of a line of `from` in entry `row` of the line of `to`. Does not throw.
  [[nodiscard]] KOKKOS_FUNCTION double factor(int row, int k) const {
    return transposed ? matrix[static_cast<std::int64_t>(row) * n + k]
                      : matrix[static_cast<std::int64_t>(k) * n + row];
  }
};

/// Row `line` of a product, all of its entries along the faster axes: for hosts, whose compilers vectorise
/// it.
struct DenseProductFunctor {
  AxisProduct product;

  KOKKOS_FUNCTION void operator()(const int line) const {
    const AxisProduct& p = product;
    const int row = line % p.n;
    const double* source = p.from + static_cast<std::int64_t>(line - row) * p.inner;
    double* target = p.to + static_cast<std::int64_t>(line) * p.inner;
    for (int x = 0; x < p.inner; ++x) target[x] = 0.0;
    for (int k = 0; k < p.n; ++k, source += p.inner) {
      const double factor = p.factor(row, k);
      for (int x = 0; x < p.inner; ++x) target[x] += factor * source[x];
    }
  }
};

/// One entry of a product: for devices, which need many threads.
struct DenseProductEntryFunctor {
  AxisProduct product;

  KOKKOS_FUNCTION void operator()(const int entry) const {
    const AxisProduct& p = product;
    const int line = entry / p.inner, row = line % p.n;
    const double* source = p.from + static_cast<std::int64_t>(line - row) * p.inner + entry % p.inner;
    double sum = 0.0;
    for (int k = 0; k < p.n; ++k, source += p.inner) sum += p.factor(row, k) * *source;
    p.to[entry] = sum;
  }
};

/// Products of three-dimensional arrays, x fastest, with square matrices along one axis.
template <class ExecutionSpace>
class DenseProduct {
 public:
  using List = Kokkos::View<double*, typename ExecutionSpace::memory_space>;

  /// Products on `space`, with numbers of any unit. Does not throw.
  explicit DenseProduct(const ExecutionSpace& space) : _space(space) {}

  /// to = M^T from (`transposed`) or M from along `axis`, with the n x n matrix M, column after column, of
  /// fewer than 2^31 numbers. Asynchronous; `from` and `to` must not overlap. Does not throw.
  void along_axis(const std::array<int, 3>& cells, std::size_t axis, const List& matrix, bool transposed,
                  const List& from, const List& to) const {
    int inner = 1, lines = 1;
    for (std::size_t a = 0; a < 3; ++a) (a < axis ? inner : lines) *= cells[a];
    const AxisProduct product{.n = cells[axis],
                              .inner = inner,
                              .transposed = transposed,
                              .matrix = matrix.data(),
                              .from = from.data(),
                              .to = to.data()};
    if constexpr (device::is_host<ExecutionSpace>)
      device::launch_each(_space, "drogue::linear::dense_product", lines, DenseProductFunctor{product});
    else
      device::launch_each(_space, "drogue::linear::dense_product", inner * lines,
                          DenseProductEntryFunctor{product});
  }

 private:
  ExecutionSpace _space;
};

#if defined(KOKKOS_ENABLE_CUDA) && !defined(DROGUE_EXACT)
/// By cuBLAS, which uses the FP64 tensor cores; not in the preset exact, since it sums in another order.
template <>
class DenseProduct<Kokkos::Cuda> {
 public:
  using List = Kokkos::View<double*, Kokkos::CudaSpace>;

  /// Products on `space`, with numbers of any unit. Throws std::runtime_error for an error of cuBLAS.
  explicit DenseProduct(const Kokkos::Cuda& space)
      : _workspace(Kokkos::view_alloc(space, Kokkos::WithoutInitializing, "drogue::linear::cublas_workspace"),
                   workspace_bytes) {
    cublasHandle_t handle = nullptr;
    check(cublasCreate(&handle));
    _handle = std::shared_ptr<cublasContext>(handle, [](cublasHandle_t h) { cublasDestroy(h); });
    check(cublasSetStream(handle, space.cuda_stream()));
    // A workspace of its own: cuBLAS would allocate inside a captured step.
    check(cublasSetWorkspace(handle, _workspace.data(), workspace_bytes));
  }

  /// As for other spaces. Asynchronous. Throws std::runtime_error for an error of cuBLAS.
  void along_axis(const std::array<int, 3>& cells, std::size_t axis, const List& matrix, bool transposed,
                  const List& from, const List& to) const {
    const int nx = cells[0], ny = cells[1], nz = cells[2];
    const double one = 1.0, zero = 0.0;
    const cublasOperation_t left = transposed ? CUBLAS_OP_T : CUBLAS_OP_N;
    const cublasOperation_t right = transposed ? CUBLAS_OP_N : CUBLAS_OP_T;
    if (axis == 0)
      check(cublasDgemm(_handle.get(), left, CUBLAS_OP_N, nx, ny * nz, nx, &one, matrix.data(), nx,
                        from.data(), nx, &zero, to.data(), nx));
    else if (axis == 1)
      check(cublasDgemmStridedBatched(_handle.get(), CUBLAS_OP_N, right, nx, ny, ny, &one, from.data(), nx,
                                      static_cast<long long>(nx) * ny, matrix.data(), ny, 0, &zero, to.data(),
                                      nx, static_cast<long long>(nx) * ny, nz));
    else
      check(cublasDgemm(_handle.get(), CUBLAS_OP_N, right, nx * ny, nz, nz, &one, from.data(), nx * ny,
                        matrix.data(), nz, &zero, to.data(), nx * ny));
  }

 private:
  static constexpr std::size_t workspace_bytes = std::size_t{32} << 20U;
  static void check(cublasStatus_t status) {
    if (status != CUBLAS_STATUS_SUCCESS)
      throw std::runtime_error(std::string("cuBLAS: ") + cublasGetStatusString(status));
  }

  Kokkos::View<char*, Kokkos::CudaSpace> _workspace;
  std::shared_ptr<cublasContext> _handle;
};
#endif

}  // namespace drogue::linear
