#include "miniapps/springs/app.hpp"

int main(int argc, char** argv) {
  return drogue::framework::run_mini_app(drogue::springs_app::mini_app(), argc, argv);
}
