#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "kernels/options/contract_check.hpp"
#include "kernels/options/cos/bessel.hpp"
#include "kernels/options/cos/characteristic_exponent.hpp"
#include "kernels/options/cos/european.hpp"
#include "kernels/reference/options/cos.hpp"
#include "tests/support/option_sets.hpp"

// Host part of the Fourier methods: Bessel functions, characteristic exponents and European prices.

namespace drogue::options {
namespace {

using Complex = std::complex<double>;

Contract european(Type type = Type::put) {
  Contract c;
  c.style = Style::european;
  c.type = type;
  c.rate = 0.05;
  return c;
}

TEST(CosBessel, MatchesIntegralRepresentationInRightHalfPlane) {
  for (const double nu : {0.0, 0.3, 0.5, 0.5000001, 1.0, 2.7, 5.0, -5.0, 20.25})
    for (const double size : {1e-3, 0.4, 1.99, 2.01, 9.0, 80.0})
      for (const double angle : {0.0, 0.4, -0.7}) {
        const Complex z = std::polar(size, angle);
        const std::complex<long double> expected =
            std::log(reference::scaled_bessel_k(nu, std::complex<long double>(z)));
        const Complex value = log_bessel_k(nu, z);
        const double tolerance = 4e-14 * std::max(1.0, std::abs(value));
        EXPECT_NEAR(std::real(value), static_cast<double>(std::real(expected)), tolerance) << nu << ' ' << z;
        // The oracle returns the principal branch.
        EXPECT_NEAR(std::remainder(std::imag(value) - static_cast<double>(std::imag(expected)), 2.0 * M_PI),
                    0.0, tolerance)
            << nu << ' ' << z;
      }
}

TEST(CosBessel, IsContinuousAcrossPrincipalBranchCut) {
  // Parallel to the imaginary axis, close to it, the argument of K_nu changes by about nu pi / 2.
  Complex before = log_bessel_k(9.5, 0.01);
  for (double y = 0.0; y < 5.0; y += 0.001) {
    const Complex value = log_bessel_k(9.5, Complex(0.01, y));
    EXPECT_LT(std::abs(std::imag(value - before)), 1.1) << y;
    before = value;
  }
}

TEST(CosBessel, ReturnsNanForOrdersAbove1000) { EXPECT_TRUE(std::isnan(std::real(log_bessel_k(1e4, 1.0)))); }

TEST(CharacteristicExponent, MatchesReference) {
  for (const auto& set : testing::option_sets()) {
    const Contract c = testing::contract_of(set, 0, Style::european);
    const CharacteristicExponent psi(c);
    const reference::LevyAsset asset{c.rate, 0.0, c.variance, set.lambda, set.alpha, set.beta, set.delta};
    for (const double u : {0.0, 0.1, 1.0, 7.0, 60.0, 900.0}) {
      const auto expected = reference::characteristic_exponent(asset, u);
      const Complex value = psi(u);
      const double tolerance = 1e-13 * std::max(1.0, std::abs(value));
      EXPECT_NEAR(std::real(value), static_cast<double>(std::real(expected)), tolerance)
          << set.name << ' ' << u;
      EXPECT_NEAR(std::imag(value), static_cast<double>(std::imag(expected)), tolerance)
          << set.name << ' ' << u;
    }
    EXPECT_NEAR(std::real(psi(Complex(0.0, -1.0))), c.rate, 1e-14);
  }
}

TEST(CharacteristicExponent, DualOfDualIsIdentity) {
  const CharacteristicExponent psi(testing::contract_of(testing::option_sets()[0], 0, Style::american));
  const Complex u(3.0, -0.3);
  EXPECT_EQ(psi(u), psi.dual().dual()(u));
  EXPECT_NEAR(std::abs(psi.dual()(Complex(0.0, -1.0)) + psi(Complex(0.0, -1.0))), 0.0, 1e-14);
}

TEST(CosEuropean, MatchesReferencePrices) {
  for (const auto& set : testing::option_sets())
    for (std::size_t spot = 0; spot < 7; ++spot)
      for (const Type type : {Type::put, Type::call}) {
        Contract c = testing::contract_of(set, spot, Style::european);
        c.type = type;
        const double parity = c.spot - std::exp(-c.rate * c.maturity);
        const double expected = set.european[spot] + (type == Type::put ? 0.0 : parity);
        const Price price = european_price(c, CharacteristicExponent(c));
        // Relative error 1e-10, and the rounding of the strike; the puts of the data have 13 digits.
        const double rounding = type == Type::put ? 1e-14 : 6e-14;
        EXPECT_NEAR(price.price, expected, 1e-10 * expected + rounding) << set.name << ' ' << spot;
        EXPECT_LE(std::abs(price.price - expected), price.error + 1e-12);
      }
}

TEST(CosEuropean, MatchesBlackScholesFormula) {
  for (const double maturity : {1.0 / 365.0, 1.0, 30.0})
    for (const double spot : {0.7, 1.0, 1.3}) {
      Contract c = european(Type::call);
      c.model = JumpModel::black_scholes;
      c.spot = spot, c.maturity = maturity, c.variance = 0.04, c.dividend = 0.02;
      const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
      const double width = 0.2 * std::sqrt(maturity);
      const double d = (std::log(spot) + 0.03 * maturity) / width + 0.5 * width;
      const double prepaid_forward = spot * std::exp(-0.02 * maturity), bond = std::exp(-0.05 * maturity);
      const Price price = european_price(c, CharacteristicExponent(c));
      EXPECT_NEAR(price.price, prepaid_forward * normal(d) - bond * normal(d - width), 1e-14);
      EXPECT_NEAR(price.delta, std::exp(-0.02 * maturity) * normal(d), 1e-12);
      EXPECT_NEAR(price.gamma,
                  std::exp(-0.02 * maturity - 0.5 * d * d) / std::sqrt(2.0 * M_PI) / (spot * width), 1e-9);
    }
}

/// The series is a Poisson mixture of Black-Scholes prices (Merton 1976).
TEST(CosEuropean, MatchesMertonSeries) {
  Contract c = european(Type::call);
  c.maturity = 0.5, c.variance = 0.0225, c.spot = 1.05;
  const double intensity = 1.5, mean = -0.2, deviation = 0.1;
  const double growth = std::exp(mean + 0.5 * deviation * deviation) - 1.0;
  double expected = 0.0, weight = std::exp(-intensity * (1.0 + growth) * c.maturity);
  for (int n = 0; n < 40; ++n) {
    Contract each = c;
    each.model = JumpModel::black_scholes;
    each.variance = c.variance + n * deviation * deviation / c.maturity;
    each.rate = c.rate - intensity * growth + n * std::log1p(growth) / c.maturity;
    expected += weight * european_price(each, CharacteristicExponent(each)).price;
    weight *= intensity * (1.0 + growth) * c.maturity / (n + 1);
  }
  c.model = JumpModel::merton;
  c.jump[0] = intensity, c.jump[1] = mean, c.jump[2] = deviation;
  EXPECT_NEAR(european_price(c, CharacteristicExponent(c)).price, expected, 1e-12);
}

/// Kou's model without jumps, and generalized hyperbolic jumps with a small delta.
TEST(CosEuropean, ApproachesBlackScholesAndVarianceGammaLimits) {
  Contract kou = european(), plain = european(), tiny = european(), gamma = european();
  kou.model = JumpModel::kou, plain.model = JumpModel::black_scholes;
  kou.variance = plain.variance = 0.04;
  kou.jump[0] = 0.0, kou.jump[1] = 0.4, kou.jump[2] = 3.0, kou.jump[3] = 3.0;
  EXPECT_NEAR(european_price(kou, CharacteristicExponent(kou)).price,
              european_price(plain, CharacteristicExponent(plain)).price, 1e-14);
  for (Contract* c : {&tiny, &gamma}) c->jump[0] = 2.0, c->jump[1] = 11.0, c->jump[2] = -5.0;
  tiny.jump[3] = 1e-6;
  EXPECT_NEAR(european_price(tiny, CharacteristicExponent(tiny)).price,
              european_price(gamma, CharacteristicExponent(gamma)).price, 1e-10);
}

/// Variance gamma put as a mixture of Black-Scholes puts: the variance g has a gamma distribution of shape
/// lambda T, and the mean is beta g (Madan, Carr and Chang 1998). The price at g = 0 is subtracted, so that
/// the trapezoidal rule in log g converges.
double gamma_mixture_put(const Contract& c) {
  const double lambda = c.jump[0], alpha = c.jump[1], beta = c.jump[2];
  const double scale = 2.0 / (alpha * alpha - beta * beta), shape = lambda * c.maturity;
  const double drift = c.rate + lambda * std::log1p(-scale * (beta + 0.5));
  const double forward = c.spot * std::exp((drift - c.rate) * c.maturity);
  const double bond = std::exp(-c.rate * c.maturity);
  const auto normal = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  const auto put = [&](double g) {
    const double d = (std::log(forward / bond) + beta * g) / std::sqrt(g);
    return bond * normal(-d) - forward * std::exp((beta + 0.5) * g) * normal(-d - std::sqrt(g));
  };
  const double price_at_zero = std::max(bond - forward, 0.0);
  const double step = 0.01;
  double sum = 0.0;
  for (double s = -80.0; s < 8.0; s += step) {
    const double g = scale * std::exp(s);
    sum += step * std::exp(shape * s - std::exp(s)) * (put(g) - price_at_zero);
  }
  return price_at_zero + sum / std::tgamma(shape);
}

/// The density has a pole, so that a cosine series does not converge; the inversion integral does.
TEST(CosEuropean, PricesOneDayOfPureVarianceGamma) {
  Contract c = european();
  c.maturity = 1.0 / 365.0, c.jump[0] = 2.0, c.jump[1] = 11.0, c.jump[2] = -5.0;
  for (const double x : {-0.01, -c.maturity * CharacteristicExponent(c).drift(), 0.0, 0.02}) {
    c.spot = std::exp(x);
    EXPECT_NEAR(european_price(c, CharacteristicExponent(c)).price, gamma_mixture_put(c), 1e-12) << x;
  }
}

// For a large delta alpha T the integrand grows beside the contour. The expected price is from a normal
// variance-mean mixture.
TEST(CosEuropean, PricesTenYearsOfFrequentJumps) {
  Contract c{.style = Style::european,
             .type = Type::put,
             .spot = 103.429,
             .strike = 100.0,
             .rate = 0.0932,
             .dividend = 0.034,
             .maturity = 10.0};
  const double law[] = {-0.5, 32.26880092138141, 3.576405459003245, 0.75651991864889};
  std::copy(law, law + 4, c.jump);
  const Price price = european_price(c, CharacteristicExponent(c));
  EXPECT_NEAR(price.price, 1.2142633, 1e-7);
  EXPECT_LT(price.error, 1e-9);
}

TEST(ContractCheck, NamesViolatedCondition) {
  Contract c;
  c.jump[0] = 1.0, c.jump[1] = 8.0, c.jump[2] = -2.0, c.jump[3] = 0.5;
  EXPECT_EQ(violated_condition(c), "");
  Contract invalid = c;
  invalid.jump[2] = 7.5;
  EXPECT_NE(violated_condition(invalid).find("|beta+1| < alpha"), std::string_view::npos);
  invalid = c;
  invalid.jump[0] = -1.0, invalid.jump[3] = 0.0;
  EXPECT_NE(violated_condition(invalid).find("lambda > 0"), std::string_view::npos);
  invalid = c;
  invalid.spot = std::nan("");
  EXPECT_NE(violated_condition(invalid).find("spot"), std::string_view::npos);
}

}  // namespace
}  // namespace drogue::options
