#include "signals.hpp"

#include <csignal>
#include <type_traits>

namespace mpmfast {

namespace {

// A handler may touch nothing else: the one piece of global state here.
volatile std::sig_atomic_t received = 0;
static_assert(std::is_same_v<std::sig_atomic_t, int>);

void remember(int number) {
  received = number;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void catch_stop_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of the write, as a full disk is
  std::signal(SIGINT, remember);
  std::signal(SIGTERM, remember);
}

const volatile int* stop_signal() { return &received; }

}  // namespace mpmfast
