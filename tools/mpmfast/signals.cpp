#include "signals.hpp"

#include <array>
#include <csignal>
#include <type_traits>

namespace mpmfast {

namespace {

// A handler may touch nothing else: the one piece of global state here.
volatile std::sig_atomic_t received = 0;
static_assert(std::is_same_v<std::sig_atomic_t, int>);

constexpr std::array<int, 8> kStops{SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU};

void store_signal(int number) {
  received = number;
  for (const int stop : kStops)
    if (stop != SIGXCPU) std::signal(stop, SIG_DFL);
}

}  // namespace

void catch_stop_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of the write, as a full disk is
  std::signal(SIGPIPE, SIG_IGN);  // a run outlives whoever read what it prints
  struct sigaction before {};
  const bool no_hang_up = sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
  for (const int stop : kStops)
    if (stop != SIGHUP || !no_hang_up) std::signal(stop, store_signal);  // nohup means it
}

const volatile int* stop_signal() { return &received; }

}  // namespace mpmfast
