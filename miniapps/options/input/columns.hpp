#pragma once

#include <string>
#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::options_app {

/// Column of a member of `Contract`.
struct NumberColumn {
  const char* name;
  double options::Contract::*member;
  bool required;
};

/// Column of a parameter of one model; models share a column by its name.
struct ModelParameter {
  const char* name;
  options::JumpModel model;
  int index;  ///< in `Contract::jump`
};

/// Text of an enumerated column and its value.
template <class Value>
struct Keyword {
  const char* text;
  Value value;
};

inline constexpr NumberColumn number_columns[] = {
    {"spot", &options::Contract::spot, true},         {"strike", &options::Contract::strike, true},
    {"rate", &options::Contract::rate, true},         {"dividend", &options::Contract::dividend, false},
    {"maturity", &options::Contract::maturity, true}, {"variance", &options::Contract::variance, false},
};

inline constexpr ModelParameter model_parameters[] = {
    {"lambda", options::JumpModel::generalized_hyperbolic, 0},
    {"alpha", options::JumpModel::generalized_hyperbolic, 1},
    {"beta", options::JumpModel::generalized_hyperbolic, 2},
    {"delta", options::JumpModel::generalized_hyperbolic, 3},
    {"intensity", options::JumpModel::merton, 0},
    {"jump_mean", options::JumpModel::merton, 1},
    {"jump_deviation", options::JumpModel::merton, 2},
    {"intensity", options::JumpModel::kou, 0},
    {"up_probability", options::JumpModel::kou, 1},
    {"up_rate", options::JumpModel::kou, 2},
    {"down_rate", options::JumpModel::kou, 3},
};

inline constexpr Keyword<options::Style> styles[] = {{"american", options::Style::american},
                                                     {"european", options::Style::european}};
inline constexpr Keyword<options::Type> types[] = {{"put", options::Type::put},
                                                   {"call", options::Type::call}};
inline constexpr Keyword<options::JumpModel> models[] = {{"gh", options::JumpModel::generalized_hyperbolic},
                                                         {"black-scholes", options::JumpModel::black_scholes},
                                                         {"merton", options::JumpModel::merton},
                                                         {"kou", options::JumpModel::kou}};

/// Names of all valid input columns, without repetitions.
[[nodiscard]] std::vector<std::string> input_columns();

}  // namespace drogue::options_app
