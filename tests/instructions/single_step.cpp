#include "single_step.hpp"

#if defined(__linux__) && defined(__x86_64__)

#include <signal.h>
#include <ucontext.h>

namespace mpmfast::instructions {

namespace {

// Plain counters: the handler runs on the thread that it stops.
volatile std::uint64_t counted = 0;
volatile greg_t last_place = 0;

void count_one(int, siginfo_t*, void* context) {
  const greg_t place = static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
  if (place != last_place) counted = counted + 1;
  last_place = place;
}

}  // namespace

bool can_count() { return true; }

void start_counting() {
  struct sigaction action {};
  action.sa_sigaction = count_one;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGTRAP, &action, nullptr);
  counted = 0;
  last_place = 0;
  // The trap flag is bit 8; the red zone below the stack pointer may be in use.
  __asm__ volatile("sub $128, %%rsp\n pushfq\n orq $0x100, (%%rsp)\n popfq\n add $128, %%rsp" ::
                       : "memory", "cc");
}

std::uint64_t stop_counting() {
  __asm__ volatile("sub $128, %%rsp\n pushfq\n andq $~0x100, (%%rsp)\n popfq\n add $128, %%rsp" ::
                       : "memory", "cc");
  return counted;
}

}  // namespace mpmfast::instructions

#else

namespace mpmfast::instructions {

bool can_count() { return false; }
void start_counting() {}
std::uint64_t stop_counting() { return 0; }

}  // namespace mpmfast::instructions

#endif
