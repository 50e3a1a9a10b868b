#pragma once

#include <string>
#include <vector>

#include "kernels/options/contract.hpp"

namespace drogue::options_app {

/// What a column of numbers sets.
struct NumberColumn {
  const char* name;
  double options::Contract::*member;  ///< null for a parameter of a model
  bool required;
};

/// A parameter of a model: its column, and its place in `Contract::jump`.
struct ModelParameter {
  const char* name;
  options::Model model;
  int place;
};

/// A word that a column may hold, and what it means.
template <class Value>
struct Word {
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

inline constexpr Word<options::Style> styles[] = {{"american", options::Style::american},
                                                  {"european", options::Style::european}};
inline constexpr Word<options::Type> types[] = {{"put", options::Type::put}, {"call", options::Type::call}};
inline constexpr Word<options::Model> models[] = {{"gh", options::Model::generalized_hyperbolic},
                                                  {"black-scholes", options::Model::black_scholes},
                                                  {"merton", options::Model::merton},
                                                  {"kou", options::Model::kou}};

/// Every column that an input may have, in the order in which they are listed.
[[nodiscard]] std::vector<std::string> input_columns();

}  // namespace drogue::options_app
