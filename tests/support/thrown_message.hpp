// The message of the Error that a call throws, for tests that check messages.
#pragma once

#include <string>

#include "depthgrid/core/error.hpp"

namespace depthgrid::test {

/// Empty when the call throws nothing; other exceptions than Error pass through and fail the test.
template <class Call>
std::string thrown_message(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace depthgrid::test
