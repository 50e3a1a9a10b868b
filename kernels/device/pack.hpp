#pragma once

#include <Kokkos_BitManipulation.hpp>
#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__AVX__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#include <immintrin.h>
#endif

// Kokkos::Experimental::simd derives its width from KOKKOS_ARCH_AVX2/AVX512XEON, which Kokkos_ARCH_NATIVE
// does not define, and cannot convert packs between double and float. Vector types of GCC and Clang do both,
// but nvcc rejects them, and a compiler of HIP sees another width for the device than for the host, so host
// backends of CUDA and HIP builds use one lane.
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
#define DROGUE_HOST_VECTORS 1
#else
#define DROGUE_HOST_VECTORS 0
#endif

namespace drogue::device {

// Scalar overloads: point functions are templates that take scalars or packs.

/// Larger of two numbers; `b` if either is NaN.
template <class T>
KOKKOS_INLINE_FUNCTION T maximum(T a, T b) {
  return a > b ? a : b;
}
/// Larger of two numbers. On a GPU a single instruction, which ignores a NaN.
KOKKOS_INLINE_FUNCTION float maximum(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return a > b ? a : b;
#endif
}

/// Smaller of two numbers; `b` if either is NaN.
template <class T>
KOKKOS_INLINE_FUNCTION T minimum(T a, T b) {
  return a < b ? a : b;
}

/// Absolute value.
KOKKOS_INLINE_FUNCTION double absolute(double a) { return Kokkos::fabs(a); }
KOKKOS_INLINE_FUNCTION float absolute(float a) { return Kokkos::fabs(a); }

/// Square root, correctly rounded.
KOKKOS_INLINE_FUNCTION double square_root(double a) { return Kokkos::sqrt(a); }
KOKKOS_INLINE_FUNCTION float square_root(float a) { return Kokkos::sqrt(a); }

/// `yes` where the condition holds, else `no`.
template <class T>
KOKKOS_INLINE_FUNCTION T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}

/// 1/x. On CUDA a hardware approximation and one cubic Newton step: within 1 ulp for normal x, with a third
/// of the instructions of an IEEE division. The exact build divides.
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

/// 1/x in single precision; on CUDA the hardware approximation.
KOKKOS_INLINE_FUNCTION float reciprocal(float x) {
#if defined(__CUDA_ARCH__) && !defined(DROGUE_EXACT)
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));  // within 1 ulp
  return y;
#else
  return 1.0F / x;
#endif
}

/// Power of two that scales a positive normal number into [1, 2); multiplication by it is exact. The largest
/// power of two for zero.
KOKKOS_INLINE_FUNCTION double binary_reciprocal(double x) {
  const std::uint64_t exponent = Kokkos::bit_cast<std::uint64_t>(x) & 0x7FF0'0000'0000'0000U;
  return Kokkos::bit_cast<double>(0x7FE0'0000'0000'0000U - exponent);
}

/// The scaling power of two in single precision.
KOKKOS_INLINE_FUNCTION float binary_reciprocal(float x) {
  const std::uint32_t exponent = Kokkos::bit_cast<std::uint32_t>(x) & 0x7F80'0000U;
  return Kokkos::bit_cast<float>(0x7F00'0000U - exponent);
}

/// Square root of x and related values.
template <class R>
struct Root {
  R value, inverse, reciprocal;  ///< sqrt(x), 1/sqrt(x), 1/x
};

/// Square root, inverse square root and reciprocal of a positive normal number; not finite for any other x.
/// On CUDA a hardware approximation of 1/sqrt(x) and one cubic Newton step give all three, the root within 2
/// ulp, with a third of the instructions of an IEEE root and division. Elsewhere root and division are
/// independent.
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

/// Roots in single precision; on CUDA from the hardware approximation of 1/sqrt(x).
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

/// True if a comparison, or several combined by &, hold in all lanes.
KOKKOS_INLINE_FUNCTION bool all(bool condition) { return condition; }

/// Conversion between precisions.
template <class To>
struct Convert {
  /// `value` rounded to the precision of `To`.
  template <class From>
  KOKKOS_INLINE_FUNCTION static To from(From value) {
    return static_cast<To>(value);
  }
};

/// Single-precision type with the same number of lanes.
template <class R>
struct SingleOf {
  using Type = R;
};
template <>
struct SingleOf<double> {
  using Type = float;
};

/// Memory access of a scalar or of a pack of `lanes` values.
template <class R>
struct Access {
  using Element = R;
  static constexpr int lanes = 1;
  /// Value at `pointer`; a pack loads `lanes` consecutive values, of any alignment.
  KOKKOS_INLINE_FUNCTION static R load(const Element* pointer) { return *pointer; }
  /// Stores one value, or the consecutive values of a pack.
  KOKKOS_INLINE_FUNCTION static void store(Element* pointer, R value) { *pointer = value; }
  /// Value of one lane.
  KOKKOS_INLINE_FUNCTION static Element lane(R value, int) { return value; }
  /// Indices of the values of all lanes. A scalar index is held by value, so that it is loaded early.
  using Index = int;
  /// Index of the values of all lanes; `of_lanes` holds one index per lane.
  KOKKOS_INLINE_FUNCTION static Index index(const int* of_lanes) { return *of_lanes; }
  /// Values at an index.
  KOKKOS_INLINE_FUNCTION static R gather(const Element* values, Index index) { return values[index]; }
  /// 0 for each lane whose byte of `sets` has the bit, else 1.
  KOKKOS_INLINE_FUNCTION static R unless_set(const std::uint8_t* sets, unsigned bit) {
    return (*sets & bit) != 0U ? R(0) : R(1);
  }
};

#if DROGUE_HOST_VECTORS

/// SIMD pack of `Lanes` values with element-wise IEEE arithmetic: each lane is equal, bit for bit, to scalar
/// code. No function of packs throws.
template <class T, int Lanes>
struct Pack {
  using Element = T;
  typedef T Vector
      __attribute__((vector_size(Lanes * sizeof(T))));  // NOLINT: an alias would lose the attribute
  static constexpr int lanes = Lanes;

  Vector v;

  Pack() = default;

  /// Broadcast of a scalar. Does not throw.
  Pack(T scalar) : v(scalar - Vector{}) {}  // NOLINT: implicit, to mix numbers and packs

  /// Pack of a vector. Not a constructor, because GCC converts its argument to T inside templates. Does not
  /// throw.
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

/// Lane-wise maximum. Does not throw.
template <class T, int L>
Pack<T, L> maximum(Pack<T, L> a, Pack<T, L> b) {
  return Pack<T, L>::of(a.v > b.v ? a.v : b.v);
}

/// Lane-wise minimum. Does not throw.
template <class T, int L>
Pack<T, L> minimum(Pack<T, L> a, Pack<T, L> b) {
  return Pack<T, L>::of(a.v < b.v ? a.v : b.v);
}

/// Lane-wise absolute value. Does not throw.
template <class T, int L>
Pack<T, L> absolute(Pack<T, L> a) {
  // Clears the sign bit; a comparison with zero would not change -0.
  using Bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Bits BitVector __attribute__((vector_size(L * sizeof(T))));  // NOLINT
  const BitVector magnitude = std::numeric_limits<Bits>::max() - BitVector{};
  return Pack<T, L>::of((typename Pack<T, L>::Vector)((BitVector)a.v & magnitude));
}

/// Lane-wise square root. Does not throw.
template <class T, int L>
Pack<T, L> square_root(Pack<T, L> a) {
  Pack<T, L> root;
  for (int k = 0; k < L; ++k) root.v[k] = std::sqrt(a.v[k]);
  return root;
}

#if defined(__AVX__)
/// Square root of four lanes in one instruction: for processors that split 256-bit registers (Zen 1) GCC
/// makes two of 128 bits of the loop above. Does not throw.
inline Pack<double, 4> square_root(Pack<double, 4> a) { return Pack<double, 4>::of(_mm256_sqrt_pd(a.v)); }
#endif

/// `yes` in lanes where the condition holds, else `no`. Does not throw.
template <class Mask, class T, int L>
Pack<T, L> select(Mask condition, Pack<T, L> yes, Pack<T, L> no) {
  return Pack<T, L>::of(condition ? yes.v : no.v);
}

/// True if a comparison of packs holds in all lanes. Does not throw.
template <class Mask>
requires(!std::is_arithmetic_v<Mask>) bool all(Mask condition) {
  bool holds = true;
  for (std::size_t k = 0; k < sizeof(Mask) / sizeof(condition[0]); ++k) holds &= condition[k] != 0;
  return holds;
}

/// Lane-wise scaling power of two, as for scalars. Does not throw.
template <class T, int L>
Pack<T, L> binary_reciprocal(Pack<T, L> x) {
  using Bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Bits BitVector __attribute__((vector_size(L * sizeof(T))));  // NOLINT
  const BitVector mask = (sizeof(T) == 8 ? Bits(0x7FF0'0000'0000'0000) : Bits(0x7F80'0000)) - BitVector{};
  const BitVector most = (sizeof(T) == 8 ? Bits(0x7FE0'0000'0000'0000) : Bits(0x7F00'0000)) - BitVector{};
  return Pack<T, L>::of((typename Pack<T, L>::Vector)(most - ((BitVector)x.v & mask)));
}

/// Lane-wise 1/x by division. Does not throw.
template <class T, int L>
Pack<T, L> reciprocal(Pack<T, L> x) {
  return Pack<T, L>(T(1)) / x;
}

/// Lane-wise roots, as for scalars. Does not throw.
template <class T, int L>
Root<Pack<T, L>> root(Pack<T, L> x) {
  const Pack<T, L> value = square_root(x), inverse = reciprocal(x);
  return {value, value * inverse, inverse};
}

#if defined(__AVX512F__) && !defined(DROGUE_EXACT)

// Masked intrinsics with all lanes set: GCC 12 warns of an uninitialised value in those without a mask.

/// 1 - a b with a single rounding. Separate operations would add the rounding error of a b, which is about 1
/// ulp. Does not throw.
inline Pack<double, 8> one_less(Pack<double, 8> a, Pack<double, 8> b) {
  return Pack<double, 8>::of(_mm512_mask3_fnmadd_pd(a.v, b.v, Pack<double, 8>(1.0).v, 0xFF));
}

/// 1/x in eight lanes: a 14-bit hardware approximation y, improved to y (1 + e)(1 + e^2) with e = 1 - x y,
/// which has a relative error of e^4. A division of eight lanes takes as long as sixteen such operations.
/// Does not throw.
inline Pack<double, 8> reciprocal(Pack<double, 8> x) {
  const auto y = Pack<double, 8>::of(_mm512_mask_rcp14_pd(x.v, 0xFF, x.v));
  const Pack<double, 8> e = one_less(x, y), better = y + y * e;
  return better + better * (e * e);
}

/// Roots of eight lanes: 1/sqrt(x) = y (1 - e)^(-1/2) with e = 1 - x y^2 and a 14-bit hardware approximation
/// y, as a series to e^4. Only e/2 enters to first order, which halves the rounding error of x y. Does not
/// throw.
inline Root<Pack<double, 8>> root(Pack<double, 8> x) {
  auto y = Pack<double, 8>::of(_mm512_mask_rsqrt14_pd(x.v, 0xFF, x.v));
  const Pack<double, 8> e = one_less(x * y, y);
  y += (y * e) * (0.5 + e * (0.375 + e * (0.3125 + e * 0.2734375)));
  return {x * y, y, y * y};
}

#endif

/// Lane-wise conversion.
template <class T, int L>
struct Convert<Pack<T, L>> {
  /// `value` rounded to the precision of T. Does not throw.
  template <class From>
  static Pack<T, L> from(Pack<From, L> value) {
    return Pack<T, L>::of(__builtin_convertvector(value.v, typename Pack<T, L>::Vector));
  }
};

template <int L>
struct SingleOf<Pack<double, L>> {
  using Type = Pack<float, L>;
};

/// Memory access of a pack. No function throws.
template <class T, int L>
struct Access<Pack<T, L>> {
  using Element = T;
  static constexpr int lanes = L;

  /// `L` consecutive values, of any alignment. Does not throw.
  static Pack<T, L> load(const T* pointer) {
    Pack<T, L> value;
    __builtin_memcpy(&value.v, pointer, sizeof(value.v));
    return value;
  }

  /// Stores the lanes as consecutive values.
  static void store(T* pointer, Pack<T, L> value) { __builtin_memcpy(pointer, &value.v, sizeof(value.v)); }

  /// Value of lane k.
  static T lane(Pack<T, L> value, int k) { return value.v[k]; }

  /// Indices of the values of all lanes.
  using Index = const int*;

  /// Index of the values of all lanes; `of_lanes` holds one index per lane.
  static Index index(const int* of_lanes) { return of_lanes; }

  /// Values at an index.
  static Pack<T, L> gather(const T* values, Index index) {
    Pack<T, L> gathered;
    for (int k = 0; k < L; ++k) gathered.v[k] = values[index[k]];
    return gathered;
  }

  /// 0 for each lane whose byte of `sets` has the bit, else 1.
  static Pack<T, L> unless_set(const std::uint8_t* sets, unsigned bit) {
    Pack<T, L> clear;
    for (int k = 0; k < L; ++k) clear.v[k] = (sets[k] & bit) != 0U ? T(0) : T(1);
    return clear;
  }
};

/// Number of doubles in the widest vector register of the target.
#if defined(__AVX512F__)
inline constexpr int host_lanes = 8;
#elif defined(__AVX__)
inline constexpr int host_lanes = 4;
#else
inline constexpr int host_lanes = 2;
#endif

/// Pack of the widest vector register of the target.
template <class T>
using HostPack = Pack<T, host_lanes>;

#else

inline constexpr int host_lanes = 1;
template <class T>
using HostPack = T;

#endif

}  // namespace drogue::device
