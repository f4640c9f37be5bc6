#include "driver/world/interrupt.hpp"

#include <csignal>

namespace bounce {
namespace {

volatile std::sig_atomic_t pressed = 0;

extern "C" void on_interrupt(int) { pressed = 1; }

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

bool interrupted() { return pressed != 0; }

}  // namespace bounce
