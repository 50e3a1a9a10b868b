#include "common/program/program.hpp"
#include "miniapps/options/app.hpp"

int main(int argc, char** argv) {
  return drogue::run_program("drogue-options", [&] {
    return drogue::options_app::run_command(drogue::options_app::parse_command(argc, argv));
  });
}
