#include "depthgrid/sensors/shared_library.hpp"

#include <dlfcn.h>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"

namespace depthgrid::sensors {
namespace {

/// "a, b and 40 others": who reads it needs an idea, not a list.
std::string some_of(std::span<const std::string> names) {
  constexpr std::size_t kShown = 2;
  std::string text;
  for (std::size_t k = 0; k < names.size() && k < kShown; ++k) {
    text += (k == 0 ? "" : ", ") + names[k];
  }
  if (names.size() == kShown + 1) {
    text += ", " + names.back();
  } else if (names.size() > kShown) {
    text += " ... " + names.back();
  }
  return text;
}

}  // namespace

SharedLibrary::SharedLibrary(std::span<const std::string> names, const std::string& hint) {
  std::string why;
  for (const std::string& name : names) {
    handle_ = ::dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ != nullptr) {
      name_ = name;
      return;
    }
    const char* const error = ::dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, in glibc
    const std::string text = error != nullptr ? error : "";
    // That a name is not found says nothing; that a library is there and does not load is the reason.
    if (why.empty() && !text.starts_with(name + ": cannot open shared object file: No such file")) {
      why = " (" + printable(text) + ")";
    }
  }
  fail("no library of the camera's maker is found, tried ", some_of(names), why, ": ", hint);
}

void* SharedLibrary::find(const char* symbol, bool is_needed) const {
  void* const address = ::dlsym(handle_, symbol);
  if (address == nullptr && is_needed) {
    fail(name_, ": has no function ", symbol, ": too old, or another library");
  }
  return address;
}

}  // namespace depthgrid::sensors
