#pragma once

#include "kernels/fabric/elastic/membrane.hpp"

namespace drogue::fabric {

/// Calls `function.operator()<model>()` with the compiled constitutive model of a material. Edge springs and
/// springs of vectors share one.
template <class Function>
decltype(auto) dispatch_model(const Material& material, const Function& function) {
  const auto with = [&]<bool tension_only>() -> decltype(auto) {
    switch (material.model) {
      case Model::quadratic:
        return function.template operator()<ConstitutiveModel{Model::quadratic, tension_only}>();
      case Model::biquadratic:
        return function.template operator()<ConstitutiveModel{Model::biquadratic, tension_only}>();
      case Model::linear_vector:
      case Model::edge:
        break;
    }
    return function.template operator()<ConstitutiveModel{Model::edge, tension_only}>();
  };
  return material.tension_only ? with.template operator()<true>() : with.template operator()<false>();
}

}  // namespace drogue::fabric
