#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

/// What the address sanitizer, which asks here, is to pass over: HDF5 1.10 loses a few KiB of its own when it
/// cannot write; fontconfig, which Cairo asks for a font, keeps its patterns by offsets, which the sanitizer
/// does not take for pointers.
extern "C" __attribute__((visibility("default"))) const char*
__lsan_default_suppressions() {  // seen by the sanitizer
  return "leak:libhdf5\nleak:libfontconfig\n";
}
