#pragma once

/// @file A reference to something that can be called, of one type for all that take the same arguments: what
/// takes one is compiled once and not with every caller.

#include <memory>

namespace mpmfast {

template <class Signature>
class FunctionRef;

/// Refers to the callable, which must outlive the reference: an argument does.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class F>
  FunctionRef(const F& f)  // implicit: functions that take one are called with a lambda
      : of_(std::addressof(f)), call_([](const void* of, Arguments... arguments) -> Result {
          return (*static_cast<const F*>(of))(arguments...);
        }) {}

  Result operator()(Arguments... arguments) const { return call_(of_, arguments...); }

 private:
  const void* of_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace mpmfast
