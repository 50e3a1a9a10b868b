#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/spatial/bounding_sphere.hpp"

namespace drogue::spatial {

/// Uniform grid of cells, hashed into chains of primitives. `Heads` is a View of int with one entry per
/// bucket, a power of two of them, each -1 before the first insertion; `Spheres` is a View of BoundingSphere
/// with one entry per primitive. Primitives whose centres are at most a cell width apart lie in neighbouring
/// cells. Cell coordinates wrap after 21 bits per axis: callers test distances of all candidates.
struct HashGrid {
  double width;  ///< edge of a cell, m

  /// Key of a cell from its integer coordinates, of which 21 bits per axis count.
  KOKKOS_FUNCTION static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto bits = [](std::int64_t a) { return static_cast<std::uint64_t>(a) & 0x1fffffU; };
    return bits(x) << 42U | bits(y) << 21U | bits(z);
  }
  /// Integer coordinate of the cell that holds coordinate x, m; |x / width| must be below 2^63.
  [[nodiscard]] KOKKOS_FUNCTION std::int64_t coordinate(double x) const {
    return static_cast<std::int64_t>(Kokkos::floor(x / width));
  }
  /// Key of the cell that holds p, m.
  [[nodiscard]] KOKKOS_FUNCTION std::uint64_t cell_of(const Point& p) const {
    return key(coordinate(p.x), coordinate(p.y), coordinate(p.z));
  }
  /// Bucket of a cell by multiplicative hashing (Knuth 1973, vol. 3, 6.4). `buckets` is a power of two.
  KOKKOS_FUNCTION static int bucket(std::uint64_t cell, std::size_t buckets) {
    return static_cast<int>((cell * 0x9e3779b97f4a7c15U >> 32U) & (buckets - 1));
  }

  /// Inserts primitive k. Threads may insert different primitives concurrently; the order within a chain then
  /// depends on their schedule.
  template <class Heads, class Spheres>
  KOKKOS_FUNCTION void insert(int k, BoundingSphere sphere, const Heads& heads,
                              const Spheres& spheres) const {
    sphere.cell = cell_of(sphere.centre);
    sphere.next = Kokkos::atomic_exchange(&heads(bucket(sphere.cell, heads.extent(0))), k);
    spheres(k) = sphere;
  }

  /// Calls `visit(k)` for every primitive whose centre lies in the cell of p (m) or in one of its 26
  /// neighbours.
  template <class Heads, class Spheres, class Visit>
  KOKKOS_FUNCTION void for_each_candidate(const Point& p, const Heads& heads, const Spheres& spheres,
                                          const Visit& visit) const {
    const std::int64_t x = coordinate(p.x), y = coordinate(p.y), z = coordinate(p.z);
    for (int near = 0; near < 27; ++near) {
      const std::uint64_t cell = key(x + near % 3 - 1, y + near / 3 % 3 - 1, z + near / 9 - 1);
      for (int k = heads(bucket(cell, heads.extent(0))); k >= 0; k = spheres(k).next)
        if (spheres(k).cell == cell) visit(k);
    }
  }
};

}  // namespace drogue::spatial
