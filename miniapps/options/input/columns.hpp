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
  options::Model model;
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
    {"lambda", options::Model::generalized_hyperbolic, 0},
    {"alpha", options::Model::generalized_hyperbolic, 1},
    {"beta", options::Model::generalized_hyperbolic, 2},
    {"delta", options::Model::generalized_hyperbolic, 3},
    {"intensity", options::Model::merton, 0},
    {"jump_mean", options::Model::merton, 1},
    {"jump_deviation", options::Model::merton, 2},
    {"intensity", options::Model::kou, 0},
    {"up_probability", options::Model::kou, 1},
    {"up_rate", options::Model::kou, 2},
    {"down_rate", options::Model::kou, 3},
};

inline constexpr Keyword<options::Style> styles[] = {{"american", options::Style::american},
                                                     {"european", options::Style::european}};
inline constexpr Keyword<options::Type> types[] = {{"put", options::Type::put},
                                                   {"call", options::Type::call}};
inline constexpr Keyword<options::Model> models[] = {{"gh", options::Model::generalized_hyperbolic},
                                                     {"black-scholes", options::Model::black_scholes},
                                                     {"merton", options::Model::merton},
                                                     {"kou", options::Model::kou}};

/// Names of all valid input columns, without repetitions.
[[nodiscard]] std::vector<std::string> input_columns();

}  // namespace drogue::options_app
