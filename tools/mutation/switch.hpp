#pragma once

/// @file What a mutated program asks at every mutant: is it this one? MUTANT names it in the environment; −1:
/// none, but those that are asked for are noted and written to the file MUTANT_RECORD. A program shares it
/// with the library that it is linked to.

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <type_traits>

#pragma GCC visibility push(default)

namespace mutation {

inline constexpr int kMost = 20000;

/// The number of the mutant that runs.
inline int chosen() {
  const char* word = std::getenv("MUTANT");
  return word ? std::atoi(word) : -2;
}
inline const int active = chosen();
inline int asked[kMost];

inline bool on(int number) {
  if (active == number) return true;
  if (active == -1) [[unlikely]]
    asked[number] = 1;
  return false;
}

/// The value of an expression: of Eigen's, which have a type each, the matrix.
template <class T>
auto plain(const T& value) {
  if constexpr (requires { typename T::PlainObject; })
    return typename T::PlainObject(value);
  else
    return static_cast<std::decay_t<T>>(value);
}

/// Writes what was asked for since the last call, with a few words before it, and forgets it.
inline void write_asked(const char* words) {
  const char* path = std::getenv("MUTANT_RECORD");
  if (active != -1 || !path) return;
  std::FILE* file = std::fopen(path, "a");
  if (!file) return;
  std::fprintf(file, "%s\t", words);
  for (int k = 0; k < kMost; ++k)
    if (asked[k]) std::fprintf(file, "%d ", k);
  std::fputc('\n', file);
  std::fclose(file);
  for (int& a : asked) a = 0;
}

/// Of a program without cases: all that it asked for, at its end.
struct AtEnd {
  ~AtEnd() { write_asked("end\t0\t1"); }
};
inline const AtEnd at_end;

}  // namespace mutation

#pragma GCC visibility pop
