#pragma once

#include <Kokkos_BitManipulation.hpp>
#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__AVX512F__) && !defined(__CUDACC__)
#include <immintrin.h>
#endif

// Kokkos::Experimental::simd picks its width from KOKKOS_ARCH_AVX2/AVX512XEON, which Kokkos_ARCH_NATIVE does
// not define, and it cannot convert double <-> float packs. GCC and Clang vector types do both, but nvcc's
// front end rejects them, so CUDA builds run their host backends with one lane.
#if defined(__GNUC__) && !defined(__CUDACC__)
#define DROGUE_HOST_VECTORS 1
#else
#define DROGUE_HOST_VECTORS 0
#endif

namespace drogue::device {

// ---- the scalar side: the same names as for packs, so that a point function is one text for both ----

template <class T>
KOKKOS_INLINE_FUNCTION T maximum(T a, T b) {
  return a > b ? a : b;
}
/// One instruction of a GPU, which a comparison that lets a NaN through is not.
KOKKOS_INLINE_FUNCTION float maximum(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}
template <class T>
KOKKOS_INLINE_FUNCTION T minimum(T a, T b) {
  return a < b ? a : b;
}
KOKKOS_INLINE_FUNCTION double absolute(double a) { return Kokkos::fabs(a); }
KOKKOS_INLINE_FUNCTION float absolute(float a) { return Kokkos::fabs(a); }
KOKKOS_INLINE_FUNCTION double square_root(double a) { return Kokkos::sqrt(a); }
KOKKOS_INLINE_FUNCTION float square_root(float a) { return Kokkos::sqrt(a); }
template <class T>
KOKKOS_INLINE_FUNCTION T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}

/// 1/x. On CUDA the hardware's approximation and one cubic Newton step (within 1 ulp for normal x; a third of
/// the instructions of an IEEE division); the exact build divides.
KOKKOS_INLINE_FUNCTION double reciprocal(double x) {
#if defined(__CUDA_ARCH__) && !defined(DROGUE_EXACT)
  double y;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x, y, 1.0);
  return fma(y, fma(e, e, e), y);
#else
  return 1.0 / x;
#endif
}
KOKKOS_INLINE_FUNCTION float reciprocal(float x) {
#if defined(__CUDA_ARCH__) && !defined(DROGUE_EXACT)
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));  // within 1 ulp
  return y;
#else
  return 1.0F / x;
#endif
}

/// The power of two that brings a positive normal number into [1, 2): no product with it rounds. Of zero it
/// is the largest there is.
KOKKOS_INLINE_FUNCTION double binary_reciprocal(double x) {
  const std::uint64_t exponent = Kokkos::bit_cast<std::uint64_t>(x) & 0x7FF0'0000'0000'0000U;
  return Kokkos::bit_cast<double>(0x7FE0'0000'0000'0000U - exponent);
}
KOKKOS_INLINE_FUNCTION float binary_reciprocal(float x) {
  const std::uint32_t exponent = Kokkos::bit_cast<std::uint32_t>(x) & 0x7F80'0000U;
  return Kokkos::bit_cast<float>(0x7F00'0000U - exponent);
}

/// What has a square root in it.
template <class R>
struct Root {
  R value, inverse, reciprocal;  ///< sqrt(x), 1/sqrt(x), 1/x
};

/// Of a positive normal number; of what else there is something is no finite number. On CUDA the hardware's
/// approximation of 1/sqrt(x) and one cubic Newton step give all (the root within 2 ulp) with a third of the
/// instructions of an IEEE root and division. Elsewhere these do not wait for one another.
KOKKOS_INLINE_FUNCTION Root<double> root(double x) {
#if defined(__CUDA_ARCH__) && !defined(DROGUE_EXACT)
  double y;
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const double e = fma(-x, y * y, 1.0);
  y = fma(y * e, fma(e, 0.375, 0.5), y);
  return {x * y, y, y * y};
#else
  const double value = square_root(x), inverse = reciprocal(x);
  return {value, value * inverse, inverse};
#endif
}
KOKKOS_INLINE_FUNCTION Root<float> root(float x) {
#if defined(__CUDA_ARCH__) && !defined(DROGUE_EXACT)
  float y;
  asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return {x * y, y, y * y};
#else
  const float value = square_root(x), inverse = reciprocal(x);
  return {value, value * inverse, inverse};
#endif
}

/// Whether all lanes of a comparison, or of several combined by &, hold.
KOKKOS_INLINE_FUNCTION bool all(bool condition) { return condition; }

template <class To>
struct Convert {
  template <class From>
  KOKKOS_INLINE_FUNCTION static To from(From value) {
    return static_cast<To>(value);
  }
};

/// Single precision with as many lanes.
template <class R>
struct SingleOf {
  using Type = R;
};
template <>
struct SingleOf<double> {
  using Type = float;
};

/// Reads one value, or `Pack::lanes` consecutive ones, from `pointer`.
template <class R>
struct Access {
  using Element = R;
  static constexpr int lanes = 1;
  KOKKOS_INLINE_FUNCTION static R load(const Element* pointer) { return *pointer; }
  KOKKOS_INLINE_FUNCTION static void store(Element* pointer, R value) { *pointer = value; }
  KOKKOS_INLINE_FUNCTION static Element lane(R value, int) { return value; }
  /// What names the values of all lanes: as an index is read ahead of them, its value.
  using Index = int;
  KOKKOS_INLINE_FUNCTION static Index index(const int* of_lanes) { return *of_lanes; }
  /// The values that it names.
  KOKKOS_INLINE_FUNCTION static R gather(const Element* values, Index index) { return values[index]; }
  /// 0 where a bit is set, else 1.
  KOKKOS_INLINE_FUNCTION static R unless_set(const std::uint8_t* sets, unsigned bit) {
    return (*sets & bit) != 0U ? R(0) : R(1);
  }
};

#if DROGUE_HOST_VECTORS

/// `Lanes` values that host arithmetic treats at once; element-wise IEEE semantics, so each lane has the bits
/// that scalar code would have.
template <class T, int Lanes>
struct Pack {
  using Element = T;
  typedef T Vector
      __attribute__((vector_size(Lanes * sizeof(T))));  // NOLINT: an alias would lose the attribute
  static constexpr int lanes = Lanes;

  Vector v;

  Pack() = default;
  Pack(T scalar) : v(scalar - Vector{}) {}  // NOLINT: numbers mix with packs as they do with numbers

  /// Not a constructor: inside a template GCC takes its parameter for a T.
  static Pack of(Vector vector) {
    Pack pack;
    pack.v = vector;
    return pack;
  }

  friend Pack operator+(Pack a, Pack b) { return of(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return of(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return of(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return of(a.v / b.v); }
  friend Pack operator-(Pack a) { return of(-a.v); }
  Pack& operator+=(Pack b) {
    v += b.v;
    return *this;
  }
  Pack& operator*=(Pack b) {
    v *= b.v;
    return *this;
  }
  friend auto operator>(Pack a, Pack b) { return a.v > b.v; }
  friend auto operator<(Pack a, Pack b) { return a.v < b.v; }
  friend auto operator>=(Pack a, Pack b) { return a.v >= b.v; }
  friend auto operator<=(Pack a, Pack b) { return a.v <= b.v; }
};

template <class T, int L>
Pack<T, L> maximum(Pack<T, L> a, Pack<T, L> b) {
  return Pack<T, L>::of(a.v > b.v ? a.v : b.v);
}
template <class T, int L>
Pack<T, L> minimum(Pack<T, L> a, Pack<T, L> b) {
  return Pack<T, L>::of(a.v < b.v ? a.v : b.v);
}
template <class T, int L>
Pack<T, L> absolute(Pack<T, L> a) {
  // Clears the sign bit; a comparison with zero would keep the sign of -0.
  using Bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Bits BitVector __attribute__((vector_size(L * sizeof(T))));  // NOLINT
  const BitVector magnitude = std::numeric_limits<Bits>::max() - BitVector{};
  return Pack<T, L>::of((typename Pack<T, L>::Vector)((BitVector)a.v & magnitude));
}
template <class T, int L>
Pack<T, L> square_root(Pack<T, L> a) {
  Pack<T, L> root;
  for (int k = 0; k < L; ++k) root.v[k] = std::sqrt(a.v[k]);
  return root;
}
template <class Mask, class T, int L>
Pack<T, L> select(Mask condition, Pack<T, L> yes, Pack<T, L> no) {
  return Pack<T, L>::of(condition ? yes.v : no.v);
}
template <class Mask>
requires(!std::is_arithmetic_v<Mask>) bool all(Mask condition) {
  bool holds = true;
  for (std::size_t k = 0; k < sizeof(Mask) / sizeof(condition[0]); ++k) holds &= condition[k] != 0;
  return holds;
}
template <class T, int L>
Pack<T, L> binary_reciprocal(Pack<T, L> x) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Bits BitVector __attribute__((vector_size(L * sizeof(T))));  // NOLINT
  const BitVector mask = (sizeof(T) == 8 ? Bits(0x7FF0'0000'0000'0000) : Bits(0x7F80'0000)) - BitVector{};
  const BitVector most = (sizeof(T) == 8 ? Bits(0x7FE0'0000'0000'0000) : Bits(0x7F00'0000)) - BitVector{};
  return Pack<T, L>::of((typename Pack<T, L>::Vector)(most - ((BitVector)x.v & mask)));
}
template <class T, int L>
Pack<T, L> reciprocal(Pack<T, L> x) {
  return Pack<T, L>(T(1)) / x;
}
template <class T, int L>
Root<Pack<T, L>> root(Pack<T, L> x) {
  const Pack<T, L> value = square_root(x), inverse = reciprocal(x);
  return {value, value * inverse, inverse};
}

#if defined(__AVX512F__) && !defined(DROGUE_EXACT)

// All lanes are taken; in the intrinsics without a mask GCC 12 warns of a value that it does not use.

/// 1 - a b with one rounding, where a compiler that fuses no operations would leave the error of a b, as
/// large as that of 1.
inline Pack<double, 8> one_less(Pack<double, 8> a, Pack<double, 8> b) {
  return Pack<double, 8>::of(_mm512_mask3_fnmadd_pd(a.v, b.v, Pack<double, 8>(1.0).v, 0xFF));
}

/// As on CUDA, for eight lanes: 14 bits from the hardware, and y (1 + e)(1 + e^2) with e = 1 - x y, whose
/// error is e^4. A division of eight takes the time of sixteen such operations.
inline Pack<double, 8> reciprocal(Pack<double, 8> x) {
  const auto y = Pack<double, 8>::of(_mm512_mask_rcp14_pd(x.v, 0xFF, x.v));
  const Pack<double, 8> e = one_less(x, y), better = y + y * e;
  return better + better * (e * e);
}

/// With e = 1 - x y^2, 1/sqrt(x) is y (1 - e)^(-1/2), here its series to e^4. Of e half counts, so that the
/// rounding of x y costs half a digit.
inline Root<Pack<double, 8>> root(Pack<double, 8> x) {
  auto y = Pack<double, 8>::of(_mm512_mask_rsqrt14_pd(x.v, 0xFF, x.v));
  const Pack<double, 8> e = one_less(x * y, y);
  y += (y * e) * (0.5 + e * (0.375 + e * (0.3125 + e * 0.2734375)));
  return {x * y, y, y * y};
}

#endif

template <class T, int L>
struct Convert<Pack<T, L>> {
  template <class From>
  static Pack<T, L> from(Pack<From, L> value) {
    return Pack<T, L>::of(__builtin_convertvector(value.v, typename Pack<T, L>::Vector));
  }
};

template <int L>
struct SingleOf<Pack<double, L>> {
  using Type = Pack<float, L>;
};

template <class T, int L>
struct Access<Pack<T, L>> {
  using Element = T;
  static constexpr int lanes = L;
  static Pack<T, L> load(const T* pointer) {
    Pack<T, L> value;
    __builtin_memcpy(&value.v, pointer, sizeof(value.v));
    return value;
  }
  static void store(T* pointer, Pack<T, L> value) { __builtin_memcpy(pointer, &value.v, sizeof(value.v)); }
  static T lane(Pack<T, L> value, int k) { return value.v[k]; }
  using Index = const int*;
  static Index index(const int* of_lanes) { return of_lanes; }
  static Pack<T, L> gather(const T* values, Index index) {
    Pack<T, L> gathered;
    for (int k = 0; k < L; ++k) gathered.v[k] = values[index[k]];
    return gathered;
  }
  static Pack<T, L> unless_set(const std::uint8_t* sets, unsigned bit) {
    Pack<T, L> clear;
    for (int k = 0; k < L; ++k) clear.v[k] = (sets[k] & bit) != 0U ? T(0) : T(1);
    return clear;
  }
};

/// Doubles in the widest vector register of the target.
#if defined(__AVX512F__)
inline constexpr int host_lanes = 8;
#elif defined(__AVX__)
inline constexpr int host_lanes = 4;
#else
inline constexpr int host_lanes = 2;
#endif

template <class T>
using HostPack = Pack<T, host_lanes>;

#else

inline constexpr int host_lanes = 1;
template <class T>
using HostPack = T;

#endif

}  // namespace drogue::device
