#include "common/program/mini_app_options.hpp"
#include "common/program/program.hpp"
#include "miniapps/springs/app.hpp"

int main(int argc, char** argv) {
  return drogue::run_program("drogue-springs", [&] {
    return drogue::springs_app::run_app(drogue::parse_mini_app_options(
        "drogue-springs", "Cloth and strings as springs that equal a membrane.", argc, argv));
  });
}
