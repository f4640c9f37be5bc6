#include "driver/world/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace bounce {
namespace {

volatile std::sig_atomic_t first_signal = 0;

extern "C" void on_interrupt(int signal) {
  if (first_signal == 0) first_signal = signal;
}

}  // namespace

void catch_interrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = on_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

bool interrupted() { return first_signal != 0; }

int interrupt_exit_code() { return 128 + first_signal; }

}  // namespace bounce
