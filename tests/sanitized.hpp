#pragma once

namespace mpmfast::test {

/// Do the sanitizers watch this engine? Everything is some 20 times slower then, so long cases take fewer
/// steps, or are passed over where others run the same code. Asked of the program, since tests are compiled
/// once for both engines.
bool sanitized();

}  // namespace mpmfast::test
