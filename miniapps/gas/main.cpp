#include "common/program/mini_app_options.hpp"
#include "common/program/program.hpp"
#include "miniapps/gas/app.hpp"

int main(int argc, char** argv) {
  return drogue::run_program("drogue-gas", [&] {
    return drogue::gas_app::run_app(drogue::parse_mini_app_options(
        "drogue-gas", "One-dimensional Euler equations with characteristic WENO5.", argc, argv));
  });
}
