#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/linear/dense_product.hpp"

namespace drogue::linear {
namespace {

using Space = DROGUE_TEST_SPACE;
using List = DenseProduct<Space>::List;

#if defined(DROGUE_EXACT)
constexpr double round_off = 0.0;
#else
// Of both sums: per term, the unit round-off of each.
constexpr double round_off = 2.3e-16;
#endif

List to_device(const Space& space, const std::vector<double>& values) {
  List list("values", values.size());
  device::copy_in(space, list, values.data(), values.size());
  space.fence();
  return list;
}

/// Sums in the order of k, and what round-off of them can be at most, by the magnitude of their terms.
struct Sums {
  std::vector<double> value, magnitude;
};

Sums sums(const std::array<int, 3>& cells, std::size_t axis, bool transposed,
          const std::vector<double>& matrix, const std::vector<double>& from) {
  const std::size_t n = static_cast<std::size_t>(cells[axis]);
  std::size_t stride = 1;
  for (std::size_t a = 0; a < axis; ++a) stride *= static_cast<std::size_t>(cells[a]);
  Sums result{std::vector<double>(from.size()), std::vector<double>(from.size())};
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t row = i / stride % n;
    for (std::size_t k = 0; k < n; ++k) {
      const double term =
          (transposed ? matrix[row * n + k] : matrix[k * n + row]) * from[i + k * stride - row * stride];
      result.value[i] += term;
      result.magnitude[i] += std::abs(term);
    }
  }
  return result;
}

/// Lengths below, at and above the widths of tiles and batches.
// ctest-label: exact
TEST(DenseProduct, SumsInTheOrderOfTheColumnsForAllSizes) {
  const std::array<int, 3> sizes[] = {{1, 1, 1},  {7, 5, 3},   {33, 66, 2}, {8, 4, 17},
                                      {1, 37, 4}, {150, 2, 2}, {2, 150, 65}};
  const Space space;
  std::mt19937 engine(11);
  const auto random = [&](std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) value = 2.0 * std::generate_canonical<double, 53>(engine) - 1.0;
    return values;
  };
  const DenseProduct<Space> product(space);
  for (const std::array<int, 3>& cells : sizes)
    for (const std::size_t axis : {0U, 1U, 2U})
      for (const bool transposed : {false, true}) {
        const std::size_t n = static_cast<std::size_t>(cells[axis]),
                          size = static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                                 static_cast<std::size_t>(cells[2]);
        const std::vector<double> matrix = random(n * n), from = random(size);
        const List to("to", size);
        product.along_axis(cells, axis, to_device(space, matrix), transposed, to_device(space, from), to);
        std::vector<double> found(size);
        device::copy_out(space, found.data(), to, size);
        space.fence();
        const Sums expected = sums(cells, axis, transposed, matrix, from);
        for (std::size_t i = 0; i < size; ++i)
          ASSERT_LE(std::abs(found[i] - expected.value[i]),
                    round_off * static_cast<double>(n) * expected.magnitude[i])
              << cells[0] << " x " << cells[1] << " x " << cells[2] << ", axis " << axis << ", entry " << i;
      }
}

}  // namespace
}  // namespace drogue::linear
