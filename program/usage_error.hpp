// Errors of the command line itself; they end the command with exit code 2 instead of 1.
#pragma once

#include "depthgrid/core/error.hpp"

namespace depthgrid::program {

/// A broken command line: the message names the option, the value and the rule.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Throws UsageError with the parts streamed one after the other into one line.
template <class... Parts>
[[noreturn]] void fail_usage(const Parts&... parts) {
  std::ostringstream text;
  text.precision(10);
  (text << ... << parts);
  throw UsageError(text.str());
}

/// Runs a check of what the command line says: the library's Error becomes a UsageError of the same text.
template <class Check>
decltype(auto) as_usage(const Check& check) {
  try {
    return check();
  } catch (const UsageError&) {
    throw;
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

}  // namespace depthgrid::program
