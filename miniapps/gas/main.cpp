#include "miniapps/gas/app.hpp"

int main(int argc, char** argv) {
  return drogue::framework::run_mini_app(drogue::gas_app::mini_app(), argc, argv);
}
