#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"
#include "kernels/device/pack.hpp"

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

/// Rows of a host's tile: with two packs across, its sums and their factors fit the vector registers.
inline constexpr int tile_rows = 4;

/// Product of `n` scalars per row with `n` rows of packs: sums of `rows` times `packs` packs in registers,
/// each in the order of k, on top of those in `to` if `adds`. Strides are in numbers.
template <class Pack, int rows, int packs>
void multiply_tile(int n, const double* scalars, std::int64_t scalar_row, std::int64_t scalar_k,
                   const double* vectors, std::int64_t vector_k, double* to, std::int64_t to_row, bool adds) {
  using Access = device::Access<Pack>;
  Pack sum[rows][packs] = {};  // gcc 12 takes those of scalars for uninitialised
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < packs; ++c)
      sum[r][c] = adds ? Access::load(to + r * to_row + c * Access::lanes) : Pack(0.0);
  for (int k = 0; k < n; ++k)
    for (int r = 0; r < rows; ++r) {
      const Pack scalar(scalars[r * scalar_row + k * scalar_k]);
      for (int c = 0; c < packs; ++c)
        sum[r][c] += scalar * Access::load(vectors + k * vector_k + c * Access::lanes);
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < packs; ++c) Access::store(to + r * to_row + c * Access::lanes, sum[r][c]);
}

/// Product along a slow axis on a host: a strip of `strip` numbers along the faster axes of one array of `n`
/// rows of `inner` numbers.
struct SlowAxisProductFunctor {
  static constexpr int strip = 64;
  AxisProduct product;

  /// Strips of a row. Does not throw.
  [[nodiscard]] static int strips(int inner) { return (inner + strip - 1) / strip; }

  void operator()(const int item) const {
    const AxisProduct& p = product;
    const std::int64_t array = static_cast<std::int64_t>(item / strips(p.inner)) * p.n * p.inner;
    const int begin = item % strips(p.inner) * strip, end = begin + strip < p.inner ? begin + strip : p.inner;
    using Pack = device::HostPack<double>;
    constexpr int lanes = device::Access<Pack>::lanes;
    int x = begin;
    for (; x + 2 * lanes <= end; x += 2 * lanes) multiply_columns<Pack, 2>(array + x);
    for (; x + lanes <= end; x += lanes) multiply_columns<Pack, 1>(array + x);
    for (; x < end; ++x) multiply_columns<double, 1>(array + x);
  }

  /// All rows of some packs from `first` on.
  template <class Pack, int packs>
  void multiply_columns(std::int64_t first) const {
    const AxisProduct& p = product;
    const std::int64_t row_stride = p.transposed ? p.n : 1, k_stride = p.transposed ? 1 : p.n;
    const auto multiply = [&]<int rows>(int row) {
      multiply_tile<Pack, rows, packs>(p.n, p.matrix + row * row_stride, row_stride, k_stride, p.from + first,
                                       p.inner, p.to + first + row * std::int64_t{p.inner}, p.inner, false);
    };
    int row = 0;
    for (; row + tile_rows <= p.n; row += tile_rows) multiply.template operator()<tile_rows>(row);
    for (; row < p.n; ++row) multiply.template operator()<1>(row);
  }
};

/// Product along the fastest axis on a host: some lines of `n` numbers.
struct FastAxisProductFunctor {
  static constexpr int batch = 64;
  AxisProduct product;
  int lines;

  void operator()(const int item) const {
    using Pack = device::HostPack<double>;
    constexpr int lanes = device::Access<Pack>::lanes;
    int row = 0;
    for (; row + 2 * lanes <= product.n; row += 2 * lanes) multiply_rows<Pack, 2>(item * batch, row);
    for (; row + lanes <= product.n; row += lanes) multiply_rows<Pack, 1>(item * batch, row);
    for (; row < product.n; ++row) multiply_rows<double, 1>(item * batch, row);
  }

  /// Entries from `row` on of the lines of a batch. Their factors are copied so that they are contiguous.
  template <class Pack, int packs>
  void multiply_rows(int first, int row) const {
    const AxisProduct& p = product;
    constexpr int width = packs * device::Access<Pack>::lanes, most = 128;
    double factors[most * width];
    const int end = first + batch < lines ? first + batch : lines;
    for (int begin = 0; begin < p.n; begin += most) {
      const int count = begin + most < p.n ? most : p.n - begin;
      for (int k = 0; k < count; ++k)
        for (int i = 0; i < width; ++i) factors[k * width + i] = p.factor(row + i, begin + k);
      const auto multiply = [&]<int rows>(int line) {
        const std::int64_t place = static_cast<std::int64_t>(line) * p.n;
        multiply_tile<Pack, rows, packs>(count, p.from + place + begin, p.n, 1, factors, width,
                                         p.to + place + row, p.n, begin > 0);
      };
      int line = first;
      for (; line + tile_rows <= end; line += tile_rows) multiply.template operator()<tile_rows>(line);
      for (; line < end; ++line) multiply.template operator()<1>(line);
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
    constexpr int batch = FastAxisProductFunctor::batch;
    if constexpr (!device::is_host<ExecutionSpace>)
      device::launch_each(_space, "drogue::linear::dense_product", inner * lines,
                          DenseProductEntryFunctor{product});
    else if (inner == 1)
      device::launch_each(_space, "drogue::linear::dense_product", (lines / product.n + batch - 1) / batch,
                          FastAxisProductFunctor{product, lines / product.n});
    else
      device::launch_each(_space, "drogue::linear::dense_product",
                          lines / product.n * SlowAxisProductFunctor::strips(inner),
                          SlowAxisProductFunctor{product});
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
