#include "tests/sanitized.hpp"

/// Defined where the program is linked with the address sanitizer.
extern "C" void __asan_init() __attribute__((weak));

namespace mpmfast::test {

bool sanitized() { return &__asan_init != nullptr; }

}  // namespace mpmfast::test
