#include "miniapps/parachute/app.hpp"

int main(int argc, char** argv) {
  return drogue::framework::run_mini_app(drogue::parachute_app::mini_app(), argc, argv);
}
